/* loading.h -- how each stick loads a force before it falls. */
#ifndef LOADING_H
#define LOADING_H

#include "features/search.h"

/* Write the loadings before the n drops of x, which is the signal in s or its negative, into s->out, with
 * their medians. */
ss_status ss_loading_find(search *s, const double *x, const ss_drop *drop, size_t n);

/* The median of those of n values that are numbers; scratch holds n. */
ss_median ss_median_of(const ss_value *v, size_t n, double *scratch);

#endif
