/* extremes.h -- the smallest and the largest of each block of any number of values.  When all blocks are full,
 * each two become one, and blocks are then twice as long. */
#ifndef EXTREMES_H
#define EXTREMES_H

#include <stddef.h>

typedef struct extremes {
    int order;                  /* a block has 2^order values */
    size_t n;                   /* values so far */
    size_t room;                /* blocks, a power of 2 */
    double *most, *least;       /* least is NULL if it is not wanted */
} extremes;

/* Make empty blocks.  Returns 0 if there is no memory; they are to be freed even then. */
int ss_extremes_make(extremes *b, size_t room, int both);
void ss_extremes_free(extremes *b);

/* *i becomes the block that the next value lies in.  Returns how many of the next n lie there. */
size_t ss_extremes_next(extremes *b, size_t n, size_t *i);
/* Add n values to blocks that keep both extremes; NaN is no value. */
void ss_extremes_add(extremes *b, const double *x, size_t n);
/* The number of blocks that have begun. */
size_t ss_extremes_count(const extremes *b);
/* What a line from x through block i has of it: its extremes, the nearer one first.  Returns how many values
 * these are, 1 or 2; 0 if the block has only NaN. */
size_t ss_extremes_of(const extremes *b, size_t i, double x, double pair[2]);

#endif
