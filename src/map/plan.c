/* plan.c -- a plan: the grid of a record, and the engine of each scale. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "map/fft/blocks.h"
#include "map/plan.h"

enum { PART = 1 << 14 };        /* coefficients by the definition, computed at a time */

ss_status
ss_morlet_new(ss_morlet **out, size_t n, double rate, const ss_morlet_opts *given, ss_error *err)
{
    ss_morlet_opts opts;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_morlet_take(&opts, given, err);
    if (st == SS_OK)
        st = ss_morlet_check(n, rate, &opts, err);
    if (st != SS_OK)
        return st;
    ss_morlet *plan = calloc(1, sizeof *plan);
    if (plan == NULL)
        return SS_ENOMEM;
    *plan = (ss_morlet){ .opts = opts, .n = n, .rate = rate };
    st = ss_grid_make(&plan->scale, &plan->n_scales, n, rate, &opts, err);
    for (size_t i = 0; st == SS_OK && i < plan->n_scales; i++) {
        plan->scale[i].offset = plan->total;
        plan->total += plan->scale[i].n;
        if (plan->total > SIZE_MAX / (2 * sizeof(double)))
            st = SS_ENOMEM;
    }
    if (st == SS_OK)
        st = ss_blocks_new(plan);
    if (st != SS_OK) {
        ss_morlet_free(plan);
        return st;
    }
    for (size_t i = 0; i < plan->n_scales; i++)
        plan->scale[i].engine = ss_blocks_covers(plan->blocks, i) ? SS_ENGINE_FFT : SS_ENGINE_QUADRATURE;
    plan->grid = (ss_grid){ plan->n_scales, plan->scale, plan->total };
    *out = plan;
    return SS_OK;
}

const ss_grid *
ss_morlet_grid(const ss_morlet *plan)
{
    return plan != NULL ? &plan->grid : NULL;
}

void
ss_morlet_free(ss_morlet *plan)
{
    if (plan == NULL)
        return;
    for (size_t i = 0; plan->wave != NULL && i < plan->n_scales; i++)
        ss_wavelet_free(plan->wave[i]);
    ss_blocks_free(plan->blocks);
    free(plan->wave);
    free(plan->scale);
    free(plan);
}

/* --- what execution needs ----------------------------------------------------------------------- */

ss_status
ss_morlet_keep_wavelets(ss_morlet *plan)
{
    plan->wave = calloc(plan->n_scales, sizeof(wavelet *));
    for (size_t i = 0; plan->wave != NULL && i < plan->n_scales; i++)
        if (!ss_blocks_covers(plan->blocks, i)
            && (plan->wave[i] = ss_wavelet_new(&plan->opts, plan->scale[i].a, plan->rate, plan->n)) == NULL)
            return SS_ENOMEM;
    return plan->wave != NULL ? SS_OK : SS_ENOMEM;
}

ss_status
ss_morlet_part(const ss_morlet *plan, const transformed *of, double *scratch, const ss_map_part *part,
               ss_error *err)
{
    const ss_scale *scale = &plan->scale[part->scale];
    const span range = { part->first, part->n };
    double factor = plan->opts.norm == SS_NORM_L1 ? 1 : sqrt(scale->a), *w = part->w;
    factor = ldexp(factor, of->rec.exponent);
    int fits = factor > 1e-250 && factor < 1e300;   /* |W| is below 4 in these units */
    factor = fits ? factor : 1;
    if (ss_blocks_covers(plan->blocks, part->scale))
        ss_blocks_scale(plan->blocks, part->scale, &of->spectra, scratch, range, factor, w);
    else {
        wavelet *own = NULL;
        const wavelet *wave = plan->wave != NULL ? plan->wave[part->scale] : NULL;
        if (wave == NULL && (wave = own = ss_wavelet_new(&plan->opts, scale->a, plan->rate, plan->n)) == NULL)
            return SS_ENOMEM;
        for (size_t k = 0; k < part->n; k++) {
            ss_wavelet_sum(wave, &of->rec, ss_scale_spot(scale, part->first + k, plan->rate), w + 2 * k);
            w[2 * k] *= factor;
            w[2 * k + 1] *= factor;
        }
        ss_wavelet_free(own);
    }
    return fits ? SS_OK : ss_morlet_finish(w, part->n, scale->a, plan->opts.norm, of->rec.exponent, err);
}

size_t
ss_morlet_part_length(const ss_morlet *plan, size_t i, size_t k)
{
    return ss_blocks_covers(plan->blocks, i) ? ss_blocks_rest(plan->blocks, i, k) : PART;
}

size_t
ss_morlet_part_most(const ss_morlet *plan)
{
    size_t most = PART;
    for (size_t i = 0; i < plan->n_scales; i++)
        if (ss_blocks_covers(plan->blocks, i) && ss_blocks_most(plan->blocks, i) > most)
            most = ss_blocks_most(plan->blocks, i);
    return most;
}
