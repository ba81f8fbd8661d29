/* test_stream.c -- the transform of a stream against the sum in long double and against that of the
 * whole record, however its samples come. */
#include <stickslip/store.h>
#include <stdlib.h>
#include <string.h>
#include "fit/verdict.h"
#include "map/map.h"
#include "morlet_oracle.h"
#include "unit.h"
#include "io/record.h"

#define LENGTH(a) (sizeof (a) / sizeof *(a))

/* Where the sink puts what a stream gives: at the place that the whole record's plan gives it. */
typedef struct collection {
    const ss_morlet *plan;      /* NULL: the length is not known yet */
    double *w;
    size_t next[2000], total;
    size_t stop_after;
} collection;

static size_t
index_of(const ss_morlet *plan, const ss_scale *scale)
{
    for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++)
        if (ss_morlet_grid(plan)->scale[i].j == scale->j)
            return i;
    fail_msg("scale %d is not one of the record's", scale->j);
    return 0;
}

/* In order, none twice, on the record's grid, and with the record's edge. */
static int
collect(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    collection *c = user;
    size_t i = index_of(c->plan, scale);
    const ss_scale *want = &ss_morlet_grid(c->plan)->scale[i];
    assert_true(n > 0 && samples > 0);
    assert_int_equal(first, c->next[i]);
    assert_true(first + n <= want->n);
    assert_true(scale->a == want->a && scale->f == want->f);
    memcpy(c->w + 2 * (want->offset + first), w, 2 * n * sizeof *w);
    c->next[i] += n;
    c->total += n;
    return c->stop_after > 0 && c->total >= c->stop_after;
}

static unsigned long long seed = 1;

static size_t
draw(size_t most)
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (size_t)(seed >> 33) % most + 1;
}

/* How samples come. */
typedef enum blocks { ALL, ONES, RANDOM, RANDOM_DRAINED, HURRIED } blocks;

static void
feed(ss_stream *stream, const double *x, size_t n, blocks how)
{
    for (size_t i = 0, part; i < n; i += part) {
        part = how == ALL ? n : how == ONES ? 1 : how == HURRIED ? draw(40) : draw(9999);
        part = part < n - i ? part : n - i;
        assert_int_equal(ss_stream_push(stream, x + i, part, NULL), SS_OK);
        if (how >= RANDOM_DRAINED)
            assert_int_equal(ss_stream_drain(stream, NULL), SS_OK);
    }
    assert_int_equal(ss_stream_samples(stream), n);
    assert_int_equal(ss_stream_end(stream, NULL), SS_OK);
}

/* The highest frequency that sampling resolves. */
static double
highest(double rate, const ss_morlet_opts *opts)
{
    return rate * opts->center / 2 / (opts->center + sqrt(-2 * log(opts->accuracy)));
}

/* Coefficients of x as a stream; *plan is the whole record's. */
static double *
stream_of(const double *x, size_t n, double rate, const ss_morlet_opts *opts, blocks how,
          ss_morlet **plan)
{
    ss_morlet_opts whole = *opts;
    ss_stream *stream = NULL;
    ss_error err = { 0 };
    collection c = { .plan = NULL };
    whole.force = 1;                    /* scales longer than the record, too */
    if (!opts->force && opts->fmax == 0 && !opts->octaves)
        whole.fmax = highest(rate, opts);
    if (ss_morlet_new(plan, n, rate, &whole, &err) != SS_OK
        || ss_stream_new(&stream, rate, opts, collect, &c, &err) != SS_OK)
        fail_msg("%s", err.text);
    c.plan = *plan;
    c.w = malloc(2 * ss_morlet_grid(*plan)->total * sizeof *c.w);
    assert_int_equal(ss_stream_grid(stream)->n_scales, ss_morlet_grid(*plan)->n_scales);
    assert_int_equal(ss_stream_grid(stream)->total, 0);        /* not known yet */
    feed(stream, x, n, how);
    assert_int_equal(c.total, ss_morlet_grid(*plan)->total);
    ss_stream_free(stream);
    return c.w;
}

static void
check_stream(const char *what, const double *x, size_t n, double rate, const ss_morlet_opts *opts,
             blocks how, size_t looked_at)
{
    ss_morlet *plan;
    double *w = stream_of(x, n, rate, opts, how, &plan);
    size_t every = 1 + ss_morlet_grid(plan)->total / looked_at;
    double worst = worst_error(plan, x, n, rate, opts, w, every);
    if (!(worst <= 1))
        fail_msg("%s, %zu samples, blocks %d, engine %d, accuracy %g: %g times the bound", what, n,
                 how, opts->engine, opts->accuracy, worst);
    ss_morlet_free(plan);
    free(w);
}

/* Grids of all kinds: fmin and rate such that there are scales from a few samples to some hundred,
 * or, the last ones, to thousands. */
static const struct setup {
    const char *what;
    double center;
    int voices;
    double step;
    int dense, admissible;
    ss_norm norm;
    double rate, fmin;
} setup[] = {
    { "default step",       6,     6, 0.25, 0, 0, SS_NORM_L2, 2000,  20 },
    { "dyadic",             6,     1, 1,    0, 0, SS_NORM_L2, 2000,  1 },
    { "dyadic, lattice",    6,     1, 0.5,  0, 0, SS_NORM_L1, 1024,  1 },
    { "dense",              6,     2, 0.25, 1, 0, SS_NORM_L2, 44100, 441 },
    { "dense, admissible",  2,     3, 0.25, 1, 1, SS_NORM_L1, 3,     0.004 },
    { "admissible",         2,     2, 0.3,  0, 1, SS_NORM_L2, 1e-3,  2e-6 },
    { "center 60",          60,    4, 0.7,  0, 0, SS_NORM_L1, 2000,  100 },
    { "a step of 30 scales", 6,    2, 30,   0, 0, SS_NORM_L2, 2000,  10 },
    { "a fine step",        5,     2, 0.01, 0, 0, SS_NORM_L2, 1e9,   1e8 },
};

static ss_morlet_opts
opts_of(const struct setup *s)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.center = s->center, opts.voices = s->voices, opts.step = s->step, opts.dense = s->dense;
    opts.admissible = s->admissible, opts.norm = s->norm, opts.fmin = s->fmin;
    return opts;
}

/* Records shorter than the longest wavelet among them, 1 and prime lengths. */
static void
keeps_the_record_s_bound_whatever_comes_together(void **state)
{
    static const size_t length[] = { 1, 2, 127, 1000, 4999 };
    static const double accuracy[] = { 1e-3, 1e-6, 1e-13 };
    double x[5000];
    (void)state;
    for (size_t i = 0; i < LENGTH(setup); i++)
        for (size_t j = 0; j < LENGTH(length); j++)
            for (kind which = 0; which < KINDS; which++) {
                ss_morlet_opts opts = opts_of(&setup[i]);
                opts.engine = (which + j) % 2 ? SS_ENGINE_FFT : SS_ENGINE_AUTO;
                opts.accuracy = accuracy[(which + j + i) % LENGTH(accuracy)];
                make(which, x, length[j]);
                blocks how = (blocks)((which + i + j) % 4);
                check_stream(setup[i].what, x, length[j], setup[i].rate, &opts, how, 15);
            }
}

/* Several windows long, and scales of which a window is longer than the shortest there is. */
static void
keeps_the_bound_from_window_to_window(void **state)
{
    enum { N = 160001 };
    double *x = malloc(N * sizeof *x);
    (void)state;
    for (size_t i = 0; i < LENGTH(setup) - 1; i++) {
        ss_morlet_opts opts = opts_of(&setup[i]);
        opts.fmin /= 8;
        opts.accuracy = i % 2 ? 1e-6 : 1e-12;
        opts.fmax = (opts.dense ? 12 : 40) * opts.fmin;
        opts.fmax = fmin(opts.fmax, highest(setup[i].rate, &opts));
        make((kind)(i % KINDS), x, N);
        check_stream(setup[i].what, x, N, setup[i].rate, &opts, i % 2 ? RANDOM : RANDOM_DRAINED, 5);
    }
    free(x);
}

/* What comes later, however loud, does not spoil what has been given: the error of a quiet beginning
 * is that of a record of its own, but for 4 eps of the loud. */
static void
quiet_beginning_is_as_accurate_as_by_itself(void **state)
{
    enum { N = 20000, QUIET = 12000 };
    static double x[N];
    (void)state;
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan;
    ss_stream *stream;
    opts.accuracy = 1e-4;
    opts.voices = 1, opts.fmin = 10, opts.fmax = 300;
    make(NOISE, x, N);
    for (size_t i = 0; i < QUIET; i++)
        x[i] *= 1e-9;
    assert_int_equal(ss_morlet_new(&plan, N, 2000, &opts, NULL), SS_OK);
    collection c = { .plan = plan, .w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *c.w) }, then;
    assert_int_equal(ss_stream_new(&stream, 2000, &opts, collect, &c, NULL), SS_OK);
    assert_int_equal(ss_stream_push(stream, x, QUIET, NULL), SS_OK);
    assert_int_equal(ss_stream_drain(stream, NULL), SS_OK);
    then = c;
    assert_int_equal(ss_stream_push(stream, x + QUIET, N - QUIET, NULL), SS_OK);
    assert_int_equal(ss_stream_end(stream, NULL), SS_OK);
    for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++) {
        const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
        double most = 0, error = 0, eps = DBL_EPSILON * sqrt(sc->a);
        assert_true(then.next[i] > 0);
        for (size_t k = 0; k < then.next[i]; k++) {
            const double *w = c.w + 2 * (sc->offset + k);
            long double want[2];
            most = fmax(most, hypot(w[0], w[1]));
            if (k % (1 + then.next[i] / 8) != 0)
                continue;
            oracle(x, N, 2000, &opts, sc->a, ss_scale_b(sc, k), want);
            error = fmax(error, (double)hypotl(w[0] - want[0], w[1] - want[1]));
        }
        assert_true(most < 1e-8);
        assert_true(error <= opts.accuracy * most / (1 - opts.accuracy) + 16e-9 * eps + 4 * eps);
    }
    ss_stream_free(stream);
    ss_morlet_free(plan);
    free(c.w);
}

/* In blocks the windows of the first level are those of a long record, and so is every bit. */
static void
blocks_are_those_of_the_record(void **state)
{
    enum { N = 1 << 17 };
    double *x = malloc(N * sizeof *x);
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan;
    (void)state;
    make(NOISE, x, N);
    opts.octaves = 1, opts.m0 = 2, opts.m1 = 3;
    double *w = stream_of(x, N, 1, &opts, RANDOM, &plan);
    double *whole = malloc(2 * ss_morlet_grid(plan)->total * sizeof *whole);
    assert_int_equal(ss_morlet_execute(plan, x, whole, NULL), SS_OK);
    assert_memory_equal(w, whole, 2 * ss_morlet_grid(plan)->total * sizeof *w);
    ss_morlet_free(plan);
    free(whole);
    free(w);
    free(x);
}

/* A sink for samples that come one by one and are drained. */
static int
check_delay(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples,
            void *user)
{
    double rate = 2000, reach = 8.5 * scale->a * rate;
    int *ended = user;
    (void)w;
    for (size_t k = first; k < first + n; k++) {
        double last = ss_scale_b(scale, k) * rate + reach, newest = (double)samples - 1;
        assert_true(*ended || (last <= newest + 1e-9 && newest <= last + 3));
    }
    return 0;
}

static void
delay_is_the_window(void **state)
{
    (void)state;
    for (int row = 0; row < 2; row++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        ss_stream *stream;
        int ended = 0;
        opts.fmin = 20, opts.voices = 2, opts.dense = row == 1;
        assert_int_equal(ss_stream_new(&stream, 2000, &opts, check_delay, &ended, NULL), SS_OK);
        for (int i = 0; i < 3000; i++) {
            assert_int_equal(ss_stream_push(stream, &(double){ sin(i) }, 1, NULL), SS_OK);
            assert_int_equal(ss_stream_drain(stream, NULL), SS_OK);
        }
        ended = 1;
        assert_int_equal(ss_stream_end(stream, NULL), SS_OK);
        ss_stream_free(stream);
    }
}

/* Samples come one by one: a coefficient comes less than its window behind b. */
typedef struct delays {
    ss_stream *stream;
    size_t at_end;              /* coefficients that came after the last sample */
    int ended;
} delays;

static int
check_window(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    delays *d = user;
    size_t i = 0;
    (void)w;
    while (ss_stream_grid(d->stream)->scale[i].a != scale->a)
        i++;
    double window = (double)ss_stream_window(d->stream, i);
    for (size_t k = first; k < first + n; k++)
        assert_true((double)samples - ss_scale_b(scale, k) * 2000 < window);
    d->at_end += d->ended ? n : 0;
    return 0;
}

static void
windows_delay_coefficients_by_less_than_their_length(void **state)
{
    (void)state;
    for (int row = 0; row < 3; row++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        delays d = { .ended = 0 };
        opts.fmin = row == 2 ? 1 : 20, opts.voices = 1, opts.dense = row == 1;
        assert_int_equal(ss_stream_new(&d.stream, 2000, &opts, check_window, &d, NULL), SS_OK);
        assert_int_equal(ss_stream_window(d.stream, ss_stream_grid(d.stream)->n_scales), 0);
        assert_in_range(ss_stream_window(d.stream, 0), 1 << 13, row == 2 ? 140000 : 20000);
        for (int i = 0; i < 150000; i++)
            assert_int_equal(ss_stream_push(d.stream, &(double){ sin(i) }, 1, NULL), SS_OK);
        d.ended = 1;
        assert_int_equal(ss_stream_end(d.stream, NULL), SS_OK);
        assert_true(d.at_end > 0);
        ss_stream_free(d.stream);
    }
}

static void
threads_change_nothing(void **state)
{
    enum { N = 200000 };
    double *x = malloc(N * sizeof *x);
    (void)state;
    make(NOISE, x, N);
    for (int row = 0; row < 2; row++) {
        ss_morlet *plan;
        ss_morlet_opts opts = ss_morlet_defaults;
        opts.fmin = 5, opts.fmax = 200, opts.voices = 3, opts.dense = row == 1;
        double *one = stream_of(x, N, 2000, &opts, ALL, &plan);
        ss_morlet_free(plan);
        opts.threads = 4;
        double *four = stream_of(x, N, 2000, &opts, ALL, &plan);
        assert_memory_equal(one, four, 2 * ss_morlet_grid(plan)->total * sizeof *one);
        ss_morlet_free(plan);
        free(one);
        free(four);
    }
    free(x);
}

/* Samples near both ends of what a double holds, of which squares would overflow or vanish. */
static void
amplitudes_of_any_size_scale_the_coefficients(void **state)
{
    enum { N = 70001 };
    static const int power[] = { -1030, -900, 900, 1018 };
    double *x = malloc(N * sizeof *x), *y = malloc(N * sizeof *y);
    ss_morlet_opts opts = ss_morlet_defaults;
    (void)state;
    opts.voices = 1, opts.fmin = 30, opts.norm = SS_NORM_L1;
    make(TONE, x, N);
    for (size_t p = 0; p < LENGTH(power); p++) {
        ss_morlet *plan;
        double tiny = ldexp(1, -1074 - power[p]), worst = 0;
        for (size_t i = 0; i < N; i++)
            y[i] = ldexp(x[i], power[p]);
        double *w = stream_of(x, N, 2000, &opts, RANDOM, &plan), most = 0;
        size_t total = 2 * ss_morlet_grid(plan)->total;
        ss_morlet_free(plan);
        double *v = stream_of(y, N, 2000, &opts, RANDOM, &plan);
        for (size_t i = 0; i < total; i++) {
            most = fmax(most, fabs(w[i]));
            worst = fmax(worst, fabs(ldexp(v[i], -power[p]) - w[i]));
        }
        /* both within the bound, and what is rounded off where doubles are sparse */
        assert_true(worst <= 2 * (opts.accuracy * most + 16 * DBL_EPSILON) + 4 * tiny);
        ss_morlet_free(plan);
        free(w);
        free(v);
    }
    free(x);
    free(y);
}

static int
ignore(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples, void *user)
{
    (void)scale, (void)first, (void)n, (void)w, (void)samples, (void)user;
    return 0;
}

static void
refuses_what_a_stream_cannot_do(void **state)
{
    static const struct {
        double fmin;
        ss_detrend detrend;
        double fmax;
        ss_engine engine;
        ss_status status;
        const char *says;
    } row[] = {
        { 0,  SS_DETREND_NONE,   0,   SS_ENGINE_AUTO, SS_EINVAL, "needs fmin" },
        { 10, SS_DETREND_MEAN,   0,   SS_ENGINE_AUTO, SS_EINVAL, "detrend" },
        { 10, SS_DETREND_LINEAR, 0,   SS_ENGINE_AUTO, SS_EINVAL, "detrend" },
        { 10, SS_DETREND_NONE,   900, SS_ENGINE_AUTO, SS_ESCALE, "up to 510.57 Hz" },
        { 1001, SS_DETREND_NONE, 0,   SS_ENGINE_AUTO, SS_ESCALE, "resolve scales up to" },
        { -1, SS_DETREND_NONE,   0,   SS_ENGINE_AUTO, SS_EINVAL, "no frequencies" },
        { 10, SS_DETREND_NONE,   0,   SS_ENGINE_QUADRATURE, SS_EINVAL, "quadrature is for whole records" },
        { 10, SS_DETREND_NONE,   1e4, SS_ENGINE_FFT,  SS_ESCALE, "no scale as short as that of 9714.79 Hz" },
    };
    (void)state;
    for (size_t i = 0; i < LENGTH(row); i++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        ss_stream *stream = NULL;
        ss_error err = { 0 };
        opts.fmin = row[i].fmin, opts.detrend = row[i].detrend, opts.fmax = row[i].fmax;
        opts.engine = row[i].engine, opts.force = row[i].fmax > 1000;
        ss_status st = ss_stream_new(&stream, 2000, &opts, ignore, NULL, &err);
        if (st != row[i].status || strstr(err.text, row[i].says) == NULL)
            fail_msg("'%s' expected, not %d, '%s'", row[i].says, st, err.text);
    }
}

static ss_stream *
some_stream(ss_coefficient_sink *sink, void *user)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_stream *stream;
    opts.fmin = 20;
    assert_int_equal(ss_stream_new(&stream, 2000, &opts, sink, user, NULL), SS_OK);
    return stream;
}

static void
fails_once_and_for_all(void **state)
{
    double x[1000] = { [500] = INFINITY, [600] = NAN };
    ss_error err = { 0 };
    (void)state;
    ss_stream *stream = some_stream(ignore, NULL);
    assert_int_equal(ss_stream_push(stream, x, 1000, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "sample 501 is infinite"));
    assert_int_equal(ss_stream_samples(stream), 500);
    assert_int_equal(ss_stream_drain(stream, NULL), SS_EINVAL);
    err.text[0] = '\0';
    assert_int_equal(ss_stream_end(stream, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "sample 501 is infinite"));
    ss_stream_free(stream);

    stream = some_stream(ignore, NULL);
    assert_int_equal(ss_stream_end(stream, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "empty"));
    ss_stream_free(stream);

    stream = some_stream(ignore, NULL);
    assert_int_equal(ss_stream_push(stream, x, 500, NULL), SS_OK);
    assert_int_equal(ss_stream_end(stream, NULL), SS_OK);
    assert_int_equal(ss_stream_end(stream, NULL), SS_OK);
    assert_int_equal(ss_stream_push(stream, x, 1, &err), SS_EINVAL);
    ss_stream_free(stream);
    ss_stream_free(NULL);
}

static void
sink_stops_the_stream(void **state)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    static double x[5000];
    ss_morlet *plan;
    ss_stream *stream;
    (void)state;
    make(NOISE, x, 5000);
    opts.fmin = 20;
    assert_int_equal(ss_morlet_new(&plan, 5000, 2000, &opts, NULL), SS_OK);
    collection c = { .plan = plan, .w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *c.w),
                     .stop_after = 100 };
    assert_int_equal(ss_stream_new(&stream, 2000, &opts, collect, &c, NULL), SS_OK);
    assert_int_equal(ss_stream_push(stream, x, 1000, NULL), SS_OK);      /* no window is full */
    assert_int_equal(ss_stream_drain(stream, NULL), SS_STOP);
    size_t total = c.total;
    assert_int_equal(ss_stream_end(stream, NULL), SS_STOP);
    assert_int_equal(c.total, total);
    ss_stream_free(stream);
    ss_morlet_free(plan);
    free(c.w);
}

/* --- as files -------------------------------------------------------------------------------- */

typedef struct file {
    ss_writer *writer;
    FILE *out;
} file;

static int
write_rows(const ss_scale *scale, size_t first, size_t n, const double *w, size_t samples,
           void *user)
{
    return ss_writer_coefficients(((file *)user)->writer, scale, first, n, w, samples, NULL) != SS_OK;
}

/* A file of the coefficients of n samples as a stream, and those that the whole record gives. */
static FILE *
file_of_stream(size_t n, ss_format format, int dense, ss_coefficients **whole)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_header *head = NULL, *own;
    assert_int_equal(ss_header_new(&head, 2000, 0.5, NULL), SS_OK);
    ss_signal *signal;
    ss_stream *stream;
    file f = { .out = tmpfile() };
    opts.fmin = 20, opts.voices = 3, opts.dense = dense;
    ss_header_add_column(head, "a", "m/s^2", NULL);
    ss_header_note(head, "made", "by hand", NULL);
    assert_int_equal(ss_signal_new(&signal, head, n, NULL), SS_OK);
    make(NOISE, signal->values, n);
    assert_int_equal(ss_coefficients_header(&own, head, 0, 0, &opts, NULL), SS_OK);
    assert_int_equal(ss_writer_new(&f.writer, f.out, NULL, format,
                                   &(ss_contents){ .grid = &(ss_coefficients){ .head = own } }, NULL), SS_OK);
    assert_int_equal(ss_stream_new(&stream, 2000, &opts, write_rows, &f, NULL), SS_OK);
    feed(stream, signal->values, n, HURRIED);
    assert_int_equal(ss_writer_end(f.writer, n, NULL), SS_OK);
    opts.force = 1;
    opts.fmax = highest(2000, &opts);
    assert_int_equal(ss_morlet_transform(whole, signal, 0, &opts, NULL), SS_OK);
    ss_writer_free(f.writer);
    ss_stream_free(stream);
    ss_signal_free(signal);
    ss_header_free(own);
    ss_header_free(head);
    rewind(f.out);
    return f.out;
}

static void
files_of_streams_read_back_as_the_record_s(void **state)
{
    static const size_t length[] = { 1, 100, 3000 };
    (void)state;
    for (size_t i = 0; i < 4 * LENGTH(length); i++) {
        ss_coefficients *whole, *back;
        ss_error err = { 0 };
        size_t n = length[i / 4];
        FILE *in = file_of_stream(n, i % 2 ? SS_AU : SS_TSV, i / 2 % 2, &whole);
        if (ss_coefficients_read(&back, in, "c", &err) != SS_OK)
            fail_msg("%s", err.text);
        double allow = 2e-6 * ss_coefficients_max(whole);
        assert_int_equal(back->n, n);
        assert_int_equal(back->n_scales, whole->n_scales);
        assert_string_equal(ss_header_find_note(back->head, "made"), "by hand");
        assert_string_equal(back->head->column[0].unit, "m/s^2");
        for (size_t s = 0; s < back->n_scales; s++) {
            const ss_scale *a = &back->scale[s], *b = &whole->scale[s];
            assert_true(a->a == b->a && a->n == b->n && a->offset == b->offset);
            for (size_t k = 0; k < 2 * a->n; k++)
                assert_true(fabs(back->w[2 * a->offset + k] - whole->w[2 * a->offset + k])
                            <= allow);
        }
        ss_coefficients_free(back);
        ss_coefficients_free(whole);
        fclose(in);
    }
}

/* Read a file after one text in it has become another. */
static void
assert_refused(const char *text, size_t size, const char *from, const char *to, const char *says)
{
    ss_coefficients *back = NULL;
    ss_error err = { 0 };
    FILE *in = tmpfile();
    const char *at = text + (*from != '\0' ? 0 : size);
    while (at < text + size && strncmp(at, from, strlen(from)) != 0)    /* AU has NULs */
        at++;
    fwrite(text, 1, (size_t)(at - text), in);
    fputs(to, in);
    assert_true(at + strlen(from) <= text + size);
    fwrite(at + strlen(from), 1, size - (size_t)(at - text) - strlen(from), in);
    rewind(in);
    ss_status st = ss_coefficients_read(&back, in, "c", &err);
    if ((st != SS_EDATA && st != SS_EKIND) || strncmp(err.text, "c:", 2) != 0 || strstr(err.text, says) == NULL)
        fail_msg("'%s' expected, not %d, '%s'", says, st, err.text);
    fclose(in);
}

static void
refuses_streams_that_are_cut_or_changed(void **state)
{
    ss_coefficients *whole;
    char *text = calloc(1 << 20, 1);
    (void)state;
    for (int au = 0; au < 2; au++) {
        FILE *in = file_of_stream(300, au ? SS_AU : SS_TSV, 0, &whole);
        size_t size = fread(text, 1, 1 << 20, in);
        fclose(in);
        ss_coefficients_free(whole);
        text[size] = '\0';
        if (au) {
            assert_refused(text, size - 56, "", "", "cut short");
            assert_refused(text, size - 13, "", "", "truncated");
            assert_refused(text, size, "coefficients 1", "signal 1", "a signal, not wavelet coefficients");
            assert_refused(text, size, "# columns: m ", "# columns: n ", "the columns are not those of wavelet");
            continue;
        }
        size_t cut = (size_t)(strstr(text, "# samples") - text);
        assert_refused(text, cut, "", "", "cut short");
        assert_refused(text, size, "samples: 300", "samples: 301", "ends with ");
        assert_refused(text, size, "samples: 300", "samples: 3000", "ends with ");
        assert_refused(text, size, "samples: 300", "samples: 290", "scale");
        assert_refused(text, size, "samples: 300", "samples: 0.5", "length of a record");
        assert_refused(text, size, "samples: 300", "samples: x", "length of a record");
        /* beyond 2^53, a double is no count */
        assert_refused(text, size, "samples: 300", "samples: 9007199254740992", "is too small for a record");
        assert_refused(text, size, "samples: 300", "samples: 9007199254740994", "length of a record");
        assert_refused(text, size, "samples: 300", "samples: 300\n# samples: 300", "twice");
        assert_refused(text, size, "stream: yes", "stream: no", "lack their option 'samples");
    }
    free(text);
}

static ss_table *
read_table(FILE *text, ss_kind of)
{
    ss_table *table = NULL;
    ss_error err = { 0 };
    rewind(text);
    if (ss_table_read(&table, text, "in", of, &err) != SS_OK)
        fail_msg("%s", err.text);
    return table;
}

static void
reads_back_the_events_that_it_writes(void **state)
{
    static const ss_event event[] = { { 0, -1e-3, 0.1, SS_SLIP, 1 },
                                      { 0.1, 1.0 / 3, -0.25, SS_REVERSE, -1 } };
    FILE *text = tmpfile();
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1, 0, NULL), SS_OK);
    ss_writer *writer = NULL;
    (void)state;
    assert_int_equal(ss_header_note(head, "scene", "mine", NULL), SS_OK);
    assert_int_equal(ss_writer_new(&writer, text, NULL, SS_TSV,
                                   &(ss_contents){ .signal = head, .events = 1 }, NULL), SS_OK);
    for (size_t i = 0; i < 2; i++)
        assert_int_equal(ss_writer_events(writer, &event[i], 1, NULL), SS_OK);
    assert_int_equal(ss_writer_end(writer, 0, NULL), SS_OK);
    ss_writer_free(writer);
    ss_table *t = read_table(text, SS_KIND_EVENTS);
    assert_int_equal(t->n, 2);
    assert_int_equal(t->n_columns, 5);
    assert_string_equal(ss_table_note(t, "scene"), "mine");
    assert_null(ss_table_note(t, "scen"));
    assert_string_equal(t->column[3].name, "v");
    assert_string_equal(t->column[3].unit, "m/s");
    for (size_t i = 0; i < 2; i++) {
        assert_true(ss_table_number(t, i, 0) == event[i].t && ss_table_number(t, i, 2) == event[i].x);
        assert_true(ss_table_number(t, i, (size_t)ss_table_column(t, "direction"))
                    == event[i].direction);
    }
    assert_string_equal(t->cell[5 + 1], "reverse");
    assert_true(isnan(ss_table_number(t, 1, 1)));
    ss_table_free(t);
    ss_header_free(head);
    fclose(text);
}

/* A ranking of two scenes, the second first, whose criteria have the values 1, 2 ... of exact text. */
static ss_ranking
make_ranking(ss_rank_row row[2], ss_verdict verdict)
{
    ss_ranking r = { .verdict = verdict, .forcing_frequency = 1.25, .noise = NAN, .n = 2, .row = row };
    for (size_t i = 0; i < 2; i++) {
        row[i] = (ss_rank_row){ .scene = 1 - i, .explained = 0.99975, .total = 0.5 + 10 * (double)i };
        for (int k = 0; k < SS_CRITERIA; k++) {
            row[i].value[k] = k == SS_BY_MAP ? NAN : k + 1;
            row[i].distance[k] = (double)i * ss_criterion_rules[k].threshold;
            r.value[k] = -k;
        }
    }
    return r;
}

static void
rows_on_a_full_disk_are_an_error(void **state)
{
    static const char *const scene[] = { "mine", "other" };
    const ss_ranking_text about = { "run.tsv", "acc", "its unit", scene, 0 };
    static const ss_format format[] = { SS_TSV, SS_CSV, SS_JSON };
    ss_rank_row row[2];
    ss_ranking r = make_ranking(row, SS_NAMED);
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        FILE *full = fopen("/dev/full", "w");
        if (full == NULL)
            skip();
        assert_int_equal(ss_ranking_write(&r, &about, NULL, full, format[i], NULL), SS_EIO);
        fclose(full);
    }
}

static void
reads_back_the_ranking_that_it_writes(void **state)
{
    static const char *const scene[] = { "mine", "other[x=1]" };
    const ss_ranking_text about = { "run.tsv", "acc", "its unit", scene, 0 };
    (void)state;
    for (ss_verdict verdict = SS_UNDECIDED; verdict <= SS_NAMED; verdict++) {
        ss_rank_row row[2];
        ss_ranking r = make_ranking(row, verdict);
        FILE *text = tmpfile();
        strcpy(r.why, verdict == SS_NAMED ? "" : "it is near");
        assert_int_equal(ss_ranking_write(&r, &about, NULL, text, SS_TSV, NULL), SS_OK);
        ss_table *t = read_table(text, SS_KIND_RANKING);
        assert_string_equal(ss_table_note(t, "signal_name"), "run.tsv");
        assert_string_equal(ss_table_note(t, "quantity"), "a (its unit)");
        assert_string_equal(ss_table_note(t, "forcing_frequency"), "1.25");
        assert_string_equal(ss_table_note(t, "noise"), "- % of the power, at most");
        assert_string_equal(ss_table_note(t, "answer"), verdict == SS_NAMED
                            ? "other[x=1] explains 99.975 % of the signal's power"
                            : "cannot tell: it is near; other[x=1] explains most, 99.975 %");
        assert_int_equal(t->n, 2);
        assert_int_equal(t->n_columns, 3 + 2 * SS_CRITERIA);
        assert_string_equal(t->column[3 + 2 * SS_BY_SLOPE].name, "slope");
        assert_string_equal(t->column[3 + 2 * SS_BY_SLOPE].unit, "dB/octave");
        for (size_t i = 0; i < 2; i++) {
            double rank = ss_table_number(t, i, 0);
            assert_true(verdict == SS_NAMED ? rank == (double)i + 1 : isnan(rank));
            assert_string_equal(t->cell[i * t->n_columns + 1], scene[1 - i]);
            assert_true(ss_table_number(t, i, 2) == row[i].total);
            for (size_t k = 0; k < SS_CRITERIA; k++) {
                double value = ss_table_number(t, i, 3 + 2 * k);
                assert_true(k == SS_BY_MAP ? isnan(value) : value == row[i].value[k]);
                assert_true(ss_table_number(t, i, 4 + 2 * k) == (double)i);
            }
        }
        ss_table_free(t);
        fclose(text);
    }
}

static void
refuses_tables_that_are_malformed(void **state)
{
    static const struct { const char *text, *why; } bad[] = {
        { "", "in: empty" },
        { "# stickslip trade 1\n", "in: no '# columns:' line in the header" },
        { "# stickslip trade 1\n1\t2\n", "in:2: no '# columns:' line in the header" },
        { "# stickslip trade 1\n# columns: a b\n1\t2\n1\n", "in:4: expected 2 columns, found 1" },
        { "# stickslip trade 1\n# columns: a b\n# columns: a\n", "in:3: other columns than before" } };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        FILE *in = tmpfile();
        ss_table *table = NULL;
        ss_error err = { 0 };
        fputs(bad[i].text, in);
        rewind(in);
        assert_int_equal(ss_table_read(&table, in, "in", SS_KIND_TRADE, &err), SS_EDATA);
        assert_string_equal(err.text, bad[i].why);
        assert_null(table);
        fclose(in);
    }
}

static void
names_each_format_that_is_written(void **state)
{
    static const ss_format_info known[] = { { SS_TSV, "tsv", 1 }, { SS_AU, "au", 0 }, { SS_CSV, "csv", 1 },
                                            { SS_JSON, "json", 1 }, { SS_WAV, "wav", 0 } };
    ss_format_info found;
    size_t i = 0;
    (void)state;
    for (; ss_format_at(&found, i); i++) {
        assert_true(i < sizeof known / sizeof *known);
        assert_int_equal(found.format, known[i].format);
        assert_string_equal(found.name, known[i].name);
        assert_int_equal(found.has_words, known[i].has_words);
    }
    assert_int_equal(i, sizeof known / sizeof *known);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_each_format_that_is_written),
        cmocka_unit_test(reads_back_the_events_that_it_writes),
        cmocka_unit_test(rows_on_a_full_disk_are_an_error),
        cmocka_unit_test(reads_back_the_ranking_that_it_writes),
        cmocka_unit_test(refuses_tables_that_are_malformed),
        cmocka_unit_test(keeps_the_record_s_bound_whatever_comes_together),
        cmocka_unit_test(keeps_the_bound_from_window_to_window),
        cmocka_unit_test(quiet_beginning_is_as_accurate_as_by_itself),
        cmocka_unit_test(blocks_are_those_of_the_record),
        cmocka_unit_test(delay_is_the_window),
        cmocka_unit_test(windows_delay_coefficients_by_less_than_their_length),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(amplitudes_of_any_size_scale_the_coefficients),
        cmocka_unit_test(refuses_what_a_stream_cannot_do),
        cmocka_unit_test(fails_once_and_for_all),
        cmocka_unit_test(sink_stops_the_stream),
        cmocka_unit_test(files_of_streams_read_back_as_the_record_s),
        cmocka_unit_test(refuses_streams_that_are_cut_or_changed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
