/* forced.c -- a scene whose base moves, and its variants.
 *
 * The parameters of the measured rig differ from those of the scene by some tenths, so a model is
 * judged by its best fit within this range.  Motion is proportional to f_k and Z_e together, if alpha
 * decreases as they increase: two to four numbers, and size and phase, remain to be found. */
#include "fit/forced.h"

#include <math.h>
#include "base/error.h"
#include "scene/model.h"

/* Parameter i of the model. */
static double *
own(const forced *c, ss_scene *s, size_t i)
{
    return number_at(s, c->model->parameter[i].offset);
}

static double
drive_of(const ss_scene *scene)
{
    return scene->stiffness * scene->base_amplitude;
}

/* f_s over f_k, which no change of f_k changes. */
static double
static_ratio(const ss_scene *scene)
{
    return scene->friction > 0 ? static_friction(scene) / scene->friction : 1;
}

ss_status
ss_forced_check(const ss_scene *scene, ss_error *err)
{
    ss_scene rest = *scene;
    ss_status st = ss_scene_check(scene, err);
    if (st == SS_OK && ss_scene_is_pulled(scene))
        return ss_fail(err, SS_EINVAL, "pulled scenes are ranked among themselves only, and fitted by their "
                       "slips");
    if (st == SS_OK && !(drive_of(scene) > 0))
        return ss_fail(err, SS_EINVAL, "base_amplitude = 0: such a scene has no cycle to compare");
    rest.damping = rest.static_friction = 0;            /* terms that are held; no other is allowed for */
    const char *term = st == SS_OK ? ss_scene_term(&rest) : NULL;
    return term == NULL ? st : ss_fail(err, SS_EINVAL, "a scene with %s is not adjusted to a signal", term);
}

forced
ss_forced_of(const ss_scene *scene, int pick, double factor)
{
    forced c = { .model = scene->model, .scene = *scene, .pick = pick, .budget = INFINITY };
    ss_scene *s = &c.scene;
    if (c.model->normalise != NULL)
        c.model->normalise(s);
    double key[FORCED_KEYS] = { s->stiffness, s->friction / drive_of(s) };
    c.n = FORCED_OWN + c.model->n_parameters;
    for (size_t i = 0; i < c.model->n_parameters; i++)
        key[FORCED_OWN + i] = *own(&c, s, i);
    for (size_t i = 0; i < c.n; i++) {
        int by_speed = i >= FORCED_OWN && c.model->parameter[i - FORCED_OWN].by_speed != 0;
        double wide = log(factor) * (by_speed ? 1.5 : 1);   /* the speed is as free as Z_e is */
        c.own[i] = log(fmax(key[i], 1e-300));   /* no friction or damping is as good as too little to see */
        c.range[i] = (ss_range){ c.own[i] - wide, c.own[i] + wide };
    }
    double most = -log(static_ratio(s));
    if (c.range[FORCED_RATIO].from < most)      /* f_s > k Z_e: nothing slips */
        c.range[FORCED_RATIO].to = fmin(c.range[FORCED_RATIO].to, most);
    return c;
}

ss_scene
ss_forced_scene(const forced *c, const double key[FORCED_KEYS], double period)
{
    ss_scene s = c->scene;
    double drive = drive_of(&s);
    s.stiffness = exp(key[FORCED_STIFFNESS]);
    s.base_amplitude = drive / s.stiffness;
    s.friction = drive * exp(key[FORCED_RATIO]);
    s.static_friction = s.static_friction > 0 ? s.friction * static_ratio(&c->scene) : 0;
    s.base_frequency = 1 / period;
    for (size_t i = 0; i < c->model->n_parameters; i++)
        *own(c, &s, i) = exp(key[FORCED_OWN + i]);
    s.phase = s.x0 = s.v0 = 0;
    s.settle = FORCED_SETTLE * period;
    return s;
}

ss_scene
ss_forced_resized(const forced *c, ss_scene s, double size)
{
    s.friction *= size;
    s.static_friction *= size;
    s.base_amplitude *= size;
    s.x0 *= size;
    s.v0 *= size;
    for (size_t i = 0; i < c->model->n_parameters; i++)
        *own(c, &s, i) *= pow(size, -c->model->parameter[i].by_speed);
    return s;
}

double
ss_forced_distance(const forced *c, const double key[FORCED_KEYS])
{
    double sum = 0, of_mass = 0, squares = 0;
    for (size_t i = 0; i < c->n; i++) {
        double d = key[i] - c->own[i];
        int by_mass = i == FORCED_STIFFNESS || (i >= FORCED_OWN && c->model->parameter[i - FORCED_OWN].by_mass);
        sum += by_mass ? d : 0;
        of_mass += by_mass;
        squares += d * d;
    }
    /* d + mu for those that go by mass, and mu: least at mu = -sum / (of_mass + 1) */
    return sqrt(fmax(squares - sum * sum / (of_mass + 1), 0) / (double)(c->n + 1));
}

const char *
ss_forced_key_name(const forced *c, size_t key)
{
    return key == FORCED_STIFFNESS ? "stiffness" : key == FORCED_RATIO ? "friction / (stiffness base_amplitude)"
        : ss_key_of_field(c->model, c->model->parameter[key - FORCED_OWN].offset)->name;
}
