/* stickslip/rank.h -- which scene explains a signal best, and the scene that fits it. */
#ifndef STICKSLIP_RANK_H
#define STICKSLIP_RANK_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/status.h>
#include <stickslip/scene.h>
#include <stickslip/signal.h>
#include <stickslip/features.h>

SS_BEGIN_DECLARATIONS

/* The quantity of a signal, in the order of the columns of ss_sim_columns.  SS_SPRING is the force of
 * the spring, k (z - x). */
typedef enum ss_quantity {
    SS_DISPLACEMENT, SS_VELOCITY, SS_ACCELERATION, SS_FORCE, SS_SPRING
} ss_quantity;

/* A criterion compares a number of the signal with the same number of each scene. */
typedef enum ss_criterion {
    SS_BY_RESIDUAL,             /* power that the scene leaves of the mean cycle, above the least [dB] */
    SS_BY_ADJUSTMENT,           /* rms change of the scene's parameters, in units of the spread */
    SS_BY_MAXIMUM,              /* part of the transitions that have a local maximum */
    SS_BY_FREQUENCY,            /* natural logarithm of the frequency in transitions */
    SS_BY_DAMPING,              /* natural logarithm of the damping ratio in transitions */
    SS_BY_JUMP,                 /* largest |W| at the shortest scale re the largest of all [dB] */
    SS_BY_SPIKES,               /* spikes per transition */
    SS_BY_SLOPE,                /* slope of the spikes across scales [dB per octave] */
    SS_BY_STIFFNESS,            /* natural logarithm of df/dx in the stick, with columns x and f */
    SS_BY_MAP,                  /* rms difference of the contour maps [dB] */
    SS_CRITERIA
} ss_criterion;

enum { SS_QUANTITIES = SS_SPRING + 1 };
extern const char *const ss_quantity_names[SS_QUANTITIES + 1];     /* "x", "v", "a", "f", "s", NULL */

typedef struct ss_rank_opts {
    size_t size;                /* set by ss_rank_opts_init */
    ss_quantity quantity;       /* of the column */
    double spread;              /* 0 <= spread < 1: the parameters of the rig are those of the scene
                                   within a factor of 1 - spread to 1 + spread */
    double forcing_frequency;   /* [Hz]; 0: found in the signal from what repeats */
    int also[SS_QUANTITIES];    /* for each quantity the index of another column of the same recording,
                                   which the answer must explain too with the same parameters, or -1 */
    ss_progress progress;
} ss_rank_opts;
void ss_rank_opts_init(ss_rank_opts *opts, size_t size);   /* acceleration, 0.3, found, no others */

typedef struct ss_rank_row {
    size_t scene;               /* its index among the scenes given */
    ss_scene adjusted;          /* parameters within the spread; phase of the cycles compared */
    double explained;           /* the part of the signal's power about its mean that it explains; with
                                   pulls, of the power of the samples near the slips */
    double excess;              /* mean square of the residual over that of the noise */
    double value[SS_CRITERIA];      /* of the adjusted scene; NaN where it has none */
    double distance[SS_CRITERIA];   /* from the signal, >= 0; NaN where only one has a value */
    double total;               /* NaN: nothing was compared, rows have no values and keep their order */
} ss_rank_row;

typedef enum ss_verdict {
    SS_UNDECIDED,               /* `why` gives the reason */
    SS_NAMED,                   /* the first row's scene explains the signal: its residual is noise,
                                   and no scene of another model has as small a residual */
    SS_NONE_FITS,               /* each scene leaves more than the noise; `why` says how much */
    SS_NOT_JUDGED               /* of a motion: it cannot show a law; the answer says why */
} ss_verdict;

typedef struct ss_ranking {
    ss_verdict verdict;
    char why[256];              /* the reason of the verdict; empty if a scene is named */
    double value[SS_CRITERIA];  /* of the signal; NaN where it has none */
    double forcing_frequency;   /* [Hz]; NaN: nothing repeats, rows have no values and keep their order */
    double noise;               /* power of the noise over that of the signal, at most; NaN as above */
    size_t n;
    ss_rank_row *row;           /* best first */
} ss_ranking;

/* Rank n >= 1 scenes by one column of a signal, whose values must be finite.
 *
 * A forced scene is adjusted within the spread, first to the signal's mean cycle and then to the
 * samples of some cycles.  It is then run with white noise of the signal's level and with its
 * gaps, and compared.  Samples near gaps are left out of both, as in ss_features_find.  Noise is
 * the part of the signal that is neither slow nor repeated, see stickslip-rank(7).
 *
 * A pulled scene needs the spring's force as column.  It is adjusted to the falls of the force;
 * only the residual and the adjustment are compared.  If there are scenes of both kinds, the
 * verdict is about those of the signal's kind, and rows of the other kind have no total.
 *
 * "None fits" and "undecided" are answers, with SS_OK.  SS_EBUDGET: a forced scene takes more than
 * 2e7 integration steps to be adjusted.  opts may be NULL.  The caller frees *out with
 * ss_ranking_free. */
ss_status ss_ranking_new(ss_ranking **out, const ss_signal *signal, size_t column, const ss_scene *scene,
                  size_t n, const ss_rank_opts *opts, ss_error *err);
void ss_ranking_free(ss_ranking *ranking);      /* NULL is allowed */

/* Facts for the text of a ranking that the ranking itself does not have. */
typedef struct ss_ranking_text {
    const char *signal;         /* the name of the signal */
    const char *column;         /* the name of the column that was ranked */
    const char *known_by;       /* how the column's quantity was found: "its unit" */
    const char *const *scene;   /* the names of the scenes, in the order in which they were given */
    int brief;                  /* 1: the answer, and of each scene the total, the residual and the worst
                                   criterion; 0: every criterion, and orders by other thresholds */
} ss_ranking_text;

/* Write the text of a ranking, as ss-rank(1) describes; opts are those of ss_ranking_new, or NULL.
 * No name may contain a tab or a newline.  ss_table_read reads it (SS_KIND_RANKING).  SS_EINVAL:
 * there is nothing to rank, or the format holds numbers only; SS_EIO; SS_ENOMEM. */
ss_status ss_ranking_write(const ss_ranking *ranking, const ss_ranking_text *about,
                           const ss_rank_opts *opts, FILE *out, ss_format format, ss_error *err);

/* --- the scene that fits ------------------------------------------------------------------- */

/* A number of a scene that a fit has adjusted. */
typedef struct ss_fitted {
    const char *name, *unit;    /* of the scene's key */
    ss_value found;             /* with its standard error; NaN if the fit is not conclusive */
    double given;               /* in the scene that the fit began with */
} ss_fitted;
enum { SS_FIT_KEYS = 5 };       /* at most */

typedef struct ss_fit {
    int conclusive;             /* 0: the parameters are not determined, and scene is the one given */
    char why[256];              /* the reason if the fit is not conclusive, else empty */
    ss_scene scene;             /* settled; its motion has the phase of the record */
    ss_fitted key[SS_FIT_KEYS];     /* friction, base_amplitude, base_frequency, contact_stiffness,
                                       contact_damping */
    double residual;            /* rms of record minus scene, over the rms of the record about its mean */
    double residual_started;    /* the same if the motion may start from any state; if this residual is
                                   more than noise, the model does not fit */
    double noise;               /* rms of the noise in the record over the rms of the record, at most */
} ss_fit;

/* Fit a compliant scene to a column without a unit or in SI units, whose values must be finite.
 *
 * f_k, Z_e, K_y, c and the frequency and phase of the base are adjusted; m, k, damping, f_s / f_k
 * and the release rule are those of the scene.  Samples in gaps are left out.  Standard errors
 * assume white noise of the size of the residual.  The fit is conclusive if its residual is no
 * more than noise, no other scene has as small a residual, its sticks last long enough, and no
 * other damping or f_s / f_k explains the record better.
 *
 * A fit that is not conclusive is an answer, with SS_OK.  opts may be NULL; its spread and other
 * columns are not used.  SS_EINVAL: the model is another; SS_EDATA: the column is in another unit,
 * or a value is not finite; SS_EBUDGET: the scenes to try take more
 * than 1e8 integration steps, where four samples count as a step. */
ss_status ss_scene_fit(ss_fit *fit, const ss_signal *signal, size_t column, const ss_scene *start,
                       const ss_rank_opts *opts, ss_error *err);

/* --- a slider pulled at constant speed ------------------------------------------------------ */

/* left, excess and noise are NaN if there is no slip. */
typedef struct ss_pull {
    ss_verdict verdict;         /* SS_NAMED: the scene explains three of four falls, and at least five */
    char why[256];              /* the reason of the verdict; empty if the scene is named */
    ss_scene scene;             /* begins to slip with the record; its later slips need not coincide */
    size_t n_slips;             /* falls of the force that are fitted */
    double left;                /* part of the power of their samples that the fit leaves */
    double excess;              /* the power that the fit leaves, over that of the noise */
    int explains;               /* 1: the residual is noise; 0: the friction is not that of the scene */
    double noise;               /* power of the noise over that of the record, at most */
    ss_features *features;      /* its loadings are the slips [N], their medians the scene's numbers */
    ss_number static_friction, friction;        /* [N] of the slips */
    size_t n_keys;              /* 0: the model is Coulomb's without damping, all is in features */
    ss_fitted key[SS_FIT_KEYS];     /* what all slips have in common */
} ss_pull;

/* Fit a scene that only a pull or a belt moves to the force of its spring [N].
 *
 * Coulomb's model without damping is fitted event by event: f_s and f_k, the mass (from k/m) and
 * the speed (from the slope of loading) are medians; the stiffness is that of the scene.  Other
 * models are simulated: the numbers in key are fitted to up to 16 falls together, f_s and f_k to
 * each fall; and SS_NAMED also requires that no error exceeds 30 %.
 *
 * A scene that does not explain the record is an answer, with SS_OK.  opts may be NULL; its
 * quantity must be SS_SPRING.  SS_EINVAL: another scene or column, or an elastic contact;
 * SS_EDATA: the column is not in N.  The caller frees *out with ss_pull_free. */
ss_status ss_pull_fit(ss_pull **out, const ss_signal *signal, size_t column, const ss_scene *start,
                      const ss_rank_opts *opts, ss_error *err);
void ss_pull_free(ss_pull *pull);               /* NULL is allowed */

/* --- the law of a contact whose motion and force were measured ------------------------------- */

/* Where the rows lie that a law is not fitted to, but judged by.  By default the second half, and then the first;
 * or every other piece of some cycles, if the halves visit other ranges of the motion. */
typedef enum ss_folds { SS_FOLDS_BY_RANGE, SS_FOLDS_HALVES, SS_FOLDS_INTERLEAVED } ss_folds;

typedef struct ss_motion_opts {
    size_t size;                /* set by ss_motion_opts_init */
    const double *time;         /* [s] of each row, ascending; NULL: the signal's clock */
    int is_velocity;            /* 1: the motion is a velocity, else a displacement or an angle */
    double angle;               /* radians in a unit of an angle, whose sine and cosine, and the size of the
                                   speed, then stand beside each law; 0: they do not */
    double delay;               /* rows: the force may be so much earlier or later than the motion, >= 0 */
    ss_folds folds;
    const char *const *without; /* names of laws that are left out, behind the last NULL; NULL: none */
    ss_progress progress;
} ss_motion_opts;
void ss_motion_opts_init(ss_motion_opts *opts, size_t size);    /* a displacement, delay 1, all laws */

typedef struct ss_motion_row {
    const char *law;
    double explained;           /* the share of the force's power about a line that it explains where it was not
                                   fitted, */
    double explained_error;
    double gain;                /* and of what the null leaves */
    double residual;            /* mean square that it leaves where it was fitted, over that of the noise */
    double repeat;              /* correlation of what it leaves with the same place of other cycles */
    int tied;                   /* 1: no law is better by more than errors */
} ss_motion_row;

/* A number of the law that is named. */
typedef struct ss_motion_number {
    const char *name;           /* the key of a scene; or tilt, inertia, sine, cosine, viscous_difference, offset,
                                   drift, delay */
    ss_value value;             /* in the recording's units; of the second direction in name_negative */
    char unit[64];              /* "" if the recording has none */
} ss_motion_number;
enum { SS_MOTION_NUMBERS = 17 };

typedef struct ss_motion_ranking {
    ss_verdict verdict;
    char answer[256];           /* "compliant-gap explains ..."; what cannot be told, or judged, and why */
    char confounded[256];       /* what the recording cannot separate; "": nothing found */
    int sign;                   /* -1: the force acts on what moves, against the motion; else 1 */
    int interleaved;            /* 1: the folds are pieces */
    size_t clipped;             /* rows whose force is at the end of its range, and was left out */
    size_t n;
    ss_motion_row row[SS_MOTION_NUMBERS];       /* the named law first, else the one that explains most */
    ss_scene scene;             /* of the named law, without mass and stiffness; no model: none is named, or its
                                   units are not known; of a bouc-wen with two sides the first */
    size_t n_numbers;
    ss_motion_number number[SS_MOTION_NUMBERS];
    size_t rows;                /* 0: nothing was compared */
    double *time, *predicted;   /* of each row: [s], and the force by the first law */
} ss_motion_ranking;

/* Rank friction laws by how well each, driven by the measured motion, predicts the force; the columns' values must
 * be finite.  stickslip-rank(7) describes how.  Every answer is SS_OK.  The caller frees *out with
 * ss_motion_ranking_free.  SS_EINVAL: an option is out of its range, or the times do not ascend. */
ss_status ss_motion_ranking_new(ss_motion_ranking **out, const ss_signal *signal, size_t motion, size_t force,
                                const ss_motion_opts *opts, ss_error *err);
void ss_motion_ranking_free(ss_motion_ranking *ranking);        /* NULL is allowed */
/* Write its text, as ss-rank(1) describes. */
ss_status ss_motion_ranking_write(const ss_motion_ranking *ranking, FILE *out, ss_format format, ss_error *err);

SS_END_DECLARATIONS
#endif
