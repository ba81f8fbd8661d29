/* extent.h -- measure how long a single event lasts. */
#ifndef EXTENT_H
#define EXTENT_H

#include <stddef.h>
#include "features/window.h"

/* The first and the last sample of the event about sample at that are off a line through the quiet
 * samples before and behind it, within the samples of win; both are at where too few are quiet.
 * period: of what shows it best, in samples. */
ss_window ss_extent(const double *x, ss_window win, size_t at, double period);

#endif
