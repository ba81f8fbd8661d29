/* events.c -- write events as text. */
#include <stickslip/sim.h>

#include <stdlib.h>
#include "base/error.h"
#include "io/record.h"

struct ss_event_writer {
    struct rows rows;
};

static void
write_row(struct rows *rows, const ss_event *event)
{
    ss_rows_number(rows, "t", "s", event->t);
    ss_rows_word(rows, "kind", ss_event_kind_name(event->kind));
    ss_rows_number(rows, "x", "m", event->x);
    ss_rows_number(rows, "v", "m/s", event->v);
    ss_rows_number(rows, "direction", "", event->direction);
    ss_rows_end(rows);
}

ss_status
ss_event_writer_new(ss_event_writer **out_writer, FILE *out, ss_format format, const ss_header *head,
                    ss_error *err)
{
    if (out_writer == NULL || out == NULL || head == NULL)
        return SS_FAIL_NULL(err);
    ss_event_writer *writer = malloc(sizeof *writer);
    *out_writer = NULL;
    if (writer == NULL)
        return ss_fail_memory(err, NULL);
    ss_status st = ss_rows_begin(&writer->rows, out, format, SS_KIND_EVENTS, err);
    if (st != SS_OK) {
        free(writer);
        return st;
    }
    ss_rows_notes(&writer->rows, head, (const char *const []){ NULL });    /* it has none of its own */
    write_row(&writer->rows, &(ss_event){ .t = 0 });    /* the names */
    *out_writer = writer;
    return SS_OK;
}

ss_status
ss_event_writer_row(ss_event_writer *writer, const ss_event *event, ss_error *err)
{
    if (writer == NULL || event == NULL)
        return SS_FAIL_NULL(err);
    if ((unsigned)event->kind > SS_REVERSE)
        return ss_fail(err, SS_EINVAL, "an event of no known kind");
    write_row(&writer->rows, event);
    return ferror(writer->rows.out) ? ss_fail(err, SS_EIO, "%s", ss_strerror(SS_EIO)) : SS_OK;
}

ss_status
ss_event_writer_flush(ss_event_writer *writer, ss_error *err)
{
    return writer != NULL ? ss_rows_finish(&writer->rows, err) : SS_FAIL_NULL(err);
}

void
ss_event_writer_free(ss_event_writer *writer)
{
    free(writer);
}
