/* script.h -- what all gnuplot scripts have in common. */
#ifndef SCRIPT_H
#define SCRIPT_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/plot.h>

#define SCRIPT_COLUMNS 1000     /* pixel columns that a line over time is thinned to */

/* The part of a record that is drawn. */
typedef struct script_span {
    double from, to;            /* [s] on the source's clock */
    size_t first, n;            /* samples in it, and one more on either side */
} script_span;

/* SS_EINVAL if nothing lies in the span asked for. */
ss_status ss_script_find_span(script_span *span, const ss_header *head, size_t n,
                              const ss_plot_opts *opts, ss_error *err);

/* Top of the script: terminal, size, title and what the caller's own variables follow. */
ss_status ss_script_begin(FILE *out, const ss_plot_opts *opts, const ss_header *head, double height,
                          ss_error *err);
/* The named variables from and to, in the lines at the top. */
void ss_script_put_span(FILE *out, const script_span *span);
/* Lines of script: tics of time at 1, 2 or 5 times a power of ten, with labels that tell them apart,
 * six intervals at most and as many as have room for these, also when from and to are changed.
 * letters is the length of a label. */
#define SCRIPT_TIME_TICS \
    "tic(share) = share < 1.001 ? 1 : share < 2.001 ? 2 : share < 5.001 ? 5 : 10\n" \
    "every(n) = (part = (to > from ? to - from : 1)/n, decade = 10**floor(log10(part)), " \
    "decade*tic(part/decade))\n" \
    "wide(t) = strlen(sprintf('%.12g', t)); last = every(6.0)*floor(to/every(6.0))\n" \
    "letters = wide(last) > wide(last - every(6.0)) ? wide(last) : wide(last - every(6.0))\n" \
    "set xtics every(letters < 5 ? 6.0 : letters < 33 ? 34.0/(letters + 1) : 1.0)\n"
#define SCRIPT_TIME_LABELS \
    "set xtics format '%.12g'; set xlabel 'time / s' noenhanced offset 0,0.5\n"

/* Text from outside as a gnuplot string constant that does nothing but stand there. */
void ss_script_quote(FILE *out, const char *text);
/* A number rounded to so many decimals, whatever the locale, and what stands behind it. */
void ss_script_put(FILE *out, double x, int decimals, const char *behind);
/* Decimals that tell apart a tenth of a pixel column in a picture of this range. */
int ss_script_decimals(double range);

/* The power of ten, a multiple of 3, that brings the n values to numbers short to read. */
int ss_script_exponent(const double *x, size_t n);
/* "name / (10^-3 unit)" as a string constant, in two lines if it is wider than the room [ems]; what
 * part of the usual size its letters may then have. */
double ss_script_put_label(FILE *out, const ss_column *column, int exponent, double room);
/* Where the label of a vertical axis stands in the script, its name from the caller: further out
 * in two lines, that tics have their room. */
#define SCRIPT_AT(label) "at screen strstrt(" label ", \"\\n\") ? 0.018 : 0.03,graph 0.5 center " \
    "rotate noenhanced"
/* The font of a text, behind it: letters of part <= 1 of the usual size; nothing for 1. */
void ss_script_put_font(FILE *out, double part);

/* set AXIS STEP: so many intervals at most over the range, of 1, 2 or 5 times a power of ten. */
void ss_script_put_tics(FILE *out, const char *axis, double range, int intervals);

/* A datablock of time and x 10^-exponent: the smallest and largest of each pixel column, so that
 * no spike is lost.  span as found; x points at the whole record.  The range of what was put. */
double ss_script_put_trace(FILE *out, const char *name, const double *x, const ss_header *head,
                      const script_span *span, int exponent);

/* SS_EIO if a write failed. */
ss_status ss_script_end(FILE *out);

#endif
