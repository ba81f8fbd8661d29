/* stickslip/overlay.h -- transitions, maxima, spikes and events that are drawn over contours. */
#ifndef STICKSLIP_OVERLAY_H
#define STICKSLIP_OVERLAY_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* Times are on the source's clock [s]. */
typedef struct ss_overlay {
    size_t n_spans, n_maxima, n_spikes;
    double (*span)[2];          /* onset and end of a transition, drawn as a bar at the bottom */
    double (*maximum)[2];       /* time and label [Hz] of a local maximum, drawn as a ring */
    double *spike;              /* time of a spike, drawn as a mark at the top */
} ss_overlay;

/* Read text that begins '# stickslip features 1' (ss_features_write): transitions, their maxima,
 * and spikes of kind jump or kink.  Messages call the file by name.  SS_EDATA: err names file and
 * line; SS_EIO. */
ss_status ss_overlay_read(ss_overlay **out, FILE *in, const char *name, ss_error *err);
void ss_overlay_free(ss_overlay *overlay);      /* NULL is allowed */

/* Read the times [s] of text that begins '# stickslip events 1' (ss_event_writer): the first field
 * of every row.  The caller frees *time, of *n values, with free(); it is NULL if *n is 0.  Errors
 * as above. */
ss_status ss_event_times_read(double **time, size_t *n, FILE *in, const char *name, ss_error *err);

SS_END_DECLARATIONS
#endif
