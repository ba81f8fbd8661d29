/* test_contour.c -- contours of noise: lines end where it begins; colours lie between their lines, ridges
 * on oscillations, palettes are even, marks beyond the map are left out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "map/map.h"
#include "plot/contour.h"
#include "contour_script.h"
#include "shipped.h"
#include "unit.h"
#include "signal/header.h"
#include "noise_rms.h"
#include "signal/noise.h"

static const char *const scene[] = { "coulomb", "state-variable", "compliant-heavy", "compliant-light" };

static ss_coefficients *
transform(const ss_signal *signal, const ss_morlet_opts *opts)
{
    ss_coefficients *c;
    assert_int_equal(ss_morlet_transform(&c, signal, 0, opts, NULL), SS_OK);
    return c;
}

/* Where the script says that noise begins [dB]; NaN: nowhere. */
static double
noise_of(const ss_coefficients *c)
{
    char *script = contour_script(c, NULL), *line = strstr(script, "\nnoise = ");
    double noise = line != NULL ? strtod(line + strlen("\nnoise = "), NULL) : NAN;
    free(script);
    return noise;
}

/* --- noise ----------------------------------------------------------------------------------- */

static ss_signal *
simulate(const char *name)
{
    ss_signal *all, *a;
    const ss_scene shipped = read_shipped_named(name);
    assert_int_equal(ss_sim_signal(&all, &shipped, NULL), SS_OK);
    size_t column = (size_t)ss_header_column(all->head, "a");
    assert_int_equal(ss_signal_select(&a, all, &column, 1, 0, all->n, NULL), SS_OK);
    ss_signal_free(all);
    return a;
}

static void
scenes_without_noise_measure_none(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scene / sizeof *scene; i++) {
        ss_signal *signal = simulate(scene[i]);
        ss_coefficients *c = transform(signal, &ss_morlet_defaults);
        if (!isnan(noise_of(c)))
            fail_msg("%s: noise at %g dB", scene[i], noise_of(c));
        ss_coefficients_free(c);
        ss_signal_free(signal);
    }
}

/* 10 log10 of ln N, of the independent |W| that a map of this duration has: they are 2 sqrt(pi) a apart, and
 * half an octave. */
static double
rise(const ss_coefficients *c, double duration)
{
    double step = log2(c->scale[c->n_scales - 1].f / c->scale[0].f) / (double)(c->n_scales - 1), n = 0;
    for (size_t i = 0; i < c->n_scales; i++)
        n += duration / (2 * sqrt(M_PI) * c->scale[i].a) * 2 * step;
    return 10 * log10(log(n));
}

/* The power of white noise in W is rms^2 / rate with the norm a^-1/2, whatever the step: the wavelet's own
 * is 1.  The largest |W| is higher by the rise.  Rounded to 0.5 dB; 2 dB too high where events
 * last; 1 dB is the scatter of nine in ten scales. */
static void
the_noise_of_scenes_is_found(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof scene / sizeof *scene; i++)
        for (double snr = 20; snr <= 40; snr += 20)
            for (int step = 0; step < 3; step++) {
                ss_signal *signal = simulate(scene[i]);
                ss_morlet_opts opts = ss_morlet_defaults;
                double rms = noise_rms(signal->values, signal->n, snr);
                opts.step = step == 1 ? 1 : 0.25;
                opts.dense = step == 2;
                assert_int_equal(ss_noise_add_once(signal->values, signal->n, rms, 7, NULL), SS_OK);
                ss_coefficients *c = transform(signal, &opts);
                double top = ss_coefficients_max(c), found = noise_of(c);
                double truth = 20 * log10(rms / sqrt(signal->head->rate) / top) + rise(c, 3);
                if (!(found >= truth - 1.5 && found <= truth + 3.5))
                    fail_msg("%s at %g dB: noise at %g dB, not %g dB", scene[i], snr, found, truth);
                ss_coefficients_free(c);
                ss_signal_free(signal);
            }
}

static ss_signal *
wave(ss_wave kind, double duration)
{
    ss_signal *signal;
    ss_wave_opts opts = ss_wave_defaults;
    opts.duration = duration;
    opts.frequency = 20;
    assert_int_equal(ss_wave_new(&signal, kind, &opts, NULL), SS_OK);
    return signal;
}

/* With the norm 1/a its power is rms^2 / (rate a): nine in ten of the scales that are short enough to count
 * have less than the tenth from the highest has. */
static void
noise_alone_has_its_level_in_both_norms(void **state)
{
    ss_signal *signal = wave(SS_NOISE, 20);
    (void)state;
    signal->values[20000] = 1000;           /* 0 dB, far above */
    for (int norm = SS_NORM_L2; norm <= SS_NORM_L1; norm++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        opts.norm = (ss_norm)norm;
        ss_coefficients *c = transform(signal, &opts);
        size_t last = c->n_scales - 1, first = last;
        while (first > 0 && 20 >= 100 * 2 * sqrt(M_PI) * c->scale[first - 1].a)
            first--;
        double a = c->scale[first + (size_t)(0.9 * (double)(last - first))].a;
        double power = norm == SS_NORM_L1 ? 1 / (2000 * a) : 1 / 2000.0;
        double truth = 10 * log10(power) + rise(c, 20) - 20 * log10(ss_coefficients_max(c)), found = noise_of(c);
        if (!(fabs(found - truth) <= 1.5))
            fail_msg("norm %d: noise at %g dB, not %g dB", norm, found, truth);
        ss_coefficients_free(c);
    }
    ss_signal_free(signal);
}

/* Scales of 100 lengths count, and it takes an octave of them. */
static void
a_short_record_has_no_level_of_noise(void **state)
{
    const double length = 0.8;
    ss_signal *signal = wave(SS_NOISE, length);
    ss_coefficients *c = transform(signal, &ss_morlet_defaults);
    (void)state;
    assert_true(length < 2 * 100 * 2 * sqrt(M_PI) * c->scale[c->n_scales - 1].a);
    assert_true(isnan(noise_of(c)));
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

static void
a_steady_oscillation_is_no_noise(void **state)
{
    ss_signal *signal = wave(SS_SINE, 20);
    ss_coefficients *c = transform(signal, &ss_morlet_defaults);
    (void)state;
    assert_true(isnan(noise_of(c)));
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

/* A span that is asked for is drawn. */
static void
a_span_that_is_given_stays(void **state)
{
    ss_signal *signal = wave(SS_NOISE, 5);
    ss_coefficients *c = transform(signal, &ss_morlet_defaults);
    ss_contour_opts opts = new_contour_opts();
    (void)state;
    opts.noise = 0;
    char *script = contour_script(c, &opts);
    assert_non_null(strstr(script, "\nspan = 80 "));
    assert_null(strstr(script, "noise"));
    free(script);
    opts.noise = ss_coefficients_max(c) / 100;
    script = contour_script(c, &opts);
    assert_non_null(strstr(script, "\nspan = 40 "));
    assert_non_null(strstr(script, "\nnoise = -40 "));
    free(script);
    script = contour_script(c, NULL);
    assert_non_null(strstr(script, "\nspan = 10 "));        /* the least */
    free(script);
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

/* --- colours --------------------------------------------------------------------------------- */

enum { ROWS = 61, COLUMNS = CONTOUR_COLUMNS + 1, POLYGON_MAX = 20000 };

/* Hills, pits and a plateau's edge, at the border too: level [dB] at column x and row y. */
static double
landscape(double x, double y)
{
    return -20 + 19 * sin(x / 60) * cos(y / 7) - 0.02 * x + 3 * cos(x * y / 3000);
}

/* One polygon of the script, its points in columns and rows; the band that it is painted as, 99: none. */
static size_t
read_polygon(const char *line, double (*point)[2], int *band)
{
    size_t n = 0;
    int used = 0;
    double t, f;
    for (line = strstr(line, "from ") + 5; sscanf(line, "%lf,%lf%n", &t, &f, &used) == 2; n++) {
        assert_true(n < POLYGON_MAX);
        point[n][0] = t * CONTOUR_COLUMNS;
        point[n][1] = log2(f) * (ROWS - 1) / 4;
        line += used;
        line += strncmp(line, " to ", 4) == 0 ? 4 : 0;
    }
    if (sscanf(line, " back fc palette cb -%d", band) != 1)
        *band = 99;
    return n;
}

static int
is_in(const double (*point)[2], size_t n, double x, double y)
{
    int in = 0;
    for (size_t i = 1; i < n; i++)
        if ((point[i - 1][1] > y) != (point[i][1] > y)
            && x < point[i - 1][0] + (y - point[i - 1][1]) / (point[i][1] - point[i - 1][1])
                   * (point[i][0] - point[i - 1][0]))
            in = !in;
    return in;
}

/* Paint by painter's rule at grid points that are not within a fifth of a pixel of a line. */
static void
every_level_has_its_colour(void **state)
{
    enum { LEVELS = 8 };
    static double level[ROWS * COLUMNS], point[POLYGON_MAX][2];
    static int painted[ROWS * COLUMNS];
    double f[ROWS], step = 5;
    const script_span span = { .from = 0, .to = 1 };
    const contour_map map = { &span, span.from, span.to, ROWS, f, level, 1, LEVELS * step, NAN };
    char *text = NULL;
    size_t size, checked = 0;
    (void)state;
    for (size_t y = 0; y < ROWS; y++) {
        f[y] = pow(2, 4.0 * (double)y / (ROWS - 1));
        for (size_t x = 0; x < COLUMNS; x++) {
            level[y * COLUMNS + x] = landscape((double)x, (double)y);
            painted[y * COLUMNS + x] = 99;
        }
    }
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(ss_contour_write_fill(out, &map, LEVELS), SS_OK);
    fclose(out);
    for (char *line = text; line != NULL && *line != '\0'; line = strchr(line, '\n') + 1) {
        int band;
        size_t n = read_polygon(line, point, &band);
        for (size_t i = 0; i < ROWS * COLUMNS; i += 13)
            if (is_in((const double (*)[2])point, n, (double)(i % COLUMNS) + 0.001, (double)(i / COLUMNS) + 0.001))
                painted[i] = band;
    }
    for (size_t i = 0; i < ROWS * COLUMNS; i += 13) {
        size_t x = i % COLUMNS, y = i / COLUMNS;
        double depth = -level[i] / step, near = 0.3;        /* of a step: slopes are below 1.5 steps a pixel */
        if (fabs(depth - round(depth)) < near || x == COLUMNS - 1 || y == ROWS - 1)
            continue;
        int band = depth < 0 ? 0 : depth > LEVELS ? 99 : (int)floor(depth);
        if (painted[i] != band)
            fail_msg("column %zu, row %zu: level %g dB has colour %d", x, y, level[i], painted[i]);
        checked++;
    }
    assert_true(checked > 1000);
    free(text);
}

/* CIE 1976 lightness of '#rrggbb'. */
static double
lightness(const char *colour)
{
    static const double share[3] = { 0.2126, 0.7152, 0.0722 };
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        char byte[3] = { colour[1 + 2 * i], colour[2 + 2 * i], '\0' };
        double v = (double)strtol(byte, NULL, 16) / 255;
        sum += share[i] * (v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
    }
    return sum > 0.008856 ? 116 * cbrt(sum) - 16 : 903.3 * sum;
}

static void
palettes_darken_or_lighten_evenly(void **state)
{
    (void)state;
    for (size_t i = 0; ss_palettes[i] != NULL; i++)
        for (int areas = 0; areas < 2; areas++) {
            char text[512] = "";
            double l[16];
            size_t n = 0;
            FILE *out = fmemopen(text, sizeof text, "w");
            ss_palette_write(out, ss_palettes[i], areas);
            fclose(out);
            for (char *c = text; (c = strchr(c, '#')) != NULL; c++)
                l[n++] = lightness(c);
            assert_int_equal(n, areas ? 11 : 9);
            const char *ground = ss_palette_ground(ss_palettes[i]);
            if (strstr(ss_palettes[i], "_r") != NULL)
                assert_memory_equal(ground, strchr(text, '#'), 7);
            else
                assert_null(ground);
            for (size_t k = 0; ground != NULL && k < n; k++)
                l[k] = -l[k];
            double mean = (l[0] - l[n - 1]) / (double)(n - 1);
            for (size_t k = 1; k < n; k++)
                if (!(fabs(l[k - 1] - l[k] - mean) <= 0.4 * mean))
                    fail_msg("%s: step %zu of lightness is %g, not %g", ss_palettes[i], k, l[k - 1] - l[k],
                             mean);
        }
}

/* --- ridges, zoom, marks ------------------------------------------------------------------------ */

/* The largest |W| of exp(i w t) is where a^1/2 exp(-(a w - c)^2 / 2) is; with the norm 1/a at a w = c.  The
 * exponent is a parabola in a.  The cubic part of ln a^1/2, u^3/6 in u = ln a, moves the top of one through three
 * points h apart by h^2/6/c^2 at most.  Scripts have three decimals.  (Below 10 Hz there are ridges of the
 * record's ends.) */
static void
the_ridge_lies_on_a_steady_oscillation(void **state)
{
    ss_signal *signal = wave(SS_SINE, 5);
    (void)state;
    for (int norm = SS_NORM_L2; norm <= SS_NORM_L1; norm++) {
        ss_morlet_opts opts = ss_morlet_defaults;
        ss_contour_opts contour = new_contour_opts();
        opts.norm = (ss_norm)norm;
        contour.ridge = 1;
        ss_coefficients *c = transform(signal, &opts);
        char *script = contour_script(c, &contour), *line = strchr(strstr(script, "$ridge"), '\n') + 1;
        double truth = 20 * (norm == SS_NORM_L1 ? 1 : 12 / (6 + sqrt(38))), h = log(2) / 16, t, f;
        size_t n = 0;
        for (; sscanf(line, "%lf %lf", &t, &f) == 2; line = strchr(line, '\n') + 1) {
            if (!(f > 10 && t > 0.5 && t < 4.5))
                continue;
            n++;
            if (!(fabs(f / truth - 1) <= h * h / 6 / 36 + 0.0005 / truth))
                fail_msg("ridge at %g s, %g Hz, not %g Hz", t, f, truth);
        }
        assert_in_range(n, 559, 561);           /* of 700 columns in 5 s */
        assert_non_null(strstr(script, "$ridge using 1:2"));
        free(script);
        ss_coefficients_free(c);
    }
    ss_signal_free(signal);
}

/* The lines of a part are those of all, cut at its border. */
static void
labels_that_are_asked_for_are_drawn(void **state)
{
    ss_signal *signal = simulate("coulomb");
    ss_coefficients *c = transform(signal, &ss_morlet_defaults);
    ss_contour_opts opts = new_contour_opts();
    ss_error err = { 0 };
    size_t at_border = 0;
    (void)state;
    opts.fmin = 20;
    opts.fmax = 90.5;
    char *script = contour_script(c, &opts), *line = strchr(strstr(script, "$contour"), '\n') + 1;
    assert_non_null(strstr(script, "\nfmin = 20 "));
    assert_non_null(strstr(script, "\nfmax = 90.5 "));
    for (; strncmp(line, "EOD", 3) != 0; line = strchr(line, '\n') + 1) {
        double t, f;
        if (sscanf(line, "%lf %lf", &t, &f) == 2) {
            assert_true(f >= 20 && f <= 90.5);
            at_border += f == 20 || f == 90.5;
        }
    }
    assert_true(at_border > 20);
    free(script);
    opts.top = 0.5;
    script = contour_script(c, &opts);
    assert_non_null(strstr(script, "\nlevel = -6.02 "));
    free(script);
    opts.fmin = 2000;
    opts.fmax = 0;
    assert_int_equal(ss_plot_contour(stdout, c, &opts, NULL, &err), SS_EINVAL);
    assert_non_null(strstr(err.text, "nothing to draw"));
    opts = new_contour_opts();
    opts.palette = "rainbow";
    assert_int_equal(ss_plot_contour(stdout, c, &opts, NULL, &err), SS_EINVAL);
    assert_string_equal(err.text, "no palette 'rainbow'");
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

static void
marks_beyond_the_map_are_left_out(void **state)
{
    ss_signal *signal = simulate("coulomb");
    ss_coefficients *c = transform(signal, &ss_morlet_defaults);
    double event[] = { 0.5, 1.25, 5 }, spike[] = { 1.5, -1 }, span[][2] = { { 1.4, 1.6 }, { 4, 5 } };
    double maximum[][2] = { { 1.5, 40 }, { 1.5, 5 }, { 1.25, 400 }, { 9, 40 } };
    ss_overlay overlay = { .n_spans = 2, .n_maxima = 4, .n_spikes = 2, .span = span, .maximum = maximum, .spike = spike };
    ss_contour_opts opts = new_contour_opts();
    ss_plot_opts plot = new_plot_opts();
    char *script = NULL;
    size_t size;
    (void)state;
    opts.event = event, opts.n_events = 3, opts.overlay = &overlay;
    opts.fmin = 20, opts.fmax = 80;
    plot.from = 1, plot.to = 2;
    FILE *out = open_memstream(&script, &size);
    assert_int_equal(ss_plot_contour(out, c, &opts, &plot, NULL), SS_OK);
    fclose(out);
    assert_non_null(strstr(script, "$events << EOD\n1.25 0\n1.25 1\n\nEOD\n"));
    assert_non_null(strstr(script, "$spans << EOD\n1.4 1.6\nEOD\n"));
    assert_non_null(strstr(script, "$spikes << EOD\n1.5\nEOD\n"));
    assert_non_null(strstr(script, "$maxima << EOD\n1.5 40\nEOD\n"));
    free(script);
    ss_coefficients_free(c);
    ss_signal_free(signal);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_without_noise_measure_none),
        cmocka_unit_test(the_noise_of_scenes_is_found),
        cmocka_unit_test(noise_alone_has_its_level_in_both_norms),
        cmocka_unit_test(a_short_record_has_no_level_of_noise),
        cmocka_unit_test(a_steady_oscillation_is_no_noise),
        cmocka_unit_test(a_span_that_is_given_stays),
        cmocka_unit_test(every_level_has_its_colour),
        cmocka_unit_test(palettes_darken_or_lighten_evenly),
        cmocka_unit_test(the_ridge_lies_on_a_steady_oscillation),
        cmocka_unit_test(labels_that_are_asked_for_are_drawn),
        cmocka_unit_test(marks_beyond_the_map_are_left_out),
    };
    return cmocka_run_group_tests_name("contour", tests, NULL, NULL);
}
