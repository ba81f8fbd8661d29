/* gauss.h -- constants of the Gaussian distribution. */
#ifndef GAUSS_H
#define GAUSS_H

#define GAUSS_MEDIAN 0.6744897501960817 /* the median of |x| over the standard deviation */
#define GAUSS_MEDIAN_ERROR 1.17         /* its relative error, times the root of the number of values */
#define GAUSS_NINE_TENTHS 0.623         /* the mean of the least nine tenths of x^2 over the variance */

#endif
