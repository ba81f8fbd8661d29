/* fuzz_delimited.c -- tables of data-acquisition systems, their clock found, named and given, gaps
 * refused and filled, uneven stamps too. */
#include "fuzz.h"

#include <string.h>

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const ss_read_opts opts[] = {
        { .rate = 0 }, { .time = "1" }, { .rate = 1000 }, { .gaps = SS_GAPS_INTERPOLATE },
        { .gaps = SS_GAPS_SPLIT }, { .resample = 100 } };
    if (size < 4 || memcmp(bytes, ".snd", 4) == 0)
        return 0;
    for (size_t i = 0; i < sizeof opts / sizeof *opts; i++)
        fuzz_signal(bytes, size, &opts[i]);
    return 0;
}
