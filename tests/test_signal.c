/* test_signal.c -- signals: headers, their three forms, clocks, benchmark signals, noise. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <cmocka.h>
#include <stickslip/signal.h>

/* A file that holds these bytes, at its start. */
static FILE *
file_of(const void *bytes, size_t n)
{
    FILE *f = tmpfile();
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    rewind(f);
    return f;
}

static ss_status
read_bytes(ss_signal **out, const void *bytes, size_t n, const ss_read_opts *opts, ss_error *err)
{
    FILE *f = file_of(bytes, n);
    ss_status st = ss_signal_read(out, f, "in", opts, err);
    fclose(f);
    return st;
}

static ss_signal *
read_text(const char *text, const ss_read_opts *opts)
{
    ss_signal *signal = NULL;
    ss_error err = { "" };
    if (read_bytes(&signal, text, strlen(text), opts, &err) != SS_OK)
        fail_msg("%s: %s", text, err.text);
    return signal;
}

/* --- headers ------------------------------------------------------------------------------- */

static ss_header *
sample_header(void)
{
    ss_header *head = ss_header_new(1000. / 3, -0.1);
    assert_int_equal(ss_header_add_column(head, "x", "m"), SS_OK);
    assert_int_equal(ss_header_add_column(head, "v", "m/s"), SS_OK);
    assert_int_equal(ss_header_add_column(head, "c", "N s"), SS_OK);
    assert_int_equal(ss_header_add_column(head, "f", ""), SS_OK);
    assert_int_equal(ss_header_add_column(head, "(odd", "(a b)/(c)"), SS_OK);
    assert_int_equal(ss_header_note(head, "scene", "a test: it has a colon"), SS_OK);
    return head;
}

static void
finds_columns_by_name_and_number(void **state)
{
    ss_header *head = sample_header();
    (void)state;
    ss_header_add_column(head, "2", "");
    ss_header_add_column(head, "Channel A", "");
    ss_header_add_column(head, "force", "");
    ss_header_add_column(head, "FORCE", "");
    ss_header_add_column(head, "9 lives", "");
    assert_int_equal(ss_header_column(head, "Channel A"), 6);   /* as its file has it */
    assert_int_equal(ss_header_column(head, "Channel_A"), 6);
    assert_int_equal(ss_header_column(head, "channel a"), 6);
    assert_int_equal(ss_header_column(head, "channel"), -1);
    assert_int_equal(ss_header_column(head, "FORCE"), 8);
    assert_int_equal(ss_header_column(head, "Force"), -1);      /* which? */
    assert_int_equal(ss_header_column(head, "X"), -1);          /* X and x may be two quantities */
    assert_int_equal(ss_header_column(head, "9 lives"), 9);
    assert_int_equal(ss_header_column(head, "x"), 0);
    assert_int_equal(ss_header_column(head, "3"), 2);
    assert_int_equal(ss_header_column(head, "2"), 5);           /* a name goes before a number */
    assert_int_equal(ss_header_column(head, "0"), -1);
    assert_int_equal(ss_header_column(head, "11"), -1);
    assert_int_equal(ss_header_column(head, "1x"), -1);
    assert_int_equal(ss_header_column(head, ""), -1);
    ss_header_free(head);
}

static void
cleans_names_and_units(void **state)
{
    ss_header *head = ss_header_new(1, 0);
    (void)state;
    assert_int_equal(ss_header_add_column(head, "", ""), SS_EINVAL);
    ss_header_add_column(head, "a b/c", NULL);
    ss_header_add_column(head, "a b/c", "m)(");
    ss_header_add_column(head, "a b/c", "1");
    assert_string_equal(head->column[0].name, "a_b_c");
    assert_string_equal(head->column[1].name, "a_b_c_2");
    assert_string_equal(head->column[2].name, "a_b_c_3");
    assert_string_equal(head->column[1].unit, "m  ");
    ss_header_free(head);
}

static void
numbers_the_same_name_by_what_is_free(void **state)
{
    static const char *const given[] = { "a", "a_3", "a", "a", "a_2", "a_x", "a_99999999999999999999", "a" };
    static const char *const got[] = { "a", "a_3", "a_2", "a_4", "a_2_2", "a_x", "a_99999999999999999999",
                                       "a_5" };
    ss_header *head = ss_header_new(1, 0);
    (void)state;
    for (size_t i = 0; i < sizeof given / sizeof *given; i++) {
        assert_int_equal(ss_header_add_column(head, given[i], NULL), SS_OK);
        assert_string_equal(head->column[i].name, got[i]);
    }
    ss_header_free(head);
}

static void
names_thousands_of_columns_alike(void **state)
{
    enum { COLUMNS = 30000, SECONDS = 60 };     /* it takes 2; each name anew from 2 on, hours */
    ss_header *head = ss_header_new(1, 0), *copy;
    clock_t begun = clock();
    (void)state;
    for (int i = 0; i < COLUMNS; i++) {
        assert_int_equal(ss_header_add_column(head, "a", NULL), SS_OK);
        assert_true(clock() - begun < SECONDS * CLOCKS_PER_SEC);
    }
    copy = ss_header_copy(head);
    assert_string_equal(copy->column[COLUMNS - 1].name, "a_30000");
    ss_header_free(copy);
    ss_header_free(head);
}

static void
au_is_not_written_where_it_would_not_be_read(void **state)
{
    enum { CHANNELS = 4096, ROOM = 1 << 20 };
    static char note[ROOM];
    ss_header *head = ss_header_new(1, 0);
    ss_writer *writer;
    ss_signal *back;
    (void)state;
    for (int i = 0; i < CHANNELS; i++)
        ss_header_add_column(head, "a", NULL);
    FILE *f = tmpfile();
    assert_int_equal(ss_writer_new(&writer, f, SS_AU, head), SS_OK);
    ss_writer_flush(writer);
    ss_writer_free(writer);
    rewind(f);
    assert_int_equal(ss_signal_read(&back, f, "in", NULL, NULL), SS_OK);
    assert_int_equal(back->head->n_columns, CHANNELS);
    ss_signal_free(back);
    fclose(f);
    f = tmpfile();
    ss_header_add_column(head, "a", NULL);
    assert_int_equal(ss_writer_new(&writer, f, SS_AU, head), SS_EINVAL);
    ss_header_free(head);
    head = ss_header_new(1, 0);
    ss_header_add_column(head, "a", NULL);
    memset(note, 'x', sizeof note - 1);
    ss_header_note(head, "long", note);
    assert_int_equal(ss_writer_new(&writer, f, SS_AU, head), SS_EINVAL);
    assert_int_equal(ftell(f), 0);              /* nothing was written */
    assert_int_equal(ss_writer_new(&writer, f, SS_TSV, head), SS_OK);
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
replaces_a_note_of_the_same_key(void **state)
{
    ss_header *head = sample_header();
    (void)state;
    ss_header_note(head, "noise", "some");
    ss_header_note(head, "scene", "two\nlines");
    assert_int_equal(head->n_notes, 2);
    assert_string_equal(ss_header_find_note(head, "scene"), "two lines");
    assert_string_equal(ss_header_find_note(head, "noise"), "some");
    assert_null(ss_header_find_note(head, "nois"));
    assert_int_equal(ss_header_note(head, "rate", "1"), SS_EINVAL);
    assert_int_equal(ss_header_note(head, "a:b", "1"), SS_EINVAL);
    assert_int_equal(ss_header_note(head, "", "1"), SS_EINVAL);
    ss_header_free(head);
}

static void
finds_the_row_of_a_time(void **state)
{
    ss_header *head = ss_header_new(1000, 2);
    (void)state;
    assert_int_equal(ss_header_row(head, 0), 0);
    assert_int_equal(ss_header_row(head, 2), 0);
    assert_int_equal(ss_header_row(head, 2.001), 1);
    assert_int_equal(ss_header_row(head, 2.0011), 2);
    assert_int_equal(ss_header_row(head, 2.3), 300);
    assert_true(ss_header_row(head, DBL_MAX) >= SIZE_MAX / 2);
    assert_int_equal(ss_header_row(head, -DBL_MAX), 0);
    ss_header_free(head);
}

/* --- both of our forms --------------------------------------------------------------------- */

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
    ss_error err = { "" };
    head->has_time = has_time;
    assert_int_equal(ss_signal_new(&one, head, n), SS_OK);
    ss_header_free(head);
    for (size_t i = 0; i < n * one->head->n_columns; i++)
        one->values[i] = hard[i % 10] * (i < 10 ? 1 : cos((double)i));
    FILE *f = tmpfile();
    assert_int_equal(ss_signal_write(one, f, format), SS_OK);
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
    ss_header *head = ss_header_new(1, 0);
    ss_signal *one, *two;
    ss_error err = { "" };
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
    assert_int_equal(ss_signal_write(one, f, SS_TSV), SS_OK);
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
    double row[16];
    size_t n;
    ss_reader *reader;
    (void)state;
    assert_int_equal(pipe(fd), 0);
    assert_int_equal(write(fd[1], first, strlen(first)), strlen(first));
    FILE *in = fdopen(fd[0], "r");
    assert_int_equal(ss_reader_new(&reader, in, "in", NULL, NULL), SS_OK);
    assert_int_equal(ss_reader_rows(reader, row, 16, &n, NULL), SS_OK);
    assert_true(n == 1 && row[0] == 1);
    assert_int_equal(write(fd[1], "\t2\n", 3), 3);
    assert_int_equal(ss_reader_rows(reader, row, 16, &n, NULL), SS_OK);
    assert_true(n == 1 && row[0] == 2);
    close(fd[1]);
    assert_int_equal(ss_reader_rows(reader, row, 16, &n, NULL), SS_OK);
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
    assert_int_equal(ss_signal_write(s, out, SS_TSV), SS_EIO);
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
        { BYTES(AU(SIZE_UNKNOWN, "\6", "\1") "\x3f\xc0\0\0\xc2\xf6\xe9\x79"), 1.5, -123.456f },
        { BYTES(AU(SIZE_UNKNOWN, "\7", "\1") "\x3f\xb9\x99\x99\x99\x99\x99\x9a\xff\xef\xff\xff\xff\xff"
                "\xff\xff"), 0.1, -DBL_MAX },
        { BYTES(AU("\0\0\0\2", "\2", "\1") "\x40\x80"), 0.5, -1 },
        { BYTES(AU("\0\0\0\0", "\2", "\1") "\x40\x80"), 0.5, -1 },      /* never filled in */
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *s;
        ss_error err = { "" };
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
#define HEAD "# stickslip signal 1\n# rate: 10\n# columns: t/s x/m v/(m/s)\n"
static const struct { const char *bytes; size_t n; const char *error; } malformed[] = {
    { BYTES(""), "in: empty" },
    { BYTES("RIFF....WAVE"), "in: truncated WAV header" },
    { BYTES("fLaC........"), "in: a sound file, not a signal; sox FILE -t au - makes a signal of it" },
    { BYTES("\211HDF\r\n\032\n...."), "in: HDF5 cannot be read from a stream; give its path" },
    { BYTES("# stickslip coefficients 1\n"), "in: wavelet coefficients, not a signal" },
    { BYTES("# stickslip signal 2\n"), "in:1: '# stickslip signal 2' is not '# stickslip signal 1'" },
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
    { BYTES("t,x\n0,1\n0.1,1\0\n"), "in:3: a NUL byte: this is not text of 8-bit characters" },
    { BYTES("hello\nworld\n"), "in:2: no row of numbers up to here; a table has them "
      "between commas, semicolons, tabs or blanks" },
    { BYTES("t,x\n0,1\n"), "in: one row has no sample rate" },
    { BYTES("t\n0\n1\n"), "in: no column but time" },
    { BYTES("t,x\n0,1\n0,1\n"), "in:3: time stamps do not ascend" },
    { BYTES("elapsed (s),x\n0,1\n2,1\n1,1\n0,1\n"), "in:4: time stamps do not ascend" },
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
        ss_error err = { "" };
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
        { "t,x\n0,1\n1,1\n2,1\n3,1\n5,1\n", SS_EGAPS }, { "t,x\n0,1\n2,1\n1,1\n", SS_EUNEVEN },
        { "t,x\n0,1\n1,1\n2,1\n3.4,1\n4.4,1\n", SS_EUNEVEN }, { "t,x\n0,1\n1,a\n", SS_EDATA },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        ss_signal *s = NULL;
        assert_int_equal(read_bytes(&s, row[i].text, strlen(row[i].text), NULL, NULL), row[i].status);
    }
}

/* --- delimited text ------------------------------------------------------------------------ */

static const struct table_case {
    const char *what, *text;
    const char *time;
    double rate;                                /* of the options */
    const char *names;                          /* name[unit], ... */
    double hz, start, last;                     /* last: of the last column and row */
} table[] = {
    { "comma", "t,x,y\n0,1,2\n0.1,3,4\n", NULL, 0, "x[] y[]", 10, 0, 4 },
    { "semicolon, decimal comma, CRLF, mark, units row", "\xef\xbb\xbfZeit;Kraft;Weg\r\ns;kN;mm\r\n"
      "0,00;1,5;2\r\n0,01;-2,5E-3;7,25\r\n", NULL, 0, "Kraft[kN] Weg[mm]", 100, 0, 7.25 },
    { "tab, decimal comma", "t\tx\n0,5\t1,5\n0,75\t2,5\n", NULL, 0, "x[]", 4, 0.5, 2.5 },
    { "tab, decimal point", "Time (s)\tx (m/s^2)\n0\t1\n0.5\t2", NULL, 0, "x[m/s^2]", 2, 0, 2 },
    { "blanks", "  t   x\n  0   1 \n  1   2 \n", NULL, 0, "x[]", 1, 0, 2 },
    { "commented names", "# t x\n0 1\n1 2\n", NULL, 0, "x[]", 1, 0, 2 },
    { "units in brackets", "t [ms],x [m/s],y/N,z/(N s)\n0,1,2,3\n2,1,2,5\n", NULL, 0,
      "x[m/s] y[N] z[N s]", 500, 0, 5 },
    { "units row in brackets", "t,x\n[ms],[m/s]\n1,2\n3,4\n", NULL, 0, "x[m/s]", 500, 0.001, 4 },
    { "units row with an empty cell", "t,mu,a\ns,,m/s\xc2\xb2\n1,2,3\n3,4,5\n", NULL, 0,
      "mu[] a[m/s\xc2\xb2]", 0.5, 1, 5 },
    { "words above", "Recorder;ACME\nRate;100\n\nA long line of words\nt;x\n0;1\n0,01;2\n", NULL, 0, "x[]", 100,
      0, 2 },
    { "quotes", "\"t\",\"force, \"\"raw\"\" (N)\"\n\"0\",\"1\"\n1,2\n", NULL, 0, "force,_\"raw\"[N]",
      1, 0, 2 },
    { "separators at the ends of lines", "t,x,\n0,1,\n1,2,\n", NULL, 0, "x[]", 1, 0, 2 },
    { "time is not the first", "x,Time (us)\n7,0\n8,10\n", NULL, 0, "x[]", 100000, 0, 8 },
    { "time by name", "x,t,clock\n7,0,3\n8,1,5\n", "clock", 0, "x[] t[]", 0.5, 3, 1 },
    { "time by number", "x,t,clock\n7,0,3\n8,1,5\n", "3", 0, "x[] t[]", 0.5, 3, 1 },
    { "time in its name", "time_ms,x\n0,1\n1,2\n", NULL, 0, "x[]", 1000, 0, 2 },
    { "time in minutes", "t [min],x\n0,1\n1,2\n", NULL, 0, "x[]", 1. / 60, 0, 2 },
    { "first column in seconds", "when (s),x\n0.25,1\n0.5,2\n0.75,3\n", NULL, 0, "x[]", 4, 0.25, 3 },
    { "no names", "0,1\n0.1,2\n", NULL, 0, "ch2[]", 10, 0, 2 },
    { "a rate given", "x,y\n5,1\n3,2\n4,9\n", NULL, 250, "x[] y[]", 250, 0, 9 },
    { "a rate given beats stamps", "t,y\n5,1\n3,2\n4,9\n", NULL, 250, "t[] y[]", 250, 0, 9 },
    { "one column", "Force (N)\n1.5\n\n2.5\n", NULL, 10, "Force[N]", 10, 0, 2.5 },
    { "comments and empty lines between", "t,x\n0,1\n# hello\n\n1,2\n", NULL, 0, "x[]", 1, 0, 2 },
    { "LabVIEW", "LabVIEW Measurement\nSeparator\tTab\nMulti_Headings\tNo\n***End_of_Header***\t\n\t\n"
      "Channels\t2\t\t\nY_Unit_Label\tNewton\tm/s^2\t\nX_Dimension\tTime\tTime\t\n"
      "X0\t0.0E+0\t0.0E+0\t\nDelta_X\t0.001\t0.001\t\n***End_of_Header***\t\t\t\n"
      "X_Value\tforce\taccel\tComment\r\n0.000\t1.5\t2.5\r\n0.001\t1.25\t2.25\r\n", NULL, 0,
      "force[] accel[]", 1000, 0, 2.25 },
    { "LabVIEW with a row of units", "X_Value\tforce\taccel\tcomment\ns\tN\tm/s^2\tComment\n0\t1\t2\n"
      "0.5\t3\t4\n", NULL, 0, "force[N] accel[m/s^2]", 2, 0, 4 },
    { "one empty name more", "t;x;\ns;mm;\n0;1\n0,5;2\n", NULL, 0, "x[mm]", 2, 0, 2 },
    { "Latin-1", "t/s;Weg/\xb5m;K\xfc" "bel (m/s\xb2)\n0;1;2\n1;2;3\n", NULL, 0,
      "Weg[\xc2\xb5m] K\xc3\xbc" "bel[m/s\xc2\xb2]", 1, 0, 3 },
    { "Latin-1 units row", "Zeit;Weg;\xe9t\xe9\ns;\xb5m;m/s\xb2\n0;1;2\n1;2;3\n", NULL, 0,
      "Weg[\xc2\xb5m] \xc3\xa9t\xc3\xa9[m/s\xc2\xb2]", 1, 0, 3 },
    { "UTF-8 of two to four bytes", "t,\xc2\xb5\xe2\x82\xac\xf0\x9f\x98\x80\n0,1\n1,2\n", NULL, 0,
      "\xc2\xb5\xe2\x82\xac\xf0\x9f\x98\x80[]", 1, 0, 2 },
    { "nearly UTF-8", "t,\xc0\xaf\xed\xa0\x80\n0,1\n1,2\n", NULL, 0,
      "\xc3\x80\xc2\xaf\xc3\xad\xc2\xa0\xc2\x80[]", 1, 0, 2 },
    { "the same name twice", "t,x,x\n0,1,2\n1,2,3\n", NULL, 0, "x[] x_2[]", 1, 0, 3 },
};

static void
reads_tables_as_recorders_write_them(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const struct table_case *c = &table[i];
        ss_read_opts opts = { .time = c->time, .rate = c->rate };
        ss_signal *s = read_text(c->text, &opts);
        char names[256] = "";
        for (size_t k = 0; k < s->head->n_columns; k++)
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s[%s]", k > 0 ? " " : "",
                     s->head->column[k].name, s->head->column[k].unit);
        if (strcmp(names, c->names) != 0)
            fail_msg("%s: columns %s, not %s", c->what, names, c->names);
        if (s->head->rate != c->hz || s->head->start != c->start)
            fail_msg("%s: %.17g Hz from %.17g s", c->what, s->head->rate, s->head->start);
        if (s->values[s->head->n_columns * s->n - 1] != c->last)
            fail_msg("%s: last value %.17g", c->what, s->values[s->head->n_columns * s->n - 1]);
        ss_signal_free(s);
    }
}

/* Stamps start + i / rate in the given printf format, each moved by a wobble in sample periods. */
static ss_status
read_stamps(double *hz, double rate, double start, size_t n, const char *format, double wobble)
{
    FILE *f = tmpfile();
    ss_signal *s;
    ss_error err;
    fputs("t,x\n", f);
    for (size_t i = 0; i < n; i++) {
        fprintf(f, format, start + ((double)i + (i % 2 ? wobble : -wobble)) / rate);
        fputs(",0\n", f);
    }
    rewind(f);
    ss_status st = ss_signal_read(&s, f, "in", NULL, &err);
    fclose(f);
    if (st == SS_OK) {
        *hz = s->head->rate;
        ss_signal_free(s);
    }
    return st;
}

static void
finds_the_exact_rate_behind_rounded_stamps(void **state)
{
    static const struct { double rate, start; size_t n; const char *format; } row[] = {
        { 1024, 0, 10241, "%.7g" }, { 1024, 0, 10241, "%.17g" }, { 50000, 91.181303, 10000, "%.6f" },
        { 2000, 94, 120000, "%.4f" }, { 44100, 0, 50000, "%.6f" }, { 1 / 0.003, 0, 3000, "%.4f" },
        { 1 / 0.007, 1e6, 3000, "%.3f" }, { 3, 0, 1000, "%.3f" }, { 1e6, 0, 1000, "%.9f" },
        { 0.001, 0, 100, "%g" }, { 25600, 0, 25600, "%.17g" }, { 1 / 60., 0, 50, "%.1f" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        double hz = 0;
        assert_int_equal(read_stamps(&hz, row[i].rate, row[i].start, row[i].n, row[i].format, 0), SS_OK);
        if (hz != row[i].rate)
            fail_msg("%.17g Hz in %s: %.17g Hz", row[i].rate, row[i].format, hz);
    }
}

static void
allows_stamps_a_tenth_of_a_period_off(void **state)
{
    double hz;
    (void)state;
    assert_int_equal(read_stamps(&hz, 100, 0, 1000, "%.17g", 0.099), SS_OK);
    assert_true(fabs(hz - 100) <= 100 * 2 * 0.1 / 999);        /* what the wobble leaves open */
    assert_int_equal(read_stamps(&hz, 100, 0, 1000, "%.17g", 0.101), SS_EUNEVEN);
}

static void
refuses_options_that_a_clock_excludes(void **state)
{
    ss_signal *s;
    ss_error err = { "" };
    const char *text = HEAD "0\t1\t2\n";
    (void)state;
    ss_read_opts rate = { .rate = 20 }, time = { .time = "x" }, same = { .rate = 10 };
    assert_int_equal(read_bytes(&s, text, strlen(text), &rate, &err), SS_EDATA);
    assert_int_equal(read_bytes(&s, text, strlen(text), &time, &err), SS_EDATA);
    ss_signal_free(read_text(text, &same));
    ss_signal_free(read_text("# stickslip signal 1\n# columns: x\n1\n", &same));
}

/* Copied from the README beside the recordings. */
static void
reads_the_measured_recordings(void **state)
{
    static const struct { const char *name; double rate, start; size_t n, columns; } row[] = {
        { "band_friction_damper_1hz_20lb.csv", 1024, 0, 10241, 3 },
        { "paper_friction_k168_v42.csv", 2000, 94, 120000, 1 },
        { "paper_friction_k168_v4300.csv", 2000, 0.9395, 7521, 1 },
        { "rock_labquake_fb03-087_event043.csv", 50000, 91.181303, 10000, 2 },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char path[128];
        ss_signal *s;
        ss_error err = { "" };
        snprintf(path, sizeof path, "../shared/data/measured/%s", row[i].name);
        FILE *f = fopen(path, "r");
        if (f == NULL) {
            print_message("skipped: no ../shared/data/measured\n");
            skip();
        }
        if (ss_signal_read(&s, f, path, NULL, &err) != SS_OK)
            fail_msg("%s", err.text);
        assert_true(s->head->rate == row[i].rate && s->head->start == row[i].start);
        assert_true(s->n == row[i].n && s->head->n_columns == row[i].columns);
        ss_signal_free(s);
        fclose(f);
    }
}

static void
selects_columns_and_rows(void **state)
{
    ss_signal *s = read_text("t,x,y\n1,1,2\n1.5,3,4\n2,5,6\n", NULL), *part;
    const size_t column[] = { 1, 0, 1 }, none[] = { 2 };
    (void)state;
    assert_int_equal(ss_signal_select(&part, s, column, 3, 1, 3), SS_OK);
    assert_true(part->n == 2 && part->head->start == 1.5 && part->head->n_columns == 3);
    assert_true(part->values[0] == 4 && part->values[1] == 6 && part->values[2] == 3);
    assert_string_equal(part->head->column[2].name, "y_2");
    ss_signal_free(part);
    assert_int_equal(ss_signal_select(&part, s, none, 1, 0, 1), SS_EINVAL);
    assert_int_equal(ss_signal_select(&part, s, column, 1, 0, 4), SS_EINVAL);
    assert_int_equal(ss_signal_select(&part, s, column, 1, 2, 1), SS_EINVAL);
    ss_signal_free(s);
}

/* --- benchmark signals --------------------------------------------------------------------- */

static ss_signal *
wave(ss_wave kind, ss_wave_opts opts)
{
    ss_signal *s;
    ss_error err = { "" };
    if (ss_wave_new(&s, kind, &opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return s;
}

/* With whole numbers f n is exact in integers: after 1e9 cycles the phase must still be so to
 * rounding (2 pi 2^-54) and the cosine to 1 ulp more. */
static void
sine_does_not_drift(void **state)
{
    const uint64_t f = 700000001, rate = 1000003;
    ss_wave_opts o = ss_wave_defaults;
    o.rate = (double)rate;
    o.frequency = (double)f;
    o.duration = 2;
    ss_signal *s = wave(SS_SINE, o);
    (void)state;
    for (uint64_t i = 0; i < s->n; i += 997) {
        double turn = (double)(f * i % rate) / (double)rate, should = cos(2 * M_PI * turn);
        if (!(fabs(s->values[i] - should) <= 2 * M_PI * DBL_EPSILON + DBL_EPSILON))
            fail_msg("sample %d: %.17g, not %.17g", (int)i, s->values[i], should);
    }
    ss_signal_free(s);
}

/* T = 2 s, f 5 -> 25 Hz: cycles 5 t + 5 t^2; at t = n / 100, in 1/2000 cycles: 100 n + n^2. */
static void
chirp_has_the_phase_of_a_linear_sweep(void **state)
{
    ss_wave_opts o = { .rate = 100, .duration = 2, .amplitude = 3, .frequency = 5,
                       .frequency_end = 25 };
    ss_signal *s = wave(SS_CHIRP, o);
    (void)state;
    for (size_t n = 0; n < s->n; n++) {
        double turn = (double)((100 * n + n * n) % 2000) / 2000;
        assert_true(fabs(s->values[n] - 3 * cos(2 * M_PI * turn)) <= 3 * 8 * DBL_EPSILON);
    }
    ss_signal_free(s);
}

/* One period later it is smaller by exp(-2 pi zeta / sqrt(1 - zeta^2)), and peaks are 1/f apart. */
static void
ringdown_decays_by_its_damping_ratio(void **state)
{
    const double zeta = 0.1, ratio = exp(-2 * M_PI * zeta / sqrt(1 - zeta * zeta));
    ss_wave_opts o = { .rate = 1000, .duration = 1, .amplitude = 2, .frequency = 20, .damping = zeta,
                       .at = 0.1 };
    ss_signal *s = wave(SS_RINGDOWN, o);
    (void)state;
    assert_true(s->values[99] == 0 && fabs(s->values[100] - 2) <= 4 * DBL_EPSILON);
    for (size_t i = 100; i + 50 < s->n; i++)
        assert_true(fabs(s->values[i + 50] - ratio * s->values[i]) <= 32 * DBL_EPSILON);
    ss_signal_free(s);
}

static void
impulse_and_step_are_where_they_should_be(void **state)
{
    ss_wave_opts o = { .rate = 10, .duration = 1, .amplitude = 3, .at = 0.34 };
    ss_signal *impulse = wave(SS_IMPULSE, o), *step = wave(SS_STEP, o);
    (void)state;
    assert_int_equal(step->n, 10);
    for (size_t i = 0; i < 10; i++) {
        assert_true(impulse->values[i] == (i == 3 ? 3 : 0));
        assert_true(step->values[i] == (i >= 4 ? 3 : 0));
    }
    ss_signal_free(impulse);
    ss_signal_free(step);
    for (int i = 0; i < 10; i++) {              /* at a sample's own time, as it is printed */
        o.at = i / 10.;
        step = wave(SS_STEP, o);
        assert_true(step->values[i] == 3 && (i == 0 || step->values[i - 1] == 0));
        ss_signal_free(step);
    }
}

static void
refuses_waves_out_of_range(void **state)
{
    static const double bad[] = { NAN, INFINITY, -INFINITY, -1 };
    ss_signal *s;
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        ss_wave_opts o[5];
        for (int k = 0; k < 5; k++)
            o[k] = ss_wave_defaults;
        o[0].rate = bad[i];
        o[1].duration = bad[i];
        o[2].frequency = bad[i];
        o[3].frequency_end = bad[i];
        o[4].damping = bad[i];
        for (int k = 0; k < 5; k++)
            assert_int_equal(ss_wave_new(&s, SS_RINGDOWN, &o[k], NULL), SS_EINVAL);
    }
    ss_wave_opts zero = ss_wave_defaults, huge = ss_wave_defaults;
    zero.duration = 0;
    huge.rate = 1e300;
    s = wave(SS_NOISE, zero);
    assert_int_equal(s->n, 0);
    ss_signal_free(s);
    assert_int_equal(ss_wave_new(&s, SS_SINE, &huge, NULL), SS_EINVAL);
}

/* --- noise --------------------------------------------------------------------------------- */

static double
variance(const double *x, size_t n)
{
    double mean = 0, square = 0;
    for (size_t i = 0; i < n; i++)
        mean += x[i] / (double)n;
    for (size_t i = 0; i < n; i++)
        square += (x[i] - mean) * (x[i] - mean) / (double)n;
    return square;
}

/* The variance of n Gaussian numbers scatters by sqrt(2 / n): five of these, once and for all as
 * the seed is fixed. */
static void
noise_has_the_ratio_asked_for(void **state)
{
    enum { N = 100000 };
    ss_wave_opts o = { .rate = N / 10., .duration = 10, .amplitude = 3, .frequency = 7 };
    ss_signal *clean = wave(SS_SINE, o), *noisy = wave(SS_SINE, o);
    (void)state;
    for (size_t i = 0; i < N; i++)
        clean->values[i] = noisy->values[i] += 1e3;             /* a mean must not count */
    double rms = ss_noise_rms(clean->values, N, 20);
    assert_true(fabs(rms - 0.1 * 3 / sqrt(2)) <= 1e-12);
    assert_int_equal(ss_noise_add_once(noisy->values, N, rms, 1), SS_OK);
    for (size_t i = 0; i < N; i++)
        noisy->values[i] -= clean->values[i];
    double ratio = variance(noisy->values, N) / (rms * rms);
    assert_true(fabs(ratio - 1) <= 5 * sqrt(2. / N));
    ss_signal_free(clean);
    ss_signal_free(noisy);
}

static void
noise_is_the_same_in_pieces(void **state)
{
    enum { N = 1000 };
    double whole[2 * N] = { 0 }, piece[2 * N] = { 0 }, other[N] = { 0 };
    const double rms[] = { 2, 0.5 };
    ss_noise *noise;
    (void)state;
    ss_noise_new(&noise, 3);
    ss_noise_add(noise, whole, N, 1, 2, N, rms);                /* column after column */
    ss_noise_free(noise);
    ss_noise_new(&noise, 3);
    for (size_t i = 0; i < N; i++)
        ss_noise_add(noise, piece + 2 * i, 1, 2, 2, 1, rms);    /* row after row */
    ss_noise_free(noise);
    for (size_t i = 0; i < N; i++)
        assert_true(whole[i] == piece[2 * i] && whole[N + i] == piece[2 * i + 1]);
    assert_int_equal(ss_noise_add_once(other, N, 2, 4), SS_OK);
    assert_true(other[0] != whole[0]);
    assert_int_equal(ss_noise_add_once(other, N, -1, 4), SS_EINVAL);
    assert_int_equal(ss_noise_add_once(other, N, NAN, 4), SS_EINVAL);
}

/* The power of x at the frequencies of the record in [lo, hi], by the definition: every k-th one. */
static double
power_between(const double *x, size_t n, double rate, double lo, double hi)
{
    double power = 0;
    for (size_t k = 1; k < n / 2; k++) {
        double f = (double)k * rate / (double)n, re = 0, im = 0;
        if (f < lo || f > hi)
            continue;
        for (size_t i = 0; i < n; i++) {
            double angle = 2 * M_PI * (double)(i * k % n) / (double)n;
            re += x[i] * cos(angle);
            im += x[i] * sin(angle);
        }
        power += 2 * (re * re + im * im) / ((double)n * (double)n);
    }
    return power;
}

/* Noise of a band has its power there, flat, and the rms that was asked for.  A record that is cut out
 * of a longer one leaks as 1 / (pi distance)^2: less than 1 % of the power, 10 frequencies away. */
static void
noise_of_a_band_stays_in_it(void **state)
{
    static const struct { size_t n; double lo, hi; } band[] = {
        { 1024, 100, 200 }, { 1500, 100, 200 }, { 1500, 0, 1000 }, { 1500, 400, 1000 },
        { 1024, 62.5, 62.5 } };
    (void)state;
    for (size_t k = 0; k < sizeof band / sizeof *band; k++) {
        double x[1500] = { 0 }, again[1500] = { 0 }, square = 0, margin = 10 * 2000. / 1500;
        size_t n = band[k].n;
        ss_noise *noise;
        for (int pass = 0; pass < 2; pass++) {
            ss_noise_new(&noise, 7);
            assert_int_equal(ss_noise_add_band(noise, pass == 0 ? x : again, n, 2000, band[k].lo,
                                               band[k].hi, 0.25, NULL), SS_OK);
            ss_noise_free(noise);
        }
        assert_memory_equal(x, again, sizeof x);
        for (size_t i = 0; i < n; i++)
            square += x[i] * x[i] / (double)n;
        assert_true(fabs(sqrt(square) - 0.25) <= 1e-12);
        double inside = power_between(x, n, 2000, band[k].lo - margin, band[k].hi + margin);
        double mean = variance(x, n);           /* without the part at 0 Hz */
        assert_true(inside >= 0.99 * mean && inside <= mean * (1 + 1e-9));
        if (band[k].hi > band[k].lo) {          /* both halves alike: each is half but for chance */
            double middle = (band[k].lo + band[k].hi) / 2;
            double half = power_between(x, n, 2000, band[k].lo - margin, middle) / inside;
            double numbers = (band[k].hi - band[k].lo) / 2000 * (double)n;  /* free ones in a half */
            assert_true(fabs(half - 0.5) <= 5 * 0.5 / sqrt(numbers));
        }
    }
}

static void
bands_without_a_frequency_are_refused(void **state)
{
    static const double wrong[][2] = { { -1, 5 }, { 5, 2 }, { 5, 1001 }, { 5.1, 5.2 }, { NAN, 5 } };
    double x[100] = { 0 };
    ss_error err = { "" };
    ss_noise *noise;
    (void)state;
    ss_noise_new(&noise, 1);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(ss_noise_add_band(noise, x, 100, 2000, wrong[i][0], wrong[i][1], 1, &err),
                         SS_EINVAL);
    assert_int_equal(ss_noise_add_band(noise, x, 100, 2000, 0, 100, -1, &err), SS_EINVAL);
    for (size_t i = 0; i < 100; i++)
        assert_true(x[i] == 0);
    ss_noise_free(noise);
}

/* A ramp over more than the range: multiples of the step, the nearest, clipped; what is wrong is even
 * between -1/2 and 1/2 of a step, so its variance is a twelfth of its square, to 1 % by the
 * ramp's own steps, and to 5 % where these are wider than the converter's. */
static void
a_converter_rounds_and_clips(void **state)
{
    enum { N = 40001 };
    static double x[N];
    (void)state;
    for (int bits = 1; bits <= 16; bits += 5) {
        double range = 2.5, step = range / (double)(1 << (bits - 1)), square = 0;
        size_t inside = 0, clipped = 7, outside = 7;
        for (size_t i = 0; i < N; i++)
            x[i] = 3 * (2. * (double)i / (N - 1) - 1);
        assert_int_equal(ss_samples_quantise(x, N, bits, range, &clipped), SS_OK);
        for (size_t i = 0; i < N; i++) {
            double was = 3 * (2. * (double)i / (N - 1) - 1), off = x[i] - was;
            outside += was < -range - step / 2 || was > range - step / 2;
            assert_true(x[i] / step == rint(x[i] / step));
            assert_true(x[i] >= -range && x[i] <= range - step);
            if (was < -range)
                assert_true(x[i] == -range);
            else if (was > range - step / 2)
                assert_true(x[i] == range - step);
            else {
                assert_true(fabs(off) <= step / 2 * (1 + 1e-9));
                square += off * off;
                inside++;
            }
        }
        assert_int_equal(clipped, outside);
        if (bits > 1)
            assert_true(fabs(square / (double)inside / (step * step / 12) - 1)
                        <= (bits > 11 ? 0.05 : 1e-2));
    }
    assert_int_equal(ss_samples_quantise(x, N, 0, 1, NULL), SS_EINVAL);
    assert_int_equal(ss_samples_quantise(x, N, 53, 1, NULL), SS_EINVAL);
    assert_int_equal(ss_samples_quantise(x, N, 8, 0, NULL), SS_EINVAL);
    assert_int_equal(ss_samples_quantise(x, N, 8, INFINITY, NULL), SS_EINVAL);
    assert_int_equal(ss_samples_quantise(x, N, 52, 1e-310, NULL), SS_EINVAL);
}

/* --- gaps and other clocks ----------------------------------------------------------------- */

static void
interpolates_uneven_stamps_to_a_uniform_clock(void **state)
{
    (void)state;
    /* Stamps i + 0.4 sin(i) periods; natural ends spoil a few steps there (by a factor 0.27 a step).
     * Error of a cubic spline: 5/384 h^4 of x's fourth derivative, for the widest step, here of under 1.8 periods. */
    enum { N = 2000 };
    const double rate = 1000, w = 2 * M_PI * 20, h = 1.8 / rate, bound = 5. / 384 * pow(h * w, 4);
    const ss_read_opts opts = { .resample = 800 };
    FILE *f = tmpfile();
    ss_signal *s;
    fputs("t,x\n", f);
    for (int i = 0; i < N; i++) {
        double t = (i + 0.4 * sin(i)) / rate;
        fprintf(f, "%.17g,%.17g\n", t, sin(w * t));
    }
    rewind(f);
    assert_int_equal(ss_signal_read(&s, f, "in", &opts, NULL), SS_OK);
    fclose(f);
    assert_true(s->head->rate == 800 && s->head->start == 0);
    assert_int_equal(s->n, 1600);
    for (size_t i = 20; i < s->n - 20; i++)
        if (!(fabs(s->values[i] - sin(w * (double)i / 800)) <= bound))
            fail_msg("sample %zu is off by %g", i, s->values[i] - sin(w * (double)i / 800));
    assert_null(ss_header_find_note(s->head, "gaps"));
    ss_signal_free(s);
}

static void
resamples_a_signal_at_its_own_samples(void **state)
{
    (void)state;
    ss_wave_opts wave = ss_wave_defaults;
    ss_signal *s, *twice, *back;
    assert_int_equal(ss_wave_new(&s, SS_CHIRP, &wave, NULL), SS_OK);
    assert_int_equal(ss_signal_resample(&twice, s, 2 * wave.rate), SS_OK);
    assert_int_equal(twice->n, 2 * s->n - 1);
    assert_int_equal(ss_signal_resample(&back, twice, wave.rate), SS_OK);
    assert_int_equal(back->n, s->n);
    for (size_t i = 0; i < s->n; i++)
        if (!(fabs(back->values[i] - s->values[i]) <= 1e-9))    /* stamps are rounded: 1e-15 * 10 s */
            fail_msg("sample %zu: %.17g became %.17g", i, s->values[i], back->values[i]);
    ss_signal_free(back);
    assert_int_equal(ss_signal_resample(&back, s, 0), SS_EINVAL);
    assert_int_equal(ss_signal_resample(&back, s, NAN), SS_EINVAL);
    ss_signal_free(twice);
    ss_signal_free(s);
}

static void
fills_gaps_and_says_where(void **state)
{
    (void)state;
    static const struct { const char *text; size_t n; double split[6], line[6]; size_t gaps; } row[] = {
        { "t,x\n1,5\n2,nan\n3,7\n", 3, { 5, 0, 7 }, { 5, 6, 7 }, 1 },
        { "t,x\n1,5\n2,4\n4,8\n5,6\n6,5\n", 6, { 5, 4, 0, 8, 6, 5 }, { 5, 4, 6, 8, 6, 5 }, 1 },
        { "t,x\n1,NaN\n2,4\n3,\n4,8\n5,INF\n", 5, { 0, 4, 0, 8, 0 }, { 4, 4, 6, 8, 8 }, 3 },
        { "t,x\n1,5\n2,4\n3,8\n", 3, { 5, 4, 8 }, { 5, 4, 8 }, 0 },
        { "t,x\n1,5\n,4\n3,8\n4,6\n", 4, { 5, 0, 8, 6 }, { 5, 6.5, 8, 6 }, 1 },
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (int how = SS_GAPS_SPLIT; how <= SS_GAPS_INTERPOLATE; how++) {
            const ss_read_opts opts = { .gaps = (ss_gaps)how };
            ss_signal *s = read_text(row[i].text, &opts);
            ss_span *span;
            size_t n;
            assert_int_equal(s->n, row[i].n);
            assert_true(s->head->rate == 1 && s->head->start == 1);
            for (size_t k = 0; k < s->n; k++)
                assert_true(s->values[k] == (how == SS_GAPS_SPLIT ? row[i].split : row[i].line)[k]);
            assert_int_equal(ss_header_gaps(&span, &n, s->head), SS_OK);
            assert_int_equal(n, row[i].gaps);
            assert_true(n == 0 || (span[0].from >= 1 && span[0].to <= 6));
            free(span);
            ss_signal_free(s);
        }
}

static void
knows_what_is_near_a_gap(void **state)
{
    (void)state;
    static const ss_span gap[] = { { 1, 2 }, { 5, 6 }, { 6.5, 6.75 } };
    static const struct { double t, margin; int near_it; } row[] = {
        { 0, 0.5, 0 }, { 0.6, 0.5, 1 }, { 1, 0, 1 }, { 1.5, 0, 1 }, { 2, 0, 0 }, { 2.4, 0.5, 1 },
        { 3.5, 1, 0 }, { 3.5, 2, 1 }, { 6.2, 0.1, 0 }, { 6.2, 0.25, 1 }, { 100, 10, 0 }, { 100, 1e3, 1 } };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        assert_int_equal(ss_gaps_near(gap, 3, row[i].t, row[i].margin), row[i].near_it);
    assert_int_equal(ss_gaps_near(NULL, 0, 1, 1e9), 0);
}

static void
reads_no_gaps_from_a_damaged_note(void **state)
{
    (void)state;
    static const char *const note[] = { "", "1", "1:", ":2", "2:1", "1:1", "a:b", "1:2x", "nan:2" };
    for (size_t i = 0; i < sizeof note / sizeof *note; i++) {
        ss_header *head = ss_header_new(1, 0);
        ss_span *span;
        size_t n;
        assert_int_equal(ss_header_note(head, "gaps", note[i]), SS_OK);
        assert_int_equal(ss_header_gaps(&span, &n, head), SS_OK);
        assert_int_equal(n, 0);
        free(span);
        ss_header_free(head);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_columns_by_name_and_number),
        cmocka_unit_test(cleans_names_and_units),
        cmocka_unit_test(numbers_the_same_name_by_what_is_free),
        cmocka_unit_test(names_thousands_of_columns_alike),
        cmocka_unit_test(au_is_not_written_where_it_would_not_be_read),
        cmocka_unit_test(text_labels_in_latin_1_become_utf_8),
        cmocka_unit_test(replaces_a_note_of_the_same_key),
        cmocka_unit_test(finds_the_row_of_a_time),
        cmocka_unit_test(text_and_au_come_back_the_same),
        cmocka_unit_test(reads_text_as_others_write_it),
        cmocka_unit_test(reads_a_line_of_any_length),
        cmocka_unit_test(gives_what_a_slow_pipe_has_delivered),
        cmocka_unit_test(reads_a_stream_without_a_descriptor),
        cmocka_unit_test(reports_a_full_disk),
        cmocka_unit_test(reads_every_au_encoding),
        cmocka_unit_test(says_what_is_wrong_with_malformed_input),
        cmocka_unit_test(status_says_what_may_help),
        cmocka_unit_test(reads_tables_as_recorders_write_them),
        cmocka_unit_test(finds_the_exact_rate_behind_rounded_stamps),
        cmocka_unit_test(allows_stamps_a_tenth_of_a_period_off),
        cmocka_unit_test(refuses_options_that_a_clock_excludes),
        cmocka_unit_test(reads_the_measured_recordings),
        cmocka_unit_test(selects_columns_and_rows),
        cmocka_unit_test(sine_does_not_drift),
        cmocka_unit_test(chirp_has_the_phase_of_a_linear_sweep),
        cmocka_unit_test(ringdown_decays_by_its_damping_ratio),
        cmocka_unit_test(impulse_and_step_are_where_they_should_be),
        cmocka_unit_test(refuses_waves_out_of_range),
        cmocka_unit_test(noise_has_the_ratio_asked_for),
        cmocka_unit_test(noise_is_the_same_in_pieces),
        cmocka_unit_test(noise_of_a_band_stays_in_it),
        cmocka_unit_test(bands_without_a_frequency_are_refused),
        cmocka_unit_test(a_converter_rounds_and_clips),

        cmocka_unit_test(interpolates_uneven_stamps_to_a_uniform_clock),
        cmocka_unit_test(resamples_a_signal_at_its_own_samples),
        cmocka_unit_test(fills_gaps_and_says_where),
        cmocka_unit_test(knows_what_is_near_a_gap),
        cmocka_unit_test(reads_no_gaps_from_a_damaged_note),
    };
    return cmocka_run_group_tests_name("signal", tests, NULL, NULL);
}
