/* ss-cat.c -- any supported file as a signal stream. */
#include "options.h"

static const char usage[] =
"usage: ss-cat [options] [FILE[:/dataset]]\n"
"Read a signal in any supported form, write it as a signal stream.\n"
"  -c, --column=NAME|N  write this column (repeatable, in order), default all\n"
"      --name=OLD=NEW   give a column this name (repeatable)\n"
"  -t, --time=NAME|N    the column of time\n"
"      --time-unit=UNIT what it counts: s, ms, us, ns, min, h or d\n"
"  -r, --rate=HZ        the sample rate of input without a clock\n"
"      --table=N        of a file with several tables, this one\n"
"      --gaps=HOW       missing samples: refuse (default), split (write 0),\n"
"                       interpolate (linearly)\n"
"      --resample=HZ    resample to this rate; time stamps may be uneven\n"
"      --from=S         from this time on the source's clock [s]\n"
"      --to=S           up to this time, excluded [s]\n"
"      --scale=[NAME=]F, --unit=[NAME=]U\n"
"                       multiply a column, name its unit (repeatable)\n"
"  -o, --output=FILE    write to FILE.tsv, .au, .csv, .json, .wav or .h5\n"
"      --format=FORM    on standard output: tsv (default), au, csv, json, wav\n"
"  -q, --quiet          no warnings\n"
"  -v, --verbose        report the input\n"
"  -h, --help           show this text and exit\n"
"      --version        show the version and exit\n";

int
main(int argc, char *argv[])
{
    static tool_reading reading = { .time_letter = 't', .rate_letter = 'r' };
    static tool_texts wanted, names;            /* of columns; OLD=NEW */
    const char *output = NULL;
    char rate[SS_NUMBER_MAX], start[SS_NUMBER_MAX];
    tool_kind kind = TOOL_TSV;
    const tool_option options[] = {
        TOOL_TEXTS('c', "column", &wanted), TOOL_TEXTS(0, "name", &names), TOOL_OUTPUT(&output), TOOL_FORMAT(&kind) };

    tool_begin(argv, "ss-cat", usage);
    const char *path = tool_input(argc, argv, TOOL_PARSE(argc, argv, options, &reading));
    tool_reading_end(&reading, wanted.text, wanted.n);
    kind = tool_output_kind(output, TOOL_SIGNALS, kind);
    reading.opts.progress = (ss_progress){ tool_progress, output != NULL ? &reading : NULL };
    ss_reader *reader = tool_read_rows(path, &reading.opts);
    const ss_header *head = ss_reader_header(reader);
    ss_number_format(rate, head->rate);
    ss_number_format(start, head->start);
    tool_note("%s: %s Hz from %s s, columns: %zu", tool_input_name(path), rate, start, head->n_columns);
    tool_copy(reader, path, &wanted, &names, output, kind, NULL);
    tool_end();
    return 0;
}
