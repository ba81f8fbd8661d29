/* delimited_clock.c -- the column of time of a text table, and its rows as samples of a clock. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/error.h"
#include "signal/header.h"
#include "signal/resample.h"
#include "stream/clock.h"
#include "stream/delimited.h"

enum { GAPS_MOST = 1000 };      /* samples for each that is there */

/* Seconds are stamps * factor / divisor. */
struct time_unit {
    const char *name;
    double factor, divisor;
};

static const struct time_unit *
find_time_unit(const char *name)
{
    static const struct time_unit known[] = {
        { "", 1, 1 }, { "s", 1, 1 }, { "sec", 1, 1 }, { "seconds", 1, 1 }, { "ms", 1, 1e3 },
        { "us", 1, 1e6 }, { "\u00b5s", 1, 1e6 }, { "\u03bcs", 1, 1e6 }, { "ns", 1, 1e9 },
        { "min", 60, 1 }, { "h", 3600, 1 }, { NULL, 0, 0 } };
    for (const struct time_unit *u = known; u->name != NULL; u++)
        if (strcasecmp(name, u->name) == 0)
            return u;
    return NULL;
}

/* Is this column called time?  "Time", "t", "time_ms"; the unit in its name is then *unit. */
static int
is_called_time(const ss_column *c, const char **unit)
{
    static const char *const word[] = { "t", "time", "timestamp", "zeit", "x_value",
        "second", "seconds", NULL };
    *unit = c->unit;
    for (int i = 0; word[i] != NULL; i++) {
        size_t n = strlen(word[i]);
        if (strncasecmp(c->name, word[i], n) != 0)
            continue;
        if (c->name[n] == '\0')
            return 1;
        if (c->name[n] == '_' && find_time_unit(c->name + n + 1) != NULL) {
            if (**unit == '\0')
                *unit = c->name + n + 1;
            return 1;
        }
    }
    return 0;
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

/* Rows at stamps as samples of a clock: that of the stamps, or that of --resample. */
static ss_status
place_rows(struct table *t, const double *stamp, ss_error *err)
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
        return st;
    }
    ss_status st = ss_usual_step(name, stamp, t->line, n, &usual, err);
    t->names->rate = t->opts->resample;
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

/* The column holds times in this unit, counted from t->origin. */
static ss_status
read_stamps(struct table *t, size_t column, double factor, double divisor, ss_error *err)
{
    drop_rows_without(t, column);
    double *stamp = malloc((t->n_rows + 1) * sizeof *stamp);
    if (stamp == NULL)
        return ss_delimited_no_memory(t, err);
    for (size_t i = 0; i < t->n_rows; i++)
        stamp[i] = t->origin + t->value[i * t->n_columns + column] * factor / divisor;
    ss_status st = place_rows(t, stamp, err);
    if (st == SS_OK) {
        t->names->start = stamp[0];
        t->time = column;
    }
    free(stamp);
    return st;
}

static ss_status
read_clock(struct table *t, size_t column, const char *unit_name, ss_error *err)
{
    const struct time_unit *unit = find_time_unit(unit_name);
    if (unit == NULL)
        return ss_fail(err, SS_EDATA, "%s: column %s: unit '%.40s' is not one of time", t->in->name,
                       t->names->column[column].name, unit_name);
    return read_stamps(t, column, unit->factor, unit->divisor, err);
}

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

ss_status
ss_delimited_choose_clock(struct table *t, ss_error *err)
{
    const ss_read_opts *opts = t->opts;
    const char *unit, *first = t->names->column[0].unit;
    int chosen = opts->time != NULL ? ss_header_column(t->names, opts->time) : -1;
    if (opts->time != NULL && chosen < 0)
        return no_such_column(t, opts->time, err);
    if (chosen >= 0) {
        is_called_time(&t->names->column[chosen], &unit);
        return read_clock(t, (size_t)chosen, unit, err);
    }
    if (opts->rate > 0) {
        t->names->rate = opts->rate;
        return SS_OK;
    }
    if (t->increment > 0)
        return read_stamps(t, 0, t->increment, 1, err);
    for (size_t i = 0; i < t->n_columns; i++)
        if (is_called_time(&t->names->column[i], &unit))
            return read_clock(t, i, unit, err);
    if (t->n_columns > 1 && *first != '\0' && find_time_unit(first) != NULL)
        return read_clock(t, 0, first, err);
    ss_status st = SS_ECLOCK;
    if (t->n_columns > 1 && !t->named)          /* a force over its deflection ascends too */
        st = read_clock(t, 0, "", NULL);
    if (st == SS_OK || st == SS_ENOMEM)
        return st == SS_OK ? SS_OK : ss_delimited_no_memory(t, err);
    return ss_fail(err, SS_ECLOCK, "%s: no column of time", t->in->name);
}
