/* reader.c -- read a signal of any format, as rows or as a whole. */
#include "io/format.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/error.h"
#include "base/number.h"
#include "base/options.h"
#include "signal/header.h"
#include "signal/source.h"

static const ss_read_opts defaults = { .size = sizeof defaults };

SS_OPTIONS(ss_read_opts, defaults)

#define MOST 1e6                /* samples for each row: a short file cannot fill a disk */

/* Bring the rows to the rate that was asked for, unless a table has brought its own to it. */
static ss_status
resample(ss_source **s, const ss_read_opts *opts, ss_error *err)
{
    const char *name = (*s)->name;
    double own = (*s)->head->rate, rate = opts->resample;
    char text[300];
    if (!(rate > 0) || !(own < rate || own > rate))
        return SS_OK;
    if (!(rate / own <= MOST))
        return ss_fail(err, SS_EDATA, "%s: each sample would become %.3g at %g Hz; at most %g are made", name,
                       rate / own, rate, MOST);
    if (own > rate && opts->warn != NULL) {
        ss_print_to(text, sizeof text, "%.200s: frequencies above %g Hz fold down", name, rate / 2);
        opts->warn(SS_OK, text, opts->user);
    }
    ss_status st = ss_refuse_range(name, rate, (*s)->head->start, err);
    return st == SS_OK ? ss_source_resample(s, rate, 0, INFINITY, err) : st;
}

char *
ss_file_of(const char *path, const char **place)
{
    struct stat is;
    const char *colon = stat(path, &is) != 0 ? strstr(path, ":/") : NULL;
    *place = colon != NULL ? colon + 1 : NULL;
    return strndup(path, colon != NULL ? (size_t)(colon - path) : strlen(path));
}

/* Open the file at a path: a stream becomes reader->file, what only its path opens, with or without ":/" and a
 * place in it, the reader's source. */
static ss_status
open_path(ss_reader *reader, const char *path, const ss_read_opts *opts, ss_error *err)
{
    struct stat is;
    const char *place;
    char *file = ss_file_of(path, &place);
    if (file == NULL)
        return ss_fail_memory(err, path);
    const struct format *format = ss_format_of_file(file);
    ss_status st = SS_OK;
    if (format != NULL)
        st = format->open_file(&reader->source, file, place, opts, err);
    else if (place != NULL && stat(file, &is) == 0)
        st = ss_fail(err, SS_EDATA, "%s: not an HDF5 file, so '%s' is not in it", file, place);
    else if ((reader->file = fopen(file, "rb")) == NULL)
        st = ss_fail_errno(err, file, errno);
    else if (fstat(fileno(reader->file), &is) == 0 && S_ISDIR(is.st_mode))
        st = ss_fail_errno(err, file, EISDIR);
    free(file);
    return st;
}

ss_status
ss_reader_open(ss_reader **out, FILE *in, const char *name, struct opening *o, ss_error *err)
{
    ss_read_opts opts;
    *out = NULL;
    ss_status st = ss_options_take(&opts, sizeof opts, &defaults, o->opts, err);
    if (st != SS_OK)
        return st;
    if (opts.needed == NULL && opts.n_needed > 0)
        return SS_FAIL_NULL(err);
    if ((unsigned)opts.gaps > SS_GAPS_INTERPOLATE || !(opts.rate >= 0) || !(opts.resample >= 0)
        || isinf(opts.rate + opts.resample))
        return ss_fail(err, SS_EINVAL, "gaps, rate or resample out of range");
    o->opts = &opts;
    ss_reader *reader = calloc(1, sizeof *reader);
    if (reader == NULL)
        return ss_fail_memory(err, name);
    o->in = &reader->in;
    if (in == NULL)
        st = open_path(reader, name, &opts, err);
    if (st == SS_OK && reader->source == NULL) {
        st = ss_input_open(&reader->in, in != NULL ? in : reader->file, name, err);
        reader->in.progress = opts.progress;
        if (st == SS_OK)
            st = ss_format_open(&reader->source, o, err);
    }
    if (st == SS_OK)
        st = ss_source_adjust(&reader->source, &opts, err);
    if (st == SS_OK)
        st = resample(&reader->source, &opts, err);
    if (st == SS_OK && opts.rewinds)
        st = ss_source_keep(&reader->source, opts.folder, err);
    if (st == SS_OK)
        *out = reader;
    else
        ss_reader_free(reader);
    return st;
}

ss_status
ss_reader_new(ss_reader **out, FILE *in, const char *name, const ss_read_opts *opts, ss_error *err)
{
    if (out == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    struct opening o = { .opts = opts, .kind = SS_KIND_SIGNAL };
    return ss_reader_open(out, in, name, &o, err);
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
    return reader != NULL && reader->in.file != NULL && !ss_source_has_rows(reader->source)
        && ss_input_waits(&reader->in);
}

ss_status
ss_reader_rewind(ss_reader *reader, ss_error *err)
{
    return reader != NULL ? ss_source_rewind(reader->source, err) : SS_FAIL_NULL(err);
}

ss_status
ss_reader_filter(ss_reader *reader, const ss_filter_opts *opts, ss_error *err)
{
    return reader != NULL ? ss_source_filter(&reader->source, opts, err) : SS_FAIL_NULL(err);
}

ss_status
ss_reader_noise(ss_reader *reader, const ss_noise_opts *opts, ss_noise_done *done, ss_error *err)
{
    return reader != NULL && done != NULL ? ss_source_noise(&reader->source, opts, done, err) : SS_FAIL_NULL(err);
}

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

ss_status
ss_signal_of_reader(ss_signal **out, ss_reader *reader, ss_error *err)
{
    if (out == NULL || reader == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    return ss_source_all(out, reader->source, err);
}

ss_status
ss_signal_read(ss_signal **out, FILE *in, const char *name, const ss_read_opts *opts, ss_error *err)
{
    ss_reader *reader = NULL;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    ss_status st = ss_reader_new(&reader, in, name, opts, err);
    if (st == SS_OK)
        st = ss_signal_of_reader(out, reader, err);
    ss_reader_free(reader);
    return st;
}
