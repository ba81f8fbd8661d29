/* numbers.h -- the numbers that the transitions of one recording have in common, by key. */
#ifndef NUMBERS_H
#define NUMBERS_H

#include <stddef.h>
#include <stickslip/features.h>

/* The recordings that have a number. */
typedef enum number_group {
    ALL, WITH_LOADING, WITH_FRICTION, WITH_FRICTION_OVER_X, WITH_MASS, WITH_X_AND_F
} number_group;

typedef struct feature_number {
    const char *key, *unit;     /* unit NULL: it contains the unit of the column */
    size_t at;                  /* in ss_features: an ss_value, or an ss_median, which begins like one */
    int is_median;              /* over the slips of a loading */
    number_group of;
} feature_number;

/* The first is the number of transitions, a count: `at` means nothing. */
extern const feature_number ss_feature_numbers[SS_SUMMARY_NUMBERS];

#endif
