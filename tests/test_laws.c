/* test_laws.c -- friction with a state of its own: LuGre's law and Bouc-Wen's, of which Dahl's is one.
 *
 * Truth: closed forms where the law has one, and an integration of the law as it is written, in long double
 * by steps of Runge and Kutta's order 4, which has no code of the library. */
#include <float.h>
#include <math.h>

#include "extremes/runs.h"
#include "near.h"
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
    /* x is counted from the pulled end: each step rounds it to half an ulp of .7125 m */
    near("bristles, of their largest deflection", worst * stiffness / 1.5, 0,
         (double)r.stats.steps * DBL_EPSILON / 2 * .7125 * stiffness / 1.5);
    run_free(&r);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motions_are_those_of_the_law),
        cmocka_unit_test(the_force_of_dahl_is_an_exponential_of_the_way),
        cmocka_unit_test(presliding_is_a_curve_of_the_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
