/* window.h -- a stretch of samples. */
#ifndef WINDOW_H
#define WINDOW_H

#include <stddef.h>

typedef struct ss_window {
    size_t first, end;          /* samples [first, end) */
} ss_window;

static inline size_t
ss_window_length(ss_window win)
{
    return win.end - win.first;
}

#endif
