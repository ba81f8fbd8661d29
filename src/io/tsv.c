/* tsv.c -- our own text: a header of lines "# key: value", then rows of numbers.
 *
 * Each time stamp is compared with start + n / rate, so that a lost row is noticed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/format.h"

struct text {
    ss_source base;
    struct input *in;
    ss_status (*late_note)(void *user, char *line, ss_error *err);
    void *user;
};

/* The error of a row that could not be read. */
static ss_status
refuse_row(const struct text *s, const char *line, ss_error *err)
{
    const ss_header *head = s->base.head;
    const char *name = s->in->name, *bad = NULL;
    const size_t time = head->has_time != 0, cells = head->n_columns + time;
    size_t found = 0, length, bad_length = 0, bad_cell = 0;
    for (const char *p = line; *(p += strspn(p, " \t")) != '\0'; p += length, found++) {
        length = strcspn(p, " \t");
        char *end;
        double x = ss_number_parse(p, &end);
        if (bad == NULL && (end != p + length || !isfinite(x))) {
            bad = p;
            bad_length = length;
            bad_cell = found;
        }
    }
    if (found != cells)
        return ss_fail(err, SS_EDATA, "%s:%lu: expected %zu column%s, found %zu", name, s->in->line, cells,
                       PLURAL(cells), found);
    if (bad == NULL)
        return ss_fail(err, SS_EDATA, "%s:%lu: a NUL byte in text", name, s->in->line);
    const char *column = bad_cell < time ? "t" : head->column[bad_cell - time].name;
    return ss_fail(err, SS_EDATA, "%s:%lu: column %s: '%.*s' is not a finite number", name, s->in->line, column,
                   bad_length < 40 ? (int)bad_length : 40, bad);
}

/* Read a line as row number `at` of the columns. */
static ss_status
read_row(const struct text *s, char *line, size_t length, double *const column[], size_t at, ss_error *err)
{
    const size_t time = s->base.head->has_time != 0, n = s->base.head->n_columns + time;
    char *p = line, *end;
    double t = 0;
    for (size_t i = 0; i < n; i++, p = end) {
        double x = ss_number_parse(p, &end);
        if (end == p || !isfinite(x) || (*end != '\t' && *end != ' ' && *end != '\0'))
            return refuse_row(s, line, err);
        if (i < time)
            t = x;
        else if (column[i - time] != NULL)
            column[i - time][at] = x;
    }
    if (p + strspn(p, " \t") != line + length)
        return refuse_row(s, line, err);
    const ss_header *head = s->base.head;
    if (!time || ss_is_on_clock(t, head->rate, head->start, s->base.row))
        return SS_OK;
    char is[SS_NUMBER_MAX], should[SS_NUMBER_MAX];
    ss_number_format(is, t);
    ss_number_format(should, head->start + (double)s->base.row / head->rate);
    return ss_fail(err, SS_EDATA, "%s:%lu: time is %s, expected start + %llu / rate = %s", s->in->name,
                   s->in->line, is, (unsigned long long)s->base.row, should);
}

static ss_status
give_rows(ss_source *base, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct text *s = (struct text *)base;
    char *line;
    size_t length;
    while (*n < max && (*n == 0 || ss_input_has_line(s->in))) {
        ss_status st = ss_input_line(s->in, &line, &length, err);
        if (st != SS_OK || line == NULL)
            return st;
        base->line = s->in->line;
        int is_note = line[0] == '#';
        if (!is_note && line[strspn(line, " \t")] == '\0')
            continue;
        st = !is_note ? read_row(s, line, length, column, *n, err)
            : s->late_note != NULL ? s->late_note(s->user, line, err) : SS_OK;
        if (st != SS_OK)
            return st;
        *n += !is_note;
        s->base.row += !is_note;
    }
    return SS_OK;
}

/* The header ends before the first line that is no comment. */
static ss_status
open_text(ss_source **out, const struct opening *o, ss_error *err)
{
    static const struct source_calls calls = { .next = give_rows };
    struct input *in = o->in;
    const char *reason = "";
    char *line;
    size_t length;
    struct text *s = ss_source_new(sizeof *s, &calls, in->name, err);
    if (s == NULL)
        return SS_ENOMEM;
    *out = &s->base;
    s->in = in;
    s->late_note = o->late_note;
    s->user = o->user;
    ss_header *head = s->base.head;
    ss_status st = ss_input_begin(in, o->kind, err);
    while (st == SS_OK && (st = ss_input_need(in, 1, err)) == SS_OK && in->lo < in->hi
           && in->buffer[in->lo] == '#') {
        if ((st = ss_input_line(in, &line, &length, err)) != SS_OK)
            break;
        st = ss_header_read_line(head, line, &reason);
        if (st != SS_OK)
            return ss_fail(err, st, "%s:%lu: %s", in->name, in->line, st == SS_EDATA ? reason : ss_strerror(st));
    }
    if (st != SS_OK)
        return st;
    if (head->n_columns == 0)
        return ss_fail(err, SS_EDATA, "%s:%lu: no '# columns:' line in the header", in->name, in->line);
    if (head->rate > 0)
        return ss_refuse_clock(in->name, head->rate, o->opts, err);
    if (!(o->opts->rate > 0))
        return ss_fail(err, SS_EDATA, "%s:%lu: no '# rate:' line in the header", in->name, in->line);
    head->rate = o->opts->rate;
    return ss_refuse_table(in->name, o->opts, err);
}

static ss_status
begin_text(FILE *out, const ss_header *head, const char *magic, ss_error *err)
{
    size_t length;
    char *text;
    ss_status st = ss_header_text(&text, &length, head, magic, err);
    if (st != SS_OK)
        return st;
    fwrite(text, 1, length, out);
    free(text);
    return ferror(out) ? SS_EIO : SS_OK;
}

FORMAT(tsv) = {
    .name = "tsv",
    .magic = "# stickslip",
    .has_header = 1,
    .open = open_text,
    .begin = begin_text,
    .has_time = 1,
    .has_notes = 1,
    .separator = '\t',
};
