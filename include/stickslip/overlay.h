/* stickslip/overlay.h -- transitions, maxima, spikes and events that are drawn over contours. */
#ifndef STICKSLIP_OVERLAY_H
#define STICKSLIP_OVERLAY_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* Times are on the source's clock [s]. */
typedef struct ss_overlay {
    size_t n_spans, n_maxima, n_spikes, n_events;
    double (*span)[2];          /* onset and end of a transition, drawn as a bar at the bottom */
    double (*maximum)[2];       /* time and label [Hz] of a local maximum, drawn as a ring */
    double *spike;              /* time of a spike, drawn as a mark at the top */
    double *event;              /* time of an event, drawn as a line */
} ss_overlay;

/* Read text of this kind, features or events: transitions, their maxima and spikes of kind jump or
 * kink; or the first field of every row, the time of an event.  Messages call the file by name.
 * SS_EINVAL: another kind; SS_EKIND: the text is of another kind; SS_EDATA: err names file and line;
 * SS_EIO. */
ss_status ss_overlay_read(ss_overlay **out, FILE *in, const char *name, ss_kind kind, ss_error *err);
void ss_overlay_free(ss_overlay *overlay);      /* NULL is allowed */

SS_END_DECLARATIONS
#endif
