/* common.c -- what every tool does the same way.
 *
 * A tool is one short-lived process, so its name and verbosity are static state here, and its files
 * in files.c: an exit or a signal anywhere finds what has to be removed. */
#include "common.h"
#include "files.h"
#include "options.h"

#include <errno.h>
#include <fcntl.h>
#include <gsl/gsl_errno.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

int tool_verbosity;
ss_error tool_error;
static const char *tool_name = "stickslip", *usage_text = "";

static volatile sig_atomic_t asked_to_stop;     /* the signal that asked; 0: none did */

int
tool_stopping(void)
{
    return asked_to_stop != 0;
}

/* A read that waits goes on after this, and finds the end. */
static void
ask_to_stop(int number)
{
    int nothing = open("/dev/null", O_RDONLY);
    asked_to_stop = number;
    if (nothing >= 0) {
        dup2(nothing, STDIN_FILENO);
        close(nothing);
    }
}

static int progress_shown;

void
clear_progress(void)
{
    if (progress_shown)
        fputs("\r\033[K", stderr);
    progress_shown = 0;
}

double
tool_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The part of the work that reading is, where all of a signal is read before other work begins. */
#define READING 0.3
static double begun_at;                 /* progress when that other work begins */

int
tool_reading_progress(double done, void *user)
{
    return tool_progress(READING * done, user);
}

void
tool_reading_done(void)
{
    begun_at = progress_shown ? READING : 0;
}

int
tool_progress(double done, void *user)
{
    static double began, shown;
    static int here = -1, data = -1;    /* are standard error and output terminals? */
    if (here < 0) {
        here = isatty(STDERR_FILENO);
        data = isatty(STDOUT_FILENO);
    }
    int terminal = here && tool_verbosity >= 0 && (user != NULL || files_writing() || !data);
    done = begun_at + (1 - begun_at) * done;
    if (terminal && !tool_stopping()) {
        double now = tool_seconds();
        if (began == 0)
            began = now;
        if (now - began > 1 && now - shown > 0.2) {
            fprintf(stderr, "\r%s: %3.0f %%", tool_name, 100 * done);
            if (done > 0)
                fprintf(stderr, ", %.0f s left", ceil((now - began) * (1 / done - 1)));
            fputs("\033[K", stderr);
            shown = now;
            progress_shown = 1;
        }
    }
    return tool_stopping();
}

void
tool_end_at_rows(const char *path)
{
    if (path == NULL || strcmp(path, "-") == 0)
        catch_signals(ask_to_stop);
}

void
tool_begin(char *argv[], const char *name, const char *usage)
{
    files_begin();
    tool_name = name;
    usage_text = usage;
    argv[0] = (char *)name;             /* getopt_long prefixes its messages with this */
    gsl_set_error_handler_off();        /* statuses are checked; GSL must not abort */
    signal(SIGXFSZ, SIG_IGN);           /* a write beyond the limit of files then fails, without a signal */
}

/* Write one line to standard error, even if names of files contain newlines. */
static void
say(const char *format, va_list args)
{
    char text[2 * PATH_MAX];
    vsnprintf(text, sizeof text, format, args);
    clear_progress();
    fprintf(stderr, "%s: %s\n", tool_name, ss_printable(text));
}

#define SAY(format) do { \
        va_list args; \
        va_start(args, format); \
        say(format, args); \
        va_end(args); \
    } while (0)

void
tool_leave(int status)
{
    files_discard();
    fflush(stdout);
    _exit(status);
}

void
tool_die(const char *format, ...)
{
    SAY(format);
    tool_leave(1);
}

void
tool_usage(const char *format, ...)
{
    if (format != NULL)
        SAY(format);
    tool_leave(2);
}

void
tool_warn(const char *format, ...)
{
    if (tool_verbosity >= 0)
        SAY(format);
}

void
tool_note(const char *format, ...)
{
    if (tool_verbosity > 0)
        SAY(format);
}

/* A hint: the tool that reads the kind that was found, or else the tool that makes the kind wanted. */
static const char *
kind_hint(ss_kind found, ss_kind wanted)
{
    static const char *const reads[] = {
        [SS_KIND_SIGNAL] = "; ss-morlet makes coefficients of it, ss-plot draws it",
        [SS_KIND_COEFFICIENTS] = "; ss-contour reads them, and ss-morlet --inverse",
        [SS_KIND_FEATURES] = "; --features of ss-contour and ss-plot reads it",
        [SS_KIND_EVENTS] = "; ss-contour --events reads it",
        [SS_KIND_SWEEP] = "; ss-plot --map reads it",
        [SS_KIND_TRADE] = "; ss-trade -o FILE.png draws one",
        [SS_KIND_SCENE] = "; ss-sim makes a signal of it",
        [SS_KIND_TABLE] = "; ss-cat, ss-morlet, ss-contour, ss-features and ss-plot read a signal in it",
        [SS_KIND_AU] = "; ss-cat, ss-morlet and ss-contour read it",
        [SS_KIND_HDF5] = "; ss-cat, ss-morlet and ss-contour read it",
    };
    static const char *const makes[SS_KIND_HDF5 + 1] = {
        [SS_KIND_COEFFICIENTS] = "; ss-morlet makes coefficients of a signal, and ss-contour those of a file by itself",
        [SS_KIND_SWEEP] = "; ss-sweep -o FILE.tsv makes one",
    };
    const char *hint = found != SS_KIND_UNKNOWN ? reads[found] : makes[wanted];
    return hint != NULL ? hint : "";
}

const char *
tool_hint(ss_status status, const ss_error *err)
{
    switch (status) {
    case SS_EKIND:   return err != NULL ? kind_hint(err->found, err->wanted) : "";
    case SS_ECLOCK:  return "; --time NAME names a column or dataset of time, --rate HZ gives the sample rate";
    case SS_EGAPS:   return "; --gaps=split or interpolate fills the gap";
    case SS_EUNEVEN: return tool_given("resample") ? "; --rate HZ ignores the stamps and spaces rows evenly"
        : "; --resample HZ makes time stamps uniform, --rate HZ ignores the stamps and spaces rows evenly";
    case SS_EUNIT:   return "; --time-unit UNIT says what it counts: s, ms, us, ns, min, h or d";
    case SS_ETABLES: return "; --table N reads one";
    case SS_ESCALE:  return tool_given("force") || tool_given("inverse") ? ""
        : "; ss-morlet --force computes them all the same";
    default:         return "";
    }
}

const char *
tool_s(size_t n)
{
    return n == 1 ? "" : "s";
}

void
tool_check_error(ss_status status, const ss_error *err)
{
    const char *rest, *name = status != SS_OK ? files_name(err->text, &rest) : NULL;
    if (status == SS_EIO && (ferror(stdout) || files_failed()))
        tool_die("write error: %s", strerror(errno));
    if (name != NULL)
        tool_die("%s%s%s", name, rest, tool_hint(status, err));
    if (status != SS_OK && status != SS_STOP)
        tool_die("%s%s", err->text[0] != '\0' ? err->text : ss_strerror(status), tool_hint(status, err));
}

void
tool_check(ss_status status)
{
    tool_check_error(status, &tool_error);
}

void
tool_check_input(ss_status status, const char *path)
{
    const char *text = tool_error.text[0] != '\0' ? tool_error.text : ss_strerror(status);
    if (status != SS_OK)
        tool_die("%s: %s%s", tool_input_name(path), text, tool_hint(status, &tool_error));
}

void *
tool_room(void *list, size_t n, size_t size)
{
    void *room = realloc(list, n > 0 ? n * size : 1);
    if (room == NULL)
        tool_die("%s", ss_strerror(SS_ENOMEM));
    return room;
}

void
tool_show(int help)
{
    if (help)
        fputs(usage_text, stdout);
    else
        printf("%s (libstickslip) %s\n", tool_name, ss_version());
    tool_verbosity = 0;
    tool_end();
    exit(0);
}

/* Note the CPU time, including gnuplot's, and the larger peak of memory of the two processes. */
static void
note_cost(void)
{
    struct rusage own, gnuplot;
#ifdef __APPLE__
    const double unit = 1;
#else
    const double unit = 1024;
#endif
    if (getrusage(RUSAGE_SELF, &own) != 0 || getrusage(RUSAGE_CHILDREN, &gnuplot) != 0)
        return;
    long seconds = own.ru_utime.tv_sec + own.ru_stime.tv_sec + gnuplot.ru_utime.tv_sec + gnuplot.ru_stime.tv_sec;
    double micro = (double)(own.ru_utime.tv_usec + own.ru_stime.tv_usec + gnuplot.ru_utime.tv_usec
                            + gnuplot.ru_stime.tv_usec);
    long most = own.ru_maxrss > gnuplot.ru_maxrss ? own.ru_maxrss : gnuplot.ru_maxrss;
    tool_note("%.3g s of CPU, %.0f MB of memory", (double)seconds + 1e-6 * micro,
              ceil(1e-6 * unit * (double)most));
}

void
tool_end(void)
{
    clear_progress();
    files_finish();
    int failed = ferror(stdout);
    if (fclose(stdout) != 0 || failed)
        tool_die("write error: %s", strerror(errno));
    note_cost();
    if (tool_stopping())                /* the last row is whole; a shell expects the signal's end */
        raise(asked_to_stop);
}
