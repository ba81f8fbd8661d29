/* stickslip/sim.h -- the motion of a scene: samples at a fixed rate, and every event. */
#ifndef STICKSLIP_SIM_H
#define STICKSLIP_SIM_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/scene.h>
#include <stickslip/signal.h>

SS_BEGIN_DECLARATIONS

/* A sink receives samples (n >= 1) or events in time order; they are valid during the call only.
 * An event comes before the first sample at its time or later.  A non-zero return ends the run
 * with SS_STOP. */
typedef int ss_sample_sink(const ss_sample *s, size_t n, void *user);
typedef int ss_event_sink(const ss_event *e, void *user);

typedef struct ss_sim_opts {
    size_t size;                /* set by ss_sim_opts_init */
    const char *method;         /* one of ss_sim_method_name; NULL: that of ss_sim_method_for */
    double tol;                 /* relative local error of a step, within ss_sim_tolerances */
    unsigned long max_steps;    /* 0: as many steps as 5e6 right-hand sides allow, with 1e4 more for
                                   each sample and 1e6 more for each second, at most 1e11 in all */
    ss_sample_sink *samples;    /* NULL: no samples are wanted */
    ss_event_sink *events;      /* NULL: no events are wanted */
    void *user;                 /* passed to both sinks */
    ss_progress progress;       /* called every few hundred steps or samples */
} ss_sim_opts;
extern const ss_range ss_sim_tolerances;        /* of tol: 1e-14 ... 1e-1 */
/* The scene's method at 1e-12, no sinks.  size is sizeof(ss_sim_opts); NULL options mean the same. */
void ss_sim_opts_init(ss_sim_opts *opts, size_t size);

typedef struct ss_sim_stats {   /* what a run cost, from the start of settling */
    unsigned long steps;        /* accepted integration steps */
    unsigned long rhs;          /* evaluations of the right-hand side */
    unsigned long events;       /* those before the record are among them */
    unsigned long unresolved;   /* events that the error of x in one step hides (the tolerance, or the
                                   rounding of the closed form): slips shorter than this error,
                                   contacts that only touched their limit, and the end of a slip that
                                   damping has slowed to nothing.  x keeps its accuracy; the number
                                   and the times of such events do not */
} ss_sim_stats;

/* Simulate the scene from the start of settling to the end of the record, in constant memory.  The
 * events do not depend on rate.  stats may be NULL.  SS_EINVAL: the scene or an option is out of
 * its range; SS_ERANGE: a value is not finite; SS_ETOL, SS_ECHATTER, SS_EBUDGET: err gives a
 * diagnosis; SS_EDATA: a rate-and-state motion ends where its spring goes slack; SS_STOP. */
ss_status ss_sim_run(const ss_scene *scene, const ss_sim_opts *opts, ss_sim_stats *stats,
                     ss_error *err);

/* The columns of a sample that a caller wants, in this order. */
enum { SS_SIM_COLUMNS = 8 };            /* x, v, a, f, s, y, z, mode */
typedef struct ss_sim_columns {
    int has_time;                       /* 1: t is wanted, as the first column */
    size_t n;                           /* columns without t */
    int pick[SS_SIM_COLUMNS];           /* their numbers in the list above, from 0 */
} ss_sim_columns;

/* Read a list such as "t,x,v,a,f".  SS_EINVAL: a name is unknown or repeated, or t is not the first. */
ss_status ss_sim_columns_parse(ss_sim_columns *columns, const char *list, ss_error *err);
/* Make the header of a signal with these columns; its notes are the scene's parameters.  The caller
 * frees it with ss_header_free.  SS_EINVAL: the scene has no model or is out of range; SS_ENOMEM. */
ss_status ss_sim_header(ss_header **head, const ss_scene *scene, const ss_sim_columns *columns, ss_error *err);
/* Write these columns of n samples, in that order: the value of sample i becomes column[c][i]. */
void ss_sim_rows(const ss_sim_columns *columns, const ss_sample *samples, size_t n, double *const column[]);

/* The simple case: make a signal of the whole record, with the columns x, v, a, f, s.  The caller
 * frees it with ss_signal_free. */
ss_status ss_sim_signal(ss_signal **out, const ss_scene *scene, ss_error *err);

const char *ss_sim_method_name(size_t i);               /* the i-th method; NULL after the last */
/* The method for a scene that has passed ss_scene_check: radau, an implicit method, if the scene
 * is so stiff that this costs least; else taylor, if the model is not linear and has a Taylor
 * series; else rk8pd.  *why, unless why is NULL, becomes the reason in words. */
const char *ss_sim_method_for(const ss_scene *scene, const char **why);

SS_END_DECLARATIONS
#endif
