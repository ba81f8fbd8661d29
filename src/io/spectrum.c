/* spectrum.c -- write spectra as text. */
#include <stickslip/spectrum.h>

#include <math.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/record.h"

/* Write the densities at one frequency. */
static void
write_row(struct rows *rows, ss_spectrum *const spectrum[], size_t k, const ss_column column[],
          const size_t index[], size_t n)
{
    const int decibels = spectrum[0]->decibels;
    char unit[DENSITY_UNIT];
    ss_rows_number(rows, "frequency", "Hz", (double)k * spectrum[0]->step);
    for (size_t i = 0; i < n; i++) {
        const ss_column *of = &column[index[i]];
        double density = spectrum[i]->density[k];
        ss_density_unit(unit, of->unit, decibels);
        ss_rows_number(rows, of->name, unit, !decibels ? density : density > 0 ? 10 * log10(density) : NAN);
    }
    ss_rows_end(rows);
}

ss_status
ss_spectra_write(ss_spectrum *const spectrum[], const ss_header *head, const size_t column[], size_t n,
                 FILE *out, ss_format format, ss_error *err)
{
    static const char *const own[] = { "resolution", "segments", NULL };
    char resolution[SS_NUMBER_MAX];
    struct rows rows;
    if (spectrum == NULL || head == NULL || column == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    if (n == 0)
        return ss_fail(err, SS_EINVAL, "no spectra to write");
    ss_status st = ss_rows_begin(&rows, out, format, SS_KIND_SPECTRUM, err);
    if (st != SS_OK)
        return st;
    ss_rows_notes(&rows, head, own);
    ss_rows_note(&rows, "resolution: %s Hz", ss_number_text(resolution, spectrum[0]->resolution));
    ss_rows_note(&rows, "segments: %zu", spectrum[0]->segments);
    write_row(&rows, spectrum, 0, head->column, column, n);          /* the names */
    for (size_t k = 0; k < spectrum[0]->n; k++)
        write_row(&rows, spectrum, k, head->column, column, n);
    return ss_rows_finish(&rows, err);
}
