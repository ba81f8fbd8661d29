/* places.c -- compute coefficients at any translations from the points of an oversampled series.
 *
 * Between points the series is a sum of KAISER_TAPS points with the weights of a kernel (kaiser.c), which are
 * polynomials of the place.  This sum is then multiplied by the carrier.  A place is kept as a whole number of
 * points and a rest, so that the phase of the carrier is right to the last bit. */
#include <math.h>
#include <string.h>
#include "base/versions.h"
#include "map/points.h"

enum { LANES = 8, AT_ONCE = 64,
    LEAD = KAISER_TAPS / 2 - 1 };       /* points before that before a place */

typedef double lanes __attribute__((vector_size(LANES * sizeof(double)), aligned(sizeof(double)), may_alias));
typedef double pair __attribute__((vector_size(2 * sizeof(double))));

/* Functions that are compiled into each version of their caller, for several kinds of machine. */
#define INLINE static inline __attribute__((always_inline))

/* AT_ONCE translations: the point before each, and the distance behind this point, at most 1. */
typedef struct places {
    double point[AT_ONCE], behind[AT_ONCE];
} places;

/* Computes as ss_scale_spot does, in two loops, for which compilers use vectors. */
INLINE void
find_places(const point_series *s, double b_num, double b_den, double rate, double first, places *out)
{
    double b[AT_ONCE], sample[AT_ONCE], time[AT_ONCE], beyond[AT_ONCE], per_sample = 1 / s->samples;
    for (int i = 0; i < AT_ONCE; i++) {
        b[i] = (first + i) * b_num / b_den;
        sample[i] = rint(b[i] * rate);
        time[i] = sample[i] / rate;
        beyond[i] = fma(b[i], rate, -sample[i]);
    }
    for (int i = 0; i < AT_ONCE; i++) {
        double tau = time[i] == b[i] ? 0 : beyond[i], c = sample[i] - s->start;
        double near = rint(c * per_sample), rest = (c - near * s->samples + tau) * per_sample;
        double point = rint(rest - 0.5);
        out->point[i] = near + point;
        out->behind[i] = rest - point;
    }
}

/* Four weights, each twice, for re and im. */
#define TWO(w, i) (w)[i], (w)[i]
#define TWICE(w, i) (lanes){ TWO(w, i), TWO(w, (i) + 1), TWO(w, (i) + 2), TWO(w, (i) + 3) }

/* The weights of the taps of a place so far behind its point, each twice. */
INLINE void
weights_behind(const kaiser *ker, double behind, lanes weight[4])
{
    double f = behind * KAISER_PARTS;
    int part = (int)f < KAISER_PARTS ? (int)f : KAISER_PARTS - 1;
    double y = 2 * (f - part) - 1;
    const lanes *c = (const lanes *)ker->table[part][KAISER_NODES - 1];
    lanes low = c[0], high = c[1];
    UNROLL
    for (int m = KAISER_NODES - 1; m > 0; m--) {
        c -= KAISER_TAPS / LANES;
        low = low * y + c[0];
        high = high * y + c[1];
    }
    for (int k = 0; k < 4; k++) {
        lanes half = k < 2 ? low : high;
        weight[k] = k % 2 == 0 ? TWICE(half, 0) : TWICE(half, 4);
    }
}

INLINE void
add_taps(const kaiser *ker, const double *v, const places *at, size_t n, double (*sum)[2])
{
    for (size_t i = 0; i < n; i++) {
        const lanes *point = (const lanes *)(v + 2 * ((ptrdiff_t)at->point[i] - LEAD));
        lanes weight[4];
        weights_behind(ker, at->behind[i], weight);
        lanes all = point[0] * weight[0];
        all += point[1] * weight[1];
        all += point[2] * weight[2];
        all += point[3] * weight[3];
        pair of[4];
        memcpy(of, &all, sizeof of);
        of[0] = (of[0] + of[1]) + (of[2] + of[3]);
        memcpy(sum[i], of, sizeof *sum);
    }
}

/* exp(2 pi i turns p) at each place p: Taylor's series of a quarter of the angle, squared twice. */
INLINE void
carriers(double turns, const places *at, double (*restrict e)[2])
{
    for (int i = 0; i < AT_ONCE; i++) {
        double t = turns * at->point[i], x, x2, co = 1, si = 1;
        t = t - rint(t) + turns * at->behind[i];
        x = (t - rint(t)) * (M_PI / 2);
        x2 = x * x;
        for (int m = 18; m > 0; m -= 2) {
            co = 1 - co * x2 * (1. / (m * (m - 1)));
            si = 1 - si * x2 * (1. / (m * (m + 1)));
        }
        si *= x;
        for (int m = 0; m < 2; m++) {
            double re = co * co - si * si;
            si = 2 * co * si;
            co = re;
        }
        e[i][0] = co;
        e[i][1] = si;
    }
}

INLINE void
turn(double (*restrict sum)[2], double (*restrict e)[2], size_t n, double factor, double *restrict w)
{
    for (size_t i = 0; i < n; i++) {
        w[2 * i] = (sum[i][0] * e[i][0] - sum[i][1] * e[i][1]) * factor;
        w[2 * i + 1] = (sum[i][0] * e[i][1] + sum[i][1] * e[i][0]) * factor;
    }
}

INLINE void
write_any(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate, span part,
          double factor, double *w)
{
    for (size_t i = 0; i < part.n; i += AT_ONCE) {
        size_t n = part.n - i < AT_ONCE ? part.n - i : AT_ONCE;
        places at;
        double sum[AT_ONCE][2], e[AT_ONCE][2];
        find_places(s, scale->b_num, scale->b_den, rate, (double)(part.first + i), &at);
        add_taps(ker, s->v, &at, n, sum);
        carriers(s->turns, &at, e);
        turn(sum, e, n, factor, w + 2 * i);
    }
}

INLINE void
add_any(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate, span part,
        double factor, const double *w, double *v)
{
    places at;
    double e[AT_ONCE][2];
    for (size_t i = 0; i < part.n; i++) {
        size_t k = i % AT_ONCE;
        if (k == 0) {
            find_places(s, scale->b_num, scale->b_den, rate, (double)(part.first + i), &at);
            carriers(s->turns, &at, e);
        }
        double re = (w[2 * i] * e[k][0] + w[2 * i + 1] * e[k][1]) * factor;
        double im = (w[2 * i] * e[k][1] - w[2 * i + 1] * e[k][0]) * factor;
        lanes *point = (lanes *)(v + 2 * ((ptrdiff_t)at.point[k] - LEAD)), weight[4];
        weights_behind(ker, at.behind[k], weight);
        for (int m = 0; m < 4; m++)
            point[m] += weight[m] * (lanes){ re, im, re, im, re, im, re, im };
    }
}

#define VERSION(size, target) \
    target static void \
    write_##size(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate, \
                 span part, double factor, double *w) \
    { \
        write_any(ker, s, scale, rate, part, factor, w); \
    } \
    target static void \
    add_##size(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate, \
               span part, double factor, const double *w, double *v) \
    { \
        add_any(ker, s, scale, rate, part, factor, w, v); \
    }

VERSION(128, FAST)
#ifdef HAVE_TARGETS
VERSION(256, FAST_FOR("avx2,fma"))
VERSION(512, FAST_FOR("avx512f"))
#endif

void
ss_places_write(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate,
                span part, double factor, double *w)
{
    BEST_VERSION(write_128, write_256, write_512)(ker, s, scale, rate, part, factor, w);
}

void
ss_places_add(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate, span part,
              double factor, const double *w, double *v)
{
    BEST_VERSION(add_128, add_256, add_512)(ker, s, scale, rate, part, factor, w, v);
}
