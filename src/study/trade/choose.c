/* choose.c -- choose the cheapest method and tolerance that keep an accuracy for a scene.
 *
 * A repeated run has the same error; only its time is random.  So the promised accuracy could fail
 * only for samples that were not compared, and by the error of the reference.  The margin covers
 * these. */
#include <math.h>
#include <string.h>
#include "base/error.h"
#include "motion/method.h"
#include "study/trade/trade.h"

#define OUTRAGEOUS 40               /* a method may take so many steps for each right-hand side of the reference */

const ss_range ss_trade_accuracies = { 1e-12, 1e-3 };

typedef struct choice {
    probe p;
    run ref, run;
    double known, accuracy;
    unsigned long user_steps;       /* the limit of opts */
    double max_steps;               /* a method may take so many */
    double least;                   /* work of the cheapest method so far */
    double tol, reached;            /* the last method's tolerance, and the least error it reached */
} choice;

/* Find the loosest tolerance at which the method keeps the accuracy; SS_ETOL: there is none; SS_EBUDGET: by then
 * it is no cheaper than another.  cost: of a right-hand side. */
static ss_status
loosest(choice *s, const char *method, double cost, unsigned long max_steps, ss_error *err)
{
    ss_status st = SS_ETOL;
    s->reached = INFINITY;
    for (int i = 0; i < TOLERANCES; i++) {
        if (ss_trade_tolerance[i] > 1.001e3 * s->accuracy)
            continue;
        st = ss_trade_run(&s->run, &s->p, method, ss_trade_tolerance[i], max_steps, err);
        if (st != SS_OK)
            return st;
        if (cost * (double)s->run.stats.rhs >= s->least)
            return SS_EBUDGET;
        double error = fmax(ss_trade_error_x(&s->run, &s->ref), s->known);
        s->reached = fmin(s->reached, error);
        s->tol = ss_trade_tolerance[i];
        if (MARGIN * error <= s->accuracy && s->run.stats.events == s->ref.stats.events)
            return SS_OK;
    }
    return SS_ETOL;
}

/* Choose the cheapest method for a scene without a closed form.  A method is stopped when it has done as
 * much work as the best so far.  With one-step methods each sample costs a step of its own. */
static ss_status
choose_cheapest(choice *s, ss_sim_opts *opts, ss_error *err)
{
    const struct method *usual = ss_method_for(&s->p.scene, USUAL), *how = usual;
    for (size_t i = 0; how != NULL; how = ss_method_at(i++)) {
        if (how->kind == CLOSED_FORM || (how == usual && i > 0))
            continue;
        double most = s->least / how->cost / how->rhs_a_step;
        if (how->kind == ONE_STEP)
            most -= (double)ss_scene_samples(&s->p.scene);
        most = fmin(most, s->max_steps);
        if (!(most >= 1))
            continue;
        ss_status st = loosest(s, how->name, how->cost, (unsigned long)most, err);
        if (st == SS_OK) {
            s->least = how->cost * (double)s->run.stats.rhs;
            opts->method = how->name;
            opts->tol = s->tol;
        } else if (st == SS_STOP || st == SS_ENOMEM) {
            return st;
        }
    }
    if (isfinite(s->least))
        return SS_OK;
    return ss_fail(err, SS_ETOL, "no method keeps an accuracy of %g in this scene", s->accuracy);
}

/* Make the reference with two methods; SS_ETOL if they do not agree within the accuracy. */
static ss_status
refer_to(choice *s, const char *method[2], ss_error *err)
{
    char text[64];
    ss_status st = ss_trade_refer(&s->ref, &s->run, &s->p, method, s->user_steps, text, err);
    if (st != SS_OK)
        return st;
    s->known = ss_trade_known(ss_trade_error_x(&s->run, &s->ref));
    if (s->run.stats.events != s->ref.stats.events)
        return ss_fail(err, SS_ETOL, "no accuracy can be told: %s find %lu and %lu events", text,
                       s->ref.stats.events, s->run.stats.events);
    if (MARGIN * s->known > s->accuracy)
        return ss_fail(err, SS_ETOL, "an accuracy of %g cannot be told: %s differ by %.2g of max|x|",
                       s->accuracy, text, s->known);
    return SS_OK;
}

static ss_status
choose(choice *s, ss_sim_opts *opts, ss_error *err)
{
    const char *witness[2];
    ss_status st = SS_ETOL;
    for (int i = 0; st == SS_ETOL && ss_method_pair(&s->p.scene, i, witness); i++)
        st = refer_to(s, witness, err);
    if (st != SS_OK)
        return st;
    const struct method *best = ss_method_for(&s->p.scene, BEST);
    if (best->kind == CLOSED_FORM && strcmp(witness[0], best->name) == 0
        && (opts->method == NULL || strcmp(opts->method, best->name) == 0)) {
        ss_sim_opts usual;
        ss_sim_opts_init(&usual, sizeof usual);
        opts->method = best->name;
        opts->tol = usual.tol;
        return SS_OK;
    }
    s->max_steps = OUTRAGEOUS * (double)s->ref.stats.rhs;
    if (s->user_steps > 0)
        s->max_steps = fmin(s->max_steps, (double)s->user_steps);
    if (opts->method == NULL)
        return choose_cheapest(s, opts, err);
    st = loosest(s, opts->method, 0, (unsigned long)s->max_steps, err);
    opts->tol = s->tol;
    if (st == SS_EBUDGET && isfinite(s->reached))
        return ss_fail(err, st, "%s needs more than %.0f steps for an accuracy of %g, %d times the error with "
                       "every event in place; with fewer x was %.2g of its maximum off", opts->method,
                       s->max_steps, s->accuracy, MARGIN, s->reached);
    if (st == SS_ETOL && isfinite(s->reached))
        return ss_fail(err, st, "%s keeps no accuracy of %g, %d times the error with every event in place: "
                       "x was %.2g of its maximum off at best", opts->method, s->accuracy, MARGIN, s->reached);
    return st;
}

ss_status
ss_trade_choose(ss_sim_opts *opts, const ss_scene *scene, double accuracy, ss_error *err)
{
    if (opts == NULL || scene == NULL)
        return SS_FAIL_NULL(err);
    ss_sim_opts known;
    ss_status st = ss_sim_opts_take(&known, opts, err);
    if (st == SS_OK)
        st = ss_record_check(scene, err);
    if (st == SS_OK)
        st = ss_range_check(accuracy, ss_trade_accuracies, "accuracy", err);
    const struct method *given;
    if (st == SS_OK && opts->method != NULL)
        st = ss_method_named(&given, opts->method, scene, err);
    if (st != SS_OK)
        return st;
    const run empty = { .progress = known.progress };
    choice s = { .p = ss_trade_probe(scene), .ref = empty, .run = empty, .accuracy = accuracy, .least = INFINITY,
                 .user_steps = known.max_steps };
    st = choose(&s, opts, err);
    ss_trade_run_free(&s.ref);
    ss_trade_run_free(&s.run);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}
