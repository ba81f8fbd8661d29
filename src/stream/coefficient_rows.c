/* coefficient_rows.c -- writing coefficients, as they come: as text, or as AU with a channel a column.
 *
 * Text repeats a scale's own columns as text, and AU as bytes; what is left to do for a row is its b,
 * re, im and edge. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "morlet/plan.h"
#include "stream/coefficient_rows.h"
#include "stream/stream.h"

enum { WIDTH = 8 * COEFFICIENT_COLUMNS, LONGEST = COEFFICIENT_COLUMNS * SS_NUMBER_MAX };

struct ss_coefficient_writer {
    ss_format format;
    double rate, start;
    ss_span *gap;
    size_t n_gaps;
    int stream;                 /* the length comes last */
    struct output out;          /* empty between calls */
};

static ss_status
write_header(const ss_header *head, FILE *out, ss_format format)
{
    static const char *const label[COEFFICIENT_COLUMNS][2] = {
        { "m", "" }, { "a", "s" }, { "b", "s" }, { "f", "Hz" }, { "re", "" }, { "im", "" },
        { "edge", "" } };
    ss_header *own;
    ss_status st = ss_header_select(&own, head, NULL, 0, 0);
    for (int i = 0; st == SS_OK && i < COEFFICIENT_COLUMNS; i++)
        st = ss_header_add_column(own, label[i][0], label[i][1]);
    if (st == SS_OK) {
        own->has_time = 0;
        st = ss_header_write(own, COEFFICIENTS_MAGIC, out, format);
    }
    ss_header_free(own);
    return st;
}

ss_status
ss_coefficient_writer_new(ss_coefficient_writer **out_writer, FILE *out, ss_format format,
                          const ss_header *head)
{
    if (out_writer == NULL || out == NULL || head == NULL || (unsigned)format > SS_AU)
        return SS_EINVAL;
    const char *stream = ss_header_find_note(head, "stream");
    ss_coefficient_writer *writer = malloc(sizeof *writer);
    *out_writer = NULL;
    if (writer == NULL)
        return SS_ENOMEM;
    writer->out.file = out;
    writer->format = format;
    writer->rate = head->rate;
    writer->start = head->start;
    writer->stream = stream != NULL && strcmp(stream, "yes") == 0;
    writer->out.used = 0;
    ss_status st = ss_header_gaps(&writer->gap, &writer->n_gaps, head);
    if (st == SS_OK)
        st = write_header(head, out, format);
    if (st == SS_OK)
        *out_writer = writer;
    else
        ss_coefficient_writer_free(writer);
    return st;
}

static size_t
put(char *to, double x, char end)
{
    size_t n = ss_number_format(to, x);
    to[n] = end;
    return n + 1;
}

/* A row as text; own is what all rows of the scale share, before b and behind it. */
static size_t
text_row(char *to, const char *const own[2], const size_t length[2], double b, const double w[2],
         int edge)
{
    char *p = to;
    memcpy(p, own[0], length[0]);
    p += length[0];
    p += put(p, b, '\t');
    memcpy(p, own[1], length[1]);
    p += length[1];
    p += put(p, w[0], '\t');
    p += put(p, w[1], '\t');
    *p++ = edge ? '1' : '0';
    *p++ = '\n';
    return (size_t)(p - to);
}

static void
au_row(char *to, double b, const double w[2], int edge)
{
    ss_au_put(to + 16, b);
    ss_au_put(to + 32, w[0]);
    ss_au_put(to + 40, w[1]);
    ss_au_put(to + 48, edge);
}

ss_status
ss_coefficient_writer_rows(ss_coefficient_writer *writer, const ss_scale *scale, size_t first,
                           size_t n, const double *w, size_t samples)
{
    if (writer == NULL || scale == NULL || w == NULL)
        return SS_EINVAL;
    char before[2 * SS_NUMBER_MAX], behind[SS_NUMBER_MAX], au[WIDTH] = { 0 };
    const char *const own[2] = { before, behind };
    size_t length[2] = { put(before, scale->m, '\t'), put(behind, scale->f, '\t') };
    length[0] += put(before + length[0], scale->a, '\t');
    ss_au_put(au, scale->m);
    ss_au_put(au + 8, scale->a);
    ss_au_put(au + 24, scale->f);
    for (size_t i = 0; i < n; i++, w += 2) {
        double b = ss_scale_b(scale, first + i);
        int edge = ss_scale_edge(scale, first + i, samples, writer->rate)
            || ss_gaps_near(writer->gap, writer->n_gaps, writer->start + b, sqrt(2) * scale->a);
        char *to = writer->out.buffer + writer->out.used;
        if (writer->format == SS_AU) {
            au_row(au, b, w, edge);
            memcpy(to, au, WIDTH);
            writer->out.used += WIDTH;
        } else {
            writer->out.used += text_row(to, own, length, b, w, edge);
        }
        if (writer->out.used > OUTPUT_ROOM - LONGEST) {
            ss_status st = ss_output_drain(&writer->out);
            if (st != SS_OK)
                return st;
        }
    }
    return ss_output_drain(&writer->out);
}

ss_status
ss_coefficient_writer_end(ss_coefficient_writer *writer, size_t samples)
{
    if (writer == NULL)
        return SS_EINVAL;
    char au[WIDTH] = { 0 };
    if (writer->stream && writer->format == SS_AU) {
        ss_au_put(au + 16, (double)(samples - 1) / writer->rate);
        fwrite(au, 1, sizeof au, writer->out.file);
    } else if (writer->stream) {
        fprintf(writer->out.file, "# samples: %zu\n", samples);
    }
    return fflush(writer->out.file) == 0 && !ferror(writer->out.file) ? SS_OK : SS_EIO;
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
ss_coefficients_write(const ss_coefficients *coefficients, FILE *out, ss_format format)
{
    ss_coefficient_writer *writer = NULL;
    if (coefficients == NULL || coefficients->w == NULL)
        return SS_EINVAL;
    ss_status st = ss_coefficient_writer_new(&writer, out, format, coefficients->head);
    for (size_t i = 0; st == SS_OK && i < coefficients->n_scales; i++) {
        const ss_scale *scale = &coefficients->scale[i];
        st = ss_coefficient_writer_rows(writer, scale, 0, scale->n,
                                        coefficients->w + 2 * scale->offset, coefficients->n);
    }
    if (st == SS_OK)
        st = ss_coefficient_writer_end(writer, coefficients->n);
    ss_coefficient_writer_free(writer);
    return st;
}
