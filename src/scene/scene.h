/* scene.h -- what the library and its tests ask of scenes beside the public functions. */
#ifndef SCENE_H
#define SCENE_H

#include <stickslip/scene.h>

const ss_model *ss_model_at(size_t i);              /* NULL after the last */
/* Make z(t) [m], the natural cubic spline through one column of a signal.  The signal's clock is
 * the scene's: its t = 0 is the start of settling.  The caller frees *base with ss_base_free.
 * SS_EDATA: the column's unit is not m, or it has fewer than 3 samples; SS_ENOMEM. */
ss_status ss_base_new(ss_base **base, const ss_signal *signal, size_t column, ss_error *err);
const char *ss_event_kind_name(ss_event_kind kind);     /* "stick", "slip", "reverse" */

#endif
