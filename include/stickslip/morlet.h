/* stickslip/morlet.h -- Morlet wavelet coefficients of a sampled signal.
 *
 * With t in seconds from the first sample and h(t) = pi^-1/4 exp(i omega_c t) exp(-t^2/2),
 *
 *     W(a, b) = a^-1/2 (1/rate) sum_n x_n conj h((n/rate - b) / a),
 *
 * the signal being zero outside the record.  Scales are a = 2^(j/V) s, j an integer, V voices an
 * octave; translations are b = n B (stepped) or n / rate (dense), from the first sample.
 *
 * B is the largest step of 2^p/m samples that does not exceed B_0 a: p is an integer, and m one of
 * 1 3 5 7 9 15 21 25 35 45, at most 17/B_0.  Short FFTs give these translations.  B is B_0 a itself
 * if exact is asked for, if B_0 > 1, and if V is 1 and B_0 a a power of two, as on the paper's
 * dyadic grid.
 *
 * A scale is labelled with the frequency f = omega_c / (2 pi a).  With the 1/a norm a steady sinusoid
 * has its largest |W| at its own frequency; with the a^-1/2 norm that label is lower by the factor
 * 2 omega_c / (omega_c + sqrt(omega_c^2 + 2)), 1.35 % at omega_c = 6. */
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
    SS_ENGINE_AUTO,             /* the cheapest one that keeps the accuracy */
    SS_ENGINE_QUADRATURE,       /* the definition, wavelet truncated as far as accuracy allows */
    SS_ENGINE_FFT               /* spectra, by FFTW; the definition for forced scales that are
                                   narrower than two samples or longer than some ten records */
} ss_engine;

/* The effort of FFTW to find a fast FFT.  A measured FFT is up to twice as fast, but measuring may take
 * seconds for each length of a plan, and its choice may differ from run to run, and with it the last
 * bits of results; but see ss_wisdom_read. */
typedef enum ss_planner { SS_PLANNER_ESTIMATE, SS_PLANNER_MEASURE, SS_PLANNER_PATIENT } ss_planner;

typedef struct ss_morlet_opts {
    double center;              /* omega_c */
    int voices;                 /* V, scales an octave */
    double step;                /* B_0, translation step in units of the scale; unused if dense */
    int exact;                  /* 1: translations are n B_0 a, which costs some 15 times more */
    int dense;                  /* 1: one coefficient a sample at every scale */
    double fmin, fmax;          /* [Hz] scales labelled fmin to fmax; 0: the default, see below */
    int octaves;                /* 1: scales from 2^m0 to 2^m1 s instead */
    double m0, m1;              /* m0 <= m1 */
    ss_engine engine;
    double accuracy;            /* TOL: the error of the sum is at most TOL x (largest
                                   |W| of its scale) + 16 DBL_EPSILON a^1/2 max|x|, with the
                                   1/a norm 16 DBL_EPSILON max|x|; or the least step of a double,
                                   where that is more */
    int rounded;                /* 1: 7/8 of TOL are left for ss_store_writer, which rounds */
    ss_norm norm;
    int admissible;             /* 1: keep the second term of h, -exp(-omega_c^2/2) in place of 0 */
    ss_detrend detrend;         /* the trend that is subtracted from the record first */
    int force;                  /* 1: scales that sampling or record do not resolve, too */
    int threads;                /* 1 ... SS_THREADS_MAX; the result does not depend on it */
    ss_planner planner;
    ss_progress progress;       /* called after every scale of a whole record, by one thread at a time */
} ss_morlet_opts;
extern const struct ss_morlet_ranges {
    ss_range rate;              /* [Hz] of the samples */
    ss_range center, voices, step, frequency, octave, accuracy;
    ss_range inverse_accuracy;  /* tol of ss_morlet_inverse */
} ss_morlet_ranges;
/* omega_c 6, 16 voices, step 0.25, l2, accuracy 1e-6.  By default fmin is 4 cycles a record (or
 * the lowest usable frequency, if that is higher), fmax the highest usable one. */
extern const ss_morlet_opts ss_morlet_defaults;

typedef struct ss_scale {
    int j;                      /* a = 2^(j/V) */
    double m;                   /* j/V = log2 a */
    double a;                   /* [s] */
    double f;                   /* omega_c / (2 pi a) [Hz] */
    double b_num, b_den;        /* translation k is k * b_num / b_den [s] */
    size_t n;                   /* translations in the record */
    size_t offset;              /* of its first coefficient in w, counted in coefficients */
} ss_scale;

/* Usable scales: sampling resolves a if the spectrum of the wavelet at Nyquist is below accuracy,
 * exp(-(a pi rate - omega_c)^2 / 2) <= accuracy; the record is long enough if some translation
 * lies outside the cone of influence, 2 sqrt(2) a <= n / rate. */
typedef struct ss_morlet ss_morlet;     /* a plan: a grid for records of one length and rate */

/* FFTW's planner is not safe for threads.  Plans are made and freed one at a time here; a program that
 * calls FFTW's planner itself must not do so at the same time.  SS_ESCALE: a requested scale is not
 * usable (unless force), or no scale is. */
ss_status ss_morlet_new(ss_morlet **out, size_t n, double rate, const ss_morlet_opts *opts,
                        ss_error *err);
/* The measurements of FFTW's planner in this process, which are FFTW's own state.  After reading them,
 * plans for the same lengths are made at once, with any planner, and are always the same.  SS_EINVAL
 * if in holds no wisdom of this FFTW and machine (less than 16 MB), SS_ENOMEM, SS_EIO. */
ss_status ss_wisdom_read(FILE *in, ss_error *err);
ss_status ss_wisdom_write(FILE *out);
size_t ss_morlet_scales(const ss_morlet *plan);                     /* long to short */
const ss_scale *ss_morlet_scale(const ss_morlet *plan, size_t i);   /* an array that the plan owns */
ss_engine ss_morlet_engine(const ss_morlet *plan, size_t i);        /* that computes scale i */
size_t ss_morlet_total(const ss_morlet *plan);                      /* coefficients over all scales */

/* Transform the plan's n samples of x, which must be finite, into w: re, im of coefficient c at
 * w[2c], w[2c + 1], 2 * ss_morlet_total doubles owned by the caller.  A plan may be executed by
 * several threads at once. */
ss_status ss_morlet_execute(const ss_morlet *plan, const double *x, double *w, ss_error *err);

/* Receives translations first ... first + n - 1, n >= 1, of a scale, each scale's in order, valid
 * during the call only: w as in ss_morlet_execute, the edge as ss_scale_edge gives it for samples.
 * A non-zero return ends the work with SS_STOP. */
typedef int ss_coefficient_sink(const ss_scale *scale, size_t first, size_t n, const double *w,
                                size_t samples, void *user);
/* The same coefficients to a sink, a whole scale at a time, long to short, by the calling thread: in
 * memory of as many scales as there are threads, whatever the grid. */
ss_status ss_morlet_each(const ss_morlet *plan, const double *x, ss_coefficient_sink *sink,
                         void *user, ss_error *err);

/* Recompute coefficients w of x, each scale's chosen at random (always the same), with the engine
 * that did not compute them, where there are two: the largest difference relative to the largest
 * |W| of its scale.  each: coefficients a scale, 1 ... 1e6. */
ss_status ss_morlet_compare(const ss_morlet *plan, const double *x, const double *w, size_t each,
                            double *difference, ss_error *err);
void ss_morlet_free(ss_morlet *plan);                               /* NULL is allowed */

typedef struct ss_point {
    double a, b;                /* scale and translation [s] */
} ss_point;

/* W at one point by the definition, as exactly as double precision allows, in opts' convention
 * (its grid fields and its accuracy are not used; detrend is).  a > 0, b within the record. */
ss_status ss_morlet_point(const double *x, size_t n, double rate, const ss_morlet_opts *opts,
                          ss_point at, double w[2], ss_error *err);

/* b of translation k [s] from the first sample.  W is taken at k B exactly where B is a fraction of
 * samples, of which this is the nearest double but one; else at this double, except that one which
 * is the time n / rate of a sample, rounded, stands for that sample. */
double ss_scale_b(const ss_scale *scale, size_t k);
/* 1 inside the cone of influence of a record of n samples: nearer than sqrt(2) a to an end, the
 * ends being the first and the last sample. */
int ss_scale_edge(const ss_scale *scale, size_t k, size_t n, double rate);

/* --- streams --------------------------------------------------------------------------------
 *
 * The transform of a signal whose length is not known.  Its memory is bounded by the longest scale,
 * on a stepped grid by the logarithm of that.  A coefficient is complete when the samples up to 8.5
 * a after b have arrived: later samples, however large, change it by less than the floor of the
 * accuracy.  So the promise for a whole record holds, even against the largest |W| of the scale so
 * far.
 *
 * Windows lie at fixed times and are computed with their last sample.  So the coefficients and their
 * order depend on the samples and on where the stream was drained, not on how many samples were
 * pushed at a time nor on the number of threads. */

typedef struct ss_stream ss_stream;

/* The sink gets scales in any order; their n and offset mean nothing.  SS_EINVAL: neither fmin nor
 * octaves is given, or detrend is, which needs the whole record.  A scale may be longer than the record
 * will be: all its coefficients then lie inside the cone of influence. */
ss_status ss_stream_new(ss_stream **out, double rate, const ss_morlet_opts *opts,
                        ss_coefficient_sink *sink, void *user, ss_error *err);
size_t ss_stream_scales(const ss_stream *stream);                   /* long to short */
const ss_scale *ss_stream_scale(const ss_stream *stream, size_t i); /* an array that it owns */
size_t ss_stream_samples(const ss_stream *stream);                  /* so far */
/* Without ss_stream_drain a coefficient of scale i comes less than so many samples behind b; 0 if there
 * is no scale i. */
size_t ss_stream_window(const ss_stream *stream, size_t i);

/* Append n samples.  When a window is full, the sink gets its complete coefficients.  SS_EINVAL: a
 * sample is not finite; those before it have been appended.  After a failure the stream only reports
 * it again. */
ss_status ss_stream_push(ss_stream *stream, const double *x, size_t n, ss_error *err);
/* Send all complete coefficients to the sink.  A stepped grid costs at least a few FFTs of some 2048
 * points an octave for that. */
ss_status ss_stream_drain(ss_stream *stream, ss_error *err);
/* Send all the rest: the signal has ended, and is zero from here on. */
ss_status ss_stream_end(ss_stream *stream, ss_error *err);
void ss_stream_free(ss_stream *stream);         /* NULL is allowed */

/* --- coefficients on their grid -------------------------------------------------------------- */

/* Coefficients with their grid, as computed or as read back. */
typedef struct ss_coefficients {
    ss_header *head;            /* the one column transformed, rate, start and notes of its signal,
                                   and the options as notes: samples, column, unit, center, voices,
                                   step (or dense: yes), lattice (if B is a fraction of samples),
                                   norm, admissible, detrend, accuracy, method, and label, the
                                   formula of the frequencies */
    size_t n;                   /* samples of the record, > 0 */
    double center;              /* omega_c */
    size_t n_scales;            /* > 0 */
    ss_scale *scale;            /* long to short; each has n > 0 */
    double *w;                  /* re, im; NULL where only the grid is known */
    ss_span *gap;               /* where others stand in for samples, from head's note, or NULL */
    size_t n_gaps;
} ss_coefficients;

/* The simple case: transform one column of a signal. */
ss_status ss_morlet_transform(ss_coefficients **out, const ss_signal *signal, size_t column,
                       const ss_morlet_opts *opts, ss_error *err);
ss_status ss_coefficients_write(const ss_coefficients *coefficients, FILE *out, ss_format format,
                                ss_error *err);
/* Text or AU, recognised by its first bytes, of a record or a stream that has come to its end.  Reads
 * past what it needs: nothing may have been read from a pipe before. */
ss_status ss_coefficients_read(ss_coefficients **out, FILE *in, const char *name, ss_error *err);
void ss_coefficients_free(ss_coefficients *coefficients);           /* NULL is allowed */

/* 1 inside the cone of influence, and as near to a gap or in it, else 0: translation k of scale i. */
int ss_coefficients_edge(const ss_coefficients *coefficients, size_t i, size_t k);

/* The signal that has these coefficients, by conjugate gradients on the frame operator: least squares
 * in the coefficients, weighted as the integral over a and b weights them.  It lacks the frequencies
 * below the lowest and above the highest label, and so a mean or a line.
 *
 * *error, unless that is NULL, becomes about its root mean square error within the labels, relative to
 * its own root mean square: the part of the coefficients that it does not explain, times the square
 * root of the ratio of the grid's frame bounds there.  With steps above 0.5 the error beyond the labels
 * may be larger.
 *
 * SS_ESCALE: the ratio exceeds 100, the grid is too coarse.  SS_ETOL: more than tol, 1e-12 ... 0.1, of
 * the coefficients stays unexplained, so that they are those of no signal, or is left after 500 passes.
 * SS_EDATA: notes lack options, or scales are missing.  SS_STOP if progress asks for it.  The cost is
 * three to 500 transforms and as many adjoints by the sum. */
ss_status ss_morlet_inverse(ss_signal **out, const ss_coefficients *coefficients, double tol,
                            double *error, ss_progress progress, ss_error *err);

/* Write coefficients as they arrive.  The header has the column's signal and the options; n = 0: the
 * number of samples is not known yet, and end writes it. */
ss_status ss_coefficients_header(ss_header **out, const ss_header *signal, size_t column, size_t n,
                                 const ss_morlet_opts *opts);
typedef struct ss_coefficient_writer ss_coefficient_writer;
ss_status ss_coefficient_writer_new(ss_coefficient_writer **out_writer, FILE *out, ss_format format,
                                    const ss_header *head, ss_error *err);
/* The arguments of a sink.  SS_EIO if out refuses the rows. */
ss_status ss_coefficient_writer_rows(ss_coefficient_writer *writer, const ss_scale *scale,
                                     size_t first, size_t n, const double *w, size_t samples);
/* Flushes. */
ss_status ss_coefficient_writer_end(ss_coefficient_writer *writer, size_t samples);
void ss_coefficient_writer_free(ss_coefficient_writer *writer);     /* NULL is allowed */

/* A source of coefficients that are not all in memory at a time: fills in those of scale i. */
typedef ss_status ss_coefficient_source(size_t i, double *w, void *user, ss_error *err);

/* Largest |W| outside the cone of influence (of all, if all lie inside): 0 dB of the contours. */
double ss_coefficients_max(const ss_coefficients *coefficients);

SS_END_DECLARATIONS
#endif
