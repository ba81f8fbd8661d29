/* utf8.h -- text as UTF-8. */
#ifndef UTF8_H
#define UTF8_H

#include <stddef.h>

/* Bytes of the UTF-8 character at the start of text; 0 if there is none. */
size_t ss_utf8_length(const char *text);
/* Bytes of what stands at the start of text, a character or an invalid byte, not 0; is it a control
 * character, of ASCII or U+0080 to U+009F, or a byte that is one in Latin-1? */
size_t ss_utf8_next(const char *text, int *is_control);
/* A copy to be freed, or NULL if there is no memory: text that is not valid UTF-8 is converted from
 * Latin-1, in which older systems export. */
char *ss_utf8_text(const char *text);

#endif
