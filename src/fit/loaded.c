/* loaded.c -- rate and state fitted to a step.
 *
 * mu = m0 + c x + a g: g is the quasi-static slider's, pulled along the recorded path, and depends on b/a, Dc and
 * k/a only.  These are tried on a grid, at few times, which lie close where the speed changes; the best go on by
 * least squares, and the best of them to all rows.  There, what the better law leaves shows the noise, with its
 * memory; rows are then whitened by it, fitted by both laws, and so once more.  Errors are those of the whitened
 * rows. */
#include "fit/loaded.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/least.h"
#include "fit/slider.h"
#include "fit/wander.h"

/* The unknowns of a fit.  Friction rings about its new value with the frequency V w, where w^2 = k/(a Dc), and
 * falls by k/a - (b/a - 1)/Dc: the difference of two numbers that may be close.  In b/a and Dc, such rings are a
 * narrow curved valley; in w and the quotient of the two, critical stiffness over k, it is straight.  DIRECT, RING
 * and STIFFNESS are logarithms, DRIFT is that over the whole way. */
enum { LEVEL, DRIFT, DIRECT, CRITICAL, RING, STIFFNESS, UNKNOWNS };
enum { STARTS = 4, NEAR = 12 };    /* NEAR: rows about a change that are not thinned */
#define FINE 1e-10              /* the slider's tolerance in fits */
#define COARSE sqrt(FINE)       /* the same on the grid, and the step of an unknown for slopes */
#define STIFF 5000              /* ways over a/k that are not tried on the grid: they take most of its time */

typedef struct start {
    double u[UNKNOWNS], squares, ratio;
} start;

typedef struct law {
    const track *record;
    int is_slip;
    wander noise;
    double u[UNKNOWNS];
    double squares;                             /* that u leaves of whitened rows; infinite: there is no fit */
    double covariance[UNKNOWNS * UNKNOWNS];
    start grid[STARTS];         /* the best of the grid */
    double *g, *moved;          /* friction of the unknowns, and if one is a little larger [n] */
    double *rows;               /* [n][UNKNOWNS + 1] */
    const ss_range *range;      /* of the unknowns */
    double *t, *load, *places;  /* the path, and friction along it */
} law;

static double
way_of(const track *r)
{
    return r->load[r->n - 1];
}

/* The slider of k_c/k, w^2 and k/a. */
static slider
slider_of(const law *l, double critical, double ring, double over)
{
    const double Dc = over / ring;
    return (slider){ l->is_slip, 1 + critical * over * Dc, Dc, over, l->record->speed };
}

/* The friction over a of some unknowns, of which one may be moved. */
static ss_status
run(const law *l, double *g, const double *u, int moved, double by, double tol)
{
    const slider s = slider_of(l, u[CRITICAL] + (moved == CRITICAL) * by, exp(u[RING] + (moved == RING) * by),
                               exp(u[STIFFNESS] - u[DIRECT] + (moved == STIFFNESS) * by));
    const track *r = l->record;
    ss_status st = ss_slider_run(l->places, &s, l->t, l->load, r->places, tol);
    memset(g, 0, r->n * sizeof *g);
    for (size_t i = 0; i < r->places; i++)
        g[r->place[i].row] += r->place[i].share * l->places[i];
    return st;
}

/* What is left of the rows, and its slopes, before they are whitened. */
static ss_status
leave(law *l, const double *u, double *residual, double *slopes)
{
    const track *r = l->record;
    const double a = exp(u[DIRECT]);
    ss_status st = run(l, l->g, u, 0, 0, FINE);
    for (size_t i = 0; residual != NULL && st == SS_OK && i < r->n; i++)
        residual[i] = r->mu[i] - u[LEVEL] - u[DRIFT] * r->load[i] / way_of(r) - a * l->g[i];
    for (int k = CRITICAL; slopes != NULL && st == SS_OK && k < UNKNOWNS; k++) {
        st = run(l, l->moved, u, k, COARSE, FINE);
        for (size_t i = 0; st == SS_OK && i < r->n; i++)
            slopes[i * UNKNOWNS + (size_t)k] = a * (l->g[i] - l->moved[i]) / COARSE;
    }
    for (size_t i = 0; slopes != NULL && st == SS_OK && i < r->n; i++) {
        double *row = &slopes[i * UNKNOWNS];
        row[LEVEL] = -1;
        row[DRIFT] = -r->load[i] / way_of(r);
        row[DIRECT] = -a * l->g[i] - row[STIFFNESS];
    }
    return st;
}

static ss_status
whitened(const double *u, double *residual, double *slopes, void *user)
{
    law *l = user;
    const track *r = l->record;
    ss_status st = leave(l, u, slopes == NULL ? residual : NULL, slopes);
    if (st == SS_OK && slopes == NULL)
        ss_wander_whiten(residual, &l->noise, r->t, residual, r->n, 1);
    else if (st == SS_OK)
        ss_wander_whiten(slopes, &l->noise, r->t, slopes, r->n, UNKNOWNS);
    return st;
}

/* --- where a fit starts -------------------------------------------------------------------- */

/* The level, the drift and a that are the best beside this friction over a; a > 0 may be given. */
static void
solve(start *s, const track *r, const double *g, double a)
{
    const size_t n = r->n;
    double mean[3] = { gsl_stats_mean(r->load, 1, n), gsl_stats_mean(g, 1, n), gsl_stats_mean(r->mu, 1, n) };
    double xx = 0, xg = 0, xm = 0;
    for (size_t i = 0; i < n; i++) {
        double x = r->load[i] - mean[0];
        xx += x * x;
        xg += x * (g[i] - mean[1]);
        xm += x * (r->mu[i] - mean[2]);
    }
    double gg = 0, gm = 0, mm = 0;
    for (size_t i = 0; i < n; i++) {
        double x = r->load[i] - mean[0];
        double of_g = g[i] - mean[1] - xg / xx * x, of_m = r->mu[i] - mean[2] - xm / xx * x;
        gg += of_g * of_g;
        gm += of_g * of_m;
        mm += of_m * of_m;
    }
    a = a > 0 ? a : gm / gg;
    s->squares = a > 0 ? mm + a * (a * gg - 2 * gm) : INFINITY;
    s->u[DIRECT] = log(a);
    s->u[DRIFT] = (xm - a * xg) / xx * way_of(r);
    s->u[LEVEL] = mean[2] - (xm - a * xg) / xx * mean[0] - a * mean[1];
    s->u[STIFFNESS] += s->u[DIRECT];
}

/* Keep the best starts of different b/a, the best first. */
static ss_status
try_start(start best[STARTS], law *l, double ratio, double critical, double ring, double over, double stiffness)
{
    start s = { .ratio = ratio, .u = { [CRITICAL] = critical, [RING] = ring, [STIFFNESS] = log(over) } };
    ss_status st = run(l, l->g, s.u, 0, 0, COARSE);
    int at = 0;
    if (st != SS_OK)
        return st == SS_EDATA ? SS_OK : st;
    solve(&s, l->record, l->g, stiffness / over);
    while (at < STARTS - 1 && best[at].ratio != s.ratio)
        at++;
    for (; at > 0 && s.squares < best[at - 1].squares; at--)
        best[at] = best[at - 1];
    if (s.squares < best[at].squares)
        best[at] = s;
    return SS_OK;
}

/* Try b/a, K = k Dc/a and the angular frequency V sqrt(k/(a Dc)) at which friction may ring, which needs its steps;
 * or what was best along another path. */
static ss_status
search(start best[STARTS], law *l, const law *other, double stiffness)
{
    const double way = way_of(l->record);
    ss_status st = SS_OK;
    for (int i = 0; i < STARTS; i++)
        best[i] = (start){ .ratio = NAN, .squares = INFINITY };
    for (const start *s = other != NULL ? other->grid : NULL; s != NULL && s < other->grid + STARTS; s++)
        if (st == SS_OK && isfinite(s->squares))
            st = try_start(best, l, s->ratio, s->u[CRITICAL], s->u[RING], exp(s->u[STIFFNESS] - s->u[DIRECT]),
                           stiffness);
    for (double ratio = 0; other == NULL && ratio <= 2; ratio += 0.25)
        for (double K = 1 / 32.; K < 100; K *= 4)
            for (double w = 3 / way; w < 2000 / way && st == SS_OK; w *= M_SQRT2) {
                const double Dc = sqrt(K) / w, over = sqrt(K) * w;
                if (Dc > way / 300 && Dc < way && K > ratio - 1 && over * way < STIFF)
                    st = try_start(best, l, ratio, (ratio - 1) / K, 2 * log(w), over, stiffness);
            }
    return st;
}

/* A record at few times: means of more rows the farther these are from a change.  SS_ENOMEM. */
static ss_status
thin(track *few, const track *r)
{
    *few = *r;
    few->n = few->places = 0;
    few->t = malloc(3 * r->n * sizeof *few->t);
    few->place = malloc(r->places * sizeof *few->place);
    if (few->t == NULL || few->place == NULL)
        return SS_ENOMEM;
    few->load = few->t + r->n;
    few->mu = few->load + r->n;
    const place *p = r->place, *end = p + r->places;
    for (size_t i = 0, rows; i < r->n; i += rows, few->n++) {
        size_t away = r->n;
        for (size_t k = 0; k < r->changes; k++) {
            size_t apart = i > r->change[k] ? i - r->change[k] : r->change[k] - i;
            away = apart < away ? apart : away;
        }
        rows = away / NEAR + 1 < r->n - i ? away / NEAR + 1 : r->n - i;
        rows = i > 0 ? rows : 1;
        few->t[few->n] = gsl_stats_mean(r->t + i, 1, rows);
        few->load[few->n] = gsl_stats_mean(r->load + i, 1, rows);
        few->mu[few->n] = gsl_stats_mean(r->mu + i, 1, rows);
        for (; p < end && p->row < i + rows; p++)
            if (rows == 1)
                few->place[few->places++] = (place){ p->t, p->load, few->n, p->share };
        if (rows > 1)
            few->place[few->places++] = (place){ few->t[few->n], few->load[few->n], few->n, 1 };
    }
    return SS_OK;
}

static ss_status
make_room(law *l, const track *r, int is_slip, const ss_range range[UNKNOWNS])
{
    *l = (law){ .record = r, .is_slip = is_slip, .noise = { 0, 1, 0 }, .range = range, .squares = INFINITY };
    l->g = malloc(((2 + UNKNOWNS + 1) * r->n + 3 * r->places) * sizeof *l->g);
    if (l->g == NULL)
        return SS_ENOMEM;
    l->moved = l->g + r->n;
    l->rows = l->moved + r->n;
    l->t = l->rows + (UNKNOWNS + 1) * r->n;
    l->load = l->t + r->places;
    l->places = l->load + r->places;
    for (size_t i = 0; i < r->places; i++) {
        l->t[i] = r->place[i].t;
        l->load[i] = r->place[i].load;
    }
    return SS_OK;
}

/* Find where the fit to all rows starts. */
static ss_status
begin(law *all, const law *other, double stiffness)
{
    const ss_range *range = all->range;
    track few;
    law l = { 0 };
    start s[STARTS];
    least_end end = { 0 };
    ss_status st = thin(&few, all->record);
    least how = { .rows = few.n, .unknowns = UNKNOWNS, .model = whitened, .user = &l, .range = range, .tol = 1e-7,
                  .farthest = 1 };
    if (st == SS_OK)
        st = make_room(&l, &few, all->is_slip, range);
    if (st == SS_OK)
        st = search(all->grid, &l, other, stiffness);
    memcpy(s, all->grid, sizeof s);
    for (int i = 0; st == SS_OK && i < STARTS && isfinite(s[i].squares); i++) {
        for (int k = 0; k < UNKNOWNS; k++)
            s[i].u[k] = fmax(range[k].from, fmin(s[i].u[k], range[k].to));
        how.noise = s[i].squares / (double)few.n;
        st = ss_least_fit(&end, &how, s[i].u, NULL, NULL);
        if (st == SS_OK && end.squares < all->squares) {
            memcpy(all->u, s[i].u, sizeof all->u);
            all->squares = end.squares;
        }
    }
    free(few.t);
    free(few.place);
    free(l.g);
    return st;
}

/* A number whose slopes by the unknowns are these.  noise: its variance, for which the covariance is 1. */
static ss_value
value_of(double value, const double slope[UNKNOWNS], const double *covariance, double noise)
{
    double variance = 0;
    for (int i = 0; i < UNKNOWNS; i++)
        for (int k = 0; k < UNKNOWNS; k++)
            if (slope[i] * slope[k] != 0)
                variance += slope[i] * slope[k] * covariance[i * UNKNOWNS + k];
    return (ss_value){ value, sqrt(variance * noise) };
}

static void
report(ss_step_law *out, const law *l, double noise)
{
    const double *u = l->u, *covariance = l->covariance, a = exp(u[DIRECT]), k = exp(u[STIFFNESS]);
    const slider s = slider_of(l, u[CRITICAL], exp(u[RING]), k / a);
    const double more = a * (s.ratio - 1), K = s.stiffness * s.distance, way = way_of(l->record);
    out->direct_effect = value_of(a, (double[]){ [DIRECT] = a, [STIFFNESS] = 0 }, covariance, noise);
    out->evolution_effect = value_of(a + more, (double[]){ [DIRECT] = a - more, [CRITICAL] = a * K, [RING] = -more,
                                     [STIFFNESS] = 2 * more }, covariance, noise);
    out->critical_slip_distance = value_of(s.distance, (double[]){ [DIRECT] = -s.distance, [RING] = -s.distance,
                                           [STIFFNESS] = s.distance }, covariance, noise);
    out->stiffness = value_of(k, (double[]){ [STIFFNESS] = k }, covariance, noise);
    out->drift = value_of(u[DRIFT] / way, (double[]){ [DRIFT] = 1 / way, [STIFFNESS] = 0 }, covariance, noise);
}

/* Add to a covariance what comes of an error that changes whitened rows by so much. */
static void
add_error(double *out, const law *l, const double *slopes, const double *changed)
{
    double by[UNKNOWNS] = { 0 }, moves[UNKNOWNS] = { 0 };
    for (size_t i = 0; i < l->record->n; i++)
        for (int k = 0; k < UNKNOWNS; k++)
            by[k] += slopes[i * UNKNOWNS + (size_t)k] * changed[i];
    for (int i = 0; i < UNKNOWNS * UNKNOWNS; i++)
        if (isfinite(l->covariance[i]))
            moves[i / UNKNOWNS] += l->covariance[i] * by[i % UNKNOWNS];
    for (int i = 0; i < UNKNOWNS * UNKNOWNS; i++)
        out[i] += moves[i / UNKNOWNS] * moves[i % UNKNOWNS];
}

/* Add the errors of the load point's place at its first change, and of friction wherever it stands still at one of
 * its digits, if noise does not move it from one to another. */
static ss_status
blur(law *l, double noise, double *changed, double *out)
{
    const track *r = l->record;
    double *slopes = changed + r->n, *left = l->rows;
    ss_status st = whitened(l->u, left, NULL, l);
    for (int back = 0; back < 2; back++) {
        for (size_t i = 0; i < r->places; i++)
            l->load[i] += r->place[i].row < r->change[0] ? 0 : back ? -r->blur : r->blur;
        if (st == SS_OK)
            st = back ? whitened(l->u, NULL, slopes, l) : whitened(l->u, changed, NULL, l);
    }
    if (st != SS_OK)
        return st == SS_EDATA ? SS_OK : st;
    for (size_t i = 0; i < r->n; i++)
        changed[i] -= left[i];
    add_error(out, l, slopes, changed);
    for (size_t from = 0, to = 0; r->digit > 2 * sqrt(noise) && from < r->n; from = to) {
        while (to < r->n && fabs(r->mu[to] - r->mu[from]) < r->digit / 2)
            to++;
        for (size_t i = 0; i < r->n; i++)
            changed[i] = i >= from && i < to ? r->digit / sqrt(12) : 0;
        ss_wander_whiten(changed, &l->noise, r->t, changed, r->n, 1);
        add_error(out, l, slopes, changed);
    }
    return SS_OK;
}

/* --- one step, or steps that share their numbers -------------------------------------------- */

enum { OWN = DIRECT, SHARED = UNKNOWNS - OWN };     /* level and drift are each step's own */

struct loaded {
    law law[SS_STEP_LAWS];
    ss_range range[UNKNOWNS];
    double free_rows;
    double line, logarithms;    /* squares that a line along the path leaves of whitened rows, and the logarithms
                                   of their variances */
    double *room;
};

typedef struct joint {
    loaded *const *step;
    size_t n, k, rows, unknowns;                /* law k of n steps */
    double *u, *best, *residual, *covariance;
    double *slopes;                             /* room for those of a step */
    ss_range *range;
} joint;

/* Where unknown k of step i stands among all. */
static size_t
place_of(size_t i, size_t k)
{
    return k >= OWN ? k - OWN : SHARED + OWN * i + k;
}

static double
noise_of(const loaded *s, size_t k)
{
    return s->law[k].squares / s->free_rows;
}

/* The rows of all steps, each in its noise. */
static ss_status
all_rows(const double *u, double *residual, double *slopes, void *user)
{
    const joint *j = user;
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < j->n; i++) {
        law *l = &j->step[i]->law[j->k];
        const size_t n = l->record->n;
        const double unit = sqrt(noise_of(j->step[i], j->k));
        double v[UNKNOWNS];
        for (size_t k = 0; k < UNKNOWNS; k++)
            v[k] = u[place_of(i, k)];
        st = whitened(v, residual, slopes != NULL ? j->slopes : NULL, l);
        for (size_t row = 0; row < n; row++)
            if (slopes == NULL)
                residual[row] /= unit;
            else
                for (size_t k = 0; k < UNKNOWNS; k++)
                    slopes[row * j->unknowns + place_of(i, k)] = j->slopes[row * UNKNOWNS + k] / unit;
        residual += n;
        slopes = slopes != NULL ? slopes + n * j->unknowns : NULL;
    }
    return st;
}

/* Fit a law to all rows, a few steps from what each of the first `starts` says, and on from the best of these.
 * SS_EDATA: there is no fit. */
static ss_status
fit_joint(joint *j, size_t starts)
{
    enum { FEW = 5 };
    least how = { .rows = j->rows, .unknowns = j->unknowns, .model = all_rows, .user = j, .range = j->range,
                  .steps = FEW, .tol = 1e-7, .noise = 1, .farthest = 1 };
    least_end end;
    double least_squares = INFINITY, free_rows = (double)(j->n - 1) * SHARED;
    for (size_t i = 0; i < j->n; i++) {
        free_rows += j->step[i]->free_rows;
        if (isinf(j->step[i]->law[j->k].squares))
            return SS_EDATA;
        for (size_t k = 0; k < UNKNOWNS; k++)
            j->range[place_of(i, k)] = j->step[i]->range[k];
    }
    for (size_t only = 0; only < starts; only++) {
        for (size_t i = 0; i < j->n; i++)
            for (size_t k = 0; k < UNKNOWNS; k++)
                j->u[place_of(i, k)] = j->step[k < OWN ? i : only]->law[j->k].u[k];
        ss_status st = starts > 1 ? ss_least_fit(&end, &how, j->u, NULL, NULL) : SS_OK;
        if (st == SS_OK && (starts == 1 || end.squares < least_squares)) {
            least_squares = end.squares;
            memcpy(j->best, j->u, j->unknowns * sizeof *j->u);
        } else if (st != SS_OK && st != SS_EDATA)
            return st;
    }
    how.steps = 0;
    ss_status st = ss_least_fit(&end, &how, j->best, j->residual, j->covariance);
    for (size_t i = 0, row = 0; st == SS_OK && i < j->n; i++) {
        law *l = &j->step[i]->law[j->k];
        const double noise = noise_of(j->step[i], j->k);
        l->squares = 0;
        for (size_t to = row + l->record->n; row < to; row++)
            l->squares += noise * j->residual[row] * j->residual[row];
        const double unit = end.squares / free_rows / noise_of(j->step[i], j->k);
        for (size_t e = 0; e < UNKNOWNS * UNKNOWNS; e++)
            l->covariance[e] = unit
                * j->covariance[place_of(i, e / UNKNOWNS) * j->unknowns + place_of(i, e % UNKNOWNS)];
        for (size_t e = 0; e < UNKNOWNS; e++)
            l->u[e] = j->best[place_of(i, e)];
    }
    return st;
}

/* Find the noise that the better law leaves of a step beside its slopes; both laws' squares, and a line's, become
 * those of rows whitened by it. */
static ss_status
find_noise(loaded *s, law *better)
{
    const track *r = better->record;
    const size_t n = r->n, free = UNKNOWNS - (s->range[STIFFNESS].from == s->range[STIFFNESS].to);
    double *rows = better->rows, *slopes = s->room + n, c[2];
    ss_status st = leave(better, better->u, s->room, slopes);
    for (size_t i = 0; i < n; i++) {
        memcpy(rows + i * (free + 1), slopes + i * UNKNOWNS, free * sizeof *slopes);    /* k is the last */
        rows[i * (free + 1) + free] = s->room[i];
    }
    if (st == SS_OK)
        st = ss_wander_find(&better->noise, r->t, rows, n, free + 1);
    for (law *l = s->law; l < s->law + SS_STEP_LAWS && st == SS_OK; l++) {
        l->noise = better->noise;
        if (isinf(l->squares))
            continue;
        st = whitened(l->u, s->room, NULL, l);
        l->squares = 0;
        for (size_t i = 0; i < n; i++)
            l->squares += s->room[i] * s->room[i];
    }
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < n; i++) {
        rows[2 * i] = 1;
        rows[2 * i + 1] = r->load[i] / way_of(r);
    }
    s->logarithms = ss_wander_whiten(rows, &better->noise, r->t, rows, n, 2);
    ss_wander_whiten(s->room, &better->noise, r->t, r->mu, n, 1);
    return ss_least_linear(rows, s->room, n, 2, c, &s->line, NULL);
}

/* Fit both laws, and again, to rows that are whitened by what the better one leaves. */
static ss_status
fit_both(loaded *const step[], size_t n)
{
    const int passes = n > 1 ? 2 : 3;
    size_t most = 0;
    joint j = { .step = step, .n = n, .unknowns = SHARED + OWN * n };
    for (size_t i = 0; i < n; i++) {
        j.rows += step[i]->law->record->n;
        most = step[i]->law->record->n > most ? step[i]->law->record->n : most;
    }
    j.range = malloc(j.unknowns * sizeof *j.range);
    j.u = malloc((j.unknowns * (j.unknowns + 2) + j.rows + most * UNKNOWNS) * sizeof *j.u);
    ss_status st = j.u != NULL && j.range != NULL ? SS_OK : SS_ENOMEM;
    j.best = j.u + j.unknowns;
    j.covariance = j.best + j.unknowns;
    j.residual = j.covariance + j.unknowns * j.unknowns;
    j.slopes = j.residual + j.rows;
    for (int pass = 0; pass < passes; pass++) {
        double ahead = 0;                       /* of the second law */
        for (j.k = 0; st == SS_OK && j.k < SS_STEP_LAWS; j.k++) {
            st = fit_joint(&j, pass == 0 ? n : 1);
            for (size_t i = 0; st == SS_EDATA && i < n; i++)    /* what has no fit of one step has none of all */
                step[i]->law[j.k].squares = INFINITY;
            st = st == SS_EDATA ? SS_OK : st;
        }
        for (size_t i = 0; i < n; i++)
            ahead += (double)step[i]->law->record->n * log(step[i]->law[0].squares / step[i]->law[1].squares);
        for (size_t i = 0; st == SS_OK && pass + 1 < passes && i < n && !isnan(ahead); i++)
            st = find_noise(step[i], &step[i]->law[ahead > 0]);
    }
    free(j.range);
    free(j.u);
    return st;
}

ss_status
ss_loaded_fit(loaded *const step[], size_t n)
{
    enum { ALL = UNKNOWNS * UNKNOWNS };
    ss_status st = fit_both(step, n);
    for (size_t k = 0; st == SS_OK && k < SS_STEP_LAWS; k++) {
        double shared[ALL] = { 0 };         /* blurs of one step are errors of what it shares with the others */
        for (size_t i = 0; st == SS_OK && i < n && isfinite(step[i]->law[k].squares); i++) {
            double more[ALL] = { 0 };
            st = blur(&step[i]->law[k], noise_of(step[i], k), step[i]->room, more);
            for (int e = 0; e < ALL; e++)
                if (e / UNKNOWNS < OWN || e % UNKNOWNS < OWN)
                    step[i]->law[k].covariance[e] += more[e] / noise_of(step[i], k);
                else
                    shared[e] += more[e];
        }
        for (size_t i = 0; i < n; i++)
            for (int e = 0; e < ALL; e++)
                step[i]->law[k].covariance[e] += shared[e] / noise_of(step[i], k);
    }
    return st;
}

ss_status
ss_loaded_new(loaded **out, const track *record, const loaded *other, double stiffness)
{
    const size_t n = record->n;
    const double way = way_of(record), held = log(stiffness);
    double most = 1;                /* friction may be in percent, or a stress */
    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(record->mu[i]));
    const ss_range of_stiffness = stiffness > 0 ? (ss_range){ held, held }
        : (ss_range){ log(1e-5 / way), log(1e4 * most / way) };
    const loaded empty = { .free_rows = (double)(n - UNKNOWNS + (stiffness > 0)), .line = NAN, .logarithms = NAN,
        .range = { { -1e9, 1e9 }, { -1e300, 1e300 }, { log(1e-7), log(most) }, { -1000, 2 },
                   { log(0.01 / (way * way)), log(1e9 / (way * way)) }, of_stiffness } };
    loaded *s = *out = malloc(sizeof *s);
    if (s == NULL)
        return SS_ENOMEM;
    *s = empty;
    s->room = malloc(n * (1 + UNKNOWNS) * sizeof *s->room);
    ss_status st = s->room != NULL ? SS_OK : SS_ENOMEM;
    for (int k = 0; st == SS_OK && k < SS_STEP_LAWS; k++) {
        st = make_room(&s->law[k], record, k == SS_STEP_SLIP, s->range);
        if (st == SS_OK)
            st = begin(&s->law[k], other != NULL ? &other->law[k] : NULL, stiffness);
    }
    return st;
}

ss_status
ss_loaded_report(loaded *s, ss_step_law out[SS_STEP_LAWS], double *model)
{
    const track *record = s->law->record;
    const size_t n = record->n;
    ss_status st = SS_OK;
    for (size_t k = 0; st == SS_OK && k < SS_STEP_LAWS; k++, model += n) {
        law *l = &s->law[k];
        const ss_value none = { NAN, NAN };
        out[k] = (ss_step_law){ k == SS_STEP_AGING ? "aging" : "slip", NAN, NAN, none, none, none, none, none, NAN,
                                model };
        if (isinf(l->squares)) {
            for (size_t i = 0; i < n; i++)
                model[i] = NAN;
            continue;
        }
        report(&out[k], l, noise_of(s, k));
        st = leave(l, l->u, s->room, NULL);
        for (size_t i = 0; i < n; i++)
            model[i] = record->mu[i] - s->room[i];
        const double squares = l->squares / (double)n;
        out[k].log_likelihood = -0.5 * (s->logarithms + (double)n * (log(2 * acos(-1) * squares) + 1));
        out[k].gain = 0.5 * (double)n * log(s->line / l->squares);
        out[k].noise = sqrt(squares);
    }
    return st;
}

void
ss_loaded_free(loaded *s)
{
    for (int k = 0; s != NULL && k < SS_STEP_LAWS; k++)
        free(s->law[k].g);
    if (s != NULL)
        free(s->room);
    free(s);
}
