/* reading.c -- the options of every tool that reads a signal. */
#include "options.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void
warn(ss_status about, const char *text, void *user)
{
    const ss_error err = { 0 };
    (void)user;
    tool_warn("%s%s", text, tool_hint(about, &err));
}

static void
set_table(const tool_option *o, char *text)
{
    *(size_t *)o->to = (size_t)tool_integer("--table", text, 1, 1000000);
}

/* Cut "[NAME=]VALUE" and return VALUE.  *made becomes a new calibration with the name. */
static char *
add_calibration(tool_reading *r, char *text, ss_calibration **made)
{
    char *equals = strrchr(text, '=');
    size_t n = r->opts.n_calibrations++;
    r->calibration = tool_room(r->calibration, n + 1, sizeof *r->calibration);
    *made = &r->calibration[n];
    **made = (ss_calibration){ .column = equals != NULL ? text : NULL };
    if (equals == NULL)
        return text;
    *equals = '\0';
    return equals + 1;
}

static void
set_scale(const tool_option *o, char *text)
{
    ss_calibration *c;
    text = add_calibration(o->to, text, &c);
    c->scale = tool_number("--scale", text, -DBL_MAX, DBL_MAX);
    if (c->scale == 0)
        tool_usage("--scale: 0 leaves nothing of a column");
}

static void
set_unit(const tool_option *o, char *text)
{
    ss_calibration *c;
    text = add_calibration(o->to, text, &c);
    c->unit = text;
}

void
tool_reading_options(tool_reading *r, tool_option row[TOOL_READING_OPTIONS])
{
    static const char *const gaps[] = { "refuse", "split", "interpolate", NULL };
    const ss_range positive = { DBL_MIN, DBL_MAX }, any = { -DBL_MAX, DBL_MAX };
    ss_read_opts *opts = &r->opts;
    ss_read_opts_init(opts, sizeof *opts);
    opts->warn = warn;
    opts->folder = getenv("TMPDIR");
    r->from = r->to = NAN;
    const tool_option option[TOOL_READING_OPTIONS] = {
        TOOL_TEXT(r->time_letter, "time", &opts->time),
        TOOL_NAME(0, "time-unit", &opts->time_unit, ss_time_unit_name),
        TOOL_NUMBER(r->rate_letter, "rate", &opts->rate, positive),
        TOOL_VALUE(0, "table", set_table, &opts->table), TOOL_CHOICE(0, "gaps", &opts->gaps, gaps),
        TOOL_NUMBER(0, "resample", &opts->resample, positive),
        TOOL_NUMBER(0, "from", &r->from, any), TOOL_NUMBER(0, "to", &r->to, any),
        TOOL_VALUE(0, "scale", set_scale, r), TOOL_VALUE(0, "unit", set_unit, r) };
    memcpy(row, option, sizeof option);
}

void
tool_reading_end(tool_reading *r, const char *const *column, size_t n)
{
    ss_read_opts *opts = &r->opts;
    if (opts->rate > 0 && (opts->time != NULL || opts->time_unit != NULL))
        tool_usage("--%s and --rate exclude each other", opts->time != NULL ? "time" : "time-unit");
    if (r->from >= r->to)
        tool_usage("--from must be less than --to");
    if (!isnan(r->from) || !isnan(r->to)) {
        opts->from = isnan(r->from) ? -DBL_MAX : r->from;
        opts->to = isnan(r->to) ? DBL_MAX : r->to;
    }
    for (size_t i = 0; i < opts->n_calibrations; i++)
        if (r->calibration[i].column == NULL)
            r->calibration[i].column = n == 1 ? *column : NULL;
    opts->calibration = r->calibration;
    opts->needed = column;
    opts->n_needed = n;
}
