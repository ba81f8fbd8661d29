/* stamp.h -- read dates and times of day in cells. */
#ifndef STAMP_H
#define STAMP_H

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

#endif
