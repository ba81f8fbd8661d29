/* unit.c -- units in SI, the unit at the end of a column's name, that of a spectral density, and the quantity of a
 * column. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include "signal/header.h"

/* Does a part of the name begin with one of the words? */
static int
has_word(const char *name, const char *const *word)
{
    for (; *word != NULL; word++)
        for (const char *p = name; *p != '\0'; p += strcspn(p, "_ "), p += *p != '\0')
            if (strncasecmp(p, *word, strlen(*word)) == 0)
                return 1;
    return 0;
}

const char *
ss_unit_of_name(const char *name, size_t *before)
{
    static const char *const lengths[] = { "disp", "pos", "slip", "stroke", "travel", "deflection", "extension",
        "vel", "speed", "acc", NULL };
    static const char *const accelerations[] = { "acc", NULL };
    static const struct { const char *end, *unit; const char *const *word; } known[] = {
        { "_m_s2", "m/s^2", NULL }, { "_mm_s2", "mm/s^2", NULL }, { "_in_s2", "in/s^2", NULL },
        { "_m_s", "m/s", NULL }, { "_mm_s", "mm/s", NULL }, { "_um_s", "um/s", NULL }, { "_in_s", "in/s", lengths },
        { "_ft_s", "ft/s", NULL }, { "_rad_s", "rad/s", NULL }, { "_deg_s", "deg/s", NULL },
        { "_mm", "mm", NULL }, { "_um", "um", NULL }, { "_nm", "nm", lengths }, { "_cm", "cm", NULL },
        { "_in", "in", lengths }, { "_ft", "ft", lengths }, { "_g", "g", accelerations },
        { "_kN", "kN", NULL }, { "_mN", "mN", NULL }, { "_lbf", "lbf", NULL }, { "_kip", "kip", NULL },
        { "_kPa", "kPa", NULL }, { "_MPa", "MPa", NULL }, { "_psi", "psi", NULL }, { "_mV", "mV", NULL },
        { "_Hz", "Hz", NULL }, { "_kHz", "kHz", NULL }, { "_rad", "rad", NULL }, { "_deg", "deg", NULL },
        { "_rpm", "rpm", NULL }, { NULL, NULL, NULL } };
    size_t n = strlen(name);
    for (int i = 0; known[i].end != NULL; i++) {
        size_t length = strlen(known[i].end);
        if (n > length && strcmp(name + n - length, known[i].end) == 0
            && (known[i].word == NULL || has_word(name, known[i].word))) {
            if (before != NULL)
                *before = n - length;
            return known[i].unit;
        }
    }
    return "";
}

double
ss_unit_size(const char *unit, char *dimension, int *per_time)
{
    static const struct { const char *name; char dimension; double size; } known[] = {
        { "N", 'N', 1 }, { "kN", 'N', 1e3 }, { "MN", 'N', 1e6 }, { "mN", 'N', 1e-3 }, { "uN", 'N', 1e-6 },
        { "lbf", 'N', 4.4482216152605 }, { "kip", 'N', 4448.2216152605 }, { "kips", 'N', 4448.2216152605 },
        { "kgf", 'N', 9.80665 }, { "gf", 'N', 9.80665e-3 }, { "dyn", 'N', 1e-5 }, { "dyne", 'N', 1e-5 },
        { "m", 'm', 1 }, { "cm", 'm', 1e-2 }, { "mm", 'm', 1e-3 }, { "um", 'm', 1e-6 }, { "\xc2\xb5m", 'm', 1e-6 },
        { "\xce\xbcm", 'm', 1e-6 }, { "micron", 'm', 1e-6 }, { "microns", 'm', 1e-6 }, { "nm", 'm', 1e-9 },
        { "in", 'm', 0.0254 }, { "ft", 'm', 0.3048 }, { "km", 'm', 1e3 },
        { "rad", 'r', 1 }, { "deg", 'r', 0.017453292519943295 } };
    static const struct { const char *text; int per_time; } over[] = {
        { "", 0 }, { "/s", 1 }, { "/s^2", 2 }, { "/s2", 2 }, { "/s\xc2\xb2", 2 }, { "/s/s", 2 } };
    const size_t n = unit != NULL ? strcspn(unit, "/") : 0;
    for (size_t i = 0; n > 0 && i < sizeof known / sizeof *known; i++)
        for (size_t k = 0; k < sizeof over / sizeof *over; k++)
            if (strlen(known[i].name) == n && strncmp(known[i].name, unit, n) == 0
                && strcmp(unit + n, over[k].text) == 0) {
                *dimension = known[i].dimension;
                *per_time = over[k].per_time;
                return known[i].size;
            }
    return 0;
}

double
ss_unit_in_si(const char *unit, char dimension)
{
    char of;
    int per_time;
    const double size = ss_unit_size(unit, &of, &per_time);
    return size > 0 && of == dimension && per_time == 0 ? size : 0;
}

void
ss_density_unit(char text[DENSITY_UNIT], const char *unit, int decibels)
{
    int brackets = strpbrk(unit, "/ *^") != NULL;
    snprintf(text, DENSITY_UNIT, "%s%s%.200s%s%s/Hz", decibels ? "dB re " : "", brackets ? "(" : "",
             unit[0] != '\0' ? unit : "1", brackets ? ")" : "", unit[0] != '\0' ? "^2" : "");
}

/* --- the quantity of a column -------------------------------------------------------------------- */

/* A slip is a fall in a force and not in a displacement, and the shape of a signal does not
 * separate them for certain.  So the quantity follows from the words that people write above columns;
 * without such words it is unknown. */
static const char *const displacement_words[] = { "displacement", "position", "stroke", "disp", "pos", "x", NULL };
static const char *const motion_words[] = { "velocity", "acceleration", "slip", "speed", "vel", "acc", "v", "a", NULL };
static const char *const force_words[] = { "force", "torque", "friction", "load", "traction", "f", "fx", "fy",
                                           "fz", "fn", "ft", NULL };

/* Does one of the words stand in the name, apart from other letters? */
static int
has_whole_word(const char *name, const char *const *list)
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
    return has_whole_word(column->name, force_words) ? QUANTITY_FORCE
        : has_whole_word(column->name, displacement_words) ? QUANTITY_DISPLACEMENT
        : has_whole_word(column->name, motion_words) ? QUANTITY_MOTION : QUANTITY_UNKNOWN;
}
