/* write.c -- write the rows of a sweep as text, and find where an interrupted sweep continues. */
#include <stickslip/sweep.h>

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/error.h"
#include "io/input.h"
#include "io/record.h"
#include "motion/method.h"
#include "scene/key.h"
#include "study/sweep/grid.h"

/* Write what the rows have in common: the keys of the motion that are not varied, the axes, and the options. */
static ss_status
write_notes(struct rows *rows, const ss_sweep_text *sweep)
{
    static const char *const search[] = { "simulation, then shooting", "simulation", "shooting" };
    const ss_axis *axes = sweep->opts->axis, *end = axes + sweep->opts->n_axes;
    const ss_steady_opts *s = sweep->opts->steady;
    ss_status st = ss_scene_check(sweep->scene, NULL);
    const scene_key *k;
    char room[SS_NUMBER_MAX], to[SS_NUMBER_MAX];
    ss_rows_note(rows, "scene: %s", sweep->name);
    for (size_t i = 0; st == SS_OK && (k = ss_key_next(sweep->scene, &i)) != NULL;) {
        const ss_axis *a = axes;
        while (a < end && strcmp(k->name, a->key) != 0)
            a++;
        if (a == end && !ss_key_is_of_record(k->name))
            ss_rows_note(rows, "%s: %s", k->name, ss_value_text(sweep->scene, k, room));
    }
    for (const ss_axis *a = axes; a < end; a++)
        ss_rows_note(rows, "vary: %s=%s:%s:%zu%s", a->key, ss_number_text(room, a->from), ss_number_text(to, a->to),
                     a->n, a->log ? ":log" : "");
    ss_rows_note(rows, "tolerance: %s", ss_number_text(room, s->tol));
    if (s->settle > 0)
        ss_rows_note(rows, "settle_cycles: %lu", s->settle);
    else
        ss_rows_note(rows, "max_cycles: %lu", s->max_cycles);
    ss_rows_note(rows, "max_period: %d", s->max_period);
    if (s->strobe > 0)
        ss_rows_note(rows, "strobe: %d", s->strobe);
    ss_rows_note(rows, "max_steps: %lu", s->max_steps);
    ss_rows_note(rows, "search: %s", (unsigned)s->search < 3 ? search[s->search] : "");
    ss_rows_note(rows, "method: %s", s->method != NULL ? s->method : ss_method_best_names(sweep->scene));
    return st;
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
            ss_rows_number(rows, ss_measure_label(m)->name, ss_measure_label(m)->unit, isinf(value) ? NAN : value);
    }
    ss_rows_word(rows, "status", row->reason);
    ss_rows_end(rows);
}

typedef struct writing {
    ss_sweep_text text;         /* with options as the library takes them */
    ss_measure measure[SS_MEASURES];    /* of the text, if it names none */
    ss_sweep_opts opts;
    ss_steady_opts steady;
    FILE *out;
    const char *name;           /* of a file that is gone on with, or NULL */
    ss_sweep_done *done;
    ss_status status;
    ss_error *err;
} writing;

/* Choose the measures of a text that names none: of the usual ones those that the model has. */
static void
take_usual(writing *own)
{
    static const ss_measure usual[] = { SS_STOPS, SS_STICK_FRACTION, SS_AMPLITUDE, SS_V_MAX, SS_A_MAX, SS_ENERGY,
                                        SS_PERIOD };
    ss_steady_opts has;
    ss_steady_opts_init(&has, sizeof has);
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++) {
        has.measures = 1u << usual[i];
        if (ss_steady_check(&has, own->text.scene, NULL) == SS_OK)
            own->measure[own->text.n_measures++] = usual[i];
    }
    own->text.measure = own->measure;
}

/* SS_EINVAL: something is missing. */
static ss_status
take(writing *own, const ss_sweep_text *given, ss_error *err)
{
    if (given == NULL || given->name == NULL || given->scene == NULL
        || (given->measure == NULL && given->n_measures > 0))
        return SS_FAIL_NULL(err);
    own->text = *given;
    own->text.opts = &own->opts;
    ss_status st = ss_sweep_opts_take(&own->opts, &own->steady, given->opts, err);
    if (given->n_measures == 0)
        take_usual(own);
    for (size_t i = 0; st == SS_OK && i < own->text.n_measures; i++)
        if ((unsigned)own->text.measure[i] >= SS_MEASURES)
            st = ss_fail(err, SS_EINVAL, "no measure %d", own->text.measure[i]);
        else
            own->steady.measures |= 1u << own->text.measure[i];
    for (size_t i = 0; st == SS_OK && i < own->opts.n_axes; i++)
        if (ss_scene_unit(given->scene, own->opts.axis[i].key) == NULL)
            st = ss_fail(err, SS_EINVAL, "the scene has no number '%s'", own->opts.axis[i].key);
    const struct format *table = ss_format_table(given->format);
    if (st == SS_OK && (table == NULL || table->separator == '\0'))
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
        st = write_notes(&rows, sweep);
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

/* --- going on ------------------------------------------------------------------------------ */

/* Is a line the row of this point?  It is written anew from its numbers, and must be the same up to the status,
 * which is the last cell.  SS_EDATA: it is not. */
static ss_status
check_row(const ss_sweep_text *sweep, size_t index, const char *line, double value[])
{
    const struct format *format = ss_format_table(sweep->format);
    ss_sweep_row row = { .index = index, .vary = value, .reason = "?" };
    const char *cell = line;
    char *text = NULL, *end;
    size_t length = 0, unknown = 0;
    ss_sweep_values(sweep->opts, index, value);
    for (size_t i = 0; i < 1 + sweep->opts->n_axes + sweep->n_measures; i++) {
        if (i > sweep->opts->n_axes) {
            ss_measure m = sweep->measure[i - 1 - sweep->opts->n_axes];
            double x = ss_number_parse(cell, &end);
            int aperiodic = m == SS_PERIOD && strncmp(cell, "aperiodic", 9) == 0;
            row.steady.value[m] = aperiodic ? 0 : end > cell && isfinite(x) ? x : NAN;
            unknown += m != SS_LYAPUNOV && isnan(row.steady.value[m]);
        }
        if ((cell = strchr(cell, format->separator)) == NULL)
            return SS_EDATA;
        cell++;
    }
    FILE *out = open_memstream(&text, &length);
    struct rows rows = { .out = out, .format = format };
    if (out == NULL)
        return SS_ENOMEM;
    write_row(&rows, sweep, &row, NULL);
    int whole = fclose(out) == 0, same = whole && strncmp(line, text, length - strlen("?\n")) == 0
        && line[length - strlen("?\n")] != '\0';
    free(text);
    return !whole ? SS_ENOMEM : same && (cell[0] == '"' || strchr(cell, format->separator) == NULL)
        && (unknown == 0 || strcmp(cell, "ok") != 0) && strlen(cell) < 2 * sizeof (ss_error) ? SS_OK : SS_EDATA;
}

/* Count the whole rows behind the header, which must be those of the points in their order.  The last point is
 * left out if it may have several rows, as some of them may be missing. */
static ss_status
count_rows(const ss_sweep_text *sweep, FILE *in, const char *name, size_t number, size_t *rows, long *end,
           ss_error *err)
{
    const ss_sweep_opts *opts = sweep->opts;
    size_t points = 0, all, room = 0;
    long at = *end;
    char *line = NULL;
    double *value = malloc((opts->n_axes + 1) * sizeof *value);
    ss_status st = value != NULL ? ss_sweep_points(opts, &all, err) : ss_fail_memory(err, NULL);
    for (ssize_t n; st == SS_OK && (n = getline(&line, &room, in)) > 0 && line[n - 1] == '\n'; at += n) {
        size_t due = opts->shard + points * opts->shards;
        int again = opts->steady->strobe > 0 && points > 0 && strtoul(line, NULL, 10) == due - opts->shards;
        line[n - 1] = '\0';
        number++;
        st = strlen(line) + 1 != (size_t)n || (!again && due >= all) ? SS_EDATA
            : check_row(sweep, again ? due - opts->shards : due, line, value);
        if (st != SS_OK) {
            st = st == SS_ENOMEM ? ss_fail_memory(err, NULL)
                : ss_fail(err, SS_EDATA, "%s:%zu: not the row of this sweep's point %zu, which is due", name,
                          number, due);
        } else if (!again) {
            *rows = points++;
            *end = at;
        }
    }
    free(value);
    free(line);
    if (st == SS_OK && opts->steady->strobe == 0) {
        *rows = points;
        *end = at;
    }
    return st;
}

/* Find how far a file of this sweep goes: *rows whole rows, and *end, the byte behind them. */
static ss_status
find_end(const ss_sweep_text *sweep, FILE *in, const char *name, const char *header, size_t *rows, long *end,
         ss_error *err)
{
    size_t at = 0, lines = 0;
    const char *line = header;
    ss_status st = SS_OK;
    for (int c; st == SS_OK && header[at] != '\0' && (c = getc(in)) != EOF; at++) {
        if (c != (unsigned char)header[at])
            st = ss_fail(err, SS_EDATA, "%s:%zu: another sweep than this one, which has '%.*s'", name, lines + 1,
                         (int)strcspn(line, "\n"), line);
        lines += c == '\n';
        line = c == '\n' ? header + at + 1 : line;
    }
    if (st == SS_OK && header[at] == '\0') {
        *end = (long)at;
        st = count_rows(sweep, in, name, lines, rows, end, err);
    }
    return st == SS_OK && ferror(in) ? ss_fail_errno(err, name, errno) : st;
}

/* --- the whole ----------------------------------------------------------------------------- */

/* Rows of a file that is gone on with must outlive a kill. */
static int
take_point(const ss_sweep_row *row, void *user)
{
    writing *w = user;
    struct rows rows = { .out = w->out, .format = ss_format_table(w->text.format) };
    size_t n = w->steady.strobe > 0 ? row->steady.n_strobes : 0;
    for (size_t i = 0; i < (n > 0 ? n : 1); i++)
        write_row(&rows, &w->text, row, n > 0 ? &row->steady.strobe[i] : NULL);
    w->done->rows++;
    w->done->failed += row->status != SS_OK;
    if (ferror(w->out) || (w->name != NULL && fflush(w->out) != 0))
        w->status = ss_fail_errno(w->err, "write error", errno);
    return w->status != SS_OK;
}

ss_status
ss_sweep_write(const ss_sweep_text *given, FILE *out, const char *resumed, ss_sweep_done *done, ss_error *err)
{
    char *header = NULL;
    long end = 0;
    writing w = { .out = out, .name = resumed, .done = done, .status = SS_OK, .err = err };
    if (out == NULL || done == NULL)
        return SS_FAIL_NULL(err);
    *done = (ss_sweep_done){ 0, 0, 0 };
    ss_status st = take(&w, given, err);
    if (st == SS_OK)
        st = make_header(&header, &w.text, err);
    if (st == SS_OK && resumed != NULL && !ss_format_table(w.text.format)->has_notes)
        st = ss_fail(err, SS_EINVAL, "%s: this format has no notes, which say of what sweep it is", resumed);
    else if (st == SS_OK && resumed != NULL)
        st = find_end(&w.text, out, resumed, header, &done->kept, &end, err);
    /* the file is gone on with there, and ends there */
    if (st == SS_OK && resumed != NULL && (fseek(out, end, SEEK_SET) != 0 || ftruncate(fileno(out), end) != 0))
        st = ss_fail_errno(err, resumed, errno);
    if (st == SS_OK) {
        fputs(end == 0 ? header : "", out);
        w.opts.first = resumed != NULL ? done->kept : w.opts.first;
        w.opts.sink = take_point;
        w.opts.user = &w;
        st = ss_sweep_run(w.text.scene, &w.opts, err);
    }
    free(header);
    return w.status != SS_OK ? w.status : st;
}
