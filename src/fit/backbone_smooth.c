/* backbone_smooth.c -- what is smooth through the blocks: damping and frequency over amplitude, with bands.
 *
 * Friction makes damping a power of the amplitude A, or a sum of such powers: viscous friction A^0, Coulomb's
 * A^-1, drag A^1.  So per e-fold of A lost, ln s grows by p, nearly constant; the state is (ln A, ln s, p), and p
 * is a random walk of variance q an e-fold.  s may be 0 or less: ln s is asinh(s / (2 small)), in fact.  The
 * frequency is (phase, w, p) in the same way, w in units of the mean of s, since friction's stiffness and its
 * losses are of one size.  Kalman's filter and smoother, about the last smooth curve, give mean and variance for
 * each q; both are averaged over q by likelihood, which is the band. */
#include "fit/backbone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N = 3, WALKS = 12, PASSES = 6, PARTS = 4 };
#define MOST 12.0               /* of ln s, re the mean, where it moves */
#define FAR 1.0                  /* the most by which ln s and p change in a pass */
#define SMALL 0.05              /* damping over its mean below which its logarithm is none */

typedef struct step {           /* from a block to the next: x becomes turn x + shift, with variance q walk */
    double turn[N][N], shift[N], walk[N][N];
} step;

typedef struct moment {
    double x[N], p[N][N];
} moment;

typedef struct place {          /* of a block */
    double y, rate, r[3];       /* measured: y and the second state; their variances */
    step step;                  /* to the next */
    moment after;               /* what it and the blocks before tell */
    double keep[N][N], news[2], sure[2][2];     /* of the filter's step: I - K H, S^-1 e, S^-1 */
    double level[N];            /* (ln A, asinh s, p) about which the level is linear */
    double lost, delay;         /* e-folds to the next block, and their integral over time */
    double mean[N], square[N];  /* over the walks, with weights */
} place;

/* (ln A, ln s, p) a time later; e-folds lost, in units of the state, and their integral over that time. */
static void
move_level(double x[N], double t, double small, double *lost, double *delay)
{
    double v = 0, sum = 0, h = t / PARTS;
    for (int i = 0; i < PARTS; i++) {
        double k[4][3], at[3], l = x[1], y = x[0];
        for (int j = 0; j < 4; j++) {
            double part = j == 0 ? 0 : j < 3 ? h / 2 : h;
            for (int c = 0; c < 3; c++)
                at[c] = (c == 0 ? y : c == 1 ? l : v) + (j > 0 ? part * k[j - 1][c] : 0);
            double gain = small * cosh(fmin(fabs(at[1]), MOST));
            k[j][0] = -small * sinh(fmax(fmin(at[1], MOST), -MOST));
            k[j][1] = gain * x[2];
            k[j][2] = gain;
        }
        double last = v, slope = k[0][2];
        x[0] = y + h / 6 * (k[0][0] + 2 * k[1][0] + 2 * k[2][0] + k[3][0]);
        x[1] = l + h / 6 * (k[0][1] + 2 * k[1][1] + 2 * k[2][1] + k[3][1]);
        v += h / 6 * (k[0][2] + 2 * k[1][2] + 2 * k[2][2] + k[3][2]);
        sum += h * (last + v) / 2 + h * h / 12 * (slope - small * cosh(fmin(fabs(x[1]), MOST)));
    }
    *lost = v;
    *delay = sum;
}

static void
walk_of(step *s, double gain, double v)
{
    double w[N][N] = { { gain * gain * v * v * v / 20, gain * v * v * v / 8, gain * v * v / 6 },
                       { gain * v * v * v / 8, v * v * v / 3, v * v / 2 }, { gain * v * v / 6, v * v / 2, v } };
    memcpy(s->walk, w, sizeof w);
}

static void
level_step(place *p, double t, double small)
{
    double x[N], moved[2][N], v, d;
    memcpy(x, p->level, sizeof x);
    move_level(x, t, small, &p->lost, &p->delay);
    p->step = (step){ .turn = { { 1 }, { 0 }, { 0 } } };
    for (int c = 1; c < N; c++) {
        for (int side = 0; side < 2; side++) {
            memcpy(moved[side], p->level, sizeof x);
            moved[side][c] += side ? 1e-4 : -1e-4;
            move_level(moved[side], t, small, &v, &d);
        }
        for (int r = 0; r < N; r++)
            p->step.turn[r][c] = (moved[1][r] - moved[0][r]) / 2e-4;
    }
    for (int r = 0; r < N; r++) {
        p->step.shift[r] = x[r];
        for (int c = 0; c < N; c++)
            p->step.shift[r] -= p->step.turn[r][c] * p->level[c];
    }
    walk_of(&p->step, p->step.turn[0][1], p->lost);
}

static void
phase_step(place *p, double t, double unit)
{
    p->step = (step){ .turn = { { 1, unit * t, unit * p->delay }, { 0, 1, p->lost }, { 0, 0, 1 } } };
    walk_of(&p->step, unit * t, p->lost);
}

/* to = f p f' + q w; backward: f' p f. */
static void
carry(double to[N][N], double f[N][N], double p[N][N], double q, double w[N][N], int backward)
{
    double half[N][N] = { { 0 } };
    for (int r = 0; r < N; r++)
        for (int c = 0; c < N; c++)
            for (int k = 0; k < N; k++)
                half[r][c] += (backward ? f[k][r] : f[r][k]) * p[k][c];
    for (int r = 0; r < N; r++)
        for (int c = 0; c < N; c++) {
            to[r][c] = q > 0 ? q * w[r][c] : 0;
            for (int k = 0; k < N; k++)
                to[r][c] += half[r][k] * (backward ? f[k][c] : f[c][k]);
        }
}

static void
apply(double to[N], double f[N][N], const double x[N], int backward)
{
    for (int r = 0; r < N; r++) {
        to[r] = 0;
        for (int k = 0; k < N; k++)
            to[r] += (backward ? f[k][r] : f[r][k]) * x[k];
    }
}

/* Take in y and rate, in Joseph's form, which keeps variances positive.  Returns their ln likelihood. */
static double
take_in(moment *m, place *b)
{
    double s00 = m->p[0][0] + b->r[0], s01 = m->p[0][1] + b->r[1], s11 = m->p[1][1] + b->r[2];
    double det = s00 * s11 - s01 * s01, i[2][2] = { { s11 / det, -s01 / det }, { -s01 / det, s00 / det } };
    double e[2] = { b->y - m->x[0], b->rate - m->x[1] }, r[2][2] = { { b->r[0], b->r[1] }, { b->r[1], b->r[2] } };
    double p[N][N], noise[N][N] = { { 0 } }, gain[N][2];
    for (int k = 0; k < N; k++)
        for (int c = 0; c < N; c++) {
            if (c < 2)
                gain[k][c] = m->p[k][0] * i[0][c] + m->p[k][1] * i[1][c];
            b->keep[k][c] = (k == c) - (c < 2 ? gain[k][c] : 0);
        }
    for (int k = 0; k < N; k++)
        for (int c = 0; c < N; c++)
            for (int a = 0; a < 2; a++)
                noise[k][c] += gain[k][a] * (r[a][0] * gain[c][0] + r[a][1] * gain[c][1]);
    carry(p, b->keep, m->p, 1, noise, 0);
    memcpy(m->p, p, sizeof p);
    for (int k = 0; k < N; k++)
        m->x[k] += gain[k][0] * e[0] + gain[k][1] * e[1];
    for (int k = 0; k < 2; k++) {
        b->news[k] = i[k][0] * e[0] + i[k][1] * e[1];
        b->sure[k][0] = i[k][0];
        b->sure[k][1] = i[k][1];
    }
    return -(log(det) + e[0] * b->news[0] + e[1] * b->news[1]) / 2;
}

/* Set mean and square of each place, over the walks: Kalman's filter forward, and backward the form of the
 * smoother without inverses (Bierman 1973). */
static void
smooth(place *p, size_t n, const moment *start)
{
    double best = -INFINITY, whole = 0;
    for (int w = 0; w < WALKS; w++) {
        double q = pow(10, -3 + .5 * w), likelihood = 0, news[N] = { 0 }, sure[N][N] = { { 0 } };
        moment m = *start;
        for (size_t i = 0; i < n; i++) {
            likelihood += take_in(&m, &p[i]);
            p[i].after = m;
            if (i + 1 == n)
                break;
            apply(m.x, p[i].step.turn, p[i].after.x, 0);
            for (int k = 0; k < N; k++)
                m.x[k] += p[i].step.shift[k];
            carry(m.p, p[i].step.turn, p[i].after.p, q, p[i].step.walk, 0);
        }
        double ease = likelihood > best ? exp(best - likelihood) : 1;
        best = fmax(best, likelihood);
        double weight = exp(likelihood - best);
        for (size_t i = n; i-- > 0;) {
            double less[N], lessened[N][N], now[N], was[N][N];
            apply(less, p[i].after.p, news, 0);
            carry(lessened, p[i].after.p, sure, 0, NULL, 0);
            for (int k = 0; k < N; k++) {
                double x = p[i].after.x[k] + less[k], square = fmax(p[i].after.p[k][k] - lessened[k][k], 0);
                p[i].mean[k] = p[i].mean[k] * ease + weight * x;
                p[i].square[k] = p[i].square[k] * ease + weight * (square + x * x);
            }
            apply(now, p[i].keep, news, 1);
            carry(was, p[i].keep, sure, 0, NULL, 1);
            for (int k = 0; k < 2; k++) {
                now[k] += p[i].news[k];
                was[k][0] += p[i].sure[k][0];
                was[k][1] += p[i].sure[k][1];
            }
            if (i > 0) {
                apply(news, p[i - 1].step.turn, now, 1);
                carry(sure, p[i - 1].step.turn, was, 0, NULL, 1);
            }
        }
        whole = whole * ease + weight;
    }
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < N; k++) {
            p[i].mean[k] /= whole;
            p[i].square[k] = fmax(p[i].square[k] / whole - p[i].mean[k] * p[i].mean[k], 0);
        }
}

static void
smooth_level(place *p, block *b, size_t n, double small)
{
    for (size_t i = 0; i < n; i++) {
        double gain = hypot(b[i].at.s, small), *r = b[i].cov[LEVEL];
        p[i].y = b[i].y[LEVEL];
        p[i].rate = asinh(b[i].at.s / small) + (-b[i].rate[LEVEL] - b[i].at.s) / gain;
        p[i].r[0] = r[0] * b[i].noise, p[i].r[1] = -r[1] * b[i].noise / gain;
        p[i].r[2] = r[2] * b[i].noise / gain / gain;
        p[i].mean[0] = p[i].mean[1] = p[i].mean[2] = 0;
        memset(p[i].square, 0, sizeof p[i].square);
        if (i + 1 < n)
            level_step(&p[i], b[i + 1].t - b[i].t, small);
    }
    smooth(p, n, &(moment){ { p->y, p->rate, 0 }, { { 100, 0, 0 }, { 0, 100, 0 }, { 0, 0, 4 } } });
    for (size_t i = 0; i < n; i++) {
        double *to = p[i].level;
        to[0] = b[i].level = p[i].mean[0];
        to[1] += fmax(fmin(p[i].mean[1] - to[1], FAR), -FAR);
        to[2] += fmax(fmin(p[i].mean[2] - to[2], FAR), -FAR);
        b[i].at.s = small * sinh(to[1]);
        double gain = hypot(b[i].at.s, small);
        b[i].at.ds = gain * gain * to[2];
        b[i].error[LEVEL] = gain * sqrt(p[i].square[1]);
        b[i].bend_error = gain * gain * sqrt(p[i].square[2]);
    }
}

static void
smooth_phase(place *p, block *b, size_t n, double unit)
{
    double w = b[n / 2].at.w, turns = 0;
    for (size_t i = 0; i < n; i++) {
        double *r = b[i].cov[PHASE], ahead = i > 0 ? p[i - 1].y + (b[i - 1].at.w + b[i].at.w - 2 * w) / 2
            * (b[i].t - b[i - 1].t) : 0;
        turns = b[i].y[PHASE] - w * (b[i].t - b->t);
        p[i].y = turns - 2 * M_PI * round((turns - ahead) / (2 * M_PI));
        p[i].rate = (b[i].rate[PHASE] - w) / unit;
        p[i].r[0] = r[0] * b[i].noise, p[i].r[1] = r[1] * b[i].noise / unit;
        p[i].r[2] = r[2] * b[i].noise / unit / unit;
        p[i].mean[0] = p[i].mean[1] = p[i].mean[2] = 0;
        memset(p[i].square, 0, sizeof p[i].square);
        if (i + 1 < n)
            phase_step(&p[i], b[i + 1].t - b[i].t, unit);
    }
    smooth(p, n, &(moment){ { p->y, p->rate, 0 }, { { 100, 0, 0 }, { 0, 1e6, 0 }, { 0, 0, 100 } } });
    for (size_t i = 0; i < n; i++) {
        b[i].phase = p[i].mean[0] + w * (b[i].t - b->t);
        b[i].at.w = w + unit * p[i].mean[1];
        b[i].at.dw = i + 1 < n ? unit * p[i].mean[2] * p[i].lost / (b[i + 1].t - b[i].t) : 0;
        b[i].error[PHASE] = unit * sqrt(p[i].square[1]);
    }
}

ss_status
ss_blocks_smooth(block *b, size_t n, int has_phase)
{
    place *p = calloc(n, sizeof *p);
    double mean = (b[0].y[LEVEL] - b[n - 1].y[LEVEL]) / (b[n - 1].t - b[0].t);
    double unit = fmax(mean, .1 / (b[n - 1].t - b[0].t));
    if (p == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        size_t lo = i > 2 ? i - 2 : 0, hi = i + 2 < n ? i + 2 : n - 1;
        b[i].at.s = fmax((b[lo].y[LEVEL] - b[hi].y[LEVEL]) / (b[hi].t - b[lo].t), SMALL * unit);
        p[i].level[0] = b[i].y[LEVEL];
        p[i].level[1] = asinh(b[i].at.s / (SMALL * unit));
    }
    for (int pass = 0; pass < PASSES; pass++)
        smooth_level(p, b, n, SMALL * unit);
    if (has_phase)
        smooth_phase(p, b, n, unit);
    free(p);
    return SS_OK;
}
