/* ss-features.c -- the transitions of a signal, one a row, and what they have in common, which is a
 * row of several signals. */
#include "jobs.h"
#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char usage[] =
"usage: ss-features [options] [FILE ...]\n"
"Find the transitions between stick and slip in one column of a signal.  Write\n"
"one row each: onset, end, spikes, local maximum of |W|, fitted oscillation; then\n"
"a summary.  Of several files, write one summary a row, then their scatter.  A\n"
"number that is absent or not known is -.\n"
"  -c, --column=NAME|N     column to analyse (a, or the only one)\n"
"      --threshold=DB      prominence that makes a local maximum (80/18)\n"
"      --norm=l2|l1        norm of the prominence, a^-1/2 or 1/a (l2)\n"
"      --fmin=HZ           lowest frequency of the map (the lowest usable one)\n"
"      --mass=KG           mass, for the oscillation's stiffness and damping\n"
"      --stiffness=N/m     stiffness of the spring, subtracted (needs --mass)\n"
"      --displacement=NAME|N, --force=NAME|N\n"
"                          columns for the slope df/dx in the stick (x and f)\n"
"      --drop=HEIGHT       transitions are falls by more than this, in a force\n"
"      --threads=N         for the transform (1)\n"
"  -j, --jobs=N            work on N files at a time (1)\n"
"      --stream            write rows as they come (needs --fmin), numbers last\n"
"      --summary           one summary a row, of one file too\n"
TOOL_READING_USAGE
"  -o, --output=FILE       .tsv .csv .json; --format=tsv|csv|json of stdout\n"
"  -q, --quiet   -v, --verbose   -h, --help   --version\n";

/* The columns of displacement and force, if none are named. */
static const char usual_displacement[] = "x", usual_force[] = "f";

typedef struct request {
    ss_features_opts opts;
    tool_reading reading;
    const char *column, *displacement, *force, *output, *needed[3];
    tool_kind kind;
    int jobs, summary, stream;
} request;

/* The column that was asked for, or else the one with this name, or -1. */
static int
find_column(const ss_header *head, const char *path, const char *asked, const char *name)
{
    return asked != NULL ? (int)tool_column(head, path, asked) : ss_header_column(head, name);
}

/* The features of one file, with its signal, column and options. */
typedef struct found {
    ss_signal *signal;
    size_t column;
    ss_features_opts opts;
    ss_features *features;
} found;

static found
find_features(const request *req, const char *path)
{
    found f = { .opts = req->opts, .signal = tool_read_signal(path, &req->reading.opts) };
    const ss_header *head = f.signal->head;
    char dimension;
    int per_time;
    f.column = tool_column(head, path, req->column);
    f.opts.displacement = find_column(head, path, req->displacement, usual_displacement);
    f.opts.force = find_column(head, path, req->force, usual_force);
    tool_check_input(ss_features_find(&f.features, f.signal, f.column, &f.opts, &tool_error), path);
    for (size_t i = 0; i < head->n_columns; i++) {      /* is the path of the load point beside a friction? */
        const ss_column *c = &head->column[i];
        if (i != f.column && strncasecmp(c->name, "load", 4) == 0
            && ss_unit_size(c->unit, &dimension, &per_time) > 0 && dimension == 'm' && per_time == 0)
            tool_warn("where the speed of %s changes, 'ss-rank --load %s --column %s' gives rate and state",
                      c->name, c->name, head->column[f.column].name);
    }
    const size_t motion = (size_t)f.opts.displacement;
    if (req->displacement != NULL && motion != f.column && isfinite(f.features->number[SS_FRICTION].value))
        tool_warn("'ss-rank --motion %s --column %s' gives the gap, stiffness and friction of either side, and the "
                  "law", head->column[motion].name, head->column[f.column].name);
    tool_note("noise of rms %.3g, local maxima: %zu, spikes: %zu, %s", f.features->noise,
              f.features->n_maxima, f.features->spikes->n, f.features->spikes->verdict);
    if (f.opts.stiffness > f.features->number[SS_TOTAL_STIFFNESS].value)
        tool_warn("the oscillation's stiffness with --mass, %.4g N/m, is below --stiffness: it "
                  "leaves none to the contact", f.features->number[SS_TOTAL_STIFFNESS].value);
    return f;
}

static int
is_stopped(double done, void *user)
{
    (void)done, (void)user;
    return tool_stopping();
}

/* Write each row when nothing behind it can change it, and the numbers at the end or when the user stops. */
static void
follow(const request *req, const char *path, tool_kind kind)
{
    ss_features_opts opts = req->opts;
    ss_reader *reader = tool_read_rows(path, &req->reading.opts);
    const ss_header *head = ss_reader_header(reader);
    size_t column = tool_column(head, path, req->column);
    opts.displacement = find_column(head, path, req->displacement, usual_displacement);
    opts.force = find_column(head, path, req->force, usual_force);
    opts.progress = (ss_progress){ is_stopped, NULL };
    tool_end_at_rows(req->output);
    tool_note("rows come at most %.3g s behind the end of a transition", 2 / opts.fmin + 0.2);
    tool_check(ss_features_follow(reader, column, &opts, tool_output(req->output), tool_stream(kind), &tool_error));
    ss_reader_free(reader);
}

typedef struct table {
    const request *req;
    char *const *path;
    FILE *rows;                 /* a summary of each file, without a name */
    size_t good;                /* files that have features */
} table;

static void
find_one(size_t i, FILE *result, void *user)
{
    const table *t = user;
    found f = find_features(t->req, t->path[i]);
    tool_check(ss_summary_write(t->path[i], f.features, f.signal, f.column, NULL, result, &tool_error));
}

static void
add_row(size_t i, FILE *result, const char *why, void *user)
{
    table *t = user;
    t->good += result != NULL;
    if (result == NULL)
        tool_check(ss_summary_write(t->path[i], NULL, NULL, 0, why, t->rows, &tool_error));
    for (int c; result != NULL && (c = getc(result)) != EOF;)
        putc(c, t->rows);
}

/* Write a row for each of n files, in their order.  Returns the number of files that have features. */
static size_t
write_table(const request *req, char *const path[], size_t n, tool_kind kind)
{
    table t = { req, path, tmpfile(), 0 };
    ss_table *all = NULL;
    if (t.rows == NULL)
        tool_die("%s", strerror(errno));
    for (size_t i = 0; i < n; i++)
        tool_reads(path[i]);
    tool_one_stdin((const char *const *)path, n);
    tool_jobs(path, n, req->jobs, find_one, add_row, &t);
    rewind(t.rows);
    tool_check(ss_table_read(&all, t.rows, "summaries", SS_KIND_SUMMARIES, &tool_error));
    tool_check(ss_summaries_write(all, tool_output(req->output), tool_stream(kind), &tool_error));
    ss_table_free(all);
    fclose(t.rows);
    return t.good;
}

int
main(int argc, char *argv[])
{
    static const char *const norms[] = { "l2", "l1", NULL };    /* in the order of ss_norm */
    const ss_range prominences = { 1e-3, 1000 }, positive = { 1e-100, 1e100 }, springs = { 0, 1e100 };
    const ss_range heights = { 1e-300, 1e300 }, jobs = { 1, TOOL_JOBS_MAX };
    static request req = { .kind = TOOL_TSV, .jobs = 1 };
    ss_features_opts_init(&req.opts, sizeof req.opts);
    const tool_option options[] = {
        TOOL_TEXT('c', "column", &req.column), TOOL_NUMBER(0, "threshold", &req.opts.threshold, prominences),
        TOOL_CHOICE(0, "norm", &req.opts.norm, norms), TOOL_NUMBER(0, "fmin", &req.opts.fmin, positive),
        TOOL_NUMBER(0, "mass", &req.opts.mass, positive),
        TOOL_NUMBER(0, "stiffness", &req.opts.stiffness, springs),
        TOOL_TEXT(0, "displacement", &req.displacement), TOOL_TEXT(0, "force", &req.force),
        TOOL_NUMBER(0, "drop", &req.opts.drop, heights), TOOL_THREADS(0, &req.opts.threads),
        TOOL_WHOLE('j', "jobs", &req.jobs, jobs), TOOL_FLAG(0, "summary", &req.summary),
        TOOL_FLAG(0, "stream", &req.stream),
        TOOL_OUTPUT(&req.output), TOOL_FORMAT_OF_WORDS(&req.kind) };

    tool_begin(argv, "ss-features", usage);
    int first = TOOL_PARSE(argc, argv, options, &req.reading);
    if (req.opts.stiffness > 0 && !(req.opts.mass > 0))
        tool_usage("--stiffness needs --mass");
    tool_reading_end(&req.reading, &req.column, req.column != NULL);
    req.needed[0] = req.column;
    req.needed[1] = req.displacement != NULL ? req.displacement : usual_displacement;
    req.needed[2] = req.force != NULL ? req.force : usual_force;
    req.reading.opts.needed = req.needed;
    req.reading.opts.n_needed = req.column != NULL ? 3 : 0;
    tool_kind kind = tool_output_kind(req.output, TOOL_WORDS, req.kind);
    req.opts.progress = (ss_progress){ tool_progress, &req };
    char *standard[] = { "-" }, **file = argc > first ? argv + first : standard;
    size_t n = argc > first ? (size_t)(argc - first) : 1, good = 1;
    if (n == 1 && !req.summary)
        req.reading.opts.progress = (ss_progress){ tool_reading_progress, &req };
    if (req.stream && (n > 1 || req.summary || !(req.opts.fmin > 0)))
        tool_usage("--stream needs --fmin, and excludes --summary and several files");
    if (req.stream)
        follow(&req, tool_input(argc, argv, first), kind);
    else if (n > 1 || req.summary)
        good = write_table(&req, file, n, kind);
    else {
        found f = find_features(&req, tool_input(argc, argv, first));
        tool_check(ss_features_write(f.features, f.signal, f.column, &f.opts, tool_output(req.output),
                                     tool_stream(kind), &tool_error));
        ss_features_free(f.features);
        ss_signal_free(f.signal);
    }
    tool_end();
    return good == 0;
}
