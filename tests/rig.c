/* rig.c -- see rig.h. */
#include "rig.h"
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TURN 6.283185307179586476925286766559L
enum { STEPS = 64 };                    /* of the search, a period */

/* Derivatives 0, 1 and 2 of x at t. */
static void
motion_at(const rig *r, const rig_piece *p, long double t, long double out[3])
{
    memset(out, 0, 3 * sizeof *out);
    out[0] = p->x;
    if (p->K < 0)
        return;
    out[0] = p->F / p->K;
    for (int h = 0; h < r->n_harmonics; h++) {
        long double w = TURN * r->f[h];
        long double complex q = r->k * r->A[h] * cexpl(I * (w * t + r->p[h])) / (p->K - r->m * w * w + I * p->D * w);
        out[0] += creall(q);
        out[1] += creall(I * w * q);
        out[2] -= w * w * creall(q);
    }
    long double s = p->D / (2 * r->m), w = sqrtl(p->K / r->m - s * s);
    long double complex root = -s + I * w, q = (p->P - I * p->Q) * cexpl(root * (t - p->t));
    out[0] += creall(q);
    out[1] += creall(root * q);
    out[2] += creall(root * root * q);
}

/* Let the piece go through x and v at its start. */
static void
start_at(const rig *r, rig_piece *p, long double x, long double v)
{
    long double steady[3], s = p->D / (2 * r->m), w = sqrtl(p->K / r->m - s * s);
    p->P = p->Q = p->x = 0;
    motion_at(r, p, p->t, steady);
    p->P = x - steady[0];
    p->Q = (v - steady[1] + s * p->P) / w;
}

static long double
pull_of_spring(const rig *r, long double t, long double x, long double *rate)
{
    long double z = 0, v = 0;
    for (int h = 0; h < r->n_harmonics; h++) {
        z += r->A[h] * cosl(TURN * r->f[h] * t + r->p[h]);
        v -= r->A[h] * TURN * r->f[h] * sinl(TURN * r->f[h] * t + r->p[h]);
    }
    if (rate != NULL)
        *rate = r->k * v;
    return r->k * (z - x);
}

/* What is positive while the piece lasts, and its rate: a slip's speed, or what is left to the limit of a
 * stick on the side `side`. */
static long double
left_at(const rig *r, const rig_piece *p, int side, long double t, long double *rate)
{
    long double x[3];
    motion_at(r, p, t, x);
    if (p->mode != 0) {
        *rate = p->mode * x[2];
        return p->mode * x[1];
    }
    if (p->K < 0) {
        long double f = pull_of_spring(r, t, p->x, rate);
        *rate *= -side;
        return r->f_s - side * f;
    }
    long double zero = -p->F / r->K_y;  /* y = x + zero */
    *rate = -side * r->K_y * x[1];
    long double f = r->K_y * (x[0] + zero);
    if (r->is_total) {
        *rate -= side * r->c * x[2];
        f += r->c * x[1];
    }
    return r->f_s - side * f;
}

static long double
bisect(const rig *r, const rig_piece *p, int side, long double from, long double to, int of_rate, int rising)
{
    for (int i = 0; i < 90; i++) {
        long double mid = (from + to) / 2, rate, g = left_at(r, p, side, mid, &rate);
        if (of_rate)
            g = rate;
        if ((g > 0) == rising)
            to = mid;
        else
            from = mid;
    }
    return to;
}

/* When the piece ends on this side between t and next, where the search has come; NaN: not there.  A piece
 * may begin at its limit: then only a point behind its start, where something is left, comes before an end. */
static long double
end_between(const rig *r, const rig_piece *p, int side, long double t, long double next)
{
    long double rate, rate_next, unused, g = left_at(r, p, side, t, &rate), g_next = left_at(r, p, side, next, &rate_next);
    int at_limit = t == p->t && g < 1e-9L * (p->mode != 0 ? fabsl(rate) * (next - t) : r->f_s);
    if (g_next > 0) {
        if (at_limit || rate >= 0 || rate_next <= 0)
            return NAN;
        long double low = bisect(r, p, side, t, next, 1, 1);
        return left_at(r, p, side, low, &unused) <= 0 ? bisect(r, p, side, t, low, 0, 0) : NAN;
    }
    for (int i = 1; at_limit && i < STEPS; i++) {
        long double inner = t + (next - t) * i / STEPS;
        if (left_at(r, p, side, inner, &unused) > 0)
            return bisect(r, p, side, inner, next, 0, 0);
    }
    return at_limit ? t : bisect(r, p, side, t, next, 0, 0);
}

/* When the piece ends; `end` if not before. */
static long double
end_of(const rig *r, const rig_piece *p, long double end, int *side)
{
    long double fastest = p->K < 0 ? 0 : sqrtl(p->K / r->m) / TURN;
    for (int h = 0; h < r->n_harmonics; h++)
        fastest = fmaxl(fastest, r->f[h]);
    long double step = 1 / (fastest * STEPS);
    for (long double t = p->t; t < end; t += step) {
        long double up = end_between(r, p, 1, t, t + step), down = p->mode != 0 ? NAN : end_between(r, p, -1, t, t + step);
        if (!isnan(up) || !isnan(down)) {
            *side = isnan(down) || up < down ? 1 : -1;
            return *side > 0 ? up : down;
        }
    }
    return end;
}

static void
add(rig_motion *m, rig_piece p)
{
    if (m->n == m->room) {
        m->room = m->room > 0 ? 2 * m->room : 256;
        rig_piece *more = realloc(m->piece, m->room * sizeof *more);
        if (more == NULL)
            abort();
        m->piece = more;
    }
    m->piece[m->n++] = p;
}

static rig_piece
slip(const rig *r, long double t, int sign, long double x, long double v)
{
    rig_piece p = { .t = t, .mode = sign, .K = r->k, .D = r->d, .F = -sign * r->f_k };
    start_at(r, &p, x, v);
    return p;
}

static rig_piece
microstick(const rig *r, long double t, long double y, long double x)
{
    rig_piece p = { .t = t, .K = r->k + r->K_y, .D = r->d + r->c, .F = -r->K_y * (y - x) };
    start_at(r, &p, x, 0);
    return p;
}

/* The piece that follows a stop at x, after a slip of this sign (0: at the start). */
static rig_piece
stopped(const rig *r, long double t, int sign, long double x)
{
    if (r->is_elastic)
        return microstick(r, t, sign * r->f_k / r->K_y, x);
    long double f = pull_of_spring(r, t, x, NULL);
    if (fabsl(f) <= r->f_s)
        return (rig_piece){ .t = t, .K = -1, .x = x };
    return slip(r, t, f > 0 ? 1 : -1, x, 0);
}

int
rig_run(rig_motion *out, const rig *of, long double end, size_t most)
{
    *out = (rig_motion){ .of = *of, .end = end };
    const rig *r = &out->of;
    add(out, stopped(r, 0, 0, 0));
    for (;;) {
        const rig_piece *p = &out->piece[out->n - 1];
        long double x[3];
        int side = 0, mode = p->mode;
        long double t = end_of(r, p, end, &side);
        if (t >= end)
            return 1;
        if (out->n >= most)
            return 0;
        motion_at(r, p, t, x);
        if (mode != 0)
            add(out, stopped(r, t, mode, x[0]));
        else if (p->K < 0)
            add(out, slip(r, t, side, x[0], 0));
        else
            add(out, slip(r, t, x[1] != 0 ? (x[1] > 0 ? 1 : -1) : side, x[0], x[1]));
    }
}

void
rig_at(const rig_motion *m, long double t, size_t *at, double out[4])
{
    long double x[3];
    size_t i = *at < m->n && m->piece[*at].t <= t ? *at : 0;
    while (i + 1 < m->n && m->piece[i + 1].t <= t)
        i++;
    *at = i;
    motion_at(&m->of, &m->piece[i], t, x);
    for (int j = 0; j < 3; j++)
        out[j] = (double)x[j];
    out[3] = (double)(pull_of_spring(&m->of, t, x[0], NULL) - m->of.d * x[1] - m->of.m * x[2]);
}

void
rig_free(rig_motion *m)
{
    free(m->piece);
    *m = (rig_motion){ 0 };
}
