/* order.h -- the rows of a ranking: how scenes that are forced fill them, and their order. */
#ifndef ORDER_H
#define ORDER_H

#include <stickslip/rank.h>

/* Find the totals of the rows, and sort these by them. */
void ss_ranking_sort(ss_ranking *r);

/* forced_rank.c: rank r->n scenes whose base moves. */
ss_status ss_forced_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                            const ss_rank_opts *opts, ss_error *err);

#endif
