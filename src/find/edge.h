/* edge.h -- whether an oscillation is that of a filter. */
#ifndef EDGE_H
#define EDGE_H

#include <stddef.h>
#include <stickslip/status.h>

/* *is_edge becomes 1 if the spectrum of n samples x ends at f [1/sample] and has no peak there; 0 also if x
 * is too short to show this. */
ss_status ss_edge_find(const double *x, size_t n, double f, int *is_edge);

#endif
