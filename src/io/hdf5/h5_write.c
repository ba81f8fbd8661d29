/* h5_write.c -- attributes, groups and datasets written so that xarray, MATLAB and h5dump understand
 * them directly.
 *
 * Every dataset has units and long_name and is attached to its dimension scales.
 * The same input gives the same bytes: creation times are not tracked, file types are little-endian, links are
 * kept in the order of writing.  A file is whole or absent. */
#include "io/hdf5/h5_write.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/error.h"

#define PLAIN_BYTES 65536       /* a dataset up to this size is stored without compression */
#define LEAST_ROW 2048          /* shorter rows share chunks */

ss_status
ss_h5_fail_write(h5_file *file, hid_t group, const char *name)
{
    return ss_h5_fail(file, SS_EIO, group, name, "HDF5 cannot store it, or is out of memory");
}

int
ss_h5_write_number(hid_t object, const char *name, hid_t file_type, double value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t id = H5Acreate2(object, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT);
    int good = id >= 0 && H5Awrite(id, H5T_NATIVE_DOUBLE, &value) >= 0;
    H5Aclose(id);
    H5Sclose(space);
    return good;
}

int
ss_h5_write_text(hid_t object, const char *name, const char *value)
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

hid_t
ss_h5_new_group(hid_t parent, const char *name)
{
    hid_t plist = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(plist, 0);
    H5Pset_link_creation_order(plist, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    hid_t group = H5Gcreate2(parent, name, H5P_DEFAULT, plist, H5P_DEFAULT);
    H5Pclose(plist);
    return group;
}

/* The layout of a dataset: if it is large, in compressed chunks along the last dimension. */
static hid_t
layout(const h5_dataset *v, int rank, const hsize_t dims[])
{
    hsize_t chunk[2] = { 1, 1 }, values = 1;
    hid_t plist = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(plist, 0);
    for (int i = 0; i < rank; i++)
        values *= dims[i];
    if (v->chunk == 0 && values * H5Tget_size(v->file_type) <= PLAIN_BYTES)
        return plist;
    hsize_t row = v->chunk > 0 ? v->chunk : dims[rank - 1] < H5_PIECE ? dims[rank - 1] : H5_PIECE;
    chunk[rank - 1] = row;
    if (rank == 2 && v->chunk == 0 && !(v->in_rows && row >= LEAST_ROW))
        chunk[0] = H5_PIECE / row < dims[0] ? H5_PIECE / row : dims[0];
    H5Pset_chunk(plist, rank, chunk);
    if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0) {
        H5Pset_shuffle(plist);
        H5Pset_deflate(plist, v->in_rows ? 1 : 4);
    }
    return plist;
}

/* Access properties of a dataset.  If it grows, its cache has room for one chunk of each row. */
static hid_t
access_of(const h5_dataset *v, int rank, const hsize_t dims[])
{
    hid_t plist = H5Pcreate(H5P_DATASET_ACCESS);
    size_t rows = rank == 2 ? (size_t)dims[0] : 1;
    if (v->chunk > 0)
        H5Pset_chunk_cache(plist, 128 * rows + 1, rows * (size_t)v->chunk * H5Tget_size(v->file_type), 1);
    return plist;
}

hid_t
ss_h5_new_dataset(hid_t group, const h5_dataset *v, int rank, const hsize_t dims[],
                  const char *const scales[])
{
    hsize_t most[2] = { dims[0], dims[rank - 1] };
    most[rank - 1] = v->chunk > 0 ? H5S_UNLIMITED : dims[rank - 1];
    hid_t how = layout(v, rank, dims), access = access_of(v, rank, dims);
    hid_t space = H5Screate_simple(rank, dims, most);
    hid_t id = H5Dcreate2(group, v->name, v->file_type, space, H5P_DEFAULT, how, access);
    int good = id >= 0 && ss_h5_write_text(id, "units", v->unit)
               && ss_h5_write_text(id, "long_name", v->long_name);
    if (good && v->values != NULL && dims[0] > 0)
        good = H5Dwrite(id, H5Tget_class(v->file_type) == H5T_STRING ? v->file_type : H5T_NATIVE_DOUBLE, H5S_ALL,
                        H5S_ALL, H5P_DEFAULT, v->values) >= 0;
    if (good && scales == NULL)
        good = H5DSset_scale(id, v->name) >= 0;
    for (int i = 0; good && scales != NULL && i < rank && scales[i] != NULL; i++) {
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

ss_status
ss_h5_write_lists(h5_file *file, hid_t group, const h5_dataset v[], size_t n, size_t length, size_t apart)
{
    const char *const scales[] = { v[0].name };
    hsize_t dims = length;
    double *x = malloc((length + 1) * sizeof *x);
    ss_status st = x != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        h5_dataset list = v[i];
        H5T_class_t class = H5Tget_class(list.file_type);
        for (size_t k = 0; class != H5T_STRING && k < length; k++) {
            const void *at = (const char *)list.values + k * apart;
            x[k] = class == H5T_INTEGER ? *(const int *)at : *(const double *)at;
        }
        list.values = class == H5T_STRING ? list.values : x;
        hid_t id = ss_h5_new_dataset(group, &list, 1, &dims, i > 0 ? scales : NULL);
        if (id < 0 || H5Dclose(id) < 0)
            st = ss_h5_fail_write(file, group, list.name);
    }
    free(x);
    return st;
}

int
ss_h5_write_piece(hid_t id, int rank, const hsize_t at[], hsize_t n, hid_t type, const void *values)
{
    hsize_t count[2] = { 1, 1 }, dims[2], end = at[rank - 1] + n;
    hid_t space = H5Dget_space(id), memory = H5Screate_simple(1, &n, NULL);
    count[rank - 1] = n;
    if (H5Sget_simple_extent_dims(space, dims, NULL) == rank && dims[rank - 1] < end) {
        dims[rank - 1] = end;
        H5Sclose(space);
        space = H5Dset_extent(id, dims) >= 0 ? H5Dget_space(id) : -1;
    }
    int good = H5Sselect_hyperslab(space, H5S_SELECT_SET, at, NULL, count, NULL) >= 0
        && H5Dwrite(id, type, memory, space, H5P_DEFAULT, values) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    return good;
}

/* --- the file ------------------------------------------------------------------------------ */

ss_status
ss_h5_output_open(h5_output *out)
{
    out->file.disk.fd = open(out->path, O_RDWR | O_CREAT | O_TRUNC, 0666);
    if (out->file.disk.fd < 0)
        return ss_fail_errno(&out->error, out->path, errno);
    hid_t access = ss_h5_disk_access(&out->file.disk, &out->file.driver);
    if (access < 0)
        return SS_ENOMEM;
    hid_t how = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);   /* programs read it since 2008 */
    H5Pset_obj_track_times(how, 0);
    H5Pset_link_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Pset_attr_creation_order(how, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    out->file.id = H5Fcreate(out->path, H5F_ACC_TRUNC, how, access);
    H5Pclose(how);
    H5Pclose(access);
    return out->file.id >= 0 ? SS_OK : SS_ENOMEM;
}

ss_status
ss_h5_output_close(h5_output *out, ss_status st)
{
    struct stat is;
    int good = out->file.id < 0 || H5Fclose(out->file.id) >= 0; /* and all objects in it */
    out->file.id = -1;
    if (st == SS_OK && !good)
        st = ss_h5_fail_write(&out->file, 0, "");
    if (out->file.driver > 0)
        H5FDunregister(out->file.driver);
    out->file.driver = 0;
    if (out->file.disk.fd < 0)
        return st;
    if (close(out->file.disk.fd) != 0 && out->file.disk.error == 0)
        out->file.disk.error = errno;
    out->file.disk.fd = -1;
    if (out->file.disk.error != 0)
        st = ss_fail_errno(&out->error, out->path, out->file.disk.error);
    if (st != SS_OK && stat(out->path, &is) == 0 && S_ISREG(is.st_mode))
        unlink(out->path);
    return st;
}

ss_status
ss_h5_output_check(h5_output *out, ss_status st)
{
    if (st == SS_OK && out->file.disk.error != 0)
        st = ss_fail_errno(&out->error, out->path, out->file.disk.error);
    if (st == SS_ENOMEM)
        ss_fail(&out->error, st, "%s: %s", out->file.path, ss_strerror(st));
    return st;
}
