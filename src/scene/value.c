/* value.c -- what the value of a key may be. */
#include "scene/value.h"

#include <math.h>
#include "base/utf8.h"
#include "signal/header.h"

int
ss_value_in_range(const scene_key *k, double x)
{
    if (k->range == RATE)
        return x >= RATE_MIN && x <= RATE_MAX;
    return isfinite(x) && (k->range == ANY_NUMBER || x > 0 || (k->range == NOT_NEGATIVE && x == 0));
}

int
ss_value_is_word(const scene_key *k, int word)
{
    int i = 0;
    while (k->word(i) != NULL && i != word)
        i++;
    return k->word(i) != NULL;
}

const char *
ss_value_range(const scene_key *k)
{
    static const char *const text[] = {
        [ANY_NUMBER] = "finite", [NOT_NEGATIVE] = ">= 0", [POSITIVE] = "> 0", [RATE] = ("in " RATE_RANGE),
    };
    return text[k->range];
}

const char *
ss_value_no_text(const char *text)
{
    int is_control = 0;
    while (*text != '\0' && *text != '#' && !is_control)
        text += ss_utf8_next(text, &is_control);
    return *text != '\0' || is_control ? "has a control character or a '#'" : NULL;
}
