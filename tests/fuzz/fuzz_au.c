/* fuzz_au.c -- sound files: Sun AU, ours and that of others, and WAV. */
#include "fuzz.h"

#include <string.h>

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (size >= 4 && (memcmp(bytes, ".snd", 4) == 0 || memcmp(bytes, "RIFF", 4) == 0))
        fuzz_signal(bytes, size, NULL);
    return 0;
}
