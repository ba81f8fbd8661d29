/* test_store.c -- what goes into an HDF5 file comes out again, to the last bit; what others wrote
 * is read or refused in clear words; a failed write leaves nothing behind. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <errno.h>
#include <hdf5.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <stickslip.h>

static char dir[] = "/tmp/test_store.XXXXXX", path[64];

static int
make_dir(void **state)
{
    (void)state;
    if (mkdtemp(dir) == NULL)
        return -1;
    snprintf(path, sizeof path, "%s/run.h5", dir);
    return 0;
}

static int
remove_dir(void **state)
{
    (void)state;
    unlink(path);
    return rmdir(dir);
}

/* --- records ------------------------------------------------------------------------------- */

static ss_signal *
new_signal(size_t n)
{
    ss_signal *signal = NULL;
    ss_header *head = ss_header_new(1000.0 / 3, -0.1);
    assert_int_equal(ss_header_add_column(head, "zeta", "kip"), SS_OK);
    assert_int_equal(ss_header_add_column(head, "a", "m/s^2"), SS_OK);
    assert_int_equal(ss_header_add_column(head, "t", ""), SS_OK);      /* as the clock is called */
    assert_int_equal(ss_header_note(head, "scene", "compliant-light"), SS_OK);
    assert_int_equal(ss_header_note(head, "author", "\303\204rger: \"\\ $x`"), SS_OK);
    assert_int_equal(ss_signal_new(&signal, head, n), SS_OK);
    ss_header_free(head);
    for (size_t i = 0; i < 3 * n; i++)
        signal->values[i] = sin((double)i) / 3 + ldexp(1, -(int)(i % 1070));
    return signal;
}

static const ss_event events[] = {
    { 0.1 / 3, 1e-300, -0.0, SS_SLIP, 1 },
    { 0.2, 3.661076025e-4, 0, SS_STICK, -1 },
    { 0.2, -1, 5e-324, SS_REVERSE, -1 },
};

static ss_coefficients *
transform(const ss_signal *signal, int dense)
{
    ss_coefficients *c = NULL;
    ss_error err = { "" };
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.dense = dense;
    opts.voices = 5;
    opts.engine = SS_ENGINE_QUADRATURE;
    if (ss_morlet_transform(&c, signal, 1, &opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return c;
}

static void
write_ok(const ss_record *record)
{
    ss_error err = { "" };
    if (ss_store_write(path, record, &err) != SS_OK)
        fail_msg("%s", err.text);
}

static void
assert_same_bits(const double *a, const double *b, size_t n)
{
    assert_memory_equal(a, b, n * sizeof *a);
}

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
assert_same_notes(const ss_header *a, const ss_header *b)
{
    assert_int_equal(a->n_notes, b->n_notes);
    for (size_t i = 0; i < a->n_notes; i++)
        assert_string_equal(a->note[i], b->note[i]);
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
        assert_int_equal(ss_store_read_signal(&back, path, NULL, NULL, NULL), SS_OK);
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
        assert_int_equal(ss_store_read_coefficients(&back, path, NULL), SS_OK);
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

/* --- made piece by piece --- */

static unsigned long long seed = 7;

static size_t
draw(size_t most)
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (size_t)(seed >> 33) % most + 1;
}

/* All of signal and c in pieces, scales in turns, to a file whose length is known or not; stops at the
 * first failure. */
static ss_status
write_pieces(const ss_signal *signal, const ss_coefficients *c, int known, ss_error *err)
{
    ss_store_writer *writer = NULL;
    ss_coefficients grid = *c;
    size_t done[200] = { 0 }, left = 1, samples = 0;
    assert_true(c->n_scales <= 200);
    grid.n = known ? c->n : 0;
    grid.w = NULL;
    ss_status st = ss_store_writer_new(&writer, path, signal->head, &grid, err);
    while (st == SS_OK && samples < signal->n) {
        size_t n = draw(signal->n / 3 + 1);
        n = n < signal->n - samples ? n : signal->n - samples;
        st = ss_store_writer_signal(writer, signal->values + samples, n, 1, signal->n, err);
        samples += n;
    }
    while (st == SS_OK && left > 0) {
        left = 0;
        for (size_t i = 0; st == SS_OK && i < c->n_scales; i++) {
            const ss_scale *scale = &c->scale[i];
            size_t n = draw(scale->n);
            n = n < scale->n - done[i] ? n : scale->n - done[i];
            if (n > 0)
                st = ss_store_writer_rows(writer, scale, done[i], n,
                                          c->w + 2 * (scale->offset + done[i]), c->n, err);
            done[i] += n;
            left += scale->n - done[i];
        }
    }
    if (st == SS_OK)
        st = ss_store_writer_end(writer, c->n, err);
    ss_store_writer_free(writer);
    return st;
}

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
            ss_error err = { "" };
            ss_morlet_opts opts = ss_morlet_defaults;
            opts.voices = 2, opts.dense = row % 2;
            assert_int_equal(ss_morlet_transform(&c, signal, 1, &opts, NULL), SS_OK);
            if (write_pieces(signal, c, row / 2, &err) != SS_OK)
                fail_msg("%s", err.text);
            assert_int_equal(ss_store_read_signal(&back, path, NULL, NULL, NULL), SS_OK);
            assert_int_equal(back->n, signal->n);
            assert_same_columns(signal->head, back->head);
            assert_same_bits(signal->values, back->values, 3 * signal->n);
            assert_int_equal(ss_store_read_coefficients(&again, path, NULL), SS_OK);
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

static void
scales_can_be_read_one_by_one(void **state)
{
    (void)state;
    for (int dense = 0; dense < 2; dense++) {
        ss_signal *signal = new_signal(500);
        ss_coefficients *c = transform(signal, dense);
        ss_store_reader *reader;
        ss_error err = { "" };
        double *w = malloc(2 * c->scale[c->n_scales - 1].n * sizeof *w);
        write_ok(&(ss_record){ .signal = signal, .coefficients = c });
        assert_int_equal(ss_store_reader_new(&reader, path, NULL), SS_OK);
        const ss_coefficients *grid = ss_store_reader_grid(reader);
        assert_null(grid->w);
        assert_true(grid->n == c->n && grid->n_scales == c->n_scales);
        assert_same_notes(c->head, grid->head);
        for (size_t i = c->n_scales; i-- > 0;) {
            assert_int_equal(ss_store_reader_scale(reader, i, w, NULL), SS_OK);
            assert_same_bits(w, c->w + 2 * c->scale[i].offset, 2 * c->scale[i].n);
        }
        assert_int_equal(ss_store_reader_scale(reader, c->n_scales, w, &err), SS_EINVAL);
        assert_true(isnan(ss_coefficients_max(grid)));
        ss_store_reader_free(reader);
        free(w);
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
a_file_that_is_not_brought_to_its_end_is_no_file(void **state)
{
    (void)state;
    for (int row = 0; row < 6; row++) {
        ss_signal *signal = new_signal(300);
        ss_coefficients *c = transform(signal, 1), grid = *c;
        const ss_scale *scale = c->scale;
        ss_store_writer *writer = NULL;
        ss_error err = { "" };
        grid.n = row % 2 ? c->n : 0;
        assert_int_equal(ss_store_writer_new(&writer, path, signal->head, &grid, NULL), SS_OK);
        ss_status st = ss_store_writer_signal(writer, signal->values, 300, 1, 300, &err);
        assert_int_equal(st, SS_OK);
        assert_int_equal(ss_store_writer_rows(writer, scale, 0, 200, c->w, 300, NULL), SS_OK);
        if (row < 2)            /* a gap in the rows of a scale */
            st = ss_store_writer_rows(writer, scale, 201, 99, c->w, 300, &err);
        else if (row < 4)       /* rows are missing */
            st = ss_store_writer_end(writer, 300, &err);
        else if (row == 5)      /* a sample too many */
            st = ss_store_writer_signal(writer, signal->values, 1, 1, 300, &err);
        assert_int_equal(st, row == 4 ? SS_OK : SS_EINVAL);
        if (row != 4) {         /* it says so once and for all */
            char first[sizeof err.text];
            strcpy(first, err.text);
            assert_true(first[0] != '\0');
            err.text[0] = '\0';
            assert_int_equal(ss_store_writer_end(writer, 300, &err), SS_EINVAL);
            assert_string_equal(err.text, first);
        }
        ss_store_writer_free(writer);
        assert_int_equal(access(path, F_OK), -1);
        assert_int_equal(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
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

static char *
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
    sleep(2);                           /* HDF5 keeps whole seconds */
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

/* --- failures ------------------------------------------------------------------------------ */

static void
a_write_that_fails_says_why_and_leaves_no_file(void **state)
{
    struct rlimit old, small;
    ss_error err = { "" };
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    ss_signal *signal = new_signal(50000);
    for (rlim_t limit = 0; limit < 1000000; limit = 2 * limit + 100) {
        small = old;
        small.rlim_cur = limit;
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
        ss_status status = ss_store_write(path, &(ss_record){ .signal = signal }, &err);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
        assert_int_equal(status, SS_EIO);
        assert_non_null(strstr(err.text, path));
        assert_non_null(strstr(err.text, strerror(EFBIG)));
        assert_int_equal(access(path, F_OK), -1);
    }
    write_ok(&(ss_record){ .signal = signal });         /* and the library is fit to go on */
    ss_signal_free(signal);
}

/* At every place in it: in the middle of chunks, at their closing, at the file's. */
static void
a_disk_full_at_any_byte_leaves_no_file(void **state)
{
    (void)state;
    ss_signal *signal = new_signal(30000);
    ss_coefficients *c;
    ss_morlet_opts opts = ss_morlet_defaults;
    struct rlimit old, small;
    struct stat st;
    opts.voices = 1;
    assert_int_equal(ss_morlet_transform(&c, signal, 1, &opts, NULL), SS_OK);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    for (int known = 0; known < 2; known++) {
        assert_int_equal(write_pieces(signal, c, known, NULL), SS_OK);
        assert_int_equal(stat(path, &st), 0);
        for (off_t limit = 0; limit < st.st_size; limit += st.st_size / 25) {
            ss_error err = { "" };
            small = old;
            small.rlim_cur = (rlim_t)limit;
            assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
            seed = 7;                   /* the same pieces */
            ss_status status = write_pieces(signal, c, known, &err);
            assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
            assert_int_equal(status, SS_EIO);
            assert_non_null(strstr(err.text, strerror(EFBIG)));
            assert_int_equal(access(path, F_OK), -1);
            assert_int_equal(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
        }
    }
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

static void
a_device_gets_a_copy(void **state)
{
    ss_error err = { "" };
    (void)state;
    ss_signal *signal = new_signal(50);
    assert_int_equal(ss_store_write("/dev/null", &(ss_record){ .signal = signal }, &err), SS_OK);
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(ss_store_write("/dev/full", &(ss_record){ .signal = signal }, &err),
                         SS_EIO);
        assert_string_equal(err.text, "/dev/full: No space left on device");
        assert_int_equal(access("/dev/full", F_OK), 0);
    }
    ss_signal_free(signal);
}

static void
a_target_that_cannot_be_opened_says_why(void **state)
{
    ss_error err = { "" };
    (void)state;
    assert_int_equal(ss_store_write("/nonexistent/run.h5", &(ss_record){ .has_events = 1 }, &err),
                     SS_EIO);
    assert_string_equal(err.text, "/nonexistent/run.h5: No such file or directory");
}

static herr_t
count_reports(hid_t stack, void *user)
{
    (void)stack;
    ++*(int *)user;
    return 0;
}

static void
hdf5_reports_nothing_and_is_left_as_it_was(void **state)
{
    int reports = 0;
    void *user = NULL;
    ss_signal *signal = NULL;
    H5E_auto2_t old, now;
    void *old_user;
    (void)state;
    H5Eget_auto2(H5E_DEFAULT, &old, &old_user);
    H5Eset_auto2(H5E_DEFAULT, count_reports, &reports);
    assert_int_equal(ss_store_read_signal(&signal, "/dev/null", NULL, NULL, NULL), SS_EDATA);
    assert_int_equal(ss_store_write("/nonexistent/run.h5", &(ss_record){ .has_events = 1 }, NULL),
                     SS_EIO);
    assert_int_equal(reports, 0);
    H5Eget_auto2(H5E_DEFAULT, &now, &user);
    assert_true(now == count_reports && user == &reports);
    H5Eset_auto2(H5E_DEFAULT, old, old_user);
}

/* --- files of others ----------------------------------------------------------------------- */

/* A file with a user block of the given size, holding arrays of every sort. */
static void
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

static void
arrays_of_others_are_read_by_their_path(void **state)
{
    static const struct { const char *path; size_t rows, columns; double values[6]; } row[] = {
        { "/tall", 3, 2, { 1, 3, 5, 2, 4, 6 } },
        { "/wide", 3, 2, { 1, 2, 3, 4, 5, 6 } },
        { "/line", 6, 1, { 1, 2, 3, 4, 5, 6 } },
    };
    ss_read_opts opts = { .rate = 50 };
    (void)state;
    for (hsize_t block = 0; block <= 1024; block = block > 0 ? 2 * block : 512) {
        write_foreign(block);
        assert_true(ss_store_is_hdf5(path));
        for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
            ss_signal *signal = NULL;
            ss_error err = { "" };
            char where[128];
            snprintf(where, sizeof where, "%s:%s", path, row[i].path);
            if (ss_signal_load(&signal, where, &opts, &err) != SS_OK)
                fail_msg("%s", err.text);
            assert_int_equal(signal->n, row[i].rows);
            assert_int_equal(signal->head->n_columns, row[i].columns);
            assert_true(signal->head->rate == 50);
            assert_same_bits(signal->values, row[i].values, 6);
            assert_string_equal(signal->head->column[row[i].columns - 1].name,
                                i == 0 ? "tall2" : i == 1 ? "wide2" : "line");
            ss_signal_free(signal);
        }
    }
}

static void
a_dataset_of_our_own_brings_its_clock(void **state)
{
    ss_signal *signal = new_signal(10), *back = NULL;
    (void)state;
    write_ok(&(ss_record){ .signal = signal });
    assert_int_equal(ss_store_read_signal(&back, path, "/signal/a", NULL, NULL), SS_OK);
    assert_same_bits(&back->head->rate, &signal->head->rate, 1);
    assert_same_bits(&back->head->start, &signal->head->start, 1);
    assert_string_equal(back->head->column[0].unit, "m/s^2");
    ss_signal_free(back);
    ss_signal_free(signal);
}

static void
what_cannot_be_read_is_refused_in_clear_words(void **state)
{
    static const struct { const char *dataset, *words; } row[] = {
        { "", "no /signal in it; choose one as %s:/PATH from /line /tall /wide" },
        { "/line", "has no clock" },
        { "/cube", "has more than two dimensions" },
        { "/word", "holds text, not numbers" },
        { "/complex", "holds complex numbers; a signal is real" },
        { "/huge", "has more values than can be read at once" },
        { "/nothing", "no such dataset" },
        { "/", "no such dataset" },
    };
    (void)state;
    write_foreign(0);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char words[256], expected[512];
        ss_signal *signal = NULL;
        ss_error err = { "" };
        snprintf(words, sizeof words, row[i].words, path);
        snprintf(expected, sizeof expected, "%s%s%s: %s", path, i > 0 ? ":" : "", row[i].dataset,
                 words);
        assert_int_equal(ss_store_read_signal(&signal, path, row[i].dataset, NULL, &err),
                         strcmp(row[i].dataset, "/line") == 0 ? SS_ECLOCK : SS_EDATA);
        assert_null(signal);
        assert_string_equal(err.text, expected);
    }
}

static void
a_file_without_coefficients_says_so(void **state)
{
    ss_coefficients *c = NULL;
    ss_error err = { "" };
    (void)state;
    write_foreign(0);
    assert_int_equal(ss_store_read_coefficients(&c, path, &err), SS_EKIND);
    assert_non_null(strstr(err.text, "no /wavelet"));
}

/* Every prefix of a file must be refused or read, never crash. */
static void
a_truncated_file_is_refused(void **state)
{
    ss_signal *signal = new_signal(100);
    ss_coefficients *c = transform(signal, 0);
    size_t size;
    (void)state;
    write_ok(&(ss_record){ .signal = signal, .coefficients = c });
    char *bytes = read_bytes(&size);
    for (size_t cut = 0; cut < size; cut += 997) {
        ss_coefficients *back = NULL;
        ss_error err = { "" };
        assert_int_equal(truncate(path, (off_t)(size - 1 - cut)), 0);
        assert_int_not_equal(ss_store_read_coefficients(&back, path, &err), SS_OK);
        assert_null(back);
        assert_non_null(strstr(err.text, path));
    }
    free(bytes);
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

/* Each bit in turn of every 61st byte is another; HDF5 keeps checksums of some parts only. */
static void
flipped_bits_are_refused_or_harmless(void **state)
{
    ss_signal *signal = new_signal(50);
    ss_coefficients *c = transform(signal, 0);
    unsigned char bytes[100000];
    (void)state;
    write_ok(&(ss_record){ .signal = signal, .coefficients = c });
    FILE *out = fopen(path, "rb+");
    size_t size = fread(bytes, 1, sizeof bytes, out);
    assert_true(feof(out));
    fclose(out);
    for (size_t i = 0; i < size; i += 61) {
        ss_signal *read = NULL;
        ss_coefficients *back = NULL;
        ss_error err = { "" };
        bytes[i] ^= (unsigned char)(1u << i / 61 % 8);
        out = fopen(path, "wb");
        assert_int_equal(fwrite(bytes, 1, size, out), size);
        fclose(out);
        if (ss_store_read_signal(&read, path, NULL, NULL, &err) != SS_OK)
            assert_true(read == NULL && err.text[0] != '\0');
        if (ss_store_read_coefficients(&back, path, &err) != SS_OK)
            assert_true(back == NULL && err.text[0] != '\0');
        /* what HDF5 says at exit, "infinite loop closing library", is of memory of its own */
        assert_int_equal(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
        ss_signal_free(read);
        ss_coefficients_free(back);
        bytes[i] ^= (unsigned char)(1u << i / 61 % 8);
    }
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

/* What LeakSanitizer asks for: HDF5 keeps memory of its own after a damaged file ("infinite loop closing
 * library").  That nothing of ours is left open in it is tested above. */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *
__lsan_default_suppressions(void)
{
    return "leak:libhdf5";
}

/* A one-dimensional dataset of n values. */
static void
put_array(hid_t file, const char *name, hid_t type, hsize_t n, hid_t how)
{
    const hsize_t most = how != H5P_DEFAULT && H5Pget_layout(how) == H5D_CHUNKED ? H5S_UNLIMITED : n;
    hid_t space = H5Screate_simple(1, &n, &most);
    hid_t id = H5Dcreate2(file, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    assert_true(id >= 0);
    H5Dclose(id);
    H5Sclose(space);
}

/* A file that leads to another, which is there, or claims what it does not hold. */
static void
write_hostile(const char *other)
{
    hsize_t chunk = 1000, huge_chunk = (hsize_t)1 << 28, n = 6;
    hid_t space = H5Screate_simple(1, &n, NULL), wide = H5Tcopy(H5T_STD_I32LE);
    hid_t how = H5Pcreate(H5P_DATASET_CREATE), raw = H5Pcreate(H5P_DATASET_CREATE);
    hid_t virtual = H5Pcreate(H5P_DATASET_CREATE), large = H5Pcreate(H5P_DATASET_CREATE);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external(other, "/line", file, "external", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external(other, "/", file, "signal", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external(other, "/", file, "wavelet", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/loop", file, "loop", H5P_DEFAULT, H5P_DEFAULT);
    H5Pset_external(raw, other, 0, 6);
    H5Pset_virtual(virtual, space, other, "/line", space);
    H5Pset_chunk(how, 1, &chunk);
    H5Pset_chunk(large, 1, &huge_chunk);
    H5Tset_size(wide, 64);
    H5Tset_precision(wide, 512);                /* all of it: HDF5 1.14.5 makes no others */
    put_array(file, "raw", H5T_STD_I8LE, 6, raw);
    put_array(file, "virtual", H5T_STD_I16BE, 6, virtual);
    put_array(file, "claims", H5T_IEEE_F64LE, 900000000, how);
    put_array(file, "chunk", H5T_IEEE_F64LE, 6, large);
    put_array(file, "wide", wide, 6, H5P_DEFAULT);
    H5Fclose(file);
    H5Pclose(how);
    H5Pclose(raw);
    H5Pclose(virtual);
    H5Pclose(large);
    H5Tclose(wide);
    H5Sclose(space);
}

static void
nothing_leads_out_of_a_file_or_claims_more_than_it_holds(void **state)
{
    static const struct { const char *dataset, *words; } row[] = {
        { "", ":/signal: not a group of this file" },
        { "/external", ":/external: no such dataset" },
        { "/loop", ":/loop: no such dataset" },
        { "/raw", ":/raw: its values lie outside this file" },
        { "/virtual", ":/virtual: its values lie outside this file" },
        { "/claims", ":/claims: claims more values than a file of this size can hold" },
        { "/chunk", ":/chunk: claims more values than a file of this size can hold" },
        { "/wide", ":/wide: does not hold real numbers" },
    };
    static const ss_read_opts opts = { .rate = 1 };
    char other[80];
    ss_coefficients *c = NULL;
    ss_error err = { "" };
    (void)state;
    write_foreign(0);
    snprintf(other, sizeof other, "%s.other", path);
    assert_int_equal(rename(path, other), 0);
    write_hostile(other);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *signal = NULL;
        assert_int_equal(ss_store_read_signal(&signal, path, row[i].dataset, &opts, &err), SS_EDATA);
        assert_null(signal);
        assert_string_equal(err.text + strlen(path), row[i].words);
    }
    assert_int_equal(ss_store_read_coefficients(&c, path, &err), SS_EDATA);
    assert_string_equal(err.text + strlen(path), ":/wavelet: not a group of this file");
    unlink(other);
}

/* A /signal of n values at 1 kHz, with a column t of no storage, tracked in the order of writing but
 * without an index of it. */
static hid_t
open_signal_without_values(hid_t file, hsize_t n)
{
    const double one = 1;
    static const char *const name[] = { "rate", "start", "has_time" };
    hid_t how = H5Pcreate(H5P_GROUP_CREATE), scalar = H5Screate(H5S_SCALAR);
    H5Pset_link_creation_order(how, H5P_CRT_ORDER_TRACKED);
    hid_t group = H5Gcreate2(file, "signal", H5P_DEFAULT, how, H5P_DEFAULT);
    for (size_t i = 0; i < 3; i++) {
        hid_t id = H5Acreate2(group, name[i], H5T_NATIVE_DOUBLE, scalar, H5P_DEFAULT, H5P_DEFAULT);
        H5Awrite(id, H5T_NATIVE_DOUBLE, &one);
        H5Aclose(id);
    }
    hid_t space = H5Screate_simple(1, &n, NULL);
    hid_t id = H5Dcreate2(group, "t", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dclose(id);
    H5Sclose(space);
    H5Sclose(scalar);
    H5Pclose(how);
    return group;
}

static void
hard_links_do_not_multiply_what_a_file_may_claim(void **state)
{
    ss_signal *signal = NULL;
    ss_error err = { "" };
    char name[32];
    struct stat st;
    (void)state;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t group = open_signal_without_values(file, 1 << 24);
    for (int i = 0; i < 12; i++) {
        snprintf(name, sizeof name, "x%d", i);
        H5Lcreate_hard(group, "t", group, name, H5P_DEFAULT, H5P_DEFAULT);
    }
    H5Gclose(group);
    H5Fclose(file);
    assert_int_equal(stat(path, &st), 0);
    assert_true(st.st_size < 10000);
    assert_int_equal(ss_store_read_signal(&signal, path, NULL, NULL, &err), SS_EDATA);
    assert_null(signal);
    assert_string_equal(err.text + strlen(path), ":/signal/x1: with those before, claims more values "
                        "than a file of this size can hold");
}

/* In the order of writing, in a time that grows as their number does: one by one it were minutes. */
static void
many_columns_without_an_index_are_listed_at_once(void **state)
{
    enum { COLUMNS = 20000 };
    ss_signal *signal = NULL;
    char name[32];
    (void)state;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t group = open_signal_without_values(file, 3);
    for (int i = COLUMNS; i > 0; i--) {
        snprintf(name, sizeof name, "x%d", i);
        H5Lcreate_hard(group, "t", group, name, H5P_DEFAULT, H5P_DEFAULT);
    }
    H5Gclose(group);
    H5Fclose(file);
    alarm(60);                          /* 4 s; with sanitizers more */
    assert_int_equal(ss_store_read_signal(&signal, path, NULL, NULL, NULL), SS_OK);
    alarm(0);
    assert_int_equal(signal->head->n_columns, COLUMNS);
    assert_string_equal(signal->head->column[0].name, "x20000");
    assert_string_equal(signal->head->column[COLUMNS - 1].name, "x1");
    ss_signal_free(signal);
}

/* HDF5 opens the sources of a virtual dataset when it is asked for an extent without limit: a FIFO
 * that no one writes to would hold it for ever. */
static void
the_sources_of_a_virtual_dataset_are_not_opened(void **state)
{
    const hsize_t none = 0, one = 1, all = H5S_UNLIMITED;
    static const ss_read_opts opts = { .rate = 1 };
    char fifo[80];
    ss_signal *signal = NULL;
    ss_error err = { "" };
    (void)state;
    snprintf(fifo, sizeof fifo, "%s.fifo", path);
    assert_int_equal(mkfifo(fifo, 0600), 0);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t space = H5Screate_simple(1, &one, &all), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &none, NULL, &all, &one);
    H5Pset_virtual(how, space, fifo, "/x", space);
    H5Dclose(H5Dcreate2(file, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT));
    H5Pclose(how);
    H5Sclose(space);
    H5Fclose(file);
    alarm(20);
    for (int named = 0; named < 2; named++)
        assert_int_equal(ss_store_read_signal(&signal, path, named ? "/x" : NULL, &opts, &err), SS_EDATA);
    alarm(0);
    assert_string_equal(err.text + strlen(path), ":/x: its values lie outside this file");
    unlink(fifo);
}

/* A dataset of one chunk of zeros through these filters; 0 ends them. */
static void
write_filtered(const H5Z_filter_t filter[])
{
    static const double zeros[1000];
    const hsize_t n = 1000;
    const unsigned level = 9;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t space = H5Screate_simple(1, &n, NULL), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(how, 1, &n);
    for (int i = 0; filter[i] != 0; i++)
        assert_true(H5Pset_filter(how, filter[i], H5Z_FLAG_OPTIONAL, filter[i] < 256, &level) >= 0);
    hid_t id = H5Dcreate2(file, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
    assert_true(H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros) >= 0);
    H5Dclose(id);
    H5Pclose(how);
    H5Sclose(space);
    H5Fclose(file);
}

static void
only_filters_that_bound_what_they_make_are_run(void **state)
{
    static const ss_read_opts opts = { .rate = 1 };
    static const H5Z_filter_t plain[] = { H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32, 0 },
        twice[] = { H5Z_FILTER_DEFLATE, H5Z_FILTER_DEFLATE, 0 }, other[] = { 32001, 0 };
    ss_signal *signal = NULL;
    ss_error err = { "" };
    unsigned before, after;
    (void)state;
    H5PLget_loading_state(&before);
    write_filtered(plain);
    assert_int_equal(ss_store_read_signal(&signal, path, "/x", &opts, &err), SS_OK);
    ss_signal_free(signal);
    for (int i = 0; i < 2; i++) {
        H5E_BEGIN_TRY {
            write_filtered(i == 0 ? twice : other);
        } H5E_END_TRY
        assert_int_equal(ss_store_read_signal(&signal, path, "/x", &opts, &err), SS_EDATA);
        assert_string_equal(err.text + strlen(path), ":/x: is packed otherwise than by deflate, once; "
                            "h5repack -f GZIP=1 makes it so");
    }
    H5PLget_loading_state(&after);
    assert_int_equal(after, before);
}

/* Give an object of the file another number as an attribute, as anyone might. */
static void
put_attribute(const char *object, const char *name, double value)
{
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), id = H5Oopen(file, object, H5P_DEFAULT);
    hid_t space = H5Screate(H5S_SCALAR);
    if (H5Aexists(id, name) > 0)
        H5Adelete(id, name);
    hid_t a = H5Acreate2(id, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(a, H5T_NATIVE_DOUBLE, &value) >= 0);
    H5Aclose(a);
    H5Sclose(space);
    H5Oclose(id);
    H5Fclose(file);
}

/* Put a 1-D dataset of n zeros in the place of one. */
static void
put_zeros(const char *dataset, hsize_t n)
{
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), space = H5Screate_simple(1, &n, NULL);
    H5Ldelete(file, dataset, H5P_DEFAULT);
    hid_t id = H5Dcreate2(file, dataset, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(id >= 0);
    H5Dclose(id);
    H5Sclose(space);
    H5Fclose(file);
}

static void
assert_refused(const char *words)
{
    ss_coefficients *c = NULL;
    ss_error err = { "" };
    assert_int_equal(ss_store_read_coefficients(&c, path, &err), SS_EDATA);
    assert_null(c);
    if (strstr(err.text, words) == NULL)
        fail_msg("'%s' does not say '%s'", err.text, words);
}

static void
a_grid_that_is_not_one_is_refused(void **state)
{
    static const struct { const char *object, *name; double value; const char *words; } row[] = {
        { "/wavelet", "scales", 0, ":/wavelet: attribute 'scales' is missing or out of range" },
        { "/wavelet", "samples", 0, "attribute 'samples'" },
        { "/wavelet", "samples", 400, ":/wavelet/scale000: the translations are not those" },
        { "/wavelet", "rate", 0, "attribute 'rate'" },
        { "/wavelet", "rate", -1, "attribute 'rate'" },
        { "/wavelet", "rate", NAN, "attribute 'rate'" },
        { "/wavelet", "rate", INFINITY, "attribute 'rate'" },
        { "/wavelet", "rate", 1e200, "attribute 'rate'" },
        { "/wavelet", "center", 7, "do not agree" },
        { "/wavelet/scale001", "frequency", 1, ":/wavelet/scale001: scale, m and frequency do not" },
        { "/wavelet/scale001", "scale", INFINITY, "attribute 'scale'" },
        { "/wavelet/scale001", "m", 3, "do not agree" },
        { "/wavelet/scale001", "b_num", 1e-9, "the translations are not those" },
        { "/wavelet/scale001", "b_den", 1e9, "the translations are not those" },
        { "/wavelet/scale001", "b_den", NAN, "attribute 'b_den'" },
    };
    ss_signal *signal = new_signal(500);
    ss_coefficients *c = transform(signal, 0);
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        write_ok(&(ss_record){ .coefficients = c });
        put_attribute(row[i].object, row[i].name, row[i].value);
        assert_refused(row[i].words);
    }
    write_ok(&(ss_record){ .coefficients = c });
    put_zeros("/wavelet/scale001/re", 0);
    put_zeros("/wavelet/scale001/im", 0);
    assert_refused(":/wavelet/scale001: the translations are not those");
    ss_scale first = c->scale[0];
    c->scale[0] = c->scale[1];                          /* the same scale twice */
    write_ok(&(ss_record){ .coefficients = c });
    assert_refused("the scales do not descend");
    c->scale[0] = first;
    ss_coefficients_free(c);
    c = transform(signal, 1);
    write_ok(&(ss_record){ .coefficients = c });
    put_attribute("/wavelet", "b_num", 2);
    assert_refused("the translations are not those");
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

static void
a_clock_of_its_own_is_not_exchanged(void **state)
{
    static const ss_read_opts other = { .rate = 5 }, column = { .time = "a" };
    ss_signal *signal = new_signal(10), *back = NULL;
    const ss_read_opts same = { .rate = signal->head->rate };
    ss_error err = { "" };
    (void)state;
    write_ok(&(ss_record){ .signal = signal });
    assert_int_equal(ss_store_read_signal(&back, path, NULL, &other, &err), SS_EDATA);
    assert_non_null(strstr(err.text, "has a clock of its own"));
    assert_int_equal(ss_store_read_signal(&back, path, NULL, &column, NULL), SS_EDATA);
    assert_int_equal(ss_store_read_signal(&back, path, "/signal/a", &column, &err), SS_EDATA);
    assert_non_null(strstr(err.text, "has no column of time to choose"));
    assert_null(back);
    assert_int_equal(ss_store_read_signal(&back, path, NULL, &same, NULL), SS_OK);
    ss_signal_free(back);
    ss_signal_free(signal);
}

static void
attributes_that_are_no_notes_are_skipped(void **state)
{
    static const char *const name[] = { "rate", "start", "columns", "a:b" };
    ss_signal *signal = new_signal(10), *back = NULL;
    (void)state;
    write_ok(&(ss_record){ .signal = signal });
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), space = H5Screate(H5S_SCALAR);
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        hid_t a = H5Acreate2(file, name[i], H5T_C_S1, space, H5P_DEFAULT, H5P_DEFAULT);
        assert_true(H5Awrite(a, H5T_C_S1, "5") >= 0);
        H5Aclose(a);
    }
    H5Sclose(space);
    H5Fclose(file);
    assert_int_equal(ss_store_read_signal(&back, path, NULL, NULL, NULL), SS_OK);
    assert_same_notes(signal->head, back->head);
    ss_signal_free(back);
    ss_signal_free(signal);
}

static void
a_missing_signal_is_told_from_a_damaged_one(void **state)
{
    ss_signal *signal = new_signal(10), *back = NULL;
    (void)state;
    write_foreign(0);
    assert_false(ss_store_has_signal(path));
    assert_false(ss_store_has_signal("/dev/null"));
    write_ok(&(ss_record){ .signal = signal });
    put_attribute("/signal", "rate", 0);
    assert_true(ss_store_has_signal(path));
    assert_int_equal(ss_store_read_signal(&back, path, NULL, NULL, NULL), SS_EDATA);
    ss_signal_free(signal);
}

static void
a_fifo_keeps_its_first_bytes(void **state)
{
    char fifo[80];
    (void)state;
    snprintf(fifo, sizeof fifo, "%s/fifo", dir);
    assert_int_equal(mkfifo(fifo, 0600), 0);
    assert_false(ss_store_is_hdf5(fifo));               /* and does not wait for a writer */
    unlink(fifo);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_signal_reads_back_exactly),
        cmocka_unit_test(coefficients_read_back_exactly),
        cmocka_unit_test(a_file_made_piece_by_piece_reads_back_exactly),
        cmocka_unit_test(scales_can_be_read_one_by_one),
        cmocka_unit_test(edges_and_times_are_those_of_the_whole),
        cmocka_unit_test(a_file_that_is_not_brought_to_its_end_is_no_file),
        cmocka_unit_test(events_are_stored_with_their_kinds_as_words),
        cmocka_unit_test(no_events_are_an_empty_group_only_where_asked_for),
        cmocka_unit_test(the_same_record_gives_the_same_bytes_a_second_later),
        cmocka_unit_test(only_large_datasets_are_compressed),
        cmocka_unit_test(a_write_that_fails_says_why_and_leaves_no_file),
        cmocka_unit_test(a_disk_full_at_any_byte_leaves_no_file),
        cmocka_unit_test(a_device_gets_a_copy),
        cmocka_unit_test(a_target_that_cannot_be_opened_says_why),
        cmocka_unit_test(hdf5_reports_nothing_and_is_left_as_it_was),
        cmocka_unit_test(arrays_of_others_are_read_by_their_path),
        cmocka_unit_test(a_dataset_of_our_own_brings_its_clock),
        cmocka_unit_test(what_cannot_be_read_is_refused_in_clear_words),
        cmocka_unit_test(a_file_without_coefficients_says_so),
        cmocka_unit_test(a_truncated_file_is_refused),
        cmocka_unit_test(flipped_bits_are_refused_or_harmless),
        cmocka_unit_test(nothing_leads_out_of_a_file_or_claims_more_than_it_holds),
        cmocka_unit_test(hard_links_do_not_multiply_what_a_file_may_claim),
        cmocka_unit_test(many_columns_without_an_index_are_listed_at_once),
        cmocka_unit_test(the_sources_of_a_virtual_dataset_are_not_opened),
        cmocka_unit_test(only_filters_that_bound_what_they_make_are_run),
        cmocka_unit_test(a_grid_that_is_not_one_is_refused),
        cmocka_unit_test(a_clock_of_its_own_is_not_exchanged),
        cmocka_unit_test(attributes_that_are_no_notes_are_skipped),
        cmocka_unit_test(a_missing_signal_is_told_from_a_damaged_one),
        cmocka_unit_test(a_fifo_keeps_its_first_bytes),
    };
    return cmocka_run_group_tests_name("store", tests, make_dir, remove_dir);
}
