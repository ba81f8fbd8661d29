/* levels.c -- see levels.h. */
#include <stdint.h>
#include <string.h>
#include "find/levels.h"

static inline size_t
digit_of(double level, int shift, size_t mask)
{
    uint64_t bits;
    memcpy(&bits, &level, sizeof bits);
    return bits >> shift & mask;
}

/* The middle one is found digit by digit of the numbers' bits, which are ordered as the numbers are: numbers
 * without its digit are moved behind the others. */
double
ss_levels_middle(double *level, size_t n)
{
    enum { BITS = 13, DIGITS = 1 << BITS };
    size_t place = n / 2;
    for (int shift = 64 - BITS; n > 1 && shift > -BITS; shift -= BITS) {
        size_t count[DIGITS] = { 0 }, digit = 0, left = 0;
        int low = shift > 0 ? shift : 0;
        for (size_t i = 0; i < n; i++)
            count[digit_of(level[i], low, DIGITS - 1)]++;
        for (; place >= count[digit]; digit++)
            place -= count[digit];
        for (size_t i = 0; i < n; i++) {
            double here = level[i];
            level[i] = level[left];
            level[left] = here;
            left += digit_of(here, low, DIGITS - 1) == digit;
        }
        n = left;
    }
    return level[0];
}
