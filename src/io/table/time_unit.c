/* time_unit.c -- the units of numbers that are times, and the names of columns that hold times. */
#include <stickslip/signal.h>

#include <math.h>
#include <string.h>
#include <strings.h>
#include "io/table/time_unit.h"

static const struct time_unit units_of_time[] = {
    { "s", "sec secs second seconds", 1, 1, 0 },
    { "ms", "msec millisecond milliseconds", 1, 1e3, 1 },
    { "us", "usec microsecond microseconds \u00b5s \u03bcs", 1, 1e6, 1 },
    { "ns", "nsec nanosecond nanoseconds", 1, 1e9, 1 },
    { "min", "minute minutes", 60, 1, 0 },
    { "h", "hr hour hours", 3600, 1, 0 },
    { "d", "day days datenum mjd", SECONDS_A_DAY, 1, 0 }
};
enum { UNITS_OF_TIME = sizeof units_of_time / sizeof *units_of_time };

const char *
ss_time_unit_name(size_t i)
{
    return i < UNITS_OF_TIME ? units_of_time[i].name : NULL;
}

/* Is this word of n bytes in the list, in upper or lower case? */
static int
is_in_list(const char *list, const char *word, size_t n)
{
    for (; n > 0 && *list != '\0'; list += strcspn(list, " "), list += *list == ' ')
        if (strcspn(list, " ") == n && strncasecmp(list, word, n) == 0)
            return 1;
    return 0;
}

const struct time_unit *
ss_time_unit_find(const char *name)
{
    for (const struct time_unit *unit = units_of_time; unit < units_of_time + UNITS_OF_TIME; unit++)
        if (strcasecmp(unit->name, name) == 0 || is_in_list(unit->others, name, strlen(name)))
            return unit;
    return NULL;
}

const struct time_unit *
ss_time_unit_in(const char *name, size_t *length)
{
    size_t n = strlen(name);
    while (n > 0 && strchr("_.-", name[n - 1]) == NULL)
        n--;
    const struct time_unit *unit = ss_time_unit_find(name + n);
    *length = unit == NULL ? strlen(name) : n > 0 ? n - 1 : 0;
    return unit;
}

int
ss_is_called_time(const char *name)
{
    static const char words[] = "t time timestamp time_stamp datetime date_time epoch unix_time zeit temps "
        "tempo tiempo elapsed elapsed_time x_value";
    static const char alone[] = "sec second seconds datenum mjd";
    size_t length;
    name += *name == '%';                       /* MATLAB's comment */
    const struct time_unit *unit = ss_time_unit_in(name, &length);
    if (unit != NULL && length == 0)
        return unit->is_name || is_in_list(alone, name, strlen(name));
    return is_in_list(words, name, length);
}

const struct time_unit *
ss_time_unit_of_date(double number)
{
    for (size_t i = 0; i < 4; i++) {
        double seconds = number / units_of_time[i].divisor;
        if (seconds >= 946684800 && seconds < 4102444800)
            return &units_of_time[i];
    }
    return NULL;
}

int
ss_is_day_now(double number)
{
    return (number >= 20000 && number < 80000)          /* Excel's days of 1954 to 2119, MJD of 1913 to 2077 */
        || (number >= 690000 && number < 770000)        /* MATLAB's of 1889 to 2108 */
        || (number >= 2430000 && number < 2490000);     /* Julian days of 1941 to 2105 */
}
