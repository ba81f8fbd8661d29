/* scale_rows.h -- |W| along single scales: its maxima, its noise, and the threshold between them. */
#ifndef SCALE_ROWS_H
#define SCALE_ROWS_H

#include <stddef.h>
#include <stickslip/spikes.h>
#include "find/window.h"
#include "map/map.h"

#define ROW_CENTER 6.0
#define ROW_VOICES 4
#define ROW_HIGHEST 0.6         /* part of the Nyquist frequency: converters have their filters above it */
/* The reach of a wavelet in scales: it is 1.5e-8 of its height there. */
#define ROW_REACH 6.0

typedef struct peak {
    double t, level;            /* [s], |W| */
} peak;

typedef struct scale_row {
    double a, f;
    double rms, top;            /* rms of the noise; level of the largest peak */
    size_t n;
    peak *peak;                 /* all maxima outside the cone of influence and out of the
                                   reach of gaps, in time order */
} scale_row;

typedef struct row_source {
    const double *x;
    size_t n;
    double rate;
    int constant;               /* 1: all samples are the same */
    double rounding;            /* rms of |W| that the rounding of the samples makes */
    const ss_span *gap;         /* in time order [s]: samples in them are not of the signal */
    size_t n_gaps;
    /* computes the rows of scales from 2^octave s up to 2^end s, from x with margin samples before it; NULL
     * before the first scale_row */
    ss_coefficients *rows;
    double octave, end;
    size_t margin;
} row_source;

/* Prepare a source of n > 0 samples, whose differences are finite. */
void ss_row_source_init(row_source *source, const double *x, size_t n, double rate, const ss_span *gap, size_t n_gaps);
/* Free its memory.  It can be used again. */
void ss_row_source_free(row_source *source);

/* Compute the row of the scale 2^(j / ROW_VOICES) s that is nearest to the label f.  Rows should be asked
 * for from short to long scales, as some octaves share spectra.  The noise is found where no spike of loud
 * is near; NULL: everywhere.  r->peak is to be freed with free(). */
ss_status ss_row_new(scale_row *r, row_source *source, double f, const ss_spikes *loud);

/* The level, in units of the noise's rms, that Gaussian noise is expected to reach FALSE_ALARMS
 * times in so many rows, the first of scale shortest, of a record of that length [s]. */
double ss_row_threshold(double length, double shortest, size_t rows);

#endif
