/* common.h -- declarations that the measurements of a scene and of a transform share. */
#ifndef TRADE_H
#define TRADE_H

#include <stickslip/trade.h>

/* The unit of what is compared: "dB"; "" if it is a number or a ratio. */
const char *ss_compared_unit(size_t i);

/* 1 if a row keeps all n needs. */
int ss_models_keeps(const ss_models_row *row, const ss_need *need, size_t n);
/* The cheapest row that keeps the needs; among rows whose times differ by less than a fifth, the
 * simplest scene.  The settled state is left out: it is the same model. */
const ss_models_row *ss_models_cheapest(const ss_models *models, const ss_need *need, size_t n);

/* own becomes the caller's options, with defaults for what is missing. */
ss_status ss_trade_opts_take(ss_trade_opts *own, const ss_trade_opts *given, ss_error *err);
/* The CPU time of this thread [s]. */
double ss_trade_cpu_time(void);
/* Measure the times of short rows again, in turns.  again runs a row and gives its seconds; done
 * is the part of the whole work that is done. */
typedef ss_status ss_trade_again(void *user, const ss_trade_row *row, double done, double *seconds);
ss_status ss_trade_repeat(ss_trade *trade, ss_trade_again *again, void *user);
void ss_trade_mark_frontier(ss_trade *trade);

#endif
