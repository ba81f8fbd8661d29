/* time.c -- a record over time: the part that is drawn, and its tics. */
#include "plot/script.h"

#include <math.h>
#include "base/error.h"

#define LARGEST 1e300           /* time: differences stay finite */

ss_status
ss_script_find_span(script_span *span, double start, double rate, size_t n, const ss_plot_opts *opts,
                    ss_error *err)
{
    double end = start + (double)n / rate;
    double from = isnan(opts->from) ? start : opts->from, to = isnan(opts->to) ? end : opts->to;
    double lo = floor((from - start) * rate), hi = ceil((to - start) * rate);
    if (!(fmax(fabs(from), fabs(to)) <= LARGEST))
        return ss_fail(err, SS_EINVAL, "time from %g s to %g s cannot be drawn", from, to);
    if (!(from < to) || !(hi >= 0 && lo < (double)n)) {
        char text[4][SS_NUMBER_MAX];
        const double t[4] = { from, to, start, end };
        for (int i = 0; i < 4; i++)
            ss_number_format(text[i], t[i]);
        return ss_fail(err, SS_EINVAL, "nothing to draw from %s s to %s s; the record goes from "
                       "%s s to %s s", text[0], text[1], text[2], text[3]);
    }
    *span = (script_span){ from, to, (size_t)(fmin(hi + 1, (double)n) - fmax(lo, 0)) };
    return SS_OK;
}

#define INTERVALS 6.0           /* at most, */
#define LETTERS 34.0            /* and so many that their labels have this many letters, blanks between them */

#define LONGEST 8               /* letters of a label; if it had more, it has the time from a round one on */

/* The letters of the longest of the last two labels up to a time. */
static int
letters_up_to(double t, double step)
{
    const double last = floor(t / step);
    return (int)fmax(snprintf(NULL, 0, "%.12g", step * (last - 1)), snprintf(NULL, 0, "%.12g", step * last));
}

/* The step of tics, with labels that differ; *letters becomes the length of the longest, *offset, a multiple of
 * the step, what is subtracted from them. */
static double
find_step(const script_span *span, int *letters, int *decimals, double *offset)
{
    double range = span->to - span->from, step = ss_script_step(range, INTERVALS, decimals);
    double whole = fmax(1, pow(10, ceil(log10(range))));
    *offset = 0;
    *letters = letters_up_to(span->to, step);
    if (*letters > LONGEST && fabs(span->from) > whole) {
        *offset = floor(span->from / whole) * whole;
        *letters = letters_up_to(span->to - *offset, step);
    }
    return ss_script_step(range, fmin(INTERVALS, fmax(1, LETTERS / (*letters + 1))), decimals);
}

int
ss_script_write_span(FILE *out, const script_span *span)
{
    int letters, step_decimals, decimals = ss_script_decimals(span->to - span->from);
    double offset, step = find_step(span, &letters, &step_decimals, &offset);
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
    double offset, step = find_step(span, &letters, &decimals, &offset);
    double far = fmax(fabs(span->from), fabs(span->to)), unit = far < 1e-6 ? 1e-9 : far < 1e-3 ? 1e-6 : 1;
    int named = unit < 1 || offset != 0;
    fputs("set xtics format '%.12g'\n", out);
    for (double k = ceil(span->from / step), first = k; named && k * step <= span->to; k++)
        ss_print(out, "set xtics %s('%.12g' %.15g)\n", k == first ? "" : "add ",
                 nearbyint(k - offset / step) * step / unit, k * step);
    if (offset != 0)
        ss_print(out, "set xlabel '(time − %.15g s) / s' noenhanced offset 0,0.5\n", offset);
    else
        ss_print(out, "set xlabel 'time / %s' noenhanced offset 0,0.5\n",
                 unit < 1e-6 ? "ns" : unit < 1 ? "µs" : "s");
}
