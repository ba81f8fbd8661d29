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

/* The adjoint of add_terms: from the terms `from` to the spectrum x, of which terms 0 and m/2 count twice.
 * What is added is the conjugate of its terms. */
VERSIONS static void
add_conjugate_terms(const double *from, size_t length, size_t at, const double *g, size_t n, double *x,
                    size_t m, ptrdiff_t k)
{
    while (n > 0) {
        ptrdiff_t r = k % (ptrdiff_t)m;
        size_t to = (size_t)(r < 0 ? r + (ptrdiff_t)m : r);
        int mirrored = to > m / 2, real = to % (m / 2) == 0;
        size_t run = mirrored ? m - to : real ? 1 : m / 2 - to;
        run = run < n ? run : n;
        run = run < length - at ? run : length - at;
        const double *in = from + 2 * at;
        if (real)
            x[2 * to] += 2 * g[0] * in[0];
        else if (mirrored)
            for (size_t i = 0; i < run; i++) {
                double *out = x + 2 * (m - to - i);
                out[0] += g[i] * in[2 * i];
                out[1] += g[i] * in[2 * i + 1];
            }
        else
            for (size_t i = 0; i < run; i++) {
                x[2 * (to + i)] += g[i] * in[2 * i];
                x[2 * (to + i) + 1] -= g[i] * in[2 * i + 1];
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

/* The conjugate of n values times factor into v. */
VERSIONS static void
add_points(const double *restrict w, size_t n, double factor, double *restrict v)
{
    for (size_t i = 0; i < n; i++) {
        v[2 * i] = w[2 * i] * factor;
        v[2 * i + 1] = -w[2 * i + 1] * factor;
    }
}

#endif
