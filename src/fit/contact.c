/* contact.c -- find the only compliant scene that moves as a signal does.
 *
 * The settled cycle of the scene is fitted to the mean cycle of the signal (forced.c), in a
 * wide range about the contact's stiffness and damping that the transitions show, or those of the
 * scene.  From the best results of this search, the motion is fitted to the record (forced_fit.c).
 *
 * The sum of squares has many minima: a motion with one micro-slip more or less is another motion.
 * So there are several starts.  The lowest minimum is the answer only if its residual is no more
 * than noise, and if no other minimum that is as low within the effect of noise has other
 * parameters. */
#include <stickslip/rank.h>

#include <math.h>
#include <stdlib.h>
#include <stickslip/sim.h>
#include "base/error.h"
#include "base/number.h"
#include "find/judgement.h"
#include "fit/forced.h"
#include "scene/model.h"
#include "signal/gaps.h"

enum { POINTS = 192, KEEP = 4 };        /* of the search */
enum { CYCLES = 32, MOST = 65536 };     /* cycles and samples that are fitted at most */
#define BUDGET 1e8                      /* integration steps of a fit: less than a minute */
#define FAR 10.0                        /* factor of the range that is searched */
#define SHORT 0.25                      /* periods of the contact: shorter sticks show no stiffness */

typedef struct fitting {
    rank_record all, record;            /* the column, and the part of it that is fitted */
    cycle goal;
    forced scene;                       /* all keys are free but k, which is known */
    forced_fit best;
    double rival;                       /* residual of the best of other parameters; infinite: none */
} fitting;

/* The numbers that are adjusted.  Each is the product of so many unknowns of a fit. */
static const struct {
    const char *name;
    size_t n, unknown[2];
} fitted[SS_FIT_KEYS] = {
    { "friction", 2, { FORCED_RATIO, FORCED_SIZE } }, { "base_amplitude", 1, { FORCED_SIZE } },
    { "base_frequency", 1, { FORCED_FREQUENCY } }, { "contact_stiffness", 1, { FORCED_OWN } },
    { "contact_damping", 1, { FORCED_OWN + 1 } } };

/* The scene from rest, settled and in step with the whole record; its numbers; and what it leaves of the record
 * without their offset. */
static ss_status
report(ss_fit *fit, const fitting *w)
{
    const residue *of = &w->best.of_samples;
    ss_scene s = w->best.scene;
    s.phase = remainder(s.phase + 2 * M_PI * s.base_frequency * (s.settle - w->record.from), 2 * M_PI);
    s.x0 = s.v0 = 0;
    s.settle = FORCED_SETTLE / s.base_frequency;
    s.duration = (double)w->all.n / w->all.rate;
    fit->scene = s;
    for (size_t i = 0; i < SS_FIT_KEYS; i++) {
        const double value = ss_scene_get(&fit->scene, fitted[i].name);
        double variance = 0;            /* of its logarithm */
        for (size_t j = 0; j < fitted[i].n; j++)
            for (size_t k = 0; k < fitted[i].n; k++)
                variance += w->best.covariance[fitted[i].unknown[j]][fitted[i].unknown[k]];
        fit->key[i].found = (ss_value){ value, value * sqrt(of->left * variance) };
    }
    fit->residual_started = sqrt(of->left / of->power);
    fit->noise = sqrt(fmin(w->record.noise, of->white) / of->power);
    double *y = malloc((w->all.n + 1) * sizeof *y), steps = 0;
    if (y == NULL)
        return SS_ENOMEM;
    rank_record left = w->all;
    left.x = y;
    ss_status st = ss_samples_run(&fit->scene, w->scene.pick, SAMPLES_FINE, y, NULL, left.n, &steps);
    for (size_t i = 0; st == SS_OK && i < left.n; i++)
        y[i] -= w->all.x[i];
    if (st == SS_OK)
        fit->residual = sqrt(ss_record_power(&left) / ss_record_power(&w->all));
    free(y);
    return st == SS_ENOMEM ? st : SS_OK;
}

/* --- the verdict --------------------------------------------------------------------------- */

typedef struct sticks {
    double since, longest;              /* begin of the present stick, NaN in slip; the longest stick [s] */
} sticks;

static int
time_stick(const ss_event *e, void *user)
{
    sticks *s = user;
    if (e->kind != SS_STICK && e->t - s->since > s->longest)
        s->longest = e->t - s->since;
    s->since = e->kind == SS_STICK ? e->t : NAN;
    return 0;
}

/* Say which term the signal contradicts most: then the other numbers are wrong, too. */
static ss_status
judge_held(ss_fit *fit, const fitting *w)
{
    forced_held of[HELD_TERMS];
    forced_term most = 0;
    ss_status st = ss_forced_gains(of, &w->scene, &w->best, &w->record);
    if (st != SS_OK)
        return st;
    for (forced_term term = 1; term < HELD_TERMS; term++)
        most = of[term].gain > of[most].gain ? term : most;
    if (!(of[most].gain > SIGMAS * SIGMAS))   /* a lag puts numbers off by more than it can be seen itself */
        return SS_OK;
    if (most == HELD_DAMPING)
        ss_print_to(fit->why, sizeof fit->why, "the scene's damping is not that of the rig, which may be %.3g",
                    of[most].nearer);
    else if (most == HELD_STATIC)
        ss_print_to(fit->why, sizeof fit->why, "the scene's static_friction is not that of the rig, which may "
                    "be %.4g times friction", of[most].nearer);
    else
        snprintf(fit->why, sizeof fit->why, "the sensor seems to lag behind the motion: its bandwidth is "
                 "too low to tell the contact");
    return SS_OK;
}

static ss_status
judge(ss_fit *fit, const fitting *w)
{
    const residue *of = &w->best.of_samples;
    const ss_scene *scene = &w->best.scene;
    ss_fitted vague = { .name = NULL };         /* the first that stands at an end of its range, or is not known */
    sticks found = { NAN, 0 };
    ss_sim_opts opts = ss_samples_opts(scene, SAMPLES_FINE);
    opts.events = time_stick;
    opts.user = &found;
    ss_status st = ss_sim_run(scene, &opts, NULL, NULL);
    if (st == SS_ENOMEM)
        return st;
    st = SS_OK;
    const double stiffness = scene->stiffness + ss_scene_get(scene, "contact_stiffness");
    const double periods = found.longest * sqrt(stiffness / scene->mass) / (2 * M_PI);
    for (size_t i = 0; i < SS_FIT_KEYS && vague.name == NULL; i++) {
        const size_t k = fitted[i].unknown[0];
        ss_fitted key = fit->key[i];
        if (k < FORCED_KEYS && !(w->best.u[k] > w->scene.range[k].from && w->best.u[k] < w->scene.range[k].to))
            key.found.error = INFINITY;
        if (!(SIGMAS * key.found.error <= key.found.value))
            vague = key;
    }
    if (of->compared == 0)
        snprintf(fit->why, sizeof fit->why, "the motion nearest to it does not slip");
    else if (!ss_residue_explains(of, w->record.noise))
        ss_print_to(fit->why, sizeof fit->why, "the best compliant scene leaves %.3g %% of the signal, "
                    "%.3g times the noise", 100 * fit->residual_started,
                    sqrt(ss_residue_excess(of, w->record.noise)));
    else if ((w->rival - of->left) * of->compared < RESIDUE_DECISIVE * of->left)
        ss_print_to(fit->why, sizeof fit->why, "scenes with other parameters leave as little of the "
                    "signal, %.3g %%", 100 * fit->residual_started);
    else if (periods < SHORT)
        ss_print_to(fit->why, sizeof fit->why, "the longest stick lasts %.2g periods of the contact's "
                    "oscillation: less than %g shows no stiffness", periods, SHORT);
    else if (vague.name != NULL && isinf(vague.found.error))
        ss_print_to(fit->why, sizeof fit->why, "%s = %.3g is at an end of the range searched", vague.name,
                    vague.found.value);
    else if (vague.name != NULL)
        ss_print_to(fit->why, sizeof fit->why, "%s = %.3g +- %.2g: the signal does not tell it", vague.name,
                    vague.found.value, vague.found.error);
    else
        st = judge_held(fit, w);
    fit->conclusive = fit->why[0] == '\0';
    return st;
}

static ss_status
fit_signal(ss_fit *fit, fitting *w, const ss_signal *signal, size_t column, const ss_rank_opts *opts,
           ss_error *err)
{
    ss_scene scene = fit->scene;
    forced *c = &w->scene;
    /* the contact starts from the stiffness and damping that the transitions show, if they do */
    ss_features *f = NULL;
    ss_features_opts how;
    ss_features_opts_init(&how, sizeof how);
    how.mass = scene.mass;
    how.stiffness = scene.stiffness;
    ss_status st = ss_features_find(&f, signal, column, &how, err);
    if (st == SS_OK && f->number[SS_CONTACT_STIFFNESS].value > 0)
        ss_scene_set(&scene, "contact_stiffness", f->number[SS_CONTACT_STIFFNESS].value, NULL);
    if (st == SS_OK && f->number[SS_CONTACT_DAMPING].value > 0)
        ss_scene_set(&scene, "contact_damping", f->number[SS_CONTACT_DAMPING].value, NULL);
    ss_features_free(f);
    *c = ss_forced_of(&scene, (int)opts->quantity, FAR);
    c->period = w->goal.period;
    c->budget = BUDGET;
    c->range[FORCED_STIFFNESS] = (ss_range){ c->own[FORCED_STIFFNESS], c->own[FORCED_STIFFNESS] };
    c->range[FORCED_RATIO].from = log(LITTLE);          /* below it sticks are too short to fit */
    c->range[FORCED_RATIO].to = scene.friction > 0
        ? log(scene.friction / fmax(scene.static_friction, scene.friction)) : 0;
    /* A long record is fitted from half a cycle on.  A fitted motion starts in a slip before its record, but the
     * record itself may start from rest. */
    const rank_record *all = &w->all;
    const double samples = w->goal.period * all->rate;
    const size_t first = (double)all->n > 2.5 * samples ? (size_t)(samples / 2) : 0;
    w->record = (rank_record){ .x = all->x + first, .rate = all->rate, .from = (double)first / all->rate,
                               .n = (size_t)fmin(fmin((double)(all->n - first), CYCLES * samples), MOST),
                               .missing = all->missing != NULL ? all->missing + first : NULL };
    if (st == SS_OK)
        st = ss_record_noise(&w->record, samples);
    c->progress = (ss_stretch){ opts->progress, 0, 1 };
    if (st == SS_OK)
        st = ss_forced_fit(&w->best, &w->rival, c, &w->goal, POINTS, KEEP, &w->record);
    if (st == SS_OK && c->steps > BUDGET)
        return ss_fail(err, SS_EBUDGET, "its fits take more than %.0e integration steps: the contact is "
                       "too stiff, or too many samples stand in a cycle", BUDGET);
    if (st == SS_OK)
        st = report(fit, w);
    return st == SS_OK ? judge(fit, w) : st;
}

ss_status
ss_scene_fit(ss_fit *fit, const ss_signal *signal, size_t column, const ss_scene *start,
             const ss_rank_opts *given, ss_error *err)
{
    ss_rank_opts own;
    const ss_rank_opts *opts = &own;
    if (fit == NULL || signal == NULL || start == NULL)
        return SS_FAIL_NULL(err);
    if (start->model == NULL || !start->model->has_contact)
        return ss_fail(err, SS_EINVAL, "only compliant scenes are fitted, not %s", ss_model_name(start->model));
    ss_status st = ss_rank_opts_take(&own, given, err);
    if (st == SS_OK)
        st = ss_column_check(signal, column, opts, err);
    if (st == SS_OK)
        st = ss_column_check_unit(signal, column, opts->quantity, err);
    if (st == SS_OK)
        st = ss_forced_check(start, err);
    if (st != SS_OK)
        return st;
    char *missing = NULL;
    fitting *w = malloc(sizeof *w);
    *fit = (ss_fit){ .scene = *start, .residual = NAN, .residual_started = NAN, .noise = NAN };
    for (size_t i = 0; i < SS_FIT_KEYS; i++) {
        ss_fitted *k = &fit->key[i];
        *k = (ss_fitted){ .name = fitted[i].name, .found = { NAN, NAN } };
        k->given = ss_scene_get(start, k->name);
        k->unit = ss_scene_unit(start, k->name);
    }
    if (w == NULL)
        return ss_fail_memory(err, NULL);
    st = ss_gaps_missing(&missing, signal);
    *w = (fitting){ .all = { .x = signal->values + column * signal->n, .missing = missing, .n = signal->n,
                             .rate = signal->head->rate } };
    if (st == SS_OK)
        st = ss_cycle_find(&w->goal, fit->why, sizeof fit->why, w->all.x, missing, w->all.n, w->all.rate,
                           opts->forcing_frequency);
    if (st == SS_OK && w->goal.period > 0)
        st = fit_signal(fit, w, signal, column, opts, err);
    if (!fit->conclusive)               /* then it gives no number */
        fit->scene = *start;
    for (size_t i = 0; i < SS_FIT_KEYS && !fit->conclusive; i++)
        fit->key[i].found = (ss_value){ NAN, NAN };
    free(missing);
    free(w);
    return st;
}
