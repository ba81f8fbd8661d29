/* time_unit.h -- the units of numbers that are times, and the names of columns that hold times. */
#ifndef TIME_UNIT_H
#define TIME_UNIT_H

#include <stddef.h>

#define SECONDS_A_DAY 86400.

/* Seconds are numbers * factor / divisor. */
struct time_unit {
    const char *name, *others;  /* the usual name; other names, with blanks between them */
    double factor, divisor;
    int is_name;                /* 1: a column with only this name holds times */
};

/* The unit with this name, in upper or lower case; NULL: there is none. */
const struct time_unit *ss_time_unit_find(const char *name);
/* The unit that is the name of a column or its end, as in ms and Time_ms; NULL: there is none.  *length
 * becomes the number of letters before it. */
const struct time_unit *ss_time_unit_in(const char *name, size_t *length);
/* The unit in which a number is a date between 2000 and 2100, counted from 1970; NULL: there is none. */
const struct time_unit *ss_time_unit_of_date(double number);
/* Is this the number of a day of our time, as Excel, MATLAB or astronomers count days? */
int ss_is_day_now(double number);

/* Does a column with this name hold times, as Time, t, time_ms, ms and Seconds do? */
int ss_is_called_time(const char *name);

#endif
