/* force.h -- the slips of a force, read from the force itself. */
#ifndef FORCE_H
#define FORCE_H

#include "find/search.h"

/* Find the transitions of the signal in s, into s->out, if it is a force whose slips are its falls or its
 * reversals.  *decided becomes 1 if no other search is needed: they are found, or s->out->why says why they
 * cannot be. */
ss_status ss_force_find(search *s, int *decided);

#endif
