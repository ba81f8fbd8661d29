/* ss-cat.c -- any supported file as a signal stream. */
#include "options.h"

#include <stdlib.h>

static const char usage[] =
"usage: ss-cat [options] [FILE[:/dataset]]\n"
"Read a signal in any supported form, write it as a signal stream.\n"
"  -c, --column=NAME|N  write this column (repeatable, in order), default all\n"
"  -t, --time=NAME|N    the column of time\n"
"      --time-unit=UNIT what it counts: s, ms, us, ns, min or h\n"
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

enum { PIECE = 4096, WHOLE = 1 << 20 };      /* rows; values */

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
    size_t *column = malloc(*n * sizeof *column);
    if (column == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    for (size_t i = 0; i < *n; i++)
        column[i] = wanted.n > 0 ? tool_column(head, path, wanted.text[i]) : i;
    return column;
}

/* The columns asked for of a whole signal. */
static void
copy_whole(tool_kind kind, const ss_read_opts *opts)
{
    ss_signal *signal = tool_read_signal(path, opts), *chosen;
    size_t n, *column = choose_columns(signal->head, &n);
    say_header(signal->head);
    tool_check(ss_signal_select(&chosen, signal, column, n, 0, signal->n, NULL), NULL);
    tool_write_signal(chosen, output, kind);
    ss_signal_free(chosen);
    ss_signal_free(signal);
    free(column);
}

/* A signal that is copied piece by piece. */
typedef struct copy {
    ss_reader *reader;
    ss_header *head;            /* of the columns asked for */
    size_t *column, n, all;     /* these, of all columns */
    double *rows, *part;        /* a piece of all columns; `room` rows of those asked for */
    size_t room;
} copy;

static copy
copy_begin(const ss_read_opts *opts, size_t values)
{
    copy c = { .reader = tool_read_rows(path, opts), .room = PIECE };
    const ss_header *head = ss_reader_header(c.reader);
    c.column = choose_columns(head, &c.n);
    c.all = head->n_columns;
    while (c.room * c.n < values)
        c.room *= 2;
    c.rows = malloc(PIECE * c.all * sizeof *c.rows);
    c.part = malloc(c.room * c.n * sizeof *c.part);
    say_header(head);
    if (c.rows == NULL || c.part == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    tool_check(ss_header_select(&c.head, head, c.column, c.n, 0), NULL);
    return c;
}

/* Read rows into part, from its i-th on; 0: there are no more. */
static size_t
copy_rows(const copy *c, size_t i)
{
    ss_error err = { 0 };
    size_t got;
    tool_check(ss_reader_rows(c->reader, c->rows, PIECE, &got, &err), &err);
    for (size_t k = 0; k < got; k++)
        for (size_t j = 0; j < c->n; j++)
            c->part[(i + k) * c->n + j] = c->rows[k * c->all + c->column[j]];
    return got;
}

static void
copy_end(copy *c)
{
    ss_header_free(c->head);
    ss_reader_free(c->reader);
    free(c->column);
    free(c->rows);
    free(c->part);
}

/* Row by row, in constant memory and as they come. */
static void
copy_stream(tool_kind kind, const ss_read_opts *opts)
{
    copy c = copy_begin(opts, 0);
    ss_writer *writer;
    ss_error err = { 0 };
    size_t n = copy_rows(&c, 0);        /* before the header is written: it may fail */
    tool_check(ss_writer_new(&writer, tool_output(output), tool_stream(kind), c.head, &err), &err);
    do {
        tool_check(ss_writer_rows(writer, c.part, n), NULL);
        tool_check(ss_writer_flush(writer), NULL);
        n = copy_rows(&c, 0);
    } while (n > 0);
    ss_writer_free(writer);
    copy_end(&c);
}

/* The n rows that were read, as a signal of this length. */
static void
store_whole(const copy *c, size_t n)
{
    ss_signal *signal;
    tool_check(ss_signal_new(&signal, c->head, n), NULL);
    for (size_t j = 0; j < c->n; j++)
        for (size_t i = 0; i < n; i++)
            signal->values[j * n + i] = c->part[i * c->n + j];
    tool_write_signal(signal, output, TOOL_H5);
    ss_signal_free(signal);
}

/* The rows that were read and those that follow. */
static void
store_pieces(const copy *c, size_t n)
{
    ss_store_writer *writer;
    ss_error err = { 0 };
    size_t samples = 0;
    tool_check(ss_store_writer_new(&writer, tool_output_path(output), c->head, NULL, &err), &err);
    for (; n > 0; n = copy_rows(c, 0)) {
        tool_check(ss_store_writer_signal(writer, c->part, n, c->n, 1, &err), &err);
        samples += n;
    }
    tool_check(ss_store_writer_end(writer, samples, &err), &err);
    ss_store_writer_free(writer);
}

/* Into HDF5, a short signal as a whole and a long one piece by piece. */
static void
copy_to_store(const ss_read_opts *opts)
{
    copy c = copy_begin(opts, WHOLE);
    size_t n = 0, got = 1;
    for (; got > 0 && n + PIECE <= c.room; n += got)
        got = copy_rows(&c, n);
    if (got == 0)
        store_whole(&c, n);
    else
        store_pieces(&c, n);
    copy_end(&c);
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
    kind = tool_output_kind(output, TOOL_SIGNALS, kind);
    if (reading.opts.resample > 0)
        copy_whole(kind, &reading.opts);
    else if (kind == TOOL_H5)
        copy_to_store(&reading.opts);
    else
        copy_stream(kind, &reading.opts);
    tool_reading_free(&reading);
    free(wanted.text);
    tool_end();
    return 0;
}
