/* basins.h -- the peaks of a map of |W|, and the borders between their basins.
 *
 * From each point of the map a way leads up to a peak.  All points whose ways lead to the same peak
 * are its basin. */
#ifndef BASINS_H
#define BASINS_H

#include <stdint.h>
#include <stickslip/morlet.h>

typedef struct peak {
    size_t row, k;              /* its coefficient */
    double level;               /* |W| > 0 */
} peak;

/* Between the basins of peaks p < q.  Of several between the same two, the highest counts. */
typedef struct border {
    uint64_t key;               /* |W| > 0, as its bits, which are ordered as the numbers are */
    uint32_t p, q;
} border;

typedef struct basins {
    const ss_coefficients *map;
    size_t first, last;         /* the rows that were searched */
    double floor;               /* |W| >= 0; points that are not above it belong to no basin */
    double top;                 /* ss_coefficients_max of these rows */
    size_t n_peaks, n_borders;
    peak *peak;
    border *border;             /* in any order */
} basins;

/* Find the basins of rows first ... last.  Free them with ss_basins_free, also if this fails. */
ss_status ss_basins_find(basins *out, const ss_coefficients *map, size_t first, size_t last,
                         double floor);
void ss_basins_free(basins *b);

#endif
