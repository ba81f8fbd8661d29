/* h5.h -- the floor of the store: one open HDF5 file, and how its calls fail. */
#ifndef H5_H
#define H5_H

#define H5_USE_110_API 1        /* one signature of H5Ovisit in HDF5 1.10 to 1.14 */
#include <hdf5.h>
#include <hdf5_hl.h>
#include <stickslip/store.h>

#define H5_MAX_VALUES 1000000000        /* in one dataset: 8 GB as doubles */

typedef struct h5_file {
    hid_t id;
    const char *path;           /* for messages */
    ss_error *err;
} h5_file;

/* SS_EIO or what is given, with the text "PATH:GROUP/NAME: TEXT"; group 0 for the file itself. */
ss_status ss_h5_fail(h5_file *file, ss_status status, hid_t group, const char *name,
                     const char *text);

/* Open for reading.  Closing it closes every dataset, group and attribute still open in it. */
ss_status ss_h5_open(h5_file *file);

/* Attributes of an object.  A missing one, or one of another kind, gives 0. */
int ss_h5_get_number(hid_t object, const char *name, double *value);
char *ss_h5_get_text(hid_t object, const char *name);      /* to be freed, or NULL */

/* Read a whole dataset of real numbers, of n values in all, as doubles. */
ss_status ss_h5_read_values(h5_file *file, hid_t group, const char *name, double *values, size_t n);

/* The notes among the root's attributes, in the order in which they were written. */
ss_status ss_h5_read_notes(h5_file *file, ss_header *head);

/* The dataset at a path, whatever wrote it (foreign.c). */
ss_status ss_h5_read_foreign(ss_signal **out, h5_file *file, const char *dataset,
                             const ss_read_opts *opts);
/* Fail with the list of datasets that the file has. */
ss_status ss_h5_fail_listing(h5_file *file);

#define H5_VERSION_NOTE "stickslip_version"     /* the one attribute of the root that is no note */

#endif
