/* window.c -- a window of a level: its samples, its spectrum, and the samples of the next level.
 *
 * blocks.c says what a window is, and how large the error. */
#include <fftw3.h>
#include <string.h>
#include "base/versions.h"
#include "map/fft/window.h"

void
ss_window_copy(const samples *s, ptrdiff_t first, size_t n, double *to)
{
    ptrdiff_t end = first + (ptrdiff_t)n;
    ptrdiff_t lo = first > s->lo ? first : s->lo, hi = end < s->hi ? end : s->hi;
    if (lo >= hi)
        lo = hi = end;
    memset(to, 0, (size_t)(lo - first) * sizeof *to);
    if (hi > lo)
        memcpy(to + (lo - first), s->x + (lo - s->lo), (size_t)(hi - lo) * sizeof *to);
    memset(to + (hi - first), 0, (size_t)(end - hi) * sizeof *to);
}

void
ss_window_transform(const stage *st, const double *x, double *v, double *terms)
{
    size_t before = st->overlap / 2;
    memcpy(v, x + before, (st->length - before) * sizeof *v);
    memcpy(v + st->length - before, x, before * sizeof *v);
    fftw_execute_dft_r2c(st->forward, v, (fftw_complex *)terms);
}

/* The terms k <= L/4 of the same window on the next level, from those on this one. */
VERSIONS static void
filter_terms(const stage *st, const double *restrict x, double *restrict y)
{
    size_t half = st->length / 4;
    const double *f = st->filter, *g = f + half + 1, *z = x + st->length;
    for (size_t k = 0; k <= half; k++) {
        y[2 * k] = f[k] * x[2 * k] + g[k] * *(z - 2 * k);
        y[2 * k + 1] = f[k] * x[2 * k + 1] - g[k] * *(z - 2 * k + 1);
    }
}

void
ss_window_decimate(const stage *st, const double *terms, double *spare, double *to)
{
    filter_terms(st, terms, spare);
    fftw_execute_dft_c2r(st->back, (fftw_complex *)spare, to);
}

size_t
ss_window_room(const struct blocks *b)
{
    size_t most = 0;
    for (size_t l = 0; l < b->levels; l++)
        most = b->stage[l].stride > most ? b->stage[l].stride : most;
    return 3 * most;
}
