/* read.c -- our own files back into memory, value by value as they were written.
 *
 * Another program may have changed a file, so every size is checked before it is used: sizes of
 * datasets against each other, sizes in attributes against the datasets. */
#include "store/h5.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "signal/header.h"
#include "stream/clock.h"

/* A required attribute of a group, lo <= value <= hi. */
static ss_status
get_number(h5_file *file, hid_t group, const char *name, double lo, double hi, double *value)
{
    if (ss_h5_get_number(group, name, value) && *value >= lo && *value <= hi)
        return SS_OK;
    char text[128];
    snprintf(text, sizeof text, "attribute '%s' is missing or out of range", name);
    return ss_h5_fail(file, SS_EDATA, group, "", text);
}

/* Rate, start and whether the text form has a column of time, from a group into a new header. */
static ss_status
get_header(h5_file *file, hid_t group, ss_header **head)
{
    double rate, start, has_time;
    ss_status status;
    if ((status = get_number(file, group, "rate", 1e-300, 1e300, &rate)) != SS_OK
        || (status = get_number(file, group, "start", -1e300, 1e300, &start)) != SS_OK
        || (status = get_number(file, group, "has_time", 0, 1, &has_time)) != SS_OK)
        return status;
    *head = ss_header_new(rate, start);
    if (*head == NULL)
        return SS_ENOMEM;
    (*head)->has_time = has_time != 0;
    return ss_h5_read_notes(file, *head);
}

/* The number of values of a 1-D or 2-D dataset, which are counted as claimed. */
static ss_status
get_size(h5_file *file, hid_t group, const char *name, size_t *n)
{
    hid_t id = ss_h5_open_dataset(group, name);
    if (id < 0)
        return ss_h5_fail(file, SS_EDATA, group, name, "no such dataset");
    const char *wrong = ss_h5_claim(file, id);
    hid_t space = wrong == NULL ? H5Dget_space(id) : -1;
    *n = wrong == NULL ? (size_t)H5Sget_simple_extent_npoints(space) : 0;
    H5Sclose(space);
    H5Dclose(id);
    return wrong == NULL ? SS_OK : ss_h5_fail(file, SS_EDATA, group, name, wrong);
}

/* --- /signal ------------------------------------------------------------------------------- */

/* The links of a group, in the order of writing where the file keeps it. */
static H5_index_t
link_order(hid_t group)
{
    unsigned tracked = 0;
    hid_t how = H5Gget_create_plist(group);
    H5Pget_link_creation_order(how, &tracked);
    H5Pclose(how);
    return tracked & H5P_CRT_ORDER_TRACKED ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
}

struct links {
    char **name;
    size_t n, room;
    ss_status status;
};

static herr_t
append_link(hid_t group, const char *name, const H5L_info_t *info, void *user)
{
    struct links *links = user;
    char **more = ss_list_room(links->name, &links->room, links->n, sizeof *more);
    (void)group, (void)info;
    if (more != NULL)
        links->name = more;
    if (links->n == MAX_COLUMNS)
        links->status = SS_EDATA;
    else if (more == NULL || (more[links->n] = strdup(name)) == NULL)
        links->status = SS_ENOMEM;
    else
        links->n++;
    return links->status != SS_OK;
}

/* All names of a group at once: one by one, HDF5 sorts them all again for each where the group has no
 * index of that order. */
static ss_status
list_links(h5_file *file, hid_t group, struct links *links)
{
    if (H5Literate(group, link_order(group), H5_ITER_INC, NULL, append_link, links) < 0)
        return ss_h5_fail(file, SS_EIO, group, "", "cannot be read");
    if (links->status == SS_EDATA)
        return ss_h5_fail(file, SS_EDATA, group, "", "has more than 32768 columns");
    return links->status;
}

/* Add the dataset at a link as a column of the header; the caller keeps ownership of *link. */
static ss_status
add_column(h5_file *file, hid_t group, const char *link, ss_header *head)
{
    hid_t id = ss_h5_open_dataset(group, link);
    if (id < 0)
        return ss_h5_fail(file, SS_EDATA, group, link, "not a dataset");
    const char *wrong = ss_h5_claim(file, id);
    char *name = NULL, *unit = NULL;
    ss_status status = wrong == NULL ? ss_h5_get_text(file, id, "column", &name)
                                     : ss_h5_fail(file, SS_EDATA, group, link, wrong);
    if (status == SS_OK)
        status = ss_h5_get_text(file, id, "units", &unit);
    if (status == SS_OK)
        status = ss_header_add_column(head, name != NULL && *name != '\0' ? name : link, unit);
    free(name);
    free(unit);
    H5Dclose(id);
    return status;
}

static ss_status
check_finite(h5_file *file, hid_t group, const char *name, const double *x, size_t n)
{
    char text[64];
    for (size_t i = 0; i < n; i++)
        if (!isfinite(x[i])) {
            snprintf(text, sizeof text, "value %zu is not finite", i + 1);
            return ss_h5_fail(file, SS_EDATA, group, name, text);
        }
    return SS_OK;
}

static ss_status
read_columns(h5_file *file, hid_t group, ss_header *head, const struct links *links,
             ss_signal **out)
{
    size_t n;
    ss_status status = get_size(file, group, "t", &n);
    for (size_t i = 0; status == SS_OK && i < links->n; i++)
        if (strcmp(links->name[i], "t") != 0)
            status = add_column(file, group, links->name[i], head);
    if (status == SS_OK)
        status = ss_signal_new(out, head, n);
    double *values = status == SS_OK ? (*out)->values : NULL;
    for (size_t i = 0; status == SS_OK && i < links->n; i++) {
        const char *name = links->name[i];
        if (strcmp(name, "t") == 0)
            continue;
        status = ss_h5_read_values(file, group, name, values, n);
        if (status == SS_OK)
            status = check_finite(file, group, name, values, n);
        values += n;
    }
    return status;
}

static ss_status
read_signal(h5_file *file, ss_signal **out)
{
    hid_t group = ss_h5_open_group(file->id, "/signal");
    struct links links = { .name = NULL };
    ss_header *head = NULL;
    if (group < 0)
        return ss_h5_fail(file, SS_EDATA, 0, "/signal", "not a group of this file");
    ss_status status = get_header(file, group, &head);
    if (status == SS_OK)
        status = list_links(file, group, &links);
    if (status == SS_OK)
        status = read_columns(file, group, head, &links, out);
    for (size_t i = 0; i < links.n; i++)
        free(links.name[i]);
    free(links.name);
    ss_header_free(head);
    H5Gclose(group);
    return status;
}

ss_status
ss_h5_read_signal(ss_signal **out, h5_file *file, const char *dataset, const ss_read_opts *opts)
{
    if (dataset != NULL && dataset[0] != '\0')
        return ss_h5_read_foreign(out, file, dataset, opts);
    if (H5Lexists(file->id, "signal", H5P_DEFAULT) <= 0)
        return ss_h5_fail_listing(file);
    ss_status status = read_signal(file, out);
    if (status != SS_OK || opts == NULL)
        return status;
    return ss_refuse_clock(file->path, (*out)->head->rate, opts, file->err);
}

/* --- /wavelet ------------------------------------------------------------------------------ */

static ss_status
add_grid_column(h5_file *file, hid_t group, ss_header *head)
{
    char *name = NULL, *unit = NULL;
    ss_status status = ss_h5_get_text(file, group, "column", &name);
    if (status == SS_OK)
        status = ss_h5_get_text(file, group, "column_units", &unit);
    if (status == SS_OK && name != NULL && name[0] != '\0')
        status = ss_header_add_column(head, name, unit);
    free(name);
    free(unit);
    return status;
}

static ss_status
get_lattice(h5_file *file, hid_t group, ss_scale *scale)
{
    ss_status status = get_number(file, group, "b_num", 1e-300, 1e300, &scale->b_num);
    return status == SS_OK ? get_number(file, group, "b_den", 1e-300, 1e300, &scale->b_den) : status;
}

/* Is scale i one of this record's grid, and shorter than the one before? */
static ss_status
check_scale(h5_file *file, hid_t group, const ss_coefficients *c, size_t i)
{
    const ss_scale *s = &c->scale[i];
    double last = (double)(c->n - 1) / c->head->rate;
    const char *wrong = !(fabs(s->a / exp2(s->m) - 1) < 1e-12)
                        || !(fabs(s->f * 2 * M_PI * s->a / c->center - 1) < 1e-12)
                        ? "scale, m and frequency do not agree"
                        : i > 0 && !(s->a < s[-1].a)
                        ? "the scales do not descend"
                        : s->n == 0 || !(ss_scale_b(s, s->n - 1) <= last && ss_scale_b(s, s->n) > last)
                        ? "the translations are not those that the record has room for" : NULL;
    return wrong == NULL ? SS_OK : ss_h5_fail(file, SS_EDATA, group, "", wrong);
}

/* The next n of all coefficients are this scale's. */
static ss_status
add_scale(ss_scale *scale, size_t n, size_t *total)
{
    if (n > SIZE_MAX / (2 * sizeof(double)) - *total)
        return SS_ENOMEM;
    scale->n = n;
    scale->offset = *total;
    *total += n;
    return SS_OK;
}

static hid_t
open_scale(hid_t parent, size_t i)
{
    char name[32];
    snprintf(name, sizeof name, "scale%03zu", i);
    return ss_h5_open_group(parent, name);
}

static ss_status
get_scale(h5_file *file, hid_t parent, ss_coefficients *c, size_t i, size_t *total)
{
    double j;
    ss_scale *scale = &c->scale[i];
    size_t n = 0, n_im;
    ss_status status;
    hid_t group = open_scale(parent, i);
    if (group < 0) {
        char name[32];
        snprintf(name, sizeof name, "scale%03zu", i);
        return ss_h5_fail(file, SS_EDATA, parent, name, "no such group");
    }
    if ((status = get_number(file, group, "j", -1e6, 1e6, &j)) == SS_OK
        && (status = get_number(file, group, "m", -1e4, 1e4, &scale->m)) == SS_OK
        && (status = get_number(file, group, "scale", 1e-300, 1e300, &scale->a)) == SS_OK
        && (status = get_number(file, group, "frequency", 1e-300, 1e300, &scale->f)) == SS_OK
        && (status = get_lattice(file, group, scale)) == SS_OK
        && (status = get_size(file, group, "re", &n)) == SS_OK
        && (status = get_size(file, group, "im", &n_im)) == SS_OK
        && (status = add_scale(scale, n, total)) == SS_OK
        && (status = check_scale(file, group, c, i)) == SS_OK)
        scale->j = (int)j;
    H5Gclose(group);
    return status;
}

/* A rectangle, a row a scale of a value a sample. */
static ss_status
check_rectangle(h5_file *file, hid_t group, const char *name, const ss_coefficients *c)
{
    size_t claimed;
    ss_status status = get_size(file, group, name, &claimed);
    if (status != SS_OK)
        return status;
    hsize_t dims[H5S_MAX_RANK] = { 0 };
    hid_t id = ss_h5_open_dataset(group, name), space = H5Dget_space(id);
    int good = H5Sget_simple_extent_ndims(space) == 2
        && H5Sget_simple_extent_dims(space, dims, NULL) == 2
        && dims[0] == c->n_scales && dims[1] == c->n;
    H5Sclose(space);
    H5Dclose(id);
    return good ? SS_OK
        : ss_h5_fail(file, SS_EDATA, group, name, "not a row a scale of a value a sample");
}

/* The scales of a rectangle, their members one dataset each. */
static ss_status
get_dense(h5_file *file, hid_t group, ss_coefficients *c, size_t *total)
{
    static const char *const name[] = { "m", "scale", "frequency", "j" };
    size_t n = c->n_scales;
    ss_status status = check_rectangle(file, group, "re", c);
    if (status == SS_OK)
        status = check_rectangle(file, group, "im", c);
    double *row = malloc((4 * n + 1) * sizeof *row);
    if (row == NULL)
        status = SS_ENOMEM;
    for (size_t k = 0; status == SS_OK && k < 4; k++) {
        status = ss_h5_read_values(file, group, name[k], row + k * n, n);
        if (status == SS_OK)
            status = check_finite(file, group, name[k], row + k * n, n);
    }
    for (size_t i = 0; status == SS_OK && i < n; i++) {
        ss_scale *scale = &c->scale[i];
        scale->m = row[i];
        scale->a = row[n + i];
        scale->f = row[2 * n + i];
        scale->j = (int)row[3 * n + i];
        if (!(scale->a >= 1e-300 && scale->f >= 1e-300 && fabs(row[3 * n + i]) <= 1e6))
            status = ss_h5_fail(file, SS_EDATA, group, "scale", "a scale is out of range");
        else if ((status = get_lattice(file, group, scale)) == SS_OK
                 && (status = add_scale(scale, c->n, total)) == SS_OK)
            status = check_scale(file, group, c, i);
    }
    free(row);
    return status;
}

/* All but the coefficients, of which there are *total. */
static ss_status
read_grid(h5_file *file, hid_t group, ss_coefficients *c, int *dense, size_t *total)
{
    double rate, samples, scales, number;
    ss_status status;
    if ((status = get_header(file, group, &c->head)) != SS_OK
        || (status = add_grid_column(file, group, c->head)) != SS_OK
        || (status = get_number(file, group, "rate", 1e-100, 1e100, &rate)) != SS_OK
        || (status = get_number(file, group, "samples", 1, H5_MAX_VALUES, &samples)) != SS_OK
        || (status = get_number(file, group, "scales", 1, 1e6, &scales)) != SS_OK
        || (status = get_number(file, group, "center", 2, 1000, &c->center)) != SS_OK
        || (status = get_number(file, group, "dense", 0, 1, &number)) != SS_OK)
        return status;
    c->n = (size_t)samples;
    c->n_scales = (size_t)scales;
    c->scale = calloc(c->n_scales + 1, sizeof *c->scale);
    if (c->scale == NULL)
        return SS_ENOMEM;
    *dense = number != 0;
    if (*dense)
        status = get_dense(file, group, c, total);
    for (size_t i = 0; status == SS_OK && !*dense && i < c->n_scales; i++)
        status = get_scale(file, group, c, i, total);
    return status == SS_OK ? ss_header_gaps(&c->gap, &c->n_gaps, c->head) : status;
}

/* --- scale by scale ------------------------------------------------------------------------ */

struct ss_store_reader {
    h5_file file;
    char *path;
    ss_error error;
    ss_coefficients *grid;
    int dense;
    hid_t group, part[2];       /* part: re and im, if dense, else -1 */
    size_t total;
    double *row;                /* the longest, re or im */
};

static const char *const part_name[] = { "re", "im" };

/* Of a file that is open. */
static ss_status
open_reader(ss_store_reader *r)
{
    size_t longest = 0;
    r->group = r->part[0] = r->part[1] = -1;
    r->grid = calloc(1, sizeof *r->grid);
    if (r->grid == NULL)
        return SS_ENOMEM;
    if (H5Lexists(r->file.id, "wavelet", H5P_DEFAULT) <= 0)
        return ss_h5_fail(&r->file, SS_EKIND, 0, "", "no /wavelet in it");
    r->group = ss_h5_open_group(r->file.id, "wavelet");
    if (r->group < 0)
        return ss_h5_fail(&r->file, SS_EDATA, 0, "/wavelet", "not a group of this file");
    ss_status status = read_grid(&r->file, r->group, r->grid, &r->dense, &r->total);
    if (status != SS_OK)
        return status;
    for (size_t i = 0; i < r->grid->n_scales; i++)
        longest = r->grid->scale[i].n > longest ? r->grid->scale[i].n : longest;
    for (int k = 0; k < 2 && r->dense; k++)
        r->part[k] = ss_h5_open_dataset(r->group, part_name[k]);
    r->row = malloc(longest * sizeof *r->row);
    return r->row != NULL ? SS_OK : SS_ENOMEM;
}

/* Row i of a rectangle. */
static ss_status
read_row(ss_store_reader *r, int k, size_t i)
{
    const hsize_t at[2] = { i, 0 }, count[2] = { 1, r->grid->n };
    hid_t space = H5Dget_space(r->part[k]), memory = H5Screate_simple(1, &count[1], NULL);
    int good = H5Sselect_hyperslab(space, H5S_SELECT_SET, at, NULL, count, NULL) >= 0
        && H5Dread(r->part[k], H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, r->row) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    return good ? SS_OK
        : ss_h5_fail(&r->file, SS_EIO, r->group, part_name[k], "cannot be read");
}

static ss_status
read_scale(ss_store_reader *r, size_t i, double *w)
{
    size_t n = r->grid->scale[i].n;
    hid_t group = r->dense ? r->group : open_scale(r->group, i);
    ss_status status = SS_OK;
    for (size_t k = 0; status == SS_OK && k < 2; k++) {
        status = r->dense ? read_row(r, (int)k, i)
                          : ss_h5_read_values(&r->file, group, part_name[k], r->row, n);
        if (status == SS_OK)
            status = check_finite(&r->file, group, part_name[k], r->row, n);
        for (size_t c = 0; status == SS_OK && c < n; c++)
            w[2 * c + k] = r->row[c];
    }
    if (!r->dense)
        H5Gclose(group);
    return status;
}

/* All but the file. */
static void
close_reader(ss_store_reader *r)
{
    H5Dclose(r->part[0]);
    H5Dclose(r->part[1]);
    H5Gclose(r->group);
    ss_coefficients_free(r->grid);
    free(r->row);
}

ss_status
ss_h5_read_coefficients(ss_coefficients **out, h5_file *file)
{
    ss_store_reader r = { .file = *file };
    ss_status status = open_reader(&r);
    ss_coefficients *c = r.grid;
    if (status == SS_OK && (c->w = malloc(2 * r.total * sizeof *c->w)) == NULL)
        status = SS_ENOMEM;
    for (size_t i = 0; status == SS_OK && i < c->n_scales; i++)
        status = read_scale(&r, i, c->w + 2 * c->scale[i].offset);
    if (status == SS_OK) {
        *out = c;
        r.grid = NULL;
    }
    close_reader(&r);
    return status;
}

/* HDF5 without its messages, and without the plugins that a file may name. */
#define QUIETLY(work) do { \
        H5E_BEGIN_TRY { \
            unsigned plugins = ss_h5_forbid_plugins(); \
            work \
            ss_h5_restore_plugins(plugins); \
        } H5E_END_TRY \
    } while (0)

/* --- public -------------------------------------------------------------------------------- */

static ss_status
finish(h5_file *file, ss_status status)
{
    if (file->id >= 0)
        H5Fclose(file->id);
    if (status == SS_ENOMEM)
        return ss_fail(file->err, status, "%s: %s", file->path, ss_strerror(status));
    return status;
}

int
ss_store_has_signal(const char *path)
{
    if (path == NULL)
        return 0;
    h5_file file = { .id = -1, .path = path };
    int has = 0;
    QUIETLY(
        if (ss_h5_open(&file) == SS_OK)
            has = H5Lexists(file.id, "signal", H5P_DEFAULT) > 0;
        finish(&file, SS_OK);
    );
    return has;
}

ss_status
ss_store_read_signal(ss_signal **out, const char *path, const char *dataset,
                     const ss_read_opts *opts, ss_error *err)
{
    h5_file file = { .id = -1, .path = path, .err = err };
    ss_signal *signal = NULL;
    ss_status status;
    if (out == NULL || path == NULL)
        return SS_FAIL_NULL(err);
    QUIETLY(
        status = ss_h5_open(&file);
        if (status == SS_OK)
            status = ss_h5_read_signal(&signal, &file, dataset, opts);
        status = finish(&file, status);
    );
    if (status == SS_OK)
        *out = signal;
    else
        ss_signal_free(signal);
    return status;
}

ss_status
ss_store_reader_new(ss_store_reader **out, const char *path, ss_error *err)
{
    if (out == NULL || path == NULL)
        return SS_FAIL_NULL(err);
    ss_store_reader *r = calloc(1, sizeof *r);
    ss_status status = SS_ENOMEM;
    if (r != NULL)
        r->file = (h5_file){ .id = -1, .path = r->path = strdup(path), .err = &r->error };
    QUIETLY(
        if (r != NULL && r->path != NULL && (status = ss_h5_open(&r->file)) == SS_OK)
            status = open_reader(r);
    );
    if (status == SS_OK)
        *out = r;
    else if (status == SS_ENOMEM)
        ss_fail(err, status, "%s: %s", path, ss_strerror(status));
    else if (err != NULL)
        *err = r->error;
    if (status != SS_OK)
        ss_store_reader_free(r);
    return status;
}

const ss_coefficients *
ss_store_reader_grid(const ss_store_reader *r)
{
    return r != NULL ? r->grid : NULL;
}

ss_status
ss_store_reader_scale(ss_store_reader *r, size_t i, double *w, ss_error *err)
{
    ss_status status;
    if (r == NULL || w == NULL)
        return SS_FAIL_NULL(err);
    if (i >= r->grid->n_scales)
        return ss_fail(err, SS_EINVAL, "no scale %zu, there are %zu", i, r->grid->n_scales);
    QUIETLY(
        status = read_scale(r, i, w);
    );
    if (status != SS_OK && err != NULL)
        *err = r->error;
    return status;
}

void
ss_store_reader_free(ss_store_reader *r)
{
    if (r == NULL)
        return;
    QUIETLY(
        close_reader(r);
        finish(&r->file, SS_OK);
    );
    free(r->path);
    free(r);
}

ss_status
ss_store_read_coefficients(ss_coefficients **out, const char *path, ss_error *err)
{
    h5_file file = { .id = -1, .path = path, .err = err };
    ss_status status;
    if (out == NULL || path == NULL)
        return SS_FAIL_NULL(err);
    QUIETLY(
        status = ss_h5_open(&file);
        if (status == SS_OK)
            status = ss_h5_read_coefficients(out, &file);
        status = finish(&file, status);
    );
    return status;
}
