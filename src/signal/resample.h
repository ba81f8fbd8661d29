/* resample.h -- bring rows at time stamps of any spacing to a uniform clock. */
#ifndef RESAMPLE_H
#define RESAMPLE_H

#include <stddef.h>
#include <stickslip/signal.h>

/* Bring n >= 2 rows, of so many columns, at the stamps t to *n_out rows at this rate, from t[0]
 * on; *out is to be freed.  NaN in the input are skipped.  A sample is NaN if it lies between
 * stamps that are more than ten median steps apart, or beyond the first or last number of its
 * column. */
ss_status ss_resample(double **out, size_t *n_out, const double *t, const double *value, size_t n,
                      size_t columns, double usual_step, double rate, const char *name,
                      ss_error *err);

#endif
