/* driven.c -- the record of a motion and a force, as friction laws need it.
 *
 * * The motion is smoothed by a cubic in a window about each row, which gives the speed and the acceleration too,
 * for stamps of any spacing.  The window is the one that predicts best the rows that it leaves out: a row, or all
 * rows about it on one count of an encoder, as these tell nothing of each other.  The force is never smoothed: what
 * is left of it must stay what was measured. */
#include "fit/driven.h"

#include <float.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/list.h"

enum { TERMS = 4, WIDEST = 64, SERIES = 5 };    /* of the cubic; half the widest window, in rows; t, x, v, a, f */
#define NOISY 1e-3                  /* of the force's range, from row to row: it is clipped, not saturated */
#define JUMP 4                      /* times the largest of four differences of noise: seldom */
#define UNKNOWN_MEMORY 0.03         /* the part of the time in which the memory of a law is not known yet */

/* The cubic about row i by the rows at most m away, but for those of a run: its value and derivatives there, and how
 * much of the row itself its value is. */
static double
smooth(const double *t, const double *x, size_t n, size_t i, size_t m, const size_t run[2], double out[3])
{
    const size_t first = i > m ? i - m : 0, end = i + m + 1 < n ? i + m + 1 : n;
    const double unit = fmax(t[end - 1] - t[i], t[i] - t[first]);
    double a[TERMS * TERMS] = { 0 }, b[TERMS] = { 0 }, own[TERMS] = { 1 };
    for (size_t k = first; k < end; k++) {
        k = k == run[0] ? run[1] : k;
        double s = (t[k] - t[i]) / unit, power[TERMS] = { 1, s, s * s, s * s * s };
        for (int p = 0; p < TERMS; p++) {
            b[p] += power[p] * (x[k] - x[i]);
            for (int q = 0; q <= p; q++)
                a[p * TERMS + q] += power[p] * power[q];
        }
    }
    gsl_matrix_view A = gsl_matrix_view_array(a, TERMS, TERMS);
    gsl_vector_view B = gsl_vector_view_array(b, TERMS), O = gsl_vector_view_array(own, TERMS);
    gsl_linalg_cholesky_decomp1(&A.matrix);
    gsl_linalg_cholesky_svx(&A.matrix, &B.vector);
    gsl_linalg_cholesky_svx(&A.matrix, &O.vector);
    out[0] = x[i] + b[0];
    out[1] = b[1] / unit;
    out[2] = 2 * b[2] / (unit * unit);
    return own[0];
}

/* The half width of the best window; *error becomes the rms difference of a row from what the others predict. */
static size_t
find_window(const double *t, const double *x, size_t n, double *error)
{
    const size_t all[2] = { n, n };
    size_t best = 0;
    *error = INFINITY;
    for (size_t m = TERMS - 1; m <= WIDEST && (best == 0 || BLOCKS * m < n); m += 1 + m / 4) {
        double sum = 0, count = 0, blind = 0, out[3];
        for (size_t i = m; i + m < n; i += 1 + 2 * n / DRIVEN_ROWS) {
            size_t run[2] = { i, i + 1 };
            while (run[0] + m > i && x[run[0] - 1] == x[i])
                run[0]--;
            while (run[1] <= i + m && x[run[1]] == x[i])
                run[1]++;
            const int is_run = run[1] - run[0] > 1;
            if (run[1] - run[0] > m) {
                blind++;
                continue;
            }
            double left = 1 - smooth(t, x, n, i, m, is_run ? run : all, out);
            left = is_run ? 1 : left;
            sum += (x[i] - out[0]) / left * ((x[i] - out[0]) / left);
            count++;
        }
        if (blind > count && m < WIDEST / 2)
            continue;
        if (best == 0 || sqrt(sum / count) < *error) {
            *error = sqrt(sum / count);
            best = m;
        }
    }
    return best;
}

static ss_status
make_room(driven *d, size_t n)
{
    d->n = n;
    d->room = calloc(SERIES * n, sizeof *d->room);
    d->used = calloc(n, 1);
    d->t = d->room;
    d->x = d->t + n;
    d->v = d->x + n;
    d->a = d->v + n;
    d->f = d->a + n;
    return d->room != NULL && d->used != NULL ? SS_OK : SS_ENOMEM;
}

void
ss_driven_free(driven *d)
{
    free(d->room);
    free(d->used);
}

/* Leave out rows at an end of the range of a noisy force if more of them stand there than chance puts on one
 * value: ten times as many as on the values next to it.  Without noise, friction itself has one value in slip. */
static ss_status
leave_out_clipped(driven *d)
{
    enum { NEXT = 4 };
    double *sorted = calloc(d->n, sizeof *sorted);
    if (sorted == NULL)
        return SS_ENOMEM;
    for (size_t i = 1; i + 1 < d->n; i++)
        sorted[i] = fabs(d->f[i - 1] - 2 * d->f[i] + d->f[i + 1]);
    const double noise = gsl_stats_median(sorted, 1, d->n);
    memcpy(sorted, d->f, d->n * sizeof *sorted);
    qsort(sorted, d->n, sizeof *sorted, ss_ascending);
    size_t squares = 0, all = 0;
    d->code = INFINITY;
    for (size_t k = 0, first = 0; k < d->n; k++)
        if (k + 1 == d->n || sorted[k + 1] != sorted[k]) {
            squares += (k + 1 - first) * (k + 1 - first);
            first = k + 1;
            all++;
            d->code = k + 1 < d->n ? fmin(d->code, sorted[k + 1] - sorted[k]) : d->code;
        }
    d->codes = all > 2 ? (double)d->n * (double)d->n / (double)squares : INFINITY;
    for (int end = 0; end < 2 && noise > NOISY * (sorted[d->n - 1] - sorted[0]); end++) {
        const double at = end ? sorted[d->n - 1] : sorted[0];
        size_t count = 0, others = 0, values = 0;
        double last = at;
        for (size_t k = 0; k < d->n && values < NEXT; k++) {
            double f = sorted[end ? d->n - 1 - k : k];
            values += f != last;
            last = f;
            count += f == at;
            others += f != at;
        }
        if (values == NEXT && count > 10 * (others / NEXT + 1))
            for (size_t i = 0; i < d->n; i++)
                if (d->f[i] == at) {
                    d->used[i] = 0;
                    d->clipped++;
                }
    }
    free(sorted);
    return SS_OK;
}

/* Does the force change within a row of row i by much more than before and after? */
static int
force_jumps(const double force[], size_t n, size_t i)
{
    double beside = 0, most = 0;
    for (size_t k = i > 3 ? i - 3 : 1; k < n && k <= i + 3; k++) {
        double *size = k + 1 >= i && k <= i + 1 ? &most : &beside;
        *size = fmax(*size, fabs(force[k] - force[k - 1]));
    }
    return most > JUMP * beside;
}

ss_status
ss_driven_new(driven *d, const double t[], const double motion[], const double force[], size_t n,
              const ss_motion_opts *opts)
{
    double error, work = 0;
    *d = (driven){ .angle = opts->angle, .most_delay = opts->delay };
    ss_status st = make_room(d, n);
    if (st != SS_OK)
        return st;
    const size_t window = find_window(t, motion, n, &error);
    for (size_t i = 0; i < n; i++) {
        double out[3];
        smooth(t, motion, n, i, window, (size_t[]){ n, n }, out);
        d->t[i] = t[i] - t[0];
        d->f[i] = force[i];
        d->used[i] = d->t[i] >= UNKNOWN_MEMORY * (t[n - 1] - t[0])      /* and the motion is known, if it is late */
            && (double)i + d->most_delay < (double)n;
        d->x[i] = out[0];
        d->v[i] = out[1];
        d->a[i] = out[2];
        if (opts->is_velocity) {
            d->a[i] = out[1];
            d->v[i] = out[0];
            d->x[i] = i == 0 ? 0 : d->x[i - 1] + (t[i] - t[i - 1]) * (d->v[i] + d->v[i - 1]) / 2;
        }
    }
    if ((st = leave_out_clipped(d)) != SS_OK)
        return st;
    const double about = gsl_stats_mean(force, 1, n);
    d->middle = gsl_stats_mean(d->x, 1, n);
    d->length = gsl_stats_sd_with_fixed_mean(d->x, 1, n, d->middle);
    d->speed = gsl_stats_sd_with_fixed_mean(d->v, 1, n, 0);
    d->force = gsl_stats_sd_with_fixed_mean(force, 1, n, about);
    d->step = (t[n - 1] - t[0]) / (double)(n - 1);
    /* of a cubic, whose slope has 75/8 times the variance of a value over the cube of the half width */
    d->slow = 3 * error * (opts->is_velocity ? 1 : sqrt(75. / 8 / pow((double)window, 3)) / d->step);
    d->least = 3 * (opts->is_velocity ? error * d->step : error);
    for (size_t i = 0; i < n; i++)
        work += (force[i] - about) * d->v[i];
    d->sign = work < 0 ? -1 : 1;            /* friction takes work from what moves */
    if (!(d->length > 0 && d->speed > 0 && d->force > 0))
        return SS_OK;
    /* where its direction is not known, and static friction not by it; */
    for (size_t i = 0, still = 0; i < n; i++) {
        still = fabs(d->v[i]) <= d->slow ? still + 1 : 0;
        size_t first = i + 1 - (still > 0), end = i + 1;
        if (still > 2 * window) {       /* beside a rest, too, over whose end the cubic is not the motion */
            first = i > 3 * window ? i - 3 * window : 0;
            end = i + 1 + window < n ? i + 1 + window : n;
        }
        memset(d->used + first, 0, end - first);
    }
    for (size_t i = 1; i < n && d->most_delay > 0; i++)
        if (((d->v[i] > 0) != (d->v[i - 1] > 0) || fabs(d->v[i]) <= d->slow) && force_jumps(force, n, i))
            memset(d->used + i - 1, 0, i + 1 < n ? 3 : 2);      /* it may do so a row earlier or later */
    const double time = d->length / d->speed;
    for (size_t i = 0; i < n; i++) {
        d->f[i] *= d->sign / d->force;
        d->x[i] = (d->x[i] - d->middle) / d->length;
        d->v[i] /= d->speed;
        d->a[i] *= time / d->speed;
        d->t[i] /= time;
    }
    d->step /= time;
    d->code /= d->force;
    d->least /= d->length;
    d->slow /= d->speed;
    return SS_OK;
}

size_t
ss_driven_turns(const driven *d, double least, char is_turn[])
{
    size_t farthest = 0, turns = 0;
    double way = 0;
    if (is_turn != NULL)
        memset(is_turn, 0, d->n);
    for (size_t i = 0; i < d->n; i++) {
        double back = d->x[farthest] - d->x[i];
        if (way == 0 && fabs(back) <= least)
            continue;
        if (way == 0)
            way = back < 0 ? 1 : -1;
        if (way * back <= 0)
            farthest = i;
        else if (way * back > least) {
            if (is_turn != NULL)
                is_turn[farthest] = 1;
            turns++;
            farthest = i;
            way = -way;
        }
    }
    return turns;
}

ss_status
ss_driven_thin(driven *thin, const driven *d, size_t most)
{
    const size_t stride = (d->n + most - 1) / most;
    char *is_turn = malloc(d->n);
    *thin = *d;
    ss_status st = make_room(thin, d->n);
    if (st != SS_OK || is_turn == NULL) {
        free(is_turn);
        return SS_ENOMEM;
    }
    /* turns that are more than noise; if these are too many, the larger ones */
    for (double by = d->least; ss_driven_turns(d, by, is_turn) > most; by = 2 * by + DBL_EPSILON)
        ;
    thin->n = 0;
    for (size_t i = 0; i < d->n; i++) {
        if (i % stride != 0 && !is_turn[i])
            continue;
        const size_t k = thin->n++;
        for (size_t c = 0; c < SERIES; c++)
            thin->room[c * d->n + k] = d->room[c * d->n + i];
        thin->used[k] = d->used[i];
    }
    free(is_turn);
    return SS_OK;
}

double
ss_driven_line(double line[2], const driven *d, const double x[])
{
    double n = 0, t = 0, tt = 0, sum = 0, product = 0, squares = 0;
    for (size_t i = 0; i < d->n; i++)
        if (d->used[i]) {
            const double s = d->t[i] - d->t[d->n - 1] / 2;
            n++;
            t += s;
            tt += s * s;
            sum += x[i];
            product += x[i] * s;
            squares += x[i] * x[i];
        }
    line[1] = (n * product - t * sum) / (n * tt - t * t);
    line[0] = (sum - line[1] * t) / n;
    return (squares - line[0] * sum - line[1] * product) / n;
}
