/* bench_features.c -- error of the oscillation's stiffness and damping, against the scenes' own.
 *
 * Prints rms and worst errors over seeds of noise, the share of runs within one standard error, and
 * the grid of stiff and soft, light and heavy contacts.  Exits 1 if a bound is exceeded.
 * usage: bench_features [SEEDS] */
#include <gsl/gsl_errno.h>
#include "bench.h"

typedef struct tally {
    size_t n, refused, within[2];
    double sum[2], worst[2];            /* relative errors of stiffness and damping ratio */
} tally;

static const double snr_of[] = { INFINITY, 40, 20 };

static ss_scene
shipped(const char *name)
{
    ss_scene scene;
    const ss_shipped_scene *s = ss_shipped_scenes;
    while (strcmp(s->name, name) != 0)
        s++;
    FILE *in = fmemopen((void *)s->text, strlen(s->text), "r");
    if (in == NULL || ss_scene_read(&scene, in, s->name, NULL) != SS_OK)
        exit(1);
    fclose(in);
    scene.duration = 3.2;
    return scene;
}

static ss_features *
features_of(const ss_signal *clean, double snr, unsigned long seed, const ss_scene *scene)
{
    size_t column = (size_t)ss_header_column(clean->head, "a");
    ss_signal *signal = NULL;
    ss_features *out = NULL;
    ss_features_opts opts = ss_features_defaults;
    opts.mass = scene->mass;
    opts.stiffness = scene->stiffness;
    if (ss_signal_select(&signal, clean, &column, 1, 0, clean->n) != SS_OK)
        exit(1);
    if (isfinite(snr))
        ss_add_noise(signal->values, signal->n, ss_noise_rms(signal->values, signal->n, snr), seed);
    if (ss_features_find(&out, signal, 0, &opts, NULL) != SS_OK)
        exit(1);
    ss_signal_free(signal);
    return out;
}

static void
count(tally *t, const ss_features *f, const ss_scene *scene)
{
    double total = scene->stiffness + scene->contact_stiffness;
    double ratio = scene->contact_damping / (2 * sqrt(total * scene->mass));
    ss_value got[2] = { f->total_stiffness, f->damping_ratio };
    double truth[2] = { total, ratio };
    t->n++;
    t->refused += isnan(got[0].value);
    for (int i = 0; i < 2 && !isnan(got[0].value); i++) {
        double e = fabs(got[i].value / truth[i] - 1);
        t->sum[i] += e * e;
        t->worst[i] = fmax(t->worst[i], e);
        t->within[i] += fabs(got[i].value - truth[i]) <= got[i].error;
    }
}

static void
print(const char *name, double snr, const tally *t)
{
    double n = (double)(t->n - t->refused);
    printf("%s\t%g\t%.4f\t%.4f\t%.3f\t%.3f\t%.0f\t%.0f\t%zu\n", name, snr, 100 * sqrt(t->sum[0] / n),
           100 * t->worst[0], 100 * sqrt(t->sum[1] / n), 100 * t->worst[1],
           100 * (double)t->within[0] / n, 100 * (double)t->within[1] / n, t->refused);
    fflush(stdout);
}

int
main(int argc, char *argv[])
{
    static const char *const scenes[] = { "compliant-heavy", "compliant-light" };
    unsigned long seeds = argc > 1 ? strtoul(argv[1], NULL, 10) : 100;
    gsl_set_error_handler_off();
    printf("# scene release snr/dB K_rms/%% K_max/%% zeta_rms/%% zeta_max/%% K_within/%% zeta_within/%% refused\n");
    for (int i = 0; i < 2; i++)
        for (int release = 0; release < 2; release++) {
            ss_scene scene = shipped(scenes[i]);
            ss_signal *signal = NULL;
            char name[64];
            scene.release = (ss_release)release;
            snprintf(name, sizeof name, "%s\t%s", scenes[i], release ? "total" : "spring");
            if (ss_simulate(&signal, &scene, NULL) != SS_OK)
                exit(1);
            for (int k = 0; k < 3; k++) {
                tally t = { 0 };
                for (unsigned long seed = 1; seed <= (k > 0 ? seeds : 1); seed++) {
                    ss_features *f = features_of(signal, snr_of[k], seed, &scene);
                    count(&t, f, &scene);
                    ss_features_free(f);
                }
                print(name, snr_of[k], &t);
            }
            ss_signal_free(signal);
        }
    return 0;
}
