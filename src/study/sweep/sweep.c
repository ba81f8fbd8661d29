/* sweep.c -- compute the points of a grid on several threads and send their rows in grid order.
 *
 * Threads compute points in batches, in order.  A finished batch waits in a ring for those before
 * it; the thread that finishes the first missing batch sends all batches that are then in order.
 * A point depends only on the scene and its index in the grid, so the rows do not depend on the
 * threads. */
#include <stickslip/sweep.h>

#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/signal.h>
#include "base/error.h"
#include "scene/key.h"
#include "base/pool.h"
#include "base/progress.h"

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

double
ss_axis_value(const ss_axis *axis, size_t i)
{
    if (axis == NULL)
        return NAN;
    if (i == 0)
        return axis->from;
    if (i + 1 >= axis->n)
        return axis->to;
    double n = (double)(axis->n - 1), done = (double)i, part = done / n;
    double ratio = axis->to / axis->from, x = axis->from * (n - done) + axis->to * done;
    if (axis->log && ratio > 0 && isfinite(ratio))
        return axis->from * pow(ratio, part);
    if (axis->log)                      /* the ratio of the ends may exceed a double */
        return pow(axis->from, 1 - part) * pow(axis->to, part);
    return isfinite(x) ? x / n : axis->from * (1 - part) + axis->to * part;
}

ss_status
ss_sweep_points(const ss_sweep_opts *opts, size_t *n, ss_error *err)
{
    if (opts == NULL || n == NULL || (opts->axis == NULL && opts->n_axes > 0))
        return SS_FAIL_NULL(err);
    size_t all = 1;
    if (opts->n_axes == 0)
        return ss_fail(err, SS_EINVAL, "nothing to vary");
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

ss_status
ss_sweep_check(const ss_scene *scene, const ss_sweep_opts *opts, ss_error *err)
{
    if (scene == NULL || opts == NULL)
        return SS_FAIL_NULL(err);
    ss_scene copy = *scene;
    size_t all;
    ss_status st = ss_steady_check(&opts->steady, scene, err);
    if (st == SS_OK)
        st = ss_sweep_points(opts, &all, err);
    for (size_t i = 0; st == SS_OK && i < opts->n_axes; i++) {
        const char *key = opts->axis[i].key;
        if (ss_scene_number(&copy, key, NULL, err) == NULL)
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

/* --- a point ------------------------------------------------------------------------------- */

typedef struct result {
    ss_steady steady;
    ss_status status;
    ss_error reason;
} result;

/* The values of the axes at a point of the grid. */
static void
place(const ss_sweep_opts *opts, size_t index, double vary[])
{
    for (size_t i = opts->n_axes; i-- > 0; index /= opts->axis[i].n)
        vary[i] = ss_axis_value(&opts->axis[i], index % opts->axis[i].n);
}

static void
work_out(const ss_scene *scene, const ss_sweep_opts *opts, const double vary[], result *out)
{
    ss_scene here = *scene;
    for (size_t i = 0; i < opts->n_axes; i++)
        *ss_scene_number(&here, opts->axis[i].key, NULL, NULL) = vary[i];
    out->status = ss_steady_find(&out->steady, &here, &opts->steady, &out->reason);
    if (out->status == SS_OK)
        strcpy(out->reason.text, "ok");
}

/* --- all of them --------------------------------------------------------------------------- */

enum { BATCH = 16, BATCHES_A_THREAD = 8 };

typedef struct batch {
    int done;
    size_t n;
    result result[BATCH];
} batch;

typedef struct sweep {
    const ss_scene *scene;
    const ss_sweep_opts *opts;
    size_t n, taken, sent;         /* points of the shard; the next to compute; the next to send */
    batch *ring;
    size_t room;
    ss_strobe *strobe;              /* of all points in the ring; NULL if none are wanted */
    double *vary;                   /* of the row for the sink */
    ss_status status;
    pthread_mutex_t lock;           /* of taken, sent and the rest; held while the sink is called */
    pthread_cond_t moved;           /* signalled when sent has grown, or the status has changed */
} sweep;

static size_t
index_of(const sweep *w, size_t i)
{
    return w->opts->shard + (w->opts->first + i) * w->opts->shards;
}

static batch *
batch_of(sweep *w, size_t point)
{
    return &w->ring[point / BATCH % w->room];
}

/* Send the batch whose turn it is to the sink. */
static void
send_batch(sweep *w, batch *b)
{
    for (size_t i = 0; w->status == SS_OK && i < b->n; i++) {
        const result *r = &b->result[i];
        ss_sweep_row row = { index_of(w, w->sent + i), w->vary, r->steady, r->status,
                             r->reason.text };
        place(w->opts, row.index, w->vary);
        if (r->status == SS_ENOMEM)
            w->status = SS_ENOMEM;
        else if (w->opts->sink(&row, w->opts->user) != 0)
            w->status = SS_STOP;
    }
    w->sent += b->n;
    b->done = 0;
    if (w->status == SS_OK)
        w->status = ss_progress_at(&w->opts->progress, (double)w->sent / (double)w->n);
}

static void
work_on(void *user)
{
    sweep *w = user;
    double *vary = calloc(w->opts->n_axes, sizeof *vary);
    pthread_mutex_lock(&w->lock);
    if (vary == NULL)
        w->status = SS_ENOMEM;
    while (w->status == SS_OK && w->taken < w->n) {
        if (w->taken >= w->sent + w->room * BATCH) {
            pthread_cond_wait(&w->moved, &w->lock);
            continue;
        }
        size_t first = w->taken;
        batch *b = batch_of(w, first);
        b->n = w->n - first < BATCH ? w->n - first : BATCH;
        w->taken += b->n;
        pthread_mutex_unlock(&w->lock);
        for (size_t i = 0; i < b->n; i++) {
            place(w->opts, index_of(w, first + i), vary);
            work_out(w->scene, w->opts, vary, &b->result[i]);
        }
        pthread_mutex_lock(&w->lock);
        b->done = 1;
        while (w->sent < w->n && (b = batch_of(w, w->sent))->done)
            send_batch(w, b);
        pthread_cond_broadcast(&w->moved);
    }
    pthread_cond_broadcast(&w->moved);
    pthread_mutex_unlock(&w->lock);
    free(vary);
}

/* Make room for the starts of cycles of the points in the ring, if they are wanted. */
static ss_status
make_room(sweep *w)
{
    const ss_steady_opts *o = &w->opts->steady;
    size_t each = (size_t)(o->strobe > o->max_period ? o->strobe : o->max_period), n = w->room * BATCH;
    w->ring = calloc(w->room, sizeof *w->ring);
    w->vary = calloc(w->opts->n_axes, sizeof *w->vary);
    w->strobe = o->strobe > 0 ? calloc(n, each * sizeof *w->strobe) : NULL;
    if (w->ring == NULL || w->vary == NULL || (o->strobe > 0 && w->strobe == NULL))
        return SS_ENOMEM;
    for (size_t i = 0; w->strobe != NULL && i < n; i++)
        w->ring[i / BATCH].result[i % BATCH].steady.strobe = w->strobe + i * each;
    return SS_OK;
}

static void
work_together(sweep *w)
{
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->moved, NULL);
    ss_pool_run(work_on, w, 0, (size_t)w->opts->threads);
    pthread_cond_destroy(&w->moved);
    pthread_mutex_destroy(&w->lock);
}

ss_status
ss_sweep_run(const ss_scene *scene, const ss_sweep_opts *opts, ss_error *err)
{
    if (scene == NULL || opts == NULL || opts->sink == NULL)
        return SS_FAIL_NULL(err);
    sweep w = { .scene = scene, .opts = opts, .room = (size_t)opts->threads * BATCHES_A_THREAD };
    size_t all;
    ss_status st = ss_sweep_check(scene, opts, err);
    if (st != SS_OK)
        return st;
    ss_sweep_points(opts, &all, NULL);
    size_t of_shard = all > opts->shard ? (all - opts->shard - 1) / opts->shards + 1 : 0;
    w.n = of_shard > opts->first ? of_shard - opts->first : 0;
    w.status = make_room(&w);
    if (w.status == SS_OK)
        work_together(&w);
    free(w.ring);
    free(w.vary);
    free(w.strobe);
    return w.status == SS_ENOMEM ? ss_fail_memory(err, NULL) : w.status;
}
