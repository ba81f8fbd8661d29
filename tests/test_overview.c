/* test_overview.c -- a recording in one pass: nothing that a picture shows is lost by thinning. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "map/map.h"

#include "signal/noise.h"
#include "unit.h"
#include "signal/header.h"

/* Noise, with a drop to half in the middle, far from 0, so that the ends are high. */
static ss_signal *
record(double duration)
{
    ss_signal *signal;
    ss_wave_opts opts = ss_wave_defaults;
    opts.duration = duration;
    opts.rate = 1000;
    assert_int_equal(ss_wave_new(&signal, SS_NOISE, &opts, NULL), SS_OK);
    for (size_t i = 0; i < signal->n; i++)
        signal->values[i] += i < signal->n / 2 ? 60 : 30;
    return signal;
}

static ss_morlet_opts
grid(void)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.fmin = 2;
    opts.voices = 8;
    return opts;
}

static ss_overview *
look_at(const ss_signal *signal, const ss_morlet_opts *opts)
{
    ss_overview *o;
    ss_reader *reader;
    ss_error err = { 0 };
    assert_int_equal(ss_reader_of_signal(&reader, signal, NULL), SS_OK);
    if (ss_overview_read(&o, reader, 0, opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    ss_reader_free(reader);
    return o;
}

/* Each block has the largest of its translations, as the transform of the whole record has them within twice
 * its accuracy, and there is no other translation. */
static void
blocks_have_the_largest_of_their_translations(void **state)
{
    const ss_morlet_opts opts = grid();
    (void)state;
    for (double duration = 6; duration < 100; duration *= 12) {
        ss_signal *signal = record(duration);
        ss_overview *o = look_at(signal, &opts);
        const ss_coefficients *few = o->coefficients;
        ss_coefficients *all;
        assert_int_equal(ss_morlet_transform(&all, signal, 0, &opts, NULL), SS_OK);
        assert_int_equal(few->n_scales, all->n_scales);
        assert_int_equal(few->n, all->n);
        for (size_t i = 0; i < all->n_scales; i++) {
            const ss_scale *s = &all->scale[i], *block = &few->scale[i];
            size_t length = (size_t)(block->b_num / s->b_num + 0.5);
            double most = 0;
            assert_true(block->n <= 4096 && block->n == (s->n + length - 1) / length && block->f == s->f);
            assert_true(length == 1 || block->n > 2048);
            for (size_t k = 0; k < s->n; k++)
                most = fmax(most, hypot(all->w[2 * (s->offset + k)], all->w[2 * (s->offset + k) + 1]));
            for (size_t k = 0; k < block->n; k++) {
                double largest = 0, found = few->w[2 * (block->offset + k)];
                for (size_t l = k * length; l < (k + 1) * length && l < s->n; l++)
                    largest = fmax(largest, hypot(all->w[2 * (s->offset + l)], all->w[2 * (s->offset + l) + 1]));
                if (!(fabs(found - largest) <= 2e-6 * most) || few->w[2 * (block->offset + k) + 1] != 0)
                    fail_msg("%g Hz, block %zu of %zu: %g is not %g", s->f, k, length, found, largest);
            }
        }
        assert_true(fabs(o->top / ss_coefficients_max(all) - 1) <= 2e-6);
        ss_coefficients_free(all);
        ss_overview_free(o);
        ss_signal_free(signal);
    }
}

/* The drop of one sample, the two extremes, and the times, within a block. */
static void
the_signal_keeps_its_extremes_and_times(void **state)
{
    const ss_morlet_opts opts = grid();
    ss_signal *signal = record(100);
    (void)state;
    signal->values[70001] = -500;
    signal->values[70002] = 900;
    ss_overview *o = look_at(signal, &opts);
    const ss_signal *few = o->signal;
    assert_true(few->n <= 8192 && few->n > 4096);
    double step = 1 / few->head->rate, most = -DBL_MAX, least = DBL_MAX, t_most = 0, t_least = 0;
    for (size_t i = 0; i < few->n; i++) {
        double x = few->values[i];
        t_most = x > most ? (double)i * step : t_most, most = fmax(most, x);
        t_least = x < least ? (double)i * step : t_least, least = fmin(least, x);
    }
    assert_true(most == 900 && least == -500 && t_least < t_most);
    assert_true(fabs(t_most - 70.002) <= 100.0 / 2000 && fabs(t_least - 70.001) <= 100.0 / 2000);
    ss_overview_free(o);
    signal->n = 3000;
    o = look_at(signal, &opts);
    few = o->signal;
    assert_int_equal(few->n, 3000);
    assert_memory_equal(few->values, signal->values, 3000 * sizeof *few->values);
    ss_overview_free(o);
    ss_signal_free(signal);
}

/* A signal with many columns is read in smaller pieces: the same numbers; and noise as the whole map has it. */
static void
pieces_do_not_matter_and_noise_is_measured(void **state)
{
    enum { MANY = 100 };
    const ss_morlet_opts opts = grid();
    ss_signal *signal = record(60), *wide;
    size_t first[MANY] = { 0 };
    assert_int_equal(ss_signal_select(&wide, signal, first, MANY, 0, signal->n, NULL), SS_OK);
    ss_overview *o = look_at(wide, &opts), *whole = look_at(signal, &opts);
    ss_signal_free(wide);
    const ss_coefficients *a = o->coefficients, *b = whole->coefficients;
    const ss_scale *last = &a->scale[a->n_scales - 1];
    double independent = 0, truth;              /* |W|, 2 sqrt(pi) a and half an octave apart */
    (void)state;
    assert_memory_equal(a->w, b->w, 2 * (last->offset + last->n) * sizeof *a->w);
    assert_true(o->noise == whole->noise);
    for (size_t i = 0; i < a->n_scales; i++)
        independent += 60 / (2 * sqrt(M_PI) * a->scale[i].a) / 8 * 2;
    truth = sqrt(log(independent) / 1000);      /* the largest of white noise of 1 */
    if (!(fabs(20 * log10(o->noise / truth)) <= 1))
        fail_msg("noise at %g, not %g", o->noise, truth);
    ss_overview_free(whole);
    ss_overview_free(o);
    ss_signal_free(signal);
}

/* A bowed string: harmonics of 49 Hz, which rise and fall by their own, and noise of this rms. */
static ss_signal *
tone(int seed, int harmonics, double noise)
{
    ss_signal *signal;
    ss_wave_opts opts = ss_wave_defaults;
    opts.duration = 6;
    opts.rate = 8000;
    assert_int_equal(ss_wave_new(&signal, SS_NOISE, &opts, NULL), SS_OK);
    for (size_t i = 0; i < signal->n; i++) {
        double t = (double)i / 8000, begins = fmin(t / 0.3, 1) * fmin((6 - t) / 0.5, 1);
        signal->values[i] *= noise;
        for (int k = 1; k <= harmonics; k++) {
            double phase = fmod(seed * k * k * 0.377, 2 * M_PI), beat = fmod(seed * k * 1.234, 3);
            double size = fmod(seed * k * 0.618, 1) / sqrt(k) * exp(-t * fmod(k * 0.271, 1.5));
            signal->values[i] += begins * size * (1 + 0.3 * sin(beat * t)) * sin(2 * M_PI * 49 * k * t + phase);
        }
    }
    return signal;
}

/* The harmonics of a tone have the distribution of noise over whole octaves, but they repeat: only what is
 * added to them is noise, as in scenes to which noise is added. */
static void
harmonics_are_no_noise(void **state)
{
    ss_morlet_opts opts = grid();
    (void)state;
    opts.fmin = 30;
    for (int seed = 1; seed <= 4; seed++)
        for (int noisy = 0; noisy < 2; noisy++) {
            ss_signal *signal = tone(seed, noisy ? 12 : 60, noisy ? 0.02 : 0);
            ss_overview *o = look_at(signal, &opts);
            double level = o->noise, truth = 0.02 * sqrt(log(6e4) / 8000);
            if (noisy ? !(fabs(20 * log10(level / truth)) <= 3) : level != 0)
                fail_msg("tone %d: noise at %g, not %g", seed, level, noisy ? truth : 0);
            ss_overview_free(o);
            ss_signal_free(signal);
        }
}

/* Signals whose |W|^2 overflows or underflows have the same picture, and the time near gaps, as that
 * of the ends, does not count for the largest. */
static void
sizes_do_not_matter_and_gaps_are_left_out(void **state)
{
    const ss_morlet_opts opts = grid();
    ss_signal *signal = record(60);
    (void)state;
    for (size_t i = 20000; i < 20100; i++)
        signal->values[i] += 4000;
    assert_int_equal(ss_header_note(signal->head, "gaps", "5.001:5.002 20:20.1 50:51", NULL), SS_OK);
    ss_overview *one = look_at(signal, &opts);
    const ss_coefficients *a = one->coefficients;
    ss_coefficients *all;
    assert_int_equal(ss_morlet_transform(&all, signal, 0, &opts, NULL), SS_OK);
    assert_true(fabs(one->top / ss_coefficients_max(all) - 1) <= 2e-6);
    for (int power = -600; power <= 600; power += 1200) {
        ss_signal *scaled = record(60);
        for (size_t i = 0; i < signal->n; i++)
            scaled->values[i] = ldexp(signal->values[i], power);
        assert_int_equal(ss_header_note(scaled->head, "gaps", "5.001:5.002 20:20.1 50:51", NULL), SS_OK);
        ss_overview *o = look_at(scaled, &opts);
        const ss_coefficients *b = o->coefficients;
        assert_int_equal(a->n_scales, b->n_scales);
        assert_true(fabs(ldexp(o->top, -power) / one->top - 1) <= 2e-6);
        for (size_t i = 0; i < a->n_scales; i++)
            for (size_t k = a->scale[i].offset; k < a->scale[i].offset + a->scale[i].n; k++)
                assert_true(fabs(ldexp(b->w[2 * k], -power) - a->w[2 * k]) <= 2e-6 * 4000);
        ss_overview_free(o);
        ss_signal_free(scaled);
    }
    ss_coefficients_free(all);
    ss_overview_free(one);
    ss_signal_free(signal);
}

static void
what_is_too_short_or_wrong_is_refused(void **state)
{
    const ss_morlet_opts opts = grid();
    ss_signal *signal = record(1);
    ss_morlet_opts none = ss_morlet_defaults;
    ss_overview *o = NULL;
    ss_reader *reader;
    ss_error err = { 0 };
    (void)state;
    assert_int_equal(ss_reader_of_signal(&reader, signal, NULL), SS_OK);
    assert_int_equal(ss_overview_read(&o, reader, 1, &opts, &err), SS_EINVAL);
    assert_int_equal(ss_overview_read(&o, reader, 0, &none, &err), SS_EINVAL);
    signal->values[1] = NAN;
    assert_int_equal(ss_overview_read(&o, reader, 0, &opts, &err), SS_EINVAL);
    ss_reader_free(reader);
    signal->n = 1;
    assert_int_equal(ss_reader_of_signal(&reader, signal, NULL), SS_OK);
    assert_int_equal(ss_overview_read(&o, reader, 0, &opts, &err), SS_EDATA);
    assert_non_null(strstr(err.text, "signal: too few samples, 1: "));
    assert_null(o);
    ss_reader_free(reader);
    ss_signal_free(signal);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_have_the_largest_of_their_translations),
        cmocka_unit_test(the_signal_keeps_its_extremes_and_times),
        cmocka_unit_test(pieces_do_not_matter_and_noise_is_measured),
        cmocka_unit_test(harmonics_are_no_noise),
        cmocka_unit_test(sizes_do_not_matter_and_gaps_are_left_out),
        cmocka_unit_test(what_is_too_short_or_wrong_is_refused),
    };
    return cmocka_run_group_tests_name("overview", tests, NULL, NULL);
}
