/* pull.c -- a slider pulled at constant speed, from the force of its spring: fitted slip by slip.
 *
 * What friction does differs from slip to slip in every measured pull, so the record repeats nothing
 * and no one motion can be laid over it.  But each slip by itself is the motion of the Coulomb slider
 * (src/features/slip.c), and has a static and a kinetic friction and a k/m of its own; each stick has
 * the slope k U.  The scene has the medians.  Its stiffness is that given: the force says k U and k/m
 * only, so that mass and speed follow from it, to be held against those given.
 *
 * In a ranking a scene stands for all rigs within the spread of its parameters.  Of these m, k and
 * U are moved by the least that gives the k U and k/m of the slips; the frictions are those of the
 * slips. */
#include "study/rank/pull.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/error.h"
#include "scene/model.h"
#include "study/rank/match.h"

enum { FEWEST = 5 };            /* slips whose median and scatter are given */
enum { FITTED = 4 };            /* parameters of a slip */
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
        return ss_fail(err, SS_EINVAL, "of pulls only those with Coulomb friction are compared, not %s",
                       model->name);
    if (opts->quantity != SS_SPRING)
        return ss_fail(err, SS_EINVAL, "a pull is compared with the spring's force only");
    if (!ss_scene_is_pulled(start))
        return ss_fail(err, SS_EINVAL, "a scene that is forced is not compared with pulls");
    if (start->damping != 0 || start->surface_velocity != 0)
        return ss_fail(err, SS_EINVAL, "a pull with damping or on a belt is not compared");
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

/* What the slips leave of the samples about them, of their power and of the noise. */
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
    *p = (ss_pull){ .verdict = SS_UNDECIDED, .scene = *start, .left = NAN, .excess = NAN, .noise = NAN };
    st = ss_features_find(&p->features, signal, column, &how, err);
    if (st == SS_OK)
        judge(p, p->features, signal, column, start);
    if (st == SS_OK && p->n_slips > 0 && find_excess(p, signal, column) != SS_OK)
        st = ss_fail_memory(err, NULL);
    if (st == SS_OK)
        *out = p;
    else
        ss_pull_free(p);
    return st;
}

/* --- a ranking ----------------------------------------------------------------------------- */

enum { ADJUSTED = 5 };          /* k, m, U, f_k, f_s */
static const char *const adjusted_name[ADJUSTED] = { "stiffness", "mass", "base_velocity", "friction",
                                                     "static_friction" };

/* The changes of a scene's parameters, as logarithms, that give the medians of the slips: of k, m
 * and U those with the least sum of squares that give k/m and k U. */
static void
find_changes(const ss_scene *own, const ss_features *f, double change[ADJUSTED])
{
    double k_over_m = log(f->k_over_m.value * own->mass / own->stiffness);
    double loading = log(f->slope.value / fabs(own->stiffness * own->base_velocity));
    change[0] = (k_over_m + loading) / 3;
    change[1] = change[0] - k_over_m;
    change[2] = loading - change[0];
    change[3] = log(f->friction.value / own->friction);
    change[4] = log((f->friction.value + f->drop.value / 2) / fmax(own->static_friction, own->friction));
}

/* The distance of a scene from the slips, and the parameter that must change most. */
static double
adjust(ss_rank_row *row, const ss_scene *own, const ss_pull *p, size_t *most)
{
    double change[ADJUSTED], squares = 0;
    find_changes(own, p->features, change);
    *most = 0;
    for (size_t i = 0; i < ADJUSTED; i++) {
        squares += change[i] * change[i];
        *most = fabs(change[i]) > fabs(change[*most]) ? i : *most;
    }
    row->adjusted = p->scene;           /* by another stiffness all forces are those of p->scene, too */
    row->adjusted.stiffness = own->stiffness * exp(change[0]);
    double ratio = row->adjusted.stiffness / p->scene.stiffness;
    row->adjusted.mass = p->scene.mass * ratio;
    row->adjusted.base_velocity = p->scene.base_velocity / ratio;
    row->adjusted.x0 = p->scene.x0 / ratio;
    row->value[SS_BY_ADJUSTMENT] = sqrt(squares / ADJUSTED);
    return change[*most];
}

/* The relative error of the medians by which scenes are told apart. */
static double
error_of(const ss_features *f)
{
    const ss_median m[] = { f->k_over_m, f->slope, f->friction, f->drop };
    double squares = 0;
    for (size_t i = 0; i < sizeof m / sizeof *m; i++)
        squares += pow(m[i].error / m[i].value, 2);
    return sqrt(squares / ADJUSTED);
}

static void
fill_row(ss_rank_row *row, const ss_pull *p, double spread)
{
    for (size_t i = 0; i < SS_CRITERIA; i++)
        row->value[i] = i == SS_BY_ADJUSTMENT ? row->value[i] : NAN;
    row->explained = 1 - p->left;
    row->excess = p->excess;
    row->value[SS_BY_RESIDUAL] = 10 * log10(fmax(p->left, 1e-12));
    row->distance[SS_BY_ADJUSTMENT] = spread > 0 ? row->value[SS_BY_ADJUSTMENT] / log(1 + spread) : 0;
}

/* Of the nearest scene: `change` is that of its parameter `most`. */
static void
compare(ss_ranking *r, const ss_pull *p, double nearest, double next, double change, size_t most,
        double spread)
{
    const double error = sqrt(MATCH_DECISIVE) * error_of(p->features);
    r->verdict = SS_NONE_FITS;
    if (!p->explains)
        snprintf(r->why, sizeof r->why, "the slips of a Coulomb slider leave %.3g %% of the power of the "
                 "falls, %.3g times the noise", 100 * p->left, p->excess);
    else if (!(fabs(change) <= log((1 + spread) / (1 - spread)) + error))
        snprintf(r->why, sizeof r->why, "the slips are those of a Coulomb slider, but the nearest scene "
                 "would need %.3g times its %s", exp(change), adjusted_name[most]);
    else if (next - nearest < error) {
        r->verdict = SS_UNDECIDED;
        snprintf(r->why, sizeof r->why, "two scenes are equally near to the slips, within their errors");
    } else
        r->verdict = SS_NAMED;
}

static ss_status
check_scenes(const ss_signal *signal, size_t column, const ss_scene *scene, size_t n,
             const ss_rank_opts *opts, ss_error *err)
{
    for (size_t i = 0; i < n; i++) {
        ss_status st = check(signal, column, &scene[i], opts, err);
        if (st != SS_OK)
            return st;
        if (scene[i].base_velocity * scene[0].base_velocity < 0)
            return ss_fail(err, SS_EINVAL, "scenes that are pulled to either side are not compared");
    }
    return SS_OK;
}

ss_status
ss_pull_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                const ss_rank_opts *opts, ss_error *err)
{
    double nearest = INFINITY, next = INFINITY, change = NAN;
    size_t most = 0;
    ss_pull *p = NULL;
    ss_status st = check_scenes(signal, column, scene, r->n, opts, err);
    if (st == SS_OK)
        st = ss_pull_fit(&p, signal, column, &scene[0], opts, err);
    if (st != SS_OK)
        return st;
    r->verdict = p->verdict;
    snprintf(r->why, sizeof r->why, "%s", p->why);
    r->noise = p->noise;
    for (size_t i = 0; p->verdict == SS_NAMED && i < r->n; i++) {
        size_t worst;
        double needed = adjust(&r->row[i], &scene[i], p, &worst), d = r->row[i].value[SS_BY_ADJUSTMENT];
        fill_row(&r->row[i], p, opts->spread);
        if (d < nearest)
            next = nearest, nearest = d, change = needed, most = worst;
        else
            next = fmin(next, d);
    }
    if (p->verdict == SS_NAMED)
        compare(r, p, nearest, next, change, most, opts->spread);
    ss_pull_free(p);
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
