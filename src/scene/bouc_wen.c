/* bouc_wen.c -- an elastic contact that slips gradually (Bouc 1967; Wen, J. Eng. Mech. Div. ASCE 102, 249, 1976):
 * f = f_k z and z' = (K/f_k) v (1 - |z|^n (1 - p + p sgn(v z))).  p = 1 and n = 1 is Dahl's law (1968); as n
 * grows, it becomes the compliant contact.
 *
 * The state is the deflection y = z f_k / K.  There is no event; the law has kinks at v = 0 and at y = 0, so a
 * mode is a sign of v and a side of y.  With a gap b, the sides are y > b, |y| <= b, where y follows the mass
 * without a force, and y < -b; then z = (y -+ b) K / f_k. */
#include <string.h>
#include "scene/models.h"

enum { STIFFNESS, EXPONENT, FRACTION, GAP };    /* K, n, p, b */

static const scene_key keys[] = {
    OWN_NUMBER("contact_stiffness", STIFFNESS, REQUIRED, POSITIVE, "N/m"),
    OWN_NUMBER("exponent", EXPONENT, REQUIRED, FROM_HALF, "1"),
    OWN_NUMBER("beta_fraction", FRACTION, REQUIRED, HALF_TO_ONE, "1"),
    OWN_NUMBER("gap", GAP, TERM, NOT_NEGATIVE, "m"),
};

static const vanishing vanishing_terms[] = {
    { "gap=0", OWN_AT(GAP) },
};

/* --- the law ------------------------------------------------------------------------------------ */

/* z where the contact is on a side. */
static double
z_of(const ss_scene *s, int side, double y)
{
    return side == 0 || s->friction == 0 ? 0 : (y - side * s->own[GAP]) / (s->friction / s->own[STIFFNESS]);
}

/* y' / v in motion in direction `way`; *slope becomes its derivative by z. */
static double
yield(const ss_scene *s, int side, int way, double z, double *slope)
{
    double n = s->own[EXPONENT], p = s->own[FRACTION], size = fmax(side * z, 0);
    double factor = 1 - p + p * way * side, part = side == 0 ? 0 : factor * pow(size, n);
    *slope = size > 0 ? -side * n * part / size : 0;
    return s->friction > 0 ? 1 - part : 0;
}

/* --- the motion --------------------------------------------------------------------------------- */

static double
fastest(const state *m, const char **what)
{
    return ss_kink_fastest(m, m->scene->own[STIFFNESS], 0, what);
}

static void
rates(const state *m, double drive, const double q[], double dqdt[])
{
    const ss_scene *s = m->scene;
    double z = z_of(s, m->side, q[2]), slope;
    dqdt[0] = q[1];
    dqdt[1] = (drive - s->stiffness * q[0] - s->damping * q[1] - s->friction * z) / s->mass;
    dqdt[2] = q[1] * yield(s, m->side, m->mode, z, &slope);
}

static void
jacobian(const state *m, double u, const double q[], double *dfdq, double dfdt[])
{
    const ss_scene *s = m->scene;
    double z = z_of(s, m->side, q[2]), z_by_y = m->side != 0 && s->friction > 0 ? s->own[STIFFNESS] / s->friction : 0;
    double slope, part = yield(s, m->side, m->mode, z, &slope);
    const double row[9] = {
        0, 1, 0,
        -s->stiffness / s->mass, -s->damping / s->mass, -s->friction * z_by_y / s->mass,
        0, part, q[1] * slope * z_by_y
    };
    ss_kink_jacobian(m, u, row, dfdq, dfdt);
}

/* |z|^n is a product of series if n is a whole number. */
enum { MOST_POWER = 20 };

static int
analytic(const ss_scene *s)
{
    return s->own[EXPONENT] <= MOST_POWER && s->own[EXPONENT] == floor(s->own[EXPONENT]);
}

static void
series(const state *m, const double step[], int order, double c[][SERIES_PARTS])
{
    enum { N = MOST_SERIES + 1 };
    const ss_scene *s = m->scene;
    const int side = m->side, power = (int)s->own[EXPONENT];
    double force[N], v[N], yields[N], pow_z[MOST_POWER + 1][N];
    double per_y = side != 0 && s->friction > 0 ? side * s->own[STIFFNESS] / s->friction : 0;
    double p = s->own[FRACTION], factor = per_y != 0 ? 1 - p + p * m->mode * side : 0;
    base_force_series(m, step, order, force);
    memcpy(c[0], m->q, sizeof m->q);
    for (int n = 0; n < order; n++) {
        v[n] = c[n][1];
        pow_z[1][n] = per_y * (c[n][2] - (n == 0 ? side * s->own[GAP] : 0));
        for (int i = 2; i <= power && factor != 0; i++)
            pow_z[i][n] = product_term(pow_z[i / 2], pow_z[i - i / 2], n);
        yields[n] = (n == 0 && s->friction > 0) - (factor != 0 ? factor * pow_z[power][n] : 0);
        double a = (force[n] - s->stiffness * c[n][0] - s->damping * v[n]
                    - s->friction * side * pow_z[1][n]) / s->mass;
        c[n][MAX_DIM] = a;
        c[n + 1][0] = step[n] * v[n];
        c[n + 1][1] = step[n] * a;
        c[n + 1][2] = step[n] * product_term(v, yields, n);
    }
}

static void
enter(state *m, int side)
{
    double b = m->scene->own[GAP];
    ss_kink_turn(m);
    m->side = side;
    m->n_bounds = 2;
    m->bound[1] = side != 0 ? (bound){ -b, { 0, 0, side }, 0 } : (bound){ b, { 0, 0, 1 }, 1 };
}

static int
start(state *m)
{
    ss_kink_start(m);
    enter(m, m->scene->own[GAP] > 0 ? 0 : m->mode);
    return 0;
}

static int
next(state *m, ss_event *e)
{
    double b = m->scene->own[GAP];
    (void)e;
    if (m->ended == 0) {
        m->q[1] = 0;
        enter(m, m->side);
    } else if (m->side == 0) {
        m->q[2] = m->mode * b;
        enter(m, m->mode);
    } else {
        m->q[2] = m->side * b;
        enter(m, b > 0 ? 0 : -m->side);
    }
    return 0;
}

static void
sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s)
{
    (void)drive;
    ss_kink_sample(q, dqdt, s);
    s->f = m->scene->friction * z_of(m->scene, m->side, q[2]);
}

static double
memory(const state *m, double *unit)
{
    *unit = m->scene->friction / m->scene->own[STIFFNESS] + m->scene->own[GAP];
    return m->q[2];
}

/* z after a motion, in units of f_k / K, on one side of y = 0: Dahl's exponential, or Chan's and Tsai's steps
 * (2010), and the exponential in which a long motion ends. */
static double
follow(const ss_scene *s, double z, double moved)
{
    enum { MOST = 12 };             /* steps: a longer motion has nearly forgotten z */
    const double n = s->own[EXPONENT], way = sign(moved), length = fmin(0.2, 2 / n);
    double slope;
    if (n == 1 && s->own[FRACTION] == 1)
        return way + (z - way) * exp(-fabs(moved));
    const int steps = (int)fmin(ceil(fabs(moved) / length), MOST);
    const double h = way * fmin(fabs(moved) / fmax(steps, 1), length);
    for (int i = 0; i < steps; i++) {       /* of order 4 by two derivatives; the second has a bound at 0 */
        const double rate = yield(s, sign(z), (int)way, z, &slope), bend = fmax(-2, fmin(h * slope, 2)) * rate;
        const double at = z + h / 2 * (rate + bend / 4), middle = yield(s, sign(at), (int)way, at, &slope);
        z += h * (rate + (bend + 2 * fmax(-2, fmin(h * slope, 2)) * middle) / 6);
        z = fmax(-1, fmin(z, 1));
    }
    return way + (z - way) * exp(-n * fabs(moved - steps * h));
}

static void
drive(const ss_scene *s, double *memory, const piece *p, double part[])
{
    const double unit = s->friction / s->own[STIFFNESS], b = s->own[GAP];
    const int way = sign(p->dx);
    double y = *memory, z = z_of(s, fabs(y) > b ? sign(y) : 0, y), rest = p->dx, slope;
    if (z * way < 0) {              /* it comes back, perhaps into the gap: how far is that, by Simpson's rule? */
        const double middle = yield(s, -way, way, z / 2, &slope), first = yield(s, -way, way, z, &slope);
        const double back = fabs(z) / 6 * unit * (1 / first + 4 / middle + 1);
        const int returns = back < fabs(rest);
        z = returns ? 0 : follow(s, z, rest / unit);
        y = returns ? -way * b : y;
        rest -= way * fmin(back, fabs(rest));
    }
    if (z == 0) {
        double through = fmin(fabs(rest), b - way * y);
        y += way * through;
        rest -= way * through;
    }
    if (rest != 0)
        z = follow(s, z, rest / unit);
    *memory = z != 0 ? sign(z) * b + z * unit : y;
    part[0] = s->friction * fmax(z, 0);
    part[1] = s->friction * fmin(z, 0);
}

static void
limit(ss_scene *s)
{
    ss_to_compliant(s, s->own[STIFFNESS], s->own[GAP]);
}

MODEL(bouc_wen) = {
    .name = "bouc-wen",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys,
    .parameter = { { .offset = OWN_AT(STIFFNESS), .by_mass = 1 } },
    .n_parameters = 1,
    .vanishing = vanishing_terms, .n_vanishing = sizeof vanishing_terms / sizeof *vanishing_terms,
    .limit = limit, .dim = 3, .kinks = 1, .force_varies = IN_STICK | IN_SLIP,
    .start = start, .fastest = fastest, .rates = rates, .jacobian = jacobian, .series = series,
    .analytic = analytic, .next = next,
    .sample = sample, .memory = memory, .variation = &ss_kink_variation,
    .drive = drive
};
