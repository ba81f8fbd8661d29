/* frames.h -- the data of sound files: frames of one value a channel, of one type. */
#ifndef FRAMES_H
#define FRAMES_H

#include "io/reader.h"

/* Add columns ch1, ch2, ... for n channels without names. */
ss_status ss_frames_columns(ss_header *head, size_t n);
/* Let the reader give the frames that follow as rows; its columns are the channels.  bytes is
 * their length; UINT64_MAX: up to the end of the file.  If end > 0, the frames end at this byte of
 * the file, and nothing may follow them, except chunks if reader->is_chunk is 1. */
void ss_frames_begin(ss_reader *reader, sample_type type, uint64_t bytes, uint64_t end);

/* One value without scaling: an integer, or floating point. */
double ss_sample_raw(const unsigned char *p, sample_type type);

#endif
