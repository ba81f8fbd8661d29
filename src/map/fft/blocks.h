/* blocks.h -- coefficients of a stepped grid by short FFTs, octave by octave. */
#ifndef BLOCKS_H
#define BLOCKS_H

#include <stddef.h>
#include "map/plan.h"

/* Choose the scales that are transformed in blocks: all that can be, unless the engine is
 * SS_ENGINE_QUADRATURE.  plan->blocks stays NULL if there are none.  SS_ENOMEM. */
ss_status ss_blocks_new(ss_morlet *plan);
void ss_blocks_free(struct blocks *blocks);           /* NULL is allowed */
int ss_blocks_covers(const struct blocks *blocks, size_t i);     /* blocks may be NULL */

/* The record's spectra, window by window; free it, forward failed or not. */
ss_status ss_blocks_forward(const struct blocks *blocks, const record *rec, spectra *out);

/* What one thread needs for parts, NULL without blocks; SS_ENOMEM. */
ss_status ss_blocks_scratch(const struct blocks *blocks, double **scratch);
void ss_blocks_scratch_free(double *scratch);         /* NULL is allowed */
/* Part of scale i, factor times what it is in units of a^1/2 and of the record. */
void ss_blocks_scale(const struct blocks *blocks, size_t i, const spectra *s, double *scratch,
                     span part, double factor, double *w);

/* The adjoint of the transform.  NULL: no memory. */
typedef struct block_sums block_sums;
block_sums *ss_block_sums_new(struct blocks *blocks);
void ss_block_sums_free(block_sums *sums);            /* NULL is allowed */
/* Add the coefficients w of a part of scale i, all of one window, times factor. */
void ss_block_sums_add(block_sums *sums, size_t i, double *scratch, span part, double factor, const double *w);
/* Add to the record's samples x what the sums make of them, and set the sums to 0.  SS_ENOMEM. */
ss_status ss_block_sums_end(block_sums *sums, double *x);

/* The level of scale i, its translations up to the end of a window, and how many a window holds, at most. */
size_t ss_blocks_level(const struct blocks *blocks, size_t i);
size_t ss_blocks_end(const struct blocks *blocks, size_t i, size_t window);
size_t ss_blocks_most(const struct blocks *blocks, size_t i);
/* Translations from k on up to the end of its window. */
size_t ss_blocks_rest(const struct blocks *blocks, size_t i, size_t k);
/* Less than so many samples of a stream come after a translation before its window is full. */
double ss_blocks_delay(const struct blocks *blocks, size_t i);

/* The levels of a stream.  A sink gets the spectrum of a window, valid during the call only; what it
 * returns, unless SS_OK, ends the work.  NULL: no memory. */
typedef struct cascade cascade;
typedef ss_status window_sink(size_t level, size_t window, double *spectrum, void *user);
cascade *ss_cascade_new(const struct blocks *blocks);
void ss_cascade_free(cascade *c);                      /* NULL is allowed */
/* Divide all samples that are there: see ss_morlet_divide. */
void ss_cascade_divide(cascade *c, int exponent, double most);
/* Samples that the first level's window lacks, >= 1; at most so many more, and where they now stand; then the
 * windows that are full now. */
size_t ss_cascade_room(const cascade *c);
double *ss_cascade_append(cascade *c, const double *x, size_t n);
ss_status ss_cascade_run(cascade *c, window_sink *sink, void *user);
/* All windows of what is there, n samples so far, as if the signal ended here, and then going on with
 * it is still possible.  SS_ENOMEM. */
ss_status ss_cascade_end(const cascade *c, size_t n, window_sink *sink, void *user);

#endif
