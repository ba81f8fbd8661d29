/* stream_plan.c -- choose the windows of a stream, and allocate what it needs, before its first
 * sample.
 *
 * The longest scales, as a rule all, are computed in blocks, as those of a record are (fft/windows.c).
 * Others are computed by the definition: scales of similar length form a group, which has windows of a
 * fixed length, at least twice the length of its longest wavelet. */
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "map/stream.h"

enum {
    BASE = 1 << 13,             /* a window has at least so many samples */
    SHORT = 1 << 13,            /* scales of at most this reach form one group */
    OCTAVES = 5,                /* other groups have scales of so many octaves */
    LONG = 1 << 21,             /* a window longer than this is twice its wavelet, not four times */
    TABLES = 32 << 20           /* most bytes of wavelets that are stored */
};

static ss_status
plan_grid(ss_stream *s, ss_error *err)
{
    ss_status st = ss_grid_make(&s->scale, &s->n_scales, 0, s->rate, &s->opts, err);
    if (st != SS_OK)
        return st;
    ss_morlet_leave_rounding(&s->opts);
    s->state = calloc(s->n_scales, sizeof *s->state);
    if (s->state == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < s->n_scales; i++) {
        double reach = ceil(REACH * s->scale[i].a * s->rate) + 1;
        s->state[i].reach = (ptrdiff_t)fmin(reach, 0x1p50);
        s->state[i].count = SIZE_MAX;
        ss_stream_continue(s, i, 0);
    }
    return SS_OK;
}

/* Make a group of n_scales scales, with windows of n samples. */
static ss_status
new_group(const ss_stream *s, group *g, size_t first, size_t n_scales, size_t n)
{
    *g = (group){ .first = first, .plan = calloc(1, sizeof *g->plan) };
    if (g->plan == NULL)
        return SS_ENOMEM;
    *g->plan = (ss_morlet){ .opts = s->opts, .n = n, .rate = s->rate, .window = 1,
                            .n_scales = n_scales, .scale = malloc(n_scales * sizeof *s->scale) };
    if (g->plan->scale == NULL)
        return SS_ENOMEM;
    memcpy(g->plan->scale, s->scale + first, n_scales * sizeof *s->scale);
    return SS_OK;
}

/* Plan the scales that are transformed in blocks, as those of the longest record that a plan allows. */
static ss_status
plan_blocks(ss_stream *s)
{
    group *g = &s->blocks;
    size_t n = 0;
    ss_status st = new_group(s, g, 0, s->n_scales, INT_MAX / 2);
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

/* Choose the windows of a group whose longest scale is `first`, and make its plan. */
static ss_status
plan_group(const ss_stream *s, group *g, size_t first)
{
    double reach = (double)s->state[first].reach, n = reach * (reach < LONG / 8 ? 8 : 4);
    if (s->state[first].reach <= SHORT)
        n = exp2(ceil(log2(fmax(n, BASE))));
    if (!(n < 0x1p58))
        return SS_ENOMEM;
    return new_group(s, g, first, scales_together(s, first), (size_t)n);
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

/* Make the wavelets of the scales that are computed by the definition, from short to long, as many as
 * TABLES allows. */
static ss_status
plan_sums(ss_stream *s)
{
    size_t bytes = 0;
    for (size_t i = s->n_groups; i-- > 0;) {
        const ss_morlet *plan = s->group[i].plan;
        for (size_t k = plan->n_scales; k-- > 0;) {
            scale_state *r = &s->state[s->group[i].first + k];
            const ss_scale *sc = &plan->scale[k];
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

/* Make room for samples.  The signal is zero before its first one. */
static ss_status
make_room_for_samples(ss_stream *s)
{
    size_t longest = 0;
    for (size_t i = 0; i < s->n_groups; i++) {
        ptrdiff_t start = ss_group_start(s, &s->group[i]);
        size_t n = s->group[i].plan->n;
        longest = n > longest ? n : longest;
        s->origin = start < s->origin ? start : s->origin;
    }
    s->room = longest + STREAM_PIECE;
    s->x = calloc(s->room, sizeof *s->x);
    return s->x != NULL ? SS_OK : SS_ENOMEM;
}

/* The largest number of coefficients that a worker computes at a time. */
static size_t
worker_room(const ss_stream *s)
{
    size_t room = s->n_groups > 0 ? GIVEN : 1;
    for (size_t i = 0; i < s->blocks.plan->n_scales; i++) {
        size_t n = ss_blocks_most(s->blocks.plan->blocks, i);
        room = n > room ? n : room;
    }
    return room < GIVEN ? room : GIVEN;
}

static ss_status
make_workers(ss_stream *s)
{
    size_t scratch = ss_morlet_room(s->blocks.plan);
    s->worker_room = worker_room(s);
    s->worker = calloc((size_t)s->opts.threads, sizeof *s->worker);
    if (s->worker == NULL)
        return SS_ENOMEM;
    for (int t = 0; t < s->opts.threads; t++) {
        stream_worker *wk = &s->worker[t];
        wk->w = malloc(2 * s->worker_room * sizeof *wk->w);
        wk->scratch = scratch > 0 ? ss_fft_doubles(scratch) : NULL;
        if (wk->w == NULL || (scratch > 0 && wk->scratch == NULL))
            return SS_ENOMEM;
    }
    return SS_OK;
}

ss_status
ss_stream_plan(ss_stream *s, ss_error *err)
{
    ss_status st = plan_grid(s, err);
    if (st == SS_OK)
        st = plan_blocks(s);
    if (st == SS_OK)
        st = plan_groups(s);
    if (st == SS_OK)
        st = plan_sums(s);
    if (st == SS_OK)
        st = make_room_for_samples(s);
    return st == SS_OK ? make_workers(s) : st;
}
