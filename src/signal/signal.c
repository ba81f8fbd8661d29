/* signal.c -- a whole signal in memory, column after column. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"
#include <stickslip/signal.h>

ss_status
ss_signal_new(ss_signal **out, const ss_header *head, size_t n, ss_error *err)
{
    if (out == NULL || head == NULL)
        return SS_FAIL_NULL(err);
    ss_signal *signal = calloc(1, sizeof *signal);
    size_t columns = head->n_columns > 0 ? head->n_columns : 1;
    *out = NULL;
    if (signal == NULL)
        return ss_fail_memory(err, NULL);
    signal->n = n;
    ss_header_select(&signal->head, head, NULL, head->n_columns, 0, NULL);
    if (n < SIZE_MAX / sizeof *signal->values / columns)
        signal->values = calloc(n * columns + 1, sizeof *signal->values);
    if (signal->head == NULL || signal->values == NULL) {
        ss_signal_free(signal);
        return ss_fail_memory(err, NULL);
    }
    *out = signal;
    return SS_OK;
}

void
ss_signal_free(ss_signal *signal)
{
    if (signal == NULL)
        return;
    ss_header_free(signal->head);
    free(signal->values);
    free(signal);
}

ss_status
ss_signal_select(ss_signal **out, const ss_signal *signal, const size_t *column, size_t n_columns,
                 size_t first, size_t end, ss_error *err)
{
    ss_header *head;
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    if (first > end || end > signal->n)
        return ss_fail(err, SS_EINVAL, "rows %zu to %zu are not among the %zu", first, end, signal->n);
    ss_status st = ss_header_select(&head, signal->head, column, n_columns, first, err);
    if (st != SS_OK)
        return st;
    size_t n = end - first;
    st = ss_signal_new(out, head, n, err);
    ss_header_free(head);
    for (size_t c = 0; st == SS_OK && c < n_columns; c++)
        memcpy((*out)->values + c * n, signal->values + (column != NULL ? column[c] : c) * signal->n + first,
               n * sizeof *signal->values);
    return st;
}
