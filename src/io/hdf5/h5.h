/* h5.h -- the base of the store: one open HDF5 file, its attributes and values, and the failures of its calls. */
#ifndef H5_H
#define H5_H

#define H5_USE_110_API 1        /* one signature of H5Ovisit in HDF5 1.10 to 1.14 */
#include <hdf5.h>
#include <hdf5_hl.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif
#include <stickslip/store.h>
#include "signal/source.h"

#define H5_MAX_VALUES 1000000000        /* in one dataset: 8 GB as doubles */
#define H5_MAX_TEXT 1048576             /* bytes of an attribute */

/* An open file on disk as HDF5 sees it (disk.c). */
typedef struct h5_disk {
    H5FD_t of_hdf5;             /* comes first */
    int fd, error;              /* error: the errno of the first failure, or 0 */
    int reading, packed;        /* packed: a heap with filters was refused */
    haddr_t eoa, eof;           /* end of what is allocated, of what is there */
} h5_disk;
/* A file access list for this disk, to be closed, or < 0.  The driver is to be unregistered behind the file:
 * H5Fclose drops what the file holds of it before its last use. */
hid_t ss_h5_disk_access(h5_disk *disk, hid_t *driver);

typedef struct h5_file {
    hid_t id;
    char *path;                 /* for messages; owned */
    ss_status status;           /* the first failure, behind which nothing is read or written */
    ss_error *err;              /* its text, but of SS_ENOMEM */
    h5_disk disk;
    hid_t driver;               /* to be unregistered behind the file */
    double claimed;             /* bytes of the file that the values read so far need at least */
    double text;                /* and of text in attributes */
} h5_file;

/* Unless it has failed before, let the file fail with this status and the text "PATH:GROUP/NAME: TEXT"; group 0
 * for the file itself. */
void ss_h5_fail(h5_file *file, ss_status status, hid_t group, const char *name, const char *text);

/* Open for reading.  Closing it closes every dataset, group and attribute still open in it. */
void ss_h5_open(h5_file *file, const char *path, ss_error *err);
void ss_h5_close(h5_file *file);                        /* opened or not */

/* Objects by their path, links out of the file not followed; < 0 if there is none.  A dataset in pieces is one of
 * which whole chunks are read, so that none is kept in memory. */
hid_t ss_h5_open_dataset(hid_t group, const char *name, int in_pieces);
hid_t ss_h5_open_group(hid_t group, const char *name);
/* The reason why the values of a dataset must not be read, or NULL: they are not plain real numbers of
 * this file, or more than the file can hold; *bytes: so many of the file they need. */
const char *ss_h5_refuse_values(hid_t dataset, double *bytes);

/* HDF5 without its messages, and without the plugins that a file may name for any filter.  If HDF5_PLUGIN_PRELOAD
 * has forbidden them for good, HDF5 gives no state to restore, and it stays 0. */
#define QUIETLY(work) do { \
        unsigned plugins = 0; \
        H5E_BEGIN_TRY { \
            H5PLget_loading_state(&plugins); \
            H5PLset_loading_state(0); \
            work \
            H5PLset_loading_state(plugins); \
        } H5E_END_TRY \
    } while (0)

/* A required attribute of a group, lo <= value <= hi. */
double ss_h5_need_number(h5_file *file, hid_t group, const char *name, double lo, double hi);
/* Attributes of an object.  Returns 0 for a missing one, or one of another kind. */
int ss_h5_get_number(hid_t object, const char *name, double *value);
/* The same of text, to be freed even after a failure: the file claims too much of it.  NULL: there is none. */
char *ss_h5_get_text(h5_file *file, hid_t object, const char *name);

/* Read count[i] values along dimension i of a dataset, from at[i] on, as doubles.  Returns 0 if HDF5 fails. */
int ss_h5_read_piece(hid_t id, int rank, const hsize_t at[], const hsize_t count[], double *values);
/* The same of n rows, from the row-th on, of a list, or of an array whose rows go along its last dimension if it
 * is by columns. */
int ss_h5_read_rows(hid_t id, int by_columns, size_t row, size_t n, double *values);

/* Open a dataset of real numbers, which are counted as claimed; it is to be closed even after a failure. */
hid_t ss_h5_open_values(h5_file *file, hid_t group, const char *name, int *rank, hsize_t dims[]);
/* The same of a list of n numbers. */
hid_t ss_h5_open_list(h5_file *file, hid_t group, const char *name, size_t *n);

/* Rate, start and whether the text form has a column of time, from a group into a header, which is made if it is
 * NULL, with the notes of the file. */
void ss_h5_read_header(h5_file *file, hid_t group, ss_header **head);

#define H5_VERSION_NOTE "stickslip_version"     /* the one attribute of the root that is no note */

/* --- what a file holds ---------------------------------------------------------------------- */

/* Open /signal, or the array at a path in the file; *out is to be freed even after a failure. */
ss_status ss_h5_open_signal(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts,
                            ss_error *err);
/* The coefficients of a file, which stay there (wavelet_reader.c). */
ss_status ss_h5_open_coefficients(ss_coefficients **out, const char *path, ss_error *err);

#endif
