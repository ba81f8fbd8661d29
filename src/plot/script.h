/* script.h -- the common parts of all gnuplot scripts. */
#ifndef SCRIPT_H
#define SCRIPT_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/plot.h>
#include "base/number.h"

#define SCRIPT_COLUMNS 1000     /* pixel columns of a line over time, after thinning */

/* Take a caller's options.  SS_EINVAL: they were not initialised. */
ss_status ss_script_take(ss_plot_opts *own, const ss_plot_opts *opts, ss_error *err);

/* The part of a record that is drawn. */
typedef struct script_span {
    double from, to;            /* [s] on the source's clock */
    size_t first, n;            /* samples in it, and one more on either side */
} script_span;

/* SS_EINVAL if the span of opts contains no sample. */
ss_status ss_script_find_span(script_span *span, const ss_header *head, size_t n,
                              const ss_plot_opts *opts, ss_error *err);

/* SS_EINVAL unless gnuplot can draw these n values of the column: they are finite, at most 1e300, and
 * not all nearer to 0 than 1e-300. */
ss_status ss_script_check(const char *column, const double *x, size_t n, ss_error *err);

/* Top of the script: terminal and size, and the variable mark, a factor of the sizes of points; the title
 * and the caller's own variables follow. */
ss_status ss_script_begin(FILE *out, const ss_plot_opts *opts, double height, ss_error *err);
/* The named variables from and to, in the lines at the top. */
void ss_script_write_span(FILE *out, const script_span *span);
/* Lines of script: tics of time at 1, 2 or 5 times a power of ten, with labels that differ, at most six
 * intervals and as many as have room for the labels, also after from and to are changed.  letters is
 * the length of a label. */
#define SCRIPT_TIME_TICS \
    "tic(share) = share < 1.001 ? 1 : share < 2.001 ? 2 : share < 5.001 ? 5 : 10\n" \
    "every(n) = (part = (to > from ? to - from : 1)/n, decade = 10**floor(log10(part)), " \
    "decade*tic(part/decade))\n" \
    "wide(t) = strlen(sprintf('%.12g', t)); last = every(6.0)*floor(to/every(6.0))\n" \
    "letters = wide(last) > wide(last - every(6.0)) ? wide(last) : wide(last - every(6.0))\n" \
    "tics = every(letters < 5 ? 6.0 : letters < 33 ? 34.0/(letters + 1) : 1.0); set xtics tics\n"
/* And their labels, in microseconds or nanoseconds where those of seconds would be long. */
#define SCRIPT_TIME_LABELS \
    "far = abs(from) > abs(to) ? abs(from) : abs(to); unit = far < 1e-6 ? 1e-9 : far < 1e-3 ? 1e-6 : 1\n" \
    "set xtics format '%.12g'\n" \
    "if (unit < 1) { set xtics ('0' 0); do for [i=ceil(from/tics):floor(to/tics)] { " \
    "set xtics add (sprintf('%.12g', i*tics/unit) i*tics) } }\n" \
    "set xlabel 'time / '.(unit < 1e-6 ? 'ns' : unit < 1 ? 'µs' : 's') noenhanced offset 0,0.5\n"

/* Text from outside as a gnuplot string constant that is data and nothing else, see script.c. */
void ss_script_quote(FILE *out, const char *text);
/* The n bytes of text as they stand between the quotes of such a constant. */
void ss_script_write_text(FILE *out, const char *text, size_t n);
/* A number rounded to so many decimals, in any locale, and the text after it. */
void ss_script_write(FILE *out, double x, int decimals, const char *behind);
/* Decimals that distinguish a tenth of a pixel column in a picture of this range. */
int ss_script_decimals(double range);

/* The least and the largest value; lo > hi: there is none. */
typedef struct script_extent {
    double lo, hi;
} script_extent;
#define SCRIPT_NO_EXTENT ((script_extent){ INFINITY, -INFINITY })
static inline void
ss_script_include(script_extent *e, double x)
{
    e->lo = x < e->lo ? x : e->lo;          /* no NaN */
    e->hi = x > e->hi ? x : e->hi;
}
/* The power of ten, a multiple of 3, by which the n values are divided to be short to read. */
int ss_script_exponent(const double *x, size_t n);
/* What is drawn of a value: (x - offset)/unit.  offset is 0 unless labels would be long without. */
typedef struct script_scale {
    double offset, unit;        /* unit: 10^exponent */
    int exponent;
} script_scale;
script_scale ss_script_scale(script_extent of_values);
script_scale ss_script_power(int exponent);     /* without an offset */
double ss_script_scaled(double x, script_scale scale);
/* *drawn shall hold these values, scaled, too. */
void ss_script_widen(script_extent *drawn, script_extent of_values, script_scale scale);
/* "name / (10^-3 unit)", or "(name − offset unit) / (10^-3 unit)"; if it is wider than its room in two
 * lines, "name" and "(10^-3 unit)", or broken near its middle, and in smaller letters; cut where it is
 * longer than any picture. */
typedef struct script_label {
    char text[256];
    size_t n;                   /* bytes of it */
    size_t second;              /* where its second line begins; 0: one line */
    double font;                /* size of its letters, <= 1, over the usual size */
} script_label;
void ss_script_make_label(script_label *label, const ss_column *column, script_scale scale,
                          double room);     /* [ems] */
/* Set the title: that of opts, or else scene or model of the header, unless it is NULL; and under it
 * "lines: " and the label, unless it is NULL.  A title too wide is broken near its middle and smaller. */
void ss_script_write_title(FILE *out, const ss_plot_opts *opts, const ss_header *head,
                           const script_label *lines);
/* The height above panels [cm], with room for that title if there is one. */
double ss_script_title_height(const ss_plot_opts *opts, const ss_header *head);
/* Set the label of the horizontal axis, so far below it: "0,0.3". */
void ss_script_write_x_label(FILE *out, const script_label *label, const char *offset);
/* Set label number n beside the vertical axis; two lines are further out, to leave room for tics. */
void ss_script_write_side_label(FILE *out, int n, const script_label *label);

script_extent ss_script_extent(const double *x, size_t n);      /* NaNs are left out */
/* The smallest step of 1, 2 or 5 times a power of ten with at most so many intervals in a range; *decimals
 * becomes the number of its decimals. */
double ss_script_step(double range, int intervals, int *decimals);
/* set AXIS STEP: at most so many intervals over the values, of 1, 2 or 5 times a power of ten; where all
 * are the same, one tic at that value. */
void ss_script_write_tics(FILE *out, const char *axis, script_extent drawn, int intervals);

/* Tics of a logarithmic axis at powers of ten, written as such; none are set, so that gnuplot's own stay,
 * where the range has less than two powers or its numbers are short: 0.001 to 100000. */
void ss_script_write_decades(FILE *out, const char *axis, double lo, double hi);
/* Set the vertical range, widened to powers of ten, and its tics as above; nothing if lo > hi. */
void ss_script_write_decade_range(FILE *out, double lo, double hi);

/* The times of a record.  Missing samples are not drawn, and a line breaks there. */
typedef struct script_clock {
    double start, rate;
    ss_span *gap;               /* to be freed */
    size_t n_gaps;
} script_clock;
/* SS_EINVAL, and nothing to be freed, if all samples of the span are missing. */
ss_status ss_script_make_clock(script_clock *clock, const ss_header *head, const script_span *span, ss_error *err);
int ss_script_is_missing(const script_clock *clock, size_t i);
/* Of the span, as it is found; x points at the whole record. */
script_extent ss_script_span_extent(const double *x, const script_clock *clock, const script_span *span);

/* A datablock of time and scaled x: the smallest and largest of each pixel column, so that no spike is
 * lost.  span as found; x points at the whole record.  *drawn is widened to the values. */
void ss_script_write_trace(FILE *out, const char *name, const double *x, const script_clock *clock,
                           const script_span *span, script_scale scale, script_extent *drawn);

/* SS_EIO if a write failed. */
ss_status ss_script_end(FILE *out);

#endif
