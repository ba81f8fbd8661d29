/* slider.c -- friction of a slider with rate and state, by its Taylor series.
 *
 * mu = mu* + a ln(V/V*) + b ln(V* theta/Dc) without inertia, pulled by a spring: mu' = k (V_load - V).  With
 * lengths in Dc, speeds in the speed before, v = V, q = 1/theta, w = ln(V theta) and K = k Dc/a:
 *
 *     v' = v u',   u' = K (v_load - v) - (b/a) f,
 *     aging: f = q - v, q' = -q f;   slip: f = -v w, w' = u' + f.
 *
 * These are products only, so the series follow by recurrence, without an exponential: their order is what a step
 * to the next time needs, or the step is what the highest order allows. */
#include "fit/slider.h"

#include <math.h>

enum { ORDER = 20, MOST_STEPS = 20000 };        /* steps: between two times */

typedef struct series {
    double v[ORDER + 1], other[ORDER + 1];      /* of the speed, and of q or w, in parts of the step */
    double rise[ORDER + 1], f[ORDER + 1];       /* of u' and f times the step */
} series;

/* Extend the series of a step of length h, with this load's speed, as far as tol needs.  Returns the order; more
 * than ORDER: it does not suffice. */
static int
extend(series *c, const slider *s, double h, double speed, double tol)
{
    const double K = s->stiffness * s->distance;
    int small = 0;
    for (int n = 0; n <= ORDER; n++) {
        double product = 0;
        if (s->is_slip)
            for (int j = 0; j <= n; j++)
                product += c->v[j] * c->other[n - j];
        c->f[n] = h * (s->is_slip ? -product : c->other[n] - c->v[n]);
        c->rise[n] = h * K * ((n == 0 ? speed : 0) - c->v[n]) - s->ratio * c->f[n];
        small = fabs(c->v[n]) <= tol * c->v[0] && fabs(c->other[n]) <= tol * (s->is_slip ? 1 : c->other[0])
            ? small + 1 : 0;
        if (small == 2 || n == ORDER)
            return n + (small < 2);
        double dv = 0, dq = 0;
        for (int j = 0; j <= n; j++) {
            dv += c->v[j] * c->rise[n - j];
            dq -= c->other[j] * c->f[n - j];
        }
        c->v[n + 1] = dv / (n + 1);
        c->other[n + 1] = (s->is_slip ? c->rise[n] + c->f[n] : dq) / (n + 1);
    }
    return ORDER + 1;
}

/* Step towards the end of a stretch that is `left` long.  Returns how far, and adds the way to *slid; NaN: it runs
 * away. */
static double
step(series *c, const slider *s, double left, double speed, double tol, double *slid)
{
    double most = 1;            /* 1 over the part of the step at which the last two terms are within tol */
    int order = extend(c, s, left, speed, tol);
    for (int n = ORDER - 1; order > ORDER && n <= ORDER; n++) {
        double size = fmax(fabs(c->v[n]) / c->v[0], fabs(c->other[n]) / (s->is_slip ? 1 : c->other[0]));
        most = fmax(most, pow(size / tol, 1. / n));
    }
    const double part = 1 / most;
    if (!(part > 1e-12))
        return NAN;
    double v = 0, other = 0, way = 0;
    for (int n = order > ORDER ? ORDER : order; n >= 0; n--) {
        v = v * part + c->v[n];
        other = other * part + c->other[n];
        way = way * part + c->v[n] / (n + 1);
    }
    c->v[0] = v;
    c->other[0] = other;
    *slid += way * part * left;
    return v > 0 && isfinite(v) && (s->is_slip || other > 0) ? part * left : NAN;
}

ss_status
ss_slider_run(double *g, const slider *s, const double *t, const double *load, size_t n, double tol)
{
    series c = { .v = { 1 }, .other = { s->is_slip ? 0 : 1 } };
    g[0] = 0;
    for (size_t i = 1; i < n; i++) {
        const double time = (t[i] - t[i - 1]) * s->speed / s->distance, way = (load[i] - load[i - 1]) / s->distance;
        double left = time, slid = 0;
        for (int steps = 0; left > 0; steps++) {
            double done = steps < MOST_STEPS ? step(&c, s, left, way / time, tol, &slid) : NAN;
            if (isnan(done))
                return SS_EDATA;
            left = done < left ? left - done : 0;
        }
        g[i] = g[i - 1] + s->stiffness * s->distance * (way - slid);
    }
    return SS_OK;
}
