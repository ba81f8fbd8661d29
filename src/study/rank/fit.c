/* fit.c -- the compliant scene that moves as a signal does.
 *
 * First the settled cycle of the scene is fitted to the mean cycle of the signal (candidate.c),
 * from the stiffness and damping that the transitions show or, where they show none, from wide
 * about the scene's.  That finds the right motion, but a record seldom is settled to the last
 * digit, and what is not would go into the parameters.  So the motion is then fitted to the record
 * itself, sample by sample, with a start of its own: position and velocity within a slip, where
 * they are all the state there is.
 *
 * A sample that an event crosses as a parameter moves jumps, so the sum of squares has steps.
 * Differences over 1e-3 and 1e-4 have events cross in many places and see the valley; over 1e-6
 * hardly any does, and they lead to its floor, from where the next ones may find a lower.  (Over
 * 1e-4 alone 0.5 % of f_k and 0.02 % of K_y remained without any noise, where all leave 1e-14; at
 * 40 dB fewer passes left 0.2 % of f_k where these leave 0.02 %.)
 *
 * For the same reason a difference over h has (jump / h)^2 too much of a slope where a sample jumps
 * within it, and nothing where none does: the sum of squares rises in proportion to the number of
 * samples that jump, which is linear, and a parabola has the same height only where it is drawn
 * over the same distance.  So the last descents go along the axes of the error ellipsoid, one
 * standard error a step, and standard errors are from there. */
#include <stickslip/rank.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_matrix.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_vector.h>
#include <stickslip/sim.h>
#include "base/error.h"
#include "base/progress.h"
#include "scene/model.h"
#include "study/rank/candidate.h"
#include "signal/gaps.h"

enum { STARTS = 96, KEEP = 6, STEPS = 150 };
enum { CYCLES = 32, MOST = 65536 };     /* of the record that is fitted */
enum { PASSES = 40 };
enum { RUNS = 1000 };                  /* of the scene in one fit, about */
#define FIT_STEPS 1e8                   /* of all runs, 10 times the usual */
#define NEAR 1.5                        /* the features' estimates are that good, as a factor */
#define FAR 10.0
/* Who leaves more of the rms than this, and than MARGIN times its noise, is another model's. */
#define UNEXPLAINED 0.1
#define MARGIN 1.5
#define EXACT 1e-8                      /* of the rms: with less left, errors are of rounding's size,
                                           and so would differences over them be */
#define VAGUE 0.3                       /* a standard error above this part tells nothing */

/* What is adjusted, by its change in the unit given.  Coordinates of a descent stand at 1:
 * differences need numbers of order 1. */
enum { FRICTION, AMPLITUDE, STIFFNESS, DAMPING, FREQUENCY, PHASE, X0, V0, OFFSET, UNKNOWNS };

typedef struct match {
    const double *signal;               /* samples matched */
    const char *missing;                /* of them; NULL: none */
    size_t n, there;                    /* there: those not missing */
    double *motion;                     /* room for as many */
    int pick;
    ss_scene start;                     /* at the first of them, in slip */
    double origin[UNKNOWNS], axis[UNKNOWNS][UNKNOWNS];  /* of the coordinates of a descent */
    double x_unit, v_unit, y_unit;
    ss_stretch progress;
    double runs, expected;              /* so far, and how many there will be at most */
    double steps;                       /* of all runs */
    ss_status status;                   /* SS_ENOMEM once a run lacked memory, SS_STOP when told to,
                                           SS_EBUDGET after too many steps */
} match;

/* Run a scene into m->motion; 0 if it cannot be run. */
static int
run(match *m, const ss_scene *s)
{
    if (m->status == SS_OK)
        m->status = ss_stretch_at(&m->progress, fmin(m->runs++ / m->expected, 1));
    if (m->status == SS_OK && m->steps > FIT_STEPS)
        m->status = SS_EBUDGET;
    if (m->status != SS_OK)
        return 0;
    ss_status st = ss_candidate_run(s, m->pick, m->motion, m->n, &m->steps);
    if (st == SS_ENOMEM)
        m->status = st;
    return st == SS_OK;
}

/* --- motion -------------------------------------------------------------------------------- */

/* The unknowns, as their change from the start, at the coordinates z. */
static void
unknowns_at(const match *m, const gsl_vector *z, double d[UNKNOWNS])
{
    for (size_t i = 0; i < UNKNOWNS; i++) {
        d[i] = m->origin[i];
        for (size_t j = 0; j < UNKNOWNS; j++)
            d[i] += m->axis[i][j] * (gsl_vector_get(z, j) - 1);
    }
}

static ss_scene
scene_at(const match *m, const double d[UNKNOWNS])
{
    ss_scene s = m->start;
    s.friction *= exp(d[FRICTION]);
    s.base_amplitude *= exp(d[AMPLITUDE]);
    s.contact_stiffness *= exp(d[STIFFNESS]);
    s.contact_damping *= exp(d[DAMPING]);
    s.base_frequency *= exp(d[FREQUENCY]);
    s.phase += d[PHASE];
    s.x0 += m->x_unit * d[X0];
    s.v0 += m->v_unit * d[V0];
    return s;
}

static int
residuals(const gsl_vector *z, void *user, gsl_vector *f)
{
    match *m = user;
    double d[UNKNOWNS];
    unknowns_at(m, z, d);
    ss_scene s = scene_at(m, d);
    double offset = m->y_unit * d[OFFSET];
    if (!run(m, &s))
        return GSL_EDOM;
    for (size_t i = 0; i < m->n; i++)
        gsl_vector_set(f, i, m->missing != NULL && m->missing[i] ? 0
                       : m->motion[i] + offset - m->signal[i]);
    return GSL_SUCCESS;
}

/* --- least squares ------------------------------------------------------------------------- */

typedef struct answer {
    double d[UNKNOWNS];                 /* see scene_at */
    gsl_matrix *covariance;
    double left;                        /* mean square; infinite if the motion could not be run */
} answer;

/* The axes scaled by those of the ellipsoid of standard errors (its Cholesky factor), or as they
 * are.  0 if it has none. */
static int
take_axes(match *m, const answer *a, int scaled)
{
    gsl_matrix_view to = gsl_matrix_view_array(m->axis[0], UNKNOWNS, UNKNOWNS);
    memcpy(m->origin, a->d, sizeof m->origin);
    if (!scaled) {
        gsl_matrix_set_identity(&to.matrix);
        return 1;
    }
    gsl_matrix_memcpy(&to.matrix, a->covariance);
    if (gsl_linalg_cholesky_decomp1(&to.matrix) != GSL_SUCCESS)
        return 0;
    for (size_t i = 0; i < UNKNOWNS; i++)
        for (size_t j = i + 1; j < UNKNOWNS; j++)
            m->axis[i][j] = 0;
    return 1;
}

/* From the covariance of coordinates to that of the unknowns: A C A'. */
static void
turn_back(const match *m, gsl_matrix *c)
{
    double half[UNKNOWNS * UNKNOWNS];
    gsl_matrix_view ac = gsl_matrix_view_array(half, UNKNOWNS, UNKNOWNS);
    gsl_matrix_const_view a = gsl_matrix_const_view_array(m->axis[0], UNKNOWNS, UNKNOWNS);
    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, &a.matrix, c, 0, &ac.matrix);
    gsl_blas_dgemm(CblasNoTrans, CblasTrans, 1, &ac.matrix, &a.matrix, 0, c);
}

/* One descent from an answer, with differences over the given step; it only changes if that helps,
 * or for the errors if they are asked for. */
static ss_status
descend(match *m, double step, int errors, answer *a)
{
    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    how.h_df = step;
    how.fdtype = errors ? GSL_MULTIFIT_NLINEAR_CTRDIFF : GSL_MULTIFIT_NLINEAR_FWDIFF;
    gsl_multifit_nlinear_workspace *w =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, m->n, UNKNOWNS);
    gsl_multifit_nlinear_fdf sum = { .f = residuals, .n = m->n, .p = UNKNOWNS, .params = m };
    double ones[UNKNOWNS];
    gsl_vector_view start = gsl_vector_view_array(ones, UNKNOWNS);
    ss_status st = w == NULL ? SS_ENOMEM : SS_OK;
    int why;
    gsl_vector_set_all(&start.vector, 1);
    if (st == SS_OK && gsl_multifit_nlinear_init(&start.vector, &sum, w) == GSL_SUCCESS) {
        /* its verdict does not matter: a rough sum of squares ends in steps that are refused */
        gsl_multifit_nlinear_driver(PASSES, 1e-9, 1e-9, 0, NULL, NULL, &why, w);
        const gsl_vector *r = gsl_multifit_nlinear_residual(w);
        double squares = 0;
        gsl_blas_ddot(r, r, &squares);
        if (squares / (double)m->there < a->left || errors) {
            gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(w), 0, a->covariance);
            gsl_matrix_scale(a->covariance, squares / (double)(m->there - UNKNOWNS));
            turn_back(m, a->covariance);
        }
        if (squares / (double)m->there < a->left) {
            a->left = squares / (double)m->there;
            unknowns_at(m, gsl_multifit_nlinear_position(w), a->d);
        }
    }
    gsl_multifit_nlinear_free(w);
    return st == SS_OK ? m->status : st;
}

/* The answer of least squares. */
static ss_status
solve(match *m, answer *a)
{
    static const double step[] = { 1e-3, 1e-4, 1e-6, 1e-4, 1e-6 };
    enum { LEAST = 3, ROUNDS = 16 };
    ss_status st = SS_OK;
    a->left = INFINITY;
    memset(a->d, 0, sizeof a->d);
    for (size_t i = 0; st == SS_OK && i < sizeof step / sizeof *step; i++) {
        take_axes(m, a, 0);
        st = descend(m, step[i], 0, a);
    }
    /* until the sum of squares falls by less than noise moves it: once in its variance */
    double before = INFINITY;
    if (a->left <= EXACT * EXACT * m->y_unit * m->y_unit)
        return st;
    for (int i = 0; st == SS_OK && isfinite(a->left) && take_axes(m, a, 1) && i < ROUNDS
                    && (i < LEAST || a->left < before * (1 - 1 / (double)m->there)); i++) {
        before = a->left;
        st = descend(m, 1, 1, a);
    }
    return st;
}

/* --- where the record starts --------------------------------------------------------------- */

typedef struct moment {
    ss_sample fastest;                  /* of the samples in slip */
    size_t at, i;
} moment;

static int
find_fastest(const ss_sample *s, size_t n, void *user)
{
    moment *m = user;
    for (size_t i = 0; i < n; i++, m->i++)
        if (s[i].mode != 0 && fabs(s[i].v) > fabs(m->fastest.v)) {
            m->fastest = s[i];
            m->at = m->i;
        }
    return 0;
}

/* Where in the first cycle of the record the scene slips fastest; 0 if it never does. */
static int
find_start(match *m, const ss_scene *settled, const double *x, const char *missing, size_t n)
{
    moment s = { .at = 0 };
    ss_sim_opts opts = { .method = "exact", .tol = 1e-12, .samples = find_fastest, .user = &s };
    ss_scene first = *settled;
    double period = 1 / settled->base_frequency, rate = settled->rate, square = 0;
    first.duration = period;
    m->status = ss_sim_run(&first, &opts, NULL, NULL);
    if (m->status != SS_OK || s.fastest.mode == 0)
        return 0;
    m->signal = x + s.at;
    m->missing = missing != NULL ? missing + s.at : NULL;
    m->n = (size_t)fmin(fmin((double)(n - s.at), CYCLES * period * rate), MOST);
    m->start = *settled;
    m->start.phase += 2 * M_PI * settled->base_frequency * s.fastest.t;
    m->start.settle = 0;
    m->start.duration = (double)m->n / rate;
    m->start.x0 = s.fastest.x;
    m->start.v0 = s.fastest.v;
    m->x_unit = fmax(fabs(s.fastest.x), settled->base_amplitude);
    m->v_unit = fabs(s.fastest.v);
    for (size_t i = 0; i < m->n; i++) {
        int there = m->missing == NULL || !m->missing[i];
        square += there ? m->signal[i] * m->signal[i] : 0;
        m->there += (size_t)there;
    }
    m->y_unit = sqrt(square / fmax((double)m->there, 1));
    return m->there > 2 * UNKNOWNS;
}

/* --- all ----------------------------------------------------------------------------------- */

/* Of the samples that are not missing. */
static double
variance(const double *x, const char *missing, size_t n)
{
    double mean = 0, sum = 0, count = 0;
    for (size_t i = 0; i < n; i++)
        if (missing == NULL || !missing[i])
            mean += x[i], count++;
    mean /= count;
    for (size_t i = 0; i < n; i++)
        if (missing == NULL || !missing[i])
            sum += (x[i] - mean) * (x[i] - mean);
    return sum / count;
}

/* Of the record less the scene's, the offset between them apart. */
static ss_status
residual_of(double *residual, const ss_scene *scene, int pick, const double *x,
            const char *missing, size_t n)
{
    double *y = malloc((n + 1) * sizeof *y);
    if (y == NULL)
        return SS_ENOMEM;
    *residual = NAN;
    double steps = 0;
    ss_status st = ss_candidate_run(scene, pick, y, n, &steps);
    for (size_t i = 0; st == SS_OK && i < n; i++)
        y[i] -= x[i];
    if (st == SS_OK)
        *residual = sqrt(variance(y, missing, n) / variance(x, missing, n));
    free(y);
    return st == SS_ENOMEM ? st : SS_OK;
}

/* Stiffness and damping from the transitions, if they tell; the rms of the noise. */
static ss_status
narrow(candidate *c, double *noise, const ss_signal *signal, size_t column, ss_error *err)
{
    ss_features *f = NULL;
    ss_features_opts opts = ss_features_defaults;
    opts.mass = c->scene.mass;
    opts.stiffness = c->scene.stiffness;
    ss_status st = ss_features_find(&f, signal, column, &opts, err);
    if (st != SS_OK)
        return st;
    const double estimate[2] = { f->contact_stiffness.value, f->contact_damping.value };
    *noise = f->noise;
    ss_features_free(f);
    for (size_t i = 0; i < 2; i++) {
        int known = estimate[i] > 0;            /* NaN is not */
        double middle = known ? log(estimate[i]) : c->own[CANDIDATE_OWN + i];
        double width = log(known ? NEAR : FAR);
        c->lo[CANDIDATE_OWN + i] = middle - width;
        c->hi[CANDIDATE_OWN + i] = middle + width;
    }
    return SS_OK;
}

/* The scene of the search settled long enough, in step with the record's first sample. */
static ss_scene
settled_scene(const candidate *c, const cycle *goal, size_t n, double rate)
{
    ss_scene s = ss_candidate_scene(c, goal);
    s.rate = rate;
    s.duration = (double)n / rate;
    return s;
}

static ss_value
scaled(double value, double relative)
{
    return (ss_value){ value, value * relative };
}

static void
report(ss_fit *fit, const ss_scene *s, const gsl_matrix *covariance)
{
    double error[UNKNOWNS];
    for (size_t i = 0; i < UNKNOWNS; i++)
        error[i] = sqrt(gsl_matrix_get(covariance, i, i));

    fit->friction = scaled(s->friction, error[FRICTION]);
    fit->base_amplitude = scaled(s->base_amplitude, error[AMPLITUDE]);
    fit->contact_stiffness = scaled(s->contact_stiffness, error[STIFFNESS]);
    fit->contact_damping = scaled(s->contact_damping, error[DAMPING]);
    fit->base_frequency = scaled(s->base_frequency, error[FREQUENCY]);
}

static ss_status
fit_record(ss_fit *fit, const candidate *c, const cycle *goal, const double *x,
           const char *missing, size_t n, double rate, ss_stretch progress)
{
    double covariance[UNKNOWNS * UNKNOWNS];
    gsl_matrix_view square = gsl_matrix_view_array(covariance, UNKNOWNS, UNKNOWNS);
    answer a = { .covariance = &square.matrix };
    ss_scene settled = settled_scene(c, goal, n, rate);
    match m = { .pick = c->pick, .progress = progress, .expected = RUNS,
                .motion = malloc(n * sizeof *m.motion) };
    if (m.motion == NULL)
        return SS_ENOMEM;
    if (!find_start(&m, &settled, x, missing, n)) {
        snprintf(fit->why, sizeof fit->why, "the motion nearest to it does not slip");
        free(m.motion);
        return m.status == SS_ENOMEM ? SS_ENOMEM : SS_OK;
    }
    gsl_matrix_set_all(a.covariance, NAN);
    ss_status st = solve(&m, &a);
    free(m.motion);
    if (st != SS_OK)
        return st;
    ss_scene s = scene_at(&m, a.d);
    report(fit, &s, a.covariance);
    fit->residual_started = sqrt(a.left / variance(m.signal, m.missing, m.n));
    s.settle = settled.settle;
    s.x0 = s.v0 = 0;
    s.duration = settled.duration;
    /* back to the first sample; whole cycles of settling leave the phase as it is */
    s.phase = remainder(s.phase - 2 * M_PI * s.base_frequency
                        * (double)(m.signal - x) / rate, 2 * M_PI);
    s.settle = CANDIDATE_SETTLE / s.base_frequency;
    st = residual_of(&fit->residual, &s, m.pick, x, missing, n);
    fit->scene = s;
    return st;
}

static void
judge(ss_fit *fit, double noise)
{
    const struct { const char *what; ss_value v; } told[] = {
        { "friction", fit->friction }, { "base_amplitude", fit->base_amplitude },
        { "contact_stiffness", fit->contact_stiffness },
        { "contact_damping", fit->contact_damping } };
    fit->told = 0;
    if (fit->why[0] != '\0')
        return;
    if (!(fit->residual_started <= fmax(UNEXPLAINED, MARGIN * noise))) {
        snprintf(fit->why, sizeof fit->why, "the best compliant scene leaves %.0f %% of the signal",
                 100 * fit->residual_started);
        return;
    }
    for (size_t i = 0; i < sizeof told / sizeof *told; i++)
        if (!(told[i].v.error <= VAGUE * told[i].v.value)) {
            snprintf(fit->why, sizeof fit->why, "%s = %.3g +- %.2g: the signal does not tell it",
                     told[i].what, told[i].v.value, told[i].v.error);
            return;
        }
    fit->told = 1;
}

/* Roughly how the work is divided. */
#define READ 0.05
#define SEARCHED 0.5

static ss_status
fit_signal(ss_fit *fit, const ss_signal *signal, size_t column, const cycle *goal,
           const char *missing, const ss_rank_opts *opts, ss_error *err)
{
    const ss_stretch whole = { opts->progress, 0, 1 };
    const ss_stretch search = ss_stretch_part(&whole, READ, SEARCHED);
    const double *x = signal->values + column * signal->n;
    double noise;
    candidate c = ss_candidate_of(&fit->scene, (int)opts->quantity, 1);
    c.lo[CANDIDATE_STIFFNESS] = c.hi[CANDIDATE_STIFFNESS];      /* k is known */
    c.lo[CANDIDATE_RATIO] = log(0.2);           /* below, sticks are too short to fit */
    c.hi[CANDIDATE_RATIO] = 0;
    ss_status st = narrow(&c, &noise, signal, column, err);
    if (st == SS_OK)
        st = ss_candidate_search(&c, goal, STARTS, KEEP, STEPS, &search);
    if (st == SS_OK)
        st = fit_record(fit, &c, goal, x, missing, signal->n, signal->head->rate,
                        ss_stretch_part(&whole, SEARCHED, 1));
    if (st == SS_EBUDGET)
        return ss_fail(err, st, "scenes like it take too many steps to be fitted");
    if (st == SS_OK)
        judge(fit, noise / sqrt(variance(x, missing, signal->n)));
    return st;
}

static ss_status
check(const ss_signal *signal, size_t column, const ss_scene *start, const ss_rank_opts *opts,
      ss_error *err)
{
    if (column >= signal->head->n_columns)
        return ss_fail(err, SS_EINVAL, "there is no column %zu", column + 1);
    if ((unsigned)opts->quantity > SS_FORCE)
        return ss_fail(err, SS_EINVAL, "the quantity is no known choice");
    if (!(opts->forcing_frequency >= 0 && isfinite(opts->forcing_frequency)))
        return ss_fail(err, SS_EINVAL, "forcing frequency %g is out of range",
                       opts->forcing_frequency);
    if (ss_model_of(start) == NULL || !ss_model_of(start)->has_contact)
        return ss_fail(err, SS_EINVAL, "only compliant scenes are fitted, not %s",
                       ss_model_name(start->model));
    for (size_t i = 0; i < signal->n; i++)
        if (!isfinite(signal->values[column * signal->n + i]))
            return ss_fail(err, SS_EDATA, "row %zu is not finite", i + 1);
    return ss_candidate_check(start, err);
}

ss_status
ss_scene_fit(ss_fit *fit, const ss_signal *signal, size_t column, const ss_scene *start,
             const ss_rank_opts *opts, ss_error *err)
{
    if (fit == NULL || signal == NULL || start == NULL)
        return SS_FAIL_NULL(err);
    if (opts == NULL)
        opts = &ss_rank_defaults;
    ss_status st = check(signal, column, start, opts, err);
    const double *x = signal->values + column * signal->n;
    double rate = signal->head->rate;
    const ss_stretch at_once = { opts->progress, 0, 0 };    /* the fit takes longer */
    char *missing = NULL;
    cycle goal;
    if (st != SS_OK)
        return st;
    *fit = (ss_fit){ .scene = *start, .residual = NAN, .residual_started = NAN };
    st = ss_gaps_missing(&missing, signal);
    if (st == SS_OK)
        st = ss_cycle_find(&goal, fit->why, sizeof fit->why, x, missing, signal->n, rate,
                           opts->forcing_frequency, &at_once);
    if (st == SS_OK && goal.period > 0)
        st = fit_signal(fit, signal, column, &goal, missing, opts, err);
    free(missing);
    return st;
}
