/* map.c -- see map.h: maps in memory, and maps that are computed where they are read. */
#include <stdlib.h>
#include "base/error.h"
#include "base/progress.h"
#include "map/map.h"
#include "map/plan.h"

ss_status
ss_map_read(const ss_coefficients *map, const ss_map_part part[], size_t n, ss_error *err)
{
    if (map == NULL || (part == NULL && n > 0))
        return SS_FAIL_NULL(err);
    if (map->w == NULL && map->source == NULL)
        return ss_fail(err, SS_EINVAL, "a map without coefficients, and no source of them");
    for (size_t i = 0; i < n; i++) {
        const ss_map_part *p = &part[i];
        size_t have = p->scale < map->n_scales ? map->scale[p->scale].n : 0;
        if (p->first > have || p->n > have - p->first || (p->n > 0 && (p->w == NULL) == (p->level == NULL)))
            return ss_fail(err, SS_EINVAL, "the map has no %zu coefficients from number %zu of scale %zu on",
                           p->n, p->first, p->scale);
    }
    if (map->w == NULL)
        return map->source->read(map, part, n, err);
    for (size_t i = 0; i < n; i++)
        ss_map_give(&part[i], 0, part[i].n, map->w + 2 * (map->scale[part[i].scale].offset + part[i].first));
    return SS_OK;
}

double
ss_coefficients_max(const ss_coefficients *map)
{
    enum { PIECE = 512 };
    double outside = -1, all = 0, level[PIECE];
    for (size_t i = 0; map != NULL && i < map->n_scales; i++)
        for (size_t k = 0, n; k < map->scale[i].n; k += n) {
            n = map->scale[i].n - k < PIECE ? map->scale[i].n - k : PIECE;
            if (ss_map_read(map, &(ss_map_part){ i, k, n, NULL, level }, 1, NULL) != SS_OK)
                return NAN;
            for (size_t c = 0; c < n; c++) {
                all = fmax(all, level[c]);
                if (level[c] > outside && !ss_coefficients_edge(map, i, k + c))
                    outside = level[c];
            }
        }
    return map == NULL ? NAN : outside >= 0 ? outside : all;
}

/* --- computed where it is read ------------------------------------------------------------------ */

typedef struct computed {
    ss_map_source source;               /* must be the first member */
    ss_morlet *plan;
    transformed of;
} computed;

static ss_status
compute(const ss_coefficients *map, const ss_map_part part[], size_t n, ss_error *err)
{
    const computed *c = (const computed *)map->source;
    return ss_morlet_parts(c->plan, &c->of, part, n, NULL, err);
}

static void
computed_free(ss_map_source *source)
{
    computed *c = (computed *)source;
    ss_morlet_end(&c->of);
    ss_morlet_free(c->plan);
    free(c);
}

ss_status
ss_map_plan(ss_coefficients **out, const ss_signal *signal, size_t column, size_t n, double rate,
            const ss_morlet_opts *opts, ss_error *err)
{
    computed *c = calloc(1, sizeof *c);
    ss_coefficients *map = NULL;
    if (c == NULL)
        return SS_ENOMEM;
    c->source = (ss_map_source){ compute, computed_free };
    ss_status st = ss_morlet_new(&c->plan, n, rate, opts, err);
    if (st == SS_OK)
        st = ss_morlet_grid_of(&map, signal, column, c->plan, opts);
    if (st == SS_OK) {
        map->source = &c->source;
        *out = map;
        return SS_OK;
    }
    ss_coefficients_free(map);
    computed_free(&c->source);
    return st;
}

ss_status
ss_map_begin(ss_coefficients *map, const double *x, ss_error *err)
{
    computed *c = (computed *)map->source;
    return ss_morlet_begin(c->plan, x, &c->of, err);
}

ss_status
ss_map_of_samples(ss_coefficients **out, const double *x, size_t n, double rate,
                  const ss_morlet_opts *opts, ss_error *err)
{
    ss_status st = ss_map_plan(out, NULL, 0, n, rate, opts, err);
    if (st != SS_OK || (st = ss_map_begin(*out, x, err)) == SS_OK)
        return st;
    ss_coefficients_free(*out);
    *out = NULL;
    return st;
}

ss_status
ss_map_progress(const ss_coefficients *map, double done)
{
    if (map->source == NULL || map->source->read != compute)
        return SS_OK;
    return ss_progress_at(&((const computed *)map->source)->plan->opts.progress, done);
}
