/* gaps.h -- missing samples, and the values that replace them. */
#ifndef GAPS_H
#define GAPS_H

#include <stddef.h>
#include <stickslip/signal.h>

/* Replace NaN by numbers in n rows, and note their times in head.  Value c of row i is
 * x[i * row + c * column]. */
ss_status ss_fill_gaps(double *x, size_t n, size_t row, size_t column, ss_header *head, ss_gaps how,
                       const char *name, ss_error *err);

/* The gaps of a record of so many rows, which head notes, in seconds from its first sample.  Each
 * is a whole number of samples and lies within the record.  *out is to be freed. */
ss_status ss_gaps_of(ss_span **out, size_t *n, const ss_header *head, size_t rows);

/* The samples *first ... *end - 1 of a gap from ss_gaps_of. */
void ss_gap_rows(const ss_span *gap, double rate, size_t *first, size_t *end);

/* Replace the samples in gaps, of the n samples of x, by a line between the neighbours of the gap,
 * or by the only neighbour. */
void ss_gaps_bridge(double *x, size_t n, double rate, const ss_span *gap, size_t n_gaps);

/* 1 for each sample of the signal that lies in a gap; to be freed.  NULL: no gaps. */
ss_status ss_gaps_missing(char **out, const ss_signal *signal);

#endif
