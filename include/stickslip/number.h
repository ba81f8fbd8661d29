/* stickslip/number.h -- numbers as text, whatever the locale. */
#ifndef STICKSLIP_NUMBER_H
#define STICKSLIP_NUMBER_H

#include <stddef.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

#define SS_NUMBER_MAX 32
/* Write x in the fewest digits that read back to the same double, laid out as by %.17g but whatever
 * the locale, and a terminating NUL; the length is returned.  What is not finite is "nan", "inf"
 * or "-inf". */
size_t ss_number_format(char text[SS_NUMBER_MAX], double x);
/* Read a decimal number as C's strtod does in the C locale, whatever the locale in force; *end is
 * set behind it, or to text if there is none.  Hexadecimal, infinity and NaN are not numbers here. */
double ss_number_parse(const char *text, char **end);

SS_END_DECLARATIONS
#endif
