/* signal_rows.c -- read the rows of a signal in HDF5 in pieces of whole chunks, so that no chunk is
 * unpacked twice. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/columns.h"
#include "io/hdf5/groups.h"
#include "io/table/clock.h"

enum { PIECE = 1 << 18 };       /* values that are read at a time, unless chunks are larger */

/* The number of rows in a chunk of a dataset; 0: it is not in chunks. */
static hsize_t
chunk_rows(hid_t id, int by_columns)
{
    hsize_t chunk[H5S_MAX_RANK];
    hid_t how = H5Dget_create_plist(id);
    int rank = H5Pget_layout(how) == H5D_CHUNKED ? H5Pget_chunk(how, H5S_MAX_RANK, chunk) : 0;
    H5Pclose(how);
    return rank > 0 ? chunk[rank == 2 && by_columns] : 0;
}

/* The number of rows to read at a time: whole chunks of the dataset with the longest chunks, about PIECE
 * values in all, or all rows. */
static size_t
piece_rows(const signal_rows *s, size_t columns)
{
    hsize_t chunk = 1, target = PIECE / (columns + 1) + 1;
    for (size_t d = 0; d < s->n_datasets; d++) {
        hsize_t own = chunk_rows(s->dataset[d], s->by_columns);
        chunk = own > chunk ? own : chunk;
    }
    if (s->stamps > 0 && chunk_rows(s->stamps, s->stamps_by_columns) > chunk)
        chunk = chunk_rows(s->stamps, s->stamps_by_columns);
    hsize_t rows = chunk < target ? target / chunk * chunk : chunk;
    return rows < s->n ? (size_t)rows : s->n;
}

/* Check n rows of dataset d.  Values that are not finite become NaN if there may be gaps, else SS_EDATA. */
static ss_status
check_finite(signal_rows *s, size_t d, double *x, size_t n, size_t columns)
{
    char text[64];
    for (size_t i = 0; i < n * columns; i++) {
        if (isfinite(x[i]))
            continue;
        x[i] = NAN;
        if (s->gaps)
            continue;
        size_t place = s->by_columns ? i / n * s->n + s->row + i % n : s->row * columns + i;
        snprintf(text, sizeof text, "value %zu is not finite", place + 1);
        return ss_h5_fail(&s->file, SS_EDATA, s->dataset[d], "", text);
    }
    return SS_OK;
}

static ss_status
check_times(signal_rows *s, const ss_reader *reader, size_t n)
{
    char text[64];
    if (!ss_h5_read_rows(s->times, 0, s->row, n, s->raw))
        return ss_h5_fail(&s->file, SS_EIO, s->times, "", "cannot be read");
    for (size_t i = 0; i < n; i++)
        if (!ss_is_on_clock(s->raw[i], reader->head->rate, reader->start, s->row + i)) {
            snprintf(text, sizeof text, "value %zu is not start + %zu / rate", s->row + i + 1, s->row + i);
            return ss_h5_fail(&s->file, SS_EDATA, s->times, "", text);
        }
    return SS_OK;
}

/* Read n rows of dataset d into columns of the piece. */
static ss_status
read_dataset(signal_rows *s, size_t d, size_t n, size_t columns, double *const piece[])
{
    double *x = columns == 1 ? piece[d] : s->raw;
    if (!ss_h5_read_rows(s->dataset[d], s->by_columns, s->row, n, x))
        return ss_h5_fail(&s->file, SS_EIO, s->dataset[d], "", "cannot be read");
    ss_status status = check_finite(s, d, x, n, columns);
    for (size_t c = 0; columns > 1 && c < columns; c++)
        for (size_t i = 0; i < n; i++)
            piece[c][i] = x[s->by_columns ? c * n + i : i * columns + c];
    return status;
}

/* Read the next n rows into the piece of the reader. */
static ss_status
read_piece(ss_reader *reader, signal_rows *s, size_t n)
{
    size_t columns = s->n_datasets > 1 ? 1 : reader->head->n_columns;
    ss_status status = s->times > 0 && n > 0 ? check_times(s, reader, n) : SS_OK;
    for (size_t d = 0; status == SS_OK && n > 0 && d < s->n_datasets; d++)
        status = read_dataset(s, d, n, columns, reader->values);
    if (status != SS_OK)
        return status;
    s->row += n;
    reader->n_rows = n;
    reader->next = 0;
    return SS_OK;
}

static ss_status
give_rows(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err)
{
    signal_rows *s = reader->source;
    size_t left = s->n - s->row;
    ss_status status = SS_OK;
    s->file.err = err;
    if (reader->next == reader->n_rows)
        QUIETLY(
            status = read_piece(reader, s, left < s->piece ? left : s->piece);
        );
    if (status != SS_OK)
        return status;
    left = reader->n_rows - reader->next;
    *n = left < max ? left : max;
    for (size_t c = 0; c < reader->head->n_columns; c++)
        if (column[c] != NULL)
            memcpy(column[c], reader->values[c] + reader->next, *n * sizeof *column[c]);
    reader->next += *n;
    reader->row += *n;
    return SS_OK;
}

static void
close_rows(ss_reader *reader)
{
    signal_rows *s = reader->source;
    QUIETLY(
        ss_h5_close(&s->file);
    );
    free(s->path);
    free(s->dataset);
    free(s->raw);
    free(s);
}

static ss_status
rewind_rows(ss_reader *reader, ss_error *err)
{
    signal_rows *s = reader->source;
    (void)err;
    s->row = 0;
    reader->next = reader->n_rows = 0;
    return SS_OK;
}

static ss_status
begin_rows(ss_reader *reader, signal_rows *s, const ss_read_opts *opts)
{
    size_t all = reader->head->n_columns, columns = s->n_datasets > 1 ? 1 : all;
    reader->rows = give_rows;
    reader->rewind = rewind_rows;
    reader->length = s->n;
    s->piece = piece_rows(s, all);
    reader->values = ss_columns_new(all, s->piece);
    s->raw = malloc((s->piece * columns + 1) * sizeof *s->raw);
    if (reader->values == NULL || s->raw == NULL)
        return SS_ENOMEM;
    return s->gaps && opts->time == NULL ? ss_reader_fill_gaps(reader, opts->gaps, s->file.err) : SS_OK;
}

ss_status
ss_h5_open_signal(ss_reader *reader, h5_file *file, const char *dataset, const ss_read_opts *opts)
{
    int is_array = dataset != NULL && dataset[0] != '\0';
    signal_rows *s = calloc(1, sizeof *s);
    char *name = malloc(strlen(file->path) + (is_array ? strlen(dataset) : 0) + 2);
    reader->in.name = name;
    if (s == NULL || name == NULL || (s->path = strdup(file->path)) == NULL) {
        ss_h5_close(file);
        free(s);
        return SS_ENOMEM;
    }
    char *end = stpcpy(name, file->path);
    if (is_array)
        stpcpy(stpcpy(end, ":"), dataset);
    s->file = *file;
    s->file.path = s->path;
    reader->source = s;
    reader->close = close_rows;
    ss_status status = is_array ? ss_h5_find_array(s, &reader->head, dataset, opts)
        : ss_h5_find_signal(s, &reader->head, opts);
    if (status == SS_OK)
        status = begin_rows(reader, s, opts);
    return status == SS_OK && opts->time != NULL ? ss_h5_time_rows(reader, s, opts) : status;
}
