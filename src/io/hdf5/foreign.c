/* foreign.c -- datasets of files from other programs: any 1-D or 2-D array of real numbers.
 *
 * The columns of a 2-D array are its shorter dimension, whichever comes first: MATLAB stores its
 * arrays transposed.  The clock is the caller's, that of a dataset of times (timed_rows.c), or the
 * attributes rate and start of the dataset or its group, which our own files have. */
#include "io/hdf5/groups.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"

typedef struct array {
    size_t rows, columns;
    int transposed;             /* 1: a column is contiguous in the file */
} array;

/* --- readable datasets --------------------------------------------------------------------- */

/* SS_OK if a dataset holds real numbers; else *why becomes the reason, or NULL if it is in file->err. */
static ss_status
check_type(h5_file *file, hid_t id, const char **why)
{
    char *matlab;
    *why = NULL;
    ss_status status = ss_h5_get_text(file, id, "MATLAB_class", &matlab);
    if (status != SS_OK)
        return status;
    hid_t type = H5Dget_type(id);
    H5T_class_t class = H5Tget_class(type);
    int text = class == H5T_STRING || (matlab != NULL && strcmp(matlab, "char") == 0);
    int pair = class == H5T_COMPOUND && H5Tget_nmembers(type) == 2
               && (H5Tget_member_index(type, "imag") >= 0 || H5Tget_member_index(type, "i") >= 0);
    free(matlab);
    H5Tclose(type);
    *why = text ? "holds text, not numbers"
         : pair ? "holds complex numbers; a signal is real" : ss_h5_refuse_values(id);
    return *why == NULL ? SS_OK : SS_EDATA;
}

static const char *
get_shape(hid_t id, array *shape)
{
    hid_t space = H5Dget_space(id);
    hsize_t dims[H5S_MAX_RANK] = { 0, 1 };
    int rank = H5Sget_simple_extent_ndims(space);
    if (rank > 0)
        H5Sget_simple_extent_dims(space, dims, NULL);
    H5Sclose(space);
    if (rank != 1 && rank != 2)
        return rank > 2 ? "has more than two dimensions" : "is a single value, not an array";
    if (dims[0] == 0 || dims[1] == 0)
        return "is empty";
    shape->transposed = dims[0] < dims[1];
    shape->rows = (size_t)(shape->transposed ? dims[1] : dims[0]);
    shape->columns = (size_t)(shape->transposed ? dims[0] : dims[1]);
    if (shape->columns > MAX_COLUMNS)
        return "has more than 32768 columns";
    return NULL;
}

/* --- the list ------------------------------------------------------------------------------ */

/* The list has at most so many letters; at most so many objects are visited, as all may be groups. */
enum { LISTED = 300, LOOKED_AT = 10000 };

struct list {
    h5_file *file;
    char text[LISTED + 10];                     /* 10 for the dots at its end */
    int looked_at;
};

/* Add a name, or dots and return 1 if it does not fit. */
static int
append_name(struct list *list, const char *name)
{
    size_t length = strlen(list->text), room = LISTED - length;
    int full = snprintf(list->text + length, room, " /%s", name) >= (int)room;
    if (full)
        strcpy(list->text + length, " ...");
    return full;
}

/* Can the names in a group not be read?  They are asked for one first, as list_links of signal_reader.c does. */
static int
has_lost_names(hid_t root, const char *name)
{
    hid_t group = ss_h5_open_group(root, name);
    int lost = H5Lexists(group, "t", H5P_DEFAULT) < 0;
    H5Gclose(group);
    return lost;
}

/* HDF5's time for groups in groups grows with the cube of their depth, so those whose names would not fit
 * are not looked into: they end the list. */
static herr_t
list_dataset(hid_t root, const char *name, const H5O_info_t *info, void *user)
{
    array shape;
    const char *why;
    struct list *list = user;
    if (++list->looked_at > LOOKED_AT)
        return 1;
    if (strlen(name) >= LISTED)
        return append_name(list, name);
    if (info->type == H5O_TYPE_GROUP)
        return has_lost_names(root, name);
    if (info->type != H5O_TYPE_DATASET)
        return 0;
    hid_t id = ss_h5_open_dataset(root, name);
    int full = id >= 0 && check_type(list->file, id, &why) == SS_OK && get_shape(id, &shape) == NULL
        && append_name(list, name);
    H5Dclose(id);
    return full;
}

ss_status
ss_h5_fail_listing(h5_file *file)
{
    struct list list = { .file = file };
    H5Ovisit(file->id, H5_INDEX_NAME, H5_ITER_INC, list_dataset, &list);
    if (list.text[0] == '\0')
        return ss_h5_fail(file, SS_EKIND, 0, "", "no /signal in it, nor any array of real numbers");
    return ss_fail(file->err, SS_EKIND, "%s: no /signal in it; choose one as %s:/PATH from%s",
                   file->path, file->path, list.text);
}

/* --- one dataset --------------------------------------------------------------------------- */

/* The path of the group of a dataset, to be freed; NULL: no memory. */
static char *
parent_of(const char *dataset)
{
    const char *slash = strrchr(dataset, '/');
    return slash == NULL ? strdup("") : strndup(dataset, slash > dataset ? (size_t)(slash - dataset) : 1);
}

/* Find rate and start: the caller's, else those in attributes of the dataset or its group. */
static ss_status
find_clock(h5_file *file, hid_t id, const char *dataset, double *rate, double *start)
{
    *start = 0;
    if (*rate > 0)
        return SS_OK;
    char *parent = parent_of(dataset);
    if (parent == NULL)
        return SS_ENOMEM;
    hid_t group = parent[0] != '\0' ? ss_h5_open_group(file->id, parent) : -1;
    free(parent);
    int found = ss_h5_get_number(id, "rate", rate);
    if (found)
        ss_h5_get_number(id, "start", start);
    else if (group >= 0 && (found = ss_h5_get_number(group, "rate", rate)))
        ss_h5_get_number(group, "start", start);
    H5Gclose(group);
    if (!found || !(*rate > 0) || !isfinite(*rate) || !isfinite(*start))
        return ss_h5_fail(file, SS_ECLOCK, 0, dataset, "has no clock");
    return SS_OK;
}

/* Make a header whose columns have the name of the dataset, numbered from 1 if there are several. */
static ss_status
make_header(h5_file *file, hid_t id, const char *dataset, const array *shape, double rate, ss_header *head)
{
    double start;
    ss_status status = find_clock(file, id, dataset, &rate, &start);
    if (status == SS_OK)
        status = ss_refuse_range(file->path, rate, start, file->err);
    if (status != SS_OK)
        return status;
    head->rate = rate;
    head->start = start;
    const char *slash = strrchr(dataset, '/'), *base = slash != NULL ? slash + 1 : dataset;
    char *unit, *name = malloc(strlen(base) + 3 * sizeof(size_t) + 1);
    if (name == NULL)
        return SS_ENOMEM;
    status = ss_h5_get_text(file, id, "units", &unit);
    for (size_t c = 0; status == SS_OK && c < shape->columns; c++) {
        char *end = stpcpy(name, base);
        if (shape->columns > 1)
            sprintf(end, "%zu", c + 1);
        status = ss_header_add_column(head, name, unit, NULL);
    }
    free(unit);
    free(name);
    return status;
}

/* Open the dataset of times at a path, if there is one. */
static ss_status
open_times(signal_rows *s, const char *path)
{
    array shape;
    const char *wrong;
    hid_t found = ss_h5_open_pieces(s->file.id, path);
    if (found < 0)
        return SS_OK;
    ss_status status = check_type(&s->file, found, &wrong);
    if (status == SS_OK)
        wrong = get_shape(found, &shape);
    if (wrong == NULL && status == SS_OK && (shape.columns > 1 || shape.rows != s->n))
        wrong = "not one time for each row of the signal";
    if (wrong != NULL)
        return ss_h5_fail(&s->file, SS_EDATA, 0, path, wrong);
    if (status == SS_OK) {
        s->stamps = found;
        s->stamps_by_columns = shape.transposed;
    }
    return status;
}

/* Find the dataset of times of an array: at a path, or with a name in the group of the array, unless a column of
 * the array has this name. */
static ss_status
find_times(signal_rows *s, const ss_header *head, const char *dataset, const char *time)
{
    char *parent = time[0] != '/' ? parent_of(dataset) : strdup("");
    char *path = parent != NULL ? malloc(strlen(parent) + strlen(time) + 2) : NULL;
    ss_status status = path != NULL ? SS_OK : SS_ENOMEM;
    if (status == SS_OK) {
        const char *between = parent[0] != '\0' && strcmp(parent, "/") != 0 ? "/" : "";
        stpcpy(stpcpy(stpcpy(path, parent), between), time);
        status = open_times(s, path);
    }
    if (status == SS_OK && s->stamps == 0 && ss_header_column(head, time) < 0)
        status = ss_h5_fail(&s->file, SS_EDATA, 0, path, "no such dataset");
    free(path);
    free(parent);
    return status;
}

ss_status
ss_h5_find_array(signal_rows *s, const char *dataset, const ss_read_opts *opts)
{
    array shape = { .rows = 0 };
    h5_file *file = &s->file;
    const char *slash = strrchr(dataset, '/');
    int has_name = slash == NULL || slash[1] != '\0';           /* for its columns */
    hid_t id = has_name ? ss_h5_open_pieces(file->id, dataset) : -1;
    s->dataset = malloc(sizeof *s->dataset);
    if (s->dataset == NULL)
        return SS_ENOMEM;
    if (id < 0) {
        hid_t group = ss_h5_open_group(file->id, dataset);
        if (group >= 0)
            H5Gclose(group);
        return ss_h5_fail(file, SS_EDATA, 0, dataset, group >= 0 ? "a group, not a dataset" : "no such dataset");
    }
    const char *wrong;
    ss_status status = check_type(file, id, &wrong);
    if (status == SS_OK)
        wrong = get_shape(id, &shape);
    if (status == SS_OK && wrong == NULL && opts->table > 0)
        wrong = "not delimited text: no table can be chosen";
    if (status == SS_OK && wrong == NULL && opts->time_unit != NULL && opts->time == NULL)
        wrong = "a unit of time is that of a dataset of times, which must be chosen";
    if (wrong != NULL)
        status = ss_h5_fail(file, SS_EDATA, 0, dataset, wrong);
    s->dataset[s->n_datasets++] = id;
    s->n = shape.rows;
    s->by_columns = shape.transposed;
    s->gaps = opts->gaps != SS_GAPS_REFUSE;
    if (status == SS_OK)
        status = make_header(file, id, dataset, &shape, opts->time != NULL ? 1 : opts->rate, s->base.head);
    return status == SS_OK && opts->time != NULL ? find_times(s, s->base.head, dataset, opts->time) : status;
}
