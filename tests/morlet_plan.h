/* morlet_plan.h -- plans and what they give, as the tests of the transform need them. */
#ifndef MORLET_PLAN_H
#define MORLET_PLAN_H

#include "morlet_oracle.h"
#include "unit.h"

#define LENGTH(a) (sizeof (a) / sizeof *(a))

/* A plan that must be possible; the coefficients of x by it. */
static inline ss_morlet *
plan_of(size_t n, double rate, const ss_morlet_opts *opts)
{
    ss_morlet *plan = NULL;
    ss_error err = { 0 };
    if (ss_morlet_new(&plan, n, rate, opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return plan;
}

static inline double *
transform(const ss_morlet *plan, const double *x)
{
    double *w = malloc((2 * ss_morlet_grid(plan)->total + 1) * sizeof *w);
    assert_int_equal(ss_morlet_execute(plan, x, w, NULL), SS_OK);
    return w;
}

/* The largest |W| of a scale and where it is. */
static inline double
largest(const ss_scale *sc, const double *w, size_t *at)
{
    double most = -1;
    for (size_t k = 0; k < sc->n; k++) {
        double level = hypot(w[2 * (sc->offset + k)], w[2 * (sc->offset + k) + 1]);
        if (level > most) {
            most = level;
            *at = k;
        }
    }
    return most;
}

#endif
