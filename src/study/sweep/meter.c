/* meter.c -- measures along a walk.
 *
 * Counts and times come from the events.  Extrema lie at the ends of legs, or where a rate changes
 * its sign inside a leg.  They are searched in parts of 1/40 of the mode's fastest period, which
 * contain at most one each, and located to 1e-9 of the part; the error of their value is the
 * square of this.  The work is f_k |dx| in slip, elsewhere a Gauss quadrature of f v, of order 10
 * in each part. */
#include "study/sweep/cycles.h"

#include <math.h>

enum { RANGE = 1u << SS_AMPLITUDE | 1u << SS_X_MAX | 1u << SS_FORCE_DROP,
       FAST = 1u << SS_V_MAX | 1u << SS_PEAK_VELOCITY };

void
ss_meter_begin(meter *r, unsigned wanted, const state *m)
{
    unsigned inside = FAST | 1u << SS_A_MAX | 1u << SS_TRANSITION;
    if (m->model->force_varies || pull_of(m->scene) != 0)   /* if not, modes end at all extrema of x */
        inside |= RANGE | 1u << SS_ENERGY;
    *r = (meter){ .wanted = wanted, .stiffness = m->scene->stiffness, .needs_course = (wanted & inside) != 0,
                  .x_lo = INFINITY, .x_hi = -INFINITY, .slip = m->mode, .in_first = 1 };
}

typedef struct point {
    double s, x, dx;                /* time in the leg; x - U t and its rate */
    double v, a, jerk, f;
    double slid, slip;              /* place and velocity on the surface */
} point;

static point
point_of(walk *w, double s, const double q[], const double dqdt[])
{
    const state *m = &w->m.now;
    double dfdq[MAX_DIM * MAX_DIM], dfdt[MAX_DIM];
    ss_sample sample;
    m->model->sample(m, base_force(m, m->u + s), q, dqdt, &sample);
    double U = m->scene->base_velocity, S = m->scene->surface_velocity;
    point p = { s, sample.x - frame_pull(m) * (m->u + s), sample.v - (U - S), sample.v + S, sample.a, 0,
                sample.f, sample.x, sample.v };
    if (w->still)
        return p;
    m->model->jacobian(m, m->u + s, q, dfdq, dfdt);
    p.jerk = dfdt[1];
    for (size_t i = 0; i < m->model->dim; i++)
        p.jerk += dfdq[m->model->dim + i] * dqdt[i];
    return p;
}

static point
point_at(walk *w, double s)
{
    double q[MAX_DIM], dqdt[MAX_DIM];
    ss_walk_at(w, s, q, dqdt);
    return point_of(w, s, q, dqdt);
}

static void
widen_extremes(meter *r, const point *p)
{
    r->x_lo = fmin(r->x_lo, p->x);
    r->x_hi = fmax(r->x_hi, p->x);
    r->v_max = fmax(r->v_max, fabs(p->v));
    r->a_max = fmax(r->a_max, fabs(p->a));
}

/* The rate that is 0 at an extremum of x, v or a. */
typedef enum rate { OF_X, OF_V, OF_A } rate;

static double
rate_of(const point *p, rate which)
{
    return which == OF_X ? p->dx : which == OF_V ? p->a : p->jerk;
}

/* The point between lo and hi at which the rate is 0; its signs at lo and hi differ.  It is found by false
 * position with the Illinois rule (Dowell and Jarratt 1971). */
static point
extremum(walk *w, point lo, point hi, rate which)
{
    double f_lo = rate_of(&lo, which), f_hi = rate_of(&hi, which), width = 1e-9 * (hi.s - lo.s);
    point mid = hi;
    for (int i = 0, side = 0; i < 60 && hi.s - lo.s > width; i++) {
        mid = point_at(w, lo.s + (hi.s - lo.s) * f_lo / (f_lo - f_hi));
        double f = rate_of(&mid, which);
        if (f == 0)
            break;
        if ((f < 0) == (f_hi < 0)) {
            width = fabs(mid.s - hi.s) <= width ? INFINITY : width;
            hi = mid;
            f_hi = f;
            f_lo /= side == 1 ? 2 : 1;
            side = 1;
        } else {
            width = fabs(mid.s - lo.s) <= width ? INFINITY : width;
            lo = mid;
            f_lo = f;
            f_hi /= side == -1 ? 2 : 1;
            side = -1;
        }
    }
    return mid;
}

static int
in_transition(const state *m, const point *p)
{
    return m->model->in_transition != NULL && m->model->in_transition(m, p->slip);
}

/* Add the spacings of a transition's extrema.  Fewer than three are no oscillation, since the base alone
 * causes two. */
static void
count_ring(meter *r, const ring *of)
{
    if (of->n < 3)
        return;
    r->spacing += of->last - of->first;
    r->spacings += of->n - 1;
}

static void
leave_transition(meter *r)
{
    if (r->in_first)
        r->begun_in = r->now;
    else
        count_ring(r, &r->now);
    r->in_first = 0;
    r->now.n = 0;
}

static double
work_between(walk *w, double lo, double hi)
{
    static const double node[] = { 0, 0.53846931010568309104, 0.90617984593866399280 };
    static const double weight[] = { 0.56888888888888888889, 0.47862867049936646804,
                                     0.23692688505618908751 };
    const state *m = &w->m.now;
    double sum = 0, half = (hi - lo) / 2;
    for (int i = -2; i <= 2; i++) {
        double s = lo + half + (i < 0 ? -1 : 1) * node[i < 0 ? -i : i] * half, q[MAX_DIM], dqdt[MAX_DIM];
        ss_sample sample;
        ss_walk_at(w, s, q, dqdt);
        m->model->sample(m, base_force(m, m->u + s), q, dqdt, &sample);
        sum += weight[i < 0 ? -i : i] * sample.f * sample.v;
    }
    return half * sum;
}

/* Measure the part of a leg between two points that are near each other. */
static void
measure_part(meter *r, walk *w, const point *lo, const point *hi)
{
    static const unsigned by_rate[] = { RANGE, FAST, 1u << SS_A_MAX | 1u << SS_TRANSITION };
    for (rate which = OF_X; which <= OF_A; which++)
        if ((r->wanted & by_rate[which]) && rate_of(lo, which) * rate_of(hi, which) < 0) {
            point p = extremum(w, *lo, *hi, which);
            widen_extremes(r, &p);
            if (which != OF_A || !in_transition(&w->m.now, &p))
                continue;
            r->now.last = r->time + p.s;
            if (r->now.n++ == 0)
                r->now.first = r->now.last;
        }
    if (!in_transition(&w->m.now, hi))
        leave_transition(r);
}

/* 1 if the friction force varies within the mode. */
static int
force_varies(const state *m)
{
    return (m->model->force_varies & (m->mode == 0 ? IN_STICK : IN_SLIP)) != 0;
}

void
ss_meter_leg(meter *r, walk *w)
{
    int still = w->still || !r->needs_course;
    size_t parts = still ? 1 : (size_t)ceil(w->h / ss_step_cap(&w->m.now));
    if (!w->m.now.model->linear && !still)
        parts *= 2;
    point lo = point_of(w, 0, w->m.now.q, w->e->dq0), first = lo;
    widen_extremes(r, &lo);
    for (size_t i = 1; i <= parts; i++) {
        point hi = point_at(w, i < parts ? w->h * (double)i / (double)parts : w->h);
        widen_extremes(r, &hi);
        if (!still) {
            measure_part(r, w, &lo, &hi);
            if (force_varies(&w->m.now) && (r->wanted & 1u << SS_ENERGY))
                r->energy += work_between(w, lo.s, hi.s);
        }
        lo = hi;
    }
    if (!force_varies(&w->m.now))
        r->energy += w->m.now.f0 * (lo.slid - first.slid);
    course *c = r->course;
    for (; c != NULL && c->done < c->n && (double)c->done * c->interval - r->time < w->h; c->done++) {
        point p = point_at(w, fmax(0, (double)c->done * c->interval - r->time));
        const double row[COURSE_COLUMNS] = { p.x, p.v, p.a, p.f };
        for (int i = 0; i < COURSE_COLUMNS; i++)
            c->value[i][c->done] = row[i];
    }
    r->time += w->h;
    if (w->m.now.mode == 0)
        r->stick += w->h;
}

void
ss_meter_event(meter *r, const ss_event *event)
{
    if (event->kind == SS_STICK) {
        r->stops++;
        return;
    }
    leave_transition(r);
    if (event->kind == SS_SLIP && r->slip == 0)
        r->first_slip = event->direction;
    else if (event->kind == SS_SLIP && r->slip == event->direction)
        r->microslips++;
    r->slip = event->direction;
}

void
ss_meter_end(meter *r, int n, int closes, double value[])
{
    if (closes && r->first_slip != 0 && r->first_slip == r->slip)
        r->microslips++;
    ring joined = r->now;
    if (r->in_first || r->begun_in.n == 0 || !closes) {
        count_ring(r, &r->now);
        count_ring(r, &r->begun_in);
    } else {                            /* the last transition and that at the start are parts of one */
        joined.first = r->now.n > 0 ? r->now.first : r->begun_in.first + r->time;
        joined.last = r->begun_in.last + r->time;
        joined.n += r->begun_in.n;
        count_ring(r, &joined);
    }
    value[SS_STOPS] = (double)r->stops / n;
    value[SS_STICK_FRACTION] = r->stick / r->time;
    value[SS_AMPLITUDE] = (r->x_hi - r->x_lo) / 2;
    value[SS_X_MAX] = fmax(fabs(r->x_hi), fabs(r->x_lo));
    value[SS_V_MAX] = r->v_max;
    value[SS_A_MAX] = r->a_max;
    value[SS_ENERGY] = r->energy / n;
    value[SS_MICROSLIPS] = (double)r->microslips / (2 * n);
    value[SS_CYCLE_TIME] = r->time / n;
    value[SS_PEAK_VELOCITY] = r->v_max;
    value[SS_FORCE_DROP] = r->stiffness * (r->x_hi - r->x_lo);
    value[SS_TRANSITION] = r->spacings > 0 ? (double)r->spacings / (2 * r->spacing) : NAN;
}
