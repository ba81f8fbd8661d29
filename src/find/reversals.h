/* reversals.h -- the reversals of a force that goes to and fro, and what they tell of friction. */
#ifndef REVERSALS_H
#define REVERSALS_H

#include "find/search.h"

/* Find the transitions of x, which is the signal in s less a constant, and the medians over them: friction, and
 * stiffness if there is a column of displacement. */
ss_status ss_reversals_find(search *s, const double *x);

#endif
