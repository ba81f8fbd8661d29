/* overlay.c -- read features and events, as far as a plot shows them.
 *
 * The fields have fixed places, so that lists written by hand need no names of columns. */
#include <stickslip/number.h>
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
    int no_memory;
} overlay_reader;

/* Append so many numbers to a list, unless the first or the last is NaN.  Returns the list. */
static void *
append(overlay_reader *r, void *list, size_t *n, size_t *room, const double number[], size_t width)
{
    if (isnan(number[0]) || isnan(number[width - 1]))
        return list;
    double *more = ss_list_room(list, room, *n, width * sizeof *more);
    r->no_memory |= more == NULL;
    if (more == NULL)
        return list;
    memcpy(more + width * (*n)++, number, width * sizeof *more);
    return more;
}

/* Read n numbers.  A hyphen stands for one that is not known.  Returns the text behind them; NULL, with the reason
 * in err, if they are not there. */
static const char *
read_numbers(overlay_reader *r, const char *p, double number[], size_t n, const char *expected, ss_error *err)
{
    for (size_t i = 0; i < n; i++) {
        char *end = (char *)p + 1;
        number[i] = NAN;
        if (n == 1 || *p != '-' || strchr(" \t", p[1]) == NULL) {       /* strchr also finds the NUL */
            number[i] = ss_number_parse(p, &end);
            if (end == p || !isfinite(number[i]) || strchr(" \t,", *end) == NULL) {
                ss_fail(err, SS_EDATA, "%s:%lu: expected %s", r->in.name, r->in.line, expected);
                return NULL;
            }
        }
        p = end + strspn(end, " \t,");
    }
    return p;
}

/* Rows are transitions (onset, end, number of spikes, and time and frequency of the maximum) or events, and notes
 * "spike" are spikes: time and kind, of which jumps and kinks are drawn. */
static ss_status
read_line(overlay_reader *r, ss_kind kind, const char *line, ss_error *err)
{
    static const char spike[] = "# spike: ";
    ss_overlay *o = r->overlay;
    double field[5];
    int is_spike = kind == SS_KIND_FEATURES && strncmp(line, spike, strlen(spike)) == 0;
    if (line[0] == '#' && !is_spike)
        return SS_OK;
    const char *rest = is_spike ? read_numbers(r, line + strlen(spike), field, 1, "the time of a spike", err)
        : kind == SS_KIND_EVENTS ? read_numbers(r, line, field, 1, "a time in seconds", err)
        : read_numbers(r, line, field, 5, "onset, end, spikes, time and frequency", err);
    if (rest == NULL)
        return SS_EDATA;
    if (is_spike && (strncmp(rest, "jump", 4) == 0 || strncmp(rest, "kink", 4) == 0)) {
        o->spike = append(r, o->spike, &o->n_spikes, &r->spikes, field, 1);
    } else if (!is_spike && kind == SS_KIND_EVENTS) {
        o->event = append(r, o->event, &o->n_events, &r->events, field, 1);
    } else if (!is_spike) {
        o->span = append(r, o->span, &o->n_spans, &r->spans, field, 2);
        o->maximum = append(r, o->maximum, &o->n_maxima, &r->maxima, field + 3, 2);
    }
    return r->no_memory ? ss_fail_memory(err, r->in.name) : SS_OK;
}

ss_status
ss_overlay_read(ss_overlay **out, FILE *in, const char *name, ss_kind kind, ss_error *err)
{
    if (out == NULL || in == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    if (kind != SS_KIND_EVENTS && kind != SS_KIND_FEATURES)
        return ss_fail(err, SS_EINVAL, "an overlay is a list of features or of events");
    overlay_reader r = { .overlay = calloc(1, sizeof *r.overlay) };
    char *line;
    *out = NULL;
    ss_status st = ss_input_open(&r.in, in, name, err);
    if (st == SS_OK && r.overlay == NULL)
        st = ss_fail_memory(err, name);
    if (st == SS_OK)
        st = ss_input_begin(&r.in, kind, err);
    while (st == SS_OK && (st = ss_input_row(&r.in, &line, err)) == SS_OK && line != NULL)
        st = read_line(&r, kind, line, err);
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
