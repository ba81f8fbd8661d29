/* fuzz_hdf5.c -- HDF5 files, through the file image interface: as signals, as the arrays of others,
 * as coefficients. */
#include <stdlib.h>
#include "io/hdf5/groups.h"
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
    h5_file file = { .id = open_image(bytes, size), .path = "in", .err = &err };
    if (file.id < 0)
        return;
    wavelet_reader reader = { .file = &file };
    ss_coefficients *c = calloc(1, sizeof *c);
    ss_status status = c != NULL ? ss_wavelet_reader_open(&reader, &file, c) : SS_ENOMEM;
    double *w = status == SS_OK ? malloc(2 * reader.total * sizeof *w) : NULL;
    for (size_t i = 0; w != NULL && status == SS_OK && i < c->n_scales; i++)
        status = ss_wavelet_reader_scale(&reader, c, i, w + 2 * c->scale[i].offset);
    if (status != SS_OK && status != SS_ENOMEM)
        fuzz_check_refusal(status == SS_EIO ? SS_EDATA : status, &err);
    free(w);
    ss_wavelet_reader_close(&reader);
    ss_coefficients_free(c);
    ss_h5_close(&file);
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
