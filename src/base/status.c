/* status.c -- status codes to text. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include "base/error.h"
#include "base/number.h"
#include "base/utf8.h"

const char *
ss_strerror(ss_status status)
{
    switch (status) {
    case SS_OK:       return "no error";
    case SS_STOP:     return "stopped on request";
    case SS_EINVAL:   return "argument out of range";
    case SS_ENOMEM:   return "out of memory";
    case SS_EIO:      return "input or output error";
    case SS_EDATA:    return "malformed input";
    case SS_EKIND:    return "a file of another kind";
    case SS_ECLOCK:   return "a signal without a clock";
    case SS_EGAPS:    return "samples are missing";
    case SS_EUNEVEN:  return "time stamps are not uniform";
    case SS_EUNIT:    return "the unit of time is in doubt";
    case SS_ETABLES:  return "which of several tables is not said";
    case SS_ESCALE:   return "scales outside the range that the record resolves";
    case SS_ETOL:     return "tolerance cannot be met";
    case SS_ECHATTER: return "events too close to tell apart";
    case SS_EBUDGET:  return "step budget used up";
    case SS_ERANGE:   return "numbers beyond double precision";
    }
    return "unknown status";
}

const char *
ss_version(void)
{
    return SS_VERSION;
}

char *
ss_printable(char *text)
{
    int is_control;
    for (char *p = text; p != NULL && *p != '\0';) {
        size_t n = ss_utf8_next(p, &is_control);
        if (is_control)
            memset(p, '?', n);
        p += n;
    }
    return text;
}

/* These texts contain names of files and parts of input.  One that is too long loses its middle: it begins with
 * the name of a file and ends with the error. */
ss_status
ss_fail(ss_error *err, ss_status status, const char *format, ...)
{
    if (err != NULL) {
        char whole[8192] = "";
        va_list args;
        va_start(args, format);
        ss_print_text(whole, sizeof whole, format, args);
        va_end(args);
        const size_t length = strlen(whole), size = sizeof err->text, first = size / 4;
        if (length < size)
            memcpy(err->text, whole, length + 1);
        else
            snprintf(err->text, size, "%.*s ... %s", (int)first, whole, whole + length - (size - first - 6));
        ss_printable(err->text);
        err->found = err->wanted = SS_KIND_UNKNOWN;
    }
    return status;
}

ss_status
ss_fail_column(ss_error *err, size_t column, size_t n)
{
    return ss_fail(err, SS_EINVAL, "no column %zu, there are %zu", column + 1, n);
}

ss_status
ss_fail_errno(ss_error *err, const char *name, int number)
{
    char text[128];
    if (strerror_r(number, text, sizeof text) != 0)
        snprintf(text, sizeof text, "error %d of the system", number);
    return ss_fail(err, SS_EIO, "%s: %s", name, text);
}

ss_status
ss_fail_memory(ss_error *err, const char *name)
{
    return ss_fail(err, SS_ENOMEM, "%s%s%s", name != NULL ? name : "", name != NULL ? ": " : "",
                   ss_strerror(SS_ENOMEM));
}
