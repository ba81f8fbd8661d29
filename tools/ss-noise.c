/* ss-noise.c -- a signal with noise added, or as a converter gives it. */
#include "options.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

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

static const char *path;
static ss_noise_done done;

/* Write the note on clipping, which is known at the end. */
static void
note_clipped(ss_writer *out)
{
    char text[64];
    if (done.clipped == 0)
        return;
    snprintf(text, sizeof text, "%zu of %zu samples", done.clipped, done.converted);
    tool_warn("%s: %s are outside the converter's range and clipped", tool_input_name(path), text);
    tool_check(ss_writer_note(out, "clipped", text, &tool_error));
}

static void
set_band(const tool_option *o, char *text)
{
    double pair[2];
    tool_pair("--band", text, "LO:HI", 0, DBL_MAX, pair);
    *(ss_range *)o->to = (ss_range){ pair[0], pair[1] };
}

int
main(int argc, char *argv[])
{
    const ss_range decibels = { -1000, 1000 }, size = { 0, DBL_MAX }, spans = { DBL_MIN * 0x1p60, DBL_MAX };
    const ss_range of_bits = { 1, SS_BITS_MAX }, seeds = { 0, 0x7fffffff };
    static const tool_texts all;
    static tool_reading reading;
    static tool_texts wanted;           /* names of columns */
    const char *output = NULL;
    tool_kind kind = TOOL_TSV;
    ss_noise_opts opts;
    int seed = 1;
    ss_noise_opts_init(&opts, sizeof opts);
    opts.range = NAN;
    const tool_option options[] = {
        TOOL_NUMBER(0, "snr", &opts.snr, decibels), TOOL_NUMBER(0, "rms", &opts.rms, size),
        TOOL_VALUE(0, "band", set_band, &opts.band), TOOL_WHOLE(0, "bits", &opts.bits, of_bits),
        TOOL_NUMBER(0, "range", &opts.range, spans), TOOL_WHOLE(0, "seed", &seed, seeds),
        TOOL_TEXTS('c', "column", &wanted), TOOL_OUTPUT(&output), TOOL_FORMAT(&kind) };

    tool_begin(argv, "ss-noise", usage);
    int first = TOOL_PARSE(argc, argv, options, &reading);
    int noisy = !isnan(opts.snr) || !isnan(opts.rms), band = !isnan(opts.band.from);
    if (!isnan(opts.snr) && !isnan(opts.rms))
        tool_usage("--snr and --rms exclude each other");
    if (!noisy && opts.bits == 0)
        tool_usage("one of --snr, --rms and --bits is needed");
    if (!noisy && band)
        tool_usage("--band needs --snr or --rms");
    if ((opts.bits > 0) == isnan(opts.range))
        tool_usage("--bits and --range need each other");
    tool_reading_end(&reading, wanted.text, wanted.n);
    reading.opts.n_needed = 0;                  /* the others are written, too */
    reading.opts.rewinds = !isnan(opts.snr) && !band;
    path = tool_input(argc, argv, first);
    kind = tool_output_kind(output, TOOL_SIGNALS, kind);
    ss_reader *reader = tool_read_rows(path, &reading.opts);
    const ss_header *head = ss_reader_header(reader);
    size_t *column = tool_room(NULL, wanted.n, sizeof *column);
    for (size_t i = 0; i < wanted.n; i++)
        column[i] = tool_column(head, path, wanted.text[i]);
    opts.column = column;
    opts.n_columns = wanted.n;
    opts.seed = (unsigned long)seed;
    done.rms = tool_room(NULL, head->n_columns, sizeof *done.rms);
    tool_check(ss_reader_noise(reader, &opts, &done, &tool_error));
    head = ss_reader_header(reader);
    for (size_t c = 0; c < head->n_columns; c++) {
        if (done.rms[c] == 0 && isnan(opts.rms))
            tool_warn("%s: column %s is constant: no noise added", tool_input_name(path), head->column[c].name);
        if (!isnan(done.rms[c]))
            tool_note("column %s: noise of rms %g", head->column[c].name, done.rms[c]);
    }
    tool_copy(reader, path, &all, &all, output, kind, note_clipped);
    free(column);
    free(done.rms);
    tool_end();
    return 0;
}
