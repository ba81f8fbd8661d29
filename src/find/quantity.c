/* quantity.c -- the physical quantity of a column, by its unit or its name.
 *
 * A slip is a fall in a force and not in a displacement, and the shape of a signal does not
 * separate them for certain.  So the quantity follows from the words that people write above columns;
 * without such words it is unknown. */
#include "find/quantity.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include "signal/header.h"

static const char *const displacement_words[] = { "displacement", "position", "stroke", "disp", "pos", "x", NULL };
static const char *const motion_words[] = { "velocity", "acceleration", "slip", "speed", "vel", "acc", "v", "a", NULL };
static const char *const force_words[] = { "force", "torque", "friction", "load", "traction", "f", "fx", "fy",
                                           "fz", "fn", "ft", NULL };

/* Does one of the words stand in the name, apart from other letters? */
static int
has_word(const char *name, const char *const *list)
{
    while (*name != '\0') {
        size_t length = 0;
        while (isalpha((unsigned char)name[length]))
            length++;
        for (size_t k = 0; length > 0 && list[k] != NULL; k++)
            if (strlen(list[k]) == length && strncasecmp(list[k], name, length) == 0)
                return 1;
        name += length > 0 ? length : 1;
    }
    return 0;
}

column_quantity
ss_column_quantity(const ss_column *column)
{
    if (ss_unit_in_si(column->unit, 'N') > 0)
        return QUANTITY_FORCE;
    /* a unit of length, by whatever time: m, mm/s, (m/s^2), in */
    const char *unit = column->unit + (column->unit[0] == '(');
    char length[16];
    snprintf(length, sizeof length, "%.*s", (int)strcspn(unit, "/)"), unit);
    if (ss_unit_in_si(length, 'm') > 0)
        return strchr(unit, '/') != NULL ? QUANTITY_MOTION : QUANTITY_DISPLACEMENT;
    return has_word(column->name, force_words) ? QUANTITY_FORCE
        : has_word(column->name, displacement_words) ? QUANTITY_DISPLACEMENT
        : has_word(column->name, motion_words) ? QUANTITY_MOTION : QUANTITY_UNKNOWN;
}
