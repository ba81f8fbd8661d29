/* ss-features.c -- the transitions of a signal, one a row, and what they have in common. */
#include "common.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
"usage: ss-features [options] [FILE]\n"
"Find the transitions between stick and slip in one column of a signal.  Write a\n"
"row each: onset, end, spikes, local maximum of |W|, fitted oscillation; then a\n"
"summary.  What is not there or not known is -.\n"
"  -c, --column=NAME|N     column to look at (a, or the only one)\n"
"      --threshold=DB      prominence that makes a local maximum (80/18)\n"
"      --norm=l2|l1        in which it is taken, a^-1/2 or 1/a (l2)\n"
"      --fmin=HZ           lowest frequency of the map (the lowest usable one)\n"
"      --mass=KG           give the oscillation's stiffness and damping\n"
"      --stiffness=N/m     of the spring, to be taken off (needs --mass)\n"
"      --displacement=NAME|N, --force=NAME|N\n"
"                          columns for the slope df/dx in the stick (x and f)\n"
"      --drop=HEIGHT       transitions are falls by more than this, in a force\n"
"      --threads=N         for the transform (1)\n"
"  -o, --output=FILE       .tsv; - is standard output\n"
"  -q, --quiet             no warnings\n"
"  -v, --verbose           say what was found on the way\n"
"  -h, --help              show this text and exit\n"
"      --version           show the version and exit\n";

enum {
    OPT_THRESHOLD = TOOL_OPT_FIRST, OPT_NORM, OPT_FMIN, OPT_MASS, OPT_STIFFNESS,
    OPT_DISPLACEMENT, OPT_FORCE, OPT_DROP, OPT_THREADS
};

static const struct option longopts[] = {
    { "column", required_argument, NULL, 'c' },
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
    const char *column, *displacement, *force, *output;
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
    default:               tool_option(c);
    }
}

/* The column that was asked for, or the one of that name if it is there, else -1. */
static int
find_column(const ss_header *head, const char *path, const char *asked, const char *name)
{
    return asked != NULL ? (int)tool_column(head, path, asked) : ss_header_column(head, name);
}

/* --- output -------------------------------------------------------------------------------- */

static void
put(FILE *out, double x)
{
    char text[SS_NUMBER_MAX] = "-";
    if (isfinite(x))
        ss_number_format(text, x);
    else if (isinf(x))
        strcpy(text, "inf");
    fputs(text, out);
}

static void
put_cells(FILE *out, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        fputc('\t', out);
        put(out, x[i]);
    }
}

static void
put_transition(FILE *out, const ss_transition *tr, double start, int conclusive)
{
    const double cells[] = { start + tr->maximum.t, tr->maximum.f, tr->maximum.prominence,
                             tr->frequency.value, tr->frequency.error, tr->damping_ratio.value,
                             tr->damping_ratio.error };
    put(out, start + tr->onset);
    fputc('\t', out);
    put(out, start + tr->end);
    if (conclusive && !tr->gap)
        fprintf(out, "\t%zu", tr->spikes);
    else
        fputs("\t-", out);
    put_cells(out, cells, sizeof cells / sizeof *cells);
    fputc('\n', out);
}

static void
put_value(FILE *out, const char *key, ss_value v)
{
    fprintf(out, "# %s: ", key);
    put(out, v.value);
    fputc(' ', out);
    put(out, v.error);
    fputc('\n', out);
}

static void
put_spikes(FILE *out, const ss_spikes *found, double start)
{
    for (size_t i = 0; i < found->n; i++) {
        fputs("# spike: ", out);
        put(out, start + found->spike[i].t);
        fprintf(out, " %s %.3g %.3g\n", ss_spike_kind_name(found->spike[i].kind),
                found->spike[i].level, found->spike[i].slope);
    }
}

static int
is_smooth(const ss_spikes *found)
{
    for (size_t i = 0; i < found->n; i++)
        if (found->spike[i].kind != SS_SPIKE_BEND)
            return 0;
    return 1;
}

/* Where none is sharp, but some are there, it is not for noise. */
static const char *
say_spikes(const ss_spikes *found)
{
    if (found->conclusive)
        return "counted";
    return found->n > 0 && is_smooth(found) ? "none to count, the signal is smooth"
        : "too much noise to count them";
}

/* See find_slip_rate: three of them have a rate. */
static int
is_missing_slips(const ss_features *f)
{
    return f->n > 2 && isnan(f->slip_rate.value) && !isnan(f->forcing_frequency.value);
}

/* Why there is no frequency; NULL where there is one, or too few transitions to look for it. */
static const char *
why_no_fit(const ss_features *f)
{
    if (f->n < 3 || !isnan(f->frequency.value))
        return NULL;
    return f->recurring > 0
        ? "none: what recurs lasts under 2 periods or is no damped oscillation; try a part (ss-cat)"
        : "none: no local maximum of |W| recurs, as ringing makes them if jumps do not hide it";
}

static void
put_summary(FILE *out, const ss_features *f, const ss_features_opts *opts)
{
    fprintf(out, "# spikes: %s\n", say_spikes(f->spikes));
    if (why_no_fit(f) != NULL)
        fprintf(out, "# fit: %s\n", why_no_fit(f));
    if (is_missing_slips(f))
        fputs("# slip_rate_not_known: fewer transitions than repetitions of the signal; try --drop "
              "for a force\n", out);
    fprintf(out, "# transitions: %zu -\n# slips: %zu -\n", f->n, f->slips);
    put_value(out, "slip_rate", f->slip_rate);
    put_value(out, "forcing_frequency", f->forcing_frequency);
    put_value(out, "transition_frequency_raw", f->frequency_raw);
    put_value(out, "transition_frequency", f->frequency);
    put_value(out, "damping_ratio", f->damping_ratio);
    if (opts->mass > 0) {
        put_value(out, "total_stiffness_raw", f->total_stiffness_raw);
        put_value(out, "total_stiffness", f->total_stiffness);
        put_value(out, "contact_stiffness", f->contact_stiffness);
        put_value(out, "contact_damping", f->contact_damping);
    }
    if (opts->displacement >= 0 && opts->force >= 0)
        put_value(out, "contact_stiffness_slope", f->contact_slope);
}

static void
write_features(FILE *out, const ss_features *f, const ss_signal *signal, size_t column,
               const ss_features_opts *opts)
{
    const ss_header *head = signal->head;
    fputs("# stickslip features 1\n", out);
    for (size_t i = 0; i < head->n_notes; i++)
        if (strncmp(head->note[i], "contact_", 8) != 0)     /* a scene's own; here they are results */
            fprintf(out, "# %s\n", head->note[i]);
    fprintf(out, "# column: %s\n# threshold: ", head->column[column].name);
    put(out, opts->threshold);
    fprintf(out, "\n# norm: %s\n", opts->norm == SS_NORM_L1 ? "l1" : "l2");
    if (ss_header_find_note(head, "gaps") != NULL)
        fputs("# near_gaps: nothing is claimed: no spike within 12 scales, no event within 6, no local "
              "maximum within sqrt(2), no fit over one\n", out);
    fputs("# columns: onset/s end/s spikes time/s frequency/Hz prominence/dB transition_frequency/Hz "
          "transition_frequency_error/Hz damping_ratio damping_ratio_error\n", out);
    for (size_t i = 0; i < f->n; i++)
        put_transition(out, &f->transition[i], head->start, f->spikes->conclusive);
    put_spikes(out, f->spikes, head->start);
    put_summary(out, f, opts);
}

/* --- all of it ----------------------------------------------------------------------------- */

int
main(int argc, char *argv[])
{
    request req = { .opts = ss_features_defaults };
    ss_features *features = NULL;
    ss_error err = { "" };

    tool_begin(argv, "ss-features", usage);
    for (int c; (c = getopt_long(argc, argv, "c:o:qvh", longopts, NULL)) != -1;)
        set_option(&req, c);
    if (req.opts.stiffness > 0 && !(req.opts.mass > 0))
        tool_usage("--stiffness needs --mass");
    tool_output_kind(req.output, 1u << TOOL_TSV, TOOL_TSV);
    const char *path = tool_input(argc, argv, optind);

    ss_signal *signal = tool_read_signal(path, NULL);
    size_t column = tool_column(signal->head, path, req.column);
    req.opts.displacement = find_column(signal->head, path, req.displacement, "x");
    req.opts.force = find_column(signal->head, path, req.force, "f");
    req.opts.progress = (ss_progress){ tool_progress, &req };
    ss_status st = ss_features_find(&features, signal, column, &req.opts, &err);
    if (st != SS_OK)
        tool_die("%s: %s", tool_input_name(path), err.text);
    tool_note("noise of rms %.3g, %zu local maxima, %zu spikes, %s", features->noise,
              features->n_maxima, features->spikes->n, say_spikes(features->spikes));
    if (req.opts.stiffness > features->total_stiffness.value)
        tool_warn("the oscillation's stiffness with --mass, %.4g N/m, is below --stiffness: it "
                  "leaves none to the contact", features->total_stiffness.value);
    write_features(tool_output(req.output), features, signal, column, &req.opts);
    ss_features_free(features);
    ss_signal_free(signal);
    tool_end();
    return 0;
}
