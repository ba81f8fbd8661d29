/* stickslip/number.h -- numbers as text, in every locale the same. */
#ifndef STICKSLIP_NUMBER_H
#define STICKSLIP_NUMBER_H

#include <stddef.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

#define SS_NUMBER_MAX 32
/* Write x with the fewest digits from which a reader gets the same double, in the layout of %.17g,
 * and a NUL behind them.  A value that is not finite becomes "nan", "inf" or "-inf".  Returns the
 * length without the NUL. */
size_t ss_number_format(char text[SS_NUMBER_MAX], double x);
/* Read the decimal number at the start of text, as strtod does in the C locale.  *end becomes the
 * first character behind it, or text if there is no number.  Hexadecimal digits, "inf" and "nan"
 * are not numbers here. */
double ss_number_parse(const char *text, char **end);

SS_END_DECLARATIONS
#endif
