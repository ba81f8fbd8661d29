/* test_morlet_integral.c -- wavelet coefficients against the integral of a continuous signal by GSL. */
#include <stdlib.h>
#include <gsl/gsl_integration.h>
#include "map/map.h"
#include "morlet_plan.h"
#include "unit.h"

/* --- the integral -------------------------------------------------------------------------- */

typedef struct wave {
    enum { COSINE, GAUSSIAN, RINGDOWN } kind;
    double f, s;                /* frequency [Hz]; width [s] or decay [1/s] */
    double first;               /* of a ringdown: the sample where it starts */
    double a, b, center;
    int imaginary;
} wave;

static double
wave_at(const wave *p, double t)
{
    switch (p->kind) {
    case COSINE:   return cos(2 * M_PI * p->f * t);
    case GAUSSIAN: return exp(-t * t / (2 * p->s * p->s)) * cos(2 * M_PI * p->f * t);
    default:       return t < 0 ? 0 : exp(-p->s * t) * cos(2 * M_PI * p->f * t);
    }
}

/* x(a u + b) conj h(u), with t = 0 one second into the record */
static double
integrand(double u, void *params)
{
    const wave *p = params;
    double h = pow(M_PI, -0.25) * exp(-u * u / 2) * wave_at(p, p->a * u + p->b - 1);
    return h * (p->imaginary ? -sin(p->center * u) : cos(p->center * u));
}

static void
integral(wave p, double w[2])
{
    gsl_integration_workspace *work = gsl_integration_workspace_alloc(2000);
    double cut = (1 - p.b) / p.a;       /* the start of a ringdown */
    cut = fmax(-12, fmin(12, cut));
    for (p.imaginary = 0; p.imaginary < 2; p.imaginary++) {
        double left = 0, right, error;
        if (p.kind != RINGDOWN)
            gsl_integration_qag(&(gsl_function){ integrand, &p }, -12, cut, 1e-14, 1e-12, 2000, 6,
                                work, &left, &error);
        gsl_integration_qag(&(gsl_function){ integrand, &p }, cut, 12, 1e-14, 1e-12, 2000, 6, work,
                            &right, &error);
        w[p.imaginary] = sqrt(p.a) * (left + right);
    }
    gsl_integration_workspace_free(work);
}

/* The largest error against the integral over all scales and translations from b_lo to b_hi,
 * relative to the largest |W| of the scale. */
static double
sampling_error(wave p, double rate, const ss_morlet_opts *opts, double b_lo, double b_hi)
{
    size_t n = (size_t)(2 * rate);
    double *x = malloc(n * sizeof *x), worst = 0;
    for (size_t i = 0; i < n; i++)
        x[i] = wave_at(&p, (double)i / rate - 1);
    if (p.kind == RINGDOWN)
        x[(size_t)rate] = p.first;
    ss_morlet *plan = plan_of(n, rate, opts);
    double *w = transform(plan, x);
    for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++) {
        const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
        size_t at, every = sc->n / 40 + 1;
        double most = largest(sc, w, &at), want[2];
        for (size_t k = 0; k < sc->n; k += every) {
            double b = ss_scale_b(sc, k), *got = w + 2 * (sc->offset + k);
            if (b < b_lo || b > b_hi)
                continue;
            p.a = sc->a, p.b = b, p.center = opts->center;
            integral(p, want);
            worst = fmax(worst, hypot(got[0] - want[0], got[1] - want[1]) / most);
        }
    }
    ss_morlet_free(plan);
    free(x);
    free(w);
    return worst;
}

static void
agrees_with_the_integral_of_what_the_sampling_resolves(void **state)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    wave tone = { .kind = COSINE, .f = 47 }, pulse = { .kind = GAUSSIAN, .f = 47, .s = 0.02 };
    (void)state;
    opts.fmin = 25, opts.fmax = 90, opts.voices = 3;   /* 8 a = 0.31 s: away from the ends */
    opts.accuracy = 1e-9;
    assert_true(sampling_error(tone, 1000, &opts, 0.4, 1.6) < 1e-9);
    assert_true(sampling_error(pulse, 1000, &opts, 0.4, 1.6) < 1e-9);
}

/* A jump that counts fully from its sample on makes the sum that of a signal which jumps half a
 * sample earlier: first order.  With half of that sample it is the trapezoidal rule: second order. */
static void
sampling_error_of_an_abrupt_start_is_of_first_order(void **state)
{
    static const struct { double first, ratio; } row[] = { { 1, 2 }, { 0.5, 4 } };
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.fmin = 40, opts.fmax = 50, opts.voices = 3, opts.accuracy = 1e-9;
    for (size_t i = 0; i < LENGTH(row); i++) {
        wave ring = { .kind = RINGDOWN, .f = 47, .s = 10, .first = row[i].first };
        double before = 0;
        for (double rate = 1000; rate <= 8000; rate *= 2) {
            double error = sampling_error(ring, rate, &opts, 0.4, 1.6);
            print_message("# start with %g of its sample, %g Hz: error %.2g of the largest |W|\n",
                          row[i].first, rate, error);
            if (before > 0 && fabs(before / error / row[i].ratio - 1) > 0.05)
                fail_msg("error %g at %g Hz, %g at half the rate", error, rate, before);
            before = error;
        }
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_integral_of_what_the_sampling_resolves),
        cmocka_unit_test(sampling_error_of_an_abrupt_start_is_of_first_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
