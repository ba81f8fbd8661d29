/* series.c -- read what a picture shows of a signal of any length, and reduce it over time. */
#include "plot/series.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/gaps.h"

/* Of a number of rows that may be less than 0, or more than there are in any file; NaN: all. */
static size_t
row_number(double row)
{
    return row < 1e18 ? (size_t)fmax(row, 0) : SIZE_MAX;
}

ss_status
ss_series_begin(series *s, ss_reader *reader, const size_t column[], size_t n, double start,
                const ss_plot_opts *opts, ss_error *err)
{
    const ss_header *head = ss_reader_header(reader);
    *s = (series){ .reader = reader, .head = head, .column = column, .n_columns = n };
    for (size_t i = 0; i < n; i++)
        if (column[i] >= head->n_columns)
            return ss_fail_column(err, column[i], head->n_columns);
    s->start = isnan(start) ? head->start : start;
    s->piece = ss_reader_piece(reader);
    s->first = isnan(opts->from) ? 0 : row_number(floor((opts->from - s->start) * head->rate));
    s->end = row_number(ceil((opts->to - s->start) * head->rate) + 1);
    s->wanted = calloc(head->n_columns, sizeof *s->wanted);
    s->value = malloc(s->piece * n * sizeof *s->value);
    if (s->wanted == NULL || s->value == NULL)
        return ss_fail_memory(err, NULL);
    for (size_t i = n; i-- > 0;)
        s->wanted[column[i]] = s->value + i * s->piece;
    return ss_header_gaps(&s->gap, &s->n_gaps, head, err);
}

ss_status
ss_series_next(series *s, size_t *n, ss_error *err)
{
    size_t got = 1, from = 0;
    for (*n = 0; *n == 0 && got > 0; s->rows += got) {
        ss_status st = ss_reader_rows(s->reader, s->wanted, s->piece, &got, err);
        if (st != SS_OK)
            return st;
        size_t to = s->end > s->rows ? s->end - s->rows : 0;
        from = s->first > s->rows ? s->first - s->rows : 0;
        to = to < got ? to : got;
        *n = from < to ? to - from : 0;
    }
    for (size_t c = s->n_columns; c-- > 0;) {           /* a column that is drawn twice is read once */
        double *x = s->value + c * s->piece;
        memmove(x, s->wanted[s->column[c]] + from, *n * sizeof *x);
        for (size_t i = 0; i < *n; i++)         /* a quarter of an interval later: times of gaps are rounded */
            if (s->n_gaps > 0 && ss_gaps_near(s->gap, s->n_gaps, s->head->start
                                              + ((double)(s->rows - got + from + i) + 0.25) / s->head->rate, 0))
                x[i] = NAN;
            else if (!isfinite(x[i]))
                return ss_fail(err, SS_EINVAL, "%s cannot be drawn: a value is not finite",
                               s->head->column[s->column[c]].name);
    }
    return SS_OK;
}

ss_status
ss_series_check(const ss_column *column, script_extent e, const script_span *span, ss_error *err)
{
    return e.lo <= e.hi ? ss_script_check(column->name, e, err)
        : ss_fail(err, SS_EINVAL, "nothing to draw: all samples from %.9g s to %.9g s are missing", span->from,
                  span->to);
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
    free(s->gap);
    free(s->wanted);
    free(s->value);
}

ss_status
ss_layers_find(layer l[LAYERS], const ss_header *head, const size_t drawn[], size_t n, const ss_plot_opts *opts,
               ss_error *err)
{
    for (size_t k = 0; k <= opts->n_over; k++, l++) {
        l->column = calloc(n, sizeof *l->column);
        l->panel = calloc(n, sizeof *l->panel);
        if (l->column == NULL || l->panel == NULL)
            return ss_fail_memory(err, NULL);
        for (size_t i = 0; i < n && (k == 0 || opts->alike); i++) {
            size_t c = drawn != NULL ? drawn[i] : i;
            if (c >= head->n_columns)
                return ss_fail_column(err, c, head->n_columns);
            int same = k == 0 ? (int)c
                : ss_header_column(ss_reader_header(opts->over[k - 1]), head->column[c].name);
            if (same >= 0) {
                l->column[l->n] = (size_t)same;
                l->panel[l->n++] = i;
            }
        }
        l->n += l->n == 0;                      /* the first column over the first panel */
    }
    return SS_OK;
}

void
ss_layers_free(layer l[LAYERS])
{
    for (size_t k = 0; k < LAYERS; k++) {
        free(l[k].column);
        free(l[k].panel);
    }
}

void
ss_layer_name(char name[40], size_t k, size_t panel, int first)
{
    int n = k == 0 ? snprintf(name, 40, "$panel%zu", panel + 1)
        : snprintf(name, 40, "$over%s", ss_script_number[k - 1]);
    if (k > 0 && panel >= (size_t)first)
        snprintf(name + n, 40 - (size_t)n, "_panel%zu", panel + 1);
}

void
ss_layers_plot(FILE *out, const layer l[], const ss_plot_opts *opts, size_t panel, int first, const char *before,
               const char *by)
{
    int titled = panel == 0 && opts->n_over > 0;
    ss_print(out, "plot %s$panel%zu using 1:2 with %s lw 1 lc rgb colour%s", before, panel + 1, by,
             titled ? " title name" : "");
    for (size_t k = 1; k <= opts->n_over; k++) {
        char name[60] = "NaN";                          /* an entry of the legend */
        for (size_t m = 0; m < l[k].n; m++)
            if (l[k].panel[m] == panel) {
                ss_layer_name(name, k, panel, first);
                strcat(name, " using 1:2");
            }
        if (titled || name[0] == '$')
            ss_script_write_over(out, k - 1, name, titled);
    }
    fputs(titled ? "\nunset key\n" : "\n", out);
}

int
ss_extremes_make(extremes *b, size_t room, int both)
{
    *b = (extremes){ .room = room, .most = malloc(room * sizeof *b->most) };
    b->least = both ? malloc(room * sizeof *b->least) : NULL;
    return b->most != NULL && (!both || b->least != NULL);
}

void
ss_extremes_free(extremes *b)
{
    free(b->most);
    free(b->least);
}

size_t
ss_extremes_next(extremes *b, size_t n, size_t *i)
{
    if (b->n >> b->order == b->room) {
        for (size_t k = 0; k < b->room / 2; k++) {
            b->most[k] = fmax(b->most[2 * k], b->most[2 * k + 1]);
            if (b->least != NULL)
                b->least[k] = fmin(b->least[2 * k], b->least[2 * k + 1]);
        }
        b->order++;
    }
    *i = b->n >> b->order;
    if (b->n == *i << b->order) {
        b->most[*i] = -INFINITY;
        if (b->least != NULL)
            b->least[*i] = INFINITY;
    }
    size_t room = ((*i + 1) << b->order) - b->n;
    return room < n ? room : n;
}

void
ss_extremes_add(extremes *b, const double *x, size_t n)
{
    for (size_t m, i; n > 0; n -= m, x += m, b->n += m) {
        m = ss_extremes_next(b, n, &i);
        double least = b->least[i], most = b->most[i];
        for (size_t k = 0; k < m; k++) {
            least = x[k] < least ? x[k] : least;
            most = x[k] > most ? x[k] : most;
        }
        b->least[i] = least;
        b->most[i] = most;
    }
}

size_t
ss_extremes_count(const extremes *b)
{
    return (b->n + ((size_t)1 << b->order) - 1) >> b->order;
}

size_t
ss_extremes_of(const extremes *b, size_t i, double x, double pair[2])
{
    int falls = b->most[i] - x < x - b->least[i];
    pair[0] = falls ? b->most[i] : b->least[i];
    pair[1] = falls ? b->least[i] : b->most[i];
    return b->least[i] < b->most[i] ? 2 : b->least[i] == b->most[i];
}

ss_status
ss_trace_end(trace *t, const series *s, const script_span *span, ss_error *err)
{
    script_extent e = SCRIPT_NO_EXTENT;
    for (size_t i = 0; i < ss_extremes_count(&t->block); i++)
        ss_script_widen(&e, (script_extent){ t->block.least[i], t->block.most[i] });
    t->from = s->start + (double)s->first / s->head->rate;
    t->step = 1 / s->head->rate;
    t->y = ss_script_axis(t->y.column, e);
    return ss_series_check(t->y.column, e, span, err);
}

ss_status
ss_traces_read(trace t[], script_span *span, ss_reader *reader, const size_t column[], size_t n, double start,
               const ss_plot_opts *opts, ss_error *err)
{
    series s;
    size_t got = 1;
    memset(t, 0, n * sizeof *t);
    ss_status st = ss_series_begin(&s, reader, column, n, start, opts, err);
    for (size_t c = 0; st == SS_OK && c < n; c++) {
        t[c].y.column = &s.head->column[column[c]];
        st = ss_extremes_make(&t[c].block, BLOCKS, 1) ? SS_OK : ss_fail_memory(err, NULL);
    }
    while (st == SS_OK && got > 0) {
        st = ss_series_next(&s, &got, err);
        for (size_t c = 0; st == SS_OK && c < n; c++)
            ss_extremes_add(&t[c].block, s.value + c * s.piece, got);
    }
    if (st == SS_OK)
        st = ss_script_find_span(span, s.start, s.head->rate, s.rows, opts, err);
    for (size_t c = 0; st == SS_OK && c < n; c++)
        st = ss_trace_end(&t[c], &s, span, err);
    ss_series_free(&s);
    return st;
}

void
ss_traces_free(trace t[], size_t n)
{
    for (size_t c = 0; c < n; c++)
        ss_extremes_free(&t[c].block);
}

void
ss_trace_write(FILE *out, const char *name, const trace *t)
{
    size_t blocks = ss_extremes_count(&t->block), of_block = 1, before = 1;
    double step = ldexp(t->step, t->block.order), pair[2] = { 0, 0 };
    script_extent e = ss_script_scaled_extent(t->y.extent, t->y.scale);
    int decimals[2] = { ss_script_decimals(step * (double)blocks), ss_script_decimals(e.hi - e.lo) };
    ss_print(out, "%s << EOD\n", name);
    for (size_t i = 0; i < blocks; i++, before = of_block) {
        of_block = ss_extremes_of(&t->block, i, pair[1], pair);
        if (of_block == 0 && before > 0)
            putc('\n', out);
        for (size_t k = 0; k < of_block; k++) {
            ss_script_write(out, t->from + step * ((double)i + (double)k / (double)of_block), decimals[0], " ");
            ss_script_write(out, ss_script_scaled(pair[k], t->y.scale), decimals[1], "\n");
        }
    }
    fputs("EOD\n", out);
}
