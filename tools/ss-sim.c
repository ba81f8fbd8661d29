/* ss-sim -- simulate a scene; write samples or events. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "options.h"

static const char usage[] =
"usage: ss-sim [options] SCENE\n"
"Simulate an oscillator with dry friction.  SCENE is a file, - for standard\n"
"input, or the name of a shipped scene; the record goes to standard output.\n"
"  -s, --set=KEY=VALUE   replace a value of the scene (repeatable)\n"
"  -b, --base=FILE[:COL] the base moves as measured in FILE, column z or COL\n"
"  -c, --columns=LIST    of t,x,v,a,f,s,y,z,mode (default t,x,v,a,f)\n"
"  -e, --events          write the events in the record, not the samples\n"
"  -m, --method=NAME     a GSL step type, taylor: a series, or exact: closed form\n"
"                        (default rk8pd; taylor where there is no closed form,\n"
"                        radau for stiff friction)\n"
"  -t, --tol=TOL         relative local error of a step (default 1e-12)\n"
"  -a, --accuracy=TOL    global error of x over max|x|: chooses --tol and,\n"
"                        if none is given, --method\n"
"      --max-steps=N     stop after N integration steps\n"
"  -l, --list            list the shipped scenes and the methods; with SCENE, its\n"
"                        keys and values, a scene to edit\n"
"  -o, --output=FILE     .tsv, .au, .csv, .json, .wav or .h5, complete or absent\n"
"      --format=FORM     of standard output: tsv (default), au, csv, json, wav\n"
"  -q, --quiet           no warnings, no progress\n"
"  -v, --verbose         report the method, the work and the cost\n"
"  -h, --help            show this text; --version: show the version\n";

/* What was asked for. */
typedef struct request {
    const char *base;                   /* NULL: the scene's */
    const char *scene_path, *path;      /* path: of the output, NULL or "-" for standard output */
    tool_texts settings;
    ss_sim_columns columns;
    int events, list;
    tool_kind kind;
    double accuracy;                    /* 0: not asked for */
    ss_sim_opts opts;
} request;

/* The output of the sinks, begun with the first sample or event, so that a run that fails at once writes
 * nothing. */
typedef struct output {
    const request *req;
    ss_contents contents;
    ss_writer *writer;
    size_t samples;
    ss_error error;
} output;

static void
begin(output *o)
{
    if (o->writer == NULL)
        o->writer = tool_writer(o->req->path, o->req->kind, &o->contents);
}

/* Rows are written a block at a time: row by row, a writer would spend a twentieth of the tool's time on
 * its own calls. */
enum { BLOCK = 64 };

static int
stream_samples(const ss_sample *s, size_t n, void *user)
{
    output *o = user;
    size_t rows;
    double block[SS_SIM_COLUMNS][BLOCK], *column[SS_SIM_COLUMNS];
    begin(o);
    for (size_t c = 0; c < SS_SIM_COLUMNS; c++)
        column[c] = block[c];
    for (o->samples += n; n > 0; s += rows, n -= rows) {
        rows = n < BLOCK ? n : BLOCK;
        ss_sim_rows(&o->req->columns, s, rows, column);
        if (tool_stopping() || ss_writer_rows(o->writer, column, rows, &o->error) != SS_OK)
            return 1;
    }
    return 0;
}

static int
stream_event(const ss_event *e, void *user)
{
    output *o = user;
    begin(o);
    return ss_writer_events(o->writer, e, 1, &o->error) != SS_OK;
}

static void
list_scenes(const ss_shipped_scene *s)
{
    for (; s->name != NULL; s++)
        printf("%-19s %s\n", s->name, s->summary);
}

static void TOOL_NORETURN
list(void)
{
    list_scenes(ss_shipped_scenes);
    list_scenes(ss_catalogue_scenes);
    printf("\nmethods:");
    for (size_t i = 0; ss_sim_method_name(i) != NULL; i++)
        printf(" %s", ss_sim_method_name(i));
    printf("\n");
    tool_end();
    exit(0);
}

/* Let the base move as it was measured, in place of the scene's base.  A column follows the last colon,
 * unless the name of a file goes on there. */
static void
set_base(ss_scene *scene, const char *given)
{
    static ss_base *base;
    char *path = strdup(given), *colon = path != NULL ? strrchr(path, ':') : NULL;
    if (path == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    const char *column = "";
    if (colon != NULL && colon[1] != '/' && access(path, F_OK) != 0) {
        *colon = '\0';
        column = colon + 1;
    }
    const char *slash = strrchr(path, '/'), *file = slash != NULL ? slash + 1 : path;
    if (strlen(column) >= sizeof scene->base_column)
        tool_usage("--base: the name of the column is longer than %zu bytes; its number stands for it, too",
                   sizeof scene->base_column - 1);
    if (strlen(file) >= sizeof scene->base_file)
        tool_usage("--base: '%s' is longer than %zu bytes", file, sizeof scene->base_file - 1);
    strcpy(scene->base_file, file);
    strcpy(scene->base_column, column);
    tool_check_base(ss_base_load(&base, scene, tool_reads(path), &tool_error));
    scene->base_amplitude = scene->base_frequency = scene->phase = 0;
    free(path);
}

/* Set the method asked for, or one that keeps the accuracy if that was asked for. */
static void
set_method(ss_sim_opts *opts, const ss_scene *scene, double accuracy)
{
    if (accuracy > 0) {
        ss_status st = ss_trade_choose(opts, scene, accuracy, &tool_error);
        if (st == SS_EINVAL)
            tool_usage("--accuracy: %s", tool_error.text);
        tool_check(st);
        tool_note("accuracy %g: method %s, tol %g", accuracy, opts->method, opts->tol);
        return;
    }
    if (opts->method == NULL) {
        const char *why;
        opts->method = ss_sim_method_for(scene, &why);
        tool_note("method %s: %s", opts->method, why);
    }
}

static void
set_columns(const tool_option *o, char *text)
{
    if (ss_sim_columns_parse(o->to, text, &tool_error) != SS_OK)
        tool_usage("--columns: %s", tool_error.text);
}

static void
parse(request *req, int argc, char *argv[])
{
    ss_sim_opts *opts = &req->opts;
    ss_sim_opts_init(opts, sizeof *opts);
    opts->progress.function = tool_progress;
    const tool_option options[] = {
        TOOL_TEXTS('s', "set", &req->settings), TOOL_TEXT('b', "base", &req->base),
        TOOL_VALUE('c', "columns", set_columns, &req->columns), TOOL_FLAG('e', "events", &req->events),
        TOOL_METHOD('m', &opts->method), TOOL_NUMBER('t', "tol", &opts->tol, ss_sim_tolerances),
        TOOL_NUMBER('a', "accuracy", &req->accuracy, ss_trade_accuracies),
        TOOL_COUNT(0, "max-steps", &opts->max_steps), TOOL_FLAG('l', "list", &req->list),
        TOOL_OUTPUT(&req->path), TOOL_FORMAT(&req->kind) };
    int first = TOOL_PARSE(argc, argv, options, NULL);
    if (first == argc && req->list)
        list();
    if (first == argc)
        tool_usage("SCENE is missing: give a file, or a name that --list shows");
    req->scene_path = tool_input(argc, argv, first);
    if (req->list)
        return;
    req->kind = tool_output_kind(req->path, req->events ? TOOL_WORDS : TOOL_SIGNALS, req->kind);
    ss_format_info form = { .has_words = 0 };
    for (size_t i = 0; ss_format_at(&form, i) && form.format != tool_stream(req->kind); i++)
        ;
    if (req->events && !form.has_words)
        tool_usage("--events are text, and this --format holds numbers only");
    if (req->accuracy > 0 && tool_given("tol"))
        tool_usage("--accuracy and --tol exclude each other");
}

/* Run the scene.  Samples and events go to the output that was asked for. */
static void
simulate(request *req, const ss_scene *scene, output *o)
{
    ss_sim_stats stats = { 0 };
    req->opts.user = req->opts.progress.user = o;
    if (o->contents.events)
        req->opts.events = stream_event;
    if (!req->events)
        req->opts.samples = stream_samples;
    tool_end_at_rows(req->path);
    ss_status st = ss_sim_run(scene, &req->opts, &stats, &tool_error);
    if (st == SS_STOP && !tool_stopping())
        tool_check_error(SS_EIO, &o->error);
    tool_check(st);
    tool_note("%s at tol %g: steps: %lu, right-hand sides: %lu, events: %lu", req->opts.method,
              req->opts.tol, stats.steps, stats.rhs, stats.events);
    if (stats.unresolved > 0 && req->accuracy == 0)     /* an accuracy was checked by two methods */
        tool_warn("slips and touches of the limit smaller than the error of x: %lu; x is right, "
                  "their number and times are not resolved", stats.unresolved);
}

int
main(int argc, char *argv[])
{
    static request req = { .kind = TOOL_TSV };
    output o = { .req = &req };

    tool_begin(argv, "ss-sim", usage);
    ss_sim_columns_parse(&req.columns, "t,x,v,a,f", NULL);
    parse(&req, argc, argv);
    ss_scene scene = tool_read_scene(req.scene_path, &req.settings, "--set");
    char tol[SS_NUMBER_MAX], *name = tool_name_scene(req.scene_path, &req.settings);
    if (req.list) {                             /* write the scene as it would be simulated */
        FILE *out = tool_output(req.path);
        fprintf(out, "# %s\n", name);
        tool_check(ss_scene_write(&scene, out, NULL));
        free(name);
        tool_end();
        return 0;
    }
    if (req.base != NULL)
        set_base(&scene, req.base);
    /* a mistyped rate must not fill the disk, or the memory, without a warning */
    const double most = 1e10, samples = scene.duration * scene.rate;
    if (!req.events && req.opts.max_steps == 0 && samples > most)
        tool_die("duration x rate = %g s x %g Hz are %.2g samples: more than %.0g are written only "
                 "with --max-steps", scene.duration, scene.rate, samples, most);
    set_method(&req.opts, &scene, req.accuracy);
    ss_header *head;
    int has_events = ss_model_has_events(scene.model);
    tool_check(ss_sim_header(&head, &scene, &req.columns, &tool_error));
    ss_number_format(tol, req.opts.tol);
    if (ss_header_note(head, "scene", name, NULL) != SS_OK
        || ss_header_note(head, "integrator", req.opts.method, NULL) != SS_OK
        || ss_header_note(head, "tolerance", tol, NULL) != SS_OK)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    free(name);
    if (req.events && !has_events)
        tool_warn("the %s model has no events", ss_model_name(scene.model));
    o.contents = (ss_contents){ .signal = head, .n = ss_scene_samples(&scene),
                                .events = req.kind == TOOL_H5 ? has_events : req.events };
    simulate(&req, &scene, &o);
    begin(&o);
    tool_write_end(o.writer, o.samples);
    ss_header_free(head);
    tool_end();
    return 0;
}
