/* test_reference.c -- simulation against tests/reference/exact.tsv, which arbitrary precision made. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <stickslip.h>
#include "shipped.h"
#include "unit.h"
#include "scene/scene.h"

enum { RATE = 2000, DURATION = 10, SAMPLES = RATE * DURATION, MAX_EVENTS = 256 };

typedef struct reference {
    ss_scene scene;
    size_t n_events, n_samples;
    ss_event event[MAX_EVENTS];
    ss_sample sample[MAX_EVENTS];       /* t, x, v, a, mode */
} reference;

typedef struct run {
    size_t n_events, n_samples;
    ss_event event[MAX_EVENTS];
    ss_sample sample[SAMPLES];
} run;

static FILE *
open_table(void)
{
    const char *source = getenv("SRC");
    char path[4096];
    snprintf(path, sizeof path, "%s/tests/reference/exact.tsv", source != NULL ? source : ".");
    FILE *in = fopen(path, "r");
    if (in == NULL)
        fail_msg("%s cannot be read: run from the source tree, or set SRC", path);
    return in;
}

static void
read_scene(ss_scene *scene, const char *name)
{
    *scene = read_shipped_named(name);
    scene->settle = 0;
    scene->duration = DURATION;
    scene->rate = RATE;
}

static ss_event_kind
kind_named(const char *name)
{
    ss_event_kind kind = SS_STICK;
    while (strcmp(ss_event_kind_name(kind), name) != 0)
        assert_true(++kind <= SS_REVERSE);
    return kind;
}

static void
read_reference(reference *r, const char *name)
{
    FILE *in = open_table();
    char line[512], scene[32], kind[16], t[64], x[64], v[64], a[64];
    int direction;
    r->n_events = r->n_samples = 0;
    read_scene(&r->scene, name);
    while (fgets(line, sizeof line, in) != NULL) {
        if (line[0] == '#')
            continue;
        assert_int_equal(sscanf(line, "%31s %15s %d %63s %63s %63s %63s", scene, kind, &direction, t,
                                x, v, a), 7);
        if (strcmp(scene, name) != 0)
            continue;
        assert_true(r->n_events < MAX_EVENTS && r->n_samples < MAX_EVENTS);
        if (strcmp(kind, "sample") == 0)
            r->sample[r->n_samples++] = (ss_sample){ .t = atof(t), .x = atof(x), .v = atof(v),
                                                     .a = atof(a), .mode = direction };
        else
            r->event[r->n_events++] = (ss_event){ atof(t), atof(x), atof(v), kind_named(kind),
                                                  direction };
    }
    fclose(in);
}

static int
keep_samples(const ss_sample *s, size_t n, void *user)
{
    run *r = user;
    memcpy(r->sample + r->n_samples, s, n * sizeof *s);
    r->n_samples += n;
    return 0;
}

static int
keep_event(const ss_event *e, void *user)
{
    run *r = user;
    if (r->n_events == MAX_EVENTS)
        return 1;
    r->event[r->n_events++] = *e;
    return 0;
}

/* Allowed: t [s]; x and v as parts of max|x| and of max|x| times the fastest frequency; a as what
 * the equation of motion makes of the errors of x and v, and a few roundings of max|a|. */
static void
compare(const char *name, const char *method, double tol, double allow_t, double allow)
{
    static reference ref;
    static run r;
    ss_error err = { 0 };
    ss_sim_opts opts = { .size = sizeof(ss_sim_opts), .method = method, .tol = tol, .samples = keep_samples,
                         .events = keep_event, .user = &r };
    double max_x = 0, max_a = 0, worst_t = 0, worst_x = 0, worst_v = 0, worst_a = 0;

    read_reference(&ref, name);
    r.n_events = r.n_samples = 0;
    if (ss_sim_run(&ref.scene, &opts, NULL, &err) != SS_OK)
        fail_msg("%s", err.text);
    for (size_t i = 0; i < r.n_samples; i++) {
        max_x = fmax(max_x, fabs(r.sample[i].x));
        max_a = fmax(max_a, fabs(r.sample[i].a));
    }
    assert_int_equal(r.n_events, ref.n_events);
    for (size_t i = 0; i < ref.n_events; i++) {
        const ss_event *e = &r.event[i], *truth = &ref.event[i];
        assert_int_equal(e->kind, truth->kind);
        assert_int_equal(e->direction, truth->direction);
        worst_t = fmax(worst_t, fabs(e->t - truth->t));
        worst_x = fmax(worst_x, fabs(e->x - truth->x));
    }
    assert_true(ref.n_samples > 200);
    for (size_t i = 0; i < ref.n_samples; i++) {
        const ss_sample *truth = &ref.sample[i], *s = &r.sample[(size_t)rint(truth->t * RATE)];
        assert_true(s->t == truth->t);
        assert_int_equal(s->mode, truth->mode);
        worst_x = fmax(worst_x, fabs(s->x - truth->x));
        worst_v = fmax(worst_v, fabs(s->v - truth->v));
        worst_a = fmax(worst_a, fabs(s->a - truth->a));
    }
    double k = ref.scene.stiffness + fmax(0, ss_scene_get(&ref.scene, "contact_stiffness")), m = ref.scene.mass;
    double omega = sqrt(k / m), allow_x = allow * max_x, allow_v = omega * allow_x;
    double allow_a = (k * allow_x + fmax(0, ss_scene_get(&ref.scene, "contact_damping")) * allow_v) / m
        + 8 * DBL_EPSILON * max_a;
    print_message("%s, %s: t %.1e s, x %.1e, v %.1e, a %.1e of what is allowed\n", method, name,
                  worst_t, worst_x / allow_x, worst_v / allow_v, worst_a / allow_a);
    assert_true(worst_t <= allow_t);
    assert_true(worst_x <= allow_x);
    assert_true(worst_v <= allow_v);
    assert_true(worst_a <= allow_a);
}

static const char *const with_events[] = { "coulomb", "compliant-heavy", "compliant-light" };

static void
exact_equals_arbitrary_precision(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        compare(with_events[i], "exact", 1e-12, 1e-13, 1e-13);
}

static void
rk8pd_equals_arbitrary_precision(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        compare(with_events[i], "rk8pd", 1e-12, 1e-10, 1e-10);
}

static void
taylor_equals_arbitrary_precision(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        compare(with_events[i], "taylor", 1e-14, 1e-13, 1e-13);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_equals_arbitrary_precision),
        cmocka_unit_test(rk8pd_equals_arbitrary_precision),
        cmocka_unit_test(taylor_equals_arbitrary_precision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
