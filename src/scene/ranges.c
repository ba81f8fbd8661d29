/* ranges.c -- the supported ranges of scenes, in the quantities on which a motion depends.
 *
 * Other units of mass, length and time change only the rounding, so the important ranges are those
 * of ratios.  The ranges of m, omega_n and X only prevent overflow.  tests/test_random.c draws its
 * scenes from this table, and stickslip-scene(5) shows it. */
#include "base/error.h"
#include "scene/model.h"

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
base_speed(const ss_scene *s)
{
    return 2 * M_PI * s->base_frequency / own_frequency(s);
}

static double
friction(const ss_scene *s)
{
    double X = amplitude_of(s);
    return X > 0 ? s->friction / s->stiffness / X : NAN;
}

static double
damping(const ss_scene *s)
{
    return s->damping / (2 * sqrt(s->stiffness) * sqrt(s->mass));
}

static double
speed(const ss_scene *s, double v)
{
    double X = amplitude_of(s);
    return X > 0 ? fabs(v) / own_frequency(s) / X : NAN;
}

static double
base_velocity(const ss_scene *s)
{
    return speed(s, s->base_velocity);
}

static double
surface_velocity(const ss_scene *s)
{
    return speed(s, s->surface_velocity);
}

static double
hold(const ss_scene *s)
{
    return s->static_friction > 0 && s->friction > 0 ? s->static_friction / s->friction : NAN;
}

static const ss_scene_range of_every[] = {
    { "m", "kg", 1e-12, 1e12, 0, mass, NULL },
    { "omega_n/(2 pi)", "Hz", 1e-9, 1e9, 0, hertz, NULL },
    { "X", "m", 1e-15, 1e9, 1, amplitude_of, NULL },
    { "Omega/omega_n", "1", 1e-3, 1e3, 1, base_speed, NULL },
    { "f_k/(k X)", "1", 1e-3, 10, 1, friction, NULL },
    { "f_s/f_k", "1", 1, 10, 0, hold, NULL },
    { "d/(2 sqrt(k m))", "1", 1e-4, 100, 1, damping, NULL },
    { "|U|/(omega_n X)", "1", 1e-3, 1, 1, base_velocity, NULL },
    { "|S|/(omega_n X)", "1", 1e-3, 1, 1, surface_velocity, NULL },
};
enum { OF_EVERY = sizeof of_every / sizeof *of_every };

const ss_scene_range *
ss_model_range(const ss_model *m, size_t i)
{
    if (m == NULL)
        return NULL;
    if (i < OF_EVERY)
        return &of_every[i];
    return i - OF_EVERY < m->n_ranges ? &m->ranges[i - OF_EVERY] : NULL;
}

ss_status
ss_scene_supported(const ss_scene *scene, ss_error *err)
{
    if (scene == NULL)
        return SS_FAIL_NULL(err);
    if (scene->model == NULL)
        return ss_fail(err, SS_EINVAL, "model is no known choice");
    const ss_scene_range *r;
    for (size_t i = 0; (r = ss_model_range(scene->model, i)) != NULL; i++) {
        double x = r->value(scene);
        if (!(x < r->from * (1 - 1e-9) || x > r->to * (1 + 1e-9)) || (x == 0 && r->zero))
            continue;
        return ss_fail(err, SS_EINVAL, "%s = %.3g lies outside %g ... %g, for which results are "
                       "tested", r->name, x, r->from, r->to);
    }
    return SS_OK;
}
