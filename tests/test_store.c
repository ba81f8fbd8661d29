/* test_store.c -- what goes into an HDF5 file comes out again, to the last bit, at once or piece by
 * piece. */
#include <time.h>
#include "map/map.h"

#include "store_file.h"
#include "signal/noise.h"
#include "scene/scene.h"

/* --- records ------------------------------------------------------------------------------- */

static const ss_event events[] = {
    { 0.1 / 3, 1e-300, -0.0, SS_SLIP, 1 },
    { 0.2, 3.661076025e-4, 0, SS_STICK, -1 },
    { 0.2, -1, 5e-324, SS_REVERSE, -1 },
};

static void
assert_same_columns(const ss_header *a, const ss_header *b)
{
    assert_same_bits(&a->rate, &b->rate, 1);
    assert_same_bits(&a->start, &b->start, 1);
    assert_int_equal(a->has_time, b->has_time);
    assert_int_equal(a->n_columns, b->n_columns);
    for (size_t i = 0; i < a->n_columns; i++) {
        assert_string_equal(a->column[i].name, b->column[i].name);
        assert_string_equal(a->column[i].unit, b->column[i].unit);
    }
}

static void
a_signal_reads_back_exactly(void **state)
{
    static const size_t length[] = { 0, 1, 1000, 20000 };   /* none, one, plain, compressed */
    (void)state;
    for (size_t i = 0; i < sizeof length / sizeof *length; i++) {
        ss_signal *signal = new_signal(length[i]), *back = NULL;
        signal->head->has_time = i % 2 == 0;
        write_ok(&(ss_record){ .signal = signal });
        assert_int_equal(ss_signal_read(&back, NULL, path, NULL, NULL), SS_OK);
        assert_int_equal(back->n, length[i]);
        assert_same_columns(signal->head, back->head);
        assert_same_notes(signal->head, back->head);
        assert_same_bits(signal->values, back->values, 3 * length[i]);
        ss_signal_free(signal);
        ss_signal_free(back);
    }
}

static void
coefficients_read_back_exactly(void **state)
{
    (void)state;
    for (int dense = 0; dense < 2; dense++) {
        ss_signal *signal = new_signal(500);
        ss_coefficients *c = transform(signal, dense), *back = NULL;
        write_ok(&(ss_record){ .signal = signal, .coefficients = c });
        assert_int_equal(read_map(&back, path, NULL), SS_OK);
        assert_same_columns(c->head, back->head);
        assert_same_notes(c->head, back->head);
        assert_int_equal(back->n, c->n);
        assert_same_bits(&back->center, &c->center, 1);
        assert_int_equal(back->n_scales, c->n_scales);
        size_t total = 0;
        for (size_t i = 0; i < c->n_scales; i++) {
            const ss_scale *a = &c->scale[i], *b = &back->scale[i];
            const double one[] = { a->m, a->a, a->f, a->b_num, a->b_den };
            const double two[] = { b->m, b->a, b->f, b->b_num, b->b_den };
            assert_same_bits(one, two, 5);
            assert_int_equal(a->j, b->j);
            assert_int_equal(a->n, b->n);
            assert_int_equal(a->offset, b->offset);
            total += a->n;
        }
        assert_same_bits(c->w, back->w, 2 * total);
        ss_coefficients_free(back);
        ss_coefficients_free(c);
        ss_signal_free(signal);
    }
}

static void
read_raw(const char *name, hid_t type, void *values)
{
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    hid_t id = H5Dopen2(file, name, H5P_DEFAULT);
    assert_true(id >= 0);
    assert_true(H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    H5Dclose(id);
    H5Fclose(file);
}

/* --- made piece by piece ------------------------------------------------------------------- */

/* Short, so that no chunk is full, and long, so that there are several. */
static void
a_file_made_piece_by_piece_reads_back_exactly(void **state)
{
    static const size_t length[] = { 60, 5000, 80000 };
    (void)state;
    for (size_t k = 0; k < 3; k++)
        for (int row = 0; row < 4; row++) {
            ss_signal *signal = new_signal(length[k]), *back = NULL;
            ss_coefficients *c, *again = NULL;
            ss_error err = { 0 };
            ss_morlet_opts opts = ss_morlet_defaults;
            opts.voices = 2, opts.dense = row % 2;
            assert_int_equal(ss_morlet_transform(&c, signal, 1, &opts, NULL), SS_OK);
            if (write_pieces(signal, c, row / 2, &err) != SS_OK)
                fail_msg("%s", err.text);
            assert_int_equal(ss_signal_read(&back, NULL, path, NULL, NULL), SS_OK);
            assert_int_equal(back->n, signal->n);
            assert_same_columns(signal->head, back->head);
            assert_same_bits(signal->values, back->values, 3 * signal->n);
            assert_int_equal(read_map(&again, path, NULL), SS_OK);
            assert_same_notes(c->head, again->head);
            assert_int_equal(again->n, c->n);
            assert_int_equal(again->n_scales, c->n_scales);
            const ss_scale *last = &c->scale[c->n_scales - 1];
            assert_same_bits(c->w, again->w, 2 * (last->offset + last->n));
            ss_coefficients_free(again);
            ss_coefficients_free(c);
            ss_signal_free(back);
            ss_signal_free(signal);
        }
}

/* A signal alone, whose length is not known, in pieces of any length, row by row. */
static void
a_signal_of_unknown_length_reads_back_exactly(void **state)
{
    static const size_t length[] = { 1, 5000, 500000 };
    (void)state;
    for (size_t k = 0; k < 3; k++) {
        size_t n = length[k], piece = k == 0 ? 1 : 999;
        ss_signal *signal = new_signal(n), *back = NULL;
        size_t columns = signal->head->n_columns;
        ss_writer *writer = NULL;
        assert_int_equal(ss_writer_new(&writer, NULL, path, SS_H5,
                                       &(ss_contents){ signal->head, NULL, 0, 0 }, NULL), SS_OK);
        for (size_t i = 0, m; i < n; i += m) {
            m = n - i < piece ? n - i : piece;
            assert_int_equal(store_samples(writer, signal, i, m, NULL), SS_OK);
        }
        assert_int_equal(ss_writer_note(writer, "late", "a note: at the end", NULL), SS_OK);
        assert_int_equal(ss_header_note(signal->head, "late", "a note: at the end", NULL), SS_OK);
        assert_int_equal(ss_writer_end(writer, n, NULL), SS_OK);
        ss_writer_free(writer);
        assert_int_equal(ss_signal_read(&back, NULL, path, NULL, NULL), SS_OK);
        assert_int_equal(back->n, n);
        assert_same_columns(signal->head, back->head);
        assert_same_notes(signal->head, back->head);
        assert_same_bits(signal->values, back->values, n * columns);
        assert_int_equal(ss_writer_new(&writer, NULL, path, SS_H5,
                                       &(ss_contents){ signal->head, NULL, 0, 0 }, NULL), SS_OK);
        assert_int_equal(store_samples(writer, signal, 0, n, NULL), SS_OK);
        assert_int_equal(ss_writer_end(writer, n + 1, NULL), SS_EINVAL);
        ss_writer_free(writer);
        ss_signal_free(back);
        ss_signal_free(signal);
    }
}

static int
to_store(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    return ss_writer_coefficients(user, scale, first, n, w, samples, NULL) != SS_OK;
}

/* The file's size after a transform of x has been written as a whole, or as a stream in pieces. */
static long
write_transform(const ss_signal *signal, const ss_morlet_opts *opts, int stream)
{
    ss_morlet *plan = NULL;
    ss_stream *flow = NULL;
    ss_writer *writer = NULL;
    ss_coefficients grid = { .n = stream ? 0 : signal->n, .center = opts->center };
    const double *x = signal->values + signal->n;
    struct stat st;
    assert_int_equal(ss_morlet_new(&plan, signal->n, signal->head->rate, opts, NULL), SS_OK);
    assert_int_equal(ss_coefficients_header(&grid.head, signal->head, 1, grid.n, opts, NULL), SS_OK);
    grid.n_scales = ss_morlet_grid(plan)->n_scales;
    grid.scale = malloc(grid.n_scales * sizeof *grid.scale);
    memcpy(grid.scale, ss_morlet_grid(plan)->scale, grid.n_scales * sizeof *grid.scale);
    assert_int_equal(ss_writer_new(&writer, NULL, path, SS_H5, &(ss_contents){ NULL,
                                   &grid, 0, grid.n }, NULL), SS_OK);
    if (stream) {
        assert_int_equal(ss_stream_new(&flow, signal->head->rate, opts, to_store, writer, NULL), SS_OK);
        assert_int_equal(ss_stream_push(flow, x, signal->n, NULL), SS_OK);
        assert_int_equal(ss_stream_end(flow, NULL), SS_OK);
    } else
        assert_int_equal(ss_morlet_each(plan, x, to_store, writer, NULL), SS_OK);
    assert_int_equal(ss_writer_end(writer, signal->n, NULL), SS_OK);
    ss_writer_free(writer);
    ss_stream_free(flow);
    ss_morlet_free(plan);
    ss_header_free(grid.head);
    free(grid.scale);
    assert_int_equal(stat(path, &st), 0);
    return (long)st.st_size;
}

/* The largest error of what the file holds, in units of the accuracy times the largest |W| of its
 * scale, by the sum. */
static double
error_of_file(const ss_signal *signal, const ss_morlet_opts *opts)
{
    ss_coefficients *back = NULL;
    ss_morlet_opts exact = *opts;
    ss_morlet *plan = NULL;
    double worst = 0;
    exact.engine = SS_ENGINE_QUADRATURE, exact.accuracy = 1e-13, exact.rounded = 0, exact.force = 1;
    assert_int_equal(read_map(&back, path, NULL), SS_OK);
    assert_int_equal(ss_morlet_new(&plan, signal->n, signal->head->rate, &exact, NULL), SS_OK);
    assert_int_equal(ss_morlet_grid(plan)->n_scales, back->n_scales);
    double *w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w);
    assert_int_equal(ss_morlet_execute(plan, signal->values + signal->n, w, NULL), SS_OK);
    for (size_t i = 0; i < back->n_scales; i++) {
        const ss_scale *scale = &back->scale[i];
        double most = 0, error = 0;
        assert_int_equal(scale->offset, ss_morlet_grid(plan)->scale[i].offset);
        for (size_t k = scale->offset; k < scale->offset + scale->n; k++) {
            most = fmax(most, hypot(w[2 * k], w[2 * k + 1]));
            error = fmax(error, hypot(w[2 * k] - back->w[2 * k], w[2 * k + 1] - back->w[2 * k + 1]));
        }
        worst = fmax(worst, error / (opts->accuracy * most));
    }
    free(w);
    ss_morlet_free(plan);
    ss_coefficients_free(back);
    return worst;
}

/* 20 bits of noise and some more are needed of 64, and 10.  A row is a chunk of scales as in
 * README-morlet.md, up to a twentieth of the rate. */
static void
rounded_coefficients_keep_the_accuracy_in_half_the_bytes(void **state)
{
    static const double accuracy[] = { 1e-6, 1e-3, 1e-12 }, part[] = { 0.4, 0.22, 0.9 };
    ss_signal *signal = new_signal(65536);
    double *x = signal->values + signal->n;
    (void)state;
    memset(x, 0, signal->n * sizeof *x);
    ss_noise_add_once(x, signal->n, 1, 1, NULL);
    for (int row = 0; row < 12; row++) {
        int stream = row % 2;
        ss_morlet_opts opts = ss_morlet_defaults;
        opts.accuracy = accuracy[row / 4], opts.dense = row / 2 % 2, opts.voices = 1;
        opts.fmin = 1, opts.fmax = 16;
        long whole = write_transform(signal, &opts, stream);
        opts.rounded = 1;
        long size = write_transform(signal, &opts, stream);
        double error = error_of_file(signal, &opts);
        int small = !opts.dense || (double)size < part[row / 4] * (double)whole;    /* rows are short */
        if (!(error <= 1 && error > 0.1 && small))
            fail_msg("accuracy %g, row %d: error %g, %ld of %ld bytes", opts.accuracy, row, error,
                     size, whole);
    }
    ss_signal_free(signal);
}

/* Bytes of a number of the coefficients of the longest scale. */
static size_t
size_of_number(int dense)
{
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    hid_t id = H5Dopen2(file, dense ? "/wavelet/re" : "/wavelet/scale000/re", H5P_DEFAULT);
    hid_t type = H5Dget_type(id);
    size_t size = H5Tget_size(type);
    H5Tclose(type);
    H5Dclose(id);
    H5Fclose(file);
    return size;
}

/* A tone that dies away, so that the scales and the parts of each differ by many orders. */
static void
fill_with_ringdown(ss_signal *signal, double amplitude)
{
    double *x = signal->values + signal->n;
    for (size_t i = 0; i < signal->n; i++)
        x[i] = amplitude * exp(-0.02 * (double)i) * cos(1.3 * (double)i);
}

static void
floats_are_stored_where_they_keep_the_accuracy(void **state)
{
    static const struct { double amplitude, accuracy; size_t size; } row[] = {
        { 1, 1e-3, 4 }, { 1, 1e-6, 4 }, { 1, 1e-7, 4 }, { 1, 9e-8, 8 }, { 1e-17, 1e-7, 4 },
        { 1e17, 1e-7, 4 }, { 1e-40, 1e-6, 8 }, { 1e-300, 1e-6, 8 }, { 1e38, 1e-6, 8 }, { 1e150, 1e-6, 8 },
        { 1e300, 1e-6, 8 },
    };
    ss_signal *signal = new_signal(2000);
    (void)state;
    for (size_t r = 0; r < 4 * sizeof row / sizeof *row; r++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        opts.accuracy = row[r / 4].accuracy, opts.dense = r / 2 % 2, opts.voices = 3, opts.rounded = 1;
        opts.fmin = 2, opts.fmax = 40;
        fill_with_ringdown(signal, row[r / 4].amplitude);
        write_transform(signal, &opts, r % 2);
        double error = error_of_file(signal, &opts);
        if (!(error <= 1 && size_of_number(opts.dense) == row[r / 4].size))
            fail_msg("%g at %g, row %zu: error %g, %zu bytes", row[r / 4].amplitude, opts.accuracy, r,
                     error, size_of_number(opts.dense));
    }
    ss_signal_free(signal);
}

/* The first coefficients of a stream choose the type. */
static void
coefficients_that_outgrow_floats_are_refused(void **state)
{
    (void)state;
    ss_signal *signal = new_signal(500);
    for (int k = 0; k < 2; k++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        opts.dense = k, opts.rounded = 1;
        ss_coefficients *c;
        ss_error err = { 0 };
        assert_int_equal(ss_morlet_transform(&c, signal, 1, &opts, NULL), SS_OK);
        const ss_scale *scale = &c->scale[0];
        static const double small[2] = { 1, 1 }, large[2] = { 0, 1e39 };
        ss_writer *writer;
        c->n = 0;
        assert_int_equal(ss_writer_new(&writer, NULL, path, SS_H5, &(ss_contents){ NULL, c, 0, c->n },
                                       &err), SS_OK);
        assert_int_equal(ss_writer_coefficients(writer, scale, 0, 1, small, 500, &err), SS_OK);
        assert_int_equal(ss_writer_coefficients(writer, scale, 1, 1, large, 500, &err), SS_ERANGE);
        assert_non_null(strstr(err.text, "/wavelet/re: coefficients of at most 1e20 precede some above 3.4e38"));
        ss_writer_free(writer);
        assert_int_equal(access(path, F_OK), -1);
        ss_coefficients_free(c);
    }
    ss_signal_free(signal);
}

static void
scales_can_be_read_one_by_one(void **state)
{
    (void)state;
    for (int dense = 0; dense < 2; dense++) {
        ss_signal *signal = new_signal(500);
        ss_coefficients *c = transform(signal, dense);
        ss_coefficients *map;
        ss_error err = { 0 };
        size_t longest = c->scale[c->n_scales - 1].n;
        double *w = malloc(2 * longest * sizeof *w), *level = malloc(longest * sizeof *level);
        write_ok(&(ss_record){ .signal = signal, .coefficients = c });
        assert_int_equal(ss_coefficients_read(&map, NULL, path, NULL), SS_OK);
        assert_null(map->w);
        assert_true(map->n == c->n && map->n_scales == c->n_scales);
        assert_same_notes(c->head, map->head);
        for (size_t i = c->n_scales; i-- > 0;) {
            size_t n = c->scale[i].n, part = n / 3;
            const double *all = c->w + 2 * c->scale[i].offset;
            assert_int_equal(ss_map_read(map, &(ss_map_part){ i, 0, n, w, NULL }, 1, NULL), SS_OK);
            assert_same_bits(w, all, 2 * n);
            const ss_map_part thirds[] = { { i, part, n - part, w, NULL }, { i, 0, part, NULL, level } };
            assert_int_equal(ss_map_read(map, thirds, 2, NULL), SS_OK);
            assert_same_bits(w, all + 2 * part, 2 * (n - part));
            for (size_t k = 0; k < part; k++)
                assert_true(fabs(level[k] - hypot(all[2 * k], all[2 * k + 1])) <= 4e-16 * level[k]);
        }
        const ss_map_part none[] = { { c->n_scales, 0, 1, w, NULL }, { 0, c->scale[0].n, 1, w, NULL },
                                     { 0, 0, 1, NULL, NULL } };
        for (size_t i = 0; i < sizeof none / sizeof *none; i++)
            assert_int_equal(ss_map_read(map, &none[i], 1, &err), SS_EINVAL);
        const double most[2] = { ss_coefficients_max(map), ss_coefficients_max(c) };
        assert_same_bits(&most[0], &most[1], 1);
        ss_coefficients_free(map);
        free(w);
        free(level);
        ss_coefficients_free(c);
        ss_signal_free(signal);
    }
}

static void
edges_and_times_are_those_of_the_whole(void **state)
{
    enum { N = 3000 };
    static double t[2][4 * N];
    static unsigned char edge[2][50 * N];
    (void)state;
    for (int dense = 0; dense < 2; dense++) {
        ss_signal *signal = new_signal(N);
        ss_coefficients *c;
        ss_morlet_opts opts = ss_morlet_defaults;
        hid_t file, id;
        opts.voices = 2, opts.dense = dense;
        assert_int_equal(ss_morlet_transform(&c, signal, 1, &opts, NULL), SS_OK);
        size_t last = c->n_scales - 1;
        char times[40], edges[40];
        snprintf(times, sizeof times, dense ? "/wavelet/time" : "/wavelet/scale%03zu/time", last);
        snprintf(edges, sizeof edges, dense ? "/wavelet/edge" : "/wavelet/scale%03zu/edge", last);
        for (int k = 0; k < 2; k++) {
            assert_int_equal(write_pieces(signal, c, k, NULL), SS_OK);
            read_raw(times, H5T_NATIVE_DOUBLE, t[k]);
            read_raw(edges, H5T_NATIVE_UCHAR, edge[k]);
        }
        for (size_t i = 0; i < c->scale[last].n; i++) {
            size_t at = dense ? last * N + i : i;
            assert_true(fabs(t[0][i] - (-0.1 + ss_scale_b(&c->scale[last], i))) < 1e-12);
            assert_int_equal(edge[0][at], ss_coefficients_edge(c, last, i));
        }
        assert_memory_equal(t[0], t[1], c->scale[last].n * sizeof **t);
        assert_memory_equal(edge[0], edge[1], (dense ? c->n_scales : 1) * c->scale[last].n);
        /* the one with an unknown length has a dimension that may grow on */
        assert_int_equal(write_pieces(signal, c, 0, NULL), SS_OK);
        hsize_t dims[2], most[2];
        file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        id = H5Dopen2(file, edges, H5P_DEFAULT);
        hid_t space = H5Dget_space(id);
        int rank = H5Sget_simple_extent_dims(space, dims, most);
        assert_true(rank == 1 + dense && most[rank - 1] == H5S_UNLIMITED);
        H5Sclose(space);
        H5Dclose(id);
        H5Fclose(file);
        ss_coefficients_free(c);
        ss_signal_free(signal);
    }
}

static void
events_are_stored_with_their_kinds_as_words(void **state)
{
    double t[3], x[3], v[3];
    int direction[3];
    char kind[3][8];
    hid_t text = H5Tcopy(H5T_C_S1);
    (void)state;
    H5Tset_size(text, 8);
    write_ok(&(ss_record){ .events = events, .n_events = 3 });
    read_raw("/events/t", H5T_NATIVE_DOUBLE, t);
    read_raw("/events/x", H5T_NATIVE_DOUBLE, x);
    read_raw("/events/v", H5T_NATIVE_DOUBLE, v);
    read_raw("/events/direction", H5T_NATIVE_INT, direction);
    read_raw("/events/kind", text, kind);
    H5Tclose(text);
    for (size_t i = 0; i < 3; i++) {
        assert_same_bits(&t[i], &events[i].t, 1);
        assert_same_bits(&x[i], &events[i].x, 1);
        assert_same_bits(&v[i], &events[i].v, 1);
        assert_int_equal(direction[i], events[i].direction);
        assert_string_equal(kind[i], ss_event_kind_name(events[i].kind));
    }
}

static void
no_events_are_an_empty_group_only_where_asked_for(void **state)
{
    (void)state;
    for (int has = 0; has < 2; has++) {
        write_ok(&(ss_record){ .has_events = has });
        hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        assert_int_equal(H5Lexists(file, "events", H5P_DEFAULT) > 0, has);
        H5Fclose(file);
    }
}

static void
the_same_record_gives_the_same_bytes_a_second_later(void **state)
{
    ss_signal *signal = new_signal(20000);
    ss_coefficients *c = transform(signal, 0);
    ss_record record = { signal, events, 3, 1, c };
    size_t n, m;
    (void)state;
    write_ok(&record);
    char *before = read_bytes(&n);
    for (time_t second = time(NULL); time(NULL) == second; )
        ;                               /* HDF5 keeps whole seconds */
    write_ok(&record);
    char *after = read_bytes(&m);
    assert_int_equal(n, m);
    assert_memory_equal(before, after, n);
    free(before);
    free(after);
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

static void
only_large_datasets_are_compressed(void **state)
{
    (void)state;
    for (size_t n = 8192; n <= 8193; n++) {             /* 64 KiB, and a value more */
        ss_signal *signal = new_signal(n);
        write_ok(&(ss_record){ .signal = signal });
        hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        hid_t id = H5Dopen2(file, "/signal/a", H5P_DEFAULT), how = H5Dget_create_plist(id);
        assert_int_equal(H5Pget_nfilters(how), n > 8192 ? 2 : 0);
        H5Pclose(how);
        H5Dclose(id);
        H5Fclose(file);
        ss_signal_free(signal);
    }
}

/* 1 if t has the list of what is attached to it. */
static int
write_columns(size_t n)
{
    ss_signal *signal = NULL, *back = NULL;
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    char name[32];
    struct stat st;
    for (size_t c = 0; c < n; c++) {
        snprintf(name, sizeof name, "x%zu", c);
        assert_int_equal(ss_header_add_column(head, name, "", NULL), SS_OK);
    }
    assert_int_equal(ss_signal_new(&signal, head, 1, NULL), SS_OK);
    ss_header_free(head);
    for (size_t c = 0; c < n; c++)
        signal->values[c] = (double)c;
    write_ok(&(ss_record){ .signal = signal });
    assert_int_equal(stat(path, &st), 0);
    assert_true(st.st_size < 400 * (off_t)n);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), t = H5Dopen2(file, "/signal/t", H5P_DEFAULT);
    int attached = H5Aexists(t, "REFERENCE_LIST") > 0;
    H5Dclose(t);
    H5Fclose(file);
    assert_int_equal(ss_signal_read(&back, NULL, path, NULL, NULL), SS_OK);
    assert_int_equal(back->head->n_columns, n);
    assert_same_bits(back->values, signal->values, n);
    ss_signal_free(back);
    ss_signal_free(signal);
    return attached;
}

/* Beyond, HDF5 would append its list to the file for each: 63 MB for 8192 columns. */
static void
as_many_columns_are_attached_to_t_as_its_header_can_list(void **state)
{
    (void)state;
    assert_true(write_columns(4000));
    assert_false(write_columns(4001));
}

/* Chunks of one length (a whole signal), of another (one that grew), and none. */
static void
rows_are_those_of_the_whole_signal(void **state)
{
    static const size_t length[] = { 0, 1, 100, 200000 };
    ss_signal *small = new_signal(500);
    ss_coefficients *c = transform(small, 0);
    (void)state;
    for (int i = 0; i < 5; i++) {
        int grew = i == 4;
        size_t n = grew ? small->n : length[i], done = 0, got;
        ss_signal *signal = new_signal(n);
        ss_reader *reader = NULL;
        ss_error err = { 0 };
        double x[3][1000], *column[] = { x[0], x[1], x[2] };
        if (!grew)
            write_ok(&(ss_record){ .signal = signal });
        else
            assert_int_equal(write_pieces(small, c, 0, &err), SS_OK);
        if (ss_reader_new(&reader, NULL, path, NULL, &err) != SS_OK)
            fail_msg("%s", err.text);
        assert_string_equal(ss_reader_header(reader)->column[2].name, "t");
        do {
            assert_int_equal(ss_reader_rows(reader, column, draw(1000), &got, &err), SS_OK);
            for (size_t k = 0; k < 3; k++)
                assert_same_bits(x[k], &signal->values[k * n + done], got);
            done += got;
        } while (got > 0);
        assert_int_equal(done, n);
        ss_reader_free(reader);
        ss_signal_free(signal);
    }
    ss_coefficients_free(c);
    ss_signal_free(small);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_signal_reads_back_exactly),
        cmocka_unit_test(coefficients_read_back_exactly),
        cmocka_unit_test(a_file_made_piece_by_piece_reads_back_exactly),
        cmocka_unit_test(a_signal_of_unknown_length_reads_back_exactly),
        cmocka_unit_test(rounded_coefficients_keep_the_accuracy_in_half_the_bytes),
        cmocka_unit_test(floats_are_stored_where_they_keep_the_accuracy),
        cmocka_unit_test(coefficients_that_outgrow_floats_are_refused),
        cmocka_unit_test(scales_can_be_read_one_by_one),
        cmocka_unit_test(edges_and_times_are_those_of_the_whole),
        cmocka_unit_test(events_are_stored_with_their_kinds_as_words),
        cmocka_unit_test(no_events_are_an_empty_group_only_where_asked_for),
        cmocka_unit_test(the_same_record_gives_the_same_bytes_a_second_later),
        cmocka_unit_test(only_large_datasets_are_compressed),
        cmocka_unit_test(as_many_columns_are_attached_to_t_as_its_header_can_list),
        cmocka_unit_test(rows_are_those_of_the_whole_signal),
    };
    return cmocka_run_group_tests_name("store", tests, make_dir, remove_dir);
}
