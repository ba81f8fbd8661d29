/* fold.h -- the mean cycle of a signal that repeats itself. */
#ifndef FOLD_H
#define FOLD_H

#include "find/search.h"

/* Find the jumps and kinks of the mean cycle, which has less noise than the record.  They repeat after
 * *period [s], that of one cycle, and are complete in [*period, 2 *period).  *out becomes NULL if there are
 * too few cycles for a mean. */
ss_status ss_fold_spikes(const search *s, ss_spikes **out, double *period);

#endif
