/* format.h -- the formats in which signals, coefficients and rows are read and written.
 *
 * A new format needs a file that defines such a table, and a row in the list below. */
#ifndef FORMAT_H
#define FORMAT_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/morlet.h>
#include <stickslip/signal.h>
#include <stickslip/store.h>
#include "io/input.h"
#include "signal/source.h"

/* A stream that is opened. */
struct opening {
    struct input *in;           /* outlives the ss_source */
    const ss_read_opts *opts;   /* of the call alone; to begin with, the caller's, or NULL */
    ss_kind kind;               /* a signal, or wavelet coefficients */
    /* Takes a line "# ..." that stands among the rows; NULL: it is passed over. */
    ss_status (*late_note)(void *user, char *line, ss_error *err);
    void *user;
};

struct format {
    const char *name;           /* "au": the name for users; a file's ending is a dot and this */

    /* To read a stream: the bytes with which it begins, where "?" is any byte; NULL: this format is tried
     * last.  *out must be set, or be NULL, even after a failure; the caller frees it. */
    const char *magic;
    int has_header;             /* 1: it begins with our header, whose first line names the kind, so that it
                                   may hold coefficients too */
    ss_status (*open)(ss_source **out, const struct opening *o, ss_error *err);        /* or NULL */

    /* To read what only its path opens: is the file at path of this format?  place: of a signal in it, or NULL. */
    int (*is_file)(const char *path);
    ss_status (*open_file)(ss_source **out, const char *path, const char *place, const ss_read_opts *opts,
                           ss_error *err);
    ss_status (*open_map)(ss_coefficients **out, const char *path, ss_error *err);     /* the coefficients in it */

    /* To write numbers: begin a file with a header whose first line is magic; NULL: no stream is written. */
    ss_status (*begin)(FILE *out, const ss_header *head, const char *magic, ss_error *err);
    /* Write a cell of at most SS_NUMBER_MAX bytes; last: 1 if it ends its row.  Returns its length.  NULL: it is
     * text, with the separator or a newline behind it. */
    size_t (*number)(char *to, double x, int last);
    /* Complete what begin has written, behind the last of the rows; NULL: it is complete. */
    ss_status (*end)(FILE *out, double rate, size_t columns, size_t rows, ss_error *err);
    int has_time;               /* 1: it has a column of time, like the other columns */
    int has_notes;              /* 1: lines "# key: value" are allowed everywhere */
    char separator;             /* of cells that may be words; '\0': it holds numbers only */
    void (*word)(FILE *out, const char *word);  /* write such a cell; NULL: as it is */
    /* Write the name before a cell, and what separates it; NULL: names stand in the header.  A row then ends with
     * a brace. */
    void (*key)(FILE *out, const char *name, int first);
};

/* The list, in the order of ss_format: ss_format_tsv and so on.  The format without magic is tried last. */
#define FORMAT_LIST(row) \
    row(tsv) \
    row(au) \
    row(delimited) \
    row(hdf5) \
    row(json) \
    row(wav) \
    row(npy)

#define FORMAT_DECLARATION(name) extern const struct format ss_format_##name;
FORMAT_LIST(FORMAT_DECLARATION)
#undef FORMAT_DECLARATION
#define FORMAT_NUMBER(name) FORMAT_##name,
enum { FORMAT_LIST(FORMAT_NUMBER) FORMATS };
#undef FORMAT_NUMBER
_Static_assert((int)SS_TSV == FORMAT_tsv && (int)SS_AU == FORMAT_au && (int)SS_CSV == FORMAT_delimited
               && (int)SS_JSON == FORMAT_json && (int)SS_WAV == FORMAT_wav,
               "the list has the order of ss_format");

/* Begins the table of a format, FORMAT(au) = { ... };.  Without a row of the list it does not compile. */
#define FORMAT(name) \
    enum { ROW_OF_##name = FORMAT_##name }; \
    const struct format ss_format_##name

/* The table of a format in which streams are written, or NULL. */
const struct format *ss_format_table(ss_format of);
/* Open a stream in the format that its first bytes show. */
ss_status ss_format_open(ss_source **out, const struct opening *o, ss_error *err);
/* The format of a file that only its path opens; NULL: it is a stream, or there is none. */
const struct format *ss_format_of_file(const char *path);

enum { COEFFICIENT_COLUMNS = 7 };
extern const char *const ss_coefficient_columns[COEFFICIENT_COLUMNS][2];        /* name and unit */

/* Refuse an option for delimited text alone. */
ss_status ss_refuse_table(const char *name, const ss_read_opts *opts, ss_error *err);
/* Refuse it, and options for input without a clock; this input has the rate own. */
ss_status ss_refuse_clock(const char *name, double own, const ss_read_opts *opts, ss_error *err);

/* --- a reader: a handle on the outermost of the sources that make the rows of a file --------- */

struct ss_reader {
    ss_source *source;
    struct input in;            /* of a stream */
    FILE *file;                 /* that the reader closes, or NULL */
};

/* Begin to read a stream of this kind, in the format that its first bytes show, or, if in is NULL, the file whose
 * path is its name; o->in becomes the reader's. */
ss_status ss_reader_open(ss_reader **out, FILE *in, const char *name, struct opening *o, ss_error *err);

/* The file of a path, to be freed, and the place in it: the path may go on behind the file's name with ":/" and a
 * place; else that is NULL. */
char *ss_file_of(const char *path, const char **place);

/* Wrap a source for the options that hold for every format: a span of time, factors and units (adjust.c). */
ss_status ss_source_adjust(ss_source **s, const ss_read_opts *opts, ss_error *err);
/* Wrap a source that cannot go back in one that can (table/samples.c). */
ss_status ss_source_keep(ss_source **s, const char *folder, ss_error *err);

/* --- a writer of one file: as a stream (writer.c), or in HDF5 (hdf5/writer.c) ---------------- */

struct writer_calls {           /* as the public functions, whose arguments have been checked */
    ss_status (*rows)(ss_writer *w, double *const column[], size_t n, ss_error *err);
    ss_status (*coefficients)(ss_writer *w, const ss_scale *scale, size_t first, size_t n, const double *c,
                              size_t samples, ss_error *err);
    ss_status (*events)(ss_writer *w, const ss_event *event, size_t n, ss_error *err);
    ss_status (*note)(ss_writer *w, const char *key, const char *value, ss_error *err);
    ss_status (*end)(ss_writer *w, size_t samples, ss_error *err);
    void (*free)(ss_writer *w);
};

/* The first member of each writer. */
struct ss_writer {
    const struct writer_calls *calls;
};

/* What HDF5 is needed for, behind the checks of arguments. */
struct ss_store_calls {
    /* As open_file of a format. */
    ss_status (*open_signal)(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts,
                             ss_error *err);
    ss_status (*open_coefficients)(ss_coefficients **out, const char *path, ss_error *err);
    ss_status (*writer_new)(ss_writer **out, const char *path, const ss_contents *contents, ss_error *err);
};

#endif
