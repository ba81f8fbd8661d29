/* read.c -- the rows of a signal in HDF5: of our /signal, or of any 1-D or 2-D array of real numbers of another
 * program.
 *
 * The columns of a 2-D array are its shorter dimension, whichever comes first: MATLAB stores its arrays
 * transposed.  Its clock is the caller's, that of times, or the attributes rate and start of the dataset or its
 * group, which our own files have.  Rows with times become a table, whose clock is found, checked and filled as
 * that of a table in text.
 *
 * Rows are read in pieces of whole chunks, so that no chunk is unpacked twice. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "io/format.h"
#include "io/hdf5/h5.h"
#include "io/table/sheet.h"
#include "signal/gaps.h"
#include "signal/header.h"

enum { PIECE = 1 << 18 };       /* values that are read at a time, unless chunks are larger */

typedef struct rows {
    ss_source base;
    h5_file file;
    hid_t *dataset;             /* one for all columns, or one for each */
    size_t n_datasets, room;
    int by_columns;             /* what is read at a time from a dataset is column after column */
    hid_t times;                /* of the rows, or 0 */
    int times_by_columns;
    int is_own;                 /* /signal, whose times must be those of its clock */
    int gaps;                   /* values that are not finite are missing, not wrong */
    size_t n;                   /* rows */
    size_t piece;               /* rows that are read at a time */
    double **value;             /* a piece of each column */
    double *raw;                /* a piece of a dataset of several columns, or of the times */
} rows;

/* --- arrays -------------------------------------------------------------------------------- */

typedef struct array {
    size_t rows, columns;
    int transposed;             /* 1: a column is contiguous in the file */
} array;

/* The reason why a dataset is no array of real numbers, or NULL and its shape. */
static const char *
refuse_array(hid_t id, int is_char, array *shape)
{
    hsize_t dims[H5S_MAX_RANK] = { 0, 1 };
    double bytes;
    hid_t type = H5Dget_type(id);
    H5T_class_t class = H5Tget_class(type);
    int pair = class == H5T_COMPOUND && H5Tget_nmembers(type) == 2
               && (H5Tget_member_index(type, "imag") >= 0 || H5Tget_member_index(type, "i") >= 0);
    H5Tclose(type);
    if (is_char || class == H5T_STRING)
        return "holds text, not numbers";
    const char *wrong = pair ? "holds complex numbers; a signal is real" : ss_h5_refuse_values(id, &bytes);
    if (wrong != NULL)
        return wrong;
    hid_t space = H5Dget_space(id);
    int rank = H5Sget_simple_extent_dims(space, dims, NULL);
    H5Sclose(space);
    if (rank != 1 && rank != 2)
        return rank > 2 ? "has more than two dimensions" : "is a single value, not an array";
    if (dims[0] == 0 || dims[1] == 0)
        return "is empty";
    shape->transposed = dims[0] < dims[1];
    shape->rows = (size_t)dims[!!shape->transposed];
    shape->columns = (size_t)dims[!shape->transposed];
    return shape->columns > MAX_COLUMNS ? "has more than 32768 columns" : NULL;
}

static array
shape_of(h5_file *file, hid_t id, const char *name)
{
    array shape = { 0 };
    char *matlab = ss_h5_get_text(file, id, "MATLAB_class");
    const char *wrong = refuse_array(id, matlab != NULL && strcmp(matlab, "char") == 0, &shape);
    free(matlab);
    if (wrong != NULL)
        ss_h5_fail(file, SS_EDATA, 0, name, wrong);
    return shape;
}

/* The list of arrays has at most so many letters; at most so many objects are visited, as all may be groups. */
enum { LISTED = 300, LOOKED_AT = 10000 };

struct list {
    h5_file *file;
    char text[LISTED + 10];                     /* 10 for the dots at its end */
    int looked_at;
};

/* Add a dataset, or dots and return 1 if its name does not fit.  HDF5's time for groups in groups grows with the
 * cube of their depth, so those whose names would not fit are not looked into: they end the list. */
static herr_t
list_dataset(hid_t root, const char *name, const H5O_info_t *info, void *user)
{
    struct list *list = user;
    size_t length = strlen(list->text), room = LISTED - length;
    int fits = strlen(name) < LISTED;
    if (++list->looked_at > LOOKED_AT)
        return 1;
    if (fits && info->type == H5O_TYPE_GROUP) {
        hid_t group = ss_h5_open_group(root, name);     /* asked for one name first, as in find_signal */
        int lost = H5Lexists(group, "t", H5P_DEFAULT) < 0;      /* and its names cannot be listed */
        H5Gclose(group);
        return lost;
    }
    if (fits && info->type != H5O_TYPE_DATASET)
        return 0;
    hid_t id = fits ? ss_h5_open_dataset(root, name, 0) : -1;
    if (id >= 0)
        shape_of(list->file, id, name);
    int is_array = id >= 0 && list->file->status == SS_OK;
    list->file->status = SS_OK;
    H5Dclose(id);
    if (fits && (!is_array || snprintf(list->text + length, room, " /%s", name) < (int)room))
        return 0;
    strcpy(list->text + length, " ...");
    return 1;
}

/* Find rate and start, the caller's or those in attributes of the dataset or its group, and the columns, which
 * have the name of the dataset, numbered from 1 if there are several. */
static void
make_header(rows *s, hid_t group, const char *dataset, size_t columns, double rate)
{
    double start = 0;
    hid_t id = *s->dataset, clock = H5Aexists(id, "rate") > 0 ? id : group;
    ss_status *status = &s->file.status;
    if (!(rate > 0)) {
        if (!ss_h5_get_number(clock, "rate", &rate))
            rate = 0;
        ss_h5_get_number(clock, "start", &start);
    }
    if (!(rate > 0) || !isfinite(rate) || !isfinite(start))
        ss_h5_fail(&s->file, SS_ECLOCK, 0, dataset, "has no clock");
    if (*status != SS_OK || (*status = ss_refuse_range(s->file.path, rate, start, s->file.err)) != SS_OK)
        return;
    s->base.head->rate = rate;
    s->base.head->start = start;
    const char *slash = strrchr(dataset, '/'), *name = slash != NULL ? slash + 1 : dataset;
    char *unit = ss_h5_get_text(&s->file, id, "units"), *numbered = malloc(strlen(name) + 3 * sizeof(size_t) + 1);
    if (numbered == NULL)
        *status = SS_ENOMEM;
    for (size_t c = 0; *status == SS_OK && c < columns; c++) {
        char *end = stpcpy(numbered, name);
        if (columns > 1)
            sprintf(end, "%zu", c + 1);
        *status = ss_header_add_column(s->base.head, numbered, unit, NULL);
    }
    free(unit);
    free(numbered);
}

/* Open the times of an array: at a path, or with a name in its group, unless a column has this name.  They become
 * the last column. */
static void
find_times(rows *s, hid_t group, const char *time)
{
    h5_file *file = &s->file;
    const char *slash = strrchr(time, '/');
    hid_t id = ss_h5_open_dataset(group, time, 1);
    if (id < 0) {
        if (ss_header_column(s->base.head, time) < 0)
            ss_h5_fail(file, SS_EDATA, group, time, "no such dataset");
        return;
    }
    s->times = id;
    const array shape = shape_of(file, id, time);
    if (shape.columns > 1 || shape.rows != s->n)
        ss_h5_fail(file, SS_EDATA, group, time, "not one time for each row of the signal");
    s->times_by_columns = shape.transposed;
    char *unit = ss_h5_get_text(file, id, "units");
    char *since = unit != NULL ? strstr(unit, " since ") : NULL;        /* "s since 1970-01-01 00:00" */
    if (since != NULL)
        *since = '\0';
    if (file->status == SS_OK)
        file->status = ss_header_add_column(s->base.head, slash != NULL ? slash + 1 : time, unit, NULL);
    free(unit);
}

static void
find_array(rows *s, const char *dataset, const ss_read_opts *opts)
{
    h5_file *file = &s->file;
    const char *slash = strrchr(dataset, '/');
    int has_name = slash == NULL || slash[1] != '\0';           /* for its columns */
    char *parent = slash == NULL ? strdup("/") : strndup(dataset, (size_t)(slash - dataset) + 1);
    s->dataset = malloc(sizeof *s->dataset);
    if (parent == NULL || s->dataset == NULL) {
        free(parent);
        file->status = SS_ENOMEM;
        return;
    }
    hid_t id = has_name ? ss_h5_open_dataset(file->id, dataset, 1) : -1;
    hid_t group = ss_h5_open_group(file->id, id < 0 ? dataset : parent);
    free(parent);
    if (id < 0) {
        ss_h5_fail(file, SS_EDATA, 0, dataset, group >= 0 ? "a group, not a dataset" : "no such dataset");
        return;
    }
    s->dataset[s->n_datasets++] = id;
    const array shape = shape_of(file, id, dataset);
    if (opts->table > 0)
        ss_h5_fail(file, SS_EDATA, 0, dataset, "not delimited text: no table can be chosen");
    if (opts->time_unit != NULL && opts->time == NULL)
        ss_h5_fail(file, SS_EDATA, 0, dataset,
                   "a unit of time is that of a dataset of times, which must be chosen");
    s->n = shape.rows;
    s->by_columns = shape.transposed;
    s->gaps = opts->gaps != SS_GAPS_REFUSE || opts->time != NULL;   /* a table refuses them itself */
    make_header(s, group, dataset, shape.columns, opts->time != NULL ? 1 : opts->rate);
    if (file->status == SS_OK && opts->time != NULL)
        find_times(s, group, opts->time);
}

/* --- /signal ------------------------------------------------------------------------------- */

/* Add the dataset at a link as a column of the header, unless it is that of the times. */
static herr_t
add_column(hid_t group, const char *link, const H5L_info_t *info, void *user)
{
    rows *s = user;
    h5_file *file = &s->file;
    size_t own;
    (void)info;
    if (strcmp(link, "t") == 0)
        return 0;
    if (s->n_datasets == MAX_COLUMNS)
        ss_h5_fail(file, SS_EDATA, group, "", "has more than 32768 columns");
    hid_t *more = ss_list_room(s->dataset, &s->room, s->n_datasets, sizeof *more);
    s->dataset = more != NULL ? more : s->dataset;
    if (more == NULL)
        file->status = SS_ENOMEM;
    if (file->status != SS_OK)
        return 1;
    hid_t id = more[s->n_datasets++] = ss_h5_open_list(file, group, link, &own);
    if (own != s->n)
        ss_h5_fail(file, SS_EDATA, group, link, "not as long as t");
    char *name = ss_h5_get_text(file, id, "column"), *unit = ss_h5_get_text(file, id, "units");
    if (file->status == SS_OK)
        file->status = ss_header_add_column(s->base.head, name != NULL && *name != '\0' ? name : link, unit, NULL);
    free(name);
    free(unit);
    return file->status != SS_OK;
}

/* Open all columns of /signal, in the order of writing if the file has it, else in that of their names.  Asked
 * for one name after the other, HDF5 would sort them all again for each, if the group has no index of that order.
 * Open one of them before: HDF5 1.10 frees pointers that it has not set if it cannot read the heap of the names
 * while it lists them. */
static void
find_signal(rows *s, const ss_read_opts *opts)
{
    h5_file *file = &s->file;
    struct list list = { .file = file };
    unsigned tracked = 0;
    if (H5Lexists(file->id, "signal", H5P_DEFAULT) <= 0) {
        H5Ovisit(file->id, H5_INDEX_NAME, H5_ITER_INC, list_dataset, &list);
        if (list.text[0] == '\0')
            ss_h5_fail(file, SS_EKIND, 0, "", "no /signal in it, nor any array of real numbers");
        else
            file->status = ss_fail(file->err, SS_EKIND, "%s: no /signal in it; choose one as %s:/PATH from%s",
                                   file->path, file->path, list.text);
        return;
    }
    hid_t group = ss_h5_open_group(file->id, "/signal");
    if (group < 0)
        ss_h5_fail(file, SS_EDATA, 0, "/signal", "not a group of this file");
    s->is_own = 1;
    ss_h5_read_header(file, group, &s->base.head);
    s->times = ss_h5_open_list(file, group, "t", &s->n);
    if (file->status != SS_OK)
        return;
    hid_t how = H5Gget_create_plist(group);
    H5Pget_link_creation_order(how, &tracked);
    H5Pclose(how);
    H5_index_t order = tracked & H5P_CRT_ORDER_TRACKED ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
    if (H5Literate(group, order, H5_ITER_INC, NULL, add_column, s) < 0)
        ss_h5_fail(file, SS_EIO, group, "", "cannot be read");
    s->by_columns = s->n_datasets > 1;
    if (file->status == SS_OK)
        file->status = ss_refuse_clock(file->path, s->base.head->rate, opts, file->err);
}

/* --- rows ---------------------------------------------------------------------------------- */

/* The number of rows in a chunk of a dataset, at least so many. */
static hsize_t
longer_chunk(hsize_t least, hid_t id, int by_columns)
{
    hsize_t chunk[H5S_MAX_RANK] = { 0 };
    hid_t how = H5Dget_create_plist(id);
    int rank = H5Pget_layout(how) == H5D_CHUNKED ? H5Pget_chunk(how, H5S_MAX_RANK, chunk) : 0;
    H5Pclose(how);
    hsize_t own = chunk[rank == 2 && by_columns];
    return own > least ? own : least;
}

/* The columns of each dataset. */
static size_t
columns_of(const rows *s)
{
    return s->n_datasets > 1 || s->is_own ? 1 : s->base.head->n_columns - (s->times > 0);
}

/* Read the next n rows.  Times of our own files are not given, but must be those of the clock.  Values that are
 * not finite become NaN if there may be gaps, else SS_EDATA. */
static void
read_piece(rows *s, size_t n)
{
    const ss_header *head = s->base.head;
    double *times = s->is_own ? s->raw : s->value[head->n_columns - 1];
    char text[64];
    size_t row = (size_t)s->base.row, columns = columns_of(s);
    if (n > 0 && s->times > 0 && !ss_h5_read_rows(s->times, s->times_by_columns, row, n, times))
        ss_h5_fail(&s->file, SS_EIO, s->times, "", "cannot be read");
    for (size_t i = 0; s->is_own && s->file.status == SS_OK && i < n; i++)
        if (!ss_is_on_clock(times[i], head->rate, head->start, row + i)) {
            snprintf(text, sizeof text, "value %zu is not start + %zu / rate", row + i + 1, row + i);
            ss_h5_fail(&s->file, SS_EDATA, s->times, "", text);
        }
    for (size_t d = 0; s->file.status == SS_OK && n > 0 && d < s->n_datasets; d++) {
        double *x = columns == 1 ? s->value[d] : s->raw;
        if (!ss_h5_read_rows(s->dataset[d], s->by_columns, row, n, x))
            ss_h5_fail(&s->file, SS_EIO, s->dataset[d], "", "cannot be read");
        for (size_t i = 0; s->file.status == SS_OK && i < n * columns; i++) {
            if (isfinite(x[i]))
                continue;
            x[i] = NAN;
            if (s->gaps)
                continue;
            size_t place = s->by_columns ? i / n * s->n + row + i % n : row * columns + i;
            snprintf(text, sizeof text, "value %zu is not finite", place + 1);
            ss_h5_fail(&s->file, SS_EDATA, s->dataset[d], "", text);
        }
        for (size_t c = 0; columns > 1 && c < columns; c++)
            for (size_t i = 0; i < n; i++)
                s->value[c][i] = x[s->by_columns ? c * n + i : i * columns + c];
    }
    if (s->file.status != SS_OK)
        return;
    s->base.row += n;
    s->base.held = n;
    s->base.given = 0;
}

static ss_status
make_rows(ss_source *base, double *const column[], size_t max, size_t *n, ss_error *err)
{
    rows *s = (rows *)base;
    size_t left = s->n - (size_t)base->row;
    (void)column, (void)max, (void)n;
    s->file.err = err;
    s->file.status = SS_OK;
    QUIETLY(
        read_piece(s, left < s->piece ? left : s->piece);
    );
    return s->file.status;
}

static void
free_rows(ss_source *base)
{
    rows *s = (rows *)base;
    QUIETLY(
        ss_h5_close(&s->file);
    );
    free(s->dataset);
    free(s->value);
    free(s->raw);
}

/* --- opening ------------------------------------------------------------------------------- */

/* At a time are read: whole chunks of the dataset with the longest chunks, about PIECE values in all, or all
 * rows. */
static ss_status
find(rows *s, const char *path, const char *dataset, const ss_read_opts *opts, ss_error *err)
{
    hsize_t chunk = 1;
    ss_h5_open(&s->file, path, err);
    if (s->file.status == SS_OK && *dataset != '\0')
        find_array(s, dataset, opts);
    else if (s->file.status == SS_OK)
        find_signal(s, opts);
    if (s->file.status != SS_OK)
        return s->file.status;
    for (size_t d = 0; d < s->n_datasets; d++)
        chunk = longer_chunk(chunk, s->dataset[d], s->by_columns);
    if (s->times > 0 && !s->is_own)
        chunk = longer_chunk(chunk, s->times, s->times_by_columns);
    hsize_t target = PIECE / (s->base.head->n_columns + 1) + 1;
    hsize_t n = chunk < target ? target / chunk * chunk : chunk;
    s->base.length = s->n;
    s->piece = n < s->n ? (size_t)n : s->n;
    s->value = ss_columns_new(s->base.head->n_columns, s->piece);
    s->raw = malloc((s->piece * columns_of(s) + 1) * sizeof *s->raw);       /* times: one column */
    if (s->value == NULL || s->raw == NULL)
        return SS_ENOMEM;
    s->base.made = *s->value;
    s->base.apart = s->piece;
    return SS_OK;
}

ss_status
ss_h5_open_signal(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts, ss_error *err)
{
    static const struct source_calls calls = { .next = make_rows, .free = free_rows };
    dataset = dataset != NULL ? dataset : "";
    char *name = malloc(strlen(path) + strlen(dataset) + 2);
    if (name == NULL)
        return ss_fail_memory(err, path);
    stpcpy(stpcpy(stpcpy(name, path), *dataset != '\0' ? ":" : ""), dataset);
    rows *s = ss_source_new(sizeof *s, &calls, name, err);
    free(name);
    if (s == NULL)
        return SS_ENOMEM;
    *out = &s->base;
    s->base.rewinds = 1;
    ss_status status;
    QUIETLY(
        status = find(s, path, dataset, opts, err);
    );
    if (status == SS_ENOMEM)
        ss_fail(err, status, "%s: %s", path, ss_strerror(status));
    if (status == SS_OK && opts->time != NULL && *dataset != '\0') {
        ss_read_opts own = *opts;
        own.time = s->times > 0 ? s->base.head->column[s->base.head->n_columns - 1].name : opts->time;
        return ss_sheet_of_source(out, &own, 1, (ss_progress){ NULL, NULL }, err);
    }
    return status == SS_OK && s->gaps ? ss_source_fill_gaps(out, opts->gaps, err) : status;
}
