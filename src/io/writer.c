/* writer.c -- signals row by row, in any format. */
#include <stdlib.h>
#include "base/error.h"
#include "io/format.h"
#include "io/output.h"

struct ss_writer {
    const struct format *format;
    ss_header *head;
    size_t row;                 /* rows written so far */
    struct output out;          /* empty between calls */
};

ss_status
ss_writer_new(ss_writer **out_writer, FILE *out, ss_format format, const ss_header *head,
              ss_error *err)
{
    if (out_writer == NULL || out == NULL || head == NULL || ss_format_table(format) == NULL)
        return ss_fail(err, SS_EINVAL, "an argument is NULL, or the format is not known");
    ss_writer *writer = malloc(sizeof *writer);
    *out_writer = NULL;
    if (writer == NULL)
        return ss_fail_memory(err, NULL);
    writer->out.file = out;
    writer->format = ss_format_table(format);
    writer->row = writer->out.used = 0;
    ss_status st = ss_header_copy(&writer->head, head, err);
    if (st == SS_OK)
        st = writer->format->begin(out, head, ss_kind_magic(SS_KIND_SIGNAL), err);
    if (st == SS_OK)
        *out_writer = writer;
    else
        ss_writer_free(writer);
    return st == SS_ENOMEM || st == SS_EIO ? ss_fail(err, st, "%s", ss_strerror(st)) : st;
}

static void
write_value(ss_writer *writer, double x, int last)
{
    struct output *out = &writer->out;
    out->used += writer->format->number(out->buffer + out->used, x, last);
}

ss_status
ss_writer_rows(ss_writer *writer, double *const column[], size_t n, ss_error *err)
{
    if (writer == NULL || (column == NULL && n > 0))
        return SS_FAIL_NULL(err);
    const ss_header *head = writer->head;
    size_t columns = head->n_columns;
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < n; i++, writer->row++) {
        if (head->has_time && writer->format->has_time)
            write_value(writer, head->start + (double)writer->row / head->rate, columns == 0);
        for (size_t c = 0; st == SS_OK && c < columns; c++) {
            if (writer->out.used > OUTPUT_ROOM - 2 * SS_NUMBER_MAX)
                st = ss_output_drain(&writer->out);
            write_value(writer, column[c][i], c + 1 == columns);
        }
    }
    if (st == SS_OK)
        st = ss_output_drain(&writer->out);
    return st == SS_OK ? st : ss_fail(err, st, "%s", ss_strerror(st));
}

ss_status
ss_writer_flush(ss_writer *writer, ss_error *err)
{
    if (writer == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_output_flush(writer->out.file);
    return st == SS_OK ? st : ss_fail(err, st, "%s", ss_strerror(st));
}

void
ss_writer_free(ss_writer *writer)
{
    if (writer == NULL)
        return;
    ss_header_free(writer->head);
    free(writer);
}

ss_status
ss_signal_write(const ss_signal *signal, FILE *out, ss_format format, ss_error *err)
{
    ss_writer *writer = NULL;
    if (signal == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    size_t columns = signal->head->n_columns;
    double **column = malloc((columns + 1) * sizeof *column);
    if (column == NULL)
        return ss_fail_memory(err, NULL);
    for (size_t c = 0; c < columns; c++)
        column[c] = signal->values + c * signal->n;
    ss_status st = ss_writer_new(&writer, out, format, signal->head, err);
    if (st == SS_OK)
        st = ss_writer_rows(writer, column, signal->n, err);
    if (st == SS_OK)
        st = ss_writer_flush(writer, err);
    ss_writer_free(writer);
    free(column);
    return st;
}
