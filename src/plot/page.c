/* page.c -- the page of a picture: terminal and size, title, and panels below one another.
 *
 * A picture on paper is 8.5 cm wide, as a journal's column is, with letters of 6 points. */
#include "plot/script.h"

#include <math.h>
#include <string.h>
#include "base/error.h"
#include "base/options.h"
#include "signal/header.h"

#define WIDTH 8.5               /* [cm] */
#define PIXELS_PER_CM 118.11    /* 300 dots per inch */
#define TITLE 0.6               /* height of a title [cm] */
#define NO_TITLE 0.15           /* and without one */
#define SCREEN 1.5              /* how much wider and higher on a screen */

static const ss_plot_opts defaults = { .from = NAN, .to = NAN, .style = SS_PAPER };

SS_OPTIONS(ss_plot_opts, defaults)

ss_status
ss_script_take(ss_plot_opts *own, const ss_plot_opts *opts, ss_error *err)
{
    ss_status st = ss_options_take(own, sizeof *own, &defaults, opts, err);
    return st != SS_OK || own->n_over <= SS_PLOT_OVER ? st
        : ss_fail(err, SS_EINVAL, "one picture has at most %d signals, not %zu", SS_PLOT_OVER + 1,
                  own->n_over + 1);
}

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

/* The scene or the model of a signal, or "". */
static const char *
origin_of(const ss_header *head)
{
    const char *scene = ss_header_find_note(head, "scene"), *model = ss_header_find_note(head, "model");
    return scene != NULL ? scene : model != NULL ? model : "";
}

/* Several signals alike have the title that they share. */
static const char *
title_of(const ss_plot_opts *opts, const ss_header *head)
{
    const char *title = opts->title != NULL ? opts->title : head != NULL ? origin_of(head) : "";
    for (size_t k = 0; opts->title == NULL && opts->alike && k < opts->n_over; k++)
        if (strcmp(title, origin_of(ss_reader_header(opts->over[k]))) != 0)
            return "";
    return title;
}

ss_status
ss_script_begin(FILE *out, const ss_plot_opts *opts, const ss_header *head, double height,
                const ss_column *lines, ss_error *err)
{
    const char *name = opts->format, *dot;
    if (name == NULL && opts->output != NULL && (dot = strrchr(opts->output, '.')) != NULL)
        name = dot + 1;
    const struct format *f = NULL;
    for (size_t i = 0; name != NULL && i < sizeof formats / sizeof *formats; i++)
        if (strcmp(name, formats[i].name) == 0)
            f = &formats[i];
    if ((name != NULL || opts->output != NULL) && f == NULL)
        return ss_fail(err, SS_EINVAL, "a picture is png, svg or pdf, not '%s'",
                       name != NULL ? name : opts->output);
    double scale = opts->style == SS_SCREEN ? SCREEN : 1;
    const double size[2] = { scale * WIDTH, scale * height };
    fputs("# Made by libstickslip " SS_VERSION " for gnuplot 5.2 or later: gnuplot -p FILE\n", out);
    if (f == NULL)
        ss_print(out, "# set terminal pdfcairo size %gcm,%gcm font 'Sans,6' fontscale 1 "
                 "linewidth 0.5; set output 'figure.pdf'\nletters = 10\n", size[0], size[1]);
    for (int i = 0; f != NULL && i < 2; i++) {
        int in_cm = f->unit[0] != '\0';
        fputs(i == 0 ? "width = " : "height = ", out);
        ss_script_write(out, in_cm ? size[i] : round(size[i] * f->per_cm), 3, in_cm ? "        # cm\n" : "\n");
    }
    if (f != NULL)
        ss_print(out, "letters = %d\nfont = sprintf('Sans,%%g', letters)\n"
                 "set terminal %s noenhanced size width%s,height%s font font linewidth %s\n", f->letters,
                 f->terminal, f->unit, f->unit, f->lines);
    if (f != NULL && opts->output != NULL) {
        /* At the start of a name gnuplot runs a program for '|' and replaces '~'. */
        ss_print(out, "set output \"%s", strchr("|~<>", opts->output[0]) != NULL ? "./" : "");
        ss_script_write_bytes(out, opts->output, strlen(opts->output), 0);
        fputs("\"\n", out);
    }
    ss_print(out, "set encoding utf8; set termoption noenhanced\nmark = %s\n", f != NULL ? f->mark : "1");
    ss_script_write_title(out, title_of(opts, head), lines);
    return SS_OK;
}

ss_status
ss_script_end(FILE *out)
{
    fputs("unset multiplot; unset output\n", out);
    return ferror(out) || fflush(out) != 0 ? SS_EIO : SS_OK;
}

void
ss_script_write_frame(FILE *out, double from, double to)
{
    ss_print(out, "set lmargin at screen %.5g; set rmargin at screen %.5g\n", from, to);
    fputs("set tics nomirror out scale 0.6; set border lw 0.8; unset key\n"
          "set grid xtics lc rgb '" GRID_COLOUR "' lt 1\n", out);
}

void
ss_script_write_key(FILE *out)
{
    fputs("set title offset 0,0.7; "
          "set key at graph 1, graph 1 bottom right horizontal samplen 1.5 noenhanced\n", out);
}

const char *const ss_script_number[] = { "", "2", "3", "4", "5", "6" };

void
ss_script_write_colours(FILE *out, const ss_plot_opts *opts)
{
    static const char *const colour[SS_PLOT_OVER] = { VERMILION, GREEN, PURPLE, ORANGE, SKY_BLUE, BLACK };
    fputs("colour = '" BLUE "'\n", out);
    for (size_t k = 0; k < opts->n_over; k++)
        ss_print(out, "over%s = '%s'\n", ss_script_number[k], colour[k]);
}

/* The entries of the legend in a row: gnuplot takes letters to be 0.172 cm wide, in a .png, and a sample as 4. */
static size_t
entries(const ss_plot_opts *opts)
{
    size_t longest = 0, all = (size_t)(0.79 * WIDTH / 0.172);
    for (size_t k = 0; opts->name != NULL && k <= opts->n_over; k++)
        longest = strlen(opts->name[k]) > longest ? strlen(opts->name[k]) : longest;
    return longest + 4 < all ? all / (longest + 4) : 1;
}

double
ss_script_legend(const ss_plot_opts *opts)
{
    return opts->n_over > 0 ? SCRIPT_LEGEND * (double)((opts->n_over + entries(opts)) / entries(opts)) : 0;
}

void
ss_script_write_legend(FILE *out, const ss_plot_opts *opts, const ss_column *const column[])
{
    ss_script_write_key(out);
    ss_print(out, "set title offset 0,%.3g; set key maxcols %zu\n", 0.7 + 0.9 * (ss_script_legend(opts)
             / SCRIPT_LEGEND - 1), entries(opts));
    for (size_t k = 0; k <= opts->n_over; k++) {
        ss_print(out, "%s%s = ", k == 0 ? "name" : "; over_name", k == 0 ? "" : ss_script_number[k - 1]);
        ss_script_quote(out, opts->name != NULL ? opts->name[k] : column[k]->name, 0);
    }
    putc('\n', out);
}

void
ss_script_write_over(FILE *out, size_t k, const char *block, int titled)
{
    const char *number = ss_script_number[k];
    ss_print(out, ", %s with lines lw 1 lc rgb over%s", block, number);
    if (titled)
        ss_print(out, " title over_name%s", number);
}

ss_status
ss_script_begin_stack(script_stack *stack, FILE *out, const ss_plot_opts *opts, const ss_header *head,
                      double height, ss_error *err)
{
    double above = title_of(opts, head)[0] != '\0' ? TITLE : NO_TITLE;
    *stack = (script_stack){ out, ss_script_legend(opts) + height + above, height, 0 };
    return ss_script_begin(out, opts, head, stack->height, NULL, err);
}

script_axis
ss_script_axis(const ss_column *column, script_extent extent)
{
    return (script_axis){ column, extent, ss_script_scale(extent) };
}

void
ss_script_write_panel(script_stack *s, double height, double gap, const script_axis *y, double room, int intervals)
{
    fputs(s->n++ == 0 ? "set multiplot\n" : "unset title; unset label 1\n", s->out);
    ss_print(s->out, "set tmargin at screen %.5f; set bmargin at screen %.5f\n", s->top / s->height,
             (s->top - height) / s->height);
    ss_script_write_side_label(s->out, 1, y->column, y->scale, room);
    if (intervals > 0)
        ss_script_write_tics(s->out, "ytics", ss_script_scaled_extent(y->extent, y->scale), intervals);
    s->top -= height + gap;
}
