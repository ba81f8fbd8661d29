/* search.h -- the state of the search for the features of a signal. */
#ifndef SEARCH_H
#define SEARCH_H

#include <math.h>
#include <stddef.h>
#include <stickslip/features.h>
#include "features/cycles.h"
#include "features/levels.h"
#include "features/quantity.h"
#include "features/window.h"

#define CENTER 6.0              /* of the wavelet */
#define STRONG 20.0             /* [dB] below the strongest: spikes that begin or end a transition */
enum { FEW = 3 };               /* maxima of a kind: fewer do not recur */
enum { CLIPPED = 8 };           /* samples at the largest or least value, one behind the other */

static const ss_value unknown = { NAN, NAN };
static const ss_median no_median = { NAN, NAN, NAN };
static const ss_maximum no_maximum = { NAN, NAN, NAN, NAN };

typedef struct search {
    const ss_signal *signal;
    double *x;                  /* the column over largest, so that squares stay in range */
    double largest;
    size_t n;
    double rate;
    size_t n_gaps;
    ss_span *gap;               /* [s] from the first sample */
    const ss_features_opts *opts;
    map_source map;             /* |W| */
    double top;                 /* its largest outside the cone of influence */
    struct row_source *rows;    /* of x (scale_rows.h) */
    ss_maximum *found;          /* maxima, slight ones too */
    size_t n_found;
    column_quantity quantity;
    ss_cycles cycles;
    int is_cleaned;             /* of a steady hum: x is no more the column */
    int has_offset;             /* a force whose sign is not that of friction, but of its zero */
    int spiked;                 /* transitions end with their last spike, anywhere before the next */
    ss_features *out;
} search;

static inline int
is_event(const ss_spike *spike)
{
    return spike->kind == SS_SPIKE_JUMP || spike->kind == SS_SPIKE_KINK;
}

/* The frequency of the cycles [Hz]. */
static inline ss_value
cycle_rate(const search *s)
{
    return (ss_value){ s->rate * s->cycles.frequency.value, s->rate * s->cycles.frequency.error };
}

/* Count the slips, and find their rate, into s->out, which has transitions and repetition_frequency; or say
 * there why they are not known. */
void ss_slip_rate_find(search *s);

/* Free the loadings, if there are any; all that they give is unknown. */
void ss_loadings_forget(ss_features *out);

/* Room for n transitions of which nothing is known, in place of those before. */
ss_status ss_transitions_new(ss_features *out, size_t n);

/* The transitions, in time order, and, where they ring, the frequency and damping that they have in
 * common, into s->out, which has spikes and repetition_frequency.  None found: s->out->n is 0. */
ss_status ss_transitions_find(search *s);

/* Transitions at the swells of the oscillation that recurs most often among the maxima of at least this
 * prominence [dB], refined and fitted, into s->out.  None: s->out->n is 0. */
ss_status ss_ringing_find(search *s, double prominence);

/* The ringing behind the transitions in s->out, if there is any. */
ss_status ss_ringing_behind(search *s);

/* Fit an oscillation of about f to every transition in s->out, each about a sample, its anchor, and
 * judge it; singly: each by itself, as they need not be alike. */
ss_status ss_oscillation_fit(search *s, const size_t *anchor, double f, int singly);

#endif
