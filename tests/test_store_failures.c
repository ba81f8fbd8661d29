/* test_store_failures.c -- a write that fails says why and leaves nothing behind. */
#include <errno.h>
#include <signal.h>
#include <sys/resource.h>
#include "map/map.h"
#include "store_file.h"

static void
a_file_that_is_not_brought_to_its_end_is_no_file(void **state)
{
    (void)state;
    for (int row = 0; row < 6; row++) {
        ss_signal *signal = new_signal(300);
        ss_coefficients *c = transform(signal, 1), grid = *c;
        const ss_scale *scale = c->scale;
        ss_writer *writer = NULL;
        ss_error err = { 0 };
        grid.n = row % 2 ? c->n : 0;
        assert_int_equal(ss_writer_new(&writer, NULL, path, SS_H5, &(ss_contents){ signal->head,
                                       &grid, 0, grid.n }, NULL), SS_OK);
        ss_status st = store_samples(writer, signal, 0, 300, &err);
        assert_int_equal(st, SS_OK);
        assert_int_equal(ss_writer_coefficients(writer, scale, 0, 200, c->w, 300, NULL), SS_OK);
        if (row < 2)            /* a gap in the rows of a scale */
            st = ss_writer_coefficients(writer, scale, 201, 99, c->w, 300, &err);
        else if (row < 4)       /* rows are missing */
            st = ss_writer_end(writer, 300, &err);
        else if (row == 5)      /* a sample too many */
            st = store_samples(writer, signal, 0, 1, &err);
        assert_int_equal(st, row == 4 ? SS_OK : SS_EINVAL);
        if (row != 4) {         /* it says so once and for all */
            char first[sizeof err.text];
            strcpy(first, err.text);
            assert_true(first[0] != '\0');
            err.text[0] = '\0';
            assert_int_equal(ss_writer_end(writer, 300, &err), SS_EINVAL);
            assert_string_equal(err.text, first);
        }
        ss_writer_free(writer);
        assert_int_equal(access(path, F_OK), -1);
        assert_int_equal(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
        ss_coefficients_free(c);
        ss_signal_free(signal);
    }
}

static void
a_write_that_fails_says_why_and_leaves_no_file(void **state)
{
    struct rlimit old, small;
    ss_error err = { 0 };
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    ss_signal *signal = new_signal(50000);
    for (rlim_t limit = 0; limit < 1000000; limit = 2 * limit + 100) {
        small = old;
        small.rlim_cur = limit;
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
        ss_status status = ss_record_write(&(ss_record){ .signal = signal }, NULL, path, SS_H5, &err);
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
            ss_error err = { 0 };
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
a_full_device_says_why(void **state)
{
    ss_error err = { 0 };
    (void)state;
    ss_signal *signal = new_signal(50);
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(ss_record_write(&(ss_record){ .signal = signal }, NULL, "/dev/full", SS_H5, &err),
                         SS_EIO);
        assert_string_equal(err.text, "/dev/full: No space left on device");
        assert_int_equal(access("/dev/full", F_OK), 0);
    }
    ss_signal_free(signal);
}

static void
a_target_that_cannot_be_opened_says_why(void **state)
{
    ss_error err = { 0 };
    (void)state;
    assert_int_equal(ss_record_write(&(ss_record){ .has_events = 1 }, NULL, "/nonexistent/run.h5", SS_H5, &err),
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
    FILE *damaged = fopen(path, "wb");
    fputs("\211HDF\r\n\032\n", damaged);
    fclose(damaged);
    assert_int_equal(ss_signal_read(&signal, NULL, path, NULL, NULL), SS_EDATA);
    assert_int_equal(ss_record_write(&(ss_record){ .has_events = 1 }, NULL, "/nonexistent/run.h5", SS_H5, NULL),
                     SS_EIO);
    assert_int_equal(reports, 0);
    H5Eget_auto2(H5E_DEFAULT, &now, &user);
    assert_true(now == count_reports && user == &reports);
    H5Eset_auto2(H5E_DEFAULT, old, old_user);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_that_is_not_brought_to_its_end_is_no_file),
        cmocka_unit_test(a_write_that_fails_says_why_and_leaves_no_file),
        cmocka_unit_test(a_disk_full_at_any_byte_leaves_no_file),
        cmocka_unit_test(a_full_device_says_why),
        cmocka_unit_test(a_target_that_cannot_be_opened_says_why),
        cmocka_unit_test(hdf5_reports_nothing_and_is_left_as_it_was),
    };
    return cmocka_run_group_tests_name("store failures", tests, make_dir, remove_dir);
}
