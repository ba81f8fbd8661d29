/* pull.h -- scenes that are pulled, and a record of the force of the spring. */
#ifndef PULL_H
#define PULL_H

#include <stickslip/rank.h>

/* SS_OK for a scene that is pulled and a column of the force of its spring. */
ss_status ss_pull_check(const ss_signal *signal, size_t column, const ss_scene *scene,
                        const ss_rank_opts *opts, ss_error *err);

/* Rank r->n scenes: fill r's rows in the order of their totals, the scene that is named first, its noise and
 * its verdict. */
ss_status ss_pull_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                          const ss_rank_opts *opts, ss_error *err);

#endif
