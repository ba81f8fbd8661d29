/* stickslip/overview.h -- a signal and its coefficients in one pass over a recording of any length,
 * reduced to what a picture shows. */
#ifndef STICKSLIP_OVERVIEW_H
#define STICKSLIP_OVERVIEW_H

#include <stddef.h>
#include <stickslip/morlet.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* An overview divides time into at most 4096 blocks.  It keeps the largest |W| of each block and
 * scale (computed with ss_stream), and the smallest and the largest sample of each block.  When
 * there are more blocks, two become one.  So memory does not grow with the recording, no peak is
 * lost, and the error of a time is less than 1/2000 of the recording. */
typedef struct ss_overview ss_overview;

/* Begin an overview of one column of a signal with this header.  opts and errors are those of
 * ss_stream_new. */
ss_status ss_overview_new(ss_overview **out, const ss_header *head, size_t column,
                          const ss_morlet_opts *opts, ss_error *err);
/* Append n samples. */
ss_status ss_overview_push(ss_overview *overview, const double *x, size_t n, ss_error *err);
/* What an overview shows, owned by it.  A coefficient is the |W| of a block, with an imaginary part of
 * 0.  A scale that lies inside the cone of influence as a whole is left out. */
typedef struct ss_overview_result {
    const ss_coefficients *coefficients;
    const ss_signal *signal;
    double top, noise;          /* for ss_contour_opts: the largest |W| outside the cone of influence, and
                                   the |W| at which noise begins, 0 if there is no noise */
} ss_overview_result;
/* The recording has ended.  SS_EDATA: it is shorter than the cone of influence of the second
 * shortest scale. */
ss_status ss_overview_end(ss_overview *overview, ss_overview_result *out, ss_error *err);
void ss_overview_free(ss_overview *overview);           /* NULL is allowed */

SS_END_DECLARATIONS
#endif
