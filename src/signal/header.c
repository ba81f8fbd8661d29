/* header.c -- the description of a signal: rate, start, columns, notes. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/utf8.h"
#include "signal/header.h"

ss_status
ss_header_new(ss_header **out, double rate, double start, ss_error *err)
{
    if (out == NULL)
        return SS_FAIL_NULL(err);
    ss_header *head = *out = calloc(1, sizeof *head);
    if (head == NULL)
        return ss_fail_memory(err, NULL);
    head->rate = rate;
    head->start = start;
    head->has_time = 1;
    return SS_OK;
}

void
ss_header_free(ss_header *head)
{
    if (head == NULL)
        return;
    for (size_t i = 0; i < head->n_columns; i++) {
        free(head->column[i].name);
        free(head->column[i].unit);
    }
    for (size_t i = 0; i < head->n_notes; i++)
        free(head->note[i]);
    free(head->column);
    free(head->note);
    free(head);
}

/* Append a column with these strings.  The header owns them from now on; if this fails, they are freed.
 * NULL for one of them: there was no memory for it. */
static ss_status
append_column(ss_header *head, char *name, char *unit, ss_error *err)
{
    ss_column *more = realloc(head->column, (head->n_columns + 1) * sizeof *more);
    if (more != NULL)
        head->column = more;
    if (more == NULL || name == NULL || unit == NULL) {
        free(name);
        free(unit);
        return ss_fail_memory(err, NULL);
    }
    if (head->n_columns == 0 && strcmp(name, "t") == 0 && strcmp(unit, "s") == 0)
        head->has_time = 1;             /* or readers would take this column for the time */
    head->column[head->n_columns++] = (ss_column){ name, unit };
    return SS_OK;
}

ss_status
ss_header_select(ss_header **out, const ss_header *head, const size_t *column, size_t n, size_t first,
                 ss_error *err)
{
    ss_header *copy;
    if (out == NULL || head == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    ss_status st = ss_header_new(&copy, head->rate, head->start, err);
    if (st != SS_OK)
        return st;
    copy->note = calloc(head->n_notes + 1, sizeof *copy->note);
    st = copy->note != NULL ? SS_OK : ss_fail_memory(err, NULL);
    for (; st == SS_OK && copy->n_notes < head->n_notes; copy->n_notes++)
        if ((copy->note[copy->n_notes] = strdup(head->note[copy->n_notes])) == NULL)
            st = ss_fail_memory(err, NULL);
    copy->has_time = head->has_time;
    if (first > 0)
        copy->start += (double)first / head->rate;
    int ascending = 1;                          /* names in ascending order all differ */
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        size_t k = column != NULL ? column[i] : i;
        ascending = ascending && (column == NULL || i == 0 || k > column[i - 1]);
        if (k >= head->n_columns)
            st = ss_fail_column(err, k, head->n_columns);
        else if (ascending)
            st = append_column(copy, strdup(head->column[k].name), strdup(head->column[k].unit), err);
        else
            st = ss_header_add_column(copy, head->column[k].name, head->column[k].unit, err);
    }
    if (st == SS_OK)
        *out = copy;
    else
        ss_header_free(copy);
    return st;
}

/* --- columns ------------------------------------------------------------------------------- */

/* What drives a terminal becomes blanks, but for tabs; in the first bytes of text, its key, question marks: a
 * key that begins with a blank would be read as another. */
static char *
blank_controls(char *text, size_t key)
{
    int is_control;
    for (char *p = text; p != NULL && *p != '\0';) {
        size_t n = ss_utf8_next(p, &is_control);
        if (is_control && *p != '\t')
            memset(p, p < text + key ? '?' : ' ', n);
        p += n;
    }
    return text;
}

static char
clean_letter(char c)
{
    return is_blank(c) || c == '/' ? '_' : c;
}

static int
find_name(const ss_header *head, const char *name)
{
    for (size_t i = 0; i < head->n_columns; i++)
        if (strcmp(head->column[i].name, name) == 0)
            return (int)i;
    return -1;
}

/* The smallest n >= 2 for which no column is called name_n; 0: no memory.  It takes one pass over the
 * columns, since there are files in which thousands have the same name. */
static size_t
free_suffix(const ss_header *head, const char *name)
{
    size_t length = strlen(name), room = head->n_columns + 3;
    char *used = calloc(room, 1);
    if (used == NULL)
        return 0;
    for (size_t i = 0; i < head->n_columns; i++) {
        const char *p = head->column[i].name;
        if (strncmp(p, name, length) != 0 || p[length] != '_')
            continue;
        size_t number = 0;
        for (p += length + 1; *p >= '0' && *p <= '9' && number < room; p++)
            number = 10 * number + (size_t)(*p - '0');
        if (*p == '\0' && number < room)
            used[number] = 1;
    }
    size_t suffix = (size_t)((char *)memchr(used + 2, 0, room - 2) - used);
    free(used);
    return suffix;
}

/* The name without blanks and slashes; a number is appended if another column already has this name. */
static char *
clean_name(const ss_header *head, const char *name)
{
    char *clean = blank_controls(ss_utf8_text(name), 0);
    if (clean == NULL)
        return NULL;
    for (char *p = clean; *p != '\0'; p++)
        *p = clean_letter(*p);
    if (find_name(head, clean) < 0)
        return clean;
    size_t length = strlen(clean), suffix = free_suffix(head, clean);
    char *longer = suffix != 0 ? realloc(clean, length + 24) : NULL;
    if (longer == NULL)
        free(clean);
    else
        sprintf(longer + length, "_%zu", suffix);
    return longer;
}

char *
ss_clean_unit(const char *unit)
{
    char *clean = blank_controls(ss_utf8_text(unit != NULL ? unit : ""), 0);
    int depth = 0, lowest = 0;
    if (clean == NULL)
        return NULL;
    for (char *p = clean; *p != '\0'; p++) {
        if (is_blank(*p))
            *p = ' ';
        depth += (*p == '(') - (*p == ')');
        lowest = depth < lowest ? depth : lowest;
    }
    if (depth != 0 || lowest < 0)
        for (char *p = clean; (p = strpbrk(p, "()")) != NULL; )
            *p = ' ';
    if (strcmp(clean, "1") == 0 || strcmp(clean, "-") == 0)     /* a ratio has none */
        *clean = '\0';
    return clean;
}

ss_status
ss_header_add_column(ss_header *head, const char *name, const char *unit, ss_error *err)
{
    if (head == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    if (*name == '\0')
        return ss_fail(err, SS_EINVAL, "a column without a name");
    return append_column(head, clean_name(head, name), ss_clean_unit(unit), err);
}

static int
lower(char c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

/* The index of the only column whose name without blanks and slashes is the one asked for; -1 if there is
 * none, or more than one.  If fold is 1, upper and lower case are the same. */
static int
find_cleaned(const ss_header *head, const char *asked, int fold)
{
    int found = -1;
    for (size_t i = 0; i < head->n_columns; i++) {
        const char *p = head->column[i].name, *q = asked;
        while (*q != '\0' && (*p == clean_letter(*q) || (fold && lower(*p) == lower(*q)))) {
            p++;
            q++;
        }
        if (*p != '\0' || *q != '\0')
            continue;
        if (found >= 0)
            return -1;
        found = (int)i;
    }
    return found;
}

int
ss_header_column(const ss_header *head, const char *name)
{
    if (head == NULL || name == NULL)
        return -1;
    char *end;
    int c = find_name(head, name);
    if (c >= 0)
        return c;
    unsigned long number = *name >= '0' && *name <= '9' ? strtoul(name, &end, 10) : 0;
    if (number >= 1 && *end == '\0')
        return number <= head->n_columns ? (int)(number - 1) : -1;
    c = find_cleaned(head, name, 0);
    return c >= 0 || strlen(name) < 2 ? c : find_cleaned(head, name, 1);
}

size_t
ss_header_row(const ss_header *head, double t)
{
    if (head == NULL)
        return 0;
    double row = ceil((t - head->start) * head->rate - 1e-6);
    if (!(row > 0))
        return 0;
    return row < (double)(SIZE_MAX / 2) ? (size_t)row : SIZE_MAX / 2;
}

/* --- notes --------------------------------------------------------------------------------- */

/* The index of the note with this key, or n_notes if there is none; *value becomes the text after the
 * colon. */
static size_t
find_note(const ss_header *head, const char *key, size_t length, const char **value)
{
    size_t i;
    for (i = 0; i < head->n_notes; i++)
        if (strncmp(head->note[i], key, length) == 0 && head->note[i][length] == ':') {
            *value = head->note[i] + length + 1;
            *value += **value == ' ';
            break;
        }
    return i;
}

const char *
ss_header_find_note(const ss_header *head, const char *key)
{
    if (head == NULL || key == NULL)
        return NULL;
    const char *value = NULL;
    find_note(head, key, strlen(key), &value);
    return value;
}

int
ss_note_is(const char *note, const char *const name[])
{
    for (size_t length; *name != NULL; name++) {
        length = strlen(*name);
        if ((*name)[length - 1] == '*' ? strncmp(note, *name, length - 1) == 0
                                       : strncmp(note, *name, length) == 0 && note[length] == ':')
            return 1;
    }
    return 0;
}

/* Delete note i; there is none behind the last. */
static void
delete_note(ss_header *head, size_t i)
{
    if (i == head->n_notes)
        return;
    free(head->note[i]);
    head->n_notes--;
    memmove(&head->note[i], &head->note[i + 1], (head->n_notes - i) * sizeof *head->note);
}

void
ss_header_forget(ss_header *head, const char *const name[])
{
    for (size_t i = head->n_notes; i > 0; i--)
        if (ss_note_is(head->note[i - 1], name))
            delete_note(head, i - 1);
}

ss_status
ss_header_note(ss_header *head, const char *key, const char *value, ss_error *err)
{
    const char *old;
    if (head == NULL || key == NULL)
        return SS_FAIL_NULL(err);
    if (is_blank(*key) || strchr(key, ':') != NULL || strcmp(key, "rate") == 0
        || strcmp(key, "start") == 0 || strcmp(key, "columns") == 0)
        return ss_fail(err, SS_EINVAL, "no note can have the key '%.40s'", key);
    if (value == NULL) {
        delete_note(head, find_note(head, key, strlen(key), &old));
        return SS_OK;
    }
    char *raw = malloc(strlen(key) + strlen(value) + 3);
    if (raw == NULL)
        return ss_fail_memory(err, NULL);
    sprintf(raw, "%s: %s", key, value);
    char *note = ss_utf8_text(raw);
    free(raw);
    if (note == NULL)
        return ss_fail_memory(err, NULL);
    size_t length = strcspn(note, ":"), i;
    blank_controls(note, length);
    i = find_note(head, note, length, &old);
    if (i == head->n_notes) {
        char **more = realloc(head->note, (i + 1) * sizeof *more);
        if (more == NULL) {
            free(note);
            return ss_fail_memory(err, NULL);
        }
        head->note = more;
        head->note[head->n_notes++] = NULL;
    }
    free(head->note[i]);
    head->note[i] = note;
    return SS_OK;
}

ss_status
ss_refuse_range(const char *name, double rate, double start, ss_error *err)
{
    if (!(rate >= RATE_MIN && rate <= RATE_MAX && fabs(start) <= START_MAX))
        return ss_fail(err, SS_EDATA, "%s: a clock of %.3g Hz that starts at %.3g s is out of range: "
                       RATE_RANGE " Hz, -1e300 ... 1e300 s", name, rate, start);
    double apart = nextafter(fabs(start), INFINITY) - fabs(start);
    if (apart * rate <= 1)
        return SS_OK;
    return ss_fail(err, SS_EDATA, "%s: a clock of %.3g Hz that starts at %.3g s has equal time stamps: doubles are "
                   "%.3g s apart there", name, rate, start, apart);
}
