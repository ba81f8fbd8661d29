/* new_signal.h -- a signal of one column, zero so far: for tests. */
#ifndef NEW_SIGNAL_H
#define NEW_SIGNAL_H

#include <stickslip.h>

#include "unit.h"

/* n samples; to be freed with ss_signal_free. */
static inline ss_signal *
new_signal(size_t n, double rate, double start, const char *name, const char *unit)
{
    ss_signal *signal = NULL;
    ss_header *head = NULL;
    assert_int_equal(ss_header_new(&head, rate, start, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, name, unit, NULL), SS_OK);
    assert_int_equal(ss_signal_new(&signal, head, n, NULL), SS_OK);
    ss_header_free(head);
    return signal;
}

#endif
