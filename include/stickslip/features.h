/* stickslip/features.h -- from wavelet coefficients to what a contour plot shows. */
#ifndef STICKSLIP_FEATURES_H
#define STICKSLIP_FEATURES_H

#include <stddef.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>
#include <stickslip/morlet.h>
#include <stickslip/spikes.h>

SS_BEGIN_DECLARATIONS

/* A local maximum of |W| over time and scale: the middle of a closed contour. */
typedef struct ss_maximum {
    double t;               /* [s] from the first sample */
    double f;               /* label omega_c / (2 pi a) [Hz] */
    double level;           /* [dB] re the largest |W| outside the cone of influence */
    double prominence;      /* [dB] above the highest saddle towards any higher point of the map;
                               infinite where there is no way to a higher one */
} ss_maximum;

/* Coefficients must have n > 0, n_scales > 0 and translations at every scale, as all have that
 * ss_morlet_transform makes or that are read.
 *
 * All local maxima outside the cone of influence with at least the given prominence, in time order;
 * *out is to be freed with free().  Translations of neighbouring scales differ: a coefficient's
 * neighbours are those of its row and, in the two rows beside, those nearest to it in time.  What is
 * highest on the border of the map (its first and last scale, or beside the cone) is no maximum, nor
 * is what lies in the reach of a gap (ss_coefficients_edge), though saddles may. */
ss_status ss_maxima_find(ss_maximum **out, size_t *n, const ss_coefficients *coefficients,
                    double min_prominence);

/* The maxima over time of |W| along one scale, outside the cone of influence, with at least the
 * given prominence along it and not more than range dB below the highest of them: the spikes that
 * reach this high.  f is the same for all. */
ss_status ss_maxima_along(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, size_t scale,
                    double range, double min_prominence);

/* --- transitions --------------------------------------------------------------------------- */

/* A number and its standard error; NaN where it is not known. */
typedef struct ss_value {
    double value, error;
} ss_value;

/* All that happens between one macroscopic slip and the next; times [s] from the first sample. */
typedef struct ss_transition {
    double onset, end;
    int gap;                    /* 1: one reaches into it, so that spikes and end are of the rest */
    size_t spikes;              /* jumps and kinks from onset to end */
    ss_maximum maximum;         /* its local maximum; all NaN: none above the threshold */
    ss_value frequency;         /* fitted to this transition alone, damped, omega / 2 pi [Hz]; NaN
                                   where less than two periods could be fitted, as with damping_ratio */
    ss_value damping_ratio;     /* s / sqrt(omega^2 + s^2) */
    double from, to;            /* the span fitted [s], NaN if none was */
} ss_transition;

/* A slip of a force that one stick after the other loads; times [s]. */
typedef struct ss_loading {
    double t;                   /* of the maximum, from the first sample */
    ss_value slope;             /* of the loading before it [unit/s] */
    ss_value stiffness;         /* the same against the displacement [unit/m], where there is a column */
    /* of the motion of a pulled slider, fitted to the fall; NaN where that does not explain it */
    ss_value drop;              /* from the end of the stick to the next one's begin [unit] */
    ss_value duration;          /* of its middle, from 10 to 90 % */
    ss_value recurrence;        /* since the slip before began; NaN of the first */
    ss_value stick;             /* before the fall, that the force follows the line of the slope */
    ss_value static_friction, friction;     /* force at the end of the stick; friction in slip [unit] */
    ss_value k_over_m;          /* stiffness over mass [1/s^2] */
    double left, power, n;      /* sums of squares of its n samples: what that motion leaves, and
                                   about their mean [unit^2] */
} ss_loading;

/* The median of many, its standard error, and the standard deviation of the many by their median
 * deviation from it.  The error is that of the scatter, or of the errors of the many if these are
 * larger. */
typedef struct ss_median {
    double value, error, scatter;
} ss_median;

typedef struct ss_features {
    size_t n;
    ss_transition *transition;  /* in time order */
    ss_loading *loading;        /* as many, where transitions are falls of a force; else NULL */
    ss_median slope, stiffness, drop, duration, recurrence, stick;
    ss_median static_friction, friction, k_over_m;      /* of these */
    int reverses;               /* 1: transitions are reversals of a force; friction is half of its step
                                   from one to the next, stiffness that over the displacement */
    size_t n_maxima;
    ss_maximum *maximum;        /* all local maxima above the threshold, in time order */
    ss_spikes *spikes;          /* of the whole record; none of it is claimed unless conclusive */
    double noise;               /* rms of white noise of the level at the shortest scales */
    size_t recurring;           /* transitions that have a local maximum */

    ss_value slips;             /* macroscopic slips that begin in the record; the error, where it is
                                   known: of those near the height that counts as a fall */
    ss_value slip_rate;         /* [1/s] */
    ss_value repetition_frequency;      /* [Hz] at which the signal repeats itself */
    const char *why_slips, *why_ringing;        /* they are not known, or how they were found; else NULL */
    const char *why_repetition; /* it is not known; else NULL.  No text is to be freed */
    ss_value frequency_raw;     /* [Hz] the paper's reading: label of the local maxima */
    ss_value frequency;         /* [Hz] damped, one for all transitions */
    ss_value damping_ratio;
    ss_value total_stiffness_raw, total_stiffness;      /* [N/m] with a mass */
    ss_value contact_stiffness, contact_damping;        /* [N/m, N s/m] with mass and stiffness; the
                                                           damping needs the mass only */
    ss_value contact_slope;     /* [N/m] |df/dx| in the stick, with columns of force and displacement */
} ss_features;

typedef struct ss_features_opts {
    double threshold;           /* [dB] > 0: prominence that makes a local maximum */
    ss_norm norm;               /* in which it is taken */
    double mass, stiffness;     /* m [kg], k [N/m]; 0: not known */
    double drop;                /* > 0: transitions are the falls by more than this (ss_drops_find) */
    double fmin;                /* [Hz] lowest frequency of the map; 0: the lowest usable one */
    int displacement, force;    /* columns for contact_slope; -1: not there */
    int threads;                /* 1 ... SS_THREADS_MAX */
    ss_progress progress;
} ss_features_opts;
extern const ss_features_opts ss_features_defaults;     /* 80/18 dB, l2, no columns, one thread */

/* Find the transitions of one column, whose values must be finite, and what they have in common.  A
 * column that is a force by its unit or name is read by its falls, if it keeps one sign, with a
 * loading for each; by its reversals, if it repeats in mirrored half-cycles; else its slips are not
 * known.  In other columns, where an oscillation recurs, there is a transition wherever |W| swells
 * at its frequency, from the onset of the oscillation to the last spike within a period of its
 * end.  Else, if the signal repeats itself, strong spikes begin transitions, and weaker ones end
 * them; else there are the single events of ss_bursts_find, from the first to the last sample off
 * lines through what is quiet beside.  What gaps (ss_header_gaps of the signal) reach is left out:
 * local maxima nearer than sqrt(2) a, spikes and events as ss_spikes_find, ss_bursts_find and
 * ss_drops_find say; what is fitted ends there.  A record too short for any scale, or with nothing
 * in it, has none: SS_OK.  A number that does not deserve its error is NaN, for the reasons of
 * ss-features(1). opts may be NULL.  To be freed with ss_features_free. */
ss_status ss_features_find(ss_features **out, const ss_signal *signal, size_t column,
                           const ss_features_opts *opts, ss_error *err);
void ss_features_free(ss_features *features);           /* NULL is allowed */

/* Write them as text: a row a transition under notes, as ss-features(1) describes, with the column
 * and the options that they were found with.  SS_EINVAL: the format holds numbers only; SS_EIO. */
ss_status ss_features_write(const ss_features *features, const ss_signal *signal, size_t column,
                            const ss_features_opts *opts, FILE *out, ss_format format);

/* --- many recordings ----------------------------------------------------------------------- */

/* What is common to all transitions of one recording, without pointers, so that a process may hand it
 * on as it is. */
enum { SS_SUMMARY_NUMBERS = 21 };
typedef struct ss_summary {
    ss_value number[SS_SUMMARY_NUMBERS];    /* named by ss_summary_name; NaN where not known */
    char unit[64];              /* of the column, "" if it has none; a longer one is cut */
    char reason[1024];          /* why numbers are not known, or how they were found; or "" */
} ss_summary;

/* The name of a number, as in the notes of ss_features_write; NULL beyond the last. */
const char *ss_summary_name(size_t i);
/* The summary of features, of this column of the signal.  Without features (NULL), no number is known,
 * and the reason is this text (or ""). */
void ss_summary_fill(ss_summary *out, const ss_features *features, const ss_signal *signal,
                     size_t column, const char *reason);
/* Write a table: a row for each of n files, whose names have control characters replaced; then notes
 * with mean, scatter between files, scatter within a file, and number of files, of each number, as
 * ss-features(1) says.  SS_EINVAL: the format holds numbers only; SS_EIO, SS_ENOMEM. */
ss_status ss_summaries_write(const char *const file[], const ss_summary summary[], size_t n, FILE *out,
                             ss_format format);

SS_END_DECLARATIONS
#endif
