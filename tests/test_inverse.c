/* test_inverse.c -- a signal from its coefficients: transform, invert, compare. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "map/map.h"

#include "map/fft/blocks.h"
#include "morlet_plan.h"
#include "new_signal.h"
#include "unit.h"

enum { N = 8009 };                      /* a prime */

/* Tones from 30 to 205 Hz one after the other, nothing at the ends: all within the labels. */
static ss_signal *
some_signal(double size)
{
    ss_signal *signal = new_signal(N, 2000, 1.5, "a", "m/s^2");
    for (int i = 0; i < N; i++)
        for (int m = 0; m < 6; m++) {
            double t = i / 2000., u = (t - 0.75 - 0.5 * m) / 0.12;
            signal->values[i] += size * exp(-u * u) * cos(2 * M_PI * (30 + 35 * m) * t + m);
        }
    return signal;
}

static ss_coefficients *
coefficients_of(const ss_signal *signal, ss_morlet_opts opts)
{
    ss_coefficients *coef;
    opts.fmin = 10, opts.fmax = opts.fmax > 0 ? opts.fmax : 280, opts.accuracy = 1e-12;
    assert_int_equal(ss_morlet_transform(&coef, signal, 0, &opts, NULL), SS_OK);
    return coef;
}

/* Root mean square of the difference over that of the signal. */
static double
difference(const ss_signal *a, const ss_signal *b)
{
    double off = 0, all = 0, unit = 0;
    assert_int_equal(a->n, b->n);
    for (size_t i = 0; i < a->n; i++)
        unit = fmax(unit, fabs(b->values[i]));
    for (size_t i = 0; i < a->n; i++) {
        double x = a->values[i] / unit, y = b->values[i] / unit;
        off += (x - y) * (x - y);
        all += y * y;
    }
    return sqrt(off / all);
}

#define GRID .size = sizeof(ss_morlet_opts)

static const ss_morlet_opts fine[] = {
    { GRID, .center = 6, .voices = 16, .step = 0.25 },
    { GRID, .center = 6, .voices = 8, .step = 0.25, .norm = SS_NORM_L1 },
    { GRID, .center = 3, .voices = 4,  .step = 0.5,  .admissible = 1 },
    { GRID, .center = 6, .voices = 4,  .dense = 1 },
    { GRID, .center = 6, .voices = 2,  .step = 0.5,  .norm = SS_NORM_L1 },
    { GRID, .center = 10, .voices = 6, .step = 0.4 },
    { GRID, .center = 3, .voices = 4,  .step = 0.5, .fmax = 800, .force = 1 },      /* blocks end at 477 Hz */
};

static void
transform_is_inverted_as_well_as_is_said(void **state)
{
    static const double tol[] = { 1e-3, 1e-5, 3e-6, 1e-6, 1e-9 }, size[] = { 1, 1, 1, 1e-200, 1e150 };
    (void)state;
    for (size_t i = 0; i < LENGTH(fine); i++)
        for (size_t k = 0; k < LENGTH(tol); k++) {
            ss_morlet_opts opts = fine[i];
            ss_error err = { 0 };
            double said = NAN;
            opts.threads = 1;
            ss_signal *signal = some_signal(i == 0 ? size[k] : 1), *back;
            ss_coefficients *coef = coefficients_of(signal, opts);
            if (ss_morlet_inverse(&back, coef, tol[k], &said, (ss_progress){ NULL, NULL }, &err) != SS_OK)
                fail_msg("row %zu: %s", i, err.text);
            double error = difference(back, signal);
            /* said is about right; 1e-9 is for what of the tones lies beyond the labels */
            if (!(said <= 4 * tol[k] && error <= 5 * said + 1e-9))
                fail_msg("row %zu: error %g, %g was said, %g asked for", i, error, said, tol[k]);
            assert_string_equal(back->head->column[0].unit, "m/s^2");
            assert_true(back->head->start == 1.5 && back->head->rate == 2000);
            ss_signal_free(back);
            ss_signal_free(signal);
            ss_coefficients_free(coef);
        }
}

/* The part of the coefficients that a signal does not explain, by the sum of the definition. */
static double
unexplained(const ss_signal *signal, const ss_coefficients *coef, ss_morlet_opts opts)
{
    double off = 0, all = 0;
    opts.engine = SS_ENGINE_QUADRATURE;
    ss_coefficients *own = coefficients_of(signal, opts);
    assert_int_equal(own->n_scales, coef->n_scales);
    for (size_t i = 0; i < coef->n_scales; i++) {
        const ss_scale *sc = &coef->scale[i];
        double weight = sc->b_num / sc->b_den / (opts.norm == SS_NORM_L1 ? 1 : sc->a);
        for (size_t k = 2 * sc->offset; k < 2 * (sc->offset + sc->n); k++) {
            off += weight * (own->w[k] - coef->w[k]) * (own->w[k] - coef->w[k]);
            all += weight * coef->w[k] * coef->w[k];
        }
    }
    ss_coefficients_free(own);
    return sqrt(off / all);
}

static void
explains_the_coefficients_as_well_as_asked(void **state)
{
    (void)state;
    for (size_t i = 0; i < LENGTH(fine); i++) {
        ss_morlet_opts opts = fine[i];
        ss_signal *signal = some_signal(1), *back;
        opts.threads = 1;
        ss_coefficients *coef = coefficients_of(signal, opts);
        for (double tol = 1e-2; tol > 1e-12; tol *= 1e-3) {
            assert_int_equal(ss_morlet_inverse(&back, coef, tol, NULL, (ss_progress){ NULL, NULL }, NULL),
                             SS_OK);
            double left = unexplained(back, coef, opts);
            if (!(left <= 1.01 * tol + 1e-12))
                fail_msg("row %zu: %g is left, %g asked for", i, left, tol);
            ss_signal_free(back);
        }
        ss_signal_free(signal);
        ss_coefficients_free(coef);
    }
}

/* A map of one scale says little of the signal, but its inverse must have the same coefficients. */
static void
one_scale_is_explained(void **state)
{
    const ss_morlet_opts opts = { GRID, .center = 6, .voices = 1, .step = 0.25, .octaves = 1, .m0 = -6, .m1 = -6,
                                  .threads = 1, .accuracy = 1e-12 };
    ss_signal *signal = some_signal(1), *back;
    ss_coefficients *coef, *own;
    ss_error err = { 0 };
    double off = 0, all = 0;
    (void)state;
    assert_int_equal(ss_morlet_transform(&coef, signal, 0, &opts, NULL), SS_OK);
    assert_int_equal(coef->n_scales, 1);
    if (ss_morlet_inverse(&back, coef, 1e-3, NULL, (ss_progress){ NULL, NULL }, &err) != SS_OK)
        fail_msg("%s", err.text);
    assert_int_equal(ss_morlet_transform(&own, back, 0, &opts, NULL), SS_OK);
    for (size_t k = 0; k < 2 * coef->scale[0].n; k++) {
        off += (own->w[k] - coef->w[k]) * (own->w[k] - coef->w[k]);
        all += coef->w[k] * coef->w[k];
    }
    assert_true(sqrt(off / all) <= 1.01e-3);
    ss_coefficients_free(coef);
    ss_coefficients_free(own);
    ss_signal_free(signal);
    ss_signal_free(back);
}

/* --- the adjoint ------------------------------------------------------------------------------ */

/* Samples by the sum over coefficients of Re(w h), in units of a^1/2. */
static long double
sum_at(const ss_scale *sc, const ss_morlet_opts *opts, double rate, const double *w, size_t n)
{
    const long double wc = opts->center, second = opts->admissible ? expl(-wc * wc / 2) : 0;
    double parts = ss_scale_parts(sc, rate);
    long double sum = 0;
    for (size_t k = 0; k < sc->n; k++) {
        spot at = ss_scale_spot(sc, k, rate);       /* a translation next to a sample is that sample */
        long double tau = parts > 0 ? (long double)k * sc->b_num / parts - (long double)at.c : at.tau;
        long double u = ((long double)n - (long double)at.c - tau) / ((long double)sc->a * rate);
        if (fabsl(u) < 12)
            sum += expl(-u * u / 2) * (w[2 * k] * (cosl(wc * u) - second) - w[2 * k + 1] * sinl(wc * u));
    }
    return sum * powl(acosl(-1), -0.25L) / ((long double)sc->a * rate);
}

/* x becomes the adjoint of scale i, in blocks where these cover it; random coefficients into w. */
static void
adjoint(const ss_morlet *plan, block_sums *sums, size_t i, double *scratch, double *w, double *x)
{
    const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
    make(NOISE, w, 2 * sc->n);
    memset(x, 0, plan->n * sizeof *x);
    if (!ss_blocks_covers(plan->blocks, i)) {
        wavelet *wave = ss_wavelet_new(&plan->opts, sc->a, plan->rate, plan->n);
        for (size_t k = 0; k < sc->n; k++)
            ss_wavelet_add(wave, plan->n, ss_scale_spot(sc, k, plan->rate), w + 2 * k, x);
        ss_wavelet_free(wave);
        return;
    }
    for (size_t k = 0, n; k < sc->n; k += n) {
        n = ss_blocks_rest(plan->blocks, i, k);
        n = n < sc->n - k ? n : sc->n - k;
        ss_block_sums_add(sums, i, scratch, (span){ k, n }, 1, w + 2 * k);
    }
    assert_int_equal(ss_block_sums_end(sums, x), SS_OK);
}

/* To 16 eps of the largest that coefficients of size 1 can make, the sum of |h| over translations. */
static void
adjoint_is_the_sum(void **state)
{
    static const ss_morlet_opts grid[] = {
        { GRID, .center = 6, .voices = 3, .step = 0.25 },
        { GRID, .center = 3, .voices = 2, .step = 0.7, .admissible = 1 },
        { GRID, .center = 6, .voices = 3, .dense = 1 },
        { GRID, .center = 2, .voices = 1, .dense = 1, .admissible = 1 },
        { GRID, .center = 6, .voices = 3, .step = 0.3, .exact = 1 },
        { GRID, .center = 40, .voices = 2, .step = 2 },
        { GRID, .center = 5, .voices = 1, .step = 1 },
        { GRID, .center = 6, .voices = 3, .step = 0.25, .engine = SS_ENGINE_QUADRATURE },
        { GRID, .center = 3, .voices = 2, .step = 0.7, .engine = SS_ENGINE_QUADRATURE, .admissible = 1 },
        { GRID, .center = 6, .voices = 3, .step = 0.3, .engine = SS_ENGINE_QUADRATURE, .exact = 1 },
    };
    static const size_t length[] = { 8009, 700 };
    (void)state;
    for (size_t g = 0; g < LENGTH(grid) * LENGTH(length); g++) {
        ss_morlet_opts opts = grid[g / LENGTH(length)];
        size_t n = length[g % LENGTH(length)], blocks = 0;
        opts.engine = opts.engine == SS_ENGINE_AUTO ? SS_ENGINE_FFT : opts.engine;
        opts.accuracy = 1e-12, opts.threads = 1;
        ss_morlet *plan = plan_of(n, 1500, &opts);
        block_sums *sums = plan->blocks != NULL ? ss_block_sums_new(plan->blocks) : NULL;
        double *w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w), *x = malloc(n * sizeof *x), *scratch;
        assert_int_equal(ss_blocks_scratch(plan->blocks, &scratch), SS_OK);
        for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++) {
            const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
            double error = 0, sum_of_h = 1.88 / (1500 * sc->b_num / sc->b_den);
            double allow = 16 * DBL_EPSILON * sum_of_h;
            blocks += ss_blocks_covers(plan->blocks, i);
            adjoint(plan, sums, i, scratch, w, x);
            for (size_t k = 0; k < n; k += k < 9 || k + 9 > n ? 1 : 97)
                error = fmax(error, fabs(x[k] - (double)sum_at(sc, &opts, 1500, w, k)));
            if (!(error <= allow))
                fail_msg("row %zu, scale %zu: %g times the bound", g, i, error / allow);
        }
        assert_true(opts.engine == SS_ENGINE_FFT ? blocks > 3 : blocks == 0);
        ss_block_sums_free(sums);
        ss_blocks_scratch_free(scratch);
        ss_morlet_free(plan);
        free(w);
        free(x);
    }
}

static void
assert_refused(const ss_coefficients *coef, double tol, ss_status status, const char *says)
{
    ss_signal *back = NULL;
    ss_error err = { 0 };
    ss_status st = ss_morlet_inverse(&back, coef, tol, NULL, (ss_progress){ NULL, NULL }, &err);
    if (st != status || back != NULL || strstr(err.text, says) == NULL)
        fail_msg("'%s' expected, not %d, '%s'", says, st, err.text);
}

static void
refuses_what_has_no_inverse(void **state)
{
    static const ss_morlet_opts coarse[] = {
        { GRID, .center = 20, .voices = 1, .step = 0.5, .threads = 1 },
        { GRID, .center = 6,  .voices = 8, .step = 5,   .threads = 1 },
    };
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_signal *signal = some_signal(1);
    (void)state;
    for (size_t i = 0; i < LENGTH(coarse); i++) {
        ss_coefficients *coef = coefficients_of(signal, coarse[i]);
        assert_refused(coef, 1e-6, SS_ESCALE, "too coarse");
        ss_coefficients_free(coef);
    }
    opts.voices = 4;
    ss_coefficients *coef = coefficients_of(signal, opts);
    assert_refused(coef, 1e-13, SS_EINVAL, "out of range");
    coef->w[2 * coef->scale[5].offset + 300] += 1;      /* one that no signal can have alone */
    assert_refused(coef, 1e-6, SS_ETOL, "no signal has these");
    coef->n_scales--;                                   /* without the last, in order still */
    coef->scale[4].j++;
    assert_refused(coef, 1e-6, SS_EDATA, "scales are missing");
    ss_header_free(coef->head);
    ss_header_select(&coef->head, signal->head, NULL, signal->head->n_columns, 0, NULL);
    assert_refused(coef, 1e-6, SS_EDATA, "lack their option 'voices'");
    ss_coefficients_free(coef);
    ss_signal_free(signal);
}

static void
nothing_gives_nothing(void **state)
{
    ss_signal *signal = some_signal(0), *back;
    double said = NAN;
    (void)state;
    ss_coefficients *coef = coefficients_of(signal, ss_morlet_defaults);
    assert_int_equal(ss_morlet_inverse(&back, coef, 1e-6, &said, (ss_progress){ NULL, NULL }, NULL), SS_OK);
    assert_true(said == 0);
    for (size_t i = 0; i < back->n; i++)
        assert_true(back->values[i] == 0);
    ss_signal_free(back);
    ss_signal_free(signal);
    ss_coefficients_free(coef);
}

typedef struct watcher {
    double last, stop_at;
    int back;
} watcher;

static int
watch(double done, void *user)
{
    watcher *w = user;
    w->back += !(done >= w->last && done <= 1);
    w->last = done;
    return done >= w->stop_at;
}

static void
progress_rises_and_may_stop(void **state)
{
    ss_signal *signal = some_signal(0), *back = NULL;
    watcher whole = { 0, 2, 0 }, half = { 0, 0.5, 0 };
    (void)state;
    for (size_t i = 0; i < signal->n; i++)
        signal->values[i] = sin(0.3 * (double)i) + sin(1e-4 * (double)i * (double)i);
    ss_coefficients *coef = coefficients_of(signal, ss_morlet_defaults);
    assert_int_equal(ss_morlet_inverse(&back, coef, 1e-2, NULL, (ss_progress){ watch, &whole },
                                       NULL), SS_OK);
    assert_true(whole.last > 0.5 && whole.back == 0);
    ss_signal_free(back);
    assert_int_equal(ss_morlet_inverse(&back, coef, 1e-2, NULL, (ss_progress){ watch, &half },
                                       NULL), SS_STOP);
    assert_true(back == NULL && half.last >= 0.5);
    ss_signal_free(signal);
    ss_coefficients_free(coef);
}

static int
count(double done, void *user)
{
    (void)done;
    ++*(int *)user;
    return 0;
}

static void
white_noise_takes_some_hundred_passes_or_is_refused_with_their_number(void **state)
{
    ss_signal *signal = new_signal(4000, 1000, 0, "a", NULL), *back;
    ss_morlet_opts opts = ss_morlet_defaults;
    int passes = 0;
    (void)state;
    make(NOISE, signal->values, signal->n);
    opts.accuracy = 1e-12;
    ss_coefficients *coef;
    assert_int_equal(ss_morlet_transform(&coef, signal, 0, &opts, NULL), SS_OK);
    assert_int_equal(ss_morlet_inverse(&back, coef, 1e-5, NULL, (ss_progress){ count, &passes }, NULL), SS_OK);
    assert_in_range(passes, 10, 150);
    assert_refused(coef, 1e-9, SS_ETOL, "passes: what lies at the edge");
    ss_signal_free(back);
    ss_signal_free(signal);
    ss_coefficients_free(coef);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transform_is_inverted_as_well_as_is_said),
        cmocka_unit_test(explains_the_coefficients_as_well_as_asked),
        cmocka_unit_test(one_scale_is_explained),
        cmocka_unit_test(adjoint_is_the_sum),
        cmocka_unit_test(refuses_what_has_no_inverse),
        cmocka_unit_test(nothing_gives_nothing),
        cmocka_unit_test(progress_rises_and_may_stop),
        cmocka_unit_test(white_noise_takes_some_hundred_passes_or_is_refused_with_their_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
