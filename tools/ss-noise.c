/* ss-noise.c -- a signal with white noise added. */
#include "common.h"

#include <float.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>

static const char usage[] =
"usage: ss-noise [options] --snr=DB|--rms=VALUE [FILE]\n"
"Add Gaussian white noise to a signal; write it to standard output.\n"
"      --snr=DB         noise this far below the variance of each column [dB]\n"
"      --rms=VALUE      noise of this standard deviation, in each column's unit\n"
"      --seed=N         of the generator, default 1\n"
"  -c, --column=NAME|N  only this column (repeatable), default all\n"
"  -o, --output=FILE    write to FILE.tsv, FILE.au or FILE.h5\n"
"      --format=FORM    on standard output: tsv (default) or au\n"
"  -q, --quiet          no warnings\n"
"  -v, --verbose        say how much noise was added\n"
"  -h, --help           show this text and exit\n"
"      --version        show the version and exit\n";

enum { OPT_SNR = TOOL_OPT_FIRST, OPT_RMS, OPT_SEED, PIECE = 4096 };

static const char *path, *output;
static const char **wanted;             /* names of columns */
static size_t n_wanted;
static double snr = NAN, rms = NAN;
static long seed = 1;

/* The noise of each column, 0 where there is to be none: for --snr all 1 at first. */
static double *
choose_columns(const ss_header *head)
{
    double *level = calloc(head->n_columns, sizeof *level), each = isnan(rms) ? 1 : rms;
    if (level == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    for (size_t c = 0; c < head->n_columns && n_wanted == 0; c++)
        level[c] = each;
    for (size_t i = 0; i < n_wanted; i++)
        level[tool_column(head, path, wanted[i])] = each;
    return level;
}

static void
add_note(ss_header *head)
{
    char text[128], number[SS_NUMBER_MAX];
    ss_number_format(number, isnan(rms) ? snr : rms);
    snprintf(text, sizeof text, "%s %s%s, seed %ld", isnan(rms) ? "snr" : "rms", number,
             isnan(rms) ? " dB" : "", seed);
    tool_check(ss_header_note(head, "noise", text), NULL);
}

/* The variance is known only from the whole record. */
static void
noise_whole(tool_kind kind, ss_noise *noise)
{
    ss_signal *signal = tool_read_signal(path, NULL);
    size_t n = signal->n, columns = signal->head->n_columns;
    double *level = choose_columns(signal->head);
    for (size_t c = 0; c < columns; c++) {
        double *x = signal->values + c * n;
        if (level[c] == 0)
            continue;
        if (isnan(rms))
            level[c] = ss_noise_rms(x, n, snr);
        if (level[c] == 0)
            tool_warn("%s: column %s is constant: no noise added", tool_input_name(path),
                      signal->head->column[c].name);
        tool_note("column %s: noise of rms %g", signal->head->column[c].name, level[c]);
    }
    ss_noise_add(noise, signal->values, n, 1, columns, n, level);
    add_note(signal->head);
    tool_write_signal(signal, output, kind);
    ss_signal_free(signal);
    free(level);
}

/* Row by row, in constant memory and as they come. */
static void
noise_stream(tool_kind kind, ss_noise *noise)
{
    ss_reader *reader;
    ss_writer *writer;
    ss_error err = { "" };
    size_t n;
    FILE *in = tool_open(path);
    tool_check(ss_reader_new(&reader, in, tool_input_name(path), NULL, &err), &err);
    ss_header *head = ss_header_copy(ss_reader_header(reader));
    double *rows = head != NULL ? malloc(PIECE * head->n_columns * sizeof *rows) : NULL;
    if (rows == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    double *level = choose_columns(head);
    add_note(head);
    tool_check(ss_writer_new(&writer, tool_output(output), kind == TOOL_AU ? SS_AU : SS_TSV, head),
               NULL);
    for (;;) {
        tool_check(ss_reader_rows(reader, rows, PIECE, &n, &err), &err);
        if (n == 0)
            break;
        ss_noise_add(noise, rows, n, head->n_columns, head->n_columns, 1, level);
        tool_check(ss_writer_rows(writer, rows, n), NULL);
        tool_check(ss_writer_flush(writer), NULL);
    }
    ss_writer_free(writer);
    ss_header_free(head);
    ss_reader_free(reader);
    free(rows);
    free(level);
}

int
main(int argc, char *argv[])
{
    static const struct option longopts[] = {
        { "snr", required_argument, NULL, OPT_SNR }, { "rms", required_argument, NULL, OPT_RMS },
        { "seed", required_argument, NULL, OPT_SEED }, { "column", required_argument, NULL, 'c' },
        { "format", required_argument, NULL, TOOL_OPT_FORMAT }, TOOL_LONGOPTS };
    tool_kind kind = TOOL_TSV;
    ss_noise *noise;

    tool_begin(argv, "ss-noise", usage);
    wanted = malloc((size_t)argc * sizeof *wanted);
    if (wanted == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    for (int c; (c = getopt_long(argc, argv, "c:o:qvh", longopts, NULL)) != -1;)
        switch (c) {
        case OPT_SNR: snr = tool_number("--snr", optarg, -1000, 1000); break;
        case OPT_RMS: rms = tool_number("--rms", optarg, 0, DBL_MAX); break;
        case OPT_SEED: seed = tool_integer("--seed", optarg, 0, 0x7fffffff); break;
        case 'c': wanted[n_wanted++] = optarg; break;
        case 'o': output = optarg; break;
        case TOOL_OPT_FORMAT: kind = tool_format(optarg); break;
        default: tool_option(c);
        }
    if (isnan(snr) == isnan(rms))
        tool_usage("one of --snr and --rms is needed");
    path = tool_input(argc, argv, optind);
    kind = tool_output_kind(output, 1u << TOOL_TSV | 1u << TOOL_AU | 1u << TOOL_H5, kind);
    tool_check(ss_noise_new(&noise, (unsigned long)seed), NULL);
    if (isnan(rms) || kind == TOOL_H5 || tool_is_hdf5(path))
        noise_whole(kind, noise);
    else
        noise_stream(kind, noise);
    ss_noise_free(noise);
    free(wanted);
    tool_end();
    return 0;
}
