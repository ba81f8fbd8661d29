/* inverse.c -- from coefficients back to a signal.
 *
 * Weighted by the grid's share of the integral over a and b, da db/a^2, coefficients on a fine grid
 * are nearly a tight frame: the transform's adjoint nearly inverts it, up to a constant, for what the
 * scales reach.  From there conjugate gradients (Hestenes and Stiefel 1952, in the form for least
 * squares, CGLS) converge on any grid; on one that is far from tight they need many passes, and a
 * residual that stays shows that the coefficients are those of no signal.  Frequencies at the edge of
 * the scales and beyond converge slowly: the residual then falls about as the passes to the power
 * -1/2 to -1, without end. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/progress.h"
#include "base/range.h"
#include "morlet/plan.h"

/* A residual stays if twice as many passes, from STALL_FROM on, lower it by less than this part. */
enum { PASSES = 500, STALL_FROM = 16 };
static const double STALL = 0.1;

typedef struct solver {
    const ss_coefficients *coef;
    ss_stretch progress;
    ss_morlet *plan;
    wavelet **wave;                 /* of each scale */
    double *x, *gradient, *step;
    double *w, *rest;               /* coefficients of step; the part that x does not explain */
    int exponent;                   /* all of these are divided by 2^exponent */
    double bounds;                  /* the upper frame bound over the lower one */
} solver;

/* A scale's weight in sums over coefficients. */
static double
weight_of(const solver *s, const ss_scale *sc)
{
    double step = sc->b_num / sc->b_den, share = step * log(2) / s->plan->opts.voices / sc->a;
    return s->plan->opts.norm == SS_NORM_L1 ? share * sc->a : share;
}

static double
norm2_weighted(const solver *s, const double *w)
{
    double sum = 0;
    for (size_t i = 0; i < s->plan->n_scales; i++) {
        const ss_scale *sc = &s->plan->scale[i];
        double part = 0;
        for (size_t k = 2 * sc->offset; k < 2 * (sc->offset + sc->n); k++)
            part += w[k] * w[k];
        sum += weight_of(s, sc) * part;
    }
    return sum;
}

static double
norm2(const double *x, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += x[i] * x[i];
    return sum;
}

/* gradient becomes the adjoint of the transform, applied to the weighted rest. */
static void
adjoint(solver *s)
{
    memset(s->gradient, 0, s->plan->n * sizeof *s->gradient);
    for (size_t i = 0; i < s->plan->n_scales; i++) {
        const ss_scale *sc = &s->plan->scale[i];
        double factor = weight_of(s, sc) * (s->plan->opts.norm == SS_NORM_L1 ? 1 : sqrt(sc->a));
        ss_quadrature_adjoint(s->plan, sc, s->wave[i], s->rest + 2 * sc->offset, factor,
                              s->gradient);
    }
}

/* Round x up to two digits. */
static double
round_up(double x)
{
    double unit = pow(10, floor(log10(x)) - 1);
    return ceil(x / unit) * unit;
}

static ss_status
refuse(double tol, double residual, int passes, int stays, ss_error *err)
{
    double takes = round_up(residual);
    if (stays || takes > 0.1)
        return ss_fail(err, SS_ETOL, "no signal has these coefficients within %g: %.2g of them is "
                       "left after %d passes, and stays", tol, takes, passes);
    return ss_fail(err, SS_ETOL, "after %d passes %.2g of the coefficients is left, more than the "
                   "%g asked for: what lies at the edge of the scales and beyond is found slowly; "
                   "an accuracy of %.2g can be had, or more with scales that reach further", passes,
                   takes, tol, takes);
}

/* Solve by conjugate gradients.  *residual becomes the size of the part that x does not explain, relative
 * to all. */
static ss_status
solve(solver *s, double tol, double *residual, ss_error *err)
{
    size_t n = s->plan->n, total = 2 * s->plan->total;
    double all = norm2_weighted(s, s->rest), left = all;
    ss_status st = SS_OK;
    adjoint(s);
    memcpy(s->step, s->gradient, n * sizeof *s->step);
    double slope = norm2(s->gradient, n), then = left;
    int pass = 0, mark = STALL_FROM, stays = 0;
    for (; left > tol * tol * all && slope > 0 && pass < PASSES && !stays; pass++) {
        /* every pass lowers the rest by about the same factor */
        double done = fmax(log(left / all) / (2 * log(tol)), (double)pass / PASSES);
        if ((st = ss_stretch_at(&s->progress, fmax(0, done))) != SS_OK
            || (st = ss_morlet_execute(s->plan, s->step, s->w, err)) != SS_OK)
            return st;
        double length = slope / norm2_weighted(s, s->w);
        for (size_t i = 0; i < n; i++)
            s->x[i] += length * s->step[i];
        for (size_t i = 0; i < total; i++)
            s->rest[i] -= length * s->w[i];
        left = norm2_weighted(s, s->rest);
        if (pass + 1 == mark) {
            stays = mark > STALL_FROM && sqrt(left) > (1 - STALL) * sqrt(then);
            then = left;
            mark *= 2;
        }
        adjoint(s);
        double before = slope;
        slope = norm2(s->gradient, n);
        for (size_t i = 0; i < n; i++)
            s->step[i] = s->gradient[i] + slope / before * s->step[i];
    }
    *residual = all > 0 ? sqrt(left / all) : 0;
    return *residual <= tol ? SS_OK : refuse(tol, *residual, pass, stays || !(slope > 0), err);
}

/* --- is it a frame? --------------------------------------------------------------------------- */

/* The sum over the scales of |H(a w)| |H(a w + shift)|.  H is normalised, and its side of negative
 * frequencies left out. */
static double
overlap(const solver *s, double w, double shift)
{
    double sum = 0;
    for (size_t i = 0; i < s->plan->n_scales; i++) {
        double v = s->plan->scale[i].a * w - s->plan->opts.center, u = v + shift;
        sum += exp(-(v * v + u * u) / 2);
    }
    return sum;
}

/* The largest step of translations in units of their scale. */
static double
largest_step(const ss_morlet *plan)
{
    double most = 0;
    for (size_t i = 0; i < plan->n_scales; i++)
        most = fmax(most, plan->scale[i].b_num / plan->scale[i].b_den / plan->scale[i].a);
    return most;
}

/* The ratio of the frame bounds after Daubechies (1990), theorem 2.7, for frequencies between those of the
 * longest and the shortest scale.  The lower bound is the smallest sum of |H|^2 minus the aliases that
 * translations step a apart make; the upper one is the largest sum plus these aliases. */
static void
find_bounds(solver *s)
{
    enum { PER_SCALE = 4, SHIFTS = 8 };
    const ss_scale *longest = &s->plan->scale[0];
    const ss_scale *shortest = &s->plan->scale[s->plan->n_scales - 1];
    double lowest = 2 * M_PI * longest->f, ratio = shortest->f / longest->f;
    double step = largest_step(s->plan), least = INFINITY, most = 0;
    double beta[2 * SHIFTS] = { 0 }, alias = 0;
    size_t n = PER_SCALE * s->plan->n_scales;
    for (size_t i = 0; i <= n; i++) {
        double w = lowest * pow(ratio, (double)i / (double)n), sum = overlap(s, w, 0);
        least = fmin(least, sum);
        most = fmax(most, sum);
        for (int k = 0; k < 2 * SHIFTS; k++) {
            double shift = (k % 2 ? -2 : 2) * M_PI / step * (1 + k / 2);
            beta[k] = fmax(beta[k], overlap(s, w, shift));
        }
    }
    for (int k = 0; k < 2 * SHIFTS; k += 2)
        alias += 2 * sqrt(beta[k] * beta[k + 1]);
    s->bounds = least > alias ? (most + alias) / (least - alias) : INFINITY;
}

/* --- the plan that made them ------------------------------------------------------------------ */

static int
note_says(const ss_coefficients *c, const char *key, const char *value)
{
    const char *note = ss_header_find_note(c->head, key);
    return note != NULL && strcmp(note, value) == 0;
}

static ss_status
read_options(const ss_coefficients *c, ss_morlet_opts *opts, ss_error *err)
{
    static const char *const needed[] = { "voices", "norm", "admissible" };
    const char *step = ss_header_find_note(c->head, "step");
    const ss_scale *longest = &c->scale[0], *shortest = &c->scale[c->n_scales - 1];
    char *end;
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
        if (ss_header_find_note(c->head, needed[i]) == NULL)
            return ss_fail(err, SS_EDATA, "the coefficients lack their option '%s'", needed[i]);
    *opts = ss_morlet_defaults;
    opts->center = c->center;
    opts->voices = (int)ss_number_parse(ss_header_find_note(c->head, "voices"), &end);
    opts->dense = note_says(c, "dense", "yes");
    opts->exact = ss_header_find_note(c->head, "lattice") == NULL;
    if (!opts->dense)
        opts->step = step != NULL ? ss_number_parse(step, &end)
            : longest->b_num / longest->b_den / longest->a;
    opts->norm = note_says(c, "norm", "l1") ? SS_NORM_L1 : SS_NORM_L2;
    opts->admissible = note_says(c, "admissible", "yes");
    opts->octaves = opts->force = 1;
    opts->m0 = shortest->m;
    opts->m1 = longest->m;
    opts->accuracy = 1e-12;
    return SS_OK;
}

static ss_status
make_plan(solver *s, ss_error *err)
{
    const ss_coefficients *c = s->coef;
    ss_morlet_opts opts;
    ss_status st = read_options(c, &opts, err);
    if (st != SS_OK || (st = ss_morlet_new(&s->plan, c->n, c->head->rate, &opts, err)) != SS_OK)
        return st;
    int same = s->plan->n_scales == c->n_scales;
    for (size_t i = 0; same && i < c->n_scales; i++)
        same = s->plan->scale[i].j == c->scale[i].j && s->plan->scale[i].n == c->scale[i].n;
    return same ? SS_OK : ss_fail(err, SS_EDATA, "scales are missing between the longest and the "
                                  "shortest");
}

/* Allocate the solver's arrays.  rest becomes the coefficients in the plan's order, times a power of two
 * with which their squares neither overflow nor vanish. */
static ss_status
make_room(solver *s)
{
    size_t n = s->plan->n, total = 2 * s->plan->total;
    s->wave = calloc(s->plan->n_scales, sizeof(wavelet *));
    s->w = malloc(total * sizeof *s->w);
    s->rest = malloc(total * sizeof *s->rest);
    s->gradient = malloc(n * sizeof *s->gradient);
    s->step = malloc(n * sizeof *s->step);
    if (s->wave == NULL || s->w == NULL || s->rest == NULL || s->gradient == NULL
        || s->step == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < s->plan->n_scales; i++) {
        const ss_scale *sc = &s->plan->scale[i];
        memcpy(s->rest + 2 * sc->offset, s->coef->w + 2 * s->coef->scale[i].offset,
               2 * sc->n * sizeof *s->rest);
    }
    double most = 0;
    for (size_t i = 0; i < total; i++)
        most = fmax(most, fabs(s->rest[i]));
    frexp(most, &s->exponent);
    for (size_t i = 0; i < total; i++)
        s->rest[i] = ldexp(s->rest[i], -s->exponent);
    for (size_t i = 0; i < s->plan->n_scales; i++) {
        const ss_scale *sc = &s->plan->scale[i];
        s->wave[i] = ss_wavelet_new(&s->plan->opts, sc->a, s->plan->rate, n);
        if (s->wave[i] == NULL)
            return SS_ENOMEM;
    }
    return SS_OK;
}

static void
release(solver *s)
{
    for (size_t i = 0; s->wave != NULL && i < s->plan->n_scales; i++)
        ss_wavelet_free(s->wave[i]);
    free(s->wave);
    free(s->w);
    free(s->rest);
    free(s->gradient);
    free(s->step);
    ss_morlet_free(s->plan);
}

ss_status
ss_morlet_inverse(ss_signal **out, const ss_coefficients *coefficients, double tol,
                  double *error, ss_progress progress, ss_error *err)
{
    if (out == NULL || coefficients == NULL)
        return SS_FAIL_NULL(err);
    enum { BOUNDS_MAX = 100 };
    solver s = { .coef = coefficients, .progress = { progress, 0, 1 } };
    double residual = 0;
    *out = NULL;
    ss_status st = ss_range_check(tol, ss_morlet_ranges.inverse_accuracy, "accuracy", err);
    if (st == SS_OK)
        st = make_plan(&s, err);
    if (st == SS_OK)
        find_bounds(&s);
    if (st == SS_OK && !(s.bounds <= BOUNDS_MAX))
        st = ss_fail(err, SS_ESCALE, "the grid is too coarse to be inverted, its frame bounds being "
                     "a factor of %.3g apart; more voices or a smaller step are needed", s.bounds);
    if (st == SS_OK)
        st = make_room(&s);
    if (st == SS_OK)
        st = ss_signal_new(out, coefficients->head, coefficients->n);
    if (st == SS_OK) {
        s.x = (*out)->values;
        st = solve(&s, tol, &residual, err);
        for (size_t i = 0; i < coefficients->n; i++)
            s.x[i] = ldexp(s.x[i], s.exponent);
    }
    release(&s);
    if (error != NULL)
        *error = residual * sqrt(s.bounds);
    if (st != SS_OK) {
        ss_signal_free(*out);
        *out = NULL;
    }
    return st;
}
