/* scene.c -- a scene: read, check, write; its model's parameters and no others.
 *
 * One table says for every key which models have it, whether it must be given and what it may be;
 * reading, checking and writing all follow that table. */
#include <stickslip/scene.h>

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <stickslip/signal.h>
#include "base/error.h"

const ss_scene ss_scene_defaults = { .duration = 10, .rate = 2000 };

static const char *const model_words[] = { "coulomb", "state-variable", "compliant", NULL };
static const char *const law_words[] = { "scaled", "literal", NULL };
static const char *const release_words[] = { "spring", "total", NULL };

enum { COULOMB = 1 << SS_COULOMB, STATE = 1 << SS_STATE_VARIABLE, COMPLIANT = 1 << SS_COMPLIANT,
       EVERY = COULOMB | STATE | COMPLIANT };
enum { ANY, NOT_NEGATIVE, POSITIVE };       /* what a number may be; all are finite */

static const struct key {
    const char *name;
    unsigned models;                /* that have it */
    int required;
    int range;                      /* of a number */
    const char *const *words;       /* of an enumeration; NULL for a number */
    size_t offset;
    const char *unit;               /* of a number */
} key[] = {
    { "model",             EVERY,     1, 0, model_words, offsetof(ss_scene, model), "" },
    { "mass",              EVERY,     1, POSITIVE, NULL, offsetof(ss_scene, mass), "kg" },
    { "stiffness",         EVERY,     1, POSITIVE, NULL, offsetof(ss_scene, stiffness), "N/m" },
    { "friction",          EVERY,     1, NOT_NEGATIVE, NULL, offsetof(ss_scene, friction), "N" },
    { "base_amplitude",    EVERY,     1, NOT_NEGATIVE, NULL, offsetof(ss_scene, base_amplitude),
      "m" },
    { "base_frequency",    EVERY,     1, NOT_NEGATIVE, NULL, offsetof(ss_scene, base_frequency),
      "Hz" },
    { "phase",             EVERY,     0, ANY, NULL, offsetof(ss_scene, phase), "rad" },
    { "x0",                EVERY,     0, ANY, NULL, offsetof(ss_scene, x0), "m" },
    { "v0",                EVERY,     0, ANY, NULL, offsetof(ss_scene, v0), "m/s" },
    { "alpha",             STATE,     1, POSITIVE, NULL, offsetof(ss_scene, alpha), "s/m" },
    { "gamma",             STATE,     1, POSITIVE, NULL, offsetof(ss_scene, gamma), "1/s" },
    { "law",               STATE,     0, 0, law_words, offsetof(ss_scene, law), "" },
    { "contact_stiffness", COMPLIANT, 1, POSITIVE, NULL, offsetof(ss_scene, contact_stiffness),
      "N/m" },
    { "contact_damping",   COMPLIANT, 1, NOT_NEGATIVE, NULL, offsetof(ss_scene, contact_damping),
      "N s/m" },
    { "release",           COMPLIANT, 0, 0, release_words, offsetof(ss_scene, release), "" },
    { "settle",            EVERY,     0, NOT_NEGATIVE, NULL, offsetof(ss_scene, settle), "s" },
    { "duration",          EVERY,     0, NOT_NEGATIVE, NULL, offsetof(ss_scene, duration), "s" },
    { "rate",              EVERY,     0, POSITIVE, NULL, offsetof(ss_scene, rate), "Hz" },
};
enum { KEYS = sizeof key / sizeof *key, MODEL_KEY = 0 };

const char *
ss_model_name(ss_model model)
{
    return (unsigned)model <= SS_COMPLIANT ? model_words[model] : "?";
}

size_t
ss_scene_samples(const ss_scene *scene)
{
    if (scene == NULL)
        return 0;
    double n = nearbyint(scene->duration * scene->rate);
    return n < 0x1p53 ? (size_t)n : SIZE_MAX;
}

/* --- values -------------------------------------------------------------------------------- */

/* All enumerations of a scene are read and written through int. */
_Static_assert(sizeof(ss_model) == sizeof(int) && sizeof(ss_law) == sizeof(int)
               && sizeof(ss_release) == sizeof(int), "enumerations have the size of int");

static double *
number_of(ss_scene *scene, const struct key *k)
{
    return (double *)(void *)((char *)scene + k->offset);
}

static int *
word_of(ss_scene *scene, const struct key *k)
{
    return (int *)(void *)((char *)scene + k->offset);
}

static int
in_range(const struct key *k, double x)
{
    return isfinite(x) && (k->range == ANY || x > 0 || (k->range == NOT_NEGATIVE && x == 0));
}

static const char *
range_text(const struct key *k)
{
    return k->range == POSITIVE ? "> 0" : k->range == NOT_NEGATIVE ? ">= 0" : "finite";
}

/* Where a key stands, for messages: a line of the file, or a setting. */
struct place {
    const char *name;           /* of the file */
    long line;                  /* 0: not given, > 0: line of the file, < 0: setting */
};

static ss_status
fail_at(struct place at, ss_error *err, const char *text)
{
    if (at.line < 0)
        return ss_fail(err, SS_EINVAL, "%s", text);
    return ss_fail(err, SS_EDATA, "%s:%ld: %s", at.name, at.line, text);
}

static ss_status
set_value(ss_scene *scene, const struct key *k, const char *value, struct place at, ss_error *err)
{
    char text[256], *end;
    if (k->words != NULL) {
        snprintf(text, sizeof text, "%s is '%.64s', but must be one of", k->name, value);
        for (int i = 0; k->words[i] != NULL; i++) {
            if (strcmp(value, k->words[i]) == 0) {
                *word_of(scene, k) = i;
                return SS_OK;
            }
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s %s", i ? "," : "",
                     k->words[i]);
        }
        return fail_at(at, err, text);
    }
    double x = ss_number_parse(value, &end);
    if (end == value || *end != '\0') {
        snprintf(text, sizeof text, "%s is '%.64s', but must be a number", k->name, value);
        return fail_at(at, err, text);
    }
    if (!in_range(k, x)) {
        snprintf(text, sizeof text, "%s = %.64s is out of range, it must be %s", k->name, value,
                 range_text(k));
        return fail_at(at, err, text);
    }
    *number_of(scene, k) = x;
    return SS_OK;
}

/* --- keys ---------------------------------------------------------------------------------- */

/* Edits (insert, delete, replace) between two words, Levenshtein 1966. */
static size_t
distance(const char *a, const char *b)
{
    enum { LONGEST = 64 };
    size_t row[LONGEST + 1], n = strlen(b);
    if (strlen(a) > LONGEST || n > LONGEST)
        return SIZE_MAX;
    for (size_t j = 0; j <= n; j++)
        row[j] = j;
    for (size_t i = 1; a[i - 1] != '\0'; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= n; j++) {
            size_t best = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            if (row[j] + 1 < best)
                best = row[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            row[j] = best;
        }
    }
    return row[n];
}

static const struct key *
find_key(const char *name)
{
    for (size_t i = 0; i < KEYS; i++)
        if (strcmp(name, key[i].name) == 0)
            return &key[i];
    return NULL;
}

static const char *
nearest_key(const char *name)
{
    const char *best = key[0].name;
    for (size_t i = 1; i < KEYS; i++)
        if (distance(name, key[i].name) < distance(name, best))
            best = key[i].name;
    return best;
}

/* The key that a name is most like may be one mistyped, if few letters differ. */
static ss_status
fail_unknown(const char *name, struct place at, ss_error *err)
{
    const char *best = nearest_key(name);
    size_t length = strlen(name), off = distance(name, best);
    char text[256];
    if (off < length && off <= (length / 3 > 2 ? length / 3 : 2))
        snprintf(text, sizeof text, "unknown key '%.64s'; the nearest is '%s'", name, best);
    else
        snprintf(text, sizeof text, "unknown key '%.64s'; ss-sim --list SCENE shows a scene's, "
                 "stickslip-scene(5) all", name);
    return fail_at(at, err, text);
}

double *
ss_scene_number(ss_scene *scene, const char *name, const char **unit, ss_error *err)
{
    if (scene == NULL || name == NULL || (unsigned)scene->model > SS_COMPLIANT) {
        ss_fail(err, SS_EINVAL, "no scene of a known model, or no key");
        return NULL;
    }
    const struct key *k = find_key(name);
    if (k == NULL) {
        fail_unknown(name, (struct place){ "", -1 }, err);
    } else if (!(k->models & 1u << scene->model)) {
        ss_fail(err, SS_EINVAL, "model %s has no key '%s'", model_words[scene->model], name);
    } else if (k->words != NULL) {
        ss_fail(err, SS_EINVAL, "%s is not a number", name);
    } else {
        if (unit != NULL)
            *unit = k->unit;
        return number_of(scene, k);
    }
    return NULL;
}

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

/* One "key = value", which is cut up in place.  given holds the line of each key so far. */
static ss_status
read_setting(ss_scene *scene, char *text, struct place at, long given[KEYS], ss_error *err)
{
    char message[256], *equals = strchr(text, '=');
    if (equals == NULL) {
        snprintf(message, sizeof message, "expected 'key = value', found '%.64s'", trim(text));
        return fail_at(at, err, message);
    }
    *equals = '\0';
    char *name = trim(text);
    const struct key *k = find_key(name);
    if (k == NULL)
        return fail_unknown(name, at, err);
    long *seen = &given[k - key];
    if (at.line < 0 && *seen > 0)
        *seen = 0;                      /* a setting takes the place of the file's line */
    if (*seen != 0) {
        snprintf(message, sizeof message, at.line < 0 ? "repeated key '%s'"
                 : "repeated key '%s', first given on line %ld", name, *seen);
        return fail_at(at, err, message);
    }
    *seen = at.line;
    return set_value(scene, k, trim(equals + 1), at, err);
}

/* After the last line: every key belongs to the model, and none is missing. */
static ss_status
check_keys(const ss_scene *scene, const long given[KEYS], struct place last, ss_error *err)
{
    char text[256];
    if (given[MODEL_KEY] == 0)
        return fail_at(last, err, "missing key 'model'");
    const char *model = model_words[scene->model];
    for (size_t i = 0; i < KEYS; i++) {
        struct place at = { last.name, given[i] };
        int has = (key[i].models & 1u << scene->model) != 0;
        if (given[i] != 0 && !has) {
            snprintf(text, sizeof text, "model %s has no key '%s'", model, key[i].name);
            /* a model chosen by a setting makes the file's keys wrong, not the file */
            if (given[MODEL_KEY] < 0)
                at.line = -1;
            return fail_at(at, err, text);
        }
        if (given[i] == 0 && has && key[i].required) {
            snprintf(text, sizeof text, "missing key '%s', which model %s needs", key[i].name,
                     model);
            return fail_at(last, err, text);
        }
    }
    if (ss_scene_samples(scene) == SIZE_MAX) {
        long where = given[find_key("rate") - key];
        struct place at = { last.name, where != 0 ? where : given[find_key("duration") - key] };
        return fail_at(at, err, "duration x rate is more than 2^53 samples");
    }
    return SS_OK;
}

/* --- reading and writing ------------------------------------------------------------------- */

/* Read one line without its newline and comment; *end is 1 after the last. */
static ss_status
read_line(FILE *in, char *line, size_t size, struct place at, int *end, ss_error *err)
{
    size_t n = 0;
    int c;
    while ((c = getc(in)) != EOF && c != '\n' && c != '\0' && n + 1 < size)
        line[n++] = (char)c;
    line[n] = '\0';
    if (at.line == 1 && ss_fail_kind(err, at.name, line, n, "a scene") != SS_OK)
        return SS_EDATA;
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
    long given[KEYS] = { 0 };
    struct place at = { name, 0 };
    char line[1024];
    ss_status st = SS_OK;

    if (out == NULL || in == NULL || name == NULL || (settings == NULL && n > 0))
        return SS_FAIL_NULL(err);
    for (int end = 0; st == SS_OK && !end;) {
        at.line++;
        st = read_line(in, line, sizeof line, at, &end, err);
        if (st == SS_OK && *trim(line) != '\0')
            st = read_setting(&scene, line, at, given, err);
    }
    struct place setting = { name, -1 };
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        if (snprintf(line, sizeof line, "%s", settings[i]) >= (int)sizeof line)
            return fail_at(setting, err, "setting too long");
        st = read_setting(&scene, line, setting, given, err);
    }
    if (st == SS_OK)
        st = check_keys(&scene, given, at, err);
    if (st == SS_OK)
        *out = scene;
    return st;
}

ss_status
ss_scene_read(ss_scene *scene, FILE *in, const char *name, ss_error *err)
{
    return ss_scene_read_set(scene, in, name, NULL, 0, err);
}

/* The text of a shipped scene, a file, or NULL with the reason in err. */
static FILE *
open_scene(const char *path, ss_error *err)
{
    char names[256] = "";
    for (const ss_shipped_scene *s = ss_shipped_scenes; s->name != NULL; s++) {
        if (strcmp(s->name, path) == 0) {
            FILE *text = fmemopen((void *)s->text, strlen(s->text), "r");
            if (text == NULL)
                ss_fail_errno(err, path, errno);
            return text;
        }
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s",
                 s == ss_shipped_scenes ? "" : ", ", s->name);
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
        ss_fail(err, SS_EIO, "%s: no such file, and the shipped scenes are %s", path, names);
    return NULL;
}

ss_status
ss_scene_load(ss_scene *scene, const char *path, const char *const settings[], size_t n,
              ss_error *err)
{
    if (scene == NULL || path == NULL || (settings == NULL && n > 0))
        return SS_FAIL_NULL(err);
    FILE *in = open_scene(path, err);
    if (in == NULL)
        return SS_EIO;
    ss_status st = ss_scene_read_set(scene, in, path, settings, n, err);
    fclose(in);
    return st;
}

ss_status
ss_scene_check(const ss_scene *scene, ss_error *err)
{
    if (scene == NULL)
        return SS_FAIL_NULL(err);
    ss_scene copy = *scene;         /* the accessors below give what may be changed */
    for (size_t i = 0; i < KEYS; i++) {
        const struct key *k = &key[i];
        if (k->words != NULL) {
            int word = *word_of(&copy, k), count = 0;
            while (k->words[count] != NULL)
                count++;
            if (word < 0 || word >= count)
                return ss_fail(err, SS_EINVAL, "%s is no known choice", k->name);
        } else if ((k->models & 1u << copy.model) && !in_range(k, *number_of(&copy, k))) {
            char text[SS_NUMBER_MAX];
            ss_number_format(text, *number_of(&copy, k));
            return ss_fail(err, SS_EINVAL, "%s = %s is out of range, it must be %s", k->name,
                           text, range_text(k));
        }
    }
    return SS_OK;
}

ss_status
ss_scene_write(const ss_scene *scene, FILE *out)
{
    if (scene == NULL || out == NULL || ss_scene_check(scene, NULL) != SS_OK)
        return SS_EINVAL;
    ss_scene copy = *scene;
    for (size_t i = 0; i < KEYS; i++) {
        const struct key *k = &key[i];
        char text[SS_NUMBER_MAX];
        if (!(k->models & 1u << scene->model))
            continue;
        if (k->words == NULL)
            ss_number_format(text, *number_of(&copy, k));
        fprintf(out, "%s = %s\n", k->name, k->words ? k->words[*word_of(&copy, k)] : text);
    }
    return ferror(out) ? SS_EIO : SS_OK;
}
