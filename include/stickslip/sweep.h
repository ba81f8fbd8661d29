/* stickslip/sweep.h -- the periodic state of a scene in numbers, at one point or over a grid. */
#ifndef STICKSLIP_SWEEP_H
#define STICKSLIP_SWEEP_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/scene.h>
#include <stickslip/signal.h>
#include <stickslip/sim.h>

SS_BEGIN_DECLARATIONS

/* Measures are those of one period of the motion.  A cycle is a forcing cycle; where base_frequency is 0
 * but a base or a surface pulls, it goes from one onset of stick (compliant: of microstick after a slip) to
 * the next.  A model without sticks has no stops, stick and microslips; only compliant contact has a transition, or the state
 * variable. */
typedef enum ss_measure {
    SS_STOPS,           /* sticks (compliant: microsticks) that begin, a cycle */
    SS_STICK_FRACTION,  /* part of the time that is stick */
    SS_AMPLITUDE,       /* half of max x - min x [m] */
    SS_X_MAX,           /* max|x| [m] */
    SS_V_MAX,           /* max|v| [m/s] */
    SS_A_MAX,           /* max|a| [m/s^2] */
    SS_ENERGY,          /* work against friction a cycle [J] */
    SS_PERIOD,          /* in cycles; 0: aperiodic */
    SS_CYCLES,          /* from the scene's initial state, or without forcing from the first onset of
                           stick, until it is periodic */
    SS_MICROSLIPS,      /* slips followed by one in the same direction, a half-cycle */
    SS_TRANSITION,      /* from the times between extrema of a in transitions that have three or
                           more of them: microsticks, or where |alpha v| < 1 [Hz] */
    SS_X_PHASE,         /* x - U t and v at the start of a cycle, which distinguish basins [m] */
    SS_V_PHASE,         /* [m/s] */
    SS_FLOQUET,         /* modulus of the largest Floquet multiplier of the period */
    SS_FLOQUET_2,       /* of the next */
    SS_FLOQUET_ANGLE,   /* argument of the largest, 0 ... pi [rad] */
    SS_CYCLE_TIME,      /* duration of a cycle, which times the period is that of the motion [s] */
    SS_MODEL_ERROR_X, SS_MODEL_ERROR_X_RMS,     /* of the model that the scene comes to in the limit */
    SS_MODEL_ERROR_V, SS_MODEL_ERROR_V_RMS,     /* (ss_scene_simpler: Coulomb's) in its place: the */
    SS_MODEL_ERROR_A, SS_MODEL_ERROR_A_RMS,     /* largest and the rms error of x - U t, v, a and f */
    SS_MODEL_ERROR_F, SS_MODEL_ERROR_F_RMS,     /* over the scene's largest value */
    SS_LYAPUNOV,        /* largest Lyapunov exponent [1/s]: the rate at which neighbouring motions part, or
                           if below 0 come together, a shift in time aside */
    SS_LYAPUNOV_ERROR,  /* its standard error; 0 of a periodic motion, whose multiplier gives it */
    SS_MEASURES
} ss_measure;

const char *ss_measure_name(ss_measure measure);    /* "stops"; NULL from SS_MEASURES on */
const char *ss_measure_unit(ss_measure measure);    /* "m/s"; "" if it is a number */

/* The way in which the periodic state is sought. */
typedef enum ss_search {
    SS_SEARCH_AUTO,         /* simulate until the motion is near a period, then shoot; simulate on where
                               that fails, and always where SS_CYCLES is wanted */
    SS_SEARCH_SIMULATE,
    SS_SEARCH_SHOOT         /* at once: a period of one cycle, which may be another than the one that
                               the scene settles to; simulate where there is none that is stable */
} ss_search;

typedef struct ss_steady_opts {
    unsigned measures;          /* wanted: a set of 1u << ss_measure */
    double tol;                 /* see ss_steady_find */
    int max_period;             /* the longest period that is searched, 1 ... SS_PERIOD_MAX cycles */
    unsigned long max_cycles;   /* > 0: a motion without a period by then is aperiodic; without forcing,
                                   one without a stick for so many own periods slides on */
    unsigned long settle;       /* > 0: simulate so many cycles instead of searching for the limit */
    int strobe;                 /* starts of cycles that are wanted of a motion without a period, at most
                                   SS_STROBE_MAX; of a periodic one, all of its period; 0: none */
    ss_search search;
    const char *method;         /* of ss_sim_method_name; NULL: exact where there is one,
                                   else as ss_sim_run chooses */
    unsigned long max_steps;    /* > 0: stop after so many, or after 20 right-hand sides for
                                   each of them; and in a cycle after a tenth of them,
                                   10^6 at least, where the tolerance forces short steps */
} ss_steady_opts;
enum { SS_PERIOD_MAX = 64, SS_STROBE_MAX = 1000 };
extern const ss_range ss_steady_tolerances;     /* of tol */
extern const ss_steady_opts ss_steady_defaults; /* 1e-9, 8, 10000, 0, simulation, 10^7 steps */

/* A point of the stroboscopic map. */
typedef struct ss_strobe {
    double x, v;                /* x - U t [m] and v [m/s] at the start of a cycle */
} ss_strobe;

typedef struct ss_steady {
    ss_strobe *strobe;          /* the caller's room, for the larger of strobe and max_period of opts where
                                   they are wanted */
    size_t n_strobes;
    double value[SS_MEASURES];  /* NaN for a measure that is not wanted or absent */
} ss_steady;

/* Find the periodic state that the scene settles to, from its initial state on, and measure it.
 *
 * The state (x - U t, v, and y or theta) at the start of each cycle is compared with that of 1,
 * 2, ... max_period cycles before: x in units of the largest of Z_e, |x0|, |v0|/omega_n and f_k/k,
 * v in those times omega_n or Omega, y in f_k/K_y, theta in f_k.  It is periodic when the difference is
 * at most tol and the state, by the rate at which the differences shrink, lies within tol of its
 * limit.  By shooting,
 * Newton's last step and residual are at most tol.  Settle, duration and rate of the scene do not
 * matter.
 *
 * Without forcing, x - U t is what differs at an onset.  True sticks end all at the same x - U t, so the
 * multipliers are 0; an elastic contact needs the methods exact or taylor for shooting, multipliers
 * and exponents.
 *
 * The exponent of a periodic motion is that of its largest multiplier, and is absent where this is 0 or
 * hidden by rounding, as where a stick ends every difference.  That of another is a mean over max_cycles (or settle)
 * cycles more (Benettin et al. 1980), its error the scatter among 20 parts of them.
 *
 * SS_OK: all that was asked for is there.  SS_EDATA: something is not, and err says why, as for
 * an aperiodic motion, which is measured over max_period cycles, or cannot be relied on, as the
 * number of events that are not resolved (ss_sim_stats); without forcing, a motion that never sticks has
 * no value.  SS_EINVAL: there are no cycles, since nothing drives them.  Else as ss_sim_run, nothing is
 * there. */
ss_status ss_steady_find(ss_steady *steady, const ss_scene *scene, const ss_steady_opts *opts,
                         ss_error *err);
/* SS_EINVAL if that is impossible for the model: a measure that it does not have, a range. */
ss_status ss_steady_check(const ss_steady_opts *opts, ss_model model, ss_error *err);

/* --- a grid ----------------------------------------------------------------------------------- */

typedef struct ss_axis {
    char key[32];               /* a number of the scene */
    double from, to;
    size_t n;                   /* >= 1 values, both ends among them */
    int log;                    /* equal ratios instead of differences; from and to > 0 */
} ss_axis;

/* From "key=from:to:n" or "key=from:to:n:log". */
ss_status ss_axis_parse(ss_axis *axis, const char *text, ss_error *err);
double ss_axis_value(const ss_axis *axis, size_t i);

typedef struct ss_sweep_row {
    size_t index;               /* in the grid, whose last axis varies fastest */
    const double *vary;         /* one value an axis */
    ss_steady steady;
    ss_status status;           /* of ss_steady_find */
    const char *reason;         /* "ok", or why something is missing; no tab or newline */
} ss_sweep_row;

/* Receives rows in grid order, one at a time, from any of the threads.  A non-zero return ends the
 * sweep with SS_STOP. */
typedef int ss_sweep_sink(const ss_sweep_row *row, void *user);

typedef struct ss_sweep_opts {
    ss_steady_opts steady;
    const ss_axis *axis;
    size_t n_axes;
    size_t shard, shards;       /* the points of which the index is shard modulo shards >= 1 */
    size_t first;               /* the first of these that is wanted, counted from 0 */
    int threads;                /* 1 ... SS_THREADS_MAX */
    ss_sweep_sink *sink;
    void *user;                 /* passed to the sink */
    ss_progress progress;       /* called as the sink is */
} ss_sweep_opts;

/* The number of points in the grid; SS_EINVAL if there are none or too many. */
ss_status ss_sweep_points(const ss_sweep_opts *opts, size_t *n, ss_error *err);

/* SS_EINVAL if no point can be computed: an axis that the model does not have or that belongs
 * to the record, a measure, a range. */
ss_status ss_sweep_check(const ss_scene *scene, const ss_sweep_opts *opts, ss_error *err);

/* Every point is computed from the scene alone, so the rows do not depend on threads and shards.
 * A point that fails is a row with its reason; SS_ENOMEM, SS_EINVAL as from ss_sweep_check, or SS_STOP
 * end the sweep. */
ss_status ss_sweep_run(const ss_scene *scene, const ss_sweep_opts *opts, ss_error *err);

/* --- as text ---------------------------------------------------------------------------------- */

/* The columns of the rows of a sweep, and their header. */
typedef struct ss_sweep_text {
    const char *name;           /* of the scene */
    const ss_scene *scene;
    const ss_sweep_opts *opts;  /* that the sweep is run with */
    const ss_measure *measure;  /* a column each, in this order */
    size_t n_measures;
    ss_format format;           /* one that holds words */
} ss_sweep_text;

/* All that the rows depend on and nothing else, to be freed with free(): files with the same header are
 * parts of the same sweep.  SS_EINVAL: something is missing, or the format holds numbers only. */
ss_status ss_sweep_header(char **header, const ss_sweep_text *sweep);
/* One row, or where strobe is wanted a row for each start of a cycle: x_phase and v_phase are those of it. */
ss_status ss_sweep_row_write(const ss_sweep_text *sweep, const ss_sweep_row *row, FILE *out);
/* How far a file of such rows has come, which may have been cut off anywhere: *rows whole ones of the
 * shard of opts, which is the first that is wanted then, and they end at byte *end, from which on to
 * write; 0: with the header.  Reads file from where it stands, its start.  SS_EDATA: these are not the
 * rows of this sweep; SS_EIO. */
ss_status ss_sweep_resume(const ss_sweep_text *sweep, FILE *file, const char *name, size_t *rows,
                          long *end, ss_error *err);

SS_END_DECLARATIONS
#endif
