/* number.h -- numbers with a decimal comma. */
#ifndef NUMBER_H
#define NUMBER_H

/* As ss_number_parse, with this decimal point; NaN for the few numbers that then need strtod. */
double ss_number_parse_point(const char *text, char point, char **end);

#endif
