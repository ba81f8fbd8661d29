/* coefficient_rows.h -- what readers and writers of coefficients share. */
#ifndef ROWS_H
#define ROWS_H

#define COEFFICIENTS_MAGIC "# stickslip coefficients 1"
enum { COEFFICIENT_COLUMNS = 7 };       /* m a/s b/s f/Hz re im edge */

#endif
