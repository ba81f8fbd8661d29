/* load.c -- read the measured base of a scene. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <stickslip/scene.h>
#include "base/error.h"
#include "io/format.h"
#include "scene/model.h"
#include "scene/scene.h"

/* POSIX's cksum: the CRC of the bytes and of their number, whose lowest byte comes first. */
static unsigned long
crc_further(unsigned long crc, unsigned long byte)
{
    crc ^= byte << 24;
    for (int i = 0; i < 8; i++)
        crc = (crc << 1 ^ (crc & 0x80000000 ? 0x04c11db7 : 0)) & 0xffffffff;
    return crc;
}

/* Write the checksum of a file to text. */
static ss_status
sum_file(char text[48], const char *file, ss_error *err)
{
    FILE *in = fopen(file, "rb");
    if (in == NULL)
        return ss_fail_errno(err, file, errno);
    unsigned long crc = 0;
    unsigned long long size = 0;
    for (int c; (c = getc(in)) != EOF; size++)
        crc = crc_further(crc, (unsigned long)c);
    int why = ferror(in) ? errno : 0;
    fclose(in);
    for (unsigned long long n = size; n > 0; n >>= 8)
        crc = crc_further(crc, (unsigned long)(n & 0xff));
    snprintf(text, 48, "%lu %llu", ~crc & 0xffffffff, size);
    return why == 0 ? SS_OK : ss_fail_errno(err, file, why);
}

static ss_status
load(ss_base **base, const char *path, const char *column, ss_error *err)
{
    ss_signal *signal = NULL;
    ss_base *b = NULL;
    ss_error why = { 0 };
    struct stat is;
    const char *place;
    char *file = ss_file_of(path, &place);
    if (file == NULL)
        return ss_fail_memory(err, path);
    int regular = stat(file, &is) != 0 || S_ISREG(is.st_mode) || S_ISDIR(is.st_mode); /* these fail when opened */
    ss_status st = regular ? ss_signal_read(&signal, NULL, path, NULL, err)     /* a pipe can be read only once */
        : ss_fail(err, SS_EDATA, "%s: not a regular file, which the motion of a base must be", path);
    int is_named = *column != '\0';
    const char *name = is_named ? column : "z";
    int c = st != SS_OK || (!is_named && signal->head->n_columns == 1) ? 0 : ss_header_column(signal->head, name);
    if (c < 0)
        st = ss_fail(err, SS_EDATA, "%s: no column '%s'", path, name);
    else if (st == SS_OK && (st = ss_base_new(&b, signal, (size_t)c, &why)) != SS_OK)
        ss_fail(err, st, "%s: %s", path, why.text);
    ss_signal_free(signal);
    if (st == SS_OK)
        st = sum_file(b->cksum, file, err);
    free(file);
    if (st == SS_OK)
        *base = b;
    else
        ss_base_free(b);
    return st;
}

ss_status
ss_base_load(ss_base **base, ss_scene *scene, const char *scene_path, ss_error *err)
{
    if (base == NULL || scene == NULL || scene_path == NULL)
        return SS_FAIL_NULL(err);
    const char *slash = strrchr(scene_path, '/');
    size_t folder = slash != NULL ? (size_t)(slash - scene_path) + 1 : 0;
    *base = NULL;
    if (*scene->base_file == '\0')
        return SS_OK;
    char *path = malloc(folder + sizeof scene->base_file);
    if (path == NULL)
        return ss_fail_memory(err, scene->base_file);
    memcpy(path, scene_path, folder);
    strcpy(path + folder, scene->base_file);
    ss_status st = load(base, path, scene->base_column, err);
    free(path);
    if (st == SS_OK)
        scene->base = *base;
    return st;
}
