/* stickslip/morlet.h -- Morlet wavelet coefficients of a sampled signal.
 *
 * With t in seconds from the first sample and h(t) = pi^-1/4 exp(i omega_c t) exp(-t^2/2),
 *
 *     W(a, b) = a^-1/2 (1/rate) sum_n x_n conj h((n/rate - b) / a),
 *
 * where the signal is zero outside the record.  Scales are a = 2^(j/V) s with an integer j and V
 * voices per octave.  Translations are b = n B (a stepped grid) or n / rate (a dense one), from
 * the first sample.
 *
 * B is the largest step of 2^p/m samples that does not exceed B_0 a, where p is an integer and m
 * one of 1 3 5 7 9 15 21 25 35 45, at most 17/B_0.  Short FFTs give these translations.  B is B_0
 * a itself in three cases: exact is asked for; B_0 > 1; V is 1 and B_0 a is a power of two, as on
 * the paper's dyadic grid.
 *
 * The label of a scale is the frequency f = omega_c / (2 pi a).  With the 1/a norm a steady
 * sinusoid has its largest |W| at its own frequency.  With the a^-1/2 norm this label is lower by
 * the factor 2 omega_c / (omega_c + sqrt(omega_c^2 + 2)), by 1.35 % at omega_c = 6. */
#ifndef STICKSLIP_MORLET_H
#define STICKSLIP_MORLET_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>

SS_BEGIN_DECLARATIONS

typedef enum ss_norm {
    SS_NORM_L2,                 /* a^-1/2, the paper's */
    SS_NORM_L1                  /* 1/a: a steady sinusoid gives the same |W| at every frequency */
} ss_norm;

typedef enum ss_detrend { SS_DETREND_NONE, SS_DETREND_MEAN, SS_DETREND_LINEAR } ss_detrend;

typedef enum ss_engine {
    SS_ENGINE_AUTO,             /* SS_ENGINE_FFT */
    SS_ENGINE_QUADRATURE,       /* the sum of the definition, over all samples within 8.5 a */
    SS_ENGINE_FFT               /* spectra, by FFTW; but the sum for forced scales that are narrower
                                   than half a sample or longer than two records */
} ss_engine;

/* The ranges of the numbers are ss_morlet_ranges. */
typedef struct ss_morlet_opts {
    size_t size;                /* set by ss_morlet_opts_init */
    double center;              /* omega_c */
    int voices;                 /* V, scales per octave */
    double step;                /* B_0, translation step in units of the scale; unused if dense */
    int exact;                  /* 1: translations are n B_0 a, which costs some 3 times more */
    int dense;                  /* 1: every scale has a coefficient at each sample */
    double fmin, fmax;          /* [Hz] labels of the longest and the shortest scale; 0: by default fmin
                                   is 4 cycles per record (or the lowest usable frequency, if that is
                                   higher) and fmax the highest usable frequency */
    int octaves;                /* 1: scales from 2^m0 to 2^m1 s instead */
    double m0, m1;              /* m0 <= m1 */
    ss_engine engine;
    double accuracy;            /* TOL: the error of a coefficient is at most TOL x (largest |W| of its
                                   scale) + 16 DBL_EPSILON a^1/2 max|x|, with the 1/a norm
                                   16 DBL_EPSILON max|x|, and never less than the least step of a double */
    int rounded;                /* 1: ss_writer_new may use TOL for rounding */
    ss_norm norm;
    int admissible;             /* 1: h has its second term too: exp(i omega_c t) becomes
                                   exp(i omega_c t) - exp(-omega_c^2/2) */
    ss_detrend detrend;         /* the trend that is first subtracted from the record */
    int force;                  /* 1: compute also scales that the record does not resolve */
    int threads;                /* 1 ... SS_THREADS_MAX; the result does not depend on it */
    ss_progress progress;       /* called after every scale of a whole record, by one thread at a time */
} ss_morlet_opts;
extern const struct ss_morlet_ranges {
    ss_range rate;              /* [Hz] of the samples */
    ss_range center, voices, step, frequency, octave, accuracy;
    ss_range inverse_accuracy;  /* tol of ss_morlet_inverse */
} ss_morlet_ranges;
/* omega_c 6, 16 voices, step 0.25, l2, accuracy 1e-6, fmin and fmax by default, one thread.  Every function
 * takes NULL for these. */
void ss_morlet_opts_init(ss_morlet_opts *opts, size_t size);

typedef struct ss_scale {
    int j;                      /* a = 2^(j/V) */
    double m;                   /* j/V = log2 a */
    double a;                   /* [s] */
    double f;                   /* the label omega_c / (2 pi a) [Hz] */
    double b_num, b_den;        /* translation k is k * b_num / b_den [s] */
    size_t n;                   /* translations in the record */
    size_t offset;              /* the number of coefficients in w before those of this scale */
    ss_engine engine;           /* of a plan: what computes it; SS_ENGINE_AUTO: not known */
} ss_scale;

typedef struct ss_grid {
    size_t n_scales;
    const ss_scale *scale;      /* long to short */
    size_t total;               /* coefficients of all scales; 0: not known yet */
} ss_grid;

/* A plan: a grid for records of one length and rate.  A scale is usable under two conditions.  The
 * sampling resolves it: at the Nyquist frequency the spectrum of its wavelet is at most accuracy,
 * exp(-(a pi rate - omega_c)^2 / 2) <= accuracy.  The record is long enough: some translation lies
 * outside the cone of influence, 2 sqrt(2) a <= n / rate. */
typedef struct ss_morlet ss_morlet;

/* Make a plan for n samples.  FFTW's planner is not safe for threads: this library makes and frees
 * one plan at a time, and a program must not call FFTW's planner itself meanwhile.  SS_ESCALE: a
 * requested scale is not usable (and force is 0), or no scale is. */
ss_status ss_morlet_new(ss_morlet **out, size_t n, double rate, const ss_morlet_opts *opts,
                        ss_error *err);
/* The grid of a plan, owned by it.  NULL: the plan is NULL. */
const ss_grid *ss_morlet_grid(const ss_morlet *plan);

/* Transform the plan's n samples of x, which must be finite.  w is an array of 2 * total
 * doubles that the caller owns: re and im of coefficient c are w[2c] and w[2c + 1].  Several
 * threads may execute one plan at the same time. */
ss_status ss_morlet_execute(const ss_morlet *plan, const double *x, double *w, ss_error *err);

/* A sink receives the translations first ... first + n - 1, n >= 1, of a scale; those of one scale
 * come in order.  They are valid during the call only.  w is as in ss_morlet_execute, and samples
 * is the number of samples that ss_scale_edge needs.  A non-zero return ends the work with
 * SS_STOP. */
typedef int ss_coefficient_sink(const ss_scale *scale, size_t first, size_t n, const double *w,
                                size_t samples, void *user);
/* Send the same coefficients to a sink, one whole scale at a time, long to short, from the calling
 * thread.  The memory is that of as many scales as there are threads. */
ss_status ss_morlet_each(const ss_morlet *plan, const double *x, ss_coefficient_sink *sink,
                         void *user, ss_error *err);

/* Compute some of the coefficients w of x again, by the sum in full: each, 1 ...
 * 1e6, of every scale, at random places that are always the same.  *difference becomes the largest
 * difference relative to the largest |W| of its scale. */
ss_status ss_morlet_compare(const ss_morlet *plan, const double *x, const double *w, size_t each,
                            double *difference, ss_error *err);
void ss_morlet_free(ss_morlet *plan);                               /* NULL is allowed */

/* The time b of translation k [s] from the first sample.  If B is a fraction of samples, W is
 * computed at k B exactly, and this double lies within two roundings of it.  Else W is computed at
 * this double; but if this double is the rounded time n / rate of a sample, W is computed at that
 * sample. */
double ss_scale_b(const ss_scale *scale, size_t k);
/* 1 if translation k lies inside the cone of influence of a record of n samples: nearer than
 * sqrt(2) a to its first or last sample. */
int ss_scale_edge(const ss_scale *scale, size_t k, size_t n, double rate);

/* --- streams --------------------------------------------------------------------------------
 *
 * The transform of a signal whose length is not known.  Its memory is bounded by the logarithm of the
 * longest scale.  A coefficient is complete when the samples up to 8.5 a after b have arrived: any later
 * sample changes it by less than the rounding that accuracy allows.  So the accuracy is that of a whole record.
 *
 * Windows lie at fixed times and are computed when their last sample arrives.  So the coefficients
 * and their order depend on the samples and on the times at which the stream was drained.  They
 * depend neither on the number of samples that are pushed at a time nor on the number of threads.
 */

typedef struct ss_stream ss_stream;

/* Begin a stream.  The sink gets the scales in any order; their n and offset have no meaning.  A
 * scale may become longer than the record; then all its coefficients lie inside the cone of
 * influence.  SS_EINVAL: neither fmin nor octaves is given; or detrend or quadrature is, which are for whole
 * records.  SS_ESCALE: as ss_morlet_new, or a scale is shorter than half a sample. */
ss_status ss_stream_new(ss_stream **out, double rate, const ss_morlet_opts *opts,
                        ss_coefficient_sink *sink, void *user, ss_error *err);
const ss_grid *ss_stream_grid(const ss_stream *stream);             /* owned by the stream */
/* The largest delay of scale i in samples: without ss_stream_drain, a coefficient is sent before
 * so many samples after b have arrived.  0 if there is no scale i. */
size_t ss_stream_window(const ss_stream *stream, size_t i);

/* Append n samples.  When a window is full, the sink gets its complete coefficients.  SS_EINVAL: a
 * sample is not finite; those before it have been appended.  After a failure the stream only
 * reports this failure again. */
ss_status ss_stream_push(ss_stream *stream, const double *x, size_t n, ss_error *err);
/* Send all complete coefficients to the sink.  On a stepped grid this costs at least a few FFTs of
 * some 2048 points for each octave. */
ss_status ss_stream_drain(ss_stream *stream, ss_error *err);
/* The signal has ended and is zero from here on: send all other coefficients. */
ss_status ss_stream_end(ss_stream *stream, ss_error *err);
void ss_stream_free(ss_stream *stream);         /* NULL is allowed */

/* --- coefficients on their grid -------------------------------------------------------------- */

typedef struct ss_coefficients ss_coefficients;

/* Some of the coefficients of a scale, and room for them: either w or level is NULL. */
typedef struct ss_map_part {
    size_t scale, first, n;     /* translations first ... first + n - 1 */
    double *w;                  /* [2 n]: re and im of each */
    double *level;              /* [n]: |W| of each */
} ss_map_part;

/* Where coefficients are that are not all in memory: in a file, for example.  It begins the object that
 * knows this. */
typedef struct ss_map_source {
    /* Fill in n parts of the map, which are within its grid. */
    ss_status (*read)(const ss_coefficients *map, const ss_map_part part[], size_t n, ss_error *err);
    void (*free)(struct ss_map_source *source);
} ss_map_source;

/* A map: coefficients with their grid, as computed or as read back. */
struct ss_coefficients {
    ss_header *head;            /* the transformed column, rate, start and notes of its signal, and the
                                   options as notes: samples, column, unit, center, voices, step (or
                                   dense: yes), lattice (if B is a fraction of samples), norm,
                                   admissible, detrend, accuracy, method, and label, the formula of
                                   the frequencies */
    size_t n;                   /* samples of the record, > 0 */
    double center;              /* omega_c */
    size_t n_scales;            /* > 0 */
    ss_scale *scale;            /* long to short; each has n > 0 */
    double *w;                  /* as in ss_morlet_execute; NULL if they are not all in memory */
    ss_map_source *source;      /* has them, if w is NULL; it belongs to the map */
    ss_span *gap;               /* the gaps that head's note names, where samples were filled in; NULL
                                   if there are none */
    size_t n_gaps;
};

/* The simple case: transform one column of a signal.  The caller frees *out with
 * ss_coefficients_free. */
ss_status ss_morlet_transform(ss_coefficients **out, const ss_signal *signal, size_t column,
                       const ss_morlet_opts *opts, ss_error *err);
/* Read text or AU, told apart by the first bytes, of a record or of a stream that has ended.  The
 * reader may read more of in than it needs, and nothing may have been read from a pipe before.
 *
 * If in is NULL, name is the path of a file, also of HDF5.  That stays open until *out is freed: ss_map_read reads
 * its coefficients, in the memory of one scale, and w is NULL.  SS_EKIND: the file holds no coefficients. */
ss_status ss_coefficients_read(ss_coefficients **out, FILE *in, const char *name, ss_error *err);
void ss_coefficients_free(ss_coefficients *coefficients);           /* NULL is allowed */

/* Fill in n parts of a map, wherever it is.  SS_EINVAL: it has no such coefficients. */
ss_status ss_map_read(const ss_coefficients *map, const ss_map_part part[], size_t n, ss_error *err);

/* Compute the signal that has these coefficients, by conjugate gradients on the frame operator:
 * the least squares solution, with the weights of the integral over a and b.  It lacks the
 * frequencies below the lowest and above the highest label, and so a mean or a linear trend.
 *
 * *error, unless error is NULL, becomes an estimate of its rms error within the labels, relative
 * to its own rms: the part of the coefficients that the signal does not explain, times the square
 * root of the ratio of the grid's frame bounds there.  With steps above 0.5 the error beyond the
 * labels may be larger.
 *
 * SS_ESCALE: this ratio exceeds 100, so the grid is too coarse.  SS_ETOL: more than tol, 1e-12 ...
 * 0.1, of the coefficients is not explained, because they are those of no signal, or because 500
 * passes do not suffice.  SS_EDATA: the notes lack options, or scales are missing.  SS_STOP:
 * progress asked for it.  The cost is one to 500 passes, each a transform and its adjoint of about the
 * same cost, and some twelve numbers per sample of memory. */
ss_status ss_morlet_inverse(ss_signal **out, const ss_coefficients *coefficients, double tol,
                            double *error, ss_progress progress, ss_error *err);

/* Make the header of coefficients, of the header of their signal and the options.  n = 0: the
 * number of samples is not known yet, and the end of the text will give it. */
ss_status ss_coefficients_header(ss_header **out, const ss_header *signal, size_t column, size_t n,
                                 const ss_morlet_opts *opts, ss_error *err);

/* The largest |W| outside the cone of influence (or of all, if all lie inside): 0 dB of the contours.
 * NaN if they cannot be read. */
double ss_coefficients_max(const ss_coefficients *coefficients);

SS_END_DECLARATIONS
#endif
