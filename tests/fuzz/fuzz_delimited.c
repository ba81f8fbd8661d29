/* fuzz_delimited.c -- tables of data-acquisition systems and arrays of NumPy, their clock found, named and
 * given, gaps refused and filled, uneven stamps too; one of several tables, a span of it, a factor. */
#include "fuzz.h"
#include "../read_opts.h"

#include <string.h>

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const ss_calibration first = { "1", 1e3, "N" };
    static const ss_read_opts opts[] = {
        { READ_OPTS, .rate = 0 }, { READ_OPTS, .time = "1" }, { READ_OPTS, .rate = 1000 },
        { READ_OPTS, .gaps = SS_GAPS_INTERPOLATE },
        { READ_OPTS, .gaps = SS_GAPS_SPLIT }, { READ_OPTS, .resample = 100 },
        { READ_OPTS, .table = 2, .time_unit = "ms" },
        { READ_OPTS, .from = 0.1, .to = 1e9, .calibration = &first, .n_calibrations = 1 } };
    if (size < 4 || memcmp(bytes, ".snd", 4) == 0)
        return 0;
    for (size_t i = 0; i < sizeof opts / sizeof *opts; i++)
        fuzz_signal(bytes, size, &opts[i]);
    return 0;
}
