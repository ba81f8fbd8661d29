/* driven_noise.c -- the noise of a measured force.
 *
 * * The noise is unknown, but at most the least of three estimates.  Motions that repeat: what differs between
 * rows of two passages through nearly the same place, by position, speed and the last two turns; a law's memory is
 * no longer than that.  Laws that are not in the list: what a free law leaves of blocks of time to which it was
 * not fitted.  Other motions: noise of short memory is as rough as its power says, and what a law fails to explain
 * is smoother, but friction that wanders from cycle to cycle, which stands beside it. */
#include "fit/driven.h"
#include "fit/verdict.h"
#include "fit/wander.h"

#include <float.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MEMORY (1. / 16)                /* of noise, at most, in cycles */
#define SHARED 1e-4                     /* ridge of the terms of a free law, which are alike */

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

/* A hat function of the k-th knot, at k, of x. */
static double
hat(double x, double k)
{
    return fmax(1 - fabs(x - k), 0);
}

/* The terms of a free law: free functions of the place, speed, its square, and acceleration, as a spring of any
 * shape and a damper have them; sliders of many lengths; free functions of the speed, alone and times the law's
 * own force, and of this force in either direction; and its rate. */
enum { PLACES = 8, SPRING = PLACES + 3, SLIDERS = 16, SPEEDS = 6, FORCES = 8 };
enum { TERMS = SPRING + SLIDERS + 2 * SPEEDS + 2 * FORCES + 1 };

static void
find_range(double range[2], const double *x, size_t n)
{
    gsl_stats_minmax(&range[0], &range[1], x, 1, n);
    range[1] -= range[0];
}

static void
fill_terms(double (*term)[TERMS], const driven *d, const double *own)
{
    double slider[SLIDERS] = { 0 }, place[2], force[2];
    find_range(place, d->x, d->n);
    find_range(force, own, d->n);
    for (size_t i = 0; i < d->n; i++) {
        double length = 0.02, speed = asinh(fabs(d->v[i]) / 0.05) * SPEEDS / 5, *at = term[i];
        for (int k = 0; k < PLACES; k++)
            *at++ = hat((d->x[i] - place[0]) / place[1] * (PLACES - 1), k);
        *at++ = d->v[i];
        *at++ = d->v[i] * fabs(d->v[i]);
        *at++ = d->a[i];
        for (int k = 0; k < SLIDERS; k++, length *= M_SQRT2)
            *at++ = slider[k] = fmax(-1, fmin(slider[k] + (i > 0 ? d->x[i] - d->x[i - 1] : 0) / length, 1));
        for (int k = 0; k < SPEEDS; k++) {
            *at++ = copysign(hat(speed, k), d->v[i]);
            *at++ = own[i] * hat(speed, k);
        }
        for (int k = 0; k < 2 * FORCES; k++)
            *at++ = (d->v[i] > 0) == k % 2 && force[1] > 0
                ? hat((own[i] - force[0]) / force[1] * (FORCES - 1), k / 2) : 0;
        *at++ = i > 0 ? (own[i] - own[i - 1]) / (d->t[i] - d->t[i - 1]) : 0;
    }
}

/* Add the products of the first terms of a row with each other and with what is left of it: most terms are 0. */
static void
add_products(double sum[TERMS + 1][TERMS], const double term[TERMS], int terms, double left)
{
    int of[TERMS], n = 0;
    for (int k = 0; k < terms; k++)
        if (term[k] != 0)
            of[n++] = k;
    for (int k = 0; k < n; k++) {
        const double one = term[of[k]];
        for (int l = 0; l <= k; l++)
            sum[of[k]][of[l]] += one * term[of[l]];
        sum[terms][of[k]] += one * left;
    }
}

ss_status
ss_driven_free_law(double free_law[BLOCKS], const driven *d, const double *left, const double *own)
{
    const int terms = own != NULL ? TERMS : SPRING;
    double (*term)[TERMS] = malloc(d->n * sizeof *term), (*sum)[TERMS + 1][TERMS] = calloc(BLOCKS, sizeof *sum);
    double count = 0;
    if (term == NULL || sum == NULL) {
        free(term);
        free(sum);
        return SS_ENOMEM;
    }
    fill_terms(term, d, own != NULL ? own : d->x);
    for (size_t i = 0; i < d->n; i++)
        if (d->used[i]) {
            add_products(sum[i * BLOCKS / d->n], term[i], terms, left[i]);
            count++;
        }
    for (size_t b = 0; b < BLOCKS; b++) {
        double others[TERMS + 1][TERMS] = { { 0 } };
        for (size_t i = 0; i < BLOCKS; i++)
            for (int k = 0; k <= terms && i != b; k++)
                for (int l = 0; l < terms; l++)
                    others[k][l] += sum[i][k][l];
        for (int k = 0; k < terms; k++)
            others[k][k] += SHARED * others[k][k] + DBL_MIN;
        gsl_matrix_view A = gsl_matrix_view_array_with_tda(others[0], (size_t)terms, (size_t)terms, TERMS);
        gsl_vector_view C = gsl_vector_view_array(others[terms], (size_t)terms);
        gsl_linalg_cholesky_decomp1(&A.matrix);
        gsl_linalg_cholesky_svx(&A.matrix, &C.vector);
        free_law[b] = 0;
        for (size_t i = (b * d->n + BLOCKS - 1) / BLOCKS; i * BLOCKS / d->n == b; i++) {
            double rest = left[i];
            for (int k = 0; k < terms; k++)
                rest -= others[terms][k] * term[i][k];
            free_law[b] += d->used[i] * rest * rest / count;
        }
    }
    free(term);
    free(sum);
    return SS_OK;
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

ss_status
ss_driven_noise(driven_noise *out, const driven_result *r, const driven *rows, const size_t *partner,
                const driven *d, const double *predicted, size_t turns)
{
    double room[DRIVEN_ROWS];
    double free_law[BLOCKS], unshared;
    ss_status st = ss_driven_free_law(free_law, rows, r->left, r->own);
    if (st != SS_OK)
        return st;
    out->repeat = find_repeat(rows, partner, r->left, &unshared);
    out->most = fmin(ss_verdict_sum(free_law), unshared);
    out->rough = find_rough(d, predicted, turns, room) + find_wander(rows, r->left, r->own, turns);
    return SS_OK;
}
