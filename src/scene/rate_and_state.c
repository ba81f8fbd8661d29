/* rate_and_state.c -- friction that depends on speed and on the age of the contacts (Dieterich, J. Geophys. Res.
 * 84, 2161, 1979; Ruina, J. Geophys. Res. 88, 10359, 1983), regularised at V = 0 (Rice and Ben-Zion 1996):
 * f = N a asinh(V/(2 V0) exp((mu0 + b s)/a)) with s = ln(V0 theta/Dc), and the law of aging,
 * theta' = 1 - V theta/Dc, or of slip, theta' = -(V theta/Dc) ln(V theta/Dc).
 *
 * The state is -d, w = f/(N a) and s, where d = U t - x is the stretch of the spring: between slips V falls by ten
 * orders of magnitude and more, and these numbers stay near each other.  V = E - G with
 * E, G = V0 exp(+-w - (mu0 + b s)/a).  V > 0 while d > 0, so nothing is an event; a run ends where d reaches 0,
 * since the law is not known for a contact that turns back.
 *
 * Each is counted from the steady slide with the pull, at which x_ref is -d and f0 is f: a motion that begins
 * beside an unstable slide leaves it after a time that the last digits of this distance decide. */
#include <string.h>
#include "scene/models.h"

enum { NORMAL, REFERENCE, DIRECT, EVOLUTION, DISTANCE, SPEED, LAW };   /* N, mu0, a, b, Dc, V0 */
enum { AGING, SLIP };

static const scene_key keys[] = {
    KEY_NUMBER(x0, OPTIONAL, ANY_NUMBER, "m"),
    KEY_NUMBER(v0, OPTIONAL, NOT_NEGATIVE, "m/s"),
    KEY_NUMBER(damping, TERM, NOT_NEGATIVE, "N s/m"),
    KEY_NUMBER(base_velocity, REQUIRED, POSITIVE, "m/s"),
    OWN_NUMBER("normal_force", NORMAL, REQUIRED, POSITIVE, "N"),
    OWN_NUMBER("reference_friction", REFERENCE, REQUIRED, POSITIVE, "1"),
    OWN_NUMBER("direct_effect", DIRECT, REQUIRED, POSITIVE, "1"),
    OWN_NUMBER("evolution_effect", EVOLUTION, REQUIRED, NOT_NEGATIVE, "1"),
    OWN_NUMBER("critical_slip_distance", DISTANCE, REQUIRED, POSITIVE, "m"),
    OWN_NUMBER("reference_velocity", SPEED, REQUIRED, POSITIVE, "m/s"),
    OWN_WORD("law", LAW, OPTIONAL, "aging", "slip"),
};

/* --- the law ------------------------------------------------------------------------------------ */

enum { LARGE = 20 };                /* beyond, exp(-2 w) is 0 beside 1 */

/* The numbers that the law uses at a state. */
typedef struct contact {
    double E, G, V, over;           /* V = E - G, and V - U */
    double ratio;                   /* b/a */
    double renewal, L;              /* U exp(-s) of the law of aging, log of V theta/Dc */
    double s_rate, by_V, by_s;      /* s', and its derivatives by V and s */
} contact;

/* f/(N a) at a speed V > 0 and the age of the steady slide. */
static double
friction_at(const ss_scene *s, double V)
{
    double level = s->own[REFERENCE] + s->own[EVOLUTION] * log(s->own[SPEED] / s->base_velocity);
    double z = log(V / s->own[SPEED]) + level / s->own[DIRECT];
    return z > LARGE ? z : asinh(exp(z) / 2);
}

static double
steady_friction(const ss_scene *s)
{
    return s->own[NORMAL] * s->own[DIRECT] * friction_at(s, s->base_velocity);
}

/* U exp(z), and by how much it is over U: without cancellation, by one exponential. */
static double
grown(double U, double z, double *over)
{
    double all = fabs(z) < 1 ? 0 : U * exp(z);
    *over = fabs(z) < 1 ? U * expm1(z) : all - U;
    return fabs(z) < 1 ? U + *over : all;
}

static contact
contact_at(const state *m, const double q[])
{
    const ss_scene *s = m->scene;
    double U = s->base_velocity, Dc = s->own[DISTANCE], steady = m->f0 / (s->own[NORMAL] * s->own[DIRECT]);
    contact c = { .ratio = s->own[EVOLUTION] / s->own[DIRECT] };
    double rise = q[1] - c.ratio * q[2], log_V = rise, younger;
    c.E = grown(U, rise, &c.over);
    if (steady + fmin(q[1], 0) < LARGE) {
        double all = -expm1(-2 * steady), G = U / all * exp(-2 * steady);       /* of the steady slide */
        c.E /= all;
        c.G = G * exp(-q[1] - c.ratio * q[2]);
        c.over = c.over / all - G * expm1(-q[1] - c.ratio * q[2]);
        log_V = c.over > -U / 2 ? log1p(c.over / U) : log((c.E - c.G) / U);
    }
    c.V = c.E - c.G;
    c.L = log_V + q[2];
    if (s->own[LAW] == SLIP) {
        c.s_rate = -c.V / Dc * c.L;
        c.by_V = -(c.L + 1) / Dc;
        c.by_s = -c.V / Dc;
    } else {
        c.renewal = grown(U, -q[2], &younger);
        c.s_rate = (younger - c.over) / Dc;
        c.by_V = -1 / Dc;
        c.by_s = -c.renewal / Dc;
    }
    return c;
}

static double
acceleration(const ss_scene *s, const double q[], double over)
{
    return (-s->stiffness * q[0] - s->damping * over - s->own[NORMAL] * s->own[DIRECT] * q[1]) / s->mass;
}

static void
equilibrium(state *m)
{
    m->f0 = steady_friction(m->scene);
    m->x_ref = -(m->f0 + m->scene->damping * m->scene->base_velocity) / m->scene->stiffness;
    memset(m->q, 0, sizeof m->q);
}

/* --- the motion --------------------------------------------------------------------------------- */

static int
start(state *m)
{
    const ss_scene *s = m->scene;
    double U = s->base_velocity;
    equilibrium(m);
    m->q[0] = s->x0 != 0 ? s->x0 - m->x_ref : s->damping * U / s->stiffness;
    if (s->v0 > 0) {
        double rise = log(s->v0 / U), least = m->f0 / (s->own[NORMAL] * s->own[DIRECT]) + fmin(rise, 0);
        m->q[1] = least > LARGE ? rise : friction_at(s, s->v0) - friction_at(s, U);
    }
    m->mode = m->n_bounds = 1;
    m->bound[0] = (bound){ .level = -m->x_ref, .of = { -1 } };
    return 0;
}

static int
next(state *m, ss_event *e)
{
    (void)e;
    m->over = "the spring is slack, and rate and state do not say how a contact turns back";
    return 0;
}

/* Where nothing swings, the motion is as slow as the load: this is a tenth of the rate at which it changes w. */
static double
fastest(const state *m, const char **what)
{
    const ss_scene *s = m->scene;
    if (what != NULL)
        *what = "the load";
    return s->stiffness * s->base_velocity / (s->own[NORMAL] * s->own[DIRECT]) / 10;
}

static void
scales(const state *m, double scale[])
{
    const ss_scene *s = m->scene;
    scale[0] = s->own[NORMAL] * s->own[DIRECT] / s->stiffness;
    scale[1] = scale[2] = 1;
}

/* By how much friction drops in a slip, about: by twice the sum of what it steadily falls by from U to the
 * greatest speed, that of a free slip, and of what heals in a pause, b ln(b N/(k Dc)).  The shipped laboratory
 * scene drops by .147 so, and by .149 in truth; with the law of slip, which heals less, by .096. */
typedef struct slip {
    double speed, fall, heals, drop;
} slip;

static slip
slip_of(const ss_scene *s)
{
    enum { ROUNDS = 8 };
    double N = s->own[NORMAL], a = s->own[DIRECT], b = s->own[EVOLUTION], U = s->base_velocity;
    slip by = { .heals = b > a ? b * fmax(0, log(b * N / (s->stiffness * s->own[DISTANCE]))) : 0 };
    for (int i = 0; i < ROUNDS; i++) {
        by.drop = 2 * (by.fall + by.heals);
        by.speed = U + N * by.drop / (2 * sqrt(s->stiffness) * sqrt(s->mass));
        by.fall = fmax(0, b - a) * log(by.speed / U);
    }
    return by;
}

/* The rate a N/(m V) at which w follows the force at the least V between slips; *pause becomes their time. */
static double
quickest_of(const ss_scene *s, double *pause)
{
    double N = s->own[NORMAL], a = s->own[DIRECT], U = s->base_velocity;
    slip by = slip_of(s);
    *pause = N * (by.drop + a) / (s->stiffness * U);
    return a * N / (s->mass * U) * exp(fmin((2 * by.fall + by.heals) / a, 100));
}

static double
quickest(const ss_scene *s)
{
    double pause;
    return quickest_of(s, &pause);
}

/* An implicit method takes as long for a cycle as 2,000 steps of Taylor, each of which is about 5 / the rate. */
static int
stiff(const ss_scene *s)
{
    double pause, rate = quickest_of(s, &pause);
    return rate * pause > 2e4;
}

static double
rate_of_friction(const state *m, const double q[], const contact *c)     /* w' */
{
    return (acceleration(m->scene, q, c->over) + c->ratio * c->s_rate * c->V) / (c->E + c->G);
}

static void
rates(const state *m, double drive, const double q[], double dqdt[])
{
    const contact c = contact_at(m, q);
    (void)drive;
    dqdt[0] = c.over;
    dqdt[1] = rate_of_friction(m, q, &c);
    dqdt[2] = c.s_rate;
}

static void
jacobian(const state *m, double u, const double q[], double *dfdq, double dfdt[])
{
    const ss_scene *s = m->scene;
    const contact c = contact_at(m, q);
    double rate = rate_of_friction(m, q, &c), drag = s->damping / s->mass, C = c.E + c.G;
    double grip = s->own[NORMAL] * s->own[DIRECT] / s->mass, V_by_s = -c.ratio * c.V, s_by_w = c.by_V * C;
    double s_by_s = c.by_V * V_by_s + c.by_s;
    const double row[9] = {
        0, C, V_by_s,
        -s->stiffness / s->mass / C,
        c.ratio * (s_by_w * c.V / C + c.s_rate) - drag - (grip + rate * c.V) / C,
        (c.ratio * (s_by_s * c.V + c.s_rate * V_by_s) - drag * V_by_s) / C + c.ratio * rate,
        0, s_by_w, s_by_s
    };
    (void)u;
    memcpy(dfdq, row, sizeof row);
    memset(dfdt, 0, 3 * sizeof *dfdt);
}

/* The products of series that the equations name; log V follows from V'/V. */
static void
series(const state *m, const double step[], int order, double c[][SERIES_PARTS])
{
    enum { N = MOST_SERIES + 1 };
    const ss_scene *s = m->scene;
    const contact at = contact_at(m, m->q);
    double Dc = s->own[DISTANCE], ratio = at.ratio;
    double E[N] = { at.E }, G[N] = { at.G }, V[N] = { at.V }, renewal[N] = { at.renewal }, L[N] = { at.L };
    double C[N], w[N], age[N], rise[N], fall[N], log_V[N];
    memcpy(c[0], m->q, sizeof m->q);
    for (int n = 0; n < order; n++) {
        C[n] = E[n] + G[n];
        age[n] = n == 0 ? at.s_rate : s->own[LAW] == SLIP ? -product_term(V, L, n) / Dc : (renewal[n] - V[n]) / Dc;
        double over = n == 0 ? at.over : V[n], a = c[n][MAX_DIM] = acceleration(s, c[n], over);
        w[n] = a + ratio * product_term(age, V, n);
        if (n > 0)
            w[n] -= inner_products(w, C, n) + w[0] * C[n];
        w[n] /= C[0];
        rise[n] = w[n] - ratio * age[n];
        fall[n] = -w[n] - ratio * age[n];
        E[n + 1] = step[n] * product_term(E, rise, n);
        G[n + 1] = step[n] * product_term(G, fall, n);
        V[n + 1] = E[n + 1] - G[n + 1];
        renewal[n + 1] = -step[n] * product_term(renewal, age, n);
        log_V[n] = V[n + 1] / step[n];
        if (n > 0)
            log_V[n] -= inner_products(log_V, V, n) + log_V[0] * V[n];
        log_V[n] /= V[0];
        L[n + 1] = step[n] * (log_V[n] + age[n]);
        c[n + 1][0] = step[n] * over;
        c[n + 1][1] = step[n] * w[n];
        c[n + 1][2] = step[n] * age[n];
    }
}

static double
speed(const state *m)
{
    return contact_at(m, m->q).V;
}

static void
sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *sample)
{
    const ss_scene *s = m->scene;
    const contact c = contact_at(m, q);
    (void)drive, (void)dqdt;
    *sample = (ss_sample){ .x = m->x_ref + q[0], .v = c.V, .a = acceleration(s, q, c.over),
                           .f = m->f0 + s->own[NORMAL] * s->own[DIRECT] * q[1], .mode = sign(c.V) };
}

static double
memory(const state *m, double *unit)
{
    *unit = 1;
    return m->q[2];
}

static void
on_section(const state *m, int is_free[D_MOST])
{
    (void)m;
    is_free[D_REF] = is_free[D_Q] = 1;
    is_free[D_V] = 0;
}

/* Beyond a change of ln theta, or of the force's ln V, by 1 neighbours tell nothing. */
static int
move(state *m, const double d[D_MOST])
{
    const ss_scene *s = m->scene;
    m->q[0] += d[D_Q];
    m->q[1] += s->own[EVOLUTION] / s->own[DIRECT] * d[D_REF];
    m->q[2] += d[D_REF];
    return m->x_ref + m->q[0] < 0 && fabs(d[D_REF]) <= 1
        && fabs(d[D_Q]) <= s->own[NORMAL] * s->own[DIRECT] / s->stiffness;
}

/* The age at a steady speed V over a time h: theta + (Dc/V - theta) (1 - exp(-V h/Dc)), or ln(V theta/Dc) falls by
 * that exponential.  At a speed that is noise, the friction is that at the noise. */
static void
drive(const ss_scene *s, double *memory, const piece *p, double part[])
{
    const double N = s->own[NORMAL] * sign(p->v), V0 = s->own[SPEED], part_of_Dc = fabs(p->dx) / s->own[DISTANCE];
    if (s->own[LAW] == SLIP && p->dx != 0) {
        const double L = log(fabs(p->dx) / p->h / V0);
        *memory = (*memory + L) * exp(-part_of_Dc) - L;
    } else if (s->own[LAW] == AGING) {
        const double grown = part_of_Dc > 0 ? -expm1(-part_of_Dc) / part_of_Dc : 1;
        *memory = log(exp(*memory - part_of_Dc) + V0 * p->h / s->own[DISTANCE] * grown);
    }
    part[0] = N * s->own[REFERENCE];
    part[1] = N * s->own[DIRECT] * log(fmax(fabs(p->v), p->slow) / V0);
    part[2] = N * s->own[EVOLUTION] * *memory;
}

static const struct variation variation = { .free = on_section, .move = move };

/* Friction that falls as far, from rest to the greatest speed. */
static void
limit(ss_scene *s)
{
    double N = s->own[NORMAL], U = s->base_velocity, f = steady_friction(s);
    slip by = slip_of(s);
    s->x0 = s->x0 != 0 ? s->x0 : -f / s->stiffness;
    s->v0 = s->v0 > 0 ? s->v0 : U;
    s->friction = f - N * by.fall;
    s->static_friction = s->friction + N * by.drop / 2;
    ss_to_stribeck(s, U);
}

MODEL(rate_and_state) = {
    .name = "rate-and-state",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys, .rig_is_own = 1,
    .limit = limit, .dim = 3, .kinks = 1, .from_pull = 1, .force_varies = IN_STICK | IN_SLIP,
    .start = start, .fastest = fastest, .scales = scales, .quickest = quickest, .stiff = stiff,
    .rates = rates, .jacobian = jacobian, .series = series, .next = next,
    .sample = sample, .speed = speed, .equilibrium = equilibrium, .memory = memory, .variation = &variation,
    .drive = drive
};
