/* bench_fit -- are the errors of ss_scene_fit honest?
 *
 *     bench_fit [EACH [SEED]]     compliant scenes drawn at each level (20), seed (1)
 *
 * Scenes are drawn wide: mass .01 to 1000 kg, contact 10 Hz to 5 kHz, its damping ratio .002 to .2, the
 * base 10 to 100 times slower, k for 1.2 to 4 times the base's frequency, f_k / (k Z_e) .5 to .97, settled
 * over 2 to 30 cycles, 10, 20 or 40 samples a period of the contact, 6 cycles; acceleration with white
 * noise at 40 and 20 dB.  The fit starts from K_y and c up to three times larger or smaller.  Of the fits
 * that are conclusive the table has the part within one and two standard errors and beyond five, of f_k,
 * Z_e, K_y and c together.  Fails, with 50 draws or more, if less than .55 or more than .80 are within
 * one, less than .88 within two, or more than .01 beyond five. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include "../foreign.h"
#include "bench.h"

enum { FITTED = 4 };

typedef struct tally {
    int n, conclusive, within_one, within_two, beyond_five;
    double seconds, longest;
} tally;

static ss_scene
draw(gsl_rng *rng, const ss_scene *shipped)
{
    ss_scene s = *shipped;
    double contact = foreign_scale(rng, 10, 5000), ratio = foreign_scale(rng, 10, 100);
    double damping = foreign_scale(rng, 0.002, 0.2), omega = 2 * M_PI * contact;
    s.mass = foreign_scale(rng, 0.01, 1000);
    s.base_frequency = contact / ratio;
    s.stiffness = s.mass * pow(2 * M_PI * s.base_frequency * foreign_scale(rng, 1.2, 4), 2);
    s.contact_stiffness = s.mass * omega * omega - s.stiffness;
    s.contact_damping = 2 * damping * s.mass * omega;
    s.base_amplitude = foreign_scale(rng, 1e-5, 1e-2);
    s.friction = s.stiffness * s.base_amplitude * foreign_between(rng, 0.5, 0.97);
    s.phase = foreign_between(rng, -M_PI, M_PI);
    s.rate = contact * 10 * pow(2, floor(foreign_between(rng, 0, 3)));
    s.settle = foreign_scale(rng, 2, 30) / s.base_frequency;
    s.duration = 6 / s.base_frequency;
    return s;
}

static void
count(tally *t, const ss_fit *fit, const ss_scene *truth)
{
    const double known[FITTED] = { truth->friction, truth->base_amplitude,
                                   truth->contact_stiffness, truth->contact_damping };
    const ss_value found[FITTED] = { fit->friction, fit->base_amplitude, fit->contact_stiffness,
                                     fit->contact_damping };
    t->conclusive += fit->conclusive;
    for (int i = 0; fit->conclusive && i < FITTED; i++) {
        double off = fabs(found[i].value - known[i]) / found[i].error;
        t->within_one += off <= 1;
        t->within_two += off <= 2;
        t->beyond_five += !(off <= 5);
    }
}

static void
one_fit(tally *t, gsl_rng *rng, const ss_scene *shipped, double snr)
{
    ss_scene truth = draw(rng, shipped), start = truth;
    ss_signal *g = bench_noisy_column(&truth, SS_ACCELERATION, snr, gsl_rng_get(rng));
    ss_fit fit;
    ss_error err;
    double began = bench_seconds();
    start.contact_stiffness *= foreign_scale(rng, 1 / 3., 3);
    start.contact_damping *= foreign_scale(rng, 1 / 3., 3);
    start.phase = 0;
    if (ss_scene_fit(&fit, g, 0, &start, NULL, &err) == SS_OK) {
        count(t, &fit, &truth);
        if (!fit.conclusive)
            printf("# %s\n", fit.why);
    } else {
        printf("# %s\n", err.text);
    }
    double seconds = bench_seconds() - began;
    t->n++;
    t->seconds += seconds;
    t->longest = fmax(t->longest, seconds);
    ss_signal_free(g);
}

int
main(int argc, char *argv[])
{
    static const double level[] = { 40, 20 };
    int each = argc > 1 ? atoi(argv[1]) : 20, failed = 0;
    unsigned long seed = argc > 2 ? strtoul(argv[2], NULL, 10) : 1;
    ss_scene light;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_set_error_handler_off();
    if (rng == NULL)
        return 1;
    bench_read(&light, &ss_shipped_scenes[1]);
    printf("# dB\tdraws\tconclusive\twithin 1\twithin 2\tbeyond 5\ts each\tlongest\n");
    for (int l = 0; l < 2; l++) {
        tally t = { .n = 0 };
        gsl_rng_set(rng, seed + (unsigned long)l);
        for (int i = 0; i < each; i++)
            one_fit(&t, rng, &light, level[l]);
        double values = fmax(FITTED * t.conclusive, 1);
        printf("%g\t%d\t%d\t%.3f\t%.3f\t%.3f\t%.2f\t%.2f\n", level[l], t.n, t.conclusive,
               t.within_one / values, t.within_two / values, t.beyond_five / values, t.seconds / t.n,
               t.longest);
        fflush(stdout);
        failed |= each >= 50 && (t.within_one < 0.55 * values || t.within_one > 0.80 * values
                                 || t.within_two < 0.88 * values || t.beyond_five > 0.01 * values);
    }
    gsl_rng_free(rng);
    return failed;
}
