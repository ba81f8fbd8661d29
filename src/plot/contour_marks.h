/* contour_marks.h -- draw the events and features of a signal over its contours, or over time. */
#ifndef CONTOUR_MARKS_H
#define CONTOUR_MARKS_H

#include "plot/contour.h"

/* The number of marks of each kind that can be drawn: an empty block is an error in gnuplot. */
typedef struct contour_marks {
    size_t spans, spikes, maxima;
    size_t event_arrows, feature_arrows;
} contour_marks;

/* Write datablocks of the events and the overlay inside the map, and of arrows for the others. */
contour_marks ss_contour_write_marks(FILE *out, const contour_map *map, const ss_contour_opts *contour);
/* In the plot command: events lie behind the lines, features before them. */
void ss_contour_plot_events(FILE *out, const contour_marks *marks, size_t n_events);
void ss_contour_plot_features(FILE *out, const contour_marks *marks);

/* Write the datablock $spans, of two times a row, cut at the ends of span; returns the number of rows. */
size_t ss_contour_write_spans(FILE *out, const script_span *span, const ss_overlay *overlay);

/* SS_EINVAL: a time or frequency is not finite.  overlay may be NULL. */
ss_status ss_contour_check_marks(const ss_contour_opts *contour, ss_error *err);
ss_status ss_contour_check_overlay(const ss_overlay *overlay, ss_error *err);

/* Decimals of a frequency: six digits at least. */
int ss_contour_decimals(double f);

#endif
