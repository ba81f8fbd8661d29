/* blocks.c -- coefficients of a stepped grid by short FFTs, octave by octave.
 *
 * Level l of the record has one sample for 2^l of the record.  A scale is computed on the level on
 * which it is A to 2 A samples long; shorter scales are computed on level 0.  A = (omega_c + CUT)/BAND,
 * so that the band of a scale ends below BAND < 2 radians a sample.  A level is cut into windows of L
 * samples, a power of two.  X is the spectrum of a window.  By Poisson's sum, on the circle of a
 * window, in units of a^1/2,
 *     W(c) = C/L sum_k X_k exp(-v_k^2/2) exp(2 pi i k c/L),   v_k = 2 pi k a/L - omega_c,
 * for any place c in samples, with C = pi^-1/4 sqrt(2 pi).
 *
 * The grid's step is 2^p/m samples (grid.c), and 2^p divides L.  So the terms are folded modulo
 * M = L m/2^p, and one inverse FFT of M points gives W at all translations of the window without
 * interpolation.  Wavelets near the ends of a window reach beyond it, so the ends belong to its
 * neighbours: windows begin every hop = L - overlap samples, overlap >= 2 REACH 2 A.  2^p divides
 * overlap too, since it is at most m B_0 2 A <= 17 (2 A), so every window begins at a translation.
 * All FFTs stay in the cache.
 *
 * Translations of other grids lie between these points.  For them the terms are moved to frequency 0
 * and divided by the response of a kernel, M is the least power of two that the kernel needs, and
 * places.c finds W between the M points.
 *
 * The next level has the same spectrum times F(w) = erfc((w - pi/2)/(sqrt(2) s))/2, folded to L/2
 * terms, through an inverse FFT; s = (pi/2 - BAND/2)/FILTER_CUT, and F(w) + F(pi - w) = 1.
 *
 * The errors are, in units of a^1/2 max|x|, of which every accuracy allows 16 eps:
 *   - the cut of the series at |v| > CUT: at most 2.4 exp(-CUT^2/2) (1 + log(1 + L/(2 CUT a))), a in
 *     samples, from the size of the kernel's error near b and its decay, 1/|u|, away from it; below
 *     3 eps for L/a = 1000, for a step in the signal at the worst phase;
 *   - images, between points: twice IMAGES in place of the exponential, below 5 eps for L/a = 1000;
 *   - wavelets that reach around the circle: tail(REACH) of quadrature.c, below 1e-16;
 *   - the filter: below w = BAND/2, 1 - F is at most erfc(FILTER_CUT/sqrt 2)/2 = 5e-17, and so is
 *     F(pi - w), which multiplies the terms that fold there.  Its response in time,
 *     sin(pi n/2)/(pi n) exp(-(s n)^2/2), is cut at s n = REACH, where it is 2e-16/(pi n).  A level has
 *     REACH/s samples more than the record at either end, the reach of the filter: half of them are
 *     those that the level before had, and its filter adds the other half;
 *   - rounding: the FFT of a window, its filter and the inverse make noise in the next level's
 *     samples of rms some eps sqrt(log2 L) rms(x).  A wavelet of a samples averages it to 1/sqrt(a) of
 *     that, a >= A >= 5, and each filter halves the power of the noise of the levels before.
 * tests/test_morlet.c finds at most 1 eps.  So one method serves every accuracy, and no result needs to
 * be checked afterwards. */
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include "base/fft.h"
#include "map/fft/stage.h"

#define CUT 8.66
#define BAND 1.99
#define FILTER_CUT 8.3
#define IMAGES 5e-17            /* the bound of the images of an interpolation */
#define SHORTEST 0.5            /* samples: rounding is some 4 eps / a of a shorter scale */

enum {
    LEAST_SAMPLES = 4,          /* a level has at least so many */
    LONGEST = 1 << 20,          /* inverse FFT, in points */
    ALIGN = 8                   /* doubles; FFTW's plans are for arrays that begin at multiples */
};

/* --- the terms of the spectrum that a scale consists of ------------------------------------------- */

typedef struct band {
    double h, h_low;                /* v_k = k h - omega_c */
    ptrdiff_t lo, mid, hi;          /* k */
} band;

/* The distance from omega_c to either end of a band that has |v| <= CUT.  The admissible wavelet has a hump about
 * v = -omega_c, which must be inside, too. */
static double
half_width(const ss_morlet_opts *opts)
{
    const double center = opts->center;
    return opts->admissible && CUT > center ? center + sqrt(CUT * CUT - center * center) : CUT;
}

/* The terms of scale a on a level, in a window of so many samples.  h in two parts: k h is needed to the last bit
 * where k is large. */
static band
band_of(const ss_morlet *plan, double a, int level, size_t length)
{
    const double two_pi = 6.2831853071795865, two_pi_low = 2.4492935982947064e-16;
    double center = plan->opts.center, half = half_width(&plan->opts), rate = ldexp(plan->rate, -level);
    double p = a * rate, p_low = fma(a, rate, -p), points = (double)length;
    double s = two_pi * p, s_low = fma(two_pi, p, -s) + two_pi * p_low + two_pi_low * p;
    band b = { .h = s / points };
    b.h_low = (fma(-b.h, points, s) + s_low) / points;
    b.lo = (ptrdiff_t)ceil((center - half) / b.h);
    b.mid = (ptrdiff_t)rint(center / b.h);
    b.hi = (ptrdiff_t)floor((center + half) / b.h);
    return b;
}

/* --- which scales, in what windows ------------------------------------------------------------ */

/* A, the length in samples that a scale has at least on its level, unless this is level 0. */
static double
least_scale(const ss_morlet_opts *opts)
{
    return (opts->center + half_width(opts)) / BAND;
}

static int
level_of(const ss_morlet *plan, const ss_scale *scale)
{
    double a = scale->a * plan->rate;
    int l = a < 2 * least_scale(&plan->opts) ? 0 : ilogb(a / least_scale(&plan->opts));
    int enough = plan->window || ldexp((double)plan->n, -l) >= LEAST_SAMPLES;
    return a >= SHORTEST && l < LEVELS && enough ? l : -1;
}

/* Choose L and hop of a level of n samples, on which wavelets reach `reach` samples, a power of two. */
static void
choose_windows(stage *st, size_t n, size_t reach, size_t margin)
{
    stage best = { .length = 0 };
    *st = (stage){ .n = n, .margin = margin, .overlap = 2 * reach };
    for (st->length = 4 * reach; st->length <= 16 * reach; st->length *= 2) {
        st->hop = st->length - st->overlap;
        size_t points = windows_for(st, n) * st->length;
        if (best.length == 0 || points < windows_for(&best, n) * best.length)
            best = *st;
    }
    *st = best;
}

static ss_status
make_weights(const ss_morlet *plan, const kaiser *kernel, block_scale *r, double a, size_t length)
{
    const ss_morlet_opts *opts = &plan->opts;
    band b = band_of(plan, a, r->level, length);
    double second = wavelet_second(opts);
    r->lo = b.lo;
    r->mid = r->kind != AT_POINTS ? b.mid : 0;
    r->terms = (size_t)(b.hi - b.lo) + 1;
    r->weight = malloc(r->terms * sizeof *r->weight);
    if (r->weight == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < r->terms; i++) {
        double k = (double)(b.lo + (ptrdiff_t)i), low = k * b.h_low, u = fma(k, b.h, low);
        double v = fma(k, b.h, -opts->center) + low;
        double g = exp(-v * v / 2) - (second > 0 ? second * exp(-u * u / 2) : 0);
        double nu = (k - (double)r->mid) / (double)r->points;
        r->weight[i] = g * (PI_M14 * sqrt(2 * M_PI) / (double)length);
        if (r->kind != AT_POINTS)
            r->weight[i] /= ss_kaiser_response(kernel->beta, nu);
    }
    return SS_OK;
}

/* M where translations lie between points: the least power of two that the kernel needs, and no less than
 * `least`. */
static size_t
points_between(const struct blocks *b, const ss_morlet *plan, const stage *st, const ss_scale *scale,
               int l, size_t least)
{
    band of = band_of(plan, scale->a, l, st->length);
    double most = (double)(of.hi - of.mid > of.mid - of.lo ? of.hi - of.mid : of.mid - of.lo);
    size_t points = 4 * PLACES_MARGIN;
    while (points < least || most / (double)points > b->kernel->edge)
        points *= 2;
    return points <= LONGEST ? points : 0;
}

/* Choose the scales that are computed here, those that can be, and their level and M. */
static void
choose_rows(struct blocks *b, const ss_morlet *plan)
{
    for (size_t i = 0; i < b->n_scales; i++) {
        block_scale *r = &b->scale[i];
        const ss_scale *scale = &plan->scale[i];
        if ((r->level = level_of(plan, scale)) < 0)
            continue;
        stage *st = &b->stage[r->level];
        /* M where the steps repeat in a window */
        double parts = ss_scale_parts(scale, plan->rate), apart = ldexp(scale->b_num, -r->level);
        double points = parts * (double)st->length / apart;
        int repeats = parts > 0 && (double)st->overlap >= apart && points <= LONGEST;
        size_t least = plan->opts.dense ? st->circle / DENSE_PHASES_MAX : 0;
        r->kind = plan->opts.dense && r->level > 0 && least <= LONGEST ? EACH : repeats ? AT_POINTS : BETWEEN;
        r->points = repeats ? (size_t)points : 0;
        r->hop = r->points - r->points / (st->length / st->overlap);
        if (r->kind != AT_POINTS)
            r->points = points_between(b, plan, st, scale, r->level, r->kind == EACH ? least : 0);
        if (r->kind == EACH)
            r->hop = st->hop << r->level;
        if (r->points == 0) {
            r->level = -1;
            continue;
        }
        st->used = 1;
        b->longest = r->points > b->longest ? r->points : b->longest;
        b->levels = (size_t)r->level + 1 > b->levels ? (size_t)r->level + 1 : b->levels;
    }
}

/* In a stream the lower levels make most of the coefficients, and have long windows, which cost less; the higher
 * levels delay most, and have short ones. */
static void
choose_stages(struct blocks *b, const ss_morlet *plan)
{
    double a = 2 * least_scale(&plan->opts);
    size_t reach = 1, n = plan->n;
    while ((double)reach < fmax(REACH * a + 2, b->margin))
        reach *= 2;
    for (int l = 0; l < LEVELS; l++) {
        stage *st = &b->stage[l];
        choose_windows(st, n, reach, (size_t)b->margin);
        if (plan->window) {
            st->length = 16 * reach >> (l < 2 ? l : 2);
            st->hop = st->length - st->overlap;
        }
        st->windows = 1 + windows_for(st, n + 2 * st->margin);
        st->stride = st->length + ALIGN;
        st->circle = st->length << l;
        n = n / 2 + 1;
    }
}

/* --- tables ----------------------------------------------------------------------------------- */

/* The kernel's weights for the places of a scale, shared with scales that have the same pattern. */
static ss_status
places_of(struct blocks *b, block_scale *r)
{
    if (r->kind == AT_POINTS)
        return SS_OK;
    if (!b->kernel->prepared)
        ss_kaiser_prepare(b->kernel);
    if (r->kind == BETWEEN)
        return SS_OK;
    size_t phases = b->stage[r->level].circle / r->points, i = 0;
    while (i < b->n_places && ss_dense_phases(b->places[i]) != phases)
        i++;
    if (i == b->n_places && (b->places[b->n_places++] = ss_dense_new(b->kernel, phases)) == NULL)
        return SS_ENOMEM;
    r->places = b->places[i];
    b->most = r->hop > b->most ? r->hop : b->most;
    return SS_OK;
}

size_t
ss_blocks_room(const struct blocks *b)
{
    return 4 * (b->longest + DENSE_MARGIN) + ss_dense_room(b->most) + 2 * DENSE_PHASES_MAX;
}

/* --- FFTW's plans, which levels with windows of one length share, and scales with as many points ------- */

typedef struct shared_plan {
    enum plan_kind { FROM_REAL, TO_REAL, INVERSE } kind;
    size_t n;
    fftw_plan plan;
    struct shared_plan *next;
} shared_plan;

/* The plan of a kind and length, from the list, or made for these arrays.  The caller holds ss_fftw_planner.
 * NULL: no memory. */
static fftw_plan
plan_of(struct blocks *b, enum plan_kind kind, size_t n, double *from, double *to)
{
    for (const shared_plan *p = b->plans; p != NULL; p = p->next)
        if (p->kind == kind && p->n == n)
            return p->plan;
    shared_plan *p = malloc(sizeof *p);
    if (p == NULL)
        return NULL;
    *p = (shared_plan){ .kind = kind, .n = n, .next = b->plans };
    b->plans = p;
    p->plan = kind == FROM_REAL ? fftw_plan_dft_r2c_1d((int)n, from, (fftw_complex *)to, FFTW_ESTIMATE)
        : kind == TO_REAL ? fftw_plan_dft_c2r_1d((int)n, (fftw_complex *)from, to, FFTW_ESTIMATE)
        : fftw_plan_dft_1d((int)n, (fftw_complex *)from, (fftw_complex *)to, FFTW_BACKWARD, FFTW_ESTIMATE);
    return p->plan;
}

ss_status
ss_blocks_plan(struct blocks *b, int adjoint)
{
    size_t room = ss_blocks_room(b);
    for (size_t l = 0; l < b->levels; l++)
        room = 2 * b->stage[l].stride > room ? 2 * b->stage[l].stride : room;
    double *v = fftw_malloc(room * sizeof *v), *points = v + 2 * (b->longest + DENSE_MARGIN);
    if (v == NULL)
        return SS_ENOMEM;
    int made = 1;
    pthread_mutex_lock(&ss_fftw_planner);
    for (stage *st = b->stage; st < b->stage + b->levels; st++) {
        double *terms = v + st->stride;
        st->forward = plan_of(b, FROM_REAL, st->length, v, terms);
        st->next = plan_of(b, TO_REAL, st->length / 2, terms, v);
        st->of_next = adjoint ? plan_of(b, FROM_REAL, st->length / 2, v, terms) : NULL;
        st->back = adjoint ? plan_of(b, TO_REAL, st->length, terms, v) : NULL;
        made &= st->forward != NULL && st->next != NULL && (!adjoint || (st->of_next != NULL && st->back != NULL));
    }
    for (size_t i = b->n_scales; i-- > 0;)
        if (b->scale[i].level >= 0) {
            b->scale[i].inverse = plan_of(b, INVERSE, b->scale[i].points, v, points);
            made &= b->scale[i].inverse != NULL;
        }
    pthread_mutex_unlock(&ss_fftw_planner);
    fftw_free(v);
    return made ? SS_OK : SS_ENOMEM;
}

ss_status
ss_blocks_new(ss_morlet *plan)
{
    double s = (M_PI / 2 - BAND / 2) / FILTER_CUT, margin = ceil(REACH / s);
    if (plan->opts.engine == SS_ENGINE_QUADRATURE
        || plan->n > INT_MAX / 2)
        return SS_OK;
    struct blocks *b = plan->blocks = calloc(1, sizeof *b);
    if (b == NULL || (b->scale = calloc(plan->n_scales, sizeof *b->scale)) == NULL)
        return SS_ENOMEM;
    b->n_scales = plan->n_scales;
    b->margin = margin;
    b->rate = plan->rate;
    b->grid = plan->scale;
    if ((b->kernel = aligned_alloc(_Alignof(kaiser), sizeof *b->kernel)) == NULL)
        return SS_ENOMEM;
    ss_kaiser_choose(b->kernel, half_width(&plan->opts), plan->opts.center, wavelet_second(&plan->opts), IMAGES);
    choose_stages(b, plan);
    choose_rows(b, plan);
    if (b->levels == 0) {
        ss_blocks_free(b);
        plan->blocks = NULL;
        return SS_OK;
    }
    ss_status st = SS_OK;
    for (size_t i = b->n_scales; st == SS_OK && i-- > 0;) {
        block_scale *r = &b->scale[i];
        if (r->level >= 0)
            st = make_weights(plan, b->kernel, r, plan->scale[i].a, b->stage[r->level].length);
        if (st == SS_OK && r->level >= 0)
            st = places_of(b, r);
    }
    for (stage *of = b->stage; st == SS_OK && of + 1 < b->stage + b->levels; of++) {
        size_t half = of->length / 4;
        if ((of->filter = malloc(2 * (half + 1) * sizeof *of->filter)) == NULL)
            st = SS_ENOMEM;
        for (size_t k = 0; st == SS_OK && k <= half; k++) {
            double x = (2 * M_PI * (double)k / (double)of->length - M_PI / 2) / (sqrt(2) * s);
            of->filter[k] = erfc(x) / 2 / (double)of->length;
            of->filter[half + 1 + k] = erfc(-x) / 2 / (double)of->length;
        }
    }
    return st == SS_OK ? ss_blocks_plan(b, 0) : st;
}

void
ss_blocks_free(struct blocks *b)
{
    if (b == NULL)
        return;
    pthread_mutex_lock(&ss_fftw_planner);
    for (shared_plan *next; b->plans != NULL; b->plans = next) {
        next = b->plans->next;
        if (b->plans->plan != NULL)
            fftw_destroy_plan(b->plans->plan);
        free(b->plans);
    }
    pthread_mutex_unlock(&ss_fftw_planner);
    for (size_t i = 0; i < b->n_scales; i++)
        free(b->scale[i].weight);
    for (size_t l = 0; l < b->levels; l++)
        free(b->stage[l].filter);
    for (size_t i = 0; i < b->n_places; i++)
        free(b->places[i]);
    free(b->kernel);
    free(b->scale);
    free(b);
}

int
ss_blocks_covers(const struct blocks *b, size_t i)
{
    return b != NULL && b->scale[i].level >= 0;
}
