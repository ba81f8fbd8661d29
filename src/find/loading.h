/* loading.h -- how each stick loads a force before it falls. */
#ifndef LOADING_H
#define LOADING_H

#include "find/search.h"
#include "find/drops.h"

/* Write n transitions, the drops of y, into s->out, and the loadings before them, with their medians.  y is the
 * signal in s or its negative, without wrong samples. */
ss_status ss_loading_find(search *s, const double *y, const ss_drop *drop, size_t n);

#endif
