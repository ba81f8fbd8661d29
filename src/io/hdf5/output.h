/* output.h -- make, complete or remove the file that HDF5 writes. */
#ifndef STORE_OUTPUT_H
#define STORE_OUTPUT_H

#include "io/hdf5/h5.h"

typedef struct h5_output {
    char *path;                 /* to be freed after the end */
    h5_file file;               /* fails into error */
    h5_disk disk;
    int spooled;                /* path is not a regular file: it gets a copy at the end */
    ss_error error;
} h5_output;

/* Make the file at out->path, whose file.id and disk.fd are -1; to be closed even after a failure. */
ss_status ss_h5_output_open(h5_output *out);
/* The status of a step, or that of the disk if this has failed since; its text is in out->error. */
ss_status ss_h5_output_check(h5_output *out, ss_status st);
/* Close everything.  An incomplete file, by the status until now or that of the disk, is removed.
 * Closing it again does nothing. */
ss_status ss_h5_output_close(h5_output *out, ss_status st);

#endif
