/* foreign.h -- signals of what no scene is: other friction laws, other non-linear rigs, and none.
 *
 * Each fills n samples at rate [Hz] with an acceleration, drawn anew by the generator, of a rig like
 * those of the shipped scenes: all parameters within 30 %, friction over drive from .90 to .97, base
 * at about 2.5 Hz; recorded after two seconds.  Rigs are integrated by the classical Runge-Kutta
 * method with FINE steps a sample; a law with a true stick stands still while the force allows. */
#ifndef FOREIGN_H
#define FOREIGN_H

#include <math.h>
#include <string.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

enum { FOREIGN_FINE = 16, FOREIGN_ELEMENTS = 20, FOREIGN_STATES = 2 + FOREIGN_ELEMENTS };
#define FOREIGN_SETTLE 2.0      /* [s] */

typedef struct foreign_rig {
    double m, k, drive, omega, f_k;         /* of all; SI */
    double stiffness, damping;              /* of the contact, or of stops */
    double f_s, v_s, viscous, gap, shape, power;
    double limit[FOREIGN_ELEMENTS];         /* of sliders [N] */
    size_t states;
    int stuck;
    double (*force)(struct foreign_rig *r, const double *q, double *rate);
} foreign_rig;

static inline double
foreign_between(gsl_rng *rng, double lo, double hi)
{
    return lo + (hi - lo) * gsl_rng_uniform(rng);
}

/* A number of one size from lo to hi, as likely in each octave. */
static inline double
foreign_scale(gsl_rng *rng, double lo, double hi)
{
    return lo * pow(hi / lo, gsl_rng_uniform(rng));
}

static inline double
foreign_sign(double x)
{
    return (x > 0) - (x < 0);
}

/* --- forces, of q = x, v, inner states, whose rates they give -------------------------------- */

/* Canudas de Wit et al. (1995); with f_s = f_k and no damping it is Dahl (1968). */
static inline double
foreign_lugre(foreign_rig *r, const double *q, double *rate)
{
    double v = q[1], g = r->f_k + (r->f_s - r->f_k) * exp(-v * v / (r->v_s * r->v_s));
    rate[2] = v - r->stiffness * fabs(v) * q[2] / g;
    return r->stiffness * q[2] + r->damping * rate[2] + r->viscous * v;
}

/* Wen (1976): z from -1 to 1. */
static inline double
foreign_bouc_wen(foreign_rig *r, const double *q, double *rate)
{
    double v = q[1], z = q[2], yield = r->f_k / r->stiffness, size = pow(fabs(z), r->power);
    rate[2] = (v - size * (r->shape * fabs(v) * foreign_sign(z) + (1 - r->shape) * v)) / yield;
    return r->f_k * z;
}

/* Iwan (1966): springs behind sliders, in parallel. */
static inline double
foreign_iwan(foreign_rig *r, const double *q, double *rate)
{
    double sum = 0, stiffness = r->stiffness / FOREIGN_ELEMENTS;
    for (size_t i = 0; i < FOREIGN_ELEMENTS; i++) {
        double f = q[2 + i];
        int slides = fabs(f) >= r->limit[i] && f * q[1] > 0;
        rate[2 + i] = slides ? 0 : stiffness * q[1];
        sum += f;
    }
    return sum + r->viscous * q[1];
}

static inline double
foreign_stops(foreign_rig *r, const double *q, double *rate)
{
    double beyond = fabs(q[0]) - r->gap;
    (void)rate;
    return r->viscous * q[1]
           + (beyond > 0 ? foreign_sign(q[0]) * r->stiffness * beyond + r->damping * q[1] : 0);
}

static inline double
foreign_linear(foreign_rig *r, const double *q, double *rate)
{
    (void)rate;
    return r->viscous * q[1];
}

/* Slips; f_s, falling with the speed, is f_k for Coulomb's law.  Sticks are those of the loop. */
static inline double
foreign_falling(foreign_rig *r, const double *q, double *rate)
{
    double v = q[1];
    (void)rate;
    return foreign_sign(v) * (r->f_k + (r->f_s - r->f_k) / (1 + fabs(v) / r->v_s)) + r->viscous * v;
}

/* --- motion -------------------------------------------------------------------------------- */

static inline double
foreign_rates(foreign_rig *r, double t, const double *q, double *rate)
{
    rate[0] = q[1];
    rate[1] = 0;
    double f = r->force(r, q, rate);
    rate[1] = (r->drive * cos(r->omega * t) - r->k * q[0] - f) / r->m;
    return rate[1];
}

static inline void
foreign_step(foreign_rig *r, double t, double h, double *q)
{
    static const double at[] = { 0, 0.5, 0.5, 1 }, part[] = { 1 / 6., 1 / 3., 1 / 3., 1 / 6. };
    double sum[FOREIGN_STATES] = { 0 }, rate[FOREIGN_STATES] = { 0 }, p[FOREIGN_STATES] = { 0 };
    for (int k = 0; k < 4; k++) {
        for (size_t i = 0; i < r->states; i++)
            p[i] = q[i] + at[k] * h * rate[i];
        foreign_rates(r, t + at[k] * h, p, rate);
        for (size_t i = 0; i < r->states; i++)
            sum[i] += part[k] * rate[i];
    }
    for (size_t i = 0; i < r->states; i++)
        q[i] += h * sum[i];
    for (size_t i = 0; r->force == foreign_iwan && i < FOREIGN_ELEMENTS; i++)
        q[2 + i] = fmax(fmin(q[2 + i], r->limit[i]), -r->limit[i]);
}

/* The same for a law with a true stick: it holds while the force is within f_s, and begins where v
 * changes sign. */
static inline void
foreign_stick_step(foreign_rig *r, double t, double h, double *q)
{
    double pull = r->drive * cos(r->omega * t) - r->k * q[0], before = q[1];
    if (r->stuck && fabs(pull) <= r->f_s)
        return;
    if (r->stuck)
        q[1] = before = foreign_sign(pull) * 1e-12;
    r->stuck = 0;
    foreign_step(r, t, h, q);
    pull = r->drive * cos(r->omega * (t + h)) - r->k * q[0];
    if (before * q[1] < 0 && fabs(pull) <= r->f_s) {
        r->stuck = 1;
        q[1] = 0;
    }
}

static inline void
foreign_run(foreign_rig *r, double *a, size_t n, double rate)
{
    double q[FOREIGN_STATES] = { 0 }, rates[FOREIGN_STATES] = { 0 }, h = 1 / (rate * FOREIGN_FINE);
    size_t settle = (size_t)(FOREIGN_SETTLE * rate);
    int sticks = r->force == foreign_falling;
    r->stuck = sticks;
    for (size_t i = 0; i < settle + n; i++) {
        double t = (double)i / rate;
        if (i >= settle)
            a[i - settle] = sticks && r->stuck ? 0 : foreign_rates(r, t, q, rates);
        for (int k = 0; k < FOREIGN_FINE; k++)
            (sticks ? foreign_stick_step : foreign_step)(r, t + k * h, h, q);
    }
}

static inline foreign_rig
foreign_draw(gsl_rng *rng)
{
    foreign_rig r = { .m = 2.42 * foreign_between(rng, 0.7, 1.3),
                      .k = 2310 * foreign_between(rng, 0.7, 1.3),
                      .omega = 2 * M_PI * 2.5 * foreign_between(rng, 0.7, 1.3),
                      .stiffness = 209900 * foreign_between(rng, 0.7, 1.3),
                      .damping = foreign_scale(rng, 25, 80), .states = 3 };
    r.drive = r.k * 0.0006 * foreign_between(rng, 0.7, 1.3);
    r.f_k = r.drive * foreign_between(rng, 0.90, 0.97);
    r.f_s = r.f_k;
    r.v_s = 0.01;
    return r;
}

/* --- kinds --------------------------------------------------------------------------------- */

static inline void
foreign_from_rig(int kind, double *a, size_t n, double rate, gsl_rng *rng)
{
    foreign_rig r = foreign_draw(rng);
    double natural = sqrt(r.k * r.m);
    switch (kind) {
    case 0:                                 /* LuGre */
        r.force = foreign_lugre;
        r.f_k = r.f_s * foreign_between(rng, 0.6, 0.95);
        r.v_s = foreign_scale(rng, 5e-4, 5e-3);
        break;
    case 1:                                 /* Dahl */
        r.force = foreign_lugre;
        r.damping = 0;
        break;
    case 2:                                 /* Bouc-Wen */
        r.force = foreign_bouc_wen;
        r.shape = foreign_between(rng, 0.3, 0.9);
        r.power = foreign_between(rng, 1, 3);
        break;
    case 3:                                 /* Iwan */
        r.force = foreign_iwan;
        r.states = FOREIGN_STATES;
        r.viscous = 0.05 * natural;
        for (size_t i = 0; i < FOREIGN_ELEMENTS; i++)
            r.limit[i] = 2 * r.f_k / FOREIGN_ELEMENTS * ((double)i + 0.5) / FOREIGN_ELEMENTS;
        break;
    case 4:                                 /* backlash: a spring behind a gap */
        r.force = foreign_stops;
        r.states = 2;
        r.gap = 1e-4 * foreign_between(rng, 0.5, 2);
        r.stiffness = r.k * foreign_scale(rng, 2, 20);
        r.damping = 0;
        r.viscous = natural * foreign_scale(rng, 0.02, 0.2);
        break;
    case 5:                                 /* impacts: stiff stops */
        r.force = foreign_stops;
        r.states = 2;
        r.gap = 4e-4 * foreign_between(rng, 0.5, 1);
        r.viscous = 0.05 * natural;
        break;
    case 6:                                 /* Coulomb and viscous damping */
        r.force = foreign_falling;
        r.states = 2;
        r.viscous = natural * foreign_scale(rng, 0.05, 0.5);
        break;
    case 7:                                 /* Stribeck */
        r.force = foreign_falling;
        r.states = 2;
        r.f_k = r.f_s * foreign_between(rng, 0.6, 0.95);
        r.v_s = foreign_scale(rng, 5e-4, 5e-3);
        break;
    default:                                /* linear resonance */
        r.force = foreign_linear;
        r.states = 2;
        r.k *= foreign_scale(rng, 0.5, 100);
        r.viscous = sqrt(r.k * r.m) * foreign_scale(rng, 0.004, 0.4);
    }
    foreign_run(&r, a, n, rate);
}

static inline void
foreign_without_rig(int kind, double *a, size_t n, double rate, gsl_rng *rng)
{
    double f = 2.5 * foreign_between(rng, 0.7, 1.3), fast = foreign_scale(rng, 10, 200);
    double decay = 2 * M_PI * fast * foreign_scale(rng, 0.01, 0.2), depth = foreign_between(rng, 0.2, 1);
    double top = foreign_scale(rng, 10, 400);
    for (size_t i = 0; i < n; i++) {
        double t = (double)i / rate, since = fmod(t, 0.5 / f);
        int odd = (int)(t / (0.5 / f)) % 2;
        switch (kind) {
        case 9: a[i] = gsl_ran_gaussian(rng, 1); break;
        case 10: a[i] = sin(2 * M_PI * (f * t + (top - f) * t * t * rate / (double)n / 2)); break;
        case 11: a[i] = (1 + depth * cos(2 * M_PI * f * t)) * sin(2 * M_PI * fast * t); break;
        default: a[i] = (odd ? -1 : 1) * exp(-decay * since) * cos(2 * M_PI * fast * since);
        }
    }
}

static const char *const foreign_names[] = {
    "LuGre", "Dahl", "Bouc-Wen", "Iwan", "backlash", "impacts", "viscous damping", "Stribeck",
    "linear resonance", "noise", "chirp", "amplitude modulation", "trains of ringing" };
enum { FOREIGN_KINDS = sizeof foreign_names / sizeof *foreign_names };

static inline void
foreign_signal(int kind, double *a, size_t n, double rate, gsl_rng *rng)
{
    (kind < 9 ? foreign_from_rig : foreign_without_rig)(kind, a, n, rate, rng);
}

#endif
