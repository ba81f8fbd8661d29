/* clock.h -- find the uniform clock of time stamps. */
#ifndef CLOCK_H
#define CLOCK_H

#include <stddef.h>
#include <stdint.h>
#include <stickslip/signal.h>

/* Sums over stamps that come one after the other, from which the uniform clock follows.  Begin with
 * zeros. */
struct clock_point {
    double sample, stamp;
};
typedef struct clock_fit {
    size_t n;
    struct clock_point first, last, mean;       /* mean: from the first on */
    double taken;               /* [s] from all stamps, which were rounded before */
    double digit;               /* [s] what 1 in the last digit of a stamp is; 0: not known */
    double product, square;     /* sums of products of sample and stamp, and of sample, about the mean */
    struct clock_side {         /* corners of the convex hull: below and above all points */
        struct clock_point *corner;
        size_t n, room;
    } side[2];
} clock_fit;

/* Add a stamp that is later than the one before.  Returns 0 if there is no memory. */
int ss_clock_add(clock_fit *f, double sample, double stamp);
/* The rate; SS_EUNEVEN, without a text, if the stamps are not uniform. */
ss_status ss_clock_rate(const clock_fit *f, const char *file, double *rate, ss_error *err);
void ss_clock_free(clock_fit *f);
/* The fewest digits of a number that is x, but for 1e-9 of it. */
int ss_clock_digits(double x);

/* Stamps of a file that are read several times: from the first on, the next with the number of its line;
 * *there = 0: there is none. */
struct stamps {
    const char *file;
    ss_status (*rewind)(void *source, ss_error *err);
    ss_status (*next)(void *source, int *there, double *stamp, unsigned long *line, ss_error *err);
    void *source;
};

/* The samples of rows: one after the other, or, where some may be missing, as the steps of their stamps show.
 * Begin with the usual step, or 0, and zeros. */
struct sample_count {
    double usual, last;         /* last: stamp */
    size_t next;
};
size_t ss_clock_sample(struct sample_count *c, double stamp);

/* Find the uniform clock of the stamps; *fit, from zeros but for taken and digit, is to be freed.  usual > 0: that step, and some may
 * be missing. */
ss_status ss_find_clock(const struct stamps *s, double usual, clock_fit *fit, double *rate, ss_error *err);
/* The median step of stamps, which must ascend. */
ss_status ss_usual_step(const struct stamps *s, double *usual, ss_error *err);

/* Is the stamp start + row / rate, but for rounding and 1e-6 sample periods? */
int ss_is_on_clock(double stamp, double rate, double start, uint64_t row);

/* Refuse an option for delimited text alone. */
ss_status ss_refuse_table(const char *name, const ss_read_opts *opts, ss_error *err);
/* Refuse it, and options for input without a clock; this input has the rate own. */
ss_status ss_refuse_clock(const char *name, double own, const ss_read_opts *opts, ss_error *err);

#endif
