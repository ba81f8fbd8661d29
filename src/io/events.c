/* events.c -- write events as text. */
#include <stickslip/sim.h>

#include <stdlib.h>
#include "base/error.h"
#include "io/output.h"
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
ss_event_writer_new(ss_event_writer **out_writer, FILE *out, ss_format format, const ss_header *head)
{
    if (out_writer == NULL || out == NULL || head == NULL)
        return SS_EINVAL;
    ss_event_writer *writer = malloc(sizeof *writer);
    *out_writer = NULL;
    if (writer == NULL)
        return SS_ENOMEM;
    ss_status st = ss_rows_begin(&writer->rows, out, format, SS_KIND_EVENTS, NULL);
    if (st != SS_OK) {
        free(writer);
        return st;
    }
    ss_rows_notes(&writer->rows, head, (const char *const []){ NULL });    /* it has none */
    write_row(&writer->rows, &(ss_event){ .t = 0 });    /* the names */
    *out_writer = writer;
    return SS_OK;
}

ss_status
ss_event_writer_row(ss_event_writer *writer, const ss_event *event)
{
    if (writer == NULL || event == NULL || (unsigned)event->kind > SS_REVERSE)
        return SS_EINVAL;
    write_row(&writer->rows, event);
    return ferror(writer->rows.out) ? SS_EIO : SS_OK;
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
