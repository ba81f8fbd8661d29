/* forced.c -- rank scenes whose base moves: by the samples of a signal, and the features of its contours.
 *
 * A scene represents all rigs within the spread of its parameters.  So each scene is first
 * adjusted to the signal's mean cycle (candidate.c) and then to its samples (match.c).  It is run
 * for the duration of the signal with the same noise.  After that, scene and signal are treated in
 * the same way: the same features, the same transform, the same phase.
 *
 * A scene is named only if its residual is no more than the noise; no criterion replaces this.  A
 * model of a real rig is wrong in details, which the residual shows too; the other criteria then
 * tell which model has the features of the signal. */
#include "fit/forced.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/sim.h>
#include "base/error.h"
#include "base/progress.h"
#include "signal/gaps.h"
#include "fit/candidate.h"
#include "fit/match.h"
#include "fit/observation.h"
#include "fit/order.h"

enum { STARTS = 32, KEEP = 2, STEPS = 40 };      /* of the search, within the usual spread */
#define EQUAL 0.01                      /* of the spread: two scenes are equally near to within this */
#define HOPELESS 0.03                   /* of the power of a cycle: see match_scene */
#define BUDGET 2e7                      /* integration steps of a scene: some seconds */
enum { WINDOW = 4 };                    /* cycles that are compared */

/* --- a scene ------------------------------------------------------------------------------- */

typedef struct comparison {
    const ss_signal *signal;            /* the window */
    size_t column;
    rank_record record;                 /* of the column */
    const ss_rank_opts *opts;
    ss_span *gap;                       /* of the window [s] */
    size_t n_gaps;
    cycle goal;
    observation observation;            /* of the signal */
} comparison;

/* A scene's best match, which is kept for the answer. */
typedef struct found {
    match match;
    candidate candidate;
} found;

/* The adjusted scene as the signal's window would show it, its gaps included. */
static ss_status
observe_scene(observation *l, const comparison *w, const ss_scene *adjusted, unsigned long seed,
              ss_error *err)
{
    ss_signal *run = NULL;
    size_t column = (size_t)w->opts->quantity;
    const char *gaps = ss_header_find_note(w->signal->head, "gaps");
    ss_status st = ss_sim_signal(&run, adjusted, err);
    if (st != SS_OK)
        return st;
    double *x = run->values + column * run->n;
    run->head->start = w->signal->head->start;
    st = gaps != NULL ? ss_header_note(run->head, "gaps", gaps, NULL) : SS_OK;
    if (st == SS_OK)
        st = ss_noise_add_once(x, run->n, sqrt(w->record.noise), seed, NULL);
    for (size_t c = 0; c < run->head->n_columns; c++)
        ss_gaps_bridge(run->values + c * run->n, run->n, run->head->rate, w->gap, w->n_gaps);
    if (st == SS_OK)
        st = ss_observation_of(l, run, column, w->goal.period, err);
    ss_signal_free(run);
    return st;
}

/* Find the best of the matches from the starts of the search.  If a start leaves much of the cycle, a
 * descent over the record changes this little: of such starts only the best is matched. */
static ss_status
match_scene(found *f, const comparison *w, const ss_stretch *progress)
{
    candidate *c = &f->candidate;
    match of[CANDIDATE_KEPT];
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < c->n_starts; i++) {
        const ss_stretch part = ss_stretch_part(progress, (double)i / (double)c->n_starts,
                                                (double)(i + 1) / (double)c->n_starts);
        if (i > 0 && (ss_match_explains(&f->match, w->record.noise)
                      || c->start[i].misfit > HOPELESS * w->goal.power))
            break;
        st = ss_match_find(&of[i], c, &c->start[i], w->goal.period, &w->record, of, i, &part);
        if (i == 0 || of[i].left < f->match.left)
            f->match = of[i];
    }
    return st;
}

/* The work of a search within a factor, over that within the usual one: a wider range has more minima. */
static double
work_of(double factor)
{
    const double usual = ss_rank_defaults.spread;
    double wider = log(factor) / log((1 + usual) / (1 - usual));
    return fmax(1, fmin(wider * wider, CANDIDATE_KEPT / KEEP));
}

static ss_status
rank_scene(ss_rank_row *row, found *f, const comparison *w, const ss_scene *scene,
           const ss_stretch *progress, ss_error *err)
{
    observation l;
    double spread = w->opts->spread, factor = (1 + spread) / (1 - spread), more = work_of(factor);
    const ss_stretch search = ss_stretch_part(progress, 0, 0.5);
    const ss_stretch matching = ss_stretch_part(progress, 0.5, 1);
    f->candidate = ss_candidate_of(scene, (int)w->opts->quantity, factor);
    f->candidate.budget = more * BUDGET;
    ss_status st = ss_candidate_search(&f->candidate, &w->goal, (size_t)(more * STARTS),
                                       (size_t)(more * KEEP), STEPS, &search);
    if (st == SS_OK)
        st = match_scene(f, w, &matching);
    if (st == SS_OK && f->candidate.steps > f->candidate.budget)
        return ss_fail(err, SS_EBUDGET, "scene %zu takes more than %.0e integration steps to be "
                       "adjusted: it is too stiff to be ranked", row->scene + 1, f->candidate.budget);
    if (st != SS_OK)
        return ss_fail(err, st, "%s", ss_strerror(st));
    const match *m = &f->match;
    row->adjusted = m->scene;
    st = observe_scene(&l, w, &row->adjusted, 1, err);
    if (st != SS_OK)
        return st;
    ss_observation_compare(row, &w->observation, &l);
    ss_observation_free(&l);
    row->explained = 1 - m->left_all / m->power;
    row->value[SS_BY_RESIDUAL] = 10 * log10(fmax(m->left, 1e-12 * m->power) / m->power);
    row->value[SS_BY_ADJUSTMENT] = ss_candidate_distance(&f->candidate, m->p);
    row->distance[SS_BY_ADJUSTMENT] = spread > 0 ? row->value[SS_BY_ADJUSTMENT] / log(1 + spread) : 0;
    return SS_OK;
}

/* --- the verdict --------------------------------------------------------------------------- */

/* The amount by which the residual of m is below that of another match, in standard errors squared. */
static double
lead_of(const match *m, const match *over, double noise)
{
    return (double)m->compared * (ss_match_excess(over, noise) - ss_match_excess(m, noise));
}

/* Does a sinusoid explain the signal, which is the motion of every linear rig? */
static int
is_sinusoid(const comparison *w, const match *m)
{
    match sinusoid = *m;
    sinusoid.left = ss_record_sinusoid(&w->record, m->scene.base_frequency);
    return ss_match_explains(&sinusoid, w->record.noise);
}

static double
variance_of(const match *m, size_t key)
{
    return fmax(m->left, MATCH_QUIET * m->power) * m->covariance[key][key];
}

/* The error of the difference of two adjustments to one record: an error that both share cancels. */
static double
difference_error(const found *a, const found *b)
{
    const double h = 1e-4;
    double squares = 0;
    for (size_t k = 0; k < a->candidate.n; k++) {
        double p[MATCH_SIZE], q[MATCH_SIZE];
        memcpy(p, a->match.p, sizeof p);
        memcpy(q, b->match.p, sizeof q);
        p[k] += h, q[k] += h;
        double slope = (ss_candidate_distance(&a->candidate, p) - ss_candidate_distance(&b->candidate, q)
                        - ss_candidate_distance(&a->candidate, a->match.p)
                        + ss_candidate_distance(&b->candidate, b->match.p)) / h;
        squares += slope * slope * variance_of(&a->match, k);
    }
    return sqrt(squares);
}

/* The scene that comes first is not named if this one explains the signal as well and has another law, or
 * is as near. */
static void
compare_equals(ss_ranking *r, const ss_rank_row *other, const found *f, double spread)
{
    const ss_rank_row *first = &r->row[0];
    double farther = other->value[SS_BY_ADJUSTMENT] - first->value[SS_BY_ADJUSTMENT];
    if (other->adjusted.model != first->adjusted.model)
        snprintf(r->why, sizeof r->why, "%s and %s friction explain the signal equally well",
                 ss_model_name(first->adjusted.model), ss_model_name(other->adjusted.model));
    else if (fabs(farther) <= fmax(sqrt(MATCH_DECISIVE) * difference_error(&f[first->scene], &f[other->scene]),
                                   EQUAL * log(1 + spread)))
        snprintf(r->why, sizeof r->why, "two scenes with %s friction are equally near to the signal",
                 ss_model_name(first->adjusted.model));
    else
        return;
    r->verdict = SS_UNDECIDED;
}

/* Find the verdict from the residuals of the scenes. */
static void
judge(ss_ranking *r, const comparison *w, const found *f)
{
    const ss_rank_row *first = &r->row[0];
    const match *m = &f[first->scene].match;
    size_t least = first->scene, fit = 0;
    r->verdict = SS_UNDECIDED;
    for (size_t i = 0; i < r->n; i++) {
        least = f[i].match.left < f[least].match.left ? i : least;
        fit += ss_match_explains(&f[i].match, w->record.noise);
    }
    const match *best = &f[least].match;
    if (fit == 0) {
        r->verdict = SS_NONE_FITS;
        snprintf(r->why, sizeof r->why, "each leaves at least %.3g %% of the signal's power, "
                 "%.3g times the noise", 100 * best->left / best->power,
                 ss_match_excess(best, w->record.noise));
    } else if (is_sinusoid(w, m)) {
        snprintf(r->why, sizeof r->why, "a sinusoid explains the signal as well: it shows no "
                 "transitions");
    } else if (lead_of(best, m, w->record.noise) > MATCH_DECISIVE) {
        snprintf(r->why, sizeof r->why, "the scene that comes first leaves %.3g %% of the signal's "
                 "power, and another, which leaves %.3g %%, shows other transitions",
                 100 * m->left / m->power, 100 * best->left / best->power);
    } else {
        r->verdict = SS_NAMED;
    }
    for (size_t i = 1; r->verdict == SS_NAMED && i < r->n; i++)
        if (ss_match_explains(&f[r->row[i].scene].match, w->record.noise)
            && lead_of(m, &f[r->row[i].scene].match, w->record.noise) < MATCH_DECISIVE)
            compare_equals(r, &r->row[i], f, w->opts->spread);
}

/* The key in which two matches of one candidate differ most, significantly, and their difference in standard
 * errors; c->n: they do not contradict each other. */
static size_t
contradicted_key(const candidate *c, const match *a, const match *b, double *errors)
{
    double most = MATCH_DECISIVE;
    size_t worst = c->n;
    for (size_t i = 0; i < c->n; i++) {
        double d = a->p[i] - b->p[i], squares = d * d / (variance_of(a, i) + variance_of(b, i));
        if (squares > most)             /* NaN is not: a key without an error */
            most = squares, worst = i;
    }
    *errors = sqrt(most);
    return worst;
}

/* Fit the scene that is named to another column; if that contradicts the first, r->why says so. */
static ss_status
fit_column(ss_ranking *r, const comparison *w, const found *named, int quantity)
{
    const size_t column = (size_t)w->opts->also[quantity];
    const ss_stretch silent = { { NULL, NULL }, 0, 1 };
    rank_record record = w->record;
    const char *first = w->signal->head->column[w->column].name;
    const char *other = w->signal->head->column[column].name;
    candidate c = named->candidate;
    const char *model = ss_model_name(c.scene.model);
    match m = { .power = 0 };
    double errors;
    c.pick = quantity;
    record.x = w->signal->values + column * w->signal->n;
    ss_status st = ss_record_noise(&record, w->goal.period * record.rate);
    if (st == SS_OK)
        st = ss_match_other(&m, &c, &named->match, &record, &silent);
    if (st != SS_OK || m.power == 0)        /* a constant contradicts nothing */
        return st;
    size_t key = contradicted_key(&c, &named->match, &m, &errors);
    if (!ss_match_explains(&m, record.noise))
        snprintf(r->why, sizeof r->why, "%s friction explains column %s, but not column %s: it "
                 "leaves %.3g %% of that, %.3g times the noise", model, first, other,
                 100 * m.left / m.power, ss_match_excess(&m, record.noise));
    else if (key < c.n && record.noise > record.steps)      /* errors are those of white noise */
        snprintf(r->why, sizeof r->why, "%s friction explains column %s and column %s, but with %s "
                 "%.2g %% apart, %.2g standard errors", model, first, other,
                 ss_candidate_key_name(&c, key), 100 * fabs(expm1(m.p[key] - named->match.p[key])),
                 errors);
    return SS_OK;
}

/* Fit the scene to the other columns, too.  It must explain each of them, with the same parameters except the
 * size, which is in the units of the column. */
static ss_status
fit_other_columns(ss_ranking *r, const comparison *w, const found *f)
{
    ss_status st = SS_OK;
    for (int q = 0; st == SS_OK && r->why[0] == '\0' && q < SS_QUANTITIES; q++)
        if (w->opts->also[q] >= 0 && (size_t)w->opts->also[q] != w->column)
            st = fit_column(r, w, &f[r->row[0].scene], q);
    if (r->why[0] != '\0')
        r->verdict = SS_UNDECIDED;
    return st;
}

/* Find the noise, the distances, the order of the rows and the verdict. */
static ss_status
conclude(ss_ranking *r, comparison *w, const found *f)
{
    double least = INFINITY;
    for (size_t i = 0; i < r->n; i++) {
        least = fmin(least, r->row[i].value[SS_BY_RESIDUAL]);
        w->record.noise = fmin(w->record.noise, f[i].match.compared > 0 ? f[i].match.white : INFINITY);
    }
    r->noise = w->record.noise / f[0].match.power;
    for (size_t i = 0; i < r->n; i++) {
        r->row[i].distance[SS_BY_RESIDUAL] = r->row[i].value[SS_BY_RESIDUAL] - least;
        r->row[i].excess = ss_match_excess(&f[i].match, w->record.noise);
    }
    ss_ranking_sort(r);
    for (size_t i = 0; i < SS_CRITERIA; i++)
        r->value[i] = w->observation.value[i];
    judge(r, w, f);
    return r->verdict == SS_NAMED ? fit_other_columns(r, w, f) : SS_OK;
}

/* --- all ----------------------------------------------------------------------------------- */

static ss_status
rows_of(ss_signal **out, const ss_signal *signal, size_t first, size_t end)
{
    size_t n = signal->head->n_columns, *column = malloc(n * sizeof *column);
    if (column == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++)
        column[i] = i;
    ss_status st = ss_signal_select(out, signal, column, n, first, end, NULL);
    free(column);
    return st;
}

static ss_status
rank_scenes(ss_ranking *r, found *f, const ss_scene *scene, comparison *w, const ss_stretch *progress,
            ss_error *err)
{
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < r->n; i++) {
        ss_stretch part = ss_stretch_part(progress, (double)(i + 1) / (double)(r->n + 1),
                                          (double)(i + 2) / (double)(r->n + 1));
        st = rank_scene(&r->row[i], &f[i], w, &scene[i], &part, err);
    }
    if (st == SS_OK)
        st = conclude(r, w, f);
    return st;
}

static ss_status
rank_all(ss_ranking *r, const ss_signal *signal, const char *missing, const ss_scene *scene,
         comparison *w, const ss_stretch *progress, ss_error *err)
{
    double rate = signal->head->rate, most = WINDOW * w->goal.period * rate;
    size_t n = most < (double)signal->n ? (size_t)most : signal->n, first = (signal->n - n) / 2;
    ss_signal *window = NULL;
    found *f = calloc(r->n, sizeof *f);
    ss_status st = f != NULL ? rows_of(&window, signal, first, first + n) : SS_ENOMEM;
    if (st != SS_OK) {
        free(f);
        return ss_fail(err, st, "%s", ss_strerror(st));
    }
    w->signal = window;
    w->record = (rank_record){ .x = window->values + w->column * n, .n = n, .rate = rate,
                               .missing = missing != NULL ? missing + first : NULL,
                               .from = (double)first / rate };
    st = ss_gaps_of(&w->gap, &w->n_gaps, window->head, n);
    for (size_t c = 0; st == SS_OK && c < window->head->n_columns; c++)
        ss_gaps_bridge(window->values + c * n, n, rate, w->gap, w->n_gaps);
    if (st == SS_OK)
        st = ss_observation_of(&w->observation, window, w->column, w->goal.period, err);
    if (st == SS_OK)
        st = ss_record_noise(&w->record, w->goal.period * rate);
    if (st == SS_OK)
        st = rank_scenes(r, f, scene, w, progress, err);
    ss_observation_free(&w->observation);
    free(w->gap);
    free(f);
    ss_signal_free(window);
    return st;
}

ss_status
ss_forced_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                  const ss_rank_opts *opts, ss_error *err)
{
    const ss_stretch whole = { opts->progress, 0, 1 };
    const ss_stretch reading = ss_stretch_part(&whole, 0, 1 / (double)(r->n + 1));
    char *missing = NULL;
    comparison *w = calloc(1, sizeof *w);
    if (w == NULL)
        return ss_fail_memory(err, NULL);
    *w = (comparison){ .column = column, .opts = opts };
    ss_status st = ss_gaps_missing(&missing, signal);
    if (st == SS_OK)
        st = ss_cycle_find(&w->goal, r->why, sizeof r->why, signal->values + column * signal->n,
                           missing, signal->n, signal->head->rate, opts->forcing_frequency,
                           &reading);
    if (st == SS_OK && w->goal.period > 0) {
        r->forcing_frequency = 1 / w->goal.period;
        st = rank_all(r, signal, missing, scene, w, &whole, err);
    }
    free(missing);
    free(w);
    return st;
}
