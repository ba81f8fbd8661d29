/* stickslip/sim.h -- the motion of a scene: samples at a fixed rate, and every event between. */
#ifndef STICKSLIP_SIM_H
#define STICKSLIP_SIM_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/scene.h>
#include <stickslip/signal.h>

SS_BEGIN_DECLARATIONS

/* Sinks receive samples (n >= 1) and events in time order, valid during the call only: an event
 * comes before the first sample that it precedes or coincides with.  A non-zero return ends the
 * run with SS_STOP. */
typedef int ss_sample_sink(const ss_sample *s, size_t n, void *user);
typedef int ss_event_sink(const ss_event *e, void *user);

typedef struct ss_sim_opts {
    const char *method;         /* one of ss_sim_method_name; NULL: ss_sim_method_for the scene */
    double tol;                 /* relative local error a step, 1e-14 ... 1e-1 */
    unsigned long max_steps;    /* 0: as many as 5e6 right-hand sides, 1e4 more for each sample and
                                   1e6 more for each second allow, at most 1e11 in all */
    ss_sample_sink *samples;
    ss_event_sink *events;
    void *user;                 /* passed to both, either of which may be NULL */
    ss_progress progress;       /* called every few hundred steps or samples */
} ss_sim_opts;
extern const ss_range ss_sim_tolerances;        /* of tol */
extern const ss_sim_opts ss_sim_defaults;       /* the scene's method at 1e-12, no sinks */

typedef struct ss_sim_stats {   /* what a run cost, from the start of settling */
    unsigned long steps;        /* accepted integration steps */
    unsigned long rhs;          /* evaluations of the right-hand side */
    unsigned long events;       /* before the record too */
    unsigned long unresolved;   /* micro-events within the error of x in a step (the tolerance, or
                                   the rounding of the closed form): slips no longer than that, and
                                   contacts that only touched their limit, and the end of a slip
                                   that damping has slowed to nothing.  x keeps its accuracy;
                                   the number and times of such events do not */
} ss_sim_stats;

/* Simulate the scene from the start of settling to the end of the record, in constant memory.
 * The events never depend on rate.  stats may be NULL.  SS_EINVAL for a scene or option out of
 * range, SS_ERANGE for a value that is not finite, SS_ETOL, SS_ECHATTER, SS_EBUDGET with a
 * diagnosis; SS_STOP. */
ss_status ss_sim_run(const ss_scene *scene, const ss_sim_opts *opts, ss_sim_stats *stats,
                     ss_error *err);

/* The wanted columns of a sample, in this order. */
enum { SS_SIM_COLUMNS = 8 };            /* x, v, a, f, s, y, z, mode */
typedef struct ss_sim_columns {
    int has_time;                       /* t is wanted (first) */
    size_t n;
    int pick[SS_SIM_COLUMNS];
} ss_sim_columns;

/* From a list such as "t,x,v,a,f"; SS_EINVAL for an unknown or repeated name, or t not first. */
ss_status ss_sim_columns_parse(ss_sim_columns *columns, const char *list, ss_error *err);
/* The header of such a signal, with the scene's parameters as notes; to be freed with
 * ss_header_free.  NULL if out of memory. */
ss_header *ss_sim_header(const ss_scene *scene, const ss_sim_columns *columns);
/* The values of one sample in that order, columns->n of them. */
void ss_sim_row(const ss_sim_columns *columns, const ss_sample *sample, double *row);

/* The simple case: the whole record as a signal with the columns x, v, a, f, s, to be freed with
 * ss_signal_free. */
ss_status ss_sim_signal(ss_signal **out, const ss_scene *scene, ss_error *err);

const char *ss_event_kind_name(ss_event_kind kind);     /* "stick", "slip", "reverse" */
const char *ss_sim_method_name(size_t i);               /* the i-th method; NULL after the last */
/* rk8pd; for models that are not linear and have a Taylor series taylor, or bsimp, an implicit method,
 * where the scene is so stiff that this is the cheaper one.  The scene must have passed ss_scene_check. */
const char *ss_sim_method_for(const ss_scene *scene);

/* --- as text ------------------------------------------------------------------------------- */

/* Write events as they arrive, one row each, after the notes of head, as ss-sim(1) describes, on out,
 * which the writer does not own.  SS_EINVAL: the format holds numbers only; SS_EIO. */
typedef struct ss_event_writer ss_event_writer;
ss_status ss_event_writer_new(ss_event_writer **writer, FILE *out, ss_format format,
                              const ss_header *head);
ss_status ss_event_writer_row(ss_event_writer *writer, const ss_event *event);
/* Flush out: SS_EIO if any write failed. */
ss_status ss_event_writer_flush(ss_event_writer *writer);
void ss_event_writer_free(ss_event_writer *writer);     /* NULL is allowed; does not flush */

SS_END_DECLARATIONS
#endif
