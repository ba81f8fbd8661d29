/* series.c -- reduce a signal of any length to what a picture shows.
 *
 * Over time, a long signal becomes the extremes of blocks, of which each column of pixels has many.
 *
 * Of one column over another, a long line becomes the parts that cross a cell of half a pixel which the line
 * has not crossed before.  The line goes from point to point, each farther than a cell from the one before, so
 * that a line through new cells is not broken.  Lines are four cells wide: a part through cells that were
 * crossed shows nothing new. */
#include "plot/series.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "plot/extremes.h"

enum {
    KEPT = 1 << 20,             /* values over time that are drawn as they are */
    LEAST_KEPT = 4096,          /* of each column, however many there are */
    PATH_KEPT = 1 << 19,        /* rows of one column over another that are drawn as they are */
    CELLS = 2 * SCRIPT_COLUMNS, /* along each axis */
    BLOCK = 8                   /* along each axis of a block */
};

/* --- rows ----------------------------------------------------------------------------------- */

/* Of a number of rows that may be less than 0, or more than there are in any file; NaN: all. */
static size_t
row_number(double row)
{
    return row < 1e18 ? (size_t)fmax(row, 0) : SIZE_MAX;
}

ss_status
ss_series_begin(series *s, ss_reader *reader, const size_t column[], size_t n, const ss_plot_opts *opts,
                ss_error *err)
{
    const ss_header *head = ss_reader_header(reader);
    *s = (series){ .reader = reader, .head = head, .column = column, .n_columns = n };
    for (size_t i = 0; i < n; i++)
        if (column[i] >= head->n_columns)
            return ss_fail_column(err, column[i], head->n_columns);
    s->piece = ss_reader_piece(reader);
    s->first = isnan(opts->from) ? 0 : row_number(floor((opts->from - head->start) * head->rate));
    s->end = row_number(ceil((opts->to - head->start) * head->rate) + 1);
    s->wanted = calloc(head->n_columns, sizeof *s->wanted);
    s->value = malloc(s->piece * n * sizeof *s->value);
    if (s->wanted == NULL || s->value == NULL)
        return ss_fail_memory(err, NULL);
    for (size_t i = n; i-- > 0;)
        s->wanted[column[i]] = s->value + i * s->piece;
    return SS_OK;
}

ss_status
ss_series_next(series *s, size_t *n, ss_error *err)
{
    size_t got = 1;
    for (*n = 0; *n == 0 && got > 0; s->rows += got) {
        ss_status st = ss_reader_rows(s->reader, s->wanted, s->piece, &got, err);
        if (st != SS_OK)
            return st;
        size_t from = s->first > s->rows ? s->first - s->rows : 0, to = s->end > s->rows ? s->end - s->rows : 0;
        to = to < got ? to : got;
        *n = from < to ? to - from : 0;
        s->at = s->rows + from;
        for (size_t c = s->n_columns; c-- > 0;)         /* a column that is drawn twice is read once */
            memmove(s->value + c * s->piece, s->wanted[s->column[c]] + from, *n * sizeof *s->value);
    }
    return SS_OK;
}

ss_status
ss_series_rewind(series *s, ss_error *err)
{
    s->rows = 0;
    return ss_reader_rewind(s->reader, err);
}

void
ss_series_free(series *s)
{
    free(s->wanted);
    free(s->value);
}

/* --- over time ------------------------------------------------------------------------------ */

static ss_status
fill_blocks(extremes block[], series *s, size_t room, ss_error *err)
{
    ss_status st = SS_OK;
    size_t n = 1;
    for (size_t c = 0; c < s->n_columns; c++)
        if (!ss_extremes_make(&block[c], room, 1))
            return ss_fail_memory(err, NULL);
    while (st == SS_OK && n > 0) {
        st = ss_series_next(s, &n, err);
        for (size_t c = 0; st == SS_OK && c < s->n_columns; c++)
            ss_extremes_add(&block[c], s->value + c * s->piece, n);
    }
    return st;
}

/* Make a signal of the blocks: one value of each as long as they have one, then two. */
static ss_status
read_blocks(ss_signal **out, series *s, const extremes block[], ss_error *err)
{
    size_t each = ss_extremes_each(block), n = each * ss_extremes_count(block);
    ss_header *head = NULL;
    ss_status st = ss_header_select(&head, s->head, s->column, s->n_columns, s->first, NULL);
    if (st == SS_OK) {
        head->rate = ldexp((double)each * head->rate, -block->order);
        st = ss_signal_new(out, head, n, NULL);
    }
    for (size_t c = 0; st == SS_OK && c < s->n_columns; c++)
        ss_extremes_give(&block[c], (*out)->values + c * n);
    ss_header_free(head);
    return st == SS_OK ? SS_OK : ss_fail_memory(err, NULL);
}

static ss_status
read_over_time(ss_signal **out, series *s, ss_plot_opts *opts, ss_error *err)
{
    extremes *block = calloc(s->n_columns, sizeof *block);
    size_t room = LEAST_KEPT;
    script_span span;
    while (room * s->head->n_columns < KEPT)
        room *= 2;
    ss_status st = block != NULL ? fill_blocks(block, s, room, err) : ss_fail_memory(err, NULL);
    if (st == SS_OK)
        st = ss_script_find_span(&span, s->head, s->rows, opts, err);
    if (st == SS_OK)
        st = read_blocks(out, s, block, err);
    if (st == SS_OK) {
        opts->from = span.from;
        opts->to = span.to;
    }
    for (size_t c = 0; block != NULL && c < s->n_columns; c++)
        ss_extremes_free(&block[c]);
    free(block);
    return st;
}

/* --- one column over another ---------------------------------------------------------------- */

/* A long line while it is reduced; points are in cells. */
typedef struct canvas {
    script_extent extent[2];    /* of the values */
    unsigned char *crossed;     /* 1 for each cell that was */
    unsigned char *in_block;    /* the number of these in each block */
    int goes_on;                /* from the point before? */
    double last[2], before[2];  /* then, its last two points */
    int was_new;                /* did the part between them cross new ones? */
    int is_kept;                /* is that part kept? */
    double *point;              /* those that are kept: x, y, x, y, ... */
    size_t n, room;
    FILE *gaps;                 /* the text of a note */
} canvas;

/* Cross all cells from one to another; 1: one of them is new.  In a full block three of four are passed over:
 * what is then not seen of another block is shorter than lines are wide. */
static int
cross(canvas *v, const double from[2], const double to[2])
{
    const double unit = 65536;          /* of a cell */
    int steps = (int)ceil(fmax(fabs(to[0] - from[0]), fabs(to[1] - from[1]))), new = 0;
    long x = (long)(from[0] * unit), dx = steps > 0 ? (long)((to[0] - from[0]) * unit / steps) : 0;
    long y = (long)(from[1] * unit), dy = steps > 0 ? (long)((to[1] - from[1]) * unit / steps) : 0;
    for (int i = 0, step; i <= steps; i += step, x += step * dx, y += step * dy) {
        long column = x >> 16, row = y >> 16;
        unsigned char *in_block = &v->in_block[row / BLOCK * (CELLS / BLOCK) + column / BLOCK];
        unsigned char *cell = &v->crossed[row * CELLS + column];
        step = *in_block == BLOCK * BLOCK ? 4 : 1;
        if (step > 1 || *cell)
            continue;
        *cell = 1;
        ++*in_block;
        new = 1;
    }
    return new;
}

static ss_status
keep(canvas *v, const double cell[2])
{
    double *more = ss_list_grow(v->point, &v->room, 2 * v->n + 2, sizeof *more);
    if (more == NULL)
        return SS_ENOMEM;
    v->point = more;
    for (int i = 0; i < 2; i++)
        more[2 * v->n + i] = v->extent[i].lo + cell[i] * ((v->extent[i].hi - v->extent[i].lo) / (CELLS - 1));
    v->n++;
    return SS_OK;
}

/* Keep the part from the last point of the line to this one, if it crosses new cells or is next to one that
 * does, so that the ends of parts are not seen.  Between parts stands a point that is a gap. */
static ss_status
add_part(canvas *v, const double cell[2])
{
    int is_new = cross(v, v->last, cell), begins = (is_new || v->was_new) && !v->is_kept;
    ss_status st = SS_OK;
    if (begins && v->n > 0) {
        ss_print(v->gaps, "%s%zu:%zu", ftell(v->gaps) > 0 ? " " : "", v->n, v->n + 1);
        st = keep(v, v->last);
    }
    if (begins && st == SS_OK)
        st = keep(v, v->before);
    if (begins && st == SS_OK)
        st = keep(v, v->last);
    v->is_kept = is_new || v->was_new;
    v->was_new = is_new;
    return st == SS_OK && v->is_kept ? keep(v, cell) : st;
}

static ss_status
add_point(canvas *v, const double at[2])
{
    double cell[2];
    for (int i = 0; i < 2; i++) {
        double range = v->extent[i].hi - v->extent[i].lo;
        cell[i] = range > 0 ? (at[i] - v->extent[i].lo) / range * (CELLS - 1) : 0;
    }
    if (!v->goes_on) {
        memcpy(v->before, cell, sizeof cell);
        memcpy(v->last, cell, sizeof cell);
        v->is_kept = v->was_new = 0;
    } else if (fabs(cell[0] - v->last[0]) <= 1 && fabs(cell[1] - v->last[1]) <= 1) {
        return SS_OK;
    }
    ss_status st = add_part(v, cell);
    memcpy(v->before, v->last, sizeof cell);
    memcpy(v->last, cell, sizeof cell);
    v->goes_on = 1;
    return st;
}

/* The columns that are drawn over one another: x and y, or only one over itself. */
static const double *
ordinate(const series *s)
{
    return s->value + (s->n_columns - 1) * s->piece;
}

/* Reduce all rows; the points that are left are on a clock of their own. */
static ss_status
read_long_path(ss_signal **out, series *s, canvas *v, const script_span *all, ss_error *err)
{
    ss_header *head = NULL;
    char *text = NULL;
    size_t length, n = 1;
    v->crossed = calloc((size_t)CELLS * CELLS, 1);
    v->in_block = calloc((size_t)CELLS / BLOCK * CELLS / BLOCK, 1);
    v->gaps = open_memstream(&text, &length);
    ss_status st = v->crossed != NULL && v->in_block != NULL && v->gaps != NULL ? SS_OK : SS_ENOMEM;
    while (st == SS_OK && n > 0) {
        st = ss_series_next(s, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++)
            if (ss_script_is_missing(all, s->at + i))
                v->goes_on = 0;
            else
                st = add_point(v, (const double[2]){ s->value[i], ordinate(s)[i] });
    }
    if (v->gaps != NULL && fclose(v->gaps) != 0)
        st = SS_ENOMEM;
    if (st == SS_OK)
        st = ss_header_select(&head, s->head, s->column, s->n_columns, 0, NULL);
    if (st == SS_OK) {
        head->start = 0;
        head->rate = 1;
        st = ss_header_note(head, "gaps", text, NULL);
    }
    if (st == SS_OK)
        st = ss_signal_new(out, head, v->n, NULL);
    for (size_t k = 0; st == SS_OK && k < s->n_columns * v->n; k++)
        (*out)->values[k] = v->point[2 * (k % v->n) + k / v->n];
    ss_header_free(head);
    free(text);
    free(v->crossed);
    free(v->in_block);
    free(v->point);
    return st;
}

static ss_status
read_short_path(ss_signal **out, series *s, size_t rows, ss_error *err)
{
    ss_header *head = NULL;
    ss_status st = ss_header_select(&head, s->head, s->column, s->n_columns, s->first, NULL);
    if (st == SS_OK)
        st = ss_signal_new(out, head, rows, NULL);
    for (size_t n = 1; st == SS_OK && n > 0;) {
        st = ss_series_next(s, &n, err);
        for (size_t c = 0; st == SS_OK && n > 0 && c < s->n_columns; c++)
            memcpy((*out)->values + c * rows + (s->at - s->first), s->value + c * s->piece, n * sizeof *s->value);
    }
    ss_header_free(head);
    return st;
}

/* Read twice: first for the extents, which cells need. */
static ss_status
read_path(ss_signal **out, series *s, const ss_plot_opts *opts, ss_error *err)
{
    canvas v = { .extent = { SCRIPT_NO_EXTENT, SCRIPT_NO_EXTENT } };
    script_span span, all = { .start = s->head->start, .rate = s->head->rate };
    ss_status st = ss_header_gaps(&all.gap, &all.n_gaps, s->head, NULL);
    if (st == SS_OK)
        st = ss_series_rewind(s, err);
    for (size_t n = 1; st == SS_OK && n > 0;) {
        st = ss_series_next(s, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++)
            if (!ss_script_is_missing(&all, s->at + i)) {
                ss_script_include(&v.extent[0], s->value[i]);
                ss_script_include(&v.extent[1], ordinate(s)[i]);
            }
    }
    if (st == SS_OK)
        st = ss_script_find_span(&span, s->head, s->rows, opts, err);
    int any = v.extent[0].lo <= v.extent[0].hi;
    for (size_t c = 0; st == SS_OK && any && c < 2; c++)
        st = ss_script_check(s->head->column[s->column[c % s->n_columns]].name,
                             (const double[]){ v.extent[c].lo, v.extent[c].hi }, 2, err);
    if (st == SS_OK)
        st = ss_series_rewind(s, err);
    if (st == SS_OK)
        st = any && span.n > PATH_KEPT ? read_long_path(out, s, &v, &all, err)
            : read_short_path(out, s, span.n, err);
    free(all.gap);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

ss_status
ss_plot_read(ss_signal **out, ss_reader *reader, const size_t column[], size_t n, ss_plot_opts *opts,
             ss_error *err)
{
    series s;
    if (out == NULL || reader == NULL || column == NULL || opts == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    if (n == 0 || (opts->xy && n > 2))
        return ss_fail(err, SS_EINVAL, "%zu columns cannot be drawn", n);
    ss_status st = ss_series_begin(&s, reader, column, n, opts, err);
    if (st == SS_OK)
        st = opts->xy ? read_path(out, &s, opts, err) : read_over_time(out, &s, opts, err);
    if (st == SS_OK && opts->xy)
        opts->from = opts->to = NAN;
    opts->rows = s.rows;
    ss_series_free(&s);
    return st;
}
