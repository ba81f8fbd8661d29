/* utf8.h -- text as UTF-8. */
#ifndef UTF8_H
#define UTF8_H

#include <stddef.h>

/* Bytes of the UTF-8 character that text begins with; 0 if it begins with none. */
size_t ss_utf8_length(const char *text);
/* A copy to be freed, or NULL if there is no memory: text that is no valid UTF-8 is taken as Latin-1,
 * in which older systems export, and converted. */
char *ss_utf8_text(const char *text);

#endif
