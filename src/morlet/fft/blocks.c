/* blocks.c -- coefficients of a stepped grid by short FFTs, octave by octave.
 *
 * Level l has one sample for 2^l of the record.  A scale is computed on the level on which it is A to
 * 2 A samples long, shorter ones on level 0; A = (omega_c + CUT)/BAND, so that its band ends below
 * BAND < 2 radians a sample.  A level is cut into windows of L samples, a power of two, each with its
 * spectrum X.  By Poisson's sum, on the circle of a window, in units of a^1/2,
 *     W(c) = C/L sum_k X_k exp(-v_k^2/2) exp(2 pi i k c/L),   v_k = 2 pi k a/L - omega_c,
 * for any place c in samples, C = pi^-1/4 sqrt(2 pi).  The grid's step is 2^p/m samples (grid.c) and
 * 2^p divides L, so the terms folded modulo M = L m/2^p and one inverse FFT of M points give W at
 * all translations of the window, with nothing to interpolate.  The ends of a window, which the
 * wavelets there reach beyond, belong to its neighbours: windows begin every hop = L - overlap
 * samples, overlap >= 2 REACH 2 A.  2^p divides overlap too, being at most m B_0 2 A <= 17 (2 A), so
 * that every window begins at a translation.  All FFTs stay in the cache.
 *
 * The next level is the same spectrum times F(w) = erfc((w - pi/2)/(sqrt(2) s))/2, folded to L/2
 * terms, and an inverse FFT; s = (pi/2 - BAND/2)/FILTER_CUT, and F(w) + F(pi - w) = 1.
 *
 * Error, in units of a^1/2 max|x|, of which every accuracy allows 16 eps:
 *   - the cut of the series at |v| > CUT: at most 2.4 exp(-CUT^2/2) (1 + log(1 + L/(2 CUT a))), a in
 *     samples (fft/plan.c), below 3 eps for L/a = 1000, for a step in the signal at the worst phase;
 *   - what reaches around the circle: tail(REACH) of quadrature.c, below 1e-16;
 *   - the filter: below w = BAND/2, 1 - F and F(pi - w), by which terms that fold there are
 *     multiplied, are at most erfc(FILTER_CUT/sqrt 2)/2 = 5e-17; its response in time,
 *     sin(pi n/2)/(pi n) exp(-(s n)^2/2), is cut at s n = REACH, where it is 2e-16/(pi n);
 *   - beyond the record's ends a level has REACH/s samples more, the reach of the filter: half of
 *     that is what the level before it had itself, and half of it what its filter adds;
 *   - rounding: the FFT of a window, its filter and the inverse make noise in the next level's
 *     samples of rms some eps sqrt(log2 L) rms(x); a wavelet of a samples averages it to 1/sqrt(a) of
 *     that, a >= A >= 5, and each filter halves the power of what the levels before have made.
 * tests/test_morlet.c finds at most 1 eps.  So one way serves every accuracy, and nothing needs to be
 * looked at afterwards. */
#include <fftw3.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "morlet/fft/blocks.h"
#include "morlet/fft/plan.h"
#include "morlet/versions.h"

#define CUT 8.66
#define BAND 1.99
#define FILTER_CUT 8.3
#define COST_POINT 4e-9         /* of an FFT, and what goes with it [s] */

enum {
    LEVELS = 48,
    LEAST_SAMPLES = 4,          /* of a level */
    LONGEST = 1 << 17,          /* inverse FFT */
    LONGEST_WINDOW = 1 << 18,
    ALIGN = 8                   /* doubles; FFTW's plans are for arrays that begin at multiples */
};

#define REAL double
#define NAMED(name) name
#include "morlet/fft/points.h"
#undef REAL
#undef NAMED

/* A level of n samples, margin more on either side. */
typedef struct stage {
    size_t n, length, overlap, hop, windows;        /* window i begins at sample (i - 1) hop */
    size_t margin, stride;                  /* doubles from a spectrum to the next */
    int used;                               /* by a scale: spectra are kept */
    double *filter;                         /* F_k / L, k <= L/4, then F_(L/2-k) / L; NULL: the last */
    fftw_plan forward, back;
} stage;

/* The weights of a scale's terms, which those of other octaves share. */
typedef struct row {
    int level;                              /* -1: not here */
    size_t points, hop;                     /* M, and translations from a window to the next */
    ptrdiff_t lo;                           /* the first term */
    size_t terms;
    double *weight;
    int owner;                              /* of weight */
    fftw_plan inverse;
} row;

struct blocks {
    size_t n_rows, levels, longest;         /* longest: M */
    double margin;                          /* samples */
    row *row;
    stage stage[LEVELS];
};

/* --- which scales, in what windows ------------------------------------------------------------ */

/* How far above omega_c, or below, the band of the wavelet ends. */
static double
half_band(const ss_morlet_opts *opts)
{
    double c = opts->center;
    return opts->admissible && CUT > c ? c + sqrt(CUT * CUT - c * c) : CUT;
}

/* A: the least samples of a scale on a level but the first. */
static double
least_scale(const ss_morlet_opts *opts)
{
    return (opts->center + half_band(opts)) / BAND;
}

static int
level_of(const ss_morlet *plan, const ss_scale *scale)
{
    double a = scale->a * plan->rate;
    int l = a < 2 * least_scale(&plan->opts) ? 0 : ilogb(a / least_scale(&plan->opts));
    return a >= 2 && l < LEVELS && ldexp((double)plan->n, -l) >= LEAST_SAMPLES ? l : -1;
}

/* Windows that hold n samples' coefficients. */
static size_t
windows_for(const stage *st, size_t n)
{
    return (n + st->hop - 1) / st->hop;
}

/* L, hop and windows of a level of n samples on which wavelets reach so many, a power of two. */
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
    st->windows = 1 + windows_for(st, n + 2 * margin);
    st->stride = st->length + ALIGN;
}

/* The row of the scale an octave shorter than row i, if its weights are the same, else NULL. */
static const row *
same_weights(const struct blocks *b, const ss_morlet *plan, size_t i)
{
    size_t j = i + (size_t)plan->opts.voices;
    if (j >= b->n_rows || b->row[j].level < 0)
        return NULL;
    int l = b->row[i].level, of = b->row[j].level;
    int same = b->stage[l].length == b->stage[of].length
        && ldexp(plan->scale[i].a, -l) == ldexp(plan->scale[j].a, -of);
    return same ? &b->row[j] : NULL;
}

static ss_status
make_weights(const ss_morlet *plan, row *r, const ss_scale *scale, size_t length)
{
    const ss_morlet_opts *opts = &plan->opts;
    band b = band_around(opts->center, half_band(opts), ldexp(scale->a, -r->level), plan->rate,
                         (double)length);
    double second = opts->admissible ? exp(-opts->center * opts->center / 2) : 0;
    r->lo = b.lo;
    r->terms = (size_t)(b.hi - b.lo) + 1;
    r->owner = 1;
    r->weight = malloc(r->terms * sizeof *r->weight);
    if (r->weight == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < r->terms; i++) {
        double k = (double)(b.lo + (ptrdiff_t)i), low = k * b.h_low, u = fma(k, b.h, low);
        double v = fma(k, b.h, -opts->center) + low;
        double g = exp(-v * v / 2) - (second > 0 ? second * exp(-u * u / 2) : 0);
        r->weight[i] = g * (PI_M14 * sqrt(2 * M_PI) / (double)length);
    }
    return SS_OK;
}

/* M of a scale on its level, 0 if its steps do not repeat as they must. */
static size_t
points_of(const stage *st, const ss_scale *scale, int l, double rate)
{
    double parts = ss_scale_parts(scale, rate), apart = ldexp(scale->b_num, -l);
    double points = parts * (double)st->length / apart;
    if (parts == 0 || (double)st->overlap < apart || points > LONGEST)
        return 0;
    return (size_t)points;
}

static double
cost_of(const stage *st, size_t points)
{
    return COST_POINT * (double)windows_for(st, st->n) * (double)points;
}

/* The spectra of the levels in use. */
static double
forward_cost(const struct blocks *b)
{
    double points = 0;
    for (size_t l = 0; l < b->levels; l++)
        points += (double)b->stage[l].windows * (double)b->stage[l].length;
    return COST_POINT * points;
}

/* Choose the scales that can be computed here; with AUTO those for which it is cheaper, if their gain
 * pays for the spectra. */
static void
choose_rows(struct blocks *b, const ss_morlet *plan)
{
    int automatic = plan->opts.engine == SS_ENGINE_AUTO;
    double gain = 0;
    for (size_t i = 0; i < b->n_rows; i++) {
        row *r = &b->row[i];
        const ss_scale *scale = &plan->scale[i];
        r->level = level_of(plan, scale);
        if (r->level < 0)
            continue;
        const stage *st = &b->stage[r->level];
        r->points = points_of(st, scale, r->level, plan->rate);
        double less = ss_quadrature_cost(plan, scale, scale->n) - cost_of(st, r->points);
        if (r->points == 0 || (automatic && less < 0)) {
            r->level = -1;
            continue;
        }
        gain += less;
        b->stage[r->level].used = 1;
        r->hop = r->points - r->points / (st->length / st->overlap);
        b->longest = r->points > b->longest ? r->points : b->longest;
        b->levels = (size_t)r->level + 1 > b->levels ? (size_t)r->level + 1 : b->levels;
    }
    if (automatic && gain < forward_cost(b))
        b->levels = 0;
}

static void
choose_stages(struct blocks *b, const ss_morlet *plan)
{
    double a = 2 * least_scale(&plan->opts);
    size_t reach = 1, n = plan->n;
    while ((double)reach < fmax(REACH * a + 2, b->margin))
        reach *= 2;
    for (int l = 0; l < LEVELS; l++) {
        choose_windows(&b->stage[l], n, reach, (size_t)b->margin);
        n = n / 2 + 1;
    }
}

/* --- tables and plans ------------------------------------------------------------------------- */

static ss_status
all_weights(struct blocks *b, const ss_morlet *plan)
{
    ss_status st = SS_OK;
    for (size_t i = b->n_rows; st == SS_OK && i-- > 0;) {       /* short to long */
        row *r = &b->row[i];
        if (r->level < 0)
            continue;
        const row *of = same_weights(b, plan, i);
        if (of != NULL) {
            r->lo = of->lo;
            r->terms = of->terms;
            r->weight = of->weight;
        } else
            st = make_weights(plan, r, &plan->scale[i], b->stage[r->level].length);
    }
    return st;
}

static ss_status
make_filter(stage *st)
{
    size_t half = st->length / 4;
    double s = (M_PI / 2 - BAND / 2) / FILTER_CUT;
    st->filter = malloc(2 * (half + 1) * sizeof *st->filter);
    if (st->filter == NULL)
        return SS_ENOMEM;
    for (size_t k = 0; k <= half; k++) {
        double x = (2 * M_PI * (double)k / (double)st->length - M_PI / 2) / (sqrt(2) * s);
        st->filter[k] = erfc(x) / 2 / (double)st->length;
        st->filter[half + 1 + k] = erfc(-x) / 2 / (double)st->length;
    }
    return SS_OK;
}

/* Doubles for a window, its spectrum and the next level's. */
static size_t
window_room(const struct blocks *b)
{
    size_t most = 0;
    for (size_t l = 0; l < b->levels; l++)
        most = b->stage[l].stride > most ? b->stage[l].stride : most;
    return 2 * most;
}

static ss_status
plan_stage(struct blocks *b, size_t l, double *v, unsigned how)
{
    stage *st = &b->stage[l];
    int n = (int)st->length;
    double *to = v + st->stride;
    const stage *same = l > 0 && st[-1].length == st->length ? st - 1 : NULL;
    st->forward = same != NULL ? same->forward
        : fftw_plan_dft_r2c_1d(n, v, (fftw_complex *)to, how);
    st->back = same != NULL ? same->back
        : fftw_plan_dft_c2r_1d(n / 2, (fftw_complex *)to, v, how);
    return st->forward != NULL && st->back != NULL ? SS_OK : SS_ENOMEM;
}

static fftw_plan
inverse_of(const struct blocks *b, size_t i, double *v, unsigned how)
{
    const row *r = &b->row[i];
    for (size_t j = i + 1; j < b->n_rows; j++)
        if (b->row[j].level >= 0 && b->row[j].points == r->points)
            return b->row[j].inverse;
    return fftw_plan_dft_1d((int)r->points, (fftw_complex *)v,
                            (fftw_complex *)(v + 2 * b->longest), FFTW_BACKWARD, how);
}

/* While ss_fftw_planner is held. */
static ss_status
plan_all(struct blocks *b, double *v, unsigned how)
{
    ss_status st = SS_OK;
    for (size_t l = 0; st == SS_OK && l < b->levels; l++)
        st = plan_stage(b, l, v, how);
    for (size_t i = b->n_rows; st == SS_OK && i-- > 0;) {
        row *r = &b->row[i];
        if (r->level < 0)
            continue;
        r->inverse = inverse_of(b, i, v, how);
        st = r->inverse != NULL ? SS_OK : SS_ENOMEM;
    }
    return st;
}

static ss_status
make_plans(struct blocks *b, ss_planner planner)
{
    static const unsigned flags[] = { FFTW_ESTIMATE, FFTW_MEASURE, FFTW_PATIENT };
    size_t room = window_room(b) > ss_blocks_room(b) ? window_room(b) : ss_blocks_room(b);
    double *v = fftw_malloc(room * sizeof *v);
    if (v == NULL)
        return SS_ENOMEM;
    pthread_mutex_lock(&ss_fftw_planner);
    ss_status st = plan_all(b, v, flags[planner]);
    pthread_mutex_unlock(&ss_fftw_planner);
    fftw_free(v);
    return st;
}

size_t
ss_blocks_room(const struct blocks *b)
{
    return 4 * b->longest;
}

ss_status
ss_blocks_new(ss_morlet *plan)
{
    double margin = ceil(REACH / ((M_PI / 2 - BAND / 2) / FILTER_CUT));
    double reach = fmax(REACH * 2 * least_scale(&plan->opts) + 2, margin);
    if (plan->opts.engine == SS_ENGINE_QUADRATURE || plan->opts.dense || plan->window
        || 32 * reach > LONGEST_WINDOW || plan->n > INT_MAX / 2)
        return SS_OK;
    struct blocks *b = plan->blocks = calloc(1, sizeof *b);
    if (b == NULL || (b->row = calloc(plan->n_scales, sizeof *b->row)) == NULL)
        return SS_ENOMEM;
    b->n_rows = plan->n_scales;
    b->margin = margin;
    choose_stages(b, plan);
    choose_rows(b, plan);
    if (b->levels == 0) {
        ss_blocks_free(b);
        plan->blocks = NULL;
        return SS_OK;
    }
    ss_status st = all_weights(b, plan);
    for (size_t l = 0; st == SS_OK && l + 1 < b->levels; l++)
        st = make_filter(&b->stage[l]);
    return st == SS_OK ? make_plans(b, plan->opts.planner) : st;
}

void
ss_blocks_free(struct blocks *b)
{
    if (b == NULL)
        return;
    pthread_mutex_lock(&ss_fftw_planner);
    for (size_t i = 0; i < b->n_rows; i++) {
        fftw_plan p = b->row[i].inverse;
        for (size_t j = i + 1; p != NULL && j < b->n_rows; j++)
            if (b->row[j].inverse == p)
                b->row[j].inverse = NULL;
        if (p != NULL)
            fftw_destroy_plan(p);
    }
    for (size_t l = 0; l < b->levels; l++) {
        if (l > 0 && b->stage[l].forward == b->stage[l - 1].forward)
            continue;
        if (b->stage[l].forward != NULL)
            fftw_destroy_plan(b->stage[l].forward);
        if (b->stage[l].back != NULL)
            fftw_destroy_plan(b->stage[l].back);
    }
    pthread_mutex_unlock(&ss_fftw_planner);
    for (size_t i = 0; i < b->n_rows; i++)
        if (b->row[i].owner)
            free(b->row[i].weight);
    for (size_t l = 0; l < b->levels; l++)
        free(b->stage[l].filter);
    free(b->row);
    free(b);
}

int
ss_blocks_covers(const struct blocks *b, size_t i)
{
    return b != NULL && b->row[i].level >= 0;
}

/* --- the record's spectra --------------------------------------------------------------------- */

/* Samples lo ... hi - 1 of a level, x[0] being sample lo; zeros elsewhere. */
typedef struct samples {
    double *x;
    ptrdiff_t lo, hi;
} samples;

/* to[i] = sample first + i. */
static void
copy_samples(const samples *s, ptrdiff_t first, size_t n, double *to)
{
    ptrdiff_t end = first + (ptrdiff_t)n;
    ptrdiff_t lo = first > s->lo ? first : s->lo, hi = end < s->hi ? end : s->hi;
    if (lo >= hi)
        lo = hi = end;
    memset(to, 0, (size_t)(lo - first) * sizeof *to);
    if (hi > lo)
        memcpy(to + (lo - first), s->x + (lo - s->lo), (size_t)(hi - lo) * sizeof *to);
    memset(to + (hi - first), 0, (size_t)(end - hi) * sizeof *to);
}

/* Terms of a window of the next level, k <= L/4, from those of this one. */
VERSIONS static void
filter_terms(const stage *st, const double *restrict x, double *restrict y)
{
    size_t half = st->length / 4;
    const double *f = st->filter, *g = f + half + 1, *z = x + st->length;
    for (size_t k = 0; k <= half; k++) {
        y[2 * k] = f[k] * x[2 * k] + g[k] * *(z - 2 * k);
        y[2 * k + 1] = f[k] * x[2 * k + 1] - g[k] * *(z - 2 * k + 1);
    }
}

/* Samples of the next level that window i gives. */
static void
decimate(const stage *st, size_t i, const double *x, double *spare, samples *next)
{
    ptrdiff_t first = ((ptrdiff_t)i - 1) * (ptrdiff_t)(st->hop / 2);
    ptrdiff_t end = first + (ptrdiff_t)st->hop / 2;
    ptrdiff_t lo = first > next->lo ? first : next->lo, hi = end < next->hi ? end : next->hi;
    double *y = spare + st->stride;
    if (lo >= hi)
        return;
    filter_terms(st, x, spare);
    fftw_execute_dft_c2r(st->back, (fftw_complex *)spare, y);
    memcpy(next->x + (lo - next->lo), y + (lo - first), (size_t)(hi - lo) * sizeof *y);
}

/* The spectra of a level, the first sample of a window at place 0 and what lies before it at the
 * end of the circle, and the next level. */
static ss_status
forward_stage(const stage *st, const samples *from, samples *next, double *v, double **out)
{
    size_t before = st->overlap / 2;
    double *x = *out = fftw_malloc((st->used ? st->windows : 1) * st->stride * sizeof *x);
    if (x == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < st->windows; i++, x += st->used ? st->stride : 0) {
        ptrdiff_t first = ((ptrdiff_t)i - 1) * (ptrdiff_t)st->hop;
        copy_samples(from, first, st->length - before, v);
        copy_samples(from, first - (ptrdiff_t)before, before, v + st->length - before);
        fftw_execute_dft_r2c(st->forward, v, (fftw_complex *)x);
        if (next != NULL)
            decimate(st, i, x, v, next);
    }
    return SS_OK;
}

static ss_status
samples_new(samples *s, const stage *st)
{
    *s = (samples){ .lo = -(ptrdiff_t)st->margin, .hi = (ptrdiff_t)(st->n + st->margin) };
    s->x = calloc((size_t)(s->hi - s->lo), sizeof *s->x);
    return s->x != NULL ? SS_OK : SS_ENOMEM;
}

ss_status
ss_blocks_forward(const struct blocks *b, const record *rec, block_spectra *out)
{
    samples now = { rec->x, 0, (ptrdiff_t)rec->n }, next = { 0 };
    double *v = fftw_malloc(window_room(b) * sizeof *v);
    out->level = calloc(b->levels, sizeof *out->level);
    out->levels = b->levels;
    ss_status st = v != NULL && out->level != NULL ? SS_OK : SS_ENOMEM;
    for (size_t l = 0; st == SS_OK && l < b->levels; l++) {
        int last = l + 1 == b->levels;
        if (!last)
            st = samples_new(&next, &b->stage[l + 1]);
        if (st == SS_OK)
            st = forward_stage(&b->stage[l], &now, last ? NULL : &next, v, &out->level[l]);
        if (l > 0)
            free(now.x);
        now = next;
        next.x = NULL;
    }
    if (st != SS_OK && now.x != rec->x)
        free(now.x);
    fftw_free(v);
    return st;
}

void
ss_block_spectra_free(block_spectra *s)
{
    for (size_t l = 0; s->level != NULL && l < s->levels; l++)
        fftw_free(s->level[l]);
    free(s->level);
}

/* --- a scale ---------------------------------------------------------------------------------- */

/* All translations of a window, the first counted one at v[0]. */
static void
transform_window(const stage *st, const row *r, const double *x, double *c, double *v)
{
    ptrdiff_t rest = r->lo % (ptrdiff_t)r->points;
    size_t at = (size_t)(rest < 0 ? rest + (ptrdiff_t)r->points : rest);
    memset(c, 0, 2 * r->points * sizeof *c);
    add_terms(x, st->length, r->lo, r->weight, r->terms, c, r->points, at);
    fftw_execute_dft(r->inverse, (fftw_complex *)c, (fftw_complex *)v);
}

void
ss_blocks_scale(const struct blocks *b, size_t i, const block_spectra *s, double *scratch,
                span part, double factor, double *w)
{
    const row *r = &b->row[i];
    const stage *st = &b->stage[r->level];
    size_t end = part.first + part.n, k = part.first;
    double *v = scratch + 2 * b->longest;
    while (k < end) {
        size_t window = 1 + k / r->hop, at = k % r->hop;
        size_t n = r->hop - at < end - k ? r->hop - at : end - k;
        transform_window(st, r, s->level[r->level] + window * st->stride, scratch, v);
        write_lattice(v + 2 * at, n, factor, w + 2 * (k - part.first));
        k += n;
    }
}
