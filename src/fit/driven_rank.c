/* driven_rank.c -- which friction law a recording of motion and force follows.
 *
 * * Each law is fitted to one fold of the recording and judged by what it leaves of the other (driven_fit.c).  The
 * verdict (verdict.c) compares what is left with the noise and with what a spring of any shape leaves.
 *
 * * The noise is unknown, but at most the less of two estimates.  Motions that repeat: what differs between
 * rows of two passages through nearly the same place, by position, speed and the last two turns; a law's memory is
 * no longer than that.  Other motions: noise of short memory is as rough as its power says, and what a law fails to
 * explain is smoother, but friction that wanders from cycle to cycle, which stands beside it. */
#include "fit/driven.h"

#include <float.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/options.h"
#include "base/progress.h"
#include "fit/wander.h"
#include "io/record.h"
#include "signal/gaps.h"
#include "signal/header.h"

enum { COARSE = DRIVEN_ROWS / 5 };      /* rows that searches look at */
#define MEMORY (1. / 16)                /* of noise, at most, in cycles */
#define OTHER_RANGE 1.25                /* ratio of the rms motion in two folds that are not alike */

static const ss_motion_opts defaults = { .size = sizeof defaults, .delay = 1 };

SS_OPTIONS(ss_motion_opts, defaults)

/* The ratio of the rms motions in the two folds, at least 1. */
static double
fold_ratio(const driven *d)
{
    double sum[FOLDS] = { 0 }, squares[FOLDS] = { 0 }, n[FOLDS] = { 0 }, variance[FOLDS];
    for (size_t i = 0; i < d->n; i++) {
        const int fold = driven_fold(d, i);
        sum[fold] += d->x[i];
        squares[fold] += d->x[i] * d->x[i];
        n[fold]++;
    }
    for (int k = 0; k < FOLDS; k++)
        variance[k] = squares[k] / n[k] - sum[k] / n[k] * (sum[k] / n[k]);
    return sqrt(fmax(variance[0], variance[1]) / fmin(variance[0], variance[1]));
}

/* --- what the motion can show -------------------------------------------------------------- */

/* Why it shows no law, or an empty text. */
static void
find_doubt(char *why, size_t room, const driven *d, size_t turns)
{
    size_t moving = 0;
    double most = 0, range[BLOCKS];
    why[0] = '\0';
    if (!isfinite(d->length + d->speed + d->force))
        snprintf(why, room, "its numbers are too large");
    else if (!(d->length > 0 && d->speed > 0 && d->force > 0))
        snprintf(why, room, "%s is constant", d->length > 0 && d->speed > 0 ? "the force" : "the motion");
    else if (d->n < DRIVEN_FEWEST)
        snprintf(why, room, "it has %zu rows, fewer than %d", d->n, DRIVEN_FEWEST);
    else if (d->least > 1)
        snprintf(why, room, "the motion is noise");
    else if (turns < 2)
        snprintf(why, room, "the motion goes in one direction only");
    else if (turns < 4)
        snprintf(why, room, "the motion turns only %zu times", turns);
    if (why[0] != '\0')
        return;
    for (size_t b = 0; b < BLOCKS; b++) {
        const size_t first = b * d->n / BLOCKS, end = (b + 1) * d->n / BLOCKS;
        double from, to;
        gsl_stats_minmax(&from, &to, d->x + first, 1, end - first);
        range[b] = to - from;
        most = fmax(most, range[b]);
    }
    for (size_t b = 0; b < BLOCKS; b++)
        moving += range[b] > LITTLE * most;
    if (2 * moving < BLOCKS)
        snprintf(why, room, "the motion is mostly rest");
}

/* --- the noise ----------------------------------------------------------------------------- */

/* For each row the row of another passage that is nearest to it, or the row itself if it is left out. */
static ss_status
find_partners(const driven *d, size_t *partner)
{
    typedef struct passing { double at[4]; size_t turns; } passing;
    passing *p = malloc(d->n * (sizeof *p + 1));
    char *is_turn = (char *)(p + d->n);
    if (p == NULL)
        return SS_ENOMEM;
    ss_driven_turns(d, fmax(LITTLE, d->least), is_turn);
    for (size_t i = 0, last = 0, before = 0, turns = 0; i < d->n; i++) {
        if (is_turn[i]) {
            before = last;
            last = i;
            turns++;
        }
        p[i] = (passing){ { d->x[i], d->v[i], d->x[last], d->x[before] }, turns };
    }
    for (size_t i = 0; i < d->n; i++) {
        double nearest = INFINITY;
        partner[i] = i;
        for (size_t j = 0; j < d->n && d->used[i]; j++) {
            double distance = 0;
            if (!d->used[j] || (p[j].turns <= p[i].turns + 1 && p[i].turns <= p[j].turns + 1))
                continue;
            for (int k = 0; k < 4; k++)
                distance += (p[i].at[k] - p[j].at[k]) * (p[i].at[k] - p[j].at[k]);
            if (distance < nearest) {
                nearest = distance;
                partner[i] = j;
            }
        }
    }
    free(p);
    return SS_OK;
}

/* The terms of a spring of any shape and a damper: free functions of the place, the speed, its square, and the
 * acceleration. */
enum { PLACES = 8, TERMS = PLACES + 3 };

static void
fill_terms(double term[TERMS], const driven *d, const double range[2], size_t i)
{
    const double at = (d->x[i] - range[0]) / (range[1] - range[0]) * (PLACES - 1);
    for (int k = 0; k < PLACES; k++)
        term[k] = fmax(1 - fabs(at - k), 0);
    term[PLACES] = d->v[i];
    term[PLACES + 1] = d->v[i] * fabs(d->v[i]);
    term[PLACES + 2] = d->a[i];
}

/* The mean square that a spring of any shape and a damper leave of what the null leaves, and its parts of blocks
 * of time, to which they were not fitted. */
static double
find_spring(double spring[BLOCKS], const driven *d, const double *left)
{
    double range[2], term[TERMS], sum = 0, count = 0;
    gsl_stats_minmax(&range[0], &range[1], d->x, 1, d->n);
    for (size_t i = 0; i < d->n; i++)
        count += d->used[i];
    for (size_t b = 0; b < BLOCKS; b++) {
        double h[TERMS * TERMS] = { 0 }, c[1][UNKNOWNS + COLUMNS] = { { 0 } };
        for (size_t i = 0; i < d->n; i++) {
            fill_terms(term, d, range, i);
            for (int k = 0; k < TERMS && d->used[i] && i * BLOCKS / d->n != b; k++) {
                for (int l = 0; l <= k; l++)
                    h[k * TERMS + l] += term[k] * term[l];
                c[0][k] += term[k] * left[i];
            }
        }
        ss_driven_solve(h, TERMS, c, 1);
        spring[b] = 0;
        for (size_t i = (b * d->n + BLOCKS - 1) / BLOCKS; i * BLOCKS / d->n == b; i++) {
            double rest = left[i];
            fill_terms(term, d, range, i);
            for (int k = 0; k < TERMS; k++)
                rest -= c[0][k] * term[k];
            spring[b] += d->used[i] * rest * rest / count;
        }
        sum += spring[b];
    }
    return sum;
}

/* The mean square at most of noise with these second differences, if its memory is at most MEMORY of a cycle: of
 * noise of the first order, and of white noise.  What a law fails to explain is smoother, but for few rows. */
static double
find_rough(const driven *d, const double *p, size_t turns)
{
    const double *f = d->f, memory = MEMORY * 2 * (double)d->n / (double)turns;     /* [rows] */
    double least = INFINITY, squares[DRIVEN_ROWS];
    for (size_t lag = 1; (double)lag <= memory; lag *= 2) {
        const double keep = exp(-(double)lag / memory);
        size_t n = 0;
        for (size_t i = lag; i + lag < d->n; i += 1 + d->n / DRIVEN_ROWS) {
            double by = f[i - lag] - p[i - lag] - 2 * (f[i] - p[i]) + f[i + lag] - p[i + lag];
            if (d->used[i - lag] && d->used[i] && d->used[i + lag])
                squares[n++] = by * by / (6 - 8 * keep + 2 * keep * keep);
        }
        if (n > DRIVEN_FEWEST)
            least = fmin(least, ss_wander_variance(squares, n));
    }
    return least;
}

/* The correlation of what is left with that of the partners; *noise becomes the mean square that they do not
 * share; NaN: no passage is like another. */
static double
find_repeat(const driven *d, const size_t *partner, const double *left, double *noise)
{
    double squares = 0, products = 0, differences = 0, n = 0;
    for (size_t i = 0; i < d->n; i++) {
        double other = left[partner[i]];
        if (partner[i] == i)
            continue;
        squares += (left[i] * left[i] + other * other) / 2;
        products += left[i] * other;
        differences += (left[i] - other) * (left[i] - other) / 2;
        n++;
    }
    *noise = n > 0 ? differences / n : NAN;
    return squares > 0 ? products / squares : NAN;
}

/* By how much less is left, in the mean square, if the law's own force has another size in each two cycles, as
 * friction wanders. */
static double
find_wander(const driven *d, const double *left, const double *own, size_t turns)
{
    const size_t parts = turns / 4 + 1;
    double sum = 0, n = 0;
    for (size_t k = 0; k < parts; k++) {
        double product = 0, squares = DBL_MIN;
        for (size_t i = k * d->n / parts; i < (k + 1) * d->n / parts; i++)
            if (d->used[i]) {
                product += left[i] * own[i];
                squares += own[i] * own[i];
                n++;
            }
        sum += product * product / squares;
    }
    return sum / n;
}

/* --- the numbers of the law ----------------------------------------------------------------- */

enum { AT = UNKNOWNS + COLUMNS, BESIDE = COLUMNS - VISCOUS, LATE = LAW_NUMBERS + BESIDE, NUMBERS };
/* What stands beside each law, and the delay. */
static const struct { const char *name, *unit; } beside[] = {
    { "viscous_friction", "N s/m" }, { "tilt", "N/m" }, { "inertia", "N s^2/m" }, { "sine", "N" },
    { "cosine", "N" }, { "viscous_difference", "N s/m" }, { "unevenness", "" }, { "unevenness_by_place", "1/m" },
    { "offset", "N" }, { "drift", "N/s" }, { "delay", "s" } };

/* The unit in which laws are fitted over that of the recording, of a number in this unit of scenes. */
static double
size_of_unit(const driven *d, const char *unit)
{
    double size = 1;
    for (int over = 0; *unit != '\0'; unit++) {
        double one = *unit == 'N' ? d->force : *unit == 'm' ? d->length : *unit == 's' ? d->length / d->speed : 1;
        over |= *unit == '/';
        size *= pow(over ? 1 / one : one, strncmp(unit + 1, "^2", 2) == 0 ? 2 : 1);
    }
    return size;
}

/* The same unit with those of the recording in place of N and m. */
static void
name_unit(char *text, size_t room, const char *unit, const char *force, const char *length)
{
    text[0] = '\0';
    if ((strchr(unit, 'N') != NULL && *force == '\0') || (strchr(unit, 'm') != NULL && *length == '\0'))
        return;
    for (; *unit != '\0'; unit++) {
        size_t n = strlen(text);
        if (*unit == 'N' || *unit == 'm')
            snprintf(text + n, room - n, "%s", *unit == 'N' ? force : length);
        else
            snprintf(text + n, room - n, "%c", *unit);
    }
}

/* All numbers that unknowns and amplitudes make. */
static void
list_numbers(double number[NUMBERS], const driven_law *law, const driven *d, const double at[AT])
{
    law->numbers(number, at, at + UNKNOWNS);
    memcpy(number + LAW_NUMBERS, at + UNKNOWNS + VISCOUS, BESIDE * sizeof *number);
    for (int k = UNEVEN; k <= PLACE; k++)
        number[LAW_NUMBERS + k - VISCOUS] /= at[UNKNOWNS + PART] > 0 ? at[UNKNOWNS + PART] : INFINITY;
    number[LATE] = at[DELAY] * d->step;
}

/* Find the numbers with their errors, and, if there are SI units, the scene of the law. */
static void
find_numbers(ss_motion_ranking *out, const driven_result *r, const driven *d, const char *force, const char *length)
{
    const double h = 1e-4, metres = ss_unit_in_si(length, 'm'), late = r->covariance[DELAY][DELAY];
    const driven si = { .force = ss_unit_in_si(force, 'N'), .length = metres, .speed = metres };
    const driven_law *law = r->law;
    double number[NUMBERS] = { 0 }, moved[AT][NUMBERS] = { { 0 } }, at[AT];
    memcpy(at, r->fit[ALL].u, sizeof r->fit[ALL].u);
    memcpy(at + UNKNOWNS, r->fit[ALL].c, sizeof r->fit[ALL].c);
    list_numbers(number, law, d, at);
    for (size_t k = 0; k < AT; k++) {
        const double was = at[k];
        at[k] += h;
        list_numbers(moved[k], law, d, at);
        at[k] = was;
    }
    for (size_t i = 0; i < NUMBERS; i++) {
        const int is_own = i < LAW_NUMBERS;
        const char *name = is_own ? law->number[i].name : beside[i - LAW_NUMBERS].name;
        const char *unit = is_own ? law->number[i].unit : beside[i - LAW_NUMBERS].unit;
        double variance = 0;
        if (is_own ? name == NULL : i < LATE ? number[i] == 0 : !(late > 0 && late < d->most_delay * d->most_delay))
            continue;
        for (size_t k = 0; k < AT; k++)
            for (size_t l = 0; l < AT; l++)
                variance += (moved[k][i] - number[i]) / h * (moved[l][i] - number[i]) / h * r->covariance[k][l];
        const double size = size_of_unit(d, unit);
        ss_motion_number *to = &out->number[out->n_numbers++];
        const double error = variance > 0 ? size * sqrt(variance) : NAN;
        *to = (ss_motion_number){ .name = name, .value = { size * number[i], error } };
        name_unit(to->unit, sizeof to->unit, unit, force, length);
        number[i] *= size * size_of_unit(&si, unit);
    }
    if (!(si.force > 0 && si.length > 0))
        return;
    out->scene = ss_scene_defaults;
    ss_driven_scene(&out->scene, law, number);
    if (number[LAW_NUMBERS] > 0 && ss_scene_set(&out->scene, "viscous_friction", number[LAW_NUMBERS], NULL) != SS_OK)
        out->scene.damping = number[LAW_NUMBERS];
}

/* Say what the recording cannot separate. */
static void
find_confounded(ss_motion_ranking *out, const driven_result *r, const driven *d)
{
    double xx = 0, aa = 0, xa = 0;
    for (size_t i = 0; i < d->n; i++) {
        xx += d->x[i] * d->x[i];
        aa += d->a[i] * d->a[i];
        xa += d->x[i] * d->a[i];
    }
    if (fabs(xa) > 0.98 * sqrt(xx * aa))
        ss_verdict_append(out->confounded, sizeof out->confounded, "inertia with tilt (the motion is one sine)");
    if (r->law->confounded != NULL)
        ss_verdict_append(out->confounded, sizeof out->confounded, r->law->confounded);
    if (r->law->parts == 1)
        ss_verdict_append(out->confounded, sizeof out->confounded, "friction that differs by direction with offset");
}

/* --- the ranking ---------------------------------------------------------------------------- */

/* Order the rows: the one that was chosen, then by what is explained. */
static void
order_rows(ss_motion_ranking *out, const driven_result *best)
{
    for (size_t i = 0; i < out->n; i++)
        for (size_t k = i; k > 0; k--) {
            ss_motion_row *a = &out->row[k - 1], *b = &out->row[k], other = *a;
            if (strcmp(a->law, best->law->name) == 0
                || (strcmp(b->law, best->law->name) != 0 && a->explained >= b->explained))
                break;
            *a = *b;
            *b = other;
        }
}

/* The work that the law's own force takes, as a part of what it takes and gives back. */
static double
work_of(const driven_result *r, const driven *d)
{
    double taken = 0, all = 0;
    for (size_t i = 1; i < d->n; i++) {
        const double work = (r->own[i - 1] + r->own[i]) / 2 * (d->x[i] - d->x[i - 1]);
        taken += work;
        all += fabs(work);
    }
    return all > 0 ? taken / all : 1;
}

/* Rank by a record d of `turns` turns that can show a law; rows and coarse: the same, thinned, to which laws are
 * fitted. */
static ss_status
judge(ss_motion_ranking *out, const driven *d, const driven *rows, const driven *coarse, size_t turns,
      const ss_signal *signal, const size_t of[2], const ss_motion_opts *opts)
{
    driven_result *r = calloc(LAWS_MOST, sizeof *r);
    candidate c[LAWS_MOST];
    size_t *partner = malloc(rows->n * sizeof *partner), n = 0, best = 0;
    double spring[BLOCKS], line[2];
    const double power = ss_driven_line(line, rows, rows->f);
    out->predicted = malloc(signal->n * sizeof *out->predicted);
    ss_status st = r != NULL && partner != NULL && out->predicted != NULL
        ? find_partners(rows, partner) : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && ss_driven_law(i) != NULL; i++) {
        const driven_law *law = ss_driven_law(i);
        const char *const *without = opts->without;
        double noise;
        while (without != NULL && *without != NULL && strcmp(*without, law->name) != 0)
            without++;
        if (without != NULL && *without != NULL)
            continue;
        st = ss_driven_fit(&r[n], law, rows, coarse);
        if (st == SS_OK)
            st = ss_progress_at(&opts->progress, (double)(i + 1) / LAWS_MOST);
        if (st == SS_OK)
            st = ss_driven_predict(out->predicted, law, d, &r[n].fit[ALL]);
        if (st != SS_OK)
            break;
        const double repeat = find_repeat(rows, partner, r[n].left, &noise);
        const double rough = find_rough(d, out->predicted, turns) + find_wander(rows, r[n].left, r[n].own, turns);
        c[n] = (candidate){ .name = law->name, .law = 1u << i, .contains = law->contains,
            .left = r[n].loss / power, .block = r[n].block, .fitted = r[n].fit[ALL].loss / power,
            .noise = noise / power, .rough = rough / power, .work = work_of(&r[n], rows) };
        out->row[n] = (ss_motion_row){ .law = law->name, .explained = 1 - c[n].left, .repeat = repeat,
            .gain = 1 - r[n].loss / r[0].loss,
            .explained_error = ss_verdict_error(r[n].block, NULL) / power };
        n++;
    }
    out->n = n;
    if (st == SS_OK) {
        c[n] = (candidate){ .left = find_spring(spring, rows, r[0].left) / power, .block = spring };
        out->verdict = ss_verdict_find(out->answer, sizeof out->answer, c, n, power, &best);
        for (size_t i = 0; i < n; i++) {
            out->row[i].tied = c[i].tied;
            out->row[i].residual = c[i].excess;
        }
        st = ss_driven_predict(out->predicted, r[best].law, d, &r[best].fit[ALL]);
    }
    if (st == SS_OK) {
        out->rows = signal->n;
        for (size_t i = 0; i < d->n; i++)
            out->predicted[i] *= d->sign * d->force;
        order_rows(out, &r[best]);
        if (out->verdict == SS_NAMED) {
            const char *unit = signal->head->column[of[0]].unit, *per_second = strstr(unit, "/s");
            char length[64];
            int letters = opts->is_velocity && per_second != NULL ? (int)(per_second - unit) : (int)strlen(unit);
            snprintf(length, sizeof length, "%.*s", letters, unit);
            find_numbers(out, &r[best], d, signal->head->column[of[1]].unit, length);
        }
        find_confounded(out, &r[best], rows);
    }
    for (size_t i = 0; r != NULL && i <= n && i < LAWS_MOST; i++)
        free(r[i].left);
    free(partner);
    free(r);
    return st;
}

/* Rank, or say why the n rows of time, motion and force, those of the signal that are not missing, show no law. */
static ss_status
rank_rows(ss_motion_ranking *r, double *const column[3], const char *missing, size_t n, const ss_signal *signal,
          const size_t of[2], const ss_motion_opts *opts)
{
    driven d = { 0 }, rows = { 0 }, coarse = { 0 };
    char why[128];
    size_t turns = 0, used[FOLDS] = { 0 };
    ss_status st = SS_OK;
    snprintf(why, sizeof why, "it has %zu rows, fewer than %d", n, DRIVEN_FEWEST);
    if (n >= DRIVEN_FEWEST && (st = ss_driven_new(&d, column[0], column[1], column[2], n, opts)) == SS_OK) {
        turns = ss_driven_turns(&d, fmax(LITTLE, d.least), NULL);
        find_doubt(why, sizeof why, &d, turns);
        if (why[0] == '\0') {
            const double span = d.t[d.n - 1] * (1 + 1e-9);
            d.pieces = 2 / span;
            r->interleaved = opts->folds == SS_FOLDS_INTERLEAVED
                || (opts->folds == SS_FOLDS_BY_RANGE && fold_ratio(&d) > OTHER_RANGE);
            if (r->interleaved)
                d.pieces = fmax(4, fmin((double)(turns / 4 * 2), 16)) / span;   /* of at least a cycle */
            for (size_t i = 0; i < d.n; i++)
                used[driven_fold(&d, i)] += (size_t)d.used[i];
            if (fold_ratio(&d) > (r->interleaved ? 2 : 1) * OTHER_RANGE)
                snprintf(why, sizeof why, "the two %s visit other ranges of the motion",
                         r->interleaved ? "folds" : "halves");
            else if (used[0] < DRIVEN_FEWEST / 4 || used[1] < DRIVEN_FEWEST / 4)
                snprintf(why, sizeof why, "where the motion goes is lost in its noise");
        }
        if (why[0] == '\0' && (st = ss_driven_thin(&rows, &d, DRIVEN_ROWS)) == SS_OK)
            st = ss_driven_thin(&coarse, &d, COARSE);
    }
    r->sign = d.sign;
    r->clipped = d.clipped;
    if (st == SS_OK && why[0] != '\0') {
        r->verdict = SS_NOT_JUDGED;
        snprintf(r->answer, sizeof r->answer, "not judged: %s", why);
    } else if (st == SS_OK)
        st = judge(r, &d, &rows, &coarse, turns, signal, of, opts);
    if (st == SS_OK && r->rows > 0)         /* to their places; what is missing leaves nothing */
        for (size_t i = signal->n, k = n; i-- > 0;)
            r->predicted[i] = missing == NULL || !missing[i] ? r->predicted[--k]
                : signal->values[of[1] * signal->n + i];
    ss_driven_free(&d);
    ss_driven_free(&rows);
    ss_driven_free(&coarse);
    return st;
}

ss_status
ss_motion_ranking_new(ss_motion_ranking **out, const ss_signal *signal, size_t motion, size_t force,
                      const ss_motion_opts *given, ss_error *err)
{
    ss_motion_opts opts;
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_options_take(&opts, sizeof opts, &defaults, given, err);
    if (st == SS_OK && (motion >= signal->head->n_columns || force >= signal->head->n_columns))
        return ss_fail_column(err, motion >= signal->head->n_columns ? motion : force, signal->head->n_columns);
    if (st == SS_OK && !(opts.delay >= 0 && opts.delay <= 100 && isfinite(opts.angle)))
        return ss_fail(err, SS_EINVAL, "delay %g is out of range 0 ... 100", opts.delay);
    if (st != SS_OK)
        return st;
    const size_t of[2] = { motion, force }, all = signal->n;
    size_t n = 0;
    double *room = malloc((3 * all + 1) * sizeof *room), *const column[3] = { room, room + all, room + 2 * all };
    char *missing = NULL;
    ss_motion_ranking *r = calloc(1, sizeof *r);
    if (r != NULL)
        r->time = malloc((all + 1) * sizeof *r->time);
    st = room != NULL && r != NULL && r->time != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK)
        st = ss_gaps_missing(&missing, signal);
    if (st != SS_OK)
        ss_fail(err, st, "%s", ss_strerror(st));
    for (size_t i = 0; st == SS_OK && i < all; i++) {
        double t = opts.time != NULL ? opts.time[i] : (double)i / signal->head->rate;
        double x = signal->values[motion * all + i], f = signal->values[force * all + i];
        r->time[i] = t;
        if (!(isfinite(x) && isfinite(f) && isfinite(t)))
            st = ss_fail(err, SS_EDATA, "row %zu is not finite", i + 1);
        else if (i > 0 && !(t > r->time[i - 1]))
            st = ss_fail(err, SS_EINVAL, "the time of row %zu is not after that of the row before", i + 1);
        if (missing != NULL && missing[i])
            continue;
        column[0][n] = t;
        column[1][n] = x;
        column[2][n++] = f;
    }
    if (st == SS_OK) {
        st = rank_rows(r, column, missing, n, signal, of, &opts);
        if (st != SS_OK)
            ss_fail(err, st, "%s", ss_strerror(st));
    }
    free(room);
    free(missing);
    if (st == SS_OK)
        *out = r;
    else
        ss_motion_ranking_free(r);
    return st;
}

void
ss_motion_ranking_free(ss_motion_ranking *ranking)
{
    if (ranking == NULL)
        return;
    free(ranking->time);
    free(ranking->predicted);
    free(ranking);
}

/* --- its text ------------------------------------------------------------------------------- */

/* Write the answer, and the numbers of the law that is named. */
static void
write_answer(struct rows *rows, const ss_motion_ranking *r)
{
    ss_rows_whole_word(rows, "answer", r->answer);
    if (r->n > 0)
        ss_rows_whole_value(rows, "explained", (ss_value){ r->row[0].explained, r->row[0].explained_error }, "",
                            5);
    for (size_t i = 0; i < r->n_numbers; i++)
        ss_rows_whole_value(rows, r->number[i].name, r->number[i].value, r->number[i].unit, 5);
    if (r->confounded[0] != '\0')
        ss_rows_whole_word(rows, "confounded", r->confounded);
}

static void
write_row(struct rows *rows, const ss_motion_ranking *r, size_t i)
{
    enum { DIGITS = 4 };
    const ss_motion_row *row = &r->row[i];
    ss_rows_count(rows, "rank", i + 1);
    ss_rows_word(rows, "law", row->law);
    ss_rows_rounded(rows, "explained", "", row->explained, DIGITS);
    ss_rows_rounded(rows, "gain", "", row->gain, DIGITS);
    ss_rows_rounded(rows, "residual", "", row->residual, DIGITS);
    ss_rows_rounded(rows, "repeat", "", row->repeat, DIGITS);
    ss_rows_count(rows, "tied", (size_t)row->tied);
    if (!rows->format->has_notes)
        write_answer(rows, r);
    ss_rows_end(rows);
}

ss_status
ss_motion_ranking_write(const ss_motion_ranking *r, FILE *out, ss_format format, ss_error *err)
{
    struct rows rows;
    if (r == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_rows_begin(&rows, out, format, SS_KIND_RANKING, err);
    if (st != SS_OK)
        return st;
    if (rows.format->has_notes)
        write_answer(&rows, r);
    if (r->n > 0) {
        ss_rows_note(&rows, "force: %s on what moves", r->sign < 0 ? "as it acts" : "opposite to that");
        ss_rows_note(&rows, "folds: %s", r->interleaved ? "interleaved" : "halves");
    }
    if (r->clipped > 0)
        ss_rows_note(&rows, "clipped: %zu rows, left out", r->clipped);
    write_row(&rows, r, 0);         /* the names */
    for (size_t i = 0; i < r->n + (r->n == 0 && !rows.format->has_notes); i++)
        write_row(&rows, r, i);
    return ss_rows_finish(&rows, err);
}
