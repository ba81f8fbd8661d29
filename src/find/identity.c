/* identity.c -- whether what rings is the contact.
 *
 * A damped oscillation in windows of a record may be of many things, and a fit is as exact whatever it is.  So
 * before a number is printed, it is compared with all that is known to look alike; each test has a row in the
 * manual's table of conditions.
 *
 * The contact rings while it sticks.  Where a slip begins, its ringing ends at once, and what force and spring
 * change there rings not at all.  A sensor or a filter that resonates, or a hum, rings on through the slip, and a
 * sensor answers each jump, kink and bend of what it senses: the end of a slip, where the contact begins to ring,
 * too, and the begin of one.  So for each stretch that no ringing, and no bent line, explains, both are fitted:
 *
 *   contact   x = p(t) + ringing until 0 + [t > 0] (jump + kink t + bend t^2)
 *   sensor    x = p(t) + ringing         + [t > 0] (what a resonator makes of these)
 *
 * with a cubic p and an event at 0, which is sought.  A low-pass may lie behind either: then its own answer to the
 * event is added.  What may not decay may be a hum, which rings on beside the event itself.
 *
 * The end of a slip is a sensor's by this, whatever rings.  Some other place must be the contact's, the same behind
 * all sticks together.  The slower a slip begins, re the ringing, the less it differs; so noise that would hide it,
 * compared with the end of a slip, speaks for neither.
 * Ringing that dies out at rest has no slips about it, and is taken as it is.
 *
 * A filter's corner has no peak, and the spectrum ends there.  The rig's own spring rings with sqrt(k/m) while it
 * slips.
 */
#include "find/search.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/spectrum.h>
#include "find/fitter.h"

#define AROUND 1.5              /* periods on either side of the middle of a stretch: more may hold two events */
#define CONTACT 0.3             /* what the sensor leaves more than the contact, in parts: less is the sensor */
#define SHOWN 1.0               /* the same: so it is the contact, whatever else may be */
#define CHANCE 2.8              /* variances of a sample: noise makes so much behind each stick, as the place of the
                                   event is chosen, and of some more sticks by chance */
#define HIDDEN 2e-4             /* noise re what an event makes: more may hide where a slip begins */
#define ROUNDING 1e-15          /* variance of a sample: less is none */
#define FLAT 1.3                /* power re the power law: with more there is a peak */
#define STEEP 3.2               /* power law re the power beyond: with more there is a corner */
#define STEP 1.67               /* from band to band, each from 1 / WIDE to WIDE of its middle */
#define WIDE 1.18
#define FINE (1 / 32.)          /* resolution re the oscillation; coarser in records of under four segments */
enum { RATE = 24 };             /* most samples of a period that are used */
enum { EVENTS = 33 };           /* places of an event that are tried, within a period of the middle */
enum { STICKS = 24, MORE = 5 }; /* most sticks that are looked behind; see CHANCE */
enum { TRIALS = 200 };          /* most of its frequencies to either side */

/* --- a filter --------------------------------------------------------------------------------- */

/* The mean density in the band about f. */
static double
mean_about(const ss_spectrum *s, double f)
{
    double sum = 0, n = 0;
    for (double k = ceil(f / WIDE / s->step); k <= f * WIDE / s->step && k < (double)s->n; k++, n++)
        sum += s->density[(size_t)k];
    return n > 0 ? sum / n : NAN;
}

/* Does the spectrum of n samples x end at f [1/sample] without a peak there?  Not in a record that is too short to
 * show this. */
static ss_status
is_edge(const double *x, size_t n, double f, int *is)
{
    ss_spectrum *s = NULL;
    ss_status st = ss_spectrum_new(&s, x, n, 1, fmax(FINE * f, 6 / (double)n), NULL);
    *is = 0;
    if (st == SS_ENOMEM)
        return st;
    if (st != SS_OK)
        return SS_OK;
    double at = mean_about(s, f), before = mean_about(s, f / STEP), law = before / mean_about(s, f / STEP / STEP);
    *is = at < FLAT * law * before && STEEP * mean_about(s, f * STEP) < law * at;
    ss_spectrum_free(s);
    return SS_OK;
}

/* --- a sensor -------------------------------------------------------------------------------- */

typedef enum ringer { BY_SENSOR, BY_CONTACT, BY_HUM, RINGERS } ringer;
enum { CUBIC = 4, RINGING = 2, EVENT = 3, FILTER = 2 };         /* columns of each */
enum { UNFILTERED = CUBIC + RINGING + EVENT, COLUMNS = UNFILTERED + FILTER };
static const double corners[] = { INFINITY, 0.7, 1, 1.4 };      /* of a filter, re the frequency; none comes first */
enum { CORNERS = sizeof corners / sizeof *corners };

/* n samples, each `skip` behind the one before; w and s by such a step. */
typedef struct stretch {
    size_t n, skip;
    size_t length, hop;         /* of it, and from one to the next, in samples of the record */
    double w, s;
    double corner;              /* of a filter behind it, re w, or infinite */
    int columns;                /* that are used */
    ringer ringers;             /* that are compared: a hum only where it is not sure that something rings and decays */
    double noise;               /* sum of squares of white noise, or of rounding */
    double *basis;              /* for each place of an event and each ringer: COLUMNS orthonormal columns */
    double *x;                  /* room for n samples */
} stretch;

/* What a resonator that rests makes of t^k, which begins at t = 0: a polynomial and what dies out. */
static double
answer(const stretch *of, int k, double t)
{
    double r = of->w * of->w + of->s * of->s, lag = 2 * of->s / r, bend = 2 * lag * lag - 2 / r;
    const double at_0[EVENT] = { 1, -lag, bend }, slope[EVENT] = { 0, 1, -2 * lag };
    const double steady[EVENT] = { 1, t - lag, t * t - 2 * lag * t + bend };
    double sine = -(of->s * at_0[k] + slope[k]) / of->w;
    return steady[k] + exp(-of->s * t) * (-at_0[k] * cos(of->w * t) + sine * sin(of->w * t));
}

static double *
basis_of(const stretch *of, size_t event, ringer who)
{
    return of->basis + (event * RINGERS + who) * of->n * COLUMNS;
}

/* The columns, orthonormal. */
static void
fill_basis(const stretch *of, size_t event, ringer who)
{
    const size_t end = of->n * COLUMNS;
    double at = 0.5 * (double)of->n + 2 * M_PI / of->w * (2 * (double)event / (EVENTS - 1) - 1);
    double *row = basis_of(of, event, who);
    for (size_t i = 0; i < of->n; i++, row += COLUMNS) {
        double t = (double)i - at, u = t / (double)of->n, fall = exp(-of->s * t);
        int rings = who != BY_CONTACT || t < 0;
        row[0] = 1, row[1] = u, row[2] = u * u, row[3] = u * u * u;
        row[4] = rings ? fall * cos(of->w * t) : 0;
        row[5] = rings ? fall * sin(of->w * t) : 0;
        for (int k = 0; k < EVENT; k++)
            row[CUBIC + RINGING + k] = t < 0 ? 0 : who == BY_SENSOR ? answer(of, k, t) : pow(u, k);
        const double turn = of->corner * of->w * M_SQRT1_2 * t;
        for (int k = UNFILTERED; k < of->columns; k++)
            row[k] = t < 0 ? 0 : exp(-turn) * (k % 2 == 0 ? cos(turn) : sin(turn));
    }
    row -= end;
    for (int c = 0; c < of->columns; c++)
        for (int k = 0; k < 2 * c + 1; k++) {   /* off those before twice, as rounding leaves a part of them */
            int by = k < 2 * c ? k % c : c;
            double dot = 0;
            for (size_t i = 0; i < end; i += COLUMNS)
                dot += row[i + (size_t)by] * row[i + (size_t)c];
            double scale = by == c && dot > 0 ? 1 / sqrt(dot) - 1 : -dot;
            for (size_t i = 0; i < end; i += COLUMNS)
                row[i + (size_t)c] += scale * row[i + (size_t)by];
        }
}

/* The sum of squares that columns first ... end - 1 of a basis explain. */
static double
explained(const stretch *of, size_t event, ringer who, int first, int end)
{
    const double *row = basis_of(of, event, who);
    double dot[COLUMNS] = { 0 }, sum = 0;
    for (size_t i = 0; i < of->n; i++, row += COLUMNS)
        for (int c = first; c < end; c++)
            dot[c] += of->x[i] * row[c];
    for (int c = first; c < end; c++)
        sum += dot[c] * dot[c];
    return sum;
}

/* So many stretches, half a period apart, lie in a gap. */
static size_t
places(const stretch *of, ss_window gap)
{
    return (ss_window_length(gap) - of->length) / of->hop + 1;
}

/* Sums over the stretches so far before the next stick. */
typedef struct place {
    double more, left;          /* what the sensor leaves more than the contact; what the contact leaves */
    double noise;               /* of which noise */
    double most;                /* the most that the contact leaves more anywhere before the same stick */
    size_t sticks;
} place;

/* Add the stretches of a gap, the last first.  0: nothing moves there but what rings. */
static int
compare(const stretch *of, const double *x, ss_window gap, place *sum)
{
    size_t n = places(of, gap);
    double most = 0, mean[2] = { INFINITY, -INFINITY }, sample[2] = { INFINITY, -INFINITY };
    for (size_t i = 0; i < n; i++) {
        const double *first = x + gap.end - of->length - i * of->hop;
        double whole = 0, all = 0, left[RINGERS] = { INFINITY, INFINITY, INFINITY };
        for (size_t k = 0; k < of->n; k++) {
            double here = of->x[k] = first[k * of->skip];
            whole += here, all += here * here;
            sample[0] = fmin(sample[0], here), sample[1] = fmax(sample[1], here);
        }
        whole /= (double)of->n;
        mean[0] = fmin(mean[0], whole), mean[1] = fmax(mean[1], whole);
        sum[i].sticks++;
        if (all - whole * whole * (double)of->n < of->noise + FIT_MISFIT * FIT_MISFIT * (double)of->n)
            continue;
        for (ringer who = BY_SENSOR; who < of->ringers; who++) {
            /* columns that are the same at all places, and the others */
            const int same = who == BY_CONTACT ? CUBIC : CUBIC + RINGING;
            double explains = 0;
            for (size_t event = 0; event < EVENTS; event++)
                explains = fmax(explains, explained(of, event, who, same, of->columns));
            left[who] = fmax(all - explained(of, 0, who, 0, same) - explains, 0) + of->noise;
        }
        const double by_others = fmin(left[BY_SENSOR], left[BY_HUM]);
        sum[i].more += by_others - left[BY_CONTACT];
        sum[i].left += left[BY_CONTACT];
        sum[i].noise += of->noise;
        most = fmax(most, left[BY_CONTACT] - by_others);
    }
    for (size_t i = 0; i < n; i++)
        sum[i].most += most;
    return mean[1] - mean[0] > SLIGHT * (sample[1] - sample[0]);
}

/* Up to STICKS gaps behind windows all over the record: what lies between the window of an anchor and the next, if
 * it is long enough. */
static size_t
find_gaps(const search *s, const ringdown *r, size_t length, ss_window gap[STICKS])
{
    size_t windows = 0, seen = 0, n = 0;
    for (size_t i = 0; i < r->n_anchors; i++)
        windows += ss_window_length(r->window[i]) > 0;
    for (size_t i = 0; i < r->n_anchors && n < STICKS; i++) {
        const ss_window win = r->window[i];
        if (ss_window_length(win) == 0 || seen++ % (windows / STICKS + 1) != 0)
            continue;
        gap[n] = (ss_window){ win.end > win.first + length ? win.end - length : win.first, 0 };
        for (size_t k = i + 1; k < r->n_anchors && gap[n].end < gap[n].first + 2 * length; k++)
            gap[n].end = (ss_window_length(r->window[k]) > 0 ? r->window[k].first : r->anchor[k]) + length / 2;
        n += gap[n].end >= gap[n].first + length && gap[n].end <= s->n;
    }
    return n;
}

/* What a sensor leaves more than a contact in n gaps, in parts, where that is most, by the bases of a corner; NaN:
 * nothing moves but what rings.  sum has room for the places of the longest gap, `most`. */
static double
most_in_gaps(const stretch *of, const double *x, const ss_window *gap, size_t n, place *sum, size_t most)
{
    size_t moved = 0;
    double best = 0;
    memset(sum, 0, most * sizeof *sum);
    for (size_t i = 0; i < n; i++)
        moved += (size_t)compare(of, x, gap[i], sum);
    for (const place *at = sum; at < sum + most; at++) {
        double unexplained = isfinite(of->corner) ? at->left
            : fmax(at->left - 2 * at->noise, 0) + fmin(at->noise, HIDDEN * at->most);
        if (at->sticks >= 2 && 2 * at->sticks >= n && at->most > 0
            && at->more > CHANCE * (at->noise + MORE * of->noise) / (double)of->n)
            best = fmax(best, at->more / unexplained);
    }
    return 2 * moved > n ? best : NAN;
}

/* Does what rings in the windows ring on through the slips, or end where they begin?  *more becomes what a sensor
 * leaves more than a contact, in parts, where that is most; it stays NaN where that cannot be told.  Behind a filter,
 * which has one of the corners first ... end - 1, it becomes that, noise included, only if it is TWICE as much. */
static ss_status
compare_all(const search *s, const ringdown *r, int is_sure, size_t first, size_t end, double *more)
{
    double period = 2 * M_PI / r->all[0].value;
    size_t skip = (size_t)ceil(period / RATE), n = (size_t)(2 * AROUND * period / (double)skip) + 1, most = 0;
    stretch of = { .n = n, .skip = skip, .length = n * skip, .hop = (size_t)ceil(period / 2),
                   .w = r->all[0].value * (double)skip, .s = r->all[1].value * (double)skip,
                   .noise = (double)n * (r->white * r->white + ROUNDING), .ringers = is_sure ? BY_HUM : RINGERS };
    ss_window gap[STICKS];
    const size_t used = find_gaps(s, r, of.length, gap);
    if (used < 2)
        return SS_OK;
    for (size_t i = 0; i < used; i++)
        most = places(&of, gap[i]) > most ? places(&of, gap[i]) : most;
    of.basis = malloc((EVENTS * RINGERS * COLUMNS + 1) * n * sizeof *of.basis);
    place *sum = malloc(most * sizeof *sum);
    if (of.basis == NULL || sum == NULL) {
        free(sum);
        free(of.basis);
        return SS_ENOMEM;
    }
    of.x = basis_of(&of, EVENTS, BY_SENSOR);
    for (size_t k = first; k < end && !(*more >= SHOWN); k++) {
        of.corner = corners[k];
        of.columns = isinf(of.corner) ? UNFILTERED : COLUMNS;
        for (size_t event = 0; event < EVENTS; event++)
            for (ringer who = BY_SENSOR; who < of.ringers; who++)
                fill_basis(&of, event, who);
        const double here = most_in_gaps(&of, s->x, gap, used, sum, most);
        if (isinf(of.corner) || here >= TWICE)
            *more = here;
    }
    free(sum);
    free(of.basis);
    return SS_OK;
}

/* How much of what rings in the sticks is one sinusoid, which runs through all of them as a hum does, by the frequency
 * within its errors at which that is most; 1: all of it.  The errors are so small that it turns evenly in a window. */
static double
run_through(const search *s, const ringdown *r)
{
    const double w = r->all[0].value, trials = fmin(SIGMAS * r->all[0].error * (double)s->n, TRIALS);
    double complex z[STICKS];
    double middle[STICKS], squares = 0, best = 0;
    size_t n = 0;
    for (size_t i = 0; i < r->n_anchors; i += r->n_anchors / STICKS + 1) {
        const ss_window win = r->window[i];
        const double step = 2 * M_PI / (double)(ss_window_length(win) + 1);
        double complex sum = 0;
        for (size_t k = win.first; k < win.end; k++)
            sum += s->x[k] * (1 - cos(step * (double)(k + 1 - win.first))) * cexp(-I * w * (double)k);
        middle[n] = (double)(win.first + win.end) / 2;
        squares += creal(sum * conj(sum));
        z[n] = sum;
        n += ss_window_length(win) > 0;
    }
    for (double j = -floor(trials); j <= trials; j++) {
        double complex sum = 0;
        for (size_t i = 0; i < n; i++)
            sum += z[i] * cexp(-I * j / (double)s->n * middle[i]);
        best = fmax(best, creal(sum * conj(sum)));
    }
    return squares > 0 ? best / ((double)n * squares) : 1;
}

/* --- all of it -------------------------------------------------------------------------------- */

/* Behind the reversals of a force each window is fitted by itself: there are no slips between to be compared. */
ss_status
ss_identity_of(search *s, const ringdown *r, const char **why)
{
    int at_edge = 0;
    double more = NAN;
    const int is_told = s->out->reverses || s->part->is_contact;
    const ss_value w = r->all[0], of = r->all[1];
    /* sqrt(k/m) of the rig's own mass and spring */
    const double stiffness = s->opts->mass * pow(s->rate, 2) * (w.value * w.value + of.value * of.value);
    const double by = 2 * s->opts->mass * pow(s->rate, 2) * hypot(w.value * w.error, of.value * of.error);
    const int is_spring = s->opts->mass > 0 && s->opts->stiffness > 0
        && fabs(stiffness - s->opts->stiffness) <= SIGMAS * by;
    const double damping = of.value, error = is_told ? 0 : (s->must_show ? PRECISE : SIGMAS) * of.error;
    /* a damping ratio above one half */
    *why = 3 * pow(damping, 2) > pow(w.value, 2)
        ? "what recurs is damped so much that a filter may make it"
        : !(damping > -error) ? "what recurs does not decay"
        : is_spring ? "it rings as the given mass does on the given spring, while it slips" : NULL;
    s->rings_as = *why != NULL ? OF_NOTHING : OF_SOMETHING;
    if (*why != NULL || is_told)
        return SS_OK;
    const int is_sure = damping > error && !s->must_show;
    ss_status st = compare_all(s, r, is_sure, 0, 1, &more);
    if (st == SS_OK && !(more >= SHOWN))
        st = is_edge(s->x, s->n, w.value / (2 * M_PI), &at_edge);
    /* a sensor that is damped more answers as a filter does */
    if (st == SS_OK && !(more >= SHOWN) && !at_edge && damping < LITTLE * w.value)
        st = compare_all(s, r, is_sure, 1, CORNERS, &more);
    s->rings_as = more >= SHOWN ? OF_CONTACT : at_edge ? OF_FILTER : more < CONTACT ? OF_SENSOR : OF_SOMETHING;
    /* a contact may be undamped, if that is well known; pieces of slips hide how much of a weak hum runs
     * through */
    const int may_ring_on = s->rings_as == OF_CONTACT && !s->must_show && error < FAINT * w.value;
    if (!(damping > error) && !(may_ring_on && run_through(s, r) < SLIGHT)) {
        *why = "what recurs is not shown to decay";
        s->rings_as = s->rings_as == OF_SENSOR ? OF_SENSOR : OF_SOMETHING;
    } else if (s->rings_as == OF_FILTER)
        *why = "it rings where the spectrum ends without a peak, as a filter does";
    else if (s->rings_as == OF_SENSOR || (s->must_show && s->rings_as != OF_CONTACT))
        *why = "it rings on where slips begin, as a sensor, a filter or a hum does";
    return st;
}
