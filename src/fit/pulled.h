/* pulled.h -- the falls in the force of a spring that pulls a slider, and scenes fitted to them. */
#ifndef PULLED_H
#define PULLED_H

#include <stddef.h>
#include <stickslip/rank.h>
#include "base/progress.h"
#include "fit/column.h"

enum {
    FALLS_MOST = 16,                /* falls that are fitted */
    FALLS_FEWEST = 5                /* whose median and scatter are given */
};
#define PULLED_BUDGET 1e7           /* integration steps of a fit */

/* Samples about a fall: every step-th of y from the first. */
typedef struct fall {
    size_t first, n, step;
    double onset;                   /* [samples of y] */
    double top, middle;             /* force at the onset, and half way down [N] */
} fall;

typedef struct falls {
    double *y;                      /* the force, > 0 in the direction of the pull, without glitches [N] */
    double rate;
    size_t n;
    fall fall[FALLS_MOST];
    double first;                   /* the onset of the first fall of the record [s] */
    ss_number slope, k_over_m;      /* as the features have them; k_over_m NaN: not known */
    double noise;                   /* variance of white noise: an upper bound */
    double power;                   /* mean square of the samples about the mean of their fall */
} falls;

/* A number of the scene that all falls have in common. */
typedef struct pulled_key {
    const char *name;
    size_t offset;                  /* in ss_scene */
    int power;                      /* if a rig becomes r times stiffer and keeps its forces, the key becomes
                                       r^power times larger */
    double own;                     /* the given value (of a speed, that of the pull over the surface) */
    double change, error;           /* the logarithm of its factor in the fit, and the error of this */
} pulled_key;

typedef struct pulled_fit {
    int slips;                      /* 0: the scene does not stick and slip: no key nor median is known */
    int unfinished;                 /* 1: it took too many steps, so that a better fit may exist */
    ss_scene scene;                 /* of the medians; its slips begin with those of the record */
    size_t n_keys;                  /* the mass, the speed of the pull, and others */
    pulled_key key[SS_FIT_KEYS];
    ss_number static_friction, friction;
    residue of_samples;
} pulled_fit;

/* Why the record shows no pull in the direction of the scene's; or an empty text. */
void ss_falls_doubt(char *why, size_t room, const ss_features *features, const ss_signal *signal, size_t column,
                    const ss_scene *scene);
/* Why so many slips are too few; or an empty text. */
void ss_falls_count(char *why, size_t room, size_t slips, const ss_features *features);
/* Gather the falls of a column; they are not usable if `why` is not empty.  To be freed with ss_falls_free
 * in either case. */
ss_status ss_falls_gather(falls *out, char *why, size_t room, const ss_features *features,
                          const ss_signal *signal, size_t column, const ss_scene *scene);
void ss_falls_free(falls *r);

/* Fit mass, speed of the pull, damping (if the scene has one) and the model's own parameters of all falls,
 * and onset, f_s and f_k of each fall.  spread: the logarithm of the factor within which the scene knows its
 * own numbers; INFINITY: it does not know them.  SS_ENOMEM, SS_STOP. */
ss_status ss_pulled_fit(pulled_fit *out, const falls *falls, const ss_scene *scene, double spread,
                        const ss_stretch *progress);

/* pull.c: SS_OK for a scene that is pulled and a column of the force of its spring. */
ss_status ss_pull_check(const ss_signal *signal, size_t column, const ss_scene *scene, const ss_rank_opts *opts,
                        ss_error *err);
/* pull_rank.c: rank the scenes of r's rows: fill these in the order of their totals, the scene that is named
 * first, its noise and its verdict. */
ss_status ss_pull_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                          const ss_rank_opts *opts, ss_error *err);

#endif
