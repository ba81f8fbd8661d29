/* write.h -- the parts of the text of features, for a stream of them. */
#ifndef WRITE_H
#define WRITE_H

#include "find/numbers.h"
#include "io/record.h"

/* Write what a recording with this header says of itself, and what was asked for. */
void ss_features_notes(struct rows *rows, const ss_header *head, size_t column, const ss_features_opts *opts);
/* Write the row of a transition, of those columns that `has` allows.  start: of the recording [s]. */
void ss_features_row(struct rows *rows, const ss_features *f, size_t i, double start, unsigned has);
/* Write the reasons, and then each number with its error; a median also has the scatter of the events. */
void ss_features_numbers(struct rows *rows, const ss_features *f, unsigned has);

#endif
