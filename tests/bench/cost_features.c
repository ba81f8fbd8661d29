/* cost_features.c -- ss_features_find against the transform that it makes, a million samples each.
 *
 * CPU seconds, the least of ROUNDS in which both take turns. */
#include <gsl/gsl_errno.h>
#include "bench.h"

enum { ROUNDS = 2 };

/* The options that ss_features_find transforms with. */
static double
transform_seconds(const ss_signal *signal)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_coefficients *coef = NULL;
    double lowest = opts.center * sqrt(2) * signal->head->rate / (M_PI * (double)signal->n);
    double start = bench_seconds();
    opts.fmin = lowest * (1 + 1e-9);
    if (ss_morlet_transform(&coef, signal, 0, &opts, NULL) != SS_OK)
        exit(1);
    double seconds = bench_seconds() - start;
    ss_coefficients_free(coef);
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
acceleration(const char *name, double snr)
{
    ss_scene scene = read_shipped_named(name);
    ss_signal *all = NULL, *a = NULL;
    scene.duration = 500;
    if (ss_sim_signal(&all, &scene, NULL) != SS_OK)
        exit(1);
    size_t column = (size_t)ss_header_column(all->head, "a");
    if (ss_signal_select(&a, all, &column, 1, 0, all->n, NULL) != SS_OK)
        exit(1);
    ss_signal_free(all);
    if (isfinite(snr))
        ss_noise_add_once(a->values, a->n, ss_noise_rms(a->values, a->n, snr), 1);
    return a;
}

int
main(void)
{
    static const char *const scene[] = { "coulomb", "compliant-heavy", "compliant-light",
                                         "state-variable" };
    static const double snr[] = { INFINITY, 40 };
    gsl_set_error_handler_off();
    printf("# scene snr/dB transform/s features/s ratio\n");
    for (int i = 0; i < 8; i++) {
        ss_signal *signal = acceleration(scene[i / 2], snr[i % 2]);
        double transform = INFINITY, features = INFINITY;
        for (int k = 0; k < ROUNDS; k++) {
            transform = fmin(transform, transform_seconds(signal));
            features = fmin(features, features_seconds(signal));
        }
        printf("%s\t%g\t%.2f\t%.2f\t%.2f\n", scene[i / 2], snr[i % 2], transform, features,
               features / transform);
        fflush(stdout);
        ss_signal_free(signal);
    }
    return 0;
}
