/* stickslip/trade.h -- the trade between accuracy and time, of a scene's simulation and of a signal's
 * wavelet transform, measured. */
#ifndef STICKSLIP_TRADE_H
#define STICKSLIP_TRADE_H

#include <stddef.h>
#include <stickslip/morlet.h>
#include <stickslip/scene.h>
#include <stickslip/sim.h>

SS_BEGIN_DECLARATIONS

typedef struct ss_trade_row {
    const char *method;
    double tol;                 /* relative local error a step; 0 for exact, which has none */
    ss_status status;           /* SS_OK: measured; SS_EBUDGET: too long, seconds is an estimate;
                                   SS_ETOL, SS_ECHATTER: the method gave up */
    double error_x, error_a;    /* worst in the record over max|x| and max|a|; error_a leaves out
                                   samples nearer to an event than that event's own error */
    double error_t;             /* worst of an event's time [s] */
    size_t missed, invented;    /* events in the record */
    unsigned long steps, rhs;
    double seconds;             /* CPU time of one run */
    int frontier;               /* no other row is faster and as accurate, or as fast and more accurate */
} ss_trade_row;

typedef struct ss_trade {
    char reference[64];         /* "exact", or two methods that agree */
    double known_x, known_a, known_t;   /* the error of the reference itself, as above: the distance of
                                   two methods, of which one simulates a mass that is larger by its
                                   last bit.  No row has a smaller error */
    size_t samples, events;     /* compared */
    size_t n;
    ss_trade_row *row;
    int transform;              /* 1: of a transform, see ss_trade_transform */
} ss_trade;

typedef struct ss_trade_opts {
    double budget;              /* [s] > 0 of CPU time a row; a run of the reference may take
                                   100 times that, else SS_EBUDGET */
    double target;              /* > 0: give up rows slower than twice the fastest that reaches it */
    ss_progress progress;
} ss_trade_opts;
extern const ss_range ss_trade_accuracies;          /* that ss_trade_choose can keep */
extern const ss_trade_opts ss_trade_defaults;       /* 10 s, no target */

/* Run the scene with every method at tolerances 1e-2, 1e-3, ... 1e-13, on this machine.  A record of
 * more than 20000 samples is measured at a lower rate, which leaves its events as they are.  Rows
 * of up to 0.1 s are timed five more times, in turns, and have their median.  opts may be NULL.
 * SS_STOP if progress asks for it; else as ss_sim_run, about the reference.  To be freed with
 * ss_trade_free. */
ss_status ss_trade_measure(ss_trade **out, const ss_scene *scene, const ss_trade_opts *opts,
                           ss_error *err);
/* Transform n samples with every engine at accuracies 1e-2, 1e-3, ... 1e-13, on this machine, on one
 * thread and on the scales of grid that 1e-13 resolves.  The rows' methods are those
 * of ss-morlet, tol is the accuracy asked for, error_x the worst error of W over the largest |W| of its
 * scale, less the 16 DBL_EPSILON a^1/2 max|x| of rounding that no accuracy promises; there are no
 * events.  The reference is the definition at some 40 translations a scale, its largest |W| among
 * them, samples the number of coefficients compared.  A plan is not part of the time.  As above; and
 * SS_EINVAL or SS_ESCALE as from ss_morlet_new. */
ss_status ss_trade_transform(ss_trade **out, const double *x, size_t n, double rate,
                             const ss_morlet_opts *grid, const ss_trade_opts *opts, ss_error *err);
void ss_trade_free(ss_trade *trade);                /* NULL is allowed */
/* Write it as text: a row a method and tolerance, as ss-trade(1) describes, times as multiples of the
 * fastest; name is what the notes call the scene or signal.  SS_EINVAL: the format holds numbers only;
 * SS_EIO. */
ss_status ss_trade_write(const ss_trade *trade, const char *name, FILE *out, ss_format format);

/* The fastest row that keeps x within accuracy of max|x|, with a margin of 2 and the right events;
 * NULL if there is none. */
const ss_trade_row *ss_trade_cheapest(const ss_trade *trade, double accuracy);

/* Fill in opts->tol so that the worst error of x in the record is at most accuracy, within
 * ss_trade_accuracies, times max|x|, by opts->method or, if that is NULL, by the cheapest.
 *
 * The scene is run against the reference of ss_trade, with at most 20000 samples in memory, from
 * loose to tight tolerances until twice the larger of error and known_x is within accuracy, and
 * there are as many events.  Cheapest is exact where there is a closed form, else the least
 * right-hand sides, weighed: a choice that does not change from run to run.  opts->max_steps bounds
 * every run, and opts->progress is called with 0.
 *
 * SS_ETOL if rounding or the method forbids it, SS_EBUDGET if the method would need more than 300
 * times the reference's steps, both with what was reached; else as ss_sim_run. */
ss_status ss_trade_choose(ss_sim_opts *opts, const ss_scene *scene, double accuracy, ss_error *err);

/* --- simpler models ------------------------------------------------------------------------ */

/* The compared numbers of a scene and of a simpler one in its place: the largest and the root mean
 * square error of x - U t, v, a and f in the record, over the largest value of the scene; the
 * largest and the rms difference of the contour maps of a, the rms over the drawn area [dB]; the
 * difference of the numbers of events and of micro-slips (slips that a slip in the same direction
 * precedes) in the record; and the relative error of each number of ss_features of a, found with
 * the scene's mass and stiffness and its x and f. */
enum { SS_COMPARED_EVENTS = 10, SS_COMPARED_MICROSLIPS, SS_COMPARED = 23 };
const char *ss_compared_name(size_t i);             /* "x", "x_rms", ...; NULL from SS_COMPARED on */
const char *ss_compared_unit(size_t i);             /* "dB"; "" if it is a number */

enum { SS_MODELS_SCENE, SS_MODELS_SETTLED, SS_MODELS_SIMPLER };    /* rows; from the last on, the simpler */
typedef struct ss_models_row {
    const char *name;           /* of ss_scene_simpler, or "settled"; of the first row: its model */
    ss_scene scene;
    ss_status status;           /* SS_OK, or why there is no such row, with the reason */
    ss_error reason;
    double error[SS_COMPARED];  /* NaN where a scene has no such number, or no finite ratio */
    size_t events, microslips;  /* in the record */
    double seconds;             /* CPU time of one run */
} ss_models_row;

typedef struct ss_models {
    size_t samples;             /* compared */
    size_t n;
    ss_models_row *row;
} ss_models;

typedef struct ss_models_opts {
    double span;                /* [dB] > 0 below the largest |W| that the maps show */
    int threads;                /* of the transforms, 1 ... SS_THREADS_MAX */
    ss_progress progress;
} ss_models_opts;
extern const ss_models_opts ss_models_defaults;     /* 80 dB, one thread */

/* Compare a scene with each simpler one that it contains (ss_scene_simpler), and with its own periodic
 * state at the same phase (ss_steady_find), each run in closed form where it has one, else by
 * ss_sim_method_for at 1e-12, and transformed with ss_morlet_defaults.  A simpler scene that cannot be
 * run is a row with its reason.  A record without usable scales has no map.  Times as in
 * ss_trade_measure.  opts may be NULL.  To be freed with ss_models_free; SS_STOP; else as ss_sim_run. */
ss_status ss_models_measure(ss_models **out, const ss_scene *scene, const ss_models_opts *opts,
                            ss_error *err);
void ss_models_free(ss_models *models);             /* NULL is allowed */

typedef struct ss_need {
    size_t what;                /* index of ss_compared_name */
    double within;              /* >= 0, in its unit */
} ss_need;
/* Read a list such as "x=1e-2,a=0.1,map=3dB,microslips": name=error, or the name alone of a count
 * that must not change.  need has room for SS_COMPARED; *n is their number. */
ss_status ss_needs_parse(ss_need need[SS_COMPARED], size_t *n, const char *list, ss_error *err);

/* 1 if a row keeps all the needs. */
int ss_models_keeps(const ss_models_row *row, const ss_need *need, size_t n);
/* The cheapest row that keeps the needs; among rows whose costs differ by less than a fifth, the
 * one that lost most.  The settled state does not count: it is the same model. */
const ss_models_row *ss_models_cheapest(const ss_models *models, const ss_need *need, size_t n);
/* "coulomb suffices for x within 1 %; a within 10 % needs compliant", to be freed with free().
 * SS_EDATA: the scene itself has no such number, a model without events has no micro-slips. */
ss_status ss_models_answer(char **sentence, const ss_models *models, const ss_need *need, size_t n,
                           ss_error *err);
/* Write a row a scene as ss-trade(1) describes, times as multiples of the first; with needs, n > 0,
 * their answer and which rows keep them.  SS_EINVAL: the format holds numbers only; SS_EIO; as
 * above. */
ss_status ss_models_write(const ss_models *models, const char *name, const ss_need *need, size_t n,
                          FILE *out, ss_format format, ss_error *err);

SS_END_DECLARATIONS
#endif
