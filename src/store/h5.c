/* h5.c -- opening HDF5 files, reading attributes and datasets of real numbers. */
#include "h5.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../error.h"

ss_status
ss_h5_fail(h5_file *file, ss_status status, hid_t group, const char *name, const char *text)
{
    char where[256] = "";
    if (group > 0 && name[0] != '/')
        H5Iget_name(group, where, sizeof where);
    const char *colon = name[0] != '\0' || where[0] != '\0' ? ":" : "";
    const char *slash = name[0] != '\0' && where[0] != '\0' && strcmp(where, "/") != 0 ? "/" : "";
    return ss_fail(file->err, status, "%s%s%s%s%s: %s", file->path, colon, where, slash, name, text);
}

ss_status
ss_h5_open(h5_file *file)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    file->id = H5Fopen(file->path, H5F_ACC_RDONLY, access);
    H5Pclose(access);
    if (file->id < 0)
        return ss_h5_fail(file, SS_EDATA, 0, "", "not an HDF5 file, or a damaged one");
    return SS_OK;
}

int
ss_h5_get_number(hid_t object, const char *name, double *value)
{
    hid_t id = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
    if (id < 0)
        return 0;
    hid_t type = H5Aget_type(id), space = H5Aget_space(id);
    H5T_class_t class = H5Tget_class(type);
    int good = (class == H5T_INTEGER || class == H5T_FLOAT)
               && H5Sget_simple_extent_npoints(space) == 1
               && H5Aread(id, H5T_NATIVE_DOUBLE, value) >= 0;
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(id);
    return good;
}

/* A string of either storage, fixed or variable, as a new C string. */
static char *
read_text(hid_t id, hid_t type)
{
    char *text = NULL, *variable = NULL;
    hid_t memory = H5Tcopy(H5T_C_S1);
    H5Tset_cset(memory, H5Tget_cset(type));
    if (H5Tis_variable_str(type) > 0) {
        H5Tset_size(memory, H5T_VARIABLE);
        if (H5Aread(id, memory, &variable) >= 0 && variable != NULL)
            text = strdup(variable);
        H5free_memory(variable);
    } else {
        size_t size = H5Tget_size(type) + 1;
        H5Tset_size(memory, size);
        text = calloc(size, 1);
        if (text != NULL && H5Aread(id, memory, text) < 0) {
            free(text);
            text = NULL;
        }
    }
    H5Tclose(memory);
    return text;
}

char *
ss_h5_get_text(hid_t object, const char *name)
{
    char *text = NULL;
    hid_t id = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
    if (id < 0)
        return NULL;
    hid_t type = H5Aget_type(id), space = H5Aget_space(id);
    if (H5Tget_class(type) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1)
        text = read_text(id, type);
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(id);
    return text;
}

ss_status
ss_h5_read_values(h5_file *file, hid_t group, const char *name, double *values, size_t n)
{
    hid_t id = H5Dopen2(group, name, H5P_DEFAULT);
    if (id < 0)
        return ss_h5_fail(file, SS_EDATA, group, name, "no such dataset");
    hid_t type = H5Dget_type(id), space = H5Dget_space(id);
    H5T_class_t class = H5Tget_class(type);
    hssize_t points = H5Sget_simple_extent_npoints(space);
    ss_status status = SS_OK;
    if (class != H5T_INTEGER && class != H5T_FLOAT)
        status = ss_h5_fail(file, SS_EDATA, group, name, "not real numbers");
    else if (points < 0 || (size_t)points != n)
        status = ss_h5_fail(file, SS_EDATA, group, name, "not of the length that the others have");
    else if (H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)
        status = ss_h5_fail(file, SS_EIO, group, name, "cannot be read");
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(id);
    return status;
}

static herr_t
read_note(hid_t root, const char *name, const H5A_info_t *info, void *head)
{
    (void)info;
    char *value = strcmp(name, H5_VERSION_NOTE) != 0 ? ss_h5_get_text(root, name) : NULL;
    ss_status status = value != NULL ? ss_header_note(head, name, value) : SS_OK;
    free(value);
    return status != SS_OK && status != SS_EINVAL;      /* others may write what is no note of ours */
}

ss_status
ss_h5_read_notes(h5_file *file, ss_header *head)
{
    hid_t root = H5Gopen2(file->id, "/", H5P_DEFAULT), how = H5Gget_create_plist(root);
    unsigned tracked = 0;
    H5Pget_attr_creation_order(how, &tracked);
    herr_t stopped = H5Aiterate2(root, tracked != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME,
                                 H5_ITER_INC, NULL, read_note, head);
    H5Pclose(how);
    H5Gclose(root);
    if (stopped < 0)
        return ss_h5_fail(file, SS_EIO, 0, "/", "attributes cannot be read");
    return stopped > 0 ? SS_ENOMEM : SS_OK;
}
