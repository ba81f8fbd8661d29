/* stickslip/plot.h -- self-contained gnuplot scripts: data inside, named variables at the top,
 * no terminal set unless opts name one.  Text from files is escaped: it is drawn and never run. */
#ifndef STICKSLIP_PLOT_H
#define STICKSLIP_PLOT_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>
#include <stickslip/morlet.h>
#include <stickslip/overlay.h>
#include <stickslip/table.h>
#include <stickslip/trade.h>

SS_BEGIN_DECLARATIONS

typedef enum ss_plot_style {
    SS_PAPER,                   /* as wide as a journal's column, 8.5 cm, with letters of 6 points */
    SS_SCREEN                   /* 1.5 times as wide and high with letters of that size: more room */
} ss_plot_style;

typedef struct ss_plot_opts {
    const char *output;         /* the picture's file, .png, .svg or .pdf; NULL: none is named, the
                                   script draws on gnuplot's current terminal */
    const char *format;         /* "png", "svg", "pdf"; NULL: from output's ending */
    const char *title;          /* NULL: from the notes (scene, model); "": none */
    double from, to;            /* [s] on the source's clock, the span drawn; NaN: all of it */
    ss_plot_style style;
    const ss_signal *over;      /* of ss_plot_signal and ss_plot_xy; NULL: none */
} ss_plot_opts;
extern const ss_plot_opts ss_plot_defaults;

/* One panel a column over time (figure 1), of the n columns given by index; n = 0 for all.  The first
 * column of opts->over, if that is not NULL, is drawn over the first panel; it begins with the
 * signal. */
ss_status ss_plot_signal(FILE *out, const ss_signal *signal, const size_t column[], size_t n,
                         const ss_plot_opts *opts, ss_error *err);
/* Columns of a signal of any length for ss_plot_signal, in memory that does not grow: read to its end, it has
 * *rows rows.  Up to 2^20 values are kept as they are; of more, the smallest and the largest of each of
 * some 10^6 blocks in all within opts->from and to, which become the span of the picture. */
ss_status ss_plot_envelope(ss_signal **out, size_t *rows, ss_reader *reader, const size_t column[], size_t n,
                           ss_plot_opts *opts, ss_error *err);
/* One column over another: a phase plane or a friction loop.  Over it are drawn the columns of
 * opts->over of the same names, or else its first two. */
ss_status ss_plot_xy(FILE *out, const ss_signal *signal, size_t x, size_t y,
                     const ss_plot_opts *opts, ss_error *err);

/* The power spectral density of columns, as ss_spectrum_new has it of the span drawn, a panel each;
 * n = 0 for all.  decibels: 1: in dB re 1 unit^2/Hz. */
ss_status ss_plot_spectrum(FILE *out, const ss_signal *signal, const size_t column[], size_t n,
                           double resolution, int decibels, const ss_plot_opts *opts, ss_error *err);

typedef struct ss_contour_opts {
    int levels;                 /* contour lines */
    double span;                /* [dB] that they span below the largest |W|, at most */
    double noise;               /* |W| at which noise begins, and the lines end, though not above 10 dB
                                   below the largest; NaN: measured, see below; 0: they span all of span */
    double top;                 /* |W| of 0 dB; 0: the largest outside the cone of influence */
    const char *palette;        /* one of ss_palette_name; NULL: viridis */
    int fill;                   /* 1: colours between the lines, too */
    int ridge;                  /* 1: the ridges are marked, see below */
    double fmin, fmax;          /* [Hz] the labels drawn, 0: all there are */
    const ss_signal *signal;    /* for panel (a), or NULL */
    size_t column;              /* of that signal */
    const double *event;        /* [s] on the source's clock, marked by vertical lines, or NULL */
    size_t n_events;
    const ss_overlay *overlay;  /* or NULL */
    ss_coefficient_source *source;  /* called once for every scale if the coefficients' w is NULL */
    void *source_user;          /* passed to it */
    ss_progress progress;       /* called after every scale */
} ss_contour_opts;
extern const ss_range ss_contour_levels;
extern const ss_range ss_contour_spans;         /* [dB] */
extern const ss_contour_opts ss_contour_defaults;   /* 18 levels spanning 80 dB, or down to the noise */
/* The name of the i-th palette, each with even steps of lightness: "viridis", ...; NULL after the
 * last. */
const char *ss_palette_name(size_t i);

/* Contours of L = 20 log10(|W| / max|W| where edge = 0) at -k span/levels, k = 1 ... levels.
 *
 * Noise is measured where |W| of a scale, outside the cone of influence, has the distribution that
 * Gaussian noise gives it, exp(-|W|^2/s^2) being the share above |W|: where the ratios of its 10,
 * 25 and 50 % quantiles are those of this law within 1 dB, with at least 100 wavelets' lengths of
 * it.  s is found from the 25 % quantile: within 0.5 dB where all is noise, up to 2 dB too high
 * where events last for 30 % of the time.  With an octave of such scales or more, noise begins at
 * sqrt(ln N) times the s that nine of ten of them do not exceed: the largest of N independent |W|,
 * as many as the map has, is about there.
 *
 * A ridge point is a maximum of |W| over the scales at one time, outside the cone, 3 dB above the
 * saddles beside it and above the lowest line.  Where a steady oscillation has it, it lies at the
 * label 2 omega_c / (omega_c + sqrt(omega_c^2 + 2)) times its frequency, 0.987 for omega_c = 6;
 * with the norm 1/a at that frequency.
 *
 * Marks outside the span and the labels drawn are arrows at the border. */
ss_status ss_plot_contour(FILE *out, const ss_coefficients *coefficients,
                          const ss_contour_opts *contour, const ss_plot_opts *opts, ss_error *err);

/* The work-precision diagram: worst error of x over CPU time as a multiple of the fastest row's, both
 * logarithmic, one line a method, the frontier ringed.  opts->from and to do not apply. */
ss_status ss_plot_trade(FILE *out, const ss_trade *trade, const ss_plot_opts *opts, ss_error *err);

/* Error against CPU time, as a multiple of the scene's own, a point a simpler scene for each of x, v, a
 * and f; and under it the same of the map.  opts->from and to do not apply. */
ss_status ss_plot_models(FILE *out, const ss_models *models, const ss_plot_opts *opts, ss_error *err);

typedef struct ss_map_opts {
    size_t x, y;                /* columns of the table that make a grid */
    size_t z[2], n_z;           /* one or two columns drawn over it */
    const double *curve;        /* x, y, x, y, ... of a line over all, NaN where it breaks; NULL */
    size_t n_curve;             /* points */
} ss_map_opts;

/* A map of a sweep over two parameters: a column of at most ten different values as regions, any other
 * as lines of equal value; "-" is no value, and "aperiodic" a period of 0.  opts->from and to do not
 * apply.  SS_EDATA: another word in a drawn column. */
ss_status ss_plot_map(FILE *out, const ss_table *table, const ss_map_opts *map,
                      const ss_plot_opts *opts, ss_error *err);

/* A sweep over one parameter: n columns y over x, a panel each, as points where rows of one x differ (a
 * bifurcation diagram), else as a line.  Words as in ss_plot_map. */
ss_status ss_plot_diagram(FILE *out, const ss_table *table, size_t x, const size_t y[], size_t n,
                          const ss_plot_opts *opts, ss_error *err);

SS_END_DECLARATIONS
#endif
