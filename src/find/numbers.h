/* numbers.h -- the numbers that a recording has as a whole: what each needs, and what a recording has.
 *
 * A new number is a row in the list of features.h and the function that finds it. */
#ifndef NUMBERS_H
#define NUMBERS_H

#include "find/search.h"
#include "io/record.h"

enum {
    WITH_X = 1, WITH_F = 1 << 1, WITH_X_F = WITH_X | WITH_F,    /* columns in the options */
    WITH_MASS = 1 << 2,
    LOADING = 1 << 3,                           /* the transitions are falls of a force */
    OF_EVENTS = 1 << 4,                         /* falls or reversals of a force: it is their median */
    OF_FALLS = LOADING | OF_EVENTS
};

typedef struct feature_number {
    ss_label label;
    const char *about;
    unsigned needs;
    ss_status (*by)(search *s);
} feature_number;
extern const feature_number ss_feature_numbers[SS_FEATURE_NUMBERS];

/* What these features and options have of what numbers need. */
unsigned ss_features_have(const ss_features *f, const ss_features_opts *opts);

/* Find the numbers that follow from the others, in the order of the list. */
ss_status ss_numbers_find(search *s);

/* |df/dx| over the n windows, each from first to end in samples, with its standard error; y is the
 * signal that the windows were found in.  All hold finite numbers, else the slope is NaN; it is,
 * too, where it is not known within a third. */
ss_status ss_slope_find(const double *f, const double *x, const double *y, const ss_window *span,
                        size_t n, ss_value *slope);

/* --- write.c: the parts of the text of features, for a stream of them ------------------------------ */

/* Write what a recording with this header says of itself, and what was asked for. */
void ss_features_notes(struct rows *rows, const ss_header *head, size_t column, const ss_features_opts *opts);
/* Write the row of a transition, of those columns that `has` allows.  start: of the recording [s]. */
void ss_features_row(struct rows *rows, const ss_features *f, size_t i, double start, unsigned has);
/* Write the reasons, and then each number with its error; a median also has the scatter of the events. */
void ss_features_numbers(struct rows *rows, const ss_features *f, unsigned has);

#endif
