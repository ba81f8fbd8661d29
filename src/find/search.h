/* search.h -- the state of the search for the features of a signal. */
#ifndef SEARCH_H
#define SEARCH_H

#include <math.h>
#include <stdlib.h>
#include <stickslip/features.h>
#include "find/cycles.h"
#include "find/drops.h"
#include "find/events.h"
#include "find/judgement.h"
#include "find/ringdown.h"
#include "find/scale_rows.h"
#include "find/window.h"
#include "signal/header.h"

#define SPAN 80.0               /* [dB] of the paper's contours */
#define STRONG 20.0             /* [dB] range of the swells, spikes and single events that make transitions */

static const ss_value unknown = { NAN, NAN };
static const ss_number no_number = { NAN, NAN, NAN, NULL };
static const ss_maximum no_maximum = { NAN, NAN, NAN, NAN };

/* Of what the oscillation is that was fitted last. */
typedef enum identity {
    OF_NOTHING,                 /* none was, or it is no contact's by what is known of it alone */
    OF_SOMETHING, OF_FILTER, OF_SENSOR,
    OF_CONTACT                  /* it ends where slips begin */
} identity;

typedef struct search {
    const ss_signal *signal;
    double *x;                  /* the column over largest, so that squares stay in range */
    double largest;
    size_t n;
    double rate;
    size_t n_gaps;
    ss_span *gap;               /* [s] from the first sample */
    const ss_features_opts *opts;
    ss_coefficients *map;       /* computed where it is read */
    double top;                 /* its largest outside the cone of influence */
    row_source *rows;           /* of x */
    ss_maximum *found;          /* all maxima, also slight ones */
    size_t n_found;
    column_quantity quantity;
    const struct stream_part *part;     /* all 0: the signal is no part */
    double label;               /* of the oscillation that recurs [Hz]; 0: none is found */
    slow_part slow;             /* beside it */
    ss_cycles cycles;
    int is_cleaned;             /* x has lost a steady hum: it is not the column any more */
    int is_second;              /* it lost that in a first search */
    int has_offset;             /* the zero of a force may not be that of friction; -1: its slips are rises */
    identity rings_as;
    int must_show;              /* what rings is the contact's only if it ends where slips begin */
    int spiked;                 /* transitions end with their last spike, which may be anywhere before the
                                   next transition */
    ss_features *out;
} search;

/* Value and error of a number become these; its reason stays. */
static inline void
know(ss_features *out, ss_feature which, ss_value v)
{
    out->number[which].value = v.value;
    out->number[which].error = v.error;
}

static inline ss_value
known(const ss_features *out, ss_feature which)
{
    return (ss_value){ out->number[which].value, out->number[which].error };
}

/* Say why a number is not known, or how it was found. */
static inline void
say(ss_features *out, ss_feature which, const char *why)
{
    out->number[which].why = why;
}

/* The frequency of the cycles [Hz]. */
static inline ss_value
cycle_rate(const search *s)
{
    return (ss_value){ s->rate * s->cycles.frequency.value, s->rate * s->cycles.frequency.error };
}

/* What a signal teaches about a part of it.  The label of the oscillation that recurs is 0 if there is none. */
typedef struct stream_lesson {
    double label, rms;          /* [Hz], noise of |W| [a^1/2 of the samples] */
    double largest;             /* of the samples */
    double highest;             /* label of a scale [Hz] */
    double length;              /* [samples] */
    slow_part slow;             /* beside the oscillation */
    ss_cycles cycles;
    ss_number repetition;
} stream_lesson;

/* A signal that is a part of a longer one. */
typedef struct stream_part {
    double period;              /* [s] of the cycles of the longer one, or NaN if it does not repeat itself: of the
                                   part only the transitions are found; 0: not known */
    int is_contact;             /* what rings in the longer one is the contact's */
    const stream_lesson *known; /* only what rings so is sought; NULL: nothing is known */
    stream_lesson *learnt;      /* to be filled in; may be NULL */
} stream_part;
/* As ss_features_find. */
ss_status ss_features_of_part(ss_features **out, const ss_signal *signal, size_t column, const ss_features_opts *opts,
                              const stream_part *part, ss_error *err);

/* Count the slips, and find their rate, into s->out, which has transitions and repetition_frequency; or say
 * there why they are not known. */
ss_status ss_slip_rate_find(search *s);

/* Free the loadings, if there are any, and make all their numbers unknown. */
void ss_loadings_forget(ss_features *out);

/* Make room for n transitions of which nothing is known, in place of those before. */
static inline ss_status
ss_transitions_new(ss_features *out, size_t n)
{
    free(out->transition);
    out->n = 0;
    out->transition = calloc(n + 1, sizeof *out->transition);
    if (out->transition == NULL)
        return SS_ENOMEM;
    out->n = n;
    for (size_t i = 0; i < n; i++)
        out->transition[i] = (ss_transition){ .maximum = no_maximum, .frequency = unknown,
                                              .damping_ratio = unknown, .from = NAN, .to = NAN };
    return SS_OK;
}

/* Find the transitions, in time order, and the frequency and damping of their ringing, if they ring, into
 * s->out, which has spikes and repetition_frequency.  If there are none, s->out->n is 0. */
ss_status ss_transitions_find(search *s);

/* Find transitions at the swells of the oscillation that recurs most often among the maxima of at least this
 * prominence [dB], refined and fitted, into s->out.  If there are none, s->out->n is 0. */
ss_status ss_ringing_find(search *s, double prominence);

/* Find the ringing behind the transitions in s->out, if there is any. */
ss_status ss_ringing_behind(search *s);

/* Fit an oscillation of about f to every transition in s->out, each about a sample, its anchor, and judge
 * the fit.  singly: fit each by itself, as they need not be alike. */
ss_status ss_oscillation_fit(search *s, const size_t *anchor, double f, int singly);

/* Find the transitions of the signal in s, into s->out, if it is a force whose slips are its falls or its
 * reversals.  *decided becomes 1 if no other search is needed: they are found, or s->out->why says why they
 * cannot be. */
ss_status ss_force_find(search *s, int *decided);

/* Write n transitions, the drops of y, into s->out, and the loadings before them, with their medians.  y is the
 * signal in s or its negative, without wrong samples. */
ss_status ss_loading_find(search *s, const double *y, const ss_drop *drop, size_t n);

/* Find the transitions of x, which is the signal in s less a constant, and the medians over them: friction, and
 * stiffness if there is a column of displacement. */
ss_status ss_reversals_find(search *s, const double *x);

/* The tests that one damped oscillation, fitted to windows, passes before its numbers are printed.  *why becomes
 * the reason why it is not the contact's, or NULL. */
ss_status ss_identity_of(search *s, const ringdown *r, const char **why);

#endif
