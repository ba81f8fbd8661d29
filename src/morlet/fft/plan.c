/* plan.c -- how the scales of a grid are transformed by FFT: circles, lengths and routes.
 *
 * A wavelet that reaches around a circle is an error, so a circle has the record's n samples and
 * REACH a of zeros.  Long scales need many zeros and use low frequencies only: for them there is a
 * second circle, on which a point stands for D samples.
 *
 * Each scale uses the cheapest route that its circle allows, and with AUTO the sum over samples where
 * that is cheaper.
 *
 * The cut R and images e of the first pass suffice for noise at the given accuracy.  Those of the
 * last suffice for any signal: the sum over samples of the kernel's error is bounded by its
 * size near b and its decay, 1/|u|, away from it, in units of a^1/2 max|x|: for the cut
 *     2.4 exp(-R^2/2) (1 + log(1 + n d/(2 R))),   d = 1/(a rate),
 * and for images at most as much with 2 e in place of the exponential; both together TAIL_FLOOR. */
#include <fftw3.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include "morlet/dense.h"
#include "morlet/fft/blocks.h"
#include "morlet/fft/plan.h"
#include "morlet/kaiser.h"
#include "morlet/plan.h"

/* [s], measured by tests/bench/bench_morlet: a point of an inverse FFT times log2 of its length, a
 * term of the series, a coefficient and a tap of it at places that repeat, and at others. */
#define COST_FFT 0.13e-9
#define COST_TERM 1.2e-9
#define COST_DENSE 0.5e-9
#define COST_DENSE_TAP 0.05e-9
#define COST_PLACE 50e-9
#define COST_TAP 1.5e-9

enum { BLOCKS = 32768 };            /* of terms, about */

/* --- bounds and circles ----------------------------------------------------------------------- */

/* in a circle's points; gaps of 12 % */
static const size_t odd_part[] = { 1, 9, 5, 21, 45, 3, 7, 15 };
enum { ODD_PARTS = sizeof odd_part / sizeof *odd_part };

/* The smallest good number of points, at least so many and a multiple of factor. */
static size_t
good_points(double least, size_t factor)
{
    double best = INFINITY;
    for (int i = 0; i < ODD_PARTS; i++) {
        double points = (double)(odd_part[i] * factor);
        while (points < least)
            points *= 2;
        best = fmin(best, points);
    }
    return best < INT_MAX ? (size_t)best : 0;
}

/* The odd factor that a circle needs for the lattice of octaves: that of the step in samples, if
 * it is small, else 1. */
static size_t
lattice_factor(const ss_morlet *plan)
{
    int e;
    double s = plan->scale[0].b_num / plan->scale[0].b_den * plan->rate;
    if (plan->opts.voices != 1 || plan->opts.dense)
        return 1;
    s = frexp(s, &e);
    for (int i = 0; i < 53 && s != floor(s); i++)
        s *= 2;
    return s < 2048 ? (size_t)s : 1;
}

static size_t
samples_reached(const ss_scale *scale, double rate)
{
    double reach = ceil(REACH * scale->a * rate);
    return reach < 0x1p50 ? (size_t)reach : (size_t)1 << 50;
}

/* See above; nd is the record's length in units of the shortest scale. */
static void
choose_bounds(struct fft *f, double nd, double accuracy)
{
    double factor = 2.4 * (1 + log1p(nd / 2)), hump = f->second > 0 ? 2 : 1;
    double cut = TAIL_FLOOR / 2 / (factor * hump), images = TAIL_FLOOR / 2 / (2 * factor);
    double first = accuracy * 4 / hump / sqrt(nd);
    double far = sqrt(-2 * log(cut)), near = sqrt(-2 * log(fmin(0.1, fmax(cut, first))));
    f->half[1] = half_band(f->center, f->second, far);
    f->half[0] = half_band(f->center, f->second, near);
    f->images[1] = images;
    f->images[0] = fmin(0.01, fmax(images, accuracy * 0.16 / sqrt(nd)));
    if (f->half[0] == f->half[1])
        f->images[0] = images;
}

/* Samples that a point may stand for, the shortest scale being so many samples.  A dense scale has
 * weights for no more of them. */
static size_t
samples_for(const struct fft *f, double shortest, int dense)
{
    double omega = (f->center + f->half[1]) / shortest;
    size_t samples = 1, most = f->n / 8;
    if (dense && most > DENSE_PHASES_MAX)
        most = DENSE_PHASES_MAX;
    while ((double)(16 * samples) * omega <= 2 * M_PI && samples < most)
        samples *= 2;
    return samples < 4 ? 1 : samples;
}

/* One circle, which a window fills but for what spreading needs. */
static void
choose_window(struct fft *f, ss_morlet *plan)
{
    level *lev = &f->level[0];
    double shortest = plan->scale[plan->n_scales - 1].a * f->rate;
    lev->samples = samples_for(f, shortest, plan->opts.dense);
    size_t margin = lev->samples > 1 ? 2 * SPREAD_TAPS : 0;
    double least = (double)f->n / (double)lev->samples + (double)margin;
    lev->points = good_points(least, lattice_factor(plan));
    lev->reach = SIZE_MAX;
    f->levels = 1;
    if (lev->points > margin)
        f->n = plan->n = (lev->points - margin) * lev->samples;
}

/* Circle 0 has few zeros; circle 1, if longer scales need one, so many that they do. */
static void
choose_levels(struct fft *f, const ss_morlet *plan)
{
    size_t factor = lattice_factor(plan), far = 0, near = SIZE_MAX;
    level *one = &f->level[1], *zero = &f->level[0];
    zero->samples = 1;
    zero->points = good_points((double)f->n * 17 / 16 + 64, factor);
    zero->reach = zero->points > f->n ? zero->points - f->n : 0;
    f->levels = 1;
    for (size_t i = 0; i < plan->n_scales; i++) {
        size_t reach = samples_reached(&plan->scale[i], f->rate);
        if (reach <= zero->reach || reach / 64 > f->n       /* the longest by their sum */
            || ss_blocks_covers(plan->blocks, i))
            continue;
        far = reach > far ? reach : far;
        near = reach < near ? reach : near;
    }
    if (far == 0)
        return;
    one->samples = samples_for(f, (double)near / REACH, plan->opts.dense);
    double least = (double)(f->n + far) / (double)one->samples + 3 * SPREAD_TAPS;
    one->points = good_points(least, factor);
    one->reach = far;
    f->levels = 2;
}

/* --- routes ----------------------------------------------------------------------------------- */

/* L, if every translation is a multiple of the circle's L-th part, else 0.  A deviation within the
 * promise is allowed: W changes by at most (omega_c + REACH)/a of its largest a second. */
static size_t
lattice_length(const struct fft *f, const level *lev, const ss_scale *scale, double accuracy,
               int window)
{
    double whole = ss_scale_parts(scale, f->rate), circle = (double)circle_of(lev);
    double step = whole > 0 ? scale->b_num / whole : scale->b_num * f->rate;
    double a = scale->a * f->rate, parts = rint(circle / step);
    int power_of_two = whole <= 1 && frexp(scale->b_num, &(int){ 0 }) == 0.5;
    int dense = whole == 1 && scale->b_num == 1;
    double off = (fabs(circle / parts - step) + 2e-16 * step) * (double)scale->n;
    double allow = accuracy / 20 * a / (f->center + REACH);
    int near = !dense && step <= a && off < allow;
    if (!(parts >= (double)scale->n && parts < INT_MAX))
        return 0;
    if (window)
        return power_of_two && circle == parts * step && step <= 4 * a ? (size_t)parts : 0;
    return near || ((dense || power_of_two) && circle == parts * step) ? (size_t)parts : 0;
}

/* Powers of two are fastest; short series stay in the first cache, long ones in none. */
static double
inverse_cost(size_t length)
{
    double cost = COST_FFT * (double)length * log2((double)length + 1);
    cost = (length & (length - 1)) == 0 ? cost : 1.4 * cost;
    return length < 1 << 12 ? cost : length < 1 << 18 ? 1.6 * cost : 3.5 * cost;
}

/* The kernel for a band to this edge, made on the first call; NULL: none is accurate enough, or no
 * memory. */
static const kaiser *
find_kernel(struct fft *f, int cut, double edge)
{
    kaiser_band shape = { .reach = f->half[cut], .center = f->center, .second = f->second };
    kaiser ker;
    if (edge > EDGE_MAX)
        return NULL;
    kaiser **at = &f->kernel[cut][kernel_index(edge, &shape.edge)];
    if (*at != NULL || !ss_kaiser_choose(&ker, &shape, f->images[cut]))
        return *at;
    *at = aligned_alloc(_Alignof(kaiser), sizeof ker);
    if (*at != NULL)
        **at = ker;
    else
        f->no_memory = 1;
    return *at;
}

/* The approximate cost of the scale with L points [s]; infinity if that is not possible. */
static double
interpolation_cost(struct fft *f, const level *lev, const ss_scale *scale, int dense, size_t length)
{
    const kaiser *kernel[2];
    band b = { 0 };
    for (int cut = 1; cut >= 0; cut--) {
        b = band_of(f, lev, scale->a, f->half[cut]);
        kernel[cut] = find_kernel(f, cut, edge_of(&b, length));
        if (kernel[cut] == NULL)
            return INFINITY;
    }
    double tap = kernel[0]->taps * (dense ? COST_DENSE_TAP : COST_TAP);
    return inverse_cost(length) + COST_TERM * (double)(b.hi - b.lo + 1)
        + (double)scale->n * ((dense ? COST_DENSE : COST_PLACE) + tap);
}

/* Choose the cheapest number of points to interpolate between, at most twice as many as the circle has,
 * if that costs less than best.  Returns the least cost. */
static double
choose_points(struct fft *f, const ss_morlet *plan, size_t i, double terms, double best)
{
    route *r = &f->route[i];
    const level *lev = &f->level[r->level];
    size_t most = 2 * lev->points;
    int dense = plan->opts.dense;
    for (int o = 0; o < ODD_PARTS; o++)
        for (size_t part = odd_part[o]; part <= most; part *= 2) {
            size_t points = most / part, phases = part / 2 * lev->samples;
            if (most % part != 0 || points > INT_MAX || points < 8
                || (dense && (part % 2 != 0 || phases > DENSE_PHASES_MAX)))
                continue;
            if ((double)points * EDGE_MAX * 2 < terms)
                break;
            double cost = interpolation_cost(f, lev, &plan->scale[i], dense, points);
            if (cost < best) {
                best = cost;
                r->kind = dense ? DENSE : ANYWHERE;
                r->length = points;
            }
        }
    return best;
}

/* Choose the route of a scale on its level.  Returns its cost. */
static double
choose_route(struct fft *f, const ss_morlet *plan, size_t i)
{
    route *r = &f->route[i];
    const ss_scale *scale = &plan->scale[i];
    const level *lev = &f->level[r->level];
    if (lev->points == 0)
        return INFINITY;
    band fine = band_of(f, lev, scale->a, f->half[1]);
    double best = INFINITY, terms = (double)(fine.hi - fine.lo) + 1;
    size_t length = lattice_length(f, lev, scale, plan->opts.accuracy,
                                   plan->window && !plan->opts.dense);
    if (terms > (double)lev->points)
        return best;
    if (length > 0) {
        r->kind = LATTICE;
        r->length = length;
        double half = f->half[0] / f->half[1];
        best = inverse_cost(length) + COST_TERM * terms * half + COST_DENSE * (double)scale->n;
    }
    return choose_points(f, plan, i, terms, best);
}

/* The spectrum of a level. */
static double
forward_cost(const struct fft *f, const level *lev)
{
    double spreading = lev->samples > 1 ? (double)f->n * SPREAD_TAPS * COST_DENSE_TAP : 0;
    return inverse_cost(lev->points) / 2 + spreading;
}

/* Choose the routes of all scales; by AUTO those only where they are cheaper, the spectra included. */
static void
choose_routes(struct fft *f, const ss_morlet *plan)
{
    double gain[2] = { 0, 0 };
    for (size_t i = 0; i < plan->n_scales; i++) {
        route *r = &f->route[i];
        size_t reach = samples_reached(&plan->scale[i], f->rate);
        r->level = reach > f->level[0].reach;
        if (ss_blocks_covers(plan->blocks, i))
            continue;
        if (r->level == 1 && (f->levels == 1 || reach > f->level[1].reach))
            continue;
        double cost = choose_route(f, plan, i);
        double sum = ss_quadrature_cost(plan, &plan->scale[i], plan->scale[i].n);
        if (plan->opts.engine == SS_ENGINE_AUTO && cost > sum)
            r->kind = BY_SUM;
        if (r->kind == BY_SUM)
            continue;
        gain[r->level] += sum - cost;
        f->cost += cost;
    }
    for (int l = 0; l < f->levels; l++) {
        double forward = forward_cost(f, &f->level[l]);
        gain[l] -= forward;
        f->cost += forward;
    }
    for (size_t i = 0; i < plan->n_scales; i++) {
        route *r = &f->route[i];
        if (plan->opts.engine == SS_ENGINE_AUTO && gain[r->level] < 0)
            r->kind = BY_SUM;
        if (r->kind != BY_SUM && r->length > f->longest)
            f->longest = r->length;
    }
}

/* --- weights of dense scales ------------------------------------------------------------------ */

/* The number of positions between points, after which they repeat. */
static size_t
phases_of(const level *lev, const route *r)
{
    return circle_of(lev) / r->length;
}

static const weights *
weights_of(struct fft *f, const kaiser *kernel, size_t phases)
{
    shared_weights *t = f->shared;
    for (; t < f->shared + f->n_shared; t++)
        if (t->kernel == kernel && t->phases == phases)
            return t->weights;
    *t = (shared_weights){ kernel, phases, ss_dense_new(kernel, phases) };
    f->n_shared += t->weights != NULL;
    return t->weights;
}

static ss_status
share_weights(struct fft *f, const ss_morlet *plan)
{
    f->shared = calloc(CUTS * plan->n_scales, sizeof *f->shared);
    if (f->shared == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < CUTS * plan->n_scales; i++) {
        route *r = &f->route[i / CUTS];
        int cut = i % CUTS;
        if (r->kind != DENSE && r->kind != ANYWHERE)
            continue;
        const level *lev = &f->level[r->level];
        band b = band_of(f, lev, plan->scale[i / CUTS].a, f->half[cut]);
        kaiser *kernel = kernel_of(f, r, &b, cut);
        if (!kernel->prepared)
            ss_kaiser_prepare(kernel);
        if (r->kind != DENSE)
            continue;
        r->weights[cut] = weights_of(f, kernel, phases_of(lev, r));
        if (r->weights[cut] == NULL)
            return SS_ENOMEM;
    }
    return SS_OK;
}

/* --- FFTW's plans, made while ss_fftw_planner is held ----------------------------------------- */

static fftw_plan
inverse_of_length(struct fft *f, size_t length, fftw_complex *v, fftw_complex *c, unsigned how)
{
    inverse *of = f->inverse;
    for (; of < f->inverse + f->n_inverse; of++)
        if (of->length == length)
            return of->plan;
    c = length > APART ? v : c;
    of->length = length;
    of->plan = fftw_plan_dft_1d((int)length, c, v, FFTW_BACKWARD, how);
    f->n_inverse++;
    return of->plan;
}

/* v, c and x have the alignment of the arrays to come. */
static ss_status
make_plans(struct fft *f, const ss_morlet *plan, double *v, double *c, double *x)
{
    unsigned how = flag_of(plan->opts.planner);
    for (size_t i = 0; i < plan->n_scales; i++) {
        route *r = &f->route[i];
        level *lev = &f->level[r->level];
        if (r->kind == BY_SUM)
            continue;
        r->inverse = inverse_of_length(f, r->length, (fftw_complex *)v, (fftw_complex *)c, how);
        if (lev->forward == NULL)
            lev->forward = fftw_plan_dft_r2c_1d((int)lev->points, x, (fftw_complex *)x, how);
        if (r->inverse == NULL || lev->forward == NULL)
            return SS_ENOMEM;
    }
    return SS_OK;
}

/* --- all of it -------------------------------------------------------------------------------- */

static ss_status
plan_all(struct fft *f, const ss_morlet *plan)
{
    size_t longest = f->longest;
    for (int l = 0; l < f->levels; l++) {
        level *lev = &f->level[l];
        lev->block = lev->points / 2 / BLOCKS + 1;
        longest = lev->points > longest ? lev->points : longest;
    }
    f->inverse = calloc(plan->n_scales, sizeof *f->inverse);
    double *v = fftw_malloc(2 * (longest + 2 * MARGIN + APART) * sizeof *v);
    ss_status st = SS_ENOMEM;
    if (f->inverse != NULL && v != NULL) {
        pthread_mutex_lock(&ss_fftw_planner);
        st = make_plans(f, plan, v + 2 * MARGIN, v + 2 * (longest + 2 * MARGIN), v);
        pthread_mutex_unlock(&ss_fftw_planner);
    }
    fftw_free(v);
    return st == SS_OK ? share_weights(f, plan) : st;
}

ss_status
ss_fft_new(ss_morlet *plan)
{
    if (plan->opts.engine == SS_ENGINE_QUADRATURE || plan->n > INT_MAX / 2)
        return SS_OK;
    struct fft *f = plan->fft = calloc(1, sizeof *f);
    if (f == NULL || (f->route = calloc(plan->n_scales, sizeof *f->route)) == NULL)
        return SS_ENOMEM;
    double shortest = plan->scale[plan->n_scales - 1].a * plan->rate;
    f->n = plan->n;
    f->rate = plan->rate;
    f->center = plan->opts.center;
    f->second = wavelet_second(&plan->opts);
    choose_bounds(f, (double)plan->n * (plan->window ? 2 : 1) / shortest, plan->opts.accuracy);
    if (plan->window)
        choose_window(f, plan);
    else
        choose_levels(f, plan);
    choose_routes(f, plan);
    if (f->no_memory)
        return SS_ENOMEM;
    if (f->longest > 0)
        return plan_all(f, plan);
    ss_fft_free(f);
    plan->fft = NULL;
    return SS_OK;
}

void
ss_fft_free(struct fft *fft)
{
    if (fft == NULL)
        return;
    pthread_mutex_lock(&ss_fftw_planner);
    for (size_t i = 0; i < fft->n_inverse; i++)
        fftw_destroy_plan(fft->inverse[i].plan);
    for (int i = 0; i < fft->levels; i++)
        if (fft->level[i].forward != NULL)
            fftw_destroy_plan(fft->level[i].forward);
    pthread_mutex_unlock(&ss_fftw_planner);
    for (int i = 0; i < KERNELS; i++) {
        free(fft->kernel[0][i]);
        free(fft->kernel[1][i]);
    }
    for (size_t i = 0; i < fft->n_shared; i++)
        ss_dense_free(fft->shared[i].weights);
    free(fft->shared);
    free(fft->inverse);
    free(fft->route);
    free(fft);
}

int
ss_fft_covers(const struct fft *fft, size_t i)
{
    return fft != NULL && fft->route[i].kind != BY_SUM;
}

double
ss_fft_cost(const struct fft *fft)
{
    return fft->cost;
}

size_t
ss_fft_unit(const ss_morlet *plan)
{
    double unit = 1;
    for (size_t i = 0; i < plan->n_scales && plan->fft != NULL; i++) {
        const route *r = &plan->fft->route[i];
        if (r->kind != LATTICE || plan->opts.dense)
            continue;
        double step = step_of(&plan->fft->level[r->level], r);
        while (step != floor(step))     /* a multiple of it that is a whole number */
            step *= 2;
        unit = fmax(unit, step);        /* they differ by powers of two */
    }
    return (size_t)unit;
}

size_t
ss_fft_places(const struct fft *fft, size_t i)
{
    const route *r = &fft->route[i];
    return r->kind == DENSE ? phases_of(&fft->level[r->level], r) : 1;
}
