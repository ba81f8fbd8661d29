/* scene.c -- measure error and time of a scene's simulation, in a row for each method and tolerance. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/options.h"
#include "base/sort.h"
#include "motion/method.h"
#include "study/trade/common.h"
#include "study/trade/runs.h"

enum { REPEATS = 5 };               /* short rows are measured so many times */
#define SHORT 0.1                   /* [s] */

/* Each run of the reference may take so many times a row's CPU time.  The limit is a time, as the user's
 * budget is, and not a number of steps.  No byte of a measurement depends on it: a reference that exceeds
 * it is refused, never replaced by a looser one.  ss_trade_choose, whose choice must not depend on the
 * machine, limits its runs by right-hand sides only. */
#define REFERENCE_BUDGET 100

static const ss_trade_opts usual = { .size = sizeof usual, .budget = 10 };

void
ss_trade_opts_init(ss_trade_opts *opts, size_t size)
{
    ss_options_init(opts, size, &usual, sizeof usual);
}

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

static int
keeps(const ss_trade_row *row, double accuracy)
{
    return row->status == SS_OK && row->missed == 0 && row->invented == 0
        && MARGIN * row->error_x <= accuracy;
}

const ss_trade_row *
ss_trade_cheapest(const ss_trade *trade, double accuracy)
{
    if (trade == NULL)
        return NULL;
    const ss_trade_row *best = NULL;
    for (size_t i = 0; i < trade->n; i++)
        if (keeps(&trade->row[i], accuracy)
            && (best == NULL || trade->row[i].seconds < best->seconds))
            best = &trade->row[i];
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

static ss_status
run_row(measurement *t, const ss_trade_row *row, ss_error *err)
{
    return ss_trade_run(&t->run, &t->p, row->method, row->tol > 0 ? row->tol : 1e-12, 0, err);
}

static ss_status
measure_row(measurement *t, ss_trade_row *row)
{
    const ss_trade_row *best = t->opts->target > 0 ? ss_trade_cheapest(t->trade, t->opts->target)
        : NULL;
    t->run.budget = t->opts->budget;
    if (best != NULL)
        t->run.budget = fmin(t->run.budget, 2 * best->seconds);
    row->status = run_row(t, row, NULL);
    row->seconds = t->run.seconds;
    row->steps = t->run.stats.steps;
    row->rhs = t->run.stats.rhs;
    if (row->status == SS_STOP || row->status == SS_ENOMEM)
        return row->status;
    if (row->status != SS_OK)
        return SS_OK;
    ss_status st = ss_trade_compare(row, &t->run, &t->ref);
    row->error_x = fmax(row->error_x, t->trade->known_x);
    row->error_a = fmax(row->error_a, t->trade->known_a);
    row->error_t = fmax(row->error_t, t->trade->known_t);
    return st;
}

/* Rows are repeated in turns, so that a disturbance of the machine affects all of them alike.  Their times
 * become the medians. */
ss_status
ss_trade_repeat(ss_trade *trade, ss_trade_again *again, void *user)
{
    double (*seconds)[REPEATS] = calloc(trade->n, sizeof *seconds);
    ss_status st = seconds != NULL ? SS_OK : SS_ENOMEM;
    for (int k = 0; st == SS_OK && k < REPEATS; k++)
        for (size_t i = 0; st == SS_OK && i < trade->n; i++) {
            const ss_trade_row *row = &trade->row[i];
            double done = 0.7 + 0.3 * ((double)k + (double)i / (double)trade->n) / REPEATS;
            if (row->status == SS_OK && row->seconds <= SHORT)
                st = again(user, row, done, &seconds[i][k]);
        }
    for (size_t i = 0; st == SS_OK && i < trade->n; i++)
        if (trade->row[i].status == SS_OK && trade->row[i].seconds <= SHORT) {
            qsort(seconds[i], REPEATS, sizeof *seconds[i], ss_ascending);
            trade->row[i].seconds = seconds[i][REPEATS / 2];
        }
    free(seconds);
    return st;
}

static ss_status
run_again(void *user, const ss_trade_row *row, double done, double *seconds)
{
    measurement *t = user;
    t->run.budget = 0;
    t->run.done = done;
    ss_status st = run_row(t, row, NULL);
    *seconds = t->run.seconds;
    return st;
}

void
ss_trade_mark_frontier(ss_trade *trade)
{
    for (size_t i = 0; i < trade->n; i++) {
        ss_trade_row *row = &trade->row[i];
        row->frontier = row->status == SS_OK;
        for (size_t k = 0; k < trade->n; k++) {
            const ss_trade_row *other = &trade->row[k];
            if (other->status == SS_OK && other->seconds <= row->seconds
                && other->error_x <= row->error_x
                && (other->seconds < row->seconds || other->error_x < row->error_x))
                row->frontier = 0;
        }
    }
}

static ss_status
measure_rows(measurement *t, ss_error *err)
{
    ss_trade *trade = t->trade;
    ss_trade_row between = { .tol = 0 };
    const char *method[2];
    ss_method_pair(&t->p.scene, 0, method);
    ss_status st = ss_trade_run_init(&t->ref, &t->p);
    if (st == SS_OK)
        st = ss_trade_run_init(&t->run, &t->p);
    if (st == SS_OK)
        st = make_rows(trade, &t->p.scene);
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
    for (size_t i = 0; st == SS_OK && i < trade->n; i++) {
        t->run.done = 0.7 * (double)i / (double)trade->n;
        t->run.share = 0.7 / (double)trade->n;
        st = measure_row(t, &trade->row[i]);
    }
    t->run.share = 0;
    if (st == SS_OK)
        st = ss_trade_repeat(trade, run_again, t);
    if (st == SS_OK)
        ss_trade_mark_frontier(trade);
    return st;
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
    if (st == SS_OK) {
        *out = t.trade;
        return SS_OK;
    }
    ss_trade_free(t.trade);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

void
ss_trade_free(ss_trade *trade)
{
    if (trade == NULL)
        return;
    free(trade->row);
    free(trade);
}
