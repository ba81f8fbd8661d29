/* cover_steps.c -- are a, b, Dc, stiffness and drift of velocity steps within their errors of the truth?
 *
 * Random steps of rate and state, made by tests/pulled_rock.h, which has no code of the library: a .003 ... .015,
 * b/a .5 ... 1.4, Dc 2 ... 30 um, k 300 ... 5000 /m, drift -10 ... 10 /m, steps of 3 to 30 up or down over 30 to
 * 60 Dc or more, noise of .3 to 5 % of the direct effect with memory, 600 to 3000 rows, even or not, a ramp over
 * up to 2 % of the path, a path with noise of .3 to 3 % of Dc, holds, and records of two steps in 300 to 900 rows,
 * as a file of nine digits has them, with a white noise of .1 to 1 %: there speeds change between rows that may be
 * a Dc apart.  A row a kind and law: steps, law named rightly, not told, wrongly, none of these, percentage of the
 * numbers within 1 and 2 errors, of each and of all, how many are beyond 5, and CPU a step and law.
 * usage: cover_steps [RECORDS [SEED [shared]]]; shared: steps of a record have one a, b, Dc and stiffness */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <stickslip.h>
#include "../pulled_rock.h"

enum { NUMBERS = 5 };
static const char *const kinds[] = { "even rows", "memory in time", "fast after", "ramp", "noisy path", "few rows",
                                    "hold" };
enum { KINDS = sizeof kinds / sizeof *kinds, HOLD = KINDS - 1, FEW = KINDS - 2 };

static double
between(uint64_t *seed, double from, double to)
{
    return from * pow(to / from, uniform(seed));
}

static rock
draw(uint64_t *seed, size_t kind, int is_slip)
{
    rock r = { .is_slip = is_slip, .a = between(seed, .003, .015), .Dc = between(seed, 2e-6, 30e-6),
               .k = between(seed, 300, 5000), .drift = 20 * uniform(seed) - 10 };
    r.b = r.a * (0.5 + 0.9 * uniform(seed));
    double ratio = between(seed, 3, 30), way = r.Dc * between(seed, 30, 60) + 3 * r.a / r.k;
    r.speed[0] = 1e-6 * (kind < HOLD && uniform(seed) < 0.4 ? ratio : 1);
    r.speed[1] = kind == HOLD ? 0 : r.speed[0] > 1e-6 ? 1e-6 : 1e-6 * ratio;
    r.until[0] = way / 2 / r.speed[0];
    r.until[1] = r.until[0] + (kind == HOLD ? between(seed, 10, 300) : way / r.speed[1]);
    if (kind >= FEW) {
        r.speed[2] = r.speed[0];
        r.until[2] = r.until[1] + way / r.speed[2];
    }
    r.ramp = kind == 3 ? 0.02 * way / fmax(r.speed[0], r.speed[1]) : 0;
    r.noise = r.a * log(ratio) * between(seed, .003, .05);
    r.path_noise = kind == 4 ? r.Dc * between(seed, .003, .03) : 0;
    r.n = (size_t)between(seed, 600, 3000);
    r.memory = 0.95 * uniform(seed);
    if (kind == FEW) {
        r.noise = r.a * log(ratio) * between(seed, .001, .01);
        r.n = (size_t)between(seed, 300, 900);
        r.memory = 0;
        r.digits = 9;
    }
    r.uneven = kind == 2 ? 2 : kind == 1;
    r.by_time = kind == 1;
    if (r.by_time)
        r.memory = between(seed, 0.3, 20) * r.until[1] / (double)r.n;
    return r;
}

int
main(int argc, char *argv[])
{
    const size_t records = argc > 1 ? (size_t)atol(argv[1]) : 10;
    uint64_t seed = argc > 2 ? (uint64_t)atol(argv[2]) : 1;
    size_t all_named[4] = { 0 }, all_within[2] = { 0 }, all_numbers = 0, all_far = 0;
    printf("# kind\tlaw\tsteps\tright\tcan't tell\twrong\tnone\ta\tb\tDc\tk\tdrift\tall 1\tall 2\tbeyond 5\tCPU/s\n");
    for (size_t kind = 0; kind < KINDS; kind++)
        for (int law = 0; law < SS_STEP_LAWS; law++) {
            size_t within[2][NUMBERS] = { { 0 } }, numbers = 0, named[4] = { 0 }, far = 0;
            clock_t cpu = 0;
            for (size_t i = 0; i < records; i++) {
                rock r = draw(&seed, kind, law);
                ss_signal *s = rock_signal(&r, &seed);
                ss_steps *steps = NULL;
                ss_error err = { 0 };
                if (s == NULL) {
                    i--;
                    continue;
                }
                clock_t from = clock();
                ss_status st = ss_steps_find(&steps, s, 0, 1,
                                             &(ss_steps_opts){ sizeof(ss_steps_opts), -1, 0, argc > 3 }, &err);
                cpu += clock() - from;
                ss_signal_free(s);
                const size_t expected = kind == FEW ? 2 : 1;
                if (st != SS_OK || steps->n != expected) {
                    fprintf(stderr, "%s: %zu steps, %s\n", kinds[kind], steps != NULL ? steps->n : 0, err.text);
                    named[3] += expected;
                    ss_steps_free(steps);
                    continue;
                }
                for (size_t of = 0; of < expected; of++) {
                    const ss_step *step = &steps->step[of];
                    const ss_step_law *l = &step->law[law];
                    const ss_value v[NUMBERS] = { l->direct_effect, l->evolution_effect, l->critical_slip_distance,
                                                  l->stiffness, l->drift };
                    const double truth[NUMBERS] = { r.a, r.b, r.Dc, r.k, r.drift };
                    named[step->answer == (ss_step_answer)law ? 0 : step->answer == SS_STEP_UNDECIDED ? 1
                          : step->answer == SS_STEP_NONE ? 3 : 2]++;
                    for (int k = 0; k < NUMBERS; k++) {
                        double off = fabs(v[k].value - truth[k]) / v[k].error;
                        within[0][k] += off <= 1;
                        within[1][k] += off <= 2;
                        far += off > 5;
                    }
                    numbers++;
                }
                ss_steps_free(steps);
            }
            size_t sum[2] = { 0 };
            printf("%s\t%s\t%zu\t%zu\t%zu\t%zu\t%zu", kinds[kind], law == 0 ? "aging" : "slip", numbers, named[0],
                   named[1], named[2], named[3]);
            for (int k = 0; k < NUMBERS; k++) {
                printf("\t%.0f/%.0f", 100. * (double)within[0][k] / (double)numbers,
                       100. * (double)within[1][k] / (double)numbers);
                sum[0] += within[0][k];
                sum[1] += within[1][k];
            }
            printf("\t%.1f\t%.1f\t%zu\t%.3f\n", 100. * (double)sum[0] / (double)(NUMBERS * numbers),
                   100. * (double)sum[1] / (double)(NUMBERS * numbers), far,
                   (double)cpu / CLOCKS_PER_SEC / (double)(2 * numbers));
            fflush(stdout);
            for (int k = 0; k < 4; k++)
                all_named[k] += named[k];
            all_far += far;
            all_within[0] += sum[0];
            all_within[1] += sum[1];
            all_numbers += NUMBERS * numbers;
        }
    printf("# all: %zu right, %zu cannot tell, %zu wrong, %zu none; ", all_named[0], all_named[1], all_named[2],
           all_named[3]);
    printf("within 1 error %.1f %%, 2 %.1f %%, beyond 5 %zu\n", 100. * (double)all_within[0] / (double)all_numbers,
           100. * (double)all_within[1] / (double)all_numbers, all_far);
    return 0;
}
