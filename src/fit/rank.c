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
#include "fit/pulled.h"

static int
report_half(double done, void *user)
{
    const ss_stretch *s = user;
    return ss_stretch_at(s, done) != SS_OK;
}

/* Rank the scenes of each kind by themselves.  The verdict and the first rows are those of the signal's kind; the
 * scenes of the other kind follow: they do not fit, and have no values. */
static ss_status
rank_both(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene, const ss_rank_opts *opts,
          ss_error *err)
{
    const size_t n = r->n;
    ss_rank_row *row = r->row;
    ss_ranking *kind[2] = { NULL, NULL };
    ss_scene *some = malloc(n * sizeof *some);
    ss_status st = some != NULL ? SS_OK : ss_fail_memory(err, NULL);
    for (int pulled = 0; st == SS_OK && pulled <= (opts->quantity == SS_SPRING); pulled++) {
        ss_stretch half = { opts->progress, 0.5 * pulled, 0.5 * (1 + pulled) };
        ss_rank_opts o = *opts;
        size_t m = 0;
        o.progress = (ss_progress){ report_half, &half };
        for (size_t i = 0; i < n; i++)
            if (ss_scene_is_pulled(&scene[i]) == pulled)
                some[m++] = scene[i];
        st = ss_ranking_new(&kind[pulled], signal, column, some, m, &o, err);
    }
    if (st == SS_OK) {
        /* the signal's kind is what is compared, then what is named, then what explains more */
        int pulled = is_compared(kind[1]);
        if (pulled && is_compared(kind[0]) && (kind[0]->verdict == SS_NAMED) != (kind[1]->verdict == SS_NAMED))
            pulled = kind[1]->verdict == SS_NAMED;
        else if (pulled && is_compared(kind[0]))
            pulled = kind[1]->row[0].explained > kind[0]->row[0].explained;
        const ss_ranking *own = kind[pulled];
        size_t next = own->n, nth = 0;
        *r = *own;
        r->row = row;
        r->n = n;
        for (size_t i = 0; i < n; i++)
            if (ss_scene_is_pulled(&scene[i]) != pulled) {
                ss_rank_row *to = &row[next++];
                *to = (ss_rank_row){ .scene = i, .adjusted = scene[i], .total = NAN, .excess = NAN };
                for (size_t k = 0; k < SS_CRITERIA; k++) {
                    to->value[k] = NAN;
                    to->distance[k] = INFINITY;
                }
            } else {
                for (size_t k = 0; k < own->n; k++)
                    if (own->row[k].scene == nth) {
                        row[k] = own->row[k];
                        row[k].scene = i;
                    }
                nth++;
            }
        if (kind[1] != NULL && kind[0]->verdict == SS_NAMED && kind[1]->verdict == SS_NAMED) {
            r->verdict = SS_UNDECIDED;
            snprintf(r->why, sizeof r->why, "a pull and a forced motion explain the signal");
        }
    }
    ss_ranking_free(kind[0]);
    ss_ranking_free(kind[1]);
    free(some);
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
