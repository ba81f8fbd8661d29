/* test_arguments.c -- NULL where something is needed is refused, and changes nothing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stickslip.h>

/* Refused, with a text where there is room for one. */
static void
assert_refused(ss_status status, ss_error *err)
{
    assert_int_equal(status, SS_EINVAL);
    if (err == NULL)
        return;
    assert_string_equal(err->text, "an argument is NULL");
    err->text[0] = '\0';
}

static void
readers_refuse_null(void **state)
{
    FILE *in = tmpfile();
    ss_error e = { "" };
    ss_scene scene;
    ss_reader *reader;
    ss_signal *signal;
    ss_coefficients *c;
    double row;
    size_t n;
    (void)state;
    assert_refused(ss_scene_read(NULL, in, "in", &e), &e);
    assert_refused(ss_scene_read(&scene, NULL, "in", &e), &e);
    assert_refused(ss_scene_read(&scene, in, NULL, &e), &e);
    assert_refused(ss_scene_read_set(&scene, in, "in", NULL, 1, &e), &e);
    assert_refused(ss_scene_check(NULL, &e), &e);
    assert_refused(ss_reader_new(NULL, in, "in", NULL, &e), &e);
    assert_refused(ss_reader_new(&reader, NULL, "in", NULL, &e), &e);
    assert_refused(ss_reader_new(&reader, in, NULL, NULL, &e), &e);
    assert_refused(ss_reader_rows(NULL, &row, 1, &n, &e), &e);
    assert_refused(ss_signal_read(NULL, in, "in", NULL, &e), &e);
    assert_refused(ss_signal_read(&signal, NULL, "in", NULL, &e), &e);
    assert_refused(ss_coefficients_read(NULL, in, "in", &e), &e);
    assert_refused(ss_coefficients_read(&c, NULL, "in", &e), &e);
    assert_refused(ss_store_read_signal(NULL, "x.h5", NULL, NULL, &e), &e);
    assert_refused(ss_store_read_signal(&signal, NULL, NULL, NULL, &e), &e);
    assert_refused(ss_store_read_coefficients(NULL, "x.h5", &e), &e);
    assert_refused(ss_store_read_coefficients(&c, NULL, &e), &e);
    assert_refused(ss_load_signal(NULL, "x", NULL, &e), &e);
    assert_refused(ss_load_signal(&signal, NULL, NULL, &e), &e);
    assert_int_equal(ftell(in), 0);
    fclose(in);
}

static void
makers_and_writers_refuse_null(void **state)
{
    static const ss_scene scene;
    static const ss_record record;
    ss_error e = { "" };
    ss_header *head = ss_header_new(1, 0);
    ss_signal *signal;
    ss_writer *writer;
    ss_coefficients *c;
    (void)state;
    assert_refused(ss_header_add_column(NULL, "x", ""), NULL);
    assert_refused(ss_header_add_column(head, NULL, ""), NULL);
    assert_refused(ss_header_note(NULL, "key", "value"), NULL);
    assert_refused(ss_header_note(head, NULL, "value"), NULL);
    assert_refused(ss_header_note(head, "key", NULL), NULL);
    assert_refused(ss_signal_new(NULL, head, 1), NULL);
    assert_refused(ss_signal_new(&signal, NULL, 1), NULL);
    assert_refused(ss_signal_select(&signal, NULL, NULL, 0, 0, 0), NULL);
    assert_refused(ss_signal_write(NULL, stdout, SS_TSV), NULL);
    assert_refused(ss_writer_new(NULL, stdout, SS_TSV, head), NULL);
    assert_refused(ss_writer_new(&writer, NULL, SS_TSV, head), NULL);
    assert_refused(ss_writer_new(&writer, stdout, SS_TSV, NULL), NULL);
    assert_refused(ss_writer_rows(NULL, NULL, 0), NULL);
    assert_refused(ss_scene_write(NULL, stdout), NULL);
    assert_refused(ss_scene_write(&scene, NULL), NULL);
    assert_refused(ss_coefficients_write(NULL, stdout, SS_TSV), NULL);
    assert_refused(ss_transform(&c, NULL, 0, &ss_morlet_defaults, &e), &e);
    assert_refused(ss_store_write(NULL, &record, &e), &e);
    assert_refused(ss_store_write("x.h5", NULL, &e), &e);
    assert_int_equal(head->n_columns + head->n_notes, 0);
    ss_header_free(head);
}

static void
nothing_is_freed_without_complaint(void **state)
{
    (void)state;
    ss_header_free(NULL);
    ss_reader_free(NULL);
    ss_signal_free(NULL);
    ss_writer_free(NULL);
    ss_noise_free(NULL);
    ss_morlet_free(NULL);
    ss_coefficients_free(NULL);
    ss_trade_free(NULL);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(readers_refuse_null),
        cmocka_unit_test(makers_and_writers_refuse_null),
        cmocka_unit_test(nothing_is_freed_without_complaint),
    };
    return cmocka_run_group_tests_name("arguments", tests, NULL, NULL);
}
