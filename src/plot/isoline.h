/* isoline.h -- lines of equal height on a rectangle of heights. */
#ifndef ISOLINE_H
#define ISOLINE_H

#include <stddef.h>
#include <stickslip/status.h>

typedef struct isoline_map {
    size_t nx, ny;              /* >= 2 each */
    const double *height;       /* finite, row after row: height[j * nx + i] */
} isoline_map;

/* One line of n >= 2 points in units of the grid; a closed one ends where it began.  high_left: 1 if heights on
 * its left are at the level or above it, those on its right below; 0 if it is the other way round. */
typedef void isoline_sink(const double (*point)[2], size_t n, int high_left, void *user);

/* Pass every line at this level to the sink, those that end at the border first. */
ss_status ss_isolines(const isoline_map *map, double level, isoline_sink *sink, void *user);

#endif
