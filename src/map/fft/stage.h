/* stage.h -- the tables and plans that blocks.c makes for windows.c and translations.c. */
#ifndef STAGE_H
#define STAGE_H

#include <fftw3.h>
#include <stddef.h>
#include "map/fft/blocks.h"
#include "map/points.h"

enum { LEVELS = BLOCK_LEVELS };

/* A level of n samples, margin more on either side. */
typedef struct stage {
    size_t n, length, overlap, hop, windows;        /* window i begins at sample (i - 1) hop */
    size_t circle;                          /* samples of the record in a window */
    size_t margin, stride;                  /* doubles from a spectrum to the next */
    int used;                               /* by a scale: spectra are kept */
    double *filter;                         /* F_k / L, k <= L/4, then F_(L/2-k) / L; NULL: the last */
    fftw_plan forward, next;                /* to the spectrum, and from its half to the next level */
    fftw_plan of_next, back;                /* the other way, for the adjoint */
} stage;

/* A scale and the weights of its terms. */
typedef struct block_scale {
    int level;                              /* -1: not here */
    enum { AT_POINTS, BETWEEN, EACH } kind; /* EACH: one a sample, at places that repeat */
    size_t points, hop;                     /* M, and translations from a window to the next if it is
                                               not BETWEEN */
    ptrdiff_t lo, mid;                      /* the first term, and the one that becomes term 0 */
    size_t terms;
    double *weight;
    const weights *places;                  /* of EACH, one of those below */
    fftw_plan inverse;
} block_scale;

struct blocks {
    size_t n_scales, levels, longest;       /* longest: M */
    size_t most;                            /* translations of EACH that are written at a time */
    double margin;                          /* samples */
    double rate;                            /* [Hz] */
    const ss_scale *grid;                   /* the plan's scales */
    kaiser *kernel;                         /* for translations between points */
    weights *places[2 * LEVELS];            /* of EACH */
    size_t n_places;
    block_scale *scale;
    stage stage[LEVELS];
    struct shared_plan *plans;              /* all that are used here, one of each kind and length */
};

/* Doubles that a thread needs. */
size_t ss_blocks_room(const struct blocks *b);
/* Make the plans of all levels and scales that are used here; those of the adjoint only if that is wanted. */
ss_status ss_blocks_plan(struct blocks *b, int adjoint);

/* The adjoint of the transform: for each window a sum over coefficients in place of its spectrum. */
struct block_sums {
    const struct blocks *b;
    double *level[LEVELS];                  /* of levels in use, from window 0 on */
    double *v;                              /* a window's samples, its spectrum, half a spectrum */
};

/* Windows that hold n samples' coefficients. */
static inline size_t
windows_for(const stage *st, size_t n)
{
    return (n + st->hop - 1) / st->hop;
}

#endif
