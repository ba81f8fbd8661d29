/* gaps.c -- samples that are missing from a record: NaN until a value replaces them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "signal/gaps.h"

static const char key[] = "gaps";

/* The value that replaces number k of the missing values [i, j): it lies on the line between their
 * neighbours, left and right. */
static double
between(double left, double right, size_t k, size_t i, size_t j)
{
    double part = (double)(k - i + 1) / (double)(j - i + 1);
    return (1 - part) * left + part * right;
}

/* Replace the missing values [i, j) of the n values x.  At an end of x the only neighbour serves as both. */
static void
fill_run(double *x, size_t i, size_t j, size_t n)
{
    double left = i > 0 ? x[i - 1] : j < n ? x[j] : 0, right = j < n ? x[j] : left;
    for (size_t k = i; k < j; k++)
        x[k] = between(left, right, k, i, j);
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
    int open;                   /* 1: the value that was added last is missing */
    size_t there;               /* the number of values that are not missing */
    double last;                /* the last of these */
};

struct gap_filler {
    ss_gaps how;
    size_t n_columns, row;      /* row: the number of the next row */
    struct runs *column, rows;  /* rows: the rows in which any column lacks its value */
};

gap_filler *
ss_gaps_new(size_t n_columns, ss_gaps how)
{
    gap_filler *g = calloc(1, sizeof *g);
    if (g == NULL || (g->column = calloc(n_columns, sizeof *g->column)) == NULL) {
        free(g);
        return NULL;
    }
    g->how = how;
    g->n_columns = n_columns;
    return g;
}

/* Add the value of a row, which may be missing; 0: no memory. */
static int
add_value(struct runs *r, size_t row, double value)
{
    int missing = isnan(value);
    if (missing && !r->open) {
        struct run *more = ss_list_room(r->run, &r->room, r->n, sizeof *more);
        if (more == NULL)
            return 0;
        r->run = more;
        more[r->n++] = (struct run){ .first = row, .left = r->last };
    }
    if (r->open || missing)
        r->run[r->n - 1].end = row + (size_t)missing;
    if (r->open && !missing) {
        struct run *run = &r->run[r->n - 1];
        run->right = value;
        run->left = run->first > 0 ? run->left : value;
    }
    r->open = missing;
    r->last = missing ? r->last : value;
    r->there += !missing;
    return 1;
}

int
ss_gaps_add(gap_filler *g, double *const column[], size_t n)
{
    for (size_t i = 0; i < n; i++, g->row++) {
        double zero = 0;                        /* NaN if any column lacks its value */
        for (size_t c = 0; c < g->n_columns; c++) {
            double x = column[c][i];
            if (g->how == SS_GAPS_SPLIT)
                g->column[c].there += !isnan(x);
            else if (!add_value(&g->column[c], g->row, x))
                return 0;
            zero = isnan(x) ? x : zero;
        }
        if (!add_value(&g->rows, g->row, zero))
            return 0;
    }
    return 1;
}

/* The gaps as "from:to from:to ...", to be freed.  Each goes from the time of its first missing sample to
 * that of the next sample with a value. */
static char *
spans(const struct runs *r, const ss_header *head)
{
    size_t length = 0;
    char *text = malloc(r->n * (2 * SS_NUMBER_MAX + 2) + 1);
    for (size_t i = 0; text != NULL && i < r->n; i++) {
        if (length > 0)
            text[length++] = ' ';
        length += ss_number_format(text + length, head->start + (double)r->run[i].first / head->rate);
        text[length++] = ':';
        length += ss_number_format(text + length, head->start + (double)r->run[i].end / head->rate);
    }
    if (text != NULL)
        text[length] = '\0';
    return text;
}

void
ss_gaps_rewind(gap_filler *g)
{
    g->row = 0;
    for (size_t c = 0; c < g->n_columns; c++)
        g->column[c].next = 0;
}

ss_status
ss_gaps_begin(gap_filler *g, ss_header *head, const char *name, ss_error *err)
{
    for (size_t c = 0; c < g->n_columns; c++) {
        struct runs *r = &g->column[c];
        if (g->row > 0 && r->there == 0)
            return ss_fail(err, SS_EDATA, "%s: column %s: no numbers", name, head->column[c].name);
        if (r->open)
            r->run[r->n - 1].right = r->last;
    }
    ss_gaps_rewind(g);
    if (g->rows.n == 0)
        return SS_OK;
    char *text = spans(&g->rows, head);
    ss_status st = text != NULL ? ss_header_note(head, key, text) : SS_ENOMEM;
    free(text);
    return st == SS_OK ? st : ss_fail_memory(err, name);
}

int
ss_gaps_fill(gap_filler *g, double *const column[], size_t n)
{
    for (size_t i = 0; i < n; i++, g->row++)
        for (size_t c = 0; c < g->n_columns; c++) {
            if (column[c] == NULL)
                continue;
            double *x = &column[c][i];
            struct runs *r = &g->column[c];
            if (isnan(*x) && g->how == SS_GAPS_SPLIT)
                *x = 0;
            if (!isnan(*x))
                continue;
            while (r->next < r->n && r->run[r->next].end <= g->row)
                r->next++;
            if (r->next == r->n || r->run[r->next].first > g->row)
                return 0;
            const struct run *run = &r->run[r->next];
            *x = between(run->left, run->right, g->row, run->first, run->end);
        }
    return 1;
}

void
ss_gaps_free(gap_filler *g)
{
    if (g == NULL)
        return;
    for (size_t c = 0; c < g->n_columns; c++)
        free(g->column[c].run);
    free(g->column);
    free(g->rows.run);
    free(g);
}

/* --- the note ------------------------------------------------------------------------------ */

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

static int
is_earlier(const void *a, const void *b)
{
    const ss_span *p = a, *q = b;
    return (p->from > q->from) - (p->from < q->from);
}

/* Put spans into the order of time, and join those that overlap. */
static size_t
order(ss_span *span, size_t n)
{
    size_t kept = 0;
    qsort(span, n, sizeof *span, is_earlier);
    for (size_t i = 0; i < n; i++)
        if (kept > 0 && span[i].from < span[kept - 1].to)
            span[kept - 1].to = fmax(span[kept - 1].to, span[i].to);
        else
            span[kept++] = span[i];
    return kept;
}

ss_status
ss_header_gaps(ss_span **out, size_t *n, const ss_header *head)
{
    if (out == NULL || n == NULL || head == NULL)
        return SS_EINVAL;
    const char *text = ss_header_find_note(head, key);
    size_t room = 0;
    *out = NULL;
    *n = 0;
    for (const char *p = text; p != NULL && *p != '\0'; p++)
        room += *p == ':';
    ss_span *span = malloc((room + 1) * sizeof *span);
    if (span == NULL)
        return SS_ENOMEM;
    size_t read = 0;
    for (char *p = (char *)text; p != NULL && *p != '\0'; read++)
        if (read == room || !read_span(&span[read], &p)) {
            free(span);
            return SS_EDATA;
        }
    *n = order(span, read);
    *out = span;
    return SS_OK;
}

ss_status
ss_header_check_gaps(const ss_header *head)
{
    ss_span *span;
    size_t n;
    ss_status st = ss_header_gaps(&span, &n, head);
    free(span);
    return st;
}

int
ss_gaps_near(const ss_span *gap, size_t n, double t, double margin)
{
    if (gap == NULL)
        return 0;
    size_t lo = 0, hi = n;                      /* the last gap that begins before t + margin */
    while (lo < hi) {
        size_t middle = lo + (hi - lo) / 2;
        if (gap[middle].from <= t || gap[middle].from < t + margin)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo > 0 && gap[lo - 1].to > t - margin;
}

/* --- within a record ----------------------------------------------------------------------- */

#define UNEVEN 1e-6             /* error of a time that was rounded to decimal digits, in samples */

ss_status
ss_gaps_of(ss_span **out, size_t *n, const ss_header *head, size_t rows)
{
    ss_status st = ss_header_gaps(out, n, head);
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
        fill_run(x, first, end < n ? end : n, n);
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
