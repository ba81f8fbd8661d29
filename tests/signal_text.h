/* signal_text.h -- signals from text and bytes, as the tests of signals need them. */
#ifndef SIGNAL_TEXT_H
#define SIGNAL_TEXT_H

#include <stdio.h>
#include <string.h>
#include <stickslip/signal.h>

#include "unit.h"

/* The header of a signal as text. */
#define HEAD "# stickslip signal 1\n# rate: 10\n# columns: t/s x/m v/(m/s)\n"

/* A file that holds these bytes, at its start. */
static inline FILE *
file_of(const void *bytes, size_t n)
{
    FILE *f = tmpfile();
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    rewind(f);
    return f;
}

static inline ss_status
read_bytes(ss_signal **out, const void *bytes, size_t n, const ss_read_opts *opts, ss_error *err)
{
    FILE *f = file_of(bytes, n);
    ss_status st = ss_signal_read(out, f, "in", opts, err);
    fclose(f);
    return st;
}

static inline ss_signal *
read_text(const char *text, const ss_read_opts *opts)
{
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    if (read_bytes(&signal, text, strlen(text), opts, &err) != SS_OK)
        fail_msg("%s: %s", text, err.text);
    return signal;
}

static inline ss_header *
sample_header(void)
{
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, 1000. / 3, -0.1, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "x", "m", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "v", "m/s", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "c", "N s", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "f", "", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "(odd", "(a b)/(c)", NULL), SS_OK);
    assert_int_equal(ss_header_note(head, "scene", "a test: it has a colon", NULL), SS_OK);
    return head;
}

static inline ss_signal *
wave(ss_wave kind, ss_wave_opts opts)
{
    ss_signal *s;
    ss_error err = { 0 };
    if (ss_wave_new(&s, kind, &opts, &err) != SS_OK)
        fail_msg("%s", err.text);
    return s;
}

#endif
