/* slope.c -- stiffness of the contact as the slope of force over displacement.
 *
 * While the contact sticks, f = K_y x + c v + const.  Least squares of f on x would read K_y too low
 * where x is noisy, as the displacement in the stick is small: so the signal that shows the
 * oscillation serves as instrument, K_y = sum y f / sum y x with each window's means taken off,
 * whose noise has nothing to do with that of x.  v is in quadrature with x and y but for the decay,
 * which leaves an error of the order of the damping ratio squared. */
#include "find/slope.h"

#include <math.h>
#include <stdlib.h>

typedef struct sums {
    double yf, yx;
} sums;

static double
mean_of(const double *v, ss_window s)
{
    double sum = 0;
    for (size_t i = s.first; i < s.end; i++)
        sum += v[i];
    return sum / (double)(s.end - s.first);
}

ss_status
ss_slope_find(const double *f, const double *x, const double *y, const ss_window *span, size_t n,
              ss_value *slope)
{
    sums *each = malloc((n + 1) * sizeof *each), all = { 0, 0 };
    double mean = 0, scatter = 0, m = (double)n;
    *slope = (ss_value){ NAN, NAN };
    if (each == NULL)
        return SS_ENOMEM;
    for (size_t k = 0; k < n; k++) {
        double f0 = mean_of(f, span[k]), x0 = mean_of(x, span[k]), y0 = mean_of(y, span[k]);
        each[k] = (sums){ 0, 0 };
        for (size_t i = span[k].first; i < span[k].end; i++) {
            each[k].yf += (y[i] - y0) * (f[i] - f0);
            each[k].yx += (y[i] - y0) * (x[i] - x0);
        }
        all.yf += each[k].yf;
        all.yx += each[k].yx;
    }
    for (size_t k = 0; k < n; k++)
        mean += (all.yf - each[k].yf) / (all.yx - each[k].yx) / m;
    for (size_t k = 0; k < n; k++)
        scatter += pow((all.yf - each[k].yf) / (all.yx - each[k].yx) - mean, 2);
    if (n >= 2 && isfinite(all.yf / all.yx) && isfinite(scatter))
        *slope = (ss_value){ fabs(all.yf / all.yx), sqrt(scatter * (m - 1) / m) };
    free(each);
    return SS_OK;
}
