/* progress.h -- tell the caller how far a piece of the work is, as a part of the whole. */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stddef.h>
#include <stickslip/status.h>

typedef struct ss_stretch {
    ss_progress *call;          /* the caller's; may be NULL */
    void *user;
    double from, to;            /* of the whole  0 ... 1 */
} ss_stretch;

/* SS_STOP if the caller wants no more. */
static inline ss_status
ss_stretch_at(const ss_stretch *s, double part)
{
    return s->call != NULL && s->call(s->from + (s->to - s->from) * part, s->user) != 0 ? SS_STOP
        : SS_OK;
}

/* The part [from, to] of a stretch. */
static inline ss_stretch
ss_stretch_part(const ss_stretch *s, double from, double to)
{
    double length = s->to - s->from;
    return (ss_stretch){ s->call, s->user, s->from + length * from, s->from + length * to };
}

#endif
