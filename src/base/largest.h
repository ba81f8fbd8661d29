/* largest.h -- the largest of many values. */
#ifndef LARGEST_H
#define LARGEST_H

#include <stddef.h>

/* The largest of n values >= 0; 0 if n is 0.  Lanes let the machine compare several at a time; call it
 * from a function that is compiled for several machines (versions.h). */
static inline double
largest_of(const double *x, size_t n)
{
    enum { LANES = 8 };
    double lane[LANES] = { 0 }, most = 0;
    size_t k = 0;
    if (n > LANES) {
        for (; k + LANES <= n; k += LANES)
            for (size_t j = 0; j < LANES; j++)
                lane[j] = x[k + j] > lane[j] ? x[k + j] : lane[j];
        for (size_t j = 0; j < LANES; j++)
            most = lane[j] > most ? lane[j] : most;
    }
    for (; k < n; k++)
        most = x[k] > most ? x[k] : most;
    return most;
}

#endif
