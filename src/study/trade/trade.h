/* trade.h -- runs of a scene and their reference, and what measurements of a scene and of a transform share. */
#ifndef TRADE_H
#define TRADE_H

#include <stickslip/trade.h>

#define MARGIN 2                    /* the promised error is the measured one times this */
enum { TOLERANCES = 14 };
extern const double ss_trade_tolerance[TOLERANCES];     /* 0.1, 0.01, ... */

/* The part of a scene that is compared. */
typedef struct probe {
    ss_scene scene;
    size_t n;                       /* samples compared */
    size_t stride;                  /* of so many samples of the scene, one is compared */
} probe;

typedef struct run {              /* what a run gave */
    const probe *p;
    double *x, *a;
    size_t seen;                    /* samples of the scene */
    int wants_events, no_memory;
    ss_event *event;
    size_t n_events, room;
    ss_sim_stats stats;
    double seconds;                 /* CPU time, or an estimate of it */

    double began, budget;           /* [s] of CPU time; budget <= 0: no limit */
    int over;                       /* 1: the run has used up its budget */
    ss_progress progress;           /* of the whole work, from the caller */
    double done, share;             /* the parts of it that precede this run, and that are this run */
} run;

/* The part of a scene that is compared. */
probe ss_trade_probe(const ss_scene *scene);

/* Run a probe, always the same with one k, which is to be freed even after a failure.  SS_EBUDGET: it needs more
 * steps or CPU time than it is allowed. */
ss_status ss_trade_run(run *k, const probe *p, const char *method, double tol, unsigned long max_steps,
                       ss_error *err);
void ss_trade_run_free(run *k);

/* Run the reference into ref, and its witness into other; text names them.  The methods are
 * a pair of ss_method_pair. */
ss_status ss_trade_refer(run *ref, run *other, const probe *p, const char *method[2],
                         unsigned long max_steps, char text[64], ss_error *err);
/* The error of the reference from the distance of the two runs: at least rounding. */
double ss_trade_known(double distance);

/* The largest error of x over max|x|; and all errors, into a row. */
double ss_trade_error_x(const run *k, const run *ref);
ss_status ss_trade_compare(ss_trade_row *row, const run *k, const run *ref);

/* What is compared: "x", "x_rms", ...; NULL behind the last.  Its unit: "dB"; "" of a number or a ratio. */
const char *ss_compared_name(size_t i);
const char *ss_compared_unit(size_t i);

/* 1 if a row keeps all n needs. */
int ss_models_keeps(const ss_models_row *row, const ss_need *need, size_t n);

/* own becomes the caller's options, with defaults for what is missing. */
ss_status ss_trade_opts_take(ss_trade_opts *own, const ss_trade_opts *given, ss_error *err);
/* The CPU time of this thread [s]. */
double ss_trade_cpu_time(void);
/* Run row i, which is measured, or again: only its time counts.  done is the part of the whole work that is
 * done.  *seconds becomes its time; NaN: it was not measured, and is not run again. */
typedef ss_status ss_trade_runner(size_t i, int again, double done, double *seconds, void *user);
/* Run n rows one after the other, then short ones again, in turns, so that a disturbance of the machine affects
 * all of them alike.  *seconds becomes an array of the times, medians of those of short rows. */
ss_status ss_trade_race(double **seconds, size_t n, ss_trade_runner *runner, const ss_progress *progress,
                        void *user);
/* Let the rows of a trade race: they get their times, and those that no other row beats are marked. */
ss_status ss_trade_time(ss_trade *trade, ss_trade_runner *runner, const ss_progress *progress, void *user);
/* *out becomes the trade, or it is freed if the measurement did not succeed.  Returns its status. */
ss_status ss_trade_give(ss_trade **out, ss_trade *trade, ss_status st, ss_error *err);

#endif
