/* contour.c -- draw contours of |W| in decibels over time and frequency, below the signal: the
 * script, its axes, the cone of influence, and the marks of events and features. */
#include "plot/contour.h"
#include "plot/series.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/options.h"
#include "io/record.h"
#include "map/map.h"

const struct ss_contour_ranges ss_contour_ranges = { { 1, CONTOUR_LEVELS }, { 1e-3, 1000 }, { -2000, 2000 } };
static const ss_contour_opts defaults = { .levels = 18, .span = 80, .noise = NAN, .level = NAN };

SS_OPTIONS(ss_contour_opts, defaults)

/* --- colours whose lightness falls in even steps, for levels on white paper, or rises ------------
 *
 * viridis, plasma, inferno and magma are those of S. van der Walt and N.  Smith for matplotlib (2015), which they
 * dedicated to the public domain (CC0), cividis that of J.  Nunez, C.  Anderton and R.  Renslow (2018), which all
 * kinds of colour vision see alike; at tenths of their range, between which colours are mixed. */

enum { TENTHS = 11, PALETTES = 6 };

/* Dark to light. */
static const char *const shade[PALETTES][TENTHS] = {
    { "#440154", "#482475", "#414487", "#355f8d", "#2a788e", "#21918c", "#22a884", "#44bf70", "#7ad151",
      "#bddf26", "#fde725" },
    { "#00224e", "#083370", "#35456c", "#4f576c", "#666970", "#7d7c78", "#948e77", "#aea371", "#c8b866",
      "#e5cf52", "#fee838" },
    { "#0d0887", "#41049d", "#6a00a8", "#8f0da4", "#b12a90", "#cc4778", "#e16462", "#f2844b", "#fca636",
      "#fcce25", "#f0f921" },
    { "#000004", "#160b39", "#420a68", "#6a176e", "#932667", "#bc3754", "#dd513a", "#f37819", "#fca50a",
      "#f6d746", "#fcffa4" },
    { "#000004", "#140e36", "#3b0f70", "#641a80", "#8c2981", "#b73779", "#de4968", "#f7705c", "#fe9f6d",
      "#fecf92", "#fcfdbf" },
    { "#000000", "#1b1b1b", "#303030", "#474747", "#5e5e5e", "#777777", "#919191", "#ababab", "#c6c6c6",
      "#e2e2e2", "#ffffff" },
};
const char *const ss_palettes[] = {
    "viridis", "cividis", "plasma", "inferno", "magma", "grey",
    "viridis_r", "cividis_r", "plasma_r", "inferno_r", "magma_r", "grey_r", NULL
};

/* Its place among ss_palettes; those from PALETTES on have a light loudest level. */
static int
find_palette(const char *name)
{
    int i = 0;
    while (ss_palettes[i] != NULL && strcmp(ss_palettes[i], name) != 0)
        i++;
    return i;
}

static int
is_palette(const char *name)
{
    return ss_palettes[find_palette(name)] != NULL;
}

const char *
ss_palette_ground(const char *name)
{
    int i = find_palette(name);
    return i >= PALETTES ? shade[i - PALETTES][0] : NULL;
}

void
ss_palette_write(FILE *out, const char *name, int areas)
{
    int i = find_palette(name);
    int lightest = areas ? TENTHS - 1 : TENTHS - 3;     /* a line of the last two is lost on white */
    fputs("colours = \"", out);
    for (int k = 0; k <= lightest; k++)
        ss_print(out, "%g '%s'%s", (double)k / lightest, shade[i % PALETTES][i < PALETTES ? lightest - k : k],
                k < lightest ? ", " : "\"\n");
}

/* --- axes and cone --------------------------------------------------------------------------- */

/* Decimals of a frequency: six digits at least. */
static int
decimals_of(double f)
{
    return (int)fmax(6, 5 - floor(log10(f)));
}

/* Write the cone of influence, within sqrt(2) a of an end of the record or of a gap, as a closed curve: at each
 * time the frequency below which coefficients are influenced. */
static void
write_cone(FILE *out, const ss_coefficients *c, const script_span *span, const double band[2])
{
    double start = c->head->start, end = start + (double)(c->n - 1) / c->head->rate, range = span->to - span->from;
    double half = range / CONTOUR_COLUMNS / 2, reach = wavelet_cone(c->center / (2 * M_PI));
    fputs("$cone << EOD\n", out);
    for (int i = -1; i <= CONTOUR_COLUMNS + 1; i++) {
        double t = span->from + fmin(fmax(i, 0), CONTOUR_COLUMNS) / CONTOUR_COLUMNS * range, f = band[0];
        double away = fmin(t - start, end - t);
        for (size_t k = 0; k < c->n_gaps; k++)
            away = fmin(away, fmax(fmax(c->gap[k].from - t, t - c->gap[k].to) - half, 0));
        if (i >= 0 && i <= CONTOUR_COLUMNS)
            f = away > 0 ? fmin(fmax(reach / away, band[0]), band[1]) : band[1];
        ss_script_write(out, t, ss_script_decimals(range), " ");
        ss_script_write(out, f, decimals_of(f), "\n");
    }
    fputs("EOD\n", out);
}

/* Tics at every digit of every power of ten; labels at 1 2 5 10 20 50 ... Hz, at the powers only where those would
 * not fit, and at every digit where there are few.  High ones are in 10^3 Hz, 10^6 Hz. */
static void
write_frequency_tics(FILE *out, double lo, double hi)
{
    int exponent = hi >= 1e5 ? 3 * (int)floor(log10(hi) / 3) : 0;
    ss_script_write_side_label(out, 2, &(ss_column){ "frequency", "Hz" }, ss_script_power(exponent), 20);
    int sparse = hi / lo > 2e4, dense = hi / lo < 8;
    double fine = hi / lo < 2 ? 10 : 1;         /* tics a digit */
    const char *between = "set ytics (";
    for (int e = (int)floor(log10(lo)); e <= (int)floor(log10(hi)); e++)
        for (int i = (int)fine; i < 10 * fine; i++) {
            double f = e < 0 ? i / (fine * pow(10, -e)) : i * pow(10, e) / fine;
            int major = dense || i == 1 || (!sparse && (i == 2 || i == 5));
            char text[SS_NUMBER_MAX], at[SS_NUMBER_MAX];
            double power = pow(10, abs(e - exponent));
            if (f < lo || f > hi)
                continue;
            ss_number_format(at, f);
            ss_number_format(text, e < exponent ? i / (fine * power) : i * power / fine);
            ss_print(out, "%s'%s' %s %d", between, major ? text : "", at, !major);
            between = ", ";
        }
    fputs(between[0] == ',' ? ")\n" : "", out);
}

/* --- marks: events and features, of which those outside the map are left out ---------------- */

static int
is_inside(const script_span *span, double t)
{
    return t >= span->from && t <= span->to;
}

static void
write_time(FILE *out, const script_span *span, double t, const char *behind)
{
    ss_script_write(out, t, ss_script_decimals(span->to - span->from), behind);
}

size_t
ss_contour_write_spans(FILE *out, const script_span *span, const ss_overlay *overlay)
{
    size_t n = 0;
    double shortest = (span->to - span->from) / CONTOUR_COLUMNS * 2;        /* that is visible */
    fputs("$spans << EOD\n", out);
    for (size_t i = 0; i < overlay->n_spans; i++) {
        double onset = overlay->span[i][0], end = fmax(overlay->span[i][1], onset + shortest);
        if (!(onset <= span->to && end >= span->from))
            continue;
        write_time(out, span, fmax(onset, span->from), " ");
        write_time(out, span, fmin(end, span->to), "\n");
        n++;
    }
    fputs("EOD\n", out);
    return n;
}

/* The number of marks of each kind that are drawn: an empty block is an error in gnuplot. */
typedef struct marks {
    size_t events, spans, spikes, maxima;
} marks;

/* Write datablocks of the events and the overlay inside the map. */
static marks
write_marks(FILE *out, const contour_map *map, const ss_contour_opts *contour)
{
    const script_span *span = map->span_of_time;
    const ss_overlay *o = contour->overlay;
    marks n = { 0 };
    fputs(contour->n_events > 0 ? "$events << EOD\n" : "", out);
    for (size_t i = 0; i < contour->n_events; i++)
        if (is_inside(span, contour->event[i])) {
            write_time(out, span, contour->event[i], " 0\n");
            write_time(out, span, contour->event[i], " 1\n\n");
            n.events++;
        }
    fputs(contour->n_events > 0 ? "EOD\n" : "", out);
    if (o == NULL)
        return n;
    fputs("feature_colour = '" MARK_COLOUR "'; rim(part) = fmin*(fmax/fmin)**part\n", out);
    n.spans = ss_contour_write_spans(out, span, o);
    fputs("$spikes << EOD\n", out);
    for (size_t i = 0; i < o->n_spikes; i++)
        if (is_inside(span, o->spike[i])) {
            write_time(out, span, o->spike[i], "\n");
            n.spikes++;
        }
    fputs("EOD\n$maxima << EOD\n", out);
    for (size_t i = 0; i < o->n_maxima; i++) {
        double f = o->maximum[i][1];
        if (is_inside(span, o->maximum[i][0]) && f >= map->f[0] && f <= map->f[map->rows - 1]) {
            write_time(out, span, o->maximum[i][0], " ");
            ss_script_write(out, f, decimals_of(f), "\n");
            n.maxima++;
        }
    }
    fputs("EOD\n", out);
    return n;
}

/* --- the script ---------------------------------------------------------------------------- */

#define ROOM 6.8                /* [ems] for the name of the signal, between "(a)" and "(b)" */

static const char around[] =
    "set multiplot\n"
    "left = 0.175; right = 0.835\n"
    "set lmargin at screen left; set rmargin at screen right\n"
    "set xrange [from:to]; unset key; set border lw 0.8; set tics nomirror out scale 0.6,0.3; set xtics tics\n";

static const char panel_a[] =
    "set offsets 0,0,graph 0.06,graph 0.06; set autoscale yfix\n"
    "plot $signal using 1:2 with lines lw 1 lc rgb 'black'\n"
    "unset title; set offsets 0,0,0,0\nunset label 2\n";

static const char panel_b[] =
    "set bmargin at screen bottom; set tmargin at screen top_b\n"
    "set logscale y; set yrange [fmin:fmax]\n"
    "set palette defined (@colours) maxcolors levels\n"
    "set cbtics scale 0.4 offset -0.7,0; set cblabel reference noenhanced offset -0.6,0\n"
    "set colorbox user origin screen right + 0.02, screen bottom size screen 0.025, screen top_b - bottom\n";

/* The colour below the areas; NULL: that of the paper. */
static const char *
ground_of(const ss_contour_opts *contour)
{
    return contour->fill && contour->palette != NULL ? ss_palette_ground(contour->palette) : NULL;
}

/* The variables at the top. */
static void
write_variables(FILE *out, const contour_map *map, const ss_contour_opts *contour)
{
    double fmin = map->f[0], fmax = map->f[map->rows - 1];
    ss_script_write_span(out, map->span_of_time);
    ss_print(out, "levels = %d          # contour lines, computed for this number and span\nspan = ",
            contour->levels);
    ss_script_write(out, map->span, 6, "           # dB below 0 dB\nstep = 1.0*span/levels\n");
    if (map->top > 0)
        ss_print(out, "level = %.2f       # dB re 1, the |W| that is 0 dB\n", 20 * log10(map->top));
    fputs(isnan(contour->level) ? "reference = 'level / dB re largest |W|'\n"
                                : "reference = sprintf('level / dB re |W| of %g dB', level)\n", out);
    if (!isnan(map->noise))
        ss_print(out, "noise = %g         # dB\n", map->noise);
    fputs("fmin = ", out);
    ss_script_write(out, fmin, decimals_of(fmin), "    # Hz\nfmax = ");
    ss_script_write(out, fmax, decimals_of(fmax), "  # Hz\n");
    if (contour->palette == NULL && !contour->fill)
        fputs("colours = \"" LEVEL_COLOURS "\"\n", out);
    else
        ss_palette_write(out, contour->palette != NULL ? contour->palette : "viridis", contour->fill);
    if (contour->fill)
        ss_print(out, "ground_colour = '%s'\n", ground_of(contour) != NULL ? ground_of(contour) : "white");
    fputs("cone_colour = '" CONE_COLOUR "'; event_colour = '" VERMILION "'\n", out);
    if (contour->fill)
        fputs("line_colour = '" LEVEL_COLOUR "'\n", out);
}

/* Where ridge points go: a datablock, or rows. */
typedef struct ridge_of {
    FILE *out;
    const contour_map *map;
    const ss_coefficients *c;
    struct rows rows;
} ridge_of;

static void
write_point(double t, double f, double level, void *user)
{
    const ridge_of *to = user;
    (void)level;
    ss_script_write(to->out, t, ss_script_decimals(to->map->to - to->map->from), " ");
    ss_script_write(to->out, f, 4 - (int)floor(log10(f)), "\n");
}

/* Of A cos(w t), |W| is A (a / 2)^1/2 pi^1/4 exp(-(a w - c)^2 / 2), largest where 2 a w = c + (c^2 + 2)^1/2; with
 * the norm 1/a it is that over a^1/2, largest where a w = c. */
static void
write_row(double t, double f, double level, void *user)
{
    ridge_of *to = user;
    const ss_coefficients *c = to->c;
    const char *norm = ss_header_find_note(c->head, "norm"), *unit = ss_header_find_note(c->head, "unit");
    int is_l1 = norm != NULL && strcmp(norm, "l1") == 0;
    double w = to->map->top * pow(10, level / 20), a = is_l1 ? 1 : c->center / (2 * M_PI * f);
    double phase = is_l1 ? c->center : (c->center + sqrt(c->center * c->center + 2)) / 2, off = phase - c->center;
    ss_rows_number(&to->rows, "t", "s", t);
    ss_rows_number(&to->rows, "frequency", "Hz", f * phase / c->center);
    ss_rows_number(&to->rows, "amplitude", unit != NULL ? unit : "",
                   w / sqrt(a / 2) / sqrt(sqrt(M_PI)) * exp(off * off / 2));
    ss_rows_end(&to->rows);
}

/* The cone is drawn first, over the colours if there are any, then events, contours and features,
 * so that events lie behind the contours.  Each level has one colour: gnuplot 6.0 loses some lines
 * that have a colour for each point. */
static ss_status
write_map(FILE *out, const contour_map *map, const ss_coefficients *c, const ss_contour_opts *contour)
{
    int lines;
    size_t ridge = 0;
    ss_status st = SS_OK;
    write_cone(out, c, map->span_of_time, (const double[2]){ map->f[0], map->f[map->rows - 1] });
    marks n = write_marks(out, map, contour);
    if (contour->ridge) {
        fputs("ridge_colour = '" MARK_COLOUR "'\n", out);
        fputs("$ridge << EOD\n", out);
        ridge = ss_contour_ridge(map, c, write_point, &(ridge_of){ .out = out, .map = map });
        fputs("EOD\n", out);
    }
    st = ss_contour_write_lines(out, map, contour->levels, &lines);
    if (st != SS_OK)
        return st;
    fputs(contour->signal != NULL ? "bottom = 0.12; top_b = 0.68\n" : "bottom = 0.16; top_b = 0.925\n", out);
    ss_script_write_time_labels(out, map->span_of_time);
    fputs(panel_b, out);
    fputs(contour->signal != NULL ? "set label 1 '(b)' at screen 0.01, screen top_b + 0.03\n" : "", out);
    /* A colour is that of a line, or that of the area between two lines. */
    fputs(contour->fill ? "set cbrange [-span:0]\n" : "set cbrange [-span - step/2 : -step/2]\n", out);
    if (!isnan(map->noise))
        fputs("set label 3 sprintf('noise at %d dB', noise) at screen 0.99,screen 0.3*bottom right noenhanced"
              "\n", out);
    write_frequency_tics(out, map->f[0], map->f[map->rows - 1]);
    if (ground_of(contour) != NULL)
        fputs("set object rectangle from graph 0,0 to graph 1,1 back fc rgb ground_colour fs solid noborder\n",
              out);
    if (contour->fill)
        st = ss_contour_write_fill(out, map, contour->levels);
    ss_print(out, "plot $cone using 1:2 with filledcurves closed fs %s noborder lc rgb cone_colour",
             contour->fill ? "transparent solid 0.6" : "solid 1");
    if (n.events > 0)
        fputs(", \\\n    $events using 1:($2 > 0 ? fmax : fmin) with lines lw 0.5 lc rgb event_colour", out);
    if (lines)
        ss_print(out, ", \\\n    for [i=1:words(drawn)] $contour index i-1 using 1:2 with lines %s",
                 contour->fill ? "lw 0.3 lc rgb line_colour" : "lw 1 lc palette cb -word(drawn,i)*step");
    if (ridge > 0)
        fputs(", \\\n    $ridge using 1:2 with points pt 7 ps 0.2*mark lc rgb ridge_colour", out);
    /* bars and marks in the rims of the panel; rings in white and colour, visible on any ground */
    if (n.spans > 0)
        fputs(", \\\n    $spans using 1:(rim(0.02)):($2-$1):(0) with vectors nohead lw 3 "
              "lc rgb feature_colour", out);
    if (n.spikes > 0)
        fputs(", \\\n    $spikes using 1:(rim(0.98)) with points pt 11 ps 0.6*mark lc rgb feature_colour", out);
    if (n.maxima > 0)
        fputs(", \\\n    $maxima using 1:2 with points pt 7 ps 0.9*mark lc rgb 'white', \\\n"
              "    $maxima using 1:2 with points pt 7 ps 0.7*mark lc rgb feature_colour, \\\n"
              "    $maxima using 1:2 with points pt 7 ps 0.35*mark lc rgb 'white'", out);
    putc('\n', out);
    return st;
}

static ss_status
check(const ss_coefficients *c, const ss_contour_opts *contour, ss_error *err)
{
    const ss_signal *signal = contour->signal;
    ss_status st = ss_range_check(contour->levels, ss_contour_ranges.levels, "levels", err);
    if (st == SS_OK)
        st = ss_range_check(contour->span, ss_contour_ranges.span, "span [dB]", err);
    if (st == SS_OK && !isnan(contour->level))
        st = ss_range_check(contour->level, ss_contour_ranges.level, "level [dB]", err);
    if (st != SS_OK)
        return st;
    if (contour->noise < 0 || isinf(contour->noise) || !(contour->top >= 0 && contour->top <= DBL_MAX)
        || !(contour->fmin >= 0) || !(contour->fmax >= 0))
        return ss_fail(err, SS_EINVAL, "noise, top, fmin or fmax is negative or not finite");
    if (contour->palette != NULL && !is_palette(contour->palette))
        return ss_fail(err, SS_EINVAL, "no palette '%.40s'", contour->palette);
    if (signal != NULL && contour->column >= signal->head->n_columns)
        return ss_fail_column(err, contour->column, signal->head->n_columns);
    if (c->w == NULL && c->source == NULL)
        return ss_fail(err, SS_EINVAL, "no coefficients, and no source of them");
    if (c->n_scales < 2)
        return ss_fail(err, SS_EINVAL, "contours need two scales at least, there are %zu", c->n_scales);
    for (size_t i = 0; i < c->n_scales; i++) {
        const ss_scale *s = &c->scale[i];
        if (!(s->f >= 1e-300 && s->f <= 1e300 && (i == 0 || s->f > s[-1].f)))
            return ss_fail(err, SS_EINVAL, "scale %zu of %g Hz cannot be drawn", i + 1, s->f);
        if (s->n == 0 || !(s->b_num / s->b_den > 0))
            return ss_fail(err, SS_EINVAL, "scale %zu has no translations", i + 1);
    }
    return SS_OK;
}

/* The caller's options, and the map. */
typedef struct picture {
    script_span span;
    ss_plot_opts opts;
    ss_contour_opts contour;
    contour_map map;
} picture;

/* To be freed even after a failure. */
static ss_status
prepare(picture *p, const ss_coefficients *c, const ss_contour_opts *contour, const ss_plot_opts *opts,
        ss_error *err)
{
    p->map.f = p->map.level = NULL;
    ss_status st = ss_script_take(&p->opts, opts, err);
    if (st == SS_OK)
        st = ss_options_take(&p->contour, sizeof p->contour, &defaults, contour, err);
    if (st == SS_OK)
        st = check(c, &p->contour, err);
    if (st == SS_OK)
        st = ss_script_find_span(&p->span, c->head->start, c->head->rate, c->n, &p->opts, err);
    return st == SS_OK ? ss_contour_map(&p->map, c, &p->contour, &p->span, err) : st;
}

ss_status
ss_ridge_write(const ss_coefficients *c, const ss_contour_opts *contour, const ss_plot_opts *opts, FILE *out,
               ss_format format, ss_error *err)
{
    static const char *const own_notes[] = { "columns", NULL };
    picture p;
    if (out == NULL || c == NULL)
        return SS_FAIL_NULL(err);
    ridge_of to = { out, &p.map, c, { .out = NULL } };
    ss_status st = prepare(&p, c, contour, opts, err);
    if (st == SS_OK)
        st = ss_rows_begin(&to.rows, out, format, SS_KIND_RIDGE, err);
    if (st == SS_OK) {
        ss_rows_notes(&to.rows, c->head, own_notes);
        write_row(NAN, NAN, NAN, &to);
        ss_contour_ridge(&p.map, c, write_row, &to);
        st = ss_rows_finish(&to.rows, err);
    }
    ss_contour_map_free(&p.map);
    return st;
}

ss_status
ss_plot_contour(FILE *out, const ss_coefficients *c, const ss_contour_opts *contour,
                const ss_plot_opts *opts, ss_error *err)
{
    if (out == NULL || c == NULL)
        return SS_FAIL_NULL(err);
    picture p;
    script_span of_signal;
    trace t = { .from = 0 };
    ss_reader *reader = NULL;
    ss_status st = prepare(&p, c, contour, opts, err);
    const ss_signal *signal = st == SS_OK ? p.contour.signal : NULL;
    if (signal != NULL) {                       /* panel (a) shows the time of (b) */
        p.opts.from = p.span.from;
        p.opts.to = p.span.to;
        st = ss_reader_of_signal(&reader, signal, err);
        if (st == SS_OK)
            st = ss_traces_read(&t, &of_signal, reader, &p.contour.column, 1, NAN, &p.opts, err);
    }
    if (st == SS_OK)
        st = ss_script_begin(out, &p.opts, c->head, signal != NULL ? 8.5 : 6.5, NULL, err);
    if (st == SS_OK) {
        write_variables(out, &p.map, &p.contour);
        fputs(around, out);
        if (signal != NULL) {
            ss_trace_write(out, "$signal", &t);
            ss_script_write_tics(out, "ytics", ss_script_scaled_extent(t.y.extent, t.y.scale), 5);
            fputs("set tmargin at screen 0.925; set bmargin at screen 0.72\n"
                  "set label 1 '(a)' at screen 0.01, screen 0.96\nset xtics format ''; ", out);
            ss_script_write_side_label(out, 2, t.y.column, t.y.scale, ROOM);
            fputs(panel_a, out);
        }
        st = write_map(out, &p.map, c, &p.contour);
    }
    if (st == SS_OK)
        st = ss_script_end(out);
    ss_contour_map_free(&p.map);
    ss_traces_free(&t, 1);
    ss_reader_free(reader);
    return st;
}
