/* bench_stream.c -- what a stream costs beside the transform of the whole record in memory.
 *
 * Prints nanoseconds of processor time a sample, for records of 1e4 to 1e6 samples of noise (or to as
 * many as the first argument says, 1e8 being five minutes), and the memory that the process held at
 * most; then both in turns on 2^20 samples, the fastest of five rounds, and their largest difference
 * in units of the bound.  Exits 1 if it exceeds that. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <stickslip.h>
#include "map/map.h"
#include "bench.h"

static double
megabytes(void)
{
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    return (double)use.ru_maxrss / 1024;
}

static void
make_noise(double *x, size_t n)
{
    unsigned long long seed = 12345;
    for (size_t i = 0; i < n; i++) {
        seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
        x[i] = (double)(seed >> 11) * 0x1p-52 - 1;
    }
}

typedef struct sum {
    double total;               /* so that nothing is left out */
    size_t n;
    const ss_morlet *plan;      /* to compare with, or NULL */
    const double *w, *largest;  /* largest: |W| of each scale */
    double tol, worst;
} sum;

static int
add(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    sum *s = user;
    (void)samples;
    s->total += w[0] + w[2 * n - 1];
    s->n += n;
    for (size_t i = 0; s->plan != NULL && i < ss_morlet_grid(s->plan)->n_scales; i++) {
        const ss_scale *sc = &ss_morlet_grid(s->plan)->scale[i];
        double error = 0;
        if (sc->j != scale->j)
            continue;
        for (size_t k = 0; k < n; k++) {
            const double *want = s->w + 2 * (sc->offset + first + k);
            error = fmax(error, hypot(w[2 * k] - want[0], w[2 * k + 1] - want[1]));
        }
        s->worst = fmax(s->worst, error / (2 * s->tol * s->largest[i]));
    }
    return 0;
}

static const struct grid {
    const char *name;
    int octaves, voices, dense;
} grid[] = {
    { "10 octaves of 8 voices, dense", 10, 8, 1 }, { "10 octaves of 16 voices, step 0.25", 10, 16, 0 },
    { "16 octaves, dyadic", 16, 1, 0 }
};

/* One sample a second; scales upwards from the shortest that 1e-13 allows. */
static ss_morlet_opts
opts_of(const struct grid *g, double accuracy)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    double v = g->voices;
    opts.accuracy = accuracy;
    opts.voices = g->voices, opts.dense = g->dense, opts.step = v > 1 ? 0.25 : 1, opts.force = 1;
    opts.octaves = 1, opts.m0 = ceil(v * log2(13.8 / M_PI)) / v;
    opts.m1 = opts.m0 + g->octaves - 1 / v;
    return opts;
}

/* Seconds for n samples pushed 8192 at a time, the same noise again and again, without planning. */
static double
stream(const ss_morlet_opts *opts, const double *x, size_t n, sum *s)
{
    enum { PUSH = 8192, REPEAT = 1 << 20 };
    ss_stream *st;
    if (ss_stream_new(&st, 1, opts, add, s, NULL) != SS_OK)
        exit(2);
    double begin = bench_seconds();
    for (size_t i = 0; i < n; i += PUSH)
        if (ss_stream_push(st, x + i % REPEAT, n - i < PUSH ? n - i : PUSH, NULL) != SS_OK)
            exit(2);
    if (ss_stream_end(st, NULL) != SS_OK)
        exit(2);
    double seconds = bench_seconds() - begin;
    ss_stream_free(st);
    return seconds;
}

static double
in_memory(const ss_morlet_opts *opts, const double *x, size_t n, ss_morlet **plan, double **w)
{
    if (ss_morlet_new(plan, n, 1, opts, NULL) != SS_OK)
        exit(2);
    *w = malloc(2 * ss_morlet_grid(*plan)->total * sizeof **w);
    memset(*w, 0, 2 * ss_morlet_grid(*plan)->total * sizeof **w);
    double begin = bench_seconds();
    if (ss_morlet_execute(*plan, x, *w, NULL) != SS_OK)
        exit(2);
    return bench_seconds() - begin;
}

/* The largest |W| of each scale; to be freed. */
static double *
largest_of_scales(const ss_morlet *plan, const double *w)
{
    size_t scales = ss_morlet_grid(plan)->n_scales;
    double *largest = calloc(scales, sizeof *largest);
    for (size_t i = 0; i < scales; i++) {
        const ss_scale *scale = &ss_morlet_grid(plan)->scale[i];
        const double *row = w + 2 * scale->offset;
        for (size_t k = 0; k < scale->n; k++)
            largest[i] = fmax(largest[i], hypot(row[2 * k], row[2 * k + 1]));
    }
    return largest;
}

/* What one run in a process of its own says of itself. */
typedef struct cost {
    double ns, planning;        /* a sample, without planning; planning [ms] */
    double megabytes;           /* at most */
} cost;

static cost
run_apart(const ss_morlet_opts *opts, const double *x, size_t n)
{
    cost c = { NAN, NAN, NAN };
    int ends[2];
    fflush(stdout);
    if (pipe(ends) != 0)
        exit(2);
    pid_t child = fork();
    if (child == 0) {
        sum s = { 0 };
        double begin = bench_seconds(), seconds = stream(opts, x, n, &s);
        c.ns = 1e9 * seconds / (double)n;
        c.planning = 1e3 * (bench_seconds() - begin - seconds);
        c.megabytes = megabytes();
        _exit(write(ends[1], &c, sizeof c) != sizeof c);
    }
    close(ends[1]);
    if (child < 0 || read(ends[0], &c, sizeof c) != sizeof c)
        exit(2);
    close(ends[0]);
    waitpid(child, NULL, 0);
    return c;
}

/* In turns on the same N samples; 1 if what they give differs by more than both bounds allow. */
static int
compare(const struct grid *g, const double *x, size_t n)
{
    enum { ROUNDS = 5 };
    ss_morlet_opts opts = opts_of(g, 1e-6);
    double whole = INFINITY, piecewise = INFINITY, *w = NULL;
    ss_morlet *plan = NULL;
    for (int i = 0; i < ROUNDS; i++) {
        free(w);
        ss_morlet_free(plan);
        whole = fmin(whole, in_memory(&opts, x, n, &plan, &w));
        piecewise = fmin(piecewise, stream(&opts, x, n, &(sum){ 0 }));
    }
    double *largest = largest_of_scales(plan, w);
    sum s = { .plan = plan, .w = w, .largest = largest, .tol = opts.accuracy };
    stream(&opts, x, n, &s);
    printf("%s: in memory %.3g ns, stream %.3g ns, ratio %.2f; difference/bound %.2g\n", g->name,
           1e9 * whole / (double)n, 1e9 * piecewise / (double)n, piecewise / whole, s.worst);
    free(largest);
    free(w);
    ss_morlet_free(plan);
    return !(s.worst <= 1);
}

int
main(int argc, char *argv[])
{
    enum { N = 1 << 20 };
    double *x = malloc(N * sizeof *x), most = argc > 1 ? atof(argv[1]) : 1e6;
    int failed = 0;
    make_noise(x, N);
    printf("samples, ns of processor time a sample, ms of planning, MB held at most, each row by a "
           "process of its own\n");
    for (size_t i = 0; i < sizeof grid / sizeof *grid; i++) {
        ss_morlet_opts opts = opts_of(&grid[i], 1e-6);
        printf("%s\n", grid[i].name);
        for (size_t n = 10000; (double)n <= most; n *= 10) {
            cost c = run_apart(&opts, x, n);
            printf("%10zu  %7.3g  %5.3g  %5.3g\n", n, c.ns, c.planning, c.megabytes);
            fflush(stdout);
        }
    }
    for (size_t i = 0; i < sizeof grid / sizeof *grid; i++)
        failed |= compare(&grid[i], x, N);
    free(x);
    return failed;
}
