/* stream.c -- the transform of a signal that has no end yet, window by window.
 *
 * The scales that are transformed in blocks, the longest ones of a stepped grid, are computed as there
 * (fft/windows.c), on the levels' windows as they become full; complete coefficients that are wanted
 * at once come from windows that are filled up with zeros.  For the others:
 *
 * Scales of similar length form a group, which has a plan for windows of a fixed length, at least
 * twice the length of its longest wavelet.  A window begins where the next coefficient needs it to,
 * and yields all coefficients of the group whose wavelets lie inside; the next window overlaps it by
 * the length of the longest wavelet.  So only samples are carried over.
 *
 * All samples within REACH a of b are in the window, so a window adds at most exp(-REACH^2/2) to the
 * error of its engine, nothing compared with the promise.  The engines hold TOL against the largest
 * |W| of a scale so far, which is at most the record's.
 *
 * A full window is computed by the engine that its plan found cheapest.  A window that is not full,
 * because the signal has ended or because complete coefficients are wanted at once, is computed by
 * the definition where that is cheaper for its few coefficients. */
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/pool.h"
#include "morlet/fft/blocks.h"
#include "morlet/plan.h"
#include "morlet/versions.h"

enum {
    BASE = 1 << 13,             /* samples in a window at least */
    SHORT = 1 << 13,            /* reach of the scales that go together in the first group */
    OCTAVES = 5,                /* of scales in the others */
    LONG = 1 << 21,             /* a window longer than this is twice its wavelet, not four times */
    PIECE = 1 << 14,            /* samples processed at a time, at most */
    GIVEN = 1 << 17,            /* coefficients passed to the sink at a time */
    TABLES = 32 << 20,          /* bytes of wavelets kept */
    WORTH_THREADS = 64,         /* fewer coefficients are computed by the caller's thread alone, */
    BLOCK_WORTH_THREADS = 1 << 14,      /* in blocks */
    FAR = 600,                  /* powers of 2 by which the samples of blocks are divided */
    LANES = 8
};

/* The state of a scale. */
typedef struct scale_state {
    size_t next;                /* its next translation */
    ptrdiff_t due;              /* the samples that it needs, from the first on */
    size_t count;               /* in the record; SIZE_MAX until that has ended */
    ptrdiff_t reach;            /* samples that a coefficient needs on either side, and one */
    double most;                /* the largest |W| so far is most 2^exponent, in units of a^1/2 */
    int exponent;
    wavelet *wave;              /* NULL: made when needed */
    double place, table;        /* cost by the definition: a coefficient, the wavelet [s] */
} scale_state;

typedef struct group {
    ss_morlet *plan;            /* its n is the length of a window */
    size_t first;               /* its scales are first ... first + plan->n_scales - 1 */
    ptrdiff_t unit;             /* a window begins at a multiple of this */
} group;

/* The work of one thread. */
typedef struct stream_worker {
    double *w, *scratch;        /* scratch: of the group at work, NULL if it needs none */
    double *of_blocks;          /* scratch */
    size_t scale, scales;       /* scales: how many, in blocks */
    span part;                  /* to compute; those from skip on go to the sink */
    size_t skip;
    ss_status status;
    ss_error error;
    struct window *window;
} stream_worker;

struct ss_stream {
    ss_morlet_opts opts;
    double rate;
    ss_coefficient_sink *sink;
    void *user;
    size_t n_scales, n_groups, samples;
    group blocks;               /* plan NULL: none; the first scales */
    cascade *cascade;
    size_t full;                /* no window is full before there are so many samples */
    ss_scale *scale;
    scale_state *state;
    group *group;
    stream_worker *worker;      /* as many as threads */
    double *x, x_max;           /* the last samples, and max|x| of all */
    ptrdiff_t origin;           /* x[0] is this sample; there are zeros before the first */
    size_t room;
    size_t worker_room;         /* coefficients in w of a worker */
    ptrdiff_t limit;            /* samples that blocks may need now; PTRDIFF_MAX: their window's */
    ss_error *why;              /* of what fails in blocks, or NULL */
    int ended;
    ss_status status;           /* of what failed first */
    ss_error error;
};

/* The samples of a group from start on that have arrived. */
typedef struct window {
    ss_stream *stream;
    const group *group;
    ptrdiff_t start;
    record rec;
    spectra spectra;
    int by_sum;
    size_t number;              /* of a window of blocks; limit: samples that may be needed */
    ptrdiff_t limit;
} window;

/* --- positions of windows -------------------------------------------------------------------- */

/* The sample at translation k or before it, 2^60 if it is that far away. */
static ptrdiff_t
place_of(const ss_stream *s, size_t i, size_t k)
{
    return (ptrdiff_t)fmin(floor(ss_scale_b(&s->scale[i], k) * s->rate), 0x1p60);
}

/* Samples that the next translation of a scale may lie behind the place where its computation
 * begins. */
static ptrdiff_t
places_of(const group *g, size_t i)
{
    return g->plan->fft != NULL ? (ptrdiff_t)ss_fft_places(g->plan->fft, i - g->first) : 1;
}

/* Continue a scale at this translation. */
static void
go_on(ss_stream *s, size_t i, size_t next)
{
    scale_state *r = &s->state[i];
    r->next = next;
    r->due = place_of(s, i, next) + r->reach;
}

static ptrdiff_t
round_down(ptrdiff_t x, ptrdiff_t unit)
{
    ptrdiff_t rest = x % unit;
    return x - (rest < 0 ? rest + unit : rest);
}

/* The start of a group's next window; PTRDIFF_MAX if none is left. */
static ptrdiff_t
start_of(const ss_stream *s, const group *g)
{
    ptrdiff_t start = PTRDIFF_MAX;
    for (size_t i = g->first; i < g->first + g->plan->n_scales; i++) {
        const scale_state *r = &s->state[i];
        if (r->next >= r->count)
            continue;
        ptrdiff_t from = r->due - 2 * r->reach - places_of(g, i);
        start = from < start ? from : start;
    }
    return start < PTRDIFF_MAX ? round_down(start, g->unit) : start;
}

/* The next translations of scale i that need no sample from limit on. */
static size_t
ready(const ss_stream *s, size_t i, ptrdiff_t limit)
{
    const scale_state *r = &s->state[i];
    ptrdiff_t last = limit - r->reach;
    if (last < 0 || limit < r->due)
        return 0;
    size_t count = ss_scale_count(&s->scale[i], (double)last / s->rate);
    count = count < r->count ? count : r->count;
    return count > r->next ? count - r->next : 0;
}

/* The samples of a window at start that have arrived. */
static ptrdiff_t
limit_of(const ss_stream *s, const group *g, ptrdiff_t start)
{
    ptrdiff_t limit = start + (ptrdiff_t)g->plan->n, samples = (ptrdiff_t)s->samples;
    return s->ended || limit < samples ? limit : samples;
}

/* By this power of 2 samples are divided, the largest of which is x_max, for blocks: 0 but for sizes
 * near the ends of what a double holds. */
static int
exponent_of(double x_max)
{
    return x_max > 0 ? FAR * (ilogb(x_max) / FAR) : 0;
}

/* --- one window ------------------------------------------------------------------------------- */

/* The samples of a window, of a size whose squares neither overflow nor underflow. */
static ss_status
fill_record(window *win)
{
    const ss_stream *s = win->stream;
    ptrdiff_t there = (ptrdiff_t)s->samples - win->start;
    size_t n = there < 0 ? 0 : (size_t)there;
    record *rec = &win->rec;
    n = n < win->group->plan->n ? n : win->group->plan->n;
    *rec = (record){ .n = n, .x = s->x + (win->start - s->origin), .x_max = s->x_max,
                     .origin = win->start };
    if (s->x_max == 0 || (s->x_max > 0x1p-300 && s->x_max < 0x1p300))
        return SS_OK;
    double *x = malloc((n + 1) * sizeof *x);
    if (x == NULL)
        return SS_ENOMEM;
    rec->x_max = frexp(s->x_max, &rec->exponent);
    for (size_t i = 0; i < n; i++)
        x[i] = ldexp(rec->x[i], -rec->exponent);
    rec->x = x;
    return SS_OK;
}

static void
release(window *win)
{
    const ss_stream *s = win->stream;
    if (win->rec.x != s->x + (win->start - s->origin))
        free(win->rec.x);
    ss_spectra_free(&win->spectra);
    for (int t = 0; t < s->opts.threads; t++) {
        if (s->worker[t].scratch != NULL)
            ss_fft_scratch_free(s->worker[t].scratch);
        s->worker[t].scratch = NULL;
    }
}

/* Compute the worker's part of its scale; user points at a pointer to the worker. */
static void
compute(void *user)
{
    stream_worker *wk = *(stream_worker **)user;
    window *win = wk->window;
    scale_state *r = &win->stream->state[wk->scale];
    int exponent = win->rec.exponent;
    double most = ldexp(r->most, r->exponent - exponent);
    wk->status = ss_morlet_part(win->group->plan, wk->scale - win->group->first, &win->rec,
                                win->by_sum ? NULL : &win->spectra, wk->scratch, r->wave, wk->part,
                                &most, wk->w, &wk->error);
    r->most = most;
    r->exponent = exponent;
}

/* Give the worker the next part of its scale; 0 if nothing is left. */
static int
next_part(stream_worker *wk, ptrdiff_t limit)
{
    const window *win = wk->window;
    const ss_stream *s = win->stream;
    size_t first = s->state[wk->scale].next, n = ready(s, wk->scale, limit);
    size_t places = (size_t)places_of(win->group, wk->scale);
    n = n < GIVEN ? n : GIVEN;
    wk->skip = win->by_sum ? 0 : (size_t)((ptrdiff_t)first - win->start) % places;
    wk->part = (span){ first - wk->skip, n + wk->skip };
    return n > 0;
}

static ss_status
send_part(ss_stream *s, stream_worker *wk, ss_error *err)
{
    size_t n = wk->part.n - wk->skip;
    if (wk->status != SS_OK) {
        if (err != NULL)
            *err = wk->error;
        return wk->status;
    }
    go_on(s, wk->scale, s->state[wk->scale].next + n);
    int stop = s->sink(&s->scale[wk->scale], wk->part.first + wk->skip, n, wk->w + 2 * wk->skip,
                       s->samples, s->user);
    return stop ? SS_STOP : SS_OK;
}

/* Each worker computes the next part of a scale, from scale first on; *busy counts those that had one. */
static ss_status
compute_parts(ss_stream *s, window *win, size_t first, size_t n, ptrdiff_t limit, size_t *busy,
              ss_error *err)
{
    stream_worker *work[SS_THREADS_MAX];
    size_t parts = 0, coefficients = 0;
    ss_status st = SS_OK;
    for (size_t t = 0; t < n; t++) {
        stream_worker *wk = &s->worker[t];
        wk->scale = first + t;
        wk->window = win;
        if (!next_part(wk, limit))
            continue;
        work[parts++] = wk;
        coefficients += wk->part.n;
    }
    if (coefficients < WORTH_THREADS)
        for (size_t t = 0; t < parts; t++)
            compute(&work[t]);
    else
        ss_pool_run(compute, work, sizeof *work, parts);
    for (size_t t = 0; st == SS_OK && t < parts; t++)
        st = send_part(s, work[t], err);
    *busy += parts;
    return st;
}

/* All coefficients of the scales of a window: a part of each, then the next of each, so that their
 * order does not depend on the number of workers. */
static ss_status
compute_scales(ss_stream *s, window *win, ptrdiff_t limit, ss_error *err)
{
    const group *g = win->group;
    size_t workers = (size_t)s->opts.threads, busy = 1;
    ss_status st = SS_OK;
    while (st == SS_OK && busy > 0) {
        busy = 0;
        for (size_t i = 0; st == SS_OK && i < g->plan->n_scales; i += workers) {
            size_t left = g->plan->n_scales - i;
            st = compute_parts(s, win, g->first + i, left < workers ? left : workers, limit, &busy,
                               err);
        }
    }
    return st;
}

/* Is the definition cheaper for the coefficients of a window? */
static int
cheaper_by_sum(const ss_stream *s, const group *g, ptrdiff_t limit)
{
    double sum = 0;
    if (g->plan->fft == NULL)
        return 1;
    if (s->opts.engine == SS_ENGINE_FFT)
        return 0;
    for (size_t i = 0; i < g->plan->n_scales; i++) {
        const scale_state *r = &s->state[g->first + i];
        size_t n = ss_fft_covers(g->plan->fft, i) ? ready(s, g->first + i, limit) : 0;
        if (n > 0)
            sum += (double)n * r->place + (r->wave == NULL ? r->table : 0);
    }
    return sum < ss_fft_cost(g->plan->fft);
}

/* All coefficients of a window at start. */
static ss_status
transform(ss_stream *s, const group *g, ptrdiff_t start, ss_error *err)
{
    ptrdiff_t limit = limit_of(s, g, start);
    window win = { .stream = s, .group = g, .start = start,
                   .by_sum = cheaper_by_sum(s, g, limit) };
    size_t workers = (size_t)s->opts.threads;
    ss_status st = fill_record(&win);
    if (st == SS_OK && !win.by_sum)
        st = ss_fft_forward(g->plan->fft, &win.rec, &win.spectra);
    for (size_t t = 0; st == SS_OK && !win.by_sum && t < workers; t++)
        if ((s->worker[t].scratch = ss_fft_scratch(g->plan->fft)) == NULL)
            st = SS_ENOMEM;
    if (st == SS_OK)
        st = compute_scales(s, &win, limit, err);
    release(&win);
    return st;
}

/* --- a window of blocks ------------------------------------------------------------------------ */

/* The next translations of scale i that a window gives. */
static span
block_part(const window *win, size_t i)
{
    const ss_stream *s = win->stream;
    const scale_state *r = &s->state[i];
    size_t end = win->number * ss_blocks_hop(s->blocks.plan->blocks, i);
    end = end < r->count ? end : r->count;
    size_t n = end > r->next ? end - r->next : 0, complete = n;
    if (win->limit < PTRDIFF_MAX)
        complete = ready(s, i, win->limit);
    return (span){ r->next, n < complete ? n : complete };
}

/* Compute the worker's scales; user points at the worker. */
static void
compute_blocks(void *user)
{
    stream_worker *wk = user;
    double *w = wk->w, most = 0;
    wk->status = SS_OK;
    for (size_t i = wk->scale; wk->status == SS_OK && i < wk->scale + wk->scales; i++) {
        span part = block_part(wk->window, i);
        if (part.n > 0)
            wk->status = ss_morlet_part(wk->window->group->plan, i, &wk->window->rec,
                                        &wk->window->spectra, wk->of_blocks, NULL, part, &most, w,
                                        &wk->error);
        w += 2 * part.n;
    }
}

static ss_status
send_blocks(ss_stream *s, stream_worker *wk, ss_error *err)
{
    const double *w = wk->w;
    ss_status st = wk->status;
    if (st != SS_OK && err != NULL)
        *err = wk->error;
    for (size_t i = wk->scale; st == SS_OK && i < wk->scale + wk->scales; i++) {
        span part = block_part(wk->window, i);
        if (part.n == 0)
            continue;
        go_on(s, i, part.first + part.n);
        st = s->sink(&s->scale[i], part.first, part.n, w, s->samples, s->user) ? SS_STOP : SS_OK;
        w += 2 * part.n;
    }
    return st;
}

/* Compute the scales from first on, the same number in each worker. */
static ss_status
share_blocks(ss_stream *s, window *win, size_t first, size_t end, size_t workers, size_t each)
{
    ss_status st = SS_OK;
    size_t n = 0;
    for (; n < workers && first < end; n++, first += each) {
        stream_worker *wk = &s->worker[n];
        wk->scale = first;
        wk->scales = end - first < each ? end - first : each;
        wk->window = win;
    }
    ss_pool_run(compute_blocks, s->worker, sizeof *s->worker, n);
    for (size_t t = 0; st == SS_OK && t < n; t++)
        st = send_blocks(s, &s->worker[t], s->why);
    return st;
}

/* All coefficients of a window of a level: by one thread scale by scale, as they stay in the cache. */
static ss_status
window_of_blocks(size_t level, size_t number, double *spectrum, void *user)
{
    ss_stream *s = user;
    const struct blocks *b = s->blocks.plan->blocks;
    size_t first = 0, end, workers = (size_t)s->opts.threads, most = 0, n = 0;
    window win = { .stream = s, .group = &s->blocks, .number = number, .limit = s->limit,
                   .rec = { .exponent = exponent_of(s->x_max) } };
    win.spectra.blocks = (block_spectra){ .first = number };
    win.spectra.blocks.level[level] = spectrum;
    while (first < s->blocks.plan->n_scales && ss_blocks_level(b, first) > level)
        first++;
    for (end = first; end < s->blocks.plan->n_scales && ss_blocks_level(b, end) == level; end++) {
        size_t part = block_part(&win, end).n;
        most = part > most ? part : most;
        n += part;
    }
    if (n == 0)
        return SS_OK;
    workers = n < BLOCK_WORTH_THREADS ? 1 : workers;
    size_t each = workers == 1 ? 1 : (end - first + workers - 1) / workers;
    size_t fit = s->worker_room / most;
    each = each < fit ? each : fit;
    ss_status st = SS_OK;
    for (; st == SS_OK && first < end; first += workers * each)
        st = share_blocks(s, &win, first, end, workers, each);
    return st;
}

/* Complete coefficients, those that need no sample from limit on. */
static ss_status
transform_rest_of_blocks(ss_stream *s, ptrdiff_t limit, ss_error *err)
{
    if (s->cascade == NULL)
        return SS_OK;
    s->limit = limit;
    s->why = err;
    ss_status st = ss_cascade_end(s->cascade, s->samples, window_of_blocks, s);
    s->limit = PTRDIFF_MAX;
    return st;
}

/* --- samples ---------------------------------------------------------------------------------- */

/* Make room for n more samples, in place of those that no window needs any more. */
static void
make_room(ss_stream *s, size_t n)
{
    ptrdiff_t keep = (ptrdiff_t)s->samples;
    size_t held = (size_t)(keep - s->origin);
    if (held + n <= s->room)
        return;
    for (size_t i = 0; i < s->n_groups; i++) {
        ptrdiff_t start = start_of(s, &s->group[i]);
        keep = start < keep ? start : keep;
    }
    size_t drop = (size_t)(keep - s->origin);
    memmove(s->x, s->x + drop, (held - drop) * sizeof *s->x);
    s->origin = keep;
}

/* The largest of |x| and most.  It may miss a NaN; *sum shows infinity and NaN. */
VERSIONS static double
largest(const double *x, size_t n, double most, double *sum)
{
    double top[LANES], zero[LANES] = { 0 };
    size_t i = 0;
    for (size_t l = 0; l < LANES; l++)
        top[l] = most;
    for (; i + LANES <= n; i += LANES)
        for (size_t l = 0; l < LANES; l++) {
            double y = fabs(x[i + l]);
            top[l] = y > top[l] ? y : top[l];
            zero[l] += 0 * x[i + l];
        }
    for (; i < n; i++) {
        top[0] = fabs(x[i]) > top[0] ? fabs(x[i]) : top[0];
        zero[0] += 0 * x[i];
    }
    *sum = 0;
    for (size_t l = 0; l < LANES; l++) {
        most = top[l] > most ? top[l] : most;
        *sum += zero[l];
    }
    return most;
}

/* Compute the full windows, and set the number of samples for the next: a window is computed with its
 * last sample, so its coefficients do not depend on how the samples arrived. */
static ss_status
transform_full(ss_stream *s, ss_error *err)
{
    s->full = SIZE_MAX;
    s->why = err;
    if (s->cascade != NULL) {
        ss_status st = ss_cascade_run(s->cascade, window_of_blocks, s);
        if (st != SS_OK)
            return st;
        s->full = s->samples + ss_cascade_room(s->cascade);
    }
    for (size_t i = 0; i < s->n_groups; i++) {
        const group *g = &s->group[i];
        ptrdiff_t start, n = (ptrdiff_t)g->plan->n;
        while ((start = start_of(s, g)) <= (ptrdiff_t)s->samples - n) {
            ss_status st = transform(s, g, start, err);
            if (st != SS_OK)
                return st;
        }
        s->full = (size_t)(start + n) < s->full ? (size_t)(start + n) : s->full;
    }
    return SS_OK;
}

static ss_status
append_samples(ss_stream *s, const double *x, size_t n, ss_error *err)
{
    double sum, most = largest(x, n, s->x_max, &sum);
    size_t good = n;
    if (!(sum == 0)) {
        for (good = 0; isfinite(x[good]); good++)
            ;
        most = largest(x, good, s->x_max, &sum);
    }
    make_room(s, good);
    memcpy(s->x + ((ptrdiff_t)s->samples - s->origin), x, good * sizeof *x);
    if (s->cascade != NULL)
        ss_cascade_append(s->cascade, x, good, exponent_of(most));
    s->samples += good;
    s->x_max = most;
    ss_status st = s->samples == s->full ? transform_full(s, err) : SS_OK;
    if (st == SS_OK && good < n)
        st = ss_fail(err, SS_EINVAL, "sample %zu is %s, not a finite number", s->samples + 1,
                     isnan(x[good]) ? "NaN" : "infinite");
    return st;
}

/* Keep a failure, or report the earlier one. */
static ss_status
keep(ss_stream *s, ss_status st, const ss_error *why, ss_error *err)
{
    if (s->status == SS_OK && st != SS_OK) {
        s->status = st;
        s->error = *why;
    }
    if (s->status != SS_OK && err != NULL)
        *err = s->error;
    return s->status;
}

ss_status
ss_stream_push(ss_stream *s, const double *x, size_t n, ss_error *err)
{
    if (s == NULL || (x == NULL && n > 0))
        return SS_FAIL_NULL(err);
    ss_error why = { 0 };
    ss_status st = s->status;
    if (st == SS_OK && s->ended)
        st = ss_fail(&why, SS_EINVAL, "the stream has ended");
    while (st == SS_OK && n > 0) {
        size_t piece = s->full - s->samples < PIECE ? s->full - s->samples : PIECE;
        piece = n < piece ? n : piece;
        st = append_samples(s, x, piece, &why);
        x += piece;
        n -= piece;
    }
    return keep(s, st, &why, err);
}

ss_status
ss_stream_drain(ss_stream *s, ss_error *err)
{
    if (s == NULL)
        return SS_FAIL_NULL(err);
    ss_error why = { 0 };
    ss_status st = s->status;
    if (st == SS_OK)
        st = transform_rest_of_blocks(s, (ptrdiff_t)s->samples, &why);
    for (size_t i = 0; st == SS_OK && i < s->n_groups; i++) {
        const group *g = &s->group[i];
        size_t found = 0;
        for (size_t k = 0; found == 0 && k < g->plan->n_scales; k++)
            found = ready(s, g->first + k, (ptrdiff_t)s->samples);
        if (found > 0)
            st = transform(s, g, start_of(s, g), &why);
    }
    return keep(s, st, &why, err);
}

ss_status
ss_stream_end(ss_stream *s, ss_error *err)
{
    if (s == NULL)
        return SS_FAIL_NULL(err);
    ss_error why = { 0 };
    ss_status st = s->status;
    if (st == SS_OK && s->samples == 0)
        st = ss_fail(&why, SS_EINVAL, "the record is empty");
    if (st == SS_OK && !s->ended)
        for (size_t i = 0; i < s->n_scales; i++)
            s->state[i].count = ss_scale_count(&s->scale[i], (double)(s->samples - 1) / s->rate);
    if (st == SS_OK && !s->ended)
        st = transform_rest_of_blocks(s, PTRDIFF_MAX, &why);
    s->ended = 1;
    for (size_t i = 0; st == SS_OK && i < s->n_groups; i++) {
        ptrdiff_t start;
        while (st == SS_OK && (start = start_of(s, &s->group[i])) < PTRDIFF_MAX)
            st = transform(s, &s->group[i], start, &why);
    }
    return keep(s, st, &why, err);
}

/* --- making and freeing ----------------------------------------------------------------------- */

static ptrdiff_t
reach_of(double a, double rate)
{
    return (ptrdiff_t)fmin(ceil(REACH * a * rate) + 1, 0x1p50);
}

/* The number of scales from first on that form a group. */
static size_t
scales_together(const ss_stream *s, size_t first)
{
    size_t n = 1;
    if (s->state[first].reach <= SHORT)
        return s->n_scales - first;
    while (first + n < s->n_scales && s->state[first + n].reach > SHORT
           && s->scale[first].a < s->scale[first + n].a * (1 << OCTAVES))
        n++;
    return n;
}

/* A plan for windows of n samples. */
static ss_status
new_group(const ss_stream *s, group *g, size_t first, size_t n_scales, size_t n)
{
    *g = (group){ .first = first, .unit = 1, .plan = calloc(1, sizeof *g->plan) };
    if (g->plan == NULL)
        return SS_ENOMEM;
    *g->plan = (ss_morlet){ .opts = s->opts, .n = n, .rate = s->rate, .window = 1,
                            .n_scales = n_scales, .scale = malloc(n_scales * sizeof *s->scale) };
    if (g->plan->scale == NULL)
        return SS_ENOMEM;
    memcpy(g->plan->scale, s->scale + first, n_scales * sizeof *s->scale);
    return SS_OK;
}

/* The scales that are transformed in blocks. */
static ss_status
plan_blocks(ss_stream *s)
{
    group *g = &s->blocks;
    size_t n = 0;
    ss_status st = new_group(s, g, 0, s->n_scales, 0);
    if (st == SS_OK)
        st = ss_blocks_new(g->plan);
    while (st == SS_OK && n < s->n_scales && ss_blocks_covers(g->plan->blocks, n))
        n++;
    if (st == SS_OK && n > 0 && (s->cascade = ss_cascade_new(g->plan->blocks)) == NULL)
        st = SS_ENOMEM;
    if (g->plan != NULL)
        g->plan->n_scales = n;
    return st;
}

/* The plan of a group, its scales with as many translations as a window yields. */
static ss_status
plan_group(const ss_stream *s, group *g, size_t first)
{
    double reach = (double)s->state[first].reach, n = reach * (reach < LONG / 8 ? 8 : 4);
    if (s->state[first].reach <= SHORT)
        n = exp2(ceil(log2(fmax(n, BASE))));
    if (!(n < 0x1p58))
        return SS_ENOMEM;
    ss_status st = new_group(s, g, first, scales_together(s, first), (size_t)n);
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < g->plan->n_scales; i++) {
        ss_scale *sc = &g->plan->scale[i];
        double hop = (double)g->plan->n - 2 * reach, step = sc->b_num / sc->b_den * s->rate;
        sc->n = (size_t)fmin(ceil(hop / step), 0x1p50);
    }
    st = ss_fft_new(g->plan);
    if (st == SS_OK)
        g->unit = (ptrdiff_t)ss_fft_unit(g->plan);
    return st;
}

static ss_status
plan_groups(ss_stream *s)
{
    s->group = calloc(s->n_scales, sizeof *s->group);
    if (s->group == NULL)
        return SS_ENOMEM;
    for (size_t first = s->blocks.plan->n_scales; first < s->n_scales;) {
        group *g = &s->group[s->n_groups++];
        ss_status st = plan_group(s, g, first);
        if (st != SS_OK)
            return st;
        first += g->plan->n_scales;
    }
    return SS_OK;
}

/* The cost by the definition, and its wavelets that are kept: the short ones. */
static ss_status
plan_rows(ss_stream *s)
{
    size_t bytes = 0;
    for (size_t i = s->n_groups; i-- > 0;) {
        const ss_morlet *plan = s->group[i].plan;
        for (size_t k = plan->n_scales; k-- > 0;) {
            scale_state *r = &s->state[s->group[i].first + k];
            const ss_scale *sc = &plan->scale[k];
            r->place = ss_quadrature_cost(plan, sc, 1);
            r->table = ss_wavelet_cost(plan, sc);
            bytes += ss_wavelet_bytes(&s->opts, sc->a, s->rate, plan->n);
            if (bytes > TABLES)
                continue;
            r->wave = ss_wavelet_new(&s->opts, sc->a, s->rate, plan->n);
            if (r->wave == NULL)
                return SS_ENOMEM;
        }
    }
    return SS_OK;
}

/* Room for samples and coefficients; the signal is zero before its first sample. */
static ss_status
make_buffers(ss_stream *s)
{
    size_t longest = 0, places = 1;
    for (size_t i = 0; i < s->n_groups; i++) {
        const group *g = &s->group[i];
        ptrdiff_t start = start_of(s, g);
        longest = g->plan->n > longest ? g->plan->n : longest;
        s->origin = start < s->origin ? start : s->origin;
        for (size_t k = 0; k < g->plan->n_scales; k++) {
            size_t n = (size_t)places_of(g, g->first + k);
            places = n > places ? n : places;
        }
    }
    s->room = longest + PIECE;
    s->worker_room = GIVEN + places;
    for (size_t i = 0; i < s->blocks.plan->n_scales; i++) {
        size_t hop = ss_blocks_hop(s->blocks.plan->blocks, i);
        s->worker_room = hop > s->worker_room ? hop : s->worker_room;
    }
    s->x = calloc(s->room, sizeof *s->x);
    s->worker = calloc((size_t)s->opts.threads, sizeof *s->worker);
    if (s->x == NULL || s->worker == NULL)
        return SS_ENOMEM;
    ss_status st = SS_OK;
    for (int t = 0; st == SS_OK && t < s->opts.threads; t++) {
        st = ss_morlet_scratch(s->blocks.plan, &s->worker[t].of_blocks);
        if ((s->worker[t].w = malloc(2 * s->worker_room * sizeof(double))) == NULL)
            st = SS_ENOMEM;
    }
    return st;
}

static ss_status
prepare(ss_stream *s, ss_error *err)
{
    ss_status st = ss_morlet_grid(&s->scale, &s->n_scales, 0, s->rate, &s->opts, err);
    if (st != SS_OK)
        return st;
    ss_morlet_leave_rounding(&s->opts);
    s->state = calloc(s->n_scales, sizeof *s->state);
    if (s->state == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < s->n_scales; i++) {
        s->state[i].reach = reach_of(s->scale[i].a, s->rate);
        s->state[i].count = SIZE_MAX;
        go_on(s, i, 0);
    }
    if ((st = plan_blocks(s)) == SS_OK && (st = plan_groups(s)) == SS_OK
        && (st = plan_rows(s)) == SS_OK)
        st = make_buffers(s);
    return st == SS_OK ? transform_full(s, err) : st;
}

ss_status
ss_stream_new(ss_stream **out, double rate, const ss_morlet_opts *opts, ss_coefficient_sink *sink,
              void *user, ss_error *err)
{
    if (out == NULL || opts == NULL || sink == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_morlet_check(1, rate, opts, err);
    if (st != SS_OK)
        return st;
    if (!(opts->fmin > 0) && !opts->octaves)
        return ss_fail(err, SS_EINVAL, "a stream, whose length is not known, needs fmin");
    if (opts->detrend != SS_DETREND_NONE)
        return ss_fail(err, SS_EINVAL, "a stream cannot be detrended: a mean or a line is that of "
                       "the whole record");
    ss_stream *s = calloc(1, sizeof *s);
    if (s == NULL)
        return SS_ENOMEM;
    *s = (ss_stream){ .opts = *opts, .rate = rate, .sink = sink, .user = user,
                      .limit = PTRDIFF_MAX };
    if ((st = prepare(s, err)) != SS_OK) {
        ss_stream_free(s);
        return st;
    }
    *out = s;
    return SS_OK;
}

size_t
ss_stream_scales(const ss_stream *s)
{
    if (s == NULL)
        return 0;
    return s->n_scales;
}

const ss_scale *
ss_stream_scale(const ss_stream *s, size_t i)
{
    return s != NULL && i < s->n_scales ? &s->scale[i] : NULL;
}

size_t
ss_stream_window(const ss_stream *s, size_t i)
{
    if (s != NULL && i < s->blocks.plan->n_scales)
        return (size_t)ss_blocks_delay(s->blocks.plan->blocks, i);
    for (size_t k = 0; s != NULL && k < s->n_groups; k++) {
        const group *g = &s->group[k];
        if (i - g->first < g->plan->n_scales)
            return g->plan->n;
    }
    return 0;
}

size_t
ss_stream_samples(const ss_stream *s)
{
    if (s == NULL)
        return 0;
    return s->samples;
}

void
ss_stream_free(ss_stream *s)
{
    if (s == NULL)
        return;
    for (size_t i = 0; i < s->n_groups; i++)
        ss_morlet_free(s->group[i].plan);
    ss_cascade_free(s->cascade);
    ss_morlet_free(s->blocks.plan);
    for (size_t i = 0; s->state != NULL && i < s->n_scales; i++)
        ss_wavelet_free(s->state[i].wave);
    for (int t = 0; s->worker != NULL && t < s->opts.threads; t++) {
        ss_fft_scratch_free(s->worker[t].of_blocks);
        free(s->worker[t].w);
    }
    free(s->group);
    free(s->state);
    free(s->scale);
    free(s->worker);
    free(s->x);
    free(s);
}
