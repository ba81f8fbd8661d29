/* execute.c -- a plan: the grid of a record, and the engine of each scale; and its execution: parts of its scales,
 * on the number of threads in the options, into memory, to a sink, or to whoever reads a map.
 *
 * One thread computes a part, from input that all threads share and none changes, so the result does
 * not depend on the number of threads. */
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/versions.h"
#include "map/fft/blocks.h"
#include "map/plan.h"

enum {
    PART = 1 << 14,             /* coefficients by the definition, computed at a time */
    WORTH_THREADS = 64,         /* the caller's thread alone computes fewer coefficients than these, */
    BLOCK_WORTH_THREADS = 1 << 14       /* and in blocks fewer than these */
};

ss_status
ss_morlet_new(ss_morlet **out, size_t n, double rate, const ss_morlet_opts *given, ss_error *err)
{
    ss_morlet_opts opts;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_morlet_take(&opts, given, err);
    if (st == SS_OK)
        st = ss_morlet_check(n, rate, &opts, err);
    if (st != SS_OK)
        return st;
    ss_morlet *plan = calloc(1, sizeof *plan);
    if (plan == NULL)
        return SS_ENOMEM;
    *plan = (ss_morlet){ .opts = opts, .n = n, .rate = rate };
    st = ss_grid_make(&plan->scale, &plan->n_scales, n, rate, &opts, err);
    for (size_t i = 0; st == SS_OK && i < plan->n_scales; i++) {
        plan->scale[i].offset = plan->total;
        plan->total += plan->scale[i].n;
        if (plan->total > SIZE_MAX / (2 * sizeof(double)))
            st = SS_ENOMEM;
    }
    if (st == SS_OK)
        st = ss_blocks_new(plan);
    if (st != SS_OK) {
        ss_morlet_free(plan);
        return st;
    }
    for (size_t i = 0; i < plan->n_scales; i++)
        plan->scale[i].engine = ss_blocks_covers(plan->blocks, i) ? SS_ENGINE_FFT : SS_ENGINE_QUADRATURE;
    plan->grid = (ss_grid){ plan->n_scales, plan->scale, plan->total };
    *out = plan;
    return SS_OK;
}

const ss_grid *
ss_morlet_grid(const ss_morlet *plan)
{
    return plan != NULL ? &plan->grid : NULL;
}

void
ss_morlet_free(ss_morlet *plan)
{
    if (plan == NULL)
        return;
    for (size_t i = 0; plan->wave != NULL && i < plan->n_scales; i++)
        ss_wavelet_free(plan->wave[i]);
    ss_blocks_free(plan->blocks);
    free(plan->wave);
    free(plan->scale);
    free(plan);
}

/* --- parts -------------------------------------------------------------------------------------- */

ss_status
ss_morlet_keep_wavelets(ss_morlet *plan)
{
    plan->wave = calloc(plan->n_scales, sizeof(wavelet *));
    for (size_t i = 0; plan->wave != NULL && i < plan->n_scales; i++)
        if (!ss_blocks_covers(plan->blocks, i)
            && (plan->wave[i] = ss_wavelet_new(&plan->opts, plan->scale[i].a, plan->rate, plan->n)) == NULL)
            return SS_ENOMEM;
    return plan->wave != NULL ? SS_OK : SS_ENOMEM;
}

ss_status
ss_morlet_part(const ss_morlet *plan, const transformed *of, double *scratch, const ss_map_part *part,
               ss_error *err)
{
    const ss_scale *scale = &plan->scale[part->scale];
    const span range = { part->first, part->n };
    double factor = plan->opts.norm == SS_NORM_L1 ? 1 : sqrt(scale->a), *w = part->w;
    factor = ldexp(factor, of->rec.exponent);
    int fits = factor > 1e-250 && factor < 1e300;   /* |W| is below 4 in these units */
    factor = fits ? factor : 1;
    if (ss_blocks_covers(plan->blocks, part->scale))
        ss_blocks_scale(plan->blocks, part->scale, &of->spectra, scratch, range, factor, w);
    else {
        wavelet *own = NULL;
        const wavelet *wave = plan->wave != NULL ? plan->wave[part->scale] : NULL;
        if (wave == NULL && (wave = own = ss_wavelet_new(&plan->opts, scale->a, plan->rate, plan->n)) == NULL)
            return SS_ENOMEM;
        for (size_t k = 0; k < part->n; k++) {
            ss_wavelet_sum(wave, &of->rec, ss_scale_spot(scale, part->first + k, plan->rate), w + 2 * k);
            w[2 * k] *= factor;
            w[2 * k + 1] *= factor;
        }
        ss_wavelet_free(own);
    }
    return fits ? SS_OK : ss_morlet_finish(w, part->n, scale->a, plan->opts.norm, of->rec.exponent, err);
}

size_t
ss_morlet_part_length(const ss_morlet *plan, size_t i, size_t k)
{
    return ss_blocks_covers(plan->blocks, i) ? ss_blocks_rest(plan->blocks, i, k) : PART;
}

size_t
ss_morlet_part_most(const ss_morlet *plan)
{
    size_t most = PART;
    for (size_t i = 0; i < plan->n_scales; i++)
        if (ss_blocks_covers(plan->blocks, i) && ss_blocks_most(plan->blocks, i) > most)
            most = ss_blocks_most(plan->blocks, i);
    return most;
}

/* --- on threads --------------------------------------------------------------------------------- */

typedef struct queue {
    const ss_morlet *plan;
    const transformed *of;
    const ss_map_part *part;
    size_t *done;               /* coefficients of the plan that are computed; NULL: nobody asks */
    pthread_mutex_t lock;       /* of done and the following fields */
    size_t next;                /* the parts before this one are not yet computed */
    size_t failed;              /* the first part that failed; its status and reason follow */
    ss_status status;
    ss_error error;
} queue;

/* The magnitude of each.  Hardly any number needs hypot, and then this is faster. */
VERSIONS static void
magnitudes_of(const double *restrict w, size_t n, double *restrict level)
{
    uint64_t others = 0;
    for (size_t k = 0; k < n; k++) {
        double square = w[2 * k] * w[2 * k] + w[2 * k + 1] * w[2 * k + 1];
        others += square > SQUARE_LEAST ? 0 : 1;
        others += square < SQUARE_MOST ? 0 : 1;
        level[k] = sqrt(square);
    }
    for (size_t k = 0; k < n && others > 0; k++)
        level[k] = magnitude_of(w + 2 * k);
}

void
ss_map_give(const ss_map_part *part, size_t at, size_t n, const double *w)
{
    if (part->w != NULL)
        memcpy(part->w + 2 * at, w, 2 * n * sizeof *w);
    else
        magnitudes_of(w, n, part->level + at);
}

/* Magnitudes are computed piece by piece, so that they need no room for all coefficients. */
static ss_status
compute_part(const queue *q, const ss_map_part *part, double *scratch, ss_error *err)
{
    ss_map_part piece = *part;
    size_t end = part->first + part->n;
    if (part->w != NULL)
        return ss_morlet_part(q->plan, q->of, scratch, part, err);
    piece.w = malloc(2 * ss_morlet_part_most(q->plan) * sizeof *piece.w);
    ss_status st = piece.w != NULL ? SS_OK : SS_ENOMEM;
    for (; st == SS_OK && piece.first < end; piece.first += piece.n) {
        piece.n = ss_morlet_part_length(q->plan, part->scale, piece.first);
        piece.n = piece.n < end - piece.first ? piece.n : end - piece.first;
        st = ss_morlet_part(q->plan, q->of, scratch, &piece, err);
        if (st == SS_OK)
            ss_map_give(part, piece.first - part->first, piece.n, piece.w);
    }
    free(piece.w);
    return st;
}

/* The work of a thread: compute parts until none is left, the last first, as short scales are expensive. */
static void
compute_parts(void *user)
{
    queue *q = user;
    double *scratch;
    ss_status have = ss_blocks_scratch(q->plan->blocks, &scratch);
    pthread_mutex_lock(&q->lock);
    if (have != SS_OK) {
        q->next = q->failed = 0;
        q->status = SS_ENOMEM;
    }
    while (q->next > 0) {
        size_t i = --q->next;
        ss_error err = { 0 };
        pthread_mutex_unlock(&q->lock);
        ss_status st = compute_part(q, &q->part[i], scratch, &err);
        pthread_mutex_lock(&q->lock);
        if (st != SS_OK && (q->status == SS_OK || i < q->failed)) {
            q->failed = i;
            q->status = st;
            q->error = err;
        }
        if (q->done != NULL && q->status == SS_OK) {
            *q->done += q->part[i].n;
            q->status = ss_progress_at(&q->plan->opts.progress, (double)*q->done / (double)q->plan->total);
        }
        if (q->status == SS_STOP)
            q->next = 0;
    }
    pthread_mutex_unlock(&q->lock);
    ss_blocks_scratch_free(scratch);
}

ss_status
ss_morlet_parts(const ss_morlet *plan, const transformed *of, const ss_map_part part[], size_t n, size_t *done,
                ss_error *err)
{
    size_t threads = (size_t)plan->opts.threads, all = 0;
    for (size_t i = 0; i < n; i++)
        all += part[i].n;
    if (all < (n > 0 && ss_blocks_covers(plan->blocks, part->scale) ? BLOCK_WORTH_THREADS : WORTH_THREADS))
        threads = 1;
    queue q = { .plan = plan, .of = of, .part = part, .done = done, .next = n };
    pthread_mutex_init(&q.lock, NULL);
    ss_pool_run(compute_parts, &q, 0, threads < n ? threads : n);
    pthread_mutex_destroy(&q.lock);
    if (q.status != SS_OK && err != NULL)
        *err = q.error;
    return q.status;
}

ss_status
ss_morlet_begin(const ss_morlet *plan, const double *x, transformed *of, ss_error *err)
{
    *of = (transformed){ .rec.x = NULL };
    ss_status st = ss_morlet_record(&of->rec, x, plan->n, plan->opts.detrend, err);
    return st == SS_OK && plan->blocks != NULL ? ss_blocks_forward(plan->blocks, &of->rec, &of->spectra) : st;
}

void
ss_morlet_end(transformed *of)
{
    ss_morlet_spectra_free(&of->spectra);
    free(of->rec.x);
}

ss_status
ss_morlet_execute(const ss_morlet *plan, const double *x, double *w, ss_error *err)
{
    if (plan == NULL || x == NULL || w == NULL)
        return SS_FAIL_NULL(err);
    transformed of;
    size_t done = 0;
    ss_map_part *part = malloc(plan->n_scales * sizeof *part);
    ss_status st = ss_morlet_begin(plan, x, &of, err);
    if (st == SS_OK && part == NULL)
        st = SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < plan->n_scales; i++)
        part[i] = (ss_map_part){ i, 0, plan->scale[i].n, w + 2 * plan->scale[i].offset, NULL };
    if (st == SS_OK)
        st = ss_morlet_parts(plan, &of, part, plan->n_scales, &done, err);
    ss_morlet_end(&of);
    free(part);
    return st;
}

/* As many scales as there are threads are computed together and then passed to the sink, so only their
 * coefficients are in memory. */
ss_status
ss_morlet_each(const ss_morlet *plan, const double *x, ss_coefficient_sink *sink, void *user, ss_error *err)
{
    if (plan == NULL || x == NULL || sink == NULL)
        return SS_FAIL_NULL(err);
    ss_map_part part[SS_THREADS_MAX];
    size_t most = 0, done = 0, together = (size_t)plan->opts.threads;
    transformed of;
    ss_status st = ss_morlet_begin(plan, x, &of, err);
    together = together < plan->n_scales ? together : plan->n_scales;
    for (size_t i = 0; i < plan->n_scales; i++)
        most = plan->scale[i].n > most ? plan->scale[i].n : most;
    double *w = most <= SIZE_MAX / (2 * sizeof *w) / together ? malloc(2 * most * together * sizeof *w) : NULL;
    if (st == SS_OK && w == NULL)
        st = SS_ENOMEM;
    for (size_t first = 0, n; st == SS_OK && first < plan->n_scales; first += n) {
        n = plan->n_scales - first < together ? plan->n_scales - first : together;
        for (size_t i = 0; i < n; i++)
            part[i] = (ss_map_part){ first + i, 0, plan->scale[first + i].n, w + 2 * most * i, NULL };
        st = ss_morlet_parts(plan, &of, part, n, NULL, err);
        for (size_t i = 0; st == SS_OK && i < n; i++) {
            const ss_scale *scale = &plan->scale[first + i];
            if (sink(scale, 0, scale->n, part[i].w, plan->n, user) != 0)
                st = SS_STOP;
            done += scale->n;
            if (st == SS_OK)
                st = ss_progress_at(&plan->opts.progress, (double)done / (double)plan->total);
        }
    }
    free(w);
    ss_morlet_end(&of);
    return st;
}
