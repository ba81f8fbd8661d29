/* events.h -- find the spikes of a signal, the single events of one that is quiet elsewhere, and rests.
 *
 * The first two are maxima of |W| along single scales (scale_rows.h).  Nothing is found near the source's gaps. */
#ifndef EVENTS_H
#define EVENTS_H

#include <stickslip/spikes.h>
#include "find/scale_rows.h"

#define EVENT_CLEAR 6.0         /* [dB] above threshold or the next weaker one: an event is no swell of noise */

static inline int
is_event(const ss_spike *spike)
{
    return spike->kind == SS_SPIKE_JUMP || spike->kind == SS_SPIKE_KINK;
}

/* Find all spikes of a source, whose memory is freed.  n = 0 if no |W| exceeds the noise. */
ss_status ss_spikes_find(ss_spikes **out, row_source *source);
void ss_spikes_free(ss_spikes *found);          /* NULL is allowed */

/* Count the spikes of a transition that begins at onset and ends, with its last release, at end,
 * both in seconds from the first sample.  Jumps and kinks count that are at most range dB below
 * the strongest.  A spike nearer to onset or end than its scale is that of onset or end. */
size_t ss_spikes_within(const ss_spikes *found, double onset, double end, double range);

typedef struct ss_bursts {
    size_t n;
    peak *burst;                /* in time order, each with its level re the strongest [dB]; to be freed */
    double f;                   /* label of the scale that shows the events best [Hz] */
    double next;                /* [dB] re the strongest, of the strongest event beyond range; -infinity
                                   if there is none above the noise */
    double floor;               /* [dB] re the strongest: noise hides weaker events */
} ss_bursts;

/* Find the events of a source that is quiet for most of the time; its memory is freed.  They may have any
 * length and shape.  They are the maxima of |W| at the scale where they exceed the noise most, at most range dB
 * below the strongest. */
ss_status ss_bursts_find(ss_bursts *out, row_source *source, double range);
/* Find the first and the last sample of the event about sample `at`: those farthest from it, within win,
 * that are off a line through the quiet samples before and behind the event.  Both become `at` if too few
 * samples are quiet.  period: of the oscillation that shows the event best, in samples. */
ss_window ss_extent(const double *x, ss_window win, size_t at, double period);

typedef struct ss_rests {
    size_t n;
    ss_window *rest;            /* in time order; to be freed */
    int is_doubtful;            /* 1: others may be rests, too, or some of these none */
    int is_end_of_range;        /* 1: no sample lies beyond the level, on one side, and it is not 0 */
    double level, band;         /* the samples of a rest are within the band about the level */
} ss_rests;

/* Find the rests of n samples x.  n = 0: it does not rest. */
ss_status ss_rests_find(const double *x, size_t n, ss_rests *out);

const char *ss_spike_kind_name(ss_spike_kind kind);     /* "glitch", "jump", "kink", "bend" */

#endif
