/* stickslip/sweep.h -- the periodic state of a scene in numbers, at one point or over a grid. */
#ifndef STICKSLIP_SWEEP_H
#define STICKSLIP_SWEEP_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/scene.h>
#include <stickslip/signal.h>
#include <stickslip/sim.h>
#include <stickslip/table.h>

SS_BEGIN_DECLARATIONS

/* What can be measured, over one period of the motion.  A cycle is a forcing cycle; or if
 * base_frequency is 0 and a base or a surface pulls, the time from one onset of stick to the next
 * (compliant: of a microstick after a slip), or of a model without sticks from one time at which the mass
 * becomes slower than the pull to the next.  A model without sticks has no stops, no stick
 * fraction and no micro-slips.  Only the compliant and the state-variable model have a transition.
 */
typedef enum ss_measure {
    SS_STOPS,           /* sticks (compliant: microsticks) that begin, per cycle */
    SS_STICK_FRACTION,  /* part of the time that the mass sticks */
    SS_AMPLITUDE,       /* (max x - min x) / 2 [m] */
    SS_X_MAX,           /* max|x| [m] */
    SS_V_MAX,           /* max|v| [m/s] */
    SS_A_MAX,           /* max|a| [m/s^2] */
    SS_ENERGY,          /* work against friction per cycle [J] */
    SS_PERIOD,          /* in cycles; 0: aperiodic */
    SS_CYCLES,          /* cycles until the motion is periodic, from the scene's initial state, or
                           without forcing from the first onset of stick */
    SS_MICROSLIPS,      /* slips that a slip in the same direction follows, per half-cycle */
    SS_TRANSITION,      /* frequency [Hz] from the times between extrema of a, in transitions with at
                           least three; a transition is a microstick, or a time with |alpha v| < 1 */
    SS_X_PHASE,         /* x - U t at the start of a cycle [m]; with the next, it tells basins apart */
    SS_V_PHASE,         /* v at the start of a cycle [m/s] */
    SS_FLOQUET,         /* modulus of the largest Floquet multiplier of the period */
    SS_FLOQUET_2,       /* modulus of the second largest */
    SS_FLOQUET_ANGLE,   /* argument of the largest, 0 ... pi [rad] */
    SS_CYCLE_TIME,      /* duration of a cycle [s]; the motion repeats after so many times SS_PERIOD */
    /* The errors of the model that is the limit of the scene's model (Coulomb's, see
     * ss_scene_simpler): the largest and the rms error of x - U t, v, a and f, over the scene's
     * largest value. */
    SS_MODEL_ERROR_X, SS_MODEL_ERROR_X_RMS,
    SS_MODEL_ERROR_V, SS_MODEL_ERROR_V_RMS,
    SS_MODEL_ERROR_A, SS_MODEL_ERROR_A_RMS,
    SS_MODEL_ERROR_F, SS_MODEL_ERROR_F_RMS,
    SS_LYAPUNOV,        /* largest Lyapunov exponent [1/s], without that of a shift in time: the rate at
                           which neighbouring motions separate; negative: they approach */
    SS_LYAPUNOV_ERROR,  /* its standard error; 0 for a periodic motion, whose multiplier gives it */
    /* of the rate-and-state model alone */
    SS_PEAK_VELOCITY,   /* max x' [m/s] */
    SS_FORCE_DROP,      /* the spring's greatest force less its least [N] */
    SS_GROWTH,          /* the rate at which a small difference from the steady slide grows [1/s], negative
                           where it dies out; known without a cycle */
    SS_MEASURES
} ss_measure;

const ss_label *ss_measure_label(ss_measure measure);      /* "v_max", "m/s"; NULL from SS_MEASURES on */

/* The way in which the periodic state is found. */
typedef enum ss_search {
    SS_SEARCH_AUTO,         /* simulate until the motion is nearly periodic, then shoot; if this fails,
                               or SS_CYCLES is wanted, simulate to the end */
    SS_SEARCH_SIMULATE,
    SS_SEARCH_SHOOT         /* shoot at once for a period of one cycle; it may differ from the one to
                               which the scene settles.  Without a stable one, simulate */
} ss_search;

typedef struct ss_steady_opts {
    size_t size;                /* set by ss_steady_opts_init */
    unsigned measures;          /* the measures wanted: a set of 1u << ss_measure */
    double tol;                 /* within ss_steady_tolerances; see ss_steady_find */
    int max_period;             /* the longest period that is searched, 1 ... SS_PERIOD_MAX cycles */
    unsigned long max_cycles;   /* > 0: a motion that has no period by then is aperiodic; without forcing,
                                   a motion slides on if it does not stick for so many own periods */
    unsigned long settle;       /* > 0: simulate so many cycles instead of searching for the limit */
    int strobe;                 /* how many starts of cycles are wanted of a motion without a period, at
                                   most SS_STROBE_MAX; a periodic one gives all of its period; 0: none */
    ss_search search;
    const char *method;         /* of ss_sim_method_name; NULL: exact if the model is linear, else that
                                   of ss_sim_method_for */
    unsigned long max_steps;    /* > 0: stop after so many steps, or after 20 times as many right-hand
                                   sides; in one cycle after a tenth of them, but at least 10^6, where
                                   the tolerance forces short steps */
} ss_steady_opts;
enum { SS_PERIOD_MAX = 64, SS_STROBE_MAX = 1000 };
extern const ss_range ss_steady_tolerances;     /* of tol */
/* No measures, 1e-9, 8, 10000, 0, simulation and shooting, 10^7 steps.  size: sizeof (ss_steady_opts). */
void ss_steady_opts_init(ss_steady_opts *opts, size_t size);

/* A point of the stroboscopic map. */
typedef struct ss_strobe {
    double x, v;                /* x - U t [m] and v [m/s] at the start of a cycle */
} ss_strobe;

typedef struct ss_steady {
    ss_strobe *strobe;          /* an array of the caller; if opts->strobe > 0, it has room for the larger
                                   of opts->strobe and opts->max_period */
    size_t n_strobes;
    double value[SS_MEASURES];  /* NaN for a measure that is not wanted or not known */
} ss_steady;

/* Find the periodic state to which the scene settles from its initial state, and measure it.
 * Settle, duration and rate of the scene have no influence.
 *
 * The state (x - U t, v, and y or theta) at the start of each cycle is compared with the state 1,
 * 2, ... max_period cycles before.  The unit of x is the largest of Z_e, |x0|, |v0|/omega_n and
 * f_k/k; that of v is this times omega_n or Omega; that of y is f_k/K_y, and that of theta f_k.  With rate and
 * state a N/k is that of x, and ln V and ln theta stand in place of v and y.
 * The motion is periodic when the difference is at most tol and the state lies within tol of its
 * limit, as the rate at which the differences shrink tells.  In shooting, Newton's last step and
 * residual are at most tol.
 *
 * Without forcing, only x - U t differs from one onset of stick to the next.  All true sticks end
 * at the same x - U t, so the multipliers are 0.  An elastic contact needs the method exact or
 * taylor for shooting, multipliers and exponents.
 *
 * The Lyapunov exponent of a periodic motion is that of its largest multiplier; -infinity if this
 * is 0 or hidden by rounding, for example because a stick ends every difference.  The exponent of
 * another motion is a mean over max_cycles (or settle) further cycles (Benettin et al. 1980); its
 * error is the scatter among 20 parts of them.
 *
 * SS_OK: every measure wanted is known.  SS_EDATA: one is not known or not reliable, and err says
 * why; the others are known.  For example, an aperiodic motion is measured over max_period cycles,
 * and the number of events is unreliable if some are unresolved (ss_sim_stats); without forcing, a
 * motion that never sticks has no value at all.  SS_EINVAL: nothing drives the motion, so there
 * are no cycles.  With any other error, which is one of ss_sim_run, no measure is known. */
ss_status ss_steady_find(ss_steady *steady, const ss_scene *scene, const ss_steady_opts *opts,
                         ss_error *err);

/* --- a grid ----------------------------------------------------------------------------------- */

typedef struct ss_axis {
    char key[32];               /* the name of a number of the scene */
    double from, to;
    size_t n;                   /* >= 1: the number of values; from and to are among them */
    int log;                    /* 1: the values have equal ratios, from and to are > 0; 0: they have
                                   equal differences */
} ss_axis;

/* Read "key=from:to:n" or "key=from:to:n:log". */
ss_status ss_axis_parse(ss_axis *axis, const char *text, ss_error *err);

typedef struct ss_sweep_row {
    size_t index;               /* of the point in the grid, whose last axis varies fastest */
    const double *vary;         /* a value for each axis */
    ss_steady steady;
    ss_status status;           /* of ss_steady_find */
    const char *reason;         /* "ok", or why a measure is missing; it has no tab or newline */
} ss_sweep_row;

/* A sink receives rows in grid order, one at a time, from any of the threads.  A non-zero return
 * ends the sweep with SS_STOP. */
typedef int ss_sweep_sink(const ss_sweep_row *row, void *user);

typedef struct ss_sweep_opts {
    size_t size;                /* set by ss_sweep_opts_init */
    const ss_steady_opts *steady;       /* NULL: its defaults */
    const ss_axis *axis;        /* n_axes of them */
    size_t n_axes;
    size_t shard, shards;       /* compute only the points with index mod shards = shard; shards >= 1 */
    size_t first;               /* leave out so many of these points */
    int threads;                /* 1 ... SS_THREADS_MAX */
    ss_sweep_sink *sink;
    void *user;                 /* passed to the sink */
    ss_progress progress;       /* called as the sink is */
} ss_sweep_opts;
/* No axes, which is one point, all points, one thread.  size: sizeof (ss_sweep_opts). */
void ss_sweep_opts_init(ss_sweep_opts *opts, size_t size);

/* SS_EINVAL if no point can be computed: the model lacks the number of an axis or a measure, an
 * axis belongs to the record, or an option is out of its range. */
ss_status ss_sweep_check(const ss_scene *scene, const ss_sweep_opts *opts, ss_error *err);

/* Compute the points of the grid and send a row for each to the sink.  A point depends on the
 * scene alone, so the rows are the same with any threads and shards.  A point that fails has a row
 * with its reason.  SS_ENOMEM, SS_STOP, or SS_EINVAL as from ss_sweep_check end the sweep. */
ss_status ss_sweep_run(const ss_scene *scene, const ss_sweep_opts *opts, ss_error *err);

/* --- as text ---------------------------------------------------------------------------------- */

/* The text of a sweep. */
typedef struct ss_sweep_text {
    const char *name;           /* of the scene */
    const ss_scene *scene;
    const ss_sweep_opts *opts;  /* those of ss_sweep_run; the measures of columns are added to theirs */
    const ss_measure *measure;  /* the measures that have a column, in this order; n_measures 0: of stops, stick,
                                   amplitude, v_max, a_max, energy and period those that the model has */
    size_t n_measures;
    ss_format format;           /* one that holds words */
} ss_sweep_text;

/* What has been done. */
typedef struct ss_sweep_done {
    size_t kept;                /* points that a file had already */
    size_t rows, failed;        /* points that were computed, and those of them that are not complete */
} ss_sweep_done;

/* Compute the sweep, whose sink is not used, and write its text: a header, which holds everything on which the
 * rows depend, and nothing else, and a row for each point; if starts of cycles are wanted, one for each, with
 * its own x_phase and v_phase.
 *
 * resumed: NULL; or the name of a file, open for reading and writing, that is empty or has the beginning of such
 * a text, which may have been cut off anywhere.  Its whole rows are kept.  The last one is computed again if the
 * format has no notes to say of what scene it is, and so are those of a last point with several.
 *
 * SS_EINVAL: a field is missing, or the format holds numbers only; SS_EDATA: the file has not rows of this sweep,
 * and is left as it was; SS_EIO; other errors as from ss_sweep_run. */
ss_status ss_sweep_write(const ss_sweep_text *sweep, FILE *out, const char *resumed, ss_sweep_done *done,
                         ss_error *err);

SS_END_DECLARATIONS
#endif
