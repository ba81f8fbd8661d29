/* delimited.h -- a text table while it is read: its cells, the names of its columns, its clock. */
#ifndef DELIMITED_H
#define DELIMITED_H

#include <stddef.h>
#include <stdint.h>
#include <stickslip/signal.h>
#include "base/error.h"
#include "stream/clock.h"
#include "stream/input.h"
#include "stream/reader.h"

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
    unsigned parts;             /* of stamps: a date, a time of day or both */
    double day;                 /* the day from which they count, in the first row; NaN: no date */
    double last;                /* the stamp of the row before */
};

/* A column of times: seconds are its values * factor / divisor. */
struct time_column {
    size_t column;              /* NONE: there is none */
    double factor, divisor;
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
    size_t time;                /* column of time, or NONE */
    struct counted counted;
    int named;                  /* is there a row of names? */
    int labview;                /* does it begin as the files of LabVIEW do? */
    enum { LAYOUT_NO, LAYOUT_ONE, LAYOUT_MULTI } layout;        /* of its columns of x */
    int first_x;                /* is the first column no channel? */
    int comments;               /* cells too many are comments, which LabVIEW writes behind its rows */
    ss_header *names;           /* all columns, that of time among them, and the clock */
    double *value;              /* rows, one after the other */
    unsigned long *line;        /* where each row stands */
    size_t n_rows, room;
    size_t *kept, n_kept;       /* the columns of the signal */
    int twice;                  /* value has the first rows only; the others are read again */
    uint64_t left;              /* the number of these that are still to be read */
    clock_fit fit;              /* of all stamps of such a table */
    uint64_t sum, *sums;        /* of the rows that are read again: of this piece, of each of n_sums */
    size_t n_sums, sums_room, piece;    /* piece: of these, the one that is read next */
};

ss_status ss_delimited_no_memory(const struct table *t, ss_error *err);
/* Pass a warning to the caller's function, if there is one. */
SS_PRINTF(3, 4)
void ss_delimited_warn(const struct table *t, ss_status about, const char *format, ...);

/* Hand the rows of a table, whose names and values are complete, to the reader: with a clock, without
 * the columns of time and text, with gaps filled. */
ss_status ss_delimited_finish(struct table *t, ss_reader *reader, ss_error *err);
void ss_delimited_free(struct table *t);        /* NULL is allowed */

/* Cells (delimited_cells.c). */

/* A cell without the blanks around it, cut in place. */
char *ss_cell_trim(char *p);
/* The number in a cell, with a decimal comma unless commas separate cells. */
enum cell_kind ss_cell_read(char *cell, char separator, double *x);
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

/* Find the column of time and turn the rows into samples of its clock (delimited_clock.c). */
ss_status ss_delimited_choose_clock(struct table *t, ss_error *err);
/* The column of time that it will take, as names, kinds and the first row show. */
struct time_column ss_delimited_time(const struct table *t);

#endif
