/* identity.c -- whether what rings is the contact.
 *
 * A damped oscillation in windows of a record may be of many things, and a fit is as exact whatever it is.  So
 * before a number is printed, it is compared with all that is known to look alike; each test has a row in the
 * manual's table of conditions.
 *
 * A steady line, a hum, does not decay, and runs through the windows with one phase.  What rings because of slips
 * starts anew with the phase of each, or the opposite one where the slip is the other way.
 *
 * A low-pass filter with steep sides rings behind each jump near its corner, at one frequency and with one
 * damping, as a contact does.  But a contact amplifies what it rings with, so that its spectrum has a
 * peak above the power law that the slips make at lower frequencies.  That of a filter follows this law
 * up to its corner, and falls below it behind. *
 * The rig's own spring rings with sqrt(k/m) while it slips.
 */
#include "find/identity.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <stickslip/spectrum.h>
#include "find/varpro.h"

#define BARELY 0.577            /* s / w at a damping ratio of one half */
#define CHANCE 1e-3             /* probability that starts at random agree as a line does */
#define FLAT 1.3                /* power re the power law: with more there is a peak */
#define STEEP 3.2               /* power law re the power beyond: with more there is a corner */
#define STEP 1.67               /* from band to band, each from 1 / WIDE to WIDE of its middle */
#define WIDE 1.18
#define FINE (1 / 32.)          /* resolution re the oscillation; coarser in records of under four segments */

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

/* --- a hum ------------------------------------------------------------------------------------ */

typedef struct ring {           /* in a window */
    ss_window at;
    double complex amplitude;   /* at its start: it is Re amplitude exp(i w t - s t) */
} ring;

/* The mean of the directions of the amplitudes at sample 0, if they run on from there to the n windows with w and
 * do not decay: 1 of a line with w. */
static double
agreement_as_line(const ring *in, size_t n, double w)
{
    double complex sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += in[i].amplitude / cabs(in[i].amplitude) * cexp(-I * fmod(w * (double)in[i].at.first, 2 * M_PI));
    return cabs(sum) / (double)n;
}

/* May one steady line run through the n windows?  It may where they agree on it as well as on their starts, or
 * better than starts at random would by chance: a line at a harmonic of the cycles agrees with both.  Its
 * frequency is sought within SIGMAS errors of the windows' own, in steps by which its phase turns by half a radian
 * from end to end. */
static int
is_line(const ring *in, size_t n, ss_value w)
{
    double complex anew = 0;
    double as_line = 0, reach = SIGMAS * w.error;
    double step = 0.5 / (double)(in[n - 1].at.first - in[0].at.first + 1);
    for (size_t i = 0; i < n; i++)
        anew += cpow(in[i].amplitude / cabs(in[i].amplitude), 2);
    for (double off = -reach; off <= reach + step; off += step)
        as_line = fmax(as_line, agreement_as_line(in, n, w.value + off));
    return as_line > fmin(sqrt(log((2 * reach / step + 1) / CHANCE) / (double)n), cabs(anew) / (double)n);
}

/* --- all of it -------------------------------------------------------------------------------- */

/* The ringing in each of the n windows that are not empty. */
static ss_status
find_rings(const search *s, const ringdown *r, ring *in, size_t *n)
{
    varpro fit;
    size_t longest = 0;
    for (size_t i = 0; i < r->n_anchors; i++)
        longest = longest > ss_window_length(r->window[i]) ? longest : ss_window_length(r->window[i]);
    ss_status st = ss_varpro_init(&fit, s->x, longest + 1);
    ss_varpro_start(&fit, r->all[0].value, r->all[1].value, r->slow);
    *n = 0;
    for (size_t i = 0; i < r->n_anchors && st == SS_OK; i++)
        if (ss_window_length(r->window[i]) > 0) {
            linear here = ss_varpro_project(&fit, r->window[i]);
            in[(*n)++] = (ring){ r->window[i], here.a - I * here.b };
        }
    ss_varpro_free(&fit);
    return st;
}

/* Behind the reversals of a force each window is fitted by itself, so that there are neither phases nor a spectrum
 * of its sticks to be compared. */
ss_status
ss_identity_of(const search *s, const ringdown *r, const char **why)
{
    ring *in = malloc((r->n_anchors + 1) * sizeof *in);
    int shared = !s->out->reverses, at_edge = 0;
    size_t n = 0;
    ss_status st = in != NULL ? find_rings(s, r, in, &n) : SS_ENOMEM;
    if (st == SS_OK && shared)
        st = is_edge(s->x, s->n, r->all[0].value / (2 * M_PI), &at_edge);
    if (st == SS_OK)
        *why = r->all[1].value > BARELY * r->all[0].value ? "what recurs is damped so much that a filter may make it"
            : !(r->all[1].value > 0) ? "what recurs does not decay"
            : shared && !(r->all[1].value > SIGMAS * r->all[1].error) && is_line(in, n, r->all[0])
            ? "what recurs is not shown to decay, and its phase is that of a steady line: it hums"
            : is_spring(s, r->all) ? "it rings as the given mass does on the given spring, while it slips"
            : at_edge ? "it rings where the spectrum ends without a peak, as a filter does" : NULL;
    free(in);
    return st;
}
