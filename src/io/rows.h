/* rows.h -- write a header of notes, and rows of words and numbers, in any format that has words. */
#ifndef ROWS_H
#define ROWS_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/number.h>
#include "base/error.h"
#include "io/format.h"

struct rows {
    FILE *out;
    const struct format *format;
    size_t cells;               /* written so far, of the row or of the line of columns */
};

/* Write the first line of a text of this kind.  SS_EINVAL: the format has no words. */
ss_status ss_rows_begin(struct rows *rows, FILE *out, ss_format format, ss_kind kind);
/* Write a line "# key: value", if the format has notes. */
SS_PRINTF(2, 3)
void ss_rows_note(struct rows *rows, const char *text, ...);
/* Write the notes of a header, except those with the names of a result's own, as ss_note_is takes them. */
void ss_rows_notes(struct rows *rows, const ss_header *head, const char *const own[]);

/* Write one column, and ss_rows_end after the last; or write all columns. */
void ss_rows_column(struct rows *rows, const char *name, const char *unit);
void ss_rows_columns(struct rows *rows, const char *const label[][2], size_t n);

/* Write the cells of a row, and then its end. */
void ss_rows_word(struct rows *rows, const char *word);
void ss_rows_count(struct rows *rows, size_t n);
void ss_rows_number(struct rows *rows, double x);      /* "-" for NaN */
void ss_rows_rounded(struct rows *rows, double x, int digits);
void ss_rows_end(struct rows *rows);

/* A number as a cell or a note shows it: "-" for NaN.  Returns text. */
const char *ss_number_text(char text[SS_NUMBER_MAX], double x);
/* The same with this number of digits. */
const char *ss_number_rounded(char text[SS_NUMBER_MAX], double x, int digits);
/* The same with this number of decimals, which may be zeros; nine digits if that is too long. */
const char *ss_number_fixed(char text[SS_NUMBER_MAX], double x, int decimals);

#endif
