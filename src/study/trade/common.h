/* common.h -- declarations that the measurements of a scene and of a transform share. */
#ifndef TRADE_H
#define TRADE_H

#include <stickslip/trade.h>

/* What is compared: "x", "x_rms", ...; NULL behind the last.  Its unit: "dB"; "" of a number or a ratio. */
const char *ss_compared_name(size_t i);
const char *ss_compared_unit(size_t i);

/* 1 if a row keeps all n needs. */
int ss_models_keeps(const ss_models_row *row, const ss_need *need, size_t n);

/* own becomes the caller's options, with defaults for what is missing. */
ss_status ss_trade_opts_take(ss_trade_opts *own, const ss_trade_opts *given, ss_error *err);
/* The CPU time of this thread [s]. */
double ss_trade_cpu_time(void);
/* Run row i, which is measured, or again: only its time counts.  done is the part of the whole work that is
 * done.  *seconds becomes its time; NaN: it was not measured, and is not run again. */
typedef ss_status ss_trade_runner(size_t i, int again, double done, double *seconds, void *user);
/* Run n rows one after the other, then short ones again, in turns, so that a disturbance of the machine affects
 * all of them alike.  *seconds becomes an array of the times, medians of those of short rows. */
ss_status ss_trade_race(double **seconds, size_t n, ss_trade_runner *runner, const ss_progress *progress,
                        void *user);
/* Let the rows of a trade race: they get their times, and those that no other row beats are marked. */
ss_status ss_trade_time(ss_trade *trade, ss_trade_runner *runner, const ss_progress *progress, void *user);
/* *out becomes the trade, or it is freed if the measurement did not succeed.  Returns its status. */
ss_status ss_trade_give(ss_trade **out, ss_trade *trade, ss_status st, ss_error *err);

#endif
