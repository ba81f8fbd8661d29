/* source.c -- what all sources of rows have in common, and a whole signal in memory. */
#include "signal/source.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"

/* A source with a copy of this header. */
static void *
make(size_t size, const struct source_calls *calls, const char *name, const ss_header *of, ss_error *err)
{
    ss_source *s = calloc(1, size);
    ss_header *head = NULL;
    char *copy = strdup(name);
    if (s == NULL || copy == NULL || ss_header_select(&head, of, NULL, of->n_columns, 0, NULL) != SS_OK) {
        free(s);
        free(copy);
        ss_header_free(head);
        ss_fail_memory(err, name);
        return NULL;
    }
    *s = (ss_source){ .calls = calls, .name = copy, .head = head, .length = UINT64_MAX,
                    .rewinds = calls->rewind != NULL };
    return s;
}

void *
ss_source_new(size_t size, const struct source_calls *calls, const char *name, ss_error *err)
{
    return make(size, calls, name, &(ss_header){ .has_time = 1 }, err);
}

void *
ss_source_wrap(ss_source **s, size_t size, const struct source_calls *calls, ss_error *err)
{
    ss_source *outer = make(size, calls, (*s)->name, (*s)->head, err);
    if (outer == NULL)
        return NULL;
    outer->length = (*s)->length;
    outer->rewinds = (*s)->rewinds;
    outer->inner = *s;
    return *s = outer;
}

void
ss_source_unwrap(ss_source **s)
{
    ss_source *outer = *s;
    *s = outer->inner;
    outer->inner = NULL;
    ss_source_free(outer);
}

void
ss_source_free(ss_source *s)
{
    while (s != NULL) {
        ss_source *inner = s->inner;
        if (s->calls->free != NULL)
            s->calls->free(s);
        free(s->name);
        ss_header_free(s->head);
        free(s);
        s = inner;
    }
}

ss_status
ss_source_rows(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    *n = 0;
    ss_status st = s->given < s->held || s->calls->next == NULL ? SS_OK : s->calls->next(s, column, max, n, err);
    size_t left = s->held - s->given;
    if (st != SS_OK || s->held == 0)
        return st;
    *n = left < max ? left : max;
    for (size_t c = 0; c < s->head->n_columns; c++)
        if (column[c] != NULL)
            memcpy(column[c], s->made + c * s->apart + s->given, *n * sizeof *column[c]);
    s->given += *n;
    return SS_OK;
}

ss_status
ss_source_rewind(ss_source *s, ss_error *err)
{
    if (!s->rewinds)
        return ss_fail(err, SS_EINVAL, "%s: its rows are not kept to be read again", s->name);
    for (; s != NULL && s->rewinds; s = s->inner) {
        s->held = s->given = 0;
        s->row = 0;
        if (s->calls->rewind != NULL)
            s->calls->rewind(s);
    }
    return SS_OK;
}

int
ss_source_has_rows(const ss_source *s)
{
    for (; s != NULL; s = s->inner)
        if (s->given < s->held || (s->calls->left != NULL && s->calls->left(s)))
            return 1;
    return 0;
}

size_t
ss_source_piece(const ss_source *s)
{
    enum { ROWS = 4096, VALUES = 1 << 16 };
    size_t rows = s->head->n_columns > 0 ? VALUES / s->head->n_columns : ROWS;
    return rows > ROWS ? ROWS : rows > 1 ? rows : 1;
}

int
ss_is_on_clock(double time, double rate, double start, uint64_t row)
{
    double expected = start + (double)row / rate;
    return fabs(time - expected) <= 1e-6 / rate + 1e-15 * fabs(expected);
}

/* --- a whole signal in memory, column after column --------------------------------------------- */

ss_status
ss_signal_new(ss_signal **out, const ss_header *head, size_t n, ss_error *err)
{
    if (out == NULL || head == NULL)
        return SS_FAIL_NULL(err);
    ss_signal *signal = calloc(1, sizeof *signal);
    size_t columns = head->n_columns > 0 ? head->n_columns : 1;
    *out = NULL;
    if (signal == NULL)
        return ss_fail_memory(err, NULL);
    signal->n = n;
    ss_header_select(&signal->head, head, NULL, head->n_columns, 0, NULL);
    if (n < SIZE_MAX / sizeof *signal->values / columns)
        signal->values = calloc(n * columns + 1, sizeof *signal->values);
    if (signal->head == NULL || signal->values == NULL) {
        ss_signal_free(signal);
        return ss_fail_memory(err, NULL);
    }
    *out = signal;
    return SS_OK;
}

void
ss_signal_free(ss_signal *signal)
{
    if (signal == NULL)
        return;
    ss_header_free(signal->head);
    free(signal->values);
    free(signal);
}

ss_status
ss_signal_select(ss_signal **out, const ss_signal *signal, const size_t *column, size_t n_columns,
                 size_t first, size_t end, ss_error *err)
{
    ss_header *head;
    *out = NULL;
    ss_status st = ss_header_select(&head, signal->head, column, n_columns, first, err);
    if (st != SS_OK)
        return st;
    size_t n = end - first;
    st = ss_signal_new(out, head, n, err);
    ss_header_free(head);
    for (size_t c = 0; st == SS_OK && c < n_columns; c++)
        memcpy((*out)->values + c * n, signal->values + (column != NULL ? column[c] : c) * signal->n + first,
               n * sizeof *signal->values);
    return st;
}

/* --- as a whole signal --------------------------------------------------------------------- */

/* Give each column of a signal room for `more` rows in place of *room. */
static ss_status
set_room(ss_signal *signal, size_t *room, size_t more, const char *name, ss_error *err)
{
    size_t columns = signal->head->n_columns, n = signal->n;
    double *values = signal->values;
    for (size_t c = 1; more < *room && c < columns; c++)
        memmove(values + c * more, values + c * *room, n * sizeof *values);
    int fits = more < SIZE_MAX / sizeof *values / (columns + 1);
    values = fits ? realloc(values, (columns * more + 1) * sizeof *values) : NULL;
    if (values == NULL)
        return ss_fail(err, SS_ENOMEM, "%s: no memory for a record this long", name);
    signal->values = values;
    for (size_t c = columns; more > *room && c-- > 1;)
        memmove(values + c * more, values + c * *room, n * sizeof *values);
    *room = more;
    return SS_OK;
}

ss_status
ss_source_all(ss_signal **out, ss_source *s, ss_error *err)
{
    size_t columns = s->head->n_columns, room = 0, got = 1;
    size_t first = s->length < UINT64_MAX ? (size_t)s->length + 1 : 1 + 16384 / (columns + 1);
    ss_signal *signal = NULL;
    double **column = malloc((columns + 1) * sizeof *column);
    ss_status st = column != NULL ? ss_signal_new(&signal, s->head, 0, NULL) : SS_ENOMEM;
    if (st != SS_OK)
        ss_fail_memory(err, s->name);
    while (st == SS_OK && got > 0) {
        if (signal->n == room)
            st = set_room(signal, &room, room > 0 ? 2 * room : first, s->name, err);
        for (size_t c = 0; c < columns; c++)
            column[c] = signal->values + c * room + signal->n;
        if (st == SS_OK)
            st = ss_source_rows(s, column, room - signal->n, &got, err);
        signal->n += st == SS_OK ? got : 0;
    }
    if (st == SS_OK)
        st = set_room(signal, &room, signal->n, s->name, err);
    free(column);
    if (st == SS_OK)
        *out = signal;
    else
        ss_signal_free(signal);
    return st;
}

/* --- of a signal in memory ----------------------------------------------------------------- */

static void
hold_all(ss_source *s)
{
    s->held = (size_t)s->length;
}

ss_source *
ss_source_of_signal(const ss_signal *signal, const char *name, ss_error *err)
{
    static const struct source_calls calls = { .rewind = hold_all };
    ss_source *s = make(sizeof *s, &calls, name, signal->head, err);
    if (s == NULL)
        return NULL;
    s->made = signal->values;
    s->length = s->apart = s->held = signal->n;
    return s;
}
