/* pull.h -- rank scenes of pulled sliders by the slips in the force of the spring. */
#ifndef PULL_H
#define PULL_H

#include <stickslip/rank.h>

/* Fill r's rows, in the order of the r->n scenes, its noise and its verdict, but no totals.  *named is
 * the scene that the verdict names; r->n: none. */
ss_status ss_pull_compare(ss_ranking *r, size_t *named, const ss_signal *signal, size_t column,
                          const ss_scene *scene, const ss_rank_opts *opts, ss_error *err);

#endif
