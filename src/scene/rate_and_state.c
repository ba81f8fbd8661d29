/* rate_and_state.c -- friction that depends on speed and on the age of the contacts (Dieterich, J. Geophys. Res.
 * 84, 2161, 1979; Ruina, J. Geophys. Res. 88, 10359, 1983), regularised at V = 0 (Rice and Ben-Zion 1996):
 * f = N a asinh(V/(2 V0) exp((mu0 + b s)/a)) with s = ln(V0 theta/Dc), and the law of aging,
 * theta' = 1 - V theta/Dc, or of slip, theta' = -(V theta/Dc) ln(V theta/Dc).
 *
 * The state is -d, w = f/(N a) and s, where d = U t - x is the stretch of the spring: between slips V falls by ten
 * orders of magnitude and more, and these numbers stay near each other.  V = E - G with
 * E, G = V0 exp(+-w - (mu0 + b s)/a).  V > 0 while d > 0, so nothing is an event; a run ends where d reaches 0,
 * since the law is not known for a contact that turns back. */
#include <string.h>
#include "scene/models.h"

enum { NORMAL, REFERENCE, DIRECT, EVOLUTION, DISTANCE, SPEED, LAW };   /* N, mu0, a, b, Dc, V0 */
enum { AGING, SLIP };

static const char *
law_word(size_t i)
{
    static const char *const word[] = { [AGING] = "aging", [SLIP] = "slip", NULL };
    return word[i];
}

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
    OWN_WORD("law", LAW, law_word),
};

static double
reference(const ss_scene *s)
{
    return s->own[REFERENCE];
}

static double
direct(const ss_scene *s)
{
    return s->own[DIRECT];
}

static double
load(const ss_scene *s)
{
    return s->stiffness * s->base_velocity / own_frequency(s) / s->own[REFERENCE];
}

static double
pull(const ss_scene *s)
{
    return s->base_velocity;
}

static double
distance(const ss_scene *s)
{
    return s->own[NORMAL] * s->own[DIRECT] / s->stiffness;
}

static const ss_scene_range ranges[] = {
    { "mu0", "1", 0.1, 1, 0, OWN_AT(REFERENCE), ss_unit_one },
    { "a/mu0", "1", 1e-3, 0.03, 0, OWN_AT(DIRECT), reference },
    { "b/a", "1", 0.1, 2, 1, OWN_AT(EVOLUTION), direct },
    { "mu0 N omega_n/(k U)", "1", 3, 1e4, 0, OWN_AT(NORMAL), load },
    { "k Dc/(a N)", "1", 0.03, 100, 0, OWN_AT(DISTANCE), distance },
    { "V0/U", "1", 1e-4, 1e4, 0, OWN_AT(SPEED), pull },
};

/* --- the law ------------------------------------------------------------------------------------ */

enum { LARGE = 20 };                /* beyond, exp(-2 w) is 0 beside 1 */

/* The numbers that the law uses at a state. */
typedef struct contact {
    double V, C;                    /* E - G and E + G */
    double ratio;                   /* b/a */
    double s_rate, by_V, by_s;      /* s', and its derivatives by V and s */
} contact;

static double
level_of(const ss_scene *s, double age)             /* (mu0 + b s)/a */
{
    return (s->own[REFERENCE] + s->own[EVOLUTION] * age) / s->own[DIRECT];
}

/* w at a speed V > 0. */
static double
friction_at(const ss_scene *s, double V, double age)
{
    double z = log(V / s->own[SPEED]) + level_of(s, age);
    return z > LARGE ? z : asinh(exp(z) / 2);
}

static contact
contact_at(const ss_scene *s, double w, double age)
{
    double E = s->own[SPEED] * exp(w - level_of(s, age)), G = w < LARGE ? E * exp(-2 * w) : 0;
    double Dc = s->own[DISTANCE];
    contact c = { .V = E - G, .C = E + G, .ratio = s->own[EVOLUTION] / s->own[DIRECT] };
    if (s->own[LAW] == SLIP) {
        double L = log(c.V / s->own[SPEED]) + age;
        c.s_rate = -c.V / Dc * L;
        c.by_V = -(L + 1) / Dc;
        c.by_s = -c.V / Dc;
    } else {
        double renewal = s->own[SPEED] * exp(-age) / Dc;
        c.s_rate = renewal - c.V / Dc;
        c.by_V = -1 / Dc;
        c.by_s = -renewal;
    }
    return c;
}

static double
acceleration(const ss_scene *s, const double q[], double V)
{
    return (-s->stiffness * q[0] - s->damping * V - s->own[NORMAL] * s->own[DIRECT] * q[1]) / s->mass;
}

/* The steady slide with the pull. */
static void
equilibrium(const ss_scene *s, double q[])
{
    double U = s->base_velocity;
    q[2] = log(s->own[SPEED] / U);
    q[1] = friction_at(s, U, q[2]);
    q[0] = -(s->own[NORMAL] * s->own[DIRECT] * q[1] + s->damping * U) / s->stiffness;
}

/* --- the motion --------------------------------------------------------------------------------- */

/* A cycle begins where V falls below U by a part of it, after it has been above U by as much.  It is not U itself,
 * at which a steady slide stays.  w - (b/a) s changes with V alone as long as G is small, and always with both. */
#define ASIDE 0.01
enum { SLOWER, FASTER };

static void
enter(state *m, int mode)
{
    double q[MAX_DIM], ratio = m->scene->own[EVOLUTION] / m->scene->own[DIRECT];
    equilibrium(m->scene, q);
    double way = mode == FASTER ? 1 : -1, level = q[1] - ratio * q[2] - way * ASIDE;
    m->mode = mode;
    m->n_bounds = 2;
    m->bound[0] = (bound){ .of = { -1 } };
    m->bound[1] = (bound){ .level = -way * level, .of = { 0, way, -way * ratio } };
}

static int
start(state *m)
{
    const ss_scene *s = m->scene;
    equilibrium(s, m->q);
    m->q[0] = s->x0 != 0 ? s->x0 : -s->own[NORMAL] * s->own[DIRECT] * m->q[1] / s->stiffness;
    m->q[1] = friction_at(s, s->v0 > 0 ? s->v0 : s->base_velocity, m->q[2]);
    enter(m, s->v0 < (1 - ASIDE) * s->base_velocity && s->v0 > 0 ? SLOWER : FASTER);
    return 0;
}

static int
next(state *m, ss_event *e)
{
    (void)e;
    if (m->ended == 0)
        m->over = "the spring is slack, and rate and state do not say how a contact turns back";
    enter(m, m->mode == FASTER ? SLOWER : FASTER);
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

/* bsimp takes as long for a cycle as 2,000 steps of Taylor, each of which is about 5 / the rate. */
static int
stiff(const ss_scene *s)
{
    double pause, rate = quickest_of(s, &pause);
    return rate * pause > 2e4;
}

static void
rates(const state *m, double drive, const double q[], double dqdt[])
{
    const ss_scene *s = m->scene;
    const contact c = contact_at(s, q[1], q[2]);
    (void)drive;
    dqdt[0] = c.V - s->base_velocity;
    dqdt[1] = (acceleration(s, q, c.V) + c.ratio * c.s_rate * c.V) / c.C;
    dqdt[2] = c.s_rate;
}

static void
jacobian(const state *m, double u, const double q[], double *dfdq, double dfdt[])
{
    const ss_scene *s = m->scene;
    const contact c = contact_at(s, q[1], q[2]);
    double rate = (acceleration(s, q, c.V) + c.ratio * c.s_rate * c.V) / c.C, drag = s->damping / s->mass;
    double grip = s->own[NORMAL] * s->own[DIRECT] / s->mass, V_by_s = -c.ratio * c.V, s_by_w = c.by_V * c.C;
    double s_by_s = c.by_V * V_by_s + c.by_s;
    const double row[9] = {
        0, c.C, V_by_s,
        -s->stiffness / s->mass / c.C,
        c.ratio * (s_by_w * c.V / c.C + c.s_rate) - drag - (grip + rate * c.V) / c.C,
        (c.ratio * (s_by_s * c.V + c.s_rate * V_by_s) - drag * V_by_s) / c.C + c.ratio * rate,
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
    double Dc = s->own[DISTANCE], level = level_of(s, m->q[2]), ratio = s->own[EVOLUTION] / s->own[DIRECT];
    double E[N], G[N], V[N], C[N], w[N], age[N], rise[N], fall[N], renewal[N], L[N], log_V[N];
    memcpy(c[0], m->q, sizeof m->q);
    E[0] = s->own[SPEED] * exp(m->q[1] - level);
    G[0] = s->own[SPEED] * exp(-m->q[1] - level);
    renewal[0] = s->own[SPEED] * exp(-m->q[2]);
    L[0] = log((E[0] - G[0]) / s->own[SPEED]) + m->q[2];
    V[0] = E[0] - G[0];
    for (int n = 0; n < order; n++) {
        C[n] = E[n] + G[n];
        age[n] = s->own[LAW] == SLIP ? -product_term(V, L, n) / Dc : (renewal[n] - V[n]) / Dc;
        double a = c[n][MAX_DIM] = acceleration(s, c[n], V[n]);
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
        c[n + 1][0] = step[n] * (V[n] - (n == 0 ? s->base_velocity : 0));
        c[n + 1][1] = step[n] * w[n];
        c[n + 1][2] = step[n] * age[n];
    }
}

static double
speed(const state *m)
{
    return contact_at(m->scene, m->q[1], m->q[2]).V;
}

static void
sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *sample)
{
    const ss_scene *s = m->scene;
    double V = contact_at(s, q[1], q[2]).V;
    (void)drive, (void)dqdt;
    *sample = (ss_sample){ .x = q[0], .v = V, .a = acceleration(s, q, V),
                           .f = s->own[NORMAL] * s->own[DIRECT] * q[1], .mode = sign(V) };
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
    double unit[MAX_DIM];
    scales(m, unit);
    m->q[0] += d[D_Q];
    m->q[1] += m->scene->own[EVOLUTION] / m->scene->own[DIRECT] * d[D_REF];
    m->q[2] += d[D_REF];
    return m->q[0] < 0 && fabs(d[D_REF]) <= 1 && fabs(d[D_Q]) <= unit[0];
}

static const struct variation variation = { .free = on_section, .move = move };

/* Friction that falls as far, from rest to the greatest speed. */
static void
limit(ss_scene *s)
{
    double q[MAX_DIM], N = s->own[NORMAL], U = s->base_velocity;
    slip by = slip_of(s);
    equilibrium(s, q);
    s->x0 = s->x0 != 0 ? s->x0 : -N * s->own[DIRECT] * q[1] / s->stiffness;
    s->v0 = s->v0 > 0 ? s->v0 : U;
    s->friction = N * (s->own[DIRECT] * q[1] - by.fall);
    s->static_friction = s->friction + N * by.drop / 2;
    ss_to_stribeck(s, U);
}

MODEL(rate_and_state) = {
    .name = "rate-and-state",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys, .rig_is_own = 1,
    .ranges = ranges, .n_ranges = sizeof ranges / sizeof *ranges,
    .limit = limit, .dim = 3, .kinks = 1, .from_pull = 1, .force_varies = IN_STICK | IN_SLIP,
    .start = start, .fastest = fastest, .scales = scales, .quickest = quickest, .stiff = stiff,
    .rates = rates, .jacobian = jacobian, .series = series, .next = next,
    
    .sample = sample, .speed = speed, .equilibrium = equilibrium, .memory = memory, .variation = &variation
};
