/* script.c -- the parts that all gnuplot scripts have: terminal and size, numbers that are the same in
 * every locale, text that gnuplot draws and never runs, and lines with no more points than the picture
 * has columns of pixels.
 *
 * A picture on paper is 8.5 cm wide, as a journal's column is, with letters of 6 points. */
#include "plot/script.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/options.h"
#include "base/utf8.h"
#include "signal/gaps.h"

#define WIDTH 8.5               /* [cm] */
#define PIXELS_PER_CM 118.11    /* 300 dots per inch */
#define SCREEN 1.5              /* how much wider and higher on a screen */
#define LARGEST 1e300           /* drawn value: differences and powers of ten stay finite */

static const ss_plot_opts defaults = { .from = NAN, .to = NAN, .style = SS_PAPER, .over_start = NAN };

void
ss_plot_opts_init(ss_plot_opts *opts, size_t size)
{
    ss_options_init(opts, size, &defaults, sizeof defaults);
}

ss_status
ss_script_take(ss_plot_opts *own, const ss_plot_opts *opts, ss_error *err)
{
    return ss_options_take(own, sizeof *own, &defaults, opts, err);
}

/* --- numbers and text ---------------------------------------------------------------------- */

void
ss_script_write(FILE *out, double x, int decimals, const char *behind)
{
    char text[SS_NUMBER_MAX];
    double unit = pow(10, decimals < 0 ? -decimals : decimals);
    if (decimals > 0 && fabs(x) < 1e15 / unit)
        x = round(x * unit) / unit;     /* the double next to that decimal: it prints short */
    else if (decimals < 0)
        x = round(x / unit) * unit;
    ss_number_format(text, x + 0.0);    /* and no -0 */
    fputs(text, out);
    fputs(behind, out);
}

int
ss_script_decimals(double range)
{
    if (!(range > 0))
        return 6;
    return (int)fmax(0, fmin(305, ceil(-log10(range / SCRIPT_COLUMNS)) + 1));
}

/* Bytes in a string constant between double quotes.  gnuplot replaces @name and `command` in a line
 * before it looks for strings, so no character with a meaning may appear in the line at all: letters,
 * digits and signs without a meaning are written as they are, all others as \ooo, which gnuplot
 * decodes after it has found the end of the string.  It reads all octal digits that follow, not only
 * three, so a digit after such a byte is written as \ooo, too.  Returns 1 if the last byte was. */
static int
write_bytes(FILE *out, const char *bytes, size_t n, int escaped)
{
    static const char plain[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                " ()+,-./:=_";
    for (size_t i = 0; i < n; i++) {
        int is_plain = memchr(plain, bytes[i], sizeof plain - 1) != NULL;
        escaped = !is_plain || (escaped && isdigit((unsigned char)bytes[i]));
        if (escaped)
            ss_print(out, "\\%03o", (unsigned char)bytes[i]);
        else
            putc(bytes[i], out);
    }
    return escaped;
}

/* XML, and so SVG, has no control characters and no U+FFFE and U+FFFF (XML 1.0, production Char), and
 * gnuplot writes the > of "]]>" as it is, which no text of XML may have (production CharData). */
static int
is_drawable(const char *text, size_t at, size_t n)
{
    const unsigned char *p = (const unsigned char *)text + at;
    if (n == 1)
        return p[0] >= 0x20 && p[0] != 0x7f && !(at >= 2 && memcmp(p - 2, "]]>", 3) == 0);
    return n == 2 ? p[0] != 0xc2 || p[1] >= 0xa0
        : n == 3 ? p[0] != 0xef || p[1] != 0xbf || p[2] < 0xbe : 1;
}

/* Text between double quotes: a control character becomes a blank, an invalid byte U+FFFD. */
void
ss_script_write_text(FILE *out, const char *text, size_t n)
{
    int escaped = 0;
    for (size_t i = 0, length; i < n; i += length > 0 ? length : 1) {
        length = ss_utf8_length(text + i);
        if (length == 0)
            escaped = write_bytes(out, "\xef\xbf\xbd", 3, escaped);
        else if (is_drawable(text, i, length))
            escaped = write_bytes(out, text + i, length, escaped);
        else
            escaped = write_bytes(out, " ", 1, escaped);
    }
}

void
ss_script_quote(FILE *out, const char *text)
{
    putc('"', out);
    ss_script_write_text(out, text, strlen(text));
    putc('"', out);
}

ss_status
ss_script_check(const char *column, const double *x, size_t n, ss_error *err)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i]))
            return ss_fail(err, SS_EINVAL, "%s cannot be drawn: a value is not finite", column);
        largest = fmax(largest, fabs(x[i]));
    }
    if (largest > LARGEST || (largest > 0 && largest < 1 / LARGEST))
        return ss_fail(err, SS_EINVAL, "%s cannot be drawn: its largest value is %.3g", column,
                       largest);
    return SS_OK;
}

int
ss_script_exponent(const double *x, size_t n)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, fabs(x[i]));
    if (largest == 0 || (largest >= 0.1 && largest < 10000))
        return 0;
    return 3 * (int)floor((log10(largest) + 1) / 3);
}

double
ss_script_step(double range, int intervals, int *decimals)
{
    double power = pow(10, floor(log10(range / intervals))), share = range / intervals / power;
    *decimals = power < 1 ? (int)round(-log10(power)) : 0;
    return (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10) * power;
}

void
ss_script_write_tics(FILE *out, const char *axis, script_extent drawn, int intervals)
{
    int decimals = ss_script_decimals(0), same = !(drawn.lo < drawn.hi);
    double step = same ? 0 : ss_script_step(drawn.hi - drawn.lo, intervals, &decimals);
    ss_print(out, "set %s %s", axis, same ? "(" : "");
    ss_script_write(out, same ? drawn.lo : step, decimals, same ? ")\n" : "\n");
}

#define TIC_LETTERS 5           /* of a tic's label, which the margin has room for */
#define TIC_INTERVALS 5

script_extent
ss_script_extent(const double *x, size_t n)
{
    script_extent e = SCRIPT_NO_EXTENT;
    for (size_t i = 0; i < n; i++)
        ss_script_include(&e, x[i]);
    return e;
}

double
ss_script_scaled(double x, script_scale scale)
{
    return (x - scale.offset) / scale.unit;
}

script_scale
ss_script_power(int exponent)
{
    return (script_scale){ 0, pow(10, exponent), exponent };
}

void
ss_script_widen(script_extent *drawn, script_extent of_values, script_scale scale)
{
    drawn->lo = fmin(drawn->lo, ss_script_scaled(of_values.lo, scale));
    drawn->hi = fmax(drawn->hi, ss_script_scaled(of_values.hi, scale));
}

/* Are labels of values from lo to hi longer than TIC_LETTERS? */
static int
is_long(double lo, double hi)
{
    int decimals;
    double largest = fmax(fabs(lo), fabs(hi));
    ss_script_step(hi - lo, TIC_INTERVALS, &decimals);
    return 1 + (int)fmax(0, floor(log10(largest))) + (lo < 0) + decimals + (decimals > 0) > TIC_LETTERS;
}

/* The offset is the middle of the values, or somewhat less, rounded to a power of ten above their range: so
 * values from a round number on count from there. */
script_scale
ss_script_scale(script_extent e)
{
    script_scale scale = ss_script_power(ss_script_exponent((double[]){ e.lo, e.hi }, 2));
    double power = ceil(log10(e.hi - e.lo));
    if (!(e.lo < e.hi) || fabs(power) > 290 || !is_long(ss_script_scaled(e.lo, scale), ss_script_scaled(e.hi, scale)))
        return scale;
    double middle = e.lo + 0.49 * (e.hi - e.lo), unit = pow(10, fabs(power));
    double offset = power > 0 ? round(middle / unit) * unit : round(middle * unit) / unit;
    scale = ss_script_power(ss_script_exponent((double[]){ e.lo - offset, e.hi - offset }, 2));
    scale.offset = offset;
    return scale;
}

/* --- top and end --------------------------------------------------------------------------- */

/* gnuplot's points do not grow with the resolution of a picture as letters do. */
static const char *
size_of_marks(const char *format)
{
    return format == NULL ? "1" : strcmp(format, "png") == 0 ? "2.4" : "0.8";
}

/* The terminal of a format, or NULL. */
static const char *
terminal(const char *format)
{
    static const char *const name[][2] = {
        { "png", "pngcairo" }, { "svg", "svg" }, { "pdf", "pdfcairo" }, { "eps", "epscairo" } };
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (strcmp(format, name[i][0]) == 0)
            return name[i][1];
    return NULL;
}

static void
write_terminal(FILE *out, const char *format, const char *output, double width, double height)
{
    int print = strcmp(format, "pdf") == 0 || strcmp(format, "eps") == 0;
    double per_cm = print ? 1 : PIXELS_PER_CM;
    const char *unit = print ? " cm" : "";
    fputs("width = ", out);
    ss_script_write(out, print ? width : round(width * per_cm), 3, print ? "        # cm\n" : "\n");
    fputs("height = ", out);
    ss_script_write(out, print ? height : round(height * per_cm), 3, print ? "        # cm\n" : "\n");
    ss_print(out, "font = 'Sans,%s'\n", print ? "6" : strcmp(format, "svg") == 0 ? "31" : "24");
    ss_print(out, "set terminal %s noenhanced size width%s,height%s font font linewidth %s%s\n",
            terminal(format), unit, unit, print ? "0.6" : "2",
            print ? " fontscale 1" : strcmp(format, "svg") == 0 ? " background 'white'" : "");
    if (output != NULL) {
        /* At the start of a name gnuplot runs a program for '|' and replaces '~'. */
        ss_print(out, "set output \"%s", strchr("|~<>", output[0]) != NULL ? "./" : "");
        write_bytes(out, output, strlen(output), 0);
        fputs("\"\n", out);
    }
}

ss_status
ss_script_begin(FILE *out, const ss_plot_opts *opts, double height, ss_error *err)
{
    const char *format = opts->format, *dot;
    if (format == NULL && opts->output != NULL && (dot = strrchr(opts->output, '.')) != NULL)
        format = dot + 1;
    if ((format != NULL || opts->output != NULL) && (format == NULL || terminal(format) == NULL))
        return ss_fail(err, SS_EINVAL, "a picture is png, svg or pdf, not '%s'",
                       format != NULL ? format : opts->output);
    double scale = opts->style == SS_SCREEN ? SCREEN : 1;
    fputs("# Made by libstickslip " SS_VERSION " for gnuplot 5.2 or later: gnuplot -p FILE\n", out);
    if (format != NULL)
        write_terminal(out, format, opts->output, scale * WIDTH, scale * height);
    else
        ss_print(out, "# set terminal pdfcairo size %gcm,%gcm font 'Sans,6' fontscale 1 "
                "linewidth 0.5; set output 'figure.pdf'\n", scale * WIDTH, scale * height);
    ss_print(out, "set encoding utf8; set termoption noenhanced\nmark = %s\n", size_of_marks(format));
    return SS_OK;
}

void
ss_script_write_span(FILE *out, const script_span *span)
{
    int decimals = ss_script_decimals(span->to - span->from);
    fputs("from = ", out);
    ss_script_write(out, span->from, decimals, "         # s\n");
    fputs("to = ", out);
    ss_script_write(out, span->to, decimals, "           # s\n");
}

ss_status
ss_script_end(FILE *out)
{
    fputs("unset output\n", out);
    return ferror(out) || fflush(out) != 0 ? SS_EIO : SS_OK;
}

/* --- time ---------------------------------------------------------------------------------- */

ss_status
ss_script_find_span(script_span *span, const ss_header *head, size_t n, const ss_plot_opts *opts,
                    ss_error *err)
{
    double end = head->start + (double)n / head->rate, rate = head->rate;
    span->from = isnan(opts->from) ? head->start : opts->from;
    span->to = isnan(opts->to) ? end : opts->to;
    double lo = floor((span->from - head->start) * rate), hi = ceil((span->to - head->start) * rate);
    if (!(fmax(fabs(span->from), fabs(span->to)) <= LARGEST))
        return ss_fail(err, SS_EINVAL, "time from %g s to %g s cannot be drawn", span->from, span->to);
    if (!(span->from < span->to) || !(hi >= 0 && lo < (double)n)) {
        char text[4][SS_NUMBER_MAX];
        const double t[4] = { span->from, span->to, head->start, end };
        for (int i = 0; i < 4; i++)
            ss_number_format(text[i], t[i]);
        return ss_fail(err, SS_EINVAL, "nothing to draw from %s s to %s s; the record goes from "
                       "%s s to %s s", text[0], text[1], text[2], text[3]);
    }
    span->first = lo > 0 ? (size_t)lo : 0;
    span->n = (hi < (double)n ? (size_t)hi + 1 : n) - span->first;
    return SS_OK;
}

ss_status
ss_script_make_clock(script_clock *clock, const ss_header *head, const script_span *span, ss_error *err)
{
    size_t i = span->first;
    *clock = (script_clock){ .start = head->start, .rate = head->rate };
    if (ss_header_gaps(&clock->gap, &clock->n_gaps, head, NULL) != SS_OK)
        return ss_fail_memory(err, NULL);
    while (i < span->first + span->n && ss_script_is_missing(clock, i))
        i++;
    if (i < span->first + span->n)
        return SS_OK;
    free(clock->gap);
    clock->gap = NULL;
    return ss_fail(err, SS_EINVAL, "nothing to draw: all samples from %.9g s to %.9g s are missing", span->from,
                   span->to);
}

/* A quarter of an interval after the sample: times of gaps are rounded. */
int
ss_script_is_missing(const script_clock *clock, size_t i)
{
    double t = clock->start + ((double)i + 0.25) / clock->rate;
    return clock->n_gaps > 0 && ss_gaps_near(clock->gap, clock->n_gaps, t, 0);
}

script_extent
ss_script_span_extent(const double *x, const script_clock *clock, const script_span *span)
{
    script_extent e = SCRIPT_NO_EXTENT;
    for (size_t i = span->first; i < span->first + span->n; i++)
        if (!ss_script_is_missing(clock, i))
            ss_script_include(&e, x[i]);
    return e;
}

/* A trace while it is written. */
typedef struct trace {
    FILE *out;
    const double *x;
    const script_clock *clock;
    script_scale scale;
    int decimals[2];
    int broken;                 /* the last line written is empty */
} trace;

static void
write_sample(trace *t, size_t i)
{
    t->broken = 0;
    ss_script_write(t->out, t->clock->start + (double)i / t->clock->rate, t->decimals[0], " ");
    ss_script_write(t->out, ss_script_scaled(t->x[i], t->scale), t->decimals[1], "\n");
}

/* The smallest and the largest of the samples from i to before end, in their order; an empty line if
 * all are missing. */
static void
write_column(trace *t, size_t i, size_t end)
{
    while (i < end && ss_script_is_missing(t->clock, i))
        i++;
    size_t min = i, max = i;
    if (i == end && !t->broken) {
        putc('\n', t->out);
        t->broken = 1;
    }
    for (; i < end; i++) {
        if (ss_script_is_missing(t->clock, i))
            continue;
        min = t->x[i] < t->x[min] ? i : min;
        max = t->x[i] > t->x[max] ? i : max;
    }
    if (min < end)
        write_sample(t, min < max ? min : max);
    if (min != max)
        write_sample(t, min < max ? max : min);
}

void
ss_script_write_trace(FILE *out, const char *name, const double *x, const script_clock *clock,
                      const script_span *span, script_scale scale, script_extent *drawn)
{
    trace t = { .out = out, .x = x, .clock = clock, .scale = scale };
    script_extent e = ss_script_span_extent(x, clock, span);
    ss_script_widen(drawn, e, scale);
    t.decimals[0] = ss_script_decimals(span->to - span->from);
    t.decimals[1] = ss_script_decimals((e.hi - e.lo) / scale.unit);
    size_t columns = span->n > 2 * SCRIPT_COLUMNS ? SCRIPT_COLUMNS : span->n;
    ss_print(out, "%s << EOD\n", name);
    for (size_t c = 0, i = span->first; c < columns; c++) {
        size_t end = span->first + (size_t)((double)span->n * (double)(c + 1) / (double)columns);
        write_column(&t, i, end);
        i = end;
    }
    fputs("EOD\n", out);
}
