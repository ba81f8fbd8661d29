/* test_store_foreign.c -- what others wrote is read, or refused in clear words. */
#include "store_file.h"

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
            ss_error err = { 0 };
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
        ss_error err = { 0 };
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
    ss_error err = { 0 };
    (void)state;
    write_foreign(0);
    assert_int_equal(ss_store_read_coefficients(&c, path, &err), SS_EKIND);
    assert_non_null(strstr(err.text, "no /wavelet"));
}

static void
a_clock_of_its_own_is_not_exchanged(void **state)
{
    static const ss_read_opts other = { .rate = 5 }, column = { .time = "a" };
    ss_signal *signal = new_signal(10), *back = NULL;
    const ss_read_opts same = { .rate = signal->head->rate };
    ss_error err = { 0 };
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
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        put_scalar(file, name[i], H5T_C_S1, "5");
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
        cmocka_unit_test(arrays_of_others_are_read_by_their_path),
        cmocka_unit_test(a_dataset_of_our_own_brings_its_clock),
        cmocka_unit_test(what_cannot_be_read_is_refused_in_clear_words),
        cmocka_unit_test(a_file_without_coefficients_says_so),
        cmocka_unit_test(a_clock_of_its_own_is_not_exchanged),
        cmocka_unit_test(attributes_that_are_no_notes_are_skipped),
        cmocka_unit_test(a_missing_signal_is_told_from_a_damaged_one),
        cmocka_unit_test(a_fifo_keeps_its_first_bytes),
    };
    return cmocka_run_group_tests_name("store foreign", tests, make_dir, remove_dir);
}
