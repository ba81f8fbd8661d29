/* runs.h -- runs of a scene and their reference. */
#ifndef RUNS_H
#define RUNS_H

#include <stickslip/trade.h>

#define MARGIN 2                    /* a measured error times this is promised */
enum { TOLERANCES = 14 };
extern const double ss_trade_tolerance[TOLERANCES];     /* from 0.1 on, a tenth of the one before */

/* The compared part of a scene. */
typedef struct probe {
    ss_scene scene;
    size_t n;                       /* samples compared */
    size_t stride;                  /* one of so many of the scene's */
} probe;

typedef struct run {              /* what a run gave */
    const probe *p;
    double *x, *a;
    size_t seen;                    /* samples of the scene */
    int wants_events, no_memory;
    ss_event *event;
    size_t n_events, room;
    ss_sim_stats stats;
    double seconds;                 /* of CPU time, or what it would have taken */

    double began, budget;           /* [s] of CPU time; budget <= 0: none */
    int over;
    ss_progress progress;           /* the caller's, of the whole */
    double done, share;
} run;

/* The part of a scene that is compared. */
probe ss_trade_probe(const ss_scene *scene);

/* Room for the samples of a probe; to be freed even after a failure. */
ss_status ss_trade_run_init(run *k, const probe *p);
void ss_trade_run_free(run *k);
/* SS_EBUDGET: more than the steps or the CPU time that it may take. */
ss_status ss_trade_run(run *k, const probe *p, const char *method, double tol, unsigned long max_steps,
                       ss_error *err);

/* The two methods of the reference, both implicit if the scene is stiff; 0 if there is no such pair.
 * Pair 1 serves where pair 0 does not agree: the closed form may round more than steps do. */
int ss_trade_witnesses(const ss_scene *scene, int pair, const char *method[2]);
/* Run the reference into ref, and its witness into other; text names them. */
ss_status ss_trade_refer(run *ref, run *other, const probe *p, const char *method[2],
                         unsigned long max_steps, char text[64], ss_error *err);
/* The error of the reference from the distance of the two runs: at least rounding. */
double ss_trade_known(double distance);

/* The worst error of x over max|x|, and that with all others, into a row. */
double ss_trade_error_x(const run *k, const run *ref);
ss_status ss_trade_compare(ss_trade_row *row, const run *k, const run *ref);

#endif
