/* contour_marks.c -- draw events and features over the contours.  Those outside the map are left out. */
#include "plot/contour.h"
#include "plot/style.h"

#include <math.h>
#include "base/error.h"

int
ss_contour_decimals(double f)
{
    return (int)fmax(6, 5 - floor(log10(f)));
}

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
        double from = fmax(overlay->span[i][0], span->from);
        double to = fmin(fmax(overlay->span[i][1], overlay->span[i][0] + shortest), span->to);
        if (!(from <= to))
            continue;
        write_time(out, span, from, " ");
        write_time(out, span, to, "\n");
        n++;
    }
    fputs("EOD\n", out);
    return n;
}

contour_marks
ss_contour_write_marks(FILE *out, const contour_map *map, const ss_contour_opts *contour)
{
    const script_span *span = map->span_of_time;
    const ss_overlay *o = contour->overlay;
    contour_marks n = { 0 };
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
            ss_script_write(out, f, ss_contour_decimals(f), "\n");
            n.maxima++;
        }
    }
    fputs("EOD\n", out);
    return n;
}

/* --- in the plot command ------------------------------------------------------------------- */

void
ss_contour_plot_events(FILE *out, const contour_marks *n)
{
    if (n->events > 0)
        fputs(", \\\n    $events using 1:($2 > 0 ? fmax : fmin) with lines lw 0.5 lc rgb event_colour", out);
}

/* Bars and marks in the rims of the panel; rings in white and colour, visible on any ground. */
void
ss_contour_plot_features(FILE *out, const contour_marks *n)
{
    if (n->spans > 0)
        fputs(", \\\n    $spans using 1:(rim(0.02)):($2-$1):(0) with vectors nohead lw 3 "
              "lc rgb feature_colour", out);
    if (n->spikes > 0)
        fputs(", \\\n    $spikes using 1:(rim(0.98)) with points pt 11 ps 0.6*mark "
              "lc rgb feature_colour", out);
    if (n->maxima > 0)
        fputs(", \\\n    $maxima using 1:2 with points pt 7 ps 0.9*mark lc rgb 'white', \\\n"
              "    $maxima using 1:2 with points pt 7 ps 0.7*mark lc rgb feature_colour, \\\n"
              "    $maxima using 1:2 with points pt 7 ps 0.35*mark lc rgb 'white'", out);
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
