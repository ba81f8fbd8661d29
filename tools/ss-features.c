/* ss-features.c -- the transitions of a signal, one a row, and what they have in common, which is a
 * row of several signals. */
#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

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
"      --summary           one summary a row, of one file too\n"
TOOL_READING_USAGE
"  -o, --output=FILE       .tsv or .csv; --format=tsv|csv of standard output\n"
"  -q, --quiet   -v, --verbose   -h, --help   --version\n";

/* Each job has two files open, and so have the finished ones that wait for one before them. */
enum { JOBS_MAX = 100 };

/* The columns of displacement and force, if none are named. */
static const char usual_displacement[] = "x", usual_force[] = "f";

typedef struct request {
    ss_features_opts opts;
    tool_reading reading;
    const char *column, *displacement, *force, *output, *needed[3];
    tool_kind kind;
    int jobs, summary;
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
    ss_error err = { 0 };
    const ss_header *head = f.signal->head;
    f.column = tool_column(head, path, req->column);
    f.opts.displacement = find_column(head, path, req->displacement, usual_displacement);
    f.opts.force = find_column(head, path, req->force, usual_force);
    ss_status st = ss_features_find(&f.features, f.signal, f.column, &f.opts, &err);
    if (st != SS_OK)
        tool_die("%s: %s%s", tool_input_name(path), err.text, tool_hint(st, &err));
    tool_note("noise of rms %.3g, local maxima: %zu, spikes: %zu, %s", f.features->noise,
              f.features->n_maxima, f.features->spikes->n, ss_spikes_verdict(f.features->spikes));
    if (f.opts.stiffness > f.features->total_stiffness.value)
        tool_warn("the oscillation's stiffness with --mass, %.4g N/m, is below --stiffness: it "
                  "leaves none to the contact", f.features->total_stiffness.value);
    return f;
}

static void
free_features(found *f)
{
    ss_features_free(f->features);
    ss_signal_free(f->signal);
}

static void
write_one(const request *req, const char *path, tool_kind kind)
{
    found f = find_features(req, path);
    tool_check(ss_features_write(f.features, f.signal, f.column, &f.opts, tool_output(req->output),
                                 tool_stream(kind)), NULL);
    free_features(&f);
}

/* --- several files ------------------------------------------------------------------------- */

/* A process of its own for each file, so that a file that cannot be read ends no other.  Its summary and
 * its messages come back through files without a name. */
typedef struct job {
    pid_t pid;
    FILE *summary, *words;
    int done, status;
} job;

static void
start_job(job *j, const request *req, const char *path)
{
    j->summary = tmpfile();
    j->words = tmpfile();
    if (j->summary == NULL || j->words == NULL || (j->pid = fork()) < 0)
        tool_die("%s: no process could be started for it: %s%s", path, strerror(errno),
                 req->jobs > 1 ? "; a smaller --jobs may do" : "");
    if (j->pid > 0)
        return;
    dup2(fileno(j->words), STDERR_FILENO);
    found f = find_features(req, path);
    ss_summary summary;
    ss_summary_fill(&summary, f.features, f.signal, f.column, NULL);
    fwrite(&summary, sizeof summary, 1, j->summary);
    _exit(fflush(j->summary) != 0);
}

/* Wait until any of the jobs that have begun ends. */
static void
wait_for_job(job *jobs, size_t begun)
{
    int status;
    pid_t pid = wait(&status);
    if (pid < 0)
        tool_die("%s", strerror(errno));
    for (size_t i = 0; i < begun; i++)
        if (jobs[i].pid == pid && !jobs[i].done) {
            jobs[i].done = 1;
            jobs[i].status = status;
        }
}

/* Pass on the messages of a job.  line becomes the last of them, without the tool's name. */
static void
pass_words(job *j, char *line, int size)
{
    static const char name[] = "ss-features: ";
    rewind(j->words);
    for (int c = 0, first = 1; fgets(line, size, j->words) != NULL; first = c == '\n') {
        size_t n = strlen(line);
        c = n > 0 ? line[n - 1] : 0;
        fputs(line, stderr);
        line[strcspn(line, "\n")] = '\0';
        if (first && strncmp(line, name, strlen(name)) == 0)
            memmove(line, line + strlen(name), strlen(line + strlen(name)) + 1);
    }
    fclose(j->words);
}

/* Read the summary of a job that is done.  Returns 0 if there is none; its reason then is the error. */
static int
collect_job(job *j, ss_summary *summary)
{
    char line[sizeof summary->reason] = "";
    pass_words(j, line, sizeof line);
    rewind(j->summary);
    int whole = j->status == 0 && fread(summary, sizeof *summary, 1, j->summary) == 1;
    fclose(j->summary);
    if (!whole && WIFSIGNALED(j->status))
        snprintf(line, sizeof line, "its process was killed by signal %d", WTERMSIG(j->status));
    if (!whole)
        ss_summary_fill(summary, NULL, NULL, 0, line);
    return whole;
}

/* Write a row for each of n files, in their order, whichever is done first.  Returns the number of files
 * that have features. */
static size_t
write_table(const request *req, char *const path[], size_t n, tool_kind kind)
{
    job *jobs = calloc(n, sizeof *jobs);
    ss_summary *summary = calloc(n, sizeof *summary);
    size_t begun = 0, ended = 0, good = 0, at_once = (size_t)req->jobs;
    if (jobs == NULL || summary == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    for (size_t i = 0, standard = 0; i < n; i++) {
        standard += strcmp(tool_reads(path[i]), "-") == 0;
        if (standard > 1)
            tool_usage("standard input can be read only once");
    }
    for (size_t first = 0; first < n;) {
        while (begun < n && begun - ended < at_once && begun - first < 2 * at_once)
            start_job(&jobs[begun], req, path[begun]), begun++;
        wait_for_job(jobs, begun);
        for (ended++; first < begun && jobs[first].done; first++)
            good += (size_t)collect_job(&jobs[first], &summary[first]);
        tool_progress((double)ended / (double)n, NULL);
    }
    tool_check(ss_summaries_write((const char *const *)path, summary, n, tool_output(req->output),
                                  tool_stream(kind)), NULL);
    free(summary);
    free(jobs);
    return good;
}

int
main(int argc, char *argv[])
{
    static const char *const norms[] = { "l2", "l1", NULL };    /* in the order of ss_norm */
    const ss_range prominences = { 1e-3, 1000 }, positive = { 1e-100, 1e100 }, springs = { 0, 1e100 };
    const ss_range heights = { 1e-300, 1e300 }, jobs = { 1, JOBS_MAX };
    request req = { .opts = ss_features_defaults, .kind = TOOL_TSV, .jobs = 1 };
    const tool_option options[] = {
        TOOL_TEXT('c', "column", &req.column), TOOL_NUMBER(0, "threshold", &req.opts.threshold, prominences),
        TOOL_CHOICE(0, "norm", &req.opts.norm, norms), TOOL_NUMBER(0, "fmin", &req.opts.fmin, positive),
        TOOL_NUMBER(0, "mass", &req.opts.mass, positive),
        TOOL_NUMBER(0, "stiffness", &req.opts.stiffness, springs),
        TOOL_TEXT(0, "displacement", &req.displacement), TOOL_TEXT(0, "force", &req.force),
        TOOL_NUMBER(0, "drop", &req.opts.drop, heights), TOOL_THREADS(0, &req.opts.threads),
        TOOL_WHOLE('j', "jobs", &req.jobs, jobs), TOOL_FLAG(0, "summary", &req.summary),
        TOOL_OUTPUT(&req.output), TOOL_FORMAT_OF_WORDS(&req.kind) };

    tool_begin(argv, "ss-features", usage);
    int first = TOOL_PARSE(argc, argv, options, &req.reading);
    if (req.opts.stiffness > 0 && !(req.opts.mass > 0))
        tool_usage("--stiffness needs --mass");
    tool_reading_end(&req.reading, req.column);
    req.needed[0] = req.column;
    req.needed[1] = req.displacement != NULL ? req.displacement : usual_displacement;
    req.needed[2] = req.force != NULL ? req.force : usual_force;
    tool_reading_needs(&req.reading, req.needed, req.column != NULL ? 3 : 0);
    tool_kind kind = tool_output_kind(req.output, TOOL_WORDS, req.kind);
    req.opts.progress = (ss_progress){ tool_progress, &req };
    char *standard[] = { "-" }, **file = argc > first ? argv + first : standard;
    size_t n = argc > first ? (size_t)(argc - first) : 1, good = 1;
    if (n == 1 && !req.summary)
        req.reading.opts.progress = (ss_progress){ tool_reading_progress, &req };
    if (n > 1 || req.summary)
        good = write_table(&req, file, n, kind);
    else
        write_one(&req, tool_input(argc, argv, first), kind);
    tool_reading_free(&req.reading);
    tool_end();
    return good == 0;
}
