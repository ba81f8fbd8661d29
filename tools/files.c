/* files.c -- the files that a tool reads and writes.
 *
 * Output gets its name when it is whole.  Until then it is a file without a name where the system has
 * those (O_TMPFILE of Linux), so that even a tool that is killed leaves nothing behind; elsewhere it
 * is a temporary file beside the place where it belongs, removed at exit and on signals.
 *
 * Device and inode of every file that is read are kept, and compared with those of the output,
 * whichever is opened first: no output takes the place of an input. */
#define _GNU_SOURCE                     /* O_TMPFILE */
#include "common.h"
#include "files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A file being written. */
typedef struct output {
    FILE *file;                         /* NULL: a library call writes it */
    const char *name;                   /* as the user gave it */
    char *target;                       /* its name when it is whole; NULL: it has it already */
    char temporary[PATH_MAX];           /* an array, which a signal handler can read */
    int fd;                             /* of a file without a name, whose path is temporary; or -1 */
} output;

enum { OUTPUTS = 2 };                   /* those of -o and of --residual */
static output out[OUTPUTS];
static volatile sig_atomic_t n_out;
static int on_stdout;                   /* standard output gets the data */

/* A regular file that is read or written. */
typedef struct known_file {
    dev_t device;
    ino_t number;
    int written;
} known_file;

static known_file *known;
static size_t n_known;

void
files_begin(void)
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (fcntl(fd, F_GETFD) < 0)     /* open it for the wrong direction: its use is then an error */
            open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void
catch_signals(void (*handler)(int))
{
    static const int caught[] = { SIGINT, SIGTERM, SIGHUP, SIGQUIT };
    struct sigaction old, new = { .sa_flags = (int)(SA_RESTART | SA_RESETHAND) };
    new.sa_handler = handler;
    sigemptyset(&new.sa_mask);
    for (size_t i = 0; i < sizeof caught / sizeof *caught; i++)
        if (sigaction(caught[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN)
            sigaction(caught[i], &new, NULL);
}

void
files_discard(void)
{
    for (int i = 0; i < n_out; i++)
        if (out[i].target != NULL && out[i].fd < 0)
            unlink(out[i].temporary);   /* async-signal-safe */
    n_out = 0;
}

static void
discard_and_die(int number)
{
    files_discard();
    signal(number, SIG_DFL);
    raise(number);
}

/* --- no output replaces an input -------------------------------------------------------------- */

/* Remember that this file is read or written, and die if it is both. */
static void
add_known(const struct stat *st, int written, const char *name)
{
    if (!S_ISREG(st->st_mode))
        return;                         /* in a device or a pipe nothing is lost */
    for (size_t i = 0; i < n_known; i++)
        if (known[i].device == st->st_dev && known[i].number == st->st_ino
            && known[i].written != written)
            tool_usage("%s is both input and output; it would be lost", name);
    known = tool_room(known, n_known + 1, sizeof *known);
    known[n_known++] = (known_file){ st->st_dev, st->st_ino, written };
}

/* A path may name a dataset in the file before its ":/". */
const char *
tool_reads(const char *path)
{
    struct stat st;
    const char *colon = strstr(path, ":/");
    char *file = colon != NULL ? strndup(path, (size_t)(colon - path)) : NULL;
    if (strcmp(path, "-") == 0 ? fstat(STDIN_FILENO, &st) == 0
        : stat(path, &st) == 0 || (file != NULL && stat(file, &st) == 0))
        add_known(&st, 0, path);
    free(file);
    return path;
}

void
tool_writes(const char *path)
{
    struct stat st;
    int standard = path == NULL || strcmp(path, "-") == 0;
    if ((standard ? fstat(STDOUT_FILENO, &st) : stat(path, &st)) == 0)
        add_known(&st, 1, standard ? "standard output" : path);
}

/* --- output ---------------------------------------------------------------------------------- */

/* The real path of a file to be written, which may not exist yet.  A link stays a link to it. */
static char *
resolve(const char *path)
{
    char link[PATH_MAX], next[PATH_MAX], *real = realpath(path, NULL);
    if (real != NULL)
        return real;
    ssize_t length = errno == ENOENT ? readlink(path, link, sizeof link - 1) : -1;
    if (length < 0)
        return strdup(path);
    link[length] = '\0';
    const char *slash = link[0] != '/' ? strrchr(path, '/') : NULL;
    int folder = slash != NULL ? (int)(slash - path) + 1 : 0;
    if (snprintf(next, sizeof next, "%.*s%s", folder, path, link) >= (int)sizeof next)
        tool_die("%s: %s", path, strerror(ENAMETOOLONG));
    return resolve(next);
}

/* The length of a path's folder, with the slash. */
static int
folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? (int)(slash - path) + 1 : 0;
}

/* 1 if both paths will name one file.  Their folders may be one with two names. */
static int
same_target(const char *a, const char *b)
{
    struct stat in_a, in_b;
    char folder[2][PATH_MAX];
    int n = folder_length(a), m = folder_length(b);
    snprintf(folder[0], PATH_MAX, "%.*s.", n, a);
    snprintf(folder[1], PATH_MAX, "%.*s.", m, b);
    return strcmp(a + n, b + m) == 0 && stat(folder[0], &in_a) == 0 && stat(folder[1], &in_b) == 0
        && in_a.st_dev == in_b.st_dev && in_a.st_ino == in_b.st_ino;
}

/* Make a name in the folder of target that no other file has.  It ends with letters of the caller. */
static int
name_beside(char name[PATH_MAX], const char *target, const char *ending)
{
    int n = folder_length(target);
    return snprintf(name, PATH_MAX, "%.*s.%s.%s", n, target, target + n, ending) < PATH_MAX;
}

/* Open a file without a name in the folder of o->target.  Returns -1 if the system cannot. */
static int
open_nameless(output *o)
{
#ifdef O_TMPFILE
    char folder[PATH_MAX];
    int n = folder_length(o->target);
    if (snprintf(folder, sizeof folder, "%.*s.", n, o->target) >= (int)sizeof folder)
        return -1;
    int fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    snprintf(o->temporary, sizeof o->temporary, "/proc/self/fd/%d", fd);
    if (fd >= 0 && access(o->temporary, W_OK) == 0)
        return fd;
    if (fd >= 0)
        close(fd);                      /* without /proc it could never be named */
#endif
    return -1;
}

const char *
tool_output_path(const char *path)
{
    struct stat st;
    int exists = stat(path, &st) == 0;
    output *o = &out[n_out];
    tool_writes(path);
    if (exists && S_ISDIR(st.st_mode))
        tool_die("%s: %s", path, strerror(EISDIR));
    if (exists && !S_ISREG(st.st_mode))
        return path;                    /* a device or a FIFO is written as it is */
    if (!exists && (errno == ELOOP || (lstat(path, &st) != 0 && errno == ENAMETOOLONG)))
        tool_die("%s: %s", path, strerror(errno));

    *o = (output){ .name = path, .target = resolve(path), .fd = -1 };
    if (o->target == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    for (int i = 0; i < n_out; i++)
        if (out[i].target != NULL && same_target(out[i].target, o->target))
            tool_usage("%s is the output of two options", path);
    mode_t mask = umask(0), mode = exists ? st.st_mode & 0777 : 0666 & ~mask;
    umask(mask);
    sigset_t all, before;               /* a signal must not come before the new file is known */
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, &before);
    o->fd = open_nameless(o);
    int is_nameless = o->fd >= 0, fits = is_nameless || name_beside(o->temporary, o->target, "XXXXXX");
    int fd = is_nameless ? o->fd : fits ? mkstemp(o->temporary) : -1;
    if (fd < 0)
        tool_die("%s: %s", path, strerror(fits ? errno : ENAMETOOLONG));
    fchmod(fd, mode);
    if (!is_nameless)
        close(fd);
    n_out++;
    catch_signals(discard_and_die);
    sigprocmask(SIG_SETMASK, &before, NULL);
    return o->temporary;
}

FILE *
tool_output(const char *path)
{
    clear_progress();
    if (path == NULL || strcmp(path, "-") == 0) {
        tool_writes(path);
        on_stdout = 1;
        return stdout;
    }
    int before = n_out;
    const char *name = tool_output_path(path);
    FILE *file = fopen(name, "wb");
    if (file == NULL)
        tool_die("%s: %s", path, strerror(errno));
    if (n_out == before)
        out[n_out++] = (output){ .name = path, .fd = -1 };
    out[n_out - 1].file = file;
    return file;
}

FILE *
tool_output_kept(const char *path)
{
    struct flock whole = { .l_type = F_WRLCK, .l_whence = SEEK_SET };
    struct stat st;
    int fd = open(path, O_RDWR | O_CREAT | O_NONBLOCK, 0666);   /* a FIFO would wait for a writer */
    if (fd < 0 || fstat(fd, &st) != 0)
        tool_die("%s: %s", path, strerror(errno));
    if (!S_ISREG(st.st_mode))
        tool_die("%s: not a regular file, which --resume needs", path);
    tool_writes(path);
    if (fcntl(fd, F_SETLK, &whole) != 0)
        tool_die("%s: %s", path, errno == EACCES || errno == EAGAIN
                 ? "another process is writing it" : strerror(errno));
    out[n_out] = (output){ .name = path, .file = fdopen(fd, "r+"), .fd = -1 };
    if (out[n_out].file == NULL)
        tool_die("%s: %s", path, strerror(errno));
    return out[n_out++].file;
}

/* --- its end --------------------------------------------------------------------------------- */

int
files_writing(void)
{
    return n_out > 0 && !on_stdout;
}

int
files_failed(void)
{
    int failed = 0;
    for (int i = 0; i < n_out; i++)
        failed |= out[i].file != NULL && ferror(out[i].file);
    return failed;
}

const char *
files_name(const char *text, const char **rest)
{
    for (int i = 0; i < n_out; i++) {
        size_t length = strlen(out[i].temporary);
        if (length == 0 || strncmp(text, out[i].temporary, length) != 0)
            continue;
        *rest = text + length;
        return out[i].name;
    }
    return NULL;
}

/* Give a file without a name its name.  If another file has this name, only renaming replaces it, so the
 * file has a temporary name for a moment. */
static int
link_nameless(const output *o)
{
    char name[PATH_MAX], number[32];
    if (linkat(AT_FDCWD, o->temporary, AT_FDCWD, o->target, AT_SYMLINK_FOLLOW) == 0)
        return 0;
    snprintf(number, sizeof number, "%ld", (long)getpid());
    if (errno != EEXIST || !name_beside(name, o->target, number)
        || linkat(AT_FDCWD, o->temporary, AT_FDCWD, name, AT_SYMLINK_FOLLOW) != 0)
        return -1;
    if (rename(name, o->target) == 0)
        return 0;
    int why = errno;
    unlink(name);
    errno = why;
    return -1;
}

void
files_finish(void)
{
    for (int i = 0; i < n_out; i++) {
        int failed = out[i].file != NULL && ferror(out[i].file);
        if (out[i].file != NULL && (fclose(out[i].file) != 0 || failed))
            tool_die("write error: %s", strerror(errno));
        out[i].file = NULL;
    }
    sigset_t all, before;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, &before);
    for (int i = 0; i < n_out; i++) {
        output *o = &out[i];
        if (o->target != NULL
            && (o->fd >= 0 ? link_nameless(o) : rename(o->temporary, o->target)) != 0)
            tool_die("%s: %s", o->name, strerror(errno));
        free(o->target);
        o->target = NULL;
    }
    n_out = 0;
    sigprocmask(SIG_SETMASK, &before, NULL);
}
