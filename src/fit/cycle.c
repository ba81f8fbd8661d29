/* cycle.c -- fold a signal at its period, and compare two cycles whatever their phase and size.
 *
 * The repeated part of a record adds up over its cycles, and noise does not.  So the mean cycle
 * has less noise than the record and far fewer samples to fit; a model's settled motion is one
 * cycle too.  Its phase and its size need no search: the correlation of two cycles, computed at
 * all shifts from their spectra, gives the best phase and size in closed form. */
#include "fit/cycle.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/number.h"
#include "find/cycles.h"

enum { GRID = 64 };             /* steps to either side in the search of the period */

static size_t
bins_of(double samples)
{
    size_t n = CYCLE_LEAST;
    while (2 * n <= CYCLE_MOST && 2 * (double)n <= samples)
        n *= 2;
    return n;
}

/* Find sum and count of each bin; returns the sum of the squares. */
static double
gather(double *sum, double *count, size_t bins, const double *x, const char *missing, size_t n, double cycles)
{
    double squares = 0;
    memset(sum, 0, bins * sizeof *sum);
    memset(count, 0, bins * sizeof *count);
    for (size_t i = 0; i < n; i++) {
        if (missing != NULL && missing[i])
            continue;
        double turn = (double)i * cycles;
        size_t b = (size_t)((turn - floor(turn)) * (double)bins);
        sum[b] += x[i];
        count[b]++;
        squares += x[i] * x[i];
    }
    return squares;
}

/* Fold n samples at a period of so many.  `why` becomes the reason if they show no cycle. */
static void
fold(cycle *c, char *why, size_t size, const double *x, const char *missing, size_t n, double samples)
{
    double count[CYCLE_MOST], mean = 0, all = 0;
    c->n = bins_of(samples);
    double within = gather(c->y, count, c->n, x, missing, n, 1 / samples);
    for (size_t i = 0; i < c->n; i++) {
        all += count[i];
        if (missing != NULL && count[i] == 0)
            ss_print_to(why, size, "gaps leave out a part of every cycle of %.3g s", c->period);
        within -= count[i] > 0 ? c->y[i] * c->y[i] / count[i] : 0;
        c->y[i] /= fmax(count[i], 1);
        mean += c->y[i] / (double)c->n;
    }
    c->power = 0;
    for (size_t i = 0; i < c->n; i++) {
        c->y[i] -= mean;
        c->power += c->y[i] * c->y[i] / (double)c->n;
    }
    double bins = (double)c->n;
    c->noise = all > bins ? fmax(within, 0) / (all - bins) * bins / all : 0;
    if (why[0] == '\0' && !(c->power > c->noise))
        snprintf(why, size, "what repeats is no more than the noise");
}

/* The period within 1 % of the given one at which most power repeats. */
static double
refine(const double *x, const char *missing, size_t n, double period)
{
    double best = period, sum[CYCLE_MOST], count[CYCLE_MOST];
    /* jumps repeat within a bin or two: the first steps are no wider than that over 8 cycles */
    for (double width = 0.01; width > 1e-6; width /= GRID) {
        double middle = best, most = -1;
        for (int i = -GRID; i <= GRID; i++) {
            const double p = middle * (1 + width * i / GRID);
            const size_t bins = bins_of(p);
            double power = 0;   /* of the mean cycle, with that of its mean, which is the same for every period */
            gather(sum, count, bins, x, missing, n, 1 / p);
            for (size_t b = 0; b < bins; b++)
                power += count[b] > 0 ? sum[b] * sum[b] / count[b] : 0;
            if (power > most)
                most = power, best = p;
        }
    }
    return best;
}

ss_status
ss_cycle_find(cycle *c, char *why, size_t size, const double *x, const char *missing, size_t n,
              double rate, double frequency)
{
    double samples = rate / frequency;
    ss_status st = frequency > 0 ? SS_OK : ss_period_find(x, n, &samples);
    if (st != SS_OK)
        return st;
    if (!(frequency > 0) && !isnan(samples))
        samples = refine(x, missing, n, samples);
    c->period = samples / rate;
    if (isnan(samples))
        snprintf(why, size, "nothing repeats in the record");
    else if (!(samples >= CYCLE_LEAST))
        ss_print_to(why, size, "%.3g samples a cycle: %d are needed", samples, CYCLE_LEAST);
    else if (!(samples <= (double)n))
        ss_print_to(why, size, "the record holds less than one cycle of %.3g s", c->period);
    else
        fold(c, why, size, x, missing, n, samples);
    c->period = why[0] == '\0' ? c->period : 0;
    return SS_OK;
}

ss_status
ss_cycle_goal_new(cycle_goal *goal, const cycle *c)
{
    goal->c = c;
    goal->back = (real_fft){ 0 };
    ss_status st = ss_real_fft_new(&goal->forward, c->n, 0);
    if (st == SS_OK)
        st = ss_real_fft_new(&goal->back, c->n, 1);
    if (st != SS_OK) {
        ss_cycle_goal_free(goal);
        return st;
    }
    memcpy(goal->forward.x, c->y, c->n * sizeof *c->y);
    ss_real_fft_run(&goal->forward);
    for (size_t k = 0; k < c->n + 2; k++)
        goal->term[k] = goal->forward.x[k] / (double)c->n;
    return SS_OK;
}

void
ss_cycle_goal_free(cycle_goal *goal)
{
    ss_real_fft_free(&goal->forward);
    ss_real_fft_free(&goal->back);
}

double
ss_cycle_misfit(const cycle_goal *goal, const double *m, double *a, double *shift)
{
    const cycle *c = goal->c;
    const double *g = goal->term;
    double *s = goal->forward.x, *y = goal->back.x, power = 0, mean = 0;
    size_t n = c->n, peak = 0;
    for (size_t i = 0; i < n; i++)
        mean += m[i] / (double)n;
    for (size_t i = 0; i < n; i++) {
        s[i] = m[i] - mean;
        power += s[i] * s[i] / (double)n;
    }
    *a = *shift = 0;
    if (!(power > 0))
        return c->power;
    ss_real_fft_run(&goal->forward);
    for (size_t k = 0; k <= n; k += 2) {        /* the goal's terms times the conjugate of those of m */
        y[k] = g[k] * s[k] + g[k + 1] * s[k + 1];
        y[k + 1] = g[k + 1] * s[k] - g[k] * s[k + 1];
    }
    ss_real_fft_run(&goal->back);
    for (size_t i = 1; i < n; i++)
        if (y[i] > y[peak])
            peak = i;
    /* a parabola through the correlation's three highest values finds the shift between bins */
    double left = y[(peak + n - 1) % n], right = y[(peak + 1) % n];
    double bend = 2 * y[peak] - left - right;
    double offset = bend > 0 ? 0.5 * (right - left) / bend : 0;
    double top = fmax(y[peak] + 0.25 * (right - left) * offset, 0) / (double)n;
    *shift = ((double)peak + offset) / (double)n;
    *a = top / power;
    return fmax(c->power - *a * top, 0);
}
