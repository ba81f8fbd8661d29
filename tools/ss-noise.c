/* ss-noise.c -- a signal with noise added, or as a converter gives it. */
#include "options.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
"usage: ss-noise [options] --snr=DB|--rms=VALUE|--bits=N --range=R [FILE]\n"
"Add Gaussian white noise to a signal, or round it as an analog-to-digital\n"
"converter does, or both in this order; write it to standard output.\n"
"      --snr=DB         signal-to-noise ratio of each column [dB]\n"
"      --rms=VALUE      noise of this standard deviation, in each column's unit\n"
"      --band=LO:HI     noise of these frequencies only [Hz], default all\n"
"      --seed=N         seed of the generator, default 1\n"
"      --bits=N         round and clip each column to N bits\n"
"      --range=R        the converter spans -R to R, in each column's unit\n"
"  -c, --column=NAME|N  only this column (repeatable), default all\n"
TOOL_READING_USAGE
"  -o, --output=FILE    write to FILE.tsv, .au, .csv, .json, .wav or .h5\n"
"      --format=FORM    on standard output: tsv (default), au, csv, json, wav\n"
"  -q, --quiet          no warnings\n"
"  -v, --verbose        report the noise that was added\n"
"  -h, --help           show this text and exit\n"
"      --version        show the version and exit\n";

static const char *path, *output;
static tool_reading reading;
static tool_texts wanted;               /* names of columns */
static double snr = NAN, rms = NAN, band[2] = { NAN, NAN }, range = NAN;
static int seed = 1, bits;

/* 1 for each column that was asked for, else 0. */
static double *
choose_columns(const ss_header *head)
{
    double *chosen = tool_room(NULL, head->n_columns, sizeof *chosen);
    for (size_t c = 0; c < head->n_columns; c++)
        chosen[c] = wanted.n == 0;
    for (size_t i = 0; i < wanted.n; i++)
        chosen[tool_column(head, path, wanted.text[i])] = 1;
    return chosen;
}

/* The numbers of samples that went through the converter, and of those that it clipped. */
static size_t n_converted, n_clipped;

static void
convert(double *x, size_t n)
{
    tool_check(ss_samples_quantise(x, n, bits, range, &n_clipped, &tool_error));
    n_converted += n;
}

/* Write the value of the note on clipping.  Returns 0 if nothing was clipped. */
static int
note_clipped(char *text, size_t size)
{
    if (n_clipped == 0)
        return 0;
    snprintf(text, size, "%zu of %zu samples", n_clipped, n_converted);
    tool_warn("%s: %s are outside the converter's range and clipped", tool_input_name(path), text);
    return 1;
}

static void
add_notes(ss_header *head)
{
    char text[256], number[SS_NUMBER_MAX], limit[2][SS_NUMBER_MAX] = { "", "" };
    if (!isnan(snr) || !isnan(rms)) {
        ss_number_format(number, isnan(rms) ? snr : rms);
        for (int i = 0; i < 2 && !isnan(band[0]); i++)
            ss_number_format(limit[i], band[i]);
        snprintf(text, sizeof text, "%s %s%s%s%s%s%s%s, seed %d", isnan(rms) ? "snr" : "rms",
                 number, isnan(rms) ? " dB" : "", isnan(band[0]) ? "" : ", ", limit[0],
                 isnan(band[0]) ? "" : " to ", limit[1], isnan(band[0]) ? "" : " Hz", seed);
        tool_check(ss_header_note(head, "noise", text, NULL));
    }
    if (bits > 0) {
        ss_number_format(number, range);
        snprintf(text, sizeof text, "%d bits, range %s", bits, number);
        tool_check(ss_header_note(head, "converter", text, NULL));
        tool_check(ss_header_note(head, "clipped", NULL, NULL));    /* by another converter; ours comes last */
    }
}

/* Report the rms of the noise of a column, which is returned. */
static double
report(const ss_header *head, size_t column, double level)
{
    const char *name = head->column[column].name;
    if (level == 0 && isnan(rms))
        tool_warn("%s: column %s is constant: no noise added", tool_input_name(path), name);
    tool_note("column %s: noise of rms %g", name, level);
    return level;
}

/* The frequencies of a band are those of the whole record.  Its noise is drawn column by column. */
static void
add_band(tool_kind kind, ss_noise *noise)
{
    ss_signal *signal = tool_read_signal(path, &reading.opts);
    size_t n = signal->n, columns = signal->head->n_columns;
    char text[128];
    double *chosen = choose_columns(signal->head), *x = signal->values;
    for (size_t c = 0; c < columns; c++, x += n) {
        if (chosen[c] == 0)
            continue;
        ss_variance variance = { .n = 0 };
        ss_variance_add(&variance, x, n);
        double level = report(signal->head, c, isnan(rms) ? ss_variance_noise(&variance, snr) : rms);
        if (level > 0)
            tool_check(ss_noise_add_band(noise, x, n, signal->head->rate, (ss_range){ band[0], band[1] }, level,
                                         &tool_error));
        if (bits > 0)
            convert(x, n);
    }
    add_notes(signal->head);
    if (note_clipped(text, sizeof text))
        tool_check(ss_header_note(signal->head, "clipped", text, NULL));
    tool_write(signal, output, kind);
    ss_signal_free(signal);
    free(chosen);
}

/* Row by row, in constant memory, and as they come unless their variance must be known, for a ratio: that takes one
 * more reading. */
static void
change_rows(tool_kind kind, ss_noise *noise)
{
    reading.opts.rewinds = !isnan(snr);
    ss_reader *reader = tool_read_rows(path, &reading.opts);
    size_t n, all = 0;
    char text[128];
    ss_header *head = NULL;
    size_t columns = ss_reader_header(reader)->n_columns, piece = ss_reader_piece(reader);
    tool_check(ss_header_select(&head, ss_reader_header(reader), NULL, columns, 0, &tool_error));
    double **x = tool_columns(columns, piece), *chosen = choose_columns(head);
    double *level = tool_room(NULL, columns, sizeof *level);            /* the rms of the noise of each column */
    ss_variance *variance = tool_room(NULL, columns, sizeof *variance);
    memset(variance, 0, columns * sizeof *variance);
    while (!isnan(snr) && (n = tool_rows(reader, x, piece)) > 0)
        for (size_t c = 0; c < columns; c++)
            ss_variance_add(&variance[c], x[c], n);
    if (!isnan(snr))
        tool_check(ss_reader_rewind(reader, &tool_error));
    for (size_t c = 0; c < columns; c++)
        level[c] = chosen[c] == 0 || (isnan(snr) && isnan(rms)) ? 0
            : report(head, c, isnan(rms) ? ss_variance_noise(&variance[c], snr) : rms);
    free(variance);
    add_notes(head);
    n = tool_rows(reader, x, piece);            /* if this fails, nothing is written */
    ss_writer *out = tool_writer(output, kind, &(ss_contents){ .signal = head });
    for (; n > 0; all += n, n = tool_rows(reader, x, piece)) {
        tool_check(ss_noise_add(noise, x, columns, n, level, &tool_error));
        for (size_t c = 0; c < columns && bits > 0; c++)
            if (chosen[c] == 1)
                convert(x[c], n);
        tool_write_rows(out, x, n);
    }
    if (note_clipped(text, sizeof text))
        tool_check(ss_writer_note(out, "clipped", text, &tool_error));
    tool_write_end(out, all);
    ss_header_free(head);
    ss_reader_free(reader);
    free(x);
    free(level);
    free(chosen);
}

static void
set_band(const tool_option *o, char *text)
{
    tool_pair("--band", text, "LO:HI", 0, DBL_MAX, o->to);
}

int
main(int argc, char *argv[])
{
    const ss_range decibels = { -1000, 1000 }, size = { 0, DBL_MAX }, spans = { DBL_MIN * 0x1p60, DBL_MAX };
    const ss_range of_bits = { 1, SS_BITS_MAX }, seeds = { 0, 0x7fffffff };
    tool_kind kind = TOOL_TSV;
    ss_noise *noise;
    const tool_option options[] = {
        TOOL_NUMBER(0, "snr", &snr, decibels), TOOL_NUMBER(0, "rms", &rms, size),
        TOOL_VALUE(0, "band", set_band, band), TOOL_WHOLE(0, "bits", &bits, of_bits),
        TOOL_NUMBER(0, "range", &range, spans), TOOL_WHOLE(0, "seed", &seed, seeds),
        TOOL_TEXTS('c', "column", &wanted), TOOL_OUTPUT(&output), TOOL_FORMAT(&kind) };

    tool_begin(argv, "ss-noise", usage);
    int first = TOOL_PARSE(argc, argv, options, &reading);
    int noisy = !isnan(snr) || !isnan(rms);
    if (!isnan(snr) && !isnan(rms))
        tool_usage("--snr and --rms exclude each other");
    if (!noisy && bits == 0)
        tool_usage("one of --snr, --rms and --bits is needed");
    if (!noisy && !isnan(band[0]))
        tool_usage("--band needs --snr or --rms");
    if ((bits > 0) == isnan(range))
        tool_usage("--bits and --range need each other");
    tool_reading_end(&reading, wanted.text, wanted.n);
    reading.opts.n_needed = 0;                  /* the others are written, too */
    path = tool_input(argc, argv, first);
    kind = tool_output_kind(output, TOOL_SIGNALS, kind);
    tool_check(ss_noise_new(&noise, (unsigned long)seed, &tool_error));
    if (!isnan(band[0]))
        add_band(kind, noise);
    else
        change_rows(kind, noise);
    ss_noise_free(noise);
    tool_end();
    return 0;
}
