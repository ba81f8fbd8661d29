/* coefficient_rows.c -- writing coefficients, as they come, a column a number, in any format.
 *
 * For each row only b, re, im and edge are formatted: the cells that all rows of a scale share are
 * made once. */
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "map/plan.h"
#include "io/coefficient_rows.h"
#include "io/format.h"
#include "io/output.h"

const char *const ss_coefficient_columns[COEFFICIENT_COLUMNS][2] = {
    { "m", "" }, { "a", "s" }, { "b", "s" }, { "f", "Hz" }, { "re", "" }, { "im", "" }, { "edge", "" } };

enum { LONGEST = COEFFICIENT_COLUMNS * SS_NUMBER_MAX };

struct ss_coefficient_writer {
    const struct format *format;
    double rate, start;
    ss_span *gap;
    size_t n_gaps;
    int stream;                 /* 1: the length of the record comes last */
    struct output out;          /* empty between calls */
};

static ss_status
write_header(const ss_header *head, FILE *out, const struct format *format, ss_error *err)
{
    ss_header *own;
    ss_status st = ss_header_select(&own, head, NULL, 0, 0, NULL);
    for (int i = 0; st == SS_OK && i < COEFFICIENT_COLUMNS; i++)
        st = ss_header_add_column(own, ss_coefficient_columns[i][0], ss_coefficient_columns[i][1], NULL);
    if (st == SS_OK) {
        own->has_time = 0;
        st = format->begin(out, own, ss_kind_magic(SS_KIND_COEFFICIENTS), err);
    }
    ss_header_free(own);
    return st;
}

ss_status
ss_coefficient_writer_new(ss_coefficient_writer **out_writer, FILE *out, ss_format format,
                          const ss_header *head, ss_error *err)
{
    if (out_writer == NULL || out == NULL || head == NULL || ss_format_table(format) == NULL)
        return ss_fail(err, SS_EINVAL, "an argument is NULL, or the format is not known");
    const char *stream = ss_header_find_note(head, "stream");
    ss_coefficient_writer *writer = malloc(sizeof *writer);
    *out_writer = NULL;
    if (writer == NULL)
        return SS_ENOMEM;
    writer->out.file = out;
    writer->format = ss_format_table(format);
    writer->rate = head->rate;
    writer->start = head->start;
    writer->stream = stream != NULL && strcmp(stream, "yes") == 0;
    writer->out.used = 0;
    ss_status st = ss_header_gaps(&writer->gap, &writer->n_gaps, head, NULL);
    if (st == SS_OK)
        st = write_header(head, out, writer->format, err);
    if (st == SS_OK)
        *out_writer = writer;
    else
        ss_coefficient_writer_free(writer);
    return st;
}

ss_status
ss_coefficient_writer_rows(ss_coefficient_writer *writer, const ss_scale *scale, size_t first,
                           size_t n, const double *w, size_t samples, ss_error *err)
{
    if (writer == NULL || scale == NULL || w == NULL)
        return SS_FAIL_NULL(err);
    size_t (*write_number)(char *, double, int) = writer->format->number;
    char m_and_a[2 * SS_NUMBER_MAX] = { 0 }, f[SS_NUMBER_MAX] = { 0 };
    size_t f_length = write_number(f, scale->f, 0), length = write_number(m_and_a, scale->m, 0);
    length += write_number(m_and_a + length, scale->a, 0);
    for (size_t i = 0; i < n; i++, w += 2) {
        double b = ss_scale_b(scale, first + i);
        int edge = wavelet_edge(scale, first + i, samples, writer->rate, writer->start, writer->gap,
                                writer->n_gaps);
        char *to = writer->out.buffer + writer->out.used;
        memcpy(to, m_and_a, sizeof m_and_a);    /* the constant size lets compilers avoid a call */
        to += length;
        to += write_number(to, b, 0);
        memcpy(to, f, sizeof f);
        to += f_length;
        to += write_number(to, w[0], 0);
        to += write_number(to, w[1], 0);
        to += write_number(to, edge, 1);
        writer->out.used = (size_t)(to - writer->out.buffer);
        if (writer->out.used > OUTPUT_ROOM - LONGEST) {
            ss_status st = ss_output_drain(&writer->out);
            if (st != SS_OK)
                return ss_fail(err, st, "%s", ss_strerror(st));
        }
    }
    ss_status st = ss_output_drain(&writer->out);
    return st == SS_OK ? SS_OK : ss_fail(err, st, "%s", ss_strerror(st));
}

/* Write the length of a stream, which is known only at its end: as a note, or as a row at scale 0 whose b
 * is the time of the last sample. */
static void
write_length(struct output *out, const struct format *format, size_t samples, double rate)
{
    if (format->has_notes) {
        fprintf(out->file, "# samples: %zu\n", samples);
        return;
    }
    for (int i = 0; format->separator == '\0' && i < COEFFICIENT_COLUMNS; i++)
        out->used += format->number(out->buffer + out->used,
                                    i == 2 ? (double)(samples - 1) / rate : 0,
                                    i + 1 == COEFFICIENT_COLUMNS);
}

ss_status
ss_coefficient_writer_end(ss_coefficient_writer *writer, size_t samples, ss_error *err)
{
    if (writer == NULL)
        return SS_FAIL_NULL(err);
    if (writer->stream)
        write_length(&writer->out, writer->format, samples, writer->rate);
    ss_status st = ss_output_drain(&writer->out);
    if (st == SS_OK)
        st = ss_output_flush(writer->out.file);
    return st == SS_OK ? SS_OK : ss_fail(err, st, "%s", ss_strerror(st));
}

void
ss_coefficient_writer_free(ss_coefficient_writer *writer)
{
    if (writer == NULL)
        return;
    free(writer->gap);
    free(writer);
}

ss_status
ss_coefficients_write(const ss_coefficients *coefficients, FILE *out, ss_format format,
                      ss_error *err)
{
    ss_coefficient_writer *writer = NULL;
    if (coefficients == NULL || coefficients->w == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_coefficient_writer_new(&writer, out, format, coefficients->head, err);
    for (size_t i = 0; st == SS_OK && i < coefficients->n_scales; i++) {
        const ss_scale *scale = &coefficients->scale[i];
        st = ss_coefficient_writer_rows(writer, scale, 0, scale->n,
                                        coefficients->w + 2 * scale->offset, coefficients->n, err);
    }
    if (st == SS_OK)
        st = ss_coefficient_writer_end(writer, coefficients->n, err);
    ss_coefficient_writer_free(writer);
    return st;
}
