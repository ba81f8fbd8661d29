/* loading.h -- how each stick loads a force before it falls. */
#ifndef LOADING_H
#define LOADING_H

#include "find/search.h"
#include "find/drops.h"

/* Write the loadings before the n drops of x, which is the signal in s or its negative, into s->out, with
 * their medians. */
ss_status ss_loading_find(search *s, const double *x, const ss_drop *drop, size_t n);

#endif
