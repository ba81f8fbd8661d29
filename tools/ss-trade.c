/* ss-trade -- what accuracy costs on a scene, or in the transform of a signal, method by method, and
 * what a simpler scene costs in accuracy, measured on this machine. */
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "options.h"

static const char usage[] =
"usage: ss-trade [options] SCENE|SIGNAL\n"
"Simulate a scene with every method at tolerances 1e-2 ... 1e-13, or transform a\n"
"signal, on this machine, and write one row each: errors, cost, and whether no\n"
"other row is both faster and more accurate.  A file whose first line that is not\n"
"a comment is KEY = VALUE is a scene, and so is the name of a shipped one;\n"
"- is standard input.\n"
"  -s, --set=KEY=VALUE   replace a value of the scene (repeatable)\n"
"  -c, --column=NAME|N   column of the signal (a, or the only one)\n"
"      --dense           one coefficient a sample at every scale\n"
"  -b, --budget=S        at most this CPU time a row [s] (default 10); a longer\n"
"                        row has an estimated time and no errors\n"
"  -t, --target=TOL      write the fastest options of ss-sim, or of ss-morlet,\n"
"                        that keep x, or W, within TOL\n"
TOOL_READING_USAGE
"  -m, --models          the scene beside each simpler one that it contains:\n"
"                        errors of x, v, a, f, of the contours, of the features\n"
"  -n, --need=LIST       the cheapest that keeps a list of NAME=ERROR, such as\n"
"                        x=1%,a=0.1,map=3dB,microslips, in one sentence\n"
"  -o, --output=FILE     .tsv .csv .json, or a picture of error over time as .gp,\n"
"                        .png, .svg, .pdf, .eps; --format=tsv|csv|json\n"
"  -q, --quiet           no progress; -v, --verbose: report the measurement\n"
"  -h, --help            show this text; --version: show the version\n";

static void
write_options(FILE *out, const ss_trade *trade, double target)
{
    const ss_trade_row *row = ss_trade_cheapest(trade, target);
    char tol[SS_NUMBER_MAX];
    if (row == NULL)
        tool_die("no method kept %s within %g of its maximum",
                 trade->transform ? "W" : "x", target);
    fprintf(out, "--method %s", row->method);
    if (row->tol > 0) {
        ss_number_format(tol, row->tol);
        fprintf(out, " --tol %s", tol);
    }
    fputc('\n', out);
}

/* The request of the command line. */
typedef struct request {
    const char *column, *output, *path;
    tool_texts settings;
    tool_reading reading;
    tool_kind kind;
    int dense, models;
    ss_need need[SS_COMPARED_MOST];
    size_t n_needs;
    ss_trade_opts opts;
    char *name;
} request;

/* Copy standard input to a file if it cannot be read twice. */
static void
keep_input(void)
{
    FILE *copy = lseek(STDIN_FILENO, 0, SEEK_CUR) < 0 ? tmpfile() : NULL;
    char part[65536];
    if (copy == NULL)
        return;
    for (size_t n; (n = fread(part, 1, sizeof part, stdin)) > 0;)
        if (fwrite(part, 1, n, copy) != n)
            tool_die("<stdin>: cannot be kept in a temporary file");
    if (ferror(stdin) || fflush(copy) != 0 || dup2(fileno(copy), STDIN_FILENO) < 0
        || fseek(stdin, 0, SEEK_SET) != 0)
        tool_die("<stdin>: cannot be read");
    fclose(copy);
}

/* 1 if the first line that is neither empty nor a comment begins with a name and an equals sign. */
static int
reads_as_scene(FILE *in)
{
    char line[4096], first[2], equals[2];
    while (fgets(line, sizeof line, in) != NULL) {
        if (strncmp(line, "# stickslip signal", 18) == 0)
            return 0;
        if (sscanf(line, " %1[^#]", first) == 1)
            return sscanf(line, " %*[A-Za-z0-9_] %1[=]", equals) == 1;
    }
    return 1;       /* the reader of scenes has the best message for an empty file */
}

static int
is_scene(const char *path)
{
    int standard = strcmp(path, "-") == 0, scene;
    if (!standard && access(path, F_OK) != 0 && strstr(path, ":/") != NULL)
        return 0;               /* a dataset in HDF5 */
    if (standard)
        keep_input();
    FILE *in = standard ? stdin : fopen(tool_reads(path), "rb");
    if (in == NULL)
        return 1;               /* shipped, or a wrong name, which the reader of scenes reports */
    scene = reads_as_scene(in);
    if (!standard)
        fclose(in);
    else if (fseek(in, 0, SEEK_SET) != 0)
        tool_die("<stdin>: cannot be read twice");
    return scene;
}

static ss_trade *
measure_scene(request *req)
{
    ss_trade *trade = NULL;
    if (req->column != NULL || req->dense || req->reading.given)
        tool_usage("--column, --dense and options of reading are for a signal, and %s is a scene", req->path);
    ss_scene scene = tool_read_scene(req->path, &req->settings, "--set");
    req->name = tool_name_scene(req->path, &req->settings);
    tool_check(ss_trade_measure(&trade, &scene, &req->opts, &tool_error));
    tool_note("%zu row%s against %s, whose x is known within %.2g of its maximum", trade->n,
              tool_s(trade->n), trade->reference, trade->known_x);
    return trade;
}

static ss_trade *
measure_signal(request *req)
{
    ss_trade *trade = NULL;
    ss_morlet_opts grid;
    ss_morlet_opts_init(&grid, sizeof grid);
    if (req->settings.n > 0)
        tool_usage("--set is for a scene, and %s is a signal", tool_input_name(req->path));
    ss_signal *signal = tool_read_signal(req->path, &req->reading.opts);
    size_t column = tool_column(signal->head, req->path, req->column);
    req->name = tool_name_scene(req->path, NULL);
    grid.dense = req->dense;
    tool_check(ss_trade_transform(&trade, signal->values + column * signal->n, signal->n,
                                  signal->head->rate, &grid, &req->opts, &tool_error));
    tool_note("%zu row%s, coefficients of each that are compared: %zu", trade->n,
              tool_s(trade->n), trade->samples);
    ss_signal_free(signal);
    return trade;
}

static void
set_needs(const tool_option *o, char *list)
{
    request *req = o->to;
    req->models = 1;
    if (ss_needs_parse(req->need, &req->n_needs, list, &tool_error) != SS_OK)
        tool_usage("--need: %s", tool_error.text);
}

static void
compare_models(request *req, tool_kind kind, ss_plot_opts *plot)
{
    ss_models *models = NULL;
    ss_scene scene = tool_read_scene(req->path, &req->settings, "--set");
    req->name = tool_name_scene(req->path, &req->settings);
    plot->title = strcmp(req->name, tool_input_name("-")) == 0 ? NULL : req->name;
    tool_check(ss_models_measure(&models, &scene, &req->opts, &tool_error));
    tool_note("%zu scene%s, samples of each that are compared: %zu", models->n, tool_s(models->n),
              models->samples);
    if (kind < TOOL_STREAM) {
        FILE *script = tool_draw(req->output, plot);
        tool_drawn(script, ss_plot_models(script, models, plot, &tool_error));
    } else if (req->n_needs > 0 && req->output == NULL) {
        char *sentence;
        FILE *out = tool_output(NULL);
        tool_check(ss_models_answer(&sentence, models, req->need, req->n_needs, &tool_error));
        fprintf(out, "%s\n", sentence);
        free(sentence);
    } else
        tool_check(ss_models_write(models, req->name, req->need, req->n_needs, tool_output(req->output),
                                   tool_stream(kind), &tool_error));
    ss_models_free(models);
}

static void
trade_accuracy(request *req, tool_kind kind, ss_plot_opts *plot)
{
    ss_trade *trade = is_scene(req->path) ? measure_scene(req) : measure_signal(req);
    plot->title = strcmp(req->name, tool_input_name("-")) == 0 ? NULL : req->name;
    if (kind < TOOL_STREAM) {
        FILE *script = tool_draw(req->output, plot);
        tool_drawn(script, ss_plot_trade(script, trade, plot, &tool_error));
    } else if (req->opts.target > 0)
        write_options(tool_output(req->output), trade, req->opts.target);
    else
        tool_check(ss_trade_write(trade, req->name, tool_output(req->output), tool_stream(kind), &tool_error));
    ss_trade_free(trade);
}

int
main(int argc, char *argv[])
{
    const ss_range budgets = { 1e-6, DBL_MAX }, targets = { 1e-14, 1 };
    static request req = { .kind = TOOL_TSV };
    ss_plot_opts plot;
    ss_trade_opts_init(&req.opts, sizeof req.opts);
    ss_plot_opts_init(&plot, sizeof plot);
    const tool_option options[] = {
        TOOL_TEXTS('s', "set", &req.settings), TOOL_TEXT('c', "column", &req.column),
        TOOL_FLAG(0, "dense", &req.dense), TOOL_NUMBER('b', "budget", &req.opts.budget, budgets),
        TOOL_NUMBER('t', "target", &req.opts.target, targets), TOOL_FLAG('m', "models", &req.models),
        TOOL_VALUE('n', "need", set_needs, &req), TOOL_OUTPUT(&req.output),
        TOOL_FORMAT_OF_WORDS(&req.kind) };

    tool_begin(argv, "ss-trade", usage);
    int first = TOOL_PARSE(argc, argv, options, &req.reading);
    tool_reading_end(&req.reading, &req.column, req.column != NULL);
    if (first == argc)
        tool_usage("SCENE or SIGNAL is missing: give a file, or the name of a shipped scene");
    if (first + 1 != argc)
        tool_usage("unexpected argument '%s'; -o FILE names the output", argv[first + 1]);
    tool_kind kind = tool_output_kind(req.output, TOOL_WORDS | TOOL_PICTURES, req.kind);
    if (req.opts.target > 0 && kind < TOOL_STREAM)
        tool_usage("--target writes options, not a picture");
    if (req.models && (req.opts.target > 0 || req.column != NULL || req.dense))
        tool_usage("--models compares scenes, and --target, --column and --dense are for methods");
    if (req.n_needs > 0 && kind < TOOL_STREAM)
        tool_usage("--need writes an answer, not a picture");

    req.path = argv[first];
    req.opts.progress = (ss_progress){ tool_progress, &req };
    if (req.models)
        compare_models(&req, kind, &plot);
    else
        trade_accuracy(&req, kind, &plot);
    tool_end();
    return 0;
}
