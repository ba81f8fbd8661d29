/* store_file.h -- records, and the one file that they are written to, as the tests of the store need
 * them. */
#ifndef STORE_FILE_H
#define STORE_FILE_H

#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <stickslip.h>
#include "map/map.h"

#include "store_samples.h"
#include "unit.h"

static char dir[] = "/tmp/test_store.XXXXXX", path[64];

static inline int
make_dir(void **state)
{
    (void)state;
    if (mkdtemp(dir) == NULL)
        return -1;
    snprintf(path, sizeof path, "%s/run.h5", dir);
    return 0;
}

static inline int
remove_dir(void **state)
{
    (void)state;
    unlink(path);
    return rmdir(dir);
}

/* The path of a dataset in the file; "" or NULL: that of the file. */
static inline const char *
place(const char *dataset)
{
    static char text[sizeof path + 8192];
    snprintf(text, sizeof text, "%s%s%s", path, dataset != NULL && *dataset != '\0' ? ":" : "",
             dataset != NULL ? dataset : "");
    return text;
}

static inline ss_status
load_place(ss_signal **out, const char *dataset, const ss_read_opts *opts, ss_error *err)
{
    return ss_signal_read(out, NULL, place(dataset), opts, err);
}

/* Read all coefficients of a file into memory. */
static inline ss_status
read_map(ss_coefficients **out, const char *name, ss_error *err)
{
    ss_coefficients *map = NULL;
    ss_status st = ss_coefficients_read(&map, NULL, name, err);
    if (st != SS_OK)
        return st;
    const ss_scale *last = &map->scale[map->n_scales - 1];
    double *w = malloc(2 * (last->offset + last->n) * sizeof *w);
    for (size_t i = 0; st == SS_OK && i < map->n_scales; i++) {
        const ss_scale *scale = &map->scale[i];
        st = ss_map_read(map, &(ss_map_part){ i, 0, scale->n, w + 2 * scale->offset, NULL }, 1, err);
    }
    map->w = w;                         /* its source stays, for ss_coefficients_free */
    if (st == SS_OK)
        *out = map;
    else
        ss_coefficients_free(map);
    return st;
}

static inline ss_signal *
new_signal(size_t n)
{
    ss_signal *signal = NULL;
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1000.0 / 3, -0.1, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "zeta", "kip", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "a", "m/s^2", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "t", "", NULL), SS_OK);      /* as the clock is called */
    assert_int_equal(ss_header_note(head, "scene", "compliant-light", NULL), SS_OK);
    assert_int_equal(ss_header_note(head, "author", "\303\204rger: \"\\ $x`", NULL), SS_OK);
    assert_int_equal(ss_signal_new(&signal, head, n, NULL), SS_OK);
    ss_header_free(head);
    for (size_t i = 0; i < 3 * n; i++)
        signal->values[i] = sin((double)i) / 3 + ldexp(1, -(int)(i % 1070));
    return signal;
}

static inline ss_coefficients *
transform(const ss_signal *signal, int dense)
{
    ss_coefficients *c = NULL;
    ss_error err = { 0 };
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.dense = dense;
    opts.voices = 5;
    opts.engine = SS_ENGINE_QUADRATURE;
    if (ss_morlet_transform(&c, signal, 1, &opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return c;
}

static inline void
write_ok(const ss_record *record)
{
    ss_error err = { 0 };
    if (ss_record_write(record, NULL, path, SS_H5, &err) != SS_OK)
        fail_msg("%s", err.text);
}

static inline void
assert_same_bits(const double *a, const double *b, size_t n)
{
    assert_memory_equal(a, b, n * sizeof *a);
}

static inline void
assert_same_notes(const ss_header *a, const ss_header *b)
{
    assert_int_equal(a->n_notes, b->n_notes);
    for (size_t i = 0; i < a->n_notes; i++)
        assert_string_equal(a->note[i], b->note[i]);
}

static unsigned long long seed = 7;

static inline size_t
draw(size_t most)
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (size_t)(seed >> 33) % most + 1;
}

/* All of signal and c in pieces, scales in turns, to a file whose length is known or not; stops at the
 * first failure. */
static inline ss_status
write_pieces(const ss_signal *signal, const ss_coefficients *c, int known, ss_error *err)
{
    ss_writer *writer = NULL;
    ss_coefficients grid = *c;
    size_t done[200] = { 0 }, left = 1, samples = 0;
    assert_true(c->n_scales <= 200);
    grid.n = known ? c->n : 0;
    grid.w = NULL;
    ss_status st = ss_writer_new(&writer, NULL, path, SS_H5, &(ss_contents){ signal->head,
                                 &grid, 0, grid.n }, err);
    while (st == SS_OK && samples < signal->n) {
        size_t n = draw(signal->n / 3 + 1);
        n = n < signal->n - samples ? n : signal->n - samples;
        st = store_samples(writer, signal, samples, n, err);
        samples += n;
    }
    while (st == SS_OK && left > 0) {
        left = 0;
        for (size_t i = 0; st == SS_OK && i < c->n_scales; i++) {
            const ss_scale *scale = &c->scale[i];
            size_t n = draw(scale->n);
            n = n < scale->n - done[i] ? n : scale->n - done[i];
            if (n > 0)
                st = ss_writer_coefficients(writer, scale, done[i], n,
                                          c->w + 2 * (scale->offset + done[i]), c->n, err);
            done[i] += n;
            left += scale->n - done[i];
        }
    }
    if (st == SS_OK)
        st = ss_writer_end(writer, c->n, err);
    ss_writer_free(writer);
    return st;
}

static inline char *
read_bytes(size_t *size)
{
    FILE *in = fopen(path, "rb");
    struct stat st;
    assert_int_equal(fstat(fileno(in), &st), 0);
    *size = (size_t)st.st_size;
    char *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, in), *size);
    fclose(in);
    return bytes;
}

/* A file with a user block of the given size, holding arrays of every sort. */
static inline void
write_foreign(hsize_t user_block)
{
    static const double real[6] = { 1, 2, 3, 4, 5, 6 };
    static const struct { const char *name; int rank; hsize_t dims[3]; int text; } row[] = {
        { "tall", 2, { 3, 2 }, 0 },     { "wide", 2, { 2, 3 }, 0 },     { "line", 1, { 6 }, 0 },
        { "cube", 3, { 1, 2, 3 }, 0 },  { "word", 1, { 1 }, 1 },        { "huge", 1, { 0 }, 0 },
    };
    hid_t how = H5Pcreate(H5P_FILE_CREATE), text = H5Tcopy(H5T_C_S1);
    hid_t complex = H5Tcreate(H5T_COMPOUND, 16);
    H5Tinsert(complex, "r", 0, H5T_NATIVE_DOUBLE);
    H5Tinsert(complex, "i", 8, H5T_NATIVE_DOUBLE);
    H5Tset_size(text, 40);
    H5Pset_userblock(how, user_block);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, how, H5P_DEFAULT);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        hsize_t big = (hsize_t)1 << 50, chunk = 100;
        int huge = strcmp(row[i].name, "huge") == 0;
        hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
        if (huge)
            H5Pset_chunk(layout, 1, &chunk);
        hid_t space = H5Screate_simple(row[i].rank, huge ? &big : row[i].dims, NULL);
        hid_t type = row[i].text ? text : strcmp(row[i].name, "line") == 0 ? H5T_STD_I16BE
                                                                           : H5T_IEEE_F32BE;
        hid_t id = H5Dcreate2(file, row[i].name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
        if (!huge)
            assert_true(H5Dwrite(id, row[i].text ? text : H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                                 H5P_DEFAULT, real) >= 0);
        H5Dclose(id);
        H5Sclose(space);
        H5Pclose(layout);
    }
    hid_t two = H5Screate_simple(1, (hsize_t[]){ 2 }, NULL);
    H5Dclose(H5Dcreate2(file, "complex", complex, two, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(two);
    H5Tclose(complex);
    H5Tclose(text);
    H5Pclose(how);
    H5Fclose(file);
}

/* A new attribute of an open object. */
static inline void
put_scalar(hid_t object, const char *name, hid_t type, const void *value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t id = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(id, type, value) >= 0);
    H5Aclose(id);
    H5Sclose(space);
}

/* Give an object of the file another number as an attribute, as anyone might. */
static inline void
put_attribute(const char *object, const char *name, double value)
{
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), id = H5Oopen(file, object, H5P_DEFAULT);
    if (H5Aexists(id, name) > 0)
        H5Adelete(id, name);
    put_scalar(id, name, H5T_NATIVE_DOUBLE, &value);
    H5Oclose(id);
    H5Fclose(file);
}

#endif
