/* welch.h -- a spectrum of samples that come in pieces. */
#ifndef WELCH_H
#define WELCH_H

#include <stickslip/spectrum.h>

/* As ss_spectrum_new, for n samples that come in pieces: new, add for each piece, end, free.  It takes 16 bytes
 * for each sample of a segment. */
typedef struct ss_welch ss_welch;
ss_status ss_welch_new(ss_welch **out, size_t n, double rate, double resolution, ss_error *err);
ss_status ss_welch_add(ss_welch *welch, const double *x, size_t n, ss_error *err);
ss_status ss_welch_end(ss_spectrum **out, ss_welch *welch, ss_error *err);
void ss_welch_free(ss_welch *welch);                    /* NULL is allowed */

#endif
