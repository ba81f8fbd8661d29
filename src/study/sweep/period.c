/* period.c -- measure cycles that begin at the present state of the finder. */
#include "study/sweep/finder.h"

#include <math.h>

/* The exponent of a multiplier; NaN if rounding, or the error that the tolerance allows, may have made it. */
static double
exponent_of(const finder *f, double multiplier, double time)
{
    return multiplier > (f->in_closed_form ? 1e-10 : 1e-6) ? log(multiplier) / time : NAN;
}

static ss_status
find_multipliers(finder *f, const motion *start, int period, ss_steady *out)
{
    tangent t;
    ss_status st = ss_finder_begin_at(f, start);
    if (st == SS_OK)
        st = ss_finder_derive(f, period, MULTIPLIERS, &t);
    if (st == SS_OK)
        st = ss_tangent_multipliers(&t, &out->value[SS_FLOQUET], &out->value[SS_FLOQUET_2],
                                    &out->value[SS_FLOQUET_ANGLE]);
    out->value[SS_LYAPUNOV] = exponent_of(f, out->value[SS_FLOQUET], period * out->value[SS_CYCLE_TIME]);
    out->value[SS_LYAPUNOV_ERROR] = 0;
    return st;
}

static ss_status
find_exponent(finder *f, const motion *start, ss_steady *out)
{
    const ss_steady_opts *o = f->opts;
    ss_status st = ss_finder_begin_at(f, start);
    return st != SS_OK ? st : ss_finder_exponent(f, o->settle > 0 ? o->settle : o->max_cycles,
                                                 &out->value[SS_LYAPUNOV], &out->value[SS_LYAPUNOV_ERROR]);
}

static ss_status
record_strobes(finder *f, const motion *start, int cycles, ss_steady *out)
{
    ss_status st = ss_finder_begin_at(f, start);
    for (int i = 0; st == SS_OK && i < cycles; i++) {
        section at = ss_section_of(&f->w.m.now);
        out->strobe[out->n_strobes++] = (ss_strobe){ at.x, at.v + f->scene->surface_velocity };
        st = ss_finder_go(f, 1, NULL, NULL);
    }
    return st;
}

ss_status
ss_finder_measure(finder *f, int cycles, int period, ss_steady *out)
{
    meter r;
    const motion start = f->w.m;
    section at = ss_section_of(&start.now);
    ss_meter_begin(&r, f->opts->measures, &start.now);
    ss_status st = SS_OK;
    if (f->opts->measures & MODEL_ERRORS) {
        st = ss_course_begin(&f->course, cycles, 1 / f->scene->base_frequency);
        r.course = &f->course;
    }
    if (st == SS_OK)
        st = ss_finder_go(f, cycles, &r, NULL);
    if (st != SS_OK)
        return st;
    f->missed = ss_section_distance(f, ss_section_of(&f->w.m.now), at);
    f->unresolved = ss_motion_unresolved(&f->w.m) - ss_motion_unresolved(&start);
    ss_meter_end(&r, cycles, period > 0, out->value);
    out->value[SS_PERIOD] = period;
    out->value[SS_X_PHASE] = at.x;
    out->value[SS_V_PHASE] = at.v + f->scene->surface_velocity;
    if (period > 0 && (f->opts->measures & (FLOQUET | LYAPUNOV)))
        st = find_multipliers(f, &start, period, out);
    else if (f->opts->measures & LYAPUNOV)
        st = find_exponent(f, &start, out);
    out->n_strobes = 0;
    if (st == SS_OK && f->opts->strobe > 0)
        st = record_strobes(f, &start, period > 0 ? period : f->opts->strobe, out);
    return st;
}
