/* bench_rank -- which model ss_rank puts first for signals of known models: confusion matrices.
 *
 * Scenes are the shipped ones with every parameter drawn within +-30 %; f_k / (k Z_e) from .90 to
 * .97, as elsewhere most do not move or stick for less than two periods; or, with "free", as it
 * falls. */
#include <gsl/gsl_rng.h>
#include "bench.h"

enum { MODELS = 4 };

static double
vary(gsl_rng *rng, double x)
{
    return x * (0.7 + 0.6 * gsl_rng_uniform(rng));
}

static ss_scene
draw(gsl_rng *rng, const ss_scene *shipped, int free_ratio)
{
    ss_scene s = *shipped;
    double ratio = 0.90 + 0.07 * gsl_rng_uniform(rng);
    s.mass = vary(rng, s.mass);
    s.stiffness = vary(rng, s.stiffness);
    s.base_amplitude = vary(rng, s.base_amplitude);
    s.base_frequency = vary(rng, s.base_frequency);
    s.friction = free_ratio ? vary(rng, s.friction) : ratio * s.stiffness * s.base_amplitude;
    s.contact_stiffness = vary(rng, s.contact_stiffness);
    s.contact_damping = vary(rng, s.contact_damping);
    s.alpha = vary(rng, s.alpha);
    s.gamma = vary(rng, s.gamma);
    return s;
}

typedef struct score {
    int first[MODELS][MODELS + 1];      /* the last: cannot tell */
    int order[MODELS][MODELS];
    int alone[SS_CRITERIA];
    double lead;
} score;

int
main(int argc, char *argv[])
{
    int n = argc > 1 ? atoi(argv[1]) : 25, free_ratio = argc > 4;
    double snr = argc > 2 ? atof(argv[2]) : 40;
    unsigned long seed = argc > 3 ? strtoul(argv[3], NULL, 10) : 1;
    ss_scene shipped[MODELS];
    score sc = { 0 };
    double seconds = 0;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, seed);
    for (int i = 0; i < MODELS; i++) {
        bench_read(&shipped[i], &ss_shipped_scenes[i]);
        shipped[i].settle = 2;
    }
    for (int k = 0; k < n; k++)
        for (int m = 0; m < MODELS; m++) {
            ss_scene s = draw(rng, &shipped[m], free_ratio);
            ss_signal *g = NULL;
            ss_ranking *r = NULL;
            ss_error err;
            if (ss_simulate(&g, &s, &err) != SS_OK) {
                printf("# %s\n", err.text);
                continue;
            }
            double *a = g->values + 2 * g->n;
            ss_add_noise(a, g->n, ss_noise_rms(a, g->n, snr), seed * 100000 + 4 * k + m);
            double began = bench_seconds();
            if (ss_rank(&r, g, 2, shipped, MODELS, NULL, &err) != SS_OK) {
                printf("# rank: %s\n", err.text);
                continue;
            }
            seconds += bench_seconds() - began;
            int first = (int)r->row[0].scene;
            sc.order[m][first]++;
            sc.first[m][r->told ? first : MODELS]++;
            if (isnan(r->forcing_frequency)) {
                printf("%d %s: %s\n", k, ss_shipped_scenes[m].name, r->why);
            } else {
              for (int c = 0; c < SS_CRITERIA; c++) {
                double least = INFINITY, own = 0; 
                for (int i = 0; i < MODELS; i++) {
                    double v = ss_rank_score(&r->row[i], c, 1);
                    if ((int)r->row[i].scene == m) own = v; else least = fmin(least, v);
                }
                sc.alone[c] += own < least;
              }
              if (first != m || !r->told || getenv("ALL")) {
                printf("%d %s: %s | beta %.3f zeta %.4f T %.4f\n", k, ss_shipped_scenes[m].name, r->why, s.friction/s.stiffness/s.base_amplitude, s.contact_damping/2/sqrt((s.stiffness+s.contact_stiffness)*s.mass), r->forcing_frequency/s.base_frequency);
                for (int i = -1; i < MODELS; i++) {
                    printf("   %-16s", i < 0 ? "signal" : ss_shipped_scenes[r->row[i].scene].name);
                    for (int c = 0; c < SS_CRITERIA; c++) {
                        if (i < 0) printf(" %8.3g     ", r->value[c]);
                        else printf(" %8.3g/%4.2f", r->row[i].value[c], ss_rank_score(&r->row[i], c, 1));}
                    if (i >= 0) printf("  = %.2f", r->row[i].total);
                    printf("\n");
                }
              }
            }
            fflush(stdout);
            ss_ranking_free(r);
            ss_signal_free(g);
        }
    printf("# %g dB, seed %lu, %d each%s, %.3g s a ranking\n", snr, seed, n, free_ratio ? ", free" : "", seconds / n / MODELS);
    for (int m = 0; m < MODELS; m++) {
        printf("%-16s", ss_shipped_scenes[m].name);
        for (int i = 0; i <= MODELS; i++)
            printf("\t%d", sc.first[m][i]);
        printf("\t| %d\n", sc.order[m][m]);
    }
    for (int c = 0; c < SS_CRITERIA; c++)
        printf("# %s alone: %.0f %%\n", ss_criterion_rules[c].name, 100.0 * sc.alone[c] / n / MODELS);
    gsl_rng_free(rng);
    return 0;
}
