/* near.h -- a number beside its truth: for tests of published results. */
#ifndef NEAR_H
#define NEAR_H

#include <math.h>

#include "unit.h"

/* Say how far off it is, and fail if that is more than is allowed. */
static inline void
near(const char *what, double got, double truth, double allowed)
{
    print_message("%s: %.13g, off by %.1e\n", what, got, fabs(got - truth));
    if (!(fabs(got - truth) <= allowed))
        fail_msg("%s: %.17g, not %.17g +- %.2g", what, got, truth, allowed);
}

#endif
