/* reader.c -- read a signal of any format, as rows or as a whole. */
#include "io/reader.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <stickslip/store.h>
#include "base/error.h"
#include "base/options.h"
#include "signal/filter.h"
#include "signal/header.h"
#include "signal/resample.h"

static const ss_read_opts defaults = { .size = sizeof defaults };

void
ss_read_opts_init(ss_read_opts *opts, size_t size)
{
    if (opts != NULL && size >= sizeof size)
        ss_options_init(opts, size, &defaults, sizeof defaults);
}

/* The caller's options, all of which this library has. */
static ss_status
take_opts(ss_read_opts *opts, const ss_read_opts *given, ss_error *err)
{
    ss_status st = ss_options_take(opts, sizeof *opts, &defaults, given, err);
    if (st != SS_OK)
        return st;
    if (opts->needed == NULL && opts->n_needed > 0)
        return SS_FAIL_NULL(err);
    if ((unsigned)opts->gaps > SS_GAPS_INTERPOLATE || !(opts->rate >= 0) || !(opts->resample >= 0)
        || isinf(opts->rate + opts->resample))
        return ss_fail(err, SS_EINVAL, "gaps, rate or resample out of range");
    return SS_OK;
}

/* --- opening ------------------------------------------------------------------------------- */

ss_status
ss_reader_open(ss_reader **out, FILE *in, const char *name, struct opening *o, ss_error *err)
{
    ss_read_opts opts;
    *out = NULL;
    ss_status st = take_opts(&opts, o->opts, err);
    if (st != SS_OK)
        return st;
    o->opts = &opts;
    ss_reader *reader = calloc(1, sizeof *reader);
    if (reader == NULL)
        return ss_fail_memory(err, name);
    o->in = &reader->in;
    st = ss_input_open(&reader->in, in, name, err);
    reader->in.progress = o->opts->progress;
    if (st == SS_OK)
        st = ss_format_open(&reader->source, o, err);
    if (st == SS_OK)
        st = ss_source_adjust(&reader->source, o->opts, err);
    if (st == SS_OK)
        *out = reader;
    else
        ss_reader_free(reader);
    return st;
}

ss_status
ss_reader_new(ss_reader **out, FILE *in, const char *name, const ss_read_opts *opts, ss_error *err)
{
    if (out == NULL || in == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    struct opening o = { .opts = opts, .kind = SS_KIND_SIGNAL };
    return ss_reader_open(out, in, name, &o, err);
}

/* Open a file of a format that only its path opens. */
static ss_status
open_place(ss_reader **out, const struct format *format, const char *path, const char *place,
           const ss_read_opts *given, ss_error *err)
{
    ss_read_opts opts;
    ss_status st = take_opts(&opts, given, err);
    if (st != SS_OK)
        return st;
    ss_reader *reader = calloc(1, sizeof *reader);
    if (reader == NULL)
        return ss_fail_memory(err, path);
    st = format->open_file(&reader->source, path, place, &opts, err);
    if (st == SS_OK)
        st = ss_source_adjust(&reader->source, &opts, err);
    if (st == SS_OK)
        *out = reader;
    else
        ss_reader_free(reader);
    return st;
}

static ss_status
open_stream(ss_reader **out, const char *path, const ss_read_opts *opts, ss_error *err)
{
    struct stat st;
    FILE *in = fopen(path, "rb");
    if (in == NULL)
        return ss_fail_errno(err, path, errno);
    ss_status status = fstat(fileno(in), &st) == 0 && S_ISDIR(st.st_mode)
                       ? ss_fail_errno(err, path, EISDIR)
                       : ss_reader_new(out, in, path, opts, err);
    if (status == SS_OK)
        (*out)->file = in;
    else
        fclose(in);
    return status;
}

ss_status
ss_reader_load(ss_reader **out, const char *path, const ss_read_opts *opts, ss_error *err)
{
    struct stat st;
    if (out == NULL || path == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    const struct format *format = ss_format_of_file(path);
    if (format != NULL)
        return open_place(out, format, path, NULL, opts, err);
    const char *colon = strstr(path, ":/");
    if (colon == NULL || stat(path, &st) == 0)
        return open_stream(out, path, opts, err);
    char *file = strndup(path, (size_t)(colon - path));
    if (file == NULL)
        return ss_fail_memory(err, path);
    format = ss_format_of_file(file);
    ss_status status = format != NULL ? open_place(out, format, file, colon + 1, opts, err)
        : stat(file, &st) != 0 ? ss_fail_errno(err, file, errno)
        : ss_fail(err, SS_EDATA, "%s: not an HDF5 file, so '%s' is not in it", file, colon + 1);
    free(file);
    return status;
}

void
ss_reader_free(ss_reader *reader)
{
    if (reader == NULL)
        return;
    ss_source_free(reader->source);
    ss_input_close(&reader->in);
    if (reader->file != NULL)
        fclose(reader->file);
    free(reader);
}

/* --- reading ------------------------------------------------------------------------------- */

const ss_header *
ss_reader_header(const ss_reader *reader)
{
    return reader != NULL ? reader->source->head : NULL;
}

ss_status
ss_reader_rows(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err)
{
    if (reader == NULL || column == NULL || n == NULL)
        return SS_FAIL_NULL(err);
    return ss_source_rows(reader->source, column, max, n, err);
}

size_t
ss_reader_piece(const ss_reader *reader)
{
    return reader != NULL ? ss_source_piece(reader->source) : 1;
}

int
ss_reader_waits(const ss_reader *reader)
{
    return reader != NULL && ss_source_waits(reader->source);
}

ss_status
ss_reader_rewind(ss_reader *reader, ss_error *err)
{
    return reader != NULL ? ss_source_rewind(reader->source, err) : SS_FAIL_NULL(err);
}

ss_status
ss_reader_keep(ss_reader *reader, const char *folder, ss_error *err)
{
    return reader != NULL ? ss_source_keep(&reader->source, folder, err) : SS_FAIL_NULL(err);
}

#define MOST 1e6                /* samples for each row: a short file cannot fill a disk */

ss_status
ss_reader_resample(ss_reader *reader, double rate, ss_error *err)
{
    if (reader == NULL)
        return SS_FAIL_NULL(err);
    if (!(rate > 0) || !isfinite(rate))
        return ss_fail(err, SS_EINVAL, "nothing can be resampled at %g Hz", rate);
    const ss_source *s = reader->source;
    if (!(rate / s->head->rate <= MOST))
        return ss_fail(err, SS_EDATA, "%s: each sample would become %.3g at %g Hz; at most %g are made",
                       s->name, rate / s->head->rate, rate, MOST);
    ss_status st = ss_refuse_range(s->name, rate, s->head->start, err);
    return st == SS_OK ? ss_source_resample(&reader->source, rate, 0, INFINITY, err) : st;
}

ss_status
ss_reader_filter(ss_reader *reader, const ss_filter_opts *opts, ss_error *err)
{
    return reader != NULL ? ss_source_filter(&reader->source, opts, err) : SS_FAIL_NULL(err);
}

/* --- whole signals ------------------------------------------------------------------------- */

ss_status
ss_reader_of_signal(ss_reader **out, const ss_signal *signal, ss_error *err)
{
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    ss_reader *reader = *out = calloc(1, sizeof *reader);
    if (reader == NULL)
        return ss_fail_memory(err, NULL);
    reader->source = ss_source_of_signal(signal, "signal", err);
    if (reader->source != NULL)
        return SS_OK;
    free(reader);
    *out = NULL;
    return SS_ENOMEM;
}

/* Read all rows of a reader that was opened with this status. */
static ss_status
read_all(ss_signal **out, ss_reader *reader, ss_status st, ss_error *err)
{
    if (st == SS_OK)
        st = ss_source_all(out, reader->source, err);
    ss_reader_free(reader);
    return st;
}

ss_status
ss_signal_read(ss_signal **out, FILE *in, const char *name, const ss_read_opts *opts, ss_error *err)
{
    ss_reader *reader = NULL;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    ss_status st = ss_reader_new(&reader, in, name, opts, err);
    return read_all(out, reader, st, err);
}

ss_status
ss_signal_load(ss_signal **out, const char *path, const ss_read_opts *opts, ss_error *err)
{
    ss_reader *reader = NULL;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    ss_status st = ss_reader_load(&reader, path, opts, err);
    return read_all(out, reader, st, err);
}
