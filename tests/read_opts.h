/* read_opts.h -- the first member of options of reading in an initialiser: { READ_OPTS, .rate = 1 }. */
#ifndef READ_OPTS_H
#define READ_OPTS_H

#include <stickslip/signal.h>

#define READ_OPTS .size = sizeof(ss_read_opts)

#endif
