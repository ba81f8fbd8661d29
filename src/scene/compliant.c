/* compliant.c -- Coulomb friction through a massless contact of stiffness K_y and damping c.
 *
 * In slip the contact is deflected by Y_m = f_k / K_y.  When v reaches 0 at x = X_s, a microstick
 * begins with y = Y_m sgn(v before) + x - X_s and f = K_y y + c y'.  It lasts until f exceeds f_s.
 *
 * The contact is piecewise linear.  It may have a play, or gap, of b on either side of y = 0, in which it
 * carries no force, and on the side y < 0 another stiffness, and friction of another size.  So it has three
 * sides at most: y > b, the gap, and y < -b.  On each the spring is deflected by q = y -+ b, and
 * to go from one to the next is no event.  A contact that is alike everywhere has one, side 0.
 *
 * The state in a microstick is q, not x: in a stiff contact Y_m is far smaller than x, and x - X_s
 * would lose most of its digits. */
#include <string.h>
#include "scene/models.h"

enum { STIFFNESS, DAMPING, RELEASE, GAP, NEGATIVE };    /* K_y, c, the force that ends a microstick, b, K_y of y < 0 */
enum { SPRING, TOTAL };                         /* K_y |y|, as the paper writes; or |K_y y + c v| */

static const scene_key keys[] = {
    OWN_NUMBER("contact_stiffness", STIFFNESS, REQUIRED, POSITIVE, "N/m"),
    OWN_NUMBER("contact_damping", DAMPING, REQUIRED, NOT_NEGATIVE, "N s/m"),
    OWN_WORD("release", RELEASE, OPTIONAL, "spring", "total"),
    KEY_STATIC_FRICTION, KEYS_FRICTION_NEGATIVE,
    OWN_NUMBER("contact_stiffness_negative", NEGATIVE, TERM, POSITIVE, "N/m"),
    OWN_NUMBER("gap", GAP, TERM, NOT_NEGATIVE, "m"),
};

static const vanishing vanishing_terms[] = {
    { "contact_stiffness_negative=0", OWN_AT(NEGATIVE) },
    { "gap=0", OWN_AT(GAP) },
    { "contact_damping=0", OWN_AT(DAMPING) },
};

/* K_y of motion in direction `way`. */
static double
stiffness_of(const ss_scene *s, int way)
{
    return way < 0 && s->own[NEGATIVE] > 0 ? s->own[NEGATIVE] : s->own[STIFFNESS];
}

static int
is_alike(const ss_scene *s)
{
    return s->own[GAP] == 0 && (s->own[NEGATIVE] == 0 || s->own[NEGATIVE] == s->own[STIFFNESS]);
}

static int
is_gap(const ss_scene *s, int side)
{
    return side == 0 && s->own[GAP] > 0;
}

/* The deflection of the spring in slip in direction `way`, and that at which a microstick ends. */
static double
deflection_in_slip(const ss_scene *s, int way)
{
    return kinetic_friction(s, way) / stiffness_of(s, way);
}

static double
deflection_limit(const ss_scene *s, int way)
{
    return holding_friction(s, way) / stiffness_of(s, way);
}

/* The ratio of damper to spring in the force that ends a microstick [s]. */
static double
damper_ratio(const ss_scene *s, int way)
{
    return s->own[RELEASE] == SPRING ? 0 : s->own[DAMPING] / stiffness_of(s, way);
}

/* Microstick lasts while the spring's force, or that of spring and damper, is within f_s.  On a side it lasts
 * there while the spring touches; its bounds are the release, the edge of the side, and the release by a damper
 * that pulls. */
static void
set_bounds(state *m)
{
    const ss_scene *s = m->scene;
    double up = deflection_limit(s, 1), down = deflection_limit(s, -1), ratio = damper_ratio(s, m->side);
    int side = m->side;
    m->n_bounds = 2;
    if (is_gap(s, side)) {
        m->n_bounds = 1;
        m->bound[0] = (bound){ s->own[GAP], { -1, 0 }, 1 };
    } else if (side != 0) {
        double pull = holding_friction(s, -side) / stiffness_of(s, side);
        m->n_bounds = ratio > 0 ? 3 : 2;
        m->bound[0] = (bound){ (side > 0 ? up : down) + m->slack, { -side, -side * ratio }, 0 };
        m->bound[1] = (bound){ 0, { side, 0 }, 0 };
        m->bound[2] = (bound){ pull, { side, side * ratio }, 0 };
    } else if (up == down) {
        m->n_bounds = 1;
        m->bound[0] = (bound){ up + m->slack, { -1, -ratio }, 1 };
    } else {
        m->bound[0] = (bound){ up + m->slack, { -1, -ratio }, 0 };
        m->bound[1] = (bound){ down + m->slack, { 1, ratio }, 0 };
    }
}

static void
microstick(state *m, double x, int side, double q, double v)
{
    const ss_scene *s = m->scene;
    int gap = is_gap(s, side);
    m->mode = 0;
    m->side = side;
    m->k = s->stiffness + (gap ? 0 : stiffness_of(s, side));
    m->c = (gap ? 0 : s->own[DAMPING]) + s->damping;
    m->x_ref = x - q;
    m->f0 = s->stiffness * m->x_ref;
    m->slack = 0;
    m->q[0] = q;
    m->q[1] = v;
    set_bounds(m);
}

/* The direction in which a mass that no contact holds is pushed: that of the force, or of the force's rate where
 * that is 0. */
static int
push(const state *m, double x)
{
    double force = ss_stick_force(m, base_force(m, m->u), x);
    int way = force != 0 ? sign(force) : sign(base_force_rate(m, m->u));
    return way != 0 ? way : 1;
}

/* A contact that goes no further than this beyond its limit only touches it.  The distance is ten times
 * the error of x in a step, which is that of an integrator in the course of a stick.  In units of the
 * limit it is at most 1e-6, a hundredth of the excursion of the shortest micro-slips (2e-4 for one of
 * 0.1 ms in the light scene). */
#define GRAZE_TOL 10
#define GRAZE_MOST 1e-6

static int
start(state *m)
{
    const ss_scene *s = m->scene;
    double up = deflection_limit(s, 1), down = deflection_limit(s, -1), v = s->v0 - s->surface_velocity;
    double limit = up < down ? up : down;
    m->graze = fmin(GRAZE_TOL * m->tol * m->x_scale, GRAZE_MOST * limit);
    if (v == 0 && static_friction(s) > 0) {
        microstick(m, s->x0, is_alike(s) || s->own[GAP] > 0 ? 0 : push(m, s->x0), 0, 0);
        return 0;
    }
    ss_linear_slip(m, s->x0, v, v != 0 ? sign(v) : push(m, s->x0));      /* without friction it never sticks */
    return 1;
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
    double rate[MAX_DIM], v = m->q[1];
    ss_linear_rates(m, base_force(m, m->u), m->q, rate);
    if (!(rate[1] * sign(m->q[0]) < 0))
        return 0;
    /* it will turn back so far beyond its limit if v' stays as it is; v^2 may underflow */
    double beyond = fabs(m->q[0]) - deflection_limit(s, sign(m->q[0])) + v / (2 * fabs(rate[1])) * v;
    if (!(beyond <= m->slack + m->graze))
        return 0;
    m->q[0] -= sign(m->q[0]) * beyond;
    m->slack = m->graze;                /* so that its peak needs no second test */
    set_bounds(m);
    m->touches++;
    return 1;
}

static int
next(state *m, ss_event *e)
{
    const ss_scene *s = m->scene;
    double x = m->x_ref + m->q[0], v = m->q[1], b = s->own[GAP];
    int before = m->mode, side = m->side, released = before == 0 && !is_gap(s, side) && (side == 0 || m->ended != 1);
    if (before == 0 && !released) {             /* from side to side */
        int to = side == 0 ? sign(m->q[0]) : b > 0 ? 0 : -side;
        /* spring and damper, if they are what counts, may exceed f_s where the spring begins to touch */
        if (is_gap(s, to) || !(damper_ratio(s, to) * to * v > deflection_limit(s, to))) {
            microstick(m, x, to, to == 0 ? side * b : 0, v);
            return 0;
        }
    }
    if (released && only_touches(m))
        return 0;
    if (before == 0) {
        ss_linear_slip(m, x, v, v != 0 ? sign(v) : sign(m->q[0]));
        e->kind = SS_SLIP;
    } else if (static_friction(s) == 0) {       /* no stick without friction: v passes through 0 */
        ss_linear_slip(m, x, 0, -m->mode);
        e->kind = SS_REVERSE;
    } else {
        e->kind = SS_STICK;
        microstick(m, x, is_alike(s) ? 0 : before, before * deflection_in_slip(s, before), 0);
    }
    e->direction = m->mode != 0 ? m->mode : before;
    return 1;
}

static double
deflection(const state *m, const double q[])
{
    const ss_scene *s = m->scene;
    return m->mode == 0 ? q[0] + m->side * s->own[GAP] : m->mode * (s->own[GAP] + deflection_in_slip(s, m->mode));
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
    s->f = m->mode != 0 ? m->f0 : is_gap(m->scene, m->side) ? 0
        : stiffness_of(m->scene, m->side) * q[0] + m->scene->own[DAMPING] * q[1];
}

static double
memory(const state *m, double *unit)
{
    *unit = m->scene->own[GAP] + fmax(deflection_limit(m->scene, 1), deflection_limit(m->scene, -1));
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

/* The derivatives across the end of a microstick, or of one side in it, where |q + ratio v| reaches its bound. */
static void
cross_bound(const state *m, const bound *by, const double q[], const double before[], const double after[],
            double d[D_MOST][D_MOST])
{
    double jump = before[1] - after[1], ratio = by->of[1] / by->of[0];
    for (int i = 0; i < D_MOST; i++) {
        double later = -(d[D_Q][i] + ratio * d[D_V][i]) / (q[1] + ratio * before[1]);
        if (jump != 0)
            d[D_V][i] += jump * later;
        if (m->mode == 0)
            continue;
        d[D_Q][i] += d[D_REF][i];
        d[D_REF][i] = 0;
    }
}

static void
cross(const state *m, int mode, const bound *by, const double q[], const double before[], const double after[],
      double d[D_MOST][D_MOST])
{
    if (mode == 0) {
        cross_bound(m, by, q, before, after, d);
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
    double rates[MAX_DIM];
    m->x_ref += d[D_REF];
    m->q[0] += d[D_Q];
    m->q[1] += d[D_V];
    if (m->mode == 0)
        m->f0 = m->scene->stiffness * m->x_ref;
    ss_linear_rates(m, base_force(m, m->u), m->q, rates);
    return within_bounds(m, rates);
}

static const struct variation variation = { free_differences, cross, move };

/* The two directions of the motion have a part each. */
static void
drive(const ss_scene *s, double *memory, const piece *p, double part[])
{
    const double b = s->own[GAP], up = b + deflection_in_slip(s, 1), down = b + deflection_in_slip(s, -1);
    *memory = fmax(-down, fmin(*memory + p->dx, up));
    part[0] = stiffness_of(s, 1) * fmax(*memory - b, 0);
    part[1] = stiffness_of(s, -1) * fmin(*memory + b, 0);
}

void
ss_to_compliant(ss_scene *scene, double stiffness, double gap)
{
    scene->model = &ss_compliant_model;
    memset(scene->own, 0, sizeof scene->own);
    scene->own[STIFFNESS] = stiffness;
    scene->own[GAP] = gap;
}

MODEL(compliant) = {
    .name = "compliant",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys,
    .parameter = { { .offset = OWN_AT(STIFFNESS), .by_mass = 1 },
                   { .offset = OWN_AT(DAMPING), .by_mass = 1 } },
    .n_parameters = 2,
    .vanishing = vanishing_terms, .n_vanishing = sizeof vanishing_terms / sizeof *vanishing_terms,
    .limit = ss_to_coulomb,
    .dim = 2, .linear = 1, .has_contact = 1, .force_varies = IN_STICK,
    .start = start, .fastest = ss_linear_fastest, .rates = ss_linear_rates,
    .jacobian = ss_linear_jacobian, .series = ss_linear_series,
    .next = next, .sample = sample,
    .memory = memory, .in_transition = in_microstick, .variation = &variation,
    .drive = drive
};
