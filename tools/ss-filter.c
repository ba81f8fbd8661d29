/* ss-filter.c -- a signal filtered, differentiated or integrated. */
#include "options.h"

#include <float.h>

static const char usage[] =
"usage: ss-filter [options] [FILE]\n"
"Filter a signal, differentiate or integrate it, without a shift in time.  Rows\n"
"at both ends that the filter cannot know are left out.\n"
"      --low-pass=HZ    pass frequencies below this edge\n"
"      --high-pass=HZ   pass frequencies above this edge\n"
"      --derivative=N   the N-th derivative in time, 1 to 4\n"
"      --integral=N     the N-fold integral in time, 1 or 2\n"
"      --stop=DB        what the stop bands are below the pass band (80)\n"
"  -c, --column=NAME|N  filter and write only this column (repeatable)\n"
"      --name=OLD=NEW   give a column this name (repeatable)\n"
TOOL_READING_USAGE
"  -o, --output=FILE    write to FILE.tsv, .au, .csv, .json, .wav or .h5\n"
"      --format=FORM    on standard output: tsv (default), au, csv, json, wav\n"
"  -q, --quiet          no warnings\n"
"  -v, --verbose        report the filter\n"
"  -h, --help           show this text and exit\n"
"      --version        show the version and exit\n";

int
main(int argc, char *argv[])
{
    const ss_range edges = { DBL_MIN, DBL_MAX }, stops = { 1, 160 }, derivatives = { 1, 4 },
        integrals = { 1, 2 };
    static tool_reading reading;
    static tool_texts wanted, names;            /* of columns; OLD=NEW */
    ss_filter_opts opts;
    const char *output = NULL;
    tool_kind kind = TOOL_TSV;
    int derivative = 0, integral = 0;
    ss_filter_opts_init(&opts, sizeof opts);
    const tool_option options[] = {
        TOOL_NUMBER(0, "low-pass", &opts.low_pass, edges), TOOL_NUMBER(0, "high-pass", &opts.high_pass, edges),
        TOOL_WHOLE(0, "derivative", &derivative, derivatives), TOOL_WHOLE(0, "integral", &integral, integrals),
        TOOL_NUMBER(0, "stop", &opts.stop, stops), TOOL_TEXTS('c', "column", &wanted), TOOL_TEXTS(0, "name", &names),
        TOOL_OUTPUT(&output), TOOL_FORMAT(&kind) };

    tool_begin(argv, "ss-filter", usage);
    const char *path = tool_input(argc, argv, TOOL_PARSE(argc, argv, options, &reading));
    if (derivative > 0 && integral > 0)
        tool_usage("--derivative and --integral exclude each other");
    opts.order = derivative - integral;
    if (opts.order == 0 && !(opts.low_pass > 0) && !(opts.high_pass > 0))
        tool_usage("one of --low-pass, --high-pass, --derivative and --integral is needed");
    tool_reading_end(&reading, wanted.text, wanted.n);
    kind = tool_output_kind(output, TOOL_SIGNALS, kind);
    reading.opts.progress = (ss_progress){ tool_progress, output != NULL ? &reading : NULL };
    ss_reader *reader = tool_read_rows(path, &reading.opts);
    ss_status st = ss_reader_filter(reader, &opts, &tool_error);
    if (st == SS_EINVAL)
        tool_usage("%s", tool_error.text);
    tool_check(st);
    tool_note("%s", ss_header_find_note(ss_reader_header(reader), "filter"));
    if (opts.order < 0 && !(opts.high_pass > 0))
        tool_warn("%s: an integral without --high-pass drifts with the mean of the signal", tool_input_name(path));
    tool_copy(reader, path, &wanted, &names, output, kind, NULL);
    tool_end();
    return 0;
}
