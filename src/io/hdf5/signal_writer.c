/* signal_writer.c -- write the samples of a signal, in pieces, with a dataset for each column in
 * /signal. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/hdf5/groups.h"

static const struct { const char *name, *unit, *long_name; } known[] = {
    { "x", "m",     "displacement" },
    { "v", "m/s",   "velocity" },
    { "a", "m/s^2", "acceleration" },
    { "f", "N",     "friction force" },
    { "y", "m",     "contact deflection" },
    { "z", "m",     "displacement of the base" },
    { "mode", "",   "mode: 0 stick, else the sign of the slip" },
};

static const char *
long_name(const ss_column *column)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(column->name, known[i].name) == 0 && strcmp(column->unit, known[i].unit) == 0)
            return known[i].long_name;
    return column->name;
}

/* Choose the name of a column's link in a group: its own name if HDF5 allows it and it is not used. */
static void
link_name(char link[256], hid_t group, const char *name)
{
    size_t length = 199;
    if (snprintf(link, length + 1, "%s", name) > (int)length) {
        while (length > 0 && (name[length] & 0xc0) == 0x80)
            length--;                   /* back to the start of a character */
        link[length] = '\0';
    }
    for (char *c = link; *c != '\0'; c++)
        if (*c == '/')
            *c = '_';
    if (link[0] == '\0' || strcmp(link, ".") == 0)
        strcpy(link, "_");
    length = strlen(link);
    for (int i = 2; H5Lexists(group, link, H5P_DEFAULT) > 0; i++)
        sprintf(link + length, "_%d", i);
}

/* For each column that is attached to t, HDF5 writes the list of all of them again.  A list of more than
 * 64 kB is not replaced but appended each time: 32768 columns would take a minute and 1 GB. */
enum { MOST_ATTACHED = 4000 };

static ss_status
open_column(signal_writer *w, hid_t group, const ss_column *column, hsize_t chunk,
            const char *const scales[])
{
    char link[256];
    hsize_t dims = w->length;
    link_name(link, group, column->name);
    const h5_dataset v = { .name = link, .unit = column->unit, .long_name = long_name(column),
                           .file_type = H5T_IEEE_F64LE, .chunk = chunk };
    hid_t id = w->column[w->n_columns++] = ss_h5_new_dataset(group, &v, 1, &dims, scales);
    if (id < 0 || (strcmp(link, column->name) != 0 && !ss_h5_write_text(id, "column", column->name)))
        return ss_h5_fail_write(w->pieces->file, group, link);
    return SS_OK;
}

ss_status
ss_signal_writer_open(signal_writer *w, h5_pieces *pieces, const ss_header *head, size_t length)
{
    const char *const scales[] = { head->n_columns <= MOST_ATTACHED ? "t" : NULL };
    hsize_t dims = length;
    hsize_t chunk = pieces->growing ? ss_h5_growing_chunk(8 * (head->n_columns + 1)) : 0;
    const h5_dataset t = { .name = "t", .unit = "s", .long_name = "time",
                           .file_type = H5T_IEEE_F64LE, .chunk = chunk };
    hid_t group = ss_h5_new_group(pieces->file->id, "signal");
    w->pieces = pieces;
    w->length = length;
    w->column = calloc(head->n_columns + 1, sizeof *w->column);
    if (w->column == NULL)
        return SS_ENOMEM;
    if (group < 0 || !ss_h5_write_clock(group, head)
        || (w->times = ss_h5_new_dataset(group, &t, 1, &dims, NULL)) < 0)
        return ss_h5_fail_write(pieces->file, 0, "/signal");
    ss_status st = SS_OK;
    for (size_t c = 0; st == SS_OK && c < head->n_columns; c++)
        st = open_column(w, group, &head->column[c], chunk, scales);
    H5Gclose(group);
    return st;
}

ss_status
ss_signal_writer_append(signal_writer *w, double *const column[], size_t n)
{
    h5_file *file = w->pieces->file;
    if (!ss_h5_write_times(w->pieces, w->times, NULL, w->samples, n))
        return ss_h5_fail_write(file, 0, "/signal/t");
    for (size_t c = 0; c < w->n_columns; c++)
        for (size_t i = 0, m; i < n; i += m) {
            hsize_t at = w->samples + i;
            m = n - i < H5_PIECE ? n - i : H5_PIECE;
            if (!ss_h5_write_piece(w->column[c], 1, &at, m, H5T_NATIVE_DOUBLE, column[c] + i))
                return ss_h5_fail_write(file, 0, "/signal");
        }
    w->samples += n;
    return SS_OK;
}
