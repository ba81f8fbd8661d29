/* common.h -- functions for every tool: messages with its name, exit codes, input, and output that
 * is whole or absent. */
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
/* Call last, before returning 0: finishes standard output, or dies; with -v, reports the cost. */
void tool_end(void);

void tool_die(const char *format, ...) TOOL_PRINTF TOOL_NORETURN;    /* "ss-x: text", exit 1 */
/* Wrong usage: "ss-x: text", exit 2.  format is NULL after a message of getopt. */
void tool_usage(const char *format, ...) TOOL_PRINTF TOOL_NORETURN;
/* Exit without a message, and leave the memory to the system, so that a leak checker does not report it. */
void tool_leave(int status) TOOL_NORETURN;
void tool_warn(const char *format, ...) TOOL_PRINTF;        /* a line on stderr, unless -q */
void tool_note(const char *format, ...) TOOL_PRINTF;        /* a line on stderr, only with -v */
extern ss_error tool_error;     /* of the library's calls: a failure ends the tool, so one is enough */
void tool_check(ss_status status);      /* dies of tool_error unless SS_OK, or SS_STOP */
void tool_check_error(ss_status status, const ss_error *err);   /* the same of another error */
/* Dies of tool_error unless SS_OK, with the name of the input. */
void tool_check_input(ss_status status, const char *path);
const char *tool_s(size_t n);                   /* the ending of a noun of which there are n: "" or "s" */
/* The same for the file of a base; the hint names no option, as the file is read without options. */
void tool_check_base(ss_status status);
/* Returns room for n entries of size bytes each, with what the list had (NULL: a new one), or
 * dies; to be freed. */
void *tool_room(void *list, size_t n, size_t size);
/* A hint how to remedy a failure, "; text", or "". */
const char *tool_hint(ss_status status, const ss_error *err);

/* Write the text of --help, or the version, and exit. */
void tool_show(int help) TOOL_NORETURN;
double tool_seconds(void);      /* on a clock that goes evenly */

extern int tool_verbosity;      /* 0; -q sets -1, -v sets 1 */

/* Several values of one option, in their order; they live as long as the tool. */
typedef struct tool_texts {
    const char **text;
    size_t n;
} tool_texts;

/* --- input --------------------------------------------------------------------------------- */

/* The one FILE argument: argv[optind], or "-" if there is none; more are wrong usage. */
const char *tool_input(int argc, char *argv[], int optind);
/* The name of a path in messages: "<stdin>" for "-"; and in outputs, without folders unless it is a dataset's. */
const char *tool_input_name(const char *path);
const char *tool_file_name(const char *path);
/* Wrong usage if more than one of n paths, which may be NULL, is "-". */
void tool_one_stdin(const char *const path[], size_t n);
/* Call with each path that an option or argument names as a file to read, before or after output
 * is opened.  Dies if the output is the same file, by whatever name.  Returns path.  The functions
 * below call it. */
const char *tool_reads(const char *path);
/* The same for the path after -o, as soon as it is known; tool_output_kind and tool_output call it. */
void tool_writes(const char *path);
/* Open for reading, or die; "-" is stdin. */
FILE *tool_open(const char *path);
/* Begin to read a signal from "-", a file or HDF5 (with ":/dataset") row by row, or die. */
ss_reader *tool_read_rows(const char *path, const ss_read_opts *opts);
/* Room for so many rows of n columns, to be freed by one free(), or die. */
double **tool_columns(size_t n, size_t rows);
/* Read at most max rows, as ss_reader_rows does.  Returns their number; 0 at the end.  Dies at a bad row, when those
 * before it were given. */
size_t tool_rows(ss_reader *reader, double *const column[], size_t max);
/* Read a whole signal from "-", a file or HDF5 (with ":/dataset"), or die. */
ss_signal *tool_read_signal(const char *path, const ss_read_opts *opts);
/* Read coefficients from "-", a file or HDF5, or die. */
ss_coefficients *tool_read_coefficients(const char *path);
/* Read features or events, as kind says, from "-" or a file, or die; NULL if path is NULL. */
ss_overlay *tool_read_overlay(const char *path, ss_kind kind);
/* Read a scene from a path, the name of a shipped scene, or "-"; then settings "key=value" by these options, such
 * as "--set", replace its values.  Dies if that fails; a wrong setting is wrong usage. */
ss_scene tool_read_scene(const char *path, const tool_texts *settings, const char *options);
/* The name of a scene, or of a signal, as above, and the settings that change its physics (NULL: none), in one
 * line; to be freed. */
char *tool_name_scene(const char *path, const tool_texts *settings);
/* Append a word to a list of at least 8 bytes for a message: "a, b", and " ..." where no more fits. */
void tool_list(char *list, size_t size, const char *word);
/* The index of a column by name or number, or die with a list of the columns.  If name is NULL:
 * that of which the file has coefficients, or "a", or else the only column. */
size_t tool_column(const ss_header *head, const char *path, const char *name);

/* --- output -------------------------------------------------------------------------------- */

typedef enum tool_kind {        /* chosen by the ending of the file after -o, or by --format */
    TOOL_H5, TOOL_GP, TOOL_PNG, TOOL_SVG, TOOL_PDF, TOOL_EPS,
    TOOL_STREAM,                /* and from here on a format of streams: see tool_stream */
    TOOL_TSV = TOOL_STREAM + SS_TSV
} tool_kind;

/* Sets of output kinds, to be combined with |: pictures, formats of streams that hold words, all
 * formats of streams, signals. */
enum {
    TOOL_PICTURES = 1 << TOOL_GP | 1 << TOOL_PNG | 1 << TOOL_SVG | 1 << TOOL_PDF | 1 << TOOL_EPS,
    TOOL_WORDS = 1 << TOOL_STREAM,
    TOOL_NUMBERS = TOOL_WORDS | 1 << (TOOL_STREAM + 1),
    TOOL_SIGNALS = TOOL_NUMBERS | 1 << TOOL_H5
};

/* The format of a kind that is a stream or HDF5. */
ss_format tool_stream(tool_kind kind);
/* The kind of path's ending, among those allowed, else wrong usage that
 * names them; standard output (NULL or "-") has the fallback. */
tool_kind tool_output_kind(const char *path, unsigned allowed, tool_kind fallback);

/* Open the output that -o names.  NULL or "-" is standard output.  A file is whole or absent: it
 * gets its name in tool_end.  Before, it has no name, or if the system has no such files, a
 * temporary name beside path, which tool_die, SIGINT, SIGTERM, SIGHUP and SIGQUIT remove. */
FILE *tool_output(const char *path);
/* The same for a library call that needs a path: returns one that leads to the file. */
const char *tool_output_path(const char *path);

/* Open a file at its start, or make it, so that a later run can continue it: all that is written
 * stays, whatever happens.  Dies if another process has opened it in this way. */
FILE *tool_output_kept(const char *path);

/* Begin to write to the output that -o names, as .h5 or a stream, or die. */
ss_writer *tool_writer(const char *path, tool_kind kind, const ss_contents *contents);
/* Append rows, which leave the tool at once, or die. */
void tool_write_rows(ss_writer *writer, double *const column[], size_t n);
/* Complete the file and free the writer, or die. */
void tool_write_end(ss_writer *writer, size_t samples);
/* All of this for a signal in memory. */
void tool_write(const ss_signal *signal, const char *path, tool_kind kind);

/* Copy the columns that are wanted, or all, of a reader of the file `from`, which is freed, as they come, and give
 * them the names "OLD=NEW"; then call last, unless it is NULL. */
void tool_copy(ss_reader *reader, const char *from, const tool_texts *wanted, const tool_texts *names, const char *to,
               tool_kind kind, void (*last)(ss_writer *out));

/* Call before work for tool_draw with the path after -o: dies if a script would go to a terminal unasked. */
void tool_script_to(const char *path);
/* Begin a script for the output that -o names, a .gp or standard output, or for the picture that gnuplot makes of it;
 * opts get the format of the picture. */
FILE *tool_draw(const char *path, ss_plot_opts *opts);
/* End it, with the status of writing it.  Dies with the message of gnuplot if that fails. */
void tool_drawn(FILE *script, ss_status status);

/* --- long work ----------------------------------------------------------------------------- */

/* Call before long work, with the path after -o.  If this is standard output, the first SIGINT,
 * SIGTERM or SIGHUP after this call does not kill at once: tool_progress returns 1, sinks should
 * return 1 too (tool_stopping), standard input ends, tool_rows gives none of the rows that it was about to read, the
 * row is finished, and tool_end dies of the signal. */
void tool_end_at_rows(const char *path);
int tool_stopping(void);
/* The function of an ss_progress, called with the part of the work that is done, 0 to 1.  After a
 * second, if standard error is a terminal and the data do not go to one, a line there shows it
 * with the time left.  user is not NULL if data are written only later.  Returns 1 if the user has
 * asked to stop. */
int tool_progress(double done, void *user);
/* The same while a signal is read of which work begins when all of it is read; and the end of reading. */
int tool_reading_progress(double done, void *user);
void tool_reading_done(void);

#endif
