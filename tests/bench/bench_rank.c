/* bench_rank -- what ss_rank answers for signals of its own models and of others.
 *
 *     bench_rank [EACH [SEED [ONLY]]]   signals of each kind and level (8), seed (1); ONLY: own, wide or
 *                                       foreign
 *
 * Own: of the shipped scenes with every parameter drawn within 30 % and f_k / (k Z_e) from .90 to .97.
 * Wide: the same with each parameter up to three times larger or smaller and f_k / (k Z_e) from .3 to
 * .97: most of these are none of the shipped scenes.  Foreign: of tests/foreign.h.  All are 3 s of
 * acceleration at 2 kHz with white noise at 40 and 20 dB.
 *
 * Fails if a scene is named that leaves more than twice the noise that was added, if an own signal is
 * given another scene's name, or if of these less than 15 in 16 at 40 dB or 12 in 16 at 20 dB are
 * named. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include "../foreign.h"
#include "bench.h"
#include "../noise_rms.h"
#include "signal/noise.h"

enum { MODELS = 4 };

typedef struct tally {
    int named[MODELS], undecided, none, n;
    int beyond;                     /* named, though more than twice the noise is left */
    double seconds;
} tally;

static double
vary(gsl_rng *rng, double x, int wide)
{
    return x * (wide ? foreign_scale(rng, 1 / 3., 3) : foreign_between(rng, 0.7, 1.3));
}

static ss_scene
draw(gsl_rng *rng, const ss_scene *shipped, int wide)
{
    ss_scene s = *shipped;
    double ratio = foreign_between(rng, wide ? 0.3 : 0.90, 0.97);
    s.mass = vary(rng, s.mass, wide);
    s.stiffness = vary(rng, s.stiffness, wide);
    s.base_amplitude = vary(rng, s.base_amplitude, wide);
    s.base_frequency = vary(rng, s.base_frequency, wide);
    s.friction = ratio * s.stiffness * s.base_amplitude;
    ss_scene_set(&s, "contact_stiffness", vary(rng, ss_scene_get(&s, "contact_stiffness"), wide), NULL);
    ss_scene_set(&s, "contact_damping", vary(rng, ss_scene_get(&s, "contact_damping"), wide), NULL);
    ss_scene_set(&s, "alpha", vary(rng, ss_scene_get(&s, "alpha"), wide), NULL);
    ss_scene_set(&s, "gamma", vary(rng, ss_scene_get(&s, "gamma"), wide), NULL);
    return s;
}

static void
answer(tally *t, ss_signal *g, const ss_scene shipped[MODELS], double snr, unsigned long seed)
{
    ss_ranking *r = NULL;
    ss_error err;
    double clean = pow(noise_rms(g->values, g->n, 0), 2), noise = clean * pow(10, -snr / 10);
    ss_noise_add_once(g->values, g->n, sqrt(noise), seed, NULL);
    double began = bench_seconds();
    if (ss_ranking_new(&r, g, 0, shipped, MODELS, NULL, &err) != SS_OK) {
        printf("# %s\n", err.text);
        exit(1);
    }
    t->seconds += bench_seconds() - began;
    t->n++;
    if (r->verdict == SS_NAMED) {
        double left = pow(10, r->row[0].value[SS_BY_RESIDUAL] / 10) * (clean + noise);
        t->named[r->row[0].scene]++;
        t->beyond += left > 2 * noise;
    } else if (r->verdict == SS_NONE_FITS) {
        t->none++;
    } else {
        t->undecided++;
    }
    ss_ranking_free(r);
}

static void
print(const tally *t, const char *kind, const char *what, double snr)
{
    printf("%g\t%s\t%s", snr, kind, what);
    for (int i = 0; i < MODELS; i++)
        printf("\t%d", t->named[i]);
    printf("\t%d\t%d\t%d\t%.2f\n", t->undecided, t->none, t->beyond, t->seconds / t->n);
    fflush(stdout);
}

/* 1 if an own signal has another's name, or too few have their own. */
static int
is_wrong(const tally *t, int own, double snr)
{
    int others = 0;
    for (int i = 0; i < MODELS; i++)
        others += i != own ? t->named[i] : 0;
    return others > 0 || 16 * t->named[own] < (snr > 30 ? 15 : 12) * t->n;
}

int
main(int argc, char *argv[])
{
    static const double level[] = { 40, 20 };
    static const char *const group[] = { "own", "wide", "foreign" };
    int each = argc > 1 ? atoi(argv[1]) : 8, failed = 0;
    unsigned long seed = argc > 2 ? strtoul(argv[2], NULL, 10) : 1;
    ss_scene shipped[MODELS];
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_set_error_handler_off();
    if (rng == NULL)
        return 1;
    for (int m = 0; m < MODELS; m++) {
        bench_read(&shipped[m], &ss_shipped_scenes[m]);
        shipped[m].settle = 2;
    }
    printf("# dB\tkind\tsignal\tnamed %s, %s, %s, %s\tcannot tell\tnone of these\tof the named beyond twice "
           "the noise\ts each\n", ss_shipped_scenes[0].name, ss_shipped_scenes[1].name,
           ss_shipped_scenes[2].name, ss_shipped_scenes[3].name);
    for (int l = 0; l < 2; l++)
        for (int k = 0; k < 2 * MODELS + FOREIGN_KINDS; k++) {
            int kind = k / MODELS < 2 ? k / MODELS : 2, which = kind < 2 ? k % MODELS : k - 2 * MODELS;
            tally t = { .n = 0 };
            if (argc > 3 && strcmp(argv[3], group[kind]) != 0)
                continue;
            gsl_rng_set(rng, seed + 1000 * (unsigned long)k + 100000 * (unsigned long)l);
            for (int i = 0; i < each; i++) {
                ss_scene s = shipped[which % MODELS];
                if (kind < 2)
                    s = draw(rng, &s, kind == 1);
                ss_signal *g = bench_column(&s, SS_ACCELERATION);
                if (kind == 2)
                    foreign_signal(which, g->values, g->n, g->head->rate, rng);
                answer(&t, g, shipped, level[l], gsl_rng_get(rng));
                ss_signal_free(g);
            }
            print(&t, group[kind], kind < 2 ? ss_shipped_scenes[which].name : foreign_names[which],
                  level[l]);
            failed |= t.beyond > 0 || (kind == 0 && is_wrong(&t, which, level[l]));
        }
    gsl_rng_free(rng);
    return failed;
}
