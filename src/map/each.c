/* each.c -- execute a plan scale by scale, for callers that do not need all coefficients at a time.
 *
 * As many scales as there are threads are computed together and then passed to the sink, so only
 * their coefficients are in memory; each is the same to the last bit as in execute.c. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "map/plan.h"

typedef struct shared_input {
    const ss_morlet *plan;
    record rec;
    spectra spectra;
} shared_input;

/* The work of one thread. */
typedef struct worker {
    const shared_input *shared;
    size_t scale;
    double *w, *scratch;        /* scratch: NULL if no scale needs it */
    ss_status status;
    ss_error error;
} worker;

static void
compute(void *user)
{
    worker *w = user;
    const shared_input *in = w->shared;
    w->error.text[0] = '\0';
    w->status = ss_morlet_whole(in->plan, w->scale, &in->rec, &in->spectra, w->scratch, w->w,
                                &w->error);
}

static ss_status
send_scale(const worker *w, ss_coefficient_sink *sink, void *user, size_t *done, ss_error *err)
{
    const ss_morlet *plan = w->shared->plan;
    const ss_scale *scale = &plan->scale[w->scale];
    if (w->status != SS_OK) {
        if (err != NULL)
            *err = w->error;
        return w->status;
    }
    if (sink(scale, 0, scale->n, w->w, plan->n, user) != 0)
        return SS_STOP;
    *done += scale->n;
    return ss_progress_at(&plan->opts.progress, (double)*done / (double)plan->total);
}

static ss_status
all_scales(worker *w, size_t workers, ss_coefficient_sink *sink, void *user, ss_error *err)
{
    const ss_morlet *plan = w->shared->plan;
    ss_status st = SS_OK;
    size_t done = 0;
    for (size_t first = 0; st == SS_OK && first < plan->n_scales; first += workers) {
        size_t left = plan->n_scales - first, n = left < workers ? left : workers;
        for (size_t t = 0; t < n; t++)
            w[t].scale = first + t;
        ss_pool_run(compute, w, sizeof *w, n);
        for (size_t t = 0; st == SS_OK && t < n; t++)
            st = send_scale(&w[t], sink, user, &done, err);
    }
    return st;
}

static ss_status
prepare(shared_input *in, worker *w, size_t workers)
{
    const ss_morlet *plan = in->plan;
    size_t most = 0;
    for (size_t i = 0; i < plan->n_scales; i++)
        most = plan->scale[i].n > most ? plan->scale[i].n : most;
    for (size_t t = 0; t < workers; t++) {
        w[t].shared = in;
        w[t].w = most <= SIZE_MAX / (2 * sizeof(double)) ? malloc(2 * most * sizeof(double)) : NULL;
        if (w[t].w == NULL || ss_morlet_scratch(plan, &w[t].scratch) != SS_OK)
            return SS_ENOMEM;
    }
    return ss_morlet_forward(plan, &in->rec, &in->spectra);
}

ss_status
ss_morlet_each(const ss_morlet *plan, const double *x, ss_coefficient_sink *sink, void *user,
               ss_error *err)
{
    if (plan == NULL || x == NULL || sink == NULL)
        return SS_FAIL_NULL(err);
    shared_input in = { .plan = plan };
    size_t workers = (size_t)plan->opts.threads;
    workers = workers < plan->n_scales ? workers : plan->n_scales;
    ss_status st = ss_morlet_record(&in.rec, x, plan->n, plan->opts.detrend, err);
    if (st != SS_OK)
        return st;
    worker *w = calloc(workers, sizeof *w);
    st = w != NULL ? prepare(&in, w, workers) : SS_ENOMEM;
    if (st == SS_OK)
        st = all_scales(w, workers, sink, user, err);
    for (size_t t = 0; w != NULL && t < workers; t++) {
        ss_fft_scratch_free(w[t].scratch);
        free(w[t].w);
    }
    free(w);
    ss_morlet_spectra_free(&in.spectra);
    free(in.rec.x);
    return st;
}
