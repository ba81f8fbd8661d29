/* spectrum.c -- write spectra as text. */
#include <stickslip/spectrum.h>

#include <math.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/output.h"
#include "io/rows.h"

static void
write_head(struct rows *rows, const ss_spectrum *first, const ss_header *head, const size_t column[], size_t n,
           int decibels)
{
    static const char *const own[] = { "resolution", "segments", NULL };
    char resolution[SS_NUMBER_MAX], unit[DENSITY_UNIT];
    ss_rows_notes(rows, head, own);
    ss_rows_note(rows, "resolution: %s Hz", ss_number_text(resolution, first->resolution));
    ss_rows_note(rows, "segments: %zu", first->segments);
    ss_rows_column(rows, "frequency", "Hz");
    for (size_t i = 0; i < n; i++) {
        ss_density_unit(unit, head->column[column[i]].unit, decibels);
        ss_rows_column(rows, head->column[column[i]].name, unit);
    }
    ss_rows_end(rows);
}

ss_status
ss_spectra_write(ss_spectrum *const spectrum[], const ss_header *head, const size_t column[], size_t n,
                 int decibels, FILE *out, ss_format format, ss_error *err)
{
    struct rows rows;
    if (spectrum == NULL || head == NULL || column == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    if (n == 0 || ss_rows_begin(&rows, out, format, SS_KIND_SPECTRUM) != SS_OK)
        return ss_fail(err, SS_EINVAL, n == 0 ? "no spectra to write" : "this format holds numbers only");
    write_head(&rows, spectrum[0], head, column, n, decibels);
    for (size_t k = 0; k < spectrum[0]->n; k++) {
        ss_rows_number(&rows, (double)k * spectrum[0]->step);
        for (size_t i = 0; i < n; i++) {
            double density = spectrum[i]->density[k];
            ss_rows_number(&rows, !decibels ? density : density > 0 ? 10 * log10(density) : NAN);
        }
        ss_rows_end(&rows);
    }
    return ferror(out) || fflush(out) != 0 ? SS_EIO : SS_OK;
}
