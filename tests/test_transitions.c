/* test_transitions.c -- transitions of simulated scenes, held against the scenes' own numbers. */
#include <stdlib.h>
#include <string.h>
#include <complex.h>
#include <math.h>
#include <stickslip.h>
#include <gsl/gsl_rng.h>
#include "new_signal.h"
#include "rig.h"
#include "shipped.h"
#include "unit.h"
#include "find/numbers.h"
#include "noise_rms.h"
#include "signal/noise.h"
#include "signal/header.h"

enum { SEEDS = 4 };

static ss_scene
scene_of(const char *name)
{
    ss_scene scene = read_shipped_named(name);
    scene.duration = 3.2;
    return scene;
}

/* The features of the scene's acceleration in noise of snr dB (infinite: none), in other units. */
static ss_features *
features_in(const ss_scene *scene, double snr, unsigned long seed, double unit, double seconds)
{
    ss_features_opts opts;
    ss_features_opts_init(&opts, sizeof opts);
    ss_features *f = NULL;
    ss_signal *signal = NULL;
    assert_int_equal(ss_sim_signal(&signal, scene, NULL), SS_OK);
    size_t column = (size_t)ss_header_column(signal->head, "a");
    double *a = signal->values + column * signal->n;
    if (isfinite(snr))
        ss_noise_add_once(a, signal->n, noise_rms(a, signal->n, snr), seed, NULL);
    for (size_t i = 0; i < signal->n; i++)
        a[i] *= unit;
    signal->head->rate /= seconds;
    opts.mass = scene->mass;
    opts.stiffness = scene->stiffness;
    assert_int_equal(ss_features_find(&f, signal, column, &opts, NULL), SS_OK);
    ss_signal_free(signal);
    return f;
}

static ss_features *
features_of(const ss_scene *scene, double snr, unsigned long seed)
{
    return features_in(scene, snr, seed, 1, 1);
}

static double
stiffness(const ss_scene *s)
{
    return s->stiffness + ss_scene_get(s, "contact_stiffness");
}

static double
ratio(const ss_scene *s)
{
    return ss_scene_get(s, "contact_damping") / (2 * sqrt(stiffness(s) * s->mass));
}

/* The worst allowed of single runs: ten times the rms of the bench at 40 dB, five at 20 dB. */
static const struct level { double snr, stiffness, ratio; } level[] = {
    { INFINITY, 2e-4, 2e-3 }, { 40, 1e-3, 1.5e-2 }, { 20, 1e-2, 0.12 }
};

static void
reads_stiffness_and_damping(void **state)
{
    static const char *const names[] = { "compliant-heavy", "compliant-light" };
    (void)state;
    for (int i = 0; i < 4; i++) {
        ss_scene scene = scene_of(names[i % 2]);
        ss_scene_set_text(&scene, "release", i < 2 ? "spring" : "total", NULL);
        for (int k = 0; k < 3; k++)
            for (unsigned long seed = 1; seed <= (k > 0 ? SEEDS : 1); seed++) {
                ss_features *f = features_of(&scene, level[k].snr, seed);
                double K = f->number[SS_TOTAL_STIFFNESS].value / stiffness(&scene) - 1;
                double z = f->number[SS_DAMPING_RATIO].value / ratio(&scene) - 1;
                if (!(fabs(K) <= level[k].stiffness && fabs(z) <= level[k].ratio))
                    fail_msg("%s at %g dB, seed %lu: stiffness off by %g, damping by %g",
                             names[i % 2], level[k].snr, seed, K, z);
                assert_true(fabs(f->number[SS_CONTACT_STIFFNESS].value + scene.stiffness
                                 - f->number[SS_TOTAL_STIFFNESS].value) < 1e-6);
                if (k == 0)     /* what is left is shared by all: within three of its errors */
                    assert_true(fabs(K * stiffness(&scene)) <= 3 * f->number[SS_TOTAL_STIFFNESS].error
                                && fabs(z * ratio(&scene)) <= 3 * f->number[SS_DAMPING_RATIO].error);
                assert_true(fabs(f->number[SS_REPETITION_FREQUENCY].value - scene.base_frequency) < 0.01);
                assert_true(fabs(f->number[SS_SLIP_RATE].value - 2 * scene.base_frequency) < 0.02);
                ss_features_free(f);
            }
    }
}

/* 600 transitions: windows grow about some of them, many are left out at a time, and the map has several
 * strips. */
static void
reads_long_records_as_well(void **state)
{
    static const struct { const char *name; int level; } run[] = { { "compliant-heavy", 0 },
                                                                   { "compliant-light", 1 } };
    (void)state;
    for (int i = 0; i < 2; i++) {
        ss_scene scene = scene_of(run[i].name);
        scene.duration = 120;
        ss_features *f = features_of(&scene, level[run[i].level].snr, 1);
        double K = f->number[SS_TOTAL_STIFFNESS].value / stiffness(&scene) - 1;
        double z = f->number[SS_DAMPING_RATIO].value / ratio(&scene) - 1;
        if (!(fabs(K) <= level[run[i].level].stiffness && fabs(z) <= level[run[i].level].ratio))
            fail_msg("%s: stiffness off by %g, damping by %g", run[i].name, K, z);
        assert_true(fabs((double)f->n - 600) <= 2);
        assert_true(f->recurring + 2 >= f->n);
        ss_features_free(f);
    }
}

/* Stiff and soft, light and heavy: within bounds, or refused.  The stiff ones, with 4 to 8 samples a period, have
 * died out in the noise when a slip begins: a sensor that resonates would look the same. */
static void
reads_stiff_and_soft_contacts(void **state)
{
    static const double K_y[] = { 6e4, 6e5, 6e6, 2e7 }, damping[] = { 0.005, 0.05, 0.2 };
    static const struct { double snr; int refused; } noise[] = { { 40, 7 }, { 60, 3 } };
    (void)state;
    for (int l = 0; l < 2; l++) {
        int refused = 0;
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 3; j++) {
                ss_scene scene = scene_of("compliant-light");
                ss_scene_set(&scene, "contact_stiffness", K_y[i], NULL);
                ss_scene_set(&scene, "contact_damping", damping[j] * 2 * sqrt(stiffness(&scene) * scene.mass),
                             NULL);
                ss_features *f = features_of(&scene, noise[l].snr, 1);
                double K = f->number[SS_TOTAL_STIFFNESS].value / stiffness(&scene) - 1;
                double z = f->number[SS_DAMPING_RATIO].value / damping[j] - 1;
                refused += isnan(K);
                if (fabs(K) > 5e-3 || fabs(z) > 0.05)       /* not a number: refused */
                    fail_msg("K_y %g, ratio %g: off by %g, %g", K_y[i], damping[j], K, z);
                ss_features_free(f);
            }
        assert_true(refused <= noise[l].refused);
    }
}

/* A displacement sticks at another level each time: both slips of a cycle count, with a unit or by the name alone. */
static void
counts_the_slips_of_a_displacement(void **state)
{
    static const char *const units[] = { "m", "" };
    (void)state;
    for (int i = 0; i < 2; i++) {
        ss_scene scene = scene_of("coulomb");
        ss_signal *signal = NULL;
        ss_features *f = NULL;
        scene.friction = 0.9;
        scene.duration = 8;
        assert_int_equal(ss_sim_signal(&signal, &scene, NULL), SS_OK);
        size_t column = (size_t)ss_header_column(signal->head, "x"), n = signal->n;
        double *x = signal->values + column * n;
        strcpy(signal->head->column[column].unit, units[i]);
        ss_noise_add_once(x, n, noise_rms(x, n, 80), 1, NULL);
        assert_int_equal(ss_features_find(&f, signal, column, NULL, NULL), SS_OK);
        assert_true(fabs(f->number[SS_SLIPS].value - 2 * scene.base_frequency * scene.duration) <= 1);
        assert_true(fabs(f->number[SS_SLIP_RATE].value - 2 * scene.base_frequency) < 0.01);
        ss_features_free(f);
        ss_signal_free(signal);
    }
}

/* A rig with true sticks, or with none, on a base of three harmonics. */
static rig
draw_rig(gsl_rng *rng)
{
    rig r = { .m = 2.42L, .k = 2310, .f_s = 0, .n_harmonics = 3 };
    for (int h = 0; h < 3; h++) {
        r.f[h] = 2.5L * (h + 1);
        r.A[h] = 1e-3L * (long double)gsl_rng_uniform(rng) / (h + 1);
        r.p[h] = 6.283185307179586L * (long double)gsl_rng_uniform(rng);
        r.f_k = r.f_s += r.k * r.A[h] * (long double)gsl_rng_uniform(rng);
    }
    return r;
}

/* The slips between two times: all begin behind a stick of a sample or more, or all where the motion turns; else NaN. */
static double
true_slips(const rig_motion *m, double from, double to, double rate)
{
    double slips = 0, turns = 0;
    for (size_t i = 1; i < m->n; i++) {
        const rig_piece *p = &m->piece[i];
        int is_slip = p->mode != 0 && (double)p->t >= from && (double)p->t < to;
        int is_behind = p[-1].mode == 0 && (double)(p->t - p[-1].t) * rate >= 1;
        slips += is_slip && is_behind;
        turns += is_slip && !is_behind;
    }
    return slips > 0 && turns > 0 ? NAN : slips + turns;
}

/* A converter that clips makes levels at which a signal seems to rest. */
static void
what_is_clipped_has_no_slips_of_its_own(void **state)
{
    enum { DRAWS = 100, N = 8000, FIRST = 4000 };
    static const char *const names[] = { "v", "a" }, *const units[] = { "m/s", "m/s^2" };
    const double rate = 1000;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_taus2);
    int known = 0, clipped = 0;
    (void)state;
    gsl_rng_set(rng, 27);
    for (int draw = 0; draw < DRAWS; draw++) {
        const rig r = draw_rig(rng);
        rig_motion motion;
        size_t at = 0;
        int of = draw % 2;
        double range = 0, part = draw % 5 == 0 ? 1 : .15 + .8 * gsl_rng_uniform(rng);
        ss_signal *signal = new_signal(N, rate, 0, names[of], units[of]);
        ss_features *f = NULL;
        assert_true(rig_run(&motion, &r, (N + FIRST) / 1000.L, 5000));
        for (int i = 0; i < N; i++) {
            double x[4];
            rig_at(&motion, (FIRST + i) / 1000.L, &at, x);
            signal->values[i] = x[1 + of];
            range = fmax(range, fabs(signal->values[i]));
        }
        ss_noise_add_once(signal->values, N, range * 1e-4, (unsigned long)draw + 1, NULL);
        for (int i = 0; i < N; i++)
            signal->values[i] = fmax(-part * range, fmin(signal->values[i], part * range));
        assert_int_equal(ss_features_find(&f, signal, 0, NULL, NULL), SS_OK);
        const double slips = f->number[SS_SLIPS].value, truth = true_slips(&motion, FIRST / rate, (FIRST + N) / rate, rate);
        if (!isnan(slips) && fabs(slips - truth) > 1)
            fail_msg("draw %d, %s clipped at %g: %g slips, there are %g", draw, names[of], part, slips, truth);
        known += !isnan(slips);
        clipped += !isnan(slips) && part < 1;
        ss_features_free(f);
        ss_signal_free(signal);
        rig_free(&motion);
    }
    gsl_rng_free(rng);
    print_message("%d known, %d of these clipped\n", known, clipped);
    assert_true(known >= 20 && clipped >= 10);
}

/* A contact without damping rings as long as it sticks: it has its frequency, and no damping ratio. */
static void
an_undamped_contact_has_its_frequency(void **state)
{
    (void)state;
    ss_scene scene = scene_of("compliant-light");
    assert_int_equal(ss_scene_set(&scene, "contact_damping", 1e-6, NULL), SS_OK);
    scene.duration = 8;
    const double truth = sqrt(stiffness(&scene) / scene.mass) / (2 * M_PI);
    for (int snr = 40; snr <= 60; snr += 20) {
        ss_features *f = features_of(&scene, snr, 3);
        const double found = f->number[SS_TRANSITION_FREQUENCY].value, error = f->number[SS_TRANSITION_FREQUENCY].error;
        if (!(fabs(found - truth) <= 5 * error && error < 1e-3 * truth))
            fail_msg("%d dB: %.9g +- %g Hz, not %.9g", snr, found, error, truth);
        assert_true(isnan(f->number[SS_DAMPING_RATIO].value));
        ss_features_free(f);
    }
}

/* Nothing rings on a Coulomb rig.  A weak hum is larger than all else in its sticks and smaller than the jumps where
 * slips begin, so it seems to end there, as what rings in a contact does; but its phase goes on from stick to stick. */
static void
a_hum_is_no_undamped_contact(void **state)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_taus2);
    (void)state;
    gsl_rng_set(rng, 9);
    for (int draw = 0; draw < 24; draw++) {
        const double hum = 150 * pow(3, gsl_rng_uniform(rng)), part = 8e-4 * pow(8, gsl_rng_uniform(rng));
        const double phase = 2 * M_PI * gsl_rng_uniform(rng), snr = 60 + 15 * gsl_rng_uniform(rng);
        ss_scene scene = scene_of("coulomb");
        ss_signal *signal = NULL;
        ss_features *f = NULL;
        double largest = 0;
        scene.duration = 8;
        assert_int_equal(ss_sim_signal(&signal, &scene, NULL), SS_OK);
        const size_t column = (size_t)ss_header_column(signal->head, "a"), n = signal->n;
        double *a = signal->values + column * n;
        for (size_t i = 0; i < n; i++)
            largest = fmax(largest, fabs(a[i]));
        for (size_t i = 0; i < n; i++)
            a[i] += part * largest * cos(2 * M_PI * hum * (double)i / scene.rate + phase);
        ss_noise_add_once(a, n, noise_rms(a, n, snr), 1, NULL);
        assert_int_equal(ss_features_find(&f, signal, column, NULL, NULL), SS_OK);
        if (!isnan(f->number[SS_TRANSITION_FREQUENCY].value))
            fail_msg("a hum of %g Hz: a contact of %g Hz", hum, f->number[SS_TRANSITION_FREQUENCY].value);
        ss_features_free(f);
        ss_signal_free(signal);
    }
    gsl_rng_free(rng);
}

/* Half a cycle of these bases leaves sticks of 0.3 to 1.5 periods. */
static void
refuses_sticks_under_two_periods(void **state)
{
    static const struct { double base, friction, K_y; } row[] = {
        { 3, 1.2, 6e4 }, { 4, 1.2, 2e5 }, { 6, 1.2, 2e5 }, { 15, 1.2, 2e5 }, { 8, 0.8, 2e5 },
        { 5, 0.4, 2e4 } };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++)
        for (int k = 0; k < 2; k++) {
            ss_scene scene = scene_of("compliant-light");
            scene.base_frequency = row[i].base;
            scene.friction = row[i].friction;
            ss_scene_set(&scene, "contact_stiffness", row[i].K_y, NULL);
            ss_features *f = features_of(&scene, level[k].snr, 1);
            if (!isnan(f->number[SS_TRANSITION_FREQUENCY].value) || !isnan(f->number[SS_DAMPING_RATIO].value))
                fail_msg("base %g Hz, K_y %g: %g Hz", row[i].base, row[i].K_y,
                         f->number[SS_TRANSITION_FREQUENCY].value);
            for (size_t t = 0; t < f->n; t++)
                assert_true(isnan(f->transition[t].frequency.value));
            ss_features_free(f);
        }
}

static void
compliant_contacts_have_local_maxima_and_others_not(void **state)
{
    static const struct { const char *name; size_t least, most; } row[] = {
        { "coulomb", 0, 0 }, { "state-variable", 0, 0 }, { "compliant-heavy", 13, 16 },
        { "compliant-light", 13, 16 } };
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        ss_scene scene = scene_of(row[i].name);
        for (int k = 0; k < 3; k++)
            for (unsigned long seed = 1; seed <= (k > 0 ? SEEDS : 1); seed++) {
                ss_features *f = features_of(&scene, level[k].snr, seed);
                if (f->recurring < row[i].least || f->recurring > row[i].most)
                    fail_msg("%s at %g dB: %zu of %zu", row[i].name, level[k].snr, f->recurring,
                             f->n);
                assert_true(isnan(f->number[SS_TRANSITION_FREQUENCY_RAW].value) == (row[i].most == 0));
                if (i == 0 && k == 0)               /* no noise, which may recur as well */
                    assert_string_equal(f->number[SS_TRANSITION_FREQUENCY].why,
                                        "no band of frequencies stands out behind the transitions");
                if (f->n < 15 || f->n > 16)
                    fail_msg("%s at %g dB, seed %lu: %zu transitions", row[i].name, level[k].snr,
                             seed, f->n);
                ss_features_free(f);
            }
    }
}

typedef struct kept {
    size_t n;
    ss_event event[100];
} kept;

static int
keep(const ss_event *e, void *user)
{
    kept *k = user;
    k->event[k->n++] = *e;
    return k->n == 100;
}

/* Each from the stick that follows a macroscopic slip to the last release before the next: within two
 * samples of the simulator's events. */
static void
transitions_begin_and_end_with_the_events(void **state)
{
    static const char *const names[] = { "coulomb", "compliant-heavy", "compliant-light" };
    (void)state;
    for (int i = 0; i < 3; i++) {
        ss_scene scene = scene_of(names[i]);
        ss_features *f = features_of(&scene, INFINITY, 1);
        ss_sim_opts opts;
        ss_sim_opts_init(&opts, sizeof opts);
        kept k = { 0 };
        size_t t = 0;
        opts.events = keep;
        opts.user = &k;
        assert_int_equal(ss_sim_run(&scene, &opts, NULL, NULL), SS_OK);
        for (size_t e = 0; e < k.n; e++) {
            if (k.event[e].kind != SS_STICK || (e > 0 && k.event[e].t - k.event[e - 1].t < 0.05))
                continue;                                   /* a micro-slip ends */
            size_t last = e + 1;
            while (last + 1 < k.n && k.event[last + 1].t - k.event[last].t < 0.05)
                last++;
            if (t >= f->n || fabs(f->transition[t].onset - k.event[e].t) > 2 / scene.rate
                || fabs(f->transition[t].end - k.event[last].t) > 2 / scene.rate)
                fail_msg("%s: transition %zu", names[i], t);
            t++;
        }
        assert_int_equal(t, f->n);
        ss_features_free(f);
    }
}

/* A change of units changes nothing but units: of a contact that rings, and of friction whose spikes alone show
 * its transitions. */
static void
units_and_rates_do_not_matter(void **state)
{
    static const double unit[] = { 1, 0x1p-660, 0x1p660 }, seconds[] = { 1, 0x1p20, 0x1p-20 };
    static const char *const names[] = { "compliant-light", "coulomb" };
    (void)state;
    for (int scene_at = 0; scene_at < 2; scene_at++)
        for (int i = 1; i < 3; i++) {
            ss_scene scene = scene_of(names[scene_at]);
            ss_features *a = features_of(&scene, 40, 1);
            ss_features *b = features_in(&scene, 40, 1, unit[i], seconds[i]);
            double f = a->number[SS_TRANSITION_FREQUENCY].value,
                g = b->number[SS_TRANSITION_FREQUENCY].value * seconds[i];
            assert_true(a->n > 0);
            assert_int_equal(a->n, b->n);
            for (size_t k = 0; k < a->n; k++)
                assert_true(fabs(b->transition[k].onset / seconds[i] - a->transition[k].onset)
                            < 1e-9 * a->transition[k].onset);
            assert_int_equal(isnan(f), scene_at == 1);
            if (scene_at == 0) {
                assert_true(fabs(g / f - 1) < 1e-9);
                assert_true(fabs(b->number[SS_DAMPING_RATIO].value / a->number[SS_DAMPING_RATIO].value - 1) < 1e-6);
            }
            ss_features_free(a);
            ss_features_free(b);
        }
}

static ss_signal *
plain(size_t n, double rms)
{
    ss_signal *signal = new_signal(n, 1000, 0, "a", "");
    ss_noise_add_once(signal->values, n, rms, 1, NULL);
    return signal;
}

static void
finds_nothing_in_noise_silence_and_short_records(void **state)
{
    static const size_t n[] = { 0, 1, 2, 7, 30, 100, 4000 };
    (void)state;
    for (int rms = 0; rms < 2; rms++)
        for (size_t i = 0; i < sizeof n / sizeof *n; i++) {
            ss_signal *signal = plain(n[i], rms);
            ss_features *f = NULL;
            assert_int_equal(ss_features_find(&f, signal, 0, NULL, NULL), SS_OK);
            assert_int_equal(f->n, 0);
            assert_true(!(f->number[SS_SLIPS].value > 0));
            assert_true(isnan(f->number[SS_TRANSITION_FREQUENCY].value)
                        && isnan(f->number[SS_TRANSITION_FREQUENCY_RAW].value)
                        && isnan(f->number[SS_REPETITION_FREQUENCY].value)
                            && isnan(f->number[SS_SLIP_RATE].value));
            ss_features_free(f);
            ss_signal_free(signal);
        }
}

/* The third harmonic is ten times the fundamental. */
/* A square wave of +-12, whose reversals set off 4 of a damped oscillation at 38 Hz, and noise: the
 * jumps hide it in the map.  Within four of its errors, which are those of the noise. */
static void
rings_beside_larger_jumps(void **state)
{
    const double rate = 1000, w = 2 * M_PI * 38, damping = 0.04;
    const double damped = 38 * sqrt(1 - damping * damping);
    (void)state;
    for (int k = 0; k < 2; k++) {
        ss_features *f = NULL;
        ss_signal *signal = plain(8000, 0.05);
        size_t reversal = 0, half = 385;
        for (size_t i = 0; i < signal->n; i++) {
            double sign = i / half % 2 ? -1 : 1, t = (double)(i % half) / rate;
            double phase = 2 * M_PI * damped * t;
            signal->values[i] += sign * (12 + 4 * exp(-damping * w * t)
                                         * (k > 0 ? sin(phase) : cos(phase)));
        }
        assert_int_equal(ss_features_find(&f, signal, 0, NULL, NULL), SS_OK);
        if (!(fabs(f->number[SS_TRANSITION_FREQUENCY].value - damped) <= 4
              * f->number[SS_TRANSITION_FREQUENCY].error
              && f->number[SS_TRANSITION_FREQUENCY].error < 1e-4 * damped
              && fabs(f->number[SS_DAMPING_RATIO].value - damping) <= 4 * f->number[SS_DAMPING_RATIO].error
              && f->number[SS_DAMPING_RATIO].error < 1e-2 * damping))
            fail_msg("%d: %g Hz, %g", k, f->number[SS_TRANSITION_FREQUENCY].value,
                     f->number[SS_DAMPING_RATIO].value);
        assert_int_equal(f->n, 8000 / half);
        for (size_t i = 0; i < f->n; i++) {
            reversal += half;           /* the jump is between this sample and the one before */
            assert_true(fabs(f->transition[i].onset * rate - ((double)reversal - 0.5)) <= 1);
            assert_true(f->transition[i].spikes >= 1);
        }
        ss_features_free(f);
        ss_signal_free(signal);
    }
}

/* A pulse, a burst of oscillation and a step, 30 samples long, in noise of 0.002 of their height.
 * The noise is seen up to band = 0.002 sqrt(2 ln m), m < 4000 samples, and may take as much off.
 * The step, the slowest to rise, sin(pi u / 2)^2, is twice that at u = 2 / pi asin(sqrt(2 band));
 * then there is a sample. */
/* Chebyshev's low-pass of fourth order with a ripple of 1 dB, by the bilinear transform. */
static void
filter_sharply(double *x, size_t n, double corner)
{
    double lean = asinh(1 / sqrt(pow(10, 0.1) - 1)) / 4, warped = 2 * tan(M_PI * corner);
    for (int k = 0; k < 2; k++) {
        double phase = M_PI * (2 * k + 1) / 8;
        double complex p = warped * (-sinh(lean) * sin(phase) + I * cosh(lean) * cos(phase)), z = (2 + p) / (2 - p);
        double a = -2 * creal(z), b = pow(cabs(z), 2), now[3] = { x[0], x[0], x[0] }, y[2] = { x[0], x[0] };
        for (size_t i = 0; i < n; i++) {
            now[2] = now[1], now[1] = now[0], now[0] = x[i];
            x[i] = (1 + a + b) / 4 * (now[0] + 2 * now[1] + now[2]) - a * y[0] - b * y[1];
            y[1] = y[0], y[0] = x[i];
        }
    }
}

/* A resonator of this frequency re the rate and this quality, by the bilinear transform. */
static void
resonate(double *x, size_t n, double f, double quality)
{
    double k = tan(M_PI * f), norm = 1 / (1 + k / quality + k * k);
    double now[3] = { x[0], x[0], x[0] }, y[2] = { x[0], x[0] };
    for (size_t i = 0; i < n; i++) {
        now[2] = now[1], now[1] = now[0], now[0] = x[i];
        x[i] = norm * (k * k * (now[0] + 2 * now[1] + now[2]) - 2 * (k * k - 1) * y[0]
                       - (1 - k / quality + k * k) * y[1]);
        y[1] = y[0], y[0] = x[i];
    }
}

static void
check_sensor(const ss_scene *scene, double f, double quality, int k)
{
    ss_signal *signal = NULL;
    ss_features *found = NULL;
    assert_int_equal(ss_sim_signal(&signal, scene, NULL), SS_OK);
    size_t column = (size_t)ss_header_column(signal->head, "a"), n = signal->n;
    double *a = signal->values + column * n;
    resonate(a, n, f, quality);
    ss_noise_add_once(a, n, noise_rms(a, n, 50), 1 + (unsigned long)k, NULL);
    assert_int_equal(ss_features_find(&found, signal, column, NULL, NULL), SS_OK);
    if (!isnan(found->number[SS_TRANSITION_FREQUENCY].value))
        fail_msg("%d: %g Hz", k, found->number[SS_TRANSITION_FREQUENCY].value);
    ss_features_free(found);
    ss_signal_free(signal);
}

/* A sensor that resonates rings behind each jump as a contact does, but where a slip begins, too. */
static void
the_ringing_of_a_sensor_is_no_contact(void **state)
{
    (void)state;
    for (int k = 0; k < 12; k++) {
        ss_scene scene = scene_of("coulomb");
        scene.friction *= 0.6 + 0.05 * (k % 6);
        scene.duration = 10;
        scene.rate = 2000;
        check_sensor(&scene, 0.02 * (1 + k % 4), 3 + k, k);
    }
    ss_scene slow = scene_of("coulomb");        /* its slips begin slowly */
    slow.mass = 6.6256922, slow.stiffness = 1350.38059, slow.friction = .00586937992;
    slow.base_amplitude = 1.33323328e-05, slow.base_frequency = .474735915;
    slow.settle = 40 / slow.base_frequency, slow.rate = 294.208187, slow.duration = 7409 / slow.rate;
    for (int k = 12; k < 16; k++)
        check_sensor(&slow, .0718800679, 6.74720346, k + 8);
}

/* A low-pass near the contact's frequency rounds all jumps and kinks, and its slips are far stronger than what rings
 * between them. */
static void
a_contact_rings_behind_a_low_pass(void **state)
{
    static const double ratio[] = { 0.01, 0.03, 0.08 };
    (void)state;
    for (int k = 0; k < 6; k++) {
        ss_scene scene = scene_of("compliant-heavy");
        ss_signal *signal = NULL;
        ss_features *found = NULL;
        const double stiffness = 40000, w = sqrt((scene.stiffness + stiffness) / scene.mass), zeta = ratio[k / 2];
        assert_int_equal(ss_scene_set(&scene, "contact_stiffness", stiffness, NULL), SS_OK);
        assert_int_equal(ss_scene_set(&scene, "contact_damping", 2 * zeta * scene.mass * w, NULL), SS_OK);
        scene.base_frequency = 0.3, scene.friction = 0.9;
        scene.settle = 20, scene.duration = 40, scene.rate = 500;
        assert_int_equal(ss_sim_signal(&signal, &scene, NULL), SS_OK);
        size_t column = (size_t)ss_header_column(signal->head, "a"), n = signal->n;
        double *a = signal->values + column * n;
        resonate(a, n, (1 + 0.25 * (k % 2)) * w / (2 * M_PI * scene.rate), sqrt(0.5));
        ss_noise_add_once(a, n, noise_rms(a, n, 50), 1 + (unsigned long)k, NULL);
        assert_int_equal(ss_features_find(&found, signal, column, NULL, NULL), SS_OK);
        const ss_number *got = &found->number[SS_TRANSITION_FREQUENCY];
        double off = (got->value - w * sqrt(1 - zeta * zeta) / (2 * M_PI)) / got->error;
        if (!(fabs(off) < 4))
            fail_msg("%d: %.8g +- %.2g Hz", k, got->value, got->error);
        ss_features_free(found);
        ss_signal_free(signal);
    }
}

/* A filter rings behind each jump, at its corner; a slider without a contact does not. */
static void
the_ringing_of_a_filter_is_no_contact(void **state)
{
    int slips = 0;
    (void)state;
    for (int k = 0; k < 8; k++) {
        ss_scene scene = scene_of("coulomb");
        ss_signal *signal = NULL;
        ss_features *f = NULL;
        scene.friction *= 0.6 + 0.05 * k;
        scene.duration = 6;
        scene.rate = 8000 * (1 + k % 2);
        assert_int_equal(ss_sim_signal(&signal, &scene, NULL), SS_OK);
        size_t column = (size_t)ss_header_column(signal->head, "a"), n = signal->n;
        double *a = signal->values + column * n;
        filter_sharply(a, n, 0.2);
        ss_noise_add_once(a, n, noise_rms(a, n, 60), 1 + (unsigned long)k, NULL);
        assert_int_equal(ss_features_find(&f, signal, column, NULL, NULL), SS_OK);
        slips += isfinite(f->number[SS_SLIP_RATE].value);
        assert_true(isnan(f->number[SS_TRANSITION_FREQUENCY].value)
                    && isnan(f->number[SS_DAMPING_RATIO].value)
                        && f->number[SS_TRANSITION_FREQUENCY].why != NULL);
        ss_features_free(f);
        ss_signal_free(signal);
    }
    assert_true(slips >= 6);
}

static void
single_events_have_an_extent(void **state)
{
    enum { N = 4000, FROM = 1900, LONG = 30 };
    const double band = 0.002 * sqrt(2 * log(N)), late = LONG * 2 / M_PI * asin(sqrt(2 * band)) + 1;
    (void)state;
    for (int k = 0; k < 3; k++) {
        ss_features *f = NULL;
        ss_signal *signal = plain(N, 0.002);
        for (size_t i = FROM; i < N; i++) {
            double u = (double)(i - FROM) / LONG;
            double pulse = u < 1 ? sin(M_PI * u) : 0;
            signal->values[i] += k == 0 ? pulse : k == 1 ? pulse * sin(8 * M_PI * u)
                : u < 1 ? 0.5 - 0.5 * cos(M_PI * u) : 1;
        }
        for (size_t i = 0; i < N; i++)
            signal->values[i] += 3 + 1e-4 * (double)i;
        assert_int_equal(ss_features_find(&f, signal, 0, NULL, NULL), SS_OK);
        assert_int_equal(f->n, 1);
        double onset = f->transition[0].onset * 1000 - FROM;
        double end = FROM + LONG - f->transition[0].end * 1000;
        if (!(onset >= -1 && onset <= late && end >= -1 && end <= late))
            fail_msg("%d: from %g to %g, not within %g", k, onset, LONG - end, late);
        ss_features_free(f);
        ss_signal_free(signal);
    }
}

/* Jumps in the cycles of a sine that are prime: how many a second is not known; in each: as many. */
static void
no_slip_rate_where_repetitions_have_no_transition(void **state)
{
    (void)state;
    for (int all = 0; all < 2; all++) {
        ss_features *f = NULL;
        ss_signal *signal = plain(6400, 1e-3);
        double height = 0;
        for (size_t i = 0; i < signal->n; i++) {
            size_t cycle = i / 200;
            if (i % 200 == 60 && (all || 0xa08a28acu >> cycle & 1))
                height = 0.5 - height;
            signal->values[i] += height + sin(2 * M_PI * (double)i / 200);
        }
        assert_int_equal(ss_features_find(&f, signal, 0, NULL, NULL), SS_OK);
        assert_true(all || fabs(f->number[SS_REPETITION_FREQUENCY].value - 5) < 0.01);
        if (all)
            assert_true(fabs(f->number[SS_SLIP_RATE].value - 5) < 0.02);
        else
            assert_true(f->n == 11 && isnan(f->number[SS_SLIP_RATE].value));
        ss_features_free(f);
        ss_signal_free(signal);
    }
}

static void
the_forcing_is_no_harmonic(void **state)
{
    ss_signal *signal = plain(8000, 0.1);
    ss_features *f = NULL;
    (void)state;
    for (size_t i = 0; i < signal->n; i++) {
        double p = 2 * M_PI * 2.3 * (double)i / 1000;
        signal->values[i] += 0.1 * sin(p) + sin(3 * p) + 0.3 * cos(5 * p);
    }
    assert_int_equal(ss_features_find(&f, signal, 0, NULL, NULL), SS_OK);
    assert_true(fabs(f->number[SS_REPETITION_FREQUENCY].value - 2.3) < 0.005);
    ss_features_free(f);
    ss_signal_free(signal);
}

/* Falls of a force at known times: their rate is one over the mean of the times between them, and its error that of
 * a mean of so many, by their scatter. */
static void
the_rate_of_uneven_falls_has_the_error_of_a_mean(void **state)
{
    static const size_t each[] = { 410, 620, 500, 370, 580, 455 };
    enum { TIMES = sizeof each / sizeof *each - 1, RATE = 1000, N = 3000, FALL = 5 };
    ss_signal *signal = new_signal(N, RATE, 0, "force", "N");
    ss_features *f = NULL;
    double mean = 0, squares = 0;
    (void)state;
    for (size_t i = 0, from = 0, k = 0; i < N; i++) {
        if (k <= TIMES && i == from + each[k])
            from += each[k++];
        double fallen = fmin(1, (double)(i - from) / FALL), before = k > 0 ? (double)each[k - 1] : 0;
        signal->values[i] = 1000 + fmax((double)(i - from), before * (1 - fallen));
    }
    for (size_t k = 1; k <= TIMES; k++)
        mean += (double)each[k] / RATE / TIMES;
    for (size_t k = 1; k <= TIMES; k++)
        squares += pow((double)each[k] / RATE - mean, 2);
    assert_int_equal(ss_features_find(&f, signal, 0, NULL, NULL), SS_OK);
    const ss_number rate = f->number[SS_SLIP_RATE];
    assert_int_equal(f->n, TIMES + 1);
    assert_true(fabs(rate.value * mean - 1) < 1e-6);
    assert_true(fabs(rate.error * mean * mean / sqrt(squares / (TIMES - 1) / TIMES) - 1) < 1e-3);
    ss_features_free(f);
    ss_signal_free(signal);
}

/* Of a force and a displacement that have nothing to do with each other there is none. */
static void
has_no_slope_without_a_spring(void **state)
{
    enum { N = 4000, WINDOWS = 10 };
    double *f = malloc(3 * N * sizeof *f), *x = f + N, *y = x + N;
    ss_window span[WINDOWS];
    size_t known = 0;
    (void)state;
    assert_non_null(f);
    for (size_t i = 0; i < N; i++)
        f[i] = x[i] = 0, y[i] = sin(0.2 * (double)i);
    for (size_t i = 0; i < WINDOWS; i++)
        span[i] = (ss_window){ 400 * i + 10, 400 * i + 300 };
    for (unsigned long seed = 0; seed < 20; seed++) {
        ss_value slope;
        ss_noise_add_once(f, N, 1, 2 * seed + 1, NULL);
        ss_noise_add_once(x, N, 1, 2 * seed + 2, NULL);
        assert_int_equal(ss_slope_find(f, x, y, span, WINDOWS, &slope), SS_OK);
        known += isfinite(slope.value);
    }
    assert_true(known <= 1);
    free(f);
}

static void
reads_the_slope_of_force_over_displacement(void **state)
{
    static const char *const names[] = { "compliant-heavy", "compliant-light" };
    (void)state;
    for (int i = 0; i < 2; i++) {
        ss_scene scene = scene_of(names[i]);
        ss_features_opts opts;
        ss_features_opts_init(&opts, sizeof opts);
        ss_features *f = NULL;
        ss_signal *signal = NULL;
        assert_int_equal(ss_sim_signal(&signal, &scene, NULL), SS_OK);
        opts.displacement = ss_header_column(signal->head, "x");
        opts.force = ss_header_column(signal->head, "f");
        assert_int_equal(ss_features_find(&f, signal, (size_t)ss_header_column(signal->head, "a"),
                                          &opts, NULL), SS_OK);
        ss_number slope = f->number[SS_CONTACT_STIFFNESS_SLOPE];
        double off = fabs(slope.value - ss_scene_get(&scene, "contact_stiffness"));
        assert_true(off <= 3 * slope.error && slope.error < 1e-4 * slope.value);
        assert_true(isnan(f->number[SS_TOTAL_STIFFNESS].value));               /* no mass given */
        ss_features_free(f);
        ss_signal_free(signal);
    }
}

/* Samples from first on, that many, are missing: filled with 0, or by a line between neighbours. */
static void
make_gap(ss_signal *signal, size_t column, size_t first, size_t many, int line)
{
    double *x = signal->values + column * signal->n, rate = signal->head->rate;
    char text[2 * SS_NUMBER_MAX + 2];
    size_t length = ss_number_format(text, signal->head->start + (double)first / rate);
    text[length++] = ':';
    ss_number_format(text + length, signal->head->start + (double)(first + many) / rate);
    assert_int_equal(ss_header_note(signal->head, "gaps", text, NULL), SS_OK);
    for (size_t i = 0; i < many; i++)
        x[first + i] = !line ? 0 : x[first - 1] + (x[first + many] - x[first - 1]) * (double)(i + 1)
                                                  / (double)(many + 1);
}

/* Neither its own spike nor one that is not there without it. */
static void
check_spikes(const ss_features *f, const ss_features *whole, double from, double to, const char *what)
{
    for (size_t i = 0; i < f->spikes->n; i++) {
        const ss_spike *s = &f->spikes->spike[i];
        double off = INFINITY;
        for (size_t k = 0; k < whole->spikes->n; k++)
            off = fmin(off, fabs(whole->spikes->spike[k].t - s->t));
        if (s->t >= from && s->t <= to)
            fail_msg("%s: a spike at %g s, in the gap", what, s->t);
        if (off > 1 / 2000. && s->kind != SS_SPIKE_BEND)
            fail_msg("%s: a spike at %g s, where none is without a gap", what, s->t);
    }
}

static double
label_of(const ss_features *f, double t)
{
    for (size_t i = 0; i < f->spikes->n; i++)
        if (f->spikes->spike[i].t == t)
            return f->spikes->spike[i].f;
    return 0;
}

/* The same time: of a spike that is seen first at the same scale, exactly; but the threshold counts by
 * the noise, of which a gap leaves out some, and at the next scale noise moves the fit. */
static int
same_time(const ss_features *f, double t, const ss_features *whole, double of)
{
    return fabs(t - of) <= (label_of(f, t) == label_of(whole, of) ? 1e-9 : 1 / 2000.);
}

/* Transitions that no gap reaches into are what they were, and nearly all are; none lies in it, and no
 * fit sees it. */
static void
check_transitions(const ss_features *f, const ss_features *whole, double from, double to,
                  const char *what)
{
    size_t k = 0, same = 0;
    for (size_t i = 0; i < f->n; i++) {
        const ss_transition *a = &f->transition[i], *b;
        if (a->onset >= from && a->onset < to)
            fail_msg("%s: a transition at %g s, in the gap", what, a->onset);
        if (a->from < to && a->to > from)
            fail_msg("%s: fitted from %g to %g s, over the gap", what, a->from, a->to);
        if (a->gap)
            continue;
        for (b = &whole->transition[k]; k < whole->n && b->onset < a->onset - 0.05; b++)
            k++;
        if (k == whole->n || !same_time(f, a->onset, whole, b->onset)
            || !same_time(f, a->end, whole, b->end)
            || b->spikes != a->spikes || isnan(b->maximum.t) != isnan(a->maximum.t)
            || isnan(b->frequency.value) != isnan(a->frequency.value)
            || fabs(b->frequency.value - a->frequency.value)
               > 0.1 * b->frequency.error + 1e-6 * b->frequency.value)
            fail_msg("%s (%g to %g s): %.9g ... %.9g s, %zu spikes, %.9g Hz, maximum at %g s; "
                     "without %.9g ... %.9g, %zu, %.9g +- %.2g, %g", what, from, to, a->onset, a->end,
                     a->spikes, a->frequency.value, a->maximum.t, b->onset, b->end, b->spikes,
                     b->frequency.value, b->frequency.error, b->maximum.t);
        same++;
    }
    if (same + 3 < whole->n || f->n > whole->n)
        fail_msg("%s: %zu of %zu transitions are left", what, same, whole->n);
}

/* Compare the features without n samples, from first on, with those of the whole signal; rings: these
 * have ringing. */
static void
check_gap(const ss_signal *signal, size_t column, const ss_features *whole, int rings, size_t first,
          size_t n, int how, const char *what)
{
    const double from = (double)first / signal->head->rate;
    const double to = (double)(first + n) / signal->head->rate;
    ss_signal *with = NULL;
    ss_features *f = NULL;
    assert_int_equal(ss_signal_select(&with, signal, &column, 1, 0, signal->n, NULL), SS_OK);
    make_gap(with, 0, first, n, how);
    assert_int_equal(ss_features_find(&f, with, 0, NULL, NULL), SS_OK);
    check_spikes(f, whole, from, to, what);
    check_transitions(f, whole, from, to, what);
    /* a gap makes no maximum prominent, nor moves what is fitted to the rest */
    if (!rings && f->recurring > 0)
        fail_msg("%s: %zu local maxima", what, f->recurring);
    if (rings && !(fabs(f->number[SS_TRANSITION_FREQUENCY].value - whole->number[SS_TRANSITION_FREQUENCY].value)
                   <= 2 * hypot(whole->number[SS_TRANSITION_FREQUENCY].error,
                                f->number[SS_TRANSITION_FREQUENCY].error)))
        fail_msg("%s: %.9g Hz, not %.9g", what, f->number[SS_TRANSITION_FREQUENCY].value,
                 whole->number[SS_TRANSITION_FREQUENCY].value);
    if (!(fabs(f->number[SS_SLIP_RATE].value - whole->number[SS_SLIP_RATE].value) <= 0.01))
        fail_msg("%s: %g slips a second", what, f->number[SS_SLIP_RATE].value);
    ss_features_free(f);
    ss_signal_free(with);
}

/* Gaps in a stick, at its release and in the slip behind it, into the onset of the next slip, and over
 * two of them: their begin [s], from a release on, and length.  Each is tried as either kind of gap. */
static void
check_gaps(const char *name, int is_noisy)
{
    static const struct { double from, length; } gap[] = {
        { -0.05, 0.01 }, { -0.005, 0.01 }, { 0.03, 0.02 }, { 0.1, 0.02 }, { -0.05, 0.002 },
        { -0.06, 0.19 } };
    const int rings = strcmp(name, "coulomb") != 0;
    ss_scene scene = scene_of(name);
    ss_signal *signal = NULL;
    ss_features *whole = NULL;
    scene.settle = 20;
    assert_int_equal(ss_sim_signal(&signal, &scene, NULL), SS_OK);
    size_t column = (size_t)ss_header_column(signal->head, "a");
    double *a = signal->values + column * signal->n;
    if (is_noisy)
        ss_noise_add_once(a, signal->n, noise_rms(a, signal->n, 40), 3, NULL);
    signal->head->start = 7;
    assert_int_equal(ss_features_find(&whole, signal, column, NULL, NULL), SS_OK);
    assert_true(whole->n >= 15);
    for (int g = 0; g < 12; g++) {
        char what[128];
        double from = whole->transition[7].end + gap[g % 6].from;
        snprintf(what, sizeof what, "%s, %s, gap %d", name, is_noisy ? "40 dB" : "clean", g);
        check_gap(signal, column, whole, rings, (size_t)(from * scene.rate),
                  (size_t)(gap[g % 6].length * scene.rate), g >= 6, what);
    }
    ss_features_free(whole);
    ss_signal_free(signal);
}

static void
gaps_leave_out_what_they_reach_and_nothing_else(void **state)
{
    static const char *const names[] = { "coulomb", "compliant-heavy", "compliant-light" };
    (void)state;
    for (int i = 0; i < 3; i++) {
        check_gaps(names[i], 0);
        check_gaps(names[i], 1);
    }
}

/* A slider of friction 1 N on a spring of 4 N/m that is moved to and fro, as Jenkins's: where two of three steps of
 * the force lack samples, whose displacement is not known, either, the others have the stiffness. */
static void
steps_with_gaps_have_no_stiffness(void **state)
{
    enum { HALF = 500, HALVES = 12, N = HALVES * HALF + 200 };
    char gaps[400] = "";
    ss_header *head = NULL;
    ss_signal *signal = NULL;
    ss_features *f = NULL;
    ss_features_opts opts;
    (void)state;
    ss_features_opts_init(&opts, sizeof opts);
    opts.displacement = 1;
    assert_int_equal(ss_header_new(&head, 1000, 0, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "force", "N", NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "x", "m", NULL), SS_OK);
    assert_int_equal(ss_signal_new(&signal, head, N, NULL), SS_OK);
    double *force = signal->values, *x = force + N;
    for (size_t i = 0; i < N; i++) {
        double to = 2 * (double)(i % HALF) / HALF - 1;
        x[i] = i / HALF % 2 ? -to : to;
        force[i] = i == 0 ? -1 : fmax(-1, fmin(1, force[i - 1] + 4 * (x[i] - x[i - 1])));
    }
    for (size_t k = 1; k < HALVES; k++)
        if (k % 3 > 0) {
            size_t first = k * HALF + 2, length = 30, end = strlen(gaps);
            memset(force + first, 0, length * sizeof *force);
            memset(x + first, 0, length * sizeof *x);
            snprintf(gaps + end, sizeof gaps - end, "%s%zue-3:%zue-3", end > 0 ? " " : "", first, first + length);
        }
    assert_int_equal(ss_header_note(signal->head, "gaps", gaps, NULL), SS_OK);
    assert_int_equal(ss_features_find(&f, signal, 0, &opts, NULL), SS_OK);
    assert_true(fabs(f->number[SS_FRICTION].value - 1) < 1e-3);
    assert_true(fabs(f->number[SS_LOADING_STIFFNESS].value - 4) < 1e-3);
    ss_features_free(f);
    ss_signal_free(signal);
    ss_header_free(head);
}

static void
refuses_what_is_out_of_range(void **state)
{
    static const ss_features_opts good = { .size = sizeof good, .threshold = 4, .displacement = -1, .force = -1,
                                           .threads = 1 };
    ss_features_opts bad[8];
    ss_signal *signal = plain(100, 1);
    ss_features *f = NULL;
    (void)state;
    for (int i = 0; i < 8; i++)
        bad[i] = good;
    bad[0].threshold = 0, bad[1].mass = -1, bad[2].stiffness = NAN, bad[3].fmin = INFINITY;
    bad[4].threads = 0, bad[5].force = 1, bad[6].drop = -1, bad[7].threshold = NAN;
    for (int i = 0; i < 8; i++)
        assert_int_equal(ss_features_find(&f, signal, 0, &bad[i], NULL), SS_EINVAL);
    assert_int_equal(ss_features_find(&f, signal, 1, &good, NULL), SS_EINVAL);
    signal->values[3] = NAN;
    assert_int_equal(ss_features_find(&f, signal, 0, &good, NULL), SS_EDATA);
    signal->values[3] = 0;
    ss_header_note(signal->head, "gaps", "1:2, 3:4", NULL);
    assert_int_equal(ss_features_find(&f, signal, 0, &good, NULL), SS_EDATA);
    ss_features_free(NULL);
    ss_signal_free(signal);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_stiffness_and_damping),
        cmocka_unit_test(reads_long_records_as_well),
        cmocka_unit_test(counts_the_slips_of_a_displacement),
        cmocka_unit_test(what_is_clipped_has_no_slips_of_its_own),
        cmocka_unit_test(an_undamped_contact_has_its_frequency),
        cmocka_unit_test(a_hum_is_no_undamped_contact),
        cmocka_unit_test(reads_stiff_and_soft_contacts),
        cmocka_unit_test(refuses_sticks_under_two_periods),
        cmocka_unit_test(compliant_contacts_have_local_maxima_and_others_not),
        cmocka_unit_test(transitions_begin_and_end_with_the_events),
        cmocka_unit_test(units_and_rates_do_not_matter),
        cmocka_unit_test(finds_nothing_in_noise_silence_and_short_records),
        cmocka_unit_test(the_forcing_is_no_harmonic),
        cmocka_unit_test(rings_beside_larger_jumps),
        cmocka_unit_test(a_contact_rings_behind_a_low_pass),
        cmocka_unit_test(the_ringing_of_a_filter_is_no_contact),
        cmocka_unit_test(the_ringing_of_a_sensor_is_no_contact),
        cmocka_unit_test(single_events_have_an_extent),
        cmocka_unit_test(no_slip_rate_where_repetitions_have_no_transition),
        cmocka_unit_test(the_rate_of_uneven_falls_has_the_error_of_a_mean),
        cmocka_unit_test(has_no_slope_without_a_spring),
        cmocka_unit_test(reads_the_slope_of_force_over_displacement),
        cmocka_unit_test(gaps_leave_out_what_they_reach_and_nothing_else),
        cmocka_unit_test(steps_with_gaps_have_no_stiffness),
        cmocka_unit_test(refuses_what_is_out_of_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
