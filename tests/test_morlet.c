/* test_morlet.c -- wavelet coefficients against their sum in long double, by every engine, on one thread
 * and on several. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include "map/map.h"
#include "map/fft/blocks.h"
#include "morlet_plan.h"
#include "unit.h"
#include "morlet_point.h"

/* --- the sum ------------------------------------------------------------------------------- */

/* Every row on every signal at every accuracy. */
static const struct setup {
    double center;
    int voices;
    double step;
    int dense, admissible;
    ss_norm norm;
    double rate;
    size_t n;
} setup[] = {
    { 6,     16, 0.25,   0, 0, SS_NORM_L2, 2000,  401 },
    { 2,      1, 1,      0, 1, SS_NORM_L2, 2000,  397 },    /* prime length */
    { 2,      2, 0.3,    0, 1, SS_NORM_L1, 1e-3,  256 },
    { 5.336,  3, 0.7,    0, 0, SS_NORM_L1, 44100, 509 },
    { 6,      2, 0.25,   1, 0, SS_NORM_L2, 44100, 251 },
    { 6,      2, 0.25,   1, 1, SS_NORM_L2, 3,     250 },
    { 20,     5, 0.1,    0, 0, SS_NORM_L2, 1e9,   300 },
    { 60,     4, 0.25,   0, 0, SS_NORM_L2, 2000,  307 },
    { 1000,  64, 0.0025, 0, 0, SS_NORM_L2, 2000, 1201 },
    { 6,      1, 1e3,    0, 0, SS_NORM_L2, 2000,  300 },    /* one translation a scale */
};

static void
error_of_the_sum_is_below_its_bound(void **state)
{
    static const double accuracy[] = { 1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-13 };
    (void)state;
    for (size_t i = 0; i < LENGTH(setup); i++)
        for (size_t j = 0; j < 2 * LENGTH(accuracy); j++) {
            struct setup s = setup[i];
            ss_morlet_opts opts = ss_morlet_defaults;
            opts.engine = j % 2 ? SS_ENGINE_QUADRATURE : SS_ENGINE_FFT;
            opts.center = s.center, opts.voices = s.voices, opts.step = s.step;
            opts.dense = s.dense, opts.admissible = s.admissible, opts.norm = s.norm;
            opts.accuracy = accuracy[j / 2];
            ss_morlet *plan = plan_of(s.n, s.rate, &opts);
            for (kind which = 0; which < KINDS; which++) {
                double *x = malloc(s.n * sizeof *x);
                make(which, x, s.n);
                double *w = transform(plan, x);
                size_t every = 1 + ss_morlet_grid(plan)->total * s.n / 4000;
                double worst = worst_error(plan, x, s.n, s.rate, &opts, w, every);
                if (!(worst <= 1))
                    fail_msg("engine %d, center %g, %d voices, accuracy %g, %s: %g times the bound",
                             opts.engine, s.center, s.voices, opts.accuracy, kind_name[which],
                             worst);
                free(x);
                free(w);
            }
            ss_morlet_free(plan);
        }
}

/* Wavelets narrower than a sample, and wider than the record. */
static void
forced_scales_keep_the_bound(void **state)
{
    enum { N = 101 };
    double x[N];
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.force = opts.octaves = 1;
    opts.m0 = -16, opts.m1 = 6;             /* 100 samples a second: 0.0015 to 6400 samples */
    opts.voices = 1, opts.step = 0.3;
    for (opts.accuracy = 1e-3; opts.accuracy > 1e-13; opts.accuracy /= 1e3)
        for (kind which = 0; which < 2 * KINDS; which++) {
            make(which / 2, x, N);
            opts.engine = which % 2 ? SS_ENGINE_QUADRATURE : SS_ENGINE_FFT;
            ss_morlet *plan = plan_of(N, 100, &opts);
            double *w = transform(plan, x);
            double worst = worst_error(plan, x, N, 100, &opts, w, 29);
            if (!(worst <= 1))
                fail_msg("engine %d, accuracy %g, %s: %g times the bound", opts.engine,
                         opts.accuracy, kind_name[which / 2], worst);
            ss_morlet_free(plan);
            free(w);
        }
}

/* A record long enough that the longest scales need a circle of their own, on the grids whose
 * translations divide the circle, are samples, or neither. */
static void
long_scales_by_fft_keep_the_bound(void **state)
{
    enum { N = 20011 };
    static const struct { int voices; double step, rate; int dense; } row[] = {
        { 1, 1, 1024, 0 }, { 1, 0.5, 2000, 0 }, { 3, 0.25, 2000, 0 }, { 2, 0, 44100, 1 } };
    double *x = malloc(N * sizeof *x);
    (void)state;
    for (size_t i = 0; i < LENGTH(row); i++)
        for (kind which = 0; which < KINDS; which++) {
            ss_morlet_opts opts = ss_morlet_defaults;
            opts.engine = SS_ENGINE_FFT;
            opts.accuracy = which % 2 ? 1e-13 : 1e-5;
            opts.voices = row[i].voices, opts.step = row[i].step, opts.dense = row[i].dense;
            make(which, x, N);
            ss_morlet *plan = plan_of(N, row[i].rate, &opts);
            double *w = transform(plan, x);
            size_t every = 1 + ss_morlet_grid(plan)->total / 60;
            for (size_t j = 0; j < ss_morlet_grid(plan)->n_scales; j++)
                assert_int_equal(ss_morlet_grid(plan)->scale[j].engine, SS_ENGINE_FFT);
            double worst = worst_error(plan, x, N, row[i].rate, &opts, w, every);
            if (!(worst <= 1))
                fail_msg("row %zu, %s: %g times the bound", i, kind_name[which], worst);
            ss_morlet_free(plan);
            free(w);
        }
    free(x);
}

/* Stepped grids in blocks, translations at points and between them: records of one window and of many,
 * with many octaves, of steps from the finest on, narrow and wide wavelets, short forced scales. */
static void
blocks_keep_the_bound(void **state)
{
    static const struct {
        double center, step, rate, m0, m1;      /* m0 = m1: the default range */
        int voices, admissible;
        ss_norm norm;
        size_t n;
        int exact;
    } row[] = {
        { 6,     0.25, 2000,  0,  0,  16, 0, SS_NORM_L2, 20011, 0 },
        { 6,     0.25, 44100, 0,  0,  3,  0, SS_NORM_L1, 1025, 0 },
        { 6,     1,    1e-3,  0,  0,  5,  0, SS_NORM_L2, 12345, 0 },
        { 6,     0.5,  1e9,   0,  0,  7,  1, SS_NORM_L2, 3001, 0 },
        { 5.336, 0.01, 7,     0,  0,  2,  0, SS_NORM_L2, 2500, 0 },
        { 2,     0.25, 48000, 0,  0,  4,  1, SS_NORM_L1, 6000, 0 },
        { 40,    0.25, 1000,  0,  0,  3,  0, SS_NORM_L2, 30000, 0 },
        { 200,   0.1,  1000,  0,  0,  1,  1, SS_NORM_L2, 40000, 0 },
        { 6,     0.3,  1024,  -9, 5,  2,  0, SS_NORM_L2, 9000, 0 },    /* 2 to 2^15 samples */
        { 6,     0.25, 2000,  0,  0,  16, 0, SS_NORM_L2, 20011, 1 },
        { 6,     0.01, 44100, 0,  0,  3,  1, SS_NORM_L1, 1025, 1 },
        { 2,     1,    1e-3,  0,  0,  5,  0, SS_NORM_L2, 12345, 1 },
        { 200,   0.3,  1e9,   0,  0,  2,  1, SS_NORM_L2, 40000, 1 },
        { 6,     1.7,  7,     0,  0,  7,  0, SS_NORM_L2, 30000, 0 },   /* above 1 they are exact */
        { 6,     40,   48000, 0,  0,  4,  0, SS_NORM_L1, 60000, 0 },
        { 6,     1,    2000,  0,  0,  1,  0, SS_NORM_L2, 20011, 0 },   /* as are powers of 2 seconds, */
        { 6,     64,   1,     0,  0,  1,  0, SS_NORM_L2, 90001, 0 },   /* too long for fractions here */
        { 6,     0.3,  1024,  -9, 5,  2,  0, SS_NORM_L2, 9000, 1 },
    };
    (void)state;
    for (size_t i = 0; i < LENGTH(row); i++)
        for (kind which = 0; which < KINDS; which++) {
            ss_morlet_opts opts = ss_morlet_defaults;
            size_t n = row[i].n, in_blocks = 0;
            double *x = malloc(n * sizeof *x);
            opts.engine = SS_ENGINE_FFT;
            opts.accuracy = which == NOISE ? 0.1 : 1e-13;
            opts.center = row[i].center, opts.step = row[i].step, opts.voices = row[i].voices;
            opts.exact = row[i].exact, opts.admissible = row[i].admissible, opts.norm = row[i].norm;
            opts.octaves = opts.force = row[i].m0 != row[i].m1;
            opts.m0 = row[i].m0, opts.m1 = row[i].m1;
            make(which, x, n);
            ss_morlet *plan = plan_of(n, row[i].rate, &opts);
            double *w = transform(plan, x);
            for (size_t j = 0; j < ss_morlet_grid(plan)->n_scales; j++)
                in_blocks += ss_blocks_covers(plan->blocks, j);
            assert_true(in_blocks + 8 > ss_morlet_grid(plan)->n_scales);
            double worst = worst_error(plan, x, n, row[i].rate, &opts, w,
                                       1 + ss_morlet_grid(plan)->total / 40);
            if (!(worst <= 1))
                fail_msg("row %zu, %s: %g times the bound", i, kind_name[which], worst);
            ss_morlet_free(plan);
            free(w);
            free(x);
        }
}

/* Where short cuts suffice: scales by lattice and by interpolation, records of odd and of prime length,
 * of any amplitude. */
static void
low_accuracy_keeps_the_bound(void **state)
{
    static const double accuracy[] = { 1e-3, 1e-4, 1e-5 }, center[] = { 2, 6, 60 };
    static const double amplitude[] = { 1, 1e-300, 1e300 };
    static const size_t length[] = { 3000, 3375, 3001 };
    enum { N_MAX = 3375 };
    double x[N_MAX];
    (void)state;
    for (size_t i = 0; i < LENGTH(accuracy); i++)
        for (size_t j = 0; j < 2 * LENGTH(center); j++)
            for (kind which = 0; which < KINDS; which++) {
                size_t turn = (i + j + which) % 3, n = length[turn];
                ss_morlet_opts opts = ss_morlet_defaults;
                opts.engine = SS_ENGINE_FFT, opts.accuracy = accuracy[i];
                opts.center = center[j / 2], opts.dense = j % 2 == 0;
                opts.voices = opts.dense ? 3 : 1, opts.step = 1;
                make(which, x, n);
                for (size_t k = 0; k < n; k++)
                    x[k] *= amplitude[(i + j) % 3] / (which == OFFSET ? 1000 : 1);
                ss_morlet *plan = plan_of(n, 2048, &opts);
                double *w = transform(plan, x);
                double worst = worst_error(plan, x, n, 2048, &opts, w, opts.dense ? 1009 : 41);
                if (!(worst <= 1))
                    fail_msg("%s, n %zu, accuracy %g, center %g, %s: %g times the bound",
                             kind_name[which], n, accuracy[i], opts.center,
                             opts.dense ? "dense" : "dyadic", worst);
                ss_morlet_free(plan);
                free(w);
            }
}

static void
threads_change_nothing(void **state)
{
    enum { N = 3000 };
    double x[N];
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    make(NOISE, x, N);
    ss_morlet *one = plan_of(N, 2000, &opts);
    opts.threads = 5;
    ss_morlet *five = plan_of(N, 2000, &opts);
    double *u = transform(one, x), *v = transform(five, x);
    assert_memory_equal(u, v, 2 * ss_morlet_grid(one)->total * sizeof *u);
    free(u);
    free(v);
    ss_morlet_free(one);
    ss_morlet_free(five);
}

typedef struct sequence {
    const ss_morlet *plan;
    const double *w;            /* of all */
    size_t next, stop_at;       /* scales */
    pthread_t thread;
} sequence;

static int
follow(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    sequence *s = user;
    const ss_scale *want = &ss_morlet_grid(s->plan)->scale[s->next];
    assert_true(pthread_equal(pthread_self(), s->thread));
    assert_true(scale->j == want->j && first == 0 && n == want->n && samples == 3001);
    assert_memory_equal(w, s->w + 2 * want->offset, 2 * n * sizeof *w);
    return ++s->next == s->stop_at;
}

static int
stop_half_way(double done, void *user)
{
    double *last = user;
    assert_true(done > *last && done <= 1);
    *last = done;
    return done > 0.5;
}

/* One at a time, the longest first, on the caller's thread, with the bits that all have together. */
static void
scales_come_one_by_one_to_the_last_bit(void **state)
{
    enum { N = 3001 };
    double x[N], done = 0;
    (void)state;
    make(NOISE, x, N);
    for (int row = 0; row < 9; row++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        opts.dense = row % 2, opts.voices = 3, opts.threads = 1 + row % 4;
        opts.engine = (ss_engine)(row % 3), opts.detrend = (ss_detrend)(row / 3);
        ss_morlet *plan = plan_of(N, 2000, &opts);
        double *w = transform(plan, x);
        sequence s = { .plan = plan, .w = w, .thread = pthread_self() };
        assert_int_equal(ss_morlet_each(plan, x, follow, &s, NULL), SS_OK);
        assert_int_equal(s.next, ss_morlet_grid(plan)->n_scales);
        s.next = 0;
        s.stop_at = 2;
        assert_int_equal(ss_morlet_each(plan, x, follow, &s, NULL), SS_STOP);
        assert_int_equal(s.next, 2);
        ss_morlet_free(plan);
        free(w);
    }
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.progress = (ss_progress){ stop_half_way, &done };
    ss_morlet *plan = plan_of(N, 2000, &opts);
    sequence s = { .plan = plan, .thread = pthread_self() };
    double *w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w);
    s.w = w;
    assert_int_equal(ss_morlet_execute(plan, x, w, NULL), SS_STOP);
    ss_morlet_free(plan);
    opts.progress.function = NULL;
    plan = plan_of(N, 2000, &opts);
    assert_int_equal(ss_morlet_execute(plan, x, w, NULL), SS_OK);
    ss_morlet_free(plan);
    opts.progress.function = stop_half_way;
    s.plan = plan = plan_of(N, 2000, &opts);
    done = 0;
    assert_int_equal(ss_morlet_each(plan, x, follow, &s, NULL), SS_STOP);
    assert_true(done > 0.5 && s.next < ss_morlet_grid(plan)->n_scales);
    x[77] = INFINITY;
    ss_error err = { 0 };
    assert_int_equal(ss_morlet_each(plan, x, follow, &s, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "sample 78"));
    ss_morlet_free(plan);
    free(w);
}

/* Plans made, used and freed by several threads at a time, as FFTW itself would not allow. */
static void *
make_plans(void *user)
{
    enum { N = 500 };
    double x[N], *w;
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan;
    size_t *failures = user;
    make(TONE, x, N);
    opts.engine = SS_ENGINE_FFT;
    for (opts.voices = 1; opts.voices <= 12; opts.voices++) {
        *failures += ss_morlet_new(&plan, N - (size_t)opts.voices, 2000, &opts, NULL) != SS_OK;
        w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w);
        *failures += ss_morlet_execute(plan, x, w, NULL) != SS_OK;
        free(w);
        ss_morlet_free(plan);
    }
    return NULL;
}

static void
threads_may_plan_at_the_same_time(void **state)
{
    pthread_t thread[4];
    size_t failures[4] = { 0 };
    (void)state;
    for (size_t i = 0; i < LENGTH(thread); i++)
        assert_int_equal(pthread_create(&thread[i], NULL, make_plans, &failures[i]), 0);
    for (size_t i = 0; i < LENGTH(thread); i++) {
        pthread_join(thread[i], NULL);
        assert_int_equal(failures[i], 0);
    }
}

static void
engines_agree_and_damage_is_seen(void **state)
{
    enum { N = 3000 };
    double x[N], noise[N], difference = NAN;
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    make(WEAK_BURST, x, N);
    for (int i = 0; i < N; i++)
        noise[i] = (i * 7919 + i * i * 104729LL) % 1009 / 1009. - 0.5;
    for (opts.engine = SS_ENGINE_AUTO; opts.engine <= SS_ENGINE_FFT; opts.engine++) {
        ss_morlet *plan = plan_of(N, 2000, &opts);
        double *w = transform(plan, x);
        assert_int_equal(ss_morlet_compare(plan, x, w, 10, &difference, NULL), SS_OK);
        assert_true((difference > 0) == (opts.engine != SS_ENGINE_QUADRATURE) && difference < 1e-14);
        for (size_t c = 0; c < 2 * ss_morlet_grid(plan)->total; c++)
            w[c] *= 1.001;      /* of the largest, too */
        assert_int_equal(ss_morlet_compare(plan, x, w, 10, &difference, NULL), SS_OK);
        assert_true(difference > 5e-4);
        assert_int_equal(ss_morlet_compare(plan, x, w, 0, &difference, NULL), SS_EINVAL);
        free(w);
        const ss_grid *grid = ss_morlet_grid(plan);
        w = transform(plan, noise);
        for (size_t i = 0, first = 0; i < grid->n_scales; first += grid->scale[i++].n) {   /* of one scale alone */
            for (size_t c = 2 * first; c < 2 * (first + grid->scale[i].n); c++)
                w[c] *= 2;
            assert_int_equal(ss_morlet_compare(plan, noise, w, 10, &difference, NULL), SS_OK);
            assert_true(difference > 0.05);
            for (size_t c = 2 * first; c < 2 * (first + grid->scale[i].n); c++)
                w[c] /= 2;
        }
        free(w);
        ss_morlet_free(plan);
    }
}

static void
error_of_one_point_is_rounding(void **state)
{
    static const double center[] = { 2, 6, 60, 1000 };
    enum { N = 2000 };
    double x[N], rate = 2000;
    (void)state;
    for (size_t i = 0; i < LENGTH(center); i++)
        for (kind which = 0; which < KINDS; which++)
            for (int j = 0; j < 60; j++) {
                ss_morlet_opts opts = ss_morlet_defaults;
                opts.center = center[i];
                opts.admissible = j & 1;
                double a = (center[i] + 2) / (M_PI * rate) * pow(1.13, j % 12), b = j / 61., w[2];
                long double want[2];
                make(which, x, N);
                assert_int_equal(point_at(x, N, rate, &opts, a, b, w, NULL), SS_OK);
                oracle(x, N, rate, &opts, a, b, want);
                double x_max = which == OFFSET ? 1001 : which == WEAK_BURST ? 1.00001 : 1;
                double unit = sqrt(a) * x_max * (16 * DBL_EPSILON + oracle_error(&opts));
                if (!(hypotl(w[0] - want[0], w[1] - want[1]) <= unit))
                    fail_msg("center %g, %s, a = %g, b = %g", center[i], kind_name[which], a, b);
            }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_of_the_sum_is_below_its_bound),
        cmocka_unit_test(forced_scales_keep_the_bound),
        cmocka_unit_test(long_scales_by_fft_keep_the_bound),
        cmocka_unit_test(blocks_keep_the_bound),
        cmocka_unit_test(low_accuracy_keeps_the_bound),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(scales_come_one_by_one_to_the_last_bit),
        cmocka_unit_test(threads_may_plan_at_the_same_time),
        cmocka_unit_test(engines_agree_and_damage_is_seen),
        cmocka_unit_test(error_of_one_point_is_rounding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
