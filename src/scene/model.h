/* model.h -- a friction model is a table of properties and of functions that move its state.
 *
 * A new model is a file like state_variable.c and a row in models.h.  It names the keys of its own
 * parameters, whose values stand in ss_scene.own at the places that its enumeration gives them.
 * All other code reads the table.  NULL in the table means that the model lacks the property.
 *
 * A model is smooth within a mode (stick or microstick 0, slip +1, slip -1); it is not smooth only
 * where the mode changes.  Coulomb and compliant contact are linear within a mode and share one
 * equation, m q'' = drive - f0 - k q - c q', whose coefficients depend on the mode.
 *
 * Models compute in the frame of the surface, which moves at S.  In this frame the surface rests,
 * the friction depends on v, and the spring is pulled at U - S.  Positions are relative to that of
 * the pull at u = 0, so that they stay small however long the pull lasts: the position less (U -
 * S) u is x - U t. */
#ifndef MODEL_H
#define MODEL_H

#include <math.h>
#include <stddef.h>
#include <stickslip/scene.h>
#include "scene/key.h"

enum { MAX_DIM = 3, MOST_SERIES = 26, SERIES_PARTS = MAX_DIM + 1 };

/* A measured base (base.c): n samples at start + i / rate. */
struct ss_base {
    double start, rate;
    size_t n;
    double size;                    /* largest |z| */
    double *z, *bend;               /* bend: z'' in units of the interval */
    char cksum[48];                 /* of its file, as POSIX's cksum prints it; "": it has no file */
};

/* What ends a mode when it becomes negative: level + p, or with either_side level - |p|, where p is linear in the
 * state. */
typedef struct bound {
    double level, of[MAX_DIM];
    int either_side;
} bound;

enum { BOUNDS = 3 };                 /* the most that a mode has */

/* The mass, its contact and the base at one instant of a mode. */
typedef struct state {
    const ss_scene *scene;
    const ss_model *model;
    double omega;                   /* Omega [rad/s] */
    double drive;                   /* k Z_e [N] */
    double ramp;                    /* k (U - S) [N/s] */
    double drag;                    /* d S [N] */
    int moves;                      /* 1: there is a pull, a moving surface or a measured base */
    double z[4];                    /* coefficients of the measured base in powers of u - u_piece, valid
                                       until u_knot */
    double u_piece, u_knot;
    double x_scale;                 /* the scale of x: absolute tolerances are tol times it */
    double tol;                     /* the error of x in a step, of x_scale */

    int mode;
    int side;                       /* of its play on which a contact is: 1, -1, or 0 in the gap */
    int n_bounds, ended;            /* ended: the number of the bound that has ended the mode */
    bound bound[BOUNDS];
    double k, c, f0;                /* coefficients of the mode's equation, see above */
    double x_ref;                   /* the position is x_ref + q[0]; in microstick q[0] is y */
    double graze;                   /* a contact no farther beyond its limit only touches it [m] */
    double slack;                   /* graze, if the contact has touched in this microstick; else 0 */
    unsigned long touches;          /* so far */
    const char *over;               /* why the motion ends here; NULL: it goes on */

    double theta;                   /* phase of the base at u = 0 [rad] */
    double u;                       /* the instant [s], from an origin that the integrator sets */
    double q[MAX_DIM];              /* position or y, velocity, theta at u */
} state;

/* state.c: the state before the first mode, at u = 0. */
state ss_state_of(const ss_scene *scene, double tol);
/* Make positions relative to the present position of the pull (below), which moves since u = 0. */
void ss_state_follow(state *m);
/* base.c: set the coefficients of the measured base, which must exist, for the interval that
 * begins at u; t is the time of u. */
void ss_state_meet_base(state *m, double t);
/* SS_EDATA if the base is not known from 0 to end; err calls its file by name. */
ss_status ss_base_covers(const ss_base *base, double end, const char *name, ss_error *err);

/* The modes in which the friction force varies. */
enum { IN_STICK = 1, IN_SLIP = 2 };

/* The change of a difference d of two neighbouring states, in the order x_ref (or the state's third
 * number, if it has one), q[0], v. */
enum { D_REF, D_Q, D_V, D_MOST };
struct variation {
    /* Set is_free to 1 for each of the three numbers that can differ within the mode. */
    void (*free)(const state *m, int is_free[D_MOST]);
    /* Carry d across the end of `mode` at q, which this bound was; before and after are the rates of
     * change on its two sides.  A neighbouring state reaches it at another time.  Each column of d is
     * the difference that one initial difference has caused.  NULL if the modes are not linear. */
    void (*cross)(const state *m, int mode, const bound *by, const double q[], const double before[],
                  const double after[], double d[D_MOST][D_MOST]);
    /* Move a state by d.  Returns 0 if its mode is not valid there. */
    int (*move)(state *m, const double d[D_MOST]);
};

/* A number of the scene; the scene is simpler without it. */
typedef struct vanishing {
    const char *name;               /* of the simpler scene: "damping=0" */
    size_t offset;                  /* in ss_scene */
} vanishing;

/* A piece of a motion that is given, over which the speed is constant. */
typedef struct piece {
    double dx, h;                   /* [m], [s] */
    double v;                       /* the speed at its end, which may be known better [m/s] */
    double slow;                    /* a speed less than this is noise [m/s] */
} piece;
enum { DRIVEN_PARTS = 3 };

struct ss_model {
    const char *name;               /* in scenes */
    const scene_key *keys;          /* keys that not every scene has (keys.c has the others) */
    size_t n_keys;
    int rig_is_own;                 /* 1: the rig is among them, all of it but mass and spring */
    parameter parameter[PARAMETERS];
    size_t n_parameters;
    const vanishing *vanishing;     /* numbers that not every scene has (simpler.c has the others) */
    size_t n_vanishing;
    /* Change a scene to the simpler model that is the limit of this one as its laws become fast or
     * stiff; NULL if this is the simplest model. */
    void (*limit)(ss_scene *scene);
    size_t dim;                     /* of the state */
    int linear;                     /* 1: each mode is linear, with the coefficients k, c and f0; else GSL's steps
                                       are repeated to know the state inside, which multistep methods cannot */
    int has_contact;                /* 1: it has an elastic contact, with contact_stiffness and
                                       contact_damping */
    int kinks;                      /* 1: modes end where the law has a kink, which is no event */
    int from_pull;                  /* 1: its position is that relative to the pulled end of the spring */
    unsigned force_varies;          /* IN_STICK, IN_SLIP */

    /* Change a scene to one with the same motion that keeps the shape of this motion when f_k and Z_e
     * grow together; NULL if every scene of the model does. */
    void (*normalise)(ss_scene *scene);
    /* Enter the first mode at the scene's initial state.  Returns 1 if it is slip. */
    int (*start)(state *m);
    /* The largest angular frequency or rate of decay of the mode [rad/s], which caps the steps.
     * *what, unless what is NULL, becomes its name for a diagnosis. */
    double (*fastest)(const state *m, const char **what);
    /* A faster rate, for which the tolerance may shorten steps further [rad/s]; NULL if none. */
    double (*quickest)(const ss_scene *scene);
    /* Set the scales of the state's numbers; NULL: those of ss_motion_scales serve. */
    void (*scales)(const state *m, double scale[]);
    /* The longest step from the present state whose error an integrator can estimate; NULL if the
     * cap of `fastest` suffices. */
    double (*sight)(const state *m, const double dqdt[]);
    /* Returns 1 if an implicit method costs less for this scene; NULL if it never does. */
    int (*stiff)(const ss_scene *scene);
    /* The rate of change of the state under the force `drive` of the base. */
    void (*rates)(const state *m, double drive, const double q[], double dqdt[]);
    /* The derivatives of this rate by the state (row after row) and by time. */
    void (*jacobian)(const state *m, double u, const double q[], double *dfdq, double dfdt[]);
    /* The Taylor coefficients of the present state in s / unit, up to an order of at most
     * MOST_SERIES, and those of v', the last part, up to one order less; step[n] = unit / (n + 1).
     * Parts that the model does not have are not written.  NULL if the model has no recurrence. */
    void (*series)(const state *m, const double step[], int order, double c[][SERIES_PARTS]);
    /* Returns 0 if the law of this scene has no such series; NULL if every scene's has. */
    int (*analytic)(const ss_scene *scene);
    /* Shorten a step [unit] to the range in which these coefficients describe the motion: beyond a
     * pole that they do not show, the motion differs.  NULL if they always describe it. */
    double (*reach)(const state *m, double c[][SERIES_PARTS], double step);
    /* Returns 1 if the mass stands still in this mode; *u_end becomes the end of this time
     * (INFINITY: it never ends).  NULL if it stands still in no mode. */
    int (*still)(const state *m, double *u_end);
    /* The mode ends in this state: enter the next one.  Returns 1 if this is an event, and writes *e.
     * NULL if the model has one mode. */
    int (*next)(state *m, ss_event *e);
    /* Fill in the sample, in the frame of the surface, from state, rate of change and force of the
     * base.  The caller fills in t, z and s. */
    void (*sample)(const state *m, double drive, const double q[], const double dqdt[],
                   ss_sample *s);
    /* The speed of the mass over the surface; NULL: it is the second number of the state. */
    double (*speed)(const state *m);
    /* Let it slide steadily with the pull; NULL if the model knows no such state. */
    void (*equilibrium)(state *m);
    /* The quantity, beside x and v, on which the further motion depends: the third number of the
     * state, if it has one.  *unit becomes its scale.  NULL if there is none. */
    double (*memory)(const state *m, double *unit);
    /* Returns 1 if the mass neither slips nor stands still, so that it may oscillate on its
     * contact; NULL if this never happens. */
    int (*in_transition)(const state *m, double v);
    /* NULL if the model cannot follow neighbouring states. */
    const struct variation *variation;
    /* Follow a piece of a motion that is given.  The contact's memory is 0 at the start.  The parts become forces
     * that add up to f at the end of the piece: of a contact with a gap those on its two sides, else f as it would
     * be at high speed, or steadily at a reference, and what is added to it.  NULL if such a motion does not
     * determine f. */
    void (*drive)(const ss_scene *scene, double *memory, const piece *p, double part[DRIVEN_PARTS]);
};

void ss_to_compliant(ss_scene *scene, double stiffness, double gap);    /* compliant.c: an undamped contact */
void ss_to_stribeck(ss_scene *scene, double speed);  /* stribeck.c: with f_s and f_k of the scene, and v_s */
void ss_to_coulomb(ss_scene *scene);                 /* coulomb.c: the limit of most models */

static inline double
own_frequency(const ss_scene *scene)                /* omega_n [rad/s] */
{
    return sqrt(scene->stiffness / scene->mass);
}

static inline double
kinetic_friction(const ss_scene *scene, int way)    /* f_k of motion to larger x, or, if way < 0, to smaller [N] */
{
    return way < 0 && scene->friction_negative > 0 ? scene->friction_negative : scene->friction;
}

static inline double
holding_friction(const ss_scene *scene, int way)    /* f_s against it [N] */
{
    double f_k = kinetic_friction(scene, way), f_s = scene->static_friction;
    if (way < 0 && scene->static_friction_negative > 0)
        f_s = scene->static_friction_negative;
    return f_s > f_k ? f_s : f_k;
}

static inline double
static_friction(const ss_scene *scene)              /* the larger f_s [N] */
{
    double f_s = holding_friction(scene, 1), other = holding_friction(scene, -1);
    return f_s > other ? f_s : other;
}

static inline double
pull_of(const ss_scene *scene)                      /* U - S [m/s] */
{
    return scene->base_velocity - scene->surface_velocity;
}

static inline double
amplitude_of(const ss_scene *s)                     /* X of the supported ranges [m] */
{
    double speed = fmax(fmax(fabs(s->v0), fabs(s->base_velocity)), fabs(s->surface_velocity));
    double z = s->base != NULL ? s->base->size : s->base_amplitude;
    double X = fmax(fmax(z, fabs(s->x0)), speed / own_frequency(s));
    return pull_of(s) != 0 ? fmax(X, static_friction(s) / s->stiffness) : X;
}

/* A friction force may reverse within |v| <= front.  A step across this range would miss the
 * change, and so would its error estimate.  So v may change by at most |v| / 2 + front, as
 * estimated from v' and v''. */
static inline double
sight_of(double v, double front, double a, double jerk)
{
    double far = fabs(v) / 2 + front;
    return 2 * far / (fabs(a) + sqrt(a * a + 2 * fabs(jerk) * far));
}

static inline double
speed_of(const state *m)
{
    return m->model->speed != NULL ? m->model->speed(m) : m->q[1];
}

static inline double
frame_pull(const state *m)                          /* of the spring's end in the frame of the state [m/s] */
{
    return m->model->from_pull ? 0 : pull_of(m->scene);
}

static inline int
sign(double x)
{
    return (x > 0) - (x < 0);
}

/* The direction of the last motion that is more than noise, which is the memory of dry friction. */
static inline double
direction_of(double *memory, const piece *p)
{
    if (fabs(p->v) > p->slow)
        *memory = sign(p->v);
    return *memory;
}

/* --- bounds of modes ------------------------------------------------------------------------- */

static inline double
bound_value(const bound *b, const double q[], const double dqdt[], double *slope)
{
    double p = b->of[0] * q[0] + b->of[1] * q[1], rate = b->of[0] * dqdt[0] + b->of[1] * dqdt[1];
    if (b->of[2] != 0) {                /* else the state may have no such part */
        p += b->of[2] * q[2];
        rate += b->of[2] * dqdt[2];
    }
    *slope = b->either_side ? -sign(p) * rate : rate;
    return b->either_side ? b->level - fabs(p) : b->level + p;
}

/* 1 if the state lies within the mode. */
static inline int
within_bounds(const state *m, const double rates[])
{
    double slope;
    for (int i = 0; i < m->n_bounds; i++)
        if (!(bound_value(&m->bound[i], m->q, rates, &slope) > 0))
            return 0;
    return 1;
}

/* --- the base: its force on the spring is k (Z_e cos(Omega t + phase) + (U - S) u) ----------
 *
 * From the forces below d S is subtracted, the force of the damper on a mass that rests on the
 * surface. */

typedef struct turn {
    double co, si;                  /* cosine and sine of an angle */
} turn;

static inline turn
turn_of(double angle)
{
    return (turn){ cos(angle), sin(angle) };
}

static inline turn
turn_further(turn a, turn b)
{
    return (turn){ a.co * b.co - a.si * b.si, a.co * b.si + a.si * b.co };
}

static inline turn
base_turn(const state *m, double u)
{
    return turn_of(m->theta + m->omega * u);
}

static inline double
measured_base(const state *m, double u)             /* [m] */
{
    double s = u - m->u_piece;
    return m->z[0] + s * (m->z[1] + s * (m->z[2] + s * m->z[3]));
}

static inline double
measured_speed(const state *m, double u)
{
    double s = u - m->u_piece;
    return m->z[1] + s * (2 * m->z[2] + s * 3 * m->z[3]);
}

static inline double
with_rest(const state *m, double swing, double u)   /* the base's force, given that of its swing */
{
    if (!m->moves)
        return swing;
    double force = swing + (m->ramp * u - m->drag);
    return m->scene->base == NULL ? force : force + m->scene->stiffness * measured_base(m, u);
}

static inline double
base_force_by(const state *m, turn base, double u)
{
    return with_rest(m, m->drive * base.co, u);
}

static inline double
base_force(const state *m, double u)
{
    return with_rest(m, m->drive * cos(m->theta + m->omega * u), u);
}

static inline double
base_force_rate(const state *m, double u)
{
    double rate = -m->drive * m->omega * sin(m->theta + m->omega * u) + m->ramp;
    return m->scene->base == NULL ? rate : rate + m->scene->stiffness * measured_speed(m, u);
}

/* The Taylor coefficients of base_force at m->u in s / unit, step[n] = unit / (n + 1). */
static inline void
base_force_series(const state *m, const double step[], int order, double c[])
{
    turn base = base_turn(m, m->u);
    double force = m->drive * base.co, late = m->drive * base.si;
    for (int n = 0; n <= order; n++) {
        double turns = m->omega * step[n], next = -turns * late;
        c[n] = force;
        late = turns * force;
        force = next;
    }
    c[0] += m->ramp * m->u - m->drag;
    c[1] += m->ramp * step[0];
    if (m->scene->base == NULL)
        return;
    double k = m->scene->stiffness, unit = step[0], s = m->u - m->u_piece;
    c[0] += k * measured_base(m, m->u);
    c[1] += k * unit * measured_speed(m, m->u);
    c[2] += k * unit * unit * (m->z[2] + 3 * m->z[3] * s);
    c[3] += k * unit * unit * unit * m->z[3];
}

/* The sum of a_i b_j over i + j = n, i and j > 0.  It goes from the middle outwards, so that the
 * coefficients that have just been computed come last, and the processor does not wait for them. */
static inline double
inner_products(const double a[], const double b[], int n)
{
    size_t j = (size_t)n / 2, i = (size_t)n - j;
    double sum = 0;
    if (i == j && j > 0)
        sum = a[j--] * b[i++];
    for (; j > 0; j--, i++)
        sum += a[j] * b[i] + a[i] * b[j];
    return sum;
}

/* The coefficient of order n of the product of two series. */
static inline double
product_term(const double a[], const double b[], int n)
{
    return n == 0 ? a[0] * b[0] : a[0] * b[n] + inner_products(a, b, n) + a[n] * b[0];
}

/* The coefficient of order n > 0 of exp(-u), from those of lower order. */
static inline double
next_of_exp(const double u[], const double e[], int n)
{
    double sum = 0;
    for (int k = 1; k <= n; k++)
        sum += k * u[k] * e[n - k];
    return -sum / n;
}

/* The longest step of at most this length in which v changes by no more than `most`. */
static inline double
step_within(double c[][SERIES_PARTS], double step, double most)
{
    enum { TERMS = 6 };
    double way = INFINITY;
    for (; way > most; step *= 0.9) {
        way = 0;
        for (int n = TERMS; n > 0; n--)
            way = (way + fabs(c[n][1])) * step;
    }
    return step / 0.9;
}

/* --- linear.c: functions that Coulomb and compliant contact share ------------------------------- */

void ss_linear_rates(const state *m, double drive, const double q[], double dqdt[]);
void ss_linear_jacobian(const state *m, double u, const double q[], double *dfdq, double dfdt[]);
void ss_linear_series(const state *m, const double step[], int order, double c[][SERIES_PARTS]);
double ss_linear_fastest(const state *m, const char **what);
void ss_linear_slip(state *m, double x, double v, int direction);

/* --- stick.c: true stick, in which v is exactly 0 ------------------------------------------- */

double ss_stick_force(const state *m, double drive, double x);     /* the load on the friction */
int ss_stick_start(state *m);
int ss_stick_still(const state *m, double *u_end);
int ss_stick_next(state *m, ss_event *e);
/* f in slip is f0. */
void ss_stick_sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s);
extern const struct variation ss_stick_variation;

/* --- kink.c: laws of three numbers x, v, z that are smooth but for kinks ------------------------- */

int ss_kink_start(state *m);
int ss_kink_next(state *m, ss_event *e);
void ss_kink_turn(state *m);                        /* the mode of v, or of v', begins */
/* The rates of a spring with such a contact, with viscous friction; what names them, as in `fastest`. */
double ss_kink_fastest(const state *m, double stiffness, double viscous, const char **what);
/* row: the derivatives of all rates by the state. */
void ss_kink_jacobian(const state *m, double u, const double row[9], double *dfdq, double dfdt[]);
/* All but f; y is the third number. */
void ss_kink_sample(const double q[], const double dqdt[], ss_sample *s);
extern const struct variation ss_kink_variation;

#endif
