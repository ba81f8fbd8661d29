/* points.h -- the terms and points of a series. */
#ifndef POINTS_H
#define POINTS_H

#include <stddef.h>
#include "base/versions.h"

/* to += g x over n terms, of which term k of the spectrum x of m points, a real signal's, is the first:
 * to term at of length, and on around it. */
VERSIONS static void
add_terms(const double *x, size_t m, ptrdiff_t k, const double *g, size_t n, double *to,
          size_t length, size_t at)
{
    while (n > 0) {
        ptrdiff_t r = k % (ptrdiff_t)m;
        size_t from = (size_t)(r < 0 ? r + (ptrdiff_t)m : r);
        int mirrored = from > m / 2;        /* of a real signal, X_-k = conj X_k */
        size_t run = mirrored ? m - from : m / 2 + 1 - from;
        run = run < n ? run : n;
        run = run < length - at ? run : length - at;
        double *out = to + 2 * at;
        if (mirrored)
            for (size_t i = 0; i < run; i++) {
                const double *in = x + 2 * (m - from - i);
                out[2 * i] += g[i] * in[0];
                out[2 * i + 1] -= g[i] * in[1];
            }
        else
            for (size_t i = 0; i < run; i++) {
                out[2 * i] += g[i] * x[2 * (from + i)];
                out[2 * i + 1] += g[i] * x[2 * (from + i) + 1];
            }
        g += run;
        n -= run;
        k += (ptrdiff_t)run;
        at = (at + run) % length;
    }
}

/* n values of a series times factor into w. */
VERSIONS static void
write_points(const double *restrict v, size_t n, double factor, double *restrict w)
{
    for (size_t i = 0; i < 2 * n; i++)
        w[i] = v[i] * factor;
}

#endif
