/* rank.c -- find the scene that explains a signal, among scenes that are forced and scenes that are pulled; and
 * the ranking as text.
 *
 * Scenes of one kind, forced or pulled, are ranked together (forced_rank.c, pull_rank.c).  If there are both, the
 * answer is that of the kind to which the signal belongs. */
#include <stickslip/rank.h>

#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/progress.h"
#include "fit/forced.h"
#include "fit/pulled.h"
#include "fit/verdict.h"
#include "io/record.h"

static int
report_part(double done, void *user)
{
    const ss_stretch *s = user;
    return ss_stretch_at(s, done) != SS_OK;
}

/* Rank the scenes of one kind; those of the other follow: they do not fit, and have no values. */
static ss_status
rank_kind(ss_ranking **out, int pulled, const ss_signal *signal, size_t column, const ss_scene *scene, size_t n,
          const ss_rank_opts *opts, ss_stretch part, ss_error *err)
{
    ss_rank_opts own = *opts;
    ss_ranking *r = *out = calloc(1, sizeof *r);
    if (r != NULL)
        r->row = calloc(n, sizeof *r->row);
    if (r == NULL || r->row == NULL)
        return ss_fail_memory(err, NULL);
    r->forcing_frequency = r->noise = NAN;
    for (size_t k = 0; k < SS_CRITERIA; k++)
        r->value[k] = NAN;
    for (size_t i = 0; i < n; i++)
        if (ss_scene_is_pulled(&scene[i]) == pulled)
            r->row[r->n++] = (ss_rank_row){ .scene = i, .total = NAN, .excess = NAN };
    for (size_t i = 0, last = r->n; i < n; i++)
        if (ss_scene_is_pulled(&scene[i]) != pulled) {
            ss_rank_row *to = &r->row[last++];
            *to = (ss_rank_row){ .scene = i, .adjusted = scene[i], .total = NAN, .excess = NAN };
            for (size_t k = 0; k < SS_CRITERIA; k++) {
                to->value[k] = NAN;
                to->distance[k] = INFINITY;
            }
        }
    own.progress = (ss_progress){ report_part, &part };
    ss_status st = (pulled ? ss_pull_compare : ss_forced_compare)(r, signal, column, scene, &own, err);
    r->n = n;
    return st;
}

/* The signal's kind is what is compared, then what is named, then what explains more. */
static int
is_pull(ss_ranking *const kind[2])
{
    if (kind[0] == NULL || !is_compared(kind[0]) || !is_compared(kind[1]))
        return kind[0] == NULL || is_compared(kind[1]);
    if ((kind[0]->verdict == SS_NAMED) != (kind[1]->verdict == SS_NAMED))
        return kind[1]->verdict == SS_NAMED;
    return kind[1]->row[0].explained > kind[0]->row[0].explained;
}

ss_status
ss_ranking_new(ss_ranking **out, const ss_signal *signal, size_t column, const ss_scene *scene, size_t n,
               const ss_rank_opts *given, ss_error *err)
{
    ss_rank_opts own;
    const ss_rank_opts *opts = &own;
    if (out == NULL || signal == NULL || scene == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_rank_opts_take(&own, given, err);
    if (st == SS_OK)
        st = ss_column_check(signal, column, opts, err);
    if (st == SS_OK && n == 0)
        return ss_fail(err, SS_EINVAL, "no scene to rank");
    if (st == SS_OK && !(opts->spread >= 0 && opts->spread < 1))
        return ss_fail(err, SS_EINVAL, "spread %g is out of range 0 ... 1", opts->spread);
    for (int q = 0; st == SS_OK && q < SS_QUANTITIES; q++)
        if (opts->also[q] >= 0)
            st = ss_column_check(signal, (size_t)opts->also[q], opts, err);
    size_t pulled = 0;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        pulled += (size_t)ss_scene_is_pulled(&scene[i]);
        st = (ss_scene_is_pulled(&scene[i]) ? ss_scene_check : ss_forced_check)(&scene[i], err);
    }
    const int has[2] = { pulled < n, pulled == n || (pulled > 0 && opts->quantity == SS_SPRING) };
    ss_ranking *kind[2] = { NULL, NULL };
    for (int k = 0; st == SS_OK && k < 2; k++) {
        const ss_stretch part = { opts->progress, has[1 - k] ? 0.5 * k : 0, has[1 - k] ? 0.5 * (1 + k) : 1 };
        if (has[k])
            st = rank_kind(&kind[k], k, signal, column, scene, n, opts, part, err);
    }
    if (st == SS_OK) {
        const int is = is_pull(kind), both = kind[0] != NULL && kind[1] != NULL;
        if (both && kind[0]->verdict == SS_NAMED && kind[1]->verdict == SS_NAMED) {
            kind[is]->verdict = SS_UNDECIDED;
            snprintf(kind[is]->why, sizeof kind[is]->why, "a pull and a forced motion explain the signal");
        }
        *out = kind[is];
        kind[is] = NULL;
    }
    ss_ranking_free(kind[0]);
    ss_ranking_free(kind[1]);
    return st;
}

void
ss_ranking_free(ss_ranking *ranking)
{
    if (ranking == NULL)
        return;
    free(ranking->row);
    free(ranking);
}

/* --- its text ------------------------------------------------------------------------------ */

enum { DIGITS = 4 };            /* more than a criterion deserves */

/* The answer as one text, to be freed; NULL: there is no memory. */
static char *
answer_of(const ss_ranking *r, const char *const *scene)
{
    const ss_rank_row *best = &r->row[0];       /* if none is named, the one that explains most */
    for (size_t i = 1; i < r->n; i++)
        if (r->verdict != SS_NAMED && r->row[i].explained > best->explained)
            best = &r->row[i];
    char part[SS_NUMBER_MAX], *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL)
        return NULL;
    if (r->verdict == SS_NAMED)
        fprintf(out, "%s explains ", scene[best->scene]);
    else
        fprintf(out, "%s: %s", r->verdict == SS_NONE_FITS ? "none of these" : "cannot tell", r->why);
    if (r->verdict != SS_NAMED && is_compared(r))
        fprintf(out, "; %s explains most, ", scene[best->scene]);
    if (is_compared(r)) {
        double left = fmax(1 - best->explained, 1e-9);          /* in per cent it has two digits: 99.98 */
        fprintf(out, "%s %%", ss_number_fixed(part, 100 * (1 - left), (int)fmax(ceil(-log10(left)) - 2, 0) + 1));
    }
    fputs(r->verdict == SS_NAMED ? " of the signal's power" : "", out);
    if (fclose(out) == 0)
        return text;
    free(text);
    return NULL;
}

/* Write "# key: name number, name number" for the criteria first ... last - 1. */
static void
write_criteria(FILE *out, const char *key, int first, int last, const ss_ranking *values)
{
    char text[SS_NUMBER_MAX];
    fprintf(out, "# %s:", key);
    for (int i = first; i < last; i++) {
        double x = values != NULL ? values->value[i] : ss_criterion_rules[i].threshold;
        fprintf(out, "%s %s %s", i > first ? "," : "", ss_criterion_rules[i].name,
                ss_number_rounded(text, x, DIGITS));
    }
    fputc('\n', out);
}

static void
write_notes(FILE *out, const ss_ranking *r, const ss_ranking_text *about, const ss_rank_opts *opts)
{
    char text[SS_NUMBER_MAX];
    fprintf(out, "# signal_name: %s\n", about->signal);
    fprintf(out, "# spread: %s\n", ss_number_rounded(text, 100 * opts->spread, DIGITS));
    fprintf(out, "# column: %s\n", about->column);
    fprintf(out, "# quantity: %s (%s)\n", ss_quantity_names[opts->quantity], about->known_by);
    fprintf(out, "# forcing_frequency: %s\n", ss_number_rounded(text, r->forcing_frequency, DIGITS));
    write_criteria(out, "thresholds", 0, SS_CRITERIA, NULL);
    write_criteria(out, "signal", SS_BY_MAXIMUM, SS_BY_MAP, r);
    fprintf(out, "# noise: %s %% of the power, at most\n", ss_number_rounded(text, 100 * r->noise, DIGITS));
}

/* The criterion of the largest score above 0, or a hyphen. */
static const char *
worst_of(const ss_rank_row *row)
{
    const char *name = "-";
    double most = 0;
    for (int k = 0; k < SS_CRITERIA; k++) {
        double score = ss_rank_score(row, (ss_criterion)k);
        if (score > most) {
            most = score;
            name = ss_criterion_rules[k].name;
        }
    }
    return name;
}

static void
write_row(struct rows *rows, const ss_ranking *r, size_t i, const ss_ranking_text *about, const char *answer)
{
    const ss_rank_row *row = &r->row[i];
    int compared = !isnan(row->total);
    ss_rows_number(rows, "rank", "", r->verdict == SS_NAMED && compared ? (double)(i + 1) : NAN);
    ss_rows_word(rows, "scene", about->scene[row->scene]);
    ss_rows_rounded(rows, "total", "", compared ? row->total : NAN, DIGITS);
    if (about->brief) {
        ss_rows_rounded(rows, "residual", "dB", compared ? row->value[SS_BY_RESIDUAL] : NAN, DIGITS);
        ss_rows_word(rows, "worst", compared ? worst_of(row) : "-");
    }
    for (int k = 0; k < SS_CRITERIA && !about->brief; k++) {
        const criterion_rule *rule = &ss_criterion_rules[k];
        char score[64];
        snprintf(score, sizeof score, "%s_score", rule->name);
        ss_rows_rounded(rows, rule->name, rule->unit, compared ? row->value[k] : NAN, DIGITS);
        ss_rows_rounded(rows, score, "", compared ? ss_rank_score(row, (ss_criterion)k) : NAN, DIGITS);
    }
    if (!rows->format->has_notes)
        ss_rows_whole_word(rows, "answer", answer);
    ss_rows_end(rows);
}

ss_status
ss_ranking_write(const ss_ranking *ranking, const ss_ranking_text *about, const ss_rank_opts *opts,
                 FILE *out, ss_format format, ss_error *err)
{
    struct rows rows;
    ss_rank_opts own;
    if (ranking == NULL || about == NULL || about->signal == NULL || about->column == NULL
        || about->known_by == NULL || about->scene == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_rank_opts_take(&own, opts, err);
    if (st == SS_OK && ranking->n == 0)
        st = ss_fail(err, SS_EINVAL, "no scene is ranked");
    if (st != SS_OK)
        return st;
    char *answer = answer_of(ranking, about->scene);
    if (answer == NULL)
        st = ss_fail_memory(err, NULL);
    if (st == SS_OK)
        st = ss_rows_begin(&rows, out, format, SS_KIND_RANKING, err);
    if (st == SS_OK) {
        int notes = rows.format->has_notes, all = notes && !about->brief;
        if (notes)
            ss_rows_whole_word(&rows, "answer", answer);
        if (all)
            write_notes(out, ranking, about, &own);
        for (size_t i = 0; i < ranking->n && notes && is_compared(ranking); i++)
            if (isnan(ranking->row[i].total))
                fprintf(out, "# does not fit: %s, which is %s\n", about->scene[ranking->row[i].scene],
                        ss_scene_is_pulled(&ranking->row[i].adjusted) ? "pulled" : "forced");
        write_row(&rows, ranking, 0, about, answer);       /* the names */
        for (size_t i = 0; i < ranking->n; i++)
            write_row(&rows, ranking, i, about, answer);
        st = ss_rows_finish(&rows, err);
    }
    free(answer);
    return st;
}
