/* output.h -- a buffer of bytes that will be written. */
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

/* Write the bytes of the buffer; SS_EIO if that fails. */
ss_status ss_output_drain(struct output *out);
/* Flush the file; SS_EIO if any write to it failed. */
ss_status ss_output_flush(FILE *file);

#endif
