/* pull.c -- a slider pulled at constant speed, from the force of its spring.
 *
 * In every measured pull, friction differs from slip to slip.  So the record does not repeat
 * itself, and no single motion fits it.
 *
 * Without damping, each slip is the motion of the Coulomb slider (src/find/slip.c), with its
 * own static and kinetic friction and its own k/m; each stick has the slope k (U - S).  The fitted
 * scene has the medians.  Its stiffness is that given: the force shows only k U and k/m, so mass
 * and speed follow from it and can be compared with those given.  With damping, or with another
 * model, slips have no closed form, or none with so few unknowns.  The scene is then simulated and
 * fitted to some slips together (falls.c). */
#include "fit/pull.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/progress.h"
#include "scene/key.h"
#include "scene/model.h"
#include "fit/falls.h"
#include "fit/match.h"
#include "fit/record.h"

enum { FITTED = 4 };            /* parameters of a slip */
#define MOST 0.75               /* the least part of the falls that must be such slips */
#define VAGUE 0.3               /* a number with a larger relative error is not determined */
#define EXPLAINED 0.98          /* the least part of the falls' power that a fit must explain */
#define BUDGET 2e7              /* integration steps */

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

/* Do its slips have a closed form with few unknowns? */
static int
is_plain(const ss_scene *scene)
{
    const struct model *model = ss_model_of(scene);
    return model->linear && !model->has_contact && scene->damping == 0;
}

static double
sum_of(const ss_signal *signal, size_t column)
{
    double sum = 0;
    for (size_t i = 0; i < signal->n; i++)
        sum += signal->values[column * signal->n + i];
    return sum;
}

/* The fitted scene.  It sticks at the start of the record so that its first slip begins with the record's. */
static ss_scene
scene_of(const ss_scene *start, const ss_features *f, size_t first, const ss_signal *signal)
{
    ss_scene s = *start;
    double direction = sign(pull_of(start)), loading = f->slope.value;
    double pull = direction * loading / s.stiffness;
    s.mass = s.stiffness / f->k_over_m.value;
    if (s.base_velocity != 0)
        s.base_velocity = s.surface_velocity + pull;
    else
        s.surface_velocity = -pull;
    s.friction = f->friction.value;
    s.static_friction = s.friction + f->drop.value / 2;     /* it scatters less if the level drifts */
    double force = s.static_friction - loading * f->transition[first].onset;
    s.x0 = -direction * fmax(force, -s.static_friction) / s.stiffness;
    s.v0 = s.surface_velocity;
    s.settle = 0;
    s.rate = signal->head->rate;
    s.duration = (double)signal->n / s.rate;
    return s;
}

/* Find the residual of the slips, relative to their power and to the noise. */
static ss_status
find_excess(ss_pull *p, const ss_signal *signal, size_t column)
{
    rank_record r = { .x = signal->values + column * signal->n, .n = signal->n };
    double left = 0, power = 0, free = 0, n = 0;
    ss_status st = ss_record_noise(&r, 0);
    for (size_t i = 0; i < p->features->n; i++) {
        const ss_loading *l = &p->features->loading[i];
        if (l->n == 0)
            continue;
        left += l->left;
        power += l->power;
        n += l->n;
        free += l->n - FITTED;
    }
    const match m = { .left = left / free, .white = r.noise, .power = power / n, .compared = (size_t)n };
    p->left = left / power;
    p->noise = r.noise / ss_record_power(&r);
    p->excess = ss_match_excess(&m, r.noise);
    p->explains = ss_match_explains(&m, r.noise);
    return st;
}

/* Is the record no pull, or one to the other side?  Then `why` says so. */
static int
is_no_pull(char *why, size_t room, const ss_features *f, const ss_signal *signal, size_t column,
           const ss_scene *scene)
{
    if (f->loading == NULL || f->n == 0)
        snprintf(why, room, "%s", f->why_slips != NULL ? f->why_slips
                 : "no falls of a force are found: is it one by name or unit, and of one sign?");
    else if (sum_of(signal, column) * pull_of(scene) < 0)
        snprintf(why, room, "the force has the opposite sign of %s",
                 scene->base_velocity != 0 ? "base_velocity" : "a belt's");
    else
        return 0;
    return 1;
}

/* Are so many slips too few?  Then `why` says so. */
static int
are_too_few(char *why, size_t room, size_t slips, const ss_features *f)
{
    if (slips >= PULL_FEWEST && !isnan(f->slope.error))
        return 0;
    snprintf(why, room, "%zu slips are too few for a median and its scatter", slips);
    return 1;
}

int
ss_pull_lacks_falls(char *why, size_t room, const ss_features *f, const ss_signal *signal, size_t column,
                    const ss_scene *scene)
{
    return is_no_pull(why, room, f, signal, column, scene) || are_too_few(why, room, f->n, f);
}

/* The verdict by the slips, of which `first` is the first. */
static void
judge_slips(ss_pull *p, const ss_signal *signal, size_t column, const ss_scene *start, size_t first)
{
    const ss_features *f = p->features;
    if (is_no_pull(p->why, sizeof p->why, f, signal, column, start))
        return;
    if ((double)p->n_slips < MOST * (double)f->n) {
        snprintf(p->why, sizeof p->why, "%zu of %zu falls are no slips of a pulled Coulomb slider",
                 f->n - p->n_slips, f->n);
        p->verdict = SS_NONE_FITS;
    } else if (!are_too_few(p->why, sizeof p->why, p->n_slips, f)) {
        p->verdict = SS_NAMED;
        p->scene = scene_of(start, f, first, signal);
    }
}

/* Fit by the slips, which have a closed form. */
static ss_status
fit_slips(ss_pull *p, const ss_signal *signal, size_t column, const ss_scene *start)
{
    const ss_features *f = p->features;
    size_t first = 0;
    for (size_t i = f->loading != NULL ? f->n : 0; i-- > 0;)
        if (isfinite(f->loading[i].friction.value))
            first = i, p->n_slips++;
    p->static_friction = f->static_friction;
    p->friction = f->friction;
    judge_slips(p, signal, column, start, first);
    return p->n_slips > 0 ? find_excess(p, signal, column) : SS_OK;
}

/* --- any scene ----------------------------------------------------------------------------- */

match
ss_pull_match(const falls *r, const falls_fit *fit)
{
    return (match){ .left = fit->slips ? fit->left : r->power, .white = r->noise, .power = r->power,
                    .compared = fit->slips ? fit->compared : 0 };
}

const char *
ss_pull_key_name(const ss_scene *scene, const falls_key *key)
{
    return ss_key_of_field(ss_model_of(scene), key->offset)->name;
}

static void
report(ss_pull *p, const falls *r, const falls_fit *fit, const ss_scene *start, const ss_signal *signal)
{
    const match m = ss_pull_match(r, fit);
    p->left = m.left / m.power;
    p->noise = r->noise / m.power;
    p->excess = ss_match_excess(&m, r->noise);
    p->explains = ss_match_explains(&m, r->noise);
    p->n_slips = r->n;
    p->static_friction = fit->static_friction;
    p->friction = fit->friction;
    p->scene = fit->scene;
    p->scene.rate = signal->head->rate;
    p->scene.duration = (double)signal->n / p->scene.rate;
    p->n_keys = fit->n_keys;
    for (size_t i = 0; i < fit->n_keys; i++) {
        ss_scene found = fit->scene, given = *start;
        ss_fitted *k = &p->key[i];
        k->name = ss_pull_key_name(start, &fit->key[i]);
        k->given = *ss_scene_number(&given, k->name, &k->unit, NULL);
        k->found.value = *ss_scene_number(&found, k->name, NULL, NULL);
        k->found.error = fit->key[i].error * fabs(k->found.value);
    }
}

/* The first key that the falls do not tell; NULL: none. */
static const ss_fitted *
vague_key(const ss_pull *p)
{
    for (size_t i = 0; i < p->n_keys; i++)
        if (!(p->key[i].found.error <= VAGUE * fabs(p->key[i].found.value)))
            return &p->key[i];
    return NULL;
}

static void
judge_fit(ss_pull *p, const falls_fit *fit)
{
    const ss_fitted *vague = vague_key(p);
    if (!fit->slips)
        snprintf(p->why, sizeof p->why, "the scene does not stick and slip, or not within the steps of "
                 "a fit");
    else if (p->left > 1 - EXPLAINED && !p->explains) {
        snprintf(p->why, sizeof p->why, "the best such scene leaves %.3g %% of the power of the falls, "
                 "%.3g times the noise", 100 * p->left, p->excess);
        p->verdict = SS_NONE_FITS;
    } else if (vague != NULL)
        snprintf(p->why, sizeof p->why, "%s = %.3g +- %.2g: the falls do not tell it", vague->name,
                 vague->found.value, vague->found.error);
    else
        p->verdict = SS_NAMED;
}

/* Fit by simulation to the falls. */
static ss_status
fit_falls(ss_pull *p, const ss_signal *signal, size_t column, const ss_scene *start,
          const ss_rank_opts *opts)
{
    const ss_stretch all = { opts->progress, 0, 1 };
    falls_fit fit;
    falls r;
    double steps = 0;
    if (ss_pull_lacks_falls(p->why, sizeof p->why, p->features, signal, column, start))
        return SS_OK;
    ss_status st = ss_falls_gather(&r, p->features, signal, column, sign(pull_of(start)));
    if (st == SS_OK && r.n < PULL_FEWEST)
        snprintf(p->why, sizeof p->why, "%zu falls that are whole are too few", r.n);
    else if (st == SS_OK) {
        st = ss_falls_fit(&fit, &r, start, INFINITY, BUDGET, &steps, &all);
        if (st == SS_OK && fit.slips)
            report(p, &r, &fit, start, signal);
        if (st == SS_OK)
            judge_fit(p, &fit);
    }
    ss_falls_free(&r);
    return st;
}

ss_status
ss_pull_fit(ss_pull **out, const ss_signal *signal, size_t column, const ss_scene *start,
            const ss_rank_opts *opts, ss_error *err)
{
    if (out == NULL || signal == NULL || start == NULL)
        return SS_FAIL_NULL(err);
    if (opts == NULL)
        opts = &ss_rank_defaults;
    ss_status st = ss_pull_check(signal, column, start, opts, err);
    if (st == SS_OK && ss_model_of(start)->has_contact)
        return ss_fail(err, SS_EINVAL, "an elastic contact is not fitted to a pull: many contacts explain "
                       "the same falls");
    if (st != SS_OK)
        return st;
    ss_features_opts how = ss_features_defaults;
    how.progress = opts->progress;
    ss_pull *p = calloc(1, sizeof *p);
    if (p == NULL)
        return ss_fail_memory(err, NULL);
    *p = (ss_pull){ .verdict = SS_UNDECIDED, .scene = *start, .left = NAN, .excess = NAN, .noise = NAN };
    st = ss_features_find(&p->features, signal, column, &how, err);
    if (st == SS_OK) {
        st = is_plain(start) ? fit_slips(p, signal, column, start)
                             : fit_falls(p, signal, column, start, opts);
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
