/* ss-morlet.c -- wavelet coefficients of one column of a signal. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "options.h"

static const char usage[] =
"usage: ss-morlet [options] [FILE] > coefficients\n"
"Compute Morlet wavelet coefficients of a signal, from FILE or standard input.\n"
"  -c, --column=NAME|N    column to transform (a, or the only one)\n"
"      --center=WC, --voices=V  omega_c of the wavelet (6); scales an octave (16)\n"
"      --step=B0, --dense  translation step in scales (0.25); one sample\n"
"      --dyadic           the paper's grid: one voice, step 1\n"
"      --fmin=HZ, --fmax=HZ  (4 cycles a record, the highest that is resolved)\n"
"      --octaves=M0:M1    scales from 2^M0 to 2^M1 seconds instead\n"
"      --method=NAME      auto, quadrature or fft (auto)\n"
"      --accuracy=TOL     error relative to the largest of a scale (1e-6)\n"
"      --norm=l2|l1       a^-1/2 or 1/a (l2)\n"
"      --admissible       keep the second term of the wavelet\n"
"      --detrend=NAME     subtract none, mean or linear first (none)\n"
"      --force            scales that the record does not resolve, too\n"
"      --threads=N        work on N scales at a time (1)\n"
"      --stream           write coefficients as they are complete; needs --fmin\n"
"      --inverse          read coefficients, write the signal that has them\n"
"      --check            compare with the sum; --exact-bits: no rounding in HDF5\n"
TOOL_READING_USAGE
"  -o, --output=FILE      .tsv .au .csv .json .h5; --format=tsv|au|csv|json\n"
"  -q, --quiet   -v, --verbose   -h, --help   --version\n";

/* In the order of the library's enumerations. */
static const char *const methods[] = { "auto", "quadrature", "fft", NULL };
static const char *const norms[] = { "l2", "l1", NULL };
static const char *const detrends[] = { "none", "mean", "linear", NULL };

typedef struct request {
    ss_morlet_opts opts;
    tool_reading reading;
    const char *column, *output;
    int dyadic, stream, inverse, check, exact_bits;
    tool_kind kind;                     /* of the output */
} request;

static void
set_octaves(const tool_option *o, char *text)
{
    ss_morlet_opts *opts = o->to;
    double m[2];
    tool_pair("--octaves", text, "M0:M1", ss_morlet_ranges.octave.from,
              ss_morlet_ranges.octave.to, m);
    opts->octaves = 1;
    opts->m0 = m[0];
    opts->m1 = m[1];
}

static int
parse(request *req, int argc, char *argv[])
{
    const struct ss_morlet_ranges *in = &ss_morlet_ranges;
    ss_morlet_opts *opts = &req->opts;
    const tool_option options[] = {
        TOOL_TEXT('c', "column", &req->column), TOOL_NUMBER(0, "center", &opts->center, in->center),
        TOOL_WHOLE(0, "voices", &opts->voices, in->voices), TOOL_NUMBER(0, "step", &opts->step, in->step),
        TOOL_FLAG(0, "dense", &opts->dense), TOOL_FLAG(0, "dyadic", &req->dyadic),
        TOOL_NUMBER(0, "fmin", &opts->fmin, in->frequency),
        TOOL_NUMBER(0, "fmax", &opts->fmax, in->frequency), TOOL_VALUE(0, "octaves", set_octaves, opts),
        TOOL_CHOICE(0, "method", &opts->engine, methods),
        TOOL_NUMBER(0, "accuracy", &opts->accuracy, in->accuracy),
        TOOL_CHOICE(0, "norm", &opts->norm, norms), TOOL_FLAG(0, "admissible", &opts->admissible),
        TOOL_CHOICE(0, "detrend", &opts->detrend, detrends), TOOL_FLAG(0, "force", &opts->force),
        TOOL_THREADS(0, &opts->threads), TOOL_FLAG(0, "stream", &req->stream),
        TOOL_FLAG(0, "inverse", &req->inverse),
        TOOL_FLAG(0, "check", &req->check), TOOL_FLAG(0, "exact-bits", &req->exact_bits),
        TOOL_OUTPUT(&req->output), TOOL_FORMAT(&req->kind) };
    return TOOL_PARSE(argc, argv, options, &req->reading);
}

/* Refuse options that exclude each other. */
static void
check_request(request *req)
{
    static const char *const of_inverse[] = { "inverse", "accuracy", "output", "format", "quiet",
                                              "verbose", NULL };
    ss_morlet_opts *opts = &req->opts;
    if (opts->octaves && (opts->fmin > 0 || opts->fmax > 0))
        tool_usage("--octaves excludes --fmin and --fmax");
    if (opts->fmin > 0 && opts->fmax > 0 && opts->fmin > opts->fmax)
        tool_usage("--fmin lies above --fmax");
    if (req->dyadic && (tool_given("voices") || tool_given("step") || opts->dense))
        tool_usage("--dyadic excludes --voices, --step and --dense");
    if (req->dyadic) {
        opts->voices = 1;
        opts->step = 1;
    }
    if (req->inverse && tool_given_others(of_inverse))
        tool_usage("--inverse takes no options but --accuracy, --output and --format");
    if (req->stream && opts->fmin == 0 && !opts->octaves)
        tool_usage("--stream needs --fmin, as the length of the record is not known");
    if (req->stream && opts->detrend != SS_DETREND_NONE)
        tool_usage("--stream excludes --detrend, which needs the whole record");
    if (req->stream && opts->engine == SS_ENGINE_QUADRATURE)
        tool_usage("--stream excludes --method quadrature, which needs the whole record");
    if (req->stream && req->check)
        tool_usage("--stream excludes --check, which needs the whole record");
    req->kind = tool_output_kind(req->output, TOOL_SIGNALS, req->kind);
    if (req->exact_bits && req->kind != TOOL_H5)
        tool_usage("--exact-bits needs an output in HDF5; other forms keep all bits");
    opts->rounded = req->kind == TOOL_H5 && !req->exact_bits && !req->inverse;
}

typedef struct flow {
    ss_writer *writer;
    ss_error error;                     /* of the writer */
    size_t coefficients, samples;       /* so far; samples of a stream */
    double seconds;                     /* spent on writing */
    double *w;                          /* all coefficients, for --check; or NULL */
    ss_stream *stream;                  /* or NULL */
} flow;

/* Write coefficients of one scale: the sink of both ways to transform. */
static int
write_coefficients(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    flow *f = user;
    double begin = tool_seconds();
    ss_status st = ss_writer_coefficients(f->writer, scale, first, n, w, samples, &f->error);
    if (f->w != NULL)
        memcpy(f->w + 2 * f->coefficients, w, 2 * n * sizeof *w);
    f->coefficients += n;
    f->seconds += tool_seconds() - begin;
    return st != SS_OK;
}

/* Open the output for n samples on this grid; n is 0 if their number is not known yet. */
static void
open_output(flow *f, const request *req, const ss_header *signal, size_t column, size_t n, const ss_grid *on)
{
    ss_header *head;
    tool_check_error(ss_coefficients_header(&head, signal, column, n, &req->opts, &f->error), &f->error);
    const ss_coefficients grid = { .head = head, .n = n, .center = req->opts.center, .n_scales = on->n_scales,
                                   .scale = (ss_scale *)on->scale };
    f->writer = tool_writer(req->output, req->kind, &(ss_contents){ signal, &grid, 0, n });
    ss_header_free(head);
}

/* Die if the transform has failed, because of the output or of the library; rows that are written stay. */
static void
check_flow(const flow *f, ss_status status, const char *path)
{
    if (status == SS_STOP)
        tool_check_error(SS_EIO, &f->error);
    if (status != SS_OK)
        fflush(NULL);
    tool_check_input(status, path);
}

static void
transform_whole(const request *req, const char *path)
{
    flow f = { .writer = NULL };
    ss_morlet *plan = NULL;
    ss_read_opts reading = req->reading.opts;
    reading.progress = (ss_progress){ tool_reading_progress, NULL };
    ss_signal *signal = tool_read_signal(path, &reading);
    size_t column = tool_column(signal->head, path, req->column);
    const double *x = signal->values + column * signal->n;
    ss_morlet_opts opts = req->opts;
    opts.progress.function = tool_progress;
    double begin = tool_seconds();
    tool_check_input(ss_morlet_new(&plan, signal->n, signal->head->rate, &opts, &tool_error), path);
    const ss_grid *grid = ss_morlet_grid(plan);
    if (req->check)
        f.w = tool_room(NULL, 2 * grid->total, sizeof *f.w);
    open_output(&f, req, signal->head, column, signal->n, grid);
    double **all = tool_room(NULL, signal->head->n_columns, sizeof *all);
    for (size_t c = 0; c < signal->head->n_columns; c++)
        all[c] = signal->values + c * signal->n;
    tool_check(ss_writer_rows(f.writer, all, signal->n, &tool_error));
    free(all);
    check_flow(&f, ss_morlet_each(plan, x, write_coefficients, &f, &tool_error), path);
    size_t by_fft = 0, last = grid->n_scales - 1;
    for (size_t i = 0; i <= last; i++)
        by_fft += grid->scale[i].engine == SS_ENGINE_FFT;
    tool_note("%zu coefficients of %zu samples on %zu scales, %.4g to %.4g Hz, %zu by fft, %zu by quadrature, %.3g s",
              grid->total, signal->n, last + 1, grid->scale[0].f, grid->scale[last].f, by_fft, last + 1 - by_fft,
              tool_seconds() - begin - f.seconds);
    if (req->check) {
        enum { EACH = 20 };             /* coefficients of a scale */
        double difference;
        tool_check_input(ss_morlet_compare(plan, x, f.w, EACH, &difference, &tool_error), path);
        tool_warn("differs from the sum in full by at most %.2g of the largest |W| of a scale, "
                  "at %d coefficients of each", difference, (int)EACH);
    }
    tool_write_end(f.writer, signal->n);
    free(f.w);
    ss_morlet_free(plan);
    ss_signal_free(signal);
}

/* Make a signal of coefficients. */
static void
invert(const request *req, const char *path)
{
    ss_coefficients *coef = tool_read_coefficients(path);
    ss_signal *signal;
    double error, accuracy = tool_given("accuracy") ? req->opts.accuracy : 1e-3;
    const ss_progress progress = { tool_progress, &error };
    tool_check_input(ss_morlet_inverse(&signal, coef, fmax(accuracy, 1e-12), &error, progress, &tool_error), path);
    const char *norm = ss_header_find_note(coef->head, "norm");
    tool_note("%zu samples from coefficients of the norm %s, error about %.2g between %.4g and %.4g Hz", signal->n,
              norm != NULL ? norm : "l2", error, coef->scale[0].f, coef->scale[coef->n_scales - 1].f);
    tool_write(signal, req->output, req->kind);
    ss_signal_free(signal);
    ss_coefficients_free(coef);
}

/* Push samples as they come, until there are no more. */
static void
follow(flow *f, ss_reader *reader, size_t column, const request *req, const char *path)
{
    const ss_header *head = ss_reader_header(reader);
    size_t n, piece = ss_reader_piece(reader);
    double **x = tool_columns(head->n_columns, piece);
    do {
        ss_status st = ss_reader_rows(reader, x, piece, &n, &tool_error);
        if (tool_stopping() && f->samples > 0)
            n = 0, st = SS_OK;          /* the last row may be a part of one */
        f->samples += n;
        if (f->samples == 0)                   /* then nothing is written */
            tool_check(st);
        if (f->writer == NULL)
            open_output(f, req, head, column, 0, ss_stream_grid(f->stream));
        tool_check(ss_writer_rows(f->writer, x, n, &tool_error));
        check_flow(f, ss_stream_push(f->stream, x[column], n, &tool_error), path);
        if (st != SS_OK)                /* coefficients that are complete before bad data are written */
            check_flow(f, ss_stream_drain(f->stream, &tool_error), path);
        if ((st != SS_OK || ss_reader_waits(reader)) && fflush(NULL) != 0)
            tool_check(SS_EIO);
        tool_check(st);
    } while (n > 0 && !tool_stopping());
    free(x);
}

static void
transform_stream(const request *req, const char *path)
{
    flow f = { .writer = NULL };
    ss_reader *reader = tool_read_rows(path, &req->reading.opts);
    const ss_header *head = ss_reader_header(reader);
    size_t column = tool_column(head, path, req->column);
    tool_end_at_rows(req->output);
    tool_check_input(ss_stream_new(&f.stream, head->rate, &req->opts, write_coefficients, &f, &tool_error), path);
    const ss_scale *scale = ss_stream_grid(f.stream)->scale;
    size_t last = ss_stream_grid(f.stream)->n_scales - 1;
    tool_note("coefficients come at most %.3g s (of %.4g Hz) to %.3g s (of %.4g Hz) behind b",
              (double)(ss_stream_window(f.stream, last) - 1) / head->rate, scale[last].f,
              (double)(ss_stream_window(f.stream, 0) - 1) / head->rate, scale[0].f);
    follow(&f, reader, column, req, path);
    check_flow(&f, ss_stream_end(f.stream, &tool_error), path);
    tool_write_end(f.writer, f.samples);
    tool_note("%zu coefficients of %zu samples on %zu scales, %.4g to %.4g Hz", f.coefficients, f.samples, last + 1,
              scale[0].f, scale[last].f);
    ss_stream_free(f.stream);
    ss_reader_free(reader);
}

int
main(int argc, char *argv[])
{
    static request req = { .kind = TOOL_TSV };
    ss_morlet_opts_init(&req.opts, sizeof req.opts);

    tool_begin(argv, "ss-morlet", usage);
    int first = parse(&req, argc, argv);
    tool_reading_end(&req.reading, &req.column, req.column != NULL);
    check_request(&req);
    const char *path = tool_input(argc, argv, first);
    if (req.inverse)
        invert(&req, path);
    else if (req.stream)
        transform_stream(&req, path);
    else
        transform_whole(&req, path);
    tool_end();
    return 0;
}
