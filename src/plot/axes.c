/* axes.c -- titles, labels of axes, and tics: names, units and superscripts as text that fits its room in the
 * picture; and the part of a record over time that is drawn, with its tics. */
#include "plot/script.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"

#define DECADES 8               /* powers of ten that stand at an axis, at most */
#define TITLE_ROOM 26.0         /* [ems]; a title stands over the panels, which leave more room on the left */
#define X_ROOM 30.0             /* of a label below the horizontal axis */
#define SMALL 0.6               /* letters too small to read */
#define TWO_LINES 0.8           /* letters of two lines, which leave tics their room */
#define THREE_LINES 0.7         /* and of a title's three, which have the height of two */

/* A label in one or two lines. */
typedef struct label {
    char text[256];
    double font;                /* size of its letters, <= 1, over the usual size */
} label;
enum { LABEL_MAX = sizeof ((label *)0)->text - sizeof "…" };

/* Append to the text, which is full when it has LABEL_MAX bytes. */
static void
add(label *l, const char *format, ...)
{
    size_t n = strlen(l->text);
    va_list list;
    va_start(list, format);
    vsnprintf(l->text + n, LABEL_MAX + 1 - n, format, list);
    va_end(list);
}

static int
is_full(const label *l)
{
    return strlen(l->text) == LABEL_MAX;
}

/* A text that is full ends with a whole character and an ellipsis. */
static void
mark_cut(label *l)
{
    size_t n = strlen(l->text);
    if (!is_full(l))
        return;
    while (n > 1 && (l->text[n - 1] & 0xc0) == 0x80)
        n--;
    memcpy(l->text + n - 1, "…", sizeof "…");
}

static void
add_superscript(label *l, int exponent)
{
    static const char *const digit[] = { "⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹" };
    char text[16];
    snprintf(text, sizeof text, "%d", exponent);
    for (const char *c = text; *c != '\0'; c++)
        add(l, "%s", *c == '-' ? "⁻" : digit[*c - '0']);
}

/* A text without line ends of its own, its ^2 and ^3 raised if it is a unit. */
static void
add_text(label *l, const char *text, int is_unit)
{
    for (; *text != '\0' && !is_full(l); text++)
        if (is_unit && *text == '^' && (text[1] == '2' || text[1] == '3') && !isdigit((unsigned char)text[2])
            && text[2] != '.')
            add_superscript(l, *++text - '0');
        else
            add(l, "%c", *text == '\n' ? ' ' : *text);
}

/* The approximate width of the wider line, in ems; what is not ASCII is a minus or a superscript. */
static double
width_of(const char *text)
{
    double widest = 0, width = 0;
    for (; *text != '\0'; text++) {
        unsigned byte = (unsigned char)*text & 0xc0;
        if (*text == '\n')
            width = 0;
        else if (byte == 0xc0)
            width += strncmp(text, "−", strlen("−")) == 0 ? 0.8 : 0.4;
        else if (byte != 0x80)
            width += strchr("fijlrtI /|.,:;!'()[]-", *text) != NULL ? 0.35
                : strchr("mwMW@%", *text) != NULL ? 0.95 : 0.6;
        widest = fmax(widest, width);
    }
    return widest;
}

/* Break the text behind the blank or _ nearest to its middle, if it has one. */
static void
break_text(label *l)
{
    long best = 0, n = (long)strlen(l->text);
    for (long i = 1; i < n; i++)
        if (strchr(" _", l->text[i - 1]) != NULL && labs(2 * i - n) < labs(2 * best - n))
            best = i;
    if (best == 0 || n + 2 > (long)sizeof l->text)
        return;
    memmove(l->text + best + 1, l->text + best, (size_t)(n - best) + 1);
    l->text[best] = '\n';
}

/* "name / (10^-3 unit)", or "(name − offset unit) / (10^-3 unit)"; if it is wider than its room, two lines, "name"
 * and "(10^-3 unit)", or broken near its middle, in smaller letters; cut where it is longer than any picture. */
static label
make_label(const ss_column *column, script_scale scale, double room)
{
    label name = { .text = "" }, unit = name;
    char number[SS_NUMBER_MAX];
    size_t n = strlen(column->name);
    const char *blank = column->unit[0] != '\0' ? " " : "";
    add_text(&name, column->name, 0);
    if (column->unit[0] != '\0' && !is_full(&name)) {   /* a unit at the end of the name is not written twice */
        ss_unit_of_name(column->name, &n);
        name.text[n] = '\0';
    }
    if (scale.offset != 0) {
        ss_number_format(number, fabs(scale.offset));
        add(&name, "%s%s%s", scale.offset < 0 ? " + " : " − ", number, blank);
        add_text(&name, column->unit, 1);
    }
    if (scale.exponent != 0) {
        add(&unit, "10");
        add_superscript(&unit, scale.exponent);
        add(&unit, "%s", blank);
    }
    add_text(&unit, column->unit, 1);
    int is_square = strchr(column->unit, '(') != NULL;          /* brackets go round round ones */
    const char *open = is_square ? "[" : "(", *close = is_square ? "]" : ")";
    int is_sole = column->unit[0] == '\0' || (scale.exponent == 0 && strpbrk(column->unit, "/ *") == NULL);
    label l = { .text = "" }, two = l, broken;
    add(&l, scale.offset != 0 ? "(%s)" : "%s", name.text);
    if (unit.text[0] != '\0')
        add(&l, " / %s%s%s", is_sole ? "" : open, unit.text, is_sole ? "" : close);
    mark_cut(&l);
    broken = l;
    if (width_of(l.text) > room && unit.text[0] != '\0' && !is_full(&name)) {
        add(&two, "%s\n%s%s%s", name.text, open, unit.text, close);
        mark_cut(&two);
        l = two;
    }
    break_text(&broken);
    if (width_of(l.text) * SMALL > room && width_of(broken.text) < width_of(l.text))
        l = broken;
    l.font = fmin(room / width_of(l.text), strchr(l.text, '\n') != NULL ? TWO_LINES : 1);
    return l;
}

/* Write the label as a string, and behind it what is between, and its size. */
static void
write_label(FILE *out, const label *l, const char *between)
{
    ss_script_quote(out, l->text, 1);
    ss_print(out, "%s", between);
    if (l->font < 1)
        ss_print(out, " font sprintf(',%%.1f', %.2f*letters)", l->font);
    putc('\n', out);
}

void
ss_script_write_x_label(FILE *out, const ss_column *column, script_scale scale)
{
    const label l = make_label(column, scale, X_ROOM);
    fputs("set xlabel ", out);
    write_label(out, &l, " noenhanced offset 0,0.4");
}

void
ss_script_write_side_label(FILE *out, int n, const ss_column *column, script_scale scale, double room)
{
    const label l = make_label(column, scale, room);
    ss_print(out, "set label %d ", n);
    write_label(out, &l, strchr(l.text, '\n') != NULL ? " at screen 0.0135,graph 0.5 center rotate noenhanced"
                : " at screen 0.03,graph 0.5 center rotate noenhanced");
}

void
ss_script_write_title(FILE *out, const char *title, const ss_column *lines)
{
    label l = { .text = "" }, all = l;
    const label of_lines = lines != NULL ? make_label(lines, ss_script_power(0), INFINITY) : l;
    add_text(&l, title, 0);
    mark_cut(&l);
    double width = width_of(l.text);
    if (width > TITLE_ROOM)
        break_text(&l);
    int is_broken = strchr(l.text, '\n') != NULL;
    all.font = fmin(TITLE_ROOM / width_of(l.text), !is_broken ? 1 : lines == NULL ? TWO_LINES : THREE_LINES);
    add(&all, "%s%s%s%s", l.text, lines != NULL && l.text[0] != '\0' ? "\n" : "", lines != NULL ? "lines: " : "",
        of_lines.text);
    mark_cut(&all);
    fputs("set title ", out);
    write_label(out, &all, " noenhanced offset 0,-0.5");
}

void
ss_script_write_tics(FILE *out, const char *axis, script_extent drawn, int intervals)
{
    int decimals = ss_script_decimals(0), same = !(drawn.lo < drawn.hi);
    double step = same ? 0 : ss_script_step(drawn.hi - drawn.lo, intervals, &decimals);
    ss_print(out, "set %s %s", axis, same ? "(" : "");
    ss_script_write(out, same ? drawn.lo : step, decimals, same ? ")\n" : "\n");
}

void
ss_script_write_decades(FILE *out, const char *axis, double lo, double hi)
{
    int first = (int)ceil(log10(lo) - 1e-9), last = (int)floor(log10(hi) + 1e-9);
    int every = 1 + (last - first) / DECADES;
    if (last <= first || (lo >= 1e-3 && hi <= 1e5))
        return;
    ss_print(out, "set %stics (", axis);
    for (int i = first - 1; i <= last; i++) {
        label l = { .text = "" };
        if (i % every == 0) {
            add(&l, "10");
            add_superscript(&l, i);
        }
        ss_print(out, "'%s' 1e%d", l.text, i);
        for (int j = 2; j < 10 && every == 1; j++)
            ss_print(out, ", '' %de%d 1", j, i);
        fputs(i < last ? ", " : ")\n", out);
    }
}

void
ss_script_write_decade_range(FILE *out, double lo, double hi)
{
    if (lo > hi)
        return;
    int first = (int)floor(log10(lo)), last = (int)floor(log10(hi)) + 1;
    ss_print(out, "set yrange [1e%d:1e%d]; set ytics autofreq\n", first, last);
    ss_script_write_decades(out, "y", pow(10, first), pow(10, last));
}

#define LATEST 1e300            /* time: differences stay finite */

ss_status
ss_script_find_span(script_span *span, double start, double rate, size_t n, const ss_plot_opts *opts,
                    ss_error *err)
{
    double end = start + (double)n / rate;
    double from = isnan(opts->from) ? start : opts->from, to = isnan(opts->to) ? end : opts->to;
    double lo = floor((from - start) * rate), hi = ceil((to - start) * rate);
    if (!(fmax(fabs(from), fabs(to)) <= LATEST))
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

#define TIME_INTERVALS 6.0           /* at most, */
#define TIME_LETTERS 34.0            /* and so many that their labels have this many letters, with blanks */

#define LONGEST_TIME 8               /* letters of a label; if it had more, it has the time from a round one on */

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
    double range = span->to - span->from, step = ss_script_step(range, TIME_INTERVALS, decimals);
    double whole = fmax(1, pow(10, ceil(log10(range))));
    *offset = 0;
    *letters = letters_up_to(span->to, step);
    if (*letters > LONGEST_TIME && fabs(span->from) > whole) {
        *offset = floor(span->from / whole) * whole;
        *letters = letters_up_to(span->to - *offset, step);
    }
    return ss_script_step(range, fmin(TIME_INTERVALS, fmax(1, TIME_LETTERS / (*letters + 1))), decimals);
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
