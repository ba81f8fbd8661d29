/* radau.c -- a stiff motion carried by collocation: over a step the state is a polynomial that satisfies its
 * equations at the points of Radau's quadrature, of which the last is the step's end (Radau IIA; E. Hairer and
 * G. Wanner, Solving Ordinary Differential Equations II, IV.5).  Newton's method finds it.
 *
 * The polynomial is also the state inside the step.  Its last two Chebyshev coefficients, which fall off, bound
 * its error there; the end of a step is more accurate. */
#include "motion/engine.h"

#include <gsl/gsl_integration.h>
#include <string.h>
#include "base/error.h"
#include "base/versions.h"

enum { STAGES = 12, PARTS = MAX_DIM - 1, RIGHT = PARTS * STAGES, WIDTH = RIGHT + 4, LANES = 4 };
enum { ROUNDS = 10 };                           /* of Newton's method */
#define FLOOR 1e-4                              /* of an error over that allowed: less may be rounding */

typedef double equations[RIGHT][WIDTH];         /* with their right-hand sides */
typedef double stages[STAGES];                  /* numbers of each place, or of the polynomial's values there */

typedef struct radau {
    engine base;
    double relative;                            /* error over the size of the state */
    double allowed[MAX_DIM];                    /* error in this step [unit] */
    stages place;                               /* as parts of the step, whose start is one more place */
    double start;                               /* weights of the values at start and places in the highest */
    stages weight;                              /* Chebyshev coefficient of the polynomial */
    stages slope[STAGES], integral[STAGES];     /* from values at the places to slopes there, and back */
    stages change[MAX_DIM];                     /* of the state since the start [unit] */
    double over;                                /* error of the last step over that allowed; 0: has no past */
} radau;

/* --- a polynomial through its values at the places --------------------------------------------- */

/* Solve n linear equations; 0: they have no solution. */
VERSIONS static int
solve(equations M, int n, double out[])
{
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(M[i][k]) > fabs(M[best][k]))
                best = i;
        if (!(fabs(M[best][k]) > 0))
            return 0;
        for (int j = 0; best != k && j < WIDTH; j++) {
            const double kept = M[k][j];
            M[k][j] = M[best][j];
            M[best][j] = kept;
        }
        for (int i = k + 1; i < n; i++) {
            const double by = M[i][k] / M[k][k];
            for (int j = k / LANES * LANES; by != 0 && j < WIDTH; j++)
                M[i][j] -= by * M[k][j];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        out[k] = M[k][RIGHT];
        for (int j = k + 1; j < n; j++)
            out[k] -= M[k][j] * out[j];
        out[k] /= M[k][k];
    }
    return 1;
}

/* Radau's points are those of Gauss with the weight 1 - x, and 1. */
static ss_status
radau_make(engine *e, ss_error *err)
{
    radau *r = (radau *)e;
    r->relative = ss_motion_relative(&e->m->now, e->tol);
    gsl_integration_fixed_workspace *gauss
        = gsl_integration_fixed_alloc(gsl_integration_fixed_jacobi, STAGES - 1, 0, 1, 1, 0);
    if (gauss == NULL)
        return ss_fail_memory(err, NULL);
    memcpy(r->place, gsl_integration_fixed_nodes(gauss), (STAGES - 1) * sizeof *r->place);
    gsl_integration_fixed_free(gauss);
    r->place[STAGES - 1] = 1;
    r->start = 2;
    for (int i = 0; i < STAGES; i++)
        r->start /= -4 * r->place[i];
    for (int i = 0; i < STAGES; i++) {
        r->weight[i] = 2 / (4 * r->place[i]);
        for (int j = 0; j < STAGES; j++)
            r->weight[i] /= i != j ? 4 * (r->place[i] - r->place[j]) : 1;
    }
    for (int i = 0; i < STAGES; i++) {
        r->slope[i][i] = -r->start / r->weight[i] / r->place[i];
        for (int j = 0; j < STAGES; j++)
            if (i != j) {
                r->slope[i][j] = r->weight[j] / r->weight[i] / (r->place[i] - r->place[j]);
                r->slope[i][i] -= r->slope[i][j];
            }
    }
    for (int j = 0; j < STAGES; j++) {
        equations M = { { 0 } };
        stages column;
        for (int i = 0; i < STAGES; i++)
            memcpy(M[i], r->slope[i], sizeof(stages));
        M[j][RIGHT] = 1;
        solve(M, STAGES, column);
        for (int i = 0; i < STAGES; i++)
            r->integral[i][j] = column[i];
    }
    return SS_OK;
}

/* What the state of a step changes by up to x, a part of it. */
static void
read_changes(const radau *r, stages change[MAX_DIM], double x, double out[])
{
    double sum[MAX_DIM] = { 0 }, all = 1 / x * r->start;
    for (int j = 0; j < STAGES; j++) {
        const double far = x - r->place[j], weight = r->weight[j] / far;
        all += weight;
        for (int k = 0; k < MAX_DIM; k++)
            sum[k] += weight * change[k][j];
        if (far == 0) {
            all = 1;
            for (int k = 0; k < MAX_DIM; k++)
                sum[k] = change[k][j];
            break;
        }
    }
    for (int k = 0; k < MAX_DIM; k++)
        out[k] = x != 0 ? sum[k] / all : 0;
}

/* Its error over that allowed: no less than the next Chebyshev coefficient, if these fall as 1/6^n. */
static double
excess(const radau *r)
{
    double most = FLOOR;
    for (size_t k = 0; k < r->base.m->now.model->dim; k++) {
        double last = 0, before = 0;
        for (int i = 0; i < STAGES; i++) {
            last += r->weight[i] * r->change[k][i];
            before += r->weight[i] * 4 * r->place[i] * r->change[k][i];
        }
        most = fmax(most, fmax(fabs(last), fabs(before) / 6) / r->allowed[k]);
    }
    return most;
}

/* --- a step -------------------------------------------------------------------------------------- */

/* Newton's equations for the parts of the state behind the first, one part after the other.  The first is the
 * integral of its rate, of which it is no part itself.  lack: what this rate has beyond that of the polynomial;
 * speed: its slopes by the other parts. */
VERSIONS static void
linearise(radau *r, double h, equations M, stages lack, stages speed[PARTS])
{
    const state *m = &r->base.m->now;
    const int n = (int)m->model->dim;
    double d[STAGES][MAX_DIM * MAX_DIM], by_time[MAX_DIM];
    memset(M, 0, sizeof(equations));
    for (int i = 0; i < STAGES; i++) {
        const double u = m->u + r->place[i] * h;
        double q[MAX_DIM], rate[MAX_DIM] = { 0 };
        for (int k = 0; k < MAX_DIM; k++)
            q[k] = m->q[k] + r->base.unit[k] * r->change[k][i];
        m->model->rates(m, base_force(m, u), q, rate);
        m->model->jacobian(m, u, q, d[i], by_time);
        r->base.rhs++;
        for (int k = 0; k < n * n; k++)
            d[i][k] *= h * r->base.unit[k % n] / r->base.unit[k / n];
        for (int k = 0; k < n; k++) {
            double *to = k == 0 ? &lack[i] : &M[(k - 1) * STAGES + i][RIGHT];
            *to = h * rate[k] / r->base.unit[k];
            for (int j = 0; j < STAGES; j++)
                *to -= r->slope[i][j] * r->change[k][j];
            if (k > 0)
                speed[k - 1][i] = d[i][k];
        }
    }
    for (int k = 1; k < n; k++)
        for (int i = 0; i < STAGES; i++) {
            double *row = M[(k - 1) * STAGES + i], by_first[STAGES];
            for (int j = 0; j < STAGES; j++) {
                row[(k - 1) * STAGES + j] = r->slope[i][j];
                by_first[j] = d[i][k * n] * r->integral[i][j];
                row[RIGHT] += by_first[j] * lack[j];
            }
            for (int l = 1; l < n; l++) {
                row[(l - 1) * STAGES + i] -= d[i][k * n + l];
                for (int j = 0; j < STAGES; j++)
                    row[(l - 1) * STAGES + j] -= by_first[j] * speed[l - 1][j];
            }
        }
}

/* Improve the polynomial of a step h by Newton's method.  Returns how far it moves, over the error allowed. */
static double
improve(radau *r, double h)
{
    const int n = (int)r->base.m->now.model->dim;
    equations M;
    stages lack, speed[PARTS], way[MAX_DIM] = { { 0 } };
    double most = 0;
    linearise(r, h, M, lack, speed);
    if (!solve(M, (n - 1) * STAGES, way[1]))
        return INFINITY;
    for (int i = 0; i < STAGES; i++)
        for (int l = 1; l < n; l++)
            lack[i] += speed[l - 1][i] * way[l][i];
    for (int i = 0; i < STAGES; i++)
        for (int j = 0; j < STAGES; j++)
            way[0][i] += r->integral[i][j] * lack[j];
    for (int k = 0; k < n; k++)
        for (int i = 0; i < STAGES; i++) {
            r->change[k][i] += way[k][i];
            most = fmax(most, isfinite(way[k][i]) ? fabs(way[k][i]) / r->allowed[k] : INFINITY);
        }
    return most;
}

/* Find the polynomial of a step h, begun where the last one leads, or else at rest; 0: there is none so near.  A
 * round of Newton's method squares the ratio of its moves. */
static int
find_changes(radau *r, double h, double last_h, stages last[MAX_DIM])
{
    for (int leads = r->over > 0; leads >= 0; leads--) {
        double before = 1, way = 0;
        memset(r->change, 0, sizeof r->change);
        for (int i = 0; leads && i < STAGES; i++) {
            double to[MAX_DIM];
            read_changes(r, last, 1 + r->place[i] * h / last_h, to);
            for (int k = 0; k < MAX_DIM; k++)
                r->change[k][i] = to[k] - last[k][STAGES - 1];
        }
        for (int round = 0; round < ROUNDS && way < INFINITY; round++, before = way) {
            way = improve(r, h);
            if (way * way / before * way / before < 1e-2)
                return 1;
        }
    }
    return 0;
}

static void
radau_begin(engine *e)
{
    radau *r = (radau *)e;
    ss_engine_begin_steps(e);
    r->over = 0;
}

static void
radau_at(engine *e, reading where, double s, turn base, double q[], double dqdt[])
{
    radau *r = (radau *)e;
    const state *m = &e->m->now;
    double change[MAX_DIM];
    (void)where;
    read_changes(r, r->change, s / e->h, change);
    for (int k = 0; k < MAX_DIM; k++)
        q[k] = m->q[k] + r->base.unit[k] * change[k];
    e->rhs++;
    m->model->rates(m, base_force_by(m, base, m->u + s), q, dqdt);
}

/* Try steps of decreasing length.  The next one follows from the error, and from how it grew over the last two
 * (K. Gustafsson, ACM Trans. Math. Softw. 20, 496, 1994). */
static ss_status
radau_step(engine *e, double h_max, ss_error *err)
{
    radau *r = (radau *)e;
    const state *m = &e->m->now;
    stages last[MAX_DIM];
    memcpy(last, r->change, sizeof last);
    if (m->model->sight != NULL) {
        double rates[MAX_DIM] = { 0 };          /* by the last polynomial, as those of the state may be rounding */
        for (int k = 0; k < MAX_DIM && r->over > 0; k++)
            for (int j = 0; j < STAGES; j++)
                rates[k] += r->slope[STAGES - 1][j] * last[k][j] * r->base.unit[k] / e->h;
        h_max = fmin(h_max, m->model->sight(m, r->over > 0 ? rates : e->dq0));
    }
    double h = fmin(e->next, h_max);
    for (size_t k = 0; k < m->model->dim; k++)
        r->allowed[k] = (e->tol * e->scale[k] + r->relative * fabs(m->q[k])) / e->unit[k];
    for (;;) {
        const double over = find_changes(r, h, e->h, last) ? excess(r) : INFINITY;
        double change = fmax(0.85 * pow(over, -1. / STAGES), 0.2);
        if (over <= 1) {
            if (r->over > 0)
                change *= fmax(0.5, fmin(h / e->h * pow(r->over / over, 1. / STAGES), 1));
            if (h >= e->next || h * change < e->next)
                e->next = h * change;
            r->over = over;
            break;
        }
        e->next = h *= change;
        if (!(h >= e->shortest))
            return ss_engine_fail_short(e, err);
    }
    e->h = h;
    e->steps++;
    radau_at(e, ANYWHERE, h, base_turn(m, m->u + h), e->q1, e->dq1);
    return SS_OK;
}

const struct engine_type ss_radau_engine = {
    .size = sizeof(radau), .degree = CAPPED_DEGREE,
    .make = radau_make, .begin = radau_begin, .step = radau_step, .at = radau_at
};
