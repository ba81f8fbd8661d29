/* contour.c -- contours of |W| in decibels over time and frequency, below the signal.
 *
 * |W| is mapped to a rectangle as wide as the picture, one row a scale.  A column has the largest
 * |W| of its translations, so that no spike is lost; between translations farther apart |W| is
 * interpolated linearly.  The script contains the lines of equal level, with the fewest points that
 * keep them within a fraction of a pixel. */
#include "plot/isoline.h"
#include "plot/script.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/progress.h"
#include "base/range.h"

#define COLUMNS 700             /* pixels that panel (b) is wide, about */
#define ROWS 580                /* and high */
#define LEVELS 100              /* at most */
#define BLUR 0.2                /* pixels by which a line may move if points are left out */
#define FLOOR 1000.0            /* [dB] below the largest |W|: the level of |W| = 0 */

const ss_range ss_contour_levels = { 1, LEVELS }, ss_contour_spans = { 1e-3, 1000 };
const ss_contour_opts ss_contour_defaults = { .levels = 18, .span = 80 };

/* --- the map ------------------------------------------------------------------------------- */

static double
magnitude(const double *w, size_t k)
{
    return hypot(w[2 * k], w[2 * k + 1]);
}

/* |W| of a scale in the column of time [lo, hi], from the first sample. */
static double
in_column(const ss_scale *scale, const double *w, double lo, double hi)
{
    double step = scale->b_num / scale->b_den, at = (lo + hi) / 2 / step;
    size_t last = scale->n - 1, k = at > 0 ? (size_t)fmin(at, (double)last) : 0;
    double part = fmin(fmax(at - (double)k, 0), 1);
    double level = magnitude(w, k);
    if (k < last)
        level += part * (magnitude(w, k + 1) - level);
    for (k = lo > 0 ? (size_t)fmin(ceil(lo / step), (double)last) : 0;
         k <= last && (double)k * step <= hi; k++)
        level = fmax(level, magnitude(w, k));
    return level;
}

/* The largest |W| of scale i, outside the cone of influence and anywhere; returns 0 if a |W| is not
 * finite. */
static int
find_largest(const ss_coefficients *c, size_t i, const double *w, double most[2])
{
    for (size_t k = 0; k < c->scale[i].n; k++) {
        double level = magnitude(w, k);
        if (!isfinite(level))
            return 0;
        most[1] = fmax(most[1], level);
        if (level > most[0] && !ss_coefficients_edge(c, i, k))
            most[0] = level;
    }
    return 1;
}

/* |W|, COLUMNS + 1 of them a scale, and the results of find_largest. */
static ss_status
fill_map(double *map, const ss_coefficients *c, const ss_contour_opts *contour,
         const script_span *span, double *own, double most[2], ss_error *err)
{
    double width = (span->to - span->from) / COLUMNS;
    for (size_t s = 0; s < c->n_scales; s++) {
        const double *w = own != NULL ? own : c->w + 2 * c->scale[s].offset;
        ss_status st = own != NULL ? contour->source(s, own, contour->source_user, err) : SS_OK;
        if (st != SS_OK)
            return st;
        if (!find_largest(c, s, w, most))
            return ss_fail(err, SS_EINVAL, "|W| at %g Hz cannot be drawn: a value is not finite",
                           c->scale[s].f);
        for (size_t i = 0; i <= COLUMNS; i++) {
            double t = span->from - c->head->start + (double)i * width;
            map[s * (COLUMNS + 1) + i] = in_column(&c->scale[s], w, t - width / 2, t + width / 2);
        }
        if (ss_progress_at(&contour->progress, (double)(s + 1) / (double)c->n_scales) != SS_OK)
            return SS_STOP;
    }
    return SS_OK;
}

/* Levels in decibels relative to the largest |W|, to be freed. */
static ss_status
make_map(double **out, const ss_coefficients *c, const ss_contour_opts *contour,
         const script_span *span, ss_error *err)
{
    size_t cells = c->n_scales * (COLUMNS + 1), longest = 0;
    double most[2] = { -1, 0 }, *own = NULL;
    for (size_t s = 0; s < c->n_scales; s++)
        longest = c->scale[s].n > longest ? c->scale[s].n : longest;
    double *map = *out = malloc(cells * sizeof *map);
    if (c->w == NULL)
        own = malloc(2 * longest * sizeof *own);
    ss_status st = map == NULL || (c->w == NULL && own == NULL) ? SS_ENOMEM
        : fill_map(map, c, contour, span, own, most, err);
    free(own);
    if (st == SS_ENOMEM)
        return ss_fail(err, st, "%s", ss_strerror(st));
    double max = most[0] >= 0 ? most[0] : most[1];
    for (size_t i = 0; st == SS_OK && i < cells; i++)
        map[i] = max > 0 && map[i] > 0
            ? fmin(fmax(20 * log10(map[i] / max), -FLOOR), FLOOR) : -FLOOR;
    return st;
}

/* --- its lines ----------------------------------------------------------------------------- */

typedef struct line_sink {
    FILE *out;
    const ss_coefficients *c;
    const script_span *span;
    int level;                  /* its number */
    size_t lines;               /* of this level, so far */
} line_sink;

static void
write_point(const line_sink *sink, const double point[2])
{
    const ss_scale *scale = sink->c->scale;
    double range = sink->span->to - sink->span->from;
    size_t row = (size_t)fmin(point[1], (double)(sink->c->n_scales - 2));
    double part = point[1] - (double)row;
    double f = scale[row].f * pow(scale[row + 1].f / scale[row].f, part);
    ss_script_write(sink->out, sink->span->from + point[0] / COLUMNS * range,
                    ss_script_decimals(range), " ");
    ss_script_write(sink->out, f, 3 - (int)floor(log10(f)), "");
    fprintf(sink->out, " %d\n", sink->level);
}

/* May the points between first and last be left out? */
static int
is_straight(const double (*point)[2], size_t first, size_t last, double row)
{
    double dx = point[last][0] - point[first][0], dy = (point[last][1] - point[first][1]) * row;
    double length = hypot(dx, dy);
    for (size_t i = first + 1; i < last; i++) {
        double x = point[i][0] - point[first][0], y = (point[i][1] - point[first][1]) * row;
        double along = x * dx + y * dy, off = fabs(x * dy - y * dx);
        if (!(off <= BLUR * length && along >= 0 && along <= length * length))
            return 0;
    }
    return 1;
}

static void
write_line(const double (*point)[2], size_t n, void *user)
{
    line_sink *sink = user;
    double row = (double)ROWS / (double)(sink->c->n_scales - 1);    /* pixels */
    write_point(sink, point[0]);
    for (size_t first = 0, last; first < n - 1; first = last) {
        for (last = first + 1; last + 1 < n && last - first < 64
             && is_straight(point, first, last + 1, row); last++)
            ;
        write_point(sink, point[last]);
    }
    putc('\n', sink->out);
    sink->lines++;
}

/* A datablock of time, frequency and number of the level, a blank line after each line and two after
 * each level, and which levels have lines; *any is 1 if one has. */
static ss_status
write_contours(FILE *out, const ss_coefficients *c, const ss_contour_opts *contour,
               const script_span *span, const double *level, int *any)
{
    char drawn[LEVELS * sizeof " 100"] = "";
    line_sink sink = { out, c, span, 0, 0 };
    const isoline_map map = { COLUMNS + 1, c->n_scales, level };
    ss_status status = SS_OK;
    fputs("$contour << EOD\n", out);
    for (int k = 1; status == SS_OK && k <= contour->levels; k++) {
        sink.level = k;
        sink.lines = 0;
        status = ss_isolines(&map, -k * contour->span / contour->levels, write_line, &sink);
        if (sink.lines > 0) {
            putc('\n', out);
            snprintf(drawn + strlen(drawn), sizeof drawn - strlen(drawn), " %d", k);
        }
    }
    *any = drawn[0] != '\0';
    fprintf(out, "EOD\ndrawn = '%s'     # levels that have lines\n", drawn + (drawn[0] == ' '));
    return status;
}

/* --- axes, cone, marks ---------------------------------------------------------------------- */

/* Decimals of a frequency: six digits at least. */
static int
decimals_of(double f)
{
    return (int)fmax(6, 5 - floor(log10(f)));
}

/* One side of a shaded area: from lo to hi Hz the times that are sqrt(2) a after t, or before it where
 * the sign is -1, but not beyond stop. */
static void
write_side(FILE *out, const script_span *span, double t, int sign, double stop, double center,
           const double band[2])
{
    enum { POINTS = 100 };
    int decimals = ss_script_decimals(span->to - span->from);
    for (int i = 0; i <= POINTS; i++) {
        double part = (double)(sign > 0 ? i : POINTS - i) / POINTS;
        double f = band[0] * pow(band[1] / band[0], part);
        double edge = t + sign * sqrt(2) * center / (2 * M_PI * f);
        edge = sign > 0 ? fmin(edge, stop) : fmax(edge, stop);
        ss_script_write(out, fmin(fmax(edge, span->from), span->to), decimals, " ");
        ss_script_write(out, f, decimals_of(f), "\n");
    }
}

/* The cone of influence, within sqrt(2) a of an end of the record, and the same around gaps: closed
 * curves, two blank lines between them.  Each has a plot command of its own, since gnuplot 5.2 draws
 * a line from one to the next. */
static void
write_cone(FILE *out, const ss_coefficients *c, const script_span *span, const double band[2])
{
    double start = c->head->start, end = start + (double)(c->n - 1) / c->head->rate;
    fputs("$cone << EOD\n", out);
    write_side(out, span, start, 1, start + (end - start) / 2, c->center, band);
    write_side(out, span, -INFINITY, -1, start, c->center, band);
    fputs("\n\n", out);
    write_side(out, span, end, -1, end - (end - start) / 2, c->center, band);
    write_side(out, span, INFINITY, 1, end, c->center, band);
    for (size_t i = 0; i < c->n_gaps; i++) {
        fputs("\n\n", out);
        write_side(out, span, c->gap[i].to, 1, end, c->center, band);
        write_side(out, span, c->gap[i].from, -1, start, c->center, band);
    }
    fputs("EOD\n", out);
}

/* Tics at every digit of every power of ten; labels at 1 2 5 10 20 50 ... Hz, at the powers only
 * where those would not fit, and at every digit where there are few. */
static void
write_frequency_tics(FILE *out, double lo, double hi)
{
    int sparse = hi / lo > 2e4, dense = hi / lo < 8;
    double fine = hi / lo < 2 ? 10 : 1;         /* tics a digit */
    const char *between = "set ytics (";
    for (int e = (int)floor(log10(lo)); e <= (int)floor(log10(hi)); e++)
        for (int i = (int)fine; i < 10 * fine; i++) {
            double f = e < 0 ? i / (fine * pow(10, -e)) : i * pow(10, e) / fine;
            int major = dense || i == 1 || (!sparse && (i == 2 || i == 5));
            char text[SS_NUMBER_MAX];
            if (f < lo || f > hi)
                continue;
            ss_number_format(text, f);
            fprintf(out, "%s'%s' %s %d", between, major ? text : "", text, !major);
            between = ", ";
        }
    fputs(between[0] == ',' ? ")\n" : "", out);
}

static void
write_events(FILE *out, const ss_contour_opts *contour, const script_span *span)
{
    int decimals = ss_script_decimals(span->to - span->from);
    fputs("$events << EOD\n", out);
    for (size_t i = 0; i < contour->n_events; i++)
        for (int end = 0; end < 2; end++) {
            ss_script_write(out, contour->event[i], decimals, end == 0 ? " 0\n" : " 1\n\n");
            if (contour->event[i] < span->from || contour->event[i] > span->to)
                break;                          /* half a line draws nothing */
        }
    fputs("EOD\n", out);
}

static int
is_inside(const script_span *span, double t)
{
    return t >= span->from && t <= span->to;
}

/* The part of an overlay in the drawn span: an empty block is an error for gnuplot. */
typedef struct visible {
    size_t spans, spikes, maxima;
} visible;

/* Spans, cut at the ends, spikes, and maxima with their frequencies. */
static visible
write_overlay(FILE *out, const ss_overlay *overlay, const script_span *span)
{
    int decimals = ss_script_decimals(span->to - span->from);
    visible seen = { 0, 0, 0 };
    fputs("$spans << EOD\n", out);
    for (size_t i = 0; i < overlay->n_spans; i++) {
        double shortest = (span->to - span->from) / COLUMNS * 2;        /* that is visible */
        double from = fmax(overlay->span[i][0], span->from);
        double to = fmin(fmax(overlay->span[i][1], overlay->span[i][0] + shortest), span->to);
        if (!(from <= to))
            continue;
        ss_script_write(out, from, decimals, " ");
        ss_script_write(out, to, decimals, "\n");
        seen.spans++;
    }
    fputs("EOD\n$spikes << EOD\n", out);
    for (size_t i = 0; i < overlay->n_spikes; i++)
        if (is_inside(span, overlay->spike[i])) {
            ss_script_write(out, overlay->spike[i], decimals, "\n");
            seen.spikes++;
        }
    fputs("EOD\n$maxima << EOD\n", out);
    for (size_t i = 0; i < overlay->n_maxima; i++)
        if (is_inside(span, overlay->maximum[i][0])) {
            ss_script_write(out, overlay->maximum[i][0], decimals, " ");
            ss_script_write(out, overlay->maximum[i][1], decimals_of(overlay->maximum[i][1]), "\n");
            seen.maxima++;
        }
    fputs("EOD\n", out);
    return seen;
}

/* --- the script ---------------------------------------------------------------------------- */

static const char around[] =
    "set multiplot\n"
    "left = 0.175; right = 0.835\n"
    "set lmargin at screen left; set rmargin at screen right\n"
    "set xrange [from:to]; unset key; set border lw 0.8; set tics nomirror out scale 0.6,0.3\n"
    SCRIPT_TIME_TICS;

#define ROOM 6.0                /* [ems] for the name of the signal, between "(a)" and "(b)" */

static const char panel_a[] =
    "set tmargin at screen 0.925; set bmargin at screen 0.72\n"
    "set label 1 '(a)' at screen 0.01, screen 0.96\n"
    "set xtics format ''; ";

static const char panel_a_plot[] =
    "set offsets 0,0,graph 0.06,graph 0.06; set autoscale yfix\n"
    "plot $signal using 1:2 with lines lw 1 lc rgb 'black'\n"
    "unset title; set offsets 0,0,0,0\nunset label 2\n";

static const char panel_b[] =
    "set bmargin at screen bottom; set tmargin at screen top_b\n"
    "set label 1 '(b)' at screen 0.01, screen top_b + 0.03\n"
    SCRIPT_TIME_LABELS
    "set label 2 'frequency / Hz' at screen 0.03,graph 0.5 center rotate\n"
    "set logscale y; set yrange [fmin:fmax]\n"
    "set palette defined (@colours) maxcolors levels\n"
    "set cbrange [-span - step/2 : -step/2]\n"
    "set cbtics scale 0.4 offset -0.7,0; set cblabel 'level / dB re largest |W|' noenhanced offset -0.6,0\n"
    "set colorbox user origin screen right + 0.02, screen bottom size screen 0.025, screen top_b - bottom\n";

/* Bars and marks in the rims of the panel; rings in white and colour, visible on any ground. */
static void
write_features(FILE *out, const visible *seen)
{
    if (seen->spans > 0)
        fputs(", \\\n    $spans using 1:(rim(0.02)):($2-$1):(0) with vectors nohead lw 3 "
              "lc rgb feature_colour", out);
    if (seen->spikes > 0)
        fputs(", \\\n    $spikes using 1:(rim(0.98)) with points pt 11 ps 0.6 "
              "lc rgb feature_colour", out);
    if (seen->maxima > 0)
        fputs(", \\\n    $maxima using 1:2 with points pt 6 ps 0.9 lw 3.5 lc rgb 'white', \\\n"
              "    $maxima using 1:2 with points pt 6 ps 0.9 lw 1.5 lc rgb feature_colour", out);
}

/* Panel (a) in the script. */
typedef struct panel {
    double range;               /* of the signal, as drawn */
    script_label label;
} panel;

/* Events first, so that they lie behind the lines; then the cone, the contours, and the features.
 * Each level has one colour: gnuplot 6.0 loses some lines that have a colour for each point. */
static void
write_panels(FILE *out, const ss_coefficients *c, const ss_contour_opts *contour, const panel *a,
             int lines, const visible *seen)
{
    fputs(around, out);
    if (contour->signal != NULL) {
        ss_script_write_tics(out, "ytics", a->range, 5);
        fputs(panel_a, out);
        ss_script_write_side_label(out, 2, &a->label);
        fputs(panel_a_plot, out);
    }
    fputs(contour->signal != NULL ? "bottom = 0.12; top_b = 0.68\n"
                                  : "bottom = 0.16; top_b = 0.925\n", out);
    fputs(panel_b, out);
    write_frequency_tics(out, c->scale[0].f, c->scale[c->n_scales - 1].f);
    if (contour->signal == NULL)
        fputs("unset label 1\n", out);
    fprintf(out, "plot for [i=0:%zu] $cone index i using 1:2 with filledcurves closed "
            "fs solid 1 noborder lc rgb cone_colour", c->n_gaps + 1);
    if (contour->n_events > 0)
        fputs(", \\\n    $events using 1:($2 > 0 ? fmax : fmin) with lines lw 0.5 "
              "lc rgb event_colour", out);
    if (lines)
        fputs(", \\\n    for [i=1:words(drawn)] $contour index i-1 using 1:2 with lines lw 1 "
              "lc palette cb -word(drawn,i)*step", out);
    write_features(out, seen);
    fputs("\nunset multiplot\n", out);
}

static ss_status
check_scales(const ss_coefficients *c, ss_error *err)
{
    for (size_t i = 0; i < c->n_scales; i++) {
        const ss_scale *s = &c->scale[i];
        if (!(s->f >= 1e-300 && s->f <= 1e300 && (i == 0 || s->f > s[-1].f)))
            return ss_fail(err, SS_EINVAL, "scale %zu of %g Hz cannot be drawn", i + 1, s->f);
        if (s->n == 0 || !(s->b_num / s->b_den > 0))
            return ss_fail(err, SS_EINVAL, "scale %zu has no translations", i + 1);
    }
    return SS_OK;
}

/* NULL if every entry of an overlay can be drawn, else the name of the first that cannot. */
static const char *
find_unplaced(const ss_overlay *overlay)
{
    for (size_t i = 0; i < overlay->n_spans; i++)
        if (!isfinite(overlay->span[i][0]) || !isfinite(overlay->span[i][1]))
            return "transition";
    for (size_t i = 0; i < overlay->n_maxima; i++)
        if (!isfinite(overlay->maximum[i][0]) || !(overlay->maximum[i][1] > 0)
            || isinf(overlay->maximum[i][1]))
            return "maximum";
    for (size_t i = 0; i < overlay->n_spikes; i++)
        if (!isfinite(overlay->spike[i]))
            return "spike";
    return NULL;
}

static ss_status
check_overlays(const ss_contour_opts *contour, ss_error *err)
{
    const char *what = contour->overlay != NULL ? find_unplaced(contour->overlay) : NULL;
    for (size_t i = 0; i < contour->n_events; i++)
        if (!isfinite(contour->event[i]))
            what = "event";
    if (what != NULL)
        return ss_fail(err, SS_EINVAL, "a time or frequency of a%s %s is not finite",
                       what[0] == 'e' ? "n" : "", what);
    return SS_OK;
}

static ss_status
check(const ss_coefficients *c, const ss_contour_opts *contour, ss_error *err)
{
    ss_status st = ss_range_check(contour->levels, ss_contour_levels, "levels", err);
    if (st == SS_OK)
        st = ss_range_check(contour->span, ss_contour_spans, "span [dB]", err);
    if (st != SS_OK)
        return st;
    if (contour->signal != NULL && contour->column >= contour->signal->head->n_columns)
        return ss_fail(err, SS_EINVAL, "no column %zu, there are %zu", contour->column + 1,
                       contour->signal->head->n_columns);
    if (c->w == NULL && contour->source == NULL)
        return ss_fail(err, SS_EINVAL, "no coefficients, and no source of them");
    if (c->n_scales < 2)
        return ss_fail(err, SS_EINVAL, "contours need two scales at least, there are %zu",
                       c->n_scales);
    if (contour->signal != NULL) {
        const ss_signal *s = contour->signal;
        ss_status status = ss_script_check(s->head->column[contour->column].name,
                                           s->values + contour->column * s->n, s->n, err);
        if (status != SS_OK)
            return status;
    }
    return check_scales(c, err);
}

static ss_status
write_signal(FILE *out, const ss_contour_opts *contour, const ss_plot_opts *opts, panel *a,
             ss_error *err)
{
    const ss_signal *signal = contour->signal;
    const double *x = signal->values + contour->column * signal->n;
    script_span span;
    ss_status status = ss_script_find_span(&span, signal->head, signal->n, opts, err);
    if (status != SS_OK)
        return status;
    int exponent = ss_script_exponent(x + span.first, span.n);
    ss_script_make_label(&a->label, &signal->head->column[contour->column], exponent, ROOM);
    a->range = ss_script_write_trace(out, "$signal", x, signal->head, &span, exponent);
    return SS_OK;
}

static ss_status
write_script(FILE *out, const ss_coefficients *c, const ss_contour_opts *contour,
             const ss_plot_opts *opts, script_span span, const double *level, ss_error *err)
{
    ss_status status = ss_script_begin(out, opts, contour->signal != NULL ? 8.5 : 6.5, err);
    if (status != SS_OK)
        return status;
    ss_script_write_title(out, opts, c->head, NULL);
    double fmin = c->scale[0].f, fmax = c->scale[c->n_scales - 1].f;
    panel a = { .range = 0 };
    int lines = 0;
    visible seen = { 0, 0, 0 };
    ss_plot_opts drawn = *opts;         /* panel (a) shows the time of (b) */
    drawn.from = span.from;
    drawn.to = span.to;
    ss_script_write_span(out, &span);
    fprintf(out, "levels = %d          # contour lines, computed for this number and span\nspan = ",
            contour->levels);
    ss_script_write(out, contour->span, 6,
                    "           # dB below the largest |W|\nstep = 1.0*span/levels\n");
    fputs("fmin = ", out);
    ss_script_write(out, fmin, decimals_of(fmin), "    # Hz\nfmax = ");
    ss_script_write(out, fmax, decimals_of(fmax), "  # Hz\n");
    fputs("colours = \"0 '#7ad151', 0.3 '#22a884', 0.55 '#2a788e', 0.8 '#414487', 1 '#440154'\"\n"
          "cone_colour = '#e4e4e4'; event_colour = '#d55e00'\n", out);
    if (contour->signal != NULL)
        status = write_signal(out, contour, &drawn, &a, err);
    if (status != SS_OK)
        return status;
    write_cone(out, c, &span, (const double[2]){ fmin, fmax });
    if (contour->n_events > 0)
        write_events(out, contour, &span);
    if (contour->overlay != NULL) {
        fputs("feature_colour = '#cc3311'; rim(part) = fmin*(fmax/fmin)**part\n", out);
        seen = write_overlay(out, contour->overlay, &span);
    }
    status = write_contours(out, c, contour, &span, level, &lines);
    if (status != SS_OK)
        return status;
    write_panels(out, c, contour, &a, lines, &seen);
    return ss_script_end(out);
}

ss_status
ss_plot_contour(FILE *out, const ss_coefficients *c, const ss_contour_opts *contour,
                const ss_plot_opts *opts, ss_error *err)
{
    if (out == NULL || c == NULL || contour == NULL || opts == NULL)
        return SS_FAIL_NULL(err);
    script_span span;
    double *level = NULL;
    ss_status status = check(c, contour, err);
    if (status == SS_OK)
        status = check_overlays(contour, err);
    if (status == SS_OK)
        status = ss_script_find_span(&span, c->head, c->n, opts, err);
    if (status == SS_OK)
        status = make_map(&level, c, contour, &span, err);
    if (status == SS_OK)
        status = write_script(out, c, contour, opts, span, level, err);
    free(level);
    return status;
}
