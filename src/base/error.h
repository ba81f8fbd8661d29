/* error.h -- functions that report a failure and its reason. */
#ifndef ERROR_H
#define ERROR_H

#include <stddef.h>
#include <stickslip/status.h>

/* A function with the arguments of printf: the numbers of the format and of the first value. */
#if defined(__GNUC__)
#define SS_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define SS_PRINTF(text, first)
#endif

/* The ending of a noun of which there are n: "%zu sample%s", n, PLURAL(n). */
#define PLURAL(n) ((n) == 1 ? "" : "s")

/* Write the text to *err, unless err is NULL, and return the status: return ss_fail(...). */
SS_PRINTF(3, 4)
ss_status ss_fail(ss_error *err, ss_status status, const char *format, ...);
/* SS_EINVAL: a pointer that must not be NULL is. */
#define SS_FAIL_NULL(err) ss_fail(err, SS_EINVAL, "an argument is NULL")
/* SS_EINVAL: a signal of n columns has none with this index. */
ss_status ss_fail_column(ss_error *err, size_t column, size_t n);
/* SS_EIO for a file, with the system's text for this errno; strerror is not safe for threads. */
ss_status ss_fail_errno(ss_error *err, const char *name, int number);
/* SS_ENOMEM of a call that reads or writes a file, or of one that does not (name NULL). */
ss_status ss_fail_memory(ss_error *err, const char *name);

/* SS_EINVAL: a number lies outside the range that a public header gives it. */
static inline ss_status
ss_range_check(double x, ss_range range, const char *name, ss_error *err)
{
    return x >= range.from && x <= range.to ? SS_OK
        : ss_fail(err, SS_EINVAL, "%s %g is out of range %g ... %g", name, x, range.from, range.to);
}

/* The first line of text of a kind; NULL: it has none. */
const char *ss_kind_magic(ss_kind kind);
/* SS_EKIND, with both kinds, for a file whose first n bytes show a known kind other than the wanted
 * one.  Else SS_OK. */
ss_status ss_fail_kind(ss_error *err, const char *name, const char *bytes, size_t n, ss_kind wanted);
/* The same for text whose first line is not that of the wanted kind; NULL: it has no line. */
ss_status ss_fail_magic(ss_error *err, const char *name, const char *line, ss_kind wanted);
/* Add the wanted kind to a failure of this status, which is returned. */
ss_status ss_fail_wanted(ss_status status, ss_kind wanted, ss_error *err);

#endif
