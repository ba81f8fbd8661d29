/* test_spectrum.c -- the power spectral density of what is known. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>

#include "signal/welch.h"
#include "unit.h"
#include "signal/noise.h"

enum { N = 1 << 16 };
#define RATE 1000.0

static ss_spectrum *
spectrum_of(const double *x, size_t n, double resolution)
{
    ss_spectrum *s;
    ss_error err = { 0 };
    if (ss_spectrum_new(&s, x, n, RATE, resolution, &err) != SS_OK)
        fail_msg("%s", err.text);
    return s;
}

/* 2 sigma^2 / rate at all frequencies: each density has an exponential distribution, and the mean of 255 segments,
 * which overlap, of 500 frequencies is right within 4 of its standard deviations, 0.1 %. */
static void
white_noise_is_flat(void **state)
{
    static double x[N];
    (void)state;
    assert_int_equal(ss_noise_add_once(x, N, 3, 1, NULL), SS_OK);
    ss_spectrum *s = spectrum_of(x, N, 1.5 * RATE / 512);
    assert_int_equal(s->n, 257);
    assert_int_equal(s->segments, 255);
    double mean = 0;
    for (size_t k = 2; k < 255; k++) {
        mean += s->density[k] / 253;
        assert_true(fabs(s->density[k] / (2 * 9 / RATE) - 1) < 0.5);
    }
    assert_true(fabs(mean / (2 * 9 / RATE) - 1) < 0.03);
    ss_spectrum_free(s);
}

/* A sinusoid's densities have its mean square as their sum, and are largest at its frequency; of a Hann
 * window's line there, 2/3 / step times the mean square. */
static void
a_sinusoid_has_its_power_at_its_frequency(void **state)
{
    static double x[N];
    (void)state;
    for (size_t i = 0; i < N; i++)
        x[i] = 7 + 2 * sin(2 * M_PI * 125 * (double)i / RATE);
    ss_spectrum *s = spectrum_of(x, N, 1.5 * RATE / 1024);
    double sum = 0;
    for (size_t k = 0; k < s->n; k++)
        sum += s->density[k] * s->step;
    assert_true(fabs(sum - 2) < 1e-9);
    assert_true(fabs(s->density[128] * s->step - 2 * 2 / 3.0) < 1e-9);
    assert_true(s->density[10] < 1e-20);
    assert_true(fabs(s->resolution - 1.5 * RATE / 1024) < 1e-12 && fabs(s->step * 128 - 125) < 1e-12);
    ss_spectrum_free(s);
}

/* By the definition, a segment of 16 samples. */
static void
one_segment_is_the_definition(void **state)
{
    double x[16], mean = 0, power = 0;
    (void)state;
    for (int i = 0; i < 16; i++)
        mean += (x[i] = cos(i * i) + 0.1 * i) / 16;
    ss_spectrum *s = spectrum_of(x, 16, 1.5 * RATE / 16);
    assert_int_equal(s->segments, 1);
    for (int i = 0; i < 16; i++)
        power += pow(0.5 - 0.5 * cos(2 * M_PI * i / 16), 2);
    for (int k = 0; k <= 8; k++) {
        double re = 0, im = 0;
        for (int i = 0; i < 16; i++) {
            double y = (x[i] - mean) * (0.5 - 0.5 * cos(2 * M_PI * i / 16));
            re += y * cos(2 * M_PI * i * k / 16);
            im += y * sin(2 * M_PI * i * k / 16);
        }
        double truth = (re * re + im * im) / power / RATE * (k == 0 || k == 8 ? 1 : 2);
        assert_true(fabs(s->density[k] - truth) < 1e-14);
    }
    ss_spectrum_free(s);
}

static void
lengths_follow_the_resolution(void **state)
{
    static double x[N];
    ss_spectrum *s;
    ss_error err = { 0 };
    (void)state;
    s = spectrum_of(x, 1000, 0);
    assert_true(s->n == 65 && s->segments == 14);
    ss_spectrum_free(s);
    s = spectrum_of(x, 1024, 0);
    assert_true(s->n == 129 && s->segments == 7);
    ss_spectrum_free(s);
    s = spectrum_of(x, N, 10);
    assert_true(s->resolution >= 10 && s->resolution < 20);
    ss_spectrum_free(s);
    assert_int_equal(ss_spectrum_new(&s, x, 15, RATE, 0, &err), SS_EINVAL);
    assert_int_equal(ss_spectrum_new(&s, x, 1000, RATE, 1, &err), SS_EINVAL);
    assert_int_equal(ss_spectrum_new(&s, x, 1000, RATE, 200, &err), SS_EINVAL);
    assert_int_equal(ss_spectrum_new(&s, x, 1000, 0, 0, &err), SS_EINVAL);
    x[5] = INFINITY;
    assert_int_equal(ss_spectrum_new(&s, x, 1000, RATE, 0, &err), SS_EINVAL);
    x[5] = 1e200;
    assert_int_equal(ss_spectrum_new(&s, x, 1000, RATE, 0, &err), SS_ERANGE);
}

/* Of pieces of any length; of a long record, whose segments nobody chose, at most 2^22 samples each. */
static void
a_spectrum_comes_from_pieces_too(void **state)
{
    static double x[N];
    ss_welch *welch;
    ss_spectrum *pieces;
    ss_error err = { 0 };
    (void)state;
    assert_int_equal(ss_noise_add_once(x, N, 3, 1, NULL), SS_OK);
    ss_spectrum *whole = spectrum_of(x, 60000, 0);
    assert_int_equal(ss_welch_new(&welch, 60000, RATE, 0, &err), SS_OK);
    for (size_t i = 0, n = 1; i < 60000; i += n, n = 3 * n % 7001)
        assert_int_equal(ss_welch_add(welch, x + i, i + n < 60000 ? n : 60000 - i, &err), SS_OK);
    assert_int_equal(ss_welch_end(&pieces, welch, &err), SS_OK);
    assert_int_equal(pieces->n, whole->n);
    assert_int_equal(pieces->segments, whole->segments);
    for (size_t k = 0; k < whole->n; k++)
        assert_true(pieces->density[k] == whole->density[k]);
    ss_spectrum_free(pieces);
    ss_spectrum_free(whole);
    ss_welch_free(welch);
    assert_int_equal(ss_welch_new(&welch, 1000000000, RATE, 0, &err), SS_OK);
    assert_int_equal(ss_welch_add(welch, (double[]){ 1, 2, INFINITY }, 3, &err), SS_EINVAL);
    assert_string_equal(err.text, "sample 3 is not finite");
    assert_int_equal(ss_welch_end(&pieces, welch, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "at least 4194304 samples, not 3"));
    ss_welch_free(welch);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_noise_is_flat),
        cmocka_unit_test(a_sinusoid_has_its_power_at_its_frequency),
        cmocka_unit_test(one_segment_is_the_definition),
        cmocka_unit_test(lengths_follow_the_resolution),
        cmocka_unit_test(a_spectrum_comes_from_pieces_too),
    };
    return cmocka_run_group_tests_name("spectrum", tests, NULL, NULL);
}
