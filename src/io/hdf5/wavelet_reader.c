/* wavelet_reader.c -- the coefficients of /wavelet as a map, which stay in the file.
 *
 * The notes hold the options of the transform and j the numbers of its scales: the grid follows from these.
 * Another program may have changed a file, so every dataset must have the size that the grid gives. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "io/hdf5/h5.h"
#include "map/plan.h"

/* The source of a map that lies in a file. */
typedef struct file_source {
    ss_map_source source;               /* must be the first member */
    h5_file file;
    hid_t group, part[2];               /* part: re and im, if dense, else -1 */
    int dense;
    double *row;                        /* room for re or im of the longest scale */
    double *w;                          /* the coefficients of scale `held`; NULL: of none yet */
    size_t longest, held;
} file_source;

static const char *const part_name[] = { "re", "im" };

static hid_t
open_scale(const file_source *s, char name[32], size_t i)
{
    snprintf(name, 32, "scale%03zu", i);
    return ss_h5_open_group(s->group, name);
}

/* SS_EDATA unless re and im have this shape, a row a scale if they are rectangles. */
static void
check_parts(file_source *s, hid_t group, size_t rows, size_t n)
{
    for (int k = 0; k < 2; k++) {
        hsize_t dims[H5S_MAX_RANK] = { 0 };
        int rank = 0;
        hid_t id = ss_h5_open_values(&s->file, group, part_name[k], &rank, dims);
        H5Dclose(id);
        if (rank != 1 + s->dense || dims[rank - 1] != n || (s->dense && dims[0] != rows))
            ss_h5_fail(&s->file, SS_EDATA, group, part_name[k],
                       "not the coefficients of the grid that the notes give");
    }
}

static void
add_scale(file_source *s, ss_coefficients *map, double j, const ss_morlet_opts *opts)
{
    size_t i = map->n_scales;
    ss_scale *scale = &map->scale[i];
    ss_error why = { 0 };
    char name[32];
    if (!(fabs(j) <= 500.0 * opts->voices) || j != rint(j) || (i > 0 && !(j < scale[-1].j)))
        ss_h5_fail(&s->file, SS_EDATA, s->group, "j", "not numbers of scales that descend");
    else if (ss_morlet_scale_at(scale, (int)j, NAN, map->n, map->head->rate, opts, &why) != SS_OK)
        ss_h5_fail(&s->file, SS_EDATA, s->group, "j", why.text);
    if (s->file.status != SS_OK)
        return;
    scale->offset = i > 0 ? scale[-1].offset + scale[-1].n : 0;
    map->n_scales++;
    s->longest = scale->n > s->longest ? scale->n : s->longest;
    if (s->dense && scale->n != map->n)
        ss_h5_fail(&s->file, SS_EDATA, s->group, "", "not dense, as it says");
    hid_t group = s->dense ? s->group : open_scale(s, name, i);
    if (group < 0)
        ss_h5_fail(&s->file, SS_EDATA, s->group, name, "no such group");
    if (!s->dense) {
        check_parts(s, group, 1, scale->n);
        H5Gclose(group);
    }
}

static void
read_grid(file_source *s, ss_coefficients *map)
{
    h5_file *file = &s->file;
    ss_morlet_opts opts;
    ss_error why = { 0 };
    size_t n = 0;
    if (H5Lexists(file->id, "wavelet", H5P_DEFAULT) <= 0) {
        ss_h5_fail(file, SS_EKIND, 0, "", "no /wavelet in it");
        ss_fail_wanted(file->status, SS_KIND_COEFFICIENTS, file->err);
    } else if ((s->group = ss_h5_open_group(file->id, "wavelet")) < 0)
        ss_h5_fail(file, SS_EDATA, 0, "/wavelet", "not a group of this file");
    ss_h5_read_header(file, s->group, &map->head);
    s->dense = ss_h5_need_number(file, s->group, "dense", 0, 1) != 0;
    hid_t of_j = ss_h5_open_list(file, s->group, "j", &n);
    ss_status st = file->status == SS_OK ? ss_coefficients_take_notes(map, &opts, &why) : SS_OK;
    if (st == SS_EDATA)
        ss_h5_fail(file, st, 0, "", why.text);
    else if (st != SS_OK)
        file->status = st;
    if (map->n == 0)
        ss_h5_fail(file, SS_EDATA, 0, "", "the note 'samples' is missing");
    if (n == 0)
        ss_h5_fail(file, SS_EDATA, s->group, "j", "no scales");
    if (file->status != SS_OK)
        return;
    double *j = malloc(n * sizeof *j);
    map->scale = calloc(n, sizeof *map->scale);
    if (map->scale == NULL || j == NULL)
        file->status = SS_ENOMEM;
    else if (H5Dread(of_j, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, j) < 0)
        ss_h5_fail(file, SS_EIO, s->group, "j", "cannot be read");
    if (s->dense)
        check_parts(s, s->group, n, map->n);
    for (size_t i = 0; file->status == SS_OK && i < n; i++)
        add_scale(s, map, j[i], &opts);
    free(j);
    H5Dclose(of_j);
    for (int k = 0; s->dense && k < 2; k++)
        s->part[k] = ss_h5_open_dataset(s->group, part_name[k], 0);
    if (file->status == SS_OK && (s->row = malloc(s->longest * sizeof *s->row)) == NULL)
        file->status = SS_ENOMEM;
}

/* Read all of scale i. */
static void
read_scale(file_source *s, size_t i, size_t n, double *w)
{
    const hsize_t at[2] = { i, 0 }, count[2] = { 1, n };
    char name[32];
    hid_t group = s->dense ? s->group : open_scale(s, name, i);
    for (size_t k = 0; s->file.status == SS_OK && k < 2; k++) {
        hid_t id = s->dense ? s->part[k] : ss_h5_open_dataset(group, part_name[k], 1);
        char text[64];
        if (!ss_h5_read_piece(id, 1 + s->dense, at + !s->dense, count + !s->dense, s->row))
            ss_h5_fail(&s->file, SS_EIO, group, part_name[k], "cannot be read");
        if (!s->dense)
            H5Dclose(id);
        for (size_t c = 0; s->file.status == SS_OK && c < n; c++) {
            w[2 * c + k] = s->row[c];
            if (isfinite(s->row[c]))
                continue;
            snprintf(text, sizeof text, "value %zu is not finite", c + 1);
            ss_h5_fail(&s->file, SS_EDATA, group, part_name[k], text);
        }
    }
    if (!s->dense)
        H5Gclose(group);
}

/* HDF5 takes as long for a part of a scale as for all of it: the last one is kept. */
static ss_status
read_parts(const ss_coefficients *map, const ss_map_part part[], size_t n, ss_error *err)
{
    file_source *s = (file_source *)map->source;
    ss_status *st = &s->file.status;
    *st = SS_OK;
    s->file.err = err;
    for (size_t i = 0; *st == SS_OK && i < n; i++) {
        size_t scale = part[i].scale;
        int all = part[i].w != NULL && part[i].n == map->scale[scale].n;
        if (!all && s->w == NULL && (s->w = malloc(2 * s->longest * sizeof *s->w)) == NULL)
            return ss_fail_memory(err, s->file.path);
        double *whole = all ? part[i].w : s->w;
        if (all || s->held != scale)
            QUIETLY(
                read_scale(s, scale, map->scale[scale].n, whole);
            );
        if (!all)
            s->held = *st == SS_OK ? scale : SIZE_MAX;
        if (*st == SS_OK && !all)
            ss_map_give(&part[i], 0, part[i].n, s->w + 2 * part[i].first);
    }
    return *st;
}

static void
close_file(ss_map_source *source)
{
    file_source *s = (file_source *)source;
    QUIETLY(
        H5Dclose(s->part[0]);
        H5Dclose(s->part[1]);
        H5Gclose(s->group);
        ss_h5_close(&s->file);
    );
    free(s->row);
    free(s->w);
    free(s);
}

ss_status
ss_h5_open_coefficients(ss_coefficients **out, const char *path, ss_error *err)
{
    ss_coefficients *map = calloc(1, sizeof *map);
    file_source *s = calloc(1, sizeof *s);
    if (map == NULL || s == NULL) {
        free(map);
        free(s);
        return ss_fail_memory(err, path);
    }
    *s = (file_source){ .source = { read_parts, close_file }, .held = SIZE_MAX, .group = -1, .part = { -1, -1 } };
    map->source = &s->source;
    QUIETLY(
        ss_h5_open(&s->file, path, err);
        if (s->file.status == SS_OK)
            read_grid(s, map);
    );
    const ss_status st = s->file.status;
    if (st == SS_ENOMEM)
        ss_fail_memory(err, path);
    if (st == SS_OK)
        *out = map;
    else
        ss_coefficients_free(map);
    return st;
}
