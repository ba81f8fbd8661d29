/* test_column.c -- power, noise and distance from a sinusoid of what a law is fitted to: closed forms.
 *
 * Noise is a median of differences, known to some 2 / sqrt n, 3 % of its variance: 10 % is allowed. */
#include <math.h>
#include <string.h>
#include "fit/column.h"
#include "new_signal.h"
#include "uniform.h"

enum { N = 40000 };
static double x[N];
static char missing[N];
static uint64_t seed;

static double
gauss(void)
{
    double u = uniform(&seed) + 1e-18;
    return sqrt(-2 * log(u)) * cos(2 * M_PI * uniform(&seed));
}

/* Of so many samples the second and the third are not those of the motion. */
static const char *
spoil(size_t of)
{
    memset(missing, 0, sizeof missing);
    for (size_t i = 1; i + 1 < N; i += of) {
        missing[i] = missing[i + 1] = 1;
        x[i] = 1e9, x[i + 1] = -2e9;
    }
    return missing;
}

static void
assert_noise(const char *missing_there, double samples, double truth)
{
    rank_record r = { .x = x, .missing = missing_there, .n = N, .rate = 1 };
    assert_int_equal(ss_record_noise(&r, samples), SS_OK);
    if (!(fabs(r.noise / truth - 1) < .1))
        fail_msg("noise of variance %g, not %g", r.noise, truth);
}

/* White noise of variance .01 about slow motion, and about one without order that repeats after 64 samples. */
static void
motion_is_no_noise(void **state)
{
    double repeated[64];
    (void)state;
    seed = 1;
    for (int i = 0; i < N; i++)
        x[i] = 10 * sin(2 * M_PI * i / 500) + .1 * gauss();
    assert_noise(NULL, 0, .01);
    assert_noise(NULL, N, .01);
    assert_noise(spoil(13), 0, .01);
    for (int i = 0; i < 64; i++)
        repeated[i] = gauss();
    for (int i = 0; i < N; i++)
        x[i] = repeated[i % 64] + .1 * gauss();
    assert_noise(NULL, 64, .01);
    assert_noise(NULL, 128, .01);
    assert_noise(spoil(13), 64, .01);
}

/* Differences of white noise: their fourth differences have C(10, 5) / 140 = 1.8 of their variance.  Those from
 * what is interpolated a part p of a sample later have 1 + q + c / 2, q = (1 - p)^2 + p^2, c = 2 p (p - 1). */
static void
cycles_of_parts_of_a_sample(void **state)
{
    (void)state;
    seed = 3;
    double before = gauss();
    for (int i = 0; i < N; i++) {
        double now = gauss();
        x[i] = .1 * (now - before) / sqrt(2);
        before = now;
    }
    assert_noise(NULL, 0, .01 * 1.8);
    for (double p = 0; p < 1; p += .25) {
        double q = (1 - p) * (1 - p) + p * p, c = -2 * p * (1 - p);
        assert_noise(NULL, 300 + p, .01 * (1 + q + c / 2) / (1 + q));
    }
    assert_noise(spoil(13), 300.5, .01 * 1.25 / 1.5);
}

/* A step of .5 that is seldom taken hides a twelfth of its square, and a ninth for noise of a third of it. */
static void
steps_of_a_converter(void **state)
{
    rank_record r = { .x = x, .n = N, .rate = 1 };
    (void)state;
    for (int i = 0; i < N; i++)
        x[i] = 1.5 * (i / 1000) - .5 * (i / 500 - i / 1000);
    assert_int_equal(ss_record_noise(&r, 0), SS_OK);
    assert_true(fabs(r.steps / (.25 * (1 / 12. + 1 / 9.)) - 1) < 1e-12 && r.noise == r.steps);
    memset(x, 0, sizeof x);
    assert_int_equal(ss_record_noise(&r, 0), SS_OK);
    assert_true(r.steps == 0 && r.noise == 0);
}

/* One difference is its own median, .6745 deviations. */
static void
few_samples(void **state)
{
    static const struct { size_t n; double x[5], samples, variance; } row[] = {
        { 5, { 0, 0, 1, 0, 0 }, 0, 36 / 70. / (.674489750196 * .674489750196) },
        { 4, { 0, .001, 1, 9 }, 2, .5 / (.674489750196 * .674489750196) },
        { 4, { 0, .6, 0, 0 }, 0, .07 },         /* its steps alone */
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        rank_record r = { .x = row[i].x, .n = row[i].n, .rate = 1 };
        assert_int_equal(ss_record_noise(&r, row[i].samples), SS_OK);
        if (!(fabs(r.noise / row[i].variance - 1) < 1e-9))
            fail_msg("row %zu: %g, not %g", i, r.noise, row[i].variance);
    }
}

/* 3 + 2 cos of a thousand whole periods, and .1 that alternates. */
static void
power_and_distance_from_a_sinusoid(void **state)
{
    double left;
    (void)state;
    for (int i = 0; i < N; i++)
        x[i] = 3 + 2 * cos(2 * M_PI * i / 40 + 1) + (i % 2 ? .1 : -.1);
    rank_record r = { .x = x, .n = N, .rate = 2 };
    assert_true(fabs(ss_record_power(&r) / 2.01 - 1) < 1e-12);
    assert_int_equal(ss_record_sinusoid(&r, .05, &left), SS_OK);
    assert_true(fabs(left / .01 - 1) < 1e-9);
    assert_int_equal(ss_record_sinusoid(&r, .06, &left), SS_OK);
    assert_true(fabs(left / 2.01 - 1) < 1e-6);
    r.missing = spoil(101);
    assert_true(fabs(ss_record_power(&r) / 2.01 - 1) < 1e-2);
    assert_int_equal(ss_record_sinusoid(&r, .05, &left), SS_OK);
    assert_true(fabs(left / .01 - 1) < 1e-2);
}

/* A scene is in SI units without a prefix; a column without a unit is trusted. */
static void
columns_that_can_be_fitted(void **state)
{
    static const struct { const char *unit; ss_quantity quantity; ss_status status; } row[] = {
        { "m", SS_DISPLACEMENT, SS_OK }, { "", SS_DISPLACEMENT, SS_OK }, { "mm", SS_DISPLACEMENT, SS_EDATA },
        { "m/s", SS_DISPLACEMENT, SS_EDATA }, { "N", SS_DISPLACEMENT, SS_EDATA }, { "m/s", SS_VELOCITY, SS_OK },
        { "m/s^2", SS_ACCELERATION, SS_OK }, { "g", SS_ACCELERATION, SS_EDATA },
        { "m", SS_ACCELERATION, SS_EDATA },
        { "N", SS_FORCE, SS_OK }, { "", SS_FORCE, SS_OK }, { "kN", SS_FORCE, SS_EDATA },
        { "m", SS_FORCE, SS_EDATA } };
    ss_rank_opts opts;
    ss_error err = { 0 };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *signal = new_signal(3, 1, 0, "y", row[i].unit);
        if (ss_column_check_unit(signal, 0, row[i].quantity, &err) != row[i].status)
            fail_msg("'%s' as quantity %d", row[i].unit, row[i].quantity);
        ss_signal_free(signal);
    }
    ss_signal *signal = new_signal(3, 1, 0, "y", NULL);
    ss_rank_opts_init(&opts, sizeof opts);
    assert_int_equal(ss_column_check(signal, 0, &opts, &err), SS_OK);
    assert_int_equal(ss_column_check(signal, 1, &opts, &err), SS_EINVAL);
    assert_string_equal(err.text, "there is no column 2");
    signal->values[2] = NAN;
    assert_int_equal(ss_column_check(signal, 0, &opts, &err), SS_EDATA);
    assert_string_equal(err.text, "row 3 is not finite");
    ss_signal_free(signal);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motion_is_no_noise), cmocka_unit_test(cycles_of_parts_of_a_sample),
        cmocka_unit_test(steps_of_a_converter), cmocka_unit_test(few_samples),
        cmocka_unit_test(power_and_distance_from_a_sinusoid),
        cmocka_unit_test(columns_that_can_be_fitted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
