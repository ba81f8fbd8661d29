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
 * with a cubic p and an event at 0, which is sought.  The end of a slip is a sensor's by this, whatever rings.
 * Some other stretch must be the contact's.
 *
 * A filter's corner has no peak, and the spectrum ends there.  The rig's own spring rings with sqrt(k/m) while it
 * slips.
 */
#include "find/identity.h"

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <stickslip/spectrum.h>

#define BARELY 0.577            /* s / w at a damping ratio of one half */
#define AROUND 2.0              /* periods on either side of the middle of a stretch */
#define CONTACT 1.03            /* what the sensor leaves over what the contact leaves: less is the sensor */
#define SENSOR 2.5              /* what the contact leaves over what the sensor leaves where a slip ends */
#define ROUNDING 1e-15          /* variance of a sample: less is none */
#define FLAT 1.3                /* power re the power law: with more there is a peak */
#define STEEP 3.2               /* power law re the power beyond: with more there is a corner */
#define STEP 1.67               /* from band to band, each from 1 / WIDE to WIDE of its middle */
#define WIDE 1.18
#define FINE (1 / 32.)          /* resolution re the oscillation; coarser in records of under four segments */
enum { RATE = 24 };             /* most samples of a period that are used */
enum { STICKS = 8, TRIED = 3 }; /* sticks that are looked behind; places in each where a slip may begin */

/* --- the rig's spring ------------------------------------------------------------------------ */

/* Is the frequency that of the rig's own mass and spring, sqrt(k/m), within errors? */
static int
is_spring(const search *s, const ss_value all[2])
{
    double m = s->opts->mass, k = s->opts->stiffness, r = hypot(all[0].value, all[1].value);
    double error = hypot(all[0].value * all[0].error, all[1].value * all[1].error) / r;
    double w = r * s->rate, total = m * w * w;
    return m > 0 && k > 0 && fabs(total - k) <= SIGMAS * 2 * total * error / r;
}

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

typedef enum ringer { BY_SENSOR, BY_CONTACT, RINGERS } ringer;
enum { EVENT = 3, COLUMNS = 4 + 2 + EVENT };    /* a cubic, the ringing, and what the event makes */

/* n samples, each `skip` behind the one before; w and s by such a step. */
typedef struct stretch {
    const double *x;
    size_t n, skip;
    double w, s;
    double noise;               /* sum of squares of white noise, or of rounding */
    int decays;                 /* 0: what rings may be a steady line, which answers nothing */
    double *room;               /* for a fit */
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

/* The sum of squares that is left of the samples from `first` on, with an event so many steps behind. */
static double
left_by(const stretch *of, size_t first, double event, ringer who)
{
    double *x = of->room, *tau = x + of->n, *column = tau + COLUMNS;
    gsl_matrix_view columns = gsl_matrix_view_array(column, of->n, COLUMNS);
    gsl_vector_view samples = gsl_vector_view_array(x, of->n), scales = gsl_vector_view_array(tau, COLUMNS);
    for (size_t i = 0; i < of->n; i++) {
        double t = (double)i - event, u = t / (double)of->n, fall = exp(-of->s * t);
        double *row = column + i * COLUMNS;
        int rings = who == BY_SENSOR || t < 0;
        x[i] = of->x[first + i * of->skip];
        row[0] = 1, row[1] = u, row[2] = u * u, row[3] = u * u * u;
        row[4] = rings ? fall * cos(of->w * t) : 0;
        row[5] = rings ? fall * sin(of->w * t) : 0;
        for (int k = 0; k < EVENT; k++)
            row[6 + k] = t < 0 ? 0 : who == BY_SENSOR && of->decays ? answer(of, k, t) : pow(t, k);
    }
    gsl_linalg_QR_decomp(&columns.matrix, &scales.vector);
    gsl_linalg_QR_QTvec(&columns.matrix, &scales.vector, &samples.vector);
    return gsl_stats_tss_m(x + COLUMNS, 1, of->n - COLUMNS, 0) + of->noise;
}

/* The least that is left by either, with the event within a period of the middle. */
static void
seek_event(const stretch *of, size_t first, double left[RINGERS])
{
    double middle = 0.5 * (double)of->n, period = 2 * M_PI / of->w;
    for (ringer who = BY_SENSOR; who < RINGERS; who++) {
        double at = middle, reach = period;
        left[who] = INFINITY;
        for (double step = period / 8; step > period / 64; step /= 4, reach /= 8)
            for (double from = at - reach, event = from; event <= from + 2 * reach; event += step) {
                double here = left_by(of, first, event, who);
                if (here < left[who])
                    left[who] = here, at = event;
            }
    }
}

/* Among the stretches from sample `from` to `end`, a quarter of a period apart: how much more the sensor leaves
 * than the contact where that is most, and how much less. */
static ss_status
compare(const stretch *of, size_t from, size_t end, double *contact, double *sensor)
{
    size_t hop = (size_t)ceil(M_PI / 2 / of->w * (double)of->skip), m = (end - from - of->n * of->skip) / hop + 1;
    double *ratio = malloc(m * sizeof *ratio), left[RINGERS], middle = 0.5 * (double)of->n;
    if (ratio == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < m; i++)
        ratio[i] = left_by(of, from + i * hop, middle, BY_SENSOR)
            / left_by(of, from + i * hop, middle, BY_CONTACT);
    *contact = *sensor = 0;
    for (int k = 0; k <= TRIED; k++) {
        size_t at = k < TRIED ? gsl_stats_max_index(ratio, 1, m) : gsl_stats_min_index(ratio, 1, m);
        seek_event(of, from + at * hop, left);
        *contact = fmax(*contact, left[BY_SENSOR] / left[BY_CONTACT]);
        *sensor = fmax(*sensor, left[BY_CONTACT] / left[BY_SENSOR]);
        for (size_t i = at > 4 ? at - 4 : 0; i < m && i <= at + 4; i++)
            ratio[i] = 1;       /* within a period it is the same event */
    }
    free(ratio);
    return SS_OK;
}

/* Does what rings in the windows ring on through the slips, or anew where they begin?  What is not shown to decay
 * must be the contact's beyond doubt. */
static ss_status
is_sensor(const search *s, const ringdown *r, int *is)
{
    const int decays = r->all[1].value > SIGMAS * r->all[1].error;
    double period = 2 * M_PI / r->all[0].value, contact[STICKS], sensor[STICKS];
    size_t skip = (size_t)ceil(period / RATE), n = (size_t)(2 * AROUND * period / (double)skip) + 1;
    size_t every = r->n_anchors / STICKS + 1, used = 0, seen = 0, length = n * skip;
    stretch of = { s->x, n, skip, r->all[0].value * (double)skip, r->all[1].value * (double)skip,
                   (double)n * (r->white * r->white + ROUNDING), decays,
                   malloc((n + COLUMNS * (n + 1)) * sizeof *of.room) };
    ss_status st = of.room != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < r->n_anchors && used < STICKS; i++) {
        ss_window win = r->window[i];
        if (ss_window_length(win) == 0 || seen++ % every != 0)
            continue;
        size_t from = win.end > win.first + length ? win.end - length : win.first, end = 0;
        for (size_t k = i + 1; k < r->n_anchors && end < from + 2 * length; k++)
            end = (ss_window_length(r->window[k]) > 0 ? r->window[k].first : r->anchor[k]) + length / 2;
        if (end < from + length || end > s->n)
            continue;
        st = compare(&of, from, end, &contact[used], &sensor[used]);
        used++;
    }
    *is = st == SS_OK && used > 1
        && gsl_stats_median(contact, 1, used) < (decays ? CONTACT : SENSOR)
        && (!decays || gsl_stats_median(sensor, 1, used) > SENSOR * gsl_stats_median(contact, 1, used));
    free(of.room);
    return st;
}

/* --- all of it -------------------------------------------------------------------------------- */

/* Behind the reversals of a force each window is fitted by itself: there are no slips between to be compared. */
ss_status
ss_identity_of(const search *s, const ringdown *r, const char **why)
{
    int of_sensor = 0, at_edge = 0;
    *why = r->all[1].value > BARELY * r->all[0].value ? "what recurs is damped so much that a filter may make it"
        : !(r->all[1].value > 0) ? "what recurs does not decay"
        : is_spring(s, r->all) ? "it rings as the given mass does on the given spring, while it slips" : NULL;
    const int is_known = *why != NULL || s->out->reverses || s->part->is_contact;
    ss_status st = is_known ? SS_OK : is_sensor(s, r, &of_sensor);
    if (of_sensor)
        *why = "it rings on where slips begin, as a sensor, a filter or a hum does";
    if (st == SS_OK && *why == NULL && !is_known)
        st = is_edge(s->x, s->n, r->all[0].value / (2 * M_PI), &at_edge);
    if (at_edge)
        *why = "it rings where the spectrum ends without a peak, as a filter does";
    return st;
}
