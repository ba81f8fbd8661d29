/* taylor.c -- a motion carried by its Taylor series.
 *
 * The model gives the series of its state by recurrence.  Order and step follow from the
 * tolerance.  The order N is the one with the least work.  The step is the largest at which the
 * terms of order N - 1 and N are within the tolerance (A. Jorba, M. Zou, Experimental Mathematics
 * 14, 99, 2005); it does not exceed the range in which the model declares its series valid.  The
 * same series gives the samples inside the step, and the events, which are the first zeros of the
 * guard's polynomial, proven by bernstein.c.  So a step needs no cap by a part of a period.
 *
 * Coefficients are those of powers of s / unit, where the unit is the last step, so that they
 * neither overflow nor underflow.  There is one coefficient beyond N for the rate of change. */
#include "motion/engine.h"

#include <float.h>
#include <string.h>
#include "base/versions.h"

/* The orders for the tolerances 1e-1 and 1e-14; every order is even. */
enum { LEAST_ORDER = 6, MOST_ORDER = 24 };

/* The number of samples that are computed side by side: they fill the widest vector register. */
enum { BATCH = 8 };

/* A step is at most this many times as long as the last: terms that are only rounding over the last step
 * do not show the error of one that is much longer. */
#define GROWTH 8.0

/* It is also at most half a period of the mode's fastest motion, over which no term exceeds e^pi. */
enum { LONGEST = STEPS_PER_PERIOD / 2 };

typedef struct taylor {
    engine base;
    int order;
    double relative;                        /* of the size of the state's parts, this part counts as scale */
    double longest;
    double unit;                            /* of the series [s] */
    double per_order[MOST_ORDER + 2];       /* 1 / (n + 1) */
    double sample[SERIES_PARTS][BATCH];     /* of the present step, one interval after the other */
    int taken;                              /* samples taken from the batch; BATCH: none are left */
} taylor;

/* The longest step [unit] that keeps the tolerance; 0 if the series is not finite.  The step is near 1, so
 * one root serves for the last two orders, and seven digits of it suffice. */
static double
tolerated(const taylor *t)
{
    const double *q = t->base.m->now.q, *last = t->base.series.c[t->order], *before = t->base.series.c[t->order - 1];
    double largest = 0, sum = 0;
    for (size_t i = 0; i < MAX_DIM; i++) {
        double term = fabs(last[i]) > fabs(before[i]) ? fabs(last[i]) : fabs(before[i]);
        double size = term / (t->base.scale[i] + t->relative * fabs(q[i]));
        largest = size > largest ? size : largest;
        sum += last[i] + before[i];
    }
    if (!isfinite(sum))
        return 0;
    return powf((float)fmin(t->base.tol / largest, FLT_MAX), (float)t->per_order[t->order - 1]);
}

static void
expand(taylor *t)
{
    double step[MOST_ORDER + 2];
    for (int n = 0; n <= t->order + 1; n++)
        step[n] = t->unit * t->per_order[n];
    t->base.series.c[t->order + 1][MAX_DIM] = 0;        /* no order has it, but higher ones before had */
    t->base.m->now.model->series(&t->base.m->now, step, t->order + 1, t->base.series.c);
    t->base.series.per_unit = 1 / t->unit;
    t->base.series.degree = t->order + 1;
    t->base.rhs += (unsigned long)t->order;
}

/* The state and the rates of change of its first two parts.  Horner's scheme runs over the even and the
 * odd powers of all parts side by side, for which compilers use vectors. */
VERSIONS static void
series_at(const series *of, double s, double q[], double dqdt[])
{
    enum { LANES = 2 * SERIES_PARTS };
    double x = s * of->per_unit, y = x * x, sum[LANES];
    const double *c = of->c[of->degree - 1];
    memcpy(sum, c, sizeof sum);
    while (c != of->c[0]) {
        c -= LANES;
        for (int i = 0; i < LANES; i++)
            sum[i] = sum[i] * y + c[i];
    }
    for (int i = 0; i < MAX_DIM; i++)
        q[i] = sum[i] + x * sum[SERIES_PARTS + i];
    dqdt[0] = q[1];
    dqdt[1] = sum[MAX_DIM] + x * sum[SERIES_PARTS + MAX_DIM];
    dqdt[2] = 0;
}

void
ss_series_at(const series *of, double s, double q[], double dqdt[])
{
    series_at(of, s, q, dqdt);
}

/* Compute BATCH samples from s on: the same scheme with samples side by side. */
VERSIONS static void
evaluate_batch(taylor *t, double s, double interval)
{
    double x[BATCH], y[BATCH], even[BATCH], odd[BATCH];
    for (int i = 0; i < BATCH; i++) {
        x[i] = (s + i * interval) * t->base.series.per_unit;
        y[i] = x[i] * x[i];
    }
    for (int part = 0; part < SERIES_PARTS; part++) {
        for (int i = 0; i < BATCH; i++) {
            even[i] = t->base.series.c[t->order][part];
            odd[i] = t->base.series.c[t->order + 1][part];
        }
        for (int n = t->order - 2; n >= 0; n -= 2)
            for (int i = 0; i < BATCH; i++) {
                even[i] = even[i] * y[i] + t->base.series.c[n][part];
                odd[i] = odd[i] * y[i] + t->base.series.c[n + 1][part];
            }
        for (int i = 0; i < BATCH; i++)
            t->sample[part][i] = even[i] + x[i] * odd[i];
    }
    t->taken = 0;
}

static void
taylor_begin(engine *e)
{
    taylor *t = (taylor *)e;
    t->longest = LONGEST * ss_step_cap(&e->m->now);
    ss_engine_begin_steps(e);
}

/* Expand the series in a unit in which it is finite, and return the longest step [unit] that keeps the
 * tolerance; 0 if no unit above the shortest step is small enough. */
static double
longest_step(taylor *t)
{
    for (t->unit = fmin(t->base.next, t->longest); t->unit >= t->base.shortest; t->unit *= 0x1p-10) {
        expand(t);
        double step = tolerated(t);
        if (step > 0)
            return fmin(step, fmin(GROWTH, t->longest * t->base.series.per_unit));
    }
    return 0;
}

static ss_status
taylor_step(engine *e, double h_max, ss_error *err)
{
    taylor *t = (taylor *)e;
    const state *m = &e->m->now;
    double step = longest_step(t);
    (void)h_max;
    if (step > 0 && m->model->reach != NULL)
        step = m->model->reach(m, t->base.series.c, step);
    e->next = step * t->unit;
    if (!(e->next >= e->shortest))
        return ss_engine_fail_short(e, err);
    for (size_t i = 0; i < MAX_DIM; i++)
        e->dq0[i] = t->base.series.per_unit * t->base.series.c[1][i];
    e->h = m->scene->base != NULL ? fmin(e->next, m->u_knot - m->u) : e->next;
    e->steps++;
    t->taken = BATCH;
    series_at(&e->series, e->h, e->q1, e->dq1);
    return SS_OK;
}

static void
taylor_at(engine *e, reading where, double s, turn base, double q[], double dqdt[])
{
    taylor *t = (taylor *)e;
    const state *m = &e->m->now;
    e->rhs++;
    if (where == ANYWHERE) {
        series_at(&e->series, s, q, dqdt);
        m->model->rates(m, base_force_by(m, base, m->u + s), q, dqdt);
        return;
    }
    if (t->taken == BATCH)
        evaluate_batch(t, s, 1 / m->scene->rate);
    int i = t->taken++;
    for (int part = 0; part < MAX_DIM; part++)
        q[part] = t->sample[part][i];
    dqdt[0] = q[1];
    dqdt[1] = t->sample[MAX_DIM][i];
}

static ss_status
taylor_make(engine *e, ss_error *err)
{
    taylor *t = (taylor *)e;
    int order = 2 * (int)ceil(2 - log10(e->tol) * 2 / 3);
    (void)err;
    t->order = order < LEAST_ORDER ? LEAST_ORDER : order > MOST_ORDER ? MOST_ORDER : order;
    t->relative = ss_motion_relative(&e->m->now, e->tol) / e->tol;
    for (int n = 0; n < MOST_ORDER + 2; n++)
        t->per_order[n] = 1.0 / (n + 1);
    return SS_OK;
}

const struct engine_type ss_taylor_engine = {
    .size = sizeof(taylor), .make = taylor_make, .begin = taylor_begin, .step = taylor_step, .at = taylor_at
};
