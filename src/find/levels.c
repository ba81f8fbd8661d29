/* levels.c -- see levels.h. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/pool.h"
#include "base/progress.h"
#include "base/versions.h"
#include "find/levels.h"
#include "map/plan.h"

struct levels {
    ss_coefficients *grid;
    ss_morlet *plan;
    record rec;
    spectra spectra;
};

/* The parts of one thread: those from first on, `every` apart. */
typedef struct task {
    const map_source *source;
    const level_part *part;
    size_t n, first, every;
    ss_status status;
} task;

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

static ss_status
compute_part(const levels *l, const level_part *part, double *scratch, double *w)
{
    ss_status st = SS_OK;
    double most = 0;
    for (size_t k = 0, n; st == SS_OK && k < part->n; k += n) {
        n = ss_morlet_part_length(l->plan, part->row, part->first + k);
        n = n < part->n - k ? n : part->n - k;
        span now = { part->first + k, n };
        st = ss_morlet_part(l->plan, part->row, &l->rec, &l->spectra, scratch, NULL, now, &most, w,
                            NULL);
        if (st == SS_OK)
            magnitudes_of(w, now.n, part->level + k);
    }
    return st;
}

static void
fill_parts(void *user)
{
    task *t = user;
    const levels *l = t->source->levels;
    double *w = malloc(2 * ss_morlet_part_most(l->plan) * sizeof *w), *scratch = NULL;
    t->status = w != NULL ? ss_morlet_scratch(l->plan, &scratch) : SS_ENOMEM;
    for (size_t i = t->first; t->status == SS_OK && i < t->n; i += t->every)
        t->status = compute_part(l, &t->part[i], scratch, w);
    ss_fft_scratch_free(scratch);
    free(w);
}

ss_status
ss_levels_fill(const map_source *source, const level_part *part, size_t n)
{
    const ss_coefficients *grid = source->grid;
    for (size_t i = 0; source->levels == NULL && i < n; i++)
        magnitudes_of(grid->w + 2 * (grid->scale[part[i].row].offset + part[i].first), part[i].n,
                    part[i].level);
    if (source->levels == NULL)
        return SS_OK;
    task share[SS_THREADS_MAX];
    size_t threads = (size_t)source->levels->plan->opts.threads;
    ss_status st = SS_OK;
    for (size_t t = 0; t < threads; t++)
        share[t] = (task){ source, part, n, t, threads, SS_OK };
    ss_pool_run(fill_parts, share, sizeof *share, threads);
    for (size_t t = 0; t < threads; t++)
        st = st == SS_OK ? share[t].status : st;
    return st;
}

static inline size_t
digit_of(double level, int shift, size_t mask)
{
    uint64_t bits;
    memcpy(&bits, &level, sizeof bits);
    return bits >> shift & mask;
}

/* The middle one is found digit by digit of the numbers' bits, which are ordered as the numbers are: numbers
 * without its digit are moved behind the others. */
double
ss_levels_middle(double *level, size_t n)
{
    enum { BITS = 13, DIGITS = 1 << BITS };
    size_t place = n / 2;
    for (int shift = 64 - BITS; n > 1 && shift > -BITS; shift -= BITS) {
        size_t count[DIGITS] = { 0 }, digit = 0, left = 0;
        int low = shift > 0 ? shift : 0;
        for (size_t i = 0; i < n; i++)
            count[digit_of(level[i], low, DIGITS - 1)]++;
        for (; place >= count[digit]; digit++)
            place -= count[digit];
        for (size_t i = 0; i < n; i++) {
            double here = level[i];
            level[i] = level[left];
            level[left] = here;
            left += digit_of(here, low, DIGITS - 1) == digit;
        }
        n = left;
    }
    return level[0];
}

ss_status
ss_levels_progress(const map_source *source, double done)
{
    return source->levels == NULL ? SS_OK
        : ss_progress_at(&source->levels->plan->opts.progress, done);
}

static ss_status
new_plan(map_source *out, size_t n, double rate, const ss_morlet_opts *opts, ss_error *err)
{
    levels *l = calloc(1, sizeof *l);
    *out = (map_source){ .levels = l };
    return l != NULL ? ss_morlet_new(&l->plan, n, rate, opts, err) : SS_ENOMEM;
}

ss_status
ss_levels_read(map_source *source, const double *x, ss_error *err)
{
    levels *l = source->levels;
    ss_status st = ss_morlet_record(&l->rec, x, l->plan->n, l->plan->opts.detrend, err);
    return st == SS_OK ? ss_morlet_forward(l->plan, &l->rec, &l->spectra) : st;
}

ss_status
ss_levels_of_samples(map_source *out, const double *x, size_t n, double rate,
                     const ss_morlet_opts *opts, ss_error *err)
{
    ss_status st = new_plan(out, n, rate, opts, err);
    return st == SS_OK ? ss_levels_read(out, x, err) : st;
}

ss_status
ss_levels_new(map_source *out, const ss_signal *signal, size_t column, const ss_morlet_opts *opts,
              ss_error *err)
{
    ss_status st = new_plan(out, signal->n, signal->head->rate, opts, err);
    if (st == SS_OK)
        st = ss_morlet_grid_of(&out->levels->grid, signal, column, out->levels->plan, opts);
    if (out->levels != NULL)
        out->grid = out->levels->grid;
    return st;
}

const ss_scale *
ss_levels_scale(const map_source *source, size_t row)
{
    return ss_morlet_scale(source->levels->plan, row);
}

void
ss_levels_free(map_source *source)
{
    levels *l = source->levels;
    if (l == NULL)
        return;
    ss_morlet_spectra_free(&l->spectra);
    free(l->rec.x);
    ss_coefficients_free(l->grid);
    ss_morlet_free(l->plan);
    free(l);
}
