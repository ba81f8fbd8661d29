/* resample.c -- bring values at time stamps of any spacing to a uniform clock, by a natural cubic
 * spline through each piece between gaps.
 *
 * A value changes the spline k stamps away by less than 2^-k of itself.  So a long piece is interpolated part by
 * part, with MARGIN stamps more on either side. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_interp.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "signal/header.h"
#include "signal/source.h"

#define AT_END 1e-6             /* a sample may lie so many periods beyond the last stamp */
enum {
    MARGIN = 64,                /* rows; the effect of one so far away is below rounding */
    ROWS = 4096, VALUES = 1 << 19       /* at most so many are in memory, unless margins need more */
};

struct resampled {
    ss_source base;
    size_t columns;
    int stamped;
    double longest, first;      /* first: the time of the first row */
    int ended;                  /* 1: all rows have been read */
    size_t n, room;             /* rows in memory, and their most, which is also the most samples */
    double *stamp, **value;     /* of row i, stamp[i] and value[c][i] of each column */
    double **to;                /* where the values of the next row go; the stamps behind them */
    double *kept_stamp, *kept;  /* one piece, without a gap, of one column */
    double at;                  /* the number of the next sample */
    double **sample;            /* of each column */
};

/* Fill in the samples between the first and the last of n values.  SS_ERANGE: one of them is not finite,
 * since differences of values or of stamps overflow. */
static ss_status
fill_piece(const struct resampled *r, double *x, const double *t, const double *value, size_t n)
{
    const double rate = r->base.head->rate;
    double first = ceil((t[0] - r->first) * rate - AT_END), last = floor((t[n - 1] - r->first) * rate + AT_END);
    gsl_interp *spline = n > 1 ? gsl_interp_alloc(n > 2 ? gsl_interp_cspline : gsl_interp_linear, n)
                               : NULL;
    gsl_interp_accel at = { 0, 0, 0 };
    if (n > 1 && spline == NULL)
        return SS_ENOMEM;
    int good = n == 1 || gsl_interp_init(spline, t, value, n) == GSL_SUCCESS;
    for (double i = fmax(first, r->at); good && i <= last && i < r->at + (double)r->base.held; i++) {
        double s = fmin(fmax(r->first + i / rate, t[0]), t[n - 1]), *to = x + (size_t)(i - r->at);
        *to = n > 1 ? gsl_interp_eval(spline, t, value, s, &at) : value[0];
        good = isfinite(*to);
    }
    gsl_interp_free(spline);
    return good ? SS_OK : SS_ERANGE;
}

/* Fill in the next samples of one column: by a spline through each piece without a gap, and NaN between them. */
static ss_status
fill_column(const struct resampled *r, double *x, const double *value)
{
    size_t k = 0;
    ss_status st = SS_OK;
    for (size_t i = 0; i < r->base.held; i++)
        x[i] = NAN;
    for (size_t i = 0; st == SS_OK && i < r->n; i++) {
        int there = !isnan(value[i]);
        if (k > 0 && (!there || r->stamp[i] - r->kept_stamp[k - 1] > r->longest)) {
            st = fill_piece(r, x, r->kept_stamp, r->kept, k);
            k = 0;
        }
        r->kept_stamp[k] = r->stamp[i];
        r->kept[k] = value[i];
        k += (size_t)there;
    }
    return st == SS_OK && k > 0 ? fill_piece(r, x, r->kept_stamp, r->kept, k) : st;
}

/* Discard the rows that the next sample does not need, and read as many further ones. */
static ss_status
read_on(struct resampled *r, ss_error *err)
{
    const ss_header *own = r->base.inner->head;
    size_t drop = 0;
    while (drop + 2 * MARGIN < r->n && (r->stamp[drop + MARGIN] - r->first) * r->base.head->rate < r->at)
        drop++;
    r->n -= drop;
    memmove(r->stamp, r->stamp + drop, r->n * sizeof *r->stamp);
    for (size_t c = 0; c < r->columns; c++)
        memmove(r->value[c], r->value[c] + drop, r->n * sizeof *r->value[c]);
    while (r->n < r->room && !r->ended) {
        size_t n;
        for (size_t c = 0; c < r->columns; c++)
            r->to[c] = r->value[c] + r->n;
        r->to[r->columns] = r->stamp + r->n;
        ss_status st = ss_source_rows(r->base.inner, r->to, r->room - r->n, &n, err);
        if (st != SS_OK)
            return st;
        for (size_t i = 0; i < n && !r->stamped; i++)
            r->stamp[r->n + i] = own->start + (double)(r->base.row + i) / own->rate;
        r->ended = n == 0;
        r->n += n;
        r->base.row += n;       /* rows read, of which the last are in memory */
        if (r->at == 0)
            r->first = r->stamp[0];
    }
    if (r->ended && r->at == 0 && r->n < 2)
        return ss_fail(err, SS_EDATA, "%s: one row cannot be resampled", r->base.name);
    return SS_OK;
}

static ss_status
make_samples(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct resampled *r = (struct resampled *)s;
    ss_status st;
    (void)column, (void)max, (void)n;
    s->given = 0;
    do {
        st = read_on(r, err);
        double all = st != SS_OK ? 0            /* samples that the rows in memory determine */
            : r->ended ? ss_resample_count(r->first, r->stamp[r->n - 1], s->head->rate)
            : floor((r->stamp[r->n - 1 - MARGIN] - r->first) * s->head->rate) + 1;
        s->held = all > r->at ? (size_t)fmin(all - r->at, (double)r->room) : 0;
    } while (st == SS_OK && s->held == 0 && !r->ended);
    for (size_t c = 0; st == SS_OK && s->held > 0 && c < r->columns; c++) {
        st = fill_column(r, r->sample[c], r->value[c]);
        if (st == SS_ENOMEM)
            ss_fail_memory(err, s->name);
        else if (st == SS_ERANGE)
            ss_fail(err, st, "%s: a resampled value exceeds what a double holds", s->name);
    }
    r->at += (double)s->held;
    return st;
}

static void
rewind_samples(ss_source *s)
{
    struct resampled *r = (struct resampled *)s;
    r->n = 0;
    r->at = 0;
    r->ended = 0;
}

static void
free_samples(ss_source *s)
{
    struct resampled *r = (struct resampled *)s;
    free(r->stamp);
    free(r->value);
    free(r->sample);
    free(r->to);
}

ss_status
ss_source_resample(ss_source **s, double rate, int stamped, double longest, ss_error *err)
{
    static const struct source_calls calls = {
        .next = make_samples, .rewind = rewind_samples, .free = free_samples };
    struct resampled *r = ss_source_wrap(s, sizeof *r, &calls, err);
    if (r == NULL)
        return SS_ENOMEM;
    ss_header *head = r->base.head;
    size_t columns = r->columns = head->n_columns - (stamped != 0);
    if (stamped) {
        free(head->column[--head->n_columns].name);
        free(head->column[head->n_columns].unit);
    }
    head->rate = rate;
    r->base.length = UINT64_MAX;
    r->stamped = stamped;
    r->longest = longest;
    r->room = VALUES / columns < ROWS ? VALUES / columns : ROWS;
    r->room = r->room < 4 * MARGIN ? 4 * MARGIN : r->room;
    r->stamp = malloc(3 * r->room * sizeof *r->stamp);
    r->value = ss_columns_new(columns, r->room);
    r->sample = ss_columns_new(columns, r->room);
    r->to = malloc((columns + 1) * sizeof *r->to);
    if (r->stamp == NULL || r->value == NULL || r->sample == NULL || r->to == NULL)
        return ss_fail_memory(err, r->base.name);
    r->base.made = *r->sample;
    r->base.apart = r->room;
    r->kept_stamp = r->stamp + r->room;
    r->kept = r->kept_stamp + r->room;
    return SS_OK;
}

double
ss_resample_gap(double end, double next, double rate)
{
    double missing = floor(end * rate + AT_END) + 1;
    return missing < ceil(next * rate - AT_END) ? missing : -1;
}

double
ss_resample_count(double first, double last, double rate)
{
    return floor((last - first) * rate + AT_END) + 1;
}
