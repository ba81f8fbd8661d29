/* wavelet_reader.c -- read the coefficients of /wavelet, scale by scale.
 *
 * Another program may have changed a file, so every size is checked before it is used: the sizes of
 * datasets must agree with each other, and sizes in attributes with the datasets. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/error.h"
#include "io/hdf5/groups.h"

static const char *const part_name[] = { "re", "im" };

static ss_status
add_grid_column(h5_file *file, hid_t group, ss_header *head)
{
    char *name = NULL, *unit = NULL;
    ss_status status = ss_h5_get_text(file, group, "column", &name);
    if (status == SS_OK)
        status = ss_h5_get_text(file, group, "column_units", &unit);
    if (status == SS_OK && name != NULL && name[0] != '\0')
        status = ss_header_add_column(head, name, unit, NULL);
    free(name);
    free(unit);
    return status;
}

static ss_status
get_lattice(h5_file *file, hid_t group, ss_scale *scale)
{
    ss_status status = ss_h5_need_number(file, group, "b_num", 1e-300, 1e300, &scale->b_num);
    if (status == SS_OK)
        status = ss_h5_need_number(file, group, "b_den", 1e-300, 1e300, &scale->b_den);
    return status;
}

/* SS_EDATA unless scale i is one of this record's grid, and shorter than the one before. */
static ss_status
check_scale(const wavelet_reader *r, hid_t group, size_t i)
{
    const ss_coefficients *c = r->grid;
    const ss_scale *s = &c->scale[i];
    double last = (double)(c->n - 1) / c->head->rate;
    const char *wrong = !(fabs(s->a / exp2(s->m) - 1) < 1e-12)
                        || !(fabs(s->f * 2 * M_PI * s->a / c->center - 1) < 1e-12)
                        ? "scale, m and frequency do not agree"
                        : i > 0 && !(s->a < s[-1].a)
                        ? "the scales do not descend"
                        : s->n == 0 || !(ss_scale_b(s, s->n - 1) <= last && ss_scale_b(s, s->n) > last)
                        ? "the translations are not those that the record has room for" : NULL;
    return wrong == NULL ? SS_OK : ss_h5_fail(r->file, SS_EDATA, group, "", wrong);
}

/* Give the next n of all coefficients to this scale. */
static ss_status
add_scale(wavelet_reader *r, ss_scale *scale, size_t n)
{
    if (n > SIZE_MAX / (2 * sizeof(double)) - r->total)
        return SS_ENOMEM;
    scale->n = n;
    scale->offset = r->total;
    r->total += n;
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
get_scale(wavelet_reader *r, size_t i)
{
    double j;
    h5_file *file = r->file;
    ss_scale *scale = &r->grid->scale[i];
    size_t n = 0, n_im;
    ss_status status;
    hid_t group = open_scale(r->group, i);
    if (group < 0) {
        char name[32];
        snprintf(name, sizeof name, "scale%03zu", i);
        return ss_h5_fail(file, SS_EDATA, r->group, name, "no such group");
    }
    if ((status = ss_h5_need_number(file, group, "j", -1e6, 1e6, &j)) == SS_OK
        && (status = ss_h5_need_number(file, group, "m", -1e4, 1e4, &scale->m)) == SS_OK
        && (status = ss_h5_need_number(file, group, "scale", 1e-300, 1e300, &scale->a)) == SS_OK
        && (status = ss_h5_need_number(file, group, "frequency", 1e-300, 1e300, &scale->f)) == SS_OK
        && (status = get_lattice(file, group, scale)) == SS_OK
        && (status = ss_h5_read_size(file, group, "re", &n)) == SS_OK
        && (status = ss_h5_read_size(file, group, "im", &n_im)) == SS_OK
        && (status = add_scale(r, scale, n)) == SS_OK
        && (status = check_scale(r, group, i)) == SS_OK)
        scale->j = (int)j;
    H5Gclose(group);
    return status;
}

/* SS_EDATA unless a dataset is a rectangle with a row for each scale and a value for each sample. */
static ss_status
check_rectangle(const wavelet_reader *r, const char *name)
{
    const ss_coefficients *c = r->grid;
    hid_t group = r->group;
    size_t claimed;
    ss_status status = ss_h5_read_size(r->file, group, name, &claimed);
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
        : ss_h5_fail(r->file, SS_EDATA, group, name, "not a row a scale of a value a sample");
}

/* Read the scales of rectangles; each of their numbers is a dataset. */
static ss_status
get_dense(wavelet_reader *r)
{
    static const char *const name[] = { "m", "scale", "frequency", "j" };
    h5_file *file = r->file;
    hid_t group = r->group;
    size_t n = r->grid->n_scales;
    ss_status status = check_rectangle(r, "re");
    if (status == SS_OK)
        status = check_rectangle(r, "im");
    double *row = malloc((4 * n + 1) * sizeof *row);
    if (row == NULL)
        status = SS_ENOMEM;
    for (size_t k = 0; status == SS_OK && k < 4; k++) {
        status = ss_h5_read_values(file, group, name[k], row + k * n, n);
        if (status == SS_OK)
            status = ss_h5_check_finite(file, group, name[k], row + k * n, n);
    }
    for (size_t i = 0; status == SS_OK && i < n; i++) {
        ss_scale *scale = &r->grid->scale[i];
        scale->m = row[i];
        scale->a = row[n + i];
        scale->f = row[2 * n + i];
        if (!(scale->a >= 1e-300 && scale->f >= 1e-300 && fabs(row[3 * n + i]) <= 1e6)) {
            status = ss_h5_fail(file, SS_EDATA, group, "scale", "a scale is out of range");
            break;
        }
        scale->j = (int)row[3 * n + i];
        if ((status = get_lattice(file, group, scale)) == SS_OK
            && (status = add_scale(r, scale, r->grid->n)) == SS_OK)
            status = check_scale(r, group, i);
    }
    free(row);
    return status;
}

/* Read the scales, without their coefficients. */
static ss_status
read_grid(wavelet_reader *r)
{
    h5_file *file = r->file;
    hid_t group = r->group;
    ss_coefficients *c = r->grid;
    double rate, samples, scales, number;
    ss_status status;
    if ((status = ss_h5_read_header(file, group, &c->head)) != SS_OK
        || (status = add_grid_column(file, group, c->head)) != SS_OK
        || (status = ss_h5_need_number(file, group, "rate", 1e-100, 1e100, &rate)) != SS_OK
        || (status = ss_h5_need_number(file, group, "samples", 1, H5_MAX_VALUES, &samples)) != SS_OK
        || (status = ss_h5_need_number(file, group, "scales", 1, 1e6, &scales)) != SS_OK
        || (status = ss_h5_need_number(file, group, "center", 2, 1000, &c->center)) != SS_OK
        || (status = ss_h5_need_number(file, group, "dense", 0, 1, &number)) != SS_OK)
        return status;
    c->n = (size_t)samples;
    c->n_scales = (size_t)scales;
    c->scale = calloc(c->n_scales + 1, sizeof *c->scale);
    if (c->scale == NULL)
        return SS_ENOMEM;
    r->dense = number != 0;
    if (r->dense)
        status = get_dense(r);
    for (size_t i = 0; status == SS_OK && !r->dense && i < c->n_scales; i++)
        status = get_scale(r, i);
    return status == SS_OK ? ss_header_gaps(&c->gap, &c->n_gaps, c->head, NULL) : status;
}

ss_status
ss_wavelet_reader_open(wavelet_reader *r, h5_file *file, ss_coefficients *map)
{
    size_t longest = 0;
    r->file = file;
    r->group = r->part[0] = r->part[1] = -1;
    r->grid = map;
    if (H5Lexists(file->id, "wavelet", H5P_DEFAULT) <= 0)
        return ss_fail_wanted(ss_h5_fail(file, SS_EKIND, 0, "", "no /wavelet in it"),
                              SS_KIND_COEFFICIENTS, file->err);
    r->group = ss_h5_open_group(file->id, "wavelet");
    if (r->group < 0)
        return ss_h5_fail(file, SS_EDATA, 0, "/wavelet", "not a group of this file");
    ss_status status = read_grid(r);
    if (status != SS_OK)
        return status;
    for (size_t i = 0; i < r->grid->n_scales; i++)
        longest = r->grid->scale[i].n > longest ? r->grid->scale[i].n : longest;
    for (int k = 0; k < 2 && r->dense; k++)
        r->part[k] = ss_h5_open_dataset(r->group, part_name[k]);
    r->row = malloc(longest * sizeof *r->row);
    return r->row != NULL ? SS_OK : SS_ENOMEM;
}

/* Read row i of re (k = 0) or im (k = 1) of a rectangle. */
static ss_status
read_row(wavelet_reader *r, int k, size_t i, size_t n)
{
    const hsize_t at[2] = { i, 0 }, count[2] = { 1, n };
    return ss_h5_read_piece(r->part[k], 2, at, count, r->row) ? SS_OK
        : ss_h5_fail(r->file, SS_EIO, r->group, part_name[k], "cannot be read");
}

ss_status
ss_wavelet_reader_scale(wavelet_reader *r, const ss_coefficients *map, size_t i, double *w)
{
    size_t n = map->scale[i].n;
    hid_t group = r->dense ? r->group : open_scale(r->group, i);
    ss_status status = SS_OK;
    for (size_t k = 0; status == SS_OK && k < 2; k++) {
        status = r->dense ? read_row(r, (int)k, i, n)
                          : ss_h5_read_values(r->file, group, part_name[k], r->row, n);
        if (status == SS_OK)
            status = ss_h5_check_finite(r->file, group, part_name[k], r->row, n);
        for (size_t c = 0; status == SS_OK && c < n; c++)
            w[2 * c + k] = r->row[c];
    }
    if (!r->dense)
        H5Gclose(group);
    return status;
}

void
ss_wavelet_reader_close(wavelet_reader *r)
{
    H5Dclose(r->part[0]);
    H5Dclose(r->part[1]);
    H5Gclose(r->group);
    free(r->row);
}
