/* script.c -- the parts that all gnuplot scripts have: terminal and size, numbers that are the same in
 * every locale, and text that gnuplot draws and never runs.
 *
 * A picture on paper is 8.5 cm wide, as a journal's column is, with letters of 6 points. */
#include "plot/script.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include "base/error.h"
#include "base/options.h"
#include "base/utf8.h"

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
static void
quote(FILE *out, const char *text, int in_lines)
{
    int escaped = 0;
    putc('"', out);
    for (size_t i = 0, n = strlen(text), length; i < n; i += length > 0 ? length : 1) {
        length = ss_utf8_length(text + i);
        if (in_lines && text[i] == '\n') {
            fputs("\\n", out);
            escaped = 0;
        } else if (length == 0) {
            escaped = write_bytes(out, "\xef\xbf\xbd", 3, escaped);
        } else {
            int drawable = is_drawable(text, i, length);
            escaped = write_bytes(out, drawable ? text + i : " ", drawable ? length : 1, escaped);
        }
    }
    putc('"', out);
}

void
ss_script_quote(FILE *out, const char *text)
{
    quote(out, text, 0);
}

void
ss_script_quote_lines(FILE *out, const char *text)
{
    quote(out, text, 1);
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

script_extent
ss_script_scaled_extent(script_extent e, script_scale scale)
{
    return (script_extent){ ss_script_scaled(e.lo, scale), ss_script_scaled(e.hi, scale) };
}

double
ss_script_step(double range, double intervals, int *decimals)
{
    double power = pow(10, floor(log10(range / intervals))), share = range / intervals / power;
    *decimals = power < 1 ? (int)round(-log10(power)) : 0;
    return (share <= 1.001 ? 1 : share <= 2.001 ? 2 : share <= 5.001 ? 5 : 10) * power;
}

script_scale
ss_script_power(int exponent)
{
    return (script_scale){ 0, pow(10, exponent), exponent };
}

/* The power of ten, a multiple of 3, by which values are divided to be short to read. */
static script_scale
short_scale(double lo, double hi)
{
    double largest = fmax(fabs(lo), fabs(hi));
    if (!(largest > 0) || isinf(largest) || (largest >= 0.1 && largest < 10000))
        return ss_script_power(0);
    return ss_script_power(3 * (int)floor((log10(largest) + 1) / 3));
}

#define TIC_LETTERS 5           /* of a tic's label, which the margin has room for */
#define TIC_INTERVALS 5

/* Are labels of values from lo to hi longer than TIC_LETTERS? */
static int
is_long(script_extent e)
{
    int decimals;
    double largest = fmax(fabs(e.lo), fabs(e.hi));
    ss_script_step(e.hi - e.lo, TIC_INTERVALS, &decimals);
    return 1 + (int)fmax(0, floor(log10(largest))) + (e.lo < 0) + decimals + (decimals > 0) > TIC_LETTERS;
}

/* The offset is the middle of the values, or somewhat less, rounded to a power of ten above their range: so
 * values from a round number on count from there. */
script_scale
ss_script_scale(script_extent e)
{
    script_scale scale = short_scale(e.lo, e.hi);
    double power = ceil(log10(e.hi - e.lo));
    if (!(e.lo < e.hi) || fabs(power) > 290 || !is_long(ss_script_scaled_extent(e, scale)))
        return scale;
    double middle = e.lo + 0.49 * (e.hi - e.lo), unit = pow(10, fabs(power));
    double offset = power > 0 ? round(middle / unit) * unit : round(middle * unit) / unit;
    scale = short_scale(e.lo - offset, e.hi - offset);
    scale.offset = offset;
    return scale;
}

/* --- top and end --------------------------------------------------------------------------- */

/* What each format has: gnuplot's points do not grow with the resolution of a picture as letters do. */
static const struct format {
    const char *name, *terminal;
    double per_cm;              /* of the unit of its size */
    const char *unit;
    int letters;                /* [points] */
    const char *lines;          /* and other options of the terminal */
    const char *mark;
} formats[] = {
    { "png", "pngcairo", PIXELS_PER_CM, "", 24, "2", "2.4" },
    { "svg", "svg", PIXELS_PER_CM, "", 31, "2 background 'white'", "0.8" },
    { "pdf", "pdfcairo", 1, " cm", 6, "0.6 fontscale 1", "0.8" },
    { "eps", "epscairo", 1, " cm", 6, "0.6 fontscale 1", "0.8" },
};

static const struct format *
find_format(const char *name)
{
    for (size_t i = 0; name != NULL && i < sizeof formats / sizeof *formats; i++)
        if (strcmp(name, formats[i].name) == 0)
            return &formats[i];
    return NULL;
}

static void
write_terminal(FILE *out, const struct format *f, const char *output, double width, double height)
{
    const double size[2] = { width * f->per_cm, height * f->per_cm };
    int in_cm = f->unit[0] != '\0';
    for (int i = 0; i < 2; i++) {
        fputs(i == 0 ? "width = " : "height = ", out);
        ss_script_write(out, in_cm ? size[i] : round(size[i]), 3, in_cm ? "        # cm\n" : "\n");
    }
    ss_print(out, "letters = %d\nfont = sprintf('Sans,%%g', letters)\n", f->letters);
    ss_print(out, "set terminal %s noenhanced size width%s,height%s font font linewidth %s\n", f->terminal,
             f->unit, f->unit, f->lines);
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
    const char *name = opts->format, *dot;
    if (name == NULL && opts->output != NULL && (dot = strrchr(opts->output, '.')) != NULL)
        name = dot + 1;
    const struct format *format = find_format(name);
    if ((name != NULL || opts->output != NULL) && format == NULL)
        return ss_fail(err, SS_EINVAL, "a picture is png, svg or pdf, not '%s'",
                       name != NULL ? name : opts->output);
    double scale = opts->style == SS_SCREEN ? SCREEN : 1;
    fputs("# Made by libstickslip " SS_VERSION " for gnuplot 5.2 or later: gnuplot -p FILE\n", out);
    if (format != NULL)
        write_terminal(out, format, opts->output, scale * WIDTH, scale * height);
    else
        ss_print(out, "# set terminal pdfcairo size %gcm,%gcm font 'Sans,6' fontscale 1 "
                "linewidth 0.5; set output 'figure.pdf'\nletters = 10\n", scale * WIDTH, scale * height);
    ss_print(out, "set encoding utf8; set termoption noenhanced\nmark = %s\n",
             format != NULL ? format->mark : "1");
    return SS_OK;
}

void
ss_script_write_margins(FILE *out, double bottom, double top, double height)
{
    ss_print(out, "set bmargin at screen %.5f; set tmargin at screen %.5f\n", bottom / height, top / height);
}

ss_status
ss_script_end(FILE *out)
{
    fputs("unset output\n", out);
    return ferror(out) || fflush(out) != 0 ? SS_EIO : SS_OK;
}
