/* input.h -- read bytes and lines of a stream as they arrive. */
#ifndef INPUT_H
#define INPUT_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/types.h>
#include <stickslip/status.h>

/* The longest line [bytes], far longer than any in a real file.  It bounds the memory of hostile input. */
enum { MAX_LINE = 1 << 24 };

/* Bytes of a stream as they arrive.  No call waits for more bytes than it needs. */
struct input {
    FILE *file;
    const char *name;           /* in messages; owned */
    char *buffer;
    size_t capacity, lo, hi;    /* unread bytes: buffer[lo ... hi) */
    size_t scanned;             /* there is no newline before this byte */
    int ended;
    ss_progress progress;       /* told the part of the file that was read, times share; set after opening */
    double share, size, had;    /* size, had [bytes]; size 0: not known */
    unsigned long line;         /* the number of the line read last, from 1 */
};
ss_status ss_input_open(struct input *in, FILE *file, const char *name, ss_error *err);
void ss_input_close(struct input *in);
/* Fill the buffer to n unread bytes, or up to the end of the stream. */
ss_status ss_input_need(struct input *in, size_t n, ss_error *err);
/* The same where all of them must be there; SS_EDATA: "truncated WHAT". */
ss_status ss_input_whole(struct input *in, size_t n, const char *what, ss_error *err);
/* Skip *n bytes, which may be more than memory holds; *n becomes the number of missing bytes. */
ss_status ss_input_skip(struct input *in, uint64_t *n, ss_error *err);
/* The next line, without its end and with a NUL behind it, valid until the next call; *length = 0
 * and *line = NULL at the end of the stream. */
ss_status ss_input_line(struct input *in, char **line, size_t *length, ss_error *err);
/* Read the first line, which must be the magic of the kind. */
ss_status ss_input_begin(struct input *in, ss_kind kind, ss_error *err);
/* The next line of text that is not blank, as ss_input_line gives it; *line = NULL at the end. */
ss_status ss_input_row(struct input *in, char **line, ss_error *err);
int ss_input_has_line(struct input *in);           /* 1: a whole line is in the buffer */
int ss_input_is_pipe(const struct input *in);      /* 1: its bytes may come slowly, and no end is known */
int ss_input_waits(const struct input *in);        /* 1: reading more bytes would block */

#endif
