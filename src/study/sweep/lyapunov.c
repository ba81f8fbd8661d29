/* lyapunov.c -- the largest Lyapunov exponent of a motion without a period.
 *
 * The derivative of each cycle carries a difference of neighbouring states to the next cycle,
 * where its length is set to one again (Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15,
 * 1980).  Events act by their saltation matrices, and a stick removes one direction (Mueller,
 * Chaos Solitons Fractals 5, 1995).  The exponent is the sum of the logarithms of the lengths over
 * time.  The scatter of parts of this mean tells its error; the parts are long compared with the
 * memory of the motion. */
#include "study/sweep/finder.h"

#include <math.h>

enum { PARTS = 20 };

typedef struct part {
    double log, time;               /* the logarithm of a difference's growth, in this time [s] */
} part;

/* Carry the difference across the cycle that ends in m, and return the factor by which it has grown. */
static double
stretch(const tangent *t, const state *m, const double unit[D_MOST], double difference[D_MOST])
{
    int is_free[D_MOST];
    double next[D_MOST], size = 0;
    m->model->variation->free(m, is_free);
    for (int i = 0; i < D_MOST; i++) {
        next[i] = 0;
        for (int j = 0; j < D_MOST && is_free[i]; j++)
            next[i] += t->d[i][j] * unit[j] / unit[i] * difference[j];
        size += next[i] * next[i];
    }
    size = sqrt(size);
    for (int i = 0; i < D_MOST; i++)
        difference[i] = next[i] / size;
    return size;
}

static ss_status
follow(finder *f, unsigned long cycles, double difference[D_MOST], part *out)
{
    double unit[D_MOST], begun = f->w.m.origin.hi + f->w.m.now.u;
    tangent t;
    ss_status st = SS_OK;
    ss_finder_coordinate_units(f, unit);
    *out = (part){ 0, 0 };
    for (unsigned long i = 0; st == SS_OK && i < cycles; i++) {
        st = ss_finder_derive(f, 1, NEWTON, &t);
        out->log += log(stretch(&t, &f->w.m.now, unit, difference));
    }
    out->time = f->autonomous ? f->w.m.origin.hi + f->w.m.now.u - begun
        : (double)cycles / f->scene->base_frequency;
    return st;
}

ss_status
ss_finder_exponent(finder *f, unsigned long cycles, double *exponent, double *error)
{
    double difference[D_MOST] = { 1, 1, 1 }, log = 0, time = 0, scatter = 0;
    part parts[PARTS];
    ss_status st = follow(f, cycles / 10, difference, &parts[0]);   /* it turns to where it grows most */
    for (int i = 0; st == SS_OK && i < PARTS; i++) {
        st = follow(f, (cycles + PARTS - 1) / PARTS, difference, &parts[i]);
        log += parts[i].log;
        time += parts[i].time;
    }
    if (st != SS_OK)
        return st;
    *exponent = log / time;
    for (int i = 0; i < PARTS; i++)
        scatter += pow(parts[i].log - *exponent * parts[i].time, 2);
    *error = sqrt(scatter * PARTS / (PARTS - 1)) / time;
    return SS_OK;
}
