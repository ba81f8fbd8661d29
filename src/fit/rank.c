/* rank.c -- find the scene that explains a signal, among scenes that are forced and scenes that are pulled.
 *
 * Scenes of one kind are ranked together (forced.c, pull_rank.c).  If there are both, the answer is that of
 * the kind to which the signal belongs. */
#include <stickslip/rank.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/progress.h"
#include "fit/forced.h"
#include "fit/order.h"
#include "fit/pull.h"
#include "fit/column.h"

static ss_status
check(const ss_signal *signal, size_t column, size_t n, const ss_rank_opts *opts, ss_error *err)
{
    ss_status st = ss_column_check(signal, column, opts, err);
    if (st == SS_OK && n == 0)
        return ss_fail(err, SS_EINVAL, "no scene to rank");
    if (st == SS_OK && !(opts->spread >= 0 && opts->spread < 1))
        return ss_fail(err, SS_EINVAL, "spread %g is out of range 0 ... 1", opts->spread);
    for (int q = 0; st == SS_OK && q < SS_QUANTITIES; q++)
        if (opts->also[q] >= 0)
            st = ss_column_check(signal, (size_t)opts->also[q], opts, err);
    return st;
}

/* --- pulled and forced scenes together ------------------------------------------------------ */

static int
report_half(double done, void *user)
{
    const ss_stretch *s = user;
    return ss_stretch_at(s, done) != SS_OK;
}

/* Rank the scenes that are pulled, or those that are not, by themselves; *out is NULL if no scene of
 * the kind can be compared with the column. */
static ss_status
rank_kind(ss_ranking **out, int pulled, const ss_signal *signal, size_t column, const ss_scene *scene,
          size_t n, const ss_rank_opts *opts, ss_error *err)
{
    ss_stretch half = { opts->progress, 0.5 * pulled, 0.5 * (1 + pulled) };
    ss_rank_opts o = *opts;
    ss_scene *some = malloc(n * sizeof *some);
    size_t *index = malloc(n * sizeof *index), n_some = 0;
    ss_status st = some != NULL && index != NULL ? SS_OK : ss_fail_memory(err, NULL);
    o.progress = (ss_progress){ report_half, &half };
    for (size_t i = 0; st == SS_OK && i < n; i++)
        if (ss_scene_is_pulled(&scene[i]) == pulled) {
            some[n_some] = scene[i];
            index[n_some++] = i;
        }
    *out = NULL;
    if (st == SS_OK && (!pulled || opts->quantity == SS_SPRING))
        st = ss_ranking_new(out, signal, column, some, n_some, &o, err);
    for (size_t i = 0; st == SS_OK && *out != NULL && i < n_some; i++)
        (*out)->row[i].scene = index[(*out)->row[i].scene];
    free(index);
    free(some);
    return st;
}

static int
is_compared(const ss_ranking *r)
{
    return r != NULL && !isnan(r->row[0].total);
}

/* Does the signal move as the pulled scenes do rather than as the forced ones? */
static int
is_pull(const ss_ranking *others, const ss_ranking *pulled)
{
    if (!is_compared(pulled) || !is_compared(others))
        return is_compared(pulled);
    if ((pulled->verdict == SS_NAMED) != (others->verdict == SS_NAMED))
        return pulled->verdict == SS_NAMED;
    return pulled->row[0].explained > others->row[0].explained;
}

/* The row of a scene that does not fit. */
static ss_rank_row
last_row(size_t i, const ss_scene *scene)
{
    ss_rank_row row = { .scene = i, .adjusted = *scene, .total = NAN, .excess = NAN };
    for (size_t k = 0; k < SS_CRITERIA; k++) {
        row.value[k] = NAN;
        row.distance[k] = INFINITY;
    }
    return row;
}

/* Copy the verdict and the rows of the scenes of the signal's kind.  The scenes of the other kind follow: they
 * do not fit, and have no values. */
static void
copy_answer(ss_ranking *r, const ss_ranking *of, const ss_scene *scene)
{
    const size_t n = r->n;
    const int pulled = ss_scene_is_pulled(&scene[of->row[0].scene]);
    ss_rank_row *row = r->row, *next = row + of->n;
    memcpy(row, of->row, of->n * sizeof *row);
    *r = *of;
    r->n = n;
    r->row = row;
    for (size_t i = 0; i < n; i++)
        if (ss_scene_is_pulled(&scene[i]) != pulled)
            *next++ = last_row(i, &scene[i]);
}

static ss_status
rank_both(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
          const ss_rank_opts *opts, ss_error *err)
{
    ss_ranking *others = NULL, *pulled = NULL;
    ss_status st = rank_kind(&others, 0, signal, column, scene, r->n, opts, err);
    if (st == SS_OK)
        st = rank_kind(&pulled, 1, signal, column, scene, r->n, opts, err);
    if (st == SS_OK)
        copy_answer(r, is_pull(others, pulled) ? pulled : others, scene);
    if (st == SS_OK && others->verdict == SS_NAMED && pulled != NULL && pulled->verdict == SS_NAMED) {
        r->verdict = SS_UNDECIDED;
        snprintf(r->why, sizeof r->why, "a pull and a forced motion explain the signal");
    }
    ss_ranking_free(others);
    ss_ranking_free(pulled);
    return st;
}

ss_status
ss_ranking_new(ss_ranking **out, const ss_signal *signal, size_t column, const ss_scene *scene, size_t n,
        const ss_rank_opts *given, ss_error *err)
{
    ss_rank_opts own;
    const ss_rank_opts *opts = &own;
    if (out == NULL || signal == NULL || scene == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_rank_opts_take(&own, given, err);
    if (st == SS_OK)
        st = check(signal, column, n, opts, err);
    size_t pulled = 0;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        pulled += (size_t)ss_scene_is_pulled(&scene[i]);
        st = (ss_scene_is_pulled(&scene[i]) ? ss_scene_check : ss_forced_check)(&scene[i], err);
    }
    if (st != SS_OK)
        return st;
    ss_ranking *r = calloc(1, sizeof *r);
    if (r != NULL)
        r->row = calloc(n, sizeof *r->row);
    if (r == NULL || r->row == NULL) {
        ss_ranking_free(r);
        return ss_fail_memory(err, NULL);
    }
    r->n = n;
    r->forcing_frequency = r->noise = NAN;
    for (size_t i = 0; i < SS_CRITERIA; i++)
        r->value[i] = NAN;
    for (size_t i = 0; i < n; i++)
        r->row[i] = (ss_rank_row){ .scene = i, .total = NAN, .excess = NAN };
    st = (pulled == n ? ss_pull_compare : pulled == 0 ? ss_forced_compare : rank_both)
        (r, signal, column, scene, opts, err);
    if (st == SS_OK)
        *out = r;
    else
        ss_ranking_free(r);
    return st;
}

void
ss_ranking_free(ss_ranking *ranking)
{
    if (ranking == NULL)
        return;
    free(ranking->row);
    free(ranking);
}
