/* forced.h -- rank scenes whose base moves. */
#ifndef FORCED_H
#define FORCED_H

#include <stickslip/rank.h>

/* Sort r's rows, which are in the order of the r->n scenes, and fill them and the verdict; rows stay as they
 * are if nothing in the signal repeats. */
ss_status ss_forced_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                            const ss_rank_opts *opts, ss_error *err);

#endif
