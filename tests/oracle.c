/* oracle.c -- see oracle.h. */
#include "oracle.h"
#include "scene/scene.h"
#include "scene_word.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.141592653589793238462643383279502884L

static long double
swing(const ss_scene *s, long double t)
{
    long double cycles = (long double)s->base_frequency * t;
    return (long double)s->stiffness * s->base_amplitude
        * cosl(2 * PI * (cycles - rintl(cycles)) + s->phase);
}

/* Spring and damper, on a mass that moves with the surface: what the friction has to hold. */
static long double
load(const ss_scene *s, long double t, long double x)
{
    return swing(s, t) + s->stiffness * (s->base_velocity * t - x)
        - (long double)s->damping * s->surface_velocity;
}

static long double
number(const ss_scene *s, const char *key)
{
    double x = ss_scene_get(s, key);
    return isnan(x) ? 0 : (long double)x;
}

/* What friction does against a slip in direction `way`, and against its beginning; a contact's stiffness there. */
static long double
kinetic(const ss_scene *s, int way)
{
    return way < 0 && s->friction_negative != 0 ? s->friction_negative : s->friction;
}

static long double
most_in_stick(const ss_scene *s, int way)
{
    long double most = way < 0 && s->static_friction_negative != 0 ? s->static_friction_negative : s->static_friction;
    return fmaxl(most, kinetic(s, way));
}

static long double
stiffness(const ss_scene *s, int way)
{
    long double other = number(s, "contact_stiffness_negative");
    return way < 0 && other != 0 ? other : number(s, "contact_stiffness");
}

static int
is_alike(const ss_scene *s)
{
    return number(s, "gap") == 0 && number(s, "contact_stiffness_negative") == 0;
}

static int
is_total(const ss_scene *s)
{
    const char *word = scene_word(s, "release");
    return word != NULL && strcmp(word, "total") == 0;
}

/* The answers of q'' + 2 a q' + k/m q = 0 to a displacement of 1 and to a velocity of 1, without the
 * former's part of the latter: exp(-a u) cos(w u) and exp(-a u) sin(w u) / w, or with cosh and sinh. */
static void
die_out(long double a, long double square, long double u, long double *C, long double *S)
{
    long double w = sqrtl(fabsl(square));
    if (square > 0) {
        *C = expl(-a * u) * cosl(w * u);
        *S = expl(-a * u) * sinl(w * u) / w;
    } else {
        long double slow = expl((w - a) * u), fast = expl(-(w + a) * u);
        *C = (slow + fast) / 2;
        *S = w > 0 ? (slow - fast) / (2 * w) : slow * u;
    }
}

/* q, q', q'' of a piece at t, in closed form; off resonance, as all tests are. */
static void
motion_at(const ss_scene *s, const oracle_piece *p, long double t, long double out[3])
{
    if (p->at_rest != 0) {
        out[0] = p->q0;
        out[1] = out[2] = 0;
        return;
    }
    long double m = s->mass, w = 2 * PI * s->base_frequency, u = t - p->t0;
    long double decay = p->c / (2 * m), square = p->k / m - decay * decay, C, S;
    /* steady part: amplitude D / (k - m w^2 + i c w), and a line */
    long double re = p->k - m * w * w, im = p->c * w, d2 = re * re + im * im;
    long double D = (long double)s->stiffness * s->base_amplitude;
    long double cycles0 = s->base_frequency * p->t0;
    long double th0 = 2 * PI * (cycles0 - rintl(cycles0)) + s->phase, th = th0 + w * u;
    long double pr = D * re / d2, pi = -D * im / d2;
    long double slope = p->ramp / p->k, level = -(p->f0 + p->c * slope) / p->k;
    long double s0 = pr * cosl(th0) - pi * sinl(th0) + level;
    long double ds0 = w * (-pr * sinl(th0) - pi * cosl(th0)) + slope;
    long double st = pr * cosl(th) - pi * sinl(th) + level + slope * u;
    long double dst = w * (-pr * sinl(th) - pi * cosl(th)) + slope;
    long double A = p->q0 - s0, B = p->v0 - ds0 + decay * A;
    die_out(decay, square, u, &C, &S);
    out[0] = st + A * C + B * S;
    out[1] = dst + A * (-decay * C - square * S) + B * (C - decay * S);
    out[2] = (swing(s, t) - p->f0 + p->ramp * u - p->k * out[0] - p->c * out[1]) / m;
}

void
oracle_at(const oracle *o, size_t i, long double t, long double out[3])
{
    const oracle_piece *p = &o->piece[i];
    motion_at(o->scene, p, t, out);
    out[0] += p->x_ref + p->belt * (t - p->t0);
    out[1] += p->belt;
}

/* What the spring, or spring and damper, lack of the release. */
static long double
left_to_release(const ss_scene *s, const oracle_piece *p, const long double q[])
{
    long double force = stiffness(s, p->side) * q[0] + (is_total(s) ? number(s, "contact_damping") * q[1] : 0);
    return fminl(most_in_stick(s, 1) - force, most_in_stick(s, -1) + force);
}

/* Not negative while the piece lasts. */
static long double
guard(const ss_scene *s, const oracle_piece *p, long double t)
{
    long double q[3];
    motion_at(s, p, t, q);
    if (p->mode != 0)
        return p->mode * (q[1] - s->surface_velocity);
    if (p->at_rest != 0) {
        long double force = load(s, t, q[0] + p->belt * (t - p->t0));
        return fminl(most_in_stick(s, 1) - force, most_in_stick(s, -1) + force);
    }
    if (p->side == 0)
        return stiffness(s, 1) * (number(s, "gap") - fabsl(q[0]));
    long double left = left_to_release(s, p, q);
    return p->side == ALIKE ? left : fminl(left, stiffness(s, p->side) * p->side * q[0]);
}

/* Of the fastest motion or decay. */
static long double
period_of(const ss_scene *s, const oracle_piece *p)
{
    long double a = p->c / (2 * s->mass), square = a * a - p->k / s->mass;
    long double root = square > 0 ? a + sqrtl(square) : sqrtl(p->k / s->mass);
    return 2 * PI / fmaxl(root, 2 * PI * s->base_frequency);
}

/* The end of a piece, or t_end: a golden-section look into every minimum of the scan, then
 * bisection to the last bit. */
static long double
end_of(const ss_scene *s, const oracle_piece *p, long double t_end)
{
    const long double golden = 0.381966011250105151795L;
    long double step = period_of(s, p) / 500, g0 = 0, g1 = 0;
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
    long double pull = (long double)s->stiffness * s->base_velocity;
    return (oracle_piece){ .t0 = t, .mode = direction, .is_event = 1, .kind = SS_SLIP, .direction = direction,
                           .k = s->stiffness, .c = s->damping, .ramp = pull,
                           .f0 = (long double)direction * kinetic(s, direction) - pull * t, .q0 = x,
                           .v0 = v };
}

/* A microstick with y beyond the edge of a side (of the gap: beyond its middle). */
static oracle_piece
on_side(const ss_scene *s, oracle_piece p, long double x, long double y, int side, long double v)
{
    long double t = p.t0;
    p.side = side;
    p.belt = s->surface_velocity;
    p.k = s->stiffness + (side != 0 ? stiffness(s, side) : 0);
    p.c = s->damping + (side != 0 ? number(s, "contact_damping") : 0);
    p.x_ref = x - y;
    p.v0 = v;
    p.ramp = (long double)s->stiffness * ((long double)s->base_velocity - s->surface_velocity);
    p.f0 = s->stiffness * (p.x_ref - s->base_velocity * t)
        + (long double)s->damping * s->surface_velocity;
    p.q0 = y;
    return p;
}

static oracle_piece
stop_from(const ss_scene *s, long double t, long double x, long double y, int direction)
{
    oracle_piece p = { .t0 = t, .is_event = 1, .kind = SS_STICK, .direction = direction, .k = s->stiffness,
                       .belt = s->surface_velocity };
    if (s->model == ss_model_named("coulomb")) {
        long double force = load(s, t, x);
        if (fabsl(force) > most_in_stick(s, force > 0 ? 1 : -1)) {
            p = slip_from(s, t, x, s->surface_velocity, force > 0 ? 1 : -1);
            p.kind = SS_REVERSE;
            return p;
        }
        p.q0 = x;
        p.at_rest = 1;
        return p;
    }
    return on_side(s, p, x, y, is_alike(s) ? ALIKE : direction, 0);
}

static oracle_piece
after(const ss_scene *s, const oracle_piece *p, long double t)
{
    long double q[3];
    motion_at(s, p, t, q);
    long double x = p->x_ref + p->belt * (t - p->t0) + q[0];
    long double gap = number(s, "gap");
    if (p->mode == 0 && p->at_rest == 0 && p->side != ALIKE
        && (p->side == 0 || p->side * q[0] * stiffness(s, p->side) < left_to_release(s, p, q))) {
        int to = p->side == 0 ? (q[0] > 0 ? 1 : -1) : gap > 0 ? 0 : -p->side;
        oracle_piece next = on_side(s, (oracle_piece){ .t0 = t }, x, to == 0 ? p->side * gap : 0, to, q[1]);
        const long double there[3] = { 0, q[1] };
        if (to == 0 || left_to_release(s, &next, there) >= 0)
            return next;
    }
    if (p->mode == 0) {
        long double way = p->at_rest != 0 ? load(s, t, x) : q[1];
        return slip_from(s, t, x, q[1] + p->belt, way > 0 ? 1 : -1);
    }
    int compliant = s->model == ss_model_named("compliant");
    long double limit = compliant ? kinetic(s, p->mode) / stiffness(s, p->mode) : 0;
    return stop_from(s, t, x, p->mode * limit, p->mode);
}

oracle *
oracle_new(const ss_scene *s, double t_end)
{
    oracle *o = calloc(1, sizeof *o);
    long double v = (long double)s->v0 - s->surface_velocity;
    int pushed = number(s, "gap") > 0 || s->model == ss_model_named("coulomb") ? 0
        : load(s, 0, s->x0) > 0 ? 1 : -1;           /* the side on which a contact without a gap begins */
    oracle_piece p = v != 0 ? slip_from(s, 0, s->x0, s->v0, v > 0 ? 1 : -1)
        : stop_from(s, 0, s->x0, 0, pushed);
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

/* --- the state variable -------------------------------------------------------------------- */

enum { PARTS = 3, LEVELS = 10 };

static void
rates(const ss_scene *s, long double t, const long double q[], long double dqdt[])
{
    dqdt[0] = q[1];
    long double spring = swing(s, t) + s->stiffness * (s->base_velocity * t - q[0]);
    long double speed = q[1] - s->surface_velocity;
    dqdt[1] = (spring - s->damping * q[1] - q[2]) / s->mass;
    long double goal = s->friction * tanhl(ss_scene_get(s, "alpha") * speed);
    dqdt[2] = -(long double)ss_scene_get(s, "gamma") * (q[2] - goal);
}

/* n steps by the midpoint rule, whose error is a series in (h / n)^2. */
static void
midpoint(const ss_scene *s, long double t, long double h, int n, const long double q[],
         long double end[])
{
    long double before[PARTS], now[PARTS], slope[PARTS], step = h / n;
    rates(s, t, q, slope);
    for (int i = 0; i < PARTS; i++) {
        before[i] = q[i];
        now[i] = q[i] + step * slope[i];
    }
    for (int k = 1; k < n; k++) {
        rates(s, t + k * step, now, slope);
        for (int i = 0; i < PARTS; i++) {
            long double next = before[i] + 2 * step * slope[i];
            before[i] = now[i];
            now[i] = next;
        }
    }
    rates(s, t + h, now, slope);
    for (int i = 0; i < PARTS; i++)
        end[i] = (before[i] + now[i] + step * slope[i]) / 2;
}

/* Extrapolate to n = infinity; the last two differ by error, in units of scale. */
static long double
extrapolate(const ss_scene *s, long double t, long double h, const long double scale[],
            const long double q[], long double end[])
{
    long double row[LEVELS][PARTS], error = 0;
    for (int k = 0; k < LEVELS; k++) {
        midpoint(s, t, h, 2 * (k + 1), q, row[k]);
        for (int j = k - 1; j >= 0; j--) {
            long double ratio = (long double)(k + 1) / (j + 1), factor = ratio * ratio - 1;
            for (int i = 0; i < PARTS; i++)
                row[j][i] = row[j + 1][i] + (row[j + 1][i] - row[j][i]) / factor;
        }
    }
    for (int i = 0; i < PARTS; i++) {
        end[i] = row[0][i];
        error = fmaxl(error, fabsl(row[0][i] - row[1][i]) / scale[i]);
    }
    return error;
}

void
oracle_smooth(const ss_scene *s, size_t n, double x[])
{
    long double omega = fmaxl(sqrtl((long double)s->stiffness / s->mass), 2 * PI * s->base_frequency);
    long double X = fmaxl(s->base_amplitude, s->friction / s->stiffness), q[PARTS] = { s->x0, s->v0, 0 };
    const long double scale[PARTS] = { X, X * omega, s->friction };
    long double t = 0, h = 1e-3L / omega, end[PARTS];
    for (size_t i = 0; i < n; i++) {
        long double until = (long double)i / s->rate;
        while (t < until) {
            long double step = fminl(h, until - t), error = extrapolate(s, t, step, scale, q, end);
            if (error > 1e-16L) {
                h = step / 2;
                continue;
            }
            t = step < h ? until : t + step;
            if (error < 1e-19L && step == h)
                h *= 1.3L;
            for (int k = 0; k < PARTS; k++)
                q[k] = end[k];
        }
        x[i] = (double)q[0];
    }
}
