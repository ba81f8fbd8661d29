/* test_random.c -- random scenes, drawn from the ranges that the library says it supports.
 *
 * Log-uniform in each range of random_scene.c, from a fixed seed; SCENES=N in the environment sets how
 * many of the older, and a third as many of the newer (tests/long/random-scenes-*.sh: 10000), FIRST=N with which one to begin. */
#include <float.h>
#include <stdint.h>

#include "extremes/runs.h"
#include "random_scene.h"
#include "unit.h"
#include "scene/key.h"
#include "scene/scene.h"

enum { DEFAULT_SCENES = 150 };

static size_t
from_environment(const char *name, size_t otherwise)
{
    const char *text = getenv(name);
    return text != NULL ? strtoul(text, NULL, 10) : otherwise;
}

/* --- what is compared ---------------------------------------------------------------------- */

/* A scene, its run, and how far that moves when mass and phase change by their last bits and steps
 * fall a little otherwise. */
typedef struct trial {
    uint64_t number;
    ss_scene scene;
    const char *method;
    run run;
    double scale;               /* of x, as the library measures it */
    double nudged;
} trial;

enum { BUDGET = 40 * RANDOM_STEPS };           /* of a run whose tolerance forces no shorter steps */
enum { LONG_BUDGET = 100000000 };       /* of one that swings in the front of tanh: 35 million seen */

enum { MOST_SAMPLES = 200000 };         /* friction that is faster than that is not added up */

static void
demand(const trial *t, const char *what, double got, double allowed)
{
    if (!(got <= allowed))
        complain(t->number, &t->scene, what, got, allowed);
}

/* A run ends, or says why not. */
static int
ended(const trial *t, const run *r)
{
    if (r->status == SS_OK)
        return 1;
    if ((r->status != SS_ETOL && r->status != SS_ECHATTER && r->status != SS_EBUDGET)
        || r->err.text[0] == '\0')
        complain(t->number, &t->scene, r->err.text, r->status, 0);
    return 0;
}

static run
run_alike(const trial *t, const ss_scene *s, double tol)
{
    return run_with(s, t->method, tol, ss_model_is_linear(t->scene.model) ? BUDGET : LONG_BUDGET);
}

static trial
trial_of(uint64_t number)
{
    trial t = { .number = number, .scene = random_scene(number) };
    ss_error err = { 0 };
    if (ss_scene_check(&t.scene, &err) != SS_OK || outside_of(&t.scene) != NULL)
        complain(t.number, &t.scene, *err.text != '\0' ? err.text : outside_of(&t.scene), 0, 0);
    t.method = ss_model_is_linear(t.scene.model) ? "exact" : ss_sim_method_for(&t.scene, NULL);
    t.run = run_alike(&t, &t.scene, 1e-12);
    demand(&t, t.run.err.text, t.run.status, SS_OK);
    ss_scene nudged = t.scene;
    nudged.mass *= 1 + DBL_EPSILON;
    nudged.phase += 4 * DBL_EPSILON;
    run other = run_alike(&t, &nudged, ss_model_is_linear(t.scene.model) ? 1e-12 : 1.001e-12);
    t.scale = fmax(scale_of(&t.scene), max_x(&t.run));
    t.nudged = difference(&t.run, &other, 1);
    run_free(&other);
    return t;
}

/* The same kinds in the same order; but an event at the very end may fall to either side of it. */
static int
same_events(const trial *t, const run *b)
{
    const run *a = &t->run;
    double end = t->scene.duration * (1 - 1e-9);
    size_t n = a->n_events < b->n_events ? a->n_events : b->n_events;
    for (size_t i = 0; i < n; i++)
        if (a->event[i].kind != b->event[i].kind)
            return 0;
    const run *longer = a->n_events > n ? a : b;
    return longer->n_events == n || (longer->n_events == n + 1 && longer->event[n].t > end);
}

/* --- properties ---------------------------------------------------------------------------- */

/* How many times as far x moves as the start and the phase of the base do: by 1e-7, which is far above
 * rounding and far below what is not linear.  Friction that falls with speed spreads both: by 95 and 104 in
 * scene 74, most in its first slip, and with it rk8pd is off by 8 times tolerance times steps at 1e-10 to 1e-12
 * (taylor at 1e-14 is off by 3e-12 of x, from Runge and Kutta's method in long double with 12 million steps).
 * Blows on a contact with a gap spread it, too: in scene 1000276 three methods at 1e-14 differ by 2e-3 of x, and
 * the last bit of the mass moves it by 3e-7.  Else nothing spreads: 1. */
static double
growth_of(const trial *t)
{
    const double by = 1e-7;
    if (ss_model_is_linear(t->scene.model)
        || (!ss_model_has_events(t->scene.model) && !(ss_scene_get(&t->scene, "gap") > 0)))
        return 1;
    double most = 1;
    for (int sign = -1; sign <= 1; sign += 2) {
        ss_scene moved = t->scene;
        moved.x0 += sign * by * t->scale;
        moved.phase += by;
        run b = run_alike(t, &moved, 1e-12);
        if (b.status == SS_OK)
            most = fmax(most, difference(&t->run, &b, 1) / (by * t->scale));
        run_free(&b);
    }
    return most;
}

/* A tolerance is kept step by step, and x was off by at most 4 times tolerance times steps, each as many
 * times as the motion spreads it; and a motion that spreads what steps leave at 1e-12 spreads as many times as
 * much of what they leave at a tolerance as many times as large. */
static void
agrees_with_another_method(const trial *t, const char *other, double tol, unsigned long most)
{
    run b = run_with(&t->scene, other, tol, most);
    if (ended(t, &b)) {
        if (t->run.stats.unresolved + b.stats.unresolved == 0 && !same_events(t, &b))
            complain(t->number, &t->scene, "events", (double)b.n_events, (double)t->run.n_events);
        demand(t, "another method's x over its scale", difference(&t->run, &b, 1) / t->scale,
               4 * tol * (double)(b.stats.steps + 100) * growth_of(t) + 16 * (tol / 1e-12) * t->nudged / t->scale);
    }
    run_free(&b);
}

static void
agrees_with_other_methods(const trial *t)
{
    if (ss_model_is_linear(t->scene.model)) {
        agrees_with_another_method(t, "rk8pd", 1e-12, BUDGET);
        agrees_with_another_method(t, "taylor", 1e-12, BUDGET);
    } else if (ss_model_has_events(t->scene.model) && strcmp(t->method, "rk8pd") != 0) {
        agrees_with_another_method(t, "rk8pd", 1e-12, LONG_BUDGET);
    } else if (strcmp(t->method, "radau") == 0) {
        agrees_with_another_method(t, "rk4imp", 1e-8, 2 * RANDOM_STEPS);
    } else {
        agrees_with_another_method(t, "rkck", 1e-10, 2 * RANDOM_STEPS);
    }
}

/* pi is known, and added to the phase, to 4 eps; x is rounded to eps of its scale; and of the steps
 * over the front of tanh, which fall otherwise by the last bit, a few may leave all that they may:
 * one in some twenty runs did, 1e-13 and 1.5e-12. */
static void
is_mirrored(const trial *t)
{
    ss_scene s = t->scene;
    s.x0 = -s.x0;
    s.v0 = -s.v0;
    s.phase += M_PI;
    if (s.friction_negative > 0 || s.static_friction_negative > 0) {        /* the sides change places */
        double other = s.friction_negative > 0 ? s.friction_negative : s.friction;
        double hold = s.static_friction_negative > 0 ? s.static_friction_negative : s.static_friction;
        s.static_friction_negative = fmax(s.static_friction, s.friction);
        s.static_friction = fmax(hold, other);
        s.friction_negative = s.friction;
        s.friction = other;
    }
    run b = run_alike(t, &s, 1e-12);
    if (ended(t, &b))
        demand(t, "mirrored x over its scale", difference(&t->run, &b, -1) / t->scale,
               16 * (DBL_EPSILON + t->nudged / t->scale)
               + (ss_model_is_linear(t->scene.model) ? 0 : 4e-12));
    run_free(&b);
}

/* Powers of two change no rounding. */
static void
does_not_depend_on_the_unit_of_mass(const trial *t)
{
    ss_scene s = t->scene;
    double unit = t->number % 2 ? 0x1p30 : 0x1p-30;
    s.mass *= unit;
    s.stiffness *= unit;
    s.friction *= unit;
    s.static_friction *= unit;
    s.friction_negative *= unit;
    s.static_friction_negative *= unit;
    const scene_key *k;
    for (size_t i = 0; (k = ss_key_at(s.model, i)) != NULL; i++)
        if (ss_key_is_own(k->offset) && k->unit[0] == 'N')
            ss_scene_set(&s, k->name, ss_scene_get(&s, k->name) * unit, NULL);
    run b = run_alike(t, &s, 1e-12);
    if (ended(t, &b))
        demand(t, "x over its scale in another unit of mass",
               difference(&t->run, &b, 1) / t->scale, 0);
    run_free(&b);
}

/* --- energy -------------------------------------------------------------------------------- */

/* A moment of a run, within a mode. */
typedef struct moment {
    double t, x, v, y, f;       /* f: of the friction; y: 0 without contact */
    int mode;
} moment;

typedef struct balance {
    double work, lost, turned_over;     /* by the base, in the friction; sum of all in modulus */
} balance;

/* The power of the base and its rate of change. */
static void
base_power(const ss_scene *s, const moment *at, double power[2])
{
    double w = 2 * M_PI * s->base_frequency, p = w * at->t + s->phase, Z = s->base_amplitude;
    double z = Z * cos(p), dz = -Z * w * sin(p), ddz = -w * w * z, k = s->stiffness;
    power[0] = k * (z - at->x) * dz;
    power[1] = k * (dz - at->v) * dz + k * (z - at->x) * ddz;
}

/* The model's number of this key; 0 if it has none. */
static double
value_of(const ss_scene *s, const char *key)
{
    double x = ss_scene_get(s, key);
    return isnan(x) ? 0 : x;
}

static double
energy(const ss_scene *s, const moment *at)
{
    double z = s->base_amplitude * cos(2 * M_PI * s->base_frequency * at->t + s->phase);
    return s->mass * at->v * at->v / 2 + s->stiffness * (z - at->x) * (z - at->x) / 2
        + value_of(s, "contact_stiffness") * at->y * at->y / 2;
}

static double
acceleration(const ss_scene *s, const moment *at)
{
    double z = s->base_amplitude * cos(2 * M_PI * s->base_frequency * at->t + s->phase);
    return (s->stiffness * (z - at->x) - at->f) / s->mass;
}

/* Of f_k |v| what lies between is known; what the contact's damper takes is c v^2, and what a friction
 * with a state theta v. */
static double
friction_power(const ss_scene *s, const moment *at, double *slope)
{
    double a = acceleration(s, at);
    if (s->model == ss_model_named("state-variable")) {
        double rate = -ss_scene_get(s, "gamma") * (at->f - s->friction * tanh(ss_scene_get(s, "alpha") * at->v));
        *slope = rate * at->v + at->f * a;
        return at->f * at->v;
    }
    *slope = at->mode == 0 ? 2 * value_of(s, "contact_damping") * at->v * a : 0;
    return at->mode == 0 ? value_of(s, "contact_damping") * at->v * at->v : 0;
}

/* From one moment to the next in a mode, by the trapezoidal rule with its first correction. */
static void
add_interval(balance *sum, const ss_scene *s, const moment *a, const moment *b)
{
    double h = b->t - a->t, p[2], q[2], da, db, fa, fb;
    base_power(s, a, p);
    base_power(s, b, q);
    fa = friction_power(s, a, &da);
    fb = friction_power(s, b, &db);
    double work = h / 2 * (p[0] + q[0]) + h * h / 12 * (p[1] - q[1]);
    double lost = h / 2 * (fa + fb) + h * h / 12 * (da - db);
    if (a->mode != 0 && s->model != ss_model_named("state-variable"))
        lost += s->friction * fabs(b->x - a->x);
    sum->work += work;
    sum->lost += lost;
    sum->turned_over += fabs(work) + fabs(lost) + fabs(energy(s, b) - energy(s, a));
}

/* The state of the friction at the time of a sample in the mode of a moment before. */
static moment
later(const ss_scene *s, const moment *from, const ss_sample *sample)
{
    moment at = { sample->t, sample->x, sample->v, from->y, from->f, from->mode };
    if (s->model == ss_model_named("state-variable"))
        at.f = sample->f;
    if (s->model == ss_model_named("compliant") && at.mode == 0) {
        at.y = from->y + (at.x - from->x);
        at.f = ss_scene_get(s, "contact_stiffness") * at.y + ss_scene_get(s, "contact_damping") * at.v;
    }
    return at;
}

/* The same moment after an event: what the contact's spring gives up at a release is lost. */
static moment
after(const ss_scene *s, const moment *before, const ss_event *e, balance *sum)
{
    moment at = *before;
    int side = e->direction;
    at.mode = e->kind == SS_STICK ? 0 : e->direction;
    if (s->model == ss_model_named("compliant"))
        at.y = side * s->friction / ss_scene_get(s, "contact_stiffness");
    at.f = e->kind == SS_STICK && s->model == ss_model_named("coulomb") ? 0 : side * s->friction;
    double given_up = energy(s, before) - energy(s, &at);
    sum->lost += given_up;
    sum->turned_over += fabs(given_up);
    return at;
}

/* Adds the next sample, after the events before it; the moment of it takes the place of the last. */
static void
add_sample(balance *sum, const ss_scene *s, const run *r, size_t i, size_t *e, moment *at)
{
    for (; *e < r->n_events && r->event[*e].t <= r->sample[i].t; ++*e) {
        const ss_event *event = &r->event[*e];
        ss_sample there = { .t = event->t, .x = event->x, .v = event->v };
        if (event->t == 0)
            continue;                   /* a start in slip: the first sample knows */
        moment end = later(s, at, &there);
        add_interval(sum, s, at, &end);
        *at = after(s, &end, event, sum);
    }
    moment next = later(s, at, &r->sample[i]);
    add_interval(sum, s, at, &next);
    *at = next;
}

/* How many samples it takes to see what goes on in a scene: 8 in each of the longest steps; and with
 * a friction that has a state 8 in the time that it takes, or to swing in the front of tanh. */
static double
samples_needed(const ss_scene *s)
{
    if (s->model != ss_model_named("state-variable"))
        return 8 * RANDOM_STEPS;
    double swing = sqrt(ss_scene_get(s, "gamma") * s->friction * ss_scene_get(s, "alpha") / s->mass);
    return fmax(4 * RANDOM_STEPS, 8 * s->duration * fmax(ss_scene_get(s, "gamma"), swing));
}

/* The work of the base is the change of energy and what the friction took.  Power is a product, of
 * twice the frequency: with 320 samples a period of what is fastest, and so 160 of that, the rule is
 * off by (2 pi / 160)^4 / 720 = 3e-9 of what it adds up; rounding of the phase, over 1e3 cycles, by
 * 1e-12.  With a friction that has a state both sums are known as well as they agree with those of
 * every second sample, or a fourth as well, since a kink in the middle of an interval puts both off
 * alike. */
static void
balances_its_energy(const trial *t)
{
    ss_scene s = t->scene;
    balance sum = { 0, 0, 0 }, known = sum;
    double doubt = 0, samples = samples_needed(&s);
    if (samples > MOST_SAMPLES)
        return;
    s.rate = samples / s.duration;
    run r = run_alike(t, &s, 1e-12);
    const ss_sample *first = &r.sample[0];
    moment start = { 0, first->x, first->v, first->y, first->f, first->mode }, at = start, last = at;
    for (size_t i = 1, e = 0; r.status == SS_OK && i < r.n; i++) {
        add_sample(&sum, &s, &r, i, &e, &at);
        if (s.model == ss_model_named("state-variable") && i % 2 == 0) {
            balance coarse = { 0, 0, 0 };
            add_interval(&coarse, &s, &last, &at);
            doubt += fabs(coarse.lost - (sum.lost - known.lost))
                + fabs(coarse.work - (sum.work - known.work));
            known = sum;
            last = at;
        }
    }
    double residue = sum.work - (energy(&s, &at) - energy(&s, &start)) - sum.lost;
    double all = sum.turned_over + energy(&s, &start) + DBL_MIN;
    if (r.status == SS_OK && r.n > 1)
        demand(t, "work that is neither energy nor loss, of what is turned over",
               fabs(residue) / all, 1e-8 + 4 * doubt / all);
    run_free(&r);
}

/* --- the suite ----------------------------------------------------------------------------- */

/* 1 for the models whose losses are in friction_power. */
static int
knows_what_is_lost(const ss_model *model)
{
    return ss_model_is_linear(model) || model == ss_model_named("state-variable");
}

static void
hold_for(const ss_model *model)
{
    size_t first = from_environment("FIRST", 0), n = from_environment("SCENES", DEFAULT_SCENES);
    for (size_t i = 0; i < n + n / 3; i++) {
        uint64_t number = i < n ? first + i : RANDOM_NEWER + first + i - n;
        if (random_scene(number).model != model)
            continue;
        trial t = trial_of(number);
        if (t.scale > 0) {
            agrees_with_other_methods(&t);
            if (ss_key_named(model, "friction") != NULL)        /* a pull has no mirror image: d > 0 */
                is_mirrored(&t);
            does_not_depend_on_the_unit_of_mass(&t);
            if (knows_what_is_lost(model))
                balances_its_energy(&t);
        }
        run_free(&t.run);
    }
}

static void
random_scenes_hold_every_property(void **state)
{
    (void)state;
    for (size_t m = 0; ss_model_at(m) != NULL; m++)
        hold_for(ss_model_at(m));
}

/* --- the manual ---------------------------------------------------------------------------- */

static void
the_manual_shows_the_ranges_drawn_from(void **state)
{
    const char *source = getenv("SRC");
    char path[4096], line[256], row[256];
    (void)state;
    snprintf(path, sizeof path, "%s/man/stickslip-scene.5", source != NULL ? source : ".");
    FILE *in = fopen(path, "r");
    if (in == NULL)
        fail_msg("%s cannot be read: run from the source tree, or set SRC", path);
    const scene_range *r;
    for (size_t m = 0; ss_model_at(m) != NULL; m++)
        for (size_t i = 0; (r = range_of(ss_model_at(m), i)) != NULL; i++) {
            int found = 0;
            snprintf(row, sizeof row, ".It %s Ta %s Ta %g Ta %g Ta %s\n", r->name, r->unit, r->from,
                     r->to, r->zero ? "or 0" : "\\&");
            for (rewind(in); !found && fgets(line, sizeof line, in) != NULL;)
                found = strcmp(line, row) == 0;
            if (!found)
                fail_msg("no row '%s'", row);
        }
    fclose(in);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_scenes_hold_every_property),
        cmocka_unit_test(the_manual_shows_the_ranges_drawn_from),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
