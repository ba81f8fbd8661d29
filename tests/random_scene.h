/* random_scene.h -- scenes drawn log-uniformly from the ranges that the library says it supports. */
#ifndef RANDOM_SCENE_H
#define RANDOM_SCENE_H

#include <math.h>
#include <stdint.h>
#include <string.h>
#include <stickslip.h>

enum { RANDOM_SAMPLES = 400, RANDOM_STEPS = 4000 };

typedef struct rng { uint64_t s; } rng;

/* splitmix64 (Steele, Lea & Flood 2014) */
static inline double
uniform(rng *r)
{
    uint64_t z = r->s += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

/* Within the named range; one time in eight 0, where that is in it. */
static inline double
draw(rng *r, const char *name)
{
    const ss_scene_range *range = NULL;
    for (size_t m = 0; range == NULL; m++)
        for (size_t i = 0; (range = ss_model_range(ss_model_at(m), i)) != NULL && strcmp(range->name, name) != 0;)
            i++;
    double u = uniform(r), zero = uniform(r);
    return range->zero && zero < 0.125 ? 0 : range->from * pow(range->to / range->from, u);
}

static inline ss_scene
random_scene(uint64_t number)
{
    rng r = { number * UINT64_C(0xd1342543de82ef95) + 1 };
    ss_scene s = ss_scene_defaults;
    double omega = 2 * M_PI * draw(&r, "omega_n/(2 pi)"), X = draw(&r, "X");
    s.model = ss_model_at((size_t)(3 * uniform(&r)));
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
    double fastest = fmax(1, base);
    if (s.model == ss_model_named("compliant")) {
        ss_scene_set(&s, "contact_stiffness", draw(&r, "K_y/k") * s.stiffness, NULL);
        double k = s.stiffness + ss_scene_get(&s, "contact_stiffness"), zeta = draw(&r, "c/(2 sqrt((k + K_y) m))");
        ss_scene_set(&s, "contact_damping", zeta * 2 * sqrt(k) * sqrt(s.mass), NULL);
        ss_scene_set_text(&s, "release", uniform(&r) < 0.5 ? "spring" : "total", NULL);
        fastest = fmax(fastest, sqrt(k / s.stiffness) * (zeta + sqrt(fmax(1, zeta * zeta))));
    } else if (s.model == ss_model_named("state-variable")) {
        ss_scene_set(&s, "alpha", draw(&r, "alpha X omega_n") / (X > 0 ? X * omega : 1), NULL);
        ss_scene_set(&s, "gamma", draw(&r, "gamma/omega_n") * omega, NULL);
    }
    /* ten of the slowest periods, or RANDOM_STEPS of the longest steps if that is less */
    double slow = base > 0 ? fmin(1, base) : 1;
    s.duration = fmin(10 / slow, RANDOM_STEPS / 40. / fastest) * 2 * M_PI / omega;
    s.rate = RANDOM_SAMPLES / s.duration;
    return s;
}

static inline double
between(rng *r, double from, double to)
{
    return from * pow(to / from, uniform(r));
}

/* One time in two none of it; else of either sign, if that is asked for. */
static inline double
perhaps(rng *r, double from, double to, int is_signed)
{
    double x = between(r, from, to), sign = is_signed && uniform(r) < .5 ? -1 : 1;
    return uniform(r) < .5 ? 0 : sign * x;
}

enum { RIG_PERIODS = 30, RIG_SAMPLES = 300 };

/* Coulomb and compliant scenes with all keys, each of which one time in two does nothing. */
static inline ss_scene
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

#endif
