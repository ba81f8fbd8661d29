/* au.c -- Sun AU: PCM of 8 to 32 bits and floating point, big-endian; 64-bit floating point is written.
 *
 * In the files that we write, the annotation is the header of our text, which has facts that AU cannot store.
 * Another program (SoX) may have changed the samples and kept the annotation, so its rate and columns are used
 * only if they agree with those of the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/format.h"
#include "io/frames.h"

/* A header within these limits is accepted; its annotation follows the fixed part. */
enum { FIXED_HEADER = 24, MAX_ANNOTATION = 1 << 20, MAX_CHANNELS = 4096 };

#define UNKNOWN_SIZE UINT32_C(0xffffffff)

/* Bytes of a value for each encoding of the file; 0 if it is not supported. */
static const unsigned width[] = { 0, 0, 1, 2, 3, 4, 4, 8 };
enum { ENCODING_FLOAT = 6, ENCODING_DOUBLE = 7 };

/* The nearest rate in whole Hz, which is all that AU has; the annotation has the exact rate. */
static uint32_t
whole_rate(double rate)
{
    return rate < 1 ? 1 : rate < UINT32_MAX ? (uint32_t)rint(rate) : UINT32_MAX;
}

/* Take our header from the annotation, if it is there and has the columns of the file. */
static ss_status
make_header(ss_source *s, ss_kind kind, char *annotation, uint32_t rate, size_t channels, ss_error *err)
{
    const char *magic = ss_kind_magic(kind), *reason = "";
    size_t n = strlen(magic), length;
    ss_header *own = s->head, *head = NULL;
    ss_status st = SS_OK;
    if (strncmp(annotation, magic, n) == 0 && annotation[n] == '\n')
        st = ss_header_new(&head, 0, 0, NULL);
    for (char *line = annotation + (head != NULL ? n + 1 : 0); head != NULL && st == SS_OK && *line == '#';) {
        char *next = line + (length = strcspn(line, "\n"));
        next += *next == '\n';
        line[length] = '\0';
        st = ss_header_read_line(head, line, &reason);
        line = next;
    }
    if (st == SS_OK && head != NULL && head->n_columns == channels) {
        s->head = head;
        head = own;
    } else if (st == SS_OK)
        st = ss_frames_columns(own, channels);
    ss_header_free(head);
    if (!(s->head->rate > 0) || whole_rate(s->head->rate) != rate)
        s->head->rate = rate;
    return st == SS_EDATA ? ss_fail(err, st, "%s: AU annotation: %s", s->name, reason)
        : st == SS_OK ? st : ss_fail_memory(err, s->name);
}

static ss_status
open_au(ss_source **out, const struct opening *o, ss_error *err)
{
    struct input *in = o->in;
    struct frames *f = ss_frames_new(in, err);
    if (f == NULL)
        return SS_ENOMEM;
    *out = &f->base;
    ss_status st = ss_input_whole(in, FIXED_HEADER, "AU header", err);
    if (st != SS_OK)
        return st;
    uint32_t field[6];
    for (int i = 0; i < 6; i++)
        field[i] = (uint32_t)ss_bytes_get(in->buffer + in->lo + 4 * i, 4, 0);
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
    st = ss_input_whole(in, offset, "AU annotation", err);
    if (st != SS_OK)
        return st;

    char *annotation = strndup(in->buffer + in->lo + FIXED_HEADER, offset - FIXED_HEADER);
    st = annotation == NULL ? ss_fail_memory(err, in->name)
        : ss_fail_kind(err, in->name, annotation, strlen(annotation), o->kind);
    if (st == SS_OK)
        st = make_header(&f->base, o->kind, annotation, field[4], channels, err);
    free(annotation);
    if (st != SS_OK)
        return st;
    in->lo += offset;
    /* a program that meant to fill in the size at the end leaves 0 */
    f->type = (sample_type){ .bytes = width[encoding], .is_float = encoding >= ENCODING_FLOAT };
    f->bytes_left = size == UNKNOWN_SIZE || size == 0 ? UINT64_MAX : size;
    f->end = (uint64_t)offset + size;
    return ss_refuse_clock(in->name, f->base.head->rate, o->opts, err);
}

enum { ANNOTATION_UNIT = 8 };

static ss_status
begin_au(FILE *out, const ss_header *head, const char *magic, ss_error *err)
{
    size_t length;
    char *text;
    ss_status st = ss_header_text(&text, &length, head, magic, err);
    if (st != SS_OK)
        return st;
    size_t padding = ANNOTATION_UNIT - length % ANNOTATION_UNIT;        /* at least one NUL */
    if (head->n_columns > MAX_CHANNELS || length + padding > MAX_ANNOTATION) {
        free(text);
        return ss_fail(err, SS_EINVAL, "AU holds at most %d columns and a header of %d MiB",
                       MAX_CHANNELS, MAX_ANNOTATION >> 20);
    }
    char fixed[FIXED_HEADER];
    uint32_t field[6] = { 0x2e736e64, (uint32_t)(sizeof fixed + length + padding), UNKNOWN_SIZE,
                          ENCODING_DOUBLE, whole_rate(head->rate), (uint32_t)head->n_columns };
    for (int i = 0; i < 6; i++)
        ss_bytes_put(fixed + 4 * i, field[i], 4, 0);
    fwrite(fixed, 1, sizeof fixed, out);
    fwrite(text, 1, length, out);
    fwrite("\0\0\0\0\0\0\0", 1, padding, out);
    free(text);
    return ferror(out) ? SS_EIO : SS_OK;
}

static size_t
encode_number(char *to, double x, int last)
{
    (void)last;
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    ss_bytes_put(to, bits, sizeof bits, 0);     /* compilers make one instruction of it */
    return sizeof bits;
}

FORMAT(au) = {
    .name = "au",
    .magic = ".snd",
    .has_header = 1,
    .open = open_au,
    .begin = begin_au,
    .number = encode_number,
};
