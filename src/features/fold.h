/* fold.h -- the mean cycle of a signal that repeats itself. */
#ifndef FOLD_H
#define FOLD_H

#include "features/search.h"

/* Jumps and kinks of the mean cycle, which has less noise than the record; *period [s], in which they
 * repeat, is what one cycle of them takes, and they are complete in [*period, 2 *period).  *out is NULL
 * where too few cycles are there to make it worth it. */
ss_status ss_fold_spikes(const search *s, ss_spikes **out, double *period);

#endif
