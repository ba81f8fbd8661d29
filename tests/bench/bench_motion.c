/* bench_motion.c -- how often ss_motion_ranking_new names the law of a simulated recording of motion and force.
 *
 * *     bench_motion [DRAWS [SEED [LAW [PART [DB]]]]]
 *
 * * Each law is integrated in small steps of its differential equation, which no code under test does, along a
 * motion that is drawn: one sine, three sines, or a sine that grows and falls.  Noise of the first order (.9) is
 * added to the force, 40 or 20 dB below it.  A second run leaves out the law and those that contain it: another is
 * then "close" if it is named, and its force differs from the true one by less than the noise does.
 *
 * * Of a force of no law (IWAN, PREISACH, POWER) a law that is named counts as simpler if its force differs from the
 * true one by less than the noise does, else as wrong.
 *
 * * PART, as .05: the rig is no law.  By a part of up to so much the friction wanders (with a memory of a cycle),
 * changes with the place, and differs between directions; the offset drifts; the force is late by up to half a row.
 *
 * * DB, 40 or 20: that noise alone. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>
#include "../uniform.h"

enum { ROWS = 4000, FINE = 40, LAWS = 9, RATE_AND_STATE = 8 };
/* What is none of the laws: sliders of lengths of a power law (Iwan) or log-normal (Preisach), and z' = v |1 - z
 * sgn v|^n (Dahl with another exponent than 1). */
enum { IWAN = LAWS, PREISACH, POWER, KINDS, SLIDERS = 100 };

static const char *const names[KINDS] = { "coulomb", "stribeck", "compliant", "dahl", "lugre", "compliant-gap",
                                         "bouc-wen", "bouc-wen-gap", "rate-and-state", "iwan", "preisach", "dahl-power" };
/* A law and those that contain it. */
static const char *const within[KINDS][10] = {
    { "coulomb", "stribeck", "compliant", "dahl", "lugre", "compliant-gap", "bouc-wen", "bouc-wen-gap",
      "rate-and-state", NULL },
    { "stribeck", "lugre", NULL }, { "compliant", "compliant-gap", "bouc-wen", "bouc-wen-gap", NULL },
    { "dahl", "lugre", "bouc-wen", "bouc-wen-gap", NULL }, { "lugre", NULL },
    { "compliant-gap", "bouc-wen-gap", NULL }, { "bouc-wen", "bouc-wen-gap", NULL }, { "bouc-wen-gap", NULL },
    { "rate-and-state", NULL }, { NULL }, { NULL }, { NULL } };

/* What a draw is made of; lengths in units of the rms motion, speeds of the rms speed. */
typedef struct truth {
    int law;
    double f, d, other, gap, n, p, rise, speed, shape, damping;
    double viscous, tilt, offset, inertia;
    double a, b;                                /* of rate and state; its distance is d */
    double length[SLIDERS], sum;                /* of sliders */
    double wander, place, side, drift, late;    /* what the law does not say */
} truth;

static double
between(uint64_t *seed, double from, double to)
{
    return from + (to - from) * uniform(seed);
}

static double
scaled(uint64_t *seed, double from, double to)
{
    return from * pow(to / from, uniform(seed));
}

static double
gauss(uint64_t *seed)
{
    double r = sqrt(-2 * log(1 - uniform(seed)));
    return r * cos(2 * M_PI * uniform(seed));
}

/* x, v and a of a motion of a kind at a time, in cycles. */
static void
motion_at(int kind, double t, const double phase[3], double m[3])
{
    static const double rate[3] = { 1, 1.37, 2.21 }, size[3] = { 1, .5, .3 };
    const double w = 2 * M_PI;
    m[0] = m[1] = m[2] = 0;
    if (kind == 1)
        for (int k = 0; k < 3; k++) {
            double r = w * rate[k];
            m[0] += size[k] * sin(r * t + phase[k]);
            m[1] += size[k] * r * cos(r * t + phase[k]);
            m[2] -= size[k] * r * r * sin(r * t + phase[k]);
        }
    else {
        double s = kind == 2 ? w * .23 : 0, g = 1 + .5 * sin(s * t + phase[1]);
        double g1 = .5 * s * cos(s * t + phase[1]);
        double g2 = -.5 * s * s * sin(s * t + phase[1]), co = cos(w * t + phase[0]), si = sin(w * t + phase[0]);
        m[0] = g * si;
        m[1] = g1 * si + g * w * co;
        m[2] = g2 * si + 2 * g1 * w * co - g * w * w * si;
    }
}

static double
clip(double x, double from, double to)
{
    return x < from ? from : x > to ? to : x;
}

/* The change of the memory z over a small step, by its differential equation. */
static double
rate_of(const truth *r, double z, double v)
{
    if (r->law == RATE_AND_STATE)
        return 1 - fabs(v) * z / r->d;
    if (r->law == POWER) {
        double to = 1 - z / r->d * (v > 0 ? 1 : -1);
        return v * pow(fabs(to), r->n) * (to > 0 ? 1 : -1);
    }
    double way = v > 0 ? 1 : -1, g = 1 + (r->rise - 1) * exp(-v * v / (r->speed * r->speed));
    if (r->law == 3 || r->law == 4)
        return v - fabs(v) * z / (r->d * (r->law == 4 ? g : 1));
    double y = fabs(z) > r->gap ? (fabs(z) - r->gap) * (z > 0 ? 1 : -1) / r->d : 0;
    return v * (1 - pow(fabs(y), r->n) * (1 - r->p + r->p * (y * way > 0 ? 1 : y * way < 0 ? -1 : 0)));
}

static double
friction_of(const truth *r, double z, double rate, double v)
{
    double y = fabs(z) > r->gap ? (fabs(z) - r->gap) * (z > 0 ? 1 : -1) : 0, way = v > 0 ? 1 : -1;
    switch (r->law) {
    case 0: return r->f * way;
    case 1: return r->f * way * (1 + (r->rise - 1) * exp(-pow(fabs(v) / r->speed, r->shape)));
    case 4: return r->f * z / r->d + r->damping * rate;
    case RATE_AND_STATE: return r->f * way * (1 + r->a * log(fabs(v)) + r->b * log(z / r->d));
    case 5: return r->f / r->d * y * (y < 0 ? r->p : 1);
    default: return r->f * y / r->d;
    }
}

/* Fill in the columns motion and force of a signal, and the force without noise. */
static void
simulate(ss_signal *s, double clean[ROWS], const truth *r, int kind, double db, uint64_t *seed)
{
    const double cycles = 10, h = cycles / ROWS / FINE;
    double *x = s->values, *f = x + ROWS, phase[3], z = r->law == RATE_AND_STATE ? r->d : 0, noise = 0, m[3];
    double sx = 0, sv = 0, sa = 0, sum = 0, squares = 0, wander = gauss(seed), before = 0;
    const double keep = exp(-cycles / ROWS);
    for (int k = 0; k < 3; k++)
        phase[k] = between(seed, 0, 2 * M_PI);
    for (int i = 0; i < ROWS; i++) {
        motion_at(kind, i * cycles / ROWS, phase, m);
        sx += m[0] * m[0] / ROWS;
        sv += m[1] * m[1] / ROWS;
        sa += m[2] * m[2] / ROWS;
    }
    sx = sqrt(sx), sv = sqrt(sv), sa = sqrt(sa);
    s->head->rate = ROWS / cycles * sx / sv;        /* so that the rms speed is 1 */
    double slid[SLIDERS] = { 0 };
    for (int i = 0; i < ROWS; i++) {
        double rate = 0;
        for (int k = -FINE / 2; k < FINE / 2 && r->law > 1; k++) {    /* to the time of the row */
            double t = i * cycles / ROWS + (k - FINE / 2) * h, v;
            motion_at(kind, t + h / 2, phase, m);
            v = m[1] / sv;
            double step = h * sv / sx;
            if (r->law == 2 || r->law == 5) {
                z = clip(z + step * v, -r->gap - r->d * (r->law == 5 ? r->other : 1), r->gap + r->d);
                continue;
            }
            if (r->law == IWAN || r->law == PREISACH) {
                z = 0;
                for (int j = 0; j < SLIDERS; j++) {
                    slid[j] = clip(slid[j] + step * v, -r->length[j], r->length[j]);
                    z += slid[j] / r->sum * r->d;
                }
                continue;
            }
            rate = rate_of(r, z + step / 2 * rate_of(r, z, v), v);
            z += step * rate;
        }
        motion_at(kind, i * cycles / ROWS, phase, m);
        double v = m[1] / sv, own, now;
        x[i] = m[0] / sx;
        wander = keep * wander + sqrt(1 - keep * keep) * gauss(seed);
        now = friction_of(r, z, rate, v);
        own = (now + r->late * (before - now)) * (1 + r->wander * wander + r->place * x[i] + (now > 0 ? r->side : 0));
        before = now;
        f[i] = own + r->drift * i / ROWS + r->offset + r->tilt * x[i] + r->viscous * v + r->inertia * m[2] / sa;
        clean[i] = f[i];
        sum += f[i] / ROWS;
        squares += f[i] * f[i] / ROWS;
    }
    double size = sqrt((squares - sum * sum) * pow(10, -db / 10) * (1 - .9 * .9));
    for (int i = -100; i < ROWS; i++) {
        noise = .9 * noise + size * gauss(seed);
        if (i >= 0) {
            f[i] += noise;
            x[i] += 1e-4 * gauss(seed);
        }
    }
}

static truth
draw(int law, uint64_t *seed)
{
    truth r = { .law = law, .f = 1, .d = scaled(seed, .05, .6), .other = scaled(seed, .6, 1.6),
                .n = scaled(seed, .6, 4),
                .p = between(seed, .5, 1), .rise = between(seed, 1.2, 2), .speed = scaled(seed, .05, .6),
                .shape = between(seed, 1, 2), .damping = between(seed, 0, .3), .viscous = between(seed, 0, .3),
                .tilt = between(seed, 0, .3), .offset = between(seed, -.3, .3), .inertia = between(seed, 0, .2) };
    if (law == RATE_AND_STATE) {
        r.a = scaled(seed, .01, .06);
        r.b = r.a * between(seed, .3, 1.6);
    }
    if (law == POWER)
        r.n = uniform(seed) < .5 ? between(seed, .3, .7) : between(seed, 1.5, 3);
    for (int i = 0; i < SLIDERS && (law == IWAN || law == PREISACH); i++) {
        r.length[i] = 2 * r.d * (law == IWAN ? pow((i + .5) / SLIDERS, r.p * 2) : exp(.7 * gauss(seed)));
        r.sum += r.length[i];
    }
    r.gap = law == 5 || law == 7 ? scaled(seed, .1, .7) : 0;
    return r;
}

/* The numbers of a law that are known, in the units of the recording. */
static int
known(const truth *r, const char *name, double *value)
{
    const double k = r->f / r->d, other = r->law == 5 ? r->p : 1;
    const struct { const char *name; double value; } of[] = {
        { "friction", r->f }, { "static_friction", r->f * r->rise }, { "contact_stiffness", k }, { "gap", r->gap },
        { "friction_negative", r->f * other * (r->law == 5 ? r->other : 1) },
        { "contact_stiffness_negative", k * other },
        { "normal_force", r->f }, { "direct_effect", r->a }, { "evolution_effect", r->b },
        { "critical_slip_distance", r->d },
        { "exponent", r->n }, { "beta_fraction", r->p }, { "stribeck_velocity", r->speed },
        { "stribeck_exponent", r->shape }, { "bristle_stiffness", k }, { "bristle_damping", r->damping } };
    for (size_t i = 0; i < sizeof of / sizeof *of; i++)
        if (strcmp(of[i].name, name) == 0) {
            *value = of[i].value;
            return 1;
        }
    return 0;
}

typedef struct counts {
    int right, simpler, untold, none, wrong, noticed, close, numbers, near;
} counts;

static int
is_one_of(const char *name, const char *const list[])
{
    for (; *list != NULL; list++)
        if (strcmp(*list, name) == 0)
            return 1;
    return 0;
}

/* Is the force that the first law predicts nearer to the true force than the measured one is? */
static int
is_close(const ss_motion_ranking *k, const ss_signal *s, const double clean[])
{
    double off = 0, noise = 0;
    for (int i = ROWS / 20; i < ROWS; i++) {
        off += pow(k->predicted[i] - clean[i], 2);
        noise += pow(s->values[ROWS + i] - clean[i], 2);
    }
    return off <= noise;
}

static void
count(counts *c, const truth *r, const ss_motion_ranking *k, const ss_signal *s, const double clean[])
{
    const int law = r->law;
    int is_limit = 0;
    for (int i = 0; i < LAWS; i++)
        is_limit |= strcmp(names[i], k->row[0].law) == 0 && is_one_of(names[law], within[i]);
    if (k->verdict == SS_UNDECIDED)
        c->untold++;
    else if (k->verdict != SS_NAMED)
        c->none++;
    else if (law >= LAWS)
        *(is_close(k, s, clean) ? &c->simpler : &c->wrong) += 1;
    else if (strcmp(k->row[0].law, names[law]) != 0)
        *(is_limit ? &c->simpler : &c->wrong) += 1;
    else {
        c->right++;
        for (size_t i = 0; i < k->n_numbers; i++) {
            const ss_value v = k->number[i].value;
            double value;
            if (known(r, k->number[i].name, &value) && v.error > 0) {
                c->numbers++;
                c->near += fabs(v.value - value) <= 2 * v.error;
                if (getenv("SHOW") != NULL)
                    printf("%s %s: %g, off by %g errors of %g\n", names[law], k->number[i].name, value,
                           (v.value - value) / v.error, v.error);
            }
        }
    }
}

int
main(int argc, char *argv[])
{
    const int draws = argc > 1 ? atoi(argv[1]) : 2;
    const char *only = argc > 3 && strcmp(argv[3], "all") != 0 ? argv[3] : NULL;
    const double part = argc > 4 ? atof(argv[4]) : 0;
    const int only_db = argc > 5 ? atoi(argv[5]) : 0;
    uint64_t seed = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    ss_header *head = NULL;
    ss_signal *s = NULL;
    ss_error err = { 0 };
    int wrong = 0;
    static double clean[ROWS];
    setvbuf(stdout, NULL, _IOLBF, BUFSIZ);
    if (ss_header_new(&head, ROWS / 10., 0, &err) != SS_OK || ss_header_add_column(head, "x", "m", &err) != SS_OK
        || ss_header_add_column(head, "f", "N", &err) != SS_OK || ss_signal_new(&s, head, ROWS, &err) != SS_OK)
        return 1;
    puts("dB law right simpler cannot none wrong noticed close within-2-errors of");
    for (int db = 40; db >= 20; db -= 20)
        for (int law = 0; law < KINDS && (only_db == 0 || db == only_db); law++) {
            counts c = { 0 };
            for (int i = 0; i < draws && (only == NULL || strcmp(only, names[law]) == 0); i++) {
                truth r = draw(law, &seed);
                if (part > 0)
                    r.wander = between(&seed, 0, part), r.place = between(&seed, -part, part),
                    r.side = between(&seed, -part, part), r.drift = between(&seed, -part, part),
                    r.late = between(&seed, 0, .5);
                ss_motion_ranking *with = NULL, *without = NULL;
                ss_motion_opts opts;
                ss_motion_opts_init(&opts, sizeof opts);
                simulate(s, clean, &r, i % 3, db, &seed);
                if (ss_motion_ranking_new(&with, s, 0, 1, &opts, &err) != SS_OK)
                    return 1;
                opts.without = within[law];
                if (law < LAWS && ss_motion_ranking_new(&without, s, 0, 1, &opts, &err) != SS_OK)
                    return 1;
                count(&c, &r, with, s, clean);
                c.noticed += law < LAWS && without->verdict != SS_NAMED;
                c.close += law < LAWS && without->verdict == SS_NAMED && is_close(without, s, clean);
                ss_motion_ranking_free(with);
                ss_motion_ranking_free(without);
            }
            if (c.right + c.simpler + c.untold + c.none + c.wrong > 0)
                printf("%d %s %d %d %d %d %d %d %d %d %d\n", db, names[law], c.right, c.simpler, c.untold, c.none,
                       c.wrong, c.noticed, c.close, c.near, c.numbers);
            wrong += law < LAWS ? c.wrong : 0;
        }
    ss_signal_free(s);
    ss_header_free(head);
    return wrong > draws * LAWS * 2 / 100 + 1;
}
