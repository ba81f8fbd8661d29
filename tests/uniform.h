/* uniform.h -- numbers between 0 and 1, the same on every machine: for tests. */
#ifndef UNIFORM_H
#define UNIFORM_H

#include <stdint.h>

/* Knuth's linear congruential generator (TAOCP 3.3.4) */
static inline double
uniform(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*seed >> 11) * 0x1p-53;
}

#endif
