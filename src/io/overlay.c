/* overlay.c -- read features and events, as far as a plot shows them.
 *
 * The fields have fixed places, so that lists written by hand need no names of columns. */
#include <stickslip/overlay.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "io/input.h"

typedef struct overlay_reader {
    struct input in;
    ss_overlay *overlay;
    size_t spans, maxima, spikes, events;       /* the room of each list */
} overlay_reader;

/* Append the pair to a list, unless one of its numbers is NaN. */
static ss_status
append_pair(overlay_reader *r, double (**list)[2], size_t *n, size_t *room, const double pair[2], ss_error *err)
{
    if (isnan(pair[0]) || isnan(pair[1]))
        return SS_OK;
    double (*more)[2] = ss_list_room(*list, room, *n, sizeof *more);
    if (more == NULL)
        return ss_fail_memory(err, r->in.name);
    *list = more;
    memcpy(more[(*n)++], pair, sizeof *more);
    return SS_OK;
}

static ss_status
append_time(overlay_reader *r, double **list, size_t *n, size_t *room, double t, ss_error *err)
{
    double *more = ss_list_room(*list, room, *n, sizeof *more);
    if (more == NULL)
        return ss_fail_memory(err, r->in.name);
    *list = more;
    more[(*n)++] = t;
    return SS_OK;
}

/* Read a transition: onset, end, number of spikes, and time and frequency of its maximum.  A hyphen stands for an
 * unknown value. */
static ss_status
read_transition(overlay_reader *r, const char *p, ss_error *err)
{
    ss_overlay *o = r->overlay;
    double field[5];
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < 5; i++)
        if (*p != '-' || strchr(" \t", p[1]) == NULL) {         /* strchr also finds the NUL */
            st = ss_input_number(&r->in, &p, "onset, end, spikes, time and frequency", &field[i], err);
        } else {
            field[i] = NAN;
            p += 1 + strspn(p + 1, " \t");
        }
    if (st == SS_OK)
        st = append_pair(r, &o->span, &o->n_spans, &r->spans, field, err);
    return st == SS_OK ? append_pair(r, &o->maximum, &o->n_maxima, &r->maxima, field + 3, err) : st;
}

/* Read time and kind of a spike.  Jumps and kinks are kept, since they are drawn. */
static ss_status
read_spike(overlay_reader *r, const char *text, ss_error *err)
{
    ss_overlay *o = r->overlay;
    double t;
    ss_status st = ss_input_number(&r->in, &text, "the time of a spike", &t, err);
    if (st != SS_OK || (strncmp(text, "jump", 4) != 0 && strncmp(text, "kink", 4) != 0))
        return st;
    return append_time(r, &o->spike, &o->n_spikes, &r->spikes, t, err);
}

static ss_status
read_event(overlay_reader *r, const char *text, ss_error *err)
{
    double t;
    ss_status st = ss_input_number(&r->in, &text, "a time in seconds", &t, err);
    return st == SS_OK ? append_time(r, &r->overlay->event, &r->overlay->n_events, &r->events, t, err) : st;
}

/* Rows are transitions or events, and notes "spike" are spikes. */
static ss_status
read_lines(overlay_reader *r, ss_kind kind, ss_error *err)
{
    static const char spike[] = "# spike: ";
    char *line;
    ss_status st = ss_input_begin(&r->in, kind, err);
    while (st == SS_OK && (st = ss_input_row(&r->in, &line, err)) == SS_OK && line != NULL)
        if (line[0] != '#')
            st = kind == SS_KIND_EVENTS ? read_event(r, line, err) : read_transition(r, line, err);
        else if (kind == SS_KIND_FEATURES && strncmp(line, spike, strlen(spike)) == 0)
            st = read_spike(r, line + strlen(spike), err);
    return st;
}

ss_status
ss_overlay_read(ss_overlay **out, FILE *in, const char *name, ss_kind kind, ss_error *err)
{
    if (out == NULL || in == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    if (kind != SS_KIND_EVENTS && kind != SS_KIND_FEATURES)
        return ss_fail(err, SS_EINVAL, "an overlay is a list of features or of events");
    overlay_reader r = { .overlay = calloc(1, sizeof *r.overlay) };
    *out = NULL;
    ss_status st = ss_input_open(&r.in, in, name, err);
    if (st == SS_OK && r.overlay == NULL)
        st = ss_fail_memory(err, name);
    if (st == SS_OK)
        st = read_lines(&r, kind, err);
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
    free(overlay->event);
    free(overlay);
}
