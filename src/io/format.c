/* format.c -- the list of formats. */
#include <string.h>
#include "io/format.h"

#define ROW(name) &ss_format_##name,
static const struct format *const list[] = { FORMAT_LIST(ROW) };
enum { FORMATS = sizeof list / sizeof *list };

const struct format *
ss_format_table(ss_format of)
{
    return (unsigned)of < FORMATS && list[of]->begin != NULL ? list[of] : NULL;
}

static int
begins(const char *bytes, size_t n, const char *magic)
{
    size_t i;
    for (i = 0; i < n && magic[i] != '\0' && (magic[i] == '?' || magic[i] == bytes[i]); i++)
        ;
    return magic[i] == '\0';
}

int
ss_format_has_words(ss_format of)
{
    const struct format *table = ss_format_table(of);
    return table != NULL && table->separator != '\0';
}

const struct format *
ss_format_of_bytes(const char *bytes, size_t n)
{
    const struct format *any = NULL;
    for (size_t i = 0; i < FORMATS; i++)
        if (list[i]->magic == NULL)
            any = list[i];
        else if (begins(bytes, n, list[i]->magic))
            return list[i];
    return any;
}

/* --- by name ------------------------------------------------------------------------------- */

const char *
ss_format_name(size_t i)
{
    for (size_t k = 0; k < FORMATS; k++)
        if (list[k]->begin != NULL && i-- == 0)
            return list[k]->name;
    return NULL;
}

int
ss_format_find(ss_format *found, const char *name)
{
    for (size_t i = 0; found != NULL && name != NULL && i < FORMATS; i++)
        if (list[i]->begin != NULL && strcmp(list[i]->name, name) == 0) {
            *found = (ss_format)i;
            return 1;
        }
    return 0;
}
