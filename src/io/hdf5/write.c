/* write.c -- a file in HDF5: samples, events and coefficients as they come.
 *
 * If the number of samples and coefficients is not known, all datasets stay open, with chunks so
 * short that one of each fits into memory.  Rows of a signal alone are put together first: then the length
 * of most signals is known when the file is made. */
#include <stdlib.h>
#include <string.h>
#include "base/columns.h"
#include "base/error.h"
#include "base/list.h"
#include "signal/header.h"
#include "io/hdf5/groups.h"
#include "io/hdf5/output.h"
#include "io/store.h"
#include "io/writer.h"

enum { TOGETHER = 1 << 20 };    /* values of a signal that are written at a time */

struct h5_writer {
    ss_writer base;
    h5_output output;
    h5_pieces pieces;
    ss_status status;           /* the first failure */
    signal_writer signal;
    wavelet_writer wavelet;
    ss_header *head;            /* of a signal alone, and its rows that were not written yet; or NULL */
    double **row;
    size_t length, n_rows;      /* length: of the record; 0: not known */
    int has_events, ended;
    ss_event *event;
    size_t n_events, room;
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

/* Make the file of a record of n samples, or, if it grows, of an unknown number. */
static ss_status
begin(struct h5_writer *w, const ss_header *signal, const ss_coefficients *grid, size_t n, int growing)
{
    const ss_header *head = grid != NULL ? grid->head : signal;
    w->pieces.file = &w->output.file;
    w->pieces.rate = head != NULL ? head->rate : 1;
    w->pieces.start = head != NULL ? head->start : 0;
    w->pieces.growing = growing;
    ss_status st = ss_h5_output_open(&w->output);
    if (st == SS_OK)
        st = write_notes(&w->output.file, head);
    if (st == SS_OK && signal != NULL)
        st = ss_signal_writer_open(&w->signal, &w->pieces, signal, n);
    if (st != SS_OK || grid == NULL)
        return st;
    const char *accuracy = ss_header_find_note(grid->head, "accuracy");
    if (ss_header_find_note(grid->head, "rounded") != NULL && accuracy != NULL)
        w->wavelet.tolerance = strtod(accuracy, NULL);
    return ss_wavelet_writer_open(&w->wavelet, &w->pieces, grid);
}

/* Run a step of a writer that has not failed.  The first failure, which may be the disk's, is kept for all calls
 * that follow. */
#define STEP(w, err, work) do { \
        ss_status st = (w)->status; \
        H5E_BEGIN_TRY { \
            if (st == SS_OK) \
                st = work; \
            (w)->status = ss_h5_output_check(&(w)->output, st); \
        } H5E_END_TRY \
        if ((w)->status != SS_OK && (err) != NULL) \
            *(err) = (w)->output.error; \
        return (w)->status; \
    } while (0)

/* Append rows to the file. */
static ss_status
append(struct h5_writer *w, double *const column[], size_t n)
{
    const signal_writer *signal = &w->signal;
    if (signal->column == NULL || (!w->pieces.growing && n > signal->length - signal->samples))
        return ss_fail(&w->output.error, SS_EINVAL, "more samples than the file was begun with");
    return ss_signal_writer_append(&w->signal, column, n);
}

/* Write the rows that were put together; all: there are no more. */
static ss_status
write_together(struct h5_writer *w, int all)
{
    size_t n = w->length > 0 || !all ? w->length : w->n_rows;
    ss_status st = w->signal.column == NULL ? begin(w, w->head, NULL, n, n == 0 && !all) : SS_OK;
    if (st == SS_OK)
        st = append(w, w->row, w->n_rows);
    w->n_rows = 0;
    return st;
}

static size_t
room_of(const ss_header *head)
{
    return TOGETHER / (head->n_columns + 1) + 1;
}

static ss_status
put_together(struct h5_writer *w, double *const column[], size_t n)
{
    size_t columns = w->head->n_columns, room = room_of(w->head);
    ss_status st = SS_OK;
    for (size_t i = 0, m; st == SS_OK && i < n; i += m) {
        m = n - i < room - w->n_rows ? n - i : room - w->n_rows;
        if (m == 0)
            st = write_together(w, 0);
        for (size_t c = 0; c < columns; c++)
            memcpy(w->row[c] + w->n_rows, column[c] + i, m * sizeof *column[c]);
        w->n_rows += m;
    }
    return st;
}

static ss_status
write_rows(ss_writer *base, double *const column[], size_t n, ss_error *err)
{
    struct h5_writer *w = (struct h5_writer *)base;
    STEP(w, err, w->head != NULL ? put_together(w, column, n) : append(w, column, n));
}

static ss_status
append_coefficients(struct h5_writer *w, const ss_scale *scale, size_t first, size_t n, const double *c, size_t samples)
{
    size_t i = ss_wavelet_writer_find(&w->wavelet, scale, first, n);
    if (i == w->wavelet.n_scales)
        return ss_fail(&w->output.error, SS_EINVAL, "coefficients that are not the next of a scale");
    return ss_wavelet_writer_append(&w->wavelet, i, n, c, samples);
}

static ss_status
write_coefficients(ss_writer *base, const ss_scale *scale, size_t first, size_t n, const double *c, size_t samples,
                   ss_error *err)
{
    struct h5_writer *w = (struct h5_writer *)base;
    STEP(w, err, append_coefficients(w, scale, first, n, c, samples));
}

/* Events are written at the end, as their number is known then. */
static ss_status
keep_events(struct h5_writer *w, const ss_event *event, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        ss_event *more = ss_list_room(w->event, &w->room, w->n_events, sizeof *more);
        if (more == NULL)
            return SS_ENOMEM;
        w->event = more;
        more[w->n_events++] = event[i];
    }
    return SS_OK;
}

static ss_status
write_events(ss_writer *base, const ss_event *event, size_t n, ss_error *err)
{
    struct h5_writer *w = (struct h5_writer *)base;
    STEP(w, err, keep_events(w, event, n));
}

static ss_status
append_note(struct h5_writer *w, const char *key, const char *value)
{
    h5_file *file = &w->output.file;
    if (file->id < 0)
        return ss_header_note(w->head, key, value, NULL);
    int good = H5Aexists(file->id, key) <= 0 || H5Adelete(file->id, key) >= 0;
    return good && ss_h5_write_text(file->id, key, value) ? SS_OK : ss_h5_fail_write(file, 0, key);
}

static ss_status
write_note(ss_writer *base, const char *key, const char *value, ss_error *err)
{
    struct h5_writer *w = (struct h5_writer *)base;
    STEP(w, err, append_note(w, key, value));
}

/* Write what is left, and check that all samples of the file have been given. */
static ss_status
complete(struct h5_writer *w, size_t samples)
{
    const signal_writer *signal = &w->signal;
    const int has_wavelet = w->wavelet.n_scales > 0;
    ss_status st = w->head != NULL ? write_together(w, 1) : SS_OK;
    size_t length = w->pieces.growing ? samples : signal->length;
    if (st == SS_OK && ((has_wavelet && (samples < 1 || (!w->pieces.growing && samples != w->wavelet.n)))
                        || (signal->column != NULL && (signal->samples != length || length != samples))))
        st = ss_fail(&w->output.error, SS_EINVAL, "%zu samples are not what the file has", samples);
    if (st == SS_OK && w->has_events)
        st = ss_h5_write_events(&w->output.file, w->event, w->n_events);
    return st == SS_OK && has_wavelet ? ss_wavelet_writer_end(&w->wavelet, samples) : st;
}

static ss_status
end(struct h5_writer *w, size_t samples)
{
    if (w->ended)
        return ss_fail(&w->output.error, SS_EINVAL, "the file is complete");
    w->ended = 1;
    return ss_h5_output_close(&w->output, complete(w, samples));
}

static ss_status
end_file(ss_writer *base, size_t samples, ss_error *err)
{
    struct h5_writer *w = (struct h5_writer *)base;
    STEP(w, err, end(w, samples));
}

static void
free_writer(ss_writer *base)
{
    struct h5_writer *w = (struct h5_writer *)base;
    H5E_BEGIN_TRY {
        ss_h5_output_close(&w->output, SS_STOP);     /* does nothing if it has ended */
    } H5E_END_TRY
    ss_wavelet_writer_free(&w->wavelet);
    ss_header_free(w->head);
    free(w->row);
    free(w->event);
    free(w->signal.column);
    free(w->output.path);
    free(w);
}

/* A signal alone is put together first, anything else begins at once. */
static ss_status
prepare(struct h5_writer *w, const ss_contents *what)
{
    const ss_header *signal = what->signal;
    w->length = what->n;
    w->has_events = what->events;
    if (w->output.path == NULL)
        return SS_ENOMEM;
    if (signal == NULL || what->grid != NULL)
        return begin(w, signal, what->grid, what->n, what->n == 0);
    w->row = ss_columns_new(signal->n_columns, room_of(signal));
    return w->row != NULL ? ss_header_copy(&w->head, signal, NULL) : SS_ENOMEM;
}

static ss_status
writer_new(ss_writer **out, const char *path, const ss_contents *what, ss_error *err)
{
    static const struct writer_calls calls = {
        write_rows, write_coefficients, write_events, write_note, end_file, free_writer };
    const ss_header *head = what->grid != NULL ? what->grid->head : what->signal;
    ss_status st = head != NULL ? ss_header_check_notes(head, err) : SS_OK;
    if (st != SS_OK)
        return st;
    struct h5_writer *w = calloc(1, sizeof *w);
    if (w == NULL)
        return ss_fail_memory(err, path);
    w->base.calls = &calls;
    w->output.path = strdup(path);
    w->output.disk.fd = -1;
    w->output.file = (h5_file){ .id = -1, .path = path, .err = &w->output.error };
    H5E_BEGIN_TRY {
        st = ss_h5_output_check(&w->output, prepare(w, what));
    } H5E_END_TRY
    w->output.file.path = w->output.path;
    if (st == SS_OK)
        *out = &w->base;
    else if (err != NULL)
        *err = w->output.error;
    if (st != SS_OK)
        free_writer(&w->base);
    return st;
}

const struct ss_store_calls *
ss_store_calls(ss_error *err)
{
    static const struct ss_store_calls calls = {
        .open_signal = ss_h5_open_signal, .open_coefficients = ss_h5_open_coefficients, .writer_new = writer_new };
    (void)err;
    return &calls;
}
