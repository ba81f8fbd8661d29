/* extremes.h -- keep the largest, or the smallest and the largest, of each block of any number of
 * values.  When all blocks are full, each two become one, and blocks are then twice as long. */
#ifndef EXTREMES_H
#define EXTREMES_H

#include <stddef.h>

typedef struct extremes {
    int order;                  /* a block has 2^order values */
    size_t n;                   /* values so far */
    size_t room;                /* blocks, a power of 2 */
    double *most;
    double *least;              /* NULL: not wanted */
    unsigned char *falls;       /* 1: the largest comes before the smallest */
} extremes;

/* Make empty blocks.  Returns 0 if there is no memory; they are to be freed even then. */
int ss_extremes_make(extremes *b, size_t room, int both);
void ss_extremes_free(extremes *b);

void ss_extremes_halve(extremes *b);
/* *i becomes the first block that has room.  Returns how many of the next n values lie in it. */
static inline size_t
ss_extremes_next(extremes *b, size_t n, size_t *i)
{
    if (b->n >> b->order == b->room)
        ss_extremes_halve(b);
    *i = b->n >> b->order;
    size_t room = ((*i + 1) << b->order) - b->n;
    return room < n ? room : n;
}

/* Add n values to blocks that keep both extremes. */
void ss_extremes_add(extremes *b, const double *x, size_t n);
/* The number of blocks that have values. */
size_t ss_extremes_count(const extremes *b);
/* The number of extremes of a block: 1 if blocks have one value, else 2. */
size_t ss_extremes_each(const extremes *b);
/* Write the extremes of each block to x, in the order of their times. */
void ss_extremes_give(const extremes *b, double *x);

#endif
