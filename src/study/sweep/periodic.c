/* periodic.c -- the periodic state to which a scene settles, by simulation and by Newton's method.
 *
 * The states at the starts of cycles are the iterates of a map.  They have period p when they
 * repeat after p cycles.  They approach their limit geometrically, so the rate at which the last
 * differences shrink gives the remaining distance, and a slow approach is not mistaken for the
 * limit.  Newton's method may replace the last part of the approach; it finds any motion that is near,
 * so what it finds is accepted only if it is the one that the motion approaches. */
#include "study/sweep/cycles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/list.h"

/* --- measuring cycles that begin at the present state ----------------------------------------- */

static void
find_multipliers(finder *f, const motion *start, int period)
{
    cycles *c = &f->c;
    double *value = f->out->value;
    tangent t;
    ss_cycles_begin_at(c, start);
    ss_cycles_derive(c, period, MULTIPLIERS, &t);
    if (c->status == SS_OK)
        c->status = ss_tangent_multipliers(&t, &value[SS_FLOQUET], &value[SS_FLOQUET_2], &value[SS_FLOQUET_ANGLE]);
    /* below this, rounding or the error that the tolerance allows may have made the multiplier */
    double least = c->how->kind == CLOSED_FORM ? 1e-10 : 1e-6, time = period * value[SS_CYCLE_TIME];
    value[SS_LYAPUNOV] = value[SS_FLOQUET] <= least ? -INFINITY : log(value[SS_FLOQUET]) / time;
    value[SS_LYAPUNOV_ERROR] = 0;
}

/* Measure n further cycles; period is 0 if the motion does not return. */
static void
measure_cycles(finder *f, int n, int period)
{
    meter r;
    cycles *c = &f->c;
    const ss_steady_opts *o = c->opts;
    double *value = f->out->value;
    const motion start = c->w.m;
    section at = ss_section_of(&start);
    ss_meter_begin(&r, o->measures, &start.now);
    if (c->status == SS_OK && (o->measures & MODEL_ERRORS)) {
        free(f->course.value);
        f->course = (course){ .cycles = n, .n = (size_t)n * COURSE_A_CYCLE,
                              .interval = 1 / c->scene->base_frequency / COURSE_A_CYCLE };
        if ((f->course.value = ss_columns_new(COURSE_COLUMNS, f->course.n)) == NULL)
            c->status = SS_ENOMEM;
        r.course = &f->course;
    }
    ss_cycles_go(c, n, &r);
    if (c->status != SS_OK)
        return;
    f->missed = ss_section_distance(c, ss_section_of(&c->w.m), at);
    f->unresolved = ss_motion_unresolved(&c->w.m) - ss_motion_unresolved(&start);
    ss_meter_end(&r, n, period > 0, value);
    value[SS_PERIOD] = period;
    value[SS_X_PHASE] = at.x;
    value[SS_V_PHASE] = speed_of(&start.now) + c->scene->surface_velocity;
    if (period > 0 && (o->measures & (FLOQUET | LYAPUNOV))) {
        find_multipliers(f, &start, period);
    } else if (o->measures & LYAPUNOV) {
        ss_cycles_begin_at(c, &start);
        ss_cycles_exponent(c, o->settle > 0 ? o->settle : o->max_cycles, &value[SS_LYAPUNOV],
                           &value[SS_LYAPUNOV_ERROR]);
    }
    int strobes = o->strobe > 0 && period > 0 ? period : o->strobe;
    if (strobes > 0)
        ss_cycles_begin_at(c, &start);
    for (f->out->n_strobes = 0; c->status == SS_OK && f->out->n_strobes < (size_t)strobes; f->out->n_strobes++) {
        double v = speed_of(&c->w.m.now) + c->scene->surface_velocity;
        f->out->strobe[f->out->n_strobes] = (ss_strobe){ ss_section_of(&c->w.m).x, v };
        ss_cycles_go(c, 1, NULL);
    }
}

/* --- Newton's method ------------------------------------------------------------------------- */

/* There are at most NEWTON_STEPS steps, and at most MOST_IN_VAIN of them may shorten the distance by less
 * than a quarter.  (At the end of a line of motions the root is a double one, and each step halves it.) */
enum { NEWTON_STEPS = 20, MOST_IN_VAIN = 6 };

/* Make one step of Newton's method, which moves *at; *t becomes the derivative there.  Returns the larger of the
 * step and of the distance by which the motion misses its start; INFINITY if no step is possible, unless this
 * distance is rounding. */
static double
newton_step(cycles *c, int period, motion *at, tangent *t)
{
    double unit[D_MOST], from[D_MOST], r[D_MOST], d[D_MOST];
    ss_cycles_begin_at(c, at);
    ss_cycles_derive(c, period, NEWTON, t);
    if (c->status != SS_OK)
        return INFINITY;
    const motion end = c->w.m;
    motion moved = *at;
    double missed = ss_section_distance(c, ss_section_of(&end), ss_section_of(at));
    ss_cycles_coordinates(at, from);
    ss_cycles_coordinates(&end, r);
    ss_cycles_units(c, unit);
    for (int i = 0; i < D_MOST; i++)
        r[i] -= from[i];
    c->status = ss_tangent_solve(t, unit, r, d);
    int allowed = end.now.mode == at->now.mode && isfinite(d[0] + d[1] + d[2]) && ss_cycles_move(&moved, d);
    double off = missed <= ROUNDING ? missed : INFINITY;
    if (allowed)
        off = fmax(missed, ss_section_distance(c, ss_section_of(&moved), ss_section_of(at)));
    *at = allowed ? moved : end;        /* if no step is possible, simulate on */
    ss_motion_rebase(at);
    at->origin = (instant){ 0, 0 };
    return off;
}

/* Make Newton's steps until one is within tol.  Returns 1 if there is one. */
static int
converge(cycles *c, int period, motion *at, tangent *t)
{
    double off = INFINITY, second, angle;
    int in_vain = 0;
    for (int i = 0; c->status == SS_OK && off > c->opts->tol && i < NEWTON_STEPS && in_vain < MOST_IN_VAIN; i++) {
        double last = off;
        off = newton_step(c, period, at, t);
        in_vain += off > 0.75 * last;
    }
    if (c->status == SS_OK && off <= c->opts->tol)
        c->status = ss_tangent_multipliers(t, &c->multiplier, &second, &angle);
    return c->status == SS_OK && off <= c->opts->tol;
}

/* --- which motion is approached ------------------------------------------------------------- */

/* A motion may differ by this part of its distance from what the derivative at its limit predicts. */
#define NONLINEAR 0.1
/* The part that shrinks least may differ by this part of its change: it must change in the same direction. */
#define SAME_WAY 0.8
/* A multiplier this near to 1, as at the end of a line of motions, does not show how a motion is
 * approached. */
#define NEUTRAL 1e-6
/* A difference of this part of the first distance is allowed, since walks are no more accurate. */
#define MEASURABLE 0.01
enum { REPETITIONS = 8 };

/* What is near a periodic motion: the derivative of one repetition, in units; and that of 2^30 repetitions,
 * divided by exp(scale), in which only the part of a difference that shrinks least is left. */
typedef struct neighbourhood {
    const motion *at;
    double unit[D_MOST], once[D_MOST][D_MOST], slow[D_MOST][D_MOST], scale;
} neighbourhood;

static neighbourhood
neighbourhood_of(const cycles *c, const motion *at, const tangent *t)
{
    neighbourhood near = { .at = at };
    ss_cycles_units(c, near.unit);
    for (int i = 0; i < D_MOST; i++)
        for (int j = 0; j < D_MOST; j++)
            near.once[i][j] = t->d[i][j] * (near.unit[j] / near.unit[i]);
    memcpy(near.slow, near.once, sizeof near.slow);
    for (int n = 0; n < 30; n++) {
        double square[D_MOST][D_MOST] = { { 0 } }, size = 0;
        for (int i = 0; i < D_MOST; i++)
            for (int j = 0; j < D_MOST; j++) {
                for (int k = 0; k < D_MOST; k++)
                    square[i][j] += near.slow[i][k] * near.slow[k][j];
                size = fmax(size, fabs(square[i][j]));
            }
        near.scale = 2 * near.scale + log(size);
        for (int i = 0; i < D_MOST * D_MOST; i++)
            near.slow[i / D_MOST][i % D_MOST] = square[i / D_MOST][i % D_MOST] / (size > 0 ? size : 1);
    }
    return near;
}

static void
times(double m[D_MOST][D_MOST], const double d[D_MOST], double out[D_MOST])
{
    for (int i = 0; i < D_MOST; i++) {
        out[i] = 0;
        for (int j = 0; j < D_MOST; j++)
            out[i] += m[i][j] * d[j];
    }
}

static double
size_of(const double d[D_MOST])
{
    return fmax(fabs(d[D_REF]), fmax(fabs(d[D_Q]), fabs(d[D_V])));
}

/* The difference of a motion from the periodic one.  Returns 1 if they have the same coordinates, as slips in
 * either direction do. */
static int
away_from(const neighbourhood *near, const motion *m, double d[D_MOST])
{
    double centre[D_MOST];
    ss_cycles_coordinates(near->at, centre);
    ss_cycles_coordinates(m, d);
    for (int i = 0; i < D_MOST; i++)
        d[i] = (d[i] - centre[i]) / near->unit[i];
    return (near->at->now.mode == 0) == (m->now.mode == 0);
}

/* 1 if the motion from a state approaches the periodic motion `at`, in several repetitions of its cycles, as its
 * derivative predicts.  If not, another motion is approached, or none.  One repetition would not suffice: a
 * chaotic motion comes near many periodic ones that it leaves again. */
static int
is_approached(cycles *c, const motion *from, const motion *at, const tangent *t, int period)
{
    double before[D_MOST], after[D_MOST], left[D_MOST], tol = c->opts->tol;
    double off[D_MOST], change[D_MOST], slow_off[D_MOST], slow_change[D_MOST];
    ss_cycles_begin_at(c, from);
    neighbourhood near = neighbourhood_of(c, at, t);
    int yes = away_from(&near, from, before);
    times(near.slow, before, left);
    double size = size_of(before), shrinks = 1 - c->multiplier;
    double allowed_slow = shrinks > NEUTRAL ? MEASURABLE * size * shrinks + tol : INFINITY;
    yes = yes && size_of(left) * exp(near.scale) <= tol;
    for (int n = 0; c->status == SS_OK && yes && n < REPETITIONS; n++) {
        ss_cycles_go(c, period, NULL);
        yes = away_from(&near, &c->w.m, after);
        /* in one repetition a difference changes as the derivative predicts; motions that lie side by side differ
         * in the part that shrinks least, of which little is lost in a cycle: this part must shrink so, too */
        times(near.once, before, off);
        for (int i = 0; i < D_MOST; i++) {
            change[i] = off[i] - before[i];
            off[i] = after[i] - off[i];
        }
        times(near.slow, off, slow_off);
        times(near.slow, change, slow_change);
        yes = yes && size_of(off) <= NONLINEAR * size_of(before) + MEASURABLE * size + tol
            && size_of(slow_off) <= SAME_WAY * size_of(slow_change) + allowed_slow;
        memcpy(before, after, sizeof before);
    }
    return yes;
}

/* 1 if a motion that has crawled for all cycles that it was given crawls to `at`, which must attract: from all
 * the way between the two, neighbours come nearer to it, too, and none passes it.  Their speed may change on the
 * way, as it does far from the limit, by more than is_approached allows. */
static int
crawls_to(cycles *c, const motion *from, const motion *at, const tangent *t, int period)
{
    enum { PLACES = 8 };
    double all[D_MOST];
    neighbourhood near = neighbourhood_of(c, at, t);
    int yes = away_from(&near, from, all) && c->multiplier < 1 - NEUTRAL
        && pow(c->multiplier, (double)c->opts->max_cycles) > c->opts->tol;
    for (int k = 0; c->status == SS_OK && yes && k < PLACES; k++) {
        motion here = *from;
        double by[D_MOST], d[D_MOST], before[D_MOST], after[D_MOST], part = 0, whole = 0;
        for (int i = 0; i < D_MOST; i++)
            by[i] = -all[i] * near.unit[i] * k / PLACES;
        yes = ss_cycles_move(&here, by);
        ss_cycles_begin_at(c, &here);
        ss_cycles_go(c, REPETITIONS * period, NULL);    /* what shrinks fast is gone after these */
        away_from(&near, &c->w.m, d);
        times(near.slow, d, before);
        ss_cycles_go(c, period, NULL);
        yes = away_from(&near, &c->w.m, d) && yes;
        times(near.slow, d, after);
        for (int i = 0; i < D_MOST; i++) {
            part += before[i] * after[i];
            whole += before[i] * before[i];
        }
        yes = yes && part > 0 && part < whole;
    }
    return yes;
}

/* Of the motions that Newton's method may find, accept a stable one; the one that the motion approaches as
 * its derivative predicts; or one that it crawls to, too slowly for the cycles that there are. */
typedef enum which_motion { STABLE, APPROACHED, CRAWLED_TO } which_motion;

/* From the present state, find a state that repeats after so many cycles, and measure it, if it is one that is
 * accepted; it misses its start by a part of tol.  Returns its period; 0 if there is none, or it cannot be
 * measured: at a limit where a contact only touches, which the motion approaches from one side, only simulation
 * shows how many events a cycle has. */
static int
shoot(finder *f, which_motion which, int n)
{
    cycles *c = &f->c;
    tangent t = { 0 };
    const motion from = c->w.m;
    motion at = from;
    int period = 0, wanted = converge(c, n, &at, &t)
        && c->multiplier <= 1 + (c->how->kind == CLOSED_FORM ? 1e-9 : 1e-5);
    if (wanted && which == APPROACHED)
        wanted = is_approached(c, &from, &at, &t, n);
    else if (wanted && which == CRAWLED_TO)
        wanted = crawls_to(c, &from, &at, &t, n);
    const double most = 2 * c->opts->tol;
    if (wanted && c->status == SS_OK) {
        ss_cycles_begin_at(c, &at);
        period = n > 1 ? ss_cycles_return(c, n, most) : 1;
    }
    if (period > 0) {
        ss_cycles_begin_at(c, &at);
        measure_cycles(f, period, period);
        period = f->missed > most || f->unresolved > 0 ? 0 : period;
    }
    if (c->status == SS_EDATA) {        /* a step has led to a state without cycles */
        c->status = SS_OK;
        period = 0;
    }
    if (period == 0)
        ss_cycles_begin_at(c, &from);
    return period;
}

/* --- settling -------------------------------------------------------------------------------- */

static void
record_section(finder *f)
{
    f->last[f->recorded++ % SECTIONS] = ss_section_of(&f->c.w.m);
}

/* The distance of the states so many cycles before the last one; INFINITY: there are not so many. */
static double
distance_before(const finder *f, int a, int b)
{
    if (f->recorded <= (unsigned long)b)
        return INFINITY;
    return ss_section_distance(&f->c, f->last[(f->recorded - 1 - (unsigned long)a) % SECTIONS],
                               f->last[(f->recorded - 1 - (unsigned long)b) % SECTIONS]);
}

/* The first period that the motion has; 0 if it has none yet.  A state within tol of its limit is within
 * 2 tol of itself after any multiple of its period.  So the search ends at a p after which the state is
 * near itself, but has not the period p: it may still come to have it. */
static int
find_period(const finder *f)
{
    const double tol = f->c.opts->tol;
    for (int p = 1; p <= f->c.opts->max_period; p++) {
        double now = distance_before(f, 0, p), before = distance_before(f, p, 2 * p), ratio = now / before;
        if (now <= ROUNDING || (now <= tol && isfinite(before) && ratio < 1 && now * ratio / (1 - ratio) <= tol))
            return p;
        if (now <= 10 * tol)
            return 0;
    }
    return 0;
}

/* Newton's method is tried when the motion is this near to a period, in units of its own size, and comes
 * nearer.  It is tried again after twice as many cycles. */
#define NEAR 0.3
enum { FIRST_TRY = 2 };
/* A motion that is still coming nearer after all cycles, and has changed by less than this in the last
 * period, crawls.  One without a period changes by about its own size. */
#define CRAWL 1e-4

/* The first period that it comes near to; 0: none. */
static int
nearest_period(const finder *f)
{
    double size = ss_section_distance(&f->c, f->last[(f->recorded - 1) % SECTIONS], (section){ 0 });
    for (int p = 1; p <= f->c.opts->max_period; p++) {
        double now = distance_before(f, 0, p), before = distance_before(f, p, 2 * p);
        if (isfinite(before) && now <= NEAR * (1 + size) && now < before)
            return p;
    }
    return 0;
}

/* Simulate until the period is known, and measure it; or if it may shoot, until the motion is near enough to a
 * period for shooting. */
static void
settle(finder *f, int may_shoot)
{
    cycles *c = &f->c;
    int period = 0, p;
    unsigned long next_try = FIRST_TRY;
    record_section(f);
    for (unsigned long i = 1; c->status == SS_OK && period == 0 && i <= c->opts->max_cycles; i++) {
        ss_cycles_go(c, 1, NULL);
        record_section(f);
        period = find_period(f);
        if (!may_shoot || i < next_try || c->status != SS_OK || (p = nearest_period(f)) == 0)
            continue;
        next_try = 2 * i;
        if (shoot(f, APPROACHED, p) > 0)
            return;
    }
    if (c->status == SS_OK && period == 0 && may_shoot && (p = nearest_period(f)) > 0
        && distance_before(f, 0, p) <= CRAWL && shoot(f, CRAWLED_TO, p) > 0)
        return;
    measure_cycles(f, period > 0 ? period : c->opts->max_period, period);
    if (period > 0)
        f->out->value[SS_CYCLES] = (double)(f->recorded - 1);
}

/* --- either ---------------------------------------------------------------------------------- */

/* Cycles simulated before Newton's first step where shooting is asked for. */
enum { APPROACH = 4 };

/* Without forcing, even differences that are small beside x change the time of the next onset so much that
 * finite differences give no derivative: only a closed form does, unless a true stick makes it 0, or the
 * differences lie in the section at which cycles begin. */
int
ss_periodic_can_shoot(const ss_scene *scene, const struct method *how)
{
    const ss_model *model = scene->model;
    return model->variation != NULL
        && (scene->base_frequency > 0 || model->still != NULL || !ss_model_has_events(model)
            || how->kind == CLOSED_FORM);
}

ss_status
ss_periodic_find(finder *f)
{
    cycles *c = &f->c;
    const ss_steady_opts *o = c->opts;
    int may_shoot = o->search != SS_SEARCH_SIMULATE && !(o->measures & 1u << SS_CYCLES)
        && ss_periodic_can_shoot(c->scene, c->how);
    c->autonomous = c->scene->base_frequency == 0;
    ss_cycles_begin(c);
    if (o->search == SS_SEARCH_SHOOT) {
        ss_cycles_go(c, APPROACH, NULL);
        if (c->status != SS_OK || shoot(f, STABLE, 1) > 0 || c->status != SS_OK)
            return c->status;
        ss_walk_end(&c->w);
        ss_cycles_begin(c);
    }
    if (c->status == SS_OK && o->settle == 0)
        settle(f, may_shoot);
    if (c->status != SS_OK || o->settle == 0)
        return c->status;
    for (unsigned long i = 0; c->status == SS_OK && i < o->settle; i++)
        ss_cycles_go(c, 1, NULL);
    const motion here = c->w.m;         /* the period is the number of cycles until it returns to this state */
    int period = ss_cycles_return(c, o->max_period, o->tol);
    if (c->status == SS_OK)
        ss_cycles_begin_at(c, &here);
    measure_cycles(f, period > 0 ? period : o->max_period, period);
    f->out->value[SS_CYCLES] = (double)o->settle;
    return c->status;
}

void
ss_periodic_free(finder *f)
{
    ss_walk_end(&f->c.w);
    free(f->course.value);
}
