/* record.h -- write results as text: notes, rows of named cells, and records of named numbers, in any
 * format that has words.
 *
 * A result has one function for its row, in which the name, the unit and the value of a cell stand side by
 * side.  The first row that it writes is the line of names, in which values do not matter; so no other
 * list can disagree with it. */
#ifndef RECORD_H
#define RECORD_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/number.h>
#include <stickslip/table.h>
#include "base/error.h"
#include "io/format.h"

struct rows {
    FILE *out;
    const struct format *format;
    int names;                  /* 1: this row is the line of names */
    size_t cells;               /* written so far of this row */
};

/* Write the first line of a text of this kind.  SS_EINVAL: the format has no words. */
ss_status ss_rows_begin(struct rows *rows, FILE *out, ss_format format, ss_kind kind, ss_error *err);
/* Flush the text; SS_EIO if any of it could not be written. */
ss_status ss_rows_finish(struct rows *rows, ss_error *err);
/* Write a line "# key: value", if the format has notes. */
SS_PRINTF(2, 3)
void ss_rows_note(struct rows *rows, const char *text, ...);
/* "# key: value error unit", the value in so many digits and the error in half of them; 0: in all. */
void ss_rows_note_value(struct rows *rows, const char *key, ss_value v, const char *unit, int digits);
/* A word or a number of the whole result, which is written above the rows as a note; in a format without notes it
 * is called at the end of each row instead, and writes cells there: KEY; all_KEY and all_KEY_error. */
void ss_rows_whole_word(struct rows *rows, const char *key, const char *text);
void ss_rows_whole_value(struct rows *rows, const char *key, ss_value v, const char *unit, int digits);
/* Write the notes of a header, except those with the names of a result's own, as ss_note_is takes them. */
void ss_rows_notes(struct rows *rows, const ss_header *head, const char *const own[]);

/* Write the cells of a row, and then its end. */
void ss_rows_word(struct rows *rows, const char *name, const char *word);
void ss_rows_count(struct rows *rows, const char *name, size_t n);
void ss_rows_number(struct rows *rows, const char *name, const char *unit, double x);   /* "-" for NaN */
void ss_rows_rounded(struct rows *rows, const char *name, const char *unit, double x, int digits);
/* Two cells: NAME and NAME_error. */
void ss_rows_value(struct rows *rows, const char *name, const char *unit, ss_value v);
void ss_rows_end(struct rows *rows);

/* A number as a cell or a note shows it: "-" for NaN.  Returns text. */
const char *ss_number_text(char text[SS_NUMBER_MAX], double x);
/* The same with this number of digits; 0: with all that a reader needs. */
const char *ss_number_rounded(char text[SS_NUMBER_MAX], double x, int digits);
/* The same with this number of decimals, which may be zeros; nine digits if that is too long. */
const char *ss_number_fixed(char text[SS_NUMBER_MAX], double x, int decimals);

/* Of a table that was read (table.c), the index of the column of this name; -1 if there is none. */
int ss_table_column(const ss_table *table, const char *name);
/* The number in a cell; NaN if the cell holds a word or "-", or if there is no such cell. */
double ss_table_number(const ss_table *table, size_t row, size_t column);

#endif
