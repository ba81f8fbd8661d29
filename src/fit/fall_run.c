/* fall_run.c -- the settled fall of a scene that is pulled, by simulation.
 *
 * A scene starts from rest without force.  Its first falls may differ from those that follow, so it is run
 * until they do not; then it is run again to the fall, and its force is sampled there. */
#include "fit/fall_run.h"

#include <math.h>
#include <stickslip/sim.h>
#include "scene/model.h"
#include "fit/samples.h"

#define FINE 1e-10              /* tolerance */
#define SHORT 0.1               /* of the time of loading 2 (f_s - f_k), and of a period of k/m: no stick
                                   before a fall is shorter than both, but those of a contact that rings */
enum { SETTLED = 2, SETTLED_CONTACT = 4 };      /* the fall that is settled: a contact may ring for long */
#define PATIENCE 8              /* times as long as a fall should take, for these to come */

typedef struct waiting {
    double since, least, t;     /* of the last stick's begin, NAN in slip; a stick; of the fall [s] */
    int falls, settled;         /* so far; of a settled motion */
} waiting;

static int
wait_for_fall(const ss_event *e, void *user)
{
    waiting *w = user;
    if (e->kind == SS_SLIP && e->t - w->since >= w->least && ++w->falls == w->settled) {
        w->t = e->t;
        return 1;
    }
    w->since = e->kind == SS_STICK ? e->t : NAN;
    return 0;
}

/* A run that is stopped, or fails, has an outcome; one without memory has none. */
static void
note_memory(ss_status *status, ss_status st)
{
    if (st == SS_ENOMEM)
        *status = st;
}

double
ss_fall_find(const ss_scene *scene, double *steps, ss_status *status)
{
    const double loading = fabs(scene->stiffness * pull_of(scene));
    const double half = scene->static_friction - scene->friction;
    ss_scene s = *scene;
    waiting w = { 0, SHORT * fmin(2 * half / loading, 2 * M_PI / own_frequency(scene)), NAN, 0,
                  ss_model_of(scene)->has_contact ? SETTLED_CONTACT : SETTLED };
    ss_sim_stats stats = { .steps = 0 };
    ss_sim_opts opts = ss_samples_opts(&s, FINE);
    opts.events = wait_for_fall;
    opts.user = &w;
    s.settle = 0;
    s.duration = 2 * s.static_friction / loading
                 + PATIENCE * (2 * half / loading + 2 * M_PI / own_frequency(&s));
    s.rate = 1 / s.duration;
    note_memory(status, ss_sim_run(&s, &opts, &stats, NULL));
    *steps += (double)stats.steps;
    return w.t;
}

typedef struct sampled {
    double *y, direction;
    size_t n, room;
} sampled;

static int
append_samples(const ss_sample *s, size_t n, void *user)
{
    sampled *t = user;
    for (size_t i = 0; i < n && t->n < t->room; i++)
        t->y[t->n++] = t->direction * s[i].s;
    return 0;
}

int
ss_fall_sample(double *y, const ss_scene *scene, double time, double onset, const fall *w, double rate,
               double *steps, ss_status *status)
{
    ss_scene s = *scene;
    sampled t = { y, pull_of(scene) > 0 ? 1 : -1, 0, w->n };
    ss_sim_stats stats = { .steps = 0 };
    ss_sim_opts opts = ss_samples_opts(&s, FINE);
    opts.samples = append_samples;
    opts.user = &t;
    s.settle = time - (onset - (double)w->first) / rate;
    s.rate = rate / (double)w->step;
    s.duration = (double)w->n / s.rate;
    ss_status st = s.settle >= 0 ? ss_sim_run(&s, &opts, &stats, NULL) : SS_EINVAL;
    note_memory(status, st);
    *steps += (double)stats.steps + (double)w->n / SAMPLES_A_STEP;
    return st == SS_OK && t.n == w->n;
}
