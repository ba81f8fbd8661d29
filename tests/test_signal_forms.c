/* test_signal_forms.c -- a signal comes back from each of its forms; malformed input is refused in
 * clear words. */
#include <stickslip/store.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>
#include "signal/noise.h"
#include "signal_text.h"

/* --- our own forms ---------------------------------------------------------------------- */

static void
au_is_not_written_where_it_would_not_be_read(void **state)
{
    enum { CHANNELS = 4096, ROOM = 1 << 20 };
    static char note[ROOM];
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_writer *writer;
    ss_signal *back;
    (void)state;
    for (int i = 0; i < CHANNELS; i++)
        ss_header_add_column(head, "a", NULL, NULL);
    FILE *f = tmpfile();
    assert_int_equal(ss_writer_new(&writer, f, NULL, SS_AU, &(ss_contents){ .signal = head }, NULL), SS_OK);
    ss_writer_end(writer, 0, NULL);
    ss_writer_free(writer);
    rewind(f);
    assert_int_equal(ss_signal_read(&back, f, "in", NULL, NULL), SS_OK);
    assert_int_equal(back->head->n_columns, CHANNELS);
    ss_signal_free(back);
    fclose(f);
    f = tmpfile();
    ss_header_add_column(head, "a", NULL, NULL);
    assert_int_equal(ss_writer_new(&writer, f, NULL, SS_AU, &(ss_contents){ .signal = head }, NULL), SS_EINVAL);
    ss_header_free(head);
    ss_header_new(&head, 1, 0, NULL);
    ss_header_add_column(head, "a", NULL, NULL);
    memset(note, 'x', sizeof note - 1);
    ss_header_note(head, "long", note, NULL);
    assert_int_equal(ss_writer_new(&writer, f, NULL, SS_AU, &(ss_contents){ .signal = head }, NULL), SS_EINVAL);
    assert_int_equal(ftell(f), 0);              /* nothing was written */
    assert_int_equal(ss_writer_new(&writer, f, NULL, SS_TSV, &(ss_contents){ .signal = head }, NULL), SS_OK);
    ss_writer_free(writer);
    ss_header_free(head);
    fclose(f);
}

static void
text_labels_in_latin_1_become_utf_8(void **state)
{
    ss_signal *s = read_text("# stickslip signal 1\n# who: J\xfcrg\n# rate: 1\n# columns: Weg/\xb5m\n1\n", NULL);
    (void)state;
    assert_string_equal(s->head->column[0].unit, "\xc2\xb5m");
    assert_string_equal(ss_header_find_note(s->head, "who"), "J\xc3\xbcrg");
    ss_signal_free(s);
}

static void
assert_same_header(const ss_header *a, const ss_header *b)
{
    assert_true(a->rate == b->rate && a->start == b->start && a->has_time == b->has_time);
    assert_int_equal(a->n_columns, b->n_columns);
    assert_int_equal(a->n_notes, b->n_notes);
    for (size_t i = 0; i < a->n_columns; i++) {
        assert_string_equal(a->column[i].name, b->column[i].name);
        assert_string_equal(a->column[i].unit, b->column[i].unit);
    }
    for (size_t i = 0; i < a->n_notes; i++)
        assert_string_equal(a->note[i], b->note[i]);
}

/* Write and read a signal of the hardest values. */
static void
come_back_the_same(ss_format format, int has_time, size_t n)
{
    static const double hard[] = { 0, -0.0, 4.9406564584124654e-324, DBL_MAX, -DBL_MIN, 1. / 3, 1e23,
                                   0.1, -1e-7, 123456789 };
    ss_header *head = sample_header();
    ss_signal *one, *two = NULL;
    ss_error err = { 0 };
    head->has_time = has_time;
    assert_int_equal(ss_signal_new(&one, head, n, NULL), SS_OK);
    ss_header_free(head);
    for (size_t i = 0; i < n * one->head->n_columns; i++)
        one->values[i] = hard[i % 10] * (i < 10 ? 1 : cos((double)i));
    FILE *f = tmpfile();
    assert_int_equal(ss_record_write(&(ss_record){ .signal = one }, f, NULL, format, NULL), SS_OK);
    rewind(f);
    if (ss_signal_read(&two, f, "in", NULL, &err) != SS_OK)
        fail_msg("%s", err.text);
    fclose(f);
    assert_same_header(one->head, two->head);
    assert_int_equal(one->n, two->n);
    assert_memory_equal(one->values, two->values, n * one->head->n_columns * sizeof(double));
    ss_signal_free(one);
    ss_signal_free(two);
}

static void
text_and_au_come_back_the_same(void **state)
{
    static const size_t rows[] = { 0, 1, 2, 10000 };
    (void)state;
    for (size_t i = 0; i < 4; i++)
        for (int has_time = 0; has_time < 2; has_time++) {
            come_back_the_same(SS_TSV, has_time, rows[i]);
            come_back_the_same(SS_AU, has_time, rows[i]);
        }
}

static void
reads_text_as_others_write_it(void **state)
{
    ss_signal *s = read_text("# stickslip signal 1\r\n# a comment\n# columns: t/s x/m  v/(m/s)\n"
                             "#rate:10\n# start: 1\n1 1 2\n# between\n\n1.1000000001\t3  4\t\r\n"
                             "1.2\t5\t6", NULL);
    (void)state;
    assert_int_equal(s->n, 3);
    assert_true(s->head->rate == 10 && s->head->start == 1 && s->head->has_time);
    assert_string_equal(s->head->column[1].unit, "m/s");
    assert_true(s->values[0] == 1 && s->values[2] == 5 && s->values[3] == 2 && s->values[5] == 6);
    ss_signal_free(s);
}

static void
reads_a_line_of_any_length(void **state)
{
    enum { COLUMNS = 5000 };
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_signal *one, *two;
    ss_error err = { 0 };
    char name[16];
    (void)state;
    head->column = malloc(COLUMNS * sizeof *head->column);
    for (int i = 0; i < COLUMNS; i++) {
        snprintf(name, sizeof name, "c%d", i);
        head->column[i] = (ss_column){ strdup(name), strdup("m") };
    }
    head->n_columns = COLUMNS;
    one = calloc(1, sizeof *one);
    one->head = head;
    one->n = 1;
    one->values = malloc(COLUMNS * sizeof *one->values);
    for (int i = 0; i < COLUMNS; i++)
        one->values[i] = 1. / (i + 3);
    FILE *f = tmpfile();
    assert_int_equal(ss_record_write(&(ss_record){ .signal = one }, f, NULL, SS_TSV, NULL), SS_OK);
    rewind(f);
    assert_int_equal(ss_signal_read(&two, f, "in", NULL, &err), SS_OK);
    assert_int_equal(two->head->n_columns, COLUMNS);
    assert_memory_equal(one->values, two->values, COLUMNS * sizeof(double));
    fclose(f);
    ss_signal_free(one);
    ss_signal_free(two);
}

/* A pipe that has delivered one row must not be waited on for the next. */
static void
gives_what_a_slow_pipe_has_delivered(void **state)
{
    static const char first[] = "# stickslip signal 1\n# rate: 10\n# columns: t/s x\n0\t1\n0.1";
    int fd[2];
    double row[16], *column = row;
    size_t n;
    ss_reader *reader;
    (void)state;
    assert_int_equal(pipe(fd), 0);
    assert_int_equal(write(fd[1], first, strlen(first)), strlen(first));
    FILE *in = fdopen(fd[0], "r");
    assert_int_equal(ss_reader_new(&reader, in, "in", NULL, NULL), SS_OK);
    assert_int_equal(ss_reader_piece(reader), 4096);
    assert_int_equal(ss_reader_rows(reader, &column, 16, &n, NULL), SS_OK);
    assert_true(n == 1 && row[0] == 1);
    assert_int_equal(write(fd[1], "\t2\n", 3), 3);
    assert_int_equal(ss_reader_rows(reader, &column, 16, &n, NULL), SS_OK);
    assert_true(n == 1 && row[0] == 2);
    close(fd[1]);
    assert_int_equal(ss_reader_rows(reader, &column, 16, &n, NULL), SS_OK);
    assert_int_equal(n, 0);
    ss_reader_free(reader);
    fclose(in);
}

static void
reads_a_stream_without_a_descriptor(void **state)
{
    static char text[] = "# stickslip signal 1\n# rate: 10\n# columns: t/s x\n0\t1\n0.1\t7\n";
    ss_signal *s;
    FILE *in = fmemopen(text, strlen(text), "r");
    (void)state;
    assert_int_equal(ss_signal_read(&s, in, "in", NULL, NULL), SS_OK);
    assert_true(s->n == 2 && s->values[1] == 7);
    ss_signal_free(s);
    fclose(in);
}

static void
reports_a_full_disk(void **state)
{
    ss_signal *s;
    FILE *out = fopen("/dev/full", "w");
    (void)state;
    if (out == NULL) {
        print_message("skipped: there is no /dev/full\n");
        skip();
    }
    assert_int_equal(ss_wave_new(&s, SS_SINE, &ss_wave_defaults, NULL), SS_OK);
    assert_int_equal(ss_record_write(&(ss_record){ .signal = s }, out, NULL, SS_TSV, NULL), SS_EIO);
    ss_signal_free(s);
    fclose(out);
}

/* --- AU of others -------------------------------------------------------------------------- */

#define AU(size, encoding, channels) \
    ".snd\0\0\0\x1c" size "\0\0\0" encoding "\0\0\x1f\x40\0\0\0" channels "note"
#define SIZE_UNKNOWN "\xff\xff\xff\xff"
#define BYTES(text) text, sizeof text - 1

static void
reads_every_au_encoding(void **state)
{
    static const struct { const char *bytes; size_t n; double first, second; } row[] = {
        { BYTES(AU(SIZE_UNKNOWN, "\2", "\1") "\x40\x80"), 0.5, -1 },
        { BYTES(AU(SIZE_UNKNOWN, "\3", "\1") "\x7f\xff\xff\xff"), 32767. / 32768, -1. / 32768 },
        { BYTES(AU(SIZE_UNKNOWN, "\4", "\1") "\x20\0\0\x80\0\1"), 0.25, -1 + 1. / 8388608 },
        { BYTES(AU(SIZE_UNKNOWN, "\5", "\1") "\0\0\0\1\xc0\0\0\0"), 1. / 2147483648, -0.5 },
        { BYTES(AU(SIZE_UNKNOWN, "\6", "\1") "\x3f\xc0\0\0\xc2\xf6\xe9\x79"), 1.5, (float)-123.456 },
        { BYTES(AU(SIZE_UNKNOWN, "\7", "\1") "\x3f\xb9\x99\x99\x99\x99\x99\x9a\xff\xef\xff\xff\xff\xff"
                "\xff\xff"), 0.1, -DBL_MAX },
        { BYTES(AU("\0\0\0\2", "\2", "\1") "\x40\x80"), 0.5, -1 },
        { BYTES(AU("\0\0\0\0", "\2", "\1") "\x40\x80"), 0.5, -1 },      /* never filled in */
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *s;
        ss_error err = { 0 };
        if (read_bytes(&s, row[i].bytes, row[i].n, NULL, &err) != SS_OK)
            fail_msg("row %zu: %s", i, err.text);
        assert_int_equal(s->n, 2);
        assert_true(s->head->rate == 8000 && s->head->start == 0 && s->head->n_columns == 1);
        assert_string_equal(s->head->column[0].name, "ch1");
        assert_true(s->values[0] == row[i].first && s->values[1] == row[i].second);
        ss_signal_free(s);
    }
}

/* --- malformed input ----------------------------------------------------------------------- */

#define NO_CLOCK "in: no column of time"
static const struct { const char *bytes; size_t n; const char *error; } malformed[] = {
    { BYTES(""), "in: empty" },
    { BYTES("RIFF....WAVE"), "in: truncated WAV header" },
    { BYTES("fLaC........"), "in: a sound file, not a signal; sox FILE -t au - makes a signal of it" },
    { BYTES("\211HDF\r\n\032\n...."), "in: HDF5 cannot be read from a stream; give its path" },
    { BYTES("# stickslip coefficients 1\n"), "in: wavelet coefficients, not a signal" },
    { BYTES("# stickslip signal 2\n"), "in:1: not a signal, of which the first line is '# stickslip signal 1'" },
    { BYTES("# stickslip signal 1\n"), "in:1: no '# columns:' line in the header" },
    { BYTES("# stickslip signal 1\n# columns: t/s\n"), "in:2: no column but time" },
    { BYTES("# stickslip signal 1\n# columns: t/s x\n0\t1\n"), "in:2: no '# rate:' line in the header" },
    { BYTES("# stickslip signal 1\n# rate: -1\n"), "in:2: the rate is not a number above 0" },
    { BYTES("# stickslip signal 1\n# start: x\n"), "in:2: the start is not a number" },
    { BYTES(HEAD "0\t1\t2\n0.1\t1\n"), "in:5: expected 3 columns, found 2" },
    { BYTES(HEAD "0\t1\t2\n0.1\t1\t2\t3\n"), "in:5: expected 3 columns, found 4" },
    { BYTES(HEAD "0\t1\tx2\n"), "in:4: column v: 'x2' is not a finite number" },
    { BYTES(HEAD "0\t1\t0x2\n"), "in:4: column v: '0x2' is not a finite number" },
    { BYTES(HEAD "0\tnan\t1\n"), "in:4: column x: 'nan' is not a finite number" },
    { BYTES(HEAD "0\t-inf\t1\n"), "in:4: column x: '-inf' is not a finite number" },
    { BYTES(HEAD "0\t1e999\t1\n"), "in:4: column x: '1e999' is not a finite number" },
    { BYTES(HEAD "0\t1\t2\0\n"), "in:4: a NUL byte in text" },
    { BYTES(HEAD "0\t1\t2\n0.2\t1\t2\n"), "in:5: time is 0.2, expected start + 1 / rate = 0.1" },
    { BYTES("t,x\n0,1\n0.1,2,3\n"), "in:3: expected 2 columns, found 3" },
    { BYTES("t,x\n0,1\n0.1,\n"), "in:3: column x: '' is not a number" },
    { BYTES("t,x\n0,1\n0.1,abc\n"), "in:3: column x: 'abc' is not a number" },
    { BYTES("t,x\n0,abc\n0.1,1\n"), "in:2: column 2: 'abc' is not a number" },
    { BYTES("t,x\n0,1\n0.1,NaN\n"), "in:3: column x: 'NaN' is not a finite number" },
    { BYTES("t,x\n0,nan\n0.1,1\n"), "in:2: column x: 'nan' is not a finite number" },
    { BYTES("t,x\n0,1\n0.1,1e999\n"), "in:3: column x: '1e999' is not a finite number" },
    { BYTES("t,x\n0,1\n0.1,1\0\n"), "in:3: a NUL byte: this is not text of 8-bit "
      "characters (iconv -f UTF-16 -t UTF-8 makes it of UTF-16)" },
    { BYTES("hello\nworld\n"), "in:2: no row of numbers up to here; a table has them "
      "between commas, semicolons, tabs or blanks" },
    { BYTES("t,x\n0,1\n"), "in: one row has no sample rate" },
    { BYTES("t\n0\n1\n"), "in: no column but time" },
    { BYTES("t,x\n0,1\n0,1\n"), "in:3: time stamps do not ascend: this one is that of the row above" },
    { BYTES("elapsed (s),x\n0,1\n2,1\n1,1\n0,1\n"), "in:4: time stamps do not ascend: this one is before that of the row above" },
    { BYTES("t (furlong),x\n0,1\n1,1\n"), "in: column t: unit 'furlong' is not one of time" },
    { BYTES("x,y\n3,1\n1,1\n"), NO_CLOCK },
    { BYTES("deflection,force\n1,1\n2,1\n3,1\n"), NO_CLOCK },  /* ascends, but is no time */
    { BYTES("deflection (mm),force\n1,1\n2,1\n3,1\n"), NO_CLOCK },
    { BYTES("1\n2\n3\n"), NO_CLOCK },
    { BYTES("t;x\n0.5;1,234\n1;2\n"),
      "in:2: column x: '1,234' has a decimal comma, numbers before it have a point" },
    { BYTES("t;x\n0;1,5\n1;2\n1.5;2,5\n"),
      "in:4: column t: '1.5' has a decimal point, numbers before it have a comma" },
    { BYTES("t,x\n0,1\n1,1\n2,1\n4,1\n5,1\n6,1\n"), "in:5: 1 sample is missing before this time stamp" },
    { BYTES(".snd\0\0\0\x18"), "in: truncated AU header" },
    { BYTES(".snd\0\0\0\x17" SIZE_UNKNOWN "\0\0\0\7\0\0\0\1\0\0\0\1"),
      "in: AU header: impossible offset of the data, 23" },
    { BYTES(".snd\xf0\0\0\0" SIZE_UNKNOWN "\0\0\0\7\0\0\0\1\0\0\0\1"),
      "in: AU header: impossible offset of the data, 4026531840" },
    { BYTES(".snd\0\0\0\x20" SIZE_UNKNOWN "\0\0\0\7\0\0\0\1\0\0\0\1"), "in: truncated AU annotation" },
    { BYTES(".snd\0\0\0\x18" SIZE_UNKNOWN "\0\0\0\7\0\0\0\1\0\0\0\0"),
      "in: AU header: impossible: 0 channels at 1 Hz" },
    { BYTES(".snd\0\0\0\x18" SIZE_UNKNOWN "\0\0\0\7\0\0\0\1\xff\xff\xff\xff"),
      "in: AU header: impossible: 4294967295 channels at 1 Hz" },
    { BYTES(".snd\0\0\0\x18" SIZE_UNKNOWN "\0\0\0\7\0\0\0\0\0\0\0\1"),
      "in: AU header: impossible: 1 channels at 0 Hz" },
    { BYTES(AU(SIZE_UNKNOWN, "\1", "\1")), "in: AU encoding 1 is not supported; 2 to 7 are (PCM of 8 to "
      "32 bits, floating point)" },
    { BYTES(AU(SIZE_UNKNOWN, "\3", "\2") "\0\1\0\2\0"), "in: truncated: 1 of 4 bytes of row 2" },
    { BYTES(AU("\0\0\0\x9", "\3", "\1") "\0\1\0\2"),
      "in: truncated: ends after row 2, 5 bytes before the end that its header gives" },
    { BYTES(AU("\0\0\0\2", "\2", "\1") "\x40\x80 and more"),
      "in: goes on after the 2 rows that its header gives; head -c 30 cuts it there" },
    { BYTES(AU("\0\0\0\3", "\3", "\1") "\0\1\0\2"), "in: truncated: 1 of 2 bytes of row 2" },
    { BYTES(AU(SIZE_UNKNOWN, "\6", "\1") "\0\0\0\0\x7f\xc0\0\0"),
      "in: row 2, column ch1: not a finite number" },
};

static void
says_what_is_wrong_with_malformed_input(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof malformed / sizeof *malformed; i++) {
        ss_signal *s = NULL;
        ss_error err = { 0 };
        ss_status st = read_bytes(&s, malformed[i].bytes, malformed[i].n, NULL, &err);
        if (st < SS_EDATA || st > SS_EUNEVEN || strcmp(err.text, malformed[i].error) != 0)
            fail_msg("status %d, '%s' instead of '%s'", st, err.text, malformed[i].error);
        assert_null(s);
        assert_int_equal(read_bytes(&s, malformed[i].bytes, malformed[i].n, NULL, NULL), st);
    }
}

/* What may help: a program decides by it what to suggest. */
static void
status_says_what_may_help(void **state)
{
    static const struct { const char *text; ss_status status; } row[] = {
        { "# stickslip features 1\n", SS_EKIND }, { "x,y\n3,1\n2,1\n", SS_ECLOCK },
        { "t,x\n0,1\n", SS_ECLOCK }, { "t,x\n0,1\n0.1,\n", SS_EGAPS },
        { "t,x\n0,1\n1,1\n2,1\n3,1\n5,1\n", SS_EGAPS }, { "t,x\n0,1\n2,1\n1,1\n", SS_ECLOCK },
        { "t,x\n0,1\n1,1\n2,1\n3.4,1\n4.4,1\n", SS_EUNEVEN }, { "t,x\n0,1\n1,a\n", SS_EDATA },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *s = NULL;
        assert_int_equal(read_bytes(&s, row[i].text, strlen(row[i].text), NULL, NULL), row[i].status);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(au_is_not_written_where_it_would_not_be_read),
        cmocka_unit_test(text_labels_in_latin_1_become_utf_8),
        cmocka_unit_test(text_and_au_come_back_the_same),
        cmocka_unit_test(reads_text_as_others_write_it),
        cmocka_unit_test(reads_a_line_of_any_length),
        cmocka_unit_test(gives_what_a_slow_pipe_has_delivered),
        cmocka_unit_test(reads_a_stream_without_a_descriptor),
        cmocka_unit_test(reports_a_full_disk),
        cmocka_unit_test(reads_every_au_encoding),
        cmocka_unit_test(says_what_is_wrong_with_malformed_input),
        cmocka_unit_test(status_says_what_may_help),
    };
    return cmocka_run_group_tests_name("signal forms", tests, NULL, NULL);
}
