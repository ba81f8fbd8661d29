/* writer.c -- a file in HDF5: samples, events and coefficients as they come.
 *
 * /signal has a dataset for each column; /events has datasets of one length; /wavelet has a group a scale, or one
 * rectangle if all scales have one coefficient a sample.  Where the number of samples and coefficients is known,
 * the datasets of a scale are closed when they are full.  If it is not, all datasets stay open, with chunks so
 * short that one of each fits into memory; rows then go to one chunk of each column after the other, however they
 * come. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "base/versions.h"
#include "io/hdf5/h5_write.h"
#include "io/writer.h"
#include "map/wavelet.h"
#include "motion/kind.h"
#include "signal/gaps.h"
#include "signal/header.h"

enum { OPEN_BYTES = 32 << 20,   /* about so much are all chunks in memory if lengths are not known */
       LEAST_CHUNK = 256 };

enum { TIME, RE, IM, EDGE, PARTS };
struct scale_datasets {
    hid_t group, part[PARTS];   /* < 0: it is not open */
    int single;                 /* re and im are 32-bit floats */
    size_t done;
    double most;                /* the largest |W| so far */
};

typedef struct h5_writer {
    ss_writer base;
    h5_output output;
    ss_status status;           /* the first failure */
    double rate, start;
    size_t length;              /* of the record; 0: not known */
    int growing, ended;         /* growing: it is known only at the end */

    hid_t *column, times;       /* of /signal, which has a dataset for each column; NULL: there is none */
    size_t n_columns, samples;  /* samples: written so far */
    size_t piece;               /* of each column, that are written at a time */

    int has_events;
    ss_event *event;
    size_t n_events, room;

    size_t n_scales, n_gaps;    /* of /wavelet; 0: there is none */
    ss_scale *scale;
    ss_span *gap;
    char *unit;                 /* of the coefficients */
    double tolerance;           /* of rounding, re the largest |W| of a scale; 0: all bits stay */
    int dense;
    hid_t group;
    struct scale_datasets *datasets;    /* of each scale; if dense, the first holds those of all */

    double value[2][H5_PIECE];  /* room for a piece of re and im, or of other values */
    float single[H5_PIECE];
    unsigned char edge[H5_PIECE];
} h5_writer;

static ss_status
fail(h5_writer *w, hid_t group, const char *name)
{
    return ss_h5_fail_write(&w->output.file, group, name);
}

static int
write_clock(hid_t group, const ss_header *head)
{
    return ss_h5_write_number(group, "rate", H5T_IEEE_F64LE, head->rate)
           && ss_h5_write_number(group, "start", H5T_IEEE_F64LE, head->start)
           && ss_h5_write_number(group, "has_time", H5T_STD_I8LE, head->has_time);
}

/* The number of values of a row in one chunk, a power of two, for rows that grow together; bytes: the size of a
 * column of all rows.  0: the length is known. */
static hsize_t
chunk_of(const h5_writer *w, size_t bytes)
{
    hsize_t chunk = H5_PIECE;
    while (chunk > LEAST_CHUNK && (double)chunk * (double)bytes > OPEN_BYTES)
        chunk /= 2;
    return w->growing ? chunk : 0;
}

/* Write the times first ..., first + n - 1 of a scale, or of the samples for NULL. */
static int
write_times(h5_writer *w, hid_t id, const ss_scale *scale, size_t first, size_t n)
{
    double *t = w->value[0];
    int good = 1;
    for (size_t m; good && n > 0; first += m, n -= m) {
        hsize_t at = first;
        m = n < H5_PIECE ? n : H5_PIECE;
        for (size_t i = 0; i < m; i++)
            t[i] = w->start + (scale != NULL ? ss_scale_b(scale, first + i) : (double)(first + i) / w->rate);
        good = ss_h5_write_piece(id, 1, &at, m, H5T_NATIVE_DOUBLE, t);
    }
    return good;
}

/* --- /signal ------------------------------------------------------------------------------- */

static const struct { const char *name, *unit, *long_name; } known[] = {
    { "x", "m",     "displacement" },
    { "v", "m/s",   "velocity" },
    { "a", "m/s^2", "acceleration" },
    { "f", "N",     "friction force" },
    { "y", "m",     "contact deflection" },
    { "z", "m",     "displacement of the base" },
    { "mode", "",   "mode: 0 stick, else the sign of the slip" },
};

/* Choose the name of a column's link in a group: its own name if HDF5 allows it and it is not used. */
static void
link_name(char link[256], hid_t group, const char *name)
{
    size_t length = 199;
    if (snprintf(link, length + 1, "%s", name) > (int)length) {
        while (length > 0 && (name[length] & 0xc0) == 0x80)
            length--;                   /* back to the start of a character */
        link[length] = '\0';
    }
    if (strcmp(link, ".") == 0)
        strcpy(link, "_");
    length = strlen(link);
    for (int i = 2; H5Lexists(group, link, H5P_DEFAULT) > 0; i++)
        sprintf(link + length, "_%d", i);
}

/* For each column that is attached to t, HDF5 writes the list of all of them again.  A list of more than
 * 64 kB is not replaced but appended each time: 32768 columns would take a minute and 1 GB. */
enum { MOST_ATTACHED = 4000 };

static ss_status
begin_signal(h5_writer *w, const ss_header *head)
{
    const char *const scales[] = { head->n_columns <= MOST_ATTACHED ? "t" : NULL };
    hsize_t dims = w->length;
    h5_dataset v = { .name = "t", .unit = "s", .long_name = "time", .file_type = H5T_IEEE_F64LE,
                     .chunk = chunk_of(w, 8 * (head->n_columns + 1)) };
    hid_t group = ss_h5_new_group(w->output.file.id, "signal");
    w->piece = v.chunk > 0 ? (size_t)v.chunk : H5_PIECE;
    if ((w->column = calloc(head->n_columns + 1, sizeof *w->column)) == NULL)
        return SS_ENOMEM;
    if (group < 0 || !write_clock(group, head) || (w->times = ss_h5_new_dataset(group, &v, 1, &dims, NULL)) < 0)
        return fail(w, 0, "/signal");
    for (; w->n_columns < head->n_columns; w->n_columns++) {
        const ss_column *column = &head->column[w->n_columns];
        char link[256];
        link_name(link, group, column->name);
        v.name = link;
        v.unit = column->unit;
        v.long_name = column->name;
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            if (strcmp(column->name, known[i].name) == 0 && strcmp(column->unit, known[i].unit) == 0)
                v.long_name = known[i].long_name;
        hid_t id = w->column[w->n_columns] = ss_h5_new_dataset(group, &v, 1, &dims, scales);
        if (id < 0 || (strcmp(link, column->name) != 0 && !ss_h5_write_text(id, "column", column->name)))
            return fail(w, group, link);
    }
    H5Gclose(group);
    return SS_OK;
}

static ss_status
append_rows(h5_writer *w, double *const column[], size_t n)
{
    if (w->column == NULL || (!w->growing && n > w->length - w->samples))
        return ss_fail(&w->output.error, SS_EINVAL, "more samples than the file was begun with");
    for (size_t i = 0, m; i < n; i += m, w->samples += m) {
        size_t left = w->piece - w->samples % w->piece;
        hsize_t at = w->samples;
        m = n - i < left ? n - i : left;
        if (!write_times(w, w->times, NULL, w->samples, m))
            return fail(w, 0, "/signal/t");
        for (size_t c = 0; c < w->n_columns; c++)
            if (!ss_h5_write_piece(w->column[c], 1, &at, m, H5T_NATIVE_DOUBLE, column[c] + i))
                return fail(w, 0, "/signal");
    }
    return SS_OK;
}

/* --- /events ------------------------------------------------------------------------------- */

static ss_status
write_all_events(h5_writer *w)
{
    enum { KIND_LENGTH = 8 };           /* "reverse" and a NUL */
    static const ss_event none;
    const ss_event *event = w->event != NULL ? w->event : &none;
    hid_t group = ss_h5_new_group(w->output.file.id, "events"), text = H5Tcopy(H5T_C_S1);
    char *kind = calloc(w->n_events + 1, KIND_LENGTH);
    H5Tset_size(text, KIND_LENGTH);
    for (size_t i = 0; kind != NULL && i < w->n_events; i++)
        snprintf(kind + i * KIND_LENGTH, KIND_LENGTH, "%s", ss_event_kind_name(event[i].kind));
    const h5_dataset v[] = {
        { .name = "t", .unit = "s", .long_name = "time", .file_type = H5T_IEEE_F64LE, .values = &event->t },
        { .name = "kind", .unit = "", .long_name = "what begins: stick, slip, or slip the other way",
          .file_type = text, .values = kind },
        { .name = "x", .unit = "m", .long_name = "displacement", .file_type = H5T_IEEE_F64LE,
          .values = &event->x },
        { .name = "v", .unit = "m/s", .long_name = "velocity", .file_type = H5T_IEEE_F64LE, .values = &event->v },
        { .name = "direction", .unit = "1", .long_name = "sign of the slip that begins, or ended at a stick",
          .file_type = H5T_STD_I8LE, .values = &event->direction },
    };
    ss_status st = kind == NULL ? SS_ENOMEM : group < 0 ? fail(w, 0, "/events")
        : ss_h5_write_lists(&w->output.file, group, v, sizeof v / sizeof *v, w->n_events, sizeof *event);
    H5Tclose(text);
    H5Gclose(group);
    free(kind);
    return st;
}

/* --- /wavelet ------------------------------------------------------------------------------ */

/* Take the grid.  It is dense if every scale has one coefficient a sample: all share one dataset of times. */
static ss_status
copy_grid(h5_writer *w, const ss_coefficients *grid)
{
    const char *of = grid->head->n_columns > 0 ? grid->head->column[0].unit : "";
    const char *norm = ss_header_find_note(grid->head, "norm");
    const char *accuracy = ss_header_find_note(grid->head, "accuracy");
    int l1 = norm != NULL && strcmp(norm, "l1") == 0;
    size_t size = strlen(of) + sizeof " s^0.5";
    w->n_scales = grid->n_scales;
    w->scale = malloc((grid->n_scales + 1) * sizeof *w->scale);
    w->datasets = calloc(grid->n_scales + 1, sizeof *w->datasets);
    w->unit = malloc(size);
    if (w->scale == NULL || w->datasets == NULL || w->unit == NULL)
        return SS_ENOMEM;
    snprintf(w->unit, size, "%s%s%s", of, *of != '\0' && !l1 ? " " : "", l1 ? "" : "s^0.5");
    if (ss_header_find_note(grid->head, "rounded") != NULL && accuracy != NULL)
        w->tolerance = strtod(accuracy, NULL);
    memcpy(w->scale, grid->scale, grid->n_scales * sizeof *w->scale);
    w->dense = 1;
    for (size_t i = 0; i <= grid->n_scales; i++)
        w->datasets[i] = (struct scale_datasets){ .group = -1, .part = { -1, -1, -1, -1 } };
    for (size_t i = 0; i < w->n_scales; i++)
        w->dense &= w->scale[i].b_num * w->rate == w->scale[i].b_den && (w->growing || w->scale[i].n == w->length);
    return ss_header_gaps(&w->gap, &w->n_gaps, grid->head, NULL);
}

static int
write_lattice(hid_t object, const ss_scale *scale)
{
    return ss_h5_write_number(object, "b_num", H5T_IEEE_F64LE, scale->b_num)
           && ss_h5_write_number(object, "b_den", H5T_IEEE_F64LE, scale->b_den);
}

/* The scales as lists, and the lattice that all share, or else a group for each. */
static ss_status
begin_wavelet(h5_writer *w, const ss_coefficients *grid)
{
    const ss_header *head = grid->head;
    const ss_column none = { "", "" }, *column = head->n_columns > 0 ? head->column : &none;
    ss_status st = copy_grid(w, grid);
    if (st != SS_OK)
        return st;
    w->group = ss_h5_new_group(w->output.file.id, "wavelet");
    if (w->group < 0 || !ss_h5_write_text(w->group, "column", column->name)
        || !ss_h5_write_text(w->group, "column_units", column->unit) || !write_clock(w->group, head)
        || !ss_h5_write_number(w->group, "center", H5T_IEEE_F64LE, grid->center)
        || !ss_h5_write_number(w->group, "dense", H5T_STD_I8LE, w->dense)
        || !ss_h5_write_number(w->group, "scales", H5T_STD_I32LE, (double)w->n_scales))
        return fail(w, 0, "/wavelet");
    const h5_dataset v[] = {
        { .name = "scale", .unit = "s", .long_name = "scale a", .file_type = H5T_IEEE_F64LE,
          .values = &w->scale->a },
        { .name = "frequency", .unit = "Hz", .long_name = "frequency label omega_c / (2 pi a)",
          .file_type = H5T_IEEE_F64LE, .values = &w->scale->f },
        { .name = "m", .unit = "1", .long_name = "log2 of the scale in seconds", .file_type = H5T_IEEE_F64LE,
          .values = &w->scale->m },
        { .name = "j", .unit = "1", .long_name = "number of the scale, a = 2^(j/voices) s",
          .file_type = H5T_STD_I32LE, .values = &w->scale->j },
    };
    st = ss_h5_write_lists(&w->output.file, w->group, v, sizeof v / sizeof *v, w->n_scales,
                                     sizeof *w->scale);
    if (st == SS_OK && w->dense && !write_lattice(w->group, &w->scale[0]))
        return fail(w, 0, "/wavelet");
    for (size_t i = 0; st == SS_OK && !w->dense && i < w->n_scales; i++) {
        const ss_scale *scale = &w->scale[i];
        char name[32];
        snprintf(name, sizeof name, "scale%03zu", i);
        hid_t group = w->datasets[i].group = ss_h5_new_group(w->group, name);
        if (group < 0 || !ss_h5_write_number(group, "m", H5T_IEEE_F64LE, scale->m)
            || !ss_h5_write_number(group, "scale", H5T_IEEE_F64LE, scale->a)
            || !ss_h5_write_number(group, "frequency", H5T_IEEE_F64LE, scale->f)
            || !ss_h5_write_number(group, "j", H5T_STD_I32LE, scale->j) || !write_lattice(group, scale))
            st = fail(w, w->group, name);
    }
    return st;
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
open_datasets(h5_writer *w, size_t i, double most)
{
    static const char *const scales[] = { "scale", "time" };
    int rank = w->dense ? 2 : 1;
    hsize_t chunk = chunk_of(w, (w->dense ? 17 : 25) * w->n_scales);
    hsize_t length = w->growing ? 0 : w->dense ? w->length : w->scale[i].n;
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
    for (size_t k = 0; k < PARTS; k++) {
        d->part[k] = k == TIME ? ss_h5_new_dataset(group, &v[k], 1, &length, NULL)
            : ss_h5_new_dataset(group, &v[k], rank, dims + 2 - rank, scales + 2 - rank);
        /* the CF conventions name so the label of a row that is not its index */
        if (d->part[k] < 0 || (k != TIME && w->dense && !ss_h5_write_text(d->part[k], "coordinates", "frequency")))
            return fail(w, group, v[k].name);
    }
    if (!w->dense && H5Gclose(group) < 0)
        return fail(w, w->group, "re");
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

/* Write re or im of n coefficients.  Were HDF5 to make 32-bit floats of them, it would zero 1 MB in each call. */
static int
write_part(h5_writer *w, hid_t id, int single, int rank, const hsize_t at[], size_t n, const double *x)
{
    for (size_t k = 0; single && k < n; k++)
        w->single[k] = (float)x[k];
    return ss_h5_write_piece(id, rank, at, n, single ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE,
                             single ? (const void *)w->single : x);
}

/* Write n coefficients of scale i, at most a piece. */
static int
write_piece(h5_writer *w, size_t i, size_t n, const double *x, size_t samples)
{
    const ss_scale *scale = &w->scale[i];
    const struct scale_datasets *d = &w->datasets[w->dense ? 0 : i];
    size_t first = w->datasets[i].done;
    int rank = w->dense ? 2 : 1;
    const hsize_t where[2] = { i, first }, *at = where + 2 - rank;
    split(w->value[0], w->value[1], x, n, rounding_of(w->tolerance, w->datasets[i].most));
    for (size_t k = 0; k < n; k++)
        w->edge[k] = (unsigned char)wavelet_edge(scale, first + k, samples, w->rate, w->start, w->gap, w->n_gaps);
    return write_part(w, d->part[RE], d->single, rank, at, n, w->value[0])
        && write_part(w, d->part[IM], d->single, rank, at, n, w->value[1])
        && ss_h5_write_piece(d->part[EDGE], rank, at, n, H5T_NATIVE_UCHAR, w->edge)
        && (w->dense || write_times(w, d->part[TIME], scale, first, n));
}

/* Write the next n coefficients of a scale, as pairs, of a record with so many samples until now. */
static ss_status
append_coefficients(h5_writer *w, const ss_scale *scale, size_t first, size_t n, const double *x, size_t samples)
{
    size_t i = 0;
    while (i < w->n_scales && w->scale[i].j != scale->j)
        i++;
    struct scale_datasets *d = &w->datasets[i], *shared = &w->datasets[w->dense ? 0 : i];
    if (i == w->n_scales || d->done != first || (!w->growing && n > w->scale[i].n - first))
        return ss_fail(&w->output.error, SS_EINVAL, "coefficients that are not the next of a scale");
    ss_status st = SS_OK;
    d->most = w->tolerance > 0 ? largest_of(x, n, d->most) : 0;
    if (shared->part[RE] < 0 && n > 0)
        st = open_datasets(w, i, d->most);
    if (st == SS_OK && shared->single && d->most > FLT_MAX)
        st = ss_h5_fail(&w->output.file, SS_ERANGE, w->group, "re", "coefficients of at most 1e20 precede "
                        "some above 3.4e38, which 32-bit floats do not hold; keep all bits");
    if (st != SS_OK)
        return st;
    for (size_t m; n > 0; n -= m, x += 2 * m) {
        m = n < H5_PIECE ? n : H5_PIECE;
        if (!write_piece(w, i, m, x, samples))
            return fail(w, w->group, "re");
        d->done += m;
    }
    int good = 1;
    for (size_t k = 0; !w->growing && !w->dense && d->done == w->scale[i].n && k < PARTS; k++) {
        good &= d->part[k] < 0 || H5Dclose(d->part[k]) >= 0;
        d->part[k] = -1;
    }
    return good ? SS_OK : fail(w, w->group, "re");
}

/* Write the length and the times that all scales share, which are known only at the end.  Each scale must have all
 * the coefficients that it has in a record of so many samples. */
static ss_status
end_wavelet(h5_writer *w, size_t samples)
{
    hid_t root = w->output.file.id;
    double last = (double)(samples - 1) / w->rate;
    for (size_t i = 0; i < w->n_scales; i++) {
        const ss_scale *scale = &w->scale[i];
        size_t done = w->datasets[i].done;
        if (!w->growing ? done != scale->n
            : !(done > 0 && ss_scale_b(scale, done - 1) <= last && ss_scale_b(scale, done) > last))
            return ss_fail(&w->output.error, SS_EINVAL, "coefficients of scale %g are missing", scale->m);
    }
    char text[SS_NUMBER_MAX];
    ss_number_format(text, (double)samples);
    if ((w->dense && !write_times(w, w->datasets->part[TIME], &w->scale[0], 0, samples))
        || (H5Aexists(root, "samples") <= 0 && !ss_h5_write_text(root, "samples", text))
        || !ss_h5_write_number(w->group, "samples", H5T_STD_I64LE, (double)samples))
        return fail(w, 0, "/wavelet");
    return SS_OK;
}

/* --- the file ------------------------------------------------------------------------------ */

static ss_status
write_notes(h5_writer *w, const ss_header *head)
{
    hid_t root = w->output.file.id;
    if (!ss_h5_write_text(root, H5_VERSION_NOTE, SS_VERSION))
        return fail(w, 0, "/");
    for (size_t i = 0; head != NULL && i < head->n_notes; i++) {
        const char *colon = strstr(head->note[i], ": ");
        size_t length = colon != NULL ? (size_t)(colon - head->note[i]) : strlen(head->note[i]);
        char *key = strndup(head->note[i], length);
        if (key == NULL)
            return SS_ENOMEM;
        int good = H5Aexists(root, key) > 0 || ss_h5_write_text(root, key, colon != NULL ? colon + 2 : "");
        free(key);
        if (!good)
            return fail(w, 0, head->note[i]);
    }
    return SS_OK;
}

/* Run a step of a writer that has not failed.  The first failure, which may be the disk's, is kept for all calls
 * that follow. */
#define STEP(base, err, work) do { \
        h5_writer *w = (h5_writer *)(base); \
        ss_status st = w->status; \
        H5E_BEGIN_TRY { \
            if (st == SS_OK) \
                st = work; \
            w->status = ss_h5_output_check(&w->output, st); \
        } H5E_END_TRY \
        if (w->status != SS_OK && (err) != NULL) \
            *(err) = w->output.error; \
        return w->status; \
    } while (0)

static ss_status
write_rows(ss_writer *base, double *const column[], size_t n, ss_error *err)
{
    STEP(base, err, append_rows(w, column, n));
}

static ss_status
write_coefficients(ss_writer *base, const ss_scale *scale, size_t first, size_t n, const double *c, size_t samples,
                   ss_error *err)
{
    STEP(base, err, append_coefficients(w, scale, first, n, c, samples));
}

/* Events are written at the end, as their number is known then. */
static ss_status
keep_events(h5_writer *w, const ss_event *event, size_t n)
{
    ss_event *more = ss_list_grow(w->event, &w->room, w->n_events + n, sizeof *more);
    if (more == NULL)
        return SS_ENOMEM;
    w->event = more;
    for (size_t i = 0; i < n; i++)
        more[w->n_events++] = event[i];
    return SS_OK;
}

static ss_status
write_events(ss_writer *base, const ss_event *event, size_t n, ss_error *err)
{
    STEP(base, err, keep_events(w, event, n));
}

static ss_status
append_note(h5_writer *w, const char *key, const char *value)
{
    hid_t root = w->output.file.id;
    int good = H5Aexists(root, key) <= 0 || H5Adelete(root, key) >= 0;
    return good && ss_h5_write_text(root, key, value) ? SS_OK : fail(w, 0, key);
}

static ss_status
write_note(ss_writer *base, const char *key, const char *value, ss_error *err)
{
    STEP(base, err, append_note(w, key, value));
}

/* Write what is left, and check that all samples of the file have been given. */
static ss_status
complete(h5_writer *w, size_t samples)
{
    int fits = w->growing || samples == w->length;
    if ((w->n_scales > 0 && (samples < 1 || !fits)) || (w->column != NULL && (w->samples != samples || !fits)))
        return ss_fail(&w->output.error, SS_EINVAL, "%zu samples are not what the file has", samples);
    ss_status st = w->has_events ? write_all_events(w) : SS_OK;
    return st == SS_OK && w->n_scales > 0 ? end_wavelet(w, samples) : st;
}

static ss_status
end(h5_writer *w, size_t samples)
{
    if (w->ended)
        return ss_fail(&w->output.error, SS_EINVAL, "the file is complete");
    w->ended = 1;
    return ss_h5_output_close(&w->output, complete(w, samples));
}

static ss_status
end_file(ss_writer *base, size_t samples, ss_error *err)
{
    STEP(base, err, end(w, samples));
}

static void
free_writer(ss_writer *base)
{
    h5_writer *w = (h5_writer *)base;
    H5E_BEGIN_TRY {
        ss_h5_output_close(&w->output, SS_STOP);     /* does nothing if it has ended */
    } H5E_END_TRY
    free(w->event);
    free(w->column);
    free(w->unit);
    free(w->scale);
    free(w->datasets);
    free(w->gap);
    free(w->output.path);
    free(w);
}

static ss_status
begin(h5_writer *w, const ss_contents *what)
{
    const ss_header *head = what->grid != NULL ? what->grid->head : what->signal;
    w->rate = head != NULL ? head->rate : 1;
    w->start = head != NULL ? head->start : 0;
    w->length = what->n;
    w->growing = what->n == 0;
    w->has_events = what->events;
    ss_status st = w->output.path != NULL ? ss_h5_output_open(&w->output) : SS_ENOMEM;
    if (st == SS_OK)
        st = write_notes(w, head);
    if (st == SS_OK && what->signal != NULL)
        st = begin_signal(w, what->signal);
    return st == SS_OK && what->grid != NULL ? begin_wavelet(w, what->grid) : st;
}

static ss_status
writer_new(ss_writer **out, const char *path, const ss_contents *what, ss_error *err)
{
    static const struct writer_calls calls = {
        write_rows, write_coefficients, write_events, write_note, end_file, free_writer };
    const ss_header *head = what->grid != NULL ? what->grid->head : what->signal;
    ss_status st = head != NULL ? ss_header_check_notes(head, err) : SS_OK;
    if (st != SS_OK)
        return st;
    h5_writer *w = calloc(1, sizeof *w);
    if (w == NULL)
        return ss_fail_memory(err, path);
    w->base.calls = &calls;
    w->output.path = strdup(path);
    w->output.file = (h5_file){ .id = -1, .path = path, .err = &w->output.error, .disk.fd = -1 };
    H5E_BEGIN_TRY {
        st = ss_h5_output_check(&w->output, begin(w, what));
    } H5E_END_TRY
    w->output.file.path = w->output.path;
    if (st == SS_OK)
        *out = &w->base;
    else if (err != NULL)
        *err = w->output.error;
    if (st != SS_OK)
        free_writer(&w->base);
    return st;
}

const struct ss_store_calls *
ss_store_calls(ss_error *err)
{
    static const struct ss_store_calls calls = {
        .open_signal = ss_h5_open_signal, .open_coefficients = ss_h5_open_coefficients, .writer_new = writer_new };
    (void)err;
    return &calls;
}
