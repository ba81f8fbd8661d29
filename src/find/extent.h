/* extent.h -- measure how long a single event lasts. */
#ifndef EXTENT_H
#define EXTENT_H

#include <stddef.h>
#include "find/window.h"

/* Find the first and the last sample of the event about sample `at`: those farthest from it, within win,
 * that are off a line through the quiet samples before and behind the event.  Both become `at` if too few
 * samples are quiet.  period: of the oscillation that shows the event best, in samples. */
ss_window ss_extent(const double *x, ss_window win, size_t at, double period);

#endif
