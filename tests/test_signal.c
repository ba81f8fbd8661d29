/* test_signal.c -- a signal in memory: its header, its columns and rows, its gaps. */
#include <stickslip/store.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "signal/noise.h"
#include "signal_text.h"
#include "read_opts.h"
#include "signal/gaps.h"
#include "signal/header.h"

/* --- headers, columns and rows -------------------------------------------------------------- */

static void
finds_columns_by_name_and_number(void **state)
{
    ss_header *head = sample_header();
    (void)state;
    ss_header_add_column(head, "2", "", NULL);
    ss_header_add_column(head, "Channel A", "", NULL);
    ss_header_add_column(head, "force", "", NULL);
    ss_header_add_column(head, "FORCE", "", NULL);
    ss_header_add_column(head, "9 lives", "", NULL);
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
    assert_int_equal(ss_header_column(head, "03"), 2);
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
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    (void)state;
    assert_int_equal(ss_header_add_column(head, "", "", NULL), SS_EINVAL);
    ss_header_add_column(head, "a b/c", NULL, NULL);
    ss_header_add_column(head, "a b/c", "m)(", NULL);
    ss_header_add_column(head, "a b/c", "1", NULL);
    assert_string_equal(head->column[0].name, "a_b_c");
    assert_string_equal(head->column[1].name, "a_b_c_2");
    assert_string_equal(head->column[2].name, "a_b_c_3");
    assert_string_equal(head->column[1].unit, "m  ");
    ss_header_free(head);
}

/* Escape and CSI, of ASCII, of Latin-1 and of UTF-8, would drive a terminal on which a header is shown. */
static void
blanks_control_characters(void **state)
{
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    (void)state;
    ss_header_add_column(head, "a\033[2J\302\2332J\303\233", "\033m\302\233\302\265", NULL);
    ss_header_add_column(head, "b\2332J", NULL, NULL);
    ss_header_add_column(head, "c\200d", NULL, NULL);
    ss_header_note(head, "note", "\033]0;t\a\n\tu\302\205v\177", NULL);
    assert_string_equal(head->column[0].name, "a_[2J__2J\303\233");
    assert_string_equal(head->column[0].unit, " m  \302\265");
    assert_string_equal(head->column[1].name, "b__2J");
    assert_string_equal(head->column[2].name, "c__d");
    assert_string_equal(ss_header_find_note(head, "note"), " ]0;t  \tu  v ");
    ss_header_note(head, "\200start", "\201", NULL);
    assert_string_equal(head->note[1], "??start:   ");
    ss_header_free(head);
}

static void
numbers_the_same_name_by_what_is_free(void **state)
{
    static const char *const given[] = { "a", "a_3", "a", "a", "a_2", "a_x", "a_99999999999999999999", "a" };
    static const char *const got[] = { "a", "a_3", "a_2", "a_4", "a_2_2", "a_x", "a_99999999999999999999",
                                       "a_5" };
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    (void)state;
    for (size_t i = 0; i < sizeof given / sizeof *given; i++) {
        assert_int_equal(ss_header_add_column(head, given[i], NULL, NULL), SS_OK);
        assert_string_equal(head->column[i].name, got[i]);
    }
    ss_header_free(head);
}

static void
names_thousands_of_columns_alike(void **state)
{
    enum { COLUMNS = 30000 };                   /* it takes 2 s; each name anew from 2 on, hours */
    ss_header *head = NULL, *copy;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    (void)state;
    for (int i = 0; i < COLUMNS; i++)
        assert_int_equal(ss_header_add_column(head, "a", NULL, NULL), SS_OK);
    ss_header_select(&copy, head, NULL, head->n_columns, 0, NULL);
    assert_string_equal(copy->column[COLUMNS - 1].name, "a_30000");
    ss_header_free(copy);
    ss_header_free(head);
}

static void
replaces_a_note_of_the_same_key(void **state)
{
    ss_header *head = sample_header();
    (void)state;
    ss_header_note(head, "noise", "some", NULL);
    ss_header_note(head, "scene", "two\nlines", NULL);
    assert_int_equal(head->n_notes, 2);
    assert_string_equal(ss_header_find_note(head, "scene"), "two lines");
    assert_string_equal(ss_header_find_note(head, "noise"), "some");
    assert_null(ss_header_find_note(head, "nois"));
    assert_int_equal(ss_header_note(head, "noise", NULL, NULL), SS_OK);
    assert_int_equal(ss_header_note(head, "nois*", NULL, NULL), SS_OK);
    assert_int_equal(head->n_notes, 1);
    assert_null(ss_header_find_note(head, "noise"));
    assert_string_equal(ss_header_find_note(head, "scene"), "two lines");
    assert_int_equal(ss_header_note(head, "rate", "1", NULL), SS_EINVAL);
    assert_int_equal(ss_header_note(head, "rate", NULL, NULL), SS_EINVAL);
    assert_int_equal(ss_header_note(head, "a:b", "1", NULL), SS_EINVAL);
    assert_int_equal(ss_header_note(head, "", "1", NULL), SS_EINVAL);
    ss_header_free(head);
}

static void
writes_at_most_4096_notes(void **state)
{
    static const ss_format format[] = { SS_TSV, SS_AU };
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_writer *writer;
    ss_error err;
    char key[24];
    FILE *out = tmpfile();
    (void)state;
    ss_header_add_column(head, "x", "", NULL);
    for (int i = 0; i < 4096; i++) {
        snprintf(key, sizeof key, "note %d", i);
        assert_int_equal(ss_header_note(head, key, "", NULL), SS_OK);
    }
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(ss_writer_new(&writer, out, NULL, format[i], &(ss_contents){ .signal = head },
                                       &err), SS_OK);
        ss_writer_free(writer);
    }
    ss_header_note(head, "one more", "", NULL);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(ss_writer_new(&writer, out, NULL, format[i], &(ss_contents){ .signal = head },
                                       &err), SS_EDATA);
        assert_string_equal(err.text, "4097 notes: files have no more than 4096");
    }
    fclose(out);
    ss_header_free(head);
}

/* A line of a header in which there are words that mean something to a reader, and bytes that may. */
static void
random_text(char *text, size_t size, unsigned *state)
{
    static const char *const part[] = {
        "rate", "start", "columns", "t", "s", "a", "\302\265", "stickslip signal 1", "# ", " ", "\t", ":", ": ",
        "/", "(", ")", ",", "\200", "\377", "\302\205", "\302", "\001", "\033", "\177", "\r", "1", "-", ".",
    };
    *text = '\0';
    do {
        *state = *state * 1664525u + 1013904223u;
        strncat(text, part[(*state >> 8) % (sizeof part / sizeof *part)], size - strlen(text) - 1);
    } while (*state >> 24 > 40);
}

/* The signal in the form in which ss_record_write gives it. */
static ss_signal *
read_again(const ss_signal *s, ss_format format)
{
    char *text;
    size_t n;
    FILE *out = open_memstream(&text, &n);
    ss_signal *again;
    ss_error err = { 0 };
    assert_int_equal(ss_record_write(&(ss_record){ .signal = s }, out, NULL, format, NULL), SS_OK);
    fclose(out);
    if (read_bytes(&again, text, n, NULL, &err) != SS_OK)
        fail_msg("%s\n%s", err.text, text);
    free(text);
    return again;
}

/* A header that was read can be written, and read again with the same names, units, notes and clock. */
static void
reads_what_it_writes(void **state)
{
    enum { TRIALS = 20000 };
    unsigned seed = 1;
    int readable = 0;
    (void)state;
    for (int i = 0; i < TRIALS; i++) {
        char key[64], value[64], column[64], text[400];
        ss_signal *s;
        random_text(key, sizeof key, &seed);
        random_text(value, sizeof value, &seed);
        random_text(column, sizeof column, &seed);
        snprintf(text, sizeof text, "# stickslip signal 1\n# rate: 10\n# %s: %s\n# columns: t/s %s\n0\t1\n.1\t2\n",
                 key, value, column);
        if (read_bytes(&s, text, strlen(text), NULL, NULL) != SS_OK)
            continue;
        ss_signal *back = read_again(s, i % 2 ? SS_AU : SS_TSV);
        const ss_header *a = s->head, *b = back->head;
        assert_true(b->rate == a->rate && b->start == a->start && back->n == s->n);
        assert_int_equal(b->n_columns, a->n_columns);
        for (size_t c = 0; c < a->n_columns; c++) {
            assert_string_equal(b->column[c].name, a->column[c].name);
            assert_string_equal(b->column[c].unit, a->column[c].unit);
        }
        assert_int_equal(b->n_notes, a->n_notes);
        for (size_t k = 0; k < a->n_notes; k++)
            assert_int_equal(strcspn(b->note[k], ":"), strcspn(a->note[k], ":"));
        ss_signal_free(back);
        ss_signal_free(s);
        readable++;
    }
    assert_true(readable > TRIALS / 4);
}

static void
a_column_t_in_seconds_is_not_the_time(void **state)
{
    const size_t column = 1;
    ss_signal *s = read_text("# stickslip signal 1\n# rate: 10\n# columns: a t/s\n1\t5\n2\t6\n", NULL), *t, *back;
    (void)state;
    assert_int_equal(s->head->has_time, 0);
    assert_int_equal(ss_signal_select(&t, s, &column, 1, 0, 2, NULL), SS_OK);
    back = read_again(t, SS_TSV);
    assert_int_equal(back->head->n_columns, 1);
    assert_string_equal(back->head->column[0].name, "t");
    assert_true(back->values[0] == 5 && back->values[1] == 6);
    ss_signal_free(back);
    ss_signal_free(t);
    ss_signal_free(s);
}

static void
finds_the_row_of_a_time(void **state)
{
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1000, 2, NULL), SS_OK);
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

static void
selects_columns_and_rows(void **state)
{
    ss_signal *s = read_text("t,x,y\n1,1,2\n1.5,3,4\n2,5,6\n", NULL), *part;
    const size_t column[] = { 1, 0, 1 }, none[] = { 2 };
    (void)state;
    assert_int_equal(ss_signal_select(&part, s, column, 3, 1, 3, NULL), SS_OK);
    assert_true(part->n == 2 && part->head->start == 1.5 && part->head->n_columns == 3);
    assert_true(part->values[0] == 4 && part->values[1] == 6 && part->values[2] == 3);
    assert_string_equal(part->head->column[2].name, "y_2");
    ss_signal_free(part);
    assert_int_equal(ss_signal_select(&part, s, none, 1, 0, 1, NULL), SS_EINVAL);
    ss_signal_free(s);
}

/* --- gaps and resampling ------------------------------------------------------------------- */

/* Write a signal, and read it at another rate. */
static ss_status
resample(ss_signal **out, const ss_signal *s, double rate)
{
    FILE *file = tmpfile();
    const ss_read_opts opts = { READ_OPTS, .resample = rate };
    assert_int_equal(ss_record_write(&(ss_record){ .signal = s }, file, NULL, SS_AU, NULL), SS_OK);
    rewind(file);
    errno = EINTR;              /* of a call before, which says nothing of the end of this file */
    ss_status st = ss_signal_read(out, file, "file", &opts, NULL);
    fclose(file);
    return st;
}

static void
resamples_a_signal_at_its_own_samples(void **state)
{
    (void)state;
    ss_wave_opts wave = ss_wave_defaults;
    ss_signal *s, *twice = NULL, *back = NULL;
    assert_int_equal(ss_wave_new(&s, SS_CHIRP, &wave, NULL), SS_OK);
    for (int start = -8; start <= 8; start += 8) {
        s->head->start = start;
        ss_signal_free(twice);
        assert_int_equal(resample(&twice, s, 2 * wave.rate), SS_OK);
        assert_int_equal(twice->n, 2 * s->n - 1);
        assert_int_equal(resample(&back, twice, wave.rate), SS_OK);
        assert_int_equal(back->n, s->n);
        for (size_t i = 0; i < s->n; i++)
            if (!(fabs(back->values[i] - s->values[i]) <= 1e-9))    /* stamps are rounded: 1e-15 * 10 s */
                fail_msg("sample %zu: %.17g became %.17g", i, s->values[i], back->values[i]);
        ss_signal_free(back);
    }
    assert_int_equal(resample(&back, s, -1), SS_EINVAL);
    assert_int_equal(resample(&back, s, NAN), SS_EINVAL);
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
            const ss_read_opts opts = { READ_OPTS, .gaps = (ss_gaps)how };
            ss_signal *s = read_text(row[i].text, &opts);
            ss_span *span;
            size_t n;
            assert_int_equal(s->n, row[i].n);
            assert_true(s->head->rate == 1 && s->head->start == 1);
            for (size_t k = 0; k < s->n; k++)
                assert_true(s->values[k] == (how == SS_GAPS_SPLIT ? row[i].split : row[i].line)[k]);
            assert_int_equal(ss_header_gaps(&span, &n, s->head, NULL), SS_OK);
            assert_int_equal(n, row[i].gaps);
            assert_true(n == 0 || (span[0].from >= 1 && span[0].to <= 6));
            free(span);
            ss_signal_free(s);
        }
}

/* Between two gaps the spline through two rows is a line, and one row stands alone. */
static void
resamples_what_lies_between_gaps(void **state)
{
    static const double truth[] = { 1, 1.5, 2, 0, 0, 0, 7, 0, 0, 0, 1, 2.5, 4 };
    const ss_read_opts opts = { READ_OPTS, .gaps = SS_GAPS_SPLIT, .resample = 2 };
    (void)state;
    ss_signal *s = read_text("t,x\n0,1\n1,2\n2,nan\n3,7\n4,nan\n5,1\n6,4\n", &opts);
    assert_int_equal(s->n, sizeof truth / sizeof *truth);
    for (size_t i = 0; i < s->n; i++)
        assert_true(fabs(s->values[i] - truth[i]) < 1e-14);
    ss_signal_free(s);
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
refuses_gaps_of_a_damaged_note(void **state)
{
    (void)state;
    static const char *const note[] = { "1", "1:", ":2", "2:1", "1:1", "a:b", "1:2x", "nan:2", "1:2 3", "1:2 4:3",
                                        "1:inf", "1:1e999", "1:2:3", "1:2,3:4", "1:2 3:4 x" };
    for (size_t i = 0; i < sizeof note / sizeof *note; i++) {
        ss_header *head = NULL;
        assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
        ss_span *span;
        size_t n;
        assert_int_equal(ss_header_note(head, "gaps", note[i], NULL), SS_OK);
        assert_int_equal(ss_header_gaps(&span, &n, head, NULL), SS_EDATA);
        assert_null(span);
        assert_int_equal(n, 0);
        ss_header_free(head);
    }
}

static void
reads_gaps_in_any_order(void **state)
{
    (void)state;
    static const char *const note[] = { "1:2 4:6 8:9", "8:9 4:6 1:2", "4:6 8:9  1:2 ", "1:2 4:5.5 4.5:6 8:9 8.25:8.5",
                                        "8:9 5:6 4:5.25 1:2" };
    static const ss_span right[] = { { 1, 2 }, { 4, 6 }, { 8, 9 } };
    for (size_t i = 0; i < sizeof note / sizeof *note; i++) {
        ss_header *head = NULL;
        assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
        ss_span *span;
        size_t n;
        assert_int_equal(ss_header_note(head, "gaps", note[i], NULL), SS_OK);
        assert_int_equal(ss_header_gaps(&span, &n, head, NULL), SS_OK);
        assert_int_equal(n, 3);
        assert_memory_equal(span, right, sizeof right);
        free(span);
        ss_header_free(head);
    }
}

/* By definition: an inch is 25.4 mm, a pound .45359237 kg, a kilogram-force 9.80665 N (NIST SP 811, B.6 and B.8). */
static void
units_have_their_size(void **state)
{
    static const double pound = .45359237, g = 9.80665, pi = 3.14159265358979323846;
    const struct { const char *unit; char dimension; int per_time; double size; } of[] = {
        { "N", 'N', 0, 1 }, { "kN", 'N', 0, 1e3 }, { "MN", 'N', 0, 1e6 }, { "mN", 'N', 0, 1e-3 }, { "uN", 'N', 0, 1e-6 },
        { "lbf", 'N', 0, pound * g }, { "kip", 'N', 0, 1e3 * pound * g }, { "kips", 'N', 0, 1e3 * pound * g },
        { "kgf", 'N', 0, g }, { "gf", 'N', 0, g / 1e3 }, { "dyn", 'N', 0, 1e-5 }, { "dyne", 'N', 0, 1e-5 },
        { "m", 'm', 0, 1 }, { "cm", 'm', 0, 1e-2 }, { "mm", 'm', 0, 1e-3 }, { "um", 'm', 0, 1e-6 },
        { "\xc2\xb5m", 'm', 0, 1e-6 }, { "\xce\xbcm", 'm', 0, 1e-6 }, { "micron", 'm', 0, 1e-6 },
        { "microns", 'm', 0, 1e-6 }, { "nm", 'm', 0, 1e-9 }, { "in", 'm', 0, .0254 }, { "ft", 'm', 0, 12 * .0254 },
        { "km", 'm', 0, 1e3 }, { "rad", 'r', 0, 1 }, { "deg", 'r', 0, pi / 180 },
        { "mm/s", 'm', 1, 1e-3 }, { "in/s^2", 'm', 2, .0254 }, { "m/s2", 'm', 2, 1 }, { "m/s\xc2\xb2", 'm', 2, 1 },
        { "cm/s/s", 'm', 2, 1e-2 }, { "kN/s", 'N', 1, 1e3 }, { "deg/s", 'r', 1, pi / 180 } };
    static const char *const none[] = { "", "/s", "n", "Nm", "m/", "m/s^3", "mm/S", "V", "IN", "kgf/s/s/s" };
    char dimension;
    int per_time;
    (void)state;
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        double size = ss_unit_size(of[i].unit, &dimension, &per_time);
        if (!(fabs(size / of[i].size - 1) < 1e-12) || dimension != of[i].dimension || per_time != of[i].per_time)
            fail_msg("%s: %.17g, %c, %d", of[i].unit, size, dimension, per_time);
    }
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
        assert_true(ss_unit_size(none[i], &dimension, &per_time) == 0);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_columns_by_name_and_number),
        cmocka_unit_test(units_have_their_size),
        cmocka_unit_test(cleans_names_and_units),
        cmocka_unit_test(blanks_control_characters),
        cmocka_unit_test(numbers_the_same_name_by_what_is_free),
        cmocka_unit_test(names_thousands_of_columns_alike),
        cmocka_unit_test(replaces_a_note_of_the_same_key),
        cmocka_unit_test(writes_at_most_4096_notes),
        cmocka_unit_test(reads_what_it_writes),
        cmocka_unit_test(a_column_t_in_seconds_is_not_the_time),
        cmocka_unit_test(finds_the_row_of_a_time),
        cmocka_unit_test(selects_columns_and_rows),
        cmocka_unit_test(resamples_a_signal_at_its_own_samples),
        cmocka_unit_test(fills_gaps_and_says_where),
        cmocka_unit_test(resamples_what_lies_between_gaps),
        cmocka_unit_test(knows_what_is_near_a_gap),
        cmocka_unit_test(refuses_gaps_of_a_damaged_note),
        cmocka_unit_test(reads_gaps_in_any_order),
    };
    return cmocka_run_group_tests_name("signal", tests, NULL, NULL);
}
