/* write.c -- a record as an HDF5 file that xarray, MATLAB and h5dump understand unaided.
 *
 * Every dataset carries units and long_name and is tied to the dimension scales that it stands on.
 * Nothing in the file depends on the clock, the path or the machine: creation times are not
 * tracked, file types are little-endian, links and attributes are kept in the order of writing.
 * HDF5 cannot let go of a file that it failed to write (a full disk): it tries again at exit, in
 * vain and aloud.  So it builds the file in memory, and the bytes are written out here. */
#include "h5.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "../error.h"

#define CHUNK 65536             /* values in a chunk at most */
#define PLAIN_BYTES 65536       /* a dataset up to this size is stored as it is */
#define IMAGE_STEP 1048576      /* bytes by which the image in memory grows */

/* One dataset to be written. */
typedef struct variable {
    const char *name, *unit, *long_name;
    hid_t file_type, memory_type;
    const void *values;
    size_t start, stride;       /* value i is values[start + i * stride]; stride 0 is 1 */
} variable;

/* In memory a call of HDF5 fails for want of that, or of a name or size that HDF5 can store. */
static ss_status
fail_write(h5_file *file, hid_t group, const char *name)
{
    return ss_h5_fail(file, SS_EIO, group, name, "HDF5 cannot store it, or is out of memory");
}

static int
put_number(hid_t object, const char *name, hid_t file_type, double value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t id = H5Acreate2(object, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT);
    int good = id >= 0 && H5Awrite(id, H5T_NATIVE_DOUBLE, &value) >= 0;
    H5Aclose(id);
    H5Sclose(space);
    return good;
}

static int
put_text(hid_t object, const char *name, const char *value)
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

/* How a dataset is laid out: large ones in compressed chunks along the last dimension. */
static hid_t
layout(hid_t type, int rank, const hsize_t dims[])
{
    hsize_t chunk[2] = { 1, 1 }, values = 1;
    hid_t plist = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(plist, 0);
    for (int i = 0; i < rank; i++)
        values *= dims[i];
    if (values * H5Tget_size(type) <= PLAIN_BYTES)
        return plist;
    hsize_t row = dims[rank - 1] < CHUNK ? dims[rank - 1] : CHUNK;
    chunk[rank - 1] = row;
    if (rank == 2)
        chunk[0] = CHUNK / row < dims[0] ? CHUNK / row : dims[0];
    H5Pset_chunk(plist, rank, chunk);
    if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0) {
        H5Pset_shuffle(plist);
        H5Pset_deflate(plist, 4);
    }
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

/* Write one dataset on the given dimension scales; NULL makes it a scale itself. */
static ss_status
put_variable(h5_file *file, hid_t group, const variable *v, int rank, const hsize_t dims[],
             const char *const scales[])
{
    hsize_t values = rank == 2 ? dims[0] * dims[1] : dims[0];
    hid_t plist = layout(v->file_type, rank, dims);
    hid_t space = H5Screate_simple(rank, dims, NULL), memory = memory_space(v, values);
    hid_t id = H5Dcreate2(group, v->name, v->file_type, space, H5P_DEFAULT, plist, H5P_DEFAULT);
    int good = id >= 0
               && H5Dwrite(id, v->memory_type, memory, values > 0 ? H5S_ALL : space, H5P_DEFAULT,
                           v->values) >= 0
               && put_text(id, "units", v->unit) && put_text(id, "long_name", v->long_name);
    if (good && scales == NULL)
        good = H5DSset_scale(id, v->name) >= 0;
    for (int i = 0; good && scales != NULL && i < rank; i++) {
        hid_t scale = H5Dopen2(group, scales[i], H5P_DEFAULT);
        good = H5DSattach_scale(id, scale, (unsigned)i) >= 0;
        H5Dclose(scale);
    }
    H5Dclose(id);
    H5Sclose(memory);
    H5Sclose(space);
    H5Pclose(plist);
    return good ? SS_OK : fail_write(file, group, v->name);
}

static hid_t
put_group(hid_t parent, const char *name)
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
    snprintf(link, 200, "%s", name);
    for (char *c = link; *c != '\0'; c++)
        if (*c == '/')
            *c = '_';
    if (link[0] == '\0' || strcmp(link, ".") == 0)
        strcpy(link, "_");
    size_t length = strlen(link);
    for (int i = 2; H5Lexists(group, link, H5P_DEFAULT) > 0; i++)
        sprintf(link + length, "_%d", i);
}

static ss_status
put_times(h5_file *file, hid_t group, const char *name, const ss_scale *scale, double rate,
          double start, size_t n)
{
    hsize_t dims = n;
    double *t = malloc((n > 0 ? n : 1) * sizeof *t);
    if (t == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++)
        t[i] = start + (scale != NULL ? ss_scale_b(scale, i) : (double)i / rate);
    variable v = { name, "s", "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, t, 0, 1 };
    ss_status status = put_variable(file, group, &v, 1, &dims, NULL);
    free(t);
    return status;
}

static ss_status
put_column(h5_file *file, hid_t group, const ss_signal *signal, size_t c)
{
    static const char *const scales[] = { "t" };
    const ss_column *column = &signal->head->column[c];
    hsize_t dims = signal->n;
    char link[256];
    link_name(link, group, column->name);
    variable v = { link, column->unit, long_name(column), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                   signal->values + c * signal->n, 0, 1 };
    ss_status status = put_variable(file, group, &v, 1, &dims, scales);
    if (status != SS_OK || strcmp(link, column->name) == 0)
        return status;
    hid_t id = H5Dopen2(group, link, H5P_DEFAULT);
    int good = put_text(id, "column", column->name);
    H5Dclose(id);
    return good ? SS_OK : fail_write(file, group, link);
}

static ss_status
put_signal(h5_file *file, const ss_signal *signal)
{
    const ss_header *head = signal->head;
    hid_t group = put_group(file->id, "signal");
    if (group < 0 || !put_number(group, "rate", H5T_IEEE_F64LE, head->rate)
        || !put_number(group, "start", H5T_IEEE_F64LE, head->start)
        || !put_number(group, "has_time", H5T_STD_I8LE, head->has_time))
        return fail_write(file, 0, "/signal");
    ss_status status = put_times(file, group, "t", NULL, head->rate, head->start, signal->n);
    for (size_t c = 0; status == SS_OK && c < head->n_columns; c++)
        status = put_column(file, group, signal, c);
    H5Gclose(group);
    return status;
}

/* --- /events ------------------------------------------------------------------------------- */

#define KIND_LENGTH 8           /* "reverse" and a NUL */

static ss_status
put_events(h5_file *file, const ss_event *event, size_t n)
{
    static const char *const scales[] = { "t" };
    static const char none;
    hsize_t dims = n;
    hid_t group = put_group(file->id, "events"), text = H5Tcopy(H5T_C_S1);
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
        { "t", "s", "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real, 0, 3 },
        { "kind", &none, "what begins: stick, slip, or slip the other way", text, text, kind, 0, 1 },
        { "x", "m", "displacement", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real, 1, 3 },
        { "v", "m/s", "velocity", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real, 2, 3 },
        { "direction", "1", "sign of the slip that begins, or ended at a stick", H5T_STD_I8LE,
          H5T_NATIVE_INT, direction, 0, 1 },
    };
    for (size_t i = 0; status == SS_OK && i < sizeof v / sizeof *v; i++)
        status = put_variable(file, group, &v[i], 1, &dims, i > 0 ? scales : NULL);
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
is_dense(const ss_coefficients *c)
{
    for (size_t i = 0; i < c->n_scales; i++)
        if (c->scale[i].n != c->n || c->scale[i].offset != i * c->n
            || c->scale[i].b_num != c->scale[0].b_num || c->scale[i].b_den != c->scale[0].b_den)
            return 0;
    return c->n_scales > 0;
}

/* re, im and edge of n_scales scales from the first on, on a line or on a rectangle. */
static ss_status
put_coefficients(h5_file *file, hid_t group, const ss_coefficients *c, size_t first,
                 size_t n_scales, int rank)
{
    static const char *const scales[] = { "scale", "time" };
    const ss_scale *scale = &c->scale[first];
    const char *unit = c->head->n_columns > 0 ? c->head->column[0].unit : "";
    const char *norm = ss_header_find_note(c->head, "norm");
    int l1 = norm != NULL && strcmp(norm, "l1") == 0;
    hsize_t dims[2] = { n_scales, scale->n };
    char units[256];
    snprintf(units, sizeof units, "%s%s%s", unit, *unit != '\0' && !l1 ? " " : "", l1 ? "" : "s^0.5");
    unsigned char *edge = malloc(n_scales * scale->n + 1);
    if (edge == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n_scales; i++)
        for (size_t k = 0; k < scale->n; k++)
            edge[i * scale->n + k] = (unsigned char)ss_coefficients_edge(c, first + i, k);
    const variable v[] = {
        { "re", units, "real part of the wavelet coefficient", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
          c->w, 2 * scale->offset, 2 },
        { "im", units, "imaginary part of the wavelet coefficient", H5T_IEEE_F64LE,
          H5T_NATIVE_DOUBLE, c->w, 2 * scale->offset + 1, 2 },
        { "edge", "1", "1 inside the cone of influence", H5T_STD_U8LE, H5T_NATIVE_UCHAR, edge, 0, 1 },
    };
    ss_status status = SS_OK;
    for (size_t i = 0; status == SS_OK && i < sizeof v / sizeof *v; i++) {
        status = put_variable(file, group, &v[i], rank, dims + 2 - rank, scales + 2 - rank);
        if (status == SS_OK && rank == 2) {     /* CF: the label of a row that is not its index */
            hid_t id = H5Dopen2(group, v[i].name, H5P_DEFAULT);
            status = put_text(id, "coordinates", "frequency") ? SS_OK
                                                              : fail_write(file, group, v[i].name);
            H5Dclose(id);
        }
    }
    free(edge);
    return status;
}

static int
put_lattice(hid_t object, const ss_scale *scale)
{
    return put_number(object, "b_num", H5T_IEEE_F64LE, scale->b_num)
           && put_number(object, "b_den", H5T_IEEE_F64LE, scale->b_den);
}

static ss_status
put_dense(h5_file *file, hid_t group, const ss_coefficients *c)
{
    static const char *const scales[] = { "scale" };
    hsize_t dims = c->n_scales;
    double *row = malloc(4 * c->n_scales * sizeof *row);
    if (row == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < c->n_scales; i++) {
        const double of[4] = { c->scale[i].a, c->scale[i].f, c->scale[i].m, c->scale[i].j };
        memcpy(row + 4 * i, of, sizeof of);
    }
    const variable v[] = {
        { "scale", "s", "scale a", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, row, 0, 4 },
        { "frequency", "Hz", "frequency label omega_c / (2 pi a)", H5T_IEEE_F64LE,
          H5T_NATIVE_DOUBLE, row, 1, 4 },
        { "m", "1", "log2 of the scale in seconds", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, row, 2, 4 },
        { "j", "1", "number of the scale, a = 2^(j/voices) s", H5T_STD_I32LE, H5T_NATIVE_DOUBLE,
          row, 3, 4 },
    };
    ss_status status = SS_OK;
    for (size_t i = 0; status == SS_OK && i < sizeof v / sizeof *v; i++)
        status = put_variable(file, group, &v[i], 1, &dims, i > 0 ? scales : NULL);
    free(row);
    if (status == SS_OK && !put_lattice(group, &c->scale[0]))
        status = fail_write(file, 0, "/wavelet");
    if (status == SS_OK)
        status = put_times(file, group, "time", &c->scale[0], c->head->rate, c->head->start, c->n);
    return status == SS_OK ? put_coefficients(file, group, c, 0, c->n_scales, 2) : status;
}

static ss_status
put_scale(h5_file *file, hid_t parent, const ss_coefficients *c, size_t i)
{
    const ss_scale *scale = &c->scale[i];
    char name[32];
    snprintf(name, sizeof name, "scale%03zu", i);
    hid_t group = put_group(parent, name);
    if (group < 0 || !put_number(group, "m", H5T_IEEE_F64LE, scale->m)
        || !put_number(group, "scale", H5T_IEEE_F64LE, scale->a)
        || !put_number(group, "frequency", H5T_IEEE_F64LE, scale->f)
        || !put_number(group, "j", H5T_STD_I32LE, scale->j) || !put_lattice(group, scale))
        return fail_write(file, parent, name);
    ss_status status = put_times(file, group, "time", scale, c->head->rate, c->head->start,
                                 scale->n);
    if (status == SS_OK)
        status = put_coefficients(file, group, c, i, 1, 1);
    H5Gclose(group);
    return status;
}

static ss_status
put_wavelet(h5_file *file, const ss_coefficients *c)
{
    const ss_header *head = c->head;
    int dense = is_dense(c);
    const ss_column none = { "", "" }, *column = head->n_columns > 0 ? head->column : &none;
    hid_t group = put_group(file->id, "wavelet");
    if (group < 0 || !put_text(group, "column", column->name)
        || !put_text(group, "column_units", column->unit)
        || !put_number(group, "samples", H5T_STD_I64LE, (double)c->n)
        || !put_number(group, "rate", H5T_IEEE_F64LE, head->rate)
        || !put_number(group, "start", H5T_IEEE_F64LE, head->start)
        || !put_number(group, "has_time", H5T_STD_I8LE, head->has_time)
        || !put_number(group, "center", H5T_IEEE_F64LE, c->center)
        || !put_number(group, "dense", H5T_STD_I8LE, dense)
        || !put_number(group, "scales", H5T_STD_I32LE, (double)c->n_scales))
        return fail_write(file, 0, "/wavelet");
    ss_status status = dense ? put_dense(file, group, c) : SS_OK;
    for (size_t i = 0; status == SS_OK && !dense && i < c->n_scales; i++)
        status = put_scale(file, group, c, i);
    H5Gclose(group);
    return status;
}

/* --- the file ------------------------------------------------------------------------------ */

static ss_status
put_notes(h5_file *file, const ss_header *head)
{
    if (!put_text(file->id, H5_VERSION_NOTE, SS_VERSION))
        return fail_write(file, 0, "/");
    for (size_t i = 0; head != NULL && i < head->n_notes; i++) {
        const char *colon = strstr(head->note[i], ": ");
        size_t length = colon != NULL ? (size_t)(colon - head->note[i]) : strlen(head->note[i]);
        char *key = strndup(head->note[i], length);
        if (key == NULL)
            return SS_ENOMEM;
        int good = H5Aexists(file->id, key) > 0
                   || put_text(file->id, key, colon != NULL ? colon + 2 : "");
        free(key);
        if (!good)
            return fail_write(file, 0, head->note[i]);
    }
    return SS_OK;
}

/* A file in memory; *access goes with it. */
static hid_t
create_image(const char *path, hid_t access)
{
    hid_t how = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_fapl_core(access, IMAGE_STEP, 0);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);   /* read by everyone since 2008 */
    H5Pset_obj_track_times(how, 0);
    H5Pset_link_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Pset_attr_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    hid_t id = H5Fcreate(path, H5F_ACC_TRUNC, how, access);
    H5Pclose(how);
    return id;
}

static ss_status
fill_image(h5_file *file, const ss_record *record)
{
    ss_status status = put_notes(file, record->coefficients != NULL ? record->coefficients->head
                                       : record->signal != NULL ? record->signal->head : NULL);
    if (status == SS_OK && record->signal != NULL)
        status = put_signal(file, record->signal);
    if (status == SS_OK && (record->has_events || record->n_events > 0))
        status = put_events(file, record->events, record->n_events);
    if (status == SS_OK && record->coefficients != NULL)
        status = put_wavelet(file, record->coefficients);
    return status;
}

static ss_status
write_out(h5_file *file, const void *bytes, size_t size)
{
    struct stat st;
    FILE *out = fopen(file->path, "wb");
    if (out == NULL)
        return ss_h5_fail(file, SS_EIO, 0, "", strerror(errno));
    int failed = fwrite(bytes, 1, size, out) != size, why = errno;
    if (fclose(out) != 0 && !failed) {
        failed = 1;
        why = errno;
    }
    if (failed && stat(file->path, &st) == 0 && S_ISREG(st.st_mode))
        unlink(file->path);
    return failed ? ss_h5_fail(file, SS_EIO, 0, "", strerror(why)) : SS_OK;
}

static ss_status
write_record(h5_file *file, const ss_record *record)
{
    void *handle = NULL;        /* for this driver, the address of the pointer to the bytes */
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    file->id = create_image(file->path, access);
    ss_status status = file->id >= 0 ? fill_image(file, record) : SS_ENOMEM;
    if (status == SS_OK && H5Fflush(file->id, H5F_SCOPE_GLOBAL) < 0)
        status = SS_ENOMEM;
    ssize_t size = status == SS_OK ? H5Fget_file_image(file->id, NULL, 0) : 0;
    if (status == SS_OK && (size < 0 || H5Fget_vfd_handle(file->id, access, &handle) < 0))
        status = SS_ENOMEM;
    if (status == SS_OK)
        status = write_out(file, *(void **)handle, (size_t)size);
    if (file->id >= 0)
        H5Fclose(file->id);
    H5Pclose(access);
    return status;
}

ss_status
ss_store_write(const char *path, const ss_record *record, ss_error *err)
{
    h5_file file = { -1, path, err };
    ss_status status;
    H5E_BEGIN_TRY {
        status = write_record(&file, record);
    } H5E_END_TRY
    if (status == SS_ENOMEM)
        ss_fail(err, status, "%s: %s", path, ss_strerror(status));
    return status;
}
