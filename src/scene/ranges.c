/* ranges.c -- the supported ranges of scenes, in the quantities on which a motion depends.
 *
 * Other units of mass, length and time change only the rounding, so the important ranges are those
 * of ratios.  The ranges of m, omega_n and X only prevent overflow.  tests/test_random.c draws its
 * scenes from this table, and stickslip-scene(5) shows it. */
#include "base/error.h"
#include "scene/model.h"
#include "scene/scene.h"

double
ss_unit_one(const ss_scene *s)
{
    (void)s;
    return 1;
}

double
ss_unit_stiffness(const ss_scene *s)
{
    return s->stiffness;
}

double
ss_unit_length(const ss_scene *s)
{
    return amplitude_of(s);
}

double
ss_unit_speed(const ss_scene *s)
{
    return own_frequency(s) * amplitude_of(s);
}

double
ss_unit_contact(const ss_scene *s)
{
    double X = amplitude_of(s);
    return X > 0 && s->friction > 0 ? s->friction / X : s->stiffness;
}

double
ss_unit_damping(const ss_scene *s)
{
    return 2 * sqrt(s->stiffness) * sqrt(s->mass);
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

#define NUMBER(field) offsetof(ss_scene, field)
static const ss_scene_range of_every[] = {
    { "m", "kg", 1e-12, 1e12, 0, NUMBER(mass), ss_unit_one },
    { "omega_n/(2 pi)", "Hz", 1e-9, 1e9, 0, 0, hertz },
    { "X", "m", 1e-15, 1e9, 1, 0, ss_unit_length },
    { "Omega/omega_n", "1", 1e-3, 1e3, 1, NUMBER(base_frequency), hertz },
    { "f_k/(k X)", "1", 1e-3, 10, 1, NUMBER(friction), force },
    { "f_s/f_k", "1", 1, 10, 0, 0, hold },
    { "d/(2 sqrt(k m))", "1", 1e-4, 100, 1, NUMBER(damping), ss_unit_damping },
    { "|U|/(omega_n X)", "1", 1e-3, 1, 1, NUMBER(base_velocity), ss_unit_speed },
    { "|S|/(omega_n X)", "1", 1e-3, 1, 1, NUMBER(surface_velocity), ss_unit_speed },
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

double
ss_range_value(const ss_scene_range *r, const ss_scene *s)
{
    double of = r->of(s);
    if (r->offset == 0)
        return of;
    return of > 0 ? fabs(number_of(s, r->offset)) / of : NAN;
}

int
ss_range_set(const ss_scene_range *r, ss_scene *s, double x)
{
    double of = r->of(s);
    if (!ss_key_is_own(r->offset))
        return 0;
    *number_at(s, r->offset) = x * (of > 0 ? of : 1);
    return 1;
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
        double x = ss_range_value(r, scene);
        if (!(x < r->from * (1 - 1e-9) || x > r->to * (1 + 1e-9)) || (x == 0 && r->zero))
            continue;
        return ss_fail(err, SS_EINVAL, "%s = %.3g lies outside %g ... %g, for which results are "
                       "tested", r->name, x, r->from, r->to);
    }
    return SS_OK;
}
