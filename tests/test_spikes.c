/* test_spikes.c -- jumps, kinks, glitches, single events and drops whose places are known. */
#include <stdlib.h>
#include <string.h>
#include <float.h>
#include <math.h>
#include <stickslip.h>
#include "find/cycles.h"
#include "find/drops.h"
#include "find/fitter.h"
#include "find/window.h"
#include "spike_score.h"
#include "uniform.h"
#include "unit.h"
#include "find/events.h"
#include "signal/gaps.h"
#include "noise_rms.h"
#include "signal/noise.h"

#define RATE 2000.

static ss_bursts
bursts_of(const double *x, size_t n, double rate, double range, const ss_span *gap, size_t n_gaps)
{
    row_source source;
    ss_bursts found;
    ss_row_source_init(&source, x, n, rate, gap, n_gaps);
    assert_int_equal(ss_bursts_find(&found, &source, range), SS_OK);
    return found;
}

static ss_spikes *
find(const double *x, size_t n, double rate)
{
    ss_spikes *found = NULL;
    assert_int_equal(spikes_of(&found, x, n, rate, NULL, 0), SS_OK);
    return found;
}

/* Truncated powers (t - t0)^p from t0 on: a jump, a kink, a curve that begins; and a Gaussian ten
 * samples wide, of which a spectrum that falls faster than any power is left. */
static double
shape(int which, double t)
{
    switch (which) {
    case 0:  return fabs(t) < 0.5 / RATE;
    case 1:  return t >= 0;
    case 2:  return t >= 0 ? 50 * t : 0;
    default: return exp(-0.5 * (t * RATE / 10) * (t * RATE / 10));
    }
}

/* The slopes that the spectra of the sampled shapes give between the shortest scale a and 2 a:
 * that of a jump is 1/(2 sin(w/2)), so between f = 0.582 and 0.291 of Nyquist it falls by 0.9 dB
 * less than the 6 dB of 1/w; of a kink twice that; where between two samples it is, and the
 * wavelet's width, add 0.5 dB. */
static void
tells_jumps_from_kinks_bends_and_glitches(void **state)
{
    static const struct { ss_spike_kind kind; double lo, hi; } want[] = {
        { SS_SPIKE_GLITCH, -3.1, -2.9 }, { SS_SPIKE_JUMP, 3.01 - 0.9 - 0.5, 3.01 },
        { SS_SPIKE_KINK, 9.03 - 1.8 - 0.5, 9.03 + 0.5 }, { SS_SPIKE_BEND, 22, 100 } };
    (void)state;
    for (int which = 0; which < 4; which++)
        for (int part = 0; part < 4; part++) {
            enum { N = 2000 };
            double x[N], t0 = (1000 + (which == 0 ? 0 : part / 4.)) / RATE;
            for (size_t i = 0; i < N; i++)
                x[i] = 7 + shape(which, (double)i / RATE - t0);
            ss_spikes *found = find(x, N, RATE);
            assert_true(found->n >= 1 && found->conclusive == (which < 3));
            const ss_spike *s = &found->spike[0];
            for (size_t i = 1; i < found->n; i++)       /* a bend has shoulders too */
                s = found->spike[i].level > s->level ? &found->spike[i] : s;
            if (s->kind != want[which].kind || s->slope < want[which].lo
                || s->slope > want[which].hi || (which < 3 && found->n > 1))
                fail_msg("shape %d: %zu spikes, a %s of slope %g", which, found->n,
                         ss_spike_kind_name(s->kind), s->slope);
            double allow = which == 1 ? 0.5 : which == 2 ? 0.02 : 0.25;    /* samples */
            if (which < 3 && !(fabs(s->t - t0) * RATE <= allow + 1e-9))
                fail_msg("shape %d at %g: %g samples off", which, t0, (s->t - t0) * RATE);
            ss_spikes_free(found);
        }
}

/* Every spike is what it was in other units, about another mean, at another rate and backwards. */
static void
units_and_clocks_do_not_matter(void **state)
{
    score_scene s;
    (void)state;
    score_scene_make(&s, "compliant-light", RATE, 1, 0);
    double *x = malloc(s.n * sizeof *x);
    ss_spikes *want = score_find(&s, 40, 1), *found;
    static const struct { double gain, offset, rate; } change[] = {
        { 1e-9, 0, RATE }, { -1e150, 0, RATE }, { 1, 100, RATE }, { 1, 0, 1e-3 }, { 1, 0, 1e9 } };
    for (size_t k = 0; k < sizeof change / sizeof *change; k++) {
        memcpy(x, s.a, s.n * sizeof *x);
        ss_noise_add_once(x, s.n, noise_rms(x, s.n, 40), 1, NULL);
        for (size_t i = 0; i < s.n; i++)
            x[i] = change[k].gain * x[i] + change[k].offset;
        found = find(x, s.n, change[k].rate);
        if (found->n != want->n)
            fail_msg("change %zu: %zu spikes, not %zu", k, found->n, want->n);
        for (size_t i = 0; i < found->n; i++) {
            assert_int_equal(found->spike[i].kind, want->spike[i].kind);
            /* rounding of samples 100 times larger; scales stand on a grid of 1/4 octave from 1 s,
             * so that another rate moves them by up to half of that, and the span of the fit with
             * them */
            double allow = change[k].rate == RATE ? 1e-3 : 0.75;
            double off = found->spike[i].t * change[k].rate - want->spike[i].t * RATE;
            if (!(fabs(off) <= allow))
                fail_msg("change %zu: spike %zu is %g samples off", k, i, off);
        }
        ss_spikes_free(found);
    }
    ss_spikes_free(want);
    free(x);
    ss_signal_free(s.signal);
}

/* All events of the clean scenes, within a sample.  16 transitions: the first micro-slip lasts 0.10
 * ms. */
static void
finds_every_event_of_clean_scenes(void **state)
{
    static const struct { const char *name; double rate; } scene[] = {
        { "coulomb", RATE }, { "compliant-heavy", RATE }, { "compliant-light", RATE },
        { "compliant-light", 20000 } };
    (void)state;
    for (size_t k = 0; k < sizeof scene / sizeof *scene; k++) {
        score_scene s;
        score sc = { 0 };
        size_t slips = 0, seen = 0;
        score_scene_make(&s, scene[k].name, scene[k].rate, 3.2, 0);
        ss_spikes *found = score_find(&s, INFINITY, 1);
        score_add(&sc, &s, found);
        assert_true(found->conclusive);
        if (sc.wrong > 0 || sc.near != sc.right)
            fail_msg("%s: %zu wrong, %zu of %zu within a sample", scene[k].name, sc.wrong, sc.near,
                     sc.right);
        for (size_t e = 0; e < s.n_events; e++) {
            int pair = score_micro_slip(&s, e) > 0 || (e > 0 && score_micro_slip(&s, e - 1) > 0);
            if (!pair && !sc.seen[e])
                fail_msg("%s: no spike at %g s", scene[k].name, s.event[e].t);
        }
        score_slips(&s, &sc, 0, 1, &slips, &seen);
        assert_int_equal(seen, slips);
        assert_int_equal(sc.transitions, 16);
        int light = strcmp(scene[k].name, "compliant-light") == 0;
        assert_int_equal(slips, light ? 16 : 0);
        if (light ? sc.grouped < 15 : sc.grouped > 0)
            fail_msg("%s at %g Hz: %zu grouped", scene[k].name, scene[k].rate, sc.grouped);
        ss_spikes_free(found);
        ss_signal_free(s.signal);
    }
}

static void
coulomb_friction_makes_one_spike_a_transition(void **state)
{
    score_scene s;
    size_t strong = 0;
    (void)state;
    score_scene_make(&s, "coulomb", RATE, 3.2, 0);
    ss_spikes *found = score_find(&s, INFINITY, 1);
    for (size_t i = 0; i < found->n; i++) {
        strong += found->spike[i].level >= -30;
        assert_int_equal(found->spike[i].kind,
                         found->spike[i].level >= -30 ? SS_SPIKE_JUMP : SS_SPIKE_KINK);
    }
    assert_int_equal(strong, 16);
    for (size_t e = 0; e + 1 < s.n_events; e += 2)
        assert_int_equal(ss_spikes_within(found, s.event[e].t, s.event[e + 1].t, 30), 1);
    ss_spikes_free(found);
    ss_signal_free(s.signal);
}

static void
a_smooth_law_bends_and_never_breaks(void **state)
{
    score_scene s;
    score sc = { 0 };
    (void)state;
    score_scene_make(&s, "state-variable", RATE, 3.2, 0);
    ss_spikes *found = score_find(&s, INFINITY, 1);
    score_add(&sc, &s, found);
    assert_true(sc.bends >= 32 && found->conclusive);
    assert_int_equal(sc.jumps + sc.kinks + sc.glitches, 0);
    ss_spikes_free(found);
    ss_signal_free(s.signal);
}

/* 20 seeds, fixed: what the bench prints for more of them. */
static void
finds_micro_slips_40_dB_above_the_noise(void **state)
{
    static const char *const name[] = { "compliant-light", "compliant-heavy", "coulomb" };
    (void)state;
    for (size_t k = 0; k < 3; k++) {
        score_scene s;
        score sc = { 0 };
        size_t slips = 0, seen = 0;
        score_scene_make(&s, name[k], RATE, 3.2, 0);
        for (unsigned long seed = 1; seed <= 20; seed++) {
            ss_spikes *found = score_find(&s, 40, seed);
            score_add(&sc, &s, found);
            score_slips(&s, &sc, 1.3e-3, 1, &slips, &seen);
            assert_true(found->conclusive);
            ss_spikes_free(found);
        }
        if (sc.wrong > 3 || (double)sc.near < 0.80 * (double)sc.right
            || (double)sc.good < 0.95 * (double)sc.right || (double)seen < 0.95 * (double)slips)
            fail_msg("%s: %zu wrong in %zu transitions; of %zu spikes %zu within 1 sample and %zu "
                     "within 2; %zu of %zu slips seen", name[k], sc.wrong, sc.transitions, sc.right,
                     sc.near, sc.good, seen, slips);
        assert_true(k == 0 ? sc.grouped > 240 : sc.grouped == 0);
        ss_signal_free(s.signal);
    }
}

static void
claims_nothing_20_dB_above_the_noise(void **state)
{
    static const char *const name[] = { "compliant-light", "compliant-heavy" };
    (void)state;
    for (size_t k = 0; k < 2; k++) {
        score_scene s;
        score_scene_make(&s, name[k], RATE, 3, 0);
        for (unsigned long seed = 1; seed <= 20; seed++) {
            ss_spikes *found = score_find(&s, 20, seed);
            assert_false(found->conclusive);
            ss_spikes_free(found);
        }
        ss_signal_free(s.signal);
    }
}

/* One record in a hundred or fewer may have a false one: of 100, at most 5 (Poisson's tail at mean
 * 1 is then below 0.1 %), white or coloured. */
static void
noise_alone_has_no_spikes(void **state)
{
    enum { N = 3000, RECORDS = 50 };
    double x[N];
    size_t wrong = 0;
    (void)state;
    for (unsigned long seed = 1; seed <= 2 * RECORDS; seed++) {
        memset(x, 0, sizeof x);
        ss_noise_add_once(x, N, 1, seed, NULL);
        for (size_t i = 1; i < N && seed > RECORDS; i++)
            x[i] += 0.9 * x[i - 1];             /* red */
        ss_spikes *found = find(x, N, RATE);
        wrong += found->n;
        ss_spikes_free(found);
    }
    if (wrong > 5)
        fail_msg("%zu spikes in %d records of noise", wrong, 2 * RECORDS);
}

/* A converter rounds a slow sine to steps of its own, which seldom change where it is slowest: no
 * jumps are found in it. */
static void
a_converter_makes_no_spikes(void **state)
{
    enum { N = 4000 };
    double x[N];
    ss_spikes *found;
    (void)state;
    for (double f = 0.01; f < 10; f *= 27) {
        for (size_t i = 0; i < N; i++)
            x[i] = sin(2 * M_PI * f * (double)i / RATE);
        assert_int_equal(ss_quantise(x, N, 10, 1, &(size_t){ 0 }, NULL), SS_OK);
        found = find(x, N, RATE);
        assert_int_equal(found->n, 0);
        ss_spikes_free(found);
    }
    for (size_t i = N / 2; i < N; i++)
        x[i] += 0.25;
    found = find(x, N, RATE);
    assert_int_equal(found->n, 1);
    assert_true(fabs(found->spike[0].t * RATE - (N / 2 - 0.5)) <= 1);
    ss_spikes_free(found);
}

static void
short_and_constant_records_are_answered(void **state)
{
    double x[64] = { 0 };
    (void)state;
    for (size_t n = 1; n <= 64; n++) {
        for (int last = 0; last < 2; last++) {          /* constant, then not */
            x[n - 1] = last;
            ss_spikes *found = find(x, n, RATE);
            assert_true(last == 1 || found->n == 0);
            ss_spikes_free(found);
            free(bursts_of(x, n, RATE, 15, NULL, 0).burst);
        }
        x[n - 1] = 0;
    }
    ss_spikes_free(NULL);
}

/* --- single events --------------------------------------------------------------------------- */

/* Pulses of 40 samples at 3000 and, at a tenth of the height, at 7000, in red noise and on a
 * drift. */
static void
finds_the_one_event(void **state)
{
    enum { N = 10000 };
    static double x[N];
    (void)state;
    ss_noise_add_once(x, N, 0.001, 5, NULL);
    for (size_t i = 1; i < N; i++)
        x[i] += 0.8 * x[i - 1];
    for (size_t i = 0; i < N; i++)
        x[i] += 1e-4 * (double)i + 1 / cosh(((double)i - 3000) / 20)
            + 0.1 / cosh(((double)i - 7000) / 20);
    ss_bursts found = bursts_of(x, N, 50000, 15, NULL, 0);
    assert_int_equal(found.n, 1);
    assert_true(fabs(found.burst[0].t * 50000 - 3000) <= 20 && found.burst[0].level == 0);
    assert_true(fabs(found.next + 20) <= 0.5);
    free(found.burst);
    found = bursts_of(x, N, 50000, 25, NULL, 0);
    assert_int_equal(found.n, 2);
    assert_true(fabs(found.burst[1].level + 20) <= 0.5 && found.next < -25);
    free(found.burst);
}

/* A gap filled with zeros, in a signal that is far from it; an event behind it is found, one in it
 * is not. */
static void
a_gap_is_no_event(void **state)
{
    enum { N = 10000 };
    static const ss_span gap[] = { { 0.02, 0.03 }, { 0.1, 0.101 } };
    static double x[N];
    (void)state;
    ss_noise_add_once(x, N, 0.001, 5, NULL);
    for (size_t i = 0; i < N; i++) {
        double t = (double)i / 50000;
        x[i] += 5 + 1 / cosh(((double)i - 7000) / 20);
        x[i] = ss_gaps_near(gap, 2, t + 0.5 / 50000, 0) ? 0 : x[i];
    }
    ss_bursts found = bursts_of(x, N, 50000, 15, gap, 2);
    assert_int_equal(found.n, 1);
    assert_true(fabs(found.burst[0].t * 50000 - 7000) <= 20);
    free(found.burst);
    ss_spikes *spikes = NULL;
    x[6000] += 1;
    assert_int_equal(spikes_of(&spikes, x, N, 50000, gap, 2), SS_OK);
    assert_true(spikes->n == 1 && spikes->spike[0].kind == SS_SPIKE_GLITCH);
    assert_true(fabs(spikes->spike[0].t * 50000 - 6000) <= 1);
    ss_spikes_free(spikes);
}

/* --- drops ----------------------------------------------------------------------------------- */

/* A sawtooth: it climbs for 0.9 s and falls within 0.1 s, tooth i by heights[i]. */
static void
saw(double *x, size_t n, const double *heights, size_t teeth)
{
    for (size_t i = 0; i < n; i++) {
        double t = (double)i / RATE, in = t - floor(t);
        size_t k = (size_t)t % teeth;
        x[i] = heights[k] * (in < 0.9 ? in / 0.9 : (1 - in) / 0.1);
    }
}

static void
counts_drops_by_their_height(void **state)
{
    enum { N = 20000 };
    static const double height[10] = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 };
    static double x[N], y[N];
    (void)state;
    saw(x, N, height, 10);
    for (int kind = 0; kind < 5; kind++) {
        memcpy(y, x, sizeof y);
        if (kind > 0)
            ss_noise_add_once(y, N, 0.1, 1, NULL);
        for (size_t i = 0; i < N; i++) {
            y[i] += kind == 2 ? -0.3 * (double)i / RATE : 0;            /* drift */
            y[i] += kind == 3 && i % 97 == 0 ? (i % 2 ? 50 : -50) : 0;  /* wrong samples */
            y[i] = kind == 4 ? 1e-6 * y[i] - 3 : y[i];
        }
        for (int above = 1; above < 10; above++) {
            ss_drop *drop = NULL;
            size_t n = 0;
            double unit = kind == 4 ? 1e-6 : 1;
            double least = (above + 0.5) * unit;
            assert_int_equal(ss_drops_find(&drop, &n, y, N, least, least / 4), SS_OK);
            if (n != 10 - (size_t)above)
                fail_msg("kind %d: %zu drops above %d.5", kind, n, above);
            for (size_t i = 0; i < n; i++) {
                double tooth = above + 1 + (double)i, at = tooth - 0.1;
                assert_true(fabs((double)drop[i].high / RATE - at) <= 0.05 && drop[i].low > drop[i].high);
            }
            free(drop);
        }
    }
}

/* Trapezoids without noise, and upside down: a running median of five samples keeps them as they are, and each
 * fall lasts from the last sample at its top to the first at its bottom. */
static void
drops_of_trapezoids_are_exact(void **state)
{
    enum { TOP = 9, FALL = 8, LOW = 11, RISE = 12, PERIOD = TOP + FALL + LOW + RISE - 2, TEETH = 15, N = TEETH * PERIOD + TOP };
    static double x[N];
    (void)state;
    for (int is_down = 0; is_down < 2; is_down++) {
        const size_t first = is_down ? TOP + FALL + LOW - 2 : TOP - 1, lasts = is_down ? RISE : FALL;
        size_t n = 0;
        ss_drop *drop = NULL;
        for (size_t i = 0; i < N; i++) {
            double at = (double)(i % PERIOD) - (TOP - 1), fallen = fmin(1, fmax(0, at / FALL));
            double level = 1 - fallen + fmax(0, (at - FALL - LOW + 1) / RISE);
            x[i] = is_down ? 3 - 2 * level : 1 + 2 * level;
        }
        assert_int_equal(ss_drops_find(&drop, &n, x, N, 1.5, 0.375), SS_OK);
        assert_int_equal(n, TEETH);
        for (size_t i = 0; i < n; i++)
            assert_true(drop[i].high == i * PERIOD + first && drop[i].low == drop[i].high + lasts);
        free(drop);
    }
}

/* Falls are at 0.9 ... 1, 1.9 ... 2, ...: the gaps take away the first and the third, and one in a
 * climb none. */
static void
falls_over_gaps_are_left_out(void **state)
{
    enum { N = 20000 };
    static const double height[1] = { 1 };
    static const ss_span gap[] = { { 0.93, 0.95 }, { 1.4, 1.5 }, { 2.7, 3.2 } };
    ss_header *head = NULL;
    ss_signal *signal = NULL;
    ss_features *found = NULL;
    ss_features_opts opts;
    (void)state;
    assert_int_equal(ss_header_new(&head, RATE, 0, NULL), SS_OK);
    assert_int_equal(ss_header_add_column(head, "f", "N", NULL), SS_OK);
    assert_int_equal(ss_header_note(head, "gaps", "0.93:0.95 1.4:1.5 2.7:3.2", NULL), SS_OK);
    assert_int_equal(ss_signal_new(&signal, head, N, NULL), SS_OK);
    ss_features_opts_init(&opts, sizeof opts);
    opts.drop = 0.4;
    for (int by_line = 0; by_line < 2; by_line++) {
        double *x = signal->values;
        saw(x, N, height, 1);
        for (size_t g = 0; g < 3; g++) {
            size_t first = (size_t)(gap[g].from * RATE + 0.5), end = (size_t)(gap[g].to * RATE + 0.5);
            double left = x[first - 1], right = x[end];
            for (size_t i = first; i < end; i++)
                x[i] = by_line ? left + (right - left) * (double)(i - first) / (double)(end - first) : 0;
        }
        assert_int_equal(ss_features_find(&found, signal, 0, &opts, NULL), SS_OK);
        assert_int_equal(found->n, 8);
        assert_true(fabs(found->transition[0].onset - 1.9) < 0.05 && fabs(found->transition[1].onset - 3.9) < 0.05);
        ss_features_free(found);
    }
    ss_signal_free(signal);
    ss_header_free(head);
}

/* One sample of three is as likely noise as wrong; among a hundred it is wrong. */
static void
a_wrong_sample_stands_out_of_many(void **state)
{
    double x[100] = { 0, 1 }, y[100];
    (void)state;
    assert_int_equal(ss_drops_without_glitches(y, x, 3, NULL, 0), SS_OK);
    assert_true(y[0] == 0 && y[1] == 1 && y[2] == 0);
    assert_int_equal(ss_drops_without_glitches(y, x, 100, NULL, 0), SS_OK);
    for (size_t i = 0; i < 100; i++)
        assert_true(y[i] == 0);
}

static void
a_slow_drift_is_no_drop(void **state)
{
    enum { N = 20000 };
    static const double height[1] = { 1 };
    static double x[N];
    ss_drop *drop = NULL;
    size_t n = 9;
    (void)state;
    saw(x, N, height, 1);
    for (size_t i = 0; i < N; i++)
        x[i] -= 0.5 * (double)i / RATE;
    assert_int_equal(ss_drops_find(&drop, &n, x, N, 1.5, 0.375), SS_OK);
    assert_int_equal(n, 0);
    free(drop);
    assert_int_equal(ss_drops_find(&drop, &n, x, 1, 1, 0.25), SS_OK);
    assert_int_equal(n, 0);
    free(drop);
}

/* An event of 100, with twice as much as counts as noise, a hundredth, before it, and just that behind it. */
static void
a_hundredth_of_an_event_counts_as_noise(void **state)
{
    double x[200] = { 0 };
    (void)state;
    x[100] = 100, x[97] = 2, x[103] = 1;
    ss_window of = ss_extent(x, (ss_window){ 0, 200 }, 100, 10);
    assert_true(of.first == 97 && of.end == 100);
}

/* 2^-20 a sample on an offset of 2^30, which take 50 of 53 bits. */
static void
an_offset_takes_no_digits_of_a_slope(void **state)
{
    double y[64];
    (void)state;
    for (int i = 0; i < 64; i++)
        y[i] = 0x1p30 + i * 0x1p-20;
    ss_line l = ss_line_through(y, NULL, (ss_window){ 0, 64 });
    assert_true(fabs(l.slope * 0x1p20 - 1) < 1e-9);
}

/* Windows of 200 and 220 samples, ten and eleven periods, are cut at a place: what is longer in all stays, and ends
 * less than half a period from there. */
static void
windows_are_cut_where_more_is_left(void **state)
{
    static const size_t at[] = { 50, 90, 120, 150, 190 };
    (void)state;
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        ss_window window[] = { { 100, 300 }, { 500, 720 } };
        fitter k = { .fit = { .w = 2 * M_PI / 20 }, .window = window, .n = 2 };
        assert_int_equal(ss_sticks_split(&k, at[i]), 1);
        for (size_t j = 0; j < 2; j++) {
            size_t first = j == 0 ? 100 : 500, end = j == 0 ? 300 : 720, cut = first + at[i];
            if (2 * at[i] > 210)
                assert_true(window[j].first == first && window[j].end <= cut && window[j].end + 10 > cut);
            else
                assert_true(window[j].end == end && window[j].first >= cut && window[j].first < cut + 10);
        }
    }
}

/* Two rests between oscillations, all in counts of 1/500: ends are right within the samples that a count hides. */
static void
rests_of_a_coarse_converter_are_found(void **state)
{
    static const size_t end[] = { 500, 900, 1300, 1700 };
    static double x[2000];
    uint64_t seed = 5;
    ss_rests rests;
    (void)state;
    for (size_t i = 0; i < 2000; i++) {
        int at_rest = (i >= end[0] && i < end[1]) || (i >= end[2] && i < end[3]);
        double from = i < end[0] ? 0 : i < end[2] ? (double)end[1] : (double)end[3];
        x[i] = rint(500 * (at_rest ? 0.004 * uniform(&seed) - 0.002 : sin(M_PI * ((double)i - from) / 50))) / 500;
    }
    assert_int_equal(ss_rests_find(x, 2000, &rests), SS_OK);
    assert_int_equal(rests.n, 2);
    for (size_t k = 0; k < 4; k++) {
        size_t is = k % 2 == 0 ? rests.rest[k / 2].first : rests.rest[k / 2].end;
        assert_true(labs((long)is - (long)end[k]) <= 3);
    }
    free(rests.rest);
}

/* Four rests of 400 samples with white noise between oscillations.  In one of them a motion that noise hides from any
 * one sample, six of its deviations high; or an oscillation whose extremum only touches the level, for 90 samples. */
static void
small_motions_make_rests_doubtful(void **state)
{
    enum { PLAIN, HIDDEN, TOUCHING, KINDS };
    static double x[2400];
    (void)state;
    for (int kind = PLAIN; kind < KINDS; kind++) {
        uint64_t seed = 5;
        ss_rests rests;
        for (size_t i = 0; i < 2400; i++) {
            double at = (double)(i % 600), noise = 0;
            for (int k = 0; k < 12; k++)
                noise += uniform(&seed) - 0.5;
            x[i] = 0.003 * noise + (at < 200 ? sin(M_PI * at / 50) : 0);
            if (kind == HIDDEN && i > 700 && at > 350 && at < 450)
                x[i] += 0.018 * sin(M_PI * (at - 350) / 100);
            if (kind == TOUCHING && i > 700 && at < 200)
                x[i] = 0.003 * noise + 1 - exp(-pow((at - 100) / 370, 2));
        }
        assert_int_equal(ss_rests_find(x, 2400, &rests), SS_OK);
        assert_int_equal(rests.is_doubtful, kind != PLAIN);
        free(rests.rest);
    }
}

/* A hum whose frequency changes every 20,000 samples, under a signal that repeats: a hundredth of it is left. */
static void
a_hum_is_subtracted_part_by_part(void **state)
{
    enum { ALL = 60000, CYCLE = 50 };
    double *x = malloc(ALL * sizeof *x), left = 0;
    ss_hum found;
    (void)state;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < ALL; i++) {
            double cycle = exp(-0.05 * (i % CYCLE)) * sin(0.2 * M_PI * (i % CYCLE));
            if (pass == 0)
                x[i] = cycle + 0.1 * cos(2 * M_PI * (0.0933 + 0.0062 * (i / 20000)) * i);
            else
                left += (x[i] - cycle) * (x[i] - cycle) / ALL;
        }
        if (pass == 0)
            assert_int_equal(ss_hum_subtract(x, ALL, 0.1, CYCLE, &found), SS_OK);
    }
    assert_int_equal(found, SS_HUM_SUBTRACTED);
    if (!(sqrt(left) < 0.01 * 0.1 * M_SQRT1_2))
        fail_msg("%g is left of the hum", sqrt(left) / 0.1 / M_SQRT1_2);
    free(x);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tells_jumps_from_kinks_bends_and_glitches),
        cmocka_unit_test(units_and_clocks_do_not_matter),
        cmocka_unit_test(finds_every_event_of_clean_scenes),
        cmocka_unit_test(coulomb_friction_makes_one_spike_a_transition),
        cmocka_unit_test(a_smooth_law_bends_and_never_breaks),
        cmocka_unit_test(finds_micro_slips_40_dB_above_the_noise),
        cmocka_unit_test(claims_nothing_20_dB_above_the_noise),
        cmocka_unit_test(noise_alone_has_no_spikes),
        cmocka_unit_test(a_converter_makes_no_spikes),
        cmocka_unit_test(short_and_constant_records_are_answered),
        cmocka_unit_test(finds_the_one_event),
        cmocka_unit_test(a_gap_is_no_event),
        cmocka_unit_test(counts_drops_by_their_height),
        cmocka_unit_test(drops_of_trapezoids_are_exact),
        cmocka_unit_test(falls_over_gaps_are_left_out),
        cmocka_unit_test(a_wrong_sample_stands_out_of_many),
        cmocka_unit_test(a_slow_drift_is_no_drop),
        cmocka_unit_test(a_hundredth_of_an_event_counts_as_noise),
        cmocka_unit_test(an_offset_takes_no_digits_of_a_slope),
        cmocka_unit_test(windows_are_cut_where_more_is_left),
        cmocka_unit_test(rests_of_a_coarse_converter_are_found),
        cmocka_unit_test(small_motions_make_rests_doubtful),
        cmocka_unit_test(a_hum_is_subtracted_part_by_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
