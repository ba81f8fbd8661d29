/* pull.h -- a pulled slider and the slips in the force of its spring: what a fit and a ranking share. */
#ifndef PULL_H
#define PULL_H

#include <stickslip/rank.h>
#include "fit/falls.h"
#include "fit/match.h"

enum { PULL_FEWEST = 5 };       /* slips whose median and scatter are given */

/* SS_OK for a scene that is pulled and a column of the force of its spring. */
ss_status ss_pull_check(const ss_signal *signal, size_t column, const ss_scene *scene,
                        const ss_rank_opts *opts, ss_error *err);
/* 1 if the falls cannot be read, or are too few, and `why` (of this room) says so; else 0. */
int ss_pull_lacks_falls(char *why, size_t room, const ss_features *f, const ss_signal *signal, size_t column,
                        const ss_scene *scene);
/* What a fit leaves of the samples of the falls. */
match ss_pull_match(const falls *r, const falls_fit *fit);
/* The name of a key of a fit in scenes. */
const char *ss_pull_key_name(const ss_scene *scene, const falls_key *key);

/* Fill r's rows, in the order of the r->n scenes, its noise and its verdict, but no totals.  *named is
 * the scene that the verdict names; r->n: none. */
ss_status ss_pull_compare(ss_ranking *r, size_t *named, const ss_signal *signal, size_t column,
                          const ss_scene *scene, const ss_rank_opts *opts, ss_error *err);

#endif
