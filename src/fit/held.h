/* held.h -- the terms that a match holds: would the record have them otherwise? */
#ifndef HELD_H
#define HELD_H

#include <stickslip/status.h>
#include "fit/candidate.h"
#include "fit/match.h"
#include "fit/record.h"

/* The damping of the mass and f_s / f_k, which are the scene's, and the lag of a sensor of first order (or its
 * opposite), which is none. */
typedef enum held_term { HELD_DAMPING, HELD_STATIC, HELD_LAG, HELD_TERMS } held_term;

typedef struct held {
    double gain;                /* by how many times the variance left, at least MATCH_QUIET of the power,
                                   the sum of squares would be less if the match adjusted the term too */
    double nearer;              /* the damping [N s/m] or f_s / f_k that it would find; NaN for the lag */
} held;

/* Find the gain of each term by the slopes at the end of a match, in which at least one key of the candidate was
 * held.  If the motion of the match cannot be run, each gain is 0.  SS_ENOMEM. */
ss_status ss_held_gains(held of[HELD_TERMS], const candidate *c, const match *m, const rank_record *record);

#endif
