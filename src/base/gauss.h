/* gauss.h -- a constant of the Gaussian distribution. */
#ifndef GAUSS_H
#define GAUSS_H

#define GAUSS_MEDIAN 0.6744897501960817 /* the median of |x| over the standard deviation */

#endif
