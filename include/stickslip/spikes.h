/* stickslip/spikes.h -- the times at which a signal is not smooth: jumps, kinks, glitches.
 *
 * A spike is a maximum of |W| over time that is present at each of the shortest usable scales.  Two spikes
 * that are nearer to each other than about two of the scales that show them have one maximum of |W|, and are
 * one.  No spike is found within 12 scales of a gap: this is the support of a wavelet one octave longer. */
#ifndef STICKSLIP_SPIKES_H
#define STICKSLIP_SPIKES_H

#include <stddef.h>
#include <stickslip/status.h>

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

typedef struct ss_spikes {
    size_t n;
    ss_spike *spike;            /* in time order */
    double threshold;           /* the least snr of a spike: noise alone has .01 such spikes in a record */
    double f;                   /* label of the shortest scale that has a spike; 0: no scale has */
    double floor;               /* [dB] the threshold relative to the clearest spike, at the scale where
                                   it is clearest; weaker spikes cannot be seen.  Bends count if the
                                   shortest scale shows them.  0: there is no spike */
    int conclusive;             /* 1: floor <= -6, so that a spike half as strong as the strongest is
                                   seen; 0: too much noise to count or to group spikes */
    const char *verdict;        /* constant text: "counted", or why they are not: there is too much noise, the
                                   signal is smooth, or the recording is too short */
} ss_spikes;

SS_END_DECLARATIONS
#endif
