/* fuzz_sweep.c -- rows of sweeps, and the map that is drawn of them. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

/* As tools write rows: the cells are words or numbers. */
static void
check_reads_back(const ss_table *t)
{
    char *text = NULL;
    size_t length = 0;
    ss_table *back = NULL;
    ss_error err = { 0 };
    FILE *out = open_memstream(&text, &length);
    fuzz_check(out != NULL, "memory for a stream");
    fputs("# stickslip sweep 1\n# columns:", out);
    for (size_t c = 0; c < t->n_columns; c++)
        fprintf(out, " c%zu", c);
    fputc('\n', out);
    for (size_t i = 0; i < t->n * t->n_columns; i++)
        fprintf(out, "%s%c", t->cell[i], (i + 1) % t->n_columns == 0 ? '\n' : '\t');
    fclose(out);
    FILE *in = fuzz_open(text, length);
    fuzz_check(ss_table_read(&back, in, "in", SS_KIND_SWEEP, &err) == SS_OK, err.text);
    fclose(in);
    free(text);
    fuzz_check(back->n_columns == t->n_columns && back->n == t->n, "as many rows and columns");
    for (size_t i = 0; i < t->n * t->n_columns; i++)
        fuzz_check(strcmp(t->cell[i], back->cell[i]) == 0, "cells read back");
    ss_table_free(back);
}

/* The last two columns over the two before them, or why there is no such map. */
static void
draw(const ss_table *t)
{
    const size_t n = t->n_columns;
    char *text = NULL;
    size_t length = 0;
    ss_error err = { 0 };
    if (n < 4)
        return;
    const size_t column[] = { n - 4, n - 3, n - 2, n - 1 };
    FILE *out = open_memstream(&text, &length);
    fuzz_check(out != NULL, "memory for a stream");
    ss_status status = ss_plot_sweep(out, t, column, 4, NULL, &err);
    if (status != SS_OK)
        fuzz_check_refusal(status == SS_EINVAL ? SS_EDATA : status, &err);
    fclose(out);
    free(text);
}

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    ss_table *table = NULL;
    ss_error err = { 0 };
    FILE *in = fuzz_open(bytes, size);
    ss_status status = ss_table_read(&table, in, "in", SS_KIND_SWEEP, &err);
    fclose(in);
    if (status == SS_OK) {
        fuzz_check(table->n_columns > 0, "columns");
        check_reads_back(table);
        draw(table);
    } else {
        fuzz_check_refusal(status, &err);
    }
    ss_table_free(table);
    return 0;
}
