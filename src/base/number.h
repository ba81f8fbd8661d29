/* number.h -- numbers with a decimal comma, and without one. */
#ifndef NUMBER_H
#define NUMBER_H

#include <stdarg.h>
#include <stdio.h>
#include "base/error.h"

/* printf, snprintf and vsnprintf with a point in every number, whatever the locale of the program. */
SS_PRINTF(2, 3)
int ss_print(FILE *out, const char *format, ...);
SS_PRINTF(3, 4)
int ss_print_to(char *text, size_t size, const char *format, ...);
SS_PRINTF(3, 0)
int ss_print_text(char *text, size_t size, const char *format, va_list args);

#endif
