/* pull.c -- a slider pulled at constant speed, from the force of its spring.
 *
 * In every measured pull, friction differs from slip to slip.  So the record does not repeat
 * itself, and no single motion fits it.
 *
 * Without damping, each slip is the motion of the Coulomb slider (src/find/slip.c), with its
 * own static and kinetic friction and its own k/m; each stick has the slope k (U - S).  Slips that
 * show a damping, or friction that falls with speed, are not explained.  The fitted
 * scene has the medians.  Its stiffness is that given: the force shows only k U and k/m, so mass
 * and speed follow from it and can be compared with those given.  With damping, or with another
 * model, slips have no closed form, or none with so few unknowns.  The scene is then simulated and
 * fitted to some slips together (pulled.c). */
#include "fit/pulled.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/number.h"
#include "base/progress.h"
#include "find/judgement.h"
#include "find/slip.h"
#include "scene/model.h"

enum { FITTED = 4 };            /* parameters of a slip */

ss_status
ss_pull_check(const ss_signal *signal, size_t column, const ss_scene *start, const ss_rank_opts *opts,
              ss_error *err)
{
    ss_status st = ss_column_check(signal, column, opts, err);
    if (st == SS_OK)
        st = ss_scene_check(start, err);
    if (st != SS_OK)
        return st;
    if (opts->quantity != SS_SPRING)
        return ss_fail(err, SS_EINVAL, "a pull is compared with the spring's force only");
    if (!ss_scene_is_pulled(start))
        return ss_fail(err, SS_EINVAL, "a scene that is forced is not compared with pulls");
    return ss_column_check_unit(signal, column, SS_SPRING, err);
}

static void
fill_left(ss_pull *p, const residue *r, double noise, double power)
{
    p->left = r->left / r->power;
    p->noise = noise / power;
    p->excess = ss_residue_excess(r, noise);
    p->explains = ss_residue_explains(r, noise);
}

/* The fitted scene.  It sticks at the start of the record so that its first slip begins with the record's. */
static ss_scene
scene_of(const ss_scene *start, const ss_features *f, double onset, const ss_signal *signal)
{
    ss_scene s = *start;
    double direction = sign(pull_of(start)), loading = f->number[SS_LOADING_SLOPE].value;
    double pull = direction * loading / s.stiffness;
    s.mass = s.stiffness / f->number[SS_K_OVER_M].value;
    if (s.base_velocity != 0)
        s.base_velocity = s.surface_velocity + pull;
    else
        s.surface_velocity = -pull;
    s.friction = f->number[SS_FRICTION].value;
    s.static_friction = s.friction + f->number[SS_DROP].value / 2;      /* it scatters less if the level drifts */
    s.x0 = -direction * fmax(s.static_friction - loading * onset, -s.static_friction) / s.stiffness;
    s.v0 = s.surface_velocity;
    s.settle = 0;
    s.rate = signal->head->rate;
    s.duration = (double)signal->n / s.rate;
    return s;
}

/* Fit by the slips, which have a closed form and were fitted one by one. */
static ss_status
fit_slips(ss_pull *p, const ss_signal *signal, size_t column, const ss_scene *start)
{
    const ss_features *f = p->features;
    rank_record record = { .x = signal->values + column * signal->n, .n = signal->n };
    double left = 0, power = 0, n = 0, onset = NAN;
    p->static_friction = f->number[SS_STATIC_FRICTION];
    p->friction = f->number[SS_FRICTION];
    for (size_t i = 0; f->loading != NULL && i < f->n; i++) {
        const ss_loading *l = &f->loading[i];
        if (!isfinite(l->friction.value))
            continue;
        onset = p->n_slips++ == 0 ? f->transition[i].onset : onset;
        left += l->left;
        power += l->power;
        n += l->n;
    }
    ss_falls_doubt(p->why, sizeof p->why, f, signal, column, start);
    if (p->why[0] == '\0' && (double)p->n_slips < MOSTLY * (double)f->n) {
        snprintf(p->why, sizeof p->why, "%zu of %zu falls are no slips of a pulled Coulomb slider",
                 f->n - p->n_slips, f->n);
        p->verdict = SS_NONE_FITS;
    }
    if (p->why[0] == '\0')
        ss_falls_count(p->why, sizeof p->why, p->n_slips, f);
    if (p->why[0] == '\0') {
        p->verdict = SS_NAMED;
        p->scene = scene_of(start, f, onset, signal);
    }
    if (p->n_slips == 0)
        return SS_OK;
    ss_status st = ss_record_noise(&record, 0);
    const residue of_slips = { left / (n - FITTED * (double)p->n_slips), power / n, record.noise, n };
    const ss_number *damping = &f->number[SS_SLIP_DAMPING];
    fill_left(p, &of_slips, record.noise, ss_record_power(&record));
    p->explains = p->explains && !(fabs(damping->value) > SIGMAS * damping->error);
    p->left = left / power;
    return st;
}

/* Fit by simulation to the falls. */
static ss_status
fit_falls(ss_pull *p, const ss_signal *signal, size_t column, const ss_scene *start, const ss_rank_opts *opts)
{
    const ss_stretch all = { opts->progress, 0, 1 };
    const ss_fitted *vague = NULL;
    pulled_fit fit;
    falls r;
    ss_status st = ss_falls_gather(&r, p->why, sizeof p->why, p->features, signal, column, start);
    const int is_usable = st == SS_OK && p->why[0] == '\0';
    if (is_usable)
        st = ss_pulled_fit(&fit, &r, start, INFINITY, &all);
    ss_falls_free(&r);
    if (!is_usable || st != SS_OK)
        return st;
    if (!fit.slips) {
        snprintf(p->why, sizeof p->why, "the scene does not stick and slip, or not within the steps of a fit");
        return SS_OK;
    }
    fill_left(p, &fit.of_samples, r.noise, r.power);
    p->n_slips = r.n;
    p->static_friction = fit.static_friction;
    p->friction = fit.friction;
    p->scene = fit.scene;
    p->scene.rate = signal->head->rate;
    p->scene.duration = (double)signal->n / p->scene.rate;
    for (p->n_keys = 0; p->n_keys < fit.n_keys; p->n_keys++) {
        ss_fitted *k = &p->key[p->n_keys];
        k->name = fit.key[p->n_keys].name;
        k->given = ss_scene_get(start, k->name);
        k->unit = ss_scene_unit(start, k->name);
        k->found.value = ss_scene_get(&fit.scene, k->name);
        k->found.error = fit.key[p->n_keys].error * fabs(k->found.value);
        if (vague == NULL && !(SIGMAS * k->found.error <= fabs(k->found.value)))
            vague = k;
    }
    if (p->left > 1 - SLIP_EXPLAINED && !p->explains) {
        ss_print_to(p->why, sizeof p->why, "the best such scene leaves %.3g %% of the power of the falls, "
                    "%.3g times the noise", 100 * p->left, p->excess);
        p->verdict = SS_NONE_FITS;
    } else if (vague != NULL)
        ss_print_to(p->why, sizeof p->why, "%s = %.3g +- %.2g: the falls do not tell it", vague->name,
                    vague->found.value, vague->found.error);
    else
        p->verdict = SS_NAMED;
    return SS_OK;
}

ss_status
ss_pull_fit(ss_pull **out, const ss_signal *signal, size_t column, const ss_scene *start,
            const ss_rank_opts *given, ss_error *err)
{
    ss_rank_opts own;
    const ss_rank_opts *opts = &own;
    if (out == NULL || signal == NULL || start == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_rank_opts_take(&own, given, err);
    if (st == SS_OK)
        st = ss_pull_check(signal, column, start, opts, err);
    if (st == SS_OK && start->model->has_contact)
        return ss_fail(err, SS_EINVAL, "an elastic contact is not fitted to a pull: many contacts explain "
                       "the same falls");
    if (st != SS_OK)
        return st;
    ss_features_opts how;
    ss_features_opts_init(&how, sizeof how);
    how.progress = opts->progress;
    ss_pull *p = calloc(1, sizeof *p);
    if (p == NULL)
        return ss_fail_memory(err, NULL);
    *p = (ss_pull){ .verdict = SS_UNDECIDED, .scene = *start, .left = NAN, .excess = NAN, .noise = NAN };
    st = ss_features_find(&p->features, signal, column, &how, err);
    if (st == SS_OK) {
        const int is_plain = start->model->linear && start->damping == 0;   /* slips have a closed form */
        st = is_plain ? fit_slips(p, signal, column, start) : fit_falls(p, signal, column, start, opts);
        if (st != SS_OK)
            ss_fail(err, st, "%s", ss_strerror(st));
    }
    if (st == SS_OK)
        *out = p;
    else
        ss_pull_free(p);
    return st;
}

void
ss_pull_free(ss_pull *pull)
{
    if (pull == NULL)
        return;
    ss_features_free(pull->features);
    free(pull);
}
