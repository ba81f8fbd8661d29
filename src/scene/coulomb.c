/* coulomb.c -- f = f_k sgn(v) in slip; true stick (stick.c). */
#include "scene/model.h"

static const scene_key keys[] = { KEY_STATIC_FRICTION };

void
ss_to_coulomb(ss_scene *scene)
{
    scene->model = SS_COULOMB;
}

/* A stick forgets v and the time at which it began, and it ends later where x is further on: then v is
 * behind by what the drop of the friction has done since. */
static void
cross(const state *m, int mode, const double q[], const double before[], const double after[],
      double d[D_MOST][D_MOST])
{
    const ss_scene *s = m->scene;
    (void)q;
    for (int i = 0; i < D_MOST; i++)
        if (mode != 0)
            d[D_V][i] *= m->mode == 0 ? 0 : after[1] / before[1];
        else if (static_friction(s) > s->friction)
            d[D_V][i] = -after[1] * s->stiffness * d[D_Q][i] / base_force_rate(m, m->u);
}

static const struct variation variation = { ss_stick_free, cross, ss_stick_move };

const struct model ss_coulomb_model = {
    .name = "coulomb",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys,
    .dim = 2, .linear = 1,
    .start = ss_stick_start, .fastest = ss_linear_fastest, .rates = ss_linear_rates,
    .jacobian = ss_linear_jacobian, .derivatives = ss_linear_derivatives,
    .series = ss_linear_series,
    .guard = ss_linear_slip_guard, .still = ss_stick_still, .next = ss_stick_next,
    .sample = ss_stick_sample,
    .variation = &variation
};
