/* reversals.h -- friction, and stiffness in the stick, of a force that goes to and fro. */
#ifndef REVERSALS_H
#define REVERSALS_H

#include "find/search.h"

/* Find the medians over the reversals in s->out of x, which is the signal in s less a constant: friction,
 * and stiffness if there is a column of displacement. */
ss_status ss_reversals_measure(search *s, const double *x);

#endif
