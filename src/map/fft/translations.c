/* translations.c -- the coefficients of a scale from the spectra of its windows (windows.c).
 *
 * blocks.c says how they follow, and how large the error is. */
#include <fftw3.h>
#include <math.h>
#include <string.h>
#include "base/versions.h"
#include "map/fft/stage.h"

/* --- the terms and points of a series ------------------------------------------------------------ */

/* to += g x over n terms, of which term k of the spectrum x of m points, a real signal's, is the first:
 * to term at of length, and on around it. */
VERSIONS static void
add_terms(const double *x, size_t m, ptrdiff_t k, const double *g, size_t n, double *to, size_t length, size_t at)
{
    while (n > 0) {
        ptrdiff_t r = k % (ptrdiff_t)m;
        size_t from = (size_t)(r < 0 ? r + (ptrdiff_t)m : r);
        int mirrored = from > m / 2;        /* of a real signal, X_-k = conj X_k */
        size_t run = mirrored ? m - from : m / 2 + 1 - from;
        run = run < n ? run : n;
        run = run < length - at ? run : length - at;
        double *out = to + 2 * at;
        if (mirrored)
            for (size_t i = 0; i < run; i++) {
                const double *in = x + 2 * (m - from - i);
                out[2 * i] += g[i] * in[0];
                out[2 * i + 1] -= g[i] * in[1];
            }
        else
            for (size_t i = 0; i < run; i++) {
                out[2 * i] += g[i] * x[2 * (from + i)];
                out[2 * i + 1] += g[i] * x[2 * (from + i) + 1];
            }
        g += run;
        n -= run;
        k += (ptrdiff_t)run;
        at = (at + run) % length;
    }
}

/* The adjoint of add_terms: from the terms `from` to the spectrum x, of which terms 0 and m/2 count twice.
 * What is added is the conjugate of its terms. */
VERSIONS static void
add_conjugate_terms(const double *from, size_t length, size_t at, const double *g, size_t n, double *x,
                    size_t m, ptrdiff_t k)
{
    while (n > 0) {
        ptrdiff_t r = k % (ptrdiff_t)m;
        size_t to = (size_t)(r < 0 ? r + (ptrdiff_t)m : r);
        int mirrored = to > m / 2, real = to % (m / 2) == 0;
        size_t run = mirrored ? m - to : real ? 1 : m / 2 - to;
        run = run < n ? run : n;
        run = run < length - at ? run : length - at;
        const double *in = from + 2 * at;
        if (real)
            x[2 * to] += 2 * g[0] * in[0];
        else if (mirrored)
            for (size_t i = 0; i < run; i++) {
                double *out = x + 2 * (m - to - i);
                out[0] += g[i] * in[2 * i];
                out[1] += g[i] * in[2 * i + 1];
            }
        else
            for (size_t i = 0; i < run; i++) {
                x[2 * (to + i)] += g[i] * in[2 * i];
                x[2 * (to + i) + 1] -= g[i] * in[2 * i + 1];
            }
        g += run;
        n -= run;
        k += (ptrdiff_t)run;
        at = (at + run) % length;
    }
}

/* n values of a series times factor into w. */
VERSIONS static void
write_points(const double *restrict v, size_t n, double factor, double *restrict w)
{
    for (size_t i = 0; i < 2 * n; i++)
        w[i] = v[i] * factor;
}

/* The conjugate of n values times factor into v. */
VERSIONS static void
add_points(const double *restrict w, size_t n, double factor, double *restrict v)
{
    for (size_t i = 0; i < n; i++) {
        v[2 * i] = w[2 * i] * factor;
        v[2 * i + 1] = -w[2 * i + 1] * factor;
    }
}

/* --- a scale ------------------------------------------------------------------------------------- */

/* The sample of the record at which a window of a scale begins. */
static double
start_of(const struct blocks *b, const block_scale *r, size_t window)
{
    return ldexp(((double)window - 1) * (double)b->stage[r->level].hop, r->level);
}

static size_t
window_of(const struct blocks *b, size_t i, size_t k)
{
    const block_scale *r = &b->scale[i];
    if (r->kind != BETWEEN)
        return 1 + k / r->hop;
    return 1 + (size_t)(ss_scale_spot(&b->grid[i], k, b->rate).c / start_of(b, r, 2));
}

size_t
ss_blocks_end(const struct blocks *b, size_t i, size_t window)
{
    const block_scale *r = &b->scale[i];
    const ss_scale *scale = &b->grid[i];
    if (r->kind != BETWEEN)
        return window * r->hop;
    double end = start_of(b, r, window + 1);
    size_t k = (size_t)(end / (b->rate * scale->b_num / scale->b_den));
    while (ss_scale_spot(scale, k, b->rate).c < end)
        k++;
    while (k > 0 && ss_scale_spot(scale, k - 1, b->rate).c >= end)
        k--;
    return k;
}

size_t
ss_blocks_most(const struct blocks *b, size_t i)
{
    const ss_scale *scale = &b->grid[i];
    const block_scale *r = &b->scale[i];
    double step = b->rate * scale->b_num / scale->b_den;
    return r->kind == BETWEEN ? (size_t)(start_of(b, r, 2) / step) + 2 : r->hop;
}

size_t
ss_blocks_rest(const struct blocks *b, size_t i, size_t k)
{
    return ss_blocks_end(b, i, window_of(b, i, k)) - k;
}

/* Where term lo goes among the points of a scale. */
static size_t
place_of_terms(const block_scale *r)
{
    ptrdiff_t rest = (r->lo - r->mid) % (ptrdiff_t)r->points;
    return (size_t)(rest < 0 ? rest + (ptrdiff_t)r->points : rest);
}

/* Compute all points of a window, of which v[0] belongs to the window's first translation.  For kernels,
 * the points are continued before and after, as on a circle. */
static void
transform_window(const stage *st, const block_scale *r, const double *x, double *c, double *v)
{
    memset(c, 0, 2 * r->points * sizeof *c);
    add_terms(x, st->length, r->lo, r->weight, r->terms, c, r->points, place_of_terms(r));
    fftw_execute_dft(r->inverse, (fftw_complex *)c, (fftw_complex *)v);
    if (r->kind != AT_POINTS) {
        memcpy(v - 2 * DENSE_MARGIN, v + 2 * (r->points - DENSE_MARGIN), 2 * DENSE_MARGIN * sizeof *v);
        memcpy(v + 2 * r->points, v, 2 * DENSE_MARGIN * sizeof *v);
    }
}

/* The points v of a window, between which translations lie. */
static point_series
series_of(const struct blocks *b, const block_scale *r, size_t window, const double *v)
{
    double apart = (double)b->stage[r->level].circle / (double)r->points;
    double turns = (double)r->mid / (double)r->points;
    return (point_series){ v, start_of(b, r, window), apart, turns };
}

/* Write n translations of a window from `first` on.  Places repeat from point to point, so those before
 * the first whole pattern are written apart. */
static void
write_each(const struct blocks *b, const block_scale *r, size_t first, size_t n, double *v,
           double factor, double *w)
{
    size_t circle = b->stage[r->level].circle, phases = circle / r->points;
    size_t skip = first % phases, turns = (size_t)r->mid;
    double *head = v + 2 * (b->longest + DENSE_MARGIN), *spare = head + 2 * DENSE_PHASES_MAX;
    if (skip > 0) {
        size_t some = phases - skip < n ? phases - skip : n;
        ss_dense_write(r->places, v, turns, circle, first - skip, phases, factor, spare, head);
        memcpy(w, head + 2 * skip, 2 * some * sizeof *w);
        first += some;
        n -= some;
        w += 2 * some;
    }
    ss_dense_write(r->places, v, turns, circle, first, n, factor, spare, w);
}

void
ss_blocks_scale(const struct blocks *b, size_t i, const spectra *s, double *scratch,
                span part, double factor, double *w)
{
    const block_scale *r = &b->scale[i];
    const stage *st = &b->stage[r->level];
    size_t last = part.first + part.n, k = part.first;
    double *v = scratch + 2 * (b->longest + DENSE_MARGIN);
    while (k < last) {
        size_t window = window_of(b, i, k), end = ss_blocks_end(b, i, window);
        span now = { k, (end < last ? end : last) - k };
        double *to = w + 2 * (k - part.first);
        transform_window(st, r, s->level[r->level] + (window - s->first) * st->stride, scratch, v);
        point_series series = series_of(b, r, window, v);
        if (r->kind == BETWEEN)
            ss_places_write(b->kernel, &series, &b->grid[i], b->rate, now, factor, to);
        else if (r->kind == EACH)
            write_each(b, r, k % r->hop, now.n, v, factor, to);
        else
            write_points(v + 2 * (k % r->hop), now.n, factor, to);
        k = end;
    }
}

/* --- the adjoint ------------------------------------------------------------------------------- */

/* Of each term and its mirror image, the term takes the half of the sum. */
void
ss_block_sums_add(block_sums *s, size_t i, double *scratch, span part, double factor, const double *w)
{
    const struct blocks *b = s->b;
    const block_scale *r = &b->scale[i];
    const stage *st = &b->stage[r->level];
    size_t window = window_of(b, i, part.first), room = 2 * DENSE_MARGIN, all = 2 * r->points;
    double *v = scratch + room, *c = scratch + 2 * (b->longest + DENSE_MARGIN);
    point_series series = series_of(b, r, window, NULL);
    memset(scratch, 0, (all + 2 * room) * sizeof *scratch);
    if (r->kind == AT_POINTS)
        add_points(w, part.n, factor / 2, v);
    else
        ss_places_add(b->kernel, &series, &b->grid[i], b->rate, part, factor / 2, w, v);
    for (size_t k = 0; r->kind != AT_POINTS && k < room; k++) {
        v[k] += v[all + k];
        v[all - room + k] += scratch[k];
    }
    fftw_execute_dft(r->inverse, (fftw_complex *)v, (fftw_complex *)c);
    add_conjugate_terms(c, r->points, place_of_terms(r), r->weight, r->terms,
                        s->level[r->level] + window * st->stride, st->length, r->lo);
}

size_t
ss_blocks_level(const struct blocks *b, size_t i)
{
    return (size_t)b->scale[i].level;
}

double
ss_blocks_delay(const struct blocks *b, size_t i)
{
    double delay = 1 + (b->scale[i].kind == BETWEEN);   /* BETWEEN may lie before its window */
    for (int l = 0; l <= b->scale[i].level; l++)
        delay += ldexp((double)(b->stage[l].length - b->stage[l].overlap / 2), l);
    return delay;
}
