/* tsv.c -- our own text: a header of lines "# key: value", then rows of numbers.
 *
 * Each time stamp is compared with start + n / rate, so that a lost row is noticed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/table/clock.h"
#include "io/format.h"
#include "io/reader.h"

static size_t
n_cells(const ss_header *head)
{
    return head->n_columns + (head->has_time != 0);
}

static const char *
cell_name(const ss_header *head, size_t i)
{
    if (head->has_time && i == 0)
        return "t";
    return head->column[i - (head->has_time != 0)].name;
}

/* The error of a row that could not be read. */
static ss_status
refuse_row(const ss_reader *reader, const char *line, ss_error *err)
{
    const ss_header *head = reader->head;
    const char *name = reader->in.name, *bad = NULL;
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
    if (found != n_cells(head))
        return ss_fail(err, SS_EDATA, "%s:%lu: expected %zu column%s, found %zu", name,
                       reader->in.line, n_cells(head), PLURAL(n_cells(head)), found);
    if (bad == NULL)
        return ss_fail(err, SS_EDATA, "%s:%lu: a NUL byte in text", name, reader->in.line);
    return ss_fail(err, SS_EDATA, "%s:%lu: column %s: '%.*s' is not a finite number", name,
                   reader->in.line, cell_name(head, bad_cell), bad_length < 40 ? (int)bad_length : 40,
                   bad);
}

static ss_status
check_time(const ss_reader *reader, double t, ss_error *err)
{
    const ss_header *head = reader->head;
    if (ss_is_on_clock(t, head->rate, reader->start, reader->row))
        return SS_OK;
    char is[SS_NUMBER_MAX], should[SS_NUMBER_MAX];
    ss_number_format(is, t);
    ss_number_format(should, reader->start + (double)reader->row / head->rate);
    return ss_fail(err, SS_EDATA, "%s:%lu: time is %s, expected start + %llu / rate = %s",
                   reader->in.name, reader->in.line, is, (unsigned long long)reader->row, should);
}

static ss_status
read_row(ss_reader *reader, char *line, size_t length, double *const column[], size_t at, ss_error *err)
{
    size_t n = n_cells(reader->head);
    const int time = reader->head->has_time != 0;
    char *p = line, *end;
    double t = 0;
    for (size_t i = 0; i < n; i++, p = end) {
        double x = ss_number_parse(p, &end);
        if (end == p || !isfinite(x) || (*end != '\t' && *end != ' ' && *end != '\0'))
            return refuse_row(reader, line, err);
        if (time && i == 0)
            t = x;
        else if (column[i - (size_t)time] != NULL)
            column[i - (size_t)time][at] = x;
    }
    if (p + strspn(p, " \t") != line + length)
        return refuse_row(reader, line, err);
    return time ? check_time(reader, t, err) : SS_OK;
}

static ss_status
text_rows(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err)
{
    char *line;
    size_t length;
    while (*n < max && (*n == 0 || ss_input_has_line(&reader->in))) {
        ss_status st = ss_input_line(&reader->in, &line, &length, err);
        if (st != SS_OK || line == NULL)
            return st;
        if (line[0] == '#' && reader->late_note != NULL)
            st = reader->late_note(reader, line, err);
        if (st != SS_OK)
            return st;
        if (line[0] == '#' || line[strspn(line, " \t")] == '\0')
            continue;
        st = read_row(reader, line, length, column, *n, err);
        if (st != SS_OK)
            return st;
        ++*n;
        reader->row++;
    }
    return SS_OK;
}

/* The header ends before the first line that is no comment. */
static ss_status
open_text(ss_reader *reader, const ss_read_opts *opts, ss_error *err)
{
    struct input *in = &reader->in;
    const char *reason = "";
    char *line;
    size_t length;
    ss_status st = ss_input_begin(in, reader->kind, err);
    reader->head->rate = 0;
    while (st == SS_OK && (st = ss_input_need(in, 1, err)) == SS_OK) {
        if (in->lo == in->hi || in->buffer[in->lo] != '#')
            break;
        st = ss_input_line(in, &line, &length, err);
        if (st != SS_OK)
            break;
        st = ss_header_read_line(reader->head, line, &reason);
        if (st != SS_OK)
            return ss_fail(err, st, "%s:%lu: %s", in->name, in->line,
                           st == SS_EDATA ? reason : ss_strerror(st));
    }
    if (st != SS_OK)
        return st;
    if (reader->head->n_columns == 0)
        return ss_fail(err, SS_EDATA, "%s:%lu: no '# columns:' line in the header", in->name, in->line);
    reader->rows = text_rows;
    if (reader->head->rate > 0)
        return ss_refuse_clock(in->name, reader->head->rate, opts, err);
    if (!(opts->rate > 0))
        return ss_fail(err, SS_EDATA, "%s:%lu: no '# rate:' line in the header", in->name, in->line);
    reader->head->rate = opts->rate;
    return ss_refuse_table(in->name, opts, err);
}

/* --- writing ------------------------------------------------------------------------------- */

static ss_status
begin_text(FILE *out, const ss_header *head, const char *magic, ss_error *err)
{
    size_t length;
    ss_status st = ss_header_check_notes(head, err);
    if (st != SS_OK)
        return st;
    char *text = ss_header_text(head, magic, &length);
    if (text == NULL)
        return SS_ENOMEM;
    fwrite(text, 1, length, out);
    free(text);
    return ferror(out) ? SS_EIO : SS_OK;
}

static size_t
format_number(char *to, double x, int last)
{
    size_t n = ss_number_format(to, x);
    to[n] = last ? '\n' : '\t';
    return n + 1;
}

const struct format ss_format_tsv = {
    .name = "tsv",
    .magic = "# stickslip",
    .has_header = 1,
    .open = open_text,
    .begin = begin_text,
    .number = format_number,
    .has_time = 1,
    .has_notes = 1,
    .separator = '\t',
};
