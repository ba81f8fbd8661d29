/* ss-cat.c -- any supported file as a signal stream. */
#include "options.h"

#include <stdlib.h>

static const char usage[] =
"usage: ss-cat [options] [FILE[:/dataset]]\n"
"Read a signal in any supported form, write it as a signal stream.\n"
"  -c, --column=NAME|N  write this column (repeatable, in order), default all\n"
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
"  -o, --output=FILE    write to FILE.tsv, .au, .csv or .h5\n"
"      --format=FORM    on standard output: tsv (default), au or csv\n"
"  -q, --quiet          no warnings\n"
"  -v, --verbose        report the input\n"
"  -h, --help           show this text and exit\n"
"      --version        show the version and exit\n";

static const char *path, *output;
static tool_texts wanted;               /* names of columns */

static void
say_header(const ss_header *head)
{
    char rate[SS_NUMBER_MAX], start[SS_NUMBER_MAX];
    ss_number_format(rate, head->rate);
    ss_number_format(start, head->start);
    tool_note("%s: %s Hz from %s s, columns: %zu", tool_input_name(path), rate, start,
              head->n_columns);
}

/* The indices of the columns asked for. */
static size_t *
choose_columns(const ss_header *head, size_t *n)
{
    *n = wanted.n > 0 ? wanted.n : head->n_columns;
    size_t *column = tool_room(NULL, *n, sizeof *column);
    for (size_t i = 0; i < *n; i++)
        column[i] = wanted.n > 0 ? tool_column(head, path, wanted.text[i]) : i;
    return column;
}

/* Copy rows as they come, in constant memory. */
static void
copy_rows(tool_kind kind, const ss_read_opts *opts)
{
    ss_reader *reader = tool_read_rows(path, opts);
    const ss_header *head = ss_reader_header(reader);
    ss_header *chosen;
    size_t n, got, all = 0, *column = choose_columns(head, &n), piece = ss_reader_piece(reader);
    double **from = tool_columns(head->n_columns, piece), **to = tool_room(NULL, n + 1, sizeof *to);
    for (size_t i = 0; i < n; i++)
        to[i] = from[column[i]];
    say_header(head);
    tool_check(ss_header_select(&chosen, head, column, n, 0, NULL), NULL);
    got = tool_rows(reader, from, piece);       /* if this fails, nothing is written */
    ss_writer *out = tool_writer(output, kind, &(ss_contents){ .signal = chosen });
    for (; got > 0; all += got, got = tool_rows(reader, from, piece))
        tool_write_rows(out, to, got);
    tool_write_end(out, all);
    ss_header_free(chosen);
    ss_reader_free(reader);
    free(column);
    free(from);
    free(to);
}

int
main(int argc, char *argv[])
{
    tool_reading reading = { .time_letter = 't', .rate_letter = 'r' };
    tool_kind kind = TOOL_TSV;
    const tool_option options[] = {
        TOOL_TEXTS('c', "column", &wanted), TOOL_OUTPUT(&output), TOOL_FORMAT(&kind) };

    tool_begin(argv, "ss-cat", usage);
    path = tool_input(argc, argv, TOOL_PARSE(argc, argv, options, &reading));
    tool_reading_end(&reading, wanted.n == 1 ? wanted.text[0] : NULL);
    tool_reading_needs(&reading, wanted.text, wanted.n);
    kind = tool_output_kind(output, TOOL_SIGNALS, kind);
    reading.opts.progress = (ss_progress){ tool_progress, output != NULL ? &reading : NULL };
    copy_rows(kind, &reading.opts);
    tool_reading_free(&reading);
    free(wanted.text);
    tool_end();
    return 0;
}
