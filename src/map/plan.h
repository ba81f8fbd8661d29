/* plan.h -- declarations that the files of the wavelet transform share. */
#ifndef PLAN_H
#define PLAN_H

#include <stddef.h>
#include <stickslip/morlet.h>
#include "map/map.h"

/* The note of a stepped grid whose translations are fractions of samples: without it they are n B_0 a. */
#define SS_LATTICE "b = n B, B the largest 2^p/m samples <= step a, m of 1 3 5 7 9 15 21 25 35 45"
/* The names of all notes that describe coefficients, as ss_header_forget takes them. */
extern const char *const ss_coefficient_notes[];
/* The options from which a grid follows, as these notes have them, and the number of samples; 0: a stream has
 * not ended.  SS_EDATA. */
ss_status ss_morlet_opts_of_notes(ss_morlet_opts *opts, size_t *samples, const ss_header *head, ss_error *err);
/* The same for a map that is read and has but the notes of its head: its n and center and the column of head
 * are set. */
ss_status ss_coefficients_take_notes(ss_coefficients *map, ss_morlet_opts *opts, ss_error *err);
#define REACH 8.5                       /* exp(-REACH^2/2) = 2e-16 */

enum { BLOCK_LEVELS = 48 };             /* of fft/blocks.c */

struct ss_morlet {
    ss_morlet_opts opts;
    size_t n;               /* samples */
    double rate;            /* [Hz] */
    size_t n_scales;
    ss_scale *scale;        /* long to short */
    size_t total;           /* coefficients */
    ss_grid grid;           /* these, for callers */
    int window;             /* 1: of a stream */
    struct blocks *blocks;  /* NULL: all by quadrature */
    struct wavelet **wave;  /* of scales by quadrature; NULL: they are made when needed */
};

/* A copy of the samples, detrended, times the power of two that brings max|x| into [1/2, 1). */
typedef struct record {
    size_t n;
    double *x;              /* the caller's to free */
    int exponent;           /* the samples are x 2^exponent */
} record;

/* Translations first ... first + n - 1 of a scale. */
typedef struct span {
    size_t first, n;
} span;

/* The place of a coefficient: tau samples, |tau| <= 1/2, after sample c. */
typedef struct spot {
    double c, tau;
} spot;

/* How many of the samples come before the first that is not finite, and max|x| of those; the error
 * that a sample is not, numbered from 1: SS_EINVAL. */
size_t ss_morlet_finite(const double *x, size_t n, double *most);
ss_status ss_morlet_not_finite(ss_error *err, size_t number, double x);

/* Divide by 2^exponent samples of a signal whose largest is `most`.  Those below 2^-900 of it become 0,
 * which is far below the error promised: their products with the wavelet would be subnormal, and some
 * processors take 100 times as long to compute those. */
void ss_morlet_divide(double *x, size_t n, int exponent, double most);

/* SS_EINVAL if a sample is not finite. */
ss_status ss_morlet_record(record *rec, const double *x, size_t n, ss_detrend detrend, ss_error *err);

/* w, in units of a^1/2 and of the record, in the norm and the samples' own size. */
ss_status ss_morlet_finish(double *w, size_t n, double a, ss_norm norm, int exponent, ss_error *err);
/* The coefficients of a scale at n translations k by the definition, so finished. */
ss_status ss_morlet_points(const ss_morlet *plan, const ss_scale *scale, const record *rec, const size_t k[],
                           size_t n, double *w, ss_error *err);

/* SS_OK if every option lies in its range and n samples at this rate are a record. */
ss_status ss_morlet_check(size_t n, double rate, const ss_morlet_opts *opts, ss_error *err);

/* The scales of opts, long to short, to be freed.  n = 0: the length is not known, and
 * translations are not counted. */
ss_status ss_grid_make(ss_scale **scale, size_t *n_scales, size_t n, double rate,
                         const ss_morlet_opts *opts, ss_error *err);
/* m, if translation k of a scale lies at sample k 2^p/m exactly, 2^p being b_num, else 0. */
double ss_scale_parts(const ss_scale *scale, double rate);
/* The place of translation k. */
spot ss_scale_spot(const ss_scale *scale, size_t k, double rate);
/* Translations up to time t >= 0. */
size_t ss_scale_count(const ss_scale *scale, double t);

/* Fill in scale j of the grid but for its offset; a NaN means 2^(j/V); n = 0: but for n, too.
 * SS_EINVAL if its translations are too many to count. */
ss_status ss_morlet_scale_at(ss_scale *scale, int j, double a, size_t n, double rate,
                             const ss_morlet_opts *opts, ss_error *err);

/* The wavelet of a scale at whole samples, for records of n samples at most, which threads share.  NULL: no
 * memory. */
typedef struct wavelet wavelet;
wavelet *ss_wavelet_new(const ss_morlet_opts *opts, double a, double rate, size_t n);
void ss_wavelet_free(wavelet *wave);                   /* NULL is allowed */
/* Let a plan keep all wavelets that it uses. */
ss_status ss_morlet_keep_wavelets(ss_morlet *plan);
/* The coefficient at a place by the definition, as exactly as double precision allows, in units of a^1/2 and of
 * the record; and the adjoint: Re(w h) is added to the n samples x. */
void ss_wavelet_sum(const wavelet *wave, const record *rec, spot at, double w[2]);
void ss_wavelet_add(const wavelet *wave, size_t n, spot at, const double w[2], double *x);

/* Of a record's windows from the first on, level by level; threads share them. */
typedef struct spectra {
    double *level[BLOCK_LEVELS];
    size_t first;
} spectra;

/* A record that is transformed by a plan. */
typedef struct transformed {
    record rec;
    spectra spectra;
} transformed;
/* Make it of the plan's n samples; to be ended, failed or not. */
ss_status ss_morlet_begin(const ss_morlet *plan, const double *x, transformed *of, ss_error *err);
void ss_morlet_end(transformed *of);
/* Compute n parts on the plan's threads, if they are worth that.  The error is that of the first part that fails.
 * done, unless it is NULL, is raised by their coefficients and reported as progress. */
ss_status ss_morlet_parts(const ss_morlet *plan, const transformed *of, const ss_map_part part[], size_t n,
                          size_t *done, ss_error *err);

void ss_morlet_spectra_free(spectra *s);
/* The coefficients of a part, in the norm and the samples' own size. */
ss_status ss_morlet_part(const ss_morlet *plan, const transformed *of, double *scratch, const ss_map_part *part,
                         ss_error *err);
/* The length of a part from translation k on of which no work is done again for the next, at most as many
 * as the second returns. */
size_t ss_morlet_part_length(const ss_morlet *plan, size_t i, size_t k);
size_t ss_morlet_part_most(const ss_morlet *plan);

#endif
