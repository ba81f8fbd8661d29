/* fuzz_delimited.c -- tables of data-acquisition systems, their clock found, named and given. */
#include "fuzz.h"

#include <string.h>

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const ss_read_opts opts[] = { { NULL, 0 }, { "1", 0 }, { NULL, 1000 } };
    if (size < 4 || memcmp(bytes, ".snd", 4) == 0)
        return 0;
    for (size_t i = 0; i < sizeof opts / sizeof *opts; i++)
        fuzz_signal(bytes, size, &opts[i]);
    return 0;
}
