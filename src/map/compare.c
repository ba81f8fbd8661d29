/* compare.c -- compare coefficients with those of another engine.
 *
 * Scales that were computed by FFT are computed again by the definition, at a few random
 * translations.  Scales that were computed by the definition are computed again by FFT, as a whole,
 * if that is possible. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "map/plan.h"

typedef struct compare {
    const ss_morlet *plan;
    ss_morlet *other;                   /* the same grid by FFT alone */
    transformed of;
    double *row;                        /* room for a scale by FFT */
    size_t each;                        /* coefficients of a scale */
    double *want;
    size_t *k;
    uint64_t state;
} compare;

/* The next pseudo-random number, by Vigna's splitmix64. */
static uint64_t
draw(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* 1 if the plan computes scale i by the definition, but FFTs could compute it. */
static int
only_by_sum(const compare *cmp, size_t i)
{
    return cmp->plan->scale[i].engine == SS_ENGINE_QUADRATURE
        && cmp->other->scale[i].engine == SS_ENGINE_FFT;
}

static ss_status
recompute(compare *cmp, size_t i, ss_error *err)
{
    const ss_scale *scale = &cmp->plan->scale[i];
    if (!only_by_sum(cmp, i)) {
        ss_status st = ss_quadrature_points(cmp->plan, scale, &cmp->of.rec, cmp->k, cmp->each,
                                            cmp->want);
        return st != SS_OK ? st : ss_morlet_finish(cmp->want, cmp->each, scale->a,
                                                   cmp->plan->opts.norm, cmp->of.rec.exponent, err);
    }
    const ss_map_part row = { i, 0, scale->n, cmp->row, NULL };
    ss_status st = ss_morlet_parts(cmp->other, &cmp->of, &row, 1, NULL, err);
    for (size_t c = 0; c < cmp->each; c++) {
        cmp->want[2 * c] = cmp->row[2 * cmp->k[c]];
        cmp->want[2 * c + 1] = cmp->row[2 * cmp->k[c] + 1];
    }
    return st;
}

/* The largest difference of a scale relative to its largest |W|. */
static ss_status
compare_scale(compare *cmp, size_t i, const double *w, double *worst, ss_error *err)
{
    const ss_scale *scale = &cmp->plan->scale[i];
    double most = 0;
    for (size_t c = 0; c < cmp->each; c++)
        cmp->k[c] = (size_t)(draw(&cmp->state) % scale->n);
    ss_status st = recompute(cmp, i, err);
    w += 2 * scale->offset;
    for (size_t c = 0; c < scale->n; c++)
        most = fmax(most, hypot(w[2 * c], w[2 * c + 1]));
    for (size_t c = 0; st == SS_OK && most > 0 && c < cmp->each; c++) {
        const double *got = w + 2 * cmp->k[c], *want = cmp->want + 2 * c;
        *worst = fmax(*worst, hypot(got[0] - want[0], got[1] - want[1]) / most);
    }
    return st;
}

static ss_status
prepare(compare *cmp, ss_error *err)
{
    const ss_morlet *plan = cmp->plan;
    ss_morlet_opts opts = plan->opts;
    size_t longest = 0;
    opts.engine = SS_ENGINE_FFT;
    ss_status st = ss_morlet_new(&cmp->other, plan->n, plan->rate, &opts, err);
    if (st != SS_OK)
        return st;
    cmp->k = malloc(cmp->each * sizeof *cmp->k);
    cmp->want = malloc(2 * cmp->each * sizeof *cmp->want);
    if (cmp->k == NULL || cmp->want == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < plan->n_scales; i++)
        if (only_by_sum(cmp, i) && plan->scale[i].n > longest)
            longest = plan->scale[i].n;
    cmp->row = malloc((2 * longest + 1) * sizeof *cmp->row);
    return cmp->row != NULL ? SS_OK : SS_ENOMEM;
}

ss_status
ss_morlet_compare(const ss_morlet *plan, const double *x, const double *w, size_t each,
                  double *difference, ss_error *err)
{
    if (plan == NULL || x == NULL || w == NULL || difference == NULL)
        return SS_FAIL_NULL(err);
    compare cmp = { .plan = plan, .each = each, .state = 1 };
    double worst = 0;
    if (each < 1 || each > 1000000)
        return ss_fail(err, SS_EINVAL, "%zu coefficients a scale are out of range 1 ... 1e6", each);
    ss_status st = prepare(&cmp, err);
    if (st == SS_OK)
        st = ss_morlet_begin(cmp.other, x, &cmp.of, err);
    for (size_t i = 0; st == SS_OK && i < plan->n_scales; i++)
        st = compare_scale(&cmp, i, w, &worst, err);
    if (st == SS_OK)
        *difference = worst;
    ss_morlet_end(&cmp.of);
    free(cmp.row);
    free(cmp.k);
    free(cmp.want);
    ss_morlet_free(cmp.other);
    return st;
}
