/* script.h -- the common parts of all gnuplot scripts. */
#ifndef SCRIPT_H
#define SCRIPT_H

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stickslip/plot.h>
#include "base/number.h"

#define SCRIPT_COLUMNS 1000     /* pixel columns of a line over time, after thinning */

/* Lines have the colours of Okabe and Ito (2008), which readers with any kind of colour vision tell apart.
 * contour.c has the colours between levels, map.c those of a map's regions and lines. */
#define BLACK "#000000"
#define BLUE "#0072b2"
#define VERMILION "#d55e00"
#define GREEN "#009e73"
#define PURPLE "#cc79a7"
#define ORANGE "#e69f00"
#define SKY_BLUE "#56b4e9"

#define GRID_COLOUR "#dddddd"
#define ZERO_COLOUR "#999999"           /* the line at 0 */

/* Contours: lines from high levels to low ones, and what is drawn over them. */
#define LEVEL_COLOURS "0 '#7ad151', 0.3 '#22a884', 0.55 '#2a788e', 0.8 '#414487', 1 '#440154'"
#define LEVEL_COLOUR "#444444"          /* lines over filled levels */
#define CONE_COLOUR "#e4e4e4"
#define MARK_COLOUR "#cc3311"           /* features and ridges */
#define SHADE_COLOUR "#f2ccc4"          /* transitions over time */

/* Take a caller's options.  SS_EINVAL: they were not initialised, or there are too many signals over one. */
ss_status ss_script_take(ss_plot_opts *own, const ss_plot_opts *opts, ss_error *err);

/* What is drawn of a value: (x - offset)/unit.  offset is 0 unless labels would be long without. */
typedef struct script_scale {
    double offset, unit;        /* unit: 10^exponent */
    int exponent;
} script_scale;

/* The least and the largest value; lo > hi: there is none. */
typedef struct script_extent {
    double lo, hi;
} script_extent;

/* --- page.c: top, panels and end ------------------------------------------------------------ */

/* Begin a picture of this height [cm], a title included: that of opts, or else scene or model of head, unless it
 * is NULL; and under it "lines: " and the label of a column, unless it is NULL.  The script has the variables
 * letters, their size in points, and mark, a factor of the sizes of points; the caller's own follow. */
ss_status ss_script_begin(FILE *out, const ss_plot_opts *opts, const ss_header *head, double height,
                          const ss_column *lines, ss_error *err);
/* SS_EIO if a write failed. */
ss_status ss_script_end(FILE *out);
/* Let all axes that follow begin and end at these parts of the width, with tics, borders and a grid in one
 * style, and no key. */
void ss_script_write_frame(FILE *out, double from, double to);

/* Let the plot that follows have its legend above it, and the title above that.  The top of its stack is to be
 * SCRIPT_LEGEND [cm] lower, in a picture so much higher. */
#define SCRIPT_LEGEND 0.4
void ss_script_write_key(FILE *out);
/* What a signal over another has behind the names of its variables: "", "2", "3", ... */
extern const char *const ss_script_number[SS_PLOT_OVER];
/* The variables colour, over, over2, ... */
void ss_script_write_colours(FILE *out, const ss_plot_opts *opts);
/* The height of the legend of opts->over [cm]; 0: none are drawn. */
double ss_script_legend(const ss_plot_opts *opts);
/* This legend above the panel; the names become the variables name, over_name, over_name2, ...  The columns are
 * those of the signal and of the others. */
void ss_script_write_legend(FILE *out, const ss_plot_opts *opts, const ss_column *const column[]);
/* The same curve again for signal k over it: "$over2 using ..." behind the plot of the first. */
void ss_script_write_over(FILE *out, size_t k, const char *block, int titled);

/* Panels below one another, with one horizontal axis. */
typedef struct script_stack {
    FILE *out;
    double height, top;         /* [cm] of the picture; where the next panel begins */
    size_t n;                   /* panels so far */
} script_stack;
/* Begin a picture whose panels and axis are so high [cm] in all, below a title as above and the legend of
 * opts->over. */
ss_status ss_script_begin_stack(script_stack *stack, FILE *out, const ss_plot_opts *opts,
                                const ss_header *head, double height, ss_error *err);
/* A column along an axis, and what is drawn of it. */
typedef struct script_axis {
    const ss_column *column;
    script_extent extent;
    script_scale scale;
} script_axis;
script_axis ss_script_axis(const ss_column *column, script_extent extent);      /* in the usual scale */
/* Let what follows be drawn in a panel of this height, with a gap below it [cm], over y, whose label has so much
 * room [ems], and which has tics at so many intervals at most; 0: at gnuplot's. */
void ss_script_write_panel(script_stack *stack, double height, double gap, const script_axis *y, double room,
                           int intervals);

/* --- script.c: numbers, text, scales --------------------------------------------------------- */

/* Bytes in a string constant between double quotes; escaped: the last byte was written as \ooo.  Returns
 * whether the last one is now. */
int ss_script_write_bytes(FILE *out, const char *bytes, size_t n, int escaped);
/* Text from outside as a gnuplot string constant that is data and nothing else, see script.c: a control character
 * becomes a blank, but a line end in lines, and an invalid byte U+FFFD. */
void ss_script_quote(FILE *out, const char *text, int in_lines);
/* A number rounded to so many decimals, in any locale, and the text after it. */
void ss_script_write(FILE *out, double x, int decimals, const char *behind);
/* Decimals that distinguish a tenth of a pixel column in a picture of this range. */
int ss_script_decimals(double range);
#define SCRIPT_NO_EXTENT ((script_extent){ INFINITY, -INFINITY })
static inline void
ss_script_include(script_extent *e, double x)
{
    e->lo = x < e->lo ? x : e->lo;          /* no NaN */
    e->hi = x > e->hi ? x : e->hi;
}
static inline void
ss_script_widen(script_extent *e, script_extent other)
{
    *e = (script_extent){ fmin(e->lo, other.lo), fmax(e->hi, other.hi) };
}
script_extent ss_script_extent(const double *x, size_t n);      /* NaNs are left out */
/* SS_EINVAL unless gnuplot can draw values of the column between these: at most 1e300, and not all nearer to 0
 * than 1e-300. */
ss_status ss_script_check(const char *column, script_extent of_values, ss_error *err);

/* The smallest step of 1, 2 or 5 times a power of ten with at most so many intervals in a range; *decimals
 * becomes the number of its decimals. */
double ss_script_step(double range, double intervals, int *decimals);
/* The length of the longest label of such steps over these values. */
int ss_script_letters(script_extent of_values, int intervals);
script_scale ss_script_scale(script_extent of_values);
script_scale ss_script_power(int exponent);     /* without an offset */
double ss_script_scaled(double x, script_scale scale);
script_extent ss_script_scaled_extent(script_extent of_values, script_scale scale);

/* --- axes.c: labels and tics ---------------------------------------------------------------- */

/* The title, broken near its middle and smaller where it is too wide, and under it "lines: " and the label of a
 * column, unless it is NULL. */
void ss_script_write_title(FILE *out, const char *title, const ss_column *lines);
/* Label the horizontal axis with a name and a unit, and what its values are scaled by. */
void ss_script_write_x_label(FILE *out, const ss_column *column, script_scale scale);
/* Label number n beside the vertical axis has so much room [ems]; a longer one has two lines or smaller
 * letters. */
void ss_script_write_side_label(FILE *out, int n, const ss_column *column, script_scale scale, double room);

/* set AXIS STEP: at most so many intervals over the values, of 1, 2 or 5 times a power of ten; where all
 * are the same, one tic at that value. */
void ss_script_write_tics(FILE *out, const char *axis, script_extent drawn, int intervals);
/* Tics of a logarithmic axis at powers of ten, written as such; none are set, so that gnuplot's own stay,
 * where the range has less than two powers or its numbers are short: 0.001 to 100000. */
void ss_script_write_decades(FILE *out, const char *axis, double lo, double hi);
/* Set the vertical range, widened to powers of ten, and its tics as above; nothing if lo > hi. */
void ss_script_write_decade_range(FILE *out, double lo, double hi);

/* The part of a record that is drawn. */
typedef struct script_span {
    double from, to;            /* [s] on the source's clock */
    size_t n;                   /* samples in it, and one more on either side */
} script_span;

/* That of n samples at this rate from start.  SS_EINVAL if the span of opts contains none. */
ss_status ss_script_find_span(script_span *span, double start, double rate, size_t n, const ss_plot_opts *opts,
                              ss_error *err);
/* Write the named variables from, to and tics, the step of time.  Returns the length of a label. */
int ss_script_write_span(FILE *out, const script_span *span);
/* Label the tics of time, in microseconds or nanoseconds where numbers of seconds would be long. */
void ss_script_write_time_labels(FILE *out, const script_span *span);

#endif
