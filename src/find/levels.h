/* levels.h -- |W| of a map, part by part, from given coefficients or computed on demand. */
#ifndef LEVELS_H
#define LEVELS_H

#include <math.h>
#include <stickslip/morlet.h>

#define SQUARE_LEAST 1e-280
#define SQUARE_MOST 1e280

/* |w|, for numbers whose squares neither overflow nor underflow, without the cost of hypot. */
static inline double
magnitude_of(const double w[2])
{
    double square = w[0] * w[0] + w[1] * w[1];
    return square > SQUARE_LEAST && square < SQUARE_MOST ? sqrt(square) : hypot(w[0], w[1]);
}

typedef struct levels levels;

/* A map on a grid: its w if levels is NULL.  The grid may be NULL else. */
typedef struct map_source {
    const ss_coefficients *grid;
    levels *levels;
} map_source;

/* Translations first ... first + n - 1 of a row, and room for their |W|, which the caller owns. */
typedef struct level_part {
    size_t row, first, n;
    double *level;
} level_part;

/* The grid of a column's transform, without w, and what computes |W| on it, when ss_levels_read has been
 * called.  SS_ESCALE as ss_morlet_new. */
ss_status ss_levels_new(map_source *out, const ss_signal *signal, size_t column,
                        const ss_morlet_opts *opts, ss_error *err);
/* The samples of the column, with those of gaps replaced. */
ss_status ss_levels_read(map_source *source, const double *x, ss_error *err);
/* Both for n samples in place of a column; the source has no grid. */
ss_status ss_levels_of_samples(map_source *out, const double *x, size_t n, double rate,
                               const ss_morlet_opts *opts, ss_error *err);
/* Row 0 is that of the longest scale. */
const ss_scale *ss_levels_scale(const map_source *source, size_t row);
/* Free what these functions have made, also if they failed. */
void ss_levels_free(map_source *source);

ss_status ss_levels_fill(const map_source *source, const level_part *part, size_t n);
/* The middle one of n >= 1 levels, all >= 0: n / 2 others are not above it.  The levels change places. */
double ss_levels_middle(double *level, size_t n);
/* Report the part of the work on a map that is done, 0 to 1; SS_STOP if the progress function stops it. */
ss_status ss_levels_progress(const map_source *source, double done);

#endif
