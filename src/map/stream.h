/* stream.h -- declarations that the files of a stream share: stream.c receives the samples,
 * stream_plan.c chooses the windows, stream_window.c computes one window. */
#ifndef STREAM_H
#define STREAM_H

#include "map/fft/blocks.h"
#include "map/plan.h"

enum {
    STREAM_PIECE = 1 << 14,     /* samples processed at a time, at most */
    GIVEN = 1 << 17             /* coefficients passed to the sink at a time, at most */
};

/* The state of a scale. */
typedef struct scale_state {
    size_t next;                /* its next translation */
    ptrdiff_t due;              /* the samples that it needs, from the first on */
    size_t count;               /* in the record; SIZE_MAX until that has ended */
    ptrdiff_t reach;            /* samples that a coefficient needs on either side, and one */
    span part;                  /* computed now */
    double most;                /* the largest |W| so far is most 2^exponent, in units of a^1/2 */
    int exponent;
    wavelet *wave;              /* NULL: made when needed */
} scale_state;

/* Scales that share their windows. */
typedef struct group {
    ss_morlet *plan;            /* its n is the length of a window */
    size_t first;               /* its scales are first ... first + plan->n_scales - 1 */
} group;

/* The work of one thread: scales first ... end - 1 of a window. */
typedef struct stream_worker {
    double *w, *scratch;        /* scratch: NULL if no scale needs it */
    const struct window *window;
    size_t first, end;
    ss_status status;
    ss_error error;
} stream_worker;

struct ss_stream {
    ss_morlet_opts opts;
    double rate;
    ss_coefficient_sink *sink;
    void *user;
    size_t n_scales, n_groups, samples;
    size_t full;                /* no window is full before there are so many samples */
    ss_scale *scale;
    ss_grid grid;               /* both, for callers */
    scale_state *state;
    group blocks;               /* the first scales, those in blocks, if any */
    cascade *cascade;           /* NULL: none are */
    group *group;               /* the others */
    stream_worker *worker;      /* as many as threads */
    size_t worker_room;         /* coefficients in w of a worker */
    double *x, x_max;           /* the last samples / 2^exponent, for groups; max|x| of all */
    int exponent;
    ptrdiff_t origin;           /* x[0] is this sample; there are zeros before the first */
    size_t room;                /* in x */
    int ended;
    ss_status status;           /* of what failed first */
    ss_error error;
};

/* Grid, groups, plans and buffers, in a stream that has nothing else yet. */
ss_status ss_stream_plan(ss_stream *s, ss_error *err);

/* Continue scale i at this translation. */
void ss_stream_continue(ss_stream *s, size_t i, size_t next);
/* The next translations of scale i that need no sample from limit on. */
size_t ss_stream_ready(const ss_stream *s, size_t i, ptrdiff_t limit);

/* The start of a group's next window; PTRDIFF_MAX if none is left. */
ptrdiff_t ss_group_start(const ss_stream *s, const group *g);
/* All coefficients of a group's window at start to the sink, of those that have arrived. */
ss_status ss_group_transform(ss_stream *s, const group *g, ptrdiff_t start, ss_error *err);

/* The coefficients in blocks whose windows are full to the sink; then all that need no sample from
 * limit on, PTRDIFF_MAX: all. */
ss_status ss_blocks_transform_full(ss_stream *s, ss_error *err);
ss_status ss_blocks_transform_rest(ss_stream *s, ptrdiff_t limit, ss_error *err);

#endif
