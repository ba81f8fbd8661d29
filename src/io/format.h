/* format.h -- the formats in which signals and rows are read and written.
 *
 * A new format needs a file that defines such a table, and a row in the list below. */
#ifndef FORMAT_H
#define FORMAT_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/signal.h>

struct format {
    const char *name;           /* "au": the name for users; a file's ending is a dot and this */

    /* To read a signal: the bytes with which it begins, where "?" is any byte; NULL: this format
     * is tried last. */
    const char *magic;
    int has_header;             /* 1: it begins with our header, whose first line names the kind, so that it
                                   may hold coefficients too */
    ss_status (*open)(ss_reader *reader, const ss_read_opts *opts, ss_error *err);  /* or NULL */

    /* To write numbers: begin a file with a header whose first line is magic; NULL: it is not written. */
    ss_status (*begin)(FILE *out, const ss_header *head, const char *magic, ss_error *err);
    /* Write a cell of at most SS_NUMBER_MAX bytes; last: 1 if it ends its row.  Returns its length. */
    size_t (*number)(char *to, double x, int last);
    int has_time;               /* 1: it has a column of time, like the other columns */
    int has_notes;              /* 1: lines "# key: value" are allowed everywhere */
    char separator;             /* of cells that may be words; '\0': it holds numbers only */
    void (*word)(FILE *out, const char *word);  /* write such a cell; NULL: as it is */
};

/* The list, in the order of ss_format: ss_format_tsv and so on.  The format without magic is tried
 * last. */
#define FORMAT_LIST(row) \
    row(tsv) \
    row(au) \
    row(delimited) \
    row(wav) \
    row(npy)

#define FORMAT_DECLARATION(name) extern const struct format ss_format_##name;
FORMAT_LIST(FORMAT_DECLARATION)
#undef FORMAT_DECLARATION

/* The table of a format that can be written, or NULL. */
const struct format *ss_format_table(ss_format of);
/* The format of a signal that begins with these n bytes. */
const struct format *ss_format_of_bytes(const char *bytes, size_t n);
enum { FORMAT_BYTES = 12 };     /* the longest magic */

#endif
