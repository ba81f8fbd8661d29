/* extremes.h -- values of any number, of which the largest, or the smallest and the largest, of
 * each block are kept: when all blocks are full, each two become one, and blocks are twice as long
 * from there on. */
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

/* Begin with zeros; 0: no memory, to be freed nevertheless. */
int ss_extremes_make(extremes *b, size_t room, int both);
void ss_extremes_free(extremes *b);

void ss_extremes_halve(extremes *b);
/* Of the next n values, how many lie in block *i, the first that has room. */
static inline size_t
ss_extremes_next(extremes *b, size_t n, size_t *i)
{
    if (b->n >> b->order == b->room)
        ss_extremes_halve(b);
    *i = b->n >> b->order;
    size_t room = ((*i + 1) << b->order) - b->n;
    return room < n ? room : n;
}

/* Add values of which both extremes are kept. */
void ss_extremes_add(extremes *b, const double *x, size_t n);
/* Blocks that have values. */
size_t ss_extremes_count(const extremes *b);
/* How many of both extremes there are of a block: one of blocks of one value, else two. */
size_t ss_extremes_each(const extremes *b);
/* Both extremes of each block, in the order of their times. */
void ss_extremes_give(const extremes *b, double *x);

#endif
