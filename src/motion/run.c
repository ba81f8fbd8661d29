/* run.c -- a motion from event to event, its samples and events fed to the sinks.
 *
 * The steps know nothing of the samples: an engine steps freely, capped by the mode's own fastest
 * period, and samples are read off inside its steps.  So the events are the same, to the last digit,
 * whatever the rate.  (Only multistep methods on the state variable, which has no events, land on
 * the samples.) */
#include <stickslip/sim.h>

#include <float.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/progress.h"
#include "motion/engine.h"
#include "motion/event.h"

/* Steps a period of the mode's fastest motion.  At 40, the terms that rk8pd drops are below
 * (2 pi / 40)^9 / 9! = 2e-13 of a step's change, and a guard has at most one extremum a step. */
enum { STEPS_PER_PERIOD = 40 };

double
ss_step_cap(const state *m)
{
    return 2 * M_PI / (STEPS_PER_PERIOD * m->model->fastest(m, NULL));
}

/* Chatter: so many events in a row, each within so small a part of the fastest period of the last,
 * are the rounding of one grazing contact and no motion. */
enum { CHATTER_EVENTS = 1000 };
#define CHATTER_PART 1e-6

enum { REPORT_STEPS = 256 };            /* from one report of progress to the next */

const ss_sim_opts ss_sim_defaults = { .method = NULL, .tol = 1e-12 };

const char *
ss_sim_method_name(size_t i)
{
    return i == 0 ? EXACT : ss_ode_method_name(i - 1);
}

const char *
ss_event_kind_name(ss_event_kind kind)
{
    static const char *const name[] = { "stick", "slip", "reverse" };
    return (unsigned)kind <= SS_REVERSE ? name[kind] : "?";
}

const char *
ss_sim_method_for(const ss_scene *scene)
{
    const struct model *model = scene != NULL ? ss_model_of(scene) : NULL;
    if (model == NULL)
        return NULL;
    return model->stiff != NULL && model->stiff(scene) ? "bsimp" : "rk8pd";
}

/* --- the motion ---------------------------------------------------------------------------- */

/* Let u count from the instant of the present step, with the phase there. */
void
ss_motion_rebase(motion *m)
{
    state *now = &m->now;
    m->origin = instant_add(m->origin, now->u);
    now->u = 0;
    now->theta = 2 * M_PI * instant_cycles(m->origin, now->scene->base_frequency) + m->phase;
}

/* What the closed form rounds off of x: an ulp for each of its four terms. */
#define EXACT_DOUBT (4 * DBL_EPSILON)

motion
ss_motion_of(const ss_scene *scene, int exact, double tol)
{
    motion m = { .now = ss_state_of(scene, tol) };
    m.phase = m.now.theta;
    m.doubt = m.now.x_scale * (exact ? EXACT_DOUBT : tol);
    return m;
}

/* Enter the first mode; 1 if it starts in slip. */
int
ss_motion_start(motion *m)
{
    int slips = m->now.model->start(&m->now);
    m->x_begin = m->now.x_ref + m->now.q[0];
    return slips;
}

unsigned long
ss_motion_unresolved(const motion *m)
{
    return m->unresolved + m->now.touches;
}

/* The phase of the base at t. */
static turn
base_at(const motion *m, instant t)
{
    return turn_of(2 * M_PI * instant_cycles(t, m->now.scene->base_frequency) + m->phase);
}

/* --- the record ---------------------------------------------------------------------------- */

typedef struct record {
    const ss_scene *scene;
    const ss_sim_opts *opts;
    instant end;                        /* of the record, from the start of settling */
    size_t n, i;                        /* samples in all (that anyone wants), next sample */
    double interval;                    /* between samples */
    double work;                        /* right-hand sides allowed where there is no max_steps */
    turn base, base_further;            /* its phase at sample i - 1, and by how much it goes on */
    size_t filled;
    ss_sample buffer[256];
} record;

/* Base and motion are carried from sample to sample by turning further, and taken up anew at each of
 * which the number divides by this: the error is at most 16 times 3 eps / 2 of their size. */
enum { RENEWAL = 16 };

static ss_status
flush(record *r)
{
    size_t filled = r->filled;
    r->filled = 0;
    if (filled > 0 && r->opts->samples(r->buffer, filled, r->opts->user) != 0)
        return SS_STOP;
    return SS_OK;
}

/* What the phase of the base gains in one interval. */
static turn
base_turns(const ss_scene *scene)
{
    return turn_of(2 * M_PI * instant_cycles(instant_sample(1, scene->rate), scene->base_frequency));
}

/* t seconds of settling and record are done. */
static ss_status
report(const record *r, double t)
{
    const ss_sim_opts *o = r->opts;
    double all = r->scene->settle + r->scene->duration;
    return ss_progress_at(&o->progress, fmin(t / all, 1));
}

static instant
instant_of_sample(const record *r, size_t i)
{
    return instant_add(instant_sample((double)i, r->scene->rate), r->scene->settle);
}

/* The time from now to the i-th sample of the record. */
static double
until_sample(const record *r, const motion *m, size_t i)
{
    return instant_diff(instant_of_sample(r, i), m->origin) - m->now.u;
}

/* The i-th sample, s from now. */
static void
fill_sample(ss_sample *sample, record *r, engine *e, int still, double s)
{
    const motion *m = e->m;
    double q[MAX_DIM], dqdt[MAX_DIM] = { 0 };
    int renew = r->i % RENEWAL == 0;
    r->base = renew ? base_at(m, instant_of_sample(r, r->i))
        : turn_further(r->base, r->base_further);
    if (still)
        memcpy(q, m->now.q, sizeof q);
    else
        e->type->at(e, renew ? FIRST_SAMPLE : NEXT_SAMPLE, fmax(s, 0), r->base, q, dqdt);
    m->now.model->sample(&m->now, m->now.drive * r->base.co, q, dqdt, sample);
    sample->t = (double)r->i / r->scene->rate;
    sample->z = r->scene->base_amplitude * r->base.co;
}

static ss_status
fail_sample(const record *r, const ss_sample *s, ss_error *err)
{
    static const char name[] = "xvafyz";
    const double value[] = { s->x, s->v, s->a, s->f, s->y, s->z };
    int i = 0;
    while (isfinite(value[i]))
        i++;
    return ss_fail(err, SS_ERANGE, "%c is not finite at t = %.9g s after %.9g s of settling: numbers "
                   "of this scene lie beyond double precision", name[i], s->t, r->scene->settle);
}

/* 0 times a number is 0 if the number is finite, else NaN. */
static int
is_finite(const ss_sample *s)
{
    return 0 * s->x + 0 * s->v + 0 * s->a + 0 * s->f + 0 * s->y + 0 * s->z == 0;
}

/* All samples up to, not including, h from now. */
static ss_status
write_samples(record *r, engine *e, int still, double h, ss_error *err)
{
    ss_status st = SS_OK;
    if (r->i == r->n)
        return SS_OK;
    double first = until_sample(r, e->m, r->i), s = first;
    for (size_t n = 1; r->i < r->n && s < h; r->i++, s = first + (double)n++ * r->interval) {
        if (r->filled == sizeof r->buffer / sizeof *r->buffer) {
            st = flush(r);
            if (st == SS_OK)
                st = report(r, instant_of_sample(r, r->i).hi);
            if (st != SS_OK)
                return st;
        }
        ss_sample *sample = &r->buffer[r->filled++];
        fill_sample(sample, r, e, still, s);
        if (!is_finite(sample))
            return fail_sample(r, sample, err);
    }
    return SS_OK;
}

static ss_status
write_event(record *r, const motion *m, ss_event *e)
{
    instant t = instant_add(m->origin, m->now.u);
    e->t = (t.hi - r->scene->settle) + t.lo;
    e->x = m->now.x_ref + m->now.q[0];
    e->v = m->now.q[1];
    if (!(e->t >= 0 && instant_diff(t, r->end) < 0) || r->opts->events == NULL)
        return SS_OK;
    ss_status st = flush(r);
    if (st == SS_OK && r->opts->events(e, r->opts->user) != 0)
        st = SS_STOP;
    return st;
}

/* --- from event to event ------------------------------------------------------------------- */

static guard_value
guard_at(double s, void *user)
{
    engine *e = user;
    const state *m = &e->m->now;
    double q[MAX_DIM], dqdt[MAX_DIM];
    guard_value at;
    e->type->at(e, ANYWHERE, s, base_turn(m, m->u + s), q, dqdt);
    at.g = m->model->guard(m, q, dqdt, &at.slope);
    e->lost |= isnan(at.g);
    return at;
}

static ss_status
fail_lost(const engine *e, ss_error *err)
{
    return ss_fail(err, SS_ERANGE, "the state or its rate of change is not finite at t = %.9g s: "
                   "numbers of this scene lie beyond double precision",
                   e->m->origin.hi + e->m->now.u + e->h);
}

ss_status
ss_engine_ends_within(engine *e, int *ends, double *s_event, ss_error *err)
{
    const state *m = &e->m->now;
    guard_value at_0, at_h;
    *ends = 0;
    if (m->model->guard == NULL)
        return SS_OK;
    at_0.g = m->model->guard(m, m->q, e->dq0, &at_0.slope);
    at_h.g = m->model->guard(m, e->q1, e->dq1, &at_h.slope);
    *ends = ss_event_find(guard_at, e, e->h, at_0, at_h, s_event);
    return e->lost ? fail_lost(e, err) : SS_OK;
}

/* The mode has ended s from now: enter the next one.  1 if that is an event. */
int
ss_engine_next_mode(engine *e, int still, double s, ss_event *event)
{
    motion *m = e->m;
    state *now = &m->now;
    if (!still) {
        double q[MAX_DIM], dqdt[MAX_DIM];
        e->type->at(e, ANYWHERE, s, base_turn(now, now->u + s), q, dqdt);
        memcpy(now->q, q, sizeof q);
    }
    now->u += s;
    ss_motion_rebase(m);
    if (now->mode != 0 && fabs(now->x_ref + now->q[0] - m->x_begin) <= m->doubt)
        m->unresolved++;
    if (!now->model->next(now, event))
        return 0;
    m->x_begin = now->x_ref + now->q[0];
    e->events++;
    return 1;
}

static ss_status
change_mode(record *r, engine *e, int still, double s)
{
    ss_event event;
    ss_status st = SS_OK;
    if (ss_engine_next_mode(e, still, s, &event))
        st = write_event(r, e->m, &event);
    return st == SS_OK ? e->type->begin(e) : st;
}

/* A step, unless it leads to what is not finite: then a rate of change is not, since each part of
 * the state is in one (and those that a model does not have are 0). */
ss_status
ss_engine_step(engine *e, double h_max, ss_error *err)
{
    ss_status st = e->type->step(e, h_max, err);
    if (st != SS_OK || 0 * e->dq1[0] + 0 * e->dq1[1] + 0 * e->dq1[2] == 0)
        return st;
    return fail_lost(e, err);
}

/* The step is done with, and no event was in it. */
void
ss_engine_accept(engine *e)
{
    state *m = &e->m->now;
    memcpy(m->q, e->q1, sizeof m->q);
    memcpy(e->dq0, e->dq1, sizeof e->dq0);
    m->u += e->h;
    e->type->go_on(e);
}

ss_status
ss_motion_chatters(const motion *m, double lasted, int *in_a_row, ss_error *err)
{
    double period = 2 * M_PI / m->now.model->fastest(&m->now, NULL);
    *in_a_row = lasted > CHATTER_PART * period ? 0 : *in_a_row + 1;
    if (*in_a_row <= CHATTER_EVENTS)
        return SS_OK;
    return ss_fail(err, SS_ECHATTER, "more than %d events in a row at t = %.9g s, each within "
                   "%.2g s of the last: the contact grazes its limit", CHATTER_EVENTS,
                   m->origin.hi, CHATTER_PART * period);
}

/* More steps than any machine takes: a scene that would need them is refused, not run for ever. */
#define TOO_MANY_STEPS 1e12

/* What a run without max_steps may cost in right-hand sides, which unlike steps cost about the same in
 * every method: so many, so many more a sample and a second of settling and record, and at most an
 * hour of a machine of today.  Ordinary scenes take 10 a sample. */
#define WORK_ALWAYS 5e6
#define WORK_SAMPLE 1e4
#define WORK_SECOND 1e6
#define WORK_MOST 1e11

static double
work_allowed(const ss_scene *scene)
{
    double length = scene->settle + scene->duration;
    return fmin(WORK_ALWAYS + length * (WORK_SAMPLE * scene->rate + WORK_SECOND), WORK_MOST);
}

static int
has_budget(const record *r, const engine *e)
{
    return r->opts->max_steps > 0 ? e->steps < r->opts->max_steps : (double)e->rhs < r->work;
}

/* Why a run was too long for its budget, and how long it would have been. */
static ss_status
over_budget(const record *r, const engine *e, double cap, ss_error *err)
{
    const motion *m = e->m;
    const char *what;
    char budget[80];
    double t = m->origin.hi + m->now.u, all = r->scene->settle + r->scene->duration;
    double estimate = (double)e->steps * all / t;
    m->now.model->fastest(&m->now, &what);
    if (r->opts->max_steps > 0)
        snprintf(budget, sizeof budget, "step budget of %lu", r->opts->max_steps);
    else
        snprintf(budget, sizeof budget, "budget of %.2g right-hand sides (max_steps would set another)",
                 r->work);
    if (e->h < cap / 2)
        return ss_fail(err, SS_EBUDGET, "%s used up at t = %.9g s of %.9g s, about "
                       "%.2g steps would do; the tolerance forces steps of %.3g s, where the "
                       "motion of %s allows %.3g s", budget, t, all, estimate, e->h, what, cap);
    return ss_fail(err, SS_EBUDGET, "%s used up at t = %.9g s of %.9g s, about %.2g "
                   "steps would do; they are %.3g s long, 1/%d of the period of %s",
                   budget, t, all, estimate, cap, STEPS_PER_PERIOD, what);
}

/* Refuse at once what is sure to be too long: by the mode that the scene begins in, where no budget
 * would do; by its slip, the slower mode, where the budget would not. */
static ss_status
check_length(const record *r, const state *m, int exact, ss_error *err)
{
    const char *what;
    const ss_scene *s = r->scene;
    double length = s->settle + s->duration, end, steps = length / ss_step_cap(m);
    double slow = fmax(sqrt(s->stiffness / s->mass), m->omega);
    double least = length * STEPS_PER_PERIOD * slow / (2 * M_PI), most = r->work * (exact ? 10 : 1);
    if (m->model->still != NULL && m->model->still(m, &end))
        return SS_OK;
    m->model->fastest(m, &what);
    if (!(steps <= TOO_MANY_STEPS))
        return ss_fail(err, SS_EBUDGET, "%.3g s are %.2g steps of 1/%d of the period of %s: more than "
                       "%.0g are not tried", length, steps, STEPS_PER_PERIOD, what,
                       TOO_MANY_STEPS);
    if (r->opts->max_steps > 0 || least <= most)
        return SS_OK;
    return ss_fail(err, SS_EBUDGET, "%.3g s are at least %.3g steps of 1/%d of the period of %s: more "
                   "than %.3g are done only if max_steps asks for them", length, least, STEPS_PER_PERIOD,
                   m->omega >= slow ? "the base" : "the spring", most);
}

static ss_status
run(record *r, engine *e, ss_error *err)
{
    motion *m = e->m;
    const state *now = &m->now;
    const struct model *model = now->model;
    double lasted = 0;                      /* of the present mode */
    int in_a_row = 0;

    for (;;) {
        double h, cap = ss_step_cap(now);
        int still = model->still != NULL && model->still(now, &h), ends = still && isfinite(h);
        ss_status st = SS_OK;
        if (still) {
            h -= now->u;
        } else {
            if (!has_budget(r, e))
                return over_budget(r, e, cap, err);
            if (e->lands_on_samples && r->i < r->n) {
                double s = until_sample(r, m, r->i);
                cap = fmin(cap, s > 0 ? s : until_sample(r, m, r->i + 1));
            }
            if (model->sight != NULL)
                cap = fmin(cap, model->sight(now, e->dq0));
            st = ss_engine_step(e, cap, err);
            if (st == SS_OK && e->steps % REPORT_STEPS == 0)
                st = report(r, m->origin.hi + now->u);
            if (st != SS_OK)
                return st;
            h = e->h;
            st = ss_engine_ends_within(e, &ends, &h, err);
            if (st != SS_OK)
                return st;
        }
        st = write_samples(r, e, still, h, err);
        if (st != SS_OK)
            return st;
        if (instant_diff(r->end, m->origin) - now->u <= h)
            return flush(r);
        lasted += h;
        if (ends) {
            st = change_mode(r, e, still, h);
            if (st == SS_OK)
                st = ss_motion_chatters(m, lasted, &in_a_row, err);
            if (st != SS_OK)
                return st;
            lasted = 0;
        } else {
            ss_engine_accept(e);
        }
    }
}

/* A start in slip is an event at t = 0. */
static ss_status
begin(record *r, engine *e, int slips)
{
    ss_event event = { .kind = SS_SLIP, .direction = e->m->now.mode };
    ss_status st = SS_OK;
    if (slips) {
        e->events++;
        st = write_event(r, e->m, &event);
    }
    return st == SS_OK ? e->type->begin(e) : st;
}

ss_status
ss_record_check(const ss_scene *scene, ss_error *err)
{
    ss_status st = ss_scene_check(scene, err);
    if (st == SS_OK && ss_scene_samples(scene) == SIZE_MAX)
        return ss_fail(err, SS_EINVAL, "duration x rate is more than 2^53 samples");
    return st;
}

ss_status
ss_sim_run(const ss_scene *scene, const ss_sim_opts *opts, ss_sim_stats *stats, ss_error *err)
{
    if (scene == NULL || opts == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_record_check(scene, err);
    if (st != SS_OK)
        return st;
    record r = { .scene = scene, .opts = opts,
                 .n = opts->samples != NULL ? ss_scene_samples(scene) : 0,
                 .end = instant_sum(scene->settle, scene->duration),
                 .interval = 1 / scene->rate, .work = work_allowed(scene),
                 .base_further = base_turns(scene) };
    const char *method = opts->method != NULL ? opts->method : ss_sim_method_for(scene);
    int exact = strcmp(method, EXACT) == 0;
    motion m = ss_motion_of(scene, exact, opts->tol);
    engine *e = NULL;

    if (!(opts->tol >= 1e-14 && opts->tol <= 1e-1))
        return ss_fail(err, SS_EINVAL, "tolerance %g is out of range 1e-14 ... 0.1", opts->tol);
    int slips = ss_motion_start(&m);
    st = check_length(&r, &m.now, exact, err);
    if (st != SS_OK)
        return st;
    st = exact ? ss_exact_new(&e, &m, err) : ss_ode_new(&e, &m, method, opts->tol, err);
    if (st == SS_OK)
        st = begin(&r, e, slips);
    if (st == SS_OK)
        st = run(&r, e, err);
    if (stats != NULL && e != NULL)
        *stats = (ss_sim_stats){ e->steps, e->rhs, e->events, ss_motion_unresolved(&m) };
    if (e != NULL)
        e->type->free(e);
    return st;
}

/* --- as a signal --------------------------------------------------------------------------- */

static const struct { const char *name, *unit; } column[SS_SIM_COLUMNS] = {
    { "x", "m" }, { "v", "m/s" }, { "a", "m/s^2" }, { "f", "N" }, { "y", "m" }, { "z", "m" },
    { "mode", "" }
};

ss_status
ss_sim_columns_parse(ss_sim_columns *out, const char *list, ss_error *err)
{
    if (out == NULL || list == NULL)
        return SS_FAIL_NULL(err);
    ss_sim_columns columns = { 0 };
    for (const char *name = list;; name++) {
        size_t length = strcspn(name, ",");
        int c = 0, repeated = 0;
        if (length == 1 && *name == 't' && name == list) {
            columns.has_time = 1;
        } else {
            while (c < SS_SIM_COLUMNS && (strlen(column[c].name) != length
                                          || strncmp(name, column[c].name, length) != 0))
                c++;
            for (size_t i = 0; i < columns.n; i++)
                repeated |= columns.pick[i] == c;
            if (c == SS_SIM_COLUMNS || repeated)
                return ss_fail(err, SS_EINVAL, repeated ? "'%.*s' is there twice in '%s'"
                               : "'%.*s' in '%s' is none of t (which comes first), x, v, a, f, y, z, "
                               "mode", (int)length, name, list);
            columns.pick[columns.n++] = c;
        }
        name += length;
        if (*name == '\0')
            break;
    }
    if (columns.n == 0)
        return ss_fail(err, SS_EINVAL, "a signal needs a column besides t");
    *out = columns;
    return SS_OK;
}

void
ss_sim_row(const ss_sim_columns *columns, const ss_sample *s, double *row)
{
    if (columns == NULL || s == NULL || row == NULL)
        return;
    const double value[SS_SIM_COLUMNS] = { s->x, s->v, s->a, s->f, s->y, s->z, s->mode };
    for (size_t i = 0; i < columns->n; i++)
        row[i] = value[columns->pick[i]] + 0.0;         /* no -0 */
}

/* The scene's own text as notes, but for the rate, which every header has. */
static ss_status
note_scene(ss_header *head, const ss_scene *scene)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL)
        return SS_ENOMEM;
    ss_status st = ss_scene_write(scene, out);
    if (fclose(out) != 0)
        st = SS_ENOMEM;
    for (char *line = text; st == SS_OK && *line != '\0';) {
        char *equals = strstr(line, " = "), *end = strchr(line, '\n');
        *equals = *end = '\0';
        if (strcmp(line, "rate") != 0)
            st = ss_header_note(head, line, equals + 3);
        line = end + 1;
    }
    free(text);
    return st;
}

ss_header *
ss_sim_header(const ss_scene *scene, const ss_sim_columns *columns)
{
    if (scene == NULL || columns == NULL)
        return NULL;
    ss_header *head = ss_header_new(scene->rate, 0);
    if (head == NULL)
        return NULL;
    head->has_time = columns->has_time;
    ss_status st = note_scene(head, scene);
    for (size_t i = 0; st == SS_OK && i < columns->n; i++)
        st = ss_header_add_column(head, column[columns->pick[i]].name,
                                  column[columns->pick[i]].unit);
    if (st == SS_OK)
        return head;
    ss_header_free(head);
    return NULL;
}

struct collector {
    const ss_sim_columns *columns;
    ss_signal *signal;
    size_t i;
};

static int
collect(const ss_sample *s, size_t n, void *user)
{
    struct collector *c = user;
    double row[SS_SIM_COLUMNS];
    for (size_t k = 0; k < n; k++, c->i++) {
        ss_sim_row(c->columns, &s[k], row);
        for (size_t j = 0; j < c->columns->n; j++)
            c->signal->values[j * c->signal->n + c->i] = row[j];
    }
    return 0;
}

ss_status
ss_sim_signal(ss_signal **out, const ss_scene *scene, ss_error *err)
{
    if (out == NULL)
        return SS_FAIL_NULL(err);
    const ss_sim_columns columns = { 1, 4, { 0, 1, 2, 3 } };
    ss_status st = ss_scene_check(scene, err);
    if (st != SS_OK)
        return st;
    struct collector c = { &columns, NULL, 0 };
    ss_header *head = ss_sim_header(scene, &columns);
    st = head != NULL ? ss_signal_new(&c.signal, head, ss_scene_samples(scene)) : SS_ENOMEM;
    ss_header_free(head);
    if (st != SS_OK)
        return ss_fail(err, st, "%s", ss_strerror(st));
    ss_sim_opts opts = ss_sim_defaults;
    opts.samples = collect;
    opts.user = &c;
    st = ss_sim_run(scene, &opts, NULL, err);
    if (st == SS_OK)
        *out = c.signal;
    else
        ss_signal_free(c.signal);
    return st;
}
