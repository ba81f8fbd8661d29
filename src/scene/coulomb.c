/* coulomb.c -- f = f_k sgn(v) in slip; true stick (stick.c). */
#include <string.h>
#include "scene/models.h"

static const scene_key keys[] = { KEY_STATIC_FRICTION, KEYS_FRICTION_NEGATIVE };

static void
drive(const ss_scene *s, double *memory, const piece *p, double part[])
{
    double way = direction_of(memory, p);
    part[0] = way * kinetic_friction(s, (int)way);
    part[1] = 0;
}

MODEL(coulomb) = {
    .name = "coulomb",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys,
    .dim = 2, .linear = 1,
    .start = ss_stick_start, .fastest = ss_linear_fastest, .rates = ss_linear_rates,
    .jacobian = ss_linear_jacobian, .series = ss_linear_series,
    .still = ss_stick_still, .next = ss_stick_next,
    .sample = ss_stick_sample,
    .variation = &ss_stick_variation, .drive = drive
};

void
ss_to_coulomb(ss_scene *scene)
{
    scene->model = &ss_coulomb_model;
    memset(scene->own, 0, sizeof scene->own);
}
