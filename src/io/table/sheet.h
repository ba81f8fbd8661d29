/* sheet.h -- a table of rows at times, of text, .npy or HDF5: its columns, its rows, which are kept, and the clock
 * on which they are samples. */
#ifndef SHEET_H
#define SHEET_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include "base/error.h"
#include "io/format.h"
#include "io/kept.h"
#include "io/table/stamp.h"

#define NONE SIZE_MAX

enum column_kind {
    COLUMN_NUMBERS,
    COLUMN_STAMPS,              /* dates or times of day; its values are seconds */
    COLUMN_TEXT                 /* left out */
};

struct sheet_column {
    enum column_kind kind;
    int spare;                  /* is it a column of numbers that the caller does not need? */
    int incomplete;             /* has a cell of such a column no number? */
    int begins_empty;           /* of text: is its first cell empty?  A number in it is then one too many */
    struct stamp_column stamps; /* of stamps */
};

struct sheet;
/* A table whose rows come as they are read. */
struct sheet_calls {
    /* Drop the rows, and add those that have arrived, at least one unless there are no more. */
    ss_status (*next)(struct sheet *t, ss_error *err);
    void (*free)(struct sheet *t);
};

struct sheet {
    const char *name;           /* of the file, for messages */
    const ss_read_opts *opts;
    size_t n_columns;           /* of the file: those of time and of text among them */
    struct sheet_column *column;
    ss_header *names;           /* all columns, that of time among them, and the clock */
    int named;                  /* is there a row of names? */
    struct {                    /* the times of rows in a table without a column of times */
        double origin, increment;       /* [s]; increment 0: not known */
        int numbered;           /* the first column numbers the rows, else they follow each other */
    } counted;
    const char *clue;           /* the line above the data that may give the rate, or NULL; its number */
    unsigned long clue_line;
    struct kept rows;           /* each of them the values of all columns and the number of its line */
    const struct sheet_calls *later;    /* NULL: all rows are there */
};

void ss_sheet_free(struct sheet *t);

/* Pass a warning to the caller's function, if there is one. */
SS_PRINTF(3, 4)
void ss_sheet_warn(const struct sheet *t, ss_status about, const char *format, ...);

/* A column of times: seconds are origin + (its values - zero) * factor / divisor. */
struct time_column {
    size_t column;              /* NONE: there is none */
    double origin, zero, factor, divisor;
};

/* The way from rows to samples. */
struct timing {
    struct time_column time;
    double usual;               /* step [s], where some rows may be missing; 0: each row is a sample */
    double longest;             /* [s] between two stamps without a gap; 0: they are not resampled */
};

/* The unit of time with this name, in upper or lower case; NULL: there is none. */
const struct time_unit *ss_time_unit_find(const char *name);
/* Does a column with this name hold times, as Time, t, time_ms, ms and Seconds do? */
int ss_is_called_time(const char *name);
/* Find the column of time, and in t->names the clock on which the rows are samples (time.c). */
ss_status ss_sheet_find_clock(struct sheet *t, struct timing *timing, ss_error *err);
/* Do the rows, which are all in memory, lie on a clock without rounding?  SS_ENOMEM, without a text. */
ss_status ss_sheet_is_plain(struct sheet *t, int *yes);
/* Mark the columns that the caller does not need, as far as the names tell, before the first row is read. */
ss_status ss_sheet_mark_spare(struct sheet *t, ss_error *err);
static inline double
ss_sheet_stamp(const struct time_column *c, const double *row)
{
    return c->origin + (row[c->column] - c->zero) * c->factor / c->divisor;
}

/* Make a source of the rows, whose names are complete, as samples: with a clock, without the columns of time and
 * text, with gaps filled.  It takes the rows from the table, or, if
 * more come later, the table.  progress is told of the rows that were given, as the
 * second half of the work. */
ss_status ss_sheet_give(ss_source **out, struct sheet *t, ss_progress progress, ss_error *err);
/* Let *s, whose rows are those of a table that is no text, be the source of its samples; on failure it is freed, and *s
 * NULL.  named: are its columns? */
ss_status ss_sheet_of_source(ss_source **s, const ss_read_opts *opts, int named, ss_progress progress, ss_error *err);

#endif
