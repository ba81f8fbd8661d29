/* fuzz_events.c -- times of events as overlays of a plot. */
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    double *time = NULL;
    size_t n = 0;
    ss_error err = { 0 };
    FILE *in = fuzz_open(bytes, size);
    ss_status status = ss_event_times_read(&time, &n, in, "in", &err);
    fclose(in);
    if (status != SS_OK)
        fuzz_check_refusal(status, &err);
    for (size_t i = 0; i < n; i++)
        fuzz_check(isfinite(time[i]), "finite times");
    free(time);
    return 0;
}
