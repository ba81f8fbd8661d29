/* extremes.c -- the extremes of blocks of values. */
#include "plot/extremes.h"

#include <math.h>
#include <stdlib.h>

int
ss_extremes_make(extremes *b, size_t room, int both)
{
    *b = (extremes){ .room = room, .most = malloc(room * sizeof *b->most) };
    b->least = both ? malloc(room * sizeof *b->least) : NULL;
    return b->most != NULL && (!both || b->least != NULL);
}

void
ss_extremes_free(extremes *b)
{
    free(b->most);
    free(b->least);
}

size_t
ss_extremes_next(extremes *b, size_t n, size_t *i)
{
    if (b->n >> b->order == b->room) {
        for (size_t k = 0; k < b->room / 2; k++) {
            b->most[k] = fmax(b->most[2 * k], b->most[2 * k + 1]);
            if (b->least != NULL)
                b->least[k] = fmin(b->least[2 * k], b->least[2 * k + 1]);
        }
        b->order++;
    }
    *i = b->n >> b->order;
    if (b->n == *i << b->order) {
        b->most[*i] = -INFINITY;
        if (b->least != NULL)
            b->least[*i] = INFINITY;
    }
    size_t room = ((*i + 1) << b->order) - b->n;
    return room < n ? room : n;
}

void
ss_extremes_add(extremes *b, const double *x, size_t n)
{
    for (size_t m, i; n > 0; n -= m, x += m, b->n += m) {
        m = ss_extremes_next(b, n, &i);
        double least = b->least[i], most = b->most[i];
        for (size_t k = 0; k < m; k++) {
            least = x[k] < least ? x[k] : least;
            most = x[k] > most ? x[k] : most;
        }
        b->least[i] = least;
        b->most[i] = most;
    }
}

size_t
ss_extremes_count(const extremes *b)
{
    return (b->n + ((size_t)1 << b->order) - 1) >> b->order;
}

size_t
ss_extremes_of(const extremes *b, size_t i, double x, double pair[2])
{
    int falls = b->most[i] - x < x - b->least[i];
    pair[0] = falls ? b->most[i] : b->least[i];
    pair[1] = falls ? b->least[i] : b->most[i];
    return b->least[i] < b->most[i] ? 2 : b->least[i] == b->most[i];
}
