/* common.h -- declarations that the measurements of a scene and of a transform share. */
#ifndef TRADE_H
#define TRADE_H

#include <stickslip/trade.h>

/* The unit of what is compared: "dB"; "" if it is a number or a ratio. */
const char *ss_compared_unit(size_t i);

/* The CPU time of this thread [s]. */
double ss_trade_cpu_time(void);
/* Measure the times of short rows again, in turns.  again runs a row and gives its seconds; done
 * is the part of the whole work that is done. */
typedef ss_status ss_trade_again(void *user, const ss_trade_row *row, double done, double *seconds);
ss_status ss_trade_repeat(ss_trade *trade, ss_trade_again *again, void *user);
void ss_trade_mark_frontier(ss_trade *trade);

#endif
