/* bench_morlet.c -- error and cost of the wavelet transform, for each accuracy.
 *
 * Prints the largest error against the sum in long double, over all signals of morlet_oracle.h, as a
 * fraction of the bound promised, and the cost; then
 * what rounding alone leaves, and the cost for longer records.  Exits 1 if a bound is exceeded. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "../morlet_oracle.h"

static double
now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds for one transform of n samples at 2 kHz; its largest error over the bound into *worst. */
static double
run(kind which, size_t n, const ss_morlet_opts *opts, double *worst, size_t *coefficients)
{
    ss_morlet *plan = NULL;
    double *x = malloc(n * sizeof *x), *w, seconds;
    make(which, x, n);
    if (ss_morlet_new(&plan, n, 2000, opts, NULL) != SS_OK)
        exit(2);
    *coefficients = ss_morlet_total(plan);
    w = malloc(2 * *coefficients * sizeof *w);
    seconds = now();
    if (ss_morlet_execute(plan, x, w, NULL) != SS_OK)
        exit(2);
    seconds = now() - seconds;
    if (worst != NULL)
        *worst = worst_error(plan, x, n, 2000, opts, w, 7);
    ss_morlet_free(plan);
    free(x);
    free(w);
    return seconds;
}

/* The largest rounding error of single points in units of eps a^1/2 max|x|. */
static double
rounding(double center)
{
    enum { N = 4001 };
    static double x[N];
    ss_morlet_opts opts = ss_morlet_defaults;
    double worst = 0, w[2], rate = 2000;
    long double want[2];
    opts.center = center;
    for (kind which = 0; which < KINDS; which++) {
        double x_max = 0;
        make(which, x, N);
        for (size_t i = 0; i < N; i++)
            x_max = fmax(x_max, fabs(x[i]));
        for (int j = 0; j < 300; j++) {
            double a = (center + 5) / (M_PI * rate) * pow(1.07, j % 70), b = j / 151.;
            if (ss_morlet_point(x, N, rate, &opts, a, b, w, NULL) != SS_OK)
                exit(2);
            oracle(x, N, rate, &opts, a, b, want);
            double error = (double)hypotl(w[0] - want[0], w[1] - want[1]);
            worst = fmax(worst, error / (DBL_EPSILON * sqrt(a) * x_max));
        }
    }
    return worst;
}

int
main(void)
{
    static const double accuracy[] = { 1e-3, 1e-6, 1e-9, 1e-12, 1e-13 };
    static const double center[] = { 2, 6, 60, 1000 };
    ss_morlet_opts opts = ss_morlet_defaults;
    size_t count;
    int failed = 0;

    printf("accuracy  error/bound  ms for 6000 samples, 16 voices\n");
    for (size_t i = 0; i < sizeof accuracy / sizeof *accuracy; i++) {
        double worst = 0, slowest = 0;
        opts.accuracy = accuracy[i];
        for (kind which = 0; which < KINDS; which++) {
            double w;
            slowest = fmax(slowest, run(which, 6000, &opts, NULL, &count));
            opts.voices = 2;
            run(which, 2003, &opts, &w, &count);
            opts.voices = 16;
            worst = fmax(worst, w);
        }
        printf("%8.0e  %11.2g  %.0f\n", accuracy[i], worst, 1e3 * slowest);
        failed |= !(worst <= 1);
    }
    printf("omega_c  rounding error in eps a^1/2 max|x|\n");
    for (size_t i = 0; i < sizeof center / sizeof *center; i++) {
        double worst = rounding(center[i]);
        printf("%7g  %.2g\n", center[i], worst);
        failed |= !(worst <= 12);
    }
    opts.accuracy = 1e-6;
    printf("samples  coefficients  seconds\n");
    for (size_t n = 6000; n <= 1000000; n = n == 6000 ? 100000 : 10 * n) {
        double seconds = run(WEAK_BURST, n, &opts, NULL, &count);
        printf("%7zu  %12zu  %.3g\n", n, count, seconds);
    }
    return failed;
}
