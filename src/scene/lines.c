/* lines.c -- read a scene, shipped or of a file: lines "key = value", and settings that replace them.
 *
 * A message names the line; that of a setting names no place, which is known to the caller. */
#include <stickslip/scene.h>

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include "base/error.h"
#include "base/number.h"
#include "scene/model.h"

/* The origin of a key, which messages name: a line of the file, or a setting. */
struct key_origin {
    const char *name;           /* of the file */
    long line;                  /* 0: not given, > 0: line of the file, < 0: setting */
};

SS_PRINTF(3, 4) static ss_status
fail_at(struct key_origin at, ss_error *err, const char *format, ...)
{
    char text[256];
    va_list args;
    va_start(args, format);
    ss_print_text(text, sizeof text, format, args);
    va_end(args);
    if (at.line < 0)
        return ss_fail(err, SS_EINVAL, "%s", text);
    return ss_fail(err, SS_EDATA, "%s:%ld: %s", at.name, at.line, text);
}

/* --- a setting ----------------------------------------------------------------------------- */

static char *
trim(char *text)
{
    char *end = text + strlen(text);
    while (end > text && isspace((unsigned char)end[-1]))
        end--;
    *end = '\0';
    while (isspace((unsigned char)*text))
        text++;
    return text;
}

/* The keys that have been read, each once.  Only the model, which may come last, says where the values of
 * its own keys stand and what its words are. */
enum { GIVEN_MOST = 128, WORD_ROOM = 68 };
typedef struct given_key {
    const scene_key *key;           /* of some model */
    long line;
    double value;                   /* of a number */
    char word[WORD_ROOM];
} given_key;

typedef struct given {
    size_t n;
    given_key key[GIVEN_MOST];
} given;

static given_key *
find_given(given *g, const char *name)
{
    for (size_t i = 0; i < g->n; i++)
        if (strcmp(g->key[i].key->name, name) == 0)
            return &g->key[i];
    return NULL;
}

static long
line_of(given *g, const char *name)
{
    const given_key *found = find_given(g, name);
    return found != NULL ? found->line : 0;
}

/* Read one "key = value"; the text is split in place. */
static ss_status
read_setting(ss_scene *scene, char *text, struct key_origin at, given *g, ss_error *err)
{
    char *equals = strchr(text, '='), unknown[KEY_UNKNOWN_ROOM], wrong[WRONG_ROOM];
    if (equals == NULL)
        return fail_at(at, err, "expected 'key = value', found '%.64s'", trim(text));
    *equals = '\0';
    char *name = trim(text), *value = trim(equals + 1);
    const scene_key *k = ss_key_of_any(name);
    if (k == NULL)
        return fail_at(at, err, "%s", ss_key_unknown(unknown, name));
    given_key *found = find_given(g, name);
    if (found == NULL && g->n == GIVEN_MOST)
        return fail_at(at, err, "too many keys");
    if (found == NULL)
        *(found = &g->key[g->n++]) = (given_key){ .key = k };
    else if (found->line < 0)
        return fail_at(at, err, "repeated key '%s'", name);
    else if (at.line > 0)               /* a setting may replace a line of the file */
        return fail_at(at, err, "repeated key '%s', first given on line %ld", name, found->line);
    found->line = at.line;
    if (ss_key_is_own(k->offset) && k->words != NULL) {
        snprintf(found->word, WORD_ROOM, "%s", value);
        return SS_OK;
    }
    if (!ss_value_read(scene, k, value, wrong))
        return fail_at(at, err, "%s", wrong);
    if (ss_key_is_own(k->offset))
        found->value = *number_at(scene, k->offset);
    return SS_OK;
}

/* Set the model's own keys.  SS_EDATA if the scene has a key that belongs only to other models. */
static ss_status
set_own(ss_scene *scene, given *g, struct key_origin last, ss_error *err)
{
    const ss_model *model = scene->model;
    memset(scene->own, 0, sizeof scene->own);
    for (size_t i = 0; i < g->n; i++) {
        const given_key *one = &g->key[i];
        const scene_key *k = ss_key_named(model, one->key->name);
        struct key_origin at = { last.name, one->line };
        char wrong[WRONG_ROOM];
        if (k == NULL && line_of(g, "model") < 0)
            at.line = -1;               /* the setting that chose the model is at fault, not the file */
        if (k == NULL)
            return fail_at(at, err, "model %s has no key '%s'", model->name, one->key->name);
        int own = ss_key_is_own(k->offset), good = 1;
        if (own && k->words == NULL)
            *number_at(scene, k->offset) = one->value;
        else if (own)
            good = ss_value_read(scene, k, one->word, wrong);
        if (!good || !ss_value_check(scene, k, wrong))
            return fail_at(at, err, "%s", wrong);
    }
    return SS_OK;
}

/* The first key that the scene needs and lacks; NULL if it has all. */
static const scene_key *
missing_key(const ss_model *model, given *g)
{
    const scene_key *k, *forcing = NULL;
    int forced = 0;
    for (size_t i = 0; (k = ss_key_at(model, i)) != NULL; i++) {
        int missing = line_of(g, k->name) == 0;
        if (missing && k->required == REQUIRED)
            return k;
        if (missing && k->required == FORCING)
            forcing = k;
        forced |= !missing && k->required == FORCING;
    }
    return forced ? forcing : NULL;
}

/* Called after the last line: check that every key belongs to the model, and that none is missing. */
static ss_status
check_keys(ss_scene *scene, given *g, struct key_origin last, ss_error *err)
{
    if (scene->model == NULL)
        return fail_at(last, err, "missing key 'model'");
    ss_status st = set_own(scene, g, last, err);
    if (st != SS_OK)
        return st;
    const scene_key *k = missing_key(scene->model, g);
    if (k != NULL && k->required == FORCING)
        return fail_at(last, err, "missing key '%s': the base moves by it", k->name);
    if (k != NULL)
        return fail_at(last, err, "missing key '%s', which model %s needs", k->name, scene->model->name);
    long file = line_of(g, "base_file"), column = line_of(g, "base_column");
    if (file != 0 && scene->base_amplitude != 0)
        return fail_at((struct key_origin){ last.name, file }, err, TWO_BASES);
    if (column != 0 && file == 0)
        return fail_at((struct key_origin){ last.name, column }, err,
                       "base_column is one of base_file, which is missing");
    const char *less = ss_scene_static_is_less(scene), *than = less != NULL ? less + strlen("static_") : NULL;
    if (less != NULL) {
        long s = line_of(g, less), f = line_of(g, than);
        return fail_at((struct key_origin){ last.name, s < 0 || f < 0 ? -1 : s }, err, STATIC_IS_LESS, less, than);
    }
    if (ss_scene_samples(scene) == SIZE_MAX) {
        long where = line_of(g, "rate");
        struct key_origin at = { last.name, where != 0 ? where : line_of(g, "duration") };
        return fail_at(at, err, "duration x rate is more than 2^53 samples");
    }
    return SS_OK;
}

/* --- a file, or a shipped scene --------------------------------------------------------------- */

static const ss_shipped_scene *const shipped_lists[] = { ss_shipped_scenes, ss_catalogue_scenes };
enum { SHIPPED_LISTS = sizeof shipped_lists / sizeof *shipped_lists };

static const ss_shipped_scene *
find_shipped(const char *name)
{
    for (int i = 0; i < SHIPPED_LISTS; i++)
        for (const ss_shipped_scene *s = shipped_lists[i]; s->name != NULL; s++)
            if (strcmp(s->name, name) == 0)
                return s;
    return NULL;
}

static void
fail_absent(const char *path, ss_error *err)
{
    char names[256] = "";
    for (int i = 0; i < SHIPPED_LISTS; i++)
        for (const ss_shipped_scene *s = shipped_lists[i]; s->name != NULL; s++)
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s",
                     *names == '\0' ? "" : ", ", s->name);
    ss_fail(err, SS_EIO, "%s: no such file, and the shipped scenes are %s", path, names);
}

/* The text of a shipped scene, a file, or NULL with the reason in err. */
static FILE *
open_scene(const char *path, ss_error *err)
{
    const ss_shipped_scene *shipped = find_shipped(path);
    if (shipped != NULL) {
        FILE *text = fmemopen((void *)shipped->text, strlen(shipped->text), "r");
        if (text == NULL)
            ss_fail_errno(err, path, errno);
        return text;
    }
    FILE *in = fopen(path, "rb");
    int why = errno;
    struct stat st;
    if (in != NULL && fstat(fileno(in), &st) == 0 && !S_ISDIR(st.st_mode))
        return in;
    if (in != NULL)
        fclose(in);
    if (in != NULL || why != ENOENT)
        ss_fail_errno(err, path, in != NULL ? EISDIR : why);
    else
        fail_absent(path, err);
    return NULL;
}

/* Read one line without its newline and comment; *end becomes 1 after the last line. */
static ss_status
read_line(FILE *in, char *line, size_t size, struct key_origin at, int *end, ss_error *err)
{
    size_t n = 0;
    int c;
    while ((c = getc(in)) != EOF && c != '\n' && c != '\0' && n + 1 < size)
        line[n++] = (char)c;
    line[n] = '\0';
    if (at.line == 1 && ss_fail_kind(err, at.name, line, n, SS_KIND_SCENE) != SS_OK)
        return SS_EKIND;
    if (c == '\0' || (c != EOF && c != '\n'))
        return fail_at(at, err, c == '\0' ? "NUL byte: this is not a text file" : "line too long");
    *end = c == EOF;
    if (ferror(in))
        return ss_fail_errno(err, at.name, errno);
    if (strcspn(line, "\r") + 1 < n)
        return fail_at(at, err, "a lone CR; lines end in LF or CRLF");
    line[strcspn(line, "#")] = '\0';
    return SS_OK;
}

static ss_status
read_lines(ss_scene *out, FILE *in, const char *name, const char *const settings[], size_t n, ss_error *err)
{
    ss_scene scene = ss_scene_defaults;
    given g = { .n = 0 };
    struct key_origin at = { name, 0 };
    char line[1024];
    ss_status st = SS_OK;
    for (int end = 0; st == SS_OK && !end;) {
        at.line++;
        st = read_line(in, line, sizeof line, at, &end, err);
        char *text = at.line == 1 && strncmp(line, "\xef\xbb\xbf", 3) == 0 ? line + 3 : line;
        if (st == SS_OK && *trim(text) != '\0')        /* without a byte-order mark */
            st = read_setting(&scene, text, at, &g, err);
    }
    struct key_origin setting = { name, -1 };
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        if (snprintf(line, sizeof line, "%s", settings[i]) >= (int)sizeof line)
            return fail_at(setting, err, "setting too long");
        st = read_setting(&scene, line, setting, &g, err);
    }
    if (st == SS_OK)
        st = check_keys(&scene, &g, at, err);
    if (st == SS_OK)
        *out = scene;
    return st;
}

ss_status
ss_scene_read(ss_scene *scene, FILE *in, const char *name, const char *const settings[], size_t n, ss_error *err)
{
    if (scene == NULL || name == NULL || (settings == NULL && n > 0))
        return SS_FAIL_NULL(err);
    FILE *opened = in == NULL ? open_scene(name, err) : NULL;
    if (in == NULL && opened == NULL)
        return SS_EIO;
    ss_status st = read_lines(scene, in != NULL ? in : opened, name, settings, n, err);
    if (opened != NULL)
        fclose(opened);
    return st;
}
