/* common.h -- declarations that the measurements of a scene and of a transform share. */
#ifndef TRADE_H
#define TRADE_H

#include <stickslip/trade.h>

/* [s] of this thread. */
double ss_trade_cpu_time(void);
/* Time the short rows that are measured again, in turns; each is run by again, which gives its
 * seconds, done being the share of the whole that is done. */
typedef ss_status ss_trade_again(void *user, const ss_trade_row *row, double done, double *seconds);
ss_status ss_trade_repeat(ss_trade *trade, ss_trade_again *again, void *user);
void ss_trade_mark_frontier(ss_trade *trade);

#endif
