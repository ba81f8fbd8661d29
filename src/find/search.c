/* search.c -- allocate transitions whose numbers are not known yet. */
#include "find/search.h"

#include <stdlib.h>

ss_status
ss_transitions_new(ss_features *out, size_t n)
{
    free(out->transition);
    out->n = 0;
    out->transition = calloc(n + 1, sizeof *out->transition);
    if (out->transition == NULL)
        return SS_ENOMEM;
    out->n = n;
    for (size_t i = 0; i < n; i++)
        out->transition[i] = (ss_transition){ .maximum = no_maximum, .frequency = unknown,
                                              .damping_ratio = unknown, .from = NAN, .to = NAN };
    return SS_OK;
}
