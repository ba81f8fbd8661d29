/* slips.c -- find micro-slips that are too weak for a single window, and oscillations after the
 * windows. */
#include "find/fitter.h"

#include <stdlib.h>
#include <string.h>
#include "base/sort.h"

#define BREAK 0.05              /* probability of cutting all windows although there is no micro-slip */
#define BREAK_EARLY 1e-3        /* the same if neither part has the least length: then all windows are
                                   refused */
#define LATEST 32.0             /* behind a window, see rings_on */
#define LOUDER 1.5              /* times the residual: an oscillation that is louder rings on */

/* --- micro-slips too weak for any one window ----------------------------------------------- */

/* A micro-slip changes the oscillation by a complex gain, and about equally in all sticks, at about
 * the same distance from their starts. So at each distance the gain is tried as a third parameter
 * beside w and s, in one linear step from the fit at hand (a score test): H and g gather J'J and J'r
 * over the windows; g' H^-1 g over the noise is chi-square of two degrees of freedom if all is well.
 * A train of micro-slips changes it by that once a period, at the same phase. */
enum { PARAMETERS = 4 };        /* w, s, real and imaginary part of the gain */
typedef struct score {
    double h[PARAMETERS * PARAMETERS], g[PARAMETERS];
} score;

static void
add_sums(varpro_sums *to, const varpro_sums *of, double times)
{
    for (int j = 0; j < VARPRO_COLUMNS; j++) {
        to->x[j] += times * of->x[j];
        for (int k = 0; k < VARPRO_COLUMNS; k++)
            to->g[j][k] += times * of->g[j][k];
    }
}

/* Sums of products with a column that counts the changes of a window's gain so far (one at a place, and one
 * each period from there), and with its square. */
static void
count_changes(fitter *k, ss_window win, size_t at, varpro_sums *once, varpro_sums *twice)
{
    varpro_sums behind;
    double period = 2 * M_PI / k->fit.w;
    size_t end = ss_window_length(win), changes = (size_t)((double)(end - 1 - at) / period) + 1;
    ss_varpro_sums_start(&k->fit, win.first, &behind);
    *once = *twice = behind;
    for (; changes > 0; changes--) {
        size_t from = at + (size_t)ceil((double)(changes - 1) * period);
        ss_varpro_sums_add(&k->fit, (ss_window){ win.first + from, win.first + end }, &behind);
        end = from;
        add_sums(once, &behind, 1);
        add_sums(twice, &behind, 2 * (double)changes - 1);
    }
}

/* The products of c cos + s sin with all columns. */
static void
step_column(const varpro_sums *sums, double c, double s, double of[VARPRO_COLUMNS])
{
    const double *by_cos = sums->g[sums->m - 2], *by_sin = sums->g[sums->m - 1];
    for (int j = 0; j < VARPRO_COLUMNS; j++)
        of[j] = c * by_cos[j] + s * by_sin[j];
}

/* Add the products of a change of a window's gain with w, s and the residual.  y is the change in the
 * orthonormal columns; the derivatives lie in the last two of these. */
static void
add_score(const varpro_factor *f, const linear *fitted, const varpro_sums *once,
          const varpro_sums *twice, score *to)
{
    const size_t left = f->m, at_cos = left - 2, at_sin = left - 1;
    const double c[] = { fitted->a, fitted->b }, s[] = { fitted->b, -fitted->a };
    double j[PARAMETERS][2], y[2][VARPRO_COLUMNS], of[VARPRO_COLUMNS];
    ss_varpro_derivatives(f, fitted->a, fitted->b, j[0], j[1]);
    for (int p = 0; p < 2; p++) {
        step_column(once, c[p], s[p], of);
        ss_varpro_substitute(f, of, y[p]);
        memcpy(j[2 + p], y[p] + left, sizeof j[0]);
        double g = c[p] * once->x[at_cos] + s[p] * once->x[at_sin];
        for (size_t i = 0; i < left; i++)
            g -= y[p][i] * f->y[i];
        to->g[2 + p] += g;
        if (twice != once)
            step_column(twice, c[p], s[p], of);
        for (int q = 0; q <= p; q++) {
            double h = c[q] * of[at_cos] + s[q] * of[at_sin];
            for (size_t i = 0; i < left; i++)
                h -= y[p][i] * y[q][i];
            to->h[(2 + p) * PARAMETERS + 2 + q] += h;
        }
    }
    for (int p = 2; p < PARAMETERS; p++)
        for (int q = 0; q < 2; q++)
            to->h[p * PARAMETERS + q] += j[p][0] * j[q][0] + j[p][1] * j[q][1];
}

/* Add the scores of a window at the places first, first + step, ... behind its start, or before its
 * end; again: the gain changes at the place and once a period behind it. */
static void
add_scores(fitter *k, ss_window win, size_t first, size_t step, size_t n_places, int from_end, int again,
           score *to)
{
    linear fitted = ss_varpro_project(&k->fit, win);
    const normal *n = &fitted.normal;
    varpro_sums behind, once, twice;
    const size_t length = ss_window_length(win);
    size_t end = length;
    ss_varpro_sums_start(&k->fit, win.first, &behind);
    for (size_t i = 0; i < n_places; i++) {     /* the last place first */
        size_t l = from_end ? i : n_places - 1 - i, at = first + l * step;
        if (from_end)
            at = at < length ? length - at : length;
        to[l].h[0] += n->ww, to[l].h[PARAMETERS] += n->ws, to[l].h[PARAMETERS + 1] += n->ss;
        to[l].g[0] += n->w, to[l].g[1] += n->s;
        if (at >= length)
            continue;
        if (again) {
            count_changes(k, win, at, &once, &twice);
            add_score(&k->fit.factor, &fitted, &once, &twice, &to[l]);
            continue;
        }
        ss_varpro_sums_add(&k->fit, (ss_window){ win.first + at, win.first + end }, &behind);
        add_score(&k->fit.factor, &fitted, &behind, &behind, &to[l]);
        end = at;
    }
}

/* g' H^-1 g by H = L D L', or 0 if H is not positive definite, since no window reaches there; destroys both. */
static double
statistic(score *at)
{
    double sum = 0;
    for (int p = 0; p < PARAMETERS; p++) {
        const double *pivot = at->h + p * PARAMETERS;
        if (!(pivot[p] > 0))
            return 0;
        sum += at->g[p] * at->g[p] / pivot[p];
        for (int q = p + 1; q < PARAMETERS; q++) {
            double *row = at->h + q * PARAMETERS, part = row[p] / pivot[p];
            at->g[q] -= part * at->g[p];
            for (int r = p; r < PARAMETERS; r++)
                row[r] -= part * pivot[r];
        }
    }
    return sum;
}

ss_status
ss_slips_find(fitter *k, const ss_window *window, size_t n, int from_end, size_t *at)
{
    size_t step = periods(k, FIT_BLOCK), longest = 0;
    for (size_t i = 0; i < n; i++)
        longest = ss_window_length(window[i]) > longest ? ss_window_length(window[i]) : longest;
    size_t n_places = longest / step;
    score *place = calloc(n_places + 1, sizeof *place);
    if (place == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++)
        if (ss_window_length(window[i]) > 0)
            add_scores(k, window[i], step, step, n_places, from_end, 0, place);
    double most = 1;
    *at = 0;
    for (size_t l = 0; l < n_places; l++) {
        size_t here = (l + 1) * step, longer = here > longest - here ? here : longest - here;
        double chance = longer < periods(k, FIT_LEAST) ? BREAK_EARLY : BREAK;
        double limit = k->noise * ss_chisq2(chance / (double)n_places);
        double over = statistic(&place[l]) / limit;
        if (over > most) {
            most = over;
            *at = here;
        }
    }
    free(place);
    return SS_OK;
}

/* A train of micro-slips looks like a damping that the contact does not have. */
int
ss_slips_recur(fitter *k, const ss_window *window, size_t n)
{
    enum { PHASES = 8 };        /* of a period at which micro-slips are tried */
    score phase[PHASES] = { { { 0 }, { 0 } } };
    size_t step = periods(k, 1. / PHASES);
    for (size_t i = 0; i < n; i++)
        if (ss_window_length(window[i]) > 0)
            add_scores(k, window[i], step, step, PHASES, 0, 1, phase);
    double limit = k->noise * ss_chisq2(BREAK / PHASES);
    for (size_t l = 0; l < PHASES; l++)
        if (statistic(&phase[l]) > limit)
            return 1;
    return 0;
}

typedef struct change {
    double statistic;           /* of the gain */
    size_t window;
} change;

/* Drop several windows at once: dropping one by one would take as many fits as windows. */
ss_status
ss_slips_drop_worst(fitter *k, ss_window *window, size_t n, size_t at, int from_end)
{
    enum { PART = 32 };         /* of the windows is dropped, and one */
    change *found = malloc((n + 1) * sizeof *found);
    size_t count = 0;
    if (found == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        score s = { { 0 }, { 0 } };
        if (ss_window_length(window[i]) <= at)
            continue;
        add_scores(k, window[i], at, 1, 1, from_end, 0, &s);
        found[count++] = (change){ statistic(&s), i };
    }
    if (count > 1)
        qsort(found, count, sizeof *found, ss_ascending);
    for (size_t left = count - count / PART; count > 0 && count >= left; count--)
        window[found[count - 1].window].end = window[found[count - 1].window].first;
    free(found);
    return SS_OK;
}

/* --- oscillations that go on behind the windows -------------------------------------------- */

typedef struct tail {           /* behind a window */
    double left;                /* mean square that the ringing leaves there */
    ss_window at;
} tail;

/* The samples so many periods behind the window: as many as the least length has, before limit; empty: there
 * are not enough. */
static tail
tail_of(fitter *k, ss_window win, double late_by, size_t limit)
{
    size_t first = win.end + periods(k, late_by);
    ss_window late = { first, first + periods(k, FIT_LEAST) };
    if (ss_window_length(win) == 0 || late.end > limit
        || ss_sticks_has_gap(k, (ss_window){ win.end, late.end }))
        return (tail){ 0, { 0, 0 } };
    double mean = ss_varpro_project(&k->fit, win).ring / (double)ss_window_length(win);
    double apart = (double)(late.first + late.end - win.first - win.end) / 2;
    return (tail){ mean * exp(-2 * k->fit.s * apart), late };
}

/* Is there an oscillation with the w and s of k->fit, of more than LOUDER times the residual's amplitude? */
static int
rings_there(fitter *k, tail behind)
{
    linear fitted = ss_varpro_project(&k->fit, behind.at);
    double m = (double)ss_window_length(behind.at);
    int is_one = fitted.ring > FIT_EXPLAINED * (fitted.ring + fitted.rss)
        || ss_sticks_belong(k, fitted.rss, ss_window_length(behind.at) - ss_varpro_columns(&k->fit));
    return is_one && fitted.ring > LOUDER * LOUDER * m * behind.left
        + k->noise * ss_chisq2(FIT_CHANCE);
}

/* Does it ring on, or hum at a frequency nearby, behind more than half of the windows? */
static int
rings_behind(fitter *k, const tail *behind, size_t n)
{
    static const double tone[] = { 0, 0.7, 0.85, 1, 1.15, 1.3 };   /* re w; 0: it itself */
    const double w = k->fit.w, s = k->fit.s;
    size_t seen = 0, most = 0;
    for (size_t t = 0; t < sizeof tone / sizeof *tone; t++) {
        size_t on = seen = 0;
        if (tone[t] > 0)
            k->fit.w = tone[t] * w, k->fit.s = 0;
        for (size_t i = 0; i < n; i++)
            if (ss_window_length(behind[i].at) > 0) {
                seen++;
                on += (size_t)rings_there(k, behind[i]);
            }
        most = on > most ? on : most;
    }
    k->fit.w = w, k->fit.s = s;
    return seen >= FIT_FEW && 2 * most > seen;
}

/* Does something go on behind the windows, at growing distances?  A train of micro-slips looks like a
 * strongly damped oscillation, but the contact rings on behind it; a hum goes on, too. */
ss_status
ss_slips_ring_on(fitter *k, const ss_window *window, size_t n, int *is)
{
    tail *behind = malloc((n + 1) * sizeof *behind);
    if (behind == NULL)
        return SS_ENOMEM;
    *is = 0;
    for (double late_by = 2; late_by <= LATEST && !*is; late_by *= 2) {
        size_t limit = k->n;
        for (size_t i = n; i-- > 0;) {
            behind[i] = tail_of(k, window[i], late_by, limit);
            limit = ss_window_length(window[i]) > 0 ? window[i].first : limit;
        }
        *is = rings_behind(k, behind, n);
    }
    free(behind);
    return SS_OK;
}

