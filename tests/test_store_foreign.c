/* test_store_foreign.c -- what others wrote is read, or refused in clear words. */
#include "store_file.h"
#include "io/format.h"
#include "read_opts.h"

static void
arrays_of_others_are_read_by_their_path(void **state)
{
    static const struct { const char *path; size_t rows, columns; double values[6]; } row[] = {
        { "/tall", 3, 2, { 1, 3, 5, 2, 4, 6 } },
        { "/wide", 3, 2, { 1, 2, 3, 4, 5, 6 } },
        { "/line", 6, 1, { 1, 2, 3, 4, 5, 6 } },
    };
    ss_read_opts opts = { READ_OPTS, .rate = 50 };
    (void)state;
    for (hsize_t block = 0; block <= 1024; block = block > 0 ? 2 * block : 512) {
        write_foreign(block);
        for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
            ss_signal *signal = NULL;
            ss_error err = { 0 };
            char where[128];
            snprintf(where, sizeof where, "%s:%s", path, row[i].path);
            if (ss_signal_read(&signal, NULL, where, &opts, &err) != SS_OK)
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

/* Value c of row i. */
static double
value_at(size_t i, size_t c)
{
    return ldexp((double)(i * 7919 % 10007), -3) - (double)c;
}

/* An array of rows x columns of 32-bit floats, rows along the dimension `along`, in chunks of these rows
 * and columns (0: not in chunks). */
static void
write_array(size_t rows, size_t columns, int along, hsize_t chunk_rows, hsize_t chunk_columns)
{
    hsize_t dims[2], chunk[2];
    double *x = malloc(rows * columns * sizeof *x);
    dims[along] = rows;
    dims[1 - along] = columns;
    chunk[along] = chunk_rows;
    chunk[1 - along] = chunk_columns;
    for (size_t i = 0; i < rows; i++)
        for (size_t c = 0; c < columns; c++)
            x[along == 0 ? i * columns + c : c * rows + i] = value_at(i, c);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t space = H5Screate_simple(2, dims, NULL), how = H5Pcreate(H5P_DATASET_CREATE);
    if (chunk_rows > 0) {
        H5Pset_chunk(how, 2, chunk);
        H5Pset_deflate(how, 1);
    }
    hid_t id = H5Dcreate2(file, "x", H5T_IEEE_F32LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
    assert_true(H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x) >= 0);
    H5Dclose(id);
    H5Pclose(how);
    H5Sclose(space);
    H5Fclose(file);
    free(x);
}

/* Rows of the array in portions of any size, from a time on. */
static void
assert_rows(size_t rows, size_t columns, double from)
{
    enum { MOST = 5000 };
    const ss_read_opts opts = { READ_OPTS, .rate = 1, .from = from, .to = from > 0 ? 1e9 : 0 };
    ss_reader *reader = NULL;
    ss_error err = { 0 };
    size_t n, i = (size_t)from;
    double *x[600], *values = malloc(MOST * columns * sizeof *values);
    for (size_t c = 0; c < columns; c++)
        x[c] = values + c * MOST;
    if (ss_reader_new(&reader, NULL, place("/x"), &opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    assert_true(ss_reader_header(reader)->start == from);
    assert_int_equal(ss_reader_waits(reader), 0);
    do {
        assert_int_equal(ss_reader_rows(reader, x, draw(MOST), &n, &err), SS_OK);
        for (size_t k = 0; k < n; k++, i++)
            for (size_t c = 0; c < columns; c++)
                assert_true(x[c][k] == value_at(i, c));
    } while (n > 0);
    assert_int_equal(i, rows);
    ss_reader_free(reader);
    free(values);
}

/* Chunks that divide a piece and that do not, that are longer than one, and that split columns. */
static void
rows_in_pieces_are_those_of_the_array(void **state)
{
    static const struct { size_t rows, columns; hsize_t chunk_rows, chunk_columns; } row[] = {
        { 300001, 3, 0, 0 }, { 300001, 3, 1000, 2 }, { 300001, 3, 200000, 1 }, { 600000, 1, 65536, 1 },
        { 700, 600, 11, 7 }, { 1, 1, 0, 0 },
    };
    const ss_read_opts opts = { READ_OPTS, .rate = 1 }, filled = { READ_OPTS, .rate = 1, .gaps = SS_GAPS_SPLIT };
    (void)state;
    for (size_t r = 0; r < sizeof row / sizeof *row; r++)
        for (int along = 0; along < 2; along++) {
            size_t rows = row[r].rows, columns = row[r].columns;
            ss_signal *all = NULL, *same = NULL;
            write_array(rows, columns, along, row[r].chunk_rows, row[r].chunk_columns);
            assert_rows(rows, columns, 0);
            if (rows > 500)
                assert_rows(rows, columns, 500);
            assert_int_equal(load_place(&all, "/x", &opts, NULL), SS_OK);
            assert_int_equal(all->n, rows);
            for (size_t i = 0; i < rows; i++)
                for (size_t c = 0; c < columns; c++)
                    assert_true(all->values[c * rows + i] == value_at(i, c));
            assert_int_equal(load_place(&same, "/x", &filled, NULL), SS_OK);
            assert_same_bits(same->values, all->values, rows * columns);
            ss_signal_free(all);
            ss_signal_free(same);
        }
}

/* Of a value that is not finite in the third piece, the rows before are there. */
static void
a_bad_value_is_found_where_it_stands(void **state)
{
    const ss_read_opts opts = { READ_OPTS, .rate = 1 }, filled = { READ_OPTS, .rate = 1, .gaps = SS_GAPS_SPLIT };
    const hsize_t at = 600000, one = 1, n = 700000;
    const double bad = NAN;
    ss_reader *reader = NULL;
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    double x[1000], *column = x;
    size_t done = 0, got = 1;
    (void)state;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t space = H5Screate_simple(1, &n, NULL), memory = H5Screate_simple(1, &one, NULL);
    hid_t id = H5Dcreate2(file, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &at, NULL, &one, NULL);
    assert_true(H5Dwrite(id, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &bad) >= 0);
    H5Dclose(id);
    H5Sclose(memory);
    H5Sclose(space);
    H5Fclose(file);
    assert_int_equal(ss_reader_new(&reader, NULL, place("/x"), &opts, &err), SS_OK);
    ss_status st = SS_OK;
    while (got > 0 && (st = ss_reader_rows(reader, &column, 1000, &got, &err)) == SS_OK)
        done += got;
    assert_int_equal(st, SS_EDATA);
    assert_string_equal(err.text + strlen(path), ":/x: value 600001 is not finite");
    assert_true(done > 300000 && done <= 600000);
    ss_reader_free(reader);
    assert_int_equal(load_place(&signal, "/x", &opts, &err), SS_EDATA);
    assert_null(signal);
    assert_int_equal(load_place(&signal, "/x", &filled, &err), SS_OK);
    assert_string_equal(ss_header_find_note(signal->head, "gaps"), "600000:600001");
    ss_signal_free(signal);
}

static void
a_dataset_of_our_own_brings_its_clock(void **state)
{
    ss_signal *signal = new_signal(10), *back = NULL;
    (void)state;
    write_ok(&(ss_record){ .signal = signal });
    assert_int_equal(load_place(&back, "/signal/a", NULL, NULL), SS_OK);
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
        { "/line/", "no such dataset" },
        { "/", "a group, not a dataset" },
    };
    (void)state;
    write_foreign(0);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char words[256], expected[512];
        ss_signal *signal = NULL;
        ss_error err = { 0 };
        snprintf(words, sizeof words, row[i].words, path);
        snprintf(expected, sizeof expected, "%s%s%s: %s", path, i > 0 ? ":" : "", row[i].dataset,
                 words);
        assert_int_equal(load_place(&signal, row[i].dataset, NULL, &err),
                         i == 0 ? SS_EKIND : strcmp(row[i].dataset, "/line") == 0 ? SS_ECLOCK : SS_EDATA);
        assert_null(signal);
        assert_string_equal(err.text, expected);
    }
}

static void
a_file_without_coefficients_says_so(void **state)
{
    ss_coefficients *c = NULL;
    ss_error err = { 0 };
    (void)state;
    write_foreign(0);
    assert_int_equal(read_map(&c, path, &err), SS_EKIND);
    assert_non_null(strstr(err.text, "no /wavelet"));
}

static void
a_clock_of_its_own_is_not_exchanged(void **state)
{
    static const ss_read_opts other = { READ_OPTS, .rate = 5 }, column = { READ_OPTS, .time = "none" };
    ss_signal *signal = new_signal(10), *back = NULL;
    const ss_read_opts same = { READ_OPTS, .rate = signal->head->rate };
    ss_error err = { 0 };
    (void)state;
    write_ok(&(ss_record){ .signal = signal });
    assert_int_equal(ss_signal_read(&back, NULL, path, &other, &err), SS_EDATA);
    assert_non_null(strstr(err.text, "has a clock of its own"));
    assert_int_equal(ss_signal_read(&back, NULL, path, &column, NULL), SS_EDATA);
    assert_int_equal(load_place(&back, "/signal/a", &column, &err), SS_EDATA);
    assert_non_null(strstr(err.text, ":/signal/none: no such dataset"));
    assert_null(back);
    assert_int_equal(ss_signal_read(&back, NULL, path, &same, NULL), SS_OK);
    ss_signal_free(back);
    ss_signal_free(signal);
}

/* Time stamps would all be 1e17. */
static void
a_start_too_late_for_its_rate_is_refused(void **state)
{
    static const char *const dataset[] = { NULL, "/signal/a" };
    ss_signal *signal = new_signal(10), *back = NULL;
    (void)state;
    write_ok(&(ss_record){ .signal = signal });
    put_attribute("/signal", "start", 1e17);
    for (size_t i = 0; i < 2; i++) {
        ss_error err = { 0 };
        assert_int_equal(load_place(&back, dataset[i], NULL, &err), SS_EDATA);
        assert_non_null(strstr(err.text, "starts at 1e+17 s has equal time stamps"));
    }
    signal->head->start = 1e13;                 /* only twice the rate is too much */
    write_ok(&(ss_record){ .signal = signal });
    ss_signal *other = NULL;
    const ss_read_opts twice = { READ_OPTS, .resample = 2 * signal->head->rate };
    assert_int_equal(ss_signal_read(&other, NULL, path, NULL, NULL), SS_OK);
    ss_signal_free(other);
    other = NULL;
    assert_int_equal(ss_signal_read(&other, NULL, path, &twice, NULL), SS_EDATA);
    assert_null(back);
    assert_null(other);
    ss_signal_free(signal);
}

/* Write n numbers as an array of one column, which MATLAB stores as a row. */
static void
put_column(hid_t group, const char *name, const double *x, hsize_t n, int in_row, hsize_t chunk)
{
    const hsize_t dims[2] = { in_row ? 1 : n, in_row ? n : 1 }, chunks[2] = { in_row ? 1 : chunk, in_row ? chunk : 1 };
    hid_t space = H5Screate_simple(in_row ? 2 : 1, dims, NULL), how = H5Pcreate(H5P_DATASET_CREATE);
    if (chunk > 0) {
        H5Pset_chunk(how, in_row ? 2 : 1, chunks);
        H5Pset_deflate(how, 1);
    }
    hid_t id = H5Dcreate2(group, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
    assert_true(H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x) >= 0);
    H5Dclose(id);
    H5Pclose(how);
    H5Sclose(space);
}

/* A file of x, n values, in /daq/ch0, and of their times: milliseconds there, seconds in /t; and of others. */
static void
write_times(size_t n, int in_row, hsize_t chunk, hsize_t chunk_of_times)
{
    double *t = malloc(2 * n * sizeof *t), *other = t + n;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t daq = H5Gcreate2(file, "daq", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    hid_t ch0 = H5Gcreate2(daq, "ch0", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    for (size_t i = 0; i < n; i++) {
        t[i] = 7 + (double)i / 800;
        other[i] = value_at(i, 0);
    }
    put_column(ch0, "x", other, n, in_row, chunk);
    put_column(file, "t", t, n, in_row, chunk_of_times);
    put_column(file, "short", t, n - 1, in_row, 0);
    for (size_t i = 0; i < n; i++)
        other[i] = 738000.25 + t[i] / 86400;
    put_column(file, "serial", other, n, in_row, 0);
    for (size_t i = 0; i < n; i++)
        other[i] = t[i] + (i > n / 2 ? 3. / 800 : 0);
    put_column(file, "gap", other, n, in_row, 0);
    for (size_t i = 0; i < n; i++)
        other[i] = t[i] + (i == 50 ? 4e-4 : 0);
    put_column(file, "uneven", other, n, in_row, 0);
    for (size_t i = 0; i < n; i++)
        other[i] = i == 5 ? NAN : t[i];
    put_column(file, "nan", other, n, in_row, 0);
    for (size_t i = 0; i < n; i++)
        other[i] = 1000 * t[i];
    put_column(ch0, "time", other, n, in_row, chunk_of_times);
    hid_t type = H5Tcopy(H5T_C_S1), id = H5Dopen2(ch0, "time", H5P_DEFAULT);
    H5Tset_size(type, 40);
    put_scalar(id, "units", type, "milliseconds since 2024-03-05 10:12:13\0\0");
    H5Dclose(id);
    H5Tclose(type);
    H5Gclose(ch0);
    H5Gclose(daq);
    H5Fclose(file);
    free(t);
}

static void
assert_timed(const char *time, const char *unit, size_t n, double start)
{
    const ss_read_opts opts = { READ_OPTS, .time = time, .time_unit = unit };
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    if (load_place(&signal, "/daq/ch0/x", &opts, &err) != SS_OK)
        fail_msg("%s: %s", time, err.text);
    assert_true(signal->head->rate == 800);
    assert_true(fabs(signal->head->start - start) <= 1e-5);
    assert_int_equal(signal->head->n_columns, 1);
    assert_string_equal(signal->head->column[0].name, "x");
    assert_int_equal(signal->n, n);
    for (size_t i = 0; i < n; i++)
        assert_true(signal->values[i] == value_at(i, 0));
    ss_signal_free(signal);
}

/* In memory and in a temporary file; with chunks that do not divide each other. */
static void
times_of_a_dataset_give_the_clock(void **state)
{
    static const struct { size_t n; int in_row; hsize_t chunk, chunk_of_times; } row[] = {
        { 2, 0, 0, 0 }, { 1000, 0, 0, 0 }, { 1000, 1, 0, 0 }, { 1000, 1, 7, 11 }, { 400000, 0, 1000, 300000 },
        { 400000, 1, 300000, 1000 },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        write_times(row[i].n, row[i].in_row, row[i].chunk, row[i].chunk_of_times);
        assert_timed("/t", NULL, row[i].n, 7);
        assert_timed("/daq/ch0/time", NULL, row[i].n, 7);
        assert_timed("time", NULL, row[i].n, 7);
        if (row[i].n > 2)
            assert_timed("/serial", "d", row[i].n, 21607);
    }
}

static void
times_of_a_dataset_are_checked_as_those_of_text(void **state)
{
    static const struct { ss_read_opts opts; ss_status status; size_t n; const char *words; } row[] = {
        { { READ_OPTS, .time = "/none" }, SS_EDATA, 0, ":/none: no such dataset" },
        { { READ_OPTS, .time = "none" }, SS_EDATA, 0, ":/daq/ch0/none: no such dataset" },
        { { READ_OPTS, .time = "/daq" }, SS_EDATA, 0, ":/daq: no such dataset" },
        { { READ_OPTS, .time = "/short" }, SS_EDATA, 0, ":/short: not one time for each row of the signal" },
        { { READ_OPTS, .time = "/uneven" }, SS_EUNEVEN, 0, "time stamps are not uniform" },
        { { READ_OPTS, .time = "/gap" }, SS_EGAPS, 0, ":/daq/ch0/x:52: 3 samples are missing before this time stamp" },
        { { READ_OPTS, .time = "/nan" }, SS_EGAPS, 0, "row 6, column nan: not a finite number" },
        { { READ_OPTS, .time = "/serial" }, SS_EUNIT, 0, "looks like days, 800 Hz from day 738000.25 on" },
        { { READ_OPTS, .time = "x" }, SS_ECLOCK, 0, "time stamps do not ascend" },
        { { READ_OPTS, .time = "/gap", .gaps = SS_GAPS_SPLIT }, SS_OK, 103, "" },
        { { READ_OPTS, .time = "/nan", .gaps = SS_GAPS_INTERPOLATE }, SS_OK, 100, "" },
        { { READ_OPTS, .time = "/uneven", .resample = 400 }, SS_OK, 50, "" },
        { { READ_OPTS, .time = "/t", .from = 7.05, .to = 7.1 }, SS_OK, 40, "" },
    };
    (void)state;
    write_times(100, 1, 0, 0);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *signal = NULL;
        ss_error err = { 0 };
        ss_status st = load_place(&signal, "/daq/ch0/x", &row[i].opts, &err);
        if (st != row[i].status || strstr(err.text, row[i].words) == NULL)
            fail_msg("%s: %d: %s", row[i].opts.time, st, err.text);
        assert_int_equal(st == SS_OK ? signal->n : 0, row[i].n);
        ss_signal_free(signal);
    }
}

/* An array of time and two channels, as MATLAB's users save them. */
static void
a_column_of_an_array_gives_its_clock(void **state)
{
    static const char *const time[] = { "data1", "1" };
    double x[3][20];
    const hsize_t dims[2] = { 3, 20 };
    (void)state;
    for (int i = 0; i < 20; i++) {
        x[0][i] = i / 50.;
        x[1][i] = i * i;
        x[2][i] = -i;
    }
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), space = H5Screate_simple(2, dims, NULL);
    hid_t id = H5Dcreate2(file, "data", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x) >= 0);
    H5Dclose(id);
    H5Sclose(space);
    H5Fclose(file);
    for (size_t i = 0; i < 2; i++) {
        const ss_read_opts opts = { READ_OPTS, .time = time[i] };
        ss_signal *signal = NULL;
        ss_error err = { 0 };
        if (load_place(&signal, "/data", &opts, &err) != SS_OK)
            fail_msg("%s", err.text);
        assert_true(signal->head->rate == 50);
        assert_int_equal(signal->head->n_columns, 2);
        assert_string_equal(signal->head->column[0].name, "data2");
        assert_same_bits(signal->values, x[1], 40);
        ss_signal_free(signal);
    }
}

static void
attributes_that_are_no_notes_are_skipped(void **state)
{
    static const char *const name[] = { "rate", "start", "columns", "a:b" };
    ss_signal *signal = new_signal(10), *back = NULL;
    (void)state;
    write_ok(&(ss_record){ .signal = signal });
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        put_scalar(file, name[i], H5T_C_S1, "5");
    hid_t two = H5Screate_simple(1, (hsize_t[]){ 2 }, NULL);        /* an array of texts is none */
    hid_t id = H5Acreate2(file, "pair", H5T_C_S1, two, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(id, H5T_C_S1, "ab") >= 0);
    H5Aclose(id);
    H5Sclose(two);
    H5Fclose(file);
    assert_int_equal(ss_signal_read(&back, NULL, path, NULL, NULL), SS_OK);
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
    assert_int_equal(ss_signal_read(&back, NULL, path, NULL, NULL), SS_EKIND);
    assert_int_equal(ss_signal_read(&back, NULL, "/dev/null", NULL, NULL), SS_EDATA);
    write_ok(&(ss_record){ .signal = signal });
    put_attribute("/signal", "rate", 0);
    assert_int_equal(ss_signal_read(&back, NULL, path, NULL, NULL), SS_EDATA);
    ss_signal_free(signal);
}

static void
a_rate_that_none_can_be_is_no_clock(void **state)
{
    static const double rate[] = { 0, -5, INFINITY, NAN };
    const ss_read_opts opts = { READ_OPTS, .rate = 0 };
    ss_signal *back = NULL;
    (void)state;
    write_foreign(0);
    for (size_t i = 0; i < sizeof rate / sizeof *rate; i++) {
        put_attribute("/line", "rate", rate[i]);
        assert_int_equal(load_place(&back, "/line", &opts, NULL), SS_ECLOCK);
    }
    put_attribute("/line", "rate", 5);
    assert_int_equal(load_place(&back, "/line", &opts, NULL), SS_OK);
    assert_true(back->head->rate == 5);
    ss_signal_free(back);
}

static void
a_fifo_keeps_its_first_bytes(void **state)
{
    char fifo[80];
    (void)state;
    snprintf(fifo, sizeof fifo, "%s/fifo", dir);
    assert_int_equal(mkfifo(fifo, 0600), 0);
    assert_null(ss_format_of_file(fifo));               /* and does not wait for a writer */
    unlink(fifo);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_of_others_are_read_by_their_path),
        cmocka_unit_test(rows_in_pieces_are_those_of_the_array),
        cmocka_unit_test(a_bad_value_is_found_where_it_stands),
        cmocka_unit_test(a_dataset_of_our_own_brings_its_clock),
        cmocka_unit_test(what_cannot_be_read_is_refused_in_clear_words),
        cmocka_unit_test(a_file_without_coefficients_says_so),
        cmocka_unit_test(a_clock_of_its_own_is_not_exchanged),
        cmocka_unit_test(times_of_a_dataset_give_the_clock),
        cmocka_unit_test(times_of_a_dataset_are_checked_as_those_of_text),
        cmocka_unit_test(a_column_of_an_array_gives_its_clock),
        cmocka_unit_test(a_start_too_late_for_its_rate_is_refused),
        cmocka_unit_test(attributes_that_are_no_notes_are_skipped),
        cmocka_unit_test(a_missing_signal_is_told_from_a_damaged_one),
        cmocka_unit_test(a_rate_that_none_can_be_is_no_clock),
        cmocka_unit_test(a_fifo_keeps_its_first_bytes),
    };
    return cmocka_run_group_tests_name("store foreign", tests, make_dir, remove_dir);
}
