/* format.c -- the list of formats, and the choice among them. */
#include "io/format.h"

#include <string.h>
#include "base/error.h"

#define ROW(name) &ss_format_##name,
static const struct format *const list[FORMATS] = { FORMAT_LIST(ROW) };
enum { LONGEST_MAGIC = 12 };

static int
begins(const char *bytes, size_t n, const char *magic)
{
    size_t i = 0;
    while (i < n && magic[i] != '\0' && (magic[i] == '?' || magic[i] == bytes[i]))
        i++;
    return magic[i] == '\0';
}

/* Files of other programs that users often try are named. */
ss_status
ss_format_open(ss_source **out, const struct opening *o, ss_error *err)
{
    struct input *in = o->in;
    ss_status st = ss_input_need(in, LONGEST_MAGIC, err);
    const char *p = in->buffer + in->lo;
    size_t n = in->hi - in->lo;
    const struct format *found = NULL;
    if (st == SS_OK && n == 0)
        st = ss_fail(err, SS_EDATA, "%s: empty", in->name);
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < FORMATS && (found == NULL || found->magic == NULL); i++)
        if (list[i]->magic == NULL ? list[i]->open != NULL : begins(p, n, list[i]->magic))
            found = list[i];
    if (found->open == NULL)
        return ss_fail(err, SS_EDATA, "%s: HDF5 cannot be read from a stream; give its path", in->name);
    int fits = found->has_header || o->kind == SS_KIND_SIGNAL;
    if ((found->magic == NULL || !fits) && ss_fail_kind(err, in->name, p, n, o->kind) != SS_OK)
        return SS_EKIND;
    return fits ? found->open(out, o, err) : ss_fail_magic(err, in->name, "", o->kind);
}

const struct format *
ss_format_of_file(const char *path)
{
    for (size_t i = 0; i < FORMATS; i++)
        if (list[i]->is_file != NULL && list[i]->is_file(path))
            return list[i];
    return NULL;
}

const struct format *
ss_format_table(ss_format of)
{
    return (unsigned)of < FORMATS && list[of]->begin != NULL ? list[of] : NULL;
}

int
ss_format_at(ss_format_info *out, size_t i)
{
    for (size_t k = 0; out != NULL && k < FORMATS; k++)
        if (list[k]->begin != NULL && i-- == 0) {
            *out = (ss_format_info){ (ss_format)k, list[k]->name, list[k]->separator != '\0' };
            return 1;
        }
    return 0;
}
