/* grid.h -- the grid of a sweep, and its options with defaults for what is missing. */
#ifndef GRID_H
#define GRID_H

#include <stickslip/sweep.h>

/* own and steady, to which it points then, become the caller's options. */
ss_status ss_sweep_opts_take(ss_sweep_opts *own, ss_steady_opts *steady, const ss_sweep_opts *given,
                             ss_error *err);
/* The number of points in the grid; SS_EINVAL if there are none or too many. */
ss_status ss_sweep_points(const ss_sweep_opts *opts, size_t *n, ss_error *err);
/* The values of the axes at this point of the grid, whose last axis varies fastest. */
void ss_sweep_values(const ss_sweep_opts *opts, size_t index, double value[]);

/* SS_EINVAL if these, which are complete, are impossible for the scene: it lacks a measure, or one is out of its
 * range. */
ss_status ss_steady_check(const ss_steady_opts *opts, const ss_scene *scene, ss_error *err);

#endif
