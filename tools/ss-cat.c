/* ss-cat.c -- any supported file as a signal stream. */
#include "common.h"

#include <float.h>
#include <getopt.h>
#include <stdlib.h>

static const char usage[] =
"usage: ss-cat [options] [FILE[:/dataset]]\n"
"Read a signal in any supported form, write it as a signal stream.\n"
"  -c, --column=NAME|N  write this column (repeatable, in order), default all\n"
"  -t, --time=NAME|N    delimited text: the column of time\n"
"  -r, --rate=HZ        the sample rate of input without a clock\n"
"      --gaps=HOW       missing samples: refuse (default), split (write 0),\n"
"                       interpolate (linearly)\n"
"      --resample=HZ    resample to this rate; time stamps may be uneven\n"
"      --from=S         from this time on the source's clock [s]\n"
"      --to=S           up to this time, excluded [s]\n"
"  -o, --output=FILE    write to FILE.tsv, FILE.au or FILE.h5\n"
"      --format=FORM    on standard output: tsv (default) or au\n"
"  -q, --quiet          no warnings\n"
"  -v, --verbose        report the input\n"
"  -h, --help           show this text and exit\n"
"      --version        show the version and exit\n";

enum { OPT_FROM = TOOL_OPT_FIRST, OPT_TO, OPT_GAPS, OPT_RESAMPLE, PIECE = 4096 };

static const char *path, *output;
static const char **wanted;             /* names of columns */
static size_t n_wanted;
static double from = -DBL_MAX, to = DBL_MAX;

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
    *n = n_wanted > 0 ? n_wanted : head->n_columns;
    size_t *column = malloc(*n * sizeof *column);
    if (column == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    for (size_t i = 0; i < *n; i++)
        column[i] = n_wanted > 0 ? tool_column(head, path, wanted[i]) : i;
    return column;
}

static void
need_rows(size_t n)
{
    if (n == 0 && (from > -DBL_MAX || to < DBL_MAX))
        tool_die("%s: no samples between --from and --to", tool_input_name(path));
}

/* The rows asked for of a whole signal: HDF5 is not read or written piece by piece. */
static void
copy_whole(tool_kind kind, const ss_read_opts *opts)
{
    ss_signal *signal = tool_read_signal(path, opts), *chosen;
    ss_error err = { 0 };
    if (opts->resample > 0 && (signal->head->rate < opts->resample
                               || signal->head->rate > opts->resample)) {
        if (signal->n < 2)
            tool_die("%s: one row cannot be resampled", tool_input_name(path));
        if (signal->head->rate > opts->resample)
            tool_warn("%s: frequencies above %g Hz fold down", tool_input_name(path),
                      opts->resample / 2);
        tool_check(ss_signal_resample(&chosen, signal, opts->resample, &err), &err);
        ss_signal_free(signal);
        signal = chosen;
    }
    size_t n, *column = choose_columns(signal->head, &n);
    size_t first = ss_header_row(signal->head, from), end = ss_header_row(signal->head, to);
    end = end < signal->n ? end : signal->n;
    first = first < end ? first : end;
    say_header(signal->head);
    need_rows(end - first);
    tool_check(ss_signal_select(&chosen, signal, column, n, first, end, NULL), NULL);
    tool_write_signal(chosen, output, kind);
    ss_signal_free(chosen);
    ss_signal_free(signal);
    free(column);
}

/* Row by row, in constant memory and as they come. */
static void
copy_stream(tool_kind kind, const ss_read_opts *opts)
{
    ss_reader *reader;
    ss_writer *writer;
    ss_header *chosen;
    ss_error err = { 0 };
    size_t n, got, row = 0, written = 0;
    FILE *in = tool_open(path);
    tool_check(ss_reader_new(&reader, in, tool_input_name(path), opts, &err), &err);
    const ss_header *head = ss_reader_header(reader);
    size_t *column = choose_columns(head, &n), all = head->n_columns;
    size_t first = ss_header_row(head, from), end = ss_header_row(head, to);
    double *rows = malloc(PIECE * all * sizeof *rows), *part = malloc(PIECE * n * sizeof *part);
    say_header(head);
    if (rows == NULL || part == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    tool_check(ss_header_select(&chosen, head, column, n, first), NULL);
    ss_status st = ss_writer_new(&writer, tool_output(output), tool_stream(kind),
                                 chosen, &err);
    tool_check(st, &err);
    while (row < end) {
        size_t kept = 0;
        tool_check(ss_reader_rows(reader, rows, PIECE, &got, &err), &err);
        if (got == 0)
            break;
        for (size_t i = 0; i < got; i++, row++)
            for (size_t c = 0; row >= first && row < end && c < n; c++)
                part[kept++] = rows[i * all + column[c]];
        tool_check(ss_writer_rows(writer, part, kept / n), NULL);
        tool_check(ss_writer_flush(writer), NULL);
        written += kept / n;
    }
    need_rows(written);
    ss_writer_free(writer);
    ss_header_free(chosen);
    ss_reader_free(reader);
    free(column);
    free(rows);
    free(part);
}

int
main(int argc, char *argv[])
{
    static const struct option longopts[] = {
        { "column", required_argument, NULL, 'c' }, { "time", required_argument, NULL, 't' },
        { "rate", required_argument, NULL, 'r' }, { "from", required_argument, NULL, OPT_FROM },
        { "to", required_argument, NULL, OPT_TO }, { "gaps", required_argument, NULL, OPT_GAPS },
        { "resample", required_argument, NULL, OPT_RESAMPLE },
        { "format", required_argument, NULL, TOOL_OPT_FORMAT }, TOOL_LONGOPTS };
    static const char *const gaps[] = { "refuse", "split", "interpolate", NULL };
    ss_read_opts opts = { .rate = 0 };
    tool_kind kind = TOOL_TSV;

    tool_begin(argv, "ss-cat", usage);
    wanted = malloc((size_t)argc * sizeof *wanted);
    if (wanted == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    for (int c; (c = getopt_long(argc, argv, "c:t:r:o:qvh", longopts, NULL)) != -1;)
        switch (c) {
        case 'c': wanted[n_wanted++] = optarg; break;
        case 't': opts.time = optarg; break;
        case 'r': opts.rate = tool_number("--rate", optarg, DBL_MIN, DBL_MAX); break;
        case OPT_FROM: from = tool_number("--from", optarg, -DBL_MAX, DBL_MAX); break;
        case OPT_TO: to = tool_number("--to", optarg, -DBL_MAX, DBL_MAX); break;
        case OPT_GAPS: opts.gaps = (ss_gaps)tool_choice("--gaps", optarg, gaps); break;
        case OPT_RESAMPLE: opts.resample = tool_number("--resample", optarg, DBL_MIN, DBL_MAX); break;
        case 'o': output = optarg; break;
        case TOOL_OPT_FORMAT: kind = tool_format(optarg); break;
        default: tool_option(c);
        }
    path = tool_input(argc, argv, optind);
    if (opts.time != NULL && opts.rate > 0)
        tool_usage("--time and --rate exclude each other");
    if (from >= to)
        tool_usage("--from does not lie before --to");
    kind = tool_output_kind(output, TOOL_SIGNALS, kind);
    if (kind == TOOL_H5 || tool_is_hdf5(path) || opts.resample > 0)
        copy_whole(kind, &opts);
    else
        copy_stream(kind, &opts);
    free(wanted);
    tool_end();
    return 0;
}
