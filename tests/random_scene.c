/* random_scene.c -- draw scenes; a model is drawn by its own table of keys and ranges. */
#include "random_scene.h"

#include "scene/model.h"
#include "scene/scene.h"

/* Within the range; one time in eight 0, where that is in it. */
static double
draw_within(rng *r, const ss_scene_range *range)
{
    double u = uniform(r), zero = uniform(r);
    return range->zero && zero < 0.125 ? 0 : range->from * pow(range->to / range->from, u);
}

/* Within the named range of every model. */
static double
draw(rng *r, const char *name)
{
    const ss_scene_range *range;
    for (size_t i = 0; (range = ss_model_range(ss_model_at(0), i)) != NULL && strcmp(range->name, name) != 0;)
        i++;
    return draw_within(r, range);
}

/* Draw the numbers and words of the scene's model, whichever it is, by its own table.  The older scenes have no
 * terms. */
static void
draw_own(rng *r, ss_scene *s, int has_terms)
{
    const ss_scene_range *range;
    for (size_t i = 0; i < s->model->n_keys; i++) {
        const scene_key *k = &s->model->keys[i];
        size_t words = 0;
        while (k->word != NULL && k->word(words) != NULL)
            words++;
        if (k->required == TERM && !has_terms)
            continue;
        if (words > 0 && s->model->normalise == NULL)   /* else its ranges are those of the first word */
            ss_scene_set_text(s, k->name, k->word((size_t)((double)words * uniform(r))), NULL);
    }
    if (ss_scene_get(s, "static_friction") == 0 && !s->model->linear)
        s->static_friction = draw(r, "f_s/f_k") * s->friction;
    for (size_t i = 0; (range = ss_model_range(s->model, i)) != NULL; i++)
        if (ss_key_is_own(range->offset)
            && (has_terms || ss_key_of_field(s->model, range->offset)->required != TERM))
            ss_range_set(range, s, draw_within(r, range));
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
