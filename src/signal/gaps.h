/* gaps.h -- missing samples, and the values that replace them. */
#ifndef GAPS_H
#define GAPS_H

#include <stddef.h>
#include <stickslip/signal.h>

/* Replace NaN by numbers in n rows, value c of row i at x[i * row + c * column], and note the times
 * in head. */
ss_status ss_fill_gaps(double *x, size_t n, size_t row, size_t column, ss_header *head, ss_gaps how,
                       const char *name, ss_error *err);

/* The gaps that head notes, of a record of so many rows: [s] from its first sample, in whole
 * samples and within it.  *out is to be freed. */
ss_status ss_gaps_of(ss_span **out, size_t *n, const ss_header *head, size_t rows);

/* The samples [*first, *end) of a gap from ss_gaps_of. */
void ss_gap_rows(const ss_span *gap, double rate, size_t *first, size_t *end);

/* Replace each gap's samples in x, of n, by the line between the neighbours of the gap, or by the
 * value of the only neighbour. */
void ss_gaps_bridge(double *x, size_t n, double rate, const ss_span *gap, size_t n_gaps);

/* 1 for each sample of the signal that lies in a gap; to be freed.  NULL: no gaps. */
ss_status ss_gaps_missing(char **out, const ss_signal *signal);

#endif
