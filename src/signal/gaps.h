/* gaps.h -- missing samples, and the values that replace them. */
#ifndef GAPS_H
#define GAPS_H

#include <stddef.h>
#include <stickslip/signal.h>
#include "signal/source.h"

/* Wrap a source that gives NaN where a value is missing, and that can go back, in one that gives numbers there:
 * all rows are read, the gaps are noted in its header, and the rows begin anew.  Memory grows with the gaps.
 * SS_EDATA: a column has no numbers, or, later, a value is missing that was there. */
ss_status ss_source_fill_gaps(ss_source **s, ss_gaps how, ss_error *err);

/* Note n gaps as text that ss_header_gaps reads; without gaps the header stays as it is. */
ss_status ss_header_note_gaps(ss_header *head, const ss_span *span, size_t n);
/* SS_EDATA: the note of the gaps is not what ss_header_gaps reads. */
ss_status ss_header_check_gaps(const ss_header *head);

/* 1 if t lies in one of n gaps, which are in time order, or nearer than margin to one; else 0. */
int ss_gaps_near(const ss_span *gap, size_t n, double t, double margin);

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
/* The spans in which samples were missing, in time order, from the note "gaps: from:to from:to
 * ..." in any order.  Each goes from its first missing sample to the next sample that is there;
 * those that overlap are one.  The caller frees *out with free().  SS_EDATA: the note is something
 * else; readers of files refuse it. */
ss_status ss_header_gaps(ss_span **out, size_t *n, const ss_header *head, ss_error *err);

#endif
