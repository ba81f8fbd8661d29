/* test_rank.c -- ranking: signals whose model is known; fits: signals whose parameters are. */
#include <stdlib.h>
#include <string.h>
#include <math.h>
#include <stickslip.h>
#include "foreign.h"
#include "shipped.h"
#include "fit/cycle.h"
#include "fit/forced.h"
#include "unit.h"
#include "noise_rms.h"
#include "signal/noise.h"
#include "signal/header.h"
#include "scene/scene.h"
#include "scene_word.h"

enum { MODELS = 4, HEAVY = 0, LIGHT, COULOMB, STATE };      /* as shipped */

static ss_scene
shipped(int i)
{
    return read_shipped(&ss_shipped_scenes[i]);
}

/* The acceleration alone, with noise at snr dB (none from 200 on). */
static ss_signal *
record_of(const ss_scene *scene, double snr)
{
    const size_t a = SS_ACCELERATION;
    ss_signal *all = NULL, *one = NULL;
    assert_int_equal(ss_sim_signal(&all, scene, NULL), SS_OK);
    assert_int_equal(ss_signal_select(&one, all, &a, 1, 0, all->n, NULL), SS_OK);
    ss_signal_free(all);
    if (snr < 200)
        ss_noise_add_once(one->values, one->n, noise_rms(one->values, one->n, snr), 5, NULL);
    return one;
}

static ss_ranking *
rank(const ss_signal *signal)
{
    ss_scene scene[MODELS];
    ss_ranking *r = NULL;
    ss_error err = { 0 };
    for (int i = 0; i < MODELS; i++)
        scene[i] = shipped(i);
    if (ss_ranking_new(&r, signal, 0, scene, MODELS, NULL, &err) != SS_OK)
        fail_msg("%s", err.text);
    return r;
}

/* --- cycles -------------------------------------------------------------------------------- */

static double
wave(double turn)
{
    return sin(2 * M_PI * turn) + 0.5 * cos(6 * M_PI * turn) + 0.2 * sin(10 * M_PI * turn + 1);
}

/* A band-limited wave shifted by parts of a bin: the parabola through three values of a correlation
 * whose fastest part has 5 periods in 512 bins errs by less than (2 pi 5 / 512)^2 of a bin. */
static void
size_and_shift_of_a_cycle_are_found(void **state)
{
    static const double shift[] = { 0, 0.25, 0.30001, 0.9 };
    cycle c = { .n = 512 };
    double m[512], a, s;
    (void)state;
    for (size_t k = 0; k < sizeof shift / sizeof *shift; k++) {
        c.power = 0;
        for (size_t i = 0; i < 512; i++) {
            c.y[i] = 2.5 * wave((double)i / 512 - shift[k]);
            m[i] = wave((double)i / 512) + 7;           /* an offset is no matter */
            c.power += c.y[i] * c.y[i] / 512;
        }
        cycle_goal goal;
        assert_int_equal(ss_cycle_goal_new(&goal, &c), SS_OK);
        double left = ss_cycle_misfit(&goal, m, &a, &s);
        ss_cycle_goal_free(&goal);
        assert_true(fabs(remainder(s - shift[k], 1)) <= 0.004 / 512);
        assert_true(fabs(a / 2.5 - 1) <= 1e-6 && left <= 1e-6 * c.power);
    }
}

static void
what_cannot_move_leaves_all(void **state)
{
    cycle c = { .n = 64, .power = 3 };
    double m[64] = { 0 }, a, s;
    (void)state;
    for (size_t i = 0; i < 64; i++)
        c.y[i] = i % 2 ? sqrt(3) : -sqrt(3);
    cycle_goal goal;
    assert_int_equal(ss_cycle_goal_new(&goal, &c), SS_OK);
    assert_true(ss_cycle_misfit(&goal, m, &a, &s) == 3 && a == 0 && s == 0);
    ss_cycle_goal_free(&goal);
}

/* The period to what a bin is over the cycles there are, and noise averaged down: 40 cycles of 100
 * samples in 64 bins, 62.5 samples in each. */
static void
folds_at_the_period_that_repeats(void **state)
{
    enum { N = 4000 };
    double *x = malloc(N * sizeof *x);
    cycle c;
    (void)state;
    for (size_t i = 0; i < N; i++)
        x[i] = 500 + wave((double)i / 100.37);      /* the mean repeats after any time */
    ss_noise_add_once(x, N, 0.1, 3, NULL);
    char why[100] = "";
    assert_int_equal(ss_cycle_find(&c, why, sizeof why, x, NULL, N, 1000, 0), SS_OK);
    assert_true(fabs(c.period / 0.10037 - 1) <= 1. / 64 / (N / 100.37) && why[0] == '\0');
    assert_int_equal(c.n, 64);
    double power = 0.5 * (1 + 0.25 + 0.04);
    assert_true(fabs(c.power / power - 1) <= 0.01);
    /* the scatter within a bin is noise and what the wave changes within it */
    assert_true(c.noise > 0.9 * 0.01 / 62.5 && c.noise < 4 * 0.01 / 62.5);
    assert_int_equal(ss_cycle_find(&c, why, sizeof why, x, NULL, N, 1000, 1000. / 1024), SS_OK);
    assert_int_equal(c.n, 1024);
    free(x);
}

/* A lighter mass has k, K_y and c go up together; f_k / (k Z_e) does not know it. */
static void
a_lighter_mass_is_the_nearest_explanation(void **state)
{
    ss_scene scene = shipped(LIGHT);
    forced c = ss_forced_of(&scene, SS_ACCELERATION, 1.5);
    (void)state;
    double key[FORCED_KEYS];
    memcpy(key, c.own, sizeof key);
    assert_true(ss_forced_distance(&c, key) == 0);
    key[0] += 0.2, key[2] += 0.2, key[3] += 0.2;
    /* mass by -mu: 3 (0.2 - mu)^2 + mu^2 is least at mu = 0.15, where it is 0.03 */
    assert_true(fabs(ss_forced_distance(&c, key) - sqrt(0.03 / 5)) <= 1e-12);
    memcpy(key, c.own, sizeof key);
    key[1] += 0.3;
    assert_true(fabs(ss_forced_distance(&c, key) - sqrt(0.09 / 5)) <= 1e-12);
}

static void
the_literal_law_is_ranked_as_the_scaled_one_that_equals_it(void **state)
{
    ss_scene literal = shipped(STATE);
    double x[400], y[400], most = 0, off = 0, steps = 0;
    (void)state;
    ss_scene_set_text(&literal, "law", "literal", NULL);
    literal.duration = 0.2;
    forced c = ss_forced_of(&literal, SS_ACCELERATION, 1);
    c.scene.duration = 0.2;
    assert_string_equal(scene_word(&c.scene, "law"), "scaled");
    assert_int_equal(ss_samples_run(&literal, SS_ACCELERATION, SAMPLES_FINE, x, NULL, 400, &steps),
                     SS_OK);
    assert_int_equal(ss_samples_run(&c.scene, SS_ACCELERATION, SAMPLES_FINE, y, NULL, 400, &steps),
                     SS_OK);
    for (size_t i = 0; i < 400; i++)
        most = fmax(most, fabs(x[i])), off = fmax(off, fabs(x[i] - y[i]));
    assert_true(off <= 1e-3 * most);            /* 1e-4 each is what the method keeps */
}

/* Against the default method, after whole cycles and a part: within a hundred times the tolerance, of
 * which rkck itself takes a third. */
static void
samples_are_as_good_as_their_tolerance(void **state)
{
    static const struct { double tol, off; } row[] = { { SAMPLES_FINE, 1e-5 }, { SAMPLES_COARSE, 1e-3 } };
    (void)state;
    for (int i = 0; i < MODELS; i++)
        for (size_t k = 0; k < 2; k++) {
            ss_scene scene = shipped(i);
            scene.settle = 6.3 / scene.base_frequency;
            ss_signal *truth = record_of(&scene, 300);
            double *x = malloc(truth->n * sizeof *x), most = 0, off = 0, steps = 0;
            assert_int_equal(ss_samples_run(&scene, SS_ACCELERATION, row[k].tol, x, NULL, truth->n,
                                            &steps), SS_OK);
            for (size_t n = 0; n < truth->n; n++) {
                most = fmax(most, fabs(truth->values[n]));
                off = fmax(off, fabs(x[n] - truth->values[n]));
            }
            if (!(off <= row[k].off * most))
                fail_msg("%s: %.3g off", ss_shipped_scenes[i].name, off / most);
            free(x);
            ss_signal_free(truth);
        }
}

/* A record of n samples often ends near an event; what lies behind it is not touched. */
static void
distances_from_events_end_with_the_record(void **state)
{
    enum { MOST = 400 };
    double x[MOST], clear[MOST + SAMPLES_REACH], steps = 0;
    (void)state;
    for (size_t n = 2; n <= MOST; n += 6) {
        ss_scene scene = shipped(COULOMB);
        scene.settle = 0;
        scene.rate = 200;
        scene.duration = (double)n / scene.rate;
        for (size_t i = n; i < n + SAMPLES_REACH; i++)
            clear[i] = -1;
        assert_int_equal(ss_samples_run(&scene, SS_ACCELERATION, SAMPLES_FINE, x, clear, n, &steps), SS_OK);
        for (size_t i = 0; i < n + SAMPLES_REACH; i++)
            assert_true(i < n ? clear[i] >= 0 && (clear[i] <= SAMPLES_REACH || isinf(clear[i])) : clear[i] == -1);
    }
}

/* --- ranking ------------------------------------------------------------------------------- */

static void
shipped_scenes_rank_themselves_first(void **state)
{
    (void)state;
    for (int i = 0; i < MODELS; i++) {
        ss_scene scene = shipped(i);
        ss_signal *signal = record_of(&scene, i % 2 ? 20 : 40);
        ss_ranking *r = rank(signal);
        if (r->verdict != SS_NAMED || (int)r->row[0].scene != i)
            fail_msg("%s: %s first; %s", ss_shipped_scenes[i].name,
                     ss_shipped_scenes[r->row[0].scene].name, r->why);
        assert_true(fabs(r->forcing_frequency / 2.5 - 1) <= 0.002);
        for (size_t k = 1; k < r->n; k++)
            assert_true(r->row[k].total >= r->row[k - 1].total);
        if (i == COULOMB)                       /* a jumps at each stop, of which a half cycle has one */
            assert_true(fabs(r->value[SS_BY_SPIKES] - 1) <= 0.1);
        for (size_t k = 0; i == COULOMB && k < r->n; k++)       /* the others have none */
            assert_true((ss_rank_score(&r->row[k], SS_BY_JUMP) == SCORE_MOST) == (r->row[k].scene != COULOMB));
        for (size_t k = 0; k < r->n; k++)       /* without x and f there is no df/dx to miss */
            assert_true(ss_rank_score(&r->row[k], SS_BY_STIFFNESS) == 0);
        ss_ranking_free(r);
        ss_signal_free(signal);
    }
}

/* Friction of 1/70 of the spring's force lets what a rig begins with ring on for cycles: place and speed of its
 * start, six cycles before the record, are found with its parameters.  All that a fit leaves is its tolerance. */
static void
a_rig_that_rings_on_is_explained(void **state)
{
    static const double speed[] = { 0.003, -0.003, 0.009 };
    (void)state;
    for (size_t k = 0; k < sizeof speed / sizeof *speed; k++) {
        ss_scene scene = shipped(STATE);
        ss_ranking *r = NULL;
        scene.friction = 0.02, scene.settle = 6 / scene.base_frequency, scene.v0 = speed[k];
        ss_signal *signal = record_of(&scene, 300);
        ss_rank_opts opts;
        ss_rank_opts_init(&opts, sizeof opts);
        opts.forcing_frequency = scene.base_frequency;
        assert_int_equal(ss_ranking_new(&r, signal, 0, &scene, 1, &opts, NULL), SS_OK);
        if (r->verdict != SS_NAMED || !(r->row[0].value[SS_BY_RESIDUAL] <= -100))
            fail_msg("v0 = %g: %g dB, %s", speed[k], r->row[0].value[SS_BY_RESIDUAL], r->why);
        ss_ranking_free(r);
        ss_signal_free(signal);
    }
}

/* Another rig, another unit, sign and clock, an offset: a compliant one all the same. */
static void
size_sign_and_offset_do_not_matter(void **state)
{
    ss_scene scene = shipped(LIGHT);
    (void)state;
    scene.mass = 3, scene.friction = 1.26, scene.phase = 2;
    ss_scene_set(&scene, "contact_stiffness", 180000, NULL);
    ss_signal *signal = record_of(&scene, 40);
    for (size_t i = 0; i < signal->n; i++)
        signal->values[i] = 4e8 - 9.81e6 * signal->values[i];
    ss_ranking *r = rank(signal);
    assert_true(r->verdict == SS_NAMED && r->row[0].scene == LIGHT);
    assert_true(r->row[0].distance[SS_BY_FREQUENCY] <= 0.02);
    ss_ranking_free(r);
    ss_signal_free(signal);
}

static void
what_has_no_transitions_is_not_named(void **state)
{
    static const struct { const char *what; double constant, rms, sine, ramp; } row[] = {
        { "nothing", 0, 0, 0, 0 }, { "a constant", 3, 0, 0, 0 }, { "noise", 0, 1, 0, 0 },
        { "a sine", 0, 0, 1, 0 }, { "a sine in noise", 0, 0.1, 1, 0 }, { "a ramp", 0, 0, 0, 1 } };
    ss_scene scene = shipped(COULOMB);
    ss_signal *signal = record_of(&scene, 300);
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        for (size_t i = 0; i < signal->n; i++)
            signal->values[i] = row[k].constant + row[k].ramp * (double)i
                                + row[k].sine * sin(2 * M_PI * 2.5 * (double)i / 2000);
        ss_noise_add_once(signal->values, signal->n, row[k].rms, 11, NULL);
        ss_ranking *r = rank(signal);
        if (r->verdict == SS_NAMED || r->why[0] == '\0')
            fail_msg("%s: named", row[k].what);
        ss_ranking_free(r);
    }
    ss_signal_free(signal);
}

/* A rig whose contact is neither: one in sixteen kinds of what no scene is, see foreign.h, at 40 dB.  A
 * scene may be named only where it leaves no more than twice the noise that was added. */
static void
what_no_scene_explains_is_not_named(void **state)
{
    static const int kinds[] = { 0, 2, 5, 7, 12 };      /* those that were named once */
    ss_scene scene = shipped(COULOMB);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    (void)state;
    assert_non_null(rng);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        ss_signal *signal = record_of(&scene, 300);
        foreign_signal(kinds[i], signal->values, signal->n, signal->head->rate, rng);
        double noise = noise_rms(signal->values, signal->n, 40);
        double power = pow(noise_rms(signal->values, signal->n, 0), 2);
        ss_noise_add_once(signal->values, signal->n, noise, 3, NULL);
        ss_ranking *r = rank(signal);
        double left = power * pow(10, r->row[0].value[SS_BY_RESIDUAL] / 10);
        if (r->verdict == SS_NAMED && left > 2 * noise * noise)
            fail_msg("%s: named, though %.3g times the noise is left", foreign_names[kinds[i]],
                     left / noise / noise);
        ss_ranking_free(r);
        ss_signal_free(signal);
    }
    gsl_rng_free(rng);
}

/* The acceleration of one rig beside the displacement of itself, of another model, or of a rig with
 * 30 % less friction. */
static void
columns_that_contradict_each_other_are_not_named(void **state)
{
    ss_scene scene[3] = { shipped(COULOMB), shipped(STATE), shipped(COULOMB) };
    static const char *const why[3] = { "", "but not column x", "column x, but with " };
    const size_t column[2] = { SS_DISPLACEMENT, SS_ACCELERATION };
    (void)state;
    scene[2].friction *= 0.7;
    for (int rig = 0; rig < 3; rig++) {
        ss_signal *all = NULL, *other = NULL, *both = NULL;
        ss_rank_opts opts;
        ss_rank_opts_init(&opts, sizeof opts);
        ss_ranking *r = NULL;
        assert_int_equal(ss_sim_signal(&all, &scene[0], NULL), SS_OK);
        assert_int_equal(ss_sim_signal(&other, &scene[rig], NULL), SS_OK);
        memcpy(all->values, other->values, all->n * sizeof(double));
        assert_int_equal(ss_signal_select(&both, all, column, 2, 0, all->n, NULL), SS_OK);
        for (size_t c = 0; c < 2; c++)
            ss_noise_add_once(both->values + c * both->n, both->n,
                              noise_rms(both->values + c * both->n, both->n, 40), 4, NULL);
        opts.also[SS_DISPLACEMENT] = 0;
        assert_int_equal(ss_ranking_new(&r, both, 1, scene, 2, &opts, NULL), SS_OK);
        assert_int_equal(r->verdict, rig > 0 ? SS_UNDECIDED : SS_NAMED);
        if (strstr(r->why, why[rig]) == NULL)
            fail_msg("%s", r->why);
        ss_ranking_free(r);
        ss_signal_free(both);
        ss_signal_free(other);
        ss_signal_free(all);
    }
}

static void
short_records_are_not_named(void **state)
{
    static const double duration[] = { 0, 0.0005, 0.01, 0.39 };
    (void)state;
    for (size_t k = 0; k < sizeof duration / sizeof *duration; k++) {
        ss_scene scene = shipped(HEAVY);
        scene.duration = duration[k];
        ss_signal *signal = record_of(&scene, 300);
        ss_ranking *r = rank(signal);
        assert_true(r->verdict == SS_UNDECIDED && isnan(r->forcing_frequency) && r->n == MODELS);
        ss_ranking_free(r);
        ss_signal_free(signal);
    }
}

static void
refuses_what_is_out_of_range(void **state)
{
    ss_scene scene = shipped(HEAVY), still = scene;
    ss_signal *signal = record_of(&scene, 300);
    ss_ranking *r = NULL;
    ss_fit fit;
    ss_rank_opts opts;
    ss_rank_opts_init(&opts, sizeof opts);
    (void)state;
    still.base_amplitude = 0;
    assert_int_equal(ss_ranking_new(&r, signal, 1, &scene, 1, NULL, NULL), SS_EINVAL);
    assert_int_equal(ss_ranking_new(&r, signal, 0, &scene, 0, NULL, NULL), SS_EINVAL);
    assert_int_equal(ss_ranking_new(&r, signal, 0, &still, 1, NULL, NULL), SS_EINVAL);
    static const double spread[] = { -0.1, 1, INFINITY, NAN };
    for (size_t i = 0; i < 4; i++) {
        opts.spread = spread[i];
        assert_int_equal(ss_ranking_new(&r, signal, 0, &scene, 1, &opts, NULL), SS_EINVAL);
    }
    ss_rank_opts_init(&opts, sizeof opts);
    opts.forcing_frequency = NAN;
    assert_int_equal(ss_ranking_new(&r, signal, 0, &scene, 1, &opts, NULL), SS_EINVAL);
    signal->values[17] = NAN;
    assert_int_equal(ss_ranking_new(&r, signal, 0, &scene, 1, NULL, NULL), SS_EDATA);
    assert_int_equal(ss_scene_fit(&fit, signal, 0, &scene, NULL, NULL), SS_EDATA);
    scene = shipped(STATE);
    assert_int_equal(ss_scene_fit(&fit, signal, 0, &scene, NULL, NULL), SS_EINVAL);
    assert_null(r);
    ss_signal_free(signal);
}

/* --- the sum ------------------------------------------------------------------------------- */

static void
scores_are_distances_over_thresholds_up_to_three(void **state)
{
    ss_rank_row row = { .scene = 0 };
    (void)state;
    row.distance[SS_BY_RESIDUAL] = 6;
    assert_true(fabs(ss_rank_score(&row, SS_BY_RESIDUAL) - 2) <= 1e-15);
    row.distance[SS_BY_RESIDUAL] = 1000;
    assert_true(ss_rank_score(&row, SS_BY_RESIDUAL) == SCORE_MOST);
    row.distance[SS_BY_RESIDUAL] = NAN;
    assert_true(ss_rank_score(&row, SS_BY_RESIDUAL) == 1);
}

/* Row 0 totals 2, row 1 .55 + 1.25 = 1.8, row 2 3. */
static void
rows_are_sorted_by_the_sum_of_their_scores(void **state)
{
    ss_rank_row row[3] = { { .scene = 0 }, { .scene = 1 }, { .scene = 2 } };
    ss_ranking r = { .n = 3, .row = row };
    (void)state;
    row[0].distance[SS_BY_SPIKES] = 2;
    row[1].distance[SS_BY_SPIKES] = 0.55;
    row[1].distance[SS_BY_JUMP] = 7.5;
    row[2].distance[SS_BY_SPIKES] = 3;
    ss_ranking_sort(&r);
    assert_true(row[0].scene == 1 && row[1].scene == 0 && row[2].scene == 2);
    assert_true(fabs(row[0].total - 1.8) <= 1e-15);
}

/* What is explained has a digit behind the point, and at least two of what is left, in per cent: 4.0, .016. */
static void
the_answer_names_what_explains_most(void **state)
{
    static const char *const names[] = { "one", "two", "three" };
    static const char *const answer[] = { "none of these: no; three explains most, 96.0 %\n",
                                          "one explains 99.984 % of the signal's power\n" };
    const ss_ranking_text about = { "s", "a", "its unit", names, 1 };
    (void)state;
    for (int is_named = 0; is_named < 2; is_named++) {
        ss_rank_row row[] = { { .scene = 0, .explained = is_named ? 0.99984 : 0.5 },
                              { .scene = 2, .explained = 0.96 }, { .scene = 1, .explained = 0.9 } };
        ss_ranking r = { .verdict = is_named ? SS_NAMED : SS_NONE_FITS, .why = "no", .forcing_frequency = 1,
                         .n = 3, .row = row };
        char *text = NULL;
        size_t size;
        FILE *out = open_memstream(&text, &size);
        assert_non_null(out);
        assert_int_equal(ss_ranking_write(&r, &about, NULL, out, SS_TSV, NULL), SS_OK);
        fclose(out);
        assert_non_null(strstr(text, answer[is_named]));
        free(text);
    }
}

/* --- fits ---------------------------------------------------------------------------------- */

/* A number of one scene over that of another. */
static double
ratio_of(const char *key, const ss_scene *a, const ss_scene *b)
{
    return ss_scene_get(a, key) / ss_scene_get(b, key);
}

/* From a start whose contact is twice as stiff and damps three times as much.  What is left
 * without noise is the tolerance of the descent; at 40 dB, 5 times what 12 seeds left: 0.005 and
 * 0.1 %, with f_k and Z_e, which have much the same effect, at 0.03 %. */
static void
finds_the_parameters_of_a_compliant_signal(void **state)
{
    static const struct { int scene; double snr, force, stiffness, damping; } row[] = {
        { HEAVY, 300, 1e-8, 1e-8, 1e-8 }, { LIGHT, 300, 1e-8, 1e-8, 1e-8 },
        { HEAVY, 40, 2e-3, 3e-4, 5e-3 }, { LIGHT, 40, 2e-3, 3e-4, 5e-3 } };
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        ss_scene truth = shipped(row[k].scene), start = truth;
        ss_signal *signal = record_of(&truth, row[k].snr);
        ss_fit fit;
        start.friction = 1;
        ss_scene_set(&start, "contact_stiffness", 2 * ss_scene_get(&start, "contact_stiffness"), NULL);
        ss_scene_set(&start, "contact_damping", 3 * ss_scene_get(&start, "contact_damping"), NULL);
        start.base_amplitude = 0.001;
        assert_int_equal(ss_scene_fit(&fit, signal, 0, &start, NULL, NULL), SS_OK);
        assert_true(fit.conclusive);
        if (!(fabs(fit.scene.friction / truth.friction - 1) <= row[k].force))
            fail_msg("%s at %g dB: f_k %.3g off", ss_shipped_scenes[row[k].scene].name, row[k].snr,
                     fit.scene.friction / truth.friction - 1);
        assert_true(fabs(fit.scene.base_amplitude / truth.base_amplitude - 1) <= row[k].force);
        assert_true(fabs(ratio_of("contact_stiffness", &fit.scene, &truth) - 1)
                    <= row[k].stiffness);
        assert_true(fabs(ratio_of("contact_damping", &fit.scene, &truth) - 1) <= row[k].damping);
        /* all that is left is the noise */
        assert_true(fit.residual_started <= 1.02 * pow(10, -row[k].snr / 20) + 1e-8);
        assert_true(fit.scene.rate == truth.rate && fit.scene.duration == truth.duration);
        assert_true(fit.residual <= 0.15);
        ss_signal_free(signal);
    }
}

/* A record of three cycles that begins at rest is fitted from half a cycle on, where a fitted motion can be that of
 * the record. */
static void
a_short_record_may_begin_at_rest(void **state)
{
    ss_scene truth = shipped(LIGHT), start = truth;
    ss_fit fit;
    (void)state;
    truth.settle = 0, truth.duration = 3 / truth.base_frequency, truth.x0 = truth.base_amplitude / 2;
    ss_scene_set(&start, "contact_stiffness", 1.3 * ss_scene_get(&start, "contact_stiffness"), NULL);
    ss_signal *signal = record_of(&truth, 300);
    ss_rank_opts opts;
    ss_rank_opts_init(&opts, sizeof opts);
    opts.forcing_frequency = truth.base_frequency;
    assert_int_equal(ss_scene_fit(&fit, signal, 0, &start, &opts, NULL), SS_OK);
    if (!fit.conclusive)
        fail_msg("%s", fit.why);
    assert_true(fabs(ratio_of("contact_stiffness", &fit.scene, &truth) - 1) <= 1e-8);
    ss_signal_free(signal);
}

/* What a sensor of first order shows that is so many samples late, of a motion that is straight between
 * samples: the closed form of its response to a ramp. */
static void
lag(double *x, size_t n, double samples)
{
    const double keep = exp(-1 / samples), part = samples * (1 - keep);
    double before = x[0];
    for (size_t i = 1; i < n; i++) {
        double now = x[i];
        x[i] = keep * x[i - 1] + (1 - part) * now + (part - keep) * before;
        before = now;
    }
}

/* Fit the light scene to a record at 40 dB of a rig that differs from it in terms that a fit holds.  *part
 * becomes what is left of the power. */
static void
ask(forced_held of[HELD_TERMS], double *part, const ss_scene *rig, double lag_samples)
{
    const ss_scene scene = shipped(LIGHT);
    const double period = 1 / scene.base_frequency;
    ss_signal *signal = record_of(rig, 300);
    forced c = ss_forced_of(&scene, SS_ACCELERATION, 2);
    rank_record r = { .x = signal->values, .n = signal->n, .rate = scene.rate };
    forced_fit m;
    cycle goal;
    char why[128] = "";
    c.period = period;
    c.range[FORCED_STIFFNESS] = (ss_range){ c.own[FORCED_STIFFNESS], c.own[FORCED_STIFFNESS] };
    if (lag_samples > 0)
        lag(signal->values, signal->n, lag_samples);
    ss_noise_add_once(signal->values, signal->n, noise_rms(signal->values, signal->n, 40), 5, NULL);
    assert_int_equal(ss_record_noise(&r, period * r.rate), SS_OK);
    assert_int_equal(ss_cycle_find(&goal, why, sizeof why, r.x, NULL, r.n, r.rate, scene.base_frequency), SS_OK);
    assert_int_equal(ss_forced_fit(&m, NULL, &c, &goal, 16, 1, &r), SS_OK);
    assert_int_equal(ss_forced_gains(of, &c, &m, &r), SS_OK);
    assert_true(m.of_samples.compared > 0);
    *part = m.of_samples.left / m.of_samples.power;
    ss_signal_free(signal);
}

/* Damping and f_s / f_k that the scene lacks come back within three standard errors, where the gain is the
 * square of the change in standard errors.  Without them no gain is significant. */
static void
terms_that_a_fit_holds_come_back(void **state)
{
    static const struct { double damping, ratio; } row[] = {
        { 0, 1 }, { 0.1, 1 }, { 0.5, 1 }, { 2, 1 }, { 8, 1 }, { 0, 1.01 }, { 0, 1.03 }, { 0, 1.1 } };
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        ss_scene rig = shipped(LIGHT);
        forced_held of[HELD_TERMS];
        double part;
        rig.damping = row[k].damping;
        rig.static_friction = row[k].ratio > 1 ? row[k].ratio * rig.friction : 0;
        ask(of, &part, &rig, 0);
        const forced_held *damping = &of[HELD_DAMPING], *ratio = &of[HELD_STATIC];
        if (row[k].ratio == 1 && !(fabs(damping->nearer - rig.damping) * sqrt(damping->gain) <= 3 * damping->nearer))
            fail_msg("damping %g: %g", rig.damping, damping->nearer);
        if (row[k].damping == 0
            && !(fabs(ratio->nearer - row[k].ratio) * sqrt(ratio->gain) <= 3 * fabs(ratio->nearer - 1)))
            fail_msg("f_s / f_k %g: %g", row[k].ratio, ratio->nearer);
        if (row[k].ratio == 1)
            assert_true((damping->gain > 9) == (row[k].damping > 0));
        assert_true(k > 0 || (ratio->gain <= 9 && of[HELD_LAG].gain <= 9));
    }
}

/* The gain by a lag is what a fit to the same record leaves less if the sensor has none.  The noise in the
 * record moves the gain by 2 sqrt(gain) for each standard error; two are allowed. */
static void
a_lag_of_the_sensor_is_seen(void **state)
{
    const ss_scene rig = shipped(LIGHT);
    forced_held of[HELD_TERMS];
    double without, part;
    (void)state;
    ask(of, &without, &rig, 0);
    for (double samples = 0.25; samples <= 2; samples *= 2) {
        ask(of, &part, &rig, samples);
        double gain = of[HELD_LAG].gain, less = (1 - without / part) * (double)ss_scene_samples(&rig);
        assert_true(gain > 9 && gain > of[HELD_DAMPING].gain && gain > of[HELD_STATIC].gain);
        if (!(fabs(gain - less) <= 4 * sqrt(gain)))
            fail_msg("%g samples: the gain is %g, but %g is left less", samples, gain, less);
    }
}

/* Gaps at one place of each cycle leave nothing to compare there. */
static void
gaps_in_every_cycle_are_said(void **state)
{
    ss_scene truth = shipped(LIGHT);
    char gaps[400] = "";
    (void)state;
    for (double from = .1; from < truth.duration; from += 1 / truth.base_frequency)
        snprintf(gaps + strlen(gaps), sizeof gaps - strlen(gaps), "%s%.12g:%.12g", gaps[0] ? " " : "", from, from + .04);
    ss_signal *signal = record_of(&truth, 300);
    assert_int_equal(ss_header_note(signal->head, "gaps", gaps, NULL), SS_OK);
    ss_ranking *r = rank(signal);
    assert_int_equal(r->verdict, SS_UNDECIDED);
    assert_non_null(strstr(r->why, "gaps leave out a part of every cycle of 0.4 s"));
    ss_ranking_free(r);
    ss_signal_free(signal);
}

/* A gap in a column that is not the first of its signal: the answer is that of the column alone. */
static void
gaps_of_a_later_column_are_bridged(void **state)
{
    const size_t columns[] = { SS_VELOCITY, SS_ACCELERATION };
    ss_scene truth = shipped(LIGHT), scene[MODELS];
    ss_signal *all = NULL, *two = NULL, *one = NULL;
    ss_ranking *r[2] = { NULL };
    (void)state;
    for (int i = 0; i < MODELS; i++)
        scene[i] = shipped(i);
    assert_int_equal(ss_sim_signal(&all, &truth, NULL), SS_OK);
    for (size_t i = 2180; i < 2240; i++)
        all->values[SS_ACCELERATION * all->n + i] = 0;
    assert_int_equal(ss_header_note(all->head, "gaps", "1.09:1.12", NULL), SS_OK);
    assert_int_equal(ss_signal_select(&two, all, columns, 2, 0, all->n, NULL), SS_OK);
    assert_int_equal(ss_signal_select(&one, all, columns + 1, 1, 0, all->n, NULL), SS_OK);
    assert_int_equal(ss_ranking_new(&r[0], one, 0, scene, MODELS, NULL, NULL), SS_OK);
    assert_int_equal(ss_ranking_new(&r[1], two, 1, scene, MODELS, NULL, NULL), SS_OK);
    for (size_t i = 0; i < r[0]->n; i++)
        for (int k = 0; k < SS_CRITERIA; k++)
            assert_true(r[0]->row[i].value[k] == r[1]->row[i].value[k]
                        || (isnan(r[0]->row[i].value[k]) && isnan(r[1]->row[i].value[k])));
    for (int i = 0; i < 2; i++)
        ss_ranking_free(r[i]);
    ss_signal_free(all);
    ss_signal_free(two);
    ss_signal_free(one);
}

/* A gap in a stick, filled with a line or with zeros: the models rank as without, and all samples
 * that are left fit the scene to the last digits. */
static void
gaps_do_not_matter(void **state)
{
    ss_scene truth = shipped(LIGHT);
    (void)state;
    for (int line = 0; line < 2; line++) {
        ss_signal *signal = record_of(&truth, 300);
        ss_fit fit;
        size_t first = 2180, many = 60;
        double *x = signal->values, left = x[first - 1], right = x[first + many];
        for (size_t i = 0; i < many; i++)
            x[first + i] = line ? left + (right - left) * (double)(i + 1) / (double)(many + 1) : 0;
        assert_int_equal(ss_header_note(signal->head, "gaps", "1.09:1.12", NULL), SS_OK);
        ss_ranking *r = rank(signal);
        assert_true(r->verdict == SS_NAMED && r->row[0].scene == LIGHT);
        assert_true(r->row[0].value[SS_BY_RESIDUAL] <= -20);
        ss_ranking_free(r);
        assert_int_equal(ss_scene_fit(&fit, signal, 0, &truth, NULL, NULL), SS_OK);
        assert_true(fit.conclusive && fit.residual_started <= 1e-8);
        assert_true(fabs(ratio_of("contact_stiffness", &fit.scene, &truth) - 1) <= 1e-8);
        assert_true(fabs(fit.scene.friction / truth.friction - 1) <= 1e-8);
        ss_signal_free(signal);
    }
}

typedef struct watcher {
    double last, stop_at, widest;       /* the widest step */
    int back, calls;
    double seen[4096];
} watcher;

static int
watch(double done, void *user)
{
    watcher *w = user;
    w->back += done < w->last || done < 0 || done > 1;
    w->widest = fmax(w->widest, done - w->last);
    w->last = done;
    w->seen[w->calls++ % 4096] = done;
    return done >= w->stop_at;
}

static void
progress_goes_on_to_the_end_or_stops(void **state)
{
    ss_scene scene = shipped(LIGHT);
    ss_signal *signal = record_of(&scene, 40);
    (void)state;
    for (int fits = 0; fits < 2; fits++)
        for (int stops = 0; stops < 2; stops++) {
            watcher w = { .stop_at = stops ? 0.6 : 2 };
            ss_rank_opts opts;
            ss_rank_opts_init(&opts, sizeof opts);
            ss_ranking *r = NULL;
            ss_fit fit;
            opts.progress = (ss_progress){ watch, &w };
            ss_status st = fits ? ss_scene_fit(&fit, signal, 0, &scene, &opts, NULL)
                : ss_ranking_new(&r, signal, 0, &scene, 1, &opts, NULL);
            assert_int_equal(st, stops ? SS_STOP : SS_OK);
            assert_true(w.back == 0 && (stops ? w.last < 0.7 : w.last > 0.7));
            ss_ranking_free(r);
        }
    ss_signal_free(signal);
}

/* A bar that tells how long it will take: work, counted in motions that are run, and what is said of it
 * go together.  Four times the samples are no more motions. */
static void
progress_of_a_fit_counts_down(void **state)
{
    int calls[2];
    (void)state;
    for (int fine = 0; fine < 2; fine++) {
        ss_scene scene = shipped(LIGHT);
        scene.rate *= fine ? 4 : 1;
        ss_signal *signal = record_of(&scene, 40);
        watcher w = { .stop_at = 2 };
        ss_rank_opts opts;
        ss_rank_opts_init(&opts, sizeof opts);
        ss_fit fit;
        opts.progress = (ss_progress){ watch, &w };
        assert_int_equal(ss_scene_fit(&fit, signal, 0, &scene, &opts, NULL), SS_OK);
        assert_true(fit.conclusive && w.back == 0 && w.widest <= 0.25 && w.last > 0.75);
        assert_true(w.calls > 200 && w.calls < 4096);
        assert_true(w.seen[w.calls / 2] > 0.2 && w.seen[w.calls / 2] < 0.8);
        calls[fine] = w.calls;
        ss_signal_free(signal);
    }
    assert_true(calls[1] < 2 * calls[0]);
}

static void
does_not_fit_what_is_not_compliant(void **state)
{
    static const int other[] = { COULOMB, STATE, LIGHT };
    ss_scene start = shipped(LIGHT);
    (void)state;
    for (size_t k = 0; k < 3; k++) {
        ss_scene scene = shipped(other[k]);
        ss_signal *signal = record_of(&scene, 40);
        ss_fit fit;
        if (other[k] == LIGHT) {            /* noise and nothing else */
            memset(signal->values, 0, signal->n * sizeof *signal->values);
            ss_noise_add_once(signal->values, signal->n, 1, 2, NULL);
        }
        assert_int_equal(ss_scene_fit(&fit, signal, 0, &start, NULL, NULL), SS_OK);
        assert_true(!fit.conclusive && fit.why[0] != '\0');
        assert_true(isnan(fit.key[0].found.value) && isnan(fit.key[0].found.error));
        assert_true(fit.scene.friction == start.friction && fit.scene.phase == start.phase);
        ss_signal_free(signal);
    }
}

static int
no_abort(void **state)
{
    (void)state;
    return 0;
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(size_and_shift_of_a_cycle_are_found),
        cmocka_unit_test(what_cannot_move_leaves_all),
        cmocka_unit_test(folds_at_the_period_that_repeats),
        cmocka_unit_test(a_lighter_mass_is_the_nearest_explanation),
        cmocka_unit_test(the_literal_law_is_ranked_as_the_scaled_one_that_equals_it),
        cmocka_unit_test(samples_are_as_good_as_their_tolerance),
        cmocka_unit_test(distances_from_events_end_with_the_record),
        cmocka_unit_test(the_answer_names_what_explains_most),
        cmocka_unit_test(shipped_scenes_rank_themselves_first),
        cmocka_unit_test(a_rig_that_rings_on_is_explained),
        cmocka_unit_test(size_sign_and_offset_do_not_matter),
        cmocka_unit_test(what_has_no_transitions_is_not_named),
        cmocka_unit_test(what_no_scene_explains_is_not_named),
        cmocka_unit_test(columns_that_contradict_each_other_are_not_named),
        cmocka_unit_test(short_records_are_not_named),
        cmocka_unit_test(refuses_what_is_out_of_range),
        cmocka_unit_test(scores_are_distances_over_thresholds_up_to_three),
        cmocka_unit_test(rows_are_sorted_by_the_sum_of_their_scores),
        cmocka_unit_test(finds_the_parameters_of_a_compliant_signal),
        cmocka_unit_test(a_short_record_may_begin_at_rest),
        cmocka_unit_test(terms_that_a_fit_holds_come_back),
        cmocka_unit_test(a_lag_of_the_sensor_is_seen),
        cmocka_unit_test(gaps_do_not_matter),
        cmocka_unit_test(gaps_in_every_cycle_are_said),
        cmocka_unit_test(gaps_of_a_later_column_are_bridged),
        cmocka_unit_test(progress_goes_on_to_the_end_or_stops),
        cmocka_unit_test(progress_of_a_fit_counts_down),
        cmocka_unit_test(does_not_fit_what_is_not_compliant),
    };
    return cmocka_run_group_tests(tests, no_abort, NULL);
}
