/* au.h -- Sun AU that is to hold something other than a signal. */
#ifndef AU_H
#define AU_H

#include <stickslip/signal.h>

/* Read the header, and our own in its annotation if that begins with the reader's magic. */
ss_status ss_au_open(ss_reader *reader, const ss_read_opts *opts, ss_error *err);

#endif
