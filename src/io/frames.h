/* frames.h -- the data of sound files: frames of one value a channel, of one type. */
#ifndef FRAMES_H
#define FRAMES_H

#include "io/format.h"

typedef struct sample_type {    /* integers are signed, big-endian comes first */
    unsigned bytes;
    int is_float, is_unsigned, little_endian;
} sample_type;

/* Add columns ch1, ch2, ... for n channels without names. */
ss_status ss_frames_columns(ss_header *head, size_t n);
/* A source of the frames that follow in the input; its columns are the channels. */
struct frames {
    ss_source base;
    struct input *in;
    sample_type type;
    uint64_t bytes_left;        /* UINT64_MAX: up to the end of the file */
    uint64_t end;               /* if > 0, the frames end at this byte of the file, and nothing may follow them */
    int is_chunk;               /* 1: except further chunks of a WAV file */
};
struct frames *ss_frames_new(struct input *in, ss_error *err);

/* An unsigned integer of n bytes in a file. */
static inline uint64_t
ss_bytes_get(const char *from, unsigned n, int little_endian)
{
    uint64_t x = 0;
    for (unsigned i = 0; i < n; i++)
        x = x << 8 | (unsigned char)from[little_endian ? n - 1 - i : i];
    return x;
}
/* Store it; returns its end. */
static inline char *
ss_bytes_put(char *to, uint64_t x, unsigned n, int little_endian)
{
    for (unsigned i = 0; i < n; i++)
        to[i] = (char)(x >> 8 * (little_endian ? i : n - 1 - i) & 0xff);
    return to + n;
}

/* One value without scaling: an integer, or floating point. */
double ss_sample_raw(const char *p, sample_type type);

#endif
