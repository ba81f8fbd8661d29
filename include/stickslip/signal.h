/* stickslip/signal.h -- uniformly sampled signals of several columns, and their streams.
 *
 * Text, AU and delimited text are described in stickslip-signal(5).  A column of time is never
 * stored: the time of row i is start + i / rate. */
#ifndef STICKSLIP_SIGNAL_H
#define STICKSLIP_SIGNAL_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/number.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

typedef struct ss_column {
    char *name;                 /* "a"; no blanks */
    char *unit;                 /* "m/s^2"; "" if unknown */
} ss_column;

typedef struct ss_header {
    double rate;                /* [Hz] > 0 */
    double start;               /* time of row 0 on the source's clock [s] */
    int has_time;               /* 1: the text form carries a column of time, t/s, first */
    size_t n_columns;           /* without time */
    ss_column *column;
    size_t n_notes;
    char **note;                /* "key: value" lines of the source, passed on; never rate, start, columns */
} ss_header;

/* Build a header.  Every string is copied; one that is not valid UTF-8 is read as Latin-1.  NULL: no
 * memory. */
ss_header *ss_header_new(double rate, double start);        /* has_time = 1 */
ss_header *ss_header_copy(const ss_header *head);
/* Append a column.  Blanks and slashes in its name become "_", and a repeated name gets the suffix
 * "_2", "_3", ...; unit may be NULL or "".  SS_EINVAL: no name. */
ss_status ss_header_add_column(ss_header *head, const char *name, const char *unit);
/* Append a note; it replaces a note with the same key.  Newlines become blanks.
 * SS_EINVAL: the key is rate, start, columns or empty, begins with a blank or has a colon in it. */
ss_status ss_header_note(ss_header *head, const char *key, const char *value);
const char *ss_header_find_note(const ss_header *head, const char *key);    /* its value, or NULL */
void ss_header_free(ss_header *head);                                       /* NULL is allowed */

/* The index of a column given by name, or by its number counted from 1; -1 if there is none.
 * Blanks and slashes in the given name match "_".  If no name matches, the only one that differs in
 * the case of letters does, except for a single letter: a and A are two quantities. */
int ss_header_column(const ss_header *head, const char *name);

/* The first row at time t or after it (by no more than 1e-6 sample periods before it), from 0. */
size_t ss_header_row(const ss_header *head, double t);

/* A copy with the n columns given by their index, in that order, that starts at row first. */
ss_status ss_header_select(ss_header **out, const ss_header *head, const size_t *column, size_t n,
                           size_t first);

/* --- reading ------------------------------------------------------------------------------- */

/* The treatment of missing samples: cells that are empty or hold no finite number, and rows that the
 * time stamps skip. */
typedef enum ss_gaps {
    SS_GAPS_REFUSE,             /* an error */
    SS_GAPS_SPLIT,              /* 0, the value of the signal outside its record */
    SS_GAPS_INTERPOLATE         /* on the line between their neighbours */
} ss_gaps;

/* A factor and a unit for one column, as of a sensor's sheet. */
typedef struct ss_calibration {
    const char *column;         /* by name or number; NULL: the only one */
    double scale;               /* its values are multiplied by this; 0: they are not */
    const char *unit;           /* in place of the file's own; NULL: that stays */
} ss_calibration;

/* The i-th unit that ss_read_opts.time_unit may be: "s", "ms", ...; NULL after the last. */
const char *ss_time_unit_name(size_t i);

/* All zeros are the defaults. */
typedef struct ss_read_opts {
    const char *time;           /* delimited text and .npy: column of time by name or number; NULL: found by
                                   its name (t, time, ...), or the first column if its unit is one of
                                   time, or if no column has a name and it ascends uniformly */
    double rate;                /* [Hz] for input without a clock; 0: the input must have one.  With
                                   delimited text the first row is then at 0, whatever its columns */
    ss_gaps gaps;               /* delimited text and arrays in HDF5; where they are filled the header
                                   gets a note, see ss_header_gaps */
    double resample;            /* [Hz] delimited text: stamps of any spacing to a clock of this rate,
                                   by cubic splines; 0: the stamps must be uniform */
    const char *time_unit;      /* delimited text: the unit of the column of time; NULL: its own unit,
                                   without one seconds, or what makes them a date of this century */
    size_t table;               /* delimited text of several tables: which, from 1; 0: it has one */
    double from, to;            /* [s] only samples at from or later and before to, on the source's
                                   clock; from >= to: all */
    const ss_calibration *calibration;
    size_t n_calibrations;
    /* Called with one line of text about a decision that a user may not expect; about: the status whose
     * remedy helps, or SS_OK.  NULL: no warnings. */
    void (*warn)(ss_status about, const char *text, void *user);
    void *user;                 /* passed to it */
} ss_read_opts;

/* A time from ... to before to, on the source's clock [s]. */
typedef struct ss_span {
    double from, to;
} ss_span;

/* Where samples were missing, in time order: the note "gaps: from:to from:to ...", from the first
 * sample missing to the first that is there again.  *out is to be freed with free(). */
ss_status ss_header_gaps(ss_span **out, size_t *n, const ss_header *head);
/* 1 if t lies in one of the n gaps, in time order, or nearer than margin to one, else 0. */
int ss_gaps_near(const ss_span *gap, size_t n, double t, double margin);

typedef struct ss_reader ss_reader;

/* Open a stream of any of the three kinds, recognised by its first bytes.  The reader does not own
 * in, but bypasses its buffer, so nothing may have been read from a pipe before.  name is the name of
 * the file in messages.  opts may be NULL.  Text and AU streams are read as they arrive, in constant
 * memory.  Delimited text is read completely first, to check its clock: a file then once more, in constant
 * memory too; a pipe, or one with samples missing, uneven stamps or several tables, is held. */
ss_status ss_reader_new(ss_reader **out, FILE *in, const char *name, const ss_read_opts *opts,
                        ss_error *err);
const ss_header *ss_reader_header(const ss_reader *reader);

/* Read up to max rows of n_columns values each, one row after the other, into rows.  *n = 0 with
 * SS_OK is the end.  It may return fewer than max: it does not wait if some rows have arrived. */
ss_status ss_reader_rows(ss_reader *reader, double *rows, size_t max, size_t *n, ss_error *err);
/* 1 if that call would wait for the source; 0 if a part of a row has arrived, or at the end. */
int ss_reader_waits(const ss_reader *reader);
void ss_reader_free(ss_reader *reader);         /* NULL is allowed */

/* A whole signal in memory. */
typedef struct ss_signal {
    ss_header *head;
    size_t n;                   /* rows */
    double *values;             /* column after column: values[c * n + i] */
} ss_signal;

ss_status ss_signal_read(ss_signal **out, FILE *in, const char *name, const ss_read_opts *opts,
                         ss_error *err);
/* n rows of zeros under a copy of head. */
ss_status ss_signal_new(ss_signal **out, const ss_header *head, size_t n);
/* A copy of some columns, in the order given by their index, and of the rows [first, end). */
ss_status ss_signal_select(ss_signal **out, const ss_signal *signal, const size_t *column,
                           size_t n_columns, size_t first, size_t end, ss_error *err);
void ss_signal_free(ss_signal *signal);         /* NULL is allowed */

/* --- writing ------------------------------------------------------------------------------- */

typedef enum ss_format {
    SS_TSV,                     /* text, tab-separated, fewest digits that read back the same */
    SS_AU,                      /* Sun AU, 64-bit float, the header in its annotation */
    SS_CSV                      /* a line of names, commas between cells, nothing else: for other programs */
} ss_format;

/* The name of the i-th format that can be written, which is also the ending of its files: "tsv", "au",
 * "csv"; NULL after the last. */
const char *ss_format_name(size_t i);
/* 1 and the format of that name, or 0 where none can be written. */
int ss_format_find(ss_format *found, const char *name);
int ss_format_has_words(ss_format format);     /* 1; 0: it holds numbers only, or cannot be written */

typedef struct ss_writer ss_writer;

/* Start a stream on out, which the writer does not own, with its header; head is copied.
 * SS_EINVAL: AU is limited to 4096 columns and a header of 1 MiB. */
ss_status ss_writer_new(ss_writer **out_writer, FILE *out, ss_format format, const ss_header *head,
                        ss_error *err);
/* Append n rows of n_columns values each, one row after the other; SS_EIO if out refuses them. */
ss_status ss_writer_rows(ss_writer *writer, const double *rows, size_t n);
/* Flush out: SS_EIO if any write failed. */
ss_status ss_writer_flush(ss_writer *writer);
void ss_writer_free(ss_writer *writer);         /* NULL is allowed; does not flush */

ss_status ss_signal_write(const ss_signal *signal, FILE *out, ss_format format, ss_error *err);

/* A copy at another rate [Hz], by the cubic spline through each column: frequencies above half the
 * new rate must have been filtered out before.  SS_EINVAL: fewer than two rows, or no rate; SS_ERANGE:
 * the spline exceeds what a double holds. */
ss_status ss_signal_resample(ss_signal **out, const ss_signal *signal, double rate, ss_error *err);

/* --- making and changing ------------------------------------------------------------------- */

typedef enum ss_wave {
    SS_SINE,        /* A cos(2 pi f (t - at)) */
    SS_IMPULSE,     /* A in the sample nearest to at, else 0 */
    SS_STEP,        /* A from at on, else 0 */
    SS_CHIRP,       /* A cos of a phase whose frequency goes linearly from f to f_end */
    SS_RINGDOWN,    /* A exp(-s (t - at)) cos(w (t - at)) from at on, else 0; see damping */
    SS_NOISE        /* Gaussian white noise of standard deviation A */
} ss_wave;

typedef struct ss_wave_opts {
    double rate;                /* [Hz] > 0 */
    double duration;            /* [s] >= 0: round(duration * rate) samples */
    double amplitude;           /* A */
    double frequency;           /* f [Hz] >= 0, damped: w = 2 pi f */
    double frequency_end;       /* f_end [Hz] at the end of the record, chirp only */
    double damping;             /* damping ratio s / sqrt(w^2 + s^2) in [0, 1), ringdown only */
    double at;                  /* [s] */
    unsigned long seed;         /* noise only */
} ss_wave_opts;
extern const ss_wave_opts ss_wave_defaults;     /* 2000 Hz, 10 s, A = 1, f = 10, seed 1 */

/* A benchmark signal of one column, a, without unit.  Phases are exact to 1e-15 cycles in a record of
 * any length.  SS_ERANGE: a value or a phase exceeds what a double holds. */
ss_status ss_wave_new(ss_signal **out, ss_wave wave, const ss_wave_opts *opts, ss_error *err);

/* Add Gaussian white noise of standard deviation rms to the n values of x; the same seed gives the
 * same noise (GSL's mt19937 and its Ziggurat).  rms >= 0. */
ss_status ss_noise_add_once(double *x, size_t n, double rms, unsigned long seed);
/* The same piece by piece, for several columns: to n rows, value c of row i at
 * x[i * row + c * column], noise of standard deviation rms[c] >= 0 (no number is drawn where it is 0).
 * SS_ERANGE, here and below, if a sum is not finite; x has been changed then. */
typedef struct ss_noise ss_noise;
ss_status ss_noise_new(ss_noise **out, unsigned long seed);
ss_status ss_noise_add(ss_noise *noise, double *x, size_t n, size_t row, size_t n_columns, size_t column,
                  const double *rms);
/* Noise of the frequencies in band [Hz] only, 0 <= from <= to <= rate / 2, to n samples of one column;
 * the added noise has exactly this rms.  SS_EINVAL if the record has no frequency in the band. */
ss_status ss_noise_add_band(ss_noise *noise, double *x, size_t n, double rate, ss_range band,
                            double rms, ss_error *err);
void ss_noise_free(ss_noise *noise);            /* NULL is allowed */
/* The rms of a noise that is snr_db below the variance of x about its mean. */
double ss_noise_rms(const double *x, size_t n, double snr_db);

/* x after a converter of so many bits, whose input spans -range to range: multiples of the step
 * range / 2^(bits - 1), the nearest (of two the even one), clipped to -range and to one step below
 * range.  Those clipped are added to *clipped, which may be NULL.  SS_EINVAL: bits are not 1 ...
 * SS_BITS_MAX, or range is not positive. */
enum { SS_BITS_MAX = 52 };
ss_status ss_samples_quantise(double *x, size_t n, int bits, double range, size_t *clipped,
                              ss_error *err);

SS_END_DECLARATIONS
#endif
