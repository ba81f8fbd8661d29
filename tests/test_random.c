/* test_random.c -- random scenes, drawn from the ranges that the library says it supports.
 *
 * Log-uniform in each of ss_scene_ranges, from a fixed seed; SCENES=N in the environment sets how
 * many (tests/long/random-scenes.sh: 10000), FIRST=N with which one to begin, VERBOSE=1 shows each. */
#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "extremes/runs.h"

enum { DEFAULT_SCENES = 200, SAMPLES = 400, STEPS = 4000 };

/* --- drawing ------------------------------------------------------------------------------- */

typedef struct rng { uint64_t s; } rng;

/* splitmix64 (Steele, Lea & Flood 2014) */
static double
uniform(rng *r)
{
    uint64_t z = r->s += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

/* Within the named range; one time in eight 0, where that is in it. */
static double
draw(rng *r, const char *name)
{
    const ss_scene_range *range = ss_scene_ranges;
    while (strcmp(range->name, name) != 0)
        range++;
    double u = uniform(r), zero = uniform(r);
    return range->zero && zero < 0.125 ? 0 : range->from * pow(range->to / range->from, u);
}

static ss_scene
random_scene(uint64_t number)
{
    rng r = { number * UINT64_C(0xd1342543de82ef95) + 1 };
    ss_scene s = ss_scene_defaults;
    double omega = 2 * M_PI * draw(&r, "omega_n/(2 pi)"), X = draw(&r, "X");
    s.model = (ss_model)(3 * uniform(&r));
    s.mass = draw(&r, "m");
    s.stiffness = s.mass * omega * omega;
    double base = draw(&r, "Omega/omega_n"), start = uniform(&r), angle = 2 * M_PI * uniform(&r);
    s.base_frequency = base * omega / (2 * M_PI);
    s.phase = 2 * M_PI * uniform(&r);
    s.base_amplitude = start < 0.25 ? X * uniform(&r) : X;
    if (start < 0.5) {
        s.x0 = X * cos(angle);
        s.v0 = X * omega * sin(angle);
    }
    X = fmax(s.base_amplitude, fmax(fabs(s.x0), fabs(s.v0) / omega));
    s.friction = draw(&r, "f_k/(k X)") * s.stiffness * X;
    double fastest = fmax(1, base);
    if (s.model == SS_COMPLIANT) {
        s.contact_stiffness = draw(&r, "K_y/k") * s.stiffness;
        double k = s.stiffness + s.contact_stiffness, zeta = draw(&r, "c/(2 sqrt((k + K_y) m))");
        s.contact_damping = zeta * 2 * sqrt(k) * sqrt(s.mass);
        s.release = uniform(&r) < 0.5 ? SS_RELEASE_SPRING : SS_RELEASE_TOTAL;
        fastest = fmax(fastest, sqrt(k / s.stiffness) * (zeta + sqrt(fmax(1, zeta * zeta))));
    } else if (s.model == SS_STATE_VARIABLE) {
        s.alpha = draw(&r, "alpha X omega_n") / (X > 0 ? X * omega : 1);
        s.gamma = draw(&r, "gamma/omega_n") * omega;
    }
    /* ten of the slowest periods, or STEPS of the longest steps if that is less */
    double slow = base > 0 ? fmin(1, base) : 1;
    s.duration = fmin(10 / slow, STEPS / 40. / fastest) * 2 * M_PI / omega;
    s.rate = SAMPLES / s.duration;
    return s;
}

static void
print_scene(uint64_t number, const ss_scene *s)
{
    print_message("scene %lu:\n", (unsigned long)number);
    ss_scene_write(s, stdout);
}

static size_t
from_environment(const char *name, size_t otherwise)
{
    const char *text = getenv(name);
    return text != NULL ? strtoul(text, NULL, 10) : otherwise;
}

/* --- properties ---------------------------------------------------------------------------- */

static int
same_events(const run *a, const run *b)
{
    if (a->n_events != b->n_events)
        return 0;
    for (size_t i = 0; i < a->n_events; i++)
        if (a->event[i].kind != b->event[i].kind)
            return 0;
    return 1;
}

static void
explore(void **state)
{
    size_t first = from_environment("FIRST", 0), n = from_environment("SCENES", DEFAULT_SCENES);
    int verbose = from_environment("VERBOSE", 0) != 0;
    (void)state;
    for (size_t i = first; i < first + n; i++) {
        ss_scene s = random_scene(i);
        ss_error err;
        if (ss_scene_check(&s, &err) != SS_OK || ss_scene_supported(&s, &err) != SS_OK)
            print_message("%zu: %s\n", i, err.text);
        if (getenv("SKIP") && s.model == (unsigned)atoi(getenv("SKIP"))) continue;
        int state_variable = s.model == SS_STATE_VARIABLE;
        run a = run_with(&s, state_variable ? NULL : "exact", 1e-12, 20000000);
        run b = run_with(&s, !state_variable ? "rk8pd" : strcmp(ss_sim_method_for(&s), "bsimp") == 0 ? "rk4imp" : "rkck", state_variable ? 1e-10: 1e-12, 2000000);
        ss_scene t = s;
        t.mass *= 1 + DBL_EPSILON;
        run c = run_with(&t, state_variable ? NULL : "exact", 1e-12, 20000000);
        double max = max_x(&a);
        print_message("%zu\t%s\t%d %d\tn %zu %zu %zu %d\tdiff %.1e nudge %.1e\tsteps %lu %lu\t%s%s\n", i,
                      ss_model_name(s.model), a.status, b.status, a.n_events, b.n_events, c.n_events,
                      same_events(&a, &b), difference(&a, &b, 1) / max,
                      difference(&a, &c, 1) / max, a.stats.steps, b.stats.steps,
                      a.status ? a.err.text : "", b.status ? b.err.text : "");
        if (verbose)
            print_scene(i, &s);
        run_free(&a);
        run_free(&b);
        run_free(&c);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(explore),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
