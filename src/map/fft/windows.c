/* windows.c -- the spectra of all windows of a record, and the adjoint: a record from such spectra.
 *
 * blocks.c says what a window is, and how large the error.  Window i of a level begins at its sample
 * (i - 1) hop, and window 0 makes only samples before the record's first, which the next level has. */
#include <fftw3.h>
#include <stdlib.h>
#include <string.h>
#include "base/pool.h"
#include "base/versions.h"
#include "map/fft/blocks.h"
#include "map/fft/stage.h"
#include "map/fft/window.h"

enum { WORTH_A_THREAD = 8 };    /* windows */

/* --- a whole record --------------------------------------------------------------------------- */

/* Some windows of a level, the work of one thread. */
typedef struct task {
    const stage *st;
    const samples *from;
    samples *next;              /* NULL: not needed */
    double *spectra, *v;        /* spectra from window 0 on, or NULL; window_room doubles */
    size_t first, end;          /* windows */
} task;

static void
one_window(const task *t, size_t i)
{
    const stage *st = t->st;
    ptrdiff_t first = ((ptrdiff_t)i - 1) * (ptrdiff_t)st->hop;
    double *terms = t->spectra != NULL ? t->spectra + i * st->stride : t->v + st->stride;
    double *spare = t->v + 2 * st->stride;
    ss_window_copy(t->from, first - (ptrdiff_t)(st->overlap / 2), st->length, spare);
    ss_window_transform(st, spare, t->v, terms);
    if (t->next == NULL)
        return;
    samples made = { spare, first / 2, (first + (ptrdiff_t)st->hop) / 2 };
    ptrdiff_t lo = made.lo > t->next->lo ? made.lo : t->next->lo;
    ptrdiff_t hi = made.hi < t->next->hi ? made.hi : t->next->hi;
    if (lo >= hi)
        return;
    ss_window_decimate(st, terms, t->v, spare);
    ss_window_copy(&made, lo, (size_t)(hi - lo), t->next->x + (lo - t->next->lo));
}

static void
some_windows(void *user)
{
    const task *t = user;
    for (size_t i = t->first; i < t->end; i++)
        one_window(t, i);
}

/* Compute the spectra of a level, if its scales need them, and the samples of the next level. */
static ss_status
forward_stage(const stage *st, task all, size_t room, size_t threads, double **out)
{
    task part[SS_THREADS_MAX];
    size_t most = 1 + st->windows / WORTH_A_THREAD, n = threads < most ? threads : most;
    if (st->used && (*out = fftw_malloc(st->windows * st->stride * sizeof **out)) == NULL)
        return SS_ENOMEM;
    all.spectra = *out;
    for (size_t i = 0; i < n; i++) {
        part[i] = all;
        part[i].v = all.v + i * room;
        part[i].first = st->windows * i / n;
        part[i].end = st->windows * (i + 1) / n;
    }
    ss_pool_run(some_windows, part, sizeof *part, n);
    return SS_OK;
}

static ss_status
samples_new(samples *s, const stage *st)
{
    *s = (samples){ .lo = -(ptrdiff_t)st->margin, .hi = (ptrdiff_t)(st->n + st->margin) };
    s->x = calloc((size_t)(s->hi - s->lo), sizeof *s->x);
    return s->x != NULL ? SS_OK : SS_ENOMEM;
}

double *
ss_fft_doubles(size_t n)
{
    return fftw_malloc(n * sizeof(double));
}

void
ss_fft_scratch_free(double *scratch)
{
    fftw_free(scratch);
}

ss_status
ss_blocks_forward(const struct blocks *b, const record *rec, size_t threads, spectra *out)
{
    samples now = { rec->x, 0, (ptrdiff_t)rec->n }, next = { 0 };
    size_t room = ss_window_room(b);
    double *v = fftw_malloc(threads * room * sizeof *v);
    ss_status st = v != NULL ? SS_OK : SS_ENOMEM;
    for (size_t l = 0; st == SS_OK && l < b->levels; l++) {
        int last = l + 1 == b->levels;
        task all = { .st = &b->stage[l], .from = &now, .next = last ? NULL : &next, .v = v };
        if (!last)
            st = samples_new(&next, &b->stage[l + 1]);
        if (st == SS_OK)
            st = forward_stage(&b->stage[l], all, room, threads, &out->level[l]);
        if (l > 0)
            free(now.x);
        now = next;
        next.x = NULL;
    }
    if (st != SS_OK && now.x != rec->x)
        free(now.x);
    fftw_free(v);
    return st;
}

void
ss_morlet_spectra_free(spectra *s)
{
    for (size_t l = 0; l < LEVELS; l++)
        fftw_free(s->level[l]);
}

/* --- the adjoint ------------------------------------------------------------------------------ */

/* Sample first + i += v[i]. */
static void
add_samples(const samples *s, ptrdiff_t first, size_t n, const double *v)
{
    ptrdiff_t end = first + (ptrdiff_t)n;
    ptrdiff_t lo = first > s->lo ? first : s->lo, hi = end < s->hi ? end : s->hi;
    for (ptrdiff_t k = lo; k < hi; k++)
        s->x[k - s->lo] += v[k - first];
}

/* The adjoint of filter_terms, y being the spectrum of real samples. */
VERSIONS static void
unfilter_terms(const stage *st, const double *restrict y, double *restrict x)
{
    size_t half = st->length / 4;
    const double *f = st->filter, *g = f + half + 1;
    double *z = x + st->length;
    for (size_t k = 0; k < half; k++) {
        x[2 * k] += f[k] * y[2 * k];
        x[2 * k + 1] += f[k] * y[2 * k + 1];
        *(z - 2 * k) += g[k] * y[2 * k];
        *(z - 2 * k + 1) -= g[k] * y[2 * k + 1];
    }
    x[2 * half] += (f[half] + g[half]) / 2 * y[2 * half];
}

/* The adjoint of one_window: samples of the next level, if there is one, and sums to those of this. */
static void
sums_window(const block_sums *s, size_t l, size_t i, const samples *next, const samples *to)
{
    const stage *st = &s->b->stage[l];
    ptrdiff_t first = ((ptrdiff_t)i - 1) * (ptrdiff_t)st->hop;
    size_t before = st->overlap / 2, inside = st->length - before, made = st->hop / 2;
    double *v = s->v, *terms = v + st->stride, *half = v + 2 * st->stride;
    if (s->level[l] != NULL)
        terms = s->level[l] + i * st->stride;
    else
        memset(terms, 0, st->stride * sizeof *terms);
    if (next != NULL) {
        ss_window_copy(next, first / 2, made, v);
        memset(v + made, 0, (st->length / 2 - made) * sizeof *v);
        fftw_execute_dft_r2c(s->half[l], v, (fftw_complex *)half);
        unfilter_terms(st, half, terms);
    }
    fftw_execute_dft_c2r(s->back[l], (fftw_complex *)terms, v);
    add_samples(to, first, inside, v);
    add_samples(to, first - (ptrdiff_t)before, before, v + inside);
    memset(terms, 0, st->stride * sizeof *terms);
}

ss_status
ss_block_sums_end(block_sums *s, double *x)
{
    samples next = { 0 }, now;
    ss_status status = SS_OK;
    for (size_t l = s->b->levels; status == SS_OK && l-- > 0;) {
        const stage *st = &s->b->stage[l];
        if (l > 0)
            status = samples_new(&now, st);
        else
            now = (samples){ x, 0, (ptrdiff_t)st->n };
        for (size_t i = 0; status == SS_OK && i < st->windows; i++)
            sums_window(s, l, i, next.x != NULL ? &next : NULL, &now);
        free(next.x);
        next = now;
    }
    return status;
}

block_sums *
ss_block_sums_new(const struct blocks *b)
{
    block_sums *s = calloc(1, sizeof *s);
    if (s == NULL)
        return NULL;
    s->b = b;
    int failed = (s->v = fftw_malloc(ss_window_room(b) * sizeof *s->v)) == NULL;
    for (size_t l = 0; !failed && l < b->levels; l++) {
        size_t room = b->stage[l].windows * b->stage[l].stride * sizeof(double);
        if (b->stage[l].used)
            failed = (s->level[l] = fftw_malloc(room)) == NULL;
        if (s->level[l] != NULL)
            memset(s->level[l], 0, room);
    }
    for (size_t i = 0; !failed && i < b->n_places; i++)
        failed = (s->places[i] = ss_columns_new(b->kernel, ss_dense_phases(b->places[i]))) == NULL;
    if (!failed && ss_sums_plans_make(s) == SS_OK)
        return s;
    ss_block_sums_free(s);
    return NULL;
}

void
ss_block_sums_free(block_sums *s)
{
    if (s == NULL)
        return;
    ss_sums_plans_free(s);
    for (size_t l = 0; l < s->b->levels; l++)
        fftw_free(s->level[l]);
    for (size_t i = 0; i < s->b->n_places; i++)
        ss_columns_free(s->places[i]);
    fftw_free(s->v);
    free(s);
}
