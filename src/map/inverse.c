/* inverse.c -- from coefficients back to a signal.
 *
 * Weighted by the grid's share of the integral over a and b, da db/a^2, coefficients on a fine grid
 * are nearly a tight frame: the transform's adjoint nearly inverts it, up to a constant, for what the
 * scales reach.  From there conjugate gradients (Hestenes and Stiefel 1952) on the normal equations
 * converge on any grid, preconditioned by one over the power with which the scales see each frequency; on a
 * grid that is far from tight they need many passes, and a residual that stays shows that the coefficients are
 * those of no signal.  Frequencies at the edge of the scales and beyond converge slowly: the residual then falls
 * about as the passes to the power -1/2 to -1, without end.
 *
 * A pass transforms the step and applies the adjoint to each part of the coefficients as it comes: the
 * given coefficients are the only ones in memory.  The rest's adjoint, the gradient, and the rest's size
 * follow from those of the step.  Rounding errors of the size show when it is some 1e-8 of where it began:
 * so both are computed anew from the given coefficients long before, and before they are found small enough. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/fft.h"
#include "base/list.h"
#include "base/progress.h"
#include "base/versions.h"
#include "map/fft/blocks.h"
#include "map/plan.h"
#include "signal/header.h"

/* A residual stays if twice as many passes, from STALL_FROM on, lower it by less than this part. */
enum { PASSES = 500, STALL_FROM = 16, LANES = 8 };
static const double STALL = 0.1;

/* A residual that is found from step to step is computed again when it has become so much smaller. */
static const double FRESH = 1e-5;

typedef struct solver {
    const ss_coefficients *coef;
    ss_progress progress;
    ss_morlet *plan;
    block_sums *sums;               /* NULL: no scale is computed in blocks */
    double **room, *x, *gradient, *levelled, *step, *image;      /* room: of all but x */
    real_fft forth, back;           /* of twice the samples */
    double *gain;                   /* of the terms of the gradient, which level what the scales see of them */
    double *part, *given, *scratch; /* given: the coefficients of a part */
    int exponent;                   /* the coefficients, and so all of these, are divided by 2^exponent */
    double bounds;                  /* the upper frame bound over the lower one */
} solver;

/* A scale's weight in sums over coefficients. */
static double
weight_of(const solver *s, const ss_scale *sc)
{
    double step = sc->b_num / sc->b_den, share = step * log(2) / s->plan->opts.voices / sc->a;
    return s->plan->opts.norm == SS_NORM_L1 ? share * sc->a : share;
}

VERSIONS static double
norm2(const double *x, size_t n)
{
    double sum[LANES] = { 0 };
    size_t i = 0;
    for (; i + LANES <= n; i += LANES)
        for (size_t l = 0; l < LANES; l++)
            sum[l] += x[i + l] * x[i + l];
    for (; i < n; i++)
        sum[0] += x[i] * x[i];
    for (size_t l = 1; l < LANES; l++)
        sum[0] += sum[l];
    return sum[0];
}

/* Add the adjoint of a part of scale i to samples, those of blocks not before the sums' end. */
static void
add_adjoint(solver *s, size_t i, span part, const double *w, double *to)
{
    const ss_scale *sc = &s->plan->scale[i];
    double factor = weight_of(s, sc) * (s->plan->opts.norm == SS_NORM_L1 ? 1 : sqrt(sc->a));
    if (ss_blocks_covers(s->plan->blocks, i))
        ss_block_sums_add(s->sums, i, s->scratch, part, factor, w);
    else
        for (size_t k = 0; k < part.n; k++) {
            const double one[2] = { factor * w[2 * k], factor * w[2 * k + 1] };
            spot at = ss_scale_spot(sc, part.first + k, s->plan->rate);
            ss_wavelet_add(s->plan->wave[i], s->plan->n, at, one, to);
        }
}

/* The coefficients of x, or with rest the given ones less those: *norm becomes the weighted sum of their squares,
 * and `to` the adjoint of the transform applied to them.  No more than a part of them is in memory at a time. */
static ss_status
transform(solver *s, const double *x, int rest, double *to, double *norm, ss_error *err)
{
    transformed of;
    ss_status st = ss_morlet_begin(s->plan, x, &of, err);
    memset(to, 0, s->plan->n * sizeof *to);
    *norm = 0;
    for (size_t i = 0; st == SS_OK && i < s->plan->n_scales; i++) {
        const ss_scale *sc = &s->plan->scale[i];
        double sum = 0;
        for (size_t k = 0, n; st == SS_OK && k < sc->n; k += n) {
            n = ss_morlet_part_length(s->plan, i, k);
            n = n < sc->n - k ? n : sc->n - k;
            st = ss_morlet_part(s->plan, &of, s->scratch, &(ss_map_part){ i, k, n, s->part, NULL }, err);
            if (st == SS_OK && rest)
                st = ss_map_read(s->coef, &(ss_map_part){ i, k, n, s->given, NULL }, 1, err);
            for (size_t c = 0; st == SS_OK && rest && c < 2 * n; c++)
                s->part[c] = ldexp(s->given[c], -s->exponent) - s->part[c];
            if (st == SS_OK) {
                sum += norm2(s->part, 2 * n);
                add_adjoint(s, i, (span){ k, n }, s->part, to);
            }
        }
        *norm += weight_of(s, sc) * sum;
    }
    if (st == SS_OK && s->sums != NULL)
        st = ss_block_sums_end(s->sums, to);
    ss_morlet_end(&of);
    return st;
}

/* s->levelled becomes the gradient with the gain of each frequency. */
static double
level(solver *s)
{
    size_t n = s->plan->n;
    double *x = s->forth.x, *y = s->back.x, product = 0;
    memcpy(x, s->gradient, n * sizeof *x);
    memset(x + n, 0, n * sizeof *x);
    ss_real_fft_run(&s->forth);
    for (size_t k = 0; k <= n; k++) {
        y[2 * k] = s->gain[k] * x[2 * k];
        y[2 * k + 1] = s->gain[k] * x[2 * k + 1];
    }
    ss_real_fft_run(&s->back);
    memcpy(s->levelled, y, n * sizeof *y);
    for (size_t i = 0; i < n; i++)
        product += s->gradient[i] * s->levelled[i];
    return product;
}

/* power: of the passes, with which the residual falls. */
static ss_status
refuse(double tol, double residual, int passes, double power, int stays, ss_error *err)
{
    double unit = pow(10, floor(log10(residual)) - 1), takes = ceil(residual / unit) * unit;    /* rounded up */
    if (stays || takes > 0.1)
        return ss_fail(err, SS_ETOL, "no signal has these coefficients within %g: %.2g of them is "
                       "left after %d passes, and stays", tol, takes, passes);
    return ss_fail(err, SS_ETOL, "after %d passes %.2g of the coefficients is left, more than the %g asked for, "
                   "which would take some %.0g passes: what lies at the edge of the scales and beyond is found "
                   "slowly; an accuracy of %.2g can be had, or more with scales that reach further", passes,
                   takes, tol, passes * pow(residual / tol, 1 / power), takes);
}

/* Solve by conjugate gradients.  *residual becomes the size of the part that x does not explain, relative
 * to all.  The rest and its adjoint follow from those of the step, and are computed anew before their
 * rounding errors show. */
static ss_status
solve(solver *s, double tol, double *residual, ss_error *err)
{
    size_t n = s->plan->n;
    double all, slope, left, fresh, then, norm;
    int pass = 0, mark = STALL_FROM, stays = 0;
    ss_status st = transform(s, s->x, 1, s->gradient, &all, err);
    if (st != SS_OK)
        return st;
    slope = level(s);
    memcpy(s->step, s->levelled, n * sizeof *s->step);
    left = fresh = then = all;
    for (; st == SS_OK && left > tol * tol * all && slope > 0 && pass < PASSES && !stays; pass++) {
        /* every pass lowers the rest by about the same factor */
        double done = fmax(log(left / all) / (2 * log(tol)), (double)pass / PASSES);
        if ((st = ss_progress_at(&s->progress, fmin(1, fmax(0, done)))) == SS_OK)
            st = transform(s, s->step, 0, s->image, &norm, err);
        double length = st == SS_OK ? slope / norm : 0;         /* along the step to the least rest */
        for (size_t i = 0; i < n; i++) {
            s->x[i] += length * s->step[i];
            s->gradient[i] -= length * s->image[i];
        }
        left -= length * slope;
        if (st == SS_OK && (left <= FRESH * FRESH * fresh || left <= tol * tol * all)) {
            st = transform(s, s->x, 1, s->gradient, &left, err);
            fresh = left;
        }
        if (pass + 1 == mark) {
            stays = mark > STALL_FROM && sqrt(left) > (1 - STALL) * sqrt(then);
            then = left;
            mark *= 2;
        }
        double before = slope;
        slope = level(s);
        for (size_t i = 0; i < n; i++)
            s->step[i] = s->levelled[i] + slope / before * s->step[i];
    }
    if (st != SS_OK)
        return st;
    *residual = all > 0 ? sqrt(left / all) : 0;
    double power = log(then / left) / 2 / log(2. * pass / mark);
    return *residual <= tol ? SS_OK : refuse(tol, *residual, pass, power, stays || !(slope > 0), err);
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

/* The gains of the 2 n samples' terms, for frequencies that the scales see with a tenth of tol of the best power
 * or more: fainter ones would hold up the rest.  For a tol below 3e-6 there are none, as the error beyond the
 * scales would be more than is said. */
static void
set_gains(solver *s, double tol)
{
    const double faint = tol < 3e-6 ? 1 : tol / 10;
    size_t n = s->plan->n;
    double most = 0;
    for (size_t k = 0; k <= n; k++) {
        s->gain[k] = overlap(s, M_PI * (double)k / (double)n * s->plan->rate, 0);
        most = fmax(most, s->gain[k]);
    }
    for (size_t k = 0; k <= n; k++)
        s->gain[k] = 1 / (s->gain[k] + faint * most);
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
    double step = 0, least = INFINITY, most = 0;            /* the largest step in units of its scale */
    double beta[2 * SHIFTS] = { 0 }, alias = 0;
    size_t n = PER_SCALE * s->plan->n_scales;
    for (const ss_scale *sc = longest; sc <= shortest; sc++)
        step = fmax(step, sc->b_num / sc->b_den / sc->a);
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

static ss_status
make_plan(solver *s, ss_error *err)
{
    const ss_coefficients *c = s->coef;
    ss_morlet_opts opts;
    size_t n;
    ss_status st = ss_morlet_opts_of_notes(&opts, &n, c->head, err);
    opts.octaves = opts.force = 1;
    opts.m0 = c->scale[c->n_scales - 1].m;
    opts.m1 = c->scale[0].m;
    opts.accuracy = 1e-12;
    if (st != SS_OK || (st = ss_morlet_new(&s->plan, c->n, c->head->rate, &opts, err)) != SS_OK)
        return st;
    int same = s->plan->n_scales == c->n_scales;
    for (size_t i = 0; same && i < c->n_scales; i++)
        same = s->plan->scale[i].j == c->scale[i].j && s->plan->scale[i].n == c->scale[i].n;
    return same ? SS_OK : ss_fail(err, SS_EDATA, "scales are missing between the longest and the shortest");
}

/* Choose the power of two by which the coefficients' squares neither overflow nor vanish. */
static ss_status
choose_unit(solver *s, size_t most, ss_error *err)
{
    const ss_coefficients *c = s->coef;
    double largest = 0;
    ss_status st = SS_OK;
    for (size_t i = 0; i < c->n_scales; i++)
        for (size_t k = 0, n; st == SS_OK && k < c->scale[i].n; k += n) {
            n = c->scale[i].n - k < most ? c->scale[i].n - k : most;
            st = ss_map_read(c, &(ss_map_part){ i, k, n, s->given, NULL }, 1, err);
            for (size_t v = 0; st == SS_OK && v < 2 * n; v++)
                largest = fmax(largest, fabs(s->given[v]));
        }
    frexp(largest, &s->exponent);
    return st;
}

static ss_status
make_room(solver *s, ss_error *err)
{
    const ss_morlet *plan = s->plan;
    size_t n = plan->n, most = 0;
    for (size_t i = 0; i < plan->n_scales; i++)
        most = plan->scale[i].n > most ? plan->scale[i].n : most;
    most = most < ss_morlet_part_most(plan) ? most : ss_morlet_part_most(plan);
    s->part = malloc(2 * most * sizeof *s->part);
    s->given = malloc(2 * most * sizeof *s->given);
    s->room = ss_columns_new(5, n + 1);
    if (s->part == NULL || s->given == NULL || s->room == NULL
        || ss_real_fft_new(&s->forth, 2 * n, 0) != SS_OK || ss_real_fft_new(&s->back, 2 * n, 1) != SS_OK
        || ss_blocks_scratch(plan->blocks, &s->scratch) != SS_OK || ss_morlet_keep_wavelets(s->plan) != SS_OK)
        return SS_ENOMEM;
    s->gradient = s->room[0], s->levelled = s->room[1], s->step = s->room[2];
    s->image = s->room[3], s->gain = s->room[4];
    if (plan->blocks != NULL && (s->sums = ss_block_sums_new(plan->blocks)) == NULL)
        return SS_ENOMEM;
    return choose_unit(s, most, err);
}

static void
release(solver *s)
{
    free(s->part);
    free(s->given);
    ss_real_fft_free(&s->forth);
    ss_real_fft_free(&s->back);
    free(s->room);
    ss_blocks_scratch_free(s->scratch);
    ss_block_sums_free(s->sums);
    ss_morlet_free(s->plan);
}

ss_status
ss_morlet_inverse(ss_signal **out, const ss_coefficients *coefficients, double tol,
                  double *error, ss_progress progress, ss_error *err)
{
    if (out == NULL || coefficients == NULL)
        return SS_FAIL_NULL(err);
    enum { BOUNDS_MAX = 100 };
    solver s = { .coef = coefficients, .progress = progress };
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
        st = make_room(&s, err);
    if (st == SS_OK)
        st = ss_signal_new(out, coefficients->head, coefficients->n, NULL);
    if (st == SS_OK) {
        ss_header_forget((*out)->head, ss_coefficient_notes);
        s.x = (*out)->values;
        set_gains(&s, tol);
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
