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
    uint64_t row;               /* the number of the next one */
};
struct frames *ss_frames_new(struct input *in, ss_error *err);

/* One value without scaling: an integer, or floating point. */
double ss_sample_raw(const unsigned char *p, sample_type type);

#endif
