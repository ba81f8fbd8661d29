/* stickslip/spikes.h -- where a signal is not smooth: jumps, kinks and glitches, from the maxima of
 * |W| over time that persist across its shortest usable scales; single events; drops of a force.
 *
 * Gaps, where other values stand in for missing ones, are given as n_gaps spans in seconds from the
 * first sample, in time order (NULL and 0: none).  Nothing is claimed within their reach. */
#ifndef STICKSLIP_SPIKES_H
#define STICKSLIP_SPIKES_H

#include <stddef.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>

SS_BEGIN_DECLARATIONS

/* The growth of |W| (a^-1/2 norm) over the octave above the shortest scale that shows the spike:
 * a^-1/2 for a glitch of one sample (-3 dB an octave; 0 for two samples), a^1/2 for a jump (+3; +2
 * at the shortest scales of a sampled one), a^3/2 for a kink (+9; 4 to 15 where jump, kink and
 * curvature come together), and faster than any power for what is smooth (30 to 50 in the
 * state-variable scene). */
typedef enum ss_spike_kind {
    SS_SPIKE_GLITCH,            /* slope below -1.5 dB an octave */
    SS_SPIKE_JUMP,              /* below 4 */
    SS_SPIKE_KINK,              /* below 22 */
    SS_SPIKE_BEND               /* 22 and more: smooth, no event */
} ss_spike_kind;

typedef struct ss_spike {
    double t;                   /* [s] from the first sample */
    double f;                   /* label of the shortest scale that shows it [Hz] */
    double level;               /* [dB] re the largest |W| of a spike at that scale, <= 0 */
    double snr;                 /* |W| there over the rms of the noise */
    double slope;               /* [dB an octave of scale] from there on */
    ss_spike_kind kind;
} ss_spike;

typedef struct ss_spike_opts {
    double fmax;                /* [Hz] label of the shortest scale used; 0: 0.6 of Nyquist */
    double false_alarms;        /* expected of white noise in the whole record, > 0, <= 1 */
    double precision;           /* of a sample, re their range: weaker spikes are none  0 ... 1 */
    const ss_span *gap;         /* they reach 12 scales: the support of a wavelet an octave up */
    size_t n_gaps;
} ss_spike_opts;
extern const ss_spike_opts ss_spike_defaults;   /* 0, 0.01, 1e-7, no gaps */

typedef struct ss_spikes {
    size_t n;
    ss_spike *spike;            /* in time order */
    double threshold;           /* |W| over the rms of the noise, from false_alarms */
    double f;                   /* label of the shortest scale at which there is a spike; 0: none */
    double floor;               /* [dB] the threshold re the clearest spike, where that is clearest
                                   (bends count if the shortest scale shows them): weaker ones would
                                   not be seen; 0 where there is none */
    int conclusive;             /* 1: floor <= -6, spikes half as strong as the strongest would be
                                   seen; 0: there is too much noise to count or to group them */
} ss_spikes;

/* All spikes of the n samples of x, which must be finite.  Two that |W| does not show apart, nearer
 * to each other than some two of the scale at which they are seen, are one.  n = 0 where nothing
 * stands out of the noise. */
ss_status ss_spikes_find(ss_spikes **out, const double *x, size_t n, double rate,
                         const ss_spike_opts *opts, ss_error *err);
void ss_spikes_free(ss_spikes *found);    /* NULL is allowed */

/* The spikes of a transition that begins at onset and ends, with its last release, at end, both in
 * seconds from the first sample; jumps and kinks not more than range dB below the strongest.  One
 * nearer to onset or end than its scale is that of onset or end itself. */
typedef struct ss_spike_group {
    size_t n;                   /* spikes from onset to end, theirs included */
    size_t inside;              /* between them: more than none and the transition is grouped */
} ss_spike_group;
ss_spike_group ss_spikes_within(const ss_spikes *found, double onset, double end,
                                double range);

/* "counted", or why they are not: too much noise, or a smooth signal. */
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
    double f;                   /* label of the scale that shows them best [Hz] */
    double next;                /* [dB] of the strongest one left out re the strongest; -infinity:
                                   none that is above the noise */
    double floor;               /* [dB] re the strongest: weaker ones would not be told from noise */
} ss_bursts;

typedef struct ss_burst_opts {
    double range;               /* [dB] >= 0 */
    const ss_span *gap;         /* they reach 6 scales, the support of its wavelet */
    size_t n_gaps;
} ss_burst_opts;

/* The events of a record that is quiet for most of the time, of whatever length and shape: maxima
 * of |W| at the scale where they stand out most, not more than range below the strongest. */
ss_status ss_bursts_find(ss_bursts **out, const double *x, size_t n, double rate,
                         const ss_burst_opts *opts, ss_error *err);
void ss_bursts_free(ss_bursts *found);          /* NULL is allowed */

/* --- drops ----------------------------------------------------------------------------------- */

/* A fall of a force that a stick has loaded. */
typedef struct ss_drop {
    double t, end;              /* [s] from the first sample, of the turning points */
    double height;              /* > 0 */
} ss_drop;

typedef struct ss_drop_opts {
    double height;              /* > 0 */
    double reload;              /* rise that ends a fall; 0: a quarter of height */
    const ss_span *gap;
    size_t n_gaps;
} ss_drop_opts;

/* All falls of x by more than height, in time order; *out is to be freed with free().  A fall ends
 * where x has risen again by reload, so a slow drift is none.  Single wrong samples
 * are left out of account; white noise moves heights by some 3 % of that.  A fall that a gap cuts is
 * left out. */
ss_status ss_drops_find(ss_drop **out, size_t *n_drops, const double *x, size_t n, double rate,
                        const ss_drop_opts *opts, ss_error *err);

SS_END_DECLARATIONS
#endif
