/* morlet_point.h -- W at any point by the definition: the library's own sum, out to the last tap that counts. */
#ifndef MORLET_POINT_H
#define MORLET_POINT_H

#include <stdlib.h>
#include "map/map.h"
#include "map/plan.h"

/* Of opts center, norm, admissible and detrend count. */
static inline ss_status
point_at(const double *x, size_t n, double rate, const ss_morlet_opts *opts, double a, double b, double w[2],
         ss_error *err)
{
    const ss_morlet plan = { .opts = *opts, .n = n, .rate = rate };
    const ss_scale scale = { .a = a, .b_num = b, .b_den = 1 };
    record rec;
    ss_status st = ss_morlet_record(&rec, x, n, opts->detrend, err);
    if (st != SS_OK)
        return st;
    st = ss_morlet_points(&plan, &scale, &rec, (size_t[]){ 1 }, 1, w, err);
    free(rec.x);
    return st;
}

#endif
