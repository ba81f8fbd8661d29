/* features.c -- features as text, and read back as far as a plot shows them. */
#include <stickslip/features.h>
#include <stickslip/overlay.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "io/input.h"
#include "io/output.h"
#include "io/rows.h"
#include "io/summary.h"

typedef struct feature_reader {
    struct input in;
    ss_overlay *overlay;
    size_t spans, maxima, spikes;       /* the room of each list */
} feature_reader;

/* Append the pair to a list, unless one of its numbers is NaN. */
static ss_status
append(feature_reader *r, double (**list)[2], size_t *n, size_t *room, const double pair[2],
       ss_error *err)
{
    if (isnan(pair[0]) || isnan(pair[1]))
        return SS_OK;
    double (*more)[2] = ss_list_room(*list, room, *n, sizeof **list);
    if (more == NULL)
        return ss_fail_memory(err, r->in.name);
    *list = more;
    memcpy(more[(*n)++], pair, sizeof *more);
    return SS_OK;
}

/* Read a number, or NaN from a hyphen, which stands for an unknown value. */
static ss_status
read_field(const feature_reader *r, const char **text, double *x, ss_error *err)
{
    const char *p = *text;
    if (*p != '-' || strchr(" \t", p[1]) == NULL)      /* strchr also finds the NUL */
        return ss_input_number(&r->in, text, "onset, end, spikes, time and frequency", x, err);
    *x = NAN;
    *text = p + 1 + strspn(p + 1, " \t");
    return SS_OK;
}

/* Read a transition: onset, end, number of spikes, and time and frequency of its maximum. */
static ss_status
read_transition(feature_reader *r, const char *text, ss_error *err)
{
    ss_overlay *o = r->overlay;
    double field[5];
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < 5; i++)
        st = read_field(r, &text, &field[i], err);
    if (st == SS_OK)
        st = append(r, &o->span, &o->n_spans, &r->spans, field, err);
    return st == SS_OK ? append(r, &o->maximum, &o->n_maxima, &r->maxima, field + 3, err) : st;
}

/* Read time and kind of a spike.  Jumps and kinks are kept, since they are drawn. */
static ss_status
read_spike(feature_reader *r, const char *text, ss_error *err)
{
    ss_overlay *o = r->overlay;
    double t;
    ss_status st = ss_input_number(&r->in, &text, "the time of a spike", &t, err);
    if (st != SS_OK || (strncmp(text, "jump", 4) != 0 && strncmp(text, "kink", 4) != 0))
        return st;
    double *more = ss_list_room(o->spike, &r->spikes, o->n_spikes, sizeof *more);
    if (more == NULL)
        return ss_fail_memory(err, r->in.name);
    o->spike = more;
    o->spike[o->n_spikes++] = t;
    return SS_OK;
}

/* Rows are transitions, and notes "spike" are spikes. */
static ss_status
read_lines(feature_reader *r, ss_error *err)
{
    static const char note[] = "# spike: ";
    char *line;
    ss_status st = ss_input_begin(&r->in, SS_KIND_FEATURES, err);
    while (st == SS_OK && (st = ss_input_row(&r->in, &line, err)) == SS_OK && line != NULL)
        if (line[0] != '#')
            st = read_transition(r, line, err);
        else if (strncmp(line, note, strlen(note)) == 0)
            st = read_spike(r, line + strlen(note), err);
    return st;
}

ss_status
ss_overlay_read(ss_overlay **out, FILE *in, const char *name, ss_error *err)
{
    if (out == NULL || in == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    feature_reader r = { .overlay = calloc(1, sizeof *r.overlay) };
    *out = NULL;
    ss_status st = ss_input_open(&r.in, in, name, err);
    if (st == SS_OK && r.overlay == NULL)
        st = ss_fail_memory(err, name);
    if (st == SS_OK)
        st = read_lines(&r, err);
    ss_input_close(&r.in);
    if (st == SS_OK)
        *out = r.overlay;
    else
        ss_overlay_free(r.overlay);
    return st;
}

void
ss_overlay_free(ss_overlay *overlay)
{
    if (overlay == NULL)
        return;
    free(overlay->span);
    free(overlay->maximum);
    free(overlay->spike);
    free(overlay);
}

/* --- writing ------------------------------------------------------------------------------- */

static void
write_transition(struct rows *rows, const ss_transition *tr, double start, int conclusive)
{
    const double cells[] = { start + tr->maximum.t, tr->maximum.f, tr->maximum.prominence,
                             tr->frequency.value, tr->frequency.error, tr->damping_ratio.value,
                             tr->damping_ratio.error };
    ss_rows_number(rows, start + tr->onset);
    ss_rows_number(rows, start + tr->end);
    if (conclusive && !tr->gap)
        ss_rows_count(rows, tr->spikes);
    else
        ss_rows_number(rows, NAN);
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++)
        ss_rows_number(rows, cells[i]);
}

static void
write_loading(struct rows *rows, const ss_loading *l)
{
    const ss_value cells[] = { l->slope, l->stiffness, l->drop, l->duration, l->recurrence, l->stick,
                               l->static_friction, l->friction, l->k_over_m };
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
        ss_rows_number(rows, cells[i].value);
        ss_rows_number(rows, cells[i].error);
    }
}

static void
write_spikes(struct rows *rows, const ss_spikes *found, double start)
{
    char t[SS_NUMBER_MAX], level[SS_NUMBER_MAX], slope[SS_NUMBER_MAX];
    for (size_t i = 0; i < found->n; i++) {
        const ss_spike *spike = &found->spike[i];
        ss_rows_note(rows, "spike: %s %s %s %s", ss_number_text(t, start + spike->t),
                     ss_spike_kind_name(spike->kind), ss_number_rounded(level, spike->level, 3),
                     ss_number_rounded(slope, spike->slope, 3));
    }
}

static void
write_reason(struct rows *rows, const char *key, const char *why)
{
    if (why != NULL)
        ss_rows_note(rows, "%s: %s", key, why);
}

static void
write_summary(struct rows *rows, const ss_features *f, const ss_features_opts *opts)
{
    ss_rows_note(rows, "spikes: %s", ss_spikes_verdict(f->spikes));
    write_reason(rows, "about_slips", f->why_slips);
    write_reason(rows, "about_repetition", f->why_repetition);
    write_reason(rows, "about_ringing", f->why_ringing);
    ss_rows_note(rows, "transitions: %zu -", f->n);
    ss_summary_write(rows, f, opts);
}

/* Write the notes of a signal, except those that features write themselves, or may write: a scene's friction is
 * not the one that was measured, and no file says of itself what was found in it. */
static void
write_notes(struct rows *rows, const ss_header *head)
{
    const char *own[SS_SUMMARY_NUMBERS + 8] = { "column", "threshold", "norm", "near_gaps", "spike", "spikes", "about_*" };
    for (size_t i = 0; i < SS_SUMMARY_NUMBERS; i++)
        own[7 + i] = ss_summary_name(i);
    ss_rows_notes(rows, head, own);
}

ss_status
ss_features_write(const ss_features *f, const ss_signal *signal, size_t column,
                  const ss_features_opts *opts, FILE *out, ss_format format)
{
    static const char *const columns[][2] = {
        { "onset", "s" }, { "end", "s" }, { "spikes", "" }, { "time", "s" }, { "frequency", "Hz" },
        { "prominence", "dB" }, { "transition_frequency", "Hz" },
        { "transition_frequency_error", "Hz" }, { "damping_ratio", "" },
        { "damping_ratio_error", "" },
        /* only falls of a force have these */
        { "slope", "" }, { "slope_error", "" }, { "stiffness", "" }, { "stiffness_error", "" },
        { "drop", "" }, { "drop_error", "" }, { "duration", "s" }, { "duration_error", "s" },
        { "recurrence", "s" }, { "recurrence_error", "s" }, { "stick", "s" }, { "stick_error", "s" },
        { "static_friction", "" }, { "static_friction_error", "" }, { "friction", "" },
        { "friction_error", "" }, { "k_over_m", "1/s^2" }, { "k_over_m_error", "1/s^2" } };
    enum { EVERY = sizeof columns / sizeof *columns, OF_LOADING = 18 };
    struct rows rows;
    char threshold[SS_NUMBER_MAX];
    if (f == NULL || signal == NULL || column >= signal->head->n_columns || opts == NULL || out == NULL
        || ss_rows_begin(&rows, out, format, SS_KIND_FEATURES) != SS_OK)
        return SS_EINVAL;
    const ss_header *head = signal->head;
    write_summary(&rows, f, opts);
    write_notes(&rows, head);
    ss_rows_note(&rows, "column: %s", head->column[column].name);
    ss_rows_note(&rows, "threshold: %s", ss_number_text(threshold, opts->threshold));
    ss_rows_note(&rows, "norm: %s", opts->norm == SS_NORM_L1 ? "l1" : "l2");
    if (ss_header_find_note(head, "gaps") != NULL)
        ss_rows_note(&rows, "near_gaps: nothing is claimed: no spike within 12 scales, no event "
                     "within 6, no local maximum within sqrt(2), no fit over one");
    size_t n_columns = f->loading != NULL ? EVERY : EVERY - OF_LOADING;
    int repeats = !rows.format->has_notes;      /* the summary, then also in a row without a transition */
    for (size_t i = 0; i < n_columns; i++)
        ss_rows_column(&rows, columns[i][0], columns[i][1]);
    if (repeats)
        ss_summary_columns(&rows, f, opts);
    ss_rows_end(&rows);
    for (size_t i = 0; i < f->n + (repeats && f->n == 0); i++) {
        if (i < f->n)
            write_transition(&rows, &f->transition[i], head->start, f->spikes->conclusive);
        if (i < f->n && f->loading != NULL)
            write_loading(&rows, &f->loading[i]);
        for (size_t k = 0; i == f->n && k < n_columns; k++)
            ss_rows_number(&rows, NAN);
        if (repeats)
            ss_summary_cells(&rows, f, opts);
        ss_rows_end(&rows);
    }
    write_spikes(&rows, f->spikes, head->start);
    return ss_output_flush(out);
}
