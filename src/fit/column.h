/* column.h -- the samples to which a motion is fitted: their power, their noise, their distance
 * from a sinusoid; and those of a scene's motion. */
#ifndef COLUMN_H
#define COLUMN_H

#include <stddef.h>
#include <stickslip/rank.h>
#include <stickslip/sim.h>
#include "fit/verdict.h"

#define RANK_SPREAD 0.3             /* the usual spread of a rig's parameters */

typedef struct rank_record {
    const double *x;            /* n samples */
    const char *missing;        /* 1 for samples that are left out; NULL: none */
    size_t n;
    double rate;                /* [Hz] */
    double from;                /* time of x[0] in the record whose cycle was searched [s] */
    double noise;               /* variance, an upper bound: see ss_record_noise */
    double steps;               /* variance that a converter's steps leave */
} rank_record;

/* own becomes the caller's options, or the defaults for NULL.  SS_EINVAL. */
ss_status ss_rank_opts_take(ss_rank_opts *own, const ss_rank_opts *given, ss_error *err);
/* SS_OK for a column that is there, has finite values and suits the options. */
ss_status ss_column_check(const ss_signal *signal, size_t column, const ss_rank_opts *opts, ss_error *err);
/* SS_OK for a column that has no unit, or the unit that scenes have: the sizes of both are compared. */
ss_status ss_column_check_unit(const ss_signal *signal, size_t column, ss_quantity quantity, ss_error *err);
/* The variance of the samples. */
double ss_record_power(const rank_record *r);
/* Set r->noise and r->steps of a record that repeats after so many samples; 0: nothing repeats. */
ss_status ss_record_noise(rank_record *r, double samples);
/* Find the mean square residual of the best sinusoid of this frequency [Hz] with an offset.  SS_ENOMEM. */
ss_status ss_record_sinusoid(const rank_record *r, double frequency, double *left);

/* --- the motion of a scene, with the accuracy and cost that a comparison needs ------------------ */

enum { SAMPLES_REACH = 18 };        /* samples */
enum { SAMPLES_A_STEP = 4 };        /* samples that cost about as much as an integration step */
#define SAMPLES_FINE 1e-7           /* tolerances: for differences of two motions, and for their sizes */
#define SAMPLES_COARSE 1e-5

/* The method and limits of a run whose samples or events are compared. */
ss_sim_opts ss_samples_opts(const ss_scene *scene, double tol);

/* The n samples of a scene's record, of the quantity pick; without a closed form their error is
 * some thirty times the tolerance.  clear[i], unless clear is NULL, becomes the distance of sample
 * i from the nearest event, in samples; infinite beyond SAMPLES_REACH.  *steps grows by the cost.
 * Fails as ss_sim_run, or with SS_EDATA. */
ss_status ss_samples_run(const ss_scene *scene, int pick, double tol, double *value, double *clear,
                         size_t n, double *steps);

#endif
