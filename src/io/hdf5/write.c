/* write.c -- write a record as an HDF5 file, at once or in pieces.
 *
 * If the number of samples and coefficients is not known, all datasets stay open, with chunks so
 * short that one of each fits into memory. */
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/hdf5/groups.h"
#include "io/hdf5/output.h"
#include "io/store.h"

struct ss_store_writer {
    h5_output output;
    h5_pieces pieces;
    ss_status status;           /* the first failure */
    signal_writer signal;
    wavelet_writer wavelet;
};

static ss_status
write_notes(h5_file *file, const ss_header *head)
{
    if (!ss_h5_write_text(file->id, H5_VERSION_NOTE, SS_VERSION))
        return ss_h5_fail_write(file, 0, "/");
    for (size_t i = 0; head != NULL && i < head->n_notes; i++) {
        const char *colon = strstr(head->note[i], ": ");
        size_t length = colon != NULL ? (size_t)(colon - head->note[i]) : strlen(head->note[i]);
        char *key = strndup(head->note[i], length);
        if (key == NULL)
            return SS_ENOMEM;
        int good = H5Aexists(file->id, key) > 0
                   || ss_h5_write_text(file->id, key, colon != NULL ? colon + 2 : "");
        free(key);
        if (!good)
            return ss_h5_fail_write(file, 0, head->note[i]);
    }
    return SS_OK;
}

/* Make the file, write the notes, and keep the clock for the groups that follow. */
static ss_status
begin(ss_store_writer **out, const char *path, const ss_header *head)
{
    ss_store_writer *w = *out = calloc(1, sizeof *w);
    if (w == NULL)
        return SS_ENOMEM;
    w->pieces.file = &w->output.file;
    w->pieces.rate = head != NULL ? head->rate : 1;
    w->pieces.start = head != NULL ? head->start : 0;
    ss_status st = ss_h5_output_open(&w->output, path);
    return st == SS_OK ? write_notes(&w->output.file, head) : st;
}

static ss_status
begin_empty(ss_store_writer **out, const char *path, const ss_header *signal,
            const ss_coefficients *grid)
{
    size_t n = grid != NULL ? grid->n : 0;
    ss_status st = begin(out, path, grid != NULL ? grid->head : signal);
    ss_store_writer *w = *out;
    if (st != SS_OK)
        return st;
    w->pieces.growing = n == 0;
    if (signal != NULL)
        st = ss_signal_writer_open(&w->signal, &w->pieces, signal, n);
    if (grid == NULL)
        return st;
    const char *rounded = ss_header_find_note(grid->head, "rounded");
    const char *accuracy = ss_header_find_note(grid->head, "accuracy");
    if (rounded != NULL && accuracy != NULL)
        w->wavelet.tolerance = strtod(accuracy, NULL);
    return st == SS_OK ? ss_wavelet_writer_open(&w->wavelet, &w->pieces, grid) : st;
}

/* Store the first failure, which may be the disk's, for later calls. */
static ss_status
keep(ss_store_writer *w, ss_status st)
{
    st = ss_h5_output_check(&w->output, st);
    if (st != SS_OK)
        w->status = st;
    return st;
}

static ss_status
report(const ss_store_writer *w, ss_status st, ss_error *err)
{
    if (st != SS_OK && err != NULL)
        *err = w->output.error;
    return st;
}

/* --- what ss_store_writer_new and the rest call, whose arguments have been checked ------------ */

static void
writer_free(ss_store_writer *w)
{
    if (w == NULL)
        return;
    H5E_BEGIN_TRY {
        ss_h5_output_close(&w->output, SS_STOP);     /* does nothing if it has ended */
    } H5E_END_TRY
    ss_wavelet_writer_free(&w->wavelet);
    free(w->signal.column);
    free(w->output.path);
    free(w);
}

static ss_status
writer_new(ss_store_writer **out, const char *path, const ss_header *signal, const ss_coefficients *grid,
           ss_error *err)
{
    ss_store_writer *w = NULL;
    ss_status st = ss_header_check_notes(grid != NULL ? grid->head : signal, err);
    if (st != SS_OK)
        return st;
    H5E_BEGIN_TRY {
        st = begin_empty(&w, path, signal, grid);
        if (w != NULL)
            st = keep(w, st);
    } H5E_END_TRY
    if (st == SS_OK)
        *out = w;
    else if (w != NULL)
        report(w, st, err);
    else
        ss_fail_memory(err, path);
    if (st != SS_OK)
        writer_free(w);
    return st;
}

static ss_status
writer_signal(ss_store_writer *w, double *const column[], size_t n, ss_error *err)
{
    ss_status st = w->status;
    signal_writer *signal = &w->signal;
    H5E_BEGIN_TRY {
        if (st == SS_OK && (signal->column == NULL
                            || (!w->pieces.growing && n > signal->length - signal->samples)))
            st = ss_fail(&w->output.error, SS_EINVAL, "more samples than the file was begun with");
        if (st == SS_OK)
            st = ss_signal_writer_append(signal, column, n);
        st = keep(w, st);
    } H5E_END_TRY
    return report(w, st, err);
}

static ss_status
writer_rows(ss_store_writer *writer, const ss_scale *scale, size_t first, size_t n, const double *w,
            size_t samples, ss_error *err)
{
    ss_status st = writer->status;
    size_t i = ss_wavelet_writer_find(&writer->wavelet, scale, first, n);
    H5E_BEGIN_TRY {
        if (st == SS_OK && i == writer->wavelet.n_scales)
            st = ss_fail(&writer->output.error, SS_EINVAL,
                         "coefficients that are not the next of a scale");
        if (st == SS_OK)
            st = ss_wavelet_writer_append(&writer->wavelet, i, n, w, samples);
        st = keep(writer, st);
    } H5E_END_TRY
    return report(writer, st, err);
}

static ss_status
writer_note(ss_store_writer *w, const char *key, const char *value, ss_error *err)
{
    ss_status st = w->status;
    h5_file *file = &w->output.file;
    H5E_BEGIN_TRY {
        if (st == SS_OK && ((H5Aexists(file->id, key) > 0 && H5Adelete(file->id, key) < 0)
                            || !ss_h5_write_text(file->id, key, value)))
            st = ss_h5_fail_write(file, 0, key);
        st = keep(w, st);
    } H5E_END_TRY
    return report(w, st, err);
}

/* 1 if all samples of the file have been given. */
static int
is_whole(const ss_store_writer *w, size_t samples)
{
    const signal_writer *signal = &w->signal;
    size_t length = w->pieces.growing ? samples : signal->length;
    return samples >= 1 && (w->pieces.growing || samples == w->wavelet.n)
           && (signal->column == NULL || signal->samples == length);
}

static ss_status
complete(ss_store_writer *w, size_t samples)
{
    if (!is_whole(w, samples))
        return ss_fail(&w->output.error, SS_EINVAL, "%zu samples are not what the file has", samples);
    return w->wavelet.n_scales > 0 ? ss_wavelet_writer_end(&w->wavelet, samples) : SS_OK;
}

static ss_status
writer_end(ss_store_writer *w, size_t samples, ss_error *err)
{
    ss_status st = w->status;
    H5E_BEGIN_TRY {
        if (st == SS_OK && w->output.file.id < 0)
            st = ss_fail(&w->output.error, SS_EINVAL, "the file is complete");
        if (st == SS_OK)
            st = complete(w, samples);
        st = keep(w, ss_h5_output_close(&w->output, st));
    } H5E_END_TRY
    return report(w, st, err);
}

static ss_status
write_signal(ss_store_writer *w, const ss_signal *signal)
{
    ss_status st = ss_signal_writer_open(&w->signal, &w->pieces, signal->head, signal->n);
    double **column = malloc((signal->head->n_columns + 1) * sizeof *column);
    for (size_t c = 0; column != NULL && c < signal->head->n_columns; c++)
        column[c] = signal->values + c * signal->n;
    if (st == SS_OK)
        st = column != NULL ? ss_signal_writer_append(&w->signal, column, signal->n) : SS_ENOMEM;
    free(column);
    return st;
}

static ss_status
write_all(ss_store_writer **out, const char *path, const ss_record *r)
{
    const ss_signal *signal = r->signal;
    const ss_coefficients *c = r->coefficients;
    ss_status st = begin(out, path, c != NULL ? c->head : signal != NULL ? signal->head : NULL);
    ss_store_writer *w = *out;
    if (st == SS_OK && signal != NULL)
        st = write_signal(w, signal);
    if (st == SS_OK && (r->has_events || r->n_events > 0))
        st = ss_h5_write_events(&w->output.file, r->events, r->n_events);
    if (st != SS_OK || c == NULL)
        return st;
    st = ss_wavelet_writer_open(&w->wavelet, &w->pieces, c);
    for (size_t i = 0; st == SS_OK && i < c->n_scales; i++)
        st = ss_wavelet_writer_append(&w->wavelet, i, c->scale[i].n, c->w + 2 * c->scale[i].offset,
                                      c->n);
    return st == SS_OK ? complete(w, c->n) : st;
}

static ss_status
write_record(const char *path, const ss_record *r, ss_error *err)
{
    ss_store_writer *w = NULL;
    ss_status st;
    H5E_BEGIN_TRY {
        st = write_all(&w, path, r);
        if (w != NULL)
            st = keep(w, ss_h5_output_close(&w->output, st));
    } H5E_END_TRY
    if (w != NULL)
        report(w, st, err);
    else
        ss_fail(err, st, "%s: %s", path, ss_strerror(st));
    writer_free(w);
    return st;
}

const struct ss_store_calls *
ss_store_calls(ss_error *err)
{
    static const struct ss_store_calls calls = {
        .open_signal = ss_h5_open_signal, .open_coefficients = ss_h5_open_coefficients, .write = write_record,
        .writer_new = writer_new, .writer_signal = writer_signal, .writer_rows = writer_rows,
        .writer_note = writer_note, .writer_end = writer_end, .writer_free = writer_free };
    (void)err;
    return &calls;
}
