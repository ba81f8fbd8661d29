/* compare.c -- compare coefficients with those of the definition: the sum in full, at a few random translations of
 * each scale. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "map/plan.h"

typedef struct compare {
    const ss_morlet *plan;
    record rec;
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

ss_status
ss_morlet_points(const ss_morlet *plan, const ss_scale *scale, const record *rec, const size_t k[], size_t n,
                 double *w, ss_error *err)
{
    wavelet *wave = ss_wavelet_new(&plan->opts, scale->a, plan->rate, rec->n);
    if (wave == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++)
        ss_wavelet_sum(wave, rec, ss_scale_spot(scale, k[i], plan->rate), w + 2 * i);
    ss_wavelet_free(wave);
    return ss_morlet_finish(w, n, scale->a, plan->opts.norm, rec->exponent, err);
}

/* The largest difference of a scale relative to its largest |W|. */
static ss_status
compare_scale(compare *cmp, size_t i, const double *w, double *worst, ss_error *err)
{
    const ss_scale *scale = &cmp->plan->scale[i];
    double most = 0;
    for (size_t c = 0; c < cmp->each; c++)
        cmp->k[c] = (size_t)(draw(&cmp->state) % scale->n);
    ss_status st = ss_morlet_points(cmp->plan, scale, &cmp->rec, cmp->k, cmp->each, cmp->want, err);
    w += 2 * scale->offset;
    for (size_t c = 0; c < scale->n; c++)
        most = fmax(most, hypot(w[2 * c], w[2 * c + 1]));
    for (size_t c = 0; st == SS_OK && most > 0 && c < cmp->each; c++) {
        const double *got = w + 2 * cmp->k[c], *want = cmp->want + 2 * c;
        *worst = fmax(*worst, hypot(got[0] - want[0], got[1] - want[1]) / most);
    }
    return st;
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
    cmp.k = malloc(each * sizeof *cmp.k);
    cmp.want = malloc(2 * each * sizeof *cmp.want);
    ss_status st = cmp.k != NULL && cmp.want != NULL
        ? ss_morlet_record(&cmp.rec, x, plan->n, plan->opts.detrend, err) : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < plan->n_scales; i++)
        st = compare_scale(&cmp, i, w, &worst, err);
    if (st == SS_OK)
        *difference = worst;
    free(cmp.rec.x);
    free(cmp.k);
    free(cmp.want);
    return st;
}
