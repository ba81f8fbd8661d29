/* contour.h -- the parts of a contour plot: the map, its noise, its lines, the areas between them. */
#ifndef CONTOUR_H
#define CONTOUR_H

#include <stickslip/morlet.h>
#include "plot/script.h"

#define CONTOUR_COLUMNS 700     /* the width of panel (b), about [pixels] */
#define CONTOUR_ROWS 580        /* and its height */
#define CONTOUR_LEVELS 100      /* the most levels */
#define CONTOUR_FLOOR 1000.0    /* [dB] below the largest |W|: the level of |W| = 0 */

/* |W| in decibels relative to that of 0 dB, with CONTOUR_COLUMNS + 1 values in a row.  A row is a
 * scale; the first and the last row are at the ends of the range of labels that is drawn. */
typedef struct contour_map {
    const script_span *span_of_time;
    double from, to;            /* [s] its first and its last column: of this span, what the record has */
    size_t rows;
    double *f;                  /* [Hz] of each row */
    double *level;
    double top;                 /* |W| of 0 dB */
    double span;                /* [dB] of the lines */
    double noise;               /* [dB] where noise begins; NaN: not measured, or below the lines */
} contour_map;
ss_status ss_contour_map(contour_map *map, const ss_coefficients *c, const ss_contour_opts *contour,
                         const script_span *span, ss_error *err);
void ss_contour_map_free(contour_map *map);

/* Write a datablock of time, frequency and number of the level, with a blank line after each line and two after
 * each level, and the list of levels that have lines.  *any becomes 1 if a level has one. */
ss_status ss_contour_write_lines(FILE *out, const contour_map *map, int levels, int *any);
/* Write polygons that fill the areas between the lines. */
ss_status ss_contour_write_fill(FILE *out, const contour_map *map, int levels);
/* Call visit for each ridge point, with its time, its frequency and its level, ascending in time.  Returns their
 * number. */
size_t ss_contour_ridge(const contour_map *map, const ss_coefficients *c,
                        void (*visit)(double t, double f, double level, void *user), void *user);

/* The level at which noise begins in a map of |W|, found in one pass (noise_level.c). */
typedef struct noise_level noise_level;

noise_level *ss_noise_level_new(size_t n_scales);       /* NULL: no memory */
/* Add those that measure noise among the coefficients first ... first + n - 1 of a scale, the i-th, given by |W|;
 * all lie outside the cone of influence. */
void ss_noise_level_add(noise_level *noise, const ss_scale *scale, size_t i, const double *level, size_t first,
                        size_t n);
/* |W| at which noise begins; 0: none was found. */
double ss_noise_level(noise_level *noise, const ss_scale *scale);
void ss_noise_level_free(noise_level *noise);           /* NULL is allowed */

/* Write the datablock $spans, of two times a row, cut at the ends of span; returns the number of rows. */
size_t ss_contour_write_spans(FILE *out, const script_span *span, const ss_overlay *overlay);

/* The colour below all areas of a palette whose loudest level is light; NULL if it is dark: white paper. */
const char *ss_palette_ground(const char *name);
/* Write the variable colours: those of a palette from quiet to loud, for lines on white or for areas. */
void ss_palette_write(FILE *out, const char *name, int areas);

#endif
