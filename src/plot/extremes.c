/* extremes.c -- the extremes of blocks of values. */
#include "plot/extremes.h"

#include <stdlib.h>

int
ss_extremes_make(extremes *b, size_t room, int both)
{
    b->room = room;
    b->most = malloc(room * sizeof *b->most);
    b->least = both ? malloc(room * sizeof *b->least) : NULL;
    b->falls = both ? calloc(room, 1) : NULL;
    return b->most != NULL && (!both || (b->least != NULL && b->falls != NULL));
}

void
ss_extremes_free(extremes *b)
{
    free(b->most);
    free(b->least);
    free(b->falls);
}

/* Merge the smallest values of two neighbours, and the order of smallest and largest. */
static void
halve_least(extremes *b)
{
    for (size_t i = 0; i < b->room / 2; i++) {
        size_t first = 2 * i, second = first + 1;
        size_t high = b->most[second] > b->most[first] ? second : first;
        size_t low = b->least[second] < b->least[first] ? second : first;
        b->falls[i] = high != low ? high < low : b->falls[high];
        b->least[i] = b->least[low];
    }
}

void
ss_extremes_halve(extremes *b)
{
    if (b->least != NULL)
        halve_least(b);
    for (size_t i = 0; i < b->room / 2; i++)
        b->most[i] = b->most[2 * i + 1] > b->most[2 * i] ? b->most[2 * i + 1] : b->most[2 * i];
    b->order++;
}

/* Add m values, all of them in block i. */
static void
add_to_block(extremes *b, size_t i, const double *x, size_t m)
{
    size_t high = 0, low = 0;
    int first = b->n == i << b->order;
    for (size_t k = 1; k < m; k++) {
        high = x[k] > x[high] ? k : high;
        low = x[k] < x[low] ? k : low;
    }
    int higher = first || x[high] > b->most[i], lower = first || x[low] < b->least[i];
    if (higher || lower)
        b->falls[i] = higher && lower ? high < low : lower;
    b->most[i] = higher ? x[high] : b->most[i];
    b->least[i] = lower ? x[low] : b->least[i];
    b->n += m;
}

void
ss_extremes_add(extremes *b, const double *x, size_t n)
{
    for (size_t k = 0, m, i; k < n; k += m) {
        m = ss_extremes_next(b, n - k, &i);
        add_to_block(b, i, x + k, m);
    }
}

size_t
ss_extremes_count(const extremes *b)
{
    return (b->n + ((size_t)1 << b->order) - 1) >> b->order;
}

size_t
ss_extremes_each(const extremes *b)
{
    return b->order > 0 ? 2 : 1;
}

void
ss_extremes_give(const extremes *b, double *x)
{
    size_t each = ss_extremes_each(b);
    for (size_t i = 0; i < ss_extremes_count(b); i++, x += each) {
        x[0] = b->falls[i] ? b->most[i] : b->least[i];
        x[each - 1] = b->falls[i] || each == 1 ? b->least[i] : b->most[i];
    }
}
