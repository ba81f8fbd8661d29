/* fuzz_hdf5.c -- HDF5 files, as signals, as the arrays of others, as coefficients. */
#include <stdlib.h>
#include <unistd.h>
#include "io/hdf5/h5.h"
#include "io/format.h"
#include "fuzz.h"
#include "../read_opts.h"

static char path[] = "/tmp/fuzz_hdf5.XXXXXX";
static FILE *file;

static void
remove_file(void)
{
    unlink(path);
}

/* Make the file of these bytes. */
static void
write_file(const uint8_t *bytes, size_t size)
{
    if (file == NULL) {
        int fd = mkstemp(path);
        fuzz_check(fd >= 0 && (file = fdopen(fd, "w")) != NULL, "a temporary file");
        atexit(remove_file);
    }
    rewind(file);
    fwrite(bytes, 1, size, file);
    fuzz_check(fflush(file) == 0 && ftruncate(fileno(file), (off_t)size) == 0, "a temporary file is written");
}

static void
read_signal(const char *dataset, const ss_read_opts *opts)
{
    ss_source *rows = NULL;
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    ss_status status = ss_h5_open_signal(&rows, path, dataset, opts, &err);
    if (status == SS_OK)
        status = ss_source_adjust(&rows, opts, &err);
    if (status == SS_OK)
        status = ss_source_all(&signal, rows, &err);
    if (status == SS_OK)
        fuzz_check_signal(signal);
    else if (status != SS_ENOMEM)
        fuzz_check_refusal(status == SS_EIO ? SS_EDATA : status, &err);
    ss_signal_free(signal);
    ss_source_free(rows);
}

static void
read_coefficients(void)
{
    ss_error err = { 0 };
    ss_coefficients *c = NULL;
    ss_status status = ss_h5_open_coefficients(&c, path, &err);
    for (size_t i = 0; status == SS_OK && i < c->n_scales; i++) {
        size_t n = c->scale[i].n;
        double *w = malloc(2 * n * sizeof *w);
        status = w != NULL ? ss_map_read(c, &(ss_map_part){ i, 0, n, w, NULL }, 1, &err) : SS_ENOMEM;
        free(w);
    }
    if (status != SS_OK && status != SS_ENOMEM)
        fuzz_check_refusal(status == SS_EIO ? SS_EDATA : status, &err);
    ss_coefficients_free(c);
}

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const ss_read_opts opts = { READ_OPTS, .rate = 1000, .gaps = SS_GAPS_SPLIT }, none = { READ_OPTS },
        timed = { READ_OPTS, .time = "t" };
    if (size == 0)
        return 0;
    write_file(bytes, size);
    H5E_BEGIN_TRY {
        read_signal(NULL, &none);
        read_signal("/y", &opts);
        read_signal("/signal/a", &none);
        read_signal("/signal/a", &timed);
        read_coefficients();
    } H5E_END_TRY
    return 0;
}
