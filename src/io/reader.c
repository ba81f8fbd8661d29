/* reader.c -- read a stream of any format, as rows or as a whole signal. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/progress.h"
#include "signal/gaps.h"
#include "signal/header.h"
#include "io/calibration.h"
#include "io/table/clock.h"
#include "io/table/delimited.h"
#include "io/format.h"
#include "io/reader.h"

/* Open the input in the format that its first bytes show.  Files of other programs that users often try are
 * named. */
static ss_status
open_format(ss_reader *reader, const ss_read_opts *opts, ss_error *err)
{
    struct input *in = &reader->in;
    ss_status st = ss_input_need(in, FORMAT_BYTES, err);
    const char *p = in->buffer + in->lo;
    size_t n = in->hi - in->lo;
    if (st != SS_OK)
        return st;
    if (n == 0)
        return ss_fail(err, SS_EDATA, "%s: empty", in->name);
    const struct format *found = ss_format_of_bytes(p, n);
    int fits = found->has_header || reader->kind == SS_KIND_SIGNAL;
    if (found->magic == NULL && n >= 4 && memcmp(p, "\211HDF", 4) == 0)
        return ss_fail(err, SS_EDATA, "%s: HDF5 cannot be read from a stream; give its path", in->name);
    if ((found->magic == NULL || !fits) && ss_fail_kind(err, in->name, p, n, reader->kind) != SS_OK)
        return SS_EKIND;
    return fits ? found->open(reader, opts, err) : ss_fail_magic(err, in->name, "", reader->kind);
}

ss_status
ss_reader_adjust(ss_reader *reader, const ss_read_opts *opts, ss_error *err)
{
    ss_status st = ss_refuse_range(reader->in.name, reader->head->rate, reader->head->start, err);
    reader->start = reader->head->start;
    if (st != SS_OK)
        return st;
    ss_select_rows(reader->head, opts, &reader->first, &reader->end_row);
    reader->from = opts->from;
    reader->to = opts->to;
    uint64_t end = reader->length < reader->end_row ? reader->length : reader->end_row;
    if (opts->from < opts->to && reader->first >= end && reader->length < UINT64_MAX)
        return ss_fail_no_rows(reader->in.name, opts->from, opts->to, err);
    return ss_calibrate_header(reader->head, opts, reader->in.name, &reader->factor, err);
}

ss_status
ss_reader_open(ss_reader *reader, FILE *in, const char *name, ss_kind kind, const ss_read_opts *opts,
               ss_error *err)
{
    static const ss_read_opts no_opts;
    reader->kind = kind;
    reader->length = UINT64_MAX;
    reader->head = ss_header_new(0, 0);
    ss_status st = ss_input_open(&reader->in, in, name, err);
    if (opts != NULL)
        reader->in.progress = opts->progress;
    if (st == SS_OK && reader->head == NULL)
        st = ss_fail_memory(err, name);
    if (st == SS_OK)
        st = open_format(reader, opts != NULL ? opts : &no_opts, err);
    return st == SS_OK ? ss_reader_adjust(reader, opts != NULL ? opts : &no_opts, err) : st;
}

void
ss_reader_close(ss_reader *reader)
{
    if (reader->close != NULL)
        reader->close(reader);
    ss_input_close(&reader->in);
    ss_header_free(reader->head);
    ss_delimited_free(reader->table);
    ss_gaps_free(reader->gaps);
    free(reader->values);
    free(reader->factor);
}

ss_reader *
ss_reader_like(const ss_reader *reader)
{
    ss_reader *r = calloc(1, sizeof *r);
    if (r == NULL)
        return NULL;
    r->in.name = strdup(reader->in.name);
    r->head = ss_header_copy(reader->head);
    r->length = r->end_row = UINT64_MAX;
    if (r->in.name != NULL && r->head != NULL)
        return r;
    ss_reader_free(r);
    return NULL;
}

ss_status
ss_reader_new(ss_reader **out, FILE *in, const char *name, const ss_read_opts *opts, ss_error *err)
{
    if (out == NULL || in == NULL || name == NULL
        || (opts != NULL && opts->needed == NULL && opts->n_needed > 0))
        return SS_FAIL_NULL(err);
    *out = NULL;
    if (opts != NULL && ((unsigned)opts->gaps > SS_GAPS_INTERPOLATE || !(opts->rate >= 0)
                         || !(opts->resample >= 0) || isinf(opts->rate + opts->resample)))
        return ss_fail(err, SS_EINVAL, "gaps, rate or resample out of range");
    ss_reader *reader = calloc(1, sizeof *reader);
    if (reader == NULL)
        return ss_fail_memory(err, name);
    ss_status st = ss_reader_open(reader, in, name, SS_KIND_SIGNAL, opts, err);
    if (st == SS_OK)
        *out = reader;
    else
        ss_reader_free(reader);
    return st;
}

const ss_header *
ss_reader_header(const ss_reader *reader)
{
    if (reader == NULL)
        return NULL;
    return reader->head;
}

ss_status
ss_reader_rows(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err)
{
    if (reader == NULL || column == NULL || n == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = SS_OK;
    do {                                        /* skip the rows before the first one wanted */
        uint64_t end = reader->passed < reader->first ? reader->first : reader->end_row;
        uint64_t left = end - reader->passed;
        *n = 0;
        st = left > 0 ? reader->rows(reader, column, left < max ? (size_t)left : max, n, err) : SS_OK;
        reader->passed += *n;
    } while (st == SS_OK && *n > 0 && reader->passed <= reader->first);
    int none = reader->passed <= reader->first;
    *n = none ? 0 : *n;
    if (reader->in.size > 0 && reader->table != NULL)
        ss_progress_at(&reader->in.progress, ss_delimited_given(reader->table));
    if (st == SS_OK && none && max > 0 && reader->from < reader->to)
        return ss_fail_no_rows(reader->in.name, reader->from, reader->to, err);
    ss_status scaled = ss_calibrate(column, *n, reader->head->n_columns, reader->factor, reader->in.name, err);
    return st == SS_OK ? scaled : st;
}

size_t
ss_reader_piece(const ss_reader *reader)
{
    enum { ROWS = 4096, VALUES = 1 << 16 };
    size_t rows = reader == NULL || reader->head->n_columns == 0 ? 1 : VALUES / reader->head->n_columns;
    return rows > ROWS ? ROWS : rows > 1 ? rows : 1;
}

int
ss_reader_waits(const ss_reader *reader)
{
    if (reader == NULL)
        return 0;
    if (reader->waits != NULL)
        return reader->waits(reader);
    return reader->values == NULL && ss_input_waits(&reader->in);
}

void
ss_reader_free(ss_reader *reader)
{
    if (reader == NULL)
        return;
    ss_reader_close(reader);
    free(reader);
}

/* --- whole signals ------------------------------------------------------------------------- */

/* Give each column of a signal room for `more` rows in place of *room. */
static ss_status
set_room(ss_signal *signal, size_t *room, size_t more, const char *name, ss_error *err)
{
    size_t columns = signal->head->n_columns, n = signal->n;
    double *values = signal->values;
    for (size_t c = 1; more < *room && c < columns; c++)
        memmove(values + c * more, values + c * *room, n * sizeof *values);
    int fits = more < SIZE_MAX / sizeof *values / (columns + 1);
    values = fits ? realloc(values, (columns * more + 1) * sizeof *values) : NULL;
    if (values == NULL)
        return ss_fail(err, SS_ENOMEM, "%s: no memory for a record this long", name);
    signal->values = values;
    for (size_t c = columns; more > *room && c-- > 1;)
        memmove(values + c * more, values + c * *room, n * sizeof *values);
    *room = more;
    return SS_OK;
}

ss_status
ss_reader_all(ss_signal **out, ss_reader *reader, ss_error *err)
{
    const char *name = reader->in.name;
    size_t columns = reader->head->n_columns, room = 0, got = 1, first = 1 + 16384 / columns;
    ss_signal *signal = NULL;
    double **column = malloc(columns * sizeof *column);
    ss_status st = column != NULL ? ss_signal_new(&signal, reader->head, 0) : SS_ENOMEM;
    if (st != SS_OK)
        ss_fail_memory(err, name);
    if (reader->length < UINT64_MAX)
        first = (size_t)((reader->length < reader->end_row ? reader->length : reader->end_row) - reader->first) + 1;
    while (st == SS_OK && got > 0) {
        if (signal->n == room && (st = set_room(signal, &room, room > 0 ? 2 * room : first, name, err)) != SS_OK)
            break;
        for (size_t c = 0; c < columns; c++)
            column[c] = signal->values + c * room + signal->n;
        st = ss_reader_rows(reader, column, room - signal->n, &got, err);
        signal->n += got;
    }
    if (st == SS_OK)
        st = set_room(signal, &room, signal->n, name, err);
    free(column);
    if (st == SS_OK)
        *out = signal;
    else
        ss_signal_free(signal);
    return st;
}

ss_status
ss_signal_read(ss_signal **out, FILE *in, const char *name, const ss_read_opts *opts,
               ss_error *err)
{
    ss_reader *reader;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    ss_status st = ss_reader_new(&reader, in, name, opts, err);
    if (st != SS_OK)
        return st;
    st = ss_reader_all(out, reader, err);
    ss_reader_free(reader);
    return st;
}
