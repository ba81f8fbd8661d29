/* sweep.c -- write the rows of a sweep as text, and find where an interrupted sweep continues. */
#include <stickslip/sweep.h>

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/signal.h>
#include "base/error.h"
#include "stream/input.h"
#include "stream/rows.h"

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
    ss_status st = all == NULL ? SS_ENOMEM : ss_scene_write(sweep->scene, all);
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
write_options(struct rows *rows, const ss_steady_opts *s, ss_model model)
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
    ss_rows_note(rows, "method: %s", s->method != NULL ? s->method
                 : ss_model_is_linear(model) ? "exact" : "taylor, bsimp where stiff");
}

static ss_status
write_columns(struct rows *rows, const ss_sweep_text *sweep)
{
    ss_scene scene = *sweep->scene;
    ss_rows_column(rows, "index", "");
    for (size_t i = 0; i < sweep->opts->n_axes; i++) {
        const char *key = sweep->opts->axis[i].key, *unit;
        if (ss_scene_number(&scene, key, &unit, NULL) == NULL)
            return SS_EINVAL;
        ss_rows_column(rows, key, unit);
    }
    for (size_t i = 0; i < sweep->n_measures; i++)
        ss_rows_column(rows, ss_measure_name(sweep->measure[i]), ss_measure_unit(sweep->measure[i]));
    ss_rows_column(rows, "status", "");
    ss_rows_end(rows);
    return SS_OK;
}

static int
is_complete(const ss_sweep_text *sweep)
{
    if (sweep == NULL || sweep->name == NULL || sweep->scene == NULL || sweep->opts == NULL
        || (sweep->opts->axis == NULL && sweep->opts->n_axes > 0)
        || (sweep->measure == NULL && sweep->n_measures > 0))
        return 0;
    for (size_t i = 0; i < sweep->n_measures; i++)
        if ((unsigned)sweep->measure[i] >= SS_MEASURES)
            return 0;
    return 1;
}

ss_status
ss_sweep_header(char **out, const ss_sweep_text *sweep)
{
    struct rows rows;
    size_t size;
    if (out == NULL || !is_complete(sweep))
        return SS_EINVAL;
    *out = NULL;
    FILE *text = open_memstream(out, &size);
    if (text == NULL)
        return SS_ENOMEM;
    ss_status st = ss_rows_begin(&rows, text, sweep->format, SS_KIND_SWEEP);
    if (st == SS_OK) {
        ss_rows_note(&rows, "scene: %s", sweep->name);
        st = write_scene(&rows, sweep);
    }
    if (st == SS_OK) {
        for (size_t i = 0; i < sweep->opts->n_axes; i++)
            write_axis(&rows, &sweep->opts->axis[i]);
        write_options(&rows, &sweep->opts->steady, sweep->scene->model);
        st = write_columns(&rows, sweep);
    }
    int whole = !ferror(text);
    if (fclose(text) != 0 || !whole)
        st = st != SS_OK ? st : SS_ENOMEM;
    if (st != SS_OK) {
        free(*out);
        *out = NULL;
    }
    return st;
}

/* Write a row.  strobe is the start of its cycle; NULL: that of the first cycle. */
static void
write_row(struct rows *rows, const ss_sweep_text *sweep, const ss_sweep_row *row, const ss_strobe *strobe)
{
    ss_rows_count(rows, row->index);
    for (size_t i = 0; i < sweep->opts->n_axes; i++)
        ss_rows_number(rows, row->vary[i]);
    for (size_t i = 0; i < sweep->n_measures; i++) {
        ss_measure m = sweep->measure[i];
        double value = row->steady.value[m];
        if (strobe != NULL && (m == SS_X_PHASE || m == SS_V_PHASE))
            value = m == SS_X_PHASE ? strobe->x : strobe->v;
        if (m == SS_PERIOD && value == 0)
            ss_rows_word(rows, "aperiodic");
        else
            ss_rows_number(rows, value);
    }
    ss_rows_word(rows, row->reason);
    ss_rows_end(rows);
}

ss_status
ss_sweep_row_write(const ss_sweep_text *sweep, const ss_sweep_row *row, FILE *out)
{
    if (!is_complete(sweep) || row == NULL || out == NULL || ss_format_table(sweep->format) == NULL
        || ss_format_table(sweep->format)->separator == '\0')
        return SS_EINVAL;
    struct rows rows = { .out = out, .format = ss_format_table(sweep->format) };
    size_t n = sweep->opts->steady.strobe > 0 ? row->steady.n_strobes : 0;
    if (n == 0)
        write_row(&rows, sweep, row, NULL);
    for (size_t i = 0; i < n; i++)
        write_row(&rows, sweep, row, &row->steady.strobe[i]);
    return ferror(out) ? SS_EIO : SS_OK;
}

/* --- going on ------------------------------------------------------------------------------ */

/* Read the next line, as much of it as there is room for, without its end.  Returns the length of the
 * whole line in the file, or 0 if the file ends within it. */
static long
read_line(FILE *in, char *line, size_t room)
{
    long length = 0;
    size_t n = 0;
    int c;
    while ((c = getc(in)) != EOF && c != '\n') {
        length++;
        if (n + 1 < room)
            line[n++] = (char)c;
    }
    line[n] = '\0';
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

/* Count the whole rows, which must be in the order of the points.  The last point is left out if it may
 * have several rows, as some of them may be missing. */
static ss_status
count_rows(const ss_sweep_text *sweep, FILE *in, const char *name, size_t *rows, long *end,
           ss_error *err)
{
    const ss_sweep_opts *opts = sweep->opts;
    char line[64], *behind, separator = ss_format_table(sweep->format)->separator;
    size_t points = 0;
    long at = *end;
    for (long n; (n = read_line(in, line, sizeof line)) > 0; at += n) {
        size_t due = opts->shard + points * opts->shards, index = strtoul(line, &behind, 10);
        if (opts->steady.strobe > 0 && points > 0 && index == due - opts->shards)
            continue;
        if (behind == line || *behind != separator || index != due)
            return ss_fail(err, SS_EDATA, "%s: row %zu is '%.*s', but point %zu is due: another sweep "
                           "or shard", name, points + 1,
                           (int)strcspn(line, (char[]){ separator, '\0' }), line, due);
        *rows = points++;
        *end = at;
    }
    if (opts->steady.strobe == 0) {
        *rows = points;
        *end = at;
    }
    return SS_OK;
}

ss_status
ss_sweep_resume(const ss_sweep_text *sweep, FILE *in, const char *name, size_t *rows, long *end,
                ss_error *err)
{
    char *header = NULL;
    size_t got = 0;
    if (sweep == NULL || in == NULL || name == NULL || rows == NULL || end == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_sweep_header(&header, sweep);
    if (st != SS_OK)
        return ss_fail(err, st, "%s: %s", name, ss_strerror(st));
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
        st = count_rows(sweep, in, name, rows, end, err);
    }
    if (st == SS_OK && ferror(in))
        st = ss_fail_errno(err, name, errno);
    free(start);
    free(header);
    return st;
}
