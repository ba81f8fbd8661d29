/* columns.h -- room for rows, column by column. */
#ifndef COLUMNS_H
#define COLUMNS_H

#include <stdint.h>
#include <stdlib.h>

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
