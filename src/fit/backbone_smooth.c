/* backbone_smooth.c -- what is smooth through the blocks: damping and frequency over amplitude, with bands.
 *
 * What is tracked is (y, rate, p) and constants: y is ln A or the phase, p is the slope of the rate over the
 * e-folds of A that are lost, and a random walk of variance q an e-fold.  Kalman's filter and smoother give mean
 * and variance for each q; in their mixture, weighed by likelihood, 68 % lie in the band.
 *
 * With no mechanism in mind: friction makes damping a power of A, or a sum of such powers, viscous friction A^0,
 * Coulomb's A^-1, drag A^1.  So ln s grows by p, nearly constant; s may be 0 or less: ln s is asinh(s / small), in
 * fact, and the filter goes about the last smooth curve.  w is in units of the mean of s, since friction's
 * stiffness and its losses are of one size. */
#include "fit/backbone.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PASSES = 20 };
#define MOST 12.0               /* of ln s, re the mean, where it moves */
#define LEAST 1e-7              /* of p: less makes no difference, but rounding */
#define KNOWN 1e-14             /* variance of ln A and phase of a block, at least: rounding hides less */
#define FAR 1.0                 /* the most by which ln s and p change in a pass */
#define EXACT 3.0               /* times as likely as not a law is exact */
#define SMALL .005              /* damping over its mean below which its logarithm is none */

static double
dot(const double *a, const double *b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* to = t p t', where t moves the first three states. */
static void
turn(double p[STATES][STATES], double t[3][3], size_t n, int backward)
{
    for (int side = 0; side < 2; side++)
        for (size_t i = 0; i < n; i++) {
            double was[3];
            for (int k = 0; k < 3; k++)
                was[k] = side ? p[i][k] : p[k][i];
            for (int k = 0; k < 3; k++) {
                double is = 0;
                for (int j = 0; j < 3; j++)
                    is += (backward ? t[j][k] : t[k][j]) * was[j];
                *(side ? &p[i][k] : &p[k][i]) = is;
            }
        }
}

/* Take in what is seen at a place, one number after the other, in Joseph's form, which keeps variances positive.
 * Returns its ln likelihood. */
static double
take_in(place *at, size_t n)
{
    double likelihood = 0;
    for (int o = 0; o < 2; o++) {
        double *gain = at->gain[o], with[STATES], left[STATES], *h = at->h[o];
        for (size_t i = 0; i < n; i++) {
            h[i] = at->see[o][i] - (o > 0 ? at->tie * at->see[0][i] : 0);
            with[i] = 0;
        }
        for (size_t i = 0; i < n; i++)
            with[i] = dot(at->p[i], h, n);
        double whole = dot(with, h, n) + at->variance[o], news = at->seen[o] - dot(at->x, h, n);
        for (size_t i = 0; i < n; i++)
            gain[i] = with[i] / whole;
        for (size_t i = 0; i < n; i++) {
            at->x[i] += gain[i] * news;
            for (size_t j = 0; j < n; j++)
                at->p[i][j] -= gain[i] * with[j];
            left[i] = dot(at->p[i], h, n);
        }
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++)
                at->p[i][j] += (at->variance[o] * gain[i] - left[i]) * gain[j];
        at->sure[o] = 1 / whole;
        at->news[o] = news / whole;
        likelihood -= (log(whole) + news * news / whole) / 2;
    }
    return likelihood;
}

/* Set mean and error of a mixture of normal distributions.  Its variance would be that of the widest, which are
 * not likely; within the geometric mean of their widths lie nearly as many as within the width of one. */
static void
mix(double *mean, double *error, double of[WALKS][2], const double weight[WALKS])
{
    double logarithm = 0;
    *mean = 0;
    for (int w = 0; w < WALKS; w++)
        *mean += weight[w] * of[w][0];
    for (int w = 0; w < WALKS; w++)
        logarithm += weight[w] * log(fmax(hypot(of[w][1], of[w][0] - *mean), DBL_MIN));
    *error = exp(logarithm);
}

double
ss_blocks_track(place *at, size_t n, size_t states, const double x[], double start[STATES][STATES], place *end,
                int is_smooth)
{
    double best = -INFINITY, whole = 0, weights[WALKS];
    memset(end, 0, sizeof *end);
    for (int w = 0; w < WALKS; w++) {
        double q = pow(10, -6.5 + .8 * w), likelihood = 0, r[STATES] = { 0 }, sure[STATES][STATES] = { { 0 } };
        memcpy(at->x, x, sizeof at->x);
        memcpy(at->p, start, sizeof at->p);
        at->p[2][2] += q;
        for (size_t i = 0; i < n; i++) {
            likelihood += take_in(&at[i], states);
            if (i + 1 == n)
                break;
            memcpy(at[i + 1].x, at[i].x, sizeof at->x);
            memcpy(at[i + 1].p, at[i].p, sizeof at->p);
            turn(at[i + 1].p, at[i].turn, states, 0);
            for (int k = 0; k < 3; k++) {
                at[i + 1].x[k] = at[i].shift[k] + dot(at[i].turn[k], at[i].x, 3);
                for (int j = 0; j < 3; j++)
                    at[i + 1].p[k][j] += q * at[i].walk[k][j];
            }
        }
        likelihood += w == 0 && states > 3 ? log(EXACT * (WALKS - 1)) : 0;
        double ease = likelihood > best ? exp(best - likelihood) : 1;
        best = fmax(best, likelihood);
        double weight = exp(likelihood - best);
        for (int k = 0; k < w; k++)
            weights[k] *= ease;
        weights[w] = weight;
        whole = whole * ease + weight;
        for (size_t i = 0; i < states; i++) {
            end->x[i] = end->x[i] * ease + weight * at[n - 1].x[i];
            end->of_walk[i][w][0] = at[n - 1].x[i];
            end->of_walk[i][w][1] = sqrt(fmax(at[n - 1].p[i][i], 0));
            for (size_t j = 0; j < states; j++)
                end->p[i][j] = end->p[i][j] * ease
                    + weight * (at[n - 1].p[i][j] + at[n - 1].x[i] * at[n - 1].x[j]);
        }
        for (size_t i = is_smooth ? n : 0; i-- > 0;) {      /* backward, without inverses (Bierman 1973) */
            double with[STATES];
            for (int o = 0; o < 3; o++) {
                double mean = dot(at[i].see[o], at[i].x, states), square = 0;
                for (size_t j = 0; j < states; j++) {
                    with[j] = dot(at[i].p[j], at[i].see[o], states);
                    mean += with[j] * r[j];
                    square += with[j] * at[i].see[o][j];
                }
                for (size_t j = 0; j < states; j++)
                    square -= with[j] * dot(sure[j], with, states);
                at[i].of_walk[o][w][0] = mean;
                at[i].of_walk[o][w][1] = sqrt(fmax(square, 0));
            }
            for (int o = 2; o-- > 0;) {
                const double *h = at[i].h[o], *gain = at[i].gain[o];
                double by = at[i].news[o] - dot(gain, r, states), both = at[i].sure[o];
                for (size_t j = 0; j < states; j++) {
                    with[j] = dot(sure[j], gain, states);
                    r[j] += h[j] * by;
                }
                both += dot(with, gain, states);
                for (size_t j = 0; j < states; j++)
                    for (size_t k = 0; k < states; k++)
                        sure[j][k] += both * h[j] * h[k] - with[j] * h[k] - h[j] * with[k];
            }
            if (i > 0) {
                double was[3] = { r[0], r[1], r[2] };
                for (int k = 0; k < 3; k++) {
                    r[k] = 0;
                    for (int j = 0; j < 3; j++)
                        r[k] += at[i - 1].turn[j][k] * was[j];
                }
                turn(sure, at[i - 1].turn, states, 1);
            }
        }
    }
    for (int w = 0; w < WALKS; w++)
        weights[w] /= whole;
    for (size_t i = 0; is_smooth && i < n; i++)
        for (int o = 0; o < 3; o++)
            mix(&at[i].mean[o], &at[i].error[o], at[i].of_walk[o], weights);
    for (size_t i = 0; i < states; i++) {
        mix(&end->mean[i], &end->error[i], end->of_walk[i], weights);
        end->x[i] /= whole;
    }
    for (size_t i = 0; i < states; i++)
        for (size_t j = 0; j < states; j++)
            end->p[i][j] = end->p[i][j] / whole - end->x[i] * end->x[j];
    return best + log(whole / WALKS);
}

/* Move (ln A, l = asinh(s / small), p) on by a time t: l grows by p an e-fold, so that atan(s / small) grows by p
 * small a time.  lost: the e-folds of that time, and their integral over it. */
static void
move_level(place *at, const double x[3], double t, double small, double lost[2])
{
    const double p = copysign(fmax(fabs(x[2]), LEAST), x[2]), top = atan(sinh(MOST));
    const double from = fmax(-top, fmin(atan(sinh(x[1])), top));
    const double by = fmax(-top - from, fmin(p * small * t, top - from));
    const double to = from + by, middle = from + by / 2, half = sin(by / 2);
    const double gain[2] = { small / cos(from), small / cos(to) };
    const double fall = log1p(2 * sin(middle) * half / cos(to)) / p;
    lost[0] = 2 * atanh(half / cos(middle)) / p;
    lost[1] = t * (lost[0] / 2 + t / 12 * (gain[0] - gain[1]));
    const double turn[3][3] = {
        { 1, -small * sin(by) / cos(from) / cos(to) / p / gain[0], (fall - small * tan(to) * t) / p },
        { 0, gain[1] / gain[0], gain[1] * t }, { 0, 0, 1 } };
    const double moved[3] = { x[0] - fall, x[1] + p * lost[0], x[2] };
    memcpy(at->turn, turn, sizeof turn);
    for (int r = 0; r < 3; r++)
        at->shift[r] = moved[r] - dot(turn[r], x, 3);
}

void
ss_place_walk(place *at, double v)
{
    double gain = at->turn[0][1];
    double w[3][3] = { { gain * gain * v * v * v / 20, gain * v * v * v / 8, gain * v * v / 6 },
                       { gain * v * v * v / 8, v * v * v / 3, v * v / 2 }, { gain * v * v / 6, v * v / 2, v } };
    memcpy(at->walk, w, sizeof w);
}

/* One pass through ln A: the curve is moved to what is smooth about it.  Returns 1 if some is not near it. */
static int
smooth_level(place *p, block *b, size_t n, double small, double (*level)[3], double (*lost)[2], int derivative)
{
    double start[STATES][STATES] = { { 100 }, { 0, 100 }, { 0, 0, 4 } };
    place end;
    int is_far = 0;
    for (size_t i = 0; i < n; i++) {
        double gain = hypot(b[i].at.s, small);
        p[i] = (place){ .see = { { 1 }, { 0, -gain }, { 0, 0, 1 } } };
        ss_place_see(&p[i], &b[i], LEVEL, b[i].y[LEVEL],
                     b[i].rate[LEVEL] + b[i].at.s - gain * asinh(b[i].at.s / small), 1);
        if (i + 1 == n)
            break;
        move_level(&p[i], level[i], b[i + 1].t - b[i].t, small, lost[i]);
        ss_place_walk(&p[i], lost[i][0]);
    }
    ss_blocks_track(p, n, 3, (double[STATES]){ b->y[LEVEL], asinh(b->at.s / small) }, start, &end, 1);
    for (size_t i = 0; i < n; i++) {
        double *to = level[i], gain = hypot(b[i].at.s, small);
        to[0] = b[i].level = p[i].mean[0];
        double by = -p[i].mean[1] / gain - to[1];
        is_far |= fabs(by) > FAR;
        to[1] += fmax(fmin(by, FAR), -FAR);
        to[2] += fmax(fmin(p[i].mean[2] - to[2], FAR), -FAR);
        b[i].at.s = small * sinh(to[1]);
        b[i].error[LEVEL] = p[i].error[1] * hypot(b[i].at.s, small) / gain;
        gain = hypot(b[i].at.s, small);
        b[i].at.ds = gain * gain * to[2];
        b[i].at.dds = 2 * b[i].at.s * pow(gain * to[2], 2);
        double half = fmax(b[i].at.ds, 0) + 2 * b[i].at.s * b[i].error[LEVEL];  /* friction acts by half periods */
        b[i].lag = b[i].at.s * b[i].at.s + b[i].at.ds - given_back(derivative, b[i].at.ds);
        b[i].lag_error = hypot(gain * gain * p[i].error[2], half + not_known(derivative, b[i].at.ds));
    }
    return is_far;
}

static void
smooth_phase(place *p, block *b, size_t n, double unit, double (*lost)[2])
{
    double w = b[n / 2].at.w, last = 0, start[STATES][STATES] = { { 100 }, { 0, 1e6 }, { 0, 0, 100 } };
    place end;
    for (size_t i = 0; i < n; i++) {
        double ahead = i > 0 ? last + (b[i - 1].at.w + b[i].at.w - 2 * w) / 2 * (b[i].t - b[i - 1].t) : 0;
        double t = i + 1 < n ? b[i + 1].t - b[i].t : 0, turns = b[i].y[PHASE] - w * (b[i].t - b->t);
        last = turns - 2 * M_PI * round((turns - ahead) / (2 * M_PI));
        p[i] = (place){ .see = { { 1 }, { 0, unit }, { 0, 0, 1 } },
                        .turn = { { 1, unit * t, unit * lost[i][1] }, { 0, 1, lost[i][0] }, { 0, 0, 1 } } };
        ss_place_see(&p[i], &b[i], PHASE, last, b[i].rate[PHASE] - w, 1);
        ss_place_walk(&p[i], lost[i][0]);
    }
    ss_blocks_track(p, n, 3, (double[STATES]){ p->seen[0] }, start, &end, 1);
    for (size_t i = 0; i < n; i++) {
        b[i].phase = p[i].mean[0] + w * (b[i].t - b->t);
        b[i].at.w = w + p[i].mean[1];
        b[i].at.dw = i + 1 < n ? unit * p[i].mean[2] * lost[i][0] / (b[i + 1].t - b[i].t) : 0;
        b[i].at.ddw = b[i].at.dw * b[i].at.ds / hypot(b[i].at.s, SMALL * unit);
        b[i].error[PHASE] = p[i].error[1];
    }
}

void
ss_place_see(place *at, const block *b, int track, double y, double rate, double unit)
{
    const double *cov = b->cov[track], noise = fmax(b->noise, KNOWN / cov[0]);
    const double tie = cov[1] / cov[0];
    at->tie = tie / unit;
    at->seen[0] = y;
    at->seen[1] = rate - at->tie * y;
    at->variance[0] = cov[0] * noise;
    at->variance[1] = fmax(cov[2] - tie * cov[1], 0) * noise / unit / unit;
}

ss_status
ss_blocks_smooth(block *b, size_t n, const decay_source *source)
{
    place *p = calloc(n, sizeof *p);
    double (*level)[3] = calloc(n, sizeof *level), (*lost)[2] = calloc(n, sizeof *lost);
    double mean = (b[0].y[LEVEL] - b[n - 1].y[LEVEL]) / (b[n - 1].t - b[0].t);
    double unit = fmax(mean, LITTLE / (b[n - 1].t - b[0].t));
    int has_room = p != NULL && level != NULL && lost != NULL;
    for (size_t i = 0; has_room && i < n; i++) {
        size_t lo = i > 2 ? i - 2 : 0, hi = i + 2 < n ? i + 2 : n - 1;
        b[i].at.s = fmax((b[lo].y[LEVEL] - b[hi].y[LEVEL]) / (b[hi].t - b[lo].t), SMALL * unit);
        level[i][0] = b[i].y[LEVEL];
        level[i][1] = asinh(b[i].at.s / (SMALL * unit));
    }
    for (int pass = 0, is_far = 0; has_room && (pass < 4 || (is_far && pass < PASSES)); pass++)
        is_far = smooth_level(p, b, n, SMALL * unit, level, lost, source->derivative);
    if (has_room && source->has_phase)
        smooth_phase(p, b, n, unit, lost);
    free(p);
    free(level);
    free(lost);
    return has_room ? SS_OK : SS_ENOMEM;
}
