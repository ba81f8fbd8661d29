/* bench_sweep.c -- points a second and error of periodic states, by simulation, by shooting, and by
 * simulation that leaves the end of the approach to shooting.
 *
 * Prints, for grids around the paper's scenes and each tolerance, and for wide ones, the largest error of
 * x at the start of a forcing cycle over the scene's scale of x, against shooting at 1e-13 (the state
 * variable: simulation at 1e-11), points a CPU second, cycles to settle, and how many are periodic; then the gain of a
 * second thread and of a second process, in turns with one.  Exits 1 if an error exceeds twice the
 * tolerance, to which differences that shrink unevenly may bring it. */
#include <sys/wait.h>
#include <unistd.h>
#include "bench.h"

typedef struct kept {
    double x[4000], cycles;
    size_t n, ok;
} kept;

static int
keep(const ss_sweep_row *row, void *user)
{
    kept *k = user;
    k->x[k->n++] = row->status == SS_OK ? row->steady.value[SS_X_PHASE] : NAN;
    k->ok += row->status == SS_OK;
    k->cycles += row->status == SS_OK ? row->steady.value[SS_CYCLES] : 0;
    return 0;
}

typedef struct grid {
    ss_scene scene;
    ss_axis axis[2];
} grid;

static ss_sweep_opts
options(const grid *g, ss_steady_opts *how, kept *out)
{
    *out = (kept){ .n = 0 };
    ss_steady_opts_init(how, sizeof *how);
    return (ss_sweep_opts){ .size = sizeof (ss_sweep_opts), .steady = how, .axis = g->axis, .n_axes = 2, .shards = 1,
                            .threads = 1, .sink = keep, .user = out };
}

static void
sweep_shard(const grid *g, size_t shard, size_t shards, kept *out)
{
    ss_steady_opts how;
    ss_sweep_opts opts = options(g, &how, out);
    opts.shard = shard;
    opts.shards = shards;
    how.measures = 1u << SS_X_PHASE | 1u << SS_CYCLES;
    if (ss_sweep_run(&g->scene, &opts, NULL) != SS_OK)
        exit(2);
}

static double
sweep(const grid *g, double tol, ss_search search, int threads, kept *out)
{
    ss_steady_opts how;
    ss_sweep_opts opts = options(g, &how, out);
    opts.threads = threads;
    how.tol = tol;
    how.search = search;
    how.measures = 1u << SS_X_PHASE | 1u << SS_AMPLITUDE | 1u << SS_PERIOD;
    if (g->scene.model != ss_model_named("state-variable"))
        how.measures |= 1u << SS_STOPS | 1u << SS_STICK_FRACTION;
    if (search == SS_SEARCH_SIMULATE)
        how.measures |= 1u << SS_CYCLES;
    double seconds = bench_seconds();
    if (ss_sweep_run(&g->scene, &opts, NULL) != SS_OK)
        exit(2);
    return bench_seconds() - seconds;
}

static double
worst_error(const grid *g, const kept *k, const kept *truth)
{
    double worst = 0, scale = fmax(g->scene.base_amplitude, 1.3 / g->scene.stiffness);
    for (size_t i = 0; i < k->n; i++)
        if (isfinite(k->x[i]) && isfinite(truth->x[i]))
            worst = fmax(worst, fabs(k->x[i] - truth->x[i]) / scale);
    return worst;
}

static int
compare(const char *name, const grid *g, const double *tol, size_t n_tol)
{
    static const char *const word[] = { "both", "simulation", "shooting" };
    static kept truth, k;
    int bad = 0, smooth = g->scene.model == ss_model_named("state-variable");
    sweep(g, smooth ? 1e-11 : 1e-13, smooth ? SS_SEARCH_SIMULATE : SS_SEARCH_SHOOT, 1, &truth);
    for (size_t i = 0; i < n_tol; i++)
        for (ss_search way = SS_SEARCH_AUTO; way <= SS_SEARCH_SHOOT; way++) {
            double seconds = sweep(g, tol[i], way, 1, &k), error = worst_error(g, &k, &truth);
            printf("%-16s %6.0e  %-10s %8.1e %8.0f", name, tol[i], word[way], error,
                   (double)k.n / seconds);
            if (way == SS_SEARCH_SIMULATE)
                printf(" %7.1f", k.cycles / (double)k.ok);
            else
                printf("      - ");
            printf("  %zu of %zu\n", k.ok, k.n);
            bad |= error > 2 * tol[i];
        }
    return bad;
}

static double
clock_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The same in two processes, each with half of the points: what the machine has to give just
 * now. */
static double
by_processes(const grid *g)
{
    static kept k;
    double began = clock_now();
    fflush(stdout);
    pid_t child = fork();
    sweep_shard(g, child == 0, 2, &k);
    if (child == 0)
        _exit(0);
    waitpid(child, NULL, 0);
    return clock_now() - began;
}

/* Single runs are at the mercy of what else the machine does: the median of ratios in turns. */
static void
gain_of_threads(const grid *g)
{
    enum { TURNS = 15 };
    static kept k;
    double threads[TURNS], processes[TURNS];
    for (int i = 0; i < TURNS; i++) {
        double began = clock_now();
        sweep(g, 1e-9, SS_SEARCH_AUTO, 1, &k);
        double one = clock_now() - began;
        began = clock_now();
        sweep(g, 1e-9, SS_SEARCH_AUTO, 2, &k);
        threads[i] = one / (clock_now() - began);
        processes[i] = one / by_processes(g);
    }
    double median = bench_median(threads, TURNS);
    printf("2 threads: %.2f times as fast as 1 (best of %d: %.2f); 2 processes: %.2f\n", median,
           TURNS, threads[TURNS - 1], bench_median(processes, TURNS));
}

int
main(void)
{
    static const struct { const char *scene, *axis[2]; } row[] = {
        { "coulomb", { "friction=0.5:1.3:20", "base_frequency=2.5:3.5:20" } },
        { "compliant-heavy", { "friction=1.2:1.32:6", "base_frequency=2.4:2.6:6" } },
        { "compliant-light", { "friction=1.2:1.32:6", "base_frequency=2.4:2.6:6" } },
        { "state-variable", { "friction=1.2:1.32:2", "base_frequency=2.4:2.6:2" } },
        { "coulomb", { "friction=0.1:1.3:50", "base_frequency=2:7:80" } },
        { "compliant-heavy", { "friction=0.1:1.3:20", "base_frequency=1:9:20" } },
        { "compliant-light", { "contact_stiffness=1e3:1e7:12:log", "contact_damping=1:1e3:12:log" } },
        { "state-variable", { "friction=0.1:1.3:10", "base_frequency=2:7:10" } } };
    static const double tol[] = { 1e-3, 1e-6, 1e-9, 1e-12 };
    int bad = 0;
    printf("%-16s %6s  %-10s %8s %8s %7s  %s\n", "scene", "tol", "method", "error", "points/s",
           "cycles", "periodic");
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        grid g;
        g.scene = read_shipped_named(row[i].scene);
        g.scene.settle = 0;
        for (int k = 0; k < 2; k++)
            if (ss_axis_parse(&g.axis[k], row[i].axis[k], NULL) != SS_OK)
                return 2;
        if (i > 3)
            compare(row[i].scene, &g, tol + 2, 1);  /* shooting may find another of several states */
        else
            bad |= compare(row[i].scene, &g, tol, g.scene.model == ss_model_named("state-variable") ? 3 : 4);
        if (i == 0)
            gain_of_threads(&g);
    }
    return bad;
}
