/* pull.c -- a slider pulled at constant speed, from the force of its spring: fitted slip by slip.
 *
 * What friction does differs from slip to slip in every measured pull, so the record repeats nothing
 * and no one motion can be laid over it.  But each slip by itself is the motion of the Coulomb slider
 * (src/features/slip.c), and has a static and a kinetic friction and a k/m of its own; each stick has
 * the slope k U.  The scene has the medians.  Its stiffness is that given: the force says k U and k/m
 * only, so that mass and speed follow from it, to be held against those given. */
#include <stickslip/rank.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/error.h"
#include "scene/model.h"
#include "study/rank/record.h"

enum { FEWEST = 5 };            /* slips whose median and scatter are given */
#define MOST 0.75               /* of the falls must be such slips */

static ss_status
check(const ss_signal *signal, size_t column, const ss_scene *start, const ss_rank_opts *opts,
      ss_error *err)
{
    ss_status st = ss_column_check(signal, column, opts, err);
    if (st == SS_OK)
        st = ss_scene_check(start, err);
    if (st != SS_OK)
        return st;
    const struct model *model = ss_model_of(start);
    if (!model->linear || model->has_contact)
        return ss_fail(err, SS_EINVAL, "only the Coulomb friction of a pulled slider is fitted, not %s",
                       model->name);
    if (opts->quantity != SS_SPRING)
        return ss_fail(err, SS_EINVAL, "a pull is fitted to the spring's force only");
    if (!ss_scene_is_pulled(start))
        return ss_fail(err, SS_EINVAL, "only a pull at constant speed is fitted so");
    if (start->damping != 0 || start->surface_velocity != 0)
        return ss_fail(err, SS_EINVAL, "a pull with damping or on a belt is not fitted");
    return SS_OK;
}

static double
sum_of(const ss_signal *signal, size_t column)
{
    double sum = 0;
    for (size_t i = 0; i < signal->n; i++)
        sum += signal->values[column * signal->n + i];
    return sum;
}

/* Stuck at the start of the record, so that the first slip begins with that of the record. */
static ss_scene
scene_of(const ss_scene *start, const ss_features *f, size_t first, const ss_signal *signal)
{
    ss_scene s = *start;
    double direction = start->base_velocity > 0 ? 1 : -1, loading = f->slope.value;
    s.mass = s.stiffness / f->k_over_m.value;
    s.base_velocity = direction * loading / s.stiffness;
    s.friction = f->friction.value;
    s.static_friction = s.friction + f->drop.value / 2;     /* where the level drifts, that scatters less */
    double force = s.static_friction - loading * f->transition[first].onset;
    s.x0 = -direction * fmax(force, -s.static_friction) / s.stiffness;
    s.v0 = s.settle = 0;
    s.rate = signal->head->rate;
    s.duration = (double)signal->n / s.rate;
    return s;
}

static void
judge(ss_pull *p, const ss_features *f, const ss_signal *signal, size_t column, const ss_scene *start)
{
    size_t first = 0;
    for (size_t i = f->loading != NULL ? f->n : 0; i-- > 0;)
        if (isfinite(f->loading[i].friction.value))
            first = i, p->n_slips++;
    if (f->loading == NULL || f->n == 0)
        snprintf(p->why, sizeof p->why, "%s", f->why_slips != NULL ? f->why_slips
                 : "no falls of a force are found: is it one by name or unit, and of one sign?");
    else if (sum_of(signal, column) * start->base_velocity < 0)
        snprintf(p->why, sizeof p->why, "the force has the opposite sign of base_velocity");
    else if ((double)p->n_slips < MOST * (double)f->n) {
        snprintf(p->why, sizeof p->why, "%zu of %zu falls are no slips of a pulled Coulomb slider",
                 f->n - p->n_slips, f->n);
        p->verdict = SS_NONE_FITS;
    } else if (p->n_slips < FEWEST || isnan(f->slope.error))
        snprintf(p->why, sizeof p->why, "%zu slips are too few for a median and its scatter",
                 p->n_slips);
    else {
        p->verdict = SS_NAMED;
        p->scene = scene_of(start, f, first, signal);
    }
}

ss_status
ss_pull_fit(ss_pull **out, const ss_signal *signal, size_t column, const ss_scene *start,
            const ss_rank_opts *opts, ss_error *err)
{
    if (out == NULL || signal == NULL || start == NULL)
        return SS_FAIL_NULL(err);
    if (opts == NULL)
        opts = &ss_rank_defaults;
    ss_status st = check(signal, column, start, opts, err);
    if (st != SS_OK)
        return st;
    ss_features_opts how = ss_features_defaults;
    how.progress = opts->progress;
    ss_pull *p = calloc(1, sizeof *p);
    if (p == NULL)
        return ss_fail_memory(err, NULL);
    *p = (ss_pull){ .verdict = SS_UNDECIDED, .scene = *start };
    st = ss_features_find(&p->features, signal, column, &how, err);
    if (st != SS_OK) {
        ss_pull_free(p);
        return st;
    }
    judge(p, p->features, signal, column, start);
    *out = p;
    return SS_OK;
}

void
ss_pull_free(ss_pull *pull)
{
    if (pull == NULL)
        return;
    ss_features_free(pull->features);
    free(pull);
}
