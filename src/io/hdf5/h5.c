/* h5.c -- opening HDF5 files, reading attributes and datasets of real numbers.
 *
 * A file may make any claim.  So everything that would open other files, run a plugin, or need memory
 * out of proportion to the file is refused before HDF5 acts on it. */
#include "io/hdf5/h5.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/error.h"
#include "signal/gaps.h"
#include "signal/header.h"

void
ss_h5_fail(h5_file *file, ss_status status, hid_t group, const char *name, const char *text)
{
    char where[256] = "";
    if (file->status != SS_OK)
        return;
    if (file->disk.packed) {
        group = 0;
        name = "";
        status = SS_EDATA;
        text = "names or attributes in it are packed by filters; only values may be";
    }
    if (group > 0 && name[0] != '/')
        H5Iget_name(group, where, sizeof where);
    const char *colon = name[0] != '\0' || where[0] != '\0' ? ":" : "";
    const char *slash = name[0] != '\0' && where[0] != '\0' && strcmp(where, "/") != 0 ? "/" : "";
    file->status = ss_fail(file->err, status, "%s%s%s%s%s: %s", file->path, colon, where, slash, name, text);
}

void
ss_h5_open(h5_file *file, const char *path, ss_error *err)
{
    *file = (h5_file){ .id = -1, .path = strdup(path), .err = err, .disk.fd = -1 };
    if (file->path == NULL) {
        file->status = SS_ENOMEM;
        return;
    }
    file->disk = (h5_disk){ .fd = open(path, O_RDONLY), .reading = 1 };
    file->disk.eof = file->disk.fd >= 0 ? (haddr_t)lseek(file->disk.fd, 0, SEEK_END) : 0;
    hid_t access = ss_h5_disk_access(&file->disk, &file->driver);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    file->id = H5Fopen(path, H5F_ACC_RDONLY, access);
    H5Pclose(access);
    if (file->id < 0)
        ss_h5_fail(file, SS_EDATA, 0, "", "not an HDF5 file, or a damaged one");
}

void
ss_h5_close(h5_file *file)
{
    if (file->id >= 0)
        H5Fclose(file->id);
    if (file->driver > 0)
        H5FDunregister(file->driver);
    if (file->disk.reading && file->disk.fd >= 0)
        close(file->disk.fd);
    free(file->path);
}

/* --- objects ------------------------------------------------------------------------------- */

static herr_t
refuse_link(const char *parent, const char *group, const char *file, const char *object,
            unsigned *flags, hid_t access, void *user)
{
    (void)parent, (void)group, (void)file, (void)object, (void)flags, (void)access, (void)user;
    return -1;
}

/* Access properties to open an object of this class without following links to another file. */
static hid_t
inside_only(hid_t class)
{
    hid_t access = H5Pcreate(class);
    H5Pset_elink_cb(access, refuse_link, NULL);
    return access;
}

hid_t
ss_h5_open_dataset(hid_t group, const char *name, int in_pieces)
{
    hid_t access = inside_only(H5P_DATASET_ACCESS);
    if (in_pieces)
        H5Pset_chunk_cache(access, 0, 0, 0);
    hid_t id = H5Dopen2(group, name, access);
    H5Pclose(access);
    return id;
}

hid_t
ss_h5_open_group(hid_t group, const char *name)
{
    hid_t access = inside_only(H5P_GROUP_ACCESS);
    hid_t id = H5Gopen2(group, name, access);
    H5Pclose(access);
    return id;
}

static double
file_size(hid_t object)
{
    hsize_t size = 0;
    hid_t file = H5Iget_file_id(object);
    H5Fget_filesize(file, &size);
    H5Fclose(file);
    return (double)size;
}

static double
product(int n, const hsize_t factor[])
{
    double all = 1;
    for (int i = 0; i < n; i++)
        all *= (double)factor[i];
    return all;
}

/* The number of values in a dataspace.  HDF5 itself multiplies modulo 2^64. */
static double
values_in(hid_t space)
{
    hsize_t dims[H5S_MAX_RANK];
    return H5Sget_simple_extent_type(space) == H5S_NULL ? 0
        : product(H5Sget_simple_extent_dims(space, dims, NULL), dims);
}

/* How they are stored is asked before their extent: for that of a virtual dataset, HDF5 opens the files that it
 * refers to.  At most 1032 bytes of values can come from one of the file, if they are deflated.  Deflated twice, a
 * file would hold 1032^2 times its size; other filters take the size from the file. */
const char *
ss_h5_refuse_values(hid_t dataset, double *bytes)
{
    hsize_t chunk[H5S_MAX_RANK];
    hid_t how = H5Dget_create_plist(dataset);
    int outside = H5Pget_layout(how) == H5D_VIRTUAL || H5Pget_external_count(how) > 0;
    int deflated = 0, others = 0, n = H5Pget_nfilters(how);
    for (int i = 0; i < n; i++) {
        unsigned flags, config;
        size_t values = 0;
        H5Z_filter_t filter = H5Pget_filter2(how, (unsigned)i, &flags, &values, NULL, 0, NULL, &config);
        deflated += filter == H5Z_FILTER_DEFLATE;
        others += filter != H5Z_FILTER_DEFLATE && filter != H5Z_FILTER_SHUFFLE && filter != H5Z_FILTER_FLETCHER32;
    }
    double in_chunk = H5Pget_layout(how) == H5D_CHUNKED
        ? product(H5Pget_chunk(how, H5S_MAX_RANK, chunk), chunk) : 0;
    H5Pclose(how);
    if (outside)
        return "its values lie outside this file";
    if (n < 0 || deflated > 1 || others > 0)
        return "is packed otherwise than by deflate, once; h5repack -f GZIP=1 makes it so";
    hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    H5T_class_t class = H5Tget_class(type);
    size_t size = H5Tget_size(type);
    double width = deflated > 0 ? (double)size / 1032 : (double)size, values = values_in(space);
    H5Sclose(space);
    H5Tclose(type);
    *bytes = values * width;
    if ((class != H5T_INTEGER && class != H5T_FLOAT) || size > 16)
        return "does not hold real numbers";
    if (!(values >= 0 && values <= H5_MAX_VALUES))
        return "has more values than can be read at once";
    return fmax(values, in_chunk) * width > file_size(dataset)
        ? "claims more values than a file of this size can hold" : NULL;
}

/* --- attributes and values ----------------------------------------------------------------- */

int
ss_h5_get_number(hid_t object, const char *name, double *value)
{
    hid_t id = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
    if (id < 0)
        return 0;
    hid_t type = H5Aget_type(id), space = H5Aget_space(id);
    H5T_class_t class = H5Tget_class(type);
    int good = (class == H5T_INTEGER || class == H5T_FLOAT) && H5Tget_size(type) <= 16
               && values_in(space) == 1 && H5Aread(id, H5T_NATIVE_DOUBLE, value) >= 0;
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(id);
    return good;
}

/* Read a string of fixed or variable length as a new C string. */
static char *
read_text(h5_file *file, hid_t id, hid_t type)
{
    char *variable = NULL, *text = NULL;
    hid_t memory = H5Tcopy(H5T_C_S1);
    H5Tset_cset(memory, H5Tget_cset(type));
    if (H5Tis_variable_str(type) > 0) {
        H5Tset_size(memory, H5T_VARIABLE);
        if (H5Aread(id, memory, &variable) >= 0 && variable != NULL && (text = strdup(variable)) == NULL)
            file->status = SS_ENOMEM;
        H5free_memory(variable);
    } else if (H5Tget_size(type) < H5_MAX_TEXT) {
        size_t size = H5Tget_size(type) + 1;
        H5Tset_size(memory, size);
        if ((text = calloc(size, 1)) == NULL) {
            file->status = SS_ENOMEM;
        } else if (H5Aread(id, memory, text) < 0) {
            free(text);
            text = NULL;
        }
    }
    H5Tclose(memory);
    return text;
}

/* Attributes are not compressed, so their texts are no longer than the file, unless many attributes of
 * variable length refer to one text. */
static int
has_claimed_too_much(const h5_file *file)
{
    return file->text > fmax(file_size(file->id), H5_MAX_TEXT);
}

char *
ss_h5_get_text(h5_file *file, hid_t object, const char *name)
{
    char *text = NULL;
    hid_t id = file->status == SS_OK && H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
    if (id < 0)
        return NULL;
    hid_t type = H5Aget_type(id), space = H5Aget_space(id);
    if (H5Tget_class(type) == H5T_STRING && values_in(space) == 1 && !has_claimed_too_much(file))
        text = read_text(file, id, type);
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(id);
    file->text += text != NULL ? (double)strlen(text) : 0;
    if (has_claimed_too_much(file))
        ss_h5_fail(file, SS_EDATA, object, "", "attributes claim more text than the file holds");
    return text;
}

struct notes {
    h5_file *file;
    ss_header *head;
};

static herr_t
read_note(hid_t root, const char *name, const H5A_info_t *info, void *user)
{
    struct notes *notes = user;
    (void)info;
    if (notes->head->n_notes == MAX_NOTES || strcmp(name, H5_VERSION_NOTE) == 0)
        return 0;
    char *value = ss_h5_get_text(notes->file, root, name);
    if (value != NULL && notes->file->status == SS_OK
        && ss_header_note(notes->head, name, value, NULL) == SS_ENOMEM)     /* SS_EINVAL: it need be no note */
        notes->file->status = SS_ENOMEM;
    free(value);
    return notes->file->status != SS_OK;
}

double
ss_h5_need_number(h5_file *file, hid_t group, const char *name, double lo, double hi)
{
    double value = lo;
    char text[128];
    snprintf(text, sizeof text, "attribute '%s' is missing or out of range", name);
    if (file->status == SS_OK && !(ss_h5_get_number(group, name, &value) && value >= lo && value <= hi))
        ss_h5_fail(file, SS_EDATA, group, "", text);
    return value;
}

void
ss_h5_read_header(h5_file *file, hid_t group, ss_header **head)
{
    double rate = ss_h5_need_number(file, group, "rate", RATE_MIN, RATE_MAX);
    double start = ss_h5_need_number(file, group, "start", -START_MAX, START_MAX);
    double has_time = ss_h5_need_number(file, group, "has_time", 0, 1);
    if (file->status == SS_OK)
        file->status = ss_refuse_range(file->path, rate, start, file->err);
    if (file->status == SS_OK && *head == NULL)
        file->status = ss_header_new(head, 0, 0, NULL);
    if (file->status != SS_OK)
        return;
    (*head)->rate = rate;
    (*head)->start = start;
    (*head)->has_time = has_time != 0;
    /* the notes among the root's attributes, in the order in which they were written */
    hid_t root = ss_h5_open_group(file->id, "/"), how = H5Gget_create_plist(root);
    struct notes notes = { file, *head };
    unsigned tracked = 0;
    H5Pget_attr_creation_order(how, &tracked);
    int lost = H5Aexists(root, H5_VERSION_NOTE) < 0;    /* as for find_signal of read.c */
    herr_t stopped = lost ? -1 : H5Aiterate2(root, tracked != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME,
                                 H5_ITER_INC, NULL, read_note, &notes);
    H5Pclose(how);
    H5Gclose(root);
    if (stopped < 0)
        ss_h5_fail(file, SS_EIO, 0, "/", "attributes cannot be read");
    ss_status st = file->status == SS_OK ? ss_header_check_gaps(*head) : SS_OK;
    if (st == SS_EDATA)
        ss_h5_fail(file, st, 0, "/", WRONG_GAPS);
    else if (st != SS_OK)
        file->status = st;
}

hid_t
ss_h5_open_values(h5_file *file, hid_t group, const char *name, int *rank, hsize_t dims[])
{
    hid_t id = file->status == SS_OK ? ss_h5_open_dataset(group, name, 1) : -1;
    double bytes = 0;
    const char *wrong = id < 0 ? "no such dataset" : ss_h5_refuse_values(id, &bytes);
    file->claimed += bytes;
    if (wrong == NULL && file->claimed > file_size(id))
        wrong = "with those before, claims more values than a file of this size can hold";
    if (wrong != NULL) {
        ss_h5_fail(file, SS_EDATA, group, name, wrong);
        return id;
    }
    hid_t space = H5Dget_space(id);
    *rank = H5Sget_simple_extent_dims(space, dims, NULL);
    H5Sclose(space);
    return id;
}

hid_t
ss_h5_open_list(h5_file *file, hid_t group, const char *name, size_t *n)
{
    hsize_t dims[H5S_MAX_RANK] = { 0 };
    int rank = 1;
    hid_t id = ss_h5_open_values(file, group, name, &rank, dims);
    *n = (size_t)dims[0];
    if (rank != 1)
        ss_h5_fail(file, SS_EDATA, group, name, "not a list of values");
    return id;
}

int
ss_h5_read_piece(hid_t id, int rank, const hsize_t at[], const hsize_t count[], double *values)
{
    hid_t space = H5Dget_space(id), memory = H5Screate_simple(rank, count, NULL);
    int good = H5Sselect_hyperslab(space, H5S_SELECT_SET, at, NULL, count, NULL) >= 0
        && H5Dread(id, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    return good;
}

int
ss_h5_read_rows(hid_t id, int by_columns, size_t row, size_t n, double *values)
{
    hsize_t at[H5S_MAX_RANK] = { 0 }, count[H5S_MAX_RANK];
    hid_t space = H5Dget_space(id);
    int rank = H5Sget_simple_extent_dims(space, count, NULL), along = rank == 2 && by_columns;
    H5Sclose(space);
    at[along] = row;
    count[along] = n;
    return ss_h5_read_piece(id, rank, at, count, values);
}
