/* driven_noise.c -- the noise of a measured force.
 *
 * * The noise is unknown, but at most the less of two estimates.  Motions that repeat: what differs between
 * rows of two passages through nearly the same place, by position, speed and the last two turns; a law's memory is
 * no longer than that.  Other motions: noise of short memory is as rough as its power says, and what a law fails to
 * explain is smoother, but friction that wanders from cycle to cycle, which stands beside it. */
#include "fit/driven.h"
#include "fit/wander.h"

#include <float.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MEMORY (1. / 16)                /* of noise, at most, in cycles */

ss_status
ss_driven_partners(const driven *d, size_t *partner)
{
    typedef struct passing { double at[4]; size_t turns; } passing;
    passing *p = malloc(d->n * (sizeof *p + 1));
    char *is_turn = (char *)(p + d->n);
    if (p == NULL)
        return SS_ENOMEM;
    ss_driven_turns(d, fmax(LITTLE, d->least), is_turn);
    for (size_t i = 0, last = 0, before = 0, turns = 0; i < d->n; i++) {
        if (is_turn[i]) {
            before = last;
            last = i;
            turns++;
        }
        p[i] = (passing){ { d->x[i], d->v[i], d->x[last], d->x[before] }, turns };
    }
    for (size_t i = 0; i < d->n; i++) {
        double nearest = INFINITY;
        partner[i] = i;
        for (size_t j = 0; j < d->n && d->used[i]; j++) {
            double distance = 0;
            if (!d->used[j] || (p[j].turns <= p[i].turns + 1 && p[i].turns <= p[j].turns + 1))
                continue;
            for (int k = 0; k < 4; k++)
                distance += (p[i].at[k] - p[j].at[k]) * (p[i].at[k] - p[j].at[k]);
            if (distance < nearest) {
                nearest = distance;
                partner[i] = j;
            }
        }
    }
    free(p);
    return SS_OK;
}

/* The terms of a spring of any shape and a damper: free functions of the place, the speed, its square, and the
 * acceleration. */
enum { PLACES = 8, TERMS = PLACES + 3 };

static void
fill_terms(double term[TERMS], const driven *d, const double range[2], size_t i)
{
    const double at = (d->x[i] - range[0]) / (range[1] - range[0]) * (PLACES - 1);
    for (int k = 0; k < PLACES; k++)
        term[k] = fmax(1 - fabs(at - k), 0);
    term[PLACES] = d->v[i];
    term[PLACES + 1] = d->v[i] * fabs(d->v[i]);
    term[PLACES + 2] = d->a[i];
}

void
ss_driven_spring(double spring[BLOCKS], const driven *d, const double *left)
{
    double sum[BLOCKS][TERMS + 1][TERMS] = { { { 0 } } }, range[2], term[TERMS], count = 0;
    gsl_stats_minmax(&range[0], &range[1], d->x, 1, d->n);
    for (size_t i = 0; i < d->n; i++) {
        double (*to)[TERMS] = sum[i * BLOCKS / d->n];
        fill_terms(term, d, range, i);
        for (int k = 0; k < TERMS && d->used[i]; k++) {
            for (int l = 0; l <= k; l++)
                to[k][l] += term[k] * term[l];
            to[TERMS][k] += term[k] * left[i];
        }
        count += d->used[i];
    }
    for (size_t b = 0; b < BLOCKS; b++) {
        double h[TERMS * TERMS] = { 0 }, c[1][UNKNOWNS + COLUMNS] = { { 0 } };
        for (size_t i = 0; i < BLOCKS; i++)
            for (int k = 0; k < TERMS && i != b; k++) {
                for (int l = 0; l <= k; l++)
                    h[k * TERMS + l] += sum[i][k][l];
                c[0][k] += sum[i][TERMS][k];
            }
        ss_driven_solve(h, TERMS, c, 1);
        spring[b] = 0;
        for (size_t i = (b * d->n + BLOCKS - 1) / BLOCKS; i * BLOCKS / d->n == b; i++) {
            double rest = left[i];
            fill_terms(term, d, range, i);
            for (int k = 0; k < TERMS; k++)
                rest -= c[0][k] * term[k];
            spring[b] += d->used[i] * rest * rest / count;
        }
    }
}

/* The mean square at most of noise with these second differences, if its memory is at most MEMORY of a cycle: of
 * noise of the first order, and of white noise.  What a law fails to explain is smoother, but for few rows.
 * room: for DRIVEN_ROWS numbers. */
static double
find_rough(const driven *d, const double *predicted, size_t turns, double *room)
{
    const double *f = d->f, *p = predicted, memory = MEMORY * 2 * (double)d->n / (double)turns;     /* [rows] */
    double least = INFINITY;
    for (size_t lag = 1; (double)lag <= memory; lag *= 2) {
        const double keep = exp(-(double)lag / memory);
        size_t n = 0;
        for (size_t i = lag; i + lag < d->n; i += 1 + d->n / DRIVEN_ROWS) {
            double by = f[i - lag] - p[i - lag] - 2 * (f[i] - p[i]) + f[i + lag] - p[i + lag];
            if (d->used[i - lag] && d->used[i] && d->used[i + lag])
                room[n++] = by * by / (6 - 8 * keep + 2 * keep * keep);
        }
        if (n > DRIVEN_FEWEST)
            least = fmin(least, ss_wander_variance(room, n));
    }
    return least;
}

/* The correlation of what is left with that of the partners; *noise becomes the mean square that they do not
 * share. */
static double
find_repeat(const driven *d, const size_t *partner, const double *left, double *noise)
{
    double squares = 0, products = 0, differences = 0, n = 0;
    for (size_t i = 0; i < d->n; i++) {
        double other = left[partner[i]];
        if (partner[i] == i)
            continue;
        squares += (left[i] * left[i] + other * other) / 2;
        products += left[i] * other;
        differences += (left[i] - other) * (left[i] - other) / 2;
        n++;
    }
    *noise = n > 0 ? differences / n : NAN;
    return squares > 0 ? products / squares : NAN;
}

/* By how much less is left, in the mean square, if the law's own force has another size in each two cycles, as
 * friction wanders. */
static double
find_wander(const driven *d, const double *left, const double *own, size_t turns)
{
    const size_t parts = turns / 4 + 1;
    double sum = 0, n = 0;
    for (size_t k = 0; k < parts; k++) {
        double product = 0, squares = DBL_MIN;
        for (size_t i = k * d->n / parts; i < (k + 1) * d->n / parts; i++)
            if (d->used[i]) {
                product += left[i] * own[i];
                squares += own[i] * own[i];
                n++;
            }
        sum += product * product / squares;
    }
    return sum / n;
}

void
ss_driven_noise(driven_noise *out, const driven_result *r, const driven *rows, const size_t *partner,
                const driven *d, const double *predicted, size_t turns)
{
    double room[DRIVEN_ROWS];
    out->repeat = find_repeat(rows, partner, r->left, &out->most);
    out->rough = find_rough(d, predicted, turns, room) + find_wander(rows, r->left, r->own, turns);
}
