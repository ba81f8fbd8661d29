/* clock.h -- from time stamps to a uniform clock. */
#ifndef CLOCK_H
#define CLOCK_H

#include <stddef.h>
#include <stickslip/signal.h>

/* Find the uniform clock of n time stamps t; row i stands in line line[i].  sample[i] becomes the number
 * of row i's sample, from 0, which is i unless gaps are allowed. */
ss_status ss_find_clock(const char *file, const double *t, const unsigned long *line, size_t n,
                        int gaps, size_t *sample, double *rate, ss_error *err);
/* The median step of stamps, which must ascend. */
ss_status ss_usual_step(const char *file, const double *t, const unsigned long *line, size_t n,
                        double *usual, ss_error *err);

/* Refuse options that are for input without a clock, as this input has a rate of its own. */
ss_status ss_refuse_clock(const char *name, double own, const ss_read_opts *opts, ss_error *err);
/* Refuse a clock so fast or slow that its times might not be finite: SS_EDATA. */
ss_status ss_refuse_range(const char *name, double rate, double start, ss_error *err);

#endif
