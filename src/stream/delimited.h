/* delimited.h -- a table that is being read: its cells, the names of its columns, its clock. */
#ifndef DELIMITED_H
#define DELIMITED_H

#include <stddef.h>
#include <stdint.h>
#include <stickslip/signal.h>
#include "stream/input.h"

#define NONE SIZE_MAX

struct table {
    struct input *in;
    const ss_read_opts *opts;
    char mark;                  /* decimal point or comma, '\0': none seen */
    char separator;             /* '\t' ';' ',' or ' ' (any blanks); '\0': one column */
    size_t n_columns;           /* that of time among them */
    char **cell;                /* of the line that was split last */
    size_t cell_room;
    char *above[2];             /* the last two header lines: [1] stands right above the data */
    unsigned long above_line[2];
    size_t time;                /* column of time, or NONE */
    double origin, increment;   /* [s] of numbered rows: the first column; increment 0: not so */
    int named;                  /* is there a row of names? */
    ss_header *names;           /* all columns, that of time among them, and the clock */
    double *value;              /* rows, one after the other */
    unsigned long *line;        /* where each row stands */
    size_t n_rows, room;
};

enum cell_kind { CELL_TEXT, CELL_NUMBER, CELL_NOT_FINITE };

ss_status ss_delimited_no_memory(const struct table *t, ss_error *err);

/* Cells (delimited_cells.c). */

/* A cell without the blanks around it, cut in place. */
char *ss_cell_trim(char *p);
/* The number in a cell, with a decimal comma unless commas separate cells. */
enum cell_kind ss_cell_read(char *cell, char separator, double *x);
/* Split a line, in place, into t->cell; empty cells too many at the end are dropped.  NONE: no
 * memory. */
size_t ss_delimited_split(struct table *t, char *p, char separator);
/* The number of cells of a line if all are numbers with this separator, else 0; NONE: no memory. */
size_t ss_delimited_count_numbers(struct table *t, const char *line, char separator);

/* Find names and units in the last two lines above the data (delimited_names.c).
 *
 * A line with numbers in it is either a word about the record ("Rate;1000") or a row of data with
 * a bad cell: the latter if it begins with a number or stands below a row of names. */
ss_status ss_delimited_read_names(struct table *t, ss_error *err);

/* Find the column of time and turn the rows into samples of its clock (delimited_clock.c). */
ss_status ss_delimited_choose_clock(struct table *t, ss_error *err);

#endif
