/* h5_write.h -- make a file, its attributes, groups and datasets. */
#ifndef H5_WRITE_H
#define H5_WRITE_H

#include "io/hdf5/h5.h"

#define H5_PIECE 65536          /* the most values in a chunk, and in one write */

/* One dataset to be written. */
typedef struct h5_dataset {
    const char *name, *unit, *long_name;
    hid_t file_type;
    const void *values;         /* doubles, or texts as in the file; NULL: they are written later */
    hsize_t chunk;              /* 0: as its size says; else its last dimension grows, and it is
                                   kept in chunks of so many values of a row */
    int in_rows;                /* 1: it is written row by row, and each has chunks of its own */
} h5_dataset;

/* A call of HDF5 fails for lack of memory, or for a name or size that it cannot store; disk.c hides a
 * full disk from it. */
ss_status ss_h5_fail_write(h5_file *file, hid_t group, const char *name);

/* Attributes of an object, and a new group; 0 or < 0 if HDF5 fails. */
int ss_h5_write_number(hid_t object, const char *name, hid_t file_type, double value);
int ss_h5_write_text(hid_t object, const char *name, const char *value);
hid_t ss_h5_new_group(hid_t parent, const char *name);

/* Make one dataset on the given dimension scales (NULL: it is a scale itself; { NULL }: on none), and
 * write its values if it has any; < 0 if HDF5 fails. */
hid_t ss_h5_new_dataset(hid_t group, const h5_dataset *v, int rank, const hsize_t dims[],
                        const char *const scales[]);
/* Write n lists of one length; the first is the scale of the others.  values of each are doubles, ints or texts as
 * its type in the file says; of numbers they point to the first, and the next is so many bytes apart. */
ss_status ss_h5_write_lists(h5_file *file, hid_t group, const h5_dataset v[], size_t n, size_t length,
                            size_t apart);
/* n values of a row, from its at-th on; at[0] is the row, if there are several.  A dataset that is too
 * short grows. */
int ss_h5_write_piece(hid_t id, int rank, const hsize_t at[], hsize_t n, hid_t type,
                      const void *values);

/* --- the file ------------------------------------------------------------------------------- */

typedef struct h5_output {
    char *path;                 /* to be freed after the end */
    h5_file file;               /* fails into error */
    ss_error error;
} h5_output;

/* Make the file at out->path, whose file.id and file.disk.fd are -1; to be closed even after a failure. */
ss_status ss_h5_output_open(h5_output *out);
/* The status of a step, or that of the disk if this has failed since; its text is in out->error. */
ss_status ss_h5_output_check(h5_output *out, ss_status st);
/* Close everything.  An incomplete file, by the status until now or that of the disk, is removed.
 * Closing it again does nothing. */
ss_status ss_h5_output_close(h5_output *out, ss_status st);

#endif
