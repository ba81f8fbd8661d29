/* stream.c -- the features of a signal without end, row by row.
 *
 * The last 64 periods of the lowest frequency are kept and searched again and again, as a recording of their own.
 * A transition is written when its end lies farther back than a wavelet of that frequency reaches, when the search
 * before found it at the same samples, so that later ones no longer change it, and when it is behind all that were
 * written.  The first search comes after 16 periods, as less shows nothing that recurs.  The numbers of all are
 * means over windows that do not overlap, weighted with their errors. */
#include <stickslip/features.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/columns.h"
#include "base/options.h"
#include "find/write.h"

enum { PERIODS = 64, FIRST = 16 };      /* in the window, and before rows: some transitions show what recurs */
#define LATE 0.18               /* [s] after two periods a row is written at the latest, but for the work */
#define SAME 2.                 /* samples between times that are the same */
#define HOP 0.06                /* [s] between searches, or a quarter of a period */

struct mean {
    double weight, value, squares;      /* squares: weighted, about the value (West 1979) */
    size_t n;
};

struct ss_features_stream {
    ss_header *head;
    size_t column;
    ss_features_opts opts;
    struct rows rows;
    ss_format format;
    unsigned has;               /* of what numbers need; 0 before the first row */
    int begun;
    double **x;                 /* the last samples of each column, n of them, in room for twice as many */
    size_t n, window, hop, behind;      /* [samples] */
    uint64_t seen;              /* samples so far */
    double written;             /* [s] the end of the last transition, on the source's clock */
    double (*before)[2];        /* onset and end of those that the last search found */
    size_t n_before;
    size_t transitions, windows;
    struct mean mean[SS_FEATURE_NUMBERS];
    ss_number last[SS_FEATURE_NUMBERS];
};

ss_status
ss_features_stream_new(ss_features_stream **out, const ss_header *head, size_t column, const ss_features_opts *opts,
                       FILE *to, ss_format format, ss_error *err)
{
    ss_features_opts usual;
    if (out == NULL || head == NULL || to == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    if (column >= head->n_columns)
        return ss_fail_column(err, column, head->n_columns);
    ss_features_opts_init(&usual, sizeof usual);
    ss_features_stream *s = calloc(1, sizeof *s);
    ss_status st = s != NULL ? ss_options_take(&s->opts, sizeof s->opts, &usual, opts, err) : ss_fail_memory(err, NULL);
    double period = st == SS_OK ? head->rate / s->opts.fmin : 0, room = 2 * (PERIODS + 4) * (period + head->rate);
    if (st == SS_OK && !(s->opts.fmin > 0 && period > 2 && room < 1e9))
        st = ss_fail(err, SS_EINVAL, "a stream of features needs fmin, below half the rate and not far below it");
    if (st == SS_OK)
        st = ss_header_copy(&s->head, head, err);
    if (st == SS_OK)
        st = ss_rows_begin(&s->rows, to, format, SS_KIND_FEATURES, err);
    if (st == SS_OK) {
        s->column = column;
        s->written = -INFINITY;
        s->hop = (size_t)ceil(fmax(HOP * head->rate, period / 4));
        s->behind = (size_t)ceil(2 * period + LATE * head->rate) - 2 * s->hop;
        s->window = s->hop * (size_t)ceil(PERIODS * period / (double)s->hop);
        s->x = ss_columns_new(head->n_columns, 2 * s->window);
        if (s->x == NULL)
            st = ss_fail_memory(err, NULL);
    }
    if (st == SS_OK)
        *out = s;
    else
        ss_features_stream_free(s);
    return st;
}

void
ss_features_stream_free(ss_features_stream *s)
{
    if (s == NULL)
        return;
    ss_header_free(s->head);
    free(s->x);
    free(s->before);
    free(s);
}

/* Add the numbers of a window to the means. */
static void
add_numbers(ss_features_stream *s, const ss_features *f)
{
    s->windows++;
    for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++) {
        const ss_number *x = &s->last[k];
        struct mean *m = &s->mean[k];
        s->last[k] = f->number[k];
        if (!(isfinite(x->value) && x->error > 0))
            continue;
        double w = 1 / (x->error * x->error), off = x->value - m->value;
        m->n++;
        m->weight += w;
        m->value += off * w / m->weight;
        m->squares += w * off * (x->value - m->value);
    }
}

/* Did the last search find this transition? */
static int
was_found(const ss_features_stream *s, double onset, double end)
{
    double most = SAME / s->head->rate;
    for (size_t i = 0; i < s->n_before; i++)
        if (fabs(s->before[i][0] - onset) <= most && fabs(s->before[i][1] - end) <= most)
            return 1;
    return 0;
}

/* Keep the transitions for the next search. */
static ss_status
keep(ss_features_stream *s, const ss_features *f, double start, ss_error *err)
{
    void *more = realloc(s->before, (f->n + 1) * sizeof *s->before);
    if (more == NULL)
        return ss_fail_memory(err, NULL);
    s->before = more;
    s->n_before = f->n;
    for (size_t i = 0; i < f->n; i++) {
        s->before[i][0] = start + f->transition[i].onset;
        s->before[i][1] = start + f->transition[i].end;
    }
    return SS_OK;
}

/* Write the names, and the rows up to a time [s] on the source's clock. */
static void
write_rows(ss_features_stream *s, const ss_features *f, double start, double until)
{
    for (size_t i = 0; i < f->n; i++) {
        double onset = start + f->transition[i].onset, end = start + f->transition[i].end;
        if (!(onset > s->written + SAME / s->head->rate && end <= until
              && (until == INFINITY || was_found(s, onset, end))))
            continue;
        if (!(f->transition[i].end > f->transition[i].onset) && f->transition[i].spikes == 0)
            continue;                           /* a maximum whose extent is not known yet */
        if (!s->begun) {
            s->has = ss_features_have(f, &s->opts);
            ss_features_notes(&s->rows, s->head, s->column, &s->opts);
            ss_features_row(&s->rows, f, f->n, 0, s->has);      /* the names */
        }
        s->begun = 1;
        ss_features_row(&s->rows, f, i, start, s->has);
        s->written = end;
        s->transitions++;
    }
}

/* Search the window. */
static ss_status
search_window(ss_features_stream *s, int last, ss_error *err)
{
    ss_signal *now = NULL;
    ss_features *f = NULL;
    size_t n = s->n < s->window ? s->n : s->window;
    ss_status st = ss_signal_new(&now, s->head, n, err);
    if (st != SS_OK)
        return st;
    now->head->start += (double)(s->seen - n) / s->head->rate;
    for (size_t c = 0; c < s->head->n_columns; c++)
        memcpy(now->values + c * n, s->x[c] + s->n - n, n * sizeof *now->values);
    st = ss_features_find(&f, now, s->column, &s->opts, err);
    double end = now->head->start + (double)n / s->head->rate;
    if (st == SS_OK) {
        write_rows(s, f, now->head->start, last ? INFINITY : end - (double)s->behind / s->head->rate);
        if (s->seen % s->window == 0 || (last && s->windows == 0))
            add_numbers(s, f);
        if (last && !s->begun) {
            s->has = ss_features_have(f, &s->opts);
            ss_features_notes(&s->rows, s->head, s->column, &s->opts);
            ss_features_row(&s->rows, f, f->n, 0, s->has);
        }
        st = keep(s, f, now->head->start, err);
        if (st == SS_OK)
            st = ss_rows_finish(&s->rows, err);
    } else if (st == SS_ESCALE && !last) {
        st = SS_OK;                             /* too short as yet */
    }
    ss_features_free(f);
    ss_signal_free(now);
    return st;
}

ss_status
ss_features_stream_push(ss_features_stream *s, double *const column[], size_t n, ss_error *err)
{
    if (s == NULL || (column == NULL && n > 0))
        return SS_FAIL_NULL(err);
    for (size_t i = 0; i < n; i++) {
        if (s->n == 2 * s->window) {
            s->n = s->window;
            for (size_t c = 0; c < s->head->n_columns; c++)
                memcpy(s->x[c], s->x[c] + s->window, s->window * sizeof *s->x[c]);
        }
        for (size_t c = 0; c < s->head->n_columns; c++)
            s->x[c][s->n] = column[c][i];
        s->n++;
        int due = ++s->seen % s->hop == 0 && s->seen >= s->window / PERIODS * FIRST;
        ss_status st = due ? search_window(s, 0, err) : SS_OK;
        if (st != SS_OK)
            return st;
    }
    return SS_OK;
}

ss_status
ss_features_stream_end(ss_features_stream *s, ss_error *err)
{
    ss_features all = { .n = 0 };
    if (s == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = search_window(s, 1, err);
    if (st != SS_OK)
        return st;
    for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++) {
        const struct mean *m = &s->mean[k];
        double spread = m->n > 1 ? m->squares / (double)(m->n - 1) : 1;
        all.number[k] = s->last[k];
        if (s->windows < 2)
            continue;
        all.number[k] = (ss_number){ .value = NAN, .error = NAN, .scatter = NAN, .why = s->last[k].why };
        if (k == SS_SLIPS)
            all.number[k].why = "a stream counts its transitions; slip_rate has the rest";
        else if (2 * m->n >= s->windows)
            all.number[k] = (ss_number){ .value = m->value, .error = sqrt(fmax(1, spread) / m->weight),
                                         .scatter = NAN };
    }
    all.number[SS_TRANSITIONS].value = (double)s->transitions;
    ss_features_numbers(&s->rows, &all, s->has);
    return ss_rows_finish(&s->rows, err);
}
