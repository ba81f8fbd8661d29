/* header_text.c -- a header as lines "# key: value", and back. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/gaps.h"
#include "signal/header.h"

void
ss_write_label(FILE *out, const char *name, const char *unit)
{
    if (*unit == '\0')
        fprintf(out, " %s", name);
    else if (strpbrk(unit, "/ (") != NULL)
        fprintf(out, " %s/(%s)", name, unit);
    else
        fprintf(out, " %s/%s", name, unit);
}

ss_status
ss_header_check_notes(const ss_header *head, ss_error *err)
{
    return head->n_notes <= MAX_NOTES ? SS_OK
        : ss_fail(err, SS_EDATA, "%zu notes: files have no more than %d", head->n_notes, MAX_NOTES);
}

ss_status
ss_header_text(char **text, size_t *length, const ss_header *head, const char *magic, ss_error *err)
{
    char number[SS_NUMBER_MAX];
    ss_status st = ss_header_check_notes(head, err);
    *text = NULL;
    FILE *out = st == SS_OK ? open_memstream(text, length) : NULL;
    if (out == NULL)
        return st == SS_OK ? SS_ENOMEM : st;
    fprintf(out, "%s\n", magic);
    for (size_t i = 0; i < head->n_notes; i++)
        fprintf(out, "# %s\n", head->note[i]);
    ss_number_format(number, head->rate);
    fprintf(out, "# rate: %s\n", number);
    ss_number_format(number, head->start);
    fprintf(out, "# start: %s\n# columns:", number);
    if (head->has_time)
        fputs(" t/s", out);
    for (size_t i = 0; i < head->n_columns; i++)
        ss_write_label(out, head->column[i].name, head->column[i].unit);
    fputc('\n', out);
    int failed = ferror(out);
    if (fclose(out) == 0 && !failed)
        return SS_OK;
    free(*text);
    return SS_ENOMEM;
}

void
ss_split_label(char *label, char **name, char **unit)
{
    char *slash = strchr(label, '/');
    *name = label;
    *unit = label + strlen(label);
    if (slash == NULL)
        return;
    *slash = '\0';
    size_t n = strlen(slash + 1);
    if (slash[1] == '(' && slash[n] == ')') {
        slash[n] = '\0';
        slash++;
    }
    *unit = slash + 1;
}

int
ss_next_label(char **list, char **name, char **unit)
{
    char *label = *list + strspn(*list, " \t"), *p = label + strcspn(label, "/ \t");
    p += *p == '/';
    for (int depth = 0; *p != '\0' && (depth > 0 || (*p != ' ' && *p != '\t')); p++)
        depth += (*p == '(') - (*p == ')' && depth > 0);
    *list = p + (*p != '\0');
    *p = '\0';
    ss_split_label(label, name, unit);
    return **name != '\0' || *unit > label;
}

static ss_status
read_columns(ss_header *head, char *p, const char **reason)
{
    char *name, *unit;
    head->has_time = 0;
    for (int first = 1; ss_next_label(&p, &name, &unit); first = 0) {
        if (first && strcmp(name, "t") == 0 && strcmp(unit, "s") == 0) {
            head->has_time = 1;
            continue;
        }
        if (head->n_columns == MAX_COLUMNS) {
            *reason = "more than 32768 columns";
            return SS_EDATA;
        }
        ss_status st = ss_header_add_column(head, name, unit, NULL);
        *reason = "a column without a name";
        if (st != SS_OK)
            return st == SS_EINVAL ? SS_EDATA : st;
    }
    *reason = "no column but time";
    return head->n_columns > 0 ? SS_OK : SS_EDATA;
}

ss_status
ss_header_read_line(ss_header *head, char *line, const char **reason)
{
    char *key = line + 1, *colon = strchr(line, ':'), *end;
    if (colon == NULL)
        return SS_OK;
    *colon = '\0';
    while (*key != '\0' && is_blank(*key))
        key++;
    char *value = colon + 1 + strspn(colon + 1, " \t");
    double x = ss_number_parse(value, &end);
    int number = end > value && *end == '\0' && isfinite(x);
    if (strcmp(key, "rate") == 0) {
        *reason = "the rate is not a number above 0";
        head->rate = x;
        return number && x > 0 ? SS_OK : SS_EDATA;
    }
    if (strcmp(key, "start") == 0) {
        *reason = "the start is not a number";
        head->start = x;
        return number ? SS_OK : SS_EDATA;
    }
    if (strcmp(key, "columns") == 0) {
        *reason = "columns are named twice";
        return head->n_columns > 0 ? SS_EDATA : read_columns(head, value, reason);
    }
    *reason = "more than 4096 notes";
    if (head->n_notes == MAX_NOTES)
        return SS_EDATA;
    if (*key == '\0')
        return SS_OK;
    ss_status st = ss_header_note(head, key, value, NULL);
    *reason = WRONG_GAPS;
    return st == SS_OK && strcmp(key, "gaps") == 0 ? ss_header_check_gaps(head) : st;
}
