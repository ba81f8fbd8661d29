/* common.h -- what every tool does the same way: its name in messages, exit codes, input, and output
 * that is whole or absent. */
#ifndef COMMON_H
#define COMMON_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip.h>

#if defined(__GNUC__)
#define TOOL_PRINTF __attribute__((format(printf, 1, 2)))
#define TOOL_NORETURN __attribute__((noreturn))
#else
#define TOOL_PRINTF
#define TOOL_NORETURN
#endif

/* Call first.  usage is the text of --help. */
void tool_begin(char *argv[], const char *name, const char *usage);
/* Call last, before returning 0: finishes standard output, or dies; with -v says what it all cost. */
void tool_end(void);

void tool_die(const char *format, ...) TOOL_PRINTF TOOL_NORETURN;    /* "ss-x: text", exit 1 */
/* Wrong usage: "ss-x: text", exit 2; NULL after getopt, which has said what is wrong. */
void tool_usage(const char *format, ...) TOOL_PRINTF TOOL_NORETURN;
void tool_warn(const char *format, ...) TOOL_PRINTF;        /* a line on stderr, unless -q */
void tool_note(const char *format, ...) TOOL_PRINTF;        /* a line on stderr, only with -v */
void tool_check(ss_status status, const ss_error *err);     /* dies unless SS_OK, or SS_STOP */
/* The same for the file of a base, which is read without options. */
void tool_check_base(ss_status status, const ss_error *err);
/* Returns room for n entries of size bytes each, with what the list had (NULL: a new one), or dies; to be
 * freed. */
void *tool_room(void *list, size_t n, size_t size);
/* A hint how to remedy a failure, "; text", or "". */
const char *tool_hint(ss_status status, const ss_error *err);

/* Write the text of --help or --version and exit. */
typedef enum tool_text { TOOL_HELP, TOOL_VERSION } tool_text;
void tool_show(tool_text text) TOOL_NORETURN;

extern int tool_verbosity;      /* 0; -q sets -1, -v sets 1 */

/* Several values of one option, in their order; to be freed with free(text). */
typedef struct tool_texts {
    const char **text;
    size_t n;
} tool_texts;

/* --- input --------------------------------------------------------------------------------- */

/* The one FILE argument: argv[optind], or "-" if there is none; more are wrong usage. */
const char *tool_input(int argc, char *argv[], int optind);
/* The name of a path in messages: "<stdin>" for "-". */
const char *tool_input_name(const char *path);
/* Call with what any option or argument names as a file to read, before or after output is opened: dies
 * if the output would take its place, under whatever name.  Returns path.  The functions below do
 * it. */
const char *tool_reads(const char *path);
/* The same for what -o names, as early as it is known; tool_output_kind and tool_output do it. */
void tool_writes(const char *path);
/* Open for reading, or die; "-" is stdin. */
FILE *tool_open(const char *path);
/* Begin to read a signal from "-", a file or HDF5 (with ":/dataset") row by row, or die. */
ss_reader *tool_read_rows(const char *path, const ss_read_opts *opts);
/* Read at most max rows, as ss_reader_rows does, or die.  Returns their number; 0 at the end. */
size_t tool_rows(ss_reader *reader, double *rows, size_t max);
/* Read a whole signal from "-", a file or HDF5 (with ":/dataset"), or die. */
ss_signal *tool_read_signal(const char *path, const ss_read_opts *opts);
/* Read coefficients from "-", a file or HDF5, or die. */
ss_coefficients *tool_read_coefficients(const char *path);
/* Read a scene given by path, by the bare name of a shipped one, or "-", with settings
 * "key=value" in place of its own; dies, a setting at fault being wrong usage. */
ss_scene tool_read_scene(const char *path, const tool_texts *settings);
/* The name by which it is known, without its directories, and what was changed in its physics; to be
 * freed. */
char *tool_name_scene(const char *path, const tool_texts *settings);
/* 1 if path holds HDF5 or names a dataset in it, else 0. */
int tool_is_hdf5(const char *path);
/* Append a word to a list of at least 8 bytes for a message: "a, b", and " ..." where no more fits. */
void tool_list(char *list, size_t size, const char *word);
/* The index of a column by name or number, or die with the list of those that are there; name
 * NULL: "a", else the only one. */
size_t tool_column(const ss_header *head, const char *path, const char *name);

/* --- output -------------------------------------------------------------------------------- */

typedef enum tool_kind {        /* what the ending of -o or --format asks for */
    TOOL_H5, TOOL_GP, TOOL_PNG, TOOL_SVG, TOOL_PDF,
    TOOL_STREAM,                /* and from here on a format of streams: see tool_stream */
    TOOL_TSV = TOOL_STREAM + SS_TSV
} tool_kind;

/* Sets of output kinds, to be combined with |: pictures, formats of streams that hold words, all
 * formats of streams, signals. */
enum {
    TOOL_PICTURES = 1 << TOOL_GP | 1 << TOOL_PNG | 1 << TOOL_SVG | 1 << TOOL_PDF,
    TOOL_WORDS = 1 << TOOL_STREAM,
    TOOL_NUMBERS = TOOL_WORDS | 1 << (TOOL_STREAM + 1),
    TOOL_SIGNALS = TOOL_NUMBERS | 1 << TOOL_H5
};

/* The format of a kind that is a stream. */
ss_format tool_stream(tool_kind kind);
/* The kind of path's ending, among those allowed, else wrong usage that
 * names them; standard output (NULL or "-") has the fallback. */
tool_kind tool_output_kind(const char *path, unsigned allowed, tool_kind fallback);

/* Open what -o names: NULL or "-" is standard output, else a file that gets its name in tool_end: it is
 * whole or absent.  It has no name before, or where the system has no such files a temporary one beside
 * path, which tool_die, SIGINT, SIGTERM, SIGHUP and SIGQUIT remove. */
FILE *tool_output(const char *path);
/* The same for a library call that wants a path: one that leads to the file. */
const char *tool_output_path(const char *path);

/* Open a file that another run is to go on with, from its start, or make it: what is written stays
 * there whatever happens.  Dies if another process has it open so. */
FILE *tool_output_kept(const char *path);
/* Go on writing at this offset; what lies behind it is dropped. */
void tool_cut(FILE *out, long offset);

/* Write a whole signal to what -o names, as .tsv, .au or .h5, or die. */
void tool_write_signal(const ss_signal *signal, const char *path, tool_kind kind);

/* The same for a signal that comes in pieces, in constant memory; its header is copied.  Rows, of which
 * the first open the file, are one after the other.  A note that is known at the end is left out by AU and
 * CSV.  The functions die if they fail; end frees. */
typedef struct tool_signal tool_signal;
tool_signal *tool_signal_new(const ss_header *head, const char *path, tool_kind kind);
void tool_signal_rows(tool_signal *signal, const double *rows, size_t n);
void tool_signal_note(tool_signal *signal, const char *key, const char *value);
void tool_signal_end(tool_signal *signal);

/* Write a script to what -o names, a .gp or standard output, or the picture that gnuplot makes of
 * it; opts get the picture's format.  Dies with gnuplot's own words if that fails. */
typedef ss_status tool_script(FILE *out, const ss_plot_opts *opts, void *user, ss_error *err);
void tool_draw(const char *path, ss_plot_opts *opts, tool_script *write_script, void *user);

/* --- long work ----------------------------------------------------------------------------- */

/* Call before long work, with what -o names.  If that is standard output, the first SIGINT, SIGTERM
 * or SIGHUP from here on does not kill at once: tool_progress answers 1 and sinks should too
 * (tool_stopping), the row is finished, and tool_end dies of the signal. */
void tool_end_at_rows(const char *path);
int tool_stopping(void);
/* How far the work is, 0 to 1: after a second, on a terminal that the data do not go to, a line on
 * standard error shows it with the time left.  user is not NULL where data only come later.  1 if the
 * user has asked to stop; the function of an ss_progress. */
int tool_progress(double done, void *user);

#endif
