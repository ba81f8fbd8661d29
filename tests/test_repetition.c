/* test_repetition.c -- what repeats, and what does not, in random draws of each kind.
 *
 * What does not repeat may have no repetition_frequency, or one after which it does repeat: over one of
 * its periods, and over eight, as read from the samples themselves.  What repeats, with drift or jitter,
 * has one with an error that covers its mean frequency. */
#include <stdlib.h>
#include <math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stickslip.h>

#include "find/cycles.h"
#include "new_signal.h"
#include "unit.h"

enum { RATE = 1000, N = 6000, DRAWS = 60 };
#define SECONDS ((double)N / RATE)

static double
between(gsl_rng *rng, double lo, double hi)
{
    return lo * pow(hi / lo, gsl_rng_uniform(rng));
}

static double
turn(gsl_rng *rng)
{
    return 2 * M_PI * gsl_rng_uniform(rng);
}

static void
add_noise(gsl_rng *rng, double *x, double rms)
{
    for (size_t i = 0; i < N; i++)
        x[i] += gsl_ran_gaussian(rng, rms);
}

/* --- what does not repeat --------------------------------------------------------------------- */

/* 3 to 12 swells, of 10 carrier periods each or more. */
static void
fill_modulated(gsl_rng *rng, double *x)
{
    double swell = between(rng, 3, 12) / SECONDS, f = swell * between(rng, 10, 25);
    double depth = 0.3 + 0.7 * gsl_rng_uniform(rng), a = turn(rng), b = turn(rng);
    for (size_t i = 0; i < N; i++) {
        double t = (double)i / RATE;
        x[i] = (1 + depth * cos(2 * M_PI * swell * t + a)) * cos(2 * M_PI * f * t + b);
    }
}

static void
fill_beats(gsl_rng *rng, double *x)
{
    double f = between(rng, 10, 60), other = f + between(rng, 3, 12) / SECONDS;
    double size = between(rng, 0.3, 1), a = turn(rng), b = turn(rng);
    for (size_t i = 0; i < N; i++) {
        double t = (double)i / RATE;
        x[i] = cos(2 * M_PI * f * t + a) + size * cos(2 * M_PI * other * t + b);
    }
}

static void
fill_ringdown(gsl_rng *rng, double *x)
{
    double f = between(rng, 10, 100), ratio = between(rng, 0.003, 0.1);
    double start = (0.05 + 0.4 * gsl_rng_uniform(rng)) * SECONDS;
    for (size_t i = 0; i < N; i++) {
        double u = (double)i / RATE - start;
        x[i] = u < 0 ? 0 : exp(-2 * M_PI * f * ratio * u) * sin(2 * M_PI * f * u);
    }
}

/* Over an octave or more. */
static void
fill_chirp(gsl_rng *rng, double *x)
{
    double f = between(rng, 3, 30), to = f * between(rng, 2, 5), phase = turn(rng);
    for (size_t i = 0; i < N; i++) {
        double t = (double)i / RATE;
        x[i] = cos(2 * M_PI * (f * t + (to - f) * t * t / (2 * SECONDS)) + phase);
    }
}

/* White, or through a pole up to that of a random walk. */
static void
fill_noise(gsl_rng *rng, double *x)
{
    double pole = 1 - between(rng, 1e-3, 1), last = 0;
    for (size_t i = 0; i < N; i++)
        x[i] = last = pole * last + gsl_ran_gaussian(rng, 1);
}

/* As through a resonance of 8 to 30 times its bandwidth: narrower ones keep time for some cycles. */
static void
fill_narrow_noise(gsl_rng *rng, double *x)
{
    double f = between(rng, 10, 100), r = exp(-M_PI * f / between(rng, 8, 30) / RATE), y = 0, z = 0;
    for (size_t i = 0; i < N + 4 * RATE; i++) {
        double next = 2 * r * cos(2 * M_PI * f / RATE) * y - r * r * z + gsl_ran_gaussian(rng, 1);
        z = y, y = next;
        if (i >= 4 * RATE)
            x[i - 4 * RATE] = y;
    }
}

/* 10 to 40 impacts at random times, of random strength, each of which rings. */
static void
fill_impacts(gsl_rng *rng, double *x)
{
    double f = between(rng, 20, 150), ratio = between(rng, 0.004, 0.1), t = 0;
    double each = SECONDS / between(rng, 10, 40);
    for (size_t i = 0; i < N; i++)
        x[i] = 0;
    for (t = gsl_ran_exponential(rng, each); t < SECONDS; t += gsl_ran_exponential(rng, each)) {
        double strength = between(rng, 0.3, 1);
        for (size_t i = (size_t)ceil(t * RATE); i < N; i++) {
            double u = (double)i / RATE - t;
            x[i] += strength * exp(-2 * M_PI * f * ratio * u) * sin(2 * M_PI * f * u);
        }
    }
}

/* A sawtooth with teeth of unequal length, jitter of their mean. */
static size_t
fill_teeth(gsl_rng *rng, double *x, double jitter, double *first, double *last)
{
    double each = SECONDS / between(rng, 10, 60), from = -each * gsl_rng_uniform(rng), to = from;
    size_t n = 0;
    for (size_t i = 0; i < N; i++) {
        double t = (double)i / RATE;
        while (t >= to) {
            if (to > 0) {
                *first = n == 0 ? to : *first;
                *last = to;
                n++;
            }
            from = to;
            to += each * fmax(0.2, 1 + gsl_ran_gaussian(rng, jitter));
        }
        x[i] = (t - from) / each;
    }
    return n;
}

static void
fill_irregular(gsl_rng *rng, double *x)
{
    double first, last;
    fill_teeth(rng, x, between(rng, 0.25, 0.6), &first, &last);
}

typedef struct kind {
    const char *name;
    void (*fill)(gsl_rng *rng, double *x);
} kind;

static const kind kinds[] = {
    { "modulated", fill_modulated }, { "beats", fill_beats }, { "rings once", fill_ringdown },
    { "chirp", fill_chirp }, { "noise", fill_noise }, { "narrow noise", fill_narrow_noise },
    { "impacts", fill_impacts }, { "irregular teeth", fill_irregular } };
enum { KINDS = sizeof kinds / sizeof *kinds };

/* The correlation of the record with itself so many samples later. */
static double
correlation(const double *x, double lag)
{
    size_t shift = (size_t)lag, m = N - shift - 1;
    double part = lag - (double)shift, sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;
    for (size_t i = 0; i < m; i++) {
        double y = x[i + shift] + part * (x[i + shift + 1] - x[i + shift]);
        sx += x[i], sy += y;
        xx += x[i] * x[i], yy += y * y, xy += x[i] * y;
    }
    double n = (double)m, vx = xx - sx * sx / n, vy = yy - sy * sy / n;
    return (xy - sx * sy / n) / sqrt(vx * vy);
}

static int
note_progress(double done, void *last)
{
    if (!(done >= *(double *)last && done <= 1))
        fail_msg("%g after %g", done, *(double *)last);
    *(double *)last = done;
    return 0;
}

/* On the way, progress rises to .9 at least; where a hum is subtracted, there is a second pass. */
static ss_features *
features_of(const double *x)
{
    ss_signal *signal = new_signal(N, RATE, 0, "signal", "");
    ss_features *f = NULL;
    double done = 0;
    ss_features_opts opts;
    ss_features_opts_init(&opts, sizeof opts);
    opts.progress = (ss_progress){ note_progress, &done };
    for (size_t i = 0; i < N; i++)
        signal->values[i] = x[i];
    assert_int_equal(ss_features_find(&f, signal, 0, &opts, NULL), SS_OK);
    assert_true(done >= 0.9);
    ss_signal_free(signal);
    return f;
}

static void
nothing_repeats_that_does_not(void **state)
{
    static double x[N];
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int wrong = 0;
    (void)state;
    for (size_t k = 0; k < KINDS; k++)
        for (unsigned long i = 0; i < DRAWS; i++) {
            gsl_rng_set(rng, KINDS * i + k + 1);
            kinds[k].fill(rng, x);
            double power = 0;
            for (size_t j = 0; j < N; j++)
                power += x[j] * x[j] / N;
            if (i % 2)
                add_noise(rng, x, 0.01 * sqrt(power));
            ss_features *f = features_of(x);
            double lag = RATE / f->number[SS_REPETITION_FREQUENCY].value;
            double far = fmin(8, floor(N / lag / 4)) * lag;
            if (!isnan(lag) && !(correlation(x, lag) > 0.9 && correlation(x, far) > 0.5)) {
                print_message("%s %lu: %g +- %g Hz, correlation %.3f and %.3f\n", kinds[k].name, i,
                              f->number[SS_REPETITION_FREQUENCY].value,
                                  f->number[SS_REPETITION_FREQUENCY].error,
                              correlation(x, lag), correlation(x, far));
                wrong++;
            }
            ss_features_free(f);
        }
    gsl_rng_free(rng);
    assert_int_equal(wrong, 0);
}

/* --- what repeats ----------------------------------------------------------------------------- */

/* The mean frequency of a sawtooth, a pulse train or a sum of harmonics whose clock drifts by up to 1 %
 * over the record. */
static double
fill_drifting(gsl_rng *rng, double *x)
{
    double f = between(rng, 8, 30) / SECONDS, drift = 0.02 * (gsl_rng_uniform(rng) - 0.5);
    double phase = gsl_rng_uniform(rng), size[6], at[6];
    int shape = (int)gsl_rng_uniform_int(rng, 3);
    for (int k = 0; k < 6; k++)
        size[k] = between(rng, 0.1, 1), at[k] = turn(rng);
    for (size_t i = 0; i < N; i++) {
        double u = (double)i / N, cycle = f * SECONDS * (u + drift * (u * u - u) / 2) + phase;
        double part = cycle - floor(cycle), sum = 0;
        for (int k = 0; k < 6; k++)
            sum += size[k] * cos(2 * M_PI * (k + 1) * cycle + at[k]);
        x[i] = shape == 0 ? part : shape == 1 ? exp(-part * 20) : sum;
    }
    return f;
}

static double
fill_regular(gsl_rng *rng, double *x)
{
    double first = 0, last = 0;
    size_t n = fill_teeth(rng, x, between(rng, 1e-3, 0.03), &first, &last);
    return (double)(n - 1) / (last - first);
}

/* Half-sines, as the teeth of a cutter make, beside a hum of 4 to 30 times their frequency; cycles later it is
 * never in step (golden section). */
static double
fill_hummed(gsl_rng *rng, double *x)
{
    double f = between(rng, 15, 150) / SECONDS, phase = turn(rng), hum = between(rng, 0.05, 0.3);
    double power = between(rng, 0.5, 2), ratio = 4 + (double)gsl_rng_uniform_int(rng, 26) + 0.381966;
    for (size_t i = 0; i < N; i++) {
        double at = 2 * M_PI * f * (double)i / RATE;
        x[i] = pow(fmax(0, sin(at + phase)), power) + hum * sin(ratio * at);
    }
    return f;
}

/* Ramps that fall back at once, whose period is so nearly a whole number of samples that each lasts as many. */
static double
fill_in_step(gsl_rng *rng, double *x)
{
    double n = 8 + (double)gsl_rng_uniform_int(rng, 23), samples = floor(N / n);
    double f = RATE / (samples + (gsl_rng_uniform(rng) - 0.5) / n), start = gsl_rng_uniform(rng);
    for (size_t i = 0; i < N; i++)
        x[i] = fmod(start + f * (double)i / RATE, 1);
    return f;
}

/* Five cycles that decay, or grow, tenfold in energy from the first to the last are one ringing, a few less are not. */
static void
what_decays_tenfold_rings_once(void **state)
{
    enum { PERIOD = 160, SAMPLES = 63 * PERIOD / 10 };
    static double x[SAMPLES];
    (void)state;
    for (int k = 0; k < 4; k++) {
        const int is_once = k % 2, grows = k / 2;
        ss_cycles found;
        for (size_t i = 0; i < SAMPLES; i++) {
            double u = (double)i / PERIOD, at = 2 * M_PI * u;
            x[grows ? SAMPLES - 1 - i : i] = pow(is_once ? 11 : 9, -u / 10)
                * (sin(at) + 0.6 * sin(2 * at + 1) + 0.5 * cos(3 * at));
        }
        assert_int_equal(ss_cycles_find(x, SAMPLES, 0, &found), SS_OK);
        assert_int_equal(found.n, 5);
        assert_int_equal(found.why != NULL, is_once);
    }
}

/* A thousand times as much in another unit: the period and its error, which the drift of the waveform makes, are
 * those in samples. */
static void
units_do_not_matter(void **state)
{
    static double x[N];
    ss_cycles found[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < N; i++) {
            double u = (double)i / N, cycle = 20.3 * (u + 0.015 * (u * u - u));
            x[i] = (k == 0 ? 1 : 1000) * (cycle - floor(cycle) + 0.3 * sin(4 * M_PI * cycle + 2 * u));
        }
        assert_int_equal(ss_cycles_find(x, N, 0, &found[k]), SS_OK);
    }
    assert_true(fabs(found[1].period.value / found[0].period.value - 1) < 1e-9);
    assert_true(fabs(found[1].period.error / found[0].period.error - 1) < 1e-6);
}

/* Ramps, and falls of a thirtieth of them, a half-sample longer than a whole number, beside a hum that is in step with
 * two of them, but not with one. */
static double
fill_in_step_with_hum(gsl_rng *rng, double *x)
{
    double samples = 40.5 + (double)gsl_rng_uniform_int(rng, 160), start = gsl_rng_uniform(rng), phase = turn(rng);
    double ratio = 3.5 + (double)gsl_rng_uniform_int(rng, 12), hum = between(rng, 0.03, 0.1);
    for (size_t i = 0; i < N; i++) {
        double cycle = (double)i / samples, part = fmod(start + cycle, 1);
        x[i] = fmin(part, 30 * (1 - part)) + hum * sin(2 * M_PI * ratio * cycle + phase);
    }
    return RATE / samples;
}

/* Cycles that differ in turn: each second one is by 4 to 10 % larger. */
static double
fill_in_turn(gsl_rng *rng, double *x)
{
    double f = between(rng, 15, 150) / SECONDS, phase = gsl_rng_uniform(rng), more = between(rng, 0.04, 0.1);
    for (size_t i = 0; i < N; i++) {
        double cycle = f * (double)i / RATE + phase;
        x[i] = pow(fmax(0, sin(2 * M_PI * cycle)), 2) * (fmod(floor(cycle), 2) > 0 ? 1 + more : 1);
    }
    return f / 2;
}

/* The same by 3 to 6 %, while the waveform changes as much from the begin of the record to its end. */
static double
fill_in_turn_drifting(gsl_rng *rng, double *x)
{
    double f = between(rng, 15, 60) / SECONDS, phase = gsl_rng_uniform(rng), more = between(rng, 0.03, 0.06);
    for (size_t i = 0; i < N; i++) {
        double cycle = f * (double)i / RATE + phase, late = (double)i / N;
        double sine = sin(2 * M_PI * cycle) + 0.1 * late * sin(6 * M_PI * cycle);
        x[i] = pow(fmax(0, sine), 2) * (fmod(floor(cycle), 2) > 0 ? 1 + more : 1);
    }
    return f / 2;
}

/* Ramps, seen by a sensor that holds each third sample, so that cycles of no whole number of these differ. */
static double
fill_held(gsl_rng *rng, double *x)
{
    double samples = between(rng, 100, 400), start = gsl_rng_uniform(rng);
    for (size_t i = 0; i < N; i++)
        x[i] = fmod(start + (double)(i / 3 * 3) / samples, 1);
    return RATE / samples;
}

/* share: of the draws that must have a number; loudest: rms of the noise in one of three; most_close: of the numbers
 * known, how many may be within a tenth of their error (errors that are much too wide tell nothing, either). */
static void
errors_cover(double (*fill)(gsl_rng *rng, double *x), const char *name, double share, double loudest, double most_close)
{
    static double x[N];
    const double noise[] = { 0, 0.1 * loudest, loudest };
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double known = 0, within = 0, beyond = 0, close = 0;
    for (unsigned long i = 0; i < DRAWS; i++) {
        gsl_rng_set(rng, i + 1);
        double truth = fill(rng, x);
        add_noise(rng, x, noise[i % 3]);
        ss_features *f = features_of(x);
        ss_number v = f->number[SS_REPETITION_FREQUENCY];
        if (!isnan(v.value)) {
            known++;
            within += fabs(v.value - truth) <= 2 * v.error;
            beyond += fabs(v.value - truth) > 5 * v.error;
            close += fabs(v.value - truth) <= 0.1 * v.error;
            if (fabs(v.value - truth) > 5 * v.error)
                print_message("%s %lu: %g +- %g Hz, not %g\n", name, i, v.value, v.error, truth);
        }
        ss_features_free(f);
    }
    gsl_rng_free(rng);
    print_message("%s: %g of %d known, within 2 errors %.3g, beyond 5 %.3g, within a tenth %.3g\n", name, known,
                  DRAWS, within / known, beyond / known, close / known);
    assert_true(known >= share * DRAWS && within >= 0.88 * known && beyond <= fmax(1, 0.01 * known));
    assert_true(close <= most_close * known);
}

static void
errors_cover_drift(void **state)
{
    (void)state;
    errors_cover(fill_drifting, "drifting", 0.8, 0.03, 0.5);
}

static void
errors_cover_jitter(void **state)
{
    (void)state;
    errors_cover(fill_regular, "jitter", 0.8, 0.03, 0.5);
}

static void
errors_cover_hum(void **state)
{
    (void)state;
    errors_cover(fill_hummed, "hummed", 0.5, 0.03, 0.5);
}

static void
errors_cover_jumps_in_step(void **state)
{
    (void)state;
    errors_cover(fill_in_step, "jumps in step", 0.8, 0.03, 0.5);
}

static void
errors_cover_hum_in_step(void **state)
{
    (void)state;
    errors_cover(fill_in_step_with_hum, "hum in step", 0.8, 0.003, 1);
}

static void
errors_cover_cycles_in_turn(void **state)
{
    (void)state;
    errors_cover(fill_in_turn, "in turn", 0.8, 0.003, 1);
}

/* A saw whose seven teeth are all 100 samples apart, though its period is not quite: the first drop and the last lie
 * anywhere between two samples. */
static void
errors_cover_drops_between_samples(void **state)
{
    enum { SAMPLES = 700 };
    double x[SAMPLES], worst = 0;
    (void)state;
    for (double period = 99.86; period < 100.15; period += 0.04)
        for (double phase = 0; phase < 1; phase += 0.1) {
            ss_cycles found;
            for (size_t i = 0; i < SAMPLES; i++)
                x[i] = fmod((double)i / period + phase, 1);
            assert_int_equal(ss_cycles_find(x, SAMPLES, 0, &found), SS_OK);
            if (!isnan(found.frequency.value))
                worst = fmax(worst, fabs(found.frequency.value - 1 / period) / found.frequency.error);
        }
    print_message("off by up to %.1f errors\n", worst);
    assert_true(worst > 0 && worst < 3);
}

static void
errors_cover_drift_in_turn(void **state)
{
    (void)state;
    errors_cover(fill_in_turn_drifting, "drift in turn", 0.5, 0.003, 1);
}

static void
errors_cover_held_samples(void **state)
{
    (void)state;
    errors_cover(fill_held, "held", 0.8, 0, 0.5);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_repeats_that_does_not),
        cmocka_unit_test(what_decays_tenfold_rings_once),
        cmocka_unit_test(units_do_not_matter),
        cmocka_unit_test(errors_cover_drift),
        cmocka_unit_test(errors_cover_jitter),
        cmocka_unit_test(errors_cover_hum),
        cmocka_unit_test(errors_cover_jumps_in_step),
        cmocka_unit_test(errors_cover_hum_in_step),
        cmocka_unit_test(errors_cover_cycles_in_turn),
        cmocka_unit_test(errors_cover_drops_between_samples),
        cmocka_unit_test(errors_cover_drift_in_turn),
        cmocka_unit_test(errors_cover_held_samples),
    };
    return cmocka_run_group_tests_name("repetition", tests, NULL, NULL);
}
