/* stream_window.c -- compute one window of a stream and send its coefficients to the sink.
 *
 * All samples within REACH a of b are in the window, so a window adds at most exp(-REACH^2/2) to the
 * error of its coefficients, nothing compared with the promise.  The definition holds TOL against the
 * largest |W| of a scale so far, which is at most the record's. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/pool.h"
#include "map/stream.h"

enum {
    WORTH_THREADS = 64,         /* the caller's thread alone computes fewer coefficients than these, */
    BLOCK_WORTH_THREADS = 1 << 14       /* and in blocks fewer than these */
};

typedef struct window {
    ss_stream *stream;
    const group *group;
    size_t first, end;          /* its scales */
    size_t workers, each;       /* each worker computes so many scales at a time */
    ptrdiff_t limit;            /* a coefficient is complete if it needs no sample from here on */
    record rec;
    const spectra *spectra;     /* NULL for the window of a group, computed by the definition */
    ptrdiff_t start;            /* the first sample of a group's window */
    size_t number;              /* of a window of blocks */
} window;

/* --- what a window gives ---------------------------------------------------------------------- */

/* The last sample not after translation k; at most 2^60. */
static ptrdiff_t
place_of(const ss_stream *s, size_t i, size_t k)
{
    return (ptrdiff_t)fmin(floor(ss_scale_b(&s->scale[i], k) * s->rate), 0x1p60);
}

void
ss_stream_continue(ss_stream *s, size_t i, size_t next)
{
    scale_state *r = &s->state[i];
    r->next = next;
    r->due = place_of(s, i, next) + r->reach;
}

size_t
ss_stream_ready(const ss_stream *s, size_t i, ptrdiff_t limit)
{
    const scale_state *r = &s->state[i];
    ptrdiff_t last = limit - r->reach;
    if (last < 0 || limit < r->due)
        return 0;
    size_t count = ss_scale_count(&s->scale[i], (double)last / s->rate);
    count = count < r->count ? count : r->count;
    return count > r->next ? count - r->next : 0;
}

ptrdiff_t
ss_group_start(const ss_stream *s, const group *g)
{
    ptrdiff_t start = PTRDIFF_MAX;
    for (size_t i = g->first; i < g->first + g->plan->n_scales; i++) {
        const scale_state *r = &s->state[i];
        if (r->next >= r->count)
            continue;
        ptrdiff_t from = r->due - 2 * r->reach - 1;
        start = from < start ? from : start;
    }
    return start;
}

/* The next translations of scale i that a window of blocks gives. */
static size_t
next_of_blocks(const window *win, size_t i)
{
    const ss_stream *s = win->stream;
    const scale_state *r = &s->state[i];
    size_t end = ss_blocks_end(s->blocks.plan->blocks, i, win->number);
    end = end < r->count ? end : r->count;
    size_t n = end > r->next ? end - r->next : 0;
    if (win->limit == PTRDIFF_MAX)
        return n;
    size_t complete = ss_stream_ready(s, i, win->limit);
    return n < complete ? n : complete;
}

/* Choose the next part of scale i, and return its length. */
static size_t
choose_part(const window *win, size_t i)
{
    scale_state *r = &win->stream->state[i];
    int blocks = win->group == &win->stream->blocks;
    size_t n = blocks ? next_of_blocks(win, i) : ss_stream_ready(win->stream, i, win->limit);
    r->part = (span){ r->next, n < GIVEN ? n : GIVEN };
    return r->part.n;
}

/* --- computing and sending -------------------------------------------------------------------- */

/* Compute the scales of a worker. */
static void
compute(void *user)
{
    stream_worker *wk = user;
    const window *win = wk->window;
    const group *g = win->group;
    double *w = wk->w;
    wk->status = SS_OK;
    for (size_t i = wk->first; wk->status == SS_OK && i < wk->end; i++) {
        scale_state *r = &win->stream->state[i];
        if (r->part.n == 0)
            continue;
        int exponent = win->rec.exponent;
        double most = ldexp(r->most, r->exponent - exponent);
        wk->status = ss_morlet_part(g->plan, i - g->first, &win->rec, win->spectra, wk->scratch,
                                    r->wave, r->part, &most, w, &wk->error);
        r->most = most;
        r->exponent = exponent;
        w += 2 * r->part.n;
    }
}

static ss_status
send_scales(ss_stream *s, const stream_worker *wk, ss_error *err)
{
    const double *w = wk->w;
    ss_status st = wk->status;
    if (st != SS_OK && err != NULL)
        *err = wk->error;
    for (size_t i = wk->first; st == SS_OK && i < wk->end; i++) {
        const scale_state *r = &s->state[i];
        size_t first = r->next, n = r->part.n;
        if (n == 0)
            continue;
        ss_stream_continue(s, i, first + n);
        if (s->sink(&s->scale[i], first, n, w, s->samples, s->user))
            st = SS_STOP;
        w += 2 * r->part.n;
    }
    return st;
}

/* Compute and send a part of each of the scales first ... end - 1, on as many workers as it takes.  *more
 * becomes 1 if some of their coefficients may be left. */
static ss_status
share_scales(ss_stream *s, const window *win, size_t first, size_t end, int *more, ss_error *err)
{
    size_t n = 0, all = 0;
    ss_status st = SS_OK;
    for (; first < end; first += win->each) {
        stream_worker *wk = &s->worker[n];
        size_t before = all;
        wk->window = win;
        wk->first = first;
        wk->end = end - first < win->each ? end : first + win->each;
        for (size_t i = first; i < wk->end; i++)
            all += choose_part(win, i);
        n += all > before;
    }
    for (size_t t = 0; all < WORTH_THREADS && t < n; t++)
        compute(&s->worker[t]);
    if (all >= WORTH_THREADS)
        ss_pool_run(compute, s->worker, sizeof *s->worker, n);
    for (size_t t = 0; st == SS_OK && t < n; t++)
        st = send_scales(s, &s->worker[t], err);
    *more |= all >= GIVEN;
    return st;
}

/* Compute and send all coefficients of a window: one part of each scale, then the next part of each, so
 * that their order does not depend on the number of workers. */
static ss_status
compute_window(ss_stream *s, const window *win, ss_error *err)
{
    size_t together = win->workers * win->each;
    ss_status st = SS_OK;
    for (int more = 1; st == SS_OK && more;) {
        more = 0;
        for (size_t i = win->first; st == SS_OK && i < win->end; i += together) {
            size_t end = win->end - i < together ? win->end : i + together;
            st = share_scales(s, win, i, end, &more, err);
        }
    }
    return st;
}

/* --- a window of a group ---------------------------------------------------------------------- */

static record
record_of(const window *win)
{
    const ss_stream *s = win->stream;
    ptrdiff_t there = (ptrdiff_t)s->samples - win->start;
    size_t n = there < 0 ? 0 : (size_t)there;
    return (record){ .n = n < win->group->plan->n ? n : win->group->plan->n,
                     .x = s->x + (win->start - s->origin), .x_max = ldexp(s->x_max, -s->exponent),
                     .exponent = s->exponent, .origin = win->start };
}

ss_status
ss_group_transform(ss_stream *s, const group *g, ptrdiff_t start, ss_error *err)
{
    ptrdiff_t limit = start + (ptrdiff_t)g->plan->n, samples = (ptrdiff_t)s->samples;
    window win = { .stream = s, .group = g, .first = g->first, .start = start,
                   .end = g->first + g->plan->n_scales, .each = 1,
                   .workers = (size_t)s->opts.threads,
                   .limit = s->ended || limit < samples ? limit : samples };
    win.rec = record_of(&win);
    return compute_window(s, &win, err);
}

/* --- windows of blocks ------------------------------------------------------------------------ */

/* The user data of transform_blocks. */
typedef struct demand {
    ss_stream *stream;
    ptrdiff_t limit;
    ss_error *err;
} demand;

/* One thread computes scale by scale, so that each stays in the cache; of several threads each computes
 * some scales. */
static void
divide_scales(window *win)
{
    const ss_stream *s = win->stream;
    size_t most = 0, all = 0, threads = (size_t)s->opts.threads;
    win->workers = win->each = 1;
    for (size_t i = win->first; i < win->end; i++) {
        size_t n = next_of_blocks(win, i);
        n = n < GIVEN ? n : GIVEN;
        most = n > most ? n : most;
        all += n;
    }
    if (threads == 1 || all < BLOCK_WORTH_THREADS)
        return;
    size_t each = (win->end - win->first + threads - 1) / threads, fit = s->worker_room / most;
    win->workers = threads;
    win->each = each < fit ? each : fit;
}

/* Compute and send all coefficients of a window of a level. */
static ss_status
transform_blocks(size_t level, size_t number, double *spectrum, void *user)
{
    const demand *asked = user;
    ss_stream *s = asked->stream;
    const struct blocks *b = s->blocks.plan->blocks;
    size_t n_scales = s->blocks.plan->n_scales;
    spectra made = { .first = number };
    made.level[level] = spectrum;
    window win = { .stream = s, .group = &s->blocks, .number = number, .limit = asked->limit,
                   .rec.exponent = s->exponent, .spectra = &made };
    while (win.first < n_scales && ss_blocks_level(b, win.first) > level)
        win.first++;
    win.end = win.first;
    while (win.end < n_scales && ss_blocks_level(b, win.end) == level)
        win.end++;
    divide_scales(&win);
    return compute_window(s, &win, asked->err);
}

ss_status
ss_blocks_transform_full(ss_stream *s, ss_error *err)
{
    demand asked = { s, PTRDIFF_MAX, err };
    return s->cascade != NULL ? ss_cascade_run(s->cascade, transform_blocks, &asked) : SS_OK;
}

ss_status
ss_blocks_transform_rest(ss_stream *s, ptrdiff_t limit, ss_error *err)
{
    demand asked = { s, limit, err };
    if (s->cascade == NULL)
        return SS_OK;
    return ss_cascade_end(s->cascade, s->samples, transform_blocks, &asked);
}
