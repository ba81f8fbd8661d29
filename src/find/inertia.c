/* inertia.c -- whether a fall of a force is the slip of a mass or a relaxation without one.
 *
 * A mass accelerates and comes to rest, so the force of its spring begins and ends to fall without a
 * corner.  What has no mass falls with a corner at either end, along a line (a saw-tooth generator, a
 * switch behind a filter) or quickest at first (a discharge through a resistor).  Both are fitted to the
 * same samples, between loadings whose slopes are free on either side, as neither a stick nor a charge
 * need be straight:
 *
 *     slip          p(v) = (1 - cos((pi + 2 a) v - a) / cos a) / 2,  tan a = k U / (D w) of slip.c,
 *     relaxation    p(v) = v + b v (1 - v),  0 <= b < 1,
 *
 * where v goes from 0 to 1 between the corners and p is the part of the fall that is behind it.  The
 * relaxation has one parameter more, so that it wins where the samples cannot tell. */
#include "find/inertia.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>

enum { ONSET, END, TOP, BOTTOM, BEFORE, BEHIND, BEND, PARAMETERS };
enum { MOST = 256, STEPS = 60 };        /* most samples, more are averaged; most iterations */

typedef struct fall {
    size_t n;
    double u[MOST], y[MOST];    /* time and force over the length and the drop of the slip, from its onset */
    double lead;                /* a */
    int relaxes;
} fall;

static double
fallen(const fall *f, double v, double bend)
{
    if (f->relaxes)
        return v + bend * bend / (1 + bend * bend) * v * (1 - v);
    return 0.5 * (1 - cos((M_PI + 2 * f->lead) * v - f->lead) / cos(f->lead));
}

static int
residuals(const gsl_vector *at, void *user, gsl_vector *out)
{
    const fall *f = user;
    double p[PARAMETERS] = { 0 };
    for (size_t k = 0; k < at->size; k++)
        p[k] = gsl_vector_get(at, k);
    for (size_t i = 0; i < f->n; i++) {
        double u = f->u[i], y;
        if (u <= p[ONSET])
            y = p[TOP] + p[BEFORE] * (u - p[ONSET]);
        else if (u >= p[END])
            y = p[BOTTOM] + p[BEHIND] * (u - p[END]);
        else
            y = p[TOP] - (p[TOP] - p[BOTTOM]) * fallen(f, (u - p[ONSET]) / (p[END] - p[ONSET]), p[BEND]);
        gsl_vector_set(out, i, y - f->y[i]);
    }
    return GSL_SUCCESS;
}

/* Fit either shape.  *left becomes the least sum of squares; NaN: there is no fit. */
static ss_status
fit(fall *f, double loading, double *left)
{
    double corner = f->relaxes ? 0.15 : 0;      /* the corners of a relaxation lie inside the slip's */
    double first[PARAMETERS] = { corner, 1 - corner, 0, -1, loading, loading, 0.5 };
    size_t parameters = f->relaxes ? PARAMETERS : BEND;
    gsl_vector_view at = gsl_vector_view_array(first, parameters);
    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_fdf least = { .f = residuals, .n = f->n, .p = parameters, .params = f };
    gsl_multifit_nlinear_workspace *space =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, least.n, parameters);
    *left = NAN;
    if (space == NULL)
        return SS_ENOMEM;
    int info, ended = gsl_multifit_nlinear_init(&at.vector, &least, space);
    if (ended == GSL_SUCCESS)
        ended = gsl_multifit_nlinear_driver(STEPS, 1e-6, 0, 0, NULL, NULL, &info, space);
    if (ended == GSL_SUCCESS || ended == GSL_ENOPROG || ended == GSL_EMAXITER) {
        const gsl_vector *r = gsl_multifit_nlinear_residual(space);
        gsl_blas_ddot(r, r, left);
    }
    gsl_multifit_nlinear_free(space);
    return SS_OK;
}

/* Fill in the samples from half a slip before it to half a slip behind it. */
static void
fill(fall *f, const double *x, ss_window room, const ss_slip *slip)
{
    double onset = slip->onset.value, length = slip->end.value - onset;
    size_t first = (size_t)fmax((double)room.first, onset - length / 2);
    size_t end = (size_t)fmin((double)room.end, onset + 1.5 * length + 1), each = (end - first) / MOST + 1;
    f->n = (end - first) / each;
    for (size_t i = 0; i < f->n; i++) {
        double mean = 0;
        for (size_t k = first + i * each; k < first + (i + 1) * each; k++)
            mean += x[k] / (double)each;
        f->u[i] = ((double)(first + i * each) + 0.5 * (double)(each - 1) - onset) / length;
        f->y[i] = (mean - slip->top.value) / slip->drop.value;
    }
}

ss_status
ss_inertia_sign(int *sign, const double *x, ss_window room, const ss_slip *slip, double loading)
{
    fall f;
    double left[2], half = slip->top.value - slip->middle.value, w = sqrt(slip->k_over_m.value);
    double slope = loading * (slip->end.value - slip->onset.value) / slip->drop.value;
    *sign = 0;
    fill(&f, x, room, slip);
    f.lead = atan(loading / (half * w));
    if (f.n <= PARAMETERS)
        return SS_OK;
    for (f.relaxes = 0; f.relaxes < 2; f.relaxes++) {
        ss_status st = fit(&f, slope, &left[f.relaxes]);
        if (st != SS_OK)
            return st;
    }
    *sign = (left[0] < left[1]) - (left[0] > left[1]);
    return SS_OK;
}
