/* medians.h -- medians over slips and sticks, with errors that count what all of these have in common. */
#ifndef MEDIANS_H
#define MEDIANS_H

#include <stickslip/features.h>
#include "find/drops.h"
#include "find/window.h"

/* The median of those of n values that are numbers; scratch holds n. */
ss_number ss_median_of(const ss_value *v, size_t n, double *scratch);

/* Find the medians of the numbers of out->loading that are typical; shared: by the order of
 * a slip's numbers, the part of the variance of each that all slips share; damping:
 * their common one.  If fewer than half of the falls are slips of a pulled slider, these may
 * differ from the others; and if falls take long, too, the mass may slide before and behind them.  v and
 * scratch have room for all loadings. */
void ss_loading_medians(ss_features *out, const ss_drop *drop, const double *shared, const ss_number *damping,
                        ss_value *v, double *scratch);
/* The value that so large a part of the samples of a window is below; copy has room for them. */
double ss_quantile(const double *x, ss_window w, double part, double *copy);
/* The smallest change from one of n values to the next, as a converter's step; infinite: there is none. */
double ss_smallest_change(const double *x, size_t n);

/* The variance of the mean of n residuals y[i] - slope x[i] (x NULL: slope i) over that of white residuals
 * of the same size: 1 ... n. */
double ss_colour(const double *y, const double *x, size_t n, double slope);

#endif
