/* fuzz_sweep.c -- rows of sweeps, and the map that is drawn of them. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* As ss-sweep writes rows; the names are not what is looked at. */
static void
check_reads_back(const ss_sweep_table *t)
{
    char *text = NULL, number[SS_NUMBER_MAX];
    size_t length = 0;
    ss_sweep_table *back = NULL;
    ss_error err = { "" };
    FILE *out = open_memstream(&text, &length);
    fuzz_check(out != NULL, "memory for a stream");
    fputs("# stickslip sweep 1\n# columns:", out);
    for (size_t c = 0; c < t->n_columns; c++)
        fprintf(out, " c%zu", c);
    fputs(" status\n", out);
    for (size_t i = 0; i < t->n; i++) {
        for (size_t c = 0; c < t->n_columns; c++) {
            double x = t->value[c * t->n + i];
            ss_number_format(number, x);
            fprintf(out, "%s\t", isnan(x) ? "-" : number);
        }
        fputs("ok\n", out);
    }
    fclose(out);
    FILE *in = fuzz_open(text, length);
    fuzz_check(ss_sweep_read(&back, in, "in", &err) == SS_OK, err.text);
    fclose(in);
    free(text);
    fuzz_check(back->n_columns == t->n_columns && back->n == t->n, "as many rows and columns");
    for (size_t i = 0; i < t->n * t->n_columns; i++)
        fuzz_check(isnan(t->value[i]) ? isnan(back->value[i]) : t->value[i] == back->value[i],
                   "values read back");
    ss_sweep_table_free(back);
}

/* The last two columns over the two before them, or why there is no such map. */
static void
draw(const ss_sweep_table *t)
{
    const size_t n = t->n_columns;
    char *text = NULL;
    size_t length = 0;
    ss_error err = { "" };
    if (n < 4)
        return;
    const ss_map_opts map = { .x = n - 4, .y = n - 3, .z = { n - 2, n - 1 }, .n_z = 2 };
    FILE *out = open_memstream(&text, &length);
    fuzz_check(out != NULL, "memory for a stream");
    ss_status status = ss_plot_map(out, t, &map, &ss_plot_defaults, &err);
    if (status != SS_OK)
        fuzz_check_refusal(status == SS_EINVAL ? SS_EDATA : status, &err);
    fclose(out);
    free(text);
}

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    ss_sweep_table *table = NULL;
    ss_error err = { "" };
    FILE *in = fuzz_open(bytes, size);
    ss_status status = ss_sweep_read(&table, in, "in", &err);
    fclose(in);
    if (status == SS_OK) {
        fuzz_check(table->n_columns > 0, "columns");
        for (size_t i = 0; i < table->n * table->n_columns; i++)
            fuzz_check(!isinf(table->value[i]), "finite values");
        check_reads_back(table);
        draw(table);
    } else {
        fuzz_check_refusal(status, &err);
    }
    ss_sweep_table_free(table);
    return 0;
}
