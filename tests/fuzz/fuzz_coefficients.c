/* fuzz_coefficients.c -- streams of wavelet coefficients. */
#include "fuzz.h"

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    ss_coefficients *c = NULL;
    ss_error err = { 0 };
    FILE *in = fuzz_open(bytes, size);
    ss_status status = ss_coefficients_read(&c, in, "in", &err);
    fclose(in);
    if (status == SS_OK)
        fuzz_check_coefficients(c);
    else
        fuzz_check_refusal(status, &err);
    ss_coefficients_free(c);
    return 0;
}
