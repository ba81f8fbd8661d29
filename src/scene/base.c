/* base.c -- the measured displacement of a base: a natural cubic spline through uniform samples
 * (GSL), kept as the cubic of each interval. */
#include "base/error.h"
#include "scene/model.h"
#include "scene/scene.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_spline.h>
#include <stdlib.h>
#include <string.h>

/* A time this near to the end of an interval belongs to the next one, in units of the interval. */
#define SAME_KNOT 1e-9

ss_status
ss_base_new(ss_base **out, const ss_signal *signal, size_t column, ss_error *err)
{
    const ss_column *c = &signal->head->column[column];
    if (*c->unit != '\0' && strcmp(c->unit, "m") != 0)
        return ss_fail(err, SS_EDATA, "column %s is in %s, but a base must be in m", c->name, c->unit);
    if (signal->n < 3)
        return ss_fail(err, SS_EDATA, "a base needs at least 3 samples for a spline, not %zu", signal->n);
    ss_base *b = calloc(1, sizeof *b);
    if (b == NULL)
        return ss_fail_memory(err, NULL);
    *b = (ss_base){ .start = signal->head->start, .rate = signal->head->rate, .n = signal->n,
                    .z = malloc(signal->n * sizeof *b->z),
                    .bend = malloc(signal->n * sizeof *b->bend) };
    for (size_t i = 0; b->z != NULL && i < b->n; i++) {
        b->z[i] = signal->values[column * signal->n + i];
        b->size = fmax(b->size, fabs(b->z[i]));
    }
    double *t = malloc(signal->n * sizeof *t);
    gsl_interp *spline = gsl_interp_alloc(gsl_interp_cspline, signal->n);
    for (size_t i = 0; t != NULL && i < b->n; i++)
        t[i] = (double)i;
    int done = b->z != NULL && b->bend != NULL && t != NULL && spline != NULL
        && gsl_interp_init(spline, t, b->z, b->n) == GSL_SUCCESS;
    for (size_t i = 0; done && i < b->n; i++)
        b->bend[i] = gsl_interp_eval_deriv2(spline, t, b->z, t[i], NULL);
    gsl_interp_free(spline);
    free(t);
    if (done)
        *out = b;
    else
        ss_base_free(b);
    return done ? SS_OK : ss_fail_memory(err, NULL);
}

void
ss_base_free(ss_base *b)
{
    if (b == NULL)
        return;
    free(b->z);
    free(b->bend);
    free(b);
}

ss_status
ss_base_covers(const ss_base *b, double end, const char *name, ss_error *err)
{
    double last = b->start + (double)(b->n - 1) / b->rate, slack = SAME_KNOT / b->rate;
    if (b->start <= slack && last >= end - slack)
        return SS_OK;
    return ss_fail(err, SS_EDATA, "%s: the base is known from %.9g s to %.9g s, and the scene moves "
                   "from 0 to %.9g s", name, b->start, last, end);
}

void
ss_state_meet_base(state *m, double t)
{
    const ss_base *b = m->scene->base;
    double place = (t - b->start) * b->rate;
    double knot = fmin(fmax(floor(place + SAME_KNOT), 0), (double)(b->n - 2));
    size_t i = (size_t)knot;
    double s = place - knot, c = b->bend[i] / 2, d = (b->bend[i + 1] - b->bend[i]) / 6;
    double slope = b->z[i + 1] - b->z[i] - c - d, h = 1 / b->rate;
    m->z[0] = b->z[i] + s * (slope + s * (c + s * d));
    m->z[1] = (slope + s * (2 * c + s * 3 * d)) / h;
    m->z[2] = (c + s * 3 * d) / (h * h);
    m->z[3] = d / (h * h * h);
    m->u_piece = m->u;
    m->u_knot = i + 2 < b->n ? m->u + (knot + 1 - place) * h : INFINITY;
}
