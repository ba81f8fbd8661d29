/* sort.h -- the order of doubles, for qsort. */
#ifndef SORT_H
#define SORT_H

/* Ascending, by the double that an element is or begins with; without NaN. */
static inline int
ss_ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

#endif
