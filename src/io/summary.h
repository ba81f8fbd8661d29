/* summary.h -- the numbers that the transitions of one recording have in common, as notes. */
#ifndef SUMMARY_H
#define SUMMARY_H

#include <stickslip/features.h>
#include "io/rows.h"

/* Write a note "key: value error" for each number that these features and options have, except the
 * count of transitions.  A median also has the scatter of the events. */
void ss_summary_write(struct rows *rows, const ss_features *f, const ss_features_opts *opts);

/* For forms without notes: a column all_KEY and all_KEY_error for each of these numbers, and their cells,
 * which are the same in each row. */
void ss_summary_columns(struct rows *rows, const ss_features *f, const ss_features_opts *opts);
void ss_summary_cells(struct rows *rows, const ss_features *f, const ss_features_opts *opts);

#endif
