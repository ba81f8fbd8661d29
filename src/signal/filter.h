/* filter.h -- filter, differentiate or integrate the rows of a source. */
#ifndef FILTER_H
#define FILTER_H

#include "signal/source.h"

/* Wrap a source in one that gives its rows filtered, as ss_reader_filter has them; opts are complete. */
ss_status ss_source_filter(ss_source **s, const ss_filter_opts *opts, ss_error *err);
/* The frequencies [Hz] that the filters which a header notes left as they were: *flat becomes at least as narrow.
 * Returns 0 if it notes none. */
int ss_header_flat(const ss_header *head, ss_range *flat);

#endif
