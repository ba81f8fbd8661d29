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

/* --- stiff and soft, light and heavy ------------------------------------------------------- */

typedef struct stick_times {         /* the longest microstick between two macroscopic slips [s] */
    double began, longest, sum;
    size_t n;
} stick_times;

/* A stick that comes more than a tenth of the base's period after the last event begins a transition. */
static int
watch(const ss_event *e, void *user)
{
    stick_times *s = user;
    if (e->kind == SS_STICK)
        s->began = e->t;
    else if (e->kind == SS_SLIP && !isnan(s->began)) {
        s->longest = fmax(s->longest, e->t - s->began);
        s->began = NAN;
    }
    return 0;
}

/* One scene with and without noise; a row if show asks for it.  Returns how many numbers are wrong
 * by more than 10 %, and counts what is given and what is refused. */
static void
probe(const ss_scene *scene, double given[2][2], int show)
{
    ss_signal *signal = NULL;
    stick_times sticks = { .began = NAN };
    ss_sim_opts opts = ss_sim_defaults;
    double total = scene->stiffness + scene->contact_stiffness;
    double ratio = scene->contact_damping / (2 * sqrt(total * scene->mass));
    opts.events = watch;
    opts.user = &sticks;
    if (ss_simulate(&signal, scene, NULL) != SS_OK || ss_sim_run(scene, &opts, NULL, NULL) != SS_OK)
        exit(1);
    double longest = sticks.longest * sqrt(total / scene->mass) / (2 * M_PI);
    for (int k = 0; k < 2; k++) {
        ss_features *f = features_of(signal, snr_of[k], 1, scene);
        ss_value K = f->total_stiffness, z = f->damping_ratio;
        given[k][0] = K.value / total - 1;
        given[k][1] = z.value / ratio - 1;
        if (show || (longest < 2 && !isnan(K.value)))
            printf("%g\t%g\t%g\t%g\t%g\t%.2f\t%.4f\t%.3f\n", scene->contact_stiffness, ratio,
                   scene->base_frequency, scene->friction, snr_of[k], longest, 100 * given[k][0],
                   100 * given[k][1]);
        for (size_t i = 0; i < f->n && longest < 2; i++)
            if (!isnan(f->transition[i].frequency.value)) { printf("row %g\n", f->transition[i].frequency.value); break; }
        ss_features_free(f);
    }
    ss_signal_free(signal);
}

static void
grid(void)
{
    static const double ratios[] = { 0.005, 0.02, 0.05, 0.1, 0.2 };
    double given[2][2];
    printf("# K_y zeta base/Hz f_k snr/dB longest_stick/periods K_error/%% zeta_error/%%\n");
    for (int i = 0; i < 7; i++)
        for (int j = 0; j < 5; j++) {
            ss_scene scene = shipped("compliant-light");
            scene.contact_stiffness = 2e4 * pow(10, i / 2.);
            double total = scene.stiffness + scene.contact_stiffness;
            scene.contact_damping = ratios[j] * 2 * sqrt(total * scene.mass);
            probe(&scene, given, 1);
        }
}

/* Sticks too short to be read: faster bases, softer contacts, less friction. */
static void
refusals(void)
{
    static const double base[] = { 3, 4, 5, 6, 8, 10, 12, 15 }, friction[] = { 0.4, 0.8, 1.2 };
    static const double soft[] = { 2e4, 6e4, 2e5 };
    double given[2][2];
    for (int b = 0; b < 8; b++) for (int f = 0; f < 3; f++) for (int s = 0; s < 3; s++) {
        ss_scene scene = shipped("compliant-light");
        scene.base_frequency = base[b];
        scene.friction = friction[f];
        scene.contact_stiffness = soft[s];
        probe(&scene, given, getenv("ALL") != NULL);
    }
}

int
main(int argc, char *argv[])
{
    static const char *const scenes[] = { "compliant-heavy", "compliant-light" };
    unsigned long seeds = argc > 1 ? strtoul(argv[1], NULL, 10) : 100;
    gsl_set_error_handler_off();
    if (seeds==1) {refusals(); return 0;}
    grid();
    if (seeds==0) return 0;
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
