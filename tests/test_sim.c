/* test_sim.c -- simulation: its events, the state-variable model, sinks and what is refused.  Truth comes
 * from tests/oracle.c (closed form between events, long double) and the figures of independent programs
 * listed beside the rows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "oracle.h"
#include "scene/scene.h"
#include "sim_runs.h"
#include "unit.h"

/* --- events -------------------------------------------------------------------------------- */

static void
finds_every_event_once(void **state)
{
    /* counts by two independent programs: closed forms checked in 34 digits, and Taylor series */
    static const size_t in_10_s[] = { 101, 151, 193 }, in_1000_s[] = { 10001, 19951, 19993 };
    static const struct { const char *method; double tol; } how[] = {
        { "exact", 1e-12 }, { "taylor", 1e-12 }, { "taylor", 1e-6 }, { "rk8pd", 1e-12 },
        { "rk8pd", 1e-6 }, { "rkf45", 1e-8 }, { "msbdf", 1e-8 } };
    (void)state;
    for (int i = 0; i < 3; i++) {
        ss_scene s = scene_named(with_events[i], 10, 20);
        for (size_t k = 0; k < sizeof how / sizeof *how; k++) {
            run r = run_by(&s, how[k].method, how[k].tol);
            assert_int_equal(r.n_events, in_10_s[i]);
            run_free(&r);
        }
        ss_scene_set_text(&s, "release", "total", NULL);
        run r = run_of(&s);
        assert_int_equal(r.n_events, in_10_s[i]);
        run_free(&r);
        ss_scene_set_text(&s, "release", "spring", NULL);
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
 * events before it: exact rounds at 4e-16 s each, the others work at a tolerance of 1e-12. */
static void
loses_no_pair_of_events_within_a_step(void **state)
{
    static const struct { const char *method; double allow; } how[] = {
        { "exact", 1e-14 }, { "taylor", 1e-10 }, { "rk8pd", 1e-10 } };
    ss_scene s = { .model = ss_model_named("compliant"), .mass = 39.962297470418015,
                   .stiffness = 1210590.7683860338,
                   .friction = 6424.5387020796, .base_amplitude = .0053703860382076155,
                   .base_frequency = 21.398368727045753,
                   .x0 = -.00030267041130123407, .v0 = 1.115255409262061, .duration = .8608,
                   .rate = 4907 };
    (void)state;
    ss_scene_set(&s, "contact_stiffness", 82309189578.27042, NULL);
    oracle *o = oracle_new(&s, s.duration);
    for (size_t i = 0; i < sizeof how / sizeof *how; i++) {
        run r = run_by(&s, how[i].method, 1e-12);
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
    const char *release;            /* NULL: the model has none */
    double settle, period, digits, t[4];
    ss_event_kind kind[4];
} settled[] = {
    { "coulomb", NULL, 40, 0.4, 1e-12,
      { 0.044012760662, 0.120289695385, 0.244012760662, 0.320289695385 },
      { SS_STICK, SS_SLIP, SS_STICK, SS_SLIP } },
    { "compliant-heavy", "spring", 40, 0.2, 1e-6,
      { 0.047167, 0.119186, 0.126924, 0.132404 }, { SS_STICK, SS_SLIP, SS_STICK, SS_SLIP } },
    { "compliant-light", "spring", 40, 0.2, 1e-6,
      { 0.048363, 0.100862, 0.102022, 0.119228 }, { SS_STICK, SS_SLIP, SS_STICK, SS_SLIP } },
    { "compliant-heavy", "total", 40, 0.2, 1e-6,
      { 0.047173, 0.118797, 0.127028, 0.131983 }, { SS_STICK, SS_SLIP, SS_STICK, SS_SLIP } },
    { "compliant-light", "total", 40, 0.2, 1e-6,
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
        if (row->release != NULL)
            ss_scene_set_text(&s, "release", row->release, NULL);
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

/* Its steps are as long as they may be, forty a period, so that the mass turns where one ends: v is rounding there. */
static void
bsimp_passes_turns_where_a_step_ends(void **state)
{
    (void)state;
    for (double tol = 1e-2; tol > 1e-14; tol /= 100) {
        ss_scene s = scene_named("free-decay", 5.2, 20);
        run r = run_by(&s, "bsimp", tol);
        assert_int_equal(r.n_events, 11);
        for (size_t k = 0; k < r.n_events; k++)
            assert_float_equal(r.event[k].t, 0.5 * (double)k, 1e-9);
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
            run r = run_by(&s, i < 3 ? "rk8pd" : "exact", 1e-12);
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

    ss_scene_set_text(&literal, "law", "literal", NULL);      /* settles at +-1 N: a weaker oscillation */
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
    /* four methods of different kinds, over 2 s; each within 1e3 of its local tolerance */
    static const struct { const char *method; double tol, allow; } how[] = {
        { "rkf45", 1e-10, 1e-7 }, { "msbdf", 1e-7, 1e-4 }, { "bsimp", 1e-8, 1e-5 },
        { "radau", 1e-8, 1e-11 } };
    static const char *const law[] = { "scaled", "literal" };
    (void)state;
    for (int l = 0; l < 2; l++) {
        ss_scene s = scene_named("state-variable", 2, 500);
        ss_scene_set_text(&s, "law", law[l], NULL);
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
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
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
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    ss_error err = { 0 };
    (void)state;
    opts.tol = NAN;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_EINVAL);
    ss_sim_opts_init(&opts, sizeof opts);
    opts.method = "magic";
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_EINVAL);
    assert_string_equal(err.text, "unknown method 'magic'");
    ss_sim_opts_init(&opts, sizeof opts);
    opts.max_steps = 10;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, &err), SS_EBUDGET);
    assert_non_null(strstr(err.text, "step budget of 10 used up at t = "));
    ss_sim_opts_init(&opts, sizeof opts);
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

/* Of every model, on a belt too: the first sample is where the motion starts, at rest on the belt or not. */
static void
records_begin_where_the_motion_starts(void **state)
{
    size_t models = 0;
    (void)state;
    for (const ss_model *model; (model = ss_model_at(models)) != NULL; models++)
        for (int k = 0; k < 6; k++) {
            const double belt = k % 2 ? .03 : 0, v0[] = { 0, .03, .07 };
            ss_scene s = read_shipped_named(strcmp(ss_model_name(model), "rate-and-state") == 0
                                            ? "rate-and-state-mild" : "coulomb");
            if (s.model != model) {
                s.model = model;
                ss_scene_set(&s, "alpha", 1000, NULL);          /* keys that a model does not have are refused */
                ss_scene_set(&s, "gamma", 100, NULL);
                ss_scene_set(&s, "contact_stiffness", 2e4, NULL);
                ss_scene_set(&s, "bristle_stiffness", 2e4, NULL);
                ss_scene_set(&s, "stribeck_velocity", .1, NULL);
                ss_scene_set(&s, "exponent", 1, NULL);
                ss_scene_set(&s, "beta_fraction", .7, NULL);
                if (strcmp(ss_model_name(model), "lugre") == 0)
                    s.static_friction = 1.5 * s.friction;
            }
            if (s.base_velocity == 0)
                s.surface_velocity = belt;
            s.settle = 0;
            s.x0 = -5.5e-3;
            s.v0 = v0[k / 2];
            s.duration = .01;
            run r = run_of(&s);
            const double v = s.v0 == 0 && s.base_velocity > 0 ? s.base_velocity : s.v0;
            if (!(fabs(r.sample[0].x - s.x0) <= 1e-15 && fabs(r.sample[0].v - v) <= 1e-12))
                fail_msg("%s, belt %g m/s: %g m, %g m/s, not %g, %g", ss_model_name(model), s.surface_velocity,
                         r.sample[0].x, r.sample[0].v, s.x0, v);
            run_free(&r);
        }
    assert_true(models > 6);
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
    assert_int_equal(signal->head->n_columns, 5);
    assert_string_equal(signal->head->column[2].unit, "m/s^2");
    assert_string_equal(ss_header_find_note(signal->head, "contact_damping"), "25");
    assert_null(ss_header_find_note(signal->head, "rate"));
    for (size_t i = 0; i < 1000; i++)
        assert_true(signal->values[i] == r.sample[i].x
                    && signal->values[2 * 1000 + i] == r.sample[i].a
                    && signal->values[3 * 1000 + i] == r.sample[i].f
                    && signal->values[4 * 1000 + i] == r.sample[i].s);
    run_free(&r);
    ss_signal_free(signal);
    s.mass = -1;
    assert_int_equal(ss_sim_signal(&signal, &s, NULL), SS_EINVAL);
}

static void
gives_the_columns_asked_for(void **state)
{
    static const char *const wrong[] = { "", "t", "x,t", "q", "x,x", "x,", ",", "xv" };
    const ss_sample sample[2] = { { .x = 2, .a = 4, .mode = -1 }, { .x = 3, .a = -0.0, .mode = 1 } };
    ss_sim_columns columns;
    double mode[2], a[2], x[2], *const column[] = { mode, a, x };
    (void)state;
    assert_int_equal(ss_sim_columns_parse(&columns, "t,mode,a,x", NULL), SS_OK);
    assert_true(columns.has_time && columns.n == 3);
    ss_sim_rows(&columns, sample, 2, column);
    assert_true(mode[0] == -1 && a[0] == 4 && x[0] == 2 && mode[1] == 1 && x[1] == 3);
    assert_true(a[1] == 0 && !signbit(a[1]));
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
        cmocka_unit_test(bsimp_passes_turns_where_a_step_ends),
        cmocka_unit_test(events_do_not_depend_on_the_rate),
        cmocka_unit_test(survives_a_slip_shorter_than_a_step),
        cmocka_unit_test(state_variable_oscillates_instead_of_sticking),
        cmocka_unit_test(methods_agree_on_the_state_variable),
        cmocka_unit_test(stops_when_a_sink_asks),
        cmocka_unit_test(refuses_what_it_cannot_do),
        cmocka_unit_test(records_begin_where_the_motion_starts),
        cmocka_unit_test(a_record_of_no_length_has_no_samples),
        cmocka_unit_test(simulates_into_a_signal),
        cmocka_unit_test(gives_the_columns_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
