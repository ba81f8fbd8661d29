/* stream.h -- what the readers and writers of signals share. */
#ifndef STREAM_H
#define STREAM_H

#include <stdint.h>
#include <stdio.h>
#include <stickslip/signal.h>

/* More than any honest input has, so that hostile input finds an end of memory and time. */
enum { MAX_LINE = 1 << 24, MAX_COLUMNS = 1 << 15, MAX_NOTES = 4096 };

/* Bytes of a stream, as they come: never waits for more than is asked for. */
struct input {
    FILE *file;
    const char *name;           /* in messages; owned */
    char *buffer;
    size_t capacity, lo, hi;    /* what is there is buffer[lo ... hi) */
    size_t scanned;             /* no newline before this */
    int ended;
    unsigned long line;         /* of the line read last, from 1 */
};
ss_status ss_input_open(struct input *in, FILE *file, const char *name, ss_error *err);
void ss_input_close(struct input *in);
/* Have n bytes in the buffer, or all that there are until the end. */
ss_status ss_input_need(struct input *in, size_t n, ss_error *err);
/* The next line, without its end and with a NUL behind it, valid until the next call; *length = 0
 * and *line = NULL at the end of the stream. */
ss_status ss_input_line(struct input *in, char **line, size_t *length, ss_error *err);
/* The first line, which must be magic: a list of what stands in the stream. */
ss_status ss_input_begin(struct input *in, const char *magic, const char *what, ss_error *err);
/* The next line of text that is not blank, as ss_input_line gives it; *line = NULL at the end. */
ss_status ss_input_row(struct input *in, char **line, ss_error *err);
/* The finite number that *text begins with; *text moves behind it and the blanks or comma after it.
 * SS_EDATA, with the line: not what is expected there. */
ss_status ss_input_number(const struct input *in, const char **text, const char *expected, double *x,
                          ss_error *err);
int ss_input_has_line(struct input *in);           /* is a whole line in the buffer? */
int ss_input_waits(const struct input *in);        /* would more bytes have to be waited for? */

typedef ss_status read_rows(ss_reader *reader, double *rows, size_t max, size_t *n, ss_error *err);
struct ss_reader {
    struct input in;
    ss_header *head;
    read_rows *rows;
    const char *magic;          /* AU: with which the annotation begins */
    uint64_t row;               /* rows given so far */
    int encoding;               /* AU: of its values */
    uint64_t bytes_left;        /* AU: of its data, UINT64_MAX if unknown */
    double *values;             /* delimited text: all rows, one after the other */
    size_t n_rows;
};
ss_status ss_text_open(ss_reader *reader, const ss_read_opts *opts, ss_error *err);
ss_status ss_au_open(ss_reader *reader, const ss_read_opts *opts, ss_error *err);
ss_status ss_delimited_open(ss_reader *reader, const ss_read_opts *opts, ss_error *err);

/* What a reader of AU believes; the annotation is the rest of the header. */
enum { AU_FIXED_HEADER = 24, AU_MAX_ANNOTATION = 1 << 20, AU_MAX_CHANNELS = 4096 };
/* The nearest whole Hz that AU can say; the annotation has the exact rate. */
uint32_t ss_au_rate(double rate);

/* Refuse options for input without a clock, as this one has one of its own rate. */
ss_status ss_refuse_clock(const char *name, double own, const ss_read_opts *opts, ss_error *err);

/* --- headers ------------------------------------------------------------------------------- */

#define STREAM_MAGIC "# stickslip signal 1"
/* The lines of a header, to be freed, or NULL if there is no memory. */
char *ss_header_text(const ss_header *head, const char *magic, size_t *length);
/* Write them, as text or as AU does; SS_EINVAL if AU is too narrow for them. */
ss_status ss_header_write(const ss_header *head, const char *magic, FILE *out, ss_format format);
/* Bytes on their way out, gathered. */
enum { OUTPUT_ROOM = 1 << 16 };
struct output {
    FILE *file;
    size_t used;
    char buffer[OUTPUT_ROOM];
};
ss_status ss_output_drain(struct output *out);     /* SS_EIO if the file refuses them */
/* A value as AU holds it. */
void ss_au_put(char to[8], double x);
/* Take in a "# key: value" line, which is changed; reason is set if it is SS_EDATA. */
ss_status ss_header_take(ss_header *head, char *line, const char **reason);
/* "name", "name/unit", "name/(unit)" into its two parts, in place. */
void ss_split_label(char *label, char **name, char **unit);

/* Time stamps t of n rows, of which row i stands in line line[i]: a uniform clock?  sample gets the
 * number of each row's sample, from 0: its own, unless gaps are allowed. */
ss_status ss_find_clock(const char *file, const double *t, const unsigned long *line, size_t n,
                        int gaps, size_t *sample, double *rate, ss_error *err);
/* The median step of stamps, which must ascend. */
ss_status ss_usual_step(const char *file, const double *t, const unsigned long *line, size_t n,
                        double *usual, ss_error *err);

/* Rows of columns values each at the stamps t, n >= 2 of them, to n_out rows, to be freed, from t[0]
 * on at this rate.  What is NaN in them is passed over; samples between stamps more than ten usual
 * steps apart, or beyond a column's own first and last, are NaN. */
ss_status ss_resample(double **out, size_t *n_out, const double *t, const double *value, size_t n,
                      size_t columns, double usual_step, double rate, const char *name,
                      ss_error *err);

/* Put numbers in place of NaN in n rows, value c of row i at x[i * row + c * column], and note in
 * head where that was. */
ss_status ss_fill_gaps(double *x, size_t n, size_t row, size_t column, ss_header *head, ss_gaps how,
                       const char *name, ss_error *err);

#endif
