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

#define NONE SIZE_MAX

/* --- dates and times of day (stamp.c) ------------------------------------------------------- */

enum { STAMP_DATE = 1, STAMP_TIME = 2 };       /* of a cell; both: a date and a time of day */

/* The order of a date whose year comes last. */
enum { DAY_FIRST, MONTH_FIRST, ORDERS };
#define NO_DAY (-1000000000L)                   /* there is no such date in this order */

typedef struct time_stamp {
    unsigned parts;             /* STAMP_...; 0: the cell is not a stamp */
    long day[ORDERS];           /* since 1970-01-01, in either order; the same if the form tells the order */
    double seconds;             /* of the day in UTC: the offset of a zone is subtracted */
    double turn;                /* [s] a time without a date begins anew after a day or, without hours, an hour */
    int leap;                   /* is it second 60 of its minute? */
} time_stamp;

/* Read a stamp of ISO 8601: 2024-03-05, 10:12:13.125, 2024-03-05T10:12:13,125Z.  The date may have
 * slashes, a blank may replace the T, and hours and minutes of a zone may follow.  Or read what others write:
 * 5.3.2024, 03/05/2024 and 03-05-2024 in either order, 9:12:13, 09:12:13 PM; times that have elapsed, 100:12:13
 * and without hours 12:13.125. */
time_stamp ss_stamp_read(const char *cell);

/* A column of stamps, of which each row shows more. */
struct stamp_column {
    unsigned parts;             /* a date, a time of day or both */
    int dated;                  /* have its rows a date? */
    int fits[ORDERS];           /* may their day and month stand in this order? */
    long first[ORDERS];         /* the first row's day in it */
    long before[ORDERS];        /* and that of the row before */
    double last;                /* the stamp of the row before, without leap seconds */
    int leap, leaps;            /* leap: may it lie in a leap second?  leaps: so many have ended */
};
#define STAMP_COLUMN(of_parts) ((struct stamp_column){ .parts = (of_parts), .fits = { 1, 1 }, .last = NAN })
/* The seconds of the next row's stamp since the midnight before the first row; NaN: it is none like those
 * before. */
double ss_stamp_next(struct stamp_column *c, const char *cell);
/* The day of the first row, since 1970-01-01; NaN: it has none, or day and month may stand in either order. */
double ss_stamp_day(const struct stamp_column *c);

/* --- columns and rows ----------------------------------------------------------------------- */

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
 * text, with gaps filled.  It takes the rows from the table, or, if more come later, the table.  progress is told
 * of the rows that were given, as the second half of the work. */
ss_status ss_sheet_give(ss_source **out, struct sheet *t, ss_progress progress, ss_error *err);
/* Let *s, whose rows are those of a table that is no text, be the source of its samples; on failure it is freed,
 * and *s NULL.  named: are its columns? */
ss_status ss_sheet_of_source(ss_source **s, const ss_read_opts *opts, int named, ss_progress progress,
                             ss_error *err);

/* --- the uniform clock of stamps (clock.c) -------------------------------------------------- */

#define CLOCK_TOLERANCE 0.1     /* a stamp may be off by so many sample periods */

/* A pass through the stamps of a table, from zeros behind the first two on. */
struct stamps {
    struct kept *rows;
    struct time_column of;
    size_t n;                   /* stamps so far */
    double stamp, before;       /* the last one, and that before it */
    unsigned long line;         /* where it stands */
    uint64_t row;
};
/* Go to the next stamp.  Returns 0 if there is none. */
int ss_stamps_next(struct stamps *s);
/* SS_ECLOCK: they are fewer than two, or do not ascend. */
ss_status ss_stamps_check(struct stamps s, ss_error *err);
/* The median of steps, or of some thousand that lie evenly among them, of stamps that ascend. */
double ss_usual_step(struct stamps s);

/* The samples of rows: one after the other, or, where some may be missing, as the steps of their stamps show.
 * Begin with the usual step, or 0, and zeros. */
struct sample_count {
    double usual, last;         /* last: stamp */
    size_t next;
};
size_t ss_clock_sample(struct sample_count *c, double stamp);

struct clock {
    double usual;               /* given: the usual step, and some stamps may be missing; 0: none is */
    double taken;               /* given: [s] from all stamps, which were rounded before */
    double digit;               /* given: [s] what 1 in the last digit of a stamp is; 0: not known */
    double rate, start;         /* found */
    size_t n;                   /* stamps */
    double last;                /* the number of the last sample */
};
/* Find the uniform clock of stamps that ascend. */
ss_status ss_find_clock(struct stamps s, struct clock *clock, ss_error *err);
/* The error of a stamp that comes so many sample periods too late. */
ss_status ss_clock_refuse(const char *name, unsigned long line, double late, ss_error *err);
/* The fewest digits of a number that is x, but for 1e-9 of it. */
int ss_clock_digits(double x);

#endif
