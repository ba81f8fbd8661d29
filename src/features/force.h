/* force.h -- the slips of a force, read from the force itself. */
#ifndef FORCE_H
#define FORCE_H

#include "features/search.h"

/* The transitions of the signal in s, if it is a force whose slips are its falls or its reversals,
 * into s->out.  *decided: 1 where nothing else needs to be looked for: they are found, or s->out->why
 * says that they cannot be. */
ss_status ss_force_find(search *s, int *decided);

#endif
