/* label.c -- titles, labels of axes, and tics at powers of ten: names, units and superscripts as text
 * that fits its room in the picture. */
#include "plot/script.h"
#include "signal/header.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DECADES 8               /* powers of ten that stand at an axis, at most */
#define TITLE_ROOM 34.0         /* [ems] */

enum { LABEL_MAX = sizeof ((script_label *)0)->text - sizeof "…" };

static void
add(script_label *l, const char *text)
{
    while (*text != '\0' && l->n < LABEL_MAX)
        l->text[l->n++] = *text++;
    l->text[l->n] = '\0';
}

/* A label that is full ends with a whole character and an ellipsis. */
static void
mark_cut(script_label *l)
{
    if (l->n < LABEL_MAX)
        return;
    while (l->n > 1 && (l->text[l->n - 1] & 0xc0) == 0x80)
        l->n--;
    memcpy(l->text + l->n - 1, "…", sizeof "…");
    l->n += sizeof "…" - 2;
}

static void
add_superscript(script_label *l, int exponent)
{
    static const char *const digit[] = { "⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹" };
    char text[16];
    snprintf(text, sizeof text, "%d", exponent);
    for (const char *c = text; *c != '\0'; c++)
        add(l, *c == '-' ? "⁻" : digit[*c - '0']);
}

/* A unit, its ^2 and ^3 raised. */
static void
add_unit(script_label *l, const char *unit)
{
    for (; *unit != '\0'; unit++) {
        const char part[2] = { *unit, '\0' };
        if (*unit == '^' && (unit[1] == '2' || unit[1] == '3') && !isdigit((unsigned char)unit[2])
            && unit[2] != '.')
            add_superscript(l, *++unit - '0');
        else
            add(l, part);
    }
}

/* The approximate width of text, in ems of a sans serif; non-ASCII characters are superscripts. */
static double
text_width(const char *text, size_t n)
{
    double width = 0;
    for (size_t i = 0; i < n; i++) {
        unsigned byte = (unsigned char)text[i] & 0xc0;
        if (byte == 0xc0)
            width += 0.4;
        else if (byte != 0x80)
            width += strchr("fijlrtI /|.,:;!'()[]-", text[i]) != NULL ? 0.35
                : strchr("mwMW@%", text[i]) != NULL ? 0.95 : 0.6;
    }
    return width;
}

/* The unit of a label, with its power of ten; square brackets go round round ones. */
static void
add_scale(script_label *l, const char *unit, int exponent, int brackets)
{
    int square = strchr(unit, '(') != NULL;
    add(l, !brackets ? "" : square ? "[" : "(");
    if (exponent != 0) {
        add(l, "10");
        add_superscript(l, exponent);
        add(l, unit[0] != '\0' ? " " : "");
    }
    add_unit(l, unit);
    add(l, !brackets ? "" : square ? "]" : ")");
}

/* The length of a column's name without the unit at its end: "slip_mm_s" of mm/s, "accel_g" of g. */
static size_t
name_length(const ss_column *column)
{
    const char *name = column->name, *unit = column->unit;
    size_t n = strlen(name);
    for (size_t i = strlen(unit), at = n; *unit != '\0' && at > 1; at--) {
        while (i > 0 && unit[i - 1] == '^')
            i--;
        if (i == 0)
            return name[at - 1] == '_' ? at - 1 : n;
        if (name[at - 1] != unit[i - 1] && !(name[at - 1] == '_' && strchr("/ *", unit[i - 1]) != NULL))
            break;
        i--;
    }
    if (*unit != '\0')
        ss_unit_of_name(name, &n);              /* that of the file, before another was given */
    return n;
}

/* "name", or "name − offset unit". */
static void
add_quantity(script_label *l, const ss_column *column, double offset)
{
    char number[SS_NUMBER_MAX];
    size_t begin = l->n;
    add(l, column->name);
    if (l->n < LABEL_MAX)
        l->n = begin + name_length(column);
    if (offset == 0)
        return;
    ss_number_format(number, fabs(offset));
    add(l, offset < 0 ? " + " : " − ");
    add(l, number);
    add(l, column->unit[0] != '\0' ? " " : "");
    add_unit(l, column->unit);
}

static void
add_line(script_label *l, const ss_column *column, script_scale scale)
{
    const char *unit = column->unit;
    add(l, scale.offset != 0 ? "(" : "");
    add_quantity(l, column, scale.offset);
    add(l, scale.offset != 0 ? ")" : "");
    if (unit[0] == '\0' && scale.exponent == 0)
        return;
    add(l, " / ");
    add_scale(l, unit, scale.exponent, unit[0] != '\0' && (scale.exponent != 0 || strpbrk(unit, "/ *") != NULL));
}

/* Break the label after the blank or _ nearest to its middle, if it has one. */
static void
break_label(script_label *l)
{
    size_t best = 0;
    for (size_t i = 1; i < l->n; i++)
        if (strchr(" _", l->text[i - 1]) != NULL && labs(2 * (long)i - (long)l->n) < labs(2 * (long)best - (long)l->n))
            best = i;
    l->second = best;
}

/* The room of a label over its width, both of its lines together. */
static double
fit(const script_label *l, double room)
{
    return room / fmax(text_width(l->text, l->second), text_width(l->text + l->second, l->n - l->second));
}

#define SMALL 0.6               /* letters too small to read */
#define TWO_LINES 0.8           /* letters of two lines, which leave tics their room */
#define THREE_LINES 0.7         /* and of a title's three, which have the height of two */

void
ss_script_make_label(script_label *l, const ss_column *column, script_scale scale, double room)
{
    *l = (script_label){ .n = 0 };
    add_line(l, column, scale);
    mark_cut(l);
    script_label two = { .n = 0 };
    add_quantity(&two, column, scale.offset);
    two.second = two.n;
    add_scale(&two, column->unit, scale.exponent, 1);
    mark_cut(&two);
    if (fit(l, room) < 1 && (column->unit[0] != '\0' || scale.exponent != 0) && two.second < LABEL_MAX)
        *l = two;
    if (fit(l, room) < SMALL) {
        two = (script_label){ .n = 0 };
        add_line(&two, column, scale);
        mark_cut(&two);
        break_label(&two);
        *l = fit(&two, room) > fit(l, room) ? two : *l;
    }
    l->font = fmin(fit(l, room), l->second > 0 ? TWO_LINES : 1);
}

static void
write_lines(FILE *out, const script_label *l)
{
    ss_script_write_text(out, l->text, l->second);
    fputs(l->second > 0 ? "\\n" : "", out);
    ss_script_write_text(out, l->text + l->second, l->n - l->second);
}

/* The label as a string constant. */
static void
write_label(FILE *out, const script_label *l)
{
    putc('"', out);
    write_lines(out, l);
    putc('"', out);
}

/* The font of the label, after it; nothing for the usual size. */
static void
write_font(FILE *out, const script_label *l)
{
    if (l->font < 1)
        ss_print(out, " font ','.(exists('font') ? sprintf('%%.1f', %.2f*word(substr(font, 6, 9), 1)) "
                ": '%.1f')", l->font, 10 * l->font);
}

void
ss_script_write_x_label(FILE *out, const script_label *l, const char *offset)
{
    fputs("set xlabel ", out);
    write_label(out, l);
    ss_print(out, " noenhanced offset %s", offset);
    write_font(out, l);
    putc('\n', out);
}

void
ss_script_write_side_label(FILE *out, int n, const script_label *l)
{
    ss_print(out, "set label %d ", n);
    write_label(out, l);
    ss_print(out, " at screen %s,graph 0.5 center rotate noenhanced", l->second > 0 ? "0.0135" : "0.03");
    write_font(out, l);
    putc('\n', out);
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
        script_label l = { .n = 0 };
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

static const char *
title_of(const ss_plot_opts *opts, const ss_header *head)
{
    const char *title = opts->title;
    if (title == NULL && head != NULL)
        title = ss_header_find_note(head, "scene");
    if (title == NULL && head != NULL)
        title = ss_header_find_note(head, "model");
    return title != NULL ? title : "";
}

double
ss_script_title_height(const ss_plot_opts *opts, const ss_header *head)
{
    return title_of(opts, head)[0] != '\0' ? 0.6 : 0.15;
}

void
ss_script_write_title(FILE *out, const ss_plot_opts *opts, const ss_header *head,
                      const script_label *lines)
{
    const char *title = title_of(opts, head);
    script_label l = { .n = 0 };
    add(&l, title);
    mark_cut(&l);
    if (fit(&l, TITLE_ROOM) < 1)
        break_label(&l);
    l.font = fmin(fit(&l, TITLE_ROOM), l.second == 0 ? 1 : lines == NULL ? TWO_LINES : THREE_LINES);
    fputs("set title \"", out);
    write_lines(out, &l);
    if (lines != NULL) {
        fputs(title[0] != '\0' ? "\\nlines: " : "lines: ", out);
        ss_script_write_text(out, lines->text, lines->n);
    }
    fputs("\" noenhanced offset 0,-0.5", out);
    write_font(out, &l);
    putc('\n', out);
}
