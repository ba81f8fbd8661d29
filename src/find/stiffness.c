/* stiffness.c -- the numbers that follow from an oscillation and a mass, and from force over displacement.
 *
 * With r = hypot(omega, s), the total stiffness is K = m r^2 and the damping c = 2 m s.  Errors follow from those
 * of frequency and damping ratio as if these were independent. */
#include <stdlib.h>
#include "find/numbers.h"
#include "find/search.h"

ss_status
ss_find_stiffness_raw(search *s)
{
    const ss_value f = known(s->out, SS_TRANSITION_FREQUENCY_RAW);
    double r = 2 * M_PI * f.value, total = s->opts->mass * r * r;
    if (s->opts->mass > 0)
        know(s->out, SS_TOTAL_STIFFNESS_RAW, (ss_value){ total, 2 * total * f.error / f.value });
    return SS_OK;
}

/* r from the damped frequency. */
static double
undamped(const search *s)
{
    double z = s->out->number[SS_DAMPING_RATIO].value;
    return 2 * M_PI * s->out->number[SS_TRANSITION_FREQUENCY].value / sqrt(1 - z * z);
}

ss_status
ss_find_stiffness(search *s)
{
    const ss_value f = known(s->out, SS_TRANSITION_FREQUENCY), z = known(s->out, SS_DAMPING_RATIO);
    double r = undamped(s), total = s->opts->mass * r * r;
    if (s->opts->mass > 0)
        know(s->out, SS_TOTAL_STIFFNESS, (ss_value){
             total, total * hypot(2 * f.error / f.value, 2 * z.value * z.error / (1 - z.value * z.value)) });
    return SS_OK;
}

ss_status
ss_find_contact_stiffness(search *s)
{
    const ss_value total = known(s->out, SS_TOTAL_STIFFNESS);
    double k = s->opts->stiffness;
    if (k > 0 && total.value > k)
        know(s->out, SS_CONTACT_STIFFNESS, (ss_value){ total.value - k, total.error });
    return SS_OK;
}

ss_status
ss_find_contact_damping(search *s)
{
    const ss_value f = known(s->out, SS_TRANSITION_FREQUENCY), z = known(s->out, SS_DAMPING_RATIO);
    double m = s->opts->mass, r = undamped(s);
    if (m > 0)
        know(s->out, SS_CONTACT_DAMPING, (ss_value){
             2 * m * r * z.value,
             2 * m * r * hypot(z.value * f.error / f.value, z.error / (1 - z.value * z.value)) });
    return SS_OK;
}

/* Find the slope over the spans in which oscillations are fitted. */
ss_status
ss_find_contact_slope(search *s)
{
    ss_features *out = s->out;
    const double *values = s->signal->values;
    size_t x = (size_t)s->opts->displacement, f = (size_t)s->opts->force, n = 0;
    ss_value slope = unknown;
    if (s->opts->displacement < 0 || s->opts->force < 0 || isnan(out->number[SS_TRANSITION_FREQUENCY].value))
        return SS_OK;
    if (out->reverses && isfinite(out->number[SS_FRICTION].value))
        return SS_OK;                   /* its loading gives the stiffness */
    ss_window *span = malloc((out->n + 1) * sizeof *span);
    if (span == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < out->n; i++)
        if (!isnan(out->transition[i].from))
            span[n++] = (ss_window){ (size_t)(out->transition[i].from * s->rate + 0.5),
                                   (size_t)(out->transition[i].to * s->rate + 0.5) };
    ss_status st = ss_slope_find(values + f * s->n, values + x * s->n, s->x, span, n, &slope);
    free(span);
    know(out, SS_CONTACT_STIFFNESS_SLOPE, slope);
    return st;
}
