/* test_rate_and_state.c -- rate-and-state friction as a scene: limit cycles and stability against digits on which
 * two independent methods agree, and motions against the slider of the inversion and against each other. */
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>

#include "extremes/runs.h"
#include "fit/slider.h"
#include "near.h"
#include "scene/model.h"
#include "shipped.h"

#define BIT(m) (1u << (m))

static ss_scene
scene_of(int is_lab, int is_slip)
{
    ss_scene s = read_shipped_named(is_lab ? "rate-and-state-lab" : "rate-and-state-mild");
    ss_scene_set_text(&s, "law", is_slip ? "slip" : "aging", NULL);
    return s;
}

static ss_steady
steady_of(const ss_scene *scene, unsigned measures, const char *method)
{
    ss_steady_opts opts;
    ss_steady out;
    ss_error err = { 0 };
    ss_steady_opts_init(&opts, sizeof opts);
    opts.measures = measures;
    opts.method = method;
    if (ss_steady_find(&out, scene, &opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return out;
}

/* --- limit cycles and stability ------------------------------------------------------------------ */

/* Each digit is shown by two methods; 1e-8 is asked for, and the digits end at 3e-11 to 7e-10 of the numbers. */
static void
cycles_have_the_known_digits(void **unused)
{
    static const double truth[2][2][4] = {
        { { .2274109419237, .02277703794843, .0833701529378, .006273909372853 },
          { .218276236022, .02034409128259, .0674333444419, .006196666105741 } },
        { { 15.22062821, .07161155591, .149026635, .00622700604675 },
          { 10.09465167059, .0464031064637, .096120901988, .005969775974669 } } };
    static const char *const method[] = { NULL, "bsimp", "radau" };
    const unsigned all = BIT(SS_CYCLE_TIME) | BIT(SS_PEAK_VELOCITY) | BIT(SS_FORCE_DROP) | BIT(SS_X_MAX)
        | BIT(SS_PERIOD);
    (void)unused;
    for (int i = 0; i < 12; i++) {
        int lab = i & 1, slip = i >> 1 & 1;
        const double *is = truth[lab][slip];
        ss_scene s = scene_of(lab, slip);
        ss_steady at = steady_of(&s, all, method[i >> 2]);
        near("period", at.value[SS_CYCLE_TIME] / is[0], 1, 1e-9);
        near("peak V", at.value[SS_PEAK_VELOCITY] / is[1], 1, 1e-9);
        near("drop", at.value[SS_FORCE_DROP] / ss_scene_get(&s, "normal_force") / is[2], 1, 3.4e-9);
        near("largest d", at.value[SS_X_MAX] / is[3], 1, 1e-9);
        assert_true(at.value[SS_PERIOD] == 1);
    }
}

static double
growth_at(ss_scene s, double stiffness)
{
    s.stiffness = stiffness;
    return steady_of(&s, BIT(SS_GROWTH), NULL).value[SS_GROWTH];
}

/* By the eigenvalues of an independent program; the last digit is its eighth.  Both laws are alike. */
static void
a_steady_slide_grows_unstable_as_known(void **unused)
{
    static const double by[] = { .98, .99, 1.01, 1.02 }, k_c[] = { 5500, 50050 };
    static const double truth[2][4] = { { .032344882, .016127049, -.016036907, -.031984311 },
                                        { .049949527, .024974888, -.024975137, -.049950523 } };
    (void)unused;
    for (int i = 0; i < 16; i++) {
        int lab = i / 8, k = i % 4;
        near("growth", growth_at(scene_of(lab, i / 4 % 2), by[k] * k_c[lab]), truth[lab][k], 2e-9);
    }
    for (int lab = 0; lab < 2; lab++) {         /* k_c = (b - a) N/Dc (1 + m U^2/(a N Dc)) */
        ss_scene s = scene_of(lab, 0);
        double lo = .9 * k_c[lab], hi = 1.1 * k_c[lab];
        for (int i = 0; i < 40; i++)
            *(growth_at(s, (lo + hi) / 2) > 0 ? &lo : &hi) = (lo + hi) / 2;
        near("k_c", lo / k_c[lab], 1, 1e-10);
    }
}

/* With the pull's speed it slides on as it is; without a cycle, ss-sweep says so and knows the growth alone. */
static void
a_stable_slide_stays(void **unused)
{
    ss_scene s = scene_of(1, 0);
    ss_steady_opts opts;
    ss_steady at;
    ss_error err = { 0 };
    (void)unused;
    s.stiffness = 60000;
    s.v0 = 0;
    run r = run_with(&s, NULL, 1e-12, 0);
    assert_int_equal(r.status, SS_OK);
    for (size_t i = 0; i < r.n; i++)            /* w = f/(N a) = 60 is rounded to 1e-14 */
        if (!(fabs(r.sample[i].v / s.base_velocity - 1) < 1e-12))
            fail_msg("V = %.15g at %g s", r.sample[i].v, r.sample[i].t);
    run_free(&r);
    ss_steady_opts_init(&opts, sizeof opts);
    opts.measures = BIT(SS_CYCLE_TIME) | BIT(SS_GROWTH);
    opts.max_cycles = 10;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EDATA);
    assert_non_null(strstr(err.text, "slides on"));
    assert_true(isnan(at.value[SS_CYCLE_TIME]) && at.value[SS_GROWTH] < 0);
}

/* --- motions ------------------------------------------------------------------------------------- */

/* Beside an unstable slide a distance grows as exp(growth t), however small it is: one that is 2^-8 of another
 * takes 8 ln 2/growth longer.  With k of k_c/20 the rate is real, and the next one soon falls behind.  The law is
 * linear to 1e-6, the larger distance; inertia leaves 1e-4 of both, of the smaller one 4e-13 of an e-fold, and a
 * step takes 1e-15 at most. */
static void
leaves_an_unstable_slide_when_it_must(void **unused)
{
    (void)unused;
    for (int law = 0; law < 2; law++) {
        ss_scene s = scene_of(1, law);
        double at[2] = { NAN, NAN }, growth = NAN;
        s.stiffness = 50050 / 20.;
        s.duration = 16;
        s.base_velocity = ldexp(1, -13);
        for (int k = 0; k < 2; k++) {
            s.v0 = s.base_velocity * (1 + ldexp(1, -20 - 8 * k));
            run r = run_with(&s, "radau", 1e-12, 0);
            growth = growth_at(s, s.stiffness);
            assert_int_equal(r.status, SS_OK);
            for (size_t i = 1; i < r.n && isnan(at[k]); i++) {
                double U = s.base_velocity, before = log(r.sample[i - 1].v / U), now = log(r.sample[i].v / U);
                if (now > 1)
                    at[k] = r.sample[i].t - (now - 1) / (now - before) / s.rate;
            }
            run_free(&r);
        }
        near("longer by", at[1] - at[0], 8 * log(2) / growth, 1e-5);
    }
}

/* It begins beside an unstable slide; numbers that are not counted from this slide keep 2e-7. */
static void
keeps_an_accuracy_of_1e_8(void **unused)
{
    (void)unused;
    ss_scene s = scene_of(1, 0);
    ss_sim_opts opts;
    ss_error err = { 0 };
    s.duration = 15;
    s.rate = 50;
    ss_sim_opts_init(&opts, sizeof opts);
    if (ss_trade_choose(&opts, &s, 1e-8, &err) != SS_OK)
        fail_msg("%s", err.text);
    assert_string_equal(opts.method, "radau");
}

/* Without mass the slider of the inversion is the same law by another program, in ln V and ln theta.  Its load
 * point leaps within 1e-10 s, the scene begins behind this leap.  Inertia changes mu by m V'/N, of which
 * V' < V^2/Dc, 1e-13 in all. */
static void
slides_without_inertia_as_the_inversion_does(void **unused)
{
    enum { N = 400 };
    const double U = 1e-6, leap = 1e-10;
    (void)unused;
    for (int law = 0; law < 2; law++) {
        double t[N + 2] = { 0, leap }, load[N + 2] = { 0 }, g[N + 2];
        ss_scene s = scene_of(1, law);
        s.mass = 1e-8;
        s.stiffness = 1000;
        s.base_velocity = U;
        s.v0 = 10 * U;
        s.rate = N / 40.;
        s.duration = 40;
        ss_scene_set(&s, "normal_force", 1, NULL);
        ss_scene_set(&s, "evolution_effect", .007, NULL);
        ss_scene_set(&s, "reference_velocity", U, NULL);
        s.x0 = -(.6 + .01 * log(10)) / s.stiffness;
        run r = run_with(&s, "radau", 1e-12, 0);
        assert_int_equal(r.status, SS_OK);
        load[1] = .01 * log(10) / s.stiffness;
        for (int i = 1; i < N; i++) {
            t[i + 1] = r.sample[i].t;
            load[i + 1] = load[1] + U * t[i + 1];
        }
        const slider quiet = { law, .7, 1e-5, 1000 / .01, U };
        assert_int_equal(ss_slider_run(g, &quiet, t, load, N + 1, 1e-13), SS_OK);
        double worst = 0;
        for (int i = 1; i < N; i++)
            worst = fmax(worst, fabs(r.sample[i].f - (.6 + .01 * g[i + 1])));
        near(law ? "slip" : "aging", worst, 0, 2e-12);      /* the leap lasts 1e-10 V/Dc of an age */
        run_free(&r);
    }
}

/* The inside of a long step of radau against Taylor's, which is the same series as its step.  At 1e-12 a step may
 * leave 1e-12 of a N/k and of w, which is ln V; a second has a hundred steps. */
static void
the_inside_of_steps_agrees_with_taylor(void **unused)
{
    (void)unused;
    for (int law = 0; law < 2; law++) {
        ss_scene s = scene_of(0, law);
        s.settle = 0;
        run a = run_with(&s, "taylor", 1e-13, 0), b = run_with(&s, "radau", 1e-12, 0);
        assert_true(a.status == SS_OK && b.status == SS_OK && a.n == b.n && a.n == 2000);
        double x = 0, V = 0, f = 0;
        for (size_t i = 0; i < a.n; i++) {
            x = fmax(x, fabs(a.sample[i].x - b.sample[i].x));
            V = fmax(V, fabs(b.sample[i].v / a.sample[i].v - 1));
            f = fmax(f, fabs(a.sample[i].f - b.sample[i].f));
        }
        near("x", x, 0, 1e-15);
        near("V", V, 0, 1e-12);
        near("f", f, 0, 1e-13);
        run_free(&a);
        run_free(&b);
    }
}

/* Steps do not depend on samples, and a sample not on the others; times are rounded to 4e-15 s, V is at most
 * .07 m/s. */
static void
samples_do_not_depend_on_the_rate(void **unused)
{
    ss_scene s = scene_of(1, 0);
    (void)unused;
    s.duration = 20;
    run fine = run_with(&s, NULL, 1e-8, 0);
    s.rate = 10;
    run coarse = run_with(&s, NULL, 1e-8, 0);
    assert_true(fine.status == SS_OK && coarse.status == SS_OK && fine.stats.steps == coarse.stats.steps);
    for (size_t i = 0; i < coarse.n; i++)
        assert_true(fabs(coarse.sample[i].x - fine.sample[100 * i].x) < 1e-15);
    run_free(&fine);
    run_free(&coarse);
}

/* 53 s take 7 ms in 9,200 right-hand sides (slip 11,000); that of a sample costs a few products.  A loose
 * tolerance needs more tries of Newton's method, but no more steps. */
static void
a_laboratory_minute_costs_little(void **unused)
{
    (void)unused;
    for (int i = 0; i < 8; i++) {
        const double tol = i < 2 ? 1e-8 : i < 4 ? 1e-6 : i < 6 ? 1e-4 : 1e-2;
        ss_scene s = scene_of(1, i & 1);
        s.rate = 1 / s.duration;
        run r = run_with(&s, NULL, tol, 0);
        print_message("%lu steps, %lu right-hand sides\n", r.stats.steps, r.stats.rhs);
        assert_true(r.status == SS_OK && r.stats.steps < 400 && r.stats.rhs < (i < 2 ? 12000 : 25000));
        run_free(&r);
    }
}

/* The Stribeck law in its place drops as far, about, by 2 (f_s - f_k), since inertia carries the slip through; and
 * Coulomb friction with the same f_s and f_k follows.  Its drop is that of the law of aging within 2 %, and so is
 * the time in which the pull makes up for it; the slip lasts .03 s, and the nucleation, which it lacks, about .3 s. */
static void
a_falling_law_drops_as_far(void **unused)
{
    ss_scene lab = scene_of(1, 0), falling, coulomb;
    (void)unused;
    assert_string_equal(ss_scene_simpler(&falling, &lab, 0), "stribeck");
    assert_string_equal(ss_scene_simpler(&coulomb, &lab, 1), "coulomb");
    near("drop", 2 * (falling.static_friction - falling.friction) / 100 / .149026635, 1, .02);
    assert_true(coulomb.friction == falling.friction && coulomb.static_friction == falling.static_friction);
    ss_steady at = steady_of(&coulomb, BIT(SS_CYCLE_TIME) | BIT(SS_STICK_FRACTION), NULL);
    near("period", at.value[SS_CYCLE_TIME], 15.22062821, .02 * 15.22 + .33);
}

/* --- what it refuses ------------------------------------------------------------------------------- */

static void
ends_where_the_spring_goes_slack(void **unused)
{
    ss_scene s = scene_of(0, 0);
    (void)unused;
    s.settle = 0;
    s.v0 = 1;                                   /* it would go v0/omega_n, five times d */
    run r = run_with(&s, NULL, 1e-10, 0);
    assert_int_equal(r.status, SS_EDATA);
    assert_non_null(strstr(r.err.text, "the spring is slack"));
    for (size_t i = 0; i < r.n; i++)
        assert_true(r.sample[i].s > 0);
    run_free(&r);
    s.x0 = 1e-9;
    r = run_with(&s, NULL, 1e-10, 0);
    assert_true(r.status == SS_EDATA && r.n == 0);
    run_free(&r);
}

static void
explicit_methods_refuse_millions_of_steps(void **unused)
{
    static const char *const method[] = { "rk8pd", "taylor", "rkck" };
    (void)unused;
    for (int i = 0; i < 3; i++) {
        ss_scene lab = scene_of(1, 0), mild = scene_of(0, 0);
        run a = run_with(&lab, method[i], 1e-8, 0), b = run_with(&mild, method[i], 1e-8, 0);
        assert_true(a.status == SS_EINVAL && b.status == SS_OK);
        assert_non_null(strstr(a.err.text, "steps would be millions"));
        run_free(&a);
        run_free(&b);
    }
}

/* Fields that only other models have must be 0. */
static void
has_no_belt_and_no_moving_base(void **unused)
{
    ss_scene s = scene_of(0, 0);
    ss_error err = { 0 };
    (void)unused;
    s.surface_velocity = 1;
    assert_int_equal(ss_scene_check(&s, &err), SS_EINVAL);
    assert_string_equal(err.text, "model rate-and-state has no key 'surface_velocity'");
    s = scene_of(0, 0);
    s.base_frequency = 1;
    assert_int_equal(ss_scene_check(&s, &err), SS_EINVAL);
    s = scene_of(0, 0);
    s.base_velocity = 0;
    assert_int_equal(ss_scene_check(&s, &err), SS_EINVAL);
}

/* Of every law: the derivatives of the rates by state and time, which implicit methods use, against their
 * differences. */
static void
the_jacobian_is_that_of_the_rates(void **unused)
{
    static const struct {
        const char *scene, *settings[4][2];
        double q[MAX_DIM];
        int side;
    } rows[] = {
        { "coulomb", { { "damping", "3" }, { "base_velocity", "1e-3" } }, { 1e-4, .01 }, 0 },
        { "compliant-heavy", { { "damping", "3" } }, { 1e-6, .01 }, 0 },
        { "state-variable", { { "damping", "3" } }, { 1e-4, 1e-4, .5 }, 0 },
        { "leine", { { "damping", ".1" }, { "stribeck_exponent", "1.4" } }, { .1, .15 }, 0 },
        { "lugre", { { "damping", ".1" } }, { .1, 1e-3, 1e-5 }, 0 },
        { "dahl", { { "exponent", "1.6" }, { "beta_fraction", ".7" } }, { 1e-4, .01, 2e-6 }, 1 },
        { "dahl", { { "exponent", "1.6" }, { "damping", "3" }, { "gap", "1e-5" } }, { 1e-4, .01, -1.2e-5 }, -1 },
        { "rate-and-state-mild", { { "damping", "3" } }, { .001, -5, -.7 }, 0 },
    };
    (void)unused;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        ss_scene s = read_shipped_named(rows[k].scene);
        for (size_t i = 0; rows[k].settings[i][0] != NULL; i++)
            assert_int_equal(ss_scene_set_text(&s, rows[k].settings[i][0], rows[k].settings[i][1], NULL), SS_OK);
        state m = ss_state_of(&s, 1e-12);
        const size_t n = m.model->dim;
        if (m.model->equilibrium != NULL)
            m.model->equilibrium(&m);
        else
            m.model->start(&m);
        m.side = rows[k].side;
        m.mode = sign(rows[k].q[1]);
        double d[MAX_DIM * MAX_DIM], by_time[MAX_DIM], rate[2][MAX_DIM];
        m.model->jacobian(&m, .1, rows[k].q, d, by_time);
        for (size_t j = 0; j <= n; j++) {
            const double h = 1e-5 * (j < n ? fabs(rows[k].q[j]) : .1);
            for (int way = 0; way < 2; way++) {
                double q[MAX_DIM], by = way == 0 ? -h : h;
                memcpy(q, rows[k].q, sizeof q);
                if (j < n)
                    q[j] += by;
                m.model->rates(&m, base_force(&m, j < n ? .1 : .1 + by), q, rate[way]);
            }
            for (size_t i = 0; i < n; i++) {
                const double differs = (rate[1][i] - rate[0][i]) / (2 * h);
                const double size = fabs(rate[0][i]) + fabs(rate[1][i]);
                near(rows[k].scene, j < n ? d[n * i + j] : by_time[i], differs,
                     1e-8 * fabs(differs) + 1e-14 * size / h);
            }
        }
    }
}

/* V = 2 V0 exp(-(mu0 + b s)/a) sinh(f/(N a)), the regularised law solved for V, where both parts of sinh count. */
static void
the_speed_is_that_of_the_law(void **unused)
{
    (void)unused;
    ss_scene s = scene_of(0, 0);
    ss_scene_set(&s, "reference_friction", .02, NULL);
    const double a = ss_scene_get(&s, "direct_effect"), b = ss_scene_get(&s, "evolution_effect");
    const double V0 = ss_scene_get(&s, "reference_velocity"), U = s.base_velocity;
    state m = ss_state_of(&s, 1e-12);
    m.model->equilibrium(&m);
    for (int i = 0; i < 9; i++) {
        m.q[1] = i / 3 - 1;
        m.q[2] = (i % 3 - 1) / 2.;
        double w = m.f0 / (ss_scene_get(&s, "normal_force") * a) + m.q[1], theta = log(V0 / U) + m.q[2];
        double V = 2 * V0 * exp(-(.02 + b * theta) / a) * sinh(w), dqdt[3];
        near("V", m.model->speed(&m) / V, 1, 1e-13);
        m.model->rates(&m, 0, m.q, dqdt);
        near("V - U", dqdt[0] / U, V / U - 1, 1e-13 * (V / U + 1));
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cycles_have_the_known_digits),
        cmocka_unit_test(a_steady_slide_grows_unstable_as_known),
        cmocka_unit_test(a_stable_slide_stays),
        cmocka_unit_test(leaves_an_unstable_slide_when_it_must),
        cmocka_unit_test(keeps_an_accuracy_of_1e_8),
        cmocka_unit_test(slides_without_inertia_as_the_inversion_does),
        cmocka_unit_test(the_inside_of_steps_agrees_with_taylor),
        cmocka_unit_test(samples_do_not_depend_on_the_rate),
        cmocka_unit_test(a_laboratory_minute_costs_little),
        cmocka_unit_test(a_falling_law_drops_as_far),
        cmocka_unit_test(ends_where_the_spring_goes_slack),
        cmocka_unit_test(explicit_methods_refuse_millions_of_steps),
        cmocka_unit_test(has_no_belt_and_no_moving_base),
        cmocka_unit_test(the_jacobian_is_that_of_the_rates),
        cmocka_unit_test(the_speed_is_that_of_the_law),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
