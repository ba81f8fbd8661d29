/* cost_sim.c -- what simulation costs.
 *
 * cost_sim compare SECONDS: rows as in bench.h, our methods on the paper's scenes.
 * cost_sim cost SCRATCH.h5: against length, contact stiffness, rate, columns and output form.
 * As a shared library: cost_taylor() for cost_heyoka.py. */
#include <stickslip/store.h>
#include "bench.h"

static double
time_run(const ss_scene *scene, const char *method, double tol, double *x, size_t *events)
{
    double seconds[15];
    int n = scene->duration > 100 ? 1 : 15;
    for (int i = 0; i < n; i++) {
        double began = bench_seconds();
        if (cost_simulate(scene, method, tol, x, events) != SS_OK)
            return NAN;
        seconds[i] = bench_seconds() - began;
    }
    return bench_median(seconds, n);
}

static void
row(const bench_scene *b, const char *method, double tol)
{
    double *x = bench_alloc(ss_scene_samples(&b->scene));
    size_t events;
    double seconds = time_run(&b->scene, method, tol, x, &events);
    if (isfinite(seconds))
        bench_row(b, method, tol, x, events, seconds);
    free(x);
}

static void
compare_on(bench_scene b)
{
    static const char *const method[] = { "taylor", "rk8pd", "rkf45", "msadams" };
    if (strcmp(ss_sim_method_for(&b.scene, NULL), "taylor") == 0)     /* how good its reference is */
        row(&b, "rkf45", 1e-13);
    else
        row(&b, "exact", 1e-12);
    for (size_t i = 0; i < sizeof method / sizeof *method; i++)
        for (double tol = 1e-4; tol > (i == 0 ? 1e-15 : i < 3 ? 1e-13 : 1e-7); tol /= 100)
            row(&b, method[i], tol);
    bench_scene_free(&b);
}

/* The Coulomb scene with a friction that falls with speed; cost_heyoka.py has the same. */
static ss_scene
falling(void)
{
    ss_scene scene = read_shipped_named("coulomb");
    ss_scene_set_text(&scene, "model", "stribeck", NULL);
    scene.settle = 0;
    scene.friction = 0.9;
    scene.static_friction = 1.28;
    ss_scene_set(&scene, "stribeck_velocity", 1e-3, NULL);
    return scene;
}

/* CPU seconds that taylor takes for a scene, NAN if it fails. */
double cost_taylor(int falls, double duration, double tol, double *x);

double
cost_taylor(int falls, double duration, double tol, double *x)
{
    ss_scene scene = falls ? falling() : read_shipped_named("state-variable");
    size_t events;
    scene.settle = 0;
    scene.duration = duration;
    double began = bench_seconds();
    return cost_simulate(&scene, "taylor", tol, x, &events) == SS_OK ? bench_seconds() - began : NAN;
}

static void
compare(double duration)
{
    for (const ss_shipped_scene *s = ss_shipped_scenes; s->name != NULL; s++)
        compare_on(bench_scene_new(s, duration));
    const ss_scene scene = falling();
    compare_on(bench_scene_of("stribeck", &scene, duration));
}

/* --- cost ---------------------------------------------------------------------------------- */

static ss_scene
scene_named(const char *name)
{
    ss_scene scene = read_shipped_named(name);
    scene.settle = 0;
    scene.duration = 10;
    return scene;
}

static int
discard(const ss_sample *s, size_t n, void *user)
{
    (void)s, (void)n, (void)user;
    return 0;
}

/* Median seconds, or NAN and why not in err. */
static double
time_to(ss_sample_sink *sink, void *user, const ss_scene *scene, const char *method,
        unsigned long max_steps, ss_sim_stats *stats, ss_error *err)
{
    ss_sim_opts opts = { .size = sizeof(ss_sim_opts), .method = method, .tol = 1e-10, .max_steps = max_steps, .samples = sink,
                         .user = user };
    double seconds[9], total = 0;
    int n = 0;
    while (n < 9 && total < 1) {
        double began = bench_seconds();
        if (ss_sim_run(scene, &opts, stats, err) != SS_OK)
            return NAN;
        seconds[n] = bench_seconds() - began;
        total += seconds[n++];
    }
    return bench_median(seconds, n);
}

static const char *const path[] = { "exact", "rk8pd" };

static void
cost_of_length(void)
{
    printf("\nLength, compliant-light at 100 Hz: ms of CPU a second simulated\n"
           "seconds\texact\trk8pd 1e-10\n");
    for (double duration = 10; duration <= 1e5; duration *= 10) {
        ss_scene s = scene_named("compliant-light");
        s.duration = duration;
        s.rate = 100;
        printf("%g", duration);
        for (int i = 0; i < 2; i++)
            printf("\t%.3g", 1e3 / duration * time_to(discard, NULL, &s, path[i], 0, NULL, NULL));
        printf("\n");
    }
}

static void
cost_of_stiffness(void)
{
    printf("\nContact stiffness, 10 s of compliant-light at 2 kHz, damping ratio kept, at most 1e7 "
           "steps\nK_y/(N/m)\tmethod\tms\tsteps\tevents\n");
    for (double K = 1e3; K <= 1.1e12; K *= 10)
        for (int i = 0; i < 2; i++) {
            ss_scene s = scene_named("compliant-light");
            ss_sim_stats stats;
            ss_error err = { 0 };
            ss_scene_set(&s, "contact_damping", ss_scene_get(&s, "contact_damping") * sqrt(K / ss_scene_get(&s, "contact_stiffness")), NULL);
            ss_scene_set(&s, "contact_stiffness", K, NULL);
            double seconds = time_to(discard, NULL, &s, path[i], 10000000, &stats, &err);
            if (isfinite(seconds))
                printf("%.0e\t%s\t%.3g\t%lu\t%lu\n", K, path[i], 1e3 * seconds, stats.steps,
                       stats.events);
            else
                printf("%.0e\t%s\trefused: %s\n", K, path[i], err.text);
        }
}

static void
cost_of_rate(void)
{
    printf("\nRate, 10 s of compliant-light: ms, and ns a sample over those without samples\n"
           "rate/Hz\texact\tns\trk8pd 1e-10\tns\n");
    ss_scene s = scene_named("compliant-light");
    double bare[2];
    printf("none");
    for (int i = 0; i < 2; i++) {
        bare[i] = time_to(NULL, NULL, &s, path[i], 0, NULL, NULL);
        printf("\t%.3g\t-", 1e3 * bare[i]);
    }
    printf("\n");
    for (s.rate = 20; s.rate <= 2e6; s.rate *= 10) {
        printf("%g", s.rate);
        for (int i = 0; i < 2; i++) {
            double seconds = time_to(discard, NULL, &s, path[i], 0, NULL, NULL);
            printf("\t%.3g\t%.3g", 1e3 * seconds, 1e9 * (seconds - bare[i]) / (10 * s.rate));
        }
        printf("\n");
    }
}

typedef struct rows {
    ss_sim_columns columns;
    ss_writer *writer;
} rows;

static int
write_rows(const ss_sample *s, size_t n, void *user)
{
    rows *r = user;
    double row[SS_SIM_COLUMNS], *column[SS_SIM_COLUMNS];
    for (size_t c = 0; c < SS_SIM_COLUMNS; c++)
        column[c] = &row[c];
    for (size_t i = 0; i < n; i++) {
        ss_sim_rows(&r->columns, &s[i], 1, column);
        if (ss_writer_rows(r->writer, column, 1, NULL) != SS_OK)
            return 1;
    }
    return 0;
}

static int
pick_rows(const ss_sample *s, size_t n, void *user)
{
    rows *r = user;
    volatile double sink;
    double row[SS_SIM_COLUMNS], *column[SS_SIM_COLUMNS];
    for (size_t c = 0; c < SS_SIM_COLUMNS; c++)
        column[c] = &row[c];
    for (size_t i = 0; i < n; i++) {
        ss_sim_rows(&r->columns, &s[i], 1, column);
        sink = row[0];
        (void)sink;
    }
    return 0;
}

static void
cost_of_columns(void)
{
    static const char *const list[] = { "t,a", "t,x,v,a,f", "t,x,v,a,f,y,z,mode" };
    printf("\nColumns, 10 s of compliant-light at 2 kHz, exact: ms\ncolumns\tpicked\tas AU\tas text\n");
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        ss_scene s = scene_named("compliant-light");
        rows r;
        ss_sim_columns_parse(&r.columns, list[i], NULL);
        printf("%s\t%.3g", list[i], 1e3 * time_to(pick_rows, &r, &s, "exact", 0, NULL, NULL));
        for (int form = 0; form < 2; form++) {
            FILE *out = fopen("/dev/null", "w");
            ss_header *head = NULL;
            ss_sim_header(&head, &s, &r.columns, NULL);
            if (out == NULL || head == NULL
                || ss_writer_new(&r.writer, out, NULL, form == 0 ? SS_AU : SS_TSV,
                                 &(ss_contents){ .signal = head }, NULL) != SS_OK)
                exit(1);
            printf("\t%.3g", 1e3 * time_to(write_rows, &r, &s, "exact", 0, NULL, NULL));
            ss_writer_free(r.writer);
            ss_header_free(head);
            fclose(out);
        }
        printf("\n");
    }
}

static void
cost_of_form(const char *h5)
{
    ss_scene s = scene_named("compliant-light");
    ss_signal *signal = NULL;
    s.duration = 100;
    if (ss_sim_signal(&signal, &s, NULL) != SS_OK)
        exit(1);
    double numbers = (double)(signal->n * (signal->head->n_columns + 1));
    printf("\nOutput, 100 s of compliant-light at 2 kHz, t,x,v,a,f: millions of numbers a second\n");
    for (int form = 0; form < 3; form++) {
        double seconds[5];
        for (int i = 0; i < 5; i++) {
            double began = bench_seconds();
            if (form < 2) {
                FILE *out = fopen("/dev/null", "w");
                if (out == NULL || ss_record_write(&(ss_record){ .signal = signal }, out, NULL,
                                                   form == 0 ? SS_TSV : SS_AU, NULL) != SS_OK)
                    exit(1);
                fclose(out);
            } else if (ss_record_write(&(ss_record){ .signal = signal }, NULL, h5, SS_H5, NULL) != SS_OK) {
                exit(1);
            }
            seconds[i] = bench_seconds() - began;
        }
        printf("%s\t%.3g\n", form == 0 ? "text" : form == 1 ? "AU" : "HDF5",
               1e-6 * numbers / bench_median(seconds, 5));
    }
    remove(h5);
    ss_signal_free(signal);
}

int
main(int argc, char *argv[])
{
    if (argc == 3 && strcmp(argv[1], "compare") == 0) {
        compare(atof(argv[2]));
    } else if (argc == 3 && strcmp(argv[1], "cost") == 0) {
        cost_of_length();
        cost_of_stiffness();
        cost_of_rate();
        cost_of_columns();
        cost_of_form(argv[2]);
    } else {
        fprintf(stderr, "usage: cost_sim compare SECONDS | cost_sim cost SCRATCH.h5\n");
        return 2;
    }
    return 0;
}
