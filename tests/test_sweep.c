/* test_sweep.c -- periodic states and their measures against closed forms and other routes.
 *
 * Truth is Den Hartog (1931) for motion without stops, free decay and free oscillation in closed
 * form, the settled numbers of independent programs listed beside the rows, and records of
 * ss_sim_run by rk8pd, which share no code with the way from event to event that is tested here. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <stickslip.h>
#include "study/sweep/grid.h"
#include "shipped.h"
#include "unit.h"
#include "io/record.h"

#define BIT(m) (1u << (m))

/* omega_n = 2 pi, k = Z_e = 1: base_frequency is r, friction is beta. */
static ss_scene
den_hartog(double r, double beta)
{
    ss_scene s = ss_scene_defaults;
    s.model = ss_model_named("coulomb");
    s.mass = 1 / (4 * M_PI * M_PI);
    s.stiffness = s.base_amplitude = 1;
    s.base_frequency = r;
    s.friction = beta;
    return s;
}

static ss_steady
steady_by(const char *method, const ss_scene *scene, unsigned measures, ss_search search)
{
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady out;
    ss_error err = { 0 };
    opts.measures = measures;
    opts.search = search;
    opts.method = method;
    if (ss_steady_find(&out, scene, &opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return out;
}

static ss_steady
steady_of(const ss_scene *scene, unsigned measures, ss_search search)
{
    return steady_by(NULL, scene, measures, search);
}

static void
is_near(double x, double truth, double allow, const char *what)
{
    if (!(fabs(x - truth) <= allow))
        fail_msg("%s: %.15g, not %.15g +- %.1e", what, x, truth, allow);
}

/* --- without stops ------------------------------------------------------------------------- */

static double
den_hartog_amplitude(double r, double beta)
{
    double U = sin(M_PI / r) / (r * (1 + cos(M_PI / r))), V = 1 / (1 - r * r);
    return sqrt(V * V - beta * beta * U * U);
}

/* S as its definition has it, by sampling tau: the sup is reached inside or as tau -> 0, where it
 * is 1. */
static double
den_hartog_limit(double r)
{
    enum { SAMPLES = 20000 };
    double U = sin(M_PI / r) / (r * (1 + cos(M_PI / r))), V = 1 / (1 - r * r), S = 1;
    for (int i = 1; i < SAMPLES; i++) {
        double tau = M_PI * i / SAMPLES;
        S = fmax(S, (r * sin(tau / r) + U * r * r * (cos(tau) - cos(tau / r))) / sin(tau));
    }
    return sqrt(V * V / (U * U + S * S / (r * r * r * r)));
}

static void
gives_den_hartogs_amplitude(void **state)
{
    /* to the digits of programs of their own, and beyond them by the formula */
    static const struct { double r, beta, X; } row[] = {
        { 1.25, 0.5, 1.282557 }, { 0.8, 0.5, 2.332235 }, { 2, 0.3, 0.297676 } };
    (void)state;
    for (size_t i = 0; i < 3; i++)
        is_near(den_hartog_amplitude(row[i].r, row[i].beta), row[i].X, 5e-7, "the formula");
    for (double r = 0.65; r < 2; r += 0.09)
        for (double part = 0.3; part < 1; part += 0.3)
            for (ss_search way = SS_SEARCH_AUTO; way <= SS_SEARCH_SHOOT; way++) {
                double beta = part * den_hartog_limit(r), X = den_hartog_amplitude(r, beta);
                ss_scene s = den_hartog(r, beta);
                ss_steady at = steady_of(&s, BIT(SS_X_MAX) | BIT(SS_AMPLITUDE) | BIT(SS_STOPS)
                                         | BIT(SS_ENERGY) | BIT(SS_PERIOD), way);
                /* the state is within tol of its limit, in units of Z_e; v adds at most 1/r of it;
                 * the last cycle is measured, a little nearer to or farther from it */
                double allow = 4e-9;
                if (at.value[SS_STOPS] != 0 || at.value[SS_PERIOD] != 1)
                    fail_msg("r = %g, beta = %g: %g stops", r, beta, at.value[SS_STOPS]);
                is_near(at.value[SS_X_MAX], X, allow, "max|x|");
                is_near(at.value[SS_AMPLITUDE], X, allow, "amplitude");
                is_near(at.value[SS_ENERGY], 4 * beta * X, 4 * beta * allow, "energy");
            }
}

static void
knows_den_hartogs_limits(void **state)
{
    static const double row[][2] = { { .3, .086407 }, { .4, .143890 }, { .6, .531513 },
        { .8, .817406 }, { 1.1, .746772 }, { 1.25, .698821 }, { 1.5, .646579 }, { 2, .596285 } };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        is_near(den_hartog_limit(row[i][0]), row[i][1], 1e-6, "beta_lim");
}

typedef struct map {
    size_t n_beta, wrong, farther, rows;
    double step;
} map;

/* A point may be on the wrong side of the limit only if it is nearer than a step of the grid. */
static int
compare_with_limit(const ss_sweep_row *row, void *user)
{
    map *m = user;
    double beta = row->vary[1], limit = den_hartog_limit(row->vary[0]);
    m->rows++;
    assert_int_equal(row->index, m->rows - 1);
    assert_string_equal(row->reason, "ok");
    int stops = row->steady.value[SS_STOPS] > 0 || row->steady.value[SS_AMPLITUDE] == 0;
    if (stops != (beta > limit)) {
        m->wrong++;
        m->farther += fabs(beta - limit) > m->step;
    }
    return 0;
}

static void
stops_where_den_hartog_says(void **state)
{
    ss_axis axis[2];
    ss_scene s = den_hartog(1, 1);
    map m = { .step = 0.025 };
    (void)state;
    assert_int_equal(ss_axis_parse(&axis[0], "base_frequency=0.31:2.01:35", NULL), SS_OK);
    assert_int_equal(ss_axis_parse(&axis[1], "friction=0.025:0.975:39", NULL), SS_OK);
    ss_steady_opts how;
    ss_steady_opts_init(&how, sizeof how);
    ss_sweep_opts opts = { .size = sizeof opts, .steady = &how, .axis = axis, .n_axes = 2, .shards = 1,
                           .threads = 2, .sink = compare_with_limit, .user = &m };
    how.search = SS_SEARCH_SHOOT;
    how.measures = BIT(SS_STOPS) | BIT(SS_AMPLITUDE);
    how.max_cycles = 2000;
    assert_int_equal(ss_sweep_run(&s, &opts, NULL), SS_OK);
    assert_int_equal(m.rows, 35 * 39);
    print_message("on the wrong side of the limit: %zu of %zu, farther than a step: %zu\n", m.wrong,
                  m.rows, m.farther);
    assert_int_equal(m.farther, 0);
}

/* --- with stops ---------------------------------------------------------------------------- */

static void
gives_the_settled_numbers(void **state)
{
    /* |x| in stick, max|v| (of samples at 2 kHz, which miss (30/s)^2 h^2 / 8 of it and the last
     * digit given) and the times of events of the Coulomb scene; max|x| and times of the
     * compliant ones, of programs of their own, to the digits given */
    static const struct { const char *name; double x, v, dx, stops, stick, dstick, microslips; }
    row[] = {
        { "coulomb", 3.661076025e-4, 1.067523e-2, 1e-13, 2,
          (0.120289695385 - 0.044012760662) / 0.2, 1e-11, 0 },
        { "compliant-heavy", 3.0391e-4, NAN, 5e-9, 4,
          (119.186 - 47.167 + 132.404 - 126.924) / 200, 1e-5, 1 },
        { "compliant-light", 2.7095e-4, NAN, 5e-9, 4,
          (100.862 - 48.363 + 119.228 - 102.022) / 200, 1e-5, 1 } };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (ss_search way = SS_SEARCH_AUTO; way <= SS_SEARCH_SHOOT; way++) {
            ss_scene s = read_shipped_named(row[i].name);
            ss_steady at = steady_of(&s, BIT(SS_X_MAX) | BIT(SS_V_MAX) | BIT(SS_STOPS)
                                     | BIT(SS_STICK_FRACTION) | BIT(SS_MICROSLIPS), way);
            double tol = 2 * 1e-9 * s.base_amplitude;
            is_near(at.value[SS_X_MAX], row[i].x, row[i].dx + tol, row[i].name);
            if (!isnan(row[i].v))
                is_near(at.value[SS_V_MAX], row[i].v, 3.3e-7, row[i].name);
            is_near(at.value[SS_STICK_FRACTION], row[i].stick, row[i].dstick + 1e-7, row[i].name);
            assert_true(at.value[SS_STOPS] == row[i].stops);
            assert_true(at.value[SS_MICROSLIPS] == row[i].microslips);
        }
}

typedef struct record {
    size_t n;
    double work, v_max, a_max, last_power, last_v, drive, interval;
    double strobe[64][2];
} record;

static int
integrate(const ss_sample *s, size_t n, void *user)
{
    record *r = user;
    for (size_t i = 0; i < n; i++, r->n++) {
        double power = r->drive * s[i].z * s[i].v;
        r->work += r->n > 0 ? (power + r->last_power) / 2 * r->interval : 0;
        r->last_power = power;
        r->v_max = fmax(r->v_max, fabs(s[i].v));
        r->a_max = fmax(r->a_max, fabs(s[i].a));
    }
    return 0;
}

/* What friction takes away in a cycle is what the base puts in, k z v integrated over a record. */
static void
balances_energy(void **state)
{
    static const char *const name[] = { "coulomb", "compliant-heavy", "compliant-light",
                                        "state-variable" };
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        ss_scene s = read_shipped_named(name[i]);
        ss_steady at = steady_of(&s, BIT(SS_ENERGY) | BIT(SS_V_MAX) | BIT(SS_A_MAX), SS_SEARCH_AUTO);
        s.settle = 60 / s.base_frequency;
        s.rate = 40000;
        s.duration = 1 / s.base_frequency + 1 / s.rate;     /* both ends */
        record r = { .drive = s.stiffness, .interval = 1 / s.rate };
        ss_sim_opts opts;
        ss_sim_opts_init(&opts, sizeof opts);
        opts.samples = integrate;
        opts.user = &r;
        assert_int_equal(ss_sim_run(&s, &opts, NULL, NULL), SS_OK);
        /* the trapezoidal rule errs by h^2 / 12 f''; samples miss a maximum by h^2 / 8 of its
         * curvature, and a jump by h times the slope before it: contact at 300 rad/s */
        double h = 1 / s.rate, w = 300;
        is_near(r.work / at.value[SS_ENERGY], 1, h * h * w * w + 2 * h * h * w, name[i]);
        is_near(r.v_max / at.value[SS_V_MAX], 1, h * h * w * w, name[i]);
        is_near(r.a_max / at.value[SS_A_MAX], 1, h * w, name[i]);
        assert_true(r.v_max <= at.value[SS_V_MAX] * (1 + 1e-8));
        assert_true(r.a_max <= at.value[SS_A_MAX] * (1 + 1e-8));
    }
}

static int
keep_strobe(const ss_sample *s, size_t n, void *user)
{
    record *r = user;
    for (size_t i = 0; i < n && r->n < 64; i++, r->n++) {
        r->strobe[r->n][0] = s[i].x;
        r->strobe[r->n][1] = s[i].v;
    }
    return 0;
}

/* A sample a forcing cycle: its distance from the last shrinks by the largest multiplier. */
static void
multipliers_are_the_rate_of_approach(void **state)
{
    static const struct { const char *name; int from; } row[] = { { "coulomb", 25 },
        { "compliant-heavy", 50 }, { "compliant-light", 42 }, { "state-variable", 16 } };
    (void)state;
    for (size_t i = 0; i < 4; i++)
        for (ss_search way = SS_SEARCH_AUTO; way <= SS_SEARCH_SHOOT; way++) {
            ss_scene s = read_shipped_named(row[i].name);
            ss_steady at = steady_of(&s, BIT(SS_FLOQUET) | BIT(SS_FLOQUET_2) | BIT(SS_FLOQUET_ANGLE)
                                     | BIT(SS_X_PHASE) | BIT(SS_V_PHASE), way);
            record r = { 0 };
            ss_sim_opts opts;
            ss_sim_opts_init(&opts, sizeof opts);
            opts.samples = keep_strobe;
            opts.user = &r;
            s.settle = 0;
            s.rate = s.base_frequency;
            s.duration = 64 / s.base_frequency;
            assert_int_equal(ss_sim_run(&s, &opts, NULL, NULL), SS_OK);
            int n = row[i].from;
            double ratio = pow((r.strobe[n + 6][0] - r.strobe[n + 5][0])
                               / (r.strobe[n][0] - r.strobe[n - 1][0]), 1. / 6);
            is_near(at.value[SS_FLOQUET], ratio, 2e-3, row[i].name);
            assert_true(at.value[SS_FLOQUET_ANGLE] == 0);
            assert_true(at.value[SS_FLOQUET_2] < at.value[SS_FLOQUET]);
        }
}

/* Near resonance the largest multiplier is near 1.  Simulation takes thousands of cycles there. */
static void
shooting_ends_a_slow_approach(void **state)
{
    (void)state;
    for (double r = 0.9995; r < 1.001; r += 0.001) {
        double beta = 0.08, X = den_hartog_amplitude(r, beta);
        ss_scene s = den_hartog(r, beta);
        ss_steady_opts opts;
        ss_steady_opts_init(&opts, sizeof opts);
        ss_steady at;
        opts.measures = BIT(SS_AMPLITUDE) | BIT(SS_PERIOD);
        opts.max_cycles = 100;
        opts.search = SS_SEARCH_SIMULATE;
        assert_int_equal(ss_steady_find(&at, &s, &opts, NULL), SS_EDATA);
        opts.search = SS_SEARCH_AUTO;
        assert_int_equal(ss_steady_find(&at, &s, &opts, NULL), SS_OK);
        is_near(at.value[SS_AMPLITUDE], X, 4e-9 * X, "amplitude");
        assert_true(at.value[SS_PERIOD] == 1);
    }
}

/* Friction that falls with speed hardly damps a motion at resonance, whose size is a hundred times that of
 * the base. */
static void
shooting_finds_a_resonance_that_simulation_needs_10000_cycles_for(void **state)
{
    ss_scene s = read_shipped_named("coulomb");
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady at, truth;
    (void)state;
    ss_scene_set_text(&s, "model", "stribeck", NULL);
    s.static_friction = 1.3;
    ss_scene_set(&s, "stribeck_velocity", 0.01, NULL);
    s.friction = 0.1;
    s.base_frequency = 93. / 19;
    opts.measures = BIT(SS_X_PHASE) | BIT(SS_V_PHASE) | BIT(SS_PERIOD);
    opts.max_cycles = 100;
    assert_int_equal(ss_steady_find(&at, &s, &opts, NULL), SS_OK);
    opts.max_cycles = 100000;
    opts.search = SS_SEARCH_SIMULATE;
    assert_int_equal(ss_steady_find(&truth, &s, &opts, NULL), SS_OK);
    is_near(at.value[SS_X_PHASE], truth.value[SS_X_PHASE], 1e-8 * s.base_amplitude, "x_phase");
    is_near(at.value[SS_V_PHASE], truth.value[SS_V_PHASE], 1e-8 * s.base_amplitude * 31, "v_phase");
    assert_true(at.value[SS_PERIOD] == 1 && truth.value[SS_PERIOD] == 1);
}

/* An elastic contact that sticks throughout stays where it is: its motion is that of a second spring and damper. */
static void
shooting_leaves_a_contact_that_sticks_where_it_is(void **state)
{
    ss_scene s = read_shipped_named("compliant-light");
    (void)state;
    s.base_amplitude = 2e-4;
    for (s.base_frequency = 1; s.base_frequency < 20; s.base_frequency *= 2) {
        const ss_steady at = steady_of(&s, BIT(SS_X_MAX) | BIT(SS_AMPLITUDE) | BIT(SS_PERIOD), SS_SEARCH_SHOOT);
        const double w = 2 * M_PI * s.base_frequency;
        const double k = s.stiffness + ss_scene_get(&s, "contact_stiffness");
        const double c = s.damping + ss_scene_get(&s, "contact_damping");
        const double X = s.stiffness * s.base_amplitude / hypot(k - s.mass * w * w, c * w);
        is_near(at.value[SS_X_MAX], X, 4e-9 * X, "x_max");
        is_near(at.value[SS_AMPLITUDE], X, 4e-9 * X, "amplitude");
        assert_true(at.value[SS_PERIOD] == 1);
    }
}

/* Where alpha v is small the friction is theta' = -gamma (theta - c v), c = f_k alpha: the multipliers are
 * exp(lambda T), lambda the roots of l^3 + g l^2 + (k + g c) / m l + g k / m. */
static void
a_linear_friction_has_its_multipliers(void **state)
{
    ss_scene s = read_shipped_named("state-variable");
    const double T = 1 / s.base_frequency, c = 5;
    (void)state;
    for (double g = 10; g < 2e4; g *= 10) {
        double m = s.mass, k = s.stiffness, real = -g;
        ss_scene_set(&s, "gamma", g, NULL);
        ss_scene_set(&s, "alpha", 1e-6, NULL);
        s.friction = c / ss_scene_get(&s, "alpha");
        for (int i = 0; i < 50; i++)
            real -= (((real + g) * real + (k + g * c) / m) * real + g * k / m)
                / ((3 * real + 2 * g) * real + (k + g * c) / m);
        double decay = (g + real) / 2, swing = sqrt(-g * k / m / real - decay * decay);
        for (int i = 0; i < 2; i++) {
            ss_steady at = steady_by(i == 0 ? NULL : "rk8pd", &s, BIT(SS_FLOQUET) | BIT(SS_FLOQUET_2)
                                     | BIT(SS_FLOQUET_ANGLE), SS_SEARCH_AUTO);
            /* in differences what tolerance leaves of a walk, 1e-12 of x, over their size, 1e-4 */
            double most = i == 0 ? 1e-9 : 1e-7;
            is_near(at.value[SS_FLOQUET], exp(-decay * T), most, "modulus");
            is_near(at.value[SS_FLOQUET_2], exp(-decay * T), most, "modulus");
            is_near(cos(at.value[SS_FLOQUET_ANGLE]), cos(swing * T), most, "angle");
        }
    }
}

/* Where friction varies within slip, neighbouring states tell the same multipliers as series do. */
static void
series_have_the_multipliers_of_differences(void **state)
{
    ss_scene s[2] = { read_shipped_named("state-variable"), read_shipped_named("coulomb") };
    int n = 0;
    (void)state;
    ss_scene_set_text(&s[1], "model", "stribeck", NULL);
    ss_scene_set(&s[1], "stribeck_velocity", 0.02, NULL);
    for (int k = 0; k < 2; k++)
        for (double f = 0.2; f < 1; f += 0.25)
            for (double r = 2.1; r < 8; r += 0.9) {
                s[k].friction = f;
                s[k].static_friction = k == 0 ? 0 : 1.05 * f;
                s[k].base_frequency = r;
                unsigned wanted = BIT(SS_FLOQUET) | BIT(SS_FLOQUET_2);
                ss_steady a = steady_of(&s[k], wanted, SS_SEARCH_AUTO);
                ss_steady b = steady_by("rk8pd", &s[k], wanted, SS_SEARCH_AUTO);
                is_near(a.value[SS_FLOQUET], b.value[SS_FLOQUET], 2e-6, "first");
                is_near(a.value[SS_FLOQUET_2], b.value[SS_FLOQUET_2], 2e-6, "second");
                n += a.value[SS_FLOQUET] > 0.01;
            }
    print_message("%d multipliers above 0.01\n", n);
    assert_true(n > 40);
}

/* Non-stop motion: no direction is lost, and the product of the multipliers is that of the two
 * saltations, since an undamped oscillator keeps areas: each multiplies v by a+/a-. */
static void
multipliers_have_the_product_of_the_jumps(void **state)
{
    static const double row[][2] = { { 1.25, 0.5 }, { 0.8, 0.5 }, { 2, 0.3 }, { 1.7, 0.1 } };
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        double r = row[i][0], beta = row[i][1], X = den_hartog_amplitude(r, beta);
        ss_scene s = den_hartog(r, beta);
        ss_steady at = steady_of(&s, BIT(SS_FLOQUET) | BIT(SS_FLOQUET_2), SS_SEARCH_SHOOT);
        /* at x = X: drive - k x -+ beta, where drive = k Z_e cos(phase):
         * from Den Hartog, cos of the phase at the turning point is X / V */
        double force = X * (1 - r * r) - X;
        double factor = (force + beta) / (force - beta);
        is_near(at.value[SS_FLOQUET] * at.value[SS_FLOQUET_2], factor * factor, 1e-7,
                "product of multipliers");
    }
}

/* A released mass loses 4 f_k / k of amplitude a cycle and rests where the spring cannot move
 * it. */
static void
free_decay_ends_where_it_must(void **state)
{
    (void)state;
    for (double x0 = 0.001; x0 < 0.03; x0 += 0.00137) {
        ss_scene s = read_shipped_named("coulomb");
        double zone = s.friction / s.stiffness, x = x0, half = M_PI * sqrt(s.mass / s.stiffness);
        size_t halves = 0;
        s.base_amplitude = 0;
        s.x0 = x0;
        for (; fabs(x) > zone; halves++)
            x = -(x - copysign(2 * zone, x));
        ss_steady at = steady_of(&s, BIT(SS_X_PHASE) | BIT(SS_AMPLITUDE) | BIT(SS_STICK_FRACTION)
                                 | BIT(SS_CYCLES), 0);
        is_near(at.value[SS_X_PHASE], x, 1e-14 * (double)(halves + 1), "rest");
        assert_true(at.value[SS_AMPLITUDE] == 0 && at.value[SS_STICK_FRACTION] == 1);
        /* seen one cycle after the first that begins at rest */
        assert_true(at.value[SS_CYCLES]
                    == ceil((double)halves * half * s.base_frequency) + 1);
    }
}

/* --- periods ------------------------------------------------------------------------------- */

/* Without friction the free oscillation never dies: at r = p it closes after p cycles. */
static void
finds_sub_harmonics(void **state)
{
    (void)state;
    for (int p = 2; p <= 8; p++) {
        ss_scene s = den_hartog(p, 0);
        ss_steady at = steady_of(&s, BIT(SS_PERIOD) | BIT(SS_CYCLES) | BIT(SS_X_MAX), 0);
        assert_true(at.value[SS_PERIOD] == p);
        assert_true(at.value[SS_CYCLES] <= 4 * p);
        /* from rest: (cos(Omega t) - cos(omega_n t)) / (1 - r^2), at most 2 / (r^2 - 1) */
        assert_true(at.value[SS_X_MAX] <= 2.0 / (p * p - 1) * (1 + 1e-12));
        assert_true(at.value[SS_X_MAX] >= 1.0 / (p * p - 1));
    }
}

static void
says_what_has_no_period(void **state)
{
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_scene s = den_hartog(sqrt(2), 0);
    ss_steady at;
    ss_error err = { 0 };
    (void)state;
    opts.measures = BIT(SS_PERIOD) | BIT(SS_CYCLES) | BIT(SS_X_MAX);
    opts.max_cycles = 500;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EDATA);
    assert_string_equal(err.text, "no period up to 8 within 500 cycles");
    assert_true(at.value[SS_PERIOD] == 0 && isnan(at.value[SS_CYCLES]));
    assert_true(at.value[SS_X_MAX] > 0.9 && at.value[SS_X_MAX] <= 2);
    s.friction = 0.3;
    opts.max_period = 1;
    opts.settle = 3;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EDATA);
    assert_string_equal(err.text, "no period up to 1 after 3 cycles");
    opts.settle = 200;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_OK);
    assert_true(at.value[SS_PERIOD] == 1 && at.value[SS_CYCLES] == 200);
}

/* --- without forcing ------------------------------------------------------------------------- */

/* From rest at f_s the spring's force swings about f_k by D sqrt(1 + 1/q^2) = k |U - S| sqrt(1 + q^2) / w,
 * while the surface goes |U - S| T on. */
static void
a_pulled_slider_has_its_closed_form(void **state)
{
    static const double row[][2] = { { 42e-6, 0 }, { -42e-6, 0 }, { 0, -42e-6 }, { 0, 42e-6 }, { 1e-3, 1e-3 - 42e-6 } };
    const double slip = .042640172992, stick = 4.251700680272, T = slip + stick, speed = 42e-6;
    (void)state;
    for (size_t i = 0; i < 5; i++)
        for (ss_search way = SS_SEARCH_AUTO; way <= SS_SEARCH_SHOOT; way++) {
            double U = row[i][0], S = row[i][1];
            ss_scene s = read_slider(U, S);
            double w = sqrt(s.stiffness / s.mass), q = .015 * w / (s.stiffness * speed), root = sqrt(1 + q * q);
            ss_steady at = steady_of(&s, BIT(SS_CYCLE_TIME) | BIT(SS_STICK_FRACTION) | BIT(SS_V_MAX)
                                     | BIT(SS_ENERGY) | BIT(SS_PERIOD) | BIT(SS_STOPS) | BIT(SS_X_PHASE)
                                     | BIT(SS_V_PHASE) | BIT(SS_FLOQUET) | BIT(SS_FLOQUET_2), way);
            is_near(at.value[SS_CYCLE_TIME], T, 2e-12, "cycle_time");
            is_near(at.value[SS_STICK_FRACTION], stick / T, 1e-12, "stick");
            is_near(at.value[SS_V_MAX], fabs(U + copysign(speed * root, U - S)), 1e-9 * speed * root, "v_max");
            is_near(at.value[SS_ENERGY], s.friction * speed * T, 1e-11 * s.friction * speed * T, "energy");
            is_near(at.value[SS_X_PHASE], -copysign(.0302 / s.stiffness, U - S), 1e-14, "x_phase");
            is_near(at.value[SS_V_PHASE], S, 0, "v_phase");
            is_near(at.value[SS_FLOQUET], 0, 0, "floquet");
            assert_true(at.value[SS_PERIOD] == 1 && at.value[SS_STOPS] == 1);
            at = steady_of(&s, BIT(SS_AMPLITUDE), way);
            is_near(at.value[SS_AMPLITUDE], speed * root / w, 1e-9 * speed * root / w, "amplitude");
        }
}

/* See a_falling_friction_cycles_as_published in test_rigs.c. */
static void
a_falling_friction_has_its_published_period(void **state)
{
    (void)state;
    for (int pull = 0; pull < 2; pull++) {
        ss_scene s = ss_scene_defaults;
        s.model = ss_model_named("stribeck");
        s.mass = s.stiffness = s.static_friction = 1;
        s.friction = 0;
        ss_scene_set(&s, "stribeck_velocity", 1. / 3, NULL);
        s.surface_velocity = pull ? 0 : .2;
        s.base_velocity = pull ? -.2 : 0;
        for (ss_search way = SS_SEARCH_AUTO; way <= SS_SEARCH_SHOOT; way++) {
            ss_steady at = steady_of(&s, BIT(SS_CYCLE_TIME) | BIT(SS_STICK_FRACTION) | BIT(SS_PERIOD)
                                     | BIT(SS_FLOQUET), way);
            is_near(at.value[SS_CYCLE_TIME], 12.001031294831, 1e-11, "cycle_time");
            is_near(at.value[SS_STICK_FRACTION] * at.value[SS_CYCLE_TIME], 7.705031769350, 1e-11, "stick");
            is_near(at.value[SS_FLOQUET], 0, 0, "floquet");
            assert_true(at.value[SS_PERIOD] == 1);
        }
    }
}

typedef struct onsets {
    double U, t[256], x[256];           /* x - U t */
    size_t n;
} onsets;

static int
keep_onsets(const ss_event *event, void *user)
{
    onsets *o = user;
    if (event->kind == SS_STICK && o->n < 256) {
        o->t[o->n] = event->t;
        o->x[o->n++] = event->x - o->U * event->t;
    }
    return 0;
}

static onsets
onsets_of(ss_scene s, double duration)
{
    onsets o = { .U = s.base_velocity };
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    opts.method = "taylor";
    opts.tol = 1e-14;
    opts.events = keep_onsets;
    opts.user = &o;
    s.settle = 0;
    s.duration = duration;
    s.rate = 1;
    assert_int_equal(ss_sim_run(&s, &opts, NULL, NULL), SS_OK);
    assert_true(o.n > 4);
    return o;
}

static void
a_damped_slider_sticks_as_its_record_does(void **state)
{
    (void)state;
    for (double d = .05; d < .5; d += .1)
        for (int belt = 0; belt < 2; belt++) {
            ss_scene s = read_slider(belt ? 0 : 1e-3, belt ? -1e-3 : 0);
            s.damping = d;
            onsets o = onsets_of(s, 4);
            ss_steady at = steady_of(&s, BIT(SS_CYCLE_TIME) | BIT(SS_X_PHASE) | BIT(SS_PERIOD), 0);
            /* what the record's tolerance leaves of f_s / k, 1e-12 of it, is 4e-13 s of the pull */
            is_near(at.value[SS_CYCLE_TIME], o.t[o.n - 1] - o.t[o.n - 2], 1e-11, "cycle_time");
            is_near(at.value[SS_X_PHASE], o.x[o.n - 1], 1e-11 * .0602 / 168, "x_phase");
            assert_true(at.value[SS_PERIOD] == 1);
        }
}

/* Whatever slips begin with, by another way: each stick that a record begins with lasts until the force is
 * f_s, and from there on all records are one, so that nothing is left of a difference. */
static void
a_true_stick_forgets_every_difference(void **state)
{
    static const char *const method[] = { "exact", "taylor", "rk8pd", "msadams" };
    (void)state;
    for (int i = 0; i < 8; i++) {
        ss_scene s = read_slider(i & 1 ? 0 : 1e-3, i & 1 ? -1e-3 : 0);
        s.model = ss_model_named(i & 2 ? "stribeck" : "coulomb");
        ss_scene_set(&s, "stribeck_velocity", .01, NULL);
        s.damping = i & 4 ? .1 : 0;
        onsets first = onsets_of(s, 4);
        for (int start = 0; start < 3; start++) {
            s.x0 = (start - 1) * 2e-4;
            s.v0 = s.surface_velocity + start * 3e-3;
            onsets o = onsets_of(s, 4);
            is_near(o.x[3], first.x[3], 1e-11 * .0602 / 168, "x of an onset");
            is_near(o.t[3] - o.t[2], first.t[3] - first.t[2], 1e-11, "time between onsets");
        }
        for (int m = i & 2 ? 1 : 0; m < (i & 2 ? 2 : 4); m++)
            for (ss_search way = SS_SEARCH_AUTO; way <= SS_SEARCH_SHOOT; way++) {
                ss_steady_opts opts;
                ss_steady_opts_init(&opts, sizeof opts);
                ss_steady at;
                ss_error err = { 0 };
                opts.method = method[m];
                opts.search = way;
                opts.measures = BIT(SS_CYCLE_TIME) | BIT(SS_X_PHASE) | BIT(SS_FLOQUET)
                    | BIT(SS_FLOQUET_2) | BIT(SS_LYAPUNOV);
                assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_OK);
                assert_true(at.value[SS_FLOQUET] == 0 && at.value[SS_FLOQUET_2] == 0);
                assert_true(at.value[SS_LYAPUNOV] == -INFINITY);
                is_near(at.value[SS_CYCLE_TIME], first.t[3] - first.t[2], 2e-9, "cycle_time");
                is_near(at.value[SS_X_PHASE], first.x[3], 2e-9 * .0602 / 168, "x_phase");
            }
    }
}

/* An elastic contact still rings when it slips again, so slips begin unlike: the distance of an onset from
 * its limit shrinks by the multiplier, here on either side of it in turn. */
static void
a_slider_on_a_contact_comes_nearer_by_its_multiplier(void **state)
{
    static const struct { double U, damping; size_t from; } row[] = { { 42e-6, .1, 9 }, { 1e-4, .2, 20 } };
    (void)state;
    for (size_t i = 0; i < 2; i++)
        for (ss_search way = SS_SEARCH_AUTO; way <= SS_SEARCH_SHOOT; way++) {
            ss_scene s = read_slider(row[i].U, 0);
            ss_scene_set_text(&s, "model", "compliant", NULL);
            ss_scene_set(&s, "contact_stiffness", 20000, NULL);
            ss_scene_set(&s, "contact_damping", row[i].damping, NULL);
            ss_steady at = steady_of(&s, BIT(SS_CYCLE_TIME) | BIT(SS_FLOQUET) | BIT(SS_FLOQUET_2)
                                     | BIT(SS_FLOQUET_ANGLE) | BIT(SS_X_PHASE) | BIT(SS_PERIOD), way);
            onsets o = onsets_of(s, 60 * at.value[SS_CYCLE_TIME]);
            size_t k = row[i].from, last = o.n - 1;
            double allow = (way == SS_SEARCH_SIMULATE ? 1e-9 : 1e-11) * .0602 / 168;
            is_near(at.value[SS_X_PHASE], o.x[last], allow, "x_phase");
            is_near(at.value[SS_CYCLE_TIME], o.t[last] - o.t[last - 1], 2 * allow / row[i].U, "cycle_time");
            /* x is known to 1e-16 m, and differs there by 1e-11 */
            is_near(at.value[SS_FLOQUET], -(o.x[k + 1] - o.x[k]) / (o.x[k] - o.x[k - 1]), 2e-5, "floquet");
            is_near(at.value[SS_FLOQUET_ANGLE], M_PI, 0, "floquet_angle");
            assert_true(at.value[SS_PERIOD] == 1 && at.value[SS_FLOQUET_2] == 0);
        }
}

/* Where the symmetry of a motion with two stops has just broken, a pair of motions lies side by side, and
 * the start decides which is approached: as simulation alone finds, from starts all over the plane. */
static void
finds_the_one_of_two_close_motions_that_is_approached(void **state)
{
    static const double r[] = { .462, .465, .47, .478 };
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        size_t of_a_pair[2] = { 0 };
        ss_scene s = read_shipped_named("shaw");
        s.base_frequency = r[i];
        for (int x = -22; x <= 22; x++)
            for (int v = -3; v <= 3; v += 2) {
                s.x0 = x / 10.;
                s.v0 = v;
                double truth = steady_of(&s, BIT(SS_X_PHASE), SS_SEARCH_SIMULATE).value[SS_X_PHASE];
                is_near(steady_of(&s, BIT(SS_X_PHASE), SS_SEARCH_AUTO).value[SS_X_PHASE], truth, 1e-8, "x_phase");
                of_a_pair[truth > 1.32]++;
            }
        assert_true(of_a_pair[0] > 0 && of_a_pair[1] > 0);
    }
}

static void
says_what_has_no_cycle(void **state)
{
    static const struct { double U, frequency, d; ss_status status; const char *why; } row[] = {
        { 0, 0, 0, SS_EINVAL, "base_frequency is 0 and base_velocity is surface_velocity: nothing keeps it "
          "moving" },
        { 0.1, 0, .2, SS_EDATA, "it slides on: no stick within" } };
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady at;
    ss_error err = { 0 };
    (void)state;
    opts.measures = BIT(SS_PERIOD) | BIT(SS_CYCLE_TIME);
    for (size_t i = 0; i < 2; i++) {
        ss_scene s = read_slider(row[i].U, 0);
        s.damping = row[i].d;
        assert_int_equal(ss_steady_find(&at, &s, &opts, &err), row[i].status);
        assert_ptr_equal(strstr(err.text, row[i].why), err.text);
        assert_true(isnan(at.value[SS_PERIOD]) && isnan(at.value[SS_CYCLE_TIME]));
    }
    ss_scene s = read_shipped_named("state-variable");
    is_near(steady_of(&s, BIT(SS_CYCLE_TIME), 0).value[SS_CYCLE_TIME], 1 / s.base_frequency,
            1e-14, "cycle_time");
    opts.method = "rk8pd";
    opts.search = SS_SEARCH_SHOOT;
    ss_scene slider = read_slider(.1, 0);
    ss_scene_set_text(&slider, "model", "compliant", NULL);
    ss_scene_set(&slider, "contact_stiffness", 20000, NULL);
    assert_int_equal(ss_steady_find(&at, &slider, &opts, &err), SS_EINVAL);
    assert_string_equal(err.text, "base_frequency is 0: without forcing, shooting, multipliers and exponents of "
                        "model compliant need method exact");
    ss_steady_opts_init(&opts, sizeof opts);
    s.base_frequency = s.base_amplitude = 0;
    s.base_velocity = .1;
    s.damping = 1;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EDATA);
    assert_ptr_equal(strstr(err.text, "it slides on with the pull: no cycle within"), err.text);
}

/* --- pulled, without a stick ---------------------------------------------------------------- */

/* A LuGre slider by Runge's and Kutta's method, with no code of the library: x - U t, v, z in steps that end where
 * v is 0, at the kink, and where v falls below .99 U after it was above 1.01 U. */
typedef struct bristles {
    double m, k, f_k, f_s, s_0, s_1, s_2, v_s, U;
    double at[3], t;
    int way, was_faster;
} bristles;

static void
bristle_rates(const bristles *b, const double y[3], double rate[3])
{
    double w = y[1] / b->v_s, g = b->f_k + (b->f_s - b->f_k) * exp(-w * w);
    rate[0] = y[1] - b->U;
    rate[2] = y[1] - b->s_0 * b->way * y[1] * y[2] / g;
    rate[1] = (-b->k * y[0] - b->s_0 * y[2] - b->s_1 * rate[2] - b->s_2 * y[1]) / b->m;
}

static bristles
bristles_after(const bristles *from, double h)
{
    static const double part[] = { 0, .5, .5, 1 }, weight[] = { 1, 2, 2, 1 };
    bristles to = *from;
    double rate[3] = { 0 };
    for (int k = 0; k < 4; k++) {
        double y[3];
        for (int i = 0; i < 3; i++)
            y[i] = from->at[i] + part[k] * h * rate[i];
        bristle_rates(from, y, rate);
        for (int i = 0; i < 3; i++)
            to.at[i] += h / 6 * weight[k] * rate[i];
    }
    to.t += h;
    return to;
}

static void
bristles_to_section(bristles *b)
{
    for (;;) {
        const double h = 5e-4, level = .99 * b->U;
        bristles to = bristles_after(b, h);
        int falls = b->was_faster && to.at[1] <= level, turns = to.at[1] * b->way < 0;
        if (falls || turns) {
            double lo = 0, hi = h, border = falls ? level : 0, side = falls ? 1 : b->way;
            for (int i = 0; i < 50; i++) {
                double middle = (lo + hi) / 2;
                *((bristles_after(b, middle).at[1] - border) * side > 0 ? &lo : &hi) = middle;
            }
            to = bristles_after(b, hi);
            to.at[1] = border;
        }
        *b = to;
        b->way = turns && !falls ? -b->way : b->way;
        b->was_faster = !falls && (b->was_faster || b->at[1] > 1.01 * b->U);
        if (falls)
            return;
    }
}

static ss_scene
scene_of_bristles(const bristles *b)
{
    ss_scene s = read_shipped_named("lugre");
    const struct { const char *key; double value; } set[] = {
        { "bristle_stiffness", b->s_0 }, { "bristle_damping", b->s_1 }, { "viscous_friction", b->s_2 },
        { "stribeck_velocity", b->v_s }, { "base_velocity", b->U } };
    for (size_t k = 0; k < sizeof set / sizeof *set; k++)
        assert_int_equal(ss_scene_set(&s, set[k].key, set[k].value, NULL), SS_OK);
    return s;
}

static void
bristles_have_the_cycles_of_runge_and_kutta(void **state)
{
    static const struct { double v_s, U; int period; } row[] = {
        { .05, .05, 1 }, { .5, .05, 1 }, { .5, .25, 1 }, { .2, .45, 1 }, { .2, .25, 2 }, { .2, .65, 2 },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        bristles b = { 1, 2, 1, 1.5, 50, 1, .1, row[i].v_s, row[i].U, { 0 }, 0, 1, 0 };
        ss_scene s = scene_of_bristles(&b);
        for (int n = 0; n < 300; n++)
            bristles_to_section(&b);

        /* a period, and the derivative of its map by x and z */
        bristles start = b;
        double d[2][2], nearest = INFINITY;
        const unsigned all = BIT(SS_CYCLE_TIME) | BIT(SS_PERIOD) | BIT(SS_X_PHASE) | BIT(SS_V_PHASE)
            | BIT(SS_FLOQUET) | BIT(SS_FLOQUET_2);
        const ss_steady at = steady_of(&s, all, SS_SEARCH_AUTO);
        assert_true(at.value[SS_PERIOD] == row[i].period);
        for (int n = 0; n < row[i].period; n++) {
            bristles_to_section(&b);
            nearest = fmin(nearest, fabs(at.value[SS_X_PHASE] - b.at[0]));
        }
        is_near(at.value[SS_CYCLE_TIME] * row[i].period, b.t - start.t, 1e-8, "cycle_time");
        is_near(nearest, 0, 1e-8, "x_phase");
        is_near(at.value[SS_V_PHASE], .99 * b.U, 1e-14, "v_phase");
        for (int j = 0; j < 2; j++) {
            const double by = 1e-5 / (j == 0 ? 1 : b.s_0);
            bristles up = start, down = start;
            up.at[2 * j] += by;
            down.at[2 * j] -= by;
            for (int n = 0; n < row[i].period; n++) {
                bristles_to_section(&up);
                bristles_to_section(&down);
            }
            for (int k = 0; k < 2; k++)
                d[k][j] = (up.at[2 * k] - down.at[2 * k]) / (2 * by);
        }
        double half = (d[0][0] + d[1][1]) / 2, root = sqrt(half * half - (d[0][0] * d[1][1] - d[0][1] * d[1][0]));
        /* by differences of 1e-4 f_s/k, over which the map bends a little */
        is_near(at.value[SS_FLOQUET], fabs(half) + root, 3e-4 * (fabs(half) + root), "floquet");
        is_near(at.value[SS_FLOQUET_2], fabs(fabs(half) - root), 1e-7, "floquet2");

        /* on a belt that moves the other way */
        s.surface_velocity = -s.base_velocity;
        s.base_velocity = 0;
        const ss_steady belt = steady_of(&s, BIT(SS_CYCLE_TIME), SS_SEARCH_SHOOT);
        is_near(belt.value[SS_CYCLE_TIME], at.value[SS_CYCLE_TIME], 1e-8, "cycle_time on a belt");
    }
}

/* Where they are chaotic, neighbours separate at the rate at which two sliders of Runge and Kutta do, whose
 * difference is drawn together after each cycle. */
static void
bristles_have_the_exponent_of_two_sliders(void **state)
{
    enum { CYCLES = 500 };
    const double apart = 1e-7;
    bristles b = { 1, 2, 1, 1.5, 50, 1, .1, .2, .05, { 0 }, 0, 1, 0 };
    ss_scene s = scene_of_bristles(&b);
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady at;
    ss_error err;
    double x = apart, z = 0, log_of_all = 0;
    (void)state;
    for (int n = 0; n < 20; n++)
        bristles_to_section(&b);
    const double begun = b.t;
    for (int n = 0; n < CYCLES; n++) {
        bristles beside = b;
        beside.at[0] += x;
        beside.at[2] += z;
        bristles_to_section(&beside);
        bristles_to_section(&b);
        double dx = beside.at[0] - b.at[0], dz = beside.at[2] - b.at[2], far = hypot(dx, b.s_0 * dz / b.k);
        log_of_all += log(far / apart);
        x = dx * apart / far;
        z = dz * apart / far;
    }
    opts.measures = BIT(SS_LYAPUNOV) | BIT(SS_LYAPUNOV_ERROR);
    opts.max_cycles = 2 * CYCLES;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EDATA);
    const double truth = log_of_all / (b.t - begun), error = at.value[SS_LYAPUNOV_ERROR];
    print_message("%g +- %g, of two %g\n", at.value[SS_LYAPUNOV], error, truth);
    assert_true(truth > 10 * error);
    is_near(at.value[SS_LYAPUNOV], truth, 4 * sqrt(1 + 2) * error, "exponent");     /* of 1000 cycles, and of 500 */
}

/* Without damping and with friction that does not fall, a slider swings about its steady slide as a free one. */
static void
a_slide_without_damping_swings_freely(void **state)
{
    static const char *const name[] = { "dahl", "state-variable" };
    (void)state;
    for (int i = 0; i < 2; i++) {
        ss_scene s = read_shipped_named(name[i]);
        s.base_frequency = s.base_amplitude = 0;
        s.base_velocity = .05;
        ss_steady at = steady_of(&s, BIT(SS_CYCLE_TIME) | BIT(SS_FLOQUET), SS_SEARCH_AUTO);
        is_near(at.value[SS_CYCLE_TIME], 2 * M_PI * sqrt(s.mass / s.stiffness), 1e-11, "cycle_time");
        is_near(at.value[SS_FLOQUET], 1, 1e-7, "floquet");
    }
}

/* Every method comes to the same motion. */
static void
methods_agree(void **state)
{
    static const char *const name[] = { "coulomb", "compliant-heavy", "compliant-light" };
    const unsigned measures = (BIT(SS_PERIOD) << 1) - 1;
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        ss_scene s = read_shipped_named(name[i]);
        ss_steady_opts opts;
        ss_steady_opts_init(&opts, sizeof opts);
        ss_steady by_steps, exact = steady_of(&s, measures, 0);
        opts.measures = measures;
        opts.method = "rk8pd";
        assert_int_equal(ss_steady_find(&by_steps, &s, &opts, NULL), SS_OK);
        for (int m = 0; m <= SS_PERIOD; m++)
            is_near(by_steps.value[m], exact.value[m], 1e-8 * fabs(exact.value[m]),
                    ss_measure_label((ss_measure)m)->name);
    }
}

/* In microstick the contact rings at sqrt((k + K_y)/m - s^2); the base, slow, shifts the extrema of
 * a by little. */
static void
hears_the_transition_frequency(void **state)
{
    static const char *const name[] = { "compliant-heavy", "compliant-light" };
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        ss_scene s = read_shipped_named(name[i]);
        double decay = ss_scene_get(&s, "contact_damping") / (2 * s.mass);
        double f = sqrt((s.stiffness + ss_scene_get(&s, "contact_stiffness")) / s.mass - decay * decay) / (2 * M_PI);
        ss_steady at = steady_of(&s, BIT(SS_TRANSITION), 0);
        is_near(at.value[SS_TRANSITION] / f, 1, 2e-4, name[i]);
    }
    ss_scene s = read_shipped_named("compliant-light");
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady at;
    ss_error err = { 0 };
    opts.measures = BIT(SS_TRANSITION);
    ss_scene_set(&s, "contact_damping", 3000, NULL);                   /* beyond critical: nothing rings */
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EDATA);
    assert_string_equal(err.text, "transition: no oscillation, a has no three extrema in one");
    assert_true(isnan(at.value[SS_TRANSITION]));
}

/* --- extremes ------------------------------------------------------------------------------ */

static void
every_value_is_there_or_the_status_says_why(void **state)
{
    static const double scale[] = { 0, 1e-9, 1e-3, 0.5, 0.99, 1, 1.01, 2, 30, 1e3, 1e6 };
    static const char *const key[] = { "friction", "base_frequency", "stiffness", "mass",
        "base_amplitude", "contact_stiffness", "contact_damping", "x0", "v0" };
    static const char *const name[] = { "coulomb", "compliant-light" };
    size_t good = 0, bad = 0;
    (void)state;
    for (size_t i = 0; i < 2; i++)
        for (size_t k = 0; k < sizeof key / sizeof *key; k++)
            for (size_t j = 0; j < sizeof scale / sizeof *scale; j++)
                for (ss_search way = SS_SEARCH_AUTO; way <= SS_SEARCH_SHOOT; way++) {
                    ss_scene s = read_shipped_named(name[i]);
                    ss_error err = { 0 };
                    ss_steady at;
                    ss_steady_opts opts = { .size = sizeof opts, .measures = BIT(SS_PERIOD) * 2 - 1, .tol = 1e-6,
                        .max_period = 4, .max_cycles = 100,
                        .search = way, .max_steps = 5000 };
                    double x = ss_scene_get(&s, key[k]);
                    if (isnan(x))
                        continue;
                    ss_scene_set(&s, key[k], (x != 0 ? x : 1e-3) * scale[j], NULL);
                    ss_status st = ss_steady_find(&at, &s, &opts, &err);
                    for (int m = 0; m <= SS_PERIOD && st == SS_OK; m++)
                        if (!isfinite(at.value[m]))
                            fail_msg("%s, %s x %g: %s is %g", name[i], key[k], scale[j],
                                     ss_measure_label((ss_measure)m)->name, at.value[m]);
                    assert_true(st == SS_OK || err.text[0] != '\0');
                    good += st == SS_OK;
                    bad += st != SS_OK;
                }
    print_message("%zu points with all values, %zu with a reason\n", good, bad);
    assert_true(good > bad);
}

static void
refuses_what_cannot_be_measured(void **state)
{
    ss_error err = { 0 };
    ss_steady at;
    ss_scene s = read_shipped_named("state-variable");
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    (void)state;
    opts.measures = BIT(SS_STOPS);
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EINVAL);
    opts.measures = BIT(SS_CYCLES);
    opts.search = SS_SEARCH_SHOOT;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EINVAL);
    opts.measures = BIT(SS_AMPLITUDE);
    opts.search = (ss_search)(SS_SEARCH_SHOOT + 1);
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EINVAL);
    opts.search = SS_SEARCH_AUTO;
    opts.method = "exact";
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EINVAL);
    ss_steady_opts_init(&opts, sizeof opts);
    opts.tol = NAN;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EINVAL);
    opts.tol = 1e-9;
    opts.max_period = SS_PERIOD_MAX + 1;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EINVAL);
    ss_steady_opts_init(&opts, sizeof opts);
    s = read_shipped_named("coulomb");
    s.base_frequency = 0;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EINVAL);
    s.base_frequency = NAN;
    assert_int_equal(ss_steady_find(&at, &s, &opts, &err), SS_EINVAL);
}

/* --- grids --------------------------------------------------------------------------------- */

static double
value_at(const ss_axis *axis, size_t i)
{
    double value;
    ss_sweep_values(&(ss_sweep_opts){ .axis = axis, .n_axes = 1 }, i, &value);
    return value;
}

static void
reads_axes(void **state)
{
    static const char *const bad[] = { "", "x0", "x0=", "x0=1:2", "x0=1:2:", "x0=1:2:0", "x0=1:2:x",
        "x0=1:2:3:lin", "=1:2:3", "x0=0:1:3:log", "x0=1:inf:3", "x0=nan:1:3", "x0=1:2:-3",
        "x0=1:2:3:log:", "a-key-that-is-longer-than-any-that-there-is=1:2:3" };
    ss_axis axis;
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(ss_axis_parse(&axis, bad[i], NULL), SS_EINVAL);
    assert_int_equal(ss_axis_parse(&axis, "x0=-1:2:4", NULL), SS_OK);
    for (int i = 0; i < 4; i++)
        assert_true(value_at(&axis, (size_t)i) == i - 1);
    assert_int_equal(ss_axis_parse(&axis, "x0=1e-3:10:5:log", NULL), SS_OK);
    for (int i = 0; i < 5; i++)
        is_near(value_at(&axis, (size_t)i), pow(10, i - 3), 1e-15 * pow(10, i - 3), "decade");
    assert_int_equal(ss_axis_parse(&axis, "x0=7:8:1", NULL), SS_OK);
    assert_true(value_at(&axis, 0) == 7);
}

/* A value that is a decimal of few digits is what a reader of these digits has; others stay as they are. */
static void
round_values_are_round(void **state)
{
    static const struct {
        const char *axis, *values;
    } round[] = {
        { "x0=0.1:1.3:13", "0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1 1.1 1.2 1.3" },
        { "x0=-0.3:0.6:10", "-0.3 -0.2 -0.1 0 0.1 0.2 0.3 0.4 0.5 0.6" },
        { "x0=1e3:1e9:7:log", "1e3 1e4 1e5 1e6 1e7 1e8 1e9" },
        { "x0=2e8:2e-12:21:log", "2e8 2e7 2e6 2e5 2e4 2e3 2e2 20 2 .2 .02 2e-3 2e-4 2e-5 2e-6 2e-7 2e-8 2e-9 "
          "2e-10 2e-11 2e-12" },
        { "x0=-3e300:-1e300:5", "-3e300 -2.5e300 -2e300 -1.5e300 -1e300" },
        { "x0=1e-300:1e300:3:log", "1e-300 1 1e300" },
        { "x0=1:1.000000000001:3", "1 1.0000000000005 1.000000000001" },
    };
    ss_axis axis;
    (void)state;
    for (size_t k = 0; k < sizeof round / sizeof *round; k++) {
        const char *value = round[k].values;
        char *end;
        assert_int_equal(ss_axis_parse(&axis, round[k].axis, NULL), SS_OK);
        for (size_t i = 0; i < axis.n; i++, value = end) {
            double truth = strtod(value, &end);
            if (value_at(&axis, i) != truth)
                fail_msg("%s: value %zu is %.17g, not %.17g", round[k].axis, i, value_at(&axis, i), truth);
        }
    }
    assert_int_equal(ss_axis_parse(&axis, "x0=0:1:4", NULL), SS_OK);
    assert_true(fabs(value_at(&axis, 1) - 1. / 3) <= 1e-16 && fabs(value_at(&axis, 2) - 2. / 3) <= 2e-16);
}

typedef struct seen {
    size_t n, index[64], stop_at;
    double vary[64][2], amplitude[64];
} seen;

static int
see(const ss_sweep_row *row, void *user)
{
    seen *s = user;
    s->index[s->n] = row->index;
    memcpy(s->vary[s->n], row->vary, sizeof s->vary[0]);
    s->amplitude[s->n++] = row->steady.value[SS_AMPLITUDE];
    return s->n == s->stop_at;
}

static void
shards_threads_and_starts_give_the_same_rows(void **state)
{
    ss_axis axis[2];
    ss_scene s = read_shipped_named("coulomb");
    seen whole = { 0 }, part;
    (void)state;
    assert_int_equal(ss_axis_parse(&axis[0], "friction=0.8:1.2:5", NULL), SS_OK);
    assert_int_equal(ss_axis_parse(&axis[1], "mass=2:3:8", NULL), SS_OK);
    ss_steady_opts how;
    ss_steady_opts_init(&how, sizeof how);
    ss_sweep_opts opts = { .size = sizeof opts, .steady = &how, .axis = axis, .n_axes = 2, .shards = 1,
                           .threads = 1, .sink = see, .user = &whole };
    how.measures = BIT(SS_AMPLITUDE);
    assert_int_equal(ss_sweep_run(&s, &opts, NULL), SS_OK);
    assert_int_equal(whole.n, 40);
    assert_true(fabs(whole.vary[9][0] - 0.9) < 1e-15 && fabs(whole.vary[9][1] - 15. / 7) < 1e-15);
    opts.user = &part;
    for (opts.shards = 1; opts.shards < 50; opts.shards += 6)
        for (opts.shard = 0; opts.shard < opts.shards; opts.shard++)
            for (opts.first = 0; opts.first < 3; opts.first++) {
                part = (seen){ 0 };
                opts.threads = 1 + (int)(opts.shard % 5);
                assert_int_equal(ss_sweep_run(&s, &opts, NULL), SS_OK);
                for (size_t i = 0; i < part.n; i++) {
                    size_t index = opts.shard + (opts.first + i) * opts.shards;
                    assert_int_equal(part.index[i], index);
                    assert_true(part.amplitude[i] == whole.amplitude[index]);
                    assert_memory_equal(part.vary[i], whole.vary[index], sizeof part.vary[i]);
                }
                size_t points = opts.shard < 40 ? (39 - opts.shard) / opts.shards + 1 : 0;
                assert_int_equal(part.n, points > opts.first ? points - opts.first : 0);
            }
    opts.shards = 1;
    opts.shard = opts.first = 0;
    part = (seen){ .stop_at = 7 };
    opts.threads = 3;
    assert_int_equal(ss_sweep_run(&s, &opts, NULL), SS_STOP);
    assert_int_equal(part.n, 7);
    opts.shard = 1;
    assert_int_equal(ss_sweep_run(&s, &opts, NULL), SS_EINVAL);
}

static void
refuses_grids_that_mean_nothing(void **state)
{
    static const char *const bad[] = { "alpha=1:2:3", "model=1:2:3", "rate=1:2:3", "nonsense=1:2:3",
                                       "mass=1:2:3" };
    ss_axis axis[3];
    ss_scene s = read_shipped_named("coulomb");
    ss_steady_opts how;
    ss_steady_opts_init(&how, sizeof how);
    ss_sweep_opts opts = { .size = sizeof opts, .steady = &how, .axis = axis, .n_axes = 2, .shards = 1,
                           .threads = 1, .sink = see };
    size_t n;
    (void)state;
    assert_int_equal(ss_axis_parse(&axis[0], "mass=1:2:3", NULL), SS_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(ss_axis_parse(&axis[1], bad[i], NULL), SS_OK);
        assert_int_equal(ss_sweep_run(&s, &opts, NULL), SS_EINVAL);
    }
    assert_int_equal(ss_axis_parse(&axis[0], "mass=1:2:4000000000", NULL), SS_OK);
    assert_int_equal(ss_axis_parse(&axis[1], "x0=1:2:4000000000", NULL), SS_OK);
    assert_int_equal(ss_axis_parse(&axis[2], "v0=1:2:4000000000", NULL), SS_OK);
    opts.n_axes = 3;
    assert_int_equal(ss_sweep_points(&opts, &n, NULL), SS_EINVAL);
    opts.n_axes = 0;
    assert_int_equal(ss_sweep_points(&opts, &n, NULL), SS_OK);
    assert_int_equal(n, 1);
}

static ss_status
read_text(ss_table **table, const char *text, ss_error *err)
{
    FILE *in = tmpfile();
    fputs(text, in);
    rewind(in);
    ss_status st = ss_table_read(table, in, "a.tsv", SS_KIND_SWEEP, err);
    fclose(in);
    return st;
}

/* Shards one after the other are one sweep. */
static void
reads_rows_back(void **state)
{
    static const char good[] = "# stickslip sweep 1\n# columns: index contact_damping/(N s/m) "
        "period amplitude/m status\n1\t2.5\taperiodic\t-\tno period\n0\t2\t1\t1e-4\tok\n"
        "# stickslip sweep 1\n# columns: index contact_damping/(N s/m) period amplitude/m status\n"
        "2\t3\t2\t0.5\tok\r\n";
    static const struct { const char *text, *why; } bad[] = {
        { "x\n", "a.tsv:1: not a sweep, of which the first line is '# stickslip sweep 1'" },
        { "# stickslip sweep 1\n1\t2\tok\n", "a.tsv:2: no '# columns:' line in the header" },
        { "# stickslip sweep 1\n# columns: index x status\n1\tok\n",
          "a.tsv:3: expected 3 columns, found 2" },
        { "# stickslip sweep 1\n# columns: index x status\n1\t2\t3\tok\n",
          "a.tsv:3: expected 3 columns, found 4" },
        { "# stickslip sweep 1\n# columns: index x status\n# columns: index y status\n",
          "a.tsv:3: other columns than before" },
        { "# stickslip sweep 1\n", "a.tsv: no '# columns:' line in the header" },
        { "", "a.tsv: empty" } };
    ss_table *t = NULL;
    ss_error err = { 0 };
    (void)state;
    assert_int_equal(read_text(&t, good, NULL), SS_OK);
    assert_int_equal(t->n_columns, 5);
    assert_int_equal(t->n, 3);
    assert_string_equal(t->column[1].name, "contact_damping");
    assert_string_equal(t->column[1].unit, "N s/m");
    assert_true(ss_table_number(t, 0, 0) == 1 && ss_table_number(t, 1, 1) == 2);
    assert_true(isnan(ss_table_number(t, 0, 3)) && ss_table_number(t, 2, 3) == 0.5);
    assert_string_equal(t->cell[2], "aperiodic");
    ss_table_free(t);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(read_text(&t, bad[i].text, &err), i == 0 ? SS_EKIND : SS_EDATA);
        assert_string_equal(err.text, bad[i].why);
    }
    assert_int_equal(read_text(&t, "# stickslip events 1\n", &err), SS_EKIND);
    assert_int_equal(err.found, SS_KIND_EVENTS);
}

/* No more columns than a signal has. */
static void
refuses_a_sweep_of_more_than_32768_columns(void **state)
{
    enum { MOST = 32768 };
    static char text[8 * MOST];
    (void)state;
    for (int n = MOST; n <= MOST + 1; n++) {
        ss_table *t = NULL;
        ss_error err = { 0 };
        char *p = text + sprintf(text, "# stickslip sweep 1\n# columns:");
        for (int i = 1; i < n; i++)
            p += sprintf(p, " a");
        p += sprintf(p, " status\n");
        for (int i = 1; i < n; i++)
            p += sprintf(p, "1\t");
        sprintf(p, "ok\n");
        assert_int_equal(read_text(&t, text, &err), n == MOST ? SS_OK : SS_EDATA);
        if (n > MOST)
            assert_string_equal(err.text, "a.tsv:2: more than 32768 columns");
        ss_table_free(t);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gives_den_hartogs_amplitude),
        cmocka_unit_test(knows_den_hartogs_limits),
        cmocka_unit_test(stops_where_den_hartog_says),
        cmocka_unit_test(gives_the_settled_numbers),
        cmocka_unit_test(balances_energy),
        cmocka_unit_test(multipliers_are_the_rate_of_approach),
        cmocka_unit_test(shooting_ends_a_slow_approach),
        cmocka_unit_test(shooting_finds_a_resonance_that_simulation_needs_10000_cycles_for),
        cmocka_unit_test(shooting_leaves_a_contact_that_sticks_where_it_is),
        cmocka_unit_test(a_linear_friction_has_its_multipliers),
        cmocka_unit_test(series_have_the_multipliers_of_differences),
        cmocka_unit_test(multipliers_have_the_product_of_the_jumps),
        cmocka_unit_test(free_decay_ends_where_it_must),
        cmocka_unit_test(finds_sub_harmonics),
        cmocka_unit_test(says_what_has_no_period),
        cmocka_unit_test(a_pulled_slider_has_its_closed_form),
        cmocka_unit_test(a_falling_friction_has_its_published_period),
        cmocka_unit_test(a_damped_slider_sticks_as_its_record_does),
        cmocka_unit_test(a_slider_on_a_contact_comes_nearer_by_its_multiplier),
        cmocka_unit_test(a_true_stick_forgets_every_difference),
        cmocka_unit_test(finds_the_one_of_two_close_motions_that_is_approached),
        cmocka_unit_test(says_what_has_no_cycle),
        cmocka_unit_test(bristles_have_the_cycles_of_runge_and_kutta),
        cmocka_unit_test(bristles_have_the_exponent_of_two_sliders),
        cmocka_unit_test(a_slide_without_damping_swings_freely),
        cmocka_unit_test(methods_agree),
        cmocka_unit_test(hears_the_transition_frequency),
        cmocka_unit_test(every_value_is_there_or_the_status_says_why),
        cmocka_unit_test(refuses_what_cannot_be_measured),
        cmocka_unit_test(reads_axes),
        cmocka_unit_test(round_values_are_round),
        cmocka_unit_test(shards_threads_and_starts_give_the_same_rows),
        cmocka_unit_test(refuses_grids_that_mean_nothing),
        cmocka_unit_test(reads_rows_back),
        cmocka_unit_test(refuses_a_sweep_of_more_than_32768_columns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
