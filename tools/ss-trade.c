/* ss-trade -- what accuracy costs on a scene, method by method, measured here and now. */
#include <float.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>
#include "common.h"

static const char usage[] =
"usage: ss-trade [options] SCENE\n"
"Run a scene with every method at tolerances 1e-2 ... 1e-13, here and now, and\n"
"write one row each: errors, events lost, cost, and whether nothing else is both\n"
"faster and more accurate.  SCENE is a file, - for standard input, or the name of\n"
"a shipped scene.\n"
"  -s, --set KEY=VALUE   put VALUE in place of the scene's own (repeatable)\n"
"  -b, --budget S        CPU time of a row at most [s] (default 10); a longer one\n"
"                        has its estimated time and no errors\n"
"  -t, --target TOL      write instead the options of ss-sim that are the fastest\n"
"                        to keep x within TOL x max|x|\n"
"  -o, --output FILE     .tsv, or the work-precision diagram as .gp, .png, .svg\n"
"                        or .pdf (default: rows on standard output)\n"
"  -q, --quiet           no progress; -v, --verbose: what was measured\n"
"  -h, --help            show this text; --version: show the version\n";

static void
put(FILE *out, double x, const char *behind)
{
    char text[SS_NUMBER_MAX];
    snprintf(text, sizeof text, "%.3g", x);     /* three digits of a measurement are plenty */
    fprintf(out, "%s%s", text, behind);
}

static void
write_row(FILE *out, const ss_trade_row *row, double fastest)
{
    fprintf(out, "%s\t", row->method);
    if (row->tol > 0)
        put(out, row->tol, "\t");
    else
        fputs("-\t", out);
    if (row->status == SS_OK) {
        put(out, row->error_x, "\t");
        put(out, row->error_a, "\t");
        put(out, row->error_t, "\t");
        fprintf(out, "%zu\t%zu\t%lu\t%lu\t", row->missed, row->invented, row->rhs, row->steps);
    } else {
        fputs("-\t-\t-\t-\t-\t-\t-\t", out);
    }
    if (row->status == SS_OK || row->status == SS_EBUDGET)
        put(out, row->seconds / fastest, "\t");
    else
        fputs("-\t", out);
    fprintf(out, "%d\t%s\n", row->frontier, row->status == SS_OK ? "measured"
            : row->status == SS_EBUDGET ? "estimated" : "refused");
}

static void
write_rows(FILE *out, const ss_trade *trade, const char *scene)
{
    double fastest = DBL_MAX;
    for (size_t i = 0; i < trade->n; i++)
        if (trade->row[i].status == SS_OK && trade->row[i].seconds < fastest)
            fastest = trade->row[i].seconds;
    fprintf(out, "# stickslip trade 1\n# scene: %s\n# reference: %s\n", scene, trade->reference);
    fprintf(out, "# compared: %zu samples, %zu events\n", trade->samples, trade->events);
    fputs("# known: x ", out);
    put(out, trade->known_x, ", a ");
    put(out, trade->known_a, ", t ");
    put(out, trade->known_t, " s\n# fastest: ");
    put(out, fastest, " s\n");
    fputs("# columns: method tol x_error a_error event_error/s missed invented rhs steps time "
          "frontier state\n", out);
    for (size_t i = 0; i < trade->n; i++)
        write_row(out, &trade->row[i], fastest);
}

static void
write_options(FILE *out, const ss_trade *trade, double target)
{
    const ss_trade_row *row = ss_trade_cheapest(trade, target);
    char tol[SS_NUMBER_MAX];
    if (row == NULL)
        tool_die("no method was seen to keep x within %g of its maximum", target);
    fprintf(out, "--method %s", row->method);
    if (row->tol > 0) {
        ss_number_format(tol, row->tol);
        fprintf(out, " --tol %s", tol);
    }
    fputc('\n', out);
}

static ss_status
write_script(FILE *out, const ss_plot_opts *opts, void *user, ss_error *err)
{
    return ss_plot_trade(out, user, opts, err);
}

int
main(int argc, char *argv[])
{
    static const struct option longopts[] = {
        { "set", required_argument, NULL, 's' }, { "budget", required_argument, NULL, 'b' },
        { "target", required_argument, NULL, 't' }, TOOL_LONGOPTS };
    const char **settings = calloc((size_t)argc, sizeof *settings), *output = NULL;
    size_t n_settings = 0;
    ss_trade_opts opts = ss_trade_defaults;
    ss_plot_opts plot = ss_plot_defaults;
    ss_trade *trade = NULL;
    ss_error err = { "" };

    tool_begin(argv, "ss-trade", usage);
    if (settings == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    for (int c; (c = getopt_long(argc, argv, "s:b:t:o:qvh", longopts, NULL)) != -1;)
        switch (c) {
        case 's': settings[n_settings++] = optarg; break;
        case 'b': opts.budget = tool_number("--budget", optarg, 1e-6, DBL_MAX); break;
        case 't': opts.target = tool_number("--target", optarg, 1e-14, 1); break;
        case 'o': output = optarg; break;
        default: tool_option(c);
        }
    if (optind == argc)
        tool_usage("which scene? give a file, or a shipped one by its name");
    if (optind + 1 != argc)
        tool_usage("unexpected argument '%s'", argv[optind + 1]);
    tool_kind kind = tool_output_kind(output, 1u << TOOL_TSV | TOOL_PICTURES, TOOL_TSV);
    if (opts.target > 0 && kind != TOOL_TSV)
        tool_usage("--target writes options, not a picture");

    ss_scene scene = tool_read_scene(argv[optind], settings, n_settings);
    char name[256];
    tool_name_scene(name, sizeof name, argv[optind], settings, n_settings);
    opts.progress = tool_progress;
    tool_check(ss_trade_measure(&trade, &scene, &opts, &err), &err);
    tool_note("%zu rows against %s, which knows x within %.2g of its maximum", trade->n,
              trade->reference, trade->known_x);
    plot.title = name;
    if (kind != TOOL_TSV)
        tool_draw(output, &plot, write_script, trade);
    else if (opts.target > 0)
        write_options(tool_output(output), trade, opts.target);
    else
        write_rows(tool_output(output), trade, name);
    ss_trade_free(trade);
    free(settings);
    tool_end();
    return 0;
}
