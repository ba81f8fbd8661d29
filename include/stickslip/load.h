/* stickslip/load.h -- a signal, or a measured base, from any file that holds one. */
#ifndef STICKSLIP_LOAD_H
#define STICKSLIP_LOAD_H

#include <stickslip/scene.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* Open path, with any contents: a stream, delimited text, HDF5, or HDF5 followed by
 * ":/path/to/dataset".  The reader closes what it has opened. */
ss_status ss_reader_load(ss_reader **out, const char *path, const ss_read_opts *opts, ss_error *err);

/* All rows of it. */
ss_status ss_signal_load(ss_signal **out, const char *path, const ss_read_opts *opts,
                         ss_error *err);

/* The measured base in such a file.  column: its name or number; NULL or "": z, or the only one. */
ss_status ss_base_load(ss_base **base, const char *path, const char *column, ss_error *err);

/* If a scene that was read from the file scene_path names a base_file, read it, from the folder of that
 * file, and let the scene move by it; else *base becomes NULL.  To be freed with ss_base_free after the
 * last use of the scene. */
ss_status ss_scene_load_base(ss_base **base, ss_scene *scene, const char *scene_path, ss_error *err);

SS_END_DECLARATIONS
#endif
