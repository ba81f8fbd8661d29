/* fuzz_text.c -- signals in our own text form. */
#include "fuzz.h"

#include <string.h>

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (size >= 11 && memcmp(bytes, "# stickslip signal 1", 11) == 0)
        fuzz_signal(bytes, size, NULL);
    return 0;
}
