/* noise_level.h -- find the level at which noise begins in a map of |W|, in one pass. */
#ifndef NOISE_LEVEL_H
#define NOISE_LEVEL_H

#include <stddef.h>
#include <stickslip/morlet.h>

typedef struct noise_level noise_level;

noise_level *ss_noise_level_new(size_t n_scales);       /* NULL: no memory */
/* Add the coefficients first, first + step, ... below n of those of scale i, given by |W|^2 >= 0;
 * all lie outside the cone of influence.  Each counts step times. */
void ss_noise_level_add(noise_level *noise, size_t i, const double *power, size_t first, size_t n,
                        size_t step);
/* |W| at which noise begins; 0: none was found. */
double ss_noise_level(noise_level *noise, const ss_scale *scale);
void ss_noise_level_free(noise_level *noise);           /* NULL is allowed */

#endif
