/* lines.c -- read a scene: lines "key = value", and settings that replace them.
 *
 * A message names the line; that of a setting names no place, which is known to the caller. */
#include <stickslip/scene.h>

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include "base/error.h"
#include "base/number.h"
#include "scene/model.h"
#include "scene/value.h"

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

/* --- a value ------------------------------------------------------------------------------- */

/* A scene may come from a stranger, so it may name only files in its own folder or below. */
static int
leaves_folder(const char *path)
{
    size_t length = strlen(path);
    return path[0] == '/' || strncmp(path, "../", 3) == 0 || strstr(path, "/../") != NULL
        || strcmp(path, "..") == 0 || (length > 2 && strcmp(path + length - 3, "/..") == 0);
}

static ss_status
set_text(ss_scene *scene, const scene_key *k, const char *value, struct key_origin at,
         ss_error *err)
{
    const char *wrong = *value == '\0' ? "is empty" : strlen(value) >= k->room ? "is too long"
        : ss_value_no_text(value);
    if (wrong == NULL && k->range == PATH && leaves_folder(value))
        wrong = "leads out of the scene's folder; a file there or below is meant";
    if (wrong != NULL)
        return fail_at(at, err, "%s %s", k->name, wrong);
    strcpy(text_of(scene, k), value);
    return SS_OK;
}

static ss_status
set_word(ss_scene *scene, const scene_key *k, const char *value, struct key_origin at, ss_error *err)
{
    char words[256] = "";
    const char *word;
    for (int i = 0; (word = k->word(i)) != NULL; i++) {
        if (strcmp(value, word) == 0) {
            *word_of(scene, k) = i;
            return SS_OK;
        }
        size_t length = strlen(words);
        snprintf(words + length, sizeof words - length, "%s %s", i ? "," : "", word);
    }
    return fail_at(at, err, "%s is '%.64s', but must be one of%s", k->name, value, words);
}

static ss_status
set_value(ss_scene *scene, const scene_key *k, const char *value, struct key_origin at,
          ss_error *err)
{
    char *end;
    if (k->word != NULL)
        return set_word(scene, k, value, at, err);
    if (k->room > 0)
        return set_text(scene, k, value, at, err);
    double x = ss_number_parse(value, &end);
    if (end == value || *end != '\0')
        return fail_at(at, err, "%s is '%.64s', but must be a number", k->name, value);
    if (!ss_value_in_range(k, x))
        return fail_at(at, err, "%s = %.64s is out of range, it must be %s", k->name, value,
                       ss_value_range(k));
    *number_at(scene, k->offset) = x;
    return SS_OK;
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

/* The line of each key that has been read, indexed by the offset of its field in ss_scene. */
typedef struct given {
    long line[sizeof(ss_scene) / sizeof(int)];
} given;

static long *
line_of(given *g, const scene_key *k)
{
    return &g->line[k->offset / sizeof(int)];
}

/* Read one "key = value"; the text is split in place. */
static ss_status
read_setting(ss_scene *scene, char *text, struct key_origin at, given *g, ss_error *err)
{
    char *equals = strchr(text, '=');
    if (equals == NULL)
        return fail_at(at, err, "expected 'key = value', found '%.64s'", trim(text));
    *equals = '\0';
    char *name = trim(text);
    const scene_key *k = ss_key_of_any(name);
    char unknown[KEY_UNKNOWN_ROOM];
    if (k == NULL)
        return fail_at(at, err, "%s", ss_key_unknown(unknown, name));
    long *seen = line_of(g, k);
    if (at.line < 0 && *seen > 0)
        *seen = 0;                      /* a setting may replace a line of the file */
    if (*seen < 0)
        return fail_at(at, err, "repeated key '%s'", name);
    if (*seen > 0)
        return fail_at(at, err, "repeated key '%s', first given on line %ld", name, *seen);
    *seen = at.line;
    return set_value(scene, k, trim(equals + 1), at, err);
}

/* SS_EDATA if the scene has a key that belongs only to other models. */
static ss_status
check_foreign(const struct model *model, given *g, struct key_origin last, ss_error *err)
{
    const struct model *other;
    for (size_t i = 0; (other = ss_model_at(i)) != NULL; i++)
        for (size_t j = 0; j < other->n_keys; j++) {
            const scene_key *k = &other->keys[j];
            struct key_origin at = { last.name, *line_of(g, k) };
            if (at.line == 0 || ss_key_of_field(model, k->offset) != NULL)
                continue;
            /* if a setting chose the model, the setting is at fault, not the file */
            if (*line_of(g, ss_key_of_any("model")) < 0)
                at.line = -1;
            return fail_at(at, err, "model %s has no key '%s'", model->name, k->name);
        }
    return SS_OK;
}

/* The first key that the scene needs and lacks; NULL if it has all. */
static const scene_key *
missing_key(const struct model *model, given *g)
{
    const scene_key *k, *forcing = NULL;
    int forced = 0;
    for (size_t i = 0; (k = ss_key_at(model, i)) != NULL; i++) {
        int missing = *line_of(g, k) == 0;
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
check_keys(const ss_scene *scene, given *g, struct key_origin last, ss_error *err)
{
    const struct model *model = ss_model_of(scene);
    if (*line_of(g, ss_key_of_any("model")) == 0)
        return fail_at(last, err, "missing key 'model'");
    ss_status st = check_foreign(model, g, last, err);
    if (st != SS_OK)
        return st;
    const scene_key *k = missing_key(model, g);
    if (k != NULL && k->required == FORCING)
        return fail_at(last, err, "missing key '%s': the base moves by it", k->name);
    if (k != NULL)
        return fail_at(last, err, "missing key '%s', which model %s needs", k->name, model->name);
    long file = *line_of(g, ss_key_of_any("base_file"));
    if (file != 0 && scene->base_amplitude != 0)
        return fail_at((struct key_origin){ last.name, file }, err, TWO_BASES);
    long column = *line_of(g, ss_key_of_any("base_column"));
    if (column != 0 && file == 0)
        return fail_at((struct key_origin){ last.name, column }, err,
                       "base_column is one of base_file, which is missing");
    long s = *line_of(g, ss_key_of_any("static_friction")), f = *line_of(g, ss_key_of_any("friction"));
    if (s != 0 && scene->static_friction < scene->friction)
        return fail_at((struct key_origin){ last.name, s < 0 || f < 0 ? -1 : s }, err,
                       STATIC_IS_LESS);
    if (ss_scene_samples(scene) == SIZE_MAX) {
        long where = *line_of(g, ss_key_of_any("rate"));
        struct key_origin at = { last.name, where != 0 ? where : *line_of(g, ss_key_of_any("duration")) };
        return fail_at(at, err, "duration x rate is more than 2^53 samples");
    }
    return SS_OK;
}

/* --- a file -------------------------------------------------------------------------------- */

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

ss_status
ss_scene_read_set(ss_scene *out, FILE *in, const char *name, const char *const settings[],
                  size_t n, ss_error *err)
{
    ss_scene scene = ss_scene_defaults;
    given g = { 0 };
    struct key_origin at = { name, 0 };
    char line[1024];
    ss_status st = SS_OK;

    if (out == NULL || in == NULL || name == NULL || (settings == NULL && n > 0))
        return SS_FAIL_NULL(err);
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
ss_scene_read(ss_scene *scene, FILE *in, const char *name, ss_error *err)
{
    return ss_scene_read_set(scene, in, name, NULL, 0, err);
}
