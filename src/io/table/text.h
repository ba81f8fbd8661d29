/* text.h -- a table of text while it is read: its lines, its cells, the names of its columns. */
#ifndef TEXT_H
#define TEXT_H

#include "io/table/sheet.h"
#include "signal/header.h"

enum { MAX_CELLS = MAX_COLUMNS + 2 };

enum cell_kind { CELL_TEXT, CELL_NUMBER, CELL_NOT_FINITE, CELL_STAMP };

struct text_line {              /* above the data, and the first of these; to be freed */
    char *text;
    unsigned long number;
    int comment;
};

struct text {
    struct sheet t;             /* what becomes of it */
    ss_read_opts opts;          /* of it */
    struct input *in;
    ss_status status;           /* the first failure, behind which nothing is read */
    ss_error *err;              /* its text, but of SS_ENOMEM */
    char mark;                  /* decimal point or comma, '\0': none seen */
    char separator;             /* '\t' ';' ',' or ' ' (any blanks); '\0': one column */
    size_t next_columns;        /* of the table that begins with the last of the kept lines */
    char next_separator;
    int ended, another;         /* has the table ended, and does another one begin there? */
    unsigned long first;        /* the line of the first row */
    double *row;                /* that is read */
    char *copy;                 /* of the line that was split last; it has room for each that was read or kept */
    size_t copy_room;
    char *cell[MAX_CELLS];      /* its cells, and a letter for each */
    char shape[MAX_CELLS + 1];
    size_t numbers;             /* finite ones in the line with this shape */
    char like[MAX_CELLS + 1];   /* those of the line that others are held against */
    struct text_line *head;     /* lines above the data */
    size_t n_head, head_room;
    int comments;               /* cells too many are comments, which LabVIEW writes behind its rows */
    int labview;                /* does it begin as the files of LabVIEW do? */
    enum { LAYOUT_NO, LAYOUT_ONE, LAYOUT_MULTI } layout;        /* of its columns of x */
    int first_x;                /* is the first column no channel? */
    int settings;               /* have the first rows a setting and its value before their numbers? */
};

/* Unless it has failed before, let the text fail in this line; 0: in none. */
SS_PRINTF(4, 5)
void ss_text_fail(struct text *x, ss_status status, unsigned long line, const char *format, ...);

/* Cells (cells.c). */

/* A cell without the blanks around it, cut in place. */
char *ss_cell_trim(char *p);
/* The number in a cell, with a decimal comma unless commas separate cells. */
enum cell_kind ss_cell_read(char *cell, char separator, double *number);
/* 1 if the cell has separators of thousands, 1,234.5 or 1'234; a number such as 1,234 may be one that
 * has a decimal comma. */
int ss_cell_is_grouped(const char *cell);
/* May a cell of a row be empty? */
int ss_text_may_lack(const struct text *x);
/* Split a copy of a line that was read or kept into x->cell and return the number of cells, without surplus empty
 * cells at the end; at most MAX_CELLS, which is more than any table has. */
size_t ss_text_split(struct text *x, const char *line, char separator);
/* A letter for each cell of a line, valid until the next call: n for a number, a stamp, or a word for a missing
 * number, e for an empty cell, t for text. */
const char *ss_text_shape(struct text *x, const char *line, char separator);

/* Names (names.c): find names, units and a clock in the lines above the data.
 *
 * A line with numbers in it is either a word about the record ("Rate;1000") or a row of data with
 * a bad cell: the latter if it begins with a number or stands below a row of names. */
void ss_text_read_names(struct text *x);
/* When all rows are there: check the columns of times that LabVIEW writes, of each channel and against the
 * header. */
void ss_text_check_times(struct text *x);

#endif
