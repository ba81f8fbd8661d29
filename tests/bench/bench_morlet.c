/* bench_morlet.c -- error and cost of the wavelet transform, for each accuracy.
 *
 * Prints the largest error against the sum in long double, over all signals of morlet_oracle.h, as a
 * fraction of the bound promised, and the cost; then what rounding alone leaves, the cost for longer
 * records, the cost of an inverse, and transforms by FFT in multiples of one FFT of the record.  Exits 1 if
 * a bound is exceeded. */
#include <fftw3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "map/map.h"
#include "../morlet_oracle.h"
#include "bench.h"
#include "../morlet_point.h"

/* Seconds for one transform of n samples at 2 kHz, the best of three; its largest error over the bound into *worst. */
static double
run(kind which, size_t n, const ss_morlet_opts *opts, double *worst, size_t *coefficients)
{
    ss_morlet *plan = NULL;
    double *x = malloc(n * sizeof *x), *w, seconds;
    make(which, x, n);
    if (ss_morlet_new(&plan, n, 2000, opts, NULL) != SS_OK)
        exit(2);
    *coefficients = ss_morlet_grid(plan)->total;
    w = malloc(2 * *coefficients * sizeof *w);
    seconds = INFINITY;
    for (int i = 0; i < 3; i++) {
        double begin = bench_seconds();
        if (ss_morlet_execute(plan, x, w, NULL) != SS_OK)
            exit(2);
        seconds = fmin(seconds, bench_seconds() - begin);
    }
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
            if (point_at(x, N, rate, &opts, a, b, w, NULL) != SS_OK)
                exit(2);
            oracle(x, N, rate, &opts, a, b, want);
            double error = (double)hypotl(w[0] - want[0], w[1] - want[1]);
            worst = fmax(worst, error / (DBL_EPSILON * sqrt(a) * x_max));
        }
    }
    return worst;
}

/* Seconds for one real FFT of n samples, the best of several. */
static double
fft_seconds(const double *x, size_t n)
{
    double *in = fftw_malloc(n * sizeof *in), best = INFINITY;
    fftw_complex *out = fftw_malloc((n / 2 + 1) * sizeof *out);
    fftw_plan plan = fftw_plan_dft_r2c_1d((int)n, in, out, FFTW_ESTIMATE);
    for (int i = 0; i < 10; i++) {
        memcpy(in, x, n * sizeof *in);
        double t = bench_seconds();
        fftw_execute(plan);
        best = fmin(best, bench_seconds() - t);
    }
    fftw_destroy_plan(plan);
    fftw_free(in);
    fftw_free(out);
    return best;
}

static const struct work {
    const char *name;
    size_t n;
    int octaves, voices, dense;
} table[] = {
    { "W1", 10000, 10, 16, 1 }, { "W2", 131072, 10, 32, 1 }, { "W3", 1048576, 10, 8, 1 },
    { "W4", 1048576, 16, 1, 0 }
};

/* One sample a second; scales upwards from the shortest that 1e-13 allows. */
static int
run_work(const struct work *work, double accuracy)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan;
    double *x = malloc(work->n * sizeof *x), best = INFINITY, differs = 0, v = work->voices;
    make(NOISE, x, work->n);
    opts.engine = SS_ENGINE_FFT;
    opts.accuracy = accuracy;
    opts.voices = work->voices, opts.dense = work->dense, opts.step = 1, opts.force = 1;
    opts.octaves = 1, opts.m0 = ceil(v * log2(13.8 / M_PI)) / v;
    opts.m1 = opts.m0 + work->octaves - 1 / v;
    double fft = fft_seconds(x, work->n), begin = bench_seconds();
    if (ss_morlet_new(&plan, work->n, 1, &opts, NULL) != SS_OK)
        exit(2);
    double planning = bench_seconds() - begin, *w = calloc(2 * ss_morlet_grid(plan)->total, sizeof *w);
    for (int i = 0; i < 5; i++) {
        begin = bench_seconds();
        if (ss_morlet_execute(plan, x, w, NULL) != SS_OK)
            exit(2);
        best = fmin(best, bench_seconds() - begin);
    }
    if (ss_morlet_compare(plan, x, w, 2, &differs, NULL) != SS_OK)
        exit(2);
    printf("%s  %8.0e  %8.3g  %8.3g  %6.4g  %8.3g  %.2g\n", work->name, accuracy, fft, best,
           best / fft, planning, differs);
    ss_morlet_free(plan);
    free(x);
    free(w);
    return !(differs <= accuracy);
}

/* Nanoseconds a coefficient on the default grid, the same with exact steps, and dense. */
static void
compare_grids(size_t n)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    double ns[3];
    size_t count;
    for (int i = 0; i < 3; i++) {
        opts.exact = i == 1, opts.dense = i == 2;
        ns[i] = run(NOISE, n, &opts, NULL, &count) / (double)count * 1e9;
    }
    printf("%7zu  %7.3g  %5.3g  %5.3g  %8.3g  %.3g\n", n, ns[0], ns[1], ns[2], ns[1] / ns[0],
           ns[2] / ns[0]);
}

static int
count_pass(double done, void *user)
{
    ++*(int *)user;
    return done > 1;
}

/* White noise at 2 kHz and its inverse within 1e-3: the passes, and the time of all and of one over that of
 * the transform. */
static void
invert(size_t n, const ss_morlet_opts *opts)
{
    ss_header *head = NULL;
    ss_header_new(&head, 2000, 0, NULL);
    ss_signal *signal = NULL, *back = NULL;
    ss_coefficients *coef = NULL;
    int passes = 0;
    double forward, begin;
    size_t count;
    if (ss_header_add_column(head, "a", "1", NULL) != SS_OK || ss_signal_new(&signal, head, n, NULL) != SS_OK)
        exit(2);
    make(NOISE, signal->values, n);
    forward = run(NOISE, n, opts, NULL, &count);
    if (ss_morlet_transform(&coef, signal, 0, opts, NULL) != SS_OK)
        exit(2);
    begin = bench_seconds();
    if (ss_morlet_inverse(&back, coef, 1e-3, NULL, (ss_progress){ count_pass, &passes }, NULL) != SS_OK)
        exit(2);
    double ratio = (bench_seconds() - begin) / forward;
    printf("%7zu  %5s  %8.3g  %6d  %5.0f  %.2g\n", n, opts->dense ? "dense" : "0.25", forward, passes, ratio,
           ratio / passes);
    ss_header_free(head);
    ss_signal_free(signal);
    ss_signal_free(back);
    ss_coefficients_free(coef);
}

static void
invert_all(void)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.fmin = 4, opts.fmax = 400;
    printf("samples   step  transform s  inverse: passes, time over it, of a pass\n");
    for (opts.dense = 0; opts.dense < 2; opts.dense++)
        for (size_t n = 20000; n <= 200000; n *= 10) {
            opts.voices = opts.dense ? 4 : 16;
            invert(n, &opts);
        }
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
            for (opts.engine = SS_ENGINE_QUADRATURE; opts.engine <= SS_ENGINE_FFT; opts.engine++) {
                run(which, 1501, &opts, &w, &count);
                worst = fmax(worst, w);
            }
            opts.engine = SS_ENGINE_AUTO;
            opts.voices = 16;
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
    printf("samples  default  exact  dense, ns a coefficient  exact/default  dense/default\n");
    compare_grids(10000);
    compare_grids(200000);
    invert_all();
    printf("      accuracy   1 FFT/s         s   ratio      plan  difference/max|W|\n");
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        for (size_t j = 0; j < sizeof accuracy / sizeof *accuracy; j++)
            failed |= run_work(&table[i], accuracy[j]);
    return failed;
}
