/* contour_marks.c -- draw events and features over the contours.  Those outside the map become
 * arrows at its border, one arrow for all of a kind that lie beyond the same place of the border.
 */
#include "plot/contour.h"
#include "plot/style.h"

#include <math.h>
#include "base/error.h"

#define LENGTH 0.022            /* of an arrow, share of the width; */
#define HEIGHT 0.03             /* of the height */
enum { PLACES = 40 };           /* of arrows along a side of the border */

int
ss_contour_decimals(double f)
{
    return (int)fmax(6, 5 - floor(log10(f)));
}

/* The border and its arrows.  Its sides are left, right, bottom and top. */
typedef struct border {
    FILE *out;
    const char *kind;           /* of marks: the name of the datablock, which exists if it has an arrow */
    const script_span *span;
    double fmin, fmax;
    char taken[4][PLACES + 1];
    size_t n;
} border;

static border
new_border(FILE *out, const char *kind, const contour_map *map)
{
    return (border){ .out = out, .kind = kind, .span = map->span_of_time, .fmin = map->f[0],
                     .fmax = map->f[map->rows - 1] };
}

/* Returns the number of arrows. */
static size_t
end_arrows(const border *b)
{
    if (b->n > 0)
        fputs("EOD\n", b->out);
    return b->n;
}

static int
is_inside(const script_span *span, double t)
{
    return t >= span->from && t <= span->to;
}

/* The height of a label in the map, 0 to 1. */
static double
height_of(const border *b, double f)
{
    return log(f / b->fmin) / log(b->fmax / b->fmin);
}

/* Write an arrow at the border for a mark beyond it, at this time and height; nothing for a mark
 * inside. */
static void
point_to(border *b, double t, double height)
{
    double range = b->span->to - b->span->from, at = fmin(fmax((t - b->span->from) / range, 0), 1);
    double dt = t < b->span->from ? -LENGTH : t > b->span->to ? LENGTH : 0;
    double rise = dt != 0 ? 0 : height < 0 ? -HEIGHT : height > 1 ? HEIGHT : 0;
    if (dt == 0 && rise == 0)
        return;
    height = fmin(fmax(height, dt != 0 ? 0.02 : 0), dt != 0 ? 0.98 : 1);
    int side = dt != 0 ? dt > 0 : 2 + (rise > 0);
    char *taken = &b->taken[side][(int)(PLACES * (dt != 0 ? height : at))];
    if (*taken)
        return;
    *taken = 1;
    if (b->n++ == 0)
        ss_print(b->out, "$%s_arrows << EOD\n", b->kind);
    ss_script_write(b->out, b->span->from + (at - dt) * range, ss_script_decimals(range), " ");
    ss_print(b->out, "%.3f ", height - rise);
    ss_script_write(b->out, dt * range, ss_script_decimals(range) + 1, " ");
    ss_print(b->out, "%.3f\n", rise);
}

static size_t
write_events(FILE *out, const contour_map *map, const ss_contour_opts *contour)
{
    const script_span *span = map->span_of_time;
    int decimals = ss_script_decimals(span->to - span->from);
    border b = new_border(out, "event", map);
    fputs("$events << EOD\n", out);
    for (size_t i = 0; i < contour->n_events; i++)
        for (int end = 0; end < 2; end++) {
            ss_script_write(out, contour->event[i], decimals, end == 0 ? " 0\n" : " 1\n\n");
            if (!is_inside(span, contour->event[i]))
                break;                          /* half a line draws nothing */
        }
    fputs("EOD\n", out);
    for (size_t i = 0; i < contour->n_events; i++)
        point_to(&b, contour->event[i], 0.5);
    return end_arrows(&b);
}

size_t
ss_contour_write_spans(FILE *out, const script_span *span, const ss_overlay *overlay)
{
    size_t n = 0;
    int decimals = ss_script_decimals(span->to - span->from);
    fputs("$spans << EOD\n", out);
    for (size_t i = 0; i < overlay->n_spans; i++) {
        double shortest = (span->to - span->from) / CONTOUR_COLUMNS * 2;        /* that is visible */
        double from = fmax(overlay->span[i][0], span->from);
        double to = fmin(fmax(overlay->span[i][1], overlay->span[i][0] + shortest), span->to);
        if (!(from <= to))
            continue;
        ss_script_write(out, from, decimals, " ");
        ss_script_write(out, to, decimals, "\n");
        n++;
    }
    fputs("EOD\n", out);
    return n;
}

/* Write spans, then spikes, and maxima with their frequencies. */
static void
write_features(FILE *out, const contour_map *map, const ss_overlay *overlay, contour_marks *seen)
{
    const script_span *span = map->span_of_time;
    int decimals = ss_script_decimals(span->to - span->from);
    seen->spans = ss_contour_write_spans(out, span, overlay);
    fputs("$spikes << EOD\n", out);
    for (size_t i = 0; i < overlay->n_spikes; i++)
        if (is_inside(span, overlay->spike[i])) {
            ss_script_write(out, overlay->spike[i], decimals, "\n");
            seen->spikes++;
        }
    fputs("EOD\n$maxima << EOD\n", out);
    for (size_t i = 0; i < overlay->n_maxima; i++) {
        double f = overlay->maximum[i][1];
        if (!is_inside(span, overlay->maximum[i][0]) || f < map->f[0] || f > map->f[map->rows - 1])
            continue;
        ss_script_write(out, overlay->maximum[i][0], decimals, " ");
        ss_script_write(out, f, ss_contour_decimals(f), "\n");
        seen->maxima++;
    }
    fputs("EOD\n", out);
}

static size_t
write_feature_arrows(FILE *out, const contour_map *map, const ss_overlay *overlay)
{
    border b = new_border(out, "feature", map);
    for (size_t i = 0; i < overlay->n_maxima; i++)
        point_to(&b, overlay->maximum[i][0], height_of(&b, overlay->maximum[i][1]));
    for (size_t i = 0; i < overlay->n_spikes; i++)
        point_to(&b, overlay->spike[i], 0.98);
    for (size_t i = 0; i < overlay->n_spans; i++) {
        const double *s = overlay->span[i];
        if (s[1] < b.span->from || s[0] > b.span->to)
            point_to(&b, s[0], 0.02);
    }
    return end_arrows(&b);
}

contour_marks
ss_contour_write_marks(FILE *out, const contour_map *map, const ss_contour_opts *contour)
{
    static const char rim[] = "rim(part) = fmin*(fmax/fmin)**part\n";
    contour_marks seen = { 0 };
    if (contour->n_events > 0)
        seen.event_arrows = write_events(out, map, contour);
    if (contour->overlay == NULL) {
        fputs(seen.event_arrows > 0 ? rim : "", out);
        return seen;
    }
    ss_print(out, "feature_colour = '" MARK_COLOUR "'; %s", rim);
    write_features(out, map, contour->overlay, &seen);
    seen.feature_arrows = write_feature_arrows(out, map, contour->overlay);
    return seen;
}

/* --- in the plot command ------------------------------------------------------------------- */

static void
plot_arrows(FILE *out, const char *kind)
{
    ss_print(out, ", \\\n    $%s_arrows using 1:(rim($2)):3:(rim($2+$4)-rim($2)) with vectors head filled "
            "size screen 0.012,20 lw 1 lc rgb %s_colour", kind, kind);
}

void
ss_contour_plot_events(FILE *out, const contour_marks *marks, size_t n_events)
{
    if (n_events > 0)
        fputs(", \\\n    $events using 1:($2 > 0 ? fmax : fmin) with lines lw 0.5 "
              "lc rgb event_colour", out);
    if (marks->event_arrows > 0)
        plot_arrows(out, "event");
}

/* Bars and marks in the rims of the panel; rings in white and colour, visible on any ground. */
void
ss_contour_plot_features(FILE *out, const contour_marks *seen)
{
    if (seen->spans > 0)
        fputs(", \\\n    $spans using 1:(rim(0.02)):($2-$1):(0) with vectors nohead lw 3 "
              "lc rgb feature_colour", out);
    if (seen->spikes > 0)
        fputs(", \\\n    $spikes using 1:(rim(0.98)) with points pt 11 ps 0.6*mark "
              "lc rgb feature_colour", out);
    if (seen->maxima > 0)
        fputs(", \\\n    $maxima using 1:2 with points pt 7 ps 0.9*mark lc rgb 'white', \\\n"
              "    $maxima using 1:2 with points pt 7 ps 0.7*mark lc rgb feature_colour, \\\n"
              "    $maxima using 1:2 with points pt 7 ps 0.35*mark lc rgb 'white'", out);
    if (seen->feature_arrows > 0)
        plot_arrows(out, "feature");
}

/* --- arguments ----------------------------------------------------------------------------- */

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

ss_status
ss_contour_check_overlay(const ss_overlay *overlay, ss_error *err)
{
    const char *what = overlay != NULL ? find_unplaced(overlay) : NULL;
    return what == NULL ? SS_OK : ss_fail(err, SS_EINVAL, "a time or frequency of a %s is not finite", what);
}

ss_status
ss_contour_check_marks(const ss_contour_opts *contour, ss_error *err)
{
    for (size_t i = 0; i < contour->n_events; i++)
        if (!isfinite(contour->event[i]))
            return ss_fail(err, SS_EINVAL, "a time or frequency of an event is not finite");
    return ss_contour_check_overlay(contour->overlay, err);
}
