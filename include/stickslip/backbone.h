/* stickslip/backbone.h -- free decays: frequency and damping against amplitude, and the mechanism behind. */
#ifndef STICKSLIP_BACKBONE_H
#define STICKSLIP_BACKBONE_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/scene.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>
#include <stickslip/table.h>

SS_BEGIN_DECLARATIONS

/* What damps, by how the damping s [1/s] and the frequency depend on the amplitude A of the fundamental. */
typedef enum ss_mechanism {
    SS_VISCOUS,                 /* s constant */
    SS_COULOMB_DAMPING,                 /* s = c / A */
    SS_VISCOUS_AND_COULOMB,         /* the sum of these two */
    SS_JENKINS,                 /* a spring behind a slider, and viscous friction beside it */
    SS_MICROSLIP,               /* s = c A^p, 0 < p <= 1; the frequency falls by b A^p; and viscous friction */
    SS_QUADRATIC,               /* s = c A */
    SS_MECHANISMS
} ss_mechanism;

typedef struct ss_backbone_opts {
    size_t size;                /* set by ss_backbone_opts_init */
    double mode;                /* [Hz] the strongest mode within 15 % of this; 0: the strongest of all */
    double periods;             /* of a block, 1.5 ... 1e6; 0: chosen */
    double level_frequency;     /* [Hz] > 0: the column is the level [dB] of a decay of this frequency, without
                                   phase; 0: it is the signal itself */
    double mass;                /* [kg] > 0: forces are wanted, too, of a column in m, m/s or m/s^2; 0: none */
} ss_backbone_opts;
void ss_backbone_opts_init(ss_backbone_opts *opts, size_t size);    /* all 0 */

typedef struct ss_backbone_row {
    double t;                   /* [s] from the record's first sample: the middle of its block */
    double amplitude;           /* of the fundamental, in the column's unit; of levels 10^(dB/20) */
    ss_value frequency;         /* [Hz] the undamped one, sqrt(w^2 + s^2) / (2 pi); of levels without error */
    ss_value damping_ratio;     /* s / sqrt(w^2 + s^2) */
    double periods;             /* of its block */
    double named[2];            /* frequency [Hz] and damping ratio by the mechanism, if one is named; else NaN */
} ss_backbone_row;

enum { SS_MECHANISM_NUMBERS = 8 };  /* at most */

/* A parameter of a mechanism. */
typedef struct ss_backbone_number {
    const char *name;           /* constant text */
    char unit[64];
    ss_value value;
} ss_backbone_number;
enum { SS_BACKBONE_NUMBERS = 8 };   /* at most */

typedef struct ss_backbone {
    size_t n;
    ss_backbone_row *row;       /* ascending in t */
    const char *why;            /* constant text: why there are no rows; NULL: there are some */
    const char *start, *stop;   /* constant text: why the first row is no earlier, and the last no later */
    double noise;               /* standard deviation of the samples about the decay, near its end */
    size_t n_mechanisms;        /* 0: another; 1: it is named; else it cannot be told among these, best first */
    ss_mechanism mechanism[SS_MECHANISMS];
    double chi2_dof;            /* of the best one; NaN: there are no rows */
    size_t n_numbers;           /* of the first mechanism */
    ss_backbone_number number[SS_BACKBONE_NUMBERS];
    const char *other;          /* constant text: why no mechanism is named; NULL: one is, or no rows */
} ss_backbone;

/* Follow the largest free decay in a column of a signal.  That there is none, and that its mechanism cannot be
 * told, are answers, with SS_OK.  SS_EDATA: a value is not finite; SS_EINVAL: an option is out of its range, or
 * the mass is given and the column is in another unit.  opts may be NULL.  The caller frees *out with
 * ss_backbone_free. */
ss_status ss_backbone_find(ss_backbone **out, const ss_signal *signal, size_t column, const ss_backbone_opts *opts,
                           ss_error *err);
void ss_backbone_free(ss_backbone *backbone);           /* NULL is allowed */

/* Write rows and notes, as ss-backbone(1) describes; the signal and the column are those of ss_backbone_find.
 * ss_table_read reads them (SS_KIND_BACKBONE).  SS_EINVAL: the format holds numbers only; SS_EIO. */
ss_status ss_backbone_write(const ss_backbone *backbone, const ss_signal *signal, size_t column, FILE *out,
                            ss_format format, ss_error *err);
/* The scene of a rig of this mass [kg] that decays as the first mechanism does, from the amplitude of the first
 * row on, where x = 0 and v > 0.  SS_EDATA: no mechanism is named, or none that has a scene, or the column is no
 * motion in SI units; err says which. */
ss_status ss_backbone_scene(ss_scene *scene, const ss_backbone *backbone, const ss_signal *signal, size_t column,
                            double mass, ss_error *err);

SS_END_DECLARATIONS
#endif
