/* format.c -- the list of formats, and the choice among them; HDF5 as a format, without the HDF5 library, which
 * only the functions of ss_store_calls need. */
#include "io/format.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
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

/* --- HDF5 ---------------------------------------------------------------------------------- */

/* The signature is at byte 0, 512, 1024, ... */
static int
is_hdf5(const char *path)
{
    static const char signature[8] = "\211HDF\r\n\032\n";
    char bytes[8];
    struct stat st;
    int found = 0;
    if (stat(path, &st) != 0 || !S_ISREG(st.st_mode))   /* a FIFO must not lose its first bytes */
        return 0;
    FILE *in = fopen(path, "rb");
    if (in == NULL)
        return 0;
    for (off_t at = 0; !found && at <= st.st_size - 8; at = at > 0 ? 2 * at : 512)
        found = fseeko(in, at, SEEK_SET) == 0 && fread(bytes, 1, 8, in) == 8
                && memcmp(bytes, signature, 8) == 0;
    fclose(in);
    return found;
}

static ss_status
open_signal(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts, ss_error *err)
{
    const struct ss_store_calls *hdf5 = ss_store_calls(err);
    return hdf5 != NULL ? hdf5->open_signal(out, path, dataset, opts, err) : SS_EIO;
}

static ss_status
open_map(ss_coefficients **out, const char *path, ss_error *err)
{
    const struct ss_store_calls *hdf5 = ss_store_calls(err);
    return hdf5 != NULL ? hdf5->open_coefficients(out, path, err) : SS_EIO;
}

FORMAT(hdf5) = {
    .name = "h5", .magic = "\211HDF", .is_file = is_hdf5, .open_file = open_signal, .open_map = open_map
};
