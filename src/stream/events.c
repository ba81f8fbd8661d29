/* events.c -- the times of events read back. */
#include <stickslip/overlay.h>

#include <stdlib.h>
#include "base/error.h"
#include "base/list.h"
#include "stream/input.h"

static ss_status
read_times(double **time, size_t *n, struct input *in, ss_error *err)
{
    char *line;
    size_t room = 0;
    ss_status st = ss_input_begin(in, "# stickslip events 1", "events", err);
    while (st == SS_OK && (st = ss_input_row(in, &line, err)) == SS_OK && line != NULL) {
        const char *text = line;
        if (*text == '#')
            continue;
        double *more = ss_list_room(*time, &room, *n, sizeof *more);
        if (more == NULL)
            return ss_fail(err, SS_ENOMEM, "%s: %s", in->name, ss_strerror(SS_ENOMEM));
        *time = more;
        st = ss_input_number(in, &text, "a time in seconds", &(*time)[(*n)++], err);
    }
    return st;
}

ss_status
ss_event_times_read(double **time, size_t *n, FILE *in, const char *name, ss_error *err)
{
    struct input input;
    if (time == NULL || n == NULL || in == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    *time = NULL;
    *n = 0;
    ss_status st = ss_input_open(&input, in, name, err);
    if (st == SS_OK)
        st = read_times(time, n, &input, err);
    ss_input_close(&input);
    if (st == SS_OK)
        return SS_OK;
    free(*time);
    *time = NULL;
    *n = 0;
    return st;
}
