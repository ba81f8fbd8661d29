/* write.c -- a record as an HDF5 file that xarray, MATLAB and h5dump understand directly.
 *
 * Every dataset has units and long_name and is attached to its dimension scales.
 * Nothing in the file depends on the clock, the path or the machine: creation times are not
 * tracked, file types are little-endian, links and attributes are kept in the order of writing.
 *
 * Samples and coefficients come in pieces.  Where their number is known, a scale's datasets are
 * closed when they are full; else all stay open, in chunks so short that one of each fits into
 * memory. */
#include "store/h5.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/error.h"

#define CHUNK 65536             /* values in a chunk, or written at a time, at most */
#define PLAIN_BYTES 65536       /* a dataset up to this size is stored without compression */
#define OPEN_BYTES (32 << 20)   /* of chunks being filled, about, where lengths are not known */
#define LEAST_CHUNK 256

/* One dataset to be written. */
typedef struct variable {
    const char *name, *unit, *long_name;
    hid_t file_type, memory_type;
    const void *values;         /* NULL: they are written later */
    size_t start, stride;       /* value i is values[start + i * stride]; stride 0 is 1 */
    hsize_t chunk;              /* 0: as its size says; else its last dimension grows, and it is
                                   kept in chunks of so many values of a row */
} variable;

struct ss_store_writer {
    char *path;
    h5_file file;
    h5_disk disk;
    int spooled;                /* path is not a regular file: it gets a copy at the end */
    ss_status status;           /* of what failed first */
    ss_error error;
    double rate, start;
    int growing;                /* lengths are known only at the end */
    /* the signal */
    size_t length, samples;     /* in all; so far */
    size_t n_columns;
    hid_t *column, times;       /* column: a dataset each */
    /* the coefficients */
    size_t n, n_scales;         /* n: samples of the record */
    ss_scale *scale;
    ss_span *gap;
    size_t n_gaps;
    int dense;
    hid_t wavelet;
    struct rows {
        hid_t time, re, im, edge;
        size_t done;
    } *rows;                    /* of each scale; if dense, the first has the datasets of all */
    double *value[2];           /* a piece: re, im, or others */
    unsigned char *edge;
};

/* A call of HDF5 fails for lack of memory, or for a name or size that it cannot store; disk.c hides a
 * full disk from it. */
static ss_status
fail_write(h5_file *file, hid_t group, const char *name)
{
    return ss_h5_fail(file, SS_EIO, group, name, "HDF5 cannot store it, or is out of memory");
}

static int
write_number(hid_t object, const char *name, hid_t file_type, double value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t id = H5Acreate2(object, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT);
    int good = id >= 0 && H5Awrite(id, H5T_NATIVE_DOUBLE, &value) >= 0;
    H5Aclose(id);
    H5Sclose(space);
    return good;
}

static int
write_text(hid_t object, const char *name, const char *value)
{
    hid_t space = H5Screate(H5S_SCALAR), type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(value) + 1);
    H5Tset_cset(type, H5T_CSET_UTF8);
    hid_t id = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    int good = id >= 0 && H5Awrite(id, type, value) >= 0;
    H5Aclose(id);
    H5Tclose(type);
    H5Sclose(space);
    return good;
}

/* The layout of a dataset: large ones in compressed chunks along the last dimension. */
static hid_t
layout(const variable *v, int rank, const hsize_t dims[])
{
    hsize_t chunk[2] = { 1, 1 }, values = 1;
    hid_t plist = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(plist, 0);
    for (int i = 0; i < rank; i++)
        values *= dims[i];
    if (v->chunk == 0 && values * H5Tget_size(v->file_type) <= PLAIN_BYTES)
        return plist;
    hsize_t row = v->chunk > 0 ? v->chunk : dims[rank - 1] < CHUNK ? dims[rank - 1] : CHUNK;
    chunk[rank - 1] = row;
    if (rank == 2 && v->chunk == 0)
        chunk[0] = CHUNK / row < dims[0] ? CHUNK / row : dims[0];
    H5Pset_chunk(plist, rank, chunk);
    if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0) {
        H5Pset_shuffle(plist);
        H5Pset_deflate(plist, 4);
    }
    return plist;
}

/* The cache of a growing dataset: room for a chunk a row. */
static hid_t
access_of(const variable *v, int rank, const hsize_t dims[])
{
    hid_t plist = H5Pcreate(H5P_DATASET_ACCESS);
    size_t rows = rank == 2 ? (size_t)dims[0] : 1;
    if (v->chunk > 0)
        H5Pset_chunk_cache(plist, rows > 1 ? 128 * rows + 1 : 1,
                           rows * (size_t)v->chunk * H5Tget_size(v->file_type), 1);
    return plist;
}

/* The values in memory as HDF5 sees them: every stride-th of a line. */
static hid_t
memory_space(const variable *v, hsize_t values)
{
    hsize_t start = v->start, stride = v->stride > 0 ? v->stride : 1, count = values;
    hsize_t length = start + values * stride;
    hid_t space = H5Screate_simple(1, &length, NULL);
    if (values == 0)
        H5Sselect_none(space);
    else
        H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, &stride, &count, NULL);
    return space;
}

/* Make one dataset on the given dimension scales (NULL: it is a scale itself), and write its values if
 * it has any; < 0 if HDF5 fails. */
static hid_t
new_variable(hid_t group, const variable *v, int rank, const hsize_t dims[],
             const char *const scales[])
{
    hsize_t values = rank == 2 ? dims[0] * dims[1] : dims[0], most[2] = { dims[0], dims[rank - 1] };
    most[rank - 1] = v->chunk > 0 ? H5S_UNLIMITED : dims[rank - 1];
    hid_t how = layout(v, rank, dims), access = access_of(v, rank, dims);
    hid_t space = H5Screate_simple(rank, dims, most);
    hid_t id = H5Dcreate2(group, v->name, v->file_type, space, H5P_DEFAULT, how, access);
    int good = id >= 0 && write_text(id, "units", v->unit)
        && write_text(id, "long_name", v->long_name);
    if (good && v->values != NULL) {
        hid_t memory = memory_space(v, values);
        good = H5Dwrite(id, v->memory_type, memory, values > 0 ? H5S_ALL : space, H5P_DEFAULT,
                        v->values) >= 0;
        H5Sclose(memory);
    }
    if (good && scales == NULL)
        good = H5DSset_scale(id, v->name) >= 0;
    for (int i = 0; good && scales != NULL && i < rank; i++) {
        hid_t scale = H5Dopen2(group, scales[i], H5P_DEFAULT);
        good = H5DSattach_scale(id, scale, (unsigned)i) >= 0;
        H5Dclose(scale);
    }
    H5Sclose(space);
    H5Pclose(access);
    H5Pclose(how);
    if (good)
        return id;
    H5Dclose(id);
    return -1;
}

static ss_status
write_variable(h5_file *file, hid_t group, const variable *v, int rank, const hsize_t dims[],
               const char *const scales[])
{
    hid_t id = new_variable(group, v, rank, dims, scales);
    return id >= 0 && H5Dclose(id) >= 0 ? SS_OK : fail_write(file, group, v->name);
}

/* Extend a dataset's rows to this length, if they are shorter. */
static int
grow(hid_t id, int rank, hsize_t length)
{
    hsize_t dims[2] = { 0, 0 };
    hid_t space = H5Dget_space(id);
    H5Sget_simple_extent_dims(space, dims, NULL);
    H5Sclose(space);
    if (dims[rank - 1] >= length)
        return 1;
    dims[rank - 1] = length;
    return H5Dset_extent(id, dims) >= 0;
}

/* n values of a row, from its at-th on; at[0] is the row, if there are several. */
static int
write_piece(hid_t id, int rank, const hsize_t at[], hsize_t n, hid_t type, const void *values)
{
    hsize_t count[2] = { 1, 1 };
    count[rank - 1] = n;
    if (!grow(id, rank, at[rank - 1] + n))
        return 0;
    hid_t space = H5Dget_space(id), memory = H5Screate_simple(1, &n, NULL);
    int good = H5Sselect_hyperslab(space, H5S_SELECT_SET, at, NULL, count, NULL) >= 0
        && H5Dwrite(id, type, memory, space, H5P_DEFAULT, values) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    return good;
}

static hid_t
write_group(hid_t parent, const char *name)
{
    hid_t plist = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(plist, 0);
    H5Pset_link_creation_order(plist, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    hid_t group = H5Gcreate2(parent, name, H5P_DEFAULT, plist, H5P_DEFAULT);
    H5Pclose(plist);
    return group;
}

/* --- /signal ------------------------------------------------------------------------------- */

static const struct { const char *name, *unit, *long_name; } known[] = {
    { "x", "m",     "displacement" },
    { "v", "m/s",   "velocity" },
    { "a", "m/s^2", "acceleration" },
    { "f", "N",     "friction force" },
    { "y", "m",     "contact deflection" },
    { "z", "m",     "displacement of the base" },
    { "mode", "",   "mode: 0 stick, else the sign of the slip" },
};

static const char *
long_name(const ss_column *column)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(column->name, known[i].name) == 0 && strcmp(column->unit, known[i].unit) == 0)
            return known[i].long_name;
    return column->name;
}

/* A free link name in the group for a column: its own, where HDF5 and the group allow it. */
static void
link_name(char link[256], hid_t group, const char *name)
{
    size_t length = 199;
    if (snprintf(link, length + 1, "%s", name) > (int)length) {
        while (length > 0 && (name[length] & 0xc0) == 0x80)
            length--;                   /* to the start of a character */
        link[length] = '\0';
    }
    for (char *c = link; *c != '\0'; c++)
        if (*c == '/')
            *c = '_';
    if (link[0] == '\0' || strcmp(link, ".") == 0)
        strcpy(link, "_");
    length = strlen(link);
    for (int i = 2; H5Lexists(group, link, H5P_DEFAULT) > 0; i++)
        sprintf(link + length, "_%d", i);
}

/* How many values of each of so many rows that grow together, of bytes in all a column, go into one
 * chunk: a power of two. */
static hsize_t
growing_chunk(size_t bytes)
{
    hsize_t chunk = CHUNK;
    while (chunk > LEAST_CHUNK && (double)chunk * (double)bytes > OPEN_BYTES)
        chunk /= 2;
    return chunk;
}

static ss_status
open_column(ss_store_writer *w, hid_t group, const ss_column *column, hsize_t chunk, hid_t *id)
{
    static const char *const scales[] = { "t" };
    char link[256];
    hsize_t dims = w->length;
    link_name(link, group, column->name);
    const variable v = { .name = link, .unit = column->unit, .long_name = long_name(column),
                         .file_type = H5T_IEEE_F64LE, .chunk = chunk };
    *id = new_variable(group, &v, 1, &dims, scales);
    if (*id < 0 || (strcmp(link, column->name) != 0 && !write_text(*id, "column", column->name)))
        return fail_write(&w->file, group, link);
    return SS_OK;
}

static ss_status
open_signal(ss_store_writer *w, const ss_header *head)
{
    hsize_t dims = w->length, chunk = w->growing ? growing_chunk(8 * (head->n_columns + 1)) : 0;
    const variable t = { .name = "t", .unit = "s", .long_name = "time",
                         .file_type = H5T_IEEE_F64LE, .chunk = chunk };
    hid_t group = write_group(w->file.id, "signal");
    w->column = calloc(head->n_columns + 1, sizeof *w->column);
    if (w->column == NULL)
        return SS_ENOMEM;
    if (group < 0 || !write_number(group, "rate", H5T_IEEE_F64LE, head->rate)
        || !write_number(group, "start", H5T_IEEE_F64LE, head->start)
        || !write_number(group, "has_time", H5T_STD_I8LE, head->has_time)
        || (w->times = new_variable(group, &t, 1, &dims, NULL)) < 0)
        return fail_write(&w->file, 0, "/signal");
    ss_status st = SS_OK;
    for (size_t c = 0; st == SS_OK && c < head->n_columns; c++, w->n_columns++)
        st = open_column(w, group, &head->column[c], chunk, &w->column[c]);
    H5Gclose(group);
    return st;
}

/* Times first ..., first + n - 1 of a scale, or of the samples for NULL. */
static int
write_times(ss_store_writer *w, hid_t id, const ss_scale *scale, size_t first, size_t n)
{
    int good = 1;
    for (size_t m; good && n > 0; first += m, n -= m) {
        hsize_t at = first;
        m = n < CHUNK ? n : CHUNK;
        for (size_t i = 0; i < m; i++)
            w->value[0][i] = w->start + (scale != NULL ? ss_scale_b(scale, first + i)
                                                       : (double)(first + i) / w->rate);
        good = write_piece(id, 1, &at, m, H5T_NATIVE_DOUBLE, w->value[0]);
    }
    return good;
}

static ss_status
write_samples(ss_store_writer *w, const double *x, size_t n, size_t row, size_t column)
{
    if (!write_times(w, w->times, NULL, w->samples, n))
        return fail_write(&w->file, 0, "/signal/t");
    for (size_t c = 0; c < w->n_columns; c++)
        for (size_t i = 0, m; i < n; i += m) {
            hsize_t at = w->samples + i;
            m = n - i < CHUNK ? n - i : CHUNK;
            for (size_t k = 0; k < m; k++)
                w->value[0][k] = x[(i + k) * row + c * column];
            if (!write_piece(w->column[c], 1, &at, m, H5T_NATIVE_DOUBLE, w->value[0]))
                return fail_write(&w->file, 0, "/signal");
        }
    w->samples += n;
    return SS_OK;
}

/* --- /events ------------------------------------------------------------------------------- */

#define KIND_LENGTH 8           /* "reverse" and a NUL */

static ss_status
write_events(h5_file *file, const ss_event *event, size_t n)
{
    static const char *const scales[] = { "t" };
    static const char none;
    hsize_t dims = n;
    hid_t group = write_group(file->id, "events"), text = H5Tcopy(H5T_C_S1);
    double *real = malloc((3 * n + 1) * sizeof *real);      /* t, x, v interleaved */
    char *kind = calloc(n + 1, KIND_LENGTH);
    int *direction = malloc((n + 1) * sizeof *direction);
    ss_status status = real && kind && direction ? SS_OK : SS_ENOMEM;
    H5Tset_size(text, KIND_LENGTH);
    if (status == SS_OK && group < 0)
        status = fail_write(file, 0, "/events");
    for (size_t i = 0; status == SS_OK && i < n; i++) {
        const double row[3] = { event[i].t, event[i].x, event[i].v };
        memcpy(real + 3 * i, row, sizeof row);
        snprintf(kind + i * KIND_LENGTH, KIND_LENGTH, "%s", ss_event_kind_name(event[i].kind));
        direction[i] = event[i].direction;
    }
    const variable v[] = {
        { "t", "s", "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real, 0, 3, 0 },
        { "kind", &none, "what begins: stick, slip, or slip the other way", text, text, kind, 0, 1,
          0 },
        { "x", "m", "displacement", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real, 1, 3, 0 },
        { "v", "m/s", "velocity", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real, 2, 3, 0 },
        { "direction", "1", "sign of the slip that begins, or ended at a stick", H5T_STD_I8LE,
          H5T_NATIVE_INT, direction, 0, 1, 0 },
    };
    for (size_t i = 0; status == SS_OK && i < sizeof v / sizeof *v; i++)
        status = write_variable(file, group, &v[i], 1, &dims, i > 0 ? scales : NULL);
    H5Tclose(text);
    H5Gclose(group);
    free(real);
    free(kind);
    free(direction);
    return status;
}

/* --- /wavelet ------------------------------------------------------------------------------ */

/* One coefficient a sample at every scale, so that all share one line of times? */
static int
is_dense(const ss_store_writer *w)
{
    for (size_t i = 0; i < w->n_scales; i++)
        if (w->scale[i].b_num * w->rate != w->scale[i].b_den
            || (!w->growing && w->scale[i].n != w->n))
            return 0;
    return w->n_scales > 0;
}

/* re, im and edge of n_scales scales from the first on, on a line or on a rectangle. */
static ss_status
open_coefficients(ss_store_writer *w, hid_t group, const ss_header *head, struct rows *rows,
                  const hsize_t dims[], int rank, hsize_t chunk)
{
    static const char *const scales[] = { "scale", "time" };
    const char *unit = head->n_columns > 0 ? head->column[0].unit : "";
    const char *norm = ss_header_find_note(head, "norm");
    int l1 = norm != NULL && strcmp(norm, "l1") == 0;
    char units[256];
    snprintf(units, sizeof units, "%s%s%s", unit, *unit != '\0' && !l1 ? " " : "", l1 ? "" : "s^0.5");
    const variable v[] = {
        { .name = "re", .unit = units, .long_name = "real part of the wavelet coefficient",
          .file_type = H5T_IEEE_F64LE, .chunk = chunk },
        { .name = "im", .unit = units, .long_name = "imaginary part of the wavelet coefficient",
          .file_type = H5T_IEEE_F64LE, .chunk = chunk },
        { .name = "edge", .unit = "1", .long_name = "1 inside the cone of influence",
          .file_type = H5T_STD_U8LE, .chunk = chunk },
    };
    hid_t *const id[] = { &rows->re, &rows->im, &rows->edge };
    for (size_t i = 0; i < sizeof v / sizeof *v; i++) {
        *id[i] = new_variable(group, &v[i], rank, dims, scales + 2 - rank);
        /* CF: the label of a row that is not its index */
        if (*id[i] < 0 || (rank == 2 && !write_text(*id[i], "coordinates", "frequency")))
            return fail_write(&w->file, group, v[i].name);
    }
    return SS_OK;
}

static ss_status
open_times(ss_store_writer *w, hid_t group, size_t n, hsize_t chunk, hid_t *id)
{
    hsize_t dims = n;
    const variable v = { .name = "time", .unit = "s", .long_name = "time",
                         .file_type = H5T_IEEE_F64LE, .chunk = chunk };
    *id = new_variable(group, &v, 1, &dims, NULL);
    return *id >= 0 ? SS_OK : fail_write(&w->file, group, v.name);
}

static int
write_lattice(hid_t object, const ss_scale *scale)
{
    return write_number(object, "b_num", H5T_IEEE_F64LE, scale->b_num)
           && write_number(object, "b_den", H5T_IEEE_F64LE, scale->b_den);
}

static ss_status
open_dense(ss_store_writer *w, hid_t group, const ss_header *head)
{
    static const char *const scales[] = { "scale" };
    hsize_t dims[2] = { w->n_scales, w->n };
    hsize_t chunk = w->growing ? growing_chunk(17 * w->n_scales) : 0;
    double *row = malloc(4 * w->n_scales * sizeof *row);
    if (row == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < w->n_scales; i++) {
        const double of[4] = { w->scale[i].a, w->scale[i].f, w->scale[i].m, w->scale[i].j };
        memcpy(row + 4 * i, of, sizeof of);
    }
    const variable v[] = {
        { "scale", "s", "scale a", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, row, 0, 4, 0 },
        { "frequency", "Hz", "frequency label omega_c / (2 pi a)", H5T_IEEE_F64LE,
          H5T_NATIVE_DOUBLE, row, 1, 4, 0 },
        { "m", "1", "log2 of the scale in seconds", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, row, 2, 4,
          0 },
        { "j", "1", "number of the scale, a = 2^(j/voices) s", H5T_STD_I32LE, H5T_NATIVE_DOUBLE,
          row, 3, 4, 0 },
    };
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < sizeof v / sizeof *v; i++)
        st = write_variable(&w->file, group, &v[i], 1, dims, i > 0 ? scales : NULL);
    free(row);
    if (st == SS_OK && !write_lattice(group, &w->scale[0]))
        st = fail_write(&w->file, 0, "/wavelet");
    if (st == SS_OK)
        st = open_times(w, group, w->n, chunk, &w->rows->time);
    return st == SS_OK ? open_coefficients(w, group, head, w->rows, dims, 2, chunk) : st;
}

static ss_status
open_scale(ss_store_writer *w, hid_t parent, const ss_header *head, size_t i)
{
    const ss_scale *scale = &w->scale[i];
    hsize_t dims = w->growing ? 0 : scale->n;
    hsize_t chunk = w->growing ? growing_chunk(25 * w->n_scales) : 0;
    char name[32];
    snprintf(name, sizeof name, "scale%03zu", i);
    hid_t group = write_group(parent, name);
    if (group < 0 || !write_number(group, "m", H5T_IEEE_F64LE, scale->m)
        || !write_number(group, "scale", H5T_IEEE_F64LE, scale->a)
        || !write_number(group, "frequency", H5T_IEEE_F64LE, scale->f)
        || !write_number(group, "j", H5T_STD_I32LE, scale->j) || !write_lattice(group, scale))
        return fail_write(&w->file, parent, name);
    ss_status st = open_times(w, group, dims, chunk, &w->rows[i].time);
    if (st == SS_OK)
        st = open_coefficients(w, group, head, &w->rows[i], &dims, 1, chunk);
    H5Gclose(group);
    return st;
}

static ss_status
copy_grid(ss_store_writer *w, const ss_coefficients *grid)
{
    w->n_scales = grid->n_scales;
    w->scale = malloc((grid->n_scales + 1) * sizeof *w->scale);
    w->rows = malloc((grid->n_scales + 1) * sizeof *w->rows);
    if (w->scale == NULL || w->rows == NULL)
        return SS_ENOMEM;
    memcpy(w->scale, grid->scale, grid->n_scales * sizeof *w->scale);
    for (size_t i = 0; i <= grid->n_scales; i++)
        w->rows[i] = (struct rows){ -1, -1, -1, -1, 0 };
    w->dense = is_dense(w);
    return ss_header_gaps(&w->gap, &w->n_gaps, grid->head);
}

static ss_status
open_wavelet(ss_store_writer *w, const ss_coefficients *grid)
{
    const ss_header *head = grid->head;
    const ss_column none = { "", "" }, *column = head->n_columns > 0 ? head->column : &none;
    ss_status st = copy_grid(w, grid);
    if (st != SS_OK)
        return st;
    w->wavelet = write_group(w->file.id, "wavelet");
    if (w->wavelet < 0 || !write_text(w->wavelet, "column", column->name)
        || !write_text(w->wavelet, "column_units", column->unit)
        || !write_number(w->wavelet, "rate", H5T_IEEE_F64LE, head->rate)
        || !write_number(w->wavelet, "start", H5T_IEEE_F64LE, head->start)
        || !write_number(w->wavelet, "has_time", H5T_STD_I8LE, head->has_time)
        || !write_number(w->wavelet, "center", H5T_IEEE_F64LE, grid->center)
        || !write_number(w->wavelet, "dense", H5T_STD_I8LE, w->dense)
        || !write_number(w->wavelet, "scales", H5T_STD_I32LE, (double)w->n_scales))
        return fail_write(&w->file, 0, "/wavelet");
    if (w->dense)
        return open_dense(w, w->wavelet, head);
    for (size_t i = 0; st == SS_OK && i < w->n_scales; i++)
        st = open_scale(w, w->wavelet, head, i);
    return st;
}

/* Are all coefficients there that a scale has in a record of so many samples? */
static int
is_full(const ss_store_writer *w, size_t i, size_t samples)
{
    double last = (double)(samples - 1) / w->rate;
    size_t done = w->rows[i].done;
    if (!w->growing)
        return done == w->scale[i].n;
    return done > 0 && ss_scale_b(&w->scale[i], done - 1) <= last
        && ss_scale_b(&w->scale[i], done) > last;
}

static int
close_rows(struct rows *r)
{
    hid_t *const id[] = { &r->time, &r->re, &r->im, &r->edge };
    int good = 1;
    for (size_t i = 0; i < sizeof id / sizeof *id; i++) {
        good &= *id[i] < 0 || H5Dclose(*id[i]) >= 0;
        *id[i] = -1;
    }
    return good;
}

/* n coefficients of scale i, as many as fit into a piece. */
static int
write_rows(ss_store_writer *w, size_t i, size_t n, const double *x, size_t samples)
{
    const ss_scale *scale = &w->scale[i];
    struct rows *rows = &w->rows[w->dense ? 0 : i];
    size_t first = w->rows[i].done;
    int rank = w->dense ? 2 : 1;
    const hsize_t where[2] = { i, first }, *at = where + 2 - rank;
    for (size_t k = 0; k < n; k++) {
        w->value[0][k] = x[2 * k];
        w->value[1][k] = x[2 * k + 1];
        w->edge[k] = (unsigned char)(ss_scale_edge(scale, first + k, samples, w->rate)
            || ss_gaps_near(w->gap, w->n_gaps, w->start + ss_scale_b(scale, first + k),
                           sqrt(2) * scale->a));
    }
    return write_piece(rows->re, rank, at, n, H5T_NATIVE_DOUBLE, w->value[0])
        && write_piece(rows->im, rank, at, n, H5T_NATIVE_DOUBLE, w->value[1])
        && write_piece(rows->edge, rank, at, n, H5T_NATIVE_UCHAR, w->edge)
        && (w->dense || write_times(w, rows->time, scale, first, n));
}

static ss_status
write_scale(ss_store_writer *w, size_t i, size_t n, const double *x, size_t samples)
{
    for (size_t m; n > 0; n -= m, x += 2 * m) {
        m = n < CHUNK ? n : CHUNK;
        if (!write_rows(w, i, m, x, samples))
            return fail_write(&w->file, w->wavelet, "re");
        w->rows[i].done += m;
    }
    if (!w->dense && !w->growing && w->rows[i].done == w->scale[i].n && !close_rows(&w->rows[i]))
        return fail_write(&w->file, w->wavelet, "re");
    return SS_OK;
}

/* --- the file ------------------------------------------------------------------------------ */

static ss_status
write_notes(ss_store_writer *w, const ss_header *head)
{
    if (!write_text(w->file.id, H5_VERSION_NOTE, SS_VERSION))
        return fail_write(&w->file, 0, "/");
    for (size_t i = 0; head != NULL && i < head->n_notes; i++) {
        const char *colon = strstr(head->note[i], ": ");
        size_t length = colon != NULL ? (size_t)(colon - head->note[i]) : strlen(head->note[i]);
        char *key = strndup(head->note[i], length);
        if (key == NULL)
            return SS_ENOMEM;
        int good = H5Aexists(w->file.id, key) > 0
                   || write_text(w->file.id, key, colon != NULL ? colon + 2 : "");
        free(key);
        if (!good)
            return fail_write(&w->file, 0, head->note[i]);
    }
    return SS_OK;
}

static hid_t
create_file(const char *path, hid_t access)
{
    hid_t how = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);   /* read by everyone since 2008 */
    H5Pset_obj_track_times(how, 0);
    H5Pset_link_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Pset_attr_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    hid_t id = H5Fcreate(path, H5F_ACC_TRUNC, how, access);
    H5Pclose(how);
    return id;
}

/* Open what path names.  Where HDF5 cannot go to and fro in it, a device or a FIFO, it gets a file
 * without a name, to be copied in the end. */
static ss_status
open_disk(ss_store_writer *w)
{
    struct stat st;
    w->spooled = stat(w->file.path, &st) == 0 && !S_ISREG(st.st_mode);
    FILE *spool = w->spooled ? tmpfile() : NULL;
    w->disk.fd = spool != NULL ? dup(fileno(spool))
        : w->spooled ? -1 : open(w->file.path, O_RDWR | O_CREAT | O_TRUNC, 0666);
    int why = errno;
    if (spool != NULL)
        fclose(spool);
    return w->disk.fd >= 0 ? SS_OK : ss_fail_errno(w->file.err, w->file.path, why);
}

static ss_status
open_file(ss_store_writer *w)
{
    ss_status st = open_disk(w);
    if (st != SS_OK)
        return st;
    hid_t access = ss_h5_disk_access(&w->disk);
    if (access < 0)
        return SS_ENOMEM;
    w->file.id = create_file(w->file.path, access);
    H5Pclose(access);
    return w->file.id >= 0 ? SS_OK : SS_ENOMEM;
}

static int
copy_out(const ss_store_writer *w)
{
    char piece[BUFSIZ];
    FILE *out = fopen(w->file.path, "wb");
    off_t at = 0;
    ssize_t n = 1;
    if (out == NULL)
        return errno;
    while (n > 0 && (n = pread(w->disk.fd, piece, sizeof piece, at)) > 0) {
        at += n;
        if (fwrite(piece, 1, (size_t)n, out) != (size_t)n)
            n = -1;
    }
    int why = n < 0 ? errno : 0;
    return fclose(out) != 0 && why == 0 ? errno : why;
}

/* Let HDF5 write its buffers and close the file. */
static ss_status
close_hdf5(ss_store_writer *w, ss_status st)
{
    int good = w->file.id < 0 || H5Fclose(w->file.id) >= 0;    /* closes all that is open in it */
    w->file.id = -1;
    return st == SS_OK && !good ? fail_write(&w->file, 0, "") : st;
}

/* Close everything.  An incomplete file is removed. */
static ss_status
close_file(ss_store_writer *w, ss_status st)
{
    struct stat is;
    st = close_hdf5(w, st);
    if (w->disk.fd < 0)
        return st;
    if (st == SS_OK && w->disk.error == 0 && w->spooled)
        w->disk.error = copy_out(w);
    if (close(w->disk.fd) != 0 && w->disk.error == 0)
        w->disk.error = errno;
    w->disk.fd = -1;
    if (w->disk.error != 0)
        st = ss_fail_errno(w->file.err, w->file.path, w->disk.error);
    if (st != SS_OK && !w->spooled && stat(w->file.path, &is) == 0 && S_ISREG(is.st_mode))
        unlink(w->file.path);
    return st;
}

/* A full disk is reported at once; the first failure is kept. */
static ss_status
keep(ss_store_writer *w, ss_status st)
{
    if (st == SS_OK && w->disk.error != 0)
        st = ss_fail_errno(w->file.err, w->file.path, w->disk.error);
    if (st == SS_ENOMEM)
        ss_fail(w->file.err, st, "%s: %s", w->file.path, ss_strerror(st));
    if (st != SS_OK)
        w->status = st;
    return st;
}

static ss_status
make_writer(ss_store_writer **out, const char *path)
{
    ss_store_writer *w = *out = calloc(1, sizeof *w);
    if (w == NULL)
        return SS_ENOMEM;
    w->file = (h5_file){ .id = -1, .path = w->path = strdup(path), .err = &w->error };
    w->disk.fd = -1;
    for (int i = 0; i < 2; i++)
        w->value[i] = malloc(CHUNK * sizeof *w->value[i]);
    w->edge = malloc(CHUNK);
    return w->path != NULL && w->value[0] != NULL && w->value[1] != NULL && w->edge != NULL
        ? open_file(w) : SS_ENOMEM;
}

/* Notes, and the clock of all that follows. */
static ss_status
begin(ss_store_writer **out, const char *path, const ss_header *head)
{
    ss_status st = make_writer(out, path);
    if (st != SS_OK)
        return st;
    (*out)->rate = head != NULL ? head->rate : 1;
    (*out)->start = head != NULL ? head->start : 0;
    return write_notes(*out, head);
}

static ss_status
begin_empty(ss_store_writer **out, const char *path, const ss_header *signal,
            const ss_coefficients *grid)
{
    ss_status st = begin(out, path, grid->head);
    ss_store_writer *w = *out;
    if (st != SS_OK)
        return st;
    w->n = w->length = grid->n;
    w->growing = grid->n == 0;
    if (signal != NULL)
        st = open_signal(w, signal);
    return st == SS_OK ? open_wavelet(w, grid) : st;
}

/* --- public -------------------------------------------------------------------------------- */

static ss_status
tell(const ss_store_writer *w, ss_status st, ss_error *err)
{
    if (st != SS_OK && err != NULL)
        *err = w->error;
    return st;
}

ss_status
ss_store_writer_new(ss_store_writer **out, const char *path, const ss_header *signal,
                    const ss_coefficients *grid, ss_error *err)
{
    ss_store_writer *w = NULL;
    ss_status st;
    if (out == NULL || path == NULL || grid == NULL || grid->head == NULL || grid->n_scales == 0)
        return SS_FAIL_NULL(err);
    H5E_BEGIN_TRY {
        st = begin_empty(&w, path, signal, grid);
        if (w != NULL)
            st = keep(w, st);
    } H5E_END_TRY
    if (st == SS_OK)
        *out = w;
    else if (w != NULL)
        tell(w, st, err);
    if (st != SS_OK)
        ss_store_writer_free(w);
    return st;
}

ss_status
ss_store_writer_signal(ss_store_writer *w, const double *x, size_t n, size_t row, size_t column,
                       ss_error *err)
{
    if (w == NULL || (x == NULL && n > 0))
        return SS_FAIL_NULL(err);
    ss_status st = w->status;
    H5E_BEGIN_TRY {
        if (st == SS_OK && (w->column == NULL || (!w->growing && n > w->length - w->samples)))
            st = ss_fail(&w->error, SS_EINVAL, "more samples than the file was begun with");
        if (st == SS_OK)
            st = write_samples(w, x, n, row, column);
        st = keep(w, st);
    } H5E_END_TRY
    return tell(w, st, err);
}

ss_status
ss_store_writer_rows(ss_store_writer *writer, const ss_scale *scale, size_t first, size_t n,
                     const double *w, size_t samples, ss_error *err)
{
    size_t i = 0;
    if (writer == NULL || scale == NULL || (w == NULL && n > 0))
        return SS_FAIL_NULL(err);
    ss_status st = writer->status;
    while (i < writer->n_scales && writer->scale[i].j != scale->j)
        i++;
    H5E_BEGIN_TRY {
        if (st == SS_OK && (i == writer->n_scales || writer->rows[i].done != first
                            || (!writer->growing && n > writer->scale[i].n - first)))
            st = ss_fail(&writer->error, SS_EINVAL,
                         "coefficients that are not the next of a scale");
        if (st == SS_OK)
            st = write_scale(writer, i, n, w, samples);
        st = keep(writer, st);
    } H5E_END_TRY
    return tell(writer, st, err);
}

/* Known only at the end: the length, and the times that all scales share. */
static ss_status
complete(ss_store_writer *w, size_t samples)
{
    if (samples < 1 || (!w->growing && samples != w->n)
        || (w->column != NULL && w->samples != (w->growing ? samples : w->length)))
        return ss_fail(&w->error, SS_EINVAL, "%zu samples are not what the file has", samples);
    for (size_t i = 0; i < w->n_scales; i++)
        if (!is_full(w, i, samples))
            return ss_fail(&w->error, SS_EINVAL, "coefficients of scale %g are missing",
                           w->scale[i].m);
    char text[SS_NUMBER_MAX];
    ss_number_format(text, (double)samples);
    if ((w->dense && !write_times(w, w->rows->time, &w->scale[0], 0, samples))
        || (H5Aexists(w->file.id, "samples") <= 0 && !write_text(w->file.id, "samples", text))
        || !write_number(w->wavelet, "samples", H5T_STD_I64LE, (double)samples))
        return fail_write(&w->file, 0, "/wavelet");
    return SS_OK;
}

ss_status
ss_store_writer_end(ss_store_writer *w, size_t samples, ss_error *err)
{
    if (w == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = w->status;
    H5E_BEGIN_TRY {
        if (st == SS_OK && w->file.id < 0)
            st = ss_fail(&w->error, SS_EINVAL, "the file is complete");
        if (st == SS_OK)
            st = complete(w, samples);
        st = keep(w, close_file(w, st));
    } H5E_END_TRY
    return tell(w, st, err);
}

void
ss_store_writer_free(ss_store_writer *w)
{
    if (w == NULL)
        return;
    H5E_BEGIN_TRY {
        close_file(w, SS_STOP);         /* unless it has ended */
    } H5E_END_TRY
    free(w->path);
    free(w->column);
    free(w->scale);
    free(w->rows);
    free(w->gap);
    free(w->value[0]);
    free(w->value[1]);
    free(w->edge);
    free(w);
}

static ss_status
write_all(ss_store_writer **out, const char *path, const ss_record *r)
{
    const ss_signal *signal = r->signal;
    const ss_coefficients *c = r->coefficients;
    ss_status st = begin(out, path, c != NULL ? c->head : signal != NULL ? signal->head : NULL);
    ss_store_writer *w = *out;
    if (st == SS_OK && signal != NULL) {
        w->length = signal->n;
        if ((st = open_signal(w, signal->head)) == SS_OK)
            st = write_samples(w, signal->values, signal->n, 1, signal->n);
    }
    if (st == SS_OK && (r->has_events || r->n_events > 0))
        st = write_events(&w->file, r->events, r->n_events);
    if (st != SS_OK || c == NULL)
        return st;
    w->n = c->n;
    st = open_wavelet(w, c);
    for (size_t i = 0; st == SS_OK && i < c->n_scales; i++)
        st = write_scale(w, i, c->scale[i].n, c->w + 2 * c->scale[i].offset, c->n);
    return st == SS_OK ? complete(w, c->n) : st;
}

ss_status
ss_store_write(const char *path, const ss_record *r, ss_error *err)
{
    ss_store_writer *w = NULL;
    ss_status st;
    if (path == NULL || r == NULL)
        return SS_FAIL_NULL(err);
    H5E_BEGIN_TRY {
        st = write_all(&w, path, r);
        if (w != NULL)
            st = keep(w, close_file(w, st));
    } H5E_END_TRY
    if (w != NULL)
        tell(w, st, err);
    else
        ss_fail(err, st, "%s: %s", path, ss_strerror(st));
    ss_store_writer_free(w);
    return st;
}
