/* test_store_hostile.c -- a damaged or hostile file is refused, or does no harm. */
#include "store_file.h"
#include "io/frames.h"
#include "read_opts.h"

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
        ss_error err = { 0 };
        assert_int_equal(truncate(path, (off_t)(size - 1 - cut)), 0);
        assert_int_not_equal(read_map(&back, path, &err), SS_OK);
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
        ss_error err = { 0 };
        bytes[i] ^= (unsigned char)(1u << i / 61 % 8);
        out = fopen(path, "wb");
        assert_int_equal(fwrite(bytes, 1, size, out), size);
        fclose(out);
        if (ss_signal_read(&read, NULL, path, NULL, &err) != SS_OK)
            assert_true(read == NULL && err.text[0] != '\0');
        if (read_map(&back, path, &err) != SS_OK)
            assert_true(back == NULL && err.text[0] != '\0');
        ss_signal_free(read);
        ss_coefficients_free(back);
        /* what HDF5 says at exit, "infinite loop closing library", is of memory of its own */
        assert_int_equal(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
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
    static const ss_read_opts opts = { READ_OPTS, .rate = 1 };
    char other[80];
    ss_coefficients *c = NULL;
    ss_error err = { 0 };
    (void)state;
    write_foreign(0);
    snprintf(other, sizeof other, "%s.other", path);
    assert_int_equal(rename(path, other), 0);
    write_hostile(other);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *signal = NULL;
        assert_int_equal(load_place(&signal, row[i].dataset, &opts, &err), SS_EDATA);
        assert_null(signal);
        assert_string_equal(err.text + strlen(path), row[i].words);
    }
    assert_int_equal(read_map(&c, path, &err), SS_EDATA);
    assert_string_equal(err.text + strlen(path), ":/wavelet: not a group of this file");
    unlink(other);
}

/* A /signal of n values at 1 Hz from 1 s on, at most 200, with a column t only, tracked in the order of writing but
 * without an index of it. */
static hid_t
open_signal_of_times(hid_t file, hsize_t n)
{
    const double one = 1;
    static const char *const name[] = { "rate", "start", "has_time" };
    hid_t how = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_link_creation_order(how, H5P_CRT_ORDER_TRACKED);
    hid_t group = H5Gcreate2(file, "signal", H5P_DEFAULT, how, H5P_DEFAULT);
    for (size_t i = 0; i < 3; i++)
        put_scalar(group, name[i], H5T_NATIVE_DOUBLE, &one);
    hid_t space = H5Screate_simple(1, &n, NULL);
    hid_t id = H5Dcreate2(group, "t", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    double t[200];
    for (int i = 0; i < 200; i++)
        t[i] = 1 + i;
    H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, t);
    H5Dclose(id);
    H5Sclose(space);
    H5Pclose(how);
    return group;
}

/* A dataset of n values beside t, without storage. */
static void
put_without_values(hid_t group, const char *name, hsize_t n)
{
    hid_t space = H5Screate_simple(1, &n, NULL);
    hid_t id = H5Dcreate2(group, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(id >= 0);
    H5Dclose(id);
    H5Sclose(space);
}

static void
assert_signal_refused(const char *words)
{
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    assert_int_equal(ss_signal_read(&signal, NULL, path, NULL, &err), SS_EDATA);
    assert_null(signal);
    assert_string_equal(err.text + strlen(path), words);
}

static void
many_datasets_together_claim_no_more_than_one_may(void **state)
{
    enum { VALUES = 200 };
    char name[32], words[120];
    struct stat st;
    (void)state;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t group = open_signal_of_times(file, VALUES);
    for (int i = 0; i < 9; i++) {
        snprintf(name, sizeof name, "x%d", i);
        put_without_values(group, name, VALUES);
    }
    H5Gclose(group);
    H5Fclose(file);
    assert_int_equal(stat(path, &st), 0);
    assert_in_range(st.st_size, 2 * 8 * VALUES, 9 * 8 * VALUES - 1);
    snprintf(words, sizeof words, ":/signal/x%d: with those before, claims more values than a file of this size can "
             "hold", (int)st.st_size / (8 * VALUES) - 1);
    assert_signal_refused(words);
}

static void
a_column_shorter_than_t_is_refused(void **state)
{
    (void)state;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t group = open_signal_of_times(file, 100);
    put_without_values(group, "x", 1);
    H5Gclose(group);
    H5Fclose(file);
    assert_signal_refused(":/signal/x: not as long as t");
}

/* An attribute of the root whose text of variable length is n times this letter. */
static void
put_variable_text(hid_t file, const char *name, size_t n, int letter)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    char *text = calloc(n + 1, 1);
    assert_non_null(memset(text, letter, n));
    H5Tset_size(type, H5T_VARIABLE);
    put_scalar(file, name, type, &text);
    H5Tclose(type);
    free(text);
}

/* Where the file refers to a text of n bytes: its length (4 bytes), the address of a global heap (8)
 * and an index in it (4), see IV.B of the HDF5 file format. */
static char *
find_reference(char *bytes, size_t size, uint32_t n)
{
    for (size_t i = 0; i + 16 <= size; i++) {
        uint64_t heap = ss_bytes_get(bytes + i + 4, 8, 1);
        if (ss_bytes_get(bytes + i, 4, 1) == n && heap + 4 <= size && memcmp(bytes + heap, "GCOL", 4) == 0)
            return bytes + i;
    }
    fail_msg("no text of %u bytes", (unsigned)n);
    return NULL;
}

static void
one_text_under_many_names_is_not_read_many_times(void **state)
{
    enum { NAMES = 20, LARGE = 600000, SMALL = 1000 };
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    char name[32];
    size_t size;
    (void)state;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(open_signal_of_times(file, 3));
    put_variable_text(file, "large", LARGE, 'a');
    for (int i = 0; i < NAMES; i++) {
        snprintf(name, sizeof name, "small%d", i);
        put_variable_text(file, name, (size_t)(SMALL + i), 'b');
    }
    H5Fclose(file);
    assert_int_equal(ss_signal_read(&signal, NULL, path, NULL, NULL), SS_OK);
    assert_int_equal(strlen(ss_header_find_note(signal->head, "large")), LARGE);
    assert_int_equal(strlen(ss_header_find_note(signal->head, "small7")), SMALL + 7);
    ss_signal_free(signal);
    signal = NULL;
    char *bytes = read_bytes(&size);
    const char *large = find_reference(bytes, size, LARGE);
    for (int i = 0; i < NAMES; i++)
        memcpy(find_reference(bytes, size, (uint32_t)(SMALL + i)), large, 16);
    FILE *out = fopen(path, "wb");
    assert_int_equal(fwrite(bytes, 1, size, out), size);
    fclose(out);
    free(bytes);
    assert_int_equal(ss_signal_read(&signal, NULL, path, NULL, &err), SS_EDATA);
    assert_null(signal);
    assert_string_equal(err.text + strlen(path), ":/: attributes claim more text than the file holds");
}

/* The root, so many types, an array: 10,000 objects are looked at, not one more. */
static void
the_list_of_arrays_ends_after_10000_objects(void **state)
{
    static const ss_read_opts opts = { READ_OPTS, .rate = 1 };
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    char name[32];
    (void)state;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    for (int i = 0; i < 9998; i++) {
        snprintf(name, sizeof name, "type%d", i);
        hid_t type = H5Tcopy(H5T_IEEE_F64LE);
        assert_true(H5Tcommit2(file, name, type, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT) >= 0);
        H5Tclose(type);
    }
    put_array(file, "x", H5T_IEEE_F64LE, 6, H5P_DEFAULT);
    H5Fclose(file);
    assert_int_equal(ss_signal_read(&signal, NULL, path, &opts, &err), SS_EKIND);
    assert_non_null(strstr(err.text, "no /signal in it; choose one as"));
    assert_non_null(strstr(err.text, " /x"));
    file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    H5Gclose(H5Gcreate2(file, "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Fclose(file);
    assert_int_equal(ss_signal_read(&signal, NULL, path, &opts, &err), SS_EKIND);
    assert_string_equal(err.text + strlen(path), ": no /signal in it, nor any array of real numbers");
    assert_int_equal(load_place(&signal, "/x", &opts, &err), SS_OK);
    ss_signal_free(signal);
}

/* 1200 deep, the list would take minutes; it ends where no name would fit any more. */
static void
groups_in_groups_are_not_followed_without_end(void **state)
{
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    (void)state;
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), group = H5Gopen2(file, "/", H5P_DEFAULT);
    put_array(file, "a", H5T_IEEE_F64LE, 6, H5P_DEFAULT);
    for (int depth = 0; depth < 1200; depth++) {
        hid_t inner = H5Gcreate2(group, "g", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        assert_true(inner >= 0);
        H5Gclose(group);
        group = inner;
    }
    H5Gclose(group);
    H5Fclose(file);
    assert_int_equal(ss_signal_read(&signal, NULL, path, NULL, &err), SS_EKIND);
    assert_non_null(strstr(err.text, ":/PATH from /a ..."));
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
    hid_t group = open_signal_of_times(file, 3);
    for (int i = COLUMNS; i > 0; i--) {
        snprintf(name, sizeof name, "x%d", i);
        put_without_values(group, name, 3);
    }
    H5Gclose(group);
    H5Fclose(file);
    assert_int_equal(ss_signal_read(&signal, NULL, path, NULL, NULL), SS_OK);
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
    static const ss_read_opts opts = { READ_OPTS, .rate = 1 };
    char fifo[80];
    ss_signal *signal = NULL;
    ss_error err = { 0 };
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
    for (int named = 0; named < 2; named++)
        assert_int_equal(load_place(&signal, named ? "/x" : NULL, &opts, &err), named ? SS_EDATA : SS_EKIND);
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
    static const ss_read_opts opts = { READ_OPTS, .rate = 1 };
    static const H5Z_filter_t plain[] = { H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32, 0 },
        twice[] = { H5Z_FILTER_DEFLATE, H5Z_FILTER_DEFLATE, 0 }, other[] = { 32001, 0 };
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    unsigned before, after;
    (void)state;
    H5PLget_loading_state(&before);
    write_filtered(plain);
    assert_int_equal(load_place(&signal, "/x", &opts, &err), SS_OK);
    ss_signal_free(signal);
    for (int i = 0; i < 2; i++) {
        H5E_BEGIN_TRY {
            write_filtered(i == 0 ? twice : other);
        } H5E_END_TRY
        assert_int_equal(load_place(&signal, "/x", &opts, &err), SS_EDATA);
        assert_string_equal(err.text + strlen(path), ":/x: is packed otherwise than by deflate, once; "
                            "h5repack -f GZIP=1 makes it so");
    }
    H5PLget_loading_state(&after);
    assert_int_equal(after, before);
}

/* As in text: within rounding and 1e-6 of a sample period of start + n / rate, over pieces, and in one row of each. */
static void
times_that_are_not_the_clock_are_refused(void **state)
{
    enum { ROWS = 300000 };
    static const struct { hsize_t at; double by; int good; } row[] = {
        { 0, 0, 1 }, { 0, 1e-3, 0 }, { ROWS - 1, -1e-6, 0 }, { ROWS / 2, NAN, 0 }, { 7, INFINITY, 0 }, { 7, 1e-10, 1 },
    };
    ss_signal *signal = new_signal(ROWS);
    (void)state;
    write_ok(&(ss_record){ .signal = signal });
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *back = NULL;
        ss_error err = { 0 };
        const hsize_t one = 1;
        char words[80];
        double right = signal->head->start + (double)row[i].at / signal->head->rate;
        for (int wrong = 1; wrong >= 0; wrong--) {
            double stamp = wrong ? right + row[i].by : right;
            hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), id = H5Dopen2(file, "/signal/t", H5P_DEFAULT);
            hid_t space = H5Dget_space(id), memory = H5Screate_simple(1, &one, NULL);
            H5Sselect_elements(space, H5S_SELECT_SET, 1, &row[i].at);
            assert_true(H5Dwrite(id, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &stamp) >= 0);
            H5Sclose(memory);
            H5Sclose(space);
            H5Dclose(id);
            H5Fclose(file);
            ss_status st = ss_signal_read(&back, NULL, path, NULL, &err);
            assert_int_equal(st, !wrong || row[i].good ? SS_OK : SS_EDATA);
            snprintf(words, sizeof words, ":/signal/t: value %d is not start + %d / rate", (int)row[i].at + 1,
                     (int)row[i].at);
            if (st != SS_OK)
                assert_string_equal(err.text + strlen(path), words);
            ss_signal_free(back);
            back = NULL;
        }
    }
    ss_signal_free(signal);
}

/* Modulo 2^64 the first three products are 0, 24 and 1. */
static void
dimensions_are_multiplied_without_end(void **state)
{
    const struct { hsize_t dims[2], chunk[2]; int deflated; const char *words; } row[] = {
        { { (hsize_t)1 << 62, 4 }, { 64, 4 }, 0, "has more values than can be read at once" },
        { { ((hsize_t)1 << 61) + 3, 8 }, { 64, 8 }, 0, "has more values than can be read at once" },
        { { 67280421310721, 274177 }, { 64, 1 }, 1, "has more values than can be read at once" },
        { { 900000000, 1 }, { 64, 1 }, 1, "claims more values than a file of this size can hold" },
        { { 1, 6 }, { 1 << 14, 1 << 14 }, 1, "claims more values than a file of this size can hold" },
    };
    static const ss_read_opts opts = { READ_OPTS, .rate = 1 };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *signal = NULL;
        ss_error err = { 0 };
        const hsize_t most[2] = { H5S_UNLIMITED, H5S_UNLIMITED };
        hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), how = H5Pcreate(H5P_DATASET_CREATE);
        hid_t space = H5Screate_simple(2, row[i].dims, most);
        H5Pset_chunk(how, 2, row[i].chunk);
        if (row[i].deflated)
            H5Pset_deflate(how, 9);
        hid_t id = H5Dcreate2(file, "x", H5T_STD_I8LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
        assert_true(id >= 0);
        H5Dclose(id);
        H5Sclose(space);
        H5Pclose(how);
        H5Fclose(file);
        assert_int_equal(load_place(&signal, "/x", &opts, &err), SS_EDATA);
        assert_string_equal(err.text + strlen(path) + strlen(":/x: "), row[i].words);
    }
}

/* Write a file whose group with this name holds n soft links to /x with long names, in a heap, and the attributes of
 * a signal and of a dense grid. */
static void
write_heap(const char *name, int n, int deflated)
{
    static const char *const attribute[] = { "rate", "start", "has_time", "samples", "scales", "dense" };
    const double one = 1, six = 6;
    char link[4000];
    hid_t access = H5Pcreate(H5P_FILE_ACCESS), how = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
    put_array(file, "x", H5T_IEEE_F64LE, 6, H5P_DEFAULT);
    H5Pset_link_phase_change(how, 0, 0);
    if (deflated)
        H5Pset_deflate(how, 9);
    hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, how, H5P_DEFAULT);
    assert_non_null(memset(link, 'a', sizeof link));
    for (int i = 0; i < n; i++) {
        snprintf(link + 3900, sizeof link - 3900, "%d", i);
        assert_true(H5Lcreate_soft("/x", group, link, H5P_DEFAULT, H5P_DEFAULT) >= 0);
    }
    assert_true(H5Lcreate_hard(file, "/x", group, "y", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    for (size_t i = 0; i < sizeof attribute / sizeof *attribute; i++)
        put_scalar(group, attribute[i], H5T_NATIVE_DOUBLE, &one);
    put_scalar(group, "center", H5T_NATIVE_DOUBLE, &six);
    H5Gclose(group);
    H5Lcreate_soft(name, file, "z", H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(file);
    H5Pclose(how);
    H5Pclose(access);
}

/* Directly, through a soft link, among the datasets to be listed, and as /signal and /wavelet. */
static void
names_that_are_packed_are_not_unpacked(void **state)
{
    static const struct { const char *name, *dataset; } row[] = {
        { "group", "/group/y" }, { "group", "/z/y" }, { "group", "" }, { "signal", "" }, { "wavelet", NULL },
    };
    static const ss_read_opts opts = { READ_OPTS, .rate = 1 };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (int deflated = 0; deflated < 2; deflated++) {
            ss_signal *signal = NULL;
            ss_coefficients *c = NULL;
            ss_error err = { 0 };
            write_heap(row[i].name, 100, deflated);
            ss_status st = row[i].dataset == NULL ? read_map(&c, path, &err)
                : load_place(&signal, row[i].dataset, &opts, &err);
            assert_int_equal(st, !deflated && i < 2 ? SS_OK : !deflated && i == 2 ? SS_EKIND : SS_EDATA);
            int packed = strstr(err.text, ": names or attributes in it are packed by filters") != NULL;
            if (packed != deflated)
                fail_msg("%s as %s, deflated %d: %s", row[i].name, row[i].dataset, deflated, err.text);
            ss_signal_free(signal);
        }
}

/* Put a 1-D dataset of n values, or of zeros, in the place of one. */
static void
put_values(const char *dataset, hsize_t n, const double *x)
{
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), space = H5Screate_simple(1, &n, NULL);
    H5Ldelete(file, dataset, H5P_DEFAULT);
    hid_t id = H5Dcreate2(file, dataset, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(id >= 0);
    if (x != NULL)
        H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x);
    H5Dclose(id);
    H5Sclose(space);
    H5Fclose(file);
}

static void
put_zeros(const char *dataset, hsize_t n)
{
    put_values(dataset, n, NULL);
}

static void
assert_refused(const char *words)
{
    ss_coefficients *c = NULL;
    ss_error err = { 0 };
    assert_int_equal(read_map(&c, path, &err), SS_EDATA);
    assert_null(c);
    if (strstr(err.text, words) == NULL)
        fail_msg("'%s' does not say '%s'", err.text, words);
}

static void
a_grid_that_is_not_one_is_refused(void **state)
{
    static const struct { const char *object, *name; double value; const char *words; } row[] = {
        { "/wavelet", "rate", 0, "attribute 'rate'" },
        { "/wavelet", "rate", -1, "attribute 'rate'" },
        { "/wavelet", "rate", NAN, "attribute 'rate'" },
        { "/wavelet", "rate", INFINITY, "attribute 'rate'" },
        { "/wavelet", "rate", 1e200, "has equal time stamps" },
        { "/wavelet", "rate", 20, "not the coefficients of the grid" },
        { "/wavelet", "dense", 2, ":/wavelet: attribute 'dense' is missing or out of range" },
        { "/wavelet", "dense", 1, ":/wavelet/re: no such dataset" },
        { "/", "samples", 500, "lack their option 'samples'" },         /* a note is text */
        { "/", "voices", 5, "lack their option 'voices'" },
    };
    static const char *const note[][3] = {
        { "samples", "400", ":/wavelet/scale000/re: not the coefficients of the grid" },
        { "samples", "0", "the option 'samples: 0' is out of range" }, { "samples", "1e300", "out of range" },
        { "samples", "400.5", "not whole numbers" }, { "center", "7x", "the option 'center: 7x' is out of range" },
        { "center", "1", "center 1 is out of range" }, { "voices", "1e9", "out of range" },
        { "voices", "3", "not the coefficients of the grid" }, { "step", "0.5", "not the coefficients of the grid" },
        { "step", "1e-9", "step" }, { "dense", "yes", "not the coefficients of the grid" },
    };
    ss_signal *signal = new_signal(500);
    ss_coefficients *c = transform(signal, 0);
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        write_ok(&(ss_record){ .coefficients = c });
        put_attribute(row[i].object, row[i].name, row[i].value);
        assert_refused(row[i].words);
    }
    for (size_t i = 0; i < sizeof note / sizeof *note; i++) {
        const char *was = ss_header_find_note(c->head, note[i][0]);
        char *before = was != NULL ? strdup(was) : NULL;
        assert_int_equal(ss_header_note(c->head, note[i][0], note[i][1], NULL), SS_OK);
        write_ok(&(ss_record){ .coefficients = c });
        assert_refused(note[i][2]);
        assert_int_equal(ss_header_note(c->head, note[i][0], before, NULL), SS_OK);
        free(before);
    }
    write_ok(&(ss_record){ .coefficients = c });
    put_zeros("/wavelet/scale001/re", 0);
    put_zeros("/wavelet/scale001/im", 0);
    assert_refused(":/wavelet/scale001/re: not the coefficients of the grid");
    write_ok(&(ss_record){ .coefficients = c });
    put_zeros("/wavelet/j", c->n_scales);
    assert_refused(":/wavelet/scale000/re: not the coefficients of the grid");
    double twice[] = { c->scale[0].j, c->scale[0].j }, fraction = c->scale[0].j + 0.5, far = 1e9;
    put_values("/wavelet/j", 2, twice);
    assert_refused(":/wavelet/j: not numbers of scales that descend");
    put_values("/wavelet/j", 1, &fraction);
    assert_refused(":/wavelet/j: not numbers");
    put_values("/wavelet/j", 1, &far);
    assert_refused(":/wavelet/j: not numbers");
    put_zeros("/wavelet/j", 0);
    assert_refused(":/wavelet/j: no scales");
    put_zeros("/wavelet/j", c->n_scales + 1);
    assert_refused(":/wavelet/");
    ss_coefficients_free(c);
    c = transform(signal, 1);
    write_ok(&(ss_record){ .coefficients = c });
    put_zeros("/wavelet/re", 4);
    assert_refused(":/wavelet/re: not the coefficients of the grid");
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

static void
gaps_that_are_reversed_are_refused(void **state)
{
    (void)state;
    static const char *const note[] = { "2:1", "1", "a:b", "1:2 x" };
    for (size_t i = 0; i < sizeof note / sizeof *note; i++) {
        ss_signal *signal = new_signal(10), *back = NULL;
        ss_error err = { 0 };
        assert_int_equal(ss_header_note(signal->head, "gaps", note[i], NULL), SS_OK);
        write_ok(&(ss_record){ .signal = signal });
        assert_int_equal(ss_signal_read(&back, NULL, path, NULL, &err), SS_EDATA);
        assert_non_null(strstr(err.text, "the note 'gaps' is not"));
        ss_signal_free(signal);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_truncated_file_is_refused),
        cmocka_unit_test(flipped_bits_are_refused_or_harmless),
        cmocka_unit_test(nothing_leads_out_of_a_file_or_claims_more_than_it_holds),
        cmocka_unit_test(many_datasets_together_claim_no_more_than_one_may),
        cmocka_unit_test(a_column_shorter_than_t_is_refused),
        cmocka_unit_test(one_text_under_many_names_is_not_read_many_times),
        cmocka_unit_test(the_list_of_arrays_ends_after_10000_objects),
        cmocka_unit_test(groups_in_groups_are_not_followed_without_end),
        cmocka_unit_test(many_columns_without_an_index_are_listed_at_once),
        cmocka_unit_test(the_sources_of_a_virtual_dataset_are_not_opened),
        cmocka_unit_test(only_filters_that_bound_what_they_make_are_run),
        cmocka_unit_test(times_that_are_not_the_clock_are_refused),
        cmocka_unit_test(dimensions_are_multiplied_without_end),
        cmocka_unit_test(names_that_are_packed_are_not_unpacked),
        cmocka_unit_test(a_grid_that_is_not_one_is_refused),
        cmocka_unit_test(gaps_that_are_reversed_are_refused),
    };
    return cmocka_run_group_tests_name("store hostile", tests, make_dir, remove_dir);
}
