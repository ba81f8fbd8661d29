/* resample.h -- bring rows at time stamps of any spacing to a uniform clock. */
#ifndef RESAMPLE_H
#define RESAMPLE_H

#include <stddef.h>
#include <stickslip/signal.h>

/* Rows of columns values each at the stamps t, n >= 2 of them, to n_out rows, to be freed, from t[0]
 * on at this rate.  NaN in them are skipped; samples between stamps more than ten median steps
 * apart, or beyond a column's own first and last, are NaN. */
ss_status ss_resample(double **out, size_t *n_out, const double *t, const double *value, size_t n,
                      size_t columns, double usual_step, double rate, const char *name,
                      ss_error *err);

#endif
