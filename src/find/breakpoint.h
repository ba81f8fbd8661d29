/* breakpoint.h -- find the break between two smooth pieces of a signal. */
#ifndef BREAKPOINT_H
#define BREAKPOINT_H

#include <stddef.h>

/* The time, in samples, at which x is best explained by two cubics that meet there, in the samples
 * [first, last]; at is where it is thought to be, and reach how far it may be from there.  The
 * cubics may differ in value (a jump) where that explains so much more that it is worth its
 * parameter.  At least BREAKPOINT_SIDE samples on either side are needed, else at is the answer. */
enum { BREAKPOINT_DEGREE = 3, BREAKPOINT_SIDE = BREAKPOINT_DEGREE + 2 };
double ss_breakpoint(const double *x, size_t first, size_t last, double at, double reach);

#endif
