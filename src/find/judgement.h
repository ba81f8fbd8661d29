/* judgement.h -- the numbers by which this folder and fit judge. */
#ifndef JUDGEMENT_H
#define JUDGEMENT_H

/* How sure. */
#define SIGMAS 3.0              /* standard errors beyond which something is not by chance; a number with a
                                   larger error than its SIGMAS-th part is not known */
#define PRECISE 10.0            /* standard errors that a value must be large where nothing but the fit speaks for it */
#define SURELY 5.0              /* standard deviations beyond which none of many samples lies by chance */
#define FALSE_ALARMS 0.01       /* a record of noise has so many of a kind */

/* How much larger. */
#define LARGER 1.5              /* times: so much more of what rings or is left, or so much quicker, is another thing */
#define TWICE 2.0               /* times: stronger or quicker by so much, whatever noise and sampling do */

/* How small a part. */
#define JITTER 0.125            /* part of a period or cycle within which times are the same */
#define PRECISION 1e-7          /* of a sample, relative to the largest change: nothing needs to be better */
#define FAINT 0.01              /* part of a height, an energy or a rate: so little is not there */
#define SLIGHT 0.05             /* part of a height, level or rate: so little counts as none */
#define LITTLE 0.1              /* part: small beside the rest, which it does not decide */
#define MOSTLY 0.75             /* part of many, or of a time: it is most of it */
#define NEARLY 0.9              /* part of a whole: it is nearly all */
#define OUTLIERS 0.02           /* part of the samples at either end of the range that may be wrong */

/* How many. */
enum { FEW = 3 };               /* fewest of a kind that recur */
enum { FEWEST = 8 };            /* fewest samples that show a shape; so many in a row that stand still are clipped */

#endif
