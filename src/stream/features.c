/* features.c -- features read back, as far as a plot shows them. */
#include <stickslip/overlay.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "stream/input.h"

typedef struct reader {
    struct input in;
    ss_overlay *overlay;
    size_t spans, maxima, spikes;       /* that the lists have room for */
} reader;

static ss_status
no_memory(const reader *r, ss_error *err)
{
    return ss_fail(err, SS_ENOMEM, "%s: %s", r->in.name, ss_strerror(SS_ENOMEM));
}

/* Append the pair to a list, unless a part of it is not known. */
static ss_status
append(reader *r, double (**list)[2], size_t *n, size_t *room, const double pair[2], ss_error *err)
{
    if (isnan(pair[0]) || isnan(pair[1]))
        return SS_OK;
    double (*more)[2] = ss_list_room(*list, room, *n, sizeof **list);
    if (more == NULL)
        return no_memory(r, err);
    *list = more;
    memcpy(more[(*n)++], pair, sizeof *more);
    return SS_OK;
}

/* A number, or a hyphen for what is not known, which is NaN. */
static ss_status
read_field(const reader *r, const char **text, double *x, ss_error *err)
{
    const char *p = *text;
    if (*p != '-' || strchr(" \t", p[1]) == NULL)      /* or the NUL at its end */
        return ss_input_number(&r->in, text, "onset, end, spikes, time and frequency", x, err);
    *x = NAN;
    *text = p + 1 + strspn(p + 1, " \t");
    return SS_OK;
}

/* A transition: onset, end, spikes, and time and frequency of its maximum. */
static ss_status
read_transition(reader *r, const char *text, ss_error *err)
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

/* Time and kind of a spike: jumps and kinks are drawn. */
static ss_status
read_spike(reader *r, const char *text, ss_error *err)
{
    ss_overlay *o = r->overlay;
    double t;
    ss_status st = ss_input_number(&r->in, &text, "the time of a spike", &t, err);
    if (st != SS_OK || (strncmp(text, "jump", 4) != 0 && strncmp(text, "kink", 4) != 0))
        return st;
    double *more = ss_list_room(o->spike, &r->spikes, o->n_spikes, sizeof *more);
    if (more == NULL)
        return no_memory(r, err);
    o->spike = more;
    o->spike[o->n_spikes++] = t;
    return SS_OK;
}

/* Rows are transitions, and notes "spike" are spikes. */
static ss_status
read_lines(reader *r, ss_error *err)
{
    static const char note[] = "# spike: ";
    char *line;
    ss_status st = ss_input_begin(&r->in, "# stickslip features 1", "features", err);
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
    reader r = { .overlay = calloc(1, sizeof *r.overlay) };
    *out = NULL;
    ss_status st = ss_input_open(&r.in, in, name, err);
    if (st == SS_OK && r.overlay == NULL)
        st = no_memory(&r, err);
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
