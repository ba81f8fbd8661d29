/* gauss.h -- a number of the Gaussian distribution. */
#ifndef GAUSS_H
#define GAUSS_H

#define GAUSS_MEDIAN 0.6744897501960817 /* of |x|, re the standard deviation */

#endif
