/* test_plot.c -- contour lines lie where the level says; thinning loses no spike; text from files
 * stays text. */
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "contour_script.h"
#include "read_opts.h"
#include "new_signal.h"
#include "plot/series.h"
#include "plot/isoline.h"
#include "plot/map.h"
#include "unit.h"
#include "signal/noise.h"

/* --- ss_isolines ------------------------------------------------------------------------------ */

enum { N = 61 };

typedef struct tally {
    size_t lines, closed, points;
    double worst;               /* distance of a point from the level, as the test has it */
    double (*off)(const double point[2]);
} tally;

static void
count_line(const double (*point)[2], size_t n, int high_left, void *user)
{
    (void)high_left;
    tally *t = user;
    int closed = point[0][0] == point[n - 1][0] && point[0][1] == point[n - 1][1];
    for (int i = 0; i < 2 && !closed; i++) {        /* an open line ends at the border */
        const double *end = point[i == 0 ? 0 : n - 1];
        assert_true(end[0] == 0 || end[0] == N - 1 || end[1] == 0 || end[1] == N - 1);
    }
    t->lines++;
    t->closed += closed;
    t->points += n;
    for (size_t i = 0; i < n && t->off != NULL; i++)
        t->worst = fmax(t->worst, fabs(t->off(point[i])));
}

static double
off_circle(const double point[2])
{
    return hypot(point[0] - 30, point[1] - 30) - 20;
}

static void
a_cone_has_a_circle(void **state)
{
    double height[N * N];
    const isoline_map map = { N, N, height };
    tally t = { 0, 0, 0, 0, off_circle };
    (void)state;
    for (int i = 0; i < N * N; i++)
        height[i] = -hypot(i % N - 30, i / N - 30);
    assert_int_equal(ss_isolines(&map, -20, count_line, &t), SS_OK);
    assert_int_equal(t.lines, 1);
    assert_int_equal(t.closed, 1);
    if (!(t.worst <= 1.0 / (8 * 20)))               /* linear interpolation on a curve of radius 20 */
        fail_msg("%g off the circle", t.worst);
}

/* Crossed sides of cells: each belongs to one line. */
static size_t
crossings(const double *height, double level)
{
    size_t n = 0;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            int above = height[j * N + i] >= level;
            n += (size_t)(i + 1 < N && (height[j * N + i + 1] >= level) != above);
            n += (size_t)(j + 1 < N && (height[(j + 1) * N + i] >= level) != above);
        }
    return n;
}

static void
every_crossing_of_a_rough_map_is_passed_once(void **state)
{
    double height[N * N];
    const isoline_map map = { N, N, height };
    unsigned long x = 1;
    (void)state;
    for (int i = 0; i < N * N; i++) {               /* few heights, so that many are at the level */
        x = (x * 1103515245 + 12345) & 0x7fffffff;
        height[i] = (double)(x >> 16 & 7);
    }
    for (double level = -0.5; level < 8; level += 0.5) {
        tally t = { 0 };
        assert_int_equal(ss_isolines(&map, level, count_line, &t), SS_OK);
        if (level != floor(level))                  /* no two points of a line coincide then */
            assert_int_equal(t.points - t.closed, crossings(height, level));
    }
}

static void
a_flat_map_has_no_lines(void **state)
{
    double height[N * N] = { 0 };
    const isoline_map map = { N, N, height };
    tally t = { 0 };
    (void)state;
    for (double level = -1; level <= 1; level++)
        assert_int_equal(ss_isolines(&map, level, count_line, &t), SS_OK);
    assert_int_equal(t.lines, 0);
}

/* On a unit square, the lines of y + (x - 1/2)^2 are parabolas y = level - (x - 1/2)^2, that of 1 with its middle on
 * the border.  Levels are all multiples of their step from the first on.  Each label lies on the line of its level, to
 * (1/60)^2 / 4 of straight pieces, and .04 from the border. */
static void
labels_lie_on_their_lines_and_off_the_border(void **state)
{
    double at[N], height[N * N], x, y, level, drawn[20] = { 0 };
    const map_axis axis = { .value = at, .n = N, .scale = ss_script_power(0), .digits = 9 };
    const map_grid g = { axis, axis };
    char *text = NULL, *line = NULL;
    size_t size, levels = 0, labels = 0;
    (void)state;
    for (size_t i = 0; i < N; i++)
        at[i] = (double)i / (N - 1);
    for (size_t i = 0; i < N * N; i++)          /* a column is not known: the longer part of a line has the label */
        height[i] = i % N == 15 ? NAN : at[i / N] + pow(at[i % N] - 0.5, 2);
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    assert_int_equal(ss_map_write_lines(out, &g, height, NULL), SS_OK);
    fclose(out);
    char *label = strstr(text, "$label");
    assert_non_null(label);
    for (line = text; line != NULL && line[1] != '\0'; line = strchr(line + 1, '\n')) {
        if (sscanf(line, "%lf %lf %lf", &x, &y, &level) != 3)
            continue;
        if (line < label) {
            if (levels == 0 || drawn[levels - 1] != level)
                drawn[levels++] = level;
        } else {
            assert_true(fabs(level - drawn[labels++]) < 1e-9);
            assert_true(fabs(y + pow(x - 0.5, 2) - level) < 1. / 3600 / 4 + 1e-6);
            assert_true(fmin(fmin(x, 1 - x), fmin(y, 1 - y)) > 0.04 - 1e-6);
        }
    }
    assert_true(levels >= 4 && labels == levels);
    for (size_t i = 0; i < levels; i++)
        assert_true(fabs(drawn[i] - (double)(i + 1) * drawn[0]) < 1e-6);
    free(text);
}

/* --- scripts ------------------------------------------------------------------------------- */

enum { OVER_TIME = -1 };

/* A signal over time, or its column y over its first; over: another over it, or NULL. */
static ss_status
try_to_draw(FILE *out, const ss_signal *signal, int y, const ss_signal *over, const ss_plot_opts *opts,
            ss_error *err)
{
    ss_plot_opts own = opts != NULL ? *opts : new_plot_opts();
    ss_reader *reader, *other = NULL;
    assert_int_equal(ss_reader_of_signal(&reader, signal, NULL), SS_OK);
    if (over != NULL)
        assert_int_equal(ss_reader_of_signal(&other, over, NULL), SS_OK);
    own.over = &other;
    own.n_over = over != NULL;
    ss_status st = y >= 0 ? ss_plot_xy(out, reader, 0, (size_t)y, &own, err)
        : ss_plot_signal(out, reader, NULL, 0, &own, err);
    ss_reader_free(other);
    ss_reader_free(reader);
    return st;
}

static char *
script_of(const ss_signal *signal, int y, const ss_signal *over, const ss_plot_opts *opts)
{
    char *text = NULL;
    size_t size;
    ss_error err = { 0 };
    FILE *out = open_memstream(&text, &size);
    if (try_to_draw(out, signal, y, over, opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    fclose(out);
    return text;
}

static char *
signal_script(const ss_signal *signal, const ss_plot_opts *opts)
{
    return script_of(signal, OVER_TIME, NULL, opts);
}

/* Of a signal of more values than there are blocks, each block has what its samples have; a shorter one stays as
 * it is.  NaN is no value. */
static void
blocks_have_the_extremes_of_their_samples(void **state)
{
    enum { ROOM = 64 };
    static const size_t length[] = { 10, ROOM - 1, ROOM, ROOM + 1, 777, 100003 };
    (void)state;
    for (size_t row = 0; row < sizeof length / sizeof *length; row++) {
        size_t n = length[row];
        ss_signal *signal = new_signal(n, 1000, 5, "a", "");
        double *x = signal->values, pair[2] = { 0, 0 };
        extremes b;
        ss_noise_add_once(x, n, 1, 1, NULL);
        for (size_t i = n / 3; i < n / 2; i++)
            x[i] = NAN;
        assert_true(ss_extremes_make(&b, ROOM, 1));
        for (size_t i = 0, m; i < n; i += m) {
            m = n - i < 100 ? n - i : 100;
            ss_extremes_add(&b, x + i, m);
        }
        assert_true(ss_extremes_count(&b) <= ROOM && 2 * ss_extremes_count(&b) > (n < ROOM ? n : ROOM));
        for (size_t i = 0, each = (size_t)1 << b.order; i < ss_extremes_count(&b); i++) {
            double low = NAN, high = NAN, before = pair[1];
            for (size_t k = i * each; k < (i + 1) * each && k < n; k++) {
                low = fmin(low, x[k]);
                high = fmax(high, x[k]);
            }
            size_t known = ss_extremes_of(&b, i, pair[1], pair);
            assert_int_equal(known, isnan(low) ? 0 : low < high ? 2 : 1);
            if (known > 0)
                assert_true(fmin(pair[0], pair[1]) == low && fmax(pair[0], pair[1]) == high
                            && fabs(pair[0] - before) <= fabs(pair[1] - before));
            else
                pair[1] = before;
        }
        ss_extremes_free(&b);
        ss_signal_free(signal);
    }
}

/* --- long lines ------------------------------------------------------------------------------ */

enum { LONG = 700000, APART = 345678 };

/* A circle 700 times round, with a gap and one sample far from it; or noise. */
static ss_signal *
long_line(int noise)
{
    ss_signal *signal = NULL;
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1000, 5, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "x", "", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "y", "", NULL), SS_OK);
    assert_int_equal(ss_header_note(head, "gaps", "8.25:8.5", NULL), SS_OK);
    assert_int_equal(ss_signal_new(&signal, head, LONG, NULL), SS_OK);
    ss_header_free(head);
    double *x = signal->values, *y = x + LONG;
    for (size_t i = 0; i < LONG; i++) {
        x[i] = noise ? 0 : cos(2 * M_PI * (double)i / 1000.1);
        y[i] = noise ? 0 : sin(2 * M_PI * (double)i / 1000.1);
    }
    if (noise)
        ss_noise_add_once(x, 2 * LONG, 1, 4, NULL);
    x[APART] = 1.5;
    y[APART] = 1.2;
    return signal;
}

/* The distance of a point from a part of a line. */
static double
distance(double px, double py, double ax, double ay, double bx, double by)
{
    double dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
    double part = square > 0 ? fmax(0, fmin(1, ((px - ax) * dx + (py - ay) * dy) / square)) : 0;
    return hypot(px - ax - part * dx, py - ay - part * dy);
}

/* The points of a datablock; NaN where a line breaks.  To be freed. */
static double (*
points_of(const char *script, const char *name, size_t *n))[2]
{
    double (*point)[2] = NULL;
    const char *line = strstr(script, name);
    assert_non_null(line);
    *n = 0;
    for (line = strchr(line, '\n') + 1; strncmp(line, "EOD", 3) != 0; line = strchr(line, '\n') + 1) {
        point = realloc(point, (*n + 1) * sizeof *point);
        if (*line == '\n')
            point[*n][0] = point[*n][1] = NAN;
        else
            assert_int_equal(sscanf(line, "%lf %lf", &point[*n][0], &point[*n][1]), 2);
        ++*n;
    }
    return point;
}

/* From the nearest part of the line that is drawn. */
static double
distance_from(double (*point)[2], size_t n, double px, double py)
{
    double least = INFINITY;
    for (size_t i = 0; i + 1 < n; i++)
        if (!isnan(point[i][0]) && !isnan(point[i + 1][0]))
            least = fmin(least, distance(px, py, point[i][0], point[i][1], point[i + 1][0], point[i + 1][1]));
    return least;
}

/* All of the line lies within the width of a line, two pixels of a thousand, from what is left of it. */
static void
a_long_path_looks_like_the_line(void **state)
{
    (void)state;
    for (int noise = 0; noise < 2; noise++) {
        ss_signal *signal = long_line(noise);
        char *script = script_of(signal, 1, NULL, NULL);
        const double *x = signal->values, *y = x + LONG;
        double range = noise ? 9.5 : 2.5;
        size_t n;
        double (*const point)[2] = points_of(script, "$path << EOD\n", &n);
        assert_true(n < (noise ? 400000 : 10000));
        for (size_t i = 100; i < LONG; i += noise ? 7919 : 997) {
            int missing = i >= 3250 && i < 3501;
            double px = (x[i] + x[i - 1]) / 2, py = (y[i] + y[i - 1]) / 2;
            if (!missing && distance_from(point, n, px, py) > 2e-3 * range)
                fail_msg("sample %zu, %g %g, is not drawn", i, px, py);
        }
        assert_true(distance_from(point, n, x[APART], y[APART]) <= 1e-3 * range);
        for (size_t i = 0; i < n && !noise; i++) {
            double r = hypot(point[i][0], point[i][1]);
            if (isnan(r))
                continue;
            assert_true(r > 1 - 2e-3 * range);
            assert_true(r < 1 + 2e-3 * range || r > 1.8);       /* the ends of the way to the sample apart */
        }
        free(point);
        free(script);
        ss_signal_free(signal);
    }
}

/* In the span to draw, and the sample at its end. */
static void
a_path_begins_and_ends_with_its_span(void **state)
{
    ss_plot_opts opts = new_plot_opts();
    ss_signal *signal = long_line(1);
    size_t n;
    (void)state;
    opts.from = 12.25;
    opts.to = 13;
    char *script = script_of(signal, 1, NULL, &opts);
    double (*const point)[2] = points_of(script, "$path << EOD\n", &n);
    assert_in_range(n, 700, 800);                       /* of 751 rows a few are near the last one */
    for (int c = 0; c < 2; c++) {
        const double *x = signal->values + c * LONG;
        assert_true(fabs(point[0][c] - x[7250]) <= 1e-3 && fabs(point[n - 1][c] - x[8000]) <= 1e-3);
    }
    free(point);
    free(script);
    ss_signal_free(signal);
}

/* A long signal over another stands where it would if it were short. */
static void
a_long_signal_over_another_begins_with_it(void **state)
{
    enum { MANY = (1 << 20) + 1000 };
    ss_signal *signal = new_signal(2000, 1, 50, "a", ""), *over = new_signal(MANY, 1000, 7, "b", "");
    (void)state;
    over->values[654321] = 3;
    for (int part = 0; part < 2; part++) {
        ss_plot_opts opts = new_plot_opts();
        if (part) {
            opts.from = 700;
            opts.to = 710;
        }
        char *script = script_of(signal, OVER_TIME, over, &opts), *at = strstr(script, " 3\n");
        assert_non_null(at);
        while (at > script && at[-1] != '\n')
            at--;
        assert_true(fabs(atof(at) - 704.321) <= (part ? 0.011 : 2));    /* a column of pixels */
        free(script);
    }
    ss_signal_free(over);
    ss_signal_free(signal);
}

static void
a_spike_of_one_sample_in_a_million_is_drawn(void **state)
{
    ss_signal *signal = new_signal(1000000, 1000, 5, "a", "");
    (void)state;
    signal->values[654321] = 7;
    signal->values[654322] = -3;
    char *script = signal_script(signal, NULL);
    assert_non_null(strstr(script, "\n658.8 -3\n659.1 7\n"));     /* a block of .512 s */
    assert_true(strlen(script) < 50000);
    free(script);
    ss_signal_free(signal);
}

static void
text_of_files_stands_between_quotes(void **state)
{
    ss_signal *signal = new_signal(10, 10, 0, "a'`@b", "m's");
    ss_plot_opts opts = new_plot_opts();
    (void)state;
    opts.title = "\"; system 'touch x'\n`touch y`";
    char *script = signal_script(signal, &opts);
    assert_non_null(strstr(script, "\nset title \"\\042\\073 system \\047touch x\\047 "
                                   "\\140touch y\\140\" noenhanced "));
    assert_non_null(strstr(script, "set label 1 \"a\\047\\140\\100b / m\\047s\" at "));
    free(script);
    ss_signal_free(signal);
}

/* A panel has room for some fourteen letters beside it. */
static void
long_labels_have_two_lines_and_smaller_letters(void **state)
{
    static const struct { const char *name, *unit, *label; int smaller; } row[] = {
        { "velocity", "m/s", "velocity / (m/s)", 0 },
        { "displacement", "m/s", "displacement\\n(m/s)", 1 },
        { "friction_force", "kip", "friction_force\\n(kip)", 1 },
        { "friction_force_kip", "", "friction_force_kip", 1 },
        { "force_kip", "kip", "force / kip", 0 },
        { "slip_velocity_mm_s", "mm/s", "slip_velocity\\n(mm/s)", 1 },
        { "accel_m_s2", "m/s^2", "accel / (m/s\\302\\262)", 0 },
        { "slip_mm", "\xc2\xb5m", "slip / \\302\\265m", 0 },
        { "napkip", "kip", "napkip / kip", 0 },
        { "_kip", "kip", "_kip / kip", 0 },
        { "a", "m/s", "a / (m/s)", 0 },
        { "v", "(m/s)^2/Hz", "v / \\133(m/s)\\302\\262/Hz\\135", 0 },
        { "displacementofthemass", "", "displacementofthemass", 1 },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char line[96];
        ss_signal *signal = new_signal(2, 1, 0, row[i].name, row[i].unit);
        signal->values[1] = 1;
        char *script = signal_script(signal, NULL);
        snprintf(line, sizeof line, "set label 1 \"%s\" at ", row[i].label);
        if (strstr(script, line) == NULL)
            fail_msg("no %s", row[i].label);
        if ((strstr(script, "noenhanced font sprintf(") != NULL) != row[i].smaller)
            fail_msg("%s: letters of the other size", row[i].name);
        free(script);
        ss_signal_free(signal);
    }
}

static void
labels_carry_powers_of_ten_and_raised_digits(void **state)
{
    static const struct { double value; const char *unit, *label; } row[] = {
        { 3e-4, "m", "a / (10⁻³ m)" },      { 0.3, "m/s^2", "a / (m/s²)" },
        { 2e7, "", "a / 10⁶" },             { 0, "N", "a / N" },
        { 5, "s^2.5", "a / s^2.5" },        { 9999, "kip", "a / kip" },
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char line[96];
        ss_signal *signal = new_signal(2, 1, 0, "a", row[i].unit);
        signal->values[1] = row[i].value;
        char *script = signal_script(signal, NULL);
        int n = snprintf(line, sizeof line, "set label 1 \"");
        for (const char *c = row[i].label; *c != '\0'; c++) {      /* the digit behind ^ is escaped, too */
            int escaped = (*c & 0x80) != 0 || *c == '^' || (c > row[i].label && c[-1] == '^');
            n += snprintf(line + n, sizeof line - (size_t)n, escaped ? "\\%03o" : "%c",
                          (unsigned char)*c);
        }
        snprintf(line + n, sizeof line - (size_t)n, "\" at ");
        if (strstr(script, line) == NULL)
            fail_msg("no %s", row[i].label);
        free(script);
        ss_signal_free(signal);
    }
}

static void
names_of_ten_thousand_characters_are_cut(void **state)
{
    static const char *const letter[] = { "a", "_", "é", "\xff", "'" };
    (void)state;
    for (size_t i = 0; i < sizeof letter / sizeof *letter; i++) {
        char *name = calloc(10000, strlen(letter[i]) + 1);
        for (int k = 0; k < 9999; k++)
            strcat(name + strlen(letter[i]) * (size_t)k, letter[i]);
        ss_signal *signal = new_signal(2, 1, 0, name, name);
        signal->values[1] = 1;
        char *script = signal_script(signal, NULL), *cut = strstr(script, "\\342\\200\\246\" at ");
        assert_non_null(cut);                   /* an ellipsis ends it */
        assert_true(cut - strstr(script, "set label 1") < 4 * 256 + 20);
        free(script);
        ss_signal_free(signal);
        free(name);
    }
}

static void
values_that_gnuplot_cannot_draw_are_refused(void **state)
{
    static const double value[] = { NAN, INFINITY, -INFINITY, -1e308, 1e-310 };
    ss_signal *signal = new_signal(10, 10, 0, "a", "");
    (void)state;
    for (size_t i = 0; i < sizeof value / sizeof *value; i++) {
        ss_error err = { 0 };
        signal->values[3] = value[i];
        assert_int_equal(try_to_draw(stdout, signal, OVER_TIME, NULL, NULL, &err), SS_EINVAL);
        assert_non_null(strstr(err.text, "a cannot be drawn"));
        assert_int_equal(try_to_draw(stdout, signal, 0, NULL, NULL, &err), SS_EINVAL);
    }
    ss_signal_free(signal);
}

static void
an_octal_escape_swallows_no_digit(void **state)
{
    ss_signal *signal = new_signal(2, 1, 0, "&#0;'9a1", "");
    (void)state;
    char *script = signal_script(signal, NULL);
    assert_non_null(strstr(script, "\"\\046\\043\\060\\073\\047\\071a1\""));
    free(script);
    ss_signal_free(signal);
}

static void
what_lies_outside_the_record_is_refused(void **state)
{
    static const double span[][2] = { { 20, 21 }, { -3, -2 }, { 6, 6 }, { 7, 6 } };
    ss_signal *signal = new_signal(10, 10, 5, "a", "");
    (void)state;
    for (size_t i = 0; i < sizeof span / sizeof *span; i++) {
        ss_plot_opts opts = new_plot_opts();
        ss_error err = { 0 };
        opts.from = span[i][0];
        opts.to = span[i][1];
        assert_int_equal(try_to_draw(stdout, signal, OVER_TIME, NULL, &opts, &err), SS_EINVAL);
        assert_non_null(strstr(err.text, "the record goes from 5 s to 6 s"));
    }
    ss_signal_free(signal);
}

static void
wrong_arguments_are_refused(void **state)
{
    ss_signal *signal = new_signal(10, 10, 0, "a", "");
    ss_plot_opts gif = new_plot_opts();
    (void)state;
    gif.output = "a.gif";
    assert_int_equal(try_to_draw(stdout, signal, 1, NULL, NULL, NULL), SS_EINVAL);
    assert_int_equal(try_to_draw(stdout, signal, OVER_TIME, NULL, &gif, NULL), SS_EINVAL);
    ss_signal_free(signal);
}

static void
a_full_disk_is_an_error(void **state)
{
    FILE *full = fopen("/dev/full", "w");
    ss_signal *signal = new_signal(10, 10, 0, "a", "");
    (void)state;
    if (full != NULL) {
        assert_int_equal(try_to_draw(full, signal, OVER_TIME, NULL, NULL, NULL), SS_EIO);
        fclose(full);
    }
    ss_signal_free(signal);
}

/* --- contours ------------------------------------------------------------------------------ */

/* A dense grid of 3 scales at 20, 40, 80 Hz, over 1 s at 1000 Hz from 2 s. */
static ss_coefficients *
new_coefficients(void)
{
    ss_coefficients *c = calloc(1, sizeof *c);
    ss_header_new(&c->head, 1000, 2, NULL);
    c->n = 1000;
    c->center = 6;
    c->n_scales = 3;
    c->scale = calloc(3, sizeof *c->scale);
    c->w = calloc(2 * 3 * 1000, sizeof *c->w);
    for (size_t i = 0; i < 3; i++) {
        double f = 20 << i, a = 6 / (2 * M_PI * f);
        c->scale[i] = (ss_scale){ 0, log2(a), a, f, 1, 1000, 1000, 1000 * i, SS_ENGINE_AUTO };
    }
    return c;
}

/* |W| falls by 100 dB/s from the 0.2 s where the widest cone ends: vertical lines. */
static void
contours_lie_where_the_level_says(void **state)
{
    ss_coefficients *c = new_coefficients();
    ss_contour_opts opts = new_contour_opts();
    int seen[9] = { 0 };
    (void)state;
    for (size_t i = 0; i < 3000; i++)
        c->w[2 * i + 1] = -3 * pow(10, -fmax((double)(i % 1000) / 1000 - 0.2, 0) * 100 / 20);
    opts.levels = 8;
    opts.span = 40;
    char *script = contour_script(c, &opts), *line = strstr(script, "$contour << EOD\n");
    for (line = strchr(line, '\n') + 1; strncmp(line, "EOD", 3) != 0; line = strchr(line, '\n') + 1) {
        double t, f;
        int k;
        if (sscanf(line, "%lf %lf %d", &t, &f, &k) != 3)
            continue;
        assert_in_range(k, 1, 8);
        assert_true(f >= 20 && f <= 80);
        seen[k]++;
        double expected = 2.2 + k * 5 / 100.0;      /* within half a column, and rounding */
        if (!(fabs(t - expected) <= 0.5 / 700 + 2e-5))
            fail_msg("line %d at %g s, not %g s", k, t, expected);
    }
    for (int k = 1; k <= 8; k++)
        assert_true(seen[k] >= 2);
    free(script);
    ss_coefficients_free(c);
}

static void
one_large_coefficient_is_not_lost(void **state)
{
    ss_coefficients *c = new_coefficients();
    (void)state;
    c->w[2 * 1501] = 1;
    char *script = contour_script(c, NULL);
    for (int k = 1; k <= 18; k++) {
        char end[16];
        snprintf(end, sizeof end, " %d\n", k);
        assert_non_null(strstr(strstr(script, "$contour"), end));
    }
    free(script);
    ss_coefficients_free(c);
}

static void
a_coefficient_of_any_size_gives_numbers(void **state)
{
    static const double value[] = { -1e308, 1e-308, 5e-324, 1.7e308 };
    (void)state;
    for (size_t i = 0; i < sizeof value / sizeof *value; i++)
        for (size_t at = 0; at < 3000; at += 1499) {        /* in an edge, too, which is not the reference */
            ss_coefficients *c = new_coefficients();
            c->w[2 * 1501] = 1e-3;
            c->w[2 * at] = value[i];
            char *script = contour_script(c, NULL);
            assert_true(strstr(script, "nan") == NULL && strstr(script, "inf") == NULL);
            free(script);
            ss_coefficients_free(c);
        }
}

static void
coefficients_and_scales_that_cannot_be_drawn_are_refused(void **state)
{
    static const double value[] = { NAN, INFINITY, 1.7e308 };
    ss_error err = { 0 };
    ss_coefficients *c = new_coefficients();
    (void)state;
    for (size_t i = 0; i < sizeof value / sizeof *value; i++) {
        c->w[2 * 1501] = c->w[2 * 1501 + 1] = value[i];
        assert_int_equal(ss_plot_contour(stdout, c, NULL, NULL, &err),
                         SS_EINVAL);
        assert_non_null(strstr(err.text, "a value is not finite"));
    }
    c->w[2 * 1501] = c->w[2 * 1501 + 1] = 0;
    for (int i = 0; i < 4; i++) {
        c->scale[1].f = (const double[]){ NAN, 0, 20, INFINITY }[i];
        assert_int_equal(ss_plot_contour(stdout, c, NULL, NULL, &err),
                         SS_EINVAL);
        assert_non_null(strstr(err.text, "cannot be drawn"));
    }
    ss_coefficients_free(c);
}

static void
zero_everywhere_gives_an_empty_picture(void **state)
{
    ss_coefficients *c = new_coefficients();
    (void)state;
    char *script = contour_script(c, NULL);
    assert_non_null(strstr(script, "$contour << EOD\nEOD\n"));
    free(script);
    ss_coefficients_free(c);
}

typedef struct origin {
    ss_map_source source;
    const ss_coefficients *c;
    size_t next, fail_at;
    double done;
} origin;

static ss_status
give_scale(const ss_coefficients *map, const ss_map_part part[], size_t n, ss_error *err)
{
    origin *o = (origin *)map->source;
    assert_true(n == 1 && part->scale == o->next++ && part->n == map->scale[part->scale].n);
    assert_int_equal(ss_map_read(o->c, part, n, err), SS_OK);
    return part->scale == o->fail_at ? SS_EDATA : SS_OK;
}

static int
note_progress(double done, void *user)
{
    origin *o = user;
    assert_true(done > o->done && done <= 1);
    o->done = done;
    return 0;
}

/* Each once, with the picture that all together give; where one is lost, nothing is written. */
static void
coefficients_may_come_scale_by_scale(void **state)
{
    ss_coefficients *c = new_coefficients(), grid = *c;
    origin o = { .source = { give_scale, NULL }, .c = c, .fail_at = SIZE_MAX };
    ss_contour_opts opts = new_contour_opts();
    (void)state;
    for (size_t i = 0; i < 2 * 3000; i++)
        c->w[i] = sin((double)i * (double)i / 4e6) * (double)(i % 2000);
    char *all = contour_script(c, &opts), *pieces;
    opts.progress = (ss_progress){ note_progress, &o };
    grid.w = NULL;
    grid.source = &o.source;
    pieces = contour_script(&grid, &opts);
    assert_string_equal(pieces, all);
    assert_true(o.next == 3 && o.done == 1);
    free(pieces);
    free(all);
    o = (origin){ .source = { give_scale, NULL }, .c = c, .fail_at = 1 };
    size_t size = 0;
    FILE *out = open_memstream(&pieces, &size);
    assert_int_equal(ss_plot_contour(out, &grid, &opts, NULL, NULL), SS_EDATA);
    fclose(out);
    assert_int_equal(size, 0);
    free(pieces);
    grid.source = NULL;
    assert_int_equal(ss_plot_contour(stdout, &grid, NULL, NULL, NULL),
                     SS_EINVAL);
    ss_coefficients_free(c);
}

static void
contour_options_out_of_range_are_refused(void **state)
{
    static const struct { int levels; double span; } row[] = {
        { 0, 80 }, { 101, 80 }, { 18, 0 }, { 18, -1 }, { 18, NAN }, { 18, INFINITY },
    };
    ss_coefficients *c = new_coefficients();
    ss_contour_opts opts = new_contour_opts();
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        opts.levels = row[i].levels;
        opts.span = row[i].span;
        assert_int_equal(ss_plot_contour(stdout, c, &opts, NULL, NULL), SS_EINVAL);
    }
    opts = new_contour_opts();
    opts.size = 0;                              /* were not initialised */
    assert_int_equal(ss_plot_contour(stdout, c, &opts, NULL, NULL), SS_EINVAL);
    c->n_scales = 1;
    assert_int_equal(ss_plot_contour(stdout, c, NULL, NULL, NULL),
                     SS_EINVAL);
    ss_coefficients_free(c);
}

/* Each power of ten from the least to the largest amplitude has a tic, also between the first two rows. */
static void
each_decade_of_a_backbone_has_its_tic(void **state)
{
    ss_backbone_row row[] = { { .amplitude = 1.2e-2 }, { .amplitude = 0.9e-2 }, { .amplitude = 1.1e-4 },
                              { .amplitude = 0.9e-4 } };
    const ss_backbone decay = { .n = 4, .row = row };
    ss_signal *signal = new_signal(100, 100, 0, "x", "m");
    char *text = NULL;
    size_t length;
    (void)state;
    for (size_t i = 0; i < 4; i++)
        row[i].frequency = row[i].damping_ratio = (ss_value){ 1 + 0.1 * (double)i, 0.01 };
    FILE *out = open_memstream(&text, &length);
    assert_int_equal(ss_plot_backbone(out, &decay, signal, 0, NULL, NULL), SS_OK);
    fclose(out);
    const char *last = NULL;
    for (const char *at = text; (at = strstr(at, "set xtics (")) != NULL; at++)
        last = at;
    assert_non_null(last);
    char *line = strndup(last, strcspn(last, "\n"));
    assert_true(strstr(line, " 1e-4") != NULL && strstr(line, " 1e-3") != NULL && strstr(line, " 1e-2") != NULL);
    free(line);
    free(text);
    ss_signal_free(signal);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cone_has_a_circle),
        cmocka_unit_test(every_crossing_of_a_rough_map_is_passed_once),
        cmocka_unit_test(a_flat_map_has_no_lines),
        cmocka_unit_test(labels_lie_on_their_lines_and_off_the_border),
        cmocka_unit_test(blocks_have_the_extremes_of_their_samples),
        cmocka_unit_test(a_long_path_looks_like_the_line),
        cmocka_unit_test(a_path_begins_and_ends_with_its_span),
        cmocka_unit_test(a_long_signal_over_another_begins_with_it),
        cmocka_unit_test(a_spike_of_one_sample_in_a_million_is_drawn),
        cmocka_unit_test(text_of_files_stands_between_quotes),
        cmocka_unit_test(names_of_ten_thousand_characters_are_cut),
        cmocka_unit_test(values_that_gnuplot_cannot_draw_are_refused),
        cmocka_unit_test(an_octal_escape_swallows_no_digit),
        cmocka_unit_test(a_coefficient_of_any_size_gives_numbers),
        cmocka_unit_test(coefficients_and_scales_that_cannot_be_drawn_are_refused),
        cmocka_unit_test(long_labels_have_two_lines_and_smaller_letters),
        cmocka_unit_test(labels_carry_powers_of_ten_and_raised_digits),
        cmocka_unit_test(what_lies_outside_the_record_is_refused),
        cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(a_full_disk_is_an_error),
        cmocka_unit_test(contours_lie_where_the_level_says),
        cmocka_unit_test(one_large_coefficient_is_not_lost),
        cmocka_unit_test(zero_everywhere_gives_an_empty_picture),
        cmocka_unit_test(coefficients_may_come_scale_by_scale),
        cmocka_unit_test(contour_options_out_of_range_are_refused),
        cmocka_unit_test(each_decade_of_a_backbone_has_its_tic),
    };
    return cmocka_run_group_tests_name("plot", tests, NULL, NULL);
}
