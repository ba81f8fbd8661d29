/* stickslip/overlay.h -- transitions, maxima, spikes and events to be drawn over contours. */
#ifndef STICKSLIP_OVERLAY_H
#define STICKSLIP_OVERLAY_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* Times on the source's clock [s]. */
typedef struct ss_overlay {
    size_t n_spans, n_maxima, n_spikes;
    double (*span)[2];          /* onset and end of a transition: a bar along the bottom */
    double (*maximum)[2];       /* time and label [Hz] of a local maximum: a ring */
    double *spike;              /* a mark along the top */
} ss_overlay;

/* Read a stream that begins '# stickslip features 1', as ss-features writes it: transitions, their
 * maxima, and spikes of kind jump or kink.  SS_EDATA with file and line; SS_EIO. */
ss_status ss_overlay_read(ss_overlay **out, FILE *in, const char *name, ss_error *err);
void ss_overlay_free(ss_overlay *overlay);      /* NULL is allowed */

/* Read the times [s] of a stream that begins '# stickslip events 1', as ss-sim --events writes it: the
 * first field of every row.  *time, to be freed by free(), has *n of them; it is NULL if n is 0.
 * SS_EDATA with file and line; SS_EIO. */
ss_status ss_event_times_read(double **time, size_t *n, FILE *in, const char *name, ss_error *err);

SS_END_DECLARATIONS
#endif
