/* stickslip/steps.h -- rate-and-state friction from steps in the speed of a load point; see stickslip-rank(7). */
#ifndef STICKSLIP_STEPS_H
#define STICKSLIP_STEPS_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>
#include <stickslip/table.h>

SS_BEGIN_DECLARATIONS

typedef enum ss_step_answer {
    SS_STEP_AGING, SS_STEP_SLIP,        /* one law is named; they are indices of ss_step.law, too */
    SS_STEP_UNDECIDED,                  /* both laws are as likely */
    SS_STEP_NONE                        /* neither follows the friction */
} ss_step_answer;
enum { SS_STEP_LAWS = 2 };

/* A law fitted to a step, mu = mu0 + a ln(V/V0) + b ln(V0 theta/Dc); each number with its standard error, or NaN
 * where the step does not show it. */
typedef struct ss_step_law {
    const char *name;           /* "aging" or "slip" */
    double log_likelihood;      /* of the rows; NaN: no fit */
    double gain;                /* how much larger it is than that of a straight line along the path */
    ss_value direct_effect, evolution_effect;   /* a, b */
    ss_value critical_slip_distance;            /* Dc [m] */
    ss_value stiffness, drift;  /* of the machine, and of friction along the load point's path [1/m] */
    double noise;               /* standard deviation of what the law leaves */
    double *model;              /* the law's friction, row by row */
} ss_step_law;

typedef struct ss_step {
    double at;                  /* where the speed changes [s] */
    double before, after;       /* speeds of the load point [m/s]; after a hold, that of the slide behind it */
    ss_step_answer answer;
    size_t best;                /* the likelier law */
    double ahead;               /* by which difference of logarithms of likelihood */
    char why[160];              /* the reason, if no law is named */
    ss_step_law law[SS_STEP_LAWS];
    size_t n;                   /* rows about the step */
    double *t, *path, *friction;        /* [s], [m] from the first row, friction */
} ss_step;

typedef struct ss_steps {
    size_t n;
    ss_step *step;              /* in the order of time */
} ss_steps;

typedef struct ss_steps_opts {
    size_t size;                /* set by ss_steps_opts_init */
    int normal;                 /* the column by which friction is divided; -1: none */
    double stiffness;           /* [1/m] >= 0 of the machine; 0: it is fitted */
    int shared;                 /* 1: all steps have one law, a, b, Dc and stiffness */
} ss_steps_opts;
void ss_steps_opts_init(ss_steps_opts *opts, size_t size);      /* no normal, 0, each step its own */

/* Fit both laws to each step in speed of a load point, from the columns `load` (a unit of length) and `friction`.
 * The last column of the signal holds the times of its rows, see ss_read_opts.stamps.
 *
 * A hold and the slide behind it are one step.  The slider begins in a steady slide and has no inertia.  The load
 * point moves on lines that meet between rows, or as recorded; of more than 4096 rows means are taken.  SS_EINVAL:
 * there is no such column, or stiffness is negative or not finite; SS_EDATA: the unit is not one of length, a value
 * is not finite, or there is no step; SS_ENOMEM.  opts may be NULL.  The caller frees *out with ss_steps_free. */
ss_status ss_steps_find(ss_steps **out, const ss_signal *signal, size_t load, size_t friction,
                        const ss_steps_opts *opts, ss_error *err);
void ss_steps_free(ss_steps *steps);            /* NULL is allowed */

/* Write a row a law and step, as ss-rank(1) describes.  SS_EINVAL: the format holds numbers only; SS_EIO. */
ss_status ss_steps_write(const ss_steps *steps, FILE *out, ss_format format, ss_error *err);

SS_END_DECLARATIONS
#endif
