/* ranges.c -- over which ranges scenes are supported, in the measures that a motion depends on.
 *
 * Units of mass, length and time change nothing but rounding, so the ranges that matter are those of
 * the ratios; m, omega_n and X are there for overflow alone.  tests/test_random.c draws its scenes
 * from this table and stickslip-scene(5) shows it. */
#include <math.h>
#include <stickslip/scene.h>
#include "base/error.h"

static double
own_frequency(const ss_scene *s)
{
    return sqrt(s->stiffness / s->mass);
}

static double
mass(const ss_scene *s)
{
    return s->mass;
}

static double
hertz(const ss_scene *s)
{
    return own_frequency(s) / (2 * M_PI);
}

static double
amplitude(const ss_scene *s)
{
    return fmax(s->base_amplitude, fmax(fabs(s->x0), fabs(s->v0) / own_frequency(s)));
}

static double
base_speed(const ss_scene *s)
{
    return 2 * M_PI * s->base_frequency / own_frequency(s);
}

static double
friction(const ss_scene *s)
{
    double X = amplitude(s);
    return X > 0 ? s->friction / s->stiffness / X : NAN;
}

static double
contact(const ss_scene *s)
{
    return s->contact_stiffness / s->stiffness;
}

static double
damping(const ss_scene *s)
{
    double k = s->stiffness + s->contact_stiffness;
    return s->contact_damping / (2 * sqrt(k) * sqrt(s->mass));
}

static double
steepness(const ss_scene *s)
{
    double X = amplitude(s);
    return X > 0 ? s->alpha * X * own_frequency(s) : NAN;
}

static double
relaxation(const ss_scene *s)
{
    double rate = s->law == SS_LAW_LITERAL ? s->gamma * s->friction : s->gamma;
    return rate / own_frequency(s);
}

enum { STATE = 1 << SS_STATE_VARIABLE, COMPLIANT = 1 << SS_COMPLIANT,
       EVERY = 1 << SS_COULOMB | STATE | COMPLIANT };

const ss_scene_range ss_scene_ranges[] = {
    { "m", "kg", EVERY, 1e-12, 1e12, 0, mass },
    { "omega_n/(2 pi)", "Hz", EVERY, 1e-9, 1e9, 0, hertz },
    { "X", "m", EVERY, 1e-15, 1e9, 1, amplitude },
    { "Omega/omega_n", "1", EVERY, 1e-3, 1e3, 1, base_speed },
    { "f_k/(k X)", "1", EVERY, 1e-3, 10, 1, friction },
    { "K_y/k", "1", COMPLIANT, 1e-2, 1e8, 0, contact },
    { "c/(2 sqrt((k + K_y) m))", "1", COMPLIANT, 1e-4, 100, 1, damping },
    { "alpha X omega_n", "1", STATE, 0.1, 1e6, 0, steepness },
    { "gamma/omega_n", "1", STATE, 1e-2, 1e8, 0, relaxation },
    { NULL, NULL, 0, 0, 0, 0, NULL }
};

ss_status
ss_scene_supported(const ss_scene *scene, ss_error *err)
{
    if (scene == NULL)
        return SS_FAIL_NULL(err);
    if ((unsigned)scene->model > SS_COMPLIANT)
        return ss_fail(err, SS_EINVAL, "model is no known choice");
    for (const ss_scene_range *r = ss_scene_ranges; r->name != NULL; r++) {
        if ((r->models & 1u << scene->model) == 0)
            continue;
        double x = r->value(scene);
        if (!(x < r->from * (1 - 1e-9) || x > r->to * (1 + 1e-9)) || (x == 0 && r->zero))
            continue;
        return ss_fail(err, SS_EINVAL, "%s = %.3g lies outside %g ... %g, for which results are "
                       "tested", r->name, x, r->from, r->to);
    }
    return SS_OK;
}
