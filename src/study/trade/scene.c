/* scene.c -- measure error and time of a scene's simulation, in a row for each method and tolerance. */
#include <math.h>
#include <stdlib.h>
#include "base/list.h"
#include "base/options.h"
#include "base/progress.h"
#include "motion/method.h"
#include "study/trade/trade.h"

enum { REPEATS = 5 };               /* short rows are measured so many times */
#define SHORT 0.1                   /* [s] */

/* Each run of the reference may take so many times a row's CPU time.  The limit is a time, as the user's
 * budget is, and not a number of steps.  No byte of a measurement depends on it: a reference that exceeds
 * it is refused, never replaced by a looser one.  ss_trade_choose, whose choice must not depend on the
 * machine, limits its runs by right-hand sides only. */
#define REFERENCE_BUDGET 100

static const ss_trade_opts usual = { .size = sizeof usual, .budget = 10, .span = 80, .threads = 1 };

SS_OPTIONS(ss_trade_opts, usual)

ss_status
ss_trade_opts_take(ss_trade_opts *own, const ss_trade_opts *given, ss_error *err)
{
    ss_status st = ss_options_take(own, sizeof *own, &usual, given, err);
    return st != SS_OK || own->budget > 0 ? st : ss_fail(err, SS_EINVAL, "a budget is more than 0 s");
}

typedef struct measurement {
    ss_trade *trade;
    const ss_trade_opts *opts;
    probe p;
    run ref, run;
} measurement;

const ss_trade_row *
ss_trade_cheapest(const ss_trade *trade, double accuracy)
{
    if (trade == NULL)
        return NULL;
    const ss_trade_row *best = NULL;
    for (const ss_trade_row *row = trade->row; row < trade->row + trade->n; row++)
        if (row->status == SS_OK && row->missed == 0 && row->invented == 0 && MARGIN * row->error_x <= accuracy
            && (best == NULL || row->seconds < best->seconds
                || (row->seconds == best->seconds && row->error_x < best->error_x)))
            best = row;
    return best;
}

/* Make the rows to be measured: one for the closed form, and one for each other method and tolerance. */
static ss_status
make_rows(ss_trade *trade, const ss_scene *scene)
{
    const struct method *how;
    size_t methods = 0;
    while (ss_method_at(methods) != NULL)
        methods++;
    trade->row = calloc(methods * TOLERANCES, sizeof *trade->row);
    if (trade->row == NULL)
        return SS_ENOMEM;
    int closed = ss_method_for(scene, BEST)->kind == CLOSED_FORM;
    for (size_t m = 0; (how = ss_method_at(m)) != NULL; m++) {
        const ss_trade_row row = { .method = how->name, .status = SS_STOP };
        if (how->kind == CLOSED_FORM && closed)
            trade->row[trade->n++] = row;
        for (int i = 1; how->kind != CLOSED_FORM && i < TOLERANCES - 1; i++) {
            trade->row[trade->n] = row;
            trade->row[trade->n++].tol = ss_trade_tolerance[i];
        }
    }
    return SS_OK;
}

/* A ss_trade_runner. */
static ss_status
run_row(size_t i, int again, double done, double *seconds, void *user)
{
    measurement *t = user;
    ss_trade_row *row = &t->trade->row[i];
    const ss_trade_row *best = t->opts->target > 0 ? ss_trade_cheapest(t->trade, t->opts->target) : NULL;
    t->run.budget = again ? 0 : best != NULL ? fmin(t->opts->budget, 2 * best->seconds) : t->opts->budget;
    t->run.done = done;
    t->run.share = again ? 0 : 0.7 / (double)t->trade->n;
    ss_status st = ss_trade_run(&t->run, &t->p, row->method, row->tol > 0 ? row->tol : 1e-12, 0, NULL);
    *seconds = st == SS_OK ? t->run.seconds : NAN;
    if (again)
        return st;
    row->status = st;
    row->seconds = t->run.seconds;
    row->steps = t->run.stats.steps;
    row->rhs = t->run.stats.rhs;
    if (st != SS_OK)
        return st == SS_STOP || st == SS_ENOMEM ? st : SS_OK;
    st = ss_trade_compare(row, &t->run, &t->ref);
    row->error_x = fmax(row->error_x, t->trade->known_x);
    row->error_a = fmax(row->error_a, t->trade->known_a);
    row->error_t = fmax(row->error_t, t->trade->known_t);
    return st;
}

ss_status
ss_trade_race(double **out, size_t n, ss_trade_runner *runner, const ss_progress *progress, void *user)
{
    enum { FIRST = 1 };
    double *seconds = malloc((n + 1) * sizeof *seconds), (*all)[REPEATS] = calloc(n + 1, sizeof *all);
    ss_status st = seconds != NULL && all != NULL ? SS_OK : SS_ENOMEM;
    for (size_t lap = 0; lap < FIRST + REPEATS; lap++)
        for (size_t i = 0; st == SS_OK && i < n; i++) {
            double part = (double)i / (double)n;
            double done = lap < FIRST ? 0.7 * part : 0.7 + 0.3 * ((double)(lap - FIRST) + part) / REPEATS;
            if (lap >= FIRST && !(seconds[i] <= SHORT))
                continue;
            st = ss_progress_at(progress, done);
            if (st == SS_OK)
                st = runner(i, lap >= FIRST, done, lap < FIRST ? &seconds[i] : &all[i][lap - FIRST], user);
        }
    for (size_t i = 0; st == SS_OK && i < n; i++)
        if (seconds[i] <= SHORT) {
            qsort(all[i], REPEATS, sizeof *all[i], ss_ascending);
            seconds[i] = all[i][REPEATS / 2];
        }
    free(all);
    if (st != SS_OK)
        free(seconds);
    *out = st == SS_OK ? seconds : NULL;
    return st;
}

ss_status
ss_trade_time(ss_trade *trade, ss_trade_runner *runner, const ss_progress *progress, void *user)
{
    double *seconds;
    ss_status st = ss_trade_race(&seconds, trade->n, runner, progress, user);
    for (size_t i = 0; st == SS_OK && i < trade->n; i++)
        if (!isnan(seconds[i]))
            trade->row[i].seconds = seconds[i];
    free(seconds);
    for (size_t i = 0; i < trade->n; i++) {
        ss_trade_row *row = &trade->row[i];
        row->frontier = row->status == SS_OK;
        for (const ss_trade_row *other = trade->row; other < trade->row + trade->n; other++)
            if (other->status == SS_OK && other->seconds <= row->seconds && other->error_x <= row->error_x
                && (other->seconds < row->seconds || other->error_x < row->error_x))
                row->frontier = 0;
    }
    return st;
}

ss_status
ss_trade_give(ss_trade **out, ss_trade *trade, ss_status st, ss_error *err)
{
    if (st == SS_OK)
        *out = trade;
    else
        ss_trade_free(trade);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

static ss_status
measure_rows(measurement *t, ss_error *err)
{
    ss_trade *trade = t->trade;
    ss_trade_row between = { .tol = 0 };
    const char *method[2];
    ss_method_pair(&t->p.scene, 0, method);
    ss_status st = make_rows(trade, &t->p.scene);
    t->ref.budget = t->run.budget = REFERENCE_BUDGET * t->opts->budget;
    if (st == SS_OK)
        st = ss_trade_refer(&t->ref, &t->run, &t->p, method, 0, trade->reference, err);
    if (st == SS_EBUDGET && (t->ref.over || t->run.over))
        return ss_fail(err, st, "the run of reference would take about %.2g s: a row's budget of %g s "
                       "allows it %g s", t->ref.over ? t->ref.seconds : t->run.seconds,
                       t->opts->budget, t->ref.budget);
    if (st == SS_OK)
        st = ss_trade_compare(&between, &t->run, &t->ref);
    trade->known_x = ss_trade_known(between.error_x);
    trade->known_a = ss_trade_known(between.error_a);
    trade->known_t = between.error_t;
    trade->events = t->ref.n_events;
    trade->samples = t->p.n;
    return st == SS_OK ? ss_trade_time(trade, run_row, &t->opts->progress, t) : st;
}

ss_status
ss_trade_measure(ss_trade **out, const ss_scene *scene, const ss_trade_opts *given, ss_error *err)
{
    ss_trade_opts opts;
    if (out == NULL || scene == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_record_check(scene, err);
    if (st == SS_OK)
        st = ss_trade_opts_take(&opts, given, err);
    if (st != SS_OK)
        return st;
    run empty = { .wants_events = 1, .progress = opts.progress };
    measurement t = { calloc(1, sizeof *t.trade), &opts, ss_trade_probe(scene), empty, empty };
    st = t.trade != NULL ? measure_rows(&t, err) : SS_ENOMEM;
    ss_trade_run_free(&t.ref);
    ss_trade_run_free(&t.run);
    return ss_trade_give(out, t.trade, st, err);
}

void
ss_trade_free(ss_trade *trade)
{
    if (trade == NULL)
        return;
    free(trade->row);
    free(trade);
}
