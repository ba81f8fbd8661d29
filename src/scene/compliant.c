/* compliant.c -- Coulomb friction through a massless contact of stiffness K_y and damping c.
 *
 * In slip the contact is deflected by Y_m = f_k / K_y.  When v reaches 0 at x = X_s, a microstick
 * begins with y = Y_m sgn(v before) + x - X_s and f = K_y y + c y'.  It lasts until f exceeds f_s.
 * The state in a microstick is y, not x: in a stiff contact Y_m is far smaller than x, and x - X_s
 * would lose most of its digits. */
#include "scene/models.h"

enum { STIFFNESS, DAMPING, RELEASE };           /* K_y, c, and the force that ends a microstick */
enum { SPRING, TOTAL };                         /* K_y |y|, as the paper writes; or |K_y y + c v| */

static const char *
release_word(size_t i)
{
    static const char *const word[] = { [SPRING] = "spring", [TOTAL] = "total", NULL };
    return word[i];
}

static const scene_key keys[] = {
    OWN_NUMBER("contact_stiffness", STIFFNESS, REQUIRED, POSITIVE, "N/m"),
    OWN_NUMBER("contact_damping", DAMPING, REQUIRED, NOT_NEGATIVE, "N s/m"),
    OWN_WORD("release", RELEASE, release_word),
    KEY_STATIC_FRICTION,
};

static const vanishing vanishing_terms[] = {
    { "contact_damping=0", OWN_AT(DAMPING) },
};

static double
critical(const ss_scene *s)
{
    return 2 * sqrt(s->stiffness + s->own[STIFFNESS]) * sqrt(s->mass);
}

static const ss_scene_range ranges[] = {
    { "K_y/k", "1", 1e-2, 1e8, 0, OWN_AT(STIFFNESS), ss_unit_stiffness },
    { "c/(2 sqrt((k + K_y) m))", "1", 1e-4, 100, 1, OWN_AT(DAMPING), critical },
};

static double
deflection_in_slip(const state *m)
{
    return m->scene->friction / m->scene->own[STIFFNESS];
}

static double
deflection_limit(const state *m)
{
    return static_friction(m->scene) / m->scene->own[STIFFNESS];
}

static void
microstick(state *m, double x, double y)
{
    const ss_scene *s = m->scene;
    m->mode = 0;
    m->k = s->stiffness + s->own[STIFFNESS];
    m->c = s->own[DAMPING] + s->damping;
    m->x_ref = x - y;
    m->f0 = s->stiffness * m->x_ref;
    m->slack = 0;
    m->q[0] = y;
    m->q[1] = 0;
}

/* Without friction the mass never sticks: it slips in the direction of the force, or of the force's
 * rate where that is 0. */
static int
start_free(state *m)
{
    double x = m->scene->x0, force = ss_stick_force(m, base_force(m, m->u), x);
    int way = force != 0 ? sign(force) : sign(base_force_rate(m, m->u));
    ss_linear_slip(m, x, 0, way != 0 ? way : 1);
    return 1;
}

/* A contact that goes no further than this beyond its limit only touches it.  The distance is ten times
 * the absolute tolerance of x, which is the error of an integrator in the course of a stick.  In units of
 * the limit it is at least 1e-10 and at most 1e-6, a hundredth of the excursion of the shortest
 * micro-slips (2e-4 for one of 0.1 ms in the light scene). */
#define GRAZE_TOL 10
#define GRAZE_LEAST 1e-10
#define GRAZE_MOST 1e-6

static int
start(state *m)
{
    const ss_scene *s = m->scene;
    double limit = deflection_limit(m), v = s->v0 - s->surface_velocity;
    m->graze = fmin(fmax(GRAZE_TOL * m->tol * m->x_scale, GRAZE_LEAST * limit), GRAZE_MOST * limit);
    if (v == 0 && limit == 0)
        return start_free(m);
    if (v == 0) {
        microstick(m, s->x0, 0);
        return 0;
    }
    ss_linear_slip(m, s->x0, v, sign(v));
    return 1;
}

/* The ratio of damper to spring in the force that ends a microstick [s]. */
static double
damper_ratio(const state *m)
{
    const ss_scene *s = m->scene;
    return s->own[RELEASE] == SPRING ? 0 : s->own[DAMPING] / s->own[STIFFNESS];
}

/* Microstick lasts while the spring's force, or that of spring and damper, is within f_s. */
static double
guard(const state *m, const double q[], const double dqdt[], double *slope)
{
    if (m->mode != 0)
        return ss_linear_slip_guard(m, q, dqdt, slope);
    double limit = deflection_limit(m), ratio = damper_ratio(m);
    double force = q[0] + ratio * q[1];         /* in units of K_y */
    *slope = -sign(force) * (dqdt[0] + ratio * dqdt[1]);
    return limit + m->slack - fabs(force);
}

/* The distance beyond its limit at which a contact will turn back if v' stays as it is. */
static double
excess(const state *m)
{
    double rate[MAX_DIM], v = m->q[1];
    ss_linear_rates(m, base_force(m, m->u), m->q, rate);
    if (!(rate[1] * sign(m->q[0]) < 0))
        return INFINITY;
    double rest = v / (2 * fabs(rate[1])) * v;      /* v^2 may underflow */
    return fabs(m->q[0]) - deflection_limit(m) + rest;
}

/* Returns 1 if a contact at its limit only touches it: if it goes at most m->slack + m->graze beyond.
 * An undamped contact returns exactly to its limit each period, and rounding would decide whether it is
 * released then.  The excess is subtracted as a distance; stopping the contact at the limit
 * would turn an error of d into one of sqrt(d). */
static int
only_touches(state *m)
{
    const ss_scene *s = m->scene;
    if (s->own[RELEASE] == TOTAL && s->own[DAMPING] > 0)
        return 0;
    double beyond = excess(m);
    if (!(beyond <= m->slack + m->graze))
        return 0;
    m->q[0] -= sign(m->q[0]) * beyond;
    m->slack = m->graze;                /* so that its peak needs no second test */
    m->touches++;
    return 1;
}

static int
next(state *m, ss_event *e)
{
    double x = m->x_ref + m->q[0], v = m->q[1];
    int before = m->mode;
    if (before == 0 && only_touches(m))
        return 0;
    if (before == 0) {
        ss_linear_slip(m, x, v, v != 0 ? sign(v) : sign(m->q[0]));
        e->kind = SS_SLIP;
    } else if (deflection_limit(m) == 0) {      /* no stick without friction: v passes through 0 */
        ss_linear_slip(m, x, 0, -m->mode);
        e->kind = SS_REVERSE;
    } else {
        e->kind = SS_STICK;
        microstick(m, x, before * deflection_in_slip(m));
    }
    e->direction = m->mode != 0 ? m->mode : before;
    return 1;
}

static double
deflection(const state *m, const double q[])
{
    return m->mode == 0 ? q[0] : m->mode * deflection_in_slip(m);
}

static void
sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s)
{
    (void)drive;
    s->x = m->x_ref + q[0];
    s->v = q[1];
    s->a = dqdt[1];
    s->mode = m->mode;
    s->y = deflection(m, q);
    s->f = m->mode == 0 ? m->scene->own[STIFFNESS] * q[0] + m->scene->own[DAMPING] * q[1]
        : m->f0;
}

static double
memory(const state *m, double *unit)
{
    *unit = deflection_limit(m);
    return deflection(m, m->q);
}

static int
in_microstick(const state *m, double v)
{
    (void)v;
    return m->mode == 0;
}

static void
free_differences(const state *m, int is_free[D_MOST])
{
    is_free[D_REF] = m->mode == 0;
    is_free[D_Q] = is_free[D_V] = 1;
}

/* The derivatives across the end of a microstick, where |y + ratio v| reaches its limit. */
static void
cross_release(const state *m, const double q[], const double before[], const double after[],
              double d[D_MOST][D_MOST])
{
    double ratio = damper_ratio(m), jump = before[1] - after[1];
    for (int i = 0; i < D_MOST; i++) {
        double later = -(d[D_Q][i] + ratio * d[D_V][i]) / (q[1] + ratio * before[1]);
        d[D_Q][i] += d[D_REF][i];
        d[D_V][i] += jump * later;
        d[D_REF][i] = 0;
    }
}

static void
cross(const state *m, int mode, const double q[], const double before[], const double after[],
      double d[D_MOST][D_MOST])
{
    if (mode == 0) {
        cross_release(m, q, before, after, d);
        return;
    }
    for (int i = 0; i < D_MOST; i++) {
        d[D_V][i] *= after[1] / before[1];
        if (m->mode == 0) {
            d[D_REF][i] = d[D_Q][i];
            d[D_Q][i] = 0;
        }
    }
}

static int
move(state *m, const double d[D_MOST])
{
    double rates[MAX_DIM], slope;
    m->x_ref += d[D_REF];
    m->q[0] += d[D_Q];
    m->q[1] += d[D_V];
    if (m->mode == 0)
        m->f0 = m->scene->stiffness * m->x_ref;
    ss_linear_rates(m, base_force(m, m->u), m->q, rates);
    return guard(m, m->q, rates, &slope) > 0;
}

static const struct variation variation = { free_differences, cross, move };

/* The two directions of the motion have a part each. */
static void
drive(const ss_scene *s, double *memory, const piece *p, double part[])
{
    const double limit = s->friction / s->own[STIFFNESS];
    *memory = fmax(-limit, fmin(*memory + p->dx, limit));
    part[0] = s->own[STIFFNESS] * fmax(*memory, 0);
    part[1] = s->own[STIFFNESS] * fmin(*memory, 0);
}

MODEL(compliant) = {
    .name = "compliant",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys,
    .ranges = ranges, .n_ranges = sizeof ranges / sizeof *ranges,
    .parameter = { { .offset = OWN_AT(STIFFNESS), .by_mass = 1 },
                   { .offset = OWN_AT(DAMPING), .by_mass = 1 } },
    .n_parameters = 2,
    .vanishing = vanishing_terms, .n_vanishing = sizeof vanishing_terms / sizeof *vanishing_terms,
    .limit = ss_to_coulomb,
    .dim = 2, .linear = 1, .has_contact = 1, .force_varies = IN_STICK,
    .start = start, .fastest = ss_linear_fastest, .rates = ss_linear_rates,
    .jacobian = ss_linear_jacobian, .derivatives = ss_linear_derivatives, .series = ss_linear_series,
    .guard = guard,
    .next = next, .sample = sample,
    .memory = memory, .in_transition = in_microstick, .variation = &variation,
    .drive = drive
};
