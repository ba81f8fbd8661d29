/* random_scene.c -- draw scenes; a model is drawn by its own table of keys, and by its ranges here. */
#include "random_scene.h"

#include "scene/model.h"
#include "scene/scene.h"
#include "scene_word.h"

/* --- the ranges -------------------------------------------------------------------------------- */

static double
one(const ss_scene *s)
{
    (void)s;
    return 1;
}

static double
spring(const ss_scene *s)
{
    return s->stiffness;
}

static double
length(const ss_scene *s)
{
    return amplitude_of(s);
}

static double
speed(const ss_scene *s)
{
    return own_frequency(s) * amplitude_of(s);
}

static double
per_speed(const ss_scene *s)
{
    return speed(s) > 0 ? 1 / speed(s) : 0;
}

static double
per_length(const ss_scene *s)
{
    double X = amplitude_of(s);
    return X > 0 && s->friction > 0 ? s->friction / X : s->stiffness;
}

static double
critical(const ss_scene *s)
{
    return 2 * sqrt(s->stiffness) * sqrt(s->mass);
}

static double
critical_on(const ss_scene *s, const char *contact)
{
    return 2 * sqrt(s->stiffness + ss_scene_get(s, contact)) * sqrt(s->mass);
}

static double
critical_contact(const ss_scene *s)
{
    return critical_on(s, "contact_stiffness");
}

static double
critical_bristles(const ss_scene *s)
{
    return critical_on(s, "bristle_stiffness");
}

static double
contact(const ss_scene *s)
{
    return ss_scene_get(s, "contact_stiffness");
}

static double
hertz(const ss_scene *s)
{
    return own_frequency(s) / (2 * M_PI);
}

static double
force(const ss_scene *s)
{
    return s->stiffness * amplitude_of(s);
}

static double
hold(const ss_scene *s)
{
    return s->static_friction > 0 && s->friction > 0 ? s->static_friction / s->friction : NAN;
}

static double
relaxation(const ss_scene *s)
{
    int literal = strcmp(scene_word(s, "law"), "literal") == 0;
    return own_frequency(s) / (literal && s->friction > 0 ? s->friction : 1);
}

static double
reference(const ss_scene *s)
{
    return ss_scene_get(s, "reference_friction");
}

static double
direct(const ss_scene *s)
{
    return ss_scene_get(s, "direct_effect");
}

static double
load(const ss_scene *s)
{
    return s->stiffness * s->base_velocity / own_frequency(s) / reference(s);
}

static double
pull(const ss_scene *s)
{
    return s->base_velocity;
}

static double
distance(const ss_scene *s)
{
    return ss_scene_get(s, "normal_force") * direct(s) / s->stiffness;
}

/* Other units of mass, length and time change only the rounding, so the important ranges are those of ratios.
 * The ranges of m, omega_n and X only prevent overflow. */
static const scene_range ranges[] = {
    { "m", "kg", 1e-12, 1e12, 0, "mass", one, NULL },
    { "omega_n/(2 pi)", "Hz", 1e-9, 1e9, 0, NULL, hertz, NULL },
    { "X", "m", 1e-15, 1e9, 1, NULL, length, NULL },
    { "Omega/omega_n", "1", 1e-3, 1e3, 1, "base_frequency", hertz, NULL },
    { "f_k/(k X)", "1", 1e-3, 10, 1, "friction", force, NULL },
    { "f_s/f_k", "1", 1, 10, 0, NULL, hold, NULL },
    { "d/(2 sqrt(k m))", "1", 1e-4, 100, 1, "damping", critical, NULL },
    { "|U|/(omega_n X)", "1", 1e-3, 1, 1, "base_velocity", speed, NULL },
    { "|S|/(omega_n X)", "1", 1e-3, 1, 1, "surface_velocity", speed, NULL },
    { "alpha X omega_n", "1", 0.1, 1e6, 0, "alpha", per_speed, "state-variable" },
    { "gamma/omega_n", "1", 1e-2, 1e8, 0, "gamma", relaxation, "state-variable" },
    { "K_y/k", "1", 1e-2, 1e8, 0, "contact_stiffness", spring, "compliant" },
    { "c/(2 sqrt((k + K_y) m))", "1", 1e-4, 100, 1, "contact_damping", critical_contact, "compliant" },
    { "K_y-/K_y", "1", 0.1, 10, 1, "contact_stiffness_negative", contact, "compliant" },
    { "b/X", "1", 1e-3, 1, 1, "gap", length, "compliant" },
    { "delta", "1", 1, 4, 1, "stribeck_exponent", one, "stribeck" },
    { "v_s/(omega_n X)", "1", 1e-3, 1e3, 0, "stribeck_velocity", speed, "stribeck" },
    { "sigma_0 X/f_k", "1", 1, 1e5, 0, "bristle_stiffness", per_length, "lugre" },
    { "sigma_1/(2 sqrt((k + sigma_0) m))", "1", 1e-3, 1, 1, "bristle_damping", critical_bristles, "lugre" },
    { "sigma_2/(2 sqrt(k m))", "1", 1e-3, 1, 1, "viscous_friction", critical, "lugre" },
    { "v_s/(omega_n X)", "1", 1e-3, 1e3, 0, "stribeck_velocity", speed, "lugre" },
    { "K X/f_k", "1", 1e-1, 1e4, 0, "contact_stiffness", per_length, "bouc-wen" },
    { "n", "1", 0.5, 20, 0, "exponent", one, "bouc-wen" },
    { "p", "1", 0.5, 1, 0, "beta_fraction", one, "bouc-wen" },
    { "b/X", "1", 1e-3, 1, 1, "gap", length, "bouc-wen" },
    { "mu0", "1", 0.1, 1, 0, "reference_friction", one, "rate-and-state" },
    { "a/mu0", "1", 1e-3, 0.03, 0, "direct_effect", reference, "rate-and-state" },
    { "b/a", "1", 0.1, 2, 1, "evolution_effect", direct, "rate-and-state" },
    { "mu0 N omega_n/(k U)", "1", 3, 1e4, 0, "normal_force", load, "rate-and-state" },
    { "k Dc/(a N)", "1", 0.03, 100, 0, "critical_slip_distance", distance, "rate-and-state" },
    { "V0/U", "1", 1e-4, 1e4, 0, "reference_velocity", pull, "rate-and-state" },
};

const scene_range *
range_of(const ss_model *model, size_t i)
{
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++)
        if ((ranges[k].model == NULL || strcmp(ranges[k].model, model->name) == 0) && i-- == 0)
            return &ranges[k];
    return NULL;
}

const char *
outside_of(const ss_scene *s)
{
    const scene_range *r;
    for (size_t i = 0; (r = range_of(s->model, i)) != NULL; i++) {
        double of = r->of(s), x = r->key == NULL ? of : of > 0 ? fabs(ss_scene_get(s, r->key)) / of : NAN;
        if ((x < r->from * (1 - 1e-9) || x > r->to * (1 + 1e-9)) && !(x == 0 && r->zero))
            return r->name;
    }
    return NULL;
}

/* --- drawing ----------------------------------------------------------------------------------- */

/* Within the range; one time in eight 0, where that is in it. */
static double
draw_within(rng *r, const scene_range *range)
{
    double u = uniform(r), zero = uniform(r);
    return range->zero && zero < 0.125 ? 0 : range->from * pow(range->to / range->from, u);
}

/* Within the named range of every model. */
static double
draw(rng *r, const char *name)
{
    const scene_range *range;
    for (size_t i = 0; (range = range_of(ss_model_at(0), i)) != NULL && strcmp(range->name, name) != 0;)
        i++;
    return draw_within(r, range);
}

/* Draw the numbers and words of the scene's model, whichever it is, by its own table.  The older scenes have no
 * terms. */
static void
draw_own(rng *r, ss_scene *s, int has_terms)
{
    const scene_range *range;
    for (size_t i = 0; i < s->model->n_keys; i++) {
        const scene_key *k = &s->model->keys[i];
        size_t words = 0;
        while (ss_key_word(k, words) != NULL)
            words++;
        if (k->required == TERM && !has_terms)
            continue;
        if (words > 0 && s->model->normalise == NULL)   /* else its ranges are those of the first word */
            ss_scene_set_text(s, k->name, ss_key_word(k, (size_t)((double)words * uniform(r))), NULL);
    }
    if (ss_scene_get(s, "static_friction") == 0 && !s->model->linear)
        s->static_friction = draw(r, "f_s/f_k") * s->friction;
    for (size_t i = 0; (range = range_of(s->model, i)) != NULL; i++)
        if (range->model != NULL && (has_terms || ss_key_named(s->model, range->key)->required != TERM)) {
            double of = range->of(s);
            ss_scene_set(s, range->key, draw_within(r, range) * (of > 0 ? of : 1), NULL);
        }
    if (has_terms && ss_key_named(s->model, "friction_negative") != NULL) {
        s->friction_negative = perhaps(r, .3, 3, 0) * s->friction;
        s->static_friction_negative = perhaps(r, 1, 10, 0) * fmax(s->friction, s->friction_negative);
    }
}

/* The fastest motion of the scene, in units of its own frequency. */
static double
fastest_of(const ss_scene *s)
{
    ss_scene still = *s;                /* the fastest mode of a contact is a stick */
    still.v0 = still.surface_velocity;
    state m = ss_state_of(&still, 1e-12);
    m.model->start(&m);
    return m.model->fastest(&m, NULL) / own_frequency(s);
}

ss_scene
random_scene(uint64_t number)
{
    rng r = { number * UINT64_C(0xd1342543de82ef95) + 1 };
    ss_scene s = ss_scene_defaults;
    double omega = 2 * M_PI * draw(&r, "omega_n/(2 pi)"), X = draw(&r, "X");
    size_t models = 0, first = number < RANDOM_NEWER ? 0 : RANDOM_OLDER - 1;
    while (ss_model_at(first + models) != NULL && (first > 0 || models < RANDOM_OLDER))
        models++;
    s.model = ss_model_at(first + (size_t)((double)models * uniform(&r)));
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
    double largest = fmax(s.base_amplitude, fmax(fabs(s.x0), fabs(s.v0) / omega));
    if (largest > 0) {
        s.base_amplitude *= X / largest;
        s.x0 *= X / largest;
        s.v0 *= X / largest;
    }
    s.friction = draw(&r, "f_k/(k X)") * s.stiffness * X;
    if (ss_key_named(s.model, "friction") == NULL) {        /* the rig is a pull alone, near its steady slide */
        s.base_velocity = (X > 0 ? X : 1) * omega;
        s.v0 = s.base_velocity * between(&r, .5, 1);
        s.friction = s.base_amplitude = s.base_frequency = s.phase = s.x0 = 0;
    }
    draw_own(&r, &s, number >= RANDOM_NEWER);
    double fastest = fastest_of(&s);
    /* ten of the slowest periods, or RANDOM_STEPS of the longest steps if that is less */
    double slow = base > 0 ? fmin(1, base) : 1;
    s.duration = fmin(10 / slow, RANDOM_STEPS / 40. / fastest) * 2 * M_PI / omega;
    s.rate = RANDOM_SAMPLES / s.duration;
    return s;
}

ss_scene
random_rig(uint64_t number)
{
    rng r = { number * UINT64_C(0xd1342543de82ef95) + 7 };
    ss_scene s = ss_scene_defaults;
    double omega = between(&r, 1, 100), X = between(&r, 1e-6, 1e-2), fastest = 1, zeta;
    s.model = ss_model_named(uniform(&r) < .5 ? "coulomb" : "compliant");
    s.mass = between(&r, 1e-3, 1e3);
    s.stiffness = s.mass * omega * omega;
    s.friction = between(&r, .01, 2) * s.stiffness * X;
    s.static_friction = uniform(&r) < .5 ? 0 : s.friction * between(&r, 1, 3);
    zeta = perhaps(&r, 1e-3, 3, 0);
    s.damping = zeta * 2 * s.mass * omega;
    fastest = fmax(fastest, zeta + sqrt(fmax(0, zeta * zeta - 1)));
    s.base_velocity = perhaps(&r, 1e-3, 1, 1) * X * omega;
    s.surface_velocity = perhaps(&r, 1e-3, 1, 1) * X * omega;
    if (uniform(&r) < .75) {
        double ratio = between(&r, .1, 10);
        if (fabs(ratio - 1) < .2)
            ratio += .4;
        s.base_frequency = ratio * omega / (2 * M_PI);
        s.base_amplitude = between(&r, .1, 3) * X;
        s.phase = 2 * M_PI * uniform(&r);
        fastest = fmax(fastest, ratio);
    }
    if (uniform(&r) < .5) {
        s.x0 = X * (2 * uniform(&r) - 1);
        s.v0 = X * omega * (2 * uniform(&r) - 1);
    } else {
        s.v0 = uniform(&r) < .5 ? s.surface_velocity : 0;
    }
    if (s.model == ss_model_named("compliant")) {
        ss_scene_set(&s, "contact_stiffness", between(&r, .5, 300) * s.stiffness, NULL);
        double k = s.stiffness + ss_scene_get(&s, "contact_stiffness"), c = between(&r, 1e-3, 2);
        ss_scene_set(&s, "contact_damping", c * 2 * sqrt(k * s.mass), NULL);
        ss_scene_set_text(&s, "release", uniform(&r) < .5 ? "spring" : "total", NULL);
        double all = (ss_scene_get(&s, "contact_damping") + s.damping) / (2 * sqrt(k * s.mass));
        fastest = fmax(fastest, sqrt(k / s.stiffness) * (all + sqrt(fmax(1, all * all) - 1)));
        fastest = fmax(fastest, sqrt(k / s.stiffness));
    }
    s.duration = RIG_PERIODS / fastest * 2 * M_PI / omega;
    s.rate = RIG_SAMPLES / s.duration;
    return s;
}

ss_scene
random_contact(uint64_t number)
{
    rng r = { number * UINT64_C(0xd1342543de82ef95) + 11 };
    ss_scene s = random_rig(number ^ UINT64_C(0x5bd1e995));
    double X = fmax(s.base_amplitude, s.friction / s.stiffness);
    s.friction_negative = perhaps(&r, .3, 3, 0) * s.friction;
    s.static_friction_negative = perhaps(&r, 1, 3, 0) * fmax(s.friction_negative, s.friction);
    if (s.model == ss_model_named("compliant")) {
        ss_scene_set(&s, "gap", perhaps(&r, 1e-3, 1, 0) * X, NULL);
        ss_scene_set(&s, "contact_stiffness_negative",
                     perhaps(&r, .3, 1, 0) * ss_scene_get(&s, "contact_stiffness"), NULL);
    }
    return s;
}
