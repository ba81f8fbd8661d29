/* gaps.h -- which samples of a record stand in for missing ones. */
#ifndef GAPS_H
#define GAPS_H

#include <stickslip/signal.h>

/* The gaps that head notes, of a record of so many rows: [s] from its first sample, in whole
 * samples and within it.  *out is to be freed. */
ss_status ss_gaps_of(ss_span **out, size_t *n, const ss_header *head, size_t rows);

/* The samples [*first, *end) of a gap from ss_gaps_of. */
void ss_gap_rows(const ss_span *gap, double rate, size_t *first, size_t *end);

/* Put the line between its neighbours, or the value of the only one, in place of each gap's samples
 * in x, of n. */
void ss_gaps_bridge(double *x, size_t n, double rate, const ss_span *gap, size_t n_gaps);

/* 1 for each sample of the signal that lies in a gap; to be freed.  NULL where there are none. */
ss_status ss_gaps_missing(char **out, const ss_signal *signal);

#endif
