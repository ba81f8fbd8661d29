/* The one least squares of all fits, against certified values, closed forms and models that fail. */
#include <gsl/gsl_errno.h>
#include <math.h>
#include <string.h>
#include "base/least.h"
#include "find/medians.h"
#include "uniform.h"
#include "unit.h"

/* Misra1a of the Statistical Reference Datasets (NIST, 1978): y = b1 (1 - exp(-b2 x)). */
static const double misra_y[] = { 10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01,
                                  66.40, 75.47, 81.78 };
static const double misra_x[] = { 77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8,
                                  593.1, 689.1, 760.0 };
enum { MISRA = sizeof misra_x / sizeof *misra_x };

static void
near_to(double x, double truth, double tol)
{
    if (!(fabs(x - truth) <= tol))
        fail_msg("%.15g, not %.15g +- %.1e", x, truth, tol);
}

typedef struct counted {
    int runs;
} counted;

static ss_status
misra(const double *u, double *residual, double *slopes, void *user)
{
    counted *c = user;
    c->runs += slopes == NULL;
    for (size_t i = 0; i < MISRA; i++) {
        double e = exp(-u[1] * misra_x[i]);
        if (slopes == NULL)
            residual[i] = u[0] * (1 - e) - misra_y[i];
        else {
            slopes[2 * i] = 1 - e;
            slopes[2 * i + 1] = u[0] * misra_x[i] * e;
        }
    }
    return SS_OK;
}

static void
finds_the_certified_values(void **state)
{
    static const double step[] = { 1e-4, 1e-10 }, from[][2] = { { 500, 1e-4 }, { 250, 5e-4 } };
    static const double value[] = { 2.3894212918e+02, 5.5015643181e-04 };
    static const double error[] = { 2.7070075241e+00, 7.2668688436e-06 };
    (void)state;
    for (int i = 0; i < 6; i++) {
        counted c = { 0 };
        least fit = { .rows = MISRA, .unknowns = 2, .model = misra, .user = &c, .steps = 200, .tol = 1e-9,
                      .difference = i / 2 == 0 ? NULL : step, .costly = i / 2 == 2 };
        double u[2] = { from[i % 2][0], from[i % 2][1] }, covariance[4], residual[MISRA], squares = 0;
        least_end end;
        assert_int_equal(ss_least_fit(&end, &fit, u, residual, covariance), SS_OK);
        assert_true(end.converged);
        near_to(end.squares, 1.2455138894e-01, 1e-10);
        for (size_t k = 0; k < MISRA; k++)
            squares += residual[k] * residual[k];
        near_to(squares, end.squares, 1e-12);
        for (size_t k = 0; k < 2; k++) {
            near_to(u[k], value[k], 1e-6 * value[k]);
            double deviation = sqrt(end.squares / (MISRA - 2) * covariance[3 * k]);
            near_to(deviation, error[k], 1e-4 * error[k]);
        }
    }
}

enum { MANY = 8 };

static ss_status
bowl(const double *u, double *residual, double *slopes, void *user)
{
    counted *c = user;
    (void)slopes;
    c->runs++;
    for (size_t i = 0; i < MANY; i++)
        residual[i] = (u[i] - 1) * (1 + 0.1 * (u[i] - 1)) + 0.01 * u[(i + 1) % MANY];
    return SS_OK;
}

/* Old slopes cost less runs than those by differences at each step. */
static void
keeps_slopes_that_are_good(void **state)
{
    double step[MANY], squares[2];
    int runs[2];
    (void)state;
    for (size_t i = 0; i < MANY; i++)
        step[i] = 1e-6;
    for (int costly = 0; costly < 2; costly++) {
        counted c = { 0 };
        least fit = { .rows = MANY, .unknowns = MANY, .model = bowl, .user = &c, .steps = 200, .tol = 1e-7,
                      .difference = step, .costly = costly };
        double u[MANY] = { 2, 3, 2, 3, 2, 3, 2, 3 };
        least_end end;
        assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_OK);
        assert_true(end.converged);
        runs[costly] = c.runs;
        squares[costly] = end.squares;
    }
    if (!(runs[1] < runs[0]))
        fail_msg("%d runs, not less than %d", runs[1], runs[0]);
    near_to(squares[0], 0, 1e-12);
    near_to(squares[1], 0, 1e-12);
}

/* (u0 - 1), (u1 - 2), and nothing of u2. */
static ss_status
line(const double *u, double *residual, double *slopes, void *user)
{
    const double most = user != NULL ? *(double *)user : INFINITY;
    if (u[0] > most)
        return SS_EDATA;
    for (int i = 0; slopes == NULL && i < 3; i++)
        residual[i] = i < 2 ? u[i] - 1 - i : 0.5;
    if (slopes != NULL)
        slopes[0] = slopes[4] = 1;
    return SS_OK;
}

static void
keeps_to_the_ranges(void **state)
{
    const ss_range range[] = { { -5, 0.25 }, { 3, 3 }, { -INFINITY, INFINITY } };
    least fit = { .rows = 3, .unknowns = 3, .model = line, .steps = 100, .tol = 1e-9, .range = range };
    double u[3] = { -5, 3, 7 }, covariance[9];
    least_end end;
    (void)state;
    assert_int_equal(ss_least_fit(&end, &fit, u, NULL, covariance), SS_OK);
    assert_true(end.converged);
    near_to(u[0], 0.25, 1e-6);
    assert_true(u[0] <= 0.25);
    assert_true(u[1] == 3 && covariance[4] == 0);
    near_to(covariance[0], 1, 1e-12);
    assert_true(isinf(covariance[8]));          /* nothing shows it */
}

static void
goes_round_where_there_is_no_model(void **state)
{
    double most = 0.5;
    least fit = { .rows = 3, .unknowns = 3, .model = line, .user = &most, .steps = 100, .tol = 1e-9 };
    double u[3] = { -1, 0, 0 };
    least_end end;
    (void)state;
    assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_OK);
    assert_true(u[0] <= 0.5 && u[0] > 0);
    u[0] = 0.75;
    assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_OK);
    assert_false(end.converged);
    assert_string_equal(end.why, "there is no model where it starts");
    assert_true(u[0] == 0.75);
}

/* Slopes by a step back, where a step ahead has no model. */
static void
goes_back_where_there_is_no_model_ahead(void **state)
{
    static const double step[3] = { 1e-3, 1e-3, 1e-3 };
    const ss_range range[] = { { -INFINITY, INFINITY }, { -INFINITY, INFINITY }, { 7, 7 } };
    double most = 4, u[3] = { 3.9995, 5, 7 };
    least fit = { .rows = 3, .unknowns = 3, .model = line, .user = &most, .steps = 20, .tol = 1e-9,
                  .difference = step, .range = range };
    least_end end;
    (void)state;
    assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_OK);
    assert_true(end.converged);
    near_to(u[0], 1, 1e-8);
    near_to(u[1], 2, 1e-8);
}

/* user times (u0 + u1 - 3), and user times (u0 - u1): least at 1.5, 1.5; with u0 held at c, too, u1 = 1.5, and
 * (c - 1.5)^2 is left of each. */
static ss_status
coupled(const double *u, double *residual, double *slopes, void *user)
{
    const double by = *(double *)user;
    if (slopes == NULL)
        residual[0] = by * (u[0] + u[1] - 3), residual[1] = by * (u[0] - u[1]);
    else
        slopes[0] = slopes[1] = slopes[2] = by, slopes[3] = -by;
    return SS_OK;
}

static void
stays_at_an_end_of_a_range_and_leaves_it(void **state)
{
    static const struct { ss_range range; double from, to; } row[] = {
        { { -9, 1 }, 0, 1 }, { { -9, 1 }, 1, 1 }, { { 2, 9 }, 5, 2 }, { { 2, 9 }, 2, 2 },
        { { 0, 1.75 }, 1.75, 1.5 }, { { 1.25, 4 }, 1.25, 1.5 } };
    static const double by[] = { .1, 1, 30 };
    (void)state;
    for (size_t i = 0; i < 3 * (sizeof row / sizeof *row); i++) {
        const ss_range range[] = { row[i / 3].range, { -INFINITY, INFINITY } };
        double size = by[i % 3], u[2] = { row[i / 3].from, -7 }, left = size * (row[i / 3].to - 1.5);
        least fit = { .rows = 2, .unknowns = 2, .model = coupled, .user = &size, .steps = 60, .tol = 1e-9,
                      .range = range };
        least_end end;
        assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_OK);
        assert_true(end.converged);
        near_to(u[0], row[i / 3].to, 1e-6);
        near_to(u[1], 1.5, 1e-6);
        near_to(end.squares, 2 * left * left, 1e-6 * size * size);
    }
}

/* (u0 - 1)^3, which each step of Gauss and Newton lessens to 8 / 27, and u1 - 2, which the first one ends. */
static ss_status
slow(const double *u, double *residual, double *slopes, void *user)
{
    (void)user;
    if (slopes == NULL)
        residual[0] = pow(u[0] - 1, 3), residual[1] = u[1] - 2;
    else
        slopes[0] = 3 * pow(u[0] - 1, 2), slopes[3] = 1;
    return SS_OK;
}

/* Every unknown must be still, to a part tol; what the noise hides is not sought, but all that it does not. */
static void
ends_when_all_are_still_or_noise_hides_the_rest(void **state)
{
    least fit = { .rows = 2, .unknowns = 2, .model = slow, .steps = 40, .tol = 1e-3 };
    double u[2] = { 3, 2 };
    least_end end;
    (void)state;
    assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_OK);
    assert_true(end.converged && end.steps > 10);
    near_to(u[0], 1, 1e-2);        /* damping may shorten its steps */
    fit.tol = 1e-9, fit.noise = 1, fit.gain = .5;       /* squares of 64 and less: to .01 */
    u[0] = 3;
    assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_OK);
    assert_true(end.converged && end.steps < 10);
    near_to(u[0], 1, .6);
    u[0] = 2;                                           /* 1, far below the noise: still to .01 */
    assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_OK);
    near_to(u[0], 1, .4);
}

/* A gain of a hundredth of the noise's variance is a tenth of a standard error. */
static void
costly_models_end_within_a_part_of_their_errors(void **state)
{
    static const double step[] = { 1e-4, 1e-10 }, from[][2] = { { 500, 1e-4 }, { 250, 5e-4 }, { 100, 1e-3 } };
    (void)state;
    for (int i = 0; i < 6; i++) {
        counted c = { 0 };
        least fit = { .rows = MISRA, .unknowns = 2, .model = misra, .user = &c, .steps = 200, .tol = 1e-12,
                      .difference = step, .costly = 1, .noise = 1.2455138894e-01 / (MISRA - 2),
                      .farthest = i > 2 ? 50 : 0 };
        double u[2] = { from[i % 3][0], from[i % 3][1] };
        least_end end;
        assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_OK);
        assert_true(end.converged);
        near_to(end.squares, 1.2455138894e-01, .02 * fit.noise);
    }
}

static ss_status
stopping(const double *u, double *residual, double *slopes, void *user)
{
    int *left = user;
    return (*left)-- > 0 ? line(u, residual, slopes, NULL) : SS_STOP;
}

static void
hands_back_what_the_model_says(void **state)
{
    (void)state;
    for (int runs = 0; runs < 4; runs++) {
        int left = runs;
        least fit = { .rows = 3, .unknowns = 3, .model = stopping, .user = &left, .steps = 100, .tol = 1e-9 };
        double u[3] = { 9, 9, 9 };
        least_end end;
        assert_int_equal(ss_least_fit(&end, &fit, u, NULL, NULL), SS_STOP);
    }
}

static void
solves_what_is_linear(void **state)
{
    static const double x[] = { 1, 0, 0, 1, 1, 1, 1, 2, 2, 1, 3, 3 };       /* the last two columns are one */
    static const double y[] = { 1, 3, 5, 7 };
    double c[3], squares, covariance[9], columns[8];
    (void)state;
    for (size_t i = 0; i < 4; i++)
        columns[2 * i] = x[3 * i], columns[2 * i + 1] = x[3 * i + 1];
    assert_int_equal(ss_least_linear(columns, y, 4, 2, c, &squares, covariance), SS_OK);
    near_to(c[0], 1, 1e-13);
    near_to(c[1], 2, 1e-13);
    near_to(squares, 0, 1e-25);
    near_to(covariance[0], 0.7, 1e-13);
    near_to(covariance[1], -0.3, 1e-13);
    near_to(covariance[3], 0.2, 1e-13);
    assert_int_equal(ss_least_linear(x, y, 4, 3, c, &squares, NULL), SS_OK);
    near_to(c[1] + c[2], 2, 1e-12);
    near_to(squares, 0, 1e-25);
}

/* The mean of n values of y_i = phi y_i-1 + white noise has (1 + phi) / (1 - phi) times the variance of white ones,
 * whatever line they lie on; of alternating ones no less than 1 is said. */
static void
coloured_residuals_count_for_less(void **state)
{
    enum { N = 20000 };
    static const double phi[] = { -0.5, 0, 0.5, 0.8 }, truth[] = { 1, 1, 3, 9 };
    static double x[N], y[N];
    (void)state;
    for (size_t k = 0; k < sizeof phi / sizeof *phi; k++)
        for (int line = 0; line < 3; line++) {
            uint64_t seed = 340 + k;
            double last = 0;
            for (size_t i = 0; i < N; i++) {
                last = phi[k] * last + uniform(&seed) - 0.5;
                x[i] = line == 2 ? 1e-3 * (double)i * (double)i / N : (double)i;
                y[i] = last + (line > 0 ? 7 + 3 * x[i] : 0);
            }
            near_to(ss_colour(y, line == 2 ? x : NULL, N, line > 0 ? 3 : 0), truth[k], 0.15 * truth[k]);
        }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_the_certified_values),
        cmocka_unit_test(keeps_slopes_that_are_good),
        cmocka_unit_test(keeps_to_the_ranges),
        cmocka_unit_test(goes_round_where_there_is_no_model),
        cmocka_unit_test(goes_back_where_there_is_no_model_ahead),
        cmocka_unit_test(stays_at_an_end_of_a_range_and_leaves_it),
        cmocka_unit_test(ends_when_all_are_still_or_noise_hides_the_rest),
        cmocka_unit_test(costly_models_end_within_a_part_of_their_errors),
        cmocka_unit_test(hands_back_what_the_model_says),
        cmocka_unit_test(solves_what_is_linear),
        cmocka_unit_test(coloured_residuals_count_for_less),
    };
    gsl_set_error_handler_off();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
