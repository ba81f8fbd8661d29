/* stickslip/signal.h -- uniformly sampled signals of several columns, and their streams.
 *
 * stickslip-signal(5) describes the text, AU and the delimited text of other programs.  No signal
 * stores a column of time: the time of row i is start + i / rate. */
#ifndef STICKSLIP_SIGNAL_H
#define STICKSLIP_SIGNAL_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/number.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

typedef struct ss_column {
    char *name;                 /* "a"; it has no blanks */
    char *unit;                 /* "m/s^2"; "" if unknown */
} ss_column;

typedef struct ss_header {
    double rate;                /* [Hz] > 0; files have 1e-300 ... 1e300 */
    double start;               /* [s] time of row 0 on the source's clock */
    int has_time;               /* 1: the text has a column of time, t/s, as its first */
    size_t n_columns;           /* columns without the one of time */
    ss_column *column;
    size_t n_notes;
    char **note;                /* lines "key: value" of the source; no key is rate, start or columns */
} ss_header;

/* Build a header.  It copies every string; a string that is not valid UTF-8 is read as Latin-1. */
ss_status ss_header_new(ss_header **out, double rate, double start, ss_error *err);     /* has_time = 1 */
/* Append a column.  Blanks and slashes in its name become "_", and a repeated name gets the suffix
 * "_2", "_3", ...; unit may be NULL or "".  A first column t in s sets has_time, as readers would take it for the
 * time otherwise.  SS_EINVAL: there is no name. */
ss_status ss_header_add_column(ss_header *head, const char *name, const char *unit, ss_error *err);
/* Append a note; it replaces a note with the same key, and NULL as its value deletes that one.  Control characters
 * but tabs become blanks, in the key question marks.  SS_EINVAL: the key is rate, start, columns or empty, begins
 * with a blank or contains a colon.  Writers and readers of files take up to 4096 notes. */
ss_status ss_header_note(ss_header *head, const char *key, const char *value, ss_error *err);
/* The value of the note with this key, owned by head; NULL if there is none. */
const char *ss_header_find_note(const ss_header *head, const char *key);
void ss_header_free(ss_header *head);                                       /* NULL is allowed */

/* The index of the column with this name, or else of the column that name counts from 1; -1 if
 * there is none.  A blank or slash in name matches "_".  If no column matches, the only column
 * that differs by the case of letters does; but a name of one letter must match: a and A are two
 * quantities. */
int ss_header_column(const ss_header *head, const char *name);

/* Copy a header for a signal that has the n columns of these indices, in this order, or the first n if column is
 * NULL, and starts at the row first. */
ss_status ss_header_select(ss_header **out, const ss_header *head, const size_t *column, size_t n,
                           size_t first, ss_error *err);

/* The size of a unit of force, length or angle in N, m or rad, of which *dimension becomes 'N', 'm' or 'r'; as
 * *per_time says, it may be divided by s (1) or s^2 (2): mm/s.  0: it is no such unit. */
double ss_unit_size(const char *unit, char *dimension, int *per_time);

/* --- reading ------------------------------------------------------------------------------- */

/* The treatment of missing samples: cells that are empty or hold no finite number, and rows that
 * the time stamps skip. */
typedef enum ss_gaps {
    SS_GAPS_REFUSE,             /* they are an error */
    SS_GAPS_SPLIT,              /* they become 0, as a signal is outside its record */
    SS_GAPS_INTERPOLATE         /* they lie on a line between the samples beside them */
} ss_gaps;

/* A factor and a unit for one column, as the data sheet of a sensor gives them. */
typedef struct ss_calibration {
    const char *column;         /* its name or number; NULL: the only column */
    double scale;               /* factor of its values; 0: they stay as they are */
    const char *unit;           /* replaces the unit in the file; NULL: that stays */
} ss_calibration;

/* The i-th unit that ss_read_opts.time_unit may be: "s", "ms", ...; NULL after the last. */
const char *ss_time_unit_name(size_t i);

typedef struct ss_read_opts {
    size_t size;                /* set by ss_read_opts_init */
    const char *time;           /* delimited text and .npy: name or number of the column of time; NULL:
                                   the one named t, time, ..., or the first column if its unit is one
                                   of time, or if no column has a name and it ascends uniformly.
                                   Arrays in HDF5: path of the dataset of times, or its name in the
                                   group of the array, or a column of the array; NULL: none */
    double rate;                /* [Hz] for input without a clock; 0: the input must have a clock.  With
                                   delimited text the first row is then at 0, whatever its columns */
    ss_gaps gaps;               /* delimited text and arrays in HDF5; filled gaps become a note of the
                                   header, "gaps: from:to from:to ..." [s] */
    double resample;            /* [Hz] rate to which the rows are brought, by the cubic spline through each
                                   column, in constant memory; 0: they stay.  Stamps in delimited text may then
                                   have any spacing.  Frequencies above half the rate fold down.  Reading
                                   fails where there is but one row */
    const char *time_unit;      /* unit of the column or dataset of time, where there is one; NULL: the unit in
                                   the file, or if it has none seconds, or the unit with which the stamps
                                   are dates of this century */
    const char *const *needed;  /* delimited text: names or numbers of the n_needed columns that the caller
                                   uses.  In the others a cell without a number is 0, with a warning for
                                   each column, and no gap.  n_needed 0: all are needed */
    size_t n_needed;
    size_t table;               /* number of a table in delimited text, from 1; 0: the only one.  This and
                                   the options of a clock are refused where they mean nothing */
    double from, to;            /* [s] on the source's clock: only samples at from or later and before
                                   to are read; from >= to: all are */
    const char *folder;         /* folder of a temporary file; NULL: /var/tmp, or else /tmp */
    const ss_calibration *calibration;
    size_t n_calibrations;
    /* Called with one line of text about a decision that a user may not expect.  about is the status
     * whose remedy helps, or SS_OK.  NULL: no warnings. */
    void (*warn)(ss_status about, const char *text, void *user);
    void *user;                 /* passed to warn */
    ss_progress progress;       /* called while a file is read, with the part that is done; it cannot stop it */
    int stamps;                 /* 1: the time of each row [s] is a further column, the last.  Rows of a table
                                   may then have any spacing, unless they are resampled; the rate is that of
                                   their usual step */
    int rewinds;                /* 1: ss_reader_rewind works.  A source that cannot go back is read to its end
                                   when it is opened; more than 2^18 numbers of it are kept in a temporary file */
} ss_read_opts;
/* Fill in the defaults, all zeros; size is sizeof(ss_read_opts). */
void ss_read_opts_init(ss_read_opts *opts, size_t size);

/* The times t with from <= t < to, on the source's clock [s]. */
typedef struct ss_span {
    double from, to;
} ss_span;

typedef struct ss_reader ss_reader;

/* Open a stream of any format that stickslip-signal(5) describes; its first bytes tell which.  The
 * caller keeps and closes in.  The reader bypasses its buffer, so nothing may have been read from
 * a pipe before.  Messages call it by name.  opts may be NULL.
 *
 * Text and AU streams are read as they arrive, in constant memory.  So is delimited text from a pipe whose rate is
 * given, or whose first 16 stamps are numbers on a clock without rounding, unless gaps, resample or table are set.
 * Other delimited text and .npy are first read to their end, to check their clock.  If they have more than 2^18
 * numbers, these are kept in a temporary file, 8 bytes for each number and each row.  Memory grows with gaps only.
 *
 * If in is NULL, name is the path of a file, which the reader closes.  Of HDF5, "FILE" is /signal, as this library
 * writes it, and "FILE:/path/to/dataset" a real dataset of one or two dimensions, of MATLAB v7.3 files too; in
 * one of two dimensions the columns are the shorter one.  A dataset takes its clock from opts->rate or opts->time.
 * SS_EDATA: /signal has a clock, and opts ask for another; SS_EKIND: there is no /signal.  HDF5 is read chunk by
 * chunk, in constant memory. */
ss_status ss_reader_new(ss_reader **out, FILE *in, const char *name, const ss_read_opts *opts,
                        ss_error *err);
const ss_header *ss_reader_header(const ss_reader *reader);     /* owned by the reader */

/* Read at most max rows: the value of row i in column c becomes column[c][i].  NULL for a column: its
 * values are not wanted.  *n becomes the number of rows; SS_OK with *n = 0 is the end.  If some rows
 * have arrived, the call returns them and does not wait for more. */
ss_status ss_reader_rows(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err);
/* The rows to read at a time, fast and in half a megabyte: 4096, fewer if they have many columns, or one. */
size_t ss_reader_piece(const ss_reader *reader);
/* 1 if that call would wait for the source; 0 if a part of a row has arrived, or at the end. */
int ss_reader_waits(const ss_reader *reader);
void ss_reader_free(ss_reader *reader);         /* NULL is allowed */

/* Go back to the first row.  SS_EINVAL: it cannot, as ss_read_opts.rewinds was 0. */
ss_status ss_reader_rewind(ss_reader *reader, ss_error *err);

/* A whole signal in memory. */
typedef struct ss_signal {
    ss_header *head;
    size_t n;                   /* rows */
    double *values;             /* column after column: row i of column c is values[c * n + i] */
} ss_signal;

/* Read all rows of a stream or, if in is NULL, of a file, as ss_reader_new and ss_reader_rows do.  The caller
 * frees each signal that a function makes with ss_signal_free. */
ss_status ss_signal_read(ss_signal **out, FILE *in, const char *name, const ss_read_opts *opts,
                         ss_error *err);
/* Make a signal of n rows of zeros, with a copy of head. */
ss_status ss_signal_new(ss_signal **out, const ss_header *head, size_t n, ss_error *err);
/* Read the rows of a signal, which must live as long as the reader, and which can go back to the first; and make a
 * signal of the rows that a reader has left.  So a signal in memory is filtered, or gets noise. */
ss_status ss_reader_of_signal(ss_reader **out, const ss_signal *signal, ss_error *err);
ss_status ss_signal_of_reader(ss_signal **out, ss_reader *reader, ss_error *err);
void ss_signal_free(ss_signal *signal);         /* NULL is allowed */

/* --- formats --------------------------------------------------------------------------------- */

typedef enum ss_format {
    SS_TSV,                     /* text with tabs, of the fewest digits that give the same double */
    SS_AU,                      /* Sun AU with 64-bit floats and the header as its annotation */
    SS_CSV,                     /* for other programs: a line of names, then rows with commas */
    SS_H5,                      /* HDF5, which is no stream: see stickslip/store.h */
    SS_JSON,                    /* for other programs: an object a row; null is what is not known */
    SS_WAV                      /* signals of a rate in whole Hz, as 64-bit floats without names, start or notes */
} ss_format;

/* A format in which streams can be written. */
typedef struct ss_format_info {
    ss_format format;
    const char *name;           /* also the ending of its files: "tsv", "au", "csv", "json", "wav" */
    int has_words;              /* 0: it holds only numbers */
} ss_format_info;
/* Store the i-th of them in *out and return 1; 0: there are not so many. */
int ss_format_at(ss_format_info *out, size_t i);

/* --- filtering ----------------------------------------------------------------------------- */

typedef struct ss_filter_opts {
    size_t size;                /* set by ss_filter_opts_init */
    double low_pass, high_pass; /* [Hz] edges, at which half of the amplitude passes; 0: there is none */
    int order;                  /* -2 ... 4: > 0: of the derivative, < 0: of the integral, 0: neither */
    double stop;                /* [dB] <= 160, what the stop bands are below the pass band at least */
} ss_filter_opts;
/* No edges, order 0, 80 dB. */
void ss_filter_opts_init(ss_filter_opts *opts, size_t size);

/* Make a reader that is at its first row give its rows filtered, differentiated or integrated, all columns alike,
 * by an FIR filter of linear phase that shifts nothing in time, in memory and with a delay in proportion to its
 * length.
 *
 * A low-pass passes up to 0.8 and stops from 1.2 times its edge on, a high-pass the other way round; the
 * transition of an edge above 0.42 times the rate ends at half the rate.  What passes is true to 1e-3 dB; of a
 * derivative or an integral this holds relative to its exact value at each frequency, up to 0.45 times the rate if
 * there is no low-pass.  Rows at both ends that the filter cannot know are not given: 6.5 periods of the lowest
 * edge with 80 dB.  An integral without a high-pass is a sum that begins with 0 and drifts with the mean.  Units
 * change with the order, and the note filter, "flat LO to HI Hz, stop DB dB ...", says what passed; gaps become
 * wider by the reach of the filter.
 *
 * SS_EINVAL: an edge is not below half the rate, no frequency passes, or the filter has more than 2^24 taps; the
 * reader is then as it was.  Reading fails with SS_EDATA where there are fewer rows than taps, and with SS_ERANGE
 * if a value is not finite. */
ss_status ss_reader_filter(ss_reader *reader, const ss_filter_opts *opts, ss_error *err);

/* --- making and changing ------------------------------------------------------------------- */

typedef enum ss_wave {
    SS_SINE,        /* A cos(2 pi f (t - at)) */
    SS_IMPULSE,     /* A in the sample nearest to at, elsewhere 0 */
    SS_STEP,        /* 0 before at, then A */
    SS_CHIRP,       /* A cos(phase), whose frequency goes linearly from f to f_end */
    SS_RINGDOWN,    /* 0 before at, then A exp(-s (t - at)) cos(w (t - at)); see damping */
    SS_NOISE        /* Gaussian white noise of standard deviation A */
} ss_wave;

typedef struct ss_wave_opts {
    size_t size;                /* set by ss_wave_opts_init */
    double rate;                /* [Hz] 1e-300 ... 1e300 */
    double duration;            /* [s] >= 0: round(duration * rate) samples */
    double amplitude;           /* A */
    double frequency;           /* f [Hz] >= 0; of a ringdown the damped one, w = 2 pi f */
    double frequency_end;       /* f_end [Hz] at the end of the record; chirp only */
    double damping;             /* damping ratio s / sqrt(w^2 + s^2) in [0, 1); ringdown only */
    double at;                  /* [s] */
    unsigned long seed;         /* noise only; the same seed gives the same noise */
} ss_wave_opts;
/* 2000 Hz, 10 s, A = 1, f = 10, seed 1. */
void ss_wave_opts_init(ss_wave_opts *opts, size_t size);

/* Make a benchmark signal with one column, a, without a unit.  Phases are exact to 1e-15 cycles in
 * a record of any length.  SS_ERANGE: a value or a phase is larger than a double can hold.
 * opts may be NULL. */
ss_status ss_wave_new(ss_signal **out, ss_wave wave, const ss_wave_opts *opts, ss_error *err);

enum { SS_BITS_MAX = 52 };

typedef struct ss_noise_opts {
    size_t size;                /* set by ss_noise_opts_init */
    double snr;                 /* [dB] the power of each column's noise is so much below the column's variance; */
    double rms;                 /* or its standard deviation is this, >= 0.  NaN: not given */
    ss_range band;              /* [Hz] 0 <= from <= to <= rate / 2: the noise has only these frequencies, and
                                   exactly this power; NaN: it is white */
    unsigned long seed;         /* the same seed gives the same noise (GSL's mt19937 and its Ziggurat) */
    int bits;                   /* 1 ... SS_BITS_MAX: then each value becomes the output of a converter of so
                                   many bits: the nearest multiple of the step range / 2^(bits - 1) (halfway the
                                   even one), at least -range and at most range less one step; 0: there is no
                                   converter */
    double range;               /* > 0, of the converter */
    const size_t *column;       /* n_columns indices of those that are changed; n_columns 0: all */
    size_t n_columns;
} ss_noise_opts;
/* Neither noise nor converter, seed 1. */
void ss_noise_opts_init(ss_noise_opts *opts, size_t size);

/* What was done. */
typedef struct ss_noise_done {
    size_t converted, clipped;  /* samples, as rows are read, that went through the converter, and those beyond its
                                   range among them; 0 after going back */
    double *rms;                /* set by the caller: NULL, or room for the rms of each column's noise, which is
                                   known before rows are read; NaN for one that gets none */
} ss_noise_done;

/* Make a reader that is at its first row give its rows with noise added, as a converter gives them, or both in
 * this order; *done must live as long as the reader.  The notes noise and converter say so.  A ratio takes one
 * reading more, so the reader must be one that can go back; with a band all rows are read into memory.  SS_EINVAL:
 * an option is out of its range, no frequency of the record lies in the band, or the reader cannot go back; it is
 * then as it was.  Reading fails with SS_ERANGE if a sum is not finite. */
ss_status ss_reader_noise(ss_reader *reader, const ss_noise_opts *opts, ss_noise_done *done, ss_error *err);

SS_END_DECLARATIONS
#endif
