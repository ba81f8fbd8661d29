/* stickslip/plot.h -- gnuplot scripts of pictures.
 *
 * A script contains its data and begins with named variables.  It sets a terminal only if opts name
 * one.  Text from files is escaped, so that gnuplot draws it and never runs it. */
#ifndef STICKSLIP_PLOT_H
#define STICKSLIP_PLOT_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/backbone.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>
#include <stickslip/morlet.h>
#include <stickslip/overlay.h>
#include <stickslip/rank.h>
#include <stickslip/steps.h>
#include <stickslip/table.h>
#include <stickslip/trade.h>

SS_BEGIN_DECLARATIONS

typedef enum ss_plot_style {
    SS_PAPER,                   /* 8.5 cm wide, a journal's column, with letters of 6 points */
    SS_SCREEN                   /* 1.5 times as wide and high, with letters of the same size */
} ss_plot_style;

enum { SS_PLOT_OVER = 6 };

typedef struct ss_plot_opts {
    size_t size;                /* set by ss_plot_opts_init */
    const char *output;         /* the file of the picture, .png, .svg or .pdf; NULL: the script draws
                                   on the terminal that gnuplot has */
    const char *format;         /* "png", "svg", "pdf"; NULL: that of output's ending */
    const char *title;          /* NULL: made from the notes (scene, model); "": no title */
    double from, to;            /* [s] on the source's clock, the span to draw; NaN: all of it */
    ss_plot_style style;
    ss_reader *const *over;     /* n_over other signals, at most SS_PLOT_OVER, for ss_plot_signal, ss_plot_xy and
                                   ss_plot_spectrum, drawn as if they began with the first */
    size_t n_over;
    const char *const *name;    /* of all n_over + 1 in a legend; NULL: those of the first columns drawn */
    int alike;                  /* 1: the others' columns are drawn over those of their names; 0, or if they have
                                   no such column: their first column over the first panel */
    int difference;             /* 1: ss_plot_signal draws the first column less those over it in a panel below,
                                   by lines between their samples; the readers can go back */
    const ss_overlay *features; /* ss_plot_signal shades its transitions in every panel; NULL: none */
    double resolution;          /* [Hz] of spectra, as for ss_spectrum_new; 0: that of seven segments */
    int decibels;               /* 1: spectra are in dB re 1 unit^2/Hz; a density of 0 is then "-" in text */
    const double *curve;        /* a map of ss_plot_sweep has this line: x, y, x, y, ..., NaN where it breaks;
                                   NULL: none */
    size_t n_curve;             /* its points */
} ss_plot_opts;
/* All that may be NULL is, times are NaN, the style is SS_PAPER.  Where a function takes options, NULL stands
 * for these. */
void ss_plot_opts_init(ss_plot_opts *opts, size_t size);

/* Draw the n columns of these indices over time, one panel each (figure 1); with n = 0 all columns.
 *
 * A signal may have any length: it is read to its end, from the row on at which the reader is, and in memory that
 * does not grow.  Of a column of more than 2048 values in the span, the smallest and the largest of each of 1024
 * blocks or more are drawn. */
ss_status ss_plot_signal(FILE *out, ss_reader *reader, const size_t column[], size_t n,
                         const ss_plot_opts *opts, ss_error *err);
/* Draw column y over column x: a phase plane or a friction loop.  Of opts->over, the columns of the same names are
 * drawn over it, or else the first two.
 *
 * The readers can go back to their first row.  A part of the line is left out if it crosses no cell of half a
 * pixel that the line has not crossed before. */
ss_status ss_plot_xy(FILE *out, ss_reader *reader, size_t x, size_t y,
                     const ss_plot_opts *opts, ss_error *err);

/* Draw the spectra of n columns of a signal of any length, which can go back to its first row, one panel each, as
 * ss_spectrum_new finds them, in the span of opts. */
ss_status ss_plot_spectrum(FILE *out, ss_reader *reader, const size_t column[], size_t n, const ss_plot_opts *opts,
                           ss_error *err);
/* Write them as text: notes of the header, resolution and segments, then a row for each frequency.  ss_table_read
 * reads it (SS_KIND_SPECTRUM).  SS_EINVAL: the format holds numbers only; SS_EIO. */
ss_status ss_spectrum_write(ss_reader *reader, const size_t column[], size_t n, const ss_plot_opts *opts,
                            FILE *out, ss_format format, ss_error *err);

typedef struct ss_contour_opts {
    size_t size;                /* set by ss_contour_opts_init */
    int levels;                 /* the number of contour lines */
    double span;                /* [dB] from the largest |W| down to the lowest line, at most */
    double noise;               /* |W| at which noise begins; the lines end there, but they always span
                                   10 dB; NaN: it is measured, see below; 0: the lines span all of span */
    double top;                 /* the largest |W|; 0: it is measured, outside the cone of influence */
    double level;               /* [dB] re 1: the |W| of 0 dB, so that pictures compare; NaN: the largest */
    const char *palette;        /* one of ss_palettes; NULL: viridis */
    int fill;                   /* 1: draw colours between the lines */
    int ridge;                  /* 1: mark the ridges, see below */
    double fmin, fmax;          /* [Hz] the range of labels to draw; 0: all */
    const ss_signal *signal;    /* the signal of panel (a); NULL: no such panel */
    size_t column;              /* its column */
    const double *event;        /* [s] on the source's clock; each is a vertical line; NULL: none */
    size_t n_events;
    const ss_overlay *overlay;  /* NULL: none */
    ss_progress progress;       /* called after every scale */
} ss_contour_opts;
extern const struct ss_contour_ranges {
    ss_range levels;
    ss_range span, level;       /* [dB] */
} ss_contour_ranges;
/* 18 levels over 80 dB, or down to the noise.  Where a function takes options, NULL stands for these. */
void ss_contour_opts_init(ss_contour_opts *opts, size_t size);
/* The names of palettes, each with even steps of lightness: "viridis", ..., and those with "_r", whose
 * loudest level is light; NULL behind the last. */
extern const char *const ss_palettes[];

/* Draw contours of L = 20 log10(|W| / |W| of 0 dB) at -k span/levels, k = 1 ... levels.
 *
 * Noise: outside the cone of influence, Gaussian noise has |W| above a value with the probability
 * exp(-|W|^2/s^2).  A scale is noise if the ratios of its 10, 25 and 50 % quantiles are those of
 * this law within 1 dB, in a record of at least 100 lengths of its wavelet, and if |W| neither changes
 * slowly nor repeats.  s comes from the 25 % quantile.  It is right within 0.5 dB if all is noise, and up
 * to 2 dB too high if events last for 30 % of the time.  If such scales make an octave or more, noise
 * begins at sqrt(ln N) times the s that nine of ten of them do not exceed.  This is about the largest of N
 * independent |W|, as many as the map has.
 *
 * A ridge point is a maximum of |W| over the scales at one time.  It lies outside the cone, 3 dB
 * above the saddles beside it, and above the lowest line.  That of a steady oscillation lies at
 * the label 2 omega_c / (omega_c + sqrt(omega_c^2 + 2)) times its frequency, 0.987 for omega_c =
 * 6; with the norm 1/a it lies at its frequency.
 *
 * A mark outside the span or the labels that are drawn is left out. */
ss_status ss_plot_contour(FILE *out, const ss_coefficients *coefficients,
                          const ss_contour_opts *contour, const ss_plot_opts *opts, ss_error *err);
/* Write the ridge points that such a picture marks, as rows of time and of the frequency and the amplitude of the
 * steady oscillation that has such a ridge.  ss_table_read reads them (SS_KIND_RIDGE).  SS_EINVAL: the format
 * holds numbers only. */
ss_status ss_ridge_write(const ss_coefficients *coefficients, const ss_contour_opts *contour,
                         const ss_plot_opts *opts, FILE *out, ss_format format, ss_error *err);

/* Draw the work-precision diagram: the largest error of x over CPU time as a multiple of the
 * fastest row's, both logarithmic, with a line for each method and rings on the frontier.
 * opts->from and to have no meaning here and below. */
ss_status ss_plot_trade(FILE *out, const ss_trade *trade, const ss_plot_opts *opts, ss_error *err);

/* Draw the errors of x, v, a and f, and the rms error of the map as a ratio less 1, over CPU time as a
 * multiple of the scene's own, with a colour for each simpler scene. */
ss_status ss_plot_models(FILE *out, const ss_models *models, const ss_plot_opts *opts, ss_error *err);

/* Draw each step of a load point: friction along the path, as measured and by both laws, and what each law
 * leaves. */
ss_status ss_plot_steps(FILE *out, const ss_steps *steps, const ss_plot_opts *opts, ss_error *err);

/* Draw a ranking of friction laws by two columns of the signal: the loop of force over motion as measured and as
 * the first law predicts it, what that leaves over time, and for each law a bar of what it explains of the force
 * where it was not fitted, with its error; a white point marks those that are tied.  SS_EINVAL: nothing was
 * compared. */
ss_status ss_plot_motion(FILE *out, const ss_signal *signal, size_t motion, size_t force,
                         const ss_motion_ranking *ranking, const ss_plot_opts *opts, ss_error *err);

/* Draw n columns of a sweep, whose notes say whether one parameter was varied or two.
 *
 * Two: columns 0 and 1 of these make a grid, and the other one or two are drawn over it.  A column with at most
 * ten different values is drawn as regions, any other as lines of equal value.
 *
 * One: columns 1 to n - 1, at most seven, over column 0, one panel each.  They are points if rows of the same x
 * differ (a bifurcation diagram), else a line.
 *
 * "-" is no value, and "aperiodic" a period of 0.  SS_EINVAL: these are too few columns, too many, or of forms
 * that exclude each other, or there is opts->curve over one parameter; SS_EDATA: a drawn column has another word
 * or no value, or the rows make no grid. */
ss_status ss_plot_sweep(FILE *out, const ss_table *table, const size_t column[], size_t n,
                        const ss_plot_opts *opts, ss_error *err);

/* Draw a free decay: its amplitude [dB] and blocks over time, and its frequency and damping ratio over amplitude,
 * with errors; what is known by the mechanism's name dashed.  SS_EINVAL: there are no rows. */
ss_status ss_plot_backbone(FILE *out, const ss_backbone *backbone, const ss_signal *signal, size_t column,
                           const ss_plot_opts *opts, ss_error *err);

SS_END_DECLARATIONS
#endif
