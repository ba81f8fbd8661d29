/* events.c -- write events as text, and read their times. */
#include <stickslip/overlay.h>
#include <stickslip/sim.h>

#include <stdlib.h>
#include "base/error.h"
#include "base/list.h"
#include "io/input.h"
#include "io/output.h"
#include "io/rows.h"

static ss_status
read_times(double **time, size_t *n, struct input *in, ss_error *err)
{
    char *line;
    size_t room = 0;
    ss_status st = ss_input_begin(in, SS_KIND_EVENTS, err);
    while (st == SS_OK && (st = ss_input_row(in, &line, err)) == SS_OK && line != NULL) {
        const char *text = line;
        if (*text == '#')
            continue;
        double *more = ss_list_room(*time, &room, *n, sizeof *more);
        if (more == NULL)
            return ss_fail_memory(err, in->name);
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

/* --- writing ------------------------------------------------------------------------------- */

struct ss_event_writer {
    struct rows rows;
};

ss_status
ss_event_writer_new(ss_event_writer **out_writer, FILE *out, ss_format format, const ss_header *head)
{
    static const char *const columns[][2] = {
        { "t", "s" }, { "kind", "" }, { "x", "m" }, { "v", "m/s" }, { "direction", "" } };
    if (out_writer == NULL || out == NULL || head == NULL)
        return SS_EINVAL;
    ss_event_writer *writer = malloc(sizeof *writer);
    *out_writer = NULL;
    if (writer == NULL)
        return SS_ENOMEM;
    ss_status st = ss_rows_begin(&writer->rows, out, format, SS_KIND_EVENTS);
    if (st != SS_OK) {
        free(writer);
        return st;
    }
    ss_rows_notes(&writer->rows, head, (const char *const []){ NULL });    /* it has none */
    ss_rows_columns(&writer->rows, columns, sizeof columns / sizeof *columns);
    *out_writer = writer;
    return SS_OK;
}

ss_status
ss_event_writer_row(ss_event_writer *writer, const ss_event *event)
{
    if (writer == NULL || event == NULL || (unsigned)event->kind > SS_REVERSE)
        return SS_EINVAL;
    struct rows *rows = &writer->rows;
    ss_rows_number(rows, event->t);
    ss_rows_word(rows, ss_event_kind_name(event->kind));
    ss_rows_number(rows, event->x);
    ss_rows_number(rows, event->v);
    ss_rows_number(rows, event->direction);
    ss_rows_end(rows);
    return ferror(rows->out) ? SS_EIO : SS_OK;
}

ss_status
ss_event_writer_flush(ss_event_writer *writer)
{
    return writer != NULL ? ss_output_flush(writer->rows.out) : SS_EINVAL;
}

void
ss_event_writer_free(ss_event_writer *writer)
{
    free(writer);
}
