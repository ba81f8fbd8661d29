/* oracle.c -- see oracle.h. */
#include "oracle.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.141592653589793238462643383279502884L

static long double
drive(const ss_scene *s, long double t)
{
    long double cycles = (long double)s->base_frequency * t;
    return (long double)s->stiffness * s->base_amplitude
        * cosl(2 * PI * (cycles - rintl(cycles)) + s->phase);
}

/* q, q', q'' of a piece at t, in closed form; under-damped and off resonance, as all tests are. */
static void
motion_at(const ss_scene *s, const oracle_piece *p, long double t, long double out[3])
{
    if (p->at_rest != 0) {
        out[0] = p->q0;
        out[1] = out[2] = 0;
        return;
    }
    long double m = s->mass, w = 2 * PI * s->base_frequency, u = t - p->t0;
    long double decay = p->c / (2 * m), wd = sqrtl(p->k / m - decay * decay);
    /* steady part: amplitude D / (k - m w^2 + i c w) */
    long double re = p->k - m * w * w, im = p->c * w, d2 = re * re + im * im;
    long double D = (long double)s->stiffness * s->base_amplitude;
    long double cycles0 = s->base_frequency * p->t0;
    long double th0 = 2 * PI * (cycles0 - rintl(cycles0)) + s->phase, th = th0 + w * u;
    long double pr = D * re / d2, pi = -D * im / d2;
    long double s0 = pr * cosl(th0) - pi * sinl(th0), ds0 = w * (-pr * sinl(th0) - pi * cosl(th0));
    long double st = pr * cosl(th) - pi * sinl(th), dst = w * (-pr * sinl(th) - pi * cosl(th));
    /* damped part */
    long double A = p->q0 - s0 + p->f0 / p->k, B = (p->v0 - ds0 + decay * A) / wd;
    long double e = expl(-decay * u), co = cosl(wd * u), si = sinl(wd * u);
    out[0] = st - p->f0 / p->k + e * (A * co + B * si);
    out[1] = dst + e * ((B * wd - decay * A) * co - (A * wd + decay * B) * si);
    out[2] = (drive(s, t) - p->f0 - p->k * out[0] - p->c * out[1]) / m;
}

void
oracle_at(const oracle *o, size_t i, long double t, long double out[3])
{
    motion_at(o->scene, &o->piece[i], t, out);
    out[0] += o->piece[i].x_ref;
}

/* Not negative while the piece lasts. */
static long double
guard(const ss_scene *s, const oracle_piece *p, long double t)
{
    long double q[3];
    motion_at(s, p, t, q);
    if (p->mode != 0)
        return p->mode * q[1];
    if (p->at_rest != 0)
        return s->friction - fabsl(drive(s, t) - s->stiffness * q[0]);
    long double force = s->contact_stiffness * q[0];
    if (s->release == SS_RELEASE_TOTAL)
        force += s->contact_damping * q[1];
    return s->friction - fabsl(force);
}

static long double
period_of(const ss_scene *s, const oracle_piece *p)
{
    return 2 * PI / fmaxl(sqrtl(p->k / s->mass), 2 * PI * s->base_frequency);
}

/* The end of a piece, or t_end: a golden-section look into every minimum of the scan, then
 * bisection to the last bit. */
static long double
end_of(const ss_scene *s, const oracle_piece *p, long double t_end)
{
    const long double golden = 0.381966011250105151795L;
    long double step = period_of(s, p) / 2000, g0 = 0, g1 = 0;
    for (size_t i = 1;; i++) {
        long double t = p->t0 + i * step, g = guard(s, p, t), lo = t - step, hi = t;
        if (i > 2 && g1 < g0 && g1 < g && g >= 0) {      /* a minimum between t - 2 step and t */
            long double a = t - 2 * step, b = t;
            while (b - a > 1e-15L * t && g >= 0) {
                long double c = a + golden * (b - a), d = b - golden * (b - a);
                long double gc = guard(s, p, c), gd = guard(s, p, d);
                if (gc < gd)
                    b = d;
                else
                    a = c;
                if (fminl(gc, gd) < 0) {
                    g = fminl(gc, gd);
                    hi = gc < gd ? c : d;
                    lo = t - 2 * step;
                }
            }
        }
        if (g < 0) {
            while (hi - lo > 2e-19L * fmaxl(t, 1)) {
                long double mid = lo + (hi - lo) / 2;
                if (mid == lo || mid == hi)
                    break;
                if (guard(s, p, mid) < 0)
                    hi = mid;
                else
                    lo = mid;
            }
            return hi;
        }
        if (t > t_end)
            return t_end;
        g0 = g1;
        g1 = g;
    }
}

static oracle_piece
slip_from(const ss_scene *s, long double t, long double x, long double v, int direction)
{
    return (oracle_piece){ .t0 = t, .mode = direction, .kind = SS_SLIP, .direction = direction,
                           .k = s->stiffness, .f0 = (long double)direction * s->friction, .q0 = x,
                           .v0 = v };
}

static oracle_piece
stop_from(const ss_scene *s, long double t, long double x, long double y, int direction)
{
    oracle_piece p = { .t0 = t, .kind = SS_STICK, .direction = direction, .k = s->stiffness };
    if (s->model == SS_COULOMB) {
        long double force = drive(s, t) - s->stiffness * x;
        if (fabsl(force) > s->friction) {
            p = slip_from(s, t, x, 0, force > 0 ? 1 : -1);
            p.kind = SS_REVERSE;
            return p;
        }
        p.q0 = x;
        p.at_rest = 1;
        return p;
    }
    p.k += s->contact_stiffness;
    p.c = s->contact_damping;
    p.x_ref = x - y;
    p.f0 = s->stiffness * p.x_ref;
    p.q0 = y;
    return p;
}

static oracle_piece
after(const ss_scene *s, const oracle_piece *p, long double t)
{
    long double q[3];
    motion_at(s, p, t, q);
    if (p->mode == 0) {
        long double way = p->at_rest != 0 ? drive(s, t) - s->stiffness * q[0] : q[1];
        return slip_from(s, t, p->x_ref + q[0], q[1], way > 0 ? 1 : -1);
    }
    long double limit = s->model == SS_COMPLIANT ? s->friction / s->contact_stiffness : 0;
    return stop_from(s, t, q[0], p->mode * limit, p->mode);
}

oracle *
oracle_new(const ss_scene *s, double t_end)
{
    oracle *o = calloc(1, sizeof *o);
    oracle_piece p = s->v0 != 0 ? slip_from(s, 0, s->x0, s->v0, s->v0 > 0 ? 1 : -1)
        : stop_from(s, 0, s->x0, 0, 0);
    o->scene = s;
    o->starts_with_event = p.mode != 0;
    if (p.kind == SS_REVERSE)
        p.kind = SS_SLIP;
    for (;;) {
        if (o->n == o->room) {
            o->room = o->room > 0 ? 2 * o->room : 256;
            o->piece = realloc(o->piece, o->room * sizeof *o->piece);
        }
        o->piece[o->n++] = p;
        long double t = end_of(s, &p, t_end);
        if (t >= t_end)
            return o;
        p = after(s, &p, t);
    }
}

void
oracle_free(oracle *o)
{
    free(o->piece);
    free(o);
}
