/* time.c -- a record over time: the part that is drawn, its gaps, its tics, and lines with no more points
 * than the picture has columns of pixels. */
#include "plot/script.h"

#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "signal/gaps.h"

#define LARGEST 1e300           /* time: differences stay finite */

ss_status
ss_script_find_span(script_span *span, const ss_header *head, size_t n, const ss_plot_opts *opts,
                    ss_error *err)
{
    double end = head->start + (double)n / head->rate, rate = head->rate;
    double from = isnan(opts->from) ? head->start : opts->from, to = isnan(opts->to) ? end : opts->to;
    double lo = floor((from - head->start) * rate), hi = ceil((to - head->start) * rate);
    if (!(fmax(fabs(from), fabs(to)) <= LARGEST))
        return ss_fail(err, SS_EINVAL, "time from %g s to %g s cannot be drawn", from, to);
    if (!(from < to) || !(hi >= 0 && lo < (double)n)) {
        char text[4][SS_NUMBER_MAX];
        const double t[4] = { from, to, head->start, end };
        for (int i = 0; i < 4; i++)
            ss_number_format(text[i], t[i]);
        return ss_fail(err, SS_EINVAL, "nothing to draw from %s s to %s s; the record goes from "
                       "%s s to %s s", text[0], text[1], text[2], text[3]);
    }
    *span = (script_span){ .from = from, .to = to, .start = head->start, .rate = rate };
    span->first = lo > 0 ? (size_t)lo : 0;
    span->n = (hi < (double)n ? (size_t)hi + 1 : n) - span->first;
    return SS_OK;
}

ss_status
ss_script_find_gaps(script_span *span, const ss_header *head, ss_error *err)
{
    size_t i = span->first, end = span->first + span->n;
    ss_status st = ss_header_gaps(&span->gap, &span->n_gaps, head, err);
    while (st == SS_OK && i < end && ss_script_is_missing(span, i))
        i++;
    return st != SS_OK || i < end ? st
        : ss_fail(err, SS_EINVAL, "nothing to draw: all samples from %.9g s to %.9g s are missing", span->from,
                  span->to);
}

/* A quarter of an interval after the sample: times of gaps are rounded. */
int
ss_script_is_missing(const script_span *span, size_t i)
{
    double t = span->start + ((double)i + 0.25) / span->rate;
    return span->n_gaps > 0 && ss_gaps_near(span->gap, span->n_gaps, t, 0);
}

script_extent
ss_script_span_extent(const double *x, const script_span *span)
{
    script_extent e = SCRIPT_NO_EXTENT;
    for (size_t i = span->first; i < span->first + span->n; i++)
        if (!ss_script_is_missing(span, i))
            ss_script_include(&e, x[i]);
    return e;
}

/* --- tics ----------------------------------------------------------------------------------- */

#define INTERVALS 6.0           /* at most, */
#define LETTERS 34.0            /* and so many that their labels have this many letters, blanks between them */

/* The step of tics, with labels that differ; *letters becomes the length of the longest. */
static double
find_step(const script_span *span, int *letters, int *decimals)
{
    double range = span->to - span->from, step = ss_script_step(range, INTERVALS, decimals);
    *letters = 0;
    for (int k = -1; k <= 0; k++)
        *letters = (int)fmax(*letters, snprintf(NULL, 0, "%.12g", step * (floor(span->to / step) + k)));
    return ss_script_step(range, fmin(INTERVALS, fmax(1, LETTERS / (*letters + 1))), decimals);
}

int
ss_script_write_span(FILE *out, const script_span *span)
{
    int letters, step_decimals, decimals = ss_script_decimals(span->to - span->from);
    double step = find_step(span, &letters, &step_decimals);
    fputs("from = ", out);
    ss_script_write(out, span->from, decimals, "         # s\n");
    fputs("to = ", out);
    ss_script_write(out, span->to, decimals, "           # s\n");
    fputs("tics = ", out);
    ss_script_write(out, step, step_decimals, "           # s between two\n");
    return letters;
}

void
ss_script_write_time_labels(FILE *out, const script_span *span)
{
    int letters, decimals;
    double far = fmax(fabs(span->from), fabs(span->to)), step = find_step(span, &letters, &decimals);
    double unit = far < 1e-6 ? 1e-9 : far < 1e-3 ? 1e-6 : 1;
    fputs("set xtics format '%.12g'\n", out);
    for (double k = ceil(span->from / step), first = k; unit < 1 && k * step <= span->to; k++)
        ss_print(out, "set xtics %s('%.12g' %.12g)\n", k == first ? "" : "add ", k * step / unit, k * step);
    ss_print(out, "set xlabel 'time / %s' noenhanced offset 0,0.5\n", unit < 1e-6 ? "ns" : unit < 1 ? "µs" : "s");
}

/* --- lines ---------------------------------------------------------------------------------- */

script_extent
ss_script_write_trace(FILE *out, const char *name, const double *x, const script_span *span, script_scale scale)
{
    script_extent e = ss_script_scaled_extent(ss_script_span_extent(x, span), scale);
    int decimals[2] = { ss_script_decimals(span->to - span->from), ss_script_decimals(e.hi - e.lo) };
    size_t columns = span->n > 2 * SCRIPT_COLUMNS ? SCRIPT_COLUMNS : span->n;
    int breaks = 1;                             /* is a line to end that has begun? */
    ss_print(out, "%s << EOD\n", name);
    for (size_t c = 0, i = span->first; c < columns; c++) {
        size_t end = span->first + (size_t)((double)span->n * (double)(c + 1) / (double)columns);
        size_t low = end, high = end;           /* end: all are missing */
        for (; i < end; i++) {
            if (ss_script_is_missing(span, i))
                continue;
            low = low == end || x[i] < x[low] ? i : low;
            high = high == end || x[i] > x[high] ? i : high;
        }
        if (low == end && breaks)
            putc('\n', out);
        breaks = low < end;
        const size_t sample[2] = { low < high ? low : high, low < high ? high : low };
        for (size_t k = 0; k < (low == end ? 0u : low == high ? 1u : 2u); k++) {
            ss_script_write(out, span->start + (double)sample[k] / span->rate, decimals[0], " ");
            ss_script_write(out, ss_script_scaled(x[sample[k]], scale), decimals[1], "\n");
        }
    }
    fputs("EOD\n", out);
    return e;
}
