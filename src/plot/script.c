/* script.c -- numbers that are the same in every locale, text that gnuplot draws and never runs, and scales
 * of values. */
#include "plot/script.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include "base/error.h"
#include "base/utf8.h"

#define LARGEST 1e300           /* drawn value: differences and powers of ten stay finite */

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

/* gnuplot replaces @name and `command` in a line before it looks for strings, so no character with a meaning may
 * appear in the line at all: letters, digits and signs without a meaning are written as they are, all others as
 * \ooo, which gnuplot decodes after it has found the end of the string.  It reads all octal digits that follow,
 * not only three, so a digit after such a byte is written as \ooo, too. */
int
ss_script_write_bytes(FILE *out, const char *bytes, size_t n, int escaped)
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
void
ss_script_quote(FILE *out, const char *text, int in_lines)
{
    int escaped = 0;
    putc('"', out);
    for (size_t i = 0, n = strlen(text), length; i < n; i += length > 0 ? length : 1) {
        length = ss_utf8_length(text + i);
        if (in_lines && text[i] == '\n') {
            fputs("\\n", out);
            escaped = 0;
        } else if (length == 0) {
            escaped = ss_script_write_bytes(out, "\xef\xbf\xbd", 3, escaped);
        } else {
            const unsigned char *p = (const unsigned char *)text + i;
            int drawable = length == 1 ? p[0] >= 0x20 && p[0] != 0x7f && !(i >= 2 && memcmp(p - 2, "]]>", 3) == 0)
                : length == 2 ? p[0] != 0xc2 || p[1] >= 0xa0
                : length == 3 ? p[0] != 0xef || p[1] != 0xbf || p[2] < 0xbe : 1;
            escaped = ss_script_write_bytes(out, drawable ? text + i : " ", drawable ? length : 1, escaped);
        }
    }
    putc('"', out);
}

ss_status
ss_script_check(const char *column, script_extent e, ss_error *err)
{
    double largest = fmax(fabs(e.lo), fabs(e.hi));
    return largest <= LARGEST && (largest == 0 || largest >= 1 / LARGEST) ? SS_OK
        : ss_fail(err, SS_EINVAL, "%s cannot be drawn: its largest value is %.3g", column, largest);
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

int
ss_script_letters(script_extent e, int intervals)
{
    int decimals;
    double largest = fmax(fabs(e.lo), fabs(e.hi));
    ss_script_step(e.hi - e.lo, intervals, &decimals);
    return 1 + (int)fmax(0, floor(log10(largest))) + (e.lo < 0) + decimals + (decimals > 0);
}

/* The offset is the middle of the values, or somewhat less, rounded to a power of ten above their range: so
 * values from a round number on count from there. */
script_scale
ss_script_scale(script_extent e)
{
    script_scale scale = short_scale(e.lo, e.hi);
    double power = ceil(log10(e.hi - e.lo));
    if (!(e.lo < e.hi) || fabs(power) > 290
        || ss_script_letters(ss_script_scaled_extent(e, scale), TIC_INTERVALS) <= TIC_LETTERS)
        return scale;
    double middle = e.lo + 0.49 * (e.hi - e.lo), unit = pow(10, fabs(power));
    double offset = power > 0 ? round(middle / unit) * unit : round(middle * unit) / unit;
    scale = short_scale(e.lo - offset, e.hi - offset);
    scale.offset = offset;
    return scale;
}
