/* test_inverse.c -- a signal from its coefficients: transform, invert, compare. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>

#include "new_signal.h"
#include "unit.h"

#define LENGTH(a) (sizeof (a) / sizeof *(a))
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
    opts.fmin = 10, opts.fmax = 280, opts.accuracy = 1e-12;
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

static const ss_morlet_opts fine[] = {
    { .center = 6, .voices = 16, .step = 0.25 },
    { .center = 6, .voices = 8, .step = 0.25, .norm = SS_NORM_L1 },
    { .center = 3, .voices = 4,  .step = 0.5,  .admissible = 1 },
    { .center = 6, .voices = 4,  .dense = 1 },
    { .center = 6, .voices = 2,  .step = 0.5,  .norm = SS_NORM_L1 },
    { .center = 10, .voices = 6, .step = 0.4 },
};

static void
transform_is_inverted_as_well_as_is_said(void **state)
{
    static const double tol[] = { 1e-3, 1e-6, 1e-9 }, size[] = { 1, 1e-200, 1e150 };
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
        { .center = 20, .voices = 1, .step = 0.5, .threads = 1 },
        { .center = 6,  .voices = 8, .step = 5,   .threads = 1 },
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
    coef->head = ss_header_copy(signal->head);
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

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transform_is_inverted_as_well_as_is_said),
        cmocka_unit_test(refuses_what_has_no_inverse),
        cmocka_unit_test(nothing_gives_nothing),
        cmocka_unit_test(progress_rises_and_may_stop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
