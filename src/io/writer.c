/* writer.c -- samples, coefficients or events as a stream, in any format.
 *
 * For each row of coefficients only b, re, im and edge are formatted: the cells that all rows of a scale share
 * are made once. */
#include "io/writer.h"

#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "map/plan.h"
#include "io/format.h"
#include "io/record.h"
#include "signal/gaps.h"
#include "motion/kind.h"

const char *const ss_coefficient_columns[COEFFICIENT_COLUMNS][2] = {
    { "m", "" }, { "a", "s" }, { "b", "s" }, { "f", "Hz" }, { "re", "" }, { "im", "" }, { "edge", "" } };

enum { ROOM = 1 << 16, LONGEST = COEFFICIENT_COLUMNS * SS_NUMBER_MAX };

struct stream {
    ss_writer base;
    enum { SAMPLES, COEFFICIENTS, EVENTS } holds;
    const struct format *format;
    double rate, start;
    size_t has_time;            /* of samples: 1: there is a column of time */
    size_t columns, row;        /* and the rows so far */
    ss_header *names;           /* and those, if each cell has its own; else NULL */
    ss_span *gap;               /* of coefficients */
    size_t n_gaps;
    int open_end;               /* of coefficients: the length of the record comes last */
    struct rows rows;           /* of events */
    struct {                    /* bytes that will be written; none between calls */
        FILE *file;
        size_t used;
        char buffer[ROOM];
    } out;
};

/* Write the buffer, and report what failed. */
static ss_status
drain(struct stream *s, ss_error *err)
{
    size_t n = s->out.used;
    s->out.used = 0;
    return fwrite(s->out.buffer, 1, n, s->out.file) == n ? SS_OK : ss_fail(err, SS_EIO, "%s", ss_strerror(SS_EIO));
}

/* Write the name of a cell, if it has one. */
static ss_status
name_cell(struct stream *s, const char *name, int first, ss_error *err)
{
    ss_status st = s->format->key != NULL || s->out.used > ROOM - SS_NUMBER_MAX ? drain(s, err) : SS_OK;
    if (s->format->key != NULL)
        s->format->key(s->out.file, name, first);
    return st;
}

static ss_status
write_samples(ss_writer *w, double *const column[], size_t n, ss_error *err)
{
    struct stream *s = (struct stream *)w;
    size_t (*number)(char *, double, int) = s->format->number;
    const size_t time = s->has_time, cells = s->columns + time;
    char *to = s->out.buffer + s->out.used, *const last = s->out.buffer + ROOM - SS_NUMBER_MAX;
    for (size_t i = 0; s->holds == SAMPLES && i < n; i++, s->row++)
        for (size_t k = 0; k < cells; k++) {
            if (to > last || s->names != NULL) {
                s->out.used = (size_t)(to - s->out.buffer);
                ss_status st = name_cell(s, k < time ? "t" : s->names != NULL ? s->names->column[k - time].name : "",
                                         k == 0, err);
                if (st != SS_OK)
                    return st;
                to = s->out.buffer;
            }
            double x = k < time ? s->start + (double)s->row / s->rate : column[k - time][i];
            to += number(to, x, k + 1 == cells);
        }
    s->out.used = (size_t)(to - s->out.buffer);
    return drain(s, err);
}

static ss_status
write_coefficients(ss_writer *w, const ss_scale *scale, size_t first, size_t n, const double *c, size_t samples,
                   ss_error *err)
{
    struct stream *s = (struct stream *)w;
    size_t (*number)(char *, double, int) = s->format->number;
    char m_and_a[2 * SS_NUMBER_MAX] = { 0 }, f[SS_NUMBER_MAX] = { 0 };
    size_t f_length = number(f, scale->f, 0), length = number(m_and_a, scale->m, 0);
    ss_status st = SS_OK;
    length += number(m_and_a + length, scale->a, 0);
    for (size_t i = 0; s->holds == COEFFICIENTS && st == SS_OK && i < n; i++, c += 2) {
        double b = ss_scale_b(scale, first + i);
        int edge = wavelet_edge(scale, first + i, samples, s->rate, s->start, s->gap, s->n_gaps);
        const double row[COEFFICIENT_COLUMNS] = { scale->m, scale->a, b, scale->f, c[0], c[1], edge };
        for (int k = 0; s->format->key != NULL && st == SS_OK && k < COEFFICIENT_COLUMNS; k++) {
            st = name_cell(s, ss_coefficient_columns[k][0], k == 0, err);
            s->out.used += number(s->out.buffer + s->out.used, row[k], k + 1 == COEFFICIENT_COLUMNS);
        }
        if (s->format->key != NULL)
            continue;
        char *to = s->out.buffer + s->out.used;
        memcpy(to, m_and_a, sizeof m_and_a);    /* the constant size lets compilers avoid a call */
        to += length;
        to += number(to, b, 0);
        memcpy(to, f, sizeof f);
        to += f_length;
        to += number(to, c[0], 0);
        to += number(to, c[1], 0);
        to += number(to, edge, 1);
        s->out.used = (size_t)(to - s->out.buffer);
        if (s->out.used > ROOM - LONGEST)
            st = drain(s, err);
    }
    return st == SS_OK ? drain(s, err) : st;
}

static void
write_event(struct rows *rows, const ss_event *event)
{
    ss_rows_number(rows, "t", "s", event->t);
    ss_rows_word(rows, "kind", ss_event_kind_name(event->kind));
    ss_rows_number(rows, "x", "m", event->x);
    ss_rows_number(rows, "v", "m/s", event->v);
    ss_rows_number(rows, "direction", "", event->direction);
    ss_rows_end(rows);
}

static ss_status
write_events(ss_writer *w, const ss_event *event, size_t n, ss_error *err)
{
    struct stream *s = (struct stream *)w;
    for (size_t i = 0; s->holds == EVENTS && i < n; i++)
        write_event(&s->rows, &event[i]);
    return ferror(s->out.file) ? ss_fail(err, SS_EIO, "%s", ss_strerror(SS_EIO)) : SS_OK;
}

static ss_status
write_note(ss_writer *w, const char *key, const char *value, ss_error *err)
{
    const struct stream *s = (struct stream *)w;
    (void)err;
    if (s->format->has_notes)
        fprintf(s->out.file, "# %s: %s\n", key, value);
    return SS_OK;
}

/* The length of a record, where it is known only at its end: as a note, or as a row at scale 0 whose b is the time
 * of the last sample. */
static ss_status
end_stream(ss_writer *w, size_t samples, ss_error *err)
{
    struct stream *s = (struct stream *)w;
    if (s->open_end && s->format->has_notes)
        fprintf(s->out.file, "# samples: %zu\n", samples);
    for (int i = 0; s->open_end && s->format->separator == '\0' && i < COEFFICIENT_COLUMNS; i++)
        s->out.used += s->format->number(s->out.buffer + s->out.used, i == 2 ? (double)(samples - 1) / s->rate : 0,
                                         i + 1 == COEFFICIENT_COLUMNS);
    ss_status st = drain(s, err);
    if (st == SS_OK && s->format->end != NULL)
        st = s->format->end(s->out.file, s->rate, s->columns, s->row, err);
    if (st == SS_OK && (fflush(s->out.file) != 0 || ferror(s->out.file)))
        st = ss_fail(err, SS_EIO, "%s", ss_strerror(SS_EIO));
    return st;
}

static void
free_stream(ss_writer *w)
{
    free(((struct stream *)w)->gap);
    ss_header_free(((struct stream *)w)->names);
    free(w);
}

static ss_status
begin_coefficients(struct stream *s, const ss_header *head, ss_error *err)
{
    ss_header *own = NULL;
    const char *open_end = ss_header_find_note(head, "stream");
    s->open_end = open_end != NULL && strcmp(open_end, "yes") == 0;
    ss_status st = ss_header_gaps(&s->gap, &s->n_gaps, head, NULL);
    if (st == SS_OK)
        st = ss_header_select(&own, head, NULL, 0, 0, NULL);
    for (int i = 0; st == SS_OK && i < COEFFICIENT_COLUMNS; i++)
        st = ss_header_add_column(own, ss_coefficient_columns[i][0], ss_coefficient_columns[i][1], NULL);
    if (st == SS_OK) {
        own->has_time = 0;
        st = s->format->begin(s->out.file, own, ss_kind_magic(SS_KIND_COEFFICIENTS), err);
    }
    ss_header_free(own);
    return st;
}

static ss_status
new_stream(ss_writer **out_writer, FILE *out, ss_format format, const ss_contents *what, ss_error *err)
{
    static const struct writer_calls calls = {
        write_samples, write_coefficients, write_events, write_note, end_stream, free_stream };
    const ss_header *head = what->grid != NULL && !what->events ? what->grid->head : what->signal;
    if (out == NULL || head == NULL)
        return SS_FAIL_NULL(err);
    struct stream *s = malloc(sizeof *s);
    if (s == NULL)
        return ss_fail_memory(err, NULL);
    s->base.calls = &calls;
    s->holds = what->events ? EVENTS : what->grid != NULL ? COEFFICIENTS : SAMPLES;
    s->format = ss_format_table(format);
    s->rate = head->rate;
    s->start = head->start;
    s->has_time = head->has_time && s->format->has_time ? 1 : 0;
    s->columns = head->n_columns;
    s->gap = NULL;
    s->names = NULL;
    s->open_end = 0;
    s->row = s->out.used = 0;
    s->out.file = out;
    ss_status st = s->format->key != NULL ? ss_header_copy(&s->names, head, err) : SS_OK;
    if (st == SS_OK && what->events) {
        if ((st = ss_rows_begin(&s->rows, out, format, SS_KIND_EVENTS, err)) == SS_OK) {
            ss_rows_notes(&s->rows, head, (const char *const []){ NULL });      /* it has none of its own */
            write_event(&s->rows, &(ss_event){ .t = 0 });       /* the names */
        }
    } else if (st == SS_OK && what->grid != NULL)
        st = begin_coefficients(s, head, err);
    else if (st == SS_OK)
        st = s->format->begin(out, head, ss_kind_magic(SS_KIND_SIGNAL), err);
    if (st == SS_OK)
        *out_writer = &s->base;
    else
        free_stream(&s->base);
    return st == SS_ENOMEM || st == SS_EIO ? ss_fail(err, st, "%s", ss_strerror(st)) : st;
}

/* --- any file ------------------------------------------------------------------------------ */

ss_status
ss_writer_new(ss_writer **out_writer, FILE *out, const char *path, ss_format format, const ss_contents *contents,
              ss_error *err)
{
    if (out_writer == NULL || contents == NULL || (contents->grid != NULL && contents->grid->head == NULL))
        return SS_FAIL_NULL(err);
    *out_writer = NULL;
    if (ss_format_table(format) != NULL)
        return new_stream(out_writer, out, format, contents, err);
    const struct ss_store_calls *hdf5 = format == SS_H5 ? ss_store_calls(err) : NULL;
    if (format != SS_H5)
        return ss_fail(err, SS_EINVAL, "the format is not known");
    if (path == NULL || (contents->grid != NULL && contents->grid->n_scales == 0))
        return SS_FAIL_NULL(err);
    return hdf5 != NULL ? hdf5->writer_new(out_writer, path, contents, err) : SS_EIO;
}

ss_status
ss_writer_rows(ss_writer *w, double *const column[], size_t n, ss_error *err)
{
    if (w == NULL || (column == NULL && n > 0))
        return SS_FAIL_NULL(err);
    return w->calls->rows(w, column, n, err);
}

ss_status
ss_writer_coefficients(ss_writer *w, const ss_scale *scale, size_t first, size_t n, const double *c, size_t samples,
                       ss_error *err)
{
    if (w == NULL || scale == NULL || (c == NULL && n > 0))
        return SS_FAIL_NULL(err);
    return w->calls->coefficients(w, scale, first, n, c, samples, err);
}

ss_status
ss_writer_events(ss_writer *w, const ss_event *event, size_t n, ss_error *err)
{
    if (w == NULL || (event == NULL && n > 0))
        return SS_FAIL_NULL(err);
    for (size_t i = 0; i < n; i++)
        if ((unsigned)event[i].kind > SS_REVERSE)
            return ss_fail(err, SS_EINVAL, "an event of no known kind");
    return w->calls->events(w, event, n, err);
}

ss_status
ss_writer_note(ss_writer *w, const char *key, const char *value, ss_error *err)
{
    if (w == NULL || key == NULL || value == NULL)
        return SS_FAIL_NULL(err);
    return w->calls->note(w, key, value, err);
}

ss_status
ss_writer_end(ss_writer *w, size_t samples, ss_error *err)
{
    return w != NULL ? w->calls->end(w, samples, err) : SS_FAIL_NULL(err);
}

void
ss_writer_free(ss_writer *w)
{
    if (w != NULL)
        w->calls->free(w);
}

/* --- at once ------------------------------------------------------------------------------- */

ss_status
ss_record_write(const ss_record *r, FILE *out, const char *path, ss_format format, ss_error *err)
{
    ss_writer *w = NULL;
    if (r == NULL || (r->coefficients != NULL && r->coefficients->w == NULL))
        return SS_FAIL_NULL(err);
    const ss_signal *signal = r->signal;
    const ss_coefficients *c = r->coefficients;
    size_t n = c != NULL ? c->n : signal != NULL ? signal->n : 0;
    size_t columns = signal != NULL ? signal->head->n_columns : 0;
    const ss_contents what = { signal != NULL ? signal->head : NULL, c, r->has_events || r->n_events > 0, n };
    double **column = malloc((columns + 1) * sizeof *column);
    ss_status st = column != NULL ? ss_writer_new(&w, out, path, format, &what, err) : ss_fail_memory(err, NULL);
    for (size_t k = 0; st == SS_OK && k < columns; k++)
        column[k] = signal->values + k * signal->n;
    if (st == SS_OK && signal != NULL)
        st = ss_writer_rows(w, column, signal->n, err);
    if (st == SS_OK)
        st = ss_writer_events(w, r->events, r->n_events, err);
    for (size_t i = 0; st == SS_OK && c != NULL && i < c->n_scales; i++)
        st = ss_writer_coefficients(w, &c->scale[i], 0, c->scale[i].n, c->w + 2 * c->scale[i].offset, n, err);
    if (st == SS_OK)
        st = ss_writer_end(w, n, err);
    ss_writer_free(w);
    free(column);
    return st;
}
