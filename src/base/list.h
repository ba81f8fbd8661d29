/* list.h -- lists that grow, are sorted and searched by time; room for rows, column by column. */
#ifndef LIST_H
#define LIST_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* Returns the list, possibly moved, with room for at least need entries of size bytes each.  A list that
 * grows gets room for twice as many.  NULL: no memory; the list is unchanged. */
static inline void *
ss_list_grow(void *list, size_t *room, size_t need, size_t size)
{
    if (need <= *room && list != NULL)
        return list;
    size_t more = need <= SIZE_MAX / 4 ? 2 * need + 62 : SIZE_MAX;
    void *longer = more <= SIZE_MAX / size ? realloc(list, more * size) : NULL;
    if (longer != NULL)
        *room = more;
    return longer;
}

/* The same with room for one entry after the first n. */
static inline void *
ss_list_room(void *list, size_t *room, size_t n, size_t size)
{
    return ss_list_grow(list, room, n + 1, size);
}

/* The index of the first of n entries whose time is t or later; n if there is none.  An entry has size
 * bytes and begins with its time. */
static inline size_t
ss_list_from(const void *list, size_t n, size_t size, double t)
{
    size_t lo = 0, hi = n;
    while (lo < hi) {
        size_t mid = lo + (hi - lo) / 2;
        const void *entry = (const char *)list + mid * size;
        if (*(const double *)entry < t)
            lo = mid + 1;
        else
            hi = mid;
    }
    return lo;
}

/* Ascending, by the double that an element is or begins with; without NaN. */
static inline int
ss_ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Room for so many rows of n columns, to be freed by one free(); NULL: no memory. */
static inline double **
ss_columns_new(size_t n, size_t rows)
{
    if (rows > SIZE_MAX / sizeof(double) / (n + 1) - 1)
        return NULL;
    double **column = malloc(n * sizeof *column + (n * rows + 1) * sizeof **column);
    for (size_t c = 0; column != NULL && c < n; c++)
        column[c] = (double *)(column + n) + c * rows;
    return column;
}

#endif
