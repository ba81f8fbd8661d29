/* coefficient_rows.h -- declarations that readers and writers of coefficients share. */
#ifndef COEFFICIENT_ROWS_H
#define COEFFICIENT_ROWS_H

enum { COEFFICIENT_COLUMNS = 7 };       /* m a/s b/s f/Hz re im edge */

#endif
