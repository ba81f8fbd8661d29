/* morlet_oracle.h -- the wavelet sum as stickslip/morlet.h writes it, in long double and with no
 * thought for speed, and signals that are hard on a truncated window.  For tests and benchmarks. */
#ifndef MORLET_ORACLE_H
#define MORLET_ORACLE_H

#include <float.h>
#include <math.h>
#include <stickslip.h>

/* W of n samples, tau samples after sample c.  Taps beyond 12 a are below 1e-31 and left out. */
static inline void
oracle_at(const double *x, size_t n, double rate, const ss_morlet_opts *opts, double a, double c,
          long double tau, long double w[2])
{
    const long double wc = opts->center;
    long double k = opts->admissible ? expl(-wc * wc / 2) : 0, re = 0, im = 0;
    for (size_t i = 0; i < n; i++) {
        long double u = ((i - (long double)c) - tau) / ((long double)a * rate);
        if (fabsl(u) > 12)
            continue;
        long double g = x[i] * expl(-u * u / 2);
        re += g * (cosl(wc * u) - k);
        im -= g * sinl(wc * u);
    }
    long double factor = powl(acosl(-1), -0.25L) / rate
        / (opts->norm == SS_NORM_L1 ? (long double)a : sqrtl(a));
    w[0] = re * factor;
    w[1] = im * factor;
}

/* W(a, b). */
static inline void
oracle(const double *x, size_t n, double rate, const ss_morlet_opts *opts, double a, double b,
       long double w[2])
{
    double c = rint(b * rate);
    long double tau = c / rate == b ? 0 : fmal(b, rate, -(long double)c);
    oracle_at(x, n, rate, opts, a, c, tau, w);
}

/* W at translation k of a scale.  Steps of a stepped grid are b_num samples over a whole number of at
 * most 63, exactly so though b is rounded; other steps are b_num seconds. */
static inline void
oracle_of(const double *x, size_t n, double rate, const ss_morlet_opts *opts, const ss_scale *scale,
          size_t k, long double w[2])
{
    double parts = rint(scale->b_den / rate), all = (double)k * scale->b_num;
    if (opts->dense || scale->b_den == 1 || parts < 1 || parts > 63) {
        oracle(x, n, rate, opts, scale->a, ss_scale_b(scale, k), w);
        return;
    }
    double c = floor(all / parts);
    oracle_at(x, n, rate, opts, scale->a, c, ((long double)all - c * parts) / parts, w);
}

/* What long double itself gets wrong, in units of a^1/2 max|x|: nothing where it is wider. */
static inline double
oracle_error(const ss_morlet_opts *opts)
{
    return LDBL_EPSILON * (16 + 8 * opts->center);
}

/* The largest error of a transform over the bound that stickslip/morlet.h promises, over all scales.
 * every: look at one coefficient in so many; the largest |W| is that of all coefficients got, which
 * is right to within accuracy. */
static inline double
worst_error(const ss_morlet *plan, const double *x, size_t n, double rate,
            const ss_morlet_opts *opts, const double *w, size_t every)
{
    double worst = 0, x_max = 0;
    for (size_t i = 0; i < n; i++)
        x_max = fmax(x_max, fabs(x[i]));
    for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++) {
        const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
        double unit = (opts->norm == SS_NORM_L1 ? 1 : sqrt(sc->a)) * x_max, most = 0, error = 0;
        for (size_t k = 0; k < sc->n; k++) {
            const double *got = w + 2 * (sc->offset + k);
            long double want[2];
            most = fmax(most, hypot(got[0], got[1]) / (1 + opts->accuracy));
            if (k % every != 0)
                continue;
            oracle_of(x, n, rate, opts, sc, k, want);
            error = fmax(error, (double)hypotl(got[0] - want[0], got[1] - want[1]));
        }
        double bound = opts->accuracy * most + 16 * DBL_EPSILON * unit + DBL_TRUE_MIN;
        worst = fmax(worst, (error - oracle_error(opts) * unit) / bound);
    }
    return worst;
}

/* --- signals ------------------------------------------------------------------------------- */

typedef enum kind { NOISE, TONE, IMPULSE, STEP, WEAK_BURST, OFFSET, KINDS } kind;

static const char *const kind_name[KINDS] = {
    "noise", "tone", "impulse", "step", "weak burst under a strong tone", "tone on an offset"
};

/* Fill x with n samples; frequencies relative to the rate, so any rate will do. */
static inline void
make(kind which, double *x, size_t n)
{
    unsigned long long seed = 12345;
    for (size_t i = 0; i < n; i++) {
        double t = (double)i, mid = (double)n / 2, u = (t - mid) / 40;
        seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
        double noise = (double)(seed >> 11) * 0x1p-52 - 1;
        switch (which) {
        case NOISE:      x[i] = noise; break;
        case TONE:       x[i] = cos(2 * M_PI * 0.047 * t + 1); break;
        case IMPULSE:    x[i] = i == n / 3; break;
        case STEP:       x[i] = i >= n / 3; break;
        case WEAK_BURST: x[i] = cos(2 * M_PI * 0.00125 * t)     /* 2.5 and 47 Hz at 2 kHz */
                             + 1e-5 * exp(-u * u) * cos(2 * M_PI * 0.0235 * t); break;
        default:         x[i] = 1000 + sin(2 * M_PI * 0.02 * t); break;
        }
    }
}

#endif
