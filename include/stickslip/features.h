/* stickslip/features.h -- find transitions, local maxima and friction parameters in a signal. */
#ifndef STICKSLIP_FEATURES_H
#define STICKSLIP_FEATURES_H

#include <stddef.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>
#include <stickslip/morlet.h>
#include <stickslip/spikes.h>
#include <stickslip/table.h>

SS_BEGIN_DECLARATIONS

/* A local maximum of |W| over time and scale: the middle of a closed contour. */
typedef struct ss_maximum {
    double t;               /* [s] from the first sample */
    double f;               /* label omega_c / (2 pi a) [Hz] */
    double level;           /* [dB] re the largest |W| outside the cone of influence */
    double prominence;      /* [dB] above the highest saddle on a way to a higher point of the map;
                               infinite if there is no way to a higher point */
} ss_maximum;

/* --- transitions --------------------------------------------------------------------------- */

/* The motion between one macroscopic slip and the next; times [s] from the first sample. */
typedef struct ss_transition {
    double onset, end;
    int gap;                    /* 1: a gap reaches into it, and spikes and end are those of the rest */
    size_t spikes;              /* jumps and kinks from onset to end */
    ss_maximum maximum;         /* its local maximum; all NaN if none is above the threshold */
    ss_value frequency;         /* of the damped oscillation in this transition, omega / 2 pi [Hz]; like
                                   damping_ratio NaN if less than two periods could be fitted */
    ss_value damping_ratio;     /* s / sqrt(omega^2 + s^2) */
    double from, to;            /* the span of the fit [s]; NaN: there was no fit */
} ss_transition;

/* A slip of a force that loads in each stick and falls in each slip; times [s]. */
typedef struct ss_loading {
    double t;                   /* of the maximum, from the first sample */
    ss_value slope;             /* of the force in the loading before it [unit/s] */
    ss_value stiffness;         /* of the force over displacement there [unit/m], if there is a column
                                   of displacement */
    /* Numbers of the motion of a pulled slider, fitted to the fall; NaN if it does not explain it. */
    ss_value drop;              /* from the end of the stick to the beginning of the next [unit] */
    ss_value duration;          /* from 10 to 90 % of the fall */
    ss_value recurrence;        /* since the slip before began; NaN for the first */
    ss_value stick;             /* time before the fall in which the force follows the line of slope */
    ss_value static_friction;   /* force at the end of the stick [unit] */
    ss_value friction;          /* friction in the slip [unit] */
    ss_value k_over_m;          /* stiffness over mass [1/s^2] */
    double left, power, n;      /* n samples of the fall: the sum of squares of their residuals, and
                                   that of their deviations from their mean [unit^2] */
} ss_loading;

/* --- the numbers that a recording has as a whole ---------------------------------------------------- */

/* The events that numbers are medians of are falls or reversals of a force.  Of reversals, the friction is half of
 * the step from one to the next, and the loading stiffness is this step over the displacement.  The error of a
 * median is that of the scatter, or of the errors of the events if these are larger; that of k_over_m (stiffness
 * over mass) has the part of the scatter in it that these errors do not explain, too.  The errors of falls have in
 * them what the fits of all falls leave alike.  slip_damping is the damping ratio of the slips: the rig's, and
 * what friction does as speed grows.  The error of slips, if known, counts those near the height that
 * makes a fall.  transition_frequency_raw is the label of the local maxima, as the paper reads it, and
 * transition_frequency that of the damped oscillation, one for all transitions.  contact_stiffness needs mass and
 * stiffness, contact_damping the mass; contact_stiffness_slope is |df/dx| in the stick.
 *
 * Their list: number(NAME, name, unit, about, needs, by).
 * name: of its note.  unit: "" if it has none; NULL if it contains the unit of the column.
 * about: the note about_ABOUT says why numbers of this kind are not known, or how they were found.
 * needs: the recordings and options for which it is written; by: the function that finds it (both internal). */
#define SS_FEATURE_NUMBER_LIST(number) \
    number(SS_TRANSITIONS, "transitions", "", "slips", 0, by_search) \
    number(SS_SLIPS, "slips", "", "slips", 0, by_search) \
    number(SS_SLIP_RATE, "slip_rate", "1/s", "slips", 0, by_search) \
    number(SS_LOADING_SLOPE, "loading_slope", NULL, "slips", OF_FALLS, by_search) \
    number(SS_LOADING_STIFFNESS, "loading_stiffness", NULL, "slips", OF_EVENTS | WITH_X, by_search) \
    number(SS_DROP, "drop", NULL, "slips", OF_FALLS, by_search) \
    number(SS_DROP_DURATION, "drop_duration", "s", "slips", OF_FALLS, by_search) \
    number(SS_RECURRENCE_TIME, "recurrence_time", "s", "slips", OF_FALLS, by_search) \
    number(SS_STICK_TIME, "stick_time", "s", "slips", OF_FALLS, by_search) \
    number(SS_STATIC_FRICTION, "static_friction", NULL, "slips", OF_FALLS, by_search) \
    number(SS_FRICTION, "friction", NULL, "slips", OF_EVENTS, by_search) \
    number(SS_K_OVER_M, "k_over_m", "1/s^2", "slips", OF_FALLS, by_search) \
    number(SS_SLIP_DAMPING, "slip_damping", "", "slips", OF_FALLS, by_search) \
    number(SS_REPETITION_FREQUENCY, "repetition_frequency", "Hz", "repetition", 0, by_search) \
    number(SS_TRANSITION_FREQUENCY_RAW, "transition_frequency_raw", "Hz", "ringing", 0, by_search) \
    number(SS_TRANSITION_FREQUENCY, "transition_frequency", "Hz", "ringing", 0, by_search) \
    number(SS_DAMPING_RATIO, "damping_ratio", "", "ringing", 0, by_search) \
    number(SS_TOTAL_STIFFNESS_RAW, "total_stiffness_raw", "N/m", "ringing", WITH_MASS, ss_find_stiffness_raw) \
    number(SS_TOTAL_STIFFNESS, "total_stiffness", "N/m", "ringing", WITH_MASS, ss_find_stiffness) \
    number(SS_CONTACT_STIFFNESS, "contact_stiffness", "N/m", "ringing", WITH_MASS, ss_find_contact_stiffness) \
    number(SS_CONTACT_DAMPING, "contact_damping", "N s/m", "ringing", WITH_MASS, ss_find_contact_damping) \
    number(SS_CONTACT_STIFFNESS_SLOPE, "contact_stiffness_slope", "N/m", "ringing", WITH_X_F, ss_find_contact_slope)

#define SS_FEATURE_ENUMERATOR(NAME, name, unit, about, needs, by) NAME,
typedef enum ss_feature { SS_FEATURE_NUMBER_LIST(SS_FEATURE_ENUMERATOR) SS_FEATURE_NUMBERS } ss_feature;
#undef SS_FEATURE_ENUMERATOR

typedef struct ss_features {
    size_t n;                   /* transitions */
    ss_transition *transition;  /* in time order */
    ss_loading *loading;        /* one for each transition if these are falls of a force; else NULL */
    int reverses;               /* 1: transitions are reversals of a force */
    size_t n_maxima;
    ss_maximum *maximum;        /* all local maxima above the threshold, in time order */
    ss_spikes *spikes;          /* of the whole record; they have no meaning unless conclusive */
    double noise;               /* rms of white noise that would explain |W| at the shortest scales */
    size_t recurring;           /* the number of transitions that have a local maximum */

    ss_number number[SS_FEATURE_NUMBERS];       /* by ss_feature */
} ss_features;

typedef struct ss_features_opts {
    size_t size;                /* set by ss_features_opts_init */
    double threshold;           /* [dB] > 0: the least prominence of a local maximum */
    ss_norm norm;               /* of the |W| whose maxima are taken */
    double mass, stiffness;     /* m [kg], k [N/m]; 0: not known */
    double drop;                /* > 0: transitions are the falls by more than this */
    double fmin;                /* [Hz] the lowest frequency of the map; 0: the lowest usable one */
    int displacement, force;    /* columns for contact_stiffness_slope; -1: there is none */
    int threads;                /* 1 ... SS_THREADS_MAX */
    ss_progress progress;
} ss_features_opts;
/* 80/18 dB, l2, no columns, one thread.  size: sizeof (ss_features_opts). */
void ss_features_opts_init(ss_features_opts *opts, size_t size);

/* Find the transitions of one column, whose values must be finite, and the numbers that they have
 * in common.  The rule depends on the column:
 * - A force (by its unit or name) that keeps one sign: the transitions are its falls, with a
 *   loading for each.
 * - A force that repeats in mirrored half-cycles: they are its reversals.
 * - Any other force: its slips are not known.
 * - Another quantity, in which an oscillation recurs: a transition is where |W| grows and decays
 *   at its frequency, from the onset of the oscillation to the last spike within a period of its
 *   end.
 * - Else, if the signal repeats itself: strong spikes begin transitions, weaker spikes end them.
 * - Else they are the single events of a record that is quiet elsewhere, from the first to the last sample that
 *   lies off lines through the quiet parts before and after.
 *
 * Nothing is found near gaps (the note gaps of the signal): no local maximum nearer than sqrt(2)
 * a, no spike nearer than 12 of its scales, no single event nearer than 6, no fall over a gap;
 * fits end before a gap.  A record that is too short for any scale, or in which nothing happens,
 * has no transitions: SS_OK.  A number is NaN if its error is not reliable, for the reasons that
 * stickslip-features(7) gives.  opts may be NULL.  The caller frees *out with ss_features_free. */
ss_status ss_features_find(ss_features **out, const ss_signal *signal, size_t column,
                           const ss_features_opts *opts, ss_error *err);
void ss_features_free(ss_features *features);           /* NULL is allowed */

/* Write a text of notes and a row for each transition, as stickslip-features(7) describes.  signal,
 * column and opts are those of ss_features_find.  SS_EINVAL: the format holds numbers only;
 * SS_EIO. */
ss_status ss_features_write(const ss_features *features, const ss_signal *signal, size_t column,
                            const ss_features_opts *opts, FILE *out, ss_format format, ss_error *err);

/* --- streams --------------------------------------------------------------------------------- */

/* Write the features of a column of a signal without end, in memory for 128 periods of the lowest frequency,
 * opts->fmin, which must be given.  Each transition is written, and the caller's file flushed, when no later
 * sample can change it: at the latest two periods and 0.2 s behind its end, but for the work.  Each row tells what
 * up to 64 periods before it show, of which a search takes as many as have 8 transitions; the first rows come
 * after 16 periods.  At the end of the rows, or when opts->progress, which is called with 0, returns non-zero, the
 * rows that are left are written, and the numbers that all have in common: means over windows of 64 periods, and
 * errors that have their scatter.  SS_EINVAL: there is no fmin, or it is not below half the rate; SS_ESCALE: the
 * signal is too short for fmin. */
ss_status ss_features_follow(ss_reader *reader, size_t column, const ss_features_opts *opts, FILE *out,
                             ss_format format, ss_error *err);

/* --- many recordings ----------------------------------------------------------------------- */

/* Write the numbers of one recording as text, a table with one row, in which control characters of
 * the file's name are replaced.  If features is NULL, no number is known for this reason, and
 * signal and column are not used.  Texts of several recordings, one behind the other, are one table
 * for ss_table_read.  SS_EIO; SS_ENOMEM. */
ss_status ss_summary_write(const char *file, const ss_features *features, const ss_signal *signal,
                           size_t column, const char *reason, FILE *out, ss_error *err);
/* Write such a table in any format.  Notes behind it give, for each number, the mean, the scatter
 * between files, the scatter within a file, and the number of files, as stickslip-features(7) describes.
 * SS_EINVAL: the format holds numbers only; SS_EDATA: the table has other columns; SS_EIO. */
ss_status ss_summaries_write(const ss_table *summaries, FILE *out, ss_format format, ss_error *err);

SS_END_DECLARATIONS
#endif
