/* calibration.h -- factors and units that a caller gives to columns. */
#ifndef CALIBRATION_H
#define CALIBRATION_H

#include <stddef.h>
#include <stdint.h>
#include <stickslip/signal.h>

/* Give the columns of head the units of opts, and a note of it; *factor gets a factor for each, to be
 * freed, or NULL where none is asked for.  SS_EINVAL: no such column. */
ss_status ss_calibrate_header(ss_header *head, const ss_read_opts *opts, const char *name, double **factor,
                              ss_error *err);
/* Multiply n rows of values, a row apart, that begin with row first; SS_ERANGE: a product is not
 * finite. */
ss_status ss_calibrate_rows(double *rows, size_t n, size_t columns, size_t row, size_t column,
                            const double *factor, const char *name, ss_error *err);

/* The rows [*first, *end) that opts ask for of a signal with this header, whose start then is
 * theirs; all if they ask for none. */
void ss_select_rows(ss_header *head, const ss_read_opts *opts, uint64_t *first, uint64_t *end);
/* Fail because no row lies between from and to. */
ss_status ss_fail_no_rows(const char *name, double from, double to, ss_error *err);

#endif
