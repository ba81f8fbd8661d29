/* cover_identity.c -- is each number of ss_features_find the number of what it says it is?
 *
 * Four populations of random rigs, each simulated by tests/rig.c, which has no code of the library:
 *   elastic   an elastic contact on a moved base, seen by 22 kinds of sensor in turn
 *   coulomb   a true stick, which has no contact to report, with hum, filters or noise
 *   soft      contacts of .3 to 20 times the rig's stiffness, filters, and clocks that wander
 *   uneven    bases of two or three harmonics, so that motions are not mirror-symmetric
 * A row a population and kind: records, numbers printed, the share of these within 2 of their standard
 * errors, those beyond 5, and of records whose sticks last three periods of the contact and more the share
 * with a stiffness.  A contact's number where there is no contact is beyond any error.
 * Exits 1 where more than 2 in 1000 numbers are beyond 5 errors, fewer than 93 % within 2, or fewer than
 * 60 % of the long sticks have a stiffness, by more than 2 binomial standard deviations.
 * usage: cover_identity [RECORDS [SEED [POPULATION]]]
 * RECORDS of each population (44); SEED is that of the first record (1); of one population, with a line a
 * number beyond 5 errors on standard error. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "chance.h"
#include "../rig.h"
#include "find/numbers.h"

enum { MOST_SAMPLES = 120000, MOST_EVENTS = 6000 };

static void
seed(uint64_t population, uint64_t record)
{
    chance = (population + 1) * 0x9e3779b97f4a7c15u + record * 0xbf58476d1ce4e5b9u;
}

/* --- records --------------------------------------------------------------------------------- */

typedef struct record {
    rig rig;
    rig_motion motion;
    double rate, settle;
    size_t n;
    double *x, *a, *f;          /* a is what the sensor says */
    double ring;                /* the contact's frequency, or where one would be expected [Hz] */
    double longest;             /* median over half-cycles of the longest stick, in periods of the contact */
    double repeats;             /* [Hz] NaN: it does not */
    int settles;                /* 1: several cycles may be as good an answer */
    double slips;               /* that begin after a stick, in the record; NaN: not only those */
    double gap_from, gap_to;    /* [s] */
} record;

static double
power(const double *x, size_t n)
{
    double mean = 0, sum = 0;
    for (size_t i = 0; i < n; i++)
        mean += x[i] / (double)n;
    for (size_t i = 0; i < n; i++)
        sum += (x[i] - mean) * (x[i] - mean);
    return sum / (double)n;
}

static double
largest(const double *x, size_t n)
{
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

/* --- sensors --------------------------------------------------------------------------------- */

static void
white(record *r, double *x, double db)
{
    double rms = sqrt(power(x, r->n)) * pow(10, -db / 20);
    for (size_t i = 0; i < r->n; i++)
        x[i] += rms * gauss();
}

/* 1/f between the record's length and the sampling: a sum of first-order noises an octave apart. */
static void
pink(record *r, double db)
{
    double *w = calloc(r->n, sizeof *w);
    if (w == NULL)
        abort();
    for (double tau = 1; tau < (double)r->n; tau *= 2) {
        double keep = exp(-1 / tau), step = sqrt(1 - keep * keep), y = gauss();
        for (size_t i = 0; i < r->n; i++)
            w[i] += y = keep * y + step * gauss();
    }
    double scale = sqrt(power(r->a, r->n) / power(w, r->n)) * pow(10, -db / 20);
    for (size_t i = 0; i < r->n; i++)
        r->a[i] += scale * w[i];
    free(w);
}

/* Mains and its third harmonic where the record resolves them, else a line near the contact. */
static void
hum(record *r, double db)
{
    double f = uniform() < 0.5 ? 50 : 60;
    if (f > 0.4 * r->rate || f * (double)r->n < 20 * r->rate)
        f = fmin(r->ring * between(0.5, 2), 0.4 * r->rate);
    double amplitude = sqrt(2 * power(r->a, r->n)) * pow(10, -db / 20), p = 2 * PI * uniform();
    for (size_t i = 0; i < r->n; i++) {
        double turn = 2 * PI * f / r->rate * (double)i + p;
        r->a[i] += amplitude * (sin(turn) + (f < 0.15 * r->rate ? 0.1 * sin(3 * turn) : 0));
    }
    white(r, r->a, 50);
}

/* Second order, by the bilinear transform, of this frequency and quality. */
static void
second_order(record *r, double f, double quality, int high)
{
    double k = tan(PI * fmin(f / r->rate, 0.45)), norm = 1 / (1 + k / quality + k * k);
    double b = high ? norm : k * k * norm, a1 = 2 * (k * k - 1) * norm, a2 = (1 - k / quality + k * k) * norm;
    double x1 = r->a[0], x2 = x1, y1 = high ? 0 : x1, y2 = y1;
    for (size_t i = 0; i < r->n; i++) {
        double y = b * (r->a[i] + (high ? -2 : 2) * x1 + x2) - a1 * y1 - a2 * y2;
        x2 = x1, x1 = r->a[i], y2 = y1, y1 = y;
        r->a[i] = y;
    }
    white(r, r->a, 50);
}

static void low_pass(record *r, double re_ring) { second_order(r, r->ring * re_ring * between(0.6, 1.7), sqrt(0.5), 0); }
static void high_pass(record *r, double re_ring) { second_order(r, r->ring * re_ring * between(0.6, 1.7), sqrt(0.5), 1); }
static void resonance(record *r, double re_ring) { second_order(r, r->ring * re_ring * between(0.7, 1.5), between(3, 20), 0); }

static void
ac_coupling(record *r, double re_base)
{
    double keep = exp(-2 * PI * re_base * (double)r->rig.f[0] / r->rate), x1 = r->a[0], y = 0;
    for (size_t i = 0; i < r->n; i++) {
        y = keep * (y + r->a[i] - x1);
        x1 = r->a[i];
        r->a[i] = y;
    }
    white(r, r->a, 50);
}

static void
bits(record *r, double n)
{
    double step = 2 * largest(r->a, r->n) / exp2(n);
    for (size_t i = 0; i < r->n; i++)
        r->a[i] = round(r->a[i] / step) * step;
}

static void
clip(record *r, double at)
{
    double most = at * largest(r->a, r->n);
    white(r, r->a, 50);
    for (size_t i = 0; i < r->n; i++)
        r->a[i] = fmax(-most, fmin(most, r->a[i]));
}

/* Read the motion again at these times [s] from the start of the record. */
static void
read_at(record *r, const double *t)
{
    size_t at = 0;
    for (size_t i = 0; i < r->n; i++) {
        double out[4];
        rig_at(&r->motion, r->settle + t[i], &at, out);
        r->a[i] = out[2];
    }
}

static void
jitter(record *r, double of_a_sample)
{
    double *t = calloc(r->n, sizeof *t);
    if (t == NULL)
        abort();
    for (size_t i = 0; i < r->n; i++)
        t[i] = fmax(0, ((double)i + of_a_sample * gauss()) / r->rate);
    read_at(r, t);
    white(r, r->a, 60);
    free(t);
}

/* The clock's rate is off by so much, rms, and changes within some cycles; its mean is right. */
static void
wander(record *r, double by)
{
    double *t = calloc(r->n, sizeof *t), rate = 0, sum = 0;
    double keep = exp(-(double)r->rig.f[0] / (r->rate * between(1, 5)));
    if (t == NULL)
        abort();
    for (size_t i = 0; i < r->n; i++) {
        rate = keep * rate + sqrt(1 - keep * keep) * gauss();
        t[i] = sum;
        sum += 1 + by * rate;
    }
    for (size_t i = 0; i < r->n; i++)
        t[i] *= (double)r->n / sum / r->rate;
    read_at(r, t);
    white(r, r->a, 60);
    free(t);
}

static void
dropout(record *r, double part)
{
    size_t from = (size_t)(between(0.2, 0.6) * (double)r->n), to = from + (size_t)(part * (double)r->n);
    white(r, r->a, 50);
    for (size_t i = from; i < to; i++)
        r->a[i] = 0;
    r->gap_from = (double)from / r->rate;
    r->gap_to = (double)to / r->rate;
}

static void
held(record *r, double samples)
{
    white(r, r->a, 60);
    for (size_t i = 0; i < r->n; i++)
        if (i % (size_t)samples != 0)
            r->a[i] = r->a[i - 1];
}

/* Without a filter before it, so that what is faster comes back as an alias. */
static void
decimate(record *r, double by)
{
    white(r, r->a, 60);
    for (size_t i = 0; i * (size_t)by < r->n; i++)
        r->a[i] = r->a[i * (size_t)by];
    r->n = (r->n + (size_t)by - 1) / (size_t)by;
    r->rate /= by;
}

static void plain(record *r, double db) { if (db > 0) white(r, r->a, db); }

typedef struct sensor {
    const char *name;
    void (*apply)(record *r, double by);
    double by;
} sensor;

static const sensor sensors[] = {
    { "clean", plain, 0 }, { "white 60 dB", plain, 60 }, { "white 40 dB", plain, 40 }, { "white 20 dB", plain, 20 },
    { "pink 40 dB", pink, 40 }, { "pink 20 dB", pink, 20 },
    { "hum -40 dB", hum, 40 }, { "hum -20 dB", hum, 20 }, { "hum -10 dB", hum, 10 },
    { "low-pass 5 f", low_pass, 5 }, { "low-pass f", low_pass, 1 }, { "resonance 5 f", resonance, 5 },
    { "AC coupling", ac_coupling, 0.1 }, { "high-pass f/4", high_pass, 0.25 },
    { "8 bit", bits, 8 }, { "10 bit", bits, 10 }, { "12 bit", bits, 12 }, { "clipped", clip, 0.8 },
    { "jitter", jitter, 0.02 }, { "dropout", dropout, 0.04 }, { "held samples", held, 3 }, { "decimated", decimate, 3 },
};
static const sensor coulomb_sensors[] = {
    { "hum -40 dB", hum, 40 }, { "hum -20 dB", hum, 20 }, { "hum -10 dB", hum, 10 }, { "white 40 dB", plain, 40 },
    { "low-pass 5 f", low_pass, 5 }, { "low-pass f", low_pass, 1 }, { "resonance f", resonance, 1 }, { "12 bit", bits, 12 },
};
static const sensor soft_sensors[] = {
    { "clean", plain, 0 }, { "white 40 dB", plain, 40 }, { "low-pass f", low_pass, 1 }, { "high-pass f/4", high_pass, 0.25 },
    { "wander .1 %", wander, 0.001 }, { "wander .3 %", wander, 0.003 },
};
static const sensor uneven_sensors[] = {
    { "clean", plain, 0 }, { "white 60 dB", plain, 60 }, { "white 40 dB", plain, 40 }, { "wander .1 %", wander, 0.001 },
};

/* --- populations ----------------------------------------------------------------------------- */

/* ratio: of the contact's frequency to the rig's. */
static rig
draw_rig(int is_elastic, double ratio, int harmonics)
{
    rig r = { .m = between(0.01, 100), .is_elastic = is_elastic, .n_harmonics = harmonics };
    double own = between(0.5, 50), w = 2 * PI * own, push = 0;
    r.k = r.m * w * w;
    r.d = uniform() < 0.5 ? 0 : 2 * between(0.001, 0.05) * r.m * w;
    if (is_elastic) {
        r.K_y = r.k * (ratio * ratio - 1);
        r.c = 2 * between(0.003, 0.15) * r.m * w * ratio;
        r.is_total = uniform() < 0.5;
    }
    double f = own * between(0.1, 0.9), amplitude = between(1e-5, 1e-3);
    for (int h = 0; h < harmonics; h++) {
        r.A[h] = amplitude * (h == 0 ? 1 : between(0.2, 0.8));
        r.f[h] = f * (h + 1);
        r.p[h] = 2 * PI * uniform();
        push += (double)(r.k * r.A[h]);
    }
    r.f_k = push * between(0.3, 0.95) / harmonics;
    r.f_s = uniform() < 0.5 ? r.f_k : r.f_k * between(1.02, 1.3);
    return r;
}

static int
order(const void *a, const void *b)
{
    double d = *(const double *)a - *(const double *)b;
    return (d > 0) - (d < 0);
}

/* The base's frequency over the number of its cycles after which the motion is the same; NaN: none up to 6.  A small
 * difference that was larger by a quarter 20 cycles before is how the motion settles, and no longer period; while it is
 * still to be seen, several cycles are no wrong answer. */
static double
repetition_of(const record *r, int *settles)
{
    enum { COMPARED = 8, BEFORE = 20, MOST = 6, CYCLES = BEFORE + COMPARED + MOST };
    double cycle = 1 / (double)r->rig.f[0], end = (double)r->motion.end * (1 - 1e-12), x[CYCLES];
    const double most = largest(r->x, r->n);
    size_t at = 0;
    for (int j = 0; j < CYCLES; j++) {
        double out[4];
        rig_at(&r->motion, end - j * cycle, &at, out);
        x[j] = out[0];
    }
    for (int p = 1; p <= MOST; p++) {
        double late = 0, early = 0;
        for (int j = 0; j < COMPARED; j++) {
            late = fmax(late, fabs(x[j] - x[j + p]));
            early = fmax(early, fabs(x[j + BEFORE] - x[j + BEFORE + p]));
        }
        *settles = late > 1e-4 * most;
        if (late < 1e-6 * most || (late < 0.05 * most && late < 0.8 * early))
            return (double)r->rig.f[0] / p;
    }
    return NAN;
}

static void
find_sticks(record *r)
{
    double half = 0.5 / (double)r->rig.f[0];
    size_t halves = (size_t)((double)r->n / r->rate / half), reversals = 0;
    double *longest = calloc(halves + 1, sizeof *longest);
    if (longest == NULL)
        abort();
    r->slips = 0;
    for (size_t i = 1; i < r->motion.n; i++) {
        const rig_piece *p = &r->motion.piece[i], *before = p - 1;
        double t = (double)p->t - r->settle;
        if (t < 0 || p->mode == 0)
            continue;
        int is_brief = (double)(p->t - before->t) * r->rate < 1;    /* no sample shows that it stopped there */
        reversals += before->mode != 0 || is_brief;
        r->slips += before->mode == 0;
        if (before->mode == 0 && (size_t)(t / half) < halves)
            longest[(size_t)(t / half)] = fmax(longest[(size_t)(t / half)], (double)(p->t - before->t));
    }
    if (reversals > 0 || r->rig.is_elastic)
        r->slips = NAN;
    qsort(longest, halves, sizeof *longest, order);
    r->longest = longest[halves / 2] * r->ring;
    free(longest);
}

typedef struct population {
    const char *name;
    int is_elastic, harmonics;
    double re_least, re_most;   /* contact's frequency re that of the rig */
    const sensor *sensor;
    size_t sensors;
} population;

#define SENSORS(list) list, sizeof list / sizeof *list
static const population populations[] = {
    { "elastic", 1, 1, 5, 60, SENSORS(sensors) },
    { "coulomb", 0, 1, 5, 60, SENSORS(coulomb_sensors) },
    { "soft", 1, 1, 1.15, 4.5, SENSORS(soft_sensors) },
    { "uneven", -1, 3, 5, 40, SENSORS(uneven_sensors) },
};
enum { POPULATIONS = sizeof populations / sizeof *populations };

/* 0: a rig that does not slip, or with more events than a record should have. */
static int
draw_record(record *r, const population *of)
{
    int is_elastic = of->is_elastic >= 0 ? of->is_elastic : uniform() < 0.3;
    int harmonics = of->harmonics == 1 ? 1 : uniform() < 0.5 ? 2 : 3;
    double ratio = between(of->re_least, of->re_most);
    *r = (record){ .rig = draw_rig(is_elastic, ratio, harmonics), .gap_from = NAN };
    rig *g = &r->rig;
    r->ring = ratio * sqrt((double)(g->k / g->m)) / (2 * PI);
    r->rate = r->ring * between(8, 50);
    double cycles = between(6, 40), f = (double)g->f[0];
    r->n = (size_t)(cycles / f * r->rate);
    r->settle = 40 / f;
    if (r->n > MOST_SAMPLES || r->n < 500
            || !rig_run(&r->motion, g, r->settle + (double)r->n / r->rate, MOST_EVENTS))
        return 0;
    r->x = calloc(3 * r->n, sizeof *r->x);
    if (r->x == NULL)
        abort();
    r->a = r->x + r->n;
    r->f = r->a + r->n;
    size_t at = 0;
    for (size_t i = 0; i < r->n; i++) {
        double out[4];
        rig_at(&r->motion, r->settle + (double)i / r->rate, &at, out);
        r->x[i] = out[0], r->a[i] = out[2], r->f[i] = out[3];
    }
    find_sticks(r);
    r->repeats = repetition_of(r, &r->settles);
    size_t slips = 0;
    for (size_t i = 1; i < r->motion.n; i++)
        slips += r->motion.piece[i].mode != 0 && (double)r->motion.piece[i].t > r->settle;
    return slips >= 6;
}

static void
drop_record(record *r)
{
    rig_free(&r->motion);
    free(r->x);
    r->x = NULL;
}

/* --- the count ------------------------------------------------------------------------------- */

typedef struct tally {
    size_t records, numbers, within, beyond, long_sticks, stiff;
} tally;

/* The true value; NaN: there is none, and none may be printed.  0: it is not counted. */
static int
truth_of(const record *r, const char *name, double *truth)
{
    const rig *g = &r->rig;
    double total = (double)(g->k + g->K_y), damping = (double)(g->d + g->c), m = (double)g->m;
    double s = damping / (2 * m), w = sqrt(total / m - s * s);
    if (strcmp(name, "transition_frequency") == 0)
        *truth = w / (2 * PI);
    else if (strcmp(name, "damping_ratio") == 0)
        *truth = s / sqrt(total / m);
    else if (strcmp(name, "total_stiffness") == 0)
        *truth = total;
    else if (strcmp(name, "contact_stiffness") == 0 || strcmp(name, "contact_stiffness_slope") == 0)
        *truth = (double)g->K_y;
    else if (strcmp(name, "contact_damping") == 0)
        *truth = damping;
    else if (strcmp(name, "repetition_frequency") == 0)
        return !isnan(*truth = r->repeats);
    else if (strcmp(name, "slips") == 0)
        return !isnan(*truth = r->slips);
    else if (strcmp(name, "slip_rate") == 0)
        return !isnan(*truth = r->slips * r->rate / (double)r->n);
    else
        return 0;
    if (!g->is_elastic && strcmp(name, "repetition_frequency") != 0)
        *truth = NAN;
    return 1;
}

static void
count(tally *t, const record *r, const char *name, double value, double error, const char *where)
{
    double truth = NAN;
    if (isnan(value) || !truth_of(r, name, &truth))
        return;
    if (strcmp(name, "repetition_frequency") == 0 && r->settles)
        truth /= fmax(1, round(truth / value));
    double off = fabs(value - truth) / error;
    if (strcmp(name, "slips") == 0)             /* one may be cut at either end */
        off = fmax(0, fabs(value - truth) - 2) / fmax(error, 0.5);
    else if (strcmp(name, "slip_rate") == 0)
        off = fmax(0, fabs(value - truth) - 2 * r->rate / (double)r->n) / error;
    t->numbers++;
    t->within += off <= 2;
    t->beyond += !(off <= 5);
    if (!(off <= 5) && where != NULL)
        fprintf(stderr, "%s\t%s %.9g +- %.3g\ttruth %.9g\toff %.3g\tsticks %.3g, samples %.3g a period, %zu rows\n",
                where, name, value, error, truth, off, r->longest, r->rate / r->ring, r->n);
}

static ss_signal *
signal_of(const record *r, int with_x_and_f)
{
    ss_header *head = NULL;
    ss_signal *signal = NULL;
    const double *column[] = { r->a, r->x, r->f };
    static const char *const name[] = { "a", "x", "f" }, *const unit[] = { "m/s^2", "m", "N" };
    size_t n = with_x_and_f ? 3 : 1;
    char gap[128];
    snprintf(gap, sizeof gap, "%.17g:%.17g", r->gap_from, r->gap_to);
    if (ss_header_new(&head, r->rate, 0, NULL) != SS_OK)
        abort();
    for (size_t c = 0; c < n; c++)
        if (ss_header_add_column(head, name[c], unit[c], NULL) != SS_OK)
            abort();
    if (!isnan(r->gap_from) && ss_header_note(head, "gaps", gap, NULL) != SS_OK)
        abort();
    if (ss_signal_new(&signal, head, r->n, NULL) != SS_OK)
        abort();
    for (size_t c = 0; c < n; c++)
        memcpy(signal->values + c * r->n, column[c], r->n * sizeof(double));
    ss_header_free(head);
    return signal;
}

static void
read_record(tally *t, record *r, const sensor *by, const char *where)
{
    int with_x_and_f = by->apply == plain;
    if (with_x_and_f && by->by > 0) {
        white(r, r->x, by->by + 20);
        white(r, r->f, by->by);
    }
    by->apply(r, by->by);
    ss_signal *signal = signal_of(r, with_x_and_f);
    ss_features *found = NULL;
    ss_features_opts opts;
    ss_features_opts_init(&opts, sizeof opts);
    ss_error err = { 0 };
    opts.mass = (double)r->rig.m;
    opts.stiffness = (double)r->rig.k;
    if (with_x_and_f)
        opts.displacement = 1, opts.force = 2;
    if (ss_features_find(&found, signal, 0, &opts, &err) != SS_OK) {
        fprintf(stderr, "cover_identity: %s\n", err.text);
        exit(1);
    }
    t->records++;
    int is_long = r->rig.is_elastic && r->longest >= 3;
    t->long_sticks += (size_t)is_long;
    for (int i = 0; i < SS_FEATURE_NUMBERS; i++) {
        const ss_number *got = &found->number[i];
        count(t, r, ss_feature_numbers[i].label.name, got->value, got->error, where);
        t->stiff += is_long && i == SS_TOTAL_STIFFNESS && !isnan(got->value);
    }
    ss_features_free(found);
    ss_signal_free(signal);
}

static double
share(size_t part, size_t of)
{
    return of > 0 ? 100. * (double)part / (double)of : NAN;
}

static void
print_row(const char *name, const char *kind, const tally *t)
{
    printf("%s\t%s\t%zu\t%zu\t%.1f\t%zu\t%.0f\n", name, kind, t->records, t->numbers,
           share(t->within, t->numbers), t->beyond, share(t->stiff, t->long_sticks));
}

/* Is a share above (or below) its bound by more than chance? */
static int
misses(size_t part, size_t of, double bound, int above)
{
    double n = (double)of, slack = 2 * sqrt(n * bound * (1 - bound)) + 1;
    return above ? (double)part > n * bound + slack : (double)part < n * bound - slack;
}

int
main(int argc, char *argv[])
{
    size_t records = argc > 1 ? strtoul(argv[1], NULL, 10) : 44;
    uint64_t first = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    const char *only = argc > 3 ? argv[3] : NULL;
    tally all = { 0 };
    printf("# population\tsensor\trecords\tnumbers\twithin_2/%%\tbeyond_5\tlong_sticks_answered/%%\n");
    for (int p = 0; p < POPULATIONS; p++) {
        const population *of = &populations[p];
        tally kind[32] = { { 0 } };
        for (size_t i = 0; i < records && (only == NULL || strcmp(only, of->name) == 0); i++) {
            const sensor *by = &of->sensor[i % of->sensors];
            record r;
            char where[96];
            seed((uint64_t)p, first + i);
            while (!draw_record(&r, of))
                drop_record(&r);
            snprintf(where, sizeof where, "%s %llu %s", of->name, (unsigned long long)(first + i), by->name);
            read_record(&kind[i % of->sensors], &r, by, only != NULL ? where : NULL);
            drop_record(&r);
        }
        for (size_t k = 0; k < of->sensors; k++) {
            const tally *t = &kind[k];
            if (t->records > 0)
                print_row(of->name, of->sensor[k].name, t);
            all.records += t->records, all.numbers += t->numbers, all.within += t->within, all.beyond += t->beyond;
            all.long_sticks += t->long_sticks, all.stiff += t->stiff;
        }
    }
    print_row("all", "all", &all);
    return misses(all.beyond, all.numbers, 0.002, 1) || misses(all.within, all.numbers, 0.93, 0)
        || misses(all.stiff, all.long_sticks, 0.6, 0);
}
