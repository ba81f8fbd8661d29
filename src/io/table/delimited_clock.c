/* delimited_clock.c -- find the column of time of a text table, and the clock that its numbers, dates or
 * times of day show. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/error.h"
#include "signal/resample.h"
#include "io/table/clock.h"
#include "io/table/delimited.h"
#include "io/table/stamp.h"
#include "io/table/time_unit.h"

enum { GAPS_MOST = 1000 };      /* at most so many samples for each one that is not missing */
#define LONGEST 10              /* usual steps; stamps farther apart have a gap between them */
/* A short file cannot claim much memory by two time stamps that lie far apart. */
enum { MOST_SAMPLES = 1000000, MOST_PER_STAMP = 1000 };

#define LEAST_RATE (1 / 3600. * (1 - 1e-9))     /* a sample an hour */
#define MOST_RATE 1e10
#define MOST_IN_SECONDS 1e6     /* [Hz] a faster clock that begins with the number of a day counts days */
#define LEAST_IN_DAYS .1        /* [Hz] slower records of days are not looked for */
enum { ROUND = 4 };             /* digits of a rate in days; those of scattered stamps have more */
#define DOUBTED_RATE 100.       /* [Hz] a slower clock without a unit may count milliseconds */

/* --- the stamps of the rows ---------------------------------------------------------------- */

static ss_status
rewind_rows(void *source, ss_error *err)
{
    return ss_delimited_rewind(source, err);
}

static ss_status
next_stamp(void *source, int *there, double *stamp, unsigned long *line, ss_error *err)
{
    struct table *t = source;
    const double *row;
    ss_status st = ss_delimited_next(t, &row, err);
    *there = row != NULL;
    if (*there) {
        *stamp = ss_delimited_stamp(&t->time, row);
        *line = (unsigned long)row[t->n_columns];
    }
    return st;
}

/* Find the clock on which the rows with these stamps are samples. */
static ss_status
find_clock(struct table *t, const struct stamps *s, ss_error *err)
{
    const struct time_column *a = &t->time, *b = &t->fitted;
    ss_header *head = t->names;
    int gaps = t->opts->gaps != SS_GAPS_REFUSE;
    head->start = t->fit.first.stamp;
    if (!gaps && t->ascends && a->column == b->column && a->origin == b->origin && a->zero == b->zero
        && a->factor == b->factor && a->divisor == b->divisor && ss_clock_rate(&t->fit, s->file, &head->rate, NULL) == SS_OK)
        return SS_OK;
    clock_fit fit = { .taken = a->zero * a->factor / a->divisor, .digit = gaps ? 0 : t->digit };
    ss_status st = gaps ? ss_usual_step(s, &t->count.usual, err) : SS_OK;
    if (st == SS_OK)
        st = ss_find_clock(s, t->count.usual, &fit, &head->rate, err);
    head->start = fit.first.stamp;
    if (st == SS_OK && (fit.last.sample + 1) / GAPS_MOST >= (double)fit.n + 1)
        st = ss_fail(err, SS_EDATA, "%s: of %.15g samples only %zu are there", s->file, fit.last.sample + 1, fit.n);
    ss_clock_free(&fit);
    return st;
}

/* Find the first and the last stamp, their number, and the first sample of the resampled signal that lies
 * in a gap; *gap is negative if there is none. */
static ss_status
survey_stamps(struct table *t, double *gap, double *last, size_t *n, ss_error *err)
{
    const double *row;
    double rate = t->opts->resample;
    ss_status st = ss_delimited_rewind(t, err);
    *gap = -1;
    *last = 0;
    for (*n = 0; st == SS_OK && (st = ss_delimited_next(t, &row, err)) == SS_OK && row != NULL; ++*n) {
        double stamp = ss_delimited_stamp(&t->time, row), start = t->names->start;
        if (*n == 0)
            t->names->start = stamp;
        else if (*gap < 0 && stamp - *last > t->longest)
            *gap = ss_resample_gap(*last - start, stamp - start, rate);
        *last = stamp;
    }
    return st;
}

/* The clock is opts->resample; check that the stamps can be resampled to it.  *own becomes their rate. */
static ss_status
resample_stamps(struct table *t, const struct stamps *s, double *own, ss_error *err)
{
    double usual, gap, last, rate = t->names->rate = t->opts->resample;
    size_t n;
    ss_status st = ss_usual_step(s, &usual, err);
    if (st != SS_OK)
        return st;
    *own = 1 / usual;
    t->longest = LONGEST * usual;
    if ((st = survey_stamps(t, &gap, &last, &n, err)) != SS_OK)
        return st;
    double samples = ss_resample_count(t->names->start, last, rate);
    if (samples > MOST_SAMPLES && samples / MOST_PER_STAMP >= (double)n + 1)
        return ss_fail(err, SS_EDATA, "%s: %zu time stamps would become %.15g samples at %g Hz", s->file, n, samples,
                       rate);
    if (t->opts->gaps != SS_GAPS_REFUSE || gap < 0)
        return SS_OK;
    return ss_fail(err, SS_EGAPS, "%s: a gap around %g s, of more than ten usual steps of %g s", s->file,
                   t->names->start + gap / rate, usual);
}

static struct stamps
stamps_of(struct table *t)
{
    return (struct stamps){ t->in->name, rewind_rows, next_stamp, t };
}

/* Find the clock of the times in a column.  *own becomes their rate. */
static ss_status
read_stamps(struct table *t, struct time_column time, double *own, ss_error *err)
{
    const struct stamps s = stamps_of(t);
    t->time = time;
    if (t->opts->resample > 0)
        return resample_stamps(t, &s, own, err);
    ss_status st = find_clock(t, &s, err);
    *own = t->names->rate;
    return st;
}

/* --- a column of numbers ------------------------------------------------------------------- */

/* The unit of a column of numbers that are times, from `first` on: given by the caller, the file or the column's
 * name, or that of a date (*is_date is 1); NULL if it is not known. */
static ss_status
unit_of_times(const struct table *t, size_t column, double first, const struct time_unit **unit, int *is_date,
              ss_error *err)
{
    size_t length;
    const ss_column *c = &t->names->column[column];
    const char *own = t->opts->time_unit != NULL ? t->opts->time_unit : c->unit;
    *unit = *own != '\0' ? ss_time_unit_find(own) : strcasecmp(c->name, "x_value") == 0
        ? ss_time_unit_find("s") : ss_time_unit_in(c->name, &length);
    if (*unit == NULL && *own != '\0')
        return ss_fail(err, SS_EDATA, "%s: column %s: unit '%.40s' is not one of time", t->in->name,
                       c->name, own);
    *is_date = *unit == NULL && (*unit = ss_time_unit_of_date(first)) != NULL;
    return SS_OK;
}

/* Are times from `first` on, which give this rate if they are seconds, rather days?  Seconds that begin late may
 * have such numbers, but then not a rate that is round in days only. */
static int
are_days(double first, double rate)
{
    if (!ss_is_day_now(first) || !(rate >= LEAST_IN_DAYS * SECONDS_A_DAY * (1 - 1e-9)))
        return 0;
    int digits = ss_clock_digits(rate / SECONDS_A_DAY);
    return rate > MOST_IN_SECONDS || (digits <= ROUND && digits < ss_clock_digits(rate));
}

static ss_status
ask_about_days(const struct table *t, const char *name, double first, double rate, ss_error *err)
{
    return ss_fail(err, SS_EUNIT, "%s: column %s has no unit and looks like days, %.3g Hz from day %.9g on; "
                   "seconds would give %.3g Hz", t->in->name, name, rate / SECONDS_A_DAY, first, rate);
}

/* SS_EUNIT for a clock that no laboratory has, unless the caller gave its unit.  Warn of a clock without a
 * unit that would be usual in another unit. */
static ss_status
check_rate(const struct table *t, const char *name, const struct time_unit *given, double first, double rate,
           ss_error *err)
{
    const char *unit = given == NULL ? "s" : given->name;
    if (t->opts->time_unit != NULL)
        return SS_OK;
    if (given == NULL && are_days(first, rate))
        return ask_about_days(t, name, first, rate, err);
    if (!(rate >= LEAST_RATE && rate <= MOST_RATE))
        return ss_fail(err, SS_EUNIT, "%s: column %s, read in %s, gives a clock of %.3g Hz, which no laboratory "
                       "has", t->in->name, name, unit, rate);
    if (given == NULL && rate < DOUBTED_RATE)
        ss_delimited_warn(t, SS_EUNIT, "%s: column %s has no unit and is read in seconds: %.3g Hz", t->in->name,
                          name, rate);
    return SS_OK;
}

/* The first time in a column of numbers; NaN: there is none. */
static ss_status
first_time(struct table *t, size_t column, double *first, ss_error *err)
{
    const double *row;
    t->time.column = column;                    /* rows without a time are passed over */
    ss_status st = ss_delimited_rewind(t, err);
    if (st == SS_OK)
        st = ss_delimited_next(t, &row, err);
    *first = st == SS_OK && row != NULL ? row[column] : NAN;
    return st;
}

/* Find the last digit of the times in a column of days, as far as doubles have it. */
static ss_status
find_digit(struct table *t, size_t column, double zero, ss_error *err)
{
    const double *row;
    double days = 1, apart = nextafter(fabs(zero), INFINITY) - fabs(zero);
    ss_status st = ss_delimited_rewind(t, err);
    while (st == SS_OK && (st = ss_delimited_next(t, &row, err)) == SS_OK && row != NULL)
        while (days > 10 * apart && fabs(remainder(row[column] - zero, days)) > apart)
            days /= 10;
    t->digit = SECONDS_A_DAY * days;
    return st;
}

/* The number of the day from whose midnight on the seconds of a column of days are counted. */
static ss_status
note_zero(struct table *t, double zero)
{
    char text[32];
    snprintf(text, sizeof text, "%.0f", zero);
    return fabs(zero) > 0 ? ss_header_note(t->names, "day", text) : SS_OK;
}

/* The status of times without a unit, from `first` on, that are not uniform: SS_EUNIT if their usual step shows
 * days. */
static ss_status
doubt_stamps(struct table *t, const char *name, double first, ss_status refused, ss_error *err)
{
    double step;
    const struct stamps s = stamps_of(t);
    ss_status st = ss_is_day_now(first) ? ss_usual_step(&s, &step, NULL) : refused;
    if (st == SS_ENOMEM)
        return ss_delimited_no_memory(t, err);
    return st == SS_OK && are_days(first, 1 / step) ? ask_about_days(t, name, first, 1 / step, err) : refused;
}

static ss_status
read_clock(struct table *t, size_t column, ss_error *err)
{
    const struct time_unit *known;
    const char *name = t->names->column[column].name;
    int is_date;
    double rate = 0, first;
    ss_status st = first_time(t, column, &first, err);
    if (st == SS_OK)
        st = unit_of_times(t, column, first, &known, &is_date, err);
    if (st != SS_OK)
        return st;
    if (is_date)
        ss_delimited_warn(t, SS_EUNIT, "%s: column %s has no unit and is read in %s since 1970", t->in->name,
                          name, known->name);
    const struct time_unit *unit = known != NULL ? known : ss_time_unit_find("s");
    double zero = ss_time_unit_zero(unit, first);
    if (fabs(zero) > 0 && (st = find_digit(t, column, zero, err)) != SS_OK)
        return st;
    st = read_stamps(t, (struct time_column){ column, t->counted.origin, zero, unit->factor, unit->divisor }, &rate,
                     err);
    if (st == SS_OK)
        st = check_rate(t, name, known, first, rate, err);
    else if ((st == SS_EUNEVEN || st == SS_EGAPS) && known == NULL)
        st = doubt_stamps(t, name, first, st, err);
    return st == SS_OK && note_zero(t, zero) != SS_OK ? ss_delimited_no_memory(t, err) : st;
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

/* Find the clock of a column of dates, times of day or both. */
static ss_status
read_stamp_clock(struct table *t, size_t column, ss_error *err)
{
    double rate, day = NAN;
    if (t->opts->time_unit != NULL)
        return ss_fail(err, SS_EDATA, "%s: column %s holds times of day or dates, so it has no unit to choose",
                       t->in->name, t->names->column[column].name);
    for (size_t i = t->n_columns; i-- > 0;)
        if (t->column[i].kind == COLUMN_STAMPS && !isnan(ss_delimited_day(&t->column[i])))
            day = ss_delimited_day(&t->column[i]);
    if (!isnan(ss_delimited_day(&t->column[column])))
        day = ss_delimited_day(&t->column[column]);
    ss_status st = read_stamps(t, (struct time_column){ column, t->counted.origin, 0, 1, 1 }, &rate, err);
    if (st == SS_OK && !isnan(day) && note_date(t, day) != SS_OK)
        st = ss_delimited_no_memory(t, err);
    return st;
}

/* The first column of stamps with these parts, or NONE. */
static size_t
find_stamps(const struct table *t, unsigned parts)
{
    for (size_t i = 0; i < t->n_columns; i++)
        if (t->column[i].kind == COLUMN_STAMPS && t->column[i].parts == parts)
            return i;
    return NONE;
}

/* The first column of dates with times, or else of times, or else of dates; NONE if there is none. */
static size_t
find_any_stamps(const struct table *t)
{
    size_t both = find_stamps(t, STAMP_DATE | STAMP_TIME), time = find_stamps(t, STAMP_TIME);
    return both != NONE ? both : time != NONE ? time : find_stamps(t, STAMP_DATE);
}

/* --- the choice ---------------------------------------------------------------------------- */

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

static ss_status
refuse_text(const struct table *t, size_t column, ss_status st, ss_error *err)
{
    return ss_fail(err, st, "%s: column %s holds text, not times such as 10:12:13.5, 12:13.5, 2024-03-05 10:12:13.5",
                   t->in->name, t->names->column[column].name);
}

/* Find the clock of the column that the caller has named. */
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
    return refuse_text(t, chosen, SS_EDATA, err);
}

/* The rows follow each other at a step that the header gives. */
static ss_status
count_rows(struct table *t)
{
    t->names->rate = 1 / t->counted.increment;
    t->names->start = t->counted.origin;
    return SS_OK;
}

/* The column of time, or NONE.  *guessed becomes 1 if only its place suggests that it is one. */
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
        if (t->column[i].kind == COLUMN_NUMBERS && ss_is_called_time(column[i].name))
            return i;
    size_t stamps = find_any_stamps(t);
    if (stamps != NONE)
        return stamps;
    if (t->n_columns < 2 || t->column[0].kind != COLUMN_NUMBERS)
        return NONE;
    if (*column[0].unit != '\0' && ss_time_unit_find(column[0].unit) != NULL)
        return 0;
    *guessed = !t->named;                       /* if named, it may be a deflection that ascends */
    return *guessed ? 0 : NONE;
}

/* The columns that may become channels, and their header, in which they have the numbers of the signal.  A column
 * of time that is only guessed leaves these open: then there are none. */
static ss_status
list_channels(const struct table *t, size_t *channel, size_t *n, ss_header **head)
{
    int guessed;
    size_t time = find_time(t, &guessed);
    *n = 0;
    for (size_t c = 0; c < t->n_columns && !guessed; c++)
        if (c != time && t->column[c].kind == COLUMN_NUMBERS)
            channel[(*n)++] = c;
    return ss_header_select(head, t->names, channel, *n, 0);
}

ss_status
ss_delimited_mark_spare(struct table *t, ss_error *err)
{
    if (t->opts->n_needed == 0)
        return SS_OK;
    ss_header *head = NULL;
    size_t n, *channel = malloc(t->n_columns * sizeof *channel);
    if (channel == NULL || list_channels(t, channel, &n, &head) != SS_OK) {
        free(channel);
        return ss_delimited_no_memory(t, err);
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

struct time_column
ss_delimited_time(const struct table *t)
{
    int guessed, is_date;
    struct time_column time = { find_time(t, &guessed), 0, 0, 1, 1 };
    const struct time_unit *unit;
    if (time.column == NONE || t->column[time.column].kind == COLUMN_STAMPS)
        return time;
    if (t->column[time.column].kind == COLUMN_TEXT
        || unit_of_times(t, time.column, t->first[time.column], &unit, &is_date, NULL) != SS_OK)
        return (struct time_column){ NONE, 0, 0, 1, 1 };
    if (unit != NULL)
        time = (struct time_column){ time.column, 0, ss_time_unit_zero(unit, t->first[time.column]), unit->factor,
                                     unit->divisor };
    return time;
}

static int
is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/* Does a line have this word with a digit somewhere behind it?  A longer word that begins so counts if the word has
 * more than four letters. */
static int
has_number_of(const char *line, const char *word)
{
    size_t n = strlen(word);
    for (const char *p = line; *p != '\0'; p++)
        if ((p == line || !is_letter(p[-1])) && strncasecmp(p, word, n) == 0 && (n > 4 || !is_letter(p[n])))
            return strpbrk(p, "0123456789") != NULL;
    return 0;
}

/* The line above the data that most probably gives the clock; NULL: there is none.  It is shown, not read: whether
 * a number is the rate of this table, its period or a rate of flow, and in what unit, only its writer knows. */
static const struct table_line *
find_rate_line(const struct table *t)
{
    static const char *const word[] = { "sampling", "samplerate", "samples per", "samples/s", "abtast", "chantillonnage",
                                        "muestreo", "campionamento", "rate", "interval", "fs", "dt" };
    for (size_t w = 0; w < sizeof word / sizeof *word; w++)
        for (size_t i = 0; i < t->n_head; i++)
            if (has_number_of(t->head[i].text, word[w]))
                return &t->head[i];
    return NULL;
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
    if (t->counted.increment > 0 && t->opts->time_unit != NULL)
        return ss_fail(err, SS_EDATA, "%s: its header gives the clock in seconds: no unit of time can be chosen",
                       t->in->name);
    if (t->counted.increment > 0)
        return t->counted.numbered
            ? read_stamps(t, (struct time_column){ 0, t->counted.origin, 0, t->counted.increment, 1 }, &rate, err)
            : count_rows(t);
    if (column != NONE && !guessed)
        return t->column[column].kind == COLUMN_STAMPS ? read_stamp_clock(t, column, err)
            : read_clock(t, column, err);
    ss_status st = guessed ? read_clock(t, column, NULL) : SS_ECLOCK;
    if (st == SS_EUNIT)
        return read_clock(t, column, err);      /* again, with its message */
    if (st == SS_OK || st == SS_ENOMEM)
        return st == SS_OK ? SS_OK : ss_delimited_no_memory(t, err);
    const struct table_line *line = find_rate_line(t);
    if (line != NULL)
        return ss_fail(err, SS_ECLOCK, "%s: no column of time, but line %lu may give the rate: '%.80s'", t->in->name,
                       line->number, line->text);
    for (size_t i = 0; i < t->n_columns; i++)
        if (t->column[i].kind == COLUMN_TEXT && ss_is_called_time(t->names->column[i].name))
            return refuse_text(t, i, SS_ECLOCK, err);
    return ss_fail(err, SS_ECLOCK, "%s: no column of time", t->in->name);
}
