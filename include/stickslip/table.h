/* stickslip/table.h -- numbers with names, units and errors, and tables of them: events, features, rankings. */
#ifndef STICKSLIP_TABLE_H
#define STICKSLIP_TABLE_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* A number and its standard error; each is NaN if it is not known. */
typedef struct ss_value {
    double value, error;
} ss_value;

/* A number that many events have in common. */
typedef struct ss_number {
    double value, error;        /* and its standard error; each is NaN if it is not known */
    double scatter;             /* the standard deviation of the events about it; NaN: it is no median */
    const char *why;            /* constant text: why it is not known, or how it was found; NULL: nothing to say */
} ss_number;

/* What a number is called. */
typedef struct ss_label {
    const char *name, *unit;    /* "m/s"; "" if it has none; NULL if the recording decides */
} ss_label;

typedef struct ss_table {
    size_t n_notes;
    char **note;                /* "key: value", in the order of the text; a key may occur twice */
    size_t n_columns;
    ss_column *column;
    size_t n;                   /* rows */
    char **cell;                /* the text of row i and column c is cell[i * n_columns + c] */
} ss_table;

/* Read text of this kind: events, features, a ranking, a trade or a sweep.  Several tables with
 * the same columns, such as the shards of a sweep, may follow each other.  Messages call the file
 * by name.  SS_EKIND: the text is of another kind; SS_EDATA: a table has no columns or others than
 * the first, or a row has more or fewer cells than columns; err names file and line; SS_EIO. */
ss_status ss_table_read(ss_table **out, FILE *in, const char *name, ss_kind kind, ss_error *err);
/* The value of the first note with this key; NULL if there is none. */
const char *ss_table_note(const ss_table *table, const char *key);
void ss_table_free(ss_table *table);            /* NULL is allowed */

SS_END_DECLARATIONS
#endif
