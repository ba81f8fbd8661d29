/* resample.h -- bring rows at time stamps of any spacing to a uniform clock. */
#ifndef RESAMPLE_H
#define RESAMPLE_H

#include <stddef.h>
#include <stickslip/signal.h>

/* At most max rows: their stamps, each later than the one before, and values, of which NaN are skipped; *n = 0:
 * there are no more. */
typedef ss_status stamped_rows(void *source, double *stamp, double *const column[], size_t max, size_t *n,
                               ss_error *err);

/* Rows at stamps of any spacing, as they come, to rows from the first stamp on at this rate [Hz].  Samples
 * between stamps more than longest [s] apart, or beyond a column's own first and last, are NaN. */
typedef struct resampler resampler;
ss_status ss_resampler_new(resampler **out, const char *name, size_t columns, double rate, double longest,
                           stamped_rows *next, void *source, ss_error *err);
/* As ss_reader_rows.  SS_EDATA: there is but one row; SS_ERANGE: a value is not finite. */
ss_status ss_resampler_rows(resampler *r, double *const column[], size_t max, size_t *n, ss_error *err);
void ss_resampler_free(resampler *r);           /* NULL is allowed */

/* The first sample in which there is no value, if stamps end at one and go on at another, or a negative
 * number; both count from the first stamp. */
double ss_resample_gap(double end, double next, double rate);
/* The number of samples from the first stamp to the last, which may be more than an integer holds. */
double ss_resample_count(double first, double last, double rate);

#endif
