/* delimited.h -- a text table while it is read: its cells, the names of its columns, its clock. */
#ifndef DELIMITED_H
#define DELIMITED_H

#include <stddef.h>
#include <stdint.h>
#include <stickslip/signal.h>
#include "base/error.h"
#include "signal/resample.h"
#include "io/table/clock.h"
#include "io/input.h"
#include "io/kept.h"
#include "io/reader.h"
#include "io/table/stamp.h"

#define NONE SIZE_MAX

enum cell_kind { CELL_TEXT, CELL_NUMBER, CELL_NOT_FINITE, CELL_STAMP };

/* The kind of a column, by its cell in the first row. */
enum column_kind {
    COLUMN_NUMBERS,
    COLUMN_STAMPS,              /* dates or times of day; its values are seconds */
    COLUMN_TEXT                 /* left out */
};

/* The times of rows in a table without a column of times. */
struct counted {
    double origin, increment;   /* [s]; increment 0: not known */
    int numbered;               /* the first column numbers the rows, else they follow each other */
};

struct table_column {
    enum column_kind kind;
    int spare;                  /* is it a column of numbers that the caller does not need? */
    int incomplete;             /* has a cell of such a column no number? */
    int begins_empty;           /* of text: is its first cell empty?  A number in it is then one too many */
    unsigned parts;             /* of stamps: a date, a time of day or both */
    int dated;                  /* have its rows a date? */
    int fits[ORDERS];           /* may their day and month stand in this order? */
    long first[ORDERS];         /* the first row's day in it */
    long before[ORDERS];        /* and that of the row before */
    double last;                /* the stamp of the row before, without leap seconds */
    int leap, leaps;            /* leap: may it lie in a leap second?  leaps: so many have ended */
};

/* A column of times: seconds are origin + (its values - zero) * factor / divisor. */
struct time_column {
    size_t column;              /* NONE: there is none */
    double origin, zero, factor, divisor;
};

struct table_line {             /* above the data, to be freed */
    char *text;
    unsigned long number;
    int comment;
};

struct table {
    struct input *in;
    const ss_read_opts *opts;
    char mark;                  /* decimal point or comma, '\0': none seen */
    char separator;             /* '\t' ';' ',' or ' ' (any blanks); '\0': one column */
    size_t n_columns;           /* of the file: those of time and of text among them */
    size_t next_columns;        /* columns and separator of the next table in the file */
    char next_separator;
    struct table_column *column;
    char **cell;                /* of the line that was split last */
    size_t cell_room;
    struct table_line *head;    /* lines above the data */
    size_t n_head, head_room;
    struct time_column time;
    struct counted counted;
    int named;                  /* is there a row of names? */
    int labview;                /* does it begin as the files of LabVIEW do? */
    enum { LAYOUT_NO, LAYOUT_ONE, LAYOUT_MULTI } layout;        /* of its columns of x */
    int first_x;                /* is the first column no channel? */
    int comments;               /* cells too many are comments, which LabVIEW writes behind its rows */
    ss_header *names;           /* all columns, that of time among them, and the clock */
    struct kept rows;           /* each of them the values of all columns and the number of its line */
    double *first;              /* the first of them */
    struct time_column fitted;  /* fit is that of its stamps, if they ascend */
    clock_fit fit;
    double digit;               /* [s] in the last digit of times in days, which is no round number of seconds, or 0 */
    int ascends;
    size_t *kept, n_kept;       /* the columns of the signal */
    struct sample_count count;
    const double *row;          /* that is given next, as this sample; NULL: it is not read yet */
    size_t sample, given;       /* given: samples so far */
    double longest;             /* [s] between two stamps without a gap, where they are resampled */
    struct resampler *resampler;        /* or NULL */
};

ss_status ss_delimited_no_memory(const struct table *t, ss_error *err);
/* Pass a warning to the caller's function, if there is one. */
SS_PRINTF(3, 4)
void ss_delimited_warn(const struct table *t, ss_status about, const char *format, ...);

/* The part of the work in reading a table to its end, before its rows are given; and the part that is done. */
#define READING 0.5
double ss_delimited_given(const struct table *t);
/* A table of the reader, which frees it.  NULL: no memory. */
struct table *ss_delimited_new(ss_reader *reader, const ss_read_opts *opts);
/* Hand the rows of a table, whose names and rows are complete, to the reader: with a clock, without the
 * columns of time and text, with gaps filled. */
ss_status ss_delimited_finish(struct table *t, ss_reader *reader, ss_error *err);
void ss_delimited_free(struct table *t);        /* NULL is allowed */

/* Rows (delimited_rows.c). */

/* The first letter that is no blank. */
char ss_delimited_first_of(const char *line);
/* The next line that is not empty; comment is set if it is one.  NULL at the end. */
ss_status ss_delimited_line(struct table *t, char **line, int *comment, ss_error *err);
/* Begin with none. */
void ss_delimited_begin_rows(struct table *t);
/* Read a line, which is cut up, as a row. */
ss_status ss_delimited_read_row(struct table *t, char *text, const double **row, ss_error *err);
/* Or room for the values of one more row, and, when they are there, add it. */
ss_status ss_delimited_new_row(struct table *t, double **row, ss_error *err);
ss_status ss_delimited_add_row(struct table *t, const double *row, ss_error *err);
/* The same for row i of a table that is no text; its values are checked when it is added. */
ss_status ss_delimited_begin_numbers(struct table *t, uint64_t i, double **row, ss_error *err);
ss_status ss_delimited_add_numbers(struct table *t, uint64_t i, double *row, ss_error *err);
/* After ss_kept_end: go back to the first row, before each reading of them; and the next that has a time, if there
 * is a column of time, or NULL. */
ss_status ss_delimited_rewind(struct table *t, ss_error *err);
ss_status ss_delimited_next(struct table *t, const double **row, ss_error *err);
void ss_delimited_free_rows(struct table *t);
/* The day of the first row of a column of stamps, since 1970-01-01; NaN: it has none, or day and month may stand
 * in either order. */
double ss_delimited_day(const struct table_column *c);

/* Cells (delimited_cells.c). */

/* A cell without the blanks around it, cut in place. */
char *ss_cell_trim(char *p);
/* The number in a cell, with a decimal comma unless commas separate cells. */
enum cell_kind ss_cell_read(char *cell, char separator, double *x);
/* May a cell of a row be empty? */
int ss_delimited_may_lack(const struct table *t);
/* Split a line, in place, into t->cell and return the number of cells, without surplus empty cells at
 * the end.  NONE: no memory. */
size_t ss_delimited_split(struct table *t, char *p, char separator);
/* A letter for each cell of a line, to be freed: n for a number, a stamp, or a word for a missing
 * number, e for an empty cell, t for text.  *numbers counts the finite numbers.  NULL: no memory. */
char *ss_delimited_shape(struct table *t, const char *line, char separator, size_t *numbers);

/* The start of the data among the lines that were kept (delimited_start.c). */

/* Is this the first line of data?  Then t->separator and t->n_columns are set. */
ss_status ss_delimited_is_data(struct table *t, const char *line, int *yes);
/* Does the last of the kept lines begin with a number and have words? */
ss_status ss_delimited_ends_mixed(struct table *t, int *yes);
/* The first of the kept lines that is a row of data with words in it, as the lines below it are too, or
 * t->n_head; then t->separator and t->n_columns are set.  NONE: no memory. */
size_t ss_delimited_find_mixed(struct table *t);

/* Find names and units in the last two lines above the data (delimited_names.c).
 *
 * A line with numbers in it is either a word about the record ("Rate;1000") or a row of data with
 * a bad cell: the latter if it begins with a number or stands below a row of names. */
ss_status ss_delimited_read_names(struct table *t, ss_error *err);

/* Read names, units and clock from lines that begin with a key: Interval, Delta_X, Unit
 * (delimited_labview.c).  Call after ss_delimited_read_names. */
ss_status ss_delimited_read_labview(struct table *t, ss_error *err);
/* Is this cell such a key? */
int ss_delimited_is_key(const char *cell);
/* Check the columns of times, of each channel and against the header, which takes all rows. */
ss_status ss_delimited_check_labview(struct table *t, ss_error *err);
/* Does this line begin another segment of a LabVIEW file? */
int ss_delimited_is_segment(const struct table *t, const char *line);

/* Find the column of time and the clock on which the rows are samples (delimited_clock.c). */
ss_status ss_delimited_choose_clock(struct table *t, ss_error *err);
/* The column of time that it will take, as names, kinds and the first row show. */
struct time_column ss_delimited_time(const struct table *t);
/* Mark the columns that the caller does not need, as far as the names tell, before the first row is read. */
ss_status ss_delimited_mark_spare(struct table *t, ss_error *err);

/* The time of a row (delimited_samples.c). */
double ss_delimited_stamp(const struct time_column *c, const double *row);
/* Go back to the first sample; and up to max more of them as rows of the columns kept, NaN where there is
 * none. */
ss_status ss_delimited_begin_samples(struct table *t, ss_error *err);
ss_status ss_delimited_samples(struct table *t, double *const column[], size_t max, size_t *n, ss_error *err);

#endif
