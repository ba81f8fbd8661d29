/* stick.c -- true stick: v is exactly 0 and the mass moves with the surface, until the force of
 * spring, damper and base exceeds the static friction. */
#include "scene/model.h"

#include <float.h>

double
ss_stick_force(const state *m, double drive, double x)
{
    return drive - m->scene->stiffness * x;
}

static int
is_held(const state *m, double drive, double x)
{
    double force = ss_stick_force(m, drive, x);
    return fabs(force) <= holding_friction(m->scene, sign(force));
}

/* Enter stick if friction can hold the mass, else slip in the direction of the force. */
static int
stop_or_go(state *m, double x)
{
    double drive = base_force(m, m->u);
    ss_linear_slip(m, x, 0, is_held(m, drive, x) ? 0 : sign(ss_stick_force(m, drive, x)));
    return m->mode;
}

int
ss_stick_start(state *m)
{
    const ss_scene *s = m->scene;
    double v = s->v0 - s->surface_velocity;
    if (v == 0)
        return stop_or_go(m, s->x0) != 0;
    ss_linear_slip(m, s->x0, v, sign(v));
    return 1;
}

/* The first angle after `from` that differs from `angle` by whole turns. */
static double
next_turn(double angle, double from)
{
    const double round = 2 * M_PI;
    double ahead = fmod(angle - from, round);
    return from + (ahead <= 0 ? ahead + round : ahead);
}

/* The zero in [lo, hi] of D cos(angle + omega s) + R s - level, which rises there: by Newton's steps, and
 * by bisection where these leave the bracket. */
static double
rising_zero(const state *m, double angle, double R, double level, double lo, double hi)
{
    double s = hi, before = NAN;
    int back = 0;
    for (int i = 0; i < 200 && hi - lo > DBL_EPSILON * fmax(fabs(lo), fabs(hi)); i++) {
        turn at = turn_of(angle + m->omega * s);
        double g = m->drive * at.co + R * s - level, next = s - g / (R - m->drive * m->omega * at.si);
        if (g < 0)
            lo = s;
        else
            hi = s;
        if (!(next >= lo && next <= hi))
            next = lo + (hi - lo) / 2;
        if (next == s)
            break;
        back = next == before ? back + 1 : 0;
        if (back == 2)                          /* rounding moves it to and fro, up to the last round */
            return i % 2 == 0 ? s : next;
        before = s;
        s = next;
    }
    return s;
}

/* The time s at which D cos(angle + omega s) + R s, which begins at level or below, exceeds level.  If
 * the pull is slower than the swing, the sum rises and falls, and each peak is higher than the one before
 * by what the pull adds in a turn.  So the first peak above level is computed, not searched. */
static double
time_to_rise(const state *m, double angle, double R, double level)
{
    double D = m->drive, fastest = D * m->omega, round = 2 * M_PI / m->omega;
    if (fastest <= fabs(R))
        return R <= 0 ? INFINITY
            : rising_zero(m, angle, R, level, fmax(0, (level - D) / R), fmax(0, (level + D) / R));
    double top = asin(R / fastest), peak = (next_turn(top, angle) - angle) / m->omega;
    double height = D * cos(top) + R * peak;
    if (height <= level && R <= 0)
        return INFINITY;
    if (height <= level)
        peak += round * (floor((level - height) / (R * round)) + 1);
    double since = fmin((M_PI + 2 * top) / m->omega, peak);
    return peak + rising_zero(m, top, R, level - R * peak, -since, 0);
}

/* The time at which a measured base and the pull raise the force above its limit, within the present
 * interval of the base; else INFINITY.  The force is a cubic there, monotonic between its extrema. */
static double
end_in_piece(const state *m, double x)
{
    double length = m->u_knot - m->u, u = m->u, a = 3 * m->z[3], b = m->z[2];
    double c = m->z[1] + m->ramp / m->scene->stiffness, root = sqrt(fmax(b * b - a * c, 0));
    double far = -(b + copysign(root, b)), first = far / a, second = c / far;   /* of 3 z3 s^2 + 2 z2 s + c */
    double at[] = { m->u_piece + fmin(first, second), m->u_piece + fmax(first, second), u + length };
    for (int i = 0; i < 3; i++) {
        double lo = u, hi = at[i];
        if (!(hi > u && hi <= m->u + length)
            || is_held(m, base_force(m, hi), x))
            continue;
        while (lo + (hi - lo) / 2 > lo && lo + (hi - lo) / 2 < hi) {
            double mid = lo + (hi - lo) / 2;
            if (is_held(m, base_force(m, mid), x))
                lo = mid;
            else
                hi = mid;
        }
        return hi;
    }
    return INFINITY;
}

/* The end of a stick is known in closed form, or to rounding.  A stick that begins at its limit, within
 * rounding, while the force grows, ends at once; without this rule the crossing would lie in the past,
 * and the stick would last a whole turn. */
int
ss_stick_still(const state *m, double *u_end)
{
    const ss_scene *s = m->scene;
    double x = m->q[0], up = holding_friction(s, 1), down = holding_friction(s, -1);

    if (m->mode != 0)
        return 0;
    *u_end = INFINITY;
    if ((m->omega == 0 || m->drive == 0) && m->ramp == 0 && s->base == NULL)
        return 1;
    double theta = m->theta + m->omega * m->u, force = ss_stick_force(m, base_force(m, m->u), x);
    double size = m->drive + s->stiffness * fabs(x) + fmax(up, down) + fabs(m->drag) + fabs(m->ramp * m->u);
    size += s->base != NULL ? s->stiffness * s->base->size : 0;
    if (force * base_force_rate(m, m->u) > 0 && (force > 0 ? up : down) - fabs(force) <= 8 * DBL_EPSILON * size) {
        *u_end = m->u;
    } else if (s->base != NULL) {
        *u_end = end_in_piece(m, x);
    } else {
        double rest = force - m->drive * cos(theta);
        *u_end = m->u + fmin(time_to_rise(m, theta, m->ramp, up - rest),
                             time_to_rise(m, theta + M_PI, -m->ramp, down + rest));
    }
    return 1;
}

int
ss_stick_next(state *m, ss_event *e)
{
    double x = m->q[0];
    int before = m->mode;
    if (before == 0) {                  /* the force has reached its limit and grows */
        ss_linear_slip(m, x, 0, sign(base_force_rate(m, m->u)));
        e->kind = SS_SLIP;
        e->direction = m->mode;
        return 1;
    }
    int now = stop_or_go(m, x);
    e->kind = now == 0 ? SS_STICK : SS_REVERSE;
    e->direction = now == 0 ? before : now;
    return now != before;               /* if equal, v has only touched 0 and keeps its sign */
}

/* --- neighbouring states ------------------------------------------------------------------- */

static void
free_differences(const state *m, int is_free[D_MOST])
{
    is_free[D_REF] = 0;
    is_free[D_Q] = 1;
    is_free[D_V] = m->mode != 0;
}

/* In a stick, neighbours lose their difference in v.  A neighbour whose x is further on slips later: it
 * has been accelerated, by the drop from static to kinetic friction, for a shorter time. */
static void
cross(const state *m, int mode, const bound *by, const double q[], const double before[], const double after[],
      double d[D_MOST][D_MOST])
{
    const ss_scene *s = m->scene;
    (void)q, (void)by;
    for (int i = 0; i < D_MOST; i++)
        if (mode == m->mode)
            continue;                   /* v has only touched 0 */
        else if (mode != 0)
            d[D_V][i] *= m->mode == 0 ? 0 : after[1] / before[1];
        else if (holding_friction(s, m->mode) > kinetic_friction(s, m->mode))
            d[D_V][i] = -after[1] * s->stiffness * d[D_Q][i] / base_force_rate(m, m->u);
}

static int
move(state *m, const double d[D_MOST])
{
    double rates[MAX_DIM];
    m->q[0] += d[D_Q];
    m->q[1] += d[D_V];
    double drive = base_force(m, m->u);
    if (m->mode == 0)
        return is_held(m, drive, m->q[0]);
    m->model->rates(m, drive, m->q, rates);
    return within_bounds(m, rates);
}

const struct variation ss_stick_variation = { free_differences, cross, move };

void
ss_stick_sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s)
{
    int still = m->mode == 0;
    s->x = q[0];
    s->v = q[1];
    s->a = still ? 0 : dqdt[1];
    s->f = still ? ss_stick_force(m, drive, q[0]) : m->f0;
    s->y = 0;
    s->mode = m->mode;
}
