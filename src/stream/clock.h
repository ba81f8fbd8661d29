/* clock.h -- from time stamps to a uniform clock. */
#ifndef CLOCK_H
#define CLOCK_H

#include <stddef.h>
#include <stickslip/signal.h>

/* Time stamps t of n rows, of which row i stands in line line[i]: a uniform clock?  sample gets the
 * number of each row's sample, from 0: its own, unless gaps are allowed. */
ss_status ss_find_clock(const char *file, const double *t, const unsigned long *line, size_t n,
                        int gaps, size_t *sample, double *rate, ss_error *err);
/* The median step of stamps, which must ascend. */
ss_status ss_usual_step(const char *file, const double *t, const unsigned long *line, size_t n,
                        double *usual, ss_error *err);

/* Refuse options for input without a clock, as this one has one of its own rate. */
ss_status ss_refuse_clock(const char *name, double own, const ss_read_opts *opts, ss_error *err);
/* Refuse a clock so fast or slow that its times might not be finite: SS_EDATA. */
ss_status ss_refuse_range(const char *name, double rate, double start, ss_error *err);

#endif
