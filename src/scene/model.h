/* model.h -- a friction model is a table of properties and of functions that move its state.
 *
 * A new model needs a file like state_variable.c, a line in models.c, and fields in ss_scene for
 * its own parameters.  All other code reads the table.  NULL in the table means that the model
 * lacks the property.
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

enum { MAX_DIM = 3, ORDERS = 4, MOST_SERIES = 26, SERIES_PARTS = MAX_DIM + 1 };

/* base.c; n samples at start + i / rate. */
struct ss_base {
    double start, rate;
    size_t n;
    double size;                    /* largest |z| */
    double *z, *bend;               /* bend: z'' in units of the interval */
    char cksum[48];                 /* of the file, as POSIX's cksum prints it; "": of none */
};

/* The mass, its contact and the base at one instant of a mode. */
typedef struct state {
    const ss_scene *scene;
    const struct model *model;
    double omega;                   /* Omega [rad/s] */
    double drive;                   /* k Z_e [N] */
    double ramp;                    /* k (U - S) [N/s] */
    double drag;                    /* d S [N] */
    int moves;                      /* there is a pull, a surface that moves or a measured base */
    double z[4];                    /* the measured base in powers of u - u_piece, until u_knot */
    double u_piece, u_knot;
    double x_scale;                 /* the scale of x: absolute tolerances are tol times it */
    double tol;                     /* of the integrator */

    int mode;
    double k, c, f0;                /* of the mode, see above */
    double x_ref;                   /* x_ref + q[0]: the position; q[0] is y in microstick */
    double graze;                   /* a contact this far beyond its limit only touches it [m] */
    double slack;                   /* graze once it has in this microstick, else 0 */
    unsigned long touches;

    double theta;                   /* phase of the base at u = 0 [rad] */
    double u;                       /* the instant [s], from an origin that the integrator sets */
    double q[MAX_DIM];              /* position or y, velocity, theta at u */
} state;

/* state.c: before its first mode, at u = 0. */
state ss_state_of(const ss_scene *scene, double tol);
/* Let positions count from the present place of the pull (below), which moves since u = 0. */
void ss_state_follow(state *m);
/* base.c: set the piece of the measured base, which there must be, for the interval that begins at
 * u, which is the time t. */
void ss_state_meet_base(state *m, double t);
/* SS_EDATA if the base is not known from 0 to end; name is that of its file. */
ss_status ss_base_covers(const ss_base *base, double end, const char *name, ss_error *err);

/* The modes in which the friction force varies. */
enum { IN_STICK = 1, IN_SLIP = 2 };

/* The change of a difference d of two neighbouring states, in the order x_ref (or the state's third
 * number, if it has one), q[0], v. */
enum { D_REF, D_Q, D_V, D_MOST };
struct variation {
    /* Set is_free to 1 for each of the three that can differ within the mode. */
    void (*free)(const state *m, int is_free[D_MOST]);
    /* Carry d across the event at q that ended `mode`; the rate of change was before and is after it.
     * A neighbouring state reaches the event at another time.  Each column of d is the difference
     * caused by one of those at the start.  NULL if the model has no events. */
    void (*cross)(const state *m, int mode, const double q[], const double before[],
                  const double after[], double d[D_MOST][D_MOST]);
    /* Move a state; 0 if its mode does not hold there. */
    int (*move)(state *m, const double d[D_MOST]);
};

/* A number of the scene whose absence makes it simpler. */
typedef struct vanishing {
    const char *name;               /* of the simpler scene: "damping=0" */
    size_t offset;                  /* in ss_scene */
} vanishing;

struct model {
    const char *name;               /* in scenes */
    const scene_key *keys;          /* besides those of every scene (keys.c) */
    size_t n_keys;
    const ss_scene_range *ranges;   /* besides those of every scene (ranges.c) */
    size_t n_ranges;
    parameter parameter[PARAMETERS];
    size_t n_parameters;
    const vanishing *vanishing;     /* besides those of every scene (simpler.c) */
    size_t n_vanishing;
    /* Rewrite a scene as one of the simpler model that it comes to as its own laws become fast or
     * stiff; NULL if it is the simplest. */
    void (*limit)(ss_scene *scene);
    size_t dim;                     /* of the state */
    int linear;                     /* in each mode, with the coefficients k, c and f0 */
    int has_contact;                /* an elastic one, of contact_stiffness and contact_damping */
    unsigned force_varies;          /* IN_STICK, IN_SLIP */

    /* Rewrite a scene as one that moves alike and keeps the shape of its motion if f_k and Z_e grow
     * together; NULL if all do. */
    void (*normalise)(ss_scene *scene);
    /* Enter the first mode at the scene's initial state; 1 if it starts in slip. */
    int (*start)(state *m);
    /* Largest angular frequency or rate of decay of the mode, which caps the steps [rad/s]; *what
     * becomes its name for a diagnosis, unless what is NULL. */
    double (*fastest)(const state *m, const char **what);
    /* A faster rate, for which the tolerance may shorten steps further [rad/s]; NULL if none. */
    double (*quickest)(const ss_scene *scene);
    /* The longest step from the present state whose error an integrator can still judge; NULL if
     * `fastest` is limit enough. */
    double (*sight)(const state *m, const double dqdt[]);
    /* 1 if an implicit method is the cheaper one; NULL if that cannot be. */
    int (*stiff)(const ss_scene *scene);
    /* The state's rate of change under the force of the base. */
    void (*rates)(const state *m, double drive, const double q[], double dqdt[]);
    /* Its derivatives by the state (row after row) and by time. */
    void (*jacobian)(const state *m, double u, const double q[], double *dfdq, double dfdt[]);
    /* The ORDERS - 1 rates of change after dqdt of a state at u; NULL if steps are to be repeated
     * for what lies inside them, which the multistep methods cannot do where there are events. */
    void (*derivatives)(const state *m, double u, const double q[], const double dqdt[],
                        double higher[][MAX_DIM]);
    /* The Taylor coefficients in s / unit of the present state up to an order of MOST_SERIES at most, and
     * of v', the last part, up to one order less, by step[n] = unit / (n + 1).  Parts that the model does
     * not have are left alone.  NULL if it has no recurrence for them. */
    void (*series)(const state *m, const double step[], int order, double c[][SERIES_PARTS]);
    /* The Taylor coefficients along the series c, up to the same order, of what the state's last rate of
     * change gains with v.  NULL if that is the same everywhere in a mode. */
    void (*slope)(const state *m, const double step[], int order, double c[][SERIES_PARTS],
                  double slope[]);
    /* Shorten a step [unit] to the range in which those coefficients describe the motion: they may not
     * show a pole beyond which the motion is another.  NULL if they always describe it. */
    double (*reach)(const state *m, double c[][SERIES_PARTS], double step);
    /* A function that is not negative within the mode; *slope is its rate of change.  NULL if the model
     * has no events.  If the model has derivatives or a series, the guard is level + p with p linear in q
     * and v, or level - |p| in a mode 0 in which the mass moves. */
    double (*guard)(const state *m, const double q[], const double dqdt[], double *slope);
    /* 1 if the mass stands still in this mode, until *u_end (INFINITY: for ever); NULL if in none. */
    int (*still)(const state *m, double *u_end);
    /* The mode ends in this state: enter the next.  1 if that is an event, which is written to *e. */
    int (*next)(state *m, ss_event *e);
    /* Fill in the sample, in the frame of the surface, from state, rate of change and force of the
     * base; t, z and s are left to the caller. */
    void (*sample)(const state *m, double drive, const double q[], const double dqdt[],
                   ss_sample *s);
    /* The quantity besides x and v on which the next motion depends, which is the state's third number
     * if it has one; *unit is its scale.  NULL if there is none. */
    double (*memory)(const state *m, double *unit);
    /* 1 where the mass neither slips nor stands still, so that it may oscillate on its contact; NULL
     * if there is no such place. */
    int (*in_transition)(const state *m, double v);
    /* NULL if the model does not follow neighbouring states. */
    const struct variation *variation;
};

const struct model *ss_model_at(size_t i);          /* models.c; NULL after the last */
const struct model *ss_model_of(const ss_scene *scene);

void ss_to_coulomb(ss_scene *scene);                 /* coulomb.c: the limit of most models */

static inline double
own_frequency(const ss_scene *scene)                /* omega_n [rad/s] */
{
    return sqrt(scene->stiffness / scene->mass);
}

static inline double
static_friction(const ss_scene *scene)              /* f_s [N] */
{
    return scene->static_friction > scene->friction ? scene->static_friction : scene->friction;
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

/* A friction force may reverse within |v| <= front.  A step across that range would not see the change,
 * and neither would its error estimate: so v may change by at most half its size plus front, as
 * estimated from v' and v''. */
static inline double
sight_of(double v, double front, double a, double jerk)
{
    double far = fabs(v) / 2 + front;
    return 2 * far / (fabs(a) + sqrt(a * a + 2 * fabs(jerk) * far));
}

static inline int
sign(double x)
{
    return (x > 0) - (x < 0);
}

/* --- the base: its force on the spring is k (Z_e cos(Omega t + phase) + (U - S) u) ----------
 *
 * The forces below are less d S, by which the damper pulls a mass that rests on the surface. */

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
swing_force(const state *m, double u)               /* of a base that is not pulled */
{
    return m->drive * cos(m->theta + m->omega * u);
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
    return with_rest(m, swing_force(m, u), u);
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

/* The sum of a_i b_j over i + j = n, i and j > 0, from the middle outwards: the coefficients that have
 * just been computed come last, so that the processor does not wait for them. */
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

/* --- linear.c: functions that Coulomb and compliant contact share ------------------------------- */

void ss_linear_rates(const state *m, double drive, const double q[], double dqdt[]);
void ss_linear_jacobian(const state *m, double u, const double q[], double *dfdq, double dfdt[]);
void ss_linear_derivatives(const state *m, double u, const double q[], const double dqdt[],
                           double higher[][MAX_DIM]);
void ss_linear_series(const state *m, const double step[], int order, double c[][SERIES_PARTS]);
double ss_linear_fastest(const state *m, const char **what);
void ss_linear_slip(state *m, double x, double v, int direction);
double ss_linear_slip_guard(const state *m, const double q[], const double dqdt[], double *slope);

/* --- stick.c: true stick, in which v is exactly 0 ------------------------------------------- */

double ss_stick_force(const state *m, double drive, double x);     /* the load on the friction */
int ss_stick_start(state *m);
int ss_stick_still(const state *m, double *u_end);
int ss_stick_next(state *m, ss_event *e);
/* f in slip is f0. */
void ss_stick_sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s);
extern const struct variation ss_stick_variation;

#endif
