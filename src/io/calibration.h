/* calibration.h -- factors and units that a caller gives to columns. */
#ifndef CALIBRATION_H
#define CALIBRATION_H

#include <stddef.h>
#include <stdint.h>
#include <stickslip/signal.h>

/* Give the columns of head the units in opts, and a note that says so.  *factor becomes an array
 * of a factor for each column, to be freed, or NULL if opts have no factor.  SS_EINVAL: there is
 * no such column. */
ss_status ss_calibrate_header(ss_header *head, const ss_read_opts *opts, const char *name, double **factor,
                              ss_error *err);
/* Multiply n rows.  SS_ERANGE: a product is not finite. */
ss_status ss_calibrate(double *const column[], size_t n, size_t columns, const double *factor, const char *name,
                       ss_error *err);

/* Find the rows *first ... *end - 1 that opts select of a signal with this header, all by default;
 * the start of the header becomes that of the first. */
void ss_select_rows(ss_header *head, const ss_read_opts *opts, uint64_t *first, uint64_t *end);
/* Report that no row lies between from and to. */
ss_status ss_fail_no_rows(const char *name, double from, double to, ss_error *err);

#endif
