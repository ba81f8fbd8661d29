/* blocks.h -- coefficients of a stepped grid by short FFTs, octave by octave. */
#ifndef BLOCKS_H
#define BLOCKS_H

#include <stddef.h>
#include "morlet/plan.h"

/* Choose the scales that are transformed in blocks: where a step is 2^p/m samples and that is
 * cheaper, or the engine is SS_ENGINE_FFT.  plan->blocks stays NULL if there are none.  SS_ENOMEM. */
ss_status ss_blocks_new(ss_morlet *plan);
void ss_blocks_free(struct blocks *blocks);           /* NULL is allowed */
int ss_blocks_covers(const struct blocks *blocks, size_t i);     /* blocks may be NULL */

/* The record's spectra, window by window; free it, forward failed or not. */
ss_status ss_blocks_forward(const struct blocks *blocks, const record *rec, block_spectra *out);
void ss_block_spectra_free(block_spectra *s);

/* Doubles that a thread needs, from fftw_malloc. */
size_t ss_blocks_room(const struct blocks *blocks);
/* Part of scale i, factor times what it is in units of a^1/2 and of the record. */
void ss_blocks_scale(const struct blocks *blocks, size_t i, const block_spectra *s, double *scratch,
                     span part, double factor, double *w);

#endif
