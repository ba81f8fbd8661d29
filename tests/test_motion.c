/* test_motion.c -- which friction law a recording of motion and force follows: against ss-sim's own forces,
 * against laws in closed form, and recordings that tell nothing. */
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "fit/driven.h"
#include "new_signal.h"
#include "scene/model.h"
#include "uniform.h"
#include "unit.h"

/* --- the law driven is the law simulated ---------------------------------------------------- */

typedef struct place {
    double t, x, v, f;          /* f: NaN at an event */
} place;

typedef struct places {
    place *at;
    size_t n, room;
} places;

static void
add(places *p, place at)
{
    if (p->n == p->room)
        p->at = realloc(p->at, (p->room = 2 * p->room + 1000) * sizeof *p->at);
    assert_non_null(p->at);
    p->at[p->n++] = at;
}

static int
add_samples(const ss_sample *s, size_t n, void *user)
{
    for (size_t i = 0; i < n; i++)
        add(user, (place){ s[i].t, s[i].x, s[i].v, s[i].f });
    return 0;
}

static int
add_event(const ss_event *e, void *user)
{
    add(user, (place){ e->t, e->x, NAN, NAN });
    return 0;
}

static int
by_time(const void *a, const void *b)
{
    const place *p = a, *q = b;
    return (p->t > q->t) - (p->t < q->t);
}

/* An elastic contact, the motion of ss-sim, and its events inserted as samples.  f is f_k times a deflection whose
 * pieces are added up: one rounding of x each. */
static void
drives_as_it_simulates(void **unused)
{
    static const char *const settings[] = { "contact_damping=0", "settle=0", "duration=4" };
    (void)unused;
    ss_scene scene;
    places p = { 0 };
    ss_sim_opts opts;
    assert_int_equal(ss_scene_read(&scene, NULL, "compliant-light", settings, 3, NULL), SS_OK);
    ss_sim_opts_init(&opts, sizeof opts);
    opts.samples = add_samples;
    opts.events = add_event;
    opts.user = &p;
    assert_int_equal(ss_sim_run(&scene, &opts, NULL, NULL), SS_OK);
    qsort(p.at, p.n, sizeof *p.at, by_time);
    double memory = 0, part[DRIVEN_PARTS], worst = 0;
    size_t events = 0;
    for (size_t i = 0; i < p.n; i++) {
        const piece q = { i > 0 ? p.at[i].x - p.at[i - 1].x : 0, i > 0 ? p.at[i].t - p.at[i - 1].t : 0, 0, 0 };
        scene.model->drive(&scene, &memory, &q, part);
        events += isnan(p.at[i].f);
        if (!isnan(p.at[i].f))
            worst = fmax(worst, fabs(part[0] + part[1] - p.at[i].f));
    }
    print_message("%zu events, f within %.1e N\n", events, worst);
    assert_true(events > 50 && worst <= 1e-9 * scene.friction);
    free(p.at);
}

/* Rate and state, from one sample to the next at the mean speed: of an age whose time is h V/Dc = .01 or less, this
 * neglects (h V/Dc)^2/12 of b N. */
static void
drives_rate_and_state_as_it_simulates(void **unused)
{
    (void)unused;
    for (int law = 0; law < 2; law++) {
        const char *const settings[] = { law ? "law=slip" : "law=aging", "settle=0", "duration=.5", "rate=20000" };
        ss_scene s;
        places p = { 0 };
        ss_sim_opts opts;
        assert_int_equal(ss_scene_read(&s, NULL, "rate-and-state-mild", settings, 4, NULL), SS_OK);
        ss_sim_opts_init(&opts, sizeof opts);
        opts.samples = add_samples;
        opts.user = &p;
        assert_int_equal(ss_sim_run(&s, &opts, NULL, NULL), SS_OK);
        double memory = log(ss_scene_get(&s, "reference_velocity") / s.base_velocity), worst = 0;
        for (size_t i = 1; i < p.n; i++) {
            const piece q = { p.at[i].x - p.at[i - 1].x, p.at[i].t - p.at[i - 1].t, p.at[i].v, 0 };
            double part[DRIVEN_PARTS];
            s.model->drive(&s, &memory, &q, part);
            worst = fmax(worst, fabs(part[0] + part[1] + part[2] - p.at[i].f));
        }
        print_message("f within %.1e N\n", worst);
        assert_true(p.n == 10000 && worst <= 1e-4 / 12 * .015 * 10);
        free(p.at);
    }
}

/* --- a converter ----------------------------------------------------------------------------- */

/* Values that n_1, n_2 ... of n rows have are as good as n^2 / (n_1^2 + n_2^2 + ...) that are as frequent as each
 * other: four are four. */
static void
counts_the_values_of_a_converter(void **unused)
{
    enum { N = 600, MOST = 4 };
    static const size_t rows[2][MOST] = { { 150, 150, 150, 150 }, { 300, 200, 100 } };
    double t[N], x[N], f[N];
    ss_motion_opts opts;
    (void)unused;
    ss_motion_opts_init(&opts, sizeof opts);
    for (int i = 0; i < 2; i++) {
        double squares = 0;
        driven d;
        for (size_t k = 0, at = 0; k < MOST; k++) {
            squares += (double)rows[i][k] * (double)rows[i][k];
            for (size_t end = at + rows[i][k]; at < end; at++)
                f[at] = 0.5 * (double)k;
        }
        for (int k = 0; k < N; k++) {
            t[k] = k;
            x[k] = sin(0.05 * k);
        }
        assert_int_equal(ss_driven_new(&d, t, x, f, N, &opts), SS_OK);
        assert_true(fabs(d.codes - (double)(N * N) / squares) <= 1e-12);
        assert_true(fabs(d.code * d.force - 0.5) <= 1e-12);
        ss_driven_free(&d);
    }
}

/* --- turns ----------------------------------------------------------------------------------- */

/* Where the force jumps as the motion turns, it may do so a row earlier or later: the rows before, behind and after
 * this one tell nothing, also at the end of the record. */
static void
leaves_out_rows_about_a_jump(void **unused)
{
    enum { N = 600 };
    static const int behind[] = { 300, N - 1 };           /* the row behind it */
    double t[N], x[N], f[N];
    ss_motion_opts opts;
    (void)unused;
    ss_motion_opts_init(&opts, sizeof opts);
    for (size_t i = 0; i < 2; i++) {
        driven d;
        for (int k = 0; k < N; k++) {
            t[k] = k;
            x[k] = -pow(k - (behind[i] - 0.5), 2);        /* which cubics follow */
            f[k] = k < behind[i] ? 1 : -1;
        }
        assert_int_equal(ss_driven_new(&d, t, x, f, N, &opts), SS_OK);
        for (int k = N / 10; k + 1 < N; k++)
            assert_int_equal(d.used[k], k < behind[i] - 1 || k > behind[i] + 1);
        ss_driven_free(&d);
    }
}

/* --- laws in closed form -------------------------------------------------------------------- */

enum { ROWS = 3000 };

typedef struct recording {
    ss_signal *signal;
    double *x, *v, *f;
} recording;

/* Ten cycles of a motion of 2 mm that is no sine, with columns x/mm and f/kN. */
static recording
record(void)
{
    ss_header *head = NULL;
    recording r = { 0 };
    assert_int_equal(ss_header_new(&head, ROWS / 10., 0, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "x", "mm", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "v", "mm/s", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "f", "kN", NULL), SS_OK);
    assert_int_equal(ss_signal_new(&r.signal, head, ROWS, NULL), SS_OK);
    ss_header_free(head);
    r.x = r.signal->values;
    r.v = r.x + ROWS;
    r.f = r.v + ROWS;
    for (int i = 0; i < ROWS; i++) {
        double w = 2 * M_PI, t = i / (ROWS / 10.);
        r.x[i] = 2 * sin(w * t) + 0.4 * sin(1.7 * w * t);
        r.v[i] = 2 * w * cos(w * t) + 0.4 * 1.7 * w * cos(1.7 * w * t);
    }
    return r;
}

static void
add_noise(double *f, double size, uint64_t seed)
{
    for (int i = 0; i < ROWS; i++)
        f[i] += size * sqrt(-2 * log(1 - uniform(&seed))) * cos(2 * M_PI * uniform(&seed));
}

static ss_motion_ranking *
rank(const recording *r, size_t motion, const ss_motion_opts *opts)
{
    ss_motion_ranking *k = NULL;
    ss_error err = { 0 };
    if (ss_motion_ranking_new(&k, r->signal, motion, 2, opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    for (size_t i = 0; i < k->n; i++)           /* a correlation */
        assert_false(fabs(k->row[i].repeat) > 1 + 1e-12);
    return k;
}

/* The number of this name is the truth within four of its errors, which are at most a tenth of it. */
static void
assert_number(const ss_motion_ranking *k, const char *name, double truth, const char *unit)
{
    for (size_t i = 0; i < k->n_numbers; i++)
        if (strcmp(k->number[i].name, name) == 0) {
            const ss_value v = k->number[i].value;
            print_message("%s: %g +- %g, truth %g\n", name, v.value, v.error, truth);
            assert_true(fabs(v.value - truth) <= 4 * v.error && v.error <= 0.1 * fabs(truth));
            assert_string_equal(k->number[i].unit, unit);
            return;
        }
    fail_msg("no %s", name);
}

static void
assert_named(const ss_motion_ranking *k, const char *law)
{
    if (k->verdict != SS_NAMED || strcmp(k->row[0].law, law) != 0)
        fail_msg("%s, not %s", k->answer, law);
}

static double
slider(double *y, double dx, double most)
{
    return *y = fmax(-most, fmin(*y + dx, most));
}

static void
fill_jenkins(recording *r)
{
    double y = 0;
    for (int i = 0; i < ROWS; i++)
        r->f[i] = 3 * slider(&y, i > 0 ? r->x[i] - r->x[i - 1] : 0, 0.5) / 0.5 + 0.2 * r->x[i] + 0.7;
}

static void
names_an_elastic_slider(void **unused)
{
    recording r = record();
    (void)unused;
    fill_jenkins(&r);
    add_noise(r.f, 0.03, 1);
    for (int i = 0; i < ROWS; i++)          /* in 10 s */
        r.f[i] += 3. * i / ROWS;
    for (int i = 1000; i < 1030; i++)       /* a gap of the recording, in which both are 0 */
        r.x[i] = r.f[i] = 0;
    assert_int_equal(ss_header_note(r.signal->head, "gaps", "3.3333333:3.4333333", NULL), SS_OK);
    ss_motion_ranking *k = rank(&r, 0, NULL);
    assert_named(k, "compliant");
    assert_number(k, "friction", 3, "kN");
    assert_number(k, "contact_stiffness", 6, "kN/mm");
    assert_number(k, "tilt", 0.2, "kN/mm");
    assert_number(k, "drift", 0.3, "kN/s");
    assert_true(k->sign == 1 && ss_scene_get(&k->scene, "contact_stiffness") > 5.9e6
                && ss_scene_get(&k->scene, "contact_stiffness") < 6.1e6);
    ss_motion_ranking_free(k);
    ss_signal_free(r.signal);
}

/* A slider behind a gap, whose place and stiffness a fit finds from a start that has been improved: other laws with a
 * gap come near it. */
static void
names_a_slider_behind_a_gap(void **unused)
{
    const double gap = 1, reach = gap + 0.5;
    recording r = record();
    double y = 0;
    (void)unused;
    for (int i = 0; i < ROWS; i++) {
        slider(&y, i > 0 ? r.x[i] - r.x[i - 1] : 0, reach);
        r.f[i] = 3 * copysign(fmax(fabs(y) - gap, 0), y) / (reach - gap);
    }
    add_noise(r.f, 0.01, 1);
    ss_motion_ranking *k = rank(&r, 0, NULL);
    assert_named(k, "compliant-gap");
    assert_number(k, "friction", 3, "kN");
    assert_number(k, "contact_stiffness", 6, "kN/mm");
    assert_number(k, "gap", gap, "mm");
    ss_motion_ranking_free(k);
    ss_signal_free(r.signal);
}

/* The force on what moves, by its velocity, and later than it by a row. */
static void
finds_sign_velocity_and_delay(void **unused)
{
    recording r = record();
    ss_motion_opts opts;
    (void)unused;
    fill_jenkins(&r);
    for (int i = ROWS - 1; i > 0; i--)
        r.f[i] = -r.f[i - 1];
    add_noise(r.f, 0.03, 2);
    ss_motion_opts_init(&opts, sizeof opts);
    opts.is_velocity = 1;
    opts.delay = 2;
    ss_motion_ranking *k = rank(&r, 1, &opts);
    assert_named(k, "compliant");
    assert_int_equal(k->sign, -1);
    assert_number(k, "contact_stiffness", 6, "kN/mm");
    assert_number(k, "delay", 10. / ROWS, "s");
    ss_motion_ranking_free(k);
    ss_signal_free(r.signal);
}

/* A force that is later than the motion by half a row is that of the motion between rows. */
static void
finds_a_delay_of_half_a_row(void **unused)
{
    const double w = 2 * M_PI, half = 5. / ROWS;
    recording r = record();
    double y = 0, before = 0;
    (void)unused;
    for (int i = 0; i < ROWS; i++) {
        double t = i / (ROWS / 10.) - half, x = 2 * sin(w * t) + 0.4 * sin(1.7 * w * t);
        r.f[i] = 3 * slider(&y, i > 0 ? x - before : 0, 0.5) / 0.5;
        before = x;
    }
    add_noise(r.f, 0.01, 13);
    ss_motion_ranking *k = rank(&r, 0, NULL);
    assert_named(k, "compliant");
    assert_number(k, "delay", half, "s");
    ss_motion_ranking_free(k);
    ss_signal_free(r.signal);
}

/* Rate and state, whose age is integrated in steps of a twentieth of a row.  Where the speed is the same to and fro,
 * it is dry friction. */
static void
names_rate_and_state_where_the_speed_varies(void **unused)
{
    enum { FINE = 20 };
    const double N = 3, a = 0.03, b = 0.02, Dc = 0.4;       /* kN, mm */
    (void)unused;
    for (int is_steady = 0; is_steady < 2; is_steady++) {
        recording r = record();
        double age = 1;
        for (int i = 0; i < ROWS; i++) {
            double h = 10. / ROWS / FINE;
            if (is_steady) {
                int at = i % 300;
                r.x[i] = at < 150 ? at / 75. : 4 - at / 75.;
                r.v[i] = at < 150 ? 4 : -4;
            }
            for (int k = 0; k < FINE && i > 0; k++)
                age += h * (1 - fabs(r.v[i - 1] + (k + 0.5) / FINE * (r.v[i] - r.v[i - 1])) * age / Dc);
            r.f[i] = N * (r.v[i] > 0 ? 1 : -1) * (1 + a * log(fabs(r.v[i])) + b * log(age / Dc));
        }
        add_noise(r.f, 0.01, 21);
        ss_motion_ranking *k = rank(&r, 0, NULL);
        assert_named(k, is_steady ? "coulomb" : "rate-and-state");
        if (!is_steady) {
            const double V0 = ss_scene_get(&k->scene, "reference_velocity") * 1e3, level = 1 + (a - b) * log(V0);
            assert_number(k, "normal_force", N * level, "kN");
            assert_number(k, "direct_effect", a / level, "");
            assert_number(k, "evolution_effect", b / level, "");
            assert_number(k, "critical_slip_distance", Dc, "mm");
            assert_non_null(strstr(k->confounded, "normal_force with reference_friction"));
        }
        ss_motion_ranking_free(k);
        ss_signal_free(r.signal);
    }
}

/* Dahl's law: an exponential of the motion between turns, which lie between rows, 46 a cycle. */
static void
names_dahl(void **unused)
{
    enum { FINE = 50 };
    const double w = 2 * M_PI / 46.1;
    recording r = record();
    double z = 0;
    (void)unused;
    for (int i = 0; i < ROWS; i++) {
        for (int k = FINE - 1; k >= 0 && i > 0; k--) {
            double t = i - (double)k / FINE, dx = 2 * (sin(w * t) - sin(w * (t - 1. / FINE)));
            double way = dx > 0 ? 1 : -1;
            z = way + (z - way) * exp(-fabs(dx) / 0.4);
        }
        r.x[i] = 2 * sin(w * i);
        r.v[i] = 2 * w * cos(w * i) * ROWS / 10;
        r.f[i] = 2 * z + 0.05 * r.v[i];
    }
    add_noise(r.f, 0.02, 3);
    ss_motion_ranking *k = rank(&r, 0, NULL);
    assert_named(k, "dahl");
    assert_number(k, "friction", 2, "kN");
    assert_number(k, "contact_stiffness", 5, "kN/mm");
    assert_number(k, "viscous_friction", 0.05, "kN s/mm");
    ss_motion_ranking_free(k);
    ss_signal_free(r.signal);
}

/* The recording is that of a law with this friction. */
static void
assert_law(const recording *r, const char *law, double friction)
{
    ss_motion_ranking *k = rank(r, 0, NULL);
    assert_named(k, law);
    assert_number(k, "friction", friction, "kN");
    ss_motion_ranking_free(k);
    ss_signal_free(r->signal);
}

/* Dry friction with a Stribeck part, clipped, with gravity on an arm, and oil that drags more in one direction. */
static void
names_dry_friction(void **unused)
{
    recording r = record();
    ss_motion_opts opts;
    (void)unused;
    for (int i = 0; i < ROWS; i++)
        r.f[i] = (r.v[i] > 0 ? 1 : -1) * (2 + 1.5 * exp(-pow(fabs(r.v[i]) / 3, 1.5))) + 0.9 * sin(r.x[i])
            + 0.08 * r.v[i] + 0.03 * fabs(r.v[i]);
    add_noise(r.f, 0.02, 4);
    for (int i = 0; i < ROWS; i++)
        r.f[i] = fmin(r.f[i], 3);
    ss_motion_opts_init(&opts, sizeof opts);
    opts.angle = 1;
    ss_motion_ranking *k = rank(&r, 0, &opts);
    assert_named(k, "stribeck");
    assert_number(k, "friction", 2, "kN");
    assert_number(k, "static_friction", 3.5, "kN");
    assert_number(k, "stribeck_velocity", 3, "mm/s");
    assert_number(k, "stribeck_exponent", 1.5, "");
    assert_number(k, "sine", 0.9, "kN");
    assert_number(k, "viscous_friction", 0.08, "kN s/mm");
    assert_number(k, "viscous_difference", 0.03, "kN s/mm");
    assert_true(k->clipped > 100);
    ss_motion_ranking_free(k);
    ss_signal_free(r.signal);
}

/* A converter reads the force a part of a row after the motion: dry friction then jumps between rows. */
static void
names_dry_friction_read_late(void **unused)
{
    const double w = 2 * M_PI, late = 0.3 / (ROWS / 10.);
    recording r = record();
    (void)unused;
    for (int i = 0; i < ROWS; i++) {
        double t = i / (ROWS / 10.) - late;
        r.f[i] = 2 * cos(w * t) + 0.4 * 1.7 * cos(1.7 * w * t) > 0 ? 2 : -2;
    }
    add_noise(r.f, 0.006, 5);
    assert_law(&r, "coulomb", 2);
}

/* A converter's steps of .03, so that friction has one value either way, or three. */
static void
knows_a_converter(void **unused)
{
    recording r = record();
    (void)unused;
    for (int i = 0; i < ROWS; i++)
        r.f[i] = 0.03 * round(((r.v[i] > 0 ? 2 : -2) + 0.01 * r.x[i]) / 0.03);
    assert_law(&r, "coulomb", 2);
}

/* Friction that wanders by 4 % in the record, and a hum of .6 %: 20 times the noise, but no error of the law. */
static void
names_friction_that_wanders(void **unused)
{
    recording r = record();
    (void)unused;
    fill_jenkins(&r);
    for (int i = 0; i < ROWS; i++)
        r.f[i] = r.f[i] * (1 + 0.04 * sin(0.9 * i / ROWS * 2 * M_PI + 1)) + 0.02 * sin(0.7 * i);
    add_noise(r.f, 0.003, 10);
    assert_law(&r, "compliant", 3);
}

/* The motion is that of an encoder of few lines: where it turns, the direction is not known for some rows. */
static void
names_dry_friction_by_a_coarse_encoder(void **unused)
{
    const double w = 2 * M_PI, late = 0.9 / (ROWS / 10.);
    recording r = record();
    (void)unused;
    for (int i = 0; i < ROWS; i++) {
        double t = i / (ROWS / 10.) - late, v = 2 * w * cos(w * t) + 0.4 * 1.7 * w * cos(1.7 * w * t);
        r.f[i] = (v > 0 ? 2 : -2) + 0.05 * v;
        r.x[i] = 0.01 * rint(r.x[i] / 0.01);
    }
    add_noise(r.f, 0.02, 6);
    ss_motion_ranking *k = rank(&r, 0, NULL);
    assert_named(k, "coulomb");
    assert_number(k, "friction", 2, "kN");
    assert_number(k, "viscous_friction", 0.05, "kN s/mm");
    ss_motion_ranking_free(k);
    ss_signal_free(r.signal);
}

/* Friction that is 6 % larger on one side, and hardly any noise: nothing shows a gap. */
static void
names_a_slider_that_is_uneven(void **unused)
{
    recording r = record();
    (void)unused;
    double y = 0;
    for (int i = 0; i < ROWS; i++) {
        double f = 3 * slider(&y, i > 0 ? r.x[i] - r.x[i - 1] : 0, 0.5) / 0.5;
        r.f[i] = f * (f > 0 ? 1.03 : 0.97) * (1 + 0.02 * r.x[i]);
    }
    add_noise(r.f, 0.003, 11);
    ss_motion_ranking *k = rank(&r, 0, NULL);
    assert_named(k, "compliant");
    assert_number(k, "contact_stiffness", 6, "kN/mm");
    assert_number(k, "unevenness", 0.03, "");
    assert_number(k, "unevenness_by_place", 0.02, "1/mm");
    ss_motion_ranking_free(k);
    ss_signal_free(r.signal);
}

/* The record ends where the motion turns: as a delay may be anything to a row, the force may have jumped. */
static void
names_dry_friction_that_ends_at_a_turn(void **unused)
{
    (void)unused;
    recording r = record();
    double noise = 0;
    add_noise(r.f, 0.02, 11);
    for (int i = 0; i < ROWS; i++) {
        double t = 20 * M_PI * i / ROWS + 11;
        noise = 0.9 * noise + r.f[i];
        r.x[i] = 2 * sin(t);
        r.f[i] = (cos(t) > 0 ? 2 : -2) + 0.4 * cos(t) + noise;
    }
    add_noise(r.x, 2e-4, 111);
    assert_law(&r, "coulomb", 2);
}

/* 100 rows on one count of an encoder at each turn: without them nothing predicts a row. */
static void
names_dry_friction_by_a_coarser_encoder(void **unused)
{
    recording r = record();
    (void)unused;
    for (int i = 0; i < ROWS; i++) {
        double t = 6 * M_PI * i / ROWS + 0.3;
        r.x[i] = 0.1 * rint(2 * sin(t) / 0.1);
        r.f[i] = (cos(t) > 0 ? 2 : -2) + 0.3 * cos(t);
    }
    add_noise(r.f, 0.01, 12);
    assert_law(&r, "coulomb", 2);
}

/* --- the verdict ---------------------------------------------------------------------------- */

/* Two laws, neither a limit of the other, of which one leaves 2 % more, just too much for it alone. */
static void
cannot_tell_laws_that_leave_the_same(void **unused)
{
    char answer[200];
    size_t best;
    candidate c[] = {
        { .name = "null", .law = 1, .left = 1, .fitted = 1, .noise = 1, .rough = 1, .work = 1 },
        { .name = "one", .law = 2, .contains = 1, .left = 2.04e-3, .fitted = 2.04e-3, .noise = 1.34e-3, .rough = 1,
          .work = 1 },
        { .name = "other", .law = 4, .contains = 1, .left = 2e-3, .fitted = 2e-3, .noise = 1.6e-3, .rough = 1,
          .work = 1 },
        { .left = 1 } };
    double block[4][BLOCKS];
    (void)unused;
    for (int i = 0; i < 4; i++) {
        c[i].block = block[i];
        for (int b = 0; b < BLOCKS; b++)
            block[i][b] = c[i].left / BLOCKS * (1 + 0.001 * (b % 2));
    }
    assert_int_equal(ss_verdict_find(answer, sizeof answer, c, 3, 1, &best), SS_UNDECIDED);
    assert_string_equal(answer, "cannot tell: one, other");
    c[2].contains = 3;          /* now one is a limit of the other */
    assert_int_equal(ss_verdict_find(answer, sizeof answer, c, 3, 1, &best), SS_NAMED);
    assert_string_equal(answer, "one explains 0.9980 of the force that was held out, no less than other, and leaves "
                        "1.522 times the noise");
    c[1].left = c[1].fitted = 1;        /* and explains nothing */
    c[1].noise = 1e-3;
    assert_int_equal(ss_verdict_find(answer, sizeof answer, c, 3, 1, &best), SS_NONE_FITS);
    assert_string_equal(answer, "none of these: more than noise is left; other explains 0.9980 of the force that was "
                        "held out, and leaves 2 times the noise");
    assert_true(fabs(c[2].excess - 2) < 1e-9);
    for (int b = 0; b < BLOCKS; b++)    /* two times, but not surely more than 1.5 times */
        block[2][b] = c[2].left / BLOCKS * (b % 2 ? 1.8 : 0.2);
    assert_int_equal(ss_verdict_find(answer, sizeof answer, c, 3, 1, &best), SS_NAMED);
    c[2].left = c[2].fitted = c[2].noise = .3;      /* no more than noise is left, but that is much */
    for (int b = 0; b < BLOCKS; b++)
        block[2][b] = c[2].left / BLOCKS * (1 + 0.001 * (b % 2));
    assert_int_equal(ss_verdict_find(answer, sizeof answer, c, 3, 1, &best), SS_NONE_FITS);
    assert_non_null(strstr(answer, "none of these: too little is explained; other explains 0.7"));
}

/* --- no law --------------------------------------------------------------------------------- */

static void
assert_answer(const recording *r, ss_verdict verdict, const char *words)
{
    ss_motion_ranking *k = rank(r, 0, NULL);
    if (k->verdict != verdict || strstr(k->answer, words) == NULL)
        fail_msg("'%s', not '%s'", k->answer, words);
    ss_motion_ranking_free(k);
}

static void
does_not_judge_what_tells_nothing(void **unused)
{
    recording r = record();
    (void)unused;
    assert_answer(&r, SS_NOT_JUDGED, "the force is constant");
    fill_jenkins(&r);
    double *moved = malloc(ROWS * sizeof *moved);
    assert_non_null(moved);
    memcpy(moved, r.x, ROWS * sizeof *moved);
    for (int i = 0; i < ROWS; i++)
        r.x[i] = 30. * i / ROWS + 0.001 * moved[i];
    assert_answer(&r, SS_NOT_JUDGED, "one direction");
    for (int i = 0; i < ROWS; i++)
        r.x[i] = i < ROWS / 4 ? moved[i] : moved[ROWS / 4];
    assert_answer(&r, SS_NOT_JUDGED, "mostly rest");
    for (int i = 0; i < ROWS; i++)
        r.x[i] = 1;
    assert_answer(&r, SS_NOT_JUDGED, "the motion is constant");
    for (int i = 0; i < ROWS; i++)          /* a law is known only where the half that it is fitted to has been */
        r.x[i] = (i < ROWS / 2 ? 1 : 1.5) * moved[i];
    ss_motion_opts opts;
    ss_motion_opts_init(&opts, sizeof opts);
    opts.folds = SS_FOLDS_HALVES;
    ss_motion_ranking *k = rank(&r, 0, &opts);
    assert_true(k->verdict == SS_NOT_JUDGED && strstr(k->answer, "the two halves visit other ranges") != NULL);
    ss_motion_ranking_free(k);
    free(moved);
    ss_signal_free(r.signal);
}

/* A spring and a damper; noise; and two sliders of other lengths, which none of the laws has. */
static void
names_none_of_these(void **unused)
{
    recording r = record();
    double y = 0, z = 0;
    (void)unused;
    for (int i = 0; i < ROWS; i++)
        r.f[i] = r.x[i] + 0.1 * r.v[i];
    add_noise(r.f, 0.03, 5);
    assert_answer(&r, SS_NONE_FITS, "null");
    memset(r.f, 0, ROWS * sizeof *r.f);
    add_noise(r.f, 1, 6);
    assert_answer(&r, SS_NONE_FITS, "none of these");
    for (int i = 0; i < ROWS; i++) {
        double dx = i > 0 ? r.x[i] - r.x[i - 1] : 0;
        r.f[i] = slider(&y, dx, 0.1) / 0.1 + slider(&z, dx, 2) / 2;
    }
    add_noise(r.f, 0.005, 7);
    assert_answer(&r, SS_NONE_FITS, "times the noise");
    y = z = 0;
    for (int i = 0; i < ROWS; i++) {        /* no passage is like another: the noise is known by its roughness */
        r.x[i] = 3 * pow(0.1, (double)i / ROWS) * sin(12 * M_PI * i / ROWS);
        double dx = i > 0 ? r.x[i] - r.x[i - 1] : 0;
        r.f[i] = slider(&y, dx, 0.1) / 0.1 + slider(&z, dx, 1);
    }
    add_noise(r.f, 0.01, 12);
    assert_answer(&r, SS_NONE_FITS, "times the noise");
    for (int i = 0; i < ROWS; i++) {        /* a spring whose offset drifts: a hysteresis without end makes the drift */
        r.x[i] = sin(2 * M_PI * 7.3 * i / ROWS);
        r.f[i] = 80 * r.x[i] + 50 * cos(2 * M_PI * 7.3 * i / ROWS) + 6.7 * i / ROWS;
    }
    add_noise(r.f, 0.2, 8);
    assert_answer(&r, SS_NONE_FITS, "null");
    for (int i = 0; i < ROWS; i++)          /* a spring with two slopes: a slider behind a gap that hardly slips */
        r.f[i] = (r.x[i] > 0 ? 140 : 70) * r.x[i] + 20 * cos(2 * M_PI * 7.3 * i / ROWS);
    add_noise(r.f, 0.4, 9);
    assert_answer(&r, SS_NONE_FITS, "friction is hardly reached");
    ss_signal_free(r.signal);
}

static void
writes_what_it_found(void **unused)
{
    recording r = record();
    char text[4096];
    (void)unused;
    fill_jenkins(&r);
    add_noise(r.f, 0.03, 1);
    ss_motion_ranking *k = rank(&r, 0, NULL);
    FILE *out = tmpfile();
    assert_non_null(out);
    assert_int_equal(ss_motion_ranking_write(k, out, SS_TSV, NULL), SS_OK);
    rewind(out);
    text[fread(text, 1, sizeof text - 1, out)] = '\0';
    fclose(out);
    assert_non_null(strstr(text, "# answer: compliant explains "));
    assert_non_null(strstr(text, "\n1\tcompliant\t"));
    double left = 0;
    for (int i = ROWS / 10; i < ROWS; i++)
        left += (r.f[i] - k->predicted[i]) * (r.f[i] - k->predicted[i]) / (0.9 * ROWS);
    assert_true(k->rows == ROWS && sqrt(left) < 1.1 * 0.03);
    ss_motion_ranking_free(k);
    ss_signal_free(r.signal);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drives_as_it_simulates),
        cmocka_unit_test(drives_rate_and_state_as_it_simulates),
        cmocka_unit_test(counts_the_values_of_a_converter),
        cmocka_unit_test(leaves_out_rows_about_a_jump),
        cmocka_unit_test(names_an_elastic_slider),
        cmocka_unit_test(names_a_slider_behind_a_gap),
        cmocka_unit_test(finds_sign_velocity_and_delay),
        cmocka_unit_test(finds_a_delay_of_half_a_row),
        cmocka_unit_test(names_dahl),
        cmocka_unit_test(names_rate_and_state_where_the_speed_varies),
        cmocka_unit_test(names_dry_friction),
        cmocka_unit_test(names_dry_friction_read_late),
        cmocka_unit_test(knows_a_converter),
        cmocka_unit_test(names_friction_that_wanders),
        cmocka_unit_test(names_dry_friction_by_a_coarse_encoder),
        cmocka_unit_test(names_a_slider_that_is_uneven),
        cmocka_unit_test(names_dry_friction_that_ends_at_a_turn),
        cmocka_unit_test(names_dry_friction_by_a_coarser_encoder),
        cmocka_unit_test(cannot_tell_laws_that_leave_the_same),
        cmocka_unit_test(does_not_judge_what_tells_nothing),
        cmocka_unit_test(names_none_of_these),
        cmocka_unit_test(writes_what_it_found),
    };
    gsl_set_error_handler_off();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
