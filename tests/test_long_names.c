/* test_long_names.c -- names of 10,000 letters wherever the library is given one: each call works or gives
 * a status, and the text of an error is one line that ends within its room. */
#include "store_file.h"
#include "shipped.h"
#include "read_opts.h"

#include <ctype.h>

enum { LETTERS = 10000, ROWS = 50 };
static char longest[LETTERS + 1], control[LETTERS + 1];

static int
make_names(void **state)
{
    memset(longest, 'a', LETTERS);
    for (size_t i = 0; i < LETTERS; i++)
        control[i] = "\n\r\t\033\177%s"[i % 7];
    return make_dir(state);
}

/* An error that was full of something else before the call. */
static ss_error
new_error(void)
{
    ss_error err;
    memset(err.text, '\n', sizeof err.text);
    return err;
}

/* The call that was given err either worked or said why not, in one printable line. */
static void
assert_told(ss_status status, const ss_error *err)
{
    if (status == SS_OK)
        return;
    const char *end = memchr(err->text, '\0', sizeof err->text);
    assert_non_null(end);
    assert_true(end > err->text);
    for (const char *p = err->text; p < end; p++)
        if (iscntrl((unsigned char)*p))
            fail_msg("byte %d of a message is 0x%02x", (int)(p - err->text), (unsigned char)*p);
}

static void
assert_fails(ss_status status, const ss_error *err)
{
    assert_int_not_equal(status, SS_OK);
    assert_told(status, err);
}

/* Two columns, one with this name and unit, and notes with this key and value. */
static ss_signal *
signal_named(const char *name)
{
    ss_signal *signal = NULL;
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 10, 0, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, name, name, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, name, "m", NULL), SS_OK);
    ss_status keyed = ss_header_note(head, name, "value", NULL);
    assert_true(keyed == SS_OK || keyed == SS_EINVAL);
    assert_int_equal(ss_header_note(head, "scene", name, NULL), SS_OK);
    assert_int_equal(ss_signal_new(&signal, head, ROWS, NULL), SS_OK);
    ss_header_free(head);
    for (size_t i = 0; i < 2 * ROWS; i++)
        signal->values[i] = sin((double)(i * i));
    return signal;
}

static void
assert_same_header(const ss_header *a, const ss_header *b)
{
    assert_int_equal(a->n_columns, b->n_columns);
    for (size_t i = 0; i < a->n_columns; i++) {
        assert_string_equal(a->column[i].name, b->column[i].name);
        assert_string_equal(a->column[i].unit, b->column[i].unit);
    }
    assert_same_notes(a, b);
}

/* HDF5 may have no room for such a name; then it says so. */
static void
signals_keep_long_names_in_every_form(void **state)
{
    ss_signal *signal = signal_named(longest), *back = NULL;
    (void)state;
    assert_int_equal(strlen(signal->head->column[0].name), LETTERS);
    assert_string_equal(ss_header_find_note(signal->head, longest), "value");
    assert_int_equal(ss_header_column(signal->head, longest), 0);
    for (int format = SS_TSV; format <= SS_AU; format++) {
        FILE *file = tmpfile();
        assert_int_equal(ss_record_write(&(ss_record){ .signal = signal }, file, NULL, (ss_format)format, NULL),
                                         SS_OK);
        rewind(file);
        assert_int_equal(ss_signal_read(&back, file, "in", NULL, NULL), SS_OK);
        assert_same_header(signal->head, back->head);
        ss_signal_free(back);
        fclose(file);
    }
    ss_error err = new_error();
    ss_status st = ss_record_write(&(ss_record){ .signal = signal }, NULL, path, SS_H5, &err);
    assert_told(st, &err);
    if (st == SS_OK) {
        assert_int_equal(ss_signal_read(&back, NULL, path, NULL, NULL), SS_OK);
        assert_same_header(signal->head, back->head);
        ss_signal_free(back);
    }
    ss_signal_free(signal);
}

/* Read a text in an attribute, of so many bytes with its end. */
static void
read_text(char *text, hid_t file, const char *object, const char *name, size_t bytes)
{
    hid_t id = H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT), type = H5Aget_type(id);
    assert_int_equal(H5Tget_size(type), bytes);
    assert_true(H5Aread(id, type, text) >= 0);
    H5Tclose(type);
    H5Aclose(id);
}

/* stickslip-hdf5(5) puts the name and the unit of what was transformed into /wavelet, for other programs only. */
static void
coefficients_have_a_long_unit_whole(void **state)
{
    ss_signal *signal = signal_named("x");
    ss_coefficients *c = transform(signal, 0);
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, signal->head->rate, 0, NULL), SS_OK);
    char text[LETTERS + 20] = "";
    (void)state;
    assert_int_equal(ss_header_add_column(head, "x", longest, NULL), SS_OK);
    ss_header_free(c->head);
    c->head = head;
    write_ok(&(ss_record){ .coefficients = c });
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    read_text(text, file, "/wavelet/scale000/re", "units", LETTERS + sizeof " s^0.5");
    assert_memory_equal(text, longest, LETTERS);
    assert_string_equal(text + LETTERS, " s^0.5");
    read_text(text, file, "/wavelet", "column_units", sizeof longest);
    assert_string_equal(text, longest);
    read_text(text, file, "/wavelet", "column", sizeof "x");
    assert_string_equal(text, "x");
    H5Fclose(file);
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

static ss_status
draw_anew(FILE *out, ss_reader *reader, const ss_plot_opts *opts)
{
    assert_int_equal(ss_reader_rewind(reader, NULL), SS_OK);
    return ss_plot_signal(out, reader, NULL, 0, opts, NULL);
}

static void
signals_with_long_names_are_drawn(void **state)
{
    const char *const name[] = { longest, control };
    (void)state;
    for (int i = 0; i < 2; i++) {
        ss_signal *signal = signal_named(name[i]);
        ss_coefficients *c = transform(signal, 0);
        ss_plot_opts titled, output;
        ss_contour_opts contour;
        FILE *out = tmpfile();
        ss_error err = new_error();
        ss_reader *reader;
        assert_int_equal(ss_reader_of_signal(&reader, signal, &err), SS_OK);
        ss_plot_opts_init(&titled, sizeof titled);
        ss_plot_opts_init(&output, sizeof output);
        ss_contour_opts_init(&contour, sizeof contour);
        titled.title = name[i];
        contour.signal = signal;
        assert_int_equal(draw_anew(out, reader, NULL), SS_OK);
        assert_int_equal(draw_anew(out, reader, &titled), SS_OK);
        assert_int_equal(ss_plot_xy(out, reader, 0, 1, &titled, NULL), SS_OK);
        assert_told(ss_plot_contour(out, c, &contour, &titled, &err), &err);
        output.output = name[i];
        assert_int_equal(ss_reader_rewind(reader, NULL), SS_OK);
        assert_fails(ss_plot_signal(out, reader, NULL, 0, &output, &err), &err);
        assert_int_equal(ss_reader_rewind(reader, NULL), SS_OK);
        output.format = name[i];
        assert_fails(ss_plot_signal(out, reader, NULL, 0, &output, &err), &err);
        ss_coefficients_free(c);
        ss_reader_free(reader);
        ss_signal_free(signal);
        fclose(out);
    }
}

static void
paths_of_10000_letters_are_refused(void **state)
{
    const char *const name[] = { longest, control };
    static char place[sizeof longest + 4096];
    ss_signal *signal = signal_named("x"), *read = NULL;
    ss_coefficients *c = NULL;
    ss_scene scene;
    (void)state;
    assert_int_equal(ss_record_write(&(ss_record){ .signal = signal }, NULL, path, SS_H5, NULL), SS_OK);
    for (int i = 0; i < 2; i++) {
        ss_error err = new_error();
        assert_fails(ss_signal_read(&read, NULL, name[i], NULL, &err), &err);
        snprintf(place, sizeof place, "%s:/%s", path, name[i]);
        assert_fails(ss_signal_read(&read, NULL, place, NULL, &err), &err);
        assert_fails(ss_coefficients_read(&c, NULL, name[i], &err), &err);
        assert_fails(ss_record_write(&(ss_record){ .signal = signal }, NULL, name[i], SS_H5, &err), &err);
        assert_fails(ss_scene_read(&scene, NULL, name[i], NULL, 0, &err), &err);
    }
    ss_signal_free(signal);
}

/* Names of files in messages, and text that is one long word. */
static void
readers_stand_long_words_in_files_of_long_names(void **state)
{
    const char *const name[] = { longest, control };
    static const char *const before[] = { "", "# stickslip signal 1\n# columns: ", "# stickslip sweep 1\n# columns: ",
        "# stickslip features 1\n", "# stickslip events 1\n", "# stickslip coefficients 1\n# ", "mass = ",
        "# stickslip sweep 1\n# vary: ", "t," };
    (void)state;
    for (size_t i = 0; i < 2 * sizeof before / sizeof *before; i++) {
        FILE *in = tmpfile();
        const char *word = name[i % 2];
        ss_scene scene;
        ss_signal *signal = NULL;
        ss_coefficients *c = NULL;
        ss_table *table = NULL;
        ss_overlay *overlay = NULL, *events = NULL;
        ss_error err = new_error();
        fprintf(in, "%s%s\n%s\n", before[i / 2], word, word);
        rewind(in);
        assert_fails(ss_scene_read(&scene, in, word, NULL, 0, &err), &err);
        rewind(in);
        assert_told(ss_signal_read(&signal, in, word, NULL, &err), &err);
        rewind(in);
        assert_fails(ss_coefficients_read(&c, in, word, &err), &err);
        rewind(in);
        assert_told(ss_table_read(&table, in, word, SS_KIND_SWEEP, &err), &err);
        rewind(in);
        assert_told(ss_overlay_read(&overlay, in, word, SS_KIND_FEATURES, &err), &err);
        rewind(in);
        assert_told(ss_overlay_read(&events, in, word, SS_KIND_EVENTS, &err), &err);
        ss_signal_free(signal);
        ss_table_free(table);
        ss_overlay_free(overlay);
        ss_overlay_free(events);
        fclose(in);
    }
}

static void
keys_and_options_of_10000_letters_are_refused(void **state)
{
    const char *const name[] = { longest, control };
    ss_signal *signal = signal_named("x"), *read = NULL;
    (void)state;
    for (int i = 0; i < 2; i++) {
        char setting[LETTERS + 20];
        const char *const set[] = { setting };
        ss_scene scene = read_shipped_named("coulomb");
        ss_sim_opts sim;
        ss_sim_opts_init(&sim, sizeof sim);
        ss_steady steady;
        ss_steady_opts opts;
        ss_steady_opts_init(&opts, sizeof opts);
        ss_read_opts timed = { READ_OPTS, .time = name[i] };
        ss_axis axis;
        ss_error err = new_error();
        assert_true(isnan(ss_scene_get(&scene, name[i])));
        assert_told(ss_scene_set(&scene, name[i], 1, &err), &err);
        snprintf(setting, sizeof setting, "%s=1", name[i]);
        assert_fails(ss_scene_read(&scene, NULL, "coulomb", set, 1, &err), &err);
        snprintf(setting, sizeof setting, "mass=%s", name[i]);
        assert_fails(ss_scene_read(&scene, NULL, "coulomb", set, 1, &err), &err);
        snprintf(setting, sizeof setting, "model=%s", name[i]);
        assert_fails(ss_scene_read(&scene, NULL, "coulomb", set, 1, &err), &err);
        snprintf(setting, sizeof setting, "%s=1:2:3", name[i]);
        assert_fails(ss_axis_parse(&axis, setting, &err), &err);
        assert_fails(ss_axis_parse(&axis, name[i], &err), &err);
        sim.method = name[i];
        assert_fails(ss_sim_run(&scene, &sim, NULL, &err), &err);
        opts.method = name[i];
        assert_fails(ss_steady_find(&steady, &scene, &opts, &err), &err);
        assert_int_equal(ss_header_column(signal->head, name[i]), -1);
        assert_null(ss_header_find_note(signal->head, name[i]));
        FILE *in = tmpfile();
        fputs("t,x\n0,1\n1,2\n", in);
        rewind(in);
        assert_fails(ss_signal_read(&read, in, "in", &timed, &err), &err);
        fclose(in);
    }
    ss_signal_free(signal);
}

/* A sweep of a scene of such a name, and a map of columns of such names. */
static void
sweeps_keep_long_names(void **state)
{
    (void)state;
    const ss_scene scene = read_shipped_named("coulomb");
    const ss_measure measure[] = { SS_AMPLITUDE };
    ss_axis axis;
    assert_int_equal(ss_axis_parse(&axis, "mass=1:2:2", NULL), SS_OK);
    ss_steady_opts how;
    ss_steady_opts_init(&how, sizeof how);
    ss_sweep_opts opts = { .size = sizeof opts, .steady = &how, .axis = &axis, .n_axes = 1, .shards = 1,
                           .threads = 1 };
    char *text = NULL;
    size_t size;
    ss_sweep_done done;
    how.measures = 1u << SS_AMPLITUDE;
    FILE *written = open_memstream(&text, &size);
    const ss_sweep_text named = { longest, &scene, &opts, measure, 1, SS_TSV };
    assert_int_equal(ss_sweep_write(&named, written, NULL, &done, NULL), SS_OK);
    fclose(written);
    assert_int_equal(done.rows, 2);
    assert_non_null(strstr(text, longest));
    free(text);
    FILE *in = tmpfile(), *out = tmpfile();
    fprintf(in, "# stickslip sweep 1\n# scene: %s\n# columns: index %s/%s y/m z%s status\n", longest, longest,
            longest, longest);
    for (int i = 0; i < 4; i++)
        fprintf(in, "%d\t%d\t%d\t%d\tok\n", i, i / 2, i % 2, i * i);
    rewind(in);
    ss_table *table = NULL;
    ss_error err = new_error();
    if (ss_table_read(&table, in, "in", SS_KIND_SWEEP, &err) != SS_OK)
        fail_msg("%.300s", err.text);
    assert_string_equal(ss_table_note(table, "scene"), longest);
    assert_string_equal(table->column[1].name, longest);
    assert_int_equal(ss_plot_sweep(out, table, (const size_t[]){ 1, 2, 3 }, 3, NULL, &err), SS_OK);
    ss_table_free(table);
    fclose(in);
    fclose(out);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signals_keep_long_names_in_every_form),
        cmocka_unit_test(coefficients_have_a_long_unit_whole),
        cmocka_unit_test(signals_with_long_names_are_drawn),
        cmocka_unit_test(paths_of_10000_letters_are_refused),
        cmocka_unit_test(readers_stand_long_words_in_files_of_long_names),
        cmocka_unit_test(keys_and_options_of_10000_letters_are_refused),
        cmocka_unit_test(sweeps_keep_long_names),
    };
    return cmocka_run_group_tests_name("long names", tests, make_names, remove_dir);
}
