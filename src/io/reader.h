/* reader.h -- a handle on the outermost of the sources that make the rows of a file. */
#ifndef READER_H
#define READER_H

#include "io/format.h"

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

#endif
