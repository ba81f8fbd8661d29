/* wav.c -- WAV: PCM of 8 to 32 bits and floating point, little-endian; 64-bit floating point is written.
 *
 * A WAV file consists of chunks.  A chunk has a name, a length, and so many bytes, padded to an
 * even number.  "fmt " describes the contents of "data"; other chunks are skipped.  A program that
 * writes to a pipe does not know the lengths and writes a number near 2^31 or 2^32, or zero.  The
 * data then end with the file, unless it has so many bytes.  A length is refused if the file
 * continues behind it with something that is not a chunk, as in AU. */
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include "base/error.h"
#include "io/frames.h"

enum {
    RIFF_HEADER = 12, CHUNK_HEADER = 8, FMT_LEAST = 16, FMT_EXTENSIBLE = 40, FMT_MOST = 4096,
    MAX_CHUNKS = 1000, MAX_CHANNELS = 4096,
    CODE_PCM = 1, CODE_FLOAT = 3, CODE_EXTENSIBLE = 0xfffe
};
/* A length from here on is unknown: SoX writes this one, other programs 2^31 - 1 or 2^32 - 1. */
#define UNKNOWN_FROM UINT32_C(0x7ffff000)

static uint32_t
little_endian(const char *at, unsigned n)
{
    return (uint32_t)ss_bytes_get(at, n, 1);
}

/* Read the contents of "fmt ", which are so long and stay where they are. */
static ss_status
read_format(struct frames *f, uint32_t length, unsigned *channels, ss_error *err)
{
    struct input *in = f->in;
    if (length < FMT_LEAST || length > FMT_MOST)
        return ss_fail(err, SS_EDATA, "%s: WAV header: a format of %lu bytes", in->name, (unsigned long)length);
    ss_status st = ss_input_whole(in, length, "WAV header", err);
    if (st != SS_OK)
        return st;
    const char *p = in->buffer + in->lo;
    unsigned code = little_endian(p, 2), frame = little_endian(p + 12, 2), bits = little_endian(p + 14, 2);
    uint32_t rate = little_endian(p + 4, 4);
    *channels = little_endian(p + 2, 2);
    if (code == CODE_EXTENSIBLE && length >= FMT_EXTENSIBLE)
        code = little_endian(p + 24, 2);
    int known = code == CODE_PCM ? bits >= 8 && bits <= 32 && bits % 8 == 0
        : code == CODE_FLOAT && (bits == 32 || bits == 64);
    if (!known)
        return ss_fail(err, SS_EDATA, "%s: WAV of code %u with %u bits is not supported; PCM of 8, 16, "
                       "24 and 32 bits and floating point are", in->name, code, bits);
    if (*channels < 1 || *channels > MAX_CHANNELS || rate < 1)
        return ss_fail(err, SS_EDATA, "%s: WAV header: impossible: %u channels at %lu Hz", in->name, *channels,
                       (unsigned long)rate);
    if (frame != 0 && frame != *channels * bits / 8)
        return ss_fail(err, SS_EDATA, "%s: WAV header: impossible: %u channels of %u bits in %u bytes",
                       in->name, *channels, bits, frame);
    f->base.head->rate = rate;
    f->type = (sample_type){ .bytes = bits / 8, .is_float = code == CODE_FLOAT, .is_unsigned = bits == 8,
                             .little_endian = 1 };
    return SS_OK;
}

/* Read the chunks before the data.  *place becomes the place of the data in the file, *length its length. */
static ss_status
read_chunks(struct frames *f, unsigned *channels, uint64_t *place, uint32_t *length, ss_error *err)
{
    struct input *in = f->in;
    *place = RIFF_HEADER;
    for (int i = 0; i < MAX_CHUNKS; i++) {
        ss_status st = ss_input_whole(in, CHUNK_HEADER, "WAV header", err);
        if (st != SS_OK)
            return st;
        char name[4];
        memcpy(name, in->buffer + in->lo, sizeof name);
        *length = little_endian(in->buffer + in->lo + 4, 4);
        uint64_t left = (uint64_t)*length + *length % 2;
        in->lo += CHUNK_HEADER;
        *place += CHUNK_HEADER;
        if (memcmp(name, "data", 4) == 0)
            return *channels > 0 ? SS_OK
                : ss_fail(err, SS_EDATA, "%s: WAV header: data before their format", in->name);
        *place += left;
        if (memcmp(name, "fmt ", 4) == 0)
            st = read_format(f, *length, channels, err);
        if (st == SS_OK && (st = ss_input_skip(in, &left, err)) == SS_OK && left > 0)
            st = ss_fail(err, SS_EDATA, "%s: truncated WAV header", in->name);
        if (st != SS_OK)
            return st;
    }
    return ss_fail(err, SS_EDATA, "%s: WAV header: no data in the first %d chunks", in->name, MAX_CHUNKS);
}

static ss_status
open_wav(ss_source **out, const struct opening *o, ss_error *err)
{
    struct input *in = o->in;
    unsigned channels = 0;
    uint32_t length = 0;
    uint64_t place = 0;
    struct frames *f = ss_frames_new(in, err);
    if (f == NULL)
        return SS_ENOMEM;
    *out = &f->base;
    ss_status st = ss_input_whole(in, RIFF_HEADER, "WAV header", err);
    if (st != SS_OK)
        return st;
    uint32_t all = little_endian(in->buffer + in->lo + 4, 4);
    in->lo += RIFF_HEADER;
    if ((st = read_chunks(f, &channels, &place, &length, err)) != SS_OK)
        return st;
    if ((st = ss_frames_columns(f->base.head, channels)) != SS_OK)
        return ss_fail(err, st, "%s: %s", in->name, ss_strerror(st));
    int unknown = (length >= UNKNOWN_FROM && !(in->size >= (double)(place + length))) || (length == 0 && all == 0);
    f->bytes_left = unknown ? UINT64_MAX : length;
    f->end = place + length;
    f->is_chunk = 1;
    return ss_refuse_clock(in->name, f->base.head->rate, o->opts, err);
}

enum { WRITTEN_HEADER = 58, WIDTH = sizeof(double) };

static char *
encode(char *to, uint64_t x, unsigned bytes)
{
    return ss_bytes_put(to, x, bytes, 1);
}

/* Store a name and the number behind it. */
static char *
encode_named(char *to, const char *name, uint64_t x)
{
    size_t n = strlen(name);
    memcpy(to, name, n);
    return encode(to + n, x, 4);
}

/* Write the header of so many rows; rows < 0: they are not known. */
static void
write_header(FILE *out, uint32_t rate, size_t channels, int64_t rows)
{
    char header[WRITTEN_HEADER], *to = header;
    size_t frame = channels * WIDTH;
    uint64_t length = rows < 0 ? UNKNOWN_FROM : (uint64_t)rows * frame;
    to = encode_named(to, "RIFF", length + WRITTEN_HEADER - CHUNK_HEADER);
    to = encode_named(to, "WAVEfmt ", FMT_LEAST + 2);
    to = encode(encode(to, CODE_FLOAT, 2), channels, 2);
    to = encode(encode(to, rate, 4), rate * frame, 4);
    to = encode(encode(encode(to, frame, 2), 8 * WIDTH, 2), 0, 2);
    to = encode(encode_named(to, "fact", 4), length / frame, 4);
    encode_named(to, "data", length);
    fwrite(header, 1, sizeof header, out);
}

static ss_status
begin_wav(FILE *out, const ss_header *head, const char *magic, ss_error *err)
{
    char rate[SS_NUMBER_MAX];
    ss_number_format(rate, head->rate);
    if (strcmp(magic, ss_kind_magic(SS_KIND_SIGNAL)) != 0)
        return ss_fail(err, SS_EINVAL, "WAV holds signals alone, no coefficients");
    if (head->n_columns < 1 || head->n_columns > MAX_CHANNELS)
        return ss_fail(err, SS_EINVAL, "WAV holds 1 to %d columns", MAX_CHANNELS);
    if (!(head->rate * (double)(head->n_columns * WIDTH) <= UINT32_MAX) || head->rate < rint(head->rate)
        || head->rate > rint(head->rate))
        return ss_fail(err, SS_EINVAL, "WAV holds rates of whole Hz, at most 2^32 bytes per second, not %s Hz; AU "
                       "keeps any rate; resample it to whole Hz", rate);
    write_header(out, (uint32_t)head->rate, head->n_columns, -1);
    return ferror(out) ? SS_EIO : SS_OK;
}

/* A pipe, and a file to which others have written before, keep the unknown length. */
static ss_status
end_wav(FILE *out, double rate, size_t columns, size_t rows, ss_error *err)
{
    off_t all = WRITTEN_HEADER + (off_t)(rows * columns * WIDTH);
    if (ftello(out) != all || (fileno(out) >= 0 && (fcntl(fileno(out), F_GETFL) & O_APPEND) != 0))
        return SS_OK;
    if (all > UINT32_MAX)
        return ss_fail(err, SS_EDATA, "WAV holds 4 GiB at most; AU and HDF5 hold more");
    fseeko(out, 0, SEEK_SET);
    write_header(out, (uint32_t)rate, columns, (int64_t)rows);
    return fseeko(out, all, SEEK_SET) == 0 ? SS_OK : SS_EIO;
}

static size_t
encode_number(char *to, double x, int last)
{
    (void)last;
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (size_t)(encode(to, bits, sizeof bits) - to);
}

FORMAT(wav) = { .name = "wav", .magic = "RIFF????WAVE", .open = open_wav, .begin = begin_wav,
                .number = encode_number, .end = end_wav };
