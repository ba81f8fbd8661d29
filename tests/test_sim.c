/* test_sim.c -- simulation against closed forms and published numbers.
 *
 * Truth comes from tests/oracle.c (closed form between events, long double), from the figures of
 * independent programs listed beside the rows, and from Den Hartog (1931). */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <stickslip.h>
#include "extremes/runs.h"
#include "oracle.h"
#include "shipped.h"

/* --- running a scene ----------------------------------------------------------------------- */

static run
run_by(const ss_scene *scene, const char *method, double tol)
{
    run r = run_with(scene, method, tol, 0);
    if (r.status != SS_OK)
        fail_msg("%s", r.err.text);
    return r;
}

static run
run_of(const ss_scene *scene)
{
    return run_by(scene, ss_sim_defaults.method, ss_sim_defaults.tol);
}

static double
max_of(const run *r, size_t from, size_t to)
{
    double max = 0;
    for (size_t i = from; i < to; i++)
        max = fmax(max, fabs(r->sample[i].x));
    return max;
}

/* A shipped scene from rest, without settling. */
static ss_scene
scene_named(const char *name, double duration, double rate)
{
    ss_scene scene = read_shipped_named(name);
    scene.settle = 0;
    scene.duration = duration;
    scene.rate = rate;
    return scene;
}

/* A free or driven oscillator with m = k = 1, so omega_n = 1, and Coulomb friction. */
static ss_scene
unit_oscillator(double friction, double amplitude, double r)
{
    ss_scene s = ss_scene_defaults;
    s.mass = s.stiffness = 1;
    s.friction = friction;
    s.base_amplitude = amplitude;
    s.base_frequency = r / (2 * M_PI);
    return s;
}

static const char *const with_events[] = { "coulomb", "compliant-heavy", "compliant-light" };

/* --- events -------------------------------------------------------------------------------- */

static void
finds_every_event_once(void **state)
{
    /* counts by two independent programs: closed forms checked in 34 digits, and Taylor series */
    static const size_t in_10_s[] = { 101, 151, 193 }, in_1000_s[] = { 10001, 19951, 19993 };
    static const struct { const char *method; double tol; } how[] = {
        { "exact", 1e-12 }, { "rk8pd", 1e-12 }, { "rk8pd", 1e-6 }, { "rkf45", 1e-8 }, { "msbdf", 1e-8 } };
    (void)state;
    for (int i = 0; i < 3; i++) {
        ss_scene s = scene_named(with_events[i], 10, 20);
        for (size_t k = 0; k < sizeof how / sizeof *how; k++) {
            run r = run_by(&s, how[k].method, how[k].tol);
            assert_int_equal(r.n_events, in_10_s[i]);
            run_free(&r);
        }
        s.release = SS_RELEASE_TOTAL;
        run r = run_of(&s);
        assert_int_equal(r.n_events, in_10_s[i]);
        run_free(&r);
        s.release = SS_RELEASE_SPRING;
        s.duration = 1000;
        s.rate = 1;
        r = run_of(&s);
        assert_int_equal(r.n_events, in_1000_s[i]);
        assert_int_equal(r.stats.events, in_1000_s[i]);
        run_free(&r);
    }
}

/* Three zeros of v in one step of slip: a stick and a slip, 0.1 ms apart where a step is 0.9 ms long.
 * Told apart from a single zero, all events that follow differ.  The error of a time grows with the
 * events before it: exact rounds at 4e-16 s each, rk8pd works at a tolerance of 1e-12. */
static void
loses_no_pair_of_events_within_a_step(void **state)
{
    static const struct { const char *method; double allow; } how[] = {
        { "exact", 1e-14 }, { "rk8pd", 1e-10 } };
    ss_scene s = { .model = SS_COMPLIANT, .mass = 39.962297470418015, .stiffness = 1210590.7683860338,
                   .friction = 6424.5387020796, .base_amplitude = .0053703860382076155,
                   .base_frequency = 21.398368727045753, .contact_stiffness = 82309189578.27042,
                   .x0 = -.00030267041130123407, .v0 = 1.115255409262061, .duration = .8608,
                   .rate = 4907 };
    (void)state;
    oracle *o = oracle_new(&s, s.duration);
    for (size_t i = 0; i < sizeof how / sizeof *how; i++) {
        run r = run_by(&s, how[i].method, ss_sim_defaults.tol);
        size_t pairs = 0;
        double worst = 0;
        assert_int_equal(r.n_events, o->n);
        for (size_t k = 0; k < r.n_events; k++) {
            assert_int_equal(r.event[k].kind, o->piece[k].kind);
            assert_int_equal(r.event[k].direction, o->piece[k].direction);
            worst = fmax(worst, fabs(r.event[k].t - (double)o->piece[k].t0));
            pairs += fabs(r.event[k].t - .2332225) < 1e-7 && fabs(r.event[k + 1].t - .2333260) < 1e-7;
        }
        print_message("%s: %zu events within %.1e s\n", how[i].method, r.n_events, worst);
        assert_int_equal(pairs, 1);
        assert_true(worst <= how[i].allow);
        run_free(&r);
    }
    oracle_free(o);
}

/* Times after a multiple of the period, as SCIENCE prints them: to the digits given there. */
static const struct settled {
    const char *scene;
    ss_release release;
    double settle, period, digits, t[4];
    ss_event_kind kind[4];
} settled[] = {
    { "coulomb", SS_RELEASE_SPRING, 40, 0.4, 1e-12,
      { 0.044012760662, 0.120289695385, 0.244012760662, 0.320289695385 },
      { SS_STICK, SS_SLIP, SS_STICK, SS_SLIP } },
    { "compliant-heavy", SS_RELEASE_SPRING, 40, 0.2, 1e-6,
      { 0.047167, 0.119186, 0.126924, 0.132404 }, { SS_STICK, SS_SLIP, SS_STICK, SS_SLIP } },
    { "compliant-light", SS_RELEASE_SPRING, 40, 0.2, 1e-6,
      { 0.048363, 0.100862, 0.102022, 0.119228 }, { SS_STICK, SS_SLIP, SS_STICK, SS_SLIP } },
    { "compliant-heavy", SS_RELEASE_TOTAL, 40, 0.2, 1e-6,
      { 0.047173, 0.118797, 0.127028, 0.131983 }, { SS_STICK, SS_SLIP, SS_STICK, SS_SLIP } },
    { "compliant-light", SS_RELEASE_TOTAL, 40, 0.2, 1e-6,
      { 0.048365, 0.100741, 0.102024, 0.119110 }, { SS_STICK, SS_SLIP, SS_STICK, SS_SLIP } },
};

static void
settles_into_the_known_cycle(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof settled / sizeof *settled; i++) {
        const struct settled *row = &settled[i];
        ss_scene s = scene_named(row->scene, 0.4, 100);
        s.settle = row->settle;
        s.release = row->release;
        run r = run_of(&s);
        size_t a_period = 4;
        assert_int_equal(r.n_events, row->period == 0.4 ? 4 : 8);
        for (size_t k = 0; k < r.n_events; k++) {
            double t = row->t[k % a_period] + (double)(k / a_period) * row->period;
            /* half of the last digit given, and what is left of the transient at 40 s */
            double allow = row->digits / 2 + (row->period == 0.2 ? 1e-7 : 1e-12);
            if (!(fabs(r.event[k].t - t) <= allow))
                fail_msg("%s: event %zu at %.15g, not %.15g", row->scene, k, r.event[k].t, t);
            assert_int_equal(r.event[k].kind, row->kind[k % a_period]);
        }
        run_free(&r);
    }
}

static void
groups_releases_as_the_paper_shows(void **state)
{
    /* c = 25: a micro-slip in every half-cycle from 2 to 5.2 s; c = 80: none there */
    static const struct { const char *scene; size_t releases; } row[] = {
        { "compliant-light", 2 }, { "compliant-heavy", 1 } };
    (void)state;
    for (int i = 0; i < 2; i++) {
        ss_scene s = scene_named(row[i].scene, 3.2, 20);
        size_t count[16] = { 0 };
        s.settle = 2;
        run r = run_of(&s);
        for (size_t k = 0; k < r.n_events; k++)
            count[(int)(r.event[k].t / 0.2)] += r.event[k].kind == SS_SLIP;
        for (int half = 0; half < 16; half++)
            assert_int_equal(count[half], row[i].releases);
        run_free(&r);
    }
}

static void
events_do_not_depend_on_the_rate(void **state)
{
    static const double rate[] = { 20, 2000, 100000 };
    (void)state;
    for (int i = 0; i < 6; i++) {
        run first = { 0 };
        for (int k = 0; k < 3; k++) {
            ss_scene s = scene_named(with_events[i % 3], 4, rate[k]);
            run r = run_by(&s, i < 3 ? "rk8pd" : "exact", ss_sim_defaults.tol);
            assert_true(r.in_order);
            if (k == 0) {
                first = r;
                continue;
            }
            assert_int_equal(r.n_events, first.n_events);
            for (size_t e = 0; e < r.n_events; e++)
                assert_true(r.event[e].t == first.event[e].t && r.event[e].x == first.event[e].x
                            && r.event[e].v == first.event[e].v);
            run_free(&r);
        }
        run_free(&first);
    }
}

static void
survives_a_slip_shorter_than_a_step(void **state)
{
    /* the shortest slip of the c = 25 scene lasts 0.10 ms; microstick steps are 0.53 ms */
    ss_scene s = scene_named("compliant-light", 10, 20);
    double shortest = 1;
    (void)state;
    run r = run_of(&s);
    for (size_t k = 1; k < r.n_events; k++)
        if (r.event[k].kind == SS_STICK)
            shortest = fmin(shortest, r.event[k].t - r.event[k - 1].t);
    assert_true(fabs(shortest - 1.0e-4) < 0.05e-4);
    run_free(&r);
}

/* --- against the closed form --------------------------------------------------------------- */

static void
compare_with_closed_form(const char *method, double allow_t, double allow_x, double allow_a)
{
    for (int i = 0; i < 6; i++) {
        ss_scene s = scene_named(with_events[i % 3], 10, 2000);
        s.release = i < 3 ? SS_RELEASE_SPRING : SS_RELEASE_TOTAL;
        oracle *o = oracle_new(&s, 10);
        run r = run_by(&s, method, ss_sim_defaults.tol);
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
        if (ss_scene_load(&s, "compliant-light", set, n + 2, &err) != SS_OK)
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
     * 47 periods a second, for ever; releases there would be rounding.  In truth: slip, stick, slip,
     * stick. */
    static const struct { const char *method; double tol; } how[] = {
        { "exact", 1e-12 }, { "rk8pd", 1e-12 }, { "rk8pd", 1e-7 }, { "rkf45", 1e-12 },
        { "rkf45", 1e-8 }, { "rk4", 1e-10 }, { "bsimp", 1e-10 }, { "msbdf", 1e-9 } };
    static const ss_event_kind kind[] = { SS_SLIP, SS_STICK, SS_SLIP, SS_STICK };
    ss_scene s = scene_named("compliant-light", 10, 20);
    (void)state;
    s.base_amplitude = s.contact_damping = 0;
    s.x0 = 0.002;
    for (int release = 0; release < 2; release++)
        for (size_t i = 0; i < sizeof how / sizeof *how; i++) {
            s.release = release == 0 ? SS_RELEASE_SPRING : SS_RELEASE_TOTAL;
            run r = run_by(&s, how[i].method, how[i].tol);
            if (r.n_events != 4)
                fail_msg("%s at %g: %zu events", how[i].method, how[i].tol, r.n_events);
            for (int k = 0; k < 4; k++)
                assert_int_equal(r.event[k].kind, kind[k]);
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
    scaled.contact_stiffness *= 0x1p40;
    scaled.contact_damping *= 0x1p40;
    run a = run_of(&s), b = run_of(&scaled);
    assert_int_equal(a.n_events, b.n_events);
    for (size_t i = 0; i < a.n; i++)
        assert_true(a.sample[i].x == b.sample[i].x && a.sample[i].a == b.sample[i].a);
    run_free(&a);
    run_free(&b);
}

/* --- the state-variable model -------------------------------------------------------------- */

static void
state_variable_oscillates_instead_of_sticking(void **state)
{
    ss_scene s = scene_named("state-variable", 10, 20000), literal = s;
    size_t extrema = 0;
    (void)state;
    run r = run_of(&s);
    assert_int_equal(r.n_events, 0);
    double max = max_of(&r, 160000, 200000);
    assert_true(fabs(max - 1.909e-4) <= 0.5e-7);        /* published to these digits */
    /* in one settled half-cycle, while v is low: six extrema of a, about 8.3 ms apart */
    double max_v = 0, last[8] = { 0 };
    for (size_t i = 160000; i < 200000; i++)
        max_v = fmax(max_v, fabs(r.sample[i].v));
    for (size_t i = 192000; i < 196000; i++) {
        const ss_sample *p = &r.sample[i];
        if (fabs(p->v) < 0.03 * max_v && (p[0].a - p[-1].a) * (p[1].a - p[0].a) < 0)
            last[extrema++ % 8] = p->t;
    }
    assert_int_equal(extrema, 6);
    assert_true(fabs((last[5] - last[2]) / 3 - 8.3e-3) < 0.1e-3);

    literal.law = SS_LAW_LITERAL;                       /* settles at +-1 N: a weaker oscillation */
    run weak = run_of(&literal);
    double max_f = 0;
    for (size_t i = 160000; i < 200000; i++)
        max_f = fmax(max_f, fabs(weak.sample[i].f));
    assert_true(max_f < 1.0 && max_f > 0.9);
    run_free(&weak);
    run_free(&r);
}

static void
methods_agree_on_the_state_variable(void **state)
{
    /* three methods of different kinds, over 2 s; each within 1e3 of its local tolerance */
    static const struct { const char *method; double tol, allow; } how[] = {
        { "rkf45", 1e-10, 1e-7 }, { "msbdf", 1e-7, 1e-4 }, { "bsimp", 1e-8, 1e-5 } };
    static const ss_law law[] = { SS_LAW_SCALED, SS_LAW_LITERAL };
    (void)state;
    for (int l = 0; l < 2; l++) {
        ss_scene s = scene_named("state-variable", 2, 500);
        s.law = law[l];
        run truth = run_of(&s);
        double max = max_of(&truth, 0, truth.n);
        for (size_t k = 0; k < sizeof how / sizeof *how; k++) {
            run r = run_by(&s, how[k].method, how[k].tol);
            double worst = 0;
            for (size_t i = 0; i < r.n; i++)
                worst = fmax(worst, fabs(r.sample[i].x - truth.sample[i].x) / max);
            if (!(worst <= how[k].allow))
                fail_msg("%s: %.2g", how[k].method, worst);
            run_free(&r);
        }
        run_free(&truth);
    }
}

/* --- the interface ------------------------------------------------------------------------- */

static int
stop_at_once(const ss_sample *s, size_t n, void *user)
{
    (void)s, (void)n;
    ++*(int *)user;
    return 1;
}

static int
stop_at_event(const ss_event *e, void *user)
{
    (void)e;
    ++*(int *)user;
    return 1;
}

static void
stops_when_a_sink_asks(void **state)
{
    ss_scene s = scene_named("compliant-light", 10, 2000);
    ss_sim_opts opts = ss_sim_defaults;
    int calls = 0;
    (void)state;
    opts.user = &calls;
    opts.samples = stop_at_once;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, NULL), SS_STOP);
    assert_int_equal(calls, 1);
    opts.samples = NULL;
    opts.events = stop_at_event;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, NULL), SS_STOP);
    assert_int_equal(calls, 2);
}

static void
refuses_what_it_cannot_do(void **state)
{
    ss_scene s = scene_named("coulomb", 10, 2000);
    ss_sim_opts opts = ss_sim_defaults;
    ss_error err = { 0 };
    (void)state;
    opts.tol = NAN;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_EINVAL);
    opts = ss_sim_defaults;
    opts.method = "magic";
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_EINVAL);
    assert_string_equal(err.text, "unknown method 'magic'");
    opts = ss_sim_defaults;
    opts.max_steps = 10;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_EBUDGET);
    assert_non_null(strstr(err.text, "step budget of 10 used up at t = "));
    opts = ss_sim_defaults;
    s.mass = INFINITY;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_EINVAL);
    s = scene_named("coulomb", 1e300, 2000);
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_EINVAL);
    s = scene_named("coulomb", 10, 2000);
    s.base_frequency = 1e300;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_EBUDGET);
    assert_non_null(strstr(err.text, "period of the base: more than 1e+12 are not tried"));
    s = scene_named("coulomb", 10, 2000);
    s.x0 = 1e308;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_ERANGE);
}

static void
a_record_of_no_length_has_no_samples(void **state)
{
    ss_scene s = scene_named("coulomb", 0, 2000);
    (void)state;
    run r = run_of(&s);
    assert_int_equal(r.n, 0);
    assert_int_equal(r.n_events, 0);
    run_free(&r);
}

static void
simulates_into_a_signal(void **state)
{
    ss_scene s = scene_named("compliant-light", 1, 1000);
    ss_signal *signal = NULL;
    (void)state;
    assert_int_equal(ss_sim_signal(&signal, &s, NULL), SS_OK);
    run r = run_of(&s);
    assert_int_equal(signal->n, 1000);
    assert_int_equal(signal->head->n_columns, 4);
    assert_string_equal(signal->head->column[2].unit, "m/s^2");
    assert_string_equal(ss_header_find_note(signal->head, "contact_damping"), "25");
    assert_null(ss_header_find_note(signal->head, "rate"));
    for (size_t i = 0; i < 1000; i++)
        assert_true(signal->values[i] == r.sample[i].x
                    && signal->values[2 * 1000 + i] == r.sample[i].a
                    && signal->values[3 * 1000 + i] == r.sample[i].f);
    run_free(&r);
    ss_signal_free(signal);
    s.mass = -1;
    assert_int_equal(ss_sim_signal(&signal, &s, NULL), SS_EINVAL);
}

static void
gives_the_columns_asked_for(void **state)
{
    static const char *const wrong[] = { "", "t", "x,t", "q", "x,x", "x,", ",", "xv" };
    const ss_sample sample = { .x = 2, .a = 4, .mode = -1 };
    ss_sim_columns columns;
    double row[SS_SIM_COLUMNS];
    (void)state;
    assert_int_equal(ss_sim_columns_parse(&columns, "t,mode,a,x", NULL), SS_OK);
    assert_true(columns.has_time && columns.n == 3);
    ss_sim_row(&columns, &sample, row);
    assert_true(row[0] == -1 && row[1] == 4 && row[2] == 2);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(ss_sim_columns_parse(&columns, wrong[i], NULL), SS_EINVAL);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_every_event_once),
        cmocka_unit_test(loses_no_pair_of_events_within_a_step),
        cmocka_unit_test(settles_into_the_known_cycle),
        cmocka_unit_test(groups_releases_as_the_paper_shows),
        cmocka_unit_test(events_do_not_depend_on_the_rate),
        cmocka_unit_test(survives_a_slip_shorter_than_a_step),
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
        cmocka_unit_test(state_variable_oscillates_instead_of_sticking),
        cmocka_unit_test(methods_agree_on_the_state_variable),
        cmocka_unit_test(stops_when_a_sink_asks),
        cmocka_unit_test(refuses_what_it_cannot_do),
        cmocka_unit_test(a_record_of_no_length_has_no_samples),
        cmocka_unit_test(simulates_into_a_signal),
        cmocka_unit_test(gives_the_columns_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
