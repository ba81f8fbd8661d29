/* order.h -- the order of the rows of a ranking. */
#ifndef ORDER_H
#define ORDER_H

#include <stickslip/rank.h>

/* Find the totals of the rows, and sort these by them. */
void ss_ranking_sort(ss_ranking *r);

#endif
