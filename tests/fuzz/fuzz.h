/* fuzz.h -- what the harnesses of the readers share.
 *
 * A harness reads its input as a file of one kind.  Beyond crashes, which the sanitizers see, it
 * holds the reader to what it promises: a refusal is one line of text, and what is accepted can be
 * written and read back the same. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stickslip.h>

/* libFuzzer calls it with what it makes up, replay.c with the files of the corpus. */
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* Abort, which libFuzzer takes for a crash, unless it is true. */
void fuzz_check(int is_true, const char *what);
/* Is this how a reader refuses input? */
void fuzz_check_refusal(ss_status status, const ss_error *err);

FILE *fuzz_open(const void *bytes, size_t size);
/* Read a signal, check it, write it, read that back and compare. */
void fuzz_signal(const uint8_t *bytes, size_t size, const ss_read_opts *opts);
void fuzz_check_signal(const ss_signal *signal);
/* The same for coefficients that have been read. */
void fuzz_check_coefficients(const ss_coefficients *coefficients);

#endif
