/* au.c -- Sun AU: PCM of 8 to 32 bits and floating point, big-endian; 64-bit floating point is written.
 *
 * When we wrote it the annotation is the header of our text form, with what AU itself cannot say.
 * A program between (SoX) may have passed it on beside samples that it has changed, so the rate and
 * the columns are believed only where they agree with the file's own. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"
#include "stream/au.h"
#include "stream/clock.h"
#include "stream/format.h"
#include "stream/reader.h"

/* What is believed; the annotation is the rest of the header. */
enum { FIXED_HEADER = 24, MAX_ANNOTATION = 1 << 20, MAX_CHANNELS = 4096 };

#define UNKNOWN_SIZE UINT32_C(0xffffffff)

/* Bytes a value, by the encoding of the file; 0 is not supported. */
static const size_t width[] = { 0, 0, 1, 2, 3, 4, 4, 8 };

static uint64_t
big_endian(const unsigned char *p, size_t n)
{
    uint64_t x = 0;
    for (size_t i = 0; i < n; i++)
        x = x << 8 | p[i];
    return x;
}

static double
decode(const unsigned char *p, int encoding)
{
    uint64_t bits = big_endian(p, width[encoding]);
    if (encoding == 7) {
        double x;
        memcpy(&x, &bits, sizeof x);
        return x;
    }
    if (encoding == 6) {
        uint32_t half = (uint32_t)bits;
        float x;
        memcpy(&x, &half, sizeof x);
        return x;
    }
    double full = ldexp(1, 8 * (int)width[encoding] - 1);   /* two's complement, to [-1, 1) */
    return (double)bits / full - ((double)bits >= full ? 2 : 0);
}

static ss_status
refuse_end(const ss_reader *reader, size_t frame, size_t rest, ss_error *err)
{
    unsigned long long row = reader->row;
    if (rest > 0)
        return ss_fail(err, SS_EDATA, "%s: truncated: %zu of %zu bytes of row %llu",
                       reader->in.name, rest, frame, row + 1);
    return ss_fail(err, SS_EDATA, "%s: truncated: ends after row %llu, %llu bytes before the end "
                   "that its header gives", reader->in.name, row,
                   (unsigned long long)reader->bytes_left);
}

static ss_status
decode_row(ss_reader *reader, const char *p, double *row, ss_error *err)
{
    size_t bytes = width[reader->encoding];
    for (size_t c = 0; c < reader->head->n_columns; c++) {
        row[c] = decode((const unsigned char *)p + c * bytes, reader->encoding);
        if (!isfinite(row[c]))
            return ss_fail(err, SS_EDATA, "%s: row %llu, column %s: not a finite number",
                           reader->in.name, (unsigned long long)reader->row + 1,
                           reader->head->column[c].name);
    }
    reader->row++;
    return SS_OK;
}

/* Behind the data that the header gives there must be nothing: which of the two is right? */
static ss_status
refuse_more(ss_reader *reader, ss_error *err)
{
    struct input *in = &reader->in;
    ss_status st = ss_input_need(in, 1, err);
    if (st != SS_OK || in->hi == in->lo)
        return st;
    return ss_fail(err, SS_EDATA, "%s: goes on after the %llu rows that its header gives; head -c %llu "
                   "cuts it there", in->name, (unsigned long long)reader->row,
                   (unsigned long long)reader->end);
}

static ss_status
au_rows(ss_reader *reader, double *rows, size_t max, size_t *n, ss_error *err)
{
    struct input *in = &reader->in;
    size_t n_columns = reader->head->n_columns, frame = n_columns * width[reader->encoding];
    for (; *n < max && reader->bytes_left > 0; ++*n) {
        if (*n > 0 && in->hi - in->lo < frame)
            break;
        ss_status st = ss_input_need(in, frame, err);
        if (st != SS_OK)
            return st;
        size_t there = in->hi - in->lo;
        if (there == 0 && reader->bytes_left == UINT64_MAX)
            break;
        if (there < frame || reader->bytes_left < frame)
            return refuse_end(reader, frame, reader->bytes_left < there
                              ? (size_t)reader->bytes_left : there, err);
        st = decode_row(reader, in->buffer + in->lo, rows + *n * n_columns, err);
        if (st != SS_OK)
            return st;
        in->lo += frame;
        if (reader->bytes_left != UINT64_MAX)
            reader->bytes_left -= frame;
    }
    return *n == 0 && reader->bytes_left == 0 ? refuse_more(reader, err) : SS_OK;
}

/* The columns that a file without names has. */
static ss_status
number_channels(ss_header *head, size_t n)
{
    char name[32];
    ss_status st = SS_OK;
    for (size_t i = 1; st == SS_OK && i <= n; i++) {
        snprintf(name, sizeof name, "ch%zu", i);
        st = ss_header_add_column(head, name, "");
    }
    return st;
}

/* Our header in the annotation: gives *out NULL if it is none or is malformed. */
static ss_status
read_annotation(ss_header **out, const char *magic, char *text)
{
    const char *reason;
    ss_status st = SS_OK;
    ss_header *head = *out = NULL;
    size_t length_of_magic = strlen(magic);
    if (strncmp(text, magic, length_of_magic) != 0 || text[length_of_magic] != '\n')
        return SS_OK;
    head = ss_header_new(0, 0);
    if (head == NULL)
        return SS_ENOMEM;
    for (char *line = text + length_of_magic + 1, *next; st == SS_OK && *line == '#'; line = next) {
        size_t length = strcspn(line, "\n");
        next = line + length + (line[length] == '\n');
        line[length] = '\0';
        st = ss_header_take(head, line, &reason);
    }
    if (st != SS_OK) {
        ss_header_free(head);
        return st == SS_ENOMEM ? st : SS_OK;
    }
    *out = head;
    return SS_OK;
}

/* The nearest whole Hz that AU can say; the annotation has the exact rate. */
static uint32_t
whole_rate(double rate)
{
    return rate < 1 ? 1 : rate < UINT32_MAX ? (uint32_t)rint(rate) : UINT32_MAX;
}

static ss_status
make_header(ss_reader *reader, char *annotation, uint32_t rate, size_t channels)
{
    ss_header *head;
    ss_status st = read_annotation(&head, reader->magic, annotation);
    if (st != SS_OK)
        return st;
    if (head != NULL && head->n_columns == channels) {
        ss_header_free(reader->head);
        reader->head = head;
    } else {
        ss_header_free(head);
        st = number_channels(reader->head, channels);
    }
    if (!(reader->head->rate > 0) || whole_rate(reader->head->rate) != rate)
        reader->head->rate = rate;
    return st;
}

ss_status
ss_au_open(ss_reader *reader, const ss_read_opts *opts, ss_error *err)
{
    struct input *in = &reader->in;
    ss_status st = ss_input_need(in, FIXED_HEADER, err);
    if (st != SS_OK)
        return st;
    if (in->hi - in->lo < FIXED_HEADER)
        return ss_fail(err, SS_EDATA, "%s: truncated AU header", in->name);
    const unsigned char *p = (unsigned char *)in->buffer + in->lo;
    uint32_t field[6];
    for (int i = 0; i < 6; i++)
        field[i] = (uint32_t)big_endian(p + 4 * i, 4);
    uint32_t offset = field[1], size = field[2], encoding = field[3], channels = field[5];

    if (offset < FIXED_HEADER || offset > FIXED_HEADER + MAX_ANNOTATION)
        return ss_fail(err, SS_EDATA, "%s: AU header: impossible offset of the data, %lu", in->name,
                       (unsigned long)offset);
    if (encoding >= sizeof width / sizeof *width || width[encoding] == 0)
        return ss_fail(err, SS_EDATA, "%s: AU encoding %lu is not supported; 2 to 7 are (PCM of 8 to "
                       "32 bits, floating point)", in->name, (unsigned long)encoding);
    if (channels < 1 || channels > MAX_CHANNELS || field[4] < 1)
        return ss_fail(err, SS_EDATA, "%s: AU header: impossible: %lu channels at %lu Hz", in->name,
                       (unsigned long)channels, (unsigned long)field[4]);
    st = ss_input_need(in, offset, err);
    if (st != SS_OK)
        return st;
    if (in->hi - in->lo < offset)
        return ss_fail(err, SS_EDATA, "%s: truncated AU annotation", in->name);

    char *annotation = strndup(in->buffer + in->lo + FIXED_HEADER, offset - FIXED_HEADER);
    const char *wanted = strcmp(reader->magic, SIGNAL_MAGIC) == 0 ? "a signal" : "wavelet coefficients";
    if (annotation != NULL
        && ss_fail_kind(err, in->name, annotation, strlen(annotation), wanted) != SS_OK) {
        free(annotation);
        return SS_EKIND;
    }
    st = annotation != NULL ? make_header(reader, annotation, field[4], channels) : SS_ENOMEM;
    free(annotation);
    if (st != SS_OK)
        return ss_fail(err, st, "%s: %s", in->name, ss_strerror(st));
    in->lo += offset;
    reader->encoding = (int)encoding;
    /* 0 is what a program leaves that meant to fill it in at the end. */
    reader->bytes_left = size == UNKNOWN_SIZE || size == 0 ? UINT64_MAX : size;
    reader->end = (uint64_t)offset + size;
    reader->rows = au_rows;
    return ss_refuse_clock(in->name, reader->head->rate, opts, err);
}

/* --- writing ------------------------------------------------------------------------------- */

enum { ANNOTATION_UNIT = 8, ENCODING_DOUBLE = 7 };

static void
put_big_endian(char *p, uint64_t x, size_t n)
{
    for (; n-- > 0; x >>= 8)
        p[n] = (char)(x & 0xff);
}

static void
write_header(FILE *out, const ss_header *head, const char *text, size_t length, size_t padding)
{
    char fixed[FIXED_HEADER];
    uint32_t field[6] = { 0x2e736e64, (uint32_t)(sizeof fixed + length + padding), UNKNOWN_SIZE,
                          ENCODING_DOUBLE, whole_rate(head->rate), (uint32_t)head->n_columns };
    for (int i = 0; i < 6; i++)
        put_big_endian(fixed + 4 * i, field[i], 4);
    fwrite(fixed, 1, sizeof fixed, out);
    fwrite(text, 1, length, out);
    fwrite("\0\0\0\0\0\0\0", 1, padding, out);
}

/* SS_EINVAL if AU is too narrow for the header. */
static ss_status
begin_au(FILE *out, const ss_header *head, const char *magic)
{
    size_t length;
    char *text = ss_header_text(head, magic, &length);
    if (text == NULL)
        return SS_ENOMEM;
    size_t padding = ANNOTATION_UNIT - length % ANNOTATION_UNIT;        /* NULs, at least one */
    int fits = head->n_columns <= MAX_CHANNELS && length + padding <= MAX_ANNOTATION;
    if (fits)
        write_header(out, head, text, length, padding);
    free(text);
    return !fits ? SS_EINVAL : ferror(out) ? SS_EIO : SS_OK;
}

static size_t
put_number(char *to, double x, int last)
{
    (void)last;
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    for (size_t i = 0; i < sizeof bits; i++)
        to[i] = (char)(bits >> (56 - 8 * i) & 0xff);
    return sizeof bits;
}

const struct format ss_format_au = {
    .name = "au",
    .magic = ".snd",
    .open = ss_au_open,
    .begin = begin_au,
    .number = put_number,
};
