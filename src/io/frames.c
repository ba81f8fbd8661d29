/* frames.c -- samples as integers, as fractions of full scale, and as floating point, of either byte order. */
#include <math.h>
#include <string.h>
#include "base/error.h"
#include "io/frames.h"

double
ss_sample_raw(const char *p, sample_type type)
{
    uint64_t bits = ss_bytes_get(p, type.bytes, type.little_endian);
    if (type.is_float && type.bytes == sizeof(double)) {
        double x;
        memcpy(&x, &bits, sizeof x);
        return x;
    }
    if (type.is_float) {
        uint32_t half = (uint32_t)bits;
        float x;
        memcpy(&x, &half, sizeof x);
        return x;
    }
    uint64_t sign = UINT64_C(1) << (8 * type.bytes - 1);
    if (type.is_unsigned || bits < sign)
        return (double)bits;
    return -(double)(~bits & (sign - 1)) - 1;
}

static ss_status
refuse_rest(const struct frames *f, ss_error *err)
{
    return ss_fail(err, SS_EDATA, "%s: goes on after the %llu row%s that its header gives; head -c %llu "
                   "cuts it there", f->in->name, (unsigned long long)f->base.row,
                   PLURAL(f->base.row), (unsigned long long)f->end);
}

/* Skip chunks up to the end of the file.  Each has four letters, a length and so many bytes, as samples
 * hardly ever do.  The byte that makes an odd length even may be missing at the end. */
static ss_status
skip_chunks(struct frames *f, ss_error *err)
{
    enum { CHUNK_HEADER = 8 };
    struct input *in = f->in;
    for (uint64_t left = f->end % 2;;) {
        ss_status st = ss_input_skip(in, &left, err);
        if (st == SS_OK)
            st = ss_input_need(in, CHUNK_HEADER, err);
        if (st != SS_OK || (in->hi == in->lo && left <= 1))
            return st;
        const char *p = in->buffer + in->lo;
        int is_name = in->hi - in->lo >= CHUNK_HEADER;
        for (int i = 0; is_name && i < 4; i++)
            is_name = p[i] >= ' ' && p[i] <= '~';
        if (!is_name)
            return refuse_rest(f, err);
        left = ss_bytes_get(p + 4, 4, 1);
        left += left % 2;
        in->lo += CHUNK_HEADER;
    }
}

/* Integers become fractions of full scale, [-1, 1). */
static ss_status
give_frames(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct frames *f = (struct frames *)s;
    struct input *in = f->in;
    size_t frame = s->head->n_columns * f->type.bytes;
    for (; *n < max && f->bytes_left > 0; ++*n, s->row++) {
        unsigned long long row = s->row;
        if (*n > 0 && in->hi - in->lo < frame)
            break;
        ss_status st = ss_input_need(in, frame, err);
        if (st != SS_OK)
            return st;
        size_t there = in->hi - in->lo;
        if (there == 0 && f->bytes_left == UINT64_MAX)
            break;
        there = f->bytes_left < there ? (size_t)f->bytes_left : there;
        if (there < frame && there > 0)
            return ss_fail(err, SS_EDATA, "%s: truncated: %zu of %zu bytes of row %llu", in->name, there, frame,
                           row + 1);
        if (there < frame)
            return ss_fail(err, SS_EDATA, "%s: truncated: ends after row %llu, %llu bytes before the end that its "
                           "header gives", in->name, row, (unsigned long long)f->bytes_left);
        for (size_t c = 0; c < s->head->n_columns; c++) {
            double x = ss_sample_raw(in->buffer + in->lo + c * f->type.bytes, f->type);
            if (!f->type.is_float)
                x = ldexp(x, 1 - 8 * (int)f->type.bytes) - (f->type.is_unsigned ? 1 : 0);
            if (column[c] != NULL)
                column[c][*n] = x;
            if (!isfinite(x))
                return ss_fail(err, SS_EDATA, "%s: row %llu, column %s: not a finite number", in->name, row + 1,
                               s->head->column[c].name);
        }
        in->lo += frame;
        if (f->bytes_left != UINT64_MAX)
            f->bytes_left -= frame;
    }
    if (*n > 0 || f->bytes_left > 0 || f->end == 0)
        return SS_OK;
    if (f->is_chunk)
        return skip_chunks(f, err);
    /* if bytes follow the data, either they or the length that the header gives is wrong */
    ss_status st = ss_input_need(in, 1, err);
    return st == SS_OK && in->hi > in->lo ? refuse_rest(f, err) : st;
}

struct frames *
ss_frames_new(struct input *in, ss_error *err)
{
    static const struct source_calls calls = { .next = give_frames };
    struct frames *f = ss_source_new(sizeof *f, &calls, in->name, err);
    if (f != NULL)
        f->in = in;
    return f;
}

ss_status
ss_frames_columns(ss_header *head, size_t n)
{
    char name[32];
    ss_status st = SS_OK;
    for (size_t i = 1; st == SS_OK && i <= n; i++) {
        snprintf(name, sizeof name, "ch%zu", i);
        st = ss_header_add_column(head, name, "", NULL);
    }
    return st;
}
