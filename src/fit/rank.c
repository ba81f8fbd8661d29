/* rank.c -- find the scene that explains a signal, among scenes that are forced and scenes that are pulled.
 *
 * Scenes of one kind are ranked together (forced.c, pull_rank.c).  If there are both, the answer is that of
 * the kind to which the signal belongs. */
#include <stickslip/rank.h>

#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/progress.h"
#include "fit/forced.h"
#include "fit/order.h"
#include "fit/pulled.h"

static int
report_part(double done, void *user)
{
    const ss_stretch *s = user;
    return ss_stretch_at(s, done) != SS_OK;
}

/* Rank the scenes of one kind; those of the other follow: they do not fit, and have no values. */
static ss_status
rank_kind(ss_ranking **out, int pulled, const ss_signal *signal, size_t column, const ss_scene *scene, size_t n,
          const ss_rank_opts *opts, ss_stretch part, ss_error *err)
{
    ss_rank_opts own = *opts;
    ss_ranking *r = *out = calloc(1, sizeof *r);
    if (r != NULL)
        r->row = calloc(n, sizeof *r->row);
    if (r == NULL || r->row == NULL)
        return ss_fail_memory(err, NULL);
    r->forcing_frequency = r->noise = NAN;
    for (size_t k = 0; k < SS_CRITERIA; k++)
        r->value[k] = NAN;
    for (size_t i = 0; i < n; i++)
        if (ss_scene_is_pulled(&scene[i]) == pulled)
            r->row[r->n++] = (ss_rank_row){ .scene = i, .total = NAN, .excess = NAN };
    for (size_t i = 0, last = r->n; i < n; i++)
        if (ss_scene_is_pulled(&scene[i]) != pulled) {
            ss_rank_row *to = &r->row[last++];
            *to = (ss_rank_row){ .scene = i, .adjusted = scene[i], .total = NAN, .excess = NAN };
            for (size_t k = 0; k < SS_CRITERIA; k++) {
                to->value[k] = NAN;
                to->distance[k] = INFINITY;
            }
        }
    own.progress = (ss_progress){ report_part, &part };
    ss_status st = (pulled ? ss_pull_compare : ss_forced_compare)(r, signal, column, scene, &own, err);
    r->n = n;
    return st;
}

/* The signal's kind is what is compared, then what is named, then what explains more. */
static int
is_pull(ss_ranking *const kind[2])
{
    if (kind[0] == NULL || !is_compared(kind[0]) || !is_compared(kind[1]))
        return kind[0] == NULL || is_compared(kind[1]);
    if ((kind[0]->verdict == SS_NAMED) != (kind[1]->verdict == SS_NAMED))
        return kind[1]->verdict == SS_NAMED;
    return kind[1]->row[0].explained > kind[0]->row[0].explained;
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
        st = ss_column_check(signal, column, opts, err);
    if (st == SS_OK && n == 0)
        return ss_fail(err, SS_EINVAL, "no scene to rank");
    if (st == SS_OK && !(opts->spread >= 0 && opts->spread < 1))
        return ss_fail(err, SS_EINVAL, "spread %g is out of range 0 ... 1", opts->spread);
    for (int q = 0; st == SS_OK && q < SS_QUANTITIES; q++)
        if (opts->also[q] >= 0)
            st = ss_column_check(signal, (size_t)opts->also[q], opts, err);
    size_t pulled = 0;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        pulled += (size_t)ss_scene_is_pulled(&scene[i]);
        st = (ss_scene_is_pulled(&scene[i]) ? ss_scene_check : ss_forced_check)(&scene[i], err);
    }
    const int has[2] = { pulled < n, pulled == n || (pulled > 0 && opts->quantity == SS_SPRING) };
    ss_ranking *kind[2] = { NULL, NULL };
    for (int k = 0; st == SS_OK && k < 2; k++) {
        const ss_stretch part = { opts->progress, has[1 - k] ? 0.5 * k : 0, has[1 - k] ? 0.5 * (1 + k) : 1 };
        if (has[k])
            st = rank_kind(&kind[k], k, signal, column, scene, n, opts, part, err);
    }
    if (st == SS_OK) {
        const int is = is_pull(kind), both = kind[0] != NULL && kind[1] != NULL;
        if (both && kind[0]->verdict == SS_NAMED && kind[1]->verdict == SS_NAMED) {
            kind[is]->verdict = SS_UNDECIDED;
            snprintf(kind[is]->why, sizeof kind[is]->why, "a pull and a forced motion explain the signal");
        }
        *out = kind[is];
        kind[is] = NULL;
    }
    ss_ranking_free(kind[0]);
    ss_ranking_free(kind[1]);
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
