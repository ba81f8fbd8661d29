/* plan.c -- one wavelet plan for many records of one length, executed by several threads at once.
 *
 *     cc plan.c $(pkg-config --cflags --libs stickslip gsl) -lpthread -lm -o plan
 *
 * Two sines: the amplitude of each comes out of its record's coefficients, to 1e-9. */
#include <stickslip.h>

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

enum { RECORDS = 2, N = 4000 };
static const double rate = 2000, frequency = 50;

typedef struct job {
    const ss_morlet *plan;
    double amplitude, found;
    ss_status status;
} job;

/* With the 1/a norm, a sine of amplitude A gives |W| = A pi^1/4 2^-1/2 where a is that of its
 * frequency. */
static void *
transform(void *argument)
{
    job *j = argument;
    double *x = malloc(N * sizeof *x), *w = malloc(2 * ss_morlet_grid(j->plan)->total * sizeof *w);
    j->status = x != NULL && w != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; j->status == SS_OK && i < N; i++)
        x[i] = j->amplitude * cos(2 * acos(-1) * frequency * (double)i / rate);
    if (j->status == SS_OK)
        j->status = ss_morlet_execute(j->plan, x, w, NULL);
    if (j->status == SS_OK) {
        const ss_scale *scale = ss_morlet_grid(j->plan)->scale;
        const double *middle = w + 2 * (scale->offset + scale->n / 2);
        j->found = hypot(middle[0], middle[1]) * sqrt(2) / pow(acos(-1), 0.25);
    }
    free(x);
    free(w);
    return NULL;
}

int
main(void)
{
    ss_morlet *plan;
    ss_error err = { 0 };
    ss_morlet_opts opts;
    ss_morlet_opts_init(&opts, sizeof opts);
    opts.norm = SS_NORM_L1;
    opts.dense = 1;
    opts.accuracy = 1e-9;
    opts.octaves = 1;                   /* one scale, the one that is labelled 50 Hz */
    opts.m0 = opts.m1 = -6;
    opts.center = 2 * acos(-1) * frequency / 64;
    ss_status status = ss_morlet_new(&plan, N, rate, &opts, &err);
    if (status != SS_OK) {
        fprintf(stderr, "plan: %s\n", err.text);
        return 1;
    }
    job jobs[RECORDS] = { { plan, 1, 0, SS_OK }, { plan, 2.5, 0, SS_OK } };
    pthread_t thread[RECORDS];
    int started = 0;
    while (started < RECORDS && pthread_create(&thread[started], NULL, transform, &jobs[started]) == 0)
        started++;
    for (int i = 0; i < started; i++) {
        pthread_join(thread[i], NULL);
        if (jobs[i].status == SS_OK)
            printf("amplitude %.6f\n", jobs[i].found);
        else
            status = jobs[i].status;
    }
    ss_morlet_free(plan);
    return status != SS_OK || started < RECORDS;
}
