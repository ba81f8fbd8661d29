/* test_waves.c -- benchmark signals, noise and the digits of a converter. */
#include <float.h>
#include <math.h>
#include "signal_text.h"
#include "noise_rms.h"
#include "signal/noise.h"

/* --- benchmark signals --------------------------------------------------------------------- */

/* With whole numbers f n is exact in integers: after 1e9 cycles the phase must still be so to
 * rounding (2 pi 2^-54) and the cosine to 1 ulp more. */
static void
sine_does_not_drift(void **state)
{
    const uint64_t f = 700000001, rate = 1000003;
    ss_wave_opts o = ss_wave_defaults;
    o.rate = (double)rate;
    o.frequency = (double)f;
    o.duration = 2;
    ss_signal *s = wave(SS_SINE, o);
    (void)state;
    for (uint64_t i = 0; i < s->n; i += 997) {
        double turn = (double)(f * i % rate) / (double)rate, should = cos(2 * M_PI * turn);
        if (!(fabs(s->values[i] - should) <= 2 * M_PI * DBL_EPSILON + DBL_EPSILON))
            fail_msg("sample %d: %.17g, not %.17g", (int)i, s->values[i], should);
    }
    ss_signal_free(s);
}

/* T = 2 s, f 5 -> 25 Hz: cycles 5 t + 5 t^2; at t = n / 100, in 1/2000 cycles: 100 n + n^2. */
static void
chirp_has_the_phase_of_a_linear_sweep(void **state)
{
    ss_wave_opts o = { .size = sizeof o, .rate = 100, .duration = 2, .amplitude = 3, .frequency = 5,
                       .frequency_end = 25 };
    ss_signal *s = wave(SS_CHIRP, o);
    (void)state;
    for (size_t n = 0; n < s->n; n++) {
        double turn = (double)((100 * n + n * n) % 2000) / 2000;
        assert_true(fabs(s->values[n] - 3 * cos(2 * M_PI * turn)) <= 3 * 8 * DBL_EPSILON);
    }
    ss_signal_free(s);
}

/* One period later it is smaller by exp(-2 pi zeta / sqrt(1 - zeta^2)), and peaks are 1/f apart. */
static void
ringdown_decays_by_its_damping_ratio(void **state)
{
    const double zeta = 0.1, ratio = exp(-2 * M_PI * zeta / sqrt(1 - zeta * zeta));
    ss_wave_opts o = { .size = sizeof o, .rate = 1000, .duration = 1, .amplitude = 2, .frequency = 20, .damping = zeta,
                       .at = 0.1 };
    ss_signal *s = wave(SS_RINGDOWN, o);
    (void)state;
    assert_true(s->values[99] == 0 && fabs(s->values[100] - 2) <= 4 * DBL_EPSILON);
    for (size_t i = 100; i + 50 < s->n; i++)
        assert_true(fabs(s->values[i + 50] - ratio * s->values[i]) <= 32 * DBL_EPSILON);
    ss_signal_free(s);
}

static void
impulse_and_step_are_where_they_should_be(void **state)
{
    ss_wave_opts o = { .size = sizeof o, .rate = 10, .duration = 1, .amplitude = 3, .at = 0.34 };
    ss_signal *impulse = wave(SS_IMPULSE, o), *step = wave(SS_STEP, o);
    (void)state;
    assert_int_equal(step->n, 10);
    for (size_t i = 0; i < 10; i++) {
        assert_true(impulse->values[i] == (i == 3 ? 3 : 0));
        assert_true(step->values[i] == (i >= 4 ? 3 : 0));
    }
    ss_signal_free(impulse);
    ss_signal_free(step);
    for (int i = 0; i < 10; i++) {              /* at a sample's own time, as it is printed */
        o.at = i / 10.;
        step = wave(SS_STEP, o);
        assert_true(step->values[i] == 3 && (i == 0 || step->values[i - 1] == 0));
        ss_signal_free(step);
    }
}

static void
refuses_waves_out_of_range(void **state)
{
    static const double bad[] = { NAN, INFINITY, -INFINITY, -1 };
    ss_signal *s;
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        ss_wave_opts o[5];
        for (int k = 0; k < 5; k++)
            o[k] = ss_wave_defaults;
        o[0].rate = bad[i];
        o[1].duration = bad[i];
        o[2].frequency = bad[i];
        o[3].frequency_end = bad[i];
        o[4].damping = bad[i];
        for (int k = 0; k < 5; k++)
            assert_int_equal(ss_wave_new(&s, SS_RINGDOWN, &o[k], NULL), SS_EINVAL);
    }
    ss_wave_opts zero = ss_wave_defaults, huge = ss_wave_defaults;
    zero.duration = 0;
    huge.rate = 1e300;
    s = wave(SS_NOISE, zero);
    assert_int_equal(s->n, 0);
    ss_signal_free(s);
    assert_int_equal(ss_wave_new(&s, SS_SINE, &huge, NULL), SS_EINVAL);
    huge.rate = 1, huge.duration = (double)(SIZE_MAX / 64);     /* rounded up: no number of samples */
    assert_int_equal(ss_wave_new(&s, SS_SINE, &huge, NULL), SS_EINVAL);
}

/* --- noise --------------------------------------------------------------------------------- */

static double
variance(const double *x, size_t n)
{
    double mean = 0, square = 0;
    for (size_t i = 0; i < n; i++)
        mean += x[i] / (double)n;
    for (size_t i = 0; i < n; i++)
        square += (x[i] - mean) * (x[i] - mean) / (double)n;
    return square;
}

/* The variance of n Gaussian numbers scatters by sqrt(2 / n): five of these, once and for all as
 * the seed is fixed. */
static void
noise_has_the_ratio_asked_for(void **state)
{
    enum { N = 100000 };
    ss_wave_opts o = { .size = sizeof o, .rate = N / 10., .duration = 10, .amplitude = 3, .frequency = 7 };
    ss_signal *clean = wave(SS_SINE, o), *noisy = wave(SS_SINE, o);
    (void)state;
    for (size_t i = 0; i < N; i++)
        clean->values[i] = noisy->values[i] += 1e3;             /* a mean must not count */
    double rms = noise_rms(clean->values, N, 20);
    assert_true(fabs(rms - 0.1 * 3 / sqrt(2)) <= 1e-12);
    assert_int_equal(ss_noise_add_once(noisy->values, N, rms, 1, NULL), SS_OK);
    for (size_t i = 0; i < N; i++)
        noisy->values[i] -= clean->values[i];
    double ratio = variance(noisy->values, N) / (rms * rms);
    assert_true(fabs(ratio - 1) <= 5 * sqrt(2. / N));
    ss_signal_free(clean);
    ss_signal_free(noisy);
}

/* Of -A, A, -B, B, ..., however large: in pieces as the order of magnitude changes between them. */
static void
a_level_is_that_of_all_pieces(void **state)
{
    static const struct { double pair[3], rms; } row[] = {
        { { 1e-300, 1e-300, 1e-300 }, 1e-300 },
        { { 1e-300, 1e-160, 1e-160 }, 0.81649658092772603e-160 },
        { { 0, 1e-200, 3 }, 1.7320508075688772 },
        { { 1e-200, 7, 1e200 }, 0.57735026918962576e200 },
        { { 5, 1e300, 1e300 }, 0.81649658092772603e300 },
    };
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        ss_variance v = { .n = 0 };
        for (size_t i = 0; i < 3; i++)
            ss_variance_add(&v, (double[2]){ row[k].pair[i], -row[k].pair[i] }, 2);
        double rms = ss_variance_noise(&v, 0);
        if (!(fabs(rms / row[k].rms - 1) <= 8 * DBL_EPSILON))
            fail_msg("row %zu: %.17g, not %.17g", k, rms, row[k].rms);
        assert_true(fabs(ss_variance_noise(&v, 20) / row[k].rms - 0.1) <= 2 * DBL_EPSILON);
    }
    assert_true(ss_variance_noise(&(ss_variance){ .n = 0 }, 0) == 0);
}

static void
noise_is_the_same_in_pieces(void **state)
{
    enum { N = 1000 };
    double whole[2][N] = { 0 }, piece[2][N] = { 0 }, other[N] = { 0 };
    const double rms[] = { 2, 0.5 };
    gsl_rng *noise;
    (void)state;
    ss_noise_new(&noise, 3, NULL);
    ss_noise_add(noise, (double *[]){ whole[0], whole[1] }, 2, N, rms, NULL);
    gsl_rng_free(noise);
    ss_noise_new(&noise, 3, NULL);
    for (size_t i = 0; i < N; i++)
        ss_noise_add(noise, (double *[]){ &piece[0][i], &piece[1][i] }, 2, 1, rms, NULL);
    gsl_rng_free(noise);
    assert_memory_equal(whole, piece, sizeof whole);
    assert_int_equal(ss_noise_add_once(other, N, 2, 4, NULL), SS_OK);
    assert_true(other[0] != whole[0][0]);
}

/* A reader of a signal in memory gives the same noise, row by row and after it has gone back, of a ratio and of an
 * rms; only the columns that are named get any. */
static void
a_reader_adds_the_same_noise(void **state)
{
    ss_signal *clean = NULL, *noisy = NULL;
    ss_reader *reader = NULL;
    ss_noise_opts opts;
    double rms[2], *column[2] = { NULL, NULL };
    ss_noise_done done = { .rms = rms };
    ss_header *head = NULL;
    size_t n;
    (void)state;
    assert_int_equal(ss_header_new(&head, 100, 0, NULL), SS_OK);
    ss_header_add_column(head, "x", NULL, NULL);
    ss_header_add_column(head, "y", NULL, NULL);
    assert_int_equal(ss_signal_new(&clean, head, 5000, NULL), SS_OK);
    for (size_t i = 0; i < 5000; i++)
        clean->values[i] = clean->values[5000 + i] = i % 2 ? 1 : -1;
    for (int pass = 0; pass < 3; pass++) {
        ss_noise_opts_init(&opts, sizeof opts);
        opts.snr = pass == 1 ? NAN : 20;
        opts.rms = pass == 1 ? 0.1 : NAN;
        opts.seed = 3;
        opts.column = &(size_t){ 1 };
        opts.n_columns = 1;
        assert_int_equal(ss_reader_of_signal(&reader, clean, NULL), SS_OK);
        assert_int_equal(ss_reader_noise(reader, &opts, &done, NULL), SS_OK);
        assert_true(isnan(rms[0]) && fabs(rms[1] - 0.1) <= 1e-15);
        assert_int_equal(ss_reader_rows(reader, column, 7, &n, NULL), SS_OK);
        assert_int_equal(ss_reader_rewind(reader, NULL), SS_OK);
        assert_int_equal(ss_signal_of_reader(&noisy, reader, NULL), SS_OK);
        double y[5000];
        memcpy(y, clean->values, sizeof y);
        assert_memory_equal(noisy->values, y, sizeof y);
        assert_int_equal(ss_noise_add_once(y, 5000, rms[1], 3, NULL), SS_OK);
        assert_memory_equal(noisy->values + 5000, y, sizeof y);
        assert_string_equal(ss_header_find_note(noisy->head, "noise"),
                            pass == 1 ? "rms 0.1, seed 3" : "snr 20 dB, seed 3");
        ss_signal_free(noisy);
        ss_reader_free(reader);
    }
    ss_signal_free(clean);
    ss_header_free(head);
}

/* The power of x at the frequencies of the record in [lo, hi], by the definition: every k-th one. */
static double
power_between(const double *x, size_t n, double rate, double lo, double hi)
{
    double power = 0;
    for (size_t k = 1; k < n / 2; k++) {
        double f = (double)k * rate / (double)n, re = 0, im = 0;
        if (f < lo || f > hi)
            continue;
        for (size_t i = 0; i < n; i++) {
            double angle = 2 * M_PI * (double)(i * k % n) / (double)n;
            re += x[i] * cos(angle);
            im += x[i] * sin(angle);
        }
        power += 2 * (re * re + im * im) / ((double)n * (double)n);
    }
    return power;
}

/* Noise of a band has its power there, flat, and the rms that was asked for.  A record that is cut out
 * of a longer one leaks as 1 / (pi distance)^2: less than 1 % of the power, 10 frequencies away. */
static void
noise_of_a_band_stays_in_it(void **state)
{
    static const struct { size_t n; double lo, hi; } band[] = {
        { 1024, 100, 200 }, { 1500, 100, 200 }, { 1500, 0, 1000 }, { 1500, 400, 1000 },
        { 1024, 62.5, 62.5 } };
    (void)state;
    for (size_t k = 0; k < sizeof band / sizeof *band; k++) {
        double x[1500] = { 0 }, again[1500] = { 0 }, square = 0, margin = 10 * 2000. / 1500;
        size_t n = band[k].n;
        gsl_rng *noise;
        for (int pass = 0; pass < 2; pass++) {
            ss_noise_new(&noise, 7, NULL);
            assert_int_equal(ss_noise_add_band(noise, pass == 0 ? x : again, n, 2000,
                                               (ss_range){ band[k].lo, band[k].hi }, 0.25, NULL), SS_OK);
            gsl_rng_free(noise);
        }
        assert_memory_equal(x, again, sizeof x);
        for (size_t i = 0; i < n; i++)
            square += x[i] * x[i] / (double)n;
        assert_true(fabs(sqrt(square) - 0.25) <= 1e-12);
        double inside = power_between(x, n, 2000, band[k].lo - margin, band[k].hi + margin);
        double mean = variance(x, n);           /* without the part at 0 Hz */
        assert_true(inside >= 0.99 * mean && inside <= mean * (1 + 1e-9));
        if (band[k].hi > band[k].lo) {          /* both halves alike: each is half but for chance */
            double middle = (band[k].lo + band[k].hi) / 2;
            double half = power_between(x, n, 2000, band[k].lo - margin, middle) / inside;
            double numbers = (band[k].hi - band[k].lo) / 2000 * (double)n;  /* free ones in a half */
            assert_true(fabs(half - 0.5) <= 5 * 0.5 / sqrt(numbers));
        }
    }
}

/* What is refused leaves a reader as it was, with its header and all its rows. */
static void
refused_noise_changes_nothing(void **state)
{
    enum { N = 100 };
    const ss_range white = { NAN, NAN };
    const struct { double snr, rms; ss_range band; int bits; } wrong[] = {
        { NAN, 1, { -1, 5 }, 0 }, { NAN, 1, { 5, 2 }, 0 }, { NAN, 1, { 5, 1001 }, 0 },
        { NAN, 1, { 5.1, 5.2 }, 0 }, { NAN, 1, { 5, NAN }, 0 }, { NAN, 0, { 5, 2 }, 0 },
        { 20, NAN, { 5.1, 5.2 }, 0 }, { NAN, -1, { 0, 100 }, 0 },
        { NAN, -1, white, 0 }, { NAN, INFINITY, white, 0 }, { 20, 1, white, 0 }, { INFINITY, NAN, white, 0 },
        { NAN, NAN, white, 53 }, { NAN, NAN, white, -1 },
    };
    ss_wave_opts o = { .size = sizeof o, .rate = 2000, .duration = N / 2000., .amplitude = 3, .frequency = 70 };
    ss_signal *clean = wave(SS_SINE, o), *read = NULL;
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        ss_noise_opts opts;
        ss_noise_done done = { .rms = NULL };
        ss_reader *reader = NULL;
        ss_error err = { 0 };
        ss_noise_opts_init(&opts, sizeof opts);
        opts.snr = wrong[i].snr;
        opts.rms = wrong[i].rms;
        opts.band = wrong[i].band;
        opts.bits = wrong[i].bits;
        opts.range = 1;
        assert_int_equal(ss_reader_of_signal(&reader, clean, NULL), SS_OK);
        if (ss_reader_noise(reader, &opts, &done, &err) != SS_EINVAL || err.text[0] == '\0')
            fail_msg("case %zu: %s", i, err.text);
        assert_int_equal(ss_reader_header(reader)->n_notes, clean->head->n_notes);
        assert_int_equal(ss_signal_of_reader(&read, reader, NULL), SS_OK);
        assert_true(read->n == N);
        assert_memory_equal(read->values, clean->values, N * sizeof *read->values);
        ss_signal_free(read);
        ss_reader_free(reader);
    }
    ss_signal_free(clean);
}

/* A ratio needs the rows twice; a reader that cannot go back says so before it gives any. */
static void
a_ratio_needs_a_reader_that_goes_back(void **state)
{
    FILE *in = tmpfile();
    ss_reader *reader = NULL;
    ss_noise_opts opts;
    ss_noise_done done = { .rms = NULL };
    ss_error err = { 0 };
    double x[3];
    size_t n;
    (void)state;
    fputs("# stickslip signal 1\n# rate: 10\n# start: 0\n# columns: x\n1\n2\n3\n", in);
    rewind(in);
    ss_noise_opts_init(&opts, sizeof opts);
    opts.snr = 20;
    assert_int_equal(ss_reader_new(&reader, in, "in", NULL, NULL), SS_OK);
    assert_int_equal(ss_reader_noise(reader, &opts, &done, &err), SS_EINVAL);
    assert_string_equal(err.text, "in: its rows are not kept to be read again");
    assert_int_equal(ss_reader_rows(reader, (double *[]){ x }, 3, &n, NULL), SS_OK);
    assert_true(n > 0 && x[0] == 1);
    ss_reader_free(reader);
    fclose(in);
}

/* A ramp over more than the range: multiples of the step, the nearest, clipped; what is wrong is even
 * between -1/2 and 1/2 of a step, so its variance is a twelfth of its square, to 1 % by the
 * ramp's own steps, and to 5 % where these are wider than the converter's. */
static void
a_converter_rounds_and_clips(void **state)
{
    enum { N = 40001 };
    static double x[N];
    (void)state;
    for (int bits = 1; bits <= 16; bits += 5) {
        double range = 2.5, step = range / (double)(1 << (bits - 1)), square = 0;
        size_t inside = 0, clipped = 7, outside = 7;
        for (size_t i = 0; i < N; i++)
            x[i] = 3 * (2. * (double)i / (N - 1) - 1);
        assert_int_equal(ss_quantise(x, N, bits, range, &clipped, NULL), SS_OK);
        for (size_t i = 0; i < N; i++) {
            double was = 3 * (2. * (double)i / (N - 1) - 1), off = x[i] - was;
            outside += was < -range - step / 2 || was > range - step / 2;
            assert_true(x[i] / step == rint(x[i] / step));
            assert_true(x[i] >= -range && x[i] <= range - step);
            if (was < -range)
                assert_true(x[i] == -range);
            else if (was > range - step / 2)
                assert_true(x[i] == range - step);
            else {
                assert_true(fabs(off) <= step / 2 * (1 + 1e-9));
                square += off * off;
                inside++;
            }
        }
        assert_int_equal(clipped, outside);
        if (bits > 1)
            assert_true(fabs(square / (double)inside / (step * step / 12) - 1)
                        <= (bits > 11 ? 0.05 : 1e-2));
    }
    size_t none = 0;
    x[0] = NAN;
    assert_int_equal(ss_quantise(x, 1, 8, 1, &none, NULL), SS_OK);
    assert_true(isnan(x[0]) && none == 0);
    assert_int_equal(ss_quantise(x, N, 0, 1, NULL, NULL), SS_EINVAL);
    assert_int_equal(ss_quantise(x, N, 53, 1, NULL, NULL), SS_EINVAL);
    assert_int_equal(ss_quantise(x, N, 8, 0, NULL, NULL), SS_EINVAL);
    assert_int_equal(ss_quantise(x, N, 8, INFINITY, NULL, NULL), SS_EINVAL);
    assert_int_equal(ss_quantise(x, N, 52, 1e-310, NULL, NULL), SS_EINVAL);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_does_not_drift),
        cmocka_unit_test(chirp_has_the_phase_of_a_linear_sweep),
        cmocka_unit_test(ringdown_decays_by_its_damping_ratio),
        cmocka_unit_test(impulse_and_step_are_where_they_should_be),
        cmocka_unit_test(refuses_waves_out_of_range),
        cmocka_unit_test(noise_has_the_ratio_asked_for),
        cmocka_unit_test(a_level_is_that_of_all_pieces),
        cmocka_unit_test(noise_is_the_same_in_pieces),
        cmocka_unit_test(a_reader_adds_the_same_noise),
        cmocka_unit_test(noise_of_a_band_stays_in_it),
        cmocka_unit_test(refused_noise_changes_nothing),
        cmocka_unit_test(a_ratio_needs_a_reader_that_goes_back),
        cmocka_unit_test(a_converter_rounds_and_clips),
    };
    return cmocka_run_group_tests_name("waves", tests, NULL, NULL);
}
