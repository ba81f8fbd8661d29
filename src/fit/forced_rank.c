/* forced_rank.c -- rank scenes whose base moves: by the samples of a signal, and the features of its contours.
 *
 * A scene represents all rigs within the spread of its parameters.  So each scene is first
 * adjusted to the signal's mean cycle and then to its samples (forced.h).  It is run
 * for the duration of the signal with the same noise.  After that, scene and signal are treated in
 * the same way: the same features, the same transform, the same phase.
 *
 * A scene is named only if its residual is no more than the noise; no criterion replaces this.  A
 * model of a real rig is wrong in details, which the residual shows too; the other criteria then
 * tell which model has the features of the signal. */
#include "fit/forced.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/features.h>
#include <stickslip/morlet.h>
#include <stickslip/sim.h>
#include <stickslip/spikes.h>
#include "base/error.h"
#include "base/number.h"
#include "find/search.h"
#include "map/map.h"
#include "signal/gaps.h"
#include "signal/noise.h"
#include "signal/header.h"

enum { POINTS = 32, KEEP = 2 };         /* of the search, within the usual spread */
#define BUDGET 2e7                      /* integration steps of a scene: some seconds */
enum { WINDOW = 4 };                    /* cycles that are compared */

/* Numbers from the features, spikes and contours of a signal. */
typedef struct observation {
    double value[SS_CRITERIA];          /* NaN where there is none */
    int countable;                      /* spikes can be counted */
    int has_slope;                      /* there are columns for df/dx */
    ss_coefficients *map;
} observation;

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

/* A scene's variants, and the best fit of them. */
typedef struct found {
    forced scene;
    forced_fit fit;
} found;

/* --- what is observed of a signal ----------------------------------------------------------- */

static double
median(double *x, size_t n)
{
    return n > 0 ? gsl_stats_median(x, 1, n) : NAN;
}

static double
level(const observation *l, size_t c, double top)
{
    double size = hypot(l->map->w[2 * c], l->map->w[2 * c + 1]);
    return fmax(size > 0 ? 20 * log10(size / top) : -SPAN, -SPAN);
}

static ss_status
measure_features(observation *l, const ss_signal *signal, size_t column, double half, ss_error *err)
{
    ss_features *f = NULL;
    ss_features_opts opts;
    ss_features_opts_init(&opts, sizeof opts);
    opts.displacement = ss_header_column(signal->head, "x");
    opts.force = ss_header_column(signal->head, "f");
    ss_status st = ss_features_find(&f, signal, column, &opts, err);
    if (st != SS_OK)
        return st;
    const ss_spikes *spikes = f->spikes;
    const double halves = (double)signal->n / signal->head->rate / half;
    size_t count = 0;
    l->has_slope = opts.displacement >= 0 && opts.force >= 0;
    l->value[SS_BY_MAXIMUM] = fmin((double)f->recurring / floor(halves), 1);
    l->value[SS_BY_FREQUENCY] = f->number[SS_TRANSITION_FREQUENCY].value;
    l->value[SS_BY_DAMPING] = f->number[SS_DAMPING_RATIO].value;
    l->value[SS_BY_STIFFNESS] = f->number[SS_CONTACT_STIFFNESS_SLOPE].value;
    /* spikes at most 20 dB below the strongest: their number in a half cycle, and the median of their slopes */
    double *slope = malloc((spikes->n + 1) * sizeof *slope);
    for (size_t i = 0; slope != NULL && i < spikes->n; i++)
        if (spikes->spike[i].kind != SS_SPIKE_GLITCH && spikes->spike[i].level >= -20)
            slope[count++] = spikes->spike[i].slope;
    l->countable = spikes->conclusive;
    l->value[SS_BY_SPIKES] = (double)count / halves;
    l->value[SS_BY_SLOPE] = median(slope, count);
    st = slope != NULL ? SS_OK : SS_ENOMEM;
    free(slope);
    ss_features_free(f);
    return st;
}

/* Observe a column whose motion repeats after period [s].  The map is the caller's to free. */
static ss_status
observe(observation *l, const ss_signal *signal, size_t column, double period, ss_error *err)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_status st;
    opts.voices = 4;
    opts.accuracy = 1e-4;
    opts.detrend = SS_DETREND_MEAN;
    for (size_t i = 0; i < SS_CRITERIA; i++)
        l->value[i] = NAN;
    l->map = NULL;
    st = measure_features(l, signal, column, period / 2, err);
    if (st == SS_OK)
        st = ss_morlet_transform(&l->map, signal, column, &opts, err);
    if (st != SS_OK)
        return st;
    /* jumps: the median over half cycles of the largest |W| in each along the shortest scale [dB re the map's] */
    const ss_scale *s = &l->map->scale[l->map->n_scales - 1];
    const double top = ss_coefficients_max(l->map), half = period / 2;
    const size_t halves = (size_t)((double)l->map->n / l->map->head->rate / half);
    double *most = malloc((halves + 1) * sizeof *most);
    if (most == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < halves; i++)
        most[i] = -SPAN;
    for (size_t k = 0; top > 0 && k < s->n; k++) {
        size_t i = (size_t)(ss_scale_b(s, k) / half);
        if (i < halves && !ss_coefficients_edge(l->map, l->map->n_scales - 1, k))
            most[i] = fmax(most[i], level(l, s->offset + k, top));
    }
    l->value[SS_BY_JUMP] = median(most, halves);
    free(most);
    return SS_OK;
}

/* The rms difference of the levels of two maps on one grid, every octave counting the same. */
static double
map_distance(const observation *a, const observation *b)
{
    double top_a = ss_coefficients_max(a->map), top_b = ss_coefficients_max(b->map), sum = 0;
    if (!(top_a > 0 && top_b > 0))
        return NAN;
    for (size_t i = 0; i < a->map->n_scales; i++) {
        const ss_scale *s = &a->map->scale[i];
        double squares = 0, count = 0;
        for (size_t k = 0; k < s->n; k++) {
            double d = level(a, s->offset + k, top_a) - level(b, s->offset + k, top_b);
            if (ss_coefficients_edge(a->map, i, k))
                continue;
            squares += d * d;
            count++;
        }
        sum += count > 0 ? squares / count : 0;
    }
    return sqrt(sum / (double)a->map->n_scales);
}

/* Write to the row what the signal's window would show of the adjusted scene, its gaps included, and the distances
 * from the signal's. */
static ss_status
compare(ss_rank_row *row, const comparison *w, ss_error *err)
{
    const observation *signal = &w->observation;
    observation model = { .map = NULL };
    ss_signal *run = NULL;
    size_t column = (size_t)w->opts->quantity;
    const char *gaps = ss_header_find_note(w->signal->head, "gaps");
    ss_status st = ss_sim_signal(&run, &row->adjusted, err);
    if (st != SS_OK)
        return st;
    run->head->start = w->signal->head->start;
    st = gaps != NULL ? ss_header_note(run->head, "gaps", gaps, NULL) : SS_OK;
    if (st == SS_OK)
        st = ss_noise_add_once(run->values + column * run->n, run->n, sqrt(w->record.noise), 1, NULL);
    for (size_t c = 0; c < run->head->n_columns; c++)
        ss_gaps_bridge(run->values + c * run->n, run->n, run->head->rate, w->gap, w->n_gaps);
    if (st == SS_OK)
        st = observe(&model, run, column, w->goal.period, err);
    for (size_t i = SS_BY_MAXIMUM; st == SS_OK && i < SS_CRITERIA; i++) {
        const double a = signal->value[i], b = row->value[i] = model.value[i];
        const int is_ratio = i == SS_BY_FREQUENCY || i == SS_BY_DAMPING || i == SS_BY_STIFFNESS;
        row->distance[i] = isnan(a) && isnan(b) ? 0 : fabs(is_ratio ? log(a / b) : a - b);
    }
    /* where noise hides spikes, their number and kind describe the noise */
    if (!signal->countable)
        row->distance[SS_BY_SPIKES] = row->distance[SS_BY_SLOPE] = 0;
    if (!signal->has_slope) {
        row->value[SS_BY_STIFFNESS] = NAN;
        row->distance[SS_BY_STIFFNESS] = 0;
    }
    if (st == SS_OK)
        row->value[SS_BY_MAP] = row->distance[SS_BY_MAP] = map_distance(signal, &model);
    ss_coefficients_free(model.map);
    ss_signal_free(run);
    return st;
}

static ss_status
rank_scene(ss_rank_row *row, found *f, const comparison *w, const ss_scene *scene,
           const ss_stretch *progress, ss_error *err)
{
    /* a wider range than the usual has more minima */
    const double spread = w->opts->spread, factor = (1 + spread) / (1 - spread);
    const double usual = (1 + RANK_SPREAD) / (1 - RANK_SPREAD), wider = log(factor) / log(usual);
    const double more = fmax(1, fmin(wider * wider, FORCED_KEPT / KEEP));
    f->scene = ss_forced_of(scene, (int)w->opts->quantity, factor);
    f->scene.period = w->goal.period;
    f->scene.budget = more * BUDGET;
    f->scene.progress = *progress;
    ss_status st = ss_forced_fit(&f->fit, NULL, &f->scene, &w->goal, (size_t)(more * POINTS),
                                 (size_t)(more * KEEP), &w->record);
    if (st == SS_OK && f->scene.steps > f->scene.budget)
        return ss_fail(err, SS_EBUDGET, "scene %zu takes more than %.0e integration steps to be "
                       "adjusted: it is too stiff to be ranked", row->scene + 1, f->scene.budget);
    if (st != SS_OK)
        return ss_fail(err, st, "%s", ss_strerror(st));
    const residue *of = &f->fit.of_samples;
    row->adjusted = f->fit.scene;
    row->explained = 1 - f->fit.left_all / of->power;
    row->value[SS_BY_RESIDUAL] = 10 * log10(fmax(of->left, 1e-12 * of->power) / of->power);
    row->value[SS_BY_ADJUSTMENT] = ss_forced_distance(&f->scene, f->fit.u);
    row->distance[SS_BY_ADJUSTMENT] = spread > 0 ? row->value[SS_BY_ADJUSTMENT] / log(1 + spread) : 0;
    return compare(row, w, err);
}

/* --- the verdict --------------------------------------------------------------------------- */

static double
variance_of(const forced_fit *m, size_t key)
{
    return fmax(m->of_samples.left, RESIDUE_QUIET * m->of_samples.power) * m->covariance[key][key];
}

/* The error of the difference of two adjustments to one record: an error that both share cancels. */
static double
difference_error(const found *a, const found *b)
{
    const double h = 1e-4;
    double squares = 0;
    for (size_t k = 0; k < a->scene.n; k++) {
        double p[FORCED_MOVED], q[FORCED_MOVED];
        memcpy(p, a->fit.u, sizeof p);
        memcpy(q, b->fit.u, sizeof q);
        p[k] += h, q[k] += h;
        double slope = (ss_forced_distance(&a->scene, p) - ss_forced_distance(&b->scene, q)
                        - ss_forced_distance(&a->scene, a->fit.u) + ss_forced_distance(&b->scene, b->fit.u)) / h;
        squares += slope * slope * variance_of(&a->fit, k);
    }
    return sqrt(squares);
}

/* Say so if a scene of another law would explain the signal as the first does, were its rig damped otherwise: a
 * law is not named for what damping does. */
static ss_status
test_damping(ss_ranking *r, const comparison *w, const found *f)
{
    const ss_rank_row *first = &r->row[0];
    ss_status st = SS_OK;
    for (size_t i = 1; st == SS_OK && r->verdict == SS_NAMED && i < r->n; i++) {
        const ss_rank_row *other = &r->row[i];
        const found *of = &f[other->scene];
        residue damped = of->fit.of_samples;
        forced_held held[HELD_TERMS];
        if (other->adjusted.model == first->adjusted.model || damped.compared == 0)
            continue;
        st = ss_forced_gains(held, &of->scene, &of->fit, &w->record);
        const forced_held *by = &held[HELD_DAMPING];
        damped.left -= by->gain * fmax(damped.left, RESIDUE_QUIET * damped.power) / damped.compared;
        if (st != SS_OK || !(by->nearer > 0)
            || !ss_residue_equals(&damped, &f[first->scene].fit.of_samples, w->record.noise))
            continue;
        r->verdict = SS_UNDECIDED;
        ss_print_to(r->why, sizeof r->why, "%s friction explains the signal as well as %s friction if the rig's "
                    "damping is %.2g N s/m", ss_model_name(other->adjusted.model),
                    ss_model_name(first->adjusted.model), by->nearer);
    }
    return st;
}

/* Find the verdict from what the scenes leave: the first is named if it explains the signal, no sinusoid does
 * (the motion of every linear rig), no scene leaves less, and none that leaves as little has another law or
 * is as near. */
static ss_status
judge(ss_ranking *r, const comparison *w, const found *f)
{
    const ss_rank_row *first = &r->row[0];
    const residue *own = &f[first->scene].fit.of_samples, *best = own;
    residue sinusoid = *own;
    double noise = w->record.noise;
    size_t explain = 0;
    r->verdict = SS_UNDECIDED;
    for (size_t i = 0; i < r->n; i++) {
        const residue *of = &f[r->row[i].scene].fit.of_samples;
        best = of->left < best->left ? of : best;
        explain += (size_t)ss_residue_explains(of, noise);
    }
    ss_status st = ss_record_sinusoid(&w->record, f[first->scene].fit.scene.base_frequency, &sinusoid.left);
    if (explain == 0) {
        r->verdict = SS_NONE_FITS;
        ss_print_to(r->why, sizeof r->why, "each leaves at least %.3g %% of the signal's power, "
                    "%.3g times the noise", 100 * best->left / best->power, ss_residue_excess(best, noise));
    } else if (ss_residue_explains(&sinusoid, noise)) {
        snprintf(r->why, sizeof r->why, "a sinusoid explains the signal as well: it shows no transitions");
    } else if (ss_residue_lead(best, own, noise) > RESIDUE_DECISIVE) {
        ss_print_to(r->why, sizeof r->why, "the scene that comes first leaves %.3g %% of the signal's "
                    "power, and another, which leaves %.3g %%, shows other transitions",
                    100 * own->left / own->power, 100 * best->left / best->power);
    } else {
        r->verdict = SS_NAMED;
    }
    for (size_t i = 1; r->verdict == SS_NAMED && i < r->n; i++) {
        const ss_rank_row *other = &r->row[i];
        const residue *of = &f[other->scene].fit.of_samples;
        double farther = other->value[SS_BY_ADJUSTMENT] - first->value[SS_BY_ADJUSTMENT];
        double allowed = sqrt(RESIDUE_DECISIVE) * difference_error(&f[first->scene], &f[other->scene]);
        if (!ss_residue_equals(of, own, noise))
            continue;
        if (other->adjusted.model != first->adjusted.model)
            snprintf(r->why, sizeof r->why, "%s and %s friction explain the signal equally well",
                     ss_model_name(first->adjusted.model), ss_model_name(other->adjusted.model));
        else if (fabs(farther) <= fmax(allowed, FAINT * log(1 + w->opts->spread)))
            snprintf(r->why, sizeof r->why, "two scenes with %s friction are equally near to the signal",
                     ss_model_name(first->adjusted.model));
        if (r->why[0] != '\0')
            r->verdict = SS_UNDECIDED;
    }
    return st == SS_OK ? test_damping(r, w, f) : st;
}

/* Fit the scene that is named to another column.  It must explain that, too, with the same parameters except
 * the size, which is in the units of the column; else r->why says so. */
static ss_status
fit_column(ss_ranking *r, const comparison *w, const found *named, int quantity)
{
    const size_t column = (size_t)w->opts->also[quantity];
    const char *first = w->signal->head->column[w->column].name;
    const char *other = w->signal->head->column[column].name;
    const char *model = ss_model_name(named->scene.scene.model);
    rank_record record = w->record;
    forced scene = named->scene;
    forced_fit m;
    double most = RESIDUE_DECISIVE;
    scene.pick = quantity;
    scene.progress.progress.function = NULL;
    record.x = w->signal->values + column * w->signal->n;
    ss_status st = ss_record_noise(&record, w->goal.period * record.rate);
    if (st == SS_OK)
        st = ss_forced_refit(&m, &scene, &named->fit, &record);
    if (st != SS_OK || m.of_samples.power == 0)         /* a constant contradicts nothing */
        return st;
    size_t key = scene.n;               /* in which the fits differ most, significantly */
    for (size_t i = 0; i < scene.n; i++) {
        const double d = named->fit.u[i] - m.u[i];
        const double squares = d * d / (variance_of(&named->fit, i) + variance_of(&m, i));
        if (squares > most)             /* NaN is not: a key without an error */
            most = squares, key = i;
    }
    if (!ss_residue_explains(&m.of_samples, record.noise))
        ss_print_to(r->why, sizeof r->why, "%s friction explains column %s, but not column %s: it "
                    "leaves %.3g %% of that, %.3g times the noise", model, first, other,
                    100 * m.of_samples.left / m.of_samples.power, ss_residue_excess(&m.of_samples, record.noise));
    else if (key < scene.n && record.noise > record.steps)      /* errors are those of white noise */
        ss_print_to(r->why, sizeof r->why, "%s friction explains column %s and column %s, but with %s "
                    "%.2g %% apart, %.2g standard errors", model, first, other,
                    ss_forced_key_name(&scene, key), 100 * fabs(expm1(m.u[key] - named->fit.u[key])),
                    sqrt(most));
    return SS_OK;
}

/* Find the noise, the distances, the order of the rows and the verdict. */
static ss_status
conclude(ss_ranking *r, comparison *w, const found *f)
{
    double least = INFINITY;
    for (size_t i = 0; i < r->n; i++) {
        const residue *of = &f[r->row[i].scene].fit.of_samples;
        least = fmin(least, r->row[i].value[SS_BY_RESIDUAL]);
        w->record.noise = fmin(w->record.noise, of->compared > 0 ? of->white : INFINITY);
    }
    r->noise = w->record.noise / f[r->row[0].scene].fit.of_samples.power;
    for (size_t i = 0; i < r->n; i++) {
        r->row[i].distance[SS_BY_RESIDUAL] = r->row[i].value[SS_BY_RESIDUAL] - least;
        r->row[i].excess = ss_residue_excess(&f[r->row[i].scene].fit.of_samples, w->record.noise);
    }
    ss_ranking_sort(r);
    memcpy(r->value, w->observation.value, sizeof r->value);
    ss_status st = judge(r, w, f);
    for (int q = 0; st == SS_OK && r->verdict == SS_NAMED && q < SS_QUANTITIES; q++) {
        if (w->opts->also[q] >= 0 && (size_t)w->opts->also[q] != w->column)
            st = fit_column(r, w, &f[r->row[0].scene], q);
        if (r->why[0] != '\0')
            r->verdict = SS_UNDECIDED;
    }
    return st;
}

/* Compare the scenes with the middle of the signal. */
static ss_status
rank_window(ss_ranking *r, comparison *w, const ss_signal *signal, const char *missing, const ss_scene *scene,
            ss_error *err)
{
    const ss_stretch whole = { w->opts->progress, 0, 1 };
    const double rate = signal->head->rate, most = WINDOW * w->goal.period * rate, scenes = (double)r->n;
    const size_t n = most < (double)signal->n ? (size_t)most : signal->n, first = (signal->n - n) / 2;
    ss_signal *window = NULL;
    const size_t last = r->row[r->n - 1].scene;
    found *f = calloc(last + 1, sizeof *f);             /* by scene */
    ss_status st = f == NULL ? SS_ENOMEM
        : ss_signal_select(&window, signal, NULL, signal->head->n_columns, first, first + n, NULL);
    w->signal = window;
    if (st == SS_OK)
        st = ss_gaps_of(&w->gap, &w->n_gaps, window->head, n);
    if (st == SS_OK) {
        w->record = (rank_record){ .x = window->values + w->column * n, .n = n, .rate = rate,
                                   .missing = missing != NULL ? missing + first : NULL,
                                   .from = (double)first / rate };
        for (size_t c = 0; c < window->head->n_columns; c++)
            ss_gaps_bridge(window->values + c * n, n, rate, w->gap, w->n_gaps);
        st = ss_record_noise(&w->record, w->goal.period * rate);
    }
    if (st != SS_OK)
        ss_fail(err, st, "%s", ss_strerror(st));
    else
        st = observe(&w->observation, window, w->column, w->goal.period, err);
    for (size_t i = 0; st == SS_OK && i < r->n; i++) {
        ss_stretch part = ss_stretch_part(&whole, (double)i / scenes, (double)(i + 1) / scenes);
        const size_t which = r->row[i].scene;
        st = rank_scene(&r->row[i], &f[which], w, &scene[which], &part, err);
    }
    if (st == SS_OK)
        st = conclude(r, w, f);
    ss_coefficients_free(w->observation.map);
    free(w->gap);
    free(f);
    ss_signal_free(window);
    return st;
}

ss_status
ss_forced_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                  const ss_rank_opts *opts, ss_error *err)
{
    char *missing = NULL;
    comparison *w = calloc(1, sizeof *w);
    if (w == NULL)
        return ss_fail_memory(err, NULL);
    *w = (comparison){ .column = column, .opts = opts };
    ss_status st = ss_gaps_missing(&missing, signal);
    if (st == SS_OK)
        st = ss_cycle_find(&w->goal, r->why, sizeof r->why, signal->values + column * signal->n,
                           missing, signal->n, signal->head->rate, opts->forcing_frequency);
    if (st == SS_OK && w->goal.period > 0) {
        r->forcing_frequency = 1 / w->goal.period;
        st = rank_window(r, w, signal, missing, scene, err);
    }
    free(missing);
    free(w);
    return st;
}
