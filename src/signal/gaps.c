/* gaps.c -- samples that are missing from a record: NaN until a value replaces them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "signal/gaps.h"
#include "signal/header.h"

static const char key[] = "gaps";

/* The value that replaces number k of the missing values [i, j): it lies on the line between their
 * neighbours, left and right. */
static double
between(double left, double right, size_t k, size_t i, size_t j)
{
    double part = (double)(k - i + 1) / (double)(j - i + 1);
    return (1 - part) * left + part * right;
}

/* --- rows that are read twice -------------------------------------------------------------- */

/* The rows [first, end) of one column have no value; left and right are the values beside them. */
struct run {
    size_t first, end;
    double left, right;
};

struct runs {
    struct run *run;
    size_t n, room, next;
    size_t there;               /* the number of values that are not missing */
    double last;                /* the last of these */
};

struct filled {
    ss_source base;
    ss_gaps how;
    struct runs *column, rows;  /* rows: the rows in which any column lacks its value */
};

/* Add the value of a row, which may be missing; 0: no memory. */
static int
add_value(struct runs *r, size_t row, double value)
{
    struct run *run = r->n > 0 && r->run[r->n - 1].end == row ? &r->run[r->n - 1] : NULL;
    if (!isnan(value)) {
        if (run != NULL)
            *run = (struct run){ run->first, row, run->first > 0 ? run->left : value, value };
        r->last = value;
        r->there++;
        return 1;
    }
    if (run == NULL) {
        struct run *more = ss_list_room(r->run, &r->room, r->n, sizeof *more);
        if (more == NULL)
            return 0;
        r->run = more;
        run = &more[r->n++];
        *run = (struct run){ row, row, r->last, r->last };
    }
    run->end = row + 1;
    return 1;
}

/* Note the gaps as "from:to from:to ...".  Each goes from the time of its first missing sample to that of the
 * next sample with a value. */
static ss_status
note_runs(const struct runs *r, ss_header *head)
{
    ss_span *span = malloc((r->n + 1) * sizeof *span);
    for (size_t i = 0; span != NULL && i < r->n; i++)
        span[i] = (ss_span){ head->start + (double)r->run[i].first / head->rate,
                             head->start + (double)r->run[i].end / head->rate };
    ss_status st = span != NULL ? ss_header_note_gaps(head, span, r->n) : SS_ENOMEM;
    free(span);
    return st;
}

static void
rewind_filled(ss_source *s)
{
    for (size_t c = 0; c < s->head->n_columns; c++)
        ((struct filled *)s)->column[c].next = 0;
}

static ss_status
give_filled(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct filled *g = (struct filled *)s;
    ss_status st = ss_source_rows(s->inner, column, max, n, err);
    for (size_t c = 0; st == SS_OK && c < s->head->n_columns; c++) {
        struct runs *r = &g->column[c];
        for (size_t i = 0; column[c] != NULL && i < *n; i++) {
            size_t row = (size_t)s->row + i;
            double *x = &column[c][i];
            if (!isnan(*x))
                continue;
            while (g->how != SS_GAPS_SPLIT && r->next < r->n && r->run[r->next].end <= row)
                r->next++;
            const struct run *run = r->next < r->n && r->run[r->next].first <= row ? &r->run[r->next] : NULL;
            if (g->how != SS_GAPS_SPLIT && run == NULL)
                return ss_fail(err, SS_EDATA, "%s: the rows have changed while they were read", s->name);
            *x = run != NULL ? between(run->left, run->right, row, run->first, run->end) : 0;
        }
    }
    s->row += *n;
    return st;
}

static void
free_filled(ss_source *s)
{
    struct filled *g = (struct filled *)s;
    for (size_t c = 0; g->column != NULL && c < s->head->n_columns; c++)
        free(g->column[c].run);
    free(g->column);
    free(g->rows.run);
}

ss_status
ss_source_fill_gaps(ss_source **s, ss_gaps how, ss_error *err)
{
    static const struct source_calls calls = { .next = give_filled, .rewind = rewind_filled, .free = free_filled };
    size_t columns = (*s)->head->n_columns, piece = ss_source_piece(*s), n = 1;
    struct filled *g = ss_source_wrap(s, sizeof *g, &calls, err);
    if (g == NULL)
        return SS_ENOMEM;
    double **column = ss_columns_new(columns, piece);
    g->how = how;
    g->base.stamped = g->base.inner->stamped;
    g->column = calloc(columns, sizeof *g->column);
    ss_status st = column != NULL && g->column != NULL ? SS_OK : ss_fail_memory(err, g->base.name);
    while (st == SS_OK && n > 0) {
        st = ss_source_rows(g->base.inner, column, piece, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++, g->base.row++) {
            double zero = 0;                    /* NaN if any column lacks its value */
            int added = 1;
            for (size_t c = 0; c < columns; c++) {
                double x = column[c][i];
                if (how == SS_GAPS_SPLIT)
                    g->column[c].there += !isnan(x);
                else
                    added &= add_value(&g->column[c], (size_t)g->base.row, x);
                zero = isnan(x) ? x : zero;
            }
            if (!added || !add_value(&g->rows, (size_t)g->base.row, zero))
                st = ss_fail_memory(err, g->base.name);
        }
    }
    free(column);
    for (size_t c = 0; st == SS_OK && c < columns; c++)
        if (g->base.row > 0 && g->column[c].there == 0)
            st = ss_fail(err, SS_EDATA, "%s: column %s: no numbers", g->base.name, g->base.head->column[c].name);
    if (st == SS_OK && note_runs(&g->rows, g->base.head) != SS_OK)
        st = ss_fail_memory(err, g->base.name);
    return st == SS_OK ? ss_source_rewind(&g->base, err) : st;
}

/* --- the note ------------------------------------------------------------------------------ */

ss_status
ss_header_note_gaps(ss_header *head, const ss_span *span, size_t n)
{
    char from[SS_NUMBER_MAX], to[SS_NUMBER_MAX], *text = NULL;
    size_t size;
    FILE *out = n > 0 ? open_memstream(&text, &size) : NULL;
    for (size_t i = 0; out != NULL && i < n; i++) {
        ss_number_format(from, span[i].from);
        ss_number_format(to, span[i].to);
        fprintf(out, "%s%s:%s", i > 0 ? " " : "", from, to);
    }
    ss_status st = n == 0 ? SS_OK
        : out != NULL && fclose(out) == 0 ? ss_header_note(head, key, text, NULL) : SS_ENOMEM;
    free(text);
    return st;
}

/* Read "from:to" and the blanks behind it; 0: it is no span. */
static int
read_span(ss_span *span, char **p)
{
    char *colon, *end;
    span->from = ss_number_parse(*p, &colon);
    if (colon == *p || *colon != ':')
        return 0;
    span->to = ss_number_parse(colon + 1, &end);
    if (end == colon + 1 || (*end != ' ' && *end != '\0'))
        return 0;
    *p = end + strspn(end, " ");
    return isfinite(span->from) && isfinite(span->to) && span->from < span->to;
}

ss_status
ss_header_gaps(ss_span **out, size_t *n, const ss_header *head, ss_error *err)
{
    const char *text = ss_header_find_note(head, key);
    size_t room = 0;
    *out = NULL;
    *n = 0;
    for (const char *p = text; p != NULL && *p != '\0'; p++)
        room += *p == ':';
    ss_span *span = malloc((room + 1) * sizeof *span);
    if (span == NULL)
        return ss_fail_memory(err, NULL);
    size_t read = 0;
    for (char *p = (char *)text; p != NULL && *p != '\0'; read++)
        if (read == room || !read_span(&span[read], &p)) {
            free(span);
            return ss_fail(err, SS_EDATA, WRONG_GAPS);
        }
    qsort(span, read, sizeof *span, ss_ascending);
    for (size_t i = 0; i < read; i++)           /* join those that overlap */
        if (*n > 0 && span[i].from < span[*n - 1].to)
            span[*n - 1].to = fmax(span[*n - 1].to, span[i].to);
        else
            span[(*n)++] = span[i];
    *out = span;
    return SS_OK;
}

ss_status
ss_header_check_gaps(const ss_header *head)
{
    ss_span *span;
    size_t n;
    ss_status st = ss_header_gaps(&span, &n, head, NULL);
    free(span);
    return st;
}

int
ss_gaps_near(const ss_span *gap, size_t n, double t, double margin)
{
    if (gap == NULL)
        return 0;
    /* behind the last gap that begins at t or before t + margin */
    size_t behind = ss_list_from(gap, n, sizeof *gap, fmax(t + margin, nextafter(t, INFINITY)));
    return behind > 0 && gap[behind - 1].to > t - margin;
}

/* --- within a record ----------------------------------------------------------------------- */

#define UNEVEN 1e-6             /* error of a time that was rounded to decimal digits, in samples */

ss_status
ss_gaps_of(ss_span **out, size_t *n, const ss_header *head, size_t rows)
{
    ss_status st = ss_header_gaps(out, n, head, NULL);
    size_t kept = 0;
    for (size_t i = 0; st == SS_OK && i < *n; i++) {
        double from = floor(((*out)[i].from - head->start) * head->rate + UNEVEN);
        double to = ceil(((*out)[i].to - head->start) * head->rate - UNEVEN);
        from = fmax(from, 0);
        to = fmin(to, (double)rows);
        if (from < to)
            (*out)[kept++] = (ss_span){ from / head->rate, to / head->rate };
    }
    if (st == SS_OK)
        *n = kept;
    return st;
}

void
ss_gap_rows(const ss_span *gap, double rate, size_t *first, size_t *end)
{
    *first = (size_t)(gap->from * rate + 0.5);
    *end = (size_t)(gap->to * rate + 0.5);
}

void
ss_gaps_bridge(double *x, size_t n, double rate, const ss_span *gap, size_t n_gaps)
{
    for (size_t g = 0; g < n_gaps; g++) {
        size_t first, end;
        ss_gap_rows(&gap[g], rate, &first, &end);
        end = end < n ? end : n;
        double left = first > 0 ? x[first - 1] : end < n ? x[end] : 0, right = end < n ? x[end] : left;
        for (size_t k = first; k < end; k++)
            x[k] = between(left, right, k, first, end);
    }
}

ss_status
ss_gaps_missing(char **out, const ss_signal *signal)
{
    ss_span *gap = NULL;
    size_t n_gaps, n = signal->n;
    ss_status st = ss_gaps_of(&gap, &n_gaps, signal->head, n);
    *out = NULL;
    if (st == SS_OK && n_gaps > 0 && (*out = calloc(n, 1)) == NULL)
        st = SS_ENOMEM;
    for (size_t g = 0; st == SS_OK && g < n_gaps; g++) {
        size_t first, end;
        ss_gap_rows(&gap[g], signal->head->rate, &first, &end);
        memset(*out + first, 1, end - first);
    }
    free(gap);
    return st;
}
