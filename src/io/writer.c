/* writer.c -- samples, coefficients or events as a stream, in any format.
 *
 * For each row of coefficients only b, re, im and edge are formatted: the cells that all rows of a scale share
 * are made once. */

#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "map/plan.h"
#include "io/format.h"
#include "io/record.h"
#include "signal/gaps.h"
#include "scene/scene.h"

const char *const ss_coefficient_columns[COEFFICIENT_COLUMNS][2] = {
    { "m", "" }, { "a", "s" }, { "b", "s" }, { "f", "Hz" }, { "re", "" }, { "im", "" }, { "edge", "" } };

enum { ROOM = 1 << 16 };

struct stream {
    ss_writer base;
    enum { SAMPLES, COEFFICIENTS, EVENTS } holds;
    const struct format *format;
    FILE *file;
    ss_header *head;            /* of the signal; of coefficients only its clock counts */
    size_t time, row;           /* of samples: 1 if there is a column of time; and the rows so far */
    ss_span *gap;               /* of coefficients */
    size_t n_gaps;
    int open_end;               /* of coefficients: the length of the record comes last */
    struct rows rows;           /* of events */
    size_t used;                /* bytes of cells on their way to the file: */
    char text[ROOM];
};

static void
drain(struct stream *s)
{
    fwrite(s->text, 1, s->used, s->file);
    s->used = 0;
}

/* Write a cell of numbers.  Returns its length. */
static size_t
format_cell(const struct format *format, char *to, double x, int last)
{
    if (format->number != NULL)
        return format->number(to, x, last);
    size_t n = ss_number_format(to, x);
    to[n] = last ? '\n' : format->separator;
    return n + 1;
}

/* Let there be room for a cell, and write the name before it if it has its own. */
static void
begin_cell(struct stream *s, const char *name, int first)
{
    if (s->format->key != NULL || s->used > ROOM - SS_NUMBER_MAX)
        drain(s);
    if (s->format->key != NULL)
        s->format->key(s->file, name, first);
}

static ss_status
end_rows(struct stream *s, ss_error *err)
{
    drain(s);
    return ferror(s->file) ? ss_fail(err, SS_EIO, "%s", ss_strerror(SS_EIO)) : SS_OK;
}

static ss_status
write_samples(ss_writer *w, double *const column[], size_t n, ss_error *err)
{
    struct stream *s = (struct stream *)w;
    const ss_header *head = s->head;
    for (size_t i = 0; s->holds == SAMPLES && i < n; i++, s->row++)
        for (size_t k = 0, cells = head->n_columns + s->time; k < cells; k++) {
            double x = k < s->time ? head->start + (double)s->row / head->rate : column[k - s->time][i];
            begin_cell(s, k < s->time ? "t" : head->column[k - s->time].name, k == 0);
            s->used += format_cell(s->format, s->text + s->used, x, k + 1 == cells);
        }
    return end_rows(s, err);
}

static ss_status
write_coefficients(ss_writer *w, const ss_scale *scale, size_t first, size_t n, const double *c, size_t samples,
                   ss_error *err)
{
    struct stream *s = (struct stream *)w;
    double row[COEFFICIENT_COLUMNS] = { scale->m, scale->a, 0, scale->f };
    struct {
        char text[SS_NUMBER_MAX];
        size_t length;
    } shared[COEFFICIENT_COLUMNS] = { { .length = 0 } };
    for (int k = 0; k < COEFFICIENT_COLUMNS; k++)
        if (k != 2 && k < 4)
            shared[k].length = format_cell(s->format, shared[k].text, row[k], 0);
    for (size_t i = 0; s->holds == COEFFICIENTS && i < n; i++) {
        row[2] = ss_scale_b(scale, first + i);
        row[4] = c[2 * i];
        row[5] = c[2 * i + 1];
        row[6] = wavelet_edge(scale, first + i, samples, s->head->rate, s->head->start, s->gap, s->n_gaps);
        for (int k = 0; k < COEFFICIENT_COLUMNS; k++) {
            begin_cell(s, ss_coefficient_columns[k][0], k == 0);
            if (shared[k].length > 0)           /* its constant size lets compilers avoid a call */
                memcpy(s->text + s->used, shared[k].text, sizeof shared[k].text);
            s->used += shared[k].length > 0 ? shared[k].length
                : format_cell(s->format, s->text + s->used, row[k], k + 1 == COEFFICIENT_COLUMNS);
        }
    }
    return end_rows(s, err);
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
    return end_rows(s, err);
}

static ss_status
write_note(ss_writer *w, const char *key, const char *value, ss_error *err)
{
    const struct stream *s = (struct stream *)w;
    (void)err;
    if (s->format->has_notes)
        fprintf(s->file, "# %s: %s\n", key, value);
    return SS_OK;
}

/* The length of a record, where it is known only at its end: as a note, or as a row at scale 0 whose b is the time
 * of the last sample. */
static ss_status
end_stream(ss_writer *w, size_t samples, ss_error *err)
{
    struct stream *s = (struct stream *)w;
    ss_status st = SS_OK;
    if (s->open_end && s->format->has_notes)
        fprintf(s->file, "# samples: %zu\n", samples);
    double row[COEFFICIENT_COLUMNS] = { 0, 0, (double)(samples - 1) / s->head->rate };
    for (int i = 0; s->open_end && s->format->separator == '\0' && i < COEFFICIENT_COLUMNS; i++)
        s->used += format_cell(s->format, s->text + s->used, row[i], 0);
    drain(s);
    if (s->format->end != NULL)
        st = s->format->end(s->file, s->head->rate, s->head->n_columns, s->row, err);
    if (st == SS_OK && (fflush(s->file) != 0 || ferror(s->file)))
        st = ss_fail(err, SS_EIO, "%s", ss_strerror(SS_EIO));
    return st;
}

static void
free_stream(ss_writer *w)
{
    free(((struct stream *)w)->gap);
    ss_header_free(((struct stream *)w)->head);
    free(w);
}

static ss_status
begin_coefficients(struct stream *s, ss_error *err)
{
    ss_header *own = NULL;
    const char *open_end = ss_header_find_note(s->head, "stream");
    s->open_end = open_end != NULL && strcmp(open_end, "yes") == 0;
    ss_status st = ss_header_gaps(&s->gap, &s->n_gaps, s->head, NULL);
    if (st == SS_OK && (st = ss_header_select(&own, s->head, NULL, 0, 0, NULL)) == SS_OK)
        own->has_time = 0;
    for (int i = 0; st == SS_OK && i < COEFFICIENT_COLUMNS; i++)
        st = ss_header_add_column(own, ss_coefficient_columns[i][0], ss_coefficient_columns[i][1], NULL);
    if (st == SS_OK)
        st = s->format->begin(s->file, own, ss_kind_magic(SS_KIND_COEFFICIENTS), err);
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
    struct stream *s = calloc(1, sizeof *s);
    if (s == NULL)
        return ss_fail_memory(err, NULL);
    s->base.calls = &calls;
    s->holds = what->events ? EVENTS : what->grid != NULL ? COEFFICIENTS : SAMPLES;
    s->format = ss_format_table(format);
    s->time = head->has_time && s->format->has_time;
    s->file = out;
    ss_status st = ss_header_select(&s->head, head, NULL, head->n_columns, 0, err);
    if (st == SS_OK && s->holds == EVENTS) {
        if ((st = ss_rows_begin(&s->rows, out, format, SS_KIND_EVENTS, err)) == SS_OK) {
            ss_rows_notes(&s->rows, head, (const char *const []){ NULL });      /* it has none of its own */
            write_event(&s->rows, &(ss_event){ .t = 0 });       /* the names */
        }
    } else if (st == SS_OK)
        st = s->holds == COEFFICIENTS ? begin_coefficients(s, err)
            : s->format->begin(out, head, ss_kind_magic(SS_KIND_SIGNAL), err);
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
ss_writer_coefficients(ss_writer *w, const ss_scale *scale, size_t first, size_t n, const double *c,
                       size_t samples, ss_error *err)
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
