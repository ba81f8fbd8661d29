/* test_morlet.c -- wavelet coefficients against their sum in long double, against the integral of a
 * continuous signal by GSL, and by the properties that a wavelet transform has. */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include "morlet_oracle.h"

#define LENGTH(a) (sizeof (a) / sizeof *(a))

/* A plan that must be possible; the coefficients of x by it. */
static ss_morlet *
plan_of(size_t n, double rate, const ss_morlet_opts *opts)
{
    ss_morlet *plan = NULL;
    ss_error err = { "" };
    if (ss_morlet_new(&plan, n, rate, opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return plan;
}

static double *
transform(const ss_morlet *plan, const double *x)
{
    double *w = malloc((2 * ss_morlet_total(plan) + 1) * sizeof *w);
    assert_int_equal(ss_morlet_execute(plan, x, w, NULL), SS_OK);
    return w;
}

/* The largest |W| of a scale and where it is. */
static double
largest(const ss_scale *sc, const double *w, size_t *at)
{
    double most = -1;
    for (size_t k = 0; k < sc->n; k++) {
        double level = hypot(w[2 * (sc->offset + k)], w[2 * (sc->offset + k) + 1]);
        if (level > most) {
            most = level;
            *at = k;
        }
    }
    return most;
}

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
                size_t every = 1 + ss_morlet_total(plan) * s.n / 10000;
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
            size_t every = 1 + ss_morlet_total(plan) / 150;
            for (size_t j = 0; j < ss_morlet_scales(plan); j++)
                assert_int_equal(ss_morlet_engine(plan, j), SS_ENGINE_FFT);
            double worst = worst_error(plan, x, N, row[i].rate, &opts, w, every);
            if (!(worst <= 1))
                fail_msg("row %zu, %s: %g times the bound", i, kind_name[which], worst);
            ss_morlet_free(plan);
            free(w);
        }
    free(x);
}

/* Where accuracy leaves room for single precision, it is used, and the bound holds: scales by lattice
 * and by interpolation, records of odd and of prime length, of any amplitude. */
static void
single_precision_keeps_the_bound(void **state)
{
    static const double accuracy[] = { 1e-3, 1e-4, 1e-5 }, center[] = { 2, 6, 60 };
    static const double amplitude[] = { 1, 1e-300, 1e300 };
    static const size_t length[] = { 3000, 3375, 3001 };
    enum { N_MAX = 3375 };
    double x[N_MAX];
    (void)state;
    for (size_t i = 0; i < LENGTH(accuracy); i++) {
        size_t singles = 0, scales = 0;
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
                size_t used = ss_morlet_singles(plan), all = ss_morlet_scales(plan);
                double worst = worst_error(plan, x, n, 2048, &opts, w, opts.dense ? 211 : 7);
                if (!(worst <= 1))
                    fail_msg("%s, n %zu, accuracy %g, center %g, %s: %g times the bound",
                             kind_name[which], n, accuracy[i], opts.center,
                             opts.dense ? "dense" : "dyadic", worst);
                assert_true(used > 0);
                singles += used;
                scales += all;
                ss_morlet_free(plan);
                free(w);
            }
        print_message("accuracy %g: %zu of %zu scales in single precision\n", accuracy[i],
                      singles, scales);
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
    assert_memory_equal(u, v, 2 * ss_morlet_total(one) * sizeof *u);
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
    const ss_scale *want = ss_morlet_scale(s->plan, s->next);
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
        assert_int_equal(s.next, ss_morlet_scales(plan));
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
    double *w = malloc(2 * ss_morlet_total(plan) * sizeof *w);
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
    assert_true(done > 0.5 && s.next < ss_morlet_scales(plan));
    x[77] = INFINITY;
    ss_error err = { "" };
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
        w = malloc(2 * ss_morlet_total(plan) * sizeof *w);
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

/* Measured FFTs keep the bound, and what was found, in both precisions, is read back. */
static void
wisdom_is_kept_and_keeps_the_bound(void **state)
{
    enum { N = 401 };
    double x[N];
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_error err = { "" };
    FILE *file = tmpfile();
    static char text[1 << 20];          /* with all that the tests before have planned */
    (void)state;
    opts.engine = SS_ENGINE_FFT, opts.planner = SS_PLANNER_MEASURE, opts.dense = 1;
    opts.voices = 2, opts.accuracy = 1e-3;
    make(NOISE, x, N);
    ss_morlet *plan = plan_of(N, 2000, &opts);
    double *w = transform(plan, x);
    assert_true(worst_error(plan, x, N, 2000, &opts, w, 7) <= 1);
    assert_int_equal(ss_wisdom_write(file), SS_OK);
    rewind(file);
    assert_int_equal(ss_wisdom_read(file, &err), SS_OK);
    rewind(file);
    assert_true(fread(text, 1, sizeof text - 1, file) > 0);
    assert_non_null(strstr(text, "(fftw_codelet_"));
    assert_non_null(strstr(text, "(fftwf_codelet_"));
    fseek(file, strstr(text, "fftwf_wisdom #") - text, SEEK_SET);
    fputs("fftwf_wisdom?", file);
    rewind(file);
    assert_int_equal(ss_wisdom_read(file, &err), SS_EINVAL);
    rewind(file);
    fputs("nonsense", file);
    rewind(file);
    assert_int_equal(ss_wisdom_read(file, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "no wisdom"));
    opts.planner = (ss_planner)3;
    assert_int_equal(ss_morlet_new(&plan, N, 2000, &opts, NULL), SS_EINVAL);
    fclose(file);
    free(w);
    ss_morlet_free(plan);
}

static void
engines_agree_and_damage_is_seen(void **state)
{
    enum { N = 3000 };
    double x[N], difference = NAN;
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    make(WEAK_BURST, x, N);
    for (opts.engine = SS_ENGINE_AUTO; opts.engine <= SS_ENGINE_FFT; opts.engine++) {
        ss_morlet *plan = plan_of(N, 2000, &opts);
        double *w = transform(plan, x);
        assert_int_equal(ss_morlet_compare(plan, x, w, 10, &difference, NULL), SS_OK);
        assert_true(difference > 0 && difference < 2e-6);
        for (size_t c = 0; c < 2 * ss_morlet_total(plan); c++)
            w[c] *= 1.001;      /* of the largest, too */
        assert_int_equal(ss_morlet_compare(plan, x, w, 10, &difference, NULL), SS_OK);
        assert_true(difference > 5e-4);
        assert_int_equal(ss_morlet_compare(plan, x, w, 0, &difference, NULL), SS_EINVAL);
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
                assert_int_equal(ss_morlet_point(x, N, rate, &opts, a, b, w, NULL), SS_OK);
                oracle(x, N, rate, &opts, a, b, want);
                double x_max = which == OFFSET ? 1001 : which == WEAK_BURST ? 1.00001 : 1;
                double unit = sqrt(a) * x_max * (16 * DBL_EPSILON + oracle_error(&opts));
                if (!(hypotl(w[0] - want[0], w[1] - want[1]) <= unit))
                    fail_msg("center %g, %s, a = %g, b = %g", center[i], kind_name[which], a, b);
            }
}

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
    for (size_t i = 0; i < ss_morlet_scales(plan); i++) {
        const ss_scale *sc = ss_morlet_scale(plan, i);
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

/* --- benchmarks of the paper --------------------------------------------------------------- */

static void
sinusoid_is_largest_at_its_scale(void **state)
{
    enum { N = 8000 };
    static const double center[] = { 5.336, 6, 20 };
    double *x = malloc(N * sizeof *x), f = 50;
    (void)state;
    for (size_t i = 0; i < N; i++)
        x[i] = cos(2 * M_PI * f * (double)i / 2000);
    for (size_t i = 0; i < LENGTH(center); i++)
        for (ss_norm norm = SS_NORM_L2; norm <= SS_NORM_L1; norm++) {
            double wc = center[i], most = 0, a = 0;
            double want = (norm == SS_NORM_L1 ? wc : (wc + sqrt(wc * wc + 2)) / 2) / (2 * M_PI * f);
            ss_morlet_opts opts = ss_morlet_defaults;
            opts.center = wc, opts.norm = norm, opts.accuracy = 1e-9;
            for (double s = 0.98; s <= 1.02; s += 1e-4) {
                double w[2];
                ss_morlet_point(x, N, 2000, &opts, s * want, 2, w, NULL);
                if (hypot(w[0], w[1]) > most) {
                    most = hypot(w[0], w[1]);
                    a = s * want;
                }
            }
            assert_true(fabs(a / want - 1) < 1.5e-4);   /* the grid of s, and rounding of a flat top */
            if (norm == SS_NORM_L1)                     /* half of 1/a times the integral of h */
                assert_true(fabs(most / (sqrt(2 * M_PI) * pow(M_PI, -0.25) / 2) - 1) < 1e-7);
        }
    free(x);
}

static void
cone_of_an_impulse_is_the_wavelet(void **state)
{
    enum { N = 600 };
    double x[N] = { 0 }, rate = 2000;
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    x[217] = 3;
    opts.accuracy = 1e-13;
    ss_morlet *plan = plan_of(N, rate, &opts);
    double *w = transform(plan, x);
    for (size_t i = 0; i < ss_morlet_scales(plan); i++) {
        const ss_scale *sc = ss_morlet_scale(plan, i);
        for (size_t k = 0; k < sc->n; k++) {
            double *got = w + 2 * (sc->offset + k), unit = 3 / sqrt(sc->a) / rate;
            double u = (217 / rate - ss_scale_b(sc, k)) / sc->a;
            double h = unit * pow(M_PI, -0.25) * exp(-u * u / 2);
            double blur = 4 * DBL_EPSILON * N / rate / sc->a;   /* of u, by b's magnitude */
            double allow = unit * (1e-13 + 6 * blur) + 16 * DBL_EPSILON * sqrt(sc->a) * 3;
            assert_true(fabs(got[0] - h * cos(6 * u)) < allow);
            assert_true(fabs(got[1] + h * sin(6 * u)) < allow);
        }
    }
    ss_morlet_free(plan);
    free(w);
}

/* --- properties ---------------------------------------------------------------------------- */

static void
is_linear(void **state)
{
    enum { N = 700 };
    double x[3][N];
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.accuracy = 1e-13;
    make(NOISE, x[0], N);
    make(STEP, x[1], N);
    for (size_t i = 0; i < N; i++)
        x[2][i] = 2 * x[0][i] - 3 * x[1][i];
    ss_morlet *plan = plan_of(N, 2000, &opts);
    double *u = transform(plan, x[0]), *v = transform(plan, x[1]), *w = transform(plan, x[2]);
    for (size_t i = 0; i < ss_morlet_scales(plan); i++) {
        const ss_scale *sc = ss_morlet_scale(plan, i);
        double allow = sqrt(sc->a) * 5 * (3 * 1e-13 + 3 * 16 * DBL_EPSILON);
        for (size_t c = 2 * sc->offset; c < 2 * (sc->offset + sc->n); c++)
            assert_true(fabs(w[c] - (2 * u[c] - 3 * v[c])) <= allow);
    }
    ss_morlet_free(plan);
    free(u);
    free(v);
    free(w);
}

/* On the paper's grid at a rate that is a power of two, steps are whole samples. */
static void
shifts_with_the_signal_by_a_lattice_step(void **state)
{
    enum { N = 2048 };
    double x[N] = { 0 }, y[N] = { 0 };
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.voices = 1, opts.step = 1, opts.octaves = 1, opts.m0 = opts.m1 = -6, opts.accuracy = 1e-13;
    make(NOISE, x, N - 64);
    memcpy(y + 32, x, (N - 64) * sizeof *x);        /* 2 steps of 2^-6 s at 1024 Hz */
    ss_morlet *plan = plan_of(N, 1024, &opts);
    double *u = transform(plan, x), *v = transform(plan, y);
    const ss_scale *sc = ss_morlet_scale(plan, 0);
    assert_int_equal(ss_morlet_scales(plan), 1);
    assert_true(sc->a == 0x1p-6);
    for (size_t k = 0; k + 2 < sc->n; k++)
        for (int c = 0; c < 2; c++)
            assert_true(fabs(u[2 * k + c] - v[2 * k + 4 + c])
                        <= 2 * sqrt(sc->a) * (1e-13 + 16 * DBL_EPSILON));
    ss_morlet_free(plan);
    free(u);
    free(v);
}

/* The same samples at half the rate: all scales an octave longer, W larger by sqrt 2. */
static void
scales_with_the_rate(void **state)
{
    enum { N = 900 };
    double x[N];
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    make(WEAK_BURST, x, N);
    ss_morlet *fast = plan_of(N, 2000, &opts), *slow = plan_of(N, 1000, &opts);
    double *u = transform(fast, x), *v = transform(slow, x);
    assert_int_equal(ss_morlet_total(fast), ss_morlet_total(slow));
    for (size_t i = 0; i < ss_morlet_scales(fast); i++) {
        const ss_scale *p = ss_morlet_scale(fast, i), *q = ss_morlet_scale(slow, i);
        assert_true(2 * p->a == q->a && p->j + 16 == q->j && p->f == 2 * q->f);
        for (size_t c = 2 * p->offset; c < 2 * (p->offset + p->n); c++)
            assert_true(fabs(sqrt(2) * u[c] - v[c]) <= 4 * DBL_EPSILON * fabs(v[c]));
    }
    ss_morlet_free(fast);
    ss_morlet_free(slow);
    free(u);
    free(v);
}

/* W of the signal run backwards is conj W at the mirrored time. */
static void
is_mirrored_by_conjugation(void **state)
{
    enum { N = 801 };
    double x[N], y[N], u[2], v[2];
    (void)state;
    make(NOISE, x, N);
    for (size_t i = 0; i < N; i++)
        y[i] = x[N - 1 - i];
    for (int k = 0; k <= 800; k += 7) {
        double a = 0x1p-6, b = k / 1024. + 0x1p-12;
        ss_morlet_point(x, N, 1024, &ss_morlet_defaults, a, b, u, NULL);
        if (800. / 1024 < b)
            break;
        ss_morlet_point(y, N, 1024, &ss_morlet_defaults, a, 800. / 1024 - b, v, NULL);
        assert_true(hypot(u[0] - v[0], u[1] + v[1]) <= 32 * DBL_EPSILON * sqrt(a));
    }
}

/* --- grid ---------------------------------------------------------------------------------- */

static void
dyadic_grid_is_exact(void **state)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.voices = 1, opts.step = 1;
    ss_morlet *plan = plan_of(6000, 2000, &opts);
    for (size_t i = 0; i < ss_morlet_scales(plan); i++) {
        const ss_scale *sc = ss_morlet_scale(plan, i);
        assert_true(sc->a == ldexp(1, sc->j) && sc->m == sc->j);
        for (size_t k = 0; k < sc->n; k++)
            assert_true(ss_scale_b(sc, k) == ldexp((double)k, sc->j));
        assert_true(ss_scale_b(sc, sc->n - 1) <= 5999. / 2000);
        assert_true(ss_scale_b(sc, sc->n) > 5999. / 2000);
    }
    ss_morlet_free(plan);
}

static void
dense_grid_has_a_coefficient_a_sample(void **state)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.dense = 1;
    for (size_t n = 12; n < 300; n++) {
        ss_morlet *plan = plan_of(n, 441. / 7, &opts);
        assert_int_equal(ss_morlet_total(plan), n * ss_morlet_scales(plan));
        assert_true(ss_scale_b(ss_morlet_scale(plan, 0), n - 1) == (double)(n - 1) / (441. / 7));
        ss_morlet_free(plan);
    }
}

static void
default_scales_are_four_cycles_a_record_to_the_highest_resolved(void **state)
{
    (void)state;
    ss_morlet *plan = plan_of(6000, 2000, &ss_morlet_defaults);
    const ss_scale *first = ss_morlet_scale(plan, 0);
    const ss_scale *last = ss_morlet_scale(plan, ss_morlet_scales(plan) - 1);
    double d = exp2(1. / 16), u;
    assert_true(first->f >= 4. / 3 && first->f / d < 4. / 3);
    u = last->a * M_PI * 2000 - 6;
    assert_true(exp(-u * u / 2) <= 1e-6);
    u = last->a / d * M_PI * 2000 - 6;
    assert_true(exp(-u * u / 2) > 1e-6);
    ss_morlet_free(plan);
}

static void
edges_are_within_the_cone(void **state)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.octaves = 1, opts.m0 = opts.m1 = -3, opts.dense = 1;
    ss_morlet *plan = plan_of(1001, 1000, &opts);
    const ss_scale *sc = ss_morlet_scale(plan, 0);
    for (size_t k = 0; k < sc->n; k++)      /* sqrt(2)/8 s = 176.8 samples */
        assert_int_equal(ss_scale_edge(sc, k, 1001, 1000), k <= 176 || k >= 1000 - 176);
    ss_morlet_free(plan);
}

static const struct refusal {
    size_t n;
    double rate, fmin, fmax;
    int force;
    ss_status status;
    const char *says;
} refusal[] = {
    { 6000, 2000, 0,    1000, 0, SS_ESCALE, "from 0.914444 to 510.57 Hz" },
    { 6000, 2000, 0.01, 0,    0, SS_ESCALE, "--force" },
    { 6000, 2000, 900,  0,    0, SS_ESCALE, "from 0.914444 to 510.57 Hz" },
    { 6000, 2000, 0.01, 1000, 1, SS_OK,     "" },
    { 6000, 2000, 100,  100.1, 0, SS_EINVAL, "no scale lies between" },
    { 6000, 2000, 200,  100,  0, SS_EINVAL, "fmin" },
    { 6000, 2000, NAN,  100,  0, SS_EINVAL, "fmin" },
    { 0,    2000, 0,    0,    0, SS_EINVAL, "empty" },
    { 1,    2000, 0,    0,    0, SS_ESCALE, "1 sample at 2000 Hz is too short" },
    { 10,   2000, 0,    0,    0, SS_ESCALE, "11 samples are needed" },
    { 11,   2000, 0,    0,    0, SS_OK,     "" },
    { 1,    2000, 0,    0,    1, SS_ESCALE, "both limits" },
    { 1,    2000, 10,   100,  1, SS_OK,     "" },
    { 2,    2000, 10,   100,  1, SS_OK,     "" },
    { 6000, NAN,  0,    0,    0, SS_EINVAL, "rate" },
    { 6000, 0,    0,    0,    0, SS_EINVAL, "rate" },
    { 6000, INFINITY, 0, 0,   0, SS_EINVAL, "rate" },
};

static void
refuses_what_is_not_usable(void **state)
{
    (void)state;
    for (size_t i = 0; i < LENGTH(refusal); i++) {
        struct refusal r = refusal[i];
        ss_morlet *plan = NULL;
        ss_error err = { "" };
        ss_morlet_opts opts = ss_morlet_defaults;
        opts.fmin = r.fmin, opts.fmax = r.fmax, opts.force = r.force;
        ss_status st = ss_morlet_new(&plan, r.n, r.rate, &opts, &err);
        if (st != r.status || strstr(err.text, r.says) == NULL)
            fail_msg("row %zu: %d, %s", i, st, err.text);
        ss_morlet_free(plan);
    }
}

static void
refuses_options_out_of_range(void **state)
{
    ss_morlet_opts bad[] = {
        { .center = 1.9 }, { .center = NAN }, { .voices = 0 }, { .voices = 1025 }, { .step = 0 },
        { .step = INFINITY }, { .accuracy = 1e-14 }, { .accuracy = NAN }, { .norm = 2 },
        { .detrend = 3 }, { .engine = 3 }, { .octaves = 1, .m0 = 1 }, { .step = 1e-300 },
        { .threads = -1 } };
    (void)state;
    for (size_t i = 0; i < LENGTH(bad); i++) {
        ss_morlet *plan = NULL;
        ss_morlet_opts opts = ss_morlet_defaults, *b = &bad[i];
        opts.center = i < 2 ? b->center : 6;
        opts.voices = i == 2 || i == 3 ? b->voices : 16;
        opts.step = i == 4 || i == 5 || i == 12 ? b->step : 0.25;
        opts.accuracy = i == 6 || i == 7 ? b->accuracy : 1e-6;
        opts.norm = b->norm, opts.detrend = b->detrend, opts.engine = b->engine;
        opts.threads = 1 + b->threads;
        opts.octaves = b->octaves, opts.m0 = b->m0, opts.m1 = b->m1;
        if (ss_morlet_new(&plan, 1000, 2000, &opts, NULL) != SS_EINVAL)
            fail_msg("row %zu was accepted", i);
    }
}

/* --- extremes ------------------------------------------------------------------------------ */

static void
amplitudes_of_any_size_scale_the_coefficients(void **state)
{
    enum { N = 300 };
    static const int power[] = { 996, -996, -1000 };    /* 1e300 and 1e-300 */
    double x[N], y[N];
    (void)state;
    make(TONE, x, N);
    ss_morlet *plan = plan_of(N, 2000, &ss_morlet_defaults);
    double *u = transform(plan, x);
    for (size_t i = 0; i < LENGTH(power); i++) {
        for (size_t k = 0; k < N; k++)
            y[k] = ldexp(x[k], power[i]);
        double *v = transform(plan, y);
        for (size_t c = 0; c < 2 * ss_morlet_total(plan); c++)
            assert_true(fabs(v[c] - ldexp(u[c], power[i])) <= 0x1p-1070);   /* a subnormal ulp */
        free(v);
    }
    ss_morlet_free(plan);
    free(u);
}

static void
refuses_coefficients_that_overflow(void **state)
{
    enum { N = 4000 };
    double *x = malloc(N * sizeof *x), w[2];
    ss_error err = { "" };
    (void)state;
    for (size_t i = 0; i < N; i++)
        x[i] = DBL_MAX * (cos(6. / 64 * (double)i) > 0 ? 1 : -1);
    assert_int_equal(ss_morlet_point(x, N, 1, &ss_morlet_defaults, 64, 2000, w, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "exceed"));
    free(x);
}

static void
one_and_two_samples_give_the_wavelet_itself(void **state)
{
    double x[2] = { 3, -5 }, w[2];
    long double want[2];
    (void)state;
    for (size_t n = 1; n <= 2; n++) {
        assert_int_equal(ss_morlet_point(x, n, 10, &ss_morlet_defaults, 0.3, 0, w, NULL), SS_OK);
        oracle(x, n, 10, &ss_morlet_defaults, 0.3, 0, want);
        assert_true(hypotl(w[0] - want[0], w[1] - want[1]) < 16 * DBL_EPSILON * sqrt(0.3) * 5);
    }
}

static void
trends_are_subtracted(void **state)
{
    enum { N = 1000 };
    double x[N], y[N];
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.accuracy = 1e-12;
    for (ss_detrend d = SS_DETREND_MEAN; d <= SS_DETREND_LINEAR; d++) {
        double sum = 0, moment = 0, top = 0;
        make(TONE, x, N);
        for (size_t i = 0; i < N; i++) {
            sum += x[i] / N;
            moment += x[i] * ((double)i - 499.5);
        }
        double slope = d == SS_DETREND_LINEAR ? moment / (N * (N * (double)N - 1) / 12) : 0;
        for (size_t i = 0; i < N; i++) {
            double line = d == SS_DETREND_LINEAR ? 0.25 * (double)i : 0;
            y[i] = x[i] + 128 + line;           /* its own trend is found besides */
            x[i] -= sum + slope * ((double)i - 499.5);
            top = fmax(top, fabs(y[i]));
        }
        opts.detrend = SS_DETREND_NONE;
        ss_morlet *plain = plan_of(N, 2000, &opts);
        opts.detrend = d;
        ss_morlet *less = plan_of(N, 2000, &opts);
        double *u = transform(plain, x), *v = transform(less, y);
        for (size_t i = 0; i < ss_morlet_scales(less); i++) {
            const ss_scale *sc = ss_morlet_scale(less, i);
            for (size_t c = 2 * sc->offset; c < 2 * (sc->offset + sc->n); c++)
                assert_true(fabs(u[c] - v[c])
                            <= sqrt(sc->a) * (2e-12 * 2 + 16 * DBL_EPSILON * top));
        }
        ss_morlet_free(plain);
        ss_morlet_free(less);
        free(u);
        free(v);
    }
}

static void
constant_signal_less_its_mean_is_nothing(void **state)
{
    double x[500];
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    for (size_t i = 0; i < 500; i++)
        x[i] = 0.1;
    for (opts.detrend = SS_DETREND_MEAN; opts.detrend <= SS_DETREND_LINEAR; opts.detrend++) {
        ss_morlet *plan = plan_of(500, 2000, &opts);
        double *w = transform(plan, x);
        for (size_t c = 0; c < 2 * ss_morlet_total(plan); c++)
            assert_true(w[c] == 0);
        ss_morlet_free(plan);
        free(w);
    }
}

static void
refuses_samples_that_are_not_finite(void **state)
{
    double x[100] = { 0 }, w[2];
    ss_error err = { "" };
    (void)state;
    x[41] = NAN;
    assert_int_equal(ss_morlet_point(x, 100, 1, &ss_morlet_defaults, 4, 40, w, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "sample 42 is NaN"));
    x[41] = -INFINITY;
    assert_int_equal(ss_morlet_point(x, 100, 1, &ss_morlet_defaults, 4, 40, w, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "sample 42 is infinite"));
}

static void
refuses_points_off_the_plane(void **state)
{
    static const double bad[][2] = { { 0, 1 }, { -1, 1 }, { NAN, 1 }, { INFINITY, 1 }, { 1, -1 },
                                     { 1, 100 }, { 1, NAN } };
    double x[100] = { 0 }, w[2];
    (void)state;
    for (size_t i = 0; i < LENGTH(bad); i++)
        assert_int_equal(ss_morlet_point(x, 100, 1, &ss_morlet_defaults, bad[i][0], bad[i][1], w,
                                         NULL), SS_EINVAL);
}

/* --- the stream ---------------------------------------------------------------------------- */

static ss_coefficients *
some_coefficients(const ss_morlet_opts *opts)
{
    ss_header *head = ss_header_new(2000, 0.125);
    ss_signal *signal = NULL;
    ss_coefficients *coef = NULL;
    ss_header_add_column(head, "x", "m");
    ss_header_add_column(head, "a", "m/s^2");
    ss_header_note(head, "scene", "compliant-light");
    assert_int_equal(ss_signal_new(&signal, head, 300), SS_OK);
    make(WEAK_BURST, signal->values + 300, 300);
    assert_int_equal(ss_morlet_transform(&coef, signal, 1, opts, NULL), SS_OK);
    ss_header_free(head);
    ss_signal_free(signal);
    return coef;
}

static void
assert_same(const ss_coefficients *p, const ss_coefficients *q)
{
    const ss_scale *last = &p->scale[p->n_scales - 1];
    assert_int_equal(p->n, q->n);
    assert_int_equal(p->n_scales, q->n_scales);
    assert_true(p->center == q->center);
    assert_true(p->head->rate == q->head->rate && p->head->start == q->head->start);
    assert_int_equal(q->head->n_columns, 1);
    assert_string_equal(p->head->column[0].name, q->head->column[0].name);
    assert_string_equal(p->head->column[0].unit, q->head->column[0].unit);
    assert_int_equal(p->head->n_notes, q->head->n_notes);
    for (size_t i = 0; i < p->head->n_notes; i++)
        assert_string_equal(p->head->note[i], q->head->note[i]);
    for (size_t i = 0; i < p->n_scales; i++) {
        const ss_scale *s = &p->scale[i], *t = &q->scale[i];
        assert_true(s->j == t->j && s->m == t->m && s->a == t->a && s->f == t->f
                    && s->b_num == t->b_num && s->b_den == t->b_den && s->n == t->n
                    && s->offset == t->offset);
    }
    assert_memory_equal(p->w, q->w, 2 * (last->offset + last->n) * sizeof *p->w);
}

static void
stream_reads_back_the_same(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        ss_coefficients *back = NULL;
        ss_error err = { "" };
        FILE *file = tmpfile();
        opts.voices = i == 1 ? 1 : 5;
        opts.dense = i == 2;
        ss_coefficients *coef = some_coefficients(&opts);
        assert_string_equal(ss_header_find_note(coef->head, "scene"), "compliant-light");
        assert_string_equal(ss_header_find_note(coef->head, "column"), "a");
        assert_int_equal(ss_coefficients_write(coef, file, SS_TSV), SS_OK);
        rewind(file);
        if (ss_coefficients_read(&back, file, "c.tsv", &err) != SS_OK)
            fail_msg("%s", err.text);
        assert_same(coef, back);
        assert_true(ss_coefficients_max(coef) == ss_coefficients_max(back));
        ss_coefficients_free(coef);
        ss_coefficients_free(back);
        fclose(file);
    }
}

static int
by_time(const void *a, const void *b)
{
    double s = 0, t = 0;
    sscanf(*(char *const *)a, "%*s %*s %lf", &s);
    sscanf(*(char *const *)b, "%*s %*s %lf", &t);
    return (s > t) - (s < t);
}

static void
stream_may_interleave_scales(void **state)
{
    char *line[2000] = { NULL };
    size_t n = 0, size = 0, header = 0;
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.voices = 2;
    ss_coefficients *coef = some_coefficients(&opts), *back = NULL;
    FILE *file = tmpfile(), *mixed = tmpfile();
    (void)state;
    ss_coefficients_write(coef, file, SS_TSV);
    rewind(file);
    for (; n < LENGTH(line) && getline(&line[n], &size, file) > 0; n++, size = 0)
        header += line[n][0] == '#';
    qsort(line + header, n - header, sizeof *line, by_time);
    for (size_t i = 0; i < LENGTH(line); i++) {
        if (i < n)
            fputs(line[i], mixed);
        free(line[i]);
    }
    rewind(mixed);
    assert_true(n < LENGTH(line));
    assert_int_equal(ss_coefficients_read(&back, mixed, "c.tsv", NULL), SS_OK);
    assert_same(coef, back);
    ss_coefficients_free(coef);
    ss_coefficients_free(back);
    fclose(file);
    fclose(mixed);
}

/* One change to a good stream, and what must be said of it. */
static const struct damage {
    const char *from, *to, *says;
} damage[] = {
    { "# stickslip coefficients 1", "# stickslip signal 1", "c.tsv: a signal, not wavelet coefficients" },
    { "# stickslip coefficients 1", "t,x,a", "c.tsv:1: not wavelet coefficients" },
    { "# rate: 2000", "# rate: fast", "rate 'fast' is not a number" },
    { "# rate: 2000", "# rate: -1", "rate -1 Hz is out of range" },
    { "# samples: 300\n", "# a:b: c\n", "c.tsv:3: 'a:b' cannot be the key of a note" },
    { "# samples: 300\n", "# : x\n", "c.tsv:3: '' cannot be the key of a note" },
    { "# stickslip coefficients 1", "\211HDF\r", "c.tsv: HDF5 cannot be read from a stream" },
    { "# samples: 300\n", "", "no line '# samples: ...'" },
    { "# samples: 300", "# samples: 300.5", "not whole numbers" },
    { "# samples: 300", "# samples: 400", "edge is 1" },
    { "# voices: 2", "# voices: 3", "not those of a scale" },
    { "# step: 0.25", "# step: 0.5", "b is 0.0078125 s where the grid has 0.015625 s" },
    { "# center: 6", "# center: 7", "not those of a scale" },
    { "# columns: m a/s", "# columns: m a/min", "expected '# columns: m a/s b/s" },
    { "-5\t0.03125\t0\t", "-5\t0.03125\tzero\t", "column 3 is not a number" },
    { "-5\t0.03125\t0\t", "-5\t0.03125\tnan\t", "column 3 is not a number" },
    { "-5\t0.03125\t0\t", "-5\t0.03125\t0 ", "expected 7 numbers separated by tabs" },
    { "-5\t0.03125\t0\t", "-5\t0.03125\t0.1\t", "b is 0.1 s where the grid has 0 s" },
    { "-5\t0.03125\t0\t", "1e300\t0.03125\t0\t", "not those of a scale" },
    { "\t1\n-5\t0.03125\t0.0078125", "\t0\n-5\t0.03125\t0.0078125", "edge is 0" },
    { "\t1\n-5\t0.03125\t0.0078125", "\t1\t2\n-5\t0.03125\t0.0078125", "separated by tabs" },
};

/* The text with its first from put in place by to. */
static FILE *
damaged(const char *text, const struct damage *d)
{
    const char *at = strstr(text, d->from);
    FILE *file = tmpfile();
    if (at == NULL)
        fail_msg("no '%s' to damage", d->from);
    fwrite(text, 1, (size_t)(at - text), file);
    fputs(d->to, file);
    fputs(at + strlen(d->from), file);
    rewind(file);
    return file;
}

static void
assert_refused(FILE *file, const char *says)
{
    ss_coefficients *back = NULL;
    ss_error err = { "" };
    ss_status st = ss_coefficients_read(&back, file, "c.tsv", &err);
    if (st != SS_EDATA || strncmp(err.text, "c.tsv:", 6) != 0 || strstr(err.text, says) == NULL)
        fail_msg("'%s' expected, not %d, '%s'", says, st, err.text);
    fclose(file);
}

static void
refuses_broken_streams(void **state)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.voices = 2, opts.octaves = 1, opts.m0 = -6, opts.m1 = -5;
    ss_coefficients *coef = some_coefficients(&opts);
    ss_coefficients_write(coef, file, SS_TSV);
    ss_coefficients_free(coef);
    fclose(file);
    for (size_t i = 0; i < LENGTH(damage); i++)
        assert_refused(damaged(text, &damage[i]), damage[i].says);

    char *last = strrchr(text, '\t');           /* cut within the last row, then before it */
    *last = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "separated by tabs");
    strrchr(text, '\n')[1] = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "coefficients of scale -6");
    strstr(text, "edge\n")[5] = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "without coefficients");
    *strstr(text, "# columns") = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "ends before '# columns");
    *text = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "empty");
    free(text);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_of_the_sum_is_below_its_bound),
        cmocka_unit_test(forced_scales_keep_the_bound),
        cmocka_unit_test(long_scales_by_fft_keep_the_bound),
        cmocka_unit_test(single_precision_keeps_the_bound),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(scales_come_one_by_one_to_the_last_bit),
        cmocka_unit_test(threads_may_plan_at_the_same_time),
        cmocka_unit_test(wisdom_is_kept_and_keeps_the_bound),
        cmocka_unit_test(engines_agree_and_damage_is_seen),
        cmocka_unit_test(error_of_one_point_is_rounding),
        cmocka_unit_test(agrees_with_the_integral_of_what_the_sampling_resolves),
        cmocka_unit_test(sampling_error_of_an_abrupt_start_is_of_first_order),
        cmocka_unit_test(sinusoid_is_largest_at_its_scale),
        cmocka_unit_test(cone_of_an_impulse_is_the_wavelet),
        cmocka_unit_test(is_linear),
        cmocka_unit_test(shifts_with_the_signal_by_a_lattice_step),
        cmocka_unit_test(scales_with_the_rate),
        cmocka_unit_test(is_mirrored_by_conjugation),
        cmocka_unit_test(dyadic_grid_is_exact),
        cmocka_unit_test(dense_grid_has_a_coefficient_a_sample),
        cmocka_unit_test(default_scales_are_four_cycles_a_record_to_the_highest_resolved),
        cmocka_unit_test(edges_are_within_the_cone),
        cmocka_unit_test(refuses_what_is_not_usable),
        cmocka_unit_test(refuses_options_out_of_range),
        cmocka_unit_test(amplitudes_of_any_size_scale_the_coefficients),
        cmocka_unit_test(refuses_coefficients_that_overflow),
        cmocka_unit_test(one_and_two_samples_give_the_wavelet_itself),
        cmocka_unit_test(trends_are_subtracted),
        cmocka_unit_test(constant_signal_less_its_mean_is_nothing),
        cmocka_unit_test(refuses_samples_that_are_not_finite),
        cmocka_unit_test(refuses_points_off_the_plane),
        cmocka_unit_test(stream_reads_back_the_same),
        cmocka_unit_test(stream_may_interleave_scales),
        cmocka_unit_test(refuses_broken_streams),
    };
    gsl_set_error_handler_off();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
