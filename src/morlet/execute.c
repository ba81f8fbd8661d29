/* execute.c -- execute a plan: each scale by its engine, on the number of threads in the options.
 *
 * One thread computes a scale, from input that all threads share and none changes, so the result does
 * not depend on the number of threads. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "morlet/plan.h"

ss_status
ss_morlet_finish(double *w, size_t n, double a, ss_norm norm, int exponent, ss_error *err)
{
    double factor = norm == SS_NORM_L1 ? 1 : sqrt(a);
    for (size_t i = 0; i < 2 * n; i++) {
        w[i] = ldexp(w[i] * factor, exponent);
        if (!isfinite(w[i]))
            return ss_fail(err, SS_EINVAL, "coefficients at scale %g s exceed what a double holds",
                           a);
    }
    return SS_OK;
}

ss_status
ss_morlet_part(const ss_morlet *plan, size_t i, const record *rec, const spectra *s,
               double *scratch, wavelet *wave, span part, double *most, double *w, ss_error *err)
{
    const ss_scale *scale = &plan->scale[i];
    double factor = plan->opts.norm == SS_NORM_L1 ? 1 : sqrt(scale->a);
    factor = ldexp(factor, rec->exponent);
    int fits = factor > 1e-250 && factor < 1e300;   /* |W| is below 4 in these units */
    factor = fits ? factor : 1;
    if (s != NULL && ss_fft_covers(plan->fft, i)) {
        if (scratch == NULL)
            return SS_ENOMEM;
        ss_fft_scale(plan, i, rec, s, scratch, part, factor, most, w);
    } else {
        wavelet *own = wave == NULL ? ss_wavelet_new(&plan->opts, scale->a, plan->rate, plan->n)
            : NULL;
        if (wave == NULL && own == NULL)
            return SS_ENOMEM;
        ss_quadrature_scale(plan, scale, rec, wave != NULL ? wave : own, part, factor, most, w);
        ss_wavelet_free(own);
    }
    return fits ? SS_OK
        : ss_morlet_finish(w, part.n, scale->a, plan->opts.norm, rec->exponent, err);
}

typedef struct scale_queue {
    const ss_morlet *plan;
    record rec;
    spectra spectra;
    double *w;
    pthread_mutex_t lock;       /* of the following fields */
    size_t next;                /* scales below it are left */
    size_t done;                /* coefficients */
    size_t failed;              /* the longest scale that failed, how and why */
    ss_status status;
    ss_error error;
} scale_queue;

static ss_status
one_scale(const scale_queue *queue, size_t i, double *scratch, ss_error *err)
{
    const ss_scale *scale = &queue->plan->scale[i];
    double most = 0;
    return ss_morlet_part(queue->plan, i, &queue->rec, &queue->spectra, scratch, NULL,
                          (span){ 0, scale->n }, &most, queue->w + 2 * scale->offset, err);
}

/* A thread: compute scales until none is left, the expensive short ones first. */
static void
compute_scales(void *user)
{
    scale_queue *queue = user;
    const ss_morlet_opts *opts = &queue->plan->opts;
    double *scratch = queue->plan->fft != NULL ? ss_fft_scratch(queue->plan->fft) : NULL;
    pthread_mutex_lock(&queue->lock);
    if (scratch == NULL && queue->plan->fft != NULL) {
        queue->next = queue->failed = 0;
        queue->status = SS_ENOMEM;
    }
    while (queue->next > 0) {
        size_t i = --queue->next;
        ss_error err = { "" };
        pthread_mutex_unlock(&queue->lock);
        ss_status st = one_scale(queue, i, scratch, &err);
        pthread_mutex_lock(&queue->lock);
        if (st != SS_OK && (queue->status == SS_OK || i < queue->failed)) {
            queue->failed = i;
            queue->status = st;
            queue->error = err;
        }
        queue->done += queue->plan->scale[i].n;
        if (queue->status == SS_OK)
            queue->status = ss_progress_at(&opts->progress,
                                           (double)queue->done / (double)queue->plan->total);
        if (queue->status == SS_STOP)
            queue->next = 0;
    }
    pthread_mutex_unlock(&queue->lock);
    if (scratch != NULL)
        ss_fft_scratch_free(scratch);
}

ss_status
ss_morlet_execute(const ss_morlet *plan, const double *x, double *w, ss_error *err)
{
    if (plan == NULL || x == NULL || w == NULL)
        return SS_FAIL_NULL(err);
    scale_queue queue = { .plan = plan, .w = w, .next = plan->n_scales };
    ss_status st = ss_morlet_record(&queue.rec, x, plan->n, plan->opts.detrend, err);
    if (st != SS_OK)
        return st;
    if (plan->fft != NULL)
        st = ss_fft_forward(plan->fft, &queue.rec, &queue.spectra);
    if (st == SS_OK) {
        size_t threads = (size_t)plan->opts.threads;
        pthread_mutex_init(&queue.lock, NULL);
        ss_pool_run(compute_scales, &queue, 0, threads < plan->n_scales ? threads : plan->n_scales);
        pthread_mutex_destroy(&queue.lock);
        if ((st = queue.status) != SS_OK && err != NULL)
            *err = queue.error;
    }
    ss_spectra_free(&queue.spectra);
    free(queue.rec.x);
    return st;
}
