/* wavelet_writer.c -- coefficients of a transform, in pieces, as /wavelet: a group a scale, or one
 * rectangle if all scales have one coefficient a sample. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/versions.h"
#include "map/wavelet.h"
#include "io/hdf5/groups.h"
#include "signal/gaps.h"

struct scale_datasets {
    hid_t group, time, re, im, edge;
    int single;                 /* re and im are 32-bit floats */
    size_t done;
    double most;                /* the largest |W| so far */
};

/* 1 if every scale has one coefficient a sample, so that all scales share one dataset of times. */
static int
is_dense(const wavelet_writer *w)
{
    for (size_t i = 0; i < w->n_scales; i++)
        if (w->scale[i].b_num * w->pieces->rate != w->scale[i].b_den
            || (!w->pieces->growing && w->scale[i].n != w->n))
            return 0;
    return w->n_scales > 0;
}

/* The unit of the coefficients, to be freed. */
static char *
name_unit(const ss_header *head)
{
    const char *of = head->n_columns > 0 ? head->column[0].unit : "";
    const char *norm = ss_header_find_note(head, "norm");
    int l1 = norm != NULL && strcmp(norm, "l1") == 0;
    size_t size = strlen(of) + sizeof " s^0.5";
    char *unit = malloc(size);
    if (unit != NULL)
        snprintf(unit, size, "%s%s%s", of, *of != '\0' && !l1 ? " " : "", l1 ? "" : "s^0.5");
    return unit;
}

static int
write_lattice(hid_t object, const ss_scale *scale)
{
    return ss_h5_write_number(object, "b_num", H5T_IEEE_F64LE, scale->b_num)
           && ss_h5_write_number(object, "b_den", H5T_IEEE_F64LE, scale->b_den);
}

/* The scales as lists, and the lattice that all share, if they do. */
static ss_status
write_scales(wavelet_writer *w)
{
    double *row = malloc(4 * w->n_scales * sizeof *row);
    if (row == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < w->n_scales; i++) {
        const double of[4] = { w->scale[i].a, w->scale[i].f, w->scale[i].m, w->scale[i].j };
        memcpy(row + 4 * i, of, sizeof of);
    }
    const h5_dataset v[] = {
        { "scale", "s", "scale a", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, row, 0, 4, 0, 0 },
        { "frequency", "Hz", "frequency label omega_c / (2 pi a)", H5T_IEEE_F64LE,
          H5T_NATIVE_DOUBLE, row, 1, 4, 0, 0 },
        { "m", "1", "log2 of the scale in seconds", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, row, 2, 4,
          0, 0 },
        { "j", "1", "number of the scale, a = 2^(j/voices) s", H5T_STD_I32LE, H5T_NATIVE_DOUBLE,
          row, 3, 4, 0, 0 },
    };
    ss_status st = ss_h5_write_lists(w->pieces->file, w->group, v, sizeof v / sizeof *v, w->n_scales);
    free(row);
    if (st == SS_OK && w->dense && !write_lattice(w->group, &w->scale[0]))
        st = ss_h5_fail_write(w->pieces->file, 0, "/wavelet");
    return st;
}

static ss_status
open_scale(wavelet_writer *w, size_t i)
{
    const ss_scale *scale = &w->scale[i];
    char name[32];
    snprintf(name, sizeof name, "scale%03zu", i);
    hid_t group = ss_h5_new_group(w->group, name);
    if (group < 0 || !ss_h5_write_number(group, "m", H5T_IEEE_F64LE, scale->m)
        || !ss_h5_write_number(group, "scale", H5T_IEEE_F64LE, scale->a)
        || !ss_h5_write_number(group, "frequency", H5T_IEEE_F64LE, scale->f)
        || !ss_h5_write_number(group, "j", H5T_STD_I32LE, scale->j) || !write_lattice(group, scale))
        return ss_h5_fail_write(w->pieces->file, w->group, name);
    w->datasets[i].group = group;
    return SS_OK;
}

static ss_status
copy_grid(wavelet_writer *w, const ss_coefficients *grid)
{
    w->n = grid->n;
    w->n_scales = grid->n_scales;
    w->scale = malloc((grid->n_scales + 1) * sizeof *w->scale);
    w->datasets = calloc(grid->n_scales + 1, sizeof *w->datasets);
    w->unit = name_unit(grid->head);
    if (w->scale == NULL || w->datasets == NULL || w->unit == NULL)
        return SS_ENOMEM;
    memcpy(w->scale, grid->scale, grid->n_scales * sizeof *w->scale);
    for (size_t i = 0; i <= grid->n_scales; i++)
        w->datasets[i] = (struct scale_datasets){ .group = -1, .time = -1, .re = -1, .im = -1,
                                                 .edge = -1 };
    w->dense = is_dense(w);
    return ss_header_gaps(&w->gap, &w->n_gaps, grid->head, NULL);
}

ss_status
ss_wavelet_writer_open(wavelet_writer *w, h5_pieces *pieces, const ss_coefficients *grid)
{
    const ss_header *head = grid->head;
    const ss_column none = { "", "" }, *column = head->n_columns > 0 ? head->column : &none;
    w->pieces = pieces;
    ss_status st = copy_grid(w, grid);
    if (st != SS_OK)
        return st;
    w->group = ss_h5_new_group(pieces->file->id, "wavelet");
    if (w->group < 0 || !ss_h5_write_text(w->group, "column", column->name)
        || !ss_h5_write_text(w->group, "column_units", column->unit)
        || !ss_h5_write_clock(w->group, head)
        || !ss_h5_write_number(w->group, "center", H5T_IEEE_F64LE, grid->center)
        || !ss_h5_write_number(w->group, "dense", H5T_STD_I8LE, w->dense)
        || !ss_h5_write_number(w->group, "scales", H5T_STD_I32LE, (double)w->n_scales))
        return ss_h5_fail_write(pieces->file, 0, "/wavelet");
    st = write_scales(w);
    for (size_t i = 0; st == SS_OK && !w->dense && i < w->n_scales; i++)
        st = open_scale(w, i);
    return st;
}

size_t
ss_wavelet_writer_find(const wavelet_writer *w, const ss_scale *scale, size_t first, size_t n)
{
    size_t i = 0;
    while (i < w->n_scales && w->scale[i].j != scale->j)
        i++;
    if (i < w->n_scales && (w->datasets[i].done != first
                            || (!w->pieces->growing && n > w->scale[i].n - first)))
        return w->n_scales;
    return i;
}

static int
close_datasets(struct scale_datasets *r)
{
    hid_t *const id[] = { &r->time, &r->re, &r->im, &r->edge };
    int good = 1;
    for (size_t i = 0; i < sizeof id / sizeof *id; i++) {
        good &= *id[i] < 0 || H5Dclose(*id[i]) >= 0;
        *id[i] = -1;
    }
    return good;
}

/* A number that, added and then subtracted, rounds to a multiple of the largest power of two that is at
 * most sqrt(2) times the error allowed for W: re and im are off by at most half of that.  0: all bits are
 * kept. */
static double
rounding_of(double tolerance, double most)
{
    double unit = WAVELET_ROUNDED * tolerance * M_SQRT2 * most;
    return tolerance >= 1e-12 && unit > 1e-280 && unit < 1e280 ? ldexp(0x1.8p52, ilogb(unit)) : 0;
}

FAST static double
largest_of(const double *x, size_t n, double most)
{
    double square = 0;
    for (size_t k = 0; k < n; k++) {
        double next = x[2 * k] * x[2 * k] + x[2 * k + 1] * x[2 * k + 1];
        square = next > square ? next : square;
    }
    return fmax(most, sqrt(square));
}

/* Make the datasets of scale i, or, if dense, those of all scales, which are rectangles.  The largest |W| is
 * `most` so far.  For tolerances from 1e-7 on there are at most 2^24 multiples of rounding_of's unit, which
 * 32-bit floats hold exactly unless the unit is below 2^-149.  The error there is far below the
 * 16 eps a^1/2 max|x| that W has anyway: |W| is at most 1.9 a^1/2 max|x|, and here at least 1e-20 at one
 * scale. */
static ss_status
open_datasets(wavelet_writer *w, size_t i, double most)
{
    static const char *const scales[] = { "scale", "time" };
    int growing = w->pieces->growing, rank = w->dense ? 2 : 1;
    hsize_t bytes = w->dense ? 17 : 25, chunk = growing ? ss_h5_growing_chunk(bytes * w->n_scales) : 0;
    hsize_t length = growing ? 0 : w->dense ? w->n : w->scale[i].n;
    const hsize_t dims[2] = { w->n_scales, length };
    struct scale_datasets *d = &w->datasets[w->dense ? 0 : i];
    d->single = w->tolerance >= 1e-7 && most >= 1e-20 && most <= 1e20;
    hid_t group = w->dense ? w->group : d->group, type = d->single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
    const h5_dataset v[] = {
        { .name = "time", .unit = "s", .long_name = "time", .file_type = H5T_IEEE_F64LE,
          .chunk = chunk },
        { .name = "re", .unit = w->unit, .long_name = "real part of the wavelet coefficient",
          .file_type = type, .chunk = chunk, .in_rows = 1 },
        { .name = "im", .unit = w->unit, .long_name = "imaginary part of the wavelet coefficient",
          .file_type = type, .chunk = chunk, .in_rows = 1 },
        { .name = "edge", .unit = "1", .long_name = "1 inside the cone of influence",
          .file_type = H5T_STD_U8LE, .chunk = chunk, .in_rows = 1 },
    };
    d->time = ss_h5_new_dataset(group, &v[0], 1, &length, NULL);
    if (d->time < 0)
        return ss_h5_fail_write(w->pieces->file, group, v[0].name);
    hid_t *const id[] = { NULL, &d->re, &d->im, &d->edge };
    for (size_t k = 1; k < sizeof v / sizeof *v; k++) {
        *id[k] = ss_h5_new_dataset(group, &v[k], rank, dims + 2 - rank, scales + 2 - rank);
        /* the CF conventions name so the label of a row that is not its index */
        if (*id[k] < 0 || (w->dense && !ss_h5_write_text(*id[k], "coordinates", "frequency")))
            return ss_h5_fail_write(w->pieces->file, group, v[k].name);
    }
    if (!w->dense && H5Gclose(group) < 0)
        return ss_h5_fail_write(w->pieces->file, w->group, "re");
    d->group = -1;
    return SS_OK;
}

/* Split coefficients into re and im, rounded by adding and subtracting `shift`. */
VERSIONS static void
split(double *restrict re, double *restrict im, const double *restrict x, size_t n, double shift)
{
    for (size_t k = 0; k < n; k++) {
        re[k] = x[2 * k] + shift - shift;
        im[k] = x[2 * k + 1] + shift - shift;
    }
}

/* Find which of n coefficients, from `first` on, are in a cone of influence.  Without gaps, all that are not
 * follow each other. */
static void
find_edges(const wavelet_writer *w, const ss_scale *scale, size_t first, size_t n, size_t samples)
{
    const h5_pieces *p = w->pieces;
    unsigned char *edge = w->pieces->edge;
    size_t from = 0, to = n;
    memset(edge, 0, n);
    while (from < to && ss_scale_edge(scale, first + from, samples, p->rate))
        edge[from++] = 1;
    while (to > from && ss_scale_edge(scale, first + to - 1, samples, p->rate))
        edge[--to] = 1;
    for (size_t k = from; w->n_gaps > 0 && k < to; k++)
        edge[k] = (unsigned char)wavelet_edge(scale, first + k, samples, p->rate, p->start, w->gap,
                                              w->n_gaps);
}

/* Write re or im of n coefficients.  Were HDF5 to make 32-bit floats of them, it would zero 1 MB in each call. */
static int
write_part(h5_pieces *p, hid_t id, int single, int rank, const hsize_t at[], size_t n, const double *x)
{
    for (size_t k = 0; single && k < n; k++)
        p->single[k] = (float)x[k];
    return ss_h5_write_piece(id, rank, at, n, single ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE,
                             single ? (const void *)p->single : x);
}

/* Write n coefficients of scale i, at most a piece. */
static int
write_rows(wavelet_writer *w, size_t i, size_t n, const double *x, size_t samples)
{
    const ss_scale *scale = &w->scale[i];
    struct scale_datasets *d = &w->datasets[w->dense ? 0 : i];
    h5_pieces *p = w->pieces;
    size_t first = w->datasets[i].done;
    int rank = w->dense ? 2 : 1;
    const hsize_t where[2] = { i, first }, *at = where + 2 - rank;
    split(p->value[0], p->value[1], x, n, rounding_of(w->tolerance, w->datasets[i].most));
    find_edges(w, scale, first, n, samples);
    return write_part(p, d->re, d->single, rank, at, n, p->value[0])
        && write_part(p, d->im, d->single, rank, at, n, p->value[1])
        && ss_h5_write_piece(d->edge, rank, at, n, H5T_NATIVE_UCHAR, p->edge)
        && (w->dense || ss_h5_write_times(p, d->time, scale, first, n));
}

ss_status
ss_wavelet_writer_append(wavelet_writer *w, size_t i, size_t n, const double *x, size_t samples)
{
    struct scale_datasets *d = &w->datasets[i], *shared = &w->datasets[w->dense ? 0 : i];
    ss_status st = SS_OK;
    d->most = w->tolerance > 0 ? largest_of(x, n, d->most) : 0;
    if (shared->re < 0 && n > 0)
        st = open_datasets(w, i, d->most);
    if (st == SS_OK && shared->single && d->most > FLT_MAX)
        st = ss_h5_fail(w->pieces->file, SS_ERANGE, w->group, "re", "coefficients of at most 1e20 precede "
                        "some above 3.4e38, which 32-bit floats do not hold; keep all bits");
    if (st != SS_OK)
        return st;
    for (size_t m; n > 0; n -= m, x += 2 * m) {
        m = n < H5_PIECE ? n : H5_PIECE;
        if (!write_rows(w, i, m, x, samples))
            return ss_h5_fail_write(w->pieces->file, w->group, "re");
        d->done += m;
    }
    if (!w->pieces->growing && !w->dense && d->done == w->scale[i].n && !close_datasets(d))
        return ss_h5_fail_write(w->pieces->file, w->group, "re");
    return SS_OK;
}

/* 1 if scale i has all the coefficients that it has in a record of so many samples. */
static int
is_full(const wavelet_writer *w, size_t i, size_t samples)
{
    double last = (double)(samples - 1) / w->pieces->rate;
    size_t done = w->datasets[i].done;
    if (!w->pieces->growing)
        return done == w->scale[i].n;
    return done > 0 && ss_scale_b(&w->scale[i], done - 1) <= last
        && ss_scale_b(&w->scale[i], done) > last;
}

ss_status
ss_wavelet_writer_end(wavelet_writer *w, size_t samples)
{
    h5_file *file = w->pieces->file;
    for (size_t i = 0; i < w->n_scales; i++)
        if (!is_full(w, i, samples))
            return ss_fail(file->err, SS_EINVAL, "coefficients of scale %g are missing", w->scale[i].m);
    char text[SS_NUMBER_MAX];
    ss_number_format(text, (double)samples);
    if ((w->dense && !ss_h5_write_times(w->pieces, w->datasets->time, &w->scale[0], 0, samples))
        || (H5Aexists(file->id, "samples") <= 0 && !ss_h5_write_text(file->id, "samples", text))
        || !ss_h5_write_number(w->group, "samples", H5T_STD_I64LE, (double)samples))
        return ss_h5_fail_write(file, 0, "/wavelet");
    return SS_OK;
}

void
ss_wavelet_writer_free(wavelet_writer *w)
{
    free(w->unit);
    free(w->scale);
    free(w->datasets);
    free(w->gap);
}
