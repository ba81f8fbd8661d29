/* slip.c -- the slip of a pulled slider, seen in the force of its spring.
 *
 * A slider of mass m is held by friction up to f_s and braked by f_k while it slips.  A spring of
 * stiffness k, whose end moves at U, pulls it.  The force s of the spring rises at s' = k U in the
 * stick.  In the slip, at time u after its onset, it is
 *
 *     s = f_k + D cos(w u) + (k U / w) sin(w u),    D = f_s - f_k, w = sqrt(k/m), q = D w / (k U).
 *
 * The slip ends when s' is k U again, at u = 2 (pi - atan q) / w, where s = f_k - D.  The slip and the
 * loadings on either side of it are fitted to the samples by least squares.  The fit varies the onset,
 * f_s, f_k and w.  Simpler readings err: noise and the momentum of the drive raise the largest sample
 * above f_s, and a line that is followed to within the noise goes on into the slip.
 *
 * The residual of a measured slip is not white, so errors count fewer samples (colour.c). */
#include "find/slip.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <string.h>
#include "find/colour.h"

enum { ONSET, TOP, MIDDLE, SPEED, FITTED };     /* SPEED: of the phase, w */
enum { FEWEST = 8, STEPS = 60 };                /* fewest samples in the fall; most iterations */
#define EXPLAINED 0.98          /* part of the sum of squares about the mean: a fit that explains less is
                                   another shape */
#define VAGUE (1 / 3.)          /* largest relative error of the drop and of k/m */
#define DEEP 0.8                /* part of D: 10 and 90 % of the fall lie at f_k +- so much */

typedef struct problem {
    const double *x;
    ss_window used;
    double loading, unit[FITTED];       /* the unit of each parameter, for steps of like size */
} problem;

static double
length_of(const double p[FITTED], double loading)
{
    double w = p[SPEED], q = (p[TOP] - p[MIDDLE]) * w / loading;
    return 2 * (M_PI - atan(q)) / w;
}

/* Find the force at sample i, and its derivatives by the parameters. */
static double
force_at(const double p[FITTED], double loading, double i, double d[FITTED])
{
    double w = p[SPEED], D = p[TOP] - p[MIDDLE], q = D * w / loading, length = length_of(p, loading);
    double u = i - p[ONSET];
    if (u < 0) {
        memcpy(d, (double[FITTED]){ -loading, 1, 0, 0 }, FITTED * sizeof *d);
        return p[TOP] + loading * u;
    }
    if (u < length) {
        double c = cos(w * u), s = sin(w * u), r = loading / w;
        d[ONSET] = D * w * s - loading * c;
        d[TOP] = c;
        d[MIDDLE] = 1 - c;
        d[SPEED] = -D * u * s - r * s / w + r * u * c;
        return p[MIDDLE] + D * c + r * s;
    }
    double by_D = -2 / (1 + q * q) / loading, by_w = -length / w - 2 / (1 + q * q) * D / (loading * w);
    d[ONSET] = -loading;
    d[TOP] = -1 - loading * by_D;
    d[MIDDLE] = 2 + loading * by_D;
    d[SPEED] = -loading * by_w;
    return p[MIDDLE] - D + loading * (u - length);
}

static void
parameters_of(const problem *f, const gsl_vector *at, double p[FITTED])
{
    for (size_t k = 0; k < FITTED; k++)
        p[k] = gsl_vector_get(at, k) * f->unit[k];
}

static int
residuals(const gsl_vector *at, void *user, gsl_vector *out)
{
    const problem *f = user;
    double p[FITTED], d[FITTED];
    parameters_of(f, at, p);
    for (size_t i = f->used.first; i < f->used.end; i++)
        gsl_vector_set(out, i - f->used.first, force_at(p, f->loading, (double)i, d) - f->x[i]);
    return GSL_SUCCESS;
}

static int
jacobian(const gsl_vector *at, void *user, gsl_matrix *out)
{
    const problem *f = user;
    double p[FITTED], d[FITTED];
    parameters_of(f, at, p);
    for (size_t i = f->used.first; i < f->used.end; i++) {
        force_at(p, f->loading, (double)i, d);
        for (size_t k = 0; k < FITTED; k++)
            gsl_matrix_set(out, i - f->used.first, k, d[k] * f->unit[k]);
    }
    return GSL_SUCCESS;
}

/* The first sample, forwards or backwards from where x passes the middle of the fall, that is past a level
 * near its end; `end`: none is. */
static size_t
walk(const double *x, size_t i, size_t end, double level)
{
    int above = x[i] > level, step = end > i ? 1 : -1;
    while (i != end && (x[i] > level) == above)
        i = step > 0 ? i + 1 : i - 1;
    return i;
}

/* Find the parameters to start from, by the times at which x passes 10, 50 and 90 % of the fall, and the
 * samples to use, up to about half a slip on either side. */
static int
start(problem *f, double p[FITTED], ss_window room, size_t high, size_t low)
{
    const double *x = f->x;
    double middle = 0.5 * (x[high] + x[low]), half = 0.5 * (x[high] - x[low]);
    size_t at = walk(x, high, low, middle);
    double from = (double)walk(x, at, high, middle + DEEP * half);
    double to = (double)walk(x, at, low, middle - DEEP * half);
    if (!(half > 0 && to > from))
        return 0;
    p[SPEED] = (acos(-DEEP) - acos(DEEP)) / (to - from);
    p[ONSET] = 0.5 * (from + to) - M_PI / 2 / p[SPEED];
    p[TOP] = middle + half;
    p[MIDDLE] = middle;
    memcpy(f->unit, (double[FITTED]){ 1 / p[SPEED], half, half, p[SPEED] }, sizeof f->unit);
    double reach = 1.5 * M_PI / p[SPEED], first = 0.5 * (from + to) - reach;
    f->used.first = first > (double)room.first ? (size_t)first : room.first;
    f->used.end = (size_t)fmin((double)room.end, 0.5 * (from + to) + reach + 1);
    return f->used.end >= f->used.first + FEWEST;
}

/* Is the residual small enough? */
static int
explains(const problem *f, const gsl_vector *left, ss_slip *out)
{
    size_t n = ss_window_length(f->used);
    double squares = 0;
    out->power = gsl_stats_tss(f->x + f->used.first, 1, n);
    for (size_t i = 0; i < n; i++)
        squares += gsl_vector_get(left, i) * gsl_vector_get(left, i);
    out->variance = squares / (double)(n - FITTED) * ss_colour(left->data, NULL, n, 0);
    out->left = squares;
    out->n = (double)n;
    return squares <= (1 - EXPLAINED) * out->power;
}

enum { OF_SLIP = 7 };

/* Write the numbers of a slip, in their order. */
static void
describe(const double p[FITTED], double loading, double number[OF_SLIP])
{
    double D = p[TOP] - p[MIDDLE], w = p[SPEED], length = length_of(p, loading);
    double peak = hypot(D, loading / w);        /* amplitude of the oscillation, whose phase is 0 there */
    double duration = (acos(-DEEP * D / peak) - acos(DEEP * D / peak)) / w;
    memcpy(number, (double[OF_SLIP]){ p[ONSET], p[ONSET] + length, 2 * D, duration, p[TOP], p[MIDDLE],
                                      w * w }, OF_SLIP * sizeof *number);
}

/* Find the errors of these numbers from the covariance of the parameters. */
static void
fill(ss_slip *s, const problem *f, const double p[FITTED], const gsl_matrix *covariance)
{
    const double step = 1e-4;                   /* of a unit */
    double value[OF_SLIP], slope[FITTED][OF_SLIP], below[OF_SLIP], moved[FITTED];
    ss_value v[OF_SLIP];
    describe(p, f->loading, value);
    memcpy(moved, p, sizeof moved);
    for (size_t k = 0; k < FITTED; k++) {
        moved[k] = p[k] + step * f->unit[k];
        describe(moved, f->loading, slope[k]);
        moved[k] = p[k] - step * f->unit[k];
        describe(moved, f->loading, below);
        moved[k] = p[k];
        for (size_t i = 0; i < OF_SLIP; i++)
            slope[k][i] = (slope[k][i] - below[i]) / (2 * step);
    }
    for (size_t i = 0; i < OF_SLIP; i++) {
        double variance = 0;
        for (size_t k = 0; k < FITTED; k++)
            for (size_t l = 0; l < FITTED; l++)
                variance += slope[k][i] * slope[l][i] * gsl_matrix_get(covariance, k, l);
        v[i] = (ss_value){ value[i], sqrt(s->variance * fmax(variance, 0)) };
    }
    s->onset = v[0], s->end = v[1], s->drop = v[2], s->duration = v[3];
    s->top = v[4], s->middle = v[5], s->k_over_m = v[6];
}

/* left: model less sample. */
static void
fill_residual(ss_slip *s, const problem *f, const gsl_vector *left)
{
    double length = s->end.value - s->onset.value, samples[SLIP_PARTS] = { 0 };
    for (size_t i = 0; i < left->size; i++) {
        double at = (double)(f->used.first + i) - s->onset.value, part = SLIP_PARTS * (at / length + 1) / 3;
        if (!(part >= 0 && part < SLIP_PARTS))
            continue;
        s->residual[(size_t)part] -= gsl_vector_get(left, i);
        samples[(size_t)part]++;
    }
    for (size_t k = 0; k < SLIP_PARTS; k++)
        s->residual[k] /= samples[k] * s->drop.value;
}

static int
is_sound(const ss_slip *s, ss_window used)
{
    return s->onset.value >= (double)used.first && s->end.value > s->onset.value
        && s->end.value <= (double)used.end
        && s->drop.error <= VAGUE * s->drop.value && s->k_over_m.error <= VAGUE * s->k_over_m.value;
}

ss_status
ss_slip_fit(ss_slip *out, int *is_found, const double *x, ss_window room, size_t high, size_t low,
            double loading)
{
    problem f = { .x = x, .loading = loading };
    double p[FITTED], first[FITTED];
    const ss_value none = { NAN, NAN };
    *out = (ss_slip){ none, none, none, none, none, none, none, NAN, NAN, 0, NAN, { 0 } };
    ss_slip found = *out;
    *is_found = 0;
    if (!(loading > 0) || low < high + FEWEST || !start(&f, p, room, high, low))
        return SS_OK;
    for (size_t k = 0; k < FITTED; k++)
        first[k] = p[k] / f.unit[k];
    gsl_vector_view at = gsl_vector_view_array(first, FITTED);
    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_fdf least = { .f = residuals, .df = jacobian, .n = ss_window_length(f.used),
                                       .p = FITTED, .params = &f };
    gsl_multifit_nlinear_workspace *space =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, least.n, FITTED);
    gsl_matrix *covariance = gsl_matrix_alloc(FITTED, FITTED);
    int info, ended = space != NULL && covariance != NULL ? GSL_SUCCESS : GSL_ENOMEM;
    if (ended == GSL_SUCCESS)
        ended = gsl_multifit_nlinear_init(&at.vector, &least, space);
    if (ended == GSL_SUCCESS)
        ended = gsl_multifit_nlinear_driver(STEPS, 1e-8, 0, 0, NULL, NULL, &info, space);
    if ((ended == GSL_SUCCESS || ended == GSL_ENOPROG)
        && explains(&f, gsl_multifit_nlinear_residual(space), &found)
        && gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(space), 0, covariance) == GSL_SUCCESS) {
        parameters_of(&f, gsl_multifit_nlinear_position(space), p);
        fill(&found, &f, p, covariance);
        fill_residual(&found, &f, gsl_multifit_nlinear_residual(space));
        *is_found = is_sound(&found, f.used);
        *out = *is_found ? found : *out;
    }
    gsl_multifit_nlinear_free(space);
    gsl_matrix_free(covariance);
    return ended == GSL_ENOMEM ? SS_ENOMEM : SS_OK;
}
