/* contour.c -- contours of |W| in decibels over time and frequency, below the signal: the script, with its
 * axes, cone of influence and marks.  The contours are those of contour_lines.c. */
#include "plot/contour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/range.h"
#include "morlet/wavelet.h"

const ss_range ss_contour_levels = { 1, CONTOUR_LEVELS }, ss_contour_spans = { 1e-3, 1000 };
const ss_contour_opts ss_contour_defaults = { .levels = 18, .span = 80 };

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
        double edge = t + sign * wavelet_cone(center / (2 * M_PI * f));
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
        double shortest = (span->to - span->from) / CONTOUR_COLUMNS * 2;        /* that is visible */
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
    status = ss_contour_write_lines(out, c, contour, &span, level, &lines);
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
        status = ss_contour_map(&level, c, contour, &span, err);
    if (status == SS_OK)
        status = write_script(out, c, contour, opts, span, level, err);
    free(level);
    return status;
}
