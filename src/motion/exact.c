/* exact.c -- a motion in closed form: Coulomb and compliant contact are linear within a mode.
 *
 * From the start of a mode, with m q'' + c q' + k q = D cos(theta + Omega u) - f0,
 *
 *     q(u) = P(u) + (q0 - P(0)) C(u) + (q0' - P'(0)) S(u) - (f0/m) G(u),
 *
 * where f0 is the sum of all constant forces and D cos(...) that of the oscillating ones.  P is
 * the steady motion, with the line by which q follows a pull; C and S are the responses to a unit
 * displacement and a unit velocity, and G is the integral of S.  C, S and G are written so that
 * nothing cancels or overflows at critical damping, far beyond it, or for w u -> 0.  P has a
 * singularity at resonance.  If the damping is small, the motion from rest replaces P within a
 * tenth of resonance; it is a divided difference of exponentials and has no singularity.  The only
 * error is rounding: a few ulp of each term.
 *
 * The next event is found from bounds of the guard's derivatives, and where they do not hold by steps, in whose
 * Taylor series no event can be missed. */
#include "motion/engine.h"

#include <complex.h>
#include <float.h>
#include <string.h>

/* |k - m Omega^2 + i c Omega| below this part of k is treated as resonance.  Above it, P loses at most one
 * digit to cancellation. */
#define RESONANCE 0.1

/* After so many cycles of the base the mode begins anew from its present state, so that Omega u keeps its
 * digits. */
enum { CYCLES = 4 };

/* A step in units of the longest that other methods may take; the terms of its series beyond the degree are
 * (pi/4)^18 / 18! = 2e-18 of the amplitude. */
enum { LONG = 5, DEGREE = 17 };

typedef struct exact {
    engine base;
    double k_m, c_m, f_m;           /* k, c, f0 (and d S) over m */
    double s, w;                    /* roots of m r^2 + c r + k: -s +- i w, or -s +- w */
    int overdamped;
    int resonant;
    double p_cos, p_sin;            /* P = p_cos cos(theta + Omega u) + p_sin sin(...) */
    double p_0, p_1;                /* + p_0 + p_1 u */
    double q, v;                    /* factors of C and S */
    double curvature, third;        /* the guard's second and third derivatives are at most this */
    double width;                   /* a bracket of the next event is not narrower [s] */
    int in_samples;                 /* 1: a sample has been computed since q and v were set */
    turn swing;                     /* exp((-s + i w) u) of the last sample */
    turn swing_further;             /* the same for one sample interval */
} exact;

/* exp((-s + i w) u) */
static turn
swing_at(const exact *x, double u)
{
    double decay = x->s == 0 ? 1 : exp(-x->s * u);
    turn t = turn_of(x->w * u);
    return (turn){ decay * t.co, decay * t.si };
}

/* C and S, from which C' = -(k/m) S and S' = C - 2 s S follow, and G.  They are computed from the swing
 * where the motion swings, and from u where it creeps. */
static inline void
free_motion(const exact *x, double u, turn swing, double *C, double *S, double *G)
{
    if (x->overdamped) {
        double slow = -x->k_m / (x->s + x->w), decay = exp(slow * u), part = -expm1(-2 * x->w * u);
        *S = decay * part / (2 * x->w);
        *C = decay * (1 - part / 2) + x->s * *S;
        *G = (1 - *C) / x->k_m;
        return;
    }
    *S = x->w > 0 ? swing.si / x->w : swing.co * u;
    *C = swing.co + x->s * *S;
    double fall = 1 - *C;
    if (x->s == 0 && swing.co > 0)          /* the same formula, without cancellation */
        fall = swing.si * swing.si / (1 + swing.co);
    *G = fall / x->k_m;
}

/* (exp(z) - 1) / z */
static double complex
expm1_over(double complex z)
{
    double x = creal(z), y = cimag(z), half = sin(y / 2);
    if (x == 0 && y == 0)
        return 1;
    return (expm1(x) * cos(y) - 2 * half * half + I * (exp(x) * sin(y))) / z;
}

/* q and q' at u of a motion that starts at rest at u = 0 and is driven by D cos(theta + Omega u). */
static void
driven_from_rest(const exact *x, double u, double *q, double *v)
{
    const state *m = &x->base.m->now;
    double complex io = I * m->omega, r[2] = { -x->s + I * x->w, -x->s - I * x->w }, part[2];
    double complex D = m->drive / m->scene->mass * cexp(I * m->theta);
    for (int i = 0; i < 2; i++)             /* integral of exp(r (u - t)) exp(i Omega t) */
        part[i] = u * cexp(r[i] * u) * expm1_over((io - r[i]) * u);
    *q = creal(D * (part[0] - part[1]) / (r[0] - r[1]));
    *v = creal(D * (r[0] * part[0] - r[1] * part[1]) / (r[0] - r[1]));
}

static void
evaluate(const exact *x, double u, turn base, turn swing, double q[], double dqdt[])
{
    const state *m = &x->base.m->now;
    double C, S, G, p, dp;
    free_motion(x, u, swing, &C, &S, &G);
    if (x->resonant) {
        driven_from_rest(x, u, &p, &dp);
    } else {
        p = x->p_cos * base.co + x->p_sin * base.si;
        dp = m->omega * (x->p_sin * base.co - x->p_cos * base.si);
    }
    q[0] = p + x->q * C + x->v * S - x->f_m * G + (x->p_0 + x->p_1 * u);
    q[1] = dp - x->q * x->k_m * S + x->v * (C - x->c_m * S) - x->f_m * S + x->p_1;
    m->model->rates(m, base_force_by(m, base, u), q, dqdt);
}

static void
evaluate_at(const exact *x, double u, double q[], double dqdt[])
{
    evaluate(x, u, base_turn(&x->base.m->now, u), swing_at(x, u), q, dqdt);
}

/* The n-th derivative of q is at most Omega^n |P| + omega0^n |K|, where the free motion is the real part
 * of K exp((-s + i w) u).  A guard is linear in q and v, with factors of one sign, up to signs that do not
 * raise a minimum. */
static void
bound_guard(exact *x, double omega0)
{
    const state *m = &x->base.m->now;
    double offset = x->q + (m->f0 + m->drag) / m->k, P = hypot(x->p_cos, x->p_sin);
    double K = hypot(offset, (x->v + x->s * offset) / x->w), omega = m->omega;
    double *const bounded[] = { &x->curvature, &x->third };
    P *= omega * omega;
    K *= omega0 * omega0;
    for (int i = 0; i < 2; i++, P *= omega, K *= omega0) {
        *bounded[i] = 0;
        for (int j = 0; j < m->n_bounds; j++)
            *bounded[i] = fmax(*bounded[i], fabs(m->bound[j].of[0] * (P + K)
                                                 + m->bound[j].of[1] * (omega * P + omega0 * K)));
    }
}

static void
exact_begin(engine *e)
{
    exact *x = (exact *)e;
    const state *m = &e->m->now;
    double mass = m->scene->mass, omega0 = sqrt(m->k / mass);
    double stiffness = m->k - mass * m->omega * m->omega, damping = m->c * m->omega;
    double impedance = hypot(stiffness, damping);

    ss_motion_rebase(e->m);
    x->k_m = m->k / mass;
    x->c_m = m->c / mass;
    x->f_m = (m->f0 + m->drag) / mass;
    x->s = m->c / (2 * mass);
    x->overdamped = x->s > omega0;
    x->w = sqrt(fabs(omega0 - x->s) * (omega0 + x->s));
    x->resonant = impedance < RESONANCE * m->k;
    x->p_1 = m->ramp / m->k;
    x->p_0 = -m->c / m->k * x->p_1;
    x->q = m->q[0] - x->p_0;
    x->v = m->q[1] - x->p_1;
    if (!x->resonant) {
        double in_phase = m->drive * (stiffness / impedance) / impedance;
        double late = m->drive * (damping / impedance) / impedance;
        turn base = turn_of(m->theta);
        x->p_cos = in_phase;
        x->p_sin = late;
        x->q -= in_phase * base.co + late * base.si;
        x->v -= m->omega * (late * base.co - in_phase * base.si);
    }
    x->curvature = x->third = INFINITY;
    if (!x->resonant && !x->overdamped)
        bound_guard(x, omega0);
    x->width = 0x1p-52 / fmax(omega0, m->omega);
    x->swing_further = swing_at(x, 1 / m->scene->rate);
    x->in_samples = 0;
    e->rhs++;
    double q[MAX_DIM];
    evaluate_at(x, 0, q, e->dq0);
}

static ss_status
exact_step(engine *e, double h_max, ss_error *err)
{
    (void)err;
    e->steps++;
    e->rhs++;
    e->h = LONG * h_max;
    evaluate_at((exact *)e, e->m->now.u + e->h, e->q1, e->dq1);
    return SS_OK;
}

/* A lower bound of the time to the next zero of a guard g with these rates of change.  A Taylor
 * polynomial of order 1 or 2, less the most that the next derivative can subtract, lies below the guard.
 * The one of order 2 leaves out g itself: it serves where a mode has just begun. */
static double
safe_distance(const exact *x, double g, double slope, double bend)
{
    double B = x->curvature, C = x->third / 3, root = sqrt(slope * slope + 2 * B * g);
    if (slope < 0)
        return 2 * g / (root - slope);
    return fmax((slope + root) / B, (bend / 2 + sqrt(bend * bend / 4 + 2 * C * slope)) / C);
}

/* The same to the zeros of all guards; the bound of the nearest becomes that which ends the mode. */
static double
safe_step(exact *x, double s, double jerk)
{
    engine *e = &x->base;
    const state *m = &e->m->now;
    const double bends[MAX_DIM] = { e->dq1[1], jerk };
    double step = INFINITY;
    for (int i = 0; i < m->n_bounds; i++) {
        const bound *b = &m->bound[i];
        double slope, bend, g = bound_value(b, e->q1, e->dq1, &slope), nearest = step;
        bound_value(b, e->q1, bends, &bend);
        if (s == 0 && g == 0)
            slope = fmax(slope, 0);         /* the mode has just begun: rounding made it negative */
        step = fmin(step, safe_distance(x, fmax(g, 0), slope, bend));
        if (b->either_side)
            step = fmin(step, safe_distance(x, 2 * b->level - g, -slope, -bend));
        if (step < nearest)
            e->ended = i;
    }
    return step;
}

/* Find the next event by going safe distances until they vanish.  Near a crossing they shrink
 * quadratically, as Newton's steps do: a mode takes about ten evaluations, where steps and a search in
 * the last of them take fifty. */
static int
exact_ahead(engine *e, double s_max, double *s_event)
{
    enum { PASSES = 60 };
    exact *x = (exact *)e;
    const state *m = &e->m->now;
    double s = 0;
    if (!isfinite(x->third))
        return -1;
    memcpy(e->q1, m->q, sizeof e->q1);
    memcpy(e->dq1, e->dq0, sizeof e->dq1);
    turn base = base_turn(m, m->u);
    e->steps++;
    for (int i = 0; i < PASSES; i++) {
        double jerk = (-m->drive * m->omega * base.si + m->ramp - m->k * e->q1[1] - m->c * e->dq1[1])
            / m->scene->mass;
        double step = safe_step(x, s, jerk);
        double width = fmax(x->width, 2 * DBL_EPSILON * (m->u + s));
        if (step <= width && s > 0) {
            *s_event = e->h = s + step + width;
            return 1;
        }
        if (!(step > width))
            return -1;
        s = fmin(s + step, s_max);
        base = base_turn(m, m->u + s);
        e->rhs++;
        evaluate(x, m->u + s, base, swing_at(x, m->u + s), e->q1, e->dq1);
        if (s == s_max) {
            e->h = s_max;
            return 0;
        }
    }
    return -1;
}

/* The derivatives are the displacements after a unit displacement (C), after a unit velocity (S) and under
 * a unit of force over mass (G), and their rates of change -(k/m) S, C - (c/m) S and S. */
static void
exact_response(engine *e, double s, double d[D_MOST][D_MOST])
{
    const exact *x = (const exact *)e;
    const state *m = &e->m->now;
    double C, S, G, mass = m->scene->mass, pull = m->scene->stiffness / mass;
    free_motion(x, s, swing_at(x, s), &C, &S, &G);
    memset(d, 0, D_MOST * sizeof *d);
    d[D_REF][D_REF] = 1;
    d[D_Q][D_REF] = -pull * G;
    d[D_Q][D_Q] = C;
    d[D_Q][D_V] = S;
    d[D_V][D_REF] = -pull * S;
    d[D_V][D_Q] = -m->k / mass * S;
    d[D_V][D_V] = C - m->c / mass * S;
}

static void
exact_at(engine *e, reading where, double s, turn base, double q[], double dqdt[])
{
    exact *x = (exact *)e;
    double u = e->m->now.u + s;
    turn swing = where == NEXT_SAMPLE && x->in_samples ? turn_further(x->swing, x->swing_further)
        : swing_at(x, u);
    if (where != ANYWHERE) {
        x->swing = swing;
        x->in_samples = 1;
    }
    e->rhs++;
    evaluate(x, u, base, swing, q, dqdt);
}

/* Begin anew after CYCLES cycles, of the base or, under a pull, of the faster of base and spring. */
static void
exact_go_on(engine *e)
{
    const state *m = &e->m->now;
    double omega = m->ramp == 0 ? m->omega : fmax(m->omega, own_frequency(m->scene));
    if (m->u * omega > CYCLES * 2 * M_PI)
        exact_begin(e);
}

const struct engine_type ss_exact_engine = {
    .size = sizeof(exact), .begin = exact_begin, .step = exact_step, .degree = DEGREE, .ahead = exact_ahead, .at = exact_at,
    .response = exact_response, .go_on = exact_go_on
};
