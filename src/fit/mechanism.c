/* mechanism.c -- which friction makes a decay, and its parameters.
 *
 * A mechanism says how the losses s and the frequency w depend on the amplitude A.  The fundamental z of the
 * motion then has z'' + 2 s(A) z' + w(A)^2 z = 0, so that its amplitude falls by s / (1 + A w_A / (2 w)), and that
 * of z' or z'' by s / (1 - A w_A / (2 w)) or s / (1 - 3 A w_A / (2 w)), of A in the column's unit: that is the
 * damping which rows show.  Its phase grows by sqrt(w^2 - s^2 - s').  These are integrated through the blocks, and
 * the parameters are fitted to the blocks' amplitudes, phases and rates.
 *
 * All this is good to some percent of s, as the motion is no sine: that is a random walk of ln A and of the phase
 * beside the errors of the blocks, and the filter that knows both makes residuals of variance 1.  If a slider is
 * best, its exact motion is cut into the same blocks and fitted instead, as it may slip for a cycle only.
 * The mechanism with the lowest BIC is named if chi^2 allows it; it cannot be told from a rival that is nearly as
 * good, unless the rival contains it. */
#include "fit/backbone.h"

#include <complex.h>
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/least.h"
#include "base/list.h"
#include "fit/column.h"

enum { LN_A, TURN, W, S, C, SHAPE, BEND, RATIO, UNKNOWNS };     /* at the start; w; viscous s; of the mechanism */
enum { TAKEN = 64, EXACT_MOST = 1 << 15, NEWTON = 12 };     /* samples of the smooth curve to begin from; of an
                                                               exact motion; steps */
/* No mechanisms, but rivals of all; by geometry w changes as A^2, as of a pendulum, and s does not. */
enum { TWO_MODES = SS_MECHANISMS, GEOMETRY, LAWS };
#define LEAST_TURN .2           /* of ln A over ln x: A of x'' falls nearly as x grows where k is large */
#define SLIPPING .2             /* of what rates change by in half a period: the error of what a slider, which
                                   slips in a part of it, is said to do */
#define HARMONIC .15            /* times a contact's stiffness re the spring's: the error that a sine makes */
#define ROUNDED 1e-11           /* variance of ln A and phase of a block, at least, beside numbers of a law */
#define GONE 1e-3               /* of the last amplitude: what a law says behind it, at least */
#define STUCK .2                /* of ln A below where a slider sticks, its last slip is past */
#define TOLD 6.0                /* of BIC: less does not tell the better one */
#define SOFTER .5               /* of its losses c: by Masing's rules friction softens by pi/4 (1 + 2/p) c */
#define REJECT 1e-3             /* probability of so large a chi^2 */

const char *const ss_mechanism_names[SS_MECHANISMS] = {
    "viscous", "coulomb", "viscous+coulomb", "jenkins", "microslip", "quadratic" };

static const struct law {
    int free[UNKNOWNS];
    unsigned contains;          /* the mechanisms that are cases of it, as bits */
    ss_range shapes;            /* of the power of A, or of where Jenkins slips */
} laws[LAWS] = {
    [SS_VISCOUS] = { { 1, 1, 1, 1 }, 0, { 1, 1 } },
    [SS_COULOMB_DAMPING] = { { 1, 1, 1, 0, 1 }, 0, { -1, -1 } },
    [SS_VISCOUS_AND_COULOMB] = { { 1, 1, 1, 1, 1 }, 1 << SS_VISCOUS | 1 << SS_COULOMB_DAMPING, { -1, -1 } },
    [SS_JENKINS] = { { 1, 1, 1, 1, 1, 1 },     /* of a stiff spring it is Coulomb's */
                     1 << SS_VISCOUS | 1 << SS_COULOMB_DAMPING | 1 << SS_VISCOUS_AND_COULOMB,
                     { .01, 1 } },
    [SS_MICROSLIP] = { { 1, 1, 1, 1, 1, 1, 1 }, 1 << SS_VISCOUS | 1 << SS_QUADRATIC, { .1, 1 } },
    [SS_QUADRATIC] = { { 1, 1, 1, 0, 1 }, 0, { 1, 1 } },
    [TWO_MODES] = { { 1, 1, 1, 1, 1, 1, 1, 1 }, 0, { -1e9, 1e9 } },
    [GEOMETRY] = { { 1, 1, 1, 1, 0, 0, 1 }, 0, { 2, 2 } },
};

/* A block for the fit: in units of the start's amplitude and of the mean damping. */
typedef struct point {
    double t, y[TRACKS], rate[TRACKS];
    double tie[TRACKS], rate_sigma[TRACKS];     /* of the rate's error to that of y, and the rest of it */
    double gain[TRACKS], whole[TRACKS];     /* of the filter; the error of what it does not expect */
    double half;                /* of a block behind the last, whose y count as amplitudes; 0: it is not behind */
} point;

typedef struct trial {
    int kind;                   /* an ss_mechanism or a rival */
    const point *p;
    size_t n, behind, tracks;
    double w;                   /* about which w is counted, in units of the mean damping */
    struct told *told;          /* n + behind to work with */
    const block *b;             /* n + behind, from which points are */
    double unit, ln_a;          /* mean damping, per sample; ln of the start's amplitude */
    int is_exact;               /* 1: a slider's blocks are those of its motion */
    const decay_source *source;
} trial;

/* At ln A: s and w, and their slopes over ln A.  s = u[S] + u[C] A^u[SHAPE] and w = of->w + u[W] - u[BEND]
 * A^u[SHAPE]; or those of Jenkins, whose spring of stiffness u[C] of->w re the mass slips at u[SHAPE]:
 * there A, as any derivative of x, is x w^order, so that ln x is found by Newton's method. */
static void
law_at(const trial *of, const double u[UNKNOWNS], double ln_a, double s[2], double w[2])
{
    const double free_w = of->w + u[W], k = u[C] * of->w, order = fmax(of->source->derivative, 0);
    if (of->kind != SS_JENKINS) {
        double g = exp(u[SHAPE] * ln_a);
        s[0] = u[S] + u[C] * g, s[1] = u[SHAPE] * u[C] * g;
        w[0] = free_w - u[BEND] * g, w[1] = -u[SHAPE] * u[BEND] * g;
        return;
    }
    double x = ln_a, stuck, sine, cosine, turn, off;
    int steps = NEWTON;
    do {
        stuck = fmin(u[SHAPE] * exp(-x), 1), sine = 2 * sqrt(stuck * (1 - stuck)), cosine = 1 - 2 * stuck;
        w[0] = sqrt(free_w * free_w + k / M_PI * (acos(cosine) - sine * cosine));
        w[1] = -2 * k / M_PI * stuck * sine / w[0];
        turn = fmax(1 + order * w[1] / w[0], LEAST_TURN);       /* of ln A over ln x */
        off = ln_a - x + order / 2 * log((free_w * free_w + k) / (w[0] * w[0]));
        x += off / turn;
    } while (fabs(off) > 1e-12 && --steps > 0);
    s[0] = k / (2 * M_PI) * sine * sine / w[0];
    s[1] = stuck < 1 ? (-2 * k / M_PI * stuck * cosine / w[0] - s[0] * w[1] / w[0]) / turn : 0;
    w[1] /= turn;
    s[0] += u[S];
}

/* The rates of ln A and of the phase, less of->w, at ln A; and what damping takes from the square of w: s^2 + s',
 * less what harmonics give, which of Coulomb's friction take s' again, and of drag s' + .183 s^2 (all of them);
 * and how far that is unknown: in its next order in s/w. */
static void
rates(const trial *of, const double u[UNKNOWNS], double ln_a, double rate[TRACKS], double lag[2])
{
    double s[2], w[2];
    law_at(of, u, fmax(fmin(ln_a, 20), -40), s, w);
    double fall = s[0] / (1 + (.5 - fmax(of->source->derivative, 0)) * w[1] / w[0]);
    double s_dot = -fall * s[1], own = s[0] - u[S];
    lag[0] = of->kind == SS_JENKINS || of->kind == SS_MICROSLIP ? s[0] * s[0] + s_dot
        : of->kind == SS_QUADRATIC ? .183 * s[0] * s[0] : u[S] * u[S] + 3 * own * s[0];
    lag[0] -= given_back(of->source->derivative, s_dot);
    lag[1] = hypot(not_known(of->source->derivative, s_dot), (lag[0] - u[S] * u[S]) * s[0] / w[0]);
    rate[LEVEL] = -fmin(fall, 1e4);
    rate[PHASE] = sqrt(fmax(w[0] * w[0] - lag[0], 0)) - of->w;
}

/* What a mechanism says of a block: ln A and phase, and their rates. */
typedef struct told {
    double y[TRACKS], rate[TRACKS], lag[2];
    double slip[TRACKS];        /* what the law does not know of the rates */
    double left;                /* what a bend leaves of an exact motion, as of a block */
} told;

/* Carry ln A and the phase on over dt, which may be negative. */
static void
carry_on(const trial *of, const double u[UNKNOWNS], double dt, double y[TRACKS], double lag[2])
{
    double k[4][TRACKS];
    int parts = 1;
    rates(of, u, y[LEVEL], k[0], lag);
    parts += (int)fmin(fabs(dt) * fmax(-k[0][LEVEL], 1) / .2, 8);
    for (int part = 0; part < parts; part++) {
        double h = dt / parts;
        for (int j = 0; j < 4; j++)
            rates(of, u, y[LEVEL] + (j == 0 ? 0 : (j < 3 ? h / 2 : h) * k[j - 1][LEVEL]), k[j], lag);
        for (size_t c = 0; c < TRACKS; c++)
            y[c] += h / 6 * (k[0][c] + 2 * k[1][c] + 2 * k[2][c] + k[3][c]);
    }
}

/* Where a slider slips for a cycle or two, the law is an average over too little.  So move the exact model from a
 * turn before the blocks on, cut its motion into the same blocks, up to where it sticks, and see what they tell.
 * *told_blocks, which is 0, becomes their number, unless it cannot be moved so. */
static ss_status
tell_exactly(told *out, size_t *told_blocks, const trial *of, const double u[UNKNOWNS])
{
    const block *b = of->b;
    const int order = of->source->derivative > 0 ? of->source->derivative : 0;
    double w = (of->w + u[W]) * of->unit, contact = u[C] * of->w * of->unit * of->unit, rate[TRACKS], steps = 0;
    double y[TRACKS] = { u[LN_A], u[TURN] - M_PI / 2 * order }, back = (b->t - (double)b->first) * of->unit;
    size_t n = 1, done = 0;
    while (n < of->n && b[n - 1].level - of->ln_a > log(u[SHAPE]) - STUCK)
        n++;
    rates(of, u, y[LEVEL], rate, out->lag);
    double turns = floor((y[PHASE] - (rate[PHASE] + of->w) * back) / M_PI) - 1;
    double ahead = (y[PHASE] - turns * M_PI) / (rate[PHASE] + of->w);
    carry_on(of, u, -ahead, y, out->lag);
    rates(of, u, y[LEVEL], rate, out->lag);
    double a = exp(of->ln_a + y[LEVEL]) / pow((rate[PHASE] + of->w) * of->unit, order);
    size_t end = b[n - 1].end - b->first;
    ss_scene scene = { .model = ss_model_named("compliant"), .mass = 1, .stiffness = w * w,
                       .damping = 2 * u[S] * of->unit,
                       .friction = contact * u[SHAPE] * exp(of->ln_a) / pow(w * w + contact, order / 2.),
                       .x0 = fmod(turns, 2) == 0 ? a : -a, .settle = (ahead - back) / of->unit,
                       .duration = (double)end, .rate = 1 };
    if (end > EXACT_MOST || ss_scene_set(&scene, "contact_stiffness", contact, NULL) != SS_OK
        || ss_scene_set(&scene, "contact_damping", 0, NULL) != SS_OK)
        return SS_OK;
    double *x = malloc(end * sizeof *x);
    ss_status st = x != NULL ? ss_samples_run(&scene, order, SAMPLES_FINE, x, NULL, end, &steps) : SS_ENOMEM;
    for (block is; st == SS_OK && done < n; done++) {
        size_t first = b[done].first - b->first, last = b[done].end - b->first;
        if (!ss_block_fit(&is, x, first, last, b[done].about, &of->source->beside, b[done].steps))
            break;
        double turn = is.y[PHASE] - of->w * (of->p[done].t - of->p->t);
        turn -= 2 * M_PI * round((turn - of->p[done].y[PHASE]) / (2 * M_PI));
        out[done] = (told){ .y = { is.y[LEVEL] - of->ln_a, turn }, .left = is.left };
        for (int c = 0; c < TRACKS; c++)
            out[done].rate[c] = is.rate[c] / of->unit - (c == PHASE ? of->w : 0);
        rates(of, u, out[done].y[LEVEL], rate, out[done].lag);
    }
    free(x);
    *told_blocks = done == n ? n : 0;
    return st == SS_ENOMEM ? st : SS_OK;
}

static ss_status
tell(told *out, const trial *of, const double u[UNKNOWNS])
{
    double y[TRACKS] = { u[LN_A], u[TURN] };
    size_t i = 0;
    /* two modes that beat: of s = u[S] and w = u[W], and of u[C] and u[SHAPE] beside it */
    const double complex one = -u[S] + u[W] * I, other = -u[C] + u[SHAPE] * I;
    for (; of->kind == TWO_MODES && i < of->n + of->behind; i++) {
        const point *p = &of->p[i];
        double complex a = cexp(one * p->t), b = cexp(u[BEND] + u[RATIO] * I + other * p->t);
        double complex sum = a + b, rate = (one * a + other * b) / sum;
        double turn = u[TURN] + carg(sum);
        out[i] = (told){ .y = { u[LN_A] + log(cabs(sum)),
                                turn + 2 * M_PI * round((p->y[PHASE] - turn) / (2 * M_PI)) },
                         .rate = { creal(rate), cimag(rate) } };
    }
    if (of->kind == TWO_MODES)
        return SS_OK;
    ss_status st = of->kind == SS_JENKINS && of->is_exact ? tell_exactly(out, &i, of, u) : SS_OK;
    if (i > 0)
        memcpy(y, out[i - 1].y, sizeof y);
    for (; i < of->n; i++) {
        carry_on(of, u, i > 0 ? of->p[i].t - of->p[i - 1].t : 0, y, out[i].lag);
        memcpy(out[i].y, y, sizeof y);
        rates(of, u, y[LEVEL], out[i].rate, out[i].lag);
    }
    /* behind them the mean over a block, by Simpson's rule; where friction stops the motion ln A has no end */
    double gone = y[LEVEL] + log(GONE), h = 0, turn = y[PHASE], lag[2];
    for (; i < of->n + of->behind; i++) {
        const double apart = of->p[i].t - of->p[i - 1].t, first = apart - h - of->p[i].half;
        double mean = 0;
        h = of->p[i].half;
        for (int part = 0; part < 3; part++) {
            carry_on(of, u, part == 0 ? first : h, y, lag);
            y[LEVEL] = fmax(y[LEVEL], gone);
            mean += (part == 1 ? 4 : 1) * exp(y[LEVEL]) / 6;
        }
        out[i].y[LEVEL] = log(mean);
        out[i].y[PHASE] = turn += apart * out[of->n - 1].rate[PHASE];
    }
    return st;
}

/* What a law leaves of the oscillation behind the last block, along and across it, where a walk is off. */
static void
leave_behind(double left[TRACKS], const point *p, const told *says, const double off[TRACKS])
{
    double turn = p->y[PHASE] - says->y[PHASE] - off[PHASE], seen = exp(p->y[LEVEL]);
    left[LEVEL] = seen * cos(turn) - exp(fmin(says->y[LEVEL] + off[LEVEL], 40));
    left[PHASE] = seen * sin(turn);
}

/* Residuals of variance 1 if the mechanism is right: of y by the filter's gains, of rates beside y's. */
static ss_status
leave(const double *u, double *residual, double *slopes, void *user)
{
    const trial *of = user;
    double off[TRACKS] = { 0 };
    (void)slopes;
    if (tell(of->told, of, u) != SS_OK)
        return SS_ENOMEM;
    for (size_t i = 0; i < of->n; i++)
        for (size_t c = 0; c < of->tracks; c++) {
            const point *p = &of->p[i];
            double left = p->y[c] - of->told[i].y[c], news = left - off[c];
            *residual++ = news / p->whole[c];
            *residual++ = (p->rate[c] - of->told[i].rate[c] - p->tie[c] * left) / p->rate_sigma[c];
            off[c] += p->gain[c] * news;
        }
    for (size_t i = of->n; i < of->n + of->behind; i++) {
        double left[TRACKS];
        leave_behind(left, &of->p[i], &of->told[i], off);
        for (int c = 0; c < TRACKS; c++)
            *residual++ = left[c] / of->p[i].whole[c];
    }
    const double *last = of->told[of->n - 1].y;
    return isfinite(last[LEVEL]) && isfinite(last[PHASE]) ? SS_OK : SS_EDATA;
}

/* Blocks in units of the start's amplitude and of the mean damping; errors of what a mechanism says. */
static void
make_points(point *p, const block *b, size_t n, size_t behind, double unit, double ln_a, double w)
{
    double walked[TRACKS] = { 0 };
    for (size_t i = 0; i < n + behind; i++) {
        double before_it = i > 0 && i <= n ? b[i - 1].at.s : 0, behind_it = i + 1 < n ? b[i + 1].at.s : 0;
        double s = fmax(i < n ? b[i].at.s : b[n - 1].at.s, fmax(before_it, behind_it)) / unit;
        double step = i > 0 ? (b[i].t - b[i - 1].t) * unit : 0;
        p[i].t = b[i].t * unit;
        p[i].y[LEVEL] = b[i].y[LEVEL] - ln_a;
        p[i].y[PHASE] = b[i].y[PHASE] - w * (b[i].t - b->t);
        p[i].y[PHASE] -= 2 * M_PI * round((p[i].y[PHASE] - (b[i].phase - w * (b[i].t - b->t))) / (2 * M_PI));
        p[i].rate[LEVEL] = b[i].rate[LEVEL] / unit;
        p[i].rate[PHASE] = (b[i].rate[PHASE] - w) / unit;
        for (int c = 0; c < TRACKS; c++) {
            const double *cov = b[i].cov[c];
            double trust = SLIGHT * s, before = walked[c] + trust * trust * step * step;
            double whole = before + b[i].noise * cov[0];
            p[i].whole[c] = sqrt(whole);
            p[i].gain[c] = before / whole;
            walked[c] = before * (1 - p[i].gain[c]);
            p[i].tie[c] = cov[1] / cov[0] / unit;
            if (i >= n) {
                p[i].half = (double)(b[i].end - b[i].first) / 2 * unit;
                double law = sqrt(before + pow(b[n - 1].at.s / w, 2)) * exp(b[n - 1].level - ln_a);
                p[i].whole[c] = hypot(sqrt(b[i].noise * cov[0]) * exp(p[i].y[LEVEL]), law);
                walked[c] = before;
                continue;
            }
            double alone = b[i].noise * fmax(cov[2] - cov[1] * cov[1] / cov[0], 0);
            p[i].rate_sigma[c] = hypot(sqrt(alone) / unit, trust);
        }
    }
}

/* Set u[S] and u[C] >= 0 so that s fits the smooth one, and W and BEND by w; returns what the first leaves. */
static double
begin(const trial *of, double u[UNKNOWNS])
{
    const struct law *law = &laws[of->kind];
    const block *b = of->b;
    const double unit = of->unit, ln_a = of->ln_a;
    const double only[UNKNOWNS] = { [C] = 1, [SHAPE] = u[SHAPE] };
    double sum[6] = { 0 }, of_c[2], w[2];
    for (size_t i = 0; i < of->n; i++) {
        law_at(of, only, b[i].level - ln_a, of_c, w);
        double s = b[i].at.s / unit, g = of_c[0];
        double weight = 1 / (pow(b[i].error[LEVEL] / unit, 2) + pow(SLIGHT * s, 2));
        sum[0] += weight, sum[1] += weight * g, sum[2] += weight * g * g;
        sum[3] += weight * s, sum[4] += weight * s * g, sum[5] += weight * s * s;
    }
    double det = sum[0] * sum[2] - sum[1] * sum[1], c = (sum[0] * sum[4] - sum[1] * sum[3]) / det;
    int both = law->free[S] && law->free[C] && det > 1e-12 * sum[0] * sum[2];
    u[C] = !law->free[C] ? 0 : both ? fmax(c, 1e-3) : sum[4] / sum[2];
    u[S] = !law->free[S] ? 0 : both ? fmax((sum[3] - u[C] * sum[1]) / sum[0], 1e-3) : sum[3] / sum[0];
    const bend *first = &b->at, *last = &b[of->n - 1].at;
    double end = b[of->n - 1].level - ln_a;
    u[LN_A] = b->level - ln_a;
    u[TURN] = b->phase;
    u[W] = u[BEND] = 0;
    if (law->free[BEND])
        u[BEND] = (last->w - first->w) / unit / (1 - exp(u[SHAPE] * end));
    if (of->kind == SS_MICROSLIP)
        u[BEND] = fmax(u[BEND], 0);
    law_at(of, u, end, of_c, w);
    u[W] = last->w / unit - w[0];
    return sum[5] + u[S] * (u[S] * sum[0] + 2 * u[C] * sum[1] - 2 * sum[3]) + u[C] * (u[C] * sum[2] - 2 * sum[4]);
}

/* Solve sum |z[k + 2] - c[1] z[k + 1] - c[0] z[k]|^2 / |z[k]|^2 = least for c, or with modes z[k] = c[0] m[0]^k +
 * c[1] m[1]^k. */
static void
solve_two(double complex c[2], const double complex *z, size_t n, const double complex *mode)
{
    double aa = 0, bb = 0;
    double complex ab = 0, ay = 0, by = 0;
    for (size_t k = 0; k + 2 < n; k++) {
        double weight = 1 / (creal(z[k]) * creal(z[k]) + cimag(z[k]) * cimag(z[k]));
        double complex a = mode != NULL ? cpow(mode[0], (double)k) : z[k];
        double complex b = mode != NULL ? cpow(mode[1], (double)k) : z[k + 1], y = z[mode != NULL ? k : k + 2];
        aa += weight * creal(a * conj(a)), bb += weight * creal(b * conj(b));
        ab += weight * conj(a) * b, ay += weight * conj(a) * y, by += weight * conj(b) * y;
    }
    double det = aa * bb - creal(ab * conj(ab));
    c[0] = (bb * ay - ab * by) / det;
    c[1] = (aa * by - conj(ab) * ay) / det;
}

/* Set u to the two modes of the smooth curve, by Prony's method. */
static void
begin_two(const point *p, const block *b, size_t n, double ln_a, double w, double u[UNKNOWNS])
{
    double complex z[TAKEN], c[2], mode[2];
    double step = (p[n - 1].t - p->t) / (TAKEN - 1);
    for (size_t k = 0, i = 0; k < TAKEN; k++) {
        double t = fmin(p->t + (double)k * step, p[n - 1].t);
        while (p[i + 1].t < t)
            i++;
        double part = (t - p[i].t) / (p[i + 1].t - p[i].t);
        double first = b[i].phase - w * (b[i].t - b->t), next = b[i + 1].phase - w * (b[i + 1].t - b->t);
        z[k] = cexp((1 - part) * (b[i].level + first * I) + part * (b[i + 1].level + next * I) - ln_a);
    }
    solve_two(c, z, TAKEN, NULL);
    mode[0] = c[1] / 2 + csqrt(c[1] * c[1] / 4 + c[0]);
    mode[1] = c[1] - mode[0];
    solve_two(c, z, TAKEN, mode);
    double complex first = clog(mode[0]) / step, second = clog(mode[1]) / step, ratio = clog(c[1] / c[0]);
    memcpy(u, (double[UNKNOWNS]){ log(cabs(c[0])), carg(c[0]), cimag(first), -creal(first), -creal(second),
                                  cimag(second), creal(ratio), cimag(ratio) }, UNKNOWNS * sizeof *u);
}

typedef struct fitted {
    double bic;                 /* by which fits are sorted */
    int kind, is_exact;         /* as of trials */
    double u[UNKNOWNS], covariance[UNKNOWNS * UNKNOWNS], squares, free, p;
} fitted;

/* Fit from f->u on. */
static ss_status
fit(fitted *f, const trial *of)
{
    const struct law *law = &laws[of->kind];
    static const double difference[UNKNOWNS] = { 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6 };
    ss_range range[UNKNOWNS];
    double unknowns = 0;
    least_end end;
    for (int k = 0; k < UNKNOWNS; k++) {
        int is_free = law->free[k] && (of->tracks == TRACKS || (k != TURN && k != W && k != BEND));
        int has_sign = k == LN_A || k == TURN || k == W || of->kind >= TWO_MODES;
        range[k] = !is_free ? (ss_range){ f->u[k], f->u[k] } : k == SHAPE ? law->shapes
            : has_sign ? (ss_range){ -1e9, 1e9 } : (ss_range){ 0, 1e3 };
        unknowns += is_free;
    }
    least of_fit = { .rows = 2 * (of->tracks * of->n + of->behind), .unknowns = UNKNOWNS, .model = leave,
                     .user = (void *)of, .range = range, .difference = difference, .costly = !of->is_exact,
                     .tol = 1e-7, .noise = 1 };
    ss_status st = ss_least_fit(&end, &of_fit, f->u, NULL, f->covariance);
    f->is_exact = of->is_exact;
    f->squares = end.squares;
    f->free = (double)of_fit.rows - unknowns;
    f->p = isfinite(end.squares) ? gsl_cdf_chisq_Q(end.squares, f->free) : 0;
    f->bic = (isfinite(end.squares) ? end.squares : INFINITY) + unknowns * log((double)of_fit.rows);
    double error = sqrt(f->covariance[BEND * (UNKNOWNS + 1)]);
    if (of->kind == SS_MICROSLIP && of->tracks == TRACKS && f->u[BEND] + 3 * error < SOFTER * f->u[C]) {
        f->p = 0;
        f->bic = INFINITY;
    }
    return st;
}

/* Fit from what the smooth curve tells. */
static ss_status
fit_first(fitted *f, trial *of, int kind)
{
    const struct law *law = &laws[kind];
    double least_left = INFINITY;
    f->kind = of->kind = kind;
    if (kind == TWO_MODES)
        begin_two(of->p, of->b, of->n, of->ln_a, of->w * of->unit, f->u);
    for (double shape = law->shapes.to; kind != TWO_MODES && shape >= law->shapes.from; shape -= fabs(shape) / 2) {
        double u[UNKNOWNS] = { [SHAPE] = shape }, left = begin(of, u);
        if (left < least_left) {
            least_left = left;
            memcpy(f->u, u, sizeof u);
        }
    }
    return fit(f, of);
}

/* Add a number that is a constant times unknown k. */
static void
add(ss_backbone *out, const fitted *f, const char *name, const char *unit, int k, double constant)
{
    ss_backbone_number *to = &out->number[out->n_numbers++];
    to->name = name;
    snprintf(to->unit, sizeof to->unit, "%s", unit);
    to->value = (ss_value){ constant * f->u[k], constant * sqrt(f->covariance[k * UNKNOWNS + k]) };
}

/* The numbers of a mechanism.  It was fitted with frequencies about w, in units of 1/s, and amplitudes in units of
 * a. */
static void
add_numbers(ss_backbone *out, const fitted *f, const decay_source *of, double about, double unit, double a)
{
    const struct law *law = &laws[f->kind];
    double w = (about + f->u[W]) * unit, contact = about * unit * unit;
    char per[64];
    snprintf(per, sizeof per, of->column[0] != '\0' ? "1/(%.50s)" : "%s", of->column);
    if (of->has_phase) {
        add(out, f, "frequency", "Hz", W, unit / (2 * M_PI));
        out->number[0].value.value = w / (2 * M_PI);
    }
    if (law->free[S]) {
        add(out, f, "damping_ratio", "", S, unit / w);
        ss_value *zeta = &out->number[out->n_numbers - 1].value;
        const double *cov = f->covariance, by_w = -zeta->value * unit / w, by_s = unit / w;
        zeta->error = sqrt(fmax(pow(zeta->error, 2) + by_w * by_w * cov[W * (UNKNOWNS + 1)]
                                + 2 * by_w * by_s * cov[S * UNKNOWNS + W], 0));
    }
    if (f->kind == SS_COULOMB_DAMPING || f->kind == SS_VISCOUS_AND_COULOMB) {
        double by_stiffness = M_PI / 2 * unit * a / w;
        add(out, f, "friction_over_stiffness", of->column, C, by_stiffness);
        if (of->mass > 0)
            add(out, f, "friction", "N", C, of->mass * of->size * pow(w, 2 - of->derivative) * by_stiffness);
    } else if (f->kind == SS_QUADRATIC)
        add(out, f, "drag_over_mass", per, C, 3 * M_PI / 4 * unit / w / a);
    else if (f->kind == SS_JENKINS) {
        double more = f->is_exact ? 0 : HARMONIC * f->u[C] * contact / w / w;
        add(out, f, "contact_stiffness_ratio", "", C, contact / w / w);
        add(out, f, "slip_amplitude", of->column, SHAPE, a);
        if (of->mass > 0) {
            const double *cov = f->covariance;
            double c = f->u[C], d = f->u[SHAPE];
            double slip = of->mass * of->size * contact * a * pow(w * w + c * contact, -of->derivative / 2.);
            add(out, f, "contact_stiffness", "N/m", C, of->mass * contact);
            add(out, f, "friction", "N", C, slip * d);
            double both = 2 * c * d * cov[C * UNKNOWNS + SHAPE] + c * c * cov[SHAPE * UNKNOWNS + SHAPE];
            both += d * d * cov[C * UNKNOWNS + C];
            out->number[out->n_numbers - 1].value.error = slip * sqrt(fmax(both, 0));
        }
        for (size_t i = out->n_numbers; i-- > 2;)
            out->number[i].value.error = hypot(out->number[i].value.error, more * out->number[i].value.value);
    } else if (f->kind == SS_MICROSLIP) {
        add(out, f, "exponent", "", SHAPE, 1);
        add(out, f, "microslip_damping", "", C, unit / w);
        if (of->has_phase)
            add(out, f, "softening", "Hz", BEND, unit / (2 * M_PI));
    }
}

/* Of a block, weighed over mechanisms: ln A, and mean and square of its rates and of what damping takes from
 * w^2. */
typedef struct mixed {
    double level, mean[3], square[3];
} mixed;

/* Add what is smooth through the blocks about the mechanism f, whose unknowns are constants beside: each track
 * twice, as what the other one finds of the constants is where it starts. */
static ss_status
smooth_about(mixed *sum, const trial *of, fitted *f, const block *b, double unit, double weight)
{
    size_t n = of->n, m = n + of->behind, states = 3, which[UNKNOWNS];
    double start[STATES][STATES] = { { 0 } }, x[STATES] = { 0 };
    told *at = calloc(m, sizeof *at), *by = calloc(m, sizeof *by);
    place *p = calloc(2 * m, sizeof *p), end[TRACKS], both;
    if (at == NULL || by == NULL || p == NULL || tell(at, of, f->u) != SS_OK) {
        free(at), free(by), free(p);
        return SS_ENOMEM;
    }
    for (size_t c = 0; c < of->tracks; c++)
        for (size_t i = 0; i < m; i++) {
            place *to = &p[c * m + i];
            double s = fmax(-at[i].rate[LEVEL], 1e-9), rate = c == LEVEL ? -s : 1;
            double t = i + 1 < m ? of->p[i + 1].t - of->p[i].t : 0;
            double lost = i + 1 < m ? fmax(at[i].y[LEVEL] - at[i + 1].y[LEVEL], 1e-9) : 0;
            double past = c == LEVEL ? -lost : t;
            double bent = s * s - given_back(of->source->derivative, s * s);
            *to = (place){ .see = { { 1 }, { 0, rate }, { 0, 0, bent } },
                           .turn = { { 1, past, past * lost / 2 }, { 0, 1, lost }, { 0, 0, 1 } } };
            ss_place_walk(to, lost);
            if (i >= n) {                       /* y counts times A; the rate does not */
                double left[TRACKS];
                leave_behind(left, &of->p[i], &at[i], (double[TRACKS]){ 0 });
                memcpy(to->see, (double[2][STATES]){ { exp(at[i].y[LEVEL]) } }, sizeof (double[2][STATES]));
                to->seen[0] = left[c];
                to->variance[0] = pow(of->p[i].whole[c], 2);
                to->variance[1] = 1;
                continue;
            }
            ss_place_see(to, &b[i], (int)c, of->p[i].y[c] - at[i].y[c], of->p[i].rate[c] - at[i].rate[c], unit);
            double less = fmax(ROUNDED / to->variance[0], 1);
            to->variance[0] *= less;
            to->variance[1] *= less;
            size_t from = i > 0 ? i - 1 : 0, next = i + 1 < n ? i + 1 : i;
            double half = M_PI / (of->w + f->u[W]) / (of->p[next].t - of->p[from].t);       /* of a period */
            double change = fabs(at[next].rate[c] - at[from].rate[c]) * half;
            at[i].slip[c] = f->kind == SS_JENKINS ? SLIPPING * change
                : c == LEVEL ? (s - f->u[S]) * pow(s / (of->w + f->u[W]), 2) : 0;      /* the next order */
            if (f->kind == SS_JENKINS) {
                to->variance[1] += pow(at[i].slip[c], 2);
                at[i].lag[1] = hypot(at[i].lag[1], (at[next].lag[0] - at[from].lag[0]) * half);
            }
        }
    ss_status st = SS_OK;
    for (size_t k = 0; st == SS_OK && k < UNKNOWNS; k++) {
        double u[UNKNOWNS], sigma = sqrt(f->covariance[k * UNKNOWNS + k]);
        if (!(sigma > 0) || !isfinite(sigma))
            continue;
        memcpy(u, f->u, sizeof u);
        u[k] += sigma / 10;
        st = tell(by, of, u);
        for (size_t c = 0; c < of->tracks; c++)
            for (size_t i = 0; i < m; i++) {
                place *to = &p[c * m + i];
                to->see[0][states] = to->see[0][0] * (by[i].y[c] - at[i].y[c]) * 10;
                to->see[1][states] = (by[i].rate[c] - at[i].rate[c]) * 10;
            }
        which[states - 3] = k;
        for (size_t j = 3; j <= states; j++) {          /* as little known as by one number of all 4 n */
            const double *cov = f->covariance, own = cov[which[j - 3] * (UNKNOWNS + 1)];
            start[j][states] = start[states][j]
                = (double)(4 * n) * cov[k * UNKNOWNS + which[j - 3]] / sigma / sqrt(own);
        }
        states++;
    }
    for (size_t c = 0; c < of->tracks; c++)
        ss_blocks_track(&p[c * m], m, states, x, start, &end[c], of->tracks == 1);
    for (size_t c = 0; of->tracks > 1 && c < of->tracks; c++) {
        place *other = &end[1 - c];
        for (size_t j = 0; j < 3; j++) {
            other->x[j] = 0;
            for (size_t k = 0; k < states; k++)
                other->p[j][k] = other->p[k][j] = 0;
        }
        ss_blocks_track(&p[c * m], m, states, other->x, other->p, &both, 1);
    }
    const place *known = of->tracks > 1 ? &both : end;
    double error[STATES];
    for (size_t j = 3; j < states; j++) {
        const size_t k = which[j - 3];
        double sigma = sqrt(f->covariance[k * UNKNOWNS + k]);
        f->u[k] += sigma * known->mean[j];
        error[j] = sigma * known->error[j] / sqrt(known->p[j][j]);
    }
    for (size_t j = 3; j < states; j++)
        for (size_t i = 3; i < states; i++)
            f->covariance[which[j - 3] * UNKNOWNS + which[i - 3]] = error[i] * error[j] * known->p[i][j];
    for (size_t i = 0; i < n; i++) {
        const place *level = &p[i], *phase = of->tracks > 1 ? &p[m + i] : level;
        double mean[3] = { at[i].rate[LEVEL] + level->mean[1], at[i].rate[PHASE] + phase->mean[1],
                           at[i].lag[0] + level->mean[2] };
        double variance[3] = { pow(level->error[1], 2) + pow(at[i].slip[LEVEL], 2),
                               pow(phase->error[1], 2) + pow(at[i].slip[PHASE], 2),
                               pow(level->error[2], 2) + pow(at[i].lag[1], 2) };
        sum[i].level += weight * (at[i].y[LEVEL] + level->mean[0]);
        for (int k = 0; k < 3; k++) {
            sum[i].mean[k] += weight * mean[k];
            sum[i].square[k] += weight * (variance[k] + mean[k] * mean[k]);
        }
    }
    free(at), free(by), free(p);
    return st;
}

ss_status
ss_mechanism_find(ss_backbone *out, block *b, size_t n, const decay_source *source)
{
    double unit = (b->level - b[n - 1].level) / (b[n - 1].t - b->t), w = b[n / 2].at.w;
    double ln_a = b->level;
    point *p = calloc(n + source->behind, sizeof *p);
    told *what = calloc(n + source->behind, sizeof *what);
    fitted f[SS_MECHANISMS];
    decay_source as[] = { *source, *source };       /* what the column may be, if its unit does not tell */
    trial of = { .p = p, .n = n, .behind = source->behind, .tracks = source->has_phase ? TRACKS : 1,
                 .w = w / unit, .told = what, .source = source, .b = b, .unit = unit, .ln_a = ln_a };
    ss_status st = p != NULL && what != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK)
        make_points(p, b, n, source->behind, unit, ln_a, w);
    for (int k = 0; st == SS_OK && k < SS_MECHANISMS; k++)
        st = fit_first(&f[k], &of, k);
    if (st != SS_OK) {
        free(p), free(what);
        return st;
    }
    qsort(f, SS_MECHANISMS, sizeof *f, ss_ascending);
    of.kind = f->kind;
    of.is_exact = of.kind == SS_JENKINS && source->has_phase;
    if (of.is_exact) {
        const fitted by_law = *f;
        st = fit(f, &of);
        *f = f->bic < by_law.bic || f->p >= REJECT ? *f : by_law;
        of.is_exact = f->is_exact;
        for (int order = 1; source->derivative < 0 && order < 3 && st != SS_ENOMEM; order++) {
            fitted g = by_law;
            trial with = of;
            as[order - 1].derivative = order;
            with.source = &as[order - 1];
            with.is_exact = 1;
            st = fit(&g, &with);
            if (g.bic + TOLD < f->bic) {
                *f = g;
                of = with;
            }
        }
    }
    fitted *best = f;
    while (best < f + SS_MECHANISMS - 1 && best->p < REJECT)
        best++;
    best = best->p < REJECT ? f : best;
    const char *other = source->beats != NULL ? source->beats : best->p < REJECT ? "no law fits" : NULL;
    for (int k = TWO_MODES; st != SS_ENOMEM && k < LAWS && other == NULL && source->has_phase; k++) {
        fitted rival;
        st = fit_first(&rival, &of, k);
        if (st == SS_OK && rival.bic + (rival.free > best->free ? 0 : TOLD) < best->bic)
            other = k == TWO_MODES ? "two modes that beat fit better"
                : "a frequency that changes with the square of the amplitude fits better";
    }
    if (st == SS_ENOMEM) {
        free(p), free(what);
        return st;
    }
    out->chi2_dof = best->squares / best->free;
    out->other = other;
    mixed *sum = calloc(n, sizeof *sum);
    double whole = 0, error[3];
    st = sum != NULL ? SS_OK : SS_ENOMEM;
    for (fitted *x = best; st == SS_OK && other == NULL && x < f + SS_MECHANISMS; x++) {
        int is_near = x->p >= REJECT && x->bic < best->bic + TOLD;
        double gain = best->squares - x->squares, more = best->free - x->free;
        /* a gain of little chance makes what contains the best a rival; a loss of faint chance, what is in it none */
        if (laws[x->kind].contains >> best->kind & 1)
            is_near &= gsl_cdf_chisq_Q(gain, more) < LITTLE;
        else if (laws[best->kind].contains >> x->kind & 1)
            is_near &= gsl_cdf_chisq_Q(-gain, -more) > FAINT;
        if (x == best || is_near) {
            of.kind = x->kind;
            double weight = exp((best->bic - x->bic) / 2);
            out->mechanism[out->n_mechanisms++] = (ss_mechanism)x->kind;
            whole += weight;
            st = smooth_about(sum, &of, x, b, unit, weight);
        }
    }
    for (size_t i = 0; st == SS_OK && whole > 0 && i < n; i++) {
        for (int k = 0; k < 3; k++) {
            sum[i].mean[k] /= whole;
            error[k] = sqrt(fmax(sum[i].square[k] / whole - sum[i].mean[k] * sum[i].mean[k], 0));
        }
        b[i].level = ln_a + sum[i].level / whole;
        b[i].at.s = -unit * sum[i].mean[LEVEL];
        b[i].lag = unit * unit * sum[i].mean[2];
        b[i].lag_error = unit * unit * error[2];
        b[i].error[LEVEL] = unit * error[LEVEL];
        if (source->has_phase) {
            b[i].at.w = w + unit * sum[i].mean[PHASE];
            b[i].error[PHASE] = unit * error[PHASE];
        }
    }
    of.kind = best->kind;
    if (st == SS_OK && out->n_mechanisms == 1 && best->is_exact && tell(what, &of, best->u) == SS_OK)
        for (size_t i = 0; i < n; i++)
            b[i].left = fmax(fabs(b[i].left - what[i].left) - LITTLE * what[i].left, 0);    /* it may be off */
    free(sum), free(p), free(what);
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < n; i++) {
        double s[2], at[2];
        law_at(&of, best->u, b[i].level - ln_a, s, at);
        double fall = s[0] / (1 + (.5 - fmax(of.source->derivative, 0)) * at[1] / at[0]);
        int is_named = out->n_mechanisms == 1;
        out->row[i].named[0] = is_named && source->has_phase ? at[0] * unit * source->rate / (2 * M_PI) : NAN;
        out->row[i].named[1] = is_named ? fall / hypot(fall, at[0]) : NAN;
    }
    if (out->n_mechanisms > 0)
        add_numbers(out, best, source, w / unit, unit * source->rate, exp(ln_a) * source->unit);
    return SS_OK;
}
