/* range.h -- whether a number lies in the range that a public header gives it. */
#ifndef RANGE_H
#define RANGE_H

#include "base/error.h"

static inline ss_status
ss_range_check(double x, ss_range range, const char *name, ss_error *err)
{
    return x >= range.from && x <= range.to ? SS_OK
        : ss_fail(err, SS_EINVAL, "%s %g is out of range %g ... %g", name, x, range.from, range.to);
}

#endif
