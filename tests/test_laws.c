/* test_laws.c -- friction with a state of its own: LuGre's law and Bouc-Wen's, of which Dahl's is one.
 *
 * Truth: closed forms where the law has one, and an integration of the law as it is written, in long double
 * by steps of Runge and Kutta's order 4, which has no code of the library. */
#include <float.h>
#include <math.h>

#include "extremes/runs.h"
#include "near.h"
#include "random_scene.h"
#include "shipped.h"
#include "unit.h"

static ss_scene
scene_with(const char *name, const char *const settings[][2])
{
    ss_scene s = read_shipped_named(name);
    ss_error err = { 0 };
    for (size_t i = 0; settings[i][0] != NULL; i++)
        if (ss_scene_set_text(&s, settings[i][0], settings[i][1], &err) != SS_OK)
            fail_msg("%s", err.text);
    return s;
}

static run
run_of(const ss_scene *scene, const char *method, double tol)
{
    run r = run_with(scene, method, tol, 0);
    if (r.status != SS_OK)
        fail_msg("%s", r.err.text);
    return r;
}

/* --- the laws as they are written ----------------------------------------------------------------- */

typedef struct point {
    long double t, x, v, z;             /* z: in m, also Bouc-Wen's */
} point;

static long double
sgn(long double x)
{
    return (x > 0) - (x < 0);
}

static long double
number(const ss_scene *s, const char *key)
{
    double x = ss_scene_get(s, key);
    return isnan(x) ? 0 : (long double)x;
}

/* z', and the friction. */
static long double
law(const ss_scene *s, long double v, long double z, long double *f)
{
    long double f_k = s->friction, rate;
    if (s->model == ss_model_named("lugre")) {
        long double w = v / number(s, "stribeck_velocity"), f_s = fmax(s->static_friction, s->friction);
        long double g = f_k + (f_s - f_k) * expl(-w * w), stiffness = number(s, "bristle_stiffness");
        rate = v - stiffness * fabsl(v) / g * z;
        *f = stiffness * z + number(s, "bristle_damping") * rate + number(s, "viscous_friction") * v;
        return rate;
    }
    long double b = number(s, "gap"), K = number(s, "contact_stiffness"), p = number(s, "beta_fraction");
    long double part = sgn(z) * fmaxl(fabsl(z) - b, 0) * K / f_k;
    *f = f_k * part;
    return v * (1 - powl(fabsl(part), number(s, "exponent")) * (1 - p + p * sgn(v * part)));
}

static point
rate(const ss_scene *s, point at)
{
    long double f, w = 2 * acosl(-1) * s->base_frequency, push;
    point d = { 1, at.v, 0, 0 };
    d.z = law(s, at.v - s->surface_velocity, at.z, &f);
    push = s->base_amplitude * cosl(w * at.t + s->phase) + s->base_velocity * at.t - at.x;
    d.v = (s->stiffness * push - s->damping * at.v - f) / s->mass;
    return d;
}

static point
along(point at, point d, long double h)
{
    return (point){ at.t + h * d.t, at.x + h * d.x, at.v + h * d.v, at.z + h * d.z };
}

static point
stepped(const ss_scene *s, point at, long double h)
{
    point a = rate(s, at), b = rate(s, along(at, a, h / 2)), c = rate(s, along(at, b, h / 2));
    point d = rate(s, along(at, c, h));
    at = along(at, a, h / 6);
    at = along(at, b, h / 3);
    at = along(at, c, h / 3);
    at = along(at, d, h / 6);
    return at;
}

/* Which piece of the law holds. */
static int
piece(const ss_scene *s, point at)
{
    long double b = number(s, "gap");
    int side = s->model == ss_model_named("lugre") || fabsl(at.z) <= b ? 0 : (int)sgn(at.z);
    return 3 * (int)sgn(at.v - s->surface_velocity) + side;
}

/* A step that leaves a piece of the law ends there: it is cut in two until it ends behind the kink by less than
 * rounding. */
static point
stepped_to_kink(const ss_scene *s, point at, long double h)
{
    point end = stepped(s, at, h);
    long double lo = 0, hi = h;
    if (piece(s, at) == piece(s, end))
        return end;
    while (hi - lo > 1e-19L * (at.t + 1)) {
        long double mid = (lo + hi) / 2;
        point there = stepped(s, at, mid);
        if (piece(s, there) == piece(s, at)) {
            lo = mid;
        } else {
            hi = mid;
            end = there;
        }
    }
    return end;
}

/* x from rest at each sample of a record, by n steps a sample, which Richardson's extrapolation of two such
 * runs takes to order 5. */
static void
integrate(long double *x, const ss_scene *s, size_t samples, size_t n)
{
    point at = { 0, s->x0, s->v0, 0 };
    for (size_t i = 0; i < samples; i++) {
        x[i] = at.x;
        for (size_t j = 1; j <= n; j++) {
            long double to = (i + (long double)j / n) / s->rate;
            while (to - at.t > 1e-17L * (1 + to))
                at = stepped_to_kink(s, at, to - at.t);
        }
    }
}

static void
agrees_with_the_law(const char *name, const char *const settings[][2], size_t steps, double allowed)
{
    ss_scene s = scene_with(name, settings);
    s.settle = 0;
    run r = run_of(&s, NULL, 1e-13);
    long double *x = malloc(2 * r.n * sizeof *x), *half = x + r.n;
    double worst = 0, known = 0, size = max_x(&r);
    integrate(x, &s, r.n, steps);
    integrate(half, &s, r.n, 2 * steps);
    for (size_t i = 0; i < r.n; i++) {
        known = fmax(known, (double)fabsl(half[i] - x[i]) / 15 / size);
        worst = fmax(worst, (double)fabsl(r.sample[i].x - (half[i] + (half[i] - x[i]) / 15)) / size);
    }
    print_message("%s: off by %.1e of %.3g, where the steps of the truth leave less than %.1e\n", name, worst,
                  size, known);
    if (!(known <= allowed && worst <= allowed))
        fail_msg("%s: off by %.2g", name, worst);
    free(x);
    run_free(&r);
}

static void
motions_are_those_of_the_law(void **state)
{
    static const char *const lugre[][2] = { { "duration", "12" }, { NULL, NULL } };
    static const char *const dahl[][2] = { { "duration", ".5" }, { "rate", "1000" }, { NULL, NULL } };
    static const char *const steep[][2] = { { "duration", ".5" }, { "rate", "1000" }, { "exponent", "3" },
                                            { "beta_fraction", ".6" }, { NULL, NULL } };
    static const char *const gap[][2] = { { "duration", ".5" }, { "rate", "1000" }, { "exponent", "2" },
                                          { "gap", "2e-5" }, { NULL, NULL } };
    (void)state;
    agrees_with_the_law("lugre", lugre, 300, 1e-9);
    agrees_with_the_law("dahl", dahl, 40, 1e-9);
    agrees_with_the_law("dahl", steep, 40, 1e-9);
    agrees_with_the_law("dahl", gap, 40, 1e-9);
}

/* --- Dahl: between two turns the force approaches +-f_k as exp(-|x - x0| K / f_k) -------------------- */

static void
the_force_of_dahl_is_an_exponential_of_the_way(void **state)
{
    ss_scene s = read_shipped_named("dahl");
    run r = run_of(&s, NULL, 1e-13);
    double f_k = s.friction, decay = ss_scene_get(&s, "contact_stiffness") / f_k, worst = 0, largest = 0;
    size_t compared = 0;
    (void)state;
    for (size_t i = 1; i < r.n; i++) {
        const ss_sample *a = &r.sample[i - 1], *b = &r.sample[i];
        double way = b->x - a->x;
        if (a->mode != b->mode || a->mode * way < 0)
            continue;                   /* it has turned between them */
        double goal = a->mode * f_k, f = goal + (a->f - goal) * exp(-fabs(way) * decay);
        worst = fmax(worst, fabs(b->f - f));
        largest = fmax(largest, fabs(b->f));
        compared++;
    }
    /* x is known to 1e-13 of 3e-4 m, 8 units in the last place of 1, and K / f_k times that is the error of f */
    near("force", worst, 0, 2 * 1e-13 * max_x(&r) * ss_scene_get(&s, "contact_stiffness") + 8 * DBL_EPSILON * f_k);
    assert_true(compared > r.n * 9 / 10 && largest > .999 * f_k);
    run_free(&r);
}

/* --- a state variable: at a speed that is held theta = goal (1 - exp(-rate t)) ---------------------- */

static void
a_state_variable_relaxes_as_its_law_says(void **state)
{
    static const char *const law[] = { "scaled", "literal" };
    const double goal[] = { 2.5, 1 }, rate[] = { 50, 2.5 * 50 };
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        const char *const settings[][2] = { { "law", law[i] }, { "friction", "2.5" }, { "alpha", "100" },
                                            { "gamma", "50" }, { "mass", "1e15" }, { "base_amplitude", "0" },
                                            { "v0", "0.01" }, { "duration", "0.05" }, { "settle", "0" },
                                            { NULL, NULL } };
        ss_scene s = scene_with("state-variable", settings);
        run r = run_of(&s, NULL, 1e-12);
        assert_true(r.n > 50);
        for (size_t k = 0; k < r.n; k++)
            near("theta", r.sample[k].f, goal[i] * tanh(1) * (1 - exp(-rate[i] * r.sample[k].t)), 1e-10);
        run_free(&r);
    }
}

/* --- LuGre: presliding (Canudas de Wit et al., fig. 2) ------------------------------------------------ */

/* The paper pushes the mass by a ramp to 1.425 N and back, below the break-away force of 1.5 N.  The spring's
 * pulled end pushes it here: k U t rises to 1.425 N.  So slow a push is a motion of equilibria, where
 * z' = v (1 - sigma_0 |z| / f_s) to the order of (v/v_s)^2: sigma_0 z = f_s (1 - exp(-sigma_0 x / f_s)). */
static void
presliding_is_a_curve_of_the_way(void **state)
{
    static const char *const settings[][2] = { { "base_velocity", "1e-4" }, { "static_friction", "1.5" },
                                               { "stribeck_velocity", "100" }, { NULL, NULL } };
    ss_scene s = scene_with("lugre", settings);
    double stiffness = ss_scene_get(&s, "bristle_stiffness"), worst = 0;
    (void)state;
    s.duration = 1.425 / s.stiffness / s.base_velocity;
    s.rate = 1000 / s.duration;
    run r = run_of(&s, NULL, 1e-12);
    for (size_t i = 1; i < r.n; i++) {
        const ss_sample *at = &r.sample[i];
        worst = fmax(worst, fabs(at->y - 1.5 / stiffness * (1 - exp(-at->x * stiffness / 1.5))));
    }
    const ss_sample *last = &r.sample[r.n - 1];
    near("x at 1.425 N", last->x, -log(1 - last->f / 1.5) * 1.5 / stiffness, 1e-9);
    /* the tolerance is relative to f_s / k = .75 m, and x is counted from the pulled end: .7125 m are rounded */
    near("bristles, of their largest deflection", worst * stiffness / 1.5, 0,
         (1e-12 * .75 + (double)r.stats.steps * DBL_EPSILON / 2 * .7125) * stiffness / 1.5);
    run_free(&r);
}

/* With f_k = 0 nothing is left of g at speeds far beyond v_s, 0 in double precision from 28 v_s on: no bristle
 * bends, and the mass swings freely. */
static void
bristles_without_friction_do_not_bend(void **state)
{
    static const char *const settings[][2] = { { "friction", "0" }, { "stribeck_velocity", "1e-4" },
                                               { "base_velocity", "0" }, { "viscous_friction", "0" },
                                               { "v0", "1" }, { NULL, NULL } };
    (void)state;
    ss_scene s = scene_with("lugre", settings);
    const double omega = sqrt(s.stiffness / s.mass);
    s.settle = 0;
    s.duration = 1 / omega;
    s.rate = 50 / s.duration;
    for (size_t m = 0; m < 2; m++) {
        run r = run_of(&s, m == 0 ? "taylor" : "rk8pd", 1e-12);
        for (size_t i = 0; i < r.n; i++) {
            near("x", r.sample[i].x * omega, sin(omega * r.sample[i].t), 1e-11);
            assert_true(r.sample[i].y == 0);
        }
        run_free(&r);
    }
}

/* --- a contact's loss in a cycle: 4 f (X - b - f / K) --------------------------------------------- */

static ss_steady
steady_of(const ss_scene *scene, const char *method)
{
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady out;
    ss_error err = { 0 };
    opts.tol = 1e-12;
    opts.method = method;
    opts.measures = 1u << SS_AMPLITUDE | 1u << SS_ENERGY | 1u << SS_FLOQUET;
    if (ss_steady_find(&out, scene, &opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return out;
}

/* The law of Jenkins between two turns at +-X: it slips 2 X, less the way through the gap and twice the
 * spring's. */
static void
a_contact_loses_what_its_slips_take(void **state)
{
    static const char *const gap[] = { "0", "1e-4" };
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        const char *const settings[][2] = { { "contact_damping", "0" }, { "gap", gap[i] }, { "base_frequency", "4.9" },
                                            { "contact_stiffness", "11000" }, { NULL, NULL } };
        ss_scene s = scene_with("compliant-light", settings);
        ss_steady at = steady_of(&s, "exact");
        double X = at.value[SS_AMPLITUDE], f = s.friction;
        near("loss, of 4 f X", at.value[SS_ENERGY] / (4 * f * X), (X - strtod(gap[i], NULL) - f / 11000) / X, 1e-10);
    }
}

/* The multiplier by differentiating the closed form across the edges of a gap, where the damper's force jumps, and by
 * simulating neighbours: 1e-4 of the scales of x, v and y away they pass the edges elsewhere, with as large an error
 * an edge. */
static void
a_multiplier_is_carried_across_a_gap(void **state)
{
    static const char *const settings[][2] = { { "gap", "3e-5" }, { "contact_stiffness_negative", "90000" },
                                               { "friction_negative", "1.1" }, { NULL, NULL } };
    (void)state;
    ss_scene s = scene_with("compliant-light", settings);
    near("multiplier", steady_of(&s, "exact").value[SS_FLOQUET], steady_of(&s, "rk8pd").value[SS_FLOQUET], 4e-4);
}

/* --- limits ----------------------------------------------------------------------------------------- */

/* As sigma_0 grows the bristles become rigid.  A stop leaves them an energy of f_k^2 / (2 sigma_0): the distance from
 * Coulomb's motion falls with its root at least. */
static void
stiff_bristles_are_coulombs(void **state)
{
    static const char *const each[] = { "1e6", "1e7", "1e8" };
    double off[3];
    (void)state;
    ss_scene limit = read_shipped_named("coulomb");
    limit.friction = .6;
    limit.settle = 8;
    limit.duration = .4;
    run truth = run_of(&limit, "exact", 1e-12);
    for (size_t i = 0; i < 3; i++) {
        ss_scene s = limit;
        ss_scene_set_text(&s, "model", "lugre", NULL);
        ss_scene_set_text(&s, "bristle_stiffness", each[i], NULL);
        ss_scene_set_text(&s, "bristle_damping", "100", NULL);
        ss_scene_set_text(&s, "stribeck_velocity", "1", NULL);
        run r = run_of(&s, NULL, 1e-10);
        off[i] = difference(&truth, &r, 1) / max_x(&truth);
        print_message("sigma_0 = %s: off by %.2g of Coulomb's motion\n", each[i], off[i]);
        run_free(&r);
    }
    assert_true(off[2] < 1e-3 && off[1] > sqrt(10) * off[2] && off[0] > sqrt(10) * off[1]);
    run_free(&truth);
}

/* A load of a twentieth of what friction holds, steady or alternating: simulators of robots creep. */
static void
a_held_load_does_not_creep(void **state)
{
    static const char *const alternating[][2] = { { "friction", "27.72" }, { "duration", "1000" }, { "rate", "7" },
                                                  { NULL, NULL } };
    (void)state;
    for (size_t m = 0; ss_sim_method_name(m) != NULL; m++) {
        ss_scene s = scene_with("coulomb", alternating);
        s.x0 = 1e-4;
        run r = run_of(&s, ss_sim_method_name(m), 1e-9);
        assert_int_equal(r.stats.events, 0);
        for (size_t i = 0; i < r.n; i++)
            assert_true(r.sample[i].x == s.x0 && r.sample[i].v == 0);
        run_free(&r);
    }
    ss_scene s = scene_with("compliant-heavy", alternating);
    s.settle = 10;                      /* periods of the base are 0.4 s: 14 samples at 35 Hz */
    s.rate = 35;
    run r = run_of(&s, "exact", 1e-12);
    assert_int_equal(r.stats.events, 0);
    double creep = 0;
    for (size_t i = 0; i + 14 < r.n; i++)
        creep = fmax(creep, fabs(r.sample[i + 14].x - r.sample[i].x));
    near("compliant, from cycle to cycle, of the contact's deflection", creep / max_x(&r), 0, 16 * DBL_EPSILON);
    run_free(&r);
}

/* --- Stribeck: the friction in slip is the formula --------------------------------------------------- */

static void
falling_friction_is_its_formula(void **state)
{
    static const char *const shape[] = { "hyperbolic", "exponential" }, *const delta[] = { "1", "1.5", "2", "3" };
    (void)state;
    for (size_t i = 0; i < 8; i++) {
        const char *const settings[][2] = { { "stribeck_shape", shape[i % 2] }, { "stribeck_exponent", delta[i / 2] },
                                            { "friction", "0.5" }, { "friction_negative", "0.4" }, { NULL, NULL } };
        ss_scene s = scene_with("leine", settings);
        run r = run_of(&s, NULL, 1e-12);
        size_t slips = 0;
        double off = 0;
        for (size_t k = 0; k < r.n; k++) {
            const ss_sample *at = &r.sample[k];
            double u = pow(fabs(at->v - s.surface_velocity) * 3, strtod(delta[i / 2], NULL));
            double part = i % 2 == 0 ? 1 / (1 + u) : exp(-u), f_k = at->mode < 0 ? .4 : .5;
            if (at->mode == 0)
                continue;
            slips++;
            if (!(fabs(at->f - at->mode * (f_k + (1 - f_k) * part)) <= 1e-14))
                fail_msg("%s %s: f = %.17g", shape[i % 2], delta[i / 2], at->f);
            off = fmax(off, fabs(at->a + at->x + at->f));
        }
        assert_true(slips > 100);
        near("a, whose series is shorter by an order than that of x, which keeps 1e-12", off, 0, 1e-10);
        run_free(&r);
    }
}

/* --- accuracy ---------------------------------------------------------------------------------------- */

/* Truth for random scenes of the laws: another method, at 1e-14. */
static void
keep_an_accuracy(ss_scene draw(uint64_t), uint64_t first, uint64_t n)
{
    size_t refused = 0;
    for (uint64_t i = first; i < first + n; i++) {
        ss_scene s = draw(i);
        ss_sim_opts opts;
        ss_sim_opts_init(&opts, sizeof opts);
        ss_error err = { 0 };
        if (ss_trade_choose(&opts, &s, 1e-7, &err) != SS_OK) {
            refused++;
            continue;
        }
        int same = opts.method != NULL && strcmp(opts.method, "rk8pd") == 0;
        run r = run_of(&s, opts.method, opts.tol);
        run truth = run_with(&s, same ? "rkck" : "rk8pd", same ? 1e-11 : 1e-13, 0);
        if (truth.status == SS_OK && !(difference(&r, &truth, 1) <= 1e-7 * max_x(&truth)))
            complain(i, &s, opts.method, difference(&r, &truth, 1) / max_x(&truth), 1e-7);
        run_free(&truth);
        run_free(&r);
    }
    print_message("%zu of %d refused\n", refused, (int)n);
    assert_true(refused <= n / 4);
}

static void
accuracies_are_kept_on_random_scenes(void **state)
{
    (void)state;
    keep_an_accuracy(random_scene, RANDOM_NEWER, 30);
    keep_an_accuracy(random_contact, 0, 30);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motions_are_those_of_the_law),
        cmocka_unit_test(the_force_of_dahl_is_an_exponential_of_the_way),
        cmocka_unit_test(a_state_variable_relaxes_as_its_law_says),
        cmocka_unit_test(presliding_is_a_curve_of_the_way),
        cmocka_unit_test(bristles_without_friction_do_not_bend),
        cmocka_unit_test(a_contact_loses_what_its_slips_take),
        cmocka_unit_test(a_multiplier_is_carried_across_a_gap),
        cmocka_unit_test(stiff_bristles_are_coulombs),
        cmocka_unit_test(a_held_load_does_not_creep),
        cmocka_unit_test(falling_friction_is_its_formula),
        cmocka_unit_test(accuracies_are_kept_on_random_scenes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
