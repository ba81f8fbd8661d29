/* held.c -- read the rows of a signal that is in memory. */
#include <string.h>
#include "io/reader.h"

void
ss_reader_give(ss_reader *reader, double *rows, size_t max, size_t *n)
{
    size_t columns = reader->head->n_columns, left = reader->n_rows - reader->next;
    *n = left < max ? left : max;
    memcpy(rows, reader->values + reader->next * columns, *n * columns * sizeof *rows);
    reader->next += *n;
    reader->row += *n;
}
