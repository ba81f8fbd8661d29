/* test_features.c -- maxima and spikes on maps whose hills are known. */
#include <stdlib.h>
#include <string.h>
#include <math.h>
#include <stickslip.h>
#include "find/maxima.h"
#include "map/map.h"
#include "signal/header.h"

#include "new_signal.h"

/* A map of the transform's grid, filled with a function of time and octaves. */
typedef double height(double t, double m);      /* dB */

static ss_status
find_maxima(ss_maximum **out, size_t *n, const ss_coefficients *map, double prominence)
{
    double top;
    return ss_maxima_of(out, n, map, &(maxima_kind){ .prominence = prominence, .range = INFINITY }, &top);
}

/* The maxima of |W| over time along one scale. */
static ss_status
find_along(ss_maximum **out, size_t *n, const ss_coefficients *map, size_t scale, double range, double prominence)
{
    const maxima_kind kind = { .prominence = prominence, .range = range };
    return ss_maxima_of_row(out, n, map, scale, &kind, ss_coefficients_max(map));
}

static ss_coefficients *
long_map_of(height *h, double step, size_t samples)
{
    ss_signal *signal = new_signal(samples, 1000, 0, "a", "");
    ss_coefficients *coef = NULL;
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.octaves = 1, opts.m0 = -6, opts.m1 = -2, opts.voices = 8, opts.step = step;
    opts.dense = step == 0, opts.force = 1;
    assert_int_equal(ss_morlet_transform(&coef, signal, 0, &opts, NULL), SS_OK);
    for (size_t i = 0; i < coef->n_scales; i++) {
        const ss_scale *sc = &coef->scale[i];
        for (size_t k = 0; k < sc->n; k++) {
            coef->w[2 * (sc->offset + k)] = 0;
            coef->w[2 * (sc->offset + k) + 1] = -pow(10, h(ss_scale_b(sc, k), sc->m) / 20);
        }
    }
    ss_signal_free(signal);
    return coef;
}

static ss_coefficients *
map_of(height *h, double step)
{
    return long_map_of(h, step, 4000);
}

/* A hill of given height at (t, m), falling by 40 dB in 0.5 s or 2 octaves, as a cone. */
static double
hill(double top, double t0, double m0, double t, double m)
{
    return top - 40 * hypot((t - t0) / 0.5, (m - m0) / 2);
}

/* Hills at 1, 2 and 3.2 s: half way between neighbours of one height h the saddle lies at
 * h - 40 (distance / 2) / 0.5; between unequal ones where the cones meet. */
static double
three_hills(double t, double m)
{
    double one = hill(0, 1, -4, t, m), two = hill(-10, 2, -4, t, m);
    return fmax(fmax(one, two), hill(-3, 3.2, -4, t, m));
}

/* Saddles: 1 and 2 meet at 1.5 + 0.0625 s: -45 dB; 2 and 3 at 2.6 - 0.04375 s: -54.5 dB.  So 0 is
 * never ended, -10 falls 35 to the first, and -3 falls 51.5. */
static void
prominence_is_the_fall_to_the_highest_saddle(void **state)
{
    static const double step[] = { 0.25, 0.1, 0 };  /* 0: dense */
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        ss_coefficients *coef = map_of(three_hills, step[i]);
        ss_maximum *peak = NULL;
        size_t n = 0;
        double grid = step[i] == 0 ? 0.001 : step[i] * 0x1p-4;      /* in time, at m = -4 */
        double blur = 80 * 2 * grid;        /* a slope of 80 dB/s, a peak or saddle off the grid */
        assert_int_equal(find_maxima(&peak, &n, coef, 20), SS_OK);
        assert_int_equal(n, 3);
        assert_true(fabs(peak[0].t - 1) <= grid && fabs(peak[1].t - 2) <= grid
                    && fabs(peak[2].t - 3.2) <= grid);
        for (size_t k = 0; k < 3; k++)
            assert_true(fabs(peak[k].f / (6 / (2 * M_PI * 0x1p-4)) - 1) < 1e-12);
        assert_true(isinf(peak[0].prominence) && peak[0].level == 0);
        assert_true(fabs(peak[1].level + 10) <= blur && fabs(peak[2].level + 3) <= blur);
        assert_true(fabs(peak[1].prominence - 35) <= 2 * blur);
        assert_true(fabs(peak[2].prominence - 51.5) <= 2 * blur);
        free(peak);
        assert_int_equal(find_maxima(&peak, &n, coef, 45), SS_OK);
        assert_int_equal(n, 2);
        free(peak);
        ss_coefficients_free(coef);
    }
}

#define APART 1.7

static double
declining_hills(double t, double m)
{
    return 10 * cos(2 * M_PI * t / APART) - 0.01 * t - 10 * (m + 4) * (m + 4);
}

/* 700 s, five million points: more than are in memory at a time.  Each hill falls 20 dB, less what the
 * saddle behind the hill before, which is higher, lies higher. */
static void
long_maps_have_no_seams(void **state)
{
    ss_coefficients *coef = long_map_of(declining_hills, 0.1, 700000);
    ss_maximum *peak = NULL;
    size_t n = 0;
    (void)state;
    const ss_scale *last = &coef->scale[coef->n_scales - 1];
    assert_true(last->offset + last->n > 5000000);
    assert_int_equal(find_maxima(&peak, &n, coef, 0), SS_OK);
    assert_int_equal(n, 411);
    assert_true(isinf(peak[0].prominence));
    for (size_t k = 0; k < n; k++) {
        assert_true(fabs(peak[k].t - (double)(k + 1) * APART) <= 0.1 * 0x1p-4);
        assert_true(k == 0 || fabs(peak[k].prominence - (20 - 0.01 * APART / 2)) < 0.002);
    }
    free(peak);
    ss_coefficients_free(coef);
}

/* A higher hill within the cone of influence: levels are those over the highest place outside. */
static double
hill_beside_the_cone(double t, double m)
{
    return fmax(hill(20, 0, -2, t, m), hill(0, 2, -4, t, m));
}

/* The one maximum of a map with at least so large a prominence. */
static ss_maximum
only_maximum(height *h, double step, double prominence)
{
    ss_coefficients *coef = map_of(h, step);
    ss_maximum *peak = NULL, only;
    size_t n = 0;
    assert_int_equal(find_maxima(&peak, &n, coef, prominence), SS_OK);
    assert_int_equal(n, 1);
    only = peak[0];
    free(peak);
    ss_coefficients_free(coef);
    return only;
}

static void
levels_are_over_the_largest_outside_the_cone(void **state)
{
    const ss_maximum peak = only_maximum(hill_beside_the_cone, 0.25, 20);
    (void)state;
    assert_true(fabs(peak.t - 2) < 0.25 * 0x1p-4 && peak.level == 0);
}

static double
slope(double t, double m)
{
    return 3 * t + m;
}

static double
plateau(double t, double m)
{
    (void)t, (void)m;
    return -20;
}

static double
ridge_on_the_border(double t, double m)
{
    return fmax(-5 * (m + 6) - 10 * fabs(t - 2), hill(-8, 3, -4, t, m));
}

static void
slopes_plateaus_and_borders_are_no_maxima(void **state)
{
    static height *const h[] = { slope, plateau };
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        ss_coefficients *coef = map_of(h[i], 0.25);
        ss_maximum *peak = NULL;
        size_t n = 9;
        assert_int_equal(find_maxima(&peak, &n, coef, 0), SS_OK);
        assert_int_equal(n, 0);
        free(peak);
        ss_coefficients_free(coef);
    }
}

/* The ridge is cut by the map's border but it is higher ground: the hill's fall is finite. */
static void
the_border_is_higher_ground(void **state)
{
    const ss_maximum peak = only_maximum(ridge_on_the_border, 0, 3);
    (void)state;
    assert_true(fabs(peak.t - 3) < 0.01 && isfinite(peak.prominence));
}

/* In the last row a ridge that falls from its top at 3 s; in the row beside it a hill at 2 s. */
static double
hill_beside_the_border(double t, double m)
{
    return m < -6 + 0.5 / 8 ? -5 * fabs(t - 3) : m < -6 + 1.5 / 8 ? -3 - 80 * fabs(t - 2) : -300;
}

/* The way from the hill to the ridge leads from row to row: down to where 3 + 80 d = 5 (1 - d), a fall of 80 d.
 * The hill falls .08 dB from a sample to the next; no sample need be at the lowest place of the way. */
static void
the_border_is_reached_from_the_row_beside_it(void **state)
{
    const ss_maximum peak = only_maximum(hill_beside_the_border, 0, 1);
    (void)state;
    assert_true(fabs(peak.t - 2) < 1e-9 && fabs(peak.prominence - 80 * 2 / 85.) <= 0.08);
}

static void
silence_has_no_maxima(void **state)
{
    ss_coefficients *coef = map_of(plateau, 0.25);
    ss_maximum *peak = NULL;
    size_t n = 9, last = coef->n_scales - 1;
    (void)state;
    memset(coef->w, 0, 2 * (coef->scale[last].offset + coef->scale[last].n) * sizeof *coef->w);
    assert_int_equal(find_maxima(&peak, &n, coef, 0), SS_OK);
    assert_int_equal(n, 0);
    free(peak);
    assert_int_equal(find_along(&peak, &n, coef, last, 40, 0), SS_OK);
    assert_int_equal(n, 0);
    free(peak);
    ss_coefficients_free(coef);
}

/* Along the row through the tops the same falls; range leaves out what is too low. */
static void
spikes_are_the_maxima_of_one_scale(void **state)
{
    ss_coefficients *coef = map_of(three_hills, 0);
    ss_maximum *peak = NULL;
    size_t n = 0, row = 0;
    (void)state;
    while (coef->scale[row].m > -4)
        row++;
    assert_int_equal(find_along(&peak, &n, coef, row, 40, 5), SS_OK);
    assert_int_equal(n, 3);
    assert_true(fabs(peak[1].prominence - 35) < 0.4 && fabs(peak[2].prominence - 51.5) < 0.4);
    free(peak);
    assert_int_equal(find_along(&peak, &n, coef, row, 5, 5), SS_OK);
    assert_int_equal(n, 2);
    free(peak);
    ss_coefficients_free(coef);
}

/* exp(-t^2/(2 s^2)) cos: |W| peaks in the middle; its label is within 3 %
 * of the frequency, 1.35 % of it the convention of a^-1/2 and the rest the step of 1/16 octave. */
static void
finds_two_tone_bursts(void **state)
{
    enum { N = 6000 };
    ss_signal *signal = new_signal(N, 2000, 0, "a", "m/s^2");
    ss_coefficients *coef = NULL;
    ss_maximum *peak = NULL;
    size_t n = 0, all;
    (void)state;
    for (size_t i = 0; i < N; i++) {
        double t = (double)i / 2000, u = (t - 1) / 0.1, v = (t - 2.2) / 0.1;
        signal->values[i] = exp(-u * u / 2) * cos(2 * M_PI * 45 * t)
            + 0.2 * exp(-v * v / 2) * cos(2 * M_PI * 100 * t);
    }
    assert_int_equal(ss_morlet_transform(&coef, signal, 0, &ss_morlet_defaults, NULL), SS_OK);
    assert_int_equal(find_maxima(&peak, &all, coef, 80. / 18), SS_OK);
    for (size_t i = 0; i < all; i++)
        if (peak[i].level > -80)        /* below is what accuracy leaves of silence */
            peak[n++] = peak[i];
    assert_int_equal(n, 2);
    assert_true(fabs(peak[0].t - 1) < 0.01 && fabs(peak[1].t - 2.2) < 0.01);
    assert_true(fabs(peak[0].f / 45 - 1) < 0.03 && fabs(peak[1].f / 100 - 1) < 0.03);
    assert_true(isinf(peak[0].prominence) && peak[1].prominence > 40);
    free(peak);
    ss_coefficients_free(coef);
    ss_signal_free(signal);
}

/* So long that the map is passed over in several strips, with a burst at each quarter of the record,
 * where strips may meet: each burst is one maximum, and all are alike. */
static void
a_long_map_has_the_maxima_of_a_short_one(void **state)
{
    enum { RATE = 1000, EVERY = 500, N = 1600 * EVERY };
    ss_signal *signal = new_signal(N, RATE, 0, "a", "");
    ss_coefficients *coef;
    ss_maximum *peak;
    ss_morlet_opts opts = ss_morlet_defaults;
    size_t n = 0, inside = 0;
    double least = INFINITY, most = 0;
    (void)state;
    for (size_t i = 0; i < N; i++) {
        double u = ((double)((i + EVERY / 2) % EVERY) - EVERY / 2.) / 80;
        signal->values[i] = exp(-u * u / 2) * cos(2 * M_PI * 50 * 80. / RATE * u);
    }
    opts.fmin = 20, opts.fmax = 120;
    assert_int_equal(ss_morlet_transform(&coef, signal, 0, &opts, NULL), SS_OK);
    assert_true(coef->scale[coef->n_scales - 1].offset > 4 << 20);
    assert_int_equal(find_maxima(&peak, &n, coef, 20), SS_OK);
    for (size_t i = 0; i < n; i++) {
        double at = peak[i].t * RATE;
        if (at < EVERY / 2. || at > N - EVERY / 2.)     /* a burst that an end cuts */
            continue;
        inside++;
        assert_true(fabs(at - EVERY * (double)inside) < 10);
        assert_true(fabs(log2(peak[i].f / 50)) < 0.1);
        least = fmin(least, peak[i].prominence);
        most = fmax(most, isfinite(peak[i].prominence) ? peak[i].prominence : 0);
    }
    assert_int_equal(inside, N / EVERY - 1);
    if (!(most - least < 3))
        fail_msg("prominences of %g to %g dB", least, most);
    free(peak);
    ss_coefficients_free(coef);
    ss_signal_free(signal);
}

/* What people write above columns: a unit says it, and without one a word that stands apart. */
static void
names_and_units_tell_the_quantity(void **state)
{
    static const struct { char name[24], unit[12]; column_quantity is; } row[] = {
        { "x", "kN", QUANTITY_FORCE }, { "force", "mm", QUANTITY_DISPLACEMENT },
        { "force", "m/s^2", QUANTITY_MOTION }, { "q", "(mm/s)", QUANTITY_MOTION },
        { "friction force", "", QUANTITY_FORCE }, { "2_Fx", "", QUANTITY_FORCE }, { "Load [V]", "V", QUANTITY_FORCE },
        { "my position", "", QUANTITY_DISPLACEMENT }, { "x1", "", QUANTITY_DISPLACEMENT },
        { "table speed", "", QUANTITY_MOTION }, { "acc.", "g", QUANTITY_MOTION },
        { "reinforced", "", QUANTITY_UNKNOWN }, { "taxi", "", QUANTITY_UNKNOWN }, { "ch0", "V", QUANTITY_UNKNOWN },
        { "", "", QUANTITY_UNKNOWN },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        if (ss_column_quantity(&(ss_column){ (char *)row[i].name, (char *)row[i].unit }) != row[i].is)
            fail_msg("'%s' in '%s' is no %d", row[i].name, row[i].unit, row[i].is);
}

/* An empty record has features that can be written. */
static void
an_empty_record_has_no_spikes(void **state)
{
    ss_signal *signal = new_signal(0, 1000, 0, "a", "");
    ss_features *found = NULL;
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    (void)state;
    assert_int_equal(ss_features_find(&found, signal, 0, NULL, NULL), SS_OK);
    assert_int_equal(ss_features_write(found, signal, 0, NULL, out, SS_TSV, NULL), SS_OK);
    fclose(out);
    assert_non_null(strstr(text, "# spikes: none, the recording is too short\n"));
    free(text);
    ss_features_free(found);
    ss_signal_free(signal);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(prominence_is_the_fall_to_the_highest_saddle),
        cmocka_unit_test(an_empty_record_has_no_spikes),
        cmocka_unit_test(long_maps_have_no_seams),
        cmocka_unit_test(levels_are_over_the_largest_outside_the_cone),
        cmocka_unit_test(slopes_plateaus_and_borders_are_no_maxima),
        cmocka_unit_test(the_border_is_higher_ground),
        cmocka_unit_test(the_border_is_reached_from_the_row_beside_it),
        cmocka_unit_test(silence_has_no_maxima),
        cmocka_unit_test(spikes_are_the_maxima_of_one_scale),
        cmocka_unit_test(finds_two_tone_bursts),
        cmocka_unit_test(a_long_map_has_the_maxima_of_a_short_one),
        cmocka_unit_test(names_and_units_tell_the_quantity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
