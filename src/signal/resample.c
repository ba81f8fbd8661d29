/* resample.c -- bring values at time stamps of any spacing to a uniform clock, by a natural cubic
 * spline through each piece between gaps. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_interp.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "signal/resample.h"

#define LONGEST 10              /* median steps; stamps farther apart have a gap between them */
#define AT_END 1e-6             /* sample periods that a sample may lie beyond the last stamp */

/* Samples of one column: sample i at from + i / rate goes to x[i * row]. */
struct target {
    double from, rate;
    double *x;
    size_t n, row;
};

/* Samples between the first and the last of n values; SS_ERANGE: one is not finite, as differences of
 * values and stamps are not. */
static ss_status
fill_piece(const struct target *to, const double *t, const double *value, size_t n)
{
    double first = ceil((t[0] - to->from) * to->rate - AT_END);
    double last = floor((t[n - 1] - to->from) * to->rate + AT_END);
    gsl_interp *spline = n > 1 ? gsl_interp_alloc(n > 2 ? gsl_interp_cspline : gsl_interp_linear, n)
                               : NULL;
    gsl_interp_accel at = { 0, 0, 0 };
    if (n > 1 && spline == NULL)
        return SS_ENOMEM;
    int good = n == 1 || gsl_interp_init(spline, t, value, n) == GSL_SUCCESS;
    for (double i = fmax(first, 0); good && i <= last && i < (double)to->n; i++) {
        double s = fmin(fmax(to->from + i / to->rate, t[0]), t[n - 1]);
        double x = n > 1 ? gsl_interp_eval(spline, t, value, s, &at) : value[0];
        to->x[(size_t)i * to->row] = x;
        good = isfinite(x);
    }
    gsl_interp_free(spline);
    return good ? SS_OK : SS_ERANGE;
}

/* One column of n values, a row apart: a spline through each piece without a gap, NaN between. */
static ss_status
fill_column(const struct target *to, const double *t, const double *value, size_t row, size_t n,
            double longest, double *kept, double *kept_t)
{
    size_t k = 0;
    ss_status st = SS_OK;
    for (size_t i = 0; i < to->n; i++)
        to->x[i * to->row] = NAN;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        int there = !isnan(value[i * row]);
        if (k > 0 && (!there || t[i] - kept_t[k - 1] > longest)) {
            st = fill_piece(to, kept_t, kept, k);
            k = 0;
        }
        kept_t[k] = t[i];
        kept[k] = value[i * row];
        k += (size_t)there;
    }
    return st == SS_OK && k > 0 ? fill_piece(to, kept_t, kept, k) : st;
}

/* The number of samples from the first stamp to the last; 0: more than memory holds. */
static size_t
count_samples(const double *t, size_t n, double rate, size_t columns)
{
    double samples = floor((t[n - 1] - t[0]) * rate + AT_END) + 1;
    return samples < (double)(SIZE_MAX / sizeof *t / columns / 2) ? (size_t)samples : 0;
}

/* A short file may not claim much memory by two time stamps that lie far apart. */
enum { MOST_SAMPLES = 1000000, MOST_PER_STAMP = 1000 };

ss_status
ss_resample(double **out, size_t *n_out, const double *t, const double *value, size_t n,
            size_t columns, double usual_step, double rate, const char *name, ss_error *err)
{
    *n_out = count_samples(t, n, rate, columns);
    *out = NULL;
    if (*n_out > MOST_SAMPLES && *n_out / MOST_PER_STAMP > n)
        return ss_fail(err, SS_EDATA, "%s: %zu time stamps would become %zu samples at %g Hz", name, n, *n_out,
                       rate);
    double *kept = malloc(2 * n * sizeof *kept);
    *out = *n_out > 0 ? malloc(*n_out * columns * sizeof **out) : NULL;
    ss_status st = kept != NULL && *out != NULL ? SS_OK : SS_ENOMEM;
    for (size_t c = 0; st == SS_OK && c < columns; c++) {
        struct target to = { t[0], rate, *out + c, *n_out, columns };
        st = fill_column(&to, t, value + c, columns, n, LONGEST * usual_step, kept, kept + n);
    }
    free(kept);
    if (st == SS_OK)
        return st;
    free(*out);
    *out = NULL;
    return ss_fail(err, st, st == SS_ERANGE ? "%s: a resampled value exceeds what a double holds"
                   : "%s: no memory for a record this long", name);
}

ss_status
ss_signal_resample(ss_signal **out, const ss_signal *signal, double rate, ss_error *err)
{
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    const ss_header *head = signal->head;
    size_t n = signal->n;
    *out = NULL;
    if (n < 2 || !(rate > 0) || !isfinite(rate))
        return ss_fail(err, SS_EINVAL, "%zu sample%s cannot be resampled at %g Hz", n,
                       n == 1 ? "" : "s", rate);
    double *t = malloc(n * sizeof *t);
    ss_header *new_head = ss_header_copy(head);
    ss_status st = t != NULL && new_head != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < n; i++)
        t[i] = head->start + (double)i / head->rate;
    size_t n_out = st == SS_OK ? count_samples(t, n, rate, head->n_columns + 1) : 0;
    if (st == SS_OK)
        new_head->rate = rate;
    if (st == SS_OK)
        st = n_out > 0 ? ss_signal_new(out, new_head, n_out) : SS_ENOMEM;
    for (size_t c = 0; st == SS_OK && c < head->n_columns; c++) {
        struct target to = { t[0], rate, (*out)->values + c * n_out, n_out, 1 };
        st = fill_piece(&to, t, signal->values + c * n, n);
    }
    ss_header_free(new_head);
    free(t);
    if (st == SS_OK)
        return st;
    ss_signal_free(*out);
    *out = NULL;
    return st == SS_ERANGE ? ss_fail(err, st, "a resampled value exceeds what a double holds")
        : ss_fail_memory(err, NULL);
}
