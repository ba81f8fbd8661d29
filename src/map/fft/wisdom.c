/* wisdom.c -- FFTW's measurements of this machine, written to a file and read from one. */
#include <errno.h>
#include <fftw3.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/fft.h"
#include <stickslip/morlet.h>

/* Wisdom is a list of (name number #xflags #xflags #xflags ...), itself in brackets.  FFTW stores the
 * flags in 20, 20 and 9 bits, and aborts the program if they do not fit. */
static int
flags_fit(const char *wisdom)
{
    static const unsigned long most[] = { 0xfffff, 0xfffff, 0x1ff };
    const char *entry = strchr(wisdom, '(');
    while (entry != NULL && (entry = strchr(entry + 1, '(')) != NULL) {
        const char *name = entry + 1 + strspn(entry + 1, " \t\r\n\v\f");
        char *p = (char *)name + strcspn(name, " \t\r\n\v\f");
        for (int i = 0; i < 3; i++)
            if ((p = strstr(p, "#x")) == NULL || strtoul(p + 2, &p, 16) > most[i])
                return 0;
    }
    return 1;
}

enum { WISDOM_ROOM = 1 << 24 };         /* a hundred thousand plans */

static int
import_wisdom(const char *text)
{
    if (!flags_fit(text))
        return 0;
    pthread_mutex_lock(&ss_fftw_planner);
    int good = fftw_import_wisdom_from_string(text);
    pthread_mutex_unlock(&ss_fftw_planner);
    return good;
}

ss_status
ss_wisdom_read(FILE *in, ss_error *err)
{
    if (in == NULL)
        return SS_FAIL_NULL(err);
    char *wisdom = malloc(WISDOM_ROOM);
    if (wisdom == NULL)
        return ss_fail_memory(err, NULL);
    size_t n = fread(wisdom, 1, WISDOM_ROOM - 1, in);
    int read = !ferror(in), why = errno;
    wisdom[n] = '\0';
    int good = read && n < WISDOM_ROOM - 1 && import_wisdom(wisdom);
    free(wisdom);
    return good ? SS_OK : !read ? ss_fail_errno(err, "wisdom", why)
        : ss_fail(err, SS_EINVAL, "this is no wisdom of %s on this machine", fftw_version);
}

ss_status
ss_wisdom_write(FILE *out, ss_error *err)
{
    if (out == NULL)
        return SS_FAIL_NULL(err);
    pthread_mutex_lock(&ss_fftw_planner);
    fftw_export_wisdom_to_file(out);
    pthread_mutex_unlock(&ss_fftw_planner);
    return fflush(out) == 0 && !ferror(out) ? SS_OK : ss_fail_errno(err, "wisdom", errno);
}
