/* test_filter.c -- filters, derivatives and integrals against closed forms. */
#include <float.h>
#include <math.h>
#include <string.h>
#include "read_opts.h"
#include "signal_text.h"
#include "unit.h"

#define RATE 1000.
enum { N = 20000 };
static const double ripple = 1.2e-4;            /* 1e-3 dB, as a part of the amplitude */

/* What closed forms have at a time: a signal, or its derivative or integral of an order. */
typedef double form(double t, int order, double f);

/* cos(2 pi f t + 1), whose integrals have no constant. */
static double
cosine(double t, int order, double f)
{
    return pow(2 * M_PI * f, order) * cos(2 * M_PI * f * t + 1 + order * M_PI / 2);
}

static ss_signal *
sample(form *of, double f)
{
    ss_header *head;
    ss_signal *s;
    assert_int_equal(ss_header_new(&head, RATE, -3, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "x", "m", NULL), SS_OK);
    assert_int_equal(ss_signal_new(&s, head, N, NULL), SS_OK);
    for (size_t i = 0; i < N; i++)
        s->values[i] = of(head->start + (double)i / RATE, 0, f);
    ss_header_free(head);
    return s;
}

static ss_filter_opts
filter_of(double low, double high, int order)
{
    ss_filter_opts o;
    ss_filter_opts_init(&o, sizeof o);
    o.low_pass = low;
    o.high_pass = high;
    o.order = order;
    return o;
}

static ss_status
filtered(ss_signal **out, const ss_signal *in, const ss_filter_opts *o, ss_error *err)
{
    ss_reader *reader = NULL;
    ss_status st = ss_reader_of_signal(&reader, in, err);
    if (st == SS_OK)
        st = ss_reader_filter(reader, o, err);
    if (st == SS_OK)
        st = ss_signal_of_reader(out, reader, err);
    ss_reader_free(reader);
    return st;
}

/* The largest error of a filtered signal; the constant of an integral that drifts is that of its first row. */
static double
error_of(form *of, double f, ss_filter_opts o, double gain)
{
    ss_signal *in = sample(of, f), *out = NULL;
    ss_error err = { 0 };
    double worst = 0, from_0 = 0;
    if (filtered(&out, in, &o, &err) != SS_OK)
        fail_msg("%s", err.text);
    assert_true(out->n > 0 && out->n <= N && fabs(out->head->start - in->head->start - (double)(N - out->n) / 2 / RATE)
                <= 1 / RATE);
    for (size_t i = 0; i < out->n; i++) {
        double t = out->head->start + (double)i / RATE, want = gain * of(t, o.order, f);
        if (i == 0 && o.order == -1 && !(o.high_pass > 0))
            from_0 = want;
        worst = fmax(worst, fabs(out->values[i] - want + from_0));
    }
    ss_signal_free(in);
    ss_signal_free(out);
    return worst;
}

/* Each frequency that passes comes out as its exact derivative or integral to 1e-3 dB, in phase; each that is stopped
 * is 80 dB below that, and of an integral with a high-pass 80 dB below the edge's.  Rounding: of sums of N terms. */
static void
passes_and_stops(void **state)
{
    static const struct { double low, high; int order; } filter[] = {
        { 100, 0, 0 }, { 0, 20, 0 }, { 100, 20, 0 }, { 480, 0, 0 }, { 0, 0, 1 }, { 0, 0, 2 }, { 0, 0, 3 }, { 0, 0, 4 },
        { 100, 0, 1 }, { 100, 20, 2 }, { 0, 20, -1 }, { 0, 20, -2 }, { 100, 20, -2 }, { 0, 0, -1 }, { 100, 0, -1 } };
    static const double f[] = { 0.5, 3.1, 7.7, 15.9, 24.1, 33.3, 57, 79.9, 120.1, 147, 260, 333, 449 };
    (void)state;
    for (size_t k = 0; k < sizeof filter / sizeof *filter; k++)
        for (size_t i = 0; i < sizeof f / sizeof *f; i++) {
            double low = filter[k].low > 0 ? filter[k].low : INFINITY, high = filter[k].high;
            int order = filter[k].order, stopped = f[i] > 1.2 * low || f[i] < 0.8 * high;
            double size = pow(2 * M_PI * (stopped && order < 0 && f[i] < high ? high : f[i]), order);
            double rounding = 64 * DBL_EPSILON * pow(M_PI * RATE, order > 0 ? order : 0) * (order < 0 ? N / RATE : 1);
            double off = error_of(cosine, f[i], filter_of(filter[k].low, high, order), !stopped);
            double allowed = (stopped ? 1e-4 : order == -1 && high == 0 ? 2 * ripple : ripple) * size + rounding;
            if (!(off <= allowed))
                fail_msg("%g to %g Hz, order %d, at %g Hz: %.3g of %.3g", high, low, order, f[i], off / size,
                         allowed / size);
        }
}

/* A deeper stop makes the pass band truer, too. */
static void
stops_as_deep_as_asked(void **state)
{
    (void)state;
    for (double stop = 100; stop <= 160; stop += 20) {
        ss_filter_opts o = filter_of(100, 0, 0);
        o.stop = stop;
        double part = pow(10, -stop / 20) + 64 * DBL_EPSILON;
        for (double f = 121; f < 500; f += 13.7)
            if (!(error_of(cosine, f, o, 0) <= part))
                fail_msg("%g dB, %g Hz: %g", stop, f, error_of(cosine, f, o, 0));
        for (double f = 1; f < 80; f += 13.7)
            assert_true(error_of(cosine, f, o, 1) <= 2 * part);     /* its ripple, less that at 0 Hz, which is 0 */
    }
}

/* A chirp of f Hz at its middle, of 2 f Hz at its end: its frequency is 2 pi f (1 + t / 20) at t. */
static double
chirp(double t, int order, double f)
{
    double w = 2 * M_PI * f * (1 + t / 20), phase = 2 * M_PI * f * (t + t * t / 40);
    return order == 0 ? cos(phase) : order == 1 ? -w * sin(phase)
        : -w * w * cos(phase) - 2 * M_PI * f / 20 * sin(phase);
}

static void
chirps_have_their_derivatives(void **state)
{
    (void)state;
    assert_true(error_of(chirp, 40, filter_of(100, 0, 0), 1) <= ripple);
    for (int order = 1; order <= 2; order++) {
        assert_true(error_of(chirp, 40, filter_of(0, 0, order), 1) <= ripple * pow(2 * M_PI * 80, order));
        assert_true(error_of(chirp, 40, filter_of(100, 20, order), 1) <= ripple * pow(2 * M_PI * 80, order));
    }
}

static double
cubic(double t, int order, double scale)
{
    static const double factor[] = { 1, 3, 6, 6, 0 };
    (void)scale;
    return order < 0 ? t * t * t * t / 4 : factor[order] * pow(t, 3 - order > 0 ? 3 - order : 0);
}

/* The response of a filter is 1 at 0 Hz, to rounding, and its slope 0; by its ripple the second derivative of a cubic
 * adds at most ripple (half / rate)^2 of itself.  The integral sums 2e4 rows. */
static void
polynomials_stay_polynomials(void **state)
{
    const double half = 0.07, largest = 17 * 17 * 17;
    (void)state;
    for (int order = -1; order <= 4; order++) {
        double bent = ripple * half * half * fabs(cubic(17, order + 2 < 4 ? order + 2 : 4, 1));
        double rounding = 64 * DBL_EPSILON * largest * pow(2 * RATE, order > 0 ? order : 0) * (order < 0 ? N / RATE : 1);
        double off = error_of(cubic, 1, filter_of(0, 0, order), 1);
        if (order != 0 && !(off <= bent + rounding))
            fail_msg("order %d: %.3g, not %.3g", order, off, bent + rounding);
    }
    /* A second integral of a line begins with a slope of 0. */
    ss_filter_opts o = filter_of(0, 0, -2);
    ss_signal *in = sample(cubic, 1), *out = NULL;
    for (size_t i = 0; i < N; i++)
        in->values[i] = 2;
    assert_int_equal(filtered(&out, in, &o, NULL), SS_OK);
    for (size_t i = 0; i < out->n; i++)
        assert_true(fabs(out->values[i] - (double)i * (double)i / RATE / RATE) <= 1e-12 * N / RATE * N / RATE);
    ss_signal_free(in);
    ss_signal_free(out);
}

static void
is_refused(ss_filter_opts o, ss_status wanted)
{
    ss_signal *in = sample(cosine, 1), *out = NULL;
    ss_error err = { 0 };
    assert_int_equal(filtered(&out, in, &o, &err), wanted);
    assert_true(out == NULL && err.text[0] != '\0');
    ss_signal_free(in);
}

static void
refuses_what_no_filter_is(void **state)
{
    (void)state;
    is_refused(filter_of(500, 0, 0), SS_EINVAL);
    is_refused(filter_of(0, 500, 0), SS_EINVAL);
    is_refused(filter_of(NAN, 0, 0), SS_EINVAL);
    is_refused(filter_of(100, 70, 0), SS_EINVAL);           /* the transitions meet */
    is_refused(filter_of(0, 1e-5, 0), SS_EINVAL);           /* 2^24 taps are too few */
    is_refused(filter_of(0, 0.6, 0), SS_EDATA);             /* 2e4 rows are too few */
    is_refused(filter_of(0, 0, 5), SS_EINVAL);
    is_refused(filter_of(0, 0, -3), SS_EINVAL);
}

/* Whole numbers as values: beyond a double in the sum of the taps. */
static void
overflow_is_an_error(void **state)
{
    ss_signal *in = sample(cosine, 10), *out = NULL;
    ss_filter_opts o = filter_of(0, 0, 1);
    (void)state;
    for (size_t i = 0; i < N; i++)
        in->values[i] *= 1e307;
    assert_int_equal(filtered(&out, in, &o, NULL), SS_ERANGE);
    ss_signal_free(in);
}

/* A reader of a part of a table goes back to the first row of the part, by itself and behind a filter. */
static void
goes_back_to_its_first_row(void **state)
{
    enum { ROWS = 2000, FROM = 500, TO = 1500 };
    static double row[2][ROWS];
    (void)state;
    for (int filters = 0; filters < 2; filters++) {
        const ss_read_opts opts = { READ_OPTS, .from = 0.5, .to = 1.5, .rewinds = 1 };
        const ss_filter_opts o = filter_of(0, 0, 1);
        size_t n[2] = { 0, 0 };
        ss_reader *reader;
        FILE *in = tmpfile();
        assert_non_null(in);
        fputs("t_s,x\n", in);
        for (int i = 0; i < ROWS; i++)
            fprintf(in, "%.3f,%d\n", i / 1000., i * i % 97);
        rewind(in);
        assert_int_equal(ss_reader_new(&reader, in, "in", &opts, NULL), SS_OK);
        if (filters)
            assert_int_equal(ss_reader_filter(reader, &o, NULL), SS_OK);
        for (int pass = 0; pass < 2; pass++) {
            double *to;
            for (size_t got = 1; got > 0; n[pass] += got) {
                to = row[pass] + n[pass];
                assert_int_equal(ss_reader_rows(reader, &to, ROWS - n[pass], &got, NULL), SS_OK);
            }
            assert_int_equal(ss_reader_rewind(reader, NULL), SS_OK);
        }
        assert_int_equal(n[0], n[1]);
        assert_memory_equal(row[0], row[1], n[0] * sizeof row[0][0]);
        assert_true(filters ? n[0] > 0 : n[0] == TO - FROM && row[0][0] == FROM * FROM % 97);
        ss_reader_free(reader);
        fclose(in);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_and_stops), cmocka_unit_test(stops_as_deep_as_asked),
        cmocka_unit_test(chirps_have_their_derivatives), cmocka_unit_test(polynomials_stay_polynomials),
        cmocka_unit_test(refuses_what_no_filter_is), cmocka_unit_test(overflow_is_an_error), cmocka_unit_test(goes_back_to_its_first_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
