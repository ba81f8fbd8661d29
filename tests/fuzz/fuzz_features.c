/* fuzz_features.c -- features as overlays of a plot. */
#include "fuzz.h"

#include <math.h>

static void
check_pairs(double (*pair)[2], size_t n)
{
    for (size_t i = 0; i < n; i++)
        fuzz_check(isfinite(pair[i][0]) && isfinite(pair[i][1]), "finite pairs");
}

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    ss_overlay *overlay = NULL;
    ss_error err = { 0 };
    FILE *in = fuzz_open(bytes, size);
    ss_status status = ss_overlay_read(&overlay, in, "in", SS_KIND_FEATURES, &err);
    fclose(in);
    if (status != SS_OK) {
        fuzz_check_refusal(status, &err);
        return 0;
    }
    check_pairs(overlay->span, overlay->n_spans);
    check_pairs(overlay->maximum, overlay->n_maxima);
    for (size_t i = 0; i < overlay->n_spikes; i++)
        fuzz_check(isfinite(overlay->spike[i]), "times of spikes");
    ss_overlay_free(overlay);
    return 0;
}
