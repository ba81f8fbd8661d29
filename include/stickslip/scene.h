/* stickslip/scene.h -- a scene: a friction model, its parameters, and the length of its record.
 *
 * All models obey  m x'' + d x' + k x + f = k (Z_e cos(Omega t + phase) + U t),  where t = 0 is
 * the start of settling.  A measured displacement z(t) may replace Z_e cos(Omega t + phase).  The
 * models differ in the friction force f, which depends on v = x' - S.  stickslip-scene(5)
 * describes the text of a scene. */
#ifndef STICKSLIP_SCENE_H
#define STICKSLIP_SCENE_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* A friction model: its law, the keys of its own parameters, and what it can do.  Its name stands in
 * scenes: "coulomb", "state-variable", "compliant", "stribeck". */
typedef struct ss_model ss_model;
const ss_model *ss_model_named(const char *name);   /* NULL: there is none */
const char *ss_model_name(const ss_model *model);   /* "?" for NULL */
int ss_model_has_events(const ss_model *model);     /* 1: it has events; 0: it is smooth, or NULL */

typedef struct ss_base ss_base;     /* the measured displacement z(t) of a base */
enum { SS_BASE_FILE = 256, SS_BASE_COLUMN = 64, SS_SCENE_OWN = 16 };

typedef struct ss_scene {
    const ss_model *model;      /* NULL: none yet, which no function accepts */
    double mass;                /* m      [kg]     > 0 */
    double stiffness;           /* k      [N/m]    > 0 */
    double friction;            /* f_k    [N]     >= 0, kinetic friction */
    double base_amplitude;      /* Z_e    [m]     >= 0 */
    double base_frequency;      /* Omega / 2 pi [Hz] >= 0 */
    double phase;               /* [rad] */
    double x0, v0;              /* displacement and velocity at the start of settling [m, m/s] */
    double damping;             /* d      [N s/m] >= 0, viscous damping of the mass */
    double base_velocity;       /* U      [m/s]: the spring's end moves at this speed */
    double surface_velocity;    /* S      [m/s]: the surface under the mass moves, as a belt does */
    double static_friction;     /* f_s    [N]     >= f_k; 0: equal to f_k, or the model has none */
    double friction_negative, static_friction_negative; /* those of motion to smaller x; 0: as the others */

    double own[SS_SCENE_OWN];   /* the model's own parameters, which ss_scene_get and ss_scene_set find
                                   by their keys; for a word, its number */

    char base_file[SS_BASE_FILE];       /* the file of z(t), "": none; ss_base_load reads it */
    char base_column[SS_BASE_COLUMN];   /* its column; "": the column z, or the only column */
    const ss_base *base;                /* z(t) in place of Z_e cos(...), owned by the caller;
                                           NULL: the cosine */

    double settle;              /* [s] >= 0  this much motion comes before the record */
    double duration;            /* [s] >= 0  length of the record */
    double rate;                /* [Hz] 1e-300 ... 1e300  samples per second */
} ss_scene;

/* duration 10 s, rate 2000 Hz, 0 elsewhere.  A caller copies it, sets the model, and then fields and keys. */
extern const ss_scene ss_scene_defaults;

/* One sample of the motion.  A sample at the time of an event is the state after that event. */
typedef struct ss_sample {
    double t;           /* [s] from the start of the record: sample n is at n / rate */
    double x, v, a;     /* displacement, velocity, acceleration of the mass [m, m/s, m/s^2] */
    double f;           /* friction force, with the sign that it has in the equation of motion [N] */
    double s;           /* force of the spring on the mass, k (z - x) [N] */
    double y;           /* deflection of the contact [m]: +-f_k/K_y in slip; 0 if not compliant */
    double z;           /* displacement of the base, with U t [m] */
    int mode;           /* 0 in a stick (compliant: a microstick), else the sign of the slip over the
                           surface; state-variable: the sign of x' - S */
} ss_sample;

typedef enum ss_event_kind {
    SS_STICK,           /* a stick begins (compliant: a microstick) */
    SS_SLIP,            /* a slip begins */
    SS_REVERSE          /* the slip changes its direction without a stick between */
} ss_event_kind;

typedef struct ss_event {
    double t;           /* [s] from the start of the record */
    double x, v;        /* displacement and velocity of the mass [m, m/s] */
    ss_event_kind kind;
    int direction;      /* +1 or -1, of the slip that begins; with SS_STICK, of the slip that ended */
} ss_event;

/* Read a scene from text, in which the n settings "key=value" then replace values; settings may be NULL if n is 0.
 * Messages call the file by name.  If in is NULL, name is that of a shipped scene ("compliant-light"), or else the
 * path of a file.  On failure *scene does not change.  SS_EDATA: a key is unknown, repeated, missing, malformed,
 * out of its range, or not one of the model's; SS_EINVAL: a setting is; SS_EIO: reading failed, or there is no
 * such scene, and err lists the shipped names. */
ss_status ss_scene_read(ss_scene *scene, FILE *in, const char *name, const char *const settings[], size_t n,
                        ss_error *err);

/* SS_OK if every parameter that the model has lies in its range, else SS_EINVAL. */
ss_status ss_scene_check(const ss_scene *scene, ss_error *err);

/* Write each key that the model has as a line, but for terms that are 0 when left out, its value with the fewest
 * digits from which ss_scene_read gets the same double.  SS_EIO: writing failed. */
ss_status ss_scene_write(const ss_scene *scene, FILE *out, ss_error *err);

/* If the scene names a base_file, make z(t) [m] of it, the natural cubic spline through its base_column, and set
 * scene->base to *base; else *base becomes NULL.  The name is relative to the folder of scene_path, the file from
 * which the scene was read; the file is of any format that ss_reader_new opens.  Its clock is the scene's: its
 * t = 0 is the start of settling.  The caller frees *base after the last use of the scene.  SS_EDATA: the column's
 * unit is not m, or it has fewer than 3 samples; SS_ENOMEM. */
ss_status ss_base_load(ss_base **base, ss_scene *scene, const char *scene_path, ss_error *err);
void ss_base_free(ss_base *base);                   /* NULL is allowed */

/* The number that key names, of the scene or of its model.  NaN: the model has no such number. */
double ss_scene_get(const ss_scene *scene, const char *key);
/* Set this number.  It may be out of its range, as a field may: ss_scene_check tells.  SS_EINVAL: the
 * model has no such number; err says what is wrong with the key. */
ss_status ss_scene_set(ss_scene *scene, const char *key, double value, ss_error *err);
/* Set a key from the text that a scene would have there, such as "release" from "total".  Another model
 * keeps the values of the keys that both have; its others are 0.  SS_EINVAL: there is no such key, or no
 * such value. */
ss_status ss_scene_set_text(ss_scene *scene, const char *key, const char *value, ss_error *err);

size_t ss_scene_samples(const ss_scene *scene);     /* round(duration * rate); SIZE_MAX from 2^53 on */
int ss_scene_is_pulled(const ss_scene *scene);      /* 1: U or S moves it, and no forcing does */

/* The built-in scenes.  ss_scene_read finds one by its name. */
typedef struct ss_shipped_scene {
    const char *name;           /* "compliant-light" */
    const char *summary;        /* its first comment line, one line of plain text */
    const char *text;           /* for ss_scene_read */
} ss_shipped_scene;
/* The scenes of the paper's figures, and those of other published results.  A NULL name ends each. */
extern const ss_shipped_scene ss_shipped_scenes[];
extern const ss_shipped_scene ss_catalogue_scenes[];

SS_END_DECLARATIONS
#endif
