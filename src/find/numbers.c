/* numbers.c -- see numbers.h. */
#include "find/numbers.h"

#define AT(member) offsetof(ss_features, member.value)

const feature_number ss_feature_numbers[SS_SUMMARY_NUMBERS] = {
    { "transitions", "", 0, 0, ALL },           /* a count: ss_features.n */
    { "slips", "", AT(slips), 0, ALL },
    { "slip_rate", "1/s", AT(slip_rate), 0, ALL },
    { "loading_slope", NULL, AT(slope), 1, WITH_LOADING },
    { "loading_stiffness", NULL, AT(stiffness), 1, WITH_FRICTION_OVER_X },
    { "drop", NULL, AT(drop), 1, WITH_LOADING },
    { "drop_duration", "s", AT(duration), 1, WITH_LOADING },
    { "recurrence_time", "s", AT(recurrence), 1, WITH_LOADING },
    { "stick_time", "s", AT(stick), 1, WITH_LOADING },
    { "static_friction", NULL, AT(static_friction), 1, WITH_LOADING },
    { "friction", NULL, AT(friction), 1, WITH_FRICTION },
    { "k_over_m", "1/s^2", AT(k_over_m), 1, WITH_LOADING },
    { "repetition_frequency", "Hz", AT(repetition_frequency), 0, ALL },
    { "transition_frequency_raw", "Hz", AT(frequency_raw), 0, ALL },
    { "transition_frequency", "Hz", AT(frequency), 0, ALL },
    { "damping_ratio", "", AT(damping_ratio), 0, ALL },
    { "total_stiffness_raw", "N/m", AT(total_stiffness_raw), 0, WITH_MASS },
    { "total_stiffness", "N/m", AT(total_stiffness), 0, WITH_MASS },
    { "contact_stiffness", "N/m", AT(contact_stiffness), 0, WITH_MASS },
    { "contact_damping", "N s/m", AT(contact_damping), 0, WITH_MASS },
    { "contact_stiffness_slope", "N/m", AT(contact_slope), 0, WITH_X_AND_F },
};
