/* pulled_rock.h -- recordings of a velocity step by rate and state, with no code of the library: ln V and ln theta
 * by Runge's and Kutta's method, in steps of which thirty make a change. */
#ifndef PULLED_ROCK_H
#define PULLED_ROCK_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <stickslip.h>

#include "uniform.h"

enum { RUNS_AWAY = 20 };        /* of ln V/V0 */

typedef struct rock {
    int is_slip;
    double a, b, Dc, k, drift;  /* [m], [1/m] */
    double speed[4];            /* of the load point, one slide or hold after the other [m/s] */
    double until[4];            /* [s], when they end; 0: there are no more */
    double ramp;                /* [s], over which a speed changes to the next */
    double noise, memory;       /* its standard deviation; what a row keeps of the one before */
    double path_noise;          /* of the recorded path [m] */
    double jump;                /* of its sensor, but not of the load point, at nine tenths of the time [m] */
    int by_time;                /* 1: memory [s], as exp(-t / memory) */
    size_t n;
    int uneven;                 /* 1: rows at random times; 2: a row in ten before the first change */
    double mean;                /* of the friction; 0: .6 */
    int digits;                 /* of path and time in a file; 0: all */
    double step[2];             /* of what a converter gives, of path [um] and friction; 0: none */
} rock;

static inline double
rock_gauss(uint64_t *seed)
{
    double u = uniform(seed);
    return sqrt(-2 * log(1 - u)) * cos(6.283185307179586 * uniform(seed));
}

/* Where the load point is, and its speed. */
static inline double
rock_load(const rock *r, double t, double *speed)
{
    double x = 0, from = 0;
    for (int i = 0; i < 4 && r->until[i] > 0; i++) {
        double before = i > 0 ? r->speed[i - 1] : r->speed[0], ramp = i > 0 ? r->ramp : 0;
        double to = fmin(t, r->until[i]), s = to - from, risen = fmin(s, ramp);
        if (s <= 0)
            break;
        x += r->speed[i] * s - (r->speed[i] - before) * (ramp > 0 ? risen - risen * risen / (2 * ramp) : 0);
        *speed = r->speed[i] - (r->speed[i] - before) * (s < ramp ? 1 - s / ramp : 0);
        from = r->until[i];
    }
    return x;
}

static inline void
rock_slope(const rock *r, double load, const double u[2], double slope[2])
{
    double v = exp(u[0]), w = u[0] + u[1];      /* V/V0, ln(V theta/Dc) */
    slope[1] = r->speed[0] / r->Dc * (r->is_slip ? -v * w : exp(-u[1]) - v);
    slope[0] = r->k / r->a * (load - v * r->speed[0]) - r->b / r->a * slope[1];
}

/* Carry the state from one time to another, between which the load point's speed has no corner. */
static inline void
rock_carry(const rock *r, double u[2], double from, double to)
{
    while (from < to && u[0] < RUNS_AWAY) {
        double fast = (r->k / r->a + 1 / r->Dc) * r->speed[0] * fmax(exp(u[0]), 1), speed = r->speed[0];
        double h = fmin(1 / (30 * fast), to - from), slope[4][2], w[2];
        for (int q = 0; q < 4; q++) {
            double part = q == 0 ? 0 : q == 3 ? 1 : 0.5, at = from + h * part;
            for (int c = 0; c < 2; c++)
                w[c] = u[c] + (q > 0 ? part * h * slope[q - 1][c] : 0);
            rock_load(r, at + 1e-9 * h * (1 - 2 * part), &speed);       /* on this side of a corner */
            rock_slope(r, speed, w, slope[q]);
        }
        for (int c = 0; c < 2; c++)
            u[c] += h / 6 * (slope[0][c] + 2 * slope[1][c] + 2 * slope[2][c] + slope[3][c]);
        from = h < to - from ? from + h : to;
    }
}

static inline double
rock_rounded(const rock *r, double x, double step)
{
    char text[32];
    x = step > 0 ? step * rint(x / step) : x;
    snprintf(text, sizeof text, "%.*g", r->digits > 0 ? r->digits : 17, x);
    return atof(text);
}

/* Times, path [um] and friction, as a signal whose last column is the time; NULL: it runs away. */
static inline ss_signal *
rock_signal(const rock *r, uint64_t *seed)
{
    ss_header *head = NULL;
    ss_signal *s = NULL;
    double end = 0, u[2] = { 0, 0 }, t = 0, noise = rock_gauss(seed), speed = r->speed[0];
    for (int i = 0; i < 4 && r->until[i] > 0; i++)
        end = r->until[i];
    ss_header_new(&head, (double)r->n / end, 0, NULL);
    ss_header_add_column(head, "load", "um", NULL);
    ss_header_add_column(head, "mu", "", NULL);
    ss_header_add_column(head, "t", "s", NULL);
    ss_signal_new(&s, head, r->n, NULL);
    ss_header_free(head);
    for (size_t i = 0; i < r->n; i++) {
        double before = t, part = (double)i / (double)r->n;
        if (r->uneven == 2)
            part = part < 0.25 ? part * 4 * r->until[0] / end : 1 + (part - 1) / 0.75 * (1 - r->until[0] / end);
        t = end * part + (r->uneven == 1 && i > 0 ? 0.7 * end / (double)r->n * uniform(seed) : 0);
        for (double at = before; at < t;) {
            double to = t;
            for (int q = 0; q < 8; q++) {
                double corner = r->until[q / 2] + (q % 2) * r->ramp;
                to = corner > at && corner < to ? corner : to;
            }
            rock_carry(r, u, at, to);
            at = to;
        }
        if (!(fabs(u[0]) < RUNS_AWAY)) {
            ss_signal_free(s);
            return NULL;
        }
        double keep = r->by_time ? exp((before - t) / r->memory) : r->memory, x = rock_load(r, t, &speed);
        noise = keep * noise + sqrt(1 - keep * keep) * rock_gauss(seed);
        double off = t > 0.9 * end ? r->jump : 0;
        s->values[r->n + i] = (r->mean > 0 ? r->mean : 0.6) + r->drift * x + r->a * u[0] + r->b * u[1] + r->noise * noise;
        x += off + (r->path_noise > 0 ? r->path_noise * rock_gauss(seed) : 0);
        s->values[i] = rock_rounded(r, 1e6 * x, r->step[0]);
        if (r->step[1] > 0)
            s->values[r->n + i] = r->step[1] * rint(s->values[r->n + i] / r->step[1]);
        s->values[2 * r->n + i] = rock_rounded(r, t, 0);
    }
    return s;
}

#endif
