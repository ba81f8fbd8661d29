/* input.c -- bytes and lines of a stream, in a buffer that grows to the longest line, up to 16 MiB.
 *
 * A FILE does not tell whether a line has arrived, so its descriptor is read instead.  A FILE
 * without a descriptor (fmemopen) is read with fread. */
#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <stickslip/number.h>
#include "base/error.h"
#include "base/progress.h"
#include "io/format.h"

enum { PIECE = 65536 };

ss_status
ss_input_open(struct input *in, FILE *file, const char *name, ss_error *err)
{
    memset(in, 0, sizeof *in);
    in->file = file;
    in->name = strdup(name);
    in->capacity = PIECE;
    in->buffer = malloc(in->capacity + 1);      /* 1 for a NUL behind the last line */
    if (in->name == NULL || in->buffer == NULL)
        return ss_fail_memory(err, name);
    struct stat st;
    in->share = 1;
    in->size = fileno(file) >= 0 && fstat(fileno(file), &st) == 0 && S_ISREG(st.st_mode) ? (double)st.st_size : 0;
    fflush(file);       /* moves the descriptor of a file (not a pipe) to where the FILE is */
    return SS_OK;
}

void
ss_input_close(struct input *in)
{
    free((char *)in->name);
    free(in->buffer);
}

/* Read more bytes, at least one unless the file ends. */
static ss_status
fill(struct input *in, ss_error *err)
{
    ssize_t n;
    if (in->lo > 0) {
        memmove(in->buffer, in->buffer + in->lo, in->hi - in->lo);
        in->scanned -= in->scanned < in->lo ? in->scanned : in->lo;
        in->hi -= in->lo;
        in->lo = 0;
    }
    if (in->hi + PIECE / 2 > in->capacity) {
        char *more = in->capacity < MAX_LINE ? realloc(in->buffer, 2 * in->capacity + 1) : NULL;
        if (more == NULL)
            return in->capacity < MAX_LINE
                ? ss_fail(err, SS_ENOMEM, "%s:%lu: no memory for a line this long", in->name, in->line + 1)
                : ss_fail(err, SS_EDATA, "%s:%lu: a line of more than 16 MB", in->name, in->line + 1);
        in->buffer = more;
        in->capacity *= 2;
    }
    char *to = in->buffer + in->hi;
    size_t room = in->capacity - in->hi;
    if (fileno(in->file) < 0) {
        n = (ssize_t)fread(to, 1, room, in->file);
        if (n == 0 && ferror(in->file))
            n = -1;
    } else {
        do
            n = read(fileno(in->file), to, room);
        while (n < 0 && errno == EINTR);
    }
    if (n < 0)
        return ss_fail_errno(err, in->name, errno);
    in->ended = n == 0;
    in->hi += (size_t)n;
    in->had += (double)n;
    if (in->size > 0)
        ss_progress_at(&in->progress, in->share * fmin(in->had / in->size, 1));
    return SS_OK;
}

ss_status
ss_input_need(struct input *in, size_t n, ss_error *err)
{
    while (in->hi - in->lo < n && !in->ended) {
        ss_status st = fill(in, err);
        if (st != SS_OK)
            return st;
    }
    return SS_OK;
}

ss_status
ss_input_whole(struct input *in, size_t n, const char *what, ss_error *err)
{
    ss_status st = ss_input_need(in, n, err);
    return st != SS_OK || in->hi - in->lo >= n ? st : ss_fail(err, SS_EDATA, "%s: truncated %s", in->name, what);
}

ss_status
ss_input_skip(struct input *in, uint64_t *n, ss_error *err)
{
    ss_status st = SS_OK;
    while (*n > 0 && (st = ss_input_need(in, 1, err)) == SS_OK && in->hi > in->lo) {
        size_t step = in->hi - in->lo < *n ? in->hi - in->lo : (size_t)*n;
        in->lo += step;
        *n -= step;
    }
    return st;
}

/* The end of the next line, or NULL if it is not in the buffer. */
static char *
find_newline(struct input *in)
{
    if (in->scanned < in->lo)
        in->scanned = in->lo;
    char *newline = memchr(in->buffer + in->scanned, '\n', in->hi - in->scanned);
    in->scanned = newline != NULL ? (size_t)(newline - in->buffer) : in->hi;
    return newline;
}

int
ss_input_has_line(struct input *in)
{
    return find_newline(in) != NULL;
}

ss_status
ss_input_line(struct input *in, char **line, size_t *length, ss_error *err)
{
    char *newline;
    *line = NULL;
    *length = 0;
    while ((newline = find_newline(in)) == NULL && !in->ended) {
        ss_status st = fill(in, err);
        if (st != SS_OK)
            return st;
    }
    if (newline == NULL && in->lo == in->hi)
        return SS_OK;
    char *end = newline != NULL ? newline : in->buffer + in->hi;
    *line = in->buffer + in->lo;
    in->lo = (size_t)(end - in->buffer) + (newline != NULL);
    while (end > *line && end[-1] == '\r')
        end--;
    *end = '\0';
    *length = (size_t)(end - *line);
    in->line++;
    return SS_OK;
}

ss_status
ss_input_begin(struct input *in, ss_kind kind, ss_error *err)
{
    char *line;
    size_t length;
    ss_status st = ss_input_line(in, &line, &length, err);
    if (st != SS_OK || (line != NULL && strcmp(line, ss_kind_magic(kind)) == 0))
        return st;
    return ss_fail_magic(err, in->name, line, kind);
}

ss_status
ss_input_row(struct input *in, char **line, ss_error *err)
{
    size_t length;
    do {
        ss_status st = ss_input_line(in, line, &length, err);
        if (st != SS_OK || *line == NULL)
            return st;
        if (strlen(*line) != length)
            return ss_fail(err, SS_EDATA, "%s:%lu: a NUL byte", in->name, in->line);
    } while ((*line)[strspn(*line, " \t\r")] == '\0');
    return SS_OK;
}

int
ss_input_is_pipe(const struct input *in)
{
    return in->size <= 0 && fileno(in->file) >= 0;
}

int
ss_input_waits(const struct input *in)
{
    struct pollfd fd = { .fd = fileno(in->file), .events = POLLIN };
    return !in->ended && fd.fd >= 0 && poll(&fd, 1, 0) == 0;
}

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
