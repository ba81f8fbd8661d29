/* writer.c -- signals as text or as Sun AU. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "stream/stream.h"

enum { ANNOTATION_UNIT = 8 };

struct ss_writer {
    ss_format format;
    ss_header *head;
    size_t row;                 /* rows written so far */
    struct output out;          /* empty between calls */
};

ss_status
ss_output_drain(struct output *out)
{
    size_t n = out->used;
    out->used = 0;
    return fwrite(out->buffer, 1, n, out->file) == n ? SS_OK : SS_EIO;
}

static void
put_big_endian(char *p, uint64_t x, size_t n)
{
    for (; n-- > 0; x >>= 8)
        p[n] = (char)(x & 0xff);
}

uint32_t
ss_au_rate(double rate)
{
    return rate < 1 ? 1 : rate < UINT32_MAX ? (uint32_t)rint(rate) : UINT32_MAX;
}

ss_status
ss_header_write(const ss_header *head, const char *magic, FILE *out, ss_format format)
{
    size_t length;
    char *text = ss_header_text(head, magic, &length), fixed[AU_FIXED_HEADER];
    if (text == NULL)
        return SS_ENOMEM;
    size_t padding = ANNOTATION_UNIT - length % ANNOTATION_UNIT;        /* NULs, at least one */
    if (format == SS_AU && (head->n_columns > AU_MAX_CHANNELS
                            || length + padding > AU_MAX_ANNOTATION)) {
        free(text);
        return SS_EINVAL;
    }
    if (format == SS_AU) {
        uint32_t field[6] = { 0x2e736e64, (uint32_t)(sizeof fixed + length + padding), 0xffffffff,
                              7, ss_au_rate(head->rate), (uint32_t)head->n_columns };
        for (int i = 0; i < 6; i++)
            put_big_endian(fixed + 4 * i, field[i], 4);
        fwrite(fixed, 1, sizeof fixed, out);
        fwrite(text, 1, length, out);
        fwrite("\0\0\0\0\0\0\0", 1, padding, out);
    } else {
        fwrite(text, 1, length, out);
    }
    free(text);
    return ferror(out) ? SS_EIO : SS_OK;
}

void
ss_au_put(char to[8], double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    to[0] = (char)(bits >> 56), to[1] = (char)(bits >> 48 & 0xff);
    to[2] = (char)(bits >> 40 & 0xff), to[3] = (char)(bits >> 32 & 0xff);
    to[4] = (char)(bits >> 24 & 0xff), to[5] = (char)(bits >> 16 & 0xff);
    to[6] = (char)(bits >> 8 & 0xff), to[7] = (char)(bits & 0xff);
}

ss_status
ss_writer_new(ss_writer **out_writer, FILE *out, ss_format format, const ss_header *head)
{
    if (out_writer == NULL || out == NULL || head == NULL || (unsigned)format > SS_AU)
        return SS_EINVAL;
    ss_writer *writer = malloc(sizeof *writer);
    *out_writer = NULL;
    if (writer == NULL)
        return SS_ENOMEM;
    writer->out.file = out;
    writer->format = format;
    writer->row = writer->out.used = 0;
    writer->head = ss_header_copy(head);
    ss_status st = writer->head == NULL ? SS_ENOMEM
        : ss_header_write(head, STREAM_MAGIC, out, format);
    if (st != SS_OK) {
        ss_writer_free(writer);
        return st;
    }
    *out_writer = writer;
    return SS_OK;
}

static void
put_value(ss_writer *writer, double x, char separator)
{
    char *to = writer->out.buffer + writer->out.used;
    if (writer->format == SS_AU) {
        ss_au_put(to, x);
        writer->out.used += sizeof x;
    } else {
        size_t n = ss_number_format(to, x);
        to[n] = separator;
        writer->out.used += n + 1;
    }
}

ss_status
ss_writer_rows(ss_writer *writer, const double *rows, size_t n)
{
    if (writer == NULL || (rows == NULL && n > 0))
        return SS_EINVAL;
    const ss_header *head = writer->head;
    size_t columns = head->n_columns;
    for (size_t i = 0; i < n; i++, writer->row++) {
        if (head->has_time && writer->format == SS_TSV)
            put_value(writer, head->start + (double)writer->row / head->rate,
                      columns > 0 ? '\t' : '\n');
        for (size_t c = 0; c < columns; c++) {
            if (writer->out.used > OUTPUT_ROOM - 2 * SS_NUMBER_MAX) {
                ss_status st = ss_output_drain(&writer->out);
                if (st != SS_OK)
                    return st;
            }
            put_value(writer, *rows++, c + 1 < columns ? '\t' : '\n');
        }
    }
    return ss_output_drain(&writer->out);
}

ss_status
ss_writer_flush(ss_writer *writer)
{
    if (writer == NULL)
        return SS_EINVAL;
    return fflush(writer->out.file) == 0 && !ferror(writer->out.file) ? SS_OK : SS_EIO;
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
ss_signal_write(const ss_signal *signal, FILE *out, ss_format format)
{
    enum { PIECE = 1024 };
    ss_writer *writer = NULL;
    if (signal == NULL || out == NULL)
        return SS_EINVAL;
    size_t columns = signal->head->n_columns;
    double *rows = malloc((columns + 1) * PIECE * sizeof *rows);
    if (rows == NULL)
        return SS_ENOMEM;
    ss_status st = ss_writer_new(&writer, out, format, signal->head);
    for (size_t first = 0; st == SS_OK && first < signal->n; first += PIECE) {
        size_t n = signal->n - first < PIECE ? signal->n - first : PIECE;
        for (size_t i = 0; i < n; i++)
            for (size_t c = 0; c < columns; c++)
                rows[i * columns + c] = signal->values[c * signal->n + first + i];
        st = ss_writer_rows(writer, rows, n);
    }
    if (st == SS_OK)
        st = ss_writer_flush(writer);
    ss_writer_free(writer);
    free(rows);
    return st;
}
