/* runs.c -- simulate a scene with one method and compare it with the reference.
 *
 * A run is compared sample by sample and event by event.  The reference is two methods of
 * different kinds, at the tightest tolerance that both keep; their distance is its error.  If
 * there is a closed form, it is one of the two.  The other simulates a mass that is larger by its
 * last bit, because two methods that round alike may agree on digits that the scene does not
 * determine. */
#include "base/number.h"
#include "study/trade/trade.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>
#include "base/error.h"
#include "base/list.h"
#include "base/progress.h"
#include "study/curve.h"

/* At most so many samples are compared.  It is a prime, so that samples fall on all phases of the base
 * whatever number of its cycles the record has. */
enum { MOST = 19997 };

const double ss_trade_tolerance[TOLERANCES] = { 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9,
                                                1e-10, 1e-11, 1e-12, 1e-13, 1e-14 };

/* --- one run ------------------------------------------------------------------------------- */

/* Events do not depend on the rate of a scene, so a model with events gets another rate.  A model without
 * events keeps its rate, since the steps of multistep methods depend on it, and one sample in every stride
 * is compared. */
probe
ss_trade_probe(const ss_scene *scene)
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

double
ss_trade_cpu_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Keep one sample of each stride, at a place that varies (Knuth's multiplicative hash), so that all phases
 * are seen even if a stride is a whole number of periods. */
static int
keep_samples(const ss_sample *s, size_t n, void *user)
{
    run *k = user;
    const ss_scene *scene = &k->p->scene;
    for (size_t i = 0; i < n; i++, k->seen++) {
        size_t block = k->seen / k->p->stride, within = k->seen % k->p->stride;
        if (block < k->p->n && within == (uint32_t)block * UINT32_C(2654435761) % k->p->stride) {
            k->x[block] = s[i].x - scene->base_velocity * (scene->settle + s[i].t);  /* it stays small */
            k->a[block] = s[i].a;
        }
    }
    return 0;
}

static int
keep_event(const ss_event *e, void *user)
{
    run *k = user;
    ss_event *event = ss_list_room(k->event, &k->room, k->n_events, sizeof *event);
    if (event == NULL) {
        k->no_memory = 1;
        return 1;
    }
    k->event = event;
    k->event[k->n_events++] = *e;
    return 0;
}

/* Stop a run as soon as it is certain to exceed its budget. */
static int
watch(double done, void *user)
{
    run *k = user;
    double spent = ss_trade_cpu_time() - k->began;
    if (k->budget > 0 && (spent > k->budget
                          || (spent > k->budget / 50 && spent > 2 * k->budget * done))) {
        k->seconds = spent / done;
        k->over = 1;
        return 1;
    }
    return ss_progress_at(&k->progress, k->done + k->share * done) != SS_OK;
}

ss_status
ss_trade_run(run *k, const probe *p, const char *method, double tol, unsigned long max_steps,
           ss_error *err)
{
    const ss_sim_opts opts = { .size = sizeof(ss_sim_opts), .method = method, .tol = tol, .max_steps = max_steps,
                               .samples = keep_samples, .progress = { watch, k }, .user = k,
                               .events = k->wants_events ? keep_event : NULL };
    if (k->x == NULL)
        k->x = malloc((p->n + 1) * sizeof *k->x);
    if (k->a == NULL)
        k->a = malloc((p->n + 1) * sizeof *k->a);
    if (k->x == NULL || k->a == NULL)
        return ss_fail_memory(err, NULL);
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

void
ss_trade_run_free(run *k)
{
    free(k->x);
    free(k->a);
    free(k->event);
}

/* --- comparison ---------------------------------------------------------------------------- */

static double
largest(const double *x, size_t n)
{
    double max = curve_largest(x, n);
    return max > 0 ? max : 1;               /* nothing moves: errors are absolute */
}

double
ss_trade_error_x(const run *k, const run *ref)
{
    double worst = 0;
    for (size_t i = 0; i < ref->p->n; i++)
        worst = fmax(worst, fabs(k->x[i] - ref->x[i]));
    return worst / largest(ref->x, ref->p->n);
}

/* The event of k nearest to e with the same kind and direction, or NULL. */
static const ss_event *
nearest(const run *k, const ss_event *e)
{
    const ss_event *best = NULL, *end = k->event + k->n_events;
    const ss_event *from = k->event + ss_list_from(k->event, k->n_events, sizeof *from, e->t), *after = from;
    while (after < end && (after->kind != e->kind || after->direction != e->direction))
        after++;
    while (from > k->event && best == NULL)
        if ((--from)->kind == e->kind && from->direction == e->direction)
            best = from;
    return after < end && (best == NULL || after->t - e->t < e->t - best->t) ? after : best;
}

/* Compare the events of two runs.  Two events that are each other's nearest are the same event.  own[i]
 * becomes the error in time of event i of the reference, 0 if it was missed. */
static void
compare_events(ss_trade_row *row, const run *k, const run *ref, double *own)
{
    size_t matched = 0;
    row->error_t = 0;
    for (size_t i = 0; i < ref->n_events; i++) {
        const ss_event *e = &ref->event[i], *same = nearest(k, e);
        int mutual = same != NULL && nearest(ref, same) == e;
        own[i] = mutual ? fabs(same->t - e->t) : 0;
        row->error_t = fmax(row->error_t, own[i]);
        matched += (size_t)mutual;
    }
    row->missed = ref->n_events - matched;
    row->invented = k->n_events - matched;
}

/* 1 if t is so near to an event that the acceleration may be that of the event's other side. */
static int
is_beside(const ss_event *e, double own, double t)
{
    return fabs(t - e->t) <= own + 8 * DBL_EPSILON * fabs(t);
}

static double
error_a(const run *k, const run *ref, const double *own)
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

ss_status
ss_trade_compare(ss_trade_row *row, const run *k, const run *ref)
{
    double *own = malloc((ref->n_events + 1) * sizeof *own);
    if (own == NULL)
        return SS_ENOMEM;
    compare_events(row, k, ref, own);
    row->error_x = ss_trade_error_x(k, ref);
    row->error_a = error_a(k, ref, own);
    free(own);
    return SS_OK;
}

/* --- the reference ------------------------------------------------------------------------- */

ss_status
ss_trade_refer(run *ref, run *other, const probe *p, const char *method[2], unsigned long max_steps,
               char text[64], ss_error *err)
{
    probe nudged = *p;
    nudged.scene.mass *= 1 + DBL_EPSILON;
    ss_status st = SS_ETOL;
    for (int i = TOLERANCES - 1; st == SS_ETOL && i >= 0 && ss_trade_tolerance[i] <= 1e-10; i--) {
        st = ss_trade_run(ref, p, method[0], ss_trade_tolerance[i], max_steps, err);
        if (st == SS_OK)
            st = ss_trade_run(other, &nudged, method[1], ss_trade_tolerance[i], max_steps, err);
        ss_print_to(text, 64, "%s and %s at tol %g", method[0], method[1], ss_trade_tolerance[i]);
    }
    other->p = p;
    return st;
}

double
ss_trade_known(double distance)
{
    return fmax(distance, 16 * DBL_EPSILON);
}
