/* transform.c -- measure error and time of the transform of a signal, for each engine.
 *
 * The reference is the sum of the definition; only terms below its rounding are left out.  It is
 * computed at random translations and at the largest |W|, where the features of the signal are. */
#include "study/trade/trade.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/progress.h"
#include "map/plan.h"

enum { EACH = 40 };

static const struct { const char *name; ss_engine engine; } method[] = {
    { "quadrature", SS_ENGINE_QUADRATURE }, { "fft", SS_ENGINE_FFT },
};
enum { METHODS = sizeof method / sizeof *method };

typedef struct trial {
    const double *x;
    size_t n;
    double rate;
    ss_morlet_opts opts;
    const ss_trade_opts *how;
    ss_trade *trade;
    ss_error *err;
    double began, estimate, done;   /* of a run [s]; the time that it would take, if it is over the budget; the
                                       part of the whole work that is done */
} trial;

/* The largest error of coefficients w in any scale, over the largest |W| there.  Of the translations of a scale
 * the last is where |W| is largest, the others are at random places (Knuth's multiplicative hash). */
static ss_status
find_error(double *worst, const trial *t, const ss_morlet *plan, const double *w)
{
    record rec = { 0 };
    double x_max = 0, want[2 * EACH];
    ss_status st = ss_morlet_record(&rec, t->x, t->n, t->opts.detrend, t->err);
    for (size_t k = 0; st == SS_OK && k < rec.n; k++)
        x_max = fmax(x_max, ldexp(fabs(rec.x[k]), rec.exponent));
    *worst = 0;
    for (const ss_scale *scale = plan->scale; st == SS_OK && scale < plan->scale + plan->n_scales; scale++) {
        const double *of = w + 2 * scale->offset, unit = plan->opts.norm == SS_NORM_L1 ? 1 : sqrt(scale->a);
        double most = -1;
        size_t place[EACH];
        for (uint32_t c = 0; c < EACH; c++)
            place[c] = (size_t)((double)(uint32_t)(c * 2654435769u) / 4294967296. * (double)scale->n);
        for (size_t k = 0; k < scale->n; k++)
            if (hypot(of[2 * k], of[2 * k + 1]) > most) {
                most = hypot(of[2 * k], of[2 * k + 1]);
                place[EACH - 1] = k;
            }
        st = ss_morlet_points(plan, scale, &rec, place, EACH, want, t->err);
        for (size_t c = 0; st == SS_OK && c < EACH && most > 0; c++) {
            const double *got = of + 2 * place[c], error = hypot(got[0] - want[2 * c], got[1] - want[2 * c + 1]);
            *worst = fmax(*worst, (error - 16 * DBL_EPSILON * unit * x_max) / most);
        }
    }
    free(rec.x);
    return st;
}

/* --- rows ------------------------------------------------------------------------------------- */

/* Stop quadrature as soon as it is certain to exceed its budget. */
static int
watch(double done, void *user)
{
    trial *t = user;
    const double spent = ss_trade_cpu_time() - t->began, budget = t->how->budget;
    if (spent > budget || (spent > budget / 50 && spent > 2 * budget * done)) {
        t->estimate = spent / done;
        return 1;
    }
    return ss_progress_at(&t->how->progress, t->done) != SS_OK;
}

/* A ss_trade_runner. */
static ss_status
run_row(size_t i, int again, double done, double *seconds, void *user)
{
    trial *t = user;
    ss_trade_row *row = &t->trade->row[i];
    ss_morlet *plan = NULL;
    ss_morlet_opts opts = t->opts;
    *seconds = NAN;
    opts.engine = method[i].engine;
    if (opts.engine == SS_ENGINE_QUADRATURE && !again)
        opts.progress = (ss_progress){ watch, t };
    ss_status st = ss_morlet_new(&plan, t->n, t->rate, &opts, t->err);
    if (st != SS_OK)
        return st;
    double *w = malloc(2 * plan->total * sizeof *w);
    t->estimate = 0;
    t->done = done;
    t->began = ss_trade_cpu_time();
    st = w != NULL ? ss_morlet_execute(plan, t->x, w, t->err) : SS_ENOMEM;
    if (st == SS_STOP && t->estimate > 0) {
        row->status = SS_EBUDGET;
        row->seconds = t->estimate;
        st = SS_OK;
    } else
        *seconds = ss_trade_cpu_time() - t->began;
    if (st == SS_OK && !again && row->status == SS_OK)
        st = find_error(&row->error_x, t, plan, w);
    row->error_x = fmax(row->error_x, t->trade->known_x);
    t->trade->samples = EACH * plan->n_scales;
    free(w);
    ss_morlet_free(plan);
    return st;
}

static ss_status
fill_rows(trial *t, ss_error *err)
{
    ss_trade *trade = t->trade;
    trade->row = calloc(METHODS, sizeof *trade->row);
    ss_status st = trade->row != NULL ? SS_OK : SS_ENOMEM;
    trade->known_x = DBL_EPSILON;
    trade->transform = 1;
    strcpy(trade->reference, "quadrature in full");
    for (; st == SS_OK && trade->n < METHODS; trade->n++)
        trade->row[trade->n].method = method[trade->n].name;
    t->err = err;
    return st == SS_OK ? ss_trade_time(trade, run_row, &t->how->progress, t) : st;
}

ss_status
ss_trade_transform(ss_trade **out, const double *x, size_t n, double rate,
                   const ss_morlet_opts *grid, const ss_trade_opts *given, ss_error *err)
{
    ss_trade_opts opts;
    if (out == NULL || x == NULL)
        return SS_FAIL_NULL(err);
    trial t = { .x = x, .n = n, .rate = rate, .how = &opts };
    ss_status st = ss_trade_opts_take(&opts, given, err);
    if (st == SS_OK)
        st = ss_morlet_take(&t.opts, grid, err);
    if (st != SS_OK)
        return st;
    t.opts.accuracy = ss_morlet_ranges.accuracy.from;
    t.opts.threads = 1;
    t.trade = calloc(1, sizeof *t.trade);
    st = t.trade != NULL ? fill_rows(&t, err) : SS_ENOMEM;
    return ss_trade_give(out, t.trade, st, err);
}
