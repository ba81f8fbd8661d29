/* observation.h -- numbers from the features, spikes and contours of a signal, and the distance of two
 * signals by them. */
#ifndef OBSERVATION_H
#define OBSERVATION_H

#include <stickslip/morlet.h>
#include <stickslip/rank.h>

typedef struct observation {
    double value[SS_CRITERIA];          /* NaN where there is none */
    int countable;                      /* spikes can be counted */
    int has_slope;                      /* there are columns for df/dx */
    ss_coefficients *map;
} observation;

/* Observe a column whose motion repeats after period [s].  To be freed if that is SS_OK. */
ss_status ss_observation_of(observation *l, const ss_signal *signal, size_t column, double period,
                            ss_error *err);
void ss_observation_free(observation *l);
/* Write the model's values to the row, and their distances from the signal's. */
void ss_observation_compare(ss_rank_row *row, const observation *signal, const observation *model);

#endif
