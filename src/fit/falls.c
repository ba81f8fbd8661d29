/* falls.c -- the falls of a spring's force in a record, as scenes are fitted to them. */
#include "fit/falls.h"

#include <math.h>
#include <stdlib.h>
#include "find/drops.h"
#include "fit/record.h"

enum { WINDOW = 512 };          /* the most samples of a fall */
#define BEFORE 0.5              /* its samples begin so many of its lengths before it, and end behind it */
#define BEHIND 1.0

static int
is_slip(const ss_features *f, size_t i)
{
    return isfinite(f->loading[i].friction.value);
}

/* Slips of a Coulomb slider are surely falls: if three quarters are such slips, the others are left out. */
static size_t
find_usable(const ss_features *f, size_t *usable)
{
    size_t slips = 0, n = 0;
    for (size_t i = 0; i < f->n; i++)
        slips += (size_t)is_slip(f, i);
    for (size_t i = 0; i < f->n; i++)
        if (!f->transition[i].gap && (4 * slips < 3 * f->n || is_slip(f, i)))
            usable[n++] = i;
    return n;
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
    return t[i].end * r->rate < to && w->n > 4 * FALL_UNKNOWNS && w->top > w->middle;
}

static double
power_of(const falls *r)
{
    double sum = 0, n = 0;
    for (size_t i = 0; i < r->n; i++) {
        const fall *w = &r->fall[i];
        double mean = 0, squares = 0;
        for (size_t k = 0; k < w->n; k++) {
            double d = r->y[w->first + k * w->step] - mean;
            mean += d / (double)(k + 1);
            squares += d * (r->y[w->first + k * w->step] - mean);
        }
        sum += squares;
        n += (double)w->n;
    }
    return n > 0 ? sum / n : NAN;
}

/* Choose at most FALLS_MOST of the usable falls, evenly over the record. */
static void
choose(falls *out, const ss_features *f, size_t *usable, size_t n)
{
    size_t n_usable = find_usable(f, usable), most = n_usable < FALLS_MOST ? n_usable : FALLS_MOST;
    for (size_t i = 0; i < most; i++)
        out->n += (size_t)set_fall(&out->fall[out->n], out, f, usable[i * n_usable / most], n);
    out->first = n_usable > 0 ? f->transition[usable[0]].onset : NAN;
    out->power = power_of(out);
}

ss_status
ss_falls_gather(falls *out, const ss_features *f, const ss_signal *signal, size_t column, double direction)
{
    size_t n = signal->n;
    double *x = malloc((n + 1) * sizeof *x);
    ss_drop *drop = calloc(f->n + 1, sizeof *drop);
    size_t *usable = malloc((f->n + 1) * sizeof *usable);
    *out = (falls){ .y = malloc((n + 1) * sizeof *x), .rate = signal->head->rate, .slope = f->slope,
                    .k_over_m = f->k_over_m };
    ss_status st = x != NULL && drop != NULL && usable != NULL && out->y != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < n; i++)
        x[i] = direction * signal->values[column * n + i];
    for (size_t i = 0; st == SS_OK && i < f->n; i++)
        drop[i].height = x[(size_t)(f->transition[i].onset * out->rate)]
                         - x[(size_t)fmin(f->transition[i].end * out->rate, (double)n - 1)];
    rank_record r = { .x = x, .n = n };
    if (st == SS_OK)
        st = ss_record_noise(&r, 0);
    if (st == SS_OK)
        st = ss_drops_without_glitches(out->y, x, n, drop, f->n);
    if (st == SS_OK)
        choose(out, f, usable, n);
    out->noise = r.noise;
    free(usable);
    free(drop);
    free(x);
    return st;
}

void
ss_falls_free(falls *r)
{
    free(r->y);
    r->y = NULL;
}
