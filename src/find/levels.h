/* levels.h -- the middle one of many levels. */
#ifndef LEVELS_H
#define LEVELS_H

#include <stddef.h>

/* The middle one of n >= 1 levels, all >= 0: n / 2 others are not above it.  The levels change places. */
double ss_levels_middle(double *level, size_t n);

#endif
