/* kind.h -- the names of events. */
#ifndef KIND_H
#define KIND_H

#include <stickslip/sim.h>

const char *ss_event_kind_name(ss_event_kind kind);     /* "stick", "slip", "reverse" */

#endif
