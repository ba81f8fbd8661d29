/* overview.h -- a recording of any length in one pass, thinned to what a picture shows of it. */
#ifndef STICKSLIP_OVERVIEW_H
#define STICKSLIP_OVERVIEW_H

#include <stddef.h>
#include <stickslip/morlet.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* The samples of one column pass through ss_stream, and of what comes out the largest of each block
 * is kept: at most 4096 blocks a scale, and of the signal the smallest and the largest sample of
 * each.  When there are more, two become one.  So memory does not grow with the recording, no peak
 * is lost, and a time is off by less than 1/2000 of the recording. */
typedef struct ss_overview ss_overview;

/* A column of a signal that begins with this header; opts as for ss_stream_new, which fails as this
 * does. */
ss_status ss_overview_new(ss_overview **out, const ss_header *head, size_t column,
                          const ss_morlet_opts *opts, ss_error *err);
ss_status ss_overview_push(ss_overview *overview, const double *x, size_t n, ss_error *err);
/* The recording has ended.  SS_EDATA: it is shorter than the cone of influence of the second shortest
 * scale. */
ss_status ss_overview_end(ss_overview *overview, ss_error *err);

/* After the end, owned by the overview.  Of the coefficients w is |W|, its imaginary part 0, and
 * translations are of blocks; the scales are those that the cone of influence leaves something of. */
const ss_coefficients *ss_overview_coefficients(const ss_overview *overview);
const ss_signal *ss_overview_signal(const ss_overview *overview);
/* The largest |W| outside the cone of influence, and |W| at which noise begins, 0 if there is none:
 * for top and noise of ss_contour_opts. */
double ss_overview_top(const ss_overview *overview);
double ss_overview_noise(const ss_overview *overview);
void ss_overview_free(ss_overview *overview);           /* NULL is allowed */

SS_END_DECLARATIONS
#endif
