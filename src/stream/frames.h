/* frames.h -- the data of sound files: frames of one value a channel, of one type. */
#ifndef FRAMES_H
#define FRAMES_H

#include "stream/reader.h"

/* Columns ch1, ch2, ... for n channels without names. */
ss_status ss_frames_columns(ss_header *head, size_t n);
/* Let the reader give rows of all that comes now: frames of such samples, in so many bytes; UINT64_MAX:
 * up to the end.  Its columns are the channels.  With end > 0, where these bytes end in the file, nothing
 * may follow them; with reader->is_chunk, nothing but chunks. */
void ss_frames_begin(ss_reader *reader, sample_type type, uint64_t bytes, uint64_t end);

/* One such value as it is: an integer, or floating point. */
double ss_sample_raw(const unsigned char *p, sample_type type);

#endif
