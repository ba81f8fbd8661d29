/* stickslip/trade.h -- measure the accuracy and the time of a scene's simulation and of a signal's
 * wavelet transform, for every method and tolerance. */
#ifndef STICKSLIP_TRADE_H
#define STICKSLIP_TRADE_H

#include <stddef.h>
#include <stickslip/features.h>
#include <stickslip/morlet.h>
#include <stickslip/scene.h>
#include <stickslip/sim.h>

SS_BEGIN_DECLARATIONS

typedef struct ss_trade_row {
    const char *method;
    double tol;                 /* relative local error of a step; 0 for exact, which has no tolerance */
    ss_status status;           /* SS_OK: measured; SS_EBUDGET: the run takes too long, seconds is an
                                   estimate; SS_ETOL, SS_ECHATTER: the method gave up */
    double error_x, error_a;    /* largest error in the record over max|x| and over max|a|; error_a
                                   leaves out samples nearer to an event than the error of its time */
    double error_t;             /* largest error of an event's time [s] */
    size_t missed, invented;    /* events that only the reference has, and that only this run has */
    unsigned long steps, rhs;   /* steps and right-hand sides of one run */
    double seconds;             /* CPU time of one run */
    int frontier;               /* 1: no other row is faster without a larger error, or has a
                                   smaller error without more time */
} ss_trade_row;

typedef struct ss_trade {
    char reference[64];         /* "exact", or the names of two methods that agree */
    double known_x, known_a, known_t;   /* errors of the reference, in the units of the rows: the
                                   distance of two methods, one of which simulates a mass that is larger
                                   by its last bit.  No row has a smaller error */
    size_t samples, events;     /* of the record, that were compared */
    size_t n;
    ss_trade_row *row;
    int transform;              /* 1: the rows are those of ss_trade_transform */
} ss_trade;

typedef struct ss_trade_opts {
    size_t size;                /* set by ss_trade_opts_init */
    double budget;              /* [s] > 0: CPU time of a row; a run of the reference may take 100
                                   times as long, else SS_EBUDGET */
    double target;              /* > 0: an error; rows slower than twice the fastest row that reaches it
                                   are given up; 0: none is */
    double span;                /* [dB] > 0: the maps of ss_models_measure show |W| from this far below the largest
                                   on */
    int threads;                /* of its transforms, 1 ... SS_THREADS_MAX */
    ss_progress progress;
} ss_trade_opts;
extern const ss_range ss_trade_accuracies;          /* the accuracies that ss_trade_choose can keep */
/* 10 s, no target, 80 dB, one thread.  size: sizeof (ss_trade_opts). */
void ss_trade_opts_init(ss_trade_opts *opts, size_t size);

/* Run the scene with every method at the tolerances 1e-2, 1e-3, ... 1e-13, on this machine.  A
 * record of more than 20000 samples is compared at a lower rate; its events stay the same.  A row
 * that takes at most 0.1 s is timed five more times, in turns with the others, and has the median.
 * opts may be NULL.  The caller frees *out with ss_trade_free.  SS_STOP: progress asked for it;
 * other errors are those of ss_sim_run for the reference. */
ss_status ss_trade_measure(ss_trade **out, const ss_scene *scene, const ss_trade_opts *opts,
                           ss_error *err);
/* Transform n samples with both engines on this machine, with one thread, at the scales of grid that the
 * accuracy 1e-13 resolves.
 *
 * The method of a row is "quadrature" or "fft", and tol is 0: an accuracy changes neither error nor time.
 * error_x is the largest error of W over the largest |W| of its scale, less the 16 DBL_EPSILON
 * a^1/2 max|x| of rounding, which no accuracy includes.  There are no events.  The reference is
 * the definition at some 40 translations of each scale, among them that of the largest |W|;
 * samples is the number of coefficients compared.  Making the plan does not count as time.  Errors
 * as above, and SS_EINVAL or SS_ESCALE as from ss_morlet_new. */
ss_status ss_trade_transform(ss_trade **out, const double *x, size_t n, double rate,
                             const ss_morlet_opts *grid, const ss_trade_opts *opts, ss_error *err);
void ss_trade_free(ss_trade *trade);                /* NULL is allowed */
/* Write a text that has a row for each method and tolerance, as ss-trade(1) describes; times are
 * multiples of the fastest row's.  The notes call the scene or signal by name.  SS_EINVAL: the
 * format holds numbers only; SS_EIO. */
ss_status ss_trade_write(const ss_trade *trade, const char *name, FILE *out, ss_format format, ss_error *err);

/* The fastest row that has no wrong events and whose error of x is at most half of accuracy,
 * relative to max|x|; NULL if there is none. */
const ss_trade_row *ss_trade_cheapest(const ss_trade *trade, double accuracy);

/* Choose opts->tol so that the largest error of x in the record is at most accuracy times max|x|.
 * accuracy lies within ss_trade_accuracies.  If opts->method is NULL, choose it too.
 *
 * The scene is run and compared with the reference of ss_trade, with at most 20000 samples in
 * memory, from loose to tight tolerances, until twice the larger of error and known_x is within
 * accuracy and the number of events is right.  The method chosen is exact if there is a closed
 * form, else the one with the least weighted number of right-hand sides; so every run makes the
 * same choice.  opts->max_steps bounds each run, and opts->progress is called with 0.
 *
 * SS_ETOL: rounding or the method forbids this accuracy; SS_EBUDGET: the method would need more
 * than 300 times the steps of the reference; in both cases err names the accuracy reached.  Other
 * errors are those of ss_sim_run. */
ss_status ss_trade_choose(ss_sim_opts *opts, const ss_scene *scene, double accuracy, ss_error *err);

/* --- simpler models ------------------------------------------------------------------------ */

/* The numbers in which a scene and a simpler scene are compared:
 * - the largest and the rms error of x - U t, v, a and f in the record, over the largest value of
 *   the scene;
 * - the largest and the rms difference of the contour maps of a [dB], the rms over the drawn area;
 * - the difference of the numbers of events and of micro-slips in the record (a micro-slip follows
 *   a slip in the same direction);
 * - the relative error of each number of ss_features that is no count of rows and no median over falls,
 *   found in a with the scene's mass and stiffness and its columns x and f. */
enum { SS_COMPARED_EVENTS = 10, SS_COMPARED_MICROSLIPS, SS_COMPARED_FEATURES,
       SS_COMPARED_MOST = SS_COMPARED_FEATURES + SS_FEATURE_NUMBERS };

/* Indices of rows; from SS_MODELS_SIMPLER on, the rows are the simpler scenes. */
enum { SS_MODELS_SCENE, SS_MODELS_SETTLED, SS_MODELS_SIMPLER };
typedef struct ss_models_row {
    const char *name;           /* the scene's model, "settled", or the name of ss_scene_simpler */
    ss_scene scene;
    ss_status status;           /* SS_OK; else this scene could not be run */
    ss_error reason;            /* why it could not */
    double error[SS_COMPARED_MOST];  /* NaN where a scene has no such number, or the ratio is not finite */
    size_t events, microslips;  /* in the record */
    double seconds;             /* CPU time of one run */
} ss_models_row;

typedef struct ss_models {
    size_t samples;             /* of the record, that were compared */
    size_t n;
    ss_models_row *row;
} ss_models;

/* Compare a scene with each simpler scene that it contains (ss_scene_simpler), and with its own
 * periodic state at the same phase (ss_steady_find).  Each is run in closed form if it has one,
 * else by ss_sim_method_for at 1e-12, and transformed with the default options.  A simpler scene
 * that cannot be run has a row with the reason.  A record without usable scales has no map.  Times
 * are measured as by ss_trade_measure.  opts may be NULL.  The caller frees *out with
 * ss_models_free.  SS_STOP; other errors are those of ss_sim_run. */
ss_status ss_models_measure(ss_models **out, const ss_scene *scene, const ss_trade_opts *opts,
                            ss_error *err);
void ss_models_free(ss_models *models);             /* NULL is allowed */

/* An error that a user allows. */
typedef struct ss_need {
    size_t what;                /* the place of its error among those of a row */
    double within;              /* >= 0, in dB for the maps */
} ss_need;
/* Read a list such as "x=1e-2,a=0.1,map=3dB,microslips": name=error, or the name alone of a count
 * that must not change.  *n becomes their number. */
ss_status ss_needs_parse(ss_need need[SS_COMPARED_MOST], size_t *n, const char *list, ss_error *err);

/* Write a sentence such as "coulomb suffices for x within 1 %; a within 10 % needs compliant".  The
 * caller frees it with free().  SS_EDATA: the scene itself has no such number; for example, a model
 * without events has no micro-slips. */
ss_status ss_models_answer(char **sentence, const ss_models *models, const ss_need *need, size_t n,
                           ss_error *err);
/* Write a text that has a row for each scene, as ss-trade(1) describes; times are multiples of the
 * first row's.  If n > 0, it has the answer to the needs and says which rows keep them.
 * SS_EINVAL: the format holds numbers only; SS_EIO; SS_EDATA as above. */
ss_status ss_models_write(const ss_models *models, const char *name, const ss_need *need, size_t n,
                          FILE *out, ss_format format, ss_error *err);

SS_END_DECLARATIONS
#endif
