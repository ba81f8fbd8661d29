/* numbers.c -- see numbers.h. */
#include "find/numbers.h"

/* Those that are found together with the transitions. */
static ss_status
by_search(search *s)
{
    (void)s;
    return SS_OK;
}

#define DECLARATION(NAME, name, unit, about, needs, by) ss_status by(search *s);
SS_FEATURE_NUMBER_LIST(DECLARATION)

#define ROW(NAME, name, unit, about, needs, by) [NAME] = { { name, unit }, about, needs, by },
const feature_number ss_feature_numbers[SS_FEATURE_NUMBERS] = { SS_FEATURE_NUMBER_LIST(ROW) };

unsigned
ss_features_have(const ss_features *f, const ss_features_opts *opts)
{
    return (opts->displacement >= 0 ? WITH_X : 0) | (opts->force >= 0 ? WITH_F : 0)
        | (opts->mass > 0 ? WITH_MASS : 0) | (f->loading != NULL ? OF_FALLS : f->reverses ? OF_EVENTS : 0);
}

ss_status
ss_numbers_find(search *s)
{
    ss_status st = SS_OK;
    for (int k = 0; st == SS_OK && k < SS_FEATURE_NUMBERS; k++)
        st = ss_feature_numbers[k].by(s);
    return st;
}
