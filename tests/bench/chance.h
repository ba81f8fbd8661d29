/* chance.h -- draws for the programs that measure how often errors cover the truth. */
#ifndef CHANCE_H
#define CHANCE_H

#include <math.h>
#include <stdint.h>

#define PI 3.14159265358979323846

static uint64_t chance;         /* the state: set it to a seed */

static double
uniform(void)                   /* splitmix64 (Steele, Lea & Flood 2014); never 0 or 1 */
{
    uint64_t z = chance += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return ((double)((z ^ (z >> 31)) >> 11) + 0.5) / 9007199254740992.;
}

static double
between(double from, double to) /* log-uniform */
{
    return from * pow(to / from, uniform());
}

static double
gauss(void)
{
    return sqrt(-2 * log(uniform())) * cos(2 * PI * uniform());
}

#endif
