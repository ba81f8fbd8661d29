/* test_coefficients.c -- coefficients as a stream: read back, in any order of scales, and damaged. */
#include <stickslip/store.h>
#include <stdlib.h>
#include <string.h>
#include "map/map.h"
#include "morlet_plan.h"
#include "unit.h"

/* --- the stream ---------------------------------------------------------------------------- */

static ss_coefficients *
some_coefficients(const ss_morlet_opts *opts)
{
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 2000, 0.125, NULL), SS_OK);
    ss_signal *signal = NULL;
    ss_coefficients *coef = NULL;
    ss_header_add_column(head, "x", "m", NULL);
    ss_header_add_column(head, "a", "m/s^2", NULL);
    ss_header_note(head, "scene", "compliant-light", NULL);
    assert_int_equal(ss_signal_new(&signal, head, 300, NULL), SS_OK);
    make(WEAK_BURST, signal->values + 300, 300);
    assert_int_equal(ss_morlet_transform(&coef, signal, 1, opts, NULL), SS_OK);
    assert_true(ss_coefficients_max(coef) > 0);     /* which the other column is nowhere */
    ss_header_free(head);
    ss_signal_free(signal);
    return coef;
}

static void
assert_same(const ss_coefficients *p, const ss_coefficients *q)
{
    const ss_scale *last = &p->scale[p->n_scales - 1];
    assert_int_equal(p->n, q->n);
    assert_int_equal(p->n_scales, q->n_scales);
    assert_true(p->center == q->center);
    assert_true(p->head->rate == q->head->rate && p->head->start == q->head->start);
    assert_int_equal(q->head->n_columns, 1);
    assert_string_equal(p->head->column[0].name, q->head->column[0].name);
    assert_string_equal(p->head->column[0].unit, q->head->column[0].unit);
    assert_int_equal(p->head->n_notes, q->head->n_notes);
    for (size_t i = 0; i < p->head->n_notes; i++)
        assert_string_equal(p->head->note[i], q->head->note[i]);
    for (size_t i = 0; i < p->n_scales; i++) {
        const ss_scale *s = &p->scale[i], *t = &q->scale[i];
        assert_true(s->j == t->j && s->m == t->m && s->a == t->a && s->f == t->f
                    && s->b_num == t->b_num && s->b_den == t->b_den && s->n == t->n
                    && s->offset == t->offset);
    }
    assert_memory_equal(p->w, q->w, 2 * (last->offset + last->n) * sizeof *p->w);
}

static void
stream_reads_back_the_same(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        ss_coefficients *back = NULL;
        ss_error err = { 0 };
        FILE *file = tmpfile();
        opts.voices = i == 1 ? 1 : 5;
        opts.dense = i == 2;
        opts.exact = i == 3;
        ss_coefficients *coef = some_coefficients(&opts);
        assert_string_equal(ss_header_find_note(coef->head, "scene"), "compliant-light");
        assert_string_equal(ss_header_find_note(coef->head, "column"), "a");
        assert_int_equal(ss_record_write(&(ss_record){ .coefficients = coef }, file, NULL, SS_TSV, NULL), SS_OK);
        rewind(file);
        if (ss_coefficients_read(&back, file, "c.tsv", &err) != SS_OK)
            fail_msg("%s", err.text);
        assert_same(coef, back);
        assert_true(ss_coefficients_max(coef) == ss_coefficients_max(back));
        ss_coefficients_free(coef);
        ss_coefficients_free(back);
        fclose(file);
    }
}

static int
by_time(const void *a, const void *b)
{
    double s = 0, t = 0;
    sscanf(*(char *const *)a, "%*s %*s %lf", &s);
    sscanf(*(char *const *)b, "%*s %*s %lf", &t);
    return (s > t) - (s < t);
}

static void
stream_may_interleave_scales(void **state)
{
    char *line[2000] = { NULL };
    size_t n = 0, size = 0, header = 0;
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.voices = 2;
    ss_coefficients *coef = some_coefficients(&opts), *back = NULL;
    FILE *file = tmpfile(), *mixed = tmpfile();
    (void)state;
    ss_record_write(&(ss_record){ .coefficients = coef }, file, NULL, SS_TSV, NULL);
    rewind(file);
    for (; n < LENGTH(line) && getline(&line[n], &size, file) > 0; n++, size = 0)
        header += line[n][0] == '#';
    qsort(line + header, n - header, sizeof *line, by_time);
    for (size_t i = 0; i < LENGTH(line); i++) {
        if (i < n)
            fputs(line[i], mixed);
        free(line[i]);
    }
    rewind(mixed);
    assert_true(n < LENGTH(line));
    assert_int_equal(ss_coefficients_read(&back, mixed, "c.tsv", NULL), SS_OK);
    assert_same(coef, back);
    ss_coefficients_free(coef);
    ss_coefficients_free(back);
    fclose(file);
    fclose(mixed);
}

/* One change to a good stream, and what must be said of it. */
static const struct damage {
    const char *from, *to, *says;
} damage[] = {
    { "# stickslip coefficients 1", "# stickslip signal 1", "c.tsv: a signal, not wavelet coefficients" },
    { "# stickslip coefficients 1", "t,x,a", "c.tsv:1: not wavelet coefficients" },
    { "# rate: 2000", "# rate: fast", "c.tsv:16: the rate is not a number above 0" },
    { "# rate: 2000", "# rate: -1", "c.tsv:16: the rate is not a number above 0" },
    { "# samples: 300\n", "# a:b: c\n", "lack their option 'samples'" },
    { "# samples: 300\n", "# : x\n", "lack their option 'samples'" },
    { "# stickslip coefficients 1", "\211HDF\r", "c.tsv: HDF5 cannot be read from a stream" },
    { "# samples: 300\n", "", "lack their option 'samples'" },
    { "# samples: 300", "# samples: 300.5", "not whole numbers" },
    { "# samples: 300", "# samples: 400", "ends with 21 of the 28 coefficients of scale -5" },
    { "# voices: 2", "# voices: 3", "not those of a scale" },
    { "# step: 0.25", "# step: 0.5", "b is 0.00731428571 s where the grid has 0.0142222222 s" },
    { "# lattice: b", "# no: b", "b is 0.00731428571 s where the grid has 0.0078125 s" },
    { "# center: 6", "# center: 7", "not those of a scale" },
    { "# columns: m a/s", "# columns: m a/min", "the columns are not those of wavelet coefficients, m a/s b/s" },
    { "-5\t0.03125\t0\t", "-5\t0.03125\tzero\t", "column b: 'zero' is not a finite number" },
    { "-5\t0.03125\t0\t", "-5\t0.03125\tnan\t", "column b: 'nan' is not a finite number" },
    { "-5\t0.03125\t0\t", "-5\t0.03125\t0", "expected 7 columns, found 6" },
    { "-5\t0.03125\t0\t", "-5\t0.03125\t0.1\t", "b is 0.1 s where the grid has 0 s" },
    { "-5\t0.03125\t0\t", "1e300\t0.03125\t0\t", "not those of a scale" },
    { "\t1\n-5\t0.03125\t0.007314285714285714", "\t1\t2\n-5\t0.03125\t0.007314285714285714", "expected 7 columns, found 8" },
};

/* The text with its first from put in place by to. */
static FILE *
damaged(const char *text, const struct damage *d)
{
    const char *at = strstr(text, d->from);
    FILE *file = tmpfile();
    if (at == NULL)
        fail_msg("no '%s' to damage", d->from);
    fwrite(text, 1, (size_t)(at - text), file);
    fputs(d->to, file);
    fputs(at + strlen(d->from), file);
    rewind(file);
    return file;
}

static void
assert_refused(FILE *file, const char *says)
{
    ss_coefficients *back = NULL;
    ss_error err = { 0 };
    ss_status st = ss_coefficients_read(&back, file, "c.tsv", &err);
    if ((st != SS_EDATA && st != SS_EKIND) || strncmp(err.text, "c.tsv:", 6) != 0 || strstr(err.text, says) == NULL)
        fail_msg("'%s' expected, not %d, '%s'", says, st, err.text);
    fclose(file);
}

static void
refuses_broken_streams(void **state)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.voices = 2, opts.octaves = 1, opts.m0 = -6, opts.m1 = -5;
    ss_coefficients *coef = some_coefficients(&opts);
    ss_record_write(&(ss_record){ .coefficients = coef }, file, NULL, SS_TSV, NULL);
    ss_coefficients_free(coef);
    fclose(file);
    for (size_t i = 0; i < LENGTH(damage); i++)
        assert_refused(damaged(text, &damage[i]), damage[i].says);

    char *last = strrchr(text, '\t');           /* cut within the last row, then before it */
    *last = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "expected 7 columns, found 6");
    strrchr(text, '\n')[1] = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "coefficients of scale -6");
    strstr(text, "edge\n")[5] = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "without coefficients");
    *strstr(text, "# columns") = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "no '# columns:' line");
    *text = '\0';
    assert_refused(damaged(text, &(struct damage){ "", "", NULL }), "empty");
    free(text);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stream_reads_back_the_same),
        cmocka_unit_test(stream_may_interleave_scales),
        cmocka_unit_test(refuses_broken_streams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
