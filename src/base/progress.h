/* progress.h -- report the progress of a part of the work as a fraction of the whole. */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stddef.h>
#include <stickslip/status.h>

/* SS_STOP if the caller asks to stop. */
static inline ss_status
ss_progress_at(const ss_progress *p, double done)
{
    return p->function != NULL && p->function(done, p->user) != 0 ? SS_STOP : SS_OK;
}

/* The part of the work between the fractions from and to of the whole. */
typedef struct ss_stretch {
    ss_progress progress;
    double from, to;
} ss_stretch;

static inline ss_status
ss_stretch_at(const ss_stretch *s, double part)
{
    return ss_progress_at(&s->progress, s->from + (s->to - s->from) * part);
}

/* The part [from, to] of a stretch. */
static inline ss_stretch
ss_stretch_part(const ss_stretch *s, double from, double to)
{
    double length = s->to - s->from;
    return (ss_stretch){ s->progress, s->from + length * from, s->from + length * to };
}

#endif
