/* test_sim_truth.c -- simulation against closed forms, by tests/oracle.c in long double, and against
 * published physics: Den Hartog (1931), symmetries, the linear oscillator. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "oracle.h"
#include "sim_runs.h"
#include "unit.h"

/* --- against the closed form --------------------------------------------------------------- */

static void
compare_with_closed_form(const char *method, double allow_t, double allow_x, double allow_a)
{
    for (int i = 0; i < 6; i++) {
        ss_scene s = scene_named(with_events[i % 3], 10, 2000);
        ss_scene_set_text(&s, "release", i < 3 ? "spring" : "total", NULL);
        oracle *o = oracle_new(&s, 10);
        run r = run_by(&s, method, 1e-12);
        size_t first = o->starts_with_event ? 0 : 1, piece = 0;
        double worst_t = 0, worst_x = 0, worst_a = 0, max_x = 0, max_a = 0;

        assert_int_equal(r.n_events, o->n - first);
        for (size_t k = 0; k < r.n_events; k++) {
            const oracle_piece *p = &o->piece[k + first];
            worst_t = fmax(worst_t, fabs(r.event[k].t - (double)p->t0));
            assert_int_equal(r.event[k].kind, p->kind);
            assert_int_equal(r.event[k].direction, p->direction);
        }
        assert_int_equal(r.n, 20000);
        for (size_t k = 0; k < r.n; k++) {
            long double truth[3], t = (long double)k / 2000;
            while (piece + 1 < o->n && o->piece[piece + 1].t0 <= t)
                piece++;
            oracle_at(o, piece, t, truth);
            worst_x = fmax(worst_x, fabs(r.sample[k].x - (double)truth[0]));
            max_x = fmax(max_x, fabs(r.sample[k].x));
            max_a = fmax(max_a, fabs(r.sample[k].a));
            int near = t - o->piece[piece].t0 < 1e-10L
                || (piece + 1 < o->n && o->piece[piece + 1].t0 - t < 1e-10L);
            if (!near) {
                worst_a = fmax(worst_a, fabs(r.sample[k].a - (double)truth[2]));
                assert_int_equal(r.sample[k].mode, o->piece[piece].mode);
            }
        }
        print_message("%s: %s, release %s: events within %.1e s, x %.1e, a %.1e of their maxima\n",
                      method, with_events[i % 3], i < 3 ? "spring" : "total", worst_t,
                      worst_x / max_x, worst_a / max_a);
        /* and, where long double has no more digits than double, what the oracle itself rounds */
        double oracle_error = 2000 * (double)LDBL_EPSILON;
        assert_true(worst_t <= allow_t + oracle_error);
        assert_true(worst_x <= (allow_x + oracle_error) * max_x);
        assert_true(worst_a <= (allow_a + 60 * oracle_error) * max_a);
        run_free(&r);
        oracle_free(o);
    }
}

static void
equals_the_closed_form_at_the_default_tolerance(void **state)
{
    (void)state;
    compare_with_closed_form("rk8pd", 1e-10, 1e-10, 1e-8);
}

static void
exact_equals_the_closed_form_to_rounding(void **state)
{
    /* a few hundred roundings of 1.1e-16 in a row; in a those of x come times K_y/m over max|a|,
     * 60 times */
    (void)state;
    compare_with_closed_form("exact", 1e-13, 1e-13, 6e-12);
}

/* Scenes on which a closed form divides by next to nothing, unless it is written with care. */
static const struct hard { const char *what, *set[6]; } hard[] = {
    { "resonance of the slip", { "base_frequency=4.917219285893747", "base_amplitude=6e-4" } },
    { "next to resonance", { "base_frequency=4.9172193", "x0=1e-3" } },
    { "a tenth off resonance", { "base_frequency=4.67", "x0=1e-3" } },
    { "resonance of the contact", { "base_frequency=47.1302", "contact_damping=0.1",
                                    "base_amplitude=6e-4" } },
    { "base at rest", { "base_frequency=0", "x0=3e-3", "v0=0.2" } },
    { "slow base", { "base_frequency=1e-3", "x0=3e-3", "v0=-0.2" } },
    { "fast base", { "base_frequency=900", "base_amplitude=0.1" } },
    { "critical damping", { "contact_damping=1433.2390065445513", "x0=1e-3" } },
    { "hardly over critical", { "contact_damping=1433.2391", "x0=1e-3" } },
    { "100 x critical", { "contact_damping=143324", "x0=1e-3" } },
    { "soft contact", { "contact_stiffness=1", "contact_damping=0.1" } },
    { "stiff contact", { "contact_stiffness=1e8", "contact_damping=500" } },
    { "soft spring", { "stiffness=1e-3", "base_amplitude=2000", "x0=0", "v0=0.3" } },
    { "no friction", { "friction=0", "contact_damping=0" } },
    { "a phase", { "phase=2", "x0=-1e-4" } },
};

static void
exact_and_integrated_agree_where_formulas_are_singular(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof hard / sizeof *hard; i++) {
        ss_scene s;
        ss_error err = { 0 };
        size_t n = 0;
        const char *set[8] = { "settle=0", "duration=3" };
        while (n < 6 && hard[i].set[n] != NULL)
            n++;
        memcpy(set + 2, hard[i].set, n * sizeof *set);
        if (ss_scene_read(&s, NULL, "compliant-light", set, n + 2, &err) != SS_OK)
            fail_msg("%s: %s", hard[i].what, err.text);
        run a = run_by(&s, "exact", 1e-12), b = run_by(&s, "rk8pd", 1e-12);
        if (a.n_events != b.n_events)
            fail_msg("%s: %zu events and %zu", hard[i].what, a.n_events, b.n_events);
        double worst = 0, max = max_of(&b, 0, b.n);
        for (size_t k = 0; k < a.n; k++)
            worst = fmax(worst, fabs(a.sample[k].x - b.sample[k].x));
        /* rk8pd at its default: 1e-12 of the absolute scale a step, over some thousand steps */
        if (!(worst <= 1e-9 * max))
            fail_msg("%s: x differs by %.2g of %.2g", hard[i].what, worst, max);
        run_free(&a);
        run_free(&b);
    }
}

static void
stays_put_while_it_sticks(void **state)
{
    ss_scene s = scene_named("coulomb", 10, 2000);
    size_t stuck = 0;
    (void)state;
    s.settle = 20;
    run r = run_of(&s);
    for (size_t i = 0; i < r.n; i++) {
        const ss_sample *p = &r.sample[i];
        if (p->mode != 0)
            continue;
        stuck++;
        assert_true(p->v == 0 && p->a == 0);
        assert_true(fabs(p->f) <= s.friction * (1 + 4 * DBL_EPSILON));
        if (i > 0 && r.sample[i - 1].mode == 0)
            assert_true(p->x == r.sample[i - 1].x);
    }
    assert_in_range(stuck, 7628 - 50, 7628 + 50);   /* 76.277 ms of each of 50 half-cycles */
    run_free(&r);
}

static void
samples_fall_on_n_over_rate(void **state)
{
    ss_scene s = scene_named("compliant-light", 1.0004, 1024.5);
    (void)state;
    s.settle = 0.1;
    run r = run_of(&s);
    assert_int_equal(r.n, 1025);            /* round(1.0004 x 1024.5 = 1024.9) */
    for (size_t i = 0; i < r.n; i++)
        assert_true(r.sample[i].t == (double)i / 1024.5);
    run_free(&r);
}

static void
settling_is_the_same_motion_earlier(void **state)
{
    ss_scene whole = scene_named("compliant-light", 3, 2000), late = whole;
    (void)state;
    late.settle = 2;
    late.duration = 1;
    run a = run_of(&whole), b = run_of(&late);
    for (size_t i = 0; i < b.n; i++) {
        const ss_sample *p = &a.sample[i + 4000], *q = &b.sample[i];
        /* 4000/2000 + i/2000 is exact, so both read the same steps at the same times */
        assert_true(p->x == q->x && p->v == q->v && p->a == q->a && p->mode == q->mode);
    }
    run_free(&a);
    run_free(&b);
}

/* A sample belongs to the side after an event; one exactly at it is an event's own. */
static void
a_sample_at_an_event_is_after_it(void **state)
{
    ss_scene s = scene_named("coulomb", 1, 2000);
    (void)state;
    run r = run_of(&s);
    assert_true(r.event[0].t == 0 && r.event[0].kind == SS_SLIP && r.event[0].direction == 1);
    assert_true(r.sample[0].t == 0 && r.sample[0].mode == 1);
    for (size_t i = 0, k = 0; i < r.n; i++) {
        while (k + 1 < r.n_events && r.event[k + 1].t <= r.sample[i].t)
            k++;
        assert_int_equal(r.sample[i].mode, r.event[k].kind == SS_STICK ? 0 : r.event[k].direction);
    }
    run_free(&r);
}

/* --- physics from elsewhere ---------------------------------------------------------------- */

static void
gives_den_hartogs_amplitudes(void **state)
{
    /* Den Hartog (1931): X / Z_e at r = Omega / omega_n, beta = f_k / (k Z_e) */
    static const double row[][3] = { { 1.25, 0.5, 1.282557 }, { 0.8, 0.5, 2.332235 },
                                     { 2, 0.3, 0.297676 } };
    (void)state;
    for (int i = 0; i < 3; i++) {
        ss_scene s = unit_oscillator(row[i][1], 1, row[i][0]);
        s.settle = 2000;
        s.duration = 20;
        s.rate = 1;
        run r = run_of(&s);
        assert_true(r.n_events >= 4);
        for (size_t k = 0; k < r.n_events; k++) {
            assert_int_equal(r.event[k].kind, SS_REVERSE);
            if (!(fabs(fabs(r.event[k].x) - row[i][2]) <= 1e-5 * row[i][2]))
                fail_msg("r = %g: amplitude %.9g, not %.9g", row[i][0], r.event[k].x, row[i][2]);
        }
        run_free(&r);
    }
}

static void
stops_where_den_hartog_says(void **state)
{
    /* the largest beta without stops, for each r */
    static const double row[][2] = { { .3, .086407 }, { .4, .143890 }, { .6, .531513 },
        { .8, .817406 }, { 1.1, .746772 }, { 1.25, .698821 }, { 1.5, .646579 }, { 2, .596285 } };
    (void)state;
    for (int i = 0; i < 8; i++)
        for (int above = 0; above <= 1; above++) {
            /* one unit of the fifth digit to either side, and half of the last digit given */
            double beta = row[i][1] + (above ? 1 : -1) * (1e-5 * row[i][1] + 5e-7);
            ss_scene s = unit_oscillator(beta, 1, row[i][0]);
            size_t stops = 0;
            s.settle = 20000;
            s.duration = 4 * 2 * M_PI / row[i][0];
            s.rate = 1;
            run r = run_by(&s, "exact", 1e-12);
            for (size_t k = 0; k < r.n_events; k++)
                stops += r.event[k].kind == SS_STICK;
            if ((stops > 0) != above)
                fail_msg("r = %g, beta = %.8g: %zu stops", row[i][0], beta, stops);
            run_free(&r);
        }
}

static void
loses_four_f_over_k_a_cycle(void **state)
{
    /* free decay from x0 = 1: extrema 1, -(1 - 2d), 1 - 4d, ... with d = f_k / k; then it sticks */
    ss_scene s = unit_oscillator(0.03, 0, 0);
    (void)state;
    s.x0 = 1;
    s.duration = 100;
    s.rate = 10;
    run r = run_of(&s);
    assert_int_equal(r.n_events, 18);       /* slip, 16 reversals, stick where |x| <= 0.03 */
    for (size_t k = 1; k < r.n_events; k++) {
        double x = (k % 2 ? -1 : 1) * (1 - 0.06 * (double)k);
        assert_true(fabs(r.event[k].t - M_PI * (double)k) < 1e-11 * (double)k);
        assert_true(fabs(r.event[k].x - x) < 1e-11);
        assert_int_equal(r.event[k].kind, k < 17 ? SS_REVERSE : SS_STICK);
    }
    assert_true(r.sample[r.n - 1].v == 0 && r.sample[r.n - 1].x == r.event[17].x);
    run_free(&r);
}

static void
touching_the_limit_is_no_release(void **state)
{
    /* no base, no damping: after the last slip the contact comes back to its limit exactly, each of
     * 47.13 periods a second, for ever; releases there would be rounding.  In truth: slip, stick, slip,
     * stick; and at most 472 touches, which are counted where rounding makes them pass the limit. */
    static const struct { const char *method; double tol; } how[] = {
        { "exact", 1e-12 }, { "taylor", 1e-12 }, { "taylor", 1e-8 }, { "rk8pd", 1e-12 },
        { "rk8pd", 1e-7 }, { "rkf45", 1e-12 },
        { "rkf45", 1e-8 }, { "rk4", 1e-10 }, { "bsimp", 1e-10 }, { "radau", 1e-10 },
        { "msbdf", 1e-9 } };
    static const ss_event_kind kind[] = { SS_SLIP, SS_STICK, SS_SLIP, SS_STICK };
    ss_scene s = scene_named("compliant-light", 10, 20);
    (void)state;
    s.base_amplitude = 0;
    ss_scene_set(&s, "contact_damping", 0, NULL);
    s.x0 = 0.002;
    for (int release = 0; release < 2; release++)
        for (size_t i = 0; i < sizeof how / sizeof *how; i++) {
            ss_scene_set_text(&s, "release", release == 0 ? "spring" : "total", NULL);
            run r = run_by(&s, how[i].method, how[i].tol);
            if (r.n_events != 4)
                fail_msg("%s at %g: %zu events", how[i].method, how[i].tol, r.n_events);
            for (int k = 0; k < 4; k++)
                assert_int_equal(r.event[k].kind, kind[k]);
            assert_true(r.stats.unresolved <= 472 && (i > 0 || r.stats.unresolved > 0));
            run_free(&r);
        }
}

static void
a_phase_of_many_turns_is_its_remainder(void **state)
{
    ss_scene s = scene_named("coulomb", 1, 100), turned = s;
    (void)state;
    turned.phase = 1e9;
    s.phase = atan2(sin(1e9), cos(1e9));
    run a = run_of(&s), b = run_of(&turned);
    assert_int_equal(a.n_events, b.n_events);
    for (size_t i = 0; i < a.n; i++)
        assert_true(fabs(a.sample[i].x - b.sample[i].x) <= 8 * DBL_EPSILON * s.base_amplitude);
    run_free(&a);
    run_free(&b);
}

static void
is_a_linear_oscillator_without_friction(void **state)
{
    /* at resonance from rest: x = (Omega t / 2) Z_e sin(Omega t) for m = k = Omega = 1 */
    ss_scene s = unit_oscillator(0, 1, 1);
    (void)state;
    s.duration = 50;
    s.rate = 10;
    run r = run_of(&s);
    for (size_t i = 0; i < r.n; i++) {
        double t = r.sample[i].t, x = t / 2 * sin(t);
        /* 2 pi (1 / 2 pi) is 1 to within an ulp, which grows with t^2 */
        assert_true(fabs(r.sample[i].x - x) <= 1e-11 * 25);
        assert_true(r.sample[i].f == 0);
    }
    run_free(&r);
}

static void
never_moves_under_great_friction(void **state)
{
    ss_scene s = unit_oscillator(1e9, 1, 1);
    (void)state;
    s.x0 = 0.1;
    run r = run_of(&s);
    assert_int_equal(r.n_events, 0);
    for (size_t i = 0; i < r.n; i++)
        assert_true(r.sample[i].x == 0.1 && r.sample[i].v == 0 && r.sample[i].a == 0);
    run_free(&r);
}

static void
keeps_the_phase_of_the_base_for_ever(void **state)
{
    /* stuck for 10^9 s: 2.5 x 10^9 cycles, a whole number, so the force is that of the first second */
    ss_scene early = scene_named("coulomb", 1, 100), late = early;
    (void)state;
    early.friction = late.friction = 10;
    late.settle = 1e9;
    run a = run_of(&early), b = run_of(&late);
    for (size_t i = 0; i < a.n; i++)
        /* 2 pi cycles rounds twice, at up to pi, and times 1.386 N */
        assert_true(fabs(a.sample[i].f - b.sample[i].f) <= 8 * DBL_EPSILON);
    run_free(&a);
    run_free(&b);
}

static void
mirrored_scenes_move_mirrored(void **state)
{
    ss_scene s = scene_named("compliant-light", 5, 500), mirror = s;
    (void)state;
    s.x0 = 1e-4;
    s.v0 = 2e-3;
    s.base_amplitude = mirror.base_amplitude = 0;
    mirror.x0 = -s.x0;
    mirror.v0 = -s.v0;
    run a = run_of(&s), b = run_of(&mirror);
    assert_int_equal(a.n_events, b.n_events);
    for (size_t i = 0; i < a.n; i++)
        assert_true(a.sample[i].x == -b.sample[i].x && a.sample[i].f == -b.sample[i].f);
    run_free(&a);
    run_free(&b);
}

static void
does_not_depend_on_the_unit_of_force(void **state)
{
    ss_scene s = scene_named("compliant-light", 5, 500), scaled = s;
    (void)state;
    scaled.mass *= 0x1p40;
    scaled.stiffness *= 0x1p40;
    scaled.friction *= 0x1p40;
    ss_scene_set(&scaled, "contact_stiffness", ss_scene_get(&scaled, "contact_stiffness") * 0x1p40, NULL);
    ss_scene_set(&scaled, "contact_damping", ss_scene_get(&scaled, "contact_damping") * 0x1p40, NULL);
    run a = run_of(&s), b = run_of(&scaled);
    assert_int_equal(a.n_events, b.n_events);
    for (size_t i = 0; i < a.n; i++)
        assert_true(a.sample[i].x == b.sample[i].x && a.sample[i].a == b.sample[i].a);
    run_free(&a);
    run_free(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equals_the_closed_form_at_the_default_tolerance),
        cmocka_unit_test(exact_equals_the_closed_form_to_rounding),
        cmocka_unit_test(exact_and_integrated_agree_where_formulas_are_singular),
        cmocka_unit_test(stays_put_while_it_sticks),
        cmocka_unit_test(samples_fall_on_n_over_rate),
        cmocka_unit_test(settling_is_the_same_motion_earlier),
        cmocka_unit_test(a_sample_at_an_event_is_after_it),
        cmocka_unit_test(gives_den_hartogs_amplitudes),
        cmocka_unit_test(stops_where_den_hartog_says),
        cmocka_unit_test(loses_four_f_over_k_a_cycle),
        cmocka_unit_test(touching_the_limit_is_no_release),
        cmocka_unit_test(a_phase_of_many_turns_is_its_remainder),
        cmocka_unit_test(is_a_linear_oscillator_without_friction),
        cmocka_unit_test(never_moves_under_great_friction),
        cmocka_unit_test(keeps_the_phase_of_the_base_for_ever),
        cmocka_unit_test(mirrored_scenes_move_mirrored),
        cmocka_unit_test(does_not_depend_on_the_unit_of_force),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
