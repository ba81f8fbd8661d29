/* fuzz_au.c -- Sun AU, ours and that of others. */
#include "fuzz.h"

#include <string.h>

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (size >= 4 && memcmp(bytes, ".snd", 4) == 0)
        fuzz_signal(bytes, size, NULL);
    return 0;
}
