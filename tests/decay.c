/* decay.c -- see decay.h. */
#include "decay.h"

#include <math.h>
#include <stdlib.h>

typedef struct piece {                  /* x = c + exp(-s t) (p cos w t + q sin w t), t from its start */
    long double c, s, w, p, q;
} piece;

static long double
at(const piece *m, long double t, int derivative)
{
    long double p = m->p, q = m->q;
    for (int i = 0; i < derivative; i++) {
        long double dp = -m->s * p + m->w * q, dq = -m->s * q - m->w * p;
        p = dp;
        q = dq;
    }
    return (derivative == 0 ? m->c : 0) + expl(-m->s * t) * (p * cosl(m->w * t) + q * sinl(m->w * t));
}

/* The motion about c with this stiffness from x and v on. */
static piece
start(const decay *of, long double stiffness, long double c, long double x, long double v)
{
    piece m = { .c = c, .s = of->zeta * of->w, .p = x - c };
    m.w = sqrtl(of->w * of->w * stiffness - m.s * m.s);
    m.q = (v + m.s * m.p) / m.w;
    return m;
}

/* The first time > 0 at which v = 0. */
static long double
turn_of(const piece *m)
{
    long double a = -m->s * m->p + m->w * m->q, b = m->s * m->q + m->w * m->p;     /* v ~ a cos - b sin */
    long double t = atan2l(a, b) / m->w, half = acosl(-1) / m->w;
    while (t <= 1e-9L * half)
        t += half;
    while (t > (1 + 1e-9L) * half)
        t -= half;
    return t;
}

/* The time before end at which x, which is monotone, is at a place that it has at end or passes before. */
static long double
reach(const piece *m, long double place, long double end, int sign)
{
    long double lo = 0, hi = end, t = end / 2;
    for (int i = 0; i < 80 && hi - lo > 1e-18L * end; i++) {        /* Newton's steps, or halves */
        long double off = at(m, t, 0) - place, next = t - off / at(m, t, 1);
        if (sign * off >= 0)
            hi = t;
        else
            lo = t;
        if (fabsl(next - t) < 1e-18L * end)
            return next;
        t = next > lo && next < hi ? next : (lo + hi) / 2;
    }
    return hi;
}

typedef struct output {
    long double dt;
    size_t n, done;
    double *x[3];
} output;

static decay_turn *
add_turn(decay_turn *turn, size_t *n, long double t, long double x)
{
    if ((*n & (*n - 1)) == 0)
        turn = realloc(turn, (2 * *n + 1) * sizeof *turn);
    turn[(*n)++] = (decay_turn){ t, x };
    return turn;
}

/* Write the samples of a piece that lasts from t to end. */
static void
write_piece(output *out, const piece *m, long double t, long double end)
{
    for (; out->done < out->n && (long double)out->done * out->dt < end; out->done++)
        for (int i = 0; i < 3; i++)
            if (out->x[i] != NULL)
                out->x[i][out->done] = (double)at(m, (long double)out->done * out->dt - t, i);
}

static decay_turn *
run_pieces(const decay *of, output *out, size_t *turns)
{
    long double x = of->amplitude, v = 0, t = 0, z[DECAY_SLIDERS];
    int sign = -1, slips[DECAY_SLIDERS] = { 0 };
    decay_turn *turn = add_turn(NULL, turns, 0, x);
    for (size_t i = 0; i < of->sliders; i++)
        z[i] = fminl(x, of->d[i]);
    while (out->done < out->n) {
        long double stiffness = 1, force = of->drag * sign, end, reached;
        size_t next = of->sliders;
        for (size_t i = 0; i < of->sliders; i++) {
            stiffness += slips[i] ? 0 : of->kappa[i];
            force += of->kappa[i] * (slips[i] ? of->d[i] * sign : z[i] - x);
        }
        piece m = start(of, stiffness, -force / stiffness, x, v);
        if (v == 0 && of->drag > 0 && fabsl(x) <= of->drag) {       /* it stays where it is */
            m.p = m.q = 0;
            m.c = x;
            write_piece(out, &m, t, INFINITY);
            break;
        }
        end = turn_of(&m);
        reached = at(&m, end, 0);
        for (size_t i = 0; i < of->sliders; i++)
            if (!slips[i] && sign * (reached - (x + sign * of->d[i] - z[i])) > 0) {
                reached = x + sign * of->d[i] - z[i];
                next = i;
            }
        if (next < of->sliders)
            end = reach(&m, reached, end, sign);
        write_piece(out, &m, t, t + end);
        for (size_t i = 0; i < of->sliders; i++)
            z[i] = slips[i] || i == next ? sign * of->d[i] : z[i] + reached - x;
        x = reached;
        t += end;
        v = next < of->sliders ? at(&m, end, 1) : 0;
        if (next < of->sliders) {
            slips[next] = 1;
            continue;
        }
        sign = -sign;
        for (size_t i = 0; i < of->sliders; i++)
            slips[i] = 0;
        turn = add_turn(turn, turns, t, x);
    }
    return turn;
}

static long double
pull(const decay *of, long double x, long double v)
{
    return -of->w * of->w * x - 2 * of->zeta * of->w * v - of->quadratic * v * fabsl(v);
}

static void
step(const decay *of, long double h, long double *x, long double *v)
{
    long double k1 = pull(of, *x, *v), v2 = *v + h / 2 * k1, k2 = pull(of, *x + h / 2 * *v, v2);
    long double v3 = *v + h / 2 * k2, k3 = pull(of, *x + h / 2 * v2, v3), v4 = *v + h * k3;
    long double k4 = pull(of, *x + h * v3, v4);
    *x += h / 6 * (*v + 2 * v2 + 2 * v3 + v4);
    *v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
}

static decay_turn *
run_steps(const decay *of, output *out, size_t *turns)
{
    long double x = of->amplitude, v = 0, most = acosl(-1) / of->w / 1000;
    size_t steps = (size_t)ceill(out->dt / most);
    decay_turn *turn = add_turn(NULL, turns, 0, x);
    for (; out->done < out->n; out->done++) {
        double now[3] = { (double)x, (double)v, (double)pull(of, x, v) };
        for (int i = 0; i < 3; i++)
            if (out->x[i] != NULL)
                out->x[i][out->done] = now[i];
        for (size_t k = 0; k < steps; k++) {
            long double h = out->dt / (long double)steps, last = v, last_x = x;
            step(of, h, &x, &v);
            if (last != 0 && (last < 0) != (v < 0)) {
                long double a = pull(of, last_x, last), part = -last / a;
                for (int i = 0; i < 4; i++) {
                    long double to_x = last_x, to_v = last;
                    step(of, part, &to_x, &to_v);
                    part -= to_v / pull(of, to_x, to_v);
                }
                long double to_x = last_x, to_v = last;
                step(of, part, &to_x, &to_v);
                turn = add_turn(turn, turns, (long double)out->done * out->dt + (long double)k * h + part, to_x);
                x = to_x;
                v = 0;
                step(of, h - part, &x, &v);
            }
        }
    }
    return turn;
}

decay_turn *
decay_run(const decay *of, long double dt, size_t n, double *x, double *v, double *a, size_t *turns)
{
    output out = { dt, n, 0, { x, v, a } };
    *turns = 0;
    return of->quadratic > 0 ? run_steps(of, &out, turns) : run_pieces(of, &out, turns);
}

int
decay_truth(const decay_turn *turn, size_t turns, long double t, double *f, double *zeta, double *amplitude)
{
    size_t i = 4;
    long double y[5], u[5], slope_y = 0, value = 0, slope_n = 0;
    while (i + 4 < turns && turn[i + 1].t < t)
        i++;
    if (turns < 9 || i + 4 >= turns || t < turn[3].t)
        return 0;
    if (i + 5 < turns && t - turn[i].t > turn[i + 1].t - t)
        i++;
    for (size_t k = 0; k < 5; k++) {
        const decay_turn *p = &turn[i - 2 + k];
        long double near = fabsl(p[-1].x) + fabsl(p[1].x), far = fabsl(p[-2].x) + fabsl(p[2].x);
        u[k] = p->t - t;
        /* without an offset, which turns have in turn, and exact for a polynomial of third order */
        y[k] = logl((10 * fabsl(p->x) + 4 * near - far) / 16);
    }
    for (size_t k = 0; k < 5; k++) {            /* Lagrange's polynomial and its slope at t */
        long double l = 1, slope = 0;
        for (size_t j = 0; j < 5; j++) {
            if (j == k)
                continue;
            long double product = 1 / (u[k] - u[j]);
            for (size_t q = 0; q < 5; q++)
                if (q != k && q != j)
                    product *= -u[q] / (u[k] - u[q]);
            slope += product;
            l *= -u[j] / (u[k] - u[j]);
        }
        value += l * y[k];
        slope_y += slope * y[k];
        slope_n += slope * (long double)k;
    }
    long double w = acosl(-1) * slope_n, s = -slope_y;
    *f = (double)(sqrtl(w * w + s * s) / (2 * acosl(-1)));
    *zeta = (double)(s / sqrtl(w * w + s * s));
    *amplitude = (double)expl(value);
    return 1;
}
