/* compare.c -- compare coefficients with those of the definition: the sum in full, at a few random translations of
 * each scale. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "map/plan.h"

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

ss_status
ss_morlet_compare(const ss_morlet *plan, const double *x, const double *w, size_t each,
                  double *difference, ss_error *err)
{
    if (plan == NULL || x == NULL || w == NULL || difference == NULL)
        return SS_FAIL_NULL(err);
    if (each < 1 || each > 1000000)
        return ss_fail(err, SS_EINVAL, "%zu coefficients a scale are out of range 1 ... 1e6", each);
    record rec = { .x = NULL };
    uint64_t state = 1;
    double worst = 0, *want = malloc(2 * each * sizeof *want);
    size_t *k = malloc(each * sizeof *k);
    ss_status st = k != NULL && want != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK)
        st = ss_morlet_record(&rec, x, plan->n, plan->opts.detrend, err);
    for (const ss_scale *scale = plan->scale; st == SS_OK && scale < plan->scale + plan->n_scales; scale++) {
        const double *of = w + 2 * scale->offset;
        double most = 0;
        for (size_t c = 0; c < each; c++)
            k[c] = (size_t)(draw(&state) % scale->n);
        st = ss_morlet_points(plan, scale, &rec, k, each, want, err);
        for (size_t c = 0; c < scale->n; c++)
            most = fmax(most, hypot(of[2 * c], of[2 * c + 1]));
        for (size_t c = 0; st == SS_OK && most > 0 && c < each; c++) {
            const double *got = of + 2 * k[c];
            worst = fmax(worst, hypot(got[0] - want[2 * c], got[1] - want[2 * c + 1]) / most);
        }
    }
    if (st == SS_OK)
        *difference = worst;
    free(rec.x);
    free(k);
    free(want);
    return st;
}
