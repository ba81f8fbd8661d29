/* backbone.c -- follow a free decay block by block.
 *
 * The record is averaged over groups of samples, to some 32 a period at most.  Blocks of a few periods follow each
 * other without gap or overlap (backbone_block.c), each started by what the blocks before tell of s and w.  What
 * is smooth through them (backbone_smooth.c) is where they are fitted again: about a curve that bends as the decay
 * does.  What it leaves of the record shows lines, which then stand beside the decay in all blocks. */
#include "fit/backbone.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/rank.h>
#include "base/error.h"
#include "base/fft.h"
#include "base/list.h"
#include "base/options.h"
#include "find/judgement.h"
#include "find/window.h"
#include "signal/gaps.h"

enum {
    RICH = 32,                  /* samples a period that are enough */
    MANY = 200,                 /* blocks that tell all of a decay; FEW are one */
    TRIED = 2,                  /* lines beside the strongest, one of which may be the decay */
    REFITS = 2,                 /* smooth curves, each through blocks fitted about the last */
    PARTS = 8,                  /* in which a line is looked at */
    SOME = 1024,                /* terms of a spectrum that tell what is usual */
    ENOUGH = 1 << 16,           /* samples that show a line */
    LEVELS = 20,                /* blocks of a level, at most, of FEW rows each, at least */
    BEHIND = 6,                 /* blocks behind the end, at most */
    SLOW = 4                    /* periods to twice the amplitude, as no blow takes */
};
#define LONG 12.0               /* periods of a block, where noise wants it long */
#define FLAT .02                /* of the range: what is clipped may have noise */
#define HIT 3.0                 /* times what the blocks behind it leave: a blow is in the first
                                   block */
#define SHORTEST 1.5            /* periods of a block */
#define NOISY 10.0              /* dB above a floor: it matters below */
#define HIGH 25.0               /* the same: it does not matter above */
#define NEPER (M_LN10 / 20)     /* a decibel */
#define FALL .35                /* of ln A in a block, at most */
#define NEAR .15                /* of the frequency: a line so near is part of the decay */
#define OUTSTANDING 60.0        /* times the median power: a line, as noise never is */
#define DIES .03                /* damping ratio of what is no line, but part of a blow or of a slip */

typedef struct decay {
    const ss_backbone_opts *opts;
    double *x;                  /* what is looked at; NaN: missing */
    size_t n, group;            /* samples, each of so many of the record's */
    double w;                   /* per sample: where to look */
    double *size;               /* of it, in the period from each sample on */
    size_t first, end;          /* samples of the decay, nearly */
    lines beside;
    block *block;
    size_t n_blocks, room;
    int cuts_blow;              /* 1: a first block that leaves far more than the next is left out */
    const char *start, *stop;
    decay_source *source;
} decay;

/* --- where it is ----------------------------------------------------------------------------- */

/* The power of n samples at k 2 pi / size, k = 0 ... size / 2, in f->x, which the caller frees: of their
 * differences, which have no offset, or tapered towards the end, as what dies out is at the start. */
static ss_status
spectrum(real_fft *f, size_t *size, const double *x, size_t n, int is_tapered)
{
    for (*size = 2; *size < n;)
        *size *= 2;
    if (ss_real_fft_new(f, *size, 0) != SS_OK)
        return SS_ENOMEM;
    memset(f->x, 0, *size * sizeof *f->x);
    for (size_t i = 0; i < n; i++) {
        double part = ((double)i + .5) / (double)n;
        f->x[i] = is_tapered ? x[i] * (1 - part * part * (3 - 2 * part)) : i > 0 ? x[i] - x[i - 1] : 0;
    }
    ss_real_fft_run(f);
    for (size_t k = 0; k <= *size / 2; k++)
        f->x[k] = f->x[2 * k] * f->x[2 * k] + f->x[2 * k + 1] * f->x[2 * k + 1];
    return SS_OK;
}

/* The frequencies of the strongest lines in n samples, per sample, weighed by frequency, as slow changes have more
 * power than they matter, each other than those before; near > 0: the second is the strongest about it.  0: there
 * is none. */
static ss_status
find_lines(double found[TRIED + 1], const double *x, size_t n, double near)
{
    size_t size;
    real_fft f;
    if (spectrum(&f, &size, x, n, 0) != SS_OK)
        return SS_ENOMEM;
    double unit = 2 * M_PI / (double)size, *power = f.x;
    for (size_t k = 1; k <= size / 2; k++)
        power[k] /= (double)k;
    for (size_t l = 0; l <= TRIED; l++) {
        double best = 0;
        found[l] = 0;
        for (size_t k = (size_t)fmax(2.5 * (double)size / (double)n, 1); k < size / 2; k++) {
            const double at = (double)k * unit;
            if (!(power[k] >= power[k - 1] && power[k] > power[k + 1] && power[k] > best))
                continue;
            int is_asked = near == 0 || l == 0 || fabs(at - near) < NEAR * near;
            for (size_t i = 0; i < l && near == 0; i++)
                is_asked &= fabs(at - found[i]) > NEAR * found[i];
            if (is_asked) {
                best = power[k];
                found[l] = at;
            }
        }
    }
    ss_real_fft_free(&f);
    return SS_OK;
}

/* 1: of three periods about its extreme in that direction, a fifth lies within FLAT of the limit, as a sine's
 * tenth does at most. */
static int
is_flat(const double *x, size_t n, double limit, int direction, double period)
{
    size_t at = 0, count = 0;
    for (size_t i = 0; i < n; i++)
        at = direction * x[i] > direction * x[at] ? i : at;
    size_t half = (size_t)(1.5 * period), end = at + half < n ? at + half : n;
    for (size_t i = at > half ? at - half : 0; i < end; i++)
        count += direction * x[i] > direction * limit;
    return (double)count > .2 * 3 * period + 2;
}

/* Average groups of the record's samples, but for those in gaps.  Those at a limit that it reaches three times,
 * or stays near, are clipped. */
static ss_status
take_record(decay *d, const double *x, size_t n)
{
    double lo = INFINITY, hi = -INFINITY;
    size_t at_lo = 0, at_hi = 0;
    d->n = n / d->group;
    d->x = malloc((d->n + 1) * sizeof *d->x);
    if (d->x == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        at_lo = x[i] < lo ? 1 : at_lo + (x[i] == lo);
        at_hi = x[i] > hi ? 1 : at_hi + (x[i] == hi);
        lo = fmin(lo, x[i]);
        hi = fmax(hi, x[i]);
    }
    double margin = FLAT * (hi - lo), period = 2 * M_PI * (double)d->group / d->w;
    double kept = sin(d->w / 2) / sin(d->w / 2 / (double)d->group);     /* of an oscillation, by a sum */
    lo = is_flat(x, n, lo + margin, -1, period) ? lo + margin : at_lo < 3 ? -INFINITY : lo;
    hi = is_flat(x, n, hi - margin, 1, period) ? hi - margin : at_hi < 3 ? INFINITY : hi;
    for (size_t i = 0; i < d->n; i++) {
        double sum = 0;
        for (size_t k = i * d->group; k < (i + 1) * d->group; k++)
            sum += x[k] > lo && x[k] < hi ? x[k] : NAN;
        d->x[i] = sum / kept;
    }
    for (size_t g = 0; g < d->source->n_gaps; g++) {
        size_t first, end;
        ss_gap_rows(&d->source->gap[g], d->source->rate, &first, &end);
        for (size_t i = first / d->group; i < d->n && i * d->group < end; i++)
            d->x[i] = NAN;
    }
    return SS_OK;
}

/* Set size, of the mean over a period, less its offset, turned by w, first, where it is largest, and end, where it
 * is near its least. */
static ss_status
find_extent(decay *d)
{
    size_t width = (size_t)fmax(round(2 * M_PI / d->w), 1), n = d->n > width ? d->n - width + 1 : 0;
    double complex *turned = malloc((d->n + 1) * sizeof *turned), sum = 0, of_one = 0, back = 1;
    const double complex step = conj(cexp(d->w * I));
    double *size = d->size = malloc((n + 1) * sizeof *size), least = INFINITY, plain = 0;
    if (turned == NULL || size == NULL) {
        free(turned);
        return SS_ENOMEM;
    }
    for (size_t i = 0; i < width; i++)          /* of a constant 1, at the last sample of a period */
        of_one += cexp(d->w * (double)i * I) / (double)width;
    for (size_t i = 0; i < d->n; i++) {
        const double complex one = of_one * back;
        turned[i] = isnan(d->x[i]) ? 0 : d->x[i] * back;
        plain += (isnan(d->x[i]) ? 0 : d->x[i]) - (i >= width && !isnan(d->x[i - width]) ? d->x[i - width] : 0);
        back *= step;
        sum += turned[i] - (i >= width ? turned[i - width] : 0);
        if (i + 1 < width)
            continue;
        size_t k = i + 1 - width;
        double complex left = sum - plain * one;
        size[k] = sqrt(creal(left) * creal(left) + cimag(left) * cimag(left)) * 2 / (double)width;
        if (size[k] > size[d->first]) {
            d->first = k;
            least = INFINITY;
        }
        least = fmin(least, size[k]);
    }
    for (d->end = d->first; d->end < n && (size[d->end] > 2 * least || size[d->first] < 8 * least); d->end++)
        ;
    d->end = n > 0 ? d->end + width - 1 : 0;
    free(turned);
    return SS_OK;
}

/* 1: from a sample on the amplitude grows from what it is there, and what a line beside it makes there, by as much
 * as noise never makes it grow, and slower than a blow does. */
static int
grows(const decay *d, size_t from, double amplitude)
{
    size_t width = (size_t)fmax(round(2 * M_PI / d->w), 1), n = d->n > width ? d->n - width + 1 : 0;
    size_t most = from, half = from;
    for (size_t i = from; i < n; i++)
        most = d->size[i] > d->size[most] ? i : most;
    for (size_t i = from; i < most; i++)
        half = d->size[i] < d->size[most] / 2 ? i : half;
    return most < n && d->size[most] > TWICE * fmax(amplitude, d->size[from]) && most - half > SLOW * width;
}

/* --- block by block -------------------------------------------------------------------------- */

/* The length of a block at an amplitude and a bend: three periods, more beside a line that is near; less where ln
 * A would fall by more than FALL; more where noise asks for it, or where there would be over MANY blocks. */
static size_t
block_length(const decay *d, bend at, double amplitude, double noise)
{
    double period = 2 * M_PI / at.w, length = 3 * period;
    double samples = 2 * noise / (amplitude * amplitude) / (.05 * .05);      /* for an error of .05 of ln A */
    if (d->opts->periods > 0)
        return (size_t)ceil(d->opts->periods * period);
    for (size_t i = 0; i < d->beside.n; i++)
        length = fmax(length, fmin(fabs(2 * M_PI * 1.8 / (d->beside.w[i] - at.w)), LONG * period));
    if (at.s * length > FALL)
        length = fmax(FALL / at.s, SHORTEST * period);
    length = fmax(length, fmin(samples, LONG * period));
    return (size_t)ceil(fmax(fmax(length, (double)(d->end - d->first) / MANY), 14 + 3. * (double)d->beside.n));
}

/* Follow the decay, from first on, as far as it is seen.  Each block starts from s and w of the one before. */
static ss_status
follow(decay *d)
{
    double noise = 0, free_of_noise = 0;
    bend at = { .s = 1 / (double)(d->end - d->first + 1), .w = d->w };
    size_t first = d->first;
    d->n_blocks = 0;
    d->stop = "end of the record";
    for (;;) {
        block *grown = ss_list_room(d->block, &d->room, d->n_blocks, sizeof *grown);
        if (grown == NULL)
            return SS_ENOMEM;
        d->block = grown;
        block *b = &grown[d->n_blocks], *last = d->n_blocks > 0 ? b - 1 : NULL;
        double level = last != NULL ? last->y[LEVEL] - at.s * ((double)first - last->t) : 0;
        size_t length = last != NULL ? block_length(d, at, exp(level), noise) : block_length(d, at, 1, 0);
        if (first + length > d->n)
            return SS_OK;
        if (!ss_block_fit(b, d->x, first, first + length, at, &d->beside, 0)
            || fabs(b->rate[PHASE] - at.w) > (last != NULL ? 2 : 3) * NEAR * at.w) {
            d->stop = "noise";
            return SS_OK;
        }
        if (last == NULL && -b->rate[LEVEL] * (double)length > 1.5 * FALL) {
            at = (bend){ .s = -b->rate[LEVEL], .w = b->rate[PHASE] };   /* too fast for this block */
            length = block_length(d, at, 1, 0);
            if (!ss_block_fit(b, d->x, first, first + length, at, &d->beside, 0))
                return SS_OK;
        }
        noise = last == NULL ? b->left / b->free : (noise * free_of_noise + b->left) / (free_of_noise + b->free);
        free_of_noise = fmin(free_of_noise + b->free, 5 * b->free);
        double error = sqrt(b->cov[LEVEL][0] * noise);
        if (last != NULL && error > .2)
            d->stop = "noise";
        else if (last != NULL && b->y[LEVEL] > last->y[LEVEL] + FALL + 5 * error)
            d->stop = "the amplitude grows";
        else {
            at = (bend){ .s = -b->rate[LEVEL], .w = b->rate[PHASE] };
            d->n_blocks++;
            first = b->end;
            continue;
        }
        return SS_OK;
    }
}

/* The mean square that a block leaves, if it is not faint beside it. */
static double
left_of(const block *b)
{
    double left = b->left / b->free;
    return left > pow(FAINT * exp(b->y[LEVEL]), 2) ? left : 0;
}

/* 1: the first block leaves far more than the next, as the blow is in it. */
static int
is_hit(const decay *d)
{
    const block *b = d->block;
    return d->n_blocks >= FEW && left_of(b) > HIT * fmax(b[1].left / b[1].free, b[2].left / b[2].free);
}

/* The noise of each block, from those about it, re the amplitude that is smooth: else those that noise makes large
 * would count more. */
static void
share_noise(decay *d)
{
    for (size_t i = 0; i < d->n_blocks; i++) {
        double left = 0, n = 0;
        for (size_t k = i > 2 ? i - 2 : 0; k < d->n_blocks && k <= i + 2; k++) {
            left += d->block[k].left;
            n += d->block[k].free;
        }
        block *b = &d->block[i];
        b->noise = (left / n + 1e-24 * exp(2 * b->y[LEVEL])) * exp(2 * (b->y[LEVEL] - b->level));
    }
}

/* Draw a smooth curve through the blocks, and fit them again about it: where noise is large, what a block alone
 * finds is biased. */
static ss_status
settle(decay *d)
{
    ss_status st = SS_OK;
    for (size_t i = 0; i < d->n_blocks; i++) {
        d->block[i].at = (bend){ .w = d->block[i].rate[PHASE] };
        d->block[i].level = d->block[i].y[LEVEL];
    }
    for (int pass = 0; st == SS_OK && pass < REFITS; pass++) {
        for (size_t i = 0; pass > 0 && i < d->n_blocks; i++) {
            block *b = &d->block[i], again;
            if (ss_block_fit(&again, d->x, b->first, b->end, b->at, &d->beside, 1)) {
                again.at = b->at;
                again.level = b->level;
                again.phase = b->phase;
                *b = again;
            }
        }
        share_noise(d);
        st = ss_blocks_smooth(d->block, d->n_blocks, d->source);
    }
    return st;
}

/* --- lines beside it ------------------------------------------------------------------------- */

/* 1: a line at w may be the decay itself, or is one that is known. */
static int
is_known(const decay *d, double w, size_t n)
{
    double width = 12 / (double)n, lo = INFINITY, hi = 0;
    double blocks = 2 * M_PI * (double)d->n_blocks / (double)(d->block[d->n_blocks - 1].end - d->block->first);
    for (size_t i = 0; i < d->n_blocks; i++) {
        lo = fmin(lo, d->block[i].at.w);
        hi = fmax(hi, d->block[i].at.w);
    }
    int known = w > lo * (1 - NEAR) - width && w < hi * (1 + NEAR) + width;
    for (size_t i = 0; i < d->beside.n; i++)
        known |= fabs(w - d->beside.w[i]) < fmax(4 * d->beside.s[i] + width, blocks);
    return known;
}

/* The decay and the frequency of a line near *w, from its amplitudes and phases in parts of n samples: the decay
 * between parts or between halves, whichever is faster, as a slip is over soon. */
static double
line_decay(double *w, const double *left, size_t n)
{
    const double complex step = conj(cexp(*w * I));
    double complex back = 1;
    double sum = 0, t = 0, tt = 0, level = 0, t_level = 0, phase = 0, t_phase = 0, last = 0;
    double half[2] = { 1e-300, 1e-300 };
    for (size_t i = 0; i < PARTS; i++) {
        double complex z = 0;
        for (size_t k = i * n / PARTS; k < (i + 1) * n / PARTS; k++, back *= step)
            z += isnan(left[k]) ? 0 : left[k] * back;
        double weight = creal(z * conj(z)) + 1e-300, at = (double)i, turn = carg(z);
        turn -= 2 * M_PI * round((turn - last) / (2 * M_PI));
        last = turn;
        half[2 * i / PARTS] += weight;
        sum += weight, t += weight * at, tt += weight * at * at;
        level += weight * log(weight) / 2, t_level += weight * at * log(weight) / 2;
        phase += weight * turn, t_phase += weight * at * turn;
    }
    double spread = (tt - t * t / sum) * (double)n / PARTS;
    *w += (t_phase - t * phase / sum) / spread;
    return fmax(fmax(-(t_level - t * level / sum) / spread, log(half[0] / half[1]) / (double)n), 0);
}

/* Of the first n samples of what is left, by how much the strongest line that is not known stands out of the
 * spectrum's median, and its frequency; 0: none is above what matters. */
static ss_status
find_beside(const decay *d, const double *left, size_t n, double *ratio, double *w)
{
    size_t size, best = 0;
    real_fft f;
    if (spectrum(&f, &size, left, n, 1) != SS_OK)
        return SS_ENOMEM;
    double unit = 2 * M_PI / (double)size, *power = f.x;
    for (size_t k = (size_t)(3 * (double)size / (double)n); k < size / 2; k++)
        if (power[k] > power[k - 1] && power[k] > power[k + 1] && power[k] > power[best]
            && !is_known(d, (double)k * unit, n))
            best = k;
    double peak = power[best], least = FAINT * exp(d->block[d->n_blocks - 1].level) * (double)n / 4;
    size_t some = size / 2 < SOME ? size / 2 : SOME;        /* of the terms tell what is usual */
    for (size_t i = 0; i < some; i++)
        power[i] = power[i * (size / 2 / some)];
    qsort(power, some, sizeof *power, ss_ascending);
    *ratio = best > 0 && peak > least * least ? peak / power[some / 2] : 0;
    *w = (double)best * unit;
    ss_real_fft_free(&f);
    return SS_OK;
}

/* Add to those beside it the strongest line, if it stands out and lasts, of all that is left or of what is left at
 * first. */
static ss_status
add_line(decay *d, int *found)
{
    size_t n = 0;
    double best = OUTSTANDING, ratio, w, *left = malloc((d->n + 1) * sizeof *left);
    ss_status st = left != NULL ? SS_OK : SS_ENOMEM;
    *found = 0;
    /* what the smooth curve leaves of all blocks but the first, which a blow or a slip may be in */
    for (size_t i = 1; left != NULL && i < d->n_blocks && n < ENOUGH; i++) {
        ss_block_leave(&d->block[i], d->x, left + n);
        n += d->block[i].end - d->block[i].first;
    }
    for (; st == SS_OK && (double)n * d->w > PARTS * 2 * M_PI; n /= 4) {
        st = find_beside(d, left, n, &ratio, &w);
        double s = st == SS_OK && ratio > best ? line_decay(&w, left, n) : INFINITY;
        if (s < DIES * w) {
            best = ratio;
            *found = 1;
            d->beside.s[d->beside.n] = s;
            d->beside.w[d->beside.n] = w;
        }
    }
    d->beside.n += *found ? 1 : 0;
    free(left);
    return st;
}

/* Fit what is behind the last block, if that is no other motion, as if it went on at its frequency: it is too
 * small for a block of its own, and laws differ in how small it is. */
static ss_status
look_behind(decay *d)
{
    const block last = d->block[d->n_blocks - 1];
    double length = (double)(last.end - last.first), half = .5 / fmax(last.at.s, 1e-9);     /* of an e-fold */
    double noise = last.noise * exp(2 * (last.level - last.y[LEVEL]));
    size_t first = last.end, n = (size_t)fmax(fmin(half, 4 * length), length), *of = &d->source->behind;
    for (; *of < BEHIND && first + n <= d->n && d->source->beats == NULL; ++*of, first += n) {
        block *grown = ss_list_room(d->block, &d->room, d->n_blocks + *of, sizeof *grown);
        if (grown == NULL)
            return SS_ENOMEM;
        d->block = grown;
        block *b = &grown[d->n_blocks + *of];
        if (!ss_block_fit(b, d->x, first, first + n, (bend){ .w = last.at.w }, &d->beside, 1)
            || b->y[LEVEL] > last.level || b->left / b->free > noise * (1 + 5 * sqrt(2 / b->free)))
            break;
        b->noise = noise;
    }
    return SS_OK;
}

/* --- levels without phase -------------------------------------------------------------------- */

/* The straight line through levels [dB] first ... end - 1, in nepers. */
static block
fit_level(const double *x, size_t first, size_t end, double w)
{
    const ss_line l = ss_line_through(x, NULL, (ss_window){ first, end });
    const double n = (double)(end - first);
    block b = { .first = first, .end = end, .t = l.x, .free = n - 2, .at = { .w = w } };
    b.left = pow(l.rms * NEPER, 2) * b.free;
    b.y[LEVEL] = b.level = l.y * NEPER;
    b.rate[LEVEL] = l.slope * NEPER;
    b.cov[LEVEL][0] = 1 / n;
    b.cov[LEVEL][2] = 12 / (n * (n * n - 1));
    return b;
}

/* Cut levels, from the highest down to what they end in, into blocks. */
static ss_status
find_levels(decay *d, const double *x, size_t n)
{
    size_t most = 0, tail = n - (n > 30 ? n / 10 : 3);
    double w = 2 * M_PI * d->opts->level_frequency / d->source->rate;
    d->group = 1;
    d->w = w;
    d->block = calloc(LEVELS, sizeof *d->block);
    d->x = malloc((n + 1) * sizeof *d->x);
    if (d->block == NULL || d->x == NULL)
        return SS_ENOMEM;
    memcpy(d->x, x, n * sizeof *x);
    for (size_t i = 1; i < n; i++)
        most = x[i] > x[most] ? i : most;
    if (n < most + FEW * FEW || most >= tail)
        return SS_OK;
    block last = fit_level(x, tail, n, w);
    size_t from = most, to = most;              /* of where the decay alone is seen above its end */
    for (size_t i = most; i < tail; i++) {
        from = x[i] * NEPER > last.y[LEVEL] + HIGH * NEPER ? i : from;
        to = x[i] * NEPER > last.y[LEVEL] + NOISY * NEPER ? i + 1 : to;
    }
    double ratio = to - from < FEW ? 1 : fmax(last.rate[LEVEL] / fit_level(x, from, to, w).rate[LEVEL], 0);
    tail = n;
    if (ratio < .5) {                           /* it bends into a floor, which has this part of the last power */
        double floor = last.y[LEVEL] / NEPER + 10 * log10(1 - ratio);
        d->stop = "noise";
        for (size_t i = tail = most; i < n && x[i] > floor + NOISY; tail = ++i)
            d->x[i] += 10 * log10(1 - pow(10, (floor - x[i]) / 10));
    }
    size_t blocks = tail > most ? (tail - most) / FEW : 0;
    blocks = blocks < LEVELS ? blocks : LEVELS;
    for (size_t i = 0; i < blocks; i++)
        d->block[d->n_blocks++] = fit_level(d->x, most + (tail - most) * i / blocks,
                                            most + (tail - most) * (i + 1) / blocks, w);
    if (d->n_blocks < FEW)
        return SS_OK;
    share_noise(d);
    return ss_blocks_smooth(d->block, d->n_blocks, d->source);
}

static const ss_backbone_opts defaults = { .size = sizeof defaults };
SS_OPTIONS(ss_backbone_opts, defaults)

static void
make_rows(ss_backbone *out, const decay *d)
{
    const decay_source *source = d->source;
    double unit = source->rate;
    for (; out->n < d->n_blocks; out->n++) {
        const block *b = &d->block[out->n];
        double whole = hypot(b->at.s, b->at.w), w0 = sqrt(b->at.w * b->at.w + b->lag);
        double es = b->error[LEVEL], ew = b->error[PHASE], ew0 = hypot(b->at.w * ew, b->lag_error / 2) / w0;
        out->row[out->n] = (ss_backbone_row){
            .t = (b->t + .5 - .5 / (double)d->group) / unit, .amplitude = exp(b->level) * source->unit,
            .frequency = { w0 * unit / (2 * M_PI), ew0 * unit / (2 * M_PI) },
            .damping_ratio = { b->at.s / whole, b->at.w * hypot(b->at.w * es, b->at.s * ew) / pow(whole, 3) },
            .periods = (double)(b->end - b->first) * b->at.w / (2 * M_PI),
            .named = { out->row[out->n].named[0], out->row[out->n].named[1] } };
        if (!source->has_phase) {
            out->row[out->n].frequency = (ss_value){ d->opts->level_frequency, NAN };
            out->row[out->n].damping_ratio.error = es / whole;
        }
    }
}

static void
forget(decay *d)
{
    free(d->x);
    free(d->size);
    free(d->block);
}

/* Why blocks are no decay; NULL: they are one. */
static const char *
no_decay(const decay *d)
{
    if (!(d->w > 0))
        return "nothing oscillates";
    if (d->n_blocks < FEW && !d->source->has_phase)
        return "too few levels lie between the highest and the end, or the noise";
    if (d->n_blocks < FEW && grows(d, 0, 0))
        return "the oscillation grows";
    if (d->n_blocks < FEW)
        return d->n_blocks > 0 && strcmp(d->stop, "end of the record") == 0
            ? "it has under three blocks of periods"
            : "nothing stands above the noise for three blocks of periods";
    const block *b = d->block, *last = b + d->n_blocks - 1;
    for (size_t i = 0; i < d->n_blocks; i++)
        if (!isfinite(b[i].at.s + b[i].at.w))
            return "its damping changes too fast from block to block";
    double lost = b->y[LEVEL] - last->y[LEVEL];
    double error = sqrt(b->cov[LEVEL][0] * b->noise + last->cov[LEVEL][0] * last->noise);
    return lost > 5 * error ? NULL : "the oscillation does not decay";
}

/* Find the decay of the line w, beside another if this is not 0 and is not w. */
static ss_status
find_at(decay *d, const double *x, size_t n, double w, double other)
{
    d->group = w > 0 ? (size_t)fmax(floor(2 * M_PI / w / RICH), 1) : 1;
    d->w = w * (double)d->group;
    ss_status st = w > 0 ? take_record(d, x, n) : SS_OK;
    other *= (double)d->group;
    if (st == SS_OK && w > 0 && other > 0 && fabs(other - d->w) > NEAR * d->w && other < 3) {
        d->beside.n = 1;                        /* a mode that is weaker is not seen without the strongest */
        d->beside.s[0] = line_decay(&other, d->x, d->n);
        d->beside.w[0] = other;
    }
    if (st == SS_OK && d->w > 0)
        st = find_extent(d);
    for (int more = d->w > 0; st == SS_OK && more;) {
        more = 0;
        st = follow(d);
        while (st == SS_OK && d->cuts_blow && is_hit(d)) {
            d->first += (size_t)ceil(M_PI / d->w);
            d->start = "a blow before it";
            st = follow(d);
        }
        if (st == SS_OK && d->n_blocks >= FEW)
            st = settle(d);
        const block *b = st == SS_OK && d->n_blocks > FEW ? &d->block[d->n_blocks - 1] : NULL;
        /* the motion's end is in the last block: it leaves more than those before, by 5 standard deviations, or it
         * loses an e-fold, as no block before a stop does */
        if (b != NULL && (b->at.s * (double)(b->end - b->first) > 1
                          || left_of(b) > fmin(b[-1].left / b[-1].free, b[-2].left / b[-2].free)
                                          * (1 + 5 * sqrt(2 / b->free)))) {
            d->n_blocks--;
            d->stop = b->cov[LEVEL][0] * b[-1].left / b[-1].free > LITTLE * LITTLE ? "noise" : "the motion stops";
            st = settle(d);
        }
        if (st == SS_OK && d->n_blocks >= FEW && d->beside.n < LINES_MAX)
            st = add_line(d, &more);
    }
    return st;
}

/* The squares that all blocks leave, and what blocks of another way to follow the decay show behind them. */
static double
leaves(const decay *d, const decay *other)
{
    size_t end = d->block[d->n_blocks - 1].end;
    double left = 0;
    for (size_t i = 0; i < d->n_blocks; i++)
        left += d->block[i].left;
    for (size_t i = 0; i < other->n_blocks; i++) {
        const block *b = &other->block[i];
        left += b->first >= end ? exp(2 * b->y[LEVEL]) / 2 * (double)(b->end - b->first) : 0;
    }
    return left;
}

/* 1: the blocks leave at first what dies out, as another mode does that curves through them follow. */
static int
is_mixed(const decay *d)
{
    const block *last = &d->block[d->n_blocks - 1];
    double n = 0;
    for (size_t i = 0; i < d->n_blocks; i++)
        n += d->block[i].free;
    return leaves(d, d) > LARGER * n * last->left / last->free;
}

/* Find the decay of the line that is asked for, or else of the strongest, beside the next one if less than half is
 * left then; of another if this is none. */
static ss_status
find(decay *d, const double *record, size_t n)
{
    const decay none = *d;
    double most = 0, *x = malloc((n + 1) * sizeof *x);
    if (x == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(record[i]));
    d->source->unit = most > 0 ? ldexp(1, ilogb(most)) : 1;     /* its squares neither overflow nor vanish */
    for (size_t i = 0; i < n; i++)
        x[i] = record[i] / d->source->unit;
    const double near = 2 * M_PI * d->opts->mode / d->source->rate;
    static const int other[][2] = { { 0, 1 }, { 1, 0 }, { 2, 0 } };     /* which line, beside which */
    double found[TRIED + 1];
    ss_status st = find_lines(found, x, n, near);
    if (st == SS_OK)
        st = find_at(d, x, n, found[near > 0], near > 0 ? found[0] : 0);
    for (size_t k = 0; st == SS_OK && near == 0 && k < sizeof other / sizeof *other; k++) {
        decay with = none;
        if (!(found[other[k][0]] > 0 && found[other[k][1]] > 0)
            || (no_decay(d) == NULL && (k > 0 || !is_mixed(d))))
            continue;
        st = find_at(&with, x, n, found[other[k][0]], found[other[k][1]]);
        if (st == SS_OK && no_decay(&with) == NULL
            && (no_decay(d) != NULL || leaves(&with, d) < leaves(d, &with) / 2)) {
            decay was = *d;
            *d = with;
            with = was;
        }
        forget(&with);
    }
    free(x);
    d->source->rate /= (double)d->group;
    if (st == SS_OK && d->n_blocks >= FEW
        && grows(d, d->block[d->n_blocks - 1].end, exp(d->block[d->n_blocks - 1].y[LEVEL])))
        d->stop = d->source->beats = "the amplitude grows";
    return st;
}

/* Follow the decay and name its mechanism.  What the first block leaves is a blow, and the decay begins behind it,
 * unless a slider explains it. */
static ss_status
find_and_name(ss_backbone **out, const double *x, size_t n, const ss_backbone_opts *opts, decay_source source,
              int cuts_blow)
{
    decay_source now = source;
    decay d = { .opts = opts, .cuts_blow = cuts_blow, .start = "the largest amplitude",
                .stop = "end of the record", .source = &now };
    ss_backbone *b = calloc(1, sizeof *b);
    ss_status st = b == NULL ? SS_ENOMEM : source.has_phase ? find(&d, x, n) : find_levels(&d, x, n);
    if (st == SS_OK) {
        b->why = no_decay(&d);
        b->start = d.start;
        b->stop = d.stop;
        b->chi2_dof = NAN;
        b->noise = d.n_blocks > 0 ? sqrt(d.block[d.n_blocks - 1].noise * (double)d.group) * now.unit : NAN;
    }
    if (st == SS_OK && b->why == NULL)
        st = (b->row = calloc(d.n_blocks, sizeof *b->row)) != NULL ? SS_OK : SS_ENOMEM;
    now.beside = d.beside;
    if (st == SS_OK && b->why == NULL && source.has_phase)
        st = look_behind(&d);
    if (st == SS_OK && b->why == NULL)
        st = ss_mechanism_find(b, d.block, d.n_blocks, &now);
    int is_cut = st == SS_OK && !cuts_blow && source.has_phase && (b->why != NULL || is_hit(&d));
    if (st == SS_OK && b->why == NULL && !is_cut)
        make_rows(b, &d);
    forget(&d);
    if (st == SS_OK && !is_cut)
        *out = b;
    else
        ss_backbone_free(b);
    return is_cut ? find_and_name(out, x, n, opts, source, 1) : st;
}

ss_status
ss_backbone_find(ss_backbone **out, const ss_signal *signal, size_t column, const ss_backbone_opts *opts,
                 ss_error *err)
{
    ss_backbone_opts own;
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    *out = NULL;
    ss_status st = ss_options_take(&own, sizeof own, &defaults, opts, err);
    if (st != SS_OK)
        return st;
    if (column >= signal->head->n_columns)
        return ss_fail_column(err, column, signal->head->n_columns);
    if (!(own.mode >= 0 && own.level_frequency >= 0 && own.mass >= 0)
        || (own.periods != 0 && !(own.periods >= SHORTEST)))
        return ss_fail(err, SS_EINVAL, "an option is out of its range");
    const ss_column *of = &signal->head->column[column];
    decay_source source = { .rate = signal->head->rate, .has_phase = !(own.level_frequency > 0), .column = of->unit,
                            .mass = own.mass, .unit = 1 };
    source.derivative = ss_motion_order(of->unit, &source.size);
    for (int i = 0; i < 3 && source.derivative < 0; i++)
        source.derivative = strcmp(of->name, ss_quantity_names[i]) == 0 ? i : -1;
    if (own.mass > 0 && !(source.size > 0))
        return ss_fail(err, SS_EINVAL, "a mass needs a length, a speed or an acceleration, as in mm, m/s or g; %s"
                       " is in '%s'", of->name, of->unit);
    const double *x = signal->values + column * signal->n;
    for (size_t i = 0; i < signal->n; i++)
        if (!isfinite(x[i]))
            return ss_fail(err, SS_EDATA, "column %s has a value that is not finite", of->name);
    double *bridged = malloc((signal->n + 1) * sizeof *bridged);
    ss_span *gap = NULL;
    st = bridged != NULL ? ss_gaps_of(&gap, &source.n_gaps, signal->head, signal->n) : SS_ENOMEM;
    source.gap = gap;
    if (st == SS_OK) {
        memcpy(bridged, x, signal->n * sizeof *x);
        ss_gaps_bridge(bridged, signal->n, source.rate, gap, source.n_gaps);
        st = find_and_name(out, bridged, signal->n, &own, source, 0);
    }
    free(gap);
    free(bridged);
    return st == SS_OK ? SS_OK : ss_fail_memory(err, NULL);
}

void
ss_backbone_free(ss_backbone *backbone)
{
    if (backbone != NULL)
        free(backbone->row);
    free(backbone);
}
