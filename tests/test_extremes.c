/* test_extremes.c -- scenes far from any that are usual: each gives a right answer, or says why not.
 *
 * A row is a shipped scene from rest, without settling, with settings; what must come out of it, by
 * a check that knows the truth from elsewhere; and why.  tests/test_random.c does the middle. */
#include <float.h>

#include "extremes/runs.h"
#include "unit.h"

#define LENGTH(a) (sizeof (a) / sizeof *(a))

/* A shipped scene with the settings in a list such as "rate=1 mass=2". */
static ss_scene
scene_of(const char *name, const char *list)
{
    enum { MOST = 24 };
    const char *setting[MOST];
    char text[1024];
    size_t n = 0;
    ss_scene scene;
    ss_error err = { 0 };
    snprintf(text, sizeof text, "settle=0 duration=1 %s", list);
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        size_t i = 0, length = strcspn(word, "=");  /* what is given twice counts as given last */
        while (i < n && strncmp(setting[i], word, length + 1) != 0)
            i++;
        assert_true(i < MOST);
        setting[i] = word;
        n = i < n ? n : n + 1;
    }
    if (ss_scene_read(&scene, NULL, name, setting, n, &err) != SS_OK)
        fail_msg("%s: %s", name, err.text);
    return scene;
}

/* --- what may come out --------------------------------------------------------------------- */

typedef struct row row;
typedef void check(const row *r, const ss_scene *s, const run *got);
struct row {
    const char *what, *scene, *settings, *method;       /* method NULL: the scene's own */
    check *must;
    double value, allow;        /* see the check */
    const char *why;            /* the truth, or words of the refusal */
};

static const row *failed;           /* the last row that did */
static size_t failures;

static void
wrong(const row *r, const run *got, const char *what, double is, double wanted, double allow)
{
    if (r != failed)
        print_error("%s (%s, %s): %s is %.17g, not %.17g +- %.1e; %lu steps, %lu events\n", r->what,
                    r->settings, r->method != NULL ? r->method : "its own method", what, is, wanted,
                    allow, got->stats.steps, got->stats.events);
    failures += r != failed;
    failed = r;
}

static void
is_near(const row *r, const run *got, const char *what, double is, double wanted, double allow)
{
    if (!(fabs(is - wanted) <= allow))
        wrong(r, got, what, is, wanted, allow);
}

/* Refused, in these words. */
static void
refused(const row *r, const ss_scene *s, const run *got)
{
    (void)s;
    if (got->status != SS_OK && strstr(got->err.text, r->why) != NULL)
        return;
    print_error("%s: '%s', not '%s'\n", r->what, got->err.text, r->why);
    failures++;
}

/* x never changes, v is 0, nothing happens. */
static void
still(const row *r, const ss_scene *s, const run *got)
{
    is_near(r, got, "number of events", (double)got->n_events, 0, 0);
    for (size_t i = 0; i < got->n; i++)
        if (got->sample[i].x != s->x0 || got->sample[i].v != 0 || got->sample[i].a != 0)
            wrong(r, got, "x", got->sample[i].x, s->x0, 0);
}

/* Samples are at n / rate, to the bit, and the base is where it must be then: off by rounding of the
 * phase, 4 eps, whatever the time.  In long double f n / rate is known to 2^-64 of its cycles. */
static void
keeps_time(const row *r, const ss_scene *s, const run *got)
{
    for (size_t i = 0; i < got->n; i++) {
        const ss_sample *at = &got->sample[i];
        long double cycles = s->base_frequency * (long double)i / s->rate;
        long double phase = 2 * acosl(-1) * (cycles - floorl(cycles)) + s->phase;
        double allow = s->base_amplitude * (8 * DBL_EPSILON + 6.3 * ldexp((double)cycles, -63));
        is_near(r, got, "time of a sample", at->t, (double)i / s->rate, 0);
        is_near(r, got, "z", at->z, (double)(s->base_amplitude * cosl(phase)), allow);
    }
    is_near(r, got, "number of samples", (double)got->n, (double)ss_scene_samples(s), 0);
}

/* So many events. */
static void
events(const row *r, const ss_scene *s, const run *got)
{
    (void)s;
    is_near(r, got, "number of events", (double)got->n_events, r->value, r->allow);
}

/* x at the end of the record. */
static void
ends_at(const row *r, const ss_scene *s, const run *got)
{
    (void)s;
    is_near(r, got, "the last x", got->sample[got->n - 1].x, r->value, r->allow);
}

/* A driven oscillator without friction, allow times max|x|.  In long double, with the sum of two
 * cosines as a product, which is right at and near resonance. */
static void
swings_freely(const row *r, const ss_scene *s, const run *got)
{
    const long double W = 2 * acosl(-1) * s->base_frequency;
    const long double w = sqrtl((long double)s->stiffness / s->mass);
    double max = max_x(got);
    for (size_t i = 0; i < got->n; i++) {
        long double t = (long double)i / s->rate, p = (W - w) / 2 * t, q = (W + w) / 2 * t;
        /* (cos w t - cos W t) w^2 / (W^2 - w^2) = w^2 t sin(q) sin(p)/p / (W + w), times 1 */
        long double beat = p == 0 ? 1 : sinl(p) / p;
        long double x = s->base_amplitude * w * w * t * sinl(q) * beat / (W + w);
        x += s->x0 * cosl(w * t) + s->v0 / w * sinl(w * t);
        is_near(r, got, "x", got->sample[i].x, (double)x, r->allow * max);
    }
}

/* As the Coulomb scene with the same settings moves, to within allow; and that a compliant contact
 * is released up to one of its periods late, that friction takes a quarter of it to be there, which
 * makes a difference of v that the spring turns into one of x, and that it gives way by f_k / K_y. */
static void
moves_as_coulomb(const row *r, const ss_scene *s, const run *got)
{
    ss_scene rigid = *s;
    ss_scene_set_text(&rigid, "model", "coulomb", NULL);
    run truth = run_with(&rigid, "exact", 1e-12, 0);
    double max_v = 0, allow = r->allow;
    for (size_t i = 0; i < truth.n; i++)
        max_v = fmax(max_v, fabs(truth.sample[i].v));
    if (s->model == ss_model_named("compliant")) {
        double period = 2 * M_PI * sqrt(s->mass / ss_scene_get(s, "contact_stiffness"));
        allow += period * (max_v + s->friction / (4 * sqrt(s->mass * s->stiffness)))
            + 4 * s->friction / ss_scene_get(s, "contact_stiffness");
    }
    is_near(r, got, "x, against Coulomb friction, at worst", difference(got, &truth, 1), 0, allow);
    run_free(&truth);
}

/* As by another method, to within allow times the scale of x; as many events. */
static void
agrees(const row *r, const ss_scene *s, const run *got)
{
    const char *other = r->method != NULL && strcmp(r->method, "exact") == 0 ? "rk8pd" : "exact";
    run b = run_with(s, other, 1e-12, 0);
    is_near(r, got, "number of events", (double)got->n_events, (double)b.n_events, 0);
    is_near(r, got, "x, against another method, at worst", difference(got, &b, 1), 0,
            r->allow * scale_of(s));
    run_free(&b);
}

/* As the scene moves in another unit of length, where its numbers are usual ones: to within allow
 * times max|x|; as many events. */
static void
scales(const row *r, const ss_scene *s, const run *got)
{
    ss_scene t = *s;
    double unit = ldexp(1, -ilogb(s->base_amplitude) - 11);
    t.base_amplitude *= unit;
    t.friction *= unit;
    t.x0 *= unit;
    t.v0 *= unit;
    ss_scene_set(&t, "alpha", ss_scene_get(&t, "alpha") / unit, NULL);
    run b = run_with(&t, r->method, 1e-12, 0);
    is_near(r, got, "number of events", (double)got->n_events, (double)b.n_events, 0);
    is_near(r, got, "x, against the same in a usual unit, at worst", difference(got, &b, 1 / unit), 0,
            r->allow * max_x(got));
    run_free(&b);
}

/* --- the table ----------------------------------------------------------------------------- */

static const row table[] = {
#include "extremes/scenes.h"
};

static void
extreme_scenes_are_right_or_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < LENGTH(table); i++) {
        const row *r = &table[i];
        ss_scene s = scene_of(r->scene, r->settings);
        run got = run_with(&s, r->method, 1e-12, 0);
        if (r->must == refused || got.status == SS_OK)
            r->must(r, &s, &got);
        else
            wrong(r, &got, got.err.text, got.status, SS_OK, 0);
        run_free(&got);
    }
    assert_int_equal(failures, 0);
}

/* A rig of 2^-20 of the mass, with 2^-20 of all forces, moves alike to the last bit, however short the steps are
 * in which its friction falls at 1e-14 m/s. */
static void
a_rig_of_a_millionth_moves_alike(void **state)
{
    ss_scene heavy = scene_of("leine", "friction=0.5 stribeck_velocity=1e-14 duration=40");
    (void)state;
    ss_scene light = heavy;
    light.mass = ldexp(heavy.mass, -20), light.stiffness = ldexp(heavy.stiffness, -20);
    light.friction = ldexp(heavy.friction, -20), light.static_friction = ldexp(heavy.static_friction, -20);
    run a = run_with(&heavy, "rk8pd", 1e-12, 0), b = run_with(&light, "rk8pd", 1e-12, 0);
    assert_true(a.status == SS_OK && b.status == SS_OK && a.n == b.n && a.n_events > 0);
    assert_true(difference(&a, &b, 1) == 0);
    run_free(&a);
    run_free(&b);
}

/* --- numbers made elsewhere ---------------------------------------------------------------- */

/* tests/reference/stiff.tsv, by SciPy's Radau.  Allowed: what that changes by at a tenth of its own
 * accuracy, ten times, and the library's tolerance of 1e-12 times 1000 steps, in units of Z_e. */
static void
stiff_friction_moves_as_radau_says(void **state)
{
    const char *source = getenv("SRC");
    char path[4096], line[256], settings[128];
    size_t rows = 0;
    (void)state;
    snprintf(path, sizeof path, "%s/tests/reference/stiff.tsv", source != NULL ? source : ".");
    FILE *in = fopen(path, "r");
    if (in == NULL)
        fail_msg("%s cannot be read: run from the source tree, or set SRC", path);
    while (fgets(line, sizeof line, in) != NULL) {
        double alpha, gamma, t, x, error;
        if (line[0] == '#')
            continue;
        assert_int_equal(sscanf(line, "%lg %lg %lg %lg %lg", &alpha, &gamma, &t, &x, &error), 5);
        snprintf(settings, sizeof settings, "alpha=%g gamma=%g duration=1.25 rate=4", alpha, gamma);
        ss_scene s = scene_of("state-variable", settings);
        run r = run_with(&s, NULL, 1e-12, 0);
        double got = r.sample[(int)(4 * t)].x, allow = 10 * error + 1e-9 * s.base_amplitude;
        assert_int_equal(r.status, SS_OK);
        if (!(fabs(got - x) <= allow))
            fail_msg("%s, t = %g: %.17g, not %.17g +- %.1e", settings, t, got, x, allow);
        run_free(&r);
        rows++;
    }
    fclose(in);
    assert_int_equal(rows, 48);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(extreme_scenes_are_right_or_refused),
        cmocka_unit_test(a_rig_of_a_millionth_moves_alike),
        cmocka_unit_test(stiff_friction_moves_as_radau_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
