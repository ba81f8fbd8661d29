/* driven_rank.c -- which friction law a recording of motion and force follows.
 *
 * * Each law is fitted to one fold of the recording and judged by what it leaves of the other (driven_fit.c).  The
 * simplest law that is as good as the best is named, unless another law as good does not contain it, or what is
 * left is no noise.
 *
 * * What is left is compared with the noise, which is unknown, but at most the least of three estimates.  Motions
 * that repeat: what differs between rows of two passages through nearly the same place, by position, speed and the
 * last two turns; a law's memory is no longer than that.  Laws that are not in the list: what a free law leaves of
 * blocks of time to which it was not fitted.  Other motions: noise of short memory is as rough as its power says, and
 * what a law fails to explain is smoother.  A law is named if its own error is less than the noise: if what it leaves
 * has less than twice the power. */
#include "fit/driven.h"
#include "fit/column.h"
#include "fit/wander.h"

#include <float.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/number.h"
#include "base/options.h"
#include "base/progress.h"
#include "io/record.h"
#include "signal/gaps.h"
#include "signal/header.h"

enum { ROWS = 2000, COARSE = 800 };     /* rows that fits and searches look at */
enum { FEWEST = 200 };                  /* rows to be judged */
#define AS_GOOD 0.03                    /* of the least loss: laws that differ by less are as good */
#define TURN 0.1                        /* of the rms motion: a turn that a contact remembers */
#define EXPLAINED 0.8                   /* of the power, by a law that is named */
#define BEYOND_NOISE 2                  /* times the noise is left: the error of the law is as large as the noise */
#define QUIET 1e-5                      /* of the power: an error of what the motion does between rows */
#define MEMORY (1. / 16)                /* of noise, at most, in cycles */
#define SHARED 1e-4                     /* ridge of the terms of a free law, which are alike */
#define OTHER_RANGE 1.25                /* ratio of the rms motion in two folds that are not alike */

static const ss_motion_opts defaults = { .size = sizeof defaults, .delay = 1 };

void
ss_motion_opts_init(ss_motion_opts *opts, size_t size)
{
    ss_options_init(opts, size, &defaults, sizeof defaults);
}

/* --- folds --------------------------------------------------------------------------------- */

/* The ratio of the rms motions in the two folds, at least 1. */
static double
fold_ratio(const driven *d, const char *fold)
{
    double sum[FOLDS] = { 0 }, squares[FOLDS] = { 0 }, n[FOLDS] = { 0 }, variance[FOLDS];
    for (size_t i = 0; i < d->n; i++) {
        sum[(int)fold[i]] += d->x[i];
        squares[(int)fold[i]] += d->x[i] * d->x[i];
        n[(int)fold[i]]++;
    }
    for (int k = 0; k < FOLDS; k++)
        variance[k] = squares[k] / n[k] - sum[k] / n[k] * (sum[k] / n[k]);
    return sqrt(fmax(variance[0], variance[1]) / fmin(variance[0], variance[1]));
}

/* Divide the rows into so many pieces, every other of which is one fold. */
static void
divide(const driven *d, size_t pieces, char *fold)
{
    for (size_t i = 0; i < d->n; i++)
        fold[i] = (char)(d->t[i] / (d->t[d->n - 1] * (1 + 1e-9)) * (double)pieces) % 2;
}

/* Choose the folds.  Returns 1 if the two are not alike. */
static int
choose_folds(const driven *d, ss_folds how, size_t turns, char *fold, int *interleaved)
{
    divide(d, 2, fold);
    *interleaved = how == SS_FOLDS_INTERLEAVED || (how == SS_FOLDS_BY_RANGE && fold_ratio(d, fold) > OTHER_RANGE);
    if (*interleaved) {
        size_t pieces = turns / 4 * 2;          /* of at least a cycle */
        divide(d, pieces < 4 ? 4 : pieces > 16 ? 16 : pieces, fold);
    }
    return fold_ratio(d, fold) > (*interleaved ? 2 : 1) * OTHER_RANGE;
}

/* --- what the motion can show -------------------------------------------------------------- */

/* Why it shows no law, or an empty text. */
static void
find_doubt(char *why, size_t room, const driven *d, size_t turns)
{
    size_t moving = 0;
    double most = 0, range[BLOCKS][2];
    why[0] = '\0';
    if (!isfinite(d->length + d->speed + d->force))
        snprintf(why, room, "its numbers are too large");
    else if (!(d->length > 0 && d->speed > 0 && d->force > 0))
        snprintf(why, room, "%s is constant", d->length > 0 && d->speed > 0 ? "the force" : "the motion");
    else if (d->n < FEWEST)
        snprintf(why, room, "it has %zu rows, fewer than %d", d->n, FEWEST);
    else if (d->least > 1)
        snprintf(why, room, "the motion is noise");
    else if (turns < 2)
        snprintf(why, room, "the motion goes in one direction only");
    else if (turns < 4)
        snprintf(why, room, "the motion turns only %zu times", turns);
    if (why[0] != '\0')
        return;
    for (size_t b = 0; b < BLOCKS; b++)
        range[b][0] = INFINITY, range[b][1] = -INFINITY;
    for (size_t i = 0; i < d->n; i++) {
        double *r = range[i * BLOCKS / d->n];
        r[0] = fmin(r[0], d->x[i]);
        r[1] = fmax(r[1], d->x[i]);
    }
    for (size_t b = 0; b < BLOCKS; b++)
        most = fmax(most, range[b][1] - range[b][0]);
    for (size_t b = 0; b < BLOCKS; b++)
        moving += range[b][1] - range[b][0] > TURN * most;
    if (2 * moving < BLOCKS)
        snprintf(why, room, "the motion is mostly rest");
}

/* --- what is left, and the noise ----------------------------------------------------------- */

/* For each row the row of another passage that is nearest to it, or the row itself if it is left out. */
static ss_status
find_partners(const driven *d, size_t *partner)
{
    double (*place)[4] = malloc(d->n * sizeof *place);
    size_t *passage = malloc(d->n * sizeof *passage), turns = 0;
    char *is_turn = malloc(d->n);
    if (place == NULL || passage == NULL || is_turn == NULL) {
        free(place);
        free(passage);
        free(is_turn);
        return SS_ENOMEM;
    }
    ss_driven_turns(d, fmax(TURN, d->least), is_turn);
    for (size_t i = 0, last = 0, before = 0; i < d->n; i++) {
        if (is_turn[i]) {
            before = last;
            last = i;
            turns++;
        }
        place[i][0] = d->x[i];
        place[i][1] = d->v[i];
        place[i][2] = d->x[last];
        place[i][3] = d->x[before];
        passage[i] = turns;
    }
    for (size_t i = 0; i < d->n; i++) {
        double nearest = INFINITY;
        partner[i] = i;
        for (size_t j = 0; j < d->n && d->used[i]; j++) {
            double distance = 0;
            if (!d->used[j] || (passage[j] <= passage[i] + 1 && passage[i] <= passage[j] + 1))
                continue;
            for (int k = 0; k < 4; k++)
                distance += (place[i][k] - place[j][k]) * (place[i][k] - place[j][k]);
            if (distance < nearest) {
                nearest = distance;
                partner[i] = j;
            }
        }
    }
    free(place);
    free(passage);
    free(is_turn);
    return SS_OK;
}

/* A hat function of the k-th knot, at k, of x. */
static double
hat(double x, double k)
{
    return fmax(1 - fabs(x - k), 0);
}

/* The terms of a free law: sliders of many lengths, free functions of the speed, of the place, and of the law's own
 * force in either direction. */
enum { SLIDERS = 8, SPEEDS = 6, PLACES = 8, FORCES = 8, TERMS = SLIDERS + SPEEDS + PLACES + 2 * FORCES };

static void
fill_terms(double (*term)[TERMS], const driven *d, const double *own)
{
    double slider[SLIDERS] = { 0 }, least = own[0], most = own[0];
    for (size_t i = 0; i < d->n; i++) {
        least = fmin(least, own[i]);
        most = fmax(most, own[i]);
    }
    for (size_t i = 0; i < d->n; i++) {
        double length = 0.02, speed = asinh(fabs(d->v[i]) / 0.05) * SPEEDS / 5, *at = term[i];
        for (int k = 0; k < SLIDERS; k++, length *= 2)
            *at++ = slider[k] = fmax(-1, fmin(slider[k] + (i > 0 ? d->x[i] - d->x[i - 1] : 0) / length, 1));
        for (int k = 0; k < SPEEDS; k++)
            *at++ = copysign(hat(speed, k), d->v[i]);
        for (int k = 0; k < PLACES; k++)
            *at++ = hat((d->x[i] + 2) * PLACES / 4, k + 0.5);
        for (int k = 0; k < 2 * FORCES; k++)
            *at++ = (d->v[i] > 0) == k % 2 && most > least
                ? hat((own[i] - least) / (most - least) * (FORCES - 1), k / 2) : 0;
    }
}

/* Add the products of the terms of some rows with each other and with what is left of these, times `by`. */
static void
add_products(double sum[TERMS + 1][TERMS], double (*term)[TERMS], const driven *d, const double *left, size_t from,
             size_t end, double by)
{
    for (size_t i = from; i < end; i++)
        for (int k = 0; k <= TERMS && d->used[i]; k++)
            for (int l = 0; l <= k && l < TERMS; l++)
                sum[k][l] += by * (k < TERMS ? term[i][k] : left[i]) * term[i][l];
}

/* The mean square that no law could explain: what such terms, fitted to other times, leave of each block. */
static ss_status
find_unexplained(const driven *d, const double *left, const double *own, double *noise)
{
    double (*term)[TERMS] = malloc(d->n * sizeof *term), sum[TERMS + 1][TERMS] = { { 0 } }, count = 0;
    if (term == NULL)
        return SS_ENOMEM;
    fill_terms(term, d, own);
    add_products(sum, term, d, left, 0, d->n, 1);
    *noise = 0;
    for (size_t b = 0; b < BLOCKS; b++) {
        const size_t from = b * d->n / BLOCKS, end = (b + 1) * d->n / BLOCKS;
        double others[TERMS + 1][TERMS];
        memcpy(others, sum, sizeof sum);
        add_products(others, term, d, left, from, end, -1);
        for (int k = 0; k < TERMS; k++)
            others[k][k] += SHARED * sum[k][k] + DBL_MIN;
        gsl_matrix_view A = gsl_matrix_view_array(others[0], TERMS, TERMS);
        gsl_vector_view C = gsl_vector_view_array(others[TERMS], TERMS);
        gsl_linalg_cholesky_decomp1(&A.matrix);
        gsl_linalg_cholesky_svx(&A.matrix, &C.vector);
        for (size_t i = from; i < end; i++) {
            double rest = left[i];
            for (int k = 0; k < TERMS; k++)
                rest -= others[TERMS][k] * term[i][k];
            *noise += d->used[i] * rest * rest;
            count += d->used[i];
        }
    }
    *noise /= count;
    free(term);
    return SS_OK;
}

/* The mean square at most of noise with these second differences, if its memory is at most MEMORY of a cycle: of
 * noise of the first order, and of white noise.  What a law fails to explain is smoother, but for few rows.
 * room: for ROWS numbers. */
static double
find_rough(const driven *d, const double *predicted, size_t turns, double *room)
{
    const double *f = d->f, *p = predicted, memory = MEMORY * 2 * (double)d->n / (double)turns;     /* [rows] */
    double least = INFINITY;
    for (size_t lag = 1; (double)lag <= memory; lag *= 2) {
        const double keep = exp(-(double)lag / memory);
        size_t n = 0;
        for (size_t i = lag; i + lag < d->n; i += 1 + d->n / ROWS) {
            double by = f[i - lag] - p[i - lag] - 2 * (f[i] - p[i]) + f[i + lag] - p[i + lag];
            if (d->used[i - lag] && d->used[i] && d->used[i + lag])
                room[n++] = by * by / (6 - 8 * keep + 2 * keep * keep);
        }
        if (n > FEWEST / 2)
            least = fmin(least, ss_wander_variance(room, n));
    }
    return least;
}

/* The correlation of what is left with that of the partners; *noise becomes the mean square that they do not
 * share. */
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

/* --- the answer ---------------------------------------------------------------------------- */

static int
contains(const driven_law *a, const driven_law *b)
{
    return a->contains >> (b - ss_driven_law(0)) & 1;
}

/* The standard error of a sum over blocks. */
static double
block_error(const double *a, const double *b)
{
    double sum = 0, squares = 0;
    for (size_t k = 0; k < BLOCKS; k++) {
        double x = a[k] - (b != NULL ? b[k] : 0);
        sum += x;
        squares += x * x;
    }
    return sqrt(fmax(squares - sum * sum / BLOCKS, 0) * BLOCKS / (BLOCKS - 1));
}

static double
power_of(const driven *d)
{
    double sum = 0, squares = 0, n = 0;
    for (size_t i = 0; i < d->n; i++)
        if (d->used[i]) {
            sum += d->f[i];
            squares += d->f[i] * d->f[i];
            n++;
        }
    return (squares - sum * sum / n) / n;
}

static int
is_smallest(const driven_result *r, size_t n, const int *tied, size_t i)
{
    for (size_t k = 0; k < n; k++)
        if (tied[k] && k != i && contains(r[i].law, r[k].law))
            return 0;
    return tied[i];
}

static void
append(char *text, size_t room, const char *word)
{
    size_t n = strlen(text);
    snprintf(text + n, room - n, "%s%s", n > 0 ? ", " : "", word);
}

/* Decide by what the laws leave; *best becomes the row that is named, or that explains most. */
static void
decide(ss_motion_ranking *out, const driven_result *r, size_t n, const double noise[], double power, size_t *best)
{
    int tied[LAWS_MOST];
    size_t named = n, count = 0;
    char names[128] = "";
    *best = 0;
    for (size_t i = 1; i < n; i++)
        if (r[i].loss < r[*best].loss)
            *best = i;
    for (size_t i = 0; i < n; i++) {
        double most = r[*best].loss, error = 2 * block_error(r[i].block, r[*best].block);
        tied[i] = r[i].loss - most <= fmax(fmin(error, most), fmax(AS_GOOD * most, RESIDUE_QUIET * power));
    }
    for (size_t i = 0; i < n; i++) {
        out->row[i].tied = tied[i];
        if (is_smallest(r, n, tied, i)) {
            named = i;
            count++;
            append(names, sizeof names, r[i].law->name);
        }
    }
    double explained = 1 - r[*best].loss / power;
    char number[SS_NUMBER_MAX], times[SS_NUMBER_MAX];
    ss_number_fixed(number, explained, 4);
    if (tied[0] || explained < EXPLAINED) {
        out->verdict = SS_NONE_FITS;
        snprintf(out->answer, sizeof out->answer, "none of these: %s%s explains %s of the force that was held out",
                 tied[0] ? "no law explains more than the null; " : "", r[*best].law->name, number);
    } else if (r[count == 1 ? named : *best].fit[ALL].loss > BEYOND_NOISE * noise[count == 1 ? named : *best]) {
        out->verdict = SS_NONE_FITS;
        snprintf(out->answer, sizeof out->answer, "none of these: %s explains most, %s of the force that was "
                 "held out, but leaves %s times the noise", r[*best].law->name, number,
                 ss_number_rounded(times, r[*best].fit[ALL].loss / noise[*best], 3));
    } else if (count > 1) {
        out->verdict = SS_UNDECIDED;
        snprintf(out->answer, sizeof out->answer, "cannot tell: %s", names);
    } else {
        out->verdict = SS_NAMED;
        *best = named;
        snprintf(out->answer, sizeof out->answer, "%s explains %s of the force that was held out",
                 r[named].law->name, ss_number_fixed(number, 1 - r[named].loss / power, 4));
    }
}

/* --- the numbers of the law ----------------------------------------------------------------- */

/* What stands beside each law. */
static const struct { const char *name, *unit; } beside[COLUMNS] = {
    [VISCOUS] = { "viscous_friction", "N s/m" }, [OFFSET] = { "offset", "N" }, [TILT] = { "tilt", "N/m" },
    [INERTIA] = { "inertia", "N s^2/m" }, [SINE] = { "sine", "N" }, [COSINE] = { "cosine", "N" } };

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
    for (; *unit != '\0'; unit++) {
        size_t n = strlen(text);
        if (*unit == 'N' || *unit == 'm')
            snprintf(text + n, room - n, "%s", *unit == 'N' ? force : length);
        else
            snprintf(text + n, room - n, "%c", *unit);
    }
}

/* Add a number with its error, whose slopes by the unknowns and amplitudes these are. */
static void
add_number(ss_motion_ranking *out, const char *name, double value, const double slope[], const driven_result *r,
           const char *unit, const char *force, const char *length)
{
    double variance = 0;
    ss_motion_number *number = &out->number[out->n_numbers++];
    for (size_t k = 0; k < UNKNOWNS + COLUMNS; k++)
        for (size_t l = 0; l < UNKNOWNS + COLUMNS; l++)
            variance += slope[k] * slope[l] * r->covariance[k][l];
    *number = (ss_motion_number){ .name = name, .value = { value, sqrt(fmax(variance, 0)) } };
    name_unit(number->unit, sizeof number->unit, unit, force, length);
}

/* The scene of the law, in SI units; none if these cannot be found. */
static void
make_scene(ss_motion_ranking *out, const driven_law *law, double number[], const char *force, const char *length)
{
    const double metres = ss_unit_in_si(length, 'm');
    const driven si = { .force = ss_unit_in_si(force, 'N'), .length = metres, .speed = metres };
    if (!(si.force > 0 && si.length > 0))
        return;
    for (size_t i = 0; i < LAW_NUMBERS && law->number[i].name != NULL; i++)
        number[i] *= size_of_unit(&si, law->number[i].unit);
    out->scene = ss_scene_defaults;
    ss_driven_scene(&out->scene, law, number);
    for (size_t i = 0; i < out->n_numbers; i++)
        if (strcmp(out->number[i].name, "viscous_friction") == 0) {
            double viscous = out->number[i].value.value * size_of_unit(&si, "N s/m");
            if (ss_scene_set(&out->scene, "viscous_friction", viscous, NULL) != SS_OK)
                out->scene.damping = viscous;
        }
}

static void
find_numbers(ss_motion_ranking *out, const driven_result *r, const driven *d, const char *force,
             const char *length)
{
    enum { N = UNKNOWNS + COLUMNS };
    const driven_fit *fit = &r->fit[ALL];
    double slope[LAW_NUMBERS][N] = { { 0 } }, number[LAW_NUMBERS], moved[LAW_NUMBERS], at[N];
    memcpy(at, fit->u, sizeof fit->u);
    memcpy(at + UNKNOWNS, fit->c, sizeof fit->c);
    r->law->numbers(number, at, at + UNKNOWNS);
    for (size_t k = 0; k < N; k++) {
        const double h = 1e-4, was = at[k];
        at[k] += h;
        r->law->numbers(moved, at, at + UNKNOWNS);
        at[k] = was;
        for (size_t i = 0; i < LAW_NUMBERS && r->law->number[i].name != NULL; i++)
            slope[i][k] = size_of_unit(d, r->law->number[i].unit) * (moved[i] - number[i]) / h;
    }
    for (size_t i = 0; i < LAW_NUMBERS && r->law->number[i].name != NULL; i++) {
        number[i] *= size_of_unit(d, r->law->number[i].unit);
        add_number(out, r->law->number[i].name, number[i], slope[i], r, r->law->number[i].unit, force, length);
    }
    for (size_t k = VISCOUS; k < COLUMNS; k++)
        if (r->fit[ALL].c[k] != 0) {
            const double size = size_of_unit(d, beside[k].unit);
            double by[N] = { 0 };
            by[UNKNOWNS + k] = size;
            add_number(out, beside[k].name, size * fit->c[k], by, r, beside[k].unit, force, length);
        }
    if (d->most_delay > 0) {
        double by[N] = { 0 };
        by[DELAY] = d->step * d->length / d->speed;
        add_number(out, "delay", by[DELAY] * fit->u[DELAY], by, r, "s", force, length);
    }
    make_scene(out, r->law, number, force, length);
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
        append(out->confounded, sizeof out->confounded, "inertia with tilt (the motion is one sine)");
    if (r->law->parts == 1)
        append(out->confounded, sizeof out->confounded, "friction that differs by direction with offset");
}

/* --- the ranking ---------------------------------------------------------------------------- */

static int
is_without(const char *const *without, const char *name)
{
    for (; without != NULL && *without != NULL; without++)
        if (strcmp(*without, name) == 0)
            return 1;
    return 0;
}

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

/* Rank by a record that can show a law. */
static ss_status
judge(ss_motion_ranking *out, const driven *d, const driven *rows, const driven *coarse, const char *fold,
      size_t turns, const ss_signal *signal, const size_t of[2], const ss_motion_opts *opts)
{
    driven_result *r = calloc(LAWS_MOST, sizeof *r);
    size_t *partner = malloc(rows->n * sizeof *partner), n = 0, best = 0;
    double room[ROWS], noise[LAWS_MOST], power = power_of(rows), quiet = QUIET * power;
    out->predicted = malloc(signal->n * sizeof *out->predicted);
    ss_status st = r != NULL && partner != NULL && out->predicted != NULL ? find_partners(rows, partner) : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && ss_driven_law(i) != NULL; i++) {
        const driven_law *law = ss_driven_law(i);
        double unshared, unexplained;
        if (is_without(opts->without, law->name))
            continue;
        st = ss_driven_fit(&r[n], law, rows, fold, coarse, r, n);
        if (st == SS_OK)
            st = ss_progress_at(&opts->progress, (double)(i + 1) / LAWS_MOST);
        if (st != SS_OK)
            break;
        out->row[n] = (ss_motion_row){ .law = law->name, .explained = 1 - r[n].loss / power,
            .explained_error = block_error(r[n].block, NULL) / power, .gain = 1 - r[n].loss / r[0].loss,
            .repeat = find_repeat(rows, partner, r[n].left, &unshared) };
        st = find_unexplained(rows, r[n].left, r[n].own, &unexplained);
        if (st == SS_OK)
            st = ss_driven_predict(out->predicted, law, d, &r[n].fit[ALL]);
        if (st != SS_OK)
            break;
        noise[n] = fmax(quiet, fmin(find_rough(d, out->predicted, turns, room), fmin(unshared, unexplained)));
        n++;
    }
    out->n = n;
    if (st == SS_OK) {
        decide(out, r, n, noise, power, &best);
        for (size_t i = 0; i < n; i++)
            out->row[i].residual = r[i].fit[ALL].loss / noise[best];
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

/* Rank, or say why the n rows of time, motion and force show no law.  row: where each stands in the signal. */
static ss_status
rank_rows(ss_motion_ranking *r, double *const column[3], const size_t *row, size_t n, const ss_signal *signal,
          const size_t of[2], const ss_motion_opts *opts)
{
    driven d = { 0 }, rows = { 0 }, coarse = { 0 };
    char why[128], *fold = malloc(n + 1);
    size_t turns = 0;
    ss_status st = fold != NULL ? SS_OK : SS_ENOMEM;
    snprintf(why, sizeof why, "it has %zu rows, fewer than %d", n, FEWEST);
    if (st == SS_OK && n >= FEWEST) {
        st = ss_driven_new(&d, column[0], column[1], column[2], n, opts);
        turns = st == SS_OK ? ss_driven_turns(&d, fmax(TURN, d.least), fold) : 0;
        if (st == SS_OK)
            find_doubt(why, sizeof why, &d, turns);
        if (st == SS_OK && why[0] == '\0')
            st = ss_driven_thin(&rows, &d, ROWS);
        if (st == SS_OK && why[0] == '\0')
            st = ss_driven_thin(&coarse, &d, COARSE);
        if (st == SS_OK && why[0] == '\0' && choose_folds(&rows, opts->folds, turns, fold, &r->interleaved))
            snprintf(why, sizeof why, "the two %s visit other ranges of the motion",
                     r->interleaved ? "folds" : "halves");
    }
    r->sign = d.sign;
    r->clipped = d.clipped;
    if (st == SS_OK && why[0] != '\0') {
        r->verdict = SS_NOT_JUDGED;
        snprintf(r->answer, sizeof r->answer, "not judged: %s", why);
    } else if (st == SS_OK)
        st = judge(r, &d, &rows, &coarse, fold, turns, signal, of, opts);
    if (st == SS_OK && r->rows > 0)         /* to their places; what is missing leaves nothing */
        for (size_t i = signal->n, k = n; i-- > 0;)
            r->predicted[i] = k > 0 && row[k - 1] == i ? r->predicted[--k] : signal->values[of[1] * signal->n + i];
    ss_driven_free(&d);
    ss_driven_free(&rows);
    ss_driven_free(&coarse);
    free(fold);
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
    size_t *row = malloc((all + 1) * sizeof *row), n = 0;
    double *room = malloc((3 * all + 1) * sizeof *room), *const column[3] = { room, room + all, room + 2 * all };
    char *missing = NULL;
    ss_motion_ranking *r = calloc(1, sizeof *r);
    if (r != NULL)
        r->time = malloc((all + 1) * sizeof *r->time);
    st = row != NULL && room != NULL && r != NULL && r->time != NULL ? SS_OK : SS_ENOMEM;
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
        column[2][n] = f;
        row[n++] = i;
    }
    if (st == SS_OK) {
        st = rank_rows(r, column, row, n, signal, of, &opts);
        if (st != SS_OK)
            ss_fail(err, st, "%s", ss_strerror(st));
    }
    free(row);
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
    ss_rows_note(&rows, "answer: %s", r->answer);
    if (rows.format->has_notes && r->n > 0) {
        ss_rows_note_value(&rows, "explained", (ss_value){ r->row[0].explained, r->row[0].explained_error }, "", 5);
        for (size_t i = 0; i < r->n_numbers; i++)
            ss_rows_note_value(&rows, r->number[i].name, r->number[i].value, r->number[i].unit, 5);
        if (r->confounded[0] != '\0')
            ss_rows_note(&rows, "confounded: %s", r->confounded);
        ss_rows_note(&rows, "force: %s on what moves", r->sign < 0 ? "as it acts" : "opposite to that");
        ss_rows_note(&rows, "folds: %s", r->interleaved ? "interleaved" : "halves");
        if (r->clipped > 0)
            ss_rows_note(&rows, "clipped: %zu rows, left out", r->clipped);
    }
    write_row(&rows, r, 0);         /* the names */
    for (size_t i = 0; i < r->n; i++)
        write_row(&rows, r, i);
    return ss_rows_finish(&rows, err);
}
