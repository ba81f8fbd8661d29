/* fuzz_events.c -- times of events as overlays of a plot. */
#include "fuzz.h"

#include <math.h>

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    ss_overlay *overlay = NULL;
    ss_error err = { 0 };
    FILE *in = fuzz_open(bytes, size);
    ss_status status = ss_overlay_read(&overlay, in, "in", SS_KIND_EVENTS, &err);
    fclose(in);
    if (status != SS_OK) {
        fuzz_check_refusal(status, &err);
        return 0;
    }
    for (size_t i = 0; i < overlay->n_events; i++)
        fuzz_check(isfinite(overlay->event[i]), "finite times");
    ss_overlay_free(overlay);
    return 0;
}
