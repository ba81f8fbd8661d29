/* error.h -- how library functions fail. */
#ifndef ERROR_H
#define ERROR_H

#include <stddef.h>
#include <stickslip/status.h>

/* Write the text to *err, unless err is NULL, and return the status: return ss_fail(...). */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
ss_status ss_fail(ss_error *err, ss_status status, const char *format, ...);
/* SS_EINVAL: a pointer that must not be NULL is. */
#define SS_FAIL_NULL(err) ss_fail(err, SS_EINVAL, "an argument is NULL")
/* SS_EIO for a file, with the system's text for this errno; strerror is not safe for threads. */
ss_status ss_fail_errno(ss_error *err, const char *name, int number);
/* SS_EKIND, with the kind, for a file whose first n bytes show a known kind other than the wanted one
 * ("a signal", "wavelet coefficients", "a scene", "a sweep").  Else SS_OK. */
ss_status ss_fail_kind(ss_error *err, const char *name, const char *bytes, size_t n,
                       const char *wanted);

#endif
