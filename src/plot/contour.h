/* contour.h -- the lines of a contour plot. */
#ifndef CONTOUR_H
#define CONTOUR_H

#include "plot/script.h"

#define CONTOUR_COLUMNS 700     /* the width of panel (b), about [pixels] */
#define CONTOUR_LEVELS 100      /* the most levels */

/* |W| in decibels relative to the largest, CONTOUR_COLUMNS + 1 values a scale, to be freed. */
ss_status ss_contour_map(double **out, const ss_coefficients *c, const ss_contour_opts *contour,
                         const script_span *span, ss_error *err);
/* A datablock of time, frequency and number of the level, a blank line after each line and two after
 * each level, and which levels have lines; *any is 1 if one has. */
ss_status ss_contour_write_lines(FILE *out, const ss_coefficients *c, const ss_contour_opts *contour,
                                 const script_span *span, const double *level, int *any);

#endif
