/* ss-sweep -- the periodic state of a scene in numbers, over a grid of its parameters. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "options.h"

static const char usage[] =
"usage: ss-sweep [options] [--vary=KEY=FROM:TO:N[:log] ...] SCENE\n"
"Find the periodic state that the scene settles to at every point of a grid and\n"
"write one row each.  SCENE is a file, - or the name of a shipped scene.\n"
"  -y, --vary=K=A:B:N    N values of K from A to B, with :log in equal ratios\n"
"                        (repeatable; the last varies fastest)\n"
"  -m, --measure=LIST    of stops,stick,amplitude,x_max,v_max,a_max,energy,\n"
"                        period,cycles,microslips,transition,x_phase,v_phase,\n"
"                        floquet[2|_angle],cycle_time,lyapunov[_error],growth,\n"
"                        model_error_x|v|a|f[_rms],peak_velocity,force_drop\n"
"  -s, --set=KEY=VALUE   replace a value of the scene (repeatable)\n"
"      --simulate        find the period by simulation alone, see the manual\n"
"      --shoot           find a period by Newton's method at once\n"
"  -t, --tol=TOL         how near to periodic, see the manual (default 1e-9)\n"
"      --max-period=N    longest period, in cycles (8)\n"
"      --strobe=N        a row a cycle of the period, or for N aperiodic cycles\n"
"      --max-cycles=N    cycles after which a motion is aperiodic (10000)\n"
"      --max-steps=N     integration steps of a point (1e7)\n"
"      --settle-cycles=N simulate N cycles instead of looking for the limit\n"
"      --method=NAME     of ss-sim (default exact where there is one)\n"
"  -j, --threads=N       work on N points at a time (1)\n"
"      --shard=I/N       every N-th point only: index I modulo N\n"
"  -r, --resume=FILE     append to FILE the rows that it lacks, or begin it\n"
"  -o, --output=FILE     .tsv .csv .json; --format=tsv|csv|json of stdout\n"
"  -q, --quiet   -v, --verbose   -h, --help   --version\n";

typedef struct request {
    const char *scene_path, *path, *resume;
    tool_kind kind;
    tool_texts settings;
    ss_axis *axis;
    ss_steady_opts steady;
    ss_sweep_opts opts;
    ss_measure pick[SS_MEASURES];       /* the measures, in the order of the command line */
    size_t n_picks;
    ss_sweep_text text;
} request;

static void
set_measures(const tool_option *o, char *names)
{
    request *req = o->to;
    const char *known[SS_MEASURES + 1] = { NULL };
    for (ss_measure m = 0; m < SS_MEASURES; m++)
        known[m] = ss_measure_label(m)->name;
    req->steady.measures = 0;
    req->n_picks = 0;
    for (char *comma; names != NULL; names = comma) {
        if ((comma = strchr(names, ',')) != NULL)
            *comma++ = '\0';
        ss_measure m = (ss_measure)tool_choice("--measure", names, known);
        if (req->steady.measures & 1u << m)
            tool_usage("--measure: '%s' is repeated", known[m]);
        req->steady.measures |= 1u << m;
        req->pick[req->n_picks++] = m;
    }
}

static void
set_shard(const tool_option *o, char *text)
{
    ss_sweep_opts *opts = o->to;
    char *slash, *end;
    long i = strtol(text, &slash, 10), n = *slash == '/' ? strtol(slash + 1, &end, 10) : 0;
    if (*slash != '/' || slash == text || end == slash + 1 || *end != '\0' || n < 1 || i < 0
        || i > n)
        tool_usage("--shard: '%s' is not I/N with I from 0 to N - 1, or from 1 to N", text);
    opts->shard = (size_t)(i % n);
    opts->shards = (size_t)n;
}

static void
add_axis(const tool_option *o, char *text)
{
    request *req = o->to;
    req->axis = tool_room(req->axis, req->opts.n_axes + 1, sizeof *req->axis);
    if (ss_axis_parse(&req->axis[req->opts.n_axes++], text, &tool_error) != SS_OK)
        tool_usage("--vary: %s", tool_error.text);
}

static void
set_search(const tool_option *o, char *text)
{
    (void)text;
    *(ss_search *)o->to = strcmp(o->name, "shoot") == 0 ? SS_SEARCH_SHOOT : SS_SEARCH_SIMULATE;
}

static void
parse(request *req, int argc, char *argv[])
{
    const ss_range periods = { 1, SS_PERIOD_MAX }, strobes = { 1, SS_STROBE_MAX };
    ss_steady_opts *steady = &req->steady;
    const tool_option options[] = {
        TOOL_VALUE('y', "vary", add_axis, req), TOOL_VALUE('m', "measure", set_measures, req),
        TOOL_TEXTS('s', "set", &req->settings), TOOL_CALL(0, "simulate", set_search, &steady->search),
        TOOL_CALL(0, "shoot", set_search, &steady->search),
        TOOL_NUMBER('t', "tol", &steady->tol, ss_steady_tolerances),
        TOOL_WHOLE(0, "max-period", &steady->max_period, periods),
        TOOL_WHOLE(0, "strobe", &steady->strobe, strobes),
        TOOL_COUNT(0, "max-cycles", &steady->max_cycles), TOOL_COUNT(0, "max-steps", &steady->max_steps),
        TOOL_COUNT(0, "settle-cycles", &steady->settle), TOOL_METHOD(0, &steady->method),
        TOOL_THREADS('j', &req->opts.threads), TOOL_VALUE(0, "shard", set_shard, &req->opts),
        TOOL_TEXT('r', "resume", &req->resume), TOOL_OUTPUT(&req->path),
        TOOL_FORMAT_OF_WORDS(&req->kind) };
    int first = TOOL_PARSE(argc, argv, options, NULL);
    if (first == argc)
        tool_usage("SCENE is missing: give a file, or the name of a shipped scene");
    req->scene_path = tool_input(argc, argv, first);
    req->text.format = tool_stream(tool_output_kind(req->path, TOOL_WORDS, req->kind));
    const char *ending = req->resume != NULL ? strrchr(req->resume, '.') : NULL;
    ss_format_info named;
    for (size_t i = 0; ending != NULL && ss_format_at(&named, i); i++)
        if (named.has_words && strcmp(named.name, ending + 1) == 0)
            req->text.format = named.format;
    if (req->resume != NULL && strcmp(req->resume, "-") == 0)
        tool_usage("--resume needs a file: what went to standard output cannot be read again");
    if (req->resume != NULL && req->path != NULL)
        tool_usage("--resume and --output exclude each other");
    if (req->resume != NULL && req->text.format != SS_TSV)
        tool_usage("--resume goes on with .tsv, whose notes say of what sweep it is");
    for (size_t i = 0; i < req->settings.n; i++) {
        const char *name = req->settings.text[i] + strspn(req->settings.text[i], " \t");
        size_t length = strcspn(name, " \t=");
        for (size_t k = 0; k < req->opts.n_axes; k++)
            if (strlen(req->axis[k].key) == length && strncmp(req->axis[k].key, name, length) == 0)
                tool_usage("%s is both varied and set", req->axis[k].key);
    }
}

/* Read the scene.  If a setting chooses the model, the scene may lack a key of this model that is varied:
 * it gets the first value. */
static ss_scene
read_scene(const request *req)
{
    enum { LONGEST = 80 };
    int sets_model = 0;
    tool_texts all = { tool_room(NULL, req->settings.n + req->opts.n_axes, sizeof *all.text), 0 };
    char (*first)[LONGEST] = tool_room(NULL, req->opts.n_axes, sizeof *first);
    for (; all.n < req->settings.n; all.n++) {
        all.text[all.n] = req->settings.text[all.n];
        sets_model |= strncmp(all.text[all.n], "model", strlen("model")) == 0;
    }
    for (size_t i = 0; sets_model && i < req->opts.n_axes; i++) {
        snprintf(first[i], LONGEST, "%s=%.17g", req->axis[i].key, req->axis[i].from);
        all.text[all.n++] = first[i];
    }
    const ss_scene scene = tool_read_scene(req->scene_path, &all,
                                           all.n > req->settings.n ? "--set or --vary" : "--set");
    free(first);
    free(all.text);
    return scene;
}

int
main(int argc, char *argv[])
{
    static request req = { .kind = TOOL_TSV };
    ss_steady_opts_init(&req.steady, sizeof req.steady);
    ss_sweep_opts_init(&req.opts, sizeof req.opts);
    req.opts.steady = &req.steady;
    req.opts.progress.function = tool_progress;

    tool_begin(argv, "ss-sweep", usage);
    parse(&req, argc, argv);
    ss_scene scene = read_scene(&req);
    req.opts.axis = req.axis;
    if (ss_sweep_check(&scene, &req.opts, &tool_error) != SS_OK)
        tool_usage("%s", tool_error.text);

    char *name = tool_name_scene(req.scene_path, &req.settings);
    req.text = (ss_sweep_text){ .name = name, .scene = &scene, .opts = &req.opts,
                                .measure = req.pick, .n_measures = req.n_picks,
                                .format = req.text.format };
    tool_end_at_rows(req.path);
    FILE *out = req.resume != NULL ? tool_output_kept(req.resume) : tool_output(req.path);
    ss_sweep_done done;
    tool_check(ss_sweep_write(&req.text, out, req.resume, &done, &tool_error));
    if (req.resume != NULL)
        tool_note("%s: rows that were there: %zu", req.resume, done.kept);
    tool_note("%zu point%s, incomplete: %zu", done.rows, tool_s(done.rows), done.failed);
    tool_end();
    return 0;
}
