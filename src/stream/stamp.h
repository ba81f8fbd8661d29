/* stamp.h -- read dates and times of day in cells. */
#ifndef STAMP_H
#define STAMP_H

enum { STAMP_DATE = 1, STAMP_TIME = 2 };       /* of a cell; both: a date and a time of day */

typedef struct time_stamp {
    unsigned parts;             /* STAMP_...; 0: the cell is no stamp */
    long day;                   /* since 1970-01-01; 0 without a date */
    double seconds;             /* of the day, less the hours that its zone is ahead of UTC */
} time_stamp;

/* ISO 8601: 2024-03-05, 10:12:13.125, 2024-03-05T10:12:13,125Z; the date also with slashes, a blank for
 * the T, and hours and minutes of a zone behind. */
time_stamp ss_stamp_read(const char *cell);

#endif
