/* fuzz_wisdom.c -- what FFTW kept of its plans.  The first line, which names version and machine, is
 * put before the input; where the rest is taken, a transform planned by it keeps its accuracy. */
#include "fuzz.h"

#include <fftw3.h>
#include <stdlib.h>
#include <string.h>
#include "map/map.h"

static void
transform(void)
{
    enum { N = 40 };
    static double x[N], *w;
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan = NULL;
    double difference = 1;
    opts.engine = SS_ENGINE_FFT, opts.planner = SS_PLANNER_MEASURE;
    opts.voices = 1, opts.center = 2, opts.dense = 1, opts.force = 1, opts.accuracy = 1e-6;
    for (size_t i = 0; i < N; i++)
        x[i] = (double)(i * i % 7) - 3;
    fuzz_check(ss_morlet_new(&plan, N, 1, &opts, NULL) == SS_OK, "a plan");
    w = malloc(2 * ss_morlet_grid(plan)->total * sizeof *w);
    fuzz_check(w != NULL && ss_morlet_execute(plan, x, w, NULL) == SS_OK, "a transform");
    fuzz_check(ss_morlet_compare(plan, x, w, 5, &difference, NULL) == SS_OK, "a comparison");
    fuzz_check(difference <= opts.accuracy, "accurate");
    ss_morlet_free(plan);
    free(w);
}

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    ss_error err = { 0 };
    char *text = NULL, *none = fftw_export_wisdom_to_string();
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    fuzz_check(out != NULL && none != NULL, "memory");
    fprintf(out, "%.*s\n", (int)strcspn(none, "\n"), none);
    fwrite(bytes, 1, size, out);
    fclose(out);
    FILE *in = fuzz_open(text, length);
    ss_status status = ss_wisdom_read(in, &err);
    fclose(in);
    if (status == SS_OK)
        transform();
    else
        fuzz_check_refusal(status == SS_EINVAL ? SS_EDATA : status, &err);
    fftw_forget_wisdom();
    free(text);
    fftw_free(none);
    return 0;
}
