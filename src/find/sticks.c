/* sticks.c -- find where a stick begins and ends.
 *
 * A core shorter than any usable stick is placed where an oscillation explains most; from there
 * the window grows.  If q more samples still belong to the stick, then with w and s fixed they
 * raise the sum of squares by the noise's variance times chi-square of q degrees of freedom.  The
 * window stops growing when they raise it by more. */
#include "find/fitter.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>
#include <stdlib.h>

#define TRIM_START 0.1          /* periods at the ends found that are left out: a misfit not seen yet may
                                   hide there */
enum { PLACES = 16, MOST_PLACES = 4 * PLACES };         /* places in the core, which is a period; in all */

/* The noise, by the median over the windows, as some may contain more than the oscillation; it is at least
 * the misfit that is allowed. */
ss_status
ss_sticks_noise(fitter *k, const ss_window *window, size_t n)
{
    double *variance = malloc(2 * n * sizeof *variance);
    size_t used = 0, columns = ss_varpro_columns(&k->fit);
    if (variance == NULL)
        return SS_ENOMEM;
    double *ring = variance + n;
    for (size_t i = 0; i < n; i++) {
        if (ss_window_length(window[i]) <= columns)
            continue;
        linear fitted = ss_varpro_project(&k->fit, window[i]);
        size_t freedom = ss_window_length(window[i]) - columns;
        if (!(k->median[freedom] > 0))
            k->median[freedom] = gsl_cdf_chisq_Pinv(0.5, (double)freedom);
        variance[used] = fitted.rss / k->median[freedom];
        ring[used++] = fitted.ring / (double)ss_window_length(window[i]);
    }
    if (used > 0)
        k->noise = fmax(gsl_stats_select(variance, 1, used, used / 2),
                        FIT_MISFIT * FIT_MISFIT * gsl_stats_select(ring, 1, used, used / 2));
    free(variance);
    return SS_OK;
}

/* The number of gaps that begin before sample i. */
static size_t
gaps_before(const fitter *k, size_t i)
{
    size_t lo = 0, hi = k->n_gaps;
    while (lo < hi) {
        size_t mid = lo + (hi - lo) / 2;
        if (k->gap[mid].first < i)
            lo = mid + 1;
        else
            hi = mid;
    }
    return lo;
}

int
ss_sticks_has_gap(const fitter *k, ss_window win)
{
    size_t g = gaps_before(k, win.end);
    return g > 0 && k->gap[g - 1].end > win.first;
}

ss_window
ss_sticks_place(fitter *k, size_t anchor, double size_in_periods)
{
    size_t size = periods(k, size_in_periods), step = 1 + periods(k, 1) / PLACES;
    size_t before = periods(k, 2), after = periods(k, 1);
    size_t fewest = ss_varpro_columns(&k->fit) + 2;
    size = size > fewest ? size : fewest;
    linear fitted[MOST_PLACES];
    ss_window place[MOST_PLACES], best = { 0, 0 };
    double most = 0, least = INFINITY;
    size_t n = 0;
    for (size_t first = anchor > before ? anchor - before : 0;
         first <= anchor + after && first + size <= k->n && n < MOST_PLACES; first += step) {
        place[n] = (ss_window){ first, first + size };
        if (ss_sticks_has_gap(k, place[n]))
            continue;
        fitted[n] = ss_varpro_project(&k->fit, place[n]);
        most = fmax(most, fitted[n++].ring);
    }
    for (size_t i = 0; i < n; i++)
        if (fitted[i].ring >= 0.25 * most && fitted[i].rss < least) {
            least = fitted[i].rss;
            best = place[i];
        }
    return best;
}

int
ss_sticks_belong(fitter *k, double rise, size_t q)
{
    if (!(k->limit[q] > 0))
        k->limit[q] = gsl_cdf_chisq_Qinv(FIT_CHANCE, (double)q);
    return rise <= k->noise * k->limit[q];
}

/* Move one end of the window outwards, by at most room samples, in steps down to one sample.  sums are
 * those of the window. */
static ss_window
grow(fitter *k, ss_window win, varpro_sums *sums, size_t room, int backwards)
{
    double start = ss_varpro_left(sums), rss = start;
    size_t added = 0;
    for (size_t step = periods(k, FIT_BLOCK); step > 0; step /= 2)
        while (added + step <= room) {
            varpro_sums more = *sums;
            ss_window block = { win.end, win.end + step };
            if (backwards)
                block = (ss_window){ win.first - step, win.first };
            ss_varpro_sums_add(&k->fit, block, &more);
            double now = ss_varpro_left(&more);
            if (!ss_sticks_belong(k, now - rss, step)
                || !ss_sticks_belong(k, now - start, added + step))
                break;
            *sums = more;
            if (backwards)
                win.first -= step;
            else
                win.end += step;
            rss = now;
            added += step;
        }
    return win;
}

static ss_window
grow_both(fitter *k, ss_window core, size_t low, size_t high, size_t longest)
{
    if (ss_window_length(core) >= longest)
        return core;
    size_t most = longest - ss_window_length(core), left = core.first - low;
    varpro_sums sums;
    if (ss_window_length(core) == 0)
        return (ss_window){ 0, 0 };
    left = left < most ? left : most;
    ss_varpro_sums_start(&k->fit, core.first - left, &sums);
    ss_varpro_sums_add(&k->fit, core, &sums);
    if (!ss_sticks_belong(k, ss_varpro_left(&sums),
                          ss_window_length(core) - ss_varpro_columns(&k->fit)))
        return (ss_window){ 0, 0 };
    ss_window win = grow(k, core, &sums, left, 1);
    size_t right = high - win.end;
    most = longest - ss_window_length(win);
    return grow(k, win, &sums, right < most ? right : most, 0);
}

/* The window without the ends that are cut off; empty: it is shorter than the least length. */
static ss_window
keep_off(const fitter *k, ss_window win, size_t start, size_t end)
{
    if (ss_window_length(win) < start + end + periods(k, FIT_LEAST))
        return (ss_window){ win.first, win.first };
    return (ss_window){ win.first + start, win.end - end };
}

/* The part of a window before a place in it, or behind it, trimmed at the place if it stays long enough.  A
 * window that does not reach the place stays whole. */
static ss_window
part(const fitter *k, ss_window win, size_t at, int from_end, int behind)
{
    size_t least = periods(k, FIT_LEAST), off = periods(k, FIT_TRIM_END), length = ss_window_length(win);
    if (at >= length)
        return behind != from_end ? (ss_window){ win.first, win.first } : win;
    size_t kept = behind != from_end ? length - at : at;
    size_t spare = kept > least ? kept - least : 0;
    off = length - kept + (off < spare ? off : spare);
    return behind ? keep_off(k, win, off, 0) : keep_off(k, win, 0, off);
}

int
ss_sticks_split(const fitter *k, ss_window *window, size_t n, size_t at, int from_end)
{
    size_t all = 0, left[2] = { 0, 0 };
    for (size_t i = 0; i < n; i++) {
        all += ss_window_length(window[i]);
        for (int behind = 0; behind < 2; behind++)
            left[behind] += ss_window_length(part(k, window[i], at, from_end, behind));
    }
    int behind = left[1] > left[0];
    if (3 * left[behind] < all)
        return 0;
    for (size_t i = 0; i < n; i++)
        window[i] = part(k, window[i], at, from_end, behind);
    return 1;
}

ss_window
ss_sticks_trim(const fitter *k, ss_window win)
{
    size_t least = periods(k, FIT_LEAST), start = periods(k, TRIM_START), end = periods(k, FIT_TRIM_END);
    size_t spare = ss_window_length(win) > least ? ss_window_length(win) - least : 0;
    end = end < spare ? end : spare;
    start = start < spare - end ? start : spare - end;
    return keep_off(k, win, start, end);
}

void
ss_sticks_find(fitter *k, const ss_window *core, ss_window *window, size_t n, size_t every, size_t limit)
{
    for (size_t i = 0; i < n; i += every) {
        size_t low = i > 0 ? core[i - 1].end : 0, high = i + 1 < n ? core[i + 1].first : k->n;
        size_t g = gaps_before(k, core[i].end);
        if (g > 0 && k->gap[g - 1].end > low)
            low = k->gap[g - 1].end;
        if (g < k->n_gaps && k->gap[g].first < high)
            high = k->gap[g].first;
        low = low < core[i].first ? low : core[i].first;
        high = high > core[i].end ? high : core[i].end;
        window[i] = grow_both(k, core[i], low, high, limit);
    }
}

