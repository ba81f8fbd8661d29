/* stickslip/spikes.h -- find the times at which a signal is not smooth (jumps, kinks, glitches),
 * single events, and falls of a force.
 *
 * A spike is a maximum of |W| over time that is present at each of the shortest usable scales.
 *
 * Where samples were missing, others were filled in.  Such gaps are given as n_gaps spans in time
 * order, in seconds from the first sample (NULL and 0: no gaps).  Nothing is found near them. */
#ifndef STICKSLIP_SPIKES_H
#define STICKSLIP_SPIKES_H

#include <stddef.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>

SS_BEGIN_DECLARATIONS

/* The kind of a spike by its slope, the growth of |W| (a^-1/2 norm) over the octave above the
 * shortest scale that shows it:
 * - a^-1/2 for a glitch of one sample (-3 dB per octave; of two samples 0 dB);
 * - a^1/2 for a jump (+3 dB; +2 dB at the shortest scales of a sampled jump);
 * - a^3/2 for a kink (+9 dB; 4 to 15 dB where jump, kink and curvature coincide);
 * - faster than any power for a smooth bend (30 to 50 dB in the state-variable scene). */
typedef enum ss_spike_kind {
    SS_SPIKE_GLITCH,            /* slope below -1.5 dB per octave */
    SS_SPIKE_JUMP,              /* below 4 */
    SS_SPIKE_KINK,              /* below 22 */
    SS_SPIKE_BEND               /* 22 and more: smooth, no event */
} ss_spike_kind;

typedef struct ss_spike {
    double t;                   /* [s] from the first sample */
    double f;                   /* label of the shortest scale that shows it [Hz] */
    double level;               /* [dB] re the largest |W| of a spike at that scale, <= 0 */
    double snr;                 /* |W| at that scale over the rms of the noise */
    double slope;               /* [dB per octave of scale] */
    ss_spike_kind kind;
} ss_spike;

typedef struct ss_spike_opts {
    double fmax;                /* [Hz] label of the shortest scale used; 0: 0.6 of Nyquist */
    double false_alarms;        /* > 0, <= 1: the spikes expected in a record of white noise only */
    double precision;           /* 0 ... 1: of a sample, relative to the range of x; a weaker spike does
                                   not count */
    const ss_span *gap;         /* no spike is found within 12 scales of a gap: this is the support of a
                                   wavelet one octave longer */
    size_t n_gaps;
} ss_spike_opts;
extern const ss_spike_opts ss_spike_defaults;   /* 0, 0.01, 1e-7, no gaps */

typedef struct ss_spikes {
    size_t n;
    ss_spike *spike;            /* in time order */
    double threshold;           /* the least snr of a spike, which follows from false_alarms */
    double f;                   /* label of the shortest scale that has a spike; 0: no scale has */
    double floor;               /* [dB] the threshold relative to the clearest spike, at the scale where
                                   it is clearest; weaker spikes cannot be seen.  Bends count if the
                                   shortest scale shows them.  0: there is no spike */
    int conclusive;             /* 1: floor <= -6, so that a spike half as strong as the strongest is
                                   seen; 0: too much noise to count or to group spikes */
} ss_spikes;

/* Find all spikes of the n samples of x, which must be finite.  Two spikes that are nearer to each
 * other than about two of the scales that show them have one maximum of |W|, and are one.  n = 0
 * if no |W| exceeds the noise. */
ss_status ss_spikes_find(ss_spikes **out, const double *x, size_t n, double rate,
                         const ss_spike_opts *opts, ss_error *err);
void ss_spikes_free(ss_spikes *found);    /* NULL is allowed */

/* The spikes of a transition. */
typedef struct ss_spike_group {
    size_t n;                   /* spikes from onset to end, these two included */
    size_t inside;              /* spikes between them; > 0: the transition is grouped */
} ss_spike_group;
/* Count the spikes of a transition that begins at onset and ends, with its last release, at end,
 * both in seconds from the first sample.  Jumps and kinks count that are at most range dB below
 * the strongest.  A spike nearer to onset or end than its scale is that of onset or end. */
ss_spike_group ss_spikes_within(const ss_spikes *found, double onset, double end,
                                double range);

/* "counted", or why the spikes are not: there is too much noise, or the signal is smooth.  A
 * constant text. */
const char *ss_spikes_verdict(const ss_spikes *found);
const char *ss_spike_kind_name(ss_spike_kind kind);     /* "glitch", "jump", "kink", "bend" */

/* --- single events --------------------------------------------------------------------------- */

typedef struct ss_burst {
    double t;                   /* [s] from the first sample */
    double level;               /* [dB] re the strongest, <= 0 */
    double snr;                 /* |W| over the rms of the noise */
} ss_burst;

typedef struct ss_bursts {
    size_t n;
    ss_burst *burst;            /* in time order */
    double f;                   /* label of the scale that shows the events best [Hz] */
    double next;                /* [dB] re the strongest, of the strongest event beyond range; -infinity
                                   if there is none above the noise */
    double floor;               /* [dB] re the strongest: noise hides weaker events */
} ss_bursts;

typedef struct ss_burst_opts {
    double range;               /* [dB] >= 0 */
    const ss_span *gap;         /* no event is found within 6 scales of a gap, the support of a wavelet */
    size_t n_gaps;
} ss_burst_opts;

/* Find the events in a record that is quiet for most of the time.  They may have any length and
 * shape.  They are the maxima of |W| at the scale where they exceed the noise most, at most range
 * below the strongest. */
ss_status ss_bursts_find(ss_bursts **out, const double *x, size_t n, double rate,
                         const ss_burst_opts *opts, ss_error *err);
void ss_bursts_free(ss_bursts *found);          /* NULL is allowed */

/* --- drops ----------------------------------------------------------------------------------- */

/* A fall of a force that has loaded in a stick. */
typedef struct ss_drop {
    double t, end;              /* [s] from the first sample: the maximum and the minimum of the fall */
    double height;              /* > 0, in the unit of x */
} ss_drop;

typedef struct ss_drop_opts {
    double height;              /* > 0, in the unit of x */
    double reload;              /* the rise that ends a fall, in the unit of x; 0: height / 4 */
    const ss_span *gap;
    size_t n_gaps;
} ss_drop_opts;

/* Find all falls of x by more than height, in time order.  The caller frees *out with free().  A
 * fall ends where x has risen again by reload, so a slow drift is no fall.  Single wrong samples
 * have no effect; white noise changes heights by some 3 % of height.  A fall that a gap cuts is
 * left out. */
ss_status ss_drops_find(ss_drop **out, size_t *n_drops, const double *x, size_t n, double rate,
                        const ss_drop_opts *opts, ss_error *err);

SS_END_DECLARATIONS
#endif
