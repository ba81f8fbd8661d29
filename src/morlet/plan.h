/* plan.h -- what the files of the wavelet transform share. */
#ifndef PLAN_H
#define PLAN_H

#include <stickslip/morlet.h>

struct ss_morlet {
    ss_morlet_opts opts;
    size_t n;               /* samples */
    double rate;            /* [Hz] */
    size_t n_scales;
    ss_scale *scale;        /* long to short */
    size_t total;           /* coefficients */
};

/* SS_OK if every option lies in its range and n samples at this rate are a record. */
ss_status morlet_check(size_t n, double rate, const ss_morlet_opts *opts, ss_error *err);

/* Fill in scale j of the grid but for its offset; a NaN means 2^(j/V).  SS_EINVAL if its
 * translations are too many to count. */
ss_status morlet_scale(ss_scale *scale, int j, double a, size_t n, double rate,
                       const ss_morlet_opts *opts, ss_error *err);

#endif
