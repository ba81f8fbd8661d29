/* falls.c -- the falls of a spring's force in a record, as scenes are fitted to them. */
#include "fit/pulled.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "find/drops.h"
#include "find/judgement.h"
#include "scene/model.h"

enum { WINDOW = 512 };          /* the most samples of a fall */
enum { FEWEST_SAMPLES = 13 };   /* of a fall: four for each of its own unknowns */
#define BEFORE 0.5              /* its samples begin so many of its lengths before it, and end behind it */
#define BEHIND 1.0

void
ss_falls_doubt(char *why, size_t room, const ss_features *f, const ss_signal *signal, size_t column,
               const ss_scene *scene)
{
    double sum = 0;
    for (size_t i = 0; i < signal->n; i++)
        sum += signal->values[column * signal->n + i];
    if (f->loading == NULL || f->n == 0)
        snprintf(why, room, "%s", f->number[SS_SLIPS].why != NULL ? f->number[SS_SLIPS].why
                 : "no falls of a force are found: is it one by name or unit, and of one sign?");
    else if (sum * pull_of(scene) < 0)
        snprintf(why, room, "the force has the opposite sign of %s",
                 scene->base_velocity != 0 ? "base_velocity" : "a belt's");
}

void
ss_falls_count(char *why, size_t room, size_t slips, const ss_features *f)
{
    if (slips < FALLS_FEWEST || isnan(f->number[SS_LOADING_SLOPE].error))
        snprintf(why, room, "%zu slips are too few for a median and its scatter", slips);
}

static int
is_slip(const ss_features *f, size_t i)
{
    return isfinite(f->loading[i].friction.value);
}

/* Set the samples about a fall, which end at the middle of the sticks beside it.  0: they are too few. */
static int
set_fall(fall *w, const falls *r, const ss_features *f, size_t i, size_t n)
{
    const ss_transition *t = f->transition;
    double length = t[i].end - t[i].onset, end = (double)n / r->rate;
    double low = i > 0 ? 0.5 * (t[i - 1].end + t[i].onset) : 0;
    double high = i + 1 < f->n ? 0.5 * (t[i].end + t[i + 1].onset) : end;
    double from = fmax(fmax(t[i].onset - BEFORE * length, low), 0) * r->rate;
    double to = fmin(fmin(t[i].end + BEHIND * length, high), end) * r->rate;
    size_t top = (size_t)(t[i].onset * r->rate), bottom = (size_t)fmin(t[i].end * r->rate, (double)n - 1);
    *w = (fall){ .first = (size_t)ceil(from), .step = 1 + (size_t)((to - from) / WINDOW),
                 .onset = t[i].onset * r->rate, .top = r->y[top],
                 .middle = 0.5 * (r->y[top] + r->y[bottom]) };
    w->n = (size_t)((to - ceil(from)) / (double)w->step);
    if (is_slip(f, i)) {
        w->top = fabs(f->loading[i].static_friction.value);
        w->middle = fabs(f->loading[i].friction.value);
    }
    return t[i].end * r->rate < to && w->n >= FEWEST_SAMPLES && w->top > w->middle;
}

/* Copy the force to out->y without its glitches, in the direction of the pull, and find its noise. */
static ss_status
copy_force(falls *out, const ss_features *f, const double *x, size_t n, double direction)
{
    double *along = malloc((n + 1) * sizeof *along);
    ss_drop *drop = calloc(f->n + 1, sizeof *drop);
    out->y = malloc((n + 1) * sizeof *out->y);
    ss_status st = along != NULL && drop != NULL && out->y != NULL ? SS_OK : SS_ENOMEM;
    rank_record r = { .x = along, .n = n };
    for (size_t i = 0; st == SS_OK && i < n; i++)
        along[i] = direction * x[i];
    for (size_t i = 0; st == SS_OK && i < f->n; i++)
        drop[i] = (ss_drop){ (size_t)(f->transition[i].onset * out->rate),
                             (size_t)fmin(f->transition[i].end * out->rate, (double)n - 1) };
    if (st == SS_OK)
        st = ss_record_noise(&r, 0);
    if (st == SS_OK)
        st = ss_drops_without_glitches(out->y, along, n, drop, f->n);
    out->noise = r.noise;
    free(along);
    free(drop);
    return st;
}

/* Slips of a Coulomb slider are surely falls: if most are such slips, the others are left out.  Of
 * the usable falls at most FALLS_MOST are chosen, evenly over the record. */
static ss_status
choose_falls(falls *out, const ss_features *f, size_t n)
{
    double squares = 0, samples = 0;    /* about the mean of their fall */
    size_t slips = 0, n_usable = 0, *usable = malloc((f->n + 1) * sizeof *usable);
    if (usable == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < f->n; i++)
        slips += (size_t)is_slip(f, i);
    for (size_t i = 0; i < f->n; i++)
        if (!f->transition[i].gap && ((double)slips < MOSTLY * (double)f->n || is_slip(f, i)))
            usable[n_usable++] = i;
    size_t most = n_usable < FALLS_MOST ? n_usable : FALLS_MOST;
    for (size_t i = 0; i < most; i++)
        out->n += (size_t)set_fall(&out->fall[out->n], out, f, usable[i * n_usable / most], n);
    out->first = n_usable > 0 ? f->transition[usable[0]].onset : NAN;
    for (size_t i = 0; i < out->n; i++) {
        const fall *w = &out->fall[i];
        double mean = 0;
        for (size_t k = 0; k < w->n; k++) {
            double d = out->y[w->first + k * w->step] - mean;
            mean += d / (double)(k + 1);
            squares += d * (out->y[w->first + k * w->step] - mean);
        }
        samples += (double)w->n;
    }
    out->power = squares / samples;
    free(usable);
    return SS_OK;
}

ss_status
ss_falls_gather(falls *out, char *why, size_t room, const ss_features *f, const ss_signal *signal, size_t column,
                const ss_scene *scene)
{
    *out = (falls){ .rate = signal->head->rate, .slope = f->number[SS_LOADING_SLOPE],
                    .k_over_m = f->number[SS_K_OVER_M] };
    ss_falls_doubt(why, room, f, signal, column, scene);
    if (why[0] == '\0')
        ss_falls_count(why, room, f->n, f);
    if (why[0] != '\0')
        return SS_OK;
    ss_status st = copy_force(out, f, signal->values + column * signal->n, signal->n, sign(pull_of(scene)));
    if (st == SS_OK)
        st = choose_falls(out, f, signal->n);
    if (st == SS_OK && out->n < FALLS_FEWEST)
        snprintf(why, room, "%zu falls that are whole are too few", out->n);
    return st;
}

void
ss_falls_free(falls *r)
{
    free(r->y);
    r->y = NULL;
}
