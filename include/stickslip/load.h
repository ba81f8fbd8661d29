/* stickslip/load.h -- open any file that holds a signal or the measured motion of a base. */
#ifndef STICKSLIP_LOAD_H
#define STICKSLIP_LOAD_H

#include <stickslip/scene.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* Open the file at path for reading: any that ss_reader_new reads, or HDF5.
 * "FILE:/path/to/dataset" is a dataset of an HDF5 file.  The reader closes the file. */
ss_status ss_reader_load(ss_reader **out, const char *path, const ss_read_opts *opts, ss_error *err);

/* The simple case: all rows of it. */
ss_status ss_signal_load(ss_signal **out, const char *path, const ss_read_opts *opts,
                         ss_error *err);

/* Make a measured base from a column of such a file.  column is its name or number; NULL or "": the
 * column z, or the only column. */
ss_status ss_base_load(ss_base **base, const char *path, const char *column, ss_error *err);

/* If the scene names a base_file, read it and set scene->base to *base; else *base becomes NULL.
 * The name is relative to the folder of scene_path, the file from which the scene was read.  The
 * caller frees *base with ss_base_free after the last use of the scene. */
ss_status ss_scene_load_base(ss_base **base, ss_scene *scene, const char *scene_path, ss_error *err);

SS_END_DECLARATIONS
#endif
