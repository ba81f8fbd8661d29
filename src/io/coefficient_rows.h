/* coefficient_rows.h -- declarations that readers and writers of coefficients share. */
#ifndef COEFFICIENT_ROWS_H
#define COEFFICIENT_ROWS_H

enum { COEFFICIENT_COLUMNS = 7 };
extern const char *const ss_coefficient_columns[COEFFICIENT_COLUMNS][2];        /* name and unit */

#endif
