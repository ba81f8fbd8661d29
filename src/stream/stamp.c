/* stamp.c -- read dates and times of day in the form of ISO 8601. */
#include <stddef.h>
#include <string.h>
#include "stream/stamp.h"

/* Read n digits as a number.  Returns their end; NULL if there are not so many, or p is NULL. */
static const char *
read_digits(const char *p, int n, long *x)
{
    *x = 0;
    for (; p != NULL && n > 0; n--, p++) {
        if (*p < '0' || *p > '9')
            return NULL;
        *x = 10 * *x + (*p - '0');
    }
    return p;
}

/* Read two digits behind one of these marks, likewise. */
static const char *
read_part(const char *p, const char *marks, long *x)
{
    return p != NULL && *p != '\0' && strchr(marks, *p) != NULL ? read_digits(p + 1, 2, x) : NULL;
}

/* The number of a day in the Gregorian calendar.  Years begin in March here, so that a leap day is the
 * last day of its year. */
static long
day_number(long year, long month, long day)
{
    year -= month < 3;
    month += month < 3 ? 9 : -3;
    return 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1 - 719468;
}

static const char *
read_date(const char *p, long *day)
{
    long y, m, d;
    const char *mark = (p = read_digits(p, 4, &y));
    p = read_part(p, "-/", &m);
    if (p == NULL || *p != *mark)
        return NULL;
    p = read_part(p, "-/", &d);
    if (p == NULL || m < 1 || m > 12 || d < 1 || d > 31)
        return NULL;
    *day = day_number(y, m, d);
    return p;
}

static const char *
read_time(const char *p, double *seconds)
{
    long h, m, s;
    p = read_part(read_part(read_digits(p, 2, &h), ":", &m), ":", &s);
    if (p == NULL || h > 23 || m > 59 || s > 60)
        return NULL;
    long digits = 0;
    double fraction = 0, unit = 1;
    if (*p == '.' || *p == ',')
        for (p++; *p >= '0' && *p <= '9' && digits < 15; p++, digits++) {
            fraction = 10 * fraction + (*p - '0');
            unit *= 10;
        }
    *seconds = (double)(3600 * h + 60 * m + s) + fraction / unit;
    return p;
}

/* Read a zone at the end: "Z", "+01", "+01:00" or "+0100".  NULL if it is none of them. */
static const char *
read_zone(const char *p, double *ahead)
{
    long h = 0, m = 0;
    int sign = *p == '-' ? -1 : 1;
    *ahead = 0;
    if (*p == 'Z' || *p == '\0')
        return p + (*p == 'Z');
    p = read_part(p, "+-", &h);
    if (p != NULL && *p != '\0')
        p = read_digits(p + (*p == ':'), 2, &m);
    *ahead = sign * (double)(3600 * h + 60 * m);
    return p;
}

time_stamp
ss_stamp_read(const char *cell)
{
    const time_stamp none = { 0, 0, 0 };
    time_stamp found = none;
    double ahead;
    const char *p = read_date(cell, &found.day);
    if (p != NULL) {
        found.parts = STAMP_DATE;
        if (*p == '\0')
            return found;
        if (*p != 'T' && *p != ' ')
            return none;
        p += *p == 'T' ? 1 : strspn(p, " ");
    }
    p = read_time(p != NULL ? p : cell, &found.seconds);
    p = p != NULL ? read_zone(p, &ahead) : NULL;
    if (p == NULL || *p != '\0')
        return none;
    found.parts |= STAMP_TIME;
    found.seconds -= ahead;
    return found;
}
