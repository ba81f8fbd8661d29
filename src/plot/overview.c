/* overview.c -- reduce a recording of any length in one pass to what a picture shows. */
#include <stickslip/overview.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/versions.h"
#include "io/format.h"
#include "map/map.h"
#include "plot/contour.h"
#include "plot/series.h"
#include "signal/gaps.h"

enum { LONG = 4096 };           /* blocks */

typedef struct reduction {
    const ss_header *head;      /* of the signal */
    ss_morlet_opts opts;
    ss_stream *stream;
    ss_span *gap;
    size_t n_gaps;
    extremes samples, *scale;   /* of |W|, of each scale */
    noise_level *noise;
    double top;
} reduction;

enum { PIECE = 512 };           /* coefficients at a time, which stay in the cache */

/* Add n levels to a row of levels.  Returns the largest. */
VERSIONS static double
add_levels(extremes *r, const double *level, size_t n)
{
    double all = 0;
    for (size_t k = 0, m, i; k < n; k += m) {
        m = ss_extremes_next(r, n - k, &i);
        double most = 0;
        for (size_t j = k; j < k + m; j++)
            most = level[j] > most ? level[j] : most;
        r->most[i] = most > r->most[i] ? most : r->most[i];
        all = most > all ? most : all;
        r->n += m;
    }
    return all;
}

/* Is a translation in the cone of influence? */
static int
is_edge(const reduction *o, const ss_scale *scale, size_t k, size_t samples)
{
    return wavelet_edge(scale, k, samples, o->head->rate, o->head->start, o->gap, o->n_gaps);
}

/* The sink of the stream: add coefficients of a scale to the picture, in stretches that lie all in the cone of
 * influence, of the ends and of gaps, or all outside. */
static int
add_rows(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    reduction *o = user;
    double level[PIECE], cone = wavelet_cone(scale->a);
    size_t i = (size_t)(scale - ss_stream_grid(o->stream)->scale);
    for (size_t end = first + n, m; first < end; first += m, w += 2 * m) {
        m = end - first < PIECE ? end - first : PIECE;
        double from = ss_scale_b(scale, first), to = ss_scale_b(scale, first + m - 1);
        int inside = !is_edge(o, scale, first, samples) && !is_edge(o, scale, first + m - 1, samples)
            && !ss_gaps_near(o->gap, o->n_gaps, o->head->start + (from + to) / 2, (to - from) / 2 + cone);
        size_t stretch = inside ? m : 1;
        ss_map_give(&(ss_map_part){ .level = level }, 0, m, w);
        for (size_t k = 0; k < m; k += stretch) {
            double most = add_levels(&o->scale[i], level + k, stretch);
            if (!inside && is_edge(o, scale, first + k, samples))
                continue;
            o->top = most > o->top ? most : o->top;
            ss_noise_level_add(o->noise, scale, i, level + k, first + k, stretch);
        }
    }
    return 0;
}

/* Let a reason begin with the name of the recording. */
static ss_status
name_it(ss_status st, const ss_reader *reader, ss_error *err)
{
    if (st == SS_OK || err == NULL)
        return st;
    const ss_error why = *err;
    return ss_fail(err, st, "%s: %s", reader->source->name, why.text);
}

/* The mean of the column, or its line of least squares, is found before, as ss_morlet_execute does, in a pass of
 * its own: first + mean + slope (i - middle) is subtracted from sample i. */
static ss_status
read_all(reduction *o, ss_reader *reader, size_t column, ss_detrend detrend, ss_error *err)
{
    size_t n = detrend != SS_DETREND_NONE, piece = ss_reader_piece(reader);
    double *x = malloc(piece * sizeof *x), **wanted = calloc(o->head->n_columns, sizeof *wanted);
    long double first = 0, mean = 0, slope = 0, middle = 0, sum = 0, moment = 0, count = 0;
    ss_status st = x != NULL && wanted != NULL ? SS_OK : ss_fail_memory(err, NULL);
    if (st == SS_OK)
        wanted[column] = x;
    while (st == SS_OK && n > 0) {
        st = ss_reader_rows(reader, wanted, piece, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++, count++) {
            first = count == 0 ? x[i] : first;
            sum += x[i] - first;
            moment += count * (x[i] - first);
        }
    }
    if (count > 0) {
        mean = sum / count;
        middle = (count - 1) / 2;
    }
    if (detrend == SS_DETREND_LINEAR && count > 1)
        slope = (moment - middle * sum) / (count * (count * count - 1) / 12);
    if (st == SS_OK && detrend != SS_DETREND_NONE)
        st = ss_reader_rewind(reader, err);
    n = 1;
    for (long double at = 0; st == SS_OK && n > 0;) {
        st = ss_reader_rows(reader, wanted, piece, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++, at++)
            x[i] = (double)(x[i] - first - mean - slope * (at - middle));
        if (st == SS_OK) {
            ss_extremes_add(&o->samples, x, n);
            st = name_it(ss_stream_push(o->stream, x, n, err), reader, err);
        }
    }
    free(wanted);
    free(x);
    return st == SS_OK ? name_it(ss_stream_end(o->stream, err), reader, err) : st;
}

static ss_status
make_signal(ss_signal **out, const reduction *o, size_t column)
{
    const extremes *r = &o->samples;
    ss_header *head;
    size_t a_block = r->order > 0 ? 2 : 1, blocks = ss_extremes_count(r);
    double pair[2] = { 0, 0 };
    ss_status st = ss_header_select(&head, o->head, &column, 1, 0, NULL);
    if (st != SS_OK)
        return st;
    head->rate = ldexp(o->head->rate * (double)a_block, -r->order);
    st = ss_signal_new(out, head, a_block * blocks, NULL);
    ss_header_free(head);
    for (size_t i = 0; st == SS_OK && i < blocks; i++) {
        ss_extremes_of(r, i, pair[1], pair);
        memcpy((*out)->values + i * a_block, pair, a_block * sizeof *pair);
    }
    return st;
}

/* The coefficients own the gaps from here on.  SS_EDATA: they are of less than two scales. */
static ss_status
make_coefficients(ss_coefficients **out, reduction *o, size_t column)
{
    size_t scales = ss_stream_grid(o->stream)->n_scales, first = 0, total = 0;
    const ss_scale *scale = ss_stream_grid(o->stream)->scale;
    ss_coefficients *c = *out = calloc(1, sizeof *c);
    if (c == NULL)
        return SS_ENOMEM;
    c->n = ss_stream_samples(o->stream);
    c->center = o->opts.center;
    c->gap = o->gap;
    c->n_gaps = o->n_gaps;
    o->gap = NULL;
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
    return ss_coefficients_header(&c->head, o->head, column, c->n, &o->opts, NULL);
}

static ss_status
reduce(ss_overview *v, reduction *o, ss_reader *reader, size_t column, ss_error *err)
{
    ss_detrend detrend = o->opts.detrend;
    o->opts.detrend = SS_DETREND_NONE;
    ss_status st = ss_stream_new(&o->stream, o->head->rate, &o->opts, add_rows, o, err);
    size_t scales = st == SS_OK ? ss_stream_grid(o->stream)->n_scales : 0;
    if (st == SS_OK)
        st = ss_header_gaps(&o->gap, &o->n_gaps, o->head, err);
    int made = st == SS_OK && (o->noise = ss_noise_level_new(scales)) != NULL
        && (o->scale = calloc(scales, sizeof *o->scale)) != NULL && ss_extremes_make(&o->samples, LONG, 1);
    for (size_t i = 0; made && i < scales; i++)
        made = ss_extremes_make(&o->scale[i], LONG, 0);
    if (!made)
        return st == SS_OK ? ss_fail_memory(err, NULL) : st;
    st = read_all(o, reader, column, detrend, err);
    if (st != SS_OK)
        return st;
    v->top = o->top;
    v->noise = ss_noise_level(o->noise, ss_stream_grid(o->stream)->scale);
    st = make_coefficients(&v->coefficients, o, column);
    if (st == SS_EDATA)
        return ss_fail(err, st, "%s: too few samples, %zu: less than two scales have translations outside "
                       "the cone of influence", reader->source->name, ss_stream_samples(o->stream));
    if (st == SS_OK)
        st = make_signal(&v->signal, o, column);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

ss_status
ss_overview_read(ss_overview **out, ss_reader *reader, size_t column, const ss_morlet_opts *opts, ss_error *err)
{
    if (out == NULL || reader == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    reduction o = { .head = ss_reader_header(reader) };
    if (column >= o.head->n_columns)
        return ss_fail_column(err, column, o.head->n_columns);
    ss_status st = ss_morlet_take(&o.opts, opts, err);
    if (st != SS_OK)
        return st;
    ss_overview *v = calloc(1, sizeof *v);
    st = v != NULL ? reduce(v, &o, reader, column, err) : ss_fail_memory(err, NULL);
    for (size_t i = 0; o.scale != NULL && i < ss_stream_grid(o.stream)->n_scales; i++)
        ss_extremes_free(&o.scale[i]);
    free(o.scale);
    ss_extremes_free(&o.samples);
    ss_noise_level_free(o.noise);
    ss_stream_free(o.stream);
    free(o.gap);
    if (st == SS_OK)
        *out = v;
    else
        ss_overview_free(v);
    return st;
}

void
ss_overview_free(ss_overview *v)
{
    if (v == NULL)
        return;
    ss_coefficients_free(v->coefficients);
    ss_signal_free(v->signal);
    free(v);
}
