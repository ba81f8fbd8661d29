/* each.c -- a plan carried out scale by scale, for what does not need all coefficients at a time.
 *
 * As many scales as there are threads are computed together and then handed on, so that memory is
 * that of theirs; each is the same to the last bit as in execute.c. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "morlet/plan.h"

typedef struct job {
    const ss_morlet *plan;
    record rec;
    spectra spectra;
} job;

/* A thread's. */
typedef struct lane {
    const job *job;
    size_t scale;
    double *w, *scratch;        /* scratch: NULL if no scale needs it */
    ss_status status;
    ss_error error;
} lane;

static void
compute(void *user)
{
    lane *l = user;
    const job *j = l->job;
    double most = 0;
    l->error.text[0] = '\0';
    l->status = ss_morlet_part(j->plan, l->scale, &j->rec, &j->spectra, l->scratch, NULL,
                               (span){ 0, j->plan->scale[l->scale].n }, &most, l->w, &l->error);
}

static ss_status
give(const lane *l, ss_coefficient_sink *sink, void *user, size_t *done, ss_error *err)
{
    const ss_morlet *plan = l->job->plan;
    const ss_scale *scale = &plan->scale[l->scale];
    if (l->status != SS_OK) {
        if (err != NULL)
            *err = l->error;
        return l->status;
    }
    if (sink(scale, 0, scale->n, l->w, plan->n, user) != 0)
        return SS_STOP;
    *done += scale->n;
    return ss_progress_at(&plan->opts.progress, (double)*done / (double)plan->total);
}

static ss_status
all_scales(lane *l, size_t lanes, ss_coefficient_sink *sink, void *user, ss_error *err)
{
    const ss_morlet *plan = l->job->plan;
    ss_status st = SS_OK;
    size_t done = 0;
    for (size_t first = 0; st == SS_OK && first < plan->n_scales; first += lanes) {
        size_t left = plan->n_scales - first, n = left < lanes ? left : lanes;
        for (size_t t = 0; t < n; t++)
            l[t].scale = first + t;
        ss_pool_run(compute, l, sizeof *l, n);
        for (size_t t = 0; st == SS_OK && t < n; t++)
            st = give(&l[t], sink, user, &done, err);
    }
    return st;
}

static ss_status
prepare(job *j, lane *l, size_t lanes)
{
    const ss_morlet *plan = j->plan;
    size_t most = 0;
    for (size_t i = 0; i < plan->n_scales; i++)
        most = plan->scale[i].n > most ? plan->scale[i].n : most;
    for (size_t t = 0; t < lanes; t++) {
        l[t].job = j;
        l[t].w = most <= SIZE_MAX / (2 * sizeof(double)) ? malloc(2 * most * sizeof(double)) : NULL;
        if (plan->fft != NULL)
            l[t].scratch = ss_fft_scratch(plan->fft);
        if (l[t].w == NULL || (plan->fft != NULL && l[t].scratch == NULL))
            return SS_ENOMEM;
    }
    return plan->fft != NULL ? ss_fft_forward(plan->fft, &j->rec, &j->spectra) : SS_OK;
}

ss_status
ss_morlet_each(const ss_morlet *plan, const double *x, ss_coefficient_sink *sink, void *user,
               ss_error *err)
{
    if (plan == NULL || x == NULL || sink == NULL)
        return SS_FAIL_NULL(err);
    job j = { .plan = plan };
    size_t lanes = (size_t)plan->opts.threads;
    lanes = lanes < plan->n_scales ? lanes : plan->n_scales;
    ss_status st = ss_morlet_record(&j.rec, x, plan->n, plan->opts.detrend, err);
    if (st != SS_OK)
        return st;
    lane *l = calloc(lanes, sizeof *l);
    st = l != NULL ? prepare(&j, l, lanes) : SS_ENOMEM;
    if (st == SS_OK)
        st = all_scales(l, lanes, sink, user, err);
    for (size_t t = 0; l != NULL && t < lanes; t++) {
        if (l[t].scratch != NULL)
            ss_fft_scratch_free(l[t].scratch);
        free(l[t].w);
    }
    free(l);
    ss_fft_release(&j.spectra);
    free(j.rec.x);
    return st;
}
