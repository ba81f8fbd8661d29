/* reading.c -- the options of every tool that reads a signal. */
#include "common.h"

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

void
tool_reading_begin(tool_reading *r, int argc)
{
    *r = (tool_reading){ .opts.warn = warn, .from = NAN, .to = NAN,
                         .calibration = calloc((size_t)argc, sizeof *r->calibration) };
    if (r->calibration == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
}

/* Cut "[NAME=]VALUE": gives VALUE, and a new calibration has the name. */
static char *
add_calibration(tool_reading *r, char *text)
{
    char *equals = strrchr(text, '=');
    ss_calibration *c = &r->calibration[r->opts.n_calibrations++];
    if (equals == NULL)
        return text;
    *equals = '\0';
    c->column = text;
    return equals + 1;
}

static const char *
time_unit(const char *text)
{
    enum { MOST = 16 };
    const char *name[MOST + 1] = { NULL };
    for (size_t i = 0; i < MOST && ss_time_unit_name(i) != NULL; i++)
        name[i] = ss_time_unit_name(i);
    return name[tool_choice("--time-unit", text, name)];
}

int
tool_reading_option(tool_reading *r, int c, char *text)
{
    static const char *const gaps[] = { "refuse", "split", "interpolate", NULL };
    ss_read_opts *opts = &r->opts;
    char *value;
    switch (c) {
    case TOOL_OPT_TIME:      opts->time = text; break;
    case TOOL_OPT_TIME_UNIT: opts->time_unit = time_unit(text); break;
    case TOOL_OPT_RATE:      opts->rate = tool_number("--rate", text, DBL_MIN, DBL_MAX); break;
    case TOOL_OPT_TABLE:     opts->table = (size_t)tool_integer("--table", text, 1, 1000000); break;
    case TOOL_OPT_GAPS:      opts->gaps = (ss_gaps)tool_choice("--gaps", text, gaps); break;
    case TOOL_OPT_RESAMPLE:  opts->resample = tool_number("--resample", text, DBL_MIN, DBL_MAX); break;
    case TOOL_OPT_FROM:      r->from = tool_number("--from", text, -DBL_MAX, DBL_MAX); break;
    case TOOL_OPT_TO:        r->to = tool_number("--to", text, -DBL_MAX, DBL_MAX); break;
    case TOOL_OPT_SCALE:
        value = add_calibration(r, text);
        r->calibration[opts->n_calibrations - 1].scale = tool_number("--scale", value, -DBL_MAX, DBL_MAX);
        if (r->calibration[opts->n_calibrations - 1].scale == 0)
            tool_usage("--scale: 0 leaves nothing of a column");
        break;
    case TOOL_OPT_UNIT:
        value = add_calibration(r, text);
        r->calibration[opts->n_calibrations - 1].unit = value;
        break;
    default: return 0;
    }
    r->given = 1;
    return 1;
}

void
tool_reading_end(tool_reading *r, const char *column)
{
    ss_read_opts *opts = &r->opts;
    if (opts->rate > 0 && (opts->time != NULL || opts->time_unit != NULL))
        tool_usage("--%s and --rate exclude each other", opts->time != NULL ? "time" : "time-unit");
    if (r->from >= r->to)
        tool_usage("--from does not lie before --to");
    if (!isnan(r->from) || !isnan(r->to)) {
        opts->from = isnan(r->from) ? -DBL_MAX : r->from;
        opts->to = isnan(r->to) ? DBL_MAX : r->to;
    }
    for (size_t i = 0; i < opts->n_calibrations; i++)
        if (r->calibration[i].column == NULL)
            r->calibration[i].column = column;
    opts->calibration = r->calibration;
}

void
tool_reading_free(tool_reading *r)
{
    free(r->calibration);
}
