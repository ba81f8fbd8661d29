/* options.c -- the options of a tool, from a table to values.
 *
 * getopt_long reads the command line; its tables are made of ours.  A tool is one short-lived process,
 * so the names that were given are static state here. */
#include "options.h"

#include <errno.h>
#include <float.h>
#include <getopt.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { OPTIONS_MOST = 64, LONG = 256 };         /* LONG: getopt_long's value of a table's first row */

double
tool_number(const char *option, const char *text, double lo, double hi)
{
    char *end;
    double x = ss_number_parse(text, &end);
    if (end == text || *end != '\0')
        tool_usage("%s: '%s' is not a number", option, text);
    if (!(x >= lo && x <= hi)) {
        char a[SS_NUMBER_MAX], b[SS_NUMBER_MAX];
        ss_number_format(a, lo);
        ss_number_format(b, hi);
        if (lo == DBL_MIN)
            tool_usage("%s: %s is out of range, it must be > 0", option, text);
        if (hi >= DBL_MAX)
            tool_usage("%s: %s is out of range, at least %s is needed", option, text, a);
        tool_usage("%s: %s is out of range %s ... %s", option, text, a, b);
    }
    return x;
}

long
tool_integer(const char *option, const char *text, long lo, long hi)
{
    char *end;
    errno = 0;
    long i = strtol(text, &end, 10);
    if (end == text || *end != '\0')
        tool_usage("%s: '%s' is not a whole number", option, text);
    if (hi == LONG_MAX && i < lo)
        tool_usage("%s: %s is out of range, at least %ld is needed", option, text, lo);
    if (errno != 0 || i < lo || i > hi)
        tool_usage("%s: %s is out of range %ld ... %ld", option, text, lo, hi);
    return i;
}

void
tool_pair(const char *option, const char *text, const char *form, double lo, double hi,
          double pair[2])
{
    char first[64];
    size_t n = strcspn(text, ":");
    if (text[n] != ':' || n >= sizeof first)
        tool_usage("%s: '%s' is not %s", option, text, form);
    memcpy(first, text, n);
    first[n] = '\0';
    pair[0] = tool_number(option, first, lo, hi);
    pair[1] = tool_number(option, text + n + 1, pair[0], hi);
}

int
tool_choice(const char *option, const char *text, const char *const choice[])
{
    char list[512] = "";
    for (int i = 0; choice[i] != NULL; i++) {
        if (strcmp(text, choice[i]) == 0)
            return i;
        tool_list(list, sizeof list, choice[i]);
    }
    tool_usage("%s: '%s' is none of %s", option, text, list);
}

/* The option's name with its dashes, for messages. */
static const char *
dashed(const tool_option *o)
{
    static char text[32];
    snprintf(text, sizeof text, "--%s", o->name);
    return text;
}

void
tool_set_flag(const tool_option *o, char *text)
{
    (void)text;
    *(int *)o->to = 1;
}

void
tool_set_text(const tool_option *o, char *text)
{
    *(const char **)o->to = text;
}

void
tool_set_texts(const tool_option *o, char *text)
{
    tool_texts *t = o->to;
    t->text = tool_room(t->text, t->n + 1, sizeof *t->text);
    t->text[t->n++] = text;
}

void
tool_set_number(const tool_option *o, char *text)
{
    *(double *)o->to = tool_number(dashed(o), text, o->range.from, o->range.to);
}

void
tool_set_whole(const tool_option *o, char *text)
{
    *(int *)o->to = (int)tool_integer(dashed(o), text, (long)o->range.from, (long)o->range.to);
}

void
tool_set_count(const tool_option *o, char *text)
{
    *(unsigned long *)o->to = (unsigned long)tool_integer(dashed(o), text, 1, LONG_MAX);
}

const char *const tool_styles[] = { "paper", "screen", NULL };  /* in the order of ss_plot_style */

/* An enumeration is stored as an int: it has the size of one, signed or not. */
void
tool_set_choice(const tool_option *o, char *text)
{
    int i = tool_choice(dashed(o), text, o->word);
    memcpy(o->to, &i, sizeof i);
}

void
tool_set_name(const tool_option *o, char *text)
{
    enum { MOST = 32 };
    const char *name[MOST + 1] = { NULL };
    for (size_t i = 0; i < MOST && o->known(i) != NULL; i++)
        name[i] = o->known(i);
    *(const char **)o->to = name[tool_choice(dashed(o), text, name)];
}

static void
set_common(const tool_option *o, char *text)
{
    (void)text;
    if (o->letter != 'q' && o->letter != 'v')
        tool_show(o->letter == 'h');
    tool_verbosity = o->letter == 'q' ? -1 : 1;
}

static const char *given[OPTIONS_MOST];
static size_t n_given;

int
tool_given(const char *name)
{
    for (size_t i = 0; i < n_given; i++)
        if (strcmp(given[i], name) == 0)
            return 1;
    return 0;
}

int
tool_given_others(const char *const names[])
{
    for (size_t i = 0; i < n_given; i++) {
        size_t k = 0;
        while (names[k] != NULL && strcmp(given[i], names[k]) != 0)
            k++;
        if (names[k] == NULL)
            return 1;
    }
    return 0;
}

/* The rows of all options, and what getopt_long needs to know of them. */
typedef struct option_rows {
    tool_option row[OPTIONS_MOST];
    size_t n;
    struct option names[OPTIONS_MOST + 1];
    char letters[2 * OPTIONS_MOST + 1];
} option_rows;

static void
append(option_rows *t, const tool_option option[], size_t n)
{
    for (size_t i = 0; i < n && t->n < OPTIONS_MOST; i++, t->n++) {
        int value = option[i].has_value ? required_argument : no_argument;
        const char letter[] = { (char)option[i].letter, value == no_argument ? '\0' : ':', '\0' };
        t->row[t->n] = option[i];
        t->names[t->n] = (struct option){ option[i].name, value, NULL, LONG + (int)t->n };
        strcat(t->letters, letter);
    }
}

int
tool_parse(int argc, char *argv[], const tool_option option[], size_t n, tool_reading *reading)
{
    static const tool_option common[] = {
        TOOL_CALL('q', "quiet", set_common, NULL), TOOL_CALL('v', "verbose", set_common, NULL),
        TOOL_CALL('h', "help", set_common, NULL), TOOL_CALL(0, "version", set_common, NULL) };
    tool_option of_reading[TOOL_READING_OPTIONS];
    option_rows t = { .n = 0 };
    append(&t, option, n);
    if (reading != NULL) {
        tool_reading_options(reading, of_reading);
        append(&t, of_reading, TOOL_READING_OPTIONS);
    }
    append(&t, common, sizeof common / sizeof *common);
    /* refuse control characters in long options, since getopt prints an unknown option as it is; names of files may
     * look like options */
    for (char **arg = argv + 1; *arg != NULL && strcmp(*arg, "--") != 0; arg++) {
        size_t length = strcspn(*arg, "=");
        char *text = strncmp(*arg, "--", 2) == 0 ? strndup(*arg, length) : NULL;
        if (text != NULL && strncmp(ss_printable(text), *arg, length) != 0)
            tool_usage("unrecognized option '%s'", text);
        free(text);
    }
    for (int c; (c = getopt_long(argc, argv, t.letters, t.names, NULL)) != -1;) {
        size_t i = c >= LONG ? (size_t)(c - LONG) : 0;
        while (c < LONG && i < t.n && t.row[i].letter != c)
            i++;
        if (i == t.n)                   /* it has written an error */
            tool_usage(NULL);
        const tool_option *o = &t.row[i];
        if (!tool_given(o->name))
            given[n_given++] = o->name;
        o->set(o, optarg);
    }
    for (size_t i = 0; reading != NULL && i < TOOL_READING_OPTIONS; i++)
        reading->given |= tool_given(of_reading[i].name);
    return optind;
}
