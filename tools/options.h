/* options.h -- the options of a tool: a table with a row for each, read by one function.
 *
 * A table is an array of rows that the macros below make, such as
 *     const tool_option options[] = {
 *         TOOL_NUMBER('t', "tol", &opts.tol, ss_sim_tolerances), TOOL_FLAG('e', "events", &events),
 *         TOOL_OUTPUT(&path) };
 * A row has the option's letter, or 0, its long name, and where its value goes. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "common.h"

typedef struct tool_option tool_option;
struct tool_option {
    int letter;
    const char *name;
    void (*set)(const tool_option *option, char *text);     /* text: the value; NULL if it has none */
    void *to;
    ss_range range;             /* of a number; of formats, { 1, 1 }: of those that hold words */
    const char *const *word;    /* NULL-terminated, of a choice */
    const char *(*known)(size_t i);     /* the i-th name that it may be; NULL after the last */
    int has_value;
};

/* A pointer, if it is one to this type; else the compiler warns. */
#define TOOL_TO(type, pointer) (1 ? (pointer) : (type *)NULL)

#define TOOL_FLAG(letter, name, to) { letter, name, tool_set_flag, TOOL_TO(int, to), { 0, 0 }, NULL, NULL, 0 }
#define TOOL_TEXT(letter, name, to) \
    { letter, name, tool_set_text, TOOL_TO(const char *, to), { 0, 0 }, NULL, NULL, 1 }
#define TOOL_TEXTS(letter, name, to) \
    { letter, name, tool_set_texts, TOOL_TO(tool_texts, to), { 0, 0 }, NULL, NULL, 1 }
#define TOOL_NUMBER(letter, name, to, range) \
    { letter, name, tool_set_number, TOOL_TO(double, to), range, NULL, NULL, 1 }
#define TOOL_WHOLE(letter, name, to, range) \
    { letter, name, tool_set_whole, TOOL_TO(int, to), range, NULL, NULL, 1 }
/* From 1 on, or 0 if it is not given. */
#define TOOL_COUNT(letter, name, to) \
    { letter, name, tool_set_count, TOOL_TO(unsigned long, to), { 0, 0 }, NULL, NULL, 1 }
/* to: an enumeration of the library, in the order of the words. */
#define TOOL_CHOICE(letter, name, to, words) { letter, name, tool_set_choice, to, { 0, 0 }, words, NULL, 1 }
/* One of the names that the function gives. */
#define TOOL_NAME(letter, name, to, known) \
    { letter, name, tool_set_name, TOOL_TO(const char *, to), { 0, 0 }, NULL, known, 1 }
/* set: a function of the tool, called with this row. */
#define TOOL_VALUE(letter, name, set, to) { letter, name, set, to, { 0, 0 }, NULL, NULL, 1 }
#define TOOL_CALL(letter, name, set, to) { letter, name, set, to, { 0, 0 }, NULL, NULL, 0 }

/* Options that many tools have. */
#define TOOL_OUTPUT(to) TOOL_TEXT('o', "output", to)
#define TOOL_FORMAT(to) TOOL_VALUE(0, "format", tool_set_format, TOOL_TO(tool_kind, to))
#define TOOL_FORMAT_OF_WORDS(to) \
    { 0, "format", tool_set_format, TOOL_TO(tool_kind, to), { 1, 1 }, NULL, NULL, 1 }
#define TOOL_METHOD(letter, to) TOOL_NAME(letter, "method", to, ss_sim_method_name)
#define TOOL_STYLE(to) TOOL_CHOICE(0, "style", TOOL_TO(ss_plot_style, to), tool_styles)
#define TOOL_THREADS(letter, to) TOOL_WHOLE(letter, "threads", to, ((ss_range){ 1, SS_THREADS_MAX }))

void tool_set_flag(const tool_option *option, char *text);
void tool_set_text(const tool_option *option, char *text);
void tool_set_texts(const tool_option *option, char *text);
void tool_set_number(const tool_option *option, char *text);
void tool_set_whole(const tool_option *option, char *text);
void tool_set_count(const tool_option *option, char *text);
void tool_set_choice(const tool_option *option, char *text);
void tool_set_name(const tool_option *option, char *text);
void tool_set_format(const tool_option *option, char *text);            /* in output.c */
extern const char *const tool_styles[];

/* Values in the functions of a tool, which give the row's name; wrong ones are wrong usage. */
double tool_number(const char *option, const char *text, double lo, double hi);
long tool_integer(const char *option, const char *text, long lo, long hi);
/* Two numbers "A:B", lo <= A <= B <= hi; form is what the message says is wanted. */
void tool_pair(const char *option, const char *text, const char *form, double lo, double hi,
               double pair[2]);
/* The index of text in the NULL-terminated list. */
int tool_choice(const char *option, const char *text, const char *const choice[]);

/* --- the options of reading a signal ------------------------------------------------------- */

#define TOOL_READING_USAGE \
    "Of reading, as in ss-cat:\n" \
    "      --time=NAME|N, --time-unit=UNIT, --rate=HZ, --table=N, --gaps=HOW,\n" \
    "      --resample=HZ, --from=S, --to=S, --scale=[NAME=]F, --unit=[NAME=]U\n"

/* Begin with { 0 }, or with the letters of two of the options.  What it holds lives as long as the tool: it is
 * static. */
typedef struct tool_reading {
    int time_letter, rate_letter;
    ss_read_opts opts;          /* for tool_read_signal and ss_reader_new */
    double from, to;            /* NaN: not given; in opts too */
    ss_calibration *calibration;
    int given;                  /* was any of the options? */
} tool_reading;

/* Call after tool_parse.  Of delimited text only these n columns, whose names are not copied, are needed; all, if n
 * is 0.  --scale and --unit without a name are of the column, if it is one, else of the only one of the file. */
void tool_reading_end(tool_reading *r, const char *const *column, size_t n);

/* For tool_parse: begin, and write the rows. */
enum { TOOL_READING_OPTIONS = 10 };
void tool_reading_options(tool_reading *r, tool_option row[TOOL_READING_OPTIONS]);

/* --- the command line ---------------------------------------------------------------------- */

/* Read the options of the command line: those of the table, those of reading a signal unless reading is
 * NULL, and -q, -v, --help and --version.  Gives the index of the first argument that is no option. */
int tool_parse(int argc, char *argv[], const tool_option option[], size_t n, tool_reading *reading);
#define TOOL_PARSE(argc, argv, options, reading) \
    tool_parse(argc, argv, options, sizeof (options) / sizeof *(options), reading)
/* 1 if an option of this long name was given. */
int tool_given(const char *name);
/* 1 if one was given that is not in the NULL-terminated list. */
int tool_given_others(const char *const names[]);

#endif
