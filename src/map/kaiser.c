/* kaiser.c -- the Kaiser-Bessel kernel, which interpolates between points of a Fourier series.
 *
 * A series sum c_k exp(2 pi i nu_k t), |nu_k| <= edge < 1/2, is known at whole t.  With
 * phi(t) = I0(beta sqrt(1 - (2 t/J)^2)) on |t| <= J/2 and c_k divided by its response
 * R(nu) = J sinh(z)/z, z^2 = beta^2 - (pi J nu)^2, the sum over J points weighted with phi gives the series
 * between them but for images: R(m - nu)/R(nu), m = +-1, +-2, ...  (Fourmont 2003.)  Where the band ends in a
 * Gaussian the images near its edge are as weak as the band is there, so kernels with a lower cutoff than the
 * band's edge are tried too.  J is KAISER_TAPS: for images below rounding the widest band takes as many, whatever
 * the wavelet. */
#include <math.h>
#include "map/points.h"

/* Bessel's I0 of sqrt(4 y), by its series: all terms are positive, so it is exact to rounding.  (GSL's is not, as
 * the argument is rounded: it is some 20 here, and so is the factor of its error.) */
static double
bessel_i0(double y)
{
    double term = 1, sum = 1;
    for (int k = 1; term > 1e-17 * sum; k++) {
        term *= y / ((double)k * k);
        sum += term;
    }
    return sum;
}

/* The kernel. */
static double
at(double beta, double t)
{
    double s = 2 * t / KAISER_TAPS, y = beta * beta / 4 * (1 - s * s);
    return y < 0 ? 0 : bessel_i0(y) * beta / (KAISER_TAPS * sinh(beta));
}

double
ss_kaiser_response(double beta, double nu)
{
    double x = M_PI * KAISER_TAPS * nu, z2 = beta * beta - x * x, z = sqrt(fabs(z2));
    double r = z < 1e-4 ? 1 : z2 > 0 ? sinh(z) / z : sin(z) / z;
    return r * beta / sinh(beta);
}

/* The response, or beyond the cutoff the envelope of its ripple. */
static double
envelope(double beta, double nu)
{
    double x = M_PI * KAISER_TAPS * nu, z2 = beta * beta - x * x;
    if (z2 > 1e-8)
        return sinh(sqrt(z2)) / sqrt(z2);
    return fmin(1, 1 / sqrt(fabs(z2) + 1e-300));
}

static double
worst_image(double edge, double reach, double center, double second, double beta)
{
    enum { PLACES = 16 };
    double worst = 0;
    for (int i = 0; i <= PLACES; i++) {
        double s = (double)i / PLACES, nu = s * edge, v = s * reach, u = fmax(0, v - center);
        double size = fmax(exp(-v * v / 2), second * exp(-u * u / 2)), images = 0;
        for (int m = 1; m <= 2; m++)
            images += envelope(beta, m - nu) + envelope(beta, m + nu);
        worst = fmax(worst, size * images / envelope(beta, nu));
    }
    return worst;
}

void
ss_kaiser_choose(kaiser *out, double reach, double center, double second, double bound)
{
    out->prepared = 0;
    for (out->edge = 0.4;; out->edge *= 0.95)
        for (double part = 1; part > 0.3; part -= 0.1) {
            out->beta = 0.985 * M_PI * KAISER_TAPS * (1 - part * out->edge);
            if (worst_image(out->edge, reach, center, second, out->beta) <= bound)
                return;
        }
}

/* The polynomials go through the kernel at Chebyshev's nodes. */
void
ss_kaiser_prepare(kaiser *ker)
{
    double c[KAISER_NODES], y[KAISER_NODES];
    for (int part = 0; part < KAISER_PARTS; part++)
        for (int i = 0; i < KAISER_TAPS; i++) {
            for (int m = 0; m < KAISER_NODES; m++) {
                y[m] = cos(M_PI * (m + 0.5) / KAISER_NODES);
                double f = (part + (1 + y[m]) / 2) / KAISER_PARTS;
                c[m] = at(ker->beta, f + (KAISER_TAPS / 2 - 1 - i));
            }
            for (int order = 1; order < KAISER_NODES; order++)          /* divided differences */
                for (int m = KAISER_NODES - 1; m >= order; m--)
                    c[m] = (c[m] - c[m - 1]) / (y[m] - y[m - order]);
            for (int order = KAISER_NODES - 1; order > 0; order--)      /* coefficients of powers */
                for (int m = order - 1; m < KAISER_NODES - 1; m++)
                    c[m] -= y[order - 1] * c[m + 1];
            for (int m = 0; m < KAISER_NODES; m++)
                ker->table[part][m][i] = c[m];
        }
    ker->prepared = 1;
}

void
ss_kaiser_weights(const kaiser *ker, double f, double weight[KAISER_TAPS])
{
    int part = (int)(f * KAISER_PARTS);
    part = part < KAISER_PARTS ? part : KAISER_PARTS - 1;
    double y = 2 * (f * KAISER_PARTS - part) - 1;
    for (int i = 0; i < KAISER_TAPS; i++) {
        weight[i] = ker->table[part][KAISER_NODES - 1][i];
        for (int m = KAISER_NODES - 2; m >= 0; m--)
            weight[i] = weight[i] * y + ker->table[part][m][i];
    }
}
