/* coefficients.c -- coefficients with their grid and the notes that say it; see map.h: maps in memory, and maps
 * that are computed where they are read. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/progress.h"
#include "map/plan.h"
#include "signal/gaps.h"
#include "signal/header.h"

static const char *const norm_name[] = { "l2", "l1" };
static const char *const engine_name[] = { "auto", "quadrature", "fft" };
static const char *const detrend_name[] = { "none", "mean", "linear" };

void
ss_coefficients_free(ss_coefficients *map)
{
    if (map == NULL)
        return;
    if (map->source != NULL)
        map->source->free(map->source);
    ss_header_free(map->head);
    free(map->scale);
    free(map->w);
    free(map->gap);
    free(map);
}

int
ss_coefficients_edge(const ss_coefficients *map, size_t i, size_t k)
{
    return wavelet_edge(&map->scale[i], k, map->n, map->head->rate, map->head->start, map->gap, map->n_gaps);
}

static ss_status
note_number(ss_header *head, const char *key, double value)
{
    char text[SS_NUMBER_MAX];
    ss_number_format(text, value);
    return ss_header_note(head, key, text, NULL);
}

const char *const ss_coefficient_notes[] = {
    "samples", "stream", "column", "unit", "center", "voices", "dense", "step", "lattice", "norm", "admissible",
    "detrend", "accuracy", "rounded", "method", "label", NULL };

static ss_status
note_options(ss_header *head, size_t n, const ss_morlet_opts *opts)
{
    const ss_column *col = &head->column[0];
    int failed = (n > 0 ? note_number(head, "samples", (double)n)
                        : ss_header_note(head, "stream", "yes", NULL))
        || ss_header_note(head, "column", col->name, NULL)
        || (col->unit[0] != '\0' && ss_header_note(head, "unit", col->unit, NULL))
        || note_number(head, "center", opts->center) || note_number(head, "voices", opts->voices)
        || (opts->dense ? ss_header_note(head, "dense", "yes", NULL)
                        : note_number(head, "step", opts->step))
        || (!opts->dense && !opts->exact && opts->step <= 1
            && ss_header_note(head, "lattice", SS_LATTICE, NULL))
        || ss_header_note(head, "norm", norm_name[opts->norm], NULL)
        || ss_header_note(head, "admissible", opts->admissible ? "yes" : "no", NULL)
        || ss_header_note(head, "detrend", detrend_name[opts->detrend], NULL)
        || note_number(head, "accuracy", opts->accuracy)
        || (opts->rounded && ss_header_note(head, "rounded", "yes", NULL))
        || ss_header_note(head, "method", engine_name[opts->engine], NULL)
        || ss_header_note(head, "label", "f = center / (2 pi a)", NULL);
    return failed ? SS_ENOMEM : SS_OK;
}

static int
says_yes(const ss_header *head, const char *key)
{
    const char *value = ss_header_find_note(head, key);
    return value != NULL && strcmp(value, "yes") == 0;
}

/* The number in a note, more than 0 and at most `most`. */
static ss_status
read_number(const ss_header *head, const char *key, double most, double *x, ss_error *err)
{
    const char *value = ss_header_find_note(head, key);
    char *end;
    if (value == NULL || *value == '\0')
        return ss_fail(err, SS_EDATA, "the coefficients lack their option '%s'", key);
    *x = ss_number_parse(value, &end);
    return end > value && *end == '\0' && *x > 0 && *x <= most ? SS_OK
        : ss_fail(err, SS_EDATA, "the option '%s: %s' is out of range", key, value);
}

ss_status
ss_morlet_opts_of_notes(ss_morlet_opts *opts, size_t *samples, const ss_header *head, ss_error *err)
{
    const char *norm = ss_header_find_note(head, "norm");
    double n = 0, voices;
    *opts = ss_morlet_defaults;
    opts->dense = says_yes(head, "dense");
    opts->exact = ss_header_find_note(head, "lattice") == NULL;
    opts->norm = norm != NULL && strcmp(norm, norm_name[SS_NORM_L1]) == 0 ? SS_NORM_L1 : SS_NORM_L2;
    opts->admissible = says_yes(head, "admissible");
    ss_status st = read_number(head, "voices", ss_morlet_ranges.voices.to, &voices, err);
    if (st == SS_OK)
        st = read_number(head, "center", ss_morlet_ranges.center.to, &opts->center, err);
    if (st == SS_OK && !opts->dense)
        st = read_number(head, "step", 1e100, &opts->step, err);
    if (st == SS_OK && (ss_header_find_note(head, "samples") != NULL || !says_yes(head, "stream")))
        st = read_number(head, "samples", 0x1p53, &n, err);
    if (st != SS_OK)
        return st;
    if (n != floor(n) || voices != floor(voices))
        return ss_fail(err, SS_EDATA, "samples and voices are not whole numbers");
    *samples = (size_t)n;
    opts->voices = (int)voices;
    return SS_OK;
}

ss_status
ss_coefficients_take_notes(ss_coefficients *map, ss_morlet_opts *opts, ss_error *err)
{
    const char *column = ss_header_find_note(map->head, "column"), *unit = ss_header_find_note(map->head, "unit");
    ss_status st = ss_morlet_opts_of_notes(opts, &map->n, map->head, err);
    if (st == SS_OK && (column == NULL || *column == '\0'))
        st = ss_fail(err, SS_EDATA, "the coefficients lack their option 'column'");
    if (st == SS_OK && ss_morlet_check(map->n > 0 ? map->n : 1, map->head->rate, opts, err) != SS_OK)
        st = SS_EDATA;
    if (st == SS_OK)
        st = ss_header_gaps(&map->gap, &map->n_gaps, map->head, err);
    map->center = opts->center;
    return st == SS_OK ? ss_header_add_column(map->head, column, unit, err) : st;
}

ss_status
ss_coefficients_header(ss_header **out, const ss_header *signal, size_t column, size_t n,
                       const ss_morlet_opts *given, ss_error *err)
{
    ss_morlet_opts opts;
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    ss_status st = ss_morlet_take(&opts, given, err);
    if (st == SS_OK)
        st = ss_morlet_check(n > 0 ? n : 1, signal->rate, &opts, err);
    if (st == SS_OK)
        st = ss_header_select(out, signal, &column, 1, 0, err);
    if (st != SS_OK)
        return st;
    ss_header_forget(*out, ss_coefficient_notes);
    if (note_options(*out, n, &opts) == SS_OK)
        return SS_OK;
    ss_header_free(*out);
    *out = NULL;
    return ss_fail_memory(err, NULL);
}

/* --- reading a map ------------------------------------------------------------------------------ */

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
    ss_coefficients *map = calloc(1, sizeof *map);
    if (c == NULL || map == NULL) {
        free(c);
        free(map);
        return SS_ENOMEM;
    }
    c->source = (ss_map_source){ compute, computed_free };
    *map = (ss_coefficients){ .source = &c->source, .n = n, .center = opts->center };
    ss_status st = ss_morlet_new(&c->plan, n, rate, opts, err);
    if (st == SS_OK && signal != NULL)
        st = ss_coefficients_header(&map->head, signal->head, column, signal->n, opts, NULL);
    if (st == SS_OK && signal != NULL)
        st = ss_header_gaps(&map->gap, &map->n_gaps, map->head, NULL);
    if (st == SS_OK && (map->scale = malloc(c->plan->n_scales * sizeof *map->scale)) == NULL)
        st = SS_ENOMEM;
    if (st != SS_OK) {
        ss_coefficients_free(map);
        return st;
    }
    map->n_scales = c->plan->n_scales;
    memcpy(map->scale, c->plan->scale, map->n_scales * sizeof *map->scale);
    *out = map;
    return SS_OK;
}

ss_status
ss_morlet_transform(ss_coefficients **out, const ss_signal *signal, size_t column, const ss_morlet_opts *given,
                    ss_error *err)
{
    ss_morlet_opts opts;
    ss_coefficients *map = NULL;
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    if (column >= signal->head->n_columns)
        return ss_fail_column(err, column, signal->head->n_columns);
    ss_status st = ss_morlet_take(&opts, given, err);
    if (st == SS_OK)
        st = ss_map_plan(&map, signal, column, signal->n, signal->head->rate, &opts, err);
    if (st != SS_OK)
        return st;
    const ss_morlet *plan = ((const computed *)map->source)->plan;
    map->w = malloc(2 * plan->total * sizeof *map->w);
    st = map->w != NULL ? ss_morlet_execute(plan, signal->values + column * signal->n, map->w, err) : SS_ENOMEM;
    map->source->free(map->source);
    map->source = NULL;
    if (st == SS_OK)
        *out = map;
    else
        ss_coefficients_free(map);
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
