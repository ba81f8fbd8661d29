/* windows.c -- the spectra of all windows of a record, or of a stream as it goes on, and the adjoint: a
 * record from such spectra.
 *
 * blocks.c says what a window is, and how large the error.  Window i of a level begins at its sample
 * (i - 1) hop, and window 0 makes only samples before the record's first, which the next level has. */
#include <fftw3.h>
#include <stdlib.h>
#include <string.h>
#include "base/versions.h"
#include "map/fft/stage.h"

/* --- a window: its samples, its spectrum, and the samples of the next level ----------------------- */

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

/* The doubles needed for a window of any level: its samples, its spectrum and the next level's samples. */
static size_t
window_room(const struct blocks *b)
{
    size_t most = 0;
    for (size_t l = 0; l < b->levels; l++)
        most = b->stage[l].stride > most ? b->stage[l].stride : most;
    return 3 * most;
}

/* --- one window of each level, which is computed when it is full ---------------------------------- */

/* The next window of a level, which samples fill. */
typedef struct filling {
    double *made;               /* samples of the next level from the last window; x follows in memory */
    double *x;                  /* the overlap/2 samples before the window, then the window's */
    size_t have, window;        /* samples in x; the number of the window */
    size_t skip;                /* so many samples that are still to come lie before x */
    ptrdiff_t end;              /* samples from here on are 0 */
} filling;

struct cascade {
    const struct blocks *b;
    double *v;                  /* window_room doubles */
    filling level[LEVELS];
};

/* Every level begins with zeros, those samples of window 0 that precede the first from the level before, or skips
 * those of the level before that precede window 0. */
cascade *
ss_cascade_new(const struct blocks *b)
{
    cascade *c = calloc(1, sizeof *c);
    if (c == NULL)
        return NULL;
    c->b = b;
    int failed = (c->v = fftw_malloc(window_room(b) * sizeof *c->v)) == NULL;
    for (size_t l = 0; l < b->levels; l++) {
        const stage *st = &b->stage[l];
        filling *f = &c->level[l];
        size_t before = st->hop + st->overlap / 2, made = l > 0 ? st[-1].hop / 2 : 0;
        if ((f->made = fftw_malloc((st->stride / 2 + st->length) * sizeof *f->made)) == NULL) {
            failed = 1;
            continue;
        }
        f->x = f->made + st->stride / 2;
        f->have = before > made ? before - made : 0;
        f->skip = before > made ? 0 : made - before;
        f->end = PTRDIFF_MAX;
        memset(f->x, 0, f->have * sizeof *f->x);
    }
    if (!failed)
        return c;
    ss_cascade_free(c);
    return NULL;
}

void
ss_cascade_free(cascade *c)
{
    if (c == NULL)
        return;
    for (size_t l = 0; l < c->b->levels; l++)
        fftw_free(c->level[l].made);
    fftw_free(c->v);
    free(c);
}

static ss_status append(cascade *c, size_t l, const double *x, size_t n, window_sink *sink, void *user);

/* Transform a full window, and begin the next one with its last samples. */
static ss_status
finish_window(cascade *c, size_t l, window_sink *sink, void *user)
{
    const stage *st = &c->b->stage[l];
    filling *f = &c->level[l];
    double *terms = c->v + st->stride;
    size_t before = st->overlap / 2;            /* so many samples of x precede the window */
    memcpy(c->v, f->x + before, (st->length - before) * sizeof *c->v);
    memcpy(c->v + st->length - before, f->x, before * sizeof *c->v);
    fftw_execute_dft_r2c(st->forward, c->v, (fftw_complex *)terms);
    ss_status status = st->used ? sink(l, f->window, terms, user) : SS_OK;
    memmove(f->x, f->x + st->hop, st->overlap * sizeof *f->x);
    f->have = st->overlap;
    f->window++;
    if (status != SS_OK || l + 1 == c->b->levels)
        return status;
    filter_terms(st, terms, c->v);
    fftw_execute_dft_c2r(st->next, (fftw_complex *)c->v, f->made);
    return append(c, l + 1, f->made, st->hop / 2, sink, user);
}

/* Append samples to a level, except the first; samples before the margin are 0. */
static ss_status
append(cascade *c, size_t l, const double *x, size_t n, window_sink *sink, void *user)
{
    const stage *st = &c->b->stage[l];
    filling *f = &c->level[l];
    ss_status status = SS_OK;
    size_t skip = n < f->skip ? n : f->skip;
    f->skip -= skip;
    x += skip;
    n -= skip;
    while (status == SS_OK && n > 0) {
        size_t left = st->length - f->have, part = n < left ? n : left;
        ptrdiff_t at = ((ptrdiff_t)f->window - 1) * (ptrdiff_t)st->hop
            - (ptrdiff_t)(st->overlap / 2) + (ptrdiff_t)f->have;
        for (ptrdiff_t i = 0; i < (ptrdiff_t)part; i++)
            f->x[(ptrdiff_t)f->have + i] = at + i >= -(ptrdiff_t)st->margin && at + i < f->end ? x[i] : 0;
        x += part;
        n -= part;
        f->have += part;
        status = f->have == st->length ? finish_window(c, l, sink, user) : SS_OK;
    }
    return status;
}

size_t
ss_cascade_room(const cascade *c)
{
    return c->b->stage[0].length - c->level[0].have;
}

void
ss_cascade_divide(cascade *c, int exponent, double most)
{
    for (size_t l = 0; l < c->b->levels; l++)
        ss_morlet_divide(c->level[l].x, c->level[l].have, exponent, most);
}

double *
ss_cascade_append(cascade *c, const double *x, size_t n)
{
    double *to = c->level[0].x + c->level[0].have;
    c->level[0].have += n;
    return memcpy(to, x, n * sizeof *x);
}

ss_status
ss_cascade_run(cascade *c, window_sink *sink, void *user)
{
    return ss_cascade_room(c) == 0 ? finish_window(c, 0, sink, user) : SS_OK;
}

ss_status
ss_cascade_end(const cascade *now, size_t n, window_sink *sink, void *user)
{
    const struct blocks *b = now->b;
    cascade *c = ss_cascade_new(b);
    ss_status st = c != NULL ? SS_OK : SS_ENOMEM;
    size_t windows[LEVELS] = { 0 };
    for (size_t l = 0; st == SS_OK && l < b->levels; l++) {
        const stage *s = &b->stage[l];
        const filling *from = &now->level[l];
        filling *f = &c->level[l];
        memcpy(f->x, from->x, from->have * sizeof *f->x);
        *f = (filling){ .made = f->made, .x = f->x, .have = from->have, .window = from->window, .skip = from->skip,
                        .end = (ptrdiff_t)(n + (l > 0 ? s->margin : 0)) };
        windows[l] = 1 + windows_for(s, n + 2 * s->margin);
        n = n / 2 + 1;
    }
    for (size_t l = 0; st == SS_OK && l < b->levels; l++)
        while (st == SS_OK && c->level[l].window < windows[l]) {
            filling *f = &c->level[l];
            memset(f->x + f->have, 0, (b->stage[l].length - f->have) * sizeof *f->x);
            st = finish_window(c, l, sink, user);
        }
    ss_cascade_free(c);
    return st;
}

/* --- a whole record --------------------------------------------------------------------------- */

ss_status
ss_blocks_scratch(const struct blocks *b, double **scratch)
{
    *scratch = b != NULL ? fftw_malloc(ss_blocks_room(b) * sizeof **scratch) : NULL;
    return b != NULL && *scratch == NULL ? SS_ENOMEM : SS_OK;
}

void
ss_blocks_scratch_free(double *scratch)
{
    fftw_free(scratch);
}

/* The user data of keep_spectrum. */
typedef struct kept {
    const struct blocks *b;
    spectra *out;
} kept;

static ss_status
keep_spectrum(size_t level, size_t window, double *spectrum, void *user)
{
    const kept *k = user;
    const stage *st = &k->b->stage[level];
    if (window < st->windows)
        memcpy(k->out->level[level] + window * st->stride, spectrum, (st->length + 2) * sizeof *spectrum);
    return SS_OK;
}

ss_status
ss_blocks_forward(const struct blocks *b, const record *rec, spectra *out)
{
    kept k = { b, out };
    cascade *c = ss_cascade_new(b);
    ss_status st = c != NULL ? SS_OK : SS_ENOMEM;
    for (size_t l = 0; st == SS_OK && l < b->levels; l++) {
        const stage *of = &b->stage[l];
        if (of->used && (out->level[l] = fftw_malloc(of->windows * of->stride * sizeof(double))) == NULL)
            st = SS_ENOMEM;
    }
    for (size_t i = 0, n; st == SS_OK && i < rec->n; i += n) {
        n = rec->n - i < ss_cascade_room(c) ? rec->n - i : ss_cascade_room(c);
        ss_cascade_append(c, rec->x + i, n);
        st = ss_cascade_run(c, keep_spectrum, &k);
    }
    if (st == SS_OK)
        st = ss_cascade_end(c, rec->n, keep_spectrum, &k);
    ss_cascade_free(c);
    return st;
}

void
ss_morlet_spectra_free(spectra *s)
{
    for (size_t l = 0; l < LEVELS; l++)
        fftw_free(s->level[l]);
}

/* --- the adjoint ------------------------------------------------------------------------------ */

/* Samples lo ... hi - 1 of a level, of which x[0] is sample lo; all others are 0. */
typedef struct samples {
    double *x;
    ptrdiff_t lo, hi;
} samples;

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

/* The adjoint of finish_window: samples of the next level, if there is one, and sums to those of this. */
static void
sums_window(const block_sums *s, size_t l, size_t window, const samples *next, const samples *to)
{
    const stage *st = &s->b->stage[l];
    ptrdiff_t first = ((ptrdiff_t)window - 1) * (ptrdiff_t)st->hop, length = (ptrdiff_t)st->length;
    ptrdiff_t inside = length - (ptrdiff_t)(st->overlap / 2), made = (ptrdiff_t)(st->hop / 2);
    double *v = s->v, *terms = v + st->stride, *half = v + 2 * st->stride;
    if (s->level[l] != NULL)
        terms = s->level[l] + window * st->stride;
    else
        memset(terms, 0, st->stride * sizeof *terms);
    for (ptrdiff_t i = 0, k = first / 2; next->x != NULL && i < length / 2; i++, k++)
        v[i] = i < made && k >= next->lo && k < next->hi ? next->x[k - next->lo] : 0;
    if (next->x != NULL) {
        fftw_execute_dft_r2c(st->of_next, v, (fftw_complex *)half);
        unfilter_terms(st, half, terms);
    }
    fftw_execute_dft_c2r(st->back, (fftw_complex *)terms, v);
    for (ptrdiff_t i = 0; i < length; i++) {
        ptrdiff_t k = first + (i < inside ? i : i - length);
        if (k >= to->lo && k < to->hi)
            to->x[k - to->lo] += v[i];
    }
    memset(terms, 0, st->stride * sizeof *terms);
}

ss_status
ss_block_sums_end(block_sums *s, double *x)
{
    samples next = { 0 };
    ss_status status = SS_OK;
    for (size_t l = s->b->levels; status == SS_OK && l-- > 0;) {
        const stage *st = &s->b->stage[l];
        ptrdiff_t margin = l > 0 ? (ptrdiff_t)st->margin : 0;
        samples now = { x, -margin, (ptrdiff_t)st->n + margin };
        if (l > 0 && (now.x = calloc((size_t)(now.hi - now.lo), sizeof *now.x)) == NULL)
            status = SS_ENOMEM;
        for (size_t i = 0; status == SS_OK && i < st->windows; i++)
            sums_window(s, l, i, &next, &now);
        free(next.x);
        next = now;
    }
    return status;
}

block_sums *
ss_block_sums_new(struct blocks *b)
{
    block_sums *s = calloc(1, sizeof *s);
    if (s == NULL)
        return NULL;
    s->b = b;
    int failed = (s->v = fftw_malloc(window_room(b) * sizeof *s->v)) == NULL;
    for (size_t l = 0; !failed && l < b->levels; l++) {
        size_t room = b->stage[l].windows * b->stage[l].stride * sizeof(double);
        if (b->stage[l].used)
            failed = (s->level[l] = fftw_malloc(room)) == NULL;
        if (s->level[l] != NULL)
            memset(s->level[l], 0, room);
    }
    if (!failed && ss_blocks_plan(b, 1) == SS_OK)
        return s;
    ss_block_sums_free(s);
    return NULL;
}

void
ss_block_sums_free(block_sums *s)
{
    if (s == NULL)
        return;
    for (size_t l = 0; l < s->b->levels; l++)
        fftw_free(s->level[l]);
    fftw_free(s->v);
    free(s);
}
