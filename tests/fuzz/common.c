/* common.c -- what the harnesses of the readers share. */
#include <stickslip/store.h>
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void
fuzz_check(int is_true, const char *what)
{
    if (is_true)
        return;
    fprintf(stderr, "not so: %s\n", what);
    abort();
}

void
fuzz_check_refusal(ss_status status, const ss_error *err)
{
    fuzz_check((status >= SS_EDATA && status <= SS_ETABLES) || status == SS_ENOMEM
               || status == SS_ERANGE, "refused as malformed, or beyond what a double holds");
    fuzz_check(err->text[0] != '\0', "refused with a text");
    ss_error shown = *err;
    fuzz_check(strcmp(ss_printable(shown.text), err->text) == 0, "refused in one printable line");
}

FILE *
fuzz_open(const void *bytes, size_t size)
{
    static char nothing;
    FILE *in = size > 0 ? fmemopen((void *)bytes, size, "r") : fmemopen(&nothing, 1, "r");
    fuzz_check(in != NULL, "memory for a stream");
    if (size == 0)
        getc(in);
    return in;
}

/* --- signals ------------------------------------------------------------------------------- */

static ss_status
read_signal(ss_signal **signal, const void *bytes, size_t size, const ss_read_opts *opts,
            ss_error *err)
{
    FILE *in = fuzz_open(bytes, size);
    ss_status status = ss_signal_read(signal, in, "in", opts, err);
    fclose(in);
    return status;
}

static void
check_same_columns(const ss_header *a, const ss_header *b)
{
    fuzz_check(a->n_columns == b->n_columns, "as many columns");
    for (size_t i = 0; i < a->n_columns; i++) {
        fuzz_check(strcmp(a->column[i].name, b->column[i].name) == 0, "names read back");
        fuzz_check(strcmp(a->column[i].unit, b->column[i].unit) == 0, "units read back");
    }
}

void
fuzz_check_signal(const ss_signal *signal)
{
    const ss_header *head = signal->head;
    size_t length = 0, values = signal->n * head->n_columns;
    char *text = NULL;
    ss_signal *back = NULL;
    ss_error err = { 0 };

    fuzz_check(head->rate > 0 && isfinite(head->rate) && isfinite(head->start), "a clock");
    fuzz_check(head->n_columns > 0, "columns");
    for (size_t i = 0; i < values; i++)
        fuzz_check(isfinite(signal->values[i]), "finite values");

    FILE *out = open_memstream(&text, &length);
    fuzz_check(out != NULL, "memory for a stream");
    fuzz_check(ss_record_write(&(ss_record){ .signal = signal }, out, NULL, SS_TSV, NULL) == SS_OK, "written");
    fclose(out);
    fuzz_check(read_signal(&back, text, length, NULL, &err) == SS_OK, err.text);
    free(text);
    fuzz_check(back->n == signal->n, "as many rows");
    check_same_columns(head, back->head);
    fuzz_check(memcmp(back->values, signal->values, values * sizeof *back->values) == 0,
               "values read back");
    ss_signal_free(back);
}

void
fuzz_signal(const uint8_t *bytes, size_t size, const ss_read_opts *opts)
{
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    ss_status status = read_signal(&signal, bytes, size, opts, &err);
    if (status == SS_OK)
        fuzz_check_signal(signal);
    else
        fuzz_check_refusal(status, &err);
    ss_signal_free(signal);
}

/* --- coefficients -------------------------------------------------------------------------- */

static void
check_reads_back(const ss_coefficients *c, size_t total, ss_format format)
{
    size_t length = 0;
    char *text = NULL;
    ss_coefficients *back = NULL;
    ss_error err = { 0 };
    FILE *out = open_memstream(&text, &length);
    fuzz_check(out != NULL, "memory for a stream");
    ss_status status = ss_record_write(&(ss_record){ .coefficients = c }, out, NULL, format, NULL);
    fclose(out);
    if (format == SS_AU && status == SS_EINVAL) {       /* its header is too long for AU */
        free(text);
        return;
    }
    fuzz_check(status == SS_OK, "written");
    FILE *in = fuzz_open(text, length);
    fuzz_check(ss_coefficients_read(&back, in, "in", &err) == SS_OK, err.text);
    fclose(in);
    free(text);
    fuzz_check(back->n == c->n && back->n_scales == c->n_scales, "as many coefficients");
    fuzz_check(memcmp(back->w, c->w, 2 * total * sizeof *c->w) == 0, "coefficients read back");
    ss_coefficients_free(back);
}

void
fuzz_check_coefficients(const ss_coefficients *c)
{
    size_t total = 0;
    fuzz_check(c->n > 0 && c->n_scales > 0, "coefficients");
    for (size_t i = 0; i < c->n_scales; i++) {
        fuzz_check(c->scale[i].n > 0 && c->scale[i].offset == total, "a grid");
        total += c->scale[i].n;
    }
    for (size_t i = 0; i < 2 * total; i++)
        fuzz_check(isfinite(c->w[i]), "finite coefficients");

    check_reads_back(c, total, SS_TSV);
    check_reads_back(c, total, SS_AU);
}
