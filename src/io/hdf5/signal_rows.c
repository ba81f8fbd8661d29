/* signal_rows.c -- read the rows of a signal in HDF5 in pieces of whole chunks, so that no chunk is
 * unpacked twice. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/columns.h"
#include "base/error.h"
#include "io/hdf5/groups.h"
#include "signal/gaps.h"

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
check_times(signal_rows *s, size_t n)
{
    const ss_header *head = s->base.head;
    char text[64];
    if (!ss_h5_read_rows(s->times, 0, s->row, n, s->raw))
        return ss_h5_fail(&s->file, SS_EIO, s->times, "", "cannot be read");
    for (size_t i = 0; i < n; i++)
        if (!ss_is_on_clock(s->raw[i], head->rate, head->start, s->row + i)) {
            snprintf(text, sizeof text, "value %zu is not start + %zu / rate", s->row + i + 1, s->row + i);
            return ss_h5_fail(&s->file, SS_EDATA, s->times, "", text);
        }
    return SS_OK;
}

/* Read n rows of dataset d into columns of the piece. */
static ss_status
read_dataset(signal_rows *s, size_t d, size_t n, size_t columns)
{
    double *x = columns == 1 ? s->value[d] : s->raw;
    if (!ss_h5_read_rows(s->dataset[d], s->by_columns, s->row, n, x))
        return ss_h5_fail(&s->file, SS_EIO, s->dataset[d], "", "cannot be read");
    ss_status status = check_finite(s, d, x, n, columns);
    for (size_t c = 0; columns > 1 && c < columns; c++)
        for (size_t i = 0; i < n; i++)
            s->value[c][i] = x[s->by_columns ? c * n + i : i * columns + c];
    return status;
}

/* Read the next n rows. */
static ss_status
read_piece(signal_rows *s, size_t n)
{
    size_t columns = s->n_datasets > 1 ? 1 : s->base.head->n_columns;
    ss_status status = s->times > 0 && n > 0 ? check_times(s, n) : SS_OK;
    for (size_t d = 0; status == SS_OK && n > 0 && d < s->n_datasets; d++)
        status = read_dataset(s, d, n, columns);
    if (status != SS_OK)
        return status;
    s->row += n;
    s->n_rows = n;
    s->next = 0;
    return SS_OK;
}

static ss_status
give_rows(ss_source *base, double *const column[], size_t max, size_t *n, ss_error *err)
{
    signal_rows *s = (signal_rows *)base;
    size_t left = s->n - s->row;
    ss_status status = SS_OK;
    s->file.err = err;
    if (s->next == s->n_rows)
        QUIETLY(
            status = read_piece(s, left < s->piece ? left : s->piece);
        );
    if (status != SS_OK)
        return status;
    left = s->n_rows - s->next;
    *n = left < max ? left : max;
    for (size_t c = 0; c < base->head->n_columns; c++)
        if (column[c] != NULL)
            memcpy(column[c], s->value[c] + s->next, *n * sizeof *column[c]);
    s->next += *n;
    return SS_OK;
}

static ss_status
rewind_rows(ss_source *base, ss_error *err)
{
    signal_rows *s = (signal_rows *)base;
    (void)err;
    s->row = s->next = s->n_rows = 0;
    return SS_OK;
}

static void
free_rows(ss_source *base)
{
    signal_rows *s = (signal_rows *)base;
    QUIETLY(
        ss_h5_close(&s->file);
    );
    free(s->path);
    free(s->dataset);
    free(s->value);
    free(s->raw);
}

static ss_status
find(signal_rows *s, const char *dataset, const ss_read_opts *opts)
{
    ss_status status = s->file.id < 0 ? ss_h5_open(&s->file) : SS_OK;
    if (status != SS_OK)
        return status;
    status = dataset != NULL ? ss_h5_find_array(s, dataset, opts) : ss_h5_find_signal(s, opts);
    if (status != SS_OK)
        return status;
    size_t all = s->base.head->n_columns, columns = s->n_datasets > 1 ? 1 : all;
    s->base.length = s->n;
    s->piece = piece_rows(s, all);
    s->value = ss_columns_new(all, s->piece);
    s->raw = malloc((s->piece * (columns > 0 ? columns : 1) + 1) * sizeof *s->raw);     /* times: one */
    return s->value != NULL && s->raw != NULL ? SS_OK : SS_ENOMEM;
}

ss_status
ss_h5_begin_signal(ss_source **out, hid_t id, const char *path, const char *dataset, const ss_read_opts *opts,
                   ss_error *err)
{
    static const struct source_calls calls = { .next = give_rows, .rewind = rewind_rows, .free = free_rows };
    dataset = dataset != NULL && dataset[0] != '\0' ? dataset : NULL;
    char *name = malloc(strlen(path) + (dataset != NULL ? strlen(dataset) : 0) + 2);
    if (name == NULL)
        return ss_fail_memory(err, path);
    char *end = stpcpy(name, path);
    if (dataset != NULL)
        stpcpy(stpcpy(end, ":"), dataset);
    signal_rows *s = ss_source_new(sizeof *s, &calls, name, err);
    free(name);
    if (s == NULL)
        return SS_ENOMEM;
    *out = &s->base;
    s->path = strdup(path);
    s->file = (h5_file){ .id = id, .path = s->path, .err = err };
    ss_status status = SS_ENOMEM;
    if (s->path != NULL)
        QUIETLY(
            status = find(s, dataset, opts);
        );
    if (status == SS_ENOMEM)
        ss_fail(err, status, "%s: %s", path, ss_strerror(status));
    if (status == SS_OK && opts->time != NULL && dataset != NULL)
        return ss_h5_time_rows(out, opts, err);
    return status == SS_OK && s->gaps ? ss_source_fill_gaps(out, opts->gaps, err) : status;
}

ss_status
ss_h5_open_signal(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts, ss_error *err)
{
    return ss_h5_begin_signal(out, -1, path, dataset, opts, err);
}
