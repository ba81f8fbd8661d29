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

/* The quantity of a signal, in the order of the columns of ss_sim_row; SS_SPRING is k (z - x). */
typedef enum ss_quantity {
    SS_DISPLACEMENT, SS_VELOCITY, SS_ACCELERATION, SS_FORCE, SS_SPRING
} ss_quantity;

/* Models are judged by a number of the signal, the same of each scene, and their distance. */
typedef enum ss_criterion {
    SS_BY_RESIDUAL,             /* power of the mean cycle that is left, above the least [dB] */
    SS_BY_ADJUSTMENT,           /* of the scene's parameters, rms in units of the spread */
    SS_BY_MAXIMUM,              /* part of the transitions with a local maximum */
    SS_BY_FREQUENCY,            /* of the transition oscillation, as a natural logarithm */
    SS_BY_DAMPING,              /* its damping ratio, as a natural logarithm */
    SS_BY_JUMP,                 /* largest |W| at the shortest scale re the largest of all [dB] */
    SS_BY_SPIKES,               /* spikes a transition */
    SS_BY_SLOPE,                /* of the spikes across scales [dB an octave] */
    SS_BY_STIFFNESS,            /* df/dx in the stick, as a natural logarithm, with x and f */
    SS_BY_MAP,                  /* rms difference of the contour maps [dB] */
    SS_CRITERIA
} ss_criterion;

/* A score is distance over threshold, at most SS_SCORE_MOST; what only one of signal and scene has
 * scores 1, what neither has 0.  The total is the sum of weight times score. */
typedef struct ss_criterion_rule {
    const char *name, *unit;    /* "residual", "dB" */
    double threshold, weight;
} ss_criterion_rule;
extern const ss_criterion_rule ss_criterion_rules[SS_CRITERIA];
#define SS_SCORE_MOST 3

enum { SS_QUANTITIES = SS_SPRING + 1 };
extern const char *const ss_quantity_names[SS_QUANTITIES + 1];     /* "x", "v", "a", "f", "s", NULL */

typedef struct ss_rank_opts {
    ss_quantity quantity;       /* of the column */
    double spread;              /* the parameters of the rig are within a factor 1 -+ spread
                                   of those of the scene  0 <= spread < 1 */
    double forcing_frequency;   /* [Hz]; 0: found from what repeats */
    int also[SS_QUANTITIES];    /* index of another column of this quantity in the same recording, or
                                   -1: the answer must explain it, too, with the same parameters */
    ss_progress progress;
} ss_rank_opts;
extern const ss_rank_opts ss_rank_defaults;     /* acceleration, 0.3, found, no others */

typedef struct ss_rank_row {
    size_t scene;               /* its index among those given */
    ss_scene adjusted;          /* parameters within the spread, phase of the signal's compared cycles */
    double explained;           /* part of the signal's power about its mean that it explains; of pulls,
                                   of the power of the samples about the slips */
    double excess;              /* mean square of the residual over that of the noise */
    double value[SS_CRITERIA];      /* of the adjusted scene; NaN where it has none */
    double distance[SS_CRITERIA];   /* from the signal, >= 0; NaN where only one has a value */
    double total;               /* NaN: nothing was compared, and rows are as given without values */
} ss_rank_row;

typedef enum ss_verdict {
    SS_UNDECIDED,               /* `why` gives the reason */
    SS_NAMED,                   /* the first row's scene explains the signal: its residual is noise,
                                   and no scene of another model has as small a residual */
    SS_NONE_FITS                /* each scene leaves more than the noise; `why` tells how much */
} ss_verdict;

typedef struct ss_ranking {
    ss_verdict verdict;
    char why[256];              /* empty if one is named */
    double value[SS_CRITERIA];  /* of the signal; NaN where it has none */
    double forcing_frequency;   /* [Hz]; NaN: nothing repeats, rows are as given without values */
    double noise;               /* power of the noise over that of the signal, at most; NaN as above */
    size_t n;
    ss_rank_row *row;           /* best first */
} ss_ranking;

/* Rank n >= 1 scenes by one column of a signal, whose values must be finite.  Those that are forced
 * are adjusted within the spread to the signal's mean cycle and then to the samples of some
 * cycles, run with white noise of the signal's own level and its gaps, and compared; what lies
 * within the reach of a gap is left out of both, as ss_features_find does.  Noise is what is
 * neither slow nor repeated, see ss-rank(1).  Those that are pulled, if the column is the spring's
 * force, are adjusted to its falls, and only what they leave and the adjustment are compared.  If there
 * are both, the verdict is that of the kind of the signal; rows of the other have no total.  "None
 * fits" and "undecided" are answers, with SS_OK.  SS_EBUDGET for a forced scene that takes more than
 * 2e7 integration steps to be adjusted.  opts may be NULL.  To be freed with ss_ranking_free. */
ss_status ss_ranking_new(ss_ranking **out, const ss_signal *signal, size_t column, const ss_scene *scene,
                  size_t n, const ss_rank_opts *opts, ss_error *err);
void ss_ranking_free(ss_ranking *ranking);      /* NULL is allowed */
/* Score of a row by one criterion with its threshold multiplied by factor. */
double ss_rank_score(const ss_rank_row *row, ss_criterion criterion, double factor);
/* Write to order[0 ... n-1] the indices of the rows as they would be ordered with one threshold
 * multiplied by factor.  1 if that order differs from the present one. */
int ss_ranking_order(const ss_ranking *ranking, ss_criterion criterion, double factor,
                     size_t *order);

/* Facts for the text of a ranking that the ranking itself does not hold. */
typedef struct ss_ranking_text {
    const char *signal;         /* names of the signal and of the column that was ranked */
    const char *column;
    const char *known_by;       /* how the column's quantity was found: "its unit" */
    const char *const *scene;   /* names of the scenes, in the order in which they were given */
} ss_ranking_text;

/* Write it as text, as ss-rank(1) describes; opts are those of ss_ranking_new, or NULL.  No name may
 * hold a tab or the end of a line.  SS_EINVAL: nothing to rank, or the format holds numbers only;
 * SS_EIO, SS_ENOMEM.  ss_table_read reads it as a "ranking". */
ss_status ss_ranking_write(const ss_ranking *ranking, const ss_ranking_text *about,
                           const ss_rank_opts *opts, FILE *out, ss_format format);

/* --- the scene that fits ------------------------------------------------------------------- */

typedef struct ss_fit {
    int conclusive;             /* 0: the parameters are not determined, scene is the one given */
    char why[256];              /* the reason, if it is not conclusive */
    ss_scene scene;             /* settled, in step with the record from its first sample */
    ss_value friction, base_amplitude;      /* with standard errors; NaN if not conclusive */
    ss_value contact_stiffness, contact_damping;
    ss_value base_frequency;
    double residual;            /* rms of record minus scene, over the rms of the record about its mean */
    double residual_started;    /* the same if the motion may start from any state: this residual
                                   is noise, or the model does not fit */
    double noise;               /* rms of the noise in the record over its own, at most */
} ss_fit;

/* Adjust f_k, Z_e, K_y, c and the frequency and phase of the base of a compliant scene to a column
 * of SI units, whose values must be finite; m, k, damping, f_s / f_k and the release rule are taken from
 * the scene.
 * Samples in gaps are left out.  Errors are those of white noise of the residual's size.  The fit
 * is conclusive if its residual is no more than noise, no other scene has as small a residual, and
 * its sticks last long enough.  A fit that is not conclusive is an answer, with SS_OK.  opts may be
 * NULL; its spread and other columns are not used.  SS_EINVAL for another model, SS_EBUDGET where
 * the scenes to be tried take more than 1e8 integration steps, of which four samples count as one. */
ss_status ss_scene_fit(ss_fit *fit, const ss_signal *signal, size_t column, const ss_scene *start,
                       const ss_rank_opts *opts, ss_error *err);

/* --- a slider pulled at constant speed ------------------------------------------------------ */

/* A number of the scene that all slips have in common. */
typedef struct ss_pull_key {
    const char *name, *unit;
    ss_value found;
    double given;
} ss_pull_key;
enum { SS_PULL_KEYS = 5 };

typedef struct ss_pull {
    ss_verdict verdict;         /* SS_NAMED: the scene explains three of four falls, and at least five */
    char why[256];              /* empty if it does */
    ss_scene scene;             /* begins to slip with the record, then goes its own way */
    size_t n_slips;             /* falls of the force that are fitted */
    double left;                /* part of the power of their samples that these leave */
    double excess;              /* the same over the noise */
    int explains;               /* what they leave is noise; else friction is not that of the scene */
    double noise;               /* power of the noise over that of the record, at most; all NaN: no slip */
    ss_features *features;      /* its loadings are the events [N], their medians the scene's */
    ss_median static_friction, friction;        /* [N] of the slips */
    size_t n_keys;              /* 0: it is Coulomb's without damping, and all is in features */
    ss_pull_key key[SS_PULL_KEYS];
} ss_pull;

/* Fit a scene that only a pull or a belt moves to the force of its spring [N].  Coulomb's without
 * damping goes event by event: f_s and f_k, the mass by k/m and the speed by the slope of loading are
 * medians; the stiffness is that given.  Others are simulated: what key lists is fitted to up to 16
 * falls together, f_s and f_k to each, and SS_NAMED are those with no error above 30 %.  A scene that
 * does not explain the record is an answer, with SS_OK.  opts may be NULL; its quantity must be
 * SS_SPRING.  SS_EINVAL for another scene or column, or an elastic contact.  To be freed with ss_pull_free. */
ss_status ss_pull_fit(ss_pull **out, const ss_signal *signal, size_t column, const ss_scene *start,
                      const ss_rank_opts *opts, ss_error *err);
void ss_pull_free(ss_pull *pull);               /* NULL is allowed */

SS_END_DECLARATIONS
#endif
