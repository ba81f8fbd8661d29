/* spike_score.h -- spikes found in the acceleration of a scene, held against the simulator's
 * events.
 *
 * A slip that sticks again within twice the scale at which a spike is seen is one event with
 * the stick that ends it: a spike between the two is right. */
#ifndef SPIKE_SCORE_H
#define SPIKE_SCORE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "find/events.h"
#include "shipped.h"
#include "noise_rms.h"
#include "signal/noise.h"

enum { SCORE_EVENTS = 1000 };
#define SCORE_MACRO 0.05        /* [s] a slip that sticks again sooner is a micro-slip */

typedef struct score_scene {
    ss_scene scene;
    ss_signal *signal;
    const double *a;            /* its acceleration */
    size_t n, n_events;
    ss_event event[SCORE_EVENTS];
} score_scene;

typedef struct score {
    size_t jumps, kinks, bends, glitches;
    size_t right, near, good;   /* jumps and kinks at an event, within 1 and 2 samples of it */
    size_t wrong;               /* those farther than two scales from all */
    size_t transitions, grouped;
    char seen[SCORE_EVENTS];    /* 1: a spike within its scale of the event */
} score;

static inline int
score_keep(const ss_event *e, void *user)
{
    score_scene *s = user;
    if (s->n_events < SCORE_EVENTS)
        s->event[s->n_events++] = *e;
    return 0;
}

/* damping: contact damping in place of the scene's, unless 0. */
static inline void
score_scene_make(score_scene *s, const char *name, double rate, double duration, double damping)
{
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    s->n_events = 0;
    s->scene = read_shipped_named(name);
    s->scene.rate = rate;
    s->scene.duration = duration;
    if (damping > 0)
        ss_scene_set(&s->scene, "contact_damping", damping, NULL);
    opts.events = score_keep;
    opts.user = s;
    if (ss_sim_run(&s->scene, &opts, NULL, NULL) != SS_OK
        || ss_sim_signal(&s->signal, &s->scene, NULL) != SS_OK)
        exit(2);
    s->n = s->signal->n;
    s->a = s->signal->values + (size_t)ss_header_column(s->signal->head, "a") * s->n;
}

/* Seconds of slip that event i begins, if it is a micro-slip, else 0. */
static inline double
score_micro_slip(const score_scene *s, size_t i)
{
    if (s->event[i].kind != SS_SLIP || i + 1 >= s->n_events || s->event[i + 1].kind != SS_STICK)
        return 0;
    double length = s->event[i + 1].t - s->event[i].t;
    return length < SCORE_MACRO ? length : 0;
}

/* From a spike at t, seen at scale a, to the nearest event [s]. */
static inline double
score_distance(const score_scene *s, double t, double a)
{
    double least = INFINITY;
    for (size_t i = 0; i < s->n_events; i++) {
        double slip = score_micro_slip(s, i), since = t - s->event[i].t;
        int between = slip > 0 && slip < 2 * a && since > 0 && since < slip;
        least = fmin(least, between ? 0 : fabs(since));
    }
    return least;
}

static inline ss_status
spikes_of(ss_spikes **out, const double *x, size_t n, double rate, const ss_span *gap, size_t n_gaps)
{
    row_source source;
    ss_row_source_init(&source, x, n, rate, gap, n_gaps);
    return ss_spikes_find(out, &source);
}

/* The noise comes from the seed; snr infinite: none. */
static inline ss_spikes *
score_find(const score_scene *s, double snr, unsigned long seed)
{
    ss_spikes *found = NULL;
    double *x = malloc(s->n * sizeof *x);
    if (x == NULL)
        exit(2);
    memcpy(x, s->a, s->n * sizeof *x);
    if (isfinite(snr) && ss_noise_add_once(x, s->n, noise_rms(x, s->n, snr), seed, NULL) != SS_OK)
        exit(2);
    if (spikes_of(&found, x, s->n, s->scene.rate, NULL, 0) != SS_OK)
        exit(2);
    free(x);
    return found;
}

/* What was found is added to the score; seen is of this record alone. */
static inline void
score_add(score *sc, const score_scene *s, const ss_spikes *found)
{
    double onset = NAN;
    memset(sc->seen, 0, sizeof sc->seen);
    for (size_t i = 0; i < found->n; i++) {
        const ss_spike *spike = &found->spike[i];
        double a = 6 / (2 * M_PI * spike->f), off = score_distance(s, spike->t, a);
        sc->jumps += spike->kind == SS_SPIKE_JUMP;
        sc->kinks += spike->kind == SS_SPIKE_KINK;
        sc->bends += spike->kind == SS_SPIKE_BEND;
        sc->glitches += spike->kind == SS_SPIKE_GLITCH;
        if (spike->kind == SS_SPIKE_BEND)
            continue;
        sc->wrong += off > 2 * a;
        sc->right += off <= 2 * a;
        sc->near += off * s->scene.rate <= 1;
        sc->good += off * s->scene.rate <= 2;
        for (size_t e = 0; e < s->n_events; e++)
            sc->seen[e] |= fabs(spike->t - s->event[e].t) <= a;
    }
    for (size_t e = 0; e < s->n_events; e++) {
        double slip = score_micro_slip(s, e);
        int restick = e > 0 && score_micro_slip(s, e - 1) > 0;
        if (s->event[e].kind == SS_STICK && !restick)
            onset = s->event[e].t;
        if (s->event[e].kind != SS_SLIP || slip > 0 || isnan(onset))
            continue;
        sc->transitions++;
        sc->grouped += ss_spikes_within(found, onset, s->event[e].t, 60) > 2;
    }
}

/* Of the micro-slips of [shortest, longest) seconds: how many there are, and were seen. */
static inline void
score_slips(const score_scene *s, const score *sc, double shortest, double longest, size_t *all,
            size_t *seen)
{
    for (size_t e = 0; e < s->n_events; e++) {
        double slip = score_micro_slip(s, e);
        if (slip == 0 || slip < shortest || slip >= longest)
            continue;
        ++*all;
        *seen += sc->seen[e] || sc->seen[e + 1];
    }
}

#endif
