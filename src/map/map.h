/* map.h -- a map of coefficients, whoever holds or makes them.
 *
 * A map is an ss_coefficients: its grid, and its coefficients in memory (w) or in a source, which reads a
 * range of the translations of a scale where that is asked for.  A record that was transformed, a file, an
 * overview of a recording and a plan that computes on demand look alike to those who read a map with
 * ss_map_read and free it with ss_coefficients_free. */
#ifndef MAP_H
#define MAP_H

#include <math.h>
#include <stickslip/morlet.h>
#include "signal/gaps.h"

/* The options by default, and those of a caller: NULL are the defaults, as ss_options_take. */
extern const ss_morlet_opts ss_morlet_defaults;
ss_status ss_morlet_take(ss_morlet_opts *own, const ss_morlet_opts *given, ss_error *err);

#define SQUARE_LEAST 1e-280
#define SQUARE_MOST 1e280

/* |w|, for numbers whose squares neither overflow nor underflow, without the cost of hypot. */
static inline double
magnitude_of(const double w[2])
{
    double square = w[0] * w[0] + w[1] * w[1];
    return square > SQUARE_LEAST && square < SQUARE_MOST ? sqrt(square) : hypot(w[0], w[1]);
}

/* For sources: fill in n coefficients w of a part, from its translation first + at on. */
void ss_map_give(const ss_map_part *part, size_t at, size_t n, const double *w);

/* The grid of the transform of n samples, with the header of a signal's column, or without one if signal is NULL,
 * and with a source that computes what is read, on the threads that opts name, once ss_map_begin has been
 * called.  SS_ESCALE as ss_morlet_new. */
ss_status ss_map_plan(ss_coefficients **out, const ss_signal *signal, size_t column, size_t n, double rate,
                      const ss_morlet_opts *opts, ss_error *err);
/* The samples of the column, with those of gaps replaced. */
ss_status ss_map_begin(ss_coefficients *map, const double *x, ss_error *err);
/* Both for n samples that have no header: the map's head is NULL. */
ss_status ss_map_of_samples(ss_coefficients **out, const double *x, size_t n, double rate,
                            const ss_morlet_opts *opts, ss_error *err);
/* Report the part of the work on a map that is done, 0 to 1, to the progress function of its options, if it
 * is computed; SS_STOP if that stops the work. */
ss_status ss_map_progress(const ss_coefficients *map, double done);
size_t ss_stream_samples(const ss_stream *stream);                  /* the samples pushed so far */

/* 1 if translation k of scale i lies inside the cone of influence, in a gap, or nearer than
 * sqrt(2) a to a gap; else 0. */
int ss_coefficients_edge(const ss_coefficients *coefficients, size_t i, size_t k);

/* --- the Morlet wavelet, h(t) = pi^-1/4 exp(i omega_c t) exp(-t^2/2) ------------------------- */

#define PI_M14 0.75112554446494248286   /* pi^-1/4 */
#define WAVELET_CENTER 6.0              /* omega_c, where none is asked for */

/* The factor of the second term of h; 0 where that is left out. */
static inline double
wavelet_second(const ss_morlet_opts *opts)
{
    return opts->admissible ? exp(-opts->center * opts->center / 2) : 0;
}

/* The width of the cone of influence at scale a: |h|^2 has fallen to exp(-2). */
static inline double
wavelet_cone(double a)
{
    return sqrt(2) * a;
}

/* 1 if coefficient k of a scale lies in the cone of influence of an end of the record, which has n
 * samples from start on, or of one of its gaps. */
static inline int
wavelet_edge(const ss_scale *scale, size_t k, size_t n, double rate, double start, const ss_span *gap,
             size_t n_gaps)
{
    return ss_scale_edge(scale, k, n, rate)
        || (n_gaps > 0 && ss_gaps_near(gap, n_gaps, start + ss_scale_b(scale, k), wavelet_cone(scale->a)));
}

#endif
