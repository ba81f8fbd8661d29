/* write.c -- write the rows of a sweep as text, and find where an interrupted sweep continues. */
#include <stickslip/sweep.h>

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/signal.h>
#include "base/error.h"
#include "io/input.h"
#include "io/record.h"
#include "motion/method.h"
#include "study/sweep/grid.h"

/* 1 if this key is varied, or is not about the motion but about its record. */
static int
is_left_out(const ss_sweep_opts *opts, const char *key)
{
    for (size_t i = 0; i < opts->n_axes; i++)
        if (strcmp(key, opts->axis[i].key) == 0)
            return 1;
    return strcmp(key, "settle") == 0 || strcmp(key, "duration") == 0 || strcmp(key, "rate") == 0;
}

/* Write the keys of the scene that are the same in all rows. */
static ss_status
write_scene(struct rows *rows, const ss_sweep_text *sweep)
{
    char *text = NULL;
    size_t size;
    FILE *all = open_memstream(&text, &size);
    ss_status st = all == NULL ? SS_ENOMEM : ss_scene_write(sweep->scene, all, NULL);
    if (all != NULL && fclose(all) != 0)
        st = SS_ENOMEM;
    for (char *line = text, *end; st == SS_OK && *line != '\0'; line = end + 1) {
        char *equals = strstr(line, " = ");
        end = strchr(line, '\n');
        *equals = *end = '\0';
        if (!is_left_out(sweep->opts, line))
            ss_rows_note(rows, "%s: %s", line, equals + 3);
    }
    free(text);
    return st;
}

static void
write_axis(struct rows *rows, const ss_axis *axis)
{
    char from[SS_NUMBER_MAX], to[SS_NUMBER_MAX];
    ss_rows_note(rows, "vary: %s=%s:%s:%zu%s", axis->key, ss_number_text(from, axis->from),
                 ss_number_text(to, axis->to), axis->n, axis->log ? ":log" : "");
}

static void
write_options(struct rows *rows, const ss_steady_opts *s, const ss_scene *scene)
{
    static const char *const search[] = { "simulation, then shooting", "simulation", "shooting" };
    char tol[SS_NUMBER_MAX];
    ss_rows_note(rows, "tolerance: %s", ss_number_text(tol, s->tol));
    if (s->settle > 0)
        ss_rows_note(rows, "settle_cycles: %lu", s->settle);
    else
        ss_rows_note(rows, "max_cycles: %lu", s->max_cycles);
    ss_rows_note(rows, "max_period: %d", s->max_period);
    if (s->strobe > 0)
        ss_rows_note(rows, "strobe: %d", s->strobe);
    ss_rows_note(rows, "max_steps: %lu", s->max_steps);
    ss_rows_note(rows, "search: %s", (unsigned)s->search < 3 ? search[s->search] : "");
    ss_rows_note(rows, "method: %s", s->method != NULL ? s->method : ss_method_best_names(scene));
}

/* Write a row.  strobe is the start of its cycle; NULL: that of the first cycle. */
static void
write_row(struct rows *rows, const ss_sweep_text *sweep, const ss_sweep_row *row, const ss_strobe *strobe)
{
    ss_rows_count(rows, "index", row->index);
    for (size_t i = 0; i < sweep->opts->n_axes; i++) {
        const char *key = sweep->opts->axis[i].key, *unit = ss_scene_unit(sweep->scene, key);
        ss_rows_number(rows, key, unit, row->vary != NULL ? row->vary[i] : NAN);
    }
    for (size_t i = 0; i < sweep->n_measures; i++) {
        ss_measure m = sweep->measure[i];
        double value = row->steady.value[m];
        if (strobe != NULL && (m == SS_X_PHASE || m == SS_V_PHASE))
            value = m == SS_X_PHASE ? strobe->x : strobe->v;
        if (m == SS_PERIOD && value == 0)
            ss_rows_word(rows, ss_measure_label(m)->name, "aperiodic");
        else
            ss_rows_number(rows, ss_measure_label(m)->name, ss_measure_label(m)->unit, value);
    }
    ss_rows_word(rows, "status", row->reason);
    ss_rows_end(rows);
}

/* A text with options as the library takes them. */
typedef struct own_text {
    ss_sweep_text text;
    ss_sweep_opts opts;
    ss_steady_opts steady;
} own_text;

/* SS_EINVAL: something is missing. */
static ss_status
take(own_text *own, const ss_sweep_text *given, ss_error *err)
{
    if (given == NULL || given->name == NULL || given->scene == NULL
        || (given->measure == NULL && given->n_measures > 0))
        return SS_FAIL_NULL(err);
    own->text = *given;
    own->text.opts = &own->opts;
    ss_status st = ss_sweep_opts_take(&own->opts, &own->steady, given->opts, err);
    for (size_t i = 0; st == SS_OK && i < given->n_measures; i++)
        if ((unsigned)given->measure[i] >= SS_MEASURES)
            st = ss_fail(err, SS_EINVAL, "no measure %d", given->measure[i]);
    for (size_t i = 0; st == SS_OK && i < own->opts.n_axes; i++)
        if (ss_scene_unit(given->scene, own->opts.axis[i].key) == NULL)
            st = ss_fail(err, SS_EINVAL, "the scene has no number '%s'", own->opts.axis[i].key);
    if (st == SS_OK && !ss_format_has_words(given->format))
        st = ss_fail(err, SS_EINVAL, "this format holds numbers only");
    return st;
}

static ss_status
make_header(char **out, const ss_sweep_text *sweep, ss_error *err)
{
    struct rows rows;
    size_t size;
    *out = NULL;
    FILE *text = open_memstream(out, &size);
    if (text == NULL)
        return ss_fail_memory(err, NULL);
    ss_status st = ss_rows_begin(&rows, text, sweep->format, SS_KIND_SWEEP, err);
    if (st == SS_OK) {
        ss_rows_note(&rows, "scene: %s", sweep->name);
        st = write_scene(&rows, sweep);
        for (size_t i = 0; i < sweep->opts->n_axes; i++)
            write_axis(&rows, &sweep->opts->axis[i]);
        write_options(&rows, sweep->opts->steady, sweep->scene);
        write_row(&rows, sweep, &(ss_sweep_row){ .index = 0 }, NULL);           /* the names */
    }
    int whole = !ferror(text);
    if (fclose(text) != 0 || !whole)
        st = st != SS_OK ? st : SS_ENOMEM;
    if (st == SS_OK)
        return SS_OK;
    free(*out);
    *out = NULL;
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

ss_status
ss_sweep_header(char **out, const ss_sweep_text *given, ss_error *err)
{
    own_text own;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = take(&own, given, err);
    return st == SS_OK ? make_header(out, &own.text, err) : st;
}

ss_status
ss_sweep_row_write(const ss_sweep_text *given, const ss_sweep_row *row, FILE *out, ss_error *err)
{
    own_text own;
    if (row == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = take(&own, given, err);
    if (st != SS_OK)
        return st;
    struct rows rows = { .out = out, .format = ss_format_table(given->format) };
    size_t n = own.steady.strobe > 0 ? row->steady.n_strobes : 0;
    if (n == 0)
        write_row(&rows, &own.text, row, NULL);
    for (size_t i = 0; i < n; i++)
        write_row(&rows, &own.text, row, &row->steady.strobe[i]);
    return ferror(out) ? ss_fail(err, SS_EIO, "%s", ss_strerror(SS_EIO)) : SS_OK;
}

/* --- going on ------------------------------------------------------------------------------ */

enum { LONGEST_ROW = 8192 };        /* of some 60 numbers and a reason */

/* Read the next line without its end, cut off if it is too long.  Returns the length of the whole line in the
 * file, or 0 if the file ends within it. */
static long
read_line(FILE *in, char line[LONGEST_ROW])
{
    long length = 0;
    int c;
    for (; (c = getc(in)) != EOF && c != '\n'; length++)
        if (length + 1 < LONGEST_ROW)
            line[length] = (char)c;
    line[length < LONGEST_ROW ? length : LONGEST_ROW - 1] = '\0';
    return c == '\n' ? length + 1 : 0;
}

/* 1 if the file begins with this header, or is itself only a beginning of it.  *got becomes the number of
 * bytes that were read. */
static int
has_header(FILE *in, const char *header, char *start, size_t *got)
{
    *got = fread(start, 1, strlen(header), in);
    return memcmp(start, header, *got) == 0;
}

/* Cut the next cell off a line, which begins behind it afterwards; NULL: it is the last. */
static char *
next_cell(char **line, char separator)
{
    char *cell = *line, *end = strchr(cell, separator);
    if (end == NULL)
        return NULL;
    *end = '\0';
    *line = end + 1;
    return cell;
}

static int
is_number(const char *cell, double *x)
{
    char *end;
    *x = ss_number_parse(cell, &end);
    return end > cell && *end == '\0' && isfinite(*x);
}

/* The value of an axis at this point of the grid, whose last axis varies fastest. */
static double
value_at(const ss_sweep_opts *opts, size_t axis, size_t index)
{
    for (size_t i = opts->n_axes - 1; i > axis; i--)
        index /= opts->axis[i].n;
    return ss_axis_value(&opts->axis[axis], index % opts->axis[axis].n);
}

/* What is wrong with the cells behind the index of a row, or NULL: they are what a row of this point may have.
 * *name becomes the column of the wrong one. */
static const char *
wrong_cell(const ss_sweep_text *sweep, char *line, size_t index, const char **name)
{
    const struct format *format = ss_format_table(sweep->format);
    const char *unknown = format->has_notes ? "-" : "", *cell;
    double x;
    int unknowns = 0;
    for (size_t i = 0; i < sweep->opts->n_axes; i++) {
        double wanted = value_at(sweep->opts, i, index);
        *name = sweep->opts->axis[i].key;
        if ((cell = next_cell(&line, format->separator)) == NULL)
            return "is missing";
        if (!is_number(cell, &x) || !(fabs(x - wanted) <= 1e-14 * fabs(wanted)))    /* pow differs */
            return "is not the grid's";
    }
    for (size_t i = 0; i < sweep->n_measures; i++) {
        *name = ss_measure_label(sweep->measure[i])->name;
        if ((cell = next_cell(&line, format->separator)) == NULL)
            return "is missing";
        unknowns += strcmp(cell, unknown) == 0;
        if (!is_number(cell, &x) && strcmp(cell, unknown) != 0
            && (sweep->measure[i] != SS_PERIOD || strcmp(cell, "aperiodic") != 0))
            return "is not a number";
    }
    *name = "status";
    if (line[0] == '\0' || (line[0] != '"' && strchr(line, format->separator) != NULL))
        return line[0] == '\0' ? "is missing" : "is not the last";
    return unknowns > 0 && strcmp(line, "ok") == 0 ? "is ok, but a measure is not known" : NULL;
}

static size_t
count_lines(const char *text)
{
    size_t n = 0;
    for (; *text != '\0'; text++)
        n += *text == '\n';
    return n;
}

/* Count the whole rows, which must be those of the points in their order.  The last point is left out if it may
 * have several rows, as some of them may be missing, or if the format has no notes, so that only its numbers tell
 * whether it is of this sweep. */
static ss_status
count_rows(const ss_sweep_text *sweep, FILE *in, const char *name, size_t header_lines, size_t *rows, long *end,
           ss_error *err)
{
    const ss_sweep_opts *opts = sweep->opts;
    const struct format *format = ss_format_table(sweep->format);
    char line[LONGEST_ROW], *behind;
    int leaves_last = opts->steady->strobe > 0 || !format->has_notes;
    size_t points = 0, all, number = header_lines + 1;
    long at = *end;
    ss_status st = ss_sweep_points(opts, &all, err);
    for (long n; st == SS_OK && (n = read_line(in, line)) > 0; at += n, number++) {
        size_t due = opts->shard + points * opts->shards, index = strtoul(line, &behind, 10);
        const char *wrong, *column = "index";
        int again = opts->steady->strobe > 0 && points > 0 && index == due - opts->shards;
        if ((size_t)n != strlen(line) + 1)
            return ss_fail(err, SS_EDATA, "%s:%zu: a NUL byte, or longer than a row", name, number);
        if (line[0] < '0' || line[0] > '9' || (*behind != format->separator && *behind != '\0')
            || (index != due && !again) || index >= all)
            return ss_fail(err, SS_EDATA, "%s:%zu: the row of '%.*s', but point %zu is due: another sweep "
                           "or shard", name, number, (int)strcspn(line, (char[]){ format->separator, '\0' }), line, due);
        if ((wrong = wrong_cell(sweep, behind + (*behind != '\0'), index, &column)) != NULL)
            return ss_fail(err, SS_EDATA, "%s:%zu: not a row of this sweep: %s %s", name, number, column, wrong);
        if (again)
            continue;
        *rows = points++;
        *end = at;
    }
    if (st == SS_OK && !leaves_last) {
        *rows = points;
        *end = at;
    }
    return st;
}

ss_status
ss_sweep_resume(const ss_sweep_text *given, FILE *in, const char *name, size_t *rows, long *end,
                ss_error *err)
{
    char *header = NULL;
    size_t got = 0;
    own_text own;
    const ss_sweep_text *sweep = &own.text;
    if (in == NULL || name == NULL || rows == NULL || end == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = take(&own, given, err);
    if (st == SS_OK)
        st = make_header(&header, sweep, err);
    if (st != SS_OK)
        return st;
    size_t length = strlen(header);
    char *start = malloc(length + 1);
    *rows = 0;
    *end = 0;
    if (start == NULL)
        st = ss_fail_memory(err, NULL);
    else if (!has_header(in, header, start, &got))
        st = ss_fail(err, SS_EDATA, "%s: another sweep than this: its header differs", name);
    else if (got == length) {
        *end = (long)length;
        st = count_rows(sweep, in, name, count_lines(header), rows, end, err);
    }
    if (st == SS_OK && ferror(in))
        st = ss_fail_errno(err, name, errno);
    free(start);
    free(header);
    return st;
}
