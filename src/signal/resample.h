/* resample.h -- bring rows at any times to a uniform clock. */
#ifndef RESAMPLE_H
#define RESAMPLE_H

#include "signal/source.h"

/* Wrap a source in one that gives its rows at this rate [Hz], from the first on, by a cubic spline through
 * each column; NaN are skipped.  stamped: the last column of the source holds the times of its rows, which
 * ascend; it is left out, and samples between times more than longest [s] apart, or beyond a column's own
 * first and last, are NaN.  SS_EDATA, when rows are read: there is but one; SS_ERANGE: a value is not
 * finite. */
ss_status ss_source_resample(ss_source **s, double rate, int stamped, double longest, ss_error *err);

/* The first sample in which there is no value, if times end at one and go on at another, or a negative
 * number; both count from the first time. */
double ss_resample_gap(double end, double next, double rate);
/* The number of samples from the first time to the last, which may be more than an integer holds. */
double ss_resample_count(double first, double last, double rate);

#endif
