/* utf8.c -- text as UTF-8 (RFC 3629: no overlong forms, no surrogates). */
#include "base/utf8.h"

#include <stdlib.h>
#include <string.h>

size_t
ss_utf8_length(const char *text)
{
    const unsigned char *p = (const unsigned char *)text;
    size_t n = p[0] < 0x80 ? 1 : p[0] < 0xc2 ? 0 : p[0] < 0xe0 ? 2 : p[0] < 0xf0 ? 3
             : p[0] < 0xf5 ? 4 : 0;
    for (size_t i = 1; i < n; i++)
        if ((p[i] & 0xc0) != 0x80)
            return 0;
    if ((p[0] == 0xe0 && p[1] < 0xa0) || (p[0] == 0xed && p[1] >= 0xa0)
        || (p[0] == 0xf0 && p[1] < 0x90) || (p[0] == 0xf4 && p[1] >= 0x90))
        return 0;                               /* too long for its value, or not a character */
    return n;
}

size_t
ss_utf8_next(const char *text, int *is_control)
{
    const unsigned char *p = (const unsigned char *)text;
    size_t n = ss_utf8_length(text);
    unsigned c = n == 2 ? (p[0] & 0x1fu) << 6 | (p[1] & 0x3fu) : p[0];
    *is_control = n < 3 && (c < ' ' || (c >= 0x7f && c < 0xa0));
    return n > 0 ? n : 1;
}

char *
ss_utf8_text(const char *text)
{
    const char *end = text;
    size_t n = 0;
    while (*end != '\0' && (n = ss_utf8_length(end)) > 0)
        end += n;
    if (*end == '\0')
        return strdup(text);
    char *copy = malloc(2 * strlen(text) + 1), *to = copy;
    for (const unsigned char *p = (const unsigned char *)text; copy != NULL && *p != '\0'; p++)
        if (*p < 0x80)
            *to++ = (char)*p;
        else {
            *to++ = (char)(0xc0 | *p >> 6);
            *to++ = (char)(0x80 | (*p & 0x3f));
        }
    if (copy != NULL)
        *to = '\0';
    return copy;
}
