/* falls.h -- the falls of a spring's force, and scenes fitted to them by simulation. */
#ifndef FALLS_H
#define FALLS_H

#include <stddef.h>
#include <stickslip/rank.h>
#include "base/progress.h"

enum {
    FALLS_MOST = 16,                /* falls that are fitted */
    FALL_UNKNOWNS = 3               /* of each: its onset, f_k, f_s - f_k */
};

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
    ss_median slope, k_over_m;      /* as the features have them; k_over_m NaN: not known */
    double noise;                   /* variance of white noise: an upper bound */
    double power;                   /* mean square of the samples about the mean of their fall */
} falls;

/* A number of the scene that all falls have in common. */
typedef struct falls_key {
    size_t offset;                  /* in ss_scene */
    int power;                      /* if a rig becomes r times stiffer and keeps its forces, the key becomes
                                       r^power times larger */
    double own;                     /* the given value (of a speed, that of the pull over the surface) */
    double change, error;           /* the logarithm of its factor in the fit, and the error of this */
} falls_key;
enum { FALLS_KEYS = SS_FIT_KEYS };

typedef struct falls_fit {
    int slips;                      /* 0: the scene does not stick and slip, and nothing else is set */
    ss_scene scene;                 /* of the medians; its slips begin with those of the record */
    size_t n_keys;                  /* the mass, the speed of the pull, and others */
    falls_key key[FALLS_KEYS];
    ss_median static_friction, friction;
    double left;                    /* mean square of the residuals of the samples compared */
    size_t compared;
} falls_fit;

/* Gather the falls of a column, in direction 1 or -1; out->n = 0 if none is usable.  To be freed with
 * ss_falls_free. */
ss_status ss_falls_gather(falls *out, const ss_features *features, const ss_signal *signal, size_t column,
                          double direction);
void ss_falls_free(falls *r);

/* Fit mass, speed of the pull, damping (if the scene has one) and the model's own parameters of all falls,
 * and onset, f_s and f_k of each fall.  spread: the logarithm of the factor within which the scene knows its
 * own numbers; INFINITY: it does not know them.  *steps grows by the cost, and the fit ends unfinished beyond
 * the budget.  SS_ENOMEM, SS_STOP. */
ss_status ss_falls_fit(falls_fit *out, const falls *falls, const ss_scene *scene, double spread,
                       double budget, double *steps, const ss_stretch *progress);

#endif
