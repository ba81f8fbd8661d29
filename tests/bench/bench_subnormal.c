/* bench_subnormal.c -- what subnormal samples cost the wavelet transform: at most 3 times others.
 *
 * Records of noise as it is, in subnormals throughout, and dying away into them, as a
 * ringdown does, by each engine, whole and as a stream, in turns; the least of each one's times is
 * compared. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <stickslip.h>
#include "map/map.h"
#include "bench.h"

enum { N = 20000, ROUNDS = 7, RECORDS = 3 };
#define MOST 3.0

static void
fill(double x[RECORDS][N])
{
    unsigned long long seed = 1;
    for (size_t i = 0; i < N; i++) {
        seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
        x[0][i] = (double)(seed >> 11) * 0x1p-52 - 1;
        x[1][i] = x[0][i] * 1e-310;
        x[2][i] = x[0][i] * exp(-720 * fmin(1, 10. * (double)i / N));   /* 1e-313 from a tenth on */
    }
}

static int
ignore(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    (void)scale, (void)first, (void)n, (void)w, (void)samples, (void)user;
    return 0;
}

/* By the plan, or as a stream. */
static double
time_of(const ss_morlet_opts *opts, const ss_morlet *plan, const double *x, double *w, int streamed)
{
    ss_stream *stream = NULL;
    if (streamed && ss_stream_new(&stream, 2000, opts, ignore, NULL, NULL) != SS_OK)
        return NAN;
    double began = bench_seconds();
    ss_status st = streamed ? ss_stream_push(stream, x, N, NULL) : ss_morlet_execute(plan, x, w, NULL);
    if (st == SS_OK && streamed)
        st = ss_stream_end(stream, NULL);
    double seconds = bench_seconds() - began;
    ss_stream_free(stream);
    return st == SS_OK ? seconds : NAN;
}

static int
measure(ss_engine engine, int streamed, double x[RECORDS][N])
{
    static const char *const name[RECORDS] = { "noise", "in subnormals", "dying away" };
    double least[RECORDS] = { INFINITY, INFINITY, INFINITY };
    int failed = 0;
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan = NULL;
    opts.engine = engine, opts.voices = 4, opts.fmin = 2;
    if (ss_morlet_new(&plan, N, 2000, &opts, NULL) != SS_OK)
        return 1;
    double *w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w);
    for (int round = 0; w != NULL && round < ROUNDS; round++)
        for (int r = 0; r < RECORDS; r++)
            least[r] = fmin(least[r], time_of(&opts, plan, x[r], w, streamed));
    for (int r = 1; r < RECORDS; r++) {
        double ratio = least[r] / least[0];
        printf("%s%s, %s: %.2f times the time of noise\n", streamed ? "stream by " : "",
               engine == SS_ENGINE_FFT ? "fft" : "quadrature", name[r], ratio);
        failed |= !(ratio <= MOST);
    }
    ss_morlet_free(plan);
    free(w);
    return failed;
}

int
main(void)
{
    static double x[RECORDS][N];
    int failed = 0;
    fill(x);
    for (int streamed = 0; streamed < 2; streamed++)
        failed |= measure(SS_ENGINE_FFT, streamed, x) | measure(SS_ENGINE_QUADRATURE, streamed, x);
    return failed;
}
