/* observation.c -- numbers from the features, spikes and contours of a signal, and the distance of
 * two signals by them. */
#include "fit/observation.h"
#include "find/search.h"
#include "map/map.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <stickslip/features.h>
#include <stickslip/spikes.h>

static double
median(double *x, size_t n)
{
    return n > 0 ? gsl_stats_median(x, 1, n) : NAN;
}

static double
level(const observation *l, size_t c, double top)
{
    double size = hypot(l->map->w[2 * c], l->map->w[2 * c + 1]);
    return fmax(size > 0 ? 20 * log10(size / top) : -SPAN, -SPAN);
}

/* The median over half cycles of the largest |W| in each along the shortest scale [dB re the
 * map's]. */
static ss_status
measure_jumps(observation *l, double half)
{
    const ss_scale *s = &l->map->scale[l->map->n_scales - 1];
    double top = ss_coefficients_max(l->map), rate = l->map->head->rate;
    size_t halves = (size_t)((double)l->map->n / rate / half);
    double *most = malloc((halves + 1) * sizeof *most);
    if (most == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < halves; i++)
        most[i] = -SPAN;
    for (size_t k = 0; top > 0 && k < s->n; k++) {
        size_t i = (size_t)(ss_scale_b(s, k) / half);
        if (i < halves && !ss_coefficients_edge(l->map, l->map->n_scales - 1, k))
            most[i] = fmax(most[i], level(l, s->offset + k, top));
    }
    l->value[SS_BY_JUMP] = median(most, halves);
    free(most);
    return SS_OK;
}

/* Measure the spikes that are at most 20 dB below the strongest: their number in a half cycle, and the median
 * of their slopes. */
static ss_status
measure_spikes(observation *l, const ss_spikes *found, double halves)
{
    size_t count = 0;
    double *slope = malloc((found->n + 1) * sizeof *slope);
    if (slope == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < found->n; i++)
        if (found->spike[i].kind != SS_SPIKE_GLITCH && found->spike[i].level >= -20)
            slope[count++] = found->spike[i].slope;
    l->countable = found->conclusive;
    l->value[SS_BY_SPIKES] = (double)count / halves;
    l->value[SS_BY_SLOPE] = median(slope, count);
    free(slope);
    return SS_OK;
}

static ss_status
measure_features(observation *l, const ss_signal *signal, size_t column, double half, ss_error *err)
{
    ss_features *f = NULL;
    ss_features_opts opts;
    ss_features_opts_init(&opts, sizeof opts);
    opts.displacement = ss_header_column(signal->head, "x");
    opts.force = ss_header_column(signal->head, "f");
    ss_status st = ss_features_find(&f, signal, column, &opts, err);
    if (st != SS_OK)
        return st;
    double halves = (double)signal->n / signal->head->rate / half;
    l->has_slope = opts.displacement >= 0 && opts.force >= 0;
    l->value[SS_BY_MAXIMUM] = fmin((double)f->recurring / floor(halves), 1);
    l->value[SS_BY_FREQUENCY] = f->number[SS_TRANSITION_FREQUENCY].value;
    l->value[SS_BY_DAMPING] = f->number[SS_DAMPING_RATIO].value;
    l->value[SS_BY_STIFFNESS] = f->number[SS_CONTACT_STIFFNESS_SLOPE].value;
    st = measure_spikes(l, f->spikes, halves);
    ss_features_free(f);
    return st;
}

void
ss_observation_free(observation *l)
{
    ss_coefficients_free(l->map);
    l->map = NULL;
}

ss_status
ss_observation_of(observation *l, const ss_signal *signal, size_t column, double period,
                  ss_error *err)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_status st;
    opts.voices = 4;
    opts.accuracy = 1e-4;
    opts.detrend = SS_DETREND_MEAN;
    for (size_t i = 0; i < SS_CRITERIA; i++)
        l->value[i] = NAN;
    l->map = NULL;
    st = measure_features(l, signal, column, period / 2, err);
    if (st == SS_OK)
        st = ss_morlet_transform(&l->map, signal, column, &opts, err);
    if (st == SS_OK)
        st = measure_jumps(l, period / 2);
    if (st != SS_OK)
        ss_observation_free(l);
    return st;
}

/* The rms difference of the levels of two maps on one grid, every octave counting the same. */
static double
map_distance(const observation *a, const observation *b)
{
    double top_a = ss_coefficients_max(a->map), top_b = ss_coefficients_max(b->map), sum = 0;
    if (!(top_a > 0 && top_b > 0))
        return NAN;
    for (size_t i = 0; i < a->map->n_scales; i++) {
        const ss_scale *s = &a->map->scale[i];
        double squares = 0, count = 0;
        for (size_t k = 0; k < s->n; k++) {
            double d = level(a, s->offset + k, top_a) - level(b, s->offset + k, top_b);
            if (ss_coefficients_edge(a->map, i, k))
                continue;
            squares += d * d;
            count++;
        }
        sum += count > 0 ? squares / count : 0;
    }
    return sqrt(sum / (double)a->map->n_scales);
}

static double
distance(ss_criterion c, double a, double b)
{
    if (isnan(a) && isnan(b))
        return 0;
    if (c == SS_BY_FREQUENCY || c == SS_BY_DAMPING || c == SS_BY_STIFFNESS)
        return fabs(log(a / b));
    return fabs(a - b);
}

void
ss_observation_compare(ss_rank_row *row, const observation *signal, const observation *model)
{
    for (size_t i = SS_BY_MAXIMUM; i < SS_CRITERIA; i++) {
        row->value[i] = model->value[i];
        row->distance[i] = distance((ss_criterion)i, signal->value[i], model->value[i]);
    }
    /* where noise hides spikes, their number and kind describe the noise */
    if (!signal->countable)
        row->distance[SS_BY_SPIKES] = row->distance[SS_BY_SLOPE] = 0;
    if (!signal->has_slope) {
        row->value[SS_BY_STIFFNESS] = NAN;
        row->distance[SS_BY_STIFFNESS] = 0;
    }
    row->value[SS_BY_MAP] = row->distance[SS_BY_MAP] = map_distance(signal, model);
}
