/* refuse.c -- options of reading that mean nothing for a format. */
#include "base/error.h"
#include "io/format.h"

ss_status
ss_refuse_table(const char *name, const ss_read_opts *opts, ss_error *err)
{
    return opts->table == 0 ? SS_OK
        : ss_fail(err, SS_EDATA, "%s: not delimited text: no table can be chosen", name);
}

ss_status
ss_refuse_clock(const char *name, double own, const ss_read_opts *opts, ss_error *err)
{
    char rate[SS_NUMBER_MAX];
    ss_number_format(rate, own);
    if (opts->time != NULL || (opts->rate > 0 && (opts->rate < own || opts->rate > own)))
        return ss_fail(err, SS_EDATA, "%s: has a clock of its own, %s Hz: no column of time or rate "
                       "can be chosen", name, rate);
    if (opts->time_unit != NULL)
        return ss_fail(err, SS_EDATA, "%s: has a clock in seconds: no unit of time can be chosen", name);
    return ss_refuse_table(name, opts, err);
}
