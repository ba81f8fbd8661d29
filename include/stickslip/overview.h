/* stickslip/overview.h -- a signal and its coefficients in one pass over a recording of any length,
 * reduced to what a picture shows. */
#ifndef STICKSLIP_OVERVIEW_H
#define STICKSLIP_OVERVIEW_H

#include <stddef.h>
#include <stickslip/morlet.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* An overview divides time into at most 4096 blocks.  It keeps the largest |W| of each block and scale, with an
 * imaginary part of 0, and the smallest and the largest sample of each block.  When there are more blocks, two
 * become one.  So memory does not grow with the recording, no peak is lost, and the error of a time is less than
 * 1/2000 of the recording.  A scale that lies inside the cone of influence as a whole is left out. */
typedef struct ss_overview {
    ss_coefficients *coefficients;
    ss_signal *signal;
    double top, noise;          /* for ss_contour_opts: the largest |W| outside the cone of influence, and
                                   the |W| at which noise begins, 0 if there is no noise */
} ss_overview;

/* Read a column to its end.  opts are those of ss_stream_new, but for a detrend, with which a reader is read
 * twice.  The caller frees *out with ss_overview_free.  SS_EDATA: the recording is shorter than the cone of
 * influence of the second shortest scale; other errors as from ss_stream_new and ss_reader_rows. */
ss_status ss_overview_read(ss_overview **out, ss_reader *reader, size_t column, const ss_morlet_opts *opts,
                           ss_error *err);
void ss_overview_free(ss_overview *overview);           /* NULL is allowed */

SS_END_DECLARATIONS
#endif
