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
#include "map/plan.h"

typedef struct scale_queue {
    const ss_morlet *plan;
    record rec;
    spectra spectra;
    double *w;
    pthread_mutex_t lock;       /* of the following fields */
    size_t next;                /* the scales before this one are not yet computed */
    size_t done;                /* coefficients */
    size_t failed;              /* the longest scale that failed; its status and reason follow */
    ss_status status;
    ss_error error;
} scale_queue;

/* The work of a thread: compute scales until none is left, the expensive short ones first. */
static void
compute_scales(void *user)
{
    scale_queue *queue = user;
    const ss_morlet *plan = queue->plan;
    double *scratch;
    ss_status have = ss_morlet_scratch(plan, &scratch);
    pthread_mutex_lock(&queue->lock);
    if (have != SS_OK) {
        queue->next = queue->failed = 0;
        queue->status = SS_ENOMEM;
    }
    while (queue->next > 0) {
        size_t i = --queue->next;
        ss_error err = { 0 };
        pthread_mutex_unlock(&queue->lock);
        ss_status st = ss_morlet_whole(plan, i, &queue->rec, &queue->spectra, scratch,
                                       queue->w + 2 * plan->scale[i].offset, &err);
        pthread_mutex_lock(&queue->lock);
        if (st != SS_OK && (queue->status == SS_OK || i < queue->failed)) {
            queue->failed = i;
            queue->status = st;
            queue->error = err;
        }
        queue->done += plan->scale[i].n;
        if (queue->status == SS_OK)
            queue->status = ss_progress_at(&plan->opts.progress,
                                           (double)queue->done / (double)plan->total);
        if (queue->status == SS_STOP)
            queue->next = 0;
    }
    pthread_mutex_unlock(&queue->lock);
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
    st = ss_morlet_forward(plan, &queue.rec, &queue.spectra);
    if (st == SS_OK) {
        size_t threads = (size_t)plan->opts.threads;
        pthread_mutex_init(&queue.lock, NULL);
        ss_pool_run(compute_scales, &queue, 0, threads < plan->n_scales ? threads : plan->n_scales);
        pthread_mutex_destroy(&queue.lock);
        if ((st = queue.status) != SS_OK && err != NULL)
            *err = queue.error;
    }
    ss_morlet_spectra_free(&queue.spectra);
    free(queue.rec.x);
    return st;
}
