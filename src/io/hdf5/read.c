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
#include "base/columns.h"
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
    char *path;                 /* of the file */
    hid_t *dataset;             /* one for all columns, or one for each */
    size_t n_datasets, room;
    ss_status status;           /* of the last one that was opened */
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

static ss_status
check_array(h5_file *file, hid_t id, const char *name, array *shape)
{
    char *matlab;
    ss_status status = ss_h5_get_text(file, id, "MATLAB_class", &matlab);
    if (status != SS_OK)
        return status;
    const char *wrong = refuse_array(id, matlab != NULL && strcmp(matlab, "char") == 0, shape);
    free(matlab);
    return wrong == NULL ? SS_OK : ss_h5_fail(file, SS_EDATA, 0, name, wrong);
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
    array shape;
    struct list *list = user;
    size_t length = strlen(list->text), room = LISTED - length;
    int fits = strlen(name) < LISTED;
    if (++list->looked_at > LOOKED_AT)
        return 1;
    if (fits && info->type == H5O_TYPE_GROUP) {
        hid_t group = ss_h5_open_group(root, name);     /* asked for one name first, as in find_columns */
        int lost = H5Lexists(group, "t", H5P_DEFAULT) < 0;
        H5Gclose(group);
        return lost;
    }
    if (fits && info->type != H5O_TYPE_DATASET)
        return 0;
    hid_t id = fits ? ss_h5_open_dataset(root, name, 0) : -1;
    int is_array = id >= 0 && check_array(list->file, id, name, &shape) == SS_OK;
    H5Dclose(id);
    if (fits && (!is_array || snprintf(list->text + length, room, " /%s", name) < (int)room))
        return 0;
    strcpy(list->text + length, " ...");
    return 1;
}

static ss_status
fail_listing(h5_file *file)
{
    struct list list = { .file = file };
    H5Ovisit(file->id, H5_INDEX_NAME, H5_ITER_INC, list_dataset, &list);
    if (list.text[0] == '\0')
        return ss_h5_fail(file, SS_EKIND, 0, "", "no /signal in it, nor any array of real numbers");
    return ss_fail(file->err, SS_EKIND, "%s: no /signal in it; choose one as %s:/PATH from%s",
                   file->path, file->path, list.text);
}

/* Find rate and start, the caller's or those in attributes of the dataset or its group, and the columns, which
 * have the name of the dataset, numbered from 1 if there are several. */
static ss_status
make_header(rows *s, hid_t group, const char *dataset, const array *shape, double rate)
{
    double start = 0;
    hid_t id = *s->dataset, clock = H5Aexists(id, "rate") > 0 ? id : group;
    if (!(rate > 0)) {
        if (!ss_h5_get_number(clock, "rate", &rate))
            rate = 0;
        ss_h5_get_number(clock, "start", &start);
    }
    if (!(rate > 0) || !isfinite(rate) || !isfinite(start))
        return ss_h5_fail(&s->file, SS_ECLOCK, 0, dataset, "has no clock");
    ss_status status = ss_refuse_range(s->path, rate, start, s->file.err);
    if (status != SS_OK)
        return status;
    s->base.head->rate = rate;
    s->base.head->start = start;
    const char *slash = strrchr(dataset, '/'), *name = slash != NULL ? slash + 1 : dataset;
    char *unit, *numbered = malloc(strlen(name) + 3 * sizeof(size_t) + 1);
    if (numbered == NULL)
        return SS_ENOMEM;
    status = ss_h5_get_text(&s->file, id, "units", &unit);
    for (size_t c = 0; status == SS_OK && c < shape->columns; c++) {
        char *end = stpcpy(numbered, name);
        if (shape->columns > 1)
            sprintf(end, "%zu", c + 1);
        status = ss_header_add_column(s->base.head, numbered, unit, NULL);
    }
    free(unit);
    free(numbered);
    return status;
}

/* Open the times of an array: at a path, or with a name in its group, unless a column has this name.  They become
 * the last column. */
static ss_status
find_times(rows *s, hid_t group, const char *time)
{
    array shape;
    const char *slash = strrchr(time, '/');
    char *unit = NULL;
    hid_t id = ss_h5_open_dataset(group, time, 1);
    if (id < 0)
        return ss_header_column(s->base.head, time) >= 0 ? SS_OK
            : ss_h5_fail(&s->file, SS_EDATA, group, time, "no such dataset");
    s->times = id;
    ss_status status = check_array(&s->file, id, time, &shape);
    if (status == SS_OK && (shape.columns > 1 || shape.rows != s->n))
        status = ss_h5_fail(&s->file, SS_EDATA, group, time, "not one time for each row of the signal");
    s->times_by_columns = shape.transposed;
    if (status == SS_OK)
        status = ss_h5_get_text(&s->file, id, "units", &unit);
    char *since = unit != NULL ? strstr(unit, " since ") : NULL;        /* "s since 1970-01-01 00:00" */
    if (since != NULL)
        *since = '\0';
    if (status == SS_OK)
        status = ss_header_add_column(s->base.head, slash != NULL ? slash + 1 : time, unit, NULL);
    free(unit);
    return status;
}

static ss_status
find_array(rows *s, const char *dataset, const ss_read_opts *opts)
{
    array shape;
    h5_file *file = &s->file;
    const char *slash = strrchr(dataset, '/');
    int has_name = slash == NULL || slash[1] != '\0';           /* for its columns */
    char *parent = slash == NULL ? strdup("/") : strndup(dataset, (size_t)(slash - dataset) + 1);
    s->dataset = malloc(sizeof *s->dataset);
    if (parent == NULL || s->dataset == NULL) {
        free(parent);
        return SS_ENOMEM;
    }
    hid_t id = has_name ? ss_h5_open_dataset(file->id, dataset, 1) : -1;
    hid_t group = ss_h5_open_group(file->id, id < 0 ? dataset : parent);
    free(parent);
    if (id < 0)
        return ss_h5_fail(file, SS_EDATA, 0, dataset, group >= 0 ? "a group, not a dataset" : "no such dataset");
    s->dataset[s->n_datasets++] = id;
    ss_status status = check_array(file, id, dataset, &shape);
    if (status != SS_OK)
        return status;
    if (opts->table > 0)
        return ss_h5_fail(file, SS_EDATA, 0, dataset, "not delimited text: no table can be chosen");
    if (opts->time_unit != NULL && opts->time == NULL)
        return ss_h5_fail(file, SS_EDATA, 0, dataset, "a unit of time is that of a dataset of times, which must "
                          "be chosen");
    s->n = shape.rows;
    s->by_columns = shape.transposed;
    s->gaps = opts->gaps != SS_GAPS_REFUSE || opts->time != NULL;   /* a table refuses them itself */
    status = make_header(s, group, dataset, &shape, opts->time != NULL ? 1 : opts->rate);
    return status == SS_OK && opts->time != NULL ? find_times(s, group, opts->time) : status;
}

/* --- /signal ------------------------------------------------------------------------------- */

/* Add the dataset at a link as a column of the header. */
static ss_status
add_column(rows *s, hid_t group, const char *link)
{
    size_t own;
    char *name = NULL, *unit = NULL;
    hid_t *more = ss_list_room(s->dataset, &s->room, s->n_datasets, sizeof *more);
    if (more == NULL)
        return SS_ENOMEM;
    s->dataset = more;
    if (s->n_datasets == MAX_COLUMNS)
        return ss_h5_fail(&s->file, SS_EDATA, group, "", "has more than 32768 columns");
    hid_t *id = &more[s->n_datasets++];
    ss_status status = ss_h5_open_list(&s->file, group, link, id, &own);
    if (status == SS_OK && own != s->n)
        status = ss_h5_fail(&s->file, SS_EDATA, group, link, "not as long as t");
    if (status == SS_OK)
        status = ss_h5_get_text(&s->file, *id, "column", &name);
    if (status == SS_OK)
        status = ss_h5_get_text(&s->file, *id, "units", &unit);
    if (status == SS_OK)
        status = ss_header_add_column(s->base.head, name != NULL && *name != '\0' ? name : link, unit, NULL);
    free(name);
    free(unit);
    return status;
}

static herr_t
add_link(hid_t group, const char *name, const H5L_info_t *info, void *user)
{
    rows *s = user;
    (void)info;
    if (strcmp(name, "t") != 0)
        s->status = add_column(s, group, name);
    return s->status != SS_OK;
}

/* Open all columns of a group, in the order of writing if the file has it, else in that of their names.  Asked
 * for one name after the other, HDF5 would sort them all again for each, if the group has no index of that order.
 * Open one of them before: HDF5 1.10 frees pointers that it has not set if it cannot read the heap of the names
 * while it lists them. */
static ss_status
find_columns(rows *s, hid_t group)
{
    unsigned tracked = 0;
    hid_t how = H5Gget_create_plist(group);
    H5Pget_link_creation_order(how, &tracked);
    H5Pclose(how);
    H5_index_t order = tracked & H5P_CRT_ORDER_TRACKED ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
    if (H5Literate(group, order, H5_ITER_INC, NULL, add_link, s) < 0)
        return ss_h5_fail(&s->file, SS_EIO, group, "", "cannot be read");
    s->by_columns = s->n_datasets > 1;
    return s->status;
}

static ss_status
find_signal(rows *s, const ss_read_opts *opts)
{
    h5_file *file = &s->file;
    if (H5Lexists(file->id, "signal", H5P_DEFAULT) <= 0)
        return fail_listing(file);
    hid_t group = ss_h5_open_group(file->id, "/signal");
    if (group < 0)
        return ss_h5_fail(file, SS_EDATA, 0, "/signal", "not a group of this file");
    s->is_own = 1;
    ss_status status = ss_h5_read_header(file, group, &s->base.head);
    if (status == SS_OK)
        status = ss_h5_open_list(file, group, "t", &s->times, &s->n);
    if (status == SS_OK)
        status = find_columns(s, group);
    return status == SS_OK ? ss_refuse_clock(file->path, s->base.head->rate, opts, file->err) : status;
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

/* The number of rows to read at a time: whole chunks of the dataset with the longest chunks, about PIECE
 * values in all, or all rows. */
static size_t
piece_rows(const rows *s)
{
    hsize_t chunk = 1, target = PIECE / (s->base.head->n_columns + 1) + 1;
    for (size_t d = 0; d < s->n_datasets; d++)
        chunk = longer_chunk(chunk, s->dataset[d], s->by_columns);
    if (s->times > 0 && !s->is_own)
        chunk = longer_chunk(chunk, s->times, s->times_by_columns);
    hsize_t n = chunk < target ? target / chunk * chunk : chunk;
    return n < s->n ? (size_t)n : s->n;
}

/* The columns of each dataset. */
static size_t
columns_of(const rows *s)
{
    return s->n_datasets > 1 || s->is_own ? 1 : s->base.head->n_columns - (s->times > 0);
}

/* Read n rows of dataset d, which has so many columns, into columns of the piece.  Values that are not finite
 * become NaN if there may be gaps, else SS_EDATA. */
static ss_status
read_dataset(rows *s, size_t d, size_t n, size_t columns)
{
    char text[64];
    double *x = columns == 1 ? s->value[d] : s->raw;
    size_t row = (size_t)s->base.row;
    if (!ss_h5_read_rows(s->dataset[d], s->by_columns, row, n, x))
        return ss_h5_fail(&s->file, SS_EIO, s->dataset[d], "", "cannot be read");
    for (size_t i = 0; i < n * columns; i++) {
        if (isfinite(x[i]))
            continue;
        x[i] = NAN;
        if (s->gaps)
            continue;
        size_t place = s->by_columns ? i / n * s->n + row + i % n : row * columns + i;
        snprintf(text, sizeof text, "value %zu is not finite", place + 1);
        return ss_h5_fail(&s->file, SS_EDATA, s->dataset[d], "", text);
    }
    for (size_t c = 0; columns > 1 && c < columns; c++)
        for (size_t i = 0; i < n; i++)
            s->value[c][i] = x[s->by_columns ? c * n + i : i * columns + c];
    return SS_OK;
}

/* Read the next n rows.  Times of our own files are not given, but must be those of the clock. */
static ss_status
read_piece(rows *s, size_t n)
{
    const ss_header *head = s->base.head;
    double *times = s->is_own ? s->raw : s->value[head->n_columns - 1];
    ss_status status = SS_OK;
    char text[64];
    size_t row = (size_t)s->base.row;
    if (n > 0 && s->times > 0 && !ss_h5_read_rows(s->times, s->times_by_columns, row, n, times))
        return ss_h5_fail(&s->file, SS_EIO, s->times, "", "cannot be read");
    for (size_t i = 0; s->is_own && status == SS_OK && i < n; i++)
        if (!ss_is_on_clock(times[i], head->rate, head->start, row + i)) {
            snprintf(text, sizeof text, "value %zu is not start + %zu / rate", row + i + 1, row + i);
            status = ss_h5_fail(&s->file, SS_EDATA, s->times, "", text);
        }
    for (size_t d = 0; status == SS_OK && n > 0 && d < s->n_datasets; d++)
        status = read_dataset(s, d, n, columns_of(s));
    if (status != SS_OK)
        return status;
    s->base.row += n;
    s->base.held = n;
    s->base.given = 0;
    return SS_OK;
}

static ss_status
make_rows(ss_source *base, double *const column[], size_t max, size_t *n, ss_error *err)
{
    rows *s = (rows *)base;
    size_t left = s->n - (size_t)base->row;
    ss_status status = SS_OK;
    (void)column, (void)max, (void)n;
    s->file.err = err;
    QUIETLY(
        status = read_piece(s, left < s->piece ? left : s->piece);
    );
    return status;
}

static void
free_rows(ss_source *base)
{
    rows *s = (rows *)base;
    QUIETLY(
        ss_h5_close(&s->file);
    );
    free(s->path);
    free(s->dataset);
    free(s->value);
    free(s->raw);
}

/* --- opening ------------------------------------------------------------------------------- */

static ss_status
find(rows *s, const char *dataset, const ss_read_opts *opts)
{
    ss_status status = ss_h5_open(&s->file);
    if (status == SS_OK)
        status = *dataset != '\0' ? find_array(s, dataset, opts) : find_signal(s, opts);
    if (status != SS_OK)
        return status;
    s->base.length = s->n;
    s->piece = piece_rows(s);
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
    s->path = strdup(path);
    s->file = (h5_file){ .id = -1, .path = s->path, .err = err };
    ss_status status = SS_ENOMEM;
    if (s->path != NULL)
        QUIETLY(
            status = find(s, dataset, opts);
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
