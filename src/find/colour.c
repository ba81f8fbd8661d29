/* colour.c -- how many samples of a residual count as one independent sample.
 *
 * If neighbours are correlated by rho, as in a smooth misfit, only a part (1 - rho) / (1 + rho) of
 * the samples counts.  Noise of 1/f is correlated over longer times; the number is then the sum of
 * the correlations, up to the first that is not positive.  The larger of the two numbers is used.
 */
#include "find/medians.h"

#include <math.h>

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
