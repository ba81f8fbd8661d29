/* ss-features.c -- the transitions of a signal, one a row, and what they have in common. */
#include "common.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
"usage: ss-features [options] [FILE]\n"
"Find the transitions between stick and slip in one column of a signal.  Write\n"
"one row each: onset, end, spikes, local maximum of |W|, fitted oscillation; then\n"
"a summary.  A number that is absent or not known is -.\n"
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
TOOL_READING_USAGE
"  -o, --output=FILE       .tsv or .csv; --format=tsv|csv of standard output\n"
"  -q, --quiet             no warnings\n"
"  -v, --verbose           report intermediate results\n"
"  -h, --help              show this text and exit\n"
"      --version           show the version and exit\n";

enum {
    OPT_THRESHOLD = TOOL_OPT_FIRST, OPT_NORM, OPT_FMIN, OPT_MASS, OPT_STIFFNESS,
    OPT_DISPLACEMENT, OPT_FORCE, OPT_DROP, OPT_THREADS
};

static const struct option longopts[] = {
    { "column", required_argument, NULL, 'c' }, TOOL_READING_LONGOPTS,
    { "format", required_argument, NULL, TOOL_OPT_FORMAT },
    { "threshold", required_argument, NULL, OPT_THRESHOLD },
    { "norm", required_argument, NULL, OPT_NORM },
    { "fmin", required_argument, NULL, OPT_FMIN },
    { "mass", required_argument, NULL, OPT_MASS },
    { "stiffness", required_argument, NULL, OPT_STIFFNESS },
    { "displacement", required_argument, NULL, OPT_DISPLACEMENT },
    { "force", required_argument, NULL, OPT_FORCE },
    { "drop", required_argument, NULL, OPT_DROP },
    { "threads", required_argument, NULL, OPT_THREADS },
    TOOL_LONGOPTS
};

typedef struct request {
    ss_features_opts opts;
    tool_reading reading;
    const char *column, *displacement, *force, *output;
    tool_kind kind;
} request;

static void
set_option(request *req, int c)
{
    static const char *const norms[] = { "l2", "l1", NULL };    /* as in ss_norm */
    ss_features_opts *opts = &req->opts;
    switch (c) {
    case 'c':              req->column = optarg; break;
    case OPT_THRESHOLD:    opts->threshold = tool_number("--threshold", optarg, 1e-3, 1000); break;
    case OPT_NORM:         opts->norm = (ss_norm)tool_choice("--norm", optarg, norms); break;
    case OPT_FMIN:         opts->fmin = tool_number("--fmin", optarg, 1e-100, 1e100); break;
    case OPT_MASS:         opts->mass = tool_number("--mass", optarg, 1e-100, 1e100); break;
    case OPT_STIFFNESS:    opts->stiffness = tool_number("--stiffness", optarg, 0, 1e100); break;
    case OPT_DISPLACEMENT: req->displacement = optarg; break;
    case OPT_FORCE:        req->force = optarg; break;
    case OPT_DROP:         opts->drop = tool_number("--drop", optarg, 1e-300, 1e300); break;
    case OPT_THREADS:      opts->threads = (int)tool_integer("--threads", optarg, 1, SS_THREADS_MAX);
                           break;
    case 'o':              req->output = optarg; break;
    case TOOL_OPT_FORMAT:  req->kind = tool_format_of_words(optarg); break;
    default:
        if (!tool_reading_option(&req->reading, c, optarg))
            tool_option(c);
    }
}

/* The column that was asked for, or the one of that name if it is there, else -1. */
static int
find_column(const ss_header *head, const char *path, const char *asked, const char *name)
{
    return asked != NULL ? (int)tool_column(head, path, asked) : ss_header_column(head, name);
}

int
main(int argc, char *argv[])
{
    request req = { .opts = ss_features_defaults, .kind = TOOL_TSV };
    ss_features *features = NULL;
    ss_error err = { 0 };

    tool_begin(argv, "ss-features", usage);
    tool_reading_begin(&req.reading, argc);
    for (int c; (c = getopt_long(argc, argv, "c:o:qvh", longopts, NULL)) != -1;)
        set_option(&req, c);
    if (req.opts.stiffness > 0 && !(req.opts.mass > 0))
        tool_usage("--stiffness needs --mass");
    tool_reading_end(&req.reading, req.column);
    tool_kind kind = tool_output_kind(req.output, TOOL_WORDS, req.kind);
    const char *path = tool_input(argc, argv, optind);

    ss_signal *signal = tool_read_signal(path, &req.reading.opts);
    size_t column = tool_column(signal->head, path, req.column);
    req.opts.displacement = find_column(signal->head, path, req.displacement, "x");
    req.opts.force = find_column(signal->head, path, req.force, "f");
    req.opts.progress = (ss_progress){ tool_progress, &req };
    ss_status st = ss_features_find(&features, signal, column, &req.opts, &err);
    if (st != SS_OK)
        tool_die("%s: %s%s", tool_input_name(path), err.text, tool_hint(st, &err));
    tool_note("noise of rms %.3g, %zu local maxima, %zu spikes, %s", features->noise,
              features->n_maxima, features->spikes->n, ss_spikes_verdict(features->spikes));
    if (req.opts.stiffness > features->total_stiffness.value)
        tool_warn("the oscillation's stiffness with --mass, %.4g N/m, is below --stiffness: it "
                  "leaves none to the contact", features->total_stiffness.value);
    tool_check(ss_features_write(features, signal, column, &req.opts, tool_output(req.output),
                                 tool_stream(kind)), NULL);
    ss_features_free(features);
    ss_signal_free(signal);
    tool_reading_free(&req.reading);
    tool_end();
    return 0;
}
