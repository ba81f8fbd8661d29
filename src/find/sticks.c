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

#define TRIM_START 0.1          /* periods at the start found that are left out, as at the end */
enum { PLACES = 16, ROOM = 4 * PLACES };         /* places in a period; for those in three */

static size_t
least_of(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* What a chi-square of q degrees of freedom exceeds as a Gaussian exceeds so many standard deviations, within
 * 3 % (Wilson and Hilferty 1931). */
static double
chi_square(double q, double deviations)
{
    double v = 2 / (9 * q);
    return q * pow(1 - v + deviations * sqrt(v), 3);
}

/* The noise, by the median over the windows, as some may contain more than the oscillation; it is at least
 * the misfit that is allowed. */
ss_status
ss_sticks_noise(fitter *k)
{
    double *variance = malloc(2 * k->n * sizeof *variance), *ring = variance + k->n;
    size_t used = 0, columns = ss_varpro_columns(&k->fit);
    if (variance == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < k->n; i++) {
        size_t length = ss_window_length(k->window[i]);
        if (length <= columns)
            continue;
        linear fitted = ss_varpro_project(&k->fit, k->window[i]);
        variance[used] = fitted.rss / chi_square((double)(length - columns), 0);
        ring[used++] = fitted.ring / (double)length;
    }
    if (used > 0)
        k->noise = fmax(gsl_stats_select(variance, 1, used, used / 2),
                        FIT_MISFIT * FIT_MISFIT * gsl_stats_select(ring, 1, used, used / 2));
    free(variance);
    return SS_OK;
}

/* The number of bars that begin before sample i. */
static size_t
bars_before(const fitter *k, size_t i)
{
    size_t lo = 0, hi = k->of->n_bars;
    while (lo < hi) {
        size_t mid = lo + (hi - lo) / 2;
        if (k->of->bar[mid].first < i)
            lo = mid + 1;
        else
            hi = mid;
    }
    return lo;
}

int
ss_sticks_is_barred(const fitter *k, ss_window win)
{
    size_t b = bars_before(k, win.end);
    return b > 0 && k->of->bar[b - 1].end > win.first;
}

ss_window
ss_sticks_place(fitter *k, size_t anchor, double size_in_periods)
{
    size_t size = periods(k, size_in_periods), step = 1 + periods(k, 1) / PLACES;
    size_t before = periods(k, 2), after = periods(k, 1), fewest = ss_varpro_columns(&k->fit) + 2;
    linear fitted[ROOM];
    ss_window place[ROOM], best = { 0, 0 };
    double most = 0, least = INFINITY;
    size_t n = 0;
    size = size > fewest ? size : fewest;
    for (size_t first = anchor > before ? anchor - before : 0;
         first <= anchor + after && first + size <= k->of->n && n < ROOM; first += step) {
        place[n] = (ss_window){ first, first + size };
        if (ss_sticks_is_barred(k, place[n]))
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
ss_sticks_belong(const fitter *k, double rise, size_t q)
{
    return rise <= k->noise * chi_square((double)q, gsl_cdf_ugaussian_Qinv(FIT_CHANCE));
}

/* Grow a window about a core to at most `longest` samples within room, backwards and then forwards, in steps
 * down to one sample.  Empty: the core itself is no oscillation. */
static ss_window
grow(fitter *k, ss_window core, ss_window room, size_t longest)
{
    ss_window win = core;
    size_t length = ss_window_length(core);
    if (length == 0 || length >= longest)
        return core;
    size_t left = least_of(core.first - room.first, longest - length);
    varpro_sums sums;
    ss_varpro_sums_start(&k->fit, core.first - left, &sums);
    ss_varpro_sums_add(&k->fit, core, &sums);
    if (!ss_sticks_belong(k, ss_varpro_left(&sums), length - ss_varpro_columns(&k->fit)))
        return (ss_window){ 0, 0 };
    for (int backwards = 1; backwards >= 0; backwards--) {
        double start = ss_varpro_left(&sums), rss = start;
        size_t most = backwards ? left : least_of(room.end - win.end, longest - ss_window_length(win)), added = 0;
        for (size_t step = periods(k, FIT_BLOCK); step > 0; step /= 2)
            while (added + step <= most) {
                varpro_sums more = sums;
                ss_window block = { backwards ? win.first - step : win.end,
                                    backwards ? win.first : win.end + step };
                ss_varpro_sums_add(&k->fit, block, &more);
                double now = ss_varpro_left(&more);
                if (!ss_sticks_belong(k, now - rss, step) || !ss_sticks_belong(k, now - start, added + step))
                    break;
                win = (ss_window){ backwards ? block.first : win.first, backwards ? win.end : block.end };
                sums = more;
                rss = now;
                added += step;
            }
    }
    return win;
}

void
ss_sticks_grow(fitter *k, const ss_window *core, size_t every, size_t limit)
{
    for (size_t i = 0; i < k->n; i += every) {
        ss_window room = { i > 0 ? core[i - 1].end : 0, i + 1 < k->n ? core[i + 1].first : k->of->n };
        size_t b = bars_before(k, core[i].end);
        if (b > 0 && k->of->bar[b - 1].end > room.first)
            room.first = k->of->bar[b - 1].end;
        if (b < k->of->n_bars && k->of->bar[b].first < room.end)
            room.end = k->of->bar[b].first;
        room.first = least_of(room.first, core[i].first);
        room.end = room.end > core[i].end ? room.end : core[i].end;
        k->window[i] = grow(k, core[i], room, limit);
    }
}

/* --- cutting windows ------------------------------------------------------------------------- */

/* The fewest samples of a window: more than all columns. */
static size_t
least_length(const fitter *k)
{
    size_t least = periods(k, FIT_LEAST);
    return least > VARPRO_COLUMNS ? least : VARPRO_COLUMNS + 1;
}

/* The window without the ends that are cut off; empty: it is shorter than the least length. */
static ss_window
keep_off(const fitter *k, ss_window win, size_t start, size_t end)
{
    if (ss_window_length(win) < start + end + least_length(k))
        return (ss_window){ win.first, win.first };
    return (ss_window){ win.first + start, win.end - end };
}

/* The part of a window before a place in it, or behind it, trimmed at the place if it stays long enough.  A
 * window that does not reach the place stays whole. */
static ss_window
part(const fitter *k, ss_window win, size_t at, int behind)
{
    size_t least = least_length(k), length = ss_window_length(win);
    if (at >= length)
        return behind ? (ss_window){ win.first, win.first } : win;
    size_t kept = behind ? length - at : at, spare = kept > least ? kept - least : 0;
    size_t off = length - kept + least_of(periods(k, FIT_TRIM_END), spare);
    return behind ? keep_off(k, win, off, 0) : keep_off(k, win, 0, off);
}

int
ss_sticks_split(fitter *k, size_t at)
{
    size_t all = 0, left[2] = { 0, 0 };
    for (size_t i = 0; i < k->n; i++) {
        all += ss_window_length(k->window[i]);
        for (int behind = 0; behind < 2; behind++)
            left[behind] += ss_window_length(part(k, k->window[i], at, behind));
    }
    int behind = left[1] > left[0];
    if (3 * left[behind] < all)
        return 0;
    for (size_t i = 0; i < k->n; i++)
        k->window[i] = part(k, k->window[i], at, behind);
    return 1;
}

ss_window
ss_sticks_trim(const fitter *k, ss_window win)
{
    size_t least = least_length(k), length = ss_window_length(win);
    size_t spare = length > least ? length - least : 0, end = least_of(periods(k, FIT_TRIM_END), spare);
    return keep_off(k, win, least_of(periods(k, TRIM_START), spare - end), end);
}
