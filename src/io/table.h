/* table.h -- the cells of a table. */
#ifndef TABLE_H
#define TABLE_H

#include <stickslip/table.h>
/* The index of the column of this name; -1 if there is none. */
int ss_table_column(const ss_table *table, const char *name);
/* The number in a cell; NaN if the cell holds a word or "-", or if there is no such cell. */
double ss_table_number(const ss_table *table, size_t row, size_t column);

#endif
