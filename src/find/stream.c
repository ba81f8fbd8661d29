/* stream.c -- the features of a signal without end, row by row.
 *
 * The last 64 periods of the lowest frequency are kept.  Each such window is searched once, as a recording of its
 * own, for numbers and for what repeats.  Rows come from searches in between, which know what repeats.  They take a
 * part of the window only: as many periods as show LEAST transitions, which were as good as the whole window on
 * signals with noise, where 5 were not.  Where nothing happened, a part that shows a transition is a reason to
 * search the whole window.  Each transition is written by the first search that finds its end farther back than a
 * wavelet of the lowest frequency reaches, and its onset behind all that were written.  The first search comes after
 * 16 periods, as less shows nothing that recurs.
 *
 * The numbers of all are means over windows that do not overlap, weighted with their errors. */
#include <stickslip/features.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/list.h"
#include "base/options.h"
#include "find/numbers.h"

enum { PERIODS = 64, FIRST = 16, LEAST = 8 };   /* in a whole window, before rows; and in a part, as transitions are */
#define DELAY 0.18              /* [s] after two periods a row is written at the latest, but for the work */
#define BEHIND 1.25             /* periods behind the end of a transition after which it is known: a wavelet's reach */
#define SAME 2.                 /* samples between times that are the same */
enum { MANY = 16 };             /* windows are searched as they come, and of the others one in so many */

struct mean {
    double weight, value, squares;      /* squares: weighted, about the value (West 1979) */
    size_t n;
};

struct stream {
    const ss_header *head;
    size_t column;
    ss_features_opts opts;
    struct rows rows;
    unsigned has;               /* of what numbers need; 0 before the first row */
    int begun;
    double **x;                 /* the last samples of each column, n of them, in room for twice as many */
    size_t n, window, first, few, hop, behind;  /* [samples] */
    size_t part;                /* of the window, in which rows are searched */
    int is_still;               /* 1: the last whole window had no transition */
    int is_changed;             /* 1: a part since then was not as it taught */
    stream_lesson lesson;       /* of it */
    stream_part known;          /* to searches of a part */
    uint64_t seen, searched;    /* samples so far, and at the last search of a whole window */
    double written;             /* [s] the end of the last transition, on the source's clock */
    ss_features *before;        /* what the last search found, in a part from before_start [s] on */
    double before_start;
    size_t transitions, windows;
    struct mean mean[SS_FEATURE_NUMBERS];
    ss_number last[SS_FEATURE_NUMBERS];         /* of the last whole window */
    ss_number shown[SS_FEATURE_NUMBERS];        /* of the last search that found all */
};

/* Add the numbers of a window to the means. */
static void
add_numbers(struct stream *s, const ss_features *f)
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

/* Is it a lone maximum, whose extent is not known yet? */
static int
is_lone(const ss_transition *tr)
{
    return !(tr->end > tr->onset || tr->spikes > 0);
}

/* Is a transition new, and known up to a time [s] on the source's clock? */
static int
is_due(const struct stream *s, const ss_transition *tr, double start, double until)
{
    return start + tr->onset > s->written + SAME / s->head->rate && start + tr->end <= until;
}

/* How many of them are, lone maxima or others? */
static size_t
count_due(const struct stream *s, const ss_features *f, int lone, double start, double until)
{
    size_t n = 0;
    for (size_t i = 0; i < f->n; i++)
        n += is_lone(&f->transition[i]) == lone && is_due(s, &f->transition[i], start, until);
    return n;
}

/* Find the features of the last n samples, which begin at *start [s], in place of those that are there.  Give lone
 * maxima the extent and the ringing that the last search found there: a fit of few transitions leaves out now one,
 * now another. */
static ss_status
find_last(struct stream *s, size_t n, const stream_part *part, ss_features **f, double *start, ss_error *err)
{
    ss_signal *now = NULL;
    ss_status st = ss_signal_new(&now, s->head, n, err);
    ss_features_free(*f);
    *f = NULL;
    if (st != SS_OK)
        return st;
    *start = now->head->start += (double)(s->seen - n) / s->head->rate;
    for (size_t c = 0; c < s->head->n_columns; c++)
        memcpy(now->values + c * n, s->x[c] + s->n - n, n * sizeof *now->values);
    st = ss_features_of_part(f, now, s->column, &s->opts, part, err);
    ss_signal_free(now);
    const double off = s->before_start - *start, same = SAME / s->head->rate;
    for (size_t i = 0, k = 0; st == SS_OK && s->before != NULL && i < (*f)->n; i++) {
        const ss_transition *old = s->before->transition;
        ss_transition *tr = &(*f)->transition[i];
        while (k < s->before->n && old[k].end + off < tr->onset - same)
            k++;
        if (!is_lone(tr) || k == s->before->n || is_lone(&old[k]) || old[k].onset + off > tr->onset + same)
            continue;
        *tr = old[k];
        tr->onset += off, tr->end += off, tr->maximum.t += off;
    }
    return st;
}

/* Write the transitions that are known now, or all at the end. */
static ss_status
write_known(struct stream *s, int last, ss_error *err)
{
    ss_features *f = NULL;
    double start, until = last ? INFINITY
        : s->head->start + (double)(s->seen - s->behind) / s->head->rate;
    size_t all = s->n < s->window ? s->n : s->window;
    size_t apart = s->windows < MANY || s->is_changed || s->known.known == NULL ? s->window : MANY * s->window;
    int whole = last || s->seen - s->searched >= apart;
    size_t n = whole || s->part > all ? all : s->part;
    int finds_all = whole || s->known.period == 0;
    const stream_part afresh = { .learnt = whole ? &s->lesson : NULL };
    ss_status st = find_last(s, n, whole ? &afresh : &s->known, &f, &start, err);
    int is_new = st == SS_OK && f->n == 0;      /* what is known is not enough for the last n samples */
    for (size_t i = s->n - n; i < s->n; i++)
        is_new |= fabs(s->x[s->column][i]) > TWICE * s->lesson.largest;
    if (st == SS_OK && !whole && s->known.known != NULL && is_new) {
        stream_part part = s->known;
        part.known = NULL;
        s->is_changed = 1;
        st = find_last(s, n, &part, &f, &start, err);
    }
    if (st == SS_OK && n < all && count_due(s, f, 1, start, until) > 0)
        st = find_last(s, 2 * n < all ? 2 * n : all, &s->known, &f, &start, err);
    if (st == SS_OK && n < all && s->is_still && count_due(s, f, 0, start, until) > 0) {
        st = find_last(s, all, &afresh, &f, &start, err);
        finds_all = 1;
    }
    if (st == SS_ESCALE && !last)
        return SS_OK;                           /* too short as yet */
    if (st != SS_OK)
        return st;
    for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++)
        if (finds_all)
            s->shown[k] = f->number[k];
        else if (isnan(f->number[k].value) || k == SS_SLIPS)
            f->number[k] = s->shown[k];
    if (!s->begun && (last || count_due(s, f, 0, start, until) > 0)) {
        s->has = ss_features_have(f, &s->opts);
        ss_features_notes(&s->rows, s->head, s->column, &s->opts);
        ss_features_row(&s->rows, f, f->n, 0, s->has);  /* the names */
        s->begun = 1;
    }
    for (size_t i = 0; i < f->n; i++)
        if (!is_lone(&f->transition[i]) && is_due(s, &f->transition[i], start, until)) {
            ss_features_row(&s->rows, f, i, start, s->has);
            s->written = start + f->transition[i].end;
            s->transitions++;
        }
    double period = 1 / f->number[SS_REPETITION_FREQUENCY].value;
    if (whole || isfinite(period))
        s->known.period = period;               /* a part that does not repeat itself says nothing of the whole */
    if (whole && (!last || s->windows == 0)) {
        add_numbers(s, f);
        s->searched = s->seen;
        s->is_still = f->n == 0;
        s->is_changed = 0;
        s->known.known = s->lesson.label > 0 ? &s->lesson : NULL;
        s->known.is_contact = isfinite(f->number[SS_TRANSITION_FREQUENCY].value);
        s->part = s->hop + s->behind + s->few;
        while (f->n > 0 && s->part < s->window && f->n * s->part < LEAST * s->window)
            s->part += s->few / LEAST;
    }
    ss_features_free(s->before);
    s->before = f;
    s->before_start = start;
    return ss_rows_finish(&s->rows, err);
}

/* Write the numbers that all rows have in common. */
static ss_status
write_numbers(struct stream *s, ss_error *err)
{
    ss_features all = { .n = 0 };
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

static ss_status
begin(struct stream *s, const ss_header *head, FILE *to, ss_format format, ss_error *err)
{
    double period = head->rate / s->opts.fmin, room = 2 * ((PERIODS + 4) * period + head->rate);
    if (s->column >= head->n_columns)
        return ss_fail_column(err, s->column, head->n_columns);
    if (!(s->opts.fmin > 0 && period > 2 && room < 1e9))
        return ss_fail(err, SS_EINVAL, "a stream of features needs fmin, below half the rate and not far below it");
    s->head = head;
    s->written = -INFINITY;
    s->behind = (size_t)ceil(BEHIND * period);
    s->hop = (size_t)(2 * period + DELAY * head->rate) - s->behind;
    s->first = (size_t)(FIRST * period);
    s->few = (size_t)(LEAST * period);
    s->part = s->window = s->hop + s->behind + (size_t)(PERIODS * period);
    s->x = ss_columns_new(head->n_columns, 2 * s->window);
    return s->x != NULL ? ss_rows_begin(&s->rows, to, format, SS_KIND_FEATURES, err) : ss_fail_memory(err, NULL);
}

/* Read up to the next search, in the room that there is; *n: so many rows. */
static ss_status
read_on(struct stream *s, ss_reader *reader, double **to, size_t *n, ss_error *err)
{
    size_t hop = s->hop - (size_t)(s->seen % s->hop);
    if (s->n == 2 * s->window) {
        s->n = s->window;
        for (size_t c = 0; c < s->head->n_columns; c++)
            memcpy(s->x[c], s->x[c] + s->window, s->window * sizeof *s->x[c]);
    }
    for (size_t c = 0; c < s->head->n_columns; c++)
        to[c] = s->x[c] + s->n;
    return ss_reader_rows(reader, to, hop < 2 * s->window - s->n ? hop : 2 * s->window - s->n, n, err);
}

ss_status
ss_features_follow(ss_reader *reader, size_t column, const ss_features_opts *opts, FILE *to, ss_format format,
                   ss_error *err)
{
    struct stream s = { .column = column };
    ss_features_opts usual;
    if (reader == NULL || to == NULL)
        return SS_FAIL_NULL(err);
    ss_features_opts_init(&usual, sizeof usual);
    ss_status st = ss_options_take(&s.opts, sizeof s.opts, &usual, opts, err), read = SS_OK;
    const ss_progress progress = s.opts.progress;
    s.opts.progress = (ss_progress){ NULL, NULL };
    if (st == SS_OK)
        st = begin(&s, ss_reader_header(reader), to, format, err);
    double **place = st == SS_OK ? ss_columns_new(s.head->n_columns, 0) : NULL;
    if (st == SS_OK && place == NULL)
        st = ss_fail_memory(err, NULL);
    for (size_t n = 1; st == SS_OK && read == SS_OK && n > 0;) {
        read = read_on(&s, reader, place, &n, err);
        if (progress.function != NULL && progress.function(0, progress.user) != 0) {
            read = SS_OK;               /* the last row may be a part of one */
            break;
        }
        s.n += n;
        s.seen += n;
        if (n > 0 && s.seen % s.hop == 0 && s.seen >= s.first)
            st = write_known(&s, 0, err);
    }
    if (st == SS_OK)
        st = read;
    if (st == SS_OK)
        st = write_known(&s, 1, err);
    if (st == SS_OK)
        st = write_numbers(&s, err);
    ss_features_free(s.before);
    free(s.x);
    free(place);
    return st;
}
