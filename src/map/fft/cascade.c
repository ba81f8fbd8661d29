/* cascade.c -- the spectra of the windows of a stream as it goes on.
 *
 * A stream keeps one window of each level, which is computed when it is full.  The windows are those of
 * windows.c. */
#include <fftw3.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "map/fft/blocks.h"
#include "map/fft/window.h"

/* The next window of a level, which samples fill. */
typedef struct filling {
    double *made;               /* samples of the next level from the last window; x follows in memory */
    double *x;                  /* the overlap/2 samples before the window, then the window's */
    size_t have, window;        /* samples in x; the number of the window */
    ptrdiff_t end;              /* samples from here on are 0 */
} filling;

struct cascade {
    const struct blocks *b;
    double *v;                  /* window_room doubles */
    filling level[LEVELS];
};

static cascade *
empty_cascade(const struct blocks *b)
{
    cascade *c = calloc(1, sizeof *c);
    if (c == NULL)
        return NULL;
    c->b = b;
    int failed = (c->v = fftw_malloc(ss_window_room(b) * sizeof *c->v)) == NULL;
    for (size_t l = 0; l < b->levels; l++) {
        filling *f = &c->level[l];
        f->made = fftw_malloc((b->stage[l].stride / 2 + b->stage[l].length) * sizeof *f->made);
        failed |= f->made == NULL;
        f->x = f->made + b->stage[l].stride / 2;
        f->end = PTRDIFF_MAX;
    }
    if (!failed)
        return c;
    ss_cascade_free(c);
    return NULL;
}

/* Every level begins with zeros: those samples of window 0 that precede the first from the level before. */
cascade *
ss_cascade_new(const struct blocks *b)
{
    cascade *c = empty_cascade(b);
    for (size_t l = 0; c != NULL && l < b->levels; l++) {
        const stage *st = &b->stage[l];
        filling *f = &c->level[l];
        f->have = st->hop + st->overlap / 2 - (l > 0 ? st[-1].hop / 2 : 0);
        memset(f->x, 0, f->have * sizeof *f->x);
    }
    return c;
}

static cascade *
copy_of(const cascade *c)
{
    cascade *to = empty_cascade(c->b);
    for (size_t l = 0; to != NULL && l < c->b->levels; l++) {
        filling *f = &to->level[l];
        f->have = c->level[l].have;
        f->window = c->level[l].window;
        memcpy(f->x, c->level[l].x, f->have * sizeof *f->x);
    }
    return to;
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

static ss_status append(cascade *c, size_t l, double *x, size_t n, window_sink *sink, void *user);

/* Transform a full window, and begin the next one with its last samples. */
static ss_status
finish_window(cascade *c, size_t l, window_sink *sink, void *user)
{
    const stage *st = &c->b->stage[l];
    filling *f = &c->level[l];
    double *terms = c->v + st->stride;
    ss_window_transform(st, f->x, c->v, terms);
    ss_status status = st->used ? sink(l, f->window, terms, user) : SS_OK;
    memmove(f->x, f->x + st->hop, st->overlap * sizeof *f->x);
    f->have = st->overlap;
    f->window++;
    if (status != SS_OK || l + 1 == c->b->levels)
        return status;
    ss_window_decimate(st, terms, c->v, f->made);
    return append(c, l + 1, f->made, st->hop / 2, sink, user);
}

/* Append samples to a level, except the first; samples before the margin are 0. */
static ss_status
append(cascade *c, size_t l, double *x, size_t n, window_sink *sink, void *user)
{
    const stage *st = &c->b->stage[l];
    filling *f = &c->level[l];
    ss_status status = SS_OK;
    while (status == SS_OK && n > 0) {
        size_t left = st->length - f->have, part = n < left ? n : left;
        ptrdiff_t at = ((ptrdiff_t)f->window - 1) * (ptrdiff_t)st->hop
            - (ptrdiff_t)(st->overlap / 2) + (ptrdiff_t)f->have;
        ptrdiff_t end = at + (ptrdiff_t)part, lo = -(ptrdiff_t)st->margin;
        lo = lo < at ? at : lo < end ? lo : end;
        samples from = { x + (lo - at), lo, end < f->end ? end : f->end };
        ss_window_copy(&from, at, part, f->x + f->have);
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

void
ss_cascade_append(cascade *c, const double *x, size_t n)
{
    memcpy(c->level[0].x + c->level[0].have, x, n * sizeof *x);
    c->level[0].have += n;
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
    cascade *c = copy_of(now);
    ss_status st = c != NULL ? SS_OK : SS_ENOMEM;
    size_t windows[LEVELS] = { 0 };
    for (size_t l = 0; st == SS_OK && l < b->levels; l++) {
        const stage *s = &b->stage[l];
        windows[l] = 1 + windows_for(s, n + 2 * s->margin);
        c->level[l].end = (ptrdiff_t)(n + (l > 0 ? s->margin : 0));
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
