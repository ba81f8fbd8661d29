/* writer.c -- a file in HDF5: samples, events and coefficients as they come, so that xarray, MATLAB and h5dump
 * understand them directly.
 *
 * /signal has a dataset for each column; /events has datasets of one length; /wavelet has a group a scale, or one
 * rectangle if all scales have one coefficient a sample.  Every dataset has units and long_name and is attached to
 * its dimension scales.  Where the number of samples and coefficients is known, the datasets of a scale are closed
 * when they are full.  If it is not, all datasets stay open, with chunks so short that one of each fits into
 * memory; rows then go to one chunk of each column after the other, however they come.
 *
 * The same input gives the same bytes: creation times are not tracked, file types are little-endian, links are
 * kept in the order of writing.  A file is whole or absent.  After the first failure nothing is written. */
#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/error.h"
#include "base/list.h"
#include "base/versions.h"
#include "io/hdf5/h5.h"
#include "io/format.h"
#include "map/map.h"
#include "scene/scene.h"
#include "signal/gaps.h"
#include "signal/header.h"

enum { PIECE = 65536,           /* the most values in a chunk, and in one write */
       PLAIN_BYTES = 65536,     /* a dataset up to this size is stored without compression */
       LEAST_ROW = 2048,        /* shorter rows share chunks */
       OPEN_BYTES = 32 << 20,   /* about so much are all chunks in memory if lengths are not known */
       LEAST_CHUNK = 256 };

/* One dataset to be written. */
typedef struct dataset {
    const char *name, *unit, *long_name;
    hid_t type;                 /* in the file */
    const void *values;         /* doubles, or texts as in the file; NULL: they are written later */
    hsize_t chunk;              /* 0: as its size says; else its last dimension grows, and it is
                                   kept in chunks of so many values of a row */
    int in_rows;                /* 1: it is written row by row, and each has chunks of its own */
} dataset;

enum { TIME, RE, IM, EDGE, PARTS };
struct scale_datasets {
    hid_t group;                /* of a stepped scale: it is open until the first coefficients come */
    hid_t part[PARTS];          /* < 0: it is not open */
    int single;                 /* re and im are 32-bit floats */
    size_t done;
    double most;                /* the largest |W| so far */
};

typedef struct h5_writer {
    ss_writer base;
    h5_file file;               /* its path is to be freed */
    ss_error error;
    double rate, start;
    size_t length;              /* of the record; 0: it is known only at the end */
    int ended;

    hid_t *column, times;       /* of /signal, which has a dataset for each column; NULL: there is none */
    size_t n_columns, samples;  /* samples: written so far */
    size_t piece;               /* of each column, that are written at a time */

    int has_events;
    ss_event *event;
    size_t n_events, room;

    size_t n_scales, n_gaps;    /* of /wavelet; 0: there is none */
    ss_scale *scale;
    ss_span *gap;
    char *unit;                 /* of the coefficients */
    double tolerance;           /* of rounding, re the largest |W| of a scale; 0: all bits stay */
    int dense;
    hid_t group;
    struct scale_datasets *datasets;    /* of each scale; if dense, the first holds those of all */

    double value[2][PIECE];     /* room for a piece of re and im, or of other values */
    float single[PIECE];
    unsigned char edge[PIECE];
} h5_writer;

/* A call of HDF5 fails for lack of memory, or for a name or size that it cannot store; disk.c hides a
 * full disk from it. */
static void
fail(h5_writer *w, hid_t group, const char *name)
{
    ss_h5_fail(&w->file, SS_EIO, group, name, "HDF5 cannot store it, or is out of memory");
}

/* --- attributes, groups and datasets -------------------------------------------------------- */

static void
write_attribute(h5_writer *w, hid_t object, const char *name, hid_t in_file, hid_t in_memory, const void *value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t id = w->file.status == SS_OK ? H5Acreate2(object, name, in_file, space, H5P_DEFAULT, H5P_DEFAULT) : -1;
    if (id < 0 || H5Awrite(id, in_memory, value) < 0)
        fail(w, object, name);
    H5Aclose(id);
    H5Sclose(space);
}

static void
write_number(h5_writer *w, hid_t object, const char *name, hid_t type, double value)
{
    write_attribute(w, object, name, type, H5T_NATIVE_DOUBLE, &value);
}

static void
write_text(h5_writer *w, hid_t object, const char *name, const char *value)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(value) + 1);
    H5Tset_cset(type, H5T_CSET_UTF8);
    write_attribute(w, object, name, type, type, value);
    H5Tclose(type);
}

static hid_t
new_group(h5_writer *w, hid_t parent, const char *name)
{
    hid_t how = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(how, 0);
    H5Pset_link_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    hid_t group = w->file.status == SS_OK ? H5Gcreate2(parent, name, H5P_DEFAULT, how, H5P_DEFAULT) : -1;
    H5Pclose(how);
    if (group < 0)
        fail(w, parent, name);
    return group;
}

/* The layout of a dataset: if it is large, in compressed chunks along the last dimension.  If it grows, its cache
 * has room for one chunk of each row. */
static void
lay_out(const dataset *v, int rank, const hsize_t dims[], hid_t how, hid_t access)
{
    hsize_t chunk[2] = { 1, 1 }, values = 1;
    const size_t rows = rank == 2 ? (size_t)dims[0] : 1, size = H5Tget_size(v->type);
    H5Pset_obj_track_times(how, 0);
    for (int i = 0; i < rank; i++)
        values *= dims[i];
    if (v->chunk > 0)
        H5Pset_chunk_cache(access, 128 * rows + 1, rows * (size_t)v->chunk * size, 1);
    else if (values * size <= PLAIN_BYTES)
        return;
    hsize_t row = v->chunk > 0 ? v->chunk : dims[rank - 1] < PIECE ? dims[rank - 1] : PIECE;
    chunk[rank - 1] = row;
    if (rank == 2 && v->chunk == 0 && !(v->in_rows && row >= LEAST_ROW))
        chunk[0] = PIECE / row < dims[0] ? PIECE / row : dims[0];
    H5Pset_chunk(how, rank, chunk);
    if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0) {
        H5Pset_shuffle(how);
        H5Pset_deflate(how, v->in_rows ? 1 : 4);
    }
}

/* Make one dataset on the given dimension scales (NULL: it is a scale itself; { NULL }: on none), and
 * write its values if it has any. */
static hid_t
new_dataset(h5_writer *w, hid_t group, const dataset *v, int rank, const hsize_t dims[],
            const char *const scales[])
{
    hsize_t most[2] = { dims[0], dims[rank - 1] };
    if (w->file.status != SS_OK)
        return -1;
    most[rank - 1] = v->chunk > 0 ? H5S_UNLIMITED : dims[rank - 1];
    hid_t how = H5Pcreate(H5P_DATASET_CREATE), access = H5Pcreate(H5P_DATASET_ACCESS);
    hid_t space = H5Screate_simple(rank, dims, most);
    lay_out(v, rank, dims, how, access);
    hid_t id = H5Dcreate2(group, v->name, v->type, space, H5P_DEFAULT, how, access);
    H5Sclose(space);
    H5Pclose(access);
    H5Pclose(how);
    if (id < 0)
        fail(w, group, v->name);
    write_text(w, id, "units", v->unit);
    write_text(w, id, "long_name", v->long_name);
    int good = w->file.status == SS_OK;
    if (good && v->values != NULL && dims[0] > 0)
        good = H5Dwrite(id, H5Tget_class(v->type) == H5T_STRING ? v->type : H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                        H5P_DEFAULT, v->values) >= 0;
    if (good && scales == NULL)
        good = H5DSset_scale(id, v->name) >= 0;
    for (int i = 0; good && scales != NULL && i < rank && scales[i] != NULL; i++) {
        hid_t scale = H5Dopen2(group, scales[i], H5P_DEFAULT);
        good = H5DSattach_scale(id, scale, (unsigned)i) >= 0;
        H5Dclose(scale);
    }
    if (good)
        return id;
    fail(w, group, v->name);
    H5Dclose(id);
    return -1;
}

/* Write n lists of one length; the first is the scale of the others.  values of each are doubles, ints or texts as
 * its type says; of numbers they point to the first, and the next is so many bytes apart. */
static void
write_lists(h5_writer *w, hid_t group, const dataset v[], size_t n, size_t length, size_t apart)
{
    const char *const scales[] = { v[0].name };
    hsize_t dims = length;
    double *x = malloc((length + 1) * sizeof *x);
    w->file.status = w->file.status == SS_OK && x == NULL ? SS_ENOMEM : w->file.status;
    for (size_t i = 0; w->file.status == SS_OK && i < n; i++) {
        dataset list = v[i];
        H5T_class_t class = H5Tget_class(list.type);
        for (size_t k = 0; class != H5T_STRING && k < length; k++) {
            const void *at = (const char *)list.values + k * apart;
            x[k] = class == H5T_INTEGER ? *(const int *)at : *(const double *)at;
        }
        list.values = class == H5T_STRING ? list.values : x;
        if (H5Dclose(new_dataset(w, group, &list, 1, &dims, i > 0 ? scales : NULL)) < 0)
            fail(w, group, list.name);
    }
    free(x);
}

/* Write n values of a row, from its at-th on; at[0] is the row, if there are several.  A dataset that is too
 * short grows. */
static void
write_values(h5_writer *w, hid_t id, int rank, const hsize_t at[], hsize_t n, hid_t type, const void *values)
{
    hsize_t count[2] = { 1, 1 }, dims[2], end = at[rank - 1] + n;
    if (w->file.status != SS_OK)
        return;
    hid_t space = H5Dget_space(id), memory = H5Screate_simple(1, &n, NULL);
    count[rank - 1] = n;
    if (H5Sget_simple_extent_dims(space, dims, NULL) == rank && dims[rank - 1] < end) {
        dims[rank - 1] = end;
        H5Sclose(space);
        space = H5Dset_extent(id, dims) >= 0 ? H5Dget_space(id) : -1;
    }
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, at, NULL, count, NULL) < 0
        || H5Dwrite(id, type, memory, space, H5P_DEFAULT, values) < 0)
        fail(w, id, "");
    H5Sclose(memory);
    H5Sclose(space);
}

static void
write_clock(h5_writer *w, hid_t group, const ss_header *head)
{
    write_number(w, group, "rate", H5T_IEEE_F64LE, head->rate);
    write_number(w, group, "start", H5T_IEEE_F64LE, head->start);
    write_number(w, group, "has_time", H5T_STD_I8LE, head->has_time);
}

/* The number of values of a row in one chunk, a power of two, for rows that grow together; bytes: the size of a
 * column of all rows.  0: the length is known. */
static hsize_t
chunk_of(const h5_writer *w, size_t bytes)
{
    hsize_t chunk = PIECE;
    while (chunk > LEAST_CHUNK && (double)chunk * (double)bytes > OPEN_BYTES)
        chunk /= 2;
    return w->length == 0 ? chunk : 0;
}

/* Write the times first ..., first + n - 1 of a scale, or of the samples for NULL. */
static void
write_times(h5_writer *w, hid_t id, const ss_scale *scale, size_t first, size_t n)
{
    double *t = w->value[0];
    for (size_t m; w->file.status == SS_OK && n > 0; first += m, n -= m) {
        hsize_t at = first;
        m = n < PIECE ? n : PIECE;
        for (size_t i = 0; i < m; i++)
            t[i] = w->start + (scale != NULL ? ss_scale_b(scale, first + i) : (double)(first + i) / w->rate);
        write_values(w, id, 1, &at, m, H5T_NATIVE_DOUBLE, t);
    }
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

/* Choose the name of a column's link in a group: its own name if HDF5 allows it and it is not used. */
static void
link_name(char link[256], hid_t group, const char *name)
{
    size_t length = 199;
    if (snprintf(link, length + 1, "%s", name) > (int)length) {
        while (length > 0 && (name[length] & 0xc0) == 0x80)
            length--;                   /* back to the start of a character */
        link[length] = '\0';
    }
    if (strcmp(link, ".") == 0)
        strcpy(link, "_");
    length = strlen(link);
    for (int i = 2; H5Lexists(group, link, H5P_DEFAULT) > 0; i++)
        sprintf(link + length, "_%d", i);
}

/* For each column that is attached to t, HDF5 writes the list of all of them again.  A list of more than
 * 64 kB is not replaced but appended each time: 32768 columns would take a minute and 1 GB. */
enum { MOST_ATTACHED = 4000 };

static void
begin_signal(h5_writer *w, const ss_header *head)
{
    const char *const scales[] = { head->n_columns <= MOST_ATTACHED ? "t" : NULL };
    hsize_t dims = w->length;
    dataset v = { .name = "t", .unit = "s", .long_name = "time", .type = H5T_IEEE_F64LE,
                  .chunk = chunk_of(w, 8 * (head->n_columns + 1)) };
    hid_t group = new_group(w, w->file.id, "signal");
    w->piece = v.chunk > 0 ? (size_t)v.chunk : PIECE;
    if ((w->column = calloc(head->n_columns + 1, sizeof *w->column)) == NULL && w->file.status == SS_OK)
        w->file.status = SS_ENOMEM;
    write_clock(w, group, head);
    w->times = new_dataset(w, group, &v, 1, &dims, NULL);
    for (; w->file.status == SS_OK && w->n_columns < head->n_columns; w->n_columns++) {
        const ss_column *column = &head->column[w->n_columns];
        char link[256];
        link_name(link, group, column->name);
        v.name = link;
        v.unit = column->unit;
        v.long_name = column->name;
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            if (strcmp(column->name, known[i].name) == 0 && strcmp(column->unit, known[i].unit) == 0)
                v.long_name = known[i].long_name;
        w->column[w->n_columns] = new_dataset(w, group, &v, 1, &dims, scales);
        if (strcmp(link, column->name) != 0)
            write_text(w, w->column[w->n_columns], "column", column->name);
    }
    H5Gclose(group);
}

/* --- /events ------------------------------------------------------------------------------- */

static void
write_all_events(h5_writer *w)
{
    enum { KIND_LENGTH = 8 };           /* "reverse" and a NUL */
    static const ss_event none;
    const ss_event *event = w->event != NULL ? w->event : &none;
    hid_t group = new_group(w, w->file.id, "events"), text = H5Tcopy(H5T_C_S1);
    char *kind = calloc(w->n_events + 1, KIND_LENGTH);
    H5Tset_size(text, KIND_LENGTH);
    for (size_t i = 0; kind != NULL && i < w->n_events; i++)
        snprintf(kind + i * KIND_LENGTH, KIND_LENGTH, "%s", ss_event_kind_name(event[i].kind));
    const dataset v[] = {
        { "t", "s", "time", H5T_IEEE_F64LE, &event->t, 0, 0 },
        { "kind", "", "what begins: stick, slip, or slip the other way", text, kind, 0, 0 },
        { "x", "m", "displacement", H5T_IEEE_F64LE, &event->x, 0, 0 },
        { "v", "m/s", "velocity", H5T_IEEE_F64LE, &event->v, 0, 0 },
        { "direction", "1", "sign of the slip that begins, or ended at a stick", H5T_STD_I8LE,
          &event->direction, 0, 0 },
    };
    if (kind == NULL && w->file.status == SS_OK)
        w->file.status = SS_ENOMEM;
    write_lists(w, group, v, sizeof v / sizeof *v, w->n_events, sizeof *event);
    H5Tclose(text);
    H5Gclose(group);
    free(kind);
}

/* --- /wavelet ------------------------------------------------------------------------------ */

/* Take the grid.  It is dense if every scale has one coefficient a sample: all share one dataset of times. */
static ss_status
copy_grid(h5_writer *w, const ss_coefficients *grid)
{
    const char *of = grid->head->n_columns > 0 ? grid->head->column[0].unit : "";
    const char *norm = ss_header_find_note(grid->head, "norm");
    const char *accuracy = ss_header_find_note(grid->head, "accuracy");
    int l1 = norm != NULL && strcmp(norm, "l1") == 0;
    size_t size = strlen(of) + sizeof " s^0.5";
    w->n_scales = grid->n_scales;
    w->scale = malloc((grid->n_scales + 1) * sizeof *w->scale);
    w->datasets = calloc(grid->n_scales + 1, sizeof *w->datasets);
    w->unit = malloc(size);
    if (w->scale == NULL || w->datasets == NULL || w->unit == NULL)
        return SS_ENOMEM;
    snprintf(w->unit, size, "%s%s%s", of, *of != '\0' && !l1 ? " " : "", l1 ? "" : "s^0.5");
    if (ss_header_find_note(grid->head, "rounded") != NULL && accuracy != NULL)
        w->tolerance = strtod(accuracy, NULL);
    memcpy(w->scale, grid->scale, grid->n_scales * sizeof *w->scale);
    w->dense = 1;
    for (size_t i = 0; i <= grid->n_scales; i++)
        w->datasets[i] = (struct scale_datasets){ .part = { -1, -1, -1, -1 } };
    for (size_t i = 0; i < w->n_scales; i++)
        w->dense &= w->scale[i].b_num * w->rate == w->scale[i].b_den
            && (w->length == 0 || w->scale[i].n == w->length);
    return ss_header_gaps(&w->gap, &w->n_gaps, grid->head, NULL);
}

static void
write_lattice(h5_writer *w, hid_t object, const ss_scale *scale)
{
    write_number(w, object, "b_num", H5T_IEEE_F64LE, scale->b_num);
    write_number(w, object, "b_den", H5T_IEEE_F64LE, scale->b_den);
}

/* The scales as lists, and the lattice that all share, or else a group for each. */
static void
begin_wavelet(h5_writer *w, const ss_coefficients *grid)
{
    const ss_header *head = grid->head;
    const ss_column none = { "", "" }, *column = head->n_columns > 0 ? head->column : &none;
    if (w->file.status == SS_OK)
        w->file.status = copy_grid(w, grid);
    if (w->file.status != SS_OK)
        return;
    w->group = new_group(w, w->file.id, "wavelet");
    write_text(w, w->group, "column", column->name);
    write_text(w, w->group, "column_units", column->unit);
    write_clock(w, w->group, head);
    write_number(w, w->group, "center", H5T_IEEE_F64LE, grid->center);
    write_number(w, w->group, "dense", H5T_STD_I8LE, w->dense);
    write_number(w, w->group, "scales", H5T_STD_I32LE, (double)w->n_scales);
    const dataset v[] = {
        { "scale", "s", "scale a", H5T_IEEE_F64LE, &w->scale->a, 0, 0 },
        { "frequency", "Hz", "frequency label omega_c / (2 pi a)", H5T_IEEE_F64LE, &w->scale->f, 0, 0 },
        { "m", "1", "log2 of the scale in seconds", H5T_IEEE_F64LE, &w->scale->m, 0, 0 },
        { "j", "1", "number of the scale, a = 2^(j/voices) s", H5T_STD_I32LE, &w->scale->j, 0, 0 },
    };
    write_lists(w, w->group, v, sizeof v / sizeof *v, w->n_scales, sizeof *w->scale);
    if (w->dense)
        write_lattice(w, w->group, &w->scale[0]);
    for (size_t i = 0; !w->dense && i < w->n_scales; i++) {
        const ss_scale *scale = &w->scale[i];
        char name[32];
        snprintf(name, sizeof name, "scale%03zu", i);
        hid_t group = w->datasets[i].group = new_group(w, w->group, name);
        write_number(w, group, "m", H5T_IEEE_F64LE, scale->m);
        write_number(w, group, "scale", H5T_IEEE_F64LE, scale->a);
        write_number(w, group, "frequency", H5T_IEEE_F64LE, scale->f);
        write_number(w, group, "j", H5T_STD_I32LE, scale->j);
        write_lattice(w, group, scale);
    }
}

/* A number that, added and then subtracted, rounds to a multiple of the largest power of two that is at most
 * sqrt(2) times the error allowed for W: re and im are off by at most half of that.  0: all bits are kept. */
static double
rounding_of(double tolerance, double most)
{
    double unit = tolerance * M_SQRT2 * most;
    return tolerance >= 1e-12 && unit > 1e-280 && unit < 1e280 ? ldexp(0x1.8p52, ilogb(unit)) : 0;
}

FAST static double
largest_of(const double *x, size_t n, double most)
{
    double square = 0;
    for (size_t k = 0; k < n; k++) {
        double next = x[2 * k] * x[2 * k] + x[2 * k + 1] * x[2 * k + 1];
        square = next > square ? next : square;
    }
    return fmax(most, sqrt(square));
}

/* Make the datasets of scale i, or, if dense, those of all scales, which are rectangles.  The largest |W| is
 * `most` so far.  For tolerances from 1e-7 on there are at most 2^24 multiples of rounding_of's unit, which 32-bit
 * floats hold exactly unless the unit is below 2^-149.  The error there is far below the 16 eps a^1/2 max|x| that
 * W has anyway: |W| is at most 1.9 a^1/2 max|x|, and here at least 1e-20 at one scale. */
static void
open_datasets(h5_writer *w, size_t i, double most)
{
    static const char *const scales[] = { "scale", "time" };
    int rank = w->dense ? 2 : 1;
    hsize_t chunk = chunk_of(w, (w->dense ? 17 : 25) * w->n_scales);
    hsize_t length = w->length == 0 ? 0 : w->dense ? w->length : w->scale[i].n;
    const hsize_t dims[2] = { w->n_scales, length };
    struct scale_datasets *d = &w->datasets[w->dense ? 0 : i];
    d->single = w->tolerance >= 1e-7 && most >= 1e-20 && most <= 1e20;
    hid_t group = w->dense ? w->group : d->group, type = d->single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    const dataset v[] = {
        { "time", "s", "time", H5T_IEEE_F64LE, NULL, chunk, 0 },
        { "re", w->unit, "real part of the wavelet coefficient", type, NULL, chunk, 1 },
        { "im", w->unit, "imaginary part of the wavelet coefficient", type, NULL, chunk, 1 },
        { "edge", "1", "1 inside the cone of influence", H5T_STD_U8LE, NULL, chunk, 1 },
    };
    for (size_t k = 0; k < PARTS; k++) {
        d->part[k] = k == TIME ? new_dataset(w, group, &v[k], 1, &length, NULL)
            : new_dataset(w, group, &v[k], rank, dims + 2 - rank, scales + 2 - rank);
        /* the CF conventions name so the label of a row that is not its index */
        if (k != TIME && w->dense)
            write_text(w, d->part[k], "coordinates", "frequency");
    }
    if (!w->dense && H5Gclose(group) < 0)
        fail(w, w->group, "re");
}

/* Split coefficients into re and im, rounded by adding and subtracting `shift`. */
VERSIONS static void
split(double *restrict re, double *restrict im, const double *restrict x, size_t n, double shift)
{
    for (size_t k = 0; k < n; k++) {
        re[k] = x[2 * k] + shift - shift;
        im[k] = x[2 * k + 1] + shift - shift;
    }
}

/* Write re or im of n coefficients.  Were HDF5 to make 32-bit floats of them, it would zero 1 MB in each call. */
static void
write_part(h5_writer *w, hid_t id, int single, int rank, const hsize_t at[], size_t n, const double *x)
{
    for (size_t k = 0; single && k < n; k++)
        w->single[k] = (float)x[k];
    write_values(w, id, rank, at, n, single ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE,
                 single ? (const void *)w->single : x);
}

/* Write the next n coefficients of a scale, as pairs, of a record with so many samples until now. */
static void
append_coefficients(h5_writer *w, const ss_scale *scale, size_t first, size_t n, const double *x, size_t samples)
{
    size_t i = 0;
    while (i < w->n_scales && w->scale[i].j != scale->j)
        i++;
    struct scale_datasets *d = &w->datasets[i], *shared = &w->datasets[w->dense ? 0 : i];
    if (i == w->n_scales || d->done != first || (w->length > 0 && n > w->scale[i].n - first)) {
        w->file.status = ss_fail(&w->error, SS_EINVAL, "coefficients that are not the next of a scale");
        return;
    }
    d->most = w->tolerance > 0 ? largest_of(x, n, d->most) : 0;
    if (shared->part[RE] < 0 && n > 0)
        open_datasets(w, i, d->most);
    if (w->file.status == SS_OK && shared->single && d->most > FLT_MAX)
        ss_h5_fail(&w->file, SS_ERANGE, w->group, "re", "coefficients of at most 1e20 precede some above 3.4e38, "
                   "which 32-bit floats do not hold; keep all bits");
    const int rank = w->dense ? 2 : 1;
    scale = &w->scale[i];
    for (size_t m; w->file.status == SS_OK && n > 0; n -= m, x += 2 * m, d->done += m) {
        const hsize_t where[2] = { i, d->done }, *at = where + 2 - rank;
        m = n < PIECE ? n : PIECE;
        split(w->value[0], w->value[1], x, m, rounding_of(w->tolerance, d->most));
        for (size_t k = 0; k < m; k++)
            w->edge[k] = (unsigned char)wavelet_edge(scale, d->done + k, samples, w->rate, w->start, w->gap,
                                                     w->n_gaps);
        write_part(w, shared->part[RE], shared->single, rank, at, m, w->value[0]);
        write_part(w, shared->part[IM], shared->single, rank, at, m, w->value[1]);
        write_values(w, shared->part[EDGE], rank, at, m, H5T_NATIVE_UCHAR, w->edge);
        if (!w->dense)
            write_times(w, d->part[TIME], scale, d->done, m);
    }
    for (size_t k = 0; w->length > 0 && !w->dense && d->done == w->scale[i].n && k < PARTS; k++) {
        if (d->part[k] >= 0 && H5Dclose(d->part[k]) < 0)
            fail(w, w->group, "re");
        d->part[k] = -1;
    }
}

/* Write the length and the times that all scales share, which are known only at the end.  Each scale must have all
 * the coefficients that it has in a record of so many samples. */
static void
end_wavelet(h5_writer *w, size_t samples)
{
    double last = (double)(samples - 1) / w->rate;
    for (size_t i = 0; w->file.status == SS_OK && i < w->n_scales; i++) {
        const ss_scale *scale = &w->scale[i];
        size_t done = w->datasets[i].done;
        if (w->length > 0 ? done != scale->n
            : !(done > 0 && ss_scale_b(scale, done - 1) <= last && ss_scale_b(scale, done) > last))
            w->file.status = ss_fail(&w->error, SS_EINVAL, "coefficients of scale %g are missing", scale->m);
    }
    char text[SS_NUMBER_MAX];
    ss_number_format(text, (double)samples);
    if (w->dense)
        write_times(w, w->datasets->part[TIME], &w->scale[0], 0, samples);
    if (H5Aexists(w->file.id, "samples") <= 0)
        write_text(w, w->file.id, "samples", text);
    write_number(w, w->group, "samples", H5T_STD_I64LE, (double)samples);
}

/* --- the file ------------------------------------------------------------------------------ */

/* Make the file, with its notes. */
static void
begin_file(h5_writer *w, const ss_header *head)
{
    w->file.disk.fd = open(w->file.path, O_RDWR | O_CREAT | O_TRUNC, 0666);
    if (w->file.disk.fd < 0) {
        w->file.status = ss_fail_errno(&w->error, w->file.path, errno);
        return;
    }
    hid_t access = ss_h5_disk_access(&w->file.disk, &w->file.driver), how = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);   /* programs read it since 2008 */
    H5Pset_obj_track_times(how, 0);
    H5Pset_link_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Pset_attr_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    w->file.id = access >= 0 ? H5Fcreate(w->file.path, H5F_ACC_TRUNC, how, access) : -1;
    H5Pclose(how);
    H5Pclose(access);
    w->file.status = w->file.id >= 0 ? SS_OK : SS_ENOMEM;
    write_text(w, w->file.id, H5_VERSION_NOTE, SS_VERSION);
    for (size_t i = 0; w->file.status == SS_OK && head != NULL && i < head->n_notes; i++) {
        const char *colon = strstr(head->note[i], ": ");
        size_t length = colon != NULL ? (size_t)(colon - head->note[i]) : strlen(head->note[i]);
        char *key = strndup(head->note[i], length);
        if (key == NULL)
            w->file.status = SS_ENOMEM;
        else if (H5Aexists(w->file.id, key) <= 0)
            write_text(w, w->file.id, key, colon != NULL ? colon + 2 : "");
        free(key);
    }
}

/* Ask for what the disk has kept, and let each failure have a text. */
static void
check_disk(h5_writer *w)
{
    if (w->file.disk.error != 0 && w->file.status == SS_OK)
        w->file.status = ss_fail_errno(&w->error, w->file.path, w->file.disk.error);
    if (w->file.status == SS_ENOMEM)
        ss_fail_memory(&w->error, w->file.path);
}

/* Close everything.  An incomplete file is removed.  Closing it again does nothing. */
static void
close_file(h5_writer *w)
{
    struct stat is;
    if (w->file.id >= 0 && H5Fclose(w->file.id) < 0)    /* and all objects in it */
        fail(w, 0, "");
    if (w->file.driver > 0)
        H5FDunregister(w->file.driver);
    w->file.id = -1;
    w->file.driver = 0;
    if (w->file.disk.fd < 0)
        return;
    if (close(w->file.disk.fd) != 0 && w->file.disk.error == 0)
        w->file.disk.error = errno;
    w->file.disk.fd = -1;
    check_disk(w);
    if (w->file.status != SS_OK && stat(w->file.path, &is) == 0 && S_ISREG(is.st_mode))
        unlink(w->file.path);
}

/* Run a step of a writer that has not failed. */
#define STEP(base, err, ...) do { \
        h5_writer *w = (h5_writer *)(base); \
        H5E_BEGIN_TRY { \
            if (w->file.status == SS_OK) \
                __VA_ARGS__; \
            check_disk(w); \
        } H5E_END_TRY \
        if (w->file.status != SS_OK && (err) != NULL) \
            *(err) = w->error; \
        return w->file.status; \
    } while (0)

static ss_status
write_rows(ss_writer *base, double *const column[], size_t n, ss_error *err)
{
    STEP(base, err, {
        if (w->column == NULL || (w->length > 0 && n > w->length - w->samples))
            w->file.status = ss_fail(&w->error, SS_EINVAL, "more samples than the file was begun with");
        for (size_t i = 0, m; w->file.status == SS_OK && i < n; i += m, w->samples += m) {
            size_t left = w->piece - w->samples % w->piece;
            hsize_t at = w->samples;
            m = n - i < left ? n - i : left;
            write_times(w, w->times, NULL, w->samples, m);
            for (size_t c = 0; c < w->n_columns; c++)
                write_values(w, w->column[c], 1, &at, m, H5T_NATIVE_DOUBLE, column[c] + i);
        }
    });
}

static ss_status
write_coefficients(ss_writer *base, const ss_scale *scale, size_t first, size_t n, const double *c, size_t samples,
                   ss_error *err)
{
    STEP(base, err, append_coefficients(w, scale, first, n, c, samples));
}

/* Events are written at the end, as their number is known then. */
static ss_status
keep_events(ss_writer *base, const ss_event *event, size_t n, ss_error *err)
{
    STEP(base, err, {
        ss_event *more = ss_list_grow(w->event, &w->room, w->n_events + n, sizeof *more);
        w->event = more != NULL ? more : w->event;
        w->file.status = more != NULL ? SS_OK : SS_ENOMEM;
        for (size_t i = 0; more != NULL && i < n; i++)
            more[w->n_events++] = event[i];
    });
}

static ss_status
write_note(ss_writer *base, const char *key, const char *value, ss_error *err)
{
    STEP(base, err, {
        if (H5Aexists(w->file.id, key) > 0 && H5Adelete(w->file.id, key) < 0)
            fail(w, 0, key);
        write_text(w, w->file.id, key, value);
    });
}

/* Write what is left, check that all samples of the file have been given, and close it. */
static ss_status
end_file(ss_writer *base, size_t samples, ss_error *err)
{
    STEP(base, err, {
        int fits = w->length == 0 || samples == w->length;
        if (w->ended)
            w->file.status = ss_fail(&w->error, SS_EINVAL, "the file is complete");
        else if ((w->n_scales > 0 && (samples < 1 || !fits))
                 || (w->column != NULL && (w->samples != samples || !fits)))
            w->file.status = ss_fail(&w->error, SS_EINVAL, "%zu samples are not what the file has", samples);
        w->ended = 1;
        if (w->file.status == SS_OK && w->has_events)
            write_all_events(w);
        if (w->file.status == SS_OK && w->n_scales > 0)
            end_wavelet(w, samples);
        close_file(w);
    });
}

static void
free_writer(ss_writer *base)
{
    h5_writer *w = (h5_writer *)base;
    if (w->file.status == SS_OK)
        w->file.status = SS_STOP;               /* a file that has not ended is incomplete */
    H5E_BEGIN_TRY {
        close_file(w);
    } H5E_END_TRY
    free(w->event);
    free(w->column);
    free(w->unit);
    free(w->scale);
    free(w->datasets);
    free(w->gap);
    free(w->file.path);
    free(w);
}

static ss_status
writer_new(ss_writer **out, const char *path, const ss_contents *what, ss_error *err)
{
    static const struct writer_calls calls = {
        write_rows, write_coefficients, keep_events, write_note, end_file, free_writer };
    const ss_header *head = what->grid != NULL ? what->grid->head : what->signal;
    ss_status st = head != NULL ? ss_header_check_notes(head, err) : SS_OK;
    if (st != SS_OK)
        return st;
    h5_writer *w = calloc(1, sizeof *w);
    char *copy = strdup(path);
    if (w == NULL || copy == NULL) {
        free(w);
        free(copy);
        return ss_fail_memory(err, path);
    }
    w->base.calls = &calls;
    w->file = (h5_file){ .id = -1, .path = copy, .err = &w->error, .disk.fd = -1 };
    w->rate = head != NULL ? head->rate : 1;
    w->start = head != NULL ? head->start : 0;
    w->length = what->n;
    w->has_events = what->events;
    H5E_BEGIN_TRY {
        begin_file(w, head);
        if (w->file.status == SS_OK && what->signal != NULL)
            begin_signal(w, what->signal);
        if (w->file.status == SS_OK && what->grid != NULL)
            begin_wavelet(w, what->grid);
        check_disk(w);
    } H5E_END_TRY
    st = w->file.status;
    if (st != SS_OK && err != NULL)
        *err = w->error;
    if (st == SS_OK)
        *out = &w->base;
    else
        free_writer(&w->base);
    return st;
}

const struct ss_store_calls *
ss_store_calls(ss_error *err)
{
    static const struct ss_store_calls calls = {
        .open_signal = ss_h5_open_signal, .open_coefficients = ss_h5_open_coefficients, .writer_new = writer_new };
    (void)err;
    return &calls;
}
