/* cost_features.c -- ss_features_find against the transform of its map, each coefficient read and none
 * kept: a million samples of noise and of scenes, and a minute of a saw-tooth at 98 Hz, as a bowed string
 * sounds, at 48 kHz.
 *
 * CPU seconds, the least of ROUNDS in which both take turns. */
#include <gsl/gsl_errno.h>
#include "map/map.h"
#include "bench.h"
#include "signal/header.h"
#include "../noise_rms.h"
#include "signal/noise.h"

enum { ROUNDS = 2, SAMPLES = 1000000, SECONDS = 60 };
#define PITCH 98.0
#define SOUND_RATE 48000.0

static int
read_largest(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    double *largest = user;
    (void)scale, (void)first, (void)samples;
    for (size_t k = 0; k < n; k++)
        *largest = fmax(*largest, w[2 * k] * w[2 * k] + w[2 * k + 1] * w[2 * k + 1]);
    return 0;
}

/* The options that ss_features_find transforms with. */
static double
transform_seconds(const ss_signal *signal)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan = NULL;
    double lowest = opts.center * sqrt(2) * signal->head->rate / (M_PI * (double)signal->n);
    double start = bench_seconds(), largest = 0;
    opts.fmin = lowest * (1 + 1e-9);
    if (ss_morlet_new(&plan, signal->n, signal->head->rate, &opts, NULL) != SS_OK
        || ss_morlet_each(plan, signal->values, read_largest, &largest, NULL) != SS_OK)
        exit(1);
    double seconds = bench_seconds() - start;
    ss_morlet_free(plan);
    return seconds;
}

static double
features_seconds(const ss_signal *signal)
{
    ss_features *found = NULL;
    double start = bench_seconds();
    if (ss_features_find(&found, signal, 0, NULL, NULL) != SS_OK)
        exit(1);
    double seconds = bench_seconds() - start;
    ss_features_free(found);
    return seconds;
}

static ss_signal *
wave(ss_wave kind, double rate, double duration)
{
    ss_wave_opts opts = ss_wave_defaults;
    ss_signal *signal = NULL;
    opts.rate = rate, opts.duration = duration;
    if (ss_wave_new(&signal, kind, &opts, NULL) != SS_OK)
        exit(1);
    return signal;
}

static ss_signal *
bowed_string(void)
{
    ss_signal *signal = wave(SS_SINE, SOUND_RATE, SECONDS);
    for (size_t i = 0; i < signal->n; i++)
        signal->values[i] = 2 * fmod((double)i * PITCH / SOUND_RATE, 1) - 1;
    ss_noise_add_once(signal->values, signal->n, noise_rms(signal->values, signal->n, 40), 1, NULL);
    return signal;
}

static ss_signal *
acceleration(const char *name, double snr)
{
    ss_scene scene = read_shipped_named(name);
    ss_signal *all = NULL, *a = NULL;
    scene.duration = SAMPLES / 2000.;
    if (ss_sim_signal(&all, &scene, NULL) != SS_OK)
        exit(1);
    size_t column = (size_t)ss_header_column(all->head, "a");
    if (ss_signal_select(&a, all, &column, 1, 0, all->n, NULL) != SS_OK)
        exit(1);
    ss_signal_free(all);
    if (isfinite(snr))
        ss_noise_add_once(a->values, a->n, noise_rms(a->values, a->n, snr), 1, NULL);
    return a;
}

static void
print_row(const char *name, double snr, ss_signal *signal)
{
    double transform = INFINITY, features = INFINITY;
    for (int k = 0; k < ROUNDS; k++) {
        transform = fmin(transform, transform_seconds(signal));
        features = fmin(features, features_seconds(signal));
    }
    printf("%s\t%g\t%.2f\t%.2f\t%.2f\n", name, snr, transform, features, features / transform);
    fflush(stdout);
    ss_signal_free(signal);
}

int
main(void)
{
    static const char *const scene[] = { "coulomb", "compliant-heavy", "compliant-light",
                                         "state-variable" };
    static const double snr[] = { INFINITY, 40 };
    gsl_set_error_handler_off();
    printf("# signal snr/dB transform/s features/s ratio\n");
    print_row("noise", -INFINITY, wave(SS_NOISE, 10000, SAMPLES / 10000.));
    for (int i = 0; i < 8; i++)
        print_row(scene[i / 2], snr[i % 2], acceleration(scene[i / 2], snr[i % 2]));
    print_row("bowed-string", 40, bowed_string());
    return 0;
}
