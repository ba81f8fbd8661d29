/* summary.h -- the numbers that the transitions of one recording have in common, as notes. */
#ifndef SUMMARY_H
#define SUMMARY_H

#include <stickslip/features.h>
#include "stream/rows.h"

/* Write a note "key: value error" for each number that these features and options have, except the
 * count of transitions.  A median also has the scatter of the events. */
void ss_summary_write(struct rows *rows, const ss_features *f, const ss_features_opts *opts);

#endif
