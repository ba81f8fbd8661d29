/* contour.h -- the parts of a contour plot: the map, its noise, its lines, what lies between them. */
#ifndef CONTOUR_H
#define CONTOUR_H

#include "plot/script.h"

#define CONTOUR_COLUMNS 700     /* the width of panel (b), about [pixels] */
#define CONTOUR_ROWS 580        /* and its height */
#define CONTOUR_LEVELS 100      /* the most levels */
#define CONTOUR_FLOOR 1000.0    /* [dB] below the largest |W|: the level of |W| = 0 */

/* |W| in decibels relative to the largest, CONTOUR_COLUMNS + 1 values a row; a row is a scale, the
 * first and the last where the labels drawn begin and end. */
typedef struct contour_map {
    const script_span *span_of_time;
    double from, to;            /* [s] its first and its last column: of this span, what the record has */
    size_t rows;
    double *f;                  /* [Hz] of each row */
    double *level;
    double span;                /* [dB] of the lines */
    double noise;               /* [dB] where noise begins; NaN: not measured, or below the lines */
} contour_map;
ss_status ss_contour_map(contour_map *map, const ss_coefficients *c, const ss_contour_opts *contour,
                         const script_span *span, ss_error *err);
void ss_contour_map_free(contour_map *map);

/* A datablock of time, frequency and number of the level, a blank line after each line and two after
 * each level, and which levels have lines; *any is 1 if one has. */
ss_status ss_contour_write_lines(FILE *out, const contour_map *map, int levels, int *any);
/* Polygons that fill what lies between the lines. */
ss_status ss_contour_write_fill(FILE *out, const contour_map *map, int levels);
/* A datablock of the ridge points, time and frequency; returns their number. */
size_t ss_contour_write_ridge(FILE *out, const contour_map *map, const ss_coefficients *c);

/* A point of the map, column and row, as time and frequency, with the texts between and behind them. */
void ss_contour_write_point(FILE *out, const contour_map *map, const double point[2], char between,
                            const char *behind);
/* The next point after first, of n, that a line needs to keep within a fraction of a pixel. */
size_t ss_contour_next_point(const contour_map *map, const double (*point)[2], size_t n, size_t first);

int ss_palette_is_known(const char *name);
/* The variable colours: those of a palette, light to dark, for lines on white or for areas. */
void ss_palette_write(FILE *out, const char *name, int areas);

#endif
