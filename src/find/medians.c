/* medians.c -- medians over slips and sticks, with errors that count what all of these have in common.
 *
 * If the errors of single values are larger than their scatter, they are not by chance: all values have a part
 * of them in common, and this part does not become less with the number of values. */
#include "find/medians.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stddef.h>
#include <string.h>
#include "base/gauss.h"
#include "find/judgement.h"
#include "find/slip.h"

#define SHORT 0.2               /* part of the time that falls may take, so that the rest may be stick */

/* The median of the errors that are known, and their number in *known; 0: none is known. */
static double
median_error(size_t *known, const ss_value *v, size_t n, double *scratch)
{
    *known = 0;
    for (size_t i = 0; i < n; i++)
        if (isfinite(v[i].value) && isfinite(v[i].error))
            scratch[(*known)++] = v[i].error;
    return *known > 0 ? gsl_stats_median(scratch, 1, *known) : 0;
}

ss_number
ss_median_of(const ss_value *v, size_t n, double *scratch)
{
    size_t used = 0, known;
    for (size_t i = 0; i < n; i++)
        if (isfinite(v[i].value))
            scratch[used++] = v[i].value;
    if (used < 2)
        return (ss_number){ used > 0 ? scratch[0] : NAN, NAN, NAN, NULL };
    double median = gsl_stats_median(scratch, 1, used);
    for (size_t i = 0; i < used; i++)
        scratch[i] = fabs(scratch[i] - median);
    double scatter = gsl_stats_median(scratch, 1, used) / GAUSS_MEDIAN;
    double error = median_error(&known, v, n, scratch);
    double common = sqrt(fmax(0, error * error - scatter * scatter));
    return (ss_number){ median, hypot(sqrt(M_PI / 2 / (double)used) * scatter, common), scatter, NULL };
}

/* The median of one number of all loadings, which is offset bytes behind their starts; `common` is the part
 * of the variance of each that all share. */
static ss_number
median_over(const ss_features *out, size_t offset, double common, ss_value *v, double *scratch)
{
    size_t known;
    for (size_t i = 0; i < out->n; i++)
        memcpy(&v[i], (const char *)&out->loading[i] + offset, sizeof *v);
    ss_number m = ss_median_of(v, out->n, scratch);
    if (common > 0 && isfinite(m.error))
        m.error = fmax(m.error, sqrt(common) * median_error(&known, v, out->n, scratch));
    return m;
}

void
ss_loading_medians(ss_features *out, const ss_drop *drop, const double *shared, const ss_number *damping,
                   ss_value *v, double *scratch)
{
    size_t slips = 0;
    double falling = 0;
    for (size_t i = 0; i < out->n; i++) {
        slips += (size_t)isfinite(out->loading[i].drop.value);
        falling += (double)(drop[i].low - drop[i].high);
    }
    int is_typical = 2 * slips >= out->n;
    int is_short = out->n > 1 && falling <= SHORT * (double)(drop[out->n - 1].low - drop[0].high);
    if (is_typical || is_short) {
        out->number[SS_LOADING_SLOPE] = median_over(out, offsetof(ss_loading, slope), 0, v, scratch);
        out->number[SS_LOADING_STIFFNESS] = median_over(out, offsetof(ss_loading, stiffness), 0, v, scratch);
    }
    if (!is_typical)
        return;
    out->number[SS_SLIP_DAMPING] = *damping;
    const struct { ss_number *to; size_t offset; double common; } of_slips[] = {
        { &out->number[SS_DROP], offsetof(ss_loading, drop), shared[SLIP_DROP] },
        { &out->number[SS_DROP_DURATION], offsetof(ss_loading, duration), shared[SLIP_DURATION] },
        { &out->number[SS_RECURRENCE_TIME], offsetof(ss_loading, recurrence), 0 },
        { &out->number[SS_STICK_TIME], offsetof(ss_loading, stick), shared[SLIP_END] },
        { &out->number[SS_STATIC_FRICTION], offsetof(ss_loading, static_friction), shared[SLIP_TOP] },
        { &out->number[SS_FRICTION], offsetof(ss_loading, friction), shared[SLIP_MIDDLE] },
        { &out->number[SS_K_OVER_M], offsetof(ss_loading, k_over_m), shared[SLIP_K_OVER_M] },
    };
    for (size_t i = 0; i < sizeof of_slips / sizeof *of_slips; i++)
        *of_slips[i].to = median_over(out, of_slips[i].offset, of_slips[i].common, v, scratch);
    /* k/m, whose values v still holds, is a property of the rig.  If slips disagree on it by more than their
     * errors, at three standard deviations, they are not quite slips of the model: a misfit may shift all of them
     * alike, which their scatter does not show. */
    size_t known;
    ss_number *k_over_m = &out->number[SS_K_OVER_M];
    double error = sqrt(1 - shared[SLIP_K_OVER_M]) * median_error(&known, v, out->n, scratch);
    double scatter = k_over_m->scatter;
    if (known > 1 && scatter > error * (1 + SIGMAS * GAUSS_MEDIAN_ERROR / sqrt((double)known)))
        k_over_m->error = hypot(k_over_m->error, sqrt(scatter * scatter - error * error));
}

double
ss_quantile(const double *x, ss_window w, double part, double *copy)
{
    size_t n = ss_window_length(w);
    memmove(copy, x + w.first, n * sizeof *copy);
    return gsl_stats_select(copy, 1, n, (size_t)(part * (double)(n - 1)));
}

double
ss_smallest_change(const double *x, size_t n)
{
    double smallest = INFINITY;
    for (size_t i = 1; i < n; i++)
        if (x[i] != x[i - 1])
            smallest = fmin(smallest, fabs(x[i] - x[i - 1]));
    return smallest;
}

/* --- coloured residuals ---------------------------------------------------------------------- */

static double
residual(const double *y, const double *x, size_t i, double slope, double mean)
{
    return y[i] - slope * (x != NULL ? x[i] : (double)i) - mean;
}

/* The sum of products of residuals so many samples apart. */
static double
products(const double *y, const double *x, size_t n, double slope, double mean, size_t apart)
{
    double sum = 0;
    for (size_t i = apart; i < n; i++)
        sum += residual(y, x, i, slope, mean) * residual(y, x, i - apart, slope, mean);
    return sum;
}

/* If neighbours are correlated by rho, as in a smooth misfit, only a part (1 - rho) / (1 + rho) of the samples
 * counts.  Noise of 1/f is correlated over longer times; the number is then the sum of the correlations, up to the
 * first that is not positive.  The larger of the two numbers is used. */
double
ss_colour(const double *y, const double *x, size_t n, double slope)
{
    double mean = 0;
    for (size_t i = 0; i < n; i++)
        mean += residual(y, x, i, slope, 0) / (double)n;
    double power = products(y, x, n, slope, mean, 0);
    if (!(power > 0))
        return 1;
    double rho = fmin(1, products(y, x, n, slope, mean, 1) / power), sum = 1;
    for (size_t k = 1; k < n / 2; k++) {
        double here = products(y, x, n, slope, mean, k) / power;
        if (!(here > 0))
            break;
        sum += 2 * here;
    }
    return fmin((double)n, fmax(sum, (1 + rho) / (1 - rho)));
}
