/* stickslip/scene.h -- a scene: one friction model, its parameters, and its record.
 *
 * All models share  m x'' + d x' + k x + f = k (Z_e cos(Omega t + phase) + U t),  t = 0 at the
 * start of settling, or with z(t) as measured in place of the cosine; they differ in the friction
 * force f, which depends on v = x' - S.  The text form is described in stickslip-scene(5). */
#ifndef STICKSLIP_SCENE_H
#define STICKSLIP_SCENE_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

typedef enum ss_model {
    SS_COULOMB,             /* f = f_k sgn(v); sticks while |k (z - x)| <= f_k */
    SS_STATE_VARIABLE,      /* f = theta, theta' = -gamma (theta - f_k tanh(alpha v)) */
    SS_COMPLIANT,           /* Coulomb through a massless contact of stiffness K_y and damping c */
    SS_STRIBECK             /* f falls from f_s to f_k with speed; sticks as SS_COULOMB */
} ss_model;

typedef enum ss_law {
    SS_LAW_SCALED,          /* theta' = -gamma (theta - f_k tanh(alpha v)) */
    SS_LAW_LITERAL          /* theta' = -gamma f_k (theta - tanh(alpha v)), equation (9) as printed */
} ss_law;

typedef enum ss_release {
    SS_RELEASE_SPRING,      /* microstick ends when K_y |y| > f_k, the paper's words */
    SS_RELEASE_TOTAL        /* microstick ends when |K_y y + c v| > f_k: friction is continuous */
} ss_release;

/* The displacement of a base as it was measured. */
typedef struct ss_base ss_base;
enum { SS_BASE_FILE = 256, SS_BASE_COLUMN = 64 };

typedef struct ss_scene {
    ss_model model;
    double mass;                /* m      [kg]     > 0 */
    double stiffness;           /* k      [N/m]    > 0 */
    double friction;            /* f_k    [N]     >= 0, kinetic */
    double base_amplitude;      /* Z_e    [m]     >= 0 */
    double base_frequency;      /* Omega / 2 pi [Hz] >= 0 */
    double phase;               /* [rad] */
    double x0, v0;              /* at the start of settling [m, m/s] */
    double damping;             /* d      [N s/m] >= 0, of the mass */
    double base_velocity;       /* U      [m/s]: the spring's end is pulled */
    double surface_velocity;    /* S      [m/s]: the mass rubs on a belt */
    double static_friction;     /* f_s    [N]     >= f_k, or 0: as f_k   not state-variable */

    double alpha, gamma;        /* [s/m] > 0, [1/s] > 0        state-variable only */
    ss_law law;                 /*                             state-variable only */
    double contact_stiffness;   /* K_y    [N/m]    > 0         compliant only */
    double contact_damping;     /* c      [N s/m] >= 0         compliant only */
    ss_release release;         /*                             compliant only */

    double stribeck_velocity;   /* v_s    [m/s]    > 0         stribeck only */

    char base_file[SS_BASE_FILE];       /* the file of z(t), "": none; ss_scene_load_base reads it */
    char base_column[SS_BASE_COLUMN];   /* "": z, or the only one */
    const ss_base *base;                /* NULL, or z(t) in place of Z_e cos(...); the caller owns it */

    double settle;              /* [s] >= 0  simulated before the record starts, not written */
    double duration;            /* [s] >= 0  length of the record */
    double rate;                /* [Hz] > 0  samples a second */
} ss_scene;

extern const ss_scene ss_scene_defaults;    /* start here: settle 0, duration 10, rate 2000, ... */

/* One sample of the motion.  At an event it is the state after the event. */
typedef struct ss_sample {
    double t;           /* [s] n / rate from the start of the record */
    double x, v, a;     /* displacement, velocity, acceleration of the mass [m, m/s, m/s^2] */
    double f;           /* friction force on the mass, with its sign in the equation of motion [N] */
    double s;           /* spring's force on the mass, k (z - x) [N] */
    double y;           /* contact deflection [m]: +-f_k/K_y while slipping; 0 without contact */
    double z;           /* displacement of the base, U t included [m] */
    int mode;           /* 0 stick (Coulomb) or microstick (compliant), else the sign of the slip
                           over the surface; state-variable: the sign of x' - S */
} ss_sample;

typedef enum ss_event_kind {
    SS_STICK,           /* a Coulomb stick or a compliant microstick begins */
    SS_SLIP,            /* slip begins */
    SS_REVERSE          /* slip changes direction with no stick between */
} ss_event_kind;

typedef struct ss_event {
    double t;           /* [s] from the start of the record */
    double x, v;        /* [m, m/s] */
    ss_event_kind kind;
    int direction;      /* +1 or -1: of the slip that begins; for SS_STICK, of the one that ended */
} ss_event;

/* Read a scene from text.  name is the name of the file in messages.  On failure *scene is unchanged.
 * SS_EDATA for a key that is unknown, repeated, missing, malformed, out of range or not the
 * model's; SS_EIO if reading failed. */
ss_status ss_scene_read(ss_scene *scene, FILE *in, const char *name, ss_error *err);

/* The same with the n settings "key=value" as if they were its last lines: they replace the
 * values of the text.  SS_EINVAL for a wrong setting, SS_EDATA for the text. */
ss_status ss_scene_read_set(ss_scene *scene, FILE *in, const char *name,
                            const char *const settings[], size_t n, ss_error *err);

/* Read the shipped scene of this name ("compliant-light"), or if there is none the file of this path,
 * with settings as above.  SS_EIO also if there is neither; err then lists the shipped names. */
ss_status ss_scene_load(ss_scene *scene, const char *path, const char *const settings[], size_t n,
                        ss_error *err);

/* SS_OK if every parameter that the model has lies in its range, else SS_EINVAL. */
ss_status ss_scene_check(const ss_scene *scene, ss_error *err);

/* Write every key that the model has, one a line, in the fewest digits that read back the same. */
ss_status ss_scene_write(const ss_scene *scene, FILE *out);

/* z(t) [m] by the natural cubic spline through a column of a signal, whose clock is the scene's: t
 * = 0 is the start of settling.  To be freed with ss_base_free.  SS_EDATA: another unit than m, or
 * fewer than 3 samples; SS_ENOMEM. */
ss_status ss_base_new(ss_base **base, const ss_signal *signal, size_t column, ss_error *err);
void ss_base_free(ss_base *base);                   /* NULL is allowed */

/* The number of a scene that a key names, and its unit unless that is NULL; NULL if the scene's model
 * has no such number, and err says so. */
double *ss_scene_number(ss_scene *scene, const char *key, const char **unit, ss_error *err);

/* A range over which scenes are supported: results are tested there.  Scenes outside are simulated,
 * too, without that promise. */
typedef struct ss_scene_range {
    const char *name, *unit;    /* "Omega/omega_n"; X is defined in stickslip-scene(5) */
    double from, to;
    int zero;                   /* 1: 0 is in the range, too */
    double (*value)(const ss_scene *scene);     /* NaN where it means nothing */
} ss_scene_range;
/* The i-th range of the scenes of a model; NULL after the last. */
const ss_scene_range *ss_model_range(ss_model model, size_t i);

/* SS_OK if a scene that has passed ss_scene_check lies within these ranges, else SS_EINVAL. */
ss_status ss_scene_supported(const ss_scene *scene, ss_error *err);

/* The i-th of the simpler scenes that a scene contains, the one that loses most the last: without
 * damping, with static friction equal to kinetic, without damping of the contact, with the model that
 * is its limit (Coulomb's, for a stiff contact or a friction that follows v at once), and without
 * friction.  Returns its name, "damping=0" or the name of its model, which is static; NULL after the
 * last. */
const char *ss_scene_simpler(ss_scene *simpler, const ss_scene *scene, size_t i);

/* Properties of a model; "?" or 0 for a number that is not that of a model. */
const char *ss_model_name(ss_model model);          /* "coulomb", "state-variable", ... */
int ss_model_has_events(ss_model model);            /* stick, slip and reverse */
int ss_model_is_linear(ss_model model);             /* between events: it has a closed form */
size_t ss_scene_samples(const ss_scene *scene);     /* round(duration * rate); SIZE_MAX if over that */
int ss_scene_is_pulled(const ss_scene *scene);      /* over its surface, and not forced */

/* Scenes that are built in.  ss_scene_load reads one by its name; text is what ss_scene_read takes. */
typedef struct ss_shipped_scene {
    const char *name;           /* "compliant-light" */
    const char *summary;        /* its first comment line: one line of plain text */
    const char *text;
} ss_shipped_scene;
/* The scenes of the paper's figures, and of other published results.  Both lists end with a NULL name. */
extern const ss_shipped_scene ss_shipped_scenes[];
extern const ss_shipped_scene ss_catalogue_scenes[];

SS_END_DECLARATIONS
#endif
