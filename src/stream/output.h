/* output.h -- bytes on their way out, gathered. */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/status.h>

enum { OUTPUT_ROOM = 1 << 16 };
struct output {
    FILE *file;
    size_t used;
    char buffer[OUTPUT_ROOM];
};

/* Write the gathered bytes; SS_EIO if the file refuses it. */
ss_status ss_output_drain(struct output *out);
/* Have the file write all that it holds; SS_EIO if any of it failed. */
ss_status ss_output_flush(FILE *file);

#endif
