/* stamp.h -- read dates and times of day in cells. */
#ifndef STAMP_H
#define STAMP_H

enum { STAMP_DATE = 1, STAMP_TIME = 2 };       /* of a cell; both: a date and a time of day */

typedef struct time_stamp {
    unsigned parts;             /* STAMP_...; 0: the cell is not a stamp */
    long day;                   /* since 1970-01-01; 0 without a date */
    double seconds;             /* of the day in UTC: the offset of a zone is subtracted */
} time_stamp;

/* Read a stamp of ISO 8601: 2024-03-05, 10:12:13.125, 2024-03-05T10:12:13,125Z.  The date may have
 * slashes, a blank may replace the T, and hours and minutes of a zone may follow. */
time_stamp ss_stamp_read(const char *cell);

#endif
