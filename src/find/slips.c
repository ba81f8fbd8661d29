/* slips.c -- find micro-slips that are too weak for a single window, and oscillations after the
 * windows. */
#include "find/fitter.h"

#include <stdlib.h>
#include "base/list.h"
#include "find/judgement.h"

#define BREAK 0.05              /* probability of cutting all windows although there is no micro-slip; it is
                                   FIT_CHANCE if neither part has the least length, as then all are refused */
#define LATEST 32.0             /* periods behind a window, see ss_slips_ring_on */

/* --- micro-slips too weak for any one window ----------------------------------------------- */

/* A micro-slip changes the oscillation by a complex gain, and about equally in all sticks, at about
 * the same distance from their starts. So at each distance the gain is tried as one more parameter,
 * in one linear step from the fit at hand (a score test): H and g gather J'J and J'r over the windows;
 * g' H^-1 g over the noise is chi-square of two degrees of freedom if all is well.  w and s are held, as
 * if they were known: that makes H larger and the test less keen (with them free, windows are cut
 * where nothing is wrong, and a fifth fewer fits are left behind a high-pass).
 * A train of micro-slips changes it by that once a period, at the same phase. */
typedef struct score {
    double h[2][2], g[2];       /* of the real and the imaginary part of the gain; h: its lower half */
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

/* Add the products of a change of a window's gain with itself and the residual.  The change is the columns
 * c cos + s sin of `once`; y is it in the orthonormal columns. */
static void
add_score(const varpro_factor *f, const linear *fitted, const varpro_sums *once, const varpro_sums *twice,
          score *to)
{
    const size_t m = f->m, at_cos = m - 2, at_sin = m - 1;
    const double c[] = { fitted->a, fitted->b }, s[] = { fitted->b, -fitted->a };
    double y[2][VARPRO_COLUMNS], of[VARPRO_COLUMNS];
    for (int p = 0; p < 2; p++) {
        for (int i = 0; i < VARPRO_COLUMNS; i++)
            of[i] = c[p] * once->g[at_cos][i] + s[p] * once->g[at_sin][i];
        ss_varpro_substitute(f, of, y[p], m);
        to->g[p] += c[p] * once->x[at_cos] + s[p] * once->x[at_sin];
        for (size_t i = 0; i < m; i++)
            to->g[p] -= y[p][i] * f->y[i];
        for (int i = 0; i < VARPRO_COLUMNS; i++)
            of[i] = c[p] * twice->g[at_cos][i] + s[p] * twice->g[at_sin][i];
        for (int q = 0; q <= p; q++) {
            to->h[p][q] += c[q] * of[at_cos] + s[q] * of[at_sin];
            for (size_t i = 0; i < m; i++)
                to->h[p][q] -= y[p][i] * y[q][i];
        }
    }
}

/* Add the scores of a window at the places first, first + step, ... behind its start; again: the gain changes at
 * the place and once a period behind it. */
static void
add_scores(fitter *k, ss_window win, size_t first, size_t step, size_t n_places, int again, score *to)
{
    const size_t length = ss_window_length(win);
    if (length == 0)
        return;
    linear fitted = ss_varpro_project(&k->fit, win);
    varpro_sums behind, once, twice;
    size_t end = length;
    ss_varpro_sums_start(&k->fit, win.first, &behind);
    for (size_t l = n_places; l-- > 0;) {
        size_t at = first + l * step;
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

/* g' H^-1 g; 0: no window reaches there. */
static double
statistic(const score *at)
{
    double real = at->h[0][0], both = at->h[1][0], imaginary = at->h[1][1], det = real * imaginary - both * both;
    double a = at->g[0], b = at->g[1];
    return real > 0 && det > 0 ? (imaginary * a * a - 2 * both * a * b + real * b * b) / det : 0;
}

ss_status
ss_slips_find(fitter *k, size_t *at)
{
    size_t step = periods(k, FIT_BLOCK), longest = 0;
    for (size_t i = 0; i < k->n; i++)
        longest = ss_window_length(k->window[i]) > longest ? ss_window_length(k->window[i]) : longest;
    size_t n_places = longest / step;
    score *place = calloc(n_places + 1, sizeof *place);
    if (place == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < k->n; i++)
        add_scores(k, k->window[i], step, step, n_places, 0, place);
    double most = 1;
    *at = 0;
    for (size_t l = 0; l < n_places; l++) {
        size_t here = (l + 1) * step, longer = here > longest - here ? here : longest - here;
        double chance = longer < periods(k, FIT_LEAST) ? FIT_CHANCE : BREAK;
        double over = statistic(&place[l]) / (k->noise * ss_chisq2(chance / (double)n_places));
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
ss_slips_recur(fitter *k)
{
    enum { PHASES = 8 };        /* of a period at which micro-slips are tried */
    score phase[PHASES] = { { .g = { 0 } } };
    size_t step = periods(k, 1. / PHASES);
    for (size_t i = 0; i < k->n; i++)
        add_scores(k, k->window[i], step, step, PHASES, 1, phase);
    for (size_t l = 0; l < PHASES; l++)
        if (statistic(&phase[l]) > k->noise * ss_chisq2(BREAK / PHASES))
            return 1;
    return 0;
}

typedef struct change {
    double statistic;           /* of the gain */
    size_t window;
} change;

/* Drop several windows at once: dropping one by one would take as many fits as windows. */
ss_status
ss_slips_drop_worst(fitter *k, size_t at)
{
    enum { PART = 32 };         /* of the windows is dropped, and one */
    change *found = malloc((k->n + 1) * sizeof *found);
    size_t count = 0;
    if (found == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < k->n; i++) {
        score s = { .g = { 0 } };
        if (ss_window_length(k->window[i]) <= at)
            continue;
        add_scores(k, k->window[i], at, 1, 1, 0, &s);
        found[count++] = (change){ statistic(&s), i };
    }
    if (count > 1)
        qsort(found, count, sizeof *found, ss_ascending);
    for (size_t i = count; i > 0 && i >= count - count / PART; i--) {
        ss_window *worst = &k->window[found[i - 1].window];
        worst->end = worst->first;
    }
    free(found);
    return SS_OK;
}

/* --- oscillations that go on behind the windows -------------------------------------------- */

typedef struct tail {           /* behind a window */
    double left;                /* mean square that the ringing leaves there */
    ss_window at;               /* empty: there are not enough samples */
} tail;

/* As many samples as the least length has, so many periods behind each window and before the next one. */
static void
find_tails(fitter *k, double late_by, tail *behind)
{
    size_t limit = k->of->n;
    for (size_t i = k->n; i-- > 0;) {
        ss_window win = k->window[i];
        size_t first = win.end + periods(k, late_by);
        ss_window late = { first, first + periods(k, FIT_LEAST) };
        behind[i] = (tail){ 0, { 0, 0 } };
        if (ss_window_length(win) == 0)
            continue;
        if (late.end <= limit && !ss_sticks_is_barred(k, (ss_window){ win.end, late.end })) {
            double mean = ss_varpro_project(&k->fit, win).ring / (double)ss_window_length(win);
            double apart = (double)(late.first + late.end - win.first - win.end) / 2;
            behind[i] = (tail){ mean * exp(-2 * k->fit.s * apart), late };
        }
        limit = win.first;
    }
}

/* Is there an oscillation with the w and s of k->fit, of more than LARGER times the residual's amplitude? */
static int
rings_there(fitter *k, tail behind)
{
    linear fitted = ss_varpro_project(&k->fit, behind.at);
    size_t m = ss_window_length(behind.at);
    int is_one = fitted.ring > NEARLY * (fitted.ring + fitted.rss)
        || ss_sticks_belong(k, fitted.rss, m - ss_varpro_columns(&k->fit));
    return is_one && fitted.ring > LARGER * LARGER * (double)m * behind.left + k->noise * ss_chisq2(FIT_CHANCE);
}

/* Does the oscillation go on behind more than half of the windows, at growing distances?  A train of micro-slips looks
 * like a strongly damped oscillation, but the contact rings on behind it. */
ss_status
ss_slips_ring_on(fitter *k, int *is)
{
    tail *behind = malloc((k->n + 1) * sizeof *behind);
    if (behind == NULL)
        return SS_ENOMEM;
    for (double late_by = 2; late_by <= LATEST && !*is; late_by *= 2) {
        size_t seen = 0, on = 0;
        find_tails(k, late_by, behind);
        for (size_t i = 0; i < k->n; i++)
            if (ss_window_length(behind[i].at) > 0) {
                seen++;
                on += (size_t)rings_there(k, behind[i]);
            }
        *is = seen >= FIT_FEW && 2 * on > seen;
    }
    free(behind);
    return SS_OK;
}
