/* test_taylor.c -- the method taylor: its error against long double, its events against the closed
 * form. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "extremes/runs.h"
#include "oracle.h"
#include "shipped.h"
#include "uniform.h"
#include "unit.h"
#include "scene/key.h"

enum { SCENES = 60, SAMPLES = 101 };

static double
about(uint64_t *seed, double x, double factor)
{
    return x * pow(factor, 2 * uniform(seed) - 1);
}

/* Within a factor of 5 of the shipped one in all numbers, over 2 s. */
static ss_scene
random_scene(uint64_t *seed)
{
    ss_scene s = read_shipped_named("state-variable");
    s.mass = about(seed, s.mass, 5);
    s.stiffness = about(seed, s.stiffness, 5);
    s.friction = about(seed, s.friction, 5);
    s.base_amplitude = about(seed, s.base_amplitude, 5);
    s.base_frequency = about(seed, s.base_frequency, 5);
    ss_scene_set(&s, "alpha", about(seed, ss_scene_get(&s, "alpha"), 5), NULL);
    ss_scene_set(&s, "gamma", about(seed, ss_scene_get(&s, "gamma"), 5), NULL);
    s.phase = 2 * M_PI * uniform(seed);
    s.settle = 0;
    s.duration = 2;
    s.rate = SAMPLES / s.duration;
    return s;
}

/* Of x over its scale. */
static double
error_of(const ss_scene *s, double tol, const double *x)
{
    run r = run_with(s, "taylor", tol, 0);
    double worst = 0;
    if (r.status != SS_OK)
        fail_msg("taylor at %g: %s", tol, r.err.text);
    for (size_t i = 0; i < SAMPLES; i++)
        worst = fmax(worst, fabs(r.sample[i].x - x[i]));
    run_free(&r);
    return worst / scale_of(s);
}

static int
ascending(const void *a, const void *b)
{
    double d = *(const double *)a - *(const double *)b;
    return (d > 0) - (d < 0);
}

static void
errors_are_about_the_tolerance(void **state)
{
    static double x[SCENES][SAMPLES], error[SCENES];
    static ss_scene s[SCENES];
    uint64_t seed = 20050127;
    (void)state;
    for (size_t i = 0; i < SCENES; i++) {
        s[i] = random_scene(&seed);
        oracle_smooth(&s[i], SAMPLES, x[i]);
    }
    for (int k = 3; k <= 14; k++) {
        double tol = pow(10, -k);
        for (size_t i = 0; i < SCENES; i++)
            error[i] = error_of(&s[i], tol, x[i]) / tol;
        qsort(error, SCENES, sizeof *error, ascending);
        double half = error[SCENES / 2], most = error[SCENES * 9 / 10], all = error[SCENES - 1];
        print_message("%g: half within %.2g tol, 9 of 10 within %.2g, all within %.2g\n", tol, half, most,
                      all);
        assert_true(half <= 1 && most <= 14 && all <= 50);
    }
}

/* At a low rate a step holds one sample or none, at a high one some hundred of them. */
static void
samples_are_the_same_at_every_rate(void **state)
{
    enum { FACTOR = 5000, SPARSE = 400 };
    static const char *const name[] = { "state-variable", "compliant-light" };
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        ss_scene s = read_shipped_named(name[i]);
        s.settle = 0;
        s.duration = 2;
        s.rate = SPARSE / s.duration;
        run sparse = run_with(&s, "taylor", 1e-12, 0);
        s.rate *= FACTOR;
        run dense = run_with(&s, "taylor", 1e-12, 0);
        for (size_t k = 0; k < SPARSE; k++) {
            const ss_sample *a = &sparse.sample[k], *b = &dense.sample[k * FACTOR];
            assert_true(fabs(a->x - b->x) <= 1e-15 * scale_of(&s));
            assert_true(fabs(a->v - b->v) <= 1e-13 * scale_of(&s));
            assert_true(fabs(a->f - b->f) <= 1e-13 * s.friction);
        }
        run_free(&sparse);
        run_free(&dense);
    }
}

/* The front of tanh is passed in 1e-3 to 1e-7 of the speed of the base, so that its series shows
 * nothing of the front a step before.  A step that passes over it is wrong by a part of the motion. */
static void
no_step_passes_over_the_front(void **state)
{
    static const double alpha[] = { 1e4, 1e5, 1e6, 1e7 }, friction[] = { 0.2, 1.28, 2.5 };
    double x[SAMPLES];
    (void)state;
    for (size_t i = 0; i < 4; i++)
        for (size_t j = 0; j < 3; j++) {
            ss_scene s = read_shipped_named("state-variable");
            s.settle = 0;
            s.duration = 1;
            s.rate = SAMPLES;
            ss_scene_set(&s, "alpha", alpha[i], NULL);
            s.friction = friction[j];
            s.v0 = 0.01;
            oracle_smooth(&s, SAMPLES, x);
            for (int k = 3; k <= 12; k += 3) {
                double tol = pow(10, -k), error = error_of(&s, tol, x);
                if (!(error <= 20 * tol))
                    fail_msg("alpha %g, f_k %g: %.2g at %g", ss_scene_get(&s, "alpha"), s.friction, error, tol);
            }
        }
}

/* Kinds and order are those of the closed form, times are off by what the tolerance moves the mass. */
static void
events_are_those_of_the_closed_form(void **state)
{
    (void)state;
    for (size_t i = 0; ss_shipped_scenes[i].name != NULL; i++)
        for (int total = 0; total < 2; total++) {
            ss_scene s = read_shipped(&ss_shipped_scenes[i]);
            if (!ss_model_is_linear(s.model))
                continue;
            ss_scene_set_text(&s, "release", total ? "total" : "spring", NULL);
            s.settle = 0;
            s.duration = 10;
            run exact = run_with(&s, "exact", 1e-14, 0);
            for (int k = 4; k <= 14; k++) {
                double tol = pow(10, -k), worst = 0;
                run r = run_with(&s, "taylor", tol, 0);
                assert_int_equal(r.status, SS_OK);
                assert_int_equal(r.n_events, exact.n_events);
                for (size_t e = 0; e < r.n_events; e++) {
                    assert_int_equal(r.event[e].kind, exact.event[e].kind);
                    assert_int_equal(r.event[e].direction, exact.event[e].direction);
                    worst = fmax(worst, fabs(r.event[e].t - exact.event[e].t));
                }
                double error = difference(&r, &exact, 1) / scale_of(&s);
                assert_true(worst <= 2 * tol + 1e-13 && error <= 20 * tol + 1e-13);
                run_free(&r);
            }
            run_free(&exact);
        }
}

/* The falling law has no closed form: rk8pd is a method of another kind.  Its front is from a
 * thousandth of the speed of the base to beyond it. */
static void
events_of_a_falling_friction_are_those_of_rk8pd(void **state)
{
    static const double front[] = { 1e-5, 1e-4, 1e-3, 0.01, 0.1 };
    (void)state;
    for (size_t i = 0; i < sizeof front / sizeof *front; i++) {
        ss_scene s = read_shipped_named("coulomb");
        ss_scene_set_text(&s, "model", "stribeck", NULL);
        s.friction = 0.9;
        s.static_friction = 1.28;
        ss_scene_set(&s, "stribeck_velocity", front[i], NULL);
        s.settle = 0;
        s.duration = 5;
        run other = run_with(&s, "rk8pd", 1e-14, 0);
        assert_true(other.n_events > 20);
        for (int k = 4; k <= 14; k += 2) {
            double tol = pow(10, -k);
            run r = run_with(&s, "taylor", tol, 0);
            assert_int_equal(r.n_events, other.n_events);
            for (size_t e = 0; e < r.n_events; e++)
                assert_int_equal(r.event[e].kind, other.event[e].kind);
            double error = difference(&r, &other, 1) / scale_of(&s);
            if (!(error <= 20 * tol + 1e-12))
                fail_msg("v_s %g: %.2g at %g", front[i], error, tol);
            run_free(&r);
        }
        run_free(&other);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_about_the_tolerance),
        cmocka_unit_test(samples_are_the_same_at_every_rate),
        cmocka_unit_test(no_step_passes_over_the_front),
        cmocka_unit_test(events_are_those_of_the_closed_form),
        cmocka_unit_test(events_of_a_falling_friction_are_those_of_rk8pd),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
