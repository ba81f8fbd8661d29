/* gaps.h -- missing samples, and the values that replace them. */
#ifndef GAPS_H
#define GAPS_H

#include <stddef.h>
#include <stickslip/signal.h>

/* Replaces NaN by numbers in columns of rows that are read twice: all rows are added; begin notes the times in head, or refuses a column without numbers; then all are filled.  Memory
 * grows with the gaps.  NULL, 0: no memory. */
typedef struct gap_filler gap_filler;
gap_filler *ss_gaps_new(size_t n_columns, ss_gaps how);
int ss_gaps_add(gap_filler *g, double *const column[], size_t n);
ss_status ss_gaps_begin(gap_filler *g, ss_header *head, const char *name, ss_error *err);
/* 0: a value is missing that was there when the rows were added. */
int ss_gaps_fill(gap_filler *g, double *const column[], size_t n);
/* Fill from the first row on again. */
void ss_gaps_rewind(gap_filler *g);
void ss_gaps_free(gap_filler *g);               /* NULL is allowed */

/* SS_EDATA: the note of the gaps is not what ss_header_gaps reads. */
ss_status ss_header_check_gaps(const ss_header *head);

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
