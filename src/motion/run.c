/* run.c -- carry a motion from event to event and send its samples and events to the sinks.
 *
 * The steps do not depend on the samples.  An engine chooses its steps, up to a cap by the mode's
 * fastest period, and samples are interpolated inside its steps.  So the events are the same, to
 * the last digit, at every rate.  (Only multistep methods on a model without events step to the
 * samples.) */
#include <stickslip/sim.h>

#include <stdint.h>
#include <string.h>
#include "base/error.h"
#include "base/number.h"
#include "base/options.h"
#include "base/progress.h"
#include "motion/method.h"
#include "motion/walk.h"

const ss_range ss_sim_tolerances = { 1e-14, 0.1 };
static const ss_sim_opts usual = { .size = sizeof usual, .method = NULL, .tol = 1e-12 };

SS_OPTIONS(ss_sim_opts, usual)

ss_status
ss_sim_opts_take(ss_sim_opts *own, const ss_sim_opts *given, ss_error *err)
{
    return ss_options_take(own, sizeof *own, &usual, given, err);
}

enum { REPORT_STEPS = 256 };            /* from one report of progress to the next */

typedef struct sampler {
    const ss_scene *scene;
    const ss_sim_opts *opts;
    instant end;                        /* of the record, from the start of settling */
    size_t n, i;                        /* all samples, 0 if no one wants any; the next sample */
    double interval;                    /* between samples */
    double work;                        /* the right-hand sides allowed if there is no max_steps */
    turn base, base_further;            /* the base's phase at sample i - 1, its change in an interval */
    size_t filled;
    ss_sample *buffer;                  /* room for BUFFERED samples */
} sampler;

enum { BUFFERED = 256 };

/* The phases of base and motion are turned further from sample to sample, and computed anew at each
 * sample whose number is a multiple of RENEWAL: the error is at most 16 times 3 eps / 2 of their size. */
enum { RENEWAL = 16 };

static ss_status
flush(sampler *r)
{
    size_t filled = r->filled;
    r->filled = 0;
    if (filled > 0 && r->opts->samples(r->buffer, filled, r->opts->user) != 0)
        return SS_STOP;
    return SS_OK;
}

/* Report that t seconds of settling and record are done. */
static ss_status
report(const sampler *r, double t)
{
    double all = r->scene->settle + r->scene->duration;
    return ss_progress_at(&r->opts->progress, fmin(t / all, 1));
}

static instant
instant_of_sample(const sampler *r, size_t i)
{
    return instant_add(instant_sample((double)i, r->scene->rate), r->scene->settle);
}

/* The time from now to the i-th sample of the record. */
static double
until_sample(const sampler *r, const motion *m, size_t i)
{
    return instant_diff(instant_of_sample(r, i), m->origin) - m->now.u;
}

/* Fill in the next sample, which is s from now. */
static void
fill_sample(ss_sample *sample, sampler *r, const walk *w, double s)
{
    const motion *m = &w->m;
    double q[MAX_DIM], dqdt[MAX_DIM] = { 0 };
    int renew = r->i % RENEWAL == 0;
    r->base = renew ? ss_motion_base(m, instant_of_sample(r, r->i))
        : turn_further(r->base, r->base_further);
    if (w->still)
        memcpy(q, m->now.q, sizeof q);
    else
        w->e->type->at(w->e, renew ? FIRST_SAMPLE : NEXT_SAMPLE, s > 0 ? s : 0, r->base, q, dqdt);
    motion_sample(m, r->base, m->now.u + s, q, dqdt, sample);
    sample->t = (double)r->i / r->scene->rate;
}

/* SS_ERANGE unless all numbers of the sample are finite.  They are if their sum is. */
static ss_status
check_sample(const sampler *r, const ss_sample *s, ss_error *err)
{
    static const char name[] = "xvafsyz";
    const double value[] = { s->x, s->v, s->a, s->f, s->s, s->y, s->z };
    int i = 0;
    if (isfinite(s->x + s->v + s->a + s->f + s->s + s->y + s->z))
        return SS_OK;
    while (name[i] != '\0' && isfinite(value[i]))
        i++;
    if (name[i] == '\0')
        return SS_OK;
    return ss_fail(err, SS_ERANGE, "%c is not finite at t = %.9g s after %.9g s of settling: numbers "
                   "of this scene lie beyond double precision", name[i], s->t, r->scene->settle);
}

/* Write all samples of a leg. */
static ss_status
write_samples(sampler *r, const walk *w, ss_error *err)
{
    ss_status st = SS_OK;
    if (r->i == r->n)
        return SS_OK;
    double first = until_sample(r, &w->m, r->i), s = first;
    for (double n = 1; r->i < r->n && s < w->h; r->i++, s = first + n++ * r->interval) {
        if (r->filled == BUFFERED) {
            st = flush(r);
            if (st == SS_OK)
                st = report(r, instant_of_sample(r, r->i).hi);
            if (st != SS_OK)
                return st;
        }
        ss_sample *sample = &r->buffer[r->filled++];
        fill_sample(sample, r, w, s);
        st = check_sample(r, sample, err);
        if (st != SS_OK)
            return st;
    }
    return SS_OK;
}

static ss_status
write_event(sampler *r, const motion *m, ss_event *e)
{
    instant t = instant_add(m->origin, m->now.u);
    e->t = (t.hi - r->scene->settle) + t.lo;
    e->x = ss_motion_x(m);
    e->v = m->now.q[1] + r->scene->surface_velocity;
    if (!(e->t >= 0 && instant_diff(t, r->end) < 0) || r->opts->events == NULL)
        return SS_OK;
    ss_status st = flush(r);
    if (st == SS_OK && r->opts->events(e, r->opts->user) != 0)
        st = SS_STOP;
    return st;
}

/* --- from event to event ------------------------------------------------------------------- */

/* No machine takes so many steps in useful time: a scene that needs more is refused at once. */
#define TOO_MANY_STEPS 1e12

/* The limit of a run without max_steps is counted in right-hand sides, which cost about the same in every
 * method; steps do not.  It is a constant, plus a number for each sample and each second of settling and
 * record, and at most an hour on a machine of today.  Ordinary scenes take 10 a sample. */
#define WORK_ALWAYS 5e6
#define WORK_SAMPLE 1e4
#define WORK_SECOND 1e6
#define WORK_MOST 1e11

/* SS_EBUDGET, with the reason why the run was too long and an estimate of the steps that it needs. */
static ss_status
over_budget(const sampler *r, const engine *e, double cap, ss_error *err)
{
    const motion *m = e->m;
    const char *what;
    char budget[80];
    double t = m->origin.hi + m->now.u, all = r->scene->settle + r->scene->duration;
    double estimate = fmin((double)e->steps * all / t, TOO_MANY_STEPS);
    const char *about = estimate < TOO_MANY_STEPS ? "about" : "more than";
    m->now.model->fastest(&m->now, &what);
    if (r->opts->max_steps > 0)
        snprintf(budget, sizeof budget, "step budget of %lu", r->opts->max_steps);
    else
        ss_print_to(budget, sizeof budget, "budget of %.2g right-hand sides (max_steps would set another)",
                    r->work);
    if (e->h < cap / 2)
        return ss_fail(err, SS_EBUDGET, "%s used up at t = %.9g s of %.9g s, %s "
                       "%.2g steps would do; the tolerance forces steps of %.3g s, where the "
                       "motion of %s allows %.3g s", budget, t, all, about, estimate, e->h, what, cap);
    return ss_fail(err, SS_EBUDGET, "%s used up at t = %.9g s of %.9g s, %s %.2g "
                   "steps would do; they are %.3g s long, 1/%d of the period of %s",
                   budget, t, all, about, estimate, cap, STEPS_PER_PERIOD, what);
}

/* Refuse at once a run that will certainly be too long: if the steps of its first mode are more than any
 * budget allows, or if those of slip, the slowest mode, are more than this budget allows. */
static ss_status
check_length(const sampler *r, const state *m, int exact, ss_error *err)
{
    const char *what;
    const ss_scene *s = r->scene;
    double length = s->settle + s->duration, end, steps = length / ss_step_cap(m);
    double own = fmax(own_frequency(s), m->omega), slow = fmin(own, m->model->fastest(m, NULL));
    double least = length * STEPS_PER_PERIOD * slow / (2 * M_PI), most = r->work * (exact ? 10 : 1);
    if (m->model->still != NULL && m->model->still(m, &end))
        return SS_OK;
    m->model->fastest(m, &what);
    if (!(steps <= TOO_MANY_STEPS))
        return ss_fail(err, SS_EBUDGET, "%.3g s are too many steps of 1/%d of the period of %s: more than "
                       "%.0g are not tried", length, STEPS_PER_PERIOD, what, TOO_MANY_STEPS);
    if (r->opts->max_steps > 0 || least <= most)
        return SS_OK;
    return ss_fail(err, SS_EBUDGET, "%.3g s are at least %.3g steps of 1/%d of the period of %s: more "
                   "than %.3g are done only if max_steps asks for them", length, least, STEPS_PER_PERIOD,
                   slow < own ? what : m->omega >= slow ? "the base" : "the spring", most);
}

/* Walk leg by leg, at most up to the next knot of a measured base. */
static ss_status
run(sampler *r, walk *w, ss_error *err)
{
    const motion *m = &w->m;
    const state *now = &m->now;
    const engine *e = w->e;
    for (;;) {
        ss_event event;
        int is_event, steps = now->mode != 0 || now->model->still == NULL;
        double longest = r->scene->base != NULL ? now->u_knot - now->u : INFINITY;
        if (steps && (r->opts->max_steps > 0 ? e->steps >= r->opts->max_steps : (double)e->rhs >= r->work))
            return over_budget(r, e, fmin(w->cap, longest), err);
        if (steps && e->lands_on_samples && r->i < r->n) {
            double s = until_sample(r, m, r->i);
            longest = fmin(longest, s > 0 ? s : until_sample(r, m, r->i + 1));
        }
        ss_status st = ss_walk_leg(w, longest, err);
        if (st == SS_OK && steps && e->steps % REPORT_STEPS == 0)
            st = report(r, m->origin.hi + now->u);
        if (st == SS_OK)
            st = write_samples(r, w, err);
        if (st != SS_OK)
            return st;
        if (instant_diff(r->end, m->origin) - now->u <= w->h)
            return flush(r);
        st = ss_walk_on(w, &is_event, &event, err);
        ss_status written = is_event ? write_event(r, m, &event) : SS_OK;
        if (st != SS_OK || written != SS_OK)
            return st != SS_OK ? st : written;
    }
}

ss_status
ss_record_check(const ss_scene *scene, ss_error *err)
{
    ss_status st = ss_scene_check(scene, err);
    if (st == SS_OK && ss_scene_samples(scene) == SIZE_MAX)
        return ss_fail(err, SS_EINVAL, "duration x rate is more than 2^53 samples");
    if (st == SS_OK && scene->base == NULL && *scene->base_file != '\0')
        return ss_fail(err, SS_EINVAL, "%s: the measured base has not been read", scene->base_file);
    if (st == SS_OK && scene->base != NULL)
        return ss_base_covers(scene->base, scene->settle + scene->duration, scene->base_file, err);
    return st;
}

ss_status
ss_sim_run(const ss_scene *scene, const ss_sim_opts *given, ss_sim_stats *stats, ss_error *err)
{
    if (scene == NULL)
        return SS_FAIL_NULL(err);
    ss_sim_opts own;
    const ss_sim_opts *opts = &own;
    ss_status st = ss_sim_opts_take(&own, given, err);
    if (st == SS_OK)
        st = ss_record_check(scene, err);
    if (st == SS_OK)
        st = ss_range_check(opts->tol, ss_sim_tolerances, "tolerance", err);
    if (st != SS_OK)
        return st;
    ss_sample buffer[BUFFERED];
    const double length = scene->settle + scene->duration;
    sampler r = { .scene = scene, .opts = opts, .buffer = buffer,
                 .n = opts->samples != NULL ? ss_scene_samples(scene) : 0,
                 .end = instant_sum(scene->settle, scene->duration),
                 .interval = 1 / scene->rate,
                 .work = fmin(WORK_ALWAYS + length * (WORK_SAMPLE * scene->rate + WORK_SECOND), WORK_MOST),
                 .base_further = turn_of(2 * M_PI * instant_cycles(instant_sample(1, scene->rate),
                                                                   scene->base_frequency)) };
    walk w;
    st = ss_walk_begin(&w, scene, opts, err);
    w.by_steps = 1;
    if (st == SS_OK)
        st = check_length(&r, &w.m.now, w.how->kind == CLOSED_FORM, err);
    if (st == SS_OK && w.slips) {       /* a start in slip is an event at t = 0 */
        ss_event event = { .kind = SS_SLIP, .direction = w.m.now.mode };
        w.e->events++;
        st = write_event(&r, &w.m, &event);
    }
    if (st == SS_OK)
        st = run(&r, &w, err);
    unsigned long unresolved = ss_motion_unresolved(&w.m);
    if (stats != NULL && w.e != NULL)
        *stats = (ss_sim_stats){ w.e->steps, w.e->rhs, w.e->events,
                                 unresolved > 0 ? unresolved : (unsigned long)ss_motion_fades(&w.m) };
    ss_walk_end(&w);
    return st;
}
