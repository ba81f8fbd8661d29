/* test_morlet_properties.c -- what a wavelet transform has to do with any signal, which grid it stands on,
 * and signals and options at the extremes. */
#include <stdlib.h>
#include <string.h>
#include "map/map.h"
#include "morlet_plan.h"
#include "unit.h"
#include "morlet_point.h"

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
                point_at(x, N, 2000, &opts, s * want, 2, w, NULL);
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
    for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++) {
        const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
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
    for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++) {
        const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
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
    const ss_scale *sc = ss_morlet_grid(plan)->scale;
    assert_int_equal(ss_morlet_grid(plan)->n_scales, 1);
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
    assert_int_equal(ss_morlet_grid(fast)->total, ss_morlet_grid(slow)->total);
    for (size_t i = 0; i < ss_morlet_grid(fast)->n_scales; i++) {
        const ss_scale *p = &ss_morlet_grid(fast)->scale[i], *q = &ss_morlet_grid(slow)->scale[i];
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
        point_at(x, N, 1024, &ss_morlet_defaults, a, b, u, NULL);
        if (800. / 1024 < b)
            break;
        point_at(y, N, 1024, &ss_morlet_defaults, a, 800. / 1024 - b, v, NULL);
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
    for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++) {
        const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
        assert_true(sc->a == ldexp(1, sc->j) && sc->m == sc->j);
        for (size_t k = 0; k < sc->n; k++)
            assert_true(ss_scale_b(sc, k) == ldexp((double)k, sc->j));
        assert_true(ss_scale_b(sc, sc->n - 1) <= 5999. / 2000);
        assert_true(ss_scale_b(sc, sc->n) > 5999. / 2000);
    }
    ss_morlet_free(plan);
}

/* Steps are at most B_0 a, a few percent less on average, 2^p/m samples and octaves apart by 2. */
static void
steps_are_fractions_of_samples_just_below_the_one_asked_for(void **state)
{
    static const struct { double step, least; } row[] = {
        { 0.25, 8. / 9 }, { 0.5, 7. / 8 }, { 1, 5. / 6 }, { 0.003, 8. / 9 } };
    (void)state;
    for (size_t i = 0; i < LENGTH(row); i++)
        for (double rate = 1e-3; rate < 1e7; rate *= 9.7) {
            ss_morlet_opts opts = ss_morlet_defaults;
            opts.step = row[i].step;
            ss_morlet *plan = plan_of(6000, rate, &opts);
            for (size_t j = 0; j < ss_morlet_grid(plan)->n_scales; j++) {
                const ss_scale *sc = &ss_morlet_grid(plan)->scale[j];
                double ratio = sc->b_num / sc->b_den / (opts.step * sc->a);
                double m = rint(sc->b_den / rate);
                assert_true(ratio <= 1 + 1e-15 && ratio >= row[i].least * (1 - 1e-15));
                assert_true(frexp(sc->b_num, &(int){ 0 }) == 0.5 && sc->b_den == m * rate);
                assert_true(fmod(m, 2) == 1 && m <= 45 && m * opts.step <= 17);
                if (j >= 16)
                    assert_true(sc[-16].b_num == 2 * sc->b_num && sc[-16].b_den == sc->b_den);
            }
            ss_morlet_free(plan);
        }
}

static void
exact_steps_are_the_scale_times_the_step(void **state)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    for (opts.step = 0.25; opts.step < 3; opts.step += 1) {
        opts.exact = opts.step <= 1;
        ss_morlet *plan = plan_of(6000, 2000, &opts);
        for (size_t j = 0; j < ss_morlet_grid(plan)->n_scales; j++)
            assert_true(ss_scale_b(&ss_morlet_grid(plan)->scale[j], 1)
                        == opts.step * ss_morlet_grid(plan)->scale[j].a);
        ss_morlet_free(plan);
    }
}

static void
dense_grid_has_a_coefficient_a_sample(void **state)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.dense = 1;
    for (size_t n = 12; n < 300; n++) {
        ss_morlet *plan = plan_of(n, 441. / 7, &opts);
        assert_int_equal(ss_morlet_grid(plan)->total, n * ss_morlet_grid(plan)->n_scales);
        assert_true(ss_scale_b(ss_morlet_grid(plan)->scale, n - 1) == (double)(n - 1) / (441. / 7));
        ss_morlet_free(plan);
    }
}

/* The longest scales of a long record, dense, which a thinner circle serves. */
static void
long_dense_scales_are_as_exact_by_either_engine(void **state)
{
    enum { N = 1000003 };
    double *x = test_malloc(N * sizeof *x), differs = 1;
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    for (size_t i = 0; i < N; i++)
        x[i] = sin(2e-10 * (double)i * (double)i) + (i > N / 3);
    opts.dense = opts.octaves = opts.force = opts.voices = 1;
    opts.m0 = 15, opts.m1 = 17;
    opts.accuracy = 1e-12;
    ss_morlet *plan = plan_of(N, 1, &opts);
    double *w = test_malloc(2 * ss_morlet_grid(plan)->total * sizeof *w);
    assert_int_equal(ss_morlet_execute(plan, x, w, NULL), SS_OK);
    assert_int_equal(ss_morlet_compare(plan, x, w, 5, &differs, NULL), SS_OK);
    assert_true(differs <= 2e-12);
    ss_morlet_free(plan);
    test_free(w);
    test_free(x);
}

/* Any part of a row, read alone, by the spectra, against the whole row by the sum. */
static void
parts_of_dense_rows_are_those_of_the_sum(void **state)
{
    enum { N = 4000, PART = 29 };
    static double x[N], w[2 * N], part[2 * PART];
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_coefficients *sum, *fast;
    (void)state;
    make(TONE, x, N);
    opts.dense = opts.voices = 1;
    opts.accuracy = 1e-9;
    opts.engine = SS_ENGINE_QUADRATURE;
    assert_int_equal(ss_map_of_samples(&sum, x, N, 2000, &opts, NULL), SS_OK);
    opts.engine = SS_ENGINE_FFT;
    assert_int_equal(ss_map_of_samples(&fast, x, N, 2000, &opts, NULL), SS_OK);
    for (size_t i = 0; i < sum->n_scales; i++) {
        double most = 0;
        assert_int_equal(ss_map_read(sum, &(ss_map_part){ i, 0, N, w, NULL }, 1, NULL), SS_OK);
        for (size_t k = 0; k < N; k++)
            most = fmax(most, hypot(w[2 * k], w[2 * k + 1]));
        for (size_t first = 0; first + PART <= N; first += 331) {
            assert_int_equal(ss_map_read(fast, &(ss_map_part){ i, first, PART, part, NULL }, 1, NULL), SS_OK);
            for (size_t k = 0; k < 2 * PART; k++)
                assert_true(fabs(part[k] - w[2 * first + k]) <= 2.1e-9 * most);
        }
    }
    ss_coefficients_free(fast);
    ss_coefficients_free(sum);
}

static void
default_scales_are_four_cycles_a_record_to_the_highest_resolved(void **state)
{
    (void)state;
    ss_morlet *plan = plan_of(6000, 2000, &ss_morlet_defaults);
    const ss_scale *first = ss_morlet_grid(plan)->scale;
    const ss_scale *last = &ss_morlet_grid(plan)->scale[ss_morlet_grid(plan)->n_scales - 1];
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
    const ss_scale *sc = ss_morlet_grid(plan)->scale;
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
    { 6000, 2000, 0.01, 0,    0, SS_ESCALE, "resolve scales from" },
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
        ss_error err = { 0 };
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

/* Both ends of a range belong to it. */
static void
takes_options_at_the_ends_of_their_ranges(void **state)
{
    const struct ss_morlet_ranges *in = &ss_morlet_ranges;
    (void)state;
    for (int i = 0; i < 8; i++) {
        ss_morlet *plan;
        ss_morlet_opts opts = ss_morlet_defaults;
        opts.octaves = opts.force = opts.voices = 1;
        opts.center = i == 0 ? in->center.from : i == 1 ? in->center.to : opts.center;
        opts.voices = (int)(i == 2 ? in->voices.from : i == 3 ? in->voices.to : opts.voices);
        opts.step = i == 4 ? in->step.from : i == 5 ? in->step.to : opts.step;
        opts.accuracy = i == 6 ? in->accuracy.from : i == 7 ? in->accuracy.to : opts.accuracy;
        plan = plan_of(3, 1, &opts);
        ss_morlet_free(plan);
    }
}

/* Tables whose bytes are 24 more than a size_t counts. */
static void
wavelets_too_long_for_memory_are_none(void **state)
{
    (void)state;
    assert_null(ss_wavelet_new(&ss_morlet_defaults, 1e25, 1, SIZE_MAX / 16 + 2));
}

/* --- extremes ------------------------------------------------------------------------------ */

/* To the last bit, also where coefficients are subnormal; samples of 20 bits are exact there. */
static void
amplitudes_of_any_size_scale_the_coefficients(void **state)
{
    enum { N = 300 };
    static const int power[] = { 996, -996, -1000, -1040, -1054 };
    double x[N], y[N];
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    make(TONE, x, N);
    for (size_t k = 0; k < N; k++)
        x[k] = rint(x[k] * 0x1p20) * 0x1p-20;
    for (size_t i = 0; i < 3 * LENGTH(power); i++) {
        opts.engine = (ss_engine)(i % 3), opts.norm = i % 2 == 0 ? SS_NORM_L1 : SS_NORM_L2;
        ss_morlet *plan = plan_of(N, 2000, &opts);
        double *u = transform(plan, x);
        for (size_t k = 0; k < N; k++)
            y[k] = ldexp(x[k], power[i / 3]);
        double *v = transform(plan, y);
        for (size_t c = 0; c < 2 * ss_morlet_grid(plan)->total; c++)
            assert_true(v[c] == ldexp(u[c], power[i / 3]));
        free(v);
        free(u);
        ss_morlet_free(plan);
    }
}

/* Samples that products with the wavelet would make subnormal count as zeros, others do not. */
static void
samples_below_2_to_the_minus_900_of_the_largest_count_as_zeros(void **state)
{
    enum { N = 3000 };
    double x[N], y[N];
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    for (size_t k = 0; k < N; k++) {
        x[k] = ldexp(k % 3 == 0 ? 1.5 : -1, k < N / 2 ? -(int)k : -899);
        y[k] = fabs(x[k]) < 0x1.8p-900 ? 0 : x[k];
    }
    for (opts.engine = SS_ENGINE_QUADRATURE; opts.engine <= SS_ENGINE_FFT; opts.engine++) {
        ss_morlet *plan = plan_of(N, 2000, &opts);
        double *u = transform(plan, x), *v = transform(plan, y);
        assert_memory_equal(u, v, 2 * ss_morlet_grid(plan)->total * sizeof *u);
        const ss_scale *shortest = &ss_morlet_grid(plan)->scale[ss_morlet_grid(plan)->n_scales - 1];
        assert_true(opts.engine != SS_ENGINE_QUADRATURE
                    || fabs(u[2 * (shortest->offset + shortest->n * 3 / 4)]) > 0x1p-960);
        free(u);
        free(v);
        ss_morlet_free(plan);
    }
}

static void
refuses_coefficients_that_overflow(void **state)
{
    enum { N = 4000 };
    double *x = malloc(N * sizeof *x), w[2];
    ss_error err = { 0 };
    (void)state;
    for (size_t i = 0; i < N; i++)
        x[i] = DBL_MAX * (cos(6. / 64 * (double)i) > 0 ? 1 : -1);
    assert_int_equal(point_at(x, N, 1, &ss_morlet_defaults, 64, 2000, w, &err), SS_EINVAL);
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
        assert_int_equal(point_at(x, n, 10, &ss_morlet_defaults, 0.3, 0, w,
                                         NULL), SS_OK);
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
        for (size_t i = 0; i < ss_morlet_grid(less)->n_scales; i++) {
            const ss_scale *sc = &ss_morlet_grid(less)->scale[i];
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
        for (size_t c = 0; c < 2 * ss_morlet_grid(plan)->total; c++)
            assert_true(w[c] == 0);
        ss_morlet_free(plan);
        free(w);
    }
}

static void
refuses_samples_that_are_not_finite(void **state)
{
    double x[100] = { 0 }, w[2];
    ss_error err = { 0 };
    (void)state;
    x[41] = NAN;
    assert_int_equal(point_at(x, 100, 1, &ss_morlet_defaults, 4, 40, w, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "sample 42 is NaN"));
    x[41] = -INFINITY;
    assert_int_equal(point_at(x, 100, 1, &ss_morlet_defaults, 4, 40, w, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "sample 42 is infinite"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sinusoid_is_largest_at_its_scale),
        cmocka_unit_test(cone_of_an_impulse_is_the_wavelet),
        cmocka_unit_test(is_linear),
        cmocka_unit_test(shifts_with_the_signal_by_a_lattice_step),
        cmocka_unit_test(scales_with_the_rate),
        cmocka_unit_test(is_mirrored_by_conjugation),
        cmocka_unit_test(dyadic_grid_is_exact),
        cmocka_unit_test(steps_are_fractions_of_samples_just_below_the_one_asked_for),
        cmocka_unit_test(exact_steps_are_the_scale_times_the_step),
        cmocka_unit_test(dense_grid_has_a_coefficient_a_sample),
        cmocka_unit_test(long_dense_scales_are_as_exact_by_either_engine),
        cmocka_unit_test(parts_of_dense_rows_are_those_of_the_sum),
        cmocka_unit_test(default_scales_are_four_cycles_a_record_to_the_highest_resolved),
        cmocka_unit_test(edges_are_within_the_cone),
        cmocka_unit_test(refuses_what_is_not_usable),
        cmocka_unit_test(refuses_options_out_of_range),
        cmocka_unit_test(takes_options_at_the_ends_of_their_ranges),
        cmocka_unit_test(wavelets_too_long_for_memory_are_none),
        cmocka_unit_test(amplitudes_of_any_size_scale_the_coefficients),
        cmocka_unit_test(samples_below_2_to_the_minus_900_of_the_largest_count_as_zeros),
        cmocka_unit_test(refuses_coefficients_that_overflow),
        cmocka_unit_test(one_and_two_samples_give_the_wavelet_itself),
        cmocka_unit_test(trends_are_subtracted),
        cmocka_unit_test(constant_signal_less_its_mean_is_nothing),
        cmocka_unit_test(refuses_samples_that_are_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
