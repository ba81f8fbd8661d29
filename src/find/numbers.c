/* numbers.c -- see numbers.h. */
#include "find/numbers.h"

#include <math.h>

#define ROW(NAME, name, unit, about, needs) [NAME] = { { name, unit }, about, needs },
const feature_number ss_feature_numbers[SS_FEATURE_NUMBERS] = { SS_FEATURE_NUMBER_LIST(ROW) };

const ss_label *
ss_feature_label(ss_feature which)
{
    return (unsigned)which < SS_FEATURE_NUMBERS ? &ss_feature_numbers[which].label : NULL;
}

unsigned
ss_features_have(const ss_features *f, const ss_features_opts *opts)
{
    return (opts->displacement >= 0 ? DISPLACEMENT : 0) | (opts->force >= 0 ? FORCE : 0)
        | (opts->mass > 0 ? MASS : 0) | (f->loading != NULL ? OF_FALLS : f->reverses ? OF_EVENTS : 0);
}

static ss_number
of_value(ss_value v, const char *why)
{
    return (ss_number){ v.value, v.error, NAN, why };
}

static ss_number
of_median(ss_median m)
{
    return (ss_number){ m.value, m.error, m.scatter, NULL };
}

void
ss_numbers_fill(ss_features *f)
{
    ss_number *n = f->number;
    n[SS_TRANSITIONS] = of_value((ss_value){ (double)f->n, NAN }, NULL);
    n[SS_SLIPS] = of_value(f->slips, f->why_slips);
    n[SS_SLIP_RATE] = of_value(f->slip_rate, NULL);
    n[SS_LOADING_SLOPE] = of_median(f->slope);
    n[SS_LOADING_STIFFNESS] = of_median(f->stiffness);
    n[SS_DROP] = of_median(f->drop);
    n[SS_DROP_DURATION] = of_median(f->duration);
    n[SS_RECURRENCE_TIME] = of_median(f->recurrence);
    n[SS_STICK_TIME] = of_median(f->stick);
    n[SS_STATIC_FRICTION] = of_median(f->static_friction);
    n[SS_FRICTION] = of_median(f->friction);
    n[SS_K_OVER_M] = of_median(f->k_over_m);
    n[SS_REPETITION_FREQUENCY] = of_value(f->repetition_frequency, f->why_repetition);
    n[SS_TRANSITION_FREQUENCY_RAW] = of_value(f->frequency_raw, NULL);
    n[SS_TRANSITION_FREQUENCY] = of_value(f->frequency, f->why_ringing);
    n[SS_DAMPING_RATIO] = of_value(f->damping_ratio, NULL);
    n[SS_TOTAL_STIFFNESS_RAW] = of_value(f->total_stiffness_raw, NULL);
    n[SS_TOTAL_STIFFNESS] = of_value(f->total_stiffness, NULL);
    n[SS_CONTACT_STIFFNESS] = of_value(f->contact_stiffness, NULL);
    n[SS_CONTACT_DAMPING] = of_value(f->contact_damping, NULL);
    n[SS_CONTACT_STIFFNESS_SLOPE] = of_value(f->contact_slope, NULL);
}
