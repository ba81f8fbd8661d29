/* stage.h -- the tables and plans that blocks.c and plans.c make for windows.c and translations.c. */
#ifndef STAGE_H
#define STAGE_H

#include <fftw3.h>
#include <stddef.h>
#include "map/fft/blocks.h"
#include "map/dense.h"
#include "map/places.h"

enum { LEVELS = BLOCK_LEVELS };

/* A list of plans, one of each kind and length; plans.c owns them. */
typedef struct shared_plan shared_plan;

/* A level of n samples, margin more on either side. */
typedef struct stage {
    size_t n, length, overlap, hop, windows;        /* window i begins at sample (i - 1) hop */
    size_t circle;                          /* samples of the record in a window */
    size_t margin, stride;                  /* doubles from a spectrum to the next */
    int used;                               /* by a scale: spectra are kept */
    double *filter;                         /* F_k / L, k <= L/4, then F_(L/2-k) / L; NULL: the last */
    fftw_plan forward, back;
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
    shared_plan *plans;
};

/* plans.c: make the plans of all levels and scales that are used here, for a scratch of so many doubles. */
ss_status ss_blocks_plans_make(struct blocks *b, size_t room);

/* The adjoint of the transform: for each window a sum over coefficients in place of its spectrum. */
struct block_sums {
    const struct blocks *b;
    double *level[LEVELS];                  /* of levels in use, from window 0 on */
    fftw_plan half[LEVELS], back[LEVELS];   /* from L/2 samples, and to L samples */
    shared_plan *plans;
    double *v;                              /* a window's samples, its spectrum, half a spectrum */
};

/* The same for its plans.  Free all plans of either. */
ss_status ss_sums_plans_make(struct block_sums *s);
void ss_plans_free(shared_plan *plans);

/* Windows that hold n samples' coefficients. */
static inline size_t
windows_for(const stage *st, size_t n)
{
    return (n + st->hop - 1) / st->hop;
}

#endif
