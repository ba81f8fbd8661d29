/* overview.c -- reduce a recording of any length in one pass to what a picture shows. */
#include <stickslip/overview.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/largest.h"
#include "base/versions.h"
#include "map/map.h"
#include "map/wavelet.h"
#include "plot/extremes.h"
#include "plot/noise_level.h"
#include "signal/gaps.h"

enum { BLOCKS = 4096 };

struct ss_overview {
    ss_header *head;            /* of the signal */
    size_t column;
    ss_morlet_opts opts;
    ss_stream *stream;
    ss_span *gap;
    size_t n_gaps;
    extremes samples, *scale;   /* of |W|, of each scale */
    noise_level *noise;
    double top;
    ss_coefficients result;
    ss_signal *signal;
};

/* --- levels -------------------------------------------------------------------------------- */

/* Add n levels to a row of levels.  Returns the largest. */
VERSIONS static double
add_levels(extremes *r, const double *level, size_t n)
{
    double all = 0;
    for (size_t k = 0, m, i; k < n; k += m) {
        m = ss_extremes_next(r, n - k, &i);
        double most = largest_of(level + k, m);
        r->most[i] = most > r->most[i] ? most : r->most[i];
        all = most > all ? most : all;
        r->n += m;
    }
    return all;
}

/* --- as coefficients come ------------------------------------------------------------------ */

enum { PIECE = 512 };           /* coefficients at a time, which stay in the cache */

/* Is a translation in the cone of influence? */
static int
is_edge(const ss_overview *o, const ss_scale *scale, size_t k, size_t samples)
{
    return wavelet_edge(scale, k, samples, o->head->rate, o->head->start, o->gap, o->n_gaps);
}

/* Are all translations first ... last outside the cone of influence, of the ends and of gaps? */
static int
are_inside(const ss_overview *o, const ss_scale *scale, size_t first, size_t last, size_t samples)
{
    double from = ss_scale_b(scale, first), to = ss_scale_b(scale, last);
    return !is_edge(o, scale, first, samples) && !is_edge(o, scale, last, samples)
        && !ss_gaps_near(o->gap, o->n_gaps, o->head->start + (from + to) / 2,
                         (to - from) / 2 + wavelet_cone(scale->a));
}

/* Add the levels of n translations from first on, which lie all in the cone of influence or all
 * outside. */
static void
add_stretch(ss_overview *o, const ss_scale *scale, size_t first, size_t n, const double *level, int edge)
{
    size_t i = (size_t)(scale - ss_stream_grid(o->stream)->scale);
    double most = add_levels(&o->scale[i], level, n);
    if (edge)
        return;
    o->top = most > o->top ? most : o->top;
    ss_noise_level_add(o->noise, scale, i, level, first, n);
}

/* The sink of the stream: add coefficients of a scale to the picture. */
static int
add_rows(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    ss_overview *o = user;
    double level[PIECE];
    for (size_t at = 0, m; at < n; at += m) {
        m = n - at < PIECE ? n - at : PIECE;
        ss_map_give(&(ss_map_part){ .level = level }, 0, m, w + 2 * at);
        int inside = are_inside(o, scale, first + at, first + at + m - 1, samples);
        size_t stretch = inside ? m : 1;
        for (size_t k = 0; k < m; k += stretch)
            add_stretch(o, scale, first + at + k, stretch, level + k,
                        !inside && is_edge(o, scale, first + at + k, samples));
    }
    return 0;
}

ss_status
ss_overview_new(ss_overview **out, const ss_header *head, size_t column, const ss_morlet_opts *opts,
                ss_error *err)
{
    if (out == NULL || head == NULL)
        return SS_FAIL_NULL(err);
    if (column >= head->n_columns)
        return ss_fail_column(err, column, head->n_columns);
    ss_overview *o = *out = calloc(1, sizeof *o);
    if (o == NULL)
        return ss_fail_memory(err, NULL);
    o->column = column;
    ss_status st = ss_morlet_take(&o->opts, opts, err);
    if (st == SS_OK)
        st = ss_stream_new(&o->stream, head->rate, &o->opts, add_rows, o, err);
    size_t scales = st == SS_OK ? ss_stream_grid(o->stream)->n_scales : 0;
    if (st == SS_OK)
        st = ss_header_gaps(&o->gap, &o->n_gaps, head, NULL);
    int made = st == SS_OK && ss_header_copy(&o->head, head, NULL) == SS_OK
        && (o->noise = ss_noise_level_new(scales)) != NULL
        && (o->scale = calloc(scales, sizeof *o->scale)) != NULL && ss_extremes_make(&o->samples, BLOCKS, 1);
    for (size_t i = 0; made && i < scales; i++)
        made = ss_extremes_make(&o->scale[i], BLOCKS, 0);
    if (made)
        return SS_OK;
    ss_overview_free(o);
    *out = NULL;
    return st == SS_OK || st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

ss_status
ss_overview_push(ss_overview *o, const double *x, size_t n, ss_error *err)
{
    if (o == NULL || (x == NULL && n > 0))
        return SS_FAIL_NULL(err);
    ss_status st = ss_stream_push(o->stream, x, n, err);
    if (st == SS_OK)
        ss_extremes_add(&o->samples, x, n);
    return st;
}

/* --- at the end ---------------------------------------------------------------------------- */

static ss_status
make_signal(ss_overview *o)
{
    const extremes *r = &o->samples;
    ss_header *head;
    size_t a_block = r->order > 0 ? 2 : 1, blocks = ss_extremes_count(r);
    double pair[2] = { 0, 0 };
    ss_status st = ss_header_select(&head, o->head, &o->column, 1, 0, NULL);
    if (st != SS_OK)
        return st;
    head->rate = ldexp(o->head->rate * (double)a_block, -r->order);
    st = ss_signal_new(&o->signal, head, a_block * blocks, NULL);
    ss_header_free(head);
    for (size_t i = 0; st == SS_OK && i < blocks; i++) {
        ss_extremes_of(r, i, pair[1], pair);
        memcpy(o->signal->values + i * a_block, pair, a_block * sizeof *pair);
    }
    return st;
}

/* A scale that lies inside the cone of influence as a whole is left out. */
static ss_status
make_coefficients(ss_overview *o)
{
    ss_coefficients *c = &o->result;
    size_t scales = ss_stream_grid(o->stream)->n_scales, first = 0, total = 0;
    const ss_scale *scale = ss_stream_grid(o->stream)->scale;
    c->n = ss_stream_samples(o->stream);
    c->center = o->opts.center;
    c->gap = o->gap;
    c->n_gaps = o->n_gaps;
    while (first < scales && 2 * wavelet_cone(scale[first].a) > (double)c->n / o->head->rate)
        first++;
    c->n_scales = scales - first;
    if (c->n_scales < 2)
        return SS_EDATA;
    for (size_t i = first; i < scales; i++)
        total += ss_extremes_count(&o->scale[i]);
    c->scale = malloc(c->n_scales * sizeof *c->scale);
    c->w = calloc(2 * total, sizeof *c->w);
    if (c->scale == NULL || c->w == NULL)
        return SS_ENOMEM;
    double *w = c->w;
    for (size_t i = first; i < scales; i++) {
        const extremes *r = &o->scale[i];
        c->scale[i - first] = scale[i];
        c->scale[i - first].b_num = ldexp(scale[i].b_num, r->order);
        c->scale[i - first].n = ss_extremes_count(r);
        c->scale[i - first].offset = (size_t)(w - c->w) / 2;
        for (size_t k = 0; k < ss_extremes_count(r); k++, w += 2)
            w[0] = r->most[k];
    }
    return ss_coefficients_header(&c->head, o->head, o->column, c->n, &o->opts, NULL);
}

ss_status
ss_overview_end(ss_overview *o, ss_overview_result *out, ss_error *err)
{
    if (o == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_stream_end(o->stream, err);
    if (st != SS_OK)
        return st;
    double noise = ss_noise_level(o->noise, ss_stream_grid(o->stream)->scale);
    st = make_coefficients(o);
    if (st == SS_EDATA)
        return ss_fail(err, SS_EDATA, "too few samples, %zu: less than two scales have translations outside "
                       "the cone of influence", ss_stream_samples(o->stream));
    if (st == SS_OK)
        st = make_signal(o);
    if (st == SS_OK)
        *out = (ss_overview_result){ &o->result, o->signal, o->top, noise };
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

void
ss_overview_free(ss_overview *o)
{
    if (o == NULL)
        return;
    for (size_t i = 0; o->scale != NULL && i < ss_stream_grid(o->stream)->n_scales; i++)
        ss_extremes_free(&o->scale[i]);
    free(o->scale);
    ss_extremes_free(&o->samples);
    ss_noise_level_free(o->noise);
    ss_stream_free(o->stream);
    free(o->gap);
    ss_header_free(o->result.head);
    free(o->result.scale);
    free(o->result.w);
    ss_signal_free(o->signal);
    ss_header_free(o->head);
    free(o);
}
