/* stamp.c -- read dates and times of day in the form of ISO 8601 and in those of spreadsheets. */
#include <math.h>
#include <stddef.h>
#include <string.h>
#include <strings.h>
#include "io/table/sheet.h"

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
    year += 400 - (month < 3);                  /* an era more, as year 0 begins in year -1 */
    month += month < 3 ? 9 : -3;
    return 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1 - 719468 - 146097;
}

static long
find_day(long year, long month, long day)
{
    if (month < 1 || month > 12 || day < 1)
        return NO_DAY;
    long first = day_number(year, month, 1), next = day_number(year + month / 12, month % 12 + 1, 1);
    return day <= next - first ? first + day - 1 : NO_DAY;
}

/* Read as many digits as there are, from 1 to `most`, likewise. */
static const char *
read_up_to(const char *p, int most, long *x)
{
    const char *end = NULL;
    for (int n = most; end == NULL && n > 0; n--)
        end = read_digits(p, n, x);
    return end;
}

/* Read a date whose year comes last: with points or a month's name, of which three letters count, the day is
 * first, else day and month may stand in either order. */
static const char *
read_date_of_year_last(const char *p, long day[ORDERS])
{
    static const char names[] = "janfebmaraprmayjunjulaugsepoctnovdec";
    long a, b, y, month = 1;
    const char *mark = (p = read_up_to(p, 2, &a));
    if (p == NULL || *p == '\0' || strchr("./-", *p) == NULL)
        return NULL;
    while (month <= 12 && strncasecmp(p + 1, names + 3 * (month - 1), 3) != 0)
        month++;
    p = month <= 12 ? p + 4 : read_up_to(p + 1, 2, &b);
    b = month <= 12 ? month : b;
    if (p == NULL || *p != *mark || (p = read_digits(p + 1, 4, &y)) == NULL)
        return NULL;
    day[DAY_FIRST] = find_day(y, b, a);
    day[MONTH_FIRST] = *mark == '.' || month <= 12 ? day[DAY_FIRST] : find_day(y, a, b);
    return day[DAY_FIRST] != NO_DAY || day[MONTH_FIRST] != NO_DAY ? p : NULL;
}

static const char *
read_date(const char *cell, long day[ORDERS])
{
    long y, m, d;
    const char *p = read_digits(cell, 4, &y), *mark = p;
    if (p == NULL)
        return read_date_of_year_last(cell, day);
    p = read_part(p, "-/", &m);
    if (p == NULL || *p != *mark)
        return NULL;
    p = read_part(p, "-/", &d);
    if (p == NULL)
        return NULL;
    day[DAY_FIRST] = day[MONTH_FIRST] = find_day(y, m, d);
    return day[DAY_FIRST] != NO_DAY ? p : NULL;
}

/* Read h:m:s, or m:s.f where a fraction shows that these are no hours and minutes, and "AM" or "PM" behind it.  In
 * times without a date hours may exceed a day, and minutes without hours an hour. */
static const char *
read_time(const char *p, time_stamp *to)
{
    long h, m, s, dated = to->parts & STAMP_DATE;
    const char *minutes = read_part(read_up_to(p, dated ? 2 : 3, &h), ":", &m);
    if ((p = read_part(minutes, ":", &s)) == NULL) {
        if (dated || minutes == NULL || (*minutes != '.' && *minutes != ','))
            return NULL;
        p = minutes;
        s = m;
        m = h;
        h = -1;
    }
    if ((dated && h > 23) || (h >= 0 && m > 59) || s > 60)
        return NULL;
    to->turn = h < 0 ? 3600 : 86400;
    to->leap = s == 60;
    h = h < 0 ? 0 : h;
    long digits = 0;
    double fraction = 0, unit = 1;
    if (*p == '.' || *p == ',')
        for (p++; *p >= '0' && *p <= '9' && digits < 15; p++, digits++) {
            fraction = 10 * fraction + (*p - '0');
            unit *= 10;
        }
    const char *half = p + strspn(p, " ");
    if (strncasecmp(half, "AM", 2) == 0 || strncasecmp(half, "PM", 2) == 0) {
        if (h < 1 || h > 12)
            return NULL;
        h = h % 12 + (*half == 'p' || *half == 'P' ? 12 : 0);
        p = half + 2;
    }
    to->seconds = (double)(3600 * h + 60 * m + s) + fraction / unit;
    return p;
}

/* A zone may stand at the end: "Z", "+01", "+01:00" or "+0100". */
time_stamp
ss_stamp_read(const char *cell)
{
    const time_stamp none = { 0 };
    time_stamp found = none;
    long h = 0, m = 0;
    const char *p = read_date(cell, found.day);
    if (p != NULL) {
        found.parts = STAMP_DATE;
        if (*p == '\0')
            return found;
        if (*p != 'T' && *p != ' ')
            return none;
        p += *p == 'T' ? 1 : strspn(p, " ");
    }
    p = read_time(p != NULL ? p : cell, &found);
    if (p != NULL && *p == 'Z') {
        p++;
    } else if (p != NULL && *p != '\0') {
        int sign = *p == '-' ? -1 : 1;
        p = read_part(p, "+-", &h);
        if (p != NULL && *p != '\0')
            p = read_digits(p + (*p == ':'), 2, &m);
        found.seconds -= sign * (double)(3600 * h + 60 * m);
    }
    found.parts |= STAMP_TIME;
    return p != NULL && *p == '\0' && h <= 23 && m <= 59 ? found : none;
}

static int
order_of(const struct stamp_column *c)
{
    return c->fits[DAY_FIRST] ? DAY_FIRST : MONTH_FIRST;
}

double
ss_stamp_day(const struct stamp_column *c)
{
    int open = c->fits[DAY_FIRST] && c->fits[MONTH_FIRST] && c->first[DAY_FIRST] != c->first[MONTH_FIRST];
    return c->dated && !open ? (double)c->first[order_of(c)] : NAN;
}

/* The days since the first row.  Day and month have the same order in all rows.  A day above 12 shows it, or
 * else, where the date changes, the order in which the next day follows.  NaN: the date fits no order. */
static double
count_days(struct stamp_column *c, const long day[ORDERS])
{
    if (!c->dated)
        memcpy(c->first, day, sizeof c->first);
    for (int i = 0; i < ORDERS; i++)
        c->fits[i] &= day[i] != NO_DAY;
    if (c->dated && c->fits[DAY_FIRST] && c->fits[MONTH_FIRST]
        && day[DAY_FIRST] - c->first[DAY_FIRST] != day[MONTH_FIRST] - c->first[MONTH_FIRST])
        for (int i = 0; i < ORDERS; i++)
            c->fits[i] = day[i] == c->before[i] + 1;
    memcpy(c->before, day, sizeof c->before);
    c->dated = 1;
    int order = order_of(c);
    return c->fits[order] ? (double)(day[order] - c->first[order]) : NAN;
}

/* Times without a date go on at midnight, and those without hours at the hour.  Second 60 is the next minute's
 * second 0 unless that follows, too: then it was a leap second. */
double
ss_stamp_next(struct stamp_column *c, const char *cell)
{
    const time_stamp s = ss_stamp_read(cell);
    double seconds = s.seconds;
    if (s.parts != c->parts)
        return NAN;
    if (c->parts & STAMP_DATE)
        seconds += 86400 * count_days(c, s.day);
    else if (!isnan(c->last))                   /* on the day that brings it nearest to the row before */
        seconds += s.turn * floor((c->last - s.seconds) / s.turn + 0.5);
    c->leaps += c->leap && !s.leap && seconds <= c->last;
    c->leap = s.leap;
    c->last = seconds;
    return seconds + c->leaps;
}
