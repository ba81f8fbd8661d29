/* test_wavelet_extremes.c -- records far from any that are usual: the accuracy is what is promised,
 * or the refusal says why.
 *
 * Every row is transformed by both engines and held against the sum in long double
 * (morlet_oracle.h), for the bound in stickslip/morlet.h. */
#include <stdlib.h>
#include <string.h>
#include "map/map.h"

#include "morlet_oracle.h"
#include "unit.h"

#define LENGTH(a) (sizeof (a) / sizeof *(a))

typedef enum shape {
    CONSTANT, FIRST_ONLY, LAST_ONLY, BOTH_ENDS, OSCILLATION, ALTERNATING, DECAY, ZERO
} shape;

/* n samples of a shape of size 1, times size, on an offset. */
static double *
record_of(shape which, size_t n, double size, double offset)
{
    double *x = malloc(n * sizeof *x);
    make(TONE, x, n);
    for (size_t i = 0; i < n; i++) {
        int first = i == 0, last = i == n - 1;
        double t = (double)i, y = 0;
        switch (which) {
        case CONSTANT:    y = 1; break;
        case FIRST_ONLY:  y = first; break;
        case LAST_ONLY:   y = last; break;
        case BOTH_ENDS:   y = first || last; break;
        case OSCILLATION: y = x[i]; break;
        case ALTERNATING: y = i % 2 ? -1 : 1; break;
        case DECAY:       y = exp(-900 * t / (double)n); break;     /* through all subnormals to 0 */
        case ZERO:        break;
        }
        x[i] = y * size + offset;
    }
    return x;
}

static const struct row {
    const char *what;
    shape shape;
    size_t n;
    double size, offset, rate, center;
    int m_rel[2];               /* octaves of scales from a sample's length; { 0 }: default */
} row[] = {
    { "1e300",                       OSCILLATION, 400, 1e300,  0, 2000, 6, { 0 } },
    { "1e-300",                      OSCILLATION, 400, 1e-300, 0, 2000, 6, { 0 } },
    { "subnormal",                   OSCILLATION, 400, 1e-310, 0, 2000, 6, { 0 } },
    { "the least there is",          ALTERNATING, 400, 4.94e-324, 0, 2000, 6, { 0 } },
    { "the largest there is",        ALTERNATING, 400, 1.7976931348623157e308, 0, 2000, 6, { 0 } },
    { "a decay through subnormals",  DECAY,       700, 1, 0, 2000, 6, { 0 } },
    { "one on an offset of 1e12",    OSCILLATION, 400, 1, 1e12, 2000, 6, { 0 } },
    { "a constant",                  CONSTANT,    400, 1, 0, 2000, 6, { 0 } },
    { "a constant, center 2",        CONSTANT,    400, 1, 0, 2000, 2, { 0 } },
    { "nothing",                     ZERO,        400, 1, 0, 2000, 6, { 0 } },
    { "the fastest oscillation",     ALTERNATING, 400, 1, 0, 2000, 6, { 0 } },
    { "the first sample alone",      FIRST_ONLY,  400, 1, 0, 2000, 6, { 0 } },
    { "the last sample alone",       LAST_ONLY,   400, 1, 0, 2000, 6, { 0 } },
    { "both",                        BOTH_ENDS,   401, 1, 0, 2000, 6, { 0 } },
    { "1 sample",                    CONSTANT,      1, 3, 0, 2000, 6, { -3, 5 } },
    { "2 samples",                   ALTERNATING,   2, 3, 0, 2000, 6, { -3, 5 } },
    { "3 samples",                   OSCILLATION,   3, 3, 0, 2000, 6, { -3, 5 } },
    { "center 2",                    OSCILLATION, 400, 1, 0, 2000, 2, { 0 } },
    { "center 30",                   OSCILLATION, 900, 1, 0, 2000, 30, { 0 } },
    { "center 1000",                 OSCILLATION, 1500, 1, 0, 2000, 1000, { 0 } },
    { "scales from 1/8 sample to 20 records", OSCILLATION, 100, 1, 0, 2000, 6, { -3, 11 } },
    { "such scales of a last sample", LAST_ONLY,  100, 1, 0, 2000, 6, { -3, 11 } },
    { "such scales, center 100",     OSCILLATION, 100, 1, 0, 2000, 100, { -3, 11 } },
    { "1 Hz",                        OSCILLATION, 400, 1, 0, 1, 6, { 0 } },     /* times are */
    { "1/25 Hz",                     OSCILLATION, 400, 1, 0, 0.04, 6, { 0 } },  /* samples here */
    { "1e-3 Hz",                     OSCILLATION, 400, 1, 0, 1e-3, 6, { 0 } },
    { "1e9 Hz",                      OSCILLATION, 400, 1, 0, 1e9, 6, { 0 } },
    { "1e-100 Hz",                   OSCILLATION, 400, 1, 0, 1e-100, 6, { 0 } },
    { "1e100 Hz",                    OSCILLATION, 400, 1, 0, 1e100, 6, { 0 } },
    { "1e300 at 1e-3 Hz",            OSCILLATION, 400, 1e300, 0, 1e-3, 6, { 0 } },
    { "1e-300 at 1e9 Hz",            OSCILLATION, 400, 1e-300, 0, 1e9, 6, { 0 } },
};

static ss_morlet_opts
options_of(const struct row *r)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.center = r->center;
    opts.voices = 3;
    opts.step = 0.4;
    if (r->m_rel[0] != r->m_rel[1]) {
        opts.force = opts.octaves = 1;
        opts.m0 = r->m_rel[0] - floor(log2(r->rate));
        opts.m1 = r->m_rel[1] - floor(log2(r->rate));
    }
    return opts;
}

static void
extreme_records_keep_the_bound(void **state)
{
    static const double accuracy[] = { 1e-3, 1e-6, 1e-12 };
    (void)state;
    for (size_t i = 0; i < LENGTH(row); i++)
        for (size_t k = 0; k < 4 * LENGTH(accuracy); k++) {
            const struct row *r = &row[i];
            double *x = record_of(r->shape, r->n, r->size, r->offset);
            ss_morlet_opts opts = options_of(r);
            ss_morlet *plan = NULL;
            ss_error err = { 0 };
            opts.engine = k % 2 ? SS_ENGINE_QUADRATURE : SS_ENGINE_FFT;
            opts.exact = k / 2 % 2;
            opts.accuracy = accuracy[k / 4];
            if (ss_morlet_new(&plan, r->n, r->rate, &opts, &err) != SS_OK)
                fail_msg("%s: %s", r->what, err.text);
            double *w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w);
            if (ss_morlet_execute(plan, x, w, &err) != SS_OK)
                fail_msg("%s: %s", r->what, err.text);
            size_t every = 1 + ss_morlet_grid(plan)->total * r->n / 20000;
            double worst = worst_error(plan, x, r->n, r->rate, &opts, w, every);
            if (!(worst <= 1))
                fail_msg("%s, engine %d, %s steps, accuracy %g: %g times the bound", r->what,
                         opts.engine, opts.exact ? "exact" : "near", opts.accuracy, worst);
            ss_morlet_free(plan);
            free(w);
            free(x);
        }
}

/* Less its mean, an oscillation of 1 on 1e12 is known as well as its samples are: half an ulp of
 * 1e12, 6.1e-5 each, times the sum of |h|, a^1/2 pi^-1/4 sqrt(2 pi) = 1.9 a^1/2. */
static void
an_oscillation_is_seen_on_an_offset_of_1e12(void **state)
{
    enum { N = 4000 };
    double *on_offset = record_of(OSCILLATION, N, 1, 1e12), *alone = record_of(OSCILLATION, N, 1, 0);
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan = NULL;
    (void)state;
    opts.detrend = SS_DETREND_MEAN;
    assert_int_equal(ss_morlet_new(&plan, N, 2000, &opts, NULL), SS_OK);
    double *u = malloc(2 * ss_morlet_grid(plan)->total * sizeof *u);
    double *v = malloc(2 * ss_morlet_grid(plan)->total * sizeof *v);
    assert_int_equal(ss_morlet_execute(plan, on_offset, u, NULL), SS_OK);
    assert_int_equal(ss_morlet_execute(plan, alone, v, NULL), SS_OK);
    for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++) {
        const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
        double allow = sqrt(sc->a) * (1.9 * 6.2e-5 + 4 * opts.accuracy);
        for (size_t c = 2 * sc->offset; c < 2 * (sc->offset + sc->n); c++)
            if (!(fabs(u[c] - v[c]) <= allow))
                fail_msg("scale %zu: %g beside %g", i, u[c], v[c]);
    }
    ss_morlet_free(plan);
    free(u), free(v), free(on_offset), free(alone);
}

/* --- refusals ------------------------------------------------------------------------------ */

static const struct refusal {
    const char *what;
    shape shape;
    size_t n;
    double size, spoil;         /* spoil: put in place of sample 17; 0: none */
    double rate, center;
    const char *says;
} refusal[] = {
    { "NaN", CONSTANT, 400, 1, NAN, 2000, 6, "sample 18 is NaN, not a finite number" },
    { "infinity", CONSTANT, 400, 1, -INFINITY, 2000, 6, "sample 18 is infinite" },
    { "a record of NaN", CONSTANT, 400, NAN, 0, 2000, 6, "sample 1 is NaN" },
    { "1 sample", CONSTANT, 1, 1, 0, 2000, 6, "too short for any scale" },
    { "2 samples", CONSTANT, 2, 1, 0, 2000, 6, "a record of 2 samples at 2000 Hz is too short for" },
    { "center 1", CONSTANT, 400, 1, 0, 2000, 1, "center 1 is out of range 2 ... 1000" },
    { "center 1001", CONSTANT, 400, 1, 0, 2000, 1001, "center 1001 is out of range 2 ... 1000" },
    { "center 1000 on a short record", CONSTANT, 400, 1, 0, 2000, 1000, "too short for any scale" },
    { "no rate", CONSTANT, 400, 1, 0, 0, 6, "rate [Hz] 0 is out of range" },
    { "a rate beyond all", CONSTANT, 400, 1, 0, 1e101, 6, "rate [Hz] 1e+101 is out of range" },
};

static void
what_cannot_be_is_refused_in_words(void **state)
{
    (void)state;
    for (size_t i = 0; i < LENGTH(refusal); i++) {
        const struct refusal *r = &refusal[i];
        double *x = record_of(r->shape, r->n, r->size, 0), *w = NULL;
        ss_morlet_opts opts = ss_morlet_defaults;
        ss_morlet *plan = NULL;
        ss_error err = { 0 };
        opts.center = r->center;
        if (r->spoil != 0)
            x[17] = r->spoil;
        ss_status st = ss_morlet_new(&plan, r->n, r->rate, &opts, &err);
        if (st == SS_OK) {
            w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w);
            st = ss_morlet_execute(plan, x, w, &err);
        }
        if (st == SS_OK || strstr(err.text, r->says) == NULL)
            fail_msg("%s: '%s', not '%s'", r->what, err.text, r->says);
        ss_morlet_free(plan);
        free(w);
        free(x);
    }
}

/* --- a long record ------------------------------------------------------------------------- */

/* 2^26 samples on the dyadic grid, one coefficient in 2^20 of the long scales and of the short ones
 * looked at; with LONG=1 only: it takes 3 GB. */
static void
two_to_the_26_samples_keep_the_bound(void **state)
{
    const size_t n = (size_t)1 << 26;
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan = NULL;
    const char *wanted = getenv("LONG");
    (void)state;
    if (wanted == NULL || *wanted == '\0')
        skip();
    double *x = record_of(OSCILLATION, n, 1, 0);
    for (size_t i = 0; i < n; i += 4099)
        x[i] += 1;
    opts.voices = 1;
    opts.step = 1;
    opts.accuracy = 1e-9;
    opts.fmin = 0.5;            /* longer scales have too many taps for the sum in long double */
    assert_int_equal(ss_morlet_new(&plan, n, 2000, &opts, NULL), SS_OK);
    double *w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w);
    assert_int_equal(ss_morlet_execute(plan, x, w, NULL), SS_OK);
    for (size_t i = 0; i < ss_morlet_grid(plan)->n_scales; i++) {
        const ss_scale *sc = &ss_morlet_grid(plan)->scale[i];
        double most = 0;
        for (size_t k = 0; k < sc->n; k++)
            most = fmax(most, hypot(w[2 * (sc->offset + k)], w[2 * (sc->offset + k) + 1]));
        for (size_t k = sc->n / 7; k < sc->n; k += sc->n / 5 + 1) {
            const double *got = w + 2 * (sc->offset + k);
            double b = ss_scale_b(sc, k);
            size_t centre = (size_t)(b * 2000), reach = (size_t)(12 * sc->a * 2000) + 2;
            size_t from = centre > reach ? centre - reach : 0;
            size_t to = centre + reach < n ? centre + reach : n;
            long double want[2];
            /* the part of the record that the wavelet sees, on a clock of its own */
            double start = (double)from / 2000;
            oracle(x + from, to - from, 2000, &opts, sc->a, b - start, want);
            /* b - start is rounded as b is, which turns the phase by omega_c / a times that */
            double bound = opts.accuracy * most + sqrt(sc->a) * 2 * (16 * DBL_EPSILON
                + (6 / sc->a) * DBL_EPSILON * b + oracle_error(&opts));
            assert_true(hypotl(got[0] - want[0], got[1] - want[1]) <= bound);
        }
    }
    ss_morlet_free(plan);
    free(w);
    free(x);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(extreme_records_keep_the_bound),
        cmocka_unit_test(an_oscillation_is_seen_on_an_offset_of_1e12),
        cmocka_unit_test(what_cannot_be_is_refused_in_words),
        cmocka_unit_test(two_to_the_26_samples_keep_the_bound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
