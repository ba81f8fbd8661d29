/* transform.c -- measure error and time of the transform of a signal, for each engine.
 *
 * The reference is the sum of the definition; only terms below its rounding are left out.  It is
 * computed at random translations and at the largest |W|, where the features of the signal are.
 * Its time also gives an estimate for the definition on the whole grid, which is not begun if it
 * would take too long. */
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

typedef struct scale_reference {
    size_t k[EACH];                 /* translations */
    double w[2 * EACH], most;       /* the largest |W| of the scale */
} scale_reference;

typedef struct trial {
    const double *x;
    size_t n;
    double rate;
    ss_morlet_opts opts;
    const ss_trade_opts *how;
    double x_max, by_sum;           /* about the seconds that the definition takes at its best */
    double *w;
    size_t n_scales;
    scale_reference *reference;
    ss_trade *trade;
    ss_error *err;
} trial;

/* --- the reference ---------------------------------------------------------------------------- */

/* Choose translations of a scale: the last is where |W| is largest, the others are spread over the scale at
 * random places (Knuth's multiplicative hash). */
static void
choose_places(scale_reference *ref, const ss_scale *scale, const double *w)
{
    double most = -1;
    for (uint32_t c = 0; c < EACH; c++) {
        double part = (double)(uint32_t)(c * 2654435769u) / 4294967296.;
        ref->k[c] = (size_t)(part * (double)scale->n);
    }
    for (size_t k = 0; k < scale->n; k++) {
        double size = hypot(w[2 * k], w[2 * k + 1]);
        if (size > most) {
            most = size;
            ref->k[EACH - 1] = k;
        }
    }
    ref->most = most;
}

/* Make the grid of the tightest accuracy, and its reference. */
static ss_status
refer(trial *t, ss_error *err)
{
    ss_morlet *plan = NULL;
    record rec = { 0 };
    t->opts.accuracy = ss_morlet_ranges.accuracy.from;
    ss_status st = ss_morlet_new(&plan, t->n, t->rate, &t->opts, err);
    if (st != SS_OK)
        return st;
    t->n_scales = plan->n_scales;
    t->w = malloc(2 * plan->total * sizeof *t->w);
    t->reference = calloc(plan->n_scales, sizeof *t->reference);
    st = t->w != NULL && t->reference != NULL ? ss_morlet_execute(plan, t->x, t->w, err) : SS_ENOMEM;
    if (st == SS_OK)
        st = ss_morlet_record(&rec, t->x, t->n, t->opts.detrend, err);
    for (size_t i = 0; st == SS_OK && i < plan->n_scales; i++) {
        const ss_scale *scale = &plan->scale[i];
        scale_reference *ref = &t->reference[i];
        double began = ss_trade_cpu_time();
        choose_places(ref, scale, t->w + 2 * scale->offset);
        st = ss_morlet_points(plan, scale, &rec, ref->k, EACH, ref->w, err);
        t->by_sum += (ss_trade_cpu_time() - began) * (double)scale->n / EACH;
        if (st == SS_OK)
            st = ss_progress_at(&t->how->progress, 0);
    }
    for (size_t k = 0; st == SS_OK && k < rec.n; k++)
        t->x_max = fmax(t->x_max, ldexp(fabs(rec.x[k]), rec.exponent));
    if (!t->opts.octaves) {
        t->opts.fmin = plan->scale[0].f;
        t->opts.fmax = plan->scale[plan->n_scales - 1].f;
    }
    free(rec.x);
    ss_morlet_free(plan);
    return st;
}

/* --- rows ------------------------------------------------------------------------------------- */

static double
worst_error(const trial *t, const ss_morlet *plan)
{
    double worst = 0;
    for (size_t i = 0; i < t->n_scales; i++) {
        const scale_reference *ref = &t->reference[i];
        const ss_scale *scale = &plan->scale[i];
        double unit = plan->opts.norm == SS_NORM_L1 ? 1 : sqrt(scale->a);
        for (size_t c = 0; c < EACH && ref->most > 0; c++) {
            const double *got = t->w + 2 * (scale->offset + ref->k[c]), *want = ref->w + 2 * c;
            double error = hypot(got[0] - want[0], got[1] - want[1]);
            worst = fmax(worst, (error - 16 * DBL_EPSILON * unit * t->x_max) / ref->most);
        }
    }
    return worst;
}

/* A ss_trade_runner. */
static ss_status
run_row(size_t i, int again, double done, double *seconds, void *user)
{
    trial *t = user;
    ss_trade_row *row = &t->trade->row[i];
    ss_morlet *plan = NULL;
    ss_morlet_opts opts = t->opts;
    (void)done;
    *seconds = NAN;
    opts.engine = method[i].engine;
    if (opts.engine == SS_ENGINE_QUADRATURE && t->by_sum > t->how->budget) {
        row->status = SS_EBUDGET;
        row->seconds = t->by_sum;
        return SS_OK;
    }
    ss_status st = ss_morlet_new(&plan, t->n, t->rate, &opts, t->err);
    if (st != SS_OK)
        return st;
    double began = ss_trade_cpu_time();
    st = ss_morlet_execute(plan, t->x, t->w, t->err);
    *seconds = ss_trade_cpu_time() - began;
    if (st == SS_OK && !again)
        row->error_x = fmax(t->trade->known_x, worst_error(t, plan));
    ss_morlet_free(plan);
    return st;
}

static ss_status
fill_rows(trial *t, ss_error *err)
{
    ss_trade *trade = t->trade;
    ss_status st = refer(t, err);
    trade->row = calloc(METHODS, sizeof *trade->row);
    if (st == SS_OK && trade->row == NULL)
        st = SS_ENOMEM;
    trade->samples = EACH * t->n_scales;
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
    t.opts.engine = SS_ENGINE_AUTO;
    t.opts.threads = 1;
    t.trade = calloc(1, sizeof *t.trade);
    st = t.trade != NULL ? fill_rows(&t, err) : SS_ENOMEM;
    free(t.w);
    free(t.reference);
    return ss_trade_give(out, t.trade, st, err);
}
