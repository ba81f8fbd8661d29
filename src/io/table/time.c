/* time.c -- find the column of time of a table, by its name or unit, and the clock that its numbers, dates or
 * times of day show. */
#include <stickslip/signal.h>

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>
#include "base/error.h"
#include "base/number.h"
#include "signal/source.h"
#include "io/table/sheet.h"

/* --- units of numbers that are times -------------------------------------------------------- */

#define SECONDS_A_DAY 86400.

/* Seconds are numbers * factor / divisor. */
struct time_unit {
    const char *name, *others;  /* the usual name; other names, with blanks between them */
    double factor, divisor;
    int is_name;                /* 1: a column with only this name holds times */
};

static const struct time_unit units_of_time[] = {
    { "s", "sec secs second seconds", 1, 1, 0 },
    { "ms", "msec millisecond milliseconds", 1, 1e3, 1 },
    { "us", "usec microsecond microseconds \u00b5s \u03bcs", 1, 1e6, 1 },
    { "ns", "nsec nanosecond nanoseconds", 1, 1e9, 1 },
    { "min", "minute minutes", 60, 1, 0 },
    { "h", "hr hour hours", 3600, 1, 0 },
    { "d", "day days datenum mjd", SECONDS_A_DAY, 1, 0 }
};
enum { UNITS_OF_TIME = sizeof units_of_time / sizeof *units_of_time };

const char *
ss_time_unit_name(size_t i)
{
    return i < UNITS_OF_TIME ? units_of_time[i].name : NULL;
}

/* Is this word of n bytes in the list, in upper or lower case? */
static int
is_in_list(const char *list, const char *word, size_t n)
{
    for (; n > 0 && *list != '\0'; list += strcspn(list, " "), list += *list == ' ')
        if (strcspn(list, " ") == n && strncasecmp(list, word, n) == 0)
            return 1;
    return 0;
}

const struct time_unit *
ss_time_unit_find(const char *name)
{
    for (const struct time_unit *unit = units_of_time; unit < units_of_time + UNITS_OF_TIME; unit++)
        if (strcasecmp(unit->name, name) == 0 || is_in_list(unit->others, name, strlen(name)))
            return unit;
    return NULL;
}

/* The unit that is the name of a column or its end, as in ms and Time_ms; NULL: there is none.  *length
 * becomes the number of letters before it. */
static const struct time_unit *
unit_in(const char *name, size_t *length)
{
    size_t n = strlen(name);
    while (n > 0 && strchr("_.-", name[n - 1]) == NULL)
        n--;
    const struct time_unit *unit = ss_time_unit_find(name + n);
    *length = unit == NULL ? strlen(name) : n > 0 ? n - 1 : 0;
    return unit;
}

int
ss_is_called_time(const char *name)
{
    static const char words[] = "t time timestamp time_stamp datetime date_time epoch unix_time zeit temps "
        "tempo tiempo elapsed elapsed_time x_value";
    static const char alone[] = "sec second seconds datenum mjd";
    size_t length;
    name += *name == '%';                       /* MATLAB's comment */
    const struct time_unit *unit = unit_in(name, &length);
    if (unit != NULL && length == 0)
        return unit->is_name || is_in_list(alone, name, strlen(name));
    return is_in_list(words, name, length);
}

/* The unit in which a number is a date between 2000 and 2100, counted from 1970; NULL: there is none. */
static const struct time_unit *
unit_of_date(double number)
{
    for (size_t i = 0; i < 4; i++) {
        double seconds = number / units_of_time[i].divisor;
        if (seconds >= 946684800 && seconds < 4102444800)
            return &units_of_time[i];
    }
    return NULL;
}

/* Is this the number of a day of our time, as Excel, MATLAB or astronomers count days? */
static int
is_day_now(double number)
{
    return (number >= 20000 && number < 80000)          /* Excel's days of 1954 to 2119, MJD of 1913 to 2077 */
        || (number >= 690000 && number < 770000)        /* MATLAB's of 1889 to 2108 */
        || (number >= 2430000 && number < 2490000);     /* Julian days of 1941 to 2105 */
}

/* --- clocks ---------------------------------------------------------------------------------- */

enum { GAPS_MOST = 1000 };      /* at most so many samples for each one that is not missing */
#define SAME 1.1                /* times a rate: that of uneven stamps is known no better */
#define LONGEST 10              /* usual steps; stamps farther apart have a gap between them */
/* A short file cannot claim much memory by two time stamps that lie far apart. */
enum { MOST_SAMPLES = 1000000, MOST_PER_STAMP = 1000 };

#define LEAST_RATE (1 / 3600. * (1 - 1e-9))     /* a sample an hour */
#define MOST_RATE 1e10
#define MOST_IN_SECONDS 1e6     /* [Hz] a faster clock that begins with the number of a day counts days */
#define LEAST_IN_DAYS .1        /* [Hz] slower records of days are not looked for */
enum { ROUND = 4 };             /* digits of a rate in days; those of scattered stamps have more */
#define DOUBTED_RATE 100.       /* [Hz] a slower clock without a unit may count milliseconds */

void
ss_sheet_warn(const struct sheet *t, ss_status about, const char *format, ...)
{
    ss_error text;
    va_list args;
    if (t->opts->warn == NULL)
        return;
    va_start(args, format);
    ss_print_text(text.text, sizeof text.text, format, args);
    va_end(args);
    t->opts->warn(about, text.text, t->opts->user);
}

/* The clock is opts->resample; check that the stamps, which begin at t->names->start, can be resampled to it. */
static ss_status
find_resampled(struct sheet *t, struct stamps s, double usual, double longest, ss_error *err)
{
    double start = t->names->start, gap = -1, rate = t->names->rate = t->opts->resample;
    while (ss_stamps_next(&s))
        if (s.n > 1 && gap < 0 && s.stamp - s.before > longest)
            gap = ss_resample_gap(s.before - start, s.stamp - start, rate);
    double samples = ss_resample_count(start, s.stamp, rate);
    if (samples > MOST_SAMPLES && samples / MOST_PER_STAMP >= (double)s.n + 1)
        return ss_fail(err, SS_EDATA, "%s: %zu time stamps would become %.15g samples at %g Hz", t->name, s.n,
                       samples, rate);
    if (t->opts->gaps != SS_GAPS_REFUSE || gap < 0)
        return SS_OK;
    return ss_fail(err, SS_EGAPS, "%s: a gap around %g s, of more than ten usual steps of %g s", t->name,
                   start + gap / rate, usual);
}

/* Find the clock of the times in a column, which have this last digit, or 0.  *own becomes their rate. */
static ss_status
read_stamps(struct sheet *t, struct timing *timing, double digit, double *own, ss_error *err)
{
    const struct time_column *time = &timing->time;
    struct stamps s = { &t->rows, *time, .n = 0 };
    int gaps = t->opts->gaps != SS_GAPS_REFUSE;
    ss_status st = ss_stamps_check(s, err);
    if (st != SS_OK)
        return st;
    if (t->opts->resample > 0 || t->opts->stamps) {
        struct stamps first = s;
        double usual = ss_usual_step(s);
        *own = t->names->rate = 1 / usual;
        ss_stamps_next(&first);
        t->names->start = first.stamp;
        if (!(t->opts->resample > 0))
            return SS_OK;
        if (*own > SAME * t->opts->resample)
            ss_sheet_warn(t, SS_OK, "%s: frequencies above %g Hz fold down", t->name, t->opts->resample / 2);
        timing->longest = LONGEST * usual;
        return find_resampled(t, s, usual, timing->longest, err);
    }
    timing->usual = gaps ? ss_usual_step(s) : 0;
    struct clock clock = { .usual = timing->usual, .taken = time->zero * time->factor / time->divisor,
                           .digit = gaps ? 0 : digit };
    st = ss_find_clock(s, &clock, err);
    *own = t->names->rate = clock.rate;
    t->names->start = clock.start;
    if (st == SS_OK && (clock.last + 1) / GAPS_MOST >= (double)clock.n + 1)
        st = ss_fail(err, SS_EDATA, "%s: of %.15g samples only %zu are there", t->name, clock.last + 1, clock.n);
    return st;
}

/* --- a column of numbers ------------------------------------------------------------------- */

/* Are times from `first` on, which give this rate if they are seconds, rather days?  Seconds that begin late may
 * have such numbers, but then not a rate that is round in days only. */
static int
are_days(double first, double rate)
{
    if (!is_day_now(first) || !(rate >= LEAST_IN_DAYS * SECONDS_A_DAY * (1 - 1e-9)))
        return 0;
    int digits = ss_clock_digits(rate / SECONDS_A_DAY);
    return rate > MOST_IN_SECONDS || (digits <= ROUND && digits < ss_clock_digits(rate));
}

static ss_status
ask_about_days(const struct sheet *t, const char *name, double first, double rate, ss_error *err)
{
    return ss_fail(err, SS_EUNIT, "%s: column %s has no unit and looks like days, %.3g Hz from day %.9g on; "
                   "seconds would give %.3g Hz", t->name, name, rate / SECONDS_A_DAY, first, rate);
}

/* SS_EUNIT for a clock that no laboratory has, unless the caller gave its unit.  Warn of a clock without a
 * unit that would be usual in another unit. */
static ss_status
check_rate(const struct sheet *t, const char *name, const struct time_unit *given, double first, double rate,
           ss_error *err)
{
    const char *unit = given == NULL ? "s" : given->name;
    if (t->opts->time_unit != NULL)
        return SS_OK;
    if (given == NULL && are_days(first, rate))
        return ask_about_days(t, name, first, rate, err);
    if (!(rate >= LEAST_RATE && rate <= MOST_RATE))
        return ss_fail(err, SS_EUNIT, "%s: column %s, read in %s, gives a clock of %.3g Hz, which no laboratory "
                       "has", t->name, name, unit, rate);
    if (given == NULL && rate < DOUBTED_RATE)
        ss_sheet_warn(t, SS_EUNIT, "%s: column %s has no unit and is read in seconds: %.3g Hz", t->name,
                          name, rate);
    return SS_OK;
}

/* The unit is that which the caller, the file or the column's name gives, or that of a date, else seconds. */
static ss_status
read_clock(struct sheet *t, size_t column, struct timing *timing, ss_error *err)
{
    const char *name = t->names->column[column].name;
    const char *own = t->opts->time_unit != NULL ? t->opts->time_unit : t->names->column[column].unit;
    double rate = 0, first = NAN;
    char text[32];
    size_t length;
    const double *row;
    for (uint64_t i = 0; isnan(first) && (row = ss_kept_row(&t->rows, i)) != NULL; i++)
        first = row[column];
    const struct time_unit *known = *own != '\0' ? ss_time_unit_find(own) : strcasecmp(name, "x_value") == 0
        ? ss_time_unit_find("s") : unit_in(name, &length);
    if (known == NULL && *own != '\0')
        return ss_fail(err, SS_EDATA, "%s: column %s: unit '%.40s' is not one of time", t->name, name, own);
    if (known == NULL && (known = unit_of_date(first)) != NULL)
        ss_sheet_warn(t, SS_EUNIT, "%s: column %s has no unit and is read in %s since 1970", t->name, name,
                      known->name);
    const struct time_unit *unit = known != NULL ? known : ss_time_unit_find("s");
    double zero = unit->factor < SECONDS_A_DAY ? 0 : trunc(first);      /* so that no digit is lost */
    timing->time = (struct time_column){ column, t->counted.origin, zero, unit->factor, unit->divisor };
    /* 1 in the last digit of the times in a column of days is so many days, as far as doubles have it */
    double days = 1, apart = nextafter(fabs(zero), INFINITY) - fabs(zero);
    for (uint64_t i = 0; zero != 0 && (row = ss_kept_row(&t->rows, i)) != NULL; i++)
        while (days > 10 * apart && fabs(remainder(row[column] - zero, days)) > apart)
            days /= 10;
    ss_status st = read_stamps(t, timing, zero != 0 ? SECONDS_A_DAY * days : 0, &rate, err);
    if (st == SS_OK)
        st = check_rate(t, name, known, first, rate, err);
    else if ((st == SS_EUNEVEN || st == SS_EGAPS) && known == NULL) {
        rate = 1 / ss_usual_step((struct stamps){ &t->rows, timing->time, .n = 0 });
        if (are_days(first, rate))
            st = ask_about_days(t, name, first, rate, err);
    }
    if (st != SS_OK || zero == 0)
        return st;
    snprintf(text, sizeof text, "%.0f", zero);  /* the day from whose midnight on seconds are counted */
    return ss_header_note(t->names, "day", text, NULL) == SS_OK ? SS_OK : ss_fail_memory(err, t->name);
}

/* --- dates and times of day ---------------------------------------------------------------- */

/* Find the clock of a column of dates, times of day or both. */
static ss_status
read_stamp_clock(struct sheet *t, size_t column, struct timing *timing, ss_error *err)
{
    double rate, day = NAN, own = ss_stamp_day(&t->column[column].stamps);
    char text[80];
    struct tm date;
    if (t->opts->time_unit != NULL)
        return ss_fail(err, SS_EDATA, "%s: column %s holds times of day or dates, so it has no unit to choose",
                       t->name, t->names->column[column].name);
    for (size_t i = t->n_columns; i-- > 0;)
        if (t->column[i].kind == COLUMN_STAMPS && !isnan(ss_stamp_day(&t->column[i].stamps)))
            day = ss_stamp_day(&t->column[i].stamps);
    day = isnan(own) ? day : own;
    timing->time = (struct time_column){ column, t->counted.origin, 0, 1, 1 };
    ss_status st = read_stamps(t, timing, 0, &rate, err);
    if (st != SS_OK || isnan(day))
        return st;
    time_t seconds = (time_t)(day * SECONDS_A_DAY);
    gmtime_r(&seconds, &date);
    snprintf(text, sizeof text, "%04d-%02d-%02d", date.tm_year + 1900, date.tm_mon + 1, date.tm_mday);
    return ss_header_note(t->names, "date", text, NULL) == SS_OK ? SS_OK : ss_fail_memory(err, t->name);
}

/* --- the choice ---------------------------------------------------------------------------- */

static ss_status
no_such_column(const struct sheet *t, const char *name, ss_error *err)
{
    char list[300] = "";
    size_t length = 0, room = sizeof list - sizeof " ...";
    for (size_t i = 0, before; i < t->n_columns && length < room; i++) {
        before = length;
        length += (size_t)snprintf(list + length, room - length, "%s%s", i > 0 ? ", " : "",
                                   t->names->column[i].name);
        if (length >= room)
            strcpy(list + before, " ...");
    }
    return ss_fail(err, SS_EDATA, "%s: no column '%.40s', there are %s", t->name, name, list);
}

static ss_status
refuse_text(const struct sheet *t, size_t column, ss_status st, ss_error *err)
{
    return ss_fail(err, st, "%s: column %s holds text, not times such as 10:12:13.5, 12:13.5, "
                   "2024-03-05 10:12:13.5", t->name, t->names->column[column].name);
}

/* The column of time, or NONE: one with the name of a time, or else the first of dates with times, or else of
 * times, or else of dates.  *guessed becomes 1 if only its place suggests that it is one. */
static size_t
find_time(const struct sheet *t, int *guessed)
{
    static const unsigned parts[] = { STAMP_DATE | STAMP_TIME, STAMP_TIME, STAMP_DATE };
    const ss_read_opts *opts = t->opts;
    const ss_column *column = t->names->column;
    int chosen = opts->time != NULL ? ss_header_column(t->names, opts->time) : -1;
    *guessed = 0;
    if (opts->time != NULL || opts->rate > 0)
        return chosen >= 0 ? (size_t)chosen : NONE;
    if (t->counted.increment > 0)
        return t->counted.numbered ? 0 : NONE;
    for (size_t i = 0; i < t->n_columns; i++)
        if (t->column[i].kind == COLUMN_NUMBERS && ss_is_called_time(column[i].name))
            return i;
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        for (size_t i = 0; i < t->n_columns; i++)
            if (t->column[i].kind == COLUMN_STAMPS && t->column[i].stamps.parts == parts[k])
                return i;
    size_t first = 0;
    while (first < t->n_columns && t->column[first].kind != COLUMN_NUMBERS)
        first++;
    if (first + 2 > t->n_columns)
        return NONE;
    if (*column[first].unit != '\0' && ss_time_unit_find(column[first].unit) != NULL)
        return first;
    *guessed = !t->named;                       /* if named, it may be a deflection that ascends */
    return *guessed ? first : NONE;
}

ss_status
ss_sheet_mark_spare(struct sheet *t, ss_error *err)
{
    if (t->opts->n_needed == 0)
        return SS_OK;
    ss_header *head = NULL;
    int guessed;
    size_t n = 0, time = find_time(t, &guessed), *channel = malloc(t->n_columns * sizeof *channel);
    /* this header has the numbers of the signal, which a column of time that is only guessed leaves open */
    for (size_t c = 0; channel != NULL && c < t->n_columns && !guessed; c++)
        if (c != time && t->column[c].kind == COLUMN_NUMBERS)
            channel[n++] = c;
    if (channel == NULL || ss_header_select(&head, t->names, channel, n, 0, NULL) != SS_OK) {
        free(channel);
        return ss_fail_memory(err, t->name);
    }
    for (size_t i = 0; i < n; i++)
        t->column[channel[i]].spare = 1;
    for (size_t i = 0; i < t->opts->n_needed; i++) {
        int found = ss_header_column(head, t->opts->needed[i]);
        if (found >= 0)
            t->column[channel[found]].spare = 0;
    }
    ss_header_free(head);
    free(channel);
    return SS_OK;
}

/* Find the clock of a column that the caller has named, or that shows that it is one of time. */
static ss_status
read_column(struct sheet *t, size_t column, struct timing *timing, ss_error *err)
{
    enum column_kind kind = t->column[column].kind;
    return kind == COLUMN_TEXT ? refuse_text(t, column, SS_EDATA, err)
        : (kind == COLUMN_STAMPS ? read_stamp_clock : read_clock)(t, column, timing, err);
}

ss_status
ss_sheet_find_clock(struct sheet *t, struct timing *timing, ss_error *err)
{
    int guessed;
    const ss_read_opts *opts = t->opts;
    size_t column = find_time(t, &guessed);
    double rate, step = t->counted.increment;
    *timing = (struct timing){ .time = { NONE, 0, 0, 1, 1 } };
    if (opts->time != NULL) {
        t->counted.origin = 0;
        return column != NONE ? read_column(t, column, timing, err) : no_such_column(t, opts->time, err);
    }
    if (opts->rate > 0) {
        t->names->rate = opts->rate;
        return SS_OK;
    }
    if (step > 0 && opts->time_unit != NULL)
        return ss_fail(err, SS_EDATA, "%s: its header gives the clock in seconds: no unit of time can be chosen",
                       t->name);
    if (step > 0 && t->counted.numbered) {
        timing->time = (struct time_column){ 0, t->counted.origin, 0, step, 1 };
        return read_stamps(t, timing, 0, &rate, err);
    }
    if (step > 0) {                             /* rows follow each other at a step that the header gives */
        t->names->rate = 1 / step;
        t->names->start = t->counted.origin;
        return SS_OK;
    }
    if (column != NONE && !guessed)
        return read_column(t, column, timing, err);
    ss_status st = guessed ? read_clock(t, column, timing, err) : SS_ECLOCK;
    if (st == SS_OK || st == SS_EUNIT || st == SS_ENOMEM)
        return st == SS_ENOMEM ? ss_fail_memory(err, t->name) : st;
    if (t->clue != NULL)
        return ss_fail(err, SS_ECLOCK, "%s: no column of time, but line %lu may give the rate: '%.80s'", t->name,
                       t->clue_line, t->clue);
    for (size_t i = 0; i < t->n_columns; i++)
        if (t->column[i].kind == COLUMN_TEXT && ss_is_called_time(t->names->column[i].name))
            return refuse_text(t, i, SS_ECLOCK, err);
    return ss_fail(err, SS_ECLOCK, "%s: no column of time", t->name);
}

ss_status
ss_sheet_is_plain(struct sheet *t, int *yes)
{
    ss_read_opts quiet = *t->opts;
    struct sheet first = *t;
    struct timing timing;
    quiet.warn = NULL;
    first.opts = &quiet;
    ss_status st = ss_sheet_find_clock(&first, &timing, NULL);
    size_t time = timing.time.column;
    *yes = st == SS_OK && (time == NONE || (t->column[time].kind == COLUMN_NUMBERS && timing.time.zero == 0));
    struct stamps s = { &first.rows, timing.time, .n = 0 };
    while (*yes && time != NONE && ss_stamps_next(&s))
        *yes = ss_is_on_clock(s.stamp, t->names->rate, t->names->start, s.n - 1);
    return st == SS_ENOMEM ? st : SS_OK;
}
