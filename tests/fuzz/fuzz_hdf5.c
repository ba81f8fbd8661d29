/* fuzz_hdf5.c -- HDF5 files, through the file image interface: as signals, as the arrays of others,
 * as coefficients. */
#include <stdlib.h>
#include "store/groups.h"
#include "fuzz.h"

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

/* As if the file were opened again. */
static void
begin(h5_file *file)
{
    h5_file again = { .id = -1, .path = file->path, .err = file->err, .seen = file->seen };
    ss_h5_close(&again);
    again.id = file->id;
    *file = again;
    file->err->text[0] = '\0';
}

static void
read_signal(h5_file *file, const char *dataset, const ss_read_opts *opts)
{
    ss_signal *signal = NULL;
    begin(file);
    ss_status status = ss_h5_read_signal(&signal, file, dataset, opts);
    if (status == SS_OK)
        fuzz_check_signal(signal);
    else if (status != SS_ENOMEM)
        fuzz_check_refusal(status == SS_EIO ? SS_EDATA : status, file->err);
    ss_signal_free(signal);
}

static void
read_coefficients(h5_file *file)
{
    wavelet_reader reader = { .file = file };
    begin(file);
    ss_status status = ss_wavelet_reader_open(&reader, file);
    const ss_coefficients *c = reader.grid;
    double *w = status == SS_OK ? malloc(2 * reader.total * sizeof *w) : NULL;
    for (size_t i = 0; w != NULL && status == SS_OK && i < c->n_scales; i++)
        status = ss_wavelet_reader_scale(&reader, i, w + 2 * c->scale[i].offset);
    if (status != SS_OK && status != SS_ENOMEM)
        fuzz_check_refusal(status == SS_EIO ? SS_EDATA : status, file->err);
    free(w);
    ss_wavelet_reader_close(&reader);
}

int
LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const ss_read_opts opts = { .rate = 1000, .gaps = SS_GAPS_SPLIT };
    ss_error err = { 0 };
    h5_file file = { .id = -1, .path = "in", .err = &err };
    if (size == 0)
        return 0;
    H5E_BEGIN_TRY {
        file.id = open_image(bytes, size);
        if (file.id >= 0) {
            read_signal(&file, NULL, NULL);
            read_signal(&file, "/y", &opts);
            read_signal(&file, "/signal/a", NULL);
            read_coefficients(&file);
            ss_h5_close(&file);
        }
    } H5E_END_TRY
    return 0;
}
