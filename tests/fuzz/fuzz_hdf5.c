/* fuzz_hdf5.c -- HDF5 files, through the file image interface: as signals, as the arrays of others,
 * as coefficients. */
#include <stdlib.h>
#include "io/hdf5/h5.h"
#include "io/reader.h"
#include "fuzz.h"
#include "../read_opts.h"

static hid_t
open_image(const uint8_t *bytes, size_t size)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    H5Pset_fapl_core(access, 65536, 0);
    H5Pset_file_image(access, (void *)bytes, size);
    hid_t id = H5Fopen("in", H5F_ACC_RDONLY, access);
    H5Pclose(access);
    return id;
}

static void
read_signal(const uint8_t *bytes, size_t size, const char *dataset, const ss_read_opts *opts)
{
    ss_source *rows = NULL;
    ss_signal *signal = NULL;
    ss_error err = { 0 };
    hid_t id = open_image(bytes, size);
    if (id < 0)
        return;
    ss_status status = ss_h5_begin_signal(&rows, id, "in", dataset, opts, &err);
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
read_coefficients(const uint8_t *bytes, size_t size)
{
    ss_error err = { 0 };
    ss_coefficients *c = NULL;
    hid_t id = open_image(bytes, size);
    if (id < 0)
        return;
    ss_status status = ss_h5_begin_coefficients(&c, id, "in", &err);
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
    H5E_BEGIN_TRY {
        read_signal(bytes, size, NULL, &none);
        read_signal(bytes, size, "/y", &opts);
        read_signal(bytes, size, "/signal/a", &none);
        read_signal(bytes, size, "/signal/a", &timed);
        read_coefficients(bytes, size);
    } H5E_END_TRY
    return 0;
}
