/* stream.c -- transform a signal whose end is not known, window by window.
 *
 * A window of a group of scales begins where the next coefficient of the group needs it to begin.
 * It gives all coefficients of the group whose wavelets lie inside.  The next window overlaps it
 * by the length of the longest wavelet, so only samples are kept from one window to the next.  In
 * blocks each level keeps one window, which is computed when it is full.  When complete
 * coefficients are wanted at once, windows are filled up with zeros and computed. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "map/stream.h"

/* --- samples ---------------------------------------------------------------------------------- */

/* Make room for n more samples; samples that no window needs any more are discarded. */
static void
make_room(ss_stream *s, size_t n)
{
    ptrdiff_t keep = (ptrdiff_t)s->samples;
    size_t held = (size_t)(keep - s->origin);
    if (held + n <= s->room)
        return;
    for (size_t i = 0; i < s->n_groups; i++) {
        ptrdiff_t start = ss_group_start(s, &s->group[i]);
        keep = start < keep ? start : keep;
    }
    size_t drop = (size_t)(keep - s->origin);
    memmove(s->x, s->x + drop, (held - drop) * sizeof *s->x);
    s->origin = keep;
}

/* Compute the full windows, and set the number of samples at which the next will be full.  A window is
 * computed as soon as it has its last sample, so its coefficients do not depend on how samples arrive. */
static ss_status
transform_full(ss_stream *s, ss_error *err)
{
    ss_status st = ss_blocks_transform_full(s, err);
    s->full = s->cascade != NULL ? s->samples + ss_cascade_room(s->cascade) : SIZE_MAX;
    for (size_t i = 0; i < s->n_groups; i++) {
        const group *g = &s->group[i];
        ptrdiff_t start, n = (ptrdiff_t)g->plan->n;
        while ((start = ss_group_start(s, g)) <= (ptrdiff_t)s->samples - n && st == SS_OK)
            st = ss_group_transform(s, g, start, err);
        s->full = (size_t)(start + n) < s->full ? (size_t)(start + n) : s->full;
    }
    return st;
}

/* Samples are stored divided by 2^exponent, so that their squares neither overflow nor underflow.  It is 0
 * except for signals near the limits of a double. */
static int
exponent_of(double x_max)
{
    enum { FAR = 300 };
    return x_max > 0 ? FAR * (ilogb(x_max) / FAR) : 0;
}

/* Divide the samples that are there so that they suit x_max; `held` are in s->x. */
static void
follow_exponent(ss_stream *s, size_t held)
{
    int more = exponent_of(s->x_max) - s->exponent;
    double most = ldexp(s->x_max, -s->exponent);
    if (more == 0)
        return;
    ss_morlet_divide(s->x, held, more, most);
    if (s->cascade != NULL)
        ss_cascade_divide(s->cascade, more, most);
    s->exponent += more;
}

static ss_status
append_samples(ss_stream *s, const double *x, size_t n, ss_error *err)
{
    double most;
    size_t good = ss_morlet_finite(x, n, &most);
    s->x_max = fmax(most, s->x_max);
    make_room(s, good);
    size_t held = (size_t)((ptrdiff_t)s->samples - s->origin);
    double *to = s->x + held;
    follow_exponent(s, held);
    memcpy(to, x, good * sizeof *x);
    ss_morlet_divide(to, good, s->exponent, s->x_max);
    if (s->cascade != NULL)
        ss_cascade_append(s->cascade, to, good);
    s->samples += good;
    ss_status st = s->samples == s->full ? transform_full(s, err) : SS_OK;
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
        size_t left = s->full - s->samples, piece = left < STREAM_PIECE ? left : STREAM_PIECE;
        piece = n < piece ? n : piece;
        st = append_samples(s, x, piece, &why);
        x += piece;
        n -= piece;
    }
    return keep(s, st, &why, err);
}

/* 1 if a coefficient of the group is complete and has not been sent. */
static int
any_ready(const ss_stream *s, const group *g)
{
    for (size_t i = g->first; i < g->first + g->plan->n_scales; i++)
        if (ss_stream_ready(s, i, (ptrdiff_t)s->samples) > 0)
            return 1;
    return 0;
}

ss_status
ss_stream_drain(ss_stream *s, ss_error *err)
{
    if (s == NULL)
        return SS_FAIL_NULL(err);
    ss_error why = { 0 };
    ss_status st = s->status;
    if (st == SS_OK)
        st = ss_blocks_transform_rest(s, (ptrdiff_t)s->samples, &why);
    for (size_t i = 0; st == SS_OK && i < s->n_groups; i++) {
        const group *g = &s->group[i];
        if (any_ready(s, g))
            st = ss_group_transform(s, g, ss_group_start(s, g), &why);
    }
    return keep(s, st, &why, err);
}

static ss_status
transform_rest(ss_stream *s, ss_error *err)
{
    for (size_t i = 0; i < s->n_scales; i++)
        s->state[i].count = ss_scale_count(&s->scale[i], (double)(s->samples - 1) / s->rate);
    ss_status st = ss_blocks_transform_rest(s, PTRDIFF_MAX, err);
    s->ended = 1;
    for (size_t i = 0; i < s->n_groups; i++) {
        ptrdiff_t start;
        while (st == SS_OK && (start = ss_group_start(s, &s->group[i])) < PTRDIFF_MAX)
            st = ss_group_transform(s, &s->group[i], start, err);
    }
    return st;
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
        st = transform_rest(s, &why);
    s->ended = 1;
    return keep(s, st, &why, err);
}

/* --- making and freeing ----------------------------------------------------------------------- */

ss_status
ss_stream_new(ss_stream **out, double rate, const ss_morlet_opts *given, ss_coefficient_sink *sink,
              void *user, ss_error *err)
{
    ss_morlet_opts opts;
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
    *s = (ss_stream){ .opts = opts, .rate = rate, .sink = sink, .user = user };
    if ((st = ss_stream_plan(s, err)) == SS_OK)
        st = transform_full(s, err);
    s->grid = (ss_grid){ s->n_scales, s->scale, 0 };
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
    for (size_t i = 0; i < s->n_groups; i++)
        ss_morlet_free(s->group[i].plan);
    ss_cascade_free(s->cascade);
    ss_morlet_free(s->blocks.plan);
    for (size_t i = 0; s->state != NULL && i < s->n_scales; i++)
        ss_wavelet_free(s->state[i].wave);
    for (int t = 0; s->worker != NULL && t < s->opts.threads; t++) {
        ss_fft_scratch_free(s->worker[t].scratch);
        free(s->worker[t].w);
    }
    free(s->group);
    free(s->state);
    free(s->scale);
    free(s->worker);
    free(s->x);
    free(s);
}

/* --- what it does ----------------------------------------------------------------------------- */

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
    if (s == NULL || i >= s->n_scales)
        return 0;
    if (i < s->blocks.plan->n_scales)
        return (size_t)ss_blocks_delay(s->blocks.plan->blocks, i);
    const group *g = s->group;
    while (i - g->first >= g->plan->n_scales)
        g++;
    return g->plan->n;
}
