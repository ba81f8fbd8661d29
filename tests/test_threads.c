/* test_threads.c -- two threads with objects of their own, and two that execute one plan, get what
 * one gets.  tests/long/threads.sh runs it under the thread sanitizer. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <stickslip.h>
#include "map/map.h"

#include "unit.h"
#include "signal/noise.h"

enum { THREADS = 2, ROUNDS = 5 };

/* What one thread does, and what came of it. */
typedef struct job {
    const ss_morlet *plan;      /* shared */
    const double *x;
    double *w;
    char *text;                 /* coefficients of a signal of its own, written, read and written */
    size_t length;
    ss_status status;
} job;

static ss_status
write_again(const ss_coefficients *c, job *j)
{
    ss_coefficients *back = NULL;
    FILE *out = open_memstream(&j->text, &j->length);
    ss_status st = ss_record_write(&(ss_record){ .coefficients = c }, out, NULL, SS_TSV, NULL);
    fclose(out);
    FILE *in = fmemopen(j->text, j->length, "r");
    if (st == SS_OK)
        st = ss_coefficients_read(&back, in, "in", NULL);
    fclose(in);
    free(j->text);
    out = open_memstream(&j->text, &j->length);
    if (st == SS_OK)
        st = ss_record_write(&(ss_record){ .coefficients = back }, out, NULL, SS_TSV, NULL);
    fclose(out);
    ss_coefficients_free(back);
    return st;
}

static void *
make_own(void *user)
{
    job *j = user;
    for (int i = 0; i < ROUNDS && j->status == SS_OK; i++) {
        ss_scene scene = { .model = ss_model_named("compliant"), .mass = 2.42, .stiffness = 2310,
            .friction = 1.28, .base_amplitude = 6e-4, .base_frequency = 2.5, .duration = 0.5, .rate = 1000 };
        ss_scene_set(&scene, "contact_stiffness", 209900, NULL);
        ss_scene_set(&scene, "contact_damping", 25, NULL);
        ss_morlet_opts opts = ss_morlet_defaults;
        ss_signal *signal = NULL;
        ss_coefficients *c = NULL;
        opts.voices = 3;
        opts.engine = SS_ENGINE_FFT;    /* FFTW's planner, too */
        j->status = ss_sim_signal(&signal, &scene, NULL);
        if (j->status == SS_OK)
            j->status = ss_noise_add_once(signal->values, signal->n, 1e-3, 7, NULL);
        if (j->status == SS_OK)
            j->status = ss_morlet_transform(&c, signal, 0, &opts, NULL);
        free(j->text);
        j->text = NULL;
        if (j->status == SS_OK)
            j->status = write_again(c, j);
        ss_coefficients_free(c);
        ss_signal_free(signal);
    }
    return NULL;
}

static void *
execute_shared(void *user)
{
    job *j = user;
    for (int i = 0; i < ROUNDS && j->status == SS_OK; i++)
        j->status = ss_morlet_execute(j->plan, j->x, j->w, NULL);
    return NULL;
}

static void
run_together(void *(*work)(void *), job *jobs)
{
    pthread_t thread[THREADS];
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, work, &jobs[i]), 0);
    for (int i = 0; i < THREADS; i++)
        pthread_join(thread[i], NULL);
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(jobs[i].status, SS_OK);
}

static void
threads_with_objects_of_their_own_get_what_one_gets(void **state)
{
    job alone = { 0 }, jobs[THREADS] = { { 0 } };
    (void)state;
    make_own(&alone);
    assert_int_equal(alone.status, SS_OK);
    run_together(make_own, jobs);
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(jobs[i].length, alone.length);
        assert_memory_equal(jobs[i].text, alone.text, alone.length);
        free(jobs[i].text);
    }
    free(alone.text);
}

static void
threads_that_share_a_plan_get_what_one_gets(void **state)
{
    static const ss_engine engine[] = { SS_ENGINE_QUADRATURE, SS_ENGINE_FFT };
    ss_wave_opts wave = ss_wave_defaults;
    ss_signal *signal;
    (void)state;
    wave.duration = 1;
    assert_int_equal(ss_wave_new(&signal, SS_CHIRP, &wave, NULL), SS_OK);
    for (size_t e = 0; e < sizeof engine / sizeof *engine; e++) {
        ss_morlet *plan;
        ss_morlet_opts opts = ss_morlet_defaults;
        opts.voices = 4;
        opts.engine = engine[e];
        opts.threads = 2;               /* and each of the two has two */
        assert_int_equal(ss_morlet_new(&plan, signal->n, 2000, &opts, NULL), SS_OK);
        size_t bytes = 2 * ss_morlet_grid(plan)->total * sizeof(double);
        job alone = { .plan = plan, .x = signal->values, .w = malloc(bytes) }, jobs[THREADS];
        for (int i = 0; i < THREADS; i++)
            jobs[i] = (job){ .plan = plan, .x = signal->values, .w = malloc(bytes) };
        execute_shared(&alone);
        run_together(execute_shared, jobs);
        for (int i = 0; i < THREADS; i++) {
            assert_memory_equal(jobs[i].w, alone.w, bytes);
            free(jobs[i].w);
        }
        free(alone.w);
        ss_morlet_free(plan);
    }
    ss_signal_free(signal);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_with_objects_of_their_own_get_what_one_gets),
        cmocka_unit_test(threads_that_share_a_plan_get_what_one_gets),
    };
    return cmocka_run_group_tests_name("threads", tests, NULL, NULL);
}
