/* clock.h -- find the uniform clock of time stamps. */
#ifndef CLOCK_H
#define CLOCK_H

#include <stddef.h>
#include "io/table/sheet.h"

#define CLOCK_TOLERANCE 0.1     /* a stamp may be off by so many sample periods */

/* A pass through the stamps of a table, from zeros behind the first two on. */
struct stamps {
    struct kept *rows;
    struct time_column of;
    size_t n;                   /* stamps so far */
    double stamp, before;       /* the last one, and that before it */
    unsigned long line;         /* where it stands */
    uint64_t row;
};
/* Go to the next stamp.  Returns 0 if there is none. */
int ss_stamps_next(struct stamps *s);
/* SS_ECLOCK: they are fewer than two, or do not ascend. */
ss_status ss_stamps_check(struct stamps s, ss_error *err);
/* The median of steps, or of some thousand that lie evenly among them, of stamps that ascend. */
double ss_usual_step(struct stamps s);

/* The samples of rows: one after the other, or, where some may be missing, as the steps of their stamps show.
 * Begin with the usual step, or 0, and zeros. */
struct sample_count {
    double usual, last;         /* last: stamp */
    size_t next;
};
size_t ss_clock_sample(struct sample_count *c, double stamp);

struct clock {
    double usual;               /* given: the usual step, and some stamps may be missing; 0: none is */
    double taken;               /* given: [s] from all stamps, which were rounded before */
    double digit;               /* given: [s] what 1 in the last digit of a stamp is; 0: not known */
    double rate, start;         /* found */
    size_t n;                   /* stamps */
    double last;                /* the number of the last sample */
};
/* Find the uniform clock of stamps that ascend. */
ss_status ss_find_clock(struct stamps s, struct clock *clock, ss_error *err);
/* The error of a stamp that comes so many sample periods too late. */
ss_status ss_clock_refuse(const char *name, unsigned long line, double late, ss_error *err);
/* The fewest digits of a number that is x, but for 1e-9 of it. */
int ss_clock_digits(double x);

#endif
