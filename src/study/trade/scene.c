/* scene.c -- the cost of accuracy on a scene, measured; and the cheapest way to an accuracy.
 *
 * A run is compared with a reference, sample by sample and event by event.  Linear models have a
 * closed form; the effect of rounding on it is measured by changing the scene's own numbers by their
 * last bit.  For the other models the reference is two methods of different order at the tightest
 * tolerance that both keep; their distance is its error.
 *
 * A run that is repeated has the same error, as nothing here is random except the time.  So an
 * accuracy that is promised holds except for the samples that were not compared and the error of the
 * reference: the margin is for these. */
#include <stickslip/trade.h>

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/error.h"
#include "base/list.h"
#include "base/progress.h"
#include "base/range.h"
#include "base/sort.h"
#include "motion/engine.h"
#include "study/trade/common.h"

/* Samples compared at most.  A prime: however many cycles the base goes through in a record, the
 * samples fall on all of its phases. */
enum { MOST = 19997 };

#define MARGIN 2                    /* a measured error times this is promised */
enum { REPEATS = 5 };               /* of short rows */
#define SHORT 0.1                   /* [s] */
#define OUTRAGEOUS 300              /* times the steps of the reference: SS_EBUDGET */

/* What each run of the reference may take, times a row's CPU time.  It is time and not steps, as the
 * user's budget is, and no byte of a measurement depends on it: a reference that exceeds it is refused,
 * never replaced by a looser one.  ss_trade_choose, whose choice must not depend on the machine, bounds
 * its runs by right-hand sides only. */
#define REFERENCE_BUDGET 100

static const double tolerance[] = { 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10,
                                    1e-11, 1e-12, 1e-13, 1e-14 };
enum { TOLERANCES = sizeof tolerance / sizeof *tolerance };

const ss_range ss_trade_accuracies = { 1e-12, 1e-3 };
const ss_trade_opts ss_trade_defaults = { .budget = 10 };

/* --- one run ------------------------------------------------------------------------------- */

/* The compared part of a scene. */
typedef struct probe {
    ss_scene scene;
    size_t n;                       /* samples compared */
    size_t stride;                  /* one of so many of the scene's */
} probe;

/* The events of a scene do not depend on its rate.  The steps of multistep methods on a model without
 * events do, so that keeps its rate and one sample in every stride is compared. */
static probe
probe_of(const ss_scene *scene)
{
    probe p = { *scene, ss_scene_samples(scene), 1 };
    if (p.n <= MOST)
        return p;
    if (!ss_model_has_events(scene->model)) {
        p.stride = p.n / MOST + 1;
        p.n /= p.stride;
    } else {
        p.n = MOST;
        p.scene.rate = MOST / scene->duration;
    }
    return p;
}

typedef struct run_result {              /* what a run gave */
    const probe *p;
    double *x, *a;
    size_t seen;                    /* samples of the scene */
    int wants_events, no_memory;
    ss_event *event;
    size_t n_events, room;
    ss_sim_stats stats;
    double seconds;                 /* of CPU time, or what it would have run_result */

    double began, budget;           /* [s] of CPU time; budget <= 0: none */
    int over;
    ss_progress progress;           /* the caller's, of the whole */
    double done, share;
} run_result;

double
ss_trade_cpu_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* x is compared as x - U t, which stays small. */
static double
pulled_by(const ss_scene *scene, double t)
{
    return scene->base_velocity * (scene->settle + t);
}

/* Of each stride of samples one, at a place that varies, so that a stride of whole periods still
 * sees all phases (Knuth's multiplicative hash). */
static int
keep_samples(const ss_sample *s, size_t n, void *user)
{
    run_result *k = user;
    for (size_t i = 0; i < n; i++, k->seen++) {
        size_t block = k->seen / k->p->stride, within = k->seen % k->p->stride;
        if (block < k->p->n && within == (uint32_t)block * UINT32_C(2654435761) % k->p->stride) {
            k->x[block] = s[i].x - pulled_by(&k->p->scene, s[i].t);
            k->a[block] = s[i].a;
        }
    }
    return 0;
}

static int
keep_event(const ss_event *e, void *user)
{
    run_result *k = user;
    ss_event *event = ss_list_room(k->event, &k->room, k->n_events, sizeof *event);
    if (event == NULL) {
        k->no_memory = 1;
        return 1;
    }
    k->event = event;
    k->event[k->n_events++] = *e;
    return 0;
}

/* Stop early a run that is sure to exceed its budget. */
static int
watch(double done, void *user)
{
    run_result *k = user;
    double spent = ss_trade_cpu_time() - k->began;
    if (k->budget > 0 && (spent > k->budget
                          || (spent > k->budget / 50 && spent > 2 * k->budget * done))) {
        k->seconds = spent / done;
        k->over = 1;
        return 1;
    }
    return ss_progress_at(&k->progress, k->done + k->share * done) != SS_OK;
}

static ss_status
run_method(run_result *k, const probe *p, const char *method, double tol, unsigned long max_steps,
           ss_error *err)
{
    const ss_sim_opts opts = { .method = method, .tol = tol, .max_steps = max_steps,
                               .samples = keep_samples, .progress = { watch, k }, .user = k,
                               .events = k->wants_events ? keep_event : NULL };
    k->p = p;
    k->seen = k->n_events = 0;
    k->over = 0;
    k->stats = (ss_sim_stats){ 0 };
    k->began = ss_trade_cpu_time();
    ss_status st = ss_sim_run(&p->scene, &opts, &k->stats, err);
    if (k->no_memory)
        return ss_fail_memory(err, NULL);
    if (st == SS_STOP && k->over)
        return SS_EBUDGET;
    k->seconds = ss_trade_cpu_time() - k->began;
    return st;
}

static ss_status
run_result_init(run_result *k, const probe *p)
{
    k->x = malloc((p->n + 1) * sizeof *k->x);
    k->a = malloc((p->n + 1) * sizeof *k->a);
    return k->x != NULL && k->a != NULL ? SS_OK : SS_ENOMEM;
}

static void
run_result_free(run_result *k)
{
    free(k->x);
    free(k->a);
    free(k->event);
}

/* --- comparison ---------------------------------------------------------------------------- */

static double
largest(const double *x, size_t n)
{
    double max = 0;
    for (size_t i = 0; i < n; i++)
        max = fmax(max, fabs(x[i]));
    return max > 0 ? max : 1;               /* nothing moves: errors are absolute */
}

static double
error_x(const run_result *k, const run_result *ref)
{
    double worst = 0;
    for (size_t i = 0; i < ref->p->n; i++)
        worst = fmax(worst, fabs(k->x[i] - ref->x[i]));
    return worst / largest(ref->x, ref->p->n);
}

/* The event of k nearest to e that is of the same kind and direction, or SIZE_MAX.  *from, where to
 * look, goes on with e. */
static size_t
nearest(const run_result *k, const ss_event *e, size_t *from)
{
    size_t best = SIZE_MAX;
    while (*from < k->n_events && k->event[*from].t < e->t)
        ++*from;
    for (int after = 0; after <= 1; after++)
        for (size_t i = *from; after ? i < k->n_events : i > 0; i += after ? 1 : (size_t)-1) {
            const ss_event *other = &k->event[after ? i : i - 1];
            if (other->kind != e->kind || other->direction != e->direction)
                continue;
            if (best == SIZE_MAX || fabs(other->t - e->t) < fabs(k->event[best].t - e->t))
                best = (size_t)(other - k->event);
            break;
        }
    return best;
}

/* Events that are each other's nearest are the same.  own[i] becomes the error of the reference's
 * i-th, 0 if it was missed. */
static void
compare_events(ss_trade_row *row, const run_result *k, const run_result *ref, double *own)
{
    size_t from = 0, from_back = 0, matched = 0;
    row->error_t = 0;
    for (size_t i = 0; i < ref->n_events; i++) {
        const ss_event *e = &ref->event[i];
        size_t j = nearest(k, e, &from);
        from_back = i;
        int mutual = j != SIZE_MAX;
        if (mutual) {
            while (from_back > 0 && ref->event[from_back - 1].t >= k->event[j].t)
                from_back--;
            mutual = nearest(ref, &k->event[j], &from_back) == i;
        }
        own[i] = mutual ? fabs(k->event[j].t - e->t) : 0;
        row->error_t = fmax(row->error_t, own[i]);
        matched += (size_t)mutual;
    }
    row->missed = ref->n_events - matched;
    row->invented = k->n_events - matched;
}

/* Near an event the acceleration may be that of its other side. */
static int
is_beside(const ss_event *e, double own, double t)
{
    return fabs(t - e->t) <= own + 8 * DBL_EPSILON * fabs(t);
}

static double
error_a(const run_result *k, const run_result *ref, const double *own)
{
    double worst = 0;
    for (size_t i = 0, e = 0; i < ref->p->n; i++) {
        double t = (double)i / ref->p->scene.rate;
        while (e < ref->n_events && ref->event[e].t <= t)
            e++;
        if ((e > 0 && is_beside(&ref->event[e - 1], own[e - 1], t))
            || (e < ref->n_events && is_beside(&ref->event[e], own[e], t)))
            continue;
        worst = fmax(worst, fabs(k->a[i] - ref->a[i]));
    }
    return worst / largest(ref->a, ref->p->n);
}

static ss_status
compare(ss_trade_row *row, const run_result *k, const run_result *ref)
{
    double *own = malloc((ref->n_events + 1) * sizeof *own);
    if (own == NULL)
        return SS_ENOMEM;
    compare_events(row, k, ref, own);
    row->error_x = error_x(k, ref);
    row->error_a = error_a(k, ref, own);
    free(own);
    return SS_OK;
}

/* --- the reference ------------------------------------------------------------------------- */

/* The scene with its oscillators' frequencies moved by the least that a double allows. */
static probe
nudged(const probe *p)
{
    probe q = *p;
    q.scene.mass = nextafter(q.scene.mass, INFINITY);
    q.scene.stiffness = nextafter(q.scene.stiffness, 0);
    q.scene.contact_stiffness = nextafter(q.scene.contact_stiffness, 0);
    return q;
}

/* Run the reference into ref, and the run that shows its error into other; text names it. */
static ss_status
run_reference(run_result *ref, run_result *other, const probe *p, unsigned long max_steps,
              char text[64], ss_error *err)
{
    if (ss_model_is_linear(p->scene.model)) {
        const probe beside = nudged(p);
        ss_status st = run_method(ref, p, EXACT, 1e-14, max_steps, err);
        snprintf(text, 64, EXACT);
        if (st == SS_OK)
            st = run_method(other, &beside, EXACT, 1e-14, max_steps, err);
        other->p = p;
        return st;
    }
    const char *first = ss_sim_method_for(&p->scene);   /* and one whose work is of the same kind */
    const char *second = strcmp(first, "rk8pd") == 0 ? "rkck" : "msbdf";
    ss_status st = SS_ETOL;
    for (int i = TOLERANCES - 1; st == SS_ETOL && i >= 0 && tolerance[i] <= 1e-10; i--) {
        st = run_method(ref, p, first, tolerance[i], max_steps, err);
        if (st == SS_OK)
            st = run_method(other, p, second, tolerance[i], max_steps, err);
        snprintf(text, 64, "%s and %s at tol %g", first, second, tolerance[i]);
    }
    return st;
}

/* The error of the reference from the distance of the two runs: of a nudge twice that; at least
 * rounding. */
static double
known(const probe *p, double distance)
{
    return fmax(ss_model_is_linear(p->scene.model) ? 2 * distance : distance, 16 * DBL_EPSILON);
}

/* --- the table ----------------------------------------------------------------------------- */

typedef struct measurement {
    ss_trade *trade;
    const ss_trade_opts *opts;
    probe p;
    run_result ref, run;
} measurement;

static int
keeps(const ss_trade_row *row, double accuracy)
{
    return row->status == SS_OK && row->missed == 0 && row->invented == 0
        && MARGIN * row->error_x <= accuracy;
}

const ss_trade_row *
ss_trade_cheapest(const ss_trade *trade, double accuracy)
{
    if (trade == NULL)
        return NULL;
    const ss_trade_row *best = NULL;
    for (size_t i = 0; i < trade->n; i++)
        if (keeps(&trade->row[i], accuracy)
            && (best == NULL || trade->row[i].seconds < best->seconds))
            best = &trade->row[i];
    return best;
}

/* The rows to measure: exact once, the others at each tolerance; none is measured yet. */
static ss_status
make_rows(ss_trade *trade, const ss_scene *scene)
{
    size_t methods = 0;
    while (ss_sim_method_name(methods) != NULL)
        methods++;
    trade->row = calloc(methods * TOLERANCES, sizeof *trade->row);
    if (trade->row == NULL)
        return SS_ENOMEM;
    for (size_t m = 0; m < methods; m++) {
        const char *method = ss_sim_method_name(m);
        int exact = strcmp(method, EXACT) == 0;
        if (exact && !ss_model_is_linear(scene->model))
            continue;
        for (int i = 1; i < TOLERANCES - 1; i++) {
            trade->row[trade->n++] = (ss_trade_row){ .method = method, .status = SS_STOP,
                                                     .tol = exact ? 0 : tolerance[i] };
            if (exact)
                break;
        }
    }
    return SS_OK;
}

static ss_status
run_row(measurement *t, const ss_trade_row *row, ss_error *err)
{
    return run_method(&t->run, &t->p, row->method, row->tol > 0 ? row->tol : 1e-12, 0, err);
}

static ss_status
measure_row(measurement *t, ss_trade_row *row)
{
    const ss_trade_row *best = t->opts->target > 0 ? ss_trade_cheapest(t->trade, t->opts->target)
        : NULL;
    t->run.budget = t->opts->budget;
    if (best != NULL)
        t->run.budget = fmin(t->run.budget, 2 * best->seconds);
    row->status = run_row(t, row, NULL);
    row->seconds = t->run.seconds;
    row->steps = t->run.stats.steps;
    row->rhs = t->run.stats.rhs;
    if (row->status == SS_STOP || row->status == SS_ENOMEM)
        return row->status;
    if (row->status != SS_OK)
        return SS_OK;
    ss_status st = compare(row, &t->run, &t->ref);
    row->error_x = fmax(row->error_x, t->trade->known_x);
    row->error_a = fmax(row->error_a, t->trade->known_a);
    row->error_t = fmax(row->error_t, t->trade->known_t);
    return st;
}

/* In turns, so that a disturbance of the machine affects all rows alike; the medians count. */
ss_status
ss_trade_repeat(ss_trade *trade, ss_trade_again *again, void *user)
{
    double (*seconds)[REPEATS] = calloc(trade->n, sizeof *seconds);
    ss_status st = seconds != NULL ? SS_OK : SS_ENOMEM;
    for (int k = 0; st == SS_OK && k < REPEATS; k++)
        for (size_t i = 0; st == SS_OK && i < trade->n; i++) {
            const ss_trade_row *row = &trade->row[i];
            double done = 0.7 + 0.3 * ((double)k + (double)i / (double)trade->n) / REPEATS;
            if (row->status == SS_OK && row->seconds <= SHORT)
                st = again(user, row, done, &seconds[i][k]);
        }
    for (size_t i = 0; st == SS_OK && i < trade->n; i++)
        if (trade->row[i].status == SS_OK && trade->row[i].seconds <= SHORT) {
            qsort(seconds[i], REPEATS, sizeof *seconds[i], ss_ascending);
            trade->row[i].seconds = seconds[i][REPEATS / 2];
        }
    free(seconds);
    return st;
}

static ss_status
run_again(void *user, const ss_trade_row *row, double done, double *seconds)
{
    measurement *t = user;
    t->run.budget = 0;
    t->run.done = done;
    ss_status st = run_row(t, row, NULL);
    *seconds = t->run.seconds;
    return st;
}

void
ss_trade_mark_frontier(ss_trade *trade)
{
    for (size_t i = 0; i < trade->n; i++) {
        ss_trade_row *row = &trade->row[i];
        row->frontier = row->status == SS_OK;
        for (size_t k = 0; k < trade->n; k++) {
            const ss_trade_row *other = &trade->row[k];
            if (other->status == SS_OK && other->seconds <= row->seconds
                && other->error_x <= row->error_x
                && (other->seconds < row->seconds || other->error_x < row->error_x))
                row->frontier = 0;
        }
    }
}

static ss_status
measure_rows(measurement *t, ss_error *err)
{
    ss_trade *trade = t->trade;
    ss_trade_row between = { .method = EXACT };
    ss_status st = run_result_init(&t->ref, &t->p);
    if (st == SS_OK)
        st = run_result_init(&t->run, &t->p);
    if (st == SS_OK)
        st = make_rows(trade, &t->p.scene);
    t->ref.budget = t->run.budget = REFERENCE_BUDGET * t->opts->budget;
    if (st == SS_OK)
        st = run_reference(&t->ref, &t->run, &t->p, 0, trade->reference, err);
    if (st == SS_EBUDGET && (t->ref.over || t->run.over))
        return ss_fail(err, st, "the run of reference would take about %.2g s: a row's budget of %g s "
                       "allows it %g s", t->ref.over ? t->ref.seconds : t->run.seconds,
                       t->opts->budget, t->ref.budget);
    if (st == SS_OK)
        st = compare(&between, &t->run, &t->ref);
    trade->known_x = known(&t->p, between.error_x);
    trade->known_a = known(&t->p, between.error_a);
    trade->known_t = 2 * between.error_t;
    trade->events = t->ref.n_events;
    trade->samples = t->p.n;
    for (size_t i = 0; st == SS_OK && i < trade->n; i++) {
        t->run.done = 0.7 * (double)i / (double)trade->n;
        t->run.share = 0.7 / (double)trade->n;
        st = measure_row(t, &trade->row[i]);
    }
    t->run.share = 0;
    if (st == SS_OK)
        st = ss_trade_repeat(trade, run_again, t);
    if (st == SS_OK)
        ss_trade_mark_frontier(trade);
    return st;
}

ss_status
ss_trade_measure(ss_trade **out, const ss_scene *scene, const ss_trade_opts *opts, ss_error *err)
{
    if (out == NULL || scene == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_record_check(scene, err);
    if (st != SS_OK)
        return st;
    if (opts == NULL)
        opts = &ss_trade_defaults;
    if (!(opts->budget > 0))
        return ss_fail(err, SS_EINVAL, "a budget is more than 0 s");
    run_result empty = { .wants_events = 1, .progress = opts->progress };
    measurement t = { calloc(1, sizeof *t.trade), opts, probe_of(scene), empty, empty };
    st = t.trade != NULL ? measure_rows(&t, err) : SS_ENOMEM;
    run_result_free(&t.ref);
    run_result_free(&t.run);
    if (st == SS_OK) {
        *out = t.trade;
        return SS_OK;
    }
    ss_trade_free(t.trade);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

void
ss_trade_free(ss_trade *trade)
{
    if (trade == NULL)
        return;
    free(trade->row);
    free(trade);
}

/* --- the reverse --------------------------------------------------------------------------- */

/* What a right-hand side costs with all that goes with it, in those of rk8pd, and how many a step,
 * or a sample within one, needs: measured with ss-trade on the state-variable scene, for the order
 * of the methods only. */
static const struct cost { const char *method; double rhs; unsigned a_step; int at_samples; }
cost[] = {
    { "rk8pd", 1, 13, 1 }, { "rkf45", 1.1, 6, 1 }, { "rkck", 1.1, 6, 1 }, { "rk4", 1, 11, 1 },
    { "rk2", 1.2, 3, 1 }, { "rk1imp", 3.5, 9, 1 }, { "rk2imp", 3.5, 9, 1 },
    { "rk4imp", 3.3, 17, 1 }, { "bsimp", 3, 50, 1 }, { "msadams", 4.6, 3, 0 },
    { "msbdf", 6.4, 3, 0 },
};
enum { COSTS = sizeof cost / sizeof *cost };

typedef struct choice {
    probe p;
    run_result ref, run;
    double known, accuracy;
    unsigned long user_steps;       /* of opts */
    double tol, reached;            /* of the last method, SS_OK; the least error seen */
} choice;

/* The loosest tolerance at which the method keeps the accuracy. */
static ss_status
loosest(choice *s, const char *method, unsigned long max_steps, ss_error *err)
{
    ss_status st = SS_ETOL;
    s->reached = INFINITY;
    for (int i = 0; i < TOLERANCES; i++) {
        if (tolerance[i] > 1.001e3 * s->accuracy)
            continue;
        st = run_method(&s->run, &s->p, method, tolerance[i], max_steps, err);
        if (st != SS_OK)
            return st;
        double error = fmax(error_x(&s->run, &s->ref), s->known);
        s->reached = fmin(s->reached, error);
        s->tol = tolerance[i];
        if (MARGIN * error <= s->accuracy && s->run.stats.events == s->ref.stats.events)
            return SS_OK;
    }
    return SS_ETOL;
}

static ss_status
choose_given(choice *s, const char *method, ss_error *err)
{
    double most = OUTRAGEOUS * (double)(s->ref.stats.steps + 1);
    if (s->user_steps > 0)
        most = fmin(most, (double)s->user_steps);
    ss_status st = loosest(s, method, (unsigned long)most, err);
    if (st == SS_EBUDGET && isfinite(s->reached))
        return ss_fail(err, st, "%s needs more than %.0f steps for an accuracy of %g; with fewer x "
                       "was %.2g of its maximum off", method, most, s->accuracy, s->reached);
    if (st == SS_ETOL && isfinite(s->reached))
        return ss_fail(err, st, "%s keeps no accuracy of %g: x was %.2g of its maximum off at best",
                       method, s->accuracy, s->reached);
    return st;
}

/* Without a closed form: a method is stopped when it has done the work of the best.  Each sample
 * costs the one-step methods a step of its own. */
static ss_status
choose_cheapest(choice *s, ss_sim_opts *opts, ss_error *err)
{
    double least = INFINITY;
    for (size_t i = 0; i < COSTS; i++) {
        double most = least / cost[i].rhs / cost[i].a_step;
        if (cost[i].at_samples)
            most -= (double)ss_scene_samples(&s->p.scene);
        most = fmin(most, OUTRAGEOUS * (double)(s->ref.stats.steps + 1));
        if (s->user_steps > 0)
            most = fmin(most, (double)s->user_steps);
        if (!(most >= 1))
            continue;
        ss_status st = loosest(s, cost[i].method, (unsigned long)most, err);
        double work = cost[i].rhs * (double)s->run.stats.rhs;
        if (st == SS_OK && work < least) {
            least = work;
            opts->method = cost[i].method;
            opts->tol = s->tol;
        } else if (st == SS_STOP || st == SS_ENOMEM) {
            return st;
        }
    }
    if (isfinite(least))
        return SS_OK;
    return ss_fail(err, SS_ETOL, "no method keeps an accuracy of %g in this scene", s->accuracy);
}

static ss_status
choose(choice *s, ss_sim_opts *opts, ss_error *err)
{
    char reference[64];
    int is_linear = ss_model_is_linear(s->p.scene.model);
    ss_status st = run_result_init(&s->ref, &s->p);
    if (st == SS_OK)
        st = run_result_init(&s->run, &s->p);
    if (st == SS_OK)
        st = run_reference(&s->ref, &s->run, &s->p, s->user_steps, reference, err);
    if (st != SS_OK)
        return st;
    s->known = known(&s->p, error_x(&s->run, &s->ref));
    if (s->run.stats.events != s->ref.stats.events)
        return ss_fail(err, SS_ETOL, "no accuracy can be kept: rounding alone makes %lu events or "
                       "%lu", s->ref.stats.events, s->run.stats.events);
    if (MARGIN * s->known > s->accuracy)
        return ss_fail(err, SS_ETOL, is_linear
                       ? "an accuracy of %g cannot be kept: by %s, rounding alone moves x by %.2g "
                       "of its maximum"
                       : "an accuracy of %g cannot be told: %s differ by %.2g of max|x|", s->accuracy, reference, s->known);
    if (opts->method == NULL && !is_linear)
        return choose_cheapest(s, opts, err);
    if (opts->method == NULL)
        opts->method = EXACT;
    if (strcmp(opts->method, EXACT) == 0) {
        opts->tol = ss_sim_defaults.tol;
        return SS_OK;
    }
    st = choose_given(s, opts->method, err);
    opts->tol = s->tol;
    return st;
}

ss_status
ss_trade_choose(ss_sim_opts *opts, const ss_scene *scene, double accuracy, ss_error *err)
{
    if (opts == NULL || scene == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_record_check(scene, err);
    if (st != SS_OK)
        return st;
    if ((st = ss_range_check(accuracy, ss_trade_accuracies, "accuracy", err)) != SS_OK)
        return st;
    if (opts->method != NULL && strcmp(opts->method, EXACT) == 0)
        st = ss_exact_check(ss_model_of(scene), err);
    if (st != SS_OK)
        return st;
    const run_result empty = { .progress = opts->progress };
    choice s = { .p = probe_of(scene), .ref = empty, .run = empty, .accuracy = accuracy,
                 .user_steps = opts->max_steps };
    st = choose(&s, opts, err);
    run_result_free(&s.ref);
    run_result_free(&s.run);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}
