/* gaps.c -- samples that are missing from a record: NaN until a value replaces them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/gaps.h"

static const char key[] = "gaps";

/* Replace a run of missing values, [i, j) of n that are a row apart. */
static void
fill_run(double *x, size_t row, size_t i, size_t j, size_t n, ss_gaps how)
{
    double left = i > 0 ? x[(i - 1) * row] : j < n ? x[j * row] : 0;
    double right = j < n ? x[j * row] : left;
    for (size_t k = i; k < j; k++) {
        double part = (double)(k - i + 1) / (double)(j - i + 1);
        x[k * row] = how == SS_GAPS_SPLIT ? 0 : (1 - part) * left + part * right;
    }
}

/* Fill one column, and mark the rows; returns the number of values present. */
static size_t
fill_column(double *x, size_t row, size_t n, ss_gaps how, char *missing)
{
    size_t there = 0;
    for (size_t i = 0, j; i < n; i = j + 1) {
        for (j = i; j < n && isnan(x[j * row]); j++)
            missing[j] = 1;
        if (j > i)
            fill_run(x, row, i, j, n, how);
        there += j < n;
    }
    return there;
}

/* "from:to from:to ...", to be freed: from the first missing sample to the next one present. */
static char *
spans(const char *missing, size_t n, const ss_header *head)
{
    size_t room = 1, length = 0;
    for (size_t i = 0; i < n; i++)
        room += (missing[i] && (i == 0 || !missing[i - 1])) * (2 * SS_NUMBER_MAX + 2);
    char *text = malloc(room);
    for (size_t i = 0, j; text != NULL && i < n; i = j + 1) {
        for (j = i; j < n && missing[j]; j++)
            ;
        if (j == i)
            continue;
        if (length > 0)
            text[length++] = ' ';
        length += ss_number_format(text + length, head->start + (double)i / head->rate);
        text[length++] = ':';
        length += ss_number_format(text + length, head->start + (double)j / head->rate);
    }
    if (text != NULL)
        text[length] = '\0';
    return text;
}

ss_status
ss_fill_gaps(double *x, size_t n, size_t row, size_t column, ss_header *head, ss_gaps how,
             const char *name, ss_error *err)
{
    char *missing = calloc(n + 1, 1), *text = NULL;
    ss_status st = missing != NULL ? SS_OK : SS_ENOMEM;
    for (size_t c = 0; st == SS_OK && c < head->n_columns; c++)
        if (fill_column(x + c * column, row, n, how, missing) == 0 && n > 0)
            st = ss_fail(err, SS_EDATA, "%s: column %s: no numbers", name, head->column[c].name);
    if (st == SS_OK && memchr(missing, 1, n) != NULL) {
        text = spans(missing, n, head);
        st = text != NULL ? ss_header_note(head, key, text) : SS_ENOMEM;
    }
    free(text);
    free(missing);
    return st == SS_ENOMEM ? ss_fail_memory(err, name) : st;
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
    *out = malloc((room + 1) * sizeof **out);
    if (*out == NULL)
        return SS_ENOMEM;
    for (char *p = (char *)text; p != NULL && *p != '\0' && *n < room; ++*n) {
        ss_span *span = *out + *n;
        char *end;
        span->from = ss_number_parse(p, &end);
        if (end == p || *end != ':')
            break;
        span->to = ss_number_parse(end + 1, &p);
        if (p == end + 1 || (*p != ' ' && *p != '\0') || !(span->from < span->to))
            break;
        p += *p == ' ';
    }
    return SS_OK;
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

#define UNEVEN 1e-6             /* of a sample: the rounding of a time to decimal digits */

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
        fill_run(x, 1, first, end < n ? end : n, n, SS_GAPS_INTERPOLATE);
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
