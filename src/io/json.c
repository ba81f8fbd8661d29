/* json.c -- rows for other programs: each is an object on a line of its own, whose cells have their names. */
#include <math.h>
#include <string.h>
#include "io/format.h"

static void
write_string(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text != '\0'; text++)
        if ((unsigned char)*text < ' ')
            fprintf(out, "\\u%04x", (unsigned)*text);
        else
            fprintf(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
    fputc('"', out);
}

static void
write_key(FILE *out, const char *name, int first)
{
    fputc(first ? '{' : ',', out);
    write_string(out, name);
    fputc(':', out);
}

static void
write_word(FILE *out, const char *word)
{
    if (strcmp(word, "-") == 0)
        fputs("null", out);
    else
        write_string(out, word);
}

static size_t
write_number(char *to, double x, int last)
{
    size_t n = isfinite(x) ? ss_number_format(to, x) : (size_t)sprintf(to, "null");
    memcpy(to + n, "}\n", 2);
    return n + (last ? 2 : 0);
}

static ss_status
begin_json(FILE *out, const ss_header *head, const char *magic, ss_error *err)
{
    (void)out, (void)head, (void)magic, (void)err;
    return SS_OK;
}

FORMAT(json) = {
    .name = "json",
    .begin = begin_json,
    .number = write_number,
    .has_time = 1,
    .separator = ',',
    .word = write_word,
    .key = write_key,
};
