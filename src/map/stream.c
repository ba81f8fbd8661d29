/* stream.c -- transform a signal whose end is not known, window by window.
 *
 * The longest scales, as a rule all, are computed in blocks, as those of a record are (fft/windows.c): each level
 * keeps one window, which is computed when it is full.  Other scales are computed by the definition, from windows
 * that they share: one begins where the next coefficient needs it to begin, has at least eight times the reach of
 * the longest wavelet, and gives all coefficients whose wavelets lie inside.  So only samples are kept from
 * one window to the next.  When complete coefficients are wanted at once, windows are filled up with zeros
 * and computed.
 *
 * All samples within REACH a of b are in the window, so a window adds at most exp(-REACH^2/2) to the
 * error of its coefficients, nothing compared with the promise. */
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "map/fft/blocks.h"
#include "map/map.h"
#include "map/plan.h"

enum {
    PIECE = 1 << 14,            /* samples processed at a time, at most */
    LEAST = 1 << 13,            /* a window of the definition has at least so many samples */
    GIVEN = 1 << 17,            /* coefficients computed and passed to the sink at a time, at most */
    TABLES = 32 << 20           /* most bytes of wavelets that are stored */
};

typedef struct scale_state {
    size_t next;                /* its next translation */
    ptrdiff_t due;              /* the samples that it needs, from the first on */
    size_t count;               /* in the record; SIZE_MAX until that has ended */
    ptrdiff_t reach;            /* samples that a coefficient needs on either side, and one */
} scale_state;

/* What is computed of one window: the scales first ... end - 1. */
typedef struct window {
    ss_stream *stream;
    size_t first, end;
    ptrdiff_t limit;            /* a coefficient is complete if it needs no sample from here on */
    int in_blocks;
    size_t number;              /* of a window of blocks */
    transformed of;
    ss_error *err;
} window;

struct ss_stream {
    ss_morlet *plan;            /* as of the longest record that a plan allows */
    ss_coefficient_sink *sink;
    void *user;
    ss_grid grid;               /* for callers */
    size_t samples, in_blocks;  /* in_blocks: so many scales, the first, are */
    size_t full;                /* no window is full before there are so many samples */
    scale_state *state;
    cascade *cascade;           /* NULL: no scale is in blocks */
    size_t length;              /* of a window of the definition */
    double *x, x_max;           /* the last samples / 2^exponent, for it; max|x| of all */
    int exponent;
    ptrdiff_t origin;           /* x[0] is this sample; there are zeros before the first */
    size_t room;                /* in x */
    double *w;
    ss_map_part *part;
    int ended;
    ss_status status;           /* of what failed first */
    ss_error error;
};

/* --- what a window gives ---------------------------------------------------------------------- */

/* Continue scale i at this translation; places are at most 2^60. */
static void
go_on(ss_stream *s, size_t i, size_t next)
{
    scale_state *r = &s->state[i];
    r->next = next;
    r->due = (ptrdiff_t)fmin(floor(ss_scale_b(&s->grid.scale[i], next) * s->plan->rate), 0x1p60) + r->reach;
}

/* The next translations of scale i that need no sample from limit on. */
static size_t
count_ready(const ss_stream *s, size_t i, ptrdiff_t limit)
{
    const scale_state *r = &s->state[i];
    if (limit < r->reach || limit < r->due)
        return 0;
    size_t count = ss_scale_count(&s->grid.scale[i], (double)(limit - r->reach) / s->plan->rate);
    count = count < r->count ? count : r->count;
    return count > r->next ? count - r->next : 0;
}

/* The next translations of scale i that a window gives. */
static size_t
count_given(const window *win, size_t i)
{
    const ss_stream *s = win->stream;
    const scale_state *r = &s->state[i];
    size_t ready = win->limit < PTRDIFF_MAX ? count_ready(s, i, win->limit) : SIZE_MAX;
    if (!win->in_blocks)
        return ready;
    size_t end = ss_blocks_end(s->plan->blocks, i, win->number);
    end = end < r->count ? end : r->count;
    size_t n = end > r->next ? end - r->next : 0;
    return n < ready ? n : ready;
}

/* --- computing and sending -------------------------------------------------------------------- */

/* Compute n parts, and pass them to the sink in their order. */
static ss_status
run_parts(const window *win, size_t n)
{
    ss_stream *s = win->stream;
    ss_status st = ss_morlet_parts(s->plan, &win->of, s->part, n, NULL, win->err);
    for (const ss_map_part *p = s->part; st == SS_OK && p < s->part + n; p++) {
        go_on(s, p->scale, p->first + p->n);
        if (s->sink(&s->grid.scale[p->scale], p->first, p->n, p->w, s->samples, s->user))
            st = SS_STOP;
    }
    return st;
}

/* Compute and send all coefficients of a window, scale by scale in parts of at most GIVEN, whatever the number of
 * threads.  One thread computes part by part, so that each stays in the cache; several threads share as many parts
 * as there is room for. */
static ss_status
run_window(const window *win)
{
    ss_stream *s = win->stream;
    ss_status st = SS_OK;
    for (size_t i = win->first; st == SS_OK && i < win->end;) {
        size_t all = 0, parts = 0, most = s->plan->opts.threads > 1 ? s->grid.n_scales : 1;
        for (; i < win->end && parts < most; i++) {
            size_t n = count_given(win, i), part = n < GIVEN ? n : GIVEN;
            if (all + part > GIVEN)
                break;
            if (part > 0)
                s->part[parts++] = (ss_map_part){ i, s->state[i].next, part, s->w + 2 * all, NULL };
            all += part;
            if (part < n)
                break;                  /* the rest comes next */
        }
        if (parts > 0)
            st = run_parts(win, parts);
    }
    return st;
}

/* --- windows of blocks ------------------------------------------------------------------------ */

/* Compute and send all coefficients of a window of a level. */
static ss_status
run_level(size_t level, size_t number, double *spectrum, void *user)
{
    window win = *(const window *)user;
    const ss_stream *s = win.stream;
    const struct blocks *b = s->plan->blocks;
    win.number = win.of.spectra.first = number;
    win.of.spectra.level[level] = spectrum;
    while (win.first < s->in_blocks && ss_blocks_level(b, win.first) > level)
        win.first++;
    win.end = win.first;
    while (win.end < s->in_blocks && ss_blocks_level(b, win.end) == level)
        win.end++;
    return run_window(&win);
}

/* What run_level is asked for. */
static window
blocks_of(ss_stream *s, ptrdiff_t limit, ss_error *err)
{
    return (window){ .stream = s, .in_blocks = 1, .limit = limit, .of.rec.exponent = s->exponent, .err = err };
}

/* All coefficients in blocks that need no sample from limit on, PTRDIFF_MAX: all. */
static ss_status
run_blocks_to(ss_stream *s, ptrdiff_t limit, ss_error *err)
{
    window asked = blocks_of(s, limit, err);
    return s->cascade != NULL ? ss_cascade_end(s->cascade, s->samples, run_level, &asked) : SS_OK;
}

/* --- windows of the definition ---------------------------------------------------------------- */

/* The start of the next window; PTRDIFF_MAX if no coefficient is left. */
static ptrdiff_t
next_start(const ss_stream *s)
{
    ptrdiff_t start = PTRDIFF_MAX;
    for (size_t i = s->in_blocks; i < s->grid.n_scales; i++) {
        const scale_state *r = &s->state[i];
        ptrdiff_t from = r->due - 2 * r->reach - 1;
        start = r->next < r->count && from < start ? from : start;
    }
    return start;
}

/* Compute and send the coefficients of the window at start, of those that have arrived. */
static ss_status
run_sums(ss_stream *s, ptrdiff_t start, ss_error *err)
{
    ptrdiff_t limit = start + (ptrdiff_t)s->length, samples = (ptrdiff_t)s->samples;
    size_t there = samples > start ? (size_t)(samples - start) : 0;
    const record rec = { .n = there < s->length ? there : s->length, .x = s->x + (start - s->origin),
                         .exponent = s->exponent, .origin = start };
    const window win = { .stream = s, .first = s->in_blocks, .end = s->grid.n_scales, .of.rec = rec,
                         .limit = s->ended || limit < samples ? limit : samples, .err = err };
    return run_window(&win);
}

/* --- samples ---------------------------------------------------------------------------------- */

/* Compute the full windows, and set the number of samples at which the next will be full.  A window is
 * computed as soon as it has its last sample, so its coefficients do not depend on how samples arrive. */
static ss_status
run_full(ss_stream *s, ss_error *err)
{
    window asked = blocks_of(s, PTRDIFF_MAX, err);
    ptrdiff_t start, n = (ptrdiff_t)s->length;
    ss_status st = s->cascade != NULL ? ss_cascade_run(s->cascade, run_level, &asked) : SS_OK;
    s->full = s->cascade != NULL ? s->samples + ss_cascade_room(s->cascade) : SIZE_MAX;
    while ((start = next_start(s)) <= (ptrdiff_t)s->samples - n && st == SS_OK)
        st = run_sums(s, start, err);
    if (start < PTRDIFF_MAX && (size_t)(start + n) < s->full)
        s->full = (size_t)(start + n);
    return st;
}

/* Divide the samples that are there so that their squares neither overflow nor underflow, now that x_max is the
 * largest; `held` are in s->x.  The exponent is 0 except for signals near the limits of a double. */
static void
follow_exponent(ss_stream *s, size_t held)
{
    enum { FAR = 300 };
    int more = (s->x_max > 0 ? FAR * (ilogb(s->x_max) / FAR) : 0) - s->exponent;
    double most = ldexp(s->x_max, -s->exponent);
    if (more == 0)
        return;
    ss_morlet_divide(s->x, held, more, most);
    if (s->cascade != NULL)
        ss_cascade_divide(s->cascade, more, most);
    s->exponent += more;
}

/* Append n samples, at most as many as complete a window; those that no window needs any more are discarded. */
static ss_status
append(ss_stream *s, const double *x, size_t n, ss_error *err)
{
    double most;
    size_t good = ss_morlet_finite(x, n, &most), held = (size_t)((ptrdiff_t)s->samples - s->origin);
    s->x_max = fmax(most, s->x_max);
    if (held + good > s->room) {
        ptrdiff_t start = next_start(s), keep = start < (ptrdiff_t)s->samples ? start : (ptrdiff_t)s->samples;
        size_t drop = (size_t)(keep - s->origin);
        held -= drop;
        memmove(s->x, s->x + drop, held * sizeof *s->x);
        s->origin = keep;
    }
    double *to = s->x + held;
    follow_exponent(s, held);
    memcpy(to, x, good * sizeof *x);
    ss_morlet_divide(to, good, s->exponent, s->x_max);
    if (s->cascade != NULL)
        ss_cascade_append(s->cascade, to, good);
    s->samples += good;
    ss_status st = s->samples == s->full ? run_full(s, err) : SS_OK;
    return st == SS_OK && good < n ? ss_morlet_not_finite(err, s->samples + 1, x[good]) : st;
}

/* Store the first failure in the stream; every later call returns it. */
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
        size_t left = s->full - s->samples, piece = left < PIECE ? left : PIECE;
        piece = n < piece ? n : piece;
        st = append(s, x, piece, &why);
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
    size_t ready = 0;
    if (st == SS_OK)
        st = run_blocks_to(s, (ptrdiff_t)s->samples, &why);
    for (size_t i = s->in_blocks; i < s->grid.n_scales; i++)
        ready += count_ready(s, i, (ptrdiff_t)s->samples);
    if (st == SS_OK && ready > 0)
        st = run_sums(s, next_start(s), &why);
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
    for (size_t i = 0; st == SS_OK && !s->ended && i < s->grid.n_scales; i++)
        s->state[i].count = ss_scale_count(&s->grid.scale[i], (double)(s->samples - 1) / s->plan->rate);
    if (st == SS_OK && !s->ended)
        st = run_blocks_to(s, PTRDIFF_MAX, &why);
    s->ended = 1;
    for (ptrdiff_t start; st == SS_OK && (start = next_start(s)) < PTRDIFF_MAX;)
        st = run_sums(s, start, &why);
    return keep(s, st, &why, err);
}

/* --- making and freeing ----------------------------------------------------------------------- */

/* The grid, and the scales that are in blocks. */
static ss_status
make_plan(ss_stream *s, double rate, const ss_morlet_opts *opts, ss_error *err)
{
    ss_morlet *plan = s->plan = calloc(1, sizeof *plan);
    if (plan == NULL)
        return SS_ENOMEM;
    *plan = (ss_morlet){ .opts = *opts, .n = INT_MAX / 2, .rate = rate, .window = 1 };
    ss_status st = ss_grid_make(&plan->scale, &plan->n_scales, 0, rate, opts, err);
    if (st == SS_OK)
        st = ss_blocks_new(plan);
    s->grid = (ss_grid){ plan->n_scales, plan->scale, 0 };
    while (st == SS_OK && s->in_blocks < plan->n_scales && ss_blocks_covers(plan->blocks, s->in_blocks))
        s->in_blocks++;
    return st == SS_OK && s->in_blocks > 0 && (s->cascade = ss_cascade_new(plan->blocks)) == NULL ? SS_ENOMEM : st;
}

/* The state of each scale.  *longest becomes the reach of the longest by the definition. */
static ss_status
make_states(ss_stream *s, double *longest)
{
    const ss_morlet *plan = s->plan;
    s->state = calloc(plan->n_scales, sizeof *s->state);
    if (s->state == NULL)
        return SS_ENOMEM;
    for (size_t i = plan->n_scales; i-- > 0;) {
        scale_state *r = &s->state[i];
        double a = plan->scale[i].a, reach = ceil(REACH * a * plan->rate) + 1;
        r->reach = (ptrdiff_t)fmin(reach, 0x1p50);
        r->count = SIZE_MAX;
        go_on(s, i, 0);
        *longest = i < s->in_blocks ? *longest : reach;
    }
    return ss_morlet_keep_wavelets(s->plan, TABLES);
}

/* Room for samples, of which the first window has zeros before the record, and for what threads need. */
static ss_status
make_room(ss_stream *s, double longest)
{
    double n = exp2(ceil(log2(fmax(8 * longest, LEAST))));
    if (!(n < 0x1p58))
        return SS_ENOMEM;
    if (longest > 0) {
        s->length = (size_t)n;
        s->origin = next_start(s);
    }
    s->room = s->length + PIECE;
    s->x = calloc(s->room, sizeof *s->x);
    s->w = malloc(2 * GIVEN * sizeof *s->w);
    s->part = malloc(s->grid.n_scales * sizeof *s->part);
    return s->x != NULL && s->w != NULL && s->part != NULL ? SS_OK : SS_ENOMEM;
}

ss_status
ss_stream_new(ss_stream **out, double rate, const ss_morlet_opts *given, ss_coefficient_sink *sink,
              void *user, ss_error *err)
{
    ss_morlet_opts opts;
    double longest = 0;
    if (out == NULL || sink == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_morlet_take(&opts, given, err);
    if (st == SS_OK)
        st = ss_morlet_check(1, rate, &opts, err);
    if (st != SS_OK)
        return st;
    if (!(opts.fmin > 0) && !opts.octaves)
        return ss_fail(err, SS_EINVAL, "a stream, whose length is not known, needs fmin");
    if (opts.detrend != SS_DETREND_NONE)
        return ss_fail(err, SS_EINVAL, "a stream cannot be detrended: a mean or a line is that of "
                       "the whole record");
    ss_stream *s = calloc(1, sizeof *s);
    if (s == NULL)
        return SS_ENOMEM;
    s->sink = sink;
    s->user = user;
    st = make_plan(s, rate, &opts, err);
    if (st == SS_OK)
        st = make_states(s, &longest);
    if (st == SS_OK)
        st = make_room(s, longest);
    if (st == SS_OK)
        st = run_full(s, err);
    if (st == SS_OK)
        *out = s;
    else
        ss_stream_free(s);
    return st;
}

void
ss_stream_free(ss_stream *s)
{
    if (s == NULL)
        return;
    ss_cascade_free(s->cascade);
    ss_morlet_free(s->plan);
    free(s->state);
    free(s->part);
    free(s->w);
    free(s->x);
    free(s);
}

const ss_grid *
ss_stream_grid(const ss_stream *s)
{
    return s != NULL ? &s->grid : NULL;
}

size_t
ss_stream_samples(const ss_stream *s)
{
    return s != NULL ? s->samples : 0;
}

size_t
ss_stream_window(const ss_stream *s, size_t i)
{
    if (s == NULL || i >= s->grid.n_scales)
        return 0;
    return i < s->in_blocks ? (size_t)ss_blocks_delay(s->plan->blocks, i) : s->length;
}
