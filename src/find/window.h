/* window.h -- a stretch of samples. */
#ifndef WINDOW_H
#define WINDOW_H

#include <stddef.h>
#include <stickslip/signal.h>

typedef struct ss_window {
    size_t first, end;          /* samples [first, end) */
} ss_window;

static inline size_t
ss_window_length(ss_window win)
{
    return win.end - win.first;
}

/* Where a record is searched. */
typedef struct search_places {
    ss_span *span;              /* n of them, in time order [s] from the first sample; NULL: everywhere */
    size_t n;
} search_places;

#endif
