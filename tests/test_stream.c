/* test_stream.c -- the transform of a stream against the sum in long double and against that of the
 * whole record, however its samples come. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "morlet_oracle.h"

#define LENGTH(a) (sizeof (a) / sizeof *(a))

/* Where the sink puts what a stream gives: at the place that the whole record's plan gives it. */
typedef struct collection {
    const ss_morlet *plan;      /* NULL: the length is not known yet */
    double *w;
    size_t next[2000], total;
    size_t latest;              /* samples when the last ones came */
    size_t stop_after;
} collection;

static size_t
index_of(const ss_morlet *plan, const ss_scale *scale)
{
    for (size_t i = 0; i < ss_morlet_scales(plan); i++)
        if (ss_morlet_scale(plan, i)->j == scale->j)
            return i;
    fail_msg("scale %d is not one of the record's", scale->j);
    return 0;
}

/* In order, none twice, on the record's grid, and with the record's edge. */
static int
collect(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    collection *c = user;
    size_t i = index_of(c->plan, scale);
    const ss_scale *want = ss_morlet_scale(c->plan, i);
    assert_true(n > 0 && samples > 0);
    assert_int_equal(first, c->next[i]);
    assert_true(first + n <= want->n);
    assert_true(scale->a == want->a && scale->f == want->f);
    memcpy(c->w + 2 * (want->offset + first), w, 2 * n * sizeof *w);
    c->next[i] += n;
    c->total += n;
    c->latest = samples;
    return c->stop_after > 0 && c->total >= c->stop_after;
}

static unsigned long long seed = 1;

static size_t
draw(size_t most)
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (size_t)(seed >> 33) % most + 1;
}

/* How samples come. */
typedef enum blocks { ALL, ONES, RANDOM, RANDOM_DRAINED, HURRIED } blocks;

static void
feed(ss_stream *stream, const double *x, size_t n, blocks how)
{
    for (size_t i = 0, part; i < n; i += part) {
        part = how == ALL ? n : how == ONES ? 1 : how == HURRIED ? draw(40) : draw(9999);
        part = part < n - i ? part : n - i;
        assert_int_equal(ss_stream_push(stream, x + i, part, NULL), SS_OK);
        if (how >= RANDOM_DRAINED)
            assert_int_equal(ss_stream_drain(stream, NULL), SS_OK);
    }
    assert_int_equal(ss_stream_samples(stream), n);
    assert_int_equal(ss_stream_end(stream, NULL), SS_OK);
}

/* The highest frequency that sampling resolves. */
static double
highest(double rate, const ss_morlet_opts *opts)
{
    return rate * opts->center / 2 / (opts->center + sqrt(-2 * log(opts->accuracy)));
}

/* Coefficients of x as a stream; *plan is the whole record's. */
static double *
stream_of(const double *x, size_t n, double rate, const ss_morlet_opts *opts, blocks how,
          ss_morlet **plan)
{
    ss_morlet_opts whole = *opts;
    ss_stream *stream = NULL;
    ss_error err = { "" };
    collection c = { .plan = NULL };
    whole.force = 1;                    /* scales longer than the record, too */
    if (!opts->force && opts->fmax == 0 && !opts->octaves)
        whole.fmax = highest(rate, opts);
    if (ss_morlet_new(plan, n, rate, &whole, &err) != SS_OK
        || ss_stream_new(&stream, rate, opts, collect, &c, &err) != SS_OK)
        fail_msg("%s", err.text);
    c.plan = *plan;
    c.w = malloc(2 * ss_morlet_total(*plan) * sizeof *c.w);
    assert_int_equal(ss_stream_scales(stream), ss_morlet_scales(*plan));
    feed(stream, x, n, how);
    assert_int_equal(c.total, ss_morlet_total(*plan));
    ss_stream_free(stream);
    return c.w;
}

static void
check_stream(const char *what, const double *x, size_t n, double rate, const ss_morlet_opts *opts,
             blocks how, size_t looked_at)
{
    ss_morlet *plan;
    double *w = stream_of(x, n, rate, opts, how, &plan);
    size_t every = 1 + ss_morlet_total(plan) / looked_at;
    double worst = worst_error(plan, x, n, rate, opts, w, every);
    if (!(worst <= 1))
        fail_msg("%s, %zu samples, blocks %d, engine %d, accuracy %g: %g times the bound", what, n,
                 how, opts->engine, opts->accuracy, worst);
    ss_morlet_free(plan);
    free(w);
}

/* Grids of all kinds: fmin and rate such that there are scales from a few samples to some hundred,
 * or, the last ones, to thousands. */
static const struct setup {
    const char *what;
    double center;
    int voices;
    double step;
    int dense, admissible;
    ss_norm norm;
    double rate, fmin;
} setup[] = {
    { "default grid",       6,    16, 0.25, 0, 0, SS_NORM_L2, 2000,  20 },
    { "dyadic",             6,     1, 1,    0, 0, SS_NORM_L2, 2000,  1 },
    { "dyadic, lattice",    6,     1, 0.5,  0, 0, SS_NORM_L1, 1024,  1 },
    { "dense",              6,     2, 0.25, 1, 0, SS_NORM_L2, 44100, 441 },
    { "dense, admissible",  2,     3, 0.25, 1, 1, SS_NORM_L1, 3,     0.004 },
    { "admissible",         2,     2, 0.3,  0, 1, SS_NORM_L2, 1e-3,  2e-6 },
    { "center 60",          60,    4, 0.7,  0, 0, SS_NORM_L1, 2000,  100 },
    { "a step of 30 scales", 6,    2, 30,   0, 0, SS_NORM_L2, 2000,  10 },
    { "a fine step",        5,     2, 0.01, 0, 0, SS_NORM_L2, 1e9,   1e8 },
};

static ss_morlet_opts
opts_of(const struct setup *s)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.center = s->center, opts.voices = s->voices, opts.step = s->step, opts.dense = s->dense;
    opts.admissible = s->admissible, opts.norm = s->norm, opts.fmin = s->fmin;
    return opts;
}

/* Records shorter than the longest wavelet among them, 1 and prime lengths. */
static void
keeps_the_record_s_bound_whatever_comes_together(void **state)
{
    static const size_t length[] = { 1, 2, 127, 1000, 4999 };
    static const double accuracy[] = { 1e-3, 1e-6, 1e-13 };
    double x[5000];
    (void)state;
    for (size_t i = 0; i < LENGTH(setup); i++)
        for (size_t j = 0; j < LENGTH(length); j++)
            for (kind which = 0; which < KINDS; which++) {
                ss_morlet_opts opts = opts_of(&setup[i]);
                opts.engine = (ss_engine)((which + j) % 3);
                opts.accuracy = accuracy[(which + j + i) % LENGTH(accuracy)];
                make(which, x, length[j]);
                blocks how = (blocks)((which + i + j) % 4);
                how = how == RANDOM_DRAINED && opts.engine != SS_ENGINE_FFT ? HURRIED : how;
                check_stream(setup[i].what, x, length[j], setup[i].rate, &opts, how, 60);
            }
}

/* Several windows long, and scales of which a window is longer than the shortest there is. */
static void
keeps_the_bound_from_window_to_window(void **state)
{
    enum { N = 300007 };
    double *x = malloc(N * sizeof *x);
    (void)state;
    for (size_t i = 0; i < LENGTH(setup) - 1; i++)
        for (int engine = SS_ENGINE_AUTO; engine <= SS_ENGINE_FFT; engine++) {
            ss_morlet_opts opts = opts_of(&setup[i]);
            int by_sum = engine == SS_ENGINE_QUADRATURE;
            opts.engine = (ss_engine)engine;
            opts.fmin /= by_sum ? 1 : 8;
            opts.accuracy = i % 2 ? 1e-6 : 1e-12;
            opts.fmax = (opts.dense ? 12 : 40) * opts.fmin;
            opts.fmax = fmin(opts.fmax, highest(setup[i].rate, &opts));
            make((kind)((i + (size_t)engine) % KINDS), x, N);
            check_stream(setup[i].what, x, by_sum && opts.dense ? N / 8 : N, setup[i].rate, &opts,
                         i % 2 ? RANDOM : RANDOM_DRAINED, 60);
        }
    free(x);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keeps_the_record_s_bound_whatever_comes_together),
        cmocka_unit_test(keeps_the_bound_from_window_to_window),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
