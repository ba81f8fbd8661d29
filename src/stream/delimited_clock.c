/* delimited_clock.c -- find the column of time of a text table, and make its rows samples of a clock. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/error.h"
#include "signal/resample.h"
#include "stream/clock.h"
#include "stream/delimited.h"
#include "stream/stamp.h"

enum { GAPS_MOST = 1000 };      /* samples for each that is there */

#define LEAST_RATE (1 / 3600. * (1 - 1e-9))     /* a sample an hour */
#define MOST_RATE 1e10
#define DOUBTED_RATE 100.       /* [Hz] a clock below, of no unit, may count milliseconds */

/* Seconds are stamps * factor / divisor. */
struct time_unit {
    const char *name, *others;  /* the usual name; others, with blanks between */
    double factor, divisor;
    int is_name;                /* does a column of such a name hold times? */
};

static const struct time_unit units_of_time[] = {
    { "s", "sec secs second seconds", 1, 1, 0 },
    { "ms", "msec millisecond milliseconds", 1, 1e3, 1 },
    { "us", "usec microsecond microseconds \u00b5s \u03bcs", 1, 1e6, 1 },
    { "ns", "nsec nanosecond nanoseconds", 1, 1e9, 1 },
    { "min", "minute minutes", 60, 1, 0 },
    { "h", "hr hour hours", 3600, 1, 0 }
};
enum { UNITS_OF_TIME = sizeof units_of_time / sizeof *units_of_time };

const char *
ss_time_unit_name(size_t i)
{
    return i < UNITS_OF_TIME ? units_of_time[i].name : NULL;
}

/* Is the word of n bytes one of those in the list, in any case? */
static int
is_in_list(const char *list, const char *word, size_t n)
{
    for (; n > 0 && *list != '\0'; list += strcspn(list, " "), list += *list == ' ')
        if (strcspn(list, " ") == n && strncasecmp(list, word, n) == 0)
            return 1;
    return 0;
}

static const struct time_unit *
find_time_unit(const char *name)
{
    for (const struct time_unit *unit = units_of_time; unit < units_of_time + UNITS_OF_TIME; unit++)
        if (strcasecmp(unit->name, name) == 0 || is_in_list(unit->others, name, strlen(name)))
            return unit;
    return NULL;
}

/* The unit that a column's name is or ends with, or NULL: ms, Time_ms.  *length: of what stands
 * before. */
static const struct time_unit *
unit_in_name(const char *name, size_t *length)
{
    size_t n = strlen(name);
    while (n > 0 && strchr("_.-", name[n - 1]) == NULL)
        n--;
    const struct time_unit *unit = find_time_unit(name + n);
    *length = unit == NULL ? strlen(name) : n > 0 ? n - 1 : 0;
    return unit;
}

/* Is this column called time, as Time, t, time_ms, ms and Seconds are? */
static int
is_called_time(const ss_column *c)
{
    static const char words[] = "t time timestamp time_stamp datetime date_time epoch unix_time zeit temps "
        "tempo tiempo elapsed elapsed_time x_value";
    static const char alone[] = "sec second seconds";
    size_t length;
    const struct time_unit *unit = unit_in_name(c->name, &length);
    if (unit != NULL && length == 0)
        return unit->is_name || is_in_list(alone, c->name, strlen(c->name));
    return is_in_list(words, c->name, length);
}

/* A number of no unit that is a date between 2000 and 2100 in seconds since 1970, or in parts of
 * them: those, else NULL. */
static const struct time_unit *
unit_of_date(double stamp)
{
    for (size_t i = 0; i < 4; i++) {
        double seconds = stamp / units_of_time[i].divisor;
        if (seconds >= 946684800 && seconds < 4102444800)
            return &units_of_time[i];
    }
    return NULL;
}

/* The unit of a column of numbers that are times: that given by the caller, the file or the
 * column's name, or else that of a date; NULL if nothing says what it is. */
static ss_status
unit_of_times(const struct table *t, size_t column, const struct time_unit **unit, int *is_date, ss_error *err)
{
    size_t length;
    const ss_column *c = &t->names->column[column];
    const char *own = t->opts->time_unit != NULL ? t->opts->time_unit : c->unit;
    *unit = *own != '\0' ? find_time_unit(own) : strcasecmp(c->name, "x_value") == 0
        ? &units_of_time[0] : unit_in_name(c->name, &length);
    if (*unit == NULL && *own != '\0')
        return ss_fail(err, SS_EDATA, "%s: column %s: unit '%.40s' is not one of time", t->in->name,
                       c->name, own);
    *is_date = *unit == NULL && (*unit = unit_of_date(t->value[column])) != NULL;
    return SS_OK;
}

/* Forget the rows without a time. */
static void
drop_rows_without(struct table *t, size_t column)
{
    size_t kept = 0, n = t->n_columns;
    for (size_t i = 0; i < t->n_rows; i++)
        if (!isnan(t->value[i * n + column])) {
            memmove(t->value + kept * n, t->value + i * n, n * sizeof *t->value);
            t->line[kept++] = t->line[i];
        }
    t->n_rows = kept;
}

/* The rows as samples at their indices, NaN between them. */
static ss_status
spread_rows(struct table *t, const size_t *sample, ss_error *err)
{
    size_t n = t->n_columns, all = sample[t->n_rows - 1] + 1;
    if (all == t->n_rows)
        return SS_OK;
    if (all / GAPS_MOST > t->n_rows)
        return ss_fail(err, SS_EDATA, "%s: of %zu samples only %zu are there", t->in->name, all,
                       t->n_rows);
    double *value = malloc(all * n * sizeof *value);
    if (value == NULL)
        return ss_delimited_no_memory(t, err);
    for (size_t i = 0; i < all * n; i++)
        value[i] = NAN;
    for (size_t i = 0; i < t->n_rows; i++)
        memcpy(value + sample[i] * n, t->value + i * n, n * sizeof *value);
    free(t->value);
    t->value = value;
    t->n_rows = all;
    return SS_OK;
}

/* Rows at stamps as samples of a clock: that of the stamps, or that of opts->resample.  *own: the
 * rate of the stamps. */
static ss_status
place_rows(struct table *t, const double *stamp, double *own, ss_error *err)
{
    const char *name = t->in->name;
    int gaps = t->opts->gaps != SS_GAPS_REFUSE;
    size_t *sample = NULL, n = t->n_rows;
    double usual, *value;
    if (!(t->opts->resample > 0)) {
        sample = malloc((n + 1) * sizeof *sample);
        if (sample == NULL)
            return ss_delimited_no_memory(t, err);
        ss_status st = ss_find_clock(name, stamp, t->line, n, gaps, sample, &t->names->rate, err);
        if (st == SS_OK)
            st = spread_rows(t, sample, err);
        free(sample);
        *own = t->names->rate;
        return st;
    }
    ss_status st = ss_usual_step(name, stamp, t->line, n, &usual, err);
    t->names->rate = t->opts->resample;
    *own = 1 / usual;
    if (st == SS_OK)
        st = ss_resample(&value, &n, stamp, t->value, n, t->n_columns, usual, t->names->rate, name, err);
    if (st != SS_OK)
        return st;
    free(t->value);
    t->value = value;
    t->n_rows = n;
    for (size_t i = 0; !gaps && i < n; i++)
        if (isnan(value[i * t->n_columns]))
            return ss_fail(err, SS_EGAPS, "%s: a gap around %g s, of more than ten usual steps of %g s", name,
                           stamp[0] + (double)i / t->names->rate, usual);
    return SS_OK;
}

/* The column holds times in this unit, counted from an origin; *own: their rate. */
static ss_status
read_stamps(struct table *t, size_t column, double factor, double divisor, double *own, ss_error *err)
{
    t->time = column;
    if (t->twice) {
        ss_status even = ss_clock_rate(&t->fit, t->in->name, &t->names->rate, err);
        t->names->start = t->fit.first.stamp;
        *own = t->names->rate;
        return even;
    }
    drop_rows_without(t, column);
    double *stamp = malloc((t->n_rows + 1) * sizeof *stamp);
    if (stamp == NULL)
        return ss_delimited_no_memory(t, err);
    for (size_t i = 0; i < t->n_rows; i++)
        stamp[i] = t->counted.origin + t->value[i * t->n_columns + column] * factor / divisor;
    ss_status st = place_rows(t, stamp, own, err);
    if (st == SS_OK)
        t->names->start = stamp[0];
    free(stamp);
    return st;
}

/* Ask about a clock that no laboratory has, unless the caller gave its unit; doubt one without unit
 * that would be usual with another. */
static ss_status
check_rate(const struct table *t, const char *name, const struct time_unit *given, double rate, ss_error *err)
{
    const char *unit = given == NULL ? "s" : given->name;
    if (t->opts->time_unit != NULL)
        return SS_OK;
    if (!(rate >= LEAST_RATE && rate <= MOST_RATE))
        return ss_fail(err, SS_EUNIT, "%s: column %s, read in %s, gives a clock of %.3g Hz, which no laboratory "
                       "has", t->in->name, name, unit, rate);
    if (given == NULL && rate < DOUBTED_RATE)
        ss_delimited_warn(t, SS_EUNIT, "%s: column %s has no unit and is read in seconds: %.3g Hz", t->in->name,
                          name, rate);
    return SS_OK;
}

static ss_status
read_clock(struct table *t, size_t column, ss_error *err)
{
    const struct time_unit *known;
    const char *name = t->names->column[column].name;
    int is_date;
    double rate = 0;
    ss_status st = unit_of_times(t, column, &known, &is_date, err);
    if (st != SS_OK)
        return st;
    if (is_date)
        ss_delimited_warn(t, SS_EUNIT, "%s: column %s has no unit and is read in %s since 1970", t->in->name,
                          name, known->name);
    const struct time_unit *unit = known != NULL ? known : &units_of_time[0];
    st = read_stamps(t, column, unit->factor, unit->divisor, &rate, err);
    return st == SS_OK ? check_rate(t, name, known, rate, err) : st;
}

/* --- dates and times of day ---------------------------------------------------------------- */

static ss_status
note_date(struct table *t, double day)
{
    char text[80];
    long n = (long)day + 719468, era = (n >= 0 ? n : n - 146096) / 146097, of_era = n - era * 146097;
    long year = (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365;
    long of_year = of_era - (365 * year + year / 4 - year / 100), month = (5 * of_year + 2) / 153;
    snprintf(text, sizeof text, "%04ld-%02ld-%02ld", year + 400 * era + (month > 9),
             month > 9 ? month - 9 : month + 3, of_year - (153 * month + 2) / 5 + 1);
    return ss_header_note(t->names, "date", text);
}

/* A clock of a column of dates, times or both. */
static ss_status
read_stamp_clock(struct table *t, size_t column, ss_error *err)
{
    double rate, day = NAN;
    if (t->opts->time_unit != NULL)
        return ss_fail(err, SS_EDATA, "%s: column %s holds times of day or dates, so it has no unit to choose",
                       t->in->name, t->names->column[column].name);
    for (size_t i = t->n_columns; i-- > 0;)
        if (t->column[i].kind == COLUMN_STAMPS && !isnan(t->column[i].day))
            day = t->column[i].day;
    if (!isnan(t->column[column].day))
        day = t->column[column].day;
    ss_status st = read_stamps(t, column, 1, 1, &rate, err);
    if (st == SS_OK && !isnan(day) && note_date(t, day) != SS_OK)
        st = ss_delimited_no_memory(t, err);
    return st;
}

/* The first column of such stamps, or NONE. */
static size_t
find_stamps(const struct table *t, unsigned parts)
{
    for (size_t i = 0; i < t->n_columns; i++)
        if (t->column[i].kind == COLUMN_STAMPS && t->column[i].parts == parts)
            return i;
    return NONE;
}

/* The column that tells most of when, or NONE. */
static size_t
find_any_stamps(const struct table *t)
{
    size_t both = find_stamps(t, STAMP_DATE | STAMP_TIME), time = find_stamps(t, STAMP_TIME);
    return both != NONE ? both : time != NONE ? time : find_stamps(t, STAMP_DATE);
}

/* ------------------------------------------------------------------------------------------- */

static ss_status
no_such_column(const struct table *t, const char *name, ss_error *err)
{
    char list[300] = "";
    size_t length = 0, room = sizeof list - sizeof " ...";
    for (size_t i = 0; i < t->n_columns && length < room; i++) {
        size_t before = length;
        length += (size_t)snprintf(list + length, room - length, "%s%s", i > 0 ? ", " : "",
                                   t->names->column[i].name);
        if (length >= room)
            strcpy(list + before, " ...");
    }
    return ss_fail(err, SS_EDATA, "%s: no column '%.40s', there are %s", t->in->name, name, list);
}

/* The column of time that the caller names. */
static ss_status
read_chosen(struct table *t, size_t chosen, ss_error *err)
{
    if (chosen == NONE)
        return no_such_column(t, t->opts->time, err);
    t->counted.origin = 0;
    switch (t->column[chosen].kind) {
    case COLUMN_STAMPS:  return read_stamp_clock(t, chosen, err);
    case COLUMN_NUMBERS: return read_clock(t, chosen, err);
    case COLUMN_TEXT:    break;
    }
    return ss_fail(err, SS_EDATA, "%s: column %s holds text, not times", t->in->name,
                   t->names->column[chosen].name);
}

/* Rows one after the other at a step that the header gives. */
static ss_status
count_rows(struct table *t)
{
    t->names->rate = 1 / t->counted.increment;
    t->names->start = t->counted.origin;
    return SS_OK;
}

/* The column of time, or NONE; *guessed: only its place says so. */
static size_t
find_time(const struct table *t, int *guessed)
{
    const ss_read_opts *opts = t->opts;
    const ss_column *column = t->names->column;
    int chosen = opts->time != NULL ? ss_header_column(t->names, opts->time) : -1;
    *guessed = 0;
    if (opts->time != NULL || opts->rate > 0)
        return chosen >= 0 ? (size_t)chosen : NONE;
    if (t->counted.increment > 0)
        return t->counted.numbered ? 0 : NONE;
    for (size_t i = 0; i < t->n_columns; i++)
        if (t->column[i].kind == COLUMN_NUMBERS && is_called_time(&column[i]))
            return i;
    size_t stamps = find_any_stamps(t);
    if (stamps != NONE)
        return stamps;
    if (t->n_columns < 2 || t->column[0].kind != COLUMN_NUMBERS)
        return NONE;
    if (*column[0].unit != '\0' && find_time_unit(column[0].unit) != NULL)
        return 0;
    *guessed = !t->named;                       /* a force over its deflection ascends too */
    return *guessed ? 0 : NONE;
}

struct time_column
ss_delimited_time(const struct table *t)
{
    int guessed, is_date;
    struct time_column time = { find_time(t, &guessed), 1, 1 };
    const struct time_unit *unit;
    if (time.column == NONE || t->column[time.column].kind == COLUMN_STAMPS)
        return time;
    if (t->column[time.column].kind == COLUMN_TEXT
        || unit_of_times(t, time.column, &unit, &is_date, NULL) != SS_OK)
        return (struct time_column){ NONE, 1, 1 };
    if (unit != NULL)
        time = (struct time_column){ time.column, unit->factor, unit->divisor };
    return time;
}

ss_status
ss_delimited_choose_clock(struct table *t, ss_error *err)
{
    int guessed;
    size_t column = find_time(t, &guessed);
    double rate;
    if (t->opts->time != NULL)
        return read_chosen(t, column, err);
    if (t->opts->rate > 0) {
        t->names->rate = t->opts->rate;
        return SS_OK;
    }
    if (t->counted.increment > 0)
        return t->counted.numbered ? read_stamps(t, 0, t->counted.increment, 1, &rate, err) : count_rows(t);
    if (column != NONE && !guessed)
        return t->column[column].kind == COLUMN_STAMPS ? read_stamp_clock(t, column, err)
            : read_clock(t, column, err);
    ss_status st = guessed ? read_clock(t, column, NULL) : SS_ECLOCK;
    if (st == SS_OK || st == SS_ENOMEM)
        return st == SS_OK ? SS_OK : ss_delimited_no_memory(t, err);
    return ss_fail(err, SS_ECLOCK, "%s: no column of time", t->in->name);
}
