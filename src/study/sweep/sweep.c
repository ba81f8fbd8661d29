/* sweep.c -- compute the points of a grid on several threads and send their rows in grid order.
 *
 * A point depends only on the scene and its index in the grid, so the rows do not depend on the
 * threads. */
#include <stickslip/sweep.h>

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/number.h"
#include "base/options.h"
#include "base/pool.h"
#include "base/progress.h"
#include "scene/key.h"
#include "study/sweep/grid.h"

static const ss_sweep_opts usual = { .size = sizeof usual, .shards = 1, .threads = 1 };

SS_OPTIONS(ss_sweep_opts, usual)

ss_status
ss_sweep_opts_take(ss_sweep_opts *own, ss_steady_opts *steady, const ss_sweep_opts *given, ss_error *err)
{
    ss_steady_opts usual_steady;
    ss_steady_opts_init(&usual_steady, sizeof usual_steady);
    if (given == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_options_take(own, sizeof *own, &usual, given, err);
    if (st == SS_OK)
        st = ss_options_take(steady, sizeof *steady, &usual_steady, own->steady, err);
    own->steady = steady;
    return st == SS_OK && own->axis == NULL && own->n_axes > 0 ? SS_FAIL_NULL(err) : st;
}

/* --- the grid ------------------------------------------------------------------------------ */

ss_status
ss_axis_parse(ss_axis *out, const char *text, ss_error *err)
{
    if (out == NULL || text == NULL)
        return SS_FAIL_NULL(err);
    ss_axis axis = { .n = 0 };
    const char *equals = strchr(text, '=');
    char *end, *rest;
    if (equals == NULL || equals == text || (size_t)(equals - text) >= sizeof axis.key)
        return ss_fail(err, SS_EINVAL, "'%s' is not key=from:to:n", text);
    memcpy(axis.key, text, (size_t)(equals - text));
    axis.from = ss_number_parse(equals + 1, &end);
    int ok = end > equals + 1 && *end == ':';
    if (ok) {
        axis.to = ss_number_parse(end + 1, &rest);
        ok = rest > end + 1 && *rest == ':' && rest[1] >= '0' && rest[1] <= '9';
    }
    if (ok) {
        axis.n = strtoul(rest + 1, &end, 10);
        axis.log = strcmp(end, ":log") == 0;
        ok = *end == '\0' || axis.log;
    }
    if (!ok && axis.n > 0)              /* n is no plain number: 1e12, say */
        return ss_fail(err, SS_EINVAL, "'%s': n is '%s', but must be digits, of a number up to %zu",
                       text, rest + 1, SIZE_MAX / 2);
    if (!ok || !isfinite(axis.from) || !isfinite(axis.to))
        return ss_fail(err, SS_EINVAL, "'%s' is not key=from:to:n or key=from:to:n:log", text);
    if (axis.n < 1)
        return ss_fail(err, SS_EINVAL, "%s: at least one value is needed", axis.key);
    if (axis.log && !(axis.from > 0 && axis.to > 0))
        return ss_fail(err, SS_EINVAL, "%s: a logarithmic axis needs ends above 0", axis.key);
    *out = axis;
    return SS_OK;
}

/* Rounding leaves a value of an axis within this part of its largest. */
#define ROUNDED (32 * DBL_EPSILON)

/* The decimal of twelve digits that rounding has made x of, such as .2; else x. */
static double
decimal_of(double x, double largest)
{
    char text[SS_NUMBER_MAX];
    ss_print_to(text, sizeof text, "%.11e", fabs(x) <= ROUNDED * largest ? 0 : x);
    double decimal = ss_number_parse(text, NULL);
    return fabs(decimal - x) <= ROUNDED * largest ? decimal : x;
}

/* The i-th value, from 0. */
static double
axis_value(const ss_axis *axis, size_t i)
{
    if (i == 0)
        return axis->from;
    if (i + 1 >= axis->n)
        return axis->to;
    double n = (double)(axis->n - 1), part = (double)i / n;
    if (axis->log) {                    /* their ratio may exceed a double */
        double x = pow(axis->from, 1 - part) * pow(axis->to, part);
        return decimal_of(x, x);
    }
    return decimal_of(axis->from * (1 - part) + axis->to * part, fmax(fabs(axis->from), fabs(axis->to)));
}

void
ss_sweep_values(const ss_sweep_opts *opts, size_t index, double value[])
{
    for (size_t k = opts->n_axes; k-- > 0; index /= opts->axis[k].n)
        value[k] = axis_value(&opts->axis[k], index % opts->axis[k].n);
}

ss_status
ss_sweep_points(const ss_sweep_opts *opts, size_t *n, ss_error *err)
{
    size_t all = 1;
    for (size_t i = 0; i < opts->n_axes; i++) {
        if (opts->axis[i].n < 1)
            return ss_fail(err, SS_EINVAL, "%s: at least one value is needed", opts->axis[i].key);
        if (all > SIZE_MAX / 2 / opts->axis[i].n)
            return ss_fail(err, SS_EINVAL, "%s: that makes more than %zu points", opts->axis[i].key,
                           SIZE_MAX / 2);
        all *= opts->axis[i].n;
    }
    *n = all;
    return SS_OK;
}

static ss_status
check(const ss_scene *scene, const ss_sweep_opts *opts, ss_error *err)
{
    ss_scene copy = *scene;
    size_t all;
    ss_status st = ss_steady_check(opts->steady, scene, err);
    if (st == SS_OK)
        st = ss_sweep_points(opts, &all, err);
    for (size_t i = 0; st == SS_OK && i < opts->n_axes; i++) {
        const char *key = opts->axis[i].key;
        if (ss_scene_set(&copy, key, axis_value(&opts->axis[i], 0), err) != SS_OK)
            return SS_EINVAL;
        if (ss_key_is_of_record(key))
            return ss_fail(err, SS_EINVAL, "%s belongs to the record, which no measure sees", key);
        for (size_t k = 0; k < i; k++)
            if (strcmp(key, opts->axis[k].key) == 0)
                return ss_fail(err, SS_EINVAL, "%s is varied twice", key);
    }
    if (st == SS_OK && (opts->threads < 1 || opts->threads > SS_THREADS_MAX))
        return ss_fail(err, SS_EINVAL, "threads: 1 ... %d", SS_THREADS_MAX);
    if (st == SS_OK && (opts->shards < 1 || opts->shard >= opts->shards))
        return ss_fail(err, SS_EINVAL, "no shard %zu of %zu", opts->shard, opts->shards);
    return st;
}

ss_status
ss_sweep_check(const ss_scene *scene, const ss_sweep_opts *given, ss_error *err)
{
    ss_sweep_opts opts;
    ss_steady_opts steady;
    if (scene == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_sweep_opts_take(&opts, &steady, given, err);
    return st == SS_OK ? check(scene, &opts, err) : st;
}

/* --- its points ---------------------------------------------------------------------------- */

typedef struct sweep {
    const ss_scene *scene;
    const ss_sweep_opts *opts;
    size_t n;                       /* points of the shard that are left */
} sweep;

/* A point: a row, with the values of the axes and the starts of cycles behind it. */
typedef struct point {
    ss_sweep_row row;
    ss_error reason;
    double values[];
} point;

static void
work_out(size_t i, void *result, void *user)
{
    const sweep *w = user;
    const ss_sweep_opts *opts = w->opts;
    point *p = result;
    ss_scene here = *w->scene;
    size_t index = opts->shard + (opts->first + i) * opts->shards;
    p->row.index = index;
    p->row.vary = p->values;
    ss_sweep_values(opts, index, p->values);
    for (size_t k = 0; k < opts->n_axes; k++)
        ss_scene_set(&here, opts->axis[k].key, p->values[k], NULL);
    p->row.steady.strobe = opts->steady->strobe > 0 ? (ss_strobe *)(p->values + opts->n_axes) : NULL;
    p->row.status = ss_steady_find(&p->row.steady, &here, opts->steady, &p->reason);
    if (p->row.status == SS_OK)
        strcpy(p->reason.text, "ok");
    p->row.reason = p->reason.text;
}

static ss_status
send(size_t i, void *result, void *user)
{
    const sweep *w = user;
    const point *p = result;
    if (p->row.status == SS_ENOMEM)
        return SS_ENOMEM;
    if (w->opts->sink(&p->row, w->opts->user) != 0)
        return SS_STOP;
    return ss_progress_at(&w->opts->progress, (double)(i + 1) / (double)w->n);
}

ss_status
ss_sweep_run(const ss_scene *scene, const ss_sweep_opts *given, ss_error *err)
{
    ss_sweep_opts own, *opts = &own;
    ss_steady_opts steady, *o = &steady;
    size_t all;
    if (scene == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_sweep_opts_take(opts, o, given, err);
    if (st == SS_OK)
        st = own.sink != NULL ? check(scene, opts, err) : SS_FAIL_NULL(err);
    if (st != SS_OK)
        return st;
    ss_sweep_points(opts, &all, NULL);
    size_t of_shard = all > opts->shard ? (all - opts->shard - 1) / opts->shards + 1 : 0;
    size_t strobes = o->strobe == 0 ? 0 : (size_t)(o->strobe > o->max_period ? o->strobe : o->max_period);
    sweep w = { scene, opts, of_shard > opts->first ? of_shard - opts->first : 0 };
    const ss_line line = { .n = w.n, .work = work_out, .send = send, .user = &w, .size = sizeof (point)
                           + opts->n_axes * sizeof (double) + strobes * sizeof (ss_strobe) };
    st = ss_pool_line(&line, (size_t)opts->threads);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}
