/* stickslip/load.h -- a signal from any file that holds one. */
#ifndef STICKSLIP_LOAD_H
#define STICKSLIP_LOAD_H

#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* Open path, with any contents: a stream, delimited text, HDF5, or HDF5 followed by
 * ":/path/to/dataset". */
ss_status ss_signal_load(ss_signal **out, const char *path, const ss_read_opts *opts,
                         ss_error *err);

SS_END_DECLARATIONS
#endif
