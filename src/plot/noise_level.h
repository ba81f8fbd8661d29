/* noise_level.h -- find the level at which noise begins in a map of |W|, in one pass. */
#ifndef NOISE_LEVEL_H
#define NOISE_LEVEL_H

#include <stddef.h>
#include <stickslip/morlet.h>

typedef struct noise_level noise_level;

noise_level *ss_noise_level_new(size_t n_scales);       /* NULL: no memory */
/* Add those that measure noise among the coefficients first ... first + n - 1 of a scale, the i-th, given by |W|;
 * all lie outside the cone of influence. */
void ss_noise_level_add(noise_level *noise, const ss_scale *scale, size_t i, const double *level, size_t first,
                        size_t n);
/* |W| at which noise begins; 0: none was found. */
double ss_noise_level(noise_level *noise, const ss_scale *scale);
void ss_noise_level_free(noise_level *noise);           /* NULL is allowed */

#endif
