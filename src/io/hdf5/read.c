/* read.c -- the coefficients in a file, as a map. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "io/hdf5/groups.h"
#include "map/map.h"

/* The source of a map that lies in a file. */
typedef struct file_source {
    ss_map_source source;               /* must be the first member */
    h5_file file;
    char *path;
    ss_error error;
    wavelet_reader wavelet;
    size_t longest;                     /* coefficients of a scale */
    double *w;                          /* those of scale `held`; NULL: of none yet */
    size_t held;
} file_source;

static void
close_file(ss_map_source *source)
{
    file_source *s = (file_source *)source;
    QUIETLY(
        ss_wavelet_reader_close(&s->wavelet);
        ss_h5_close(&s->file);
    );
    free(s->path);
    free(s->w);
    free(s);
}

/* HDF5 takes as long for a part of a scale as for all of it: the last one is kept. */
static ss_status
read_parts(const ss_coefficients *map, const ss_map_part part[], size_t n, ss_error *err)
{
    file_source *s = (file_source *)map->source;
    ss_status status = SS_OK;
    for (size_t i = 0; status == SS_OK && i < n; i++) {
        size_t scale = part[i].scale;
        int all = part[i].w != NULL && part[i].n == map->scale[scale].n;
        if (!all && s->w == NULL && (s->w = malloc(2 * s->longest * sizeof *s->w)) == NULL)
            return ss_fail_memory(err, s->path);
        double *whole = all ? part[i].w : s->w;
        if (all || s->held != scale)
            QUIETLY(
                status = ss_wavelet_reader_scale(&s->wavelet, map, scale, whole);
            );
        if (!all)
            s->held = status == SS_OK ? scale : SIZE_MAX;
        if (status == SS_OK && !all)
            ss_map_give(&part[i], 0, part[i].n, s->w + 2 * part[i].first);
    }
    if (status != SS_OK && err != NULL)
        *err = s->error;
    return status;
}

ss_status
ss_h5_open_coefficients(ss_coefficients **out, const char *path, ss_error *err)
{
    ss_coefficients *map = calloc(1, sizeof *map);
    file_source *s = calloc(1, sizeof *s);
    ss_status status = SS_ENOMEM;
    if (s != NULL)
        *s = (file_source){ .source = { read_parts, close_file }, .held = SIZE_MAX, .path = strdup(path),
                            .wavelet = { .group = -1, .part = { -1, -1 } } };
    if (s != NULL)
        s->file = (h5_file){ .id = -1, .path = s->path, .err = &s->error };
    if (map != NULL && s != NULL && s->path != NULL)
        QUIETLY(
            if ((status = ss_h5_open(&s->file)) == SS_OK)
                status = ss_wavelet_reader_open(&s->wavelet, &s->file, map);
        );
    for (size_t i = 0; status == SS_OK && i < map->n_scales; i++)
        s->longest = map->scale[i].n > s->longest ? map->scale[i].n : s->longest;
    if (status == SS_ENOMEM)
        ss_fail(err, status, "%s: %s", path, ss_strerror(status));
    else if (status != SS_OK && err != NULL)
        *err = s->error;
    if (map != NULL && s != NULL)
        map->source = &s->source;
    else if (s != NULL)
        close_file(&s->source);
    if (status == SS_OK)
        *out = map;
    else
        ss_coefficients_free(map);
    return status;
}
