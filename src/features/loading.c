/* loading.c -- how each stick loads a force before it falls.
 *
 * While the slider sticks, the drive loads the force along a line.  The line is laid through the
 * middle half of the rise from one fall to the next, and reaches as far as the samples stay within
 * NEAR of its standard deviations; then it is laid through all of that, and its length is the stick.
 * Samples of a measured force are not independent, so the standard error of the slope counts only
 * (1 - rho) / (1 + rho) of them, rho the correlation of neighbours about the line.
 *
 * A slope of a force over time is the stiffness that loads it, times the speed of the drive.  Where
 * there is a column of displacement, the slope against it is a stiffness by itself. */
#include "features/loading.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "features/window.h"

#define NEAR 3.0                /* standard deviations about the line */
#define AWAY 4                  /* samples in a row beyond that end it */
#define MAD 0.6744897501960817  /* of a Gaussian, re its standard deviation */

typedef struct line {
    double slope, error;        /* per unit of the abscissa */
    double x, y;                /* a point on it */
    double rms;                 /* about it */
} line;

/* y against x, or against the number of the sample where x is NULL. */
static line
fit(const double *y, const double *x, ss_window w)
{
    double m = (double)ss_window_length(w), xx = 0, xy = 0, rr = 0, neighbours = 0, last = 0;
    line l = { 0, NAN, 0, 0, 0 };
    for (size_t i = w.first; i < w.end; i++) {
        l.x += (x != NULL ? x[i] : (double)i) / m;
        l.y += y[i] / m;
    }
    for (size_t i = w.first; i < w.end; i++) {
        double u = (x != NULL ? x[i] : (double)i) - l.x;
        xx += u * u;
        xy += u * (y[i] - l.y);
    }
    l.slope = xx > 0 ? xy / xx : NAN;
    for (size_t i = w.first; i < w.end; i++) {
        double r = y[i] - l.y - l.slope * ((x != NULL ? x[i] : (double)i) - l.x);
        rr += r * r;
        neighbours += i > w.first ? r * last : 0;
        last = r;
    }
    double rho = rr > 0 ? fmax(0, fmin(0.99, neighbours / rr)) : 0;
    l.rms = sqrt(rr / (m - 2));
    l.error = l.rms * sqrt((1 + rho) / (1 - rho) / xx);
    return l;
}

/* From sample i on, forwards or backwards and not beyond end, the last that is near the line. */
static size_t
follow(const double *y, const line *l, size_t i, size_t end)
{
    size_t last = i, away = 0;
    int step = end > i ? 1 : -1;
    while (i != end && away < AWAY) {
        i = step > 0 ? i + 1 : i - 1;
        int near = fabs(y[i] - l->y - l->slope * ((double)i - l->x)) <= NEAR * l->rms;
        last = near ? i : last;
        away = near ? 0 : away + 1;
    }
    return last;
}

/* Where between two turning points y passes so much of the way, in samples. */
static double
crossing(const double *y, size_t from, size_t to, double part)
{
    double level = y[from] + part * (y[to] - y[from]);
    for (size_t i = from; i < to; i++)
        if ((y[i] > level) != (y[i + 1] > level))
            return (double)i + (level - y[i]) / (y[i + 1] - y[i]);
    return NAN;
}

static ss_loading
read_loading(const search *s, const double *x, size_t low, size_t high, size_t end)
{
    enum { FEWEST = 8 };
    size_t rise = high - low;
    ss_loading out = { .slope = unknown, .stiffness = unknown, .stick = NAN, .recurrence = NAN };
    out.duration = (crossing(x, high, end, 0.9) - crossing(x, high, end, 0.1)) / s->rate;
    if (rise < FEWEST)
        return out;
    ss_window stick = { low + rise / 4, high - rise / 4 };
    line l = fit(x, NULL, stick);
    stick.first = follow(x, &l, stick.first, low);
    stick.end = follow(x, &l, stick.end - 1, high) + 1;
    l = fit(x, NULL, stick);
    if (!(l.slope > 0))
        return out;
    out.slope = (ss_value){ l.slope * s->rate * s->largest, l.error * s->rate * s->largest };
    out.stick = (double)ss_window_length(stick) / s->rate;
    if (s->opts->displacement < 0)
        return out;
    l = fit(x, s->signal->values + (size_t)s->opts->displacement * s->n, stick);
    out.stiffness = (ss_value){ fabs(l.slope) * s->largest, l.error * s->largest };
    return out;
}

/* Of those that are numbers; v holds n. */
static ss_median
median_of(double *v, size_t n)
{
    size_t used = 0;
    for (size_t i = 0; i < n; i++)
        if (isfinite(v[i]))
            v[used++] = v[i];
    if (used < 2)
        return (ss_median){ used > 0 ? v[0] : NAN, NAN, NAN };
    double median = gsl_stats_median(v, 1, used);
    for (size_t i = 0; i < used; i++)
        v[i] = fabs(v[i] - median);
    double scatter = gsl_stats_median(v, 1, used) / MAD;
    return (ss_median){ median, sqrt(M_PI / 2 / (double)used) * scatter, scatter };
}

static void
summarise(ss_features *out, double *v)
{
    const size_t n = out->n;
    for (size_t i = 0; i < n; i++)
        v[i] = out->loading[i].slope.value;
    out->slope = median_of(v, n);
    for (size_t i = 0; i < n; i++)
        v[i] = out->loading[i].stiffness.value;
    out->stiffness = median_of(v, n);
    for (size_t i = 0; i < n; i++)
        v[i] = out->loading[i].drop;
    out->drop = median_of(v, n);
    for (size_t i = 0; i < n; i++)
        v[i] = out->loading[i].duration;
    out->duration = median_of(v, n);
    for (size_t i = 0; i < n; i++)
        v[i] = out->loading[i].recurrence;
    out->recurrence = median_of(v, n);
    for (size_t i = 0; i < n; i++)
        v[i] = out->loading[i].stick;
    out->stick = median_of(v, n);
}

ss_status
ss_loading_find(search *s, const double *x, const ss_drop *drop, size_t n)
{
    ss_features *out = s->out;
    double *v = malloc((n + 1) * sizeof *v);
    out->loading = calloc(n + 1, sizeof *out->loading);
    if (out->loading == NULL || v == NULL) {
        free(v);
        return SS_ENOMEM;
    }
    for (size_t i = 0, low = 0; i < n; i++) {
        size_t high = (size_t)(drop[i].t * s->rate + 0.5), end = (size_t)(drop[i].end * s->rate + 0.5);
        for (size_t k = low; i == 0 && k < high; k++)   /* nothing falls before the first */
            low = x[k] < x[low] ? k : low;
        ss_loading *l = &out->loading[i];
        *l = read_loading(s, x, low, high, end);
        l->t = drop[i].t;
        l->drop = drop[i].height * s->largest;
        if (i > 0 && !ss_gaps_near(s->gap, s->n_gaps, 0.5 * (drop[i].t + drop[i - 1].t),
                                   0.5 * (drop[i].t - drop[i - 1].t)))
            l->recurrence = drop[i].t - drop[i - 1].t;
        low = end;
    }
    summarise(out, v);
    free(v);
    return SS_OK;
}
